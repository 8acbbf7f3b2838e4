"""One operating point to 1e-6: SciPy's LSODA run until it repeats, and ours, alone and in a batch."""

from __future__ import annotations

import math
import time

import numpy as np

import trum_sym as ts
from benchmarks.lsoda import lsoda_cycles
from benchmarks.rows import Row, cpus, measured

__all__ = ["rows"]

SECTION = "one operating point at tolerance 1e-6"
TOLERANCE = 1e-6
HEAVIER = 1000.0


def _lsoda(motor: ts.Motor, point: ts.OperatingPoint, start: float, most: int) -> tuple[float, int, bool]:
    """Seconds and cycles until LSODA's cycle mean changes by less than the tolerance of the largest speed.

    If that takes more than ``most`` cycles, what those took is extrapolated by the rate at which the changes fall;
    the last value says so.
    """
    means: list[float] = []
    begin = time.perf_counter()
    scale = max(abs(point.min_speed), abs(point.max_speed))
    for mean, _, _ in lsoda_cycles(motor, ts.Drive(), point, most, start):
        means.append(mean)
        if len(means) > 1 and abs(means[-1] - means[-2]) < TOLERANCE * scale:
            return time.perf_counter() - begin, len(means), False
    spent = time.perf_counter() - begin
    last, before = abs(means[-1] - means[-2]), abs(means[-2] - means[-3])
    if not last < before:
        return math.inf, most, True
    more = math.log(TOLERANCE * scale / last) / math.log(last / before)
    return spent * (1 + more / most), math.ceil(most + more), True


def rows(repeats: int, count: int, cycles: int) -> list[Row]:
    """Milliseconds a point; the ratio says how many times as fast as LSODA from rest, at the same inertia."""
    motor = ts.load_motor("trum60")
    found: list[Row] = []
    for factor in (1.0, HEAVIER):
        heavy = motor.with_values({"rotor_inertia": motor.rotor_inertia.value * factor})
        label = "" if factor == 1 else f", inertia x{factor:g}"
        point = ts.evaluate(heavy, ts.Drive(), tolerance=TOLERANCE)
        yardstick = 0.0
        for name, start in (("from rest", 0.0), ("from its mean", point.mean_speed)):
            times, taken, guessed = [], 0, False
            for _ in range(repeats):
                seconds, taken, guessed = _lsoda(heavy, point, start, cycles)
                times.append(seconds)
            median = float(np.median(times))
            yardstick = yardstick or median
            name = f"SciPy LSODA {name}{label}"
            if not math.isfinite(median):
                found.append(Row(SECTION, name, None, "ms", note=f"no rate of settling to be seen in {taken} cycles"))
                continue
            note = f"{taken} cycles" + (f", extrapolated from {cycles}" if guessed else "")
            spread = (max(times) - min(times)) / median
            found.append(Row(SECTION, name, 1e3 * median, "ms", spread, yardstick / median, note))
        batch = ts.Drive(prepressure=np.linspace(160, 210, count))
        for name, drive, points, processors in (
            ("ours, one point alone", ts.Drive(), 1, 1),
            (f"ours, {count} points, one processor", batch, count, 1),
            (f"ours, {count} points, two processors", batch, count, 2),
        ):
            with cpus(processors) as got:
                median, spread = measured(lambda h=heavy, d=drive: ts.evaluate(h, d, tolerance=TOLERANCE), repeats)
            each = median / points
            note = "" if got == processors else f"on {got}"
            found.append(Row(SECTION, name + label, 1e3 * each, "ms", spread, yardstick / each, note))
    return found
