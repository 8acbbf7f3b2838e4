"""Speed in closed loop: the plant against orbits, the phases carried on, the loop's margins, what drifts taken up."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from trum_sym import console
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import response
from trum_sym.model.levels import Levels
from trum_sym.studies.loop import Loop, loop_at
from trum_sym.studies.loop import _margins as margins
from trum_sym.studies.speed_table_result import Segment, SpeedTable
from trum_sym.studies.track import Disturbance, _carried, _Course, _Plant, _State, track

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
LEVELS = Levels()
DRIVE = ts.Drive(load_torque=0.1, prepressure=180.0, frequency_difference=2964.35)
HEAVY = ts.Drive(start="rest", phase_lead=-1, load_inertia=1e-3, prepressure=180.0, frequency_difference=3177.0)


def table_of(drive, low, high):
    """A table of two entries by ts.evaluate, which takes no search."""
    differences = np.array([drive.frequency_difference - 3, drive.frequency_difference + 3])
    point = ts.evaluate(drive=replace(drive, frequency_difference=differences), tolerance=1e-9)
    order = np.argsort(point.mean_speed)
    entries = Segment(
        speed=np.asarray(point.mean_speed)[order],
        speed_error=np.zeros(2),
        deviation=np.zeros(2),
        drive_frequency=np.asarray(point.drive_frequency)[order],
        drive={"frequency_difference": differences[order]},
    )
    return SpeedTable(
        motor="TRUM-60", drive=drive, variables=("frequency_difference",), segments=(entries,), gaps=(), error=0.1,
        largest_error=0.1, floor=low, reachable=(low, high), evaluations=2,
        inputs=ts.evaluate(drive=drive).inputs,
    )  # fmt: skip


def test_without_disturbances_and_control_the_rotor_comes_to_its_orbit():
    """Cycle by cycle, with phases that go on: mean speed and phases are those of the orbit."""
    plant = _Plant(ts.load_motor("trum60"), DRIVE, LEVELS, ())
    course, state = _Course(plant), _State(0.0, 0.0, 0.0, None)
    point = ts.evaluate(drive=DRIVE, tolerance=1e-9)
    ends = [course.to(state, k * point.cycle_time, 2964.35) for k in range(1, 8)]
    speeds = np.diff(ends) / point.cycle_time / plant.radius
    assert speeds[-1] == pytest.approx(point.mean_speed, abs=1e-6 * abs(point.max_speed))
    first = response(0.0, {**plant.start.values}, plant.start.stator.D, plant.start.stator.k_c)
    scale = float(plant.start.stator.W)
    for name in ("w_A", "w_B"):
        assert state.phases[name] == pytest.approx(scale * first[name], abs=1e-9 * scale)


def test_phases_go_on_where_the_frequency_changes():
    """Displacement and velocity at a cycle's first instant are those that the one before has left."""
    plant = _Plant(ts.load_motor("trum60"), DRIVE, LEVELS, ())
    course, state = _Course(plant), _State(0.0, 0.0, 0.0, None)
    course.to(state, 1e-4, 2964.35)
    left = dict(state.phases)
    case = plant.case(state.time, 3100.0)
    values = _carried(case, left)
    begun = response(1e-12, values, case.stator.D, case.stator.k_c)
    size = float(case.stator.W) * float(case.stator.omega_n)
    for name in ("w_A", "w_B"):
        assert begun[name] == pytest.approx(left[name], abs=1e-6 * float(case.stator.W))
    for name in ("v_A", "v_B"):
        assert begun[name] == pytest.approx(left[name], abs=1e-6 * size)


def test_gains_follow_from_slope_and_pole_and_the_loop_is_stable():
    loop = loop_at(ts.load_motor("trum60"), HEAVY, LEVELS, 2e-3)
    slope = ts.sensitivities(drive=HEAVY, tolerance=1e-9)["mean_speed"]["frequency_difference"]
    assert loop.slope == pytest.approx(slope, rel=1e-6)
    left = max(0.5, loop.rotor)
    assert loop.integral == pytest.approx((1 - left) / slope, rel=1e-9)
    assert loop.proportional == pytest.approx(loop.integral * loop.rotor / (1 - loop.rotor), rel=1e-9)
    assert loop.gain_margin > 2
    light = loop_at(ts.load_motor("trum60"), DRIVE, LEVELS, 2e-3)
    assert light.rotor < 1e-6
    assert light.integral * light.slope == pytest.approx(0.5)


@pytest.mark.parametrize(("rotor", "stator"), [(1e-9, 0.05), (0.3, 0.05), (0.8, 0.01), (0.95, 0.2)])
def test_at_its_gain_margin_a_loop_is_about_to_be_unstable(rotor, stator):
    """Poles of the closed loop from the recursion itself: inside the circle below the margin, outside above."""
    left = max(0.5, rotor)
    together = (1 - left) / (1 - rotor)
    proportional, integral = rotor * together, (1 - rotor) * together
    gain, phase = margins(1.0, rotor, stator, proportional, integral)
    assert 0 < phase <= np.pi
    lag = -1 / np.log(rotor)
    mean = lag * (1 - rotor)

    def largest(slope):
        # states: rotor's speed, stator's filter of the command, command; reading = mean speed of the period before
        poly = np.polynomial.polynomial
        motor_top = slope * poly.polyadd([-(1 - mean) * rotor, 1 - mean], [mean * (1 - rotor)])
        motor_below = poly.polymul([0, 1], [-rotor, 1])
        stator_top, stator_below = [0, 1 - stator], [-stator, 1]
        control_top, control_below = [-proportional, proportional + integral], [-1, 1]
        top = poly.polymul(poly.polymul(motor_top, stator_top), control_top)
        below = poly.polymul(poly.polymul(motor_below, stator_below), control_below)
        return np.max(np.abs(np.roots(poly.polyadd(top, below)[::-1])))

    assert largest(0.98 * gain) < 1 < largest(1.02 * gain)


@pytest.fixture(scope="module")
def followed():
    """A heavy rotor for 0.12 s, with a load step."""
    table = table_of(HEAVY, 1e-4, 1.0)
    target = float(np.mean(table.segments[0].speed))
    return track(
        drive=HEAVY, target_speed=target, duration=0.1, table=table,
        disturbances=["load_torque=+1 %@0.04 s", "friction_coefficient=+0.5 %@0.05:0.06 s", "prepressure=+0.1 N@0.05"],
    )  # fmt: skip


def test_a_load_step_is_taken_up_in_closed_loop_and_not_in_open_loop(followed):
    """In open loop the rotor goes to the mean speed that evaluate says of all of them together."""
    last, motor = followed.windows[-1], ts.load_motor("trum60").with_values({"friction_coefficient": 0.25 * 1.005})
    drive = replace(followed.inputs.drive, prepressure=180.1, load_torque=0.3 * 1.01)
    kept = ts.evaluate(drive=followed.inputs.drive).drive_frequency
    drive = replace(drive, frequency_difference=kept - ts.evaluate(motor, drive).resonance_frequency)
    change = ts.evaluate(motor, drive, tolerance=1e-9).mean_speed - followed.target_speed
    assert last["open mean"] - followed.target_speed == pytest.approx(change, rel=0.1)
    assert abs(last["closed mean"] - followed.target_speed) < 0.1 * abs(change)
    assert followed.loop.gain_margin > 2


def test_readings_are_whole_counts(followed):
    count = 2 * np.pi / followed.encoder_counts / followed.control_period
    for run in (followed.closed, followed.open):
        assert run.reading / count == pytest.approx(np.round(run.reading / count), abs=1e-6)
        assert np.abs(run.reading - run.speed).max() <= count
    assert np.all(np.diff(followed.open.frequency_difference) == 0)


def test_the_frequency_stays_where_the_speed_still_follows_it(followed):
    low, high = followed.reach.frequencies
    assert np.all((followed.closed.frequency_difference >= low) & (followed.closed.frequency_difference <= high))
    there = np.linspace(low, high, 41)
    speeds = np.asarray(ts.evaluate(drive=replace(HEAVY, frequency_difference=there)).mean_speed)
    assert np.mean(np.sign(np.diff(speeds)) == np.sign(followed.loop.slope)) > 0.95


def test_what_is_told_of_it(followed):
    text = followed.to_text()
    assert "load torque +1 % at 0.04 s" in text
    assert "friction coefficient +0.5 % from 0.05 to 0.06 s" in text
    record = followed.to_dict()
    assert len(record["closed"]["time"]) == 50
    assert record["units"]["target_speed"] == "rad/s"
    few = replace(followed, encoder_counts=1000)
    assert any("one count in a control period" in remark for remark in few.remarks)
    wild = replace(followed, loop=replace(followed.loop, gain_margin=1.5))
    assert isinstance(wild.loop, Loop)
    assert any("unstable where the motor's slope is 1.5 times" in remark for remark in wild.remarks)
    beyond = replace(followed, changes=(1e3, 0.0, 0.0))
    assert any("no frequency that may be set takes up load torque" in remark for remark in beyond.remarks)


def test_a_ramp_comes_evenly_and_a_step_at_once():
    ramp = Disturbance("prepressure", 1.0, False, 0.1, 0.2)
    assert [ramp.at(t) for t in (0.0, 0.1, 0.15, 0.2, 1.0)] == pytest.approx([0, 0, 0.5, 1, 1])
    step = Disturbance("load_torque", 0.01, True, 0.1, 0.1)
    assert [step.at(t) for t in (0.09, 0.1)] == [0.0, 1.0]


def test_the_console_tracks_and_draws(capsys, tmp_path):
    picture = tmp_path / "track.png"
    line = ["track", "--target-speed", "100000 arcsec/s", "--load-torque", "0.1", "--prepressure", "180"]
    line += ["--duration", "10 ms", "--plot", str(picture)]
    assert console.main([*line, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["target_speed"] == pytest.approx(100000 * ARCSEC)
    assert len(record["disturbances"]) == 4
    assert picture.read_bytes().startswith(b"\x89PNG")


TRACK = ("track", "--target-speed", "1", "--prepressure", "180", "--load-torque", "0.1")
BAD = [
    (("--duration", "1 ms"), ("--duration: got 1 ms", "> 0.002")),
    (("--control-period", "0"), ("--control-period: got 0", "> 0")),
    (("--encoder-counts", "0.5"), ("--encoder-counts: got 0.5", ">= 1")),
    (("--disturb", "voltage=1@0.1"), ("--disturb: got voltage", "prepressure")),
    (("--disturb", "load_torque=1 %"), ("--disturb: got load_torque=1 %", "NAME=CHANGE@TIME")),
    (("--disturb", "load_torque=1 N@0.1"), ("change of load_torque: got 1 N", "N*m")),
    (("--disturb", "load_torque=1 %@0.2:0.1"), ("time of load_torque: got 0.2 to 0.1 s", "after it begins")),
    (("--disturb", "load_torque=1 %@9"), ("time of load_torque: got 9", "<= 0.5")),
]


@pytest.mark.parametrize(("arguments", "naming"), BAD, ids=[" ".join(a) for a, _ in BAD])
def test_bad_input_is_one_line(console_refuses, monkeypatch, arguments, naming):
    monkeypatch.setattr("trum_sym.studies.track.speed_table", lambda *_, **__: table_of(DRIVE, 0.1, 2.0))
    monkeypatch.setattr(SpeedTable, "at", lambda *_: {"frequency_difference": 2964.35})
    console_refuses(*TRACK, *arguments, naming=naming)
