"""Hertz's line contact (eqs. 25, 26), from the half-plane under a line load.

A crest of radius R_k presses on a flat with P newton per metre of its width.  The pressure that closes the
gap is p_0 sqrt(1 - s^2) over |s| = |x|/a < 1.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

__all__ = ["C_E", "P", "curvature_diameter", "full_width", "gap_slope_integral", "rho_k"]

P, C_E, rho_k, a, p_0 = sp.symbols("P C_E rho_k a p_0", positive=True)
_angle, _s = sp.symbols("angle s", real=True)


def curvature_diameter(amplitude: sp.Expr, wavenumber: sp.Expr) -> sp.Expr:
    """Twice the radius of curvature of the crest of ``amplitude cos(wavenumber x)`` (eq. 25)."""
    x = sp.Symbol("x", real=True)
    bend = sp.diff(amplitude * sp.cos(wavenumber * x), x, 2).subs(x, 0)
    return -2 / bend


@cache
def gap_slope_integral() -> sp.Expr:
    """PV integral of sqrt(1 - s'^2)/(s - s') over |s'| < 1, which gives the surface's slope: pi s.

    With s' = sin(angle), 1 - s'^2 = (s - s')(s + s') + (1 - s^2), so the integrand is s + s' and a rest
    (1 - s^2)/(s - sin(angle)), whose principal value vanishes for |s| < 1: half of that over a full turn.

    Raises
    ------
    ArithmeticError
        If the decomposition is wrong.
    """
    sine = sp.sin(_angle)
    if sp.expand(1 - sine**2 - (_s - sine) * (_s + sine) - (1 - _s**2)) != 0:
        raise ArithmeticError("the integrand does not split as stated")
    return sp.integrate(_s + sine, (_angle, -sp.pi / 2, sp.pi / 2))


@cache
def full_width() -> sp.Expr:
    """2a = sqrt(8 P rho_k C_E / pi), both bodies as half-planes of joint compliance C_E (eq. 26).

    A pressure p makes the surfaces' slope -(2 C_E/pi) PV integral p/(x - x'); it must be -2 x/rho_k.
    """
    slope = 2 * C_E / sp.pi * p_0 * gap_slope_integral() / _s  # times x/a
    (peak,) = sp.solve(slope / a - 2 / rho_k, p_0)
    load = peak * a * sp.integrate(sp.cos(_angle) ** 2, (_angle, -sp.pi / 2, sp.pi / 2))
    (half,) = (root for root in sp.solve(load - P, a) if root.is_positive)
    return 2 * half
