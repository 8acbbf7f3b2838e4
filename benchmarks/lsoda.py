"""The rotor's orbit as SciPy would find it: LSODA, cycle after cycle, until it repeats."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import trum_sym as ts
from trum_sym.model.cycle import modal_values, response


def lsoda_cycles(
    motor: ts.Motor, drive: ts.Drive, point: ts.OperatingPoint, cycles: int, start: float | None = None
) -> Iterator[tuple[float, float, float]]:
    """Mean, lowest and highest rotor speed (rad/s) of cycle after cycle, begun at ``start`` or ``point``'s mean speed.

    The Winkler contact and the friction are written out anew and the load balance solved by Brent's method; only the
    modal displacements, which have their own witnesses, are the project's.
    """
    W, D, k = point.amplitude, point.neutral_axis, point.wavenumber
    J = motor.rotor_inertia.value
    modal = modal_values(2 * np.pi * point.resonance_frequency, motor.damping_ratio.value, drive)
    radius, mu, F = motor.contact_radius.value, motor.friction_coefficient.value, float(drive.prepressure)
    crests = motor.crests.value
    stiffness = motor.layer_young_modulus.value * motor.layer_width.value / motor.layer_thickness.value

    def fraction(t: float, v: float) -> float:
        state = response(t % point.cycle_time, modal)
        w_A, w_B, v_A, v_B = (W * float(state[name]) for name in ("w_A", "w_B", "v_A", "v_B"))
        height = max(np.hypot(w_A, w_B), 1e-30)
        y = F * k / (2 * crests * stiffness * height)
        full = y >= np.pi
        theta = np.pi if full else brentq(lambda a: np.sin(a) - a * np.cos(a) - y, 0, np.pi, xtol=1e-15)
        constant = y / np.pi if full else -np.cos(theta)
        speed, phase = D * k * np.hypot(v_A, v_B), np.arctan2(-(w_A * v_A + w_B * v_B), v_A * w_B - v_B * w_A)
        ratio = np.clip(v / max(speed, 1e-300), -1, 1)

        def cumulative(u: np.ndarray) -> np.ndarray:
            u = np.clip(u, -theta, theta)
            return 0.5 + (np.sin(u) + constant * u) / (2 * y)

        half = np.arccos(ratio)
        turns = 2 * np.pi * np.arange(-1, 2)
        return 2 * np.sum(cumulative(phase + half + turns) - cumulative(phase - half + turns)) - 1

    push, drag = radius**2 * mu * F / J, radius * float(drive.load_torque) / J
    v = (point.mean_speed if start is None else start) * radius
    for _ in range(cycles):
        steps = solve_ivp(
            lambda t, y: [push * fraction(t, y[0]) - drag, y[0]],
            (0, point.cycle_time),
            [v, 0.0],
            "LSODA",
            rtol=1e-8,
            atol=1e-10,
            max_step=point.cycle_time / (60 * drive.periods),
        )
        v = steps.y[0, -1]
        yield steps.y[1, -1] / point.cycle_time / radius, steps.y[0].min() / radius, steps.y[0].max() / radius
