"""Answers of commands as pictures: a point, its slopes, histories, a sweep, a fit, a front, a worst case, a table."""

from __future__ import annotations

from dataclasses import asdict
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.calibration.calibrate import model_of
from trum_sym.calibration.least_squares import interval_factor
from trum_sym.calibration.result import Calibration
from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import DRIVE_DOMAINS
from trum_sym.inputs.measurements import UNCERTAINTY
from trum_sym.inputs.shown import full, quantity_of, readable
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.histories import simulate
from trum_sym.model.operating_point import OperatingPoint
from trum_sym.model.sensitivities import Sensitivities
from trum_sym.plots.style import COLOURS, GRID, INK, figure_of, legend, panels, styled, write_picture
from trum_sym.quantities import QUANTITIES, Quantity
from trum_sym.studies.pareto import ParetoFront
from trum_sym.studies.robust import RobustPoint
from trum_sym.studies.speed_table_result import SpeedTable
from trum_sym.studies.track import Tracking
from trum_sym.text import one_line

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from trum_sym.model.coupled_point import CoupledPoint

__all__ = [
    "SUFFIXES",
    "check_swept",
    "fitted",
    "front",
    "histories",
    "point",
    "slopes",
    "swept",
    "table",
    "tracked",
    "worst_case",
    "write_picture",
]

SUFFIXES = (".png", ".svg", ".pdf")


def _plain(text: str) -> str:
    """Text that is no formula, whatever a motor is called."""
    return one_line(text).replace("$", r"\$")


@styled
def point(found: OperatingPoint | CoupledPoint) -> Figure:
    """The rotor's speed over two cycles of a single operating point, with its mean and its standard deviation."""
    inputs = found.inputs
    laps = simulate(inputs.motor, inputs.drive, cycles=2, tolerance=inputs.tolerance, **asdict(inputs.levels))
    (ax,) = panels(None, height=3.2)
    unit = 1e6 * ARCSEC
    mean = float(found.mean_speed) / unit
    speed = laps.rotor_speed.to_numpy() / unit
    deviation = float(np.std(speed))
    ax.axhspan(mean - deviation, mean + deviation, color=GRID, alpha=0.6, linewidth=0, label="mean ± deviation")
    ax.plot(1e3 * laps.time.to_numpy(), speed, color=COLOURS[0], label="rotor")
    ax.axhline(mean, color=COLOURS[1], linestyle="--", label=f"mean, {float(found.mean_speed) / ARCSEC:.6g} arcsec/s")
    ax.axhline(0, color=INK, linewidth=0.6)
    ax.set_xlabel("time (ms)")
    ax.set_ylabel("rotor speed (10⁶ arcsec/s)")
    drive = inputs.drive
    figure_of(ax).suptitle(
        f"{_plain(found.motor)}: {full(drive.prepressure)} N, {full(drive.frequency_difference)} Hz, "
        f"load {full(drive.load_torque)} N m, start {drive.start}",
        fontsize=9,
    )
    legend(ax)
    return figure_of(ax)


@styled
def histories(found: xr.Dataset) -> Figure:
    """Both phases, the contact, and the rotor's speed and angle over the cycles of ``ts.simulate``."""
    axes = panels(None, 4, 1, 6.4, sharex=True)
    time = 1e3 * found.time.to_numpy()
    turn = 180 / np.pi
    lines = (
        (axes[0], "w_A", 1e6, "phase A"),
        (axes[0], "w_B", 1e6, "phase B"),
        (axes[1], "theta", turn, "half-angle"),
        (axes[2], "rotor_speed", 1e-6 / ARCSEC, "rotor"),
        (axes[3], "rotor_angle", 1 / ARCSEC, "rotor"),
    )
    for ax, name, scale, label in lines:
        colour = COLOURS[len(ax.get_lines())]
        ax.plot(time, scale * found[name].to_numpy(), color=colour, label=label, linewidth=0.8)
    labels = ("displacement (µm)", "contact (°)", "speed (10⁶ arcsec/s)", "angle (arcsec)")
    for ax, label in zip(axes, labels, strict=True):
        ax.set_ylabel(label)
    mean = float(found.attrs["mean_speed"]) / ARCSEC
    axes[2].axhline(1e-6 * mean, color=COLOURS[1], linestyle="--", label=f"mean, {mean:.6g} arcsec/s")
    axes[3].set_xlabel("time since phase A is first switched off (ms)")
    region = found.region.to_numpy()
    edges = np.flatnonzero(np.diff(region, prepend=-1, append=-1))
    for first, last in pairwise(edges):
        if region[first] < len(_OFF):
            end = time[last] if last < time.size else time[-1]
            for ax in axes:
                named = ax is axes[0] and first < region.size / found.attrs["cycles"]
                label = _OFF[region[first]] if named else "_"
                ax.axvspan(time[first], end, color=_SHADES[region[first]], linewidth=0, zorder=0, label=label)
    for ax in (axes[0], axes[2]):
        legend(ax)
    figure_of(axes[0]).suptitle(_plain(found.attrs["title"]), fontsize=9)
    return figure_of(axes[0])


_OFF = ("A off", "B off")
_SHADES = ("#e9edf1", "#f7f1e3")
_SHOWN = ("mean_speed", "speed_volatility", "stall_torque", "q_average")  # of a sweep, where all are computed
_SHOWN_COUPLED = ("mean_speed", "speed_volatility", "highest_wave", "input_power")


def check_swept(dimensions: int) -> None:
    """Refuse a sweep that no picture shows.

    Raises
    ------
    ParameterError
        For more than two axes, or none.
    """
    if not 1 <= dimensions <= 2:
        raise ParameterError("--plot", f"{dimensions} axes", "a sweep over one axis, drawn as lines, or two, as maps")


@styled
def swept(found: xr.Dataset) -> Figure:
    """Figures of a sweep over one axis as lines, over two as maps; at most four of them."""
    names = [str(name) for name in found.data_vars if name != "status"]
    chosen = _SHOWN_COUPLED if found.attrs.get("coupling") == "contact" else _SHOWN
    names = ([name for name in chosen if name in names] or names)[:4]
    dimensions = [str(name) for name in found[names[0]].dims]
    check_swept(len(dimensions))
    missing = int(np.count_nonzero(found["status"].to_numpy()))
    rows = -(-len(names) // 2)
    axes = panels(None, rows, min(2, len(names)), 0.6 + 2.8 * rows)
    for ax, name in zip(axes, names, strict=False):
        quantity = quantity_of(name)
        values = found[name].to_numpy() * readable(name, 1.0)
        ax.set_xlabel(_axis(found, dimensions[-1]))
        if len(dimensions) == 1:
            ax.plot(_along(found, dimensions[0]), values, ".-", markersize=3)
            ax.set_ylabel(f"{quantity.label} ({quantity.shown})")
            continue
        x, y = _along(found, dimensions[1]), _along(found, dimensions[0])
        mesh = ax.pcolormesh(x, y, values, shading="nearest", rasterized=True)
        figure_of(ax).colorbar(mesh, ax=ax, label=f"{quantity.label} ({quantity.shown})", location="top")
        ax.set_ylabel(_axis(found, dimensions[0]))
        ax.grid(visible=False)
    for ax in axes[len(names) :]:
        ax.set_axis_off()
    blank = f"; blank: {missing} of {found['status'].size} without an answer" * bool(missing)
    figure_of(axes[0]).suptitle(_plain(found.attrs["motor"]) + blank, fontsize=9)
    return figure_of(axes[0])


def _along(found: xr.Dataset, dimension: str) -> Array:
    """The values along a dimension; the row where several parameters share it."""
    return found[dimension].to_numpy() if dimension in found.coords else np.arange(1.0, found.sizes[dimension] + 1)


def _axis(found: xr.Dataset, dimension: str) -> str:
    if dimension not in found.coords:
        return f"{dimension.replace('_', ' ')} (row)"
    unit = found[dimension].attrs.get("units", "1")
    return dimension.replace("_", " ") + (f" ({unit})" if unit != "1" else "")


@styled
def fitted(found: Calibration) -> Figure:
    """Each measured column with the fit through it, and the band in which the fit lies with the fit's confidence.

    Over the only input that varies, or time; over the rows where several vary.
    """
    data, model = found.measurements, model_of(found)
    values = np.array([estimate.value for estimate in found.estimates])
    fit = np.split(model.predict(values), len(data.observed))
    slopes = model.slopes(values)
    width = interval_factor(found.confidence, found.residuals.degrees_of_freedom)
    variance = np.einsum("ij,jk,ik->i", slopes, found.covariance, slopes)
    band = np.split(width * np.sqrt(np.maximum(variance, 0)), len(data.observed))
    varied = [data.abscissa] if data.abscissa else [n for n in data.inputs if np.ptp(data.columns[n]) > 0]
    name = varied[0] if len(varied) == 1 else None
    x = data.columns[name] if name is not None else np.arange(1.0, len(data) + 1)
    known = {"time": "s", "frequency": "Hz", **{field: unit for field, (_, unit) in DRIVE_DOMAINS.items()}}
    unit = known.get(name or "", "1")
    order = np.argsort(x, kind="stable")
    axes = panels(None, len(data.observed), 1, 0.8 + 2.6 * len(data.observed), sharex=True)
    for ax, column, line, half in zip(axes, data.observed, fit, band, strict=True):
        figure = column in QUANTITIES
        scale = float(readable(column, 1.0)) if figure else 1.0
        quantity = quantity_of(column) if figure else Quantity(column, "", "", _SIGNAL[column])
        low, high = scale * (line - half)[order], scale * (line + half)[order]
        band_of = f"its {100 * found.confidence:g} % band"
        ax.plot(x[order], scale * line[order], color=COLOURS[0], label="fit")
        ax.fill_between(x[order], low, high, color=COLOURS[5], alpha=0.6, linewidth=0, label=band_of)
        ax.plot(x, scale * data.columns[column], "o", color=COLOURS[1], markersize=3, label="measured")
        error = data.columns.get(column + UNCERTAINTY)
        if error is not None:
            ax.errorbar(x, scale * data.columns[column], scale * error, fmt="none", color=COLOURS[1], linewidth=0.8)
        ax.set_ylabel(f"{quantity.label} ({quantity.shown})")
        legend(ax)
    axes[-1].set_xlabel("row of the data" if name is None else name.replace("_", " ") + f" ({unit})" * (unit != "1"))
    shown = ", ".join(f"{e.name.replace('_', ' ')} {e.value:.4g}" for e in found.estimates if e.in_motor)
    figure_of(axes[0]).suptitle(f"{_plain(found.motor.name)} fitted to {_plain(found.data)}: {shown}", fontsize=9)
    return figure_of(axes[0])


_SIGNAL = {"displacement": "m", "velocity": "m/s", "envelope": "as measured", "conductance": "S", "susceptance": "S"}
_SHARE = 0.01


@styled
def slopes(found: Sensitivities) -> Figure:
    """What one percent of each input changes the mean speed and the volatility by, the largest on top."""
    inputs = found.inputs
    values = {**inputs.drive.numbers(), **{name: p.value for name, p in inputs.motor.parameters()}}
    from trum_sym.model.operating_point import evaluate

    here = evaluate(inputs.motor, inputs.drive, tolerance=inputs.tolerance, **asdict(inputs.levels))
    values = {**here.figures, **values}
    two = panels(None, 1, 2, 2.8, sharey=False)
    for ax, figure, colour in zip(two, ("mean_speed", "speed_volatility"), COLOURS, strict=False):
        quantity = quantity_of(figure)
        changes = {
            name: readable(figure, float(found[figure][name]) * _SHARE * float(np.asarray(values[name])))
            for name in found.parameters
        }
        order = sorted(changes, key=lambda name, of=changes: abs(of[name]))  # type: ignore[misc]
        ax.barh([name.replace("_", " ") for name in order], [changes[name] for name in order], color=colour)
        ax.axvline(0, color=INK, linewidth=0.6)
        ax.set_title(quantity.label)
        ax.set_xlabel(f"change by 1 % of the input ({quantity.shown})")
        ax.grid(visible=False, axis="y")
    figure_of(two[0]).suptitle(_plain(inputs.motor.name), fontsize=9)
    return figure_of(two[0])


@styled
def front(found: ParetoFront) -> Figure:
    """The two figures of a front against each other, the points by their numbers."""
    (ax,) = panels(None, height=3.4)
    x, y = ([getattr(point, name) for point in found.points] for name in ("against", "objective"))
    ax.plot(x, y, "o", color=COLOURS[0])
    for number, place in enumerate(zip(x, y, strict=True), 1):
        ax.annotate(str(number), place, xytext=(4, 4), textcoords="offset points", fontsize=8)
    for low, high in found.gaps:
        ax.axvspan(low, high, color=GRID, alpha=0.6, linewidth=0)
    better = "more is better" if found.larger_is_better else "less is better"
    ax.set_xlabel(f"{found.against.replace('$', '')} (SI units, {better})" + "; grey: gaps" * bool(found.gaps))
    ax.set_ylabel(f"{found.objective.replace('$', '')} (SI units, less is better)")
    ax.set_title(f"{_plain(found.inputs.motor.name)}: {found.message}")
    return figure_of(ax)


@styled
def worst_case(found: RobustPoint) -> Figure:
    """The objective in every case at the robust point, the nominal one on top."""
    (ax,) = panels(None, height=1.2 + 0.28 * len(found.cases))
    names = [", ".join(f"{n} {v:.4g}" for n, v in case.changed.items()) or "nominal" for case in found.cases]
    values = [case.objective for case in found.cases]
    worst = max(values)
    colours = [COLOURS[1] if value >= worst - 1e-4 * abs(worst) else COLOURS[0] for value in values]
    ax.barh(range(len(values)), values, color=colours)
    ax.set_yticks(range(len(values)), names, fontsize=7)
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlabel(f"{found.objective.replace('$', '')} (SI units, less is better)")
    ax.set_title(f"{_plain(found.inputs.motor.name)}: {full(found.prepressure)} N, {found.frequency_difference:.7g} Hz")
    return figure_of(ax)


@styled
def table(found: SpeedTable) -> Figure:
    """The drive against the mean speed, a stretch without a jump a line."""
    names = found.variables
    axes = panels(None, len(names), 1, 2.0 + 1.2 * len(names), sharex=True)
    for ax, name in zip(axes, names, strict=True):
        for segment in found.segments:
            ax.plot(segment.speed / ARCSEC, segment.drive[name], ".-", color=COLOURS[0], markersize=3)
        for gap in found.gaps:
            ax.axvspan(gap.low / ARCSEC, gap.high / ARCSEC, color=GRID, alpha=0.6, linewidth=0)
        unit = {"prepressure": "N", "frequency_difference": "Hz", "switching_phase": "rad"}[name]
        ax.set_ylabel(f"{name.replace('_', ' ')} ({unit})")
    axes[-1].set_xlabel("mean speed (arcsec/s)" + "; grey: speeds that the table does not have" * bool(found.gaps))
    axes[0].set_title(f"{_plain(found.motor)}: {len(found)} entries")
    return figure_of(axes[0])


@styled
def tracked(found: Tracking) -> Figure:
    """Speed in closed and in open loop, the frequency that is set, and how the disturbances come."""
    top, middle, bottom = panels(None, 3, 1, 6.6, sharex=True)
    target = found.target_speed / ARCSEC
    for run, colour, name in ((found.open, COLOURS[1], "open loop"), (found.closed, COLOURS[0], "closed loop")):
        few = min(5, run.time.size)
        means = np.convolve(run.speed, np.full(few, 1 / few), "valid") / ARCSEC
        top.plot(1e3 * run.time, run.speed / ARCSEC, color=colour, linewidth=0.4, alpha=0.5)
        top.plot(1e3 * run.time[few - 1 :], means, color=colour, label=f"{name}, mean of {few} periods")
        middle.plot(1e3 * run.time, run.frequency_difference, color=colour, drawstyle="steps-post", label=name)
    top.axhline(target, color=INK, linewidth=0.8, linestyle=":", label=f"target, {target:.6g} arcsec/s")
    top.set_ylabel("mean speed (arcsec/s)")
    middle.set_ylabel("frequency difference (Hz)")
    for disturbance, colour in zip(found.disturbances, (*COLOURS[2:], *COLOURS[:2]), strict=False):
        bottom.plot(1e3 * found.closed.time, found.set_values(disturbance), color=colour, label=disturbance.text)
    bottom.set_ylabel("share that has come")
    bottom.set_xlabel("time (ms)")
    legend(top)
    legend(bottom, ncols=2)
    figure_of(top).suptitle(
        f"{_plain(found.inputs.motor.name)}: PI every {1e3 * found.control_period:g} ms, "
        f"{found.encoder_counts} counts, {found.inputs.drive.load_text()}",
        fontsize=9,
    )
    return figure_of(top)
