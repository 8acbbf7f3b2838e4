"""Replays certificates in exact fractions; needs Python alone: ``python derivations/certificates/checker.py FILE ...``

A polynomial is ``{monomial: coefficient}``, such as ``{"Y f^2": "1", "": "-3/2"}``.  ``given`` polynomials are 0, and so
are their derivatives where ``rates`` says how letters change; ``positive`` ones are above 0.  A claim holds if
``times * goal = sum of multipliers * given + equals``, checked coefficient by coefficient, where ``times`` and
``equals`` are lists of ``[c, [indices of positive ones], p]``, each standing for ``c * their product * p^2`` with c > 0.
With ``equals`` empty the goal is 0; else it is above 0; for the goal -1 the given cannot hold.  It is given from then on.
"""

from __future__ import annotations

import json
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

Poly = dict[tuple[tuple[str, int], ...], Fraction]


def read(terms: dict[str, str]) -> Poly:
    found: Poly = {}
    for monomial, coefficient in terms.items():
        powers = [(name, int(power or 1)) for name, _, power in (part.partition("^") for part in monomial.split())]
        found[tuple(sorted(powers))] = found.get(tuple(sorted(powers)), Fraction(0)) + Fraction(coefficient)
    return {powers: c for powers, c in found.items() if c}


def times(a: Poly, b: Poly) -> Poly:
    total: dict[tuple[tuple[str, int], ...], Fraction] = {}
    for (p, c), (q, d) in ((x, y) for x in a.items() for y in b.items()):
        names = {name for name, _ in p + q}
        powers = tuple(sorted((name, dict(p).get(name, 0) + dict(q).get(name, 0)) for name in names))
        total[powers] = total.get(powers, Fraction(0)) + c * d
    return {powers: c for powers, c in total.items() if c}


def plus(a: Poly, b: Poly) -> Poly:
    total = {powers: a.get(powers, Fraction(0)) + b.get(powers, Fraction(0)) for powers in {*a, *b}}
    return {powers: c for powers, c in total.items() if c}


def derivative(a: Poly, rates: dict[str, Poly]) -> Poly:
    total: Poly = {}
    for powers, c in a.items():
        for name, power in powers:
            less = tuple((n, e - (n == name)) for n, e in powers if e - (n == name))
            total = plus(total, times({less: c * power}, rates.get(name, {})))
    return total


def cone(parts: list[Any], positive: list[Poly]) -> Poly:
    total: Poly = {}
    for c, indices, p in parts:
        if Fraction(c) <= 0:
            raise ValueError(f"a part of a sum of squares has the factor {c}")
        term = times({(): Fraction(c)}, times(read(p), read(p)))
        for index in indices:
            term = times(term, positive[index])
        total = plus(total, term)
    return total


def check(certificate: dict[str, Any]) -> None:
    """Return if every claim holds; a ValueError that names the first one that does not."""
    positive, rates = [read(p) for p in certificate["positive"]], {n: read(p) for n, p in certificate["rates"].items()}
    given = [read(p) for p in certificate["given"]]
    given += [derivative(p, rates) for p in given] if rates else []
    for claim in certificate["claims"]:
        for parts in filter(None, (claim["times"] or [["0", [], {}]], claim["equals"])):
            if not any(read(p).keys() == {()} for _, _, p in parts):
                raise ValueError(f"{claim['name']}: a sum of squares could be 0")
        left, right = times(cone(claim["times"], positive), read(claim["goal"])), cone(claim["equals"], positive)
        for index, multiplier in claim["multipliers"]:
            right = plus(right, times(read(multiplier), given[index]))
        if left != right:
            raise ValueError(f"{claim['name']}: both sides differ")
        if not claim["equals"]:
            given.append(read(claim["goal"]))
        else:
            positive.append(read(claim["goal"]))


if __name__ == "__main__":
    for path in sys.argv[1:]:
        check(json.loads(Path(path).read_text("utf-8")))
        print(f"{path}: every claim holds")
