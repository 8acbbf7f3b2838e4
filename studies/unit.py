"""``python -m studies.unit [COUNT]``: the co-simulation unit beside ``simulate``, and from rest beside an integration.

Random drives of the stock motor (150 to 210 N, 1 to 5 kHz off resonance, 4 to 30 periods, loads to 0.9 of the limit).
On the orbit every sample of speed and angle over two cycles is compared with :func:`trum_sym.simulate`; from rest the
speed at the end of each of twelve cycles with the integrator of ``tests/orbit_reference.py``, which shares nothing with
either.  Differences are over the largest speed, and over the angle of a cycle at that speed.  FMPy runs the unit.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

import trum_sym as ts
from trum_sym.c_library.fmu import built

sys.path.append(str(Path(__file__).parent.parent / "tests"))
from orbit_reference import Reference

_CYCLES = 12  # of a start-up
_STARTS_UP = 5  # every fifth drive also starts from rest
_SAMPLES = 64  # in a drive period


def drives(count: int, seed: int) -> list[dict[str, float]]:
    """Random inputs of the unit."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        periods = int(rng.integers(4, 31))
        force = rng.uniform(150, 210)
        found.append(
            {
                "prepressure": force,
                "frequency_difference": rng.uniform(1000, 5000),
                "load_torque": rng.uniform(-0.9, 0.9) * 0.25 * force * 0.0265,
                "periods": float(periods),
                "on_periods": float(rng.integers((periods + 1) // 2, periods + 1)),
            }
        )
    return found


def _run(unit: Path, stop: float, step: float, values: dict[str, Any]) -> np.ndarray:
    return fmpy.simulate_fmu(str(unit), start_time=0, stop_time=stop, output_interval=step, start_values=values)


def on_the_orbit(unit: Path, values: dict[str, float]) -> tuple[float, float]:
    """The largest differences of speed and angle over two cycles."""
    histories = ts.simulate(drive=ts.Drive(**values), cycles=2, samples_per_period=_SAMPLES, tolerance=1e-6)
    times, speed = histories["time"].values, histories["rotor_speed"].values
    found = _run(unit, float(times[-1]), float(times[1]), values)
    count, top = min(len(found), times.size), float(np.abs(speed).max())
    angle = np.abs(found["angle"][:count] - histories["rotor_angle"].values[:count]).max()
    return float(np.abs(found["speed"][:count] - speed[:count]).max() / top), float(angle / (top * times[-1] / 2))


def from_rest(unit: Path, values: dict[str, float]) -> float:
    """The largest difference of the speed at the ends of the first cycles."""
    motor, drive = ts.load_motor("trum60"), ts.Drive(**values)
    point = ts.evaluate(motor, drive)
    other = Reference(motor, drive, point)
    cycle, speed, expected = float(point.cycle_time), 0.0, []
    for _ in range(_CYCLES):
        speed += float(other.lap(speed, 1e-11)[0][0])
        expected.append(speed / other.radius)
    step = cycle / (_SAMPLES * values["periods"])
    found = _run(unit, _CYCLES * cycle, step, {**values, "settled": False, "start_speed": 0.0})
    ends = np.interp(cycle * np.arange(1, _CYCLES + 1), found["time"], found["speed"])
    top = max(float(np.abs(found["speed"]).max()), abs(float(point.max_speed)), abs(float(point.min_speed)))
    return float(np.abs(ends - expected).max() / top)


def study(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Differences on the orbit, two of each drive, and from rest."""
    orbits, starts = [], []
    with tempfile.TemporaryDirectory(prefix="ünit") as name, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        unit = Path(name) / "motor.fmu"
        unit.write_bytes(built(ts.load_motor("trum60"), ts.Drive(), {})[0])
        for k, values in enumerate(drives(count, seed)):
            orbits.append(on_the_orbit(unit, values))
            if k % _STARTS_UP == 0:
                starts.append(from_rest(unit, values))
    return np.array(orbits), np.array(starts)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m studies.unit", description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, nargs="?", default=100)
    parser.add_argument("--seed", type=int, default=24)
    options = parser.parse_args()
    orbits, starts = study(options.count, options.seed)
    for name, column in (("speed", orbits[:, 0]), ("angle", orbits[:, 1]), ("speed from rest", starts)):
        print(f"{name}: {column.size} drives, largest {column.max():.2g}, median {np.median(column):.2g}")


if __name__ == "__main__":
    main()
