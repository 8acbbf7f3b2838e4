"""The rotor's orbit as others would find it: fixed and adaptive Runge-Kutta in Numba, LSODA, diffrax.

The equation of motion is the witness's, ``studies/witness.py``, compiled by Numba; diffrax has it once more in JAX.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit

import trum_sym as ts
from studies import witness
from studies.witness import _friction, _phasors, _surface

__all__ = ["Figures", "Point", "adaptive", "diffrax_lap", "fixed", "scipy_lap"]

_TURN = 2 * math.pi
_LAPS = 40


@dataclass(frozen=True)
class Figures:
    """Of an orbit, m/s at the rim: its mean, and lowest, highest, deviation where they were asked for; laps taken."""

    mean: float
    low: float = math.nan
    high: float = math.nan
    deviation: float = math.nan
    laps: int = 1

    def error(self, of: Figures) -> float:
        """The largest error of what there is, over the largest speed of another."""
        ours = np.array([self.mean, self.low, self.high, self.deviation])
        off = np.abs(ours - [of.mean, of.low, of.high, of.deviation])
        return float(np.nanmax(off) / max(abs(of.low), abs(of.high)))


@dataclass(frozen=True)
class Point:
    """The witness's constants of a point of the start ``periodic``, periods in a cycle and those on."""

    p: np.ndarray
    periods: int
    on: int

    @classmethod
    def of(cls, motor: ts.Motor, drive: ts.Drive) -> Point:
        """From the product's inputs; the stator's figures are the product's."""
        point = ts.evaluate(motor, drive)
        names = ("resonance_frequency", "amplitude", "neutral_axis", "wavenumber")
        stator = {name: np.float64(getattr(point, name)) for name in names}
        values = {name: np.float64(parameter.value) for name, parameter in motor.parameters()}
        numbers = {name: np.float64(value) for name, value in drive.numbers().items()}
        p = witness.constants(values, numbers, stator, "winkler")
        return cls(p, int(drive.periods), int(drive.on_periods))

    def reference(self) -> tuple[Figures, float]:
        """The witness's figures at its finest, and the speed at which the orbit starts."""
        found = witness.orbit(self.p, self.periods, self.on, 2)
        if found is None:
            raise RuntimeError("the witness finds no orbit")
        return Figures(found.mean, found.low, found.high, found.deviation, found.laps), found.start

    def regions(self) -> tuple[np.ndarray, np.ndarray]:
        """States of the phases at the start of the cycle's three regions, and how long these are."""
        m, n, period = self.periods, self.on, _TURN / self.p[2]
        return _phasors(self.p, m, n, 2), np.array([m - n, m - n, 2 * n - m]) * period


# --- Runge-Kutta of order 4 with a fixed step -----------------------------------------------------
# The surface does not depend on the rotor: it is computed once, at the nodes and between them, and every lap uses it.


@njit(cache=True)
def _surfaces(p, phasors, durations, counts):
    """Surface at the ends and middles of all steps, region after region: every region has its own first node."""
    at = np.zeros((2 * counts.sum() + 3, 8))
    k = 0
    for r in range(3):
        half = durations[r] / (2 * max(counts[r], 1))
        for i in range(2 * counts[r] + 1):
            if i > 0:
                at[k, 2] = at[k - 1, 2]
            _surface(p, phasors[r], i * half, at[k])
            k += 1
    return at


@njit(cache=True)
def _rk4_lap(p, at, durations, counts, v, out):
    """A lap from rim speed v.  out: end, ln of the lap map's slope, integrals of v and v^2, lowest, highest."""
    k = 0
    first = v
    log, sum_v, sum_vv, low, high = 0.0, 0.0, 0.0, v, v
    for r in range(3):
        if counts[r] == 0:
            k += 1
            continue
        h = durations[r] / counts[r]
        f, slope, _ = _friction(at[k], v)
        rate, fall = p[10] * f - p[11], slope
        for _ in range(counts[r]):
            k2, middle, _ = _friction(at[k + 1], v + 0.5 * h * rate)
            k2 = p[10] * k2 - p[11]
            k3, _, _ = _friction(at[k + 1], v + 0.5 * h * k2)
            k3 = p[10] * k3 - p[11]
            k4, _, _ = _friction(at[k + 2], v + h * k3)
            k4 = p[10] * k4 - p[11]
            new = v + h * (rate + 2 * k2 + 2 * k3 + k4) / 6
            f, slope, _ = _friction(at[k + 2], new)
            after = p[10] * f - p[11]
            half = 0.5 * (v + new) + 0.125 * h * (rate - after)  # of Hermite's cubic
            sum_v += h * (v + 4 * half + new - 6 * first) / 6
            sum_vv += h * ((v - first) ** 2 + 4 * (half - first) ** 2 + (new - first) ** 2) / 6
            log += h * p[10] * (fall + 4 * middle + slope) / 6
            if (rate > 0) != (after > 0):  # the cubic's extreme, by the secant of its slopes and one step of Newton
                s = rate / (rate - after)
                d = new - v
                for _ in range(3):
                    g = h * rate + s * (6 * d - 4 * h * rate - 2 * h * after) + s * s * (3 * h * (rate + after) - 6 * d)
                    bend = 6 * d - 4 * h * rate - 2 * h * after + 2 * s * (3 * h * (rate + after) - 6 * d)
                    if bend != 0.0:
                        s = min(1.0, max(0.0, s - g / bend))
                top = v + s * (h * rate + s * (3 * d - 2 * h * rate - h * after + s * (h * (rate + after) - 2 * d)))
                low, high = min(low, top), max(high, top)
            v, rate, fall = new, after, slope
            low, high = min(low, v), max(high, v)
            k += 2
        k += 1
    out[0], out[1], out[2], out[3], out[4], out[5] = v, log, sum_v, sum_vv, low, high


@njit(cache=True)
def _rk4_orbit(p, phasors, durations, counts, v, allowed, out):
    """Newton's laps until they repeat; the number of laps, negative if they do not."""
    at = _surfaces(p, phasors, durations, counts)
    for lap in range(_LAPS):
        _rk4_lap(p, at, durations, counts, v, out)
        out[6] = v
        gain = out[0] - v
        if abs(gain) <= allowed * max(abs(out[4]), abs(out[5])):
            return lap + 1
        v += gain / max(1.0 - math.exp(out[1]), 1e-6)
    return -1


def fixed(point: Point, steps: int, accuracy: float) -> Callable[[], Figures]:
    """Runge-Kutta of order 4 with so many steps a drive period, Newton's method on the laps, begun from rest."""
    m, n = point.periods, point.on
    counts = np.array([m - n, m - n, 2 * n - m]) * steps

    def run() -> Figures:
        phasors, durations = point.regions()
        out = np.empty(7)
        laps = _rk4_orbit(point.p, phasors, durations, counts, 0.0, 0.1 * accuracy, out)
        return _figures(out, durations.sum(), laps)

    return run


def _figures(out: np.ndarray, whole: float, laps: int) -> Figures:
    mean, square = out[2] / whole, out[3] / whole  # of the difference from the speed that the lap began at
    return Figures(out[6] + mean, out[4], out[5], math.sqrt(max(square - mean * mean, 0.0)), laps)


# --- Runge-Kutta of order 5(4) by Dormand and Prince with a controlled step -----------------------

_C = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
_A = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
_E = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])


@njit(cache=True)
def _adaptive_lap(p, phasors, durations, first, allowed, tables, out):
    """As :func:`_rk4_lap`, of the speed's difference from the first one; a step may be off by so much."""
    c, a, e = tables
    period = _TURN / p[2]
    k, s, at = np.empty(7), np.empty(7), np.zeros(8)
    x, log, sum_x, sum_xx, low, high, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, period / 100
    for r in range(3):
        tau, end = 0.0, durations[r]
        if end == 0.0:
            continue
        _surface(p, phasors[r], 0.0, at)
        f, s[0], _ = _friction(at, first + x)
        k[0] = p[10] * f - p[11]
        while tau < end:
            last = tau + h * 1.0000001 >= end
            step = end - tau if last else h
            for i in range(1, 7):
                y = x
                for j in range(i):
                    y += step * a[i, j] * k[j]
                _surface(p, phasors[r], tau + c[i] * step, at)
                f, s[i], _ = _friction(at, first + y)
                k[i] = p[10] * f - p[11]
            error = 0.0
            for i in range(7):
                error += e[i] * k[i]
            ratio = abs(step * error) / allowed
            if ratio > 1.0 and step > 1e-12 * period:
                h = step * max(0.2, 0.9 * ratio**-0.2)
                continue
            half = 0.5 * (x + y) + 0.125 * step * (k[0] - k[6])
            sum_x += step * (x + 4 * half + y) / 6
            sum_xx += step * (x * x + 4 * half * half + y * y) / 6
            log += step * p[10] * (s[0] + 4 * s[3] + s[6]) / 6
            if (k[0] > 0) != (k[6] > 0):
                q, d = k[0] / (k[0] - k[6]), y - x
                for _ in range(3):
                    once, twice = 6 * d - 4 * step * k[0] - 2 * step * k[6], 3 * step * (k[0] + k[6]) - 6 * d
                    bend = once + 2 * q * twice
                    if bend != 0.0:
                        q = min(1.0, max(0.0, q - (step * k[0] + q * (once + q * twice)) / bend))
                once, twice = 3 * d - 2 * step * k[0] - step * k[6], step * (k[0] + k[6]) - 2 * d
                top = x + q * (step * k[0] + q * (once + q * twice))
                low, high = min(low, top), max(high, top)
            low, high = min(low, y), max(high, y)
            x, k[0], s[0] = y, k[6], s[6]
            tau = end if last else tau + step
            h = min(period / 20, step * min(5.0, 0.9 * (ratio + 1e-12) ** -0.2))
    out[0], out[1], out[2], out[3], out[4], out[5] = first + x, log, sum_x, sum_xx, first + low, first + high


@njit(cache=True)
def _adaptive_orbit(p, phasors, durations, v, share, accuracy, tables, out):
    scale = p[6] * p[5] * p[2]
    for lap in range(_LAPS):
        _adaptive_lap(p, phasors, durations, v, share * scale, tables, out)
        out[6] = v
        scale = max(abs(out[4]), abs(out[5]))
        gain = out[0] - v
        if abs(gain) <= accuracy * scale:
            return lap + 1
        v += gain / max(1.0 - math.exp(out[1]), 1e-6)
    return -1


def adaptive(point: Point, share: float, accuracy: float) -> Callable[[], Figures]:
    """Dormand and Prince's pair, a step off by no more than a share of the largest speed; Newton's method on laps."""

    def run() -> Figures:
        phasors, durations = point.regions()
        out = np.empty(7)
        laps = _adaptive_orbit(point.p, phasors, durations, 0.0, share, 0.1 * accuracy, (_C, _A, _E), out)
        return _figures(out, durations.sum(), laps)

    return run


# --- LSODA with a right-hand side that Numba has compiled ------------------------------------------


@njit(cache=True)
def _rates(p, z, tau, v, at):
    _surface(p, z, tau, at)
    f, _, _ = _friction(at, v)
    return p[10] * f - p[11]


def scipy_lap(point: Point, start: float, tolerance: float) -> Callable[[], Figures]:
    """SciPy's ``odeint`` over one lap from the orbit's start, which it would have to find: the mean speed only."""
    from scipy.integrate import odeint

    top = float(point.p[6] * point.p[5] * point.p[2])

    def run() -> Figures:
        phasors, durations = point.regions()
        state, at = np.array([start, 0.0]), np.zeros(8)
        for z, end in zip(phasors, durations, strict=True):
            if end > 0:

                def rates(y: np.ndarray, tau: float, z: np.ndarray = z) -> tuple[float, float]:
                    return _rates(point.p, z, tau, y[0], at), y[0]

                longest = _TURN / point.p[2] / 20
                allowed = [tolerance * top, tolerance * top * durations.sum()]
                state = odeint(rates, state, [0.0, end], rtol=0.0, atol=allowed, hmax=longest, mxstep=10**6)[-1]
        return Figures(float(state[1] / durations.sum()))

    return run


# --- diffrax --------------------------------------------------------------------------------------


def diffrax_lap(points: list[Point], starts: list[float], tolerance: float) -> Callable[[], list[float]]:
    """Tsit5 of diffrax over one lap of every point, compiled and vectorised by JAX; mean speeds."""
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", val=True)
    p = jnp.array([point.p for point in points])
    states, lengths = (jnp.array(of) for of in zip(*(point.regions() for point in points), strict=True))

    def acceleration(p, z, tau, v):
        omega_d = p[0] * jnp.sqrt(1 - p[1] ** 2)
        rate = -p[1] * p[0] + 1j * omega_d
        turn, drive = jnp.exp(rate * tau), jnp.exp(1j * p[2] * tau)

        def phase(state, gate, begun):
            stopped = (p[2] * begun.imag + (rate * begun).real) / omega_d
            free, held = (state[0] + 1j * state[1]) * turn, 1j * stopped * turn
            w = free.real + gate * ((begun * (drive - turn)).real - held.real)
            speed = (begun * (1j * p[2] * drive - rate * turn)).real - (rate * held).real
            return w, (rate * free).real + gate * speed

        begun = p[5] * jnp.exp(1j * p[3])
        (w_a, v_a), (w_b, v_b) = phase(z[0:2], z[4], begun), phase(z[2:4], z[5], begun * 1j * p[4])
        height, fastest = jnp.hypot(w_a, w_b), p[6] * jnp.hypot(v_a, v_b)
        tilted = (w_b + 1j * w_a) * (v_a + 1j * v_b)
        tilt = jnp.arctan2(tilted.imag, tilted.real)
        y = p[7] / height
        inside = jnp.minimum(y, 3.1)
        theta = jnp.minimum(jnp.cbrt(3 * inside), 3.0)
        for _ in range(8):
            theta -= (jnp.sin(theta) - theta * jnp.cos(theta) - inside) / (theta * jnp.sin(theta))
            theta = jnp.clip(theta, 1e-6, 3.1415)
        alpha = jnp.arccos(jnp.clip(v / fastest, -1.0, 1.0))
        mass = 0.0
        for j in (-1, 0, 1):
            begin = jnp.maximum(-theta, -tilt - alpha + _TURN * j)
            end = jnp.minimum(theta, -tilt + alpha + _TURN * j)
            middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
            part = 0.5 / y * (2 * jnp.cos(middle) * jnp.sin(half) - jnp.cos(theta) * 2 * half)
            mass += jnp.where(end > begin, part, 0.0)
        return p[10] * (2 * mass - 1) - p[11]

    def rates(tau, y, given):
        p, z = given
        return jnp.array([acceleration(p, z, tau, y[0]), y[0]])

    def lap(p, states, lengths, start):
        whole, y = lengths.sum(), jnp.array([start, 0.0])
        top, longest = p[6] * p[5] * p[2], _TURN / p[2] / 20
        control = diffrax.PIDController(rtol=0.0, atol=jnp.array([1.0, whole]) * tolerance * top, dtmax=longest)
        for z, end in zip(states, lengths, strict=True):
            found = diffrax.diffeqsolve(
                diffrax.ODETerm(rates), diffrax.Tsit5(), 0.0, end, longest / 5, y, (p, z),
                stepsize_controller=control, saveat=diffrax.SaveAt(t1=True), max_steps=10**6,
            )  # fmt: skip
            y = found.ys[0]
        return y[1] / whole

    compiled = jax.jit(jax.vmap(lap))
    begun = jnp.array(starts)
    return lambda: np.asarray(compiled(p, states, lengths, begun)).tolist()
