"""One operating point and what happens in it: phases, direction of the wave and rotor over a drive cycle.

    python examples/gallery_evaluate.py [FOLDER]

Prints the point; with a folder, also draws pulses.svg there.
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
        panels = plots.blank(4, 1, height=7.4, sharex=True)
        plots.phase_responses(motor, drive, axes=panels[:2])
        plots.forward_and_backward(motor, drive, axes=panels[2])
        plots.instantaneous_speed(motor, drive, axes=panels[3])
        panels[2].set_title("which way the wave runs", loc="right", fontsize=9)
        panels[3].set_title("the rotor follows; its mean is small", loc="right", fontsize=9)
        panels[3].set_xlim(0.0, 1e3 * float(point.cycle_time))
        for axes in panels:
            axes.label_outer()
        plots.save(panels[0].figure, folder / "pulses.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
