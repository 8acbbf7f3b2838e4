"""The wheel as a stranger gets it: built twice, audited, installed where no compiler is, beside the source tree.

python -m studies.wheel [FOLDER]      leaves the wheel, the source archive and the SBOM in FOLDER (dist)

same bytes     the source tree, and its source archive unpacked elsewhere, give one wheel, byte for byte
audit          auditwheel names the oldest manylinux that it runs on; abi3audit finds no symbol outside the stable ABI;
               at most 6 MB, no test and no generator inside
bare           in a new environment with the package's own dependencies alone and no compiler on the path,
               `trum-sym evaluate` within 3 s, and on every instruction set what the source tree prints
other Pythons  the same wheel on every newer Python that is here (python3.12, ..., or those of pyenv)
SBOM           CycloneDX, of what requirements.lock pins and the wheel itself

The tools come from PyPI, into an environment of their own.  The exit code is 1 if anything was found.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TOOLS = ("build==1.6.1", "auditwheel==6.8.2", "abi3audit==0.0.26", "cyclonedx-bom==7.5.0")
MOST_BYTES, MOST_SECONDS = 6_000_000, 3.0
EVALUATE = """
import sys
from trum_sym import _kernels
from trum_sym.console import main
for name in _kernels.instruction_sets():
    _kernels.use(name)
    print(name, flush=True)
    if main(["evaluate"]): sys.exit(1)
"""


def run(*command: str | Path, **keywords: object) -> str:
    """What a command prints.

    Raises
    ------
    subprocess.CalledProcessError
        If it fails.
    """
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **keywords)
    if done.returncode:
        print(done.stdout[-2000:], done.stderr[-2000:], sep="\n")
        raise subprocess.CalledProcessError(done.returncode, [str(word) for word in command])
    return done.stdout


def environment(folder: Path, python: str, *packages: str) -> Path:
    """A new virtual environment with packages in it; its programs' folder."""
    run(python, "-m", "venv", folder)
    if packages:
        run(folder / "bin" / "pip", "install", "-q", *packages)
    return folder / "bin"


def epoch() -> str:
    """When the last commit was made; where there is no git, the release's day."""
    if shutil.which("git") and (ROOT / ".git").exists():
        return run("git", "log", "-1", "--format=%ct", cwd=ROOT).strip()
    return "1764288000"


def built(tools: Path, folder: Path) -> tuple[Path, Path, list[str]]:
    """The wheel and the source archive, and what is wrong with their bytes."""
    outside = {**os.environ, "SOURCE_DATE_EPOCH": epoch(), "PATH": f"{tools}:{os.environ['PATH']}"}

    def build(kind: str, source: Path, to: Path, ends: str) -> Path:
        run(tools / "python", "-m", "build", "--no-isolation", f"--{kind}", "--outdir", to, source, env=outside)
        return next(to.glob(f"*{ends}"))

    archive = build("sdist", ROOT, folder, ".tar.gz")
    again = build("sdist", ROOT, folder / "again", ".tar.gz")
    shutil.unpack_archive(archive, folder / "another place", filter="data")
    wheel = build("wheel", ROOT, folder / "of the tree", ".whl")
    other = build("wheel", next((folder / "another place").iterdir()), folder / "of the archive", ".whl")
    digests = [hashlib.sha256(file.read_bytes()).hexdigest()[:12] for file in (wheel, other, archive, again)]
    print(f"  {wheel.name}: {' '.join(digests[:2])}; {archive.name}: {' '.join(digests[2:])}")
    found = [] if digests[2] == digests[3] else ["two source archives differ"]
    if digests[0] != digests[1]:
        found.append(f"tree and archive give two wheels; {', '.join(unlike(wheel, other)) or 'their headers'} differ")
    return wheel, archive, found


def unlike(one: Path, other: Path) -> list[str]:
    """Members that two wheels do not share."""
    with zipfile.ZipFile(one) as first, zipfile.ZipFile(other) as second:
        names = sorted({*first.namelist(), *second.namelist()})
        held = [{*first.namelist()}, {*second.namelist()}]
        return [n for n in names if n not in held[0] or n not in held[1] or first.read(n) != second.read(n)]


def audited(tools: Path, wheel: Path) -> list[str]:
    """What is wrong with it, and prints what it needs."""
    found = []
    shown = " ".join(run(tools / "auditwheel", "show", wheel).split())
    print(
        "  " + (re.search(r"platform tag: \"(\S+)\"", shown) or ["", "no platform tag"])[1],
        f"{wheel.stat().st_size} bytes",
    )
    if "manylinux" not in shown:
        found.append(f"no manylinux: {shown[:200]}")
    report = json.loads(run(tools / "abi3audit", "--report", wheel))
    modules = [module for spec in report["specs"].values() for module in spec["wheel"]]
    wrong = [m["name"] for m in modules if not (m["result"]["is_abi3"] and m["result"]["is_abi3_baseline_compatible"])]
    if wrong or not modules:
        found.append(f"outside the stable ABI: {wrong or 'no module at all'}")
    if wheel.stat().st_size > MOST_BYTES:
        found.append(f"{wheel.stat().st_size} bytes are more than {MOST_BYTES}")
    with zipfile.ZipFile(wheel) as archive:
        strangers = [n for n in archive.namelist() if not n.startswith(("trum_sym/", "trum_sym-")) or "/_driver/" in n]
    return found + [f"{name} is inside" for name in strangers]


def pythons() -> list[str]:
    """The newer Pythons that are here, oldest first."""
    roots = [Path(folder) for folder in os.get_exec_path()] + [p / "bin" for p in Path.home().glob(".pyenv/versions/*")]
    found: dict[int, str] = {}
    for root in roots:
        for path in sorted(root.glob("python3.*")):
            if (match := re.fullmatch(r"python3\.(\d+)", path.name)) and int(match[1]) > sys.version_info[1]:
                ready = subprocess.run([path, "-c", "import ensurepip"], capture_output=True).returncode == 0
                if ready:
                    found.setdefault(int(match[1]), str(path))
    return [found[minor] for minor in sorted(found)]


def bare(folder: Path, python: str, wheel: Path, expected: str) -> list[str]:
    """Installs the wheel where there is no compiler and compares what it prints."""
    programs = environment(folder, python)
    outside = {"PATH": str(programs), "HOME": str(folder), "LC_ALL": "C.UTF-8"}
    for name in ("cc", "gcc", "g++", "clang", "cl"):
        assert shutil.which(name, path=outside["PATH"]) is None
    kept = {k: v for k, v in os.environ.items() if k.startswith(("PIP_", "SSL_", "REQUESTS_"))}
    run(programs / "pip", "install", "-q", "--only-binary", ":all:", wheel, env={**outside, **kept})
    begin = time.monotonic()
    first = run(programs / "trum-sym", "evaluate", env=outside, cwd=folder)
    seconds = time.monotonic() - begin
    printed = run(programs / "python", "-I", "-c", EVALUATE, env=outside, cwd=folder)
    version = run(programs / "python", "--version").strip()
    sets = re.findall(r"^orbit_(\w+)$", printed, re.M)
    print(f"  {version}: {seconds:.2f} s after the installation's end; {', '.join(sets)}")
    found = [] if seconds <= MOST_SECONDS else [f"{version}: the first answer took {seconds:.1f} s"]
    if printed != expected:
        found.append(f"{version}: it does not print what the source tree does")
    if first not in expected:
        found.append(f"{version}: the command and the sets differ")
    return found


def listed(tools: Path, wheel: Path, to: Path) -> list[str]:
    """Writes the SBOM; what it lacks."""
    outside = {**os.environ, "SOURCE_DATE_EPOCH": epoch()}
    command = (
        tools / "cyclonedx-py",
        "requirements",
        ROOT / "requirements.lock",
        "--pyproject",
        ROOT / "pyproject.toml",
    )
    run(*command, "--mc-type", "library", "--output-reproducible", "--of", "JSON", "-o", to, env=outside)
    record = json.loads(to.read_text("utf-8"))
    record["metadata"]["component"]["hashes"] = [
        {"alg": "SHA-256", "content": hashlib.sha256(wheel.read_bytes()).hexdigest()}
    ]
    to.write_text(json.dumps(record, indent=1) + "\n", "utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    names = {component["name"].lower().replace("_", "-") for component in record["components"]}
    wanted = {re.split(r"[><=]", line)[0].lower() for line in project["dependencies"]}
    print(f"  {to.name}: {record['specVersion']}, {len(names)} components")
    found = [f"the SBOM lacks {name}" for name in sorted(wanted - names)]
    if record["metadata"]["component"].get("version") != project["version"]:
        found.append("the SBOM has another version")
    return found


def main(target: Path) -> int:
    """Build and check; the exit code."""
    begin, found = time.monotonic(), []

    def said(part: str, wrong: list[str]) -> None:
        found.extend(wrong)
        print(f"{part}: {len(wrong)} found, {time.monotonic() - begin:.0f} s", *wrong, sep="\n  ", flush=True)

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        needed = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["build-system"]["requires"]
        tools = environment(folder / "tools", sys.executable, *TOOLS, *needed, "cmake>=3.26", "ninja")
        wheel, archive, wrong = built(tools, folder)
        said("same bytes", wrong)
        said("audit", audited(tools, wheel))
        expected = run(sys.executable, "-W", "ignore", "-c", EVALUATE, cwd=ROOT)
        for python in (sys.executable, *pythons()):
            said("bare", bare(folder / f"bare{Path(python).name}", python, wheel, expected))
        target.mkdir(parents=True, exist_ok=True)
        said("SBOM", listed(tools, wheel, target / "sbom.cdx.json"))
        for file in (wheel, archive):
            shutil.copy(file, target)
    print(f"{len(found)} found, {time.monotonic() - begin:.0f} s")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "dist")))
