"""Arithmetic in which a statement can be written once, for 50-digit numbers and for symbols."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any, Protocol, TypeAlias

import mpmath as mp
import sympy as sp

__all__ = ["DIGITS", "NUMBERS", "SYMBOLS", "Maths", "Number", "Point"]

DIGITS = 75
"""Digits that proofs compute with: 50 to be compared, the rest to be lost in sums that cancel."""

Number: TypeAlias = Any
"""A 50-digit number, or an expression."""


class Point:
    """Values of a kernel's arguments by their names: ``p.omega_n``."""

    def __init__(self, values: Mapping[str, Number]) -> None:
        self.values: dict[str, Number] = dict(values)

    def __getattr__(self, name: str) -> Number:
        try:
            return self.__dict__["values"][name]
        except KeyError:
            raise AttributeError(f"the point has no {name}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.values)

    def with_(self, **changed: Number) -> Point:
        """The point with some values changed."""
        return Point({**self.values, **changed})


class Maths(Protocol):
    """The functions that a statement may use."""

    @property
    def pi(self) -> Number: ...  # noqa: D102

    def sqrt(self, x: Number) -> Number: ...  # noqa: D102
    def sin(self, x: Number) -> Number: ...  # noqa: D102
    def cos(self, x: Number) -> Number: ...  # noqa: D102
    def exp(self, x: Number) -> Number: ...  # noqa: D102
    def log(self, x: Number) -> Number: ...  # noqa: D102
    def absolute(self, x: Number) -> Number: ...  # noqa: D102
    def integral(self, function: Callable[[Number], Number], low: Number, high: Number) -> Number: ...  # noqa: D102
    def derivative(self, function: Callable[[Number], Number], at: Number) -> Number: ...  # noqa: D102


@cache
def _gauss(digits: int, count: int = 48) -> tuple[tuple[Number, Number], ...]:
    """Gauss-Legendre nodes and weights on [-1, 1]: roots by Newton, weights from the derivative."""
    found = []
    with mp.workdps(digits):
        for i in range(count):
            x = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (count + mp.mpf(1) / 2))
            for _ in range(8):
                before, value = mp.mpf(1), x
                for k in range(2, count + 1):
                    before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
                slope = count * (x * value - before) / (x * x - 1)
                x -= value / slope
            found.append((x, 2 / ((1 - x * x) * slope**2)))
    return tuple(found)


class _Numbers:
    """With mpmath."""

    @property
    def pi(self) -> Number:
        return +mp.pi

    sqrt, sin, cos, exp, log = (staticmethod(f) for f in (mp.sqrt, mp.sin, mp.cos, mp.exp, mp.log))
    absolute = staticmethod(abs)

    def integral(self, function: Callable[[Number], Number], low: Number, high: Number) -> Number:
        """Of a function that is smooth over a wave: Gauss's rule of 48 points."""
        half, middle = (high - low) / 2, (high + low) / 2
        return half * mp.fsum(weight * function(middle + half * x) for x, weight in _gauss(mp.mp.dps))

    def derivative(self, function: Callable[[Number], Number], at: Number) -> Number:
        """Central difference, with as many digits again."""
        step = mp.mpf(10) ** (-mp.mp.dps // 2) * (abs(at) or 1)
        with mp.workdps(2 * mp.mp.dps):
            return (function(at + step) - function(at - step)) / (2 * step)


class _Symbols:
    """With SymPy."""

    pi = sp.pi
    sqrt, sin, cos, exp, log = (staticmethod(f) for f in (sp.sqrt, sp.sin, sp.cos, sp.exp, sp.log))
    absolute = staticmethod(sp.Abs)

    def integral(self, function: Callable[[Number], Number], low: Number, high: Number) -> Number:
        x = sp.Dummy(real=True)
        return sp.integrate(function(x), (x, low, high))

    def derivative(self, function: Callable[[Number], Number], at: Number) -> Number:
        x = sp.Dummy(real=True)
        return function(x).diff(x).subs(x, at)


NUMBERS: Maths = _Numbers()
SYMBOLS: Maths = _Symbols()
