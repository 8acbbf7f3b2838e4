from __future__ import annotations

import math

import pytest
from refusals import MOTOR_TEXT, refusal

import trum_sym as ts
from trum_sym.errors import ParameterError
from trum_sym.inputs.measurements import read_measurements
from trum_sym.inputs.units import parse_quantity, parse_unit, unit_for


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
        ("22.7 mS", "A/V", 0.0227),
        ("24 nF", "C/V", 24e-9),
        ("15 mH", "V s/A", 15e-3),
        ("44 Ω", "V/A", 44.0),
        ("2 kohm", "1/S", 2000.0),
        ("8.85 nF/m", "F/m", 8.85e-9),
        ("3 mW", "N*m/s", 3e-3),
        ("3 mm/S", "m/s", None),
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


# --- Spellings: by instruments, CF conventions, datasheets of several countries, units libraries ---------------------

SPELLINGS = {
    "1/s": ("s-1", "s^-1", "s**-1", "s⁻¹", "1 / s", "1 / second", "Hz", "hertz", "Hertz", "1/sec"),
    "kg/m^3": (
        *("kg m-3", "kg m^-3", "kg·m⁻³", "kg.m-3", "kg*m**-3", "kg/m3", "kg/m³", "kg / m ** 3", "kg/(m m^2)"),
        *("kilogram / meter ** 3", "kilograms/metre^3"),
    ),
    "N*m": (
        "Nm",
        "N.m",
        "N m",
        "N·m",
        "N⋅m",
        "N-m",
        "m N",
        "newton * meter",
        "Newton meters",
        "kg m2 s-2",
        "1/(N-1 m-1)",
    ),
    "m^2": ("m²", "m2", "m**2", "m^2", "m*m", "meter ** 2"),
    "rad/s": ("rad s-1", "rad/sec", "radian / second", "rad·s⁻¹", "radians/s"),
    "kg*m^2": ("kg m2", "kgm2", "kgm²", "kg·m²", "kg m**2"),
    "C/N": ("C N-1", "m/V", "coulomb / newton"),
}
SCALED = [  # by hand, in SI
    ("mNm", "N*m", 1e-3),
    ("Ncm", "N*m", 1e-2),
    ("N·cm", "N*m", 1e-2),
    ("N-mm", "N*m", 1e-3),
    ("kgf cm", "N*m", 0.0980665),
    ("kgfcm", "N*m", 0.0980665),
    ("gf-cm", "N*m", 9.80665e-5),
    ("daN", "N", 10.0),
    ("gcm²", "kg*m^2", 1e-7),
    ("g cm2", "kg*m^2", 1e-7),
    ("pm/V", "C/N", 1e-12),
    ("μm", "m", 1e-6),
    ("micrometer", "m", 1e-6),
    ("kilohertz", "Hz", 1e3),
    ("1/min", "Hz", 1 / 60),
    ("min⁻¹", "Hz", 1 / 60),
    ("rev/min", "rad/s", math.pi / 30),
    ("r/min", "rad/s", math.pi / 30),
    ("rpm", "rad/s", math.pi / 30),
    ("revolutions_per_minute", "rad/s", math.pi / 30),
    ("°/s", "rad/s", math.pi / 180),
    ("degree / second", "rad/s", math.pi / 180),
    ("arcmin/s", "rad/s", math.pi / 10800),
    ("″/s", "rad/s", math.pi / 648000),
    ("mas / s", "rad/s", math.pi / 648e6),
    ("mrad/ms", "rad/s", 1.0),
    ("rad/m", "1/m", 1.0),
    ("percent", "1", 0.01),
    ("dimensionless", "1", 1.0),
]


@pytest.mark.parametrize(("unit", "text"), [(unit, text) for unit, texts in SPELLINGS.items() for text in texts])
def test_usual_spellings_are_one_unit(unit, text):
    assert parse_unit(text).kind == parse_unit(unit).kind
    assert float(parse_unit(text).factor) == 1.0


@pytest.mark.parametrize(("text", "unit", "factor"), SCALED)
def test_usual_spellings_convert(text, unit, factor):
    assert unit_for(text, unit).to_si(1.0) == pytest.approx(factor, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "close"),
    [
        ("khz", "kHz"),
        ("mpa", "MPa, mPa"),
        ("mm/ss", "s"),
        ("Newtn", "newton"),
        ("NM", "Nm"),
        ("gm", "Gm"),
        ("kgs", "kg"),
    ],
)
def test_an_unknown_unit_names_its_nearest(text, close):
    with pytest.raises(ValueError, match=f"unknown unit .*close ones: .*{close}"):
        parse_unit(text)


@pytest.mark.parametrize("text", ["N/m*s", "1/s m", "kg/m3 s-1", "Nm2", "Nm^-1", "N/m.s", "m2s", "r2r2"])
def test_what_people_read_in_two_ways_is_refused(text):
    with pytest.raises(ValueError, match=r"two ways|unknown unit"):
        parse_unit(text)


@pytest.mark.parametrize(
    "text", ["((((Gm)99)99)99)99", "r22 " * 24, "mas22 " * 16, "(" * 50 + "m" + ")" * 50, "m" * 101, "Gm^9", "m " * 60]
)
def test_a_unit_has_limits(text):
    with pytest.raises(ValueError, match="unit"):
        parse_unit(text)


# --- Cycles and angles -----------------------------------------------------------------------------------------------

ANGULAR = ("rad/s", "deg/s", "arcsec/s", "rpm", "rad s-1", "rev/min", "°/s", "mrad/s", "krad/s", "arcmin/s", "mas/s")
CYCLIC = ("Hz", "1/s", "1/min", "kHz", "s-1", "min^-1", "mHz")


@pytest.mark.parametrize("unit", ANGULAR)
def test_a_frequency_refuses_an_angle_per_time(unit):
    with pytest.raises(ParameterError, match=rf"frequency: got 2 {unit.replace('^', '.')}, .*2\*pi.* Hz"):
        parse_quantity("frequency", f"2 {unit}", "Hz")
    assert math.isfinite(parse_quantity("speed", f"2 {unit}", "rad/s"))


@pytest.mark.parametrize("unit", CYCLIC)
def test_a_speed_refuses_cycles_per_time(unit):
    with pytest.raises(ParameterError, match=r"speed: got 2 .*2\*pi.* rad/s"):
        parse_quantity("speed", f"2 {unit}", "rad/s")
    assert math.isfinite(parse_quantity("frequency", f"2 {unit}", "Hz"))


def test_the_refusal_says_what_is_meant_if_it_was_meant():
    with refusal("18849.5559 rad/s", "3000 Hz are meant"):
        parse_quantity("frequency_difference", "18849.5559 rad/s", "Hz")
    with refusal("180000 rpm", "3000 Hz are meant"):
        parse_quantity("frequency_difference", "180000 rpm", "Hz")
    with refusal("0.5 Hz", "3.14159 rad/s are meant"):
        parse_quantity("target_speed", "0.5 Hz", "rad/s")


@pytest.mark.parametrize(
    ("text", "unit"), [("5 %", "rad"), ("1 1", "rad"), ("3 rad", "1"), ("3 deg", "1"), ("30 °", "1")]
)
def test_an_angle_is_no_pure_number(text, unit):
    with refusal(f"got {text}", "angle"):
        parse_quantity("x", text, unit)


# wherever a unit enters: arguments, or a file's content
CONSOLE = [
    ("evaluate", "--frequency-difference", "18849.5559 rad/s"),
    ("evaluate", "--frequency-difference", "180000 rpm"),
    ("evaluate", "--switching-phase", "5 %"),
    ("evaluate", "--set", "resonance_frequency=245 krad/s"),
    ("evaluate", "--set", "friction_coefficient=0.25 rad"),
    ("optimize", "--target-speed", "0.5 Hz"),
    ("optimize", "--objective", "wear", "--frequency-difference", "17600 rad/s:20700 rad/s"),
    ("optimize", "--constraint", "mean_speed >= 0.5 Hz"),
    ("optimize", "--constraint", "max_speed - min_speed <= 5 1/s"),
    ("optimize", "--objective", "mean_speed + frequency_difference"),
    ("pareto", "--target-speed", "0.5 1/s"),
    ("robust", "--objective", "wear", "--spread", "friction_coefficient=10 deg"),
    ("speed-table", "--from", "0.1 Hz", "--to", "1 rad/s"),
    ("speed-table", "--from", "0.1 rad/s", "--to", "1 kHz"),
    ("sweep", "--frequency-difference", "1 rad/s:2 rad/s:3", "--outputs", "amplitude", "--dry-run"),
    ("sweep", "--frequency-difference", "1 rpm,2 rpm", "--outputs", "amplitude", "--dry-run"),
    ("spread", "--spread", "frequency_difference=uniform:18000 rad/s:19000 rad/s"),
    ("spread", "--target", "mean_speed >= 0.5 Hz"),
    ("simulate", "--frequency-difference", "3 deg/s"),
]


@pytest.mark.parametrize("arguments", CONSOLE, ids=[" ".join(arguments[:3]) for arguments in CONSOLE])
def test_the_console_refuses_an_angle_for_cycles_everywhere(console_refuses, arguments):
    line = console_refuses(*arguments, naming=("got",))
    assert "2*pi" in line or "angle" in line or "rad s^-1 and s^-1 do not add" in line


@pytest.mark.parametrize(
    ("header", "naming"),
    [
        ("prepressure [N],resonance_frequency [rad/s]", ("resonance_frequency", "2*pi")),
        ("load_torque [Nm],mean_speed [Hz]", ("mean_speed", "2*pi")),
        ("load_torque [Nm],mean_speed [1/min]", ("mean_speed", "2*pi")),
        ("frequency_difference [rpm],amplitude [um]", ("frequency_difference", "2*pi")),
        ("load_torque [Nm],mean_speed [rad/s],mean_speed_uncertainty [Hz]", ("mean_speed_uncertainty", "2*pi")),
        ("prepressure [N],q_average [rad/s]", ("q_average", "2*pi")),
        ("prepressure [N],speed_volatility [deg]", ("speed_volatility", "angle")),
    ],
)
def test_a_data_file_refuses_an_angle_for_cycles(tmp_path, header, naming):
    path = tmp_path / "data.csv"
    path.write_text(f"{header}\n{','.join('1' for _ in header.split(','))}\n")
    with refusal(*naming):
        read_measurements(path)


def test_a_column_of_a_sweep_refuses_an_angle_for_cycles(tmp_path):
    path = tmp_path / "drives.csv"
    path.write_text("frequency_difference [rad/s]\n18849\n")
    with refusal("2*pi"):
        ts.sweep(ts.load_motor(), outputs=["amplitude"], frequency_difference=f"@{path}")


def test_a_motor_file_refuses_an_angle_for_cycles(motor_file):
    entry = '[parameters]\nresonance_frequency = { value = 245e3, unit = "rad/s", source = "measured" }'
    with refusal("resonance_frequency.unit: got rad/s", "2*pi"):
        ts.load_motor(motor_file(MOTOR_TEXT.replace("[parameters]", entry, 1)))
    with refusal("published.unit: got Hz", "2*pi"):
        ts.load_motor(motor_file(MOTOR_TEXT.replace('unit = "arcsec/s"', 'unit = "Hz"')))


def test_figures_of_one_kind_add_whatever_their_unit_is_called():
    from trum_sym.optimiser.expressions import parse_constraint, parse_expression

    assert parse_constraint("constraint", "max_speed - min_speed <= 5 rpm").high == pytest.approx(5 * math.pi / 30)
    assert parse_expression("objective", "q_average + drive_frequency").unit == "s^-1"
    assert parse_expression("objective", "sqrt(mean_speed**2) + speed_deviation").unit == "rad s^-1"
    assert parse_expression("objective", "mean_speed * cycle_time + switching_phase").unit == "rad"
