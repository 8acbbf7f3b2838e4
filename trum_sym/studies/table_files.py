"""A speed table's files: CSV, and a C header that interpolates by itself."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.units import ARCSEC
from trum_sym.output.c_text import EXACT_ARITHMETIC, as_comment
from trum_sym.text import one_line

__all__ = ["Rows", "as_c", "as_csv"]


def _as_text(line: str) -> str:
    """A comment that no spreadsheet reads a formula or a quoted cell in: a blank follows every separator."""
    return re.sub(r"([,;])(?=\S)", r"\1 ", one_line(line)).replace('"', "'")


class Rows(NamedTuple):
    """The entries of one segment: speeds, deviations and bounds of errors in rad/s, and the other columns."""

    speed: Array
    values: Sequence[Array]
    deviation: Array
    error: Array


def as_csv(about: Sequence[str], columns: Mapping[str, str], segments: Sequence[Rows]) -> str:
    """One row an entry; comments on top say what holds for all, and name the gaps.

    Parameters
    ----------
    about : sequence of str
        The comments.
    columns : mapping of str to str
        Names of the columns beside the speed, with units.
    segments : sequence of Rows
        With a value for each of the columns.
    """
    names = (f"{name} [{unit}]" for name, unit in columns.items())
    header = ["segment", "mean_speed [arcsec/s]", *names, "speed_deviation [arcsec/s]", "mean_speed_error [arcsec/s]"]
    lines = [*(f"# {_as_text(line)}" for line in about), ",".join(header)]
    for number, segment in enumerate(segments, 1):
        entries = [segment.speed / ARCSEC, *segment.values, segment.deviation / ARCSEC, segment.error / ARCSEC]
        lines += [",".join([str(number), *(f"{value:.15g}" for value in row)]) for row in zip(*entries, strict=True)]
    return "\n".join(lines) + "\n"


def as_c(name: str, about: Sequence[str], columns: Mapping[str, str], segments: Sequence[Rows]) -> str:
    """A header for C99 and C++ without dependencies: the entries, and a function that interpolates them.

    Its numbers are double, or float where it is compiled with ``-DTRUM_REAL_BITS=32``, as the C library's are.

    Parameters
    ----------
    name : str
        Of the table; what is no letter, digit or underscore becomes an underscore.
    about, columns, segments
        As for :func:`as_csv`; at least one entry.
    """
    name = re.sub(r"\W", "_", name, flags=re.ASCII)
    name = name if re.match(r"[A-Za-z]", name) else f"table_{name}"
    upper = name.upper()
    begins = np.cumsum([0, *(segment.speed.size for segment in segments)])
    speeds = [value for segment in segments for value in segment.speed]
    rows = [row for segment in segments for row in zip(*segment.values, strict=True)]
    comment = "\n".join(f" * {as_comment(line)}" for line in about)

    def number(value: float) -> str:
        return f"{upper}_C({float(value)!r})"

    places = (f"#define {upper}_{column.upper()} {k} /* {unit} */" for k, (column, unit) in enumerate(columns.items()))
    return _C_TEXT.format(
        about=comment,
        exact="\n".join(EXACT_ARITHMETIC),
        name=name,
        upper=upper,
        places="\n".join(places),
        columns=len(columns),
        segments=len(segments),
        entries=len(speeds),
        begins=", ".join(str(int(begin)) for begin in begins),
        speeds=",\n    ".join(number(speed) for speed in speeds),
        rows=",\n    ".join("{" + ", ".join(number(value) for value in row) + "}" for row in rows),
    )


_C_TEXT = """\
/* Written by trum-sym; do not edit.
{about}
 */
#ifndef {upper}_H
#define {upper}_H

#include <float.h>
#include <limits.h>

{exact}

/* The table's numbers: double, or float with -DTRUM_REAL_BITS=32. */
#ifndef TRUM_REAL_BITS
#define TRUM_REAL_BITS 64
#endif
#if TRUM_REAL_BITS == 32 && FLT_MANT_DIG == 24
typedef float {name}_real;
#elif TRUM_REAL_BITS == 64 && DBL_MANT_DIG == 53
typedef double {name}_real;
#else
#error "trum: TRUM_REAL_BITS is 64 or 32, and double or float has to have as many bits"
#endif
typedef char {name}_real_has_other_bits[sizeof({name}_real) * CHAR_BIT == TRUM_REAL_BITS ? 1 : -1];
#define {upper}_C(x) (({name}_real)(x))

{places}
#define {upper}_COLUMNS {columns}
#define {upper}_SEGMENTS {segments}
#define {upper}_ENTRIES {entries}

/* The drive for a mean speed in rad/s, between entries on the line through them.
 * Returns 1, or 0 for a speed that lies in a gap or beyond the table; then drive stays as it is. */
static inline int {name}_drive({name}_real speed, {name}_real drive[{upper}_COLUMNS])
{{
  static const {name}_real speeds[{upper}_ENTRIES] = {{
    {speeds}}};
  static const {name}_real entries[{upper}_ENTRIES][{upper}_COLUMNS] = {{
    {rows}}};
  static const int begins[{upper}_SEGMENTS + 1] = {{{begins}}};
  int segment, column;
  for (segment = 0; segment < {upper}_SEGMENTS; ++segment) {{
    int low = begins[segment], high = begins[segment + 1] - 1;
    {name}_real share;
    if (!(speed >= speeds[low] && speed <= speeds[high])) continue;
    while (high - low > 1) {{
      const int middle = low + (high - low) / 2;
      if (speed < speeds[middle]) high = middle;
      else low = middle;
    }}
    share = high > low ? (speed - speeds[low]) / (speeds[high] - speeds[low]) : {upper}_C(0.0);
    for (column = 0; column < {upper}_COLUMNS; ++column)
      drive[column] = entries[low][column] + share * (entries[high][column] - entries[low][column]);
    return 1;
  }}
  return 0;
}}

#endif
"""
