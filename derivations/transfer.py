"""From the vibrating surface to the force on the rotor (Sect. 4; eqs. 28 to 38).

u = k_c (x - x_max) is the angle from the crest.  The surface moves under the rotor with
v_x(u) = R cos(u - phi), the layer presses with p(u) ~ cos u - cos theta on |u| < theta, and Coulomb's
friction points along v_x - v.  All of the paper's transfer cases are one closed form: the surface is faster
than the rotor where cos(u - phi) > c = v/R, that is between u = phi - acos c and u = phi + acos c, and the
net share of friction is twice the share of the load there, less one.

Clipping is by Max and Min, so every expression can become a kernel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derivations.nomenclature import sym
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = [
    "CASES",
    "DIMENSIONS",
    "TransferCase",
    "crest_amplitude",
    "friction_force",
    "friction_fraction",
    "half_zone_fraction",
    "nonsliding_point_of_half_zone",
    "nonsliding_points",
    "pressure_distribution",
    "pressure_share",
    "speed_amplitude",
    "speed_angle",
    "steady_wave_fraction",
    "surface_speed",
    "torque_balance",
    "wave_states",
    "whole_wave_share",
]

t, x, k_c, D, theta, F_c, n_j = sym("t x k_c D theta F_c n_j")
mu, r_c, J = sym("mu r_c J")
u, phi, c, v = sp.symbols("u phi c v", real=True)
W_c, R_v, epsilon = sp.symbols("W_c R_v epsilon", positive=True)
W_c_rate, q = sp.symbols(r"\dot{W}_c q", real=True)
w_A, w_B, v_A, v_B = sp.symbols("w_A w_B v_A v_B", real=True)
omega_p, T_load, f_net = sp.symbols("omega_p T_load f_net", real=True)

_UNITS = {
    u: "rad",
    phi: "rad",
    c: "1",
    v: "m/s",
    W_c: "m",
    R_v: "m/s",
    epsilon: "1",
    W_c_rate: "m/s",
    q: "m^2/s",
    w_A: "m",
    w_B: "m",
    v_A: "m/s",
    v_B: "m/s",
    omega_p: "rad/s",
    T_load: "N*m",
    f_net: "1",
}
DIMENSIONS: dict[sp.Basic, Dimension] = {symbol: parse_unit(unit).dimension for symbol, unit in _UNITS.items()}


def wave_states() -> dict[sp.Symbol, sp.Expr]:
    """W_c, its rate and q for given displacements and velocities of the two phases (eqs. 20, 21, 42)."""
    height = sp.sqrt(w_A**2 + w_B**2)
    return {W_c: height, W_c_rate: (w_A * v_A + w_B * v_B) / height, q: v_A * w_B - v_B * w_A}


def crest_amplitude() -> sp.Expr:
    """zeta_zmax = W_c: the wave w_A sin(k_c x) + w_B cos(k_c x) at k_c x_max = atan2(w_A, w_B) (eq. 21)."""
    return wave_states()[W_c]


@cache
def surface_speed() -> sp.Expr:
    """v_x(u) = D k_c [(q/W_c) cos u - W_c' sin u], from eq. 11 at k_c x = u + atan2(w_A, w_B).

    Raises
    ------
    ArithmeticError
        If this differs from D d2(zeta_z)/dx dt for any displacements and velocities of the phases.
    """
    A, B = sp.Function("A")(t), sp.Function("B")(t)
    general = D * (A * sp.sin(k_c * x) + B * sp.cos(k_c * x)).diff(x, t)
    general = general.subs({A.diff(t): v_A, B.diff(t): v_B}).subs({A: w_A, B: w_B})
    height = sp.sqrt(w_A**2 + w_B**2)
    sine = (sp.sin(u) * w_B + sp.cos(u) * w_A) / height
    cosine = (sp.cos(u) * w_B - sp.sin(u) * w_A) / height
    general = general.subs({sp.sin(k_c * x): sine, sp.cos(k_c * x): cosine})
    result = D * k_c * (q / W_c * sp.cos(u) - W_c_rate * sp.sin(u))
    if sp.expand(general - result.subs(wave_states())) != 0:
        raise ArithmeticError("the surface speed about the crest is not eq. 11's")
    return result


@cache
def speed_amplitude() -> sp.Expr:
    """R, the largest surface speed: D k_c sqrt((q/W_c)^2 + W_c'^2) = D k_c sqrt(w_A'^2 + w_B'^2) (eq. 17).

    Raises
    ------
    ArithmeticError
        If the two forms differ.
    """
    result = D * k_c * sp.sqrt((q / W_c) ** 2 + W_c_rate**2)
    square = (result**2).subs(wave_states()) - (D * k_c) ** 2 * (v_A**2 + v_B**2)
    if sp.factor(sp.expand(square)) != 0:
        raise ArithmeticError("the amplitude of the surface speed is not that of both phases' velocities")
    return result


def speed_angle() -> sp.Expr:
    """phi, where in the wave the surface is fastest: v_x(u) = R cos(u - phi)."""
    return sp.atan2(-W_c * W_c_rate, q)


def pressure_share(low: sp.Expr = -theta, high: sp.Expr = theta) -> sp.Expr:
    """C(u): share of the load left of u, between ``low`` and ``high`` inside the contact (eqs. 28 to 31)."""

    def load(at: sp.Expr) -> sp.Expr:
        return sp.sin(at) - at * sp.cos(theta)

    inside = sp.Max(low, sp.Min(high, u))
    return (load(inside) - load(low)) / (load(high) - load(low))


def whole_wave_share() -> sp.Expr:
    """C(u) when even theta = pi cannot carry the load: the whole wave presses, p ~ 1 + epsilon cos u.

    epsilon <= 1 is the layer's alternating over its mean pressure, k_N W_c 2 pi n_j / (k_c F_c).
    """
    inside = sp.Max(-sp.pi, sp.Min(sp.pi, u))
    return (inside + sp.pi + epsilon * sp.sin(inside)) / (2 * sp.pi)


def _opening() -> sp.Expr:
    """Half-width acos c, c limited to [-1, 1]: how far around phi the surface is faster than the rotor."""
    return sp.acos(sp.Max(-1, sp.Min(1, c)))


def nonsliding_points(turn: int = 0) -> tuple[sp.Expr, sp.Expr]:
    """The u where v_x falls below, and where it rises above, the rotor's speed (eqs. 34, 35): all branches.

    Every solution of R cos(u - phi) = v is one of these for some whole number of turns; those with
    |u| < theta lie in the contact, where there may be none, one or two.
    """
    return phi + _opening() + 2 * sp.pi * turn, phi - _opening() + 2 * sp.pi * turn


def nonsliding_point_of_half_zone() -> sp.Expr:
    """The only nonsliding point in 0 < u < theta, where there is just one (eq. 35), by the speed at the crest."""
    return _nearest(phi + sp.sign(sp.cos(phi) - c) * _opening())


def friction_fraction(share: sp.Expr | None = None) -> sp.Expr:
    """Net friction over mu F_c: f = 2 sum_j [C(phi + acos c + 2 pi j) - C(phi - acos c + 2 pi j)] - 1.

    From -1 (the rotor outruns the surface everywhere, c >= 1) to +1 (c <= -1).  j = -1, 0, 1 suffice since
    |phi| <= pi, acos c <= pi and |u| <= pi.

    Parameters
    ----------
    share : sympy.Expr, optional
        C(u); that of the partial contact if not given.
    """
    C = pressure_share() if share is None else share
    faster = sum(C.subs(u, falls) - C.subs(u, rises) for falls, rises in map(nonsliding_points, (-1, 0, 1)))
    return 2 * faster - 1


def half_zone_fraction() -> sp.Expr:
    """The friction fraction of the zone's right half alone, which eq. 36 doubles."""
    return friction_fraction(pressure_share(sp.Integer(0), theta))


def steady_wave_fraction() -> sp.Expr:
    """F for a steady wave (phi = 0) whose nonsliding points lie at +-a inside the contact."""
    a = sp.Symbol("a", positive=True)
    return 2 * (sp.sin(a) - a * sp.cos(theta)) / (sp.sin(theta) - theta * sp.cos(theta)) - 1


@cache
def pressure_distribution() -> sp.Expr:
    """Line pressure p(u) >= 0, N/m, that carries F_c on all crests: eq. 32 from eqs. 28, 30, 31."""
    shape = sp.cos(u) - sp.cos(theta)
    carried = n_j / k_c * sp.integrate(shape, (u, -theta, theta))
    return F_c * sp.Max(0, shape) / sp.factor(carried)


def friction_force() -> sp.Expr:
    """Net friction on the rotor, N, for the fraction ``f_net`` (eq. 36 over the whole zone)."""
    return mu * F_c * f_net


def torque_balance() -> sp.Expr:
    """d(omega_p)/dt from the angular momentum of the rotor (eq. 38)."""
    return (r_c * friction_force() - T_load) / J


@dataclass(frozen=True)
class TransferCase:
    """One of the sixteen transfer models (Figs. 7, 8), on the half zone 0 < u < theta as the paper draws it.

    The text names what tells them apart: the rotor's direction, the sign of v_x - v at the crest and at the
    edge, and (eq. 35) whether v_x has a peak or trough between them.

    Attributes
    ----------
    forward : bool
        The rotor's speed is positive (Fig. 7), or negative (Fig. 8).
    crest, edge : int
        Sign of v_x - v at u = 0 and at u = theta.
    extremum : bool
        v_x has an extremum inside.
    """

    forward: bool
    crest: int
    edge: int
    extremum: bool

    @property
    def name(self) -> str:
        """Such as ``forward +-, extremum``."""
        signs = "".join("+" if sign > 0 else "-" for sign in (self.crest, self.edge))
        return f"{'forward' if self.forward else 'reverse'} {signs}, {'extremum' if self.extremum else 'monotone'}"

    def fraction(self) -> sp.Expr:
        """What the closed form becomes in this case for |c| < 1, with C the half zone's share.

        Where the sign changes once, one nonsliding point is left; where it is equal at both ends it changes
        twice or not at all, and twice only around an extremum.  A stretch that is slower than a rotor running
        forward, or faster than one running backward, is longer than half a wave and fits between no two ends.
        """
        C = pressure_share(sp.Integer(0), theta)
        falls, rises = (_nearest(phi + sp.acos(c)), _nearest(phi - sp.acos(c)))
        if self.crest != self.edge:
            return self.crest * (2 * C.subs(u, falls if self.crest > 0 else rises) - 1)
        if not self.extremum or (self.crest > 0) == self.forward:
            return sp.Integer(self.crest)
        if self.crest < 0:  # a faster stretch around the peak at phi, or none
            return 2 * (C.subs(u, _nearest(phi) + sp.acos(c)) - C.subs(u, _nearest(phi) - sp.acos(c))) - 1
        slow, closing = _nearest(phi + sp.pi), sp.pi - sp.acos(c)  # a slower stretch around the trough, or none
        return 1 - 2 * (C.subs(u, slow + closing) - C.subs(u, slow - closing))


def _nearest(angle: sp.Expr) -> sp.Expr:
    """The angle by whole turns into (-pi, pi]: every point of the half zone 0 < u < theta <= pi is its own."""
    return sp.atan2(sp.sin(angle), sp.cos(angle))


CASES = tuple(
    TransferCase(forward, crest, edge, extremum)
    for forward in (True, False)
    for crest in (1, -1)
    for edge in (1, -1)
    for extremum in (False, True)
)
