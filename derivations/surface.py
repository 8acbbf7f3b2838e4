"""What a point of the stator's surface does (eqs. 11, 12, 16, 20), and what passes between it and the rotor (Sect. 4).

The figures' own kernels; cycle and orbit need neither.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations import transfer
from derivations.nomenclature import sym
from derivations.phases import PHASES, response
from derivations.rotor import less, phasor, turns

__all__ = ["displacements", "interface", "point", "vector"]

a, b, W, psi, s, D, k_c, x, x_max = sym("a b W psi s D k_c x x_max")
R_v, cos_phi, sin_phi, v = sym("R_v cos_phi sin_phi v")
engagement, share, theta, F_c, n_j, mu = sym("engagement share theta F_c n_j mu")


def vector(phase: str) -> tuple[sp.Expr, sp.Expr]:
    """The rotating vector whose real part is the modal displacement, tau after the start of a region (eq. 12).

    The free motion's phasor turns with lambda, the steady response with the drive; B leads by s quarter turns.

    Raises
    ------
    ArithmeticError
        If the real part is not the phase's response.
    """
    a_p, b_p, gate = sym(f"a_{phase} b_{phase} g_{phase}")
    z_re, z_im = (part.subs({a: a_p, b: b_p}) for part in phasor())
    e_re, e_im, d_re, d_im = turns()
    on_re = W * (d_re * sp.cos(psi) - d_im * sp.sin(psi))
    on_im = W * (d_re * sp.sin(psi) + d_im * sp.cos(psi))
    if phase == "B":
        on_re, on_im = -s * on_im, s * on_re
    real = z_re * e_re - z_im * e_im + gate * on_re
    if sp.simplify(sp.expand_trig(real - response(phase)[0])) != 0:
        raise ArithmeticError("the vector's real part is not the phase's displacement")
    return real, z_re * e_im + z_im * e_re + gate * on_im


def displacements(w_A: sp.Expr, w_B: sp.Expr) -> dict[str, sp.Expr]:
    """The point at x, of both phases' displacements; along the circumference by the section's turning (eq. 11)."""
    zeta_z = w_A * sp.sin(k_c * x) + w_B * sp.cos(k_c * x)
    return {"zeta_z": zeta_z, "zeta_x": D * zeta_z.diff(x)}


@cache
def point() -> dict[str, sp.Expr]:
    """Displacements and velocity of the point at x, its vertical envelope, the crest (eqs. 11, 12, 16, 20)."""
    t = sp.Symbol("t", real=True)
    moving = {phase: sp.Function(f"w_{phase}")(t) for phase in PHASES}
    zeta_z, zeta_x = displacements(*moving.values()).values()
    found = {phase: response(phase) for phase in PHASES}
    at = [(w.diff(t), found[phase][1]) for phase, w in moving.items()]
    at += [(w, found[phase][0]) for phase, w in moving.items()]
    parts = [vector(phase) for phase in PHASES]
    along = (sp.sin(k_c * x), sp.cos(k_c * x))
    real, imaginary = (sum(c * part[i] for c, part in zip(along, parts, strict=True)) for i in (0, 1))
    return {
        "zeta_z": zeta_z.subs(at),
        "zeta_x": zeta_x.subs(at),
        "v_x": zeta_x.diff(t).subs(at),
        "A_Q": sp.sqrt(real**2 + imaginary**2),
        "x_max": sp.atan2(found["A"][0], found["B"][0]) / k_c,
    }


@cache
def interface() -> dict[str, sp.Expr]:
    """Surface speed at x and its slope, line pressure and Coulomb's traction on the rotor there (eqs. 16, 32, 36).

    Raises
    ------
    ArithmeticError
        If the pressure of a partial contact is not eq. 32's.
    """
    u = k_c * (x - x_max)
    speed = R_v * (sp.cos(u) * cos_phi + sp.sin(u) * sin_phi)
    shape = engagement * sp.cos(u) + share
    scale = 1 / (sp.sin(theta) - theta * sp.cos(theta))
    printed = transfer.pressure_distribution().args
    partial = shape.subs({engagement: scale, share: -scale * sp.cos(theta)})
    inside = {sp.Max(0, sp.cos(transfer.u) - sp.cos(theta)): sp.cos(transfer.u) - sp.cos(theta)}
    expected = sp.Mul(*printed).subs(inside).subs(transfer.u, u)
    if sp.simplify(F_c * k_c / (2 * n_j) * partial - expected) != 0:
        raise ArithmeticError("the pressure is not that of eq. 32")
    pressure = F_c * k_c / (2 * n_j) * sp.Max(0, shape)
    return {
        "v_x": speed,
        "v_x_slope": speed.diff(x),
        "p": pressure,
        "traction": mu * pressure * (less(v, speed) - less(speed, v)),
    }
