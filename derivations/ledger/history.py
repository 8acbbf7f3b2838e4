"""Both phases over one drive cycle at Table 3, sampled: what the ledger measures effects on.

From the derived region solutions alone, in double precision; midpoints of equal steps, so that sums over
the samples are integrals over the cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derivations import phases
from derivations.ledger.operating import operating_point

__all__ = ["STARTS", "Array", "History", "Start", "history", "moments", "numeric", "region_edges", "values"]

Array = NDArray[np.float64]
Start = Literal["periodic", "steady", "rest"]
STARTS: tuple[Start, ...] = ("periodic", "steady", "rest")


@cache
def numeric(expr: sp.Basic, symbols: tuple[sp.Symbol, ...]) -> Callable[..., Any]:
    """The expression as a NumPy function of the symbols."""
    function: Callable[..., Any] = sp.lambdify(symbols, expr, modules=[{"expm1": np.expm1}, "numpy"])
    return function


def _number(expr: sp.Basic, known: Mapping[str, Any]) -> Any:  # noqa: ANN401
    expr = sp.sympify(expr)
    symbols = tuple(sorted(expr.free_symbols, key=lambda symbol: symbol.name))
    return numeric(expr, symbols)(*(known[symbol.name] for symbol in symbols))


def values(**changed: float) -> dict[str, float]:
    """Table 3's values as floats by symbol name, phase lead +1 and switching phase 0 unless changed."""
    point = {name: float(value) for name, value in operating_point().items()}
    point = {**point, "s": 1.0, "psi": 0.0, **changed}
    point["omega_q"] = _number(phases.drive_frequency(), point)
    point["T"] = _number(phases.cycle_time(), point)
    return point


@dataclass(frozen=True, eq=False)  # hashed by identity, for caches
class History:
    """Displacements and velocities over one cycle, SI; ``region`` is 0, 1, 2, ``step`` in s."""

    time: Array
    w_A: Array
    w_B: Array
    v_A: Array
    v_B: Array
    region: NDArray[np.int64]
    step: float

    @property
    def W_c(self) -> Array:
        """Displacement of the crest."""
        return np.hypot(self.w_A, self.w_B)

    @property
    def q(self) -> Array:
        """w_A' w_B - w_B' w_A, the determinant over D k_c."""
        return self.v_A * self.w_B - self.v_B * self.w_A

    @property
    def W_c_rate(self) -> Array:
        """Rate of the crest's displacement."""
        return (self.w_A * self.v_A + self.w_B * self.v_B) / self.W_c


_BEFORE: dict[str, Callable[[str], phases.State]] = {
    "periodic": phases.periodic_start,
    "rest": phases.rest_start,
    "steady": lambda _: (sp.S.Zero, sp.S.Zero),
}


@cache
def region_edges(m: float = 20.0, n: float = 14.0) -> tuple[float, ...]:
    """t_1 to t_4 of a cycle that begins at 0."""
    known = values(m=m, n=n)
    return tuple(np.concatenate([[0.0], np.cumsum([_number(time, known) for time in phases.region_times()])]).tolist())


@cache
def _coefficients(start: Start, m: float, n: float) -> dict[str, float]:
    """Displacement and velocity from which each phase moves freely, by symbol name and region."""
    known, found = values(m=m, n=n), {}
    for phase in phases.PHASES:
        w_0, v_0 = (sp.Float(_number(value, known)) for value in _BEFORE[start](phase))
        for index, state in enumerate(phases.propagate_cycle(phase, (w_0, v_0))[:3]):
            for letter, value in zip("ab", state, strict=True):
                found[f"{letter}_{phase} {index}"] = float(_number(value, known))
    return found


def moments(start: Start, time: Array, m: float = 20.0, n: float = 14.0) -> History:
    """Both phases at any times of a cycle from a start, at Table 3 but for the pulse counts; ``step`` is 0."""
    known: dict[str, Any] = values(m=m, n=n)
    edges, free = np.array(region_edges(m, n)), _coefficients(start, m, n)
    region = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, 2)
    columns: dict[str, Array] = {}
    for phase in phases.PHASES:
        displacement, velocity, _ = phases.response(phase)
        w, rate = np.empty(time.size), np.empty(time.size)
        for index, gate in enumerate(phases.GATES[phase]):
            here = region == index
            if not here.any():
                continue
            given: dict[str, Any] = {"tau": time[here] - edges[index], f"g_{phase}": float(gate)}
            given |= {f"{letter}_{phase}": free[f"{letter}_{phase} {index}"] for letter in "ab"}
            w[here] = _number(displacement, {**known, **given})
            rate[here] = _number(velocity, {**known, **given})
        columns[f"w_{phase}"], columns[f"v_{phase}"] = w, rate
    return History(time=time, region=region, step=0.0, **columns)


@cache
def history(start: Start = "periodic", samples: int = 20000, m: float = 20.0, n: float = 14.0) -> History:
    """One drive cycle from a start, at Table 3 but for the pulse counts m and n, at midpoints of equal steps."""
    step = region_edges(m, n)[-1] / samples
    time: Array = (np.arange(samples, dtype=np.float64) + 0.5) * step
    return replace(moments(start, time, m, n), step=step)
