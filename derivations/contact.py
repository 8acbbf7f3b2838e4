"""Contact of the wave's crests with the rotor's friction layer, as far as the resonance needs it.

The layer is a Winkler foundation that only presses: p(u) = k_N W (cos u - cos theta) on |u| < theta,
u = k_c (x - x_max).  Its balance with the prepressure gives the half-angle theta, and theta the
stiffness that the beam feels.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["foundation", "hertz_half_angle", "layer_stiffness", "pressure", "wavenumber", "winkler_balance"]

k_N, W, k_c, theta, F_c, n_j, R = sym("k_N W k_c theta F_c n_j R")
E_m, b_m, h_m, E_eq, mu_e, mu_m, r_t = sym("E_m b_m h_m E_eq mu_e mu_m r_t")
_u = sp.Symbol("u", real=True)


def wavenumber() -> sp.Expr:
    """k_c: n_j waves on the circumference 2 pi R (below eq. 4)."""
    return n_j / R


def layer_stiffness() -> sp.Expr:
    """k_N, force per length and length of indentation (eq. 30 made dimensionally whole)."""
    return E_m * b_m / h_m


def pressure() -> sp.Expr:
    """Line pressure of the layer at u, inside the contact (eqs. 28, 30)."""
    return k_N * W * (sp.cos(_u) - sp.cos(theta))


@cache
def winkler_balance() -> tuple[sp.Expr, sp.Expr]:
    """Residual of the load balance over all crests and its slope in theta (eq. 31).

    The residual is F_c less the layer's force, over that of a fully engaged wave's scale
    2 n_j k_N W / k_c; it falls from positive to negative as theta grows.
    """
    force = n_j * sp.integrate(pressure(), (_u, -theta, theta)) / k_c
    residual = sp.expand(sp.simplify((F_c - force) / (2 * n_j * k_N * W / k_c)))
    return residual, sp.simplify(residual.diff(theta))


@cache
def hertz_half_angle() -> sp.Expr:
    """Theta = k_c x_m of the paper's Hertz contact (eqs. 25, 26), not yet limited to pi."""
    curvature = 2 * r_t**2 / (n_j**2 * W)
    compliance = (1 - mu_e**2) / E_eq + (1 - mu_m**2) / E_m
    width = sp.Rational(8, 5) * sp.sqrt(F_c * curvature * compliance / (n_j * b_m))
    return k_c * width / 2


@cache
def foundation() -> dict[str, sp.Expr]:
    """k_f that the layer adds under the beam, by level.

    ``harmonic`` is the fundamental harmonic of the layer's reaction to W cos u; ``smeared`` spreads k_N
    over the circumference by the contact's share; ``printed`` is k_dx below eq. 5, in N/m.
    """
    fundamental = sp.integrate(sp.expand(pressure() * sp.cos(_u)), (_u, -theta, theta)) / sp.pi
    x_m = theta / k_c
    share = n_j * 2 * x_m / (2 * sp.pi * R)
    return {
        "harmonic": sp.expand(sp.simplify(fundamental / W)),
        "smeared": k_N * share.subs(R, n_j / k_c),
        "printed": 2 * n_j * x_m * k_N,
    }
