"""Proofs of the kernels of a layer that loses energy or is sheared: contact, reaction on the wave, bristles."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from functools import partial
from itertools import pairwise

import mpmath as mp

from derivations.proofs.contact import balanced
from derivations.proofs.maths import NUMBERS, Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS"]

Found = Mapping[str, Number | None]


def _out(p: Point) -> Number:
    """Where the layer leaves: the pressure's peak is the argument of 1 + i eta."""
    return mp.arg(mp.mpc(1, p.eta_m)) - p.leaving


def _apart(eta: Number, out: Number, free: Number) -> Number:
    """Surface over a layer that has eta sin(-out) left where the wave has it leave, and recovers since."""
    rotor = mp.cos(out) + eta * mp.sin(out)  # no pressure there
    return mp.cos(out - free) - rotor + eta * mp.sin(out) * mp.exp(-free / eta)


def _meeting(p: Point, m: Maths) -> Found:
    out = _out(p)
    return {
        "gap": _apart(p.eta_m, out, p.free),
        "gap_free": m.derivative(lambda free: _apart(p.eta_m, out, free), p.free),
        "u_in": out - p.free + 2 * m.pi,
        "u_out": out,
    }


def _meets(eta: Number, leaving: Number) -> Number:
    """How far the wave moves on until surface and layer meet: bisection, then Newton."""
    out = mp.arg(mp.mpc(1, eta)) - leaving
    low, high = mp.mpf("1e-3"), 2 * mp.pi + out  # below it until they meet, above it then
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _apart(eta, out, middle) < 0 else (low, middle)
    for _ in range(6):
        slope = mp.sin(low + (2 * mp.pi - out)) * -1 - mp.sin(out) * mp.exp(-low / eta)
        low -= _apart(eta, out, low) / slope
    return low


def _pressed(engagement: Number, eta: Number, leaving: Number, free: Number) -> Number:
    """The pressure's share summed over a contact that ends without pressure."""
    out = mp.arg(mp.mpc(1, eta)) - leaving
    ends = mp.cos(out) + eta * mp.sin(out)
    return NUMBERS.integral(
        lambda u: engagement * (mp.cos(u) + eta * mp.sin(u) - ends) / 2, out, out + 2 * mp.pi - free
    )


def _carried(p: Point, m: Maths) -> Found:
    out = _out(p)
    return {
        "carried": _pressed(p.engagement, p.eta_m, p.leaving, p.free),
        "carried_leaving": m.derivative(
            lambda leaving: _pressed(p.engagement, p.eta_m, leaving, _meets(p.eta_m, leaving)), p.leaving
        ),
        "share": -p.engagement * abs(mp.mpc(1, p.eta_m)) * mp.cos(out - mp.arg(mp.mpc(1, p.eta_m))),
    }


def _touching(values: dict[str, Number], at: random.Random) -> None:
    """Contacts that begin where surface and recovering layer meet, some of them almost all round."""
    values["eta_m"], values["leaving"] = mp.mpf(at.uniform(0.02, 0.6)), mp.mpf(at.uniform(0.7, 3.1))
    values["free"] = _meets(values["eta_m"], values["leaving"])


def _apart_at(values: dict[str, Number], at: random.Random) -> None:
    values["eta_m"], values["leaving"] = mp.mpf(at.uniform(0.05, 0.6)), mp.mpf(at.uniform(0.7, 3.1))
    values["free"] = mp.mpf(at.choice((at.uniform(0.01, 0.5), at.uniform(0.5, 5))))


def _overlap(of: Callable[[Number], Number], p: Point, low: Number, high: Number) -> Number:
    """Sum over the contact, of what lies between two places less what lies outside, modulo a turn."""
    turn = 2 * mp.pi
    stops = sorted({p.u_out, p.u_in, *(q for k in (-1, 0, 1) for q in (low + k * turn, high + k * turn))})
    stops = [q for q in stops if p.u_out <= q <= p.u_in]
    total = mp.mpf(0)
    for start, end in pairwise(stops):
        middle = (start + end) / 2
        inside = any(low < middle + k * turn < high for k in (-1, 0, 1))
        total += (1 if inside else -1) * NUMBERS.integral(of, start, end)
    return total


def _share_at(p: Point, u: Number) -> Number:
    return (p.engagement * (mp.cos(u) + p.eta_m * mp.sin(u)) + p.share) / 2


def _reaction(p: Point, m: Maths) -> Found:
    """Pressure and friction, a sign times the pressure, summed over the contact, alone, times cos u and sin u."""

    def sums(weight: Callable[[Number], Number], wider: Number = 0) -> Number:
        return _overlap(lambda u: _share_at(p, u) * weight(u), p, p.zone_low - wider, p.zone_high + wider)

    def all_(weight: Callable[[Number], Number]) -> Number:
        return m.integral(lambda u: _share_at(p, u) * weight(u), p.u_out, p.u_in)

    rest = all_(lambda u: u**0) - 1  # 0 where the contact carries its load
    widened = mp.mpf("1e-40")
    slope = (sums(lambda u: u**0, widened) - sums(lambda u: u**0, -widened)) / (2 * widened)
    return {
        "f": sums(lambda u: u**0) + rest,
        "f_alpha": slope,
        "central": p.F_c * all_(mp.cos),
        "lossy": p.F_c * all_(mp.sin),
        "along": p.mu * p.F_c * sums(mp.cos),
        "across": p.mu * p.F_c * sums(mp.sin),
    }


def _reaction_slope(p: Point, m: Maths) -> Found:
    """All of them; the slope, whose error is that of a difference, to fewer digits."""
    return {"f_alpha": _reaction(p, m)["f_alpha"]}


def _wide(values: dict[str, Number], at: random.Random) -> None:
    """Contacts that reach beyond half a wave at either end, or all round; zones about the crest, beside it, beyond."""
    reach = at.choice(
        ((-3.4, -2.6, 2.0, 2.7), (-2.5, -1.5, 3.2, 3.6), (-1.2, -0.3, 0.3, 1.4), (-3.1415, -3.14, 3.14, 3.1415))
    )
    values["eta_m"] = mp.mpf(at.uniform(0.05, 0.5))
    values["u_out"], values["u_in"] = mp.mpf(at.uniform(*reach[:2])), mp.mpf(at.uniform(*reach[2:]))
    if reach[3] < 2:  # narrow: beside the zone, too
        half, middle = mp.mpf(at.choice((at.uniform(0.2, 3.0), 0.1))), mp.mpf(at.choice((0.0, 1.8, -1.8, -1.8)))
    else:
        half = mp.mpf(at.choice((at.uniform(0.2, 3.0), at.uniform(2.6, 3.1))))
        middle = mp.mpf(at.choice((0.0, at.uniform(0.3, 0.8), at.uniform(-0.8, -0.3))))
    values["zone_low"], values["zone_high"] = middle - half, middle + half


def _balance(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Dynamic stiffness, pressure's and friction's first harmonics as complex numbers; where the real part is 0."""
    lever = p.D * p.k_c
    contact = mp.mpc(p.central, p.lossy) + 1j * lever * mp.mpc(p.along, p.across)

    def force(omega: Number) -> Number:
        return p.M_q * p.W * mp.mpc(p.omega_n0**2 - omega**2, 2 * p.xi * p.omega_n0 * omega) + contact

    whole = force(p.omega_q)
    square = p.omega_n0**2 + contact.real / (p.M_q * p.W)
    return {
        "in_phase": whole.real,
        "ahead": whole.imag,
        "residual": (whole * whole.conjugate()).real - p.F_q**2,
        "lead": mp.arg(whole),
        "omega_r": mp.sqrt(square),
    }


def _without_contact(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Where the dynamic stiffness at the resonance with the contact, and the contact's part of it, add up to 0."""
    contact = mp.mpc(p.central, 0) + 1j * p.D * p.k_c * mp.mpc(0, p.across)

    def force(own: Number) -> Number:
        return (p.M_q * p.W * mp.mpc(own**2 - p.omega_n**2, 0) + contact).real

    return {"omega_n0": mp.findroot(force, (p.omega_n, p.omega_n * mp.mpf("0.999")), tol=mp.mpf(10) ** -90)}


def _powers(p: Point, m: Maths) -> Found:
    """Means over a period of force times speed: damping, traction and pressure on the surface, friction on the rim."""
    period, size, whole = 2 * m.pi / p.omega_q, p.omega_q * p.W, (-m.pi + 0 * p.W, m.pi + 0 * p.W)

    def damped(t: Number) -> Number:
        speeds = (size * m.cos(p.omega_q * t), size * m.sin(p.omega_q * t))
        return sum(2 * p.xi * p.omega_n0 * p.M_q * speed**2 for speed in speeds)

    stator = m.integral(damped, 0 * period, period) / period
    pulled = m.integral(lambda u: p.along * m.cos(u) / m.pi * (p.D * p.k_c * size * m.cos(u)), *whole)
    pressed = m.integral(lambda u: p.lossy * m.sin(u) / m.pi * (size * m.sin(u)), *whole)
    rim = p.f * p.mu * p.F_c * p.v
    return {
        "P_in": stator + pulled + pressed,
        "P_stator": stator,
        "P_contact": pulled + pressed,
        "P_layer": pressed,
        "P_slip": pulled - rim,
        "P_rotor": rim,
    }


def _passage(p: Point, m: Maths) -> Found:
    """The stress grows with the slip; stress and limit are integrated over the way, alone, times cos u and sin u."""

    def stress(at: Number) -> Number:
        return p.t_0 + m.integral(lambda s: p.grip * (m.cos(s) - p.ratio), p.u_0, at)

    def limit(at: Number) -> Number:
        return m.cos(at) - p.level

    found: dict[str, Number] = {"stress": stress(p.u), "limit": limit(p.u)}
    found |= {"stress_u": m.derivative(stress, p.u), "limit_u": m.derivative(limit, p.u)}
    # a rotor that is faster by 1 shears by grip less for each angle passed
    found["stuck_ratio"] = m.integral(lambda at: -m.integral(lambda s: p.grip * s**0, p.u_0, at), p.u_0, p.u)
    for kind, of in (("stuck", stress), ("slid", limit)):
        found[kind] = m.integral(of, p.u_0, p.u)
        found[f"{kind}_cos"] = m.integral(partial(_times, of, m.cos), p.u_0, p.u)
        found[f"{kind}_sin"] = m.integral(partial(_times, of, m.sin), p.u_0, p.u)
    return found


def _times(one: Callable[[Number], Number], other: Callable[[Number], Number], at: Number) -> Number:
    return one(at) * other(at)


def _sheared(p: Point, m: Maths) -> Found:
    """The bristles' stress over that of the prepressure; the pressure summed over the contact."""
    of_all = p.engagement / 2 * p.F_c  # k_N W n_j / k_c
    pressed = m.integral(lambda u: p.F_c * (p.engagement * m.cos(u) + p.share) / 2 * m.cos(u), -p.theta, p.theta)
    return {
        "f": of_all * p.sheared / p.F_c,
        "f_ratio": p.sheared_ratio / p.F_c * of_all,
        "central": pressed,
        "along": of_all * p.mu * p.sheared_cos,
        "across": of_all * p.mu * p.sheared_sin * -1,
    }


def _stuck(p: Point, m: Maths) -> Found:
    """The greatest of stress less limit of a wave of unit height, found by Newton; the stress's part in sin u."""
    place = mp.findroot(lambda u: mp.diff(lambda s: p.grip * mp.sin(s) - mp.cos(s), u), 2.2, solver="secant")
    most = p.grip * mp.sin(place) - mp.cos(place)
    length = 2 * m.pi * p.n_j / p.k_c
    # grip cos u + sin u, along exp(i u), is never more than the size of grip + i
    fastest = abs(mp.mpc(p.grip, 1)) / p.grip
    return {
        "ratio_most": fastest,
        "W_stick": (p.F_c - abs(p.f) * p.F_c) / length / p.k_N / most,
        "sheared_sin": m.integral(lambda u: p.grip * m.sin(u) ** 2, -m.pi + 0 * p.grip, m.pi + 0 * p.grip),
    }


_RESTS = "lossy-layer"
_SHEAR = "sheared-layer"
PROOFS = (
    Proof(
        "trum_layer_meeting",
        "gap gap_free u_in u_out",
        _RESTS,
        "surface less what is left of an element that recovers, its difference quotient; an argument",
        _meeting,
        grid("eta_m free leaving", 12, _apart_at),
        "random elements, just free and about to touch",
        tolerance=1e-30,
    ),
    Proof(
        "trum_layer_carried",
        "carried carried_leaving share",
        _RESTS,
        "pressure summed over the contact; its difference quotient along contacts that begin where both meet",
        _carried,
        grid("engagement eta_m free leaving", 8, _touching),
        "random contacts, narrow to nearly all round",
        tolerance=1e-30,
    ),
    Proof(
        "trum_layer_reaction",
        "f central lossy along across",
        f"30 36 {_RESTS}",
        "pressure and friction summed over the contact, alone, times cos u and sin u",
        _reaction,
        grid("F_c engagement eta_m mu share u_in u_out zone_high zone_low", 40, _wide),
        "random contacts, partial, beyond half a wave, all round; zones about the crest and beside it",
    ),
    Proof(
        "trum_layer_reaction",
        "f_alpha",
        f"36 {_RESTS}",
        "difference quotient of that sum as the zone widens",
        _reaction_slope,
        grid("F_c engagement eta_m mu share u_in u_out zone_high zone_low", 40, _wide),
        "the same",
        tolerance=1e-25,
        floor=1,
    ),
    Proof(
        "trum_layer_balance",
        "in_phase ahead residual lead omega_r",
        f"{_RESTS} {_SHEAR}",
        "dynamic stiffness and the contact's first harmonics as complex numbers; where the real part is 0",
        _balance,
        grid("D F_q M_q W across along central k_c lossy omega_n0 omega_q xi", 12),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_without_contact",
        "omega_n0",
        f"{_RESTS} {_SHEAR}",
        "where dynamic stiffness and the contact's first harmonics add up to 0",
        _without_contact,
        grid("D M_q W across central k_c omega_n", 12),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_layer_powers",
        "P_in P_stator P_contact P_layer P_slip P_rotor",
        f"{_RESTS} {_SHEAR}",
        "means over a period of force times speed",
        _powers,
        grid("D F_c M_q W along f k_c lossy mu omega_n0 omega_q v xi"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_shear_passage",
        "stress limit stuck slid stuck_cos stuck_sin slid_cos slid_sin stress_u limit_u stuck_ratio",
        f"30 36 {_SHEAR}",
        "slip, stress and limit integrated over the way, alone, times cos u and sin u",
        _passage,
        grid("grip level ratio t_0 u u_0", 8),
        "random places and states",
    ),
    Proof(
        "trum_shear_reaction",
        "f f_ratio central along across",
        f"30 {_SHEAR}",
        "the stress over that of the prepressure; pressure summed over the contact",
        _sheared,
        grid("F_c engagement mu share sheared sheared_cos sheared_ratio sheared_sin theta", 8, balanced),
        "random contacts that carry their load, partial and full",
    ),
    Proof(
        "trum_stuck_layer",
        "W_stick sheared_sin ratio_most",
        f"30 {_SHEAR}",
        "where the greatest of stress less limit is 0; the stress's part in sin u",
        _stuck,
        grid("F_c f grip k_N k_c n_j", 8),
        "random points, loads of either sign",
    ),
)
