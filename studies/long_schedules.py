"""Schedules whose repeated drive periods are counted, beside the same ones with every period integrated.

python -m studies.long_schedules [COUNT] [--seed N] [--longest M]

The C library is built twice, once counting beyond 100 periods and once beyond none of the points' 200 to M (10,000).
Random drives, damping ratios of 0.003 to 0.05, inertias of 1e-7 to 1e-4 kg m^2, tolerances of 1e-3 to 1e-8, all starts.
Wrong is a point whose figures differ by more than both bounds together, or that converges in one way only.  The exit
code is 1 if any is.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from trum_sym.c_library.export import exported
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor_file import load_motor

__all__ = ["BOUNDED", "build", "compared", "draw", "figures", "main"]

BOUNDED = ("mean_speed", "min_speed", "max_speed", "stall_torque", "speed_volatility")


def build(folder: Path, beyond: int, flags: str = "-O2") -> Path:
    """The C library's example, which counts repeated periods of schedules of more than `beyond`."""
    for name, text in exported(load_motor(), Drive(), {}).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    given = [f"CFLAGS={flags}", f"CPPFLAGS=-DTRUM_REPEATS_BEYOND={beyond}"]
    subprocess.run(["make", "-s", *given], cwd=folder, check=True)
    return folder / "example"


def figures(program: Path, point: dict[str, object]) -> dict[str, float]:
    """What the example prints, and the processor time in s."""
    begin = time.perf_counter()
    words = [f"{name}={value!r}" if isinstance(value, float) else f"{name}={value}" for name, value in point.items()]
    done = subprocess.run([program, *words], capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return {**found, "seconds": time.perf_counter() - begin}


def draw(rng: np.random.Generator, longest: int) -> dict[str, object]:
    """A random point, by the example's names."""
    periods = int(np.exp(rng.uniform(np.log(200), np.log(longest + 1))))
    return {
        "prepressure": float(rng.uniform(100, 220)),
        "frequency_difference": float(rng.uniform(-5000, 5000)),
        "periods": periods,
        "on_periods": int(rng.integers((periods + 1) // 2, periods + 1)),
        "load_torque": float(rng.uniform(-0.5, 0.5)),
        "damping_ratio": float(10 ** rng.uniform(-2.5, -1.3)),
        "rotor_inertia": float(10 ** rng.uniform(-7, -4)),
        "start": str(rng.choice(["periodic", "steady", "rest"])),
        "tolerance": float(10 ** rng.uniform(-8, -3)),
    }


def compared(one: dict[str, float], other: dict[str, float]) -> tuple[str, float]:
    """What is wrong, if anything, and the largest difference over both bounds together."""
    if one["converged"] != other["converged"]:
        return f"converged: {one['converged']} and {other['converged']}", 0.0
    if not one["converged"]:
        return "", 0.0
    worst, name = max(
        (abs(one[name] - other[name]) / (one[f"{name}_error"] + other[f"{name}_error"]), name)
        for name in BOUNDED
        if one[f"{name}_error"] is not None and other[f"{name}_error"] is not None
    )
    return (f"{name} differs" if worst > 1 else ""), worst


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m studies.long_schedules", description=__doc__.splitlines()[0])
    parser.add_argument("count", nargs="?", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--longest", type=int, default=10_000)
    options = parser.parse_args()
    rng, wrong, ratios, seconds = np.random.default_rng(options.seed), 0, [], np.zeros(2)
    with tempfile.TemporaryDirectory() as temporary:
        programs = [build(Path(temporary) / str(beyond), beyond) for beyond in (100, options.longest)]
        for k in range(options.count):
            point = draw(rng, options.longest)
            found = [figures(program, point) for program in programs]
            said, worst = compared(*found)
            wrong += bool(said)
            ratios.append(worst)
            seconds += [each["seconds"] for each in found]
            if said:
                print(f"{k}: {said}, {worst:.3g} of the bounds: {point}", flush=True)
    print(
        f"{options.count} points, {wrong} wrong; differences over both bounds: median {np.median(ratios):.2g}, largest "
        f"{np.max(ratios):.2g}; {seconds[0]:.0f} s counting, {seconds[1]:.0f} s without"
    )
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())
