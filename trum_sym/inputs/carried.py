"""What a number brings along: the unit of a quantity, the dimensions and the index of a labelled array.

pint, astropy, unyt, xarray and pandas are known by what their objects have, and none of them is imported.
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from trum_sym.errors import ParameterError, shorten
from trum_sym.inputs.units import parse_unit, unit_for

__all__ = ["LabelledArray", "Labels", "in_unit", "labels_of", "magnitude_and_unit"]

_DEEPEST = 32  # lists in each other, as NumPy has it
_PLAIN = (float, int, bool, complex, str, bytes, np.ndarray, np.generic, type(None))


class Labels(NamedTuple):
    """Names of the dimensions, and along each the index, None where there is none."""

    dimensions: tuple[str, ...]
    indices: tuple[npt.NDArray[Any] | None, ...]

    def fits(self, other: Labels) -> bool:
        """Whether values at the same places belong together."""
        return self.dimensions == other.dimensions and all(
            a is None or b is None or np.array_equal(a, b) for a, b in zip(self.indices, other.indices, strict=True)
        )

    def __str__(self) -> str:
        return ", ".join(
            name if index is None else f"{name} {shorten(np.array2string(index, threshold=4, edgeitems=1))}"
            for name, index in zip(self.dimensions, self.indices, strict=True)
        )


class LabelledArray(np.ndarray[tuple[int, ...], np.dtype[np.float64]]):
    """Numbers that still know their labels, so that others can be compared with them; results are plain arrays."""

    labels: Labels | None = None

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:  # noqa: ANN401
        """What is computed has no labels."""
        plain = np.asarray(array)
        return plain[()] if return_scalar else plain


def labels_of(value: object) -> Labels | None:
    """The labels of an xarray.DataArray or a pandas object, else None."""
    if isinstance(value, LabelledArray):
        return value.labels
    if isinstance(value, _PLAIN):
        return None
    if _has(value, "dims", "coords"):
        found: Any = value
        indices = tuple(np.asarray(found.coords[name]) if name in found.coords else None for name in found.dims)
        return Labels(tuple(map(str, found.dims)), indices) if found.dims else None
    if _has(value, "index", "iloc"):
        found = value
        rows = np.asarray(found.index)
        columns = (np.asarray(found.columns),) if hasattr(found, "columns") else ()
        return Labels(("index", "columns")[: 1 + len(columns)], (rows, *columns))
    return None


def _has(value: object, *names: str) -> bool:
    """Whether the type has all of these; its instances may answer to any name."""
    return all(hasattr(type(value), name) for name in names)


def magnitude_and_unit(name: str, value: object, depth: int = 0) -> tuple[object, str | None]:
    """A value without its unit, and the unit as text; None where it carries none.

    Raises
    ------
    ParameterError
        For a list in which some numbers carry a unit and some do not, or something with a unit but no number.
    TypeError
        For what is neither a number nor a list or an array of them.
    """
    if isinstance(value, list | tuple):
        return _of_list(name, value, depth)
    if type(value) in _PLAIN or isinstance(value, np.generic):
        return value, None
    if not (isinstance(value, float | int | range | array) or _has(value, "__array__") or _has(value, "__float__")):
        raise TypeError  # a sequence of a stranger's making may have no end
    if _has(value, "attrs"):  # xarray, pandas: their other attributes may be columns and coordinates
        return _of_labelled(name, value)
    unit = next((found for key in ("units", "unit") if (found := _attribute(value, key)) is not None), None)
    if unit is None:
        return value, None
    if isinstance(value, np.ndarray):
        return np.asarray(value.view(np.ndarray)), _text(unit)
    for key in ("magnitude", "value", "values"):
        magnitude = _attribute(value, key)
        if magnitude is not None and not _is_time(value):
            return magnitude, _text(unit)
    raise ParameterError(name, value, "a number, or a quantity with a magnitude and a unit")


def _attribute(value: object, name: str) -> Any:  # noqa: ANN401
    """An attribute that is no method; None if it has none, or says only that it cannot."""
    try:
        found = getattr(value, name, None)
    except Exception:  # whatever a stranger's property raises, it yields no unit
        return None
    return None if callable(found) and not hasattr(found, "to_string") else found


def _is_time(value: object) -> bool:
    """Whether it is a span of time whose unit is not that of its number, as pandas has it."""
    return hasattr(type(value), "total_seconds")


def _text(unit: object) -> str:
    # quantities' units are numbers of one; its dimensionality is the text
    text = str(getattr(unit, "dimensionality", unit)) if isinstance(unit, np.ndarray) else str(unit)
    return text.strip() or "1"


def _of_labelled(name: str, value: object) -> tuple[object, str | None]:
    found: Any = value
    inner = getattr(found, "data", None) if _has(value, "dims") else getattr(found, "array", None)
    if inner is not None and hasattr(inner, "quantity"):  # pint's arrays in pandas
        inner = inner.quantity
    if inner is not None and not isinstance(inner, _PLAIN):
        magnitude, unit = magnitude_and_unit(name, inner)
        if unit is not None:
            return magnitude, unit
    attributes = found.attrs
    unit = attributes.get("units", attributes.get("unit")) if isinstance(attributes, Mapping) else None
    return np.asarray(found), None if unit is None else _text(unit)


def _of_list(name: str, value: list[Any] | tuple[Any, ...], depth: int) -> tuple[object, str | None]:
    """A list of quantities, all in the unit of the first."""
    if all(type(entry) in _PLAIN for entry in value):
        return value, None
    if depth == _DEEPEST:
        raise TypeError
    parts = [magnitude_and_unit(name, entry, depth + 1) for entry in value]
    units = {unit for _, unit in parts}
    if units <= {None}:
        return value, None
    if None in units:
        raise ParameterError(name, value, "a unit on every number, or on none")
    first = next(unit for _, unit in parts if unit is not None)
    return [in_unit(name, magnitude, unit, first) for magnitude, unit in parts], first


def in_unit(name: str, magnitude: object, given: str | None, wanted: str | None) -> object:
    """A magnitude converted; as it is where no unit was given, to SI where any is wanted.

    Raises
    ------
    ParameterError
        For a unit that is unknown or does not convert.
    """
    if given is None or given == wanted:
        return magnitude
    raw = np.asarray(magnitude)
    allowed = "a quantity in a unit that is known" if wanted is None else f"a quantity that converts to {wanted}"
    if raw.dtype.kind not in "iuf":
        raise ParameterError(name, magnitude, allowed)
    try:
        single = float(raw) if raw.ndim == 0 else None
        unit = parse_unit(given) if wanted is None else unit_for(given, wanted, single)
        target = 1.0 if wanted is None else parse_unit(wanted).to_si(1.0)
    except ValueError as error:
        got = f"{single:.12g} {given}" if single is not None else f"an array in {given}"
        raise ParameterError(name, got, f"{allowed} ({error})" if str(error) else allowed) from None
    with np.errstate(over="ignore"):
        converted = unit.to_si(raw.astype(np.float64))
    return converted if target == 1.0 else converted / target
