"""The plain wave that the rotor acts back on: against motion in time, a prescribed wave, another model, limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.coupling import _balance, _possible, coupled_values, plain_waves, wave_at
from trum_sym.model.levels import Levels

CONTACT = Levels(coupling="contact")
RPM = 30 / math.pi


def values_of(motor=None, levels=CONTACT, **drive):
    motor = ts.load_motor() if motor is None else motor
    return coupled_values(motor, ts.Drive(**{"on_periods": 20, "frequency_difference": 500.0, **drive}), levels)


def unpressed(levels=CONTACT, **drive):
    """Values almost without prepressure; eq. 8's amplitude, which counts for nothing here, is the same at any."""
    flat = ts.load_motor().with_values({"amplitude_factor": 1.0, "amplitude_exponent": 0.0})
    return values_of(flat, levels, prepressure=1e-4, load_torque=0.0, **drive)


def shinsei(hertz, torque):
    """Modal numbers, force and contact of the public simulation USM_SIM, which scales them by 0.3 squared."""
    mass, stiffness, damping, ratio = 0.196, 12e9, 500.0, 0.3
    return {
        **{"M_q": mass * ratio**2, "omega_n0": math.sqrt(stiffness / mass), "F_q": ratio * 175.0},
        **{"xi": damping / 2 / math.sqrt(stiffness * mass), "omega_q": 2 * math.pi * hertz},
        **{"D": 4e-3, "k_c": 300.0, "n_j": 9.0, "k_N": 4e7 / 0.03, "mu": 0.2, "F_c": 170.0, "r_c": 0.03},
        **{"T_load": torque, "J_total": 1e-5, "s": 1.0},
    }


def balance(p, height, fraction):
    """What is left of the modal force's square, by closed forms of partial and full contact, and bisection."""
    scale = p["n_j"] * p["k_N"] / p["k_c"]
    if height <= p["F_c"] / (2 * math.pi * scale):
        theta, free = math.pi, -p["F_c"] / (2 * math.pi * scale)
    else:
        theta = halved(lambda t: 2 * scale * height * (math.sin(t) - t * math.cos(t)) - p["F_c"], math.pi)
        free = height * math.cos(theta)
    alpha = halved(
        lambda a: 4 * scale * (height * math.sin(a) - free * a) - (1 + fraction) * p["F_c"],
        theta,
    )

    def first(a):  # the pressure's part in cos u up to a
        return scale * (height * (a + math.sin(a) * math.cos(a)) - 2 * free * math.sin(a))

    elastic = p["M_q"] * (p["omega_n0"] ** 2 - p["omega_q"] ** 2) * height + first(theta)
    lossy = 2 * p["xi"] * p["omega_n0"] * p["M_q"] * p["omega_q"] * height
    lossy += p["D"] * p["k_c"] * p["mu"] * (2 * first(alpha) - first(theta))
    return elastic**2 + lossy**2 - p["F_q"] ** 2


def halved(function, high):
    low = 0.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return low


def test_steady_states_are_those_of_a_motion_in_time():
    """A sample; `python -m studies.coupling 100` compares more."""
    from studies.coupling import differences

    (row,) = differences(1)
    assert np.abs(row).max() < 1e-7


def test_a_motion_in_time_keeps_its_energy():
    from studies.coupling import energy_residual

    start = np.array([2e-6, 0.3, 1e-6, 0.2, 0.5e-6, 0.0, 0.1])
    assert abs(energy_residual(values_of(load_torque=0.3), start, 1)) < 1e-8


def test_a_stable_state_attracts_and_the_one_between_repels():
    """From 1 % beside, towards it or away from it, by a motion in time of 20 periods."""
    from studies.coupling import after, guessed

    values = shinsei(40_500.0, 0.5)
    waves = plain_waves(values)
    assert waves.names == ("whole", "unstable", "high")
    for k, nearer in ((1, False), (2, True)):
        size, rim = float(waves.amplitude[k]), float(waves.speed[k]) * values["r_c"]
        state = guessed(values, size, float(waves.lead[k]), rim, float(waves.half_angle[k]))
        state[:4] *= 1.01
        end = after(values, state[:, np.newaxis], 20, tolerance=1e-6)[:, 0]
        assert (abs(math.hypot(end[0], end[2]) - size) < 0.01 * size) is nearer


def test_the_public_simulations_speeds_are_met():
    """rpm from a run of its class: five frequencies without load, 0.5 N m at 41 kHz, three roots at 40.5 kHz."""
    for hertz, rpm in ((40.5e3, 244.9), (41e3, 161.8), (42e3, 82.6), (43e3, 35.2), (44e3, 13.7)):
        waves = plain_waves(shinsei(hertz, 0.0))
        assert waves.speed.size == 1
        assert RPM * waves.speed[0] == pytest.approx(rpm, abs=0.051)
    assert RPM * plain_waves(shinsei(41e3, 0.5)).speed[-1] == pytest.approx(105.9, abs=0.051)
    assert plain_waves(shinsei(40.5e3, 0.5)).amplitude.size == 3
    assert plain_waves(shinsei(40e3, 0.0)).amplitude.size == 3


def test_all_steady_states_are_found():
    """As many as a dense scan of the balance, typed again, changes its sign."""
    at, several = np.random.default_rng(4), 0
    for _ in range(20):
        values = shinsei(at.uniform(39.8e3, 41e3), at.uniform(-0.3, 0.9)) | {"F_q": at.uniform(35, 70)}
        waves = plain_waves(values)
        fraction = values["T_load"] / (0.2 * 170 * 0.03)
        heights = np.geomspace(1e-9, 1.5e-5, 150)
        signs = np.sign([balance(values, height, fraction) for height in heights])
        assert np.count_nonzero(waves.amplitude) == np.count_nonzero(np.diff(signs))
        for height in waves.amplitude[waves.amplitude > 0]:
            assert abs(balance(values, height, fraction)) < 1e-9 * values["F_q"] ** 2
        several += waves.amplitude.size > 1
    assert several > 1


def test_no_bracket_with_a_state_in_it_is_left_out():
    """Random brackets, and the modal force that has its state at a random height within."""
    at = np.random.default_rng(8)
    for _ in range(200):
        values = shinsei(at.uniform(38e3, 42e3), at.uniform(-0.95, 0.95) * 0.2 * 170 * 0.03)
        low = 10 ** at.uniform(-8, -5)
        ends = np.array([low, low * (1 + 10 ** at.uniform(-3, 1))])
        inside = _balance(values, ends[:1] + at.uniform(0, 1) * np.diff(ends), "loaded")
        values["F_q"] = float(np.hypot(inside["in_phase"], inside["ahead"])[0])
        sides = _balance(values, ends, "loaded")
        one, other = ({name: value[k : k + 1] for name, value in sides.items()} for k in (0, 1))
        assert _possible(values, one, other, (ends[:1], ends[1:])).all()


def test_a_wave_has_a_steady_state_at_every_frequency():
    """One or three, in steps of 10 Hz across the resonance."""
    values = values_of(load_torque=0.0, prepressure=160.0)
    for offset in np.arange(-100.0, 501.0, 10.0):
        assert plain_waves(values | {"omega_q": values["omega_n0"] + 2 * math.pi * offset}).amplitude.size in (1, 3)


def test_what_brackets_rest_on_grows_with_the_height():
    """The central reaction, and what friction does beyond its mu-fold negative, for any load."""
    for load in (-0.9, -0.3, 0.0, 0.5, 0.99):
        values = shinsei(41e3, load * 0.2 * 170 * 0.03)
        heights = np.geomspace(1e-8, 1e-4, 400)
        at = _balance(values, heights, "loaded")
        assert (np.diff(at["central"]) > 0).all()
        assert (np.diff(at["along"] + 0.2 * at["central"]) > 0).all()


@pytest.mark.parametrize(("compliance", "offset"), [("layer", 500.0), ("flange", 500.0), ("flange", 3000.0)])
def test_the_speed_on_a_wave_is_that_on_the_same_wave_prescribed(trum60, compliance, offset):
    """The orbit of a rotor on a wave of the coupled height, at the same drive frequency; contacts of 0.4 to 2.5 rad."""
    levels = Levels(coupling="contact", compliance=compliance)
    values = values_of(levels=levels, load_torque=0.4, frequency_difference=offset)
    waves = plain_waves(values)
    drive = ts.Drive(on_periods=20, load_torque=0.4, frequency_difference=1.0)
    same = trum60.with_values(
        {"amplitude": float(waves.amplitude[0]), "resonance_frequency": values["omega_q"] / 2 / math.pi - 1.0}
    )
    point = ts.evaluate(same, drive, compliance=compliance, tolerance=1e-9)
    assert waves.speed[0] == pytest.approx(point.mean_speed, rel=1e-8)
    assert waves.half_angle[0] / math.pi == pytest.approx(point.contact_fraction, rel=1e-9)
    held = wave_at(values, waves.amplitude[:1], "held")
    assert held.friction[0] * 0.25 * 180 * 0.0265 == pytest.approx(point.stall_torque, rel=1e-8)


@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_without_prepressure_it_is_the_free_oscillator(trum60):
    values = unpressed(Levels(coupling="contact", amplitude="forced"))
    waves = plain_waves(values)
    stiffness = values["omega_n0"] ** 2 - values["omega_q"] ** 2
    damping = 2 * values["xi"] * values["omega_n0"] * values["omega_q"]
    free = values["F_q"] / values["M_q"] / abs(complex(stiffness, damping))
    assert waves.amplitude[-1] == pytest.approx(free, rel=1e-5)
    at_rest = ts.evaluate(
        trum60.with_values({"amplitude_factor": 1.0, "amplitude_exponent": 0.0}),
        ts.Drive(on_periods=20, frequency_difference=500.0 + (values["omega_n"] - values["omega_n0"]) / 2 / math.pi),
        foundation="none",
        amplitude="forced",
    )
    assert free == pytest.approx(at_rest.amplitude, rel=1e-9)  # eq. 7 put right


def test_the_modal_force_of_the_measured_amplitude_gives_it_at_resonance():
    values = unpressed()
    values |= {"omega_q": values["omega_n0"]}
    assert plain_waves(values).amplitude[-1] == pytest.approx(12.6e-6, rel=1e-5)


def test_a_narrow_contact_lifts_the_resonance_by_the_prepressure():
    # K = M omega^2 = 0.03313 * (2 pi 38730)^2 = 1.9619e9 N/m; 180 N over K and 10 um is 9.175e-3;
    # (sqrt(1.009175) - 1) * 38730 Hz = 177.3 Hz
    values = values_of(load_torque=0.0) | {"k_N": 1e14}
    shift = wave_at(values, np.array([1e-5])).resonance[0] - values["omega_n0"]
    assert shift / 2 / math.pi == pytest.approx(177.3, abs=0.1)


def test_friction_holds_a_surface_that_the_force_cannot_move():
    # at rest the whole wave touches: friction's part in cos u is mu F_c 2/pi cos(pi f/2), here times D k_c = 1.2
    limit = 1.2 * 0.2 * 170 * 2 / math.pi * math.cos(math.pi / 2 * 0.5)
    base = shinsei(41e3, 0.5 * 0.2 * 170 * 0.03)
    assert plain_waves(base | {"F_q": 0.999 * limit}).names[0] == "still"
    assert "still" not in plain_waves(base | {"F_q": 1.001 * limit}).names


def test_powers_add_up_and_the_force_puts_them_in():
    waves = plain_waves(values_of(load_torque=0.5))
    parts = waves.stator_power + waves.slip_power + waves.output_power
    assert waves.input_power == pytest.approx(parts, rel=1e-12)
    assert waves.output_power[0] == pytest.approx(0.5 * waves.speed[0], rel=1e-12)
    assert abs(waves.residual).max() < 1e-12
    assert waves.slip_power[0] > 0


def test_the_other_lead_turns_the_rotor_round():
    ahead = plain_waves(values_of(load_torque=0.4))
    behind = plain_waves(values_of(load_torque=-0.4, phase_lead=-1))
    assert behind.speed == -ahead.speed
    assert behind.amplitude == ahead.amplitude


def test_a_resonance_measured_under_prepressure_has_the_contact_taken_off(trum60):
    plain = values_of(load_torque=0.2)
    found = values_of(trum60.with_values({"resonance_frequency": plain["omega_n"] / 2 / math.pi}), load_torque=0.2)
    assert found["omega_q"] == pytest.approx(plain["omega_q"], rel=1e-12)
    # the quartic's stiffness and the modal one differ by the rotation's share, a thousandth of the shift
    assert found["omega_n0"] == pytest.approx(plain["omega_n0"], rel=1e-4)


def test_a_load_beyond_friction_has_no_steady_state():
    assert plain_waves(values_of(load_torque=1.2)).amplitude.size == 0
    assert plain_waves(values_of(load_torque=-1.2)).amplitude.size == 0


@pytest.mark.parametrize(
    ("values", "drive", "levels", "naming"),
    [
        ({}, {"on_periods": 14}, {}, "coupling: got contact, need none in pulse drive"),
        ({}, {"start": "rest"}, {}, "coupling: got contact, need none where start is rest"),
        (
            {"layer_loss_factor": 0.1},
            {},
            {"tangential": "brush"},
            "layer_loss_factor: got 0.1, need 0 where coupling is",
        ),
        ({}, {}, {"contact": "hertz"}, "coupling: got contact, need none where contact is hertz"),
        ({"amplitude": 5e-6}, {}, {}, "coupling: got contact, need none where the motor's amplitude"),
        ({"friction_coefficient": 0}, {}, {}, "friction_coefficient: got 0, need a number > 0 where coupling"),
        ({"damping_ratio": 0}, {}, {}, "damping_ratio: got 0, need a number > 0 where coupling"),
        ({"contact_radius": np.array([0.025, 0.026])}, {}, {}, "contact_radius: got an array"),
    ],
)
@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_what_the_level_does_not_know_is_refused(trum60, values, drive, levels, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        values_of(trum60.with_values(values), replace(CONTACT, **levels), **drive)


def test_other_answers_refuse_the_level(trum60):
    for answer in (
        lambda: ts.holding(trum60, coupling="contact"),
        lambda: ts.calibrate({"prepressure": [100.0, 220.0], "amplitude": [8e-6, 5e-6]}, coupling="contact"),
    ):
        with pytest.raises(ts.ParameterError, match="coupling: got contact, need none"):
            answer()


def test_curves_of_a_coupled_wave(trum60):
    pytest.importorskip("xarray")
    drive = ts.Drive(on_periods=20, frequency_difference=500.0)
    curves = ts.characteristics(trum60, drive, points=3, coupling="contact", compliance="flange").sel(drive="plain")
    speed = curves["mean_speed"].values
    kept = curves["droop_compliance"].values * curves["droop_reaction"].values
    assert kept == pytest.approx(speed / speed[0], rel=1e-12)
    one = plain_waves(values_of(levels=replace(CONTACT, compliance="flange"), load_torque=float(curves["torque"][1])))
    assert speed[1] == one.speed[-1]
    assert curves["amplitude"].values[1] == one.amplitude[-1]
    assert curves["efficiency"].values[1] == pytest.approx(one.output_power[-1] / one.input_power[-1], rel=1e-12)
    assert (np.diff(curves["speed_by_frequency"].values) < 0).all()
    # the reaction changes the speed by a few per cent, the contact's width by far more
    assert (curves["droop_reaction"].values[1:] > 0.9).all()
    assert "amplitude" not in ts.characteristics(trum60, drive, points=2)


def test_the_console_shows_the_wave(capsys):
    pytest.importorskip("xarray")
    words = ["--coupling", "contact", "--frequency-difference", "500", "--points", "3"]
    assert main(["characteristics", *words, "--on-periods", "20"]) == 0
    assert "speed kept by contact" in capsys.readouterr().out
    assert main(["characteristics", *words]) == 2
    assert capsys.readouterr().err == (
        "trum-sym: --coupling: got contact, need none in pulse drive, or on_periods = periods, the plain wave\n"
    )
