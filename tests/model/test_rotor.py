"""Contact, friction and the rotor's orbit against quadrature, closed forms and an ODE solver."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import scipy

import trum_sym as ts
from trum_sym import _kernels
from trum_sym.console import main
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")  # friction from none to any


def winkler(y):
    """theta, engagement 1/y and share of the Winkler layer at load y = sin theta - theta cos theta."""
    fullness = min(1.0, y / math.pi)
    found = call("trum_contact_winkler", {"fullness": fullness, "fullness_root": np.cbrt(fullness)})
    return {**found, "engagement": 1 / y}


def friction(contact, R_v, phi, v):
    return call(
        "trum_friction",
        {**contact, "R_v": R_v, "phi": phi, "cos_phi": np.cos(phi), "sin_phi": np.sin(phi), "v": v},
    )


def test_winkler_contact_solves_its_load_balance_over_the_whole_range():
    for theta in np.concatenate([np.geomspace(0.01, 3, 40), np.pi - np.geomspace(1e-4, 0.1, 20)]):
        found = winkler(np.sin(theta) - theta * np.cos(theta))
        assert found["theta"] == pytest.approx(theta, rel=1e-9)
        assert found["sin_theta"] == pytest.approx(np.sin(theta), rel=1e-6, abs=1e-12)
        assert found["share"] == pytest.approx(-np.cos(theta) * found["engagement"], rel=1e-8, abs=1e-9)


def pressure(u, contact):
    u = (u + np.pi) % (2 * np.pi) - np.pi
    density = contact["engagement"] * np.cos(u) + contact["share"]
    return np.where(np.abs(u) < contact["theta"], density / 2, 0.0)


@pytest.mark.parametrize("y", [1e-4, 0.02, 0.5, 2.0, 3.1, 3.5, 40.0])
def test_pressure_shares_sum_to_one(y):
    contact = winkler(y)
    assert scipy.integrate.quad(pressure, -np.pi, np.pi, args=(contact,), points=[-contact["theta"], contact["theta"]])[
        0
    ] == pytest.approx(1, rel=1e-8)


def test_friction_fraction_is_the_signed_share_of_pressure_for_random_waves():
    rng = np.random.default_rng(4)
    u = (np.arange(400_000) + 0.5) * 2 * np.pi / 400_000 - np.pi
    for _ in range(60):
        contact = winkler(np.exp(rng.uniform(-8, 3)))
        phi, v = rng.uniform(-np.pi, np.pi), rng.uniform(-1.2, 1.2)
        brute = np.mean(np.sign(np.cos(u - phi) - v) * pressure(u, contact)) * 2 * np.pi
        assert friction(contact, 1.0, phi, v)["f"] == pytest.approx(brute, abs=2e-4)


def test_friction_slope_is_the_derivative():
    rng = np.random.default_rng(5)
    for _ in range(60):
        contact = winkler(np.exp(rng.uniform(-6, 3)))
        phi, v, step = rng.uniform(-np.pi, np.pi), rng.uniform(-0.95, 0.95), 1e-6
        ahead, behind = (friction(contact, 1.0, phi, v + d)["f"] for d in (step, -step))
        slope = friction(contact, 1.0, phi, v)["f_v"]
        assert (ahead - behind) / (2 * step) == pytest.approx(slope, rel=1e-4, abs=1e-4)


def test_steady_wave_has_the_closed_form_of_friction_against_speed():
    for y in (0.02, 0.5, 2.5):
        contact = winkler(y)
        theta = contact["theta"]
        a = np.linspace(1e-3, 1, 9) * theta
        expected = 2 * (np.sin(a) - a * np.cos(theta)) / (np.sin(theta) - theta * np.cos(theta)) - 1
        assert friction(contact, 1.0, 0.0, np.cos(a))["f"] == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_friction_saturates_when_the_rotor_outruns_the_surface():
    contact = winkler(0.1)
    assert friction(contact, 1.0, 0.4, 1.001)["f"] == pytest.approx(-1, abs=1e-15)
    assert friction(contact, 1.0, 0.4, -1.001)["f"] == pytest.approx(1, abs=1e-15)


def settings(motor, drive, tolerance=1e-6, **levels):
    return ts.evaluate(motor, drive, tolerance=tolerance, **levels)


@pytest.mark.parametrize("load", [0.0, 0.5, -0.5, 1.1])
@pytest.mark.parametrize("inertia", [1e-9, 4.5e-6, 10.0])
def test_plain_travelling_wave_turns_the_rotor_where_friction_carries_the_load(trum60, load, inertia):
    motor = trum60.with_values({"rotor_inertia": inertia})
    point = settings(motor, ts.Drive(on_periods=20, start="steady", load_torque=load))
    y = 180.0 / (2 * 9 * 3e10 * point.amplitude / point.wavenumber)
    contact = winkler(y)
    limit = 0.0265 * 0.25 * 180.0
    surface = point.neutral_axis * point.wavenumber * point.amplitude * 2 * np.pi * point.drive_frequency
    rim = scipy.optimize.brentq(
        lambda v: friction(contact, surface, 0.0, v)["f"] - load / limit, -surface, surface, xtol=1e-14
    )
    assert point.mean_speed == pytest.approx(rim / 0.0265, rel=2e-6)
    assert point.max_speed - point.min_speed < 1e-4 * point.mean_speed
    assert point.stall_torque == pytest.approx(limit, rel=1e-9)
    assert point.contact_fraction == pytest.approx(contact["theta"] / np.pi, rel=1e-7)
    assert point.converged


@pytest.mark.parametrize(
    ("drive", "cycles"),
    [
        ({"periods": 6, "on_periods": 4, "start": "periodic", "load_torque": 0.0}, 12),
        ({"periods": 8, "on_periods": 5, "start": "steady", "load_torque": 0.1, "switching_phase": 0.7}, 12),
        ({"periods": 6, "on_periods": 3, "start": "rest", "load_torque": -0.1, "frequency_difference": -2000.0}, 14),
    ],
)
def test_orbit_agrees_with_lsoda_run_until_it_repeats(trum60, drive, cycles):
    from benchmarks.lsoda import lsoda_cycles

    drive = ts.Drive(**drive)
    point = settings(trum60, drive)
    *_, (mean, low, high) = lsoda_cycles(trum60, drive, point, cycles)
    scale = max(abs(low), abs(high))
    assert point.converged
    assert abs(point.mean_speed - mean) < 2e-5 * scale
    assert abs(point.min_speed - low) < 2e-4 * scale  # LSODA's own steps, without interpolation
    assert abs(point.max_speed - high) < 2e-4 * scale


def test_tighter_tolerances_move_the_figures_by_less_than_the_looser_one(trum60):
    drive = ts.Drive(prepressure=np.linspace(150, 220, 6), load_torque=0.1)
    loose, tight = (settings(trum60, drive, tolerance) for tolerance in (1e-4, 1e-7))
    scale = np.maximum(np.abs(tight.min_speed), np.abs(tight.max_speed))
    assert tight.converged.all()
    for name in ("mean_speed", "min_speed", "max_speed"):
        assert np.max(np.abs(getattr(loose, name) - getattr(tight, name)) / scale) < 1e-4


def test_fluctuation_falls_with_inertia_and_the_mean_settles(trum60):
    inertias = np.array([4.5e-4, 4.5e-3, 4.5e-2])
    point = settings(trum60.with_values({"rotor_inertia": inertias}), ts.Drive(load_torque=0.0))
    swing = point.max_speed - point.min_speed
    assert point.converged.all()
    assert swing[:-1] / swing[1:] == pytest.approx([10, 10], rel=0.02)
    assert point.mean_speed[1] == pytest.approx(point.mean_speed[2], rel=1e-3)


def test_every_instruction_set_gives_the_same_figures(trum60):
    """Fused multiply-add rounds once where the baseline rounds twice, and may make a step of another length."""
    drive = ts.Drive(prepressure=np.linspace(120, 220, 9), load_torque=0.1)
    best = list(_kernels.instruction_sets())[-1]
    figures = ("mean_speed", "min_speed", "speed_volatility", "stall_torque")
    found = {}
    for name in _kernels.instruction_sets():
        _kernels.use(name)
        found[name] = ts.evaluate(trum60, drive, tolerance=1e-6).figures
    _kernels.use(best)
    for point in found.values():
        for name in figures:
            assert np.all(
                np.abs(point[name] - found[best][name]) <= point[f"{name}_error"] + found[best][f"{name}_error"]
            )


def test_a_batch_gives_the_same_bits_as_its_points_one_by_one(trum60):
    periods, on = np.array([20, 10, 20, 12, 10]), np.array([14, 6, 14, 12, 6])
    batch = ts.evaluate(trum60, ts.Drive(periods=periods, on_periods=on, load_torque=0.1))
    for i in range(5):
        one = ts.evaluate(trum60, ts.Drive(periods=periods[i], on_periods=on[i], load_torque=0.1))
        assert (one.mean_speed, one.min_speed, one.max_speed) == (
            batch.mean_speed[i],
            batch.min_speed[i],
            batch.max_speed[i],
        )


@pytest.mark.parametrize("name", _kernels.instruction_sets())
def test_nodes_side_by_side_give_the_bits_of_nodes_in_turn(trum60, name):
    """With all lanes busy a step's nodes are evaluated in turn; with fewer points several at once, in idle lanes."""
    orbits = {}
    drive = ts.Drive(prepressure=np.linspace(120, 220, 8), periods=4, on_periods=3, load_torque=0.1)
    values = dict(prepare(trum60, drive, Levels(), 1e-3).arguments)
    best = list(_kernels.instruction_sets())[-1]
    _kernels.use(name)
    try:
        for together in (8, 1, 2, 3):
            parts = [
                call("rotor_orbit", {k: np.broadcast_to(v, 8)[i : i + together] for k, v in values.items()})
                for i in range(0, 8, together)
            ]
            orbits[together] = {k: np.concatenate([part[k] for part in parts]) for k in parts[0]}
    finally:
        _kernels.use(best)
    assert (orbits[8]["flags"] == orbits[8]["flags"][0]).all()
    for orbit in orbits.values():
        assert all(np.array_equal(orbit[k], orbits[8][k]) for k in orbit)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-6])
def test_a_line_of_contact_is_as_fast_as_its_wave(trum60, tolerance):
    """Bold steps chatter where the rotor has the speed of the wave, and are to be taken back."""
    values = {"amplitude": 5e-6, "resonance_frequency": 39e3, "layer_young_modulus": 1e15}
    drive = ts.Drive(on_periods=20, start="steady", load_torque=0.0)
    point = ts.evaluate(trum60.with_values(values), drive, tolerance=tolerance)
    # a plain wave's crest has the speed D k_c W omega_q, the edges of the contact less by theta^2/2 of it
    crest = point.neutral_axis * point.wavenumber * 5e-6 * 2 * np.pi * 42e3 / trum60.contact_radius.value
    assert point.converged
    theta = np.pi * point.contact_fraction
    assert theta < 0.01
    assert crest * (1 - theta**2 / 2) < point.mean_speed < crest


def test_a_load_beyond_friction_has_no_speed(trum60, capsys):
    point = ts.evaluate(trum60, ts.Drive(load_torque=np.array([1.0, 1.2, -1.2])))
    assert np.isfinite(point.mean_speed[0])
    assert np.isnan(point.mean_speed[1:]).all()
    assert point.converged.tolist() == [True, False, False]
    assert np.isfinite(point.stall_torque).all()
    assert main(["evaluate", "--load-torque", "1.2", "--json"]) == 1
    printed = json.loads(capsys.readouterr().out)
    assert printed["mean_speed"] is None
    assert printed["converged"] is False
    assert printed["reason"].startswith("no speed balances the load")
    main(["evaluate", "--load-torque", "1.2"])
    assert "no speed balances the load" in capsys.readouterr().out


def test_no_friction_and_no_load_leave_the_speed_open(trum60):
    point = ts.evaluate(trum60.with_values({"friction_coefficient": 0.0}), ts.Drive(load_torque=0.0))
    assert math.isnan(point.mean_speed)
    assert point.stall_torque == 0.0
    assert point.converged is False


def test_stall_torque_is_the_load_at_which_a_heavy_rotor_stands(trum60):
    motor = trum60.with_values({"rotor_inertia": 1.0})
    stall = ts.evaluate(motor, ts.Drive(load_torque=0.0), tolerance=1e-7).stall_torque
    loads = ts.Drive(load_torque=stall * np.array([0.999, 1.001]))
    assert np.sign(ts.evaluate(motor, loads, tolerance=1e-7).mean_speed).tolist() == [1, -1]


def test_reversing_the_wave_and_the_load_reverses_the_rotor(trum60):
    ahead = ts.evaluate(trum60, ts.Drive(load_torque=0.1), tolerance=1e-7)
    back = ts.evaluate(trum60, ts.Drive(load_torque=-0.1, phase_lead=-1), tolerance=1e-7)
    assert back.mean_speed == pytest.approx(-ahead.mean_speed, rel=1e-5)
    assert back.max_speed == pytest.approx(-ahead.min_speed, rel=1e-5)


def test_hertz_contact_runs_and_differs(trum60):
    layer, hertz = (ts.evaluate(trum60, ts.Drive(load_torque=0.0), contact=law) for law in ("winkler", "hertz"))
    assert hertz.converged
    assert hertz.contact_fraction > 1.5 * layer.contact_fraction


def test_an_encoder_sees_less_fluctuation_the_longer_it_averages(trum60):
    drive = ts.Drive(load_torque=0.0)
    cycle = ts.evaluate(trum60, drive).cycle_time
    seen = [ts.evaluate(trum60, drive, sampling_period=p).speed_volatility for p in (1e-9 * cycle, 2e-3, 5 * cycle)]
    assert seen[0] == pytest.approx(ts.evaluate(trum60, drive).speed_volatility, rel=5e-3)
    assert seen[1] < 0.2 * seen[0]
    assert seen[2] < 1e-6 * seen[0]


def test_newton_on_laps_does_not_go_round_in_circles(trum60):
    """Here Newton's steps lead from one end of the bracket to the other and back: their length has to be watched."""
    motor = trum60.with_values({"friction_coefficient": 0.15036263687842363, "rotor_inertia": 1.1334116873345693e-05})
    drive = ts.Drive(
        prepressure=151.94908881274398,
        frequency_difference=2783.3467231060276,
        load_torque=0.20079393255353645,
        periods=16,
        on_periods=10,
        start="steady",
    )
    fine = ts.evaluate(motor, drive, tolerance=1e-8)
    for tolerance in (1e-2, 3e-3, 1e-3, 3e-4):
        found = ts.evaluate(motor, drive, tolerance=tolerance)
        assert found.converged
        assert found.mean_speed == pytest.approx(fine.mean_speed, abs=tolerance * abs(float(fine.min_speed)))
