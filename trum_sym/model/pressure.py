"""The highest contact pressure of a drive cycle: what a friction layer's wear goes by (eqs. 28, 30, 31)."""

from __future__ import annotations

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.cycle import response
from trum_sym.model.kernels import call
from trum_sym.model.operating_point import Case

__all__ = ["peak_pressure"]

_SAMPLES = 32  # in a drive period; the wave's height oscillates twice in one
_RIVALS = 3  # crests of the height that are followed to their top
_ZOOMS = 4


def peak_pressure(case: Case) -> Array:
    """Pressure under the crest when the wave is highest, Pa, of the case's shape.

    Under a constant prepressure the contact is the narrower, and its pressure the higher, the higher the wave is.
    Exact to 1e-9 but where two of the cycle's tops change places, which is a kink.

    Parameters
    ----------
    case : Case
        From :func:`trum_sym.model.operating_point.prepare`.
    """
    values = {name: np.broadcast_to(value, case.shape) for name, value in case.arguments.items()}
    height = _highest(values)
    if np.all(np.asarray(case.arguments["hertz"]) > 0.5):
        touching = call("trum_contact_hertz", {"W_c": height, "W_full": values["W_full"]})
    else:
        filling = call("trum_filling", {"W_c": height, "engagement_per_height": values["engagement_per_height"]})
        fullness = np.asarray(filling["fullness"])
        layer = call("trum_contact_winkler", {"fullness": fullness, "fullness_root": np.cbrt(fullness)})
        touching = {**layer, "engagement": filling["engagement"]}
    pressure = call("trum_peak_pressure", {**case.symbols, **touching})["pressure"]
    return np.broadcast_to(np.asarray(pressure, np.float64), case.shape)


def _highest(values: dict[str, Array]) -> Array:
    """The wave's greatest height W_c in the cycle, m."""
    shape = values["m"].shape
    column: dict[str, ArrayLike] = {name: value[..., np.newaxis] for name, value in values.items()}
    period = 2 * np.pi / np.add(column["omega_n"], column["Delta_omega"])

    def height(turns: Array) -> Array:
        both = response(np.clip(turns, 0.0, column["m"]) * period, column)
        return np.hypot(both["w_A"], both["w_B"])

    count = int(np.max(values["m"])) * _SAMPLES
    turns = np.broadcast_to(np.arange(count + 1) / _SAMPLES, (*shape, count + 1))
    found = height(turns)
    left, right = np.roll(found, 1, axis=-1), np.roll(found, -1, axis=-1)
    tops = (found >= left) & (found >= right)
    rivals = np.argsort(np.where(tops, _vertex(left, found, right), 0.0), axis=-1)[..., -_RIVALS:]
    at = np.take_along_axis(turns, rivals, axis=-1)
    half = 1.0 / _SAMPLES
    for _ in range(_ZOOMS):
        offsets = np.linspace(-half, half, 9)
        places = at[..., np.newaxis] + offsets
        there = height(places.reshape(*shape, -1)).reshape(places.shape)
        at = np.take_along_axis(places, there.argmax(axis=-1)[..., np.newaxis], axis=-1)[..., 0]
        half = offsets[-1] - offsets[-2]
    return np.asarray(_vertex(height(at - half), height(at), height(at + half)).max(axis=-1))


def _vertex(left: Array, middle: Array, right: Array) -> Array:
    """Top of the parabola through three values of which the middle one is the highest."""
    bend = np.minimum(left + right - 2 * middle, -1e-300)
    tops = (middle >= left) & (middle >= right)
    return np.asarray(np.where(tops, middle - (right - left) ** 2 / (8 * bend), middle))
