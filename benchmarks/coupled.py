"""An orbit of phases, contact and rotor as one system: LSODA on equations that Numba has compiled, and ours.

The forces of the contact are written out anew, by the integrals of pressure between the places where it ends and where
slip turns round; the rotor has a mass.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping

import numpy as np
from numba import njit
from scipy.integrate import odeint

import trum_sym as ts
from benchmarks.rows import Row, least
from trum_sym.model.coupled_orbit import CoupledOrbit, lap_values, laps, orbit_from, start_of
from trum_sym.model.levels import Levels

__all__ = ["lsoda_lap", "rows"]

SECTION = "an orbit with the rotor's reaction on the wave, to 1e-6 of the largest speed"
TOLERANCE = 1e-6
_MASS = 0.02  # kg
_NAMES = [
    "M_q",
    "omega_n0",
    "xi",
    "F_q",
    "omega_q",
    "D",
    "k_c",
    "k_N",
    "n_j",
    "mu",
    "F_c",
    "r_c",
    "T_load",
    "J_total",
    "mass",
    "force_phase",
    "s",
]


@njit(cache=True)
def _within(low, high, w, z):
    """Integrals of w cos u - z, alone and times cos u and sin u, between two angles."""
    a, b, c, d = math.sin(low), math.sin(high), math.cos(low), math.cos(high)
    whole = w * (b - a) - z * (high - low)
    cosine = w * ((high - low) + b * d - a * c) / 2 - z * (b - a)
    sine = w * (b * b - a * a) / 2 + z * (d - c)
    return whole, cosine, sine


@njit(cache=True)
def _rates(y, t, p, g_A, g_B, rate):
    w_A, v_A, w_B, v_B, z, climb, v = y[0], y[1], y[2], y[3], y[4], y[5], y[6]
    lever = p[5] * p[6]
    w, angle = math.hypot(w_A, w_B), math.atan2(w_A, w_B)
    theta = 0.0 if z >= w else math.pi if z <= -w else math.acos(z / w)
    normal, press_c, _ = _within(-theta, theta, w, z)
    # the surface's speed at u from the crest is fast cos(u - top)
    along, across = v_A * math.cos(angle) - v_B * math.sin(angle), -v_A * math.sin(angle) - v_B * math.cos(angle)
    fast, top = lever * math.hypot(along, across), math.atan2(across, along)
    half = 0.0 if v >= fast else math.pi if v <= -fast else math.acos(v / fast)
    zone, zone_c, zone_s = 0.0, 0.0, 0.0
    for turn in (-2 * math.pi, 0.0, 2 * math.pi):
        low, high = max(-theta, top - half + turn), min(theta, top + half + turn)
        if high > low:
            one, c, s = _within(low, high, w, z)
            zone, zone_c, zone_s = zone + one, zone_c + c, zone_s + s
    size = p[7] * p[8] / p[6]
    drag, drag_c, drag_s = (
        p[9] * size * (2 * zone - normal),
        p[9] * size * (2 * zone_c - press_c),
        p[9] * size * 2 * zone_s,
    )
    sin_a, cos_a = math.sin(angle), math.cos(angle)
    on_A = g_A * p[3] * math.cos(p[4] * t + p[15])
    on_B = -g_B * p[16] * p[3] * math.sin(p[4] * t + p[15])
    of_A = on_A - size * press_c * sin_a - lever * (drag_c * cos_a - drag_s * sin_a)
    of_B = on_B - size * press_c * cos_a + lever * (drag_s * cos_a + drag_c * sin_a)
    rate[0], rate[1] = v_A, of_A / p[0] - 2 * p[2] * p[1] * v_A - p[1] * p[1] * w_A
    rate[2], rate[3] = v_B, of_B / p[0] - 2 * p[2] * p[1] * v_B - p[1] * p[1] * w_B
    rate[4], rate[5] = climb, (size * normal - p[10]) / p[14]
    rate[6] = p[11] * (p[11] * drag - p[12]) / p[13]
    rate[7] = v


def lsoda_lap(values: Mapping[str, float], start: np.ndarray, tolerance: float) -> tuple[np.ndarray, float]:
    """The state (7,) a drive cycle after one, and the rim's mean speed, by SciPy's LSODA."""
    p = np.array([values[name] for name in _NAMES])
    periods, period = int(values["m"]), 2 * math.pi / values["omega_q"]
    speed = values["size"] * values["omega_n0"]
    sizes = np.array([values["size"], speed] * 3 + [values["D"] * values["k_c"] * speed])
    allowed = tolerance * np.append(sizes, sizes[6] * period)
    rate, state = np.empty(8), np.append(start, 0.0)
    for k in range(periods):
        g_A, g_B = (float(not values[f"off_{name}"] <= k < values[f"on_{name}"]) for name in "AB")

        def rates(y: np.ndarray, t: float, a: float = g_A, b: float = g_B) -> np.ndarray:
            _rates(y, t, p, a, b, rate)
            return rate

        state = odeint(rates, state, [0.0, period], rtol=0.0, atol=allowed, hmax=period / 20, mxstep=10**6)[-1]
    return state[:7], float(state[7] / (periods * period))


def _needed(values: Mapping[str, float], orbit: CoupledOrbit) -> int:
    """Laps from both phases' steady swing until a lap's mean is the orbit's to the tolerance; they are ours."""
    state, top = start_of("steady", values)[:, np.newaxis], max(abs(orbit.min_speed), abs(orbit.max_speed))
    fine = {**values, "tolerance": 1e-9}
    for count in range(1, 1000):
        state, found = laps(fine, state)
        if abs(found["mean"][0] / values["r_c"] - orbit.mean_speed) < TOLERANCE * top:
            return count
    raise RuntimeError("laps do not come to the orbit")


def _accurate(values: Mapping[str, float], orbit: CoupledOrbit) -> tuple[float, float]:
    """The coarsest tolerance by tens at which LSODA's lap has the mean to 1e-6, and how far it is off."""
    top = max(abs(orbit.min_speed), abs(orbit.max_speed))
    for tolerance in 10.0 ** -np.arange(5, 12):
        off = abs(lsoda_lap(values, orbit.state, tolerance)[1] / values["r_c"] - orbit.mean_speed) / top
        if off < TOLERANCE:
            return float(tolerance), float(off)
    raise RuntimeError("LSODA does not come to the orbit's mean speed")


def rows(repeats: int) -> list[Row]:
    """Milliseconds an orbit at Table 3; ratios are to an orbit of a prescribed wave, and of LSODA to ours."""
    motor, found = ts.load_motor(), []
    for label in ("layer", "flange"):
        levels = Levels(compliance=label)
        values = lap_values(motor, ts.Drive(), levels, rotor_mass=_MASS, tolerance=TOLERANCE)
        orbit = orbit_from({**values, "wanted": TOLERANCE / 10}, start_of("steady", values), "steady")
        start = start_of("steady", values)
        prescribed, spread = least(lambda c=label: ts.evaluate(motor, compliance=c, tolerance=TOLERANCE), 3 * repeats)
        found.append(Row(SECTION, f"prescribed wave, {label}", 1e3 * prescribed, "ms", spread, 1.0, "with bounds"))
        ours, spread = least(lambda v=values, s=start: orbit_from(v, s, "steady"), 3 * repeats)
        note = f"errors estimated, {prescribed and ours / prescribed:.1f} x the prescribed wave's time"
        found.append(Row(SECTION, f"coupled, {label}, {_MASS} kg", 1e3 * ours, "ms", spread, prescribed / ours, note))
        tolerance, off = _accurate(values, orbit)
        begin = time.process_time()
        lsoda_lap(values, orbit.state, tolerance)
        lap, needed = time.process_time() - begin, _needed(values, orbit)
        whole = lap * needed
        note = f"{needed} laps of {1e3 * lap:.0f} ms at {tolerance:.0e}, off by {off:.0e}; {whole / ours:.0f} x ours"
        found.append(
            Row(SECTION, f"LSODA, right-hand side by Numba, {label}", 1e3 * whole, "ms", 0.0, prescribed / whole, note)
        )
    return found
