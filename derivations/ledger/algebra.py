"""When two expressions are the same."""

from __future__ import annotations

from functools import cache

import sympy as sp

__all__ = ["difference", "vanishes"]


@cache
def vanishes(expr: sp.Basic) -> bool:
    """Whether an expression is identically 0, by ever stronger simplification."""
    if isinstance(expr, sp.Equality):
        expr = expr.lhs - expr.rhs
    for simpler in (sp.sympify, sp.expand, lambda e: sp.expand(sp.expand_trig(e)), sp.together, sp.simplify):
        expr = simpler(expr)
        if expr == 0:
            return True
    return False


def difference(form: sp.Basic, other: sp.Basic) -> sp.Basic:
    """What must vanish for two expressions, or two equations, to be the same (equations: side by side)."""
    if isinstance(form, sp.Equality) and isinstance(other, sp.Equality):
        return (form.lhs - form.rhs) - (other.lhs - other.rhs)
    return form - other
