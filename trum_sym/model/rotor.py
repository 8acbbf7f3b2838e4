"""The rotor's periodic orbit: speed, its extremes and fluctuation, stall torque (Sect. 4, eqs. 38 to 41)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.batch import call_in_blocks
from trum_sym.model.brush import solve_brush
from trum_sym.model.kernels import ORBIT_FLAGS, call, expect, signature
from trum_sym.model.levels import Method

__all__ = [
    "RUNAWAY",
    "Orbit",
    "as_orbit",
    "encoder_deviation",
    "encoder_readings",
    "grid_is_tried",
    "history",
    "lap_from",
    "orbit_values",
    "reasons",
    "solve_orbit",
    "surface_and_contact",
    "weight_inertia",
]

_GRID_WINS = 1e-3  # the tolerance from which on a grid is faster
_FLAG = {name: 1 << bit for bit, name in enumerate(ORBIT_FLAGS)}
# What the driver takes and gives, by the names that this module uses
_INPUTS = (
    "omega_n",
    "Delta_omega",
    "xi",
    "psi",
    "s",
    "m",
    "n",
    "a_A",
    "b_A",
    "a_B",
    "b_B",
    "W",
    "D",
    "k_c",
    "engagement_per_height",
    "W_full",
    "hertz",
    "push",
    "drag",
    "tolerance",
    "held",
)
_OUTPUTS = (
    "mean",
    "low",
    "high",
    "variance",
    "contact",
    "held",
    "start",
    "level",
    "error",
    "mean_error",
    "low_error",
    "high_error",
    "deviation_error",
    "contact_error",
    "held_error",
    "flags",
)
_WHOLE = "the whole wave touches: no bristle of the layer leaves the contact"
RUNAWAY = "no speed balances the load: it exceeds what friction can transmit"
# Why an orbit is not converged, by the driver's flags
_REASONS = {
    "runaway": RUNAWAY,
    "too_many_steps": "a lap of the drive cycle needs more time steps than are allowed",
    "too_many_laps": "the search for the orbit needs more laps than are allowed",
    "failed_step": "a time step cannot be evaluated however short it is",
    "rounding_limit": "the errors stated are rounding, which shorter time steps do not make smaller",
}
_MISSED = "the bounds of the errors miss the tolerance"
_OF_HISTORY = ("low", "high", "start", "level")
expect("an orbit's inputs", _INPUTS, signature("rotor_orbit")[0])
expect("an orbit's outputs", _OUTPUTS, signature("rotor_orbit")[1])
expect("an orbit's outputs on a grid", _OUTPUTS, signature("rotor_grid")[1])
expect("an orbit's flags", ("converged", "full_contact", "autonomous", *_REASONS), ORBIT_FLAGS)
expect("a history's inputs", (*_INPUTS, *_OF_HISTORY, "times"), signature("rotor_history")[0])


@dataclass(frozen=True)
class Orbit:
    """Figures of periodic orbits; arrays of one shape.

    Speeds of the rotor in rad/s; ``stall_torque`` in N m is what holds the rotor still on average;
    ``contact_fraction`` is the mean of theta/pi.  Where no speed balances the load, speeds are NaN.  The errors are
    bounds (:mod:`derivations.error_bound`), ``deviation_error`` that of the root of ``variance``; ``on_grid`` is where
    they are those of a grid of equal steps (:mod:`derivations.fixed_grid`).
    """

    mean_speed: Array
    min_speed: Array
    max_speed: Array
    variance: Array
    stall_torque: Array
    contact_fraction: Array
    mean_speed_error: Array
    min_speed_error: Array
    max_speed_error: Array
    deviation_error: Array
    stall_torque_error: Array
    converged: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    full_contact: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    runaway: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    on_grid: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    raw: Mapping[str, Array]


def orbit_values(
    modal: Mapping[str, ArrayLike], stator: Mapping[str, ArrayLike], contact: str, tolerance: ArrayLike
) -> dict[str, ArrayLike]:
    """The driver's arguments: modal state, geometry and what the steps of a point share.

    Where ``held`` is set to 0, stall torque and contact fraction are not computed, and NaN.

    Parameters
    ----------
    modal : mapping
        From :func:`trum_sym.model.cycle.modal_values`, at the amplitude of the phases.
    stator : mapping
        Symbols of the motor and its section, F_c and T_load.
    contact : str
        ``"winkler"`` or ``"hertz"``.
    tolerance : float or array
        Of the bounds of the errors of mean, extremes and deviation, relative to the largest speed; of those of contact
        and stall torque, relative to a whole wave in contact and to the largest friction.
    """
    shared = dict(call("trum_rotor_coefficients", stator))
    full = {law: shared.pop(f"W_full_{law}") for law in ("winkler", "hertz")}
    of_contact = {"W_full": full[contact], "hertz": float(contact == "hertz")}
    geometry = {"D": stator["D"], "k_c": stator["k_c"]}
    return {**modal, **geometry, **shared, **of_contact, "tolerance": tolerance, "held": 1.0}


def weight_inertia(stator: Mapping[str, ArrayLike]) -> Array:
    """What a weight on a string adds to the moment of inertia, kg m^2; 0 without a string.

    Parameters
    ----------
    stator : mapping
        Symbols of motor and drive.
    """
    total = np.asarray(call("trum_total_inertia", stator)["J_total"])
    found: Array = total - np.asarray(call("trum_total_inertia", {**stator, "r_s": 0.0})["J_total"])
    return found


def grid_is_tried(method: Method, tolerance: float) -> bool:
    """Whether a method tries a grid of equal steps at a tolerance."""
    return method == "grid" or (method == "auto" and tolerance >= _GRID_WINS)


def solve_orbit(
    values: Mapping[str, ArrayLike],
    stator: Mapping[str, ArrayLike],
    progress: bool = False,
    method: Method = "adaptive",
) -> Orbit:
    """The periodic orbit of every point.

    Parameters
    ----------
    values : mapping
        From :func:`orbit_values`; with those of :func:`trum_sym.model.brush.brush_values`, the layer is a brush.
    stator : mapping
        As there; the contact radius turns rim speeds into rotor speeds.
    progress : bool
        Whether to show a bar on the standard error while many points are computed.
    method : {"auto", "adaptive", "grid"}
        How; a brush has no choice.
    """
    label = "orbits" if progress else None
    if "grip" not in values:
        if method == "adaptive":
            return as_orbit(call_in_blocks("rotor_orbit", values, label), stator)
        tried = [grid_is_tried(method, tolerance) for tolerance in np.ravel(np.asarray(values["tolerance"]))]
        return _orbit_on_grid(values, stator, label, np.reshape(tried, np.shape(values["tolerance"])))
    raw = solve_brush(values)
    runaway = raw.pop("runaway") > 0
    converged = ~runaway & (raw["error"] <= np.asarray(values["tolerance"]))
    raw["flags"] = np.where(runaway, float(_FLAG["runaway"]), np.where(converged, float(_FLAG["converged"]), 0.0))
    return as_orbit(raw, stator)


def _orbit_on_grid(
    values: Mapping[str, ArrayLike],
    stator: Mapping[str, ArrayLike],
    label: str | None,
    tried: np.ndarray[tuple[int, ...], np.dtype[np.bool_]],
) -> Orbit:
    """The orbits on a grid where it is tried, the others and those that it leaves by adaptive steps."""
    columns = dict(zip(_INPUTS, np.broadcast_arrays(*(values[name] for name in _INPUTS)), strict=True))
    shape = columns["tolerance"].shape
    flat = {name: column.ravel() for name, column in columns.items()}
    raw = {name: np.full(flat["tolerance"].size, np.nan) for name in _OUTPUTS}
    on_grid = np.broadcast_to(tried, shape).flatten()  # a copy
    if on_grid.any():
        found = call_in_blocks("rotor_grid", {name: column[on_grid] for name, column in flat.items()}, label)
        met = (found["flags"].astype(int) & _FLAG["converged"]) > 0
        on_grid[on_grid] = met
        for name, of_grid in found.items():
            raw[name][on_grid] = of_grid[met]
    if not on_grid.all():
        rest = call_in_blocks("rotor_orbit", {name: column[~on_grid] for name, column in flat.items()}, label)
        for name, adaptive in rest.items():
            raw[name][~on_grid] = adaptive
    return as_orbit({name: value.reshape(shape) for name, value in raw.items()}, stator, on_grid.reshape(shape))


def as_orbit(
    raw: Mapping[str, Array],
    stator: Mapping[str, ArrayLike],
    on_grid: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] | None = None,
) -> Orbit:
    """The rotor's figures from those of its rim, as the driver gives them; none is on a grid if that is not given."""
    radius = np.asarray(stator["r_c"])
    flags = raw["flags"].astype(int)
    stall, stall_error = (
        np.asarray(call("trum_stall_torque", {**stator, "f": raw[name]})["torque"]) for name in ("held", "held_error")
    )
    return Orbit(
        mean_speed=raw["mean"] / radius,
        min_speed=raw["low"] / radius,
        max_speed=raw["high"] / radius,
        variance=raw["variance"] / radius**2,
        stall_torque=stall,
        contact_fraction=raw["contact"],
        mean_speed_error=raw["mean_error"] / radius,
        min_speed_error=raw["low_error"] / radius,
        max_speed_error=raw["high_error"] / radius,
        deviation_error=raw["deviation_error"] / radius,
        stall_torque_error=stall_error,
        converged=(flags & _FLAG["converged"]) > 0,
        full_contact=(flags & _FLAG["full_contact"]) > 0,
        runaway=(flags & _FLAG["runaway"]) > 0,
        on_grid=np.zeros(flags.shape, np.bool_) if on_grid is None else on_grid,
        raw=raw,
    )


def reasons(raw: Mapping[str, Array]) -> np.ndarray[tuple[int, ...], np.dtype[np.str_]]:
    """Why orbits are not converged, in words; empty where they are."""
    flags = raw["flags"].astype(int)
    found = np.full(flags.shape, _MISSED, dtype=object)
    for name, reason in reversed(_REASONS.items()):
        found[(flags & _FLAG[name]) > 0] = reason
    if "whole" in raw:
        found[np.asarray(raw["whole"]) > 0] = _WHOLE
    found[(flags & _FLAG["converged"]) > 0] = ""
    return found.astype(np.str_)


def history(values: Mapping[str, ArrayLike], raw: Mapping[str, ArrayLike], count: int) -> dict[str, Array]:
    """One cycle of an orbit at ``count`` equal times after t1, the last at the cycle's end.

    Returns
    -------
    dict
        ``speed`` of the rim (m/s), its ``distance`` since t1 (m) and the net ``friction`` fraction.
    """
    if "grip" in values:
        steady, shares = float(np.asarray(raw["start"])), np.arange(1, count + 1) / count
        period = 2 * np.pi / (float(np.asarray(values["omega_n"])) + float(np.asarray(values["Delta_omega"])))
        cycle = float(np.asarray(values["m"])) * period
        return {"speed": np.full(count, steady), "distance": steady * cycle * shares}
    point = {name: raw[name] for name in _OF_HISTORY}
    found = call("rotor_history", {**values, **point, "times": np.empty(count)})
    return {name: np.asarray(value) for name, value in found.items()}


def lap_from(
    values: Mapping[str, ArrayLike], raw: Mapping[str, ArrayLike], start: float, count: int, level: float
) -> dict[str, Array]:
    """One drive cycle of the rotor from any rim speed at t1, at ``count`` equal times after t1.

    Parameters
    ----------
    values : mapping
        From :func:`orbit_values`; for another cycle than its repetition with the free motion before t1 set anew.
    raw : mapping
        ``low`` and ``high`` of the orbit, whose size errors are measured by.
    start : float
        Of the lap, m/s.
    count : int
        Times.
    level : float
        Error that a step may have, per drive period, over the largest speed.

    Returns
    -------
    dict
        As :func:`history`.
    """
    if "grip" in values:
        raise ValueError("a brush has no laps")
    given = {**values, "low": raw["low"], "high": raw["high"], "start": start, "level": level}
    return {
        name: np.asarray(value) for name, value in call("rotor_history", {**given, "times": np.empty(count)}).items()
    }


def over_mean(deviation: Array, error: Array, mean: Array, mean_error: Array) -> tuple[Array, Array]:
    """A deviation over the size of the mean (eq. 40), and its error: infinite where the mean's sign is uncertain."""
    size = np.abs(mean)
    with np.errstate(all="ignore"):
        found = deviation / size
        least = size - mean_error
        of_both = (error + found * mean_error) / least
        return np.asarray(found), np.where(least <= 0, np.inf, of_both)


def encoder_deviation(distance: Array, cycle_time: float, period: float) -> float:
    """Standard deviation of the speeds that an encoder reads which averages over ``period``, m/s.

    The encoder is not locked to the drive, so its windows begin anywhere in the cycle with equal chance.

    Parameters
    ----------
    distance : (n,) array, m
        Of the rim, at equal times of a cycle, the last at its end.
    cycle_time : float, s
        Of the drive.
    period : float, s
        Of the encoder.
    """
    starts = np.arange(distance.size) / distance.size
    return float(np.std(encoder_readings(distance, cycle_time, period, starts)))


def encoder_readings(distance: Array, cycle_time: float, period: float, starts: Array) -> Array:
    """What an encoder reads that averages over ``period``, m/s at the rim.

    Parameters
    ----------
    distance, cycle_time, period
        As for :func:`encoder_deviation`.
    starts : array, 1
        Where in the cycle each window begins, from 0 to 1.
    """
    cycles, rest = divmod(period / cycle_time, 1.0)
    grid = np.arange(distance.size + 1) / distance.size
    path = np.concatenate([[0.0], distance])
    ends = starts + rest
    end_path = np.interp(ends % 1.0, grid, path) + np.floor(ends) * path[-1]
    readings: Array = (end_path - np.interp(starts, grid, path) + cycles * path[-1]) / period
    return readings


def surface_and_contact(values: Mapping[str, ArrayLike], found: Mapping[str, ArrayLike]) -> dict[str, ArrayLike]:
    """Wave, surface speed and contact at instants of known displacement and velocity."""
    now: dict[str, ArrayLike] = {**values, "g_A": 0.0, "g_B": 0.0}
    for phase in "AB":  # the wave's kernel takes the phases as free motions that turn: here by nothing
        phasor = call("trum_phasor", {**values, "a": found[f"w_{phase}"], "b": found[f"v_{phase}"]})
        now |= {f"f_{phase}_re": phasor["re"], f"f_{phase}_im": phasor["im"]}
    now |= {"e_re": 1.0, "e_im": 0.0, "d_re": 1.0, "d_im": 0.0, "p_re": 1.0, "p_im": 0.0}
    now |= call("trum_wave", now)
    if values["hertz"]:
        return {**now, **call("trum_contact_hertz", now)}
    now |= call("trum_filling", now)
    now["fullness_root"] = np.cbrt(now["fullness"])
    return {**now, **call("trum_contact_winkler", now)}
