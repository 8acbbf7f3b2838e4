"""Section 3.4, place, displacement and velocity of the wave crest: eqs. (20) to (22)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import determinant
from derivations.ledger.course import Lap, extremes, mean, share
from derivations.ledger.exact import REGIONS, at_table_3, crest_states, vertical_displacement
from derivations.ledger.history import Array, History, values
from derivations.ledger.judge import evaluate, figure, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.regions import rows
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

x, t, k_c, D, x_max, w_A, w_B = sym("x t k_c D x_max w_A w_B")
_SHAPE = w_A * sp.sin(k_c * x) + w_B * sp.cos(k_c * x)
_a, _b, _da, _db = sp.symbols("a b da db", real=True)


def _at_state(expr: sp.Basic, state: dict[str, mp.mpf]) -> mp.mpf:
    """Value of an expression in w_A(t), w_B(t) and their rates."""
    plain = expr.doit().subs({w_A.diff(t): _da, w_B.diff(t): _db}).subs({w_A: _a, w_B: _b})
    return evaluate(plain, {symbol: state[symbol.name] for symbol in plain.free_symbols})


# --- (20) ---------------------------------------------------------------------------------------------------
_EQ20: Forms = {
    "x_max": sp.Piecewise(
        (sp.atan(w_A / w_B) / k_c, sp.Ge(sp.cos(k_c * x), 0)),
        ((sp.atan(w_A / w_B) + sp.pi) / k_c, sp.Lt(sp.cos(k_c * x), 0)),
        evaluate=False,
    )
}


def _derive_20() -> Derivation:
    slope = _SHAPE.diff(x) / k_c
    length = sp.sqrt(w_A**2 + w_B**2)
    crest = {sp.sin(k_c * x): w_A / length, sp.cos(k_c * x): w_B / length}
    return Derivation(
        (
            step(
                "At a crest the slope, not the vertical velocity, is zero (the text says the velocity and writes the "
                "slope):",
                sp.Eq(_SHAPE.diff(x), 0),
            ),
            step(
                "This leaves two places half a wavelength apart, the crest and the trough; at the crest sine and "
                "cosine of k_c x have the signs of w_A and w_B:",
                sp.Eq(sp.sin(k_c * x), w_A / length),
                sp.Eq(sp.cos(k_c * x), w_B / length),
                zero=slope.subs(crest),
            ),
            step(
                "There the displacement is the largest possible, positive:",
                length,
                zero=sp.simplify(_SHAPE.subs(crest) - length),
            ),
            step(
                "So the branch follows the sign of w_B, and both rows are one function:",
                sp.Eq(x_max, sp.atan2(w_A, w_B) / k_c),
            ),
        ),
        {"x_max": sp.atan2(w_A, w_B) / k_c},
    )


def _judge_20(forms: Forms) -> Iterator[Evidence]:
    form = forms["x_max"]
    flat = high = True
    for state in crest_states(16, "eq20"):
        place = _at_state(form, state)
        k, a, b = state["k_c"], state["a"], state["b"]
        size = mp.sqrt(a**2 + b**2)
        flat &= bool(abs(a * mp.cos(k * place) - b * mp.sin(k * place)) < mp.mpf(10) ** -25 * size)
        high &= bool(abs(a * mp.sin(k * place) + b * mp.cos(k * place) - size) < mp.mpf(10) ** -25 * size)
    yield evidence("identity", flat, "the slope is zero at x_max")
    yield evidence(
        "numeric",
        high,
        "x_max is the crest, not the trough, in all four quadrants of (w_A, w_B), wherever the particle x is",
    )
    yield evidence("domain", not form.has(x), "the crest's place depends on the phases only, not on the particle's x")


def _repair_20(forms: Forms) -> Forms:
    """The same branches by the sign of w_B."""
    first, second = rows(forms["x_max"])
    return {"x_max": sp.Piecewise((first, sp.Ge(w_B, 0)), (second, sp.Lt(w_B, 0)))}


def _effect_20() -> str:
    lap = Lap("steady")
    wrong = share(lambda h: -h.w_B, lap)
    return (
        "For a particle at x = 0, cos(k_c x) = 1 always picks the first row: for "
        f"{figure(100 * wrong, 3)} % of the cycle at Table 3, from a steady start, that is the trough, "
        f"{figure(1000 * mp.pi / at_table_3()['k_c'], 4)} mm from the crest, where the determinant's sign is the same "
        "but displacement and velocity both change sign."
    )


# --- (21), (22) ---------------------------------------------------------------------------------------------
_EQ21: Forms = {"zeta_zmax": _SHAPE.subs(x, x_max)}
_EQ22: Forms = {"v_xmax": sp.Derivative(_SHAPE.subs(x, x_max), t)}


def _at_crest(expr: sp.Basic, state: dict[str, mp.mpf]) -> mp.mpf:
    return _at_state(expr.doit().subs(x_max, sp.atan2(_a, _b) / k_c), state)


def _derive_21() -> Derivation:
    length = sp.sqrt(w_A**2 + w_B**2)
    crest = {sp.sin(k_c * x_max): w_A / length, sp.cos(k_c * x_max): w_B / length}
    return Derivation(
        (
            step("Eq. (11) at the crest:", _EQ21["zeta_zmax"]),
            step(
                "With the sine and cosine that belong to the crest (20) it is the length of (w_A, w_B), never "
                "negative:",
                length,
                zero=sp.simplify(_EQ21["zeta_zmax"].subs(crest) - length),
            ),
        ),
        {"zeta_zmax": length},
    )


def _judge_21(forms: Forms) -> Iterator[Evidence]:
    form, worst_ = forms["zeta_zmax"], mp.mpf(0)
    highest = True
    for state in crest_states(12, "eq21"):
        value, k = _at_crest(form, state), state["k_c"]
        grid = [state["a"] * mp.sin(k * u) + state["b"] * mp.cos(k * u) for u in mp.linspace(0, 2 * mp.pi / k, 50)]
        size = mp.sqrt(state["a"] ** 2 + state["b"] ** 2)
        worst_ = worse(worst_, abs(value / size - 1))
        highest &= bool(value >= max(grid))
    yield evidence(
        "numeric", worst_ < mp.mpf(10) ** -25, f"is the length of (w_A, w_B) to {mp.nstr(worst_, 2)} relative"
    )
    yield evidence("domain", highest, "no other place of the wave is higher; never negative")


def _wave_of(state: dict[str, mp.mpf], place: mp.mpf, later: mp.mpf) -> mp.mpf:
    """(11) at a place, a moment after the state."""
    a, b = state["a"] + later * state["da"], state["b"] + later * state["db"]
    return vertical_displacement(a, b, state["k_c"], place)


def _derive_22() -> Derivation:
    length = sp.sqrt(w_A**2 + w_B**2)
    velocity = D * k_c * (w_A.diff(t) * sp.cos(k_c * x_max) - w_B.diff(t) * sp.sin(k_c * x_max))
    crest = {sp.sin(k_c * x_max): w_A / length, sp.cos(k_c * x_max): w_B / length}
    return Derivation(
        (
            step(
                "A tangential velocity is the rate of the tangential displacement zeta_x = D d(zeta_z)/dx, at a "
                "fixed place:",
                D * sp.Derivative(_SHAPE, x, t),
                zero=(D * _SHAPE.diff(x, t)).subs(x, x_max) - velocity,
            ),
            step(
                "At the crest it is the determinant Q (24) over the crest's height, so that (42) holds:",
                determinant.determinant() / length,
                zero=sp.simplify(velocity.subs(crest) - determinant.determinant() / length),
            ),
            step("The print differentiates zeta_z, the vertical displacement: that is the crest's vertical velocity."),
        ),
        {"v_xmax": velocity},
    )


def _judge_22(forms: Forms) -> Iterator[Evidence]:
    form, worst_, most = forms["v_xmax"], mp.mpf(0), mp.mpf(0)
    for state in crest_states(12, "eq22"):
        value, k = _at_crest(form, state), state["k_c"]
        place = mp.atan2(state["a"], state["b"]) / k
        wanted = state["D"] * mp.diff(partial(_wave_of, state), (place, 0), (1, 1))
        worst_ = worse(worst_, abs(value - wanted))
        q = state["da"] * state["b"] - state["db"] * state["a"]
        product = mp.sqrt(state["a"] ** 2 + state["b"] ** 2) * value
        most = worse(most, abs(product - state["D"] * k * q))
    yield evidence(
        "numeric",
        worst_ < mp.mpf(10) ** -12,
        f"off the rate of zeta_x, derivatives taken numerically, by {mp.nstr(worst_, 3)} m/s at most",
    )
    yield evidence("identity", most < mp.mpf(10) ** -25, "zeta_zmax v_xmax is the determinant (42)")


def _repair_22(forms: Forms) -> Forms:
    """Differentiate D d(zeta_z)/dx in place of zeta_z."""
    inner = forms["v_xmax"]
    if isinstance(inner, sp.Derivative):
        moved = inner.expr.subs(x_max, x)
        return {"v_xmax": sp.Derivative(D * moved.diff(x), t).doit().subs(x, x_max)}
    return forms


def _effect_22() -> str:
    lap, p = Lap("steady"), values()
    height = lap.at(np.array([0.0, lap.length])).W_c
    mean_printed = float(height[1] - height[0]) / lap.length

    def along(h: History) -> Array:
        return p["D"] * p["k_c"] * h.q / h.W_c

    printed, derived = extremes(lambda h: h.W_c_rate, lap), extremes(along, lap)
    return (
        "Over the cycle at Table 3, from a steady start, phase lead +1, the printed velocity averages "
        f"{figure(mean_printed, 3)} m/s, the change of the crest's height over the cycle's time, and runs from "
        f"{figure(printed[0], 3)} to {figure(printed[1], 3)} m/s; the tangential one averages "
        f"{figure(mean(along, lap), 3)} m/s and runs from {figure(derived[0], 3)} to {figure(derived[1], 3)} m/s."
    )


def _picture_22() -> Picture:
    cycle = at_table_3()
    curves: dict[str, tuple[list[float], list[float]]] = {"(22) as printed": ([], []), "tangential velocity": ([], [])}
    start = mp.mpf(0)
    for region, length in zip(REGIONS, cycle.durations(), strict=True):
        for tau in cycle.times(region, 100):
            (a, da), (b, db) = (cycle.response(p, region, tau) for p in "AB")
            height = mp.sqrt(a**2 + b**2)
            values = (a * da + b * db) / height, cycle["D"] * cycle["k_c"] * (da * b - db * a) / height
            for curve, value in zip(curves.values(), values, strict=True):
                curve[0].append(float(1000 * (start + tau)))
                curve[1].append(float(value))
        start += length
    return Picture("Velocity of the crest over a cycle of 14 in 20 pulses", "t - t_1, ms", "m/s", curves)


ENTRIES = (
    Entry(
        id="20",
        section="3.4",
        title="Place of the crest",
        place="Sect. 3.4",
        printed=_EQ20,
        units={"x_max": "m"},
        verdict="erratum",
        reason="The arctangent is right up to half a wavelength, but cos(k_c x) of the particle cannot choose between "
        "crest and trough: the sign of w_B does. It is the slope that vanishes at a crest, not the vertical "
        "velocity.",
        judge=_judge_20,
        derive=_derive_20,
        effect=_effect_20,
        repair=_repair_20,
        found_by=("numeric", "domain"),
    ),
    Entry(
        id="21",
        section="3.4",
        title="Displacement of the crest",
        place="Sect. 3.4",
        printed=_EQ21,
        units={"zeta_zmax": "m"},
        verdict="verified",
        reason="With the crest's place of (20) put right it is sqrt(w_A^2 + w_B^2).",
        judge=_judge_21,
        derive=_derive_21,
        effect=lambda: "None: printed and derived agree, given x_max at the crest.",
    ),
    Entry(
        id="22",
        section="3.4",
        title="Tangential velocity of the crest",
        place="Sect. 3.4",
        printed=_EQ22,
        units={"v_xmax": "m/s"},
        verdict="erratum",
        reason="Differentiates zeta_z, the vertical displacement, where zeta_x is meant.",
        judge=_judge_22,
        derive=_derive_22,
        effect=_effect_22,
        repair=_repair_22,
        found_by=("numeric", "identity"),
        picture=_picture_22,
    ),
)
