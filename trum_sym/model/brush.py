"""A plain wave whose layer gives way along the circumference, as a brush: the steady speed of the rotor over it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.model.kernels import call

__all__ = ["brush_values", "check_drive", "solve_brush"]


def check_drive(drive: Drive) -> None:
    """Raise a ParameterError unless both phases are always on and have long been: bristles are known then alone."""
    if np.any(np.asarray(drive.on_periods) != drive.periods):
        raise ParameterError("tangential", "brush", "rigid in pulse drive, or on_periods = periods, the plain wave")
    if drive.start == "rest":
        raise ParameterError("tangential", "brush", "rigid where start is rest: a wave that grows is no plain one")


def brush_values(symbols: Mapping[str, ArrayLike]) -> dict[str, ArrayLike]:
    """What the rotor's speed over a brush depends on.

    Parameters
    ----------
    symbols : mapping
        Of motor, stator and drive, in SI.

    Returns
    -------
    dict
        ``theta`` (rad), ``grip`` (1), ``R_v`` (m/s) and the friction fraction ``f`` that balances the load.

    Raises
    ------
    ParameterError
        Without friction.
    """
    if np.any(np.asarray(symbols["mu"]) == 0):
        raise ParameterError("friction_coefficient", 0, "a number > 0 where tangential is brush")
    with_layer = {**call("trum_tangential_stiffness", symbols), **symbols}
    theta = call("contact_half_angle", symbols)["theta"]
    most = call("trum_stall_torque", {**symbols, "f": 1.0})["torque"]
    with np.errstate(all="ignore"):
        fraction = np.asarray(symbols["T_load"]) / np.asarray(most)
    return {"theta": theta, "f": fraction, **call("trum_brush_coefficient", with_layer)}


def solve_brush(values: Mapping[str, ArrayLike]) -> dict[str, Array]:
    """The figures of the orbit's driver for the steady speed over a brush.

    Where the whole wave touches, no bristle leaves the contact, and they are NaN.

    Parameters
    ----------
    values : mapping
        The orbit's arguments, with those of :func:`brush_values`.
    """
    side = np.asarray(values["s"])  # with it the wave, its friction and its speed turn round
    wanted = side * np.asarray(values["f"])
    found = call("brush_speed", {**values, "f": wanted})
    runaway = (np.abs(wanted) >= 1) & (np.asarray(values["theta"]) < np.pi)
    at_rest = call("brush_friction", {**values, "ratio": 0.0})
    held = side * np.asarray(at_rest["f"])
    mean, error = (np.asarray(found[name]) * np.asarray(values["R_v"]) for name in ("ratio", "ratio_error"))
    mean = side * mean
    shape = np.broadcast_shapes(*(np.shape(value) for value in (mean, held, *values.values())))
    raw: dict[str, ArrayLike] = {
        **dict.fromkeys(("mean", "low", "high", "start"), mean),
        **dict.fromkeys(("mean_error", "low_error", "high_error"), error),
        **dict.fromkeys(("variance", "deviation_error"), np.where(np.isnan(mean), np.nan, 0.0)),
        "contact": np.asarray(values["theta"]) / np.pi,
        "held": held,
        **dict.fromkeys(("contact_error", "held_error"), at_rest["f_error"]),
        "level": np.nan,
        "error": np.asarray(found["ratio_error"]),
        "runaway": runaway.astype(float),
        "whole": (np.asarray(values["theta"]) >= np.pi).astype(float),
    }
    return {name: np.array(np.broadcast_to(value, shape), np.float64) for name, value in raw.items()}
