"""Figures of points that are to be held: drifts, an encoder's readings, times to come to speed, the worst speed error.

Each takes several orbits or many laps, so their slopes are differences (:mod:`trum_sym.optimiser.model`).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import SPREADING
from trum_sym.inputs.motor import Motor
from trum_sym.model.holding import Asked
from trum_sym.model.operating_point import Case, encoder_deviation_of
from trum_sym.model.rotor import Orbit, solve_orbit
from trum_sym.model.sensitivities import orbit_with_slopes
from trum_sym.model.settling import rim_orbits, settling_time
from trum_sym.model.spreading import amounts_at, mean_speed_off, speeds_off

__all__ = ["COARSE", "DRIFTS", "HELD_FIGURES", "check_asked", "held_figures"]

DRIFTS = {f"{name}_drift": name for name in SPREADING}
"""The most that the spread of an input moves the mean speed by, by the figure's name."""
COARSE = 1e-4
"""Tolerance of orbits from which on a map takes drifts from slopes, which are the dearer and the better ones there."""
_TIMES = {"start_time": ("rest",), "return_time": ("more", "less")}
_OF_SPREADS = frozenset({*DRIFTS, "worst_speed_error"})
HELD_FIGURES: Mapping[str, str] = {
    **dict.fromkeys(DRIFTS, "rad/s"),
    "worst_speed_error": "rad/s",
    "encoder_deviation": "rad/s",
    **dict.fromkeys(_TIMES, "s"),
}
"""All of them with their SI units."""


def check_asked(names: frozenset[str], asked: Asked, target: float | None, motor: Motor) -> None:
    """Refuse figures that need what was not given.

    Raises
    ------
    ParameterError
        For drifts without spreads, an encoder without a period, a speed's error without a target.
    """
    if names & _OF_SPREADS and not asked.amounts:
        raise ParameterError("spreads", "none", "how far inputs may be off: the motor file states none in [spreads]")
    for name in sorted(names & set(DRIFTS)):
        if DRIFTS[name] not in asked.amounts and set(DRIFTS) - names:  # `drift` names all of them
            raise ParameterError("spreads", "none", f"a spread of {DRIFTS[name]}, whose drift is asked for")
    if "encoder_deviation" in names and asked.period(motor) is None:
        raise ParameterError("sampling_period", "none", "the encoder's period: the motor file states none in [bench]")
    if "worst_speed_error" in names and target is None:
        raise ParameterError("target_speed", "none", "a speed in rad/s, from which worst_speed_error is")


def held_figures(
    case: Case, names: frozenset[str], asked: Asked, target: float | None
) -> tuple[Orbit, dict[str, Array]]:
    """The orbits of a case of one dimension, and those of the figures that are named."""
    slopes: dict[str, Array] = {}
    if names & _OF_SPREADS and case.tolerance >= COARSE:
        orbit, by = orbit_with_slopes(case)
        slopes = by["mean_speed"]
    else:
        orbit = solve_orbit(case.arguments, case.symbols)
    found: dict[str, Array] = {}
    if names & _OF_SPREADS:
        found |= _of_spreads(case, names, asked, target, orbit.mean_speed, slopes)
    period = asked.period(case.motor)
    if "encoder_deviation" in names and period is not None:
        found["encoder_deviation"] = encoder_deviation_of(case, orbit, period)
    if names & set(_TIMES):
        sizes = np.abs(orbit.mean_speed) if not target else np.full(np.shape(orbit.mean_speed), abs(target))
        points = rim_orbits(case, orbit)
        for figure in names & set(_TIMES):
            times = [
                settling_time(point, _TIMES[figure], asked.within * size)
                for point, size in zip(points, np.ravel(sizes), strict=True)
            ]
            found[figure] = np.array(times).reshape(np.shape(orbit.mean_speed))
    return orbit, found


def _of_spreads(
    case: Case, names: frozenset[str], asked: Asked, target: float | None, mean: Array, slopes: Mapping[str, Array]
) -> dict[str, Array]:
    """Drifts, and the worst speed error: with all inputs off towards what by itself gives more speed, or less."""
    worst = "worst_speed_error" in names
    amounts = amounts_at(case, asked.amounts)
    chosen = [name for name in amounts if worst or f"{name}_drift" in names]
    if slopes:
        changes = {name: np.stack([slopes[name] * amounts[name], -slopes[name] * amounts[name]]) for name in chosen}
    else:
        changes = {name: both - mean for name, both in speeds_off(case, asked.amounts, chosen).items()}
    found = {f"{name}_drift": np.max(np.abs(both), axis=0) for name, both in changes.items()}
    found |= {drift: np.zeros(case.shape) for drift in names & set(DRIFTS) if drift not in found}
    if worst and target is not None:
        more = {name: np.where(both[0] >= both[1], 1.0, -1.0) * amounts[name] for name, both in changes.items()}
        ends = mean_speed_off(case, {name: np.stack([off, -off]) for name, off in more.items()})
        found["worst_speed_error"] = np.max(np.abs(ends - target), axis=0)
    return {name: value for name, value in found.items() if name in names}
