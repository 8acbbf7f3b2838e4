"""Stator, layer and rotor moved through time by another formulation: the witness of the level coupling = "contact".

Both phases are integrated as they are, with the drive's own oscillation, and so is the rotor, up and down with a mass
and round with its load: no turning frame, no averaging, none of the package's formulas.  The layer is cut into elements
between the places where it touches and where slip turns round; each has 16 Gauss points at which pressure and friction
act on the surface.  A steady state is what repeats itself every drive period, by Newton on the map of one period.
Pulses are followed through a drive cycle from the state in which the package's orbit begins.  Where terminals of a
phase that is off are open, its voltage is one more number of the state, which moves as no current has it.

    python -m studies.coupling 100
    python -m studies.coupling pulses 100
    python -m studies.coupling open 100
    python -m studies.coupling errors 100
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
from trum_sym.inputs.schedule import Schedule, Terminals
from trum_sym.model.coupled_orbit import CoupledOrbit, lap_values, orbit_from, start_of
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels

__all__ = [
    "Steady",
    "after",
    "cycle",
    "differences",
    "draw",
    "draw_pulses",
    "energy_residual",
    "guessed",
    "left_over",
    "over_error",
    "pulse_differences",
    "repeated",
    "steady",
]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_PERIOD = 7  # of the state's numbers repeat: w_A, v_A, w_B, v_B, the rotor's height and its rate, the rim's speed
_SIZES = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-5])
"""Of the state; then work in J, put in, lost in the stator, by slip, taken by the load, and the rim's way in m."""
_NUMBERS = _SIZES.size
_VOLTAGES = np.array([100.0, 100.0])
"""Sizes of A's and B's voltage, which follow where terminals open."""


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


def _carried(y: Array, p: Mapping[str, float]) -> Array:
    """Heights at which the layer carries the prepressure, (n,): Newton from where it would be flat, which overshoots
    downward, and from there on only rises.
    """
    w_A, w_B = y[0], y[2]
    stiff = p["n_j"] / p["k_c"] * p["k_N"]
    z = np.full(y.shape[1], -p["F_c"] / (2 * np.pi * stiff)) - np.hypot(w_A, w_B)
    for _ in range(60):
        places = np.sort(_places(w_B, w_A, z), axis=0)
        stops = np.stack([np.zeros_like(z), *places, np.full_like(z, 2 * np.pi)])
        half, middle = np.diff(stops, axis=0) / 2, (stops[1:] + stops[:-1]) / 2
        s = middle[:, np.newaxis] + half[:, np.newaxis] * _NODES[:, np.newaxis]
        depth = w_A * np.sin(s) + w_B * np.cos(s) - z
        weight = stiff * half[:, np.newaxis] * _WEIGHTS[:, np.newaxis]
        force = (weight * np.maximum(0.0, depth)).sum(axis=(0, 1))
        change = (force - p["F_c"]) / (weight * (depth > 0)).sum(axis=(0, 1))
        z = z + change
        if (np.abs(change) < 1e-14 * 1e-6).all():
            break
    return np.asarray(z)


def _rates(t: float, y: Array, p: Mapping[str, float]) -> Array:
    if not p["mass"] > 0:
        y = np.concatenate([y[:4], _carried(y, p)[np.newaxis], np.zeros((1, y.shape[1])), y[6:]])
    forces = _contact(y, p)
    turn = p["omega_q"] * t + p["phase"]
    if p["open"]:
        on_A, on_B = (
            p["factor"] * (p["U_s"] * swing if p[gate] else voltage)
            for gate, swing, voltage in zip(
                ("g_A", "g_B"), (math.cos(turn), -math.sin(turn)), y[_NUMBERS:], strict=True
            )
        )
    else:
        on_A = p["g_A"] * p["F_q"] * math.cos(turn)
        on_B = -p["g_B"] * p["F_q"] * math.sin(turn)  # a quarter period ahead
    damping, own, mass = 2 * p["xi"] * p["omega_n0"], p["omega_n0"] ** 2, p["M_q"]
    return np.array(
        [
            y[1],
            (on_A + forces[0]) / mass - damping * y[1] - own * y[0],
            y[3],
            (on_B + forces[1]) / mass - damping * y[3] - own * y[2],
            y[5],
            (forces[2] - p["F_c"]) / p["mass"] if p["mass"] > 0 else np.zeros_like(y[5]),
            p["r_c"] * (p["r_c"] * forces[3] - p["T_load"]) / p["J_total"],
            on_A * y[1] + on_B * y[3],
            damping * mass * (y[1] ** 2 + y[3] ** 2),
            forces[4],
            p["T_load"] / p["r_c"] * y[6],
            y[6],
            # no current: what the motion's charge takes the capacitance gives
            *(-p["factor"] / p["held_still"] * rate for rate in (y[1], y[3]) if p["open"]),
        ]
    )


def _port(values: Mapping[str, float]) -> tuple[float, float]:
    """Force per volt, and capacitance of a phase that is held still: a plate of ceramic that cannot strain."""
    field = 1 / values["h_p"]
    density = values["eps_33T"] * field - values["d_31"] * (values["d_31"] * field / values["s_11E"])
    area = values["b_p"] * 2 * math.pi / values["k_c"] * values["n_j"] * values["c_p"]
    return values["F_q"] / values["U_s"], density * area


def after(
    values: Mapping[str, float],
    start: Array,
    periods: float,
    mass: float = 0.02,
    tolerance: float = 1e-10,
    gates: tuple[float, float] = (1.0, 1.0),
    phase: float = 0.0,
    voltages: tuple[float, float] | None = None,
) -> Array:
    """States (12, n) after some drive periods, from states (7, n) at a phase of the drive.

    Parameters
    ----------
    values : mapping
        By symbol, as :func:`trum_sym.model.coupling.plain_waves` takes them, for a phase lead of 1.
    start : (7, n) array
        Displacement and velocity of A and B, height of the rotor and its rate, speed of the rim.
    periods : float
    mass : float, kg
        Of the rotor that goes up and down; without one the layer carries the prepressure at every instant.
    tolerance : float
        Relative, of the integration by DOP853.
    gates : (float, float)
        1 for a phase, A and B, that is driven, 0 for one that is off.
    phase : float, rad
        Of A's force at the start.
    voltages : (float, float), V
        Of A and B at the start, where terminals of a phase that is off are open; the states have them behind.
    """
    p = {**values, "mass": mass, "g_A": gates[0], "g_B": gates[1], "phase": phase, "open": voltages is not None}
    count, sizes = start.shape[1], _SIZES
    full = np.concatenate([start, np.zeros((_NUMBERS - _PERIOD, count))])
    if voltages is not None:
        p["factor"], p["held_still"] = _port(values)
        sizes = np.concatenate([sizes, _VOLTAGES])
        full = np.concatenate([full, np.repeat(np.array(voltages)[:, np.newaxis], count, axis=1)])
    found = solve_ivp(
        lambda t, y: _rates(t, y.reshape(sizes.size, count), p).ravel(),
        (0.0, periods * 2 * math.pi / p["omega_q"]),
        full.ravel(),
        method="DOP853",
        rtol=tolerance,
        atol=np.repeat(1e-3 * tolerance * sizes, count),
    )
    return np.asarray(found.y[:, -1].reshape(sizes.size, count))


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


def left_over(values: Mapping[str, float], start: Array, end: Array, mass: float = 0.02) -> float:
    """Work put in less what is lost, slipped, taken by the load and stored, over the work put in.

    From a state (7,) to one (12,) with the work on the way.
    """

    def stored(y: Array) -> float:
        modes = values["M_q"] / 2 * (y[1] ** 2 + y[3] ** 2 + values["omega_n0"] ** 2 * (y[0] ** 2 + y[2] ** 2))
        s = 2 * np.pi * (np.arange(200_000) + 0.5) / 200_000
        pressed = np.maximum(0.0, y[0] * np.sin(s) + y[2] * np.cos(s) - y[4])
        layer = values["k_N"] * values["n_j"] / values["k_c"] * np.pi * float(np.mean(pressed**2))
        turning = values["J_total"] / 2 * (y[6] / values["r_c"]) ** 2
        return float(modes + layer + mass / 2 * y[5] ** 2 + values["F_c"] * y[4] + turning)

    return float((end[7] - end[8] - end[9] - end[10] - (stored(end) - stored(start))) / end[7])


def energy_residual(values: Mapping[str, float], start: Array, periods: int, mass: float = 0.02) -> float:
    """What is left over of the work that goes in over some drive periods, from a state (7,)."""
    return left_over(values, start, after(values, start[:, np.newaxis], periods, mass, 1e-12)[:, 0], mass)


def cycle(values: Mapping[str, float], start: Array, tolerance: float = 1e-10) -> Array:
    """The state (12,) after a drive cycle of pulses: A is off first, then B is for as long, then neither."""
    periods, phase = int(values["m"]), values["force_phase"]
    mass, state, sums = values["mass"], start, np.zeros(_NUMBERS - _PERIOD)
    driven = values.get("U_s", 0.0) * np.array([math.cos(phase), -math.sin(phase)])  # where periods end
    voltages = driven
    for period in range(periods):
        gates = tuple(float(not values[f"off_{name}"] <= period < values[f"on_{name}"]) for name in "AB")
        held = (float(voltages[0]), float(voltages[1])) if values.get("K_o", 0.0) > 0 else None
        end = after(values, state[:, np.newaxis], 1, mass, tolerance, gates, phase, held)[:, 0]
        state, sums = end[:_PERIOD], sums + end[_PERIOD:_NUMBERS]
        voltages = np.where(gates, driven, end[_NUMBERS:]) if held else driven
    if not mass > 0:
        state = state.copy()
        state[4] = _carried(state[:, np.newaxis], values)[0]
    return np.concatenate([state, sums])


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


def draw_pulses(seed: int, off_terminals: Terminals = "short") -> dict[str, float]:
    """As :func:`draw`, pulsed: a rotor's mass or none, the bench's plate or none, cycles of 2 to 7 periods."""
    at = np.random.default_rng(seed)
    motor = ts.load_motor().with_values(
        {"contact_stiffness": float(10 ** at.uniform(8.8, 10.5)), "friction_coefficient": float(at.uniform(0.2, 0.3))}
    )
    force = float(at.uniform(100, 220))
    most = float(motor.friction_coefficient.value) * force * float(motor.contact_radius.value)
    periods = int(at.integers(2, 8))
    drive = ts.Drive(
        periods=periods,
        on_periods=int(at.integers((periods + 1) // 2, periods)),
        prepressure=force,
        frequency_difference=float(at.uniform(-300, 3000)),
        load_torque=float(at.uniform(-0.1, 0.3)) * most,
        load_inertia=float(at.choice([0.0, 2.7e-4])),
    )
    mass = float(at.choice([0.0, 10 ** at.uniform(-2, -1)]))
    values = lap_values(motor, drive, Levels(), Schedule(off_terminals=off_terminals), rotor_mass=mass)
    share = float(at.uniform(0.4, 1.2))
    scaled = {"F_q": values["F_q"] * share, "size": values["size"] * share, "K_o": values["K_o"] * share**2}
    return {**values, **scaled}


def pulse_differences(seed: int, off_terminals: Terminals = "short") -> tuple[CoupledOrbit, Array] | None:
    """The orbit at a random pulsed point, and how far the witness's cycle is off where that begins; None without one.

    By the largest of displacements and of velocities, of speed and mean speed by the rotor's largest speed, of input
    power; friction's mean torque by the largest; the energy left over of the input.
    """
    values = draw_pulses(seed, off_terminals)
    orbit = orbit_from({**values, "wanted": 1e-8}, start_of("steady", values), "steady")
    if not (orbit.closed and orbit.cycles == 1):
        return None
    end = cycle(values, orbit.state, 1e-11)
    wave, off = orbit.highest_wave, np.abs(end[:_PERIOD] - orbit.state)
    speed, top = wave * values["omega_q"], max(abs(orbit.min_speed), abs(orbit.max_speed))
    time = values["m"] * 2 * math.pi / values["omega_q"]
    torque = values["J_total"] * off[6] / values["r_c"] / time  # what it has beyond the load's
    gaps = [
        max(off[0], off[2], off[4]) / wave,
        max(off[1], off[3], off[5]) / speed,
        off[6] / values["r_c"] / top,
        abs(end[11] / time / values["r_c"] - orbit.mean_speed) / top,
        torque / (values["mu"] * values["F_c"] * values["r_c"]),
        abs(end[7] / time / orbit.input_power - 1),
        abs(left_over(values, orbit.state, end, values["mass"])),
    ]
    return orbit, np.array(gaps)


def over_error(seed: int) -> Array | None:
    """At a random pulsed point, by how much of their stated errors the orbit's figures are off from far finer steps."""
    values = draw_pulses(seed)
    orbit = orbit_from(values, start_of("steady", values), "steady")
    if not (orbit.tolerance_met and orbit.stable):
        return None
    finer = orbit_from({**values, "wanted": 1e-9}, orbit.state, "finer", settling=0)
    if not (finer.mean_speed_error < orbit.mean_speed_error / 10 and finer.cycles == orbit.cycles):
        return None
    pairs = ((getattr(orbit, name), getattr(finer, name), getattr(orbit, f"{name}_error")) for name in _FIGURES)
    return np.array([abs(one - other) / error for one, other, error in pairs])


_FIGURES = ("mean_speed", "min_speed", "max_speed", "deviation", "contact_fraction", "highest_wave", "input_power")
_GAPS = ("displacements", "velocities", "speed", "mean speed", "torque", "input power", "energy")
_ALLOWED = np.array([1e-6] * 6 + [1e-8])


def _pulses(count: int, off_terminals: Terminals = "short") -> int:
    worst, orbits, stable = np.zeros(len(_GAPS)), 0, 0
    for seed in range(count):
        found = pulse_differences(seed, off_terminals)
        if found is None:
            print(f"seed {seed}: no orbit of one cycle")
            continue
        orbit, gaps = found
        orbits, stable, worst = orbits + 1, stable + orbit.stable, np.maximum(worst, gaps)
        if not (gaps < _ALLOWED).all():
            print(f"seed {seed}: " + ", ".join(f"{name} {gap:.1e}" for name, gap in zip(_GAPS, gaps, strict=True)))
    print(f"{count} pulsed points, {orbits} orbits of one cycle, {stable} of them stable; largest differences:")
    for name, value in zip(_GAPS, worst, strict=True):
        print(f"{name:<14} {value:.1e}")
    return int(not (worst < _ALLOWED).all())


def _errors(count: int) -> int:
    rows = np.array([row for row in map(over_error, range(count)) if row is not None])
    print(f"{count} pulsed points, {len(rows)} orbits; differences from finer steps over the stated errors:")
    for name, shares in zip(_FIGURES, rows.T, strict=True):
        print(
            f"{name:<17} median {np.median(shares):.3f}, largest {shares.max():.2f}, above 1: {int((shares > 1).sum())}"
        )
    return int((rows > 1).mean() > 0.01)


def main(arguments: list[str]) -> int:
    """Compare random points, print the worst; 1 if one is off by more than 1e-6, or energy by more than 1e-8.

    ``errors``: 1 if more than one in a hundred errors is larger than stated.
    """
    if arguments and arguments[0] in ("pulses", "open", "errors"):
        of = int(arguments[1]) if len(arguments) > 1 else 100
        if arguments[0] == "errors":
            return _errors(of)
        return _pulses(of, "open" if arguments[0] == "open" else "short")
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
