"""Schedules of up to a million periods, whose repeated periods are counted.

Apart from what has died away, a schedule's means are a + b/m: a region's begin costs the same however long it is, and
the rest of it repeats one period.  Two short schedules, which are integrated whole, give a and b.
"""

from __future__ import annotations

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import history, solve_orbit

SHORT = np.array([400, 800])
MOTOR = ts.load_motor().with_values({"damping_ratio": 0.03})  # free motion falls to 1e-10 in 120 periods


def at(periods, **drive):
    return ts.Drive(periods=periods, on_periods=7 * np.asarray(periods) // 10, **drive)


@pytest.mark.parametrize(("periods", "tolerance", "start"), [(10**6, 1e-7, "periodic"), (10_010, 1e-4, "rest")])
def test_means_are_those_that_short_schedules_foretell(periods, tolerance, start):
    short = ts.evaluate(MOTOR, at(SHORT, start=start), tolerance=1e-8)
    long = ts.evaluate(MOTOR, at(periods, start=start), tolerance=tolerance)
    assert long.converged

    def foretold(values):
        slope = (values[1] - values[0]) / (1 / SHORT[1] - 1 / SHORT[0])
        return values[1] + slope * (1 / periods - 1 / SHORT[1])

    top = float(np.max(np.abs(short.max_speed)))
    assert long.mean_speed == pytest.approx(foretold(short.mean_speed), abs=long.mean_speed_error + 3e-8 * top)
    stall = foretold(short.stall_torque)
    assert long.stall_torque == pytest.approx(stall, abs=long.stall_torque_error + 1e-7)
    assert long.contact_fraction == pytest.approx(foretold(short.contact_fraction), abs=tolerance + 1e-7)
    squares = foretold((short.speed_volatility * short.mean_speed) ** 2 + short.mean_speed**2)
    deviation = np.sqrt(squares - foretold(short.mean_speed) ** 2)
    volatility = deviation / abs(foretold(short.mean_speed))
    assert long.speed_volatility == pytest.approx(volatility, abs=long.speed_volatility_error + 1e-7 * volatility)
    for name in ("min_speed", "max_speed"):  # of what begins and repeats itself alike
        assert getattr(long, name) == pytest.approx(
            getattr(short, name)[1], abs=getattr(long, f"{name}_error") + 2e-8 * top
        )
    sums = foretold(short.q_average * short.cycle_time * (short.q_ratio + 1) / (short.q_ratio - 1))
    assert sums == pytest.approx(1.0)  # as eq. 43 has it, which is no check of the sums
    ratio = ts.evaluate(MOTOR, at(SHORT[1], start=start)).q_ratio
    assert long.q_ratio > ratio  # the region of both phases grows, whose determinant has one sign


def test_a_lap_that_is_integrated_whole_ends_where_it_began():
    case = prepare(MOTOR, at(10_010), Levels(), 1e-5)
    raw = {name: float(value) for name, value in solve_orbit(case.arguments, case.symbols).raw.items()}
    arguments = {name: float(np.asarray(value)) for name, value in case.arguments.items()}
    whole = history(arguments, {**raw, "level": 1e-2 * raw["level"]}, 2)
    cycle = 2 * np.pi * arguments["m"] / (arguments["omega_n"] + arguments["Delta_omega"])
    assert whole["distance"][-1] / cycle == pytest.approx(raw["mean"], abs=raw["mean_error"])
    assert whole["speed"][-1] == pytest.approx(raw["start"], abs=1e-5 * raw["high"])
    counted = history(arguments, raw, 1)  # of which only the end is wanted
    assert counted["distance"][-1] == pytest.approx(whole["distance"][-1], rel=1e-5)


def test_slopes_are_those_that_short_schedules_foretell():
    short = [ts.sensitivities(MOTOR, at(int(m)), tolerance=1e-7) for m in SHORT]
    long = ts.sensitivities(MOTOR, at(1_000_000), tolerance=1e-6)
    for name, slope in long["mean_speed"].items():
        two = np.array([each["mean_speed"][name] for each in short])
        limit = two[1] + (two[1] - two[0]) / (1 / SHORT[1] - 1 / SHORT[0]) * (1e-6 - 1 / SHORT[1])
        assert slope == pytest.approx(limit, rel=1e-3), name
