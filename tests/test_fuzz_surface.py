"""A sample of ``python -m studies.fuzz_surface``, and that it notices what is wrong."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def test_a_sample_of_calls_ends_as_it_should():
    command = [sys.executable, "-m", "studies.fuzz_surface", "120", "--seed", "2"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, encoding="utf-8", timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 calls at 0 places were not as they should be" in done.stdout


def fails(error):
    raise error


@pytest.mark.parametrize(
    "fault",
    [
        lambda: fails(KeyError("x")),
        lambda: fails(TypeError("x")),
        lambda: fails(SystemExit(3)),
        lambda: fails(FloatingPointError("unflagged")),
        lambda: time.sleep(10),
    ],
    ids=["KeyError", "TypeError", "exit", "nan", "hang"],
)
def test_what_is_wrong_is_found(monkeypatch, fault):
    import signal

    from studies import fuzz_surface

    monkeypatch.setattr(fuzz_surface, "LONGEST", 0.1)
    before = signal.signal(signal.SIGALRM, fuzz_surface.ring)
    try:
        found = fuzz_surface.Found()
        found.call("planted", fault, ())
    finally:
        signal.signal(signal.SIGALRM, before)
    assert sum(found.places.values()) == 1


def test_a_traceback_at_the_console_is_found(monkeypatch):
    from studies import fuzz_surface

    traced = "Traceback (most recent call last):"
    monkeypatch.setattr(fuzz_surface.console, "main", lambda _: print(traced, file=sys.stderr) or 2)
    with pytest.raises(AssertionError, match="exit code 2"):
        fuzz_surface.run_console(["evaluate"])
