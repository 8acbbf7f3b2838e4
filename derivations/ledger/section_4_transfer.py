"""Section 4.2.3, the transfer: eqs. (36) to (38), the sixteen cases of Figs. 7 and 8."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
import sympy as sp

from derivations import transfer
from derivations.ledger.contact_cycle import contact_motion, friction, friction_kinks, table_4_speed
from derivations.ledger.course import Lap, Quantity, extremes, mean, root_mean_square, share, shares
from derivations.ledger.friction_states import (
    K,
    State,
    brute_fraction,
    half_zone_signs,
    integrals_done,
    states,
)
from derivations.ledger.history import Array, History, history, numeric, values
from derivations.ledger.judge import figure, largest, rounded, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.nomenclature import sym
from trum_sym.inputs.units import parse_unit

__all__ = ["ENTRIES"]

D, k_c, W, F_c, n_j, mu, theta, x, p = sym("D k_c W F_c n_j mu theta x p")
M_a, M_b, N_a, N_b, Psi_v, v_xp, v_xx = sym("M_a M_b N_a N_b Psi_v v_xp v_xx")
phi_vm1, phi_vm2, x_px, x_max, x_xm, v_xm, v_xmax = sym("phi_vm1 phi_vm2 x_px x_max x_xm v_xm v_xmax")
f_t, f_b, f_nall, M_n, T_load = sym("f_t f_b f_nall M_n T_load")
r_c, J, t = sym("r_c J t")
phi, c, u, R_v = transfer.phi, transfer.c, transfer.u, transfer.R_v


def _cycle_at_midpoints() -> tuple[Array, Array, Array, Array]:
    """Time in ms, phi, R and half-angle at the instants of a picture."""
    h = history(samples=500)
    return (1e3 * h.time, *contact_motion(h))


# --- (36) ---------------------------------------------------------------------------------------------------
_EQ36: Forms = {"f_n": 2 * n_j * mu * sp.Integral(p * sp.sign(v_xx - v_xp), (x, x_max, x_xm))}


def _whole_zone(form: sp.Expr) -> sp.Expr:
    return form.subs(x_max, 2 * x_max - x_xm) / 2


def _share_inside(at: sp.Expr) -> sp.Expr:
    """C at a point inside the contact, where nothing is clipped."""
    return transfer.pressure_share().subs(u, at).subs(sp.Max(-theta, sp.Min(theta, at)), at)


def _derive_36() -> Derivation:
    """From the surface's motion to one closed form, and what doubling a half does to it."""
    form = _whole_zone(_EQ36["f_n"])
    speed, largest, angle = transfer.surface_speed(), transfer.speed_amplitude(), transfer.speed_angle()
    a = sp.Symbol("a", positive=True)
    C, f, states_at = sp.Function("C"), sp.Symbol("f"), transfer.wave_states()
    share = _share_inside(u)
    press = sp.cos(u) - sp.cos(theta)
    load = sp.integrate(press, (u, -theta, theta))
    falls, rises = _share_inside(phi + a), _share_inside(phi - a)
    whole = 2 * (falls - rises) - 1
    doubled = 4 * (falls - _share_inside(sp.Integer(0))) - 1
    steady = transfer.steady_wave_fraction()
    return Derivation(
        (
            step(
                "Let u = k_c (x - x_max) count from the crest, v_A and v_B be the rates of w_A and w_B. The crest's "
                "height, its rate, and the determinant over D k_c are",
                *(sp.Eq(symbol, value) for symbol, value in states_at.items()),
            ),
            step(
                "The tangential velocity D d2(zeta_z)/dx dt of eq. 11 becomes, about the crest,",
                sp.Eq(sp.Symbol("v_xx"), speed),
                zero=_about_the_crest() - sp.expand(speed.subs(states_at)),
            ),
            step(
                "Both terms together are one cosine, R cos(u - phi): the surface is fastest at phi, below phi_v.",
                sp.Eq(R_v, largest),
                sp.Eq(phi, angle),
                zero=sp.simplify(largest * (sp.cos(u) * sp.cos(angle) + sp.sin(u) * sp.sin(angle)) - speed),
            ),
            step("phi is 0 or pi only while the crest's height does not change. In a beat it does."),
            step(
                "Friction on an element b_m dx of the contact is mu p dx along v_xx - v_xp, and the contact "
                "reaches from x_max - x_m = 2 x_max - x_xm to x_xm, at n_j crests:",
                sp.Eq(sp.Symbol("f_n"), form),
            ),
            step(
                "The pressure is p ~ cos u - cos theta, theta = k_c x_m (eqs. 28, 30). The share of the load left "
                "of u is",
                sp.Eq(C(u), share),
                zero=(
                    sp.simplify(share.diff(u) - press / load),
                    sp.simplify(share.subs(u, -theta)),
                    sp.simplify(share.subs(u, theta) - 1),
                ),
            ),
            step(
                "The surface is faster than the rotor where cos(u - phi) > v_xp/R: from phi - a to phi + a with",
                sp.Eq(a, sp.acos(v_xp / R_v)),
                zero=sp.cos(phi + sp.acos(c) - phi) - c,
            ),
            step(
                "This stretch drives with its share of the load and all the rest brakes, so of mu F_c there remains",
                sp.Eq(f, 2 * (C(phi + a) - C(phi - a)) - 1),
                zero=sp.expand((falls - rises) - (1 - (falls - rises)) - whole),
            ),
            step(
                "with C cut off at the ends of the contact, and the same stretch one turn to either side: the closed "
                "form of all transfer cases."
            ),
            step(
                "Eq. 36 instead doubles the right half. For phi - a < 0 < phi + a < theta that gives",
                sp.Eq(sp.Symbol("f_printed"), 4 * (C(phi + a) - C(0)) - 1),
                zero=sp.expand(doubled - 2 * (2 * (falls - sp.Rational(1, 2)) - sp.Rational(1, 2))),
            ),
            step(
                "The two differ by 2 [C(phi + a) + C(phi - a) - 1], which is 0 for phi = 0 and grows with phi, "
                "as C does:",
                zero=(
                    sp.simplify(doubled - whole - 2 * (falls + rises - 1)),
                    sp.simplify((falls + rises - 1).subs(phi, 0)),
                ),
            ),
            step(
                "So eq. 36 is right for every rotor on a steady wave alone, where f becomes",
                sp.Eq(f, steady),
                zero=sp.simplify(whole.subs(phi, 0) - steady),
            ),
        ),
        {"f_n": form},
    )


def _about_the_crest() -> sp.Expr:
    """D d2(zeta_z)/dx dt at k_c x = u + k_c x_max, with sine and cosine of k_c x_max = atan2(w_A, w_B) put in."""
    A, B, v_A, v_B = transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B
    height = sp.sqrt(A**2 + B**2)
    sine = (sp.sin(u) * B + sp.cos(u) * A) / height
    cosine = (sp.cos(u) * B - sp.sin(u) * A) / height
    return sp.expand(D * k_c * (v_A * cosine - v_B * sine))


def _concrete(s: State) -> dict[sp.Basic, sp.Basic]:
    """Eq. 36's functions and symbols for a state, with a prepressure of 180 N on nine crests."""
    turn = k_c * (x - x_max)
    load = transfer.pressure_distribution().replace(sp.Max, lambda *terms: next(t for t in terms if t != 0))
    numbers = {
        F_c: sp.Integer(180),
        n_j: sp.Integer(9),
        k_c: sp.Integer(300),
        mu: sp.Rational(1, 4),
        theta: sp.Float(s.theta, 20),
        x_max: sp.Float(s.crest / K, 20),
        x_xm: sp.Float((s.crest + s.theta) / K, 20),
        v_xp: sp.Float(s.c, 20),
    }
    return {
        p: load.subs(u, turn).subs(numbers),
        v_xx: sp.cos(turn - sp.Float(s.phi, 20)).subs(numbers),
        **numbers,
    }


def _judge_36(forms: Forms) -> Iterator[Evidence]:
    form = forms["f_n"]
    scale = 45.0
    closed = numeric(transfer.friction_fraction(), (phi, c, theta))
    chosen = list(states(4, "36"))
    found = [float(integrals_done(form, _concrete(s))) / scale for s in chosen]
    brute = float(np.max([abs(f - brute_fraction(s, whole=True)) for f, s in zip(found, chosen, strict=True)]))
    yield evidence(
        "numeric",
        brute < 1e-3,
        f"the friction of all elements summed by brute force: off by {brute:.1e} of mu F_c at most",
    )
    fractions = [float(closed(s.phi, s.c, s.theta)) for s in chosen]
    exact = float(np.max(np.abs(np.subtract(found, fractions))))
    yield evidence("derivation", exact < 1e-10, f"the closed form of the friction fraction: off by {rounded(exact)}")
    outrun = State(0.3, 1.5, 0.5, 0.2)
    ahead = float(integrals_done(form, _concrete(outrun))) / scale
    yield evidence("limit", abs(ahead + 1) < 1e-12, "a rotor that outruns the surface is braked by mu F_c")


def _effect_36() -> str:
    v, lap, speed = values(), Lap(), table_4_speed()
    rub, kinks = v["mu"] * v["F_c"], [*friction_kinks(speed), *friction_kinks(speed, half=True)]
    whole, half = friction(speed), friction(speed, transfer.half_zone_fraction())
    zone = extremes(lambda h: contact_motion(h)[2], lap)
    rms = root_mean_square(lambda h: half(h) - whole(h), lap, kinks)
    worst = max(abs(end) for end in extremes(lambda h: half(h) - whole(h), lap))
    signs = share(lambda h: -half(h) * whole(h), lap)
    return (
        "Over the cycle at Table 3, periodic, phase lead +1, at Table 4's mean speed, with a contact half-angle from "
        f"{figure(zone[0], 3)} to {figure(zone[1], 3)} rad: the doubled half differs from the "
        f"whole by {figure(rms * rub, 3)} N rms and {figure(worst * rub, 3)} N at most of {figure(rub)} N, has the "
        f"wrong sign {figure(100 * signs, spec='.1f')} % of the time, and a mean of "
        f"{figure(mean(half, lap, kinks) * rub, 3)} N where it is {figure(mean(whole, lap, kinks) * rub, 3)} N."
    )


def _size_36() -> tuple[str, float]:
    """The doubled half off the whole over the periodic cycle, root mean square of both."""
    lap, speed = Lap(), table_4_speed()
    kinks = [*friction_kinks(speed), *friction_kinks(speed, half=True)]
    whole, half = friction(speed), friction(speed, transfer.half_zone_fraction())
    off = root_mean_square(lambda h: half(h) - whole(h), lap, kinks)
    return "the friction over the cycle (rms)", float(off / root_mean_square(whole, lap, kinks))


def _picture_36() -> Picture:
    """Friction of the doubled half and of the whole zone over a periodic cycle, with Table 4's rotor."""
    v, speed = values(), table_4_speed()
    time, angle, R, zone = _cycle_at_midpoints()
    rub = v["mu"] * v["F_c"]
    curves = {
        label: (time.tolist(), [rub * float(f) for f in numeric(form, (phi, c, theta))(angle, speed / R, zone)])
        for label, form in (
            ("printed: right half, doubled", transfer.half_zone_fraction()),
            ("derived: whole contact", transfer.friction_fraction()),
        )
    }
    return Picture("Friction over a drive cycle", "t - t_1 in ms", "friction in N", curves)


# --- (37) ---------------------------------------------------------------------------------------------------
def _rows_37() -> sp.Expr:
    ahead, behind = v_xx - v_xp > 0, v_xx - v_xp < 0
    plus = sp.Or(sp.And(ahead, v_xp > 0), sp.And(ahead, v_xp < 0))
    minus = sp.Or(sp.And(behind, v_xp > 0), sp.And(behind, v_xp < 0))
    return sp.Piecewise((sp.Integer(1), plus), (sp.Integer(-1), minus), evaluate=False)


_EQ37: Forms = {"sign": _rows_37()}


def _derive_37() -> Derivation:
    form = sp.sign(v_xx - v_xp)
    return Derivation(
        (
            step(
                "Friction on the rotor points where the surface moves relative to it, whichever way the rotor runs:",
                form,
                zero=[
                    form.subs({v_xx: a, v_xp: b}) - (1 if a > b else -1)
                    for a, b in ((2, 1), (1, 2), (1, -1), (-2, -1), (1, 0), (-1, 0))
                ],
            ),
        ),
        {"sign": form},
    )


def _judge_37(forms: Forms) -> Iterator[Evidence]:
    form = forms["sign"]
    rotor = [(a, b) for a in (-1.5, -0.2, 0.4, 2.0) for b in (-1.0, 0.3, 1.1)]
    wrong = [(a, b) for a, b in rotor if form.subs({v_xx: a, v_xp: b}) != (1 if a > b else -1)]
    yield evidence("numeric", not wrong, "along v_xx - v_xp for a moving rotor")
    still = [a for a in (-1, 1) if form.subs({v_xx: a, v_xp: 0}) != a]
    yield evidence("domain", not still, "along v_xx for a rotor at rest")


def _at_rest() -> float:
    """Mean torque on a rotor at rest over the periodic cycle, N m."""
    v = values()
    return mean(friction(0.0), Lap(), friction_kinks(0.0)) * v["mu"] * v["F_c"] * v["r_c"]


def _effect_37() -> str:
    return (
        "Either row holds for v_xp > 0 or v_xp < 0, so these conditions say nothing but exclude v_xp = 0: a rotor at "
        f"rest would feel no friction and never start. It feels {figure(_at_rest(), 3)} N m, averaged over the cycle "
        "at Table 3, periodic, phase lead +1. Where v_xx = v_xp on a stretch, friction takes any value up to mu p; the "
        "sign leaves that open."
    )


# --- Figs. 7 and 8 ------------------------------------------------------------------------------------------
def _derive_cases() -> Derivation:
    steps = [
        step(
            "Eq. 36's closed form on the half zone 0 < u < theta, C its share of the load:",
            transfer.friction_fraction(sp.Function("C")(u)),
        ),
        step(
            "The text tells cases apart by the rotor's direction, the sign of v_x - v at the crest and at the end of "
            "the contact, and (eq. 35) by whether v_x has an extremum between them: 2 x 2 x 2 x 2 cases."
        ),
    ]
    forms = {}
    for number, case in enumerate(transfer.CASES, 1):
        forms[f"f_{number}"] = case.fraction()
        steps.append(step(f"{number}. {case.name}", sp.Symbol(f"f_{number}")))
    return Derivation(tuple(steps), forms)


@cache
def _case_samples() -> tuple[tuple[str, State, float, float], ...]:
    """Six random states of each case: the case, the friction by brute force, and by the closed form."""
    numbers = {(s.forward, s.crest, s.edge, s.extremum): f"f_{i}" for i, s in enumerate(transfer.CASES, 1)}
    closed = numeric(transfer.half_zone_fraction(), (phi, c, theta))
    seen: Counter[str] = Counter()
    samples = []
    for s in states(400, "cases"):
        key = numbers[half_zone_signs(s)]
        seen[key] += 1
        if seen[key] <= 6:
            samples.append((key, s, brute_fraction(s, whole=False), float(closed(s.phi, s.c, s.theta))))
    return tuple(samples)


def _judge_cases(forms: Forms) -> Iterator[Evidence]:
    samples = _case_samples()
    counts = Counter(key for key, *_ in samples)
    empty = [key for key in forms if not counts[key]]
    yield evidence(
        "domain",
        not empty,
        f"each case occurs among random states, {min(counts.values())} times at least; "
        f"every state is in one{f'; none in {empty}' if empty else ''}",
    )
    brute = exact = 0.0
    for key, s, by_force, by_form in samples:
        found = complex(numeric(forms[key], (phi, c, theta))(s.phi, s.c, s.theta))
        brute, exact = worse(brute, abs(found - by_force)), worse(exact, abs(found - by_form))
    yield evidence("numeric", brute < 1e-3, f"sign(v_x - v) p summed over the half zone: off by {brute:.1e} at most")
    yield evidence(
        "derivation", exact < 1e-12, f"the closed form, which needs no cases: off by {rounded(exact)} at most"
    )


def _effect_cases() -> str:
    speed = table_4_speed()
    names = {(s.forward, s.crest, s.edge, s.extremum): s.name for s in transfer.CASES}

    def kind(h: History) -> list[str]:
        moments = zip(*contact_motion(h), strict=True)
        return [names[half_zone_signs(State(float(a), float(speed / R), float(at), 0.0))] for a, R, at in moments]

    def against(place: Callable[[Array], Array], level: float) -> Quantity:
        def value(h: History) -> Array:
            angle, R, zone = contact_motion(h)
            found: Array = np.cos(place(zone) - angle) - level * speed / R
            return found

        return value

    ends = (lambda zone: 0 * zone, lambda zone: zone)
    turns = (lambda zone: 0 * zone - np.pi / 2, lambda zone: zone - np.pi / 2)
    cuts = [*(against(end, 1.0) for end in ends), *(against(turn, 0.0) for turn in turns)]
    found = shares(kind, Lap(), cuts)
    often = {name: part for name, part in found.items() if part > 1e-4}
    listed = ", ".join(f"{name} {figure(100 * part, 2)} %" for name, part in often.items())
    rare = ", ".join(name for name in found if name not in often)
    return (
        "One formula replaces the table. At Table 4's mean speed the cycle at Table 3, periodic, phase lead +1, "
        "passes "
        f"{figure(len(found))} cases: {listed}; {rare} for less than 0.01 % each."
    )


# --- (38) ---------------------------------------------------------------------------------------------------
_omega = sp.Function("omega_p")(t)
_FORCES: Forms = {"f_nall": f_t - f_b, "M_n": f_nall * r_c, "omega_p": v_xp / r_c}
_EQ38: Forms = {"balance": sp.Eq(J * _omega.diff(t), M_n - T_load), **_FORCES}


def _derive_38() -> Derivation:
    energy, power = J * _omega**2 / 2, f_nall * r_c * _omega - T_load * _omega
    return Derivation(
        (
            step(
                "The rotor's kinetic energy grows by the power of the friction at the contact radius, where its "
                "surface runs at r_c omega_p, less that of the load:",
                sp.Eq(sp.Derivative(energy, t), power),
            ),
            step(
                "Over omega_p that is the balance of torques:",
                _EQ38["balance"],
                zero=sp.expand(energy.diff(t) - power - _omega * (J * _omega.diff(t) - f_nall * r_c + T_load)),
            ),
            step(
                "The same with the closed form of the friction:",
                sp.Eq(_omega.diff(t), transfer.torque_balance()),
                zero=J * transfer.torque_balance() - r_c * mu * F_c * transfer.f_net + T_load,
            ),
        ),
        {"balance": _EQ38["balance"], **_FORCES},
    )


def _judge_38(forms: Forms) -> Iterator[Evidence]:
    worst = 0.0
    for i, s in enumerate(states(6, "38")):
        radius, inertia, load = 0.02 + 0.001 * i, 4e-6 + 1e-6 * i, 0.1 * i - 0.2
        share = (1 + brute_fraction(s, whole=True)) / 2  # of the load that drives forward
        wheel = {r_c: radius, J: inertia, T_load: load, f_t: 45 * share, f_b: 45 * (1 - share)}
        # eight equal point masses on the contact radius, each pushed by its part of the friction
        mass = inertia / radius**2 / 8
        rate = (45 * brute_fraction(s, whole=True) / 8 - load / radius / 8) / mass / radius
        residual = (forms["balance"].lhs - forms["balance"].rhs).subs(M_n, forms["M_n"])
        residual = residual.subs(f_nall, forms["f_nall"]).subs(_omega.diff(t), rate).subs(wheel)
        worst = worse(worst, abs(float(residual)))
        arc = 0.3 + 0.1 * i  # surface speed of a rotor that turns by arc/radius in a second
        worst = worse(worst, abs(float(forms["omega_p"].subs({v_xp: arc, r_c: radius})) - arc / radius))
    yield evidence("numeric", worst < 1e-9, f"eight point masses pushed along the rim: off by {rounded(worst)}")
    energy, power = J * _omega**2 / 2, f_nall * r_c * _omega - T_load * _omega
    residual = (forms["balance"].lhs - forms["balance"].rhs).subs(M_n, forms["M_n"])
    yield evidence("identity", sp.expand(energy.diff(t) - power - _omega * residual) == 0, "balances power")


def _effect_38() -> str:
    v = values()
    stall = v["mu"] * v["F_c"] * v["r_c"]
    return (
        f"At most mu F_c r_c = {figure(stall, 3)} N m; averaged over the cycle at Table 3, periodic, phase lead +1, a "
        f"rotor at rest gets {figure(_at_rest(), 3)} N m, against the {0.3:g} N m of Table 1 (with the assumed mu and "
        "r_c). The text's T_load is a weight on a string, which pulls one way whichever way the rotor turns."
    )


# --- the sign of the reverse model --------------------------------------------------------------------------
_REVERSE: Forms = {"f_nall": f_t - f_b}


def _derive_reverse() -> Derivation:
    form = sp.sign(v_xp) * (f_t - f_b)
    return Derivation(
        (
            step("Forward, the driving zone (plus, v_x > v) pushes along +x, and f_t - f_b is the force along +x."),
            step(
                "Reverse, Fig. 8 calls driving (plus) where v_x < v; it pushes along -x, so the force along +x is",
                form,
                zero=form.subs(v_xp, -1) - (f_b - f_t),
            ),
        ),
        {"f_nall": form},
    )


def _judge_reverse(forms: Forms) -> Iterator[Evidence]:
    worst = {"forward": 0.0, "reverse": 0.0}
    for s in states(40, "reverse"):
        width = (np.arange(20001) + 0.5) / 20001 * 2 * s.theta - s.theta
        press = np.cos(width) - np.cos(s.theta)
        ahead = np.cos(width - s.phi) > s.c
        driving = ahead if s.c > 0 else ~ahead
        total = float(press.sum())
        known = {f_t: float(press[driving].sum()) / total, f_b: float(press[~driving].sum()) / total, v_xp: s.c}
        found = float(forms["f_nall"].subs(known))
        way = "forward" if s.c > 0 else "reverse"
        worst[way] = worse(worst[way], abs(found - brute_fraction(s, whole=True, steps=20001)))
    yield evidence(
        "numeric",
        largest(worst.values()) < 1e-9,
        "the signed sum of eq. 36, off by "
        + ", ".join(f"{error:.2g} {way}" for way, error in worst.items())
        + " of mu F_c",
    )
    backward = forms["f_nall"].subs({f_t: 1, f_b: 0, v_xp: -1})
    yield evidence("limit", backward == -1, "a reverse rotor driven on its whole contact is pushed along -x")


def _effect_reverse() -> str:
    v = values()
    return (
        "With the zones of Fig. 8, f_t - f_b in eq. 38 pushes a reverse rotor forward: the force is off by up to "
        f"2 mu F_c = {figure(2 * v['mu'] * v['F_c'])} N. Eq. 36 with eq. 37 has the right sign for both directions."
    )


ENTRIES = (
    Entry(
        id="36",
        section="4.2.3",
        title="Friction on the rotor",
        place="Sect. 4.2.3",
        printed=_EQ36,
        units={"f_n": "N"},
        verdict="erratum",
        judge=_judge_36,
        derive=_derive_36,
        effect=_effect_36,
        picture=_picture_36,
        size=_size_36,
        known=transfer.DIMENSIONS,
        repair=lambda forms: {key: _whole_zone(form) for key, form in forms.items()},
        found_by=("numeric", "derivation"),
        reason="Twice the right half of the contact is the whole where v_x is even about the crest, or where all of "
        "the contact slides one way; in a beat the crest's height changes, and v_x is not even.",
    ),
    Entry(
        id="37",
        section="4.2.3",
        title="Sign of the friction",
        place="Sect. 4.2.3",
        printed=_EQ37,
        units={"sign": "1"},
        verdict="erratum",
        judge=_judge_37,
        derive=_derive_37,
        effect=_effect_37,
        known=transfer.DIMENSIONS,
        repair=lambda _: {"sign": sp.Piecewise((1, v_xx - v_xp > 0), (-1, v_xx - v_xp < 0), (0, True))},
        found_by=("domain",),
        reason="The conditions on v_xp are empty but exclude the rotor at rest, so nothing could start.",
    ),
    Entry(
        id="transfer-cases",
        section="4.2.3",
        title="The sixteen transfer models of Figs. 7 and 8",
        place="Sect. 4.2.3, a and b",
        printed={},
        units={f"f_{i}": "1" for i in range(1, 17)},
        verdict="reconstructed",
        judge=_judge_cases,
        derive=_derive_cases,
        effect=_effect_cases,
        known=transfer.DIMENSIONS,
        reason="The text names what tells the cases apart but not their forces; each is a corollary of one "
        "closed form.",
    ),
    Entry(
        id="38",
        section="4.2.3",
        title="Torque balance of the rotor",
        place="Sect. 4.2.3",
        printed=_EQ38,
        units={"f_nall": "N", "M_n": "N*m", "omega_p": "rad/s"},
        verdict="verified",
        judge=_judge_38,
        derive=_derive_38,
        effect=_effect_38,
        known={**transfer.DIMENSIONS, _omega: parse_unit("rad/s").dimension},
        reason="Angular momentum of the rotor, for forward motion; the reverse model needs the sign judged apart.",
    ),
    Entry(
        id="reverse-model",
        section="4.2.3",
        title="Driving and braking zone of the reverse model",
        place="Sect. 4.2.3, b, and below eq. 38",
        printed=_REVERSE,
        units={"f_nall": "N"},
        verdict="erratum",
        judge=_judge_reverse,
        derive=_derive_reverse,
        effect=_effect_reverse,
        known=transfer.DIMENSIONS,
        repair=lambda forms: {"f_nall": sp.sign(v_xp) * forms["f_nall"]},
        found_by=("numeric", "limit"),
        reason="Where the rotor runs backward, the driving zone pushes along -x, and f_t - f_b changes its sign.",
    ),
)
