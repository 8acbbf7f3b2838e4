"""Proofs of the contact's kernels: how much of the wave touches, the pressure there, the rotor's coefficients."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping

import mpmath as mp
import sympy as sp

from derivations.proofs.maths import Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS", "balanced", "half_angle", "load", "turned"]

Found = Mapping[str, Number | None]
TINY = mp.mpf("1e-37")


def load(theta: Number) -> Number:
    """Force of springs of unit stiffness under a wave of unit height that touches up to theta, halved."""
    return mp.sin(theta) - theta * mp.cos(theta)


def half_angle(filled: Number) -> Number:
    """Theta at which the load is pi times ``filled``: the load grows, so by bisection in few digits, then Newton."""
    if filled >= 1:
        return +mp.pi
    low, high, wanted = 0.0, math.pi, math.pi * float(filled)
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if math.sin(middle) - middle * math.cos(middle) < wanted else (low, middle)
    theta = mp.mpf((low + high) / 2)
    for _ in range(9):
        sine = mp.sin(theta)
        step = (sine - theta * mp.cos(theta) - mp.pi * filled) / (theta * sine)
        theta -= step
        if abs(step) < mp.mpf(10) ** (-mp.mp.dps * 2 // 3):  # the next one has more digits than there are
            break
    return theta


def balanced(values: dict[str, Number], at: random.Random, theta: Number = None) -> None:
    """Makes engagement, share and sine those of a contact that carries its load; a third touches all round."""
    if theta is None:
        theta = +mp.pi if at.random() < 1 / 3 else mp.mpf(at.uniform(0.3, 3.0))
    if theta >= mp.pi:
        engagement = mp.mpf(at.uniform(0.05, 0.99)) / mp.pi
        values |= {"theta": theta, "sin_theta": mp.mpf(0), "engagement": engagement, "share": 1 / mp.pi}
        return
    engagement = 1 / load(theta)
    values |= {"theta": theta, "sin_theta": mp.sin(theta), "engagement": engagement}
    values["share"] = -engagement * mp.cos(theta)


def _coefficients(p: Point, m: Maths) -> Found:
    """From the force of a layer that touches up to theta, from angular momentum, and from where theta is pi."""
    one_crest = m.integral(lambda u: p.k_N * (m.cos(u) + 1), -m.pi, m.pi) / p.k_c  # whole wave, unit height
    rounded = sp.Rational(str(round(float(mp.sqrt(8 / mp.pi)), 1)))
    squeezed = (1 - p.mu_e) * (1 + p.mu_e) / p.E_eq + (1 - p.mu_m) * (1 + p.mu_m) / p.E_m
    # width^2 = rounded^2 P rho_k C_E is the square of a wavelength, rho_k = 2 r_t^2/(n_j^2 W)
    length = 2 * m.pi / p.k_c
    inertia = 2 * _energy(p, m)
    factor = rounded**2 if isinstance(p.k_c, sp.Basic) else mp.mpf(int(rounded.p)) ** 2 / int(rounded.q) ** 2
    return {
        # force of all crests over prepressure is the engagement times sin theta - theta cos theta: at theta = pi, pi
        "engagement_per_height": p.n_j * one_crest / p.F_c / m.pi,
        "push": p.r_c * (p.r_c * p.mu * p.F_c) / inertia,
        "drag": p.r_c * p.T_load / inertia,
        "W_full_hertz": factor * p.F_c / (p.n_j * p.b_m) * 2 * (p.r_t / p.n_j) ** 2 * squeezed / length**2,
        "W_full_winkler": p.F_c / (p.n_j * one_crest),
    }


def _gravity(p: Point) -> Number:
    return sp.Rational(980665, 100000) if isinstance(p.J, sp.Basic) else mp.mpf(9.80665)


def _energy(p: Point, m: Maths) -> Number:
    """Kinetic energy at one radian a second: of rotor and plate, and of the weight that the string moves with them."""
    weight = m.absolute(p.T_load) / p.r_s / _gravity(p)
    return (p.J + p.J_load) / 2 + weight * p.r_s**2 / 2


def _tension(p: Point, m: Maths) -> Found:
    """Newton's law for both bodies: rotor and plate under friction and string, the weight under string and gravity."""
    weight = m.absolute(p.T_load) / p.r_s / _gravity(p)
    # (J + J_load) turn = friction - S r_s and weight r_s turn = S - weight g, by Cramer's rule
    bodies, friction = p.J + p.J_load, p.r_c * p.mu * p.F_c * p.f
    pull = (weight * p.r_s * friction + weight * _gravity(p) * bodies) / (bodies + weight * p.r_s**2)
    return {"tension": pull / (weight * _gravity(p))}


def _filling(p: Point, m: Maths) -> Found:
    """The half-angle that balances the load fills its share of the wave."""
    engaged = p.engagement_per_height * p.W_c
    theta = half_angle(1 / (m.pi * engaged))
    return {"engagement": engaged, "fullness": load(theta) / load(+mp.pi)}


def _no_wave() -> list[Point]:
    return [grid("engagement_per_height", 1)()[0].with_(W_c=mp.mpf(0), tiny=TINY)]


def _winkler(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The half-angle by bisection; the share that makes the pressure 0 at the contact's edge."""
    theta = half_angle(p.fullness)
    return {"theta": theta, "sin_theta": mp.sin(theta), "share": -mp.cos(theta) / load(theta)}


def _fullnesses() -> list[Point]:
    """Of half-angles from 0.004 pi on, in 250 equal steps, and the whole wave."""
    found = []
    for i in range(1, 251):
        full = load(mp.pi * i / 250) / mp.pi if i < 250 else mp.mpf(1)
        found.append(Point({"fullness": full, "fullness_root": mp.cbrt(full), "tiny": TINY}))
    return found


def _hertz(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Theta falls as the root of the height from pi at full contact; engagement and share carry the load."""
    theta = +mp.pi if p.W_c <= p.W_full else mp.sqrt(mp.pi**2 * p.W_full / p.W_c)
    # engagement sin theta + share theta = 1, engagement cos theta + share = 0
    size = mp.sin(theta) - theta * mp.cos(theta)
    return {"theta": theta, "sin_theta": mp.sin(theta), "engagement": 1 / size, "share": -mp.cos(theta) / size}


def _heights(values: dict[str, Number], at: random.Random) -> None:
    values["W_c"] = values["W_full"] * mp.mpf(at.choice((at.uniform(0.1, 1), at.uniform(1, 3), at.uniform(3, 20))))


def _no_height() -> list[Point]:
    return [grid("W_full", 1)()[0].with_(W_c=mp.mpf(0), tiny=TINY)]


def _peak(p: Point, m: Maths) -> Found:
    """The density engagement cos u + share, scaled to carry the prepressure on strips b_m wide, under the crest."""
    over_the_contact = m.integral(lambda u: p.engagement * m.cos(u) + p.share, -p.theta, p.theta)
    return {"pressure": p.F_c * (p.engagement + p.share) / (p.n_j * p.b_m * over_the_contact / p.k_c)}


def _stall(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Friction's force at the radius r_c."""
    return {"torque": (p.mu * p.F_c * p.f) * p.r_c}


def _interface(p: Point, m: Maths) -> Found:
    """The surface's speed, the pressure that carries the prepressure, friction in the sense of the slip."""

    def speed(x: Number) -> Number:
        phi = mp.arg(mp.mpc(p.cos_phi, p.sin_phi))
        return p.R_v * mp.cos(p.k_c * (x - p.x_max) - phi)

    share = (p.engagement * mp.cos(p.k_c * (p.x - p.x_max)) + p.share) / 2  # of a crest's load, per angle
    pressure = p.F_c / p.n_j * (share if share > 0 else mp.mpf(0)) * p.k_c
    slip = speed(p.x) - p.v
    return {
        "v_x": speed(p.x),
        "v_x_slope": m.derivative(speed, p.x),
        "p": pressure,
        "traction": p.mu * pressure * mp.sign(slip),
    }


def turned(values: dict[str, Number], at: random.Random) -> None:
    """Makes cosine and sine those of an angle, and the contact carry its load."""
    phi = mp.mpf(at.uniform(-3.1, 3.1))
    values |= {"phi": phi, "cos_phi": mp.cos(phi), "sin_phi": mp.sin(phi)}
    balanced(values, at)


def _contact_limit(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The half-angle's slope times dt/dsigma, a step's 1e-60th from full contact, from the balance solved there."""
    sigma = mp.mpf(10) ** -60
    with mp.workdps(260):
        time = p.step * sigma**2
        filled = 1 / (1 + abs(p.W_c_rate) / p.W_full * time)  # 1 over engagement and pi; it is in proportion to W_c
        near = mp.sqrt(2 * (1 - filled))  # load is pi - pi near^2/2 + near^3/3 to this order
        for _ in range(12):
            near += (load(mp.pi - near) - mp.pi * filled) / ((mp.pi - near) * mp.sin(mp.pi - near))
        theta = mp.pi - near
        slope = -load(theta) / (theta * mp.sin(theta))  # of load(theta) = pi filled by ln filled, filled as 1/E
        return {"T_theta_E": slope * 2 * p.step * sigma}


def _still(names: str, **values: int) -> Callable[[], list[Point]]:
    return lambda: [grid(names, 1)()[0].with_(tiny=TINY, **{name: mp.mpf(value) for name, value in values.items()})]


def _finite(*names: str) -> Callable[[Point, Maths], Found]:
    return lambda p, m: dict.fromkeys(names)  # noqa: ARG005


_SURFACE = "F_c R_v k_c mu n_j v x x_max"
PROOFS = (
    Proof(
        "trum_rotor_coefficients",
        "engagement_per_height push drag W_full_hertz W_full_winkler",
        "25 26 30 31 38 load-inertia",
        "force of the layer under a whole wave; angular momentum; kinetic energy of rotor, plate and weight; heights "
        "at which the half-angle is pi",
        _coefficients,
        grid("E_eq E_m F_c J J_load T_load b_m k_N k_c mu mu_e mu_m n_j r_c r_s r_t"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_total_inertia",
        "J_total",
        "load-inertia",
        "twice the kinetic energy of rotor, plate and weight at one radian a second",
        lambda p, m: {"J_total": 2 * _energy(p, m)},
        grid("J J_load T_load r_s"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_string_tension",
        "tension",
        "load-inertia",
        "Newton's law for rotor and weight, solved for the string's pull",
        _tension,
        grid("F_c J J_load T_load f mu r_c r_s"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_filling",
        "engagement fullness",
        "31",
        "load at the half-angle that balances it, found by bisection, over that of the whole wave",
        _filling,
        grid(
            "W_c engagement_per_height",
            12,
            lambda v, at: v.update(W_c=mp.mpf(at.uniform(0.2, 9)) / 20 / v["engagement_per_height"] * 10),
        ),
        "random heights, partly and wholly in contact",
    ),
    Proof(
        "trum_filling",
        "engagement fullness",
        "31",
        "whole wave in contact",
        lambda p, m: {"engagement": mp.mpf(0), "fullness": mp.mpf(1)},  # noqa: ARG005
        _no_wave,
        "no wave",
    ),
    Proof(
        "trum_contact_winkler",
        "theta sin_theta share",
        "28 30 31",
        "half-angle by bisection; no pressure at the edge",
        _winkler,
        _fullnesses,
        "250 half-angles from 0.004 pi to pi",
        tolerance=4e-14,
        floor=1,
    ),
    Proof(
        "trum_contact_hertz",
        "theta sin_theta share engagement",
        "25 26 30 31",
        "half-angle as the root of the height; the load is carried, no pressure at the edge",
        _hertz,
        grid("W_c W_full", 12, _heights),
        "random heights, partly and wholly in contact",
    ),
    Proof(
        "trum_contact_hertz",
        "theta sin_theta share engagement",
        "25 26 30 31",
        "whole wave in contact",
        _hertz,
        _no_height,
        "no wave",
    ),
    Proof(
        "trum_peak_pressure",
        "pressure",
        "28 30 31",
        "the density scaled to carry the prepressure, under the crest",
        _peak,
        grid("F_c b_m k_c n_j", 6, balanced),
        "random contacts that carry their load",
    ),
    Proof(
        "trum_stall_torque",
        "torque",
        "38",
        "friction's force at the radius",
        _stall,
        grid("F_c f mu r_c"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_interface",
        "v_x v_x_slope p traction",
        "16 32 36",
        "the surface's speed and its slope; density that carries the prepressure; friction in the sense of the slip",
        _interface,
        grid(_SURFACE, 12, turned),
        "random places, inside and outside of the contact, slip in either sense",
    ),
    Proof(
        "trum_interface",
        "v_x v_x_slope p traction",
        "37",
        "no traction without slip",
        lambda p, m: {"v_x": mp.mpf(0), "v_x_slope": mp.mpf(0), "p": None, "traction": mp.mpf(0)},  # noqa: ARG005
        lambda: [grid(_SURFACE, 1, turned)()[0].with_(R_v=mp.mpf(0), v=mp.mpf(0))],
        "surface and rotor at rest",
    ),
    Proof(
        "trum_contact_limit",
        "T_theta_E",
        "31",
        "slope of the balance solved a step's 1e-60th from full contact",
        _contact_limit,
        grid("W_c_rate W_full step", 6),
        "random rates of either sign",
    ),
    Proof(
        "trum_contact_limit",
        "T_theta_E",
        "31",
        "finite",
        _finite("T_theta_E"),
        _still("W_c_rate W_full step", W_c_rate=0),
        "a wave that neither grows nor falls",
    ),
)
