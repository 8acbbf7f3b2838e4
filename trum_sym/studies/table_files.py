"""A speed table as CSV, and as a C header that interpolates by itself."""

from __future__ import annotations

import math
import re

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.studies.speed_table import Segment, SpeedTable

__all__ = ["as_c", "as_csv", "as_json_text", "as_text"]

_ARCSEC = math.pi / 648000
_ALWAYS = (("prepressure", "N"), ("frequency_difference", "Hz"), ("drive_frequency", "Hz"))


def _named(table: SpeedTable) -> tuple[tuple[str, str], ...]:
    """The columns beside the speed, with units; the switching phase is one if it varies."""
    return (*_ALWAYS, ("switching_phase", "rad")) if "switching_phase" in table.variables else _ALWAYS


def _columns(table: SpeedTable, segment: Segment) -> list[Array]:
    """Their values at every entry."""
    held = {**table.drive.numbers(), "drive_frequency": segment.drive_frequency}
    size = segment.speed.size
    return [np.asarray(np.broadcast_to(segment.drive.get(name, held[name]), size)) for name, _ in _named(table)]


def _about(table: SpeedTable) -> list[str]:
    drive = table.drive
    held = "" if len(table.variables) == 2 else f"{table.held()}, "
    phase = "" if "switching_phase" in table.variables else f", switching phase {drive.switching_phase:g} rad"
    lines = [
        f"speed table of {table.motor}: {held}load {drive.load_torque:g} N m, {drive.on_periods:g} of "
        f"{drive.periods:g} periods on, start {drive.start}, phase lead {drive.phase_lead:+g}" + phase,
        f"linear interpolation between entries meets the speed within {100 * table.error:g} % "
        f"(of {table.floor / _ARCSEC:.6g} arcsec/s where it is slower); largest error seen "
        f"{100 * table.largest_error:.3g} %",
    ]
    for gap in table.gaps:
        lines.append(f"gap: {gap.low / _ARCSEC:.9g} to {gap.high / _ARCSEC:.9g} arcsec/s: {gap.reason}")
    if not table.gaps:
        lines.append("no gaps")
    return lines


def as_csv(table: SpeedTable) -> str:
    """One row an entry; comments on top say what holds for all, and name the gaps."""
    header = ["segment", "mean_speed [arcsec/s]", *(f"{name} [{unit}]" for name, unit in _named(table)),
              "speed_deviation [arcsec/s]"]  # fmt: skip
    lines = [*(f"# {line}" for line in _about(table)), ",".join(header)]
    for number, segment in enumerate(table.segments, 1):
        columns = [segment.speed / _ARCSEC, *_columns(table, segment), segment.deviation / _ARCSEC]
        lines += [",".join([str(number), *(f"{value:.15g}" for value in row)]) for row in zip(*columns, strict=True)]
    return "\n".join(lines) + "\n"


def as_c(table: SpeedTable, name: str) -> str:
    """A header for C99 and C++ without dependencies: the entries, and a function that interpolates them.

    Parameters
    ----------
    table : SpeedTable
        With at least one entry.
    name : str
        Of the table; what is no letter, digit or underscore becomes an underscore.
    """
    name = re.sub(r"\W", "_", name, flags=re.ASCII)
    name = name if re.match(r"[A-Za-z]", name) else f"table_{name}"
    upper = name.upper()
    begins = np.cumsum([0, *(segment.speed.size for segment in table.segments)])
    speeds = [value for segment in table.segments for value in segment.speed]
    rows = [row for segment in table.segments for row in zip(*_columns(table, segment), strict=True)]
    about = "\n".join(f" * {line}" for line in _about(table)).replace("*/", "* /")
    places = "\n".join(
        f"#define {upper}_{column.upper()} {k} /* {unit} */" for k, (column, unit) in enumerate(_named(table))
    )
    return _C_TEXT.format(
        about=about, name=name, upper=upper, places=places, columns=len(_named(table)), segments=len(table.segments),
        entries=len(speeds), begins=", ".join(str(int(begin)) for begin in begins),
        speeds=",\n    ".join(repr(float(speed)) for speed in speeds),
        rows=",\n    ".join("{" + ", ".join(repr(float(value)) for value in row) + "}" for row in rows),
    )  # fmt: skip


_C_TEXT = """\
/* Written by trum-sym; do not edit.
{about}
 */
#ifndef {upper}_H
#define {upper}_H

{places}
#define {upper}_COLUMNS {columns}
#define {upper}_SEGMENTS {segments}
#define {upper}_ENTRIES {entries}

/* The drive for a mean speed in rad/s, between entries on the line through them.
 * Returns 1, or 0 for a speed that lies in a gap or beyond the table; then drive stays as it is. */
static inline int {name}_drive(double speed, double drive[{upper}_COLUMNS])
{{
  static const double speeds[{upper}_ENTRIES] = {{
    {speeds}}};
  static const double entries[{upper}_ENTRIES][{upper}_COLUMNS] = {{
    {rows}}};
  static const int begins[{upper}_SEGMENTS + 1] = {{{begins}}};
  int segment, column;
  for (segment = 0; segment < {upper}_SEGMENTS; ++segment) {{
    int low = begins[segment], high = begins[segment + 1] - 1;
    double share;
    if (!(speed >= speeds[low] && speed <= speeds[high])) continue;
    while (high - low > 1) {{
      const int middle = low + (high - low) / 2;
      if (speed < speeds[middle]) high = middle;
      else low = middle;
    }}
    share = high > low ? (speed - speeds[low]) / (speeds[high] - speeds[low]) : 0.0;
    for (column = 0; column < {upper}_COLUMNS; ++column)
      drive[column] = entries[low][column] + share * (entries[high][column] - entries[low][column]);
    return 1;
  }}
  return 0;
}}

#endif
"""


def as_text(table: SpeedTable) -> str:
    """For people: the segments, the gaps, and how it was checked."""
    from tabulate import tabulate

    rows = []
    for number, segment in enumerate(table.segments, 1):
        ends = [f"{value:.6g}" for value in (segment.speed[[0, -1]] / _ARCSEC)]
        drives = [f"{column[0]:.7g} to {column[-1]:.7g}" for column in _columns(table, segment)]
        rows.append((number, segment.speed.size, *ends, *drives))
    headers = (
        "segment",
        "entries",
        "from arcsec/s",
        "to arcsec/s",
        *(f"{name} {unit}" for name, unit in _named(table)),
    )
    low, high = (speed / _ARCSEC for speed in table.reachable)
    body = (
        [tabulate(rows, headers, disable_numparse=True, colalign=("right",) * len(headers))] if rows else ["no entries"]
    )
    return "\n".join(
        [
            *_about(table)[:2], "", *body, "", *_about(table)[2:],
            f"mean speeds on the map of the box: {low:.6g} to {high:.6g} arcsec/s; {table.evaluations} orbits computed",
        ]
    )  # fmt: skip


def as_json_text(table: SpeedTable) -> str:
    """One JSON object in SI units."""
    import json

    record = {
        "motor": table.motor,
        "drive": {**{name: float(value) for name, value in table.drive.numbers().items()}, "start": table.drive.start},
        "variables": list(table.variables),
        "error": table.error,
        "largest_error": table.largest_error,
        "floor": table.floor,
        "reachable": list(table.reachable),
        "gaps": [{"low": gap.low, "high": gap.high, "reason": gap.reason} for gap in table.gaps],
        "segments": [
            {
                "mean_speed": segment.speed.tolist(),
                **{
                    name: column.tolist()
                    for (name, _), column in zip(_named(table), _columns(table, segment), strict=True)
                },
                "speed_deviation": segment.deviation.tolist(),
            }
            for segment in table.segments
        ],
        "evaluations": table.evaluations,
    }
    return json.dumps(record, indent=1, allow_nan=False)
