"""How long a rotor takes to come to its speed from rest, or back to it, followed lap by lap."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trum_sym.model.kernels import call
from trum_sym.model.operating_point import Case
from trum_sym.model.rotor import Orbit, lap_from

__all__ = ["RimOrbit", "rim_orbits", "settling_time"]

_DISTURBANCE = 0.1  # of the largest speed
_EXACT_LAPS = 12  # before the rest is told from how laps draw speeds together
_LAP_SHARE = 0.01  # of the allowed error, that a lap may be off by
_PER_DECADE = 4  # laps that tell it, by distance from the orbit
_COARSEST = 1e5  # times the orbit's own level
_LEAST = 1e-7  # of a lap, by which it has to draw speeds together


@dataclass(frozen=True)
class RimOrbit:
    """One point of a case: the driver's arguments, the orbit at the rim, radius, cycle time and tolerance."""

    arguments: Mapping[str, float]
    raw: Mapping[str, float]
    radius: float
    cycle_time: float
    tolerance: float

    @property
    def top(self) -> float:
        """The largest speed of the rim."""
        return max(abs(self.raw["low"]), abs(self.raw["high"]))


def rim_orbits(case: Case, orbit: Orbit) -> list[RimOrbit]:
    """Every point of a case of at most one dimension."""
    cycle_time = call("trum_drive", case.values)["T"]
    alone = {"r_c": case.symbols["r_c"], "T": cycle_time}
    names = [*case.arguments, *alone, *(f"orbit {name}" for name in orbit.raw)]
    columns = np.broadcast_arrays(*case.arguments.values(), *alone.values(), *orbit.raw.values())
    found = []
    for row in zip(*(np.ravel(column) for column in columns), strict=True):
        given = dict(zip(names, (float(value) for value in row), strict=True))
        raw = {name: given[f"orbit {name}"] for name in orbit.raw}
        arguments = {name: given[name] for name in case.arguments}
        found.append(RimOrbit(arguments, raw, given["r_c"], given["T"], case.tolerance))
    return found


def settling_time(point: RimOrbit, begins: tuple[str, ...], error: float) -> float:
    """Time until the rotor's speed differs from the orbit's by no more than an error, s; infinite if it never does.

    Parameters
    ----------
    point : RimOrbit
        From :func:`rim_orbits`.
    begins : tuple of "rest", "more" or "less"
        From rest, or from the orbit's start with a tenth of the largest speed more or less; the slowest counts.
    error : float
        In rad/s.
    """
    if not np.isfinite(point.raw["mean"]):
        return math.inf
    start, off = point.raw["start"], _DISTURBANCE * point.top
    allowed = max(error * point.radius, 2 * point.tolerance * point.top)
    at = {"rest": 0.0, "more": start + off, "less": start - off}
    return point.cycle_time * max(_cycles(point, at[begin], allowed) for begin in begins)


def _cycles(point: RimOrbit, start: float, allowed: float) -> float:
    """Drive cycles until a rim speed is near the orbit's start, the last one shared out by the logarithm."""
    known = point.raw["level"] if np.isfinite(point.raw["level"]) else point.tolerance
    level = known * min(max(_LAP_SHARE * allowed / (point.tolerance * point.top), 1.0), _COARSEST)
    orbit = point.raw["start"]

    def after(distance: float) -> float:
        return float(lap_from(point.arguments, point.raw, orbit + distance, 1, level)["speed"][-1]) - orbit

    distance = start - orbit
    for lap in range(_EXACT_LAPS):
        if abs(distance) <= allowed:
            return float(lap)
        then = after(distance)
        if abs(then) <= allowed:
            least = max(abs(then), point.tolerance * point.top)  # below is rounding
            return lap + math.log(abs(distance) / allowed) / math.log(abs(distance) / least)
        distance = then
    count = max(2, 1 + math.ceil(_PER_DECADE * math.log10(abs(distance) / allowed)))
    logs = np.linspace(math.log(allowed), math.log(abs(distance)), count)
    left = [math.copysign(math.exp(log), distance) for log in logs]
    kept = np.log(np.clip([after(far) / far for far in left], 1e-300, 1.0))
    here, laps = math.log(abs(distance)), float(_EXACT_LAPS)
    while here > logs[0]:
        change = float(np.interp(here, logs, kept))
        if change > -_LEAST:  # laps draw nothing together that could be told from rounding
            return math.inf
        if here + change <= logs[0]:
            return float(laps + (here - logs[0]) / -change)
        here, laps = here + change, laps + 1
    return float(laps)
