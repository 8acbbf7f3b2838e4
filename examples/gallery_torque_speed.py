"""How the mean speed falls with the load.

    python examples/gallery_torque_speed.py [FOLDER]

Prints the curve; with a folder, also draws torque-speed.svg there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym import plots
from trum_sym.inputs.units import ARCSEC


def main(folder: Path | None = None) -> None:
    """One call for all loads: fields of the drive may be arrays."""
    motor = ts.load_motor("trum60")
    loads = np.linspace(0.0, 1.0, 6)
    for start, lead in plots.READINGS:
        point = ts.evaluate(motor, ts.Drive(load_torque=loads, start=start, phase_lead=lead))
        speeds = "  ".join(f"{speed / ARCSEC:10.0f}" for speed in np.asarray(point.mean_speed))
        print(f"{start:<8} {lead:+d}  {speeds}  arcsec/s at 0 to 1 N m")
    if folder is not None:
        plots.save(plots.torque_speed(motor), folder / "torque-speed.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
