"""A bad day for every command that writes: nothing is lost, nothing is half-written, and one line says what happened.

python -m studies.faults [COUNT] [--seed N] [--only FAULT] [--writer FILE ...]

Commands run in processes that are forked once all modules are loaded; the fault SLOW starts them as a shell does, and
interrupts them while modules load.  Each is told to replace a file, or to make a new one, and meets one fault:

disk         no room: a small tmpfs where mounting is allowed, and a limit on the length of files
folder       the folder is not ours to write in
SIGINT, SIGTERM, SIGHUP, SIGKILL, SLOW        at a random moment
pipe         whoever reads the output has gone, at once or after some bytes; or the output is /dev/full, or closed
memory       the address space ends (but for optimize and speed-table: IPOPT's linear algebra then waits for ever); a
             crash in other libraries' compiled code is counted apart, and must leave the files as the others do
files        no more files can be opened
clock        the clock is set back in the middle, and the old file is from the future

Then: the file is the old one or the new one, whole; nothing lies beside it (of SIGKILL: until the command runs again);
there is at most one line of error, and no traceback; the process ended by itself within half a minute; where the exit
code is 0, the new file is there; and the same command without a fault makes what it would have made.
"""

from __future__ import annotations

import argparse
import contextlib
import faulthandler
import hashlib
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LONGEST = 30.0  # s
POINT = ("--load-torque", "0.05")
SWEEP = ("sweep", "--prepressure", "160:200:6", "--frequency-difference", "2900:3100:4")
SWEEP += ("--outputs", "q_average,amplitude")
TOLERANCE = ("spread", *POINT, "--spread", "friction_coefficient", "--samples", "64", "--tolerance", "1e-2")
OPTIMUM = ("optimize", *POINT, "--objective", "q_volatility", "--prepressure", "175:185")
OPTIMUM += ("--frequency-difference", "3000")
TABLE = ("speed-table", *POINT, "--from", "2 rad/s", "--to", "2.02 rad/s", "--direction", "positive", "--points", "2")
TABLE += ("--error", "0.5", "--prepressure", "175:185", "--frequency-difference", "3000")
COMMANDS: dict[str, tuple[str, ...]] = {
    "histories.nc": ("simulate", "--force", "--out"),
    "histories.csv": ("simulate", "--samples-per-period", "16", "--force", "--out"),
    "map.zarr": (*SWEEP, "--chunk", "4", "--out"),
    "map.nc": (*SWEEP, "--force", "--out"),
    "map.parquet": (*SWEEP, "--force", "--out"),
    "map.csv": (*SWEEP, "--force", "--out"),
    "points.nc": (*TOLERANCE, "--force", "--out"),
    "points.csv": (*TOLERANCE, "--force", "--out"),
    "study.png": (*TOLERANCE, "--force", "--plot"),
    "study.pdf": (*TOLERANCE, "--force", "--plot"),
    "study.svg": (*TOLERANCE, "--force", "--plot"),
    "box.png": (*OPTIMUM, "--force", "--plot"),
    "box.svg": (*OPTIMUM, "--force", "--plot"),
    "table.csv": (*TABLE, "--force", "--out"),
    "table.h": (*TABLE, "--force", "--out"),
    "motor.toml": ("calibrate", "DATA", "--fit", "amplitude_factor", "--force", "--out"),
    "report": ("report",),
}
DATA = "prepressure [N],amplitude [um]\n140,6.3\n160,5.9\n180,5.5\n200,5.3\n"
ENDING = {"SIGINT": signal.SIGINT, "SIGTERM": signal.SIGTERM, "SIGHUP": signal.SIGHUP, "SIGKILL": signal.SIGKILL}
FAULTS = ("disk", "folder", *ENDING, "pipe", "memory", "files", "clock", "SLOW")
OLD = b"the old one\n"


@dataclass
class Bad:
    """What went wrong, by kind."""

    lost: list[str] = field(default_factory=list)
    half_written: list[str] = field(default_factory=list)
    tracebacks: list[str] = field(default_factory=list)
    crashes: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)

    def all(self) -> list[str]:
        return [f"{kind}: {text}" for kind, texts in vars(self).items() for text in texts]


def preload() -> None:
    """Load what the commands would load, and put a page in the report's place: drawing all of it takes a minute."""
    import casadi  # noqa: F401
    import h5netcdf  # noqa: F401
    import matplotlib as mpl
    import matplotlib.backends.backend_agg
    import matplotlib.backends.backend_pdf
    import matplotlib.backends.backend_svg
    import pyarrow.parquet  # noqa: F401
    import scipy.stats  # noqa: F401
    import tomlkit  # noqa: F401
    import xarray  # noqa: F401

    import trum_sym.calibration.calibrate
    import trum_sym.console
    import trum_sym.inputs.motor_writer
    import trum_sym.model.histories
    import trum_sym.plots.optimum
    import trum_sym.plots.tolerance
    import trum_sym.report.output
    import trum_sym.studies.speed_table_result
    import trum_sym.sweeps.store
    import trum_sym.uncertainty.study

    os.environ["SOURCE_DATE_EPOCH"] = "0"  # so that a picture's bytes do not depend on the day
    mpl.rcParams["svg.hashsalt"] = "faults"
    page = "<p>" + "0123456789" * 50_000
    trum_sym.report.output.page = lambda *_, **__: page


def contents(path: Path) -> str | None:
    """What is at a path, as a digest; None if nothing is."""
    if path.is_dir():
        found = {str(file.relative_to(path)): contents(file) for file in sorted(path.rglob("*")) if file.is_file()}
        return repr(found)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None


def _catches(child: int, number: int) -> bool:
    """Whether a process has a handler for a signal, or has ended."""
    try:
        status = Path(f"/proc/{child}/status").read_text()
    except OSError:
        return True
    masks = [line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:")]
    return not masks or bool(int(masks[0], 16) >> (number - 1) & 1) or "\nState:\tZ" in status


def _said(error: str, fault: str) -> list[str]:
    """The lines of error, without warnings and progress; as memory ends a library may say so in its own words first."""
    lines = [line for line in error.splitlines() if line and not line.startswith(("trum-sym: warning:", "figures"))]
    lines = [line for line in lines if " points (" not in line]
    return lines[-1:] if fault == "memory" else lines


def _of_a_library(error: str) -> bool:
    """Whether the code that a crash was in is neither ours nor called by ours at once."""
    frames = [line for line in error.partition("most recent call first")[2].splitlines() if 'File "' in line]
    return bool(frames) and f"{ROOT}/trum_sym" not in frames[0]


def name_of(error: str) -> str:
    """The innermost frame of a crash."""
    frames = [line for line in error.splitlines() if 'File "' in line]
    return re.sub(r'.*File "(?:.*/)?([^/"]+/[^/"]+)", line \d+', r"\1", frames[0]).strip()


class Harness:
    """Faults on a folder of their own."""

    def __init__(self, folder: Path, seed: int, small: bool) -> None:
        self.folder, self.rng, self.small = folder, random.Random(seed), small
        self.bad, self.way = Bad(), ""
        self.count: Counter[str] = Counter()
        self.codes: Counter[str] = Counter()
        self.libraries: Counter[str] = Counter()
        self.wanted: dict[str, str | None] = {}
        self.takes: dict[str, float] = {}
        (folder / "data.csv").write_text(DATA)
        folder.chmod(0o755)

    def arguments(self, name: str, target: Path) -> list[str]:
        data = str(self.folder / "data.csv")
        return [*(data if part == "DATA" else part for part in COMMANDS[name]), str(target)]

    def reference(self, name: str) -> None:
        """What the command makes when nothing happens, and how long it takes."""
        if name in self.wanted:
            return
        for turn in range(2):
            place = self.folder / f"reference-{turn}"
            place.mkdir(exist_ok=True)
            begin = time.monotonic()
            code, error = self.forked(name, place / name)
            self.takes[name] = time.monotonic() - begin
            if code or "Traceback" in error:
                raise RuntimeError(f"{name}: exit code {code} without a fault: {error}")
            made = contents(place / name)
            if turn and made != self.wanted[name]:
                raise RuntimeError(f"{name}: two runs make different files; they cannot be told from broken ones")
            self.wanted[name] = made
            shutil.rmtree(place)

    def forked(
        self,
        name: str,
        target: Path,
        prepare: Callable[[], None] = lambda: None,
        meanwhile: Callable[[int], None] = lambda _: None,
        out: int | None = None,
    ) -> tuple[int, str]:
        """Run a command in a child; returns its exit code, negative for a signal, and its standard error."""
        ours, theirs = os.pipe()  # not a file: its length may be what is limited
        with tempfile.TemporaryFile() as printed:
            child = os.fork()
            if not child:
                try:
                    os.setsid()
                    os.dup2(theirs, 2)
                    os.close(ours), os.close(theirs)
                    os.dup2(printed.fileno() if out is None else out, 1)
                    sys.argv = ["trum-sym", *self.arguments(name, target)]
                    faulthandler.enable()  # which says in whose code a crash was
                    prepare()
                    from trum_sym.__main__ import run

                    run()
                finally:
                    sys.excepthook(*sys.exc_info())
                    os._exit(99)
            os.close(theirs)
            os.set_blocking(ours, False)
            meanwhile(child)
            return self.ended(child, ours)

    def ended(self, child: int, error: int) -> tuple[int, str]:
        """The exit code and the standard error of a child; -1000 if it does not end."""
        said, end, code = b"", time.monotonic() + LONGEST, None
        while code is None and time.monotonic() < end:
            found, status = os.waitpid(child, os.WNOHANG)
            if found:
                code = os.waitstatus_to_exitcode(status)
            with contextlib.suppress(BlockingIOError):
                while part := os.read(error, 65536):
                    said += part
            time.sleep(0.002)
        os.close(error)
        if code is None:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            code = -1000
        return code, said.decode("utf-8", "replace")

    # --- The faults ---------------------------------------------------------------------------------------------------

    def disk(self, name: str, target: Path) -> tuple[int, str]:
        room = int(10 ** self.rng.uniform(0, 6))
        if self.small and self.rng.random() < 0.7:
            filler = target.parent / "filler"
            state = os.statvfs(target.parent)
            with filler.open("wb") as file:
                os.posix_fallocate(file.fileno(), 0, max(1, state.f_bavail * state.f_bsize - room))
            try:
                return self.forked(name, target)
            finally:
                filler.unlink()
        return self.forked(name, target, lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)))

    def folder_(self, name: str, target: Path) -> tuple[int, str]:
        def nobody() -> None:
            if os.geteuid() == 0:
                os.setgroups([]), os.setgid(65534), os.setuid(65534)

        target.parent.chmod(0o555)
        try:
            return self.forked(name, target, nobody)
        finally:
            target.parent.chmod(0o755)

    def signalled(self, name: str, target: Path, number: int) -> tuple[int, str]:
        moment = self.rng.uniform(0, 1.1 * self.takes[name])

        def send(child: int) -> None:
            while not _catches(child, signal.SIGHUP):  # the last that the console takes care of
                time.sleep(0.001)
            time.sleep(moment)
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, number)

        return self.forked(name, target, meanwhile=send)

    def slow(self, name: str, target: Path) -> tuple[int, str]:
        """Started anew, and interrupted from its own first line on: before that it is the interpreter's."""
        number = self.rng.choice([signal.SIGINT, signal.SIGTERM])
        moment = self.rng.uniform(0, 1.0)
        program = "import trum_sym.__main__ as m, sys; sys.stdout.write('x'); sys.stdout.flush(); m.run()"
        command = [sys.executable, "-c", program, *self.arguments(name, target)]
        (self.folder / "matplotlibrc").write_text("svg.hashsalt: faults\n")
        environment = {**os.environ, "MATPLOTLIBRC": str(self.folder / "matplotlibrc")}
        with tempfile.TemporaryFile() as said:
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, env=environment)
            process.stdout.read(1)
            time.sleep(0.001 + moment)
            process.send_signal(number)
            try:
                process.communicate(timeout=LONGEST)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                return -1000, ""
            said.seek(0)
            return process.returncode, said.read().decode("utf-8", "replace")

    def pipe(self, name: str, target: Path) -> tuple[int, str]:
        self.way = way = self.rng.choice([" gone", " some", " full", " closed", " full error", " closed error"])
        if way in (" gone", " some"):
            ours, theirs = os.pipe()
            os.set_inheritable(theirs, True)
            if way == " gone":
                os.close(ours)

            def read(_: int) -> None:
                os.close(theirs)
                if way == " some":
                    os.read(ours, self.rng.randrange(1, 40))
                    os.close(ours)

            def forget() -> None:
                os.close(theirs)
                if way == " some":
                    os.close(ours)

            return self.forked(name, target, forget, read, out=theirs)

        def prepare() -> None:
            number = 2 if "error" in way else 1
            os.close(number)
            if "full" in way:
                os.open("/dev/full", os.O_WRONLY)
            stream = None
            if "full" in way:
                stream = open(number, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
            setattr(sys, "stderr" if number == 2 else "stdout", stream)

        return self.forked(name, target, prepare)

    def memory(self, name: str, target: Path) -> tuple[int, str]:
        more = int(10 ** self.rng.uniform(5, 8.7))

        def limit() -> None:
            pages = int(Path("/proc/self/statm").read_text().split()[0])
            size = pages * resource.getpagesize() + more
            resource.setrlimit(resource.RLIMIT_AS, (size, size))

        return self.forked(name, target, limit)

    def files(self, name: str, target: Path) -> tuple[int, str]:
        more = self.rng.randrange(0, 14)

        def limit() -> None:
            most = max(map(int, os.listdir("/proc/self/fd"))) + 1 + more
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))

        return self.forked(name, target, limit)

    def clock(self, name: str, target: Path) -> tuple[int, str]:
        begin, step, real = time.monotonic(), self.rng.uniform(0, self.takes[name]), time.time
        if target.exists():
            os.utime(target, (4e9, 4e9))

        def back() -> None:
            time.time = lambda: real() - (1e8 if time.monotonic() - begin > step else 0.0)

        return self.forked(name, target, back)

    # --- What is looked at --------------------------------------------------------------------------------------------

    def one(self, fault: str, name: str) -> None:
        """One fault on one command."""
        self.reference(name)
        place = self.folder / ("small" if self.small else "large") / "here"
        place.mkdir(parents=True)
        target, store = place / name, name.endswith(".zarr") or name == "report"
        replacing = not store and self.rng.random() < 0.6
        if replacing:
            target.write_bytes(OLD)
        before = contents(target)
        acts: dict[str, Any] = {"disk": self.disk, "folder": self.folder_, "pipe": self.pipe, "memory": self.memory}
        acts |= {"files": self.files, "clock": self.clock, "SLOW": self.slow}
        act = acts.get(fault) or (lambda n, t: self.signalled(n, t, ENDING[fault]))
        self.way = ""
        code, error = act(name, target)
        self.count[fault] += 1
        self.codes[f"{code}"] += 1
        self.judge(f"{fault}{self.way} on {name}, exit code {code}", code, error, fault, before, target)
        now_whole = contents(target) == self.wanted[name]
        if now_whole and fault not in ("disk", "SIGKILL") and not store:
            shutil.rmtree(place)
            return
        again, said = self.forked(name, target)
        if again or contents(target) != self.wanted[name] or {path.name for path in place.iterdir()} != {name}:
            beside = sorted(path.name for path in place.iterdir())
            self.bad.lost.append(f"{fault} on {name}: run again, exit code {again}, {beside}: {said[-300:]}")
        shutil.rmtree(place)

    def judge(self, what: str, code: int, error: str, fault: str, before: str | None, target: Path) -> None:
        """Whether all is as it should be after a fault."""
        killed = fault == "SIGKILL" and code == -signal.SIGKILL
        self.look_at_files(what, code, before, target, killed)
        if "Traceback" in error or "Exception ignored" in error:
            self.bad.tracebacks.append(f"{what}: {error[-1500:]}")
        if fault == "memory" and code < 0 and _of_a_library(error):
            self.libraries[name_of(error)] += 1
            return
        if code not in (0, 1, 2, 129, 130, 141, 143) and not killed:
            self.bad.crashes.append(f"{what}: {error[-500:]}")
        said = _said(error, fault)
        silent = killed or code in (0, 141) or "error" in what  # nothing to tell, or nobody to tell it to
        if not (silent and not said) and not (len(said) == 1 and said[0].startswith("trum-sym: ")):
            self.bad.lines.append(f"{what}: {said[-6:]}")

    def look_at_files(self, what: str, code: int, before: str | None, target: Path, killed: bool) -> None:
        """Whether the file is the old one or the new one, and alone."""
        now, wanted = contents(target), self.wanted[target.name]
        store = target.suffix == ".zarr" or target.name == "report"
        if not store and now not in (before, wanted):
            (self.bad.lost if now is None else self.bad.half_written).append(f"{what}: {now}")
        if target.name == "report" and target.is_dir():
            parts = [target / part for part in ("ledger.html", "index.html")]
            if any(part.exists() and repr(contents(part)) not in str(wanted) for part in parts):
                self.bad.half_written.append(f"{what}: a part of the report")
        beside = [path.name for path in target.parent.iterdir() if path.name != target.name]
        if beside and not killed:
            self.bad.half_written.append(f"{what}: beside it {beside}")
        if code == 0 and now != wanted and "error" not in what:
            self.bad.lost.append(f"{what}: but it is not there")


def run(count: int, seed: int, only: str | None, names: list[str], small: bool, folder: Path) -> int:
    """Meet that many faults; print what they did; 1 if anything was not as it should be."""
    preload()
    begin = time.monotonic()
    harness = Harness(folder, seed, small)
    faults = [only] if only else list(FAULTS)
    plan = [(faults[i % len(faults)], names[(i // len(faults) + i) % len(names)]) for i in range(count)]
    for done, (fault, name) in enumerate(plan):
        if done and done % 100 == 0:
            print(f"{done} faults in {time.monotonic() - begin:.0f} s", flush=True)
        shown = len(harness.bad.all())
        if fault == "memory" and COMMANDS[name][0] in ("optimize", "speed-table"):
            name = "histories.csv"  # IPOPT's linear algebra waits for ever for memory that does not come
        if fault == "SLOW" and name == "report":
            name = "histories.nc"  # the report itself, a minute long, is not run here
        harness.one(fault, name)
        for line in harness.bad.all()[shown:]:
            print(line, flush=True)
    kinds = ", ".join(f"{kind.replace('_', '-')} {len(found)}" for kind, found in vars(harness.bad).items())
    print(f"{count} faults: {', '.join(f'{fault} {harness.count[fault]}' for fault in faults)}")
    print(
        f"on {len(names)} writers; exit codes {dict(sorted(harness.codes.items()))}; {time.monotonic() - begin:.0f} s"
    )
    for where, times in harness.libraries.items():
        print(f"other libraries' code crashed as memory ended, {times} times in {where}")
    print(kinds)
    return int(bool(harness.bad.all()))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, nargs="?", default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=FAULTS)
    parser.add_argument("--writer", choices=COMMANDS, action="append")
    parser.add_argument("--small", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.small is None:
        with tempfile.TemporaryDirectory() as folder:
            small = Path(folder) / "small"
            small.mkdir()
            command = [sys.executable, "-m", "studies.faults", *sys.argv[1:], "--small"]
            mount = 'mount -t tmpfs -o size=4m tmpfs "$0" && exec "$@"'
            allowed = ["unshare", "--mount", "sh", "-c", mount.replace('&& exec "$@"', ""), str(small)]
            if shutil.which("unshare") and subprocess.run(allowed, capture_output=True).returncode == 0:
                command = ["unshare", "--mount", "sh", "-c", mount, str(small), *command, "yes"]
            else:
                print("no mounting here: a full disk is a limit on the length of files")
                command.append("no")
            return subprocess.run([*command], cwd=ROOT, env={**os.environ, "TRUM_FAULTS": folder}).returncode
    names = given.writer or list(COMMANDS)
    return run(given.count, given.seed, given.only, names, given.small == "yes", Path(os.environ["TRUM_FAULTS"]))


if __name__ == "__main__":
    sys.exit(main())
