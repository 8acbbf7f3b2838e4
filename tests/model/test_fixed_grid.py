"""Orbits on a grid of equal steps: within what they state, said to be so, the same bits however they are asked for."""

from __future__ import annotations

import json

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym import _kernels
from trum_sym.console import main
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare

bounds = lazily("studies.bounds")
PLAIN_START = ts.Drive(
    prepressure=127.50223024680183,
    frequency_difference=-4735.86905689284,
    periods=1,
    on_periods=1,
    load_torque=-0.855836409892414 * 0.25 * 127.50223024680183 * 0.0265,
    start="rest",
    phase_lead=-1.0,
)
FIGURES = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque")


def random_drives(seed, count, most=0.96, **fields):
    rng = np.random.default_rng(seed)
    periods, force = rng.integers(2, 31, count), rng.uniform(100, 220, count)
    return ts.Drive(
        prepressure=force,
        frequency_difference=rng.uniform(-5000, 5000, count),
        periods=periods,
        on_periods=np.maximum(1, rng.integers((periods + 1) // 2, periods)),
        load_torque=rng.uniform(-most, most, count) * 0.25 * force * 0.0265,
        **fields,
    )


@pytest.mark.parametrize("box", ["stock", "limit"])
def test_stated_errors_hold_beside_an_independent_integration(box):
    """A small sample; of a larger one: python -m studies.bounds stock 2000 --method grid --finest 1e-3."""
    found = bounds.study(24, 3, box, 1e-10, 12, "grid", 1e-3)
    assert found.beyond == 0, found.worst
    assert found.converged == found.points
    if box == "stock":
        assert found.compared >= 8


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
@pytest.mark.parametrize(("start", "contact"), [("periodic", "winkler"), ("rest", "winkler"), ("steady", "hertz")])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_stated_errors_hold_beside_fine_adaptive_steps(trum60, start, contact, tolerance):
    drive = random_drives(11, 120, start=start)
    grid = ts.evaluate(trum60, drive, tolerance=tolerance, method="grid", contact=contact)
    fine = ts.evaluate(trum60, drive, tolerance=1e-7, contact=contact)
    assert grid.converged.all()
    assert np.mean(grid.method == "grid") > 0.7
    for name in FIGURES:
        stated = getattr(grid, f"{name}_error") + getattr(fine, f"{name}_error")
        assert np.all(np.abs(getattr(grid, name) - getattr(fine, name)) <= stated), name
    assert np.all(np.abs(grid.contact_fraction - fine.contact_fraction) <= tolerance)


def test_a_slope_that_square_roots_blur_is_not_believed(trum60):
    """A heavy rotor's laps hardly draw speeds together, and a sixth of that is missed next to saturation."""
    friction, force = 0.2585753277084322, 106.36936650597343
    motor = trum60.with_values({"rotor_inertia": 5.908860967792451e-3, "friction_coefficient": friction})
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=268.666882332609,
        periods=20,
        on_periods=20,
        load_torque=0.1379015554885758 * friction * force * 0.0265,
        start="rest",
    )
    for tolerance in (1e-2, 1e-3):
        point = ts.evaluate(motor, drive, contact="hertz", tolerance=tolerance)
        assert point.converged
        assert abs(point.mean_speed - 0.6500054035530991 / 0.0265) <= point.mean_speed_error  # at 1e-8


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_an_event_in_a_region_s_first_cell_is_counted(trum60):
    """One period from rest: friction is not smooth where it begins."""
    found = ts.evaluate(trum60, PLAIN_START, tolerance=1e-2, method="grid")
    fine = ts.evaluate(trum60, PLAIN_START, tolerance=1e-8)
    assert abs(found.mean_speed - fine.mean_speed) <= found.mean_speed_error


def test_what_a_grid_leaves_is_answered_by_adaptive_steps_to_the_last_bit(trum60):
    limit = 0.25 * 180.0 * 0.0265
    drive = ts.Drive(prepressure=180.0, load_torque=limit * np.array([0.1, 0.9999, 1.1]))
    found = ts.evaluate(trum60, drive, tolerance=1e-3)
    adaptive = ts.evaluate(trum60, drive, tolerance=1e-3, method="adaptive")
    assert found.method.tolist() == ["grid", "adaptive", "adaptive"]
    assert found.converged.tolist() == [True, True, False]
    assert found.reason[2] == adaptive.reason[2] != ""
    for name in ("mean_speed", "max_speed", "stall_torque", "contact_fraction", "mean_speed_error"):
        assert np.array_equal(getattr(found, name)[1:], getattr(adaptive, name)[1:], equal_nan=True)
    plain = ts.evaluate(trum60, ts.Drive(periods=4, on_periods=4), tolerance=1e-3)
    assert plain.method == "adaptive"


@pytest.mark.parametrize(
    ("tolerance", "method"), [(1e-2, "grid"), (1e-3, "grid"), (9.9e-4, "adaptive"), (1e-6, "adaptive")]
)
def test_a_grid_is_chosen_by_itself_at_coarse_tolerances_alone(trum60, tolerance, method):
    point = ts.evaluate(trum60, ts.Drive(load_torque=0.1), tolerance=tolerance)
    assert point.method == method
    asked = ts.evaluate(trum60, ts.Drive(load_torque=0.1), tolerance=tolerance, method=method)
    assert point.mean_speed == asked.mean_speed
    assert point.to_dict()["method"] == method


def test_the_console_says_how_an_orbit_was_found(capsys):
    for method, found in (("auto", "grid"), ("adaptive", "adaptive"), ("grid", "grid")):
        assert main(["evaluate", "--load-torque", "0.1", "--tolerance", "1e-2", "--method", method, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["method"] == found


def test_a_method_that_is_none_is_refused(trum60, capsys):
    with pytest.raises(ts.ParameterError, match=r"method.*auto, adaptive, grid"):
        ts.evaluate(trum60, method="newton")
    assert main(["evaluate", "--method", "newton"]) == 2
    assert "--method" in capsys.readouterr().err
    with pytest.raises(ts.ParameterError, match="method"):
        ts.sweep(trum60, prepressure="160:210:3", method="newton")


@pytest.mark.parametrize("name", _kernels.instruction_sets())
def test_a_batch_gives_the_bits_of_its_points_one_by_one(trum60, name):
    """Of points whose laps are of different lengths, on every instruction set.

    Lanes whose lap had ended once went on to count their last speed among the lowest that the bound rests on.
    """
    values = dict(prepare(trum60, random_drives(5, 43, start="rest"), Levels(), 3e-3).arguments)
    columns = dict(zip(values, np.broadcast_arrays(*values.values()), strict=True))
    best = list(_kernels.instruction_sets())[-1]
    _kernels.use(name)
    try:
        whole = call("rotor_grid", columns)
        for together in (1, 6):
            for i in range(0, 43, together):
                part = call("rotor_grid", {k: v[i : i + together] for k, v in columns.items()})
                for figure, batch in whole.items():
                    assert np.array_equal(part[figure], batch[i : i + together], equal_nan=True), figure
    finally:
        _kernels.use(best)
    assert np.mean(whole["flags"] > 0) > 0.8


def test_instruction_sets_agree_within_the_stated_errors(trum60):
    values = dict(prepare(trum60, random_drives(6, 40), Levels(), 1e-2).arguments)
    found, best = {}, list(_kernels.instruction_sets())[-1]
    try:
        for name in _kernels.instruction_sets():
            _kernels.use(name)
            found[name] = call("rotor_grid", values)
    finally:
        _kernels.use(best)
    for orbit in found.values():
        both = (orbit["flags"] > 0) & (found[best]["flags"] > 0)
        assert both.sum() > 30
        for name in ("mean", "low", "high", "held", "contact"):
            off = np.abs(orbit[name] - found[best][name])[both]
            assert np.all(off <= (orbit[f"{name}_error"] + found[best][f"{name}_error"])[both])


def test_figures_without_the_held_rotor_are_the_same(trum60):
    values = dict(prepare(trum60, ts.Drive(load_torque=0.1), Levels(), 1e-3).arguments)
    held, free = call("rotor_grid", values), call("rotor_grid", {**values, "held": 0.0})
    assert np.isnan(free["contact"])
    assert np.isnan(free["held_error"])
    assert held["mean"] == free["mean"]


def test_a_sweep_says_where_it_used_a_grid(trum60):
    coarse = ts.sweep(
        trum60, prepressure="170:174:3", load_torque="0.1,1.12", outputs=("mean_speed", "on_grid"), tolerance=1e-2
    )
    assert coarse.attrs["method"] == "auto"
    assert coarse.on_grid.dtype == bool
    assert coarse.on_grid.values[:, 0].all()
    assert not coarse.on_grid.values[:, 1].any()
    assert "on_grid" in ts.sweep(trum60, prepressure="170:190:2", tolerance=1e-2)
    assert "on_grid" not in ts.sweep(trum60, prepressure="170:190:2")
    asked = ts.sweep(trum60, prepressure="170:190:2", tolerance=1e-2, method="adaptive", outputs=("mean_speed",))
    drive = ts.Drive(prepressure=np.array([170.0, 190.0]))
    assert np.array_equal(asked.mean_speed, ts.evaluate(trum60, drive, tolerance=1e-2, method="adaptive").mean_speed)


# From rest the wave passes zero between nodes; stall torque, by studies/witness.py, and load over the limit
PASSING = {
    "two periods": (
        {"prepressure": 146.83928479934693, "frequency_difference": -35.53640941152298, "phase_lead": -1},
        {"periods": 2, "on_periods": 1},
        0.0016411568819763524,
        0.23294854312951274,
        0.879177117237907,
    ),
    "eight periods": (
        {"prepressure": 215.99544720520592, "frequency_difference": 2720.633820124357},
        {"periods": 8, "on_periods": 7, "switching_phase": 1.5925138358978936},
        0.0013962389792359596,
        0.8225133844029022,
        0.9267947698629374,
    ),
    "three periods": (
        {"prepressure": 154.4059325952122, "frequency_difference": 2364.705442171068},
        {"periods": 3, "on_periods": 2, "switching_phase": 1.7200734159872304},
        0.005802269786871486,
        0.5741763376322729,
        0.5954382556488623,
    ),
}


@pytest.mark.parametrize(("drive", "cycle", "tolerance", "share", "load"), PASSING.values(), ids=list(PASSING))
def test_a_peak_of_the_held_rotor_s_friction_between_two_nodes_is_in_the_bound(drive, cycle, tolerance, share, load):
    motor, limit = ts.load_motor("trum60"), 0.25 * drive["prepressure"] * 0.0265
    drive = ts.Drive(**drive, **cycle, load_torque=load * limit, start="rest")
    point = ts.evaluate(motor, drive, contact="hertz", tolerance=tolerance)
    assert point.converged
    assert abs(abs(point.stall_torque) - share * limit) <= point.stall_torque_error
