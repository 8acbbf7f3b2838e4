"""Formulas for a terminal: SymPy's Unicode pictures, with the pieces into which a formula falls that is too wide.

A picture is ``{"lines": [...], "baseline": n}``, n the line that stands on a row's line.  One wider than ``NARROW``
columns has ``parts`` beside it, pictures from left to right; a part with ``"breaks": true`` may begin a new row, one
with ``"row": true`` does.  One wider than ``WIDEST`` has its parts only.  :mod:`trum_sym.paper.terminal` lays them out
in the width that there is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any
from unicodedata import normalize

import sympy as sp
from sympy.core.function import AppliedUndef, _coeff_isneg
from sympy.core.relational import Relational
from sympy.printing.conventions import requires_partial
from sympy.printing.pretty.pretty import PrettyPrinter
from sympy.printing.pretty.pretty_symbology import greek_unicode, pretty_symbol, sub
from sympy.printing.pretty.stringpict import prettyForm

from derivations.nomenclature import NOMENCLATURE

__all__ = ["NARROW", "WIDEST", "picture"]

NARROW, WIDEST = 32, 160  # columns
Picture = dict[str, Any]

_PLAIN = re.compile(r"((?:\\[A-Za-z]+)+|[A-Za-z])(?:_\{?([A-Za-z0-9,]+)\}?)?")
_VARIANTS = {"vartheta": "ϑ", "varphi": "φ"}
_SIGNS = {"==": "=", "!=": "≠", "<=": "≤", ">=": "≥", "<": "<", ">": ">"}


def _name(symbol: str, latex: str) -> str:
    """What the nomenclature's LaTeX says in Unicode, where it is a letter with an index; else SymPy's way."""
    found = _PLAIN.fullmatch(latex)
    if found is None:
        return str(pretty_symbol(symbol))
    words = found[1].removeprefix("\\").split("\\")
    letter = "".join(_VARIANTS.get(word) or greek_unicode.get(word) or word for word in words)
    index = found[2] or ""
    small = [sub.get(character) for character in index]
    return letter + ("".join(map(str, small)) if all(small) else f"_{index}")


def _plain(name: str) -> str:
    """A symbol of the ledger's own, whose name may be LaTeX."""
    name = re.sub(r"\\mathrm\{([^{}]*)\}", r"\1", name)
    name = re.sub(r"\\dot\{?(\w)\}?", lambda found: normalize("NFC", found[1] + "\u0307"), name)
    name = re.sub(r"\\([A-Za-z]+) ?", lambda found: greek_unicode.get(found[1], found[1]), name)
    return str(pretty_symbol(name))


_NAMES = {entry.symbol: _name(name, entry.latex) for name, entry in NOMENCLATURE.items()}


class _Printer(PrettyPrinter):  # type: ignore[misc]  # SymPy is untyped
    """SymPy's, with the nomenclature's names."""

    def _print_Symbol(self, e: sp.Symbol, bold_name: bool = False) -> prettyForm:  # noqa: ARG002
        return prettyForm(_NAMES.get(e) or _plain(e.name))

    def _print_Max(self, e: sp.Max) -> prettyForm:
        return self._helper_print_function(e.func, e.args, func_name=e.func.__name__.lower())

    _print_Min = _print_Max


_printer = _Printer({"use_unicode": True, "wrap_line": False, "num_columns": None})


def _whole(expression: sp.Basic) -> Picture:
    form = _printer._print(expression)
    return {"lines": list(form.picture), "baseline": int(form.baseline)}


def _text(text: str, *, breaks: bool = False) -> Picture:
    return {"lines": [text], "baseline": 0, **({"breaks": True} if breaks else {})}


def _width(of: Picture) -> int:
    return max(map(len, of["lines"]))


def picture(name: str, form: sp.Basic) -> Picture:
    """A form of the ledger under its name: an equation as it is, an expression as one for its name.

    Examples
    --------
    >>> a, b = sp.symbols("a b")
    >>> picture("c", a + b)["lines"]
    ['c = a + b']
    """
    if isinstance(form, Relational) or form in (sp.true, sp.false) or not name:
        return _of(form)
    entry = NOMENCLATURE.get(name)
    known = _NAMES[entry.symbol] if entry is not None else None
    left = _text(known or (name.replace("_", " ") if len(name.split("_")[0]) > 3 else str(pretty_symbol(name))))
    return _joined([left, _text(" = ", breaks=True), _of(form)])


def _of(expression: sp.Basic) -> Picture:
    whole = _whole(expression)
    if _width(whole) <= NARROW:
        return whole
    parts = list(_parts(expression))
    if not parts:
        return whole
    return {**(whole if _width(whole) <= WIDEST else {"lines": [], "baseline": 0}), "parts": parts}


def _joined(parts: list[Picture]) -> Picture:
    """Parts side by side; as one picture where they are narrow enough."""
    if any(not part["lines"] for part in parts):
        return {"lines": [], "baseline": 0, "parts": parts}
    lines, baseline = _beside(parts)
    whole = {"lines": lines, "baseline": baseline}
    if len(lines[0]) <= NARROW:
        return whole
    return {**(whole if len(lines[0]) <= WIDEST else {"lines": [], "baseline": 0}), "parts": parts}


def _beside(parts: list[Picture]) -> tuple[list[str], int]:
    from trum_sym.paper.terminal import beside

    return beside(parts)


def _parts(expression: sp.Basic) -> Iterator[Picture]:
    """What a formula falls into at its outermost operators; nothing where it does not."""
    if isinstance(expression, Relational):
        yield _of(expression.lhs)
        yield _text(f" {_SIGNS[expression.rel_op]} ", breaks=True)
        yield _of(expression.rhs)
    elif isinstance(expression, sp.Add):
        yield from _sum(expression)
    elif isinstance(expression, sp.Mul):
        yield from _product(expression)
    elif isinstance(expression, sp.Pow):
        yield from _power(expression)
    elif isinstance(expression, sp.Piecewise):
        yield from _pieces(expression)
    elif isinstance(expression, sp.And | sp.Or):
        yield from _junction(expression)
    elif isinstance(expression, sp.Derivative):
        yield from _derivative(expression)
    elif isinstance(expression, sp.Integral) and all(len(limit) == 3 for limit in expression.limits):
        yield from _integral(expression)
    elif isinstance(expression, sp.Function | sp.Max | sp.Min):
        name = expression.func.__name__
        yield _text(str(pretty_symbol(name)) if isinstance(expression, AppliedUndef) else name.lower())
        yield from _bracketed(*expression.args)


def _pieces(expression: sp.Piecewise) -> Iterator[Picture]:
    for value, condition in expression.args:
        yield {**_text("otherwise " if condition == sp.true else ""), "row": True}
        yield _of(value)
        if condition != sp.true:
            yield _text("  for ", breaks=True)
            yield _of(condition)


def _junction(expression: sp.And | sp.Or) -> Iterator[Picture]:
    for place, argument in enumerate(sorted(expression.args, key=sp.default_sort_key)):
        if place:
            yield _text(" ∧ " if isinstance(expression, sp.And) else " ∨ ", breaks=True)
        yield _of(argument)


def _derivative(expression: sp.Derivative) -> Iterator[Picture]:
    whole = _whole(sp.Derivative(sp.Symbol("·"), *expression.args[1:]))
    sign = "∂" if requires_partial(expression.expr) else "d"
    top = [line.replace("(·)", "").replace("·", "").replace("d", sign) for line in whole["lines"]]
    yield {"lines": top, "baseline": whole["baseline"]}
    yield from _bracketed(expression.expr)


def _integral(expression: sp.Integral) -> Iterator[Picture]:
    for over, low, high in reversed(expression.limits):
        yield _text(f"∫ over {_whole(over)['lines'][0]} from ", breaks=True)
        yield _of(low)
        yield _text(" to ")
        yield _of(high)
        yield _text(" of ")
    yield from _bracketed(expression.function)


def _bracketed(*arguments: sp.Basic) -> Iterator[Picture]:
    yield _text("(")
    for place, argument in enumerate(arguments):
        if place:
            yield _text(", ")
        yield {**_of(argument), **({"breaks": True} if place else {})}
    yield _text(")")


def _sum(expression: sp.Add) -> Iterator[Picture]:
    for place, term in enumerate(_printer._as_ordered_terms(expression)):
        negative = _coeff_isneg(term)
        if place or negative:
            sign = "-" if negative else "+"
            yield _text(f" {sign} " if place else f"{sign}", breaks=place > 0)
        shown = term
        if negative and isinstance(term, sp.Mul):
            coefficient, others = term.as_coeff_mul(rational=False)
            shown = sp.Mul(*([] if coefficient == -1 else [-coefficient]), *others, evaluate=False)
        elif negative:
            shown = -term
        yield from _bracketed(shown) if isinstance(shown, sp.Add) else [_of(shown)]


def _product(expression: sp.Mul) -> Iterator[Picture]:
    above: list[sp.Basic] = []
    below: list[sp.Basic] = []
    for factor in expression.args if expression.args[0] is sp.S.One else expression.as_ordered_factors():
        if isinstance(factor, sp.Pow) and factor.exp.is_Rational and factor.exp.is_negative:
            below.append(factor.base if factor.exp == -1 else sp.Pow(factor.base, -factor.exp, evaluate=False))
        elif isinstance(factor, sp.Rational) and factor.is_finite:
            above += [sp.Integer(factor.p)] if factor.p != 1 else []
            below += [sp.Integer(factor.q)] if factor.q != 1 else []
        else:
            above.append(factor)
    if above and above[0] == -1 and len(above) > 1:
        yield _text("-")
        del above[0]
    yield from _factors(above or [sp.S.One])
    if below:
        yield _text(" / ", breaks=True)
        if len(below) > 1:
            yield _text("(")
        yield from _factors(below)
        if len(below) > 1:
            yield _text(")")


def _factors(factors: list[sp.Basic]) -> Iterator[Picture]:
    for place, factor in enumerate(factors):
        if place:
            yield _text("⋅", breaks=True)
        loose = isinstance(factor, sp.Add | sp.Piecewise | Relational | sp.Mul)
        yield from _bracketed(factor) if loose else [_of(factor)]


def _power(expression: sp.Pow) -> Iterator[Picture]:
    base, exponent = expression.args
    if exponent.is_Rational and exponent.is_negative:
        yield _text("1 / ")
        exponent = -exponent
    if exponent == sp.Rational(1, 2):
        yield _text("√")
    if base is sp.E:
        yield _text("exp")
        yield from _bracketed(exponent)
        return
    yield from _bracketed(base)
    if exponent not in (sp.Rational(1, 2), sp.S.One):
        raised = _whole(exponent)
        yield {"lines": [*raised["lines"], " " * _width(raised)], "baseline": len(raised["lines"])}
