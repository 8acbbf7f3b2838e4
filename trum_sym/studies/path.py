"""A path over the level lines of a map: one place for every value, near the best and near each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.chart import Chart, crossings

__all__ = ["Candidates", "candidates", "choose"]

_WAY = 4.0  # what crossing the whole box costs, in units of the least cost at a value


@dataclass(frozen=True)
class Candidates:
    """Places (n, d) in the unit cube where a figure has a value, and what each costs, (n,)."""

    share: Array
    cost: Array


def candidates(known: Chart, figure: Array, value: float, cost: Array, excess: Array) -> Candidates:
    """Where a figure has a value on the edges of a map's grid.

    Parameters
    ----------
    known, value : Chart, float
        The map, and the value.
    figure, cost : (n,) arrays
        Of the map's places.
    excess : (n,) array
        Of the constraints; places above 0 do not count.
    """
    a, b, along = crossings(known, figure - value)
    share = known.share[a] + along[:, np.newaxis] * (known.share[b] - known.share[a])
    there = cost[a] + along * (cost[b] - cost[a])
    good = np.isfinite(there) & (excess[a] + along * (excess[b] - excess[a]) <= 0)
    return Candidates(share[good], there[good])


def choose(levels: Sequence[Candidates]) -> list[int]:
    """One candidate for every value, -1 where there is none.

    The sum of cost over the least cost at each value, and of the way between neighbours, is the least there is
    (dynamic programming).
    """
    chosen = [-1] * len(levels)
    begin = 0
    while begin < len(levels):
        if not levels[begin].cost.size:
            begin += 1
            continue
        end = begin
        while end < len(levels) and levels[end].cost.size:
            end += 1
        chosen[begin:end] = _stretch(levels[begin:end])
        begin = end
    return chosen


def _stretch(levels: Sequence[Candidates]) -> list[int]:
    total = _relative(levels[0])
    back: list[Array] = []
    for before, here in pairwise(levels):
        way = np.linalg.norm(here.share[:, np.newaxis] - before.share, axis=2)
        sums = total + _WAY * way
        back.append(np.argmin(sums, axis=1))
        total = np.min(sums, axis=1) + _relative(here)
    path = [int(np.argmin(total))]
    for step in reversed(back):
        path.append(int(step[path[-1]]))
    return path[::-1]


def _relative(level: Candidates) -> Array:
    least = float(np.min(level.cost))
    return np.asarray(level.cost / least - 1 if least > 0 else level.cost - least)
