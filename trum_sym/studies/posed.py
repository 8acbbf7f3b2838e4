"""What the studies share: input as ``ts.optimize`` reads it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.spreads import Spread
from trum_sym.model.holding import WITHIN
from trum_sym.model.levels import Levels
from trum_sym.optimiser.held import check_asked
from trum_sym.optimiser.limits import Holds, limits_of
from trum_sym.optimiser.search import Bound, aim_of, asked_to, box_of, check_scalars, warn_of_box
from trum_sym.optimiser.solve import Problem

__all__ = ["Bound", "Held", "posed"]


def posed(
    motor: Motor | None,
    drive: Drive | None,
    levels: Levels,
    objective: str,
    target: float | None,
    bounds: Mapping[str, Bound] | None,
    constraints: Sequence[str],
    held: Held | None = None,
) -> Problem:
    """The problem that :func:`trum_sym.optimize` would solve, for one pair of pulse counts.

    Raises
    ------
    ParameterError
        For bad input, and for a range of pulse counts.
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_scalars(motor, drive)
    held = Held() if held is None else held
    box, pulses, drive = box_of(motor, drive, bounds)
    if len(pulses) != 1:
        counted = f"{len(pulses)} combinations of periods, on_periods and phase_lead"
        raise ParameterError("periods", counted, "one value of each in a study")
    if "load_torque" in box.names:
        raise ParameterError("bounds of load_torque", "a range", "one value in a study")
    m, n, lead = pulses[0]
    drive = replace(drive, periods=m, on_periods=n, phase_lead=lead)
    asked = asked_to(motor, held.within, held.spreads, held.sampling_period, held.starts)
    aim, limits = aim_of(objective, target, constraints)
    limits = (*limits, *limits_of(asked, target if held.target is None else held.target, held.holds, held.starts))
    problem = Problem(motor, drive, levels, box, aim, limits, asked, target if held.target is None else held.target)
    check_asked(problem.names, asked, problem.target, motor)
    warn_of_box(problem)
    return problem


@dataclass(frozen=True)
class Held:
    """What a study was told of points that are to be held, as :func:`trum_sym.optimize` takes it.

    ``target`` is the speed that shares are of where no constraint holds it.
    """

    holds: Holds | None = None
    starts: float | str | None = None
    within: float | str = WITHIN
    spreads: Mapping[str, Spread] | None = None
    sampling_period: float | str | None = None
    target: float | None = None
