"""Sections 3.4 and 3.5, wave crest, ellipse and direction determinant: eqs. (20) to (24)."""

from __future__ import annotations

import random
from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations import determinant, ellipse
from derivations.ledger.exact import REGIONS, Cycle, at_table_3
from derivations.ledger.judge import evaluate, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.operating import operating_point
from derivations.ledger.regions import by_region, context, row_value, rows, worst
from derivations.ledger.section_3_phases import EQ9, corrected_10, rotating_vector
from derivations.nomenclature import sym
from trum_sym.units import Dimension, parse_unit

__all__ = ["ENTRIES", "error_24"]

x, t, k_c, D, x_max, W_maxf = sym("x t k_c D x_max W_maxf")
w_A, w_B, zeta_z, zeta_x = sym("w_A w_B zeta_z zeta_x")
W_a, W_b, omega_n, omega_q, xi = sym("W_a W_b omega_n omega_q xi")
t_1, t_2, t_3 = sym("t_1 t_2 t_3")
A_AB, Theta_A, Psi_A, varphi_A = sym("A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu")
A_Badd, Theta_B, Psi_B, varphi_B = sym("A_Badd Theta_Badd Psi_Badd varphi_Badd")
_SHAPE = w_A * sp.sin(k_c * x) + w_B * sp.cos(k_c * x)
mean = (omega_n + omega_q) / 2
half_A, half_B = (Theta_A + Psi_A) / 2, (Theta_B + Psi_B) / 2


def _states(count: int, seed: str) -> list[dict[str, mp.mpf]]:
    """Displacements and velocities of the phases in all four quadrants, a place, D and k_c."""
    found = []
    q = operating_point()
    for index in range(count):
        draw = random.Random(f"{seed} {index}")
        signs = (1 if index & 1 else -1, 1 if index & 2 else -1)
        found.append({
            "a": signs[0] * mp.mpf(draw.uniform(1e-6, 9e-6)), "b": signs[1] * mp.mpf(draw.uniform(1e-6, 9e-6)),
            "da": mp.mpf(draw.uniform(-1, 1)), "db": mp.mpf(draw.uniform(-1, 1)),
            "x": mp.mpf(draw.uniform(-0.01, 0.01)), "D": q["D"], "k_c": q["k_c"],
        })  # fmt: skip
    return found


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
    )
}


def _derive_20() -> Derivation:
    slope = _SHAPE.diff(x) / k_c
    length = sp.sqrt(w_A**2 + w_B**2)
    crest = {sp.sin(k_c * x): w_A / length, sp.cos(k_c * x): w_B / length}
    return Derivation(
        (
            step("At a crest the slope, not the vertical velocity, is zero (the text says the velocity and writes the "
                 "slope):", sp.Eq(_SHAPE.diff(x), 0)),
            step("This leaves two places half a wavelength apart, the crest and the trough; at the crest sine and cosine of "
                 "k_c x have the signs of w_A and w_B:", sp.Eq(sp.sin(k_c * x), w_A / length),
                 sp.Eq(sp.cos(k_c * x), w_B / length), zero=slope.subs(crest)),
            step("There the displacement is the largest possible, positive:", length,
                 zero=sp.simplify(_SHAPE.subs(crest) - length)),
            step("So the branch follows the sign of w_B, and both rows are one function:",
                 sp.Eq(x_max, sp.atan2(w_A, w_B) / k_c)),
        ),
        {"x_max": sp.atan2(w_A, w_B) / k_c},
    )  # fmt: skip


def _judge_20(forms: Forms) -> Iterator[Evidence]:
    form = forms["x_max"]
    flat = high = True
    for state in _states(16, "eq20"):
        place = _at_state(form, state)
        k, a, b = state["k_c"], state["a"], state["b"]
        size = mp.sqrt(a**2 + b**2)
        flat &= bool(abs(a * mp.cos(k * place) - b * mp.sin(k * place)) < mp.mpf(10) ** -25 * size)
        high &= bool(abs(a * mp.sin(k * place) + b * mp.cos(k * place) - size) < mp.mpf(10) ** -25 * size)
    yield evidence("identity", flat, "the slope is zero at x_max")
    yield evidence("numeric", high, "x_max is the crest, not the trough, in all four quadrants of (w_A, w_B), wherever the "
                   "particle x is")  # fmt: skip
    yield evidence("domain", not form.has(x), "the crest's place depends on the phases only, not on the particle's x")


def _repair_20(forms: Forms) -> Forms:
    first, second = rows(forms["x_max"])
    return {"x_max": sp.Piecewise((first, sp.Ge(w_B, 0)), (second, sp.Lt(w_B, 0)))}


def _effect_20() -> str:
    cycle = at_table_3()
    wrong = total = 0
    for region in REGIONS:
        for tau in cycle.times(region, 40):
            total += 1
            wrong += cycle.response("B", region, tau)[0] < 0
    return (
        f"For a particle at x = 0, cos(k_c x) = 1 always picks the first row: at {wrong} of {total} instants of the cycle that "
        f"is the trough, {mp.nstr(1000 * mp.pi / cycle['k_c'], 4)} mm from the crest, where the determinant's sign is the same "
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
            step("With the sine and cosine that belong to the crest (20) it is the length of (w_A, w_B), never negative:",
                 length, zero=sp.simplify(_EQ21["zeta_zmax"].subs(crest) - length)),
        ),
        {"zeta_zmax": length},
    )  # fmt: skip


def _judge_21(forms: Forms) -> Iterator[Evidence]:
    form, worst_ = forms["zeta_zmax"], mp.mpf(0)
    highest = True
    for state in _states(12, "eq21"):
        value, k = _at_crest(form, state), state["k_c"]
        grid = [state["a"] * mp.sin(k * u) + state["b"] * mp.cos(k * u) for u in mp.linspace(0, 2 * mp.pi / k, 50)]
        size = mp.sqrt(state["a"] ** 2 + state["b"] ** 2)
        worst_ = max(worst_, abs(value / size - 1))
        highest &= bool(value >= max(grid))
    yield evidence(
        "numeric", worst_ < mp.mpf(10) ** -25, f"is the length of (w_A, w_B) to {mp.nstr(worst_, 2)} relative"
    )
    yield evidence("domain", highest, "no other place of the wave is higher; never negative")


def _derive_22() -> Derivation:
    length = sp.sqrt(w_A**2 + w_B**2)
    velocity = D * k_c * (w_A.diff(t) * sp.cos(k_c * x_max) - w_B.diff(t) * sp.sin(k_c * x_max))
    crest = {sp.sin(k_c * x_max): w_A / length, sp.cos(k_c * x_max): w_B / length}
    return Derivation(
        (
            step("A tangential velocity is the rate of the tangential displacement zeta_x = D d(zeta_z)/dx, at a fixed place:",
                 D * sp.Derivative(_SHAPE, x, t), zero=(D * _SHAPE.diff(x, t)).subs(x, x_max) - velocity),
            step("At the crest it is the determinant Q (24) over the crest's height, so that (42) holds:",
                 determinant.determinant() / length,
                 zero=sp.simplify(velocity.subs(crest) - determinant.determinant() / length)),
            step("The print differentiates zeta_z, the vertical displacement: that is the crest's vertical velocity."),
        ),
        {"v_xmax": velocity},
    )  # fmt: skip


def _judge_22(forms: Forms) -> Iterator[Evidence]:
    form, worst_, most = forms["v_xmax"], mp.mpf(0), mp.mpf(0)
    for state in _states(12, "eq22"):
        value, k = _at_crest(form, state), state["k_c"]
        place = mp.atan2(state["a"], state["b"]) / k
        # zeta_x a moment later less now, by numerical differentiation of (11) in x and t
        zeta = lambda u, h, s=state: (
            (s["a"] + h * s["da"]) * mp.sin(s["k_c"] * u) + (s["b"] + h * s["db"]) * mp.cos(s["k_c"] * u)
        )
        wanted = state["D"] * mp.diff(lambda h: mp.diff(lambda u, h=h: zeta(u, h), place), 0)
        worst_ = max(worst_, abs(value - wanted))
        q = state["da"] * state["b"] - state["db"] * state["a"]
        product = mp.sqrt(state["a"] ** 2 + state["b"] ** 2) * value
        most = max(most, abs(product - state["D"] * k * q))
    yield evidence("numeric", worst_ < mp.mpf(10) ** -12,
                   f"off the rate of zeta_x, derivatives taken numerically, by {mp.nstr(worst_, 3)} m/s at most")  # fmt: skip
    yield evidence("identity", most < mp.mpf(10) ** -25, "zeta_zmax v_xmax is the determinant (42)")


def _repair_22(forms: Forms) -> Forms:
    """Differentiate D d(zeta_z)/dx in place of zeta_z."""
    inner = forms["v_xmax"]
    if isinstance(inner, sp.Derivative):
        moved = inner.expr.subs(x_max, x)
        return {"v_xmax": sp.Derivative(D * moved.diff(x), t).doit().subs(x, x_max)}
    return forms


def _effect_22() -> str:
    cycle = at_table_3()
    printed, derived = [], []
    for region in REGIONS:
        for tau in cycle.times(region, 40):
            (a, da), (b, db) = (cycle.response(p, region, tau) for p in "AB")
            length = mp.sqrt(a**2 + b**2)
            printed.append((a * da + b * db) / length)
            derived.append(cycle["D"] * cycle["k_c"] * (da * b - db * a) / length)
    average = lambda values: mp.fsum(values) / len(values)  # noqa: E731
    return (
        f"Over the cycle the printed velocity averages {mp.nstr(average(printed), 3)} m/s and runs from "
        f"{mp.nstr(min(printed), 3)} to {mp.nstr(max(printed), 3)} m/s; the tangential one averages "
        f"{mp.nstr(average(derived), 3)} m/s and runs from {mp.nstr(min(derived), 3)} to {mp.nstr(max(derived), 3)} m/s."
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


# --- (23) ---------------------------------------------------------------------------------------------------
_P_A, _P_B = sp.symbols("P_A P_B", real=True)
_A_ell, _B_ell, _C_ell, _F_ell = sp.symbols("A_ell B_ell C_ell F_ell", real=True)
_NUMBER, _METRE = Dimension(), parse_unit("m").dimension
_KNOWN_23 = {_P_A: _METRE, _P_B: _METRE, _A_ell: parse_unit("m^2").dimension, _B_ell: parse_unit("m^2").dimension,
             _C_ell: parse_unit("m^2").dimension, _F_ell: parse_unit("m^4").dimension}  # fmt: skip
_p_a, _p_b = sp.symbols("p_A p_B", real=True)  # P_Aredu, P_Bredu: the responses over W_maxf
_KNOWN_23 |= {_p_a: _NUMBER, _p_b: _NUMBER}
_CONIC = sp.Eq(_A_ell * zeta_x**2 + _C_ell * zeta_x**2 + _B_ell * zeta_x * zeta_z, _F_ell)
_EQ23: Forms = {
    "conic": _CONIC,
    "A_ell": (_P_A / (D * k_c)) ** 2,
    "B_ell_redu": 2 * _p_a * _p_b / (W_maxf * D * k_c),
    "B_ell": 2 * _P_A * _P_B / (D * k_c),
    "C_ell_redu": (_p_b / W_maxf) ** 2,
    "C_ell": _P_B**2,
    "F_ell_redu": ((_p_a**2 + _p_b**2) * sp.cos(k_c * x)) ** 2,
    "F_ell": ((_P_A**2 + _P_B**2) * sp.cos(k_c * x)) ** 2,
}
_UNITS_23 = {"A_ell": "m^2", "B_ell_redu": "1", "B_ell": "m^2", "C_ell_redu": "1", "C_ell": "m^2", "F_ell_redu": "m^2",
             "F_ell": "m^4"}  # fmt: skip


def _corrected_23() -> Forms:
    per_square = {_P_A: _p_a * W_maxf, _P_B: _p_b * W_maxf}
    whole = {
        "A_ell": (_P_A / (D * k_c)) ** 2, "B_ell": 2 * _P_A * _P_B / (D * k_c), "C_ell": _P_B**2,
        "F_ell": ((_P_A**2 + _P_B**2) * sp.cos(k_c * x)) ** 2,
    }  # fmt: skip
    redu = {f"{name}_redu": sp.factor(whole[name].subs(per_square) / W_maxf**2) for name in ("B_ell", "C_ell", "F_ell")}
    conic = sp.Eq(_A_ell * zeta_x**2 + _C_ell * zeta_z**2 + _B_ell * zeta_x * zeta_z, _F_ell)
    order = ("A_ell", "B_ell_redu", "B_ell", "C_ell_redu", "C_ell", "F_ell_redu", "F_ell")
    return {"conic": conic, **{name: {**whole, **redu}[name] for name in order}}


def _derive_23() -> Derivation:
    sine, cosine = sp.sin(k_c * x), sp.cos(k_c * x)
    vertical, along = _P_A * sine + _P_B * cosine, _P_A * cosine - _P_B * sine
    line = vertical * _P_B + along * _P_A
    forms = _corrected_23()
    values = {zeta_z: vertical, zeta_x: D * k_c * along}
    put = {_A_ell: forms["A_ell"], _B_ell: forms["B_ell"], _C_ell: forms["C_ell"], _F_ell: forms["F_ell"]}
    conic = forms["conic"].lhs - forms["conic"].rhs
    kind = ellipse.discriminant((conic + _F_ell).subs(put), zeta_x, zeta_z)
    invariant = ellipse.invariant()
    angle = k_c * x
    real = sp.simplify(invariant.subs(ellipse.turned_back(zeta_x / (D * k_c), zeta_z, angle)))
    axes = ellipse.discriminant(invariant, ellipse.P_A, ellipse.P_B)
    return Derivation(
        (
            step("With P_A, P_B the two responses at one instant, (11) reads:", sp.Eq(zeta_z, vertical),
                 sp.Eq(zeta_x / (D * k_c), along)),
            step("P_B times the first and P_A times the second, added (A12):", sp.Eq(zeta_z * _P_B + zeta_x / (D * k_c) * _P_A,
                 (_P_A**2 + _P_B**2) * cosine), zero=sp.expand(line - (_P_A**2 + _P_B**2) * cosine)),
            step("Squared, this is the conic of (23) and (A13), with zeta_z^2 in its second term:", forms["conic"],
                 zero=sp.expand(conic.subs(put).subs(values))),
            step("Its discriminant vanishes: the square of a straight line is a pair of parallel lines, not an ellipse. The "
                 "line turns with P_A and P_B and meets the particle's path at that one instant.", sp.Eq(sp.S.Zero, kind,
                 evaluate=False), zero=kind),
            step("The path itself: two phases W_a cos(alpha), W_b cos(alpha + delta) eliminate the fast angle alpha,",
                 sp.Eq(invariant, 0)),
            step("and with P_A, P_B turned back to the displacements at the particle:", sp.Eq(real, 0)),
            step("Its discriminant is negative unless delta is a multiple of pi: an ellipse, run through in the sense of Q = D "
                 "k_c W_a W_b omega sin(delta), slowly changing as delta drifts.", axes,
                 zero=sp.simplify(axes + 4 * sp.sin(ellipse.delta) ** 2 / (ellipse.W_a * ellipse.W_b) ** 2)),
        ),
        forms,
    )  # fmt: skip


def _judge_23(forms: Forms) -> Iterator[Evidence]:
    worst_ = mp.mpf(0)
    for state in _states(8, "eq23"):
        size, W = mp.sqrt(state["a"] ** 2 + state["b"] ** 2), mp.mpf("5.5e-6")
        u = state["k_c"] * state["x"]
        base = {
            _P_A: state["a"], _P_B: state["b"], _p_a: state["a"] / W, _p_b: state["b"] / W, W_maxf: W, D: state["D"],
            k_c: state["k_c"], x: state["x"], zeta_z: state["a"] * mp.sin(u) + state["b"] * mp.cos(u),
            zeta_x: state["D"] * state["k_c"] * (state["a"] * mp.cos(u) - state["b"] * mp.sin(u)),
        }  # fmt: skip
        for suffix in ("", "_redu"):
            scale = W**-2 if suffix else mp.mpf(1)
            values = {"A_ell": evaluate(forms["A_ell"], {s: base[s] for s in forms["A_ell"].free_symbols}) * scale}
            for name in ("B_ell", "C_ell", "F_ell"):
                expr = forms[name + suffix]
                values[name] = evaluate(expr, {s: base[s] for s in expr.free_symbols})
            point = {
                **base,
                _A_ell: values["A_ell"],
                _B_ell: values["B_ell"],
                _C_ell: values["C_ell"],
                _F_ell: values["F_ell"],
            }
            left = forms["conic"].lhs - forms["conic"].rhs
            value = evaluate(left, {s: point[s] for s in left.free_symbols})
            worst_ = max(worst_, abs(value) / (size**4 * scale))
    yield evidence("numeric", worst_ < mp.mpf(10) ** -20,
                   f"the particle is off the conic by {mp.nstr(worst_, 3)} of the fourth power of its amplitude at most")  # fmt: skip
    both = forms["B_ell"] ** 2 - 4 * forms["A_ell"] * forms["C_ell"]
    yield evidence("domain", vanishes(both), "discriminant 0: a pair of parallel lines at every instant")


def _repair_23(forms: Forms) -> Forms:
    conic = forms["conic"]
    swapped = conic.lhs - _C_ell * zeta_x**2 + _C_ell * zeta_z**2
    return {
        **forms, "conic": sp.Eq(swapped, conic.rhs), "B_ell_redu": forms["B_ell_redu"] * W_maxf,
        "C_ell_redu": forms["C_ell_redu"] * W_maxf**2, "F_ell_redu": forms["F_ell_redu"] * W_maxf**2,
    }  # fmt: skip


def _effect_23() -> str:
    cycle = at_table_3()
    q = operating_point()
    time = cycle.durations()[0] / 7
    a, b = (cycle.response(p, "redu", time)[0] for p in "AB")
    printed = ((a / (q["D"] * q["k_c"])) ** 2 + b**2) * (q["D"] * q["k_c"] * a) ** 2
    right = (a**2 + b**2) ** 2
    return (
        f"At x = 0, a seventh into T_redu, the printed left side is {mp.nstr(100 * printed / right - 100, 3)} % off the right "
        "side. Even put right, the conic is a pair of parallel lines, so it cannot give Figs. 9, 12 and 15, which need (11)."
    )


# --- (24) ---------------------------------------------------------------------------------------------------
def _printed_24(amplitudes: tuple[sp.Expr, sp.Expr], rates: tuple[sp.Expr, sp.Expr], angle: sp.Expr) -> sp.Expr:
    return D * k_c * amplitudes[0] * amplitudes[1] * (sum(rates) / 2 * sp.sin(angle, evaluate=False))


_TURN_3 = half_B + varphi_B - mean * (t_3 - t_2) * (half_A + varphi_A - sp.pi / 2)
_DECAY_A, _DECAY_B = sp.exp(-xi * omega_n * (t - t_1)), sp.exp(-xi * omega_n * (t - t_2))
_add = sym("Delta_omega_add")[0]
_EQ24: Forms = {
    "Q_q": by_region(
        (_printed_24((W_maxf * _DECAY_A, W_maxf), (omega_n, omega_q), (omega_q - omega_n) * (t - t_1) + sp.pi / 2), 1, 2),
        (_printed_24((A_AB, W_maxf * _DECAY_B), (mean, omega_n),
                     (omega_q - omega_n) / 2 * (t - t_2) + sp.pi - varphi_A - half_A), 2, 3),
        (_printed_24((A_AB, A_Badd), (mean, mean), _add * (t - t_3) + _TURN_3), 3, 4),
    )
}  # fmt: skip


def _as_cosines() -> list[tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]]:
    """(amplitude, angle) of both phases as cosines in every region, from (9) and (10) put right."""
    found = []
    for of_A, of_B in zip(rows(EQ9["w_A"]), rows(corrected_10()["w_B"]), strict=True):
        pair = []
        for row in (of_A, of_B):
            (wave,) = row.atoms(sp.sin, sp.cos)
            angle = wave.args[0] - (sp.pi / 2 if isinstance(wave, sp.sin) else 0)
            amplitude = row / wave
            if amplitude.could_extract_minus_sign():
                amplitude, angle = -amplitude, angle + sp.pi
            pair.append((amplitude, angle.subs(sym("varphi_Aredu")[0], sp.pi / 2)))
        found.append((pair[0], pair[1]))
    return found


def corrected_24() -> Forms:
    """Eq. (A8) for the phases of every region: amplitudes and slow phases held, the sum frequency dropped."""
    branches = []
    for ((A, alpha), (B, beta)), span in zip(_as_cosines(), ((1, 2), (2, 3), (3, 4)), strict=True):
        rate = (sp.diff(alpha, t) + sp.diff(beta, t)) / 2
        branches.append((D * k_c * A * B * rate * sp.sin(beta - alpha), *span))
    return {"Q_q": by_region(*branches)}


def error_24(form: sp.Basic, cycle: Cycle, region: str, tau: mp.mpf) -> mp.mpf:
    """Approximate less exact Q over D k_c W^2 omega_q."""
    names = {**context(cycle, region, tau), "Delta_omega_add": mp.mpf(0)}
    scale = cycle["D"] * cycle["k_c"]
    value = row_value(form, names)
    exact = scale * cycle.determinant(region, tau)
    return (value - exact) / (scale * cycle["W"] ** 2 * cycle["omega_q"])


def _judge_24(forms: Forms) -> Iterator[Evidence]:
    def premise(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        """Against (A8) from the phases' complex vectors: their lengths and the angle between them."""
        names = {**context(cycle, region, time), "Delta_omega_add": mp.mpf(0)}
        found = row_value(forms["Q_q"], names)
        if found is None:
            return mp.inf
        a, b = (rotating_vector(cycle, phase, region, time) for phase in "AB")
        n, q = cycle["omega_n"], cycle["omega_q"]
        rate = {"redu": (n + q) / 2, "addredu": (3 * n + q) / 4, "add": (n + q) / 2}[region]
        wanted = abs(a) * abs(b) * rate * mp.sin(mp.arg(b / a))
        return abs(found / (cycle["D"] * cycle["k_c"]) - wanted) / (cycle["W"] ** 2 * q)

    exactly = worst(premise)
    text = ", ".join(f"{mp.nstr(100 * v, 3)} % in T_{r}" for r, v in exactly.items())
    yield evidence("numeric", max(exactly.values()) < mp.mpf("0.02"),
                   f"off (A8) with the phases as complex vectors, in D k_c W^2 omega_q, by {text}; allowed 2 %")  # fmt: skip
    found = worst(lambda c, r, u: abs(error_24(forms["Q_q"], c, r, u)))
    text = ", ".join(f"{mp.nstr(100 * v, 3)} % in T_{r}" for r, v in found.items())
    yield evidence("error_size", max(found.values()) < 0.5,
                   f"off the exact determinant, in D k_c W^2 omega_q, by {text}; allowed 50 %")  # fmt: skip
    at_start = [row_value(forms["Q_q"], context(at_table_3(), "redu", mp.mpf(0)))]
    yield evidence("limit", at_start[0] > 0, "positive at t_1, where the wave still travels clockwise")


def _repair_24(forms: Forms) -> Forms:
    """Sign of the drift in T_addredu, minus before the bracket in T_add, amplitude of B from (10) put right."""
    first, second, third = rows(forms["Q_q"])
    drift = (omega_q - omega_n) / 2 * (t - t_2)
    wave = next(e for e in second.atoms(sp.sin) if e.has(t_2))
    back = wave.func(sp.expand(wave.args[0]) - 2 * sp.expand(drift))
    second = second.xreplace({wave: back}) * omega_q / omega_n
    lost = -mean * (t_3 - t_2) * (half_A + varphi_A - sp.pi / 2)
    meant = -mean * (t_3 - t_2) - (half_A + varphi_A - sp.pi / 2)
    last = next(e for e in third.atoms(sp.sin) if e.has(t_3))
    third = third.xreplace({last: last.func(sp.expand(last.args[0] - lost + meant))})
    return {"Q_q": by_region((first, 1, 2), (second, 2, 3), (third.subs(_add, 0), 3, 4))}


def _derive_24() -> Derivation:
    exact = determinant.determinant()
    forms = corrected_24()
    alpha, beta_ = sp.symbols("alpha beta_", cls=sp.Function)
    a, b = W_a * sp.cos(alpha(t)), W_b * sp.cos(beta_(t))
    put = exact.subs({w_A: a, w_B: b}).doit()
    da, db = alpha(t).diff(t), beta_(t).diff(t)
    half = D * k_c * W_a * W_b / 2
    product = half * ((db - da) * sp.sin(alpha(t) + beta_(t)) + (da + db) * sp.sin(beta_(t) - alpha(t)))
    ((A1, al1), (B1, be1)), ((A2, al2), (B2, be2)), ((A3, al3), (B3, be3)) = _as_cosines()
    return Derivation(
        (
            step("For any two phases the determinant (A5) with the displacements (11) is, wherever the particle is, exactly",
                 sp.Eq(sym("Q_q")[0], exact)),
            step("Two phases W_a cos(alpha), W_b cos(beta) of slowly varying amplitude give (A6):", product,
                 zero=sp.expand(sp.expand_trig(put - product))),
            step("The term with the sum of the angles is smaller by the ratio of difference to sum of the frequencies and "
                 "averages out; what stays is (A8), D k_c W_a W_b times the mean frequency times sin(beta - alpha)."),
            step("From t_1 to t_2 A is free and B forced; alpha and beta are", al1, be1,
                 zero=sp.expand(be1 - al1 - (omega_q - omega_n) * (t - t_1) - sp.pi / 2)),
            step("From t_2 to t_3 A has the mean frequency, B is free and slower: beta - alpha falls, by half the "
                 "difference; the print lets it rise.", al2, be2,
                 zero=sp.expand(sp.diff(be2 - al2, t) + (omega_q - omega_n) / 2)),
            step("From t_3 to t_4 both have the mean frequency and beta - alpha stands still but for the slow phases. The print "
                 "lost a minus before its last bracket.", al3, be3, zero=sp.expand(sp.diff(be3 - al3, t))),
            step("Put together:", *rows(forms["Q_q"])),
        ),
        forms,
    )  # fmt: skip


def _effect_24() -> str:
    cycle = at_table_3()
    good, parts = corrected_24()["Q_q"], []
    for region in REGIONS:
        times = cycle.times(region, 40)
        flips = sum(
            (error_24(_EQ24["Q_q"], cycle, region, u) * cycle["W"] ** 2 * cycle["omega_q"] + cycle.determinant(region, u))
            * cycle.determinant(region, u) < 0
            for u in times
        )  # fmt: skip
        sizes = [max(abs(error_24(form, cycle, region, u)) for u in times) for form in (_EQ24["Q_q"], good)]
        parts.append(
            f"T_{region}: printed off by {mp.nstr(100 * sizes[0], 3)} % at most, with the wrong sign at {flips} of 40 instants, "
            f"put right {mp.nstr(100 * sizes[1], 3)} %"
        )
    return f"In units of D k_c W^2 omega_q: {'; '.join(parts)}."


def _picture_24() -> Picture:
    cycle = at_table_3()
    good = corrected_24()["Q_q"]
    labels = ("exact", "(24) as printed", "(24) put right")
    curves: dict[str, tuple[list[float], list[float]]] = {label: ([], []) for label in labels}
    start, unit = mp.mpf(0), cycle["W"] ** 2 * cycle["omega_q"]
    for region, length in zip(REGIONS, cycle.durations(), strict=True):
        for tau in cycle.times(region, 70):
            exact = cycle.determinant(region, tau) / unit
            values = (exact, *(exact + error_24(form, cycle, region, tau) for form in (_EQ24["Q_q"], good)))
            for label, value in zip(labels, values, strict=True):
                curves[label][0].append(float(1000 * (start + tau)))
                curves[label][1].append(float(value))
        start += length
    return Picture(
        "Direction determinant over a cycle of 14 in 20 pulses", "t - t_1, ms", "Q / (D k_c W^2 omega_q)", curves
    )


ENTRIES = (
    Entry(
        id="20", section="3.4", title="Place of the crest", place="Sect. 3.4",
        printed=_EQ20, units={"x_max": "m"}, verdict="erratum",
        reason="The arctangent is right up to half a wavelength, but cos(k_c x) of the particle cannot choose between crest and "
        "trough: the sign of w_B does. It is the slope that vanishes at a crest, not the vertical velocity.",
        judge=_judge_20, derive=_derive_20, effect=_effect_20, repair=_repair_20, found_by=("numeric", "domain"),
    ),
    Entry(
        id="21", section="3.4", title="Displacement of the crest", place="Sect. 3.4",
        printed=_EQ21, units={"zeta_zmax": "m"}, verdict="verified",
        reason="With the crest's place of (20) put right it is sqrt(w_A^2 + w_B^2).",
        judge=_judge_21, derive=_derive_21, effect=lambda: "None: printed and derived agree, given x_max at the crest.",
    ),
    Entry(
        id="22", section="3.4", title="Tangential velocity of the crest", place="Sect. 3.4",
        printed=_EQ22, units={"v_xmax": "m/s"}, verdict="erratum",
        reason="Differentiates zeta_z, the vertical displacement, where zeta_x is meant.",
        judge=_judge_22, derive=_derive_22, effect=_effect_22, repair=_repair_22, found_by=("numeric", "identity"),
        picture=_picture_22,
    ),
    Entry(
        id="23", section="3.5", title="Conic of the particle's path", place="Sect. 3.5",
        printed=_EQ23, units=_UNITS_23, known=_KNOWN_23, verdict="erratum",
        reason="zeta_x^2 stands twice, zeta_z^2 is missing; the rows of T_redu divide by W_maxf what is already free of it. "
        "Put right it holds at every instant, but as the square of a straight line, not as an ellipse.",
        judge=_judge_23, derive=_derive_23, effect=_effect_23, repair=_repair_23, found_by=("dimension", "numeric"),
    ),
    Entry(
        id="24", section="3.5", title="Direction determinant, region by region", place="Sect. 3.5",
        printed=_EQ24, units={"Q_q": "m^2/s"}, verdict="erratum",
        reason="The phase difference drifts the other way in T_addredu, a minus is lost in T_add, and B's amplitude is (10)'s. "
        "Put right it is still an approximation of the exact determinant.",
        judge=_judge_24, derive=_derive_24, effect=_effect_24, repair=_repair_24, found_by=("numeric", "error_size"),
        picture=_picture_24,
    ),
)  # fmt: skip
