"""A motor that was read and changed is written with its file's own text around the changes."""

from __future__ import annotations

import difflib
from dataclasses import replace

import pytest
from refusals import MOTOR_TEXT

import trum_sym as ts


def test_what_was_changed_is_changed_and_nothing_else(trum60, tmp_path):
    target = tmp_path / "mine.toml"
    ts.save_motor(trum60.with_values({"contact_radius": "26 mm", "neutral_axis": 2.8e-3}, source="drawing"), target)
    text = target.read_text("utf-8")
    lines = [line for line in difflib.ndiff(MOTOR_TEXT.splitlines(), text.splitlines()) if line[0] in "+-"]
    assert sorted(line.split("=")[0].split()[1] for line in lines if line.strip("+- ")) == [
        "contact_radius",
        "contact_radius",
        "neutral_axis",
    ]
    again = ts.load_motor(target)
    assert again.contact_radius.value == pytest.approx(0.026, rel=1e-15)
    assert again.neutral_axis.source == "drawing"
    ts.save_motor(again, target)
    assert target.read_text("utf-8") == text


def test_what_no_line_of_the_file_would_say_is_refused(trum60, tmp_path):
    target = tmp_path / "mine.toml"
    for motor, word in (
        (replace(trum60, name="another"), "motor: name"),
        (replace(trum60, box={}), "motor: box"),
        (replace(trum60, text=""), "motor"),
        ("trum60", "motor"),
    ):
        with pytest.raises(ts.ParameterError) as said:
            ts.save_motor(motor, target)
        assert said.value.name == word
        assert not target.exists()
