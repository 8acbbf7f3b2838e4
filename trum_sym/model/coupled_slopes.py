"""Slopes of a coupled orbit's figures: central differences of orbits on one branch, with an estimate of their error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import check_single, numbers_of
from trum_sym.model.batch import over_points
from trum_sym.model.coupled_orbit import CoupledOrbit, lap_values, orbit_from
from trum_sym.model.coupled_point import coupled_point, prepare_coupled
from trum_sym.model.levels import Levels
from trum_sym.model.rotor import over_mean

__all__ = ["FIGURES", "PARAMETERS", "coupled_slopes"]

PARAMETERS = (
    "prepressure",
    "frequency_difference",
    "load_torque",
    "load_inertia",
    "friction_coefficient",
    "damping_ratio",
    "rotor_mass",
)
"""What slopes are by; the last only where the rotor has a mass."""
FIGURES = (
    "mean_speed",
    "min_speed",
    "max_speed",
    "speed_volatility",
    "contact_fraction",
    "highest_wave",
    "input_power",
)
_STEPS = (2e-3, 1e-3)  # of a parameter's size, to either side; the second is taken, their difference is its error
_WIDTH = 5e-3  # of the resonance, about half its width: the size of a frequency difference
_TURN = 2 * np.pi

Slopes = dict[str, dict[str, Array]]


def coupled_slopes(motor: Motor, drive: Drive, levels: Levels, tolerance: float) -> tuple[Slopes, Slopes]:
    """Slopes of :data:`FIGURES` by :data:`PARAMETERS` of a single point, and estimates of their errors; SI.

    An error is what half the step changes, and what the orbits' own errors make over it.  NaN where an orbit beside the
    point's closes after other cycles, does not attract or misses the tolerance.

    Parameters
    ----------
    motor, drive, levels
        Of one point.
    tolerance : float
        Of the orbits: what of it is left over the step is in the errors.

    Raises
    ------
    ParameterError
        As :func:`trum_sym.model.coupled_point.prepare_coupled` does; for arrays, and where no orbit attracts.
    """
    check_single(numbers_of(motor, drive), "one number: each slope with coupling takes orbits of its own")
    case = prepare_coupled(motor, drive, levels, tolerance)
    point = coupled_point(case)
    orbit, values = point.orbit, case.points[0]
    if orbit is None or not point.converged:
        raise ParameterError("coupling", "contact", f"none here, where {point.reason}")
    sizes = _sizes(values)
    names = [name for name in PARAMETERS if sizes[name] > 0]
    moves = [(name, way * step) for name in names for step in _STEPS for way in (1, -1)]
    found: list[CoupledOrbit | None] = [None] * len(moves)

    def run(place: int) -> None:
        name, share = moves[place]
        machine, one = _moved(motor, drive, name, share * sizes[name])
        found[place] = orbit_from(lap_values(machine, one, levels, tolerance=tolerance), orbit.state, "followed")

    over_points(run, len(moves))
    slopes: Slopes = {figure: {} for figure in FIGURES}
    errors: Slopes = {figure: {} for figure in FIGURES}
    for k, name in enumerate(names):
        beside = [one for one in found[4 * k : 4 * k + 4] if one is not None]
        known = all(one.converged and one.cycles == orbit.cycles for one in beside)
        for figure in FIGURES:
            at = np.array([_figure(figure)(one) for one in beside]) if known else np.full((4, 2), np.nan)
            slopes[figure][name], errors[figure][name] = _difference(at, sizes[name])
    return slopes, errors


def _difference(at: Array, size: float) -> tuple[Array, Array]:
    """A slope and its error from a figure with its error at both steps to either side, (4, 2)."""
    wide, near = ((at[2 * j, 0] - at[2 * j + 1, 0]) / (2 * step * size) for j, step in enumerate(_STEPS))
    off = at[2:, 1].sum() / (2 * _STEPS[1] * size)
    return np.asarray(near), np.asarray(abs(near - wide) + off)


def _sizes(values: Mapping[str, float]) -> dict[str, float]:
    """Of each parameter, in its unit, what steps are shares of."""
    return {
        "prepressure": values["F_c"],
        "frequency_difference": _WIDTH * values["omega_n"] / _TURN,
        "load_torque": values["mu"] * values["F_c"] * values["r_c"],
        "load_inertia": values["J_total"],
        "friction_coefficient": values["mu"],
        "damping_ratio": values["xi"],
        "rotor_mass": values["mass"],
    }


def _moved(motor: Motor, drive: Drive, name: str, amount: float) -> tuple[Motor, Drive]:
    """Motor and drive with one parameter off by so much; the inertia is the rotor's, which may be less than it is."""
    held = "rotor_inertia" if name == "load_inertia" else name
    if held in drive.numbers():
        return motor, replace(drive, **{held: float(np.asarray(getattr(drive, held))) + amount})  # type: ignore[arg-type]
    with unquestioned():
        return motor.with_values({held: float(np.asarray(getattr(motor, held).value)) + amount}), drive


def _figure(name: str) -> Callable[[CoupledOrbit], tuple[float, float]]:
    """A figure of an orbit with its error."""
    if name != "speed_volatility":
        return lambda orbit: (getattr(orbit, name), getattr(orbit, f"{name}_error"))

    def volatility(orbit: CoupledOrbit) -> tuple[float, float]:
        of = (orbit.deviation, orbit.deviation_error, orbit.mean_speed, orbit.mean_speed_error)
        found, error = over_mean(*(np.asarray(number) for number in of))
        return float(found), float(error)

    return volatility
