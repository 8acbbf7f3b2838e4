"""The direction determinant Q of the ellipse (eqs. 11, 24, A5, 42) and its cycle measures (eqs. 43, 44)."""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["determinant", "measures", "phase_determinant", "ratios"]

x, t, k_c, D = sym("x t k_c D")
q_plus, q_minus, p_plus, p_minus, T = sym("q_plus q_minus p_plus p_minus T")
_w_A = sp.Function("w_A")(t)
_w_B = sp.Function("w_B")(t)


@cache
def determinant() -> sp.Expr:
    """Q = D k_c (w_A' w_B - w_B' w_A), from eq. A5 with the displacements of eq. 11.

    Proved here for any w_A(t), w_B(t): the expression does not depend on x, and it equals the product of
    the crest's displacement and tangential velocity (eq. 42).

    Raises
    ------
    ArithmeticError
        If either proof fails.
    """
    zeta_z = _w_A * sp.sin(k_c * x) + _w_B * sp.cos(k_c * x)
    zeta_x = D * zeta_z.diff(x)
    general = zeta_x.diff(t) * zeta_z - zeta_z.diff(t) * zeta_x
    if sp.simplify(general.diff(x)) != 0:
        raise ArithmeticError("the determinant depends on x")
    value = sp.factor(sp.simplify(general.subs(x, 0)))
    if sp.simplify(general - value) != 0:
        raise ArithmeticError("the determinant at x = 0 is not the determinant")
    # At the crest k_c x_max = atan2(w_A, w_B): sin = w_A / W_c and cos = w_B / W_c.
    W_c = sp.sqrt(_w_A**2 + _w_B**2)
    crest = {sp.sin(k_c * x): _w_A / W_c, sp.cos(k_c * x): _w_B / W_c}
    product = (zeta_z * zeta_x.diff(t)).subs(crest)
    if sp.simplify(product - value) != 0:
        raise ArithmeticError("the determinant is not the crest's displacement times its tangential velocity")
    return value


def phase_determinant(w_A: sp.Expr, v_A: sp.Expr, w_B: sp.Expr, v_B: sp.Expr) -> sp.Expr:
    """Q for given displacements and velocities of the phases."""
    velocities = {_w_A.diff(t): v_A, _w_B.diff(t): v_B}
    return determinant().subs(velocities).subs({_w_A: w_A, _w_B: w_B})


def determinant_rate(w_A: sp.Expr, a_A: sp.Expr, w_B: sp.Expr, a_B: sp.Expr) -> sp.Expr:
    """dQ/dt for given displacements and accelerations of the phases."""
    rate = determinant().diff(t).doit()
    accelerations = {_w_A.diff(t, 2): a_A, _w_B.diff(t, 2): a_B}
    free_of_velocity = sp.expand(rate.subs(accelerations))
    return sp.factor(free_of_velocity).subs({_w_A: w_A, _w_B: w_B})


def ratios() -> tuple[sp.Expr, sp.Expr]:
    """X and Y: what turns forward over what turns backward, of Q and of its square."""
    return q_plus / q_minus, p_plus / p_minus


def measures() -> tuple[sp.Expr, sp.Expr]:
    """Q_aver and Q_vib (eqs. 43, 44), with |Y - 1| since eq. 44 turns complex for Y < 1.

    In X and Y: Q_aver = (X - 1)/((X + 1) T), Q_vib = sqrt((Y + 1)/|Y - 1|)/(T^2 Q_aver).
    """
    average = (q_plus - q_minus) / ((q_plus + q_minus) * T)
    return average, sp.sqrt((p_plus + p_minus) / sp.Abs(p_plus - p_minus)) / (T**2 * average)
