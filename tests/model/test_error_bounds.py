"""Stated errors hold: against closed forms, an independent integration, and the program's own answers elsewhere."""

from __future__ import annotations

import datetime
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import solve_orbit

bounds, fuzz_points = lazily("studies.bounds"), lazily("studies.fuzz_points")
FIGURES = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque")


def plain_wave(motor, drive, point):
    """The rotor's speed under a plain wave, where friction within the angle a balances the load (eqs. 35, 36)."""
    radius, friction = float(motor.contact_radius.value), float(motor.friction_coefficient.value)
    theta = math.pi * float(point.contact_fraction)
    share = -drive.load_torque / (friction * drive.prepressure * radius)
    within = 0.5 * (1 - share) * (math.sin(theta) - theta * math.cos(theta))
    low, high = 0.0, theta
    for _ in range(200):
        a = 0.5 * (low + high)
        low, high = (low, a) if math.sin(a) - a * math.cos(theta) > within else (a, high)
    omega = 2 * math.pi * float(point.drive_frequency)
    return omega * float(point.wavenumber) * float(point.neutral_axis) * float(point.amplitude) * math.cos(low) / radius


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-6, None])
def test_a_plain_wave_near_the_limit_is_its_closed_form(trum60, tolerance):
    drive = ts.Drive(prepressure=100.0, periods=1, on_periods=1, load_torque=-0.6592)
    point = ts.evaluate(trum60, drive, tolerance=tolerance)
    exact = plain_wave(trum60, drive, ts.evaluate(trum60, drive, tolerance=1e-9))
    assert exact == pytest.approx(70.43, abs=0.01)
    assert point.converged
    assert abs(point.mean_speed - exact) <= point.mean_speed_error + 1e-9


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_a_hertz_contact_near_the_limit_is_the_same_at_every_tolerance(trum60, tolerance):
    force = 128.93640652170959
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=-310.79918776885097,
        periods=1,
        on_periods=1,
        load_torque=-0.9714271290346224 * 0.25 * force * 0.0265,
    )
    point = ts.evaluate(trum60, drive, contact="hertz", tolerance=tolerance)
    assert abs(point.mean_speed - 56.848) <= point.mean_speed_error + 5e-4


def test_steps_that_newton_closes_at_once_are_held_by_their_error(trum60):
    """After a brief end of saturation the first change is small, and friction at the nodes is bent all the same."""
    force = 195.3869747678116
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=-1544.892903773416,
        periods=4,
        on_periods=2,
        switching_phase=5.1795400351385235,
        load_torque=-0.999984393861415 * 0.25 * force * 0.0265,
        start="steady",
    )
    point = ts.evaluate(trum60, drive, contact="hertz", tolerance=1.7e-7)
    exact = ts.evaluate(trum60, drive, contact="hertz", tolerance=1e-9)
    assert exact.mean_speed == pytest.approx(1.3606523532 / 0.0265, abs=1e-8)  # studies/witness.py
    assert point.converged
    assert abs(point.mean_speed - exact.mean_speed) <= point.mean_speed_error


def test_a_light_rotor_that_comes_to_saturation_within_a_step_is_held_by_its_error(trum60):
    """Newton's changes shrink on the way to a saturation that they never reach, and a step's solution is beyond it."""
    friction, force = 0.23220205620493115, 108.7405256923835
    motor = trum60.with_values({"rotor_inertia": 6.451792712046227e-08, "friction_coefficient": friction})
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=153.79530026568864,
        periods=38,
        on_periods=27,
        switching_phase=3.706555180865205,
        load_torque=-0.9420349638351031 * friction * force * 0.0265,
        start="steady",
    )
    point = ts.evaluate(motor, drive, tolerance=0.0008566866184656968)
    assert point.converged
    assert abs(point.mean_speed - 1.39041005061 / 0.0265) <= point.mean_speed_error  # studies/witness.py


# Each does not converge without one mend: the bound by the surface's speed, speeds counted from 0, shorter steps there
STOPPING = {
    "bound": {
        "values": {"rotor_inertia": 3.0463196756974867e-09, "friction_coefficient": 0.2591806064315312},
        "drive": {"prepressure": 207.39698196398095, "frequency_difference": 1219.491230023902},
        "cycle": {"periods": 3, "on_periods": 2, "switching_phase": 5.626565881885601, "phase_lead": -1},
        "share": -0.9774780830022997,
        "options": {"contact": "hertz", "tolerance": 1.3145224995305368e-09},
    },
    "reference": {
        "values": {"rotor_inertia": 2.0444760783315993e-09, "friction_coefficient": 0.26865153817138354},
        "drive": {"prepressure": 211.10400203216886, "frequency_difference": 455.9463640023887},
        "cycle": {"periods": 6, "on_periods": 5, "switching_phase": 4.855938010567319},
        "share": -0.997752567399215,
        "options": {"contact": "hertz", "tolerance": 1.9753236281279625e-08},
    },
    "shortest step": {
        "values": {"rotor_inertia": 1.2743389240156535e-09, "friction_coefficient": 0.27234848395635985},
        "drive": {"prepressure": 106.71784014811047, "frequency_difference": 293.2049395351687},
        "cycle": {"periods": 9, "on_periods": 6, "phase_lead": -1},
        "share": 0.36979614764049334,
        "options": {"tolerance": 2.3242657011612757e-09},
    },
}


@pytest.mark.parametrize("case", STOPPING.values(), ids=list(STOPPING))
def test_a_light_rotor_that_stops_with_the_surface_knows_how_slow_it_was(trum60, case):
    """From rest the wave stands still twice a period until both phases are on: there friction is infinitely steep."""
    motor, share = trum60.with_values(case["values"]), case["share"]
    load = share * case["values"]["friction_coefficient"] * case["drive"]["prepressure"] * 0.0265
    drive = ts.Drive(**case["drive"], **case["cycle"], load_torque=load, start="rest")
    point = ts.evaluate(motor, drive, **case["options"])
    assert point.converged
    slowest, error = (point.min_speed, point.min_speed_error) if share < 0 else (point.max_speed, point.max_speed_error)
    assert abs(slowest) <= error  # it stops; friction never drives it against the load's direction


def test_rounding_does_not_hold_the_length_of_steps(trum60):
    """After the shortest step, whose error is rounding, steps grow again; they stayed as short to the lap's end."""
    friction, force = 0.22564927670817728, 178.99184418052397
    motor = trum60.with_values({"rotor_inertia": 2.2639380268390183e-09, "friction_coefficient": friction})
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=-2792.3195933355173,
        periods=2,
        on_periods=1,
        load_torque=-0.9982134285453587 * friction * force * 0.0265,
        start="steady",
    )
    fine, coarse = (ts.evaluate(motor, drive, tolerance=tolerance) for tolerance in (1.0608321754513768e-09, 1e-5))
    assert fine.converged
    assert abs(fine.mean_speed - coarse.mean_speed) <= coarse.mean_speed_error


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 8.96153987144326e-09, 5e-9, 1e-9])
def test_a_peak_of_friction_that_steps_pass_over_is_in_the_bound(trum60, tolerance):
    """The wave of a start from rest, 9e-15 m high where it passes zero: friction peaks for 5e-9 drive periods."""
    drive = ts.Drive(
        prepressure=164.89141065680303,
        frequency_difference=-2641.7417594596004,
        periods=2,
        on_periods=1,
        switching_phase=1.2515251344676794,
        phase_lead=-1,
        load_torque=-0.3121710830350415 * 0.25 * 164.89141065680303 * 0.0265,
        start="rest",
    )
    point = ts.evaluate(trum60, drive, contact="hertz", tolerance=tolerance)
    limit = 0.25 * 164.89141065680303 * 0.0265
    exact = 0.3659265783260 * limit  # studies/witness.py, to 1e-13 of the limit
    assert point.converged
    assert abs(abs(point.stall_torque) - exact) <= point.stall_torque_error + 1e-12 * limit


def random_drives(seed, count, nearest):
    rng = np.random.default_rng(seed)
    periods, force = rng.integers(1, 31, count), rng.uniform(100, 220, count)
    share = (1 - 10 ** rng.uniform(np.log10(nearest), -0.3, count)) * rng.choice([-1, 1], count)
    return ts.Drive(
        prepressure=force,
        frequency_difference=rng.uniform(-5000, 5000, count),
        periods=periods,
        on_periods=rng.integers((periods + 1) // 2, periods + 1),
        load_torque=share * 0.25 * force * 0.0265,
        start="steady",
    )


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_coarse_answers_hold_what_they_state_beside_fine_ones(trum60, tolerance):
    """Extremes that a coarse search overlooks, deviations of zero beside a swing: loads to 1e-4 of the limit."""
    drive = random_drives(7, 300, 1e-4)
    coarse, fine = (ts.evaluate(trum60, drive, tolerance=t) for t in (tolerance, 1e-8))
    assert coarse.converged.all()
    assert fine.converged.all()
    for name in FIGURES:
        off = np.abs(getattr(coarse, name) - getattr(fine, name))
        allowed = getattr(coarse, f"{name}_error") + getattr(fine, f"{name}_error")
        assert np.all((off <= allowed) | (off < 1e-12)), name
    swings = fine.max_speed - fine.min_speed > 1e-6 * np.abs(fine.mean_speed)
    flat = (coarse.speed_volatility == 0) & swings & (coarse.min_speed < coarse.max_speed)
    assert np.all(coarse.speed_volatility_error[flat] >= fine.speed_volatility[flat])


def test_a_light_rotor_below_the_limit_has_a_speed(trum60, capsys):
    """Beside an implicit integration of its own (studies/witness.py): 23.8400 rad/s, from 20.3442 to 27.1769."""
    light = trum60.with_values({"rotor_inertia": 4.5e-9})
    point = ts.evaluate(light, ts.Drive(load_torque=-1.1, periods=2, on_periods=1))
    assert point.converged
    for found, error, expected in (
        (point.mean_speed, point.mean_speed_error, 23.83999629),
        (point.min_speed, point.min_speed_error, 20.34423863),
        (point.max_speed, point.max_speed_error, 27.17687954),
    ):
        assert abs(found - expected) <= error + 5e-8
    given = ["--set", "rotor_inertia=4.5e-9", "--load-torque", "-1.1", "--periods", "2", "--on-periods", "1"]
    assert main(["evaluate", *given]) == 0
    assert "no speed balances" not in capsys.readouterr().out


@pytest.mark.parametrize("load", [1.1926, -1.1926, 100.0])
def test_a_load_beyond_friction_is_said_from_the_load_and_ends_with_1(trum60, capsys, load):
    point = ts.evaluate(trum60, ts.Drive(load_torque=load))
    assert np.isnan(point.mean_speed)
    assert not point.converged
    assert point.reason == "no speed balances the load: it exceeds what friction can transmit"
    assert math.isfinite(point.stall_torque)
    for command in ("evaluate", "simulate"):
        assert main([command, "--load-torque", str(load)]) == 1
        assert point.reason in capsys.readouterr().out


def printed(text, label):
    """A value and its error in a table."""
    value, error = re.search(rf"^{re.escape(label)} +(\S+)(?:  (\S+))?", text, re.MULTILINE).groups()
    return float(value), float(error)


def test_an_optimum_pasted_as_printed_gives_the_speed_that_was_asked_for(capsys, tmp_path):
    assert main(["optimize", "--target-speed", "633 arcsec/s"]) == 0
    text = capsys.readouterr().out
    place = [
        *("--prepressure", re.search(r"^prepressure +(\S+)", text, re.M)[1]),
        *("--frequency-difference", re.search(r"^frequency difference +(\S+)", text, re.M)[1]),
    ]
    speed, error = printed(text, "mean speed v_s")
    assert abs(speed - 633) <= error
    assert main(["evaluate", *place]) == 0
    other, other_error = printed(capsys.readouterr().out, "mean speed v_s")
    assert abs(other - speed) <= error + other_error
    assert other_error <= 633 * 1e-4
    path = tmp_path / "history.csv"
    assert main(["simulate", *place, "--out", str(path)]) == 0
    columns = np.loadtxt(path, delimiter=",", skiprows=1)
    header = path.read_text().splitlines()[0].split(",")
    time, angle = (columns[:, header.index(name)] for name in ("time [s]", "rotor_angle [rad]"))
    speeds = columns[:, header.index("rotor_speed [rad/s]")]
    whole = time[-1] + (time[1] - time[0])
    advance = angle[-1] - angle[0] + 0.5 * (speeds[-1] + speeds[0]) * (time[1] - time[0])
    assert advance / whole / (math.pi / 648000) == pytest.approx(633, abs=2)  # the last sample's trapezium


def test_a_speed_tables_entries_have_the_speeds_that_they_state(trum60):
    table = ts.speed_table(
        trum60, slowest="500 arcsec/s", fastest="1000 arcsec/s", points=3, bounds={"prepressure": 177.3}, error=0.5
    )
    assert table.segments
    for segment in table.segments:
        for speed, error, *drive in zip(segment.speed, segment.speed_error, *table.values(segment), strict=True):
            given = dict(zip(table.columns(), drive, strict=True))
            names = {
                name: float(value) for name, value in given.items() if name in ("prepressure", "frequency_difference")
            }
            point = ts.evaluate(trum60, ts.Drive(**{"prepressure": 177.3, **names}))
            assert abs(point.mean_speed - speed) <= point.mean_speed_error + error
            assert error <= 1e-5 * abs(speed)


def test_a_forced_batch_has_the_bits_of_its_points(trum60):
    force = np.linspace(110, 210, 7)
    batch = ts.evaluate(trum60, ts.Drive(prepressure=force), amplitude="forced", tolerance=1e-3)
    for i, each in enumerate(force):
        one = ts.evaluate(trum60, ts.Drive(prepressure=float(each)), amplitude="forced", tolerance=1e-3).figures
        for name in ("amplitude", "resonance_frequency", *FIGURES, *(f"{figure}_error" for figure in FIGURES)):
            assert getattr(batch, name)[i] == one[name], name


@pytest.mark.parametrize("inertia", [1e-8, 1e-7])
def test_a_switched_drive_has_its_bits_beside_plain_waves(trum60, inertia):
    """These are solved at once, as roots, and leave their lanes idle."""
    motor, periods = trum60.with_values({"rotor_inertia": inertia}), 20

    def orbits(on_periods):
        drive = ts.Drive(periods=periods, on_periods=on_periods, load_torque=0.3)
        case = prepare(motor, drive, Levels(), 1e-3)
        given = {**case.arguments, "tolerance": 1e-6, "held": 0.0}
        return solve_orbit(given, case.symbols, method="adaptive").raw

    alone, beside = orbits(np.array([13])), orbits(np.array([13, periods, periods]))
    for name in ("mean", "low", "high", "mean_error"):
        assert beside[name][0] == alone[name][0], name


@pytest.mark.parametrize("height", [1e-9, 1e-8, 1e-7, 5e-6])
def test_contact_and_stall_torque_stay_within_what_is_possible(trum60, height):
    small = trum60.with_values({"amplitude": height})
    for contact in ("winkler", "hertz"):
        point = ts.evaluate(small, ts.Drive(periods=10, on_periods=np.arange(5, 11)), contact=contact)
        assert np.all(point.contact_fraction <= 1)
        assert np.all(np.abs(point.stall_torque) <= 0.25 * 180 * 0.0265)


@pytest.mark.parametrize(("box", "count"), [("stock", 12), ("wave", 60), ("limit", 8)])
def test_a_daily_sample_of_the_studies_holds(box, count):
    """Other points every day: stated beside true errors, as ``python -m studies.bounds`` does it in full."""
    seed = datetime.datetime.now(datetime.UTC).date().toordinal()
    print(f"seed {seed}")
    found = bounds.study(count, seed, box, periods=8)
    assert found.points == count
    assert found.converged == count, f"seed {seed}: {found.text()}"
    assert found.beyond == 0, f"seed {seed}: {found.text()}"


def test_random_points_are_told_right_alone_and_in_a_batch():
    """Other points every day, as ``python -m studies.fuzz_points`` does it in full."""
    seed = datetime.datetime.now(datetime.UTC).date().toordinal()
    assert not fuzz_points.study(600, seed, batch=200), f"seed {seed}"


@pytest.mark.parametrize(
    ("figure", "value", "kind"),
    [
        ("mean_speed", np.nan, "mean_speed is no number, without a reason"),
        ("contact_fraction", 1 + 1e-15, "a contact fraction outside"),
        ("mean_speed", 1e9, "a mean outside the extremes"),
        ("stall_torque", 2.0, "a stall torque beyond"),
        ("mean_speed_error", -1.0, "the bound of mean_speed is negative"),
    ],
)
def test_the_random_points_study_sees_what_is_wrong(monkeypatch, figure, value, kind):
    evaluate = ts.evaluate

    def wrong(*given, **options):
        point = evaluate(*given, **options)
        return replace(point, **{figure: np.full_like(point.mean_speed, value)}) if np.ndim(point.mean_speed) else point

    monkeypatch.setattr(ts, "evaluate", wrong)
    found = fuzz_points.study(20, 1)
    assert any(kind in name for name in found), found


def test_a_search_that_rounding_ends_says_so_and_states_it(trum60):
    """2.5e-6 below the largest load laps draw speeds together by 9e-4, and rounding is 2e-9 of the speed."""
    force, friction, radius = 126.63766228978255, 0.25, float(trum60.contact_radius.value)
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=1739.2558872099016,
        periods=17,
        on_periods=13,
        switching_phase=0.7682100302699351,
        load_torque=0.9999974902754193 * friction * force * radius,
    )
    asked, met = (ts.evaluate(trum60, drive, tolerance=t) for t in (1e-9, 3e-9))
    assert met.converged
    assert not asked.converged
    assert "rounding" in asked.reason
    assert 1e-9 * abs(asked.mean_speed) < asked.mean_speed_error < 3e-9 * abs(asked.mean_speed)
    assert abs(asked.mean_speed - met.mean_speed) < asked.mean_speed_error


NEAR = 0.9999642947911891
NEARLY_SATURATED = (
    {},
    {
        "prepressure": 156.29841222106336,
        "frequency_difference": -2024.160042893016,
        "periods": 21,
        "on_periods": 19,
    },
    {"switching_phase": 0.0, "phase_lead": -1, "start": "periodic"},
)
ONCE_BEYOND = {  # values of the motor, a drive, its share of the limit, a tolerance and the contact
    "a light rotor that the surface slips away from": (
        {"rotor_inertia": 5.663656185497067e-09, "friction_coefficient": 0.2069647210934692},
        {"prepressure": 165.6647235333009, "frequency_difference": -2532.716775333568, "periods": 10, "on_periods": 6},
        {"switching_phase": 5.365836425896212, "phase_lead": -1, "start": "steady"},
        (0.9974659679980307, 1e-6, "winkler"),
    ),
    "a peak that the first step hides": (
        {},
        {"prepressure": 121.68427327699902, "frequency_difference": 50.257859250019465, "periods": 10, "on_periods": 9},
        {"switching_phase": 4.699348499753745, "phase_lead": 1, "start": "periodic"},
        (-0.9938250707310864, 5.764559181804873e-4, "winkler"),
    ),
    "a peak where a light rotor meets a wave that begins": (
        {"rotor_inertia": 1.3793599369902426e-09, "friction_coefficient": 0.21497368905223946},
        {
            "prepressure": 119.19442562101754,
            "frequency_difference": -1093.095624499495,
            "periods": 25,
            "on_periods": 21,
        },
        {"switching_phase": 0.0, "phase_lead": -1, "start": "rest"},
        (0.7255624981894631, 2.394739572848287e-06, "winkler"),
    ),
    "a lap whose slope jumps as a moment without saturation begins": (*NEARLY_SATURATED, (NEAR, 1.1e-7, "hertz")),
    "a moment without saturation that is over before a second node": (*NEARLY_SATURATED, (NEAR, 1e-8, "hertz")),
}


@pytest.mark.parametrize("case", ONCE_BEYOND)
def test_what_was_once_off_by_more_than_it_stated_is_within(trum60, case):
    values, place, rest, (share, tolerance, contact) = ONCE_BEYOND[case]
    motor = trum60.with_values(values)
    friction, radius = float(motor.friction_coefficient.value), float(motor.contact_radius.value)
    drive = ts.Drive(**place, **rest, load_torque=share * friction * place["prepressure"] * radius)
    coarse, fine = (ts.evaluate(motor, drive, contact=contact, tolerance=t) for t in (tolerance, 1e-9))
    for name in ("mean_speed", "min_speed", "max_speed"):
        allowed = getattr(coarse, f"{name}_error") + getattr(fine, f"{name}_error")
        assert abs(getattr(coarse, name) - getattr(fine, name)) <= allowed, name
