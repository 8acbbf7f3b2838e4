"""The optimiser: against dense maps, closed answers and its own slopes taken anew."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
import scipy

import trum_sym as ts
from studies import optimum as optimise_study
from studies import slopes as slopes_study
from trum_sym import console
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import response
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.pressure import peak_pressure
from trum_sym.optimiser.expressions import parse_constraint, parse_expression
from trum_sym.optimiser.finish import TOLERANCE
from trum_sym.optimiser.model import Box, Model, functions

LEVELS = Levels()
KEYS = {
    "status",
    "objective",
    "prepressure",
    "frequency_difference",
    "on_periods",
    "periods",
    "mean_speed",
    "speed_volatility",
    "q_average",
    "q_volatility",
    "constraint_violation",
    "evaluations",
    "message",
}
DRIVE = ts.Drive(load_torque=0.1)


def point(motor, found, drive=DRIVE, **options):
    """The answer's drive, evaluated from outside."""
    names = ("prepressure", "frequency_difference", "switching_phase", "periods", "on_periods")
    return ts.evaluate(motor, replace(drive, **{name: getattr(found, name) for name in names}), **options)


@pytest.fixture(scope="module")
def at_one(trum60):
    """1 rad/s at 0.1 N m in the paper's box."""
    return ts.optimize(trum60, DRIVE, target_speed=1.0)


@pytest.fixture(scope="module")
def dense(trum60):
    """The paper's box at 0.1 N m, on a map of its own."""
    force, difference = np.meshgrid(np.linspace(160, 210, 61), np.linspace(2800, 3300, 61), indexing="ij")
    return ts.evaluate(trum60, replace(DRIVE, prepressure=force, frequency_difference=difference))


def test_the_target_is_met_on_evaluation(trum60, at_one):
    assert at_one.status == "solved"
    assert at_one.constraint_violation <= 1e-8
    assert point(trum60, at_one, tolerance=TOLERANCE).mean_speed == pytest.approx(1.0, rel=1e-8)


def test_a_speed_far_below_the_swing_is_met_as_well(trum60):
    """633 arcsec/s of a swing of 6 million: 1e-8 of it is a part in 1e12 of the speeds that it is the mean of."""
    found = ts.optimize(trum60, target_speed="633 arcsec/s")
    assert found.status == "solved"
    again = point(trum60, found, ts.Drive(), tolerance=TOLERANCE)
    assert again.mean_speed == pytest.approx(633 * ARCSEC, rel=1e-8)


def test_no_place_of_a_dense_map_is_better(at_one, dense):
    """Along the map's edges, where the speed crosses the target, the deviation is no less."""
    deviation = dense.speed_volatility * np.abs(dense.mean_speed)
    least = np.inf
    for axis in (0, 1):
        speed, spread = (np.moveaxis(a, axis, 0) for a in (dense.mean_speed, deviation))
        crossed = (speed[:-1] - 1) * (speed[1:] - 1) < 0
        along = (1 - speed[:-1][crossed]) / (speed[1:] - speed[:-1])[crossed]
        least = min(least, np.min(spread[:-1][crossed] + along * (spread[1:] - spread[:-1])[crossed]))
    assert at_one.objective == pytest.approx(at_one.speed_volatility, rel=1e-8)
    assert at_one.objective <= 1.001 * least
    assert at_one.objective >= 0.99 * least


def test_evidence_names_map_and_optima(at_one):
    evidence = at_one.evidence
    assert evidence.map_shape == (16, 16)
    assert evidence.basins == evidence.starts == len(evidence.optima) == 2
    assert evidence.optima[0] == pytest.approx(at_one.objective, rel=1e-4)
    assert evidence.places[0]["prepressure"] == pytest.approx(at_one.prepressure, abs=0.01)
    assert at_one.evaluations > 256


def test_without_a_target_the_whole_box_is_searched(trum60, dense):
    found = ts.optimize(trum60, DRIVE)
    assert found.status == "solved"
    assert found.objective <= 1.001 * dense.speed_volatility.min()
    assert found.constraint_violation == 0


def test_both_directions(trum60):
    back = ts.optimize(trum60, DRIVE, target_speed="-300000 arcsec/s")
    assert back.status == "solved"
    assert back.mean_speed == pytest.approx(-300000 * ARCSEC, rel=1e-8)


def test_unreachable_speeds_are_said_to_be(trum60, dense):
    """Both ends of the range agree with the dense map's, and the nearest point is the nearer end."""
    for target, pick in ((5.0, np.max), (-9.0, np.min)):
        found = ts.optimize(trum60, DRIVE, target_speed=target)
        assert found.status == "infeasible"
        assert found.objective is None
        assert found.constraint_violation > 0.1
        low, high = found.evidence.reachable_speed
        assert low == pytest.approx(dense.mean_speed.min(), abs=2e-3)
        assert high == pytest.approx(dense.mean_speed.max(), abs=2e-3)
        assert found.mean_speed == pytest.approx(pick(dense.mean_speed), abs=2e-3)
        assert point(trum60, found, tolerance=1e-6).mean_speed == pytest.approx(found.mean_speed, abs=1e-4)


@pytest.fixture(scope="module")
def fastest(trum60):
    """The greatest speed in a box where it is a hill's top inside."""
    motor, drive = trum60, DRIVE
    found = ts.optimize(motor, drive, target_speed=50.0, bounds=HILL)
    return found.evidence.reachable_speed[1]


HILL = {"prepressure": 180, "frequency_difference": (3000, 3300)}


@pytest.mark.parametrize("below", [1e-3, 1e-6, 1e-8])
def test_a_target_just_below_the_top_is_reached(trum60, fastest, below):
    """Too close to the top for any two places of the map to lie on its two sides."""
    found = ts.optimize(trum60, DRIVE, target_speed=fastest * (1 - below), bounds=HILL)
    assert found.status == "solved"
    assert found.constraint_violation <= 1e-8


@pytest.mark.parametrize("above", [1e-6, 1e-3])
def test_a_target_just_above_the_top_is_not(trum60, fastest, above):
    assert ts.optimize(trum60, DRIVE, target_speed=fastest * (1 + above), bounds=HILL).status == "infeasible"


def test_a_box_without_any_orbit(trum60):
    """5 N m is more than mu F_c r_c = 1.4 N m."""
    found = ts.optimize(trum60, ts.Drive(load_torque=5.0), target_speed=1.0)
    assert found.status == "infeasible"
    assert found.prepressure is None
    assert "no speed balances the load" in found.message


def test_one_variable_gives_the_root(trum60):
    """With the prepressure held, the target leaves one frequency difference: Brent's method finds the same."""
    found = ts.optimize(trum60, DRIVE, target_speed=1.0, bounds={"prepressure": 180.0})

    def miss(difference):
        return ts.evaluate(trum60, replace(DRIVE, frequency_difference=difference), tolerance=1e-9).mean_speed - 1

    assert found.prepressure == 180
    assert found.frequency_difference == pytest.approx(scipy.optimize.brentq(miss, 2800, 3200, xtol=1e-7), abs=1e-5)


def test_constraints_hold_and_cost(trum60, at_one):
    """A stall torque that the free optimum lacks: the border is where the new one lies."""
    limit = at_one.figures["stall_torque"] + 5e-4
    found = ts.optimize(trum60, DRIVE, target_speed=1.0, constraints=[f"stall_torque >= {limit!r} N*m"])
    assert found.status == "solved"
    again = point(trum60, found, tolerance=TOLERANCE)
    assert again.stall_torque >= limit * (1 - 1e-8)
    assert again.stall_torque == pytest.approx(limit, rel=1e-6)
    assert again.mean_speed == pytest.approx(1.0, rel=1e-8)
    assert found.objective > at_one.objective


def test_a_margin_between_two_figures(trum60):
    found = ts.optimize(trum60, DRIVE, constraints=["stall_torque - load_torque >= 60 mN*m", "mean_speed >= 1 rad/s"])
    assert found.status == "solved"
    assert found.figures["stall_torque"] >= 0.16 - 1e-8
    assert found.mean_speed >= 1


def test_constraints_that_exclude_each_other(trum60):
    found = ts.optimize(trum60, DRIVE, constraints=["mean_speed >= 1", "stall_torque <= 0.1"])
    assert found.status == "infeasible"
    assert "no point of the box meets all constraints" in found.message


def test_an_objective_of_the_user_with_a_kink(trum60):
    """A closed answer, whatever the motor does: 0 at 171.3 N and 3150 Hz, at the bottom of a sharp valley."""
    text = "((prepressure - 171.3) / 10)**2 + abs(frequency_difference / 100 - 31.5)"
    found = ts.optimize(trum60, DRIVE, objective=text)
    assert found.objective == pytest.approx(0, abs=1e-5)
    assert found.prepressure == pytest.approx(171.3, abs=0.03)
    assert found.frequency_difference == pytest.approx(3150, abs=1e-3)
    assert found.evidence.stationarity > 3e-3  # IPOPT alone stops at the kink


def test_q_volatility_against_the_map(trum60, dense):
    found = ts.optimize(trum60, DRIVE, objective="q-volatility")
    assert found.objective == abs(found.q_volatility)
    assert found.objective <= 1.0001 * np.abs(dense.q_volatility).min()


def test_ripple_against_the_map(trum60, dense):
    found = ts.optimize(trum60, DRIVE, objective="ripple")
    assert found.objective <= 1.001 * ((dense.max_speed - dense.min_speed) / np.abs(dense.mean_speed)).min()


def test_speed_error_is_zero_where_the_target_is_in_reach_and_the_distance_where_not(trum60, at_one):
    inside = ts.optimize(trum60, DRIVE, objective="speed-error", target_speed=1.0)
    assert inside.status == "solved"
    assert inside.objective <= 1e-8
    assert inside.prepressure == pytest.approx(at_one.prepressure, abs=1e-3)
    outside = ts.optimize(trum60, DRIVE, objective="speed-error", target_speed=5.0)
    assert outside.status == "solved"
    assert outside.objective == pytest.approx(5.0 - outside.mean_speed)


def test_pulse_counts_are_enumerated(trum60):
    """The best of nine pairs is the best of nine answers."""
    bounds = {"periods": (18, 20), "on_periods": (13, 15)}
    found = ts.optimize(trum60, DRIVE, target_speed=1.0, bounds=bounds)
    each = [
        ts.optimize(trum60, replace(DRIVE, periods=m, on_periods=n), target_speed=1.0)
        for m in range(18, 21)
        for n in range(13, 16)
    ]
    best = min((one for one in each if one.status == "solved"), key=lambda one: one.objective)
    assert (found.periods, found.on_periods) == (best.periods, best.on_periods)
    assert found.objective == pytest.approx(best.objective, rel=1e-6)
    assert found.evidence.pulses == 9
    assert found.evidence.pruned > 0


def test_the_switching_phase_is_a_variable(trum60, at_one):
    bounds = {"switching_phase": (0, "360 deg"), "prepressure": at_one.prepressure}
    found = ts.optimize(trum60, DRIVE, target_speed=1.0, bounds=bounds)
    assert found.status == "solved"
    assert found.constraint_violation <= 1e-8
    assert found.objective <= at_one.objective * (1 + 1e-6)


# --- Slopes ---------------------------------------------------------------------------------------


def test_slopes_of_every_figure_are_its_differences(trum60):
    names = (
        "mean_speed",
        "speed_deviation",
        "stall_torque",
        "q_average",
        "q_volatility",
        "peak_pressure",
        "resonance_frequency",
        "amplitude",
        "cycle_time",
        "prepressure",
        "load_torque",
    )
    box = Box(("prepressure", "frequency_difference", "switching_phase"), np.zeros(3), np.ones(3))
    model = Model(trum60, DRIVE, LEVELS, box, frozenset(names))
    places = np.array([[180.0, 3000.0, 0.3], [166.0, 3170.0, 2.0]])
    _, slopes = model.results_with_slopes(places, 1e-9)
    for k, step in enumerate((0.05, 0.5, 1e-3)):
        shift = step * np.eye(3)[k]
        up, down = model.results(places + shift, 1e-9), model.results(places - shift, 1e-9)
        for name in names:
            difference = (up[name] - down[name]) / (2 * step)
            size = np.abs(up[name]) * 1e-5 / step * (0.05 if k < 2 else 1e-3)
            relative = 2e-4 if k < 2 else 1e-3  # those by the phase are differences themselves
            assert slopes[name][:, k] == pytest.approx(difference, rel=relative, abs=size.max()), (name, k)


# --- Contact pressure -----------------------------------------------------------------------------


@pytest.mark.parametrize("contact", ["winkler", "hertz"])
@pytest.mark.parametrize("start", ["periodic", "rest"])
def test_the_highest_pressure_is_the_contact_law_s_at_the_highest_wave(trum60, contact, start):
    """Sampled densely; the layer's pressure k_N W_c (1 - cos theta) from the load balance solved anew."""
    levels = Levels(contact, "quartic", "harmonic", "measured")
    case = prepare(trum60, ts.Drive(start=start), levels, 1e-3)
    times = np.linspace(0, 1, 100_001) * call("trum_drive", case.values)["T"]
    both = response(times, case.arguments)
    height = np.hypot(both["w_A"], both["w_B"]).max()
    s = case.symbols
    wavelengths = 2 * s["n_j"] / s["k_c"]
    if contact == "winkler":
        balance = s["F_c"] / (wavelengths * s["k_N"] * height)
        theta = scipy.optimize.brentq(lambda a: math.sin(a) - a * math.cos(a) - balance, 0, math.pi, xtol=1e-15)
        stiffness = s["k_N"]
    else:
        theta = math.pi * math.sqrt(case.arguments["W_full"] / height)
        stiffness = s["F_c"] / (wavelengths * height * (math.sin(theta) - theta * math.cos(theta)))
    expected = stiffness * height * (1 - math.cos(theta)) / s["b_m"]
    assert peak_pressure(case) == pytest.approx(expected, rel=1e-7)


def test_a_whole_wave_in_contact_presses_with_its_mean_and_its_height(trum60):
    """1 kN/mm^2 less stiff: the whole wave touches, p = F_c k_c / (2 pi n_j b_m) + k_N W_c / b_m."""
    soft = trum60.with_values({"layer_young_modulus": 5e6, "amplitude": 5e-6, "resonance_frequency": 39e3})
    case = prepare(soft, ts.Drive(start="steady", on_periods=20), LEVELS, 1e-3)
    s = case.symbols
    mean = s["F_c"] * s["k_c"] / (2 * math.pi * s["n_j"] * s["b_m"])
    assert peak_pressure(case) == pytest.approx(mean + s["k_N"] * 5e-6 / s["b_m"], rel=1e-6)


# --- Expressions ----------------------------------------------------------------------------------


def value(text, **figures):
    rows = functions([parse_expression("objective", text)])
    return rows.values({name: np.array([x]) for name, x in figures.items()})[0, 0]


def test_expressions_compute_what_python_computes():
    figures = {"mean_speed": -1.5, "max_speed": 2.0, "prepressure": 180.0, "speed_volatility": 0.25}
    for text in (
        "abs(mean_speed) + max_speed",
        "mean_speed**2 / max_speed",
        "-mean_speed * 2 - 1",
        "sqrt(speed_volatility)",
        "sqrt(max_speed**2)",
        "min(mean_speed, max_speed, 0.5)",
        "max(mean_speed, 1) / prepressure",
        "exp(-speed_volatility) + log(speed_volatility)",
        "+max_speed / (1 + speed_volatility)",
    ):
        names = parse_expression("objective", text).names
        known = {"abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "exp": math.exp, "log": math.log}
        expected = eval(text, {"__builtins__": {}}, {**known, **figures})
        assert value(text, **{name: figures[name] for name in names}) == pytest.approx(expected, rel=1e-15)


def test_constraints_take_units_and_arithmetic():
    one = parse_constraint("constraint", "mean_speed >= 633 arcsec/s")
    assert (one.low, one.high) == (pytest.approx(633 * ARCSEC), math.inf)
    two = parse_constraint("constraint", "max_speed - min_speed <= 2 rpm")
    assert (two.low, two.high) == (-math.inf, pytest.approx(2 * math.pi / 30))
    assert parse_expression("objective", "max(abs(prepressure / 10 - 17), abs(mean_speed * 2 - 1))").unit == "1"
    three = parse_constraint("constraint", "stall_torque >= 1.5 * load_torque")
    assert three.expression.names == {"stall_torque", "load_torque"}
    assert (three.low, three.high) == (0, math.inf)
    four = parse_constraint("constraint", "contact_fraction == 14 %")
    assert four.low == four.high == pytest.approx(0.14)


# --- Console --------------------------------------------------------------------------------------

LIGHT = ("--load-torque", "0.1")


def test_the_console_answers_as_python_does(capsys, at_one):
    assert console.main(["optimize", *LIGHT, "--target-speed", "1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) >= KEYS
    for name in KEYS:
        assert found[name] == getattr(at_one, name)


def test_the_console_says_no_with_exit_code_1(capsys):
    assert console.main(["optimize", *LIGHT, "--target-speed", "5", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert set(found) >= KEYS
    assert found["status"] == "infeasible"
    assert found["objective"] is None
    assert console.main(["optimize", "--load-torque", "5", "--objective", "volatility", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert set(found) >= KEYS
    assert found["prepressure"] is found["mean_speed"] is found["constraint_violation"] is None


def test_the_console_reads_units_in_bounds(capsys):
    arguments = [
        "--prepressure",
        "0.18 kN",
        "--frequency-difference",
        "2.9 kHz:3.1kHz",
        "--objective",
        "ripple",
        "--json",
    ]
    assert console.main(["optimize", *LIGHT, *arguments]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["prepressure"] == 180
    assert 2900 <= found["frequency_difference"] <= 3100


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_a_picture_is_drawn(capsys, tmp_path, suffix):
    target = tmp_path / f"box.{suffix}"
    extra = ("--constraint", "stall_torque >= 0.12 N*m", "--plot", str(target))
    assert console.main(["optimize", *LIGHT, "--target-speed", "1", *extra]) == 0
    capsys.readouterr()
    content = target.read_bytes()
    assert content.startswith(b"\x89PNG" if suffix == "png" else b"<?xml")
    assert len(content) > 20_000
    assert [path.name for path in tmp_path.iterdir()] == [target.name]


def test_one_variable_is_drawn_as_a_line(capsys, tmp_path):
    target = tmp_path / "line.svg"
    arguments = ["--target-speed", "1", "--prepressure", "180", "--plot", str(target)]
    assert console.main(["optimize", *LIGHT, *arguments]) == 0
    assert "frequency difference" in target.read_text() or target.stat().st_size > 20_000
    capsys.readouterr()


def test_a_box_beyond_the_fit_warns(capsys):
    assert console.main(["optimize", *LIGHT, "--prepressure", "90:150", "--objective", "volatility", "--json"]) == 0
    error = capsys.readouterr().err
    assert error.startswith("trum-sym: warning: prepressure: 90 to 150 N reaches outside 100 to 220 N")
    assert "extrapolated" in error
    assert len(error.splitlines()) == 2  # of the hardware, and of the fit


# --- Studies --------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
@pytest.mark.parametrize("seed", range(1000, 1005))
def test_random_problems_against_dense_maps(seed):
    found = list(optimise_study.records(seed, targets=4, side=51))
    assert [optimise_study.wrong(record) for record in found] == [""] * 6


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_slopes_come_closer_with_the_tolerance():
    """At smooth points the errors' medians fall, to 1e-6 and less at the finest."""
    rows = [row for seed in range(5) for row in slopes_study.record(seed)["errors"].values()]
    smooth = [errors for agree, *errors in rows if agree <= slopes_study.AGREE]
    assert len(smooth) > 50
    rough, middle, fine = np.median(smooth, axis=0)
    assert fine <= middle <= rough
    assert fine < 1e-6


def test_it_says_what_it_does_and_about_how_long(capsys):
    drive = ts.Drive(load_torque=0.05)
    ts.optimize(ts.load_motor(), drive, objective="wear", bounds={"prepressure": 180}, progress=True)
    first, second = capsys.readouterr().err.splitlines()
    assert first == "optimize: a map of the box"
    assert re.fullmatch(r"optimize: descents from its basins, about [\d.e-]+ s", second)
    ts.optimize(ts.load_motor(), drive, objective="wear", bounds={"prepressure": 180})
    assert capsys.readouterr().err == ""
