"""Bad motor files: the entry, what it holds, what is allowed."""

from __future__ import annotations

import pytest
from refusals import MOTOR_TEXT, VOLTAGE_LINE, WITHOUT_PUBLISHED, described, published, refusal, voltage

import trum_sym as ts
from trum_sym import console

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")


# --- Motor files ---------------------------------------------------------------------------------


BAD_ENTRIES = [
    ({"value": None}, ("voltage.value: got nothing",)),
    ({"unit": None}, ("voltage.unit: got nothing",)),
    ({"source": None}, ("voltage.source: got nothing",)),
    ({"value": '"200"'}, ("voltage.value: got 200", "a number in V")),
    ({"value": '""'}, ("voltage.value: got", "a number in V")),
    ({"value": "true"}, ("voltage.value: got True", "a number in V")),
    ({"value": "[200.0]"}, ("voltage.value: got [200.0]", "a number in V")),
    ({"value": "{}"}, ("voltage.value: got {}", "a number in V")),
    ({"value": "2021-10-01"}, ("voltage.value: got", "a number in V")),
    ({"value": "nan"}, ("voltage: got nan", "> 0 in V")),
    ({"value": "inf"}, ("voltage: got inf", "> 0 in V")),
    ({"value": "-inf"}, ("voltage: got -inf", "> 0 in V")),
    ({"value": "1e400"}, ("voltage: got inf", "> 0 in V")),
    ({"value": "0"}, ("voltage: got 0", "> 0 in V")),
    ({"value": "-200"}, ("voltage: got -200", "> 0 in V")),
    ({"value": "1" + "0" * 400}, ("voltage", "in V")),
    ({"value": "1" + "0" * 5000}, ("motor",)),
    ({"value": '"x"', "unit": '"\\nV"'}, ("voltage.value: got x", "a number in")),
    ({"unit": '"Hz"'}, ("voltage.unit: got Hz", "converts to V")),
    ({"unit": '"vlt"'}, ("voltage.unit: got vlt", "converts to V", "unknown unit", "volt")),
    ({"unit": '""'}, ("voltage.unit: got", "converts to V")),
    ({"unit": "1"}, ("voltage.unit: got 1", "text")),
    ({"unit": '"V deg^-9999"'}, ("voltage", "V")),
    ({"unit": '"V Gm^400/m^400"'}, ("voltage", "V")),
    ({"symbol": '"U"'}, ("voltage.symbol: got U", "U_s")),
    ({"symbol": '""'}, ("voltage.symbol: got", "U_s")),
    ({"symbol": "1"}, ("voltage.symbol: got 1", "text")),
    ({"source": '""'}, ("voltage.source: got empty text", "where the value comes from")),
    ({"source": '"  "'}, ("voltage.source: got empty text", "where the value comes from")),
    ({"source": "2021"}, ("voltage.source: got 2021", "text")),
    ({"note": "1"}, ("voltage.note: got 1", "text")),
    ({"colour": '"red"'}, ("voltage: got colour", "value, unit, symbol, source, range, reason, note")),
    ({'"two\\nlines"': "1"}, ("voltage: got two lines", "value, unit, symbol, source, range, reason, note")),
    ({"source": '"assumed"'}, ("voltage: got source = 'assumed'", "a range and a reason")),
    ({"source": '"assumed"', "range": "[100, 300]"}, ("voltage", "a range and a reason")),
    ({"source": '"assumed"', "reason": '"usual"'}, ("voltage", "a range and a reason")),
    ({"source": '"assumed"', "range": "[100, 300]", "reason": '" "'}, ("voltage", "a range and a reason")),
    ({"range": "[300, 400]"}, ("voltage.range: got [300, 400]", "low <= value <= high")),
    ({"range": "[300, 100]"}, ("voltage.range: got [300, 100]", "low <= value <= high")),
    ({"range": "[nan, 300]"}, ("voltage.range: got", "nan")),
    ({"range": "[100, inf]"}, ("voltage.range: got", "inf")),
    ({"range": "[100, 1" + "0" * 400 + "]"}, ("voltage.range",)),
    ({"range": "[100]"}, ("voltage.range: got [100]", "two numbers")),
    ({"range": "[100, 200, 300]"}, ("voltage.range: got [100, 200, 300]", "two numbers")),
    ({"range": "200"}, ("voltage.range: got 200", "two numbers")),
    ({"range": '["low", 300]'}, ("voltage.range: got low", "a number in V")),
    ({"range": "[false, 300]"}, ("voltage.range: got False", "a number in V")),
]


@pytest.mark.parametrize(("changes", "naming"), BAD_ENTRIES, ids=[described(changes) for changes, _ in BAD_ENTRIES])
def test_motor_file_refuses_a_bad_entry(motor_file, changes, naming):
    with refusal(*naming):
        ts.load_motor(motor_file(voltage(**changes)))


@pytest.mark.parametrize(
    ("content", "naming"),
    [
        pytest.param("", ("name: got nothing",), id="empty"),
        pytest.param("name = ", ("motor", "a valid TOML file"), id="malformed"),
        pytest.param('name = "two\nlines"', ("motor", "a valid TOML file", "line 1"), id="newline-in-text"),
        pytest.param("name = 1\nname = 2", ("motor", "a valid TOML file", "overwrite"), id="key-twice"),
        pytest.param(MOTOR_TEXT + "\0", ("motor", "a valid TOML file"), id="nul-at-the-end"),
        pytest.param(f"{VOLTAGE_LINE}\n".join(["[parameters]\n"] * 3), ("a valid TOML file",), id="parameter-twice"),
        pytest.param("name = " + "[" * 5000 + "]" * 5000, ("motor",), id="nested-arrays"),
        pytest.param("name = " + "{a=" * 5000, ("motor",), id="nested-tables"),
        pytest.param(b"\x7fELF\x02\x01\x01\x00\xff\xfe", ("motor", "not UTF-8 text"), id="binary"),
        pytest.param(MOTOR_TEXT.encode("utf-16"), ("motor", "not UTF-8 text"), id="utf-16"),
        pytest.param("colour = 1\n" + MOTOR_TEXT, ("colour", "box, allowed, spreads and"), id="unknown-key"),
        pytest.param("[motor]\n" + MOTOR_TEXT, ("motor", "box, allowed, spreads and"), id="name-in-a-table"),
        pytest.param('"two\\nlines" = 1\n' + MOTOR_TEXT, ("two lines", "parameters"), id="unknown-two-line-key"),
        pytest.param(MOTOR_TEXT.replace('"TRUM-60"', "60"), ("name: got 60", "text"), id="name-a-number"),
        pytest.param(MOTOR_TEXT.replace('"TRUM-60"', "[]"), ("name: got []", "text"), id="name-a-list"),
        pytest.param('name = "bare"', ("parameters", "got nothing"), id="no-parameters"),
        pytest.param('name = "bare"\nparameters = 3', ("parameters: got 3",), id="parameters-a-number"),
        pytest.param('name = "bare"\n[[parameters]]', ("parameters: got [{}]",), id="parameters-a-list"),
        pytest.param('name = "bare"\n[parameters]', ("no radius, tooth_count", "every required"), id="all-missing"),
        pytest.param(MOTOR_TEXT.replace(VOLTAGE_LINE, ""), ("no voltage", "every required"), id="one-missing"),
        pytest.param(MOTOR_TEXT.replace(VOLTAGE_LINE, "voltage = 200"), ("voltage: got 200", "table"), id="bare-value"),
        pytest.param(MOTOR_TEXT.replace(VOLTAGE_LINE, "voltage = [{}]"), ("voltage: got [{}]", "table"), id="list"),
        pytest.param(MOTOR_TEXT.replace("voltage ", "voltge "), ("got voltge", "close names: voltage"), id="misspelt"),
        pytest.param(MOTOR_TEXT.replace("voltage ", '"volt\\nage" '), ("got volt age", "a name"), id="two-line-name"),
    ],
)
def test_motor_file_refuses_bad_content(motor_file, content, naming):
    with refusal(*naming):
        ts.load_motor(motor_file(content))


NOT_FITTING = [
    ("value = 2.0, unit", "value = 4.5, unit", ("tooth_height: got 0.0045", "beam_thickness")),
    ("value = 0.8, unit", "value = 2.8, unit", ("slot_width: got 0.0028", "perimeter")),
    ("value = 100.0, unit", "value = 300.0, unit", ("fit_prepressure_min: got 300", "fit_prepressure_max")),
    ("value = 9, unit", "value = 9.5, unit", ("crests: got 9.5", "an integer")),
    ("value = 72, unit", "value = 0, unit", ("tooth_count: got 0", "an integer >= 1")),
    ("value = 0.006, unit", "value = 1.0, unit", ("damping_ratio: got 1", "< 1")),
    ('value = 0.006, unit = "1"', 'value = 0.006, unit = "m"', ("damping_ratio.unit: got m", "converts")),
    ("value = 0.006, unit", 'value = "0.6 %", unit', ("damping_ratio.value: got 0.6 %", "number")),
]


@pytest.mark.parametrize(("old", "new", "naming"), NOT_FITTING, ids=[new for _, new, _ in NOT_FITTING])
def test_motor_file_refuses_values_that_do_not_fit(motor_file, old, new, naming):
    assert MOTOR_TEXT.count(old) == 1
    with refusal(*naming):
        ts.load_motor(motor_file(MOTOR_TEXT.replace(old, new)))


@pytest.mark.parametrize(
    "changes",
    [
        {"output": None},
        {"value": None},
        {"unit": None},
        {"source": None},
        {"drive": None},
        {"colour": '"red"'},
        {"output": "1"},
        {"output": "[1]"},
        {"output": '"nonsense"'},
        {"output": '"motor"'},
        {"value": '"5.5"'},
        {"value": "true"},
        {"value": "nan"},
        {"value": "inf"},
        {"value": "[5.5e-6]"},
        {"value": "1" + "0" * 400},
        {"unit": '"furlong"'},
        {"unit": '"Hz"'},
        {"unit": '""'},
        {"unit": "1"},
        {"source": "1"},
        {"drive": "180"},
        {"drive": "{ nonsense = 1 }"},
        {"drive": '{ start = "rest" }'},
        {"drive": '{ prepressure = "180 N" }'},
        {"drive": "{ prepressure = true }"},
        {"drive": "{ prepressure = nan }"},
        {"drive": "{ prepressure = [180] }"},
    ],
    ids=described,
)
def test_motor_file_refuses_a_malformed_published_figure(motor_file, changes):
    with refusal("published", "got", "need"):
        ts.load_motor(motor_file(published(**changes)))


@pytest.mark.parametrize("content", ["published = 3\n", 'published = "Table 4"\n', "published = [3]\n"])
def test_motor_file_refuses_published_that_is_no_array_of_tables(motor_file, content):
    with refusal("published: got", "tables"):
        ts.load_motor(motor_file(content + WITHOUT_PUBLISHED))


def test_console_compares_with_a_published_zero(motor_file, capsys):
    assert console.main(["evaluate", "--motor", str(motor_file(published(value="0")))]) == 0
    assert capsys.readouterr().err == ""


def test_motor_refuses_a_missing_file(tmp_path):
    with refusal("motor: got", "TOML file that exists"):
        ts.load_motor(tmp_path / "missing.toml")


def test_motor_refuses_a_directory(tmp_path):
    with refusal("motor: got", "a readable TOML file", "directory"):
        ts.load_motor(tmp_path)


def test_motor_refuses_a_path_through_a_file(motor_file):
    with refusal("motor: got", "TOML file"):
        ts.load_motor(motor_file(MOTOR_TEXT) / "motor.toml")


@pytest.mark.parametrize(
    ("old", "new", "naming"),
    [
        ("[bench]", "[bench]\nstring_stiffness = 1e5", ("bench", "string_stiffness", "load_inertia, load_radius")),
        ("[bench]\n", "bench = 1\n[other]\n", ("other",)),
        ('unit = "kg*m^2", symbol = "J_load"', 'unit = "kg", symbol = "J_load"', ("load_inertia.unit", "kg*m^2")),
        ("range = [1.7e-5, 4.0e-3]", "range = [1e-3, 4.0e-3]", ("load_inertia.range", "low <= value <= high")),
        ("value = 2.7e-4", "value = -2.7e-4", ("load_inertia", ">= 0")),
    ],
)
def test_a_bench_that_is_none_is_refused(motor_file, old, new, naming):
    assert MOTOR_TEXT.count(old) == 1
    with refusal(*naming):
        ts.load_motor(motor_file(MOTOR_TEXT.replace(old, new)))


def test_a_motor_file_may_say_nothing_of_a_bench(motor_file):
    without = MOTOR_TEXT[: MOTOR_TEXT.index("[bench]")] + MOTOR_TEXT[MOTOR_TEXT.index("[[published]]") :]
    assert dict(ts.load_motor(motor_file(without)).bench) == {}
    stated = ts.load_motor("trum60").bench
    assert stated["sampling_period"].value == 2e-3
    assert stated["load_inertia"].range == (1.7e-5, 4e-3)
