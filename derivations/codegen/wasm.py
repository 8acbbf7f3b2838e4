"""The C library as WebAssembly, for the report's interactive part: compiles it, and says when it is stale.

The module is checked in with ``motor.json`` beside it, which has compiler, flags and a hash of every source, so that a
report needs no compiler and a stale module is noticed without one.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

__all__ = ["MODULE", "RECORD", "build", "command", "stale"]

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "trum_sym" / "report" / "interactive"
MODULE = FOLDER / "motor.wasm"
RECORD = FOLDER / "motor.json"

_COMPILER = "clang"
_FLAGS = (
    "--target=wasm32-wasi",
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-Wall",
    "-Wextra",
    "-Wno-unused-function",
    "-Igenerated",
    "-Itrum_sym/_driver",
    "-nostartfiles",
    "-Wl,--no-entry",
    "-Wl,--strip-all",
    "-Wl,--gc-sections",
)
_ENTRY = "trum_sym/_driver/trum_browser.c"


def _units() -> list[str]:
    """The C files that are compiled, from the root."""
    return [_ENTRY, *sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "generated").glob("trum_*.c"))]


def _hashes(names: Iterable[str]) -> dict[str, str]:
    """SHA-256 by name; empty for a file that is gone."""
    found = {name: (ROOT / name).read_bytes() if (ROOT / name).is_file() else b"" for name in names}
    return {name: hashlib.sha256(text).hexdigest() if text else "" for name, text in found.items()}


def _first_line(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]


def _read_by(compiler: str) -> list[str]:
    """Every file of the tree that the compiler reads, from the root."""
    found: set[str] = set()
    for unit in _units():
        rule = subprocess.run(
            [compiler, *_FLAGS, "-Qunused-arguments", "-MM", unit], cwd=ROOT, capture_output=True, text=True, check=True
        )
        found |= set(rule.stdout.replace("\\\n", " ").split(":", 1)[1].split())
    return sorted(found)


def _compile() -> tuple[bytes, str, list[str]]:
    """The module's bytes, the compiler's version and what it has read.

    Raises
    ------
    FileNotFoundError
        If there is no compiler.
    RuntimeError
        If it fails; the message is what it says.
    """
    compiler = shutil.which(_COMPILER)
    if compiler is None:
        raise FileNotFoundError(
            f"{_COMPILER} is not here; on Debian: apt-get install clang lld wasi-libc libclang-rt-dev-wasm32"
        )
    version = _first_line(compiler, "--version")
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / MODULE.name
        done = subprocess.run([compiler, *_FLAGS, *_units(), "-o", target], cwd=ROOT, capture_output=True, text=True)
        if done.returncode or done.stderr:
            raise RuntimeError(f"{_COMPILER} fails:\n{done.stderr}")
        return target.read_bytes(), version, _read_by(compiler)


def _libc() -> str:
    """The package of the C library, whose mathematics is in the module."""
    if shutil.which("dpkg-query") is None:
        return "unknown"
    return _first_line("dpkg-query", "-Wf", "${Package} ${Version}\n", "wasi-libc")


def build() -> None:
    """Compile the module and record what it was made of."""
    module, version, read = _compile()
    record = {
        "module": hashlib.sha256(module).hexdigest(),
        "compiler": version,
        "libc": _libc(),
        "flags": list(_FLAGS),
        "sources": _hashes(read),
    }
    MODULE.write_bytes(module)
    RECORD.write_text(json.dumps(record, indent=1) + "\n", "utf-8")


def stale() -> list[str]:
    """What of the module no longer fits its record, a line each; needs no compiler."""
    record: dict[str, Any] = json.loads(RECORD.read_text("utf-8"))
    found = []
    if hashlib.sha256(MODULE.read_bytes()).hexdigest() != record["module"]:
        found.append(f"{MODULE.name} is not the module that {RECORD.name} records")
    if list(_FLAGS) != record["flags"]:
        found.append("it was compiled with other flags")
    now = _hashes(record["sources"])
    found += [f"{name} has changed" for name, then in record["sources"].items() if now[name] != then]
    return found + [f"{name} is new" for name in _units() if name not in now]


def command(check: bool) -> int:
    """``python -m derivations wasm``; returns the exit code."""
    if check:
        problems = stale()
        if problems:
            print("\n".join(problems))
            print(f"{MODULE.name} is stale: run `python -m derivations wasm` and commit it", file=sys.stderr)
            return 1
        print(f"{MODULE.name} is made of what is here")
        return 0
    try:
        build()
    except (FileNotFoundError, RuntimeError) as error:
        print(f"derivations: {error}", file=sys.stderr)
        return 1
    print(f"{MODULE.name}: {MODULE.stat().st_size} bytes")
    return 0
