"""Many points at once: threads, progress, interruption."""

from __future__ import annotations

import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model import batch
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare


@pytest.fixture
def drive():
    """More than two blocks of points, a number that the lanes do not divide."""
    return ts.Drive(prepressure=np.linspace(120, 220, 601), load_torque=0.1, periods=4, on_periods=3)


def figures(point):
    return [point.mean_speed, point.min_speed, point.max_speed, point.speed_volatility, point.stall_torque]


def test_threads_do_not_change_a_bit(trum60, drive, monkeypatch):
    found = {}
    for workers in (1, 2, 3):
        monkeypatch.setattr(batch.os, "cpu_count", lambda workers=workers: workers)
        found[workers] = figures(ts.evaluate(trum60, drive))
    assert np.array_equal(found[1], found[2])
    assert np.array_equal(found[1], found[3])


def test_parameters_of_several_shapes_meet_their_points(trum60):
    force, difference = np.linspace(150, 210, 40), np.linspace(2000, 4000, 15)[:, None]
    drive = ts.Drive(prepressure=force, frequency_difference=difference, periods=4, on_periods=3)
    grid = ts.evaluate(trum60, drive).mean_speed
    assert grid.shape == (15, 40)
    for i, j in ((0, 0), (7, 31), (14, 39)):
        one = ts.Drive(prepressure=force[j], frequency_difference=difference[i, 0], periods=4, on_periods=3)
        assert grid[i, j] == ts.evaluate(trum60, one).mean_speed


def test_progress_is_shown_on_request_at_a_terminal(trum60, drive, capsys, monkeypatch):
    ts.evaluate(trum60, drive, progress=True)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    ts.evaluate(trum60, drive)
    assert capsys.readouterr().err == ""
    ts.evaluate(trum60, drive, progress=True)
    assert "orbits" in capsys.readouterr().err


def test_an_interruption_leaves_the_other_blocks_alone(trum60, drive, monkeypatch):
    original, begun, lock = batch.call, [], threading.Lock()

    def interrupted(kernel, values):
        if kernel == "rotor_orbit":
            with lock:
                begun.append(kernel)
            if len(begun) == 2:
                raise KeyboardInterrupt
        return original(kernel, values)

    monkeypatch.setattr(batch, "call", interrupted)
    monkeypatch.setattr(batch, "_BLOCK", 16)  # 38 blocks
    monkeypatch.setattr(batch.os, "cpu_count", lambda: 2)
    with pytest.raises(KeyboardInterrupt):
        ts.evaluate(trum60, drive, progress=True)
    assert len(begun) < 20


@pytest.mark.parametrize("kernel", ["rotor_orbit", "rotor_grid", "cycle_sums"])
def test_the_drivers_let_other_threads_run(trum60, kernel):
    """Were the interpreter's lock kept, this thread would stand still from the call's begin to its end."""
    count = {"rotor_orbit": 200, "rotor_grid": 800, "cycle_sums": 10000}[kernel]
    drive = ts.Drive(prepressure=np.linspace(120, 220, count), load_torque=0.1)
    levels = Levels()
    values = {**prepare(trum60, drive, levels, 1e-3).arguments, "panels": 4.0}
    took = []

    def call_it():
        begin = time.perf_counter()
        batch.call(kernel, values)
        took.append(time.perf_counter() - begin)

    thread = threading.Thread(target=call_it)
    last, longest = time.perf_counter(), 0.0
    thread.start()
    while thread.is_alive():
        now = time.perf_counter()
        last, longest = now, max(longest, now - last)
    assert longest < took[0] / 2


def test_the_smallest_stack_of_a_thread_is_enough():
    """128 KiB, which musl gives, for the kernels; modules are loaded before, on the main thread's stack."""
    code = (
        "import threading; threading.stack_size(128 * 1024); import trum_sym as ts; from trum_sym import _kernels\n"
        "from trum_sym.model.kernels import call; from trum_sym.model.levels import Levels\n"
        "from trum_sym.model.operating_point import prepare\n"
        "given = prepare(ts.load_motor(), ts.Drive(prepressure=[170.0] * 70), Levels(), 1e-3).arguments\n"
        "def run():\n"
        "    for name in _kernels.instruction_sets():\n"
        "        _kernels.use(name), call('rotor_orbit', given), call('rotor_grid', given)\n"
        "    ts.sensitivities(); print('done')\n"
        "ts.sensitivities(); thread = threading.Thread(target=run); thread.start(); thread.join()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr
