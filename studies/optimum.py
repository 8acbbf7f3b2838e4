"""How often the optimiser is right: random problems against dense maps of their boxes.

    python -m studies.optimum run FILE.jsonl --draws 100 --targets 10 --side 101
    python -m studies.optimum again FILE.jsonl --to NEW.jsonl
    python -m studies.optimum report FILE.jsonl

A draw is a motor (friction, inertia), a load, a start, pulse counts and a box.  Its targets are the speeds of random
points of the box, and two speeds out of reach.  The best of the map is found without the optimiser: where the speed
crosses the target along the map's edges, by regula falsi on orbits at 1e-8, then SciPy's SLSQP with differences.
What is done already in FILE is not done again, so a run may be stopped and taken up.  The maps take most of the time:
`again` solves the problems of FILE once more and compares with the maps that it has.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from pathlib import Path

import numpy as np
import scipy

import trum_sym as ts

CLOSE = 1e-3
_POLISHED = 24  # crossings that are brought onto the target
_FINE = 1e-8


def draw(seed):
    """A motor, a drive and a box."""
    rng = np.random.default_rng([5, seed])
    motor = ts.load_motor("trum60").with_values(
        {"friction_coefficient": rng.uniform(0.1, 0.4), "rotor_inertia": 10 ** rng.uniform(-6, -4)}
    )
    periods = int(rng.integers(10, 31))
    drive = ts.Drive(
        load_torque=rng.uniform(-0.3, 0.3),
        start=rng.choice(["periodic", "steady", "rest"]),
        periods=periods,
        on_periods=int(rng.integers(-(-periods // 2), periods)),
    )
    low = np.array([rng.uniform(100, 200), rng.uniform(500, 4000)])
    high = np.array([min(220.0, low[0] + rng.uniform(10, 100)), low[1] + rng.uniform(50, 1000)])
    return motor, drive, low, high, rng


class Map:
    """A dense map of a box, and what is best on it."""

    def __init__(self, motor, drive, low, high, side):
        self.motor, self.drive, self.low, self.high = motor, drive, low, high
        share = np.linspace(0, 1, side)
        self.share = np.stack(np.meshgrid(share, share, indexing="ij"), axis=-1)
        self.point = self.at(self.share, 1e-3)

    def at(self, share, tolerance):
        force, difference = np.moveaxis(self.low + np.clip(share, 0, 1) * (self.high - self.low), -1, 0)
        drive = ts.Drive(
            **{**self.drive.numbers(), "prepressure": force, "frequency_difference": difference}, start=self.drive.start
        )
        return ts.evaluate(self.motor, drive, tolerance=tolerance)

    @property
    def speed(self):
        return self.point.mean_speed

    def best(self, target):
        """Least volatility at a target speed."""
        deviation = self.point.speed_volatility * np.abs(self.speed)
        ends, rank = [], []
        for axis in (0, 1):
            first = [
                np.moveaxis(a, axis, 0)[:-1].reshape(-1, *a.shape[2:]) for a in (self.share, self.speed, deviation)
            ]
            second = [
                np.moveaxis(a, axis, 0)[1:].reshape(-1, *a.shape[2:]) for a in (self.share, self.speed, deviation)
            ]
            crossed = (first[1] - target) * (second[1] - target) <= 0
            along = (target - first[1][crossed]) / (second[1][crossed] - first[1][crossed] + 1e-300)
            ends.append(np.stack([first[0][crossed], second[0][crossed]], axis=1))
            rank.append(first[2][crossed] + along * (second[2][crossed] - first[2][crossed]))
        ends, rank = np.concatenate(ends), np.concatenate(rank)
        if not rank.size:
            return np.inf
        ends = ends[np.argsort(rank)[:_POLISHED]]
        a, b = ends[:, 0].copy(), ends[:, 1].copy()
        g_a, g_b = self.at(a, _FINE).mean_speed - target, self.at(b, _FINE).mean_speed - target
        for _ in range(8):
            with np.errstate(all="ignore"):
                along = np.where(g_a == g_b, 0.5, g_a / (g_a - g_b))[:, np.newaxis]
            middle = a + np.clip(along, 0.02, 0.98) * (b - a)
            found = self.at(middle, _FINE)
            g = found.mean_speed - target
            left = g * g_a > 0
            a, g_a = np.where(left[:, np.newaxis], middle, a), np.where(left, g, g_a)
            b, g_b = np.where(left[:, np.newaxis], b, middle), np.where(left, g_b, g)
        met = np.abs(g) <= 1e-6 * np.abs(target)
        volatility = np.where(met, found.speed_volatility, np.inf)
        k = int(np.argmin(np.where(np.isfinite(volatility), volatility, np.abs(g) * 1e100)))
        return min(float(volatility[k]), self.polished(middle[k], target))

    def polished(self, start, target):
        """SLSQP from a place, on orbits at 1e-8 and differences."""
        span = np.ptp(self.speed[np.isfinite(self.speed)])
        known = {}

        def look(x):
            key = x.tobytes()
            if key not in known:
                places = np.concatenate([[x], x + 1e-5 * np.where(x > 0.5, -1.0, 1.0) * np.eye(2)])
                point = self.at(places, 1e-8)
                deviation = point.speed_volatility * np.abs(point.mean_speed) / abs(target)
                known[key] = deviation, (point.mean_speed - target) / span
            return known[key]

        def slopes(values, x):
            return (values[1:] - values[0]) / (1e-5 * np.where(x > 0.5, -1.0, 1.0))

        scale = look(start)[0][0] or 1.0
        found = scipy.optimize.minimize(
            lambda x: look(x)[0][0] / scale,
            start,
            jac=lambda x: slopes(look(x)[0], x) / scale,
            method="SLSQP",
            bounds=[(0, 1)] * 2,
            options={"maxiter": 15},
            constraints={"type": "eq", "fun": lambda x: look(x)[1][0], "jac": lambda x: slopes(look(x)[1], x)},
        )
        deviation, error = look(found.x)
        return float(deviation[0]) if abs(error[0]) * span <= 1e-6 * abs(target) else np.inf


def extremes(dense):
    """Lowest and highest speed of a box, refined from the map by shrinking patches."""
    ends = []
    for pick in (np.nanargmin, np.nanargmax):
        centre = dense.share.reshape(-1, 2)[pick(dense.speed)]
        half = 1.0 / (dense.share.shape[0] - 1)
        for _ in range(8):
            offsets = np.linspace(-half, half, 5)
            patch = np.clip(centre + np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2), 0, 1)
            speeds = dense.at(patch, 1e-7).mean_speed
            centre, half = patch[pick(speeds)], 0.4 * half
        ends.append(float(speeds[pick(speeds)]))
    return ends


def problem(motor, drive, low, high, target):
    """The optimiser's answer, as a record."""
    begin = time.perf_counter()
    found = ts.optimize(
        motor,
        drive,
        target_speed=target,
        bounds={"prepressure": (low[0], high[0]), "frequency_difference": (low[1], high[1])},
    )
    record = {
        "target": target,
        "status": found.status,
        "seconds": time.perf_counter() - begin,
        "objective": found.objective,
        "violation": found.constraint_violation,
        "evaluations": found.evaluations,
        "optima": len(found.evidence.optima),
        "where": [found.prepressure, found.frequency_difference],
        "range": found.evidence.reachable_speed,
    }
    return record


def records(seed, targets, side):
    """One record a target."""
    motor, drive, low, high, rng = draw(seed)
    dense = Map(motor, drive, low, high, side)
    if not np.isfinite(dense.speed).all():
        yield {"seed": seed, "kind": "no orbit", "side": side}
        return
    for k in range(targets):
        target = float(dense.at(rng.uniform(size=2), 1e-9).mean_speed)
        found = problem(motor, drive, low, high, target)
        yield {"seed": seed, "kind": "feasible", "number": k, "side": side, "map": dense.best(target), **found}
    low_speed, high_speed = extremes(dense)
    reach = high_speed - low_speed
    for end, sign in ((low_speed, -1), (high_speed, 1)):
        beyond = 10 ** rng.uniform(-4, 0)
        found = problem(motor, drive, low, high, end + sign * beyond * reach)
        yield {
            "seed": seed,
            "kind": "unreachable",
            "side": side,
            "beyond": beyond,
            "true range": [low_speed, high_speed],
            **found,
        }


def run(file, draws, targets, side, first):
    done = set()
    if file.exists():
        done = {(r["seed"], r["side"]) for r in map(json.loads, file.read_text().splitlines())}
    for seed in range(first, first + draws):
        if (seed, side) in done:
            continue
        found = list(records(seed, targets, side))
        with file.open("a") as stream:
            stream.writelines(json.dumps(record) + "\n" for record in found)
        print(f"draw {seed}: {len(found)} problems", flush=True)


def again(file, to):
    """The problems of a file, against its maps."""
    known = [json.loads(line) for line in file.read_text().splitlines()]
    done = len(to.read_text().splitlines()) if to.exists() else 0
    for record in known[done:]:
        motor, drive, low, high, _ = draw(record["seed"])
        new = problem(motor, drive, low, high, record["target"]) if "target" in record else {}
        with to.open("a") as stream:
            stream.write(json.dumps({**record, **new}) + "\n")


def wrong(record):
    """What is wrong with a record, or nothing."""
    if record["kind"] == "unreachable":
        return "" if record["status"] == "infeasible" else f"unreachable, but {record['status']}"
    if record["status"] != "solved":
        return f"reachable, but {record['status']}"
    if not record["violation"] <= 1e-8:
        return f"violation {record['violation']:.1e}"
    if record["objective"] > (1 + CLOSE) * record["map"] + 1e-12:
        return f"objective {record['objective']:.6g}, the map has {record['map']:.6g}"
    return ""


def report_solved(solved):
    if not solved:
        return
    ratio = np.array([record["objective"] / record["map"] - 1 for record in solved])
    print(f"  objective over the map's: median {np.median(ratio):+.1e}, worst {ratio.max():+.1e}")
    print(f"  largest violation {max(record['violation'] for record in solved):.1e}")
    times = np.array([record["seconds"] for record in solved])
    print(f"  seconds: median {np.median(times):.2f}, 95 % {np.quantile(times, 0.95):.2f}, most {times.max():.2f}")


def report(file):
    found = [json.loads(line) for line in file.read_text().splitlines()]
    for side in sorted({record["side"] for record in found}):
        ours = [record for record in found if record["side"] == side and record["kind"] != "no orbit"]
        feasible = [record for record in ours if record["kind"] == "feasible"]
        unreachable = [record for record in ours if record["kind"] == "unreachable"]
        bad = [(record, wrong(record)) for record in ours if wrong(record)]
        print(f"map {side} x {side}: {len({record['seed'] for record in ours})} draws")
        right = len(feasible) - sum(record["kind"] == "feasible" for record, _ in bad)
        print(f"  feasible targets: {right} of {len(feasible)} right")
        right = len(unreachable) - sum(record["kind"] == "unreachable" for record, _ in bad)
        print(f"  unreachable targets: {right} of {len(unreachable)} right")
        report_solved([record for record in feasible if record["status"] == "solved"])
        for record, why in bad:
            print(f"  seed {record['seed']}, target {record['target']:.10g}: {why}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("run", "again", "report"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--to", type=Path, help="where `again` writes")
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="the first draw's number")
    parser.add_argument("--targets", type=int, default=10)
    parser.add_argument("--side", type=int, default=101)
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", ts.ValidityWarning)
    if chosen.what == "run":
        run(chosen.file, chosen.draws, chosen.targets, chosen.side, chosen.first)
    if chosen.what == "again":
        again(chosen.file, chosen.to)
    report(chosen.to or chosen.file)


if __name__ == "__main__":
    main()
