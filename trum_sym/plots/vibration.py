"""The stator alone, as Sect. 7 measured it: resonance under prepressure, power-off decay, beat (Figs. 25b to 27b)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.model.levels import FOUNDATIONS, RESONANCES, Levels
from trum_sym.model.stator import solve_stator
from trum_sym.paper.cycle import Cycle, solve
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, legend, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["beat", "power_off", "resonance_levels"]

MEASURED, APPLIED = 39703.0, 45000.0
"""Sect. 7.3: resonance and drive frequency of the power-off experiments, Hz."""
_BEFORE, _AFTER = 9, 45  # drive periods that are shown on either side of t_off


@styled
def resonance_levels(motor: Motor | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 25b, the model's side: resonance against prepressure at every level, and the measured frequency.

    Parameters
    ----------
    motor
        TRUM-60 if not given.
    axes : Axes, optional
        A new figure's if not given.
    """
    machine = load_motor("trum60") if motor is None else motor
    (ax,) = panels(axes, height=3.6)
    force = np.linspace(100.0, 220.0, 25)
    styles = {"harmonic": "-", "smeared": "--", "printed": ":", "none": "-."}
    for resonance, colour in zip(RESONANCES, COLOURS, strict=False):
        for foundation in FOUNDATIONS:
            levels = Levels("winkler", resonance, foundation, "measured")
            omega_n = np.asarray(solve_stator(machine, Drive(prepressure=force), levels).omega_n)
            frequency = np.broadcast_to(omega_n, force.shape) / (2e3 * np.pi)
            ax.plot(force, frequency, styles[foundation], color=colour, label=f"{resonance}, {foundation}")
    for entry in machine.published:
        if entry.output == "resonance_frequency":
            ax.axhline(1e-3 * entry.value, color=INK, linewidth=1.6, alpha=0.6, label="measured (Sect. 7.3)")
    ax.set_xlabel("prepressure F_c (N)")
    ax.set_ylabel("resonance f_n (kHz)")
    legend(ax, loc="upper left", bbox_to_anchor=(1.0, 1.0), ncols=1, fontsize=7)
    return figure_of(ax)


def _switched_off(motor: Motor | None) -> Cycle:
    """Both phases steady at 45 kHz until A is switched off, the resonance as measured."""
    machine = (load_motor("trum60") if motor is None else motor).with_values({"resonance_frequency": MEASURED})
    drive = Drive(frequency_difference=APPLIED - MEASURED, periods=2 * _AFTER, on_periods=_AFTER, start="steady")
    return solve(machine, drive)


def _around(cycle: Cycle) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """Times about t_off, and the phases' velocities: steady before, free or steady after."""
    before = np.arange(-_BEFORE * 48, 0) / 48 * cycle.period
    after = np.arange(_AFTER * 48) / 48 * cycle.period
    always = replace(cycle.case.drive, on_periods=cycle.case.drive.periods)
    running = solve(cycle.case.motor, always).phases(before + cycle.edges[-1])
    stopped = cycle.phases(after)
    steady = {phase: np.asarray(running[f"v_{phase}"]) for phase in "AB"}
    return np.concatenate([before, after]), steady, {phase: np.asarray(stopped[f"v_{phase}"]) for phase in "AB"}


@styled
def power_off(motor: Motor | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 26b, the model's side: vertical velocity of phase A alone, 45 kHz until t_off, then free at 39.703 kHz.

    Parameters
    ----------
    motor
        TRUM-60 if not given; its resonance is replaced by the measured one.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = _switched_off(motor)
    (ax,) = panels(axes, height=2.5)
    time, steady, free = _around(cycle)
    scale = float(np.max(np.abs(steady["A"])))
    ax.plot(
        1e3 * time,
        np.concatenate([steady["A"], free["A"]]) / scale,
        color=COLOURS[0],
        linewidth=0.8,
        label="velocity of M, phase A alone",
    )
    ax.axvline(0, color=INK, linewidth=0.8, linestyle=":")
    ax.annotate("t_off", (0, 1), (3, -2), xycoords=("data", "axes fraction"), textcoords="offset points", va="top")
    ax.set_xlabel("time since t_off (ms)")
    ax.set_ylabel("over its amplitude (1)")
    legend(ax)
    return figure_of(ax)


@styled
def beat(motor: Motor | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 27b, the model's side: both phases at 45 kHz, A switched off at t_off; vertical velocity beats.

    The point lies where both phases move it alike, k_c x = π/4.

    Parameters
    ----------
    motor
        TRUM-60 if not given; its resonance is replaced by the measured one.
    axes : Axes, optional
        A new figure's if not given.
    """
    cycle = _switched_off(motor)
    (ax,) = panels(axes, height=2.5)
    time, steady, free = _around(cycle)
    both = np.concatenate([steady["A"] + steady["B"], free["A"] + free["B"]])
    scale = float(np.max(np.abs(both[time < 0])))
    ax.plot(1e3 * time, both / scale, color=COLOURS[0], linewidth=0.8, label="velocity of M, both phases")
    period = 1e3 / (APPLIED - MEASURED)
    ax.axvline(0, color=INK, linewidth=0.8, linestyle=":")
    for number in range(int(1e3 * time[-1] / period) + 1):
        ax.axvspan(
            number * period,
            min((number + 1) * period, 1e3 * time[-1]),
            color=COLOURS[number % 2],
            alpha=0.08,
            linewidth=0,
        )
    ax.set_xlabel("time since t_off (ms); bands last 1/(f_q − f_n) = " + f"{period:.3f} ms")
    ax.set_ylabel("over its amplitude (1)")
    legend(ax)
    return figure_of(ax)
