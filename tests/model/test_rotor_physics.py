"""Closed forms, energy and the edges of the model, through the kernels and ``evaluate``."""

from __future__ import annotations

import math
import warnings

import mpmath as mp
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lazily import lazily

import trum_sym as ts
from trum_sym.model.kernels import call

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")  # friction from none to any

orbit_reference = lazily("orbit_reference")
LIMIT = 0.0265 * 0.25 * 180.0  # r_c mu F_c of TRUM-60 at Table 3, N m


def contact(theta):
    """The Winkler layer's kernel at the load that closes it over theta, found at 40 digits."""
    with mp.workdps(40):
        y = mp.sin(theta) - theta * mp.cos(theta)
        fullness, root = float(y / mp.pi), float(mp.cbrt(y / mp.pi))
        return {
            **call("trum_contact_winkler", {"fullness": fullness, "fullness_root": root}),
            "engagement": float(1 / y),
        }


def friction(contact, phi, ratio):
    wave = {"R_v": 1.0, "phi": phi, "cos_phi": np.cos(phi), "sin_phi": np.sin(phi)}
    return call("trum_friction", {**contact, **wave, "v": ratio})["f"]


@pytest.mark.parametrize("theta", [0.1, 0.3, 0.5, 0.8, 1.2, math.pi / 2, 2.0, 2.6, 3.0])
def test_steady_wave_torque_against_speed_is_the_closed_form(theta):
    """Model: f = 2 (sin a - a cos theta)/(sin theta - theta cos theta) - 1, the rotor as fast as the point at a."""
    kernel = contact(theta)
    allowed = 1e-12 * max(1.0, (0.4 / theta) ** 3)  # theta - sin theta cos theta loses digits as theta cubed
    with mp.workdps(40):
        for share in np.linspace(0.02, 0.98, 25):
            a = mp.mpf(theta) * mp.mpf(share)
            exact = 2 * (mp.sin(a) - a * mp.cos(theta)) / (mp.sin(theta) - theta * mp.cos(theta)) - 1
            torque = call(
                "trum_stall_torque",
                {"F_c": 180.0, "mu": 0.25, "r_c": 0.0265, "f": friction(kernel, 0.0, float(mp.cos(a)))},
            )
            assert abs(torque["torque"] / LIMIT - exact) < allowed
    slower = np.cos(theta) - np.linspace(1e-9, 1.0, 50)  # the plateau: all of the contact is faster
    assert np.max(np.abs(friction(kernel, 0.0, slower) - 1)) < allowed


def plain(trum60, load, **more):
    """A plain travelling wave: both phases always on.  Also its surface speed at the crest and its half-angle."""
    point = ts.evaluate(trum60, ts.Drive(on_periods=20, start="steady", load_torque=load), tolerance=1e-9, **more)
    crest = point.neutral_axis * point.wavenumber * point.amplitude * 2 * np.pi * point.drive_frequency
    y = 180.0 * point.wavenumber / (2 * 9 * 3e10 * point.amplitude)
    return point, crest / 0.0265, mp.findroot(lambda x: mp.sin(x) - x * mp.cos(x) - y, (3 * y) ** (1 / 3))


@pytest.mark.parametrize("share", [0.0, 0.4, -0.7, 0.999])
def test_a_plain_travelling_wave_turns_the_rotor_at_the_ratio_of_the_closed_form(trum60, share):
    point, crest, theta = plain(trum60, share * LIMIT)
    norm = mp.sin(theta) - theta * mp.cos(theta)
    a = mp.findroot(lambda a: 2 * (mp.sin(a) - a * mp.cos(theta)) / norm - 1 - share, (0, theta), solver="anderson")
    assert point.converged
    assert point.mean_speed == pytest.approx(float(crest * mp.cos(a)), rel=1e-9)
    assert point.max_speed - point.min_speed < 1e-9 * crest


def test_a_load_on_the_plateau_stops_nothing_and_one_above_it_leaves_no_speed(trum60):
    point, crest, theta = plain(trum60, LIMIT * (1 - 1e-9))
    assert point.stall_torque == pytest.approx(LIMIT, rel=1e-12)
    assert point.mean_speed == pytest.approx(float(crest * mp.cos(theta)), rel=1e-4)
    for load in (LIMIT * (1 + 1e-9), -LIMIT * (1 + 1e-9)):
        above, *_ = plain(trum60, load)
        assert math.isnan(above.mean_speed)
        assert not above.converged


DRIVES = [
    {"periods": 6, "on_periods": 4, "load_torque": 0.2},
    {"periods": 8, "on_periods": 5, "start": "steady", "load_torque": -0.3, "phase_lead": -1},
    {"periods": 7, "on_periods": 5, "start": "rest", "load_torque": 0.0, "frequency_difference": -2000.0},
    {"periods": 5, "on_periods": 5, "load_torque": 0.4, "switching_phase": 0.7},
]


@pytest.mark.parametrize("drive", DRIVES)
def test_the_surface_pays_for_the_load_and_the_heat(trum60, drive):
    """Work of the surface and heat are the reference's integrals along its orbit, the load's power is the product's."""
    drive = ts.Drive(**drive)
    point = ts.evaluate(trum60, drive, tolerance=1e-9)
    orbit = orbit_reference.Reference(trum60, drive, point).orbit()
    assert orbit.heat > 0
    delivered = float(drive.load_torque) * point.mean_speed
    assert abs(orbit.surface_power - orbit.heat - delivered) < 1e-8 * (orbit.heat + abs(delivered))


def test_all_sixteen_transfer_cases_are_hit_and_each_agrees_with_the_cut_surface():
    """Figs. 7, 8: the rotor's direction, the signs of v_x - v at crest and edge, an extremum between them."""
    rng = np.random.default_rng(16)
    hit: dict[tuple[bool, bool, bool, bool], int] = {}
    for _ in range(4000):
        theta, phi, ratio = rng.uniform(0.3, 3.1), rng.uniform(-np.pi, np.pi), rng.uniform(-0.99, 0.99)
        at_crest, at_edge = np.cos(phi) > ratio, np.cos(theta - phi) > ratio
        extremum = any(0 < turn < theta for turn in (phi, phi + np.pi))
        case = (ratio > 0, at_crest, at_edge, extremum)
        if hit.get(case, 0) >= 25:
            continue
        hit[case] = hit.get(case, 0) + 1
        y = np.sin(theta) - theta * np.cos(theta)
        p = np.zeros(12)
        p[6], p[7] = 1.0, y  # unit height and speed: v_x = cos(u - phi) with the crest at kx = 0
        w = np.array([0.0, 1.0, np.cos(phi), -np.sin(phi)])
        assert friction(contact(theta), phi, ratio) == pytest.approx(orbit_reference.surface(p, w, ratio)[0], abs=1e-10)
    assert len(hit) == 16
    assert min(hit.values()) >= 10


def test_nothing_breaks_where_the_wave_passes_through_zero(trum60):
    """After a start from rest with A off first the wave stands: its height passes through zero twice a period."""
    drive = ts.Drive(periods=4, on_periods=2, start="rest", load_torque=0.05)
    point = ts.evaluate(trum60, drive, tolerance=1e-7)
    orbit = orbit_reference.Reference(trum60, drive, point).orbit()
    assert point.converged
    assert np.abs(np.array([point.mean_speed - orbit.mean, point.max_speed - orbit.high])).max() < 1e-7 * orbit.largest


@pytest.mark.parametrize(("prepressure", "always"), [(3e3, False), (1e5, True)])
def test_a_whole_wave_in_contact_is_a_state_of_its_own(trum60, prepressure, always):
    motor = trum60.with_values({"amplitude": 1e-6, "resonance_frequency": 39e3})
    drive = ts.Drive(prepressure=prepressure, periods=6, on_periods=4, load_torque=1.0)
    point = ts.evaluate(motor, drive, tolerance=1e-7)
    orbit = orbit_reference.Reference(motor, drive, point).orbit()
    heights = np.hypot(*(ts.simulate(motor, drive, tolerance=1e-7)[name].values for name in ("w_A", "w_B")))
    whole = 3e10 * 2 * 9 * heights / (prepressure * point.wavenumber) < 1 / np.pi  # k_N W_c pi 2 n_j / k_c < F_c
    assert whole.all() if always else (whole.any() and not whole.all())
    assert (point.contact_fraction == pytest.approx(1.0, abs=1e-12)) is always
    assert point.converged
    assert abs(point.mean_speed - orbit.mean) < 1e-7 * orbit.largest


@pytest.mark.parametrize("inertia", [1e-9, 10.0])
def test_the_lightest_and_the_heaviest_rotor_agree_with_the_independent_orbit(trum60, inertia):
    motor = trum60.with_values({"rotor_inertia": inertia})
    drive = ts.Drive(periods=4, on_periods=3, load_torque=0.1)
    point = ts.evaluate(motor, drive, tolerance=1e-6)
    orbit = orbit_reference.Reference(motor, drive, point, tolerance=1e-11).orbit()
    assert point.converged
    ours = np.array([point.mean_speed, point.min_speed, point.max_speed])
    assert np.abs(ours - [orbit.mean, orbit.low, orbit.high]).max() < 1e-6 * orbit.largest


def test_a_rotor_that_outruns_all_of_the_surface_agrees_with_the_independent_orbit(trum60):
    """Each cycle begins with the stator at rest while the load drives the rotor on: nothing there is as fast."""
    drive = ts.Drive(load_torque=-0.8 * LIMIT, periods=6, on_periods=4, start="rest")
    point = ts.evaluate(trum60, drive, tolerance=1e-7)
    orbit = orbit_reference.Reference(trum60, drive, point).orbit()
    assert point.converged
    assert orbit.start > 0.5 * orbit.mean > 0
    ours = np.array([point.mean_speed, point.min_speed, point.max_speed])
    assert np.abs(ours - [orbit.mean, orbit.low, orbit.high]).max() < 1e-7 * orbit.largest


@pytest.mark.parametrize(
    "drive", [{"on_periods": 20}, {"on_periods": 10}, {"load_torque": 0.0}, {"periods": 1, "on_periods": 1}]
)
@pytest.mark.parametrize("start", ["periodic", "steady", "rest"])
def test_the_edges_of_the_drive_have_an_orbit(trum60, drive, start):
    point = ts.evaluate(trum60, ts.Drive(**{"load_torque": 0.1, **drive}, start=start))
    assert point.converged
    assert point.min_speed <= point.mean_speed <= point.max_speed


def test_next_to_no_friction_is_an_orbit_and_none_is_flagged(trum60):
    drive = ts.Drive(load_torque=0.0, periods=6, on_periods=4)
    little = ts.evaluate(trum60.with_values({"friction_coefficient": 1e-9}), drive)
    assert little.converged
    assert 0 < abs(little.stall_torque) <= 1e-9 * 0.0265 * 180.0
    none = ts.evaluate(trum60.with_values({"friction_coefficient": 0.0}), drive)
    assert math.isnan(none.mean_speed)
    assert not none.converged


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    prepressure=st.floats(1.0, 1e4),
    frequency_difference=st.floats(-2e4, 2e4),
    pulses=st.integers(1, 30).flatmap(lambda m: st.tuples(st.just(m), st.integers((m + 1) // 2, m))),
    load=st.one_of(st.just(0.0), st.floats(-3.0, 3.0)),
    switching_phase=st.floats(-10.0, 10.0),
    lead=st.sampled_from([-1, 1]),
    start=st.sampled_from(["periodic", "steady", "rest"]),
    law=st.sampled_from(["winkler", "hertz"]),
    inertia=st.floats(-9, 1).map(lambda e: 10.0**e),
    friction_coefficient=st.one_of(st.just(0.0), st.floats(1e-6, 2.0)),
    amplitude=st.floats(-8, -4).map(lambda e: 10.0**e),
    damping=st.floats(1e-4, 0.2),
)
def test_no_input_of_the_domain_gives_a_silent_nan(
    trum60,
    prepressure,
    frequency_difference,
    pulses,
    load,
    switching_phase,
    lead,
    start,
    law,
    inertia,
    friction_coefficient,
    amplitude,
    damping,
):
    motor = trum60.with_values(
        {
            "rotor_inertia": inertia,
            "friction_coefficient": friction_coefficient,
            "amplitude": amplitude,
            "damping_ratio": damping,
            "resonance_frequency": 39e3,
        }
    )
    drive = ts.Drive(
        prepressure=prepressure,
        frequency_difference=frequency_difference,
        periods=pulses[0],
        on_periods=pulses[1],
        load_torque=load,
        switching_phase=switching_phase,
        phase_lead=lead,
        start=start,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        point = ts.evaluate(motor, drive, contact=law)
    speeds = [point.mean_speed, point.min_speed, point.max_speed]
    limit = friction_coefficient * prepressure * 0.0265
    if abs(load) >= limit:
        assert not point.converged
        assert all(math.isnan(speed) for speed in speeds)
    elif point.converged:
        assert all(math.isfinite(speed) for speed in speeds)
        assert point.min_speed - 1e-9 <= point.mean_speed <= point.max_speed + 1e-9
    assert math.isfinite(point.stall_torque)
    assert abs(point.stall_torque) <= limit * (1 + 1e-9)
    assert 0 < point.contact_fraction <= 1 + 1e-12
