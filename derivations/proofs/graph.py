"""Expressions as a graph of their distinct parts, evaluated with many digits; one part can be replaced."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import add, mul

import mpmath as mp
import sympy as sp

from derivations.proofs.maths import Number

__all__ = ["Graph", "Replaced"]

Values = list[Number]
Replaced = Mapping[int, sp.Basic]
"""Expressions, of the graph's own parts, that stand in for some of them."""


def _angle(y: Number, x: Number) -> Number:
    if isinstance(y, mp.mpc) or isinstance(x, mp.mpc):
        raise ValueError("the angle of complex numbers")
    return mp.atan2(y, x)


_FUNCTIONS: dict[str, Callable[..., Number]] = {
    "sin": mp.sin,
    "cos": mp.cos,
    "exp": mp.exp,
    "sinh": mp.sinh,
    "cosh": mp.cosh,
    "atan": mp.atan,
    "atan2": _angle,
    "Abs": abs,
    "expm1": mp.expm1,
    "Min": min,
    "Max": max,
    "less": lambda x, y: mp.mpf(x < y),
}


def _number(expr: sp.Basic) -> Number:
    if isinstance(expr, sp.Float):
        return mp.make_mpf(expr._mpf_)
    if isinstance(expr, sp.Rational):
        return mp.mpf(int(expr.p)) / int(expr.q)
    if expr == sp.pi:
        return +mp.pi
    raise NotImplementedError(f"no number for {expr}")


def _apply(expr: sp.Basic, of: list[Number]) -> Number:
    """The value of an expression whose arguments have these values."""
    if isinstance(expr, sp.Add):
        return reduce(add, of)
    if isinstance(expr, sp.Mul):
        return reduce(mul, of)
    if isinstance(expr, sp.Pow):
        base, exponent = of
        if isinstance(expr.exp, sp.Integer):
            return base ** int(expr.exp)
        if expr.exp == sp.Rational(1, 2):
            return mp.sqrt(base)
        return base**exponent
    return _FUNCTIONS[type(expr).__name__](*of)


class Graph:
    """Named expressions as one list of their parts, each after its arguments.

    Attributes
    ----------
    parts : list of sympy.Basic
        Every distinct part once.
    outputs : dict of str to int
        Where the named expressions are in it.
    """

    def __init__(self, expressions: Mapping[str, sp.Expr]) -> None:
        self.parts: list[sp.Basic] = []
        self._place: dict[sp.Basic, int] = {}
        self.outputs = {name: self._add(sp.sympify(expr)) for name, expr in expressions.items()}
        self._above: list[set[int]] = [set() for _ in self.parts]
        for i, part in enumerate(self.parts):
            for argument in part.args:
                self._above[self._place[argument]].add(i)

    def _add(self, expr: sp.Basic) -> int:
        if expr not in self._place:
            for argument in expr.args:
                self._add(argument)
            self._place[expr] = len(self.parts)
            self.parts.append(expr)
        return self._place[expr]

    def place(self, part: sp.Basic) -> int:
        """Where a part is in the list."""
        return self._place[part]

    def above(self, place: int) -> list[sp.Basic]:
        """The parts that have the one at a place for an argument."""
        return [self.parts[i] for i in sorted(self._above[place])]

    def affected(self, part: int) -> list[int]:
        """What is computed from a part, in order, the part itself left out."""
        found: set[int] = set()
        front = {part}
        while front:
            front = set().union(*(self._above[i] for i in front)) - found
            found |= front
        return sorted(found)

    def values(self, point: Mapping[str, Number]) -> Values:
        """Of all parts, at values of the symbols by name."""
        found: Values = []
        for part in self.parts:
            if isinstance(part, sp.Symbol):
                found.append(point[part.name])
            elif part.args:
                found.append(_apply(part, [found[self._place[a]] for a in part.args]))
            else:
                found.append(_number(part))
        return found

    def _other(self, expr: sp.Basic, values: Values, point: Mapping[str, Number]) -> Number:
        place = self._place.get(expr)
        if place is not None:
            return values[place]
        if isinstance(expr, sp.Symbol):
            return point[expr.name]
        if not expr.args:
            return _number(expr)
        return _apply(expr, [self._other(argument, values, point) for argument in expr.args])

    def changed(
        self, values: Values, point: Mapping[str, Number], part: int, new: sp.Basic, affected: list[int]
    ) -> dict[str, Number]:
        """The outputs if one part were ``new``, an expression of parts; ``affected`` is that of the part."""
        moved: dict[int, Number] = {part: self._other(new, values, point)}
        if moved[part] != values[part]:
            for i in affected:
                arguments = [self._place[a] for a in self.parts[i].args]
                moved[i] = _apply(self.parts[i], [moved.get(k, values[k]) for k in arguments])
        return {name: moved.get(i, values[i]) for name, i in self.outputs.items()}
