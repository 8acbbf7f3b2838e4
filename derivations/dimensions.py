"""Dimension analysis: walk an expression and carry the SI exponents along."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import sympy as sp

from derivations.nomenclature import NOMENCLATURE, TINY
from trum_sym.units import Dimension

__all__ = ["DimensionError", "dimension"]

_NONE = Dimension()
_SAME_AS_ARGUMENTS = (sp.Add, sp.Abs, sp.Min, sp.Max)


class DimensionError(ValueError):
    """Terms of different dimension are added, or a function's argument is not a number."""


def dimension(expr: sp.Basic, known: Mapping[sp.Basic, Dimension] | None = None) -> Dimension:
    """The dimension of an expression.

    Parameters
    ----------
    expr : sympy.Basic
        Sums, products, powers, elementary functions of the nomenclature's symbols.
    known : mapping, optional
        Dimensions of further symbols or subexpressions.

    Raises
    ------
    DimensionError
        Where the expression is dimensionally inconsistent; names the terms.
    """
    if known and expr in known:
        return known[expr]
    if isinstance(expr, sp.Symbol) and expr != TINY:
        return NOMENCLATURE[expr.name].dimension
    if expr.is_number:
        return _NONE
    if expr == TINY:
        return _NONE
    if isinstance(expr, sp.Add) and TINY in expr.args:
        return dimension(expr - TINY, known)
    of_arguments = [dimension(argument, known) for argument in expr.args]
    if isinstance(expr, sp.Mul):
        product = _NONE
        for factor in of_arguments:
            product = product.times(factor)
        return product
    if isinstance(expr, sp.Pow):
        base, exponent = of_arguments
        if isinstance(expr.exp, sp.Rational):
            return base.power(Fraction(int(expr.exp.p), int(expr.exp.q)))
        if base == exponent == _NONE:
            return _NONE
        raise DimensionError(f"power of {expr.base} [{base}] to {expr.exp} [{exponent}]")
    comparison = isinstance(expr, sp.atan2) or expr.func.__name__ == "less"
    if comparison or isinstance(expr, _SAME_AS_ARGUMENTS):
        for term, found in zip(expr.args, of_arguments, strict=True):
            if found != of_arguments[0]:
                raise DimensionError(
                    f"{expr.args[0]} [{of_arguments[0]}] and {term} [{found}] meet in one {type(expr).__name__}"
                )
        return _NONE if comparison else of_arguments[0]
    for argument, found in zip(expr.args, of_arguments, strict=True):
        if found != _NONE:
            raise DimensionError(f"argument {argument} [{found}] of {type(expr).__name__} is not a number")
    return _NONE
