"""Laps of phases, contact and rotor as one system: against motion in time, a prescribed wave, the plain wave."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model.coupled_orbit import (
    STATE,
    coupled_orbits,
    followed,
    lap_values,
    laps,
    one_phase,
    orbit_from,
    start_of,
)
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels


@pytest.fixture(scope="module")
def motor():
    return ts.load_motor()


def test_a_lap_is_a_motion_in_time(motor):
    """Two periods of pulses, A off and B off, from a state of unlike phases, under a rotor with a mass."""
    from studies.coupling import after

    values = lap_values(motor, ts.Drive(periods=2, on_periods=1), Levels(compliance="flange"), rotor_mass=0.02)
    values |= {"force_phase": 0.0}
    start = np.array([2e-6, 0.3, 1e-6, -0.5, 1.5e-6, 0.01, 0.1])
    wanted = start[:, np.newaxis]
    for gates in ((0.0, 1.0), (1.0, 0.0)):
        wanted = after(values, wanted, 1, 0.02, 1e-8, gates)[:7]
    sizes = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3])
    gaps = []
    for steps in (25.0, 50.0, 400.0):
        end, _ = laps({**values, "steps": steps}, start[:, np.newaxis])
        gaps.append(float(np.abs((end - wanted)[:, 0] / sizes).max()))
    assert gaps[2] < 1e-6
    assert gaps[1] < gaps[0] / 8  # fourth order, but where a kink falls into a step


def test_without_reaction_it_is_the_orbit_on_a_prescribed_wave(motor):
    """Of the same force, whose amplitude coupling = none is given; its cycle and orbit are another code's."""
    values = lap_values(motor, ts.Drive(), Levels(), reaction=False, steps=200)
    own, turn = values["omega_n"], values["omega_q"]
    values |= {"omega_n0": own}  # at the resonance under prepressure, as there
    size = values["F_q"] / values["M_q"] / abs(complex(own**2 - turn**2, 2 * values["xi"] * own * turn))
    orbit = orbit_from(values, start_of("steady", values), "steady")
    prescribed = motor.with_values({"amplitude": size, "resonance_frequency": own / 2 / math.pi})
    point = ts.evaluate(prescribed, ts.Drive(), tolerance=1e-8)
    assert orbit.closed
    most = max(abs(point.min_speed), point.max_speed)
    assert orbit.mean_speed == pytest.approx(point.mean_speed, abs=3e-4 * most)
    assert orbit.max_speed == pytest.approx(point.max_speed, abs=1e-3 * most)
    assert orbit.min_speed == pytest.approx(point.min_speed, abs=1e-3 * most)
    assert orbit.contact_fraction == pytest.approx(point.contact_fraction, abs=1e-3)
    assert abs(orbit.mean_speed_change) < 1e-3 * most


@pytest.mark.parametrize("mass", [0.0, 0.02])
def test_both_phases_always_on_come_to_the_plain_wave(motor, mass):
    drive = ts.Drive(periods=1, on_periods=1, frequency_difference=500.0, load_torque=0.4)
    values = lap_values(motor, drive, Levels(compliance="flange"), rotor_mass=mass, steps=200)
    orbit = orbit_from(values, start_of("steady", values), "steady", settling=200)
    plain = plain_waves(coupled_values(motor, drive, Levels(compliance="flange", coupling="contact")))
    assert orbit.closed
    assert orbit.stable
    assert orbit.mean_speed == pytest.approx(plain.speed[-1], rel=1e-6)
    assert orbit.deviation < 1e-6 * orbit.mean_speed
    assert math.hypot(orbit.state[0], orbit.state[2]) == pytest.approx(plain.amplitude[-1], rel=1e-6)
    assert orbit.input_power == pytest.approx(plain.input_power[-1], rel=1e-5)
    assert orbit.contact_fraction == pytest.approx(plain.half_angle[-1] / math.pi, rel=1e-5)


def test_an_orbit_of_pulses_repeats_and_its_disturbances_die_out_as_laps_do(motor):
    values = lap_values(motor, ts.Drive(), Levels(), steps=60)
    (orbit,) = coupled_orbits(values)  # both starts lead to one
    assert orbit.closed
    assert orbit.stable
    aside = orbit.state[:, np.newaxis] * (1 + 1e-4)
    first, _ = laps(values, aside)
    for _ in range(3):
        aside, _ = laps(values, aside)
    later, _ = laps(values, aside)
    sizes = np.abs(orbit.state)[[0, 1, 2, 3, 6], np.newaxis]
    gaps = [np.abs((end - orbit.state[:, np.newaxis])[[0, 1, 2, 3, 6]] / sizes).max() for end in (first, later)]
    rate = (gaps[1] / gaps[0]) ** (1 / 4)
    assert rate < 1.1 * np.abs(orbit.multipliers).max()


def test_a_sweep_goes_on_from_the_orbit_before(motor):
    """Where there is one orbit, it is that of any start; the second begins so near that few laps are needed first."""
    points = [
        lap_values(motor, ts.Drive(frequency_difference=f), Levels(compliance="flange"), steps=40)
        for f in (2990.0, 3e3)
    ]
    first, second = followed(points, 6)
    assert (first.start, second.start) == ("steady", "followed")
    assert second.closed
    assert second.mean_speed == pytest.approx(coupled_orbits(points[1], ("rest",))[0].mean_speed, rel=1e-7)


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_one_phase_without_prepressure_has_the_free_amplitude(motor):
    motor = motor.with_values({"amplitude_factor": 1.0, "amplitude_exponent": 0.0})  # eq. 8 would have no end
    drive = ts.Drive(prepressure=1e-3, frequency_difference=0.0)
    values = coupled_values(motor, ts.Drive(prepressure=1e-3, frequency_difference=0.0, on_periods=20), Levels())
    own, turn = values["omega_n0"], values["omega_q"]
    free = values["F_q"] / values["M_q"] / abs(complex(own**2 - turn**2, 2 * values["xi"] * own * turn))
    orbit = one_phase(motor, drive, Levels(), rotor_mass=0.0, steps=100)
    assert orbit.highest_wave == pytest.approx(free, rel=1e-3)  # at the steps' ends
    assert abs(orbit.state[STATE.index("w_B")]) < 1e-15
    assert abs(orbit.mean_speed) < 1e-9


@pytest.mark.parametrize(
    ("drive", "words", "naming"),
    [
        ({"start": "steady"}, {}, "start: got steady, need periodic where coupling is contact"),
        ({}, {"rotor_mass": -1.0}, "rotor_mass: got -1"),
        ({}, {"steps": 3}, "steps: got 3"),
        ({}, {"steps": 100.5}, "steps: got 100.5"),
    ],
)
def test_what_a_lap_cannot_take_is_refused(motor, drive, words, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        lap_values(motor, ts.Drive(**drive), Levels(), **words)


def test_a_start_that_is_none_is_refused(motor):
    with pytest.raises(ts.ParameterError, match="start: got moving, need one of rest, steady"):
        start_of("moving", lap_values(motor, ts.Drive(), Levels()))
