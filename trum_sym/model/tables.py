"""An operating point for people, a table beside the published figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import SPECS, TO_DO, Motor, Parameter, Published
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.shown import full, quantity_of, readable
from trum_sym.inputs.units import parse_unit
from trum_sym.model.inputs import Inputs
from trum_sym.model.operating_point import OF_ORBIT, OperatingPoint, prepare, results
from trum_sym.output.digits import with_error
from trum_sym.output.text_table import text_table
from trum_sym.quantities import QUANTITIES, Quantity
from trum_sym.text import one_line

if TYPE_CHECKING:
    import xarray as xr

    from trum_sym.model.coupled_point import CoupledPoint

__all__ = ["as_table", "compared", "drive_in_words", "histories_table", "reading_in_words", "shown_with_error"]

_FAR = 10.0  # times: further apart, a difference is given in the figure's unit


def histories_table(histories: xr.Dataset) -> str:
    """What the histories span: lowest, mean and highest value of each, in SI units."""
    rows = [
        (name, *(f"{float(value):.6g}" for value in (h.min(), h.mean(), h.max())), h.units, h.long_name)
        for name, h in histories.data_vars.items()
    ]
    table = text_table(rows, ("", "lowest", "mean", "highest", "unit", ""), "lrrrll")
    count, known = histories.sizes["time"], histories.attrs
    title = (
        f"{known['title']}, start {known['start']}\n"
        f"{known['cycles']} cycle{'s' * (known['cycles'] != 1)} of {1e3 * known['cycle_time']:.6g} ms, "
        f"{count} times; --out FILE.nc or FILE.csv writes them"
    )
    period = known["sampling_period"]
    kind = "continuous" if period == "none" else f"encoder of {full(1e3 * float(period))} ms"
    value = readable("speed_volatility", float(known["speed_volatility"]))
    notes = ["", f"speed volatility sigma_s, {kind}: {value:.6g} %"] if np.isfinite(value) else []
    notes += ["", known["reason"]] if known["reason"] else []
    return "\n".join([title, "", table, *notes])


def shown_with_error(figures: Mapping[str, Any], name: str) -> tuple[str, str]:
    """A figure in its unit for people to the last digit that its error leaves, and the error; else to six digits."""
    value, error = float(figures[name]), figures.get(f"{name}_error")
    if not np.isfinite(value):
        return "-", ""
    value = readable(name, value)
    return (f"{value:.6g}", "") if error is None else with_error(value, readable(name, float(error)))


def _published(inputs: Inputs) -> dict[str, Published]:
    """What is published for this very drive, by figure: of an encoder only where ours is of the same one."""
    settings = inputs.drive.numbers()
    here: float | None = None if inputs.sampling_period is None else float(inputs.sampling_period)
    return {
        entry.output: entry
        for entry in inputs.motor.published
        if all(_alike(float(settings[name]), value) for name, value in entry.drive.items())
        and (entry.output != "speed_volatility" or _same_encoder(entry.sampling_period, here))
    }


def _same_encoder(one: float | None, other: float | None) -> bool:
    return one is other or (one is not None and other is not None and _alike(one, other))


def _alike(one: float, other: float) -> bool:
    """Equal but for rounding."""
    return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-8)


def compared(point: OperatingPoint | CoupledPoint) -> dict[str, dict[str, object]]:
    """What is published of the figures, by name, with the unit and place of print: of the same kind only."""
    return {
        name: {"value": parse_unit(entry.unit).to_si(entry.value), "source": entry.source}
        for name, entry in _published(point.inputs).items()
        if name in point.quantities
    }


def _difference(name: str, ours: float, theirs: float) -> str:
    """In percent where the two are near, else in the unit that people read."""
    if not np.isfinite(ours) or not theirs:
        return ""
    if ours * theirs > 0 and 1 / _FAR < ours / theirs < _FAR:
        return f"{100 * (ours / theirs - 1):+.2f} %"
    unit = quantity_of(name).shown
    return f"{ours - theirs:+.6g}" + ("" if unit == "1" else f" {unit}")


def drive_in_words(drive: Drive) -> str:
    """The numbers of a drive, with all of their digits."""
    return (
        f"{full(drive.prepressure)} N, {'+' * (drive.frequency_difference >= 0)}{full(drive.frequency_difference)} Hz, "
        f"{full(drive.on_periods)} of {full(drive.periods)} periods on, {drive.load_text()}"
    )


def reading_in_words(inputs: Inputs) -> list[str]:
    """The choices that a paper's text leaves open, two lines."""
    drive = inputs.drive
    return [
        f"reading: start {drive.start}, phase lead {drive.phase_lead:+g}, "
        f"switching phase {full(drive.switching_phase)} rad",
        "levels: " + ", ".join(f"{name} {level}" for name, level in asdict(inputs.levels).items()),
    ]


def _resting_on_assumed(point: OperatingPoint | CoupledPoint) -> dict[str, set[str]]:
    """The figures that change when an assumed value of the motor goes to an end of its range, by that value's name."""
    inputs = point.inputs
    assumed = inputs.motor.assumed()
    if not assumed:
        return {}
    if not isinstance(point, OperatingPoint):
        return _coupled_on_assumed(inputs, assumed, point.quantities)
    closed = [name for name in QUANTITIES if name not in OF_ORBIT]
    # as they are, then each in turn at another value: one batch
    columns = {name: np.full(len(assumed) + 1, float(parameter.value)) for name, parameter in assumed.items()}
    for place, (name, parameter) in enumerate(assumed.items(), 1):
        columns[name][place] = _another(name, parameter)
    with unquestioned():
        motor = inputs.motor.with_values(columns)
        case = prepare(motor, inputs.drive, inputs.levels, inputs.tolerance or 1e-6, warn=False)
        figures = results(case, closed)

    def moved(value: Any) -> Array:  # noqa: ANN401
        """Where another value of the n-th assumed parameter changes something, (n,)."""
        every = np.broadcast_to(value, len(assumed) + 1)
        return np.asarray(every[1:] != every[0])

    orbit = np.any([moved({**case.symbols, **case.arguments}[key]) for key in {"r_c", *case.arguments}], axis=0)
    found: dict[str, Any] = {figure: moved(figures[figure]) for figure in closed}
    found |= dict.fromkeys(OF_ORBIT & set(QUANTITIES), orbit)
    return {name: {f for f, by in found.items() if by[place]} for place, name in enumerate(assumed)}


def _coupled_on_assumed(
    inputs: Inputs, assumed: Mapping[str, Parameter], quantities: Mapping[str, Quantity]
) -> dict[str, set[str]]:
    """The same with coupling: an orbit's figures rest on all that its laps depend on."""
    from trum_sym.model.coupled_point import FREE_OF_ORBIT, coupled_results, prepare_coupled

    def at(name: str | None) -> tuple[dict[str, Any], Mapping[str, float]]:
        with unquestioned():
            changed = {} if name is None else {name: _another(name, assumed[name])}
            case = prepare_coupled(inputs.motor.with_values(changed), inputs.drive, inputs.levels, inputs.tolerance)
        return coupled_results(case, FREE_OF_ORBIT), case.points[0]

    closed, values = at(None)
    found: dict[str, set[str]] = {}
    for name in assumed:
        try:
            others, point = at(name)
        except ParameterError:  # laps know no other value: they rest on the one that they have
            found[name] = {figure for figure in quantities if figure not in closed}
            continue
        found[name] = {figure for figure in closed if others[figure] != closed[figure]}
        found[name] |= {q for q in quantities if q not in closed} if _laps_differ(values, point) else set()
    return found


def _laps_differ(one: Mapping[str, float], other: Mapping[str, float]) -> bool:
    """Whether two points' laps depend on different numbers."""
    from trum_sym.model.kernels import signature

    names = signature("coupled_lap")[0]
    return any(one[name] != other[name] for name in names if name in one)


def _another(name: str, parameter: Parameter) -> float:
    """Another value that a parameter might have: an end of its range, or where none is stated, one beside it."""
    value = float(parameter.value)
    if parameter.range is not None:
        low, high = parameter.range
        return low if low != value else high
    return value + 1 if SPECS[name].domain.integer else 0.999 * value


def as_table(point: OperatingPoint | CoupledPoint) -> str:
    """The point as a table: value, bound of its error, unit, and what is published of the same kind."""
    inputs = point.inputs
    motor, drive, published = inputs.motor, inputs.drive, _published(inputs)
    resting = _resting_on_assumed(point)
    marked = set().union(*resting.values()) if resting else set()
    period = inputs.sampling_period
    kind = "continuous" if period is None else f"encoder of {full(1e3 * float(period))} ms"
    rows: list[list[str]] = []
    figures: dict[str, Any] = point.figures
    for name, quantity in point.quantities.items():
        label = f"{quantity.label}, {kind}" if name == "speed_volatility" else quantity.label
        row = [label, *shown_with_error(figures, name), "" if quantity.shown == "1" else quantity.shown]
        row += ["*" if name in marked else ""] * bool(marked)
        if published:
            entry = published.get(name)
            theirs = 0.0 if entry is None else readable(name, parse_unit(entry.unit).to_si(entry.value))
            row += ["", "", ""] if entry is None else [
                f"{theirs:.6g}", _difference(name, readable(name, float(figures[name])), theirs), one_line(entry.source)
            ]  # fmt: skip
        rows.append(row)
    headers = ["", "value", "+-", "unit"] + [""] * bool(marked)
    align = "lrll" + "l" * bool(marked)
    if published:
        headers, align = [*headers, "published", "difference", "printed in"], align + "rrl"
    table = text_table(rows, headers, align)
    title = [f"{one_line(motor.name)} at {drive_in_words(drive)}", *reading_in_words(inputs)]
    if not isinstance(point, OperatingPoint):
        title.append(_orbit_in_words(point))
    return "\n".join([*title, "", table, *_notes(point, resting)])


def _orbit_in_words(point: CoupledPoint) -> str:
    """Which orbit a coupled point's figures are of."""
    orbit = point.orbit
    if orbit is None:
        return "orbit: none"
    mass = float(point.inputs.motor.rotor_mass.value) if point.inputs.motor.rotor_mass is not None else 0.0
    state = f"closed after {orbit.cycles} cycle{'s' * (orbit.cycles != 1)}" if orbit.closed else "no lap closes"
    sizes = np.abs(orbit.multipliers)
    return (
        f"orbit: from {point.start}, {state}, branch {point.branch}, "
        f"multipliers up to {float(sizes.max()):.3g}; rotor of {1e3 * mass:.6g} g; "
        "errors are estimates"
    )


def _notes(point: OperatingPoint | CoupledPoint, resting: Mapping[str, set[str]]) -> list[str]:
    """What the figures alone do not say."""
    notes = ["", *(f"remark: {remark}" for remark in point.remarks)] if point.remarks else []
    motor = point.inputs.motor
    names = [name for name, figures in resting.items() if figures]
    left = [name for name in names if getattr(motor, name).source.casefold().startswith(TO_DO)]
    names = [name for name in names if name not in left]
    if left:
        notes += ["", f"* rests on {len(left)} values that are still those of a template: trum-sym motor check"]
    if names:
        values = [f"{name} {_in_range(motor, name)}" for name in names]
        notes += ["", "* rests on values that are assumed, not measured: " + values[0] + ",", *_wrapped(values[1:])]
    other = [e for e in motor.published if e.output == "speed_volatility" and e.sampling_period is not None]
    shown = _published(point.inputs)
    if other and "speed_volatility" not in shown and shown:
        entry = other[0]
        period = full(1e3 * float(entry.sampling_period or 0))
        notes += ["", f"published of an encoder: sigma_s {entry.value:g} {entry.unit} ({one_line(entry.source)}); "
                  f"--sampling-period '{period} ms' compares with it"]  # fmt: skip
    return [*notes, "", "next: trum-sym motor show says where every value is from; --json > point.json keeps the point",
            "      with all inputs, and --point point.json gives it to any other command"]  # fmt: skip


def _in_range(motor: Motor, name: str) -> str:
    parameter = getattr(motor, name)
    unit = "" if parameter.unit == "1" else f" {parameter.unit}"
    ends = f" ({parameter.range[0]:g} to {parameter.range[1]:g})" if parameter.range else ""
    return f"{parameter.value:g}{unit}{ends}"


def _wrapped(words: list[str]) -> list[str]:
    import textwrap

    return textwrap.wrap(", ".join(words), 110, initial_indent="  ", subsequent_indent="  ", break_on_hyphens=False)
