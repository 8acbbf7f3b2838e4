"""Composite section of the unrolled stator ring (eqs. 1 and 2), by integration over the height.

z runs from the tooth surface down, in eq. 2 from the neutral axis; metal fills the first h_e, piezoelectric
ceramic the next h_p.
Grooves soften the metal: only the height below the teeth carries bending stress, which scales its
second moment, and so its modulus, by (1 - h_t/h_e)^3; mass and shear area lose the grooves' volume.

This modulus is made for bending about the metal's own middle.  Eq. 1 takes it for an axial one as well, which
lifts the axis into the metal; ``layered`` has the axis of what does carry stress.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["equivalent_beam", "layered", "neutral_axis", "section"]

b_e, h_e, h_t, rho_e, E_e, G_e = sym("b_e h_e h_t rho_e E_e G_e")
n_s, b_s, l_s = sym("n_s b_s l_s")
b_p, h_p, rho_p, E_p, G_p = sym("b_p h_p rho_p E_p G_p")
D, E_eq = sym("D E_eq")
_z = sp.Symbol("z", real=True)


def equivalent_beam() -> dict[str, sp.Expr]:
    """Modulus, shear modulus and density of the solid beam that stands for the toothed one."""
    k_t, k_s = h_t / h_e, n_s * b_s / l_s
    k_d = 1 - k_t * k_s
    return {"E_eq": (1 - k_t) ** 3 * E_e, "G_eq": k_d * G_e, "rho_eq": k_d * rho_e}


@cache
def neutral_axis() -> sp.Expr:
    """D, the distance from the tooth surface to the axis of zero bending stress (eq. 1).

    Without axial force the stress E z' sums to zero over the section: integral of E b (z - D) = 0.
    """
    modulus = equivalent_beam()["E_eq"]
    force = b_e * E_eq * sp.integrate(_z - D, (_z, 0, h_e)) + b_p * E_p * sp.integrate(_z - D, (_z, h_e, h_e + h_p))
    (solution,) = sp.solve(force, D)
    return sp.factor(solution).subs(E_eq, modulus)


@cache
def layered() -> dict[str, sp.Expr]:
    """Axis D and bending stiffness EI of metal below the teeth and ceramic, each with its own modulus.

    The teeth carry no stress along the ring, so the metal's stress begins at h_t; without axial force the
    stress sums to zero over what is left, and the stiffness is its moment per curvature.
    """

    def over_the_layers(weight: sp.Expr) -> sp.Expr:
        metal = E_e * b_e * sp.integrate(weight, (_z, h_t, h_e))
        return metal + E_p * b_p * sp.integrate(weight, (_z, h_e, h_e + h_p))

    (axis,) = sp.solve(over_the_layers(_z - D), D)
    return {"D": sp.factor(axis), "EI": over_the_layers((_z - D) ** 2)}


@cache
def section() -> dict[str, sp.Expr]:
    """E, rho, I_z, G and A of the composite section about its neutral axis D (eq. 2)."""
    beam = equivalent_beam()
    A_eq, A_p = b_e * h_e, b_p * h_p
    I_e = b_e * sp.integrate(_z**2, (_z, -D, h_e - D))
    I_p = b_p * sp.integrate(_z**2, (_z, h_e - D, h_e + h_p - D))
    area, inertia = A_eq + A_p, I_e + I_p
    return {
        "E": (beam["E_eq"] * I_e + E_p * I_p) / inertia,
        "rho": (beam["rho_eq"] * A_eq + rho_p * A_p) / area,
        "I_z": inertia,
        "G": (beam["G_eq"] * A_eq + G_p * A_p) / area,
        "A": area,
        "E_eq": beam["E_eq"],
    }
