"""Whether a certificate is about what its letters are said to mean.

What a letter stands for is said in the ledger's symbols (``means``), or is a form of the ledger that a claim is about
(``form``: entry, name).  With the letters' values in, what is given must vanish, what is positive be so, and every goal
come out as claimed, so that what is proved is what the paper is about; and with the *printed* form of an erratum in its
letter's place, a goal that names it must fail.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from derivations.certificates import checker
from derivations.certificates.page import written
from derivations.certificates.sources import SOURCES
from derivations.ledger import entry
from derivations.ledger.judge import evaluate
from derivations.ledger.model import WORKING_DIGITS
from derivations.nomenclature import NOMENCLATURE

__all__ = ["misread"]

Poly = dict[str, str]


def _symbols() -> dict[str, sp.Expr]:
    """The ledger's symbols by name; responses and rates as plain ones."""
    plain = {n: e.symbol for n, e in NOMENCLATURE.items() if isinstance(e.symbol, sp.Symbol)}
    return {**plain, **{n: sp.Symbol(n, real=True) for n in ("w_A", "w_B", "v_A", "v_B", "u")}}


def _value(terms: Mapping[str, str], values: Mapping[str, mp.mpc]) -> mp.mpc:
    total = mp.mpf(0)
    for powers, coefficient in checker.read(dict(terms)).items():
        term = mp.mpf(coefficient.numerator) / coefficient.denominator
        total += term * mp.fprod(values[letter] ** power for letter, power in powers)
    return total


def _nothing(value: mp.mpc) -> bool:
    return bool(abs(value) < mp.mpf(10) ** -25)


def _positive(value: mp.mpc) -> bool:
    return bool(_nothing(mp.im(value)) and mp.re(value) > 0)


def _form(where: Sequence[str], *, printed: bool = False) -> sp.Expr:
    """The ledger's form that a letter stands for: what stands, or the print."""
    found = entry(where[0])
    return sp.sympify((found.printed if printed else found.subject())[where[1]])


def _points(
    meanings: Iterable[sp.Expr], domain: Mapping[str, tuple[float, float]]
) -> Iterator[dict[sp.Symbol, mp.mpf]]:
    """Four points of the symbols: in their domain, or between 0.3 and 1.7 and of either sign if real."""
    symbols = sorted(set().union(*(m.free_symbols for m in meanings)), key=lambda s: s.name)
    for index in range(4):
        point = {}
        for symbol in symbols:
            draw = random.Random(f"{symbol.name} {index}")
            low, high = domain.get(symbol.name, (0.3, 1.7))
            either = symbol.name not in domain and not symbol.is_positive
            point[symbol] = mp.mpf(draw.uniform(low, high)) * (draw.choice((1, -1)) if either else 1)
        yield point


def misread(certificate: Mapping[str, Any], domain: Mapping[str, tuple[float, float]] | None = None) -> list[str]:
    """Where a certificate is not about what its letters are said to mean; empty if it is."""
    source = next((one for one in SOURCES if one.name == certificate["name"]), None)
    if source is None:
        return [f"no certificate is called {certificate['name']}"]
    names = _symbols()
    meanings = {letter: sp.sympify(text, locals=names) for letter, text in certificate["letters"].items()}
    meanings |= {letter: _form(where) for letter, where in certificate["forms"].items()}
    with mp.workdps(WORKING_DIGITS):
        found: list[str] = []
        for point in _points(meanings.values(), source.domain if domain is None else domain):
            values = {letter: evaluate(meaning, point) for letter, meaning in meanings.items()}
            found += _off(certificate, values, meanings, point)
            for letter, where in certificate["forms"].items():
                printed = {**values, letter: evaluate(_form(where, printed=True), point)}
                goals = {claim["name"]: _value(claim["goal"], printed) for claim in certificate["claims"]}
                found += [f"{name}: the print satisfies it too" for name in source.refutes if _nothing(goals[name])]
    return list(dict.fromkeys(found))


def _off_rates(
    rates: Mapping[str, Poly],
    values: dict[str, mp.mpc],
    meanings: Mapping[str, sp.Expr],
    point: Mapping[sp.Symbol, mp.mpf],
) -> Iterator[str]:
    """Rates that are not the derivatives by the letter whose rate is 1; a letter of its own is given its value."""
    by = [meanings[letter] for letter, rate in rates.items() if rate == {"": "1"}]
    for letter, rate in rates.items():
        slope = evaluate(meanings[letter].diff(by[0]), point)
        (alone,) = rate if list(rate.values()) == ["1"] else ("",)
        if alone.isalpha():
            values.setdefault(alone, slope)
        if not _nothing(slope - _value(rate, values)):
            yield f"the rate of {letter} is not {written(rate)}"


def _off(
    certificate: Mapping[str, Any],
    values: dict[str, mp.mpc],
    meanings: Mapping[str, sp.Expr],
    point: Mapping[sp.Symbol, mp.mpf],
) -> Iterator[str]:
    """What does not hold at a point."""
    yield from _off_rates(certificate["rates"], values, meanings, point)
    for terms in certificate["given"]:
        if not _nothing(_value(terms, values)):
            yield f"{written(terms)} is not 0"
    for terms in certificate["positive"]:
        if not _positive(_value(terms, values)):
            yield f"{written(terms)} is not above 0"
    for claim in certificate["claims"]:
        value = _value(claim["goal"], values)
        if claim["goal"] == {"": "-1"}:  # what is given cannot hold, in real numbers
            if all(_nothing(mp.im(v)) for v in values.values()):
                yield f"{claim['name']}: real numbers do what the certificate denies"
        elif not (_positive(value) if claim["equals"] else _nothing(value)):
            yield f"{claim['name']}: {written(claim['goal'])} is not {'above ' if claim['equals'] else ''}0"
