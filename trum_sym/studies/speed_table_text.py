"""A speed table for people and for programs."""

from __future__ import annotations

from trum_sym.inputs.units import ARCSEC
from trum_sym.output.json_text import json_text
from trum_sym.studies.speed_table_result import SpeedTable

__all__ = ["as_json_text", "as_text"]


def as_text(table: SpeedTable) -> str:
    """For people: the segments, the gaps, and how it was checked."""
    from tabulate import tabulate

    rows = []
    for number, segment in enumerate(table.segments, 1):
        ends = [f"{value:.6g}" for value in (segment.speed[[0, -1]] / ARCSEC)]
        drives = [f"{column[0]:.7g} to {column[-1]:.7g}" for column in table.values(segment)]
        rows.append((number, segment.speed.size, *ends, *drives))
    headers = (
        "segment",
        "entries",
        "from arcsec/s",
        "to arcsec/s",
        *(f"{name} {unit}" for name, unit in table.columns().items()),
    )
    low, high = (speed / ARCSEC for speed in table.reachable)
    body = (
        [tabulate(rows, headers, disable_numparse=True, colalign=("right",) * len(headers))] if rows else ["no entries"]
    )
    return "\n".join(
        [
            *table.about()[:2],
            "",
            *body,
            "",
            *table.about()[2:],
            f"mean speeds on the map of the box: {low:.6g} to {high:.6g} arcsec/s; {table.evaluations} orbits computed",
        ]
    )


def as_json_text(table: SpeedTable) -> str:
    """One JSON object in SI units."""
    record = {
        "motor": table.motor,
        "drive": {**{name: float(value) for name, value in table.drive.numbers().items()}, **table.drive.words()},
        "variables": list(table.variables),
        "error": table.error,
        "largest_error": table.largest_error,
        "floor": table.floor,
        "reachable": list(table.reachable),
        "gaps": [{"low": gap.low, "high": gap.high, "reason": gap.reason} for gap in table.gaps],
        "segments": [
            {
                "mean_speed": segment.speed.tolist(),
                **{name: column.tolist() for name, column in zip(table.columns(), table.values(segment), strict=True)},
                "speed_deviation": segment.deviation.tolist(),
            }
            for segment in table.segments
        ],
        "evaluations": table.evaluations,
    }
    return json_text(record)
