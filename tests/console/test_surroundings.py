"""Full and closed streams, signals at any moment, no memory: one line, an exit code, and no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from importlib import import_module

import pytest

from trum_sym import console
from trum_sym.errors import UnfinishedError

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
QUICK = ["equations", "--equation", "6"]
TABLE = ["equations"]  # longer than what a pipe is read of here


def run(*arguments, before="", **streams):
    """The command as a shell starts it; ``before`` is what happens first."""
    program = f"import os, signal, sys\n{before}\nsys.argv[0] = 'trum-sym'\nfrom trum_sym.__main__ import run\nrun()"
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams}
    return subprocess.run([sys.executable, "-c", program, *arguments], text=True, timeout=30, **options)


def one_line(done, code, *words):
    assert done.returncode == code
    assert done.stderr.startswith("trum-sym: ")
    assert done.stderr.count("\n") == 1
    assert all(word in done.stderr for word in words)


# --- Streams ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("arguments", [QUICK, ["--help"], ["--version"], ["evaluate", "--help"]])
def test_a_full_output_is_one_line(arguments):
    with open("/dev/full", "w") as full:
        one_line(run(*arguments, stdout=full), 2, "No space left on device")


def test_a_full_error_output_changes_nothing():
    with open("/dev/full", "w") as full:
        done = run(*QUICK, stderr=full)
        assert (done.returncode, bool(done.stdout)) == (0, True)
        assert run("evaluate", "--prepressure", "none", stderr=full).returncode == 2


def test_whoever_has_read_enough_hears_nothing():
    ours, theirs = os.pipe()
    os.close(ours)
    done = run(*TABLE, stdout=theirs)
    os.close(theirs)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize("closed", [(1,), (2,), (0, 1, 2)])
def test_closed_streams_are_not_written_to_and_no_file_takes_their_place(tmp_path, closed):
    out = tmp_path / "a.csv"
    before = "".join(f"os.close({number})\n" for number in closed)
    before += "".join(f"sys.{'stdout' if number == 1 else 'stderr'} = None\n" for number in closed if number)
    assert run("simulate", "--samples-per-period", "4", "--out", str(out), before=before).returncode == 0
    lines = out.read_text().splitlines()
    assert lines[0].startswith("time [s]")
    assert len({line.count(",") for line in lines}) == 1


# --- Signals ---------------------------------------------------------------------------------------------------------

WHILE = """
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            os.kill(os.getpid(), {number})
        return None
sys.meta_path.insert(0, Finder())
"""
TURNED = """
import importlib.abc, importlib.machinery
class Loader(importlib.abc.Loader):
    def exec_module(self, module):
        try:
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(1000): pass
        except KeyboardInterrupt:
            {turned}
class Finder:
    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, Loader()) if name == "trum_sym.output.text_table" else None
sys.meta_path.insert(0, Finder())
"""
DESTROYED = """
class Last:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000): pass
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "trum_sym.output.text_table":
            Last()
            import time
            time.sleep(2)
        return None
sys.meta_path.insert(0, Finder())
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize(
    "module", ["click", "trum_sym.console", "numpy", "trum_sym.output.text_table", "trum_sym._kernels"]
)
def test_a_signal_while_modules_load_is_one_line(module, number):
    done = run("evaluate", before=WHILE.format(module=module, number=int(number)))
    one_line(done, 128 + number, "interrupted")
    assert done.stdout == ""


@pytest.mark.parametrize(
    "turned", ["raise ImportError('half loaded')", "raise ValueError('odd')", "raise SystemExit(3)"]
)
def test_a_signal_that_a_module_turns_into_an_error_is_still_a_signal(turned):
    one_line(run("evaluate", before=TURNED.format(turned=turned)), 130, "interrupted")


def test_a_signal_in_a_destructor_is_not_lost():
    one_line(run("evaluate", before=DESTROYED), 130, "interrupted")


def test_a_second_signal_ends_at_once():
    before = WHILE.format(module="trum_sym.output.text_table", number=2) + (
        "import trum_sym.__main__ as m\n"
        "class Out:\n"
        "    def write(self, text): os.kill(os.getpid(), 15)\n"
        "    def flush(self): pass\n"
        "sys.stderr = Out()\n"
    )
    done = run("evaluate", before=before)
    assert (done.returncode, done.stderr) == (143, "")


def test_a_signal_that_is_ignored_stays_ignored():
    before = "signal.signal(signal.SIGINT, signal.SIG_IGN)\n" + WHILE.format(module="numpy", number=2)
    assert run(*QUICK[:1], "--json", before=before).returncode == 0


# --- What the system refuses -----------------------------------------------------------------------------------------

REFUSALS = [
    (MemoryError(), 2, "not enough memory"),
    (SystemError("error return without exception set"), 2, "not enough memory, or a library"),
    (RuntimeError("Zstd error: b'Allocation error : not enough memory'"), 2, "not enough memory"),
    (OSError(24, "Too many open files", "a.so"), 2, "the system refuses a.so: Too many open files"),
    (ImportError("a.so: failed to map segment from shared object"), 2, "a module cannot be loaded: a.so"),
    (RuntimeError("can't start new thread"), 2, "the system refuses a new thread"),
    (UnfinishedError("a.zarr: No space left on device"), 1, "No space left on device"),
]


@pytest.mark.parametrize(("error", "code", "words"), REFUSALS, ids=[type(error).__name__ for error, *_ in REFUSALS])
def test_what_the_system_refuses_is_one_line(monkeypatch, capsys, error, code, words):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr(import_module("trum_sym.console.equations"), "say", fails)
    assert console.main(QUICK) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"trum-sym: {words}") or words in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("path", ["\0.nc", "\ud800.nc", "\0.zarr", "\ud800.zarr"])
def test_a_path_that_no_system_takes_is_one_line(console_refuses, path):
    console_refuses("sweep", "--prepressure", "170:190:2", "--out", path, naming=("trum-sym: ",))
    console_refuses("calibrate", path, naming=("trum-sym: ",))


def test_a_fault_of_our_own_is_not_hidden(monkeypatch):
    def fails(*_, **__):
        raise RuntimeError("a bug")

    monkeypatch.setattr(import_module("trum_sym.console.equations"), "say", fails)
    with pytest.raises(RuntimeError, match="a bug"):
        console.main(QUICK)


def test_a_sample_of_the_fault_harness():
    """The rest: ``python -m studies.faults``."""
    command = [
        sys.executable,
        "-m",
        "studies.faults",
        "11",
        "--seed",
        "7",
        "--writer",
        "map.zarr",
        "--writer",
        "map.csv",
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "lost 0, half-written 0, tracebacks 0, crashes 0, lines 0" in done.stdout
