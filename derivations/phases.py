"""The two phases in the three regions of a drive cycle (Sect. 3; eqs. 9, 10 and the supplement).

Each phase is an oscillator, w'' + 2 xi omega_n w' + omega_n^2 w = gate * forcing, whose steady response
is W cos(omega_q tau + phase).  In a region the gate is constant, so w is the gate times the steady
response plus a free motion; where a gate switches, displacement and velocity stay continuous, so the
free motion jumps by the steady state.  A region lasts a whole number of drive pulses, so the drive's
phase at every switching is the switching phase psi.

    region    A    B    pulses
    redu      off  on   m - n
    addredu   on   off  m - n
    add       on   on   2n - m
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = [
    "GATES",
    "PHASES",
    "REGIONS",
    "State",
    "cycle_time",
    "drive_frequency",
    "free",
    "periodic_start",
    "propagate_cycle",
    "region_times",
    "repetition",
    "response",
    "rest_start",
    "steady",
]

omega_n, Delta_omega, omega_q, xi, tau, T = sym("omega_n Delta_omega omega_q xi tau T")
W, psi, s, m, n = sym("W psi s m n")
a, b = sym("a b")

State = tuple[sp.Expr, sp.Expr]
REGIONS = ("redu", "addredu", "add")
PHASES = ("A", "B")
GATES = {"A": (0, 1, 1), "B": (1, 0, 1)}
PULSES = (m - n, m - n, 2 * n - m)


def drive_frequency() -> sp.Expr:
    """omega_q from the resonance and the frequency difference."""
    return omega_n + Delta_omega


def cycle_time() -> sp.Expr:
    """T_Qall: m drive pulses."""
    return 2 * sp.pi * m / drive_frequency()


def region_times() -> tuple[sp.Expr, ...]:
    """Durations of the three regions."""
    return tuple(2 * sp.pi * pulses / drive_frequency() for pulses in PULSES)


def _oscillator(w: sp.Expr) -> sp.Expr:
    """The left side of the phase's equation of motion."""
    return w.diff(tau, 2) + 2 * xi * omega_n * w.diff(tau) + omega_n**2 * w


@cache
def free() -> State:
    """Free motion from displacement a and velocity b: displacement and velocity after tau.

    Solved as exp(-xi omega_n tau) (c1 cos + c2 sin), and checked against equation and start.
    """
    omega_d = omega_n * sp.sqrt(1 - xi**2)
    c1, c2 = sp.symbols("c1 c2")
    ansatz = sp.exp(-xi * omega_n * tau) * (c1 * sp.cos(omega_d * tau) + c2 * sp.sin(omega_d * tau))
    start = sp.solve([ansatz.subs(tau, 0) - a, ansatz.diff(tau).subs(tau, 0) - b], [c1, c2])
    w = ansatz.subs(start)
    if sp.simplify(_oscillator(w)) != 0:
        raise ArithmeticError("the free motion does not solve the oscillator's equation")
    decay, c, sn = sp.exp(-xi * omega_n * tau), sp.cos(omega_d * tau), sp.sin(omega_d * tau)
    w = decay * (a * c + (b + xi * omega_n * a) / omega_d * sn)
    v = decay * (b * c - (omega_n * a + xi * b) * omega_n / omega_d * sn)
    if any(sp.simplify(difference) != 0 for difference in (w - ansatz.subs(start), v - ansatz.subs(start).diff(tau))):
        raise ArithmeticError("the collected free motion differs from the solved one")
    return w, v


def steady(phase: str) -> State:
    """Steady response of a phase that is on: displacement and velocity, tau from any switching.

    B leads A by s quarter periods; since s is +1 or -1, cos(s pi/2) = 0 and sin(s pi/2) = s exactly.
    """
    angle = sp.Symbol("angle", real=True)
    shape = sp.cos(angle)
    if phase == "B":
        quarter = s * sp.pi / 2
        shape = sp.expand_trig(sp.cos(angle + quarter)).subs({sp.cos(quarter): 0, sp.sin(quarter): s})
        if any(shape.subs(s, side) != sp.cos(angle + quarter.subs(s, side)) for side in (1, -1)):
            raise ArithmeticError("phase B is not a quarter period from phase A")
    w = W * shape.subs(angle, drive_frequency() * tau + psi)
    return w, w.diff(tau)


def _switching(phase: str) -> State:
    """The steady state at a switching, by which the free motion jumps."""
    w, v = steady(phase)
    return w.subs(tau, 0), v.subs(tau, 0)


def _after(state: State, duration: sp.Expr) -> State:
    w, v = free()
    values = {a: state[0], b: state[1], tau: duration}
    return w.subs(values, simultaneous=True), v.subs(values, simultaneous=True)


def _plus(state: State, other: State, factor: int) -> State:
    return state[0] + factor * other[0], state[1] + factor * other[1]


def propagate_cycle(phase: str, before: State) -> tuple[State, State, State, State]:
    """Free motion at the start of each region and at the cycle's end.

    Parameters
    ----------
    phase : str
        ``"A"`` or ``"B"``.
    before : (displacement, velocity)
        Free motion just before t1, while the phase is still on.
    """
    states: list[State] = []
    state, gate_before = before, 1
    for gate, duration in zip(GATES[phase], region_times(), strict=True):
        state = _plus(state, _switching(phase), gate_before - gate)
        states.append(state)
        state, gate_before = _after(state, duration), gate
    return states[0], states[1], states[2], state


def rest_start(phase: str) -> State:
    """Free motion just before t1 when the phase is at rest: it cancels the steady state."""
    w, v = _switching(phase)
    return -w, -v


def _residue_of_cycle() -> tuple[sp.Expr, sp.Expr]:
    """1 - exp(lambda T) = re - i im for the free eigenvalue lambda, without cancellation.

    omega_q T is a whole number of turns, so omega_d T may be counted from it: the angle left is
    (omega_d - omega_q) T = -(Delta_omega + omega_n xi^2 / (1 + sqrt(1 - xi^2))) T.
    """
    time = cycle_time()
    angle = -(Delta_omega + omega_n * xi**2 / (1 + sp.sqrt(1 - xi**2))) * time
    decay = sp.exp(-xi * omega_n * time)
    lost = -sp.Function("expm1")(-xi * omega_n * time)
    real = lost + 2 * decay * sp.sin(angle / 2) ** 2
    imaginary = decay * sp.sin(angle)
    return real, imaginary


@cache
def periodic_start(phase: str) -> State:
    """Free motion just before t1 that repeats itself after a cycle: x0 = (I - M)^-1 c.

    c is what a cycle makes of no free motion.  M has the eigenvalues exp(lambda T); written on the
    oscillator's own coordinates, (I - M)^-1 is one complex division.
    """
    c_w, c_v = propagate_cycle(phase, (sp.Integer(0), sp.Integer(0)))[3]
    omega_d = omega_n * sp.sqrt(1 - xi**2)
    # w = Re z, with z = w - i (v + xi omega_n w) / omega_d, turns free motion into z exp(lambda tau).
    z_re, z_im = c_w, -(c_v + xi * omega_n * c_w) / omega_d
    re, im = _residue_of_cycle()
    square = re**2 + im**2
    # z0 = z / (1 - exp(lambda T)) = z / (re - i im)
    w0 = (z_re * re - z_im * im) / square
    i0 = (z_re * im + z_im * re) / square
    return w0, -omega_d * i0 - xi * omega_n * w0


def repetition() -> sp.Expr:
    """|1 - exp(lambda T)|: how firmly the repeated cycle fixes its periodic state; 0 where none exists."""
    re, im = _residue_of_cycle()
    return sp.sqrt(re**2 + im**2)


def response(phase: str) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Displacement, velocity and acceleration of a phase, tau after the start of a region."""
    a_p, b_p, gate = sym(f"a_{phase} b_{phase} g_{phase}")
    w_free, v_free = free()
    w_on, v_on = steady(phase)
    values = {a: a_p, b: b_p}
    w = w_free.subs(values) + gate * w_on
    v = v_free.subs(values) + gate * v_on
    acceleration_free = -2 * xi * omega_n * v_free.subs(values) - omega_n**2 * w_free.subs(values)
    return w, v, acceleration_free + gate * v_on.diff(tau)
