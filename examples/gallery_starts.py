"""The same drive in the three states in which a cycle can begin.

    python examples/gallery_starts.py [FOLDER]

Prints the figures; with a folder, also draws starts.svg there: the rotor's speed over two cycles.
"""

from __future__ import annotations

import sys
from pathlib import Path

import trum_sym as ts
from trum_sym import plots
from trum_sym.inputs.units import ARCSEC


def main(folder: Path | None = None) -> None:
    """Compare periodic, steady and rest, each with the lead that makes Q_aver positive."""
    motor = ts.load_motor("trum60")
    print("start     lead   Q_aver 1/s   v_s arcsec/s   stall N m")
    panels = plots.blank(3, 1, height=6.4, sharex=True)
    for axes, reading in zip(panels, plots.READINGS, strict=True):
        drive = reading.of(ts.Drive(load_torque=0.1))
        point = ts.evaluate(motor, drive)
        print(
            f"{reading.start:<8}  {reading.phase_lead:+4d}  {point.q_average:11.1f}  "
            f"{point.mean_speed / ARCSEC:13.0f}  {point.stall_torque:10.4f}"
        )
        plots.instantaneous_speed(motor, drive, axes=axes)
        axes.set_title(reading.label, loc="right")
        axes.label_outer()
    if folder is not None:
        plots.save(panels[0].figure, folder / "starts.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
