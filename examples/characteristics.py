"""Plain-wave characteristics of three motors at their stated values and over what is assumed, beside what is published.

    python examples/characteristics.py

Nothing is fitted: amplitude, friction, contact radius and flange are drawn from the ranges of the motor files.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.stats import qmc
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.plausible import unquestioned

RPM = 30 / np.pi
SHARES = (0.0, 0.49, 0.56)
VARIED = (
    "friction_coefficient",
    "contact_radius",
    "flange_thickness",
    "flange_length",
    "layer_young_modulus",
    "layer_thickness",
    "layer_width",
    "free_amplitude",
    "amplitude",
)
# drive, and what is published of no-load speed (rpm), stall (N m), speed at 49 and 56 % of stall over that without load
MOTORS = {
    "trum60": ({"prepressure": 180.0}, ("", "", "", "")),
    "dual60": ({"prepressure": 180.0}, ("120", "0.8", "", "0.45")),
    "ring60": ({"prepressure": 170.0}, ("161.8 (41 kHz)", "1.02", "0.65", "")),
}
LEVELS = ({}, {"tangential": "brush"}, {"compliance": "flange"}, {"compliance": "flange", "tangential": "brush"})


def figures(motor: ts.Motor, drive: Mapping[str, Any], levels: Mapping[str, Any]) -> tuple[np.ndarray, ...]:
    """No-load speed in rpm, stall in N m, speeds at shares of stall over that without load; arrays as the motor is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        stall = np.asarray(ts.evaluate(motor, ts.Drive(**drive), tolerance=1e-5, **levels).stall_torque)
        loads = np.multiply.outer(SHARES, stall)
        speed = np.asarray(
            ts.evaluate(motor, ts.Drive(**{**drive, "load_torque": loads}), tolerance=1e-5, **levels).mean_speed
        )
    return RPM * speed[0], stall, speed[1] / speed[0], speed[2] / speed[0]


def drawn(motor: ts.Motor, drive: Mapping[str, Any], count: int = 64) -> tuple[ts.Motor, dict[str, Any]]:
    """The motor with every varied parameter that has a range drawn from it, and prepressures 20 % to either side."""
    ranges = {name: getattr(motor, name).range for name in VARIED if getattr(motor, name) is not None}
    ranges = {name: ends for name, ends in ranges.items() if ends is not None}
    unit = qmc.Sobol(len(ranges) + 1, seed=0).random(count).T
    values = {
        name: low + share * (high - low) for (name, (low, high)), share in zip(ranges.items(), unit, strict=False)
    }
    with unquestioned():
        return motor.with_values(values), {**drive, "prepressure": drive["prepressure"] * (0.8 + 0.4 * unit[-1])}


def main() -> None:
    """Print no-load speed, stall and droop of every motor and model."""
    rows = []
    for name, (force, published) in MOTORS.items():
        motor = ts.load_motor(name)
        drive = {"frequency_difference": 500.0, "on_periods": 20, "load_torque": 0.0, **force}
        for levels in LEVELS:
            stated = figures(motor, drive, levels)
            label = f"{levels.get('compliance', 'layer')}, {levels.get('tangential', 'rigid')}"
            rows.append((name, label, *(f"{float(value):.3g}" for value in stated)))
        spread = figures(*drawn(motor, drive), {"compliance": "flange"})
        with np.errstate(all="ignore"):
            ends = (np.nanpercentile(value, (5, 95)) for value in spread)
        rows.append((name, "flange, rigid, 5 to 95 %", *(f"{low:.3g} to {high:.3g}" for low, high in ends)))
        rows.append((name, "published", *published))
    print(
        tabulate(
            rows, ("motor", "model", "no load, rpm", "stall, N m", "at 49 % of stall", "at 56 %"), disable_numparse=True
        )
    )


def more() -> None:
    """Stall against amplitude, and how far the no-load speed falls from 41 to 44 kHz."""
    amplitudes = np.array([1e-6, 1.5e-6, 2e-6, 3e-6, 5e-6])
    rows = []
    for name, (force, _) in MOTORS.items():
        drive = ts.Drive(frequency_difference=500.0, on_periods=20, load_torque=0.0, **force)
        motor = ts.load_motor(name)
        with unquestioned():
            point = ts.evaluate(
                motor.with_values({"amplitude": amplitudes}), drive, tolerance=1e-5, compliance="flange"
            )
        rows.append((name, *(f"{stall:.3g}" for stall in point.stall_torque)))
    print(tabulate(rows, ("stall, N m, at", *(f"{1e6 * W:g} um" for W in amplitudes)), disable_numparse=True))
    print()
    rows = []
    for name, published in (("trum60", ""), ("ring60", "11.8 (its model)")):
        motor, force = ts.load_motor(name), MOTORS[name][0]
        difference = np.array([41e3, 44e3]) - 39e3
        for _ in range(60):  # the resonance under prepressure follows the forced amplitude
            drive = ts.Drive(frequency_difference=difference, on_periods=20, load_torque=0.0, **force)
            point = ts.evaluate(motor, drive, tolerance=1e-5, amplitude="forced", compliance="flange")
            difference = np.array([41e3, 44e3]) - np.asarray(point.resonance_frequency)
        speed = RPM * np.asarray(point.mean_speed)
        rows.append((name, *(f"{v:.3g}" for v in speed), f"{speed[0] / speed[1]:.3g}", published))
    print(tabulate(rows, ("motor", "41 kHz, rpm", "44 kHz, rpm", "falls by", "published"), disable_numparse=True))


if __name__ == "__main__":
    main()
    print()
    more()
