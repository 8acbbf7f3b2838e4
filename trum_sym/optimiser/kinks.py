"""Whether a point is stationary, and the way on from where a kink has stopped IPOPT.

Extremes of the speed change hands, |x|, min and max of an objective have a kink, the contact opens.  IPOPT can stop at
such a place without its being a minimum.  The slopes tell: they leave a way down.  Then a compass search goes on, which
needs none.
"""

from __future__ import annotations

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.descent import Visit
from trum_sym.optimiser.finish import Bounds, towards
from trum_sym.optimiser.model import Functions, Model

__all__ = ["compass", "stationarity"]

_EDGE = 1e-5  # of the box's side
_ACTIVE = 1e-4  # of a constraint's range in the box
_DIRECTIONS = 16
_FIRST, _LAST = 0.02, 1e-6  # radii, of the box's side
_ROUNDS = 60
_GAIN = 1e-7  # of the objective: less is rounding
_MET = 1e-5  # of a constraint's range, on the way


def stationarity(found: Visit, bounds: Bounds, scale: Array) -> float:
    """What is left of the scaled objective's slope when constraints and edges of the box have taken theirs.

    Parameters
    ----------
    found : Visit
        Place, values and slopes.
    bounds : Bounds
        Of the constraints.
    scale : (1 + k,) array
        Of objective and constraints.
    """
    slopes = found.slopes / scale[:, np.newaxis]
    if not np.all(np.isfinite(slopes)):
        return np.inf
    values = found.values[1:]
    at_low, at_high = (np.abs(values - bound) <= _ACTIVE * scale[1:] for bound in (bounds.low, bounds.high))
    active = slopes[1:][at_low | at_high]
    signs = np.where((at_low & at_high)[at_low | at_high], 0, np.where(at_low, 1, -1)[at_low | at_high])
    free = (found.share > _EDGE) & (found.share < 1 - _EDGE)
    force = np.linalg.lstsq(active[:, free].T, slopes[0, free], rcond=None)[0] if len(active) else np.empty(0)
    if np.any(force * signs < -1e-9):  # a border that holds the wrong way does not hold
        force = np.where(force * signs < 0, 0.0, force)
    rest = slopes[0] - force @ active
    held = np.where(
        found.share <= _EDGE, np.minimum(rest, 0), np.where(found.share >= 1 - _EDGE, np.maximum(rest, 0), rest)
    )
    return float(np.max(np.abs(held)))


def compass(model: Model, rows: Functions, bounds: Bounds, scale: Array, found: Visit, tolerance: float) -> Visit:
    """Tries places all around, brought onto the constraints, at smaller and smaller distances.

    Returns
    -------
    Visit
        The best place, with its values and the slopes of ``found``.
    """
    d = found.share.size
    rng = np.random.default_rng(0)
    best, value, radius = found.share, float(found.values[0]), _FIRST
    values = found.values
    slopes = found.slopes[1:] / bounds.unit[:, np.newaxis]
    for _ in range(_ROUNDS):
        if radius < _LAST:
            break
        around = rng.normal(size=(_DIRECTIONS, d))
        around /= np.linalg.norm(around, axis=1, keepdims=True)
        places = np.clip(best + radius * around, 0.0, 1.0)
        found_there = rows.values(model.results(model.box.at(places), tolerance))
        if bounds.unit.size:
            places = np.array(
                [
                    towards(place, slopes, bounds.excess(row[1:])) if np.all(np.isfinite(row)) else place
                    for place, row in zip(places, found_there, strict=True)
                ]
            )
            found_there = rows.values(model.results(model.box.at(places), tolerance))
        missed = np.max(np.abs(bounds.excess(found_there[:, 1:])) * bounds.unit / scale[1:], axis=1, initial=0.0)
        objective = np.where(missed <= _MET, found_there[:, 0], np.inf)
        objective = np.where(np.isfinite(objective), objective, np.inf)
        k = int(np.argmin(objective))
        if objective[k] < value - _GAIN * max(abs(value), scale[0] * 1e-3):
            best, value, values = places[k], float(objective[k]), found_there[k]
        else:
            radius /= 3
    return Visit(best, values, found.slopes)
