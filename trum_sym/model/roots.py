"""Roots of rising functions, many at once, each between bounds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trum_sym.inputs.checks import Array

__all__ = ["rising"]

_HALVINGS = 60  # at most
_NEAR = 1e-8  # of a size, from where on a step no shorter than the one before is rounding


def rising(
    at: Callable[[Array], tuple[Array, Array]],
    low: Array,
    high: Array,
    start: Array,
    size: Array,
    last: float,
) -> Array:
    """Where functions change from below 0 to 0 or above, by Newton's steps as long as they stay between the bounds.

    Parameters
    ----------
    at : callable
        Values and slopes at places, arrays of the shape of ``start``.
    low, high, start, size : array of one shape
        Bounds, where to begin between them, and sizes that the last step is small against.
    last : float
        How small; a place is also found where steps stay below 1e-8 of its size and no longer shrink, by rounding.
    """
    place, moved, done = start, size, np.zeros(start.shape, dtype=bool)
    for _ in range(_HALVINGS):
        value, slope = at(place)
        less = value < 0
        low, high = np.where(less, place, low), np.where(less, high, place)
        with np.errstate(all="ignore"):
            step = place - value / slope
        after = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        before, moved = moved, np.abs(after - place)
        place = np.where(done, place, after)
        done |= (moved <= last * size) | ((moved <= _NEAR * size) & (moved >= before))
        if done.all():
            break
    return place
