"""What a parameter's distribution means, in the motor file and as text, and which are refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy
from refusals import MOTOR, MOTOR_TEXT, refusal, voltage

import trum_sym as ts
from trum_sym.inputs.distributions import Distribution, checked, from_text
from trum_sym.inputs.motor import SPECS

LEVELS = (np.arange(200_000) + 0.5) / 200_000


def drawn(distribution, name="friction_coefficient"):
    return checked(name, distribution, SPECS[name]).quantile(LEVELS)


@pytest.mark.parametrize(
    ("distribution", "mean", "deviation"),
    [
        # moments of each by hand
        (Distribution("uniform", 0.2, 0.3), 0.25, 0.1 / math.sqrt(12)),
        (Distribution("triangular", 0.2, 0.5, mode=0.2), 0.3, 0.3 / math.sqrt(18)),
        (Distribution("normal", mean=0.25, standard_deviation=0.02), 0.25, 0.02),
        (Distribution("lognormal", mean=0.25, standard_deviation=0.1), 0.25, 0.1),
        # half a normal: mean sigma sqrt(2/pi), variance sigma^2 (1 - 2/pi)
        (
            Distribution("normal", low=0.25, mean=0.25, standard_deviation=0.02),
            0.25 + 0.02 * math.sqrt(2 / math.pi),
            0.02 * math.sqrt(1 - 2 / math.pi),
        ),
    ],
    ids=["uniform", "triangular", "normal", "lognormal", "half-normal"],
)
def test_moments_are_those_that_were_asked_for(distribution, mean, deviation):
    values = drawn(distribution)
    assert values.mean() == pytest.approx(mean, rel=1e-4)
    assert values.std() == pytest.approx(deviation, rel=2e-3)


def test_a_cut_lognormal_has_the_cut_density():
    values = drawn(Distribution("lognormal", 0.2, 0.4, mean=0.25, standard_deviation=0.1))
    spread = math.log1p(0.4**2)
    density = scipy.stats.lognorm(math.sqrt(spread), scale=0.25 * math.exp(-spread / 2)).pdf
    whole = scipy.integrate.quad(density, 0.2, 0.4)[0]
    assert values.mean() == pytest.approx(scipy.integrate.quad(lambda x: x * density(x), 0.2, 0.4)[0] / whole, rel=1e-6)
    assert 0.2 < values.min() < values.max() < 0.4


def test_a_normal_distribution_is_cut_at_the_parameters_domain():
    values = drawn(Distribution("normal", mean=0.01, standard_deviation=0.1))
    assert values.min() >= 0
    assert np.median(values) == pytest.approx(scipy.stats.truncnorm(-0.1, np.inf, 0.01, 0.1).median(), rel=1e-3)


def test_every_level_gives_a_finite_value():
    ends = np.array([0.0, 2.0**-64, 1 - 2.0**-53, 1.0])
    for distribution in (
        Distribution("normal", mean=0.25, standard_deviation=0.02),
        Distribution("lognormal", mean=0.25, standard_deviation=0.02),
    ):
        assert np.isfinite(
            checked("friction_coefficient", distribution, SPECS["friction_coefficient"]).quantile(ends)
        ).all()


# --- The motor file ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "meant"),
    [
        ({}, None),
        ({"range": "[190, 210]"}, Distribution("uniform", 190, 210)),
        ({"range": "[190, 210]", "distribution": '"uniform"'}, Distribution("uniform", 190, 210)),
        ({"range": "[190, 205]", "distribution": '"triangular"'}, Distribution("triangular", 190, 205, mode=200)),
        (
            {"distribution": '"normal"', "standard_deviation": "5"},
            Distribution("normal", mean=200, standard_deviation=5),
        ),
        (
            {"distribution": '"normal"', "mean": "198", "standard_deviation": "5", "range": "[190, 210]"},
            Distribution("normal", 190, 210, 198, 5),
        ),
        ({"distribution": '"normal"', "range": "[190, 210]"}, Distribution("normal", 190, 210, 200, 5)),
        (
            {"distribution": '"lognormal"', "unit": '"mV"', "standard_deviation": "5", "value": "200"},
            Distribution("lognormal", mean=0.2, standard_deviation=0.005),
        ),
    ],
    ids=["none", "range", "uniform", "triangular", "normal", "cut", "normal-of-range", "unit"],
)
def test_the_motor_file_says_how_a_value_spreads(motor_file, changes, meant):
    motor = ts.load_motor(motor_file(voltage(**changes)))
    assert motor.voltage.spread() == meant


def test_assumed_ranges_are_uniform_and_a_value_that_is_set_is_certain():
    assert MOTOR.friction_coefficient.spread() == Distribution("uniform", 0.2, 0.3)
    assert MOTOR.with_values({"friction_coefficient": 0.2}).friction_coefficient.spread() is None


BAD_ENTRIES = [
    (
        {"distribution": '"flat"', "range": "[190, 210]"},
        ("voltage: got flat", "uniform, triangular, normal, lognormal"),
    ),
    ({"distribution": "1"}, ("voltage.distribution: got 1", "text")),
    ({"distribution": '"uniform"'}, ("voltage.distribution: got uniform", "a range")),
    ({"distribution": '"normal"'}, ("voltage.distribution: got normal", "standard_deviation")),
    ({"distribution": '"uniform"', "range": "[190, 210]", "mean": "200"}, ("voltage.mean", "a range only")),
    ({"mean": "200"}, ("voltage.mean: got no distribution", "beside it")),
    ({"standard_deviation": "2"}, ("voltage.standard_deviation: got no distribution",)),
    ({"distribution": '"normal"', "standard_deviation": "-2"}, ("standard_deviation = -2", "> 0, in V")),
    ({"distribution": '"normal"', "standard_deviation": "0"}, ("standard_deviation = 0", "> 0, in V")),
    ({"distribution": '"normal"', "standard_deviation": "nan"}, ("standard_deviation = nan", "> 0, in V")),
    ({"distribution": '"normal"', "standard_deviation": '"2 V"'}, ("voltage.standard_deviation: got 2 V", "in V")),
    ({"distribution": '"normal"', "standard_deviation": "1e-20"}, ("standard_deviation = 1e-20", "size of its values")),
    ({"distribution": '"lognormal"', "standard_deviation": "1e300"}, ("standard_deviation = 1e+300", "size of its")),
    ({"distribution": '"normal"', "mean": "-1", "standard_deviation": "2"}, ("voltage: got mean = -1", "> 0 in V")),
    (
        {"distribution": '"normal"', "mean": "220", "standard_deviation": "2", "range": "[190, 210]"},
        ("voltage: got mean = 220", "190 to 210"),
    ),
    ({"distribution": '"uniform"', "range": "[0, 210]"}, ("voltage: got uniform with low = 0", "> 0 in V")),
    ({"distribution": '"uniform"', "range": "[200, 200]"}, ("uniform from 200 to 200", "low < high, in V")),
]


@pytest.mark.parametrize(("changes", "naming"), BAD_ENTRIES, ids=[str(changes) for changes, _ in BAD_ENTRIES])
def test_the_motor_file_refuses_a_bad_distribution(motor_file, changes, naming):
    with refusal(*naming):
        ts.load_motor(motor_file(voltage(**changes)))


def test_a_number_of_teeth_does_not_vary_continuously(motor_file):
    text = MOTOR_TEXT.replace(
        'value = 72, unit = "1"', 'value = 72, unit = "1", range = [70, 74], distribution = "uniform"'
    )
    assert text != MOTOR_TEXT
    with refusal("tooth_count: got uniform", "whole number"):
        ts.load_motor(motor_file(text))


# --- Text ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("uniform:0.025:27 mm", Distribution("uniform", 0.025, 0.027)),
        ("triangular:25 mm:26mm:0.03", Distribution("triangular", 0.025, 0.03, mode=0.026)),
        ("normal : 26 mm : 100 um", Distribution("normal", mean=0.026, standard_deviation=1e-4)),
        ("lognormal:26 mm:1 mm:25 mm:30 mm", Distribution("lognormal", 0.025, 0.03, 0.026, 1e-3)),
    ],
)
def test_text_says_what_a_file_says(text, meant):
    assert from_text("contact_radius", text, "m") == meant


@pytest.mark.parametrize(
    ("text", "naming"),
    [
        ("flat:1:2", ("contact_radius: got flat", "uniform, triangular, normal, lognormal")),
        ("", ("contact_radius: got empty text", "a distribution")),
        ("25 mm", ("contact_radius: got 25 mm", "a distribution")),
        ("uniform", ("contact_radius: got uniform", "uniform:LOW:HIGH")),
        ("uniform:1", ("got uniform:1", "uniform:LOW:HIGH")),
        ("uniform:1:2:3", ("got uniform:1:2:3", "uniform:LOW:HIGH")),
        ("normal:1:2:3", ("got normal:1:2:3", "normal:MEAN:STANDARD_DEVIATION[:LOW:HIGH]")),
        ("uniform:25 mm:27 kg", ("contact_radius, high: got 27 kg", "in m")),
        ("uniform:25 mm:", ("contact_radius, high: got empty text", "in m")),
        ("normal:26 mm:much", ("contact_radius, standard_deviation: got much", "in m")),
    ],
)
def test_unreadable_text_is_refused(text, naming):
    with refusal(*naming):
        from_text("contact_radius", text, "m")


@pytest.mark.parametrize(
    ("distribution", "naming"),
    [
        (Distribution("uniform", -0.1, 0.3), ("friction_coefficient: got uniform with low = -0.1", ">= 0")),
        (Distribution("uniform", 0.3, 0.2), ("uniform from 0.3 to 0.2", "low < high")),
        (Distribution("uniform", 0.3), ("uniform from 0.3 to inf", "finite low and high")),
        (Distribution("uniform", math.nan, 0.3), ("low = nan", "a number")),
        (Distribution("triangular", 0.2, 0.3, mode=0.1), ("mode = 0.1", "low <= mode <= high")),
        (Distribution("triangular", 0.2, 0.3), ("mode = None", "low <= mode <= high")),
        (Distribution("normal", mean=0.2), ("standard_deviation = None", "> 0")),
        (Distribution("normal", standard_deviation=0.1), ("mean = None", ">= 0")),
        (Distribution("normal", mean=0.2, standard_deviation=-0.1), ("standard_deviation = -0.1", "> 0")),
        (Distribution("normal", 0.2, 0.3, 0.25, 1e9), ("standard_deviation = 1e+09", "size of its values")),
        (Distribution("lognormal", mean=0.0, standard_deviation=0.1), ("lognormal with mean = 0", "> 0")),
        (Distribution("cauchy"), ("friction_coefficient: got cauchy", "uniform")),
    ],
    ids=lambda x: x.describe() if isinstance(x, Distribution) and x.kind == "uniform" else None,
)
def test_impossible_distributions_are_refused(distribution, naming):
    with refusal(*naming):
        checked("friction_coefficient", distribution, SPECS["friction_coefficient"])
