"""Least volatility at a speed: ours, SciPy's SLSQP with differences, differential evolution, on the same kernels."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, differential_evolution, minimize

import trum_sym as ts
from benchmarks.rows import Row
from trum_sym.errors import ValidityWarning

__all__ = ["rows"]

SECTION = "least volatility at a target speed"
_LOW, _HIGH = np.array([160.0, 2800.0]), np.array([210.0, 3300.0])
_STEP = 1e-4  # of SLSQP's differences, over the box's side
_TOLERANCE = 1e-6
_CLOSE = 2e-3  # objectives closer than this share are equal: a miss of _MET moves them by as much
_MET = 1e-3  # miss of the target, over it, that counts as met for the others; ours has to meet 1e-8


class Case:
    """A motor, a load and a target; figures at places of the unit square."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng([7, seed])
        self.motor = ts.load_motor("trum60").with_values({"friction_coefficient": rng.uniform(0.2, 0.3)})
        self.load = float(rng.uniform(0.0, 0.2))
        self.rng, self.evaluations = rng, 0
        self.target = float(self.at(rng.uniform(size=(1, 2)), 1e-9)[1][0])
        self.span = float(np.ptp(self.at(rng.uniform(size=(64, 2)), 1e-3)[1]))
        self.scale = float(self.at(np.full((1, 2), 0.5), 1e-3)[0][0])

    def at(self, places: np.ndarray, tolerance: float = _TOLERANCE) -> tuple[np.ndarray, np.ndarray]:
        """The speed's deviation and mean, rad/s."""
        if not places.size:  # differential_evolution asks for the feasible part of a generation
            return np.empty(0), np.empty(0)
        points = _LOW + np.clip(places, 0, 1) * (_HIGH - _LOW)
        drive = ts.Drive(prepressure=points[:, 0], frequency_difference=points[:, 1], load_torque=self.load)
        found = ts.evaluate(self.motor, drive, tolerance=tolerance)
        self.evaluations += len(points)
        return found.speed_volatility * np.abs(found.mean_speed), found.mean_speed

    def volatility(self, place: np.ndarray) -> tuple[float, float]:
        """At a place: volatility at the target, and the miss over the target."""
        deviation, speed = self.at(place[np.newaxis], 1e-8)
        return float(deviation[0]) / abs(self.target), abs(float(speed[0]) - self.target) / abs(self.target)


def _ours(case: Case) -> tuple[float, float]:
    found = ts.optimize(case.motor, ts.Drive(load_torque=case.load), target_speed=case.target)
    case.evaluations = found.evaluations
    if found.status != "solved" or found.objective is None or found.constraint_violation is None:
        return np.inf, np.inf
    return found.objective, found.constraint_violation


def _slsqp(case: Case) -> tuple[float, float]:
    known: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    def look(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Deviation and miss with their slopes, in one batch of three points."""
        key = x.tobytes()
        if key not in known:
            signs = np.where(x > 0.5, -1.0, 1.0)
            deviation, speed = case.at(np.concatenate([[x], x + _STEP * np.diag(signs)]))
            deviation, miss = deviation / case.scale, (speed - case.target) / case.span
            known[key] = tuple(
                np.concatenate([[row[0]], (row[1:] - row[0]) / (_STEP * signs)]) for row in (deviation, miss)
            )  # type: ignore[assignment]
        return known[key]

    start = case.rng.uniform(size=2)
    found = minimize(
        lambda x: look(x)[0][0],
        start,
        jac=lambda x: look(x)[0][1:],
        method="SLSQP",
        bounds=[(0, 1)] * 2,
        constraints={"type": "eq", "fun": lambda x: look(x)[1][0], "jac": lambda x: look(x)[1][1:]},
    )
    return case.volatility(np.clip(found.x, 0, 1))


def _evolution(case: Case, **settings: float) -> tuple[float, float]:
    """Differential evolution with SciPy's defaults, a generation in one batch."""

    def deviation(x: np.ndarray) -> np.ndarray:
        return case.at(np.atleast_2d(x.T))[0] / case.scale

    target = NonlinearConstraint(
        lambda x: (case.at(np.atleast_2d(x.T))[1] / case.target - 1.0).reshape(1, *x.shape[1:]), -_MET, _MET
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = differential_evolution(
            deviation,
            Bounds([0, 0], [1, 1]),
            constraints=target,
            vectorized=True,
            updating="deferred",
            seed=int(case.rng.integers(2**31)),
            **settings,
        )
    return case.volatility(np.asarray(found.x))


def rows(problems: int) -> list[Row]:
    """Milliseconds a problem; the ratio is to the time of the first, the note says how often each is right.

    Right is: on target, and no more than 0.2 % above the best that any of them found for the problem.
    """
    ways: dict[str, Callable[[Case], tuple[float, float]]] = {
        "SciPy differential_evolution, its defaults": _evolution,
        "SciPy differential_evolution, twice the population, tol 1e-4": partial(_evolution, popsize=30, tol=1e-4),
        "SciPy SLSQP with differences, one random start": _slsqp,
        "ours": _ours,
    }
    warnings.simplefilter("ignore", ValidityWarning)
    _ours(Case(0))  # loads what is loaded once
    times: dict[str, list[float]] = {name: [] for name in ways}
    counts: dict[str, list[int]] = {name: [] for name in ways}
    found: dict[str, list[float]] = {name: [] for name in ways}
    for seed in range(problems):
        for name, way in ways.items():
            case = Case(seed)
            case.evaluations = 0
            begin = time.perf_counter()
            volatility, miss = way(case)
            times[name].append(time.perf_counter() - begin)
            counts[name].append(case.evaluations)
            found[name].append(volatility if miss <= (1e-8 if name == "ours" else _MET) else np.inf)
    values = np.array(list(found.values()))
    right = values <= (1 + _CLOSE) * values.min(axis=0)
    yardstick = float(np.median(times[next(iter(ways))]))
    table = []
    for name, good in zip(ways, right, strict=True):
        median = float(np.median(times[name]))
        spread = (max(times[name]) - min(times[name])) / median
        note = f"right in {good.sum()} of {problems}, {np.median(counts[name]):.0f} orbits"
        table.append(Row(SECTION, name, 1e3 * median, "ms", spread, yardstick / median, note))
    return table
