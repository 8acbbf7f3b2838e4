"""What the studies share: input as ``ts.optimize`` reads it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.model.levels import Levels
from trum_sym.optimiser.search import Bound, aim_of, box_of, check_scalars, warn_outside_fit
from trum_sym.optimiser.solve import Problem

__all__ = ["Bound", "posed"]


def posed(
    motor: Motor | None,
    drive: Drive | None,
    levels: Levels,
    objective: str,
    target: float | None,
    bounds: Mapping[str, Bound] | None,
    constraints: Sequence[str],
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
    box, pulses, drive = box_of(motor, drive, bounds)
    if len(pulses) != 1:
        raise ParameterError(
            "periods", f"{len(pulses)} pairs of periods and on_periods", "one value of each in a study"
        )
    drive = Drive(**{**drive.numbers(), **drive.words(), "periods": pulses[0][0], "on_periods": pulses[0][1]})  # type: ignore[arg-type]
    aim, limits = aim_of(objective, target, constraints)
    problem = Problem(motor, drive, levels, box, aim, limits)
    warn_outside_fit(problem)
    return problem
