"""Bad input in Python: a ParameterError of one clear line."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import CHOICES, MOTOR, NO_NUMBERS, NUMERIC_FIELDS, refusal

import trum_sym as ts

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")


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
@pytest.mark.parametrize(
    "name", ["contact", "resonance", "foundation", "amplitude", "compliance", "tangential", "coupling"]
)
def test_evaluation_refuses_a_wrong_word(name, word):
    with refusal(f"{name}: got", *CHOICES[name]):
        ts.evaluate(MOTOR, **{name: word})


@pytest.mark.parametrize("period", [0, -1e-3, math.nan, math.inf, 1j, True, [], [1e-3, 0.0]], ids=repr)
def test_evaluation_refuses_a_wrong_sampling_period(period):
    with refusal("sampling_period: got", "> 0 in s"):
        ts.evaluate(MOTOR, sampling_period=period)


def test_evaluation_refuses_a_sampling_period_in_hertz():
    with refusal("sampling_period: got 10 Hz", "a number in s"):
        ts.evaluate(MOTOR, sampling_period="10 Hz")


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
        ({"contact_radius": math.nan}, ("contact_radius: got nan", "> 0 and < 10 in m")),
        ({"contact_radius": [26e-3, 0.0]}, ("contact_radius: got 0", "> 0 and < 10 in m")),
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
        "unknown",
        "empty-name",
        "two-line-name",
        "nan",
        "zero-in-list",
        "wrong-unit",
        "critical-damping",
        "critical-damping-in-list",
        "tall-teeth",
        "tall-teeth-in-list",
        "many-thin-beams",
        "many-wide-slots",
        "reversed-fit",
        "tooth-and-beam-shapes",
        "count-and-slot-shapes",
    ],
)
def test_motor_refuses_bad_values(values, naming):
    with refusal(*naming):
        MOTOR.with_values(values)


@pytest.mark.parametrize("value", [math.nan, -0.1, 1.0])
def test_motor_refuses_a_bad_parameter_set_on_the_dataclass(value):
    bad = replace(MOTOR.damping_ratio, value=value)
    with refusal("damping_ratio", str(value)):
        ts.evaluate(replace(MOTOR, damping_ratio=bad))
