"""Section 3.5, the conic of the particle's path: eq. (23)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import mpmath as mp
import sympy as sp

from derivations import ellipse
from derivations.ledger.exact import at_table_3, crest_states
from derivations.ledger.judge import agrees, evaluate, figure, largest, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import operating_point
from derivations.ledger.regions import rows
from derivations.ledger.section_3_phases import EQ9, corrected_10
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

x, k_c, D, W_maxf, zeta_z, zeta_x = sym("x k_c D W_maxf zeta_z zeta_x")
t, t_1, t_2, xi, omega_n, omega_q = sym("t t_1 t_2 xi omega_n omega_q")
w_A, w_B, varphi_Aredu = sym("w_A w_B varphi_Aredu")

# --- (23) ---------------------------------------------------------------------------------------------------
P_A, P_B, p_A, p_B, A_ell, B_ell, C_ell, F_ell = sym("P_A P_B p_A p_B A_ell B_ell C_ell F_ell")
_EQ23: Forms = {
    "conic": sp.Eq(A_ell * zeta_x**2 + C_ell * zeta_x**2 + B_ell * zeta_x * zeta_z, F_ell),
    "A_ell": (P_A / (D * k_c)) ** 2,
    "B_ell_redu": 2 * p_A * p_B / (W_maxf * D * k_c),
    "B_ell": 2 * P_A * P_B / (D * k_c),
    "C_ell_redu": (p_B / W_maxf) ** 2,
    "C_ell": P_B**2,
    "F_ell_redu": ((p_A**2 + p_B**2) * sp.cos(k_c * x)) ** 2,
    "F_ell": ((P_A**2 + P_B**2) * sp.cos(k_c * x)) ** 2,
    "p_A": sp.exp(-xi * omega_n * (t - t_1)) * sp.sin(omega_n * (t - t_1) + sp.pi / 2, evaluate=False),
    "p_B": sp.cos(omega_q * (t - t_1) + sp.pi / 2, evaluate=False),
    "P_A": w_A,
    "P_B_addredu": W_maxf * sp.exp(-xi * omega_n * (t - t_2)) * sp.cos(omega_n * (t - t_2) + sp.pi / 2, evaluate=False),
    "P_B_add": w_B,
}
_PER_SQUARE = {"A_ell_redu": "1/m^2", "B_ell_redu": "1/m^2", "C_ell_redu": "1/m^2", "F_ell_redu": "1"}
_UNITS_23 = {
    "A_ell": "m^2",
    "B_ell": "m^2",
    "C_ell": "m^2",
    "F_ell": "m^4",
    **_PER_SQUARE,
    "p_A": "1",
    "p_B": "1",
    "P_A": "m",
    "P_B_addredu": "m",
    "P_B_add": "m",
}


@cache
def _corrected_23() -> Forms:
    whole = {
        "A_ell": (P_A / (D * k_c)) ** 2,
        "B_ell": 2 * P_A * P_B / (D * k_c),
        "C_ell": P_B**2,
        "F_ell": ((P_A**2 + P_B**2) * sp.cos(k_c * x)) ** 2,
    }
    free_of_W = {P_A: p_A * W_maxf, P_B: p_B * W_maxf}
    redu = {f"{name}_redu": sp.factor(form.subs(free_of_W) / W_maxf**4) for name, form in whole.items()}
    conic = sp.Eq(A_ell * zeta_x**2 + C_ell * zeta_z**2 + B_ell * zeta_x * zeta_z, F_ell)
    responses = {**_responses(), "P_A": w_A, "P_B_add": w_B}
    coefficients = dict(sorted({**whole, **redu}.items(), key=lambda item: (item[0][0], -len(item[0]))))
    return {"conic": conic, **coefficients, **responses}


@cache
def _responses() -> Forms:
    """The two phases' responses by (9) and (10) put right, the first ones over W_maxf."""
    of_A, (on, off, _) = rows(EQ9["w_A"])[0].subs(varphi_Aredu, sp.pi / 2), rows(corrected_10()["w_B"])
    return {"p_A": of_A / W_maxf, "p_B": on / W_maxf, "P_B_addredu": off}


def _derive_23() -> Derivation:
    sine, cosine = sp.sin(k_c * x), sp.cos(k_c * x)
    vertical, along = P_A * sine + P_B * cosine, P_A * cosine - P_B * sine
    line = vertical * P_B + along * P_A
    forms = _corrected_23()
    values = {zeta_z: vertical, zeta_x: D * k_c * along}
    put = {A_ell: forms["A_ell"], B_ell: forms["B_ell"], C_ell: forms["C_ell"], F_ell: forms["F_ell"]}
    conic = forms["conic"].lhs - forms["conic"].rhs
    kind = ellipse.discriminant((conic + F_ell).subs(put), zeta_x, zeta_z)
    invariant = ellipse.invariant()
    angle = k_c * x
    real = sp.simplify(invariant.subs(ellipse.turned_back(zeta_x / (D * k_c), zeta_z, angle)))
    axes = ellipse.discriminant(invariant, ellipse.P_A, ellipse.P_B)
    return Derivation(
        (
            step(
                "With P_A, P_B the two responses at one instant, (11) reads:",
                sp.Eq(zeta_z, vertical),
                sp.Eq(zeta_x / (D * k_c), along),
            ),
            step(
                "P_B times the first and P_A times the second, added (A12):",
                sp.Eq(zeta_z * P_B + zeta_x / (D * k_c) * P_A, (P_A**2 + P_B**2) * cosine),
                zero=sp.expand(line - (P_A**2 + P_B**2) * cosine),
            ),
            step(
                "Squared, this is the conic of (23) and (A13), with zeta_z^2 in its second term:",
                forms["conic"],
                zero=sp.expand(conic.subs(put).subs(values)),
            ),
            step(
                "In T_redu the text takes W_maxf out of P_A and P_B; over W_maxf^4 the coefficients become",
                *(sp.Eq(sp.Symbol(name), forms[name]) for name in _PER_SQUARE),
            ),
            step(
                "Its discriminant B_ell^2 - 4 A_ell C_ell vanishes: the square of a straight line is a pair of "
                "parallel lines, not an ellipse. The line turns with P_A and P_B and meets the particle's path at "
                "that one instant.",
                sp.Eq(B_ell**2 - 4 * A_ell * C_ell, kind, evaluate=False),
                zero=kind,
            ),
            step(
                "The path itself: two phases W_a cos(alpha), W_b cos(alpha + delta) eliminate the fast angle alpha,",
                sp.Eq(invariant, 0),
            ),
            step("and with P_A, P_B turned back to the displacements at the particle:", sp.Eq(real, 0)),
            step(
                "Its discriminant is negative unless delta is a multiple of pi: an ellipse, run through in the sense "
                "of Q = D k_c W_a W_b omega sin(delta), slowly changing as delta drifts.",
                axes,
                zero=sp.simplify(axes + 4 * sp.sin(ellipse.delta) ** 2 / (ellipse.W_a * ellipse.W_b) ** 2),
            ),
        ),
        forms,
    )


def _off_the_conic(forms: Forms, state: dict[str, mp.mpf], redu: bool) -> mp.mpf:
    """How far the particle of (11) is off the conic, over the fourth power of its amplitude."""
    W, u = mp.mpf("5.5e-6"), state["k_c"] * state["x"]
    a, b, suffix = state["a"], state["b"], "_redu" if redu else ""
    names = {
        P_A: a,
        P_B: b,
        p_A: a / W,
        p_B: b / W,
        W_maxf: W,
        D: state["D"],
        k_c: state["k_c"],
        x: state["x"],
        zeta_z: a * mp.sin(u) + b * mp.cos(u),
        zeta_x: state["D"] * state["k_c"] * (a * mp.cos(u) - b * mp.sin(u)),
    }
    whole = {**_corrected_23(), **forms}  # the text has no row of A_ell in T_redu
    for symbol in (A_ell, B_ell, C_ell, F_ell):
        form = whole[symbol.name + suffix]
        names[symbol] = evaluate(form, {s: names[s] for s in form.free_symbols})
    left = whole["conic"].lhs - whole["conic"].rhs
    off = evaluate(left, {s: names[s] for s in left.free_symbols})
    return abs(off) / (a**2 + b**2) ** 2 * (W**4 if redu else 1)


_WIDE = {"t": (3e-4, 6e-4), "t_1": (0.0, 1e-6), "t_2": (1e-4, 2e-4), "W_maxf": (4e-6, 7e-6)}


def _judge_23(forms: Forms) -> Iterator[Evidence]:
    derived = _responses()
    yield agrees(
        {name: forms[name] for name in derived},
        derived,
        ranges=_WIDE,
        tolerance=1e-20,
        against="(9) and (10) put right",
    )
    yield evidence("identity", forms["P_A"] == w_A and forms["P_B_add"] == w_B, "elsewhere they are the responses")
    off = largest(_off_the_conic(forms, s, redu) for s in crest_states(8, "eq23") for redu in (False, True))
    yield evidence(
        "numeric",
        off < mp.mpf(10) ** -20,
        f"the particle is off the conic by {mp.nstr(off, 3)} of the fourth power of its amplitude at most",
    )
    both = forms["B_ell"] ** 2 - 4 * forms["A_ell"] * forms["C_ell"]
    yield evidence("domain", vanishes(both), "discriminant 0: a pair of parallel lines at every instant")


def _repair_23(forms: Forms) -> Forms:
    """zeta_z^2 for the second zeta_x^2, W_maxf once more in B_ell's first row, B's amplitude from (10) put right."""
    conic = forms["conic"]
    left = conic.lhs - C_ell * zeta_x**2 + C_ell * zeta_z**2
    return {
        **forms,
        "conic": sp.Eq(left, conic.rhs),
        "B_ell_redu": forms["B_ell_redu"] / W_maxf,
        "P_B_addredu": forms["P_B_addredu"] * omega_q / omega_n,
    }


def _effect_23() -> str:
    cycle = at_table_3()
    q = operating_point()
    time = cycle.durations()[0] / 7
    a, b = (cycle.response(p, "redu", time)[0] for p in "AB")
    printed = ((a / (q["D"] * q["k_c"])) ** 2 + b**2) * (q["D"] * q["k_c"] * a) ** 2
    right = (a**2 + b**2) ** 2
    return (
        "At Table 3, from a steady start, x = 0 and a seventh into T_redu, the printed left side is "
        f"{figure(100 * printed / right - 100, 3)} % off "
        "the right side. Even put right, the conic is a pair of parallel lines, so it cannot give Figs. 9, 12 and 15, "
        "which need (11)."
    )


ENTRIES = (
    Entry(
        id="23",
        section="3.5",
        title="Conic of the particle's path",
        place="Sect. 3.5",
        printed=_EQ23,
        units=_UNITS_23,
        verdict="erratum",
        reason="zeta_x^2 stands twice, zeta_z^2 is missing; in T_redu, whose P are free of W_maxf, B_ell needs its "
        "square; P_B in T_addredu has (10)'s amplitude, and is called P_Bredu there. Put right it holds at "
        "every instant, but as the square of a straight line, not as an ellipse. "
        "The text at hand has no row of A_ell for T_redu; the other rows ask for (P_Aredu/(W_maxf D k_c))^2.",
        judge=_judge_23,
        derive=_derive_23,
        effect=_effect_23,
        repair=_repair_23,
        found_by=("dimension", "numeric"),
    ),
)
