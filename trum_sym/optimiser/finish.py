"""From a place near an optimum to a point whose constraints hold, checked by an evaluation of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.descent import Visit
from trum_sym.optimiser.model import Functions, Model

__all__ = ["ALLOWED", "TOLERANCE", "Bounds", "Finished", "checked", "finish", "towards"]

TOLERANCE = 1e-9  # of the orbits that decide
ALLOWED = 1e-8  # violation of a constraint, over its bound
_AIM = 1e-9
_AT_EDGE = 1e-5  # of the box's side: closer is on it
_MOST_STEPS = 8


@dataclass(frozen=True)
class Bounds:
    """Of the constraints, one entry each: equal ones ask for a value.

    ``unit`` is what a violation is divided by: the bound itself, or the constraint's size in the box where that is 0.
    """

    low: Array
    high: Array
    unit: Array

    def excess(self, values: Array) -> Array:
        """How far beyond its bounds each constraint is, signed, in units."""
        above, below = np.maximum(values - self.high, 0.0), np.minimum(values - self.low, 0.0)
        excess: Array = (above + below) / self.unit
        return excess

    def violation(self, values: Array) -> float:
        """The largest excess's size; infinite where there is no number."""
        worst = float(np.max(np.abs(self.excess(values)), initial=0.0))
        return worst if np.isfinite(worst) else np.inf


@dataclass(frozen=True)
class Finished:
    """A checked point.

    Attributes
    ----------
    share, point : (d,) arrays
        In the unit cube, and in SI units.
    figures : mapping
        Every figure of an independent evaluation at :data:`TOLERANCE`.
    objective, constraints, violation : float, (k,) array, float
        From those figures.
    """

    share: Array
    point: Array
    figures: Mapping[str, Any]
    objective: float
    constraints: Array
    violation: float

    @property
    def feasible(self) -> bool:
        """Whether all constraints hold."""
        return self.violation <= ALLOWED and bool(np.isfinite(self.objective))


def finish(model: Model, functions: Functions, bounds: Bounds, found: Visit) -> Finished:
    """Newton onto the constraints that are violated, along their slopes and inside the box; every step is checked.

    Parameters
    ----------
    model : Model
        Gives the figures.
    functions : Functions
        The objective, then the constraints.
    bounds : Bounds
        Of the constraints.
    found : Visit
        Where the descent ended, with these functions' slopes.
    """
    share = np.where(found.share < _AT_EDGE, 0.0, np.where(found.share > 1 - _AT_EDGE, 1.0, found.share))
    slopes = found.slopes[1:] / bounds.unit[:, np.newaxis]
    guess = found.values[1:] + found.slopes[1:] @ (share - found.share)
    if np.all(np.isfinite(slopes)) and bounds.violation(guess) > _AIM:  # on rougher orbits, but a start
        share = towards(share, slopes, bounds.excess(guess))
    best = checked(model, functions, bounds, share)
    point = best
    for _ in range(_MOST_STEPS):
        if best.violation <= _AIM or not np.all(np.isfinite(slopes)) or not np.isfinite(point.violation):
            break
        before = point
        point = checked(model, functions, bounds, towards(before.share, slopes, bounds.excess(before.constraints)))
        moved = point.share - before.share
        if not moved @ moved > 0:
            break
        # Broyden's update keeps the slopes true along the path
        change = (point.constraints - before.constraints) / bounds.unit
        slopes = slopes + np.outer(change - slopes @ moved, moved) / (moved @ moved)
        if point.violation < best.violation:
            best = point
    return best


def towards(share: Array, slopes: Array, excess: Array) -> Array:
    """The least step that takes the excess away to first order, without leaving the unit cube."""
    active = excess != 0
    free = np.ones(share.size, bool)
    for _ in range(share.size):
        step = np.zeros(share.size)
        step[free] = -np.linalg.lstsq(slopes[active][:, free], excess[active], rcond=None)[0]
        outside = free & ((share + step < 0) | (share + step > 1)) & ((share == 0) | (share == 1))
        if not outside.any() or outside.sum() == free.sum():
            break
        free &= ~outside
    return np.clip(share + step, 0.0, 1.0)


def checked(model: Model, functions: Functions, bounds: Bounds, share: Array) -> Finished:
    """A place as it is, evaluated by :func:`trum_sym.evaluate`."""
    point = model.box.at(share[np.newaxis])[0]
    (figures,) = model.check(point[np.newaxis], TOLERANCE)
    values = functions.values({name: np.array([figures[name]]) for name in functions.names})[0]
    return Finished(share, point, figures, float(values[0]), values[1:], bounds.violation(values[1:]))
