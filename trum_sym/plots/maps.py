"""Speed and determinants over the paper's box and beyond it; does Q_aver predict v_s, Q_vib predict sigma_s?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.model.operating_point import evaluate
from trum_sym.paper.cycle import READINGS
from trum_sym.paper.published import BOX
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, legend, panels, styled
from trum_sym.plots.trends import measures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["BEYOND", "maps", "prediction", "rank_correlation"]

BEYOND: dict[str, tuple[float, float]] = {"frequency_difference": (500.0, 5000.0), "prepressure": (100.0, 220.0)}
"""Around the box: from near resonance to twice its middle, Hz; the range of Table 2, N."""


def rank_correlation(first: Array, second: Array) -> float:
    """Spearman's, of two samples without ties."""
    ranks = [np.argsort(np.argsort(np.ravel(sample))) for sample in (first, second)]
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])


def _grid(
    motor: Motor | None,
    drive: Drive,
    ranges: Mapping[str, tuple[float, float]],
    across: int,
    up: int,
    sampling_period: float | None = None,
) -> tuple[Array, Array, dict[str, Array]]:
    """Frequency differences, prepressures, and the figures on their grid, shape (up, across)."""
    difference = np.linspace(*ranges["frequency_difference"], across)
    force = np.linspace(*ranges["prepressure"], up)
    at = replace(drive, frequency_difference=difference[None, :], prepressure=force[:, None])
    machine = load_motor("trum60") if motor is None else motor
    return difference, force, measures(evaluate(machine, at, sampling_period=sampling_period))


@styled
def maps(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Mean speed, volatility and Q_aver over the paper's box (above) and around it (below), zero speed as a line.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given, but for the two variables.
    axes : six Axes, optional
        A new figure's if not given.
    """
    six = panels(axes, 2, 3, 5.0)
    drive = Drive() if drive is None else drive
    ranges = (BOX, BEYOND)
    for row, (spans, shape) in enumerate(zip(ranges, ((31, 26), (46, 31)), strict=True)):
        difference, force, found = _grid(motor, drive, spans, *shape)
        speed, volatility = found["mean_speed"], np.log10(found["speed_volatility"])
        shown = (
            ("v_s (10⁶ arcsec/s)", speed, "cividis", _span(speed)),
            ("log₁₀ of σ_s in %", volatility, "cividis", _span(np.minimum(volatility, 3.0))),
            ("Q_aver (1/s)", found["q_average"], "cividis", _span(found["q_average"])),
        )
        for ax, (label, values, colours, limits) in zip(six[3 * row : 3 * row + 3], shown, strict=True):
            mesh = ax.pcolormesh(difference, force, values, cmap=colours, shading="nearest", rasterized=True, **limits)
            figure_of(ax).colorbar(mesh, ax=ax, label=label, location="top", shrink=0.95)
            if np.nanmin(speed) < 0 < np.nanmax(speed):
                ax.contour(difference, force, speed, levels=[0.0], colors="#d55e00", linewidths=1.6)
            ax.grid(visible=False)
            if row:
                (left, right), (low, high) = BOX["frequency_difference"], BOX["prepressure"]
                ax.plot([left, right, right, left, left], [low, low, high, high, low], color="white", linewidth=1.0)
                ax.set_xlabel("Δf (Hz)")
        six[3 * row].set_ylabel("prepressure F_c (N)")
    return figure_of(six[0])


def _span(values: Array) -> dict[str, Any]:
    low, high = np.nanquantile(values, (0.005, 0.995))
    return {"vmin": float(low), "vmax": float(high)}


@styled
def prediction(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    sampling_period: float | None = None,
    axes: Panels = None,
) -> Figure:
    """Does Q_aver predict v_s, and Q_vib sigma_s?  Over the box and around it, with rank correlations.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given, but for the two variables.
    sampling_period : float, s, optional
        Of the encoder behind the volatility; continuous if not given.
    axes : four Axes, optional
        v_s over the box and beyond, then sigma_s.
    """
    four = panels(axes, 2, 2, 5.2)
    drive = Drive() if drive is None else drive
    ranges = (BOX, BEYOND)
    for column, (spans, title) in enumerate(zip(ranges, ("the paper's box", "around it"), strict=True)):
        for reading, colour, mark in zip(READINGS, COLOURS, "osD", strict=False):
            _, _, found = _grid(motor, reading.of(drive), spans, 12, 12, sampling_period)
            for ax, x, y in (
                (four[column], "q_average", "mean_speed"),
                (four[2 + column], "q_volatility", "speed_volatility"),
            ):
                rank = rank_correlation(found[x], found[y])
                label = f"{reading.label}: rank correlation {rank:+.2f}".replace("-", "−")
                style: dict[str, Any] = {"markersize": 2.2, "markeredgewidth": 0, "alpha": 0.7}
                ax.plot(found[x].ravel(), found[y].ravel(), mark, color=colour, label=label, **style)
        four[column].set_title(title, pad=44)
    for ax in four[:2]:
        ax.set_xlabel("Q_aver (1/s)")
        ax.set_ylabel("v_s (10⁶ arcsec/s)")
        ax.axhline(0, color=INK, linewidth=0.5)
    for ax in four[2:]:
        ax.set_xlabel("Q_vib (1/s)")
        ax.set_ylabel("σ_s (%)")
        ax.set_yscale("log")
    four[3].set_xscale("symlog", linthresh=3e3, linscale=0.5)  # Q_vib has poles where Q_aver is 0
    four[3].set_xticks([-1e5, -1e4, 0.0, 1e4, 1e5])
    for ax in four:
        legend(ax, ncols=1, fontsize=7, markerscale=2)
    return figure_of(four[0])
