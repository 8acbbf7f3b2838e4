"""The rotor's orbit, found a second way: nothing here imports the derivations or the kernels.

Phases: the 2x2 state-space matrix of an oscillator, its matrix exponential, gates from the paper's definition of the
three regions.  Contact: the layer's balance solved in a bracket at every evaluation.  Friction: the contact zone is cut
at the points that are as fast as the rotor, and each piece counts with the sign of the surface's speed past it.
Rotor: Dormand and Prince's explicit method of order 8 with its error per step held far below the product's, which
shortens the steps by itself where the friction has a square root in time; extremes by a step that ends where the
acceleration vanishes.  Orbit: bracketed secant on the lap map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.integrate import DOP853
from scipy.linalg import expm

GATES = np.array([[0.0, 1.0], [1.0, 0.0], [1.0, 1.0]])  # (A, B) in T_redu, T_addredu, T_add

_STAGES = DOP853.n_stages
_TABLE = (DOP853.A, DOP853.B, DOP853.C, DOP853.E3, DOP853.E5)
_SAMPLES = 8  # of a step, in search of events
_MOST_STEPS = 2_000_000  # in a cycle
_SIZE = 5  # deviation of speed, its integral, its square's, work of the surface, heat
_TURN = 2 * np.pi


@dataclass(frozen=True)
class ReferenceOrbit:
    """Rotor speeds in rad/s, powers in W, all over one cycle; ``start`` is the speed at t1."""

    start: float
    mean: float
    low: float
    high: float
    deviation: float
    surface_power: float
    heat: float
    laps: int
    steps: int

    @property
    def volatility(self) -> float:
        return self.deviation / abs(self.mean)

    @property
    def largest(self) -> float:
        return max(abs(self.low), abs(self.high))


@njit(cache=True)
def _half_angle(y):
    """Theta of sin theta - theta cos theta = y by Newton, with halving wherever it leaves its bracket."""
    if y >= math.pi:
        return math.pi
    low, high = 0.0, math.pi
    x = min((3 * y) ** (1 / 3), 3.0)
    for _ in range(80):
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
        if abs(new - x) <= 2e-16 * x or high - low <= 2e-16 * high:
            return new
        x = new
    return x


@njit(cache=True)
def modal(p, y, gates, tau):
    """w_A, w_B, w_A', w_B' at a time after the region's start; y holds the states there."""
    omega, xi, omega_q, psi, s, W = p[0], p[1], p[2], p[3], p[4], p[5]
    omega_d = omega * math.sqrt(1 - xi * xi)
    decay = math.exp(-xi * omega * tau)
    c, sn = decay * math.cos(omega_d * tau), decay * math.sin(omega_d * tau) / omega_d
    # exp(M tau) = decay (cos I + sin/omega_d (M + xi omega I)) of M = [[0, 1], [-omega^2, -2 xi omega]]
    e00, e01, e10, e11 = c + xi * omega * sn, sn, -omega * omega * sn, c - xi * omega * sn
    out = np.empty(4)
    for i in range(2):
        phase = psi + (s * 0.5 * math.pi if i == 1 else 0.0)
        w0, v0 = gates[i] * W * math.cos(phase), -gates[i] * W * omega_q * math.sin(phase)
        angle = omega_q * tau + phase
        w1, v1 = gates[i] * W * math.cos(angle), -gates[i] * W * omega_q * math.sin(angle)
        a, b = y[2 * i] - w0, y[2 * i + 1] - v0
        out[i] = w1 + e00 * a + e01 * b
        out[2 + i] = v1 + e10 * a + e11 * b
    return out


@njit(cache=True)
def half_angle(p, height):
    """Contact half-angle theta at a wave height; p[7] is F_c k / (2 n_j k_N), p[8] Hertz's theta times sqrt(height)."""
    if p[9] > 0.5:
        return min(math.pi, p[8] / math.sqrt(height)) if height > 0 else math.pi
    return _half_angle(p[7] / height) if height > 0 else math.pi


@njit(cache=True)
def surface(p, w, v):
    """Net friction fraction at rim speed v, share of p that does work on the surface (m/s), of heat (m/s).

    The pressure's share at u from the crest is (cos u + constant)/(2 norm); the surface there moves with
    D k (w_A' cos kx - w_B' sin kx), kx = crest + u.
    """
    height = math.hypot(w[0], w[1])
    crest = math.atan2(w[0], w[1])
    fastest, lag = p[6] * math.hypot(w[2], w[3]), math.atan2(w[3], w[2])
    theta = half_angle(p, height)
    tilt = crest + lag  # speed = fastest cos(u + tilt)
    if theta < math.pi:
        constant = -math.cos(theta)
        weight = 0.5 / (math.sin(theta) - theta * math.cos(theta))
        even = 0.0
    elif p[9] > 0.5 or height <= 0:
        weight, constant, even = 0.5 / math.pi, 1.0, 0.0
        if height <= 0:
            weight, even = 0.0, 0.5 / math.pi
    else:
        weight, constant, even = 0.5 * height / p[7], 0.0, 0.5 / math.pi
    cuts = np.empty(4)
    cuts[0] = -theta
    n = 1
    if abs(v) < fastest:
        alpha = math.acos(v / fastest)
        for sign in (-1.0, 1.0):
            u = sign * alpha - tilt
            u -= _TURN * math.floor((u + math.pi) / _TURN)
            if -theta < u < theta:
                cuts[n] = u
                n += 1
    if n == 3 and cuts[1] > cuts[2]:
        cuts[1], cuts[2] = cuts[2], cuts[1]
    cuts[n] = theta
    ct, st = math.cos(tilt), math.sin(tilt)
    net = work = heat = 0.0
    for i in range(n):
        a, b = cuts[i], cuts[i + 1]
        past = fastest * math.cos(0.5 * (a + b) + tilt) - v
        sign = 1.0 if past > 0 else (-1.0 if past < 0 else 0.0)
        sa, sb, ca, cb = math.sin(a), math.sin(b), math.cos(a), math.cos(b)
        share = weight * (sb - sa + constant * (b - a)) + even * (b - a)
        # integral of (weight (cos u + constant) + even) (cos u cos tilt - sin u sin tilt)
        flat = weight * constant + even
        along = weight * 0.5 * (b - a + sb * cb - sa * ca) + flat * (sb - sa)
        across = weight * 0.5 * (sb * sb - sa * sa) - flat * (cb - ca)
        moved = fastest * (ct * along - st * across)
        net += sign * share
        work += sign * moved
        heat += sign * (moved - v * share)
    return net, work, heat


@njit(cache=True)
def rate(p, y, gates, tau, v0, x, out):
    """d/dt of the state x = (v - v0, its integral, its square's, work, heat); p[10] push, p[11] drag."""
    w = modal(p, y, gates, tau)
    net, work, heat = surface(p, w, v0 + x[0])
    out[0] = p[10] * net - p[11]
    out[1] = x[0]
    out[2] = x[0] * x[0]
    out[3] = work
    out[4] = heat


@njit(cache=True)
def _step(table, p, y, gates, tau, v0, x, h, k, new):
    """One step; k[0] holds the rate at its start, k[12] gets that at its end."""
    a, b, nodes = table[0], table[1], table[2]
    trial = np.empty(_SIZE)
    for i in range(1, _STAGES):
        for c in range(_SIZE):
            total = 0.0
            for j in range(i):
                total += a[i, j] * k[j, c]
            trial[c] = x[c] + h * total
        rate(p, y, gates, tau + nodes[i] * h, v0, trial, k[i])
    for c in range(_SIZE):
        total = 0.0
        for j in range(_STAGES):
            total += b[j] * k[j, c]
        new[c] = x[c] + h * total
    rate(p, y, gates, tau + h, v0, new, k[_STAGES])


@njit(cache=True)
def _turning(table, p, y, gates, tau, v0, x, h, k, slope0, slope1):
    """Deviation of speed where its rate vanishes within a step, by secant on shorter steps from its start."""
    inner, new = k.copy(), np.empty(_SIZE)
    a, fa, b, fb = 0.0, slope0, h, slope1
    best = x[0]
    for _ in range(30):
        at = (a * fb - b * fa) / (fb - fa)
        if not min(a, b) < at < max(a, b):
            at = 0.5 * (a + b)
        _step(table, p, y, gates, tau, v0, x, at, inner, new)
        best = new[0]
        f = inner[_STAGES, 0]
        if abs(f) <= 1e-7 * (abs(slope0) + abs(slope1)):
            break
        if (f > 0) == (fa > 0):
            a, fa, fb = at, f, 0.5 * fb
        else:
            b, fb, fa = at, f, 0.5 * fa
    return best


@njit(cache=True)
def _event(p, y, gates, tau, v, kind):
    """What changes its sign where friction changes its form.

    0: by how much the fastest point in contact is ahead of the rotor, in the rotor's direction; friction is saturated
    where it is not.  1: growth of the wave; where it begins to grow anew the crest may sweep past in no time.  A plain
    travelling wave does not grow, up to rounding: hence the threshold.
    """
    w = modal(p, y, gates, tau)
    if kind == 1:
        return w[0] * w[2] + w[1] * w[3] - 1e-6 * p[5] ** 2 * p[0]
    fastest = p[6] * math.hypot(w[2], w[3])
    off = math.atan2(w[0], w[1]) + math.atan2(w[3], w[2]) + (math.pi if v < 0 else 0.0)
    off = abs(off - _TURN * round(off / _TURN))
    return fastest * math.cos(max(0.0, off - half_angle(p, math.hypot(w[0], w[1])))) - abs(v)


@njit(cache=True)
def _cubic(x, new, k, h, at):
    """The deviation of speed within a step, from both its ends and their rates."""
    chord, r0, r1 = (new[0] - x[0]) / h, k[0, 0], k[_STAGES, 0]
    return x[0] + h * at * (r0 + at * ((3 * chord - 2 * r0 - r1) + at * (r0 + r1 - 2 * chord)))


@njit(cache=True)
def _first_event(p, y, gates, tau, v0, x, new, h, k):
    """The share of a step after which an event first changes its sign; 1 if none does.

    Samples see every change but a pair between two of them; a parabola through three looks for those.
    """
    share, value = np.empty(_SAMPLES + 1), np.empty(_SAMPLES + 1)
    first = 1.0
    for kind in range(2):
        for i in range(_SAMPLES + 1):
            share[i] = max(i / _SAMPLES, 1e-6)
            value[i] = _event(p, y, gates, tau + share[i] * h, v0 + _cubic(x, new, k, h, share[i]), kind)
        for i in range(_SAMPLES):
            a, b = share[i], 0.0
            if (value[i] > 0) != (value[i + 1] > 0):
                b = share[i + 1]
            elif kind == 0:
                for j in (i, i + 1):  # the parabola through three neighbours, its vertex in this interval
                    if 0 < j < _SAMPLES:
                        bend = value[j - 1] - 2 * value[j] + value[j + 1]
                        if bend != 0:
                            vertex = share[j] - 0.5 * (value[j + 1] - value[j - 1]) / bend / _SAMPLES
                            if share[i] < vertex < share[i + 1]:
                                there = v0 + _cubic(x, new, k, h, vertex)
                                if (_event(p, y, gates, tau + vertex * h, there, kind) > 0) != (value[i] > 0):
                                    b = vertex
            if b > 0:
                for _ in range(60):
                    middle = 0.5 * (a + b)
                    there = v0 + _cubic(x, new, k, h, middle)
                    if (_event(p, y, gates, tau + middle * h, there, kind) > 0) == (value[i] > 0):
                        a = middle
                    else:
                        b = middle
                first = min(first, b)
                break
    return first


@njit(cache=True)
def _lap(table, p, states, durations, gates, v0, scales, tolerance, longest):
    """State x after a cycle begun at rim speed v0, its lowest and highest deviation, the number of steps."""
    x, new = np.zeros(_SIZE), np.empty(_SIZE)
    k = np.empty((_STAGES + 1, _SIZE))
    low = high = 0.0
    steps = 0
    h = longest * 0.1
    for r in range(3):
        tau, end = 0.0, durations[r]
        if end <= 0:
            continue
        rate(p, states[r], gates[r], 0.0, v0, x, k[0])
        while tau < end:
            if steps > _MOST_STEPS:
                raise RuntimeError("the reference does not get on")
            last = tau + h * 1.0000001 >= end
            step = end - tau if last else h
            _step(table, p, states[r], gates[r], tau, v0, x, step, k, new)
            error = 0.0
            for c in range(3):  # work and heat follow
                e5 = e3 = 0.0
                for j in range(_STAGES + 1):
                    e5 += table[4][j] * k[j, c]
                    e3 += table[3][j] * k[j, c]
                e5, e3 = abs(e5) * step / scales[c], abs(e3) * step / scales[c]
                if e5 > 0:
                    error = max(error, e5 * e5 / math.sqrt(e5 * e5 + 0.01 * e3 * e3))
            steps += 1
            ratio = error / tolerance
            if step > 1e-7 * longest:
                share = _first_event(p, states[r], gates[r], tau, v0, x, new, step, k)
                if share < 1.0 - 1e-6:
                    h = max(share * step, 1e-7 * longest)
                    if ratio > 1.0:
                        h = min(h, step * max(0.2, 0.9 * ratio ** (-0.125)))
                    continue
            if ratio <= 1.0 or step < 1e-12 * longest:
                before, after = k[0, 0], k[_STAGES, 0]
                if (before > 0) != (after > 0):
                    turn = _turning(table, p, states[r], gates[r], tau, v0, x, step, k, before, after)
                    low, high = min(low, turn), max(high, turn)
                low, high = min(low, new[0]), max(high, new[0])
                tau = end if last else tau + step
                for c in range(_SIZE):
                    x[c] = new[c]
                    k[0, c] = k[_STAGES, c]
            h = min(longest, step * min(6.0, max(0.2, 0.9 * (ratio + 1e-12) ** (-0.125))))
    return x, low, high, steps


def _region_starts(p: np.ndarray, start: str, pulses: np.ndarray) -> np.ndarray:
    """States (w_A, w_A', w_B, w_B') at the start of every region, by SciPy's matrix exponential."""
    omega, xi, omega_q, psi, s, W = p[:6]
    matrix = np.array([[0.0, 1.0], [-(omega**2), -2 * xi * omega]])
    phases = psi + np.array([0.0, s * np.pi / 2])
    steady = np.stack([W * np.cos(phases), -W * omega_q * np.sin(phases)], axis=1)  # same at every switching
    moves = [expm(matrix * (pulse * _TURN / omega_q)) for pulse in pulses]

    def through(y: np.ndarray) -> list[np.ndarray]:
        seen = [y]
        for gate, move in zip(GATES, moves, strict=True):
            on = gate[:, None] * steady
            seen.append(on + (seen[-1] - on) @ move.T)
        return seen

    if start == "steady":
        first = steady
    elif start == "rest":
        first = np.zeros((2, 2))
    else:
        whole = moves[2] @ moves[1] @ moves[0]
        first = np.linalg.solve(np.eye(2) - whole, through(np.zeros((2, 2)))[-1].T).T
    return np.array([y.ravel() for y in through(first)[:-1]])


class Reference:
    """One point: a motor with scalar values, a drive with scalar fields, and what ``evaluate`` says of the stator.

    Of ``point`` only the stator's figures are used: resonance, amplitude, neutral axis, wavenumber.
    """

    def __init__(self, motor, drive, point, *, contact="winkler", tolerance=1e-13, longest=1 / 40):
        def value(name):
            return float(getattr(motor, name).value)

        self.radius = value("contact_radius")
        inertia, friction, force = value("rotor_inertia"), value("friction_coefficient"), float(drive.prepressure)
        f_q = float(point.resonance_frequency) + float(drive.frequency_difference)
        D, k, W = float(point.neutral_axis), float(point.wavenumber), float(point.amplitude)
        crests = value("crests")
        layer = value("layer_young_modulus") * value("layer_width") / value("layer_thickness")
        thickness = (1 - value("tooth_height") / value("beam_thickness")) ** 3
        compliance = (1 - value("beam_poisson_ratio") ** 2) / (thickness * value("beam_young_modulus")) + (
            1 - value("layer_poisson_ratio") ** 2
        ) / value("layer_young_modulus")
        curvature = 2 * value("curvature_radius") ** 2 / crests**2
        width = 1.6 * math.sqrt(force * curvature * compliance / (crests * value("layer_width")))
        self.push = self.radius**2 * friction * force / inertia
        self.drag = self.radius * float(drive.load_torque) / inertia
        self.force = friction * force
        self.p = np.array(
            [
                _TURN * float(point.resonance_frequency),
                value("damping_ratio"),
                _TURN * f_q,
                float(drive.switching_phase),
                float(drive.phase_lead),
                W,
                D * k,
                force * k / (2 * crests * layer),
                k * width / 2,
                float(contact == "hertz"),
                self.push,
                self.drag,
            ]
        )
        m, n = int(drive.periods), int(drive.on_periods)
        self.durations = np.array([m - n, m - n, 2 * n - m]) / f_q
        self.cycle_time = m / f_q
        self.states = _region_starts(self.p, drive.start, np.array([m - n, m - n, 2 * n - m]))
        speed = D * k * W * self.p[0]
        self.scale = min(speed, (self.push + abs(self.drag)) * self.cycle_time)
        self.tolerance, self.longest = tolerance, longest / f_q
        self.fastest = 4 * speed

    @property
    def runaway(self) -> bool:
        return abs(self.drag) >= self.push

    def lap(self, v0, tolerance):
        scales = self.scale * np.array([1.0, self.cycle_time, self.scale * self.cycle_time])
        return _lap(_TABLE, self.p, self.states, self.durations, GATES, v0, scales, tolerance, self.longest)

    def orbit(self) -> ReferenceOrbit:
        """The cycle that repeats itself.  A lap's gain falls as its start rises: secant, halved where it leaves."""
        if self.runaway:
            raise ValueError("no speed balances the load")
        bound = self.fastest + 2 * (self.push + abs(self.drag)) * self.cycle_time
        v, slope, laps, steps = 0.0, -1.0, 0, 0
        for tolerance, close in ((max(1e-9, self.tolerance), 1e-6), (self.tolerance, 5e-10)):
            low, high, before = -bound, bound, None
            while True:
                if laps == 200:
                    raise RuntimeError("no orbit found")
                x, least, most, taken = self.lap(v, tolerance)
                gain, laps, steps = x[0], laps + 1, steps + taken
                low, high = (v, high) if gain > 0 else (low, v)
                noise = 1e4 * tolerance * self.scale
                flat = before is not None and abs(gain - before[1]) < noise < abs(gain)  # friction saturated throughout
                if before is not None and abs(gain - before[1]) > noise:
                    slope = min((gain - before[1]) / (v - before[0]), -1e-9)
                before, new = (v, gain), v - gain / slope
                if flat or not low <= new <= high:
                    new = 0.5 * (low + high)
                if abs(new - v) <= close * max(abs(v + least), abs(v + most)):
                    break
                v = new
        T = self.cycle_time
        mean, square = x[1] / T, x[2] / T
        return ReferenceOrbit(
            start=v / self.radius,
            mean=(v + mean) / self.radius,
            low=(v + least) / self.radius,
            high=(v + most) / self.radius,
            deviation=math.sqrt(max(0.0, square - mean**2)) / self.radius,
            surface_power=self.force * x[3] / T,
            heat=self.force * x[4] / T,
            laps=laps,
            steps=steps,
        )


def encoder_readings(other: Reference, period: float, count: int = 100) -> np.ndarray:
    """What an encoder reads that averages over ``period``, from the orbit's path, whole cycles and a rest, rad/s."""
    orbit = other.orbit()
    grid = np.linspace(0, 1, count + 1)
    whole, path = other.durations.copy(), [0.0]
    edges = np.concatenate([[0], np.cumsum(whole)])
    for share in grid[1:]:
        region = min(int(np.searchsorted(edges[1:], share * edges[-1] * (1 - 1e-12))), 2)
        other.durations = np.where(np.arange(3) < region, whole, 0.0)
        other.durations[region] = share * edges[-1] - edges[region]
        path.append(orbit.start * share * edges[-1] + other.lap(orbit.start * other.radius, 1e-9)[0][1] / other.radius)
    other.durations = whole
    path = np.array(path)

    def angle(at):
        return np.interp(at % 1.0, grid, path) + np.floor(at) * path[-1]

    return (angle(grid[:-1] + period / other.cycle_time) - angle(grid[:-1])) / period
