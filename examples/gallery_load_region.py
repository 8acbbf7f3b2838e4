"""Where friction and the load's inertia give the mean speed and the volatility that were measured.

    python examples/gallery_load_region.py [FOLDER]

Prints friction and volatility by inertia, contact radius as assumed; with a folder, also draws load-region.svg there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym import plots
from trum_sym.paper.region import region


def main(folder: Path | None = None) -> None:
    """From rest with phase lead -1, the reading nearest to Table 4's determinants."""
    motor = ts.load_motor("trum60")
    found = region(motor, "rest", -1.0, 0.0, np.array([9.2e-4, 4e-3]), np.array([0.0265]))
    for inertia, friction, volatility in zip(found.inertia, found.friction[0], found.volatility[0], strict=True):
        print(f"{inertia:.1e} kg m^2: friction {friction:.4f}, sigma_s {100 * volatility:.1f} %")
    if folder is not None:
        plots.save(plots.load_region(motor), folder / "load-region.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
