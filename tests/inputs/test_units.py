from __future__ import annotations

import math

import pytest

from trum_sym.errors import ParameterError
from trum_sym.inputs.units import parse_quantity, parse_unit


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("3000", "Hz", 3000.0),
        ("3 kHz", "Hz", 3000.0),
        ("26.5 mm", "m", 0.0265),
        ("1.2mm", "m", 0.0012),
        ("-97 pC/N", "C/N", -97e-12),
        ("155 GPa", "Pa", 155e9),
        ("45 g cm^2", "kg*m^2", 4.5e-6),
        ("8.9 g/cm^3", "kg/m^3", 8900.0),
        ("300 mN*m", "N*m", 0.3),
        ("633 arcsec/s", "rad/s", 633 * math.pi / 648000),
        ("17.3 %", "1", 0.173),
        ("5.5 µm", "m", 5.5e-6),
        ("1e3 /m", "1/m", None),
        (".5e1 1/mm", "1/m", 5000.0),
        ("90 deg", "rad", math.pi / 2),
    ],
)
def test_numbers_with_units_convert(text, unit, expected):
    if expected is None:
        with pytest.raises(ParameterError):
            parse_quantity("x", text, unit)
    else:
        assert parse_quantity("x", text, unit) == pytest.approx(expected, rel=1e-15)


def test_decimal_prefixes_convert_to_the_last_bit():
    assert parse_unit("mm").to_si(1.2) == 0.0012
    assert parse_unit("GPa").to_si(76.5) == 76.5e9


@pytest.mark.parametrize("text", ["180 Hz", "180 foo", "3 N/m", "abc", "", "3 4", "1 m^^2"])
def test_wrong_units_are_refused_by_name(text):
    with pytest.raises(ParameterError, match=r"prepressure: got .* need a number in N"):
        parse_quantity("prepressure", text, "N")


def test_newton_metre_is_joule_in_base_units():
    assert parse_unit("N*m").dimension == parse_unit("kg m^2/s^2").dimension
