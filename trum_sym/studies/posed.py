"""What the studies share: input as ``ts.optimize`` reads it, and expressions over several cases at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import casadi

from trum_sym.drive import Drive
from trum_sym.errors import ParameterError
from trum_sym.motor import Motor
from trum_sym.optimiser.model import Functions
from trum_sym.optimiser.search import Bound, _aim, _box, _check_scalars, _number, _warn_outside_fit
from trum_sym.optimiser.solve import Problem
from trum_sym.stator import Levels

__all__ = ["Bound", "number_of", "posed", "rows_of"]

number_of = _number


def posed(
    motor: Motor,
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
    drive = Drive() if drive is None else drive
    _check_scalars(motor, drive)
    box, pulses, drive = _box(drive, bounds)
    if len(pulses) != 1:
        raise ParameterError("bounds", f"{len(pulses)} pairs of periods and on_periods", "one value of each in a study")
    drive = Drive(**{**drive.numbers(), "start": drive.start, "periods": pulses[0][0], "on_periods": pulses[0][1]})  # type: ignore[arg-type]
    aim, limits = _aim(objective, target, constraints)
    problem = Problem(motor, drive, levels, box, aim, limits)
    _warn_outside_fit(problem)
    return problem


def rows_of(names: Sequence[str], rows: Sequence[tuple[str, float, str | None]]) -> Functions:
    """Rows ``sign * first - second`` over figures of any names.

    Parameters
    ----------
    names : sequence of str
        The figures, in the order of the functions' columns.
    rows : sequence
        Of (first, sign, second or None).
    """
    symbols = {name: casadi.SX.sym(f"x{k}") for k, name in enumerate(names)}
    graphs = [sign * symbols[first] - (symbols[second] if second else 0) for first, sign, second in rows]
    arguments, stacked = casadi.vertcat(*symbols.values()), casadi.vertcat(*graphs)
    return Functions(
        tuple(names),
        casadi.Function("value", [arguments], [stacked]),
        casadi.Function("jacobian", [arguments], [casadi.densify(casadi.jacobian(stacked, arguments))]),
    )
