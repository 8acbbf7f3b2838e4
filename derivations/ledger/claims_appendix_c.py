"""Statements in words of Appendix C.2, on how the volatility determinant changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp

from derivations.ledger.appendix_b_c import differs_by_start
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

(T,) = sym("T")
(X,) = sym("X")


# --- monotonicity of Appendix C.2 ---------------------------------------------------------------------------
_SIGNS: Forms = {"sign_dz": sp.Integer(1)}


def _derive_signs() -> Derivation:
    z = (X + 1) / ((X - 1) * T)  # 1/(T^2 Q_aver) by (A14)
    slope = sp.factor(z.diff(X))
    return Derivation(
        (
            step("By (A14), z = 1/(T^2 Q_aver) in X is", z, zero=z - 1 / (T**2 * ((X - 1) / ((X + 1) * T)))),
            step("It falls on either side of its pole X = 1; on Y it does not depend:", slope,
                 zero=sp.simplify(slope + 2 / ((X - 1) ** 2 * T))),
        ),
        {"sign_dz": sp.Integer(-1)},
    )  # fmt: skip


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


def _trends() -> dict[str, set[int]]:
    """Signs of the change of Q_vib, with its sign, along cycles whose forward share rises: above and below Y = 1."""
    time = np.linspace(0, 1, 4001)
    found: dict[str, set[int]] = {"trend_above": set(), "trend_below": set()}
    for biases in (np.linspace(0.05, 0.6, 12), np.linspace(-0.6, -0.05, 12)):
        measures = []
        for bias in biases:
            Q = np.sin(2 * np.pi * time) + bias
            signed = (Q * np.abs(Q)).sum()
            measures.append(math.sqrt((Q**2).sum() / abs(signed)) / (Q.sum() / np.abs(Q).sum()))
        label = "trend_above" if biases[0] > 0 else "trend_below"
        found[label] = {int(s) for s in np.sign(np.diff(measures))}
    return found


def _derive_trend() -> Derivation:
    a = sp.Symbol("a", positive=True)
    return Derivation(
        (
            step("X and Y pass 1 together when backward turning takes over, and rise together. Above 1 both factors "
                 "are positive and fall: Q_vib falls."),
            step("Below 1 z is negative and falls, f is positive and rises (A17 put right): their product falls as "
                 "well; only its magnitude rises. For X = Y = 1 - a:",
                 -(2 - a) / a * sp.sqrt((2 - a) / a),
                 zero=sp.simplify((((2 - a) / a) ** 3).diff(a) + 6 * (2 - a) ** 2 / a**4)),
        ),
        {"trend_above": sp.Integer(-1), "trend_below": sp.Integer(-1)},
    )  # fmt: skip


def _judge_trend(forms: Forms) -> Iterator[Evidence]:
    found = _trends()
    listed = ", ".join(f"{key} {sorted(signs)}" for key, signs in found.items())
    yield evidence("numeric", all(signs == {int(forms[key])} for key, signs in found.items()),
                   f"Q_vib along cycles that turn ever more forward: {listed}")  # fmt: skip
    above, below = (sp.limit((X + 1) / (X - 1), X, 1, side) for side in "+-")
    towards = {"trend_above": -1 if above == sp.oo else 1, "trend_below": -1 if below == -sp.oo else 1}
    yield evidence("limit", all(int(forms[key]) == sign for key, sign in towards.items()),
                   "falls to -infinity as X rises to 1, and from +infinity beyond")  # fmt: skip


def _effect_trend() -> str:
    return (
        "Q_vib jumps from -infinity to +infinity where forward turning comes to prevail. At Table 3, phase lead +1: "
        f"{differs_by_start()}."
    )


def _entry(identifier: str, **fields: Any) -> Entry:  # noqa: ANN401
    return Entry(id=identifier, **{"units": {}, **fields})


ENTRIES = (
    _entry(
        "claim-z", section="C.2", place="Appendix C.2", title="'z(Y) is a monotonically increasing function'",
        printed=_SIGNS, verdict="erratum", judge=_judge_signs, derive=_derive_signs, effect=_effect_signs,
        repair=lambda forms: {"sign_dz": -forms["sign_dz"]}, found_by=("numeric", "limit"),
        reason="z depends on X through Q_aver, not on Y, and falls.",
    ),
    _entry(
        "claim-Q_vib", section="C.2", place="Appendix C.2", title="Trend of Q_vib with Y", printed=_TREND,
        verdict="erratum", judge=_judge_trend, derive=_derive_trend, effect=_effect_trend,
        repair=lambda forms: {**forms, "trend_below": -forms["trend_below"]}, found_by=("numeric", "limit"),
        reason="Right for Y > 1; for Y < 1 Q_aver is negative and Q_vib, with its sign, falls too.",
    ),
)  # fmt: skip
