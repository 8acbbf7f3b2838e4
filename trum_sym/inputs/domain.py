"""What values a quantity may have.  Nothing here needs NumPy until a domain is asked about values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

__all__ = ["Domain", "Spec"]


@dataclass(frozen=True)
class Domain:
    """An interval, open or closed at each end, of the reals or of the integers."""

    low: float = -math.inf
    high: float = math.inf
    low_open: bool = True
    high_open: bool = True
    integer: bool = False

    def describe(self, unit: str) -> str:
        """The domain in words, with its unit."""
        kind = "an integer" if self.integer else "a finite number"
        bounds = []
        if math.isfinite(self.low):
            bounds.append(f"{'>' if self.low_open else '>='} {self.low:g}")
        if math.isfinite(self.high):
            bounds.append(f"{'<' if self.high_open else '<='} {self.high:g}")
        where = " " + " and ".join(bounds) if bounds else ""
        return f"{kind}{where}" + (f" in {unit}" if unit != "1" else "")

    def contains(self, values: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Element by element: is the value finite and inside?"""
        import numpy as np

        inside = np.isfinite(values)
        inside &= values > self.low if self.low_open else values >= self.low
        inside &= values < self.high if self.high_open else values <= self.high
        if self.integer:
            inside &= values == np.floor(values)
        return inside


@dataclass(frozen=True)
class Spec:
    """What a parameter must be: SI unit, symbol, domain, and whether a motor file must give it."""

    unit: str
    symbol: str
    domain: Domain
    required: bool
