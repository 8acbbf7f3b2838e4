"""The C of this package under two compilers, seven standards, strict warnings, four checkers and another byte order.

python -m studies.c_matrix [PART ...]

warnings     gcc and clang, C99, C11, C17, C++11, C++17, C++20: the library, every kernel, the example, a speed table;
             the extension module in C++17
memory       the example under AddressSanitizer and UndefinedBehaviorSanitizer, and under valgrind
threads      points computed by four threads at once, under ThreadSanitizer: the same bits, no race
big-endian   the example for s390x under qemu-user: the figures of this machine

A part whose tool is not here says so and does not count as done; the exit code is 1 if anything was found.
"""

from __future__ import annotations

import fnmatch
import json
import math
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = [ROOT / "generated", ROOT / "trum_sym" / "_driver"]
WARNINGS = ("-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Wdouble-promotion", "-Wshadow", "-Wmissing-prototypes")
C, CPP = ("c99", "c11", "c17"), ("c++11", "c++17", "c++20")
PLUS = {"gcc": "g++", "clang": "clang++"}
INSTRUCTIONS = {
    "baseline": (),
    "avx2": ("-mavx2", "-mfma"),
    "avx512": ("-mavx512f", "-mavx512dq", "-mavx512vl", "-mfma"),
}
EXTENSION: dict[str, tuple[str, ...]] = {
    "ufuncs": (),
    **{f"{of}_{name}": flags for of in ("orbit", "grid", "coupled") for name, flags in INSTRUCTIONS.items()},
}
# Nothing is set when the module loads: code for AVX-512 would run before the module has looked for it.
NOTHING_AT_LOAD = {"gcc": (), "clang": ("-Wglobal-constructors",)}

# warning, where, why it stays
EXCEPTIONS = (
    ("-W*enum-float-conversion", "trum_sym/_driver/orbit/*.h", "flags are small whole numbers, kept as numbers"),
    ("-W*enum-float-conversion", "trum_sym/_driver/trum_coupled*.h", "flags are small whole numbers, kept as numbers"),
)
_WARNING = re.compile(r"^([^\s:]+):(\d+):\d+: (?:warning|error): (.*?)(?: \[(-W[\w+-]+)\])?$", re.M)
LIBRARY = '#define TRUM_IMPLEMENTATION\n#include "trum.h"\n#include "trum60.h"\n'


def found(output: str) -> list[tuple[str, str, str]]:
    """File, warning and text of what a compiler says."""
    paths = {file: Path(file).resolve() for file, *_ in _WARNING.findall(output)}
    names = {file: str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else file for file, path in paths.items()}
    return [(names[file], flag, text) for file, _, text, flag in _WARNING.findall(output)]


def excused(file: str, flag: str) -> str | None:
    """Why a warning stays, if it is one of the exceptions."""
    for warning, where, reason in EXCEPTIONS:
        if fnmatch.fnmatch(flag, warning) and fnmatch.fnmatch(file, where):
            return reason
    return None


def units(folder: Path) -> tuple[list[Path], list[Path]]:
    """What is compiled as C, and what as C++."""
    import numpy as np

    from trum_sym.studies.table_files import Rows, as_c

    rows = Rows(np.array([1.0, 2.0]), [np.array([180.0, 181.0])], np.array([0.1, 0.1]), np.array([1e-9, 1e-9]))
    table = as_c("table", ["a table"], {"prepressure": "N"}, [rows])
    use = (
        "double at(double v);\ndouble at(double v) { double d[TABLE_COLUMNS] = {0}; table_drive(v, d); return d[0]; }\n"
    )
    for suffix in ("c", "cpp"):
        (folder / f"library.{suffix}").write_text(LIBRARY)
        (folder / f"table.{suffix}").write_text(table + use)
    both = [[folder / f"{name}.{suffix}" for name in ("library", "table")] for suffix in ("c", "cpp")]
    return [*both[0], ROOT / "examples/c/main.c", *sorted((ROOT / "generated").glob("trum_*.c"))], both[1]


def compilations(folder: Path, compilers: Iterable[str], c: Iterable[str], cpp: Iterable[str]) -> list[list[str]]:
    """Command lines that only check."""
    import numpy as np

    as_c, as_cpp = units(folder)
    includes = [f"-I{path}" for path in FOLDERS]
    plain = [flag for flag in WARNINGS if flag != "-Wmissing-prototypes"]  # of C only, for gcc
    lines = []
    for compiler in compilers:
        base = ["-fsyntax-only", "-O2", *includes]
        lines += [[compiler, f"-std={std}", *WARNINGS, *base, str(unit)] for std in c for unit in as_c]
        lines += [[PLUS[compiler], f"-std={std}", *plain, *base, str(unit)] for std in cpp for unit in as_cpp]
        if "c++17" in cpp:
            system = [f"-isystem{sysconfig.get_paths()['include']}", f"-isystem{np.get_include()}"]
            system += ["-DNPY_NO_DEPRECATED_API=NPY_2_0_API_VERSION", "-Wno-psabi"]
            for name, flags in EXTENSION.items():
                source = ROOT / "trum_sym" / "_driver" / f"{name}.cpp"
                more = (*flags, *NOTHING_AT_LOAD[compiler])
                lines.append([PLUS[compiler], "-std=c++17", *plain, *base, *system, *more, str(source)])
    return lines


def warnings(
    compilers: Iterable[str] = ("gcc", "clang"), c: Iterable[str] = C, cpp: Iterable[str] = CPP
) -> tuple[list[str], Counter[str]]:
    """What is found beyond the exceptions, a line each; and how often each exception was met."""
    wrong: dict[str, None] = {}
    met: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        for line in compilations(Path(name), compilers, c, cpp):
            done = subprocess.run(line, capture_output=True, text=True)
            for file, flag, text in found(done.stderr):
                reason = excused(file, flag)
                if reason is None:
                    wrong[f"{line[0]} {line[1]}: {file}: {text} [{flag}]"] = None
                else:
                    met[f"{flag}, {Path(file).parent}: {reason}"] += 1
            if done.returncode:
                wrong[f"{' '.join(line)}: exit code {done.returncode}"] = None
    return list(wrong), met


def program(folder: Path, source: str, *flags: str, compiler: str = "gcc") -> Path:
    """A program of the library."""
    (folder / "program.c").write_text(source)
    sources = [folder / "program.c", *sorted((ROOT / "generated").glob("trum_*.c"))]
    command = [compiler, "-std=c99", *flags, *(f"-I{path}" for path in FOLDERS), *map(str, sources), "-lm"]
    subprocess.run([*command, "-o", folder / "program"], check=True)
    return folder / "program"


def example() -> str:
    """The example's source."""
    return (ROOT / "examples" / "c" / "main.c").read_text("utf-8")


DRIVES = (
    "",
    "load_torque=0.05 start=rest phase_lead=-1",
    "load_torque=0.05 contact=hertz amplitude=forced",
    "load_torque=2",
)


def memory(tolerance: str = "1e-2") -> list[str]:
    """What the sanitizers and valgrind find in the example."""
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sanitized = program(folder, example(), "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
        wrong += [f"sanitizers: {line}" for drive in DRIVES if (line := _ran([sanitized, *drive.split()]))]
        if shutil.which("valgrind") is None:
            print("memory: no valgrind here")
            return wrong
        checked = ["valgrind", "-q", "--error-exitcode=9", "--leak-check=full", program(folder, example(), "-g", "-O1")]
        for drive in DRIVES[:2]:
            if line := _ran([*checked, f"tolerance={tolerance}", *drive.split()]):
                wrong.append(f"valgrind: {line}")
    return wrong


def _ran(command: list[object]) -> str:
    """What is wrong with a run of the example: 0 and 3 are exit codes of points."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    bad = done.returncode not in (0, 1, 3) or "Sanitizer" in done.stderr or "runtime error" in done.stderr
    return f"{command}: exit code {done.returncode}: {done.stderr[-500:]}" if bad else ""


THREADS = """
#define TRUM_IMPLEMENTATION
#include "trum.h"
#include "trum60.h"
#include <pthread.h>
#include <stdio.h>
#define THREADS 4
#define POINTS 3
static struct trum_point points[THREADS][POINTS];
static void* work(void* at) {
  int k;
  for (k = 0; k < POINTS; ++k) {
    struct trum_drive drive = trum_table3;
    drive.load_torque = 0.02 * (k + 1);
    drive.tolerance = 1e-2;
    trum_evaluate(&trum60, &drive, (struct trum_point*)at + k);
  }
  return at;
}
int main(void) {
  pthread_t all[THREADS];
  int k, j;
  for (k = 0; k < THREADS; ++k) if (pthread_create(&all[k], 0, work, points[k])) return 2;
  for (k = 0; k < THREADS; ++k) pthread_join(all[k], 0);
  for (k = 1; k < THREADS; ++k)
    for (j = 0; j < POINTS; ++j)
      if (memcmp(&points[0][j].mean_speed, &points[k][j].mean_speed, sizeof points[0][j].mean_speed)) return 1;
  return points[0][0].converged ? 0 : 3;
}
"""


def threads(source: str = THREADS) -> list[str]:
    """What ThreadSanitizer finds."""
    with tempfile.TemporaryDirectory() as name:
        ready = program(Path(name), source, "-O0", "-g", "-fsanitize=thread", "-pthread")
        done = subprocess.run([ready], capture_output=True, text=True)
    return [f"threads: exit code {done.returncode}: {done.stderr[-500:]}"] if done.returncode else []


def big_endian() -> list[str]:
    """Figures on s390x that differ from this machine's by more than 1e-9 (of speeds: of the largest) at that tolerance.

    Bounds of errors follow the steps, which rounding may choose otherwise: they may differ by a factor of 30.
    """
    compiler, emulator = "s390x-linux-gnu-gcc", shutil.which("qemu-s390x-static") or shutil.which("qemu-s390x")
    if shutil.which(compiler) is None or emulator is None:
        print("big-endian: no compiler or emulator for s390x here")
        return []
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        here, there = Path(name) / "here", Path(name) / "there"
        here.mkdir(), there.mkdir()
        ours = program(here, example(), "-O2", "-ffp-contract=off")
        theirs = program(there, example(), "-O2", "-ffp-contract=off", "-static", compiler=compiler)
        for drive in DRIVES:
            given = [*drive.split(), "tolerance=1e-9"]
            runs = ([ours, *given], [emulator, theirs, *given])
            both = [subprocess.run(run, capture_output=True, text=True) for run in runs]
            if both[0].returncode != both[1].returncode:
                wrong.append(f"s390x {drive}: exit code {both[1].returncode}, here {both[0].returncode}")
                continue
            records = [json.loads(run.stdout) for run in both]
            top = max(abs(records[0][key] or 0.0) for key in ("mean_speed", "min_speed", "max_speed"))
            for key, value in records[0].items():
                other = records[1][key]
                if key.endswith("_error") and isinstance(value, float) and isinstance(other, float):
                    if not value / 30 - 1e-12 * top <= other <= 30 * value + 1e-12 * top:
                        wrong.append(f"s390x {drive}: {key} is {other!r}, here {value!r}")
                elif isinstance(value, float) and isinstance(other, float):
                    bound = 1e-9 * top if key.endswith("_speed") else 1e-9 * abs(value)
                    if not math.isclose(value, other, rel_tol=1e-12, abs_tol=bound):
                        wrong.append(f"s390x {drive}: {key} is {other!r}, here {value!r}")
                elif value != other:
                    wrong.append(f"s390x {drive}: {key} is {other!r}, here {value!r}")
    return wrong


def _warnings() -> list[str]:
    compilers = [name for name in PLUS if shutil.which(name)]
    print(f"warnings: {', '.join(compilers)}; {', '.join((*C, *CPP))}")
    wrong, met = warnings(compilers)
    for line, count in sorted(met.items()):
        print(f"  named exception, {count} times: {line}")
    return wrong


PARTS: dict[str, Callable[[], list[str]]] = {
    "warnings": _warnings,
    "memory": memory,
    "threads": threads,
    "big-endian": big_endian,
}


def main(parts: list[str]) -> int:
    """Run the parts, print what they find."""
    bad = 0
    for part in parts or PARTS:
        wrong = PARTS[part]()
        bad += len(wrong)
        print(f"{part}: {len(wrong)} found", *wrong, sep="\n  ", flush=True)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
