"""From the first keystroke: whole processes of ``trum-sym`` beside the import of NumPy and of the tools behind it.

python -m benchmarks --only start
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time

from benchmarks.rows import Row

__all__ = ["rows"]

COMMANDS = {
    "trum-sym --help": ["-m", "trum_sym", "--help"],
    "trum-sym evaluate": ["-m", "trum_sym", "evaluate"],
    "trum-sym evaluate --json": ["-m", "trum_sym", "evaluate", "--json"],
    "python -c pass": ["-c", "pass"],
    "import numpy": ["-c", "import numpy"],
    "import click": ["-c", "import click"],
    "import sympy, casadi": ["-c", "import sympy, casadi"],
}


def _run(arguments: list[str], surroundings: dict[str, str]) -> tuple[float, float]:
    """Wall and processor time of a process in s."""
    begin = time.perf_counter()
    quiet = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    child = os.posix_spawn(sys.executable, [sys.executable, *arguments], surroundings, file_actions=quiet)
    _, status, used = os.wait4(child, 0)
    if status:
        raise RuntimeError(f"{' '.join(arguments)} ended with {status}")
    return time.perf_counter() - begin, used.ru_utime + used.ru_stime


def rows(repeats: int) -> list[Row]:
    """Wall time of whole processes; the ratio is of the least processor times, to that of ``import numpy``.

    Bytecode is kept, as an installed package has it, whatever the surroundings say.
    """
    seen: dict[str, list[tuple[float, float]]] = {name: [] for name in COMMANDS}
    with tempfile.TemporaryDirectory() as kept:
        surroundings = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        surroundings["PYTHONPYCACHEPREFIX"] = kept
        for arguments in COMMANDS.values():  # which compiles
            _run(arguments, surroundings)
        for _ in range(2 * repeats):  # interleaved, so that a busy moment hits all
            for name, arguments in COMMANDS.items():
                seen[name].append(_run(arguments, surroundings))
    least = {name: min(used for _, used in times) for name, times in seen.items()}
    found = []
    for name, times in seen.items():
        walls = [wall for wall, _ in times]
        median = statistics.median(walls)
        note = f"least processor time {1e3 * least[name]:.0f} ms"
        spread = (max(walls) - min(walls)) / median
        found.append(Row("start-up", name, 1e3 * median, "ms", spread, least[name] / least["import numpy"], note))
    return found
