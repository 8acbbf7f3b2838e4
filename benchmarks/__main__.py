"""python -m benchmarks [--json] [--quick] [--only SECTION ...]: all measurements side by side."""

from __future__ import annotations

import argparse
import json
import platform
from dataclasses import asdict
from importlib import import_module

import trum_sym as ts  # noqa: F401
from benchmarks.rows import Row, cpu_name, table
from trum_sym import _kernels

SECTIONS = ("step", "peers", "point", "map", "sweep", "start", "optimise", "coupled")


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
    quick, once = chosen.quick, 1 if chosen.quick else 0
    modules = {
        "step": ("step", (repeats,)),
        "peers": ("orbits", (repeats, 64 if quick else 512)),
        "point": ("points", (repeats, 32 if quick else 512, 4 if quick else chosen.cycles)),
        "map": ("maps", (once or min(repeats, 5), 400 if quick else chosen.points)),
        "sweep": ("sweep", (once or min(repeats, 3), 2000 if quick else chosen.points)),
        "start": ("cold_start", (repeats,)),
        "optimise": ("optimise", (2 if quick else chosen.problems,)),
        "coupled": ("coupled", (repeats,)),
    }
    rows: list[Row] = []
    for section, (module, how) in modules.items():
        if section in chosen.only:
            rows += import_module(f"benchmarks.{module}").rows(*how)
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
