"""Constrained problems of points that are to be held, beside a dense search of the box.

    python -m studies.limits FILE.jsonl [COUNT]      takes up where FILE ends; 20 problems
    python -m studies.limits FILE.jsonl 0            prints the figures

The dense search knows nothing of the optimiser.  On a grid of the box it brackets the target speed along every line of
equal prepressure, brings each crossing onto it by regula falsi on orbits at 1e-9, and computes there what is needed
with `ts.evaluate` alone: drifts at both ends of the spreads, the worst speed error in all corners of them, an encoder's
readings, the swing; start times by the laps that `ts.holding` follows.  The best crossings, by violation and then by
objective, are refined between their neighbours.  Limits are chosen from what the search finds: some are met by a hair,
some missed by one.
"""

from __future__ import annotations

import argparse
import itertools
import json
import time
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import WITHIN
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import solve_orbit
from trum_sym.model.settling import rim_orbits, settling_time

SIDE = 36
BEST, LEVELS = 2, 8  # crossings that are refined, how often
HAIR = 1e-4
PERIOD = 2e-3
SPREADS = {"prepressure": 1.0, "frequency_difference": 1.0, "friction_coefficient": 0.01, "load_torque": 0.01}
GIVEN = {"prepressure": "+-1 N", "frequency_difference": "+-1 Hz", "friction_coefficient": 0.01, "load_torque": 0.01}

# load, target in arcsec/s, box: what is shared by a few problems
SCENES = (
    (ts.Drive(load_torque=0.1), 20000.0, (160.0, 210.0), (2800.0, 3300.0)),
    (ts.Drive(load_torque=0.05), 300000.0, (165.0, 205.0), (2850.0, 3200.0)),
    (ts.Drive(load_torque=0.3), 5000.0, (160.0, 210.0), (3000.0, 3300.0)),
    (ts.Drive(start="rest", phase_lead=-1, load_inertia=1e-3), 633.0, (165.0, 200.0), (2800.0, 3300.0)),
)
# scene, objective, what is limited, and where: at the least there is, by a hair more or less, or a share of the way
# from the least to the most
PROBLEMS = (
    (0, "volatility", "friction_coefficient_drift", 1 + HAIR),
    (0, "volatility", "friction_coefficient_drift", 1 - HAIR),
    (0, "drift", None, None),
    (0, "worst-speed-error", "swing", 0.5),
    (0, "encoder-volatility", "frequency_difference_drift", 0.4),
    (1, "volatility", "prepressure_drift", 1 + HAIR),
    (1, "drift", "encoder_volatility", 0.3),
    (1, "volatility", "encoder_volatility", 1 - HAIR),
    (1, "worst-speed-error", None, None),
    (1, "drift", "swing", 1 - HAIR),
    (2, "volatility", "load_torque_drift", 1 - HAIR),
    (2, "encoder-volatility", None, None),
    (2, "drift", "frequency_difference_drift", 1 + HAIR),
    (2, "volatility", "prepressure_drift", 0.5),
    (2, "worst-speed-error", "friction_coefficient_drift", 1 - HAIR),
    (3, "drift", "start_time", 0.5),
    (3, "volatility", "start_time", 0.3),
    (3, "encoder-volatility", "start_time", 0.7),
    (3, "drift", None, None),
    (3, "encoder-volatility", "load_torque_drift", 0.5),
)


def speed(motor, drive):
    """What `ts.evaluate` says, without the figures of a rotor that is held still."""
    case = prepare(motor, drive, Levels(), 1e-9, warn=False)
    return np.asarray(solve_orbit({**case.arguments, "held": 0.0}, case.symbols).mean_speed)


class Curve:
    """Where a box has the target speed, with every figure there."""

    def __init__(self, drive, target, forces, differences):
        self.motor, self.drive, self.target = ts.load_motor("trum60"), drive, target * ARCSEC
        self.forces, self.differences = forces, differences
        force, difference = np.linspace(*forces, SIDE), np.linspace(*differences, SIDE)
        grid = replace(drive, prepressure=force[:, None], frequency_difference=difference)
        speeds = np.asarray(ts.evaluate(self.motor, grid, tolerance=1e-4).mean_speed) - self.target
        rows, columns = np.nonzero(speeds[:, :-1] * speeds[:, 1:] < 0)
        self.spacing = force[1] - force[0]
        self.width = difference[1] - difference[0]
        self.points = self.onto(force[rows], difference[columns], difference[columns + 1])
        edges = []  # where the curve leaves through an edge of equal frequency difference
        for column in (0, SIDE - 1):
            there = np.flatnonzero(speeds[:-1, column] * speeds[1:, column] < 0)
            edges += [(force[k], force[k + 1], difference[column]) for k in there]
        if edges:
            low, high, at = np.array(edges).T
            self.points = np.concatenate([self.points, self.onto_force(at, low, high)])
        self.known = {}

    def onto(self, force, low, high):
        """Regula falsi (Illinois) along the frequency difference; points that arrive, (n, 2)."""
        return self._falsi(
            lambda x: replace(self.drive, prepressure=force, frequency_difference=x), force, low, high, 1
        )

    def onto_force(self, difference, low, high):
        return self._falsi(
            lambda x: replace(self.drive, prepressure=x, frequency_difference=difference), difference, low, high, 0
        )

    def _falsi(self, drive_at, other, a, b, column):
        a, b = np.array(a, float), np.array(b, float)
        if not a.size:
            return np.empty((0, 2))
        f_a, f_b = speed(self.motor, drive_at(a)) - self.target, speed(self.motor, drive_at(b)) - self.target
        good = f_a * f_b < 0
        x = a.copy()
        for _ in range(25):
            with np.errstate(all="ignore"):
                x = np.where(good, a - f_a * (b - a) / (f_b - f_a), a)
            f = speed(self.motor, drive_at(x)) - self.target
            if np.all((np.abs(f) <= 3e-9 * abs(self.target)) | ~good):
                break
            same = f * f_b > 0
            f_a = np.where(same, 0.5 * f_a, f_b)
            a = np.where(same, a, b)
            b, f_b = x, f
        found = np.stack([other, x] if column else [x, other], axis=1)
        return found[good & (np.abs(f) <= 1e-8 * abs(self.target))]

    def figures(self, points, names):
        """Some figures at points, by name."""
        force, difference = points.T
        at = replace(self.drive, prepressure=force, frequency_difference=difference)
        alone = ts.evaluate(self.motor, at, tolerance=1e-9)
        found = {
            "volatility": np.asarray(alone.speed_volatility),
            "swing": np.asarray(alone.max_speed) - np.asarray(alone.min_speed),
        }
        if {"encoder_volatility", "encoder-volatility"} & names:
            here = ts.evaluate(self.motor, at, tolerance=1e-9, sampling_period=PERIOD)
            found["encoder_volatility"] = found["encoder-volatility"] = np.asarray(here.speed_volatility)
        if "worst-speed-error" in names:
            corners = itertools.product((1.0, -1.0), repeat=len(SPREADS))
            speeds = [self.moved(points, dict(zip(SPREADS, signs, strict=True))) for signs in corners]
            found["worst-speed-error"] = np.max(np.abs(np.array(speeds) - self.target), axis=0)
        for name in SPREADS:
            if {"drift", f"{name}_drift"} & names:
                both = [self.moved(points, {name: sign}) - np.asarray(alone.mean_speed) for sign in (1.0, -1.0)]
                found[f"{name}_drift"] = np.max(np.abs(both), axis=0)
        if "drift" in names:
            found["drift"] = sum(found[f"{name}_drift"] for name in SPREADS)
        if "start_time" in names:
            found["start_time"] = self.start_times(at)
        return {name: found[name] for name in names}

    def start_times(self, at):
        case = prepare(self.motor, at, Levels(), 1e-9, warn=False)
        points = rim_orbits(case, solve_orbit(case.arguments, case.symbols))
        return np.array([settling_time(point, ("rest",), WITHIN * abs(self.target)) for point in points])

    def of_all(self, name):
        """A figure at all crossings, computed once."""
        if name not in self.known:
            self.known |= self.figures(self.points, {name})
        return self.known[name]

    def moved(self, points, signs):
        """The mean speed with inputs off to a side."""
        off = {name: sign * SPREADS[name] for name, sign in signs.items()}
        force, difference = points.T
        drive = replace(
            self.drive,
            prepressure=force + off.get("prepressure", 0.0),
            frequency_difference=difference + off.get("frequency_difference", 0.0),
            load_torque=float(self.drive.load_torque) * (1 + off.get("load_torque", 0.0)),
        )
        with unquestioned():
            friction = float(self.motor.friction_coefficient.value) * (1 + off.get("friction_coefficient", 0.0))
            return speed(self.motor.with_values({"friction_coefficient": friction}), drive)

    def best(self, objective, limited=None, limit=None):
        """Least objective within the limit, or least excess over it, between neighbours: (excess, objective)."""

        names = {objective} if limited is None else {objective, limited}

        def rank(figures):
            excess = np.zeros(len(figures[objective])) if limited is None else figures[limited] / limit - 1
            return np.maximum(excess, 1e-9), figures[objective]

        ranked = rank({name: self.of_all(name) for name in names})
        answers = []
        for first in np.lexsort(ranked[::-1])[:BEST]:
            centre, half = self.points[first], self.spacing
            value = tuple(float(part[first]) for part in ranked)
            for _ in range(LEVELS):
                force = np.clip(centre[0] + half * np.linspace(-1, 1, 9), *self.forces)
                slope = self.slope(centre)
                guess = centre[1] + slope * (force - centre[0])
                reach = 0.3 * abs(half) * max(abs(slope), 0.2) + 1e-7
                low, high = (np.clip(guess + side * reach, *self.differences) for side in (-1, 1))
                found = self.onto(force, low, high)
                if len(found):
                    there = rank(self.figures(found, names))
                    k = np.lexsort(there[::-1])[0]
                    if (there[0][k], there[1][k]) < value:
                        value, centre = (float(there[0][k]), float(there[1][k])), found[k]
                half /= 4
            answers.append(value)
        return min(answers)

    def slope(self, point):
        """Of the frequency difference by the prepressure along the curve."""
        at = np.array([point + d for d in ((0.01, 0), (-0.01, 0), (0, 0.1), (0, -0.1))])
        a, b, c, d = speed(self.motor, replace(self.drive, prepressure=at[:, 0], frequency_difference=at[:, 1]))
        return -((a - b) / 0.02) / ((c - d) / 0.2)


def limit_of(curve, limited, place):
    """At the least of a figure, by a hair more or less; or a share of the way from the least to the most."""
    if limited is None:
        return None
    least = curve.best(limited)[1]
    if abs(place - 1) <= HAIR * 1.001:
        return least * place
    values = curve.of_all(limited)
    return float(least + place * (np.max(values) - least))


def record(number, curves):
    k, objective, limited, place = PROBLEMS[number]
    drive, target, forces, differences = SCENES[k]
    begin = time.process_time()
    if k not in curves:
        curves.clear()
        curves[k] = Curve(*SCENES[k])
    curve = curves[k]
    limit = limit_of(curve, limited, place)
    excess, value = curve.best(objective, limited, limit)
    dense_seconds = time.process_time() - begin
    begin = time.process_time()
    constraint = [] if limited is None else [f"{limited} <= {limit!r}"]
    motor = replace(ts.load_motor("trum60"), spreads={})
    found = ts.optimize(
        motor,
        drive,
        objective=objective,
        target_speed=target * ARCSEC,
        bounds={"prepressure": forces, "frequency_difference": differences},
        constraints=constraint,
        spreads=GIVEN,
        sampling_period=PERIOD,
    )
    return {
        "number": number,
        "problem": [k, objective, limited, limit],
        "dense": [bool(excess <= 1e-7), value, excess],
        "ours": [found.status, found.objective, found.constraint_violation],
        "message": found.message,
        "optima": found.evidence.optima,
        "seconds": [dense_seconds, time.process_time() - begin],
    }


def wrong(found):
    """What is wrong with a record, or nothing."""
    feasible, value, _ = found["dense"]
    status, objective, _ = found["ours"]
    if (status == "solved") != feasible:
        return f"{status}, but dense says {'feasible' if feasible else 'not'}"
    if feasible and objective > value * (1 + 1e-6):
        return f"objective {objective:.10g}, dense has {value:.10g}"
    return ""


def report(file):
    records = [json.loads(line) for line in file.read_text().splitlines()]
    for found in records:
        k, objective, limited, limit = found["problem"]
        feasible, value, excess = found["dense"]
        status, ours, _ = found["ours"]
        said = f"{ours / value - 1:+.1e}" if feasible and ours else f"excess {excess:.3g}"
        what = f"scene {k}, {objective}" + (f", {limited} <= {limit:.6g}" if limited else "")
        print(f"{found['number']:2} {what:70} {status:11} {said:16} {wrong(found)}")
    solved = [f["ours"][1] / f["dense"][1] - 1 for f in records if f["dense"][0] and f["ours"][1]]
    right, none = sum(not wrong(f) for f in records), sum(not f["dense"][0] for f in records)
    print(f"{len(records)} problems, {right} right; {none} infeasible")
    if solved:
        low, high = min(solved), max(solved)
        print(f"objective over the dense search's: median {np.median(solved):+.1e}, from {low:+.1e} to {high:+.1e}")
    print(
        f"seconds: dense {sum(f['seconds'][0] for f in records):.0f}, ours {sum(f['seconds'][1] for f in records):.0f}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("count", type=int, nargs="?", default=20)
    parser.add_argument("--only", type=int, nargs="*")
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", ts.ValidityWarning)
    done, curves = set(), {}
    if chosen.file.exists():
        done = {json.loads(line)["number"] for line in chosen.file.read_text().splitlines()}
    for number in range(min(chosen.count, len(PROBLEMS))) if chosen.only is None else chosen.only:
        if number not in done:
            line = json.dumps(record(number, curves))
            with chosen.file.open("a") as stream:
                stream.write(line + "\n")
            print(line, flush=True)
    report(chosen.file)


if __name__ == "__main__":
    main()
