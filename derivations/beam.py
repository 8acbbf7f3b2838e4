"""The stator as a Timoshenko beam on an elastic foundation (eqs. 3 to 6).

Hamilton's principle gives the coupled equations; a standing wave turns them into a dispersion
relation, whose lower root is the bending resonance.  The levels of resonance are this root and its
truncations, and eq. 6 as the paper prints it.
"""

from __future__ import annotations

from functools import cache

import sympy as sp
from sympy.calculus.euler import euler_equations

from derivations.nomenclature import sym

__all__ = ["dispersion", "elimination", "equations_of_motion", "resonance", "rotation_ratio"]

x, t = sym("x t")
E, rho, I_z, G, A, kappa = sym("E rho I_z G A kappa")
k_c, k_f, k_dx, omega_n = sym("k_c k_f k_dx omega_n")
w = sp.Function("w")(x, t)
theta = sp.Function("theta")(x, t)
p = sp.Function("p")(x, t)


@cache
def equations_of_motion() -> tuple[sp.Expr, sp.Expr]:
    """Timoshenko's equations from the Lagrangian density, as expressions that vanish (eq. 3).

    Kinetic energy of translation and rotation, strain energy of bending and shear, energy of the
    foundation, work of the load p.  Both are returned with the inertia term positive.
    """
    kinetic = (rho * A * w.diff(t) ** 2 + rho * I_z * theta.diff(t) ** 2) / 2
    strain = (E * I_z * theta.diff(x) ** 2 + kappa * G * A * (w.diff(x) - theta) ** 2 + k_f * w**2) / 2
    lagrangian = kinetic - strain + p * w
    force, moment = euler_equations(lagrangian, [w, theta], [x, t])
    return sp.expand(-force.lhs.doit()), sp.expand(-moment.lhs.doit())


@cache
def elimination() -> dict[str, sp.Expr]:
    """Coefficients of the single equation for w after theta is eliminated, p = 0 (eq. 5).

    Constant-coefficient operators commute, so theta is eliminated by the determinant of the system
    with d/dx -> X and d/dt -> S.  Keys name the derivative: ``xxxx``, ``xxtt``, ``tttt``, ``tt``, ``xx``, ``1``.
    Two terms, in ``xx`` and ``tt``, couple the foundation to shear and rotation; eq. 5 lacks them.
    """
    X, S, u, v = sp.symbols("X S u v")
    wave = sp.exp(X * x + S * t)
    rows = []
    for equation in equations_of_motion():
        value = equation.subs({w: u * wave, theta: v * wave, p: 0}).doit()
        value = sp.expand(sp.simplify(value / wave))
        rows.append([value.coeff(u), value.coeff(v)])
    operator = sp.Poly(sp.expand(sp.Matrix(rows).det() / (kappa * G * A)), X, S)
    names = {(4, 0): "xxxx", (2, 2): "xxtt", (0, 4): "tttt", (0, 2): "tt", (2, 0): "xx", (0, 0): "1"}
    return {names[power]: sp.simplify(coefficient) for power, coefficient in operator.terms()}


@cache
def dispersion() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """a, b, c of a omega^4 - b omega^2 + c = 0 for a wave of wavenumber k_c."""
    e = elimination()
    a = e["tttt"]
    b = e["tt"] - k_c**2 * e["xxtt"]
    c = e["xxxx"] * k_c**4 - e["xx"] * k_c**2 + e["1"]
    return a, b, c


def _lower_root() -> sp.Expr:
    """omega_n of the full quartic, in the form that does not cancel: 2c / (b + sqrt(b^2 - 4ac))."""
    a, b, c = dispersion()
    return sp.sqrt(2 * c / (b + sp.sqrt(b**2 - 4 * a * c)))


def _euler() -> sp.Expr:
    """Without shear deformation and rotary inertia: Euler-Bernoulli."""
    lagrangian = (rho * A * w.diff(t) ** 2 - E * I_z * w.diff(x, 2) ** 2 - k_f * w**2) / 2
    (equation,) = euler_equations(lagrangian, [w], [x, t])
    wave = sp.cos(k_c * x) * sp.cos(omega_n * t)
    residual = sp.expand(equation.lhs.subs(w, wave).doit() / wave)
    (square,) = sp.solve(residual, omega_n**2)
    return sp.sqrt(square)


@cache
def resonance() -> dict[str, sp.Expr]:
    """omega_n at each level; ``printed`` is eq. 6 as it stands, the others use k_f [N/m^2].

    ``eq6`` is what the derivation gives when the fourth time derivative is dropped; the printed form
    lost the factor E I_z in its denominator and puts k_dx [N/m] where k_f belongs.
    """
    _, b, c = dispersion()
    printed = sp.sqrt((E * I_z * k_c**4 + k_dx) / (rho * A + rho * (1 / (kappa * G) + 1 / E) * k_c**2))
    return {"euler": _euler(), "printed": printed, "eq6": sp.sqrt(c / b), "quartic": _lower_root()}


@cache
def rotation_ratio() -> sp.Expr:
    """beta: theta = -beta W sin(k_c x) when w = W cos(k_c x), from the moment equation at omega_n.

    On the lower branch it is positive and tends to k_c for a slender beam.
    """
    beta, W = sym("beta W")
    _, moment = equations_of_motion()
    shape = {w: W * sp.cos(k_c * x) * sp.cos(omega_n * t), theta: -beta * W * sp.sin(k_c * x) * sp.cos(omega_n * t)}
    (ratio,) = sp.solve(sp.simplify(moment.subs(shape).doit() / (sp.sin(k_c * x) * sp.cos(omega_n * t))), beta)
    return sp.simplify(ratio)
