"""Formulas in a terminal: pictures that were made with the ledger, broken at operators where the width ends."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

__all__ = ["beside", "laid_out"]

Picture = dict[str, Any]
_INDENT = 4


def beside(pictures: Sequence[Picture]) -> tuple[list[str], int]:
    """Pictures side by side on one line of writing: the lines, all as long, and which of them that line is.

    Examples
    --------
    >>> half = {"lines": ["1", "─", "2"], "baseline": 1}
    >>> beside([{"lines": ["x = "], "baseline": 0}, half])
    (['    1', 'x = ─', '    2'], 1)
    """
    above = max(p["baseline"] for p in pictures)
    below = max(len(p["lines"]) - p["baseline"] for p in pictures)
    rows = [""] * (above + below)
    for p in pictures:
        width, first = max(map(len, p["lines"])), above - p["baseline"]
        for number in range(len(rows)):
            inside = 0 <= number - first < len(p["lines"])
            rows[number] += (p["lines"][number - first] if inside else "").ljust(width)
    return rows, above


def laid_out(picture: Picture, width: int) -> list[str]:
    """The lines of a formula that is at most ``width`` columns wide wherever it can be broken.

    Parameters
    ----------
    picture : dict
        ``lines`` and ``baseline``, and ``parts`` where it may be broken; see :mod:`derivations.ledger.terminal`.
    width : int
        Columns.

    Examples
    --------
    >>> parts = [{"lines": ["x = a"], "baseline": 0}, {"lines": [" + b"], "baseline": 0, "breaks": True}]
    >>> laid_out({"lines": ["x = a + b"], "baseline": 0, "parts": parts}, 8)
    ['x = a', '     + b']
    """
    if picture["lines"] and max(map(len, picture["lines"])) <= width:
        return [line.rstrip() for line in picture["lines"]]
    lines: list[str] = []
    for most in range(width - 2 * _INDENT, 0, -_INDENT):  # what stands before and behind a piece needs room, too
        lines = _rows(picture, width, most)
        if max(map(len, lines)) <= width:
            break
    return lines


def _rows(picture: Picture, width: int, most: int) -> list[str]:
    """The lines with pieces of at most ``most`` columns, where there are such."""
    rows: list[list[Picture]] = [[]]
    used = 0
    for group in _groups(_atoms(picture, most)):
        wide = sum(_width(p) for p in group)
        full = used + wide > width - (_INDENT if len(rows) > 1 else 0)
        if rows[-1] and (full or group[0].get("row")):
            rows.append([])
            used = 0
        rows[-1] += group
        used += wide
    found: list[str] = []
    for number, row in enumerate(rows):
        lines = beside(row)[0]
        if number and (len(lines) > 1 or len(found) > number):
            found.append("")  # what is taller than a line stands apart
        found += [" " * (_INDENT * (number > 0)) + line for line in lines]
    return [line.rstrip() for line in found]


def _width(picture: Picture) -> int:
    return max(map(len, picture["lines"]))


def _atoms(picture: Picture, width: int) -> Iterator[Picture]:
    """The largest pictures that are narrow enough, from left to right."""
    if "parts" not in picture or (picture["lines"] and _width(picture) <= width):
        yield picture
        return
    for number, part in enumerate(picture["parts"]):
        for place, atom in enumerate(_atoms(part, width)):
            first = number == 0 and place == 0
            yield {**atom, **{k: picture[k] for k in ("breaks", "row") if k in picture}} if first else atom


def _groups(atoms: Iterator[Picture]) -> Iterator[list[Picture]]:
    """Pictures that stand together: a new row begins where one of them lets it."""
    group: list[Picture] = []
    for atom in atoms:
        if group and (atom.get("breaks") or atom.get("row")):
            yield group
            group = []
        group.append(atom)
    if group:
        yield group
