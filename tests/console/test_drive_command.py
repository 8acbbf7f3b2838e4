"""``trum-sym drive``: the orbit of ts.drive_orbit, from options that a schedule's fields make."""

from __future__ import annotations

import json
from dataclasses import fields

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.console import main
from trum_sym.console.drive import drive
from trum_sym.inputs.schedule import Schedule

QUICK = ["drive", "--compliance", "flange", "--tolerance", "1e-3"]


def test_every_field_of_a_schedule_is_an_option():
    options = {option.name for option in drive.params}
    assert {"schedule", *(field.name for field in fields(Schedule)[1:])} <= options


def test_the_answer_is_that_of_python(capsys):
    line = ["--schedule", "continuous", "--phase-difference", "30 deg", "--voltage", "0.5", "--ratio", "0.8"]
    assert main([*QUICK, *line, "--load-torque", "0.05", "--start", "steady", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    schedule = ts.Schedule(kind="continuous", phase_difference="30 deg", voltage=0.5, ratio=0.8)
    found = ts.drive_orbit(
        drive=ts.Drive(load_torque=0.05), schedule=schedule, start="steady", compliance="flange", tolerance=1e-3
    )
    assert record["mean_speed"] == found.orbit.mean_speed
    assert record["schedule"]["phase_difference"] == np.pi / 6
    assert record["converged"] is True


def test_a_burst_is_said_in_words_and_drawn(capsys, tmp_path):
    line = ["--schedule", "burst", "--periods", "60", "--on-periods", "2", "--load-torque", "0"]
    picture = tmp_path / "drive.png"
    assert main([*QUICK, *line, "--set", "rotor_mass=0", "--plot", str(picture)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("TRUM-60, burst, 2 of 60 periods on, at 180 N, +3000 Hz, load 0 N m\n")
    assert "closed after 1 cycle, attracts" in out
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_pulses_are_the_point_of_evaluate(capsys):
    assert main([*QUICK, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    point = ts.evaluate(coupling="contact", compliance="flange", tolerance=1e-3)
    assert record["mean_speed"] == point.mean_speed
    assert record["highest_wave"] == point.highest_wave


def test_a_load_beyond_friction_ends_with_no(capsys):
    assert main([*QUICK, "--schedule", "continuous", "--load-torque", "5"]) == 1
    assert "from rest: comes to no orbit" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "naming"),
    [
        (("--schedule", "burst"), ("--periods: got none", "need an integer >= 1 for a burst")),
        (("--schedule", "single", "--ratio", "0.5"), ("--ratio: got 0.5", "B is not driven")),
        (("--schedule", "continuous", "--periods", "5"), ("--periods: got 5", "every period is alike")),
        (("--on-periods", "3"), ("--on-periods: got 3", "periods/2")),
        (("--voltage", "-1"), ("--voltage: got -1", "> 0")),
        (("--tolerance", "1"), ("--tolerance: got 1",)),
    ],
)
def test_what_is_no_schedule_is_one_line(console_refuses, line, naming):
    console_refuses("drive", *line, naming=naming)
