"""Motor and drive together: every number of an operating point by name, and what commands of one point refuse."""

from __future__ import annotations

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike, number
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.units import parse_quantity

__all__ = ["check_point", "check_single", "numbers_of", "one_number", "period_of"]


def check_point(motor: object, drive: object) -> None:
    """Refuse what is no motor, or no drive.

    Raises
    ------
    ParameterError
        Which names the one that is not.
    """
    if not isinstance(motor, Motor):
        raise ParameterError("motor", motor, "a Motor, as load_motor returns it")
    if not isinstance(drive, Drive):
        raise ParameterError("drive", drive, "a Drive")


def one_number(name: str, value: object, unit: str, domain: Domain | None = None) -> float:
    """A number in its SI unit, from a number, a quantity, or text that may carry a unit.

    Raises
    ------
    ParameterError
        If it is none, not finite, outside its domain, or an array.
    """
    domain = Domain() if domain is None else domain
    given = parse_quantity(name, value, unit) if isinstance(value, str) else value
    checked = number(name, given, domain, unit)
    if np.ndim(checked):
        raise ParameterError(name, f"an array of shape {np.shape(checked)}", f"one number, {domain.describe(unit)}")
    return float(checked)


def period_of(value: object) -> ArrayLike | None:
    """An encoder's averaging period in s, None for the continuous speed.

    Raises
    ------
    ParameterError
        If it is neither.
    """
    return None if value is None else number("sampling_period", value, Domain(low=0.0), "s")


def numbers_of(motor: Motor, drive: Drive, sampling_period: ArrayLike | None = None) -> dict[str, ArrayLike]:
    """All numbers of an operating point by name, of the drive first, in the units of the motor file."""
    numbers = {**drive.numbers(), **{name: parameter.value for name, parameter in motor.parameters()}}
    return numbers if sampling_period is None else {**numbers, "sampling_period": sampling_period}


def check_single(numbers: dict[str, ArrayLike], allowed: str = "a single number") -> None:
    """Refuse arrays, for whatever has one answer.

    Parameters
    ----------
    numbers : mapping
        From :func:`numbers_of`.
    allowed : str
        What to say is needed instead.

    Raises
    ------
    ParameterError
        Which names the first array and its shape.
    """
    for name, value in numbers.items():
        if np.ndim(value):
            raise ParameterError(name, f"an array of shape {np.shape(value)}", allowed)
