"""What an answer was asked for: motor, drive, levels, encoder, tolerance; and the same as a record for programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from trum_sym.inputs.checks import ArrayLike
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.model.levels import Levels
from trum_sym.quantities import unit_of_figure
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["SCHEMA", "Inputs", "remarks_of", "units_of"]

SCHEMA = 1
"""Version of the records; it rises when a name changes its meaning or goes."""


_SWINGS = 100.0  # times the mean: beyond, it is said


@dataclass(frozen=True, eq=False)
class Inputs(Value):
    """Everything that decides about an operating point.

    Attributes
    ----------
    motor : Motor
    drive : Drive
    levels : Levels
    sampling_period : float or array, s, or None
        The encoder's; None for the continuous speed.
    tolerance : float
        Of the rotor's speeds, relative to the largest: what was asked for, or what it came to where nothing was.
    """

    motor: Motor
    drive: Drive
    levels: Levels
    sampling_period: ArrayLike | None = None
    tolerance: float | None = None

    def __repr__(self) -> str:
        return f"<Inputs {one_line(self.motor.name)}, {self.drive!r}>"

    def record(self) -> dict[str, Any]:
        """All of it by name, in SI units: what ``--point`` reads."""
        from importlib.metadata import version

        return {
            "schema": SCHEMA,
            "trum_sym": version("trum-sym"),
            "motor": self.motor.name,
            "motor_values": {name: _plain(p.value) for name, p in self.motor.parameters()},
            "assumed": {name: p.range for name, p in self.motor.assumed().items()},
            "box": {name: [allowed.low, allowed.high] for name, allowed in self.motor.box.items()},
            "allowed": {name: [allowed.low, allowed.high] for name, allowed in self.motor.allowed.items()},
            "spreads": {name: [off.value, off.share] for name, off in self.motor.spreads.items()},
            "drive": {f.name: _plain(getattr(self.drive, f.name)) for f in fields(Drive)},
            "levels": asdict(self.levels),
            "sampling_period": None if self.sampling_period is None else _plain(self.sampling_period),
            "tolerance": self.tolerance,
        }


def _plain(value: Any) -> Any:  # noqa: ANN401
    return value.tolist() if isinstance(value, np.ndarray) else value


def units_of(record: Mapping[str, Any]) -> dict[str, str]:
    """The SI unit of every number of a record that has one, by name, at any depth."""
    found: dict[str, str] = {}

    def look(entry: object) -> None:
        if isinstance(entry, Mapping):
            for name, value in entry.items():
                unit = _unit(name)
                if unit is not None and not isinstance(value, str | Mapping):
                    found[name] = unit
                look(value)
        elif isinstance(entry, list | tuple):
            for value in entry:
                look(value)

    look(record)
    return found


def _unit(name: str) -> str | None:
    if name in DRIVE_DOMAINS:
        return DRIVE_DOMAINS[name][1]
    return SPECS[name].unit if name in SPECS else unit_of_figure(name)


def remarks_of(figures: Mapping[str, Any], load_torque: float) -> tuple[str, ...]:
    """What the figures of one point do not say by themselves.

    Parameters
    ----------
    figures : mapping
        ``mean_speed`` and ``stall_torque``, and ``reason`` where there is one, in SI units.
    load_torque : float
        In N m.

    Returns
    -------
    tuple of str
        Why an orbit is not converged; that the rotor turns backward, or that the load is more than holds it still.
    """
    found = [str(figures["reason"])] if figures.get("reason") else []
    speed, stall, load = float(figures["mean_speed"]), float(figures["stall_torque"]), float(load_torque)
    if not np.isfinite(speed):
        return tuple(found)
    if speed * load < 0 and abs(load) > abs(stall):
        found.append("the load exceeds the stall torque and drives the rotor back")
    elif load * stall > 0 and abs(load) > abs(stall):
        found.append(
            f"the load, {load:g} N*m, exceeds the stall torque, {stall:.4g} N*m: it pulls back a rotor that is held "
            "still; one that is free follows the beats to this speed"
        )
    elif speed * stall < 0:
        found.append("the rotor turns backward, against the direction in which the stator drives it at standstill")
    swing = float(figures.get("max_speed", speed)) - float(figures.get("min_speed", speed))
    if swing > _SWINGS * abs(speed):
        times = f"{swing / abs(speed):.2g} times the mean" if speed else "about a mean of zero"
        found.append(f"the speed swings {times} within a cycle: a small drift of any input outweighs this mean")
    return tuple(found)
