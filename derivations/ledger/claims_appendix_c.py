"""Statements in words of Appendix C.2, on how the volatility determinant changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp

from derivations.ledger.appendix_b_c import differs_by_start
from derivations.ledger.history import Array
from derivations.ledger.judge import figure
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.witness import Drive
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

(T,) = sym("T")
X, Y, Q_aver = sym("X Y Q_aver")


# --- monotonicity of Appendix C.2 ---------------------------------------------------------------------------
_SIGNS: Forms = {"sign_dz": sp.Integer(1)}


def _derive_signs() -> Derivation:
    z = (X + 1) / ((X - 1) * T)  # 1/(T^2 Q_aver) by (A14)
    slope = sp.factor(z.diff(X))
    return Derivation(
        (
            step("By (A14), z = 1/(T^2 Q_aver) in X is", z, zero=z - 1 / (T**2 * ((X - 1) / ((X + 1) * T)))),
            step(
                "It falls on either side of its pole X = 1; on Y it does not depend:",
                slope,
                zero=sp.simplify(slope + 2 / ((X - 1) ** 2 * T)),
            ),
        ),
        {"sign_dz": sp.Integer(-1)},
    )


def _judge_signs(forms: Forms) -> Iterator[Evidence]:
    stated = int(forms["sign_dz"])
    z = (
        [(ratio, (ratio + 1) / (ratio - 1)) for ratio in (0.2, 0.3, 0.8, 0.9)],
        [(ratio, (ratio + 1) / (ratio - 1)) for ratio in (1.1, 1.2, 2.0, 5.0)],
    )
    signs = {int(math.copysign(1, b - a)) for branch in z for (_, a), (_, b) in pairwise(branch)}
    yield evidence(
        "numeric", signs == {stated}, f"z between neighbouring X on both sides of 1 changes with sign {signs}"
    )
    low, high = sp.limit((X + 1) / (X - 1), X, 1, "+"), sp.limit((X + 1) / (X - 1), X, sp.oo)
    yield evidence(
        "limit", stated == sp.sign(high - 1000) and low == sp.oo, "from infinity at X = 1 to 1/T for X -> infinity"
    )


def _effect_signs() -> str:
    return (
        "f falls and z falls for X, Y > 1, so Q_vib does fall as both grow, as the text concludes; with the stated "
        "rising z the product of a falling and a rising factor would have no definite trend. Q_aver depends on X, not "
        "on Y."
    )


_TREND: Forms = {"trend_above": sp.Integer(-1), "trend_below": sp.Integer(1)}


def _cycles(X_ratio: float, Y_ratio: float) -> tuple[Array, Array]:
    """Times and values of a Q in two steps, forward and backward, whose sums and sums of squares have these ratios."""
    back = X_ratio / Y_ratio
    return np.array([X_ratio, 1 / back]), np.array([1.0, -back])


def _measures(weights: Array, Q: Array) -> tuple[float, float]:
    """Q_aver and Q_vib for T = 1, from the sums of Q over both senses of turning."""
    signed, size = float(weights @ Q), float(weights @ np.abs(Q))
    return signed / size, math.sqrt(float(weights @ Q**2) / abs(float(weights @ (Q * np.abs(Q))))) / (signed / size)


def _trends(average: int) -> dict[str, set[int]]:
    """Signs of the change of Q_vib as Y rises at a constant Q_aver of one sign: above and below Y = 1."""
    found: dict[str, set[int]] = {}
    for key, ratios in (("trend_above", np.linspace(1.05, 1.9, 12)), ("trend_below", np.linspace(0.55, 0.95, 12))):
        volatilities = [_measures(*_cycles(2.0 if average > 0 else 0.5, float(ratio)))[1] for ratio in ratios]
        found[key] = {int(s) for s in np.sign(np.diff(volatilities))}
    return found


@cache
def _against_the_sign() -> tuple[float, float]:
    """X and Y of a cycle with Y < 1 in which forward turning prevails: lead -1, 55 of 100 pulses, 4000 Hz, periodic."""
    Q = Drive("periodic", 100, 55, 4000.0, -1).phases().q
    forward, backward = np.maximum(Q, 0), np.maximum(-Q, 0)
    return float(forward.sum() / backward.sum()), float((forward**2).sum() / (backward**2).sum())


def _derive_trend() -> Derivation:
    root = sp.sqrt((Y + 1) / sp.Abs(Y - 1))
    above, below = sp.Symbol("g", positive=True), sp.Symbol("e", positive=True)
    seen = _against_the_sign()
    average = sp.sign(Q_aver)
    return Derivation(
        (
            step(
                "Q_vib = f(Y)/(T^2 Q_aver), with f = ((Y + 1)/|Y - 1|)^(1/2) > 0 (A16 put right). At constant Q_aver "
                "and T its trend is that of f, times the sign of Q_aver:",
                root / (T**2 * Q_aver),
            ),
            step(
                "Above 1, Y = 1 + g, f falls; below, Y = 1 - e, it rises with Y:",
                sp.sqrt((above + 2) / above),
                sp.sqrt((2 - below) / below),
                zero=[
                    sp.simplify(((above + 2) / above).diff(above) + 2 / above**2),
                    sp.simplify(((2 - below) / below).diff(below) + 2 / below**2),
                ],
            ),
            step(
                "So both stated trends are right where Q_aver > 0 and both turn round where Q_aver < 0.",
                -average,
                average,
            ),
            step(
                "The sign of Q_aver is that of X - 1 (A14), a ratio of sums, Y one of sums of squares: neither bounds "
                "the other's side of 1: any two positive numbers are X and Y of some Q in two steps. A drive of the "
                "motor shows it: 55 of 100 pulses, 4000 Hz, phase lead -1, periodic, "
                f"has X = {seen[0]:.3f} and Y = {seen[1]:.3f}, forward turning longer and weaker, and with phase lead "
                "+1, where Q changes its sign, X and Y are the inverse."
            ),
            step(
                "X and Y of one cycle change together, so along a change of the drive Q_vib need not follow either "
                "trend."
            ),
        ),
        {"trend_above": -average, "trend_below": average},
    )


def _judge_trend(forms: Forms) -> Iterator[Evidence]:
    wrong, listed = [], []
    for average in (1, -1):
        found = _trends(average)
        listed += [f"{key} {sorted(signs)} for Q_aver {'>' if average > 0 else '<'} 0" for key, signs in found.items()]
        wrong += [key for key, signs in found.items() if signs != {int(forms[key].subs(Q_aver, average))}]
    yield evidence(
        "numeric",
        not wrong,
        "Q_vib over rising Y at constant Q_aver, from the sums of a Q in two steps: " + ", ".join(listed),
    )
    poles = [sp.limit((Y + 1) / (Y - 1), Y, 1, "+"), sp.limit((Y + 1) / (1 - Y), Y, 1, "-")] == [sp.oo, sp.oo]
    towards = {("trend_above", a): -a for a in (1, -1)} | {("trend_below", a): a for a in (1, -1)}
    yield evidence(
        "limit",
        poles and all(forms[key].subs(Q_aver, a) == sign for (key, a), sign in towards.items()),
        "towards Y = 1 from either side Q_vib grows without bound in the sense of Q_aver",
    )


def _effect_trend() -> str:
    X_seen, Y_seen = _against_the_sign()
    return (
        "Where Q_aver < 0 both stated trends turn round. At Table 3, phase lead +1: "
        f"{differs_by_start()}. The two ratios may lie on different sides of 1: 55 of 100 pulses, 4000 Hz, phase lead "
        f"-1, periodic, X = {figure(X_seen)}, Y = {figure(Y_seen, 3)}."
    )


def _entry(identifier: str, **fields: Any) -> Entry:  # noqa: ANN401
    return Entry(id=identifier, **{"units": {}, **fields})


ENTRIES = (
    _entry(
        "claim-z",
        section="C.2",
        place="Appendix C.2",
        title="'z(Y) is a monotonically increasing function'",
        printed=_SIGNS,
        verdict="erratum",
        judge=_judge_signs,
        derive=_derive_signs,
        effect=_effect_signs,
        repair=lambda forms: {"sign_dz": -forms["sign_dz"]},
        found_by=("numeric", "limit"),
        reason="z depends on X through Q_aver, not on Y, and falls.",
    ),
    _entry(
        "claim-Q_vib",
        section="C.2",
        place="Appendix C.2",
        title="Trend of Q_vib with Y",
        printed=_TREND,
        verdict="erratum",
        judge=_judge_trend,
        derive=_derive_trend,
        effect=_effect_trend,
        repair=lambda forms: {key: form * sp.sign(Q_aver) for key, form in forms.items()},
        found_by=("numeric", "limit"),
        reason="Right where Q_aver > 0, at constant Q_aver and T; where Q_aver < 0 both trends turn round. On which "
        "side of 1 Y lies does not tell the sign of Q_aver.",
    ),
)
