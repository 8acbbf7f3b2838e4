"""SymPy expressions as CasADi expressions, operation by operation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import add, mul
from typing import TypeAlias

import casadi as ca
import sympy as sp

__all__ = ["to_casadi"]

Walk: TypeAlias = Callable[[sp.Basic], ca.SX]

_ELEMENTARY: dict[type, Callable[..., ca.SX]] = {
    sp.sin: ca.sin,
    sp.cos: ca.cos,
    sp.exp: ca.exp,
    sp.sinh: ca.sinh,
    sp.cosh: ca.cosh,
    sp.atan: ca.atan,
    sp.atan2: ca.atan2,
    sp.Abs: ca.fabs,
}


def to_casadi(expr: sp.Expr, symbols: Mapping[sp.Symbol, ca.SX], memo: dict[sp.Basic, ca.SX]) -> ca.SX:
    """Translate an expression; equal subexpressions become one node through ``memo``.

    Arguments of sums and products are taken in ``sympy.ordered`` order, so the result does not depend
    on hashing.

    Raises
    ------
    NotImplementedError
        For a function that no kernel has needed so far.
    """
    if expr in memo:
        return memo[expr]
    memo[expr] = result = _translate(expr, symbols, memo)
    return result


def _translate(expr: sp.Expr, symbols: Mapping[sp.Symbol, ca.SX], memo: dict[sp.Basic, ca.SX]) -> ca.SX:
    def walk(part: sp.Basic) -> ca.SX:
        return to_casadi(part, symbols, memo)

    if isinstance(expr, sp.Symbol):
        return symbols[expr]
    if expr.is_number and not expr.has(sp.Function):
        return ca.SX(float(expr.evalf(40)))
    if isinstance(expr, sp.Add):
        return _signed_sum(expr, walk)
    if isinstance(expr, sp.Mul):
        numerator, denominator = sp.fraction(expr, exact=True)
        if denominator != 1:
            return walk(numerator) / walk(denominator)
        coefficient, rest = expr.as_coeff_Mul()
        if coefficient == -1:
            return -walk(rest)
        return reduce(mul, (walk(factor) for factor in sp.ordered(expr.args)))
    if isinstance(expr, sp.Pow):
        return _power(walk(expr.base), expr.exp, walk)
    if type(expr) in _ELEMENTARY:
        return ca.SX(_ELEMENTARY[type(expr)](*(walk(argument) for argument in expr.args)))
    if expr.is_Function and expr.func.__name__ == "expm1":
        return ca.expm1(walk(expr.args[0]))
    if isinstance(expr, sp.Min | sp.Max):
        pick = ca.fmin if isinstance(expr, sp.Min) else ca.fmax
        return reduce(pick, (walk(argument) for argument in sp.ordered(expr.args)))
    if expr.is_Function and expr.func.__name__ == "less":
        return ca.SX(walk(expr.args[0]) < walk(expr.args[1]))
    raise NotImplementedError(f"no C operation for {type(expr).__name__} in {expr}")


def _signed_sum(expr: sp.Add, walk: Walk) -> ca.SX:
    """A sum with its positive terms first, so that negative ones become subtractions."""
    terms = list(sp.ordered(expr.args))
    plus = [term for term in terms if not term.could_extract_minus_sign()]
    minus = [-term for term in terms if term.could_extract_minus_sign()]
    if not plus:
        return -reduce(add, (walk(term) for term in minus))
    total = reduce(add, (walk(term) for term in plus))
    for term in minus:
        total = total - walk(term)
    return total


def _power(base: ca.SX, exponent: sp.Expr, walk: Walk) -> ca.SX:
    if exponent.is_Integer:
        return base ** int(exponent) if exponent > 0 else 1 / base ** int(-exponent)
    if exponent.is_Rational and exponent.q == 2:
        root = ca.sqrt(base)
        whole = abs(int(exponent.p)) // 2
        value = root if whole == 0 else base**whole * root
        return value if exponent > 0 else 1 / value
    return ca.power(base, walk(exponent))
