"""The forced amplitude over the frequency difference, beside the measured one.

python examples/forced_amplitude.py
"""

from __future__ import annotations

import numpy as np
from tabulate import tabulate

import trum_sym as ts


def main() -> None:
    """Print the table."""
    motor = ts.load_motor("trum60")
    drive = ts.Drive(frequency_difference=np.array([-3000.0, -1000.0, 0.0, 100.0, 1000.0, 3000.0]))
    forced, measured = (ts.evaluate(motor, drive, amplitude=level) for level in ("forced", "measured"))
    rows = zip(
        drive.frequency_difference,
        1e6 * forced.amplitude,
        forced.resonance_frequency,
        1e6 * measured.amplitude,
        measured.resonance_frequency,
        strict=True,
    )
    headers = ("df Hz", "forced µm", "its f_n Hz", "measured µm", "its f_n Hz")
    print(tabulate(rows, headers, floatfmt=("+.0f", ".3f", ".1f", ".3f", ".1f")))


if __name__ == "__main__":
    main()
