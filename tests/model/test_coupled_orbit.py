"""Laps of phases, contact and rotor as one system: against motion in time, a prescribed wave, the plain wave."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model.coupled_orbit import (
    STATE,
    coupled_orbits,
    followed,
    lap_values,
    laps,
    one_phase,
    orbit_from,
    start_of,
)
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.port import port_of


@pytest.fixture(scope="module")
def motor():
    return ts.load_motor()


def test_a_lap_is_a_motion_in_time(motor):
    """Two periods of pulses, A off and B off, from a state of unlike phases, under a rotor with a mass."""
    from studies.coupling import cycle

    values = lap_values(motor, ts.Drive(periods=2, on_periods=1), Levels(compliance="flange"), rotor_mass=0.02)
    start = np.array([2e-6, 0.3, 1e-6, -0.5, 1.5e-6, 0.01, 0.1])
    wanted = cycle(values, start, 1e-10)
    sizes = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3])
    gaps = []
    for tolerance in (1e-4, 1e-6, 1e-8):
        end, _ = laps({**values, "tolerance": tolerance}, start[:, np.newaxis])
        gaps.append(float(np.abs((end[:, 0] - wanted[:7]) / sizes).max()))
    assert gaps[2] < 1e-6
    assert gaps[1] < gaps[0] / 10  # falls as what a step may be off, kinks of contact and friction notwithstanding
    assert gaps[2] < gaps[1] / 10


def test_a_lap_is_the_same_on_every_instruction_set(motor):
    """Which takes states beside each other in registers of 2, 4 or 8, or one after another."""
    from trum_sym import _kernels

    values = lap_values(motor, ts.Drive(periods=3, on_periods=2), Levels(), rotor_mass=0.02, tolerance=1e-4)
    point = {**values, **dict(zip(STATE, start_of("steady", values), strict=True))}
    sets = list(_kernels.instruction_sets())
    found = []
    try:
        for name in sets:
            _kernels.use(name)
            one, more = call("coupled_lap", point), call("coupled_slopes", point)
            slopes = np.asarray(more.pop("slopes"))
            assert one == more
            found.append((np.array([float(np.asarray(value)) for value in one.values()]), slopes))
    finally:
        _kernels.use(sets[-1])
    for figures, slopes in found[1:]:
        assert figures == pytest.approx(found[0][0], rel=1e-9, abs=1e-12)
        assert slopes == pytest.approx(found[0][1], rel=1e-4, abs=1e-6 * np.abs(slopes).max())


@pytest.mark.parametrize(("mass", "off_terminals"), [(0.0, "short"), (0.02, "short"), (0.0, "open"), (0.02, "open")])
def test_slopes_of_a_lap_are_differences_of_laps(motor, mass, off_terminals):
    drive, schedule = ts.Drive(periods=3, on_periods=2), ts.Schedule(off_terminals=off_terminals)
    values = lap_values(motor, drive, Levels(compliance="flange"), schedule, rotor_mass=mass)
    values |= {"tolerance": 1e-11}
    start = laps(values, start_of("steady", values)[:, np.newaxis])[0][:, 0]
    slopes = np.asarray(call("coupled_slopes", {**values, **dict(zip(STATE, start, strict=True))})["slopes"])
    speed = values["size"] * values["omega_n0"]
    sizes = np.array([values["size"], speed] * 3 + [values["D"] * values["k_c"] * speed])
    for k in (0, 1, 2, 3, 6):
        aside = start[:, np.newaxis] + 1e-4 * sizes[k] * np.eye(7)[:, [k]] * np.array([1, -1])
        ends, found = laps(values, aside)
        quotient = np.append(ends[:, 0] - ends[:, 1], found["mean"][0] - found["mean"][1]) / (2e-4 * sizes[k])
        scale = np.append(sizes, sizes[6]) / sizes[k]
        assert np.abs((slopes[:, k] - quotient) / scale).max() < 2e-3


def test_without_reaction_it_is_the_orbit_on_a_prescribed_wave(motor):
    """Of the same force, whose amplitude coupling = none is given; its cycle and orbit are another code's."""
    values = lap_values(motor, ts.Drive(), Levels(), reaction=False, tolerance=1e-7, rotor_mass=0.0)
    own, turn = values["omega_n"], values["omega_q"]
    values |= {"omega_n0": own}  # at the resonance under prepressure, as there
    size = values["F_q"] / values["M_q"] / abs(complex(own**2 - turn**2, 2 * values["xi"] * own * turn))
    orbit = orbit_from(values, start_of("steady", values), "steady")
    prescribed = motor.with_values({"amplitude": size, "resonance_frequency": own / 2 / math.pi})
    point = ts.evaluate(prescribed, ts.Drive(), tolerance=1e-8)
    assert orbit.closed
    most = max(abs(point.min_speed), point.max_speed)
    for name in ("mean_speed", "min_speed", "max_speed"):
        assert getattr(orbit, name) == pytest.approx(getattr(point, name), abs=2e-7 * most)
    assert orbit.contact_fraction == pytest.approx(point.contact_fraction, abs=1e-6)


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_with_light_contact_it_tends_to_the_orbit_on_a_prescribed_wave(motor):
    """The reaction over the modal stiffness times the wave is what both differ by, 2 kHz above the resonance."""
    gaps, sizes = [], []
    for force in (2.0, 1.0, 0.5):
        drive = ts.Drive(prepressure=force, frequency_difference=2e3, load_torque=0.0)
        values = lap_values(motor, drive, Levels(), rotor_mass=0.0)
        own, turn = values["omega_n0"], values["omega_q"]
        swing = complex(own**2 - turn**2, 2 * values["xi"] * own * turn)
        values |= {"force_phase": float(np.angle(swing))}
        size = values["F_q"] / values["M_q"] / abs(swing)
        prescribed = motor.with_values({"amplitude": size, "resonance_frequency": own / 2 / math.pi})
        same = ts.Drive(prepressure=force, frequency_difference=(turn - own) / 2 / math.pi, load_torque=0.0)
        point = ts.evaluate(prescribed, same)
        orbit = orbit_from(values, start_of("steady", values), "steady")
        assert orbit.stable
        gaps.append(abs(orbit.mean_speed / point.mean_speed - 1))
        sizes.append(force / (values["M_q"] * own**2 * size))
    orders = np.diff(np.log(gaps)) / np.diff(np.log(sizes))
    assert orders == pytest.approx(1.0, abs=0.05)
    assert gaps[-1] < 0.003


@pytest.mark.parametrize("mass", [0.0, 0.02])
def test_both_phases_always_on_come_to_the_plain_wave(motor, mass):
    drive = ts.Drive(periods=1, on_periods=1, frequency_difference=500.0, load_torque=0.4)
    values = lap_values(motor, drive, Levels(compliance="flange"), rotor_mass=mass)
    orbit = orbit_from(values, start_of("steady", values), "steady")
    plain = plain_waves(coupled_values(motor, drive, Levels(compliance="flange", coupling="contact")))
    assert orbit.closed
    assert orbit.stable
    assert abs(orbit.mean_speed - plain.speed[-1]) < max(orbit.mean_speed_error, 1e-9)
    assert orbit.deviation < 1e-7 * orbit.mean_speed
    assert math.hypot(orbit.state[0], orbit.state[2]) == pytest.approx(plain.amplitude[-1], rel=1e-7)
    assert orbit.input_power == pytest.approx(plain.input_power[-1], rel=1e-7)
    assert orbit.contact_fraction == pytest.approx(plain.half_angle[-1] / math.pi, rel=1e-7)


@pytest.mark.parametrize(("seed", "off_terminals"), [(31, "short"), (40, "short"), (0, "open"), (1, "open")])
def test_another_formulation_closes_the_orbits_and_finds_the_energy(seed, off_terminals):
    """A sample; `python -m studies.coupling pulses 100`, or `open 100`, compares more."""
    from studies.coupling import pulse_differences

    orbit, gaps = pulse_differences(seed, off_terminals)
    assert orbit.stable
    assert (gaps[:-1] < 1e-6).all()
    assert gaps[-1] < 1e-8


def test_stated_errors_hold_the_difference_from_finer_steps():
    """A sample; `python -m studies.coupling errors 100` has more."""
    from studies.coupling import over_error

    shares = [over_error(seed) for seed in (0, 2, 10, 31)]
    assert all((share < 1).all() for share in shares)


def test_a_tolerance_is_met_with_the_steps_that_it_takes(motor):
    orbits = []
    for tolerance in (1e-3, 1e-6):
        values = lap_values(motor, ts.Drive(), Levels(compliance="flange"), rotor_mass=0.1, tolerance=tolerance)
        orbit = orbit_from(values, start_of("steady", values), "steady")
        most = max(abs(orbit.min_speed), abs(orbit.max_speed))
        assert orbit.tolerance_met
        assert max(orbit.mean_speed_error, orbit.min_speed_error, orbit.max_speed_error) <= tolerance * most
        orbits.append(orbit)
    coarse, fine = orbits
    assert abs(coarse.mean_speed - fine.mean_speed) < coarse.mean_speed_error
    assert coarse.mean_speed_error > 3 * fine.mean_speed_error


@pytest.mark.parametrize("cycles", [2, 3])
def test_orbits_over_several_cycles_are_found(cycles):
    """Rotors on a layer, from the steady swing."""
    from studies.coupling import draw_pulses

    values = {**draw_pulses({2: 176, 3: 812}[cycles]), "wanted": 1e-4}
    orbit = orbit_from(values, start_of("steady", values), "steady")
    assert orbit.closed
    assert orbit.stable
    assert orbit.cycles == cycles
    states = [orbit.state]
    for _ in range(cycles):
        states.append(laps({**values, "tolerance": 1e-9}, states[-1][:, np.newaxis])[0][:, 0])
    sizes = np.abs(orbit.state).max() * np.array([1e-6, 1, 1e-6, 1, 1e-6, 1, 1])
    gaps = [float(np.abs((state - orbit.state) / sizes).max()) for state in states[1:]]
    assert gaps[-1] < 1e-3
    assert min(gaps[:-1]) > 0.05
    again = orbit_from(values, states[1], "a cycle on", 12)
    assert again.mean_speed == pytest.approx(orbit.mean_speed, rel=1e-3)


def test_an_orbit_of_pulses_repeats_and_its_disturbances_die_out_as_laps_do(motor):
    values = lap_values(motor, ts.Drive(), Levels(), rotor_mass=0.0)
    (orbit,) = coupled_orbits(values)  # both starts lead to one
    assert orbit.closed
    assert orbit.stable
    aside = orbit.state[:, np.newaxis] * (1 + 1e-4)
    first, _ = laps(values, aside)
    for _ in range(3):
        aside, _ = laps(values, aside)
    later, _ = laps(values, aside)
    sizes = np.abs(orbit.state)[[0, 1, 2, 3, 6], np.newaxis]
    gaps = [np.abs((end - orbit.state[:, np.newaxis])[[0, 1, 2, 3, 6]] / sizes).max() for end in (first, later)]
    rate = (gaps[1] / gaps[0]) ** (1 / 4)
    assert rate < 1.1 * np.abs(orbit.multipliers).max()


def test_a_sweep_goes_on_from_the_orbit_before(motor):
    """Where there is one orbit, it is that of any start; the second begins so near that few laps are needed first."""
    points = [
        lap_values(motor, ts.Drive(frequency_difference=f), Levels(compliance="flange"), rotor_mass=0.0)
        for f in (2990.0, 3e3)
    ]
    first, second = followed(points, 6)
    assert (first.start, second.start) == ("steady", "followed")
    assert second.closed
    (other,) = coupled_orbits(points[1], ("rest",))
    assert abs(second.mean_speed - other.mean_speed) < second.mean_speed_error + other.mean_speed_error


def test_an_orbit_that_rounding_alone_keeps_from_closing_is_closed(motor):
    """A rotor that does not turn meets no tolerance of its speed, and steps become as fine as they may."""
    drive = ts.Drive(prepressure=180.0, frequency_difference=-273.6710819647439)
    orbit = one_phase(motor, drive, Levels(compliance="flange"), rotor_mass=0.02, tolerance=1e-4)
    assert orbit.closed
    assert orbit.stable
    assert orbit.missed < 1e-8


def _alone(motor, **words):
    """A phase A that is off for a lap after it was driven, its terminals open, and a B without a force."""
    schedule = ts.Schedule(periods=2, on_periods=1, off_terminals="open")
    values = lap_values(motor, ts.Drive(), Levels(), schedule, **words)
    return values | {"m": 7.0, "on_A": 7.0, "off_B": 0.0, "on_B": 0.0, "force_B_ahead": 0.0, "tolerance": 1e-10}


def test_an_open_phase_swings_about_where_its_charge_holds_it(motor):
    """Without a rotor: a damped oscillator in closed form, at the port's open resonance but for the damping."""
    values = _alone(motor, reaction=False, rotor_mass=0.0) | {"force_phase": 0.4}
    port = port_of(coupled_values(motor, ts.Drive(on_periods=20), Levels(coupling="contact")))
    start = np.array([1e-6, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0])
    end, found = laps(values, start[:, np.newaxis])
    own, turn, damping = values["omega_n0"], 2 * math.pi * port.open_resonance, values["xi"] * values["omega_n0"]
    voltage = values["U_s"] * math.cos(0.4)
    # at rest the ring's stiffness holds what the charge of voltage and displacement makes
    aside = (port.force_factor * voltage + (turn**2 - own**2) * values["M_q"] * start[0]) / (values["M_q"] * turn**2)
    time, whole = 7 * 2 * math.pi / values["omega_q"], math.sqrt(turn**2 - damping**2)
    root = complex(-damping, whole)
    size = complex(start[0] - aside, (-damping * (start[0] - aside) - start[1]) / whole)
    moved = size * np.exp(root * time)
    assert end[0, 0] == pytest.approx(aside + moved.real, abs=1e-8 * abs(size))
    assert end[1, 0] == pytest.approx((root * moved).real, abs=1e-8 * abs(size * root))
    # the charge's work is what the capacitance's energy has lost
    then = (float(found["pull_A"][0]) - values["K_o"] * end[0, 0]) / port.force_factor
    assert then == pytest.approx(voltage - port.force_factor / port.capacitance * (end[0, 0] - start[0]), rel=1e-9)
    lost = port.capacitance / 2 * (voltage**2 - then**2)
    assert float(found["input"][0]) * time == pytest.approx(lost, rel=1e-7)


@pytest.mark.parametrize("mass", [0.0, 0.02])
def test_an_infinite_capacitance_keeps_the_voltage_and_without_one_is_a_short(motor, mass):
    values = _alone(motor, rotor_mass=mass)
    start = start_of("steady", values)[:, np.newaxis]
    gaps = []
    for phase, stiffness in ((math.pi / 2, 1e-5), (math.pi / 2, 1e-3), (0.0, 1e-5)):
        point = values | {"force_phase": phase}
        short = laps(point | {"K_o": 0.0}, start)[0]
        open_ = laps(point | {"K_o": stiffness * values["K_o"]}, start)[0]
        gaps.append(float(np.abs(open_ - short)[0, 0]) / values["size"])
    assert gaps[1] / gaps[0] == pytest.approx(100, rel=0.02)
    assert 0 < gaps[1] < 1e-3
    held = values["F_q"] / values["M_q"] / values["omega_n0"] ** 2 / values["size"]  # by the voltage at its crest
    assert 0.1 * held < gaps[2] < 3 * held


def test_open_terminals_take_a_permittivity(motor):
    bare = replace(motor, piezo_permittivity=None)
    with pytest.raises(ts.ParameterError, match="piezo_permittivity: got nothing"):
        lap_values(bare, ts.Drive(), Levels(), ts.Schedule(off_terminals="open"))
    assert lap_values(bare, ts.Drive(), Levels())["K_o"] == 0


def test_pulses_have_the_force_of_the_motors_electrodes(motor):
    levels = Levels(amplitude="forced")
    whole, part = (
        lap_values(m, ts.Drive(), levels, rotor_mass=0.0) for m in (motor, motor.with_values({"phase_coverage": 4 / 9}))
    )
    assert part["F_q"] / whole["F_q"] == pytest.approx(4 / 9, rel=1e-12)


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_one_phase_without_prepressure_has_the_free_amplitude(motor):
    drive = ts.Drive(prepressure=0.1, frequency_difference=0.0)
    values = coupled_values(motor, ts.Drive(prepressure=0.1, frequency_difference=0.0, on_periods=20), Levels())
    own, turn = values["omega_n0"], values["omega_q"]
    free = values["F_q"] / values["M_q"] / abs(complex(own**2 - turn**2, 2 * values["xi"] * own * turn))
    orbit = one_phase(motor, drive, Levels(), rotor_mass=0.0)
    assert orbit.highest_wave == pytest.approx(free, rel=1e-5)  # friction of 0.1 N
    assert abs(orbit.state[STATE.index("w_B")]) < 1e-15
    assert abs(orbit.mean_speed) < 1e-6


@pytest.mark.parametrize(
    ("drive", "words", "naming"),
    [
        ({"start": "steady"}, {}, "start: got steady, need periodic where coupling is contact"),
        ({}, {"rotor_mass": -1.0}, "rotor_mass: got -1"),
        ({}, {"tolerance": 1e-12}, "tolerance: got 1e-12"),
        ({}, {"tolerance": 1}, "tolerance: got 1"),
    ],
)
def test_what_a_lap_cannot_take_is_refused(motor, drive, words, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        lap_values(motor, ts.Drive(**drive), Levels(), **words)


def test_a_start_that_is_none_is_refused(motor):
    with pytest.raises(ts.ParameterError, match="start: got moving, need one of rest, steady"):
        start_of("moving", lap_values(motor, ts.Drive(), Levels(), rotor_mass=0.0))
