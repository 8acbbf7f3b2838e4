"""The C library on machines without an operating system: built, run under qemu, compared with the PC, measured.

python -m studies.metal [PART ...] [--points N]

builds       `make` of the exported folder, a folder in float and one pair in double: gcc, clang, arm-none-eabi-gcc with
             newlib and picolibc, riscv64-unknown-elf-gcc; every warning is an error
points       N points of examples/metal/points.csv on every machine: figures within their errors of the PC's double
functions    instructions of single functions, flash, RAM and stack
clean        no globals, no heap, no recursion, no double in a float build: read from the object files
precision    all points in float on the PC: how far each figure is from the double one
controller   examples/controller on the emulated Cortex-M4F
narrow       a compiler whose double has 32 bits (a C28x): refused, or right where the build is float
points.csv   makes that file anew: the points' inputs and what the PC's double says at a tolerance of 1e-7

Without the compilers a part says loudly what is missing, and does not count as done.  The exit code is 1 where
anything was found.
"""

from __future__ import annotations

import argparse
import csv
import math
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
METAL = ROOT / "examples" / "metal"
KEPT = METAL / "points.csv"
PACKAGES = (
    "gcc-arm-none-eabi libnewlib-arm-none-eabi picolibc-arm-none-eabi qemu-system-arm "
    "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf qemu-system-misc"
)
NUMBERS = ("prepressure", "frequency_difference", "load_torque", "switching_phase", "on_periods", "phase_lead")
INPUTS = (*NUMBERS, "start", "contact")
COUNTED = ("point", "status", "steps", "instructions", "stack")
SPEEDS = ("mean_speed", "min_speed", "max_speed")
BOUNDED = (*SPEEDS, "speed_volatility", "stall_torque")
# What figures without a bound of their own may be off by in float, as `measured` scales them; `precision` measures it
SHARE, CANCELLING, QUOTIENT = 1e-3, 1e-4, 1e-3


def measured(name: str, row: dict[str, float]) -> tuple[float, str]:
    """A figure over what its error is measured by: sums that may cancel by what they are sums of."""
    value = row[name]
    if name in SPEEDS:
        return value / (max(abs(row[speed]) for speed in SPEEDS) or 1.0), "the largest speed"
    if name.endswith("_ratio"):
        return (value / (1 + value) if math.isfinite(value) else 1.0), "both parts"
    if name == "q_average":
        return value * row["cycle_time"], "1 over the cycle time"
    if name == "q_volatility":
        return value * row["q_average"] * row["cycle_time"] ** 2, "Q_aver and the cycle time"
    if name == "stall_torque":
        return value, "1 N m"
    return value, "itself"


@dataclass(frozen=True)
class Machine:
    """A compiler with its flags and how its programs run; bits of the library's number."""

    compiler: str
    flags: tuple[str, ...]
    link: tuple[str, ...]
    run: tuple[str, ...]
    bits: int
    every: int = 1  # of the points that are wanted it evaluates one in so many: emulation takes its time


def _memory(flash: str, ram: str) -> tuple[str, ...]:
    places = {"__flash": flash, "__flash_size": "0x00400000", "__ram": ram, "__ram_size": "0x00400000"}
    return tuple(f"-Wl,--defsym={name}={at}" for name, at in places.items())


def _arm(cpu: str, fpu: str, board: str, bits: int, every: int) -> Machine:
    flags = (f"-mcpu={cpu}", "-mthumb", f"-mfpu={fpu}", "-mfloat-abi=hard", "--specs=picolibc.specs")
    run = ("qemu-system-arm", "-M", board, *_QEMU)
    return Machine("arm-none-eabi-gcc", flags, (*_HOSTED, *_memory("0x00000000", "0x20000000")), run, bits, every)


def _newlib(machine: Machine, every: int) -> Machine:
    flags = (*machine.flags[:-1], "--specs=rdimon.specs")
    link = (f"-T{METAL / 'newlib.ld'}", str(METAL / "newlib_reset.c"))
    return Machine(machine.compiler, flags, link, machine.run, machine.bits, every)


def _riscv(isa: str, abi: str, bits: int, every: int) -> Machine:
    flags = (f"-march={isa}", f"-mabi={abi}", "--specs=picolibc.specs")
    run = ("qemu-system-riscv32", "-M", "virt", "-bios", "none", *_QEMU)
    return Machine("riscv64-unknown-elf-gcc", flags, (*_HOSTED, *_memory("0x80000000", "0x80400000")), run, bits, every)


_QEMU = ("-semihosting-config", "enable=on", "-nographic", "-monitor", "none", "-icount", "shift=0", "-kernel")
_HOSTED = ("--oslib=semihost", "--crt0=hosted")
MACHINES = {
    "Cortex-M4F, float": _arm("cortex-m4", "fpv4-sp-d16", "mps2-an386", 32, 1),
    "Cortex-M4F, float, newlib": _newlib(_arm("cortex-m4", "fpv4-sp-d16", "mps2-an386", 32, 1), 10),
    "Cortex-M7, float": _arm("cortex-m7", "fpv5-d16", "mps2-an500", 32, 10),
    "RV32IMAFC, float": _riscv("rv32imafc", "ilp32f", 32, 50),
    "Cortex-M7, double": _arm("cortex-m7", "fpv5-d16", "mps2-an500", 64, 50),
    "RV32IMAFDC, double": _riscv("rv32imafdc", "ilp32d", 64, 100),
    "Cortex-M4F, double": _arm("cortex-m4", "fpv4-sp-d16", "mps2-an386", 64, 1000),
}
PC = Machine("cc", (), (), (), 64)
CAREFUL = ("-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-pedantic", "-Werror")
STRICT = ("-std=c99", "-O2", "-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections")


def missing(machine: Machine) -> str:
    """The first tool of a machine that is not here."""
    tools = (machine.compiler, *machine.run[:1])
    return next((tool for tool in tools if shutil.which(tool) is None), "")


def here(machines: dict[str, Machine]) -> dict[str, Machine]:
    """Those machines whose tools are here; says loudly which are not."""
    for name, machine in machines.items():
        if tool := missing(machine):
            print(f"*** NOT RUN ON {name}: no {tool} here (apt-get install {PACKAGES}) ***", flush=True)
    return {name: machine for name, machine in machines.items() if not missing(machine)}


# --- Points ---------------------------------------------------------------------------------------


def drawn(count: int, seed: int = 20211110) -> list[dict[str, float]]:
    """Points over the box in which the paper's figures lie, with every start and both contacts; exact in float."""
    rng = random.Random(seed)

    def whole(low: float, high: float, parts: int) -> float:
        return low + (high - low) * rng.randrange(parts + 1) / parts

    points = []
    for k in range(count):
        points.append(
            {
                "prepressure": whole(120, 220, 128),
                "frequency_difference": whole(1000, 5000, 512),
                "load_torque": whole(-0.3125, 0.3125, 640),
                "switching_phase": whole(0, 6, 96),
                "on_periods": rng.randint(10, 19),
                "phase_lead": rng.choice((-1, 1)),
                "start": k % 3,
                "contact": k // 3 % 2,
            }
        )
    return points


def header(points: Sequence[dict[str, float]]) -> str:
    """``points.h`` of examples/metal."""
    members = " ".join(f"{'float' if name in NUMBERS else 'int'} {name};" for name in INPUTS)
    rows = ",\n".join(
        "  {" + ", ".join(f"{p[n]!r}f" if n in NUMBERS else f"{p[n]:.0f}" for n in INPUTS) + "}"
        for p in ({name: float(value) for name, value in point.items()} for point in points)
    )
    return (
        f"#define POINT_COUNT {len(points)}L\nstatic const struct {{ {members} }} points[POINT_COUNT] = {{\n{rows}}};\n"
    )


def kept(count: int) -> list[dict[str, float]]:
    """The first points of ``points.csv``."""
    with KEPT.open(newline="") as file:
        rows = [row for row, _ in zip(csv.DictReader(file), range(count), strict=False)]
    return [{name: float(value) for name, value in row.items()} for row in rows]


def library(folder: Path, bits: int, *, fixed: bool = False) -> Path:
    """The exported pair for a type of number."""
    from trum_sym.c_library.export import BITS, exported, write_folder
    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.motor_file import load_motor

    real = next(name for name, wide in BITS.items() if wide == bits)
    target = folder / f"library{bits}{'f' * fixed}"
    if not target.exists():
        write_folder("DIR", exported(load_motor(), Drive(), {}, real=real, fixed=fixed, single=True), target)
    return target


def program(folder: Path, machine: Machine, source: str, *flags: str, fixed: bool = False) -> Path:
    """A program of examples/metal for a machine."""
    place = library(folder, machine.bits, fixed=fixed)
    target = folder / f"{Path(source).stem}-{abs(hash((machine, flags, fixed)))}"
    sources = [METAL / source if not Path(source).is_absolute() else source, place / "trum.c"]
    paths = [f"-I{path}" for path in (place, METAL, folder)]
    command = [machine.compiler, *STRICT, *machine.flags, *machine.link, *flags, *paths, *sources, "-lm", "-o", target]
    subprocess.run(list(map(str, command)), check=True)
    return target


def ran(machine: Machine, ready: Path, limit: float) -> list[str]:
    """The lines that a program prints."""
    done = subprocess.run(
        [*machine.run, str(ready)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=limit,
        stdin=subprocess.DEVNULL,
        check=True,
    )
    return done.stdout.splitlines()


def evaluated(
    folder: Path, machine: Machine, points: Sequence[dict[str, float]], *flags: str
) -> list[dict[str, float]]:
    """What a machine says of points."""
    from trum_sym.quantities import ERRORS, QUANTITIES

    (folder / "points.h").write_text(header(points))
    names = (*COUNTED, *QUANTITIES, *ERRORS)
    lines = ran(machine, program(folder, machine, "points.c", *flags), 60 + 20.0 * len(points))
    rows = [dict(zip(names, map(float, line.split(",")), strict=True)) for line in lines]
    if len(rows) != len(points):
        raise RuntimeError(f"{machine.compiler}: {len(rows)} points answered of {len(points)}")
    return rows


def compared(ours: dict[str, float], exact: dict[str, float]) -> list[str]:
    """Figures that are further from the double ones than their stated errors, or than the share of those without."""
    from trum_sym.quantities import QUANTITIES

    if ours["status"] != exact["status"] and not {ours["status"], exact["status"]} <= {0.0, 6.0}:
        return [f"status {ours['status']:.0f}, in double {exact['status']:.0f}"]
    wrong = []
    for name in QUANTITIES:
        a, b = ours[name], exact[name]
        if math.isnan(b) or math.isinf(ours.get(f"{name}_error", 0.0)):
            continue
        if name in BOUNDED:
            allowed = ours[f"{name}_error"] + exact[f"{name}_error"] + 1e-6 * abs(b)
        else:
            (a, of), b = measured(name, ours), measured(name, exact)[0]
            allowed = SHARE * abs(b) if of == "itself" else CANCELLING
            if name == "q_volatility":  # divided by Q_aver, which may be all but nothing
                allowed = QUOTIENT * max(1.0, abs(b))
        if not abs(a - b) <= allowed:
            wrong.append(f"{name} {a:.9g}, in double {b:.9g}, allowed {allowed:.2g}")
    return wrong


def make_points(count: int) -> list[str]:
    """Writes ``points.csv``."""
    points = drawn(count)
    with tempfile.TemporaryDirectory() as name:
        rows = evaluated(Path(name), PC, points, "-DTOLERANCE=1e-7")
    figures = [key for key in rows[0] if key not in ("instructions", "stack", "steps")]
    with KEPT.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["point", *INPUTS, *figures[1:]])
        for k, (point, row) in enumerate(zip(points, rows, strict=True)):
            writer.writerow([k, *(f"{point[n]:.9g}" for n in INPUTS), *(f"{row[n]:.9g}" for n in figures[1:])])
    return []


def on_machines(count: int) -> list[str]:
    """Points on every machine beside the PC's double."""
    wrong = []
    for name, machine in here(MACHINES).items():
        own = kept(max(1, count // machine.every))
        with tempfile.TemporaryDirectory() as folder:
            rows = evaluated(Path(folder), machine, own)
        found = [f"{name}, point {k}: {text}" for k, (row, exact) in enumerate(zip(rows, own, strict=True))
                 for text in compared(row, exact)]  # fmt: skip
        counts = sorted(row["instructions"] for row in rows)
        print(
            f"  {name}: {len(rows)} points, {len(found)} beyond their errors; million instructions: median "
            f"{counts[len(counts) // 2] / 1e6:.1f}, most {counts[-1] / 1e6:.1f}; most steps "
            f"{max(row['steps'] for row in rows):.0f}; stack {max(row['stack'] for row in rows):.0f} B; "
            f"{sum(row['status'] != 0 for row in rows)} not converged",
            flush=True,
        )
        wrong += found
    return wrong


def precision(count: int) -> list[str]:
    """Float on the PC beside double: the largest and the median difference of each figure."""
    from trum_sym.quantities import QUANTITIES

    own = kept(count)
    with tempfile.TemporaryDirectory() as folder:
        rows = evaluated(Path(folder), Machine("cc", (), (), (), 32), own)
    print(f"  {len(rows)} points in float at its finest tolerance, {sum(r['status'] != 0 for r in rows)} not converged")
    print("  figure                  median     most  of")
    for name in QUANTITIES:
        pairs = [(measured(name, row), measured(name, exact)[0]) for row, exact in zip(rows, own, strict=True)]
        errors = [abs(a - b) / (abs(b) if of == "itself" else 1.0) for (a, of), b in pairs if not math.isnan(b)]
        errors = sorted(error for error in errors if not math.isnan(error))
        print(f"  {name:22} {errors[len(errors) // 2]:8.1e} {errors[-1]:8.1e}  {pairs[0][0][1]}")
    return [
        f"float, point {k}: {text}"
        for k, (row, exact) in enumerate(zip(rows, own, strict=True))
        for text in compared(row, exact)
    ]


# --- What a build holds ---------------------------------------------------------------------------


def size(machine: Machine, ready: Path) -> tuple[int, int]:
    """Flash and RAM that a program takes, without its stack."""
    tool = machine.compiler.replace("gcc", "size")
    said = subprocess.run([tool, ready], capture_output=True, text=True, check=True).stdout.splitlines()[1]
    text, data, bss = map(int, said.split()[:3])
    return text + data, data + bss


EMPTY = "int main(void) { return 0; }\n"
USES = {
    "nothing": EMPTY,
    "kernels": (
        '#include "trum.h"\n#include "motor.h"\nint main(void) {{ trum_real v[64] = {{1}}; '
        "const trum_real* a[64]; trum_real* r[64]; int k;"
        " for (k = 0; k < 64; ++k) a[k] = &v[k], r[k] = &v[k];\n{calls}return v[3] > 0; }}\n"
    ),
    "determinants": (
        '#include "trum.h"\n#include "motor.h"\nint main(void) { struct trum_point p; '
        "return (int)trum_evaluate_determinants(&my_motor, &my_drive, &p) + (p.q_average > 0); }\n"
    ),
    "evaluate": (
        '#include "trum.h"\n#include "motor.h"\nint main(void) { struct trum_point p; '
        "return (int)trum_evaluate(&my_motor, &my_drive, &p) + (p.mean_speed > 0); }\n"
    ),
}


def of_a_point() -> list[str]:
    """The kernels that the driver calls for an operating point."""
    from trum_sym.c_library.sources import amalgamated
    from trum_sym.c_library.sources import library as texts

    body = amalgamated(texts())["trum.c"]
    left_out = ("_slopes", "_coupled_", "_limit")  # of sensitivities, of the coupled wave, of a float's domain
    return [n for n in re.findall(r"^int (trum_\w+)\(", body, re.M) if not any(word in n for word in left_out)]


def functions(count: int) -> list[str]:
    """Flash, RAM, stack and instructions, as the table of the docs."""
    del count
    calls = "".join(f"  (void){name}(a, r, 0, 0, 0);\n" for name in of_a_point())
    rows = []
    for name, machine in here(MACHINES).items():
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            sizes = {}
            for use, text in USES.items():
                (folder / f"{use}.c").write_text(text.format(calls=calls) if use == "kernels" else text)
                sizes[use] = size(machine, program(folder, machine, str(folder / f"{use}.c")))
            flash = {use: sizes[use][0] - sizes["nothing"][0] for use in sizes}
            lean = program(folder, machine, str(folder / "evaluate.c"), fixed=True)
            lines = ran(machine, program(folder, machine, "functions.c"), 300)
            counts = {line.split(",")[0]: float(line.split(",")[1]) for line in lines}
            ram = sizes["evaluate"][1] - sizes["nothing"][1]
            cells = [
                *(f"{flash[use] / 1e3:.1f}" for use in ("kernels", "determinants", "evaluate")),
                f"{(size(machine, lean)[0] - sizes['nothing'][0]) / 1e3:.1f}",
                f"{ram}",
                f"{deepest(folder, machine)}",
                *(f"{counts[kernel]:.0f}" for kernel in ("trum_wave", "trum_friction")),
                f"{counts['trum_evaluate_determinants'] / 1e6:.2f}",
                f"{counts['trum_evaluate'] / 1e6:.1f}",
            ]
            rows.append(f"| {name} | {' | '.join(cells)} |")
            print(rows[-1], flush=True)
    return []


def frames(folder: Path, machine: Machine) -> tuple[dict[str, int], dict[str, set[str]]]:
    """The frame of every function of the library in bytes, and what it calls."""
    place = library(folder, machine.bits)
    command = [
        machine.compiler,
        *STRICT[:2],
        *machine.flags,
        "-fno-pie",
        "-fcallgraph-info=su",
        f"-I{place}",
        "-c",
        place / "trum.c",
    ]
    subprocess.run([*map(str, command), "-o", "graph.o"], check=True, cwd=folder)
    text = next(folder.glob("graph*.ci")).read_text()
    sizes, calls = {}, {}
    for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"', text):
        frame = re.search(r"(\d+) bytes \((static|dynamic,bounded|dynamic)\)", label)
        sizes[title], calls[title] = int(frame[1]) if frame else 0, set()
    for caller, callee in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
        calls.setdefault(caller, set()).add(callee)
    # the only functions that are called through pointers: what a root is looked for of
    calls["__indirect_call"] = {
        name for name in sizes if name.split(":")[-1] in ("trum_balance_at", "trum_determinant_at")
    }
    return sizes, calls


def deepest(folder: Path, machine: Machine) -> int:
    """The most stack that trum_evaluate's own frames take; the C library's mathematics comes on top.

    Raises
    ------
    RecursionError
        If a function can call itself.
    """
    sizes, calls = frames(folder, machine)
    known: dict[str, int] = {}

    def depth(name: str, above: tuple[str, ...]) -> int:
        if name in above:
            raise RecursionError(f"{name} can call itself")
        if name not in known:
            known[name] = sizes.get(name, 0) + max((depth(to, (*above, name)) for to in calls.get(name, ())), default=0)
        return known[name]

    return depth(next(name for name in sizes if name.split(":")[-1] == "trum_evaluate"), ())


FORBIDDEN = {"malloc", "calloc", "realloc", "free", "printf", "stdout", "errno", "abort"}


def clean(count: int) -> list[str]:
    """What the object files hold that they must not."""
    del count
    wrong = []
    for name, machine in {"the PC, double": PC, **here(MACHINES)}.items():
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            try:
                print(f"  {name}: at most {deepest(folder, machine)} B of frames, no recursion")
            except RecursionError as error:
                wrong.append(f"{name}: {error}")
            tool = "nm" if machine is PC else machine.compiler.replace("gcc", "nm")
            symbols = subprocess.run([tool, folder / "graph.o"], capture_output=True, text=True, check=True).stdout
        for line in symbols.splitlines():
            kind, symbol = line.split()[-2:]
            doubled = machine.bits == 32 and re.match(r"__aeabi_(d|.*2d)|__\w+df\d?$|__extendsf|__trunc", symbol)
            if kind in "bBdDC" or symbol in FORBIDDEN or doubled:
                wrong.append(f"{name}: {line}")
    return wrong


# --- Builds ---------------------------------------------------------------------------------------

_M4F = ("-O2", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
BUILDS = {
    "gcc": ("gcc", ("-O2",), ()),
    "clang": ("clang", ("-O2",), ()),
    "arm-none-eabi-gcc, newlib": ("arm-none-eabi-gcc", _M4F, ("--specs=rdimon.specs",)),
    "arm-none-eabi-gcc, picolibc": (
        "arm-none-eabi-gcc", (*_M4F, "--specs=picolibc.specs"), (*_HOSTED, *_memory("0x00000000", "0x20000000")),
    ),
    "riscv64-unknown-elf-gcc, picolibc": (
        "riscv64-unknown-elf-gcc", ("-O2", "-march=rv32imafc", "-mabi=ilp32f", "--specs=picolibc.specs"),
        (*_HOSTED, *_memory("0x80000000", "0x80400000")),
    ),
}  # fmt: skip


def builds(count: int) -> list[str]:
    """`make` of the exported folder under every compiler."""
    del count
    from trum_sym.c_library.export import exported, write_folder
    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.motor_file import load_motor

    wrong = []
    for name, (compiler, flags, link) in BUILDS.items():
        if shutil.which(compiler) is None:
            print(f"*** NOT BUILT BY {name}: no {compiler} here (apt-get install {PACKAGES} clang) ***", flush=True)
            continue
        for real, single in (("float", False), ("double", True)):
            with tempfile.TemporaryDirectory() as folder:
                target = Path(folder) / "library"
                write_folder("DIR", exported(load_motor(), Drive(), {}, real=real, single=single), target)
                command = ["make", "-s", f"CC={compiler}", f"CFLAGS={' '.join(flags)}", f"LDFLAGS={' '.join(link)}"]
                done = subprocess.run(command, cwd=target, capture_output=True, text=True)
            told = [line for line in done.stderr.splitlines() if "warning:" in line or "error:" in line]
            if done.returncode or [line for line in told if "is not implemented and will always fail" not in line]:
                wrong.append(f"{name}, {real}: exit code {done.returncode}: {done.stderr[-300:]}")
        print(f"  {name}: built", flush=True)
    return wrong


# A compiler whose double is float, as the C28x's with COFF is: the standard headers keep theirs
NARROW = "".join(f"#include <{name}.h>\n" for name in ("float", "limits", "math", "stdint", "stdio", "string"))
NARROW += "#define double float\n"


def narrow(count: int) -> list[str]:
    """Double under the name of float, on the PC."""
    wrong = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "narrow.h").write_text(NARROW)
        own = kept(min(count, 200))
        (folder / "points.h").write_text(header(own))
        flags = ("-include", str(folder / "narrow.h"))
        place = library(folder, 64)
        refused = subprocess.run(
            ["cc", *STRICT[:2], *flags, f"-I{place}", "-fsyntax-only", place / "trum.c"], capture_output=True, text=True
        )
        if refused.returncode == 0 or "other_bits_than_TRUM_REAL_BITS" not in refused.stderr:
            wrong.append(f"double of 32 bits is not refused: {refused.stderr[-200:]}")
        rows = evaluated(folder, Machine("cc", flags, (), (), 32), own)
        wrong += [
            f"narrow, point {k}: {t}" for k, (r, e) in enumerate(zip(rows, own, strict=True)) for t in compared(r, e)
        ]
        fine = evaluated(folder, Machine("cc", flags, (), (), 32), own[:2], "-DTOLERANCE=1e-6")
        if any(row["status"] != 1 for row in fine):
            wrong.append("a tolerance that float cannot keep is not refused")
    print(f"  double of 32 bits: refused as double; {len(own)} points as float")
    return wrong


def controller(count: int) -> list[str]:
    """The controller's example on the Cortex-M4F: it has to bring the motor within 1 % of the speed that is wanted."""
    del count
    place, wrong = ROOT / "examples" / "controller", []
    for name, machine in here({name: MACHINES[name] for name in list(MACHINES)[:1]}).items():
        with tempfile.TemporaryDirectory() as temporary:
            ready = program(Path(temporary), machine, str(place / "main.c"), f"-I{place}", *CAREFUL)
            lines = ran(machine, ready, 120)
        print(f"  {name}:", *lines[-2:], sep="\n    ")
        if not lines[-1].startswith("off by 0.") or int(lines[-2].split()[-1]) > 1500:
            wrong.append(f"{name}: {lines[-2]}; {lines[-1]}")
    return wrong


PARTS: dict[str, Callable[[int], list[str]]] = {
    "builds": builds,
    "clean": clean,
    "narrow": narrow,
    "precision": precision,
    "controller": controller,
    "points": on_machines,
    "functions": functions,
    "points.csv": make_points,
}


def main(arguments: Iterable[str]) -> int:
    """Run the parts, print what they find."""
    parser = argparse.ArgumentParser(prog="python -m studies.metal", description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="PART", choices=[*PARTS, []], help=", ".join(PARTS))
    parser.add_argument("--points", type=int, default=1000, metavar="N", help="how many points")
    options = parser.parse_args(list(arguments))
    bad = 0
    for part in options.parts or [name for name in PARTS if name != "points.csv"]:
        print(f"{part}:", flush=True)
        wrong = PARTS[part](options.points)
        bad += len(wrong)
        print(f"{part}: {len(wrong)} found", *wrong[:20], sep="\n  ", flush=True)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
