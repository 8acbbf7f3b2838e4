"""The stator over a drive cycle: phases, surface, determinant (Figs. 3, 6, 9 to 19)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.histories import REGIONS
from trum_sym.paper.cycle import Cycle, solve
from trum_sym.plots.style import COLOURS, GRID, INK, Panels, figure_of, legend, panels, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "determinant",
    "ellipse",
    "forward_and_backward",
    "instantaneous_speed",
    "phase_responses",
    "tangential_velocity",
    "vertical_displacement",
]

_SHADES = ("#0072b2", "#d55e00", "#009e73")
_PLACE = np.pi / 4  # k_c x of particle Q: the paper says any; here both phases count alike
SECTION_5 = (
    Drive(periods=100, on_periods=55, start="steady"),
    Drive(periods=100, on_periods=55, start="steady"),
    Drive(periods=100, on_periods=75, start="steady"),
)
"""The drives of Sects. 5.2.1 to 5.2.3, one a region."""


def _shade(axes: Axes, cycle: Cycle, named: bool) -> None:
    for low, high, colour, name in zip(cycle.edges, cycle.edges[1:], _SHADES, REGIONS, strict=False):
        axes.axvspan(1e3 * low, 1e3 * high, color=colour, alpha=0.09, linewidth=0)
        if named and high > low:
            axes.annotate(
                name,
                (5e2 * (low + high), 1.0),
                (0, 3),
                xycoords=("data", "axes fraction"),
                textcoords="offset points",
                ha="center",
                fontsize=8,
            )


@styled
def phase_responses(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 3: both phases over a drive cycle, with their envelopes and the three regions.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : two Axes, optional
        Phase A and phase B; a new figure's if not given.
    """
    cycle = solve(motor, drive)
    both = panels(axes, 2, 1, 3.6, sharex=True, sharey=True)
    time = cycle.times(48)
    found = cycle.phases(time)
    for ax, phase, angle, colour in zip(both, "AB", (np.pi / 2, 0.0), COLOURS, strict=False):
        envelope = cycle.surface(time, angle / np.asarray(cycle.case.arguments["k_c"]))["A_Q"]
        _shade(ax, cycle, named=phase == "A")
        ax.plot(1e3 * time, 1e6 * np.asarray(found[f"w_{phase}"]), color=colour, linewidth=0.9, label=f"w_{phase}")
        for sign in (1, -1):
            ax.plot(1e3 * time, sign * 1e6 * envelope, "--", color=INK, linewidth=0.7, label="envelope")
        ax.set_ylabel(f"w_{phase} (µm)")
    both[1].set_xlabel("time since t₁ (ms)")
    return figure_of(both[0])


@styled
def tangential_velocity(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 6: tangential velocity along a wavelength, in the middle of each region; dots are at the crest.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, drive)
    (ax,) = panels(axes)
    wavelength = 2 * np.pi / float(np.asarray(cycle.case.arguments["k_c"]))
    x = np.linspace(0, wavelength, 181)
    for region, colour in zip(range(3), COLOURS, strict=False):
        middle = (cycle.edges[region] + cycle.edges[region + 1]) / 2
        found = cycle.surface(middle, x)
        crest = float(found["x_max"][0]) % wavelength
        ax.plot(1e3 * x, found["v_x"], color=colour, label=REGIONS[region])
        ax.plot(1e3 * crest, float(cycle.surface(middle, crest)["v_x"]), "o", color=colour, markersize=5)
    ax.axhline(0, color=INK, linewidth=0.6)
    ax.set_xlabel("position x along the circumference (mm)")
    ax.set_ylabel("tangential velocity v_x (m/s)")
    legend(ax)
    return figure_of(ax)


def _beat(cycle: Cycle, region: int, per_period: int) -> Array:
    """Times of a region's first beat of the frequency difference, or of the region if that is shorter."""
    low, high = cycle.edges[region : region + 2]
    beat = 1.0 / abs(float(np.asarray(cycle.case.drive.frequency_difference)))
    span = min(beat, high - low)
    return np.linspace(low, low + span, 4 * round(span / cycle.period * per_period / 4) + 1)


@styled
def ellipse(motor: Motor | None = None, drive: Drive | None = None, *, region: int = 0, axes: Panels = None) -> Figure:
    """Figs. 9, 12, 15: path of particle Q in the four quarters of a region's first beat, clockwise or not.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the drive of Sect. 5.2 for this region if not given.
    region : {0, 1, 2}
        A off, B off, both on.
    axes : four Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, SECTION_5[region] if drive is None else drive)
    four = panels(axes, 1, 4, 2.5, sharex=True, sharey=True)
    k_c = float(np.asarray(cycle.case.arguments["k_c"]))
    time = _beat(cycle, region, 48)
    point = cycle.surface(time, _PLACE / k_c)
    turning = np.asarray(cycle.phases(time)["Q"])
    quarter = (len(time) - 1) // 4
    for number, ax in enumerate(four):
        part = slice(number * quarter, (number + 1) * quarter + 1)
        for sign, colour, name in ((1, COLOURS[0], "clockwise"), (-1, COLOURS[1], "counter-clockwise")):
            kept = sign * turning[part] > 0
            x, z = (np.where(kept, 1e6 * point[name_][part], np.nan) for name_ in ("zeta_x", "zeta_z"))
            ax.plot(x, z, color=colour, linewidth=0.9, label=name)
        ax.plot(1e6 * point["zeta_x"][part.start], 1e6 * point["zeta_z"][part.start], "o", color=INK, markersize=3)
        ax.set_title(f"quarter {number + 1}")
        ax.set_xlabel("ζ_x (µm)")
        ax.set_box_aspect(1)
    four[0].set_ylabel("ζ_z (µm)")
    reach = 1.06e6 * max(float(np.max(np.abs(point[name]))) for name in ("zeta_x", "zeta_z"))
    four[0].set(xlim=(-reach, reach), ylim=(-reach, reach))
    figure = figure_of(four[0])
    handles, labels = four[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


@styled
def vertical_displacement(
    motor: Motor | None = None, drive: Drive | None = None, *, region: int = 0, axes: Panels = None
) -> Figure:
    """Figs. 10, 13, 16: vertical displacement of particle Q through a region, within its envelope (eq. 12).

    Parameters
    ----------
    motor, drive
        TRUM-60 and the drive of Sect. 5.2 for this region if not given.
    region : {0, 1, 2}
        A off, B off, both on.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, SECTION_5[region] if drive is None else drive)
    (ax,) = panels(axes, height=2.4)
    time = cycle.times(40, region)
    # the last instant belongs to this region still, not to the next
    found = cycle.surface(np.minimum(time, np.nextafter(time[-1], 0)), _PLACE / np.asarray(cycle.case.arguments["k_c"]))
    shown = 1e3 * (time - time[0])
    ax.plot(shown, 1e6 * found["zeta_z"], color=COLOURS[0], linewidth=0.8, label="ζ_z of particle Q")
    for sign in (1, -1):
        ax.plot(
            shown, sign * 1e6 * found["A_Q"], color=COLOURS[1], linewidth=1.1, label="envelope" if sign > 0 else None
        )
    ax.set_xlabel(f"time since the region's start, {REGIONS[region]} (ms)")
    ax.set_ylabel("ζ_z (µm)")
    legend(ax)
    return figure_of(ax)


@styled
def determinant(
    motor: Motor | None = None, drive: Drive | None = None, *, region: int = 0, axes: Panels = None
) -> Figure:
    """Figs. 11, 14, 17: the direction determinant Q through a region, and the crest's tangential velocity.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the drive of Sect. 5.2 for this region if not given.
    region : {0, 1, 2}
        A off, B off, both on.
    axes : two Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, SECTION_5[region] if drive is None else drive)
    upper, lower = panels(axes, 2, 1, 3.2, sharex=True)
    time = cycle.times(40, region)
    inside = np.minimum(time, np.nextafter(time[-1], 0))
    shown = 1e3 * (time - time[0])
    touching = cycle.touching(inside)
    turning = 1e6 * np.asarray(cycle.phases(inside)["Q"])
    upper.plot(shown, turning, color=INK, linewidth=0.8, label="Q")
    _signed(upper, shown, turning)
    crest = np.asarray(touching["R_v"]) * np.asarray(touching["cos_phi"])
    lower.plot(shown, crest, color=COLOURS[2], linewidth=0.8, label="v_xmax")
    lower.axhline(0, color=INK, linewidth=0.6)
    upper.set_ylabel("Q (mm²/s)")
    lower.set_ylabel("v_xmax (m/s)")
    lower.set_xlabel(f"time since the region's start, {REGIONS[region]} (ms)")
    return figure_of(upper)


def _signed(axes: Axes, time: Array, values: Array) -> None:
    above, below = values > 0, values < 0
    axes.fill_between(time, values, 0, where=list(above), color=COLOURS[0], alpha=0.45, linewidth=0, label="clockwise")
    axes.fill_between(
        time, values, 0, where=list(below), color=COLOURS[1], alpha=0.45, linewidth=0, label="counter-clockwise"
    )
    axes.axhline(0, color=INK, linewidth=0.6)
    legend(axes)


@styled
def instantaneous_speed(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 18: the rotor's speed over two cycles, its mean v_s, and S_k to either side (eqs. 39 to 41).

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, drive)
    (ax,) = panels(axes)
    time, speed, _ = cycle.rotor(480)
    laps = np.concatenate([time, time[1:] + time[-1]])
    unit = 1e6 * ARCSEC
    mean = float(cycle.orbit.mean_speed) / unit
    spread = float(np.sqrt(cycle.orbit.variance)) / unit
    ax.axhspan(mean - spread, mean + spread, color=GRID, alpha=0.6, linewidth=0, label="v_s ± S_k")
    ax.plot(1e3 * laps, np.concatenate([speed, speed[1:]]) / unit, color=COLOURS[0], label="v_i")
    ax.axhline(mean, color=COLOURS[1], linestyle="--", label="v_s")
    ax.set_xlabel("time since t₁ (ms)")
    ax.set_ylabel("rotor speed (10⁶ arcsec/s)")
    legend(ax)
    return figure_of(ax)


@styled
def forward_and_backward(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 19: the determinant over a cycle, its positive and its negative parts, whose sums make Q_aver and Q_vib.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, drive)
    (ax,) = panels(axes)
    time = cycle.times(48)
    _shade_edges(ax, cycle)
    values = 1e6 * np.asarray(cycle.phases(np.minimum(time, np.nextafter(time[-1], 0)))["Q"])
    ax.plot(1e3 * time, values, color=INK, linewidth=0.8, label="Q")
    _signed(ax, 1e3 * time, values)
    ax.set_xlabel("time since t₁ (ms)")
    ax.set_ylabel("Q (mm²/s)")
    return figure_of(ax)


def _shade_edges(axes: Axes, cycle: Cycle) -> None:
    for edge in cycle.edges[1:3]:
        axes.axvline(1e3 * edge, color=INK, linewidth=0.6, linestyle=":")
