"""Trees as Maxima text: node by node as they stand, nothing is simplified on the way.

What Maxima's own notation lacks is written with inert names that ``judges/kernel.mac`` gives their meaning: ``rows``
of a piecewise form as pairs of value and condition, ``both`` and ``either`` for conditions joined, ``area`` of an
integral (Maxima's own takes out of it what it holds for constant), ``angle2`` of two arguments.  Numbers are exact.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

__all__ = ["PrintError", "forms_text", "name_of", "text"]

_FUNCTIONS: dict[type, str] = {
    sp.sin: "sin",
    sp.cos: "cos",
    sp.tan: "tan",
    sp.asin: "asin",
    sp.acos: "acos",
    sp.atan: "atan",
    sp.atan2: "angle2",
    sp.exp: "exp",
    sp.sinh: "sinh",
    sp.cosh: "cosh",
    sp.log: "log",
    sp.Abs: "abs",
    sp.sign: "signum",
    sp.floor: "floor",
    sp.Max: "max",
    sp.Min: "min",
    sp.And: "both",
    sp.Or: "either",
}
_UNORDERED = (sp.Max, sp.Min, sp.And, sp.Or)
_RESERVED = {"lambda": "lambda_", "step": "step_"}
_CONSTANTS: dict[sp.Basic, str] = {
    sp.pi: "%pi",
    sp.E: "%e",
    sp.I: "%i",
    sp.oo: "inf",
    sp.true: "true",
    sp.false: "false",
}
_UNIT = re.compile(r"\\mathrm\{(\w+)\}")


class PrintError(ValueError):
    """A tree with a node that has no text here; names the node."""


def name_of(name: str) -> str:
    """A symbol's name in Maxima: units as ``u_m``, the language's own words with an underscore behind them."""
    unit = _UNIT.fullmatch(name)
    if unit:
        return f"u_{unit[1]}"
    plain = re.sub(r"\W+", "_", name.replace(r"\dot", "rate")).strip("_")
    return _RESERVED.get(plain, plain)


def _sum(node: sp.Basic) -> str:
    return "(" + " + ".join(text(term) for term in node.args) + ")"


def _product(node: sp.Basic) -> str:
    return "(" + "*".join(text(factor) for factor in node.args) + ")"


def _power(node: sp.Basic) -> str:
    base, exponent = node.args
    return f"sqrt({text(base)})" if exponent == sp.Rational(1, 2) else f"({text(base)})^({text(exponent)})"


def _rows(node: sp.Basic) -> str:
    return "rows(" + ", ".join(f"[{text(value)}, {text(condition)}]" for value, condition in node.args) + ")"


def _derivative(node: sp.Basic) -> str:
    orders = ", ".join(f"{text(by)}, {order}" for by, order in node.variable_count)
    return f"diff({text(node.expr)}, {orders})"


def _within(word: str) -> Callable[[sp.Basic], str]:
    def write(node: sp.Basic) -> str:
        if len(node.limits) != 1 or len(node.limits[0]) != 3:
            raise PrintError(f"no text for {node}")
        by, low, high = node.limits[0]
        return f"{word}({text(node.function)}, {text(by)}, {text(low)}, {text(high)})"

    return write


def _relation(node: sp.Basic) -> str:
    return f"({text(node.lhs)} {node.rel_op.replace('==', '=')} {text(node.rhs)})"


def _called(node: sp.Basic) -> str:
    return f"{name_of(node.func.__name__)}({', '.join(map(text, node.args))})"


def _indexed(node: sp.Basic) -> str:
    return f"{name_of(str(node.base))}[{', '.join(map(text, node.indices))}]"


_WRITERS: tuple[tuple[type, Callable[[sp.Basic], str]], ...] = (
    (sp.Symbol, lambda node: name_of(node.name)),
    (sp.Rational, lambda node: f"({node.p}/{node.q})" if node.q != 1 else f"({node.p})"),
    (sp.Float, lambda node: text(sp.Rational(str(node)))),
    (sp.Add, _sum),
    (sp.Mul, _product),
    (sp.Pow, _power),
    (sp.Piecewise, _rows),
    (sp.Derivative, _derivative),
    (sp.Integral, _within("area")),
    (sp.Sum, _within("'sum")),
    (Relational, _relation),
    (AppliedUndef, _called),
    (sp.Indexed, _indexed),
)


def text(node: sp.Basic) -> str:
    """A tree as Maxima text.

    Raises
    ------
    PrintError
        If the tree has a node without a text.
    """
    if node in _CONSTANTS:
        return _CONSTANTS[node]
    if node.func in _FUNCTIONS:
        arguments = list(map(text, node.args))
        if node.func in _UNORDERED:  # SymPy keeps them as a set, in an order that differs from run to run
            arguments.sort()
        return f"{_FUNCTIONS[node.func]}({', '.join(arguments)})"
    for kind, write in _WRITERS:
        if isinstance(node, kind):
            return write(node)
    raise PrintError(f"no text for {type(node).__name__}: {node}")


def forms_text(forms: Mapping[str, sp.Basic]) -> str:
    """Named forms as a list of pairs, in their order."""
    return "[" + ", ".join(f'["{name}", {text(sp.sympify(form))}]' for name, form in forms.items()) + "]"
