"""Tolerance studies of the motor against brute force, quadrature and closed forms."""

from __future__ import annotations

import json
import math
import threading
from dataclasses import replace

import numpy as np
import pytest
import scipy
from refusals import MOTOR, assert_one_clear_line, refusal

import trum_sym as ts
from trum_sym.model import batch
from trum_sym.model.cycle import cycle_sums, modal_values
from trum_sym.uncertainty.propagation import propagate

# few pulses a cycle: a point costs a fifth of Table 3's
SHORT = ts.Drive(periods=4, on_periods=3, load_torque=0.05)
BOUNDS = {"friction_coefficient": (0.2, 0.3), "contact_radius": (0.025, 0.030), "prepressure": (150.0, 210.0)}
UNIFORM = {name: f"uniform:{low}:{high}" for name, (low, high) in BOUNDS.items()}


@pytest.fixture(scope="module")
def study():
    return ts.spread(
        MOTOR,
        SHORT,
        spreads=UNIFORM,
        samples=256,
        outputs=["mean_speed", "speed_volatility"],
        target=["mean_speed >= 7000000 arcsec/s", "speed_volatility < 1.6 %"],
    )


@pytest.fixture(scope="module")
def overloaded():
    """A load of 1.1 N m: friction transmits mu F_c r_c at most, 1.06 to 1.24 N m here."""
    return ts.spread(
        MOTOR,
        replace(SHORT, load_torque=1.1),
        spreads={"friction_coefficient": "uniform:0.222:0.26", "frequency_difference": "uniform:2900:3100"},
        samples=128,
        outputs=["max_speed", "q_average"],
        target="max_speed > 0 rad/s",
    )


def test_indices_of_the_rotors_speed_are_those_of_quadrature(study):
    """Eight Gauss nodes in each direction integrate the variances, and their parts, to far beyond the intervals."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    weights = weights / 2
    axes = [low + (high - low) * (nodes + 1) / 2 for low, high in BOUNDS.values()]
    grid = dict(zip(BOUNDS, np.meshgrid(*axes, indexing="ij"), strict=True))
    force = grid.pop("prepressure")
    point = ts.evaluate(MOTOR.with_values(grid), replace(SHORT, prepressure=force), tolerance=1e-6)
    for output in ("mean_speed", "speed_volatility"):
        values = getattr(point, output)
        mean = np.einsum("ijk,i,j,k", values, weights, weights, weights)
        variance = np.einsum("ijk,i,j,k", values**2, weights, weights, weights) - mean**2
        spread, indices = study.propagation.spread(output), study.propagation.indices[output]
        assert spread.mean == pytest.approx(mean, rel=1e-3)
        assert spread.standard_deviation == pytest.approx(math.sqrt(variance), rel=1e-2)
        for axis, name in enumerate(BOUNDS):
            front = np.moveaxis(values, axis, 0)
            alone = np.einsum("ijk,j,k->i", front, weights, weights)
            others = np.einsum("ijk,i->jk", front, weights)
            first = ((weights * alone**2).sum() - mean**2) / variance
            total = 1 - (np.einsum("jk,j,k", others**2, weights, weights) - mean**2) / variance
            for exact, found in ((first, indices.first[name]), (total, indices.total[name])):
                assert found.low <= exact <= found.high
                assert found.value == pytest.approx(exact, abs=0.02)


def double_loop(function, parameters, name, rng, outer, inner):
    """First-order index by brute force, with its standard error: the variance between means less what is noise."""
    fixed = np.repeat(parameters[name](rng.random(outer)), inner)
    drawn = {other: quantile(rng.random(outer * inner)) for other, quantile in parameters.items()}
    values = function({**drawn, name: fixed})["y"].reshape(outer, inner)
    means, noise = values.mean(axis=1), values.var(axis=1, ddof=1)

    def index(rows):
        between = means[rows].var(ddof=1) - noise[rows].mean() / inner
        return between / (between + noise[rows].mean())

    every = np.arange(outer)
    left_out = np.array([index(np.delete(every, row)) for row in every])
    return index(every), math.sqrt((outer - 1) * left_out.var())


def test_indices_of_a_determinant_are_those_of_a_double_loop():
    drive = ts.Drive()
    omega_n = 2 * np.pi * ts.evaluate(MOTOR).resonance_frequency

    def determinant(point):
        moved = replace(drive, frequency_difference=point["frequency_difference"])
        return {"y": cycle_sums(modal_values(omega_n, point["damping_ratio"], moved))["q_average"]}

    parameters = {
        "frequency_difference": scipy.stats.norm(3000, 100).ppf,
        "damping_ratio": scipy.stats.uniform(0.002, 0.008).ppf,
    }
    indices = propagate(determinant, parameters, samples=256).indices["y"]
    rng = np.random.default_rng(5)
    for name in parameters:
        brute, error = double_loop(determinant, parameters, name, rng, 160, 10)
        assert error < 0.1
        found = indices.first[name]
        assert abs(found.value - brute) < 3 * error
        assert found.low - 2 * error < brute < found.high + 2 * error


@pytest.mark.slow
def test_indices_of_the_rotors_speed_are_those_of_a_double_loop(study):
    def volatility(point):
        force = point["prepressure"]
        motor = MOTOR.with_values({name: value for name, value in point.items() if name != "prepressure"})
        return {"y": ts.evaluate(motor, replace(SHORT, prepressure=force), tolerance=1e-6).speed_volatility}

    parameters = {name: scipy.stats.uniform(low, high - low).ppf for name, (low, high) in BOUNDS.items()}
    rng = np.random.default_rng(6)
    for name, found in study.propagation.indices["speed_volatility"].first.items():
        brute, error = double_loop(volatility, parameters, name, rng, 300, 60)
        assert error < 0.05
        assert abs(found.value - brute) < 3 * error
        assert found.low <= brute <= found.high


def test_what_to_measure_first_is_said_in_words(study):
    text = study.to_text()
    best = study.propagation.indices["mean_speed"].first["prepressure"]
    assert f"measure prepressure first: on average, knowing it takes away {100 * best.value:.3g} %" in text
    # knowing it: the variance that is left, found without the engine
    rng = np.random.default_rng(1)
    drawn = {name: rng.uniform(low, high, 600) for name, (low, high) in BOUNDS.items()}
    drawn["prepressure"] = np.repeat(drawn["prepressure"][:30], 20)
    force = drawn.pop("prepressure")
    speeds = ts.evaluate(MOTOR.with_values(drawn), replace(SHORT, prepressure=force)).mean_speed.reshape(30, 20)
    left = speeds.var(axis=1, ddof=1).mean() / study.propagation.spread("mean_speed").standard_deviation ** 2
    assert 1 - left == pytest.approx(best.value, abs=0.1)


def test_every_point_is_an_operating_point(study):
    points, values = study.propagation.points, study.propagation.values
    for row, column in ((0, 3), (1, 100), (4, 255)):
        own = {name: points[name][row, column] for name in ("friction_coefficient", "contact_radius")}
        drive = replace(SHORT, prepressure=points["prepressure"][row, column])
        alone = ts.evaluate(MOTOR.with_values(own), drive, tolerance=1e-6)
        assert values["mean_speed"][row, column] == alone.mean_speed
        assert values["speed_volatility"][row, column] == alone.speed_volatility


def test_missing_a_target_is_counted(study):
    speed = study.propagation.values["mean_speed"][:2] / (np.pi / 648000)
    volatility = study.propagation.values["speed_volatility"][:2]
    slow, rough = (study.missing(target) for target in study.targets)
    assert 0 < slow.value == np.mean(speed < 7e6) < 1
    assert 0 < rough.value == np.mean(volatility >= 0.016) < 1
    assert study.missing().value == np.mean((speed < 7e6) | (volatility >= 0.016))
    assert slow.low < slow.value < slow.high
    assert f"probability of missing mean_speed >= 7000000 arcsec/s: {100 * slow.value:.3g} %" in study.to_text()


def test_points_that_no_speed_balances_are_counted_and_named(overloaded):
    """Coulomb: the load is held where mu > T / (F_c r_c)."""
    edge = 1.1 / (180 * 0.0265)
    points, values = overloaded.propagation.points["friction_coefficient"], overloaded.propagation.values
    assert np.array_equal(np.isnan(values["max_speed"]), points <= edge)
    exact = (edge - 0.222) / (0.26 - 0.222)
    assert overloaded.unbalanced.low < exact < overloaded.unbalanced.high
    assert overloaded.unbalanced.value == pytest.approx(exact, abs=0.01)
    record = json.loads(overloaded.to_json())["unbalanced"]
    assert record["count"] == (points <= edge).sum()
    assert len(record["points"]) == (points[:2] <= edge).sum()
    assert all(point["friction_coefficient"] <= edge for point in record["points"])
    text = overloaded.to_text()
    assert f"no speed balances the load at {record['count']} of 512 points" in text
    assert f"max speed has no value at {len(record['points'])} of 256 points" in text
    assert f"friction_coefficient = {record['points'][0]['friction_coefficient']:.6g}" in text


def test_points_that_no_speed_balances_miss_the_target(overloaded):
    assert overloaded.missing().value >= overloaded.unbalanced.value
    values = overloaded.propagation.values
    assert np.all(values["missed"][np.isnan(values["max_speed"])] == 1)


def test_what_decides_whether_a_speed_balances_the_load(overloaded):
    decides = overloaded.propagation.indices["balanced"]
    assert decides.leader == "friction_coefficient"
    assert decides.first["friction_coefficient"].value == pytest.approx(1, abs=0.1)
    assert decides.total["frequency_difference"].value == 0


def test_indices_say_how_many_rows_they_hold_for(overloaded):
    values = overloaded.propagation.values["max_speed"]
    indices = overloaded.propagation.indices
    assert indices["max_speed"].rows == np.isfinite(values).all(axis=0).sum() < 128
    assert indices["q_average"].rows == 128
    assert f"over the {indices['max_speed'].rows} of 128 rows" in overloaded.to_text()


def test_orbits_that_do_not_settle_are_counted_and_named(study):
    settled = study.settled.copy()
    assert settled.all()
    settled[0, 5] = settled[3, 7] = False
    text = replace(study, settled=settled).to_text()
    assert "did not meet its tolerance at 2 of 1280 points" in text
    assert f"prepressure = {study.propagation.points['prepressure'][0, 5]:.6g}" in text
    record = json.loads(replace(study, settled=settled).to_json())["unsettled"]
    assert (record["count"], len(record["points"])) == (2, 1)


def test_a_volatility_without_a_variance_is_said_to_be_one():
    drive = ts.Drive(load_torque=0.16)  # about the stall torque
    found = ts.spread(MOTOR, drive, samples=64, spreads={"friction_coefficient": None})
    speed = found.propagation.values["mean_speed"]
    assert speed.min() < 0 < speed.max(), "or this test says nothing"
    assert found.unbounded == ("speed_volatility",)
    assert "grows without bound" in found.to_text()
    assert json.loads(found.to_json())["outputs"]["speed_volatility"]["unbounded"] is True


def test_the_motor_file_says_what_is_uncertain():
    found = ts.spread(MOTOR.with_values({"piezo_width": 7e-3}), SHORT, samples=64)
    coupled = {
        "rotor_mass",
        "layer_loss_factor",
        "phase_coverage",
        "piezo_permittivity",
        "piezo_loss_factor",
    }  # no figure of a spread has them
    every = {name for name, p in MOTOR.parameters() if p.source == "assumed"} - coupled
    flange = {"flange_thickness", "flange_length", "flange_young_modulus", "flange_poisson_ratio"}
    assumed = every - flange  # which the layer alone leaves out
    assert set(found.distributions) == assumed - {"piezo_width"}
    more = ts.spread(MOTOR, SHORT, samples=64, spreads={"motor": None, "load_torque": "normal:0.05:0.01"})
    assert set(more.distributions) == assumed | {"load_torque"}
    whole = ts.spread(MOTOR, SHORT, samples=64, compliance="flange")
    assert set(whole.distributions) == every
    assert "no effect at any point: piezo_strain_constant, piezo_compliance, curvature_radius" in found.to_text()


def test_the_same_seed_gives_the_same_bits_on_any_number_of_threads(study, monkeypatch):
    monkeypatch.setattr(batch.os, "cpu_count", lambda: 3)
    targets = [target.text for target in study.targets]
    again = ts.spread(MOTOR, SHORT, spreads=UNIFORM, samples=256, outputs=study.outputs, target=targets)
    assert again.to_json() == study.to_json()
    for name, values in study.propagation.values.items():
        assert np.array_equal(values, again.propagation.values[name], equal_nan=True)


def test_the_data_set_has_every_point_and_setting(study):
    data = study.to_xarray()
    assert data.sizes == {"matrix": 5, "sample": 256}
    assert data.mean_speed.units == "rad/s"
    assert data.prepressure.units == "N"
    assert np.array_equal(data.sel(matrix="B").prepressure, study.propagation.points["prepressure"][1])
    assert data.attrs["seed"] == 0
    assert "prepressure: uniform, 150 to 210" in data.attrs["distributions"]
    assert data.attrs["motor_rotor_inertia"] == 4.5e-6


def test_an_interruption_stops_the_work(monkeypatch):
    original, begun, lock = batch.call, [], threading.Lock()

    def interrupted(kernel, values):
        if kernel == "rotor_orbit":
            with lock:
                begun.append(kernel)
            if len(begun) == 3:  # the nominal point, then the second block
                raise KeyboardInterrupt
        return original(kernel, values)

    monkeypatch.setattr(batch, "call", interrupted)
    monkeypatch.setattr(batch, "_BLOCK", 16)
    monkeypatch.setattr(batch.os, "cpu_count", lambda: 2)
    with pytest.raises(KeyboardInterrupt):
        ts.spread(MOTOR, SHORT, spreads=UNIFORM, samples=64)
    assert len(begun) < 15


BAD_STUDIES = [
    ({"spreads": ["frictoin_coefficient"]}, ("spreads: got frictoin_coefficient", "friction_coefficient")),
    ({"spreads": ["name"]}, ("spreads: got name", "the motor file or the drive")),
    ({"spreads": ["phase_lead"]}, ("spreads: got phase_lead", "the motor file or the drive")),
    ({"spreads": ["prepressure"]}, ("spread of prepressure: got nothing", "LOW:HIGH")),
    ({"spreads": ["voltage"]}, ("spread of voltage: got nothing", "LOW:HIGH")),
    ({"spreads": "prepressure"}, ("spreads: got prepressure", "names")),
    ({"spreads": 3}, ("spreads: got 3", "names")),
    ({"spreads": []}, ("spreads: got none", "at least one")),
    ({"spreads": [3]}, ("spreads: got 3", "names")),
    ({"spreads": {"prepressure": 180.0}}, ("spread of prepressure: got 180", "< 1")),
    ({"spreads": {"prepressure": "cauchy:1:2"}}, ("prepressure: got cauchy", "uniform, triangular")),
    ({"spreads": {"prepressure": "normal:180:-5"}}, ("prepressure: got standard_deviation = -5", "> 0, in N")),
    ({"spreads": {"prepressure": "uniform:-10:10"}}, ("prepressure: got uniform with low = -10", "> 0")),
    ({"spreads": {"prepressure": "uniform:200:100"}}, ("prepressure: got uniform from 200 to 100", "low < high")),
    ({"spreads": {"periods": "uniform:20:30"}}, ("periods: got uniform", "whole number")),
    ({"spreads": {"damping_ratio": "uniform:0.5:1.5"}}, ("damping_ratio: got uniform with high = 1.5", "< 1")),
    ({"spreads": {"tooth_height": "uniform:2 mm:6 mm"}}, ("tooth_height: got", "less than beam_thickness")),
    ({"spreads": {"frequency_difference": "uniform:-40 kHz:0"}}, ("frequency_difference: got", "the resonance")),
    ({"outputs": ["speed"]}, ("outputs: got speed", "mean_speed")),
    ({"outputs": []}, ("outputs: got none", "at least one")),
    ({"outputs": 5}, ("outputs: got 5", "text")),
    ({"outputs": ["converged"]}, ("outputs: got converged", "one of")),
    (
        {"outputs": ["cycle_time", "mean_speed"], "spreads": ["friction_coefficient"]},
        ("cycle_time", "the same value"),
    ),
    ({"target": "fast"}, ("target: got fast", "mean_speed >= 600 arcsec/s")),
    ({"target": "speed >= 3"}, ("target: got speed", "one of")),
    ({"target": "mean_speed >= 3 N"}, ("target, mean_speed: got 3 N", "rad/s")),
    ({"target": "mean_speed >= inf"}, ("target, mean_speed: got inf", "finite")),
    ({"target": "mean_speed = 3"}, ("target: got mean_speed = 3", ">=")),
    ({"target": 600}, ("target: got 600", "text")),
    ({"samples": 1000}, ("samples: got 1000", "a power of two")),
    ({"seed": -1}, ("seed: got -1",)),
    ({"tolerance": 1}, ("tolerance: got 1", "<= 0.01")),
    ({"contact": "bolted"}, ("contact: got bolted", "winkler, hertz")),
]


@pytest.mark.parametrize(("wishes", "naming"), BAD_STUDIES, ids=[str(wishes) for wishes, _ in BAD_STUDIES])
def test_bad_studies_are_refused(wishes, naming):
    with refusal(*naming):
        ts.spread(MOTOR, SHORT, **{"samples": 64, **wishes})


def test_a_study_is_of_one_point():
    with refusal("prepressure: got an array of shape (2,)", "one number"):
        ts.spread(MOTOR, ts.Drive(prepressure=[150.0, 160.0]))
    with refusal("voltage: got an array of shape (2,)", "one number"):
        ts.spread(MOTOR.with_values({"voltage": [150.0, 160.0]}))
    with refusal("motor: got trum60"):
        ts.spread("trum60")
    with refusal("drive: got None"):
        ts.spread(MOTOR, "None")


def test_a_load_that_nothing_holds_is_refused():
    with refusal("outputs: got mean_speed", "none at any of the 192 points"):
        ts.spread(MOTOR, replace(SHORT, load_torque=50.0), spreads=["friction_coefficient"], samples=64)


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "scipy", None)
    with pytest.raises(ts.MissingExtraError) as caught:
        ts.spread(MOTOR, SHORT)
    assert_one_clear_line(str(caught.value), "scipy", "trum-sym[sweep]")
