"""How ranges are written: ``160:210:51``, ``160:210:by=1``, ``160,180,200``, ``@FILE``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.csv_text import read_table
from trum_sym.inputs.units import parse_quantity

__all__ = ["MAX_VALUES", "Column", "is_range", "parse"]

MAX_VALUES = 10_000_000
"""Values on one axis: these are held in memory, unlike the grid."""

NOTATION = "LOW:HIGH:COUNT, LOW:HIGH:by=STEP, a list such as 1,2,3, or @FILE.csv"
_WHOLE = 1e-9  # how far from a whole number of steps a range may be, in steps


@dataclass(frozen=True)
class Column:
    """A column of a file: values that go with those of the file's other columns, row by row."""

    file: str
    values: Array


def is_range(text: str) -> bool:
    """Whether a text is meant as more than one value."""
    return text.lstrip().startswith("@") or ":" in text or "," in text


def parse(name: str, text: str, unit: str) -> float | Array | Column:
    """Read one value, a range, a list, or a column of a file, in the SI unit ``unit``.

    ``LOW:HIGH:COUNT`` are COUNT equidistant values, both ends among them; ``LOW:HIGH:by=STEP`` are those STEP apart,
    and STEP must divide the range.  Either each number carries a unit or none does.

    Raises
    ------
    ParameterError
        For what is none of these, an empty range, or a step that does not divide.
    """
    text = text.strip()
    if text.startswith("@"):
        return _column(name, text[1:].strip(), unit)
    if ":" in text:
        return _range(name, text, unit)
    if "," in text:
        return np.array(_numbers(name, text.split(","), text, unit))
    return parse_quantity(name, text, unit)


def _bare(text: str) -> bool:
    try:
        float(text.strip())
    except ValueError:
        return False
    return True


def _numbers(name: str, parts: list[str], text: str, unit: str) -> list[float]:
    if any(not part.strip() for part in parts):
        raise ParameterError(name, text, f"a number between any two separators: {NOTATION}")
    values = [parse_quantity(name, part, unit) for part in parts]
    if len({_bare(part) for part in parts}) > 1:
        raise ParameterError(name, text, f"a unit on every number, or on none (then in {unit})")
    return values


def _range(name: str, text: str, unit: str) -> Array:
    parts = [part.strip() for part in text.split(":")]
    if len(parts) != 3:
        raise ParameterError(name, text, NOTATION)
    key, by, step_text = parts[2].partition("=")
    if by and key.strip() != "by":
        raise ParameterError(name, text, NOTATION)
    if by:
        low, high, step = _numbers(name, [*parts[:2], step_text], text, unit)
        _check_finite(name, text, low, high, step)
        steps = (high - low) / step
        if steps < 0:
            raise ParameterError(name, text, "a step that leads from the first end to the second")
        if steps > MAX_VALUES or abs(steps - round(steps)) > _WHOLE * max(1.0, steps):
            raise ParameterError(name, text, f"a step that divides the range, which here is {steps:.6g} steps")
        count = round(steps) + 1
    else:
        low, high = _numbers(name, parts[:2], text, unit)
        _check_finite(name, text, low, high)
        count = _count(name, parts[2], text)
    if count < 2 or low == high:
        raise ParameterError(name, text, "a range of two values or more")
    return np.linspace(low, high, count)


def _check_finite(name: str, text: str, low: float, high: float, step: float = 1.0) -> None:
    if not all(map(math.isfinite, (low, high, high - low, step, (high - low) / (step or math.nan)))):
        raise ParameterError(name, text, "finite ends and a finite step that is not 0")


def _count(name: str, part: str, text: str) -> int:
    if not part.isdecimal() or not 2 <= int(part[:9]) <= MAX_VALUES or len(part) > 9:
        raise ParameterError(name, text, f"a whole number of values from 2 to {MAX_VALUES}, or by=STEP, after the ends")
    return int(part)


def _column(name: str, file: str, unit: str) -> Column:
    wanted = f"@ and the path of a CSV file with a column {name}"
    table = read_table(name, Path(file))
    titles = [cell.partition("[") for cell in table.header]
    places = [i for i, title in enumerate(titles) if title[0].strip() == name]
    if len(places) != 1:
        raise ParameterError(name, f"the columns {', '.join(map(str.strip, table.header))} in @{file}", wanted)
    place = places[0]
    given = titles[place][2].rstrip("] ")
    values = [_cell(name, file, line, row, place, unit, given) for line, row in table.rows()]
    if not 1 <= len(values) <= MAX_VALUES:
        raise ParameterError(name, f"{len(values)} rows in @{file}", f"{wanted} of 1 to {MAX_VALUES} rows")
    return Column(str(Path(file)), np.array(values))


def _cell(name: str, file: str, line: int, row: list[str], place: int, unit: str, given: str) -> float:
    if place >= len(row):
        raise ParameterError(name, f"{len(row)} columns in line {line} of @{file}", "as many columns as in the header")
    try:
        return parse_quantity(name, f"{row[place]} {given}", unit)
    except ParameterError as error:
        raise ParameterError(name, f"{error.got} in line {line} of @{file}", error.allowed) from None
