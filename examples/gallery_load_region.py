"""Where friction and the load's inertia give the mean speed and the volatility that were measured.

    python examples/gallery_load_region.py [FOLDER]

Prints friction and volatility by inertia, contact radius as assumed, with the friction layer giving way alone and with
the rotor's flange; with a folder, also draws load-region.svg there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym import plots
from trum_sym.model.levels import COMPLIANCES
from trum_sym.paper.region import region


def main(folder: Path | None = None) -> None:
    """From rest with phase lead -1, the reading nearest to Table 4's determinants."""
    motor = ts.load_motor("trum60")
    for compliance in COMPLIANCES:
        found = region(motor, "rest", -1.0, 0.0, np.array([1e-4, 9.2e-4, 4e-3]), np.array([0.0265]), compliance)
        for inertia, friction, width, volatility in zip(
            found.inertia, found.friction[0], found.width[0], found.volatility[0], strict=True
        ):
            print(
                f"{compliance:<6}  {inertia:.1e} kg m^2: friction {friction:.4f}, within {100 * width:.2g} %, "
                f"sigma_s {100 * volatility:.3g} %"
            )
    if folder is not None:
        plots.save(plots.load_region(motor), folder / "load-region.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
