"""A coarse map of the box: where objective and constraints begin to be good, and how many such places there are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.model import Functions, Model

__all__ = ["Chart", "basins", "chart", "crossings"]

Index: TypeAlias = npt.NDArray[np.intp]

_DIVISIONS = {1: 64, 2: 16, 3: 9}  # grid points along a side, by the number of variables
_TOLERANCE = 1e-2
_NEIGHBOUR = 1.6  # divisions


@dataclass(frozen=True)
class Chart:
    """Figures on a grid of the box.

    Attributes
    ----------
    share : (n, d) array
        Places in the unit cube, row by row of the grid.
    shape : tuple of int
    figures : dict
        Of every place, (n,); of cases, (n * cases,) with a place's cases one after the other.
    """

    share: Array
    shape: tuple[int, ...]
    figures: dict[str, Array]


def chart(model: Model, divisions: int | None = None, cases: int = 1) -> Chart:
    """Compute the map, of every case that the model has; about 0.15 ms of a core a place and case."""
    d = len(model.box.names)
    side = np.linspace(0.0, 1.0, divisions or _DIVISIONS[d])
    share = np.stack(np.meshgrid(*[side] * d, indexing="ij"), axis=-1).reshape(-1, d)
    return Chart(share, (side.size,) * d, model.results(np.repeat(model.box.at(share), cases, axis=0), _TOLERANCE))


def crossings(found: Chart, residual: Array) -> tuple[Index, Index, Array]:
    """Edges of the grid along which a residual changes sign: their ends, and where along them."""
    grid = np.arange(residual.size).reshape(found.shape)
    first, second = [], []
    for axis in range(grid.ndim):
        first.append(np.moveaxis(grid, axis, 0)[:-1].ravel())
        second.append(np.moveaxis(grid, axis, 0)[1:].ravel())
    a, b = np.concatenate(first), np.concatenate(second)
    with np.errstate(invalid="ignore"):
        crossed = residual[a] * residual[b] < 0
    a, b = a[crossed], b[crossed]
    return a, b, residual[a] / (residual[a] - residual[b])


def basins(found: Chart, functions: Functions, low: Array, high: Array, scale: Array) -> tuple[Array, Array, Array]:
    """Places that no place around beats, best first.

    A place of the grid beats another by a smaller violation of the constraints, or by the objective among those
    without.  Beside the grid's own places stand those where a constraint's border crosses an edge of the grid.

    Parameters
    ----------
    found : Chart
        The map.
    functions : Functions
        The objective, then the constraints.
    low, high, scale : (k,) arrays
        Bounds of the constraints, and what a violation is measured by.

    Returns
    -------
    places : (n, d) array
        In the unit cube.
    objective, violation : (n,) arrays
        As interpolated.
    """
    values = functions.values(found.figures)
    share = [found.share]
    rows = [values]
    for k, (least, most) in enumerate(zip(low, high, strict=True)):
        for bound in {least, most} - {-np.inf, np.inf}:
            a, b, along = crossings(found, values[:, 1 + k] - bound)
            if a.size == 0:
                continue
            along = along[:, np.newaxis]
            share.append(found.share[a] + along * (found.share[b] - found.share[a]))
            there = {name: value[a] + along[:, 0] * (value[b] - value[a]) for name, value in found.figures.items()}
            crossing = functions.values(there)
            crossing[:, 1 + k] = bound
            rows.append(crossing)
    places, values = np.concatenate(share), np.concatenate(rows)
    objective, constraints = values[:, 0], values[:, 1:]
    violation = np.max(np.maximum(low - constraints, constraints - high) / scale, axis=1, initial=0.0)
    known = np.isfinite(objective) & np.isfinite(violation)
    places, objective, violation = places[known], objective[known], violation[known]
    order = np.lexsort((objective, violation))
    places, objective, violation = places[order], objective[order], violation[order]
    reach = _NEIGHBOUR / (np.array(found.shape) - 1)
    near = np.all(np.abs(places[:, np.newaxis] - places) <= reach, axis=2)
    first = np.argmax(near, axis=1)  # the best place around, in this order
    own = first == np.arange(len(places))
    return places[own], objective[own], violation[own]
