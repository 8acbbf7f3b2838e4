"""Section 4.2.2, where the rotor does not slide: eqs. (33) to (35)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import transfer
from derivations.ledger.contact_cycle import contact_motion, table_4_speed
from derivations.ledger.course import Lap, Quantity, share, shares
from derivations.ledger.friction_states import K, State, states
from derivations.ledger.history import Array, History, values
from derivations.ledger.judge import evaluate, figure, rounded, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "EQ35"]

D, k_c, W, F_c, n_j, mu, theta, x, p, lam = sym("D k_c W F_c n_j mu theta x p lambda")
M_a, M_b, N_a, N_b, Psi_v, v_xp, v_xx = sym("M_a M_b N_a N_b Psi_v v_xp v_xx")
phi_vm1, phi_vm2, x_px, x_max, x_xm, v_xm, v_xmax = sym("phi_vm1 phi_vm2 x_px x_max x_xm v_xm v_xmax")
phi, c, u, R_v = transfer.phi, transfer.c, transfer.u, transfer.R_v


# --- (33) ---------------------------------------------------------------------------------------------------
_ROW = sp.atan(M_a / M_b)
_EQ33: Forms = {"row 1": sp.Eq(phi_vm1, _ROW / k_c), "row 2": sp.Eq(phi_vm1, (_ROW + sp.pi) / k_c)}


def _derive_33() -> Derivation:
    speed = M_a * sp.sin(k_c * x) + M_b * sp.cos(k_c * x)
    slope = speed.diff(x) / k_c
    first, value = slope.subs(x, _ROW / k_c), sp.simplify(speed.subs(x, _ROW / k_c))
    return Derivation(
        (
            step("Eq. 16 with A_v cos(Psi_v) and A_v sin(Psi_v) for M_a and M_b; v_x over D k_c is", speed),
            step(
                "It is largest or smallest where its slope vanishes, half a wave apart:",
                sp.Eq(slope, 0),
                zero=(first.simplify(), sp.expand(slope.subs(x, x + sp.pi / k_c) + slope)),
            ),
            step(
                "The first is a peak if M_b > 0 and else a trough: there v_x over D k_c is",
                value,
                zero=sp.simplify(value - M_b * sp.sqrt(1 + (M_a / M_b) ** 2)),
            ),
        ),
        {"row 1": _EQ33["row 1"], "row 2": sp.Eq(phi_vm2, (_ROW + sp.pi) / k_c)},
    )


def _extrema(a: float, b: float) -> list[float]:
    """Where |a sin + b cos| is largest in (-pi/2, 3 pi/2), in order: by scanning, then thirds."""
    grid = np.linspace(-np.pi / 2, 3 * np.pi / 2, 4001)
    size = np.abs(a * np.sin(grid) + b * np.cos(grid))
    found = []
    for i in range(1, len(grid) - 1):
        if size[i] >= size[i - 1] and size[i] > size[i + 1]:
            low, high = grid[i - 1], grid[i + 1]
            for _ in range(80):
                one, two = low + (high - low) / 3, high - (high - low) / 3
                lower = abs(a * math.sin(one) + b * math.cos(one)) < abs(a * math.sin(two) + b * math.cos(two))
                low, high = (one, high) if lower else (low, two)
            found.append((low + high) / 2)
    return found


def _judge_33(forms: Forms) -> Iterator[Evidence]:
    left = [form.lhs for form in forms.values()]
    yield evidence("domain", len(set(left)) == len(left), f"two positions, the names {', '.join(map(str, left))}")
    worst = 0.0
    for a, b in ((0.7, 1.1), (-0.4, 0.9), (0.8, -0.5), (-1.2, -0.3)):
        wanted = _extrema(a, b)
        for form, at in zip(forms.values(), wanted, strict=True):
            found = complex(evaluate(form.rhs, {M_a: a, M_b: b, k_c: K}))
            worst = worse(worst, abs(K * found - at))
    yield evidence(
        "numeric",
        worst < 1e-6,
        "the extrema in (-pi/2, 3 pi/2)/k_c, in order, by scanning v_x for all "
        f"signs of M_a, M_b: off by {rounded(worst)} rad at most",
    )
    slopes = [(M_a * sp.cos(k_c * f.rhs) - M_b * sp.sin(k_c * f.rhs)) for f in forms.values()]
    yield evidence("identity", all(s.simplify() == 0 for s in slopes), "the slope of v_x vanishes in both rows")


def _effect_33() -> str:
    trough = share(lambda h: -h.v_A, Lap())  # M_b = w_A'
    return (
        "phi_vm2, which eq. 35 needs, is defined nowhere. The rows do not say which is the peak: the first one is a "
        f"trough whenever M_b = w_A' < 0, {figure(100 * trough, 3)} % of the cycle at Table 3, periodic, and fails at "
        "M_b = 0."
    )


# --- (34) ---------------------------------------------------------------------------------------------------
def _rows_34(ratio: sp.Expr, a: sp.Symbol, b: sp.Symbol, covers_zero: bool) -> sp.Expr:
    arc = sp.asin(ratio)
    middle = sp.And(a >= 0 if covers_zero else a > 0, b <= 0)
    return sp.Piecewise(
        ((arc - Psi_v) / k_c, b >= 0),
        ((-sp.pi - arc - Psi_v) / k_c, middle),
        ((sp.pi - arc - Psi_v) / k_c, sp.And(a < 0, b <= 0)),
    )


_EQ34: Forms = {
    "x_px_redu": _rows_34(v_xp / (D * k_c * sp.sqrt(N_a**2 + N_b**2)), N_a, N_b, False),
    "x_px": _rows_34(v_xp / (D * k_c * sp.sqrt(M_a**2 + M_b**2)), M_a, M_b, False),
    "lambda": 2 * sp.pi / k_c,
}


def _derive_34() -> Derivation:
    amplitude = sp.Symbol("A_v", positive=True)
    arc = sp.asin(v_xp / amplitude)
    roots = [angle - Psi_v for angle in (arc, sp.pi - arc, -sp.pi - arc)]
    redu, other = D * k_c * W * sp.sqrt(N_a**2 + N_b**2), D * k_c * sp.sqrt(M_a**2 + M_b**2)
    return Derivation(
        (
            step(
                "The rotor's speed meets v_x = A_v sin(k_c x + Psi_v) (eq. 16) at either arcsine, up to whole waves:",
                *roots,
                zero=[sp.expand_trig(amplitude * sp.sin(root + Psi_v)).simplify() - v_xp for root in roots],
            ),
            step(
                "A_v has the factor W_maxf in T_redu (eq. 17), where M_a and M_b are in 1/s; eq. 34 leaves it out:",
                sp.Eq(amplitude, redu),
                sp.Eq(amplitude, other),
            ),
            step(
                "In all there are two nonsliding points a wave, symmetric about the peak of v_x (closed form, u from "
                "the crest):",
                *transfer.nonsliding_points(),
            ),
        ),
        {
            "x_px_redu": _rows_34(v_xp / redu, N_a, N_b, True),
            "x_px": _rows_34(v_xp / other, M_a, M_b, True),
            "lambda": 2 * sp.pi / k_c,
        },
    )


def _judge_34(forms: Forms) -> Iterator[Evidence]:
    points = {key: form for key, form in forms.items() if key != "lambda"}
    worst, turned = {key: mp.mpf(0) for key in points}, []
    stiff, height = mp.mpf("2.8e-3"), mp.mpf("5.6e-6")
    for key, form in points.items():
        redu = key == "x_px_redu"
        a, b = (N_a, N_b) if redu else (M_a, M_b)
        for ratio, angle in ((0.3, 0.4), (-0.7, 1.9), (0.6, -0.8), (0.2, 4.0), (-0.5, 3.3), (0.9, -1.2)):
            psi = mp.mpf(angle)
            size = mp.mpf(2.5e5) if redu else mp.mpf("1.4")
            speed = stiff * K * size * (height if redu else 1)
            known = {
                D: stiff,
                k_c: mp.mpf(K),
                W: height,
                v_xp: ratio * speed,
                Psi_v: psi,
                a: size * mp.cos(psi),
                b: size * mp.sin(psi),
            }
            found = evaluate(form, {s: known[s] for s in form.free_symbols})
            turned.append(complex(K * found).real)
            worst[key] = worse(worst[key], abs(speed * mp.sin(K * found + psi) / speed - ratio))
    detail = ", ".join(f"{key} misses by {mp.nstr(value, 2)} of A_v" for key, value in worst.items())
    yield evidence("numeric", all(value < 1e-12 for value in worst.values()), f"v_x there is the rotor's: {detail}")
    one_wave = all(-3 * math.pi / 2 <= angle <= math.pi / 2 for angle in turned)
    yield evidence("limit", one_wave, "all rows give k_c x_px in one wave, from -3 pi/2 to pi/2")
    turn = mp.expj(K * evaluate(forms["lambda"], {k_c: mp.mpf(K)}) / 4)  # a quarter of the wave: no multiple passes
    yield evidence("identity", abs(turn - 1j) < 1e-25, "a quarter of lambda turns the wave by a quarter")
    gaps = [key for key, form in points.items() if _row_at(form, 0, -1) is sp.nan]
    yield evidence(
        "domain", not gaps, "a row for every M_a, M_b" + (f", but for M_a = 0 > M_b in {gaps}" if gaps else "")
    )


def _row_at(form: sp.Expr, a: int, b: int) -> sp.Expr:
    return form.subs({M_a: a, N_a: a, M_b: b, N_b: b})


def _repair_34(forms: Forms) -> Forms:
    root = sp.sqrt(N_a**2 + N_b**2)
    closed = {N_a > 0: N_a >= 0, M_a > 0: M_a >= 0}
    return {
        "x_px_redu": forms["x_px_redu"].subs(closed).subs(root, W * root),
        "x_px": forms["x_px"].subs(closed),
        "lambda": forms["lambda"],
    }


def _left_34(ratio: float) -> float:
    """The share of all phases Psi_v for which eq. 34 gives a point outside of (-pi/2, 3 pi/2)/k_c."""
    arc, outside = math.asin(ratio), 0.0
    rows = ((0, math.pi, arc), (-math.pi / 2, 0, -math.pi - arc), (math.pi, 1.5 * math.pi, math.pi - arc))
    for low, high, at_zero in rows:
        least = at_zero + math.pi / 2  # beyond this phase the point lies below -pi/2
        most = at_zero - 1.5 * math.pi  # before this one above 3 pi/2
        outside += max(0.0, high - max(low, least)) + max(0.0, min(high, most) - low)
    return outside / (2 * math.pi)


def _effect_34() -> str:
    v = values()
    speed = v["D"] * v["k_c"] * v["W"] * v["omega_q"]
    shift = math.asin(0.5) - math.asin(0.5 * v["W"])
    return (
        f"At Table 3, in a steady wave: in T_redu the arcsine's argument comes out {figure(v['W'], 3)} times too "
        "small: "
        f"for a rotor at half the surface's {figure(1000 * speed)} mm/s the point moves by "
        f"{figure(1000 * shift / v['k_c'], 3)} mm, to where the surface stands still. The rows give points in "
        "(-3 pi/2, pi/2)/k_c, not in the stated (-pi/2, 3 pi/2)/k_c: whatever the rotor's speed, "
        f"{figure(100 * _left_34(0.5))} % of all phases Psi_v leave it."
    )


def _paper_angles(s: State) -> tuple[float, float, float]:
    """Psi_v in (-pi/2, 3 pi/2), M_a and M_b for a state."""
    psi = (math.pi / 2 - s.phi - s.crest + math.pi / 2) % (2 * math.pi) - math.pi / 2
    return psi, math.cos(psi), math.sin(psi)


def _position_34(s: State) -> float:
    """k_c x_px by the rows of eq. 34."""
    psi, a, b = _paper_angles(s)
    arc = math.asin(s.c)
    return arc - psi if b >= 0 else (-math.pi if a > 0 else math.pi) - arc - psi


# --- (35) ---------------------------------------------------------------------------------------------------
def _rows_35() -> sp.Expr:
    """The rows of eq. 35, repeated ones once; the text breaks off after them."""
    mirrored, shifted = 2 * phi_vm1 - x_px, x_px + 2 * sp.pi
    rising, falling = sp.And(v_xm > v_xmax, v_xmax > 0), sp.And(v_xm < v_xmax, v_xmax < 0)
    slowing, hastening = sp.And(v_xmax > v_xm, v_xm > 0), sp.And(v_xmax < v_xm, v_xm < 0)
    both = sp.And(x_max < phi_vm1, x_xm > phi_vm2)
    first = sp.And(x_max < phi_vm1, phi_vm1 < x_xm)
    second = sp.And(x_max < phi_vm2, phi_vm2 < x_xm)
    beyond = sp.And(x_max > phi_vm2, phi_vm2 < x_xm)
    return sp.Piecewise(
        (x_px, x_xm <= phi_vm1),
        (x_px, sp.And(both, rising)),
        (x_px, sp.And(both, falling)),
        (mirrored, sp.And(first, slowing)),
        (mirrored, sp.And(first, hastening)),
        (mirrored, sp.And(second, rising)),
        (mirrored, sp.And(second, falling)),
        (shifted, sp.And(second, v_xmax > 0)),
        (shifted, sp.And(second, slowing)),
        (shifted, sp.And(second, hastening)),
        (shifted, sp.And(beyond, hastening)),
        (shifted, sp.And(beyond, v_xmax < 0)),
        evaluate=False,
    )


EQ35: Forms = {"x_p": _rows_35()}


def _derive_35() -> Derivation:
    inside = transfer.nonsliding_point_of_half_zone().subs(sp.Max(-1, sp.Min(1, c)), c)  # |v| <= R, or there is none
    form = x_max + inside.subs(c, v_xp / R_v) / k_c
    form = form.subs(sp.sign(sp.cos(phi) - v_xp / R_v), sp.sign(v_xmax - v_xp))
    falls, rises = transfer.nonsliding_points()
    return Derivation(
        (
            step(
                "All nonsliding points, as angles from the crest, are up to whole turns",
                falls,
                rises,
                zero=[sp.cos(at - phi) - sp.Max(-1, sp.Min(1, c)) for at in (falls, rises)],
            ),
            step(
                "Where just one lies between the crest and the end of the contact, v_x falls through v if the crest "
                "is faster than the rotor, and rises through it if it is slower; no further case is needed:",
                sp.Eq(sp.Symbol("x_p"), form),
            ),
        ),
        {"x_p": form},
    )


@cache
def _single_states(count: int) -> list[tuple[State, float]]:
    """States with one nonsliding point between crest and end, and where it is (angle from the crest)."""
    found = ((s, s.crossings()) for s in states(8 * count, "35", widest=1.5))
    return [(s, roots[0]) for s, roots in found if len(roots) == 1][:count]


def _known_35(s: State) -> dict[sp.Basic, float]:
    _, a, b = _paper_angles(s)
    first = math.atan(a / b)
    return {
        x_px: _position_34(s) / K,
        phi_vm1: first / K,
        phi_vm2: (first + math.pi) / K,
        x_max: s.crest / K,
        x_xm: (s.crest + s.theta) / K,
        v_xm: math.cos(s.theta - s.phi),
        v_xmax: math.cos(s.phi),
        v_xp: s.c,
        R_v: 1.0,
        phi: s.phi,
        k_c: K,
    }


def _tally_35(form: sp.Expr, count: int = 150) -> Counter[str]:
    symbols = sorted(form.free_symbols, key=lambda s: s.name)
    function = sp.lambdify(symbols, form, "mpmath")
    tally: Counter[str] = Counter()
    for s, root in _single_states(count):
        known = _known_35(s)
        found = function(*(known[symbol] for symbol in symbols))
        if found is None:  # no row applies
            tally["none"] += 1
        else:
            tally["right" if abs(K * float(found) - s.crest - root) < 1e-9 else "wrong"] += 1
    return tally


def _judge_35(forms: Forms) -> Iterator[Evidence]:
    tally = _tally_35(forms["x_p"])
    total = sum(tally.values())
    yield evidence(
        "domain",
        not tally["none"],
        f"gives a point in {total - tally['none']} of {total} random states "
        "with one nonsliding point between crest and end",
    )
    yield evidence(
        "numeric",
        not tally["wrong"],
        f"right in {tally['right']} of these, by scanning and bisection; wrong in {tally['wrong']}",
    )


def _kind_35(form: sp.Expr) -> Callable[[History], list[str]]:
    """What the rows make of states in which one nonsliding point lies between crest and end: right, wrong or none."""
    symbols = sorted(form.free_symbols, key=lambda s: s.name)
    function = sp.lambdify(symbols, form, "math")
    speed = table_4_speed()

    def kind(h: History) -> list[str]:
        found = []
        for A, B, angle, R, zone in zip(h.w_A, h.w_B, *contact_motion(h), strict=True):
            crest = (math.atan2(A, B) + math.pi / 2) % (2 * math.pi) - math.pi / 2
            s = State(float(angle), float(speed / R), float(zone), crest)
            opening = math.acos(max(-1.0, min(1.0, s.c)))
            ends = [s.phi + side * opening + 2 * math.pi * turn for side in (1, -1) for turn in (-1, 0, 1)]
            roots = [end for end in ends if 0 < end < s.theta]
            if len(roots) != 1:
                found.append("other")
                continue
            known = _known_35(s)
            placed = function(*(known[symbol] for symbol in symbols))
            if placed is None:
                found.append("none")
            else:
                found.append("right" if abs(K * placed - s.crest - roots[0]) < 1e-9 else "wrong")
        return found

    return kind


def _cuts_35() -> list[Quantity]:
    """Where a condition of eq. 35, or what it compares, changes: at each sign change of one of these."""
    speed = table_4_speed()

    def places(h: History) -> tuple[Array, Array, Array, Array, Array]:
        """phi, c, theta, the crest's place and that of the first extremum, as angles."""
        angle, R, zone = contact_motion(h)
        crest = (np.arctan2(h.w_A, h.w_B) + np.pi / 2) % (2 * np.pi) - np.pi / 2
        psi = np.pi / 2 - angle - crest
        return angle, speed / R, zone, crest, np.arctan(np.cos(psi) / np.where(np.sin(psi) == 0, 1e-300, np.sin(psi)))

    def against(end: float, level: float) -> Quantity:
        def value(h: History) -> Array:
            angle, ratio, zone, _, _ = places(h)
            found: Array = np.cos(end * zone - angle) - level * ratio
            return found

        return value

    def beside(end: float, turn: float) -> Quantity:
        def value(h: History) -> Array:
            _, _, zone, crest, first = places(h)
            return crest + end * zone - first - turn

        return value

    def steeper(h: History) -> Array:
        angle, _, zone, _, _ = places(h)
        found: Array = np.cos(zone - angle) - np.cos(angle)
        return found

    def turned(quarter: float) -> Quantity:
        def value(h: History) -> Array:
            angle, _, _, crest, _ = places(h)
            found: Array = np.sin(quarter - angle - crest)
            return found

        return value

    return [
        *(against(end, level) for end in (0, 1) for level in (0, 1)),
        *(beside(end, turn) for end in (0, 1) for turn in (0, np.pi)),
        steeper,
        turned(np.pi / 2),
        turned(np.pi),
        lambda h: h.w_A,
        lambda h: h.w_B,
    ]


def _effect_35() -> str:
    printed = EQ35["x_p"]
    parts, single = [], 0.0
    for form in (printed, printed.subs(x_px + 2 * sp.pi, x_px + 2 * sp.pi / k_c)):
        found = shares(_kind_35(form), Lap(), _cuts_35())
        single = 1 - found.get("other", 0.0)
        parts.append(" / ".join(figure(100 * found.get(k, 0.0) / single, 3) for k in ("right", "wrong", "none")))
    v = values()
    waves = 2 * math.pi / (2 * math.pi / v["k_c"])
    return (
        f"During {figure(100 * single, 3)} % of the cycle at Table 3, periodic, phase lead +1, at Table 4's mean speed "
        f"one nonsliding point lies between crest and end. Of that time the legible rows place it rightly / wrongly / "
        f"not at all {parts[0]} % (the text breaks off, repeats rows, and lets rows overlap); with 2 pi read as "
        f"2 pi/k_c {parts[1]} %. The last rows shift by 2 pi metres, {figure(waves)} waves, where 2 pi/k_c = "
        f"{figure(2000 * math.pi / v['k_c'])} mm is meant; v_x hides it only because k_c is a whole number of 1/m."
    )


_PLACE = "Sect. 4.2.2"
ENTRIES = (
    Entry(
        id="33",
        section="4.2.2",
        title="Peaks and troughs of the tangential velocity",
        place=_PLACE,
        printed=_EQ33,
        units={},
        verdict="erratum",
        judge=_judge_33,
        derive=_derive_33,
        effect=_effect_33,
        known=transfer.DIMENSIONS,
        repair=lambda forms: {"row 1": forms["row 1"], "row 2": forms["row 2"].subs(phi_vm1, phi_vm2)},
        found_by=("domain",),
        reason="Both rows define phi_vm1, so it has two values and phi_vm2 of eq. 35 none; the second is phi_vm2.",
    ),
    Entry(
        id="34",
        section="4.2.2",
        title="Position of a nonsliding point",
        place=_PLACE,
        printed=_EQ34,
        units={"x_px_redu": "m", "x_px": "m", "lambda": "m"},
        verdict="erratum",
        judge=_judge_34,
        derive=_derive_34,
        effect=_effect_34,
        known=transfer.DIMENSIONS,
        repair=_repair_34,
        found_by=("dimension", "numeric", "domain"),
        reason="Lacks W_maxf in T_redu, where eq. 17 takes it out of M_a and M_b, and a row for M_a = 0 > M_b; gives "
        "one of two solutions.",
    ),
    Entry(
        id="35",
        section="4.2.2",
        title="The only nonsliding point",
        place=_PLACE,
        printed=EQ35,
        units={"x_p": "m"},
        verdict="erratum",
        judge=_judge_35,
        derive=_derive_35,
        effect=_effect_35,
        known=transfer.DIMENSIONS,
        repair=lambda _: _derive_35().forms,
        found_by=("dimension", "domain", "numeric"),
        reason="Adds 2 pi to a length, leaves most states without a row, and uses the undefined phi_vm2. One "
        "expression replaces the table. Repeated rows are transcribed once; the text breaks off.",
    ),
)
