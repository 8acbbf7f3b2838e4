"""A speed table: the drive against the mean speed, and what it says of itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.choices import path_of
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.points import one_number
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import Asked, Holding, compared
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["Gap", "Segment", "SpeedTable"]

_ALWAYS = {"prepressure": "N", "frequency_difference": "Hz", "drive_frequency": "Hz"}


@dataclass(frozen=True, eq=False, kw_only=True)
class Segment(Value):
    """A stretch of speeds along which the drive varies continuously; arrays of one length, speeds rising.

    Speeds and their standard deviation in rad/s, drive frequency in Hz; ``drive`` has what varies, in SI units.
    ``speed_error`` bounds how far the mean speed at an entry's drive is from the entry's, rad/s.
    """

    speed: Array
    speed_error: Array
    deviation: Array
    drive_frequency: Array
    drive: Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Gap(Value):
    """Speeds that the table does not have, rad/s, and why."""

    low: float
    high: float
    reason: str


@dataclass(frozen=True, eq=False, kw_only=True)
class SpeedTable(Result, Value):
    """The drive against the mean speed.

    Attributes
    ----------
    motor : str
    drive : Drive
        What does not vary.
    variables : tuple of str
        What varies with the speed.
    segments : tuple of Segment
        By rising speed.
    gaps : tuple of Gap
        Speeds asked for that lie in no segment.
    error : float
        Largest difference, over the speed, between a speed and what the motor does at the drive interpolated linearly
        for it: not above it halfway between all neighbours, where it was evaluated.
    largest_error : float
        The largest that was seen there.
    floor : float
        Speed in rad/s of which ``error`` is taken where the speed is smaller, and the accuracy of the orbits.
    reachable : (float, float)
        Lowest and highest mean speed on the map of the box, which has a tolerance of 1e-2 of the swing, rad/s.
    evaluations : int
        Orbits computed.
    inputs : Inputs
        Motor, drive, levels, and the tolerance of the orbits.
    terms : Asked
        How near, against what and in what time the entries are to be held.
    """

    motor: str
    drive: Drive
    variables: tuple[str, ...]
    segments: tuple[Segment, ...]
    gaps: tuple[Gap, ...]
    error: float
    largest_error: float
    floor: float
    reachable: tuple[float, float]
    evaluations: int
    inputs: Inputs = field(repr=False)
    terms: Asked = field(repr=False, default_factory=Asked)

    def holdings(self, places: Sequence[int] | None = None) -> list[Holding]:
        """What it takes to hold the entries, counted through all segments; of all of them if no places are given."""
        rows: dict[str, Any] = {
            name: np.concatenate([segment.drive[name] for segment in self.segments]) for name in self.variables
        }
        chosen = range(len(self)) if places is None else places
        drives = {name: column[list(chosen)] for name, column in rows.items()}
        return self.terms.each(self.inputs.motor, replace(self.drive, **drives), self.inputs.levels) if chosen else []

    def __len__(self) -> int:
        return sum(segment.speed.size for segment in self.segments)

    def __repr__(self) -> str:
        return f"<SpeedTable {one_line(self.motor)}, {len(self)} entries, {len(self.gaps)} gaps>"

    def to_dict(self) -> dict[str, Any]:
        """Inputs, segments, every entry as a point, gaps and units by name, in SI units."""
        return _as_dict(self)

    def to_text(self) -> str:
        """The segments, the gaps, and how it was checked."""
        return _as_text(self)

    def held(self) -> str:
        """What does not vary of prepressure and frequency difference, in words."""
        numbers = self.drive.numbers()
        known = {"prepressure": "N", "frequency_difference": "Hz"}
        return ", ".join(f"{name} {numbers[name]:g} {known[name]}" for name in known if name not in self.variables)

    def at(self, speed: float | str) -> dict[str, float]:
        """The drive for a speed in rad/s, or text with a unit, linear between neighbours.

        Raises
        ------
        ParameterError
            For a speed that lies in no segment.
        """
        speed = one_number("speed", speed, "rad/s")
        for segment in self.segments:
            if segment.speed[0] <= speed <= segment.speed[-1]:
                return {name: float(np.interp(speed, segment.speed, x)) for name, x in segment.drive.items()}
        ranges = ", ".join(f"{s.speed[0]:.6g} to {s.speed[-1]:.6g}" for s in self.segments) or "none at all"
        raise ParameterError("speed", speed, f"a speed in a segment of the table, in rad/s: {ranges}")

    def columns(self) -> dict[str, str]:
        """The table's columns beside the speed, with units; the switching phase is one if it varies."""
        return {**_ALWAYS, "switching_phase": "rad"} if "switching_phase" in self.variables else dict(_ALWAYS)

    def values(self, segment: Segment) -> list[Array]:
        """The columns of a segment, a value an entry."""
        held = {**self.drive.numbers(), "drive_frequency": segment.drive_frequency}
        size = segment.speed.size
        return [np.asarray(np.broadcast_to(segment.drive.get(name, held[name]), size)) for name in self.columns()]

    def about(self) -> list[str]:
        """What holds for all entries, and the gaps, a line each."""
        drive = self.drive
        held = "" if len(self.variables) == 2 else f"{self.held()}, "
        phase = "" if "switching_phase" in self.variables else f", switching phase {drive.switching_phase:g} rad"
        lines = [
            f"speed table of {one_line(self.motor)}: {held}{drive.load_text()}, {drive.on_periods:g} of "
            f"{drive.periods:g} periods on, start {drive.start}, phase lead {drive.phase_lead:+g}" + phase,
            f"linear interpolation between entries meets the speed within {100 * self.error:g} % "
            f"(of {self.floor / ARCSEC:.6g} arcsec/s where it is slower); largest error seen "
            f"{100 * self.largest_error:.3g} %",
        ]
        for gap in self.gaps:
            lines.append(f"gap: {gap.low / ARCSEC:.9g} to {gap.high / ARCSEC:.9g} arcsec/s: {gap.reason}")
        if not self.gaps:
            lines.append("no gaps")
        if self.segments:
            most = max(float(segment.speed_error.max()) for segment in self.segments)
            lines.append(f"at the entries themselves the mean speed is off by {most / ARCSEC:.2g} arcsec/s at most")
        return lines

    def save(self, target: str | PathLike[str], name: str = "speed table") -> None:
        """Write a CSV file (.csv) or a C header (.h), whole or not at all.

        Raises
        ------
        ParameterError
            For another suffix, a table without entries, or a file that cannot be written.
        """
        from trum_sym.output.files import check_target, write_bytes
        from trum_sym.studies.table_files import Rows, as_c, as_csv

        path = path_of(name, target)
        check_target(name, path, (".csv", ".h"))
        if not self.segments:
            raise ParameterError(name, "a table without entries", "a range of speeds that the box has")
        rows = [Rows(s.speed, self.values(s), s.deviation, s.speed_error) for s in self.segments]
        csv = path.suffix == ".csv"
        text = (
            as_csv(self.about(), self.columns(), rows) if csv else as_c(path.stem, self.about(), self.columns(), rows)
        )
        write_bytes(name, text.encode(), path)


def _as_text(table: SpeedTable) -> str:
    """For people: the segments, the gaps, and how it was checked."""
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
    body = [text_table(rows, headers, "r" * len(headers))] if rows else ["no entries"]
    return "\n".join(
        [
            *table.about()[:2],
            "",
            *body,
            "",
            *table.about()[2:],
            *_held(table),
            f"mean speeds on the map of the box: about {low:.3g} to {high:.3g} arcsec/s; "
            f"{table.evaluations} orbits computed",
        ]
    )


_SHOWN = 7  # entries of which the summary says what it takes to hold them


def _held(table: SpeedTable) -> list[str]:
    """What it takes to hold some entries, evenly over the table, and their remarks."""
    if not len(table):
        return []
    places = np.unique(np.linspace(0, len(table) - 1, _SHOWN).round().astype(int)).tolist()
    speeds = np.concatenate([segment.speed for segment in table.segments])[places] / ARCSEC
    labels, holdings = [f"{speed:.6g}" for speed in speeds], table.holdings(places)
    lines = ["", compared(labels, holdings, "arcsec/s"), ""]
    for label, holding in zip(labels, holdings, strict=True):
        lines += [f"remark on {label} arcsec/s: {remark}" for remark in holding.remarks]
    return lines


def _as_dict(table: SpeedTable) -> dict[str, Any]:
    holdings = iter(table.holdings())
    record = {
        **table.inputs.record(),
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
                "mean_speed_error": segment.speed_error.tolist(),
            }
            for segment in table.segments
        ],
        "points": [
            {
                "mean_speed": float(segment.speed[k]),
                "drive": {name: float(x[k]) for name, x in segment.drive.items()},
                "holding": (held := next(holdings)).entries(),
                "remarks": held.remarks,
            }
            for segment in table.segments
            for k in range(segment.speed.size)
        ],
        "evaluations": table.evaluations,
        "remarks": [f"{gap.low:.9g} to {gap.high:.9g} rad/s: {gap.reason}" for gap in table.gaps],
    }
    return {**record, "units": units_of(record)}
