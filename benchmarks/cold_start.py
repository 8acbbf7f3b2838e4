"""Cold start of ``trum-sym evaluate`` beside the import of the tools it was derived with.

python -m benchmarks.cold_start
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time

COMMANDS = {
    "trum-sym evaluate": ["-m", "trum_sym.console", "evaluate"],
    "trum-sym evaluate --json": ["-m", "trum_sym.console", "evaluate", "--json"],
    "import numpy": ["-c", "import numpy"],
    "import sympy, casadi": ["-c", "import sympy, casadi"],
}


def main(repeats: int = 15) -> None:
    """Measure and print."""
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(repeats):  # interleaved, so that a busy moment hits all
        for name, arguments in COMMANDS.items():
            begin = time.perf_counter()
            subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL, check=True, cwd=os.sep)
            times[name].append(time.perf_counter() - begin)
    slowest = statistics.median(times["import sympy, casadi"])
    for name, found in times.items():
        median = statistics.median(found)
        print(
            f"{name:26} {1000 * median:6.0f} ms  (min {1000 * min(found):4.0f})  {median / slowest:5.2f} of the import"
        )


if __name__ == "__main__":
    main()
