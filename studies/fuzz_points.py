"""Operating points at random, far beyond what motors do: no crash, no hang, no number without what it is worth.

python -m studies.fuzz_points [COUNT] [--seed N] [--batch N]

Batches of points, one in fifty of them wide: inertias from 1e-9 to 1 kg m^2, 1 to 200 periods, loads beyond the
limit. In a third of the batches a third of the waves is plain; four in five batches have 2 to 40 points, which are
integrated otherwise than many. Tolerances are 1e-2 to 1e-9, in wide ones to 1e-6. Wrong are: an error, a figure that
is NaN and has no reason, a contact fraction outside [0, 1], a speed outside its extremes, a stall torque beyond
friction's, a negative bound, a batch that takes more than 10 s for 1,000 points, and points that are not, alone, what
they are in their batch, to the last bit (3 of a large batch are tried, and all of a small one). The exit code is 1 if
anything was.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
import warnings
from collections import Counter

import numpy as np

import trum_sym as ts

__all__ = ["checked", "draw", "main", "study"]

LONGEST = 10.0  # s, for a thousand points
FIGURES = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque", "contact_fraction")
BOUNDS = tuple(f"{name}_error" for name in FIGURES if name != "contact_fraction")
_ALONE = 3  # points of a large batch that are computed alone, too
_SMALL = 40  # points at most in a small batch


def draw(rng: np.random.Generator, count: int, wide: bool) -> tuple[ts.Motor, ts.Drive, dict[str, object]]:
    """A motor and a drive of random points; start, levels and tolerance are of the batch."""
    periods = rng.integers(1, 201 if wide else 31, count)
    plain = rng.random(count) < rng.choice([0, 0, 1 / 3])
    force = rng.uniform(1 if wide else 100, 500 if wide else 220, count)
    values = {
        "rotor_inertia": 10 ** rng.uniform(*((-9, 0) if wide else (-7, -4)), count),
        "friction_coefficient": rng.uniform(0.01 if wide else 0.2, 1.0 if wide else 0.3, count),
        "contact_radius": rng.uniform(0.02, 0.029, count),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ImplausibleWarning)
        motor = ts.load_motor().with_values(values)
    limit = values["friction_coefficient"] * force * values["contact_radius"]
    share = rng.uniform(-1.3, 1.3, count) if wide else np.tanh(rng.normal(0, 1.5, count))
    drive = ts.Drive(
        prepressure=force,
        frequency_difference=rng.uniform(-5000, 5000, count),
        periods=periods,
        on_periods=np.where(plain, periods, rng.integers((periods + 1) // 2, periods + 1)),
        load_torque=share * limit * rng.choice([1.0, 1e-9, 0.0], count, p=[0.9, 0.05, 0.05]),
        switching_phase=rng.uniform(0, 2 * np.pi, count) * rng.integers(0, 2, count),
        phase_lead=rng.choice([-1, 1], count),
        start=str(rng.choice(["periodic", "steady", "rest"])),
    )
    options = {
        "contact": str(rng.choice(["winkler", "hertz"])),
        "foundation": str(rng.choice(["harmonic", "none"])),
        "tolerance": float(10 ** rng.uniform(-6 if wide else -9, -2)),
    }
    return motor, drive, options


def _alone(value: object, k: int) -> object:
    """Of an array the k-th number, of a value with fields all of theirs."""
    if isinstance(value, np.ndarray) and value.ndim:
        return value[k].item()
    return value


def checked(motor: ts.Motor, drive: ts.Drive, options: dict[str, object], picked: np.ndarray) -> Counter[str]:
    """What is wrong with a batch, by kind; ``picked`` points are computed alone, too."""
    wrong: Counter[str] = Counter()
    points = ts.evaluate(motor, drive, **options)
    known = np.asarray(points.reason) == ""
    for name in FIGURES:
        bound = getattr(points, f"{name}_error", np.zeros(known.shape))
        wrong[f"{name} is no number, without a reason"] += int(np.sum(known & ~np.isfinite(getattr(points, name))))
        wrong[f"the bound of {name} is negative or no number"] += int(np.sum(known & ~(bound >= 0)))
    given = np.isfinite(points.mean_speed)
    spread = points.max_speed - points.min_speed
    inside = (points.mean_speed >= points.min_speed) & (points.mean_speed <= points.max_speed) & (spread >= 0)
    wrong["a mean outside the extremes"] += int(np.sum(given & ~inside))
    contact = np.asarray(points.contact_fraction)
    wrong["a contact fraction outside [0, 1]"] += int(np.sum((contact < 0) | (contact > 1)))
    radius, friction = (np.asarray(getattr(motor, name).value) for name in ("contact_radius", "friction_coefficient"))
    most = friction * np.asarray(drive.prepressure) * radius
    wrong["a stall torque beyond friction's"] += int(np.sum(np.abs(points.stall_torque) > most * (1 + 1e-12)))
    wrong["flagged, but without a reason"] += int(np.sum(np.asarray(points.converged) != known))
    for k in picked:
        one = motor.with_values({name: _alone(p.value, k) for name, p in motor.parameters()})
        fields = {field.name: _alone(getattr(drive, field.name), k) for field in dataclasses.fields(drive)}
        alone = ts.evaluate(one, ts.Drive(**fields), **options)
        for name in (*FIGURES, *BOUNDS):
            a, b = getattr(alone, name), np.asarray(getattr(points, name))[k]
            wrong[f"{name} alone is another number"] += int(not (a == b or (np.isnan(a) and np.isnan(b))))
    return +wrong


def study(count: int, seed: int, batch: int = 1000, say: bool = False) -> Counter[str]:
    """What was wrong, by kind, in so many points."""
    rng, wrong = np.random.default_rng(seed), Counter[str]()
    begin, slowest, done = time.perf_counter(), 0.0, 0
    while done < count:
        small = bool(rng.random() < 0.8)
        size = min(int(rng.integers(2, _SMALL + 1)) if small else batch, count - done)
        motor, drive, options = draw(rng, size, wide=bool(rng.random() < 0.02))
        picked = np.arange(size) if small else rng.integers(0, size, _ALONE)
        start = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                found = checked(motor, drive, options, picked)
            except Exception as error:
                found = Counter({f"{type(error).__name__}: {error}": 1})
        took = (time.process_time() - start) * 1000 / max(size, 1000)
        slowest, done = max(slowest, took), done + size
        if took > LONGEST:
            found["a batch of more than 10 s"] += 1
        if found and say:
            print(f"after {done}: {dict(found)} {options} start {drive.start}", flush=True)
        wrong += found
        if say and done // (100 * batch) > (done - size) // (100 * batch):
            print(f"{done} points, slowest {slowest:.1f} s, {time.perf_counter() - begin:.0f} s", flush=True)
    if say:
        print(f"{done} points, slowest batch {slowest:.1f} s CPU, wrong: {dict(wrong) or 'nothing'}")
    return wrong


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m studies.fuzz_points", description=__doc__.splitlines()[0])
    parser.add_argument("count", nargs="?", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=int(time.strftime("%Y%m%d")))
    parser.add_argument("--batch", type=int, default=1000)
    options = parser.parse_args()
    print(f"seed {options.seed}")
    return int(bool(study(options.count, options.seed, options.batch, say=True)))


if __name__ == "__main__":
    raise SystemExit(main())
