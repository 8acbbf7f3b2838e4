"""Rows of words under headers: what every answer's table looks like.

Own lines in place of tabulate, whose import takes a tenth of a whole ``trum-sym evaluate``; it makes the same of words.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

__all__ = ["text_table"]


def text_table(rows: Sequence[Sequence[object]], headers: Sequence[str] = (), align: str = "") -> str:
    """Columns two blanks apart, a rule below the headers.

    Parameters
    ----------
    rows : sequence of rows
        Cells as they are to be read; None is an empty one.
    headers : sequence of str
        One a column, of one line or more; none, and no rule, if not given.
    align : str
        ``l`` or ``r`` for every column from the first; the others are aligned to the left.

    Examples
    --------
    >>> print(text_table([("mean speed", "-1.5"), ("swing", "12")], ("", "rad/s"), "lr"))
                  rad/s
    ----------  -------
    mean speed     -1.5
    swing            12
    """
    cells = [["" if cell is None else str(cell).strip() for cell in row] for row in rows]
    titles = [header.split("\n") for header in headers]
    columns = list(zip(*cells, strict=True)) or [()] * len(titles)
    widths = [max((len(cell) for cell in column), default=0) for column in columns]
    if titles:
        widths = [max(width, 2 + max(map(len, title))) for width, title in zip(widths, titles, strict=True)]
    rights = [side == "r" for side, _ in zip_longest(align, widths, fillvalue="l")]

    def line(words: Sequence[str]) -> str:
        placed = zip(words, widths, rights, strict=True)
        return "  ".join(word.rjust(width) if right else word.ljust(width) for word, width, right in placed).rstrip()

    lines = [line(words) for words in zip_longest(*titles, fillvalue="")]
    lines += ["  ".join("-" * width for width in widths)] * bool(titles)
    return "\n".join([*lines, *map(line, cells)])
