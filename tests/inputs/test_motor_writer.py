"""A motor file with some entries replaced: everything else stays to the letter."""

from __future__ import annotations

import difflib
import os
from dataclasses import replace

import pytest
from refusals import MOTOR_TEXT, refusal, voltage

import trum_sym as ts
from trum_sym.inputs.motor_writer import write_motor

FITTED = ts.Parameter(0.0265432, "m", "r_c", "calibrated", interval=(0.0264, 0.0267), data='speeds "1".csv')
WITH_SECTION = """
[parameters.contact_radius]
# where the layer touches
value = 26.5  # guessed
unit = "mm"
source = "assumed"
range = [25.0, 30.0]
reason = "not given"

[[published]]"""


def changed_lines(before, after):
    return [line for line in difflib.ndiff(before.splitlines(), after.splitlines()) if line[0] in "+-"]


def test_one_entry_changes_one_line_and_keeps_unit_and_symbol(trum60, tmp_path):
    target = tmp_path / "out.toml"
    write_motor(replace(trum60, contact_radius=FITTED), "trum60", target)
    old, new = changed_lines(MOTOR_TEXT, target.read_text("utf-8"))
    assert old.startswith("- contact_radius      = { value = 26.5")
    assert new == (
        '+ contact_radius      = { value = 26.5432, unit = "mm", symbol = "r_c", source = "calibrated", '
        'interval = [26.4, 26.7], data = "speeds \\"1\\".csv" }'
    )
    assert ts.load_motor(target).contact_radius.data == 'speeds "1".csv'
    assert ts.load_motor(target).contact_radius.value == pytest.approx(0.0265432, rel=1e-10)


def test_the_same_motor_writes_the_same_bytes(trum60, tmp_path):
    target = tmp_path / "out.toml"
    write_motor(trum60, "trum60", target)
    assert target.read_text("utf-8") == MOTOR_TEXT


def test_notes_and_comments_of_an_entry_stay(trum60, motor_file, tmp_path):
    text = MOTOR_TEXT.replace('eq. (8), with F_c in newton" }', 'eq. (8) # not this" }  # with F_c in newton')
    assert text != MOTOR_TEXT
    base = motor_file(text)
    law = ts.Parameter(15.0, "1", "C_f", "calibrated", interval=(14.0, 16.0), data="x.csv")
    write_motor(replace(trum60, amplitude_factor=law), base, tmp_path / "out.toml")
    _, new = changed_lines(text, (tmp_path / "out.toml").read_text("utf-8"))
    assert 'note = "eq. (8) # not this"' in new
    assert new.endswith("}  # with F_c in newton")


def test_a_parameter_that_the_file_does_not_have_is_added(trum60, tmp_path):
    layer = ts.Parameter(2.4e10, "N/m^2", "k_N", "calibrated", interval=(2e10, 3e10), data="x.csv")
    write_motor(replace(trum60, layer_stiffness=layer), "trum60", tmp_path / "out.toml")
    (new,) = changed_lines(MOTOR_TEXT, (tmp_path / "out.toml").read_text("utf-8"))
    assert new.startswith('+ layer_stiffness = { value = 24000000000.0, unit = "N/m^2"')
    assert ts.load_motor(tmp_path / "out.toml").layer_stiffness == layer


@pytest.mark.parametrize("limits", ["[25.0, 30.0]", "[\n  25.0,\n  30.0,\n]"], ids=["one line", "several lines"])
def test_an_entry_in_a_section_of_its_own_is_replaced(trum60, motor_file, tmp_path, limits):
    line = next(line for line in MOTOR_TEXT.splitlines() if line.startswith("contact_radius"))
    section = WITH_SECTION.replace("[25.0, 30.0]", limits)
    base = motor_file(MOTOR_TEXT.replace(line + "\n", "").replace("\n[[published]]", section, 1))
    write_motor(replace(trum60, contact_radius=FITTED), base, tmp_path / "out.toml")
    assert "# where the layer touches" in (tmp_path / "out.toml").read_text("utf-8")
    assert ts.load_motor(tmp_path / "out.toml").contact_radius.interval == pytest.approx((0.0264, 0.0267))


def test_overrides_are_written_as_set(trum60, tmp_path):
    motor = trum60.with_values({"resonance_frequency": "39.703 kHz"})
    write_motor(replace(motor, contact_radius=FITTED), "trum60", tmp_path / "out.toml")
    assert ts.load_motor(tmp_path / "out.toml").resonance_frequency == motor.resonance_frequency


def test_a_file_may_be_replaced_by_itself(trum60, motor_file):
    base = motor_file(MOTOR_TEXT)
    write_motor(replace(trum60, contact_radius=FITTED), base, base)
    assert ts.load_motor(base).contact_radius.source == "calibrated"
    assert [path.name for path in base.parent.iterdir()] == [base.name]


def test_an_entry_of_dotted_keys_is_replaced(trum60, motor_file, tmp_path):
    line = next(line for line in MOTOR_TEXT.splitlines() if line.startswith("contact_radius"))
    dotted = 'contact_radius.value = 26.5\ncontact_radius.unit = "mm"\ncontact_radius.source = "x"'
    base = motor_file(MOTOR_TEXT.replace(line, dotted))
    write_motor(replace(trum60, contact_radius=FITTED), base, tmp_path / "out.toml")
    assert ts.load_motor(tmp_path / "out.toml").contact_radius.interval == pytest.approx((0.0264, 0.0267))


def test_a_folder_that_cannot_be_written_is_refused(trum60, tmp_path):
    with refusal("motor file", "a folder that exists"):
        write_motor(trum60, "trum60", tmp_path / "none" / "out.toml")
    with refusal("motor file", "ends in .toml"):
        write_motor(trum60, "trum60", tmp_path / "out.txt")
    if os.geteuid():
        tmp_path.chmod(0o500)
        with refusal("motor file", "can be written to"):
            write_motor(trum60, "trum60", tmp_path / "out.toml")


@pytest.mark.parametrize(
    ("changes", "naming"),
    [
        ({"source": '"calibrated"'}, ("voltage: got source = 'calibrated'", "an interval and data")),
        ({"source": '"calibrated"', "interval": "[190, 210]"}, ("an interval and data",)),
        ({"source": '"calibrated"', "data": '"x.csv"'}, ("an interval and data",)),
        ({"interval": "[300, 400]"}, ("voltage.interval: got [300, 400]", "low <= value <= high")),
        ({"interval": "[1]"}, ("voltage.interval: got [1]", "two numbers")),
        ({"interval": '["a", 300]'}, ("voltage.interval: got a", "a number in V")),
        ({"data": "1"}, ("voltage.data: got 1", "text")),
    ],
)
def test_a_calibrated_entry_says_from_what_and_how_well(motor_file, changes, naming):
    with refusal(*naming):
        ts.load_motor(motor_file(voltage(**changes)))
