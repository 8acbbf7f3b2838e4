"""Checks of numbers that come from outside: finite, real, inside their domain, of one shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from trum_sym.errors import ParameterError

__all__ = ["Array", "ArrayLike", "Domain", "broadcast_shape", "number"]

Array: TypeAlias = npt.NDArray[np.float64]
ArrayLike: TypeAlias = float | Array


@dataclass(frozen=True)
class Domain:
    """An interval, open or closed at each end, of the reals or of the integers."""

    low: float = -np.inf
    high: float = np.inf
    low_open: bool = True
    high_open: bool = True
    integer: bool = False

    def describe(self, unit: str) -> str:
        """The domain in words, with its unit."""
        kind = "an integer" if self.integer else "a finite number"
        bounds = []
        if np.isfinite(self.low):
            bounds.append(f"{'>' if self.low_open else '>='} {self.low:g}")
        if np.isfinite(self.high):
            bounds.append(f"{'<' if self.high_open else '<='} {self.high:g}")
        where = " " + " and ".join(bounds) if bounds else ""
        return f"{kind}{where}" + (f" in {unit}" if unit != "1" else "")

    def contains(self, values: Array) -> npt.NDArray[np.bool_]:
        """Element by element: is the value finite and inside?"""
        inside = np.isfinite(values)
        inside &= values > self.low if self.low_open else values >= self.low
        inside &= values < self.high if self.high_open else values <= self.high
        if self.integer:
            inside &= values == np.floor(values)
        return inside


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
