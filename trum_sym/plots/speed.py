"""The rotor's speed as an encoder reads it, and under load (Fig. 29; torque against speed)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.kernels import call
from trum_sym.model.operating_point import evaluate
from trum_sym.model.rotor import encoder_readings, history
from trum_sym.paper.cycle import READINGS, solve
from trum_sym.paper.published import ENCODER
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, legend, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["measured_speed", "torque_speed"]

_COUNT = 60


@styled
def measured_speed(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 29, the model's side: consecutive readings of an encoder of 2 ms, as deviation from their mean.

    The drive's cycle and the encoder's period are no multiples of each other, so the readings scatter.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : three Axes, optional
        One a start.
    """
    three = panels(axes, 1, 3, 2.6, sharey=True)
    drive = Drive() if drive is None else drive
    for ax, reading, colour in zip(three, READINGS, COLOURS, strict=False):
        cycle = solve(motor, reading.of(drive))
        distance = history(cycle.case.arguments, cycle.orbit.raw, 64 * int(np.asarray(drive.periods)))["distance"]
        lap = float(cycle.edges[-1])
        starts = np.asarray(np.arange(_COUNT) * (ENCODER / lap) % 1.0, np.float64)
        speed = encoder_readings(distance, lap, ENCODER, starts) / np.asarray(cycle.case.symbols["r_c"])
        mean = float(cycle.orbit.mean_speed)
        time = 1e3 * ENCODER * np.arange(_COUNT)
        ax.plot(time, 100 * (speed / mean - 1), ".-", color=colour, linewidth=0.3, markersize=3.5)
        ax.axhline(0, color=INK, linewidth=0.6)
        ax.set_title(f"{reading.label}\nmean {mean / (1e6 * ARCSEC):.4g}·10⁶ arcsec/s".replace("-", "−"))
        ax.set_xlabel("time (ms)")
    three[0].set_ylabel("reading less mean (% of the mean)")
    return figure_of(three[0])


@styled
def torque_speed(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Mean speed against load torque up to the limit of friction, with the torque on the rotor held still.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given, but for the load.
    axes : Axes, optional
        A new figure's if not given.
    """
    machine = load_motor("trum60") if motor is None else motor
    drive = Drive() if drive is None else drive
    (ax,) = panels(axes, height=3.2)
    limit = float(
        np.asarray(call("trum_stall_torque", {**machine.symbols(), "F_c": drive.prepressure, "f": 1.0})["torque"])
    )
    load = np.linspace(-0.98, 0.98, 57) * limit
    for reading, colour, line in zip(READINGS, COLOURS, ("-", "--", "-."), strict=False):
        point = evaluate(machine, replace(reading.of(drive), load_torque=load))
        ax.plot(load, np.asarray(point.mean_speed) / (1e6 * ARCSEC), line, color=colour, label=reading.label)
        ax.plot([float(np.ravel(point.stall_torque)[0])], [0.0], "o", color=colour, markersize=5)
    ax.axhline(0, color=INK, linewidth=0.6)
    ax.axvline(float(np.asarray(drive.load_torque)), color=INK, linewidth=0.8, linestyle=":", label="load of the drive")
    ax.set_xlabel("load torque (N m); dots: mean torque on the rotor held still")
    ax.set_ylabel("v_s (10⁶ arcsec/s)")
    legend(ax)
    return figure_of(ax)
