"""What turns with the rotor on a test bench: a plate, and a weight on a string that runs over it (Sect. 8.1).

Eq. 38 has the rotor's moment of inertia alone.  A plate adds its own.  A weight of mass m on a string at the radius r_s
pulls with m g r_s where nothing accelerates; with the string taut it moves as the string does, so that it adds
m r_s^2.  A string only pulls: the tension that the taut motion needs says whether the motion is possible.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["DynamicsError", "inertia", "mass", "stretched", "tension"]

J, J_load, T_load, r_s, r_c, mu, F_c, f, g = sym("J J_load T_load r_s r_c mu F_c f g")
stiffness, Omega = sp.symbols("k_string Omega", positive=True)


class DynamicsError(ArithmeticError):
    """A result does not solve the equations of motion that it was derived from."""


def _zero(expression: sp.Expr, what: str) -> None:
    if sp.simplify(expression) != 0:
        raise DynamicsError(f"{what}: {sp.simplify(expression)} is not 0")


def mass() -> sp.Expr:
    """Of the weight whose pull is the load's torque where nothing accelerates: m g r_s = |T_load|."""
    return sp.Abs(T_load) / (g * r_s)


@cache
def _taut() -> tuple[sp.Expr, sp.Expr]:
    """Angular acceleration and tension of two bodies and a constraint, by Lagrange's equations with a multiplier.

    theta is the angle that lifts the weight, z the weight's height, z = r_s theta while the string is taut; q is the
    torque of friction in that sense.  Returned as functions of q and m.

    Raises
    ------
    DynamicsError
        If Newton's equations of both bodies and the balance of energy do not hold for the result.
    """
    t, m, q, S = sp.symbols("t m q S", real=True)
    theta, z = sp.Function("theta")(t), sp.Function("z")(t)
    kinetic = (J + J_load) * theta.diff(t) ** 2 / 2 + m * z.diff(t) ** 2 / 2
    lagrangian = kinetic - m * g * z
    turn, lift = sp.symbols("turn lift", real=True)

    def equation(of: sp.Expr, force: sp.Expr) -> sp.Expr:
        left = lagrangian.diff(of.diff(t)).diff(t) - lagrangian.diff(of)
        return left.subs({theta.diff(t, 2): turn, z.diff(t, 2): lift}) - force

    constraint = sp.Eq(lift, r_s * turn)
    found = sp.solve([equation(theta, q - S * r_s), equation(z, S), constraint], [turn, lift, S], dict=True)[0]
    _zero((J + J_load) * found[turn] - (q - found[S] * r_s), "the rotor under friction and string")
    _zero(m * r_s * found[turn] - (found[S] - m * g), "the weight under string and gravity")
    speed = sp.Symbol("omega", real=True)
    power = (J + J_load) * speed * found[turn] + m * (r_s * speed) * (r_s * found[turn])
    _zero(power - (q * speed - m * g * r_s * speed), "energy")
    return found[turn].subs({q: _q, m: _m}), found[S].subs({q: _q, m: _m})


_q, _m = sp.symbols("q_f m_w", real=True)


@cache
def inertia() -> sp.Expr:
    """What friction and load together accelerate: of rotor, plate and the weight on its taut string.

    Raises
    ------
    DynamicsError
        If the acceleration of the two bodies is not that of one of this moment of inertia.
    """
    turn, _ = _taut()
    moved = J + J_load + sp.Abs(T_load) * r_s / g  # m r_s^2
    _zero(turn.subs(_m, mass()) - (_q - sp.Abs(T_load)) / moved, "one body of that inertia")
    return moved


@cache
def tension() -> sp.Expr:
    """The string's tension over the weight m g, where friction is the fraction f in the sense that lifts the weight.

    The string is slack where this would be negative: the rotor goes down faster than the weight can fall.  It is
    taut whatever friction does if r_s r_c mu F_c <= g (J + J_load), the least being that at f = -1.

    Raises
    ------
    DynamicsError
        If it is not the tension of the two bodies.
    """
    _, pull = _taut()
    share = (g * (J + J_load) + r_s * r_c * mu * F_c * f) / (g * inertia())
    _zero(pull.subs({_q: r_c * mu * F_c * f, _m: mass()}) / (mass() * g) - share, "tension over weight")
    return share


@cache
def stretched() -> sp.Expr:
    """Moment of inertia that a torque of the angular frequency Omega meets where the string gives, of stiffness k.

    Rotor and weight are two bodies with a spring r_s theta - z between them.  A stiff string (k large) gives
    :func:`inertia`; below k = m Omega^2 the weight moves against the rotor, and from a soft string the rotor feels the
    weight's pull and not its mass.

    Raises
    ------
    DynamicsError
        If it is not the ratio of torque to acceleration of the two bodies.
    """
    angle, height, torque = sp.symbols("angle height torque")
    weight = mass()
    bodies = [
        sp.Eq(-(Omega**2) * (J + J_load) * angle, torque - stiffness * r_s * (r_s * angle - height)),
        sp.Eq(-(Omega**2) * weight * height, stiffness * (r_s * angle - height)),
    ]
    found = sp.solve(bodies, [angle, height], dict=True)[0]
    met = J + J_load + sp.Abs(T_load) * r_s / g / (1 - Omega**2 * weight / stiffness)
    _zero(torque / (-(Omega**2) * found[angle]) - met, "torque over acceleration")
    _zero(sp.limit(met, stiffness, sp.oo) - inertia(), "a stiff string")
    _zero(sp.limit(met, stiffness, 0) - (J + J_load), "a soft string")
    return met
