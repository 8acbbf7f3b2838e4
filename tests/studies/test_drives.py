"""Which drive is steadiest: settings against the engine at them, the table and the picture of a few."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.drive_orbit import drive_orbit

drives = lazily("studies.drives")
PLATE = 2.7e-4


@pytest.fixture(scope="module")
def motor():
    return ts.load_motor()


def test_bursts_far_apart_are_what_the_engine_makes_of_the_same_pause(motor):
    condition = drives.Condition("flange", 0.0, 0.05)
    (record,) = drives.solved(motor, condition, "bursts of 1", (20.0,))
    schedule = ts.Schedule(kind="burst", periods=record["setting"], on_periods=1)
    found = drive_orbit(
        motor,
        condition.drive(3000.0),
        schedule,
        compliance="flange",
        tolerance=1e-8,
        sampling_period="2 ms",
        rotor_mass=0.0,
    )
    assert record["mean"] == pytest.approx(20, rel=1e-3)
    assert record["mean"] == pytest.approx(found.orbit.mean_speed / ARCSEC, rel=1e-5)
    assert record["deviation"] == pytest.approx(found.orbit.deviation / ARCSEC, rel=1e-5)
    assert record["encoder"] == pytest.approx(found.encoder_deviation / ARCSEC, rel=1e-5)
    assert record["encoder_width"] * ARCSEC == pytest.approx(found.encoder_high - found.encoder_low, rel=1e-5)


def test_a_phase_difference_and_a_voltage_give_the_mean_speed_that_was_asked_for(motor):
    condition = drives.Condition("flange", PLATE, 0.0)
    (phase,) = drives.solved(motor, condition, "phase difference", (100.0,))
    schedule = ts.Schedule(kind="continuous", phase_difference=phase["setting"])
    found = drive_orbit(
        motor, condition.drive(3000.0), schedule, start="steady", compliance="flange", tolerance=1e-8, rotor_mass=0.0
    )
    assert found.orbit.mean_speed / ARCSEC == pytest.approx(100, rel=0.02)
    assert phase["deviation"] < 1
    (voltage,) = drives.solved(motor, condition, "voltage", (100.0,))
    values = coupled_values(motor, ts.Drive(load_torque=0.0, load_inertia=PLATE, on_periods=20), condition.levels)
    waves = plain_waves({**values, "F_q": voltage["setting"] * values["F_q"]})
    assert min(abs(speed / ARCSEC - 100) for speed in waves.speed) < 1


def test_what_no_setting_reaches_is_said(motor):
    """A million arcsec/s takes bursts that overlap."""
    (record,) = drives.solved(motor, drives.Condition("flange", PLATE, 0.0), "bursts of 20", (1e6,))
    assert record == {"target": 1e6, "reached": False, "why": "overlap"}


def test_the_command_takes_up_where_its_file_ends_prints_and_draws(motor, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("studies.drives.DRIVES", ("bursts of 1",))
    file, picture = tmp_path / "drives.jsonl", tmp_path / "drives.png"
    two = drives.conditions(motor)[-2:]
    monkeypatch.setattr("studies.drives.conditions", lambda _: two)
    assert drives.main([str(file), str(picture), "1"]) == 0
    assert drives.main([str(file)]) == 0
    assert [json.loads(line)["load"] for line in file.read_text("utf-8").splitlines()] == [0.0, 0.05]
    before = file.read_bytes()
    assert drives.main([str(file)]) == 0
    assert file.read_bytes() == before
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert "bursts of 1" in capsys.readouterr().out
    assert drives.main([]) == 2


def test_every_drive_has_a_place_in_the_table():
    assert len(set(drives.DRIVES)) == 7


def test_the_docs_have_these_rows(motor):
    """Of the bursts, which take least time; two digits of a figure."""
    text = (Path(__file__).parents[2] / "docs" / "coupling.md").read_text("utf-8")
    block = re.search(r"<!-- python -m studies.drives -->\n```\n(.*?)```", text, re.DOTALL)[1]
    shown = [re.split(r"\s{2,}", line.strip()) for line in block.splitlines()]
    found = [
        {**vars(condition), "drive": name, "found": drives.solved(motor, condition, name)}
        for condition in drives.conditions(motor)
        for name in (("bursts of 1", "bursts of 20") if condition.contact == "flange" else ("bursts of 1",))
    ]
    for row in drives.rows(found):
        (theirs,) = [line for line in shown if line[:2] == list(row[:2])]
        assert [float(cell) for cell in theirs[2:]] == pytest.approx([float(cell) for cell in row[2:-1]], rel=0.06)
