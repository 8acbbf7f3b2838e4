"""One language: examples run, errors speak as people type, points pass from command to command."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from pathlib import Path

import click
import numpy as np
import pytest

import trum_sym as ts
from trum_sym import console
from trum_sym.console.point_file import read_point
from trum_sym.inputs.shown import full

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
ROOT = Path(__file__).parents[2]
COMMANDS = console._cli.commands


def leaves(commands=COMMANDS, before=()):
    """Every command that does something, with the words that call it."""
    for name, command in commands.items():
        if isinstance(command, click.Group):
            yield from leaves(command.commands, (*before, name))
        else:
            yield (*before, name), command


LEAVES = dict(leaves())
# the report takes a minute; tests/report makes one
EXAMPLES = [
    pytest.param(line.strip(), marks=[pytest.mark.slow] * (words == ("robust",)))
    for words, command in LEAVES.items()
    if words != ("report",)
    for line in (command.epilog or "").splitlines()
    if line.strip().startswith("trum-sym")
]


def answer(capsys, *words):
    """What a command prints, which has to end well."""
    code = console.main(list(words))
    out, err = capsys.readouterr()
    assert code in (0, 1), err
    return code, out


# --- Examples -------------------------------------------------------------------------------------


@pytest.mark.parametrize("words", LEAVES, ids=" ".join)
def test_every_help_has_an_example_of_that_command(capsys, words):
    _, out = answer(capsys, *words, "--help")
    _, _, shown = out.partition("Examples:\n")
    assert shown, "no example"
    found = [line.strip() for line in shown.splitlines() if line.strip()]
    assert all(line.startswith(" ".join(("trum-sym", *words))) for line in found), found


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the data that examples name, and a point in a file."""
    shutil.copytree(ROOT / "examples" / "data", tmp_path / "examples" / "data")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("line", EXAMPLES)
def test_every_example_of_a_help_runs(folder, capsys, line):
    if "point.json" in line:
        _, out = answer(capsys, "evaluate", "--json")
        (folder / "point.json").write_text(out, "utf-8")
    if "my.toml" in line and " new " not in line:
        answer(capsys, "motor", "new", "my.toml")
    code, out = answer(capsys, *shlex.split(line)[1:])
    assert code == (1 if "check my.toml" in line else 0), out  # a template is not ready


# --- Errors ---------------------------------------------------------------------------------------

TYPED = [
    (("evaluate", "--prepressure", "-0.2 kN"), "--prepressure: got -0.2 kN, need "),
    (("evaluate", "--set", "contact_radius=-26 mm"), "contact_radius: got -26 mm, need "),
    (
        ("speed-table", "--from", "1000 arcsec/s", "--to", "1 arcsec/s"),
        "--from: got 1000 arcsec/s, need less than --to, 1 arcsec/s",
    ),
    (
        ("speed-table", "--from", "1 arcsec/s", "--to", "1000 arcsec/s", "--prepressure", "180"),
        "--error: got 0.01, need ",
    ),
    (("robust", "--objective", "ripple"), "--spread: got neither "),
    (("spread", "--samples", "100"), "--samples: got 100, need "),
    (("optimize",), "--target-speed: got none, need a mean speed"),
    (("pareto",), "--target-speed: got none, need a mean speed"),
    (("robust", "--spread", "friction_coefficient"), "--target-speed: got none, need a mean speed"),
]


@pytest.mark.parametrize(("words", "beginning"), TYPED, ids=[" ".join(words) for words, _ in TYPED])
def test_errors_name_options_and_what_was_typed(console_refuses, words, beginning):
    assert console_refuses(*words, naming=()).startswith(f"trum-sym: {beginning}")


# --- Points ---------------------------------------------------------------------------------------

GIVEN = (
    *("--prepressure", "171.25 N", "--frequency-difference", "2.91 kHz", "--load-torque", "0.07", "--periods", "10"),
    *(
        "--on-periods",
        "7",
        "--start",
        "steady",
        "--phase-lead",
        "-1",
        "--contact",
        "hertz",
        "--sampling-period",
        "2 ms",
    ),
    *("--set", "friction_coefficient=0.21", "--tolerance", "1e-5"),
)


@pytest.fixture
def written(capsys, tmp_path):
    """Write what a command answers with --json; returns the path and the record."""

    def write(*words):
        _, out = answer(capsys, *words, "--json")
        path = tmp_path / "point.json"
        path.write_text(out, "utf-8")
        return str(path), json.loads(out)

    return write


def test_json_has_every_input_and_says_its_units(written):
    _, record = written("evaluate", *GIVEN)
    assert record["schema"] == 1
    assert record["drive"] == {
        **{"prepressure": 171.25, "frequency_difference": 2910.0, "periods": 10.0, "on_periods": 7.0},
        **{name: value for name, value in record["drive"].items() if name not in GIVEN_NAMES},
        **{"load_torque": 0.07, "start": "steady", "switching_phase": 0.0, "phase_lead": -1.0},
    }
    assert record["levels"]["contact"] == "hertz"
    assert (record["sampling_period"], record["tolerance"]) == (2e-3, 1e-5)
    assert record["motor_values"]["friction_coefficient"] == 0.21
    assert (record["units"]["mean_speed"], record["units"]["prepressure"]) == ("rad/s", "N")
    assert record["units"]["contact_radius"] == "m"
    named = {name for name, value in record.items() if isinstance(value, float)}
    assert named <= set(record["units"]) | {"tolerance"}


GIVEN_NAMES = ("prepressure", "frequency_difference", "periods", "on_periods")


def test_a_point_gives_the_same_figures_again(written):
    path, first = written("evaluate", *GIVEN)
    assert written("evaluate", "--point", path)[1] == first


def test_a_point_of_the_default_tolerance_gives_the_same_bits(written):
    path, first = written("evaluate")
    again = written("evaluate", "--point", path)[1]
    assert again == first


def test_what_is_typed_comes_before_what_the_file_says(written):
    path, first = written("evaluate", *GIVEN)
    again = written("evaluate", "--point", path, "--load-torque", "0.01", "--set", "contact_radius=27 mm")[1]
    assert again["drive"] == {**first["drive"], "load_torque": 0.01}
    assert again["motor_values"] == {**first["motor_values"], "contact_radius": 0.027}


def test_a_motor_of_ones_own_goes_with_its_point(written, motor_file):
    from refusals import WITHOUT_PUBLISHED

    own = motor_file(
        WITHOUT_PUBLISHED.replace('name = "TRUM-60"', 'name = "own"').replace("value = 12.6", "value = 12.1")
    )
    path, first = written("evaluate", "--motor", str(own))
    own.unlink()
    again = written("evaluate", "--point", path)[1]
    assert again == {**first, "assumed": again["assumed"]}
    assert again["motor"] == "own"
    assert set(again["assumed"]) == set(first["assumed"])


PLACE = ("--load-torque", "0.05", "--prepressure", "180")
NARROW = ("--frequency-difference", "2950:3000")
SOURCES = {
    "optimize": ("optimize", *PLACE, "--target-speed", "300000 arcsec/s"),
    "pareto": ("pareto", *PLACE, "--target-speed", "300000 arcsec/s", "--points", "3", "--objective", "ripple"),
    "robust": ("robust", *PLACE, "--target-speed", "300000 arcsec/s", "--spread", "load_torque=1 %", *NARROW),
    "speed-table": ("speed-table", *PLACE, "--from", "300000 arcsec/s", "--to", "301000 arcsec/s", "--points", "2"),
    "spread": ("spread", *PLACE, "--spread", "friction_coefficient=1 %", "--samples", "64"),
}


@pytest.mark.parametrize("source", [pytest.param(s, marks=[pytest.mark.slow] * (s == "robust")) for s in SOURCES])
def test_a_point_passes_from_any_command_into_others(written, capsys, source):
    path, record = written(*SOURCES[source])
    points = record.get("points")
    assert set(record) >= {"schema", "trum_sym", "motor_values", "drive", "levels", "tolerance", "remarks", "units"}
    last = points[-1] if points else None
    name = f"{path}#{len(points)}" if points else path
    drive = {**record["drive"], **(last["drive"] if last else {})}
    found = json.loads(answer(capsys, "evaluate", "--point", name, "--json")[1])
    assert found["drive"] == drive
    nominal = record["outputs"]["mean_speed"]["nominal"] if source == "spread" else (last or record).get("mean_speed")
    if source == "robust":
        nominal = record["cases"][0]["mean_speed"]
    assert found["mean_speed"] == pytest.approx(nominal, rel=1e-6)
    table = answer(capsys, "evaluate", "--point", name)[1]
    numbers = [full(drive[key]) for key in ("prepressure", "frequency_difference")]
    assert all(number in table for number in numbers)
    pasted = ("--prepressure", numbers[0], "--frequency-difference", numbers[1], "--load-torque", "0.05")
    given = ("--tolerance", full(found["tolerance"]))
    assert json.loads(answer(capsys, "evaluate", *pasted, *given, "--json")[1])["mean_speed"] == found["mean_speed"]


def test_a_file_of_several_points_needs_a_number(written, console_refuses):
    path, record = written(*SOURCES["speed-table"])
    count = len(record["points"])
    console_refuses("evaluate", "--point", path, naming=("--point: got no number", f"the file's {count} points"))
    console_refuses("evaluate", "--point", f"{path}#{count + 1}", naming=("--point", f"from 1 to {count}"))
    console_refuses("evaluate", "--point", f"{path}#0", naming=("--point", f"from 1 to {count}"))


@pytest.mark.parametrize(
    ("change", "naming"),
    [
        (lambda r: {**r, "schema": 99}, ("--point, schema: got 99", "1")),
        (lambda _: {"prepressure": 180.0}, ("--point, schema: got None",)),
        (lambda r: {**r, "drive": 3}, ("--point, drive: got 3", "an object")),
        (lambda r: {**r, "drive": {**r["drive"], "prepressure": None}}, ("--point, prepressure: got None", "a number")),
        (lambda r: {**r, "drive": {**r["drive"], "prepressure": True}}, ("--point, prepressure: got True", "a number")),
        (lambda r: {**r, "drive": {**r["drive"], "prepressure": -1.0}}, ("--prepressure: got -1", "> 0")),
        (lambda r: {**r, "drive": {**r["drive"], "force": 1.0}}, ("--point, drive: got force", "prepressure")),
        (lambda r: {**r, "drive": {**r["drive"], "start": "late"}}, ("--start", "'late'", "periodic")),
        (lambda r: {**r, "levels": {**r["levels"], "contact": "glue"}}, ("--contact", "'glue'", "winkler")),
        (lambda r: {**r, "motor_values": {"force": 1.0}}, ("--point, motor_values: got force", "motor file")),
        (lambda r: {**r, "motor": "x", "motor_values": {}}, ("--point, motor_values: got no radius",)),
        (lambda r: {**r, "motor_values": {**r["motor_values"], "radius": "wide"}}, ("--point, radius: got wide",)),
    ],
)
def test_a_file_that_is_no_point_is_refused(written, console_refuses, change, naming):
    path, record = written("evaluate")
    Path(path).write_text(json.dumps(change(record)), "utf-8")
    console_refuses("evaluate", "--point", path, naming=naming)


@pytest.mark.parametrize("content", ["{", "[]", "null"])
def test_what_is_no_object_is_refused(tmp_path, console_refuses, content):
    path = tmp_path / "point.json"
    path.write_text(content, "utf-8")
    console_refuses(
        "spread", "--point", str(path), naming=("--point: got", "wrote with --json" if content == "{" else "one JSON")
    )
    console_refuses("evaluate", "--point", str(tmp_path / "none.json"), naming=("--point: got", "No such file"))


def test_the_motor_of_a_point_is_the_shipped_one_where_nothing_was_set(written):
    path, _ = written("evaluate")
    assert read_point(Path(path)).motor() == ts.load_motor()


@pytest.mark.parametrize("number", range(6))
def test_a_random_point_passes_every_way(tmp_path, number):
    """A sample of ``python -m studies.points``: each command that takes a point once."""
    from studies import points

    assert points.wrong(points.drawn(np.random.default_rng([7, number])), tmp_path, number) == []


def test_a_point_that_loses_digits_is_noticed(tmp_path, monkeypatch):
    from studies import points
    from trum_sym.model import tables

    monkeypatch.setattr(tables, "full", lambda value: f"{float(value):.6g}")
    assert "pasted to evaluate" in points.wrong(points.drawn(np.random.default_rng(7)), tmp_path, 0)


def test_words_agree_in_number(capsys):
    pytest.importorskip("xarray")
    assert "1 cycle of" in answer(capsys, "simulate")[1]
    assert "2 cycles of" in answer(capsys, "simulate", "--cycles", "2")[1]
    assert not re.search(r"periods of periods", answer(capsys, *SOURCES["optimize"])[1])
