"""Measured characteristics of a motor: points that stand beside what is computed, and that no calibration reads."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import number
from trum_sym.inputs.choices import choice, path_of
from trum_sym.inputs.csv_text import read_text
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.motor_file import SHIPPED
from trum_sym.inputs.units import unit_for
from trum_sym.values import Value

__all__ = ["CURVES", "FORMS", "MeasuredPoint", "load_measured", "measured_of"]

CURVES = MappingProxyType(
    {
        "speed_torque": ("N*m", "rad/s"),
        "speed_frequency": ("Hz", "rad/s"),
        "speed_prepressure": ("N", "rad/s"),
        "stall_prepressure": ("N", "N*m"),
    }
)
"""The curves that points may lie on, with the SI units of abscissa and ordinate."""
FORMS = ("plain", "pulse")
"""How the phases are driven: both always on, or the superimposed pulses."""

_MAX_BYTES = 1_000_000
_MAX_POINTS = 1000
_KEYS = ("curve", "drive", "x", "y", "source", "note")


@dataclass(frozen=True, eq=False)
class MeasuredPoint(Value):
    """A point of a measured curve, in SI: speeds in rad/s.

    Attributes
    ----------
    curve : str
        One of :data:`CURVES`.
    drive : {"plain", "pulse"}
    x, y : float
    source : str
        Where it is published.
    note : str
        What else is known of it, such as that a model computed it.
    """

    curve: str
    drive: str
    x: float
    y: float
    source: str
    note: str = ""


def measured_of(motor: str | PathLike[str]) -> Path | None:
    """The file of measured points that lies beside a motor's: NAME.measured.toml beside NAME.toml; None without one."""
    path = Path(__file__).parents[1] / "data" / f"{motor}.toml" if str(motor) in SHIPPED else Path(motor)
    beside = path.parent / f"{path.stem}.measured.toml"
    return beside if beside.is_file() else None


def load_measured(source: str | PathLike[str]) -> tuple[MeasuredPoint, ...]:
    """Read measured points from a TOML file of tables ``[[point]]``.

    Each has ``curve``, ``drive``, ``x`` and ``y`` as ``{ value = 54, unit = "rpm" }``, ``source`` and perhaps ``note``.

    Raises
    ------
    ParameterError
        If the file is missing, is not TOML, or an entry is unknown, incomplete or of a wrong unit.
    """
    path = path_of("measured", source, "the path of a TOML file")
    try:
        text = read_text("measured", path, "a TOML file", _MAX_BYTES)
    except FileNotFoundError:
        raise ParameterError("measured", str(source), "the path of a TOML file that exists") from None
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ParameterError("measured", str(source), f"a valid TOML file ({error})") from None
    entries = data.get("point")
    if set(data) != {"point"} or not isinstance(entries, list) or len(entries) > _MAX_POINTS:
        raise ParameterError("measured", str(source), f"up to {_MAX_POINTS} tables [[point]] and nothing else")
    return tuple(_read(entry) for entry in entries)


def _read(entry: object) -> MeasuredPoint:
    if not isinstance(entry, dict):
        raise ParameterError("point", entry, "a table [[point]]")
    unknown = sorted(set(entry) - set(_KEYS))
    if unknown:
        raise ParameterError("point", unknown[0], f"no other keys than {', '.join(_KEYS)}")
    for key in _KEYS[:-1]:
        if key not in entry:
            raise ParameterError(f"point.{key}", "nothing", f"{key} in the file of measured points")
    for key in ("source", "note"):
        if not isinstance(entry.get(key, ""), str) or (key == "source" and not entry[key].strip()):
            raise ParameterError(f"point.{key}", entry[key], "text")
    curve, drive = entry["curve"], entry["drive"]
    choice("point.curve", curve, tuple(CURVES))
    choice("point.drive", drive, FORMS)
    x, y = (_quantity(f"point.{key}", entry[key], unit) for key, unit in zip("xy", CURVES[curve], strict=True))
    return MeasuredPoint(curve, drive, x, y, entry["source"].strip(), entry.get("note", "").strip())


def _quantity(name: str, entry: Any, wanted: str) -> float:  # noqa: ANN401
    if not isinstance(entry, dict) or set(entry) != {"value", "unit"} or not isinstance(entry["unit"], str):
        raise ParameterError(name, entry, "a table of value and unit")
    value = entry["value"]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ParameterError(name, value, "a number")
    try:
        unit = unit_for(entry["unit"], wanted)
        return float(number(name, unit.to_si(float(value)), Domain(), wanted))
    except (ValueError, OverflowError) as error:
        if isinstance(error, ParameterError):
            raise
        raise ParameterError(name, entry["unit"], f"a unit that converts to {wanted}") from None
