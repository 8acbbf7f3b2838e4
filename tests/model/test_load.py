"""The load's inertia: plate and weight, light and heavy, a string that goes slack."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from tests.refusals import refusal
from trum_sym.model.kernels import call
from trum_sym.model.string import SLACK

bench = lazily("studies.bench")
orbit = lazily("tests.orbit_reference")
J = 4.5e-6
SPEEDS = ("mean_speed", "min_speed", "max_speed", "speed_volatility")
REST = ts.Drive(start="rest", phase_lead=-1)
RIG = replace(REST, load="weight", load_radius=0.030)
ENOUGH = 0.25 * 180 * 0.0265 * 0.030 / 9.80665 - J  # of a plate: mu F_c r_c r/g - J, 3.64e-3 kg m^2


def test_a_plate_is_so_much_more_of_the_rotors_own(trum60):
    """To the last bit, and nothing at 0."""
    for inertia in (0.0, 2.5e-4, 1.0):
        heavier = trum60.with_values({"rotor_inertia": J + inertia})
        loaded = ts.evaluate(trum60, replace(REST, load_inertia=inertia))
        assert loaded.figures == ts.evaluate(heavier, REST).figures


def test_without_a_load_s_inertia_the_rotor_s_equation_is_eq_38_to_the_last_bit(trum60):
    """Push and drag as the product and quotient of eq. 38's numbers, in this order, with J alone."""
    rng, count = np.random.default_rng(38), 20_000
    drawn = {
        "F_c": rng.uniform(10, 400, count),
        "mu": rng.uniform(0.05, 0.5, count),
        "r_c": rng.uniform(0.01, 0.05, count),
        "J": 10 ** rng.uniform(-9, 0, count),
        "T_load": rng.uniform(-2, 2, count),
    }
    point = ts.evaluate(trum60)
    section = {"k_c": point.wavenumber, "k_N": 3e10, "E_eq": 2e10}
    found = call("trum_rotor_coefficients", {**trum60.symbols(), **section, **drawn, "J_load": 0.0, "r_s": 0.0})
    F_c, mu, r_c, J, T_load = drawn.values()
    assert np.array_equal(found["push"], F_c * mu * (r_c * r_c) / J)
    assert np.array_equal(found["drag"], T_load * r_c / J)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_weight_is_a_plate_of_its_mass_times_the_radius_squared(trum60, sense):
    mass = 0.3 / 9.80665 / 0.030
    hung = ts.evaluate(trum60, replace(RIG, load_torque=sense * 0.3, load_inertia=4e-3))
    turned = ts.evaluate(trum60, replace(REST, load_torque=sense * 0.3, load_inertia=4e-3 + mass * 0.030**2))
    for name in SPEEDS:
        assert getattr(hung, name) == pytest.approx(getattr(turned, name), rel=1e-9)
    assert hung.reason == turned.reason == ""


def test_without_a_pull_there_is_no_weight(trum60):
    free = replace(RIG, load_torque=0.0)
    assert ts.evaluate(trum60, free).figures == ts.evaluate(trum60, replace(REST, load_torque=0.0)).figures


def test_a_light_load_changes_the_speed_in_proportion(trum60):
    """By the slope, which is that of the rotor alone."""
    alone = ts.evaluate(trum60, REST, tolerance=1e-9).mean_speed
    slope = ts.sensitivities(trum60, REST, tolerance=1e-9)["mean_speed"]["load_inertia"]
    for inertia in (1e-8, 2e-8):
        moved = ts.evaluate(trum60, replace(REST, load_inertia=inertia), tolerance=1e-9).mean_speed
        assert moved - alone == pytest.approx(slope * inertia, rel=5e-2)


def test_a_heavy_load_turns_as_fast_as_friction_balances_the_torque_on_average(trum60):
    """No swing is left: friction at one speed, averaged over the cycle without the kernels, carries the load."""
    heavy = ts.Drive(phase_lead=-1, start="rest", load_inertia=100.0)
    point = ts.evaluate(trum60, heavy, tolerance=1e-9)
    other = orbit.Reference(trum60, heavy, point)
    shares = []
    for region, span in enumerate(other.durations):
        times = (np.arange(20000) + 0.5) / 20000 * span
        f = [
            orbit.surface(
                other.p, orbit.modal(other.p, other.states[region], orbit.GATES[region], t), point.mean_speed * 0.0265
            )[0]
            for t in times
        ]
        shares.append(np.mean(f) * span)
    assert np.sum(shares) / other.cycle_time == pytest.approx(0.3 / (0.25 * 180 * 0.0265), abs=2e-6)


def test_the_swing_of_a_heavy_load_is_in_inverse_proportion_to_it(trum60):
    inertia = np.array([1e-2, 1e-1, 1.0])
    point = ts.evaluate(trum60, replace(REST, load_inertia=inertia), tolerance=1e-8)
    swing = (point.max_speed - point.min_speed) * (J + inertia)
    assert swing == pytest.approx(swing[-1], rel=2e-3)
    assert np.diff(point.mean_speed) == pytest.approx(0.0, abs=2e-2 * point.mean_speed[-1])
    assert abs(np.diff(point.mean_speed)[1]) < 0.2 * abs(np.diff(point.mean_speed)[0])  # nor with the mean left to move


def test_a_string_goes_slack_where_the_rotor_outruns_the_weight(trum60):
    """Friction of the whole prepressure stops a rotor with the weight faster than g/r, unless a plate holds it up."""
    assert ts.evaluate(trum60, RIG).reason == SLACK
    assert ts.evaluate(trum60, replace(RIG, load_torque=-0.3)).reason == SLACK
    assert ts.evaluate(trum60, replace(RIG, load_inertia=ENOUGH * 1.0001)).reason == ""
    plates = replace(RIG, load_inertia=np.array([0.5, 0.9, 0.99, 1.001]) * ENOUGH)
    assert ts.evaluate(trum60, plates).reason.tolist() == [SLACK, SLACK, SLACK, ""]


def test_friction_that_could_make_a_string_slack_need_not(trum60):
    """One speed all the time: the orbit is looked at, not what friction might do."""
    for load in (0.1, -0.1):  # friction lifts the weight in either sense
        steady = ts.Drive(on_periods=20, load_torque=load, load="weight", load_radius=0.03)
        assert ts.evaluate(trum60, steady).reason == ""


def test_a_runaway_has_no_string_to_speak_of(trum60):
    point = ts.evaluate(trum60, replace(RIG, load_torque=5.0))
    assert point.reason.startswith("no speed balances the load")


@pytest.mark.parametrize("place", [2, 3])
def test_three_bodies_and_two_constraints_agree(place):
    """The first of 100 that ``python -m studies.bench`` compares."""
    error = bench.disagreement(bench.benches(place + 1)[place])
    assert (error[:3] <= 1e-6).all()
    assert error[3] <= 1e-9
    assert error[4] <= 1e-12


@pytest.mark.parametrize("drive", [replace(REST, load_inertia=1e-3), replace(RIG, load_inertia=4e-3, load_torque=0.2)])
def test_slopes_by_the_loads_inertia_and_by_a_weights_torque(trum60, drive):
    found = ts.sensitivities(trum60, drive, tolerance=1e-9)
    for name in ("load_inertia", "load_torque"):
        step = 1e-3 * getattr(drive, name)
        up, down = (
            ts.evaluate(trum60, replace(drive, **{name: getattr(drive, name) + e}), tolerance=1e-9)
            for e in (step, -step)
        )
        for figure in ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque"):
            difference = (getattr(up, figure) - getattr(down, figure)) / (2 * step)
            floor = 1e-5 * abs(getattr(up, figure) / getattr(drive, name))
            assert found[figure][name] == pytest.approx(difference, rel=1e-3, abs=floor), (name, figure)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"load_inertia": -1e-6}, ("load_inertia: got -1e-06", ">= 0")),
        ({"load_inertia": 1e7}, ("load_inertia: got 10000000", "< 1e+06")),
        ({"load_inertia": float("nan")}, ("load_inertia: got nan",)),
        ({"load": "weight"}, ("load_radius: got 0", "more than 0 m with load = weight")),
        ({"load": "weight", "load_radius": np.array([0.03, 0.0])}, ("load_radius: got 0", "more than 0 m")),
        ({"load_radius": 0.03}, ("load_radius: got 0.03", "0 m with load = torque")),
        ({"load": "weight", "load_radius": -0.03}, ("load_radius: got -0.03",)),
        ({"load": "weight", "load_radius": 30.0}, ("load_radius: got 30", "< 10 in m")),
        ({"load": "spring"}, ("load: got spring", "torque, weight")),
    ],
)
def test_a_load_that_is_none_is_refused(given, words):
    with refusal(*words):
        ts.Drive(**given)


def test_histories_and_batches_take_it(trum60):
    radii = np.array([0.01, 0.03])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        batch = ts.evaluate(trum60, replace(RIG, load_radius=radii, load_inertia=0.02))
    for k, radius in enumerate(radii):
        one = ts.evaluate(trum60, replace(RIG, load_radius=float(radius), load_inertia=0.02), tolerance=1e-6)
        assert (batch.mean_speed[k], batch.reason[k]) == (one.mean_speed, one.reason)
    data = ts.simulate(trum60, replace(RIG, load_inertia=0.02))
    assert data.attrs["load"] == "weight"
    assert data.attrs["load_radius"] == 0.030
    assert data.attrs["slack"] == 0
    assert ts.simulate(trum60, RIG).attrs["slack"] == 1
    acceleration = np.gradient(data.rotor_speed.values, data.time.values)[5:-5]
    wanted = (0.25 * 180 * 0.0265 * data.friction.values - 0.3) / (J + 0.02 + 0.3 * 0.03 / 9.80665)
    assert np.median(np.abs(acceleration / wanted[5:-5] - 1)) < 1e-3


@pytest.mark.parametrize("given", [{"load_inertia": 1e-4}, [1e-4], 1.0])
def test_a_motor_s_bench_is_a_mapping_of_parameters(trum60, given):
    with refusal("bench", "a mapping of names to Parameters"):
        replace(trum60, bench=given)
