"""Dimension analysis: walk an expression and carry the SI exponents along."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from derivations.nomenclature import NOMENCLATURE, TINY
from trum_sym.inputs.units import Dimension

__all__ = ["DimensionError", "dimension"]

_NONE = Dimension()
_SAME_AS_ARGUMENTS = (sp.Add, sp.Abs, sp.Min, sp.Max)


class DimensionError(ValueError):
    """Terms of different dimension are added, or a function's argument is not a number."""


def _of_name(name: str) -> Dimension:
    if name not in NOMENCLATURE:
        raise DimensionError(f"{name} is not in the nomenclature")
    return NOMENCLATURE[name].dimension


def _same(terms: Sequence[sp.Basic], known: Mapping[sp.Basic, Dimension] | None, where: str) -> Dimension:
    """The common dimension of terms that are added or compared."""
    found = [dimension(term, known) for term in terms]
    for term, of_term in zip(terms, found, strict=True):
        if of_term != found[0]:
            raise DimensionError(f"{terms[0]} [{found[0]}] and {term} [{of_term}] meet in one {where}")
    return found[0] if found else _NONE


def _of_calculus(expr: sp.Derivative | sp.Integral | sp.Sum, known: Mapping[sp.Basic, Dimension] | None) -> Dimension:
    """A derivative divides by its variables' dimensions, an integral multiplies; a sum does neither."""
    result = dimension(expr.args[0], known)
    for variable, *rest in (tuple(limits) for limits in expr.args[1:]):
        if isinstance(expr, sp.Sum):
            continue
        of_variable = dimension(variable, known)
        if isinstance(expr, sp.Derivative):
            result = result.times(of_variable.power(-int(rest[0])))
        else:
            _same([variable, *(limit for limit in rest if limit != 0)], known, "Integral")
            result = result.times(of_variable)
    return result


def _of_branches(expr: sp.Piecewise, known: Mapping[sp.Basic, Dimension] | None) -> Dimension:
    for _, condition in expr.args:
        for relation in sorted(condition.atoms(Relational), key=str):
            dimension(relation, known)
    return _same([branch for branch, _ in expr.args if branch != 0], known, "Piecewise")


def dimension(expr: sp.Basic, known: Mapping[sp.Basic, Dimension] | None = None) -> Dimension:
    """The dimension of an expression.

    Parameters
    ----------
    expr : sympy.Basic
        Sums, products, powers, elementary functions of the nomenclature's symbols and functions; derivatives,
        integrals, sums, branches; for an equation or inequality the common dimension of its sides.
    known : mapping, optional
        Dimensions of further symbols or subexpressions.

    Raises
    ------
    DimensionError
        Where the expression is dimensionally inconsistent; names the terms.
    """
    if known and expr in known:
        return known[expr]
    if expr == TINY:
        return _NONE
    if isinstance(expr, sp.Add) and TINY in expr.args:
        return dimension(expr - TINY, known)
    if isinstance(expr, sp.Symbol) or (isinstance(expr, AppliedUndef) and expr.name in NOMENCLATURE):
        return _of_name(expr.name)
    if expr.is_number or expr in (sp.true, sp.false):
        return _NONE
    if isinstance(expr, (sp.Derivative, sp.Integral, sp.Sum)):
        return _of_calculus(expr, known)
    if isinstance(expr, sp.Piecewise):
        return _of_branches(expr, known)
    if isinstance(expr, Relational):
        return _same([a for a in expr.args if a != 0], known, type(expr).__name__)
    if isinstance(expr, sp.Subs):
        return dimension(expr.expr, known)
    if isinstance(expr, sp.sign):
        dimension(expr.args[0], known)
        return _NONE
    return _of_operation(expr, known)


def _of_operation(expr: sp.Basic, known: Mapping[sp.Basic, Dimension] | None) -> Dimension:
    """Of a product, a power, or a function of arguments."""
    comparison = isinstance(expr, sp.atan2) or type(expr).__name__ == "less"
    if comparison or isinstance(expr, _SAME_AS_ARGUMENTS):
        common = _same([a for a in expr.args if a != 0] or expr.args, known, type(expr).__name__)
        return _NONE if comparison else common
    of_arguments = [dimension(argument, known) for argument in expr.args]
    if isinstance(expr, sp.Mul):
        product = _NONE
        for factor in of_arguments:
            product = product.times(factor)
        return product
    if isinstance(expr, sp.Pow):
        return _of_power(expr, *of_arguments)
    for argument, found in zip(expr.args, of_arguments, strict=True):
        if found != _NONE:
            raise DimensionError(f"argument {argument} [{found}] of {type(expr).__name__} is not a number")
    return _NONE


def _of_power(expr: sp.Pow, base: Dimension, exponent: Dimension) -> Dimension:
    if isinstance(expr.exp, sp.Rational):
        return base.power(Fraction(int(expr.exp.p), int(expr.exp.q)))
    if base == exponent == _NONE:
        return _NONE
    raise DimensionError(f"power of {expr.base} [{base}] to {expr.exp} [{exponent}]")
