"""Certificates of orbits: of a plain wave known in closed form, beside the finest steps, moved away, where none is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model.coupled_orbit import LapSystem, lap_values, orbit_from, start_of
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels
from trum_sym.model.orbit_certificate import certificate_of


@pytest.fixture(scope="module")
def pulsed():
    values = lap_values(ts.load_motor(), ts.Drive(), Levels(compliance="flange"), rotor_mass=0.02)
    return values, orbit_from(values, start_of("steady", values), "steady")


@pytest.mark.parametrize("mass", [0.0, 0.02])
def test_a_plain_wave_in_closed_form_lies_within_what_is_stated(mass):
    """Its height, lead, speed and contact are roots of a balance of numbers, without any step in time."""
    from studies.coupling import guessed

    drive, levels = ts.Drive(periods=1, on_periods=1, frequency_difference=500.0), Levels(compliance="flange")
    values = lap_values(ts.load_motor(), drive, levels, rotor_mass=mass)
    orbit = orbit_from(values, start_of("steady", values), "steady")
    wave = plain_waves(coupled_values(ts.load_motor(), drive, Levels(compliance="flange", coupling="contact")))
    k = wave.highest
    figures = (float(of[k]) for of in (wave.amplitude, wave.lead, wave.speed * values["r_c"], wave.half_angle))
    lead = values["force_phase"]  # of A's force where the cycle begins
    amplitude, ahead, speed, half_angle = figures
    truth = guessed(values, amplitude, ahead - lead, speed, half_angle)
    found = certificate_of(values, orbit)
    assert found.certified
    assert found.stable
    assert found.radius < 1e-6
    assert (np.abs(orbit.state - truth) <= found.state_error + 1e-12 * np.abs(truth)).all()


@pytest.mark.parametrize("seed", [3, 31])
def test_what_is_stated_holds_beside_the_finest_steps(seed):
    """A sample; `python -m studies.orbit_certificate 200` checks more."""
    from studies.orbit_certificate import checked

    found = checked(seed)
    assert found["certified"]
    assert found["state"] < 1
    assert max(found["figures"]) < 1
    assert found["discs"] < 1
    assert found["back"] == 4


def test_a_state_that_is_moved_has_the_orbit_within_as_much_and_no_more(pulsed):
    values, orbit = pulsed
    system, exact = LapSystem(values), certificate_of(values, orbit)
    ways = np.array([1, -1, 1, -1, 1, -1, 1])
    for share, certified in ((1e-3, True), (0.05, True), (30.0, False)):
        aside = share * exact.alone_within * ways
        found = certificate_of(values, replace(orbit, state=orbit.state + aside * system.sizes))
        assert found.certified is certified, found.reason
        if certified:
            assert (np.abs(aside * system.sizes) <= found.state_error + exact.state_error).all()
            assert found.radius < 3 * np.abs(aside).max()
        else:
            assert (found.radius, found.alone_within, found.stable) == (np.inf, 0.0, False)
            assert "of the state's size" in found.reason


def test_a_lap_that_cannot_be_stepped_is_refused(pulsed):
    values, orbit = pulsed
    found = certificate_of(values, replace(orbit, state=np.full(7, np.nan)))
    assert not found.certified
    assert "cannot be stepped" in found.reason


def _plain(seed: int, share: float) -> tuple[dict[str, float], list[np.ndarray]]:
    """Laps of a random plain wave, at a share of its modal force, and all states (7,) in which it stands, by height."""
    from studies.coupling import draw, guessed

    at, drive = draw(seed), ts.Drive(periods=1, on_periods=1)
    values = lap_values(ts.load_motor(), drive, Levels(), rotor_mass=0.0) | at
    values |= {"F_q": share * at["F_q"], "force_phase": 0.0, "held": 0.0}
    values["size"] = values["F_q"] / values["M_q"] / (2 * values["xi"] * values["omega_n0"] ** 2)
    waves = plain_waves({**at, "F_q": values["F_q"]})
    rows = zip(waves.amplitude, waves.lead, waves.speed * values["r_c"], waves.half_angle, strict=True)
    return values, [guessed(values, *map(float, row)) for row in rows if row[0] > 0]


def test_a_box_in_which_an_orbit_is_alone_does_not_reach_the_neighbour_and_past_their_fold_there_is_none():
    """Of two plain waves in closed form, which meet and vanish as the force falls."""
    seed, low, high = 93, 0.37, 0.39
    for _ in range(7):
        middle = (low + high) / 2
        low, high = (low, middle) if len(_plain(seed, middle)[1]) > 1 else (middle, high)
    for share in (1.0, high + 0.001):
        values, states = _plain(seed, share)
        for state, other in ((states[-1], states[-2]), (states[-2], states[-1])):
            orbit = orbit_from(values, state, "closed form", settling=0)
            found = certificate_of(values, orbit)
            apart = LapSystem(values).distance(state, other)
            assert LapSystem(values).distance(orbit.state, state) < 1e-6
            assert found.certified, found.reason
            assert found.alone_within < apart
            assert found.stable is (state is states[-1])
    values, _ = _plain(seed, low - 1e-3)
    past = orbit_from(values, _plain(seed, high)[1][-1], "past", settling=0)
    assert not certificate_of(values, past).certified


@pytest.mark.slow
def test_past_a_fold_nothing_is_certified():
    """Where the upper branch of a rotor of 0.1 kg ends."""
    from studies.orbit_certificate import _at, branch

    hertz, last = branch()[-1]
    for off in (0.01, 1.0):
        values = _at(hertz + off)
        assert not certificate_of(values, orbit_from(values, last.state, "followed", settling=0)).certified
