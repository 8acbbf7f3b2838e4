"""Appendices B and C: eqs. (A10) to (A17), the ellipse and the monotonicity of the determinants."""

from __future__ import annotations

import math
from collections.abc import Iterator

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import ellipse
from derivations.ledger.exact import at_table_3
from derivations.ledger.history import STARTS, values
from derivations.ledger.judge import Point, agrees, evaluate, figure, identical, points, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.section_6 import cycle_totals
from derivations.nomenclature import sym
from trum_sym.inputs.units import Dimension

__all__ = ["ENTRIES", "differs_by_start"]

D, k_c, x, t, T = sym("D k_c x t T")
q_plus, q_minus, p_plus, p_minus = sym("q_plus q_minus p_plus p_minus")
W_a, W_b, omega_a, omega_b, varphi_a, varphi_b = sym("W_a W_b omega_a omega_b varphi_a varphi_b")
P_A, P_B, zeta_x, zeta_z, X, Y, Q_aver = sym("P_A P_B zeta_x zeta_z X Y Q_aver")

_RANGES = {
    "W_a": (3e-6, 9e-6),
    "W_b": (3e-6, 9e-6),
    "omega_a": (2.3e5, 2.6e5),
    "omega_b": (2.4e5, 2.8e5),
    "varphi_a": (-3.0, 3.0),
    "varphi_b": (-3.0, 3.0),
    "P_A": (-8e-6, 8e-6),
    "P_B": (-8e-6, 8e-6),
    "X": (0.1, 6.0),
    "Y": (0.1, 6.0),
    "Q_aver": (500.0, 2000.0),
    "q_plus": (0.1, 3.0),
    "q_minus": (0.1, 3.0),
    "p_plus": (0.1, 3.0),
    "p_minus": (0.1, 3.0),
    "delta": (-3.0, 3.0),
}
_MOTION = (W_a, W_b, omega_a, omega_b, varphi_a, varphi_b, k_c, x, t)
_sine, _cosine = sp.sin(k_c * x), sp.cos(k_c * x)
_in_a, _in_b = sp.cos(omega_a * t + varphi_a), sp.cos(omega_b * t + varphi_b)


def _phasors(q: Point) -> tuple[mp.mpf, mp.mpf]:
    """The two responses in time as real parts of turning phasors."""
    return (
        q[W_a] * mp.re(mp.expj(q[omega_a] * q[t] + q[varphi_a])),
        q[W_b] * mp.re(mp.expj(q[omega_b] * q[t] + q[varphi_b])),
    )


# --- (A10) --------------------------------------------------------------------------------------------------
_A10: Forms = {"w_A": W_a * _sine * _in_a, "w_B": W_b * _cosine * _in_b}


def _derive_a10() -> Derivation:
    pairs = ((_A10["w_A"], omega_a), (_A10["w_B"], omega_b))
    return Derivation(
        (
            step(
                "Standing waves of wavenumber k_c at the frequency of each phase:",
                *_A10.values(),
                zero=[z for w, omega in pairs for z in (w.diff(x, 2) + k_c**2 * w, w.diff(t, 2) + omega**2 * w)],
            ),
            step("a quarter wave apart, as the electrodes are:", zero=_sine.subs(x, x + sp.pi / (2 * k_c)) - _cosine),
        ),
        _A10,
    )


def _judge_a10(forms: Forms) -> Iterator[Evidence]:
    def standing(label: str, q: Point) -> mp.mpf:
        wave = mp.expj(q[k_c] * q[x])
        A, B = _phasors(q)
        return mp.im(wave) * A if label == "w_A" else mp.re(wave) * B

    yield agrees(forms, standing, symbols=_MOTION, ranges=_RANGES, against="phasors in space and time")
    free = all(
        sp.expand(w.diff(x, 2) + k_c**2 * w) == 0 == sp.expand(w.diff(t, 2) + omega**2 * w)
        for w, omega in zip(forms.values(), (omega_a, omega_b), strict=True)
    )
    yield evidence("identity", free, "standing waves of wavenumber k_c, harmonic at omega_a and omega_b")


def _effect_a10() -> str:
    return "Repeats (A1). Constant amplitudes: between switchings W_a or W_b decays or grows, which A10 leaves out."


# --- (A11) --------------------------------------------------------------------------------------------------
_A11: Forms = {
    "zeta_z": W_a * _sine * _in_a + W_b * _cosine * _in_b,
    "zeta_x": D * k_c * (W_a * _cosine * _in_a - W_b * _sine * _in_b),
    "P_A": W_a * _in_a,
    "P_B": W_b * _in_b,
}


def _derive_a11() -> Derivation:
    up = _A10["w_A"] + _A10["w_B"]
    forms = {"zeta_z": up, "zeta_x": sp.expand(D * up.diff(x)), "P_A": W_a * _in_a, "P_B": W_b * _in_b}
    return Derivation(
        (
            step(
                "Superposition, and the section's rotation at the distance D from the neutral axis (eq. 11):",
                forms["zeta_z"],
                forms["zeta_x"],
                zero=forms["zeta_x"] - _A11["zeta_x"],
            ),
            step("with the responses in time", forms["P_A"], forms["P_B"]),
        ),
        forms,
    )


def _judge_a11(forms: Forms) -> Iterator[Evidence]:
    def by_differences(label: str, q: Point) -> mp.mpf:
        A, B = _phasors(q)

        def wave(at: mp.mpf) -> mp.mpf:
            return A * mp.sin(q[k_c] * at) + B * mp.cos(q[k_c] * at)

        h = mp.mpf("1e-9")
        known = {"P_A": A, "P_B": B, "zeta_z": wave(q[x])}
        slope = (8 * (wave(q[x] + h) - wave(q[x] - h)) - wave(q[x] + 2 * h) + wave(q[x] - 2 * h)) / (12 * h)
        return known[label] if label in known else q[D] * slope

    yield agrees(
        forms,
        by_differences,
        symbols=(*_MOTION, D),
        ranges=_RANGES,
        tolerance=1e-6,
        against="the sum, and D times its slope by differences",
    )
    yield identical({k: sp.expand(f) for k, f in forms.items()}, _derive_a11().forms)


def _effect_a11() -> str:
    p = values()
    return (
        f"At Table 3 a steady wave has {figure(1e6 * p['W'])} um upward and {figure(1e6 * p['D'] * p['k_c'] * p['W'])} "
        "um along. The displacements are called xi here, which is the damping ratio in eq. 7 and zeta in eq. 11."
    )


# --- (A12) --------------------------------------------------------------------------------------------------
_A12: Forms = {
    "(1)": sp.Eq(zeta_z * P_B, (P_A * _sine + P_B * _cosine) * P_B),
    "(2)": sp.Eq(zeta_x / (D * k_c) * P_A, (P_A * _cosine - P_B * _sine) * P_A),
}
_ON_MOTION: dict[sp.Basic, sp.Basic] = {
    zeta_z: P_A * _sine + P_B * _cosine,
    zeta_x: D * k_c * (P_A * _cosine - P_B * _sine),
}


def _residual_numbers(forms: Forms) -> mp.mpf:
    """Largest |left - right| over |left| + |right| on the motion, at random points."""
    worst = mp.mpf(0)
    for form in forms.values():
        sides = [side.subs(_ON_MOTION) for side in (form.lhs, form.rhs)]
        symbols = set().union(*(side.free_symbols for side in sides)) | {P_A, P_B}
        for q in points(symbols, 4, "A12", _RANGES):
            left, right = (evaluate(side, {s: q[s] for s in side.free_symbols}) for side in sides)
            worst = worse(worst, abs(left - right) / (abs(left) + abs(right)))
    return worst


def _derive_a12() -> Derivation:
    zeros = [(form.lhs - form.rhs).subs(_ON_MOTION) for form in _A12.values()]
    return Derivation((step("(A11) with P_A and P_B, each row times one of them:", *_A12.values(), zero=zeros),), _A12)


def _judge_a12(forms: Forms) -> Iterator[Evidence]:
    worst = _residual_numbers(forms)
    yield evidence("numeric", worst < 1e-25, f"both sides agree on the motion to {mp.nstr(worst, 2)}")
    zeros = [sp.expand((form.lhs - form.rhs).subs(_ON_MOTION)) for form in forms.values()]
    yield evidence("identity", not any(zeros), "both rows hold for any P_A, P_B")
    weights = [form.lhs.coeff(along, 1) for form, along in zip(forms.values(), (zeta_z, zeta_x), strict=True)]
    yield evidence("limit", weights == [P_B, P_A / (D * k_c)], "weighted so that the mixed terms of the sum cancel")


def _effect_a12() -> str:
    return "None: an identity at every instant."


# --- (A13) --------------------------------------------------------------------------------------------------
_A13: Forms = {
    "conic": sp.Eq(
        (P_A / (D * k_c)) ** 2 * zeta_x**2 + (P_B * zeta_z) ** 2 + 2 * P_A * P_B / (D * k_c) * zeta_x * zeta_z,
        ((P_A**2 + P_B**2) * _cosine) ** 2,
    )
}
delta = ellipse.delta


def _derive_a13() -> Derivation:
    printed = _A13["conic"]
    total = sum((form.lhs for form in _A12.values()), sp.S.Zero)
    conic = ellipse.invariant()
    turned = conic.subs(ellipse.turned_back(zeta_x / (D * k_c), zeta_z, k_c * x), simultaneous=True)
    form = sp.Eq(turned + sp.sin(delta) ** 2, sp.sin(delta) ** 2)
    flat = ellipse.discriminant((printed.lhs - printed.rhs), zeta_x, zeta_z)
    round_ = ellipse.discriminant(conic, P_A, P_B)
    return Derivation(
        (
            step(
                "((1) + (2))^2 of (A12) is the printed equation, an identity at every instant:",
                printed,
                zero=[sp.expand((printed.lhs - printed.rhs).subs(_ON_MOTION)), sp.expand(total**2 - printed.lhs)],
            ),
            step(
                "Its left side is a perfect square, so its discriminant B^2 - 4 A C is 0: at every instant it is a "
                "pair of parallel lines through the point, and these turn with P_A and P_B at the drive's frequency. "
                "It is not the path.",
                zero=flat,
            ),
            step(
                "What stays is the conic in the responses, delta their phase difference at that instant, "
                "omega_b t + varphi_b - omega_a t - varphi_a:",
                sp.Eq(conic, 0),
            ),
            step(
                "Its discriminant is negative, so it is an ellipse unless sin(delta) = 0:",
                round_,
                zero=sp.expand(round_ * W_a**2 * W_b**2 - 4 * sp.cos(delta) ** 2 + 4),
            ),
            step(
                "The displacements are the responses turned by k_c x, so the path is the same ellipse, turned. Its "
                "area is pi D k_c W_a W_b |sin delta|, and Q = D k_c omega W_a W_b sin(delta) for equal frequencies: "
                "Q's sign is the sense of turning.",
                form,
            ),
        ),
        {"conic": form},
    )


def _judge_a13(forms: Forms) -> Iterator[Evidence]:
    form = forms["conic"]
    on_motion = {P_A: W_a * _in_a, P_B: W_b * _in_b}
    apart = omega_b * t + varphi_b - omega_a * t - varphi_a
    worst = mp.mpf(0)
    sides = [s.subs(_ON_MOTION).subs(delta, apart).subs(on_motion) for s in (form.lhs, form.rhs)]
    for q in points((*_MOTION, D), 4, "A13", _RANGES):
        left, right = (evaluate(side, {s: q[s] for s in side.free_symbols}) for side in sides)
        worst = worse(worst, abs(left - right) / (abs(left) + abs(right)))
    yield evidence("numeric", worst < 1e-25, f"holds on the motion, two sides to {mp.nstr(worst, 2)}")
    fast = sorted(s.name for s in form.free_symbols & {P_A, P_B})
    bend = ellipse.discriminant(form.lhs - form.rhs, zeta_x, zeta_z)
    (q,) = points((*_MOTION, D, P_A, P_B, delta), 1, "A13 bend", _RANGES)
    number = evaluate(bend, {s: q[s] for s in bend.free_symbols})
    is_ellipse = not fast and mp.re(number) < 0
    what = f"coefficients turn with {', '.join(fast)}, " if fast else ""
    yield evidence("domain", is_ellipse, f"an ellipse that stays: {what}discriminant {mp.nstr(number, 3)}")


def _effect_a13() -> str:
    p, cycle = values(), at_table_3()
    end = cycle.durations()[0]
    a, b = (cycle.vector(phase, "redu", end) for phase in "AB")
    area = math.pi * p["D"] * p["k_c"] * 1e12
    return (
        f"Drawn as an ellipse it has no area. The path encloses pi D k_c W^2 = {figure(area * p['W'] ** 2)} "
        "um^2 in the steady wave of Table 3; at the end of T_redu, after a steady start, phase lead +1, W_a has fallen "
        f"to {figure(1e6 * abs(a))} um and the drive has run ahead of the free motion by "
        f"{figure((cycle['omega_q'] - cycle['omega_n']) * end, 3)} rad, so it encloses "
        f"{figure(area * abs(mp.im(mp.conj(a) * b)))} um^2."
    )


def _picture_a13() -> Picture:
    """The printed conic and the path at one instant of T_redu, W_b = W and W_a = 0.8 W, a third of a beat apart."""
    p = values()
    W, Dk, apart, place, now = p["W"] * 1e6, p["D"] * p["k_c"], 2.1, 0.5, 0.9
    turn = np.linspace(0, 2 * np.pi, 241)
    A, B = 0.8 * W * np.cos(turn), W * np.cos(turn + apart)
    path = Dk * (A * np.cos(place) - B * np.sin(place)), A * np.sin(place) + B * np.cos(place)
    at_a, at_b = 0.8 * W * np.cos(now), W * np.cos(now + apart)
    along = np.linspace(-1.2 * W, 1.2 * W, 2)
    level = (at_a**2 + at_b**2) * np.cos(place)
    curves = {"derived: the path": (path[0].tolist(), path[1].tolist())}
    for label, side in (("printed, one line", 1), ("printed, the other", -1)):
        up = (side * level - at_a / Dk * along) / at_b
        curves[label] = along.tolist(), up.tolist()
    return Picture("Path of a point and the printed conic at one instant", "zeta_x in um", "zeta_z in um", curves)


# --- (A14), (A15) -------------------------------------------------------------------------------------------
_A14: Forms = {"Q_aver": (X - 1) / ((X + 1) * T), "X": q_plus / q_minus}
_A15: Forms = {"dQ_aver/dX": 2 / ((X + 1) ** 2 * T)}


def _derive_a14() -> Derivation:
    from derivations import determinant

    average, _ = determinant.measures()
    ratio, _ = determinant.ratios()
    return Derivation(
        (
            step(
                "Eq. 43, numerator and denominator over the backward sum:",
                *_A14.values(),
                zero=_A14["Q_aver"].subs(X, ratio) - average,
            ),
        ),
        {"Q_aver": _A14["Q_aver"], "X": ratio},
    )


def _judge_a14(forms: Forms) -> Iterator[Evidence]:
    whole = {"Q_aver": forms["Q_aver"].subs(X, forms["X"]), "X": forms["X"]}

    def direct(label: str, q: Point) -> mp.mpf:
        if label == "X":
            return q[q_plus] / q[q_minus]
        return (q[q_plus] - q[q_minus]) / (q[q_plus] + q[q_minus]) / q[T]

    yield agrees(whole, direct, symbols=(q_plus, q_minus, T), ranges=_RANGES, against="eq. 43 in the sums")
    ends = [sp.limit(forms["Q_aver"], X, end) for end in (0, sp.oo)]
    yield evidence(
        "limit", ends == [-1 / T, 1 / T] and forms["Q_aver"].subs(X, 1) == 0, "from -1/T to 1/T, 0 for X = 1"
    )


def _effect_a14() -> str:
    known = cycle_totals("periodic")
    ratio = known[q_plus] / known[q_minus]
    average = (ratio - 1) / (ratio + 1) / values()["T"]
    return f"X = {figure(ratio)} at Table 3 (periodic start, phase lead +1): Q_aver = {figure(average)} 1/s."


def _derive_a15() -> Derivation:
    form = sp.factor(_A14["Q_aver"].diff(X))
    return Derivation(
        (
            step(
                "The derivative of (A14); a positive number over a square:",
                sp.Eq(sp.Derivative(_A14["Q_aver"], X), form),
                zero=form - _A15["dQ_aver/dX"],
            ),
        ),
        {"dQ_aver/dX": form},
    )


def _judge_a15(forms: Forms) -> Iterator[Evidence]:
    def differences(_: str, q: Point) -> mp.mpf:
        h = mp.mpf("1e-8")

        def average(ratio: mp.mpf) -> mp.mpf:
            return (ratio - 1) / (ratio + 1) / q[T]

        return (average(q[X] + h) - average(q[X] - h)) / (2 * h)

    yield agrees(
        forms, differences, symbols=(X, T), ranges=_RANGES, tolerance=1e-12, against="central differences of (A14)"
    )
    found = forms["dQ_aver/dX"]
    yield evidence("domain", found.is_positive, "positive for every X > 0, as printed")
    yield identical(forms, {"dQ_aver/dX": _A14["Q_aver"].diff(X)})


def _effect_a15() -> str:
    known, p = cycle_totals("periodic"), values()
    ratio = known[q_plus] / known[q_minus]
    slope = 2 / ((ratio + 1) ** 2 * p["T"])
    change = 100 * (_cycle_time(3300) / _cycle_time(2800) - 1)
    return (
        f"{figure(slope)} 1/s for each unit of X at Table 3 (periodic start, phase lead +1). T is taken as constant; "
        f"from 2800 to 3300 Hz it changes by {figure(change, spec='.2f')} %, and Q_aver with it."
    )


def _cycle_time(difference: float) -> float:
    p = values()
    return p["m"] / (p["omega_n"] / (2 * float(sp.pi)) + difference)


# --- (A16), (A17) -------------------------------------------------------------------------------------------
_f_printed = sp.sqrt(Y + 1) / sp.sqrt(Y - 1)
_f = sp.sqrt((Y + 1) / sp.Abs(Y - 1))
_A16: Forms = {"Q_vib": 1 / (T**2 * Q_aver) * _f_printed, "Y": p_plus / p_minus}
_A17: Forms = {"df/dY": -2 / (Y - 1)}


def _derive_a16() -> Derivation:
    form = _f / (T**2 * Q_aver)
    volatility = sp.sqrt((p_plus + p_minus) / sp.Abs(p_plus - p_minus)) / (T**2 * Q_aver)
    return Derivation(
        (
            step(
                "Eq. 44 put right, with the backward sum of squares taken out:",
                form,
                zero=[
                    (form.subs(Y, p_plus / p_minus) - volatility).subs({p_plus: a, p_minus: b}).simplify()
                    for a, b in ((3, 2), (1, 4))
                ],
            ),
        ),
        {"Q_vib": form, "Y": p_plus / p_minus},
    )


def _judge_a16(forms: Forms) -> Iterator[Evidence]:
    below = forms["Q_vib"].subs({Y: sp.Rational(1, 2), T: 1, Q_aver: 1})
    yield evidence("domain", below.is_real, "real for Y < 1")
    whole = {"Q_vib": forms["Q_vib"].subs(Y, forms["Y"]), "Y": forms["Y"]}

    def direct(label: str, q: Point) -> mp.mpf:
        if label == "Y":
            return q[p_plus] / q[p_minus]
        squares = (q[p_plus] + q[p_minus]) / abs(q[p_plus] - q[p_minus])
        return mp.sqrt(squares) / (q[T] ** 2 * q[Q_aver])

    yield agrees(
        whole,
        direct,
        symbols=(p_plus, p_minus, T, Q_aver),
        ranges=_RANGES,
        count=8,
        tolerance=1e-20,
        against="eq. 44 put right, in the sums, for Y below and above 1",
    )
    unit = forms["Q_vib"].subs({T: 1, Q_aver: 1})
    yield evidence("limit", sp.limit(unit, Y, sp.oo) == 1, "tends to 1/(T^2 Q_aver) when nothing turns back")


def differs_by_start() -> str:
    """X and Y of the three starts at Table 3, as a sentence's part."""
    parts = []
    for start in STARTS:
        known = cycle_totals(start)
        parts.append(
            f"{start} X = {figure(known[q_plus] / known[q_minus], 3)}, Y = {figure(known[p_plus] / known[p_minus], 3)}"
        )
    return "; ".join(parts)


def _effect_a16() -> str:
    parts = []
    for start in STARTS[:2]:
        known = cycle_totals(start)
        ratio = known[p_plus] / known[p_minus]
        root = complex(_f_printed.subs(Y, ratio))
        text = figure(root.real) if abs(root.imag) < 1e-9 else f"{figure(root.imag)} i"
        parts.append(f"{start} Y = {figure(ratio)}, f = {text}, put right {figure(float(_f.subs(Y, ratio)))}")
    return f"At Table 3, phase lead +1: {'; '.join(parts)}."


def _picture_a17() -> Picture:
    """The printed and the right derivative of f, for Y above 1."""
    axis = np.linspace(1.5, 8, 131)
    printed, right = (sp.lambdify(Y, form["df/dY"], "numpy")(axis) for form in (_A17, _derive_a17().forms))
    curves = {"printed": (axis.tolist(), printed.tolist()), "derived": (axis.tolist(), right.tolist())}
    return Picture("Derivative of f", "Y", "df/dY", curves)


def _derive_a17() -> Derivation:
    form = -1 / ((Y - 1) * sp.sqrt(sp.Abs(Y**2 - 1)))
    above, below = sp.Symbol("g", positive=True), sp.Symbol("e", positive=True)
    branch_above = sp.sqrt((above + 2) / above)  # Y = 1 + g
    branch_below = sp.sqrt((2 - below) / below)  # Y = 1 - e
    return Derivation(
        (
            step(
                "Above 1, with Y = 1 + g:",
                sp.Eq(sp.Symbol("f"), branch_above),
                zero=sp.simplify(branch_above.diff(above) ** 2 - 1 / (above**2 * ((1 + above) ** 2 - 1))),
            ),
            step(
                "Below 1, with Y = 1 - e and so df/dY = -df/de:",
                sp.Eq(sp.Symbol("f"), branch_below),
                zero=sp.simplify(branch_below.diff(below) ** 2 - 1 / (below**2 * (1 - (1 - below) ** 2))),
            ),
            step(
                "Both have the sign of 1 - Y. The printed -2/(Y - 1) is the derivative of (Y + 1)/(Y - 1) short of "
                "its square, and without the root's:",
                form,
                zero=sp.simplify(((Y + 1) / (Y - 1)).diff(Y) + 2 / (Y - 1) ** 2),
            ),
        ),
        {"df/dY": form},
    )


def _judge_a17(forms: Forms) -> Iterator[Evidence]:
    def differences(_: str, q: Point) -> mp.mpf:
        h = mp.mpf("1e-9")

        def f(y: mp.mpf) -> mp.mpf:
            return mp.sqrt((y + 1) / abs(y - 1))

        return (8 * (f(q[Y] + h) - f(q[Y] - h)) - f(q[Y] + 2 * h) + f(q[Y] - 2 * h)) / (12 * h)

    yield agrees(
        forms,
        differences,
        symbols=(Y,),
        ranges=_RANGES,
        count=8,
        tolerance=1e-6,
        against="differences of f, for Y below and above 1",
    )
    squared = forms["df/dY"].subs(Y, 3) ** 2 - sp.sqrt((Y + 1) / (Y - 1)).diff(Y).subs(Y, 3) ** 2
    yield evidence("identity", sp.simplify(squared) == 0, "the derivative of f at Y = 3, in closed form")


def _effect_a17() -> str:
    known = cycle_totals("periodic")
    ratio = known[p_plus] / known[p_minus]
    printed, right = (float(form.subs(Y, ratio)) for form in (_A17["df/dY"], _derive_a17().forms["df/dY"]))
    return (
        f"At Table 3 (periodic start, phase lead +1, Y = {figure(ratio)}) printed {figure(printed)}, right "
        f"{figure(right)}: {figure(printed / right, 3)} times too steep. Its sign is right on both sides of 1."
    )


_B, _C1, _C2 = "Appendix B", "Appendix C.1", "Appendix C.2"
ENTRIES = (
    Entry(
        id="A10",
        section="B",
        title="Responses of the two phases",
        place=_B,
        printed=_A10,
        units={"w_A": "m", "w_B": "m"},
        verdict="definition",
        judge=_judge_a10,
        derive=_derive_a10,
        effect=_effect_a10,
        reason="Two standing waves a quarter wave apart, of constant amplitude.",
    ),
    Entry(
        id="A11",
        section="B",
        title="Displacements of a surface point, P_A and P_B",
        place=_B,
        printed=_A11,
        units={"zeta_z": "m", "zeta_x": "m", "P_A": "m", "P_B": "m"},
        verdict="verified",
        judge=_judge_a11,
        derive=_derive_a11,
        effect=_effect_a11,
        reason="Superposition, and D times the slope.",
    ),
    Entry(
        id="A12",
        section="B",
        title="Displacements times P_A and P_B",
        place=_B,
        printed=_A12,
        units={},
        verdict="verified",
        judge=_judge_a12,
        derive=_derive_a12,
        effect=_effect_a12,
        reason="Holds for any responses.",
    ),
    Entry(
        id="A13",
        section="B",
        title="General equation of the ellipse",
        place=_B,
        printed=_A13,
        units={},
        verdict="erratum",
        judge=_judge_a13,
        derive=_derive_a13,
        effect=_effect_a13,
        known={delta: Dimension()},
        repair=lambda _: _derive_a13().forms,
        found_by=("domain",),
        picture=_picture_a13,
        reason="An identity, but no ellipse: a perfect square whose coefficients turn with the vibration. The path's "
        "conic has the amplitudes and the slow phase difference for coefficients.",
    ),
    Entry(
        id="A14",
        section="C.1",
        title="Speed determinant in X",
        place=_C1,
        printed=_A14,
        units={"Q_aver": "1/s", "X": "1"},
        verdict="verified",
        judge=_judge_a14,
        derive=_derive_a14,
        effect=_effect_a14,
        reason="Eq. 43 in the ratio of the sums.",
    ),
    Entry(
        id="A15",
        section="C.1",
        title="Its derivative",
        place=_C1,
        printed=_A15,
        units={"dQ_aver/dX": "1/s"},
        verdict="verified",
        judge=_judge_a15,
        derive=_derive_a15,
        effect=_effect_a15,
        reason="Positive for every X > 0, at constant T.",
    ),
    Entry(
        id="A16",
        section="C.2",
        title="Volatility determinant in Y",
        place=_C2,
        printed=_A16,
        units={"Q_vib": "1/s", "Y": "1"},
        verdict="erratum",
        judge=_judge_a16,
        derive=_derive_a16,
        effect=_effect_a16,
        repair=lambda forms: {**forms, "Q_vib": forms["Q_vib"].subs(_f_printed, _f)},
        found_by=("domain", "numeric"),
        reason="f(Y) is imaginary for Y < 1, for which the text states a monotonicity; needs |Y - 1|.",
    ),
    Entry(
        id="A17",
        section="C.2",
        title="Derivative of f",
        place=_C2,
        printed=_A17,
        units={"df/dY": "1"},
        verdict="erratum",
        judge=_judge_a17,
        derive=_derive_a17,
        effect=_effect_a17,
        repair=lambda forms: {"df/dY": forms["df/dY"] / (2 * sp.sqrt(sp.Abs(Y**2 - 1)))},
        found_by=("numeric", "identity"),
        picture=_picture_a17,
        reason="Not the derivative of f: short of a square, and of the root's inner derivative. The sign is right.",
    ),
)
