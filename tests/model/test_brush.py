"""Friction of a plain wave over a layer of bristles, against bristles moved step by step, limits and a hand value."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.kernels import call

PLAIN = ts.Drive(frequency_difference=500.0, on_periods=20, load_torque=0.4)


def fraction(theta, grip, ratio):
    return float(call("brush_friction", {"theta": theta, "grip": grip, "ratio": ratio})["f"])


def stepped(theta, grip, ratio, count=20_000):
    """A bristle carried through the contact in small steps: sheared by the slip, held to what friction can hold."""
    u = np.linspace(-theta, theta, count + 1)
    limit = (np.cos(u) - math.cos(theta)).tolist()
    sheared = np.diff(grip * (np.sin(u) - ratio * u)).tolist()
    stress, total = 0.0, 0.0
    for most, by in zip(limit[1:], sheared, strict=True):
        before, stress = stress, min(max(stress + by, -most), most)
        total += (before + stress) / 2
    return total / math.fsum(limit)


def states(count):
    draw = np.random.default_rng(20)
    for _ in range(count):
        yield draw.uniform(0.1, 3.1), 10 ** draw.uniform(-1, 2.5), draw.uniform(-1.3, 1.3)


def test_friction_is_that_of_bristles_moved_step_by_step():
    for theta, grip, ratio in states(100):
        assert fraction(theta, grip, ratio) == pytest.approx(stepped(theta, grip, ratio), abs=3e-8 * (1 + grip)), (
            theta,
            grip,
            ratio,
        )


def test_without_bound_the_grip_is_rigid_friction():
    """Of a rigid layer the share of the pressure where the surface is faster, less that where it is slower."""
    for theta in (0.2, 0.38, 1.2, 2.5, 3.1):
        for ratio in (-0.9, -0.2, 0.0, 0.5, 0.93, 0.99, 1.1):
            at = min(theta, math.acos(max(-1.0, min(1.0, ratio))))
            carried = (math.sin(at) - at * math.cos(theta)) / (math.sin(theta) - theta * math.cos(theta))
            gaps = [abs(fraction(theta, grip, ratio) - (2 * carried - 1)) for grip in (1e3, 1e5, 1e9)]
            assert gaps[2] < 1e-6
            assert gaps[1] < 0.05


def test_friction_of_a_held_rotor_by_hand():
    # grip 1, theta pi/3: sticks up to pi/3 - pi/2 = -pi/6, the stress being sin u + sin(pi/3); then slides.
    # stuck: cos(pi/3) - cos(pi/6) + sin(pi/3) pi/6 = 0.5 - 0.866025 + 0.453450 = 0.087425
    # slid: sin(pi/3) + sin(pi/6) - cos(pi/3) pi/2 = 0.866025 + 0.5 - 0.785398 = 0.580627
    # all: 2 (sin(pi/3) - pi/3 cos(pi/3)) = 0.684853; together 0.668052 / 0.684853 = 0.975467
    assert fraction(math.pi / 3, 1.0, 0.0) == pytest.approx(0.975467, abs=2e-6)
    assert fraction(math.pi / 4 * 0.99, 1.0, 0.0) == pytest.approx(1, abs=1e-15)  # below atan(grip) all slides


def test_friction_falls_with_the_speed_and_stays_within_what_it_can_carry():
    ratios = np.linspace(-1.2, 1.2, 241)
    for theta, grip, _ in states(30):
        found = call("brush_friction", {"theta": theta, "grip": grip, "ratio": ratios})["f"]
        assert (np.diff(found) <= 1e-13).all()
        assert np.abs(found).max() <= 1 + 1e-14


def test_the_speed_is_where_friction_carries_the_fraction():
    for theta, grip, _ in states(60):
        for wanted in (-0.99, -0.3, 0.0, 0.49, 0.9):
            found = call("brush_speed", {"theta": theta, "grip": grip, "f": wanted})
            assert 0 < found["ratio_error"] < 1e-10
            there = call("brush_friction", {"theta": theta, "grip": grip, "ratio": found["ratio"]})
            assert abs(there["f"] - wanted) < there["f_error"] < 3e-12


def test_a_stiff_brush_is_the_rigid_layer_at_an_operating_point(trum60):
    stiff = trum60.with_values({"tangential_stiffness": 1e19})
    for levels in ({}, {"compliance": "flange"}):
        rigid = ts.evaluate(trum60, PLAIN, tolerance=1e-9, **levels)
        brush = ts.evaluate(stiff, PLAIN, tangential="brush", **levels)
        assert brush.mean_speed == pytest.approx(rigid.mean_speed, rel=1e-7)
        assert brush.stall_torque == pytest.approx(rigid.stall_torque, rel=1e-7)
        assert brush.contact_fraction == pytest.approx(rigid.contact_fraction, rel=1e-9)


def test_an_operating_point_is_the_steady_speed_of_its_bristles(trum60):
    """Friction summed over stepped bristles at the speed that is found carries the load."""
    point = ts.evaluate(trum60, PLAIN, tangential="brush")
    crest = point.neutral_axis * point.wavenumber * point.amplitude * 2 * np.pi * point.drive_frequency
    shear = 5e9 / (2 * 1.3) * 1.2e-3 / 0.2e-3  # G b_m / h_m
    grip = shear * point.neutral_axis * point.wavenumber / (0.25 * 3e10)
    theta = math.pi * point.contact_fraction
    carried = stepped(theta, grip, point.mean_speed * 0.0265 / crest, 200_000)
    assert carried * 0.25 * 180 * 0.0265 == pytest.approx(0.4, rel=1e-7)
    assert stepped(theta, grip, 0.0) * 0.25 * 180 * 0.0265 == pytest.approx(point.stall_torque, rel=1e-6)
    assert point.min_speed == point.mean_speed == point.max_speed
    assert point.speed_volatility == 0
    assert point.converged


def test_the_other_lead_turns_everything_round(trum60):
    ahead, behind = (
        ts.evaluate(trum60, ts.Drive(on_periods=20, load_torque=load, phase_lead=lead), tangential="brush")
        for load, lead in ((0.4, 1), (-0.4, -1))
    )
    assert behind.mean_speed == -ahead.mean_speed
    assert behind.stall_torque == -ahead.stall_torque


def test_a_load_beyond_friction_runs_away_and_the_others_of_a_batch_do_not(trum60):
    drive = ts.Drive(on_periods=20, load_torque=np.array([0.4, 1.3, -1.3]))
    point = ts.evaluate(trum60, drive, tangential="brush")
    assert np.isfinite(point.mean_speed).tolist() == [True, False, False]
    assert point.converged.tolist() == [True, False, False]
    assert all("no speed balances the load" in reason for reason in point.reason[1:])
    one = ts.evaluate(trum60, ts.Drive(on_periods=20, load_torque=0.4), tangential="brush")
    assert point.mean_speed[0] == one.mean_speed


def test_histories_of_a_brush_are_those_of_a_steady_rotor(trum60):
    pytest.importorskip("xarray")
    found = ts.simulate(trum60, PLAIN, tangential="brush", cycles=2)
    speed = ts.evaluate(trum60, PLAIN, tangential="brush").mean_speed
    assert (found["rotor_speed"].values == speed).all()
    assert found["rotor_angle"].values == pytest.approx(speed * found["time"].values, rel=1e-12)
    assert found["friction"].values == pytest.approx(0.4 / (0.25 * 180 * 0.0265))


@pytest.mark.parametrize(
    ("drive", "values", "naming"),
    [
        ({"on_periods": 14}, {}, "tangential: got brush, need rigid in pulse drive"),
        ({"start": "rest"}, {}, "tangential: got brush, need rigid where start is rest"),
        ({}, {"friction_coefficient": 0}, "friction_coefficient: got 0, need a number > 0 where tangential is brush"),
    ],
)
@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_where_bristles_are_not_known_they_are_refused(trum60, drive, values, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        ts.evaluate(trum60.with_values(values), ts.Drive(**{"on_periods": 20, **drive}), tangential="brush")


@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_where_the_whole_wave_touches_there_is_no_figure_and_a_reason(trum60):
    soft = trum60.with_values({"layer_stiffness": np.array([1e8, 3e10])})
    point = ts.evaluate(soft, PLAIN, tangential="brush")
    assert np.isnan(point.mean_speed).tolist() == np.isnan(point.stall_torque).tolist() == [True, False]
    assert point.contact_fraction[0] == 1
    assert point.converged.tolist() == [False, True]
    assert point.reason.tolist() == ["the whole wave touches: no bristle of the layer leaves the contact", ""]


def test_slopes_of_a_brush_are_refused(trum60):
    with pytest.raises(ts.ParameterError, match="tangential: got brush, need rigid"):
        ts.sensitivities(trum60, PLAIN, tangential="brush")


def test_the_console_takes_both_levels(capsys):
    arguments = ["--on-periods", "20", "--load-torque", "0.4", "--compliance", "flange", "--tangential", "brush"]
    assert main(["evaluate", "--json", *arguments]) == 0
    drive = ts.Drive(on_periods=20, load_torque=0.4)
    point = ts.evaluate(ts.load_motor(), drive, compliance="flange", tangential="brush")
    assert json.loads(capsys.readouterr().out)["mean_speed"] == point.mean_speed
