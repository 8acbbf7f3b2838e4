"""The figures of many points of a box at once, with their slopes, as objective and constraints need them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from trum_sym.errors import ValidityWarning
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.cycle import cycle_sums
from trum_sym.model.holding import Asked
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import Case, evaluate, prepare
from trum_sym.model.pressure import peak_pressure
from trum_sym.model.rotor import Orbit, solve_orbit
from trum_sym.model.sensitivities import orbit_with_slopes
from trum_sym.optimiser.expressions import Expression, symbol
from trum_sym.optimiser.extra import casadi
from trum_sym.optimiser.held import COARSE, HELD_FIGURES, held_figures
from trum_sym.values import Value

__all__ = ["Box", "Functions", "Model", "functions"]

_TURN = 2 * np.pi
_DETERMINANT = ("q_ratio", "q_square_ratio", "q_average", "q_volatility")
_HELD = {"stall_torque", "contact_fraction"}  # the figures of a rotor that is held
_INPUTS = ("prepressure", "frequency_difference", "switching_phase", "load_torque", "periods", "on_periods")
_PHASE = "switching_phase"
# of closed forms' differences, and of orbits': N, Hz, N m, rad
_STEPS = {"prepressure": 0.02, "frequency_difference": 0.3, "load_torque": 1e-4, _PHASE: 1e-3}
_ORBIT_STEPS = {"prepressure": 0.02, "frequency_difference": 0.3, "load_torque": 1e-4, _PHASE: 4e-3}
_FINEST = 1e-9


@dataclass(frozen=True, eq=False)
class Box(Value):
    """Where the variables may be; each an entry of :class:`trum_sym.Drive`."""

    names: tuple[str, ...]
    low: Array
    high: Array

    @property
    def width(self) -> Array:
        """High less low."""
        return self.high - self.low

    def at(self, share: Array) -> Array:
        """Points of the box from their place in the unit cube, (n, d)."""
        return np.clip(self.low + share * self.width, self.low, self.high)


@dataclass(frozen=True)
class Functions:
    """Expressions as functions of named figures: rows of values, and their derivatives by the figures."""

    names: tuple[str, ...]
    value: Any
    jacobian: Any

    def values(self, figures: Mapping[str, Array]) -> Array:
        """One row a point, one column an expression."""
        columns = np.array([figures[name] for name in self.names])
        return np.asarray(self.value(columns), np.float64).T

    def slopes(self, figures: Mapping[str, Array], by: Mapping[str, Array]) -> Array:
        """Derivatives by the box's variables, (points, expressions, variables)."""
        columns = np.array([figures[name] for name in self.names])
        inner = np.stack([by[name] for name in self.names], axis=1)  # points, figures, variables
        outer = np.asarray(self.jacobian(columns), np.float64)
        outer = outer.reshape(outer.shape[0], columns.shape[1], len(self.names)).transpose(1, 0, 2)
        with np.errstate(all="ignore"):
            return np.asarray(outer @ inner)


def functions(expressions: Sequence[Expression]) -> Functions:
    """Compile expressions over the figures that occur in them."""
    names = tuple(sorted(frozenset().union(*(expression.names for expression in expressions))))
    arguments = casadi.vertcat(*(symbol(name) for name in names))
    rows = casadi.vertcat(*(expression.graph for expression in expressions))
    return Functions(
        names,
        casadi.Function("value", [arguments], [rows]),
        casadi.Function("jacobian", [arguments], [casadi.densify(casadi.jacobian(rows, arguments))]),
    )


class Model:
    """A motor under a drive whose entries in the box vary.

    Parameters
    ----------
    motor : Motor
    drive : Drive
        What does not vary; all numbers scalars.
    levels : Levels
    box : Box
    names : set of str
        The figures that are wanted.
    asked : Asked, optional
        What is asked of points that are to be held.
    target : float, optional
        The mean speed that is wanted, rad/s.
    cases : mapping of (k,) arrays, optional
        Values of the motor or of the load, by name, in which k cases differ: points are then given k times each, once
        for every case in their order.

    Attributes
    ----------
    evaluations : int
        Orbits computed so far.
    """

    def __init__(
        self,
        motor: Motor,
        drive: Drive,
        levels: Levels,
        box: Box,
        names: frozenset[str],
        asked: Asked | None = None,
        target: float | None = None,
        cases: Mapping[str, Array] | None = None,
    ) -> None:
        self.motor, self.drive, self.levels, self.box, self.names = motor, drive, levels, box, names
        self.asked, self.target = Asked() if asked is None else asked, target
        self.cases = {} if cases is None else dict(cases)
        self._held = names.intersection(HELD_FIGURES)
        self.evaluations = 0

    def at(self, points: Array) -> tuple[Motor, Drive]:
        """Motor and drive at points of the box, (..., n, d) or, without cases, (d,)."""
        varied: dict[str, Any] = {name: points[..., k] for k, name in enumerate(self.box.names)}
        own: dict[str, Any] = {name: np.resize(values, points.shape[-2]) for name, values in self.cases.items()}
        varied |= {name: own.pop(name) for name in DRIVE_DOMAINS if name in own}
        with unquestioned():
            return self.motor.with_values(own) if own else self.motor, replace(self.drive, **varied)

    def results(self, points: Array, tolerance: float) -> dict[str, Array]:
        """The wanted figures, mean speed and deviation always among them; NaN where no speed balances the load."""
        if self._held:
            tolerance = min(tolerance, COARSE)
        case = self._case(points, tolerance)
        self.evaluations += len(points)
        if not self._held:
            orbit = solve_orbit(case.arguments, case.symbols, method="auto")
            return {**self._closed(case), **_speeds(orbit)}
        orbit, held = held_figures(case, self._held, self.asked, self.target)
        return {**self._closed(case), **_speeds(orbit), **held}

    def results_with_slopes(self, points: Array, tolerance: float) -> tuple[dict[str, Array], dict[str, Array]]:
        """The same and their derivatives by the box's variables, each (n, d)."""
        case = self._case(points, tolerance)
        self.evaluations += len(points)
        orbit, found = orbit_with_slopes(case)
        figures = {**self._closed(case), **_speeds(orbit)}
        closed = self.names.difference(found, self._held)
        slopes = self._differences(points, range(points.shape[1])) if closed else {}
        if self._held:
            figures |= held_figures(case, self._held, self.asked, self.target)[1]
            by_all = self._differences(points, range(points.shape[1]), orbits=True)
            slopes |= {name: by_all[name] for name in self._held}
        if _PHASE in self.box.names:
            by_phase = self._differences(points, [self.box.names.index(_PHASE)], orbits=True)
            for of in found:
                found[of][_PHASE] = by_phase[of][:, 0]
        for of in found:
            slopes[of] = np.stack([found[of][variable] for variable in self.box.names], axis=-1)
        return figures, slopes

    def check(self, points: Array, tolerance: float) -> list[dict[str, Any]]:
        """Every figure of points, (n, d), by :func:`trum_sym.evaluate`, independent of what found them."""
        motor, drive = self.at(points)
        self.evaluations += len(points)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ValidityWarning)
            found = evaluate(motor, drive, **vars(self.levels), tolerance=tolerance).figures
            case = self._case(points, tolerance)
        figures: dict[str, Any] = self._closed(case)
        if self._held:
            figures |= held_figures(case, self._held, self.asked, self.target)[1]
        figures |= {name: value for name, value in found.items() if name == "reason" or _is_numbers(value)}
        figures["speed_deviation"] = figures["speed_volatility"] * np.abs(figures["mean_speed"])
        return [{name: values[k].item() for name, values in figures.items()} for k in range(len(points))]

    def _case(self, points: Array, tolerance: float) -> Case:
        motor, drive = self.at(points)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ValidityWarning)  # the box has warned
            case = prepare(motor, drive, self.levels, tolerance)
        return replace(case, arguments={**case.arguments, "held": float(bool(self.names & _HELD))})

    def _closed(self, case: Case) -> dict[str, Array]:
        """Figures that need no orbit."""
        found: dict[str, Any] = {name: getattr(case.drive, name) for name in _INPUTS}
        timing = call("trum_drive", case.values)
        found["resonance_frequency"] = np.asarray(case.stator.omega_n) / _TURN
        found["drive_frequency"] = np.asarray(timing["omega_q"]) / _TURN
        found |= {"cycle_time": timing["T"], "amplitude": case.stator.W}
        found |= {"neutral_axis": case.stator.D, "wavenumber": case.stator.k_c}
        if self.names.intersection(_DETERMINANT):
            found |= cycle_sums(case.values)
        if "peak_pressure" in self.names:
            found["peak_pressure"] = peak_pressure(case)
        return {name: np.broadcast_to(value, case.shape) for name, value in found.items()}

    def _differences(self, points: Array, axes: Sequence[int], orbits: bool = False) -> dict[str, Array]:
        """Slopes along some variables, by central differences of sixth order: of what needs no orbit, or of orbits."""
        shifts = np.array([1.0, -1.0, 2.0, -2.0, 3.0, -3.0])
        weights = np.array([45.0, -45.0, -9.0, 9.0, 1.0, -1.0]) / 60
        columns: dict[str, list[Array]] = {}
        for k in axes:
            step = (_ORBIT_STEPS if orbits else _STEPS)[self.box.names[k]]
            moved = np.repeat(points[np.newaxis], 6, axis=0)
            moved[:, :, k] += shifts[:, np.newaxis] * step
            if orbits:
                flat = self.results(moved.reshape(-1, points.shape[1]), _FINEST)
                found = {name: value.reshape(6, -1) for name, value in flat.items()}
            else:
                found = self._closed(self._case(moved, _FINEST))
            for figure, value in found.items():
                columns.setdefault(figure, []).append(weights @ value / step)
        return {figure: np.stack(by, axis=-1) for figure, by in columns.items()}


def _is_numbers(value: object) -> bool:
    return isinstance(value, np.ndarray) and value.dtype == np.float64


def _speeds(orbit: Orbit) -> dict[str, Array]:
    deviation = np.sqrt(orbit.variance)
    with np.errstate(all="ignore"):
        volatility = deviation / np.abs(orbit.mean_speed)
    return {
        "mean_speed": orbit.mean_speed,
        "min_speed": orbit.min_speed,
        "max_speed": orbit.max_speed,
        "speed_volatility": volatility,
        "speed_deviation": deviation,
        "stall_torque": orbit.stall_torque,
        "contact_fraction": orbit.contact_fraction,
    }
