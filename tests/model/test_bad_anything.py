"""Any input at all is answered or refused in one clear line (property tests)."""

from __future__ import annotations

import io
import math
from contextlib import redirect_stderr, redirect_stdout, suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import (
    CHOICES,
    MOTOR,
    MOTOR_TEXT,
    NUMERIC_FIELDS,
    OPTIONS,
    PARAMETER_NAMES,
    POINT_NUMBERS,
    SAMPLE,
    SEARCH,
    WIDE_SAMPLE,
    WIDE_SEARCH,
    assert_one_clear_line,
    published,
    voltage,
)

import trum_sym as ts
from trum_sym import console
from trum_sym.inputs.units import parse_quantity

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")


# --- Any input at all ----------------------------------------------------------------------------


ROTOR_NUMBERS = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque", "contact_fraction")
ROTOR_NUMBERS += tuple(f"{name}_error" for name in ROTOR_NUMBERS[:-1])


def assert_no_nan(point):
    for name in POINT_NUMBERS:
        value = getattr(point, name)
        infinite = name in ("q_ratio", "q_square_ratio") and value == math.inf
        unsettled = name in ROTOR_NUMBERS and not point.converged and point.reason  # said so by the flag
        volatile = name.startswith("speed_volatility") and abs(point.mean_speed) <= point.mean_speed_error
        assert math.isfinite(value) or infinite or unsettled or volatile, name
    assert 0 <= point.contact_fraction <= 1 or math.isnan(point.contact_fraction)


def evaluate_or_refuse(make):
    try:
        point = make()
    except ts.ParameterError as error:
        assert_one_clear_line(str(error), "got", "need")
    else:
        assert_no_nan(point)


def console_answers(*arguments):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = console.main(list(arguments))
    warnings = [line for line in err.getvalue().splitlines() if line.startswith("trum-sym: warning: ")]
    refusals = [line for line in err.getvalue().splitlines() if line not in warnings]
    assert code in (0, 1, 2)
    assert len(refusals) == (code == 2)
    assert all(line.startswith("trum-sym: ") for line in refusals)
    assert (out.getvalue() == "") == (code == 2)


def load_or_refuse(path, content):
    path.write_bytes(content)
    try:
        motor = ts.load_motor(path)
    except ts.ParameterError as error:
        assert_one_clear_line(str(error), "got", "need")
    else:
        assert isinstance(motor, ts.Motor)
        console_answers("evaluate", "--motor", str(path))


@pytest.fixture(scope="module")
def scratch_file(tmp_path_factory):
    return tmp_path_factory.mktemp("motors") / "motor.toml"


ANY_FLOAT = st.floats() | st.floats(-1e6, 1e6) | st.integers(-50, 50) | st.integers()
UNIT_TERM = st.tuples(
    st.sampled_from(["m", "mm", "kg", "s", "N", "kN", "Hz", "GPa", "deg", "arcsec", "rpm", "%", "1", "µm", "x", ""]),
    st.sampled_from(["", "", "2", "^2", "^-1", "^0", "^400", "^-400", "^9999", "^-9999", "^^", "^1.5"]),
).map("".join)
UNIT_TEXT = st.lists(
    st.tuples(UNIT_TERM, st.sampled_from(["*", "/", " ", "·", "", "\n"])).map("".join), max_size=4
).map("".join)
NUMBER_TEXT = st.floats().map(repr) | st.sampled_from(
    ["", "1", "-inf", "NaN", "ınf", "1e", "1e999", "٣", "1_000", "+-1"]
)
QUANTITY_TEXT = st.tuples(NUMBER_TEXT, st.sampled_from(["", " ", "\t"]), UNIT_TEXT).map("".join)
ANY_TEXT = st.text(max_size=40) | QUANTITY_TEXT
TOML_VALUE = st.sampled_from(
    ['""', '"x"', '"V"', '"a\\nb"', "0", "-1", "1e-300", "1e300", "nan", "inf", "true", "[]", "{}", "[1, 2]", "1e", "x"]
)


# Orbits of a drive or a motor that nobody has may take seconds each: a sample, and all of them with -m slow
SIZES = pytest.mark.parametrize("sample", [True, pytest.param(False, marks=pytest.mark.slow)], ids=["sample", "all"])


def a_parameter(name, value, amplitude):
    with suppress(ts.ConvergenceError):
        evaluate_or_refuse(lambda: ts.evaluate(MOTOR.with_values({name: value}), amplitude=amplitude))


@SIZES
@pytest.mark.parametrize("name", NUMERIC_FIELDS)
def test_any_number_in_a_drive_evaluates_or_is_refused(name, sample):
    def one(value, start):
        evaluate_or_refuse(lambda: ts.evaluate(MOTOR, ts.Drive(**{name: value}, start=start)))

    (SAMPLE if sample else SEARCH)(given(ANY_FLOAT, st.sampled_from(CHOICES["start"]))(one))()


@SIZES
def test_any_number_for_a_motor_parameter_evaluates_or_is_refused(sample):
    a_parameter("resonance_frequency", 1e300, "measured")
    a_parameter("wavenumber", 5e-324, "forced")
    drawn = given(st.sampled_from(PARAMETER_NAMES), ANY_FLOAT, st.sampled_from(CHOICES["amplitude"]))
    (WIDE_SAMPLE if sample else WIDE_SEARCH)(drawn(a_parameter))()


@SEARCH
@given(text=ANY_TEXT)
def test_any_text_after_set_is_answered(text):
    console_answers("evaluate", "--set", text)


@SEARCH
@given(name=st.sampled_from(PARAMETER_NAMES), text=ANY_TEXT)
def test_any_text_as_a_value_to_set_is_answered(name, text):
    console_answers("evaluate", "--set", f"{name}={text}")


@SEARCH
@given(option=st.sampled_from(list(OPTIONS)), text=ANY_TEXT)
def test_any_text_for_an_option_is_answered(option, text):
    console_answers("evaluate", option, text)


@WIDE_SEARCH
@given(text=ANY_TEXT, unit=st.sampled_from(["1", "m", "N", "Hz", "N*m", "kg/m^3"]))
def test_any_text_is_a_quantity_or_refused(text, unit):
    try:
        value = parse_quantity("prepressure", text, unit)
    except ts.ParameterError as error:
        assert_one_clear_line(str(error), "prepressure", "need")
    else:
        assert isinstance(value, float)


@SEARCH
@given(content=st.text(max_size=200).map(str.encode) | st.binary(max_size=200))
def test_any_content_as_a_motor_file_is_read_or_refused(scratch_file, content):
    load_or_refuse(scratch_file, content)


@SEARCH
@given(line=st.integers(0, MOTOR_TEXT.count("\n")), text=st.text(max_size=40))
def test_any_line_in_a_motor_file_is_read_or_refused(scratch_file, line, text):
    lines = MOTOR_TEXT.splitlines()
    load_or_refuse(scratch_file, "\n".join([*lines[:line], text, *lines[line + 1 :]]).encode())


@SEARCH
@given(changes=st.dictionaries(st.sampled_from(["value", "unit", "symbol", "source", "range", "reason"]), TOML_VALUE))
def test_any_entry_in_a_motor_file_is_read_or_refused(scratch_file, changes):
    load_or_refuse(scratch_file, voltage(**changes).encode())


@SEARCH
@given(changes=st.dictionaries(st.sampled_from(["output", "value", "unit", "source", "drive"]), TOML_VALUE))
def test_any_published_figure_in_a_motor_file_is_read_or_refused(scratch_file, changes):
    load_or_refuse(scratch_file, published(**changes).encode())
