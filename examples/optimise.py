"""A gimbal's question: 633 arcsec/s with the least volatility, in the paper's box.

At the paper's load and at a third of it; what 10 % of friction or of load do to the answer; and from which friction, or
up to which load, there is one.

python examples/optimise.py
"""

from __future__ import annotations

from scipy.optimize import brentq
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC

TARGET = "633 arcsec/s"


def row(motor: ts.Motor, load: float, label: str) -> tuple[object, ...]:
    """One answer."""
    found = ts.optimize(motor, ts.Drive(load_torque=load), target_speed=TARGET)
    if found.status != "solved":
        low, high = (f"{speed / ARCSEC:.4g}" for speed in found.evidence.reachable_speed)
        return label, found.status, "-", "-", "-", "-", f"speeds {low} to {high} arcsec/s"
    swing = (found.figures["max_speed"] - found.figures["min_speed"]) / ARCSEC
    margin = found.figures["stall_torque"] - load
    optima = len(found.evidence.optima)
    return (
        label,
        found.status,
        f"{found.prepressure:.2f}",
        f"{found.frequency_difference:.1f}",
        f"{100 * found.speed_volatility:.4g}",
        f"{margin:+.4f}",
        f"swing {swing:.3g} arcsec/s, local optima {optima}",
    )


def edge(motor: ts.Motor, load: float, name: str, low: float, high: float) -> float:
    """The friction or the load at which the fastest point of the box turns at the target speed."""

    def excess(value: float) -> float:
        changed = motor.with_values({name: value}) if name == "friction_coefficient" else motor
        drive = ts.Drive(load_torque=value if name == "load_torque" else load)
        found = ts.optimize(changed, drive, objective="-1 * mean_speed")
        return found.mean_speed - 633 * ARCSEC

    return float(brentq(excess, low, high, xtol=2e-4))


def main() -> None:
    """Print the table."""
    motor = ts.load_motor("trum60")
    friction = float(motor.friction_coefficient.value)
    rows = []
    for load in (0.3, 0.1):
        rows.append(row(motor, load, f"load {load} N m"))
        for factor in (0.9, 1.1):
            slippery = motor.with_values({"friction_coefficient": friction * factor})
            rows.append(row(slippery, load, f"  friction {100 * (factor - 1):+.0f} %"))
        rows.extend(row(motor, load * factor, f"  load {100 * (factor - 1):+.0f} %") for factor in (0.9, 1.1))
    headers = ("", "", "F_c N", "df Hz", "sigma_s %", "stall - load N m", "")
    print(f"Least volatility at {TARGET}, 160 to 210 N, 2800 to 3300 Hz, 14 of 20 periods on\n")
    print(tabulate(rows, headers, disable_numparse=True, colalign=("left", "left", *["right"] * 4, "left")))
    least, most = edge(motor, 0.3, "friction_coefficient", 0.15, 0.3), edge(motor, 0.3, "load_torque", 0.3, 0.5)
    print(f"\nAt 0.3 N m there is an answer from a friction coefficient of {least:.3f};")
    print(f"with a friction coefficient of {friction:g}, up to a load of {most:.3f} N m.")


if __name__ == "__main__":
    main()
