"""Random points over a wide domain: ``ts.evaluate`` beside the independent orbit of :mod:`orbit_reference`.

python -m studies.orbit [COUNT]     prints every disagreement
"""

from __future__ import annotations

import sys
import time
import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import trum_sym as ts
from trum_sym.inputs.plausible import unquestioned

if TYPE_CHECKING:
    from tests.orbit_reference import Reference

SEED = 20211110
FIGURES = ("mean", "low", "high", "deviation")
STARTS = ("periodic", "steady", "rest")


@dataclass(frozen=True)
class Sample:
    """One point: values of the motor and fields of the drive."""

    motor: dict[str, float]
    drive: dict[str, object]

    @property
    def friction_torque(self) -> float:
        return 0.0265 * self.motor["friction_coefficient"] * self.drive["prepressure"]


def samples(count: int, seed: int = SEED, periods: tuple[int, int] = (4, 100)) -> list[Sample]:
    """Two points in three carry a share of what friction can hold, the third any load between -1 and 1 N m."""
    rng = np.random.default_rng(seed)
    found = []
    for i in range(count):
        m = int(rng.integers(periods[0], periods[1] + 1))
        motor = {
            "rotor_inertia": float(10 ** rng.uniform(-7, -2)),
            "friction_coefficient": float(rng.uniform(0.05, 0.5)),
            "contact_radius": 0.0265,
        }
        drive: dict[str, object] = {
            "prepressure": float(rng.uniform(20, 400)),
            "frequency_difference": float(rng.uniform(-5000, 5000)),
            "periods": m,
            "on_periods": int(rng.integers((m + 1) // 2, m + 1)),
            "switching_phase": float(rng.uniform(0, 2 * np.pi)),
            "phase_lead": int(rng.choice([-1, 1])),
            "start": STARTS[i % 3],
        }
        share, load = rng.uniform(-0.95, 0.95), rng.uniform(-1, 1)
        if (i // 3) % 3 < 2:
            load = np.clip(share * 0.0265 * motor["friction_coefficient"] * drive["prepressure"], -1, 1)
        found.append(Sample(motor, {**drive, "load_torque": float(load)}))
    return found


def evaluate(points: list[Sample], tolerance: float) -> list[ts.OperatingPoint]:
    """The product's answer to every point, one call for all points of one start."""
    base, answers = ts.load_motor("trum60"), [None] * len(points)
    for start in STARTS:
        chosen = [i for i, point in enumerate(points) if point.drive["start"] == start]
        if not chosen:
            continue
        motor, drive = (
            {name: np.array([getattr(points[i], part)[name] for i in chosen]) for name in names}
            for part, names in (("motor", points[0].motor), ("drive", points[0].drive.keys() - {"start"}))
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ts.ValidityWarning)  # prepressures beyond eq. 8's fit
            with unquestioned():  # on purpose beyond the range that the motor file states
                machine = base.with_values(motor)
            batch = ts.evaluate(machine, ts.Drive(**drive, start=start), tolerance=tolerance)
        for place, i in enumerate(chosen):
            shape = np.shape(batch.mean_speed)
            single = {name: value[place] for name, value in batch.figures.items() if np.shape(value) == shape}
            answers[i] = replace(batch, **single)
    return answers


def reference(point: Sample, answer: ts.OperatingPoint, **accuracy: float) -> Reference:
    """The reference of a point, on the stator that the product found."""
    from tests.orbit_reference import Reference  # loads numba

    with unquestioned():
        machine = ts.load_motor("trum60").with_values(point.motor)
    return Reference(machine, ts.Drive(**point.drive), answer, **accuracy)


def disagreement(point: Sample, answer: ts.OperatingPoint) -> tuple[bool, np.ndarray]:
    """Whether no speed balances the load; else errors of mean, low, high, deviation over the largest speed."""
    other = reference(point, answer)
    if other.runaway:
        return True, np.array([answer.mean_speed, answer.min_speed, answer.max_speed, answer.speed_volatility])
    orbit = other.orbit()
    ours = np.array(
        [
            answer.mean_speed,
            answer.min_speed,
            answer.max_speed,
            answer.speed_volatility * abs(answer.mean_speed),
        ]
    )
    theirs = np.array([orbit.mean, orbit.low, orbit.high, orbit.deviation])
    return False, (ours - theirs) / orbit.largest


def main(count: int) -> None:
    """Print how far product and reference are apart."""
    points = samples(count)
    begin = time.perf_counter()
    answers = evaluate(points, 1e-6)
    print(f"product: {(time.perf_counter() - begin) / count:.4f} s a point")
    begin, runaways, errors = time.perf_counter(), 0, []
    for i, (point, answer) in enumerate(zip(points, answers, strict=True)):
        runaway, error = disagreement(point, answer)
        runaways += runaway
        if runaway:
            if answer.converged or not np.isnan(error).all():
                print(f"{i}: runaway, not flagged: {error} {point}")
            continue
        if np.isfinite(error).all():
            errors.append(np.abs(error))
        if not answer.converged or not np.abs(error).max() <= 1e-6:
            told = ", ".join(f"{name} {value:+.1e}" for name, value in zip(FIGURES, error, strict=True))
            print(f"{i}: {told}, converged {bool(answer.converged)}: {point}")
    print(f"reference: {(time.perf_counter() - begin) / count:.4f} s a point")
    spread = np.array(errors)
    print(
        f"{count} points, {runaways} runaway, {len(errors)} compared; largest error of mean, low, high, deviation:",
        spread.max(0),
    )
    print("median:", np.median(spread, 0), " within 1e-6:", int((spread.max(1) <= 1e-6).sum()))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300)
