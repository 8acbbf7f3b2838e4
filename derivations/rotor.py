"""From two modal displacements to the torque on the rotor (Sect. 4), in the form that a time step evaluates.

The wave at an instant is one cosine of height W_c on the unrolled stator; u = k_c (x - x_max) counts from its crest.
Its surface moves tangentially with v_x(u) = R cos(u - phi).  The friction layer presses with a density that is a
cosine plus a constant inside |u| < theta, so its cumulative share is elementary, and the net Coulomb friction follows
from the two points where the surface is as fast as the rotor.
"""

from __future__ import annotations

from functools import cache

import mpmath as mp
import sympy as sp

from derivations import bench
from derivations.contact import hertz_half_angle
from derivations.nomenclature import TINY, sym

__all__ = [
    "coefficients",
    "contact_hertz",
    "contact_winkler",
    "filling",
    "friction",
    "friction_slope",
    "friction_slopes",
    "hertz_full_height",
    "less",
    "motion_phasor",
    "nonsliding",
    "peak_pressure",
    "phasor",
    "pressed",
    "rotation",
    "stall_torque",
    "turns",
    "wave",
    "wave_in_time",
    "widening",
    "winkler_full_height",
]

omega_n, Delta_omega, xi, tau = sym("omega_n Delta_omega xi tau")
a, b, W, D, k_c, s, psi = sym("a b W D k_c s psi")
f_A_re, f_A_im, f_B_re, f_B_im = sym("f_A_re f_A_im f_B_re f_B_im")
p_re, p_im, e_re, e_im, d_re, d_im, g_A, g_B = sym("p_re p_im e_re e_im d_re d_im g_A g_B")
W_c, engagement, share, theta, phi, R_v, v = sym("W_c engagement share theta phi R_v v")
fullness, fullness_root, sin_theta, cos_phi, sin_phi = sym("fullness fullness_root sin_theta cos_phi sin_phi")
n_j, k_N, F_c, mu, r_c, T_load, b_m = sym("n_j k_N F_c mu r_c T_load b_m")
engagement_per_height, W_full, fraction = sym("engagement_per_height W_full f")


class less(sp.Function):  # type: ignore[misc]
    """1 where the first argument is less than the second, else 0."""

    @classmethod
    def eval(cls, x: sp.Expr, y: sp.Expr) -> sp.Expr | None:
        """Numbers compare at once."""
        if x.is_number and y.is_number:
            return sp.Integer(1) if x < y else sp.Integer(0)
        return None


def phasor() -> tuple[sp.Expr, sp.Expr]:
    """Z of a free motion with displacement a and velocity b: a = Re z, b = Re(lambda z).

    lambda = omega_n (-xi + i sqrt(1 - xi^2)); free motion only turns and shrinks z.
    """
    omega_d = omega_n * sp.sqrt(1 - xi**2)
    return a, -(b + xi * omega_n * a) / omega_d


def turns() -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]:
    """exp(lambda tau) of the free motion and exp(i omega_q tau) of the drive, real and imaginary parts."""
    omega_d = omega_n * sp.sqrt(1 - xi**2)
    decay, angle = sp.exp(-xi * omega_n * tau), (omega_n + Delta_omega) * tau
    return decay * sp.cos(omega_d * tau), decay * sp.sin(omega_d * tau), sp.cos(angle), sp.sin(angle)


def _flat(expr: sp.Expr) -> sp.Expr:
    """The same with exp for expm1, and angles in omega_n, Delta_omega and the root of 1 - xi^2 only."""
    root = sp.Symbol("root", positive=True)
    expr = expr.replace(sp.Function("expm1"), lambda x: sp.exp(x) - 1)
    expr = expr.subs(sp.sqrt(1 - xi**2), root).subs(xi**2, 1 - root**2)
    return expr.replace(
        lambda part: isinstance(part, sp.sin | sp.cos), lambda part: part.func(sp.expand(sp.cancel(part.args[0])))
    )


@cache
def rotation() -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]:
    """The free motion's turn, and by how much the drive's exceeds it; real and imaginary parts of both.

    The difference is taken without cancellation, from half the sum and half the difference of the two angles: after a
    start from rest it is all that there is of the wave.

    Raises
    ------
    ArithmeticError
        If these are not :func:`turns`.
    """
    omega_d, omega_q = omega_n * sp.sqrt(1 - xi**2), omega_n + Delta_omega
    mean = (omega_q + omega_d) / 2 * tau
    half = (Delta_omega + omega_n * xi**2 / (1 + sp.sqrt(1 - xi**2))) / 2 * tau
    lost = -sp.Function("expm1")(-xi * omega_n * tau)
    cosine = sp.cos(mean) * sp.cos(half) + sp.sin(mean) * sp.sin(half)
    sine = sp.sin(mean) * sp.cos(half) - sp.cos(mean) * sp.sin(half)
    found = (
        (1 - lost) * cosine,
        (1 - lost) * sine,
        lost * cosine - 2 * sp.sin(mean) * sp.sin(half),
        lost * sine + 2 * sp.cos(mean) * sp.sin(half),
    )
    e_re, e_im, d_re, d_im = turns()
    for part, plain in zip(found, (e_re, e_im, d_re - e_re, d_im - e_im), strict=True):
        if sp.simplify(sp.expand(_flat(part - plain).rewrite(sp.exp))) != 0:
            raise ArithmeticError("the turns from half angles are not those of the free motion and the drive")
    return found


def motion_phasor(phase: str, gate: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Phasor of a phase's motion at a region's start: the free motion's and the drive's (eqs. 9, 10).

    Its real part is the displacement, which stays the same where a gate switches; at rest it is zero.
    """
    z_re, z_im = phasor()
    on = _led(phase, (sp.cos(psi), sp.sin(psi)))
    return z_re + gate * W * on[0], z_im + gate * W * on[1]


def _turned(re: sp.Expr, im: sp.Expr, c_re: sp.Expr, c_im: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    return re * c_re - im * c_im, re * c_im + im * c_re


def _led(phase: str, of_A: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """A drive phasor of phase A as one of the phase: B leads by s quarter turns."""
    return of_A if phase == "A" else (-s * of_A[1], s * of_A[0])


@cache
def wave() -> dict[str, sp.Expr]:
    """Wave height, surface speed amplitude and phase, a time after the motion had the phasor f (eqs. 11, 20).

    The motion's phasor has become z = f e + g W p d, with e the free motion's turn, d what the drive's exceeds it by
    and p the drive's phasor; w = Re z and w' = Re(lambda z) + g W Re((i omega_q - lambda) p (e + d)).
    W_c = sqrt(w_A^2 + w_B^2); with q = w_A' w_B - w_B' w_A the surface speed is
    D k_c (q cos u - W_c W_c' sin u) / W_c = R_v cos(u - phi).
    """
    omega_d, omega_q = omega_n * sp.sqrt(1 - xi**2), omega_n + Delta_omega
    excess, drive = _turned(p_re, p_im, d_re, d_im), _turned(p_re, p_im, e_re + d_re, e_im + d_im)
    w, velocity = {}, {}
    for phase, re, im, gate in (("A", f_A_re, f_A_im, g_A), ("B", f_B_re, f_B_im, g_B)):
        free_re, free_im = _turned(re, im, e_re, e_im)
        more_re, more_im = _led(phase, excess)
        on_re, on_im = _led(phase, drive)
        z_re, z_im = free_re + gate * W * more_re, free_im + gate * W * more_im
        w[phase] = z_re
        velocity[phase] = (
            -xi * omega_n * z_re - omega_d * z_im + gate * W * (xi * omega_n * on_re + (omega_d - omega_q) * on_im)
        )
    q = velocity["A"] * w["B"] - velocity["B"] * w["A"]
    growth = w["A"] * velocity["A"] + w["B"] * velocity["B"]
    length = sp.sqrt(q**2 + growth**2) + TINY
    return {
        "W_c": sp.sqrt(w["A"] ** 2 + w["B"] ** 2),
        "R_v": D * k_c * sp.sqrt(velocity["A"] ** 2 + velocity["B"] ** 2),
        "phi": sp.atan2(-growth, q),
        "cos_phi": q / length,
        "sin_phi": -growth / length,
    }


def coefficients() -> dict[str, sp.Expr]:
    """What a point's steps share: engagement per wave height, and the accelerations of the rotor's rim (eq. 38).

    engagement = 2 n_j k_N W_c / (k_c F_c) compares the layer's force at full wave with the prepressure; the rim's
    speed v = omega r_c obeys v' = push f - drag.  The moment of inertia is the
    rotor's with the load's.
    """
    inertia = bench.inertia()
    return {
        "engagement_per_height": 2 * n_j * k_N / (k_c * F_c),
        "push": r_c**2 * mu * F_c / inertia,
        "drag": r_c * T_load / inertia,
    }


def stall_torque() -> sp.Expr:
    """Torque on a rotor held still, from the cycle's mean net friction fraction f (eqs. 36, 38)."""
    return r_c * mu * F_c * fraction


def hertz_full_height() -> sp.Expr:
    """Wave height at which the Hertz half-angle, which falls as 1/sqrt(W), is pi (eqs. 25, 26)."""
    return hertz_half_angle() ** 2 * W / sp.pi**2


def winkler_full_height() -> sp.Expr:
    """Wave height below which the whole wave touches the Winkler layer: fullness 1 (eq. 31)."""
    return 1 / (sp.pi * coefficients()["engagement_per_height"])


def filling() -> dict[str, sp.Expr]:
    """Engagement of the layer, and how full the contact is: 1 when the whole wave touches, W_c small (eq. 31)."""
    engaged = engagement_per_height * W_c
    return {"engagement": engaged, "fullness": sp.Min(1, 1 / (sp.pi * engaged + TINY))}


@cache
def _guess() -> sp.Expr:
    """Theta from its fullness t to 2e-4: pi - sqrt(1 - t) times a polynomial in the cube root of t and sqrt(1 - t).

    sin theta - theta cos theta = pi t has a cube root at t = 0 and a square root at t = 1; the fit takes both out.
    Least squares on a fixed grid of theta in multiprecision, so the coefficients are reproducible.
    """
    with mp.workdps(40):
        rows, right = [], []
        count = 160
        for i in range(1, count):
            angle = mp.pi * (1 - mp.cos(mp.pi * i / count)) / 2
            t = (mp.sin(angle) - angle * mp.cos(angle)) / mp.pi
            root, rest = mp.cbrt(t), mp.sqrt(1 - t)
            weight = rest / min(angle, mp.pi - angle)
            basis = [root**k for k in range(5)] + [rest * root**k for k in range(3)]
            rows.append([weight * value for value in basis])
            right.append(weight * (mp.pi - angle) / rest)
        solution = mp.lu_solve(mp.matrix(rows), mp.matrix(right))
        fitted = [sp.Float(mp.nstr(value, 17), 17) for value in solution]
    rest_ = sp.sqrt(1 - fullness)
    polynomial = sum(c * fullness_root**k for k, c in enumerate(fitted[:5]))
    polynomial += rest_ * sum(c * fullness_root**k for k, c in enumerate(fitted[5:]))
    return sp.pi - rest_ * polynomial


@cache
def contact_winkler() -> dict[str, sp.Expr]:
    """Half-angle, its sine, and the constant part of the pressure's share, from fullness t and its cube root (eq. 31).

    One Halley step on sin theta - theta cos theta = pi t from the guess.  The share of pressure between -u and u is
    engagement sin u + share u; a whole wave in contact (t = 1) has theta = pi and share = 1/pi.
    """
    guess = _guess()
    sine, cosine = sp.sin(guess), sp.cos(guess)
    residual = sine - guess * cosine - sp.pi * fullness
    slope, bend = guess * sine, sine + guess * cosine
    angle = sp.Min(guess - 2 * residual * slope / (2 * slope**2 - residual * bend + TINY), sp.pi)
    step = angle - guess
    sin_angle = sine + step * (cosine - step * sine / 2)
    cos_angle = cosine - step * (sine + step * cosine / 2)
    return {"theta": angle, "sin_theta": sin_angle, "share": -cos_angle / (sp.pi * fullness)}


@cache
def contact_hertz() -> dict[str, sp.Expr]:
    """The same for the paper's Hertz width at wave height W_c (eqs. 25, 26), theta limited to pi.

    The pressure keeps the cosine shape over that width (eq. 30), scaled to carry the prepressure.
    """
    angle = sp.pi * sp.sqrt(sp.Min(1, W_full / (W_c + TINY)))
    scale = 1 / (sp.sin(angle) - angle * sp.cos(angle))
    return {"theta": angle, "sin_theta": sp.sin(angle), "share": -scale * sp.cos(angle), "engagement": scale}


def peak_pressure() -> sp.Expr:
    """Pressure under a crest, where it is highest (eqs. 28, 30, 31): the wear's proxy.

    The share of the load between -u and u is engagement sin u + share u, and one crest of n_j carries F_c / n_j on a
    strip of width b_m: what it has at u = 0 per length u / k_c.  For the layer that is k_N W_c (1 - cos theta) / b_m.
    """
    share_per_angle = sp.diff(engagement * sp.sin(phi) + share * phi, phi).subs(phi, 0) / 2
    return F_c / n_j * k_c * share_per_angle / b_m


def pressed(p_1: sp.Expr, p_2: sp.Expr) -> sp.Expr:
    """Mean of the pressures at the two points as fast as the rotor, over the contact's; there is no pull."""
    return sp.Max(0, p_1) / 2 + sp.Max(0, p_2) / 2


def friction_slope(pressure: sp.Expr, lead: sp.Expr) -> sp.Expr:
    """df/dv from that mean pressure, and the root of R_v^2 - v^2 (eqs. 33 to 37)."""
    return -2 * pressure / (lead + TINY)


def widening(engaged: sp.Expr, angle: sp.Expr, sine: sp.Expr) -> sp.Expr:
    """Derivative of theta by ln E of a layer that carries its load, E (sin theta - theta cos theta) = 1 (eq. 31)."""
    return -1 / (engaged * angle * sine + TINY)


def nonsliding() -> list[tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr, sp.Expr]]:
    """The two points where the surface is as fast as the rotor, phi + alpha and phi - alpha.

    For each: turns of the circle; u and sin u, both held at the contact's edge outside it; whether it is inside; cos u,
    not held.
    """
    ratio, sine = _speeds()
    alpha = sp.atan2(sine, ratio)
    found = []
    for sign in (1, -1):
        u = phi + sign * alpha
        turns = less(sp.pi, u) - less(u, -sp.pi)
        wrapped = u - 2 * sp.pi * turns
        sin_u = sin_phi * ratio + sign * cos_phi * sine
        cos_u = cos_phi * ratio - sign * sin_phi * sine
        inside = less(sp.Abs(wrapped), theta)
        side = 2 * less(0, wrapped) - 1
        clipped = inside * wrapped + (1 - inside) * side * theta
        sin_clipped = inside * sin_u + (1 - inside) * side * sin_theta
        found.append((turns, clipped, sin_clipped, inside, cos_u))
    return found


def _speeds() -> tuple[sp.Expr, sp.Expr]:
    """Cosine and sine of alpha: the rotor's speed over the surface's greatest, held at 1."""
    ratio = sp.Max(-1, sp.Min(1, v / (R_v + TINY)))
    return ratio, sp.sqrt(1 - ratio**2)


@cache
def friction() -> dict[str, sp.Expr]:
    """Net friction fraction f of mu F_c at rim speed v, and df/dv (eqs. 33 to 37 in one form).

    The surface is faster than the rotor between phi - alpha and phi + alpha, cos alpha = v / R_v.  With C(u) the
    pressure's cumulative share, continued over the crests, f = 2 (C(phi + alpha) - C(phi - alpha)) - 1: f = -1 for a
    rotor faster than all of the surface, +1 for one slower.  p_1 and p_2 are the pressure at the two points over its
    mean (0 and below: not in contact), whose changes of sign are kinks of f.
    """
    points = nonsliding()
    shares = [turns + (engagement * sin_u + share * u) / 2 for turns, u, sin_u, _, _ in points]
    pressures = [engagement * cos_u + share for *_, cos_u in points]
    net = 2 * (shares[0] - shares[1]) - 1
    moving = less(sp.Abs(v), R_v)
    slope = moving * friction_slope(pressed(*pressures), R_v * _speeds()[1])
    return {"f": net, "f_v": slope, "p_1": pressures[0], "p_2": pressures[1]}


@cache
def friction_slopes() -> dict[str, sp.Expr]:
    """How f changes with the angle phi, and with the logarithm of the engagement E.

    The pressure is E cos u + share inside theta, with the load balance E (sin theta - theta cos theta) = 1 and zero
    pressure at the edges, so moving those adds nothing: d share / d ln E = share - 1/theta, and d theta / d ln E =
    -1 / (E theta sin theta).  A whole wave in contact keeps theta = pi and share = 1/pi, and the same form holds.
    E_height is d ln E / d ln W_c for the paper's Hertz width, where theta falls as the root of W_c; the layer's is 1.
    """
    points = nonsliding()
    shares = [inside * (engagement * sin_u + (share - 1 / theta) * u) / 2 for _, u, sin_u, inside, _ in points]
    pressures = [sp.Max(0, engagement * cos_u + share) for *_, cos_u in points]
    partly = less(theta, sp.pi)
    return {
        "f_phi": pressures[0] - pressures[1],
        "f_E": 2 * (shares[0] - shares[1]),
        "theta_E": partly * widening(engagement, theta, sin_theta),
        "E_height": engagement * theta**2 * sin_theta / 2,
    }


def wave_in_time() -> dict[str, sp.Expr]:
    """The wave a time tau after phasors f and p, all of it as a function of the frequencies and of tau."""
    turned = dict(zip((e_re, e_im, d_re, d_im), rotation(), strict=True))
    return {name: expr.subs(turned) for name, expr in wave().items() if name in ("W_c", "R_v", "phi")}
