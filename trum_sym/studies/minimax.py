"""The least worst case over several models of one box: maps, then sequential quadratic programming, then a check."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.checks import Array
from trum_sym.optimiser.chart import Chart, chart
from trum_sym.optimiser.finish import ALLOWED, TOLERANCE
from trum_sym.optimiser.model import Functions, Model, functions
from trum_sym.optimiser.solve import Problem

__all__ = ["Minimax", "Outcome"]

_STARTS = 4
_SEARCH = 1e-7  # of the search's orbits
_NEWTON = 6
_CLOSE = 1e-6  # of the objective: the search's steps that gain less are its last
_MOST_PLACES = 40  # of one search: a line search on rough orbits would go on


class _Enough(Exception):
    """The search has seen enough places."""


@dataclass(frozen=True)
class Outcome:
    """A place, checked by :func:`trum_sym.evaluate` in every case."""

    share: Array
    point: Array
    objectives: list[float]
    violations: list[float]
    figures: list[Mapping[str, Any]]

    @property
    def feasible(self) -> bool:
        """Whether all constraints hold in every case."""
        return max(self.violations) <= ALLOWED and bool(np.all(np.isfinite(self.objectives)))


class Minimax:
    """Least worst objective of a problem over models that differ in what is not known exactly.

    Parameters
    ----------
    problem : Problem
    models : sequence of Model
        One a case, the nominal one first.
    target : float or None
        If given, the objective is the distance of the problem's objective from it.
    held : bool
        Whether the first constraint is an equality that holds in the nominal case only.
    """

    def __init__(self, problem: Problem, models: Sequence[Model], target: float | None, held: bool) -> None:
        self.problem, self.models, self.target, self.held = problem, models, target, held
        constraints = problem.constraints
        self._rows: Functions = functions([problem.objective, *(c.expression for c in constraints)])
        self._low = np.array([c.low for c in constraints])
        self._high = np.array([c.high for c in constraints])
        self._unit = np.ones(len(constraints))
        self._size = 1.0
        self._starts: list[Array] = []
        self.evaluations = 0

    def total(self) -> int:
        """Orbits computed."""
        return self.evaluations + sum(model.evaluations for model in self.models)

    def map(self, shown: Callable[[Sequence[Model]], Iterable[Model]]) -> None:
        """The worst case on the map's grid, and where a search is to begin."""
        charts = [chart(model) for model in shown(self.models)]
        values = np.array([self._rows.values(c.figures) for c in charts])  # cases, places, rows
        with np.errstate(all="ignore"):
            objective = self._figure(values[:, :, 0])
            constraints = values[:, :, 1:]
            size = np.nanmax(np.abs(np.where(np.isfinite(constraints), constraints, np.nan)), axis=(0, 1), initial=0.0)
            bound = np.where(np.isfinite(self._low), self._low, self._high)
            self._unit = np.where(bound != 0, np.abs(bound), np.where(size > 0, size, 1.0))
            spread = np.nanmax(np.where(np.isfinite(constraints), constraints, np.nan), axis=(0, 1), initial=-np.inf)
            spread = spread - np.nanmin(
                np.where(np.isfinite(constraints), constraints, np.nan), axis=(0, 1), initial=np.inf
            )
            beyond = np.maximum(self._low - constraints, constraints - self._high) / np.where(spread > 0, spread, 1.0)
        if self.held:
            beyond[1:, :, 0] = 0.0
        missed = np.maximum(np.max(beyond, axis=(0, 2), initial=0.0), 0.0)
        worst = np.max(objective, axis=0)
        missed = np.where(np.isfinite(worst) & np.isfinite(missed), missed, np.inf)
        self._size = float(np.median(np.abs(worst[np.isfinite(worst)]))) if np.isfinite(worst).any() else 1.0
        self._starts = _lowest(charts[0], missed, worst)

    def solve(self) -> Outcome | None:
        """The best that the searches from the map's best places find; None if none meets the constraints."""
        best: Outcome | None = None
        for start in self._starts:
            found = self.check(self._onto(self._search(start)))
            if found.feasible and (best is None or max(found.objectives) < max(best.objectives)):
                best = found
        return best

    def check(self, share: Array, models: Sequence[Model] | None = None) -> Outcome:
        """A place in every case, or in those of other models, by an evaluation of its own."""
        others = models is not None
        models = self.models if models is None else models
        point = self.problem.box.at(share[np.newaxis])[0]
        found = [model.check(point, TOLERANCE) for model in models]
        if others:
            self.evaluations += len(found)
        objectives, violations = [], []
        for k, figures in enumerate(found):
            row = self._rows.values({name: np.array([figures[name]]) for name in self._rows.names})[0]
            beyond = np.maximum(np.maximum(self._low - row[1:], row[1:] - self._high), 0.0) / self._unit
            if self.held and (k or others):
                beyond = beyond[1:]
            objectives.append(float(self._figure(row[0])))
            worst = float(np.max(beyond, initial=0.0))
            violations.append(worst if np.isfinite(worst) else np.inf)
        return Outcome(share, point, objectives, violations, list(found))

    def _figure(self, values: Array) -> Array:
        return values if self.target is None else np.abs(values - self.target)

    def _at(self, share: Array) -> tuple[Array, Array]:
        """Rows (cases, rows) and their slopes (cases, rows, variables) in the unit cube."""
        values, slopes = [], []
        box = self.problem.box
        for model in self.models:
            figures, by = model.results_with_slopes(box.at(share[np.newaxis]), _SEARCH)
            values.append(self._rows.values(figures)[0])
            slopes.append(self._rows.slopes(figures, {name: slope * box.width for name, slope in by.items()})[0])
        return np.array(values), np.array(slopes)

    def _search(self, start: Array) -> Array:
        """Least t with every case's objective at most t, by sequential quadratic programming."""
        try:
            from scipy.optimize import minimize
        except ImportError as error:
            raise MissingExtraError("robust", str(error.name), "optimize") from None
        d, seen = start.size, dict[bytes, tuple[Array, Array]]()

        def look(x: Array) -> tuple[Array, Array]:
            share = np.clip(x[:d], 0.0, 1.0)
            key = share.tobytes()
            if key not in seen and len(seen) == _MOST_PLACES:
                raise _Enough
            if key not in seen:
                values, slopes = self._at(share)
                good = np.all(np.isfinite(values)) and np.all(np.isfinite(slopes))
                seen[key] = (values, slopes) if good else (np.full_like(values, 1e6), np.zeros_like(slopes))
            return seen[key]

        def above(x: Array) -> Array:  # >= 0 where it holds
            values, _ = look(x)
            rows = [x[d] - sign * (values[:, 0] - centre) / self._size for sign, centre in self._sides()]
            return np.concatenate([*rows, *(part for part, _ in self._inequalities(*look(x)))])

        def above_slopes(x: Array) -> Array:
            _, slopes = look(x)
            parts = []
            for sign, _ in self._sides():
                parts.append(np.hstack([-sign * slopes[:, 0] / self._size, np.ones((len(slopes), 1))]))
            for _, slope in self._inequalities(*look(x)):
                parts.append(np.hstack([slope, np.zeros((len(slope), 1))]))
            return np.vstack(parts)

        limits = [{"type": "ineq", "fun": above, "jac": above_slopes}]
        if self.held:
            limits.append(
                {
                    "type": "eq",
                    "fun": lambda x: np.array([(look(x)[0][0, 1] - self._low[0]) / self._unit[0]]),
                    "jac": lambda x: np.append(look(x)[1][0, 1] / self._unit[0], 0.0)[np.newaxis],
                }
            )
        first = float(np.max(self._figure(look(start)[0][:, 0])) / self._size)
        with suppress(_Enough):
            minimize(
                lambda x: x[d],
                np.append(start, first),
                jac=lambda _: np.append(np.zeros(d), 1.0),
                method="SLSQP",
                bounds=[(0.0, 1.0)] * d + [(None, None)],
                constraints=limits,
                options={"maxiter": 40, "ftol": _CLOSE},
            )
        # whatever it says of its success: the best place that it saw
        best = min(seen, key=lambda key: self._rank(*seen[key]))
        return np.frombuffer(best).copy()

    def _rank(self, values: Array, slopes: Array) -> tuple[float, float]:
        """Violation beyond rounding, then the worst objective."""
        missed = [-float(np.min(part, initial=0.0)) for part, _ in self._inequalities(values, slopes)]
        if self.held:
            missed.append(abs(values[0, 1] - self._low[0]) / self._unit[0])
        return max([1e-6, *missed]), float(np.max(self._figure(values[:, 0])))

    def _sides(self) -> tuple[tuple[float, float], ...]:
        """Signs and centres whose rows make the objective."""
        return ((1.0, 0.0),) if self.target is None else ((1.0, self.target), (-1.0, self.target))

    def _inequalities(self, values: Array, slopes: Array) -> list[tuple[Array, Array]]:
        """What is at least 0 where the constraints hold, in every case, with slopes."""
        found = []
        for k in range(int(self.held), self._low.size):
            for sign, bound in ((1.0, self._low[k]), (-1.0, self._high[k])):
                if np.isfinite(bound):
                    scale = sign / self._unit[k]
                    found.append((scale * (values[:, 1 + k] - bound), scale * slopes[:, 1 + k]))
        return found

    def _onto(self, share: Array) -> Array:
        """Newton's least steps onto what is violated: the held speed, and constraints in their worst cases."""
        for _ in range(_NEWTON):
            figures = [m.results_with_slopes(self.problem.box.at(share[np.newaxis]), TOLERANCE) for m in self.models]
            width = self.problem.box.width
            values = np.array([self._rows.values(f)[0] for f, _ in figures])
            slopes = np.array([self._rows.slopes(f, {n: s * width for n, s in by.items()})[0] for f, by in figures])
            rows, sides = [], []
            if self.held:
                off = (values[0, 1] - self._low[0]) / self._unit[0]
                if abs(off) > 0.1 * ALLOWED:
                    rows.append(slopes[0, 1] / self._unit[0])
                    sides.append(off)
            for part, slope in self._inequalities(values, slopes):
                for value, by in zip(part, slope, strict=True):
                    if value < 0:
                        rows.append(by)
                        sides.append(value - 0.1 * ALLOWED)
            if not rows or not np.all(np.isfinite(rows)):
                break
            step = np.linalg.lstsq(np.array(rows), np.array(sides), rcond=1e-8)[0]
            share = np.clip(share - step, 0.0, 1.0)
        return share


def _lowest(known: Chart, missed: Array, worst: Array) -> list[Array]:
    """Places of the grid that none around beats, by violation and then by the worst case; at most a few."""
    order = np.lexsort((worst, np.where(missed <= 1e-12, 0.0, missed)))
    order = order[np.isfinite(missed[order])]
    reach = 1.6 / (np.array(known.shape) - 1)
    kept: list[Array] = []
    for k in order:
        share = known.share[k]
        if all(np.any(np.abs(share - other) > 2 * reach) for other in kept):
            kept.append(share)
        if len(kept) == _STARTS:
            break
    return kept
