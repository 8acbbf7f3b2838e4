"""The rotor's orbit a third way, fast enough for tens of thousands of points, without the package's models.

Phases are complex amplitudes of a decaying and a steady rotation.  Friction is the pressure's mass on the arc of the
wave that is faster than the rotor.  The speed is integrated by Radau's collocation with five nodes (order 9), which
damps a light rotor's stiff motions, in steps that shrink by themselves where friction has a root or a kink in time:
no event is located.  A brief touch of rotor and surface is looked for between the nodes.  Extremes are the ends of
steps that are shortened until the torques balance there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.polynomial import polynomial as poly

__all__ = ["Orbit", "constants", "held", "orbit"]

_TURN = 2 * math.pi
_S = 5


def _radau() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes, integrals up to each node, and weights of the difference to the quadrature that lacks the last node."""
    # right Radau nodes: d^(s-1)/dx^(s-1) of x^(s-1) (x - 1)^s
    of = poly.polymul(poly.polypow([0.0, 1.0], _S - 1), poly.polypow([-1.0, 1.0], _S))
    base = poly.polyder(of, _S - 1)
    c = np.sort(poly.polyroots(base).real)
    for _ in range(3):
        c -= poly.polyval(c, base) / poly.polyval(c, poly.polyder(base))
    c[-1] = 1.0
    powers = np.vander(c, _S, increasing=True)
    upto = np.array([[x ** (k + 1) / (k + 1) for k in range(_S)] for x in c])
    a = upto @ np.linalg.inv(powers)
    early = np.concatenate([[0.0], c[:-1]])
    weights = np.linalg.solve(np.vander(early, _S, increasing=True).T, 1.0 / np.arange(1, _S + 1))
    e = np.zeros(_S + 1)
    e[1:] = a[-1]
    e[:_S] -= weights
    return c, a, e


_C, _A, _E = _radau()
_TO_POWERS = np.linalg.inv(np.vander(np.concatenate([[0.0], _C]), _S + 1, increasing=True))


@dataclass(frozen=True)
class Orbit:
    """Speeds of the rim in m/s; ``doubt`` is what they may be off by."""

    start: float
    mean: float
    low: float
    high: float
    deviation: float
    doubt: float
    laps: int


@njit(cache=True, inline="always")
def _half_angle(y, guess):
    """Theta of sin theta - theta cos theta = y."""
    if y >= math.pi:
        return math.pi
    low, high, x = 0.0, math.pi, guess
    for _ in range(100):
        s, c = math.sin(x), math.cos(x)
        r = s - x * c - y
        if r > 0:
            high = x
        else:
            low = x
        slope = x * s
        new = x - r / slope if slope > 0 else -1.0
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - x) <= 1e-15 * x:
            return new
        x = new
    return x


@njit(cache=True)
def _phase(re, im, gate, begun, turn, drive, excess, rate, omega_q):
    """Displacement and velocity of a phase: from its state at the region's start, and from its drive."""
    stopped = (omega_q * begun.imag + (rate * begun).real) / rate.imag  # i times it has the velocity of the excess
    free = complex(re, im) * turn
    held = complex(0.0, stopped) * turn
    w = free.real + gate * ((begun * excess).real - held.real)
    v = (rate * free).real + gate * ((begun * (complex(0.0, omega_q) * drive - rate * turn)).real - (rate * held).real)
    return w, v


@njit(cache=True)
def _surface(p, z, tau, out):
    """Fastest speed R, tilt, theta, weight, constant, even share, height of the wave at a time in a region.

    p: 0 omega_n, 1 xi, 2 omega_q, 3 psi, 4 s, 5 W, 6 D k, 7 F_c k/(2 n_j k_N), 8 Hertz's theta sqrt(W_c), 9 Hertz?,
    10 push, 11 drag.  z: states of A and B at the region's start as phasors of free motion (re, im), gates.

    What the drive makes of a phase at rest is W (exp(i omega_q tau) - exp(lambda tau)) and the free motion that stops
    it at first; the difference is taken by exp(x) - 1, as it is small after a start from rest.
    """
    omega_d = p[0] * math.sqrt(1 - p[1] * p[1])
    decay = math.exp(-p[1] * p[0] * tau)
    turn = decay * complex(math.cos(omega_d * tau), math.sin(omega_d * tau))
    rate = complex(-p[1] * p[0], omega_d)
    drive = complex(math.cos(p[2] * tau), math.sin(p[2] * tau))
    x, y = p[1] * p[0] * tau, (p[2] - omega_d) * tau
    excess = turn * complex(math.expm1(x) * math.cos(y) - 2 * math.sin(0.5 * y) ** 2, math.exp(x) * math.sin(y))
    begun = p[5] * complex(math.cos(p[3]), math.sin(p[3]))
    w_a, v_a = _phase(z[0], z[1], z[4], begun, turn, drive, excess, rate, p[2])
    w_b, v_b = _phase(z[2], z[3], z[5], begun * complex(0.0, p[4]), turn, drive, excess, rate, p[2])
    height = math.hypot(w_a, w_b)
    fastest = p[6] * math.hypot(v_a, v_b)
    tilted = complex(w_b, w_a) * complex(v_a, v_b)
    tilt = math.atan2(tilted.imag, tilted.real)
    if p[9] > 0.5:
        theta = min(math.pi, p[8] / math.sqrt(height)) if height > 0 else math.pi
        weight = 0.5 / (math.sin(theta) - theta * math.cos(theta))
        constant, even = -math.cos(theta), 0.0
    else:
        y = p[7] / height if height > 0 else math.inf
        if y < math.pi:
            guess = out[2] if 0 < out[2] < math.pi else min((3 * y) ** (1 / 3), 3.0)
            theta = _half_angle(y, guess)
            weight = 0.5 / y
            constant, even = -math.cos(theta), 0.0
        else:
            theta, weight, constant, even = math.pi, 0.5 * height / p[7], 0.0, 0.5 / math.pi
    out[0], out[1], out[2], out[3], out[4], out[5], out[6] = fastest, tilt, theta, weight, constant, even, height


@njit(cache=True)
def _friction(at, v):
    """Net friction fraction at rim speed v, its slope, and by how much saturated friction is short of ending (m/s)."""
    fastest, tilt, theta, weight, constant, even = at[0], at[1], at[2], at[3], at[4], at[5]
    ratio = v / fastest if fastest > 0 else (math.inf if v > 0 else -math.inf)
    if ratio >= 1.0:
        off = abs(tilt) - theta
        return -1.0, 0.0, fastest * (math.cos(off) if off > 0 else 1.0) - v
    if ratio <= -1.0:
        off = math.pi - abs(tilt) - theta
        return 1.0, 0.0, fastest * (math.cos(off) if off > 0 else 1.0) + v
    alpha = math.acos(ratio)
    mass = 0.0
    for j in range(-1, 2):
        begin, end = max(-theta, -tilt - alpha + _TURN * j), min(theta, -tilt + alpha + _TURN * j)
        if end > begin:
            middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
            mass += weight * (2 * math.cos(middle) * math.sin(half) + constant * 2 * half) + even * 2 * half
    slope = 0.0
    for side in (-1.0, 1.0):
        u = side * alpha - tilt
        u -= _TURN * math.floor((u + math.pi) / _TURN)
        if abs(u) < theta:
            slope += weight * (math.cos(u) + constant) + even
    root = fastest * math.sin(alpha)
    slope = -2 * slope / root if root > 0 else 0.0
    short = 1.0
    if mass <= 0.0:
        mass, off = 0.0, abs(tilt) - theta
        short = fastest * (math.cos(off) if off > 0 else 1.0) - v
    elif slope == 0.0 and mass > 0.5:
        mass, off = 1.0, math.pi - abs(tilt) - theta
        short = fastest * (math.cos(off) if off > 0 else 1.0) + v
    return 2 * mass - 1, slope, short


@njit(cache=True)
def _solve(m, b):
    """Gaussian elimination in place."""
    n = b.size
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(m[i, k]) > abs(m[best, k]):
                best = i
        if best != k:
            for j in range(n):
                m[k, j], m[best, j] = m[best, j], m[k, j]
            b[k], b[best] = b[best], b[k]
        for i in range(k + 1, n):
            q = m[i, k] / m[k, k]
            for j in range(k + 1, n):
                m[i, j] -= q * m[k, j]
            b[i] -= q * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= m[k, j] * b[j]
        b[k] /= m[k, k]


@njit(cache=True)
def _step(c, a, p, z, tau, v0, x, force, h, at, xs, fs, slopes, work):
    """Radau's step: deviations of speed xs, accelerations fs and friction's slopes at the nodes; whether it closed."""
    matrix, right = work
    for i in range(_S):
        if i > 0:
            at[i, 2] = at[i - 1, 2]
        _surface(p, z, tau + c[i] * h, at[i])
        xs[i] = x + c[i] * h * force
    closed = False
    before = math.inf
    for tries in range(60):
        for i in range(_S):
            f, slope, short = _friction(at[i], v0 + xs[i])
            fs[i] = p[10] * f - p[11]
            at[i, 7] = short if slope == 0.0 else 1.0
            # beside a square root Newton would jump to and fro: saturated friction keeps half of the slope before
            slopes[i] = 0.5 * slopes[i] if slope == 0.0 and tries > 2 else p[10] * slope
        for i in range(_S):
            right[i] = x - xs[i]
            for j in range(_S):
                right[i] += h * a[i, j] * fs[j]
                matrix[i, j] = -h * a[i, j] * slopes[j]
            matrix[i, i] += 1.0
        _solve(matrix, right)
        change = 0.0
        damp = 1.0 if tries < 8 else (0.5 if tries < 20 else 0.2)
        for i in range(_S):
            reach = 1.001 * c[i] * h * (p[10] + abs(p[11]))
            new = min(x + reach, max(x - reach, xs[i] + damp * right[i]))
            change = max(change, abs(new - xs[i]))
            xs[i] = new
        size = abs(v0) + abs(x) + h * (p[10] + abs(p[11]))
        if change <= 2e-15 * size or (tries > 3 and change <= 1e-13 * size and change >= 0.5 * before):
            closed = True
            break
        before = change
    for i in range(_S):
        f, slope, short = _friction(at[i], v0 + xs[i])
        fs[i] = p[10] * f - p[11]
        slopes[i] = p[10] * slope
    return closed


@njit(cache=True)
def _turned(at, tilt):
    """The largest turn of the surface's motion from node to node."""
    turned = 0.0
    for i in range(_S):
        off = at[i, 1] - tilt
        turned = max(turned, abs(off - _TURN * round(off / _TURN)))
        tilt = at[i, 1]
    return turned


@njit(cache=True)
def _hides_an_end(c, at, begin_short, coarse):
    """Whether saturated friction may end for a moment between nodes at which it is saturated."""
    best = 0
    for i in range(_S):
        if at[i, 7] > 0.0:
            return False
        if at[i, 7] > at[best, 7]:
            best = i
    if best == _S - 1:
        return False
    t0, g0 = (0.0, begin_short) if best == 0 else (c[best - 1], at[best - 1, 7])
    t1, g1 = c[best], at[best, 7]
    t2, g2 = c[best + 1], at[best + 1, 7]
    d01, d12 = (g1 - g0) / (t1 - t0), (g2 - g1) / (t2 - t1)
    bend = (d12 - d01) / (t2 - t0)
    if bend >= 0:
        return False
    rise = max(abs(d01), abs(d12)) * (t2 - t0)
    if g1 + rise > 0 and coarse:
        return True
    vertex = 0.5 * (t0 + t1) - 0.5 * d01 / bend
    top = g0 + (vertex - t0) * (d01 + bend * (vertex - t1))
    return t0 < vertex < t2 and top > -1e-3 * rise


@njit(cache=True)
def _embedded(e, values, first, mean, smooth):
    """The embedded formula's estimate of a step's error in the mean of some values, over the step; unless these are
    smooth the better formula is taken to be no better."""
    total, reference = 0.0, abs(mean)
    for i in range(_S):
        total += e[i + 1] * (values[i] - first)
        reference = max(reference, abs(values[i] - first - mean))
    return abs(total) * (min(1.0, abs(total) / (reference + 1e-300)) ** 0.6 if smooth else 1.0)


@njit(cache=True)
def _step_error(a, e, p, at, fs, slopes, force, begin_theta, step, push_only):
    """Estimate of a step's error of the speed; if the contact is asked for, too, of theta as if it pushed."""
    mean, damped, saturated = 0.0, 0.0, 0
    for i in range(_S):
        saturated += slopes[i] == 0.0
        mean += a[_S - 1, i] * (fs[i] - force)
        damped -= step * a[_S - 1, i] * slopes[i]
    error = step * _embedded(e, fs, force, mean, saturated in (0, _S)) / (1.0 + damped)
    if push_only:
        error = max(error, step * _embedded(e, at[:, 2], begin_theta, 0.0, True) * p[10] / math.pi)
    return error


@njit(cache=True)
def _balanced(c, a, p, z, tau, v0, x, force, ends, at, work):
    """The speed where the acceleration changes its sign within a step, between (time, acceleration) and another."""
    left, fl, right, fr = ends
    xt, ft, st = np.empty(_S), np.empty(_S), np.empty(_S)
    inner, best, end = at.copy(), x, right
    for _ in range(40):
        place = (left * fr - right * fl) / (fr - fl)
        if not left < place < right:
            place = 0.5 * (left + right)
        _step(c, a, p, z, tau, v0, x, force, place, inner, xt, ft, st, work)
        best, fm = xt[_S - 1], ft[_S - 1]
        if abs(fm) <= 1e-9 * p[10] or right - left <= 1e-12 * end:
            break
        if (fm > 0) == (fl > 0):
            left, fl, fr = place, fm, 0.5 * fr
        else:
            right, fr, fl = place, fm, 0.5 * fl
    return best


@njit(cache=True)
def _extremes(c, a, p, z, tau, v0, x, force, step, at, xs, fs, work, low, high):
    """Lowest and highest speed so far: at steps' ends, and where the torques balance."""
    before, at_before = force, 0.0
    for i in range(_S):
        if (before > 0) != (fs[i] > 0):
            ends = (at_before * step, before, c[i] * step, fs[i])
            best = _balanced(c, a, p, z, tau, v0, x, force, ends, at, work)
            low, high = min(low, best), max(high, best)
        before, at_before = fs[i], c[i]
    return min(low, xs[_S - 1]), max(high, xs[_S - 1])


@njit(cache=True)
def _integrate(to_powers, x, xs, step, record):
    """Adds the integrals of a step's interpolant and of its square."""
    q = np.empty(_S + 1)
    for k in range(_S + 1):
        q[k] = to_powers[k, 0] * x
        for i in range(_S):
            q[k] += to_powers[k, i + 1] * xs[i]
    for k in range(_S + 1):
        record[2] += step * q[k] / (k + 1)
        for j in range(_S + 1):
            record[3] += step * q[k] * q[j] / (k + j + 1)


@njit(cache=True)
def _region(c, a, e, to_powers, p, z, end, v0, allowed, push_only, h, most, record):
    """A region of a lap, from the state in the record; the next step's length, or 0 if it needs too many steps."""
    period = _TURN / p[2]
    longest, shortest = period / 160, 1e-15 * period
    at, one = np.zeros((_S, 8)), np.zeros(8)
    xs, fs, slopes = np.empty(_S), np.empty(_S), np.empty(_S)
    work = (np.empty((_S, _S)), np.empty(_S))
    x = record[0]
    _surface(p, z, 0.0, one)
    f, slope, short = _friction(one, v0 + x)
    force, tau = p[10] * f - p[11], 0.0
    begin_short, begin_tilt, begin_theta = short if slope == 0.0 else 1.0, one[1], one[2]
    while tau < end:
        record[9] += 1
        if record[9] > most:
            return 0.0
        last = tau + h * 1.0000001 >= end
        step = end - tau if last else h
        at[0, 2] = begin_theta
        if not _step(c, a, p, z, tau, v0, x, force, step, at, xs, fs, slopes, work) and step > shortest:
            h = 0.3 * step
            continue
        if step > 1e-6 * period and _turned(at, begin_tilt) > 0.3:
            h = 0.5 * step
            continue
        if step > 1e-7 * period and begin_short <= 0.0 and _hides_an_end(c, at, begin_short, step > period / 2000):
            h = 0.4 * step
            continue
        error = _step_error(a, e, p, at, fs, slopes, force, begin_theta, step, push_only)
        ratio = error / max(allowed, 1e-15 * p[10] * step)
        if ratio > 1.0 and step > shortest:
            h = step * max(0.15, 0.8 * ratio ** (-1 / 8))
            continue
        record[4], record[5] = _extremes(c, a, p, z, tau, v0, x, force, step, at, xs, fs, work, record[4], record[5])
        _integrate(to_powers, x, xs, step, record)
        for i in range(_S):
            record[1] += step * a[_S - 1, i] * slopes[i]
            record[6] += step * a[_S - 1, i] * (fs[i] + p[11]) / p[10]
            record[7] += step * a[_S - 1, i] * at[i, 2]
        record[8] += error
        x, force = xs[_S - 1], fs[_S - 1]
        begin_short, begin_tilt, begin_theta = at[_S - 1, 7], at[_S - 1, 1], at[_S - 1, 2]
        tau = end if last else tau + step
        h = min(longest, step * min(4.0, max(0.3, 0.8 * (ratio + 1e-12) ** (-1 / 8))))
    record[0] = x
    return h


@njit(cache=True)
def _lap(c, a, e, to_powers, p, phasors, durations, v0, allowed, push_only, record):
    """A lap from rim speed v0.  record: gain, ln of the slope of the lap map, integrals of x and x^2, lowest, highest,
    integrals of friction and theta, steps' errors, steps; x counts from v0."""
    period = _TURN / p[2]
    record[:] = 0.0
    h, most = period / 320, 100_000 * durations.sum() / period
    for r in range(3):
        if durations[r] > 0:
            h = _region(c, a, e, to_powers, p, phasors[r], durations[r], v0, allowed, push_only, h, most, record)
            if h == 0.0:
                return False
    return True


@njit(cache=True)
def _phasors(p, m, n, start):
    """States of A and B as phasors of free motion, with their gates, at the start of the regions.

    start: 0 steady, 1 rest, 2 periodic.
    """
    omega_d = p[0] * math.sqrt(1 - p[1] * p[1])
    gates = ((0.0, 1.0, 1.0), (1.0, 0.0, 1.0))
    pulses = (m - n, m - n, 2 * n - m)
    out = np.zeros((3, 6))
    for phase in range(2):
        angle = p[3] + phase * p[4] * 0.5 * math.pi
        shown, speed = p[5] * math.cos(angle), -p[5] * p[2] * math.sin(angle)
        steady = complex(shown, -(speed + p[1] * p[0] * shown) / omega_d)  # a free motion in the steady one's state
        g = gates[phase]
        turns = [complex(0.0), complex(0.0), complex(0.0)]
        for r in range(3):
            t = pulses[r] * _TURN / p[2]
            decay = math.exp(-p[1] * p[0] * t)
            turns[r] = decay * complex(math.cos(omega_d * t), math.sin(omega_d * t))
        if start == 0:
            first = (1.0 - g[0]) * steady
        elif start == 1:
            first = -g[0] * steady
        else:  # z repeats: z = turn z + jumps
            through, whole = complex(0.0), complex(1.0)
            for r in range(3):
                after = g[(r + 1) % 3]
                through = through * turns[r] + (g[r] - after) * steady
                whole *= turns[r]
            first = through / (1.0 - whole)
        z = first
        for r in range(3):
            state = z + g[r] * steady
            out[r, 2 * phase], out[r, 2 * phase + 1], out[r, 4 + phase] = state.real, state.imag, g[r]
            if r < 2:
                z = z * turns[r] + (g[r] - g[r + 1]) * steady
    return out


@njit(cache=True)
def _search(c, a, e, to_powers, p, m, n, start, guess, accuracy, out):
    """The orbit; out: start, mean, low, high, deviation, doubt, laps."""
    phasors = _phasors(p, m, n, start)
    period = _TURN / p[2]
    durations = np.array([(m - n) * period, (m - n) * period, (2 * n - m) * period])
    whole = m * period
    bound = 10.0 * p[6] * p[5] * max(p[0], p[2]) + 2 * (p[10] + abs(p[11])) * whole
    low, high, v = -bound, bound, guess
    r = np.empty(10)
    level, scale = 1e-4, min(p[6] * p[5] * p[2], p[10] * whole)
    gain_low, gain_high, laps, halve = math.nan, math.nan, 0, False
    pull, polished, last, before = 1.0, 0, math.inf, (math.inf, math.inf)
    while laps < 120:
        allowed = level * scale / (60.0 * m)
        if not _lap(c, a, e, to_powers, p, phasors, durations, v, allowed, 0, r):
            return False
        laps += 1
        gain, errors = r[0], r[8]
        pull = max(-math.expm1(r[1]), 1e-13)
        top = max(abs(v + r[4]), abs(v + r[5]))
        fine = level <= accuracy * 1.01
        noise = (errors + 2e-15 * top) / pull
        if abs(gain) > 4 * errors:
            if gain > 0:
                low, gain_low = v, gain
            else:
                high, gain_high = v, gain
        if fine and abs(gain - before[1]) > 1e3 * errors and abs(v - before[0]) > 1e-13 * top:
            pull = min(1.0, max(-(gain - before[1]) / (v - before[0]), 1e-13))
        before = (v, gain)
        new = v + gain / pull
        if not low < new < high or abs(new - v) > 0.5 * last:
            share = 0.5 if halve or math.isnan(gain_low) or math.isnan(gain_high) else gain_low / (gain_low - gain_high)
            new = low + share * (high - low)
            halve = not halve
        away = abs(new - v)
        last = away
        close = away <= accuracy * top or abs(gain) <= 2 * errors or high - low <= 1e-15 * top
        if fine and close:
            polished = 1
            break
        if away <= max(1e-4 * top, 2 * noise) and not fine:
            level = max(accuracy, min(0.01 * level, 1e-6 * level if laps > 60 else level))
            level = accuracy
            low, high, gain_low, gain_high, last = -bound, bound, math.nan, math.nan, math.inf
            before = (math.inf, math.inf)
        scale = max(min(top, p[10] * whole), 1e-300) * max(pull, 1e-7)
        v = new
    mean, square = r[2] / whole, r[3] / whole
    out[0], out[1], out[2], out[3] = v, v + mean, v + r[4], v + r[5]
    out[4], out[5], out[6] = math.sqrt(max(0.0, square - mean * mean)), away + noise, laps
    return polished == 1


@njit(cache=True)
def _held(c, a, e, to_powers, p, m, n, start, accuracy, out):
    phasors = _phasors(p, m, n, start)
    period = _TURN / p[2]
    durations = np.array([(m - n) * period, (m - n) * period, (2 * n - m) * period])
    q = p.copy()
    q[10], q[11] = 1e-290, 0.0
    r = np.empty(10)
    ok = _lap(c, a, e, to_powers, q, phasors, durations, 0.0, accuracy * 1e-290 * period / 60.0, 1, r)
    out[0], out[1] = r[6] / (m * period), r[7] / (m * period) / math.pi
    return ok


def half_angle(y: float) -> float:
    """Theta of sin theta - theta cos theta = y."""
    return float(_half_angle(y, min((3 * y) ** (1 / 3), 3.0)))


def orbit(p: np.ndarray, m: int, n: int, start: int, guess: float = 0.0, accuracy: float = 1e-12) -> Orbit | None:
    """The orbit of constants p; None if it was not found."""
    out = np.empty(7)
    found = _search(_C, _A, _E, _TO_POWERS, p, m, n, start, guess, accuracy, out)
    return Orbit(*out[:6], int(out[6])) if found else None


def held(p: np.ndarray, m: int, n: int, start: int, accuracy: float = 1e-12) -> tuple[float, float, float]:
    """Mean friction fraction on a rotor at rest, mean of theta/pi, and the accuracy that was reached."""
    out = np.empty(2)
    while not _held(_C, _A, _E, _TO_POWERS, p, m, n, start, accuracy, out):
        accuracy *= 10.0  # too many steps, at a wave that begins from rest
    return float(out[0]), float(out[1]), accuracy


def constants(
    motor: dict[str, np.ndarray], drive: dict[str, np.ndarray], stator: dict[str, np.ndarray], contact: str
) -> np.ndarray:
    """Rows of constants, from the values of motors and drives and from what the product says of their stators."""
    force, crests = np.asarray(drive["prepressure"], float), motor["crests"]
    k, W = stator["wavenumber"], stator["amplitude"]
    f_n, f_q = stator["resonance_frequency"], stator["resonance_frequency"] + drive["frequency_difference"]
    layer = motor["layer_young_modulus"] * motor["layer_width"] / motor["layer_thickness"]
    thickness = (1 - motor["tooth_height"] / motor["beam_thickness"]) ** 3
    compliance = (1 - motor["beam_poisson_ratio"] ** 2) / (thickness * motor["beam_young_modulus"])
    compliance = compliance + (1 - motor["layer_poisson_ratio"] ** 2) / motor["layer_young_modulus"]
    curvature = 2 * motor["curvature_radius"] ** 2 / crests**2
    width = 1.6 * np.sqrt(force * curvature * compliance / (crests * motor["layer_width"]))
    radius = motor["contact_radius"]
    columns = [
        _TURN * f_n,
        motor["damping_ratio"],
        _TURN * f_q,
        drive["switching_phase"],
        drive["phase_lead"],
        W,
        stator["neutral_axis"] * k,
        force * k / (2 * crests * layer),
        k * width / 2,
        float(contact == "hertz"),
        radius**2 * motor["friction_coefficient"] * force / motor["rotor_inertia"],
        radius * drive["load_torque"] / motor["rotor_inertia"],
    ]
    return np.stack(np.broadcast_arrays(*(np.asarray(column, float) for column in columns)), axis=-1)
