"""Checks of numbers that come from outside: finite, real, inside their domain, of one shape."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from trum_sym.errors import ParameterError
from trum_sym.inputs.carried import LabelledArray, Labels, in_unit, labels_of, magnitude_and_unit
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.units import parse_quantity

__all__ = ["Array", "ArrayLike", "broadcast_shape", "check_labels", "number", "outside", "quantity"]

Array: TypeAlias = npt.NDArray[np.float64]
ArrayLike: TypeAlias = float | Array


def number(name: str, value: object, domain: Domain, unit: str) -> ArrayLike:
    """Return ``value`` as a float or a read-only float64 array, or say what is wrong with it.

    Text is read as a number with a unit, ``"170 N"``.  A value that carries a unit, as pint's and astropy's quantities
    or an xarray.DataArray with ``attrs["units"]`` do, is converted; one that
    carries none is in ``unit``, the SI unit.  Labels stay with the array.

    Raises
    ------
    ParameterError
        If the value is not numeric, not real, not finite, outside ``domain``, or in a unit that does not convert.
    """
    return quantity(name, value, domain, unit)[0]


def quantity(name: str, value: object, domain: Domain, unit: str | None) -> tuple[ArrayLike, str | None]:
    """As :func:`number`, and the unit that the value carried, None if it carried none.

    ``unit`` is None where a value may be of any kind; it is then in SI.
    """
    if type(value) is float and domain.contains(np.asarray(value)):  # most often, and not to be made anew
        return value, None
    allowed = domain.describe(unit or "its SI unit")
    value = _spelt_out(name, value, unit)
    try:
        if "numpy.ma" in sys.modules and np.ma.is_masked(value):  # else there is no masked array, nor need of it
            raise TypeError
        magnitude, given = magnitude_and_unit(name, value)
        raw = np.asarray(in_unit(name, magnitude, given, unit))
        if raw.dtype.kind not in "iuf":
            raise TypeError
        with np.errstate(over="ignore"):
            values = raw.astype(np.float64)
        labels = labels_of(value)
    except ParameterError:
        raise
    except Exception:  # whatever an object raises that was asked for its numbers, it is no number
        raise ParameterError(name, value, allowed) from None
    if values.size == 0:
        raise ParameterError(name, value, f"{allowed}; the array is empty")
    inside = domain.contains(values)
    if not inside.all():
        first = values[~inside].flat[0].item()
        raise ParameterError(name, first, allowed)
    if values.ndim == 0:
        return float(values), given
    if labels is not None and len(labels.dimensions) == values.ndim:
        labelled = values.view(LabelledArray)
        labelled.labels = labels
        values = labelled
    values.flags.writeable = False
    return values, given


def _spelt_out(name: str, value: object, unit: str | None) -> object:
    """Numbers for text such as ``"170 N"``, or a list of it; anything else as it is."""
    if unit is None:
        return value
    if isinstance(value, str):
        return parse_quantity(name, value, unit)
    if isinstance(value, list | tuple) and value and all(isinstance(entry, str) for entry in value):
        return [parse_quantity(name, entry, unit) for entry in value]
    return value


def outside(value: ArrayLike, low: ArrayLike, high: ArrayLike) -> npt.NDArray[np.bool_]:
    """Where ``value`` lies outside ``low`` to ``high`` by more than a rounding, as of a unit's conversion.

    NaN lies outside.
    """
    slack = 1e-12 * np.maximum(np.abs(low), np.abs(high))
    return ~((np.asarray(value) >= low - slack) & (np.asarray(value) <= high + slack))


def check_labels(labels: Mapping[str, Labels | None]) -> None:
    """Refuse labelled arrays that would go together place by place although their labels are not the same.

    Raises
    ------
    ParameterError
        Which names both.
    """
    known = [(name, found) for name, found in labels.items() if found is not None]
    for name, found in known[1:]:
        if not found.fits(known[0][1]):
            raise ParameterError(
                name,
                f"labels {found}",
                f"those of {known[0][0]}, {known[0][1]}: labelled arrays go together by name; align them, give their "
                "bare values, or let sweep cross their dimensions",
            )


def broadcast_shape(values: Mapping[str, ArrayLike]) -> tuple[int, ...]:
    """The common shape of named values.

    Raises
    ------
    ParameterError
        If the shapes do not broadcast, or labelled arrays have unlike labels; names the first value that does not fit.
    """
    arrays = {name: value for name, value in values.items() if type(value) not in (float, int)}
    check_labels({name: labels_of(value) for name, value in arrays.items()})
    shape: tuple[int, ...] = ()
    for name, value in arrays.items():
        try:
            shape = np.broadcast_shapes(shape, np.shape(value))
        except ValueError:
            raise ParameterError(
                name, f"shape {np.shape(value)}", f"a shape that broadcasts with {shape} of the parameters before it"
            ) from None
    return shape
