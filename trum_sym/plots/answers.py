"""Answers of commands as pictures: a point, its slopes, a front, a worst case, a speed table."""

from __future__ import annotations

from dataclasses import asdict
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.shown import full, quantity_of, readable
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.histories import simulate
from trum_sym.model.operating_point import OperatingPoint
from trum_sym.model.sensitivities import PARAMETERS, Sensitivities
from trum_sym.output.files import write_bytes
from trum_sym.plots.style import COLOURS, GRID, INK, figure_of, legend, panels, styled
from trum_sym.studies.pareto import ParetoFront
from trum_sym.studies.robust import RobustPoint
from trum_sym.studies.speed_table_result import SpeedTable
from trum_sym.studies.track import Tracking
from trum_sym.text import one_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["SUFFIXES", "front", "point", "slopes", "table", "tracked", "worst_case", "write"]

SUFFIXES = (".png", ".svg", ".pdf")


def write(name: str, figure: Figure, target: Path) -> None:
    """Write a picture, whole or not at all.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    content = BytesIO()
    figure.savefig(content, format=target.suffix[1:], dpi=150, facecolor="white")
    write_bytes(name, content.getvalue(), target)


def _plain(text: str) -> str:
    """Text that is no formula, whatever a motor is called."""
    return one_line(text).replace("$", r"\$")


@styled
def point(found: OperatingPoint) -> Figure:
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
            for name in PARAMETERS
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
