"""The figures' slopes beside differences of sixth order, on orbits finer than ``evaluate`` offers.

    python -m studies.slopes FILE.jsonl [COUNT] [--first N]      takes up where FILE ends
    python -m studies.slopes FILE.jsonl 0                        prints the figures

At every random point the differences are taken with three steps, each four times the one before, on orbits at 1e-12.
Where two neighbours among these agree to 1e-8, the point is smooth for that parameter, and the slope is compared with
theirs.  Errors are over the slope or the figure per parameter, whichever is larger.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np

import trum_sym as ts
from studies import records
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare, results
from trum_sym.model.sensitivities import DIFFERENTIATED, PARAMETERS

TOLERANCES = (1e-3, 1e-6, 1e-9)
LEVELS = Levels()
SHIFTS = np.array([1.0, -1.0, 2.0, -2.0, 3.0, -3.0])
WEIGHTS = np.array([45.0, -45.0, -9.0, 9.0, 1.0, -1.0]) / 60
STEPS = (5e-5, 2e-4, 8e-4)  # over the parameter
FINEST = 1e-12
AGREE = 1e-8


def draw(seed):
    """A motor and a drive with the rotor's load well inside what friction can hold."""
    rng = np.random.default_rng([9, seed])
    friction, force = rng.uniform(0.1, 0.4), rng.uniform(110, 210)
    with unquestioned():  # on purpose beyond the range that the motor file states
        motor = ts.load_motor("trum60").with_values(
            {"friction_coefficient": friction, "rotor_inertia": 10 ** rng.uniform(-6, -4)}
        )
    periods = int(rng.integers(6, 31))
    return motor, ts.Drive(
        prepressure=force,
        frequency_difference=rng.uniform(500, 4500) * rng.choice([-1, 1]),
        periods=periods,
        on_periods=int(rng.integers(-(-periods // 2), periods)),
        load_torque=rng.uniform(-0.5, 0.5) * 0.0265 * friction * force,
        start=str(rng.choice(["periodic", "steady", "rest"])),
    )


def base(motor, drive, point, name):
    """A parameter's value, and what it is a value of."""
    if name in ("prepressure", "frequency_difference", "load_torque"):
        return getattr(drive, name)
    if name == "load_inertia":  # which the rotor's own stands for
        return motor.rotor_inertia.value
    return motor.friction_coefficient.value if name == "friction_coefficient" else getattr(point, name)


def moved(motor, drive, point, name, values):
    """The figures at other values of one parameter."""
    if name in ("prepressure", "frequency_difference", "load_torque"):
        drive = replace(drive, **{name: values})
    elif name in ("friction_coefficient", "load_inertia"):
        own = "rotor_inertia" if name == "load_inertia" else name
        with unquestioned():
            motor = motor.with_values({own: values})
    else:
        motor = motor.with_values(
            {"amplitude": point.amplitude, "resonance_frequency": point.resonance_frequency} | {name: values}
        )
    return finest(motor, drive)


def finest(motor, drive):
    """The figures, from an orbit a thousand times finer than is offered."""
    case = prepare(motor, drive, LEVELS, 1e-9)
    return results(replace(case, arguments={**case.arguments, "tolerance": FINEST}), DIFFERENTIATED)


def record(seed):
    motor, drive = draw(seed)
    point = ts.evaluate(motor, drive, tolerance=1e-9)
    found = {tolerance: ts.sensitivities(motor, drive, tolerance=tolerance) for tolerance in TOLERANCES}
    errors = {}
    for name in PARAMETERS:
        value = base(motor, drive, point, name)
        differences = []
        for step in STEPS:
            there = moved(motor, drive, point, name, value * (1 + step * SHIFTS))
            differences.append({f: WEIGHTS @ there[f] / (step * value) for f in DIFFERENTIATED})
        for figure in DIFFERENTIATED:
            values = [difference[figure] for difference in differences]
            near, far = min(pairwise(values), key=lambda pair: abs(pair[0] - pair[1]))
            scale = max(abs(near), abs(getattr(point, figure) / value))
            errors[f"{figure} by {name}"] = [
                abs(near - far) / scale,
                *(abs(found[tolerance][figure][name] - near) / scale for tolerance in TOLERANCES),
            ]
    return {"seed": seed, "errors": {key: [float(e) for e in row] for key, row in errors.items()}}


def report(file):
    from tabulate import tabulate

    records = [json.loads(line) for line in file.read_text().splitlines()]
    rows = []
    for key in records[0]["errors"]:
        all_ = np.array([r["errors"][key] for r in records])
        smooth = all_[all_[:, 0] <= AGREE, 1:]
        if len(smooth):
            median, worst = np.median(smooth, axis=0), smooth.max(axis=0)
            share = np.mean(smooth[:, -1] <= 1e-7)
            rows.append((key, len(smooth), *median, *worst, f"{100 * share:.0f} %"))
        else:
            rows.append((key, 0))
    heads = [
        "slope",
        "smooth",
        *(f"median {t:g}" for t in TOLERANCES),
        *(f"worst {t:g}" for t in TOLERANCES),
        "<= 1e-7",
    ]
    print(f"{len(records)} points; errors by tolerance of the orbit that is differentiated\n")
    print(tabulate(rows, heads, floatfmt=".1e"))


if __name__ == "__main__":
    records.collect(__doc__, 500, record, report)
