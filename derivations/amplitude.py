"""Amplitude of one phase's standing wave: forced by the ceramic (eq. 7) and under prepressure (eq. 8).

Eq. 7 as printed divides by the ceramic's mass alone and takes D/2 for the lever arm.  Here the modal
mass is the whole section's, with its rotary inertia, and the arm reaches from the neutral axis to the
middle of the ceramic.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["forced", "measured", "piezo_moment", "under_prepressure"]

k_c, beta, omega_n, omega_q, xi = sym("k_c beta omega_n omega_q xi")
rho, A, I_z, D = sym("rho A I_z D")
b_p, h_e, h_p, d_31, s_11E, U_s = sym("b_p h_e h_p d_31 s_11E U_s")
W_max, C_f, varsigma, F_c, N_1 = sym("W_max C_f varsigma F_c N_1")
x = sym("x")[0]
_z = sp.Symbol("z", real=True)


def piezo_moment() -> sp.Expr:
    """Amplitude of the bending moment of one fully poled segment, N m.

    Blocked stress d31/s11E U/h_p over the ceramic's section, times its distance from the neutral axis;
    the sign of d31 only shifts the drive's phase by pi, an amplitude does not see it.
    """
    stress = sp.Abs(d_31) / s_11E * U_s / h_p
    return stress * b_p * sp.factor(sp.integrate(_z, (_z, h_e - D, h_e + h_p - D)))


@cache
def forced() -> sp.Expr:
    """W_max at omega_q without prepressure, from the modal balance (eq. 7 put right).

    Over one wavelength, mode w = W cos(k_c x), theta = -beta W sin(k_c x): segments half a wavelength
    long are poled in turn, and their moment does work on the mode's curvature, wherever the electrode
    runs (eq. 7 takes the whole ring, and so does this).
    """
    wavelength = 2 * sp.pi / k_c
    bending = beta * k_c * sp.cos(k_c * x)
    crest, trough = (x, -wavelength / 4, wavelength / 4), (x, wavelength / 4, 3 * wavelength / 4)
    force = piezo_moment() * (sp.integrate(bending, crest) - sp.integrate(bending, trough))
    mass = sp.integrate(rho * A * sp.cos(k_c * x) ** 2 + rho * I_z * (beta * sp.sin(k_c * x)) ** 2, (x, 0, wavelength))
    ratio = omega_q / omega_n
    resonator = sp.sqrt((1 - ratio**2) ** 2 + (2 * xi * ratio) ** 2)
    return sp.factor(sp.simplify(force / mass)) / omega_n**2 / resonator


def under_prepressure(amplitude: sp.Expr) -> sp.Expr:
    """W_maxf for the amplitude without prepressure, F_c in newton (eq. 8)."""
    return C_f * (F_c / N_1) ** (-varsigma) * amplitude


def measured() -> sp.Expr:
    """W_maxf from the measured W_max, which the paper takes as independent of the drive frequency (eq. 8)."""
    return under_prepressure(W_max)
