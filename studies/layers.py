"""The layer that loses energy or is sheared, by another formulation: the witness of docs/coupling.md.

Both phases are integrated with the drive's own oscillation, as in :mod:`studies.coupling`: no turning frame, none of
the package's formulas. A steady state is what repeats itself every drive period, by Newton on the map of one period.

``loss``: pressure and friction act at Gauss points between the places where the contact begins and ends and where
slip turns round; the rotor goes up and down with a mass, and the layer feels its speed. What is left of an element
that leaves is written down as it leaves, place and depth, and decays by itself until the wave is back: that memory is
a state of its own, of one period.

``shear``: the circumference is cut into elements, each of which keeps its own stress: it grows with the slip from
step to step and is cut off at friction's limit. Errors fall as the square of the number of elements, and of steps,
which are as many; the last two numbers are taken on to none by that.

    python -m studies.layers loss 20
    python -m studies.layers shear 20
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.integrate import solve_ivp

import trum_sym as ts
from studies.coupling import _NODES, _WEIGHTS, _places
from trum_sym.inputs.checks import Array
from trum_sym.model.coupling import PlainWaves, coupled_values, plain_waves
from trum_sym.model.levels import Levels

__all__ = ["draw", "loss_differences", "main", "shear_differences"]

_TURN = 2 * np.pi
_MASS = 0.02  # kg, of the rotor of ``loss``
_SEGMENTS = 24  # of a period, after each of which the layer's memory is written
_SIZES = np.array([1e-6, 0.3, 1e-6, 0.3, 1e-6, 0.3, 0.3])
"""Of w_A, v_A, w_B, v_B, the rotor's height and its rate, the rim's speed."""
_WORKS = 5  # put in, lost in the stator, by slip, taken by the load, given to the layer
_TOLERANCE = 1e-10
_ELEMENTS = (200, 400)
_NAMES = ("amplitude", "lead", "speed", "torque", "power in", "power lost")

Values = Mapping[str, float]
CArray: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]


def draw(seed: int, kind: str) -> dict[str, float]:
    """A motor and a drive at random as :func:`studies.coupling.draw`, with a loss factor or a layer that is sheared.

    Its grip is from 0.3 to 8: elements would have to be many more where their stress grows within fewer of them.
    """
    at = np.random.default_rng(seed)
    motor = ts.load_motor().with_values(
        {
            "contact_stiffness": float(10 ** at.uniform(8.8, 10.5)),
            "friction_coefficient": float(at.uniform(0.2, 0.3)),
            "layer_loss_factor": float(at.uniform(0.01, 0.2)) if kind == "loss" else 0.0,
        }
    )
    force = float(at.uniform(100, 220))
    most = float(motor.friction_coefficient.value) * force * float(motor.contact_radius.value)
    drive = ts.Drive(
        on_periods=20,
        prepressure=force,
        frequency_difference=float(at.uniform(-300, 3000)),
        load_torque=float(at.uniform(-0.3, 0.8)) * most,
    )
    levels = Levels(coupling="contact", amplitude="forced")
    values = coupled_values(motor, drive, levels)
    values["F_q"] *= float(at.uniform(0.4, 1.2))
    if kind == "loss":
        return values
    grip = float(10 ** at.uniform(-0.5, 0.9))
    return {**values, "grip": grip, "k_T": grip * values["mu"] * values["k_N"] / (values["D"] * values["k_c"])}


@dataclass
class _Memory:
    """Where the layer left, unwrapped, when, and how deep it was: (m,), and (m, n) for n states."""

    times: Array
    places: Array
    depths: Array

    def left(self, place: Array, t: float, lag: float) -> tuple[Array, Array]:
        """What is left of the depth at places (n,), and its slope."""
        found, slopes = np.empty_like(place), np.empty_like(place)
        for k, at in enumerate(place - _TURN):
            then = np.interp(at, self.places[:, k], self.times)
            rate = (self.times[-1] - self.times[0]) / (self.places[-1, k] - self.places[0, k])
            found[k] = np.interp(at, self.places[:, k], self.depths[:, k]) * math.exp(-(t - then) / lag)
            slopes[k] = found[k] * rate / lag
        return found, slopes


def _edges(t: float, y: Array, p: Values, memory: _Memory) -> tuple[Array, Array, Array, Array]:
    """Crest, unwrapped, where the layer leaves and where it begins to touch, from the crest, and depth on leaving."""
    w_A, v_A, w_B, v_B, z, climb = y[:6]
    lag = p["eta_m"] / p["omega_q"]
    crest = np.arctan2(w_A, w_B)
    near = memory.places[-1] + p["omega_q"] * (t - memory.times[-1])  # the crest is less than half a wave ahead of it
    crest = near + 1.0 + (crest - near - 1.0 + np.pi) % _TURN - np.pi
    a, b, c = w_B + lag * v_B, w_A + lag * v_A, z + lag * climb
    size = np.hypot(a, b)
    whole = -c >= size
    with np.errstate(all="ignore"):
        out = (np.arctan2(b, a) - crest + np.pi) % _TURN - np.pi - np.arccos(np.clip(c / size, -1, 1))
        into = np.arccos(np.clip(z / np.hypot(w_A, w_B), -1, 1))
    for _ in range(30):
        place = crest + into
        left, slope = memory.left(place, t, lag)
        gap = w_A * np.sin(place) + w_B * np.cos(place) - z - left
        step = gap / (w_A * np.cos(place) - w_B * np.sin(place) - slope)
        into = np.where(whole, into, into - step)
        if (np.abs(step[~whole]) < 1e-14).all():
            break
    depth = w_A * np.sin(crest + out) + w_B * np.cos(crest + out) - z
    return crest, np.where(whole, -np.pi, out), np.where(whole, np.pi, into), depth


def _lossy_forces(t: float, y: Array, p: Values, memory: _Memory) -> Array:
    """Forces on A, B, up and along on the rotor, slip's heat and power into the layer, (6, n)."""
    w_A, v_A, w_B, v_B, z, climb, v = y[:7]
    lever, lag = p["D"] * p["k_c"], p["eta_m"] / p["omega_q"]
    crest, out, into, _ = _edges(t, y, p, memory)
    turns = (_places(lever * v_A, -lever * v_B, v) - crest - out) % _TURN + out
    stops = np.sort(np.stack([out, *np.minimum(turns, into), into]), axis=0)
    half, middle = np.diff(stops, axis=0) / 2, (stops[1:] + stops[:-1]) / 2
    s = crest + middle[:, np.newaxis] + half[:, np.newaxis] * _NODES[:, np.newaxis]
    sine, cosine = np.sin(s), np.cos(s)
    weight = half[:, np.newaxis] * _WEIGHTS[:, np.newaxis] * p["n_j"] / p["k_c"]
    rate = v_A * sine + v_B * cosine - climb
    press = p["k_N"] * (w_A * sine + w_B * cosine - z + lag * rate) * weight
    slip = lever * (v_A * cosine - v_B * sine) - v
    drag = p["mu"] * press * np.sign(slip)
    parts = (-press * sine - drag * lever * cosine, -press * cosine + drag * lever * sine)
    return np.array([part.sum(axis=(0, 1)) for part in (*parts, press, drag, drag * slip, press * rate)])


def _lossy_rates(t: float, y: Array, p: Values, memory: _Memory) -> Array:
    forces = _lossy_forces(t, y, p, memory)
    turn = p["omega_q"] * t
    on_A, on_B = p["F_q"] * math.cos(turn), -p["F_q"] * math.sin(turn)
    damping, own, mass = 2 * p["xi"] * p["omega_n0"], p["omega_n0"] ** 2, p["M_q"]
    return np.array(
        [
            y[1],
            (on_A + forces[0]) / mass - damping * y[1] - own * y[0],
            y[3],
            (on_B + forces[1]) / mass - damping * y[3] - own * y[2],
            y[5],
            (forces[2] - p["F_c"]) / _MASS,
            p["r_c"] * (p["r_c"] * forces[3] - p["T_load"]) / p["J_total"],
            on_A * y[1] + on_B * y[3],
            damping * mass * (y[1] ** 2 + y[3] ** 2),
            forces[4],
            p["T_load"] / p["r_c"] * y[6],
            forces[5],
        ]
    )


def _lossy_period(p: Values, states: Array, memory: _Memory) -> tuple[Array, _Memory]:
    """States (12, n) after a period from states (7, n), and the memory of that period."""
    count, period = states.shape[1], _TURN / p["omega_q"]
    sizes = np.concatenate([_SIZES, np.full(_WORKS, 1e-3)])
    y = np.concatenate([states, np.zeros((_WORKS, count))])
    known = memory
    for k in range(_SEGMENTS):
        span = (k * period / _SEGMENTS, (k + 1) * period / _SEGMENTS)
        found = solve_ivp(
            lambda t, flat, known=known: _lossy_rates(t, flat.reshape(-1, count), p, known).ravel(),
            span,
            y.ravel(),
            method="DOP853",
            rtol=_TOLERANCE,
            atol=np.repeat(1e-3 * _TOLERANCE * sizes, count),
        )
        y = found.y[:, -1].reshape(-1, count)
        crest, out, _, depth = _edges(span[1], y, p, known)
        known = _Memory(
            np.append(known.times, span[1]),
            np.vstack([known.places, crest + out]),
            np.vstack([known.depths, depth]),
        )
    last = slice(-_SEGMENTS - 1, None)
    return y, _Memory(known.times[last] - period, known.places[last] - _TURN, known.depths[last])


def _guessed(p: Values, waves: PlainWaves, k: int, height: float) -> Array:
    """A state (7,) at the drive's phase 0 from a plain wave's figures."""
    size, a, omega = float(waves.amplitude[k]), math.pi / 2 - float(waves.lead[k]), p["omega_q"]
    w_A, w_B = size * math.sin(a), size * math.cos(a)
    return np.array([w_A, omega * w_B, w_B, -omega * w_A, height, 0.0, float(waves.speed[k]) * p["r_c"]])


def _lossy_steady(p: Values, guess: Array) -> tuple[Array, Array, float]:
    """State that a period brings back, friction's force, and powers: put in, in the stator, slip, load and layer."""
    period = _TURN / p["omega_q"]
    times = np.linspace(-period, 0, _SEGMENTS + 1)
    start = np.arctan2(guess[0], guess[2]) - 1.0
    flat = np.zeros((_SEGMENTS + 1, 1))
    memory = _Memory(times, start + p["omega_q"] * times[:, np.newaxis], flat)
    crest, out, _, depth = _edges(0.0, guess[:, np.newaxis], p, memory)
    memory = _Memory(times, crest + out + p["omega_q"] * times[:, np.newaxis], flat + depth)
    state, steps = guess, 1e-4 * _SIZES
    shifts = np.concatenate([np.zeros((7, 1)), np.diag(steps), -np.diag(steps)], axis=1)
    for _ in range(12):
        states = state[:, np.newaxis] + shifts
        wide = _Memory(memory.times, np.repeat(memory.places, 15, axis=1), np.repeat(memory.depths, 15, axis=1))
        end, after = _lossy_period(p, states, wide)
        gaps = end[:7] - states
        moved = np.abs(after.places[:, :1] - memory.places).max()
        moved += np.abs(after.depths[:, :1] - memory.depths).max() / _SIZES[0]
        memory = _Memory(after.times, after.places[:, :1], after.depths[:, :1])
        powers = end[7:, 0] / period
        if np.abs(gaps[:, 0] / _SIZES).max() < 30 * _TOLERANCE and moved < 1e-7:
            break
        slopes = (gaps[:, 1:8] - gaps[:, 8:]) / (2 * steps)
        state = state - np.linalg.solve(slopes, gaps[:, 0])
    return state, powers, float(_lossy_forces(0.0, state[:, np.newaxis], p, memory)[3, 0])


def loss_differences(seed: int) -> list[Array]:
    """At a random point, for each steady state: amplitude, lead, speed, torque, input and loss, relative.

    Amplitude by itself, torque by its largest, speed by the surface's, powers by the input.
    """
    from trum_sym.model.kernels import call
    from trum_sym.model.layer import lossy_contact

    p = draw(seed, "loss")
    waves, found = plain_waves(p), []
    per_height = float(np.asarray(call("trum_engagement", p)["engagement_per_height"]))
    at = np.random.default_rng(seed)
    for k, size in enumerate(waves.amplitude):
        contact = lossy_contact(p, np.array([per_height * size]))
        if size == 0 or (not waves.whole[k] and contact["theta"][0] > np.pi - 2 * _TURN / _SEGMENTS):
            continue  # friction holds it; or the layer touches again before its memory is written
        guess = _guessed(p, waves, k, float(-contact["share"][0]) / per_height) * (1 + 1e-4 * at.uniform(-1, 1, 7))
        state, powers, force = _lossy_steady(p, guess)
        surface = p["D"] * p["k_c"] * p["omega_q"] * math.hypot(state[0], state[2])
        lead = math.atan2(state[2], state[0])
        found.append(
            np.array(
                [
                    size / math.hypot(state[0], state[2]) - 1,
                    float(waves.lead[k]) - lead,
                    (float(waves.speed[k]) * p["r_c"] - state[6]) / surface,
                    float(waves.friction[k]) - force / p["mu"] / p["F_c"],
                    float(waves.input_power[k]) / powers[0] - 1,
                    (float(waves.layer_power[k]) - powers[4]) / powers[0],
                ]
            )
        )
    return found


@dataclass
class _Elements:
    """Both phases, the rim and the stress of each element (n, N) of n motions, after a time."""

    modes: Array  # (n, 4): w_A, v_A, w_B, v_B
    rim: Array  # (n,): speed
    stress: Array  # (n, N), N/m


def _depths(modes: Array, p: Values, places: Array) -> Array:
    """Of elements in a layer that carries the prepressure, (n, N), m, below 0 where it is clear, by Newton."""
    depth = modes[:, :1] * np.sin(places) + modes[:, 2:3] * np.cos(places)
    wanted = p["F_c"] * p["k_c"] / (_TURN * p["n_j"] * p["k_N"])  # mean of the depths pressed in
    height = depth.mean(axis=1, keepdims=True) - wanted
    for _ in range(60):
        pressed = np.maximum(depth - height, 0)
        step = (pressed.mean(axis=1, keepdims=True) - wanted) / (pressed > 0).mean(axis=1, keepdims=True)
        height = height + step
        if (np.abs(step) < 1e-21).all():
            break
    return np.asarray(depth - height)


def _sheared_period(p: Values, start: _Elements, count: int) -> tuple[_Elements, Array, CArray]:
    """The motions after a period; powers put in, lost in the stator, on the load, the rim's speed; the drive's wave.

    There is one step more than there are elements, so that no element sees the wave as its neighbour did.
    """
    places = _TURN * (np.arange(count) + 0.5) / count
    sine, cosine, lever = np.sin(places), np.cos(places), p["D"] * p["k_c"]
    period, own, mass = _TURN / p["omega_q"], p["omega_n0"], p["M_q"]
    h, damped, area = period / (count + 1), own * math.sqrt(1 - p["xi"] ** 2), _TURN / count * p["n_j"] / p["k_c"]
    decay, turned = math.exp(-p["xi"] * own * h), damped * h
    lag = p["xi"] / math.sqrt(1 - p["xi"] ** 2) * math.sin(turned)
    flow = decay * np.array(
        [
            [math.cos(turned) + lag, math.sin(turned) / damped],
            [-(own**2) * math.sin(turned) / damped, math.cos(turned) - lag],
        ]
    )
    modes, rim, stress = start.modes.copy(), start.rim.copy(), start.stress.copy()
    works, seen = np.zeros((4, rim.size)), np.zeros(rim.size, complex)

    def kick(t: float, half: float) -> None:
        press = p["k_N"] * np.maximum(_depths(modes, p, places), 0)
        on_A = -(press * sine).sum(axis=1) * area - lever * (stress * cosine).sum(axis=1) * area
        on_B = -(press * cosine).sum(axis=1) * area + lever * (stress * sine).sum(axis=1) * area
        drive_A, drive_B = p["F_q"] * math.cos(p["omega_q"] * t), -p["F_q"] * math.sin(p["omega_q"] * t)
        before = modes[:, 1].copy(), modes[:, 3].copy(), rim.copy()
        modes[:, 1] += half / mass * (drive_A + on_A)
        modes[:, 3] += half / mass * (drive_B + on_B)
        rim[:] += half * p["r_c"] / p["J_total"] * (p["r_c"] * stress.sum(axis=1) * area - p["T_load"])
        speeds = (modes[:, 1] + before[0]) / 2, (modes[:, 3] + before[1]) / 2, (rim + before[2]) / 2
        works[0] += half * (drive_A * speeds[0] + drive_B * speeds[1])
        works[1] += half * 2 * p["xi"] * own * mass * (speeds[0] ** 2 + speeds[1] ** 2)
        works[2] += half * p["T_load"] / p["r_c"] * speeds[2]
        works[3] += half * speeds[2]

    for k in range(count + 1):
        kick(k * h, h / 2)
        moved = np.einsum("ij,npj->npi", flow, modes.reshape(-1, 2, 2)).reshape(-1, 4)
        change = moved - modes
        sheared = lever * (change[:, :1] * cosine - change[:, 2:3] * sine) - h * rim[:, np.newaxis]
        before = _depths(modes, p, places)
        modes[:] = moved
        after = _depths(modes, p, places)
        enters = (before < 0) & (after > 0)  # and is sheared from then on
        sheared *= np.where(enters, after / np.where(enters, after - before, 1), 1)
        most = p["mu"] * p["k_N"] * np.maximum(after, 0)
        stress[:] = np.clip(stress + p["k_T"] * sheared, -most, most)
        kick((k + 1) * h, h / 2)
        seen += (modes[:, 2] + 1j * modes[:, 0]) * np.exp(-1j * p["omega_q"] * (k + 1) * h) / (count + 1)
    return _Elements(modes, rim, stress), works / period, seen


def _sheared_steady(p: Values, guess: Array, count: int) -> tuple[complex, Array]:
    """Of the motion that a period brings back: its wave as the drive sees it, powers and the rim's mean speed."""
    sizes = _SIZES[[0, 1, 2, 3, 6]]
    state, steps, stress = guess, 1e-5 * sizes, np.zeros(count)
    shifts = np.concatenate([np.zeros((1, 5)), np.diag(steps), -np.diag(steps)])
    wave, powers = 0j, np.zeros(4)
    for _ in range(25):
        states = state + shifts
        begin = _Elements(states[:, :4].copy(), states[:, 4].copy(), np.repeat(stress[np.newaxis], 11, axis=0))
        end, works, seen = _sheared_period(p, begin, count)
        gaps = np.column_stack([end.modes, end.rim]) - states
        moved = np.abs(end.stress[0] - stress).max() / (p["mu"] * p["F_c"] * p["k_c"] / p["n_j"])
        stress, powers, wave = end.stress[0], works[:, 0], complex(seen[0])
        if np.abs(gaps[0] / sizes).max() < 1e-11 and moved < 1e-10:
            break
        slopes = ((gaps[1:6] - gaps[6:]) / (2 * steps[:, np.newaxis])).T
        state = state - np.linalg.solve(slopes, gaps[0])
    return wave, powers


def shear_differences(seed: int, elements: tuple[int, ...] = _ELEMENTS) -> list[Array]:
    """At a random point, for each steady state and number of elements, (m, 6): as :func:`loss_differences`.

    Torque is what reaches the load, and the last one what slip takes.
    """
    p, found = draw(seed, "shear"), []
    waves = plain_waves(p)
    for k, size in enumerate(waves.amplitude):
        if waves.whole[k]:
            continue  # elements that never leave have a memory without end, which Newton on five numbers knows not of
        rows = []
        for count in elements:
            guess = _guessed(p, waves, k, 0.0)[[0, 1, 2, 3, 6]]
            wave, powers = _sheared_steady(p, guess, count)
            surface = p["D"] * p["k_c"] * p["omega_q"] * abs(wave)
            slip, most = powers[0] - powers[1] - powers[2], p["mu"] * p["F_c"]
            rows.append(
                [
                    size / abs(wave) - 1,
                    float(waves.lead[k]) - math.pi / 2 + float(np.angle(wave)),
                    (float(waves.speed[k]) * p["r_c"] - powers[3]) / surface,
                    (float(waves.output_power[k]) - powers[2]) / (most * surface),
                    float(waves.input_power[k]) / powers[0] - 1,
                    (float(waves.slip_power[k]) - slip) / powers[0],
                ]
            )
        found.append(np.array(rows))
    return found


def main(arguments: list[str]) -> int:
    """Compare random points, print the worst; 1 if one is off by more than 1e-6, of elements by more than 1e-5."""
    if len(arguments) != 2 or arguments[0] not in ("loss", "shear") or not arguments[1].isdecimal():
        print("loss or shear, and how many points", file=sys.stderr)
        return 2
    worst, states = np.zeros(6), 0
    coarse, fine = np.zeros(6), np.zeros(6)
    for seed in range(int(arguments[1])):
        if arguments[0] == "loss":
            for row in loss_differences(seed):
                worst, states = np.maximum(worst, np.abs(row)), states + 1
            continue
        for rows in shear_differences(seed):
            coarse, fine = np.maximum(coarse, np.abs(rows[0])), np.maximum(fine, np.abs(rows[1]))
            on = rows[1] + (rows[1] - rows[0]) / ((_ELEMENTS[1] / _ELEMENTS[0]) ** 2 - 1)
            worst, states = np.maximum(worst, np.abs(on)), states + 1
    print(f"{arguments[1]} points, {states} steady states; largest differences, relative:")
    for k, name in enumerate(_NAMES):
        more = f"   {coarse[k]:.1e} and {fine[k]:.1e} with {_ELEMENTS[0]} and {_ELEMENTS[1]} elements"
        print(f"{name:<11} {worst[k]:.1e}{more if arguments[0] == 'shear' else ''}")
    return int(not (worst < (1e-6 if arguments[0] == "loss" else 1e-5)).all())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
