"""What the paper publishes of drives and measurements, once: ranges, tables, the encoder."""

from __future__ import annotations

import numpy as np

__all__ = ["BOX", "ENCODER", "TABLE_2", "TABLE_5"]

BOX: dict[str, tuple[float, float]] = {
    "prepressure": (160.0, 210.0),
    "frequency_difference": (2800.0, 3300.0),
}
"""Sect. 9's ranges of prepressure (N) and frequency difference (Hz)."""

ENCODER = 2e-3
"""Sampling period of the encoder of Sect. 8.2, s."""

TABLE_2 = {100.0: 8.3e-6, 120.0: 7.3e-6, 140.0: 6.6e-6, 160.0: 6.0e-6, 180.0: 5.5e-6, 200.0: 5.2e-6, 220.0: 4.8e-6}
"""Table 2: measured amplitude of a phase (m) by prepressure (N)."""

TABLE_5 = {
    "prepressure": np.array([180.0, 170.0, 160.0, 190.0, 200.0, 210.0]),
    "frequency_difference": np.array([3300.0, 3100.0, 3000.0, 2800.0, 2900.0, 3200.0]),
}
"""Table 5: six drives (N, Hz); the differences are printed in rad/s and of the size of Hz."""
