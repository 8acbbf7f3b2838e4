"""How a motor starts from rest and stops, with the rotor's reaction on the wave (docs/coupling.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np

from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.schedule import Schedule
from trum_sym.inputs.shown import full
from trum_sym.model.drive_orbit import DriveHistory, DriveOrbit, drive_history
from trum_sym.model.levels import LevelChoice
from trum_sym.plots.style import COLOURS, GRID, Panels, figure_of, legend, panels, styled
from trum_sym.text import one_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["driven", "start_and_stop"]


@styled
def start_and_stop(
    motor: Motor | None = None,
    drive: Drive | None = None,
    schedule: Schedule | None = None,
    *,
    cycles: float = 10,
    pause: float = 200,
    rotor_mass: float | str | None = None,
    axes: Panels = None,
    **levels: Unpack[LevelChoice],
) -> Figure:
    """The rotor's speed and the wave from rest on and after the drive is switched off, shaded while it is.

    Parameters
    ----------
    motor, drive, schedule, cycles, pause, rotor_mass, levels
        As for ``trum_sym.model.drive_orbit.drive_history``.
    axes : two Axes, optional
        A new figure's if not given.
    """
    upper, lower = panels(axes, 2, 1, 3.6, sharex=True)
    found = drive_history(motor, drive, schedule, cycles=cycles, pause=pause, rotor_mass=rotor_mass, **levels)
    _motion(upper, lower, found)
    return figure_of(upper)


@styled
def driven(found: DriveOrbit) -> Figure:
    """The rotor's speed and the wave over the cycles of a drive's orbit, shaded while both phases are off."""
    upper, lower = panels(None, 2, 1, 3.6, sharex=True)
    _motion(upper, lower, found.history)
    upper.axhline(found.orbit.mean_speed, color=COLOURS[2], linestyle="--", linewidth=0.8, label="mean")
    legend(upper)
    drive, motor = found.inputs.drive, one_line(found.inputs.motor.name).replace("$", r"\$")
    figure_of(upper).suptitle(
        f"{motor}: {found.schedule.kind}, {full(drive.prepressure)} N, {full(drive.frequency_difference)} Hz, "
        f"{drive.load_text()}",
        fontsize=9,
    )
    return figure_of(upper)


def _motion(upper: Axes, lower: Axes, found: DriveHistory) -> None:
    """Speed and wave of a motion in time, shaded while both phases are off."""
    time = 1e3 * found.time
    upper.plot(time, found.speed, color=COLOURS[0])
    lower.plot(time, 1e6 * found.wave, color=COLOURS[1])
    off = np.flatnonzero(~found.driven.any(axis=1))
    for first in off[np.diff(off, prepend=-2) > 1]:
        after = found.driven[first:].any(axis=1)
        last = first + int(np.argmax(after)) if after.any() else len(found.driven)
        for ax in (upper, lower):
            ax.axvspan(time[first], time[last], color=GRID, alpha=0.5, linewidth=0)
    upper.set_ylabel("rotor (rad/s)")
    lower.set_ylabel("wave (µm)")
    lower.set_xlabel("time (ms)")
