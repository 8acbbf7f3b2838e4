"""Speed tables: the drive for every mean speed of a range, so that a controller may interpolate between them."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, Domain, number
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.stator import Amplitude, Contact, Foundation, Levels, Resonance
from trum_sym.optimiser.chart import chart
from trum_sym.optimiser.model import Model
from trum_sym.optimiser.search import one_number
from trum_sym.studies.posed import Bound, posed
from trum_sym.studies.table_builder import Builder, Entry

__all__ = ["Gap", "Segment", "SpeedTable", "speed_table"]

_DIVISIONS = {1: 513, 2: 33, 3: 11}
_DIRECTIONS = ("both", "positive", "negative")
_COUNT = Domain(low=2, low_open=False, high=1000, high_open=False, integer=True)


@dataclass(frozen=True, kw_only=True)
class Segment:
    """A stretch of speeds along which the drive varies continuously; arrays of one length, speeds rising.

    Speeds and their standard deviation in rad/s, drive frequency in Hz; ``drive`` has what varies, in SI units.
    """

    speed: Array
    deviation: Array
    drive_frequency: Array
    drive: Mapping[str, Array]


@dataclass(frozen=True)
class Gap:
    """Speeds that the table does not have, rad/s, and why."""

    low: float
    high: float
    reason: str


@dataclass(frozen=True, kw_only=True)
class SpeedTable:
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
        Lowest and highest mean speed on the map of the box, rad/s.
    evaluations : int
        Orbits computed.
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

    def __len__(self) -> int:
        return sum(segment.speed.size for segment in self.segments)

    def held(self) -> str:
        """What does not vary of prepressure and frequency difference, in words."""
        numbers = self.drive.numbers()
        known = {"prepressure": "N", "frequency_difference": "Hz"}
        return ", ".join(f"{name} {numbers[name]:g} {known[name]}" for name in known if name not in self.variables)

    def at(self, speed: float) -> dict[str, float]:
        """The drive for a speed in rad/s, linear between neighbours.

        Raises
        ------
        ParameterError
            For a speed that lies in no segment.
        """
        for segment in self.segments:
            if segment.speed[0] <= speed <= segment.speed[-1]:
                return {name: float(np.interp(speed, segment.speed, x)) for name, x in segment.drive.items()}
        ranges = ", ".join(f"{s.speed[0]:.6g} to {s.speed[-1]:.6g}" for s in self.segments) or "none at all"
        raise ParameterError("speed", speed, f"a speed in a segment of the table, in rad/s: {ranges}")

    def save(self, target: str | PathLike[str], name: str = "speed table") -> None:
        """Write a CSV file (.csv) or a C header (.h), whole or not at all.

        Raises
        ------
        ParameterError
            For another suffix, a table without entries, or a file that cannot be written.
        """
        from trum_sym.output.files import check_target, write_bytes
        from trum_sym.studies.table_files import as_c, as_csv

        path = Path(target)
        check_target(name, path, (".csv", ".h"))
        if not self.segments:
            raise ParameterError(name, "a table without entries", "a range of speeds that the box has")
        text = as_csv(self) if path.suffix == ".csv" else as_c(self, path.stem)
        write_bytes(name, text.encode(), path)


def speed_table(
    motor: Motor,
    drive: Drive | None = None,
    *,
    slowest: float | str,
    fastest: float | str,
    direction: str = "both",
    points: int = 31,
    error: float = 0.01,
    bounds: Mapping[str, Bound] | None = None,
    constraints: Sequence[str] = (),
    contact: Contact = "winkler",
    resonance: Resonance = "quartic",
    foundation: Foundation = "harmonic",
    amplitude: Amplitude = "measured",
    progress: bool = False,
) -> SpeedTable:
    """Operating points along a range of mean speeds, continuous along the way where the motor allows.

    On a map of the box every speed's level line is known; a path over those lines is chosen that stays near the least
    fluctuation and jumps only where it must (dynamic programming).  Newton then takes every point onto its speed, and
    points are added until halfway between any two the motor does what interpolation says.  Where that cannot be had,
    or a speed does not exist in the box, the table has a gap with its reason.

    Parameters
    ----------
    motor, drive, bounds, constraints, contact, resonance, foundation, amplitude
        As for :func:`trum_sym.optimize`; pulse counts have one value each.
    slowest, fastest : float or str, rad/s
        Magnitudes of the speeds; text may carry a unit.
    direction : {"both", "positive", "negative"}
        Both are one table, through standstill where the path allows.
    points : int
        Speeds asked for in each direction, in equal ratios; more are added as needed.
    error : float
        Allowed difference between a speed and what the motor does at the interpolated drive, over the speed.
    progress : bool
        Whether to report on the standard error.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without CasADi.
    """
    low, high = (float(number(name, one_number(name, value, "rad/s"), Domain(low=0.0), "rad/s"))
                 for name, value in (("slowest", slowest), ("fastest", fastest)))  # fmt: skip
    if low >= high:
        raise ParameterError("slowest", f"{low:g} rad/s", f"less than fastest, {high:g} rad/s")
    count = int(number("points", points, _COUNT, "1"))
    error = float(number("error", error, Domain(low=1e-6, low_open=False, high=0.5, high_open=False), "1"))
    if direction not in _DIRECTIONS:
        raise ParameterError("direction", direction, f"one of {', '.join(_DIRECTIONS)}")
    levels = Levels(contact, resonance, foundation, amplitude)
    problem = posed(motor, drive, levels, "speed_deviation", None, bounds, constraints)
    sizes = np.geomspace(low, high, count)
    speeds = {"both": np.concatenate([-sizes[::-1], sizes]), "positive": sizes, "negative": -sizes[::-1]}[direction]
    model = problem.model()
    say = _say if progress else lambda _: None
    say("map of the box")
    known = chart(model, _DIVISIONS[len(problem.box.names)])
    found = known.figures["mean_speed"]
    if not np.isfinite(found).any():
        raise ParameterError(
            "load_torque", float(problem.drive.load_torque), "a load that friction can carry in the box"
        )
    table = Builder(model, known, problem.constraints, speeds, low, error, say)
    segments = tuple(_segment(model, entries) for entries in table.build())
    return SpeedTable(
        motor=motor.name, drive=problem.drive, variables=problem.box.names, segments=segments,
        gaps=tuple(Gap(*gap) for gap in table.gaps), error=error,
        largest_error=table.largest_error, floor=low, evaluations=model.evaluations,
        reachable=(float(np.nanmin(found)), float(np.nanmax(found))),
    )  # fmt: skip


def _segment(model: Model, entries: list[Entry]) -> Segment:
    points = model.box.at(np.array([entry.share for entry in entries]))
    return Segment(
        speed=np.array([entry.speed for entry in entries]),
        deviation=np.array([entry.deviation for entry in entries]),
        drive_frequency=np.array([entry.drive_frequency for entry in entries]),
        drive={name: points[:, k] for k, name in enumerate(model.box.names)},
    )


def _say(what: str) -> None:
    import click

    click.echo(f"speed-table: {what}", err=True)
    sys.stderr.flush()
