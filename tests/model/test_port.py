"""The electrical port: against circuits, motions in time, and energies that are typed here on their own."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.console import main
from trum_sym.inputs.motor import COUPLED
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels
from trum_sym.model.port import drawn, free_admittance, port_of

integrate, optimize = lazily("scipy.integrate"), lazily("scipy.optimize")

MOTOR = ts.load_motor()
PLAIN = ts.Drive(on_periods=20, frequency_difference=500.0, load_torque=0.3)
TURN = 2 * np.pi


def values_of(motor=MOTOR, drive=PLAIN, **levels):
    return coupled_values(motor, drive, Levels(coupling="contact", **levels))


@pytest.fixture(scope="module")
def values():
    return values_of()


def impedance(port, omega):
    """Of inductance, capacitance and resistance in series."""
    return port.resistance + 1j * omega * port.inductance + 1 / (1j * omega * port.motional_capacitance)


def test_a_free_phase_is_a_circuit(values):
    port, frequency = port_of(values), np.linspace(37e3, 42e3, 41)
    omega = TURN * frequency
    loss = MOTOR.piezo_loss_factor.value
    wanted = 1j * omega * port.capacitance * (1 - 1j * loss) + 1 / impedance(port, omega)
    conductance, susceptance = free_admittance(values, frequency)
    assert conductance + 1j * susceptance == pytest.approx(wanted, rel=1e-10)


def test_series_and_parallel_resonance_and_coupling_factor_are_the_circuits(values):
    port = port_of(values)
    assert port.resonance == pytest.approx(1 / (TURN * np.sqrt(port.inductance * port.motional_capacitance)), rel=1e-12)
    both = port.capacitance * port.motional_capacitance / (port.capacitance + port.motional_capacitance)
    assert port.open_resonance == pytest.approx(1 / (TURN * np.sqrt(port.inductance * both)), rel=1e-12)

    def lossless(f):
        omega = TURN * f
        branch = omega * port.inductance - 1 / (omega * port.motional_capacitance)
        return omega * port.capacitance - 1 / branch

    assert port.open_resonance == pytest.approx(
        optimize.brentq(lossless, port.resonance + 100, port.resonance + 3000), rel=1e-9
    )
    share = port.motional_capacitance / (port.motional_capacitance + port.capacitance)
    assert port.coupling_factor == pytest.approx(np.sqrt(share), rel=1e-12)


def test_factor_and_capacitance_are_what_the_ceramics_data_give():
    """By hand, of the sheet's numbers: the charge of half waves and a plate of 188.5 mm by 8 mm, 0.5 mm thick."""
    values = values_of(amplitude="forced")
    port = port_of(values)
    square = 97e-12**2 / (11.5e-12 * 8.85e-9)  # k_31
    area = TURN * 30e-3 * 8e-3
    assert port.capacitance == pytest.approx(8.85e-9 * (1 - square) * area / 0.5e-3, rel=1e-12)
    middle = 4.5e-3 + 0.25e-3 - values["D"]
    # mean |cos| is 2/pi; the mode's curvature at its crest is beta k_c
    charge = 97e-12 / 11.5e-12 * middle * values["beta"] * values["k_c"] * 2 / np.pi * area
    assert port.force_factor == pytest.approx(charge, rel=1e-12)
    half = port_of(values_of(MOTOR.with_values({"phase_coverage": 0.5}), amplitude="forced"))
    assert half.force_factor == pytest.approx(port.force_factor / 2, rel=1e-12)
    assert half.capacitance == pytest.approx(port.capacitance / 2, rel=1e-12)


def test_a_motion_in_time_draws_the_conductance_and_susceptance(values):
    port, mass = port_of(values), values["M_q"]
    omega, size = TURN * (port.resonance + 300), 200.0
    damping, stiffness = 2 * values["xi"] * values["omega_n0"] * mass, mass * values["omega_n0"] ** 2

    def rate(t, state):
        w, v, *_ = state
        voltage, slope = size * np.cos(omega * t), -size * omega * np.sin(omega * t)
        current = port.force_factor * v + port.capacitance * slope
        current += omega * port.capacitance * values["tan_delta"] * voltage
        force = port.force_factor * voltage
        lagging = size * np.sin(omega * t)
        return [v, (force - damping * v - stiffness * w) / mass, current * voltage, current * lagging]

    # steady motion from the mode's complex stiffness, then one period in time
    w = port.force_factor * size / (stiffness - mass * omega**2 + 1j * damping * omega)
    start = [w.real, (1j * omega * w).real, 0.0, 0.0]
    moved = integrate.solve_ivp(rate, (0.0, TURN / omega), start, rtol=1e-10, atol=1e-14, method="DOP853").y[:, -1]
    assert moved[:2] == pytest.approx(start[:2], rel=1e-6)
    conductance, susceptance = free_admittance(values, np.array([omega / TURN]))
    mean = moved[2:] * omega / TURN / (size**2 / 2)
    assert mean[0] == pytest.approx(conductance[0], rel=1e-7)
    assert -mean[1] == pytest.approx(susceptance[0], rel=1e-7)


@pytest.mark.parametrize("resistor", [1e-4, 1e10])
def test_electrodes_that_are_short_or_open_set_the_frequency_of_a_phase_that_is_off(values, resistor):
    """Eigenvalues of displacement, velocity and voltage with a resistor across the electrodes."""
    port, mass = port_of(values), values["M_q"]
    own, damping = values["omega_n0"], 2 * values["xi"] * values["omega_n0"]
    matrix = np.array(
        [
            [0.0, 1.0, 0.0],
            [-(own**2), -damping, port.force_factor / mass],
            [0.0, -port.force_factor / port.capacitance, -1 / (resistor * port.capacitance)],
        ]
    )
    swing = max(np.linalg.eigvals(matrix), key=lambda x: x.imag)
    undamped = abs(swing) / TURN
    assert undamped == pytest.approx(port.resonance if resistor < 1 else port.open_resonance, rel=1e-6)
    assert port.open_resonance - port.resonance > 500


@pytest.mark.parametrize("load", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("levels", [{}, {"compliance": "flange"}, {"amplitude": "forced"}])
def test_electrical_power_is_what_stator_ceramic_slip_and_load_take(load, levels):
    values = values_of(drive=replace(PLAIN, load_torque=load), **levels)
    waves = plain_waves(values)
    draws = drawn(values, waves)
    assert waves.amplitude.size
    taken = waves.stator_power + draws.dielectric_power + waves.slip_power + load * waves.speed
    assert np.abs(draws.electric_power / taken - 1).max() < 1e-8
    apparent = values["U_s"] * draws.current  # of both phases, effective values
    assert draws.electric_power**2 + draws.reactive_power**2 == pytest.approx(apparent**2, rel=1e-12)
    assert draws.power_factor == pytest.approx(draws.electric_power / apparent, rel=1e-12)


def test_a_wave_that_friction_holds_draws_the_current_of_the_capacitance():
    weak = MOTOR.with_values({"voltage": 20.0})
    drive = ts.Drive(load_torque=0.0)
    found = ts.admittance(weak, drive, frequencies=[38000.0, 38700.0], amplitude="forced").sel(state="pressed")
    assert (found["amplitude"].values == 0).all()
    omega = TURN * found["frequency"].values
    assert found["susceptance"].values == pytest.approx(omega * float(found["capacitance"]), rel=1e-12)
    assert found["conductance"].values == pytest.approx(0.004 * omega * float(found["capacitance"]), rel=1e-12)


def test_far_from_resonance_a_pressed_phase_tends_to_a_free_one():
    """The contact reacts with some F_c and mu F_c, next to ever more modal force."""
    near, far = (
        ts.admittance(MOTOR.with_values({"voltage": volts}), frequencies=[37000.0], amplitude="forced")
        for volts in (900.0, 9000.0)
    )

    def apart(found):
        y = found["conductance"].values[:, 0] + 1j * found["susceptance"].values[:, 0]
        return abs(y[1] / y[0] - 1)

    assert apart(far) < apart(near) / 9 < 1e-2


def test_the_pressed_curve_is_what_characteristics_has_at_the_same_frequency():
    curves = ts.characteristics(MOTOR, replace(PLAIN, load_torque=0.3), points=2, coupling="contact").sel(drive="plain")
    values = values_of(drive=replace(PLAIN, load_torque=0.0))
    found = ts.admittance(frequencies=[values["omega_q"] / TURN], drive=ts.Drive(load_torque=0.0)).sel(state="pressed")
    assert float(found["amplitude"][0]) == pytest.approx(float(curves["amplitude"][0]), rel=1e-9)
    assert float(found["electric_power"][0]) == pytest.approx(float(curves["electric_power"][0]), rel=1e-9)
    size = np.hypot(float(found["conductance"][0]), float(found["susceptance"][0]))
    assert 200.0 * size == pytest.approx(float(curves["current"][0]), rel=1e-9)
    share = curves["output_power"].values / curves["electric_power"].values
    assert curves["electric_efficiency"].values == pytest.approx(share, rel=1e-12)


def test_a_motor_file_without_a_permittivity_has_no_electrical_figures():
    bare = replace(MOTOR, **dict.fromkeys(COUPLED))
    curves = ts.characteristics(bare, PLAIN, points=2, coupling="contact").sel(drive="plain")
    known = ts.characteristics(MOTOR, PLAIN, points=2, coupling="contact").sel(drive="plain")
    assert np.isnan(curves["current"].values).all()
    assert np.array_equal(curves["amplitude"].values, known["amplitude"].values)
    with pytest.raises(ts.ParameterError, match="piezo_permittivity: got nothing"):
        ts.admittance(bare)
    with pytest.raises(ts.ParameterError, match="more than d_31"):
        ts.admittance(bare.with_values({"piezo_permittivity": "0.5 nF/m"}))


def test_arguments_replace_what_the_motor_file_says_of_rotor_and_electrodes():
    levels = Levels(amplitude="forced", coupling="contact")
    found = coupled_values(MOTOR, PLAIN, levels, coverage=4 / 9, rotor_mass=0.05)
    assert (found["c_p"], found["m_r"]) == (4 / 9, 0.05)
    assert found["F_q"] == pytest.approx(4 / 9 * coupled_values(MOTOR, PLAIN, levels)["F_q"], rel=1e-12)
    bare = coupled_values(replace(MOTOR, **dict.fromkeys(COUPLED)), PLAIN, levels)
    assert (bare["c_p"], bare["m_r"]) == (1.0, 0.0)
    of_file = coupled_values(MOTOR.with_values({"rotor_mass": "50 g"}), PLAIN, levels)
    assert of_file["m_r"] == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"frequencies": []}, "frequencies: got"),
        ({"frequencies": [4e4, 3e4]}, "numbers that rise"),
        ({"frequencies": [-1.0, 3e4]}, "> 0"),
        ({"frequencies": ["a"]}, "frequencies: got"),
        ({"points": 1}, "points: got 1"),
        ({"coupling": "none"}, "coupling: got none"),
        ({"contact": "hertz"}, "contact: got hertz"),
        ({"foundation": "none"}, "foundation: got none"),
        ({"tangential": "brush"}, "tangential: got brush"),
        ({"drive": 3}, "drive: got 3"),
        ({"drive": ts.Drive(prepressure=[100.0, 120.0])}, "one number"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments, words):
    with pytest.raises(ts.ParameterError) as error:
        ts.admittance(**arguments)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_the_command_prints_writes_and_draws(tmp_path, capsys):
    few = ["--points", "3", "--compliance", "flange"]
    out, plot = tmp_path / "curve.csv", tmp_path / "curve.svg"
    assert main(["admittance", *few, "--out", str(out), "--plot", str(plot)]) == 0
    said = capsys.readouterr().out
    assert "force factor" in said
    assert "200 V, pressed with 180 N under 0.3 N m" in said
    assert plot.read_text().lstrip().startswith("<?xml")
    lines = out.read_text().splitlines()
    assert lines[0].startswith("state,frequency [Hz],conductance [S],susceptance [S]")
    assert len(lines) == 1 + 2 * 3
    assert main(["admittance", *few, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    found = ts.admittance(points=3, compliance="flange")
    assert printed["variables"]["conductance"]["values"] == found["conductance"].values.tolist()
    port = asdict(port_of(values_of(compliance="flange")))
    assert {name: printed["variables"][name]["values"] for name in port} == pytest.approx(port, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--from", "38 kHz"], "--to: got nothing"),
        (["--from", "39 kHz", "--to", "38 kHz"], "more than the first frequency, 39000 Hz"),
        (["--points", "1"], "--points: got 1"),
        (["--set", "phase_coverage=1.5"], "phase_coverage"),
        (["--out", "curve.txt"], "--out"),
    ],
)
def test_the_command_refuses_in_one_line(arguments, words, capsys):
    assert main(["admittance", *arguments]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
