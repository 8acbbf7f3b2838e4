"""The grid of a sweep: its axes, how it falls into chunks, and the values at any part of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from trum_sym.errors import ParameterError
from trum_sym.inputs.carried import Labels, labels_of
from trum_sym.inputs.checks import Array, ArrayLike, check_labels, number
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS
from trum_sym.inputs.motor import SPECS
from trum_sym.sweeps.notation import MAX_VALUES, Column, parse

__all__ = ["PARAMETERS", "Axis", "Grid", "chunk_shape", "read_ranges"]

_OWN = {"phase_lead": (Domain(), "1"), "sampling_period": (Domain(low=0.0), "s")}
PARAMETERS: Mapping[str, tuple[Domain, str]] = {
    **DRIVE_DOMAINS,
    **_OWN,
    **{name: (spec.domain, spec.unit) for name, spec in SPECS.items()},
}
"""What can be swept: domain and unit by name."""


@dataclass(frozen=True)
class Axis:
    """One dimension: a parameter's values, or those of several parameters that vary together, each of one length."""

    name: str
    values: Mapping[str, Array]

    @property
    def size(self) -> int:
        """How many values."""
        return int(next(iter(self.values.values())).size)


@dataclass(frozen=True)
class Grid:
    """The outer product of axes; never laid out as a whole."""

    axes: tuple[Axis, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Values on each axis."""
        return tuple(axis.size for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def mesh(self, where: tuple[slice, ...]) -> dict[str, Array]:
        """The values in a part of the grid, shaped so that they broadcast to it."""
        count = len(self.axes)
        return {
            name: values[part].reshape([-1 if i == place else 1 for i in range(count)])
            for place, (axis, part) in enumerate(zip(self.axes, where, strict=True))
            for name, values in axis.values.items()
        }

    def points(self, numbers: npt.NDArray[np.int64]) -> dict[str, Array]:
        """The values at points that are numbered in C order."""
        places = np.unravel_index(numbers, self.shape)
        return {
            name: values[place]
            for axis, place in zip(self.axes, places, strict=True)
            for name, values in axis.values.items()
        }


def chunk_shape(shape: tuple[int, ...], points: int) -> tuple[int, ...]:
    """Equal chunks of at most ``points`` points, the last axes whole as far as they go."""
    chunk = []
    for length in reversed(shape):
        pieces = math.ceil(length / max(1, min(length, points)))
        side = math.ceil(length / pieces)
        chunk.append(side)
        points = points // side
    return tuple(reversed(chunk))


def read_ranges(ranges: Mapping[str, object]) -> tuple[dict[str, ArrayLike], Grid]:
    """What does not vary, and the grid of what does.

    Parameters
    ----------
    ranges : mapping
        By name: a number, a sequence, a text in the notation of :func:`trum_sym.sweeps.notation.parse`, or a
        one-dimensional xarray.DataArray; those of one dimension vary together, as do columns of one file.  Quantities
        and DataArrays with ``attrs["units"]`` are converted.

    Raises
    ------
    ParameterError
        For an unknown name, values outside their domain, an empty axis, a value twice on it, nothing that varies, or
        one dimension with two indices.
    """
    fixed: dict[str, ArrayLike] = {}
    axes: dict[str, dict[str, Array]] = {}
    files: dict[str, str] = {}
    labels: dict[str, dict[str, Labels]] = {}
    for name, given in ranges.items():
        domain, unit = _parameter(name)
        value: Any = parse(name, given, unit) if isinstance(given, str) else given
        dimension = name
        if isinstance(value, Column):
            dimension = files.setdefault(value.file, f"row_{len(files) + 1}" if files else "row")
            value = value.values
        elif (known := labels_of(value)) is not None and len(known.dimensions) == 1 and hasattr(value, "dims"):
            (dimension,) = known.dimensions
            labels.setdefault(dimension, {})[name] = known
        checked = number(name, value, domain, unit)
        _check_lead(name, checked)
        if isinstance(checked, float):
            fixed[name] = checked
            continue
        if checked.ndim != 1 or checked.size > MAX_VALUES:
            raise ParameterError(name, f"an array of shape {checked.shape}", f"1 to {MAX_VALUES} values in a row")
        if dimension == name:
            _check_distinct(name, checked)
        axes.setdefault(str(dimension), {})[name] = np.asarray(checked)
    for together in labels.values():
        check_labels(together)
    _check_axes(axes)
    return fixed, Grid(tuple(Axis(dimension, values) for dimension, values in axes.items()))


def _parameter(name: str) -> tuple[Domain, str]:
    if name not in PARAMETERS:
        from difflib import get_close_matches

        close = get_close_matches(name, PARAMETERS, n=3, cutoff=0.5)
        hint = f"; close names: {', '.join(close)}" if close else ""
        raise ParameterError("swept parameter", name, f"a number of the drive or a value of the motor file{hint}")
    return PARAMETERS[name]


def _check_lead(name: str, value: ArrayLike) -> None:
    if name == "phase_lead" and np.any(np.abs(value) != 1):
        raise ParameterError(name, value, "1, -1 or both")


def _check_distinct(name: str, values: Array) -> None:
    found, counts = np.unique(values, return_counts=True)
    if found.size < values.size:
        raise ParameterError(name, f"{found[counts > 1][0]:g} more than once", "each value once")


def _check_axes(axes: Mapping[str, Mapping[str, Array]]) -> None:
    if not axes:
        raise ParameterError("sweep", "no range", "at least one parameter with a range, such as prepressure=160:210:51")
    swept = {name for values in axes.values() for name in values}
    for dimension, values in axes.items():
        if len({column.size for column in values.values()}) > 1:
            sizes = ", ".join(f"{name} {column.size}" for name, column in values.items())
            raise ParameterError(
                f"dimension {dimension}", sizes, "as many values of each parameter that varies along it"
            )
        if dimension in swept - set(values) or (dimension in PARAMETERS and len(values) > 1):
            raise ParameterError(f"dimension {dimension}", dimension, "a name that is not that of a parameter")
