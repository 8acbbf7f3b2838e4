"""The conic that a surface point follows (Sect. 3.5, Appendix B).

With c = cos(k_c x), s = sin(k_c x) the displacements are the modal responses turned by k_c x:
zeta_z = P_A s + P_B c, zeta_x/(D k_c) = P_A c - P_B s.  Two phases of amplitudes W_a, W_b that differ by an
angle delta run on an ellipse; it holds at every instant for the delta of that instant, so while delta
drifts slowly the point follows it.
"""

from __future__ import annotations

import sympy as sp

__all__ = ["P_A", "P_B", "W_a", "W_b", "delta", "discriminant", "invariant", "turned_back"]

P_A, P_B, delta = sp.symbols("P_A P_B delta", real=True)
W_a, W_b = sp.symbols("W_a W_b", positive=True)


def invariant() -> sp.Expr:
    """(P_A/W_a)^2 + (P_B/W_b)^2 - 2 P_A P_B cos(delta)/(W_a W_b) - sin(delta)^2: 0 on the motion.

    Raises
    ------
    ArithmeticError
        If P_A = W_a cos(angle), P_B = W_b cos(angle + delta) does not satisfy it at every angle.
    """
    conic = (P_A / W_a) ** 2 + (P_B / W_b) ** 2 - 2 * P_A * P_B * sp.cos(delta) / (W_a * W_b) - sp.sin(delta) ** 2
    angle = sp.Symbol("angle", real=True)
    motion = sp.expand(sp.expand_trig(conic.subs({P_A: W_a * sp.cos(angle), P_B: W_b * sp.cos(angle + delta)})))
    for turn in (angle, delta):
        motion = sp.expand(motion.subs(sp.sin(turn) ** 2, 1 - sp.cos(turn) ** 2))
    if motion != 0:
        raise ArithmeticError("the motion is not on the conic")
    return conic


def turned_back(zeta_x: sp.Expr, zeta_z: sp.Expr, angle: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """P_A and P_B from zeta_x/(D k_c) and zeta_z at angle k_c x: the rotation the other way."""
    return {
        P_A: zeta_x * sp.cos(angle) + zeta_z * sp.sin(angle),
        P_B: zeta_z * sp.cos(angle) - zeta_x * sp.sin(angle),
    }


def discriminant(conic: sp.Expr, first: sp.Symbol, second: sp.Symbol) -> sp.Expr:
    """B^2 - 4 A C of the quadratic form in two coordinates: negative for an ellipse, 0 for parallel lines."""
    polynomial = sp.Poly(sp.expand(conic), first, second)
    squares = [polynomial.coeff_monomial(power) for power in (first**2, first * second, second**2)]
    return sp.expand(squares[1] ** 2 - 4 * squares[0] * squares[2])
