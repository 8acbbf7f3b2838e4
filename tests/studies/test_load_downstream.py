"""What takes a drive takes its load's inertia: optimum, worst case, tolerance, fit, table, console."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.console import main
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.string import SLACK
from trum_sym.optimiser.model import Box
from trum_sym.studies import robust

PLATE = ts.Drive(start="rest", phase_lead=-1, load_inertia=1e-3)


def test_an_optimum_with_a_plate_creeps_at_the_speed_asked_for(trum60):
    found = ts.optimize(trum60, PLATE, target_speed=633 * ARCSEC)
    assert found.status == "solved"
    there = replace(PLATE, prepressure=found.prepressure, frequency_difference=found.frequency_difference)
    heavier = trum60.with_values({"rotor_inertia": 4.5e-6 + 1e-3})
    point = ts.evaluate(heavier, replace(there, load_inertia=0.0), tolerance=1e-9)
    assert point.mean_speed == pytest.approx(633 * ARCSEC, rel=1e-3)
    assert found.figures["max_speed"] == pytest.approx(point.max_speed, rel=1e-6)


def test_a_worst_case_takes_the_loads_inertia(trum60):
    box = Box(("prepressure",), np.array([160.0]), np.array([210.0]))
    posed = SimpleNamespace(motor=trum60, drive=PLATE, levels=None, box=box, names=frozenset(), asked=None, target=None)
    cases = robust._model(posed, [{}, {"load_inertia": 8e-4, "friction_coefficient": 0.22}])
    motor, drive = cases.at(np.array([[180.0], [180.0], [190.0], [190.0]]))  # two places in both cases
    assert drive.load_inertia.tolist() == [PLATE.load_inertia, 8e-4] * 2
    assert motor.friction_coefficient.value.tolist() == [0.25, 0.22] * 2
    assert drive.prepressure.tolist() == [180.0, 180.0, 190.0, 190.0]
    assert drive.load_torque == PLATE.load_torque
    with pytest.raises(ts.ParameterError, match="load_torque or load_inertia"):
        ts.robust(trum60, PLATE, spreads={"periods": "10 %"})


def test_a_tolerance_study_takes_the_bench_s_range(trum60):
    pytest.importorskip("xarray")
    low, high = trum60.bench["load_inertia"].range
    short = replace(PLATE, periods=4, on_periods=3)
    study = ts.spread(trum60, short, spreads=["load_inertia"], samples=64)
    drawn = study.to_xarray()["load_inertia"].values
    assert low <= drawn.min() < 0.3 * high
    assert 0.7 * high < drawn.max() <= high


def test_measured_rows_may_each_have_a_plate_of_their_own(trum60):
    plates = np.array([1e-4, 3e-4, 1e-3, 3e-3])
    known = trum60.with_values({"friction_coefficient": 0.23})
    speed = ts.evaluate(known, replace(PLATE, load_inertia=plates), tolerance=1e-8).mean_speed
    found = ts.calibrate(
        {"load_inertia": plates, "mean_speed": speed}, trum60, parameters=["friction_coefficient"], drive=PLATE
    )
    assert found["friction_coefficient"].value == pytest.approx(0.23, rel=1e-6)


def test_the_console_says_that_a_string_goes_slack(capsys):
    hung = ["evaluate", "--start", "rest", "--phase-lead", "-1", "--load", "weight", "--load-radius", "30 mm"]
    assert main(hung) == 0
    text = capsys.readouterr().out
    assert "load 0.3 N m by a weight on a string at 30 mm" in text
    assert SLACK in text
    assert main([*hung, "--load-inertia", "4e-3 kg*m^2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["reason"] == ""
    assert main(hung[:-2]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "--load-radius" in error


def test_a_sweep_counts_slack_strings(trum60):
    pytest.importorskip("xarray")
    hung = replace(PLATE, load="weight", load_radius=0.03, load_inertia=0.0)
    found = ts.sweep(trum60, hung, outputs=("mean_speed",), load_inertia=[0.0, 4e-3])
    flags = dict(zip(found.status.flag_meanings.split(), found.status.flag_values, strict=True))
    assert found.status.values.tolist() == [flags["slack_string"], flags["done"]]
