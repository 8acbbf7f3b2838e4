"""The certificates, made: each claim's goal from its letters, its multipliers by division of polynomials."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import sympy as sp

from derivations.certificates.sources import SOURCES

__all__ = ["as_json", "make"]

Poly = dict[str, str]


def _polynomial(text: str) -> sp.Expr:
    names = {name: sp.Symbol(name) for name in "abcdefghjklmnpqrstuvwxyzABCEDFGLPQRSTXY"}
    return sp.expand(sp.sympify(text.replace("^", "**"), locals=names))


def _letters(expressions: Sequence[sp.Expr]) -> list[sp.Symbol]:
    return sorted(set().union(*(e.free_symbols for e in expressions)), key=str)


def _terms(expr: sp.Expr, letters: Sequence[sp.Symbol]) -> Poly:
    """A polynomial as the checker reads it."""
    found: Poly = {}
    for powers, coefficient in sp.Poly(expr, *letters, domain="QQ").terms():
        if coefficient:
            parts = [f"{s}^{e}" if e > 1 else str(s) for s, e in zip(letters, powers, strict=True) if e]
            found[" ".join(parts)] = str(coefficient)
    return found


def _multipliers(
    target: sp.Expr, given: Sequence[sp.Expr], letters: Sequence[sp.Symbol], order: str
) -> list[tuple[int, Poly]]:
    """The m_i other than 0 with target = sum m_i given_i: by division, or by Groebner's basis."""
    if target == 0:
        return []
    first = [sp.Symbol(letter) for letter in order]
    quotients, rest = sp.reduced(target, given, *first, *(s for s in letters if s not in first), order="lex")
    if rest != 0:
        ring = sp.QQ.old_poly_ring(*letters)
        try:
            found = ring.ideal(*given).in_terms_of_generators(target)
        except ValueError as error:
            raise ArithmeticError(f"{target} does not follow from what is given") from error
        quotients = [ring.to_sympy(m) for m in found]
    multipliers = [_terms(sp.expand(m), letters) for m in quotients]
    return [(index, m) for index, m in enumerate(multipliers) if m]


def _derivative(expr: sp.Expr, rates: Mapping[str, sp.Expr]) -> sp.Expr:
    return sp.expand(sum((expr.diff(sp.Symbol(name)) * rate for name, rate in rates.items()), sp.S.Zero))


def _cone(parts: Sequence[tuple[str, tuple[int, ...], str]], positive: Sequence[sp.Expr]) -> sp.Expr:
    total = sp.S.Zero
    for factor, indices, root in parts:
        total += sp.Rational(factor) * sp.Mul(*(positive[i] for i in indices)) * _polynomial(root) ** 2
    return sp.expand(total)


@cache
def make(name: str) -> dict[str, Any]:
    """A certificate as data."""
    (source,) = (one for one in SOURCES if one.name == name)
    rates = {letter: _polynomial(rate) for letter, rate in source.rates.items()}
    stated, positive = [_polynomial(g) for g in source.given], [_polynomial(p) for p in source.positive]
    given = [*stated, *(_derivative(g, rates) for g in stated)] if rates else list(stated)
    goals = [_polynomial(claim.goal) for claim in source.claims]
    letters = _letters([*given, *positive, *goals, *rates.values()])
    claims = []
    for claim, goal in zip(source.claims, goals, strict=True):
        target = sp.expand(_cone(claim.times, positive) * goal - _cone(claim.equals, positive))
        claims.append(
            {
                "name": claim.name,
                "says": claim.says,
                "goal": _terms(goal, letters),
                "times": _parts(claim.times, letters),
                "equals": _parts(claim.equals, letters),
                "multipliers": [list(pair) for pair in _multipliers(target, given, letters, source.order)],
            }
        )
        (positive if claim.equals else given).append(goal)
    return {
        "name": source.name,
        "title": source.title,
        "about": list(source.about),
        "letters": dict(source.letters),
        "forms": {letter: list(where) for letter, where in source.forms.items()},
        "given": [_terms(g, letters) for g in stated],
        "positive": [_terms(_polynomial(p), letters) for p in source.positive],
        "rates": {letter: _terms(rate, letters) for letter, rate in rates.items()},
        "claims": claims,
    }


def _parts(parts: Sequence[tuple[str, tuple[int, ...], str]], letters: Sequence[sp.Symbol]) -> list[Any]:
    return [[factor, list(indices), _terms(_polynomial(root), letters)] for factor, indices, root in parts]


def as_json(certificate: Mapping[str, Any]) -> str:
    """The text of a certificate's file."""
    return json.dumps(certificate, indent=1, ensure_ascii=False) + "\n"
