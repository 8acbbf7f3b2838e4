"""What it takes to hold a point, beside differences and simulations of its own, at random points.

    python -m studies.holding FILE.jsonl [COUNT] [--first N]     takes up where FILE ends
    python -m studies.holding FILE.jsonl 0                       prints the figures

Slopes are compared with differences of sixth order on orbits at 1e-9 with three steps, of which the two neighbours that
agree best count; drifts with evaluations at both ends of the spread.  From rest and after a disturbance the rotor is
followed through whole drive cycles: by `tests/orbit_reference.py`, which shares no formula with the kernels,
where few laps are needed, else lap by lap on the kernels.
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

import trum_sym as ts
from studies import records
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import lap_from, solve_orbit

sys.path.append(str(Path(__file__).parents[1] / "tests"))

SHIFTS = np.array([1.0, -1.0, 2.0, -2.0, 3.0, -3.0])
WEIGHTS = np.array([45.0, -45.0, -9.0, 9.0, 1.0, -1.0]) / 60
STEPS = (5e-5, 2e-4, 8e-4)  # over the input
REFERENCE_LAPS = 25
MOST_LAPS = 4000


def draw(seed):
    """A motor, a drive, what is asked."""
    rng = np.random.default_rng([21, seed])
    friction, force = rng.uniform(0.15, 0.35), rng.uniform(110, 210)
    with unquestioned():
        motor = ts.load_motor("trum60").with_values({"friction_coefficient": friction})
    periods = int(rng.integers(8, 27))
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=rng.uniform(800, 4500),
        periods=periods,
        on_periods=int(rng.integers(-(-periods // 2), periods)),
        load_torque=rng.uniform(-0.4, 0.4) * 0.0265 * friction * force,
        load_inertia=0.0 if rng.uniform() < 0.7 else 10 ** rng.uniform(-5, -3),
        start=str(rng.choice(["periodic", "steady", "rest"])),
        phase_lead=float(rng.choice([-1, 1])),
        switching_phase=rng.uniform(0, 6),
    )
    spreads = {
        "prepressure": f"+-{rng.uniform(0.1, 2)!r} N",
        "frequency_difference": f"+-{rng.uniform(0.1, 2)!r} Hz",
        "friction_coefficient": rng.uniform(1e-3, 2e-2),
        "load_torque": rng.uniform(1e-3, 2e-2),
        "amplitude": rng.uniform(1e-3, 2e-2),
    }
    asked = {"within": 10 ** rng.uniform(-3, -1), "speed_time": 10 ** rng.uniform(-3.5, -1.5)}
    return motor, drive, spreads, asked


def speed(motor, drive):
    return np.asarray(ts.evaluate(motor, drive, tolerance=1e-9).mean_speed)


def moved(motor, drive, point, name, values):
    """Mean speeds at other values of one input."""
    if hasattr(drive, name):
        return speed(motor, replace(drive, **{name: values}))
    with unquestioned():
        if name in ("amplitude", "resonance_frequency"):  # each alone, so the other is held
            both = {"amplitude": point.amplitude, "resonance_frequency": point.resonance_frequency}
            return speed(motor.with_values({**both, name: values}), drive)
        return speed(motor.with_values({name: values}), drive)


def own_value(motor, drive, point, name):
    if hasattr(drive, name):
        return float(np.asarray(getattr(drive, name)))
    found = getattr(point, name, None)
    return float(found if found is not None else getattr(motor, name).value)


def slope_error(motor, drive, point, name, slope):
    """Over the slope or the mean speed per input, whichever is larger; and how far the differences agree."""
    value = own_value(motor, drive, point, name)
    scale = value if value else 4.5e-6  # a load without inertia: the rotor's
    at = value
    differences = []
    for step in STEPS:
        places = at + step * scale * SHIFTS
        if name == "load_inertia" and value == 0.0:  # which cannot be less than none: by the rotor's own
            own = motor.rotor_inertia.value
            with unquestioned():
                speeds = speed(motor.with_values({"rotor_inertia": own * (1 + step * SHIFTS)}), drive)
            differences.append(float(WEIGHTS @ speeds / (step * own)))
            continue
        differences.append(float(WEIGHTS @ moved(motor, drive, point, name, places) / (step * scale)))
    near, far = min(pairwise(differences), key=lambda pair: abs(pair[0] - pair[1]))
    size = max(abs(near), abs(point.mean_speed / scale))
    return abs(slope - near) / size, abs(near - far) / size


def drift_error(motor, drive, point, name, amount, drift):
    """Against evaluations with the input off to either side, over the drift."""
    if name == "amplitude":  # follows the prepressure as it is
        with unquestioned():
            at = motor.with_values({"amplitude": point.amplitude + amount * np.array([1.0, -1.0])})
        changes = speed(at, drive) - point.mean_speed
    else:
        value = own_value(motor, drive, point, name)
        changes = moved(motor, drive, point, name, value + amount * np.array([1.0, -1.0])) - point.mean_speed
    largest = changes[np.argmax(np.abs(changes))]
    return abs(drift - largest) / max(abs(largest), 1e-9 * max(abs(point.min_speed), abs(point.max_speed)))


def cycles(lap, start, orbit, allowed, floor):
    """Whole cycles until a speed is near the orbit's, the last shared out by the logarithm down to rounding."""
    away = start - orbit
    for k in range(MOST_LAPS):
        if abs(away) <= allowed:
            return float(k)
        then = lap(orbit + away) - orbit
        if abs(then) <= allowed:
            return k + math.log(abs(away) / allowed) / math.log(abs(away) / max(abs(then), floor))
        away = then
    return math.inf


def simulated(motor, drive, found):
    """Start and return time by laps, and whether an independent integration made them."""
    import orbit_reference

    case = prepare(motor, drive, Levels(), 1e-9, warn=False)
    raw = {k: float(v) for k, v in solve_orbit(case.arguments, case.symbols).raw.items()}
    radius, period = float(case.symbols["r_c"]), float(call("trum_drive", case.values)["T"])
    top = max(abs(raw["low"]), abs(raw["high"]))
    allowed = max(found.within * abs(found.mean_speed) * radius, 2e-9 * top)
    begins = {"start": (0.0,), "return": (raw["start"] + 0.1 * top, raw["start"] - 0.1 * top)}
    guess = max(found.start_time, found.return_time) / period

    if guess <= REFERENCE_LAPS and float(drive.load_inertia) == 0.0:
        other = orbit_reference.Reference(motor, drive, ts.evaluate(motor, drive, tolerance=1e-9))

        def lap(v):
            return v + other.lap(v, 1e-11)[0][0]

        how = "reference"
    else:

        def lap(v):
            return float(lap_from(case.arguments, raw, v, 1, raw["level"])["speed"][-1])

        how = "kernels"
    times = {
        k: period * max(cycles(lap, v, raw["start"], allowed, 1e-9 * top) for v in starts)
        for k, starts in begins.items()
    }
    return times, how


def record(seed):
    motor, drive, spreads, asked = draw(seed)
    point = ts.evaluate(motor, drive, tolerance=1e-9)
    found = ts.holding(motor, drive, spreads=spreads, **asked)
    slopes = {name: slope_error(motor, drive, point, name, slope) for name, slope in found.slopes.items()}
    drifts = {
        name: drift_error(motor, drive, point, name, found.spreads[name], drift) for name, drift in found.drifts.items()
    }
    times, how = simulated(motor, drive, found)
    pushed = point.mean_speed * float(drive.load_torque) < 0
    return {
        "seed": seed,
        "slopes": {name: [float(x) for x in pair] for name, pair in slopes.items()},
        "drifts": {name: float(x) for name, x in drifts.items()},
        "starts": [found.starts, bool(times["start"] <= found.speed_time and not pushed)],
        "returns": [found.returns, bool(times["return"] <= found.speed_time and not pushed)],
        "times": [[found.start_time, times["start"]], [found.return_time, times["return"]]],
        "how": how,
    }


def report(file):
    records = [json.loads(line) for line in file.read_text().splitlines()]
    print(f"{len(records)} points")
    slopes = [pair for r in records for pair in r["slopes"].values()]
    smooth = np.array([error for error, agree in slopes if agree <= 1e-5])
    print(
        f"slopes: {len(slopes)}, of {len(smooth)} the differences agree to 1e-5; error median {np.median(smooth):.1e}, "
    )
    print(f"  largest {smooth.max():.1e}, within 1e-4: {np.sum(smooth <= 1e-4)}")
    drifts = np.array([x for r in records for x in r["drifts"].values()])
    print(f"drifts: {len(drifts)}, largest error {drifts.max():.1e}, within 1e-4: {np.sum(drifts <= 1e-4)}")
    for name in ("starts", "returns"):
        pairs = [r[name] for r in records]
        yes = sum(pair[1] for pair in pairs)
        print(f"{name}: {yes} yes, {len(pairs) - yes} no; as simulated: {sum(a == b for a, b in pairs)}")
    times = np.array([pair for r in records for pair in r["times"]])
    off = np.abs(times[:, 0] / times[:, 1] - 1)
    alone = sum(r["how"] == "reference" for r in records)
    print(f"times: off by median {np.nanmedian(off):.1e}, largest {np.nanmax(off):.1e}; {alone} by the reference")


if __name__ == "__main__":
    records.collect(__doc__, 200, record, report)
