"""The calmest operating point that creeps at 633 arcsec/s, and where it lies on the map.

    python examples/gallery_optimize.py [FOLDER]

Prints the optimum; with a folder, also draws optimum.svg there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import trum_sym as ts
from trum_sym import plots
from trum_sym.inputs.units import ARCSEC


def main(folder: Path | None = None) -> None:
    """Least volatility in the paper's box at Table 4's mean speed and Table 3's load."""
    motor = ts.load_motor("trum60")
    best = ts.optimize(motor, objective="volatility", target_speed="633 arcsec/s")
    print(f"{best.status}: {best.message}")
    if best.status != "solved":
        return
    print(f"{best.prepressure:.2f} N, {best.frequency_difference:.2f} Hz")
    print(f"v_s {best.mean_speed / ARCSEC:.1f} arcsec/s, Q_aver {best.q_average:.1f} 1/s")
    if folder is not None:
        figure = plots.maps(motor)
        for axes in figure.axes[:6]:
            axes.plot(best.frequency_difference, best.prepressure, "o", color="white", markeredgecolor="black")
        plots.save(figure, folder / "optimum.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
