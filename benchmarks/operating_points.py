"""Operating points of the rotor: ours in a batch, on one and two threads, beside SciPy's LSODA.

python -m benchmarks.operating_points
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

import trum_sym as ts
from benchmarks.lsoda import lsoda_cycles
from trum_sym import _kernels, rotor

COUNT = 512
TOLERANCE = 1e-6


def seconds(run: Callable[[], object], repeats: int = 5) -> tuple[float, float]:
    """Median and spread of the wall time."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return statistics.median(times), max(times) - min(times)


def lsoda_seconds(motor: ts.Motor, start: ts.OperatingPoint) -> tuple[float, int]:
    """Time and cycles until LSODA's cycle mean changes by less than the tolerance of the largest speed."""
    before, begin = np.inf, time.perf_counter()
    cycles = 0
    for mean, low, high in lsoda_cycles(motor, ts.Drive(), start, 100):
        cycles += 1
        if abs(mean - before) < TOLERANCE * max(abs(low), abs(high)):
            break
        before = mean
    return time.perf_counter() - begin, cycles


def main() -> None:
    """Measure and print."""
    motor = ts.load_motor("trum60")
    drive = ts.Drive(prepressure=np.linspace(160, 210, COUNT))
    single = ts.Drive()
    point = ts.evaluate(motor, single, tolerance=TOLERANCE)
    by_scipy, cycles = lsoda_seconds(motor, point)
    print(f"instruction sets {_kernels.instruction_sets()}, tolerance {TOLERANCE:g}, TRUM-60 around Table 3")
    print(f"SciPy LSODA, one point, {cycles} cycles from its mean speed   {1000 * by_scipy:10.1f} ms per point")
    threads = rotor.os.cpu_count
    for label, settings, count, workers in (
        ("one point alone", single, 1, 1),
        (f"{COUNT} points, one thread", drive, COUNT, 1),
        (f"{COUNT} points, two threads", drive, COUNT, 2),
    ):
        rotor.os.cpu_count = lambda workers=workers: workers
        median, spread = seconds(lambda settings=settings: ts.evaluate(motor, settings, tolerance=TOLERANCE))
        each = median / count
        print(f"{label:50} {1000 * each:16.2f} ms per point, +-{100 * spread / median:.0f} %, {by_scipy / each:5.0f}x")
    rotor.os.cpu_count = threads
    for inertia in (4.5e-6, 4.5e-3):
        heavy = motor.with_values({"rotor_inertia": inertia})
        median, _ = seconds(lambda heavy=heavy: ts.evaluate(heavy, drive, tolerance=TOLERANCE), 3)
        print(f"inertia {inertia:g} kg m^2, all threads {1000 * median / COUNT:37.2f} ms per point")


if __name__ == "__main__":
    main()
