"""What gives in the contact beside the friction layer: the stator's teeth, and the rotor's flange, which carries it.

The flange is a thin elastic plate (Kirchhoff), clamped to the rotor's body along one edge and loaded by the layer along
the other, l_f away; like the stator it is unrolled, so its circumference is straight.  Under the wave's line load
p cos(k_c x) it bends to Y(y) cos(k_c x), statically: its inertia is left out.  A tooth is a column as wide as the beam,
pressed over its height; what the grooves take is spread over the circumference.  Layer, tooth and flange carry the same
force one behind the other.

Along the circumference the layer gives way too, by shear: the tangential stiffness.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.contact import layer_stiffness
from derivations.nomenclature import sym

__all__ = ["contact_stiffness", "flange_stiffness", "plate", "tangential_stiffness", "tooth_stiffness"]

k_N, k_c, E_e, b_e, h_t, n_s, b_s, l_s = sym("k_N k_c E_e b_e h_t n_s b_s l_s")
E_f, mu_f, h_f, l_f = sym("E_f mu_f h_f l_f")
E_m, mu_m = sym("E_m mu_m")
_y = sp.Symbol("y", positive=True)


@cache
def plate() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Deflection Y(y) under a unit load at the edge y = l_f, and the plate's moment and edge force along y.

    The strain energy of w = Y(y) cos(k_c x), averaged over a wavelength, is (B/4) times the integral of
    (Y'' - k_c^2 Y)^2 + 2 (1 - mu_f) k_c^2 (Y Y'' + Y'^2); Y makes it stationary.  Its variation has the equation of the
    plate inside, and at an edge the moment and the force (the shear and the change of the twist along the edge).

    Raises
    ------
    ArithmeticError
        If Y is not the plate's, at one of both edges or between them.
    """
    B, k, nu = _bending(), k_c, mu_f
    Y = sp.Function("Y")(_y)
    energy = B / 4 * ((Y.diff(_y, 2) - k**2 * Y) ** 2 + 2 * (1 - nu) * k**2 * (Y * Y.diff(_y, 2) + Y.diff(_y) ** 2))
    # 2 x: the load's work averages over the wavelength to half of its greatest
    moment = 2 * energy.diff(Y.diff(_y, 2))
    force = 2 * energy.diff(Y.diff(_y)) - moment.diff(_y)
    equation = 2 * energy.diff(Y) - force.diff(_y)
    # clamped at y = 0; both solve the equation
    a, b = sp.symbols("a b")
    clamped = a * (k * _y * sp.cosh(k * _y) - sp.sinh(k * _y)) + b * k * _y * sp.sinh(k * _y)
    inside, bent, pushed = (sp.expand(expression.subs(Y, clamped).doit()) for expression in (equation, moment, force))
    at = {_y: l_f}
    found = sp.solve([bent.subs(at), pushed.subs(at) - 1], [a, b], dict=True)[0]
    residuals = (inside, clamped.subs(_y, 0), clamped.diff(_y).subs(_y, 0), bent.subs({**found, **at}))
    if not all(_vanishes(residual) for residual in residuals):
        raise ArithmeticError("the deflection is not that of the clamped plate")
    return clamped.subs(found), bent.subs(found), pushed.subs(found)


def _vanishes(expression: sp.Expr) -> bool:
    """Whether an expression that is rational in exponentials is 0: over one denominator, its numerator is."""
    numerator, _ = sp.fraction(sp.together(expression.rewrite(sp.exp)))
    return bool(sp.expand(numerator) == 0)


def _bending() -> sp.Expr:
    return E_f * h_f**3 / (12 * (1 - mu_f**2))


@cache
def flange_stiffness() -> sp.Expr:
    """Line load over the deflection at the loaded edge, both of the wave's shape (our own; no equation of the paper).

    For a wave much longer than the flange it is a cantilever's 3 B / l_f^3, B the plate's bending stiffness.

    Raises
    ------
    ArithmeticError
        If this closed form is not the plate's.
    """
    alpha = k_c * l_f
    stiffness = (
        _bending()
        * k_c**3
        * ((3 + mu_f) * (1 - mu_f) * sp.cosh(alpha) ** 2 + (1 - mu_f) ** 2 * alpha**2 + (1 + mu_f) ** 2)
        / (2 * (sp.sinh(alpha) * sp.cosh(alpha) - alpha))
    )
    deflection = plate()[0].subs(_y, l_f)
    if not _vanishes(deflection * stiffness - 1):
        raise ArithmeticError("the flange's stiffness is not load over deflection")
    return stiffness


def tooth_stiffness() -> sp.Expr:
    """Of the teeth as columns, per length of the circumference."""
    return E_e * b_e * (1 - n_s * b_s / l_s) / h_t


def contact_stiffness() -> dict[str, sp.Expr]:
    """Layer, tooth and flange in series, per length of the circumference and per length of approach."""
    tooth, flange = tooth_stiffness(), flange_stiffness()
    return {"k_tooth": tooth, "k_flange": flange, "k_con": 1 / (1 / k_N + 1 / tooth + 1 / flange)}


def tangential_stiffness() -> sp.Expr:
    """k_T of the layer in shear, whose modulus is E_m / (2 (1 + mu_m)): of the normal stiffness, that over E_m."""
    return layer_stiffness() / (2 * (1 + mu_m))
