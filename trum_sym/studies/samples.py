"""Samples of what is not known exactly: a CSV file, one case a row."""

from __future__ import annotations

from pathlib import Path

from trum_sym.errors import ParameterError
from trum_sym.inputs.measurements import table_of
from trum_sym.inputs.motor import spec

__all__ = ["read_samples"]


def read_samples(path: Path) -> list[dict[str, float]]:
    """Cases in SI from a CSV file with headers such as ``friction_coefficient,contact_radius [mm]``.

    Raises
    ------
    ParameterError
        If the file cannot be read, a header is no parameter of the motor, or a cell is no finite number.
    """
    columns, _, _ = table_of(path, lambda name: "N*m" if name == "load_torque" else spec(name).unit)
    rows = list(zip(*columns.values(), strict=True))
    if not rows:
        raise ParameterError("samples", path.name, "at least one row")
    return [dict(zip(columns, (float(value) for value in row), strict=True)) for row in rows]
