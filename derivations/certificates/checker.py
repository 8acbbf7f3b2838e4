"""Replays certificates in exact fractions; needs Python alone: ``python derivations/certificates/checker.py FILE ...``

A polynomial is ``{monomial: coefficient}``, such as ``{"Y f^2": "1", "": "-3/2"}``.  ``given`` polynomials are 0, and
so are their derivatives where ``rates`` says how letters change; ``positive`` ones are above 0.  A claim is proved by
``times * goal = sum of multipliers * given + equals``, compared coefficient by coefficient, where ``times`` and
``equals`` are lists of ``[c, [indices of positive ones], p]``, each standing for ``c * their product * p^2``, c > 0.
With ``equals`` empty the goal is 0, else it is above 0; for the goal -1 the given cannot hold.  What is proved is given
to the claims after it.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import Any

Poly = dict[tuple[tuple[str, int], ...], Fraction]


def read(terms: dict[str, str]) -> Poly:
    """A polynomial from its data: powers of letters, sorted, to coefficients that are not 0."""
    split = {text: [part.partition("^") for part in text.split()] for text in terms}
    powers = {text: tuple(sorted((name, int(power or 1)) for name, _, power in split[text])) for text in terms}
    return total(*({powers[text]: Fraction(terms[text])} for text in terms))


def total(*polynomials: Poly) -> Poly:
    """Their sum."""
    found: dict[tuple[tuple[str, int], ...], Fraction] = {}
    for powers, c in (term for polynomial in polynomials for term in polynomial.items()):
        found[powers] = found.get(powers, Fraction(0)) + c
    return {powers: c for powers, c in found.items() if c}


def product(*polynomials: Poly) -> Poly:
    """Their product."""
    found: Poly = {(): Fraction(1)}
    for other in polynomials:
        found = total(*({_both(p, q): c * d} for p, c in found.items() for q, d in other.items()))
    return found


def _both(p: tuple[tuple[str, int], ...], q: tuple[tuple[str, int], ...]) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((Counter(dict(p)) + Counter(dict(q))).items()))


def derivative(polynomial: Poly, rates: dict[str, Poly]) -> Poly:
    """By the product rule, letters changing at their rates and the others not at all."""
    parts = []
    for powers, c in polynomial.items():
        for name, power in powers:
            less = tuple((n, e - (n == name)) for n, e in powers if e > (n == name))
            parts.append(product({less: c * power}, rates.get(name, {})))
    return total(*parts)


def cone(parts: list[Any], positive: list[Poly]) -> Poly:
    """A sum of positive numbers times positive polynomials times squares, one part surely above 0."""
    if parts and not any(read(root).keys() == {()} for _, _, root in parts):
        raise ValueError("a sum of squares could be 0")
    if any(Fraction(c) <= 0 for c, _, _ in parts):
        raise ValueError("a square has a factor that is not above 0")
    return total(*(product({(): Fraction(c)}, *(positive[i] for i in at), read(p), read(p)) for c, at, p in parts))


def check(certificate: dict[str, Any]) -> None:
    """Return if every claim is proved; a ValueError that names the first one that is not."""
    positive, rates = [read(p) for p in certificate["positive"]], {n: read(p) for n, p in certificate["rates"].items()}
    given = [read(p) for p in certificate["given"]]
    given += [derivative(p, rates) for p in given] if rates else []
    for claim in certificate["claims"]:
        try:
            left = product(cone(claim["times"], positive), read(claim["goal"]))
            right = total(
                cone(claim["equals"], positive), *(product(read(m), given[i]) for i, m in claim["multipliers"])
            )
        except (ValueError, IndexError) as error:
            raise ValueError(f"{claim['name']}: {error}") from error
        if not claim["times"] or left != right:
            raise ValueError(f"{claim['name']}: both sides differ")
        (positive if claim["equals"] else given).append(read(claim["goal"]))


if __name__ == "__main__":
    for path in sys.argv[1:]:
        check(json.loads(Path(path).read_text("utf-8")))
        print(f"{path}: every claim is proved")
