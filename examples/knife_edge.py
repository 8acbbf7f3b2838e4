"""How sharp the optimum at 633 arcsec/s is, by the load's inertia and by what gives in the contact.

From rest with phase lead -1, the reading nearest to the paper's determinants, and for the motor that keeps running.

    python examples/knife_edge.py
"""

from __future__ import annotations

from dataclasses import replace

from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.levels import COMPLIANCES, Compliance

TARGET = "633 arcsec/s"
INERTIAS = (0.0, 2.7e-4, 1e-3, 4e-3)  # kg m^2: none, the motor file's torque plate, and heavier ones


def row(motor: ts.Motor, drive: ts.Drive, compliance: Compliance) -> tuple[object, ...]:
    """The optimum, and what its speed does when one thing is a little off."""
    found = ts.optimize(motor, drive, target_speed=TARGET, compliance=compliance)
    name = f"{drive.start} {drive.phase_lead:+g}", compliance, f"{drive.load_inertia:g}"
    if found.status != "solved":
        low, high = (f"{speed / ARCSEC:.3g}" for speed in found.evidence.reachable_speed)
        return *name, "none", "", f"{low} to {high}", "", "", "", ""
    at = replace(drive, prepressure=found.prepressure, frequency_difference=found.frequency_difference)
    slopes = ts.sensitivities(motor, at, tolerance=1e-9, compliance=compliance)["mean_speed"]
    friction = float(motor.friction_coefficient.value)
    swing = (found.figures["max_speed"] - found.figures["min_speed"]) / ARCSEC
    drifts = (
        slopes["prepressure"],
        slopes["frequency_difference"],
        0.01 * friction * slopes["friction_coefficient"],
        0.01 * drive.load_torque * slopes["load_torque"],
    )
    return (
        *name,
        f"{found.prepressure:.2f}",
        f"{found.frequency_difference:.1f}",
        f"{swing:.3g}",
        *(f"{drift / ARCSEC:+.3g}" for drift in drifts),
    )


def main() -> None:
    """Print the table."""
    motor = ts.load_motor("trum60")
    rows = [
        row(motor, ts.Drive(start=start, phase_lead=lead, load_inertia=inertia), compliance)
        for start, lead in (("periodic", 1), ("rest", -1))
        for compliance in COMPLIANCES
        for inertia in INERTIAS
    ]
    print(f"Least volatility at {TARGET}, 0.3 N m, 160 to 210 N, 2800 to 3300 Hz, 14 of 20 periods on\n")
    head = (
        "reading",
        "gives",
        "load kg m^2",
        "F_c N",
        "df Hz",
        "swing",
        "by 1 N",
        "by 1 Hz",
        "by 1 % mu",
        "by 1 % load",
    )
    print(tabulate(rows, head, disable_numparse=True, colalign=("left", "left", *["right"] * 8)))
    print("\nswing and drifts of the mean in arcsec/s; none: the box's speeds, which leave the target out")


if __name__ == "__main__":
    main()
