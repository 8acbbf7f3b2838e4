"""The extension's C++ for other processors, systems and compilers: what compiles, and figures where it runs.

python -m studies.targets [NAME ...] [--points N]

gcc, clang        this machine's; clang with -mno-avx, as for a processor without AVX
plain             gcc without vector types, as MSVC has none (lanes_plain.hpp)
the others        by zig (`pip install ziglang`); those for aarch64 run under qemu (apt-get install qemu-user-static),
                  those for Windows and macOS are linked and not run

Orbits of N random points on every instruction set are compared with gcc's baseline: speeds within the sum of both
stated errors, or the last digits.  Where the headers of this Python and NumPy fit (64-bit Linux), the module's own
source is compiled too.  The exit code is 1 if anything was found.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import trum_sym as ts
from studies.c_matrix import EXTENSION, FOLDERS, ROOT
from studies.orbit import samples
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.kernels import signature
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare

FLAGS = ("-std=c++17", "-ffp-contract=off", "-O3", "-fno-math-errno", "-fno-trapping-math", "-Wno-psabi")
ZIG = (sys.executable, "-m", "ziglang", "c++")
SPEEDS = ("mean", "low", "high")


@dataclass(frozen=True)
class Target:
    """A compiler with its flags; what runs its programs, None if nothing here does; whether Python's headers fit."""

    compiler: tuple[str, ...]
    flags: tuple[str, ...] = ()
    run: tuple[str, ...] | None = ()
    x86: bool = True  # has the copies for AVX2 and AVX-512
    module: bool = True


def _zig(triple: str, run: tuple[str, ...] | None, module: bool = True) -> Target:
    static = ("-static",) if "musl" in triple else ()
    return Target((*ZIG, "-target", triple), static, run, triple.startswith("x86_64"), module)


_QEMU = ("qemu-aarch64-static",)
TARGETS = {
    "gcc": Target(("g++",)),
    "clang -mno-avx": Target(("clang++",), ("-mno-avx",)),
    "plain": Target(("g++",), ("-DTRUM_PLAIN_LANES",), x86=False),
    "x86_64-linux-gnu.2.28": _zig("x86_64-linux-gnu.2.28", ()),
    "x86_64-linux-musl": _zig("x86_64-linux-musl", ()),
    "aarch64-linux-musl": _zig("aarch64-linux-musl", _QEMU),
    "aarch64-linux-gnu.2.28": _zig("aarch64-linux-gnu.2.28", None),
    "x86_64-windows-gnu": _zig("x86_64-windows-gnu", None, module=False),
    "aarch64-windows-gnu": _zig("aarch64-windows-gnu", None, module=False),
    "x86_64-macos": _zig("x86_64-macos", None, module=False),
    "aarch64-macos": _zig("aarch64-macos", None, module=False),
}


def missing(target: Target) -> str:
    """The first tool of a target that is not here."""
    if target.compiler[: len(ZIG)] == ZIG and importlib.util.find_spec("ziglang") is None:
        return "ziglang"
    if platform.machine() != "x86_64" and target.run == () and target.x86:
        return "processor of x86-64"
    tools = (target.compiler[0], *(target.run or ())[:1])
    return next((tool for tool in tools if shutil.which(tool) is None), "")


def compiled(folder: Path, target: Target) -> Path:
    """The program studies/targets.cpp for a target, and the module's own source as an object file.

    Raises
    ------
    subprocess.CalledProcessError
        If the compiler fails; its output says why.
    """
    zig = target.compiler[: len(ZIG)] == ZIG  # its library of C++ takes minutes to build, and the orbits use none
    defined = ["-DTRUM_X86_ORBITS"] if target.x86 else []
    include = [f"-I{place}" for place in FOLDERS]

    def run(*words: str) -> None:
        done = subprocess.run([*target.compiler, *words], cwd=ROOT, capture_output=True, text=True)
        if done.returncode:
            raise subprocess.CalledProcessError(done.returncode, words, done.stdout, done.stderr)

    objects = []
    for name in ("studies/targets.cpp", *(f"trum_sym/_driver/{name}.cpp" for name in EXTENSION if "orbit" in name)):
        source = Path(name)
        features = EXTENSION.get(source.stem, ())
        if features and not target.x86:
            continue
        of_set = (*features, "-ffp-contract=fast") if features else ()
        objects.append(str(folder / f"{source.stem}.o"))
        run(*FLAGS, *target.flags, *of_set, *defined, *include, "-c", name, "-o", objects[-1])
    for path in sorted((ROOT / "generated").glob("trum_*.c")):
        objects.append(str(folder / f"{path.stem}.o"))
        words = ("-x", "c", "-std=c99", "-O2", "-ffp-contract=off", *target.flags, *include, "-c", str(path))
        run(*words, "-o", objects[-1])
    if target.module:
        python = (f"-isystem{sysconfig.get_path('include')}", f"-isystem{np.get_include()}")
        if sysconfig.get_config_var("MULTIARCH"):  # Debian's pyconfig.h asks for the machine's; 64 bits are 64 bits
            python = (
                f"-isystem{Path(sysconfig.get_path('include')).parent / sysconfig.get_config_var('MULTIARCH')}",
                *python,
            )
        stable = ("-DPy_LIMITED_API=0x030B0000", "-DNPY_NO_DEPRECATED_API=NPY_2_0_API_VERSION")
        run(
            *FLAGS,
            *target.flags,
            *stable,
            *defined,
            *include,
            *python,
            "-c",
            "trum_sym/_driver/ufuncs.cpp",
            "-o",
            str(folder / "ufuncs.o"),
        )
    program = folder / "targets"
    run(*objects, *target.flags, *(("-nostdlib++",) if zig else ()), "-o", str(program))
    return program


def points(count: int) -> str:
    """Arguments of the orbits of random points, a line each."""
    lines = []
    with unquestioned(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for sample in samples(count):
            motor, drive = ts.load_motor().with_values(sample.motor), ts.Drive(**sample.drive)
            given = prepare(motor, drive, Levels(), 1e-3).arguments
            lines.append(" ".join(float(given[name]).hex() for name in signature("rotor_orbit")[0]))
    return "\n".join(lines) + "\n"


def orbits(target: Target, program: Path, given: str) -> dict[str, np.ndarray]:
    """Outputs by instruction set, a row a point."""
    assert target.run is not None
    done = subprocess.run([*target.run, str(program)], input=given, capture_output=True, text=True, check=True)
    found: dict[str, list[list[float]]] = {}
    for line in done.stdout.splitlines():
        name, *numbers = line.split()
        found.setdefault(name, []).append([float("nan") if "nan" in x else float.fromhex(x) for x in numbers])
    return {name: np.array(rows) for name, rows in found.items()}


def differences(rows: np.ndarray, expected: np.ndarray) -> list[str]:
    """Points at which a speed is further from the expected one than both errors and rounding allow."""
    names = signature("rotor_orbit")[1]
    of = {name: k for k, name in enumerate(names)}
    largest = np.maximum(np.abs(expected[:, of["low"]]), np.abs(expected[:, of["high"]]))
    found = []
    if rows.shape != expected.shape:
        return [f"{len(rows)} points instead of {len(expected)}"]
    for name in SPEEDS:
        off = np.abs(rows[:, of[name]] - expected[:, of[name]])
        allowed = rows[:, of[f"{name}_error"]] + expected[:, of[f"{name}_error"]] + 1e-13 * largest
        same = np.isnan(rows[:, of[name]]) & np.isnan(expected[:, of[name]])
        found += [f"point {k}: {name} is off by {off[k]:.3g} m/s" for k in np.flatnonzero(~(same | (off <= allowed)))]
    return found


def main(arguments: Iterable[str]) -> int:
    """Compile, run and compare; the exit code."""
    parser = argparse.ArgumentParser(prog="python -m studies.targets", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(TARGETS))
    parser.add_argument("--points", type=int, default=300, metavar="N", help="how many points")
    options = parser.parse_args(list(arguments))
    if unknown := [name for name in options.names if name not in TARGETS]:
        parser.error(f"{unknown[0]!r} is none of {', '.join(TARGETS)}")
    given, expected, bad = points(options.points), None, 0
    for name in dict.fromkeys(["gcc", *(options.names or TARGETS)]):
        target = TARGETS[name]
        if tool := missing(target):
            print(f"*** NOT DONE FOR {name}: no {tool} here ***", flush=True)
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                program = compiled(Path(folder), target)
            except subprocess.CalledProcessError as error:
                print(f"{name}: does not compile\n{error.stderr[:2000]}", flush=True)
                bad += 1
                continue
            size = os.path.getsize(program)
            if target.run is None:
                print(f"{name}: compiled and linked, {size} bytes; not run", flush=True)
                continue
            found = orbits(target, program, given)
        expected = found["orbit_baseline"] if expected is None else expected
        for code, rows in found.items():
            wrong, same = (
                differences(rows, expected),
                int(((rows == expected) | np.isnan(rows) & np.isnan(expected)).all(axis=1).sum()),
            )
            bad += len(wrong)
            print(
                f"{name}, {code}: {len(rows)} points, {same} to the last bit, {len(wrong)} off",
                *wrong[:5],
                sep="\n  ",
                flush=True,
            )
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
