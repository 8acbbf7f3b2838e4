"""What the motor file's spreads move the mean speed by, over all that the hardware allows, as a picture.

python examples/drift_map.py docs/pictures/drift-map.png
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import solve_orbit
from trum_sym.model.spreading import speeds_off
from trum_sym.plots import answers
from trum_sym.plots.style import blank, figure_of

FORCES, DIFFERENCES = 25, 33
TARGET = 633.0  # arcsec/s
READINGS = (ts.Drive(), ts.Drive(start="rest", phase_lead=-1, load_inertia=4e-3))


def main() -> None:
    """Draw both readings side by side."""
    motor = ts.load_motor("trum60")
    low, high = motor.allowed["prepressure"], motor.allowed["frequency_difference"]
    force = np.linspace(low.low, low.high, FORCES)
    difference = np.linspace(high.low, high.high, DIFFERENCES)
    axes = blank(1, 2, 3.6, sharey=True)
    for ax, drive in zip(axes, READINGS, strict=True):
        at = replace(drive, prepressure=force[:, np.newaxis], frequency_difference=difference)
        case = prepare(motor, at, Levels(), 1e-5, warn=False)
        mean = np.asarray(solve_orbit(case.arguments, case.symbols).mean_speed)
        drift = sum(np.max(np.abs(both - mean), axis=0) for both in speeds_off(case, motor.spreads).values())
        shown = ax.pcolormesh(1e-3 * difference, force, np.log10(drift / ARCSEC), shading="gouraud", vmin=3.5, vmax=6)
        ax.contour(1e-3 * difference, force, mean / ARCSEC, [TARGET], colors="white", linewidths=1.0)
        ax.set_title(f"{drive.start} {drive.phase_lead:+g}, load {drive.load_inertia:g} kg m²", fontsize=9)
        ax.set_xlabel("frequency difference (kHz)")
        least = np.unravel_index(np.argmin(drift), drift.shape)
        where = f"{force[least[0]]:.0f} N, {difference[least[1]]:.0f} Hz"
        ends = f"{drift.min() / ARCSEC:.0f} to {drift.max() / ARCSEC:.3g} arcsec/s"
        print(f"{drive.start} {drive.phase_lead:+g}: drift {ends},")
        print(f"  the least at {where}, where the mean is {mean[least] / ARCSEC:.4g} arcsec/s")
    axes[0].set_ylabel("prepressure (N)")
    figure = figure_of(axes[0])
    figure.colorbar(shown, ax=axes, label="drift by all spreads (log10 of arcsec/s)")
    figure.suptitle(
        f"1 N, 1 Hz, 1 % of friction, load and amplitude; white: {TARGET:g} arcsec/s at 0.3 N m", fontsize=9
    )
    answers.write("picture", figure, Path(sys.argv[1]))


if __name__ == "__main__":
    main()
