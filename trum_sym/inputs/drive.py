"""The drive: what the electronics and the assembly set."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike, Domain, broadcast_shape, number

__all__ = ["DRIVE_DOMAINS", "STARTS", "Drive", "Start", "choice"]

Start = Literal["periodic", "steady", "rest"]
STARTS: tuple[Start, ...] = ("periodic", "steady", "rest")

_PULSES = Domain(low=1, low_open=False, high=10_000, high_open=False, integer=True)
DRIVE_DOMAINS = {
    "prepressure": (Domain(low=0.0, high=1e6), "N"),
    "frequency_difference": (Domain(low=-1e9, high=1e9), "Hz"),
    "periods": (_PULSES, "1"),
    "on_periods": (_PULSES, "1"),
    "load_torque": (Domain(low=-1e9, high=1e9), "N*m"),
    "switching_phase": (Domain(low=-1e6, high=1e6), "rad"),
}


def choice(name: str, value: object, allowed: tuple[str, ...]) -> None:
    """Check a word against the words that are allowed.

    Raises
    ------
    ParameterError
        If it is none of them.
    """
    if not isinstance(value, str) or value not in allowed:
        raise ParameterError(name, value, f"one of {', '.join(allowed)}")


@dataclass(frozen=True, kw_only=True)
class Drive:
    """One drive of the superimposed pulse method; numbers broadcast against each other.

    The defaults are the paper's Table 3.

    Parameters
    ----------
    prepressure : float or array, N
        Force F_c between rotor and stator.
    frequency_difference : float or array, Hz
        Drive frequency less resonance, of either sign.
    periods, on_periods : int or array
        m drive pulses per cycle, n of them on each phase; m/2 <= n <= m.
    load_torque : float or array, N m
        Torque against positive rotation.
    start : {"periodic", "steady", "rest"}
        State in which every cycle begins: the repeated cycle's own, both phases at full steady
        amplitude, or both at rest.
    switching_phase : float or array, rad
        Drive phase of A at which phases are switched.
    phase_lead : {1, -1} or array
        Quarter periods by which B leads A; +1 turns the rotor clockwise, the positive direction.

    Raises
    ------
    ParameterError
        For a value outside its domain, or shapes that do not broadcast.
    """

    prepressure: ArrayLike = 180.0
    frequency_difference: ArrayLike = 3000.0
    periods: ArrayLike = 20
    on_periods: ArrayLike = 14
    load_torque: ArrayLike = 0.3
    start: Start = "periodic"
    switching_phase: ArrayLike = 0.0
    phase_lead: ArrayLike = 1

    def __post_init__(self) -> None:
        """Checks and stores every number as float64."""
        for name, (domain, unit) in DRIVE_DOMAINS.items():
            object.__setattr__(self, name, number(name, getattr(self, name), domain, unit))
        lead = number("phase_lead", self.phase_lead, Domain(), "1")
        if np.any(np.abs(lead) != 1):
            raise ParameterError("phase_lead", np.asarray(lead)[np.abs(lead) != 1].flat[0].item(), "1 or -1")
        object.__setattr__(self, "phase_lead", lead)
        choice("start", self.start, STARTS)
        broadcast_shape(self.numbers())
        periods, on_periods = np.broadcast_arrays(self.periods, self.on_periods)
        wrong = (2 * on_periods < periods) | (on_periods > periods)
        if wrong.any():
            m, n = int(periods[wrong].flat[0]), int(on_periods[wrong].flat[0])
            raise ParameterError("on_periods", n, f"an integer from periods/2 to periods, with periods = {m}")

    def numbers(self) -> dict[str, ArrayLike]:
        """The numeric fields by name."""
        return {field.name: getattr(self, field.name) for field in fields(self) if field.name != "start"}
