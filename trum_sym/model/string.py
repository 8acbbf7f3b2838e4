"""Whether the string that bears a load's weight stays taut over the rotor's orbit (Sect. 8.1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.cycle import response
from trum_sym.model.kernels import call
from trum_sym.model.rotor import Orbit, history, surface_and_contact

__all__ = ["SLACK", "least_tension"]

SLACK = "the string goes slack: the rotor drops faster than the weight can fall, and the figures do not hold"
_SAMPLES = 64  # of a drive period


def least_tension(arguments: Mapping[str, ArrayLike], symbols: Mapping[str, ArrayLike], orbit: Orbit) -> Array:
    """The string's least tension over the weight, of every point: below 0 it goes slack.

    Where friction could not make it slack even if all of it drove the rotor down, that bound is given; else the least
    over 64 instants of a drive period on the orbit.  NaN where there is none.

    Parameters
    ----------
    arguments : mapping
        From :func:`trum_sym.model.rotor.orbit_values`.
    symbols : mapping
        Of motor and drive.
    orbit : Orbit
        From :func:`trum_sym.model.rotor.solve_orbit` of them.
    """
    of_load = {name: symbols[name] for name in ("J", "J_load", "T_load", "mu", "F_c", "r_c", "r_s")}
    names = [*arguments, *of_load, *(f"orbit {name}" for name in orbit.raw)]
    columns = np.broadcast_arrays(*arguments.values(), *of_load.values(), *orbit.raw.values())
    given = dict(zip(names, columns, strict=True))
    found = np.array(call("trum_string_tension", {**given, "f": -1.0})["tension"], ndmin=1, dtype=np.float64)
    speeds = np.isfinite(orbit.mean_speed)
    for place in np.argwhere(np.atleast_1d((found < 0) & speeds)):
        index = tuple(place) if np.ndim(columns[0]) else ()
        point = {name: float(column[index]) for name, column in given.items()}
        found[tuple(place)] = _on_orbit(point, {name: point[f"orbit {name}"] for name in orbit.raw})
    return np.where(speeds, found.reshape(columns[0].shape), np.nan)


def _on_orbit(point: Mapping[str, float], raw: Mapping[str, float]) -> float:
    """The least of a cycle's samples."""
    count = int(_SAMPLES * point["m"])
    time = call("trum_drive", point)["T"]
    phases = response(np.arange(count) * time / count, dict(point), point["D"], point["k_c"])
    speed = np.roll(history(point, raw, count)["speed"], 1)  # the last one is at the cycle's end
    friction = call("trum_friction", {**surface_and_contact(point, phases), "v": speed})["f"]
    lifting = np.sign(point["T_load"]) * np.asarray(friction)
    return float(np.min(call("trum_string_tension", {**point, "f": lifting})["tension"]))
