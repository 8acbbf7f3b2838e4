"""Shares, means and extremes over a drive cycle: by roots of what is asked and quadrature between them.

A share of time is the length between the sign changes of a function, found by scanning and bisection; an
integral is Gauss and Legendre's on panels that end where the integrand has a kink, doubled until it stands
still; an extreme is the best of a scan, narrowed down.  Nothing hangs on how many instants were looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from derivations.ledger.history import Array, History, Start, moments, region_edges

__all__ = ["Lap", "Quantity", "extremes", "integral", "mean", "root_mean_square", "share", "shares", "zeros"]

Quantity = Callable[[History], Array]
"""A function of time, through the phases' displacements and velocities."""
_SCAN = 16000  # instants at which sign changes and extremes are looked for
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Lap:
    """One drive cycle at Table 3 from a start, or a stretch of it; ``m`` and ``n`` are its pulses.

    ``low`` and ``high`` bound the stretch, in s from t_1; the whole cycle without them.
    """

    start: Start = "periodic"
    m: float = 20.0
    n: float = 14.0
    low: float | None = None
    high: float | None = None

    def region(self, index: int) -> Lap:
        """T_redu, T_addredu or T_add of it."""
        edges = region_edges(self.m, self.n)
        return replace(self, low=edges[index], high=edges[index + 1])

    @property
    def spans(self) -> list[tuple[float, float]]:
        """The stretch, cut where a phase is switched."""
        edges = region_edges(self.m, self.n)
        low = edges[0] if self.low is None else self.low
        high = edges[-1] if self.high is None else self.high
        inner = [edge for edge in edges[1:-1] if low < edge < high]
        ends = [low, *inner, high]
        return list(pairwise(ends))

    @property
    def length(self) -> float:
        """How long the stretch lasts, s."""
        return sum(high - low for low, high in self.spans)

    def at(self, time: Array) -> History:
        """Both phases at some times."""
        return moments(self.start, time, self.m, self.n)


@cache
def _scan(lap: Lap, span: tuple[float, float]) -> tuple[Array, History]:
    count = max(1000, round(_SCAN * (span[1] - span[0]) / lap.length))
    time: Array = np.linspace(*span, count + 1)
    return time, lap.at(time)


def _roots(quantity: Quantity, lap: Lap, span: tuple[float, float]) -> Array:
    time, states = _scan(lap, span)
    positive = quantity(states) > 0
    (at,) = np.nonzero(positive[1:] != positive[:-1])
    low, high, left = time[at], time[at + 1], positive[at]
    if not at.size:
        return low
    for _ in range(60):
        middle = (low + high) / 2
        same = (quantity(lap.at(middle)) > 0) == left
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    root: Array = (low + high) / 2
    return root


def zeros(quantity: Quantity, lap: Lap) -> Array:
    """Times at which a quantity changes its sign."""
    return np.concatenate([_roots(quantity, lap, span) for span in lap.spans])


def share(quantity: Quantity, lap: Lap) -> float:
    """The share of the time during which a quantity is positive."""
    total = 0.0
    for low, high in lap.spans:
        cuts = np.concatenate([[low], _roots(quantity, lap, (low, high)), [high]])
        inside = quantity(lap.at((cuts[1:] + cuts[:-1]) / 2)) > 0
        total += float(np.diff(cuts)[inside].sum())
    return total / lap.length


def shares(kind: Callable[[History], list[str]], lap: Lap, cuts: Iterable[Quantity]) -> dict[str, float]:
    """The shares of the time during which a state is of each kind, most frequent first.

    A kind may change only where one of ``cuts`` changes its sign.
    """
    found: dict[str, float] = {}
    quantities = list(cuts)
    for span in lap.spans:
        roots = [_roots(quantity, lap, span) for quantity in quantities]
        ends = np.unique(np.concatenate([np.array(span), *roots]))
        ends = ends[np.r_[True, np.diff(ends) > 1e-15]]
        for name, length in zip(kind(lap.at((ends[1:] + ends[:-1]) / 2)), np.diff(ends), strict=True):
            found[name] = found.get(name, 0.0) + float(length)
    ordered = sorted(found.items(), key=lambda item: -item[1])
    return {name: length / lap.length for name, length in ordered}


def _on_panels(quantity: Quantity, lap: Lap, cuts: Array, panels: int) -> tuple[float, float]:
    """The integral of a quantity and that of its magnitude."""
    total = size = 0.0
    for low, high in lap.spans:
        inside = cuts[(cuts > low) & (cuts < high)]
        ends = np.unique(np.concatenate([np.linspace(low, high, panels + 1), inside]))
        half = np.diff(ends) / 2
        time = ((ends[1:] + ends[:-1]) / 2)[:, None] + half[:, None] * _NODES
        values = quantity(lap.at(time.ravel())).reshape(time.shape)
        total += float((half * (values @ _WEIGHTS)).sum())
        size += float((half * (np.abs(values) @ _WEIGHTS)).sum())
    return total, size


def integral(quantity: Quantity, lap: Lap, kinks: Iterable[Quantity] = ()) -> float:
    """The integral over a stretch, by ever more panels.

    Parameters
    ----------
    quantity : callable
        The integrand.
    lap : Lap
        The cycle, or the stretch of it.
    kinks : callables
        The integrand may have a kink or a jump where one of these changes its sign.

    Raises
    ------
    ArithmeticError
        If more panels keep changing the integral.
    """
    cuts = np.sort(np.concatenate([np.empty(0), *(zeros(kink, lap) for kink in kinks)]))
    before, _ = _on_panels(quantity, lap, cuts, 32)
    change = np.inf
    for doubling in range(1, 10):
        after, size = _on_panels(quantity, lap, cuts, 32 * 2**doubling)
        change = abs(after - before) / size if size else 0.0
        if change <= 1e-9:
            return after
        before = after
    raise ArithmeticError(f"an integral over the cycle still changes by {change:.1e} of its size")


def mean(quantity: Quantity, lap: Lap, kinks: Iterable[Quantity] = ()) -> float:
    """The mean over a stretch; arguments as :func:`integral` has them."""
    return integral(quantity, lap, kinks) / lap.length


def root_mean_square(quantity: Quantity, lap: Lap, kinks: Iterable[Quantity] = ()) -> float:
    """The root of the mean square over a stretch."""
    return float(np.sqrt(mean(lambda h: quantity(h) ** 2, lap, kinks)))


def extremes(quantity: Quantity, lap: Lap) -> tuple[float, float]:
    """The smallest and the largest value during a stretch."""
    found = []
    for sign in (-1.0, 1.0):
        best = -np.inf
        for span in lap.spans:
            time, states = _scan(lap, span)
            values = sign * quantity(states)
            beside = np.maximum(np.r_[-np.inf, values[:-1]], np.r_[values[1:], -np.inf])
            (at,) = np.nonzero(values >= beside)
            at = at[np.argsort(values[at])[-12:]].astype(np.int64)
            best = max(best, float(values.max()), _narrowed(quantity, lap, sign, time, at))
        found.append(sign * best)
    return found[0], found[1]


def _narrowed(quantity: Quantity, lap: Lap, sign: float, time: Array, at: NDArray[np.int64]) -> float:
    """The largest value around some instants of a scan, by thirds."""
    low, high = time[np.maximum(at - 1, 0)], time[np.minimum(at + 1, time.size - 1)]
    for _ in range(70):
        one, two = low + (high - low) / 3, high - (high - low) / 3
        rising = sign * quantity(lap.at(one)) < sign * quantity(lap.at(two))
        low, high = np.where(rising, one, low), np.where(rising, high, two)
    return float((sign * quantity(lap.at((low + high) / 2))).max())
