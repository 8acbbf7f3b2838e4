"""Bad input at the console: one clear line, exit code 2, no traceback."""

from __future__ import annotations

import subprocess

import pytest
from refusals import CHOICES, OPTIONS, run_console

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")


# --- Console: numbers ----------------------------------------------------------------------------

# option: (what is allowed, a unit of another dimension)


def parameter(option):
    return f"{option}: "


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e400"])
@pytest.mark.parametrize("option", OPTIONS)
def test_console_refuses_what_is_not_finite(console_refuses, option, value):
    allowed = "an integer" if "periods" in option else OPTIONS[option][0]
    console_refuses("evaluate", option, value, naming=(parameter(option), f"got {value}", allowed))


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
    ("--prepressure", "1 MN", ("got 1 MN", "< 1e+06", "in N")),
    ("--periods", "0", ("got 0", "an integer >= 1")),
    ("--periods", "-20", ("got -20", "an integer >= 1")),
    ("--periods", "20.5", ("got 20.5", "an integer")),
    ("--periods", "1000001", ("got 1000001", "<= 1e+06")),
    ("--on-periods", "0", ("got 0", "an integer >= 1")),
    ("--on-periods", "-14", ("got -14", "an integer >= 1")),
    ("--on-periods", "13.5", ("got 13.5", "an integer")),
    ("--on-periods", "9", ("got 9", "from periods/2 to periods", "periods = 20")),
    ("--on-periods", "21", ("got 21", "from periods/2 to periods", "periods = 20")),
    ("--switching-phase", "1e7", ("got 1e7", "< 1e+06", "in rad")),
    ("--sampling-period", "0", ("got 0", "> 0", "in s")),
    ("--sampling-period", "-0.01", ("got -0.01", "> 0", "in s")),
    ("--sampling-period", "-10 ms", ("got -10 ms", "> 0", "in s")),
    ("--frequency-difference", "-40 kHz", ("got -40 kHz", "-0.9 times the resonance", "Hz")),
    ("--frequency-difference", "1e300", ("got 1e300", "Hz")),
    ("--frequency-difference", "1e308", ("got 1e308", "Hz")),
    ("--frequency-difference", "-1e308", ("got -1e308", "Hz")),
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
    console_refuses("evaluate", "--periods", value, naming=("--periods: ", f"got {value}"))


def test_console_shortens_a_long_unit(console_refuses):
    long = "180 " + "x" * 1000
    line = console_refuses("evaluate", "--prepressure", long, naming=("--prepressure:", "got 180 xxx", "in N"))
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
    ("contact_radius=nan", ("contact_radius", "got nan", "> 0 and < 10 in m")),
    ("contact_radius=inf", ("contact_radius", "got inf", "> 0 and < 10 in m")),
    ("contact_radius=-inf", ("contact_radius", "got -inf", "> 0 and < 10 in m")),
    ("contact_radius=0", ("contact_radius", "got 0", "> 0 and < 10 in m")),
    ("contact_radius=-26 mm", ("contact_radius", "got -26 mm", "> 0 and < 10 in m")),
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
    ("resonance_frequency=0", ("resonance_frequency", "got 0", "> 0 and < 1e+09 in Hz")),
    ("resonance_frequency=1e308", ("resonance_frequency",)),
    ("resonance_frequency=40 mm", ("resonance_frequency", "got 40 mm", "in Hz")),
    ("tooth_height=5 mm", ("tooth_height", "got 5 mm", "less than beam_thickness (0.0045 m)")),
    ("tooth_height=4.5 mm", ("tooth_height", "got 4.5 mm", "less than beam_thickness (0.0045 m)")),
    ("slot_width=3 mm", ("slot_width", "got 3 mm", "perimeter")),
    ("tooth_count=500", ("slot_width", "tooth_count", "perimeter")),
    ("fit_prepressure_min=300", ("fit_prepressure_min", "got 300", "less than fit_prepressure_max (220")),
    ("fit_prepressure_max=50", ("fit_prepressure_min", "got 100", "less than fit_prepressure_max (50")),
]


@pytest.mark.parametrize(("override", "naming"), BAD_SETS, ids=[override or "empty" for override, _ in BAD_SETS])
def test_console_refuses_a_bad_set(console_refuses, override, naming):
    console_refuses("evaluate", "--set", override, naming=naming)


@pytest.mark.parametrize("override", ["crests=1e300", "piezo_density=1e300", "beam_young_modulus=1e300"])
def test_console_blames_the_motor_where_its_values_give_no_resonance(console_refuses, override):
    line = console_refuses("evaluate", "--set", override, naming=("resonance_frequency",))
    assert "frequency_difference" not in line


def test_console_blames_the_part_that_a_radius_of_nothing_does_not_fit(console_refuses):
    console_refuses("evaluate", "--set", "radius=1e-300", naming=("flange_length: got 0.003", "radius (1e-300 m)"))


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
    console_refuses("evaluate", "--motor", "trum61", naming=("--motor: got trum61", "trum60 or the path"))


def test_console_refuses_a_directory_as_motor(console_refuses, tmp_path):
    console_refuses("evaluate", "--motor", str(tmp_path), naming=("motor", "a readable TOML file", "directory"))


def test_console_refuses_a_file_that_is_not_toml(console_refuses, motor_file):
    path = motor_file("radius = = 30")
    console_refuses("evaluate", "--motor", str(path), naming=("motor", "a valid TOML file", "line 1"))


@pytest.mark.parametrize("name", ["", "no\0path", "x" * 5000], ids=["empty", "with-nul", "too-long"])
def test_console_refuses_what_is_no_path(console_refuses, name):
    console_refuses("evaluate", "--motor", name, naming=("motor: got", "TOML file"))


# --- Console: words, options, commands -----------------------------------------------------------


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
    console_refuses("evaluate", "--json", "--prepressure", "-1", naming=("--prepressure", "got -1", "> 0"))


@pytest.mark.parametrize(
    ("arguments", "naming"),
    [
        (("evaluate", "--prepressure", "180 Hz"), (b"--prepressure: got 180 Hz, need a number in N",)),
        (("evaluate", "--motor", b"\xff.toml"), (b"--motor: got", b"trum60 or the path of a TOML file")),
        (("evaluate", "--on-periods", "9"), (b"--on-periods: got 9", b"periods/2")),
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
