"""Table 4's determinants for every start and phase lead, and the trends of Figs. 21 and 23.

    python examples/table4.py

Nothing is tuned: the rows are the readings that the paper leaves open.
"""

from __future__ import annotations

import numpy as np
from tabulate import tabulate

import trum_sym as ts

PAPER = {"q_average": 1447.5, "q_volatility": 3446.4}
STARTS = ("periodic", "steady", "rest")


def trend(values: np.ndarray) -> str:
    """One word for how a curve runs."""
    steps = np.diff(values)
    return "rises" if np.all(steps > 0) else "falls" if np.all(steps < 0) else "mixed"


def main() -> None:
    """Print both tables."""
    motor = ts.load_motor("trum60")
    motors = {"model": motor, "39703 Hz": motor.with_values({"resonance_frequency": 39703.0})}
    rows = []
    for start in STARTS:
        for lead in (1, -1):
            for label, machine in motors.items():
                point = ts.evaluate(machine, ts.Drive(start=start, phase_lead=lead))
                found = [getattr(point, name) for name in PAPER]
                difference = [100 * (value / paper - 1) for value, paper in zip(found, PAPER.values(), strict=True)]
                rows.append((start, f"{lead:+d}", label, found[0], difference[0], found[1], difference[1]))
    headers = ("start", "lead", "f_n", "Q_aver 1/s", "off %", "Q_vib 1/s", "off %")
    print("Table 3's drive; Table 4 prints Q_aver = 1447.5, Q_vib = 3446.4\n")
    print(tabulate(rows, headers, floatfmt=("", "", "", ".2f", "+.2f", ".2f", "+.2f")))

    differences, forces = np.linspace(2800, 3300, 11), np.linspace(160, 210, 11)
    rows = []
    for start in STARTS:
        for lead in (1, -1):
            by_difference = ts.evaluate(motor, ts.Drive(start=start, phase_lead=lead, frequency_difference=differences))
            by_force = ts.evaluate(motor, ts.Drive(start=start, phase_lead=lead, prepressure=forces))
            curves = (by_difference.q_average, by_difference.q_volatility, by_force.q_average, by_force.q_volatility)
            rows.append((start, f"{lead:+d}", *map(trend, curves)))
    rows.append(("paper", "", "falls", "rises", "rises", "falls"))
    print("\nTrends: frequency difference 2800 to 3300 Hz at 180 N; prepressure 160 to 210 N at 3000 Hz\n")
    print(tabulate(rows, ("start", "lead", "Q_aver(df)", "Q_vib(df)", "Q_aver(F_c)", "Q_vib(F_c)")))


if __name__ == "__main__":
    main()
