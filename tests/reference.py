"""Independent witnesses: a state-space ODE of the two phases, and 50-digit sums of exponentials.

Written from the statement of the model (an oscillator per phase, gated forcing, continuous displacement and
velocity), not from the derivations: nothing here imports them or the kernels.
"""

from __future__ import annotations

from itertools import pairwise

import mpmath as mp
import numpy as np
import scipy

GATES = ((0, 1), (1, 0), (1, 1))  # (A, B) in the regions redu, addredu, add


def region_pulses(m, n):
    return np.array([m - n, m - n, 2 * n - m])


def steady_state(f_n, df, psi, s, time):
    """w_A, w_B and their velocities in full steady vibration of unit amplitude."""
    omega_q = 2 * np.pi * (f_n + df)
    a, b = omega_q * time + psi, omega_q * time + psi + s * np.pi / 2
    return np.array([np.cos(a), np.cos(b), -omega_q * np.sin(a), -omega_q * np.sin(b)])


def integrate_regions(y, f_n, df, xi, psi, s, m, n, fractions, rtol=1e-12):
    """DOP853 through one cycle of many drives in lockstep; time is scaled by each drive's region.

    ``y`` is (4, drives): w_A, w_B, v_A, v_B at t1.  Returns states at ``fractions`` of every region,
    (3, len(fractions), 4, drives), and the state at the cycle's end.
    """
    omega_n, omega_q = 2 * np.pi * f_n, 2 * np.pi * (f_n + df)
    scale = np.stack([np.ones_like(f_n), np.ones_like(f_n), omega_q, omega_q])
    phases = np.stack([psi, psi + s * np.pi / 2])
    seen = []
    for pulses, gate in zip(region_pulses(m, n), GATES, strict=True):
        turns = 2 * np.pi * pulses
        ratio = omega_n / omega_q
        gates = np.array(gate, float)[:, None]

        def rate(sigma, flat, turns=turns, ratio=ratio, gates=gates):
            w, v = flat.reshape(2, 2, -1)
            angle = turns * sigma + phases
            force = (ratio**2 - 1) * np.cos(angle) - 2 * xi * ratio * np.sin(angle)
            return (turns * np.stack([v, gates * force - 2 * xi * ratio * v - ratio**2 * w])).ravel()

        solution = scipy.integrate.solve_ivp(
            rate, (0, 1), (y / scale).ravel(), method="DOP853", rtol=rtol, atol=1e-13, t_eval=[*fractions, 1.0]
        )
        states = solution.y.T.reshape(len(fractions) + 1, 4, -1) * scale
        seen.append(states[:-1])
        y = states[-1]
    return np.array(seen), y


class Exponentials:
    """A finite sum of c exp(mu t), closed under products, with exact integrals, in mpmath."""

    def __init__(self, terms):
        self.terms = terms

    def __mul__(self, other):
        return Exponentials([(a * b, mu + nu) for a, mu in self.terms for b, nu in other.terms])

    def __sub__(self, other):
        return Exponentials(self.terms + [(-b, nu) for b, nu in other.terms])

    def __add__(self, other):
        return Exponentials(self.terms + other.terms)

    def derivative(self):
        return Exponentials([(c * mu, mu) for c, mu in self.terms])

    def __call__(self, t):
        return mp.re(mp.fsum(c * mp.exp(mu * t) for c, mu in self.terms))

    def sampled(self, t):
        return sum(complex(c) * np.exp(complex(mu) * t) for c, mu in self.terms).real

    def integral(self, a, b):
        tiny = mp.mpf(10) ** -40
        return mp.re(
            mp.fsum(
                c * (b - a) if abs(mu) < tiny else c * (mp.exp(mu * b) - mp.exp(mu * a)) / mu for c, mu in self.terms
            )
        )


def _real(z, mu):
    return Exponentials([(z / 2, mu), (mp.conj(z) / 2, mp.conj(mu))])


def reference_sums(f_n, df, xi, psi, s, m, n, start):
    """Integrals of Q+, |Q-|, Q+^2, Q-^2 over a cycle for unit W, D, k, and T, at the working precision."""
    f_n, df, xi, psi = (mp.mpf(v) for v in (f_n, df, xi, psi))
    m, n, s = int(m), int(n), int(s)
    omega_n, omega_q = 2 * mp.pi * f_n, 2 * mp.pi * (f_n + df)
    lam = omega_n * mp.mpc(-xi, mp.sqrt(1 - xi**2))
    forced = {"A": mp.expj(psi), "B": mp.expj(psi + s * mp.pi / 2)}
    times = [2 * mp.pi * int(p) / omega_q for p in region_pulses(m, n)]

    def to_free(w, v):  # w = Re z, v = Re(lam z)
        return mp.mpc(w, (mp.re(lam) * w - v) / mp.im(lam))

    jump = {p: to_free(mp.re(z), mp.re(1j * omega_q * z)) for p, z in forced.items()}

    def cycle(phase, z):
        states, gate_before = [], 1
        for gates, time in zip(GATES, times, strict=True):
            gate = gates["AB".index(phase)]
            z = z + (gate_before - gate) * jump[phase]
            states.append(z)
            z, gate_before = z * mp.exp(lam * time), gate
        return states, z

    def initial(phase):
        if start == "steady":
            return mp.mpc(0)
        if start == "rest":
            return -jump[phase]
        total = mp.exp(lam * mp.fsum(times))
        return cycle(phase, mp.mpc(0))[1] / (1 - total)

    states = {p: cycle(p, initial(p))[0] for p in "AB"}
    sums = [mp.mpf(0)] * 4
    for r, (gates, time) in enumerate(zip(GATES, times, strict=True)):
        if time == 0:
            continue
        w = {}
        for i, p in enumerate("AB"):
            w[p] = _real(states[p][r], lam) + _real(gates[i] * forced[p], 1j * omega_q)
        Q = w["A"].derivative() * w["B"] - w["B"].derivative() * w["A"]
        square = Q * Q
        edges = [mp.mpf(0), *_crossings(Q, time, omega_q), time]
        for a, b in pairwise(edges):
            area, energy = Q.integral(a, b), square.integral(a, b)
            k = 0 if area >= 0 else 1
            sums[k] += abs(area)
            sums[k + 2] += energy
    return sums, mp.fsum(times)


def _crossings(Q, time, omega_q):
    count = int(400 * float(time * omega_q / (2 * mp.pi))) + 2
    grid = np.linspace(0.0, float(time), count)
    values = Q.sampled(grid)
    scale = np.abs(values).max()
    if scale == 0 or not np.any(np.abs(values) > 1e-300):
        return []
    slope = Q.derivative()
    roots = []
    for i in np.nonzero((values[:-1] >= 0) != (values[1:] >= 0))[0]:
        low, high = mp.mpf(grid[i]), mp.mpf(grid[i + 1])
        f_low = Q(low)
        for _ in range(12):  # bisection, then Newton: both bracketed by the sample spacing
            middle = (low + high) / 2
            low, high = (middle, high) if (Q(middle) >= 0) == (f_low >= 0) else (low, middle)
        root = (low + high) / 2
        for _ in range(7):
            root -= Q(root) / slope(root)
        roots.append(root)
    return roots


def reference_measures(f_n, df, xi, psi, s, m, n, start):
    """X, Y, Q_aver and Q_vib at the working precision."""
    (plus, minus, plus2, minus2), T = reference_sums(f_n, df, xi, psi, s, m, n, start)
    average = (plus - minus) / (plus + minus) / T
    volatility = mp.sqrt((plus2 + minus2) / abs(plus2 - minus2)) / (T**2 * average)
    return plus / minus if minus else mp.inf, plus2 / minus2 if minus2 else mp.inf, average, volatility
