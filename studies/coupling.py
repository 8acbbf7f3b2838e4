"""Stator, layer and rotor moved through time by another formulation: the witness of the level coupling = "contact".

Both phases are integrated as they are, with the drive's own oscillation, and so is the rotor, up and down with a mass
and round with its load: no turning frame, no averaging, none of the package's formulas.  The layer is cut into elements
between the places where it touches and where slip turns round; each has 16 Gauss points at which pressure and friction
act on the surface.  A steady state is what repeats itself every drive period, by Newton on the map of one period.

    python -m studies.coupling 100
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

import trum_sym as ts
from trum_sym.inputs.checks import Array
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels

__all__ = ["Steady", "after", "differences", "draw", "energy_residual", "guessed", "repeated", "steady"]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_PERIOD = 7  # of the state's numbers repeat: w_A, v_A, w_B, v_B, the rotor's height and its rate, the rim's speed
_SIZES = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3, 1e-3, 1e-3, 1e-3, 1e-3])
"""Of the state; the last four are the work put in, lost in the stator, by slip, and taken by the load, in J."""


def _places(a: Array, b: Array, c: Array) -> Array:
    """The two places from 0 to 2 pi where a cos s + b sin s is c, (2, n); 0 where there are none."""
    size = np.hypot(a, b)
    with np.errstate(all="ignore"):
        half = np.where(np.abs(c) < size, np.arccos(np.clip(c / size, -1, 1)), 0.0)
    return np.where(half > 0, (np.arctan2(b, a) + np.stack([half, -half])) % (2 * np.pi), 0.0)


def _contact(y: Array, p: Mapping[str, float]) -> Array:
    """Forces on A, B, up and along on the rotor, and slip's heat, (5, n) for n states: sums over all elements."""
    w_A, v_A, w_B, v_B, z, _, v = y[:_PERIOD]
    lever = p["D"] * p["k_c"]
    stops = np.zeros((6, y.shape[1]))
    stops[:2] = _places(w_B, w_A, z)  # the wave as high as the rotor
    stops[2:4] = _places(lever * v_A, -lever * v_B, v)  # the surface, D times the slope's rate, as fast as the rim
    stops[5] = 2 * np.pi
    stops = np.sort(stops, axis=0)
    half, middle = np.diff(stops, axis=0) / 2, (stops[1:] + stops[:-1]) / 2
    s = middle[:, np.newaxis] + half[:, np.newaxis] * _NODES[:, np.newaxis]
    sine, cosine = np.sin(s), np.cos(s)
    weight = half[:, np.newaxis] * _WEIGHTS[:, np.newaxis] * p["n_j"] / p["k_c"]
    press = p["k_N"] * np.maximum(0.0, w_A * sine + w_B * cosine - z) * weight
    slip = lever * (v_A * cosine - v_B * sine) - v
    drag = p["mu"] * press * np.sign(slip)
    parts = [-press * sine - drag * lever * cosine, -press * cosine + drag * lever * sine, press, drag, drag * slip]
    return np.array([part.sum(axis=(0, 1)) for part in parts])


def _rates(t: float, y: Array, p: Mapping[str, float]) -> Array:
    forces = _contact(y, p)
    on_A = p["g_A"] * p["F_q"] * math.cos(p["omega_q"] * t)
    on_B = -p["g_B"] * p["F_q"] * math.sin(p["omega_q"] * t)  # a quarter period ahead
    damping, own, mass = 2 * p["xi"] * p["omega_n0"], p["omega_n0"] ** 2, p["M_q"]
    return np.array(
        [
            y[1],
            (on_A + forces[0]) / mass - damping * y[1] - own * y[0],
            y[3],
            (on_B + forces[1]) / mass - damping * y[3] - own * y[2],
            y[5],
            (forces[2] - p["F_c"]) / p["mass"],
            p["r_c"] * (p["r_c"] * forces[3] - p["T_load"]) / p["J_total"],
            on_A * y[1] + on_B * y[3],
            damping * mass * (y[1] ** 2 + y[3] ** 2),
            forces[4],
            p["T_load"] / p["r_c"] * y[6],
        ]
    )


def after(
    values: Mapping[str, float],
    start: Array,
    periods: float,
    mass: float = 0.02,
    tolerance: float = 1e-10,
    gates: tuple[float, float] = (1.0, 1.0),
) -> Array:
    """States (11, n) after some drive periods, from states (7, n) at the drive's phase 0.

    Parameters
    ----------
    values : mapping
        By symbol, as :func:`trum_sym.model.coupling.plain_waves` takes them, for a phase lead of 1.
    start : (7, n) array
        Displacement and velocity of A and B, height of the rotor and its rate, speed of the rim.
    periods : float
    mass : float, kg
        Of the rotor that goes up and down.
    tolerance : float
        Relative, of the integration by DOP853.
    gates : (float, float)
        1 for a phase, A and B, that is driven, 0 for one that is off.
    """
    p = {**values, "mass": mass, "g_A": gates[0], "g_B": gates[1]}
    count = start.shape[1]
    full = np.concatenate([start, np.zeros((4, count))])
    found = solve_ivp(
        lambda t, y: _rates(t, y.reshape(11, count), p).ravel(),
        (0.0, periods * 2 * math.pi / p["omega_q"]),
        full.ravel(),
        method="DOP853",
        rtol=tolerance,
        atol=np.repeat(1e-3 * tolerance * _SIZES, count),
    )
    return np.asarray(found.y[:, -1].reshape(11, count))


@dataclass(frozen=True)
class Steady:
    """A steady state of the plain wave: height of the wave (m), lead of the force (rad), rim's speed (m/s)."""

    amplitude: float
    lead: float
    speed: float
    force: float
    left: float


def repeated(values: Mapping[str, float], guess: Array, mass: float = 0.02, tolerance: float = 1e-10) -> Array:
    """The state (7,) that a drive period brings back, from a guess, by Newton on the map of a period."""
    sizes, state = _SIZES[:_PERIOD], np.array(guess, float)
    steps = 1e-4 * sizes
    for _ in range(12):
        states = state[:, np.newaxis] + np.concatenate(
            [np.zeros((_PERIOD, 1)), np.diag(steps), -np.diag(steps)], axis=1
        )
        gaps = after(values, states, 1, mass, tolerance)[:_PERIOD] - states
        if np.abs(gaps[:, 0] / sizes).max() < 30 * tolerance:
            break
        slopes = (gaps[:, 1 : 1 + _PERIOD] - gaps[:, 1 + _PERIOD :]) / (2 * steps)
        state = state - np.linalg.solve(slopes, gaps[:, 0])
    return state


def steady(values: Mapping[str, float], guess: Array, mass: float = 0.02, tolerance: float = 1e-10) -> Steady:
    """The steady state next to a guess."""
    state = repeated(values, guess, mass, tolerance)
    closed = after(values, state[:, np.newaxis], 1, mass, tolerance)[:_PERIOD, 0]
    size = math.hypot(state[0], state[2])
    # the force on A is at its crest at t = 0, ahead of A = W cos(omega_q t - lead) by the lead
    lead = math.atan2(state[2], state[0])
    force = _contact(state[:, np.newaxis], {**values, "mass": mass})[3, 0]
    return Steady(size, lead, float(state[6]), float(force), float(np.abs((closed - state) / _SIZES[:_PERIOD]).max()))


def energy_residual(values: Mapping[str, float], start: Array, periods: int, mass: float = 0.02) -> float:
    """Work put in less what is lost, slipped, taken by the load and stored, over the work put in, from a state (7,)."""
    end = after(values, start[:, np.newaxis], periods, mass, 1e-12)[:, 0]

    def stored(y: Array) -> float:
        modes = values["M_q"] / 2 * (y[1] ** 2 + y[3] ** 2 + values["omega_n0"] ** 2 * (y[0] ** 2 + y[2] ** 2))
        s = 2 * np.pi * (np.arange(200_000) + 0.5) / 200_000
        pressed = np.maximum(0.0, y[0] * np.sin(s) + y[2] * np.cos(s) - y[4])
        layer = values["k_N"] * values["n_j"] / values["k_c"] * np.pi * float(np.mean(pressed**2))
        turning = values["J_total"] / 2 * (y[6] / values["r_c"]) ** 2
        return float(modes + layer + mass / 2 * y[5] ** 2 + values["F_c"] * y[4] + turning)

    return float((end[7] - end[8] - end[9] - end[10] - (stored(end) - stored(start))) / end[7])


def draw(seed: int) -> dict[str, float]:
    """A motor and a drive at random: TRUM-60 with prepressure, layer, friction, load, force and frequency changed."""
    at = np.random.default_rng(seed)
    motor = ts.load_motor().with_values(
        {"contact_stiffness": float(10 ** at.uniform(8.8, 10.5)), "friction_coefficient": float(at.uniform(0.2, 0.3))}
    )
    force = float(at.uniform(100, 220))
    most = float(motor.friction_coefficient.value) * force * float(motor.contact_radius.value)
    drive = ts.Drive(
        on_periods=20,
        prepressure=force,
        frequency_difference=float(at.uniform(-300, 3000)),
        load_torque=float(at.uniform(-0.3, 0.8)) * most,
    )
    values = coupled_values(motor, drive, Levels(coupling="contact", amplitude="forced"))
    return {**values, "F_q": float(values["F_q"]) * float(at.uniform(0.4, 1.2))}


def guessed(values: Mapping[str, float], amplitude: float, lead: float, speed: float, half_angle: float) -> Array:
    """A state at the drive's phase 0 from the figures of a plain wave, as a guess."""
    omega, height = values["omega_q"], amplitude * math.cos(half_angle)
    if half_angle >= math.pi:
        height = -values["F_c"] * values["k_c"] / (2 * math.pi * values["n_j"] * values["k_N"])
    a = math.pi / 2 - lead  # the crest's angle: (w_A, w_B) = W (sin a, cos a)
    w_A, w_B = amplitude * math.sin(a), amplitude * math.cos(a)
    return np.array([w_A, omega * w_B, w_B, -omega * w_A, height, 0.0, speed])


def differences(seed: int) -> list[tuple[float, float, float, float]]:
    """At a random point, for each steady state: amplitude, lead, speed, torque, relative, ours less the witness's."""
    values = draw(seed)
    waves = plain_waves(values)
    found = []
    for k in range(waves.amplitude.size):
        if waves.amplitude[k] == 0:
            continue
        rim = float(waves.speed[k]) * values["r_c"]
        guess = guessed(values, float(waves.amplitude[k]), float(waves.lead[k]), rim, float(waves.half_angle[k])) * (
            1 + 1e-4 * np.random.default_rng(seed).uniform(-1, 1, _PERIOD)
        )
        other = steady(values, guess)
        surface = values["D"] * values["k_c"] * values["omega_q"] * other.amplitude
        most = values["mu"] * values["F_c"]
        found.append(
            (
                float(waves.amplitude[k]) / other.amplitude - 1,
                float(waves.lead[k]) - other.lead,
                (rim - other.speed) / surface,
                (most * float(waves.friction[k]) - other.force) / most,
            )
        )
    return found


def main(arguments: list[str]) -> int:
    """Compare random points, print the worst; 1 if one is off by more than 1e-6."""
    count = int(arguments[0]) if arguments else 100
    worst, states = np.zeros(4), 0
    for seed in range(count):
        for row in differences(seed):
            worst, states = np.maximum(worst, np.abs(row)), states + 1
    print(f"{count} points, {states} steady states; largest differences, relative:")
    for name, value in zip(("amplitude", "lead", "speed", "torque"), worst, strict=True):
        print(f"{name:<10} {value:.1e}")
    return int(not (worst < 1e-6).all())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
