"""One measurement as a row; how it is timed and shown."""

from __future__ import annotations

import os
import platform
import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Row", "cpu_name", "cpus", "least", "measured", "table"]


@dataclass(frozen=True)
class Row:
    """A figure: median, or the least processor time, in ``unit``, None if there is none; spread (largest less smallest)
    as a share of it; ratio to its section's yardstick.
    """

    section: str
    name: str
    value: float | None
    unit: str
    spread: float = 0.0
    ratio: float | None = None
    note: str = ""


def measured(run: Callable[[], object], repeats: int) -> tuple[float, float]:
    """Median wall time in s and the spread as a share of it, after one run that does not count."""
    run()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    median = statistics.median(times)
    return median, (max(times) - min(times)) / median


def least(run: Callable[[], object], repeats: int) -> tuple[float, float]:
    """The least processor time of some runs in s, after one that does not count, and how far the most is above it.

    It hardly depends on what else the machine does, and so is what ratios are made of.
    """
    run()
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        run()
        times.append(time.process_time() - begin)
    return min(times), max(times) / min(times) - 1


@contextmanager
def cpus(count: int) -> Iterator[int]:
    """Run on the first ``count`` processors only; yields how many there are."""
    if not hasattr(os, "sched_setaffinity"):
        yield os.cpu_count() or 1
        return
    before = os.sched_getaffinity(0)
    chosen = set(sorted(before)[:count])
    os.sched_setaffinity(0, chosen)
    try:
        yield len(chosen)
    finally:
        os.sched_setaffinity(0, before)


def cpu_name() -> str:
    """As the system names it."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def table(rows: list[Row]) -> str:
    """Section by section, the ratio first."""
    from tabulate import tabulate

    texts = []
    for section in dict.fromkeys(row.section for row in rows):
        shown = [
            (
                "" if row.ratio is None else f"{row.ratio:.3g} x",
                row.name,
                "-" if row.value is None else f"{row.value:.4g} {row.unit}",
                "" if row.value is None else f"{100 * row.spread:.0f} %",
                row.note,
            )
            for row in rows
            if row.section == section
        ]
        columns = ("ratio", "", "measured", "spread", "")
        texts.append(f"{section}\n\n" + tabulate(shown, columns, disable_numparse=True, colalign=("right",)))
    return "\n\n".join(texts)
