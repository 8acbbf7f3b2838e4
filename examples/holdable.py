"""The operating points that are the most holdable in open loop, at five slow speeds, over all that the hardware allows.

For the motor from rest with phase lead -1 and a heavy torque plate, and at one of the speeds for the one that keeps
running without a load's inertia; beside them the least volatility at the same speeds in the paper's box, and the drive
of Table 3.

    python examples/holdable.py
"""

from __future__ import annotations

from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC

SPEEDS = (1.0, 10.0, 100.0, 633.0, 1000.0)  # arcsec/s
HEAVY, LIGHT = ts.Drive(start="rest", phase_lead=-1, load_inertia=4e-3), ts.Drive()


def drift(found: ts.Optimum) -> float:
    """What all spreads together move the mean speed by, arcsec/s."""
    return found.holding.drift / ARCSEC


def row(motor: ts.Motor, drive: ts.Drive, speed: float) -> tuple[str, ...]:
    """The most holdable point, and the plain optimum's drift."""
    target = speed * ARCSEC
    widest = {name: (allowed.low, allowed.high) for name, allowed in motor.allowed.items()}
    best = ts.optimize(motor, drive, objective="drift", target_speed=target, bounds=widest)
    plain = ts.optimize(motor, drive, target_speed=target)
    beside = f"{drift(plain):.4g}" if plain.status == "solved" else "none"
    better = f"{drift(plain) / drift(best):.2f}" if plain.status == "solved" else ""
    largest = max(best.holding.drifts, key=lambda name: abs(best.holding.drifts[name]))
    return (
        f"{drive.start} {drive.phase_lead:+g}",
        f"{speed:g}",
        f"{best.prepressure:.2f}",
        f"{best.frequency_difference:.1f}",
        f"{drift(best):.4g}",
        f"{100 * drift(best) / speed:.3g}",
        f"{abs(best.holding.drifts[largest]) / ARCSEC:.4g} by {largest.replace('_', ' ')}",
        f"{100 * best.holding.encoder_volatility:.4g}",
        beside,
        better,
    )


def main() -> None:
    """Print the table."""
    motor = ts.load_motor("trum60")
    rows = [*(row(motor, HEAVY, speed) for speed in SPEEDS), row(motor, LIGHT, 633.0)]
    spreads = "1 N, 1 Hz, 1 % of friction, load and amplitude"
    print(f"Least drift by {spreads}; 0.3 N m, 100 to 220 N, 1000 to 5000 Hz, 14 of 20 periods on\n")
    head = ("reading", "arcsec/s", "F_c N", "df Hz", "drift", "% of speed", "largest", "encoder %", "plain", "times")
    print(tabulate(rows, head, disable_numparse=True, colalign=("left", *["right"] * 9)))
    print("\ndrifts in arcsec/s; plain: of the least volatility in the paper's box, and how many times as much")
    for drive in (HEAVY, LIGHT):
        at = ts.holding(motor, drive)
        speed, by = at.mean_speed / ARCSEC, at.drift / ARCSEC
        print(f"Table 3's drive, {drive.start} {drive.phase_lead:+g}: {speed:.4g} arcsec/s, drift {by:.4g} arcsec/s")


if __name__ == "__main__":
    main()
