"""python -m benchmarks [--json] [--quick] [--only SECTION ...]: all measurements side by side."""

from __future__ import annotations

import argparse
import json
import platform
from dataclasses import asdict

import trum_sym as ts  # noqa: F401
from benchmarks.rows import Row, cpu_name, table
from trum_sym import _kernels

SECTIONS = ("step", "peers", "point", "map", "sweep", "start", "optimise")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    parser.add_argument("--quick", action="store_true", help="small counts: shows that it runs, measures nothing")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, default=SECTIONS, help="which sections")
    parser.add_argument("--repeats", type=int, default=5, help="runs behind each median (default 5)")
    parser.add_argument("--points", type=int, default=100_000, help="of the largest map (default 100000)")
    parser.add_argument("--cycles", type=int, default=12, help="of LSODA, before its rate is extrapolated (default 12)")
    parser.add_argument("--problems", type=int, default=20, help="that the optimisers solve (default 20)")
    chosen = parser.parse_args()
    repeats = 2 if chosen.quick else max(1, chosen.repeats)
    rows: list[Row] = []
    if "step" in chosen.only:
        from benchmarks import step

        rows += step.rows(repeats)
    if "peers" in chosen.only:
        from benchmarks import orbits

        rows += orbits.rows(repeats, 64 if chosen.quick else 512)
    if "point" in chosen.only:
        from benchmarks import points

        rows += points.rows(repeats, 32 if chosen.quick else 512, 4 if chosen.quick else chosen.cycles)
    if "map" in chosen.only:
        from benchmarks import maps

        rows += maps.rows(1 if chosen.quick else min(repeats, 5), 400 if chosen.quick else chosen.points)
    if "sweep" in chosen.only:
        from benchmarks import sweep

        rows += sweep.rows(1 if chosen.quick else min(repeats, 3), 2000 if chosen.quick else chosen.points)
    if "start" in chosen.only:
        from benchmarks import cold_start

        rows += cold_start.rows(repeats)
    if "optimise" in chosen.only:
        from benchmarks import optimise

        rows += optimise.rows(2 if chosen.quick else chosen.problems)
    machine = {
        "cpu": cpu_name(),
        "instruction_sets": list(_kernels.instruction_sets()),
        "python": platform.python_version(),
        "repeats": repeats,
    }
    if chosen.json:
        print(json.dumps({**machine, "rows": [asdict(row) for row in rows]}, indent=1, ensure_ascii=False))
    else:
        print(", ".join(f"{name} {value}" for name, value in machine.items()))
        print(table(rows))


if __name__ == "__main__":
    main()
