"""Many points at once: threads, progress, interruption."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import trum_sym as ts
from trum_sym import rotor


@pytest.fixture
def drive():
    """More than two blocks of points, a number that the lanes do not divide."""
    return ts.Drive(prepressure=np.linspace(120, 220, 601), load_torque=0.1, periods=4, on_periods=3)


def figures(point):
    return [point.mean_speed, point.min_speed, point.max_speed, point.speed_volatility, point.stall_torque]


def test_threads_do_not_change_a_bit(trum60, drive, monkeypatch):
    found = {}
    for workers in (1, 2, 3):
        monkeypatch.setattr(rotor.os, "cpu_count", lambda workers=workers: workers)
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


def test_progress_is_shown_on_request(trum60, drive, capsys):
    ts.evaluate(trum60, drive)
    assert capsys.readouterr().err == ""
    ts.evaluate(trum60, drive, progress=True)
    assert "orbits" in capsys.readouterr().err


def test_an_interruption_leaves_the_other_blocks_alone(trum60, drive, monkeypatch):
    original, begun, lock = rotor.call, [], threading.Lock()

    def interrupted(kernel, values):
        if kernel == "rotor_orbit":
            with lock:
                begun.append(kernel)
            if len(begun) == 2:
                raise KeyboardInterrupt
        return original(kernel, values)

    monkeypatch.setattr(rotor, "call", interrupted)
    monkeypatch.setattr(rotor, "_BLOCK", 16)  # 38 blocks
    monkeypatch.setattr(rotor.os, "cpu_count", lambda: 2)
    with pytest.raises(KeyboardInterrupt):
        ts.evaluate(trum60, drive, progress=True)
    assert len(begun) < 20
