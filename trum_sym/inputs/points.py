"""Motor and drive together: every number of an operating point by name, and what commands of one point refuse."""

from __future__ import annotations

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor

__all__ = ["check_point", "check_single", "numbers_of"]


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
