"""Speed tables: the drive for every mean speed of a range, so that a controller may interpolate between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.choices import choice
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.points import one_number
from trum_sym.inputs.spreads import Spread
from trum_sym.model.holding import WITHIN
from trum_sym.model.inputs import Inputs
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import evaluate
from trum_sym.optimiser.chart import chart
from trum_sym.optimiser.limits import Holds
from trum_sym.optimiser.model import Model
from trum_sym.optimiser.solve import Problem
from trum_sym.output.progress import said
from trum_sym.studies.posed import Bound, Held, posed
from trum_sym.studies.speed_table_result import Gap, Segment, SpeedTable
from trum_sym.studies.table_builder import TOLERANCE, Builder, TableEntry

__all__ = ["speed_table"]

_DIVISIONS = {1: 513, 2: 33, 3: 11}
_DIRECTIONS = ("both", "positive", "negative")
_COUNT = Domain(low=2, low_open=False, high=1000, high_open=False, integer=True)


def speed_table(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    slowest: float | str,
    fastest: float | str,
    direction: str = "both",
    points: int = 31,
    error: float = 0.01,
    bounds: Mapping[str, Bound] | None = None,
    constraints: Sequence[str] = (),
    holds: Holds | None = None,
    starts: float | str | None = None,
    within: float | str = WITHIN,
    spreads: Mapping[str, Spread] | None = None,
    sampling_period: float | str | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> SpeedTable:
    """Operating points along a range of mean speeds, continuous along the way where the motor allows.

    On a map of the box every speed's level line is known; a path over those lines is chosen that stays near the least
    fluctuation and jumps only where it must (dynamic programming).  Newton then takes every point onto its speed, and
    points are added until halfway between any two the motor does what interpolation says.  Where that cannot be had,
    or a speed does not exist in the box, the table has a gap with its reason.

    Parameters
    ----------
    motor, drive, bounds, constraints, holds, starts, within, spreads, sampling_period
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
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; ``tangential`` has to be ``"rigid"``.

    Returns
    -------
    trum_sym.studies.speed_table_result.SpeedTable
        Segments and gaps; ``save`` writes CSV or C, ``at`` interpolates.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without CasADi.

    Notes
    -----
    The mean speed is eq. 39; tables of the paper's motor: docs/studies.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> table = ts.speed_table(
    ...     drive=ts.Drive(load_torque=0.1),
    ...     slowest="50000 arcsec/s",
    ...     fastest="100000 arcsec/s",
    ...     direction="positive",
    ...     points=2,
    ...     bounds={"prepressure": 180.0, "frequency_difference": (2800, 3300)},
    ... )
    >>> len(table), f"{table.at('70000 arcsec/s')['frequency_difference']:.0f} Hz"
    (2, '2956 Hz')
    """
    if isinstance(slowest, str) and isinstance(fastest, str):
        said_slowest, said_fastest = slowest, fastest
    else:
        said_slowest, said_fastest = f"{slowest} rad/s", f"{fastest} rad/s"
    low, high = (
        one_number(name, value, "rad/s", Domain(low=0.0))
        for name, value in (("slowest", slowest), ("fastest", fastest))
    )
    if low >= high:
        raise ParameterError("slowest", said_slowest, f"less than fastest, {said_fastest}")
    count = int(one_number("points", points, "1", _COUNT))
    error = one_number("error", error, "1", Domain(low=1e-6, low_open=False, high=0.5, high_open=False))
    choice("direction", direction, _DIRECTIONS)
    terms = Held(holds, starts, within, spreads, sampling_period)
    problem = posed(motor, drive, Levels(**levels), "speed_deviation", None, bounds, constraints, terms)
    sizes = np.geomspace(low, high, count)
    speeds = {"both": np.concatenate([-sizes[::-1], sizes]), "positive": sizes, "negative": -sizes[::-1]}[direction]
    model = problem.model()
    say = said("speed-table" if progress else None)
    say("map of the box")
    known = chart(model, _DIVISIONS[len(problem.box.names)])
    found = known.figures["mean_speed"]
    if not np.isfinite(found).any():
        raise ParameterError(
            "load_torque", float(problem.drive.load_torque), "a load that friction can carry in the box"
        )
    table = Builder(model, known, problem.constraints, speeds, low, error, say)
    segments = tuple(_segment(problem, model, entries) for entries in table.build())
    return SpeedTable(
        motor=problem.motor.name,
        drive=problem.drive,
        variables=problem.box.names,
        segments=segments,
        gaps=tuple(Gap(*gap) for gap in table.gaps),
        error=error,
        largest_error=table.largest_error,
        floor=low,
        evaluations=model.evaluations,
        inputs=Inputs(problem.motor, problem.drive, problem.levels, None, TOLERANCE),
        reachable=(float(np.nanmin(found)), float(np.nanmax(found))),
        terms=problem.asked,
    )


def _segment(problem: Problem, model: Model, entries: list[TableEntry]) -> Segment:
    points = model.box.at(np.array([entry.share for entry in entries]))
    speed = np.array([entry.speed for entry in entries])
    found = evaluate(*model.at(points), tolerance=TOLERANCE, **asdict(problem.levels))
    return Segment(
        speed=speed,
        speed_error=np.abs(found.mean_speed - speed) + found.mean_speed_error,
        deviation=np.array([entry.deviation for entry in entries]),
        drive_frequency=np.array([entry.drive_frequency for entry in entries]),
        drive={name: points[:, k] for k, name in enumerate(model.box.names)},
    )
