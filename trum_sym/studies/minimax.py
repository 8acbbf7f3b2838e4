"""The least worst case over several cases of one box: a map, then sequential quadratic programming, then a check.

All cases of a place are points of one batch, and so are the places that searches from several starts ask for at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.checks import Array
from trum_sym.optimiser.chart import Chart, chart
from trum_sym.optimiser.finish import ALLOWED, TOLERANCE
from trum_sym.optimiser.lockstep import in_lockstep
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
    """Least worst objective of a problem over cases that differ in what is not known exactly.

    Parameters
    ----------
    problem : Problem
    model : Model
        Of all cases, the nominal one first.
    count : int
        Cases of the model.
    target : float or None
        If given, the objective is the distance of the problem's objective from it.
    held : bool
        Whether the first constraint is an equality that holds in the nominal case only.
    """

    def __init__(self, problem: Problem, model: Model, count: int, target: float | None, held: bool) -> None:
        self.problem, self.model, self.count, self.target, self.held = problem, model, count, target, held
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
        return self.evaluations + self.model.evaluations

    def map(self) -> None:
        """The worst case on the map's grid, and where a search is to begin."""
        known = chart(self.model, cases=self.count)
        values = self._by_case(self._rows.values(known.figures)).swapaxes(0, 1)  # cases, places, rows
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
        self._starts = _lowest(known, missed, worst)

    def solve(self) -> Outcome | None:
        """The best that the searches from the map's best places find; None if none meets the constraints."""
        if not self._starts:
            return None
        ends = self._onto(np.array(in_lockstep(self._search, self._starts, self._answers)))
        feasible = [found for found in self.check(ends) if found.feasible]
        return min(feasible, key=lambda found: max(found.objectives), default=None)

    def check(self, shares: Array, others: tuple[Model, int] | None = None) -> list[Outcome]:
        """Places in every case, or in those of another model and their number, by an evaluation of their own."""
        model, count = (self.model, self.count) if others is None else others
        points = self.problem.box.at(shares)
        figures = model.check(np.repeat(points, count, axis=0), TOLERANCE)
        if others is not None:
            self.evaluations += len(figures)
        found = []
        for k, (share, point) in enumerate(zip(shares, points, strict=True)):
            own = figures[k * count : (k + 1) * count]
            rows = self._rows.values({name: np.array([of[name] for of in own]) for name in self._rows.names})
            beyond = np.maximum(np.maximum(self._low - rows[:, 1:], rows[:, 1:] - self._high), 0.0) / self._unit
            if self.held:
                beyond[0 if others is not None else 1 :, 0] = 0.0
            worst = np.max(beyond, axis=1, initial=0.0)
            violations = np.where(np.isfinite(worst), worst, np.inf)
            found.append(Outcome(share, point, self._figure(rows[:, 0]).tolist(), violations.tolist(), list(own)))
        return found

    def _figure(self, values: Array) -> Array:
        return values if self.target is None else np.abs(values - self.target)

    def _by_case(self, rows: Array) -> Array:
        """Rows of points as (places, cases, ...)."""
        return rows.reshape(-1, self.count, *rows.shape[1:])

    def _at(self, shares: Array, tolerance: float) -> tuple[Array, Array]:
        """Rows (places, cases, rows) and their slopes (places, cases, rows, variables) in the unit cube."""
        box = self.problem.box
        figures, by = self.model.results_with_slopes(np.repeat(box.at(shares), self.count, axis=0), tolerance)
        slopes = self._rows.slopes(figures, {name: slope * box.width for name, slope in by.items()})
        return self._by_case(self._rows.values(figures)), self._by_case(slopes)

    def _answers(self, asked: list[tuple[int, Array]]) -> list[tuple[Array, Array]]:
        """Of the places that the searches ask for in a round."""
        return list(zip(*self._at(np.array([share for _, share in asked]), _SEARCH), strict=True))

    def _search(self, start: Array, ask: Callable[[Array], tuple[Array, Array]]) -> Array:
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
                values, slopes = ask(share)
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

    def _onto(self, shares: Array) -> Array:
        """Newton's least steps onto what is violated: the held speed, and constraints in their worst cases."""
        shares, active = shares.copy(), np.arange(len(shares))
        for _ in range(_NEWTON):
            steps = [self._step(*found) for found in zip(*self._at(shares[active], TOLERANCE), strict=True)]
            for place, step in zip(active, steps, strict=True):
                if step is not None:
                    shares[place] = np.clip(shares[place] - step, 0.0, 1.0)
            active = active[[step is not None for step in steps]]
            if not active.size:
                break
        return shares

    def _step(self, values: Array, slopes: Array) -> Array | None:
        """Newton's least step from a place; None where nothing is violated."""
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
            return None
        return np.asarray(np.linalg.lstsq(np.array(rows), np.array(sides), rcond=1e-8)[0])


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
