"""Cold start of ``trum-sym evaluate`` beside the import of the tools it was derived with.

python -m benchmarks --only start
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time

from benchmarks.rows import Row

__all__ = ["rows"]

COMMANDS = {
    "trum-sym evaluate": ["-m", "trum_sym", "evaluate"],
    "trum-sym evaluate --json": ["-m", "trum_sym", "evaluate", "--json"],
    "import numpy": ["-c", "import numpy"],
    "import sympy, casadi": ["-c", "import sympy, casadi"],
}


def rows(repeats: int) -> list[Row]:
    """Wall time of whole processes; the ratio says how many times as fast as the import of SymPy and CasADi."""
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(repeats):  # interleaved, so that a busy moment hits all
        for name, arguments in COMMANDS.items():
            begin = time.perf_counter()
            subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL, check=True, cwd=os.sep)
            times[name].append(time.perf_counter() - begin)
    slowest = statistics.median(times["import sympy, casadi"])
    found = []
    for name, seen in times.items():
        median = statistics.median(seen)
        found.append(Row("cold start", name, 1e3 * median, "ms", (max(seen) - min(seen)) / median, slowest / median))
    return found
