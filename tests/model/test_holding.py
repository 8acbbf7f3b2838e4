"""What it takes to hold a point: against differences, evaluations and simulations of its own."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from studies import holding as study
from trum_sym import console
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import lap_from, solve_orbit

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
EDGE = ts.Drive(prepressure=177.30863595233288, frequency_difference=3149.775277073866)
"""633 arcsec/s at 0.3 N m, the mean of a swing of six million."""


@pytest.fixture(scope="module")
def edge():
    return ts.holding(drive=EDGE)


@pytest.mark.parametrize("seed", [3, 7])
def test_slopes_drifts_and_times_are_those_of_differences_and_simulations(seed):
    """Two points of `python -m studies.holding`, one of which comes to speed in time and one of which does not."""
    found = study.record(seed)
    assert found["how"] == "reference"
    assert all(error <= 1e-4 for error, agree in found["slopes"].values() if agree <= 1e-5)
    assert max(found["drifts"].values()) <= 1e-4
    assert found["starts"][0] == found["starts"][1] == (seed == 3)
    assert found["returns"][0] == found["returns"][1]
    for ours, theirs in found["times"]:
        assert ours == pytest.approx(theirs, rel=1e-2)


def test_the_mean_of_a_swing_is_a_knifes_edge_and_one_sentence_says_so(edge, trum60):
    assert edge.mean_speed == pytest.approx(633 * ARCSEC, rel=1e-6)
    assert edge.slopes["prepressure"] / ARCSEC == pytest.approx(7063, rel=1e-3)
    assert edge.slopes["frequency_difference"] / ARCSEC == pytest.approx(1849, rel=1e-3)
    assert "% more of friction coefficient doubles this speed, as much less stops it" in edge.fragile
    share = float(edge.fragile.split(" %")[0]) / 100
    doubled, stopped = (
        ts.evaluate(trum60.with_values({"friction_coefficient": 0.25 * (1 + by)}), EDGE).mean_speed / edge.mean_speed
        for by in (share, -share)
    )
    assert doubled == pytest.approx(2, abs=0.05)
    assert stopped == pytest.approx(0, abs=0.05)


def test_a_rotor_whose_stall_torque_is_below_the_load_starts_by_itself(edge):
    """It was said that it is not set going: followed from rest, it is at its speed in two drive cycles."""
    case = prepare(None, EDGE, Levels(), 1e-9)
    raw = {name: float(value) for name, value in solve_orbit(case.arguments, case.symbols).raw.items()}
    speed = 0.0
    for _ in range(3):
        speed = float(lap_from(case.arguments, raw, speed, 1, raw["level"])["speed"][-1])
    assert speed == pytest.approx(raw["start"], rel=1e-6)
    assert edge.starts
    assert edge.returns
    assert edge.start_time < 1e-3
    assert any("one that is free follows the beats to this speed" in remark for remark in edge.remarks)


def test_a_heavy_rotors_time_is_that_of_its_laps_one_by_one():
    """40 laps; from the thirteenth on they are told from a few."""
    drive = ts.Drive(start="rest", phase_lead=-1, load_inertia=1e-3, prepressure=168.0, frequency_difference=2800.0)
    found = ts.holding(drive=drive)
    case = prepare(None, drive, Levels(), 1e-9)
    raw = {name: float(value) for name, value in solve_orbit(case.arguments, case.symbols).raw.items()}
    allowed = 0.01 * abs(raw["mean"])

    def lap(speed):
        return float(lap_from(case.arguments, raw, speed, 1, 100 * raw["level"])["speed"][-1])

    period = ts.evaluate(drive=drive).cycle_time
    assert found.start_time / period > 20
    assert found.start_time == pytest.approx(period * study.cycles(lap, 0.0, raw["start"], allowed, 0.0), rel=5e-3)
    slow = ts.holding(drive=drive, speed_time="5 ms")
    assert not slow.starts
    assert any("from rest the rotor is not at this speed within 0.005 s" in remark for remark in slow.remarks)


def test_what_is_driven_back_or_has_no_speed_does_not_start():
    back = ts.holding()
    assert back.mean_speed < 0
    assert not back.starts
    assert "drives the rotor back" in back.remarks[0]
    none = ts.holding(drive=ts.Drive(load_torque=100.0))
    assert math.isnan(none.mean_speed)
    assert none.start_time == math.inf
    assert (none.starts, none.returns, none.fragile) == (False, False, "")
    assert "no speed balances the load" in none.remarks[0]


def test_spreads_are_the_motor_files_until_others_are_given(trum60):
    drive = ts.Drive(load_torque=0.1)
    stated = ts.holding(trum60, drive)
    assert list(stated.spreads) == list(trum60.spreads)
    assert stated.spreads["friction_coefficient"] == pytest.approx(0.0025)
    given = {"prepressure": "+-0.2 N", "frequency_difference": "2999:3001", "load_torque": "2 %", "amplitude": 0.005}
    other = ts.holding(trum60, drive, spreads=given)
    assert other.spreads["prepressure"] == 0.2
    assert other.spreads["frequency_difference"] == pytest.approx(1.0)
    assert other.spreads["load_torque"] == pytest.approx(0.002)
    assert other.spreads["friction_coefficient"] == stated.spreads["friction_coefficient"]
    assert other.drift == pytest.approx(sum(abs(drift) for drift in other.drifts.values()))
    bare = ts.holding(replace(trum60, spreads={}), drive)
    assert (dict(bare.spreads), dict(bare.drifts), bare.fragile) == ({}, {}, "")
    assert set(bare.precisions) == set(stated.precisions)


def test_an_encoders_readings_are_those_of_evaluate(trum60):
    drive = ts.Drive(load_torque=0.1)
    for period in (None, "1 ms"):
        found = ts.holding(trum60, drive, sampling_period=period)
        point = ts.evaluate(trum60, drive, sampling_period=period or 2e-3, tolerance=1e-9)
        assert found.encoder_volatility == pytest.approx(point.speed_volatility, rel=1e-9)


def test_the_console_says_what_it_takes_on_request(capsys):
    line = ["evaluate", "--load-torque", "0.1", "--hold-within", "2 %", "--spread", "prepressure=+-0.2 N"]
    assert console.main(line) == 0
    text = capsys.readouterr().out
    assert "for 2 % keep within" in text
    assert "from rest under the load: at this speed after 0." in text
    assert console.main([*line, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["holding"]["spreads"]["prepressure"] == 0.2
    assert record["units"]["holding"]["slopes"]["load_torque"] == "rad/s/(N*m)"
    assert record["holding"]["starts"] is True
    assert np.sign(record["holding"]["slopes"]["friction_coefficient"]) == 1


@pytest.mark.parametrize(
    ("entry", "naming"),
    [
        ('voltage = { value = 1.0, unit = "V", source = "x" }', ("spreads: got voltage", "prepressure")),
        ('prepressure = { value = 1.0, unit = "Hz", source = "x" }', ("spreads.prepressure.unit: got Hz", "N")),
        ('prepressure = { value = 0.0, unit = "N", source = "x" }', ("spreads.prepressure.value: got 0", "> 0")),
        ('prepressure = { value = 1.0, unit = "N" }', ("spreads.prepressure", "value, unit and source")),
        ('prepressure = { value = 1.0, unit = "N", source = "assumed" }', ("spreads.prepressure", "a reason")),
        ('prepressure = { value = "1", unit = "N", source = "x" }', ("spreads.prepressure.value", "a number")),
        ("prepressure = 3", ("spreads.prepressure: got 3", "a table")),
    ],
)
def test_bad_spreads_of_a_motor_file_are_refused(console_refuses, motor_file, entry, naming):
    from refusals import WITHOUT_PUBLISHED

    start, end = (WITHOUT_PUBLISHED.index(mark) for mark in ("[spreads]", "[parameters]"))
    own = motor_file(f"{WITHOUT_PUBLISHED[:start]}[spreads]\n{entry}\n{WITHOUT_PUBLISHED[end:]}")
    console_refuses("evaluate", "--motor", str(own), naming=naming)
