"""The drive: what the electronics and the assembly set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Literal, get_args

from trum_sym.errors import ParameterError
from trum_sym.inputs.choices import choice
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.shown import full
from trum_sym.values import Value

if TYPE_CHECKING:
    from trum_sym.inputs.checks import ArrayLike

__all__ = ["BOX_NAMES", "DRIVE_DOMAINS", "LEAD", "LOADS", "SPREADING", "STARTS", "Drive", "Load", "Start"]

Start = Literal["periodic", "steady", "rest"]
STARTS: tuple[Start, ...] = get_args(Start)
Load = Literal["torque", "weight"]
LOADS: tuple[Load, ...] = get_args(Load)

BOX_NAMES = ("prepressure", "frequency_difference")
"""What searches vary unless they are told otherwise; the motor file states the ranges."""

SPREADING = (
    "prepressure",
    "frequency_difference",
    "load_torque",
    "load_inertia",
    "friction_coefficient",
    "amplitude",
    "resonance_frequency",
)
"""What drifts while a motor works, of drive, load and motor: the motor file may state how far in ``[spreads]``."""

_PULSES = Domain(low=1, low_open=False, high=1_000_000, high_open=False, integer=True)
LEAD = Domain(low=-1, low_open=False, high=1, high_open=False)
"""Of the phase lead, which is 1 or -1."""


def _quantity(default: float, unit: str, domain: Domain, text: str, metavar: str) -> Any:  # noqa: ANN401
    """A number of the drive; the console makes its option of what is said here."""
    about = {"unit": unit, "domain": domain, "text": text, "metavar": metavar}
    return field(default=default, metadata=about)


@dataclass(frozen=True, eq=False, kw_only=True)
class Drive(Value):
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
    load_inertia : float or array, kg m^2
        Moment of inertia of what turns with the rotor beside it: a torque plate, a coupling.
    load : {"torque", "weight"}
        What makes the load's torque: nothing that moves, or a weight on a string, which adds its own inertia
        ``abs(load_torque) load_radius / g`` and can only pull.
    load_radius : float or array, m
        Radius at which the weight's string runs; for a weight only, and needed there.
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
        For a value outside its domain, shapes that do not broadcast, a weight without a radius or a radius without a
        weight.

    Examples
    --------
    >>> import trum_sym as ts
    >>> drive = ts.Drive(prepressure=["170 N", "180 N"], frequency_difference="3 kHz", load_torque=0.1)
    >>> drive.prepressure
    array([170., 180.])

    ``dataclasses.replace(drive, periods=21)`` makes another one; a drive itself does not change.
    """

    prepressure: ArrayLike = _quantity(180.0, "N", Domain(low=0.0, high=1e6), "Prepressure F_c.", "N")
    frequency_difference: ArrayLike = _quantity(
        3000.0, "Hz", Domain(low=-1e9, high=1e9), "Drive frequency less resonance.", "HZ"
    )
    periods: ArrayLike = _quantity(20, "1", _PULSES, "Drive pulses per cycle, m.", "M")
    on_periods: ArrayLike = _quantity(14, "1", _PULSES, "Pulses per cycle on each phase, n.", "N")
    load_torque: ArrayLike = _quantity(0.3, "N*m", Domain(low=-1e9, high=1e9), "Load torque.", "NM")
    load_inertia: ArrayLike = _quantity(
        0.0, "kg*m^2", Domain(low=0.0, low_open=False, high=1e6), "Inertia that turns with the rotor.", "KGM2"
    )
    load_radius: ArrayLike = _quantity(
        0.0, "m", Domain(low=0.0, low_open=False, high=10.0), "Radius of the weight's string, with --load weight.", "M"
    )
    load: Load = field(default=LOADS[0], metadata={"words": LOADS, "text": "What makes the load's torque."})
    start: Start = field(default=STARTS[0], metadata={"words": STARTS, "text": "State in which every cycle begins."})
    switching_phase: ArrayLike = _quantity(
        0.0, "rad", Domain(low=-1e6, high=1e6), "Drive phase of A at the switching.", "RAD"
    )
    phase_lead: ArrayLike = field(
        default=1, metadata={"words": ("1", "-1"), "text": "Quarter periods by which B leads A."}
    )

    def __post_init__(self) -> None:
        """Checks and stores every number as float64."""
        import numpy as np

        from trum_sym.inputs.checks import broadcast_shape, number

        for name, (domain, unit) in DRIVE_DOMAINS.items():
            object.__setattr__(self, name, number(name, getattr(self, name), domain, unit))
        lead = number("phase_lead", self.phase_lead, Domain(), "1")
        if np.any(np.abs(lead) != 1):
            raise ParameterError("phase_lead", np.asarray(lead)[np.abs(lead) != 1].flat[0].item(), "1 or -1")
        object.__setattr__(self, "phase_lead", lead)
        choice("start", self.start, STARTS)
        choice("load", self.load, LOADS)
        radius = np.ravel(self.load_radius)
        if self.load == "weight" and not np.all(radius > 0):
            raise ParameterError("load_radius", 0.0, "more than 0 m with load = weight: where the string runs")
        if self.load == "torque" and np.any(radius > 0):
            wrong_radius = float(radius[radius > 0][0])
            raise ParameterError("load_radius", wrong_radius, "0 m with load = torque: a string bears a weight")
        broadcast_shape(self.numbers())
        periods, on_periods = np.broadcast_arrays(self.periods, self.on_periods)
        wrong = (2 * on_periods < periods) | (on_periods > periods)
        if wrong.any():
            m, n = int(periods[wrong].flat[0]), int(on_periods[wrong].flat[0])
            raise ParameterError("on_periods", n, f"an integer from periods/2 to periods, with periods = {m}")

    def _table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        units = {name: unit for name, (_, unit) in DRIVE_DOMAINS.items() if unit != "1"}
        rows: list[tuple[str, ...]] = [
            (f.name, f"{getattr(self, f.name)}", units.get(f.name, "")) for f in fields(self)
        ]
        return ("drive", "value", "unit"), rows

    def numbers(self) -> dict[str, ArrayLike]:
        """The numeric fields by name."""
        return {field.name: getattr(self, field.name) for field in fields(self) if field.name not in _WORDS}

    def words(self) -> dict[str, str]:
        """The fields that are one of some words, by name."""
        return {name: getattr(self, name) for name in _WORDS}

    def load_text(self) -> str:
        """The load in words, of single numbers: ``load 0.3 N m``, with what it adds to the rotor's inertia."""
        text = f"load {full(self.load_torque)} N m"
        if self.load == "weight":
            text += f" by a weight on a string at {full(1e3 * float(self.load_radius))} mm"
        return f"{text} with {full(self.load_inertia)} kg m^2" if float(self.load_inertia) else text

    def symbols(self) -> dict[str, ArrayLike]:
        """Prepressure and load by the symbols of the equations, as the kernels name their arguments."""
        return {
            "F_c": self.prepressure,
            "T_load": self.load_torque,
            "J_load": self.load_inertia,
            "r_s": self.load_radius,
        }


_WORDS = ("start", "load")
DRIVE_DOMAINS: Mapping[str, tuple[Domain, str]] = {
    quantity.name: (quantity.metadata["domain"], quantity.metadata["unit"])
    for quantity in fields(Drive)
    if "domain" in quantity.metadata
}
"""Domain and unit of every number of the drive but the phase lead, which is 1 or -1."""
