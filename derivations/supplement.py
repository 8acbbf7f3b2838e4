"""The paper's missing supplement: amplitudes and phases of eqs. (9) and (10) in the three regions.

A phase that is on is a forced and a free motion,

    w = W sin(omega_q tau + Psi) + R exp(-xi omega_n tau) sin(omega_d tau + Theta),

and the sum of two sines is one of the mean frequency, with an amplitude and a phase that beat slowly:

    w = A sin((omega_d + omega_q) tau / 2 + (Theta + Psi) / 2 + varphi).

Written in the paper's sines; s = +1, B leads A by a quarter period.  The paper sets omega_d = omega_n.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations import phases
from derivations.nomenclature import sym

__all__ = ["beating", "damped_frequency", "forced_phase", "free_polar", "free_start", "region_start"]

omega_n, omega_q, xi, W, psi, tau, a, b, s = sym("omega_n omega_q xi W psi tau a b s")
Delta_omega, omega_d = sym("Delta_omega omega_d")


def damped_frequency() -> sp.Expr:
    """omega_d, the frequency of free motion."""
    return omega_n * sp.sqrt(1 - xi**2)


def free_polar() -> tuple[sp.Expr, sp.Expr]:
    """R and Theta of a free motion R exp(-xi omega_n tau) sin(omega_d tau + Theta) with displacement a, velocity b."""
    sine, cosine = a, (b + xi * omega_n * a) / omega_d
    return sp.sqrt(sine**2 + cosine**2), sp.atan2(sine, cosine)


def forced_phase(phase: str) -> sp.Expr:
    """Psi: the steady response of a phase is W sin(omega_q tau + Psi) from any switching on."""
    w, v = phases.steady(phase)
    start = w.subs(tau, 0).subs(s, 1), v.subs(tau, 0).subs(s, 1)
    candidate = psi + sp.pi / 2 if phase == "A" else psi + sp.pi
    rate = phases.drive_frequency()
    if (
        sp.expand_trig(start[0] - W * sp.sin(candidate)) != 0
        or sp.expand_trig(start[1] - W * rate * sp.cos(candidate)).expand() != 0
    ):
        raise ArithmeticError(f"the forced phase of {phase} does not give the steady response")
    return candidate


@cache
def free_start(phase: str, region: str) -> tuple[sp.Expr, sp.Expr]:
    """A and b: free displacement and velocity at the start of a region, the cycle having begun in steady state."""
    index = phases.REGIONS.index(region)
    state = phases.propagate_cycle(phase, (sp.Integer(0), sp.Integer(0)))[index]
    values = {s: 1, phases.Delta_omega: omega_q - omega_n}
    return state[0].subs(values), state[1].subs(values)


def region_start(region: str) -> sp.Expr:
    """Duration from t_1 to the start of a region."""
    index = phases.REGIONS.index(region)
    return sum(phases.region_times()[:index], sp.Integer(0)).subs(phases.Delta_omega, omega_q - omega_n)


@cache
def beating(free: sp.Expr, theta: sp.Expr, forced: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Amplitude A and slow phase varphi of W sin(omega_q tau + forced) + free exp(..) sin(omega_d tau + theta).

    Raises
    ------
    ArithmeticError
        If the product form is not the sum.
    """
    P, R, mean, half = sp.symbols("P R mean half", real=True)
    total = P * sp.sin(mean + half) + R * sp.sin(mean - half)
    product = (P + R) * sp.cos(half) * sp.sin(mean) + (P - R) * sp.sin(half) * sp.cos(mean)
    square = ((P + R) * sp.cos(half)) ** 2 + ((P - R) * sp.sin(half)) ** 2
    law = P**2 + R**2 + 2 * P * R * sp.cos(2 * half)
    if sp.expand(sp.expand_trig(total - product)) != 0 or sp.simplify(square - law) != 0:
        raise ArithmeticError("the product form is not the sum")
    decayed = free * sp.exp(-xi * omega_n * tau)
    difference = (omega_q - omega_d) * tau + forced - theta
    values = {P: W, R: decayed, half: difference / 2}
    amplitude = sp.sqrt(law.subs({P: W, R: decayed}).subs(half, difference / 2))
    phase = sp.atan2(((P - R) * sp.sin(half)).subs(values), ((P + R) * sp.cos(half)).subs(values))
    return amplitude, phase
