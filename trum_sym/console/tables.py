"""An operating point for people (a table beside the published figures) and for programs (JSON)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor, Published
from trum_sym.inputs.units import parse_unit
from trum_sym.model.operating_point import OperatingPoint
from trum_sym.output.digits import with_error
from trum_sym.output.json_text import json_text
from trum_sym.quantities import QUANTITIES
from trum_sym.text import one_line

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["as_json_text", "as_table", "histories_table", "shown_with_error"]


def as_json_text(point: OperatingPoint) -> str:
    """The point as a JSON object; null where a figure has no meaning or is infinite."""
    return json_text(point.as_dict())


def histories_table(histories: xr.Dataset) -> str:
    """What the histories span: lowest, mean and highest value of each, in SI units."""
    from tabulate import tabulate

    rows = [
        (name, *(f"{float(value):.6g}" for value in (h.min(), h.mean(), h.max())), h.units, h.long_name)
        for name, h in histories.data_vars.items()
    ]
    table = tabulate(
        rows,
        headers=("", "lowest", "mean", "highest", "unit", ""),
        disable_numparse=True,
        colalign=("left", "right", "right", "right", "left", "left"),
    )
    count, known = histories.sizes["time"], histories.attrs
    title = (
        f"{known['title']}, start {known['start']}\n{known['cycles']} cycles of {1e3 * known['cycle_time']:.6g} ms, "
        f"{count} times; --out FILE.nc or FILE.csv writes them"
    )
    notes = ["", known["reason"]] if known["reason"] else []
    return "\n".join([title, "", table, *notes])


def shown_with_error(figures: Mapping[str, Any], name: str) -> tuple[str, str]:
    """A figure in its unit for people to the last digit that its error leaves, and the error; else to six digits."""
    _, unit, shown = QUANTITIES[name]
    value, error = float(figures[name]), figures.get(f"{name}_error")
    if not np.isfinite(value):
        return "-", ""
    value = _convert(value, unit, shown)
    if error is None:
        return f"{value:.6g}", ""
    return with_error(value, _convert(float(error), unit, shown))


def _published(motor: Motor, drive: Drive) -> dict[str, Published]:
    """What is published for this very drive, by figure."""
    settings = drive.numbers()
    return {
        entry.output: entry
        for entry in motor.published
        if all(bool(np.isclose(settings[name], value, rtol=1e-9)) for name, value in entry.drive.items())
    }


def _convert(value: float, unit: str, shown: str) -> float:
    return parse_unit(unit).to_si(value) / parse_unit(shown).to_si(1.0)


def as_table(motor: Motor, drive: Drive, point: OperatingPoint, levels: Mapping[str, object]) -> str:
    """The point as a table: our value, the published one where there is one, the difference, the unit."""
    from tabulate import tabulate

    published = _published(motor, drive)
    rows = []
    for name, (label, unit, shown) in QUANTITIES.items():
        value, entry = getattr(point, name), published.get(name)
        ours, error = shown_with_error(point.as_dict(), name)
        paper = difference = source = ""
        if entry is not None:
            theirs = _convert(entry.value, entry.unit, shown)
            paper, source = f"{theirs:.6g}", one_line(entry.source)
            if np.isfinite(value) and theirs:
                difference = f"{100 * (_convert(value, unit, shown) / theirs - 1):+.2f} %"
        rows.append((label, ours, error, "" if shown == "1" else shown, paper, difference, source))
    table = tabulate(
        rows,
        headers=("", "ours", "+-", "unit", "paper", "difference", "printed in"),
        disable_numparse=True,
        colalign=("left", "right", "left", "left", "right", "right", "left"),
    )
    title = (
        f"{one_line(motor.name)} at "
        f"{drive.prepressure:g} N, {drive.frequency_difference:+g} Hz, {drive.on_periods:g} of "
        f"{drive.periods:g} periods on, {drive.load_text()}\n"
        f"start {point.start}, phase lead {drive.phase_lead:+g}, switching phase {drive.switching_phase:g} rad\n"
        + ", ".join(f"{name} {level}" for name, level in levels.items() if level is not None)
    )
    return "\n".join([title, "", table, *_notes(drive, point)])


def _notes(drive: Drive, point: OperatingPoint) -> list[str]:
    """What the figures alone do not say about the rotor."""
    notes = ["", str(point.reason)] if point.reason else []
    load, speed, stall = (float(x) for x in (drive.load_torque, point.mean_speed, point.stall_torque))
    if speed * load < 0 and abs(load) > abs(stall):
        notes += ["", "the load exceeds the stall torque and drives the rotor back"]
    return notes
