"""From what inertia of the load on the rotor follows the determinants, and what then meets Table 4."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import STARTS
from trum_sym.paper.findings import Context, rank_correlation
from trum_sym.paper.readings import LEADS, LOAD_INERTIA, POINTS

__all__ = ["FOLLOWS", "PAIRS", "VARIABLES", "Trend", "inertias", "trends"]

FOLLOWS = 0.9
"""Rank correlation from which one curve is said to follow another."""
PAIRS = {
    "v_s": ("mean_speed", "q_average"),
    "encoder's sigma_s": ("encoder_volatility", "q_volatility"),
    "speed's sigma_s": ("speed_volatility", "q_volatility"),
}
"""What is compared with what: the mean speed with Q_aver, the volatility that the encoder reads, or that of the speed
itself, with Q_vib."""
VARIABLES = {"df": POINTS.figure_21, "F_c": POINTS.figure_23}
"""2800 to 3300 Hz at 180 N, and 160 to 210 N at 3000 Hz, six drives each."""


def inertias() -> Array:
    """Load's inertias, kg m^2: none, then seven a decade to the greatest of ``LOAD_INERTIA``, which are among them."""
    return np.unique([*LOAD_INERTIA, *np.geomspace(1e-6, LOAD_INERTIA[-1], 26)])


@dataclass(frozen=True)
class Trend:
    """How a speed follows a determinant in one reading, at the default level, as the load's inertia grows.

    Attributes
    ----------
    start, lead : of the reading; A is at its crest at t1
    variable, pair : of ``VARIABLES`` and ``PAIRS``
    correlation : rank correlations at :func:`inertias`
    """

    start: str
    lead: float
    variable: str
    pair: str
    correlation: Array

    @property
    def at_ends(self) -> tuple[float, ...]:
        """The correlation at each of ``LOAD_INERTIA``."""
        return tuple(float(self.correlation[inertias() == value][0]) for value in LOAD_INERTIA)

    @property
    def follows_from(self) -> float | None:
        """The least inertia from which on it is at least ``FOLLOWS`` up to the greatest; None if it is not there."""
        fails = np.flatnonzero(~(self.correlation >= FOLLOWS))
        first = int(fails[-1]) + 1 if fails.size else 0
        return float(inertias()[first]) if first < self.correlation.size else None


def trends(context: Context) -> list[Trend]:
    """All of them: by reading, variable and pair."""
    points = [*VARIABLES.values()]
    which = np.concatenate([np.arange(part.start, part.stop) for part in points])
    found = context.loaded(
        context.motor, POINTS.prepressure[which], POINTS.difference[which], inertias(), phases=(0.0,)
    )
    rows = []
    for i, start in enumerate(STARTS):
        for j, lead in enumerate(LEADS):
            for k, variable in enumerate(VARIABLES):
                part = slice(6 * k, 6 * k + 6)
                for pair, (speed, determinant) in PAIRS.items():
                    a, b = (found[name][:, i, j, 0, part] for name in (speed, determinant))
                    rows.append(Trend(start, lead, variable, pair, rank_correlation(a, b)))
    return rows
