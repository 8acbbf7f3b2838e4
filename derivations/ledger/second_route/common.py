"""The register of second routes, and what several of them use."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger import witness
from derivations.ledger.witness import Array, Drive, Sampled, peak, resonance, stator

__all__ = [
    "SECOND_ROUTES",
    "STARTS",
    "at_table_3",
    "beam_of",
    "hertz_of",
    "rate_of",
    "region_ends",
    "route",
    "whole_cycle",
    "within_region",
]

Route = Callable[[], Iterable[Any]]
SECOND_ROUTES: dict[str, Route] = {}
"""Entry -> figures of its effect, in the order of their computation."""
STARTS = ("periodic", "steady", "rest")


def route(*names: str) -> Callable[[Route], Route]:
    """Enter a function as the second route of some entries."""

    def keep(route: Route) -> Route:
        SECOND_ROUTES.update(dict.fromkeys(names, route))
        return route

    return keep


@cache
def at_table_3(name: str) -> float:
    """A value at Table 3's point."""
    return float(stator()[name])


@cache
def rate_of(name: str) -> float:
    """omega_n, omega_q, omega_d, or the drive's less the resonance's."""
    own, drive = 2 * math.pi * at_table_3("f_n"), 2 * math.pi * at_table_3("f_q")
    return {"n": own, "q": drive, "d": own * math.sqrt(1 - at_table_3("xi") ** 2), "delta": drive - own}[name]


def whole_cycle(quantity: Callable[[Sampled], Array], start: str, largest: bool) -> float:
    """The largest or smallest value of a cycle, looked for region by region."""
    drive, ends = Drive(start), region_ends()
    found = [peak(quantity, drive, low, high, largest) for low, high in pairwise(ends)]
    return max(found) if largest else min(found)


@cache
def region_ends() -> list[float]:
    """When the regions of a cycle begin and end, in s."""
    return [pulses / at_table_3("f_q") for pulses in (0, 6, 12, 20)]


def within_region(index: int, quantity: Callable[[Sampled], Array]) -> float:
    """The largest magnitude in a region after a steady start; the edges belong to it."""
    low, high = region_ends()[index], region_ends()[index + 1]
    tiny = 1e-9 * (high - low)
    return peak(lambda s: np.abs(quantity(s)), Drive("steady"), low + tiny, high - tiny)


def beam_of(**changed: Any) -> dict[str, mp.mpf]:  # noqa: ANN401
    """The witness's section, some of its values changed."""
    return witness.beam(**changed)


def hertz_of(b: Any, k: Any = None, k_f: Any = None) -> mp.mpf:  # noqa: ANN401
    """The lower resonance of a section, in Hz."""
    v = stator()
    return mp.re(resonance(b, v["k_c"] if k is None else k, v["k_f"] if k_f is None else k_f)[0])
