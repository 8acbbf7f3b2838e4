"""The certificates, made: each claim's goal from the letters below, its multipliers by division of polynomials.

What a letter stands for is said in the ledger's symbols (``means``), or is a form of the ledger that a claim is about
(``form``: entry, name).  :func:`misread` holds a certificate against that reading: with the letters' values in, what is
given must vanish, what is positive be so, and every goal come out as claimed, so that what is proved is what the paper
is about; and with the *printed* form of an erratum in its letter's place, a goal that names it must fail.
"""

from __future__ import annotations

import json
import random
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import mpmath as mp
import sympy as sp

from derivations.certificates import checker
from derivations.ledger import entry
from derivations.ledger.html import anchor
from derivations.ledger.judge import evaluate
from derivations.ledger.model import WORKING_DIGITS
from derivations.nomenclature import NOMENCLATURE

__all__ = ["DATA", "SOURCES", "as_json", "command", "make", "misread", "page", "sentence"]

DATA = Path(__file__).parent / "data"
Poly = dict[str, str]


@dataclass(frozen=True)
class Claim:
    """A goal that is 0, or above 0 where ``equals`` is not empty; both factors as in the checker."""

    name: str
    says: str
    goal: str
    times: tuple[tuple[str, tuple[int, ...], str], ...] = (("1", (), "1"),)
    equals: tuple[tuple[str, tuple[int, ...], str], ...] = ()


@dataclass(frozen=True)
class Source:
    """A certificate before its multipliers are found."""

    name: str
    title: str
    about: tuple[str, ...]  # entries
    letters: Mapping[str, str]  # letter -> its meaning in the ledger's symbols
    claims: tuple[Claim, ...]
    forms: Mapping[str, tuple[str, str]] = field(default_factory=dict)  # letter -> entry and form that it stands for
    given: tuple[str, ...] = ()
    positive: tuple[str, ...] = ()
    rates: Mapping[str, str] = field(default_factory=dict)
    domain: Mapping[str, tuple[float, float]] = field(default_factory=dict)  # of the symbols in the meanings
    refutes: tuple[str, ...] = ()  # claims that the printed form of a letter's erratum fails
    order: str = ""  # letters that what is given eliminates, first to last


_TURN = "s^2 + c^2 - 1"
SOURCES: tuple[Source, ...] = (
    Source(
        "determinant",
        "Q does not depend on the particle, and is the crest's height times its speed",
        ("A5", "24", "42", "22"),
        {
            "a": "w_A",
            "b": "w_B",
            "g": "v_A",
            "h": "v_B",
            "s": "sin(k_c*x)",
            "c": "cos(k_c*x)",
            "d": "D*k_c",
            "z": "w_A*sin(k_c*x) + w_B*cos(k_c*x)",
            "x": "D*k_c*(w_A*cos(k_c*x) - w_B*sin(k_c*x))",
            "l": "v_A*sin(k_c*x) + v_B*cos(k_c*x)",
            "k": "D*k_c*(v_A*cos(k_c*x) - v_B*sin(k_c*x))",
            "w": "sqrt(w_A**2 + w_B**2)",
            "S": "w_A/sqrt(w_A**2 + w_B**2)",
            "C": "w_B/sqrt(w_A**2 + w_B**2)",
        },
        (
            Claim(
                "anywhere",
                "(A5) with the displacements of (11): xi_x' xi_z - xi_z' xi_x is the same at every x",
                "k*z - l*x - d*(g*b - h*a)",
            ),
            Claim(
                "crest",
                "(42): at the crest, whose sine and cosine are S and C, height times tangential velocity is that Q",
                "w*d*(g*C - h*S) - d*(g*b - h*a)",
            ),
            Claim(
                "height", "(21): the wave's displacement there is its height", "(a*S + b*C) - w", (("1", (0,), "1"),)
            ),
        ),
        given=(
            _TURN,
            "z - (a*s + b*c)",
            "x - d*(a*c - b*s)",
            "l - (g*s + h*c)",
            "k - d*(g*c - h*s)",
            "w*S - a",
            "w*C - b",
            "w^2 - a^2 - b^2",
        ),
        positive=("w",),
        order="zxlks",
    ),
    Source(
        "two-phases",
        "The determinant of two harmonic phases as a slow and a fast term",
        ("A6",),
        {
            "P": "W_a",
            "R": "W_b",
            "m": "omega_a",
            "n": "omega_b",
            "s": "sin(omega_a*t + varphi_a)",
            "c": "cos(omega_a*t + varphi_a)",
            "S": "sin(omega_b*t + varphi_b)",
            "C": "cos(omega_b*t + varphi_b)",
            "d": "D*k_c",
            "u": "sin(omega_a*t + varphi_a + omega_b*t + varphi_b)",
            "v": "sin(omega_b*t + varphi_b - omega_a*t - varphi_a)",
        },
        (
            Claim(
                "sum and difference",
                "(A6): v_A w_B - v_B w_A, times D k_c, with sines of sum and difference of both angles",
                "2*Q - d*P*R*((n - m)*u + (n + m)*v)",
            ),
        ),
        forms={"Q": ("A6", "Q_q")},
        given=("Q - d*((-P*m*s)*(R*C) - (-R*n*S)*(P*c))", "u - (s*C + c*S)", "v - (S*c - C*s)"),
        order="Quv",
    ),
    Source(
        "speed-determinant",
        "Q_aver in X, and that it grows with X",
        ("43", "A14", "A15"),
        {
            "p": "q_plus",
            "q": "q_minus",
            "T": "T",
            "X": "q_plus/q_minus",
            "Q": "(q_plus - q_minus)/((q_plus + q_minus)*T)",
        },
        (Claim("in X", "(A14): Q_aver (X + 1) T = X - 1", "Q*(X + 1)*T - (X - 1)", (("1", (0,), "1"),)),),
        given=("X*q - p", "Q*(p + q)*T - (p - q)"),
        positive=("q", "p", "T"),
        domain={"q_plus": (0.1, 3), "q_minus": (0.1, 3), "T": (0.3, 2)},
    ),
    Source(
        "speed-slope",
        "The derivative of Q_aver by X, positive for every X > 0",
        ("A15",),
        {"X": "X", "T": "T", "Q": "(X - 1)/((X + 1)*T)"},
        (
            Claim("slope", "(A15): dQ_aver/dX (X + 1)^2 T = 2", "F*(X + 1)^2*T - 2"),
            Claim(
                "sign",
                "and it is positive",
                "F",
                (("1", (0, 0, 1), "1"), ("2", (0, 1), "1"), ("1", (1,), "1")),
                (("2", (), "1"),),
            ),
        ),
        forms={"F": ("A15", "dQ_aver/dX")},
        given=("Q*(X + 1)*T - (X - 1)",),
        positive=("X", "T"),
        rates={"X": "1", "Q": "F"},
        domain={"X": (0.1, 5), "T": (0.3, 2)},
    ),
    Source(
        "volatility-ratio",
        "Q_vib's root in Y: the same, real only with the magnitude",
        ("44", "A16"),
        {
            "p": "p_plus",
            "q": "p_minus",
            "Y": "p_plus/p_minus",
            "f": "sqrt((p_plus + p_minus)/(p_plus - p_minus))",
        },
        (
            Claim(
                "in Y",
                "(44) squared is (A16) squared: f^2 (Y - 1) = Y + 1",
                "f^2*(Y - 1) - (Y + 1)",
                (("1", (0,), "1"),),
            ),
        ),
        given=("Y*q - p", "f^2*(p - q) - (p + q)"),
        positive=("q", "p", "p - q"),
        domain={"p_plus": (2.1, 3), "p_minus": (0.1, 2)},
    ),
    Source(
        "imaginary",
        "The printed root has no real value for Y < 1",
        ("44", "A16"),
        {"f": "sqrt((Y + 1)/(Y - 1))", "Y": "Y"},
        (
            Claim(
                "no real f",
                "for 0 < Y < 1 no real f has f^2 (Y - 1) = Y + 1",
                "-1",
                (("1", (), "1"),),
                (("1", (1,), "f"), ("1", (0,), "1")),
            ),
        ),
        given=("f^2*(Y - 1) - (Y + 1)",),
        positive=("Y", "1 - Y"),
        domain={"Y": (0.1, 0.9)},
    ),
    Source(
        "root-above",
        "f = sqrt((Y + 1)/(Y - 1)) and its derivative for Y > 1",
        ("A16", "A17", "44"),
        {"Y": "Y", "f": "sqrt((Y + 1)/(Y - 1))", "r": "sqrt(Y**2 - 1)"},
        (
            Claim("f in r", "f (Y - 1) = sqrt(Y^2 - 1)", "f*(Y - 1) - r", (("1", (0, 1), "1"), ("1", (2,), "1"))),
            Claim("slope", "(A17) put right: df/dY (Y - 1) sqrt(Y^2 - 1) = -1", "F*(Y - 1)*r + 1", (("1", (1,), "1"),)),
            Claim("sign", "f falls", "-F", (("1", (1, 2), "1"),), (("1", (), "1"),)),
        ),
        forms={"F": ("A17", "df/dY")},
        given=("f^2*(Y - 1) - (Y + 1)", "r^2 - Y^2 + 1"),
        positive=("f", "Y - 1", "r"),
        rates={"Y": "1", "f": "F", "r": "G"},
        domain={"Y": (1.1, 5)},
        refutes=("slope",),
    ),
    Source(
        "root-below",
        "f = sqrt((Y + 1)/(1 - Y)) and its derivative for 0 < Y < 1",
        ("A16", "A17", "44"),
        {"Y": "Y", "f": "sqrt((Y + 1)/(1 - Y))", "r": "sqrt(1 - Y**2)"},
        (
            Claim("f in r", "f (1 - Y) = sqrt(1 - Y^2)", "f*(1 - Y) - r", (("1", (0, 1), "1"), ("1", (2,), "1"))),
            Claim("slope", "(A17) put right: df/dY (1 - Y) sqrt(1 - Y^2) = 1", "F*(1 - Y)*r - 1", (("1", (1,), "1"),)),
            Claim("sign", "f rises", "F", (("1", (1, 2), "1"),), (("1", (), "1"),)),
        ),
        forms={"F": ("A17", "df/dY")},
        given=("f^2*(1 - Y) - (Y + 1)", "r^2 + Y^2 - 1"),
        positive=("f", "1 - Y", "r"),
        rates={"Y": "1", "f": "F", "r": "G"},
        domain={"Y": (0.1, 0.9)},
        refutes=("slope",),
    ),
    Source(
        "friction",
        "The friction's closed form, and what doubling a half of the contact does to it",
        ("36", "transfer-cases"),
        {
            "s": "sin(phi)",
            "c": "cos(phi)",
            "S": "sin(u)",
            "C": "cos(u)",
            "e": "cos(theta)",
            "p": "phi",
            "a": "u",
            "L": "sin(theta) - theta*cos(theta)",
            "j": "(sin(phi + u) - (phi + u)*cos(theta) + sin(theta) - theta*cos(theta))/(2*(sin(theta) - "
            "theta*cos(theta)))",
            "k": "(sin(phi - u) - (phi - u)*cos(theta) + sin(theta) - theta*cos(theta))/(2*(sin(theta) - "
            "theta*cos(theta)))",
            "f": "2*(cos(phi)*sin(u) - u*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
            "h": "2*(sin(phi + u) - (phi + u)*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
        },
        (
            Claim(
                "closed form",
                "u from phi - a to phi + a drives, the rest brakes: L f = 2 (cos(phi) sin(a) - a cos(theta)) - L",
                "L*(2*(j - k) - 1) - (2*(c*S - a*e) - L)",
            ),
            Claim("the same f", "f is that share", "f - (2*(j - k) - 1)", (("1", (0,), "1"),)),
            Claim(
                "doubled half",
                "twice the half 0 < u < theta is off by 2 (sin(phi) cos(a) - phi cos(theta)) over L: nothing for phi "
                "= 0",
                "L*(h - f) - 2*(s*C - p*e)",
            ),
        ),
        given=(
            "2*L*j - ((s*C + c*S) - (p + a)*e + L)",
            "2*L*k - ((s*C - c*S) - (p - a)*e + L)",
            "L*f - (2*(c*S - a*e) - L)",
            "L*h - (2*((s*C + c*S) - (p + a)*e) - L)",
        ),
        positive=("L",),
        domain={"phi": (-0.2, 0.2), "u": (0.05, 0.3), "theta": (0.6, 1.4)},
    ),
    Source(
        "friction-slope",
        "A faster rotor is never driven more: the closed form falls as its driving stretch narrows",
        ("rotor-orbit", "36"),
        {
            "s": "sin(phi)",
            "c": "cos(phi)",
            "S": "sin(u)",
            "C": "cos(u)",
            "e": "cos(theta)",
            "a": "u",
            "L": "sin(theta) - theta*cos(theta)",
            "f": "2*(cos(phi)*sin(u) - u*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
            "F": "2*(cos(phi)*cos(u) - cos(theta))/(sin(theta) - theta*cos(theta))",
        },
        (
            Claim(
                "slope",
                "L df/da is the pressure at both ends, cos(phi + a) - cos(theta) and cos(phi - a) - cos(theta)",
                "L*F - (((c*C - s*S) - e) + ((c*C + s*S) - e))",
            ),
            Claim(
                "sign",
                "which is positive where both ends lie in the contact",
                "F",
                (("1", (0,), "1"),),
                (("1", (1,), "1"), ("1", (2,), "1")),
            ),
        ),
        given=("L*f - (2*(c*S - a*e) - L)",),
        positive=("L", "c*C - s*S - e", "c*C + s*S - e"),
        rates={"a": "1", "S": "C", "C": "-S", "f": "F"},
        domain={"phi": (-0.2, 0.2), "u": (0.05, 0.3), "theta": (0.6, 1.4)},
    ),
    Source(
        "conic",
        "The printed conic: on the motion at every instant, but the square of a straight line",
        ("23", "A12", "A13"),
        {
            "a": "P_A",
            "b": "P_B",
            "s": "sin(k_c*x)",
            "c": "cos(k_c*x)",
            "d": "D*k_c",
            "z": "P_A*sin(k_c*x) + P_B*cos(k_c*x)",
            "x": "D*k_c*(P_A*cos(k_c*x) - P_B*sin(k_c*x))",
            "A": "P_A**2/(D*k_c)**2",
            "B": "2*P_A*P_B/(D*k_c)",
            "E": "P_B**2",
        },
        (
            Claim(
                "line",
                "(A12), summed: P_A zeta_x/(D k_c) + P_B zeta_z = (P_A^2 + P_B^2) cos(k_c x)",
                "a*x + d*b*z - d*(a^2 + b^2)*c",
            ),
            Claim(
                "conic",
                "squared, (A13): A zeta_x^2 + P_B^2 zeta_z^2 + B zeta_x zeta_z = ((P_A^2 + P_B^2) cos(k_c x))^2",
                "A*x^2 + E*z^2 + B*x*z - ((a^2 + b^2)*c)^2",
                (("1", (0, 0), "1"),),
            ),
            Claim(
                "degenerate",
                "B^2 - 4 A C = 0: parallel lines, not an ellipse",
                "B^2 - 4*A*E",
                (("1", (0, 0), "1"),),
            ),
        ),
        given=(_TURN, "z - (a*s + b*c)", "x - d*(a*c - b*s)", "A*d^2 - a^2", "B*d - 2*a*b", "E - b^2"),
        positive=("d",),
        order="ABExzs",
    ),
    Source(
        "ellipse",
        "The path's own conic, and that it is an ellipse",
        ("A13",),
        {
            "P": "W_a",
            "R": "W_b",
            "s": "sin(omega_a*t)",
            "c": "cos(omega_a*t)",
            "S": "sin(varphi_b)",
            "C": "cos(varphi_b)",
            "a": "W_a*cos(omega_a*t)",
            "b": "W_b*cos(omega_a*t + varphi_b)",
            "l": "1/W_a**2",
            "m": "-2*cos(varphi_b)/(W_a*W_b)",
            "n": "1/W_b**2",
        },
        (
            Claim(
                "invariant",
                "phases W_a cos(alpha), W_b cos(alpha + delta) keep a conic that is free of alpha",
                "R^2*a^2 + P^2*b^2 - 2*P*R*C*a*b - P^2*R^2*S^2",
            ),
            Claim(
                "discriminant",
                "of that conic B^2 - 4 A C is minus 4 sin(delta)^2 over (W_a W_b)^2",
                "P^2*R^2*(m^2 - 4*l*n) + 4*S^2",
            ),
        ),
        given=(_TURN, "S^2 + C^2 - 1", "a - P*c", "b - R*(c*C - s*S)", "l*P^2 - 1", "n*R^2 - 1", "m*P*R + 2*C"),
        positive=("P", "R"),
        order="mlnabsS",
    ),
)


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


# --- the reading --------------------------------------------------------------------------------------------
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
            yield f"the rate of {letter} is not {_written(rate)}"


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
            yield f"{_written(terms)} is not 0"
    for terms in certificate["positive"]:
        if not _positive(_value(terms, values)):
            yield f"{_written(terms)} is not above 0"
    for claim in certificate["claims"]:
        value = _value(claim["goal"], values)
        if claim["goal"] == {"": "-1"}:  # what is given cannot hold, in real numbers
            if all(_nothing(mp.im(v)) for v in values.values()):
                yield f"{claim['name']}: real numbers do what the certificate denies"
        elif not (_positive(value) if claim["equals"] else _nothing(value)):
            yield f"{claim['name']}: {_written(claim['goal'])} is not {'above ' if claim['equals'] else ''}0"


# --- the statement, from the certificate --------------------------------------------------------------------
def _written(terms: Mapping[str, str]) -> str:
    """A polynomial in words of mathematics, from its data."""
    parts = []
    for monomial, coefficient in terms.items():
        sign, size = ("-", coefficient[1:]) if coefficient.startswith("-") else ("+", coefficient)
        body = " ".join(part for part in (size if size != "1" or not monomial else "", monomial) if part)
        parts.append(f"{sign} {body}")
    text = " ".join(parts) or "0"
    return text.removeprefix("+ ") if text.startswith("+ ") else text.replace("- ", "-", 1)


def sentence(certificate: Mapping[str, Any]) -> list[str]:
    """What a certificate proves, read from its data alone."""
    lines = ["For all real numbers with"]
    lines += [f"    {_written(terms)} = 0" for terms in certificate["given"]]
    lines += [f"    {_written(terms)} > 0" for terms in certificate["positive"]]
    if certificate["rates"]:
        rates = ", ".join(f"{letter}' = {_written(rate)}" for letter, rate in certificate["rates"].items())
        lines += [f"and the derivatives of the equations, {rates},"]
    lines += ["it follows that"]
    for claim in certificate["claims"]:
        if claim["goal"] == {"": "-1"}:
            lines.append(f"    there are no such numbers ({claim['name']})")
        else:
            relation = "> 0" if claim["equals"] else "= 0"
            lines.append(f"    {_written(claim['goal'])} {relation} ({claim['name']})")
    return lines


def page(certificates: Iterable[Mapping[str, Any]], records: Iterable[Mapping[str, Any]]) -> str:
    """docs/certificates.md: each statement beside the paper's."""
    by_id = {record["id"]: record for record in records}
    lines = [
        "# Certificates of the algebraic core",
        "",
        "Each certificate is a file in `derivations/certificates/data/` that says what is given, what follows, and the",
        "multipliers that prove it; a checker of some fifty lines replays it in exact fractions with Python's own "
        "library:",
        "",
        "    python derivations/certificates/checker.py derivations/certificates/data/*.json",
        "",
        "What is proved is printed below from the certificate's data, not from what it was made of, beside the paper's",
        "formulas.  `python -m derivations certificates` replays all, and holds what is given and every claim "
        "against the",
        "ledger's own formulas in the letters' places: a certificate that proves something else is refused.",
        "Lean would have been the stronger form; its toolchain was looked for in Debian, PyPI and npm and is in none.",
    ]
    for certificate in certificates:
        about = [by_id[name] for name in certificate["about"]]
        links = ", ".join(f"[{r['id']}](../generated/ledger.html#{anchor(r['id'])})" for r in about)
        lines += ["", f"## {certificate['title']}", "", f"About {links}.", "", "| letter | stands for |", "|---|---|"]
        lines += [f"| {letter} | `{meaning}` |" for letter, meaning in certificate["letters"].items()]
        lines += [
            f"| {letter} | the ledger's form `{name}` of ({identifier}) |"
            for letter, (identifier, name) in certificate["forms"].items()
        ]
        lines += ["", "```", *sentence(certificate), "```", ""]
        lines += [f"* {claim['name']}: {claim['says']}." for claim in certificate["claims"]]
        lines += ["", "In the paper:", ""]
        for record in about:
            for formula in record["printed_latex"] or ():
                lines.append(f"* ({record['id']}), {record['verdict']}: $`{formula}`$")
    return "\n".join(lines) + "\n"


def command(*, write: bool) -> int:
    """Replay all certificates as they lie in their files; 1 if one is refused, misread or stale."""
    from derivations.codegen.emit import GENERATED

    made = {source.name: make(source.name) for source in SOURCES}
    records = json.loads((GENERATED / "ledger.json").read_text("utf-8"))
    texts = {DATA / f"{name}.json": as_json(one) for name, one in made.items()}
    texts[GENERATED.parent / "docs" / "certificates.md"] = page(made.values(), records)
    if write:
        for path in DATA.glob("*.json"):
            path.unlink()
        for path, text in texts.items():
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, "utf-8")
    problems = [
        f"{path.name} is stale: run `python -m derivations certificates --write`"
        for path, text in texts.items()
        if not path.is_file() or path.read_text("utf-8") != text
    ]
    claims = 0
    for path in sorted(DATA.glob("*.json")):
        certificate = json.loads(path.read_text("utf-8"))
        try:
            checker.check(certificate)
            claims += len(certificate["claims"])
        except ValueError as error:
            problems.append(f"{path.name}: {error}")
        problems += [f"{path.name}: {problem}" for problem in misread(certificate)]
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(made)} certificates, {claims} claims replayed, {len(problems)} problems")
    return 1 if problems else 0
