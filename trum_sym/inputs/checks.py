"""Checks of numbers that come from outside: finite, real, inside their domain, of one shape."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from trum_sym.errors import ParameterError
from trum_sym.inputs.domain import Domain

__all__ = ["Array", "ArrayLike", "broadcast_shape", "number"]

Array: TypeAlias = npt.NDArray[np.float64]
ArrayLike: TypeAlias = float | Array


def number(name: str, value: object, domain: Domain, unit: str) -> ArrayLike:
    """Return ``value`` as a float or a read-only float64 array, or say what is wrong with it.

    Raises
    ------
    ParameterError
        If the value is not numeric, not real, not finite, or outside ``domain``.
    """
    allowed = domain.describe(unit)
    try:
        if np.ma.is_masked(value):
            raise TypeError
        raw = np.asarray(value)
        if raw.dtype.kind not in "iuf":
            raise TypeError
        with np.errstate(over="ignore"):
            values = raw.astype(np.float64)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    if values.size == 0:
        raise ParameterError(name, value, f"{allowed}; the array is empty")
    inside = domain.contains(values)
    if not inside.all():
        first = values[~inside].flat[0].item()
        raise ParameterError(name, first, allowed)
    if values.ndim == 0:
        return float(values)
    values.flags.writeable = False
    return values


def broadcast_shape(values: Mapping[str, ArrayLike]) -> tuple[int, ...]:
    """The common shape of named values.

    Raises
    ------
    ParameterError
        If the shapes do not broadcast; names the first value that does not fit and its shape.
    """
    shape: tuple[int, ...] = ()
    for name, value in values.items():
        try:
            shape = np.broadcast_shapes(shape, np.shape(value))
        except ValueError:
            raise ParameterError(
                name, f"shape {np.shape(value)}", f"a shape that broadcasts with {shape} of the parameters before it"
            ) from None
    return shape
