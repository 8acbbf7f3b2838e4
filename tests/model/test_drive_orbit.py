"""Drives on the coupled engine: limits, a motion in time by another code, energy, starts and stops, an encoder."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model.coupled_orbit import STATE, lap_values, laps, orbit_from, start_of
from trum_sym.model.coupling import coupled_values, plain_waves, standing
from trum_sym.model.drive_orbit import drive_history, drive_orbit, history_of, read_by_encoder
from trum_sym.model.levels import Levels
from trum_sym.model.orbit_certificate import certificate_of
from trum_sym.model.rotor import encoder_readings

FLANGE = Levels(compliance="flange")
QUICK = {"compliance": "flange", "start": "steady", "tolerance": 1e-4, "rotor_mass": 0.0}
PLAIN = ts.Schedule(kind="continuous")


@pytest.fixture(scope="module")
def motor():
    return ts.load_motor()


@pytest.fixture(scope="module")
def drive():
    return ts.Drive(frequency_difference=500.0, load_torque=0.0)


@pytest.mark.parametrize(
    "schedule",
    [
        ts.Schedule(kind="burst", periods=1, on_periods=1),
        ts.Schedule(kind="burst", periods=3, on_periods=3),
        ts.Schedule(periods=2, on_periods=2),
        PLAIN,
    ],
)
def test_a_drive_that_is_never_off_is_the_plain_wave(motor, schedule):
    drive = ts.Drive(frequency_difference=500.0, load_torque=0.4)
    found = drive_orbit(motor, drive, schedule, **QUICK).orbit
    plain = plain_waves(
        coupled_values(motor, ts.Drive(frequency_difference=500.0, load_torque=0.4, on_periods=20), FLANGE)
    )
    assert found.closed
    assert found.mean_speed == pytest.approx(plain.speed[-1], rel=1e-6)
    assert found.deviation < 1e-6 * found.mean_speed
    assert found.input_power == pytest.approx(plain.input_power[-1], rel=1e-5)


@pytest.mark.parametrize("voltage", [0.2, 0.6])
def test_a_share_of_the_voltage_is_a_share_of_the_modal_force(motor, drive, voltage):
    values = coupled_values(motor, ts.Drive(frequency_difference=500.0, load_torque=0.0, on_periods=20), FLANGE)
    plain = plain_waves({**values, "F_q": voltage * values["F_q"]})
    found = drive_orbit(motor, drive, ts.Schedule(kind="continuous", voltage=voltage), **QUICK).orbit
    assert found.mean_speed == pytest.approx(plain.speed[plain.highest], rel=1e-6)
    assert found.highest_wave == pytest.approx(plain.amplitude[plain.highest], rel=1e-6)


@pytest.mark.parametrize(
    "schedule",
    [
        ts.Schedule(kind="continuous", phase_difference=0.0),
        ts.Schedule(kind="continuous", phase_difference="180 deg"),
        ts.Schedule(kind="continuous", ratio=0.0),
        ts.Schedule(kind="single"),
    ],
)
def test_a_standing_wave_does_not_turn_the_rotor(motor, drive, schedule):
    found = drive_orbit(motor, drive, schedule, **QUICK).orbit
    assert found.closed
    assert found.stable
    assert found.highest_wave > 2e-6
    assert abs(found.mean_speed) < 1e-6  # of a surface that goes to and fro at some m/s, to 1e-4


def test_a_standing_wave_on_the_bare_layer_turns_it_either_way(motor):
    """The rotor at rest is an orbit there, too, but a small push grows; which way it then turns is the push's."""
    drive = ts.Drive(load_torque=0.0)
    values = lap_values(motor, drive, Levels(), ts.Schedule(kind="single"), tolerance=1e-4, rotor_mass=0.0)
    still = orbit_from(values, start_of("steady", values), "steady", 0)
    assert still.closed
    assert abs(still.mean_speed) < 1e-9
    assert not still.stable
    speeds = []
    for way in (1, -1):
        pushed = still.state.copy()
        pushed[STATE.index("v")] += way * 1e-3  # of 0.19 m/s, the surface's
        speeds.append(orbit_from(values, pushed, "pushed", 300))
    assert all(orbit.closed and orbit.stable for orbit in speeds)
    assert speeds[0].mean_speed == pytest.approx(-speeds[1].mean_speed, rel=1e-6)
    assert speeds[0].mean_speed > 1


@pytest.mark.parametrize("words", [{"phase_difference": 0.3}, {"ratio": 0.3, "phase_difference": 0.3}])
def test_a_part_of_a_running_wave_turns_it_as_its_mirror_image_does_the_other_way(motor, drive, words):
    """B of the other sign is the mirror image, step for step; B behind by as much is one at other instants."""
    schedule = ts.Schedule(kind="continuous", **words)
    mirrored = ts.Schedule(kind="continuous", **{**words, "phase_difference": 0.3 - math.pi})
    found = drive_orbit(motor, drive, schedule, **QUICK).orbit
    assert found.mean_speed > 1
    ends = []
    for way, one in ((1, schedule), (-1, mirrored)):
        start = found.state * np.array([1, 1, way, way, 1, 1, way])
        end, lap = laps(lap_values(motor, drive, FLANGE, one, tolerance=1e-4, rotor_mass=0.0), start[:, np.newaxis])
        ends.append((end[:, 0] * np.array([1, 1, way, way, 1, 1, way]), way * lap["mean"][0]))
    assert ends[1][0] == pytest.approx(ends[0][0], rel=1e-7, abs=1e-15)  # rounding at the driving zone's edges
    assert ends[1][1] == pytest.approx(ends[0][1], rel=1e-7)
    behind = ts.Drive(frequency_difference=500.0, load_torque=0.0, phase_lead=-1)
    others = [(drive, mirrored)] if "ratio" in words else [(drive, mirrored), (behind, schedule)]
    for turned, one in others:
        back = drive_orbit(motor, turned, one, **QUICK).orbit
        assert abs(back.mean_speed + found.mean_speed) < back.mean_speed_error + found.mean_speed_error


@pytest.mark.parametrize("lead", [1, -1])
def test_without_reaction_both_phases_swing_as_far_apart_and_as_high_as_they_are_driven(motor, lead):
    """Laps from rest come to the steady swing of two oscillators, whose complex amplitudes are as their forces."""
    drive = ts.Drive(frequency_difference=500.0, load_torque=0.0, phase_lead=lead)
    schedule = ts.Schedule(kind="continuous", phase_difference="40 deg", ratio=0.6, voltage=0.5)
    values = lap_values(motor, drive, FLANGE, schedule, tolerance=1e-6, reaction=False, rotor_mass=0.0)
    state, _ = laps({**values, "m": 1500.0, "on_A": 0.0, "on_B": 0.0}, start_of("rest", values)[:, np.newaxis])
    w_A, v_A, w_B, v_B = state[:4, 0]
    of_A, of_B = complex(w_A, -v_A / values["omega_q"]), complex(w_B, -v_B / values["omega_q"])
    own, turn = values["omega_n0"], values["omega_q"]
    free = 0.5 * values["F_q"] / values["M_q"] / complex(own**2 - turn**2, 2 * values["xi"] * own * turn)
    assert of_A == pytest.approx(free * np.exp(1j * values["force_phase"]), rel=1e-6)
    assert of_B / of_A == pytest.approx(0.6 * np.exp(1j * lead * math.radians(40)), rel=1e-6)


def test_a_burst_is_a_motion_in_time_and_its_energy_adds_up(motor):
    """A cycle of a burst's orbit, two periods on and one off, integrated with all of its work by the witness."""
    from studies.coupling import after

    schedule = ts.Schedule(kind="burst", periods=3, on_periods=2, phase_difference="90 deg")
    drive = ts.Drive(frequency_difference=500.0, load_torque=0.3)
    values = lap_values(motor, drive, FLANGE, schedule, rotor_mass=0.02) | {"force_phase": 0.0}
    orbit = orbit_from(values, start_of("steady", values), "steady", 200)
    assert orbit.closed
    state, work = orbit.state[:, np.newaxis], np.zeros(4)
    for gates in schedule.gates(drive):
        found = after(values, state, 1, 0.02, 1e-9, tuple(gates))
        state, work = found[:7], work + found[7:11, 0]
    sizes = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3])
    assert np.abs((state[:, 0] - orbit.state) / sizes).max() < 1e-5
    time = 3 * 2 * math.pi / values["omega_q"]
    assert orbit.input_power * time == pytest.approx(work[0], rel=1e-6)
    assert work[0] == pytest.approx(work[1:].sum(), rel=1e-5)
    assert orbit.mean_speed * time * 0.3 == pytest.approx(work[3], rel=1e-5)


def test_a_step_from_rest_is_the_witness_s(motor):
    """A burst of one period, then one that is off: how far the rim has come."""
    from studies.coupling import after

    drive = ts.Drive(frequency_difference=500.0, load_torque=0.05)
    values = lap_values(motor, drive, FLANGE, PLAIN, rotor_mass=0.02) | {"force_phase": 0.0}
    begun = start_of("rest", values)
    first = after(values, begun[:, np.newaxis], 1, 0.02, 1e-8, (1.0, 1.0))
    second = after(values, first[:7], 1, 0.02, 1e-8, (0.0, 0.0))
    wanted = (first[10, 0] + second[10, 0]) / 0.05
    found = history_of({**values, "tolerance": 1e-8}, begun, np.array([[1.0, 1.0], [0.0, 0.0]]), 8).angle[-1]
    assert found == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("compliance", ["layer", "flange"])
def test_friction_stops_wave_and_rotor_and_when_it_is_said_to_matters_little(motor, drive, compliance):
    schedule = ts.Schedule(kind="burst", periods=200, on_periods=2)
    values = lap_values(motor, drive, Levels(compliance=compliance), schedule, rotor_mass=0.0)
    begun = start_of("rest", values)[:, np.newaxis]
    steps = []
    for share in (1.0, 3.0):
        end, lap = laps({**values, "held": share * values["held"]}, begun)
        assert not end[[0, 1, 2, 3, 6]].any()
        assert lap["touching"][0] > 0.85  # all of the wave in the pause
        steps.append(float(lap["mean"][0]))
    assert steps[0] == pytest.approx(steps[1], rel=2e-3)


def test_what_rests_moves_again_when_it_is_driven(motor, drive):
    values = lap_values(motor, drive, FLANGE, PLAIN, tolerance=1e-4, rotor_mass=0.0)
    begun = start_of("rest", values)[:, np.newaxis]
    wanted, _ = laps({**values, "m": 2.0}, begun)
    later, lap = laps({**values, "m": 5.0, "on_A": 3.0, "on_B": 3.0}, begun)
    assert later == pytest.approx(wanted, rel=1e-12)
    assert lap["high"][0] > 0


def test_a_rotor_that_still_turns_is_not_at_rest_however_small_the_wave(motor):
    """It begins with the rim at 0.2 m/s, which friction cannot take from it in a drive period."""
    loaded = ts.Drive(frequency_difference=500.0, load_torque=0.0, load_inertia=2.7e-4)
    values = lap_values(motor, loaded, FLANGE, PLAIN, tolerance=1e-4, rotor_mass=0.0)
    begun = start_of("rest", values)
    begun[STATE.index("v")] = 0.2
    slowed = values["mu"] * values["F_c"] * values["r_c"] ** 2 / values["J_total"] * 2 * math.pi / values["omega_q"]
    found = history_of(values, begun, np.zeros((100, 2)), 1)
    assert 0.2 - found.speed[1] * values["r_c"] == pytest.approx(slowed, rel=0.05)
    assert found.speed[-1] == 0


def test_what_is_held_is_what_a_plain_wave_is_held_by(motor):
    """A modal force a little below it leaves the plain wave still, one a little above does not."""
    from trum_sym.model.coupling import held_wave

    values = coupled_values(motor, ts.Drive(on_periods=20, load_torque=0.2), FLANGE)
    force = held_wave(values) * values["M_q"] * values["omega_n0"] ** 2
    assert "still" in plain_waves({**values, "F_q": 0.999 * force}).names
    assert "still" not in plain_waves({**values, "F_q": 1.001 * force}).names
    assert held_wave({**values, "T_load": 2.0}) == 0


def test_a_rotor_with_a_mass_rests_while_it_still_goes_up_and_down(motor):
    drive = ts.Drive(frequency_difference=500.0, load_torque=0.05)
    values = lap_values(motor, drive, FLANGE, ts.Schedule(kind="burst", periods=60, on_periods=1), rotor_mass=0.02)
    end, _ = laps(values, start_of("rest", values)[:, np.newaxis])
    assert not end[[0, 1, 2, 3, 6]].any()
    assert abs(end[5, 0]) > 0


def test_a_motor_starts_from_rest_and_stops(motor, drive):
    found = drive_history(
        motor, drive, PLAIN, cycles=200, pause=100, compliance="flange", tolerance=1e-4, rotor_mass=0.0
    )
    plain = plain_waves(
        coupled_values(motor, ts.Drive(frequency_difference=500.0, load_torque=0.0, on_periods=20), FLANGE)
    )
    driven = found.driven[:, 0] == 1
    last = np.flatnonzero(driven)[-1] + 1
    assert found.wave[0] == found.speed[0] == found.wave[-1] == found.speed[-1] == 0
    assert found.wave[last] == pytest.approx(plain.amplitude[-1], rel=1e-3)
    assert found.speed[last] == pytest.approx(plain.speed[-1], rel=1e-3)
    assert found.time[-1] == pytest.approx(300 * found.time[last] / 200)
    assert found.angle[-1] > found.angle[last]
    assert not found.input_power[~driven].any()


@pytest.mark.parametrize("off_terminals", ["short", "open"])
def test_parts_of_a_lap_are_the_lap(motor, off_terminals):
    schedule = ts.Schedule(periods=4, on_periods=3, off_terminals=off_terminals)
    values = lap_values(motor, ts.Drive(), FLANGE, schedule, rotor_mass=0.02) | {"tolerance": 1e-10}
    begun = start_of("steady", values)
    end, lap = laps(values, begun[:, np.newaxis])
    found = history_of(values, begun, schedule.gates(ts.Drive()), 16)
    sizes = values["size"] * np.array([1, values["omega_n0"]] * 3 + [values["D"] * values["k_c"] * values["omega_n0"]])
    assert np.abs((found.states[:, -1] - end[:, 0]) / sizes).max() < 3e-8  # some hundred steps of 1e-10
    assert found.angle[-1] / found.time[-1] == pytest.approx(float(lap["mean"][0]) / values["r_c"], rel=1e-8)
    assert found.input_power.mean() == pytest.approx(float(lap["input"][0]), rel=1e-8)


def test_a_phase_that_was_never_driven_holds_no_charge(motor, drive):
    """From rest A is off first: open, it is only stiffer; no voltage of before holds it aside."""
    schedule = ts.Schedule(periods=4, on_periods=3, off_terminals="open")
    few = {"samples_per_period": 4, "tolerance": 1e-4, "rotor_mass": 0.0}
    found = drive_history(motor, drive, schedule, compliance="flange", **few)
    assert np.abs(found.states[0, 1]) < 0.02 * np.abs(found.states[2, 1])
    with pytest.raises(ts.ParameterError, match="pause: got 3, need 0 where off_terminals is open"):
        drive_history(motor, drive, schedule, pause=3)


def test_single_with_an_open_phase_is_stiffer_there_alone(motor, drive):
    """B, which a standing wave of A leaves at rest, counts for how small disturbances die out, not for the orbit."""
    orbits = [
        drive_orbit(motor, drive, ts.Schedule(kind="single", off_terminals=terminals), **QUICK).orbit
        for terminals in ("short", "open")
    ]
    assert orbits[1].highest_wave == pytest.approx(orbits[0].highest_wave, rel=1e-6)
    turns = [np.sort(np.abs(np.angle(orbit.multipliers))) for orbit in orbits]  # of the rotor, B twice, A twice
    assert (turns[1][1:3] > 1.5 * turns[0][1:3]).all()
    assert turns[1][3:] == pytest.approx(turns[0][3:], rel=0.02)


def test_gates_are_the_three_spans_of_the_superimposed_pulses():
    gates = ts.Schedule(periods=5, on_periods=3).gates(ts.Drive())
    assert gates[:, 0].tolist() == [0, 0, 1, 1, 1]
    assert gates[:, 1].tolist() == [1, 1, 0, 0, 1]
    assert ts.Schedule().gates(ts.Drive()).sum(axis=0).tolist() == [14, 14]
    assert ts.Schedule(kind="single").gates(ts.Drive()).tolist() == [[1, 0]]


def test_an_encoder_reads_what_the_product_s_reads_of_the_same_path():
    rng = np.random.default_rng(1)
    angle = np.concatenate([[0.0], np.cumsum(rng.uniform(-1, 1.5, 40))])
    time = np.arange(41) / 40 * 5e-4
    spread, low, high = read_by_encoder(time, angle, 2.21e-3)
    starts = (np.arange(200_000) + 0.5) / 200_000
    readings = encoder_readings(angle[1:], 5e-4, 2.21e-3, starts)
    assert spread == pytest.approx(np.std(readings), rel=1e-6)
    assert (low, high) == pytest.approx((readings.min(), readings.max()), rel=1e-3)
    assert high > low


def test_an_answer_is_a_table_and_a_record(motor, drive):
    schedule = ts.Schedule(kind="burst", periods=1000, on_periods=1)
    found = ts.drive_orbit(
        motor, drive, schedule, compliance="flange", sampling_period="2 ms", tolerance=1e-4, rotor_mass=0.0
    )
    record = found.to_dict()
    assert record["schedule"]["kind"] == "burst"
    assert record["closed"]
    assert record["encoder_deviation"] == found.encoder_deviation > 0
    assert found.encoder_low == 0  # the pause is longer than 2 ms
    assert "mean speed" in found.to_text()
    assert "TRUM-60, burst, 1 of 1000 periods on, at 180 N" in found.to_text()
    assert "from rest: closed after 1 cycle, attracts\n" in found.to_text()
    assert found.converged is record["converged"] is True
    assert '"mean_speed"' in found.to_json()


@pytest.mark.parametrize(
    ("words", "naming"),
    [
        ({"kind": "bursts"}, "kind: got bursts, need one of pulses, burst, single, continuous"),
        ({"kind": "burst", "periods": 10}, "on_periods: got none, need an integer >= 1 for a burst"),
        ({"kind": "burst", "periods": 10, "on_periods": 0}, "on_periods: got 0"),
        ({"kind": "single", "periods": 10}, "periods: got 10, need none where the schedule is single"),
        ({"kind": "single", "ratio": 0.5}, "ratio: got 0.5, need none where the schedule is single"),
        ({"voltage": 0.0}, "voltage: got 0"),
        ({"ratio": -0.5}, "ratio: got -0.5"),
        ({"phase_difference": 4.0}, "phase_difference: got 4.0"),
        ({"phase_difference": "4 N"}, "phase_difference: got 4 N"),
        ({"off_terminals": "none"}, "off_terminals: got none, need one of short, open"),
        (
            {"kind": "burst", "periods": 9, "on_periods": 3, "off_terminals": "open"},
            "off_terminals: got open, need short where the schedule is burst: a charge would hold the wave aside",
        ),
        (
            {"kind": "continuous", "off_terminals": "open"},
            "need short where the schedule is continuous: no phase is off",
        ),
    ],
)
def test_a_schedule_that_is_none_is_refused(words, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        ts.Schedule(**words)


@pytest.mark.parametrize(
    ("words", "naming"),
    [
        ({"schedule": "burst"}, "schedule: got burst, need a Schedule"),
        ({"schedule": ts.Schedule(kind="burst", periods=3, on_periods=4)}, "on_periods: got 4"),
        ({"schedule": ts.Schedule(periods=10, on_periods=4)}, "on_periods: got 4, need an integer from periods/2"),
        ({"start": "moving"}, "start: got moving"),
        ({"coupling": "none"}, "coupling: got none, need contact"),
        ({"tangential": "brush"}, "coupling: got contact, need none where tangential is brush"),
        ({"sampling_period": 0}, "sampling_period: got 0"),
        ({"tolerance": 1}, "tolerance: got 1"),
        ({"rotor_mass": -1}, "rotor_mass: got -1"),
        ({"drive": ts.Drive(start="rest")}, "start: got rest, need periodic"),
        ({"drive": ts.Drive(load_torque=[0.1, 0.2])}, "load_torque: got an array"),
        ({"motor": "trum60"}, "motor: got trum60, need a Motor"),
    ],
)
def test_what_no_orbit_can_be_found_of_is_refused(words, naming):
    with pytest.raises(ts.ParameterError, match=naming):
        drive_orbit(**words)


def test_a_drive_s_orbit_is_certified_where_it_is_asked_for(motor):
    found = drive_orbit(motor, ts.Drive(), ts.Schedule(), certify=True, **QUICK)
    assert found.certificate is not None
    assert found.certificate.certified
    values = lap_values(motor, ts.Drive(), Levels(compliance="flange"), rotor_mass=0.0, tolerance=1e-4)
    own = certificate_of(values, found.orbit)
    assert found.certificate.radius == own.radius
    assert "certified: begins within" in found.to_text()
    assert "stable for certain" in found.to_text()
    record = found.to_dict()["certificate"]
    assert record["radius"] == own.radius
    assert record["largest_multiplier_error"] == max(own.multiplier_error)
    plain = drive_orbit(motor, ts.Drive(), ts.Schedule(), **QUICK)
    assert plain.certificate is None
    assert "certified" not in plain.to_text()
    assert "certificate" not in plain.to_dict()
    wild = ts.Drive(load_torque=0.1, frequency_difference=2000.0)  # closes on no instruction set
    lost = drive_orbit(motor, wild, ts.Schedule(), certify=True, rotor_mass=0.005, tolerance=1e-4, start="rest")
    assert "not certified: " in lost.to_text()


@pytest.mark.parametrize(
    ("words", "peak", "mass"),
    [
        ({}, 1.0, 0.02),
        ({"kind": "continuous"}, 1.0, 0.0),
        ({"kind": "single"}, 1.0, 0.0),
        ({"ratio": 2.0}, 2.0, 0.0),
        ({"phase_difference": 0.0}, math.sqrt(2), 0.0),
        ({"phase_difference": math.radians(60), "ratio": 1.0}, math.sqrt(1.5), 0.0),
        ({"off_terminals": "open"}, math.sqrt(2), 0.0),
    ],
)
def test_forces_that_friction_holds_move_nothing(motor, words, peak, mass):
    """Up to the plain wave's dead zone; such laps were stepped through a chatter of friction for minutes."""
    load = 0.2
    of_plain = coupled_values(motor, ts.Drive(load_torque=load, on_periods=20), Levels())
    voltage = standing(of_plain)[1] / of_plain["F_q"] / peak
    for share in (1e-320, 1e-3, 0.999):
        found = drive_orbit(
            motor, ts.Drive(load_torque=load), ts.Schedule(**{**words, "voltage": share * voltage}), rotor_mass=mass
        )
        assert (found.orbit.closed, found.orbit.stable, found.orbit.highest_wave) == (True, True, 0.0)
        assert not found.history.angle.any()
    more = lap_values(
        motor,
        ts.Drive(load_torque=load),
        Levels(),
        ts.Schedule(**{**words, "voltage": 1.01 * voltage}),
        rotor_mass=mass,
    )
    _, lap = laps(
        {**more, "m": 1.0, "off_A": 0.0, "off_B": 0.0, "on_A": 0.0, "on_B": 0.0}, start_of("rest", more)[:, None]
    )
    if words.get("off_terminals") != "open":  # whose largest force is of charges that this lap does not have
        assert lap["highest"][0] > 0
