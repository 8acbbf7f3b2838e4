"""The rotor's orbit against an independent one; and that one against quadrature, SciPy and itself at finer steps."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy
from lazily import lazily

import trum_sym as ts
from studies.orbit import disagreement, evaluate, reference, samples

orbit_reference = lazily("orbit_reference")
SMALL = samples(12, seed=7, periods=(4, 9))
# From rest, the load drives: for moments only does the crest sweep past points that are faster than the rotor
BRIEF = samples(60, seed=99, periods=(4, 12))[53]


@pytest.fixture(scope="module")
def answers():
    return evaluate(SMALL, 1e-6)


@pytest.fixture(scope="module")
def steady(answers):
    """A point that is not runaway, of every start."""
    chosen = {}
    for point, answer in zip(SMALL, answers, strict=True):
        if not reference(point, answer).runaway:
            chosen.setdefault(point.drive["start"], (point, answer))
    assert len(chosen) == 3
    return list(chosen.values())


@pytest.mark.parametrize("index", range(len(SMALL)))
def test_mean_extremes_and_fluctuation_agree_with_the_independent_orbit(answers, index):
    runaway, error = disagreement(SMALL[index], answers[index])
    if runaway:
        assert np.isnan(error).all()
        assert not answers[index].converged
    else:
        assert answers[index].converged
        assert np.abs(error).max() <= 1e-6, error


def test_moments_of_friction_are_not_missed():
    runaway, error = disagreement(BRIEF, evaluate([BRIEF], 1e-6)[0])
    assert not runaway
    assert np.abs(error).max() <= 1e-6, error


@pytest.mark.slow
def test_three_hundred_points_agree_with_the_independent_orbit():
    points = samples(300)
    orbits, wrong = 0, []
    for point, answer in zip(points, evaluate(points, 1e-6), strict=True):
        runaway, error = disagreement(point, answer)
        orbits += not runaway
        good = np.isnan(error).all() if runaway else np.abs(error).max() <= 1e-6
        if not good or answer.converged == runaway:
            wrong.append((point, error))
    assert orbits >= 200
    assert not wrong, wrong


def test_hertz_contact_agrees_with_the_independent_orbit(trum60):
    drive = ts.Drive(periods=6, on_periods=4, load_torque=0.1, start="rest")
    point = ts.evaluate(trum60, drive, contact="hertz", tolerance=1e-7)
    orbit = orbit_reference.Reference(trum60, drive, point, contact="hertz").orbit()
    ours = np.array([point.mean_speed, point.min_speed, point.max_speed])
    assert np.abs(ours - [orbit.mean, orbit.low, orbit.high]).max() <= 1e-7 * orbit.largest


def test_the_reference_counts_the_points_of_the_surface_that_are_faster_than_the_rotor(steady):
    other = reference(*steady[0])
    rng = np.random.default_rng(3)
    u = (np.arange(200_000) + 0.5) * 2 * np.pi / 200_000 - np.pi
    for _ in range(60):
        w = rng.normal(size=4) * np.array([1e-6, 1e-6, 0.3, 0.3]) * 10 ** rng.uniform(-2, 1)
        height, crest = np.hypot(w[0], w[1]), np.arctan2(w[0], w[1])
        theta = orbit_reference.half_angle(other.p, height)
        density = np.where(np.abs(u) < theta, np.cos(u) - np.cos(theta), 0.0)
        if theta == np.pi:
            density = np.cos(u) + other.p[7] / height / np.pi
        assert density.min() >= 0
        density /= density.sum()
        speed = other.p[6] * (w[2] * np.cos(crest + u) - w[3] * np.sin(crest + u))
        v = rng.uniform(-1.1, 1.1) * np.abs(speed).max()
        sign = np.sign(speed - v)
        brute = [np.sum(sign * density), np.sum(sign * density * speed), np.sum(density * np.abs(speed - v))]
        scale = np.array([1, np.abs(speed).max(), np.abs(speed).max()])
        assert np.abs(orbit_reference.surface(other.p, w, v) - np.array(brute)).max() / scale.max() < 1e-4


def test_the_references_half_angle_carries_the_prepressure(steady):
    p = reference(*steady[0]).p
    for height in np.geomspace(p[7] / math.pi * 1.0001, p[7] * 1e4, 40):
        theta = orbit_reference.half_angle(p, height)
        assert math.sin(theta) - theta * math.cos(theta) == pytest.approx(p[7] / height, rel=1e-10)
    assert orbit_reference.half_angle(p, p[7] / 3.15) == math.pi


def test_the_references_phases_are_continuous_over_the_regions_and_repeat(steady):
    for point, answer in steady:
        other = reference(point, answer)
        ends = [
            orbit_reference.modal(other.p, other.states[r], orbit_reference.GATES[r], other.durations[r])[[0, 2, 1, 3]]
            for r in range(3)
        ]
        scale = np.array([1, other.p[0]] * 2) * other.p[5]
        for r in (0, 1):
            assert np.abs((ends[r] - other.states[r + 1]) / scale).max() < 1e-10
        if point.drive["start"] == "periodic":
            assert np.abs((ends[2] - other.states[0]) / scale).max() < 1e-10


def test_the_reference_does_not_depend_on_its_own_steps(steady):
    for point, answer in [*steady, (BRIEF, evaluate([BRIEF], 1e-2)[0])]:
        orbits = [
            reference(point, answer, tolerance=tolerance, longest=longest).orbit()
            for tolerance, longest in ((1e-13, 1 / 40), (1e-14, 1 / 120))
        ]
        coarse, fine = (np.array([orbit.mean, orbit.low, orbit.high, orbit.deviation]) for orbit in orbits)
        assert np.abs(coarse - fine).max() <= 1e-8 * orbits[1].largest


def test_the_reference_closes_and_has_its_extremes_where_lsoda_has_them(steady):
    for point, answer in steady:
        other = reference(point, answer)
        orbit = other.orbit()
        v0, x, seen = orbit.start * other.radius, np.zeros(5), [0.0]
        for r in range(3):
            if other.durations[r] == 0:
                continue

            def derivative(t, x, r=r, other=other, v0=v0):
                out = np.empty(5)
                orbit_reference.rate(other.p, other.states[r], orbit_reference.GATES[r], t, v0, x, out)
                return out

            def turning(t, x, derivative=derivative):
                return derivative(t, x)[0]

            steps = scipy.integrate.solve_ivp(
                derivative,
                (0, other.durations[r]),
                x,
                "LSODA",
                rtol=1e-12,
                atol=1e-14,
                events=turning,
                max_step=other.cycle_time / point.drive["periods"] / 400,
            )
            x = steps.y[:, -1]
            seen += [x[0], *(state[0] for state in steps.y_events[0])]
        scale = orbit.largest * other.radius
        assert abs(x[0]) <= 1e-8 * scale
        assert abs(v0 + x[1] / other.cycle_time - orbit.mean * other.radius) <= 1e-8 * scale
        assert abs(v0 + min(seen) - orbit.low * other.radius) <= 1e-8 * scale
        assert abs(v0 + max(seen) - orbit.high * other.radius) <= 1e-8 * scale
