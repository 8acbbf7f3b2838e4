"""A search that needs no slopes of what is sought: along the level of the equalities, by violation and then objective.

Drifts are sizes of slopes, with kinks where one changes its sign, and their own slopes are dear.  So places are tried
around the best one, brought onto the equalities by Newton's method with the exact slopes of these, at smaller and
smaller distances.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.expressions import Constraint
from trum_sym.optimiser.finish import ALLOWED, TOLERANCE, Bounds, towards
from trum_sym.optimiser.held import HELD_FIGURES
from trum_sym.optimiser.model import Functions, Model, functions

__all__ = ["Place", "better", "seek"]

_NEWTON = 8
_MET = 1e-9  # of an equality's bound
_NOISE = 0.1  # times the orbits' tolerance, of the largest speed: what rough orbits leave
_ROUNDS = 60
_SHRINK = 9.0
_ALONG = np.array([1.0, -1.0, 1 / 3, -1 / 3, 1 / 9, -1 / 9])  # of the radius, where one direction is left
_DIRECTIONS = 20  # where more are
_GAIN = 1e-12  # of the objective: less is rounding


@dataclass(frozen=True)
class Place:
    """A place in the unit cube with objective and constraints there, and the largest violation over its bound."""

    share: Array
    values: Array
    violation: float

    @property
    def rank(self) -> tuple[float, float]:
        """Violation above what counts as met, then the objective."""
        return max(self.violation, 0.1 * ALLOWED), float(self.values[0])


def better(one: Place, other: Place) -> bool:
    """Whether a place beats another by more than rounding."""
    if one.rank[0] != other.rank[0]:
        return one.rank[0] < other.rank[0]
    return one.rank[1] < other.rank[1] - _GAIN * abs(other.rank[1])


class _Level:
    """Where the equalities hold."""

    def __init__(self, model: Model, constraints: Sequence[Constraint], bounds: Bounds) -> None:
        rows = [k for k, constraint in enumerate(constraints) if constraint.low == constraint.high]
        self.count = len(rows)
        if not rows:
            return
        equal = [constraints[k].expression for k in rows]
        names = frozenset[str]().union(*(expression.names for expression in equal))
        cheap = not names & set(HELD_FIGURES)
        self._model = (
            Model(model.motor, model.drive, model.levels, model.box, names, model.asked, model.target)
            if cheap
            else model
        )
        self._own, self._cheap = model, cheap
        self._rows: Functions = functions(equal)
        self._wanted, self._unit = bounds.low[rows], bounds.unit[rows]

    def onto(self, share: Array, tolerance: float, near: Array | None = None) -> tuple[Array, Array, Array]:
        """Places brought onto the level, whether each has arrived, and the level's slopes, (n, k, d).

        ``near`` are slopes that are known nearby, by which steps are taken; without them the places' own are computed.
        """
        share, n, d = share.copy(), len(share), share.shape[1]
        if not self.count:
            return share, np.ones(n, bool), np.empty((n, 0, d))
        met, slopes, active = np.zeros(n, bool), np.full((n, self.count, d), np.nan), np.arange(n)
        if near is not None:
            slopes = near.copy()
        for _ in range(_NEWTON):
            figures, here = self._at(share[active], tolerance, near is None)
            if here is not None:
                slopes[active] = here
            off = (self._rows.values(figures) - self._wanted) / self._unit
            with np.errstate(all="ignore"):
                top = np.maximum(np.abs(figures["min_speed"]), np.abs(figures["max_speed"]))
                noise = _NOISE * tolerance * top[:, np.newaxis] / self._unit if tolerance > TOLERANCE else 0.0
                arrived = np.all(np.abs(off) <= np.maximum(_MET, noise), axis=1)
            met[active[arrived]] = True
            go = ~arrived & np.all(np.isfinite(off), axis=1) & np.all(np.isfinite(slopes[active]), axis=(1, 2))
            for place, excess in zip(active[go], off[go], strict=True):
                share[place] = towards(share[place], slopes[place], excess)
            active = active[go]
            if not active.size:
                break
        return share, met, slopes

    def _at(self, share: Array, tolerance: float, with_slopes: bool) -> tuple[dict[str, Array], Array | None]:
        """Figures at places, and the scaled slopes of the equalities if they are wanted."""
        points = self._model.box.at(share)
        if self._cheap:
            self._own.evaluations += len(points)
        if not with_slopes:
            return self._model.results(points, tolerance), None
        figures, by = self._model.results_with_slopes(points, tolerance)
        here = self._rows.slopes(figures, {name: slope * self._model.box.width for name, slope in by.items()})
        return figures, here / self._unit[:, np.newaxis]


@dataclass
class _Walk:
    """The search from one start: the best place so far, the level's slopes there, and how far away others are tried."""

    best: Place
    slopes: Array
    radius: float


def seek(
    model: Model,
    rows: Functions,
    constraints: Sequence[Constraint],
    bounds: Bounds,
    starts: Array,
    radii: tuple[float, float],
    tolerance: float,
) -> list[Place]:
    """The best places around starts, side by side; none for a start near which the equalities cannot be met.

    Parameters
    ----------
    model, rows, constraints, bounds
        Figures, objective and constraints as functions of them, the constraints and their bounds.
    starts : (n, d) array
        In the unit cube.
    radii : (float, float)
        First and last distance at which places are tried, of the box's side.
    tolerance : float
        Of the orbits.
    """
    level, rng, d = _Level(model, constraints, bounds), np.random.default_rng(0), starts.shape[1]

    def look(share: Array, near: Array | None = None) -> tuple[list[Place | None], Array]:
        share, met, slopes = level.onto(share, tolerance, near)
        found: list[Place | None] = [None] * len(share)
        if met.any():
            values = rows.values(model.results(model.box.at(share[met]), tolerance))
            for k, row in zip(np.flatnonzero(met), values, strict=True):
                if np.all(np.isfinite(row)):
                    found[k] = Place(share[k], row, _violation(constraints, bounds, row))
        return found, slopes

    begun, slopes = look(starts)
    walks = [_Walk(place, slopes[k], radii[0]) for k, place in enumerate(begun) if place is not None]
    active = walks if level.count < d else []
    for _ in range(_ROUNDS):
        active = [walk for walk in active if walk.radius >= radii[1]]
        if not active:
            break
        tried = [_around(walk, rng) for walk in active]
        near = np.concatenate(
            [np.repeat(w.slopes[np.newaxis], len(own), 0) for w, own in zip(active, tried, strict=True)]
        )
        places, _ = look(np.concatenate(tried), near)
        moved = _moved(active, places, [len(own) for own in tried])
        if moved and level.count:
            _, _, there = level.onto(np.array([walk.best.share for walk in moved]), tolerance)
            for walk, here_slopes in zip(moved, there, strict=True):
                walk.slopes = here_slopes
    return [walk.best for walk in walks]


def _moved(walks: Sequence[_Walk], places: Sequence[Place | None], counts: Sequence[int]) -> list[_Walk]:
    """The walks of which a place that was tried is better, at that place; the others will try nearer ones."""
    first, moved = 0, list[_Walk]()
    for walk, count in zip(walks, counts, strict=True):
        here = [place for place in places[first : first + count] if place is not None]
        first += count
        best = min(here, key=lambda place: place.rank, default=None)
        if best is not None and better(best, walk.best):
            walk.best = best
            moved.append(walk)
        else:
            walk.radius /= _SHRINK if count == len(_ALONG) else 2.0
    return moved


def _around(walk: _Walk, rng: np.random.Generator) -> Array:
    """Places to try: along the level where that is a line, else all around in it."""
    along = _tangents(walk.slopes, walk.best.share.size)
    if along.shape[1] == 1:
        steps = _ALONG[:, np.newaxis] * along[:, 0]
    else:
        around = rng.normal(size=(_DIRECTIONS, along.shape[1]))
        steps = (around / np.linalg.norm(around, axis=1, keepdims=True)) @ along.T
    return np.clip(walk.best.share + walk.radius * steps, 0.0, 1.0)


def _violation(constraints: Sequence[Constraint], bounds: Bounds, row: Array) -> float:
    """The largest violation of what is no equality, which are met on the level."""
    excess = np.abs(bounds.excess(row[1:]))
    loose = [excess[k] for k, constraint in enumerate(constraints) if constraint.low != constraint.high]
    return float(max(loose, default=0.0))


def _tangents(slopes: Array, d: int) -> Array:
    """Directions along the level, (d, d - k); all where the level has no slope."""
    if not slopes.size or not np.all(np.isfinite(slopes)):
        return np.eye(d)
    _, sizes, rows = np.linalg.svd(slopes)
    rank = int(np.sum(sizes > 1e-12 * sizes.max(initial=0.0)))
    return np.asarray(rows[rank:].T) if rank < d else np.eye(d)
