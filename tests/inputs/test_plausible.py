"""Motors that contradict themselves, and materials that do not exist: a warning says which and what may be meant."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from refusals import MOTOR_TEXT, run_console

import trum_sym as ts
from trum_sym import console
from trum_sym.inputs.plausible import doubts
from trum_sym.model.levels import Levels
from trum_sym.sweeps.plan import make_plan

MOTOR = ts.load_motor("trum60")


def warned(call):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(issubclass(w.category, ts.ImplausibleWarning) for w in caught)
    assert all(w.filename == __file__ for w in caught)  # at the line that called
    lines = [str(w.message) for w in caught]
    assert all(len(line.splitlines()) == 1 for line in lines)
    return lines


CASES = [
    # contradictions: 2 pi 60 mm is 377 mm, 2 pi 20 mm 125.7 mm, l_s is 188.4 mm
    ({"radius": "60 mm"}, ("radius: 60 mm contradicts perimeter 188.4 mm", "376.991 mm", "is 60 mm the diameter?")),
    ({"radius": "20 mm"}, ("radius: 20 mm contradicts perimeter 188.4 mm", "125.664 mm")),
    ({"perimeter": "377 mm"}, ("radius: 30 mm contradicts perimeter 377 mm",)),
    ({"contact_radius": "224 mm"}, ("contact_radius: 224 mm is more than the stator's outer radius, 30 mm",)),
    ({"contact_radius": "18 mm"}, ("contact_radius: 18 mm lies inside the ring, whose inner radius is 22 mm",)),
    ({"layer_width": "12 mm"}, ("layer_width: 12 mm is more than the beam's width, 8 mm",)),
    ({"piezo_width": "9 mm"}, ("piezo_width: 9 mm is more than the beam's width",)),
    ({"beam_width": "35 mm"}, ("beam_width: 35 mm is more than the stator's outer radius",)),
    ({"layer_thickness": "200 mm"}, ("layer_thickness: 200 mm is more than the beam's thickness",)),
    ({"piezo_thickness": "500 mm"}, ("piezo_thickness: 500 mm is more than the beam's thickness",)),
    ({"neutral_axis": "28.6 mm"}, ("neutral_axis: 28.6 mm is more than beam and piezoelectric ring",)),
    ({"wavenumber": "0.3 1/m"}, ("wavenumber: 0.3 1/m contradicts crests / radius, 300 1/m",)),
    ({"amplitude": "13 um"}, ("amplitude: 0.013 mm is more than the free amplitude",)),
    ({"beam_shear_modulus": "468 GPa"}, ("beam_shear_modulus: 468 GPa is far from 58.2707 GPa",)),
    ({"piezo_compliance": "90e-12 m^2/N"}, ("piezo_compliance: 9e-11 m^2/N is far from 1 / piezo_young_modulus",)),
    # materials: mPa for MPa, and units that were left out
    ({"beam_young_modulus": "155000 mPa"}, ("beam_young_modulus: 155 Pa is not that of a metal", "is 155 GPa meant?")),
    ({"beam_young_modulus": "155 MPa"}, ("beam_young_modulus: 1.55e+08 Pa is not that of a metal",)),
    ({"beam_young_modulus": 155e3}, ("is 155000 MPa meant?",)),
    ({"layer_young_modulus": 5.0}, ("layer_young_modulus: 5 Pa is not that of a friction layer", "is 5 GPa meant?")),
    ({"beam_density": 8.9}, ("beam_density: 8.9 kg/m^3 is not that of a metal", "is 8.9 g/cm^3 meant?")),
    ({"piezo_strain_constant": -97.0}, ("piezo_strain_constant: -97 C/N is not", "is -97 pC/N meant?")),
    ({"friction_coefficient": 3.0}, ("friction_coefficient: 3 is not that of a friction layer, 0 to 1.5",)),
    ({"damping_ratio": 0.6}, ("damping_ratio: 0.6 is not that of a resonator", "is 0.6 % meant?")),
    ({"free_amplitude": 9.9e-3}, ("free_amplitude: 0.0099 m is not that of a stator",)),
    ({"resonance_frequency": 39.7}, ("resonance_frequency: 39.7 Hz is not", "is 39.7 kHz meant?")),
    ({"layer_young_modulus": [5e9, 5.0]}, ("layer_young_modulus: 5 Pa",)),
    # stated ranges
    ({"friction_coefficient": 0.31}, ("friction_coefficient: 0.31 lies outside 0.2 to 0.3", "(assumed)")),
    ({"contact_radius": "24 mm"}, ("contact_radius: 0.024 m lies outside 0.025 to 0.03 m",)),
]


@pytest.mark.parametrize(("values", "naming"), CASES, ids=[str(values) for values, _ in CASES])
def test_what_no_motor_has_is_warned_of(values, naming):
    lines = warned(lambda: MOTOR.with_values(values))
    assert any(all(part in line for part in naming) for line in lines), lines


FINE = [
    {},
    {"radius": "30.2 mm"},
    {"friction_coefficient": 0.2},
    {"contact_radius": ["25 mm", "30 mm"][0]},
    {"contact_radius": np.linspace(25e-3, 30e-3, 5)},
    {"piezo_width": "6 mm"},
    {"beam_young_modulus": "210 GPa", "beam_shear_modulus": "81 GPa"},
    {"beam_young_modulus": "70 GPa", "beam_shear_modulus": "26 GPa", "beam_density": "2.7 g/cm^3"},
    {"layer_young_modulus": "1 MPa"},
    {"resonance_frequency": "39.7 kHz", "amplitude": "5.5 um", "neutral_axis": "2.9 mm", "wavenumber": "300 1/m"},
    {"rotor_inertia": "1 kg*m^2"},
]


@pytest.mark.parametrize("values", FINE, ids=str)
def test_what_motors_have_is_not(values):
    assert warned(lambda: MOTOR.with_values(values)) == []


def test_the_shipped_motor_gives_no_warning():
    assert warned(lambda: ts.evaluate(ts.load_motor("trum60"))) == []
    assert doubts(dict(MOTOR.parameters())) == []
    done = run_console("evaluate")
    assert (done.returncode, done.stderr) == (0, b"")


def test_a_motor_file_warns_once_where_it_is_read(motor_file):
    path = motor_file(MOTOR_TEXT.replace("value = 30.0, unit", "value = 60.0, unit", 1))
    (diameter, ring) = warned(lambda: ts.load_motor(path))
    assert "is 60 mm the diameter?" in diameter
    assert "contact_radius: 26.5 mm lies inside the ring" in ring
    motor = ts.load_motor(path) if warned(lambda: None) else None
    assert motor is None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ImplausibleWarning)
        motor = ts.load_motor(path)
    assert warned(lambda: ts.evaluate(motor)) == []


def test_the_console_says_each_doubt_in_one_line(motor_file, capsys):
    path = str(motor_file(MOTOR_TEXT.replace("value = 30.0, unit", "value = 60.0, unit", 1)))
    assert console.main(["evaluate", "--motor", path]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert [line.partition(": ")[2][:24] for line in lines] == ["warning: radius: 60 mm c", "warning: contact_radius:"]
    assert console.main(["evaluate", "--motor", path, "--set", "radius=30 mm"]) == 0
    assert capsys.readouterr().err == ""


def test_searches_and_samples_do_not_warn_of_where_they_go():
    outputs = {"samples": 64, "outputs": ["stall_torque"]}
    assert warned(lambda: ts.spread(MOTOR, spreads={"friction_coefficient": "uniform:0.1:2"}, **outputs)) == []
    swept = {"friction_coefficient": [0.1, 3.0]}
    assert warned(lambda: make_plan(MOTOR, None, Levels(), None, 1e-3, ["amplitude"], None, swept)) == []


def test_calibrate_says_when_a_fitted_value_leaves_its_body():
    force = np.linspace(120.0, 210.0, 5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ImplausibleWarning)
        wide = MOTOR.with_values({"layer_width": "12 mm"})
    for machine, beyond in ((MOTOR, 0), (wide, 1)):
        measured = ts.evaluate(machine, ts.Drive(prepressure=force)).resonance_frequency
        data = {"prepressure": force, "resonance_frequency": measured}
        found = []
        lines = warned(lambda data=data, found=found: found.append(ts.calibrate(data, parameters=["layer_width"])))
        assert found[0].status == "solved"
        assert found[0]["layer_width"].value == pytest.approx(machine.layer_width.value, rel=1e-6)
        assert len(lines) == beyond
        assert all(line.startswith("fitted layer_width: 12 mm is more than the beam's width, 8 mm; ") for line in lines)


@pytest.mark.slow
def test_speeds_in_turns_taken_for_radians_give_a_ring_beyond_the_stator_and_that_is_said():
    load = np.array([0.0, 0.02, 0.04, 0.06, 0.08, 0.1])
    speed = ts.evaluate(MOTOR, ts.Drive(load_torque=load)).mean_speed / (2 * np.pi)
    found = []
    lines = warned(lambda: found.append(ts.calibrate({"load_torque": load, "mean_speed": speed}, MOTOR)))
    assert found[0]["contact_radius"].value > 0.03
    assert any("fitted contact_radius" in line and "outer radius" in line for line in lines), lines


def test_a_bound_met_but_for_its_rounding_is_met():
    """As a value converted from another unit may be, or a corner of a contour at a map's edge."""
    force, rate = MOTOR.allowed["prepressure"], MOTOR.allowed["frequency_difference"]
    ends = [np.nextafter(force.low, 0), np.nextafter(force.high, np.inf)]
    rates = (np.nextafter(rate.low, 0), np.nextafter(rate.high, np.inf))
    friction = MOTOR.friction_coefficient
    assert friction.range is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ts.evaluate(MOTOR, ts.Drive(prepressure=np.array(ends)), tolerance=1e-3)
        ts.optimize(MOTOR, bounds={"prepressure": tuple(ends), "frequency_difference": rates})
        MOTOR.with_values({"friction_coefficient": np.nextafter(friction.range[1], np.inf)})
    with pytest.warns(ts.ValidityWarning, match="reaches outside 100 to 220 N"):
        ts.optimize(MOTOR, bounds={"prepressure": (100, 220.001), "frequency_difference": rates})
