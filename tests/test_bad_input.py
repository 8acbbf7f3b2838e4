"""Bad input: one clear line, exit code 2, no traceback; the parameter, what it got and what is allowed."""

from __future__ import annotations

import io
import math
import re
import subprocess
import sys
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

import trum_sym as ts
from trum_sym import console
from trum_sym.units import parse_quantity

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")

MOTOR = ts.load_motor("trum60")
MOTOR_TEXT = files("trum_sym").joinpath("data/trum60.toml").read_text("utf-8")
VOLTAGE_LINE = re.search(r"^voltage .*$", MOTOR_TEXT, re.MULTILINE)[0]
WITHOUT_PUBLISHED = MOTOR_TEXT[: MOTOR_TEXT.index("[[published]]")]
NUMERIC_FIELDS = tuple(ts.Drive().numbers())
MEASURED_NAMES = ("resonance_frequency", "amplitude", "neutral_axis", "wavenumber", "layer_stiffness")
PARAMETER_NAMES = (*dict(MOTOR.parameters()), *MEASURED_NAMES)
POINT_NUMBERS = tuple(name for name, value in ts.evaluate(MOTOR).as_dict().items() if isinstance(value, float))
SEARCH = settings(
    derandomize=True, deadline=None, max_examples=80, phases=(Phase.explicit, Phase.generate, Phase.shrink)
)
WIDE_SEARCH = settings(SEARCH, max_examples=250)


# --- The two helpers -----------------------------------------------------------------------------


def assert_one_clear_line(message, *fragments):
    assert len(message.splitlines()) == 1
    assert "Traceback" not in message
    assert "got , need" not in message, "what was given must show, even if it is empty"
    assert not re.search(r"number in 1(?!/)", message), "a pure number has no unit"
    for fragment in fragments:
        assert fragment in message


@pytest.fixture
def console_refuses(capsys):
    def refuse(*arguments, naming):
        code = console.main(list(arguments))
        out, err = capsys.readouterr()
        assert code == 2
        assert out == ""
        assert err.endswith("\n")
        assert err.startswith("trum-sym: ")
        assert not err.startswith("trum-sym: warning")
        assert_one_clear_line(err, *naming)
        return err

    return refuse


@contextmanager
def refusal(*fragments):
    with pytest.raises(ts.ParameterError) as caught:
        yield
    assert_one_clear_line(str(caught.value), *fragments)


def run_console(*arguments):
    command = [sys.executable, "-m", "trum_sym.console", *arguments]
    return subprocess.run(command, capture_output=True, timeout=8, check=False)


# --- Console: numbers ----------------------------------------------------------------------------

# option: (what is allowed, a unit of another dimension)
OPTIONS = {
    "--prepressure": ("in N", "Hz"),
    "--frequency-difference": ("in Hz", "N"),
    "--periods": ("need", "m"),
    "--on-periods": ("need", "Hz"),
    "--load-torque": ("in N*m", "V"),
    "--switching-phase": ("in rad", "s"),
    "--sampling-period": ("in s", "Hz"),
}


def parameter(option):
    return option.removeprefix("--").replace("-", "_")


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e400"])
@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_what_is_not_finite(console_refuses, option, value):
    shown = value if value != "1e400" else "inf"
    allowed = "an integer" if "periods" in option else OPTIONS[option][0]
    console_refuses("evaluate", option, value, naming=(parameter(option), f"got {shown}", allowed))


@pytest.mark.parametrize("value", ["many", "1,5", "0x10", "--", "one hundred N"])
@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_what_is_no_number(console_refuses, option, value):
    console_refuses("evaluate", option, value, naming=(parameter(option), f"got {value}", OPTIONS[option][0]))


@pytest.mark.parametrize("value", ["", "   ", "\n"], ids=["empty", "blanks", "newline"])
@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_empty_text_for_a_number(console_refuses, option, value):
    console_refuses("evaluate", option, value, naming=(parameter(option), "got", OPTIONS[option][0]))


@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_a_unit_of_another_dimension(console_refuses, option):
    allowed, unit = OPTIONS[option]
    console_refuses("evaluate", option, f"180 {unit}", naming=(parameter(option), f"got 180 {unit}", allowed))


@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_an_unknown_unit(console_refuses, option):
    naming = (parameter(option), "got 180 furlong", OPTIONS[option][0], "unknown unit 'furlong'")
    console_refuses("evaluate", option, "180 furlong", naming=naming)


OUT_OF_DOMAIN = [
    ("--prepressure", "0", ("got 0", "> 0", "in N")),
    ("--prepressure", "-180", ("got -180", "> 0", "in N")),
    ("--prepressure", "1 MN", ("got 1000000.0", "< 1e+06", "in N")),
    ("--periods", "0", ("got 0", "an integer >= 1")),
    ("--periods", "-20", ("got -20", "an integer >= 1")),
    ("--periods", "20.5", ("got 20.5", "an integer")),
    ("--periods", "1000001", ("got 1000001", "<= 1e+06")),
    ("--on-periods", "0", ("got 0", "an integer >= 1")),
    ("--on-periods", "-14", ("got -14", "an integer >= 1")),
    ("--on-periods", "13.5", ("got 13.5", "an integer")),
    ("--on-periods", "9", ("got 9", "from periods/2 to periods", "periods = 20")),
    ("--on-periods", "21", ("got 21", "from periods/2 to periods", "periods = 20")),
    ("--switching-phase", "1e7", ("got 10000000.0", "< 1e+06", "in rad")),
    ("--sampling-period", "0", ("got 0", "> 0", "in s")),
    ("--sampling-period", "-0.01", ("got -0.01", "> 0", "in s")),
    ("--sampling-period", "-10 ms", ("got -0.01", "> 0", "in s")),
    ("--frequency-difference", "-40 kHz", ("got -40000", "-0.9 times the resonance", "Hz")),
    ("--frequency-difference", "1e300", ("got 1e+300", "Hz")),
    ("--frequency-difference", "1e308", ("got 1e+308", "Hz")),
    ("--frequency-difference", "-1e308", ("got -1e+308", "Hz")),
]


@pytest.mark.parametrize(("option", "value", "naming"), OUT_OF_DOMAIN, ids=[f"{o} {v}" for o, v, _ in OUT_OF_DOMAIN])
def test_console_refuses_a_number_out_of_its_domain(console_refuses, option, value, naming):
    console_refuses("evaluate", option, value, naming=(parameter(option), *naming))


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--prepressure", "180 deg^-9999 N"),
        ("--prepressure", "180 N Gm^400/m^400"),
        ("--prepressure", "180 N pm^400/m^400"),
        ("--prepressure", "180 N^" + "9" * 5000),
        ("--frequency-difference", "ınf"),
        ("--load-torque", "0.3 N*m*rad/urad^60"),
        ("--load-torque", "0.3 //"),
        ("--switching-phase", "1 rad^0.5"),
    ],
    ids=["degree", "giga", "pico", "digits", "dotless-i", "micro", "slashes", "root"],
)
def test_console_refuses_an_odd_unit(console_refuses, option, value):
    console_refuses("evaluate", option, value, naming=(parameter(option), "got", OPTIONS[option][0]))


@pytest.mark.parametrize("value", ["20 100", "20 12", "20 000"])
def test_console_refuses_a_second_number_in_place_of_a_unit(console_refuses, value):
    console_refuses("evaluate", "--periods", value, naming=("periods", f"got {value}"))


def test_console_shortens_a_long_unit(console_refuses):
    long = "180 " + "x" * 1000
    line = console_refuses("evaluate", "--prepressure", long, naming=("prepressure", "got 180 xxx", "in N"))
    assert len(line) < 300


# --- Console: the motor --------------------------------------------------------------------------

BAD_SETS = [
    ("nonsense=1", ("nonsense", "a name of the motor file")),
    ("contact_raduis=26 mm", ("contact_raduis", "close names", "contact_radius")),
    ("name=TRUM-80", ("got name", "a name of the motor file")),
    ("published=1", ("got published", "a name of the motor file")),
    ("__class__=1", ("got __class__", "a name of the motor file")),
    ("contact_radius", ("--set", "got contact_radius", "NAME=VALUE")),
    ("contact_radius=", ("--set", "got contact_radius=", "NAME=VALUE")),
    ("contact_radius=  ", ("--set", "got contact_radius=", "NAME=VALUE")),
    ("=26 mm", ("--set", "got =26 mm", "NAME=VALUE")),
    ("=", ("--set", "got =", "NAME=VALUE")),
    ("", ("--set", "NAME=VALUE")),
    ("contact_radius==26 mm", ("contact_radius", "got =26 mm", "in m")),
    ("contact_radius=26 kg", ("contact_radius", "got 26 kg", "in m")),
    ("contact_radius=26 inch", ("contact_radius", "got 26 inch", "in m", "unknown unit")),
    ("contact_radius=wide", ("contact_radius", "got wide", "in m")),
    ("contact_radius=nan", ("contact_radius", "got nan", "> 0 in m")),
    ("contact_radius=inf", ("contact_radius", "got inf", "> 0 in m")),
    ("contact_radius=-inf", ("contact_radius", "got -inf", "> 0 in m")),
    ("contact_radius=0", ("contact_radius", "got 0", "> 0 in m")),
    ("contact_radius=-26 mm", ("contact_radius", "got -0.026", "> 0 in m")),
    ("damping_ratio=1", ("damping_ratio", "got 1", "< 1")),
    ("damping_ratio=1.5", ("damping_ratio", "got 1.5", "< 1")),
    ("damping_ratio=-0.001", ("damping_ratio", "got -0.001", ">= 0")),
    ("damping_ratio=some", ("damping_ratio", "got some")),
    ("crests=8.5", ("crests", "got 8.5", "an integer >= 1")),
    ("crests=0", ("crests", "got 0", "an integer >= 1")),
    ("tooth_count=71.5", ("tooth_count", "got 71.5", "an integer >= 1")),
    ("beam_poisson_ratio=0.6", ("beam_poisson_ratio", "got 0.6", "<= 0.5")),
    ("layer_poisson_ratio=-1", ("layer_poisson_ratio", "got -1", "> -1")),
    ("shear_correction=1.1", ("shear_correction", "got 1.1", "<= 1")),
    ("friction_coefficient=-0.1", ("friction_coefficient", "got -0.1", ">= 0")),
    ("piezo_strain_constant=inf", ("piezo_strain_constant", "got inf", "C/N")),
    ("resonance_frequency=0", ("resonance_frequency", "got 0", "> 0 in Hz")),
    ("resonance_frequency=1e308", ("resonance_frequency",)),
    ("resonance_frequency=40 mm", ("resonance_frequency", "got 40 mm", "in Hz")),
    ("tooth_height=5 mm", ("tooth_height", "got 0.005", "less than beam_thickness (0.0045 m)")),
    ("tooth_height=4.5 mm", ("tooth_height", "got 0.0045", "less than beam_thickness (0.0045 m)")),
    ("slot_width=3 mm", ("slot_width", "got 0.003", "perimeter")),
    ("tooth_count=500", ("slot_width", "tooth_count", "perimeter")),
    ("fit_prepressure_min=300", ("fit_prepressure_min", "got 300", "less than fit_prepressure_max (220")),
    ("fit_prepressure_max=50", ("fit_prepressure_min", "got 100", "less than fit_prepressure_max (50")),
]


@pytest.mark.parametrize(("override", "naming"), BAD_SETS, ids=[override or "empty" for override, _ in BAD_SETS])
def test_console_refuses_a_bad_set(console_refuses, override, naming):
    console_refuses("evaluate", "--set", override, naming=naming)


@pytest.mark.parametrize("override", ["crests=1e300", "radius=1e-300", "neutral_axis=1e300", "piezo_thickness=1e100"])
def test_console_blames_the_motor_where_its_values_give_no_resonance(console_refuses, override):
    line = console_refuses("evaluate", "--set", override, naming=("resonance_frequency",))
    assert "frequency_difference" not in line


@pytest.mark.parametrize("first", ["radius=30 mm", "radius=\n30 mm"], ids=["plain", "with-newline"])
def test_console_refuses_the_same_name_twice(console_refuses, first):
    naming = ("--set", "got radius=31 mm", "each name once", "30 mm before")
    console_refuses("evaluate", "--set", first, "--set", "radius=31 mm", naming=naming)


@pytest.mark.parametrize("start", ["periodic", "steady", "rest"])
@pytest.mark.parametrize("amplitude", ["measured", "forced"])
def test_console_refuses_undamped_resonance(console_refuses, start, amplitude):
    choices = ("--start", start, "--amplitude", amplitude)
    naming = ("damping_ratio: got 0", "> 0", "frequency_difference is 0 Hz")
    console_refuses("evaluate", "--set", "damping_ratio=0", "--frequency-difference", "0", *choices, naming=naming)


# resonance 40 kHz: periods * difference / (40 kHz + difference) is an integer
IN_PHASE = [("10 kHz", "5", "4"), ("4 kHz", "11", "8"), ("-10 kHz", "3", "2"), ("40 kHz", "20", "14")]


@pytest.mark.parametrize(("difference", "periods", "on"), IN_PHASE)
def test_console_refuses_a_periodic_start_that_the_cycle_does_not_fix(console_refuses, difference, periods, on):
    motor = ("--set", "damping_ratio=0", "--set", "resonance_frequency=40 kHz")
    drive = ("--frequency-difference", difference, "--periods", periods, "--on-periods", on)
    console_refuses("evaluate", *motor, *drive, naming=("start: got periodic", "damping", "steady or rest"))


def test_console_refuses_a_motor_that_does_not_exist(console_refuses):
    console_refuses("evaluate", "--motor", "trum61", naming=("motor: got trum61", "trum60 or the path"))


def test_console_refuses_a_directory_as_motor(console_refuses, tmp_path):
    console_refuses("evaluate", "--motor", str(tmp_path), naming=("motor", "a readable TOML file", "directory"))


def test_console_refuses_a_file_that_is_not_toml(console_refuses, motor_file):
    path = motor_file("radius = = 30")
    console_refuses("evaluate", "--motor", str(path), naming=("motor", "a valid TOML file", "line 1"))


@pytest.mark.parametrize("name", ["", "no\0path", "x" * 5000], ids=["empty", "with-nul", "too-long"])
def test_console_refuses_what_is_no_path(console_refuses, name):
    console_refuses("evaluate", "--motor", name, naming=("motor: got", "TOML file"))


# --- Console: words, options, commands -----------------------------------------------------------

CHOICES = {
    "start": ("periodic", "steady", "rest"),
    "contact": ("winkler", "hertz"),
    "resonance": ("quartic", "eq6", "printed", "euler"),
    "foundation": ("harmonic", "smeared", "printed", "none"),
    "amplitude": ("measured", "forced"),
}


@pytest.mark.parametrize("word", ["wrong", "", "None", "0", "two\nlines"], ids=repr)
@pytest.mark.parametrize("name", CHOICES)
def test_console_refuses_a_wrong_word(console_refuses, name, word):
    console_refuses("evaluate", f"--{name}", word, naming=(f"--{name}", repr(word), *CHOICES[name]))


@pytest.mark.parametrize("lead", ["0", "2", "-2", "0.5", "nan", "one", ""])
def test_console_refuses_a_wrong_phase_lead(console_refuses, lead):
    console_refuses("evaluate", "--phase-lead", lead, naming=("--phase-lead", repr(lead), "'1', '-1'"))


BAD_COMMAND_LINES = [
    (("evaluate", "--prepresure", "180"), ("--prepresure", "--prepressure")),
    (("evaluate", "--nonsense"), ("No such option", "--nonsense")),
    (("evaluate", "--nonsense=1"), ("No such option", "--nonsense")),
    (("evaluate", "-x"), ("No such option", "-x")),
    (("evaluate", "--json=yes"), ("--json", "does not take a value")),
    (("--prepressure", "180"), ("No such option", "--prepressure")),
    (("evaluate", "180"), ("unexpected", "180")),
    (("evaluate", "evaluate"), ("unexpected", "evaluate")),
    (("evalute",), ("No such command", "evalute")),
    (("",), ("No such command",)),
    (("evaluate", "--prepressure"), ("--prepressure", "requires an argument")),
    (("evaluate", "--set"), ("--set", "requires an argument")),
    (("evaluate", "--motor"), ("--motor", "requires an argument")),
    (("evaluate", "--start"), ("--start", "requires an argument")),
]


@pytest.mark.parametrize(
    ("arguments", "naming"), BAD_COMMAND_LINES, ids=[" ".join(a) or "empty" for a, _ in BAD_COMMAND_LINES]
)
def test_console_refuses_a_wrong_command_line(console_refuses, arguments, naming):
    console_refuses(*arguments, naming=naming)


def test_console_refuses_bad_input_as_json_too(console_refuses):
    console_refuses("evaluate", "--json", "--prepressure", "-1", naming=("prepressure", "got -1", "> 0"))


@pytest.mark.parametrize(
    ("arguments", "naming"),
    [
        (("evaluate", "--prepressure", "180 Hz"), (b"prepressure: got 180 Hz, need a number in N",)),
        (("evaluate", "--motor", b"\xff.toml"), (b"motor: got", b"need trum60 or the path of a TOML file")),
        (("evaluate", "--on-periods", "9"), (b"on_periods: got 9", b"periods/2")),
    ],
    ids=["wrong-unit", "undecodable-name", "too-few-on-periods"],
)
def test_process_refuses_bad_input(arguments, naming):
    done = run_console(*arguments)
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(b"trum-sym: ")
    assert len(done.stderr.splitlines()) == 1
    assert all(fragment in done.stderr for fragment in naming)


@pytest.mark.parametrize(
    "force", ["180 kN^99999999", "180" + " " * 3000 + "x\ny"], ids=["huge-exponent", "blanks-before-two-lines"]
)
def test_process_refuses_at_once(force):
    try:
        done = run_console("evaluate", "--prepressure", force)
    except subprocess.TimeoutExpired:
        pytest.fail("no answer within 8 s")
    assert (done.returncode, done.stdout) == (2, b"")
    assert len(done.stderr.splitlines()) == 1


# --- Python: the drive ---------------------------------------------------------------------------


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", NUMERIC_FIELDS)
def test_drive_refuses_what_is_not_finite(name, value):
    with refusal(f"{name}: got {value}"):
        ts.Drive(**{name: value})


@pytest.mark.parametrize("value", [[180.0, math.nan], np.array([[180.0], [-math.inf]])], ids=["list", "column"])
@pytest.mark.parametrize("name", ["prepressure", "frequency_difference", "load_torque", "switching_phase"])
def test_drive_refuses_an_array_that_is_not_all_finite(name, value):
    with refusal(f"{name}: got", "need a finite number"):
        ts.Drive(**{name: value})


NO_NUMBERS = [
    pytest.param(None, id="None"),
    pytest.param("strong", id="text"),
    pytest.param("", id="empty-text"),
    pytest.param(b"180", id="bytes"),
    pytest.param(180 + 0j, id="complex"),
    pytest.param(True, id="bool"),
    pytest.param({}, id="dict"),
    pytest.param({180.0}, id="set"),
    pytest.param(len, id="function"),
    pytest.param([], id="empty-list"),
    pytest.param(np.zeros((0, 3)), id="empty-array"),
    pytest.param([[1.0], [1.0, 2.0]], id="ragged"),
    pytest.param(np.array([1.0, None]), id="object-array"),
    pytest.param(np.array([True, False]), id="bool-array"),
    pytest.param(np.array([1j, 2j]), id="complex-array"),
    pytest.param(np.array(["1", "2"]), id="text-array"),
    pytest.param(np.array(["2021-10-01"], dtype="datetime64[D]"), id="dates"),
    pytest.param(np.zeros(2, dtype=[("force", float)]), id="structured-array"),
    pytest.param(10**400, id="400-digits"),
    pytest.param(10**5000, id="5000-digits"),
]


@pytest.mark.parametrize("value", NO_NUMBERS)
@pytest.mark.parametrize("name", ["prepressure", "periods", "load_torque", "phase_lead"])
def test_drive_refuses_what_is_no_number(name, value):
    with refusal(f"{name}: got", "need"):
        ts.Drive(**{name: value})


def test_drive_refuses_a_long_double_beyond_a_double():
    with refusal("prepressure", "< 1e+06 in N"):
        ts.Drive(prepressure=np.finfo(np.longdouble).max)


BAD_FIELDS = [
    ({"prepressure": 0}, ("prepressure: got 0", "> 0", "in N")),
    ({"prepressure": -180.0}, ("prepressure: got -180", "> 0", "in N")),
    ({"prepressure": [150.0, -1.0]}, ("prepressure: got -1", "> 0", "in N")),
    ({"periods": 0}, ("periods: got 0", "an integer >= 1")),
    ({"periods": 2.5}, ("periods: got 2.5", "an integer >= 1")),
    ({"periods": [20, 20.5]}, ("periods: got 20.5", "an integer >= 1")),
    ({"on_periods": 0}, ("on_periods: got 0", "an integer >= 1")),
    ({"on_periods": 9}, ("on_periods: got 9", "periods/2", "periods = 20")),
    ({"on_periods": 21}, ("on_periods: got 21", "to periods", "periods = 20")),
    ({"periods": 29}, ("on_periods: got 14", "periods/2", "periods = 29")),
    ({"periods": [20, 30]}, ("on_periods: got 14", "periods/2", "periods = 30")),
    ({"on_periods": [[14], [15]], "periods": [14, 15]}, ("on_periods: got 15", "periods = 14")),
    ({"phase_lead": 0}, ("phase_lead: got 0", "1 or -1")),
    ({"phase_lead": 0.5}, ("phase_lead: got 0.5", "1 or -1")),
    ({"phase_lead": 2}, ("phase_lead: got 2", "1 or -1")),
    ({"phase_lead": [1, -1, 0]}, ("phase_lead: got 0", "1 or -1")),
    ({"switching_phase": -1e7}, ("switching_phase: got -10000000.0", "> -1e+06", "in rad")),
]


@pytest.mark.parametrize(("fields", "naming"), BAD_FIELDS, ids=[str(fields) for fields, _ in BAD_FIELDS])
def test_drive_refuses_a_number_out_of_its_domain(fields, naming):
    with refusal(*naming):
        ts.Drive(**fields)


@pytest.mark.parametrize(
    ("fields", "naming"),
    [
        ({"prepressure": [150.0, 160.0], "load_torque": [0.1, 0.2, 0.3]}, ("load_torque: got shape (3,)", "(2,)")),
        ({"periods": [20, 20, 20], "on_periods": [14, 14]}, ("on_periods: got shape (2,)", "(3,)")),
        ({"prepressure": np.full((2, 3), 180.0), "phase_lead": [1, -1]}, ("phase_lead: got shape (2,)", "(2, 3)")),
    ],
    ids=["torque", "on-periods", "two-axes"],
)
def test_drive_refuses_shapes_that_do_not_broadcast(fields, naming):
    with refusal(*naming, "broadcasts"):
        ts.Drive(**fields)


NO_WORDS = ["wrong", "", "PERIODIC", None, 0, True, b"rest", ("rest",), ["rest"], {}, math.nan, np.array(["rest"])]


@pytest.mark.parametrize("word", NO_WORDS, ids=repr)
def test_drive_refuses_a_wrong_start(word):
    with refusal("start: got", *CHOICES["start"]):
        ts.Drive(start=word)


# --- Python: an evaluation -----------------------------------------------------------------------


@pytest.mark.parametrize("word", NO_WORDS, ids=repr)
@pytest.mark.parametrize("name", ["contact", "resonance", "foundation", "amplitude"])
def test_evaluation_refuses_a_wrong_word(name, word):
    with refusal(f"{name}: got", *CHOICES[name]):
        ts.evaluate(MOTOR, **{name: word})


@pytest.mark.parametrize("period", [0, -1e-3, math.nan, math.inf, "10 ms", 1j, True, [], [1e-3, 0.0]], ids=repr)
def test_evaluation_refuses_a_wrong_sampling_period(period):
    with refusal("sampling_period: got", "> 0 in s"):
        ts.evaluate(MOTOR, sampling_period=period)


FAR_OFF = [
    (-39e3, ("got -39000", "-0.9 times the resonance", "Hz")),
    (-1e5, ("got -100000", "-0.9 times the resonance", "Hz")),
    ([3e3, -1e5], ("got -100000", "-0.9 times the resonance", "Hz")),
    (1e300, ("got 1e+300", "Hz")),
    (1e308, ("got 1e+308", "Hz")),
    (-1e308, ("got -1e+308", "Hz")),
]


@pytest.mark.parametrize(("difference", "naming"), FAR_OFF, ids=[str(difference) for difference, _ in FAR_OFF])
@pytest.mark.parametrize("start", CHOICES["start"])
def test_evaluation_refuses_a_drive_frequency_far_off(difference, naming, start):
    with refusal("frequency_difference", *naming):
        ts.evaluate(MOTOR, ts.Drive(frequency_difference=difference, start=start))


@pytest.mark.parametrize("damping", [0.0, [0.006, 0.0]], ids=["one", "one-of-two"])
def test_evaluation_refuses_undamped_resonance(damping):
    with refusal("damping_ratio: got 0", "> 0", "frequency_difference is 0 Hz"):
        ts.evaluate(MOTOR.with_values({"damping_ratio": damping}), ts.Drive(frequency_difference=0.0))


def test_evaluation_refuses_a_periodic_start_where_one_cycle_of_many_does_not_fix_it():
    motor = MOTOR.with_values({"damping_ratio": 0.0, "resonance_frequency": 40e3})
    drive = ts.Drive(frequency_difference=10e3, periods=[4, 5, 6], on_periods=4)
    with refusal("start: got periodic", "damping", "steady or rest"):
        ts.evaluate(motor, drive)


def test_evaluation_refuses_motor_values_that_do_not_broadcast_against_the_drive():
    motor = MOTOR.with_values({"contact_radius": [26e-3, 27e-3]})
    with refusal("contact_radius: got shape (2,)", "broadcasts", "(3,)"):
        ts.evaluate(motor, ts.Drive(prepressure=[150.0, 160.0, 170.0]))


def test_evaluation_refuses_motor_values_that_do_not_broadcast_against_each_other():
    motor_values = {"contact_radius": [26e-3, 27e-3], "rotor_inertia": [4e-6, 5e-6, 6e-6]}
    with refusal("rotor_inertia: got shape (3,)", "broadcasts", "(2,)"):
        ts.evaluate(MOTOR.with_values(motor_values))


# --- Python: the motor ---------------------------------------------------------------------------


@pytest.mark.parametrize("value", NO_NUMBERS)
def test_motor_refuses_what_is_no_number(value):
    with refusal("contact_radius: got", "in m"):
        MOTOR.with_values({"contact_radius": value})


@pytest.mark.parametrize(
    ("values", "naming"),
    [
        ({"nonsense": 1.0}, ("got nonsense", "a name of the motor file")),
        ({"": 1.0}, ("a name of the motor file",)),
        ({"two\nlines": 1.0}, ("got two lines", "a name of the motor file")),
        ({"contact_radius": math.nan}, ("contact_radius: got nan", "> 0 in m")),
        ({"contact_radius": [26e-3, 0.0]}, ("contact_radius: got 0", "> 0 in m")),
        ({"contact_radius": "26 kg"}, ("contact_radius: got 26 kg", "in m")),
        ({"damping_ratio": 1.0}, ("damping_ratio: got 1", "< 1")),
        ({"damping_ratio": [0.0, 1.0]}, ("damping_ratio: got 1", "< 1")),
        ({"tooth_height": 4.5e-3}, ("tooth_height: got 0.0045", "less than beam_thickness")),
        ({"tooth_height": [2e-3, 5e-3]}, ("tooth_height", "less than beam_thickness")),
        ({"tooth_height": 4.4e-3, "beam_thickness": np.linspace(4e-3, 5e-3, 50)}, ("tooth_height: got 0.0044",)),
        ({"slot_width": np.linspace(1e-3, 3e-3, 50)}, ("slot_width", "perimeter")),
        ({"fit_prepressure_min": 220.0}, ("fit_prepressure_min: got 220", "less than fit_prepressure_max")),
        ({"tooth_height": [2e-3] * 2, "beam_thickness": [4e-3] * 3}, ("shape (", "broadcast")),
        ({"tooth_count": [70, 72], "slot_width": [8e-4] * 3}, ("shape (", "broadcast")),
    ],
    ids=[
        "unknown", "empty-name", "two-line-name", "nan", "zero-in-list", "wrong-unit", "critical-damping",
        "critical-damping-in-list", "tall-teeth", "tall-teeth-in-list", "many-thin-beams", "many-wide-slots",
        "reversed-fit", "tooth-and-beam-shapes", "count-and-slot-shapes",
    ],
)  # fmt: skip
def test_motor_refuses_bad_values(values, naming):
    with refusal(*naming):
        MOTOR.with_values(values)


@pytest.mark.parametrize("value", [math.nan, -0.1, 1.0])
def test_motor_refuses_a_bad_parameter_set_on_the_dataclass(value):
    bad = replace(MOTOR.damping_ratio, value=value)
    with refusal("damping_ratio", str(value)):
        ts.evaluate(replace(MOTOR, damping_ratio=bad))


# --- Motor files ---------------------------------------------------------------------------------


@pytest.fixture
def motor_file(tmp_path):
    def write(content):
        path = tmp_path / "motor.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def voltage(**changes):
    entry = {"value": "200.0", "unit": '"V"', "source": '"Table 1"', **changes}
    items = ", ".join(f"{key} = {value}" for key, value in entry.items() if value is not None)
    return MOTOR_TEXT.replace(VOLTAGE_LINE, f"voltage = {{ {items} }}")


def described(changes):
    return ", ".join(f"{key} = {value}" for key, value in changes.items())[:40]


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
    ({"unit": '"volt"'}, ("voltage.unit: got volt", "converts to V", "unknown unit")),
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
    ({"colour": '"red"'}, ("voltage.colour: got red", "value, unit, symbol, source, range, reason, note")),
    ({'"two\\nlines"': "1"}, ("voltage", "got 1", "value, unit, symbol, source, range, reason, note")),
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
        pytest.param("colour = 1\n" + MOTOR_TEXT, ("colour", "name, parameters and published"), id="unknown-key"),
        pytest.param("[motor]\n" + MOTOR_TEXT, ("motor", "name, parameters and published"), id="name-in-a-table"),
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


def published(**changes):
    entry = {"output": '"amplitude"', "value": "5.5e-6", "unit": '"m"', "source": '"Table 2"', "drive": "{}", **changes}
    return f"{MOTOR_TEXT}\n[[published]]\n" + "\n".join(f"{k} = {v}" for k, v in entry.items() if v is not None)


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


# --- Any input at all ----------------------------------------------------------------------------


def assert_no_nan(point):
    for name in POINT_NUMBERS:
        value = getattr(point, name)
        assert math.isfinite(value) or (name in ("q_ratio", "q_square_ratio") and value == math.inf), name


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
    warnings = [line for line in err.getvalue().splitlines() if line.startswith("trum-sym: warning: prepressure")]
    refusals = [line for line in err.getvalue().splitlines() if line not in warnings]
    assert code in (0, 2)
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


@pytest.mark.parametrize("name", NUMERIC_FIELDS)
@SEARCH
@given(value=ANY_FLOAT, start=st.sampled_from(CHOICES["start"]))
def test_any_number_in_a_drive_evaluates_or_is_refused(name, value, start):
    evaluate_or_refuse(lambda: ts.evaluate(MOTOR, ts.Drive(**{name: value}, start=start)))


@WIDE_SEARCH
@given(name=st.sampled_from(PARAMETER_NAMES), value=ANY_FLOAT, amplitude=st.sampled_from(CHOICES["amplitude"]))
@example(name="resonance_frequency", value=1e300, amplitude="measured")
@example(name="wavenumber", value=5e-324, amplitude="forced")
def test_any_number_for_a_motor_parameter_evaluates_or_is_refused(name, value, amplitude):
    with suppress(ts.ConvergenceError):
        evaluate_or_refuse(lambda: ts.evaluate(MOTOR.with_values({name: value}), amplitude=amplitude))


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
