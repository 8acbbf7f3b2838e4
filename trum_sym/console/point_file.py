"""``--point``: an operating point that a command wrote with ``--json``, as the options of another."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trum_sym.errors import ParameterError

if TYPE_CHECKING:
    from trum_sym.inputs.motor import Motor

__all__ = ["PointFile", "read_point"]

_MAX_BYTES = 10_000_000
_ENDS = ".json files that trum-sym wrote with --json"


@dataclass(frozen=True)
class PointFile:
    """What a file says: values of options by their name, and the motor."""

    options: Mapping[str, Any]
    record: Mapping[str, Any]

    def motor(self) -> Motor:
        """The motor of the point: the shipped one where it is that, with the values of the file.

        Raises
        ------
        ParameterError
            For names or values that no motor has.
        """
        from trum_sym.inputs.motor import SPECS, Allowed, Amount, Motor, Parameter
        from trum_sym.inputs.motor_file import load_motor
        from trum_sym.inputs.plausible import unquestioned

        values, assumed, box = (_table(self.record, name) for name in ("motor_values", "assumed", "box"))
        for name in values:
            if name not in SPECS:
                raise ParameterError("--point, motor_values", name, "names of the motor file")
        shipped = load_motor()
        changed: dict[str, Any] = {}
        for name, value in values.items():
            _number(name, value)
            here = getattr(shipped, name)
            if self.record.get("motor") == shipped.name and here is not None and here.value == value:
                continue
            span = assumed.get(name)
            source = "assumed" if name in assumed else "the point's file"
            spec = SPECS[name]
            changed[name] = Parameter(value, spec.unit, spec.symbol, source, tuple(span) if span else None)
        with unquestioned():  # whoever wrote the file was warned
            if self.record.get("motor") == shipped.name:
                return replace(shipped, **changed)
            missing = [name for name, spec in SPECS.items() if spec.required and name not in changed]
            if missing:
                raise ParameterError("--point, motor_values", f"no {missing[0]}", "every required value of a motor")
            source = "the point's file"
            ranges = {name: Allowed(float(low), float(high), source) for name, (low, high) in box.items()}
            allowed, spreads = (self.record.get(name) or {} for name in ("allowed", "spreads"))
            changed["allowed"] = {
                name: Allowed(float(low), float(high), source) for name, (low, high) in allowed.items()
            }
            changed["spreads"] = {
                name: Amount(float(off), bool(share), source) for name, (off, share) in spreads.items()
            }
            return Motor(name=str(self.record["motor"]), box=ranges, **changed)


def _table(record: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    found = record.get(name)
    if not isinstance(found, Mapping):
        raise ParameterError(f"--point, {name}", found, f"an object, as in {_ENDS}")
    return found


def _number(name: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ParameterError(f"--point, {name}", value, "a number")


def read_point(path: Path) -> PointFile:
    """Read a file, or the K-th point of one with several, ``FILE#K``.

    Raises
    ------
    ParameterError
        For what is no such file, or has no such point.
    """
    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.reading import read_text
    from trum_sym.model.inputs import SCHEMA

    name, mark, number = str(path).rpartition("#")
    place, wanted = (name, number) if mark and number.isdigit() else (str(path), None)
    try:
        record = json.loads(read_text(Path(place), _MAX_BYTES))
    except (OSError, ValueError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not JSON"
        raise ParameterError("--point", place, f"one of the {_ENDS} ({reason})") from None
    if not isinstance(record, dict):
        raise ParameterError("--point", place, f"one JSON object, as in {_ENDS}")
    if record.get("schema") != SCHEMA:
        raise ParameterError("--point, schema", record.get("schema"), f"{SCHEMA}, as in {_ENDS} of this version")
    drive = dict(_chosen(record, wanted))
    known = Drive.__dataclass_fields__
    for key, value in drive.items():
        if key not in known:
            raise ParameterError("--point, drive", key, f"one of {', '.join(known)}")
        if isinstance(value, str):
            continue
        if isinstance(value, bool) or not isinstance(value, int | float):
            status = f" (its status is {record['status']})" if record.get("status", "solved") != "solved" else ""
            raise ParameterError(f"--point, {key}", value, f"a number{status}")
        if key == "phase_lead":
            drive[key] = f"{value:g}"
    options = {**drive, **_table(record, "levels")}
    for key in ("sampling_period", "tolerance"):
        if record.get(key) is not None:
            _number(key, record[key])
            options[key] = record[key]
    return PointFile(options, record)


def _chosen(record: Mapping[str, Any], wanted: str | None) -> Mapping[str, Any]:
    """The drive of the only point, or of the K-th."""
    points = record.get("points")
    if not isinstance(points, list):
        if wanted is not None:
            raise ParameterError("--point", f"#{wanted}", "no number: the file has one point")
        return _table(record, "drive")
    if wanted is None and len(points) > 1:
        raise ParameterError("--point", "no number", f"FILE#K, the K-th of the file's {len(points)} points")
    place = int(wanted or 1) - 1
    if not 0 <= place < len(points) or not isinstance(points[place], Mapping):
        raise ParameterError("--point", f"#{place + 1}", f"a number from 1 to {len(points)}")
    return {**_table(record, "drive"), **_table(points[place], "drive")}
