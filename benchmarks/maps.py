"""A map over prepressure and frequency difference at the default tolerance: time, memory, growth."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np

from benchmarks.rows import Row

__all__ = ["rows"]

SECTION = "a map over prepressure and frequency difference, default tolerance"
# In a process of its own, so that the peak memory is the map's
MAP = """
import json, resource, sys, time
import numpy as np
import trum_sym as ts
across, down, factor = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
motor = ts.load_motor("trum60")
motor = motor.with_values({"rotor_inertia": motor.rotor_inertia.value * factor})
ts.evaluate(motor)
def most():  # Linux: ru_maxrss would keep the peak of the process that started this one
    if sys.platform == "linux":
        return 1024 * int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
before = most()
drive = ts.Drive(prepressure=np.linspace(120, 220, across), frequency_difference=np.linspace(1000, 5000, down)[:, None])
begin = time.perf_counter()
point = ts.evaluate(motor, drive)
seconds = time.perf_counter() - begin
peak = most()
print(json.dumps([seconds, peak, peak - before, float(point.converged.mean())]))
"""


def _run(across: int, down: int, factor: float, repeats: int) -> tuple[float, float, list[float]]:
    """Median seconds, its spread, and the last run's peak memory, its growth (bytes) and the share converged."""
    times = []
    for _ in range(repeats):
        command = [sys.executable, "-c", MAP, str(across), str(down), str(factor)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        seconds, *rest = json.loads(done.stdout)
        times.append(seconds)
    median = float(np.median(times))
    return median, (max(times) - min(times)) / median, rest


def rows(repeats: int, points: int) -> list[Row]:
    """Seconds a map; the ratio is its time per point over that of the first row."""
    found: list[Row] = []
    first = 0.0
    for share, factor in ((100, 1.0), (10, 1.0), (1, 1.0), (10, 1000.0)):
        down = max(1, round((points / share) ** 0.5))
        across = max(1, points // share // down)
        seconds, spread, (peak, grown, settled) = _run(across, down, factor, repeats)
        each = seconds / (across * down)
        first = first or each
        name = f"{across} x {down} = {across * down} points" + ("" if factor == 1 else f", inertia x{factor:g}")
        note = f"{1e6 * each:.3g} µs a point; peak {peak / 2**20:.0f} MiB, {grown / 2**20:.0f} of them the map's; "
        note += f"{100 * settled:.4g} % converged"
        found.append(Row(SECTION, name, seconds, "s", spread, each / first, note))
    return found
