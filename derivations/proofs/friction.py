"""Proofs of friction's kernels: the share of the contact where the surface is faster than the rotor (eqs. 33 to 38).

Friction is summed as what it is, the sign of the slip times the pressure over the contact: where the slip changes its
sign is found by bisection between the surface speed's extremes, and the pressure between two such points is integrated.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from itertools import pairwise

import mpmath as mp

from derivations.proofs.contact import TINY, balanced, half_angle, load, turned
from derivations.proofs.maths import DIGITS, Maths, Number, Point
from derivations.proofs.proof import Proof, draw, grid

__all__ = ["PROOFS", "changes", "states"]

Found = Mapping[str, Number | None]


def _root(function: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """Where a function that changes its sign once does so: bisection in few digits, then secants.

    Once a secant's step is two thirds of the digits small, the next one would be below all of them.
    """
    rising, left, right = function(high) > 0, float(low), float(high)
    with mp.workdps(16):
        for _ in range(22):
            middle = (left + right) / 2
            left, right = (left, middle) if (function(mp.mpf(middle)) > 0) == rising else (middle, right)
    before, at = mp.mpf(left), mp.mpf(right)
    for _ in range(12):
        one, other = function(before), function(at)
        if one == other:
            break
        before, at = at, at - other * (at - before) / (other - one)
        if abs(at - before) < mp.mpf(10) ** (-mp.mp.dps * 2 // 3):
            break
    return at


def _slip(p: Point) -> Callable[[Number], Number]:
    return lambda u: p.R_v * mp.cos(u - p.phi) - p.v


def changes(p: Point) -> list[Number]:
    """Where the slip changes its sign inside the contact."""
    slip = _slip(p)
    extremes = [p.phi + k * mp.pi for k in range(-3, 4)]
    stops = [-p.theta, *(u for u in extremes if -p.theta < u < p.theta), p.theta]
    return [_root(slip, a, b) for a, b in pairwise(stops) if (slip(a) > 0) != (slip(b) > 0)]


def _fraction(p: Point) -> Number:
    """Sum of the sign of the slip times the share of the load, over the contact."""
    slip, total = _slip(p), mp.mpf(0)

    def carried(u: Number) -> Number:
        return (p.engagement * mp.sin(u) + p.share * u) / 2

    for a, b in pairwise([-p.theta, *changes(p), p.theta]):
        total += mp.sign(slip((a + b) / 2)) * (carried(b) - carried(a))
    return total


def _slope(function: Callable[[Number], Number], at: Number) -> Number:
    step = mp.mpf(10) ** (-DIGITS // 2) * (abs(at) or 1)
    with mp.workdps(2 * DIGITS):
        return (function(at + step) - function(at - step)) / (2 * step)


def _friction(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The sum, its difference quotient by the speed; the pressure at both points as fast as the rotor.

    Round the circle from where the surface is fastest, phi, its speed falls below the rotor's once, and rises above
    it once on the other side; a rotor out of its range is nearest to it at phi, or half a turn on.
    """
    slip = _slip(p)
    if abs(p.v) < p.R_v:
        falls, rises = _root(slip, p.phi, p.phi + mp.pi), _root(slip, p.phi - mp.pi, p.phi)
        by_speed = _slope(lambda v: _fraction(p.with_(v=v)), p.v)
    else:
        falls = rises = p.phi if p.v > 0 else p.phi + mp.pi
        by_speed = mp.mpf(0)
    return {
        "f": _fraction(p),
        "f_v": by_speed,
        "p_1": p.engagement * mp.cos(falls) + p.share,
        "p_2": p.engagement * mp.cos(rises) + p.share,
    }


def _slopes(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Difference quotients of the sum by phi, and by ln E along states that carry their load; theta's own.

    Under the paper's Hertz width theta falls as the root of the height, and E follows from the balance.
    """
    full = p.theta >= mp.pi

    def at(log_change: Number) -> Point:
        engagement = p.engagement * mp.exp(log_change)
        if full:
            return p.with_(engagement=engagement)
        theta = half_angle(1 / (mp.pi * engagement))
        return p.with_(engagement=engagement, theta=theta, share=-engagement * mp.cos(theta))

    def log_engagement(log_height: Number) -> Number:
        return -mp.log(load(p.theta * mp.exp(-log_height / 2)))

    sliding = abs(p.v) < p.R_v
    return {
        "f_phi": _slope(lambda phi: _fraction(p.with_(phi=phi)), p.phi) if sliding else mp.mpf(0),
        "f_E": _slope(lambda change: _fraction(at(change)), mp.mpf(0)) if sliding else mp.mpf(0),
        "theta_E": mp.mpf(0) if full else _slope(lambda change: at(change).theta, mp.mpf(0)),
        "E_height": None if full else _slope(log_engagement, mp.mpf(0)),
    }


def _beyond(values: dict[str, Number], at: random.Random) -> None:
    """A contact that carries its load and a rotor beyond the surface's speeds."""
    values["v"] = values["R_v"] * mp.mpf(at.uniform(1.01, 2) * at.choice((1, -1)))
    turned(values, at)


def states() -> list[Point]:
    """States that between them have each of both points as fast as the rotor wherever it can be, on either side.

    In a partial contact: inside it, beside it, far from it; in a full one; past half a turn, just before and after it.
    """
    found = []
    cases = [(sign, side, place) for sign in (1, -1) for side in (1, -1) for place in _PLACES]
    for index, (sign, side, place) in enumerate(cases * 2):
        at = random.Random(f"state {index}")
        low, high, widths = _PLACES[place]
        theta = at.uniform(*widths)
        u = side * at.uniform(*(a + b * theta for a, b in (low, high)))
        alpha = at.uniform(0.003, 0.02) if index < len(cases) else at.uniform(0.1, 3.1)
        values = {"R_v": draw("R_v", index)}
        balanced(values, at, mp.mpf(theta) if theta < _FULL else +mp.pi)
        phi = mp.mpf(u) - sign * mp.mpf(alpha)
        phi -= 2 * mp.pi * mp.nint(phi / (2 * mp.pi))
        values |= {"phi": phi, "cos_phi": mp.cos(phi), "sin_phi": mp.sin(phi), "v": values["R_v"] * mp.cos(alpha)}
        found.append(Point(values))
    return found


def _standing() -> list[Point]:
    """Surface and rotor stand still, at a contact that carries its load."""
    return [states()[0].with_(R_v=mp.mpf(0), v=mp.mpf(0), tiny=TINY)]


def _limit(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """df/dv times dt/dsigma, a step's 1e-60th from where the rotor is as fast as the surface.

    Towards the side where some of the surface is faster.  The zone's half-width is alpha = acos(|v|/R_v), each end adds
    the pressure there over its mean, where there is any, and d alpha/dv = -1/sqrt(R_v^2 - v^2).
    """
    sigma = mp.mpf(10) ** -60
    with mp.workdps(400):
        side = 1 if p.R_v * p.R_v_rate > p.v * p.v_rate else -1
        time = side * p.step * sigma**2
        surface, rotor = p.R_v + p.R_v_rate * time, p.v + p.v_rate * time
        narrowing = -1 / mp.sqrt(surface**2 - rotor**2)
        ends = sum(pressure for pressure in (p.p_larger, p.p_smaller) if pressure > 0)
        return {"T_f_v": ends * narrowing * 2 * p.step * sigma}


def _as_fast(values: dict[str, Number], at: random.Random) -> None:
    values["v"] = values["R_v"] * at.choice((1, -1))


_FULL = 3.1  # from this half-angle on the whole wave is taken to touch
_PLACES: dict[str, tuple[tuple[float, float], tuple[float, float], tuple[float, float]]] = {
    "inside": ((0, 0.02), (0, 0.98), (0.3, 3.0)),
    "inside of nearly all": ((0, 0.02), (0, 0.98), (3.02, 3.09)),
    "beside": ((0, 1.05), (0.98, 0), (0.3, 0.7)),
    "far": ((1.1, 0), (3.0, 0), (0.3, 0.9)),
    "full": ((0.02, 0), (3.0, 0), (3.12, 3.14)),
    "half a turn": ((3.02, 0), (3.13, 0), (3.12, 3.14)),
    "past it": ((3.15, 0), (3.25, 0), (3.12, 3.14)),
    "past it, beside": ((3.16, 0), (3.25, 0), (2.86, 3.0)),
}
"""Between which angles a + b theta, by a and b, a point as fast as the rotor lies, and of which half-angles theta."""
_LIMIT = "R_v R_v_rate p_larger p_smaller step v v_rate"
_INSIDE = "64 states: each of both points inside, beside, far from the contact, about half a turn"
_BEYOND = "16 random states with a rotor beyond the surface's speeds"


def _grip(p: Point, m: Maths) -> Found:
    """Stress of a bristle on a held rotor, carried from the side of the wave to its top, over friction's scale."""
    quarter = m.pi / 2 / p.omega_q
    fastest = p.omega_q * (p.D * p.k_c * p.W)  # a point of the surface goes D k_c W to either side
    carried = m.integral(lambda t: fastest * m.cos(p.omega_q * t), -quarter, 0 * quarter)
    return {"grip": p.k_T * carried / (p.mu * p.k_N * p.W), "R_v": fastest}


def _passage(p: Point, m: Maths) -> Found:
    """The stress grows with the slip; both are integrated over the way."""

    def stress(at: Number) -> Number:
        return p.t_0 + m.integral(lambda s: p.grip * (m.cos(s) - p.ratio), p.u_0, at)

    def limit(at: Number) -> Number:
        return m.cos(at) - m.cos(p.theta)

    return {
        "stress": stress(p.u),
        "limit": limit(p.u),
        "stuck": m.integral(stress, p.u_0, p.u),
        "slid": m.integral(limit, p.u_0, p.u),
    }


def _turns(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Half of the zeros' sum and difference of what grows faster, stress or limit; none: all the way or nowhere."""
    whole = mp.mpc(p.grip, 1)  # grip cos u + sin u is its part along exp(i u)
    share = p.grip * p.ratio / abs(whole)
    span = mp.mpf(0) if share >= 1 else +mp.pi if share <= -1 else mp.acos(share)
    return {"delay": mp.arg(whole), "span": span}


PROOFS = (
    Proof(
        "trum_brush_coefficient",
        "grip R_v",
        "16 36",
        "stress of a bristle that a quarter period carries along",
        _grip,
        grid("D W k_N k_T k_c mu omega_q"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_brush_passage",
        "stress limit stuck slid",
        "30 36",
        "slip and stress integrated over the way",
        _passage,
        grid("grip ratio t_0 theta u u_0"),
        "random places and states",
        symbolic=True,
    ),
    Proof(
        "trum_brush_turns",
        "delay span",
        "36",
        "argument and part of a complex number; all the way or nowhere beyond",
        _turns,
        grid("grip ratio", 12),
        "random states, some in which a bristle slides all the way",
    ),
    Proof(
        "trum_friction",
        "f f_v p_1 p_2",
        "33 34 35 36 37 rotor-orbit",
        "sum of the slip's sign times the pressure; its difference quotient; pressure where the slip is 0",
        _friction,
        states,
        _INSIDE,
        floor=1,
    ),
    Proof(
        "trum_friction",
        "f f_v p_1 p_2",
        "33 34 35 36 37 rotor-orbit",
        "all of friction in one sense, slope 0",
        _friction,
        grid("R_v", 16, _beyond),
        _BEYOND,
        floor=1,
    ),
    Proof(
        "trum_friction",
        "f f_v p_1 p_2",
        "36",
        "finite, slope 0",
        lambda p, m: {"f": None, "f_v": mp.mpf(0), "p_1": None, "p_2": None},  # noqa: ARG005
        _standing,
        "surface and rotor at rest",
    ),
    Proof(
        "trum_friction_slopes",
        "f_phi f_E theta_E E_height",
        "31 36 rotor-orbit",
        "difference quotients of the sum by phi and along states that carry their load",
        _slopes,
        states,
        _INSIDE,
        floor=1,
    ),
    Proof(
        "trum_friction_slopes",
        "f_phi f_E theta_E E_height",
        "31 36 rotor-orbit",
        "none by the engagement",
        _slopes,
        grid("R_v", 16, _beyond),
        _BEYOND,
        floor=1,
    ),
    Proof(
        "trum_friction_slopes",
        "f_phi f_E theta_E E_height",
        "36",
        "finite",
        lambda p, m: dict.fromkeys(("f_phi", "f_E", "theta_E", "E_height")),  # noqa: ARG005
        _standing,
        "surface and rotor at rest",
    ),
    Proof(
        "trum_friction_limit",
        "T_f_v",
        "36 rotor-orbit",
        "slope by the speed a step's 1e-60th from where rotor and surface are equally fast",
        _limit,
        grid(_LIMIT, 12, _as_fast),
        "random rates, pressures of either sign",
    ),
    Proof(
        "trum_friction_limit",
        "T_f_v",
        "36 rotor-orbit",
        "finite",
        lambda p, m: {"T_f_v": None},  # noqa: ARG005
        lambda: [grid(_LIMIT, 1)()[0].with_(v=mp.mpf(0), R_v=mp.mpf(0), tiny=TINY)],
        "surface and rotor at rest",
    ),
)
