"""The package at the lowest versions that it declares, and at the newest there are: install, import, a sample of tests.

python -m studies.versions lowest [FOLDER]        or newest

An environment is made in a temporary folder; pip's own index and settings are used.  The package is the wheel in
FOLDER, which `python -m studies.wheel FOLDER` leaves there, or is built from the source tree where none is named.
``lowest`` pins every dependency of the package and of its extras but ``derive`` and ``dev`` to the lower end of its
range; what those need in turn is as new as they allow.  The tests' own tools are those of the lock.  The exit code is
that of the tests, or 77 if these versions cannot be had, or not together.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EXTRAS = ("data", "optimize", "report", "sweep")
TOOLS = ("pytest", "pytest-xdist", "hypothesis", "mpmath")
SAMPLE = (
    "tests/test_values.py",
    "tests/output",
    "tests/inputs/test_reading.py",
    "tests/sweeps/test_sweep.py",
    "tests/optimiser/test_bad_optimise.py",
)


def declared() -> list[str]:
    """The requirements of the package and its extras."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    found = [*project["dependencies"], *(line for extra in EXTRAS for line in project["optional-dependencies"][extra])]
    return sorted({line for line in found if not line.startswith("trum-sym")})


def lowest(requirement: str) -> str:
    """A requirement pinned to the lower end of its range."""
    match = re.fullmatch(r"([\w.-]+)>=([\d.]+),<[\d.]+", requirement)
    if match is None:
        raise ValueError(f"{requirement}: a range NAME>=LOW,<HIGH is needed")
    return f"{match[1]}=={match[2]}"


def locked(names: tuple[str, ...]) -> list[str]:
    """The tests' tools as the lock has them."""
    lines = (ROOT / "requirements.lock").read_text("utf-8").splitlines()
    return [line.split(" ;")[0] for line in lines if line.partition("==")[0] in names]


def main(which: str = "", built: str = "") -> int:
    """Install, run, print versions; the exit code of the tests."""
    wheels = list(Path(built).resolve().glob("*.whl")) if built else [ROOT]
    if which not in ("lowest", "newest"):
        print(__doc__)
        return 2
    if len(wheels) != 1:
        print(f"{built}: got {len(wheels)} wheels, need the one of `python -m studies.wheel`", file=sys.stderr)
        return 2
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        python = str(Path(folder) / "bin" / "python")
        pins = [lowest(line) for line in declared()] if which == "lowest" else []
        upgrade = ["--upgrade", "--upgrade-strategy", "eager"] if which == "newest" else []
        package = f"{wheels[0]}[{','.join(EXTRAS)}]"
        install = [python, "-m", "pip", "install", "-q", *upgrade, package, *pins, *locked(TOOLS)]
        if subprocess.run(install).returncode:
            print(f"*** NOT TESTED AT THE {which.upper()} VERSIONS: they cannot be had here, or not together ***")
            return 77
        frozen = subprocess.run([python, "-m", "pip", "freeze"], capture_output=True, text=True, check=True).stdout
        known = {re.split(r"[><=]", line)[0].lower().replace("_", "-") for line in declared()}
        print(" ".join(x for x in frozen.split() if x.partition("==")[0].lower().replace("_", "-") in known))
        print(f"installed in {time.monotonic() - begin:.0f} s", flush=True)
        ignored = ["-W", "default"]  # old versions warn of what newer Pythons changed
        tests = [python, "-P", "-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "2", *ignored]
        tests += ["-o", "pythonpath=tests tests/sweeps", *SAMPLE]  # and not the source tree, which has no kernels
        outside = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        code = subprocess.run([*tests, "--rootdir", str(ROOT)], cwd=ROOT, env=outside).returncode
    print(f"{which}: exit code {code}, {time.monotonic() - begin:.0f} s")
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
