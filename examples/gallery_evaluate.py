"""One operating point and what happens in it: the two phases over a drive cycle.

    python examples/gallery_evaluate.py [FOLDER]

Prints the point; with a folder, also draws phases.svg there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import trum_sym as ts
from trum_sym import plots
from trum_sym.inputs.units import ARCSEC


def main(folder: Path | None = None) -> None:
    """Evaluate Table 3's drive, print it, draw it."""
    motor = ts.load_motor("trum60")
    drive = ts.Drive(prepressure=180.0, frequency_difference=3000.0, periods=20, on_periods=14, load_torque=0.1)
    point = ts.evaluate(motor, drive)
    print(f"resonance   {point.resonance_frequency:10.1f} Hz")
    print(f"Q_aver      {point.q_average:10.1f} 1/s")
    print(f"mean speed  {point.mean_speed / ARCSEC:10.0f} arcsec/s")
    print(f"stall       {point.stall_torque:10.4f} N m")
    if folder is not None:
        plots.save(plots.phase_responses(motor, drive), folder / "phases.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
