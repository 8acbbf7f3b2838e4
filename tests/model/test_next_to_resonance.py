"""Without damping a drive next to a resonance is said to be one; with TRUM-60's damping nothing is."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import trum_sym as ts

FREE = ts.evaluate(ts.load_motor()).resonance_frequency / 19
"""Hz above the resonance at which 20 drive pulses last 19 free vibrations, which then come back in phase."""


def warned(trum60, damping, difference, start="periodic"):
    motor = trum60.with_values({"damping_ratio": damping})
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        point = ts.evaluate(motor, ts.Drive(frequency_difference=difference, start=start, load_torque=0.05))
    return point, [str(warning.message) for warning in said]


@pytest.mark.parametrize("start", ["periodic", "steady", "rest"])
def test_no_damping_next_to_the_resonance_is_said(trum60, start):
    for difference in (1e-3, -1e-3, 10.0):
        _, said = warned(trum60, 0, difference, start)
        assert len(said) == 1
        assert said[0].startswith("damping_ratio: 0 so near the resonance")


@pytest.mark.parametrize("damping", [0, 1e-6, 1e-4])
def test_a_free_vibration_that_comes_back_in_phase_is_said(trum60, damping):
    point, said = warned(trum60, damping, FREE + 1e-2)
    assert abs(point.mean_speed) > 1e3, "rad/s, of a motor that turns at arc-seconds a second"
    assert len(said) == 1
    assert "times the forced one" in said[0]


@pytest.mark.parametrize("start", ["periodic", "steady", "rest"])
def test_the_motors_own_damping_is_never_said_anything_of(trum60, start):
    for difference in (0.0, 1e-9, 1.0, FREE, FREE + 1e-2, 3000.0, -3000.0):
        assert warned(trum60, 0.006, difference, start)[1] == []
    assert warned(trum60, 0, 3000.0, start)[1] == []


def test_one_point_of_many_is_enough(trum60):
    assert len(warned(trum60, 0, np.array([3000.0, FREE + 1e-2]))[1]) == 1
