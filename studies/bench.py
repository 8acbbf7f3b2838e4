"""Random benches: ``ts.evaluate`` beside rotor, plate and weight as three bodies, integrated by SciPy's solve_ivp.

python -m studies.bench [COUNT]     prints every disagreement

The three bodies keep a velocity each.  Accelerations, the joint's torque and the string's pull are the unknowns of a
linear system: Newton's law of each body and the two constraints, differentiated once.  The friction is that of
``tests/orbit_reference.py``, which shares nothing with the kernels.  Nothing here knows a total inertia.
"""

from __future__ import annotations

import sys
import time
import warnings
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import trum_sym as ts
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import solve_orbit
from trum_sym.model.string import least_tension

SEED = 20211110
GRAVITY = 9.80665
FIGURES = ("start", "mean", "deviation", "tension")
ACCURACY, COARSE = 1e-12, 1e-6  # of solve_ivp's steps


@dataclass(frozen=True)
class Bench:
    """A motor's friction and a drive with a weight and a plate."""

    friction: float
    drive: dict[str, object]

    def motor(self) -> ts.Motor:
        with unquestioned():
            return ts.load_motor("trum60").with_values({"friction_coefficient": self.friction})


def benches(count: int, seed: int = SEED) -> list[Bench]:
    """Plates from a tenth of the rotor's inertia to ten thousand times it, strings from 5 to 150 mm."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        m, friction, force = int(rng.integers(6, 30)), rng.uniform(0.1, 0.4), rng.uniform(110, 210)
        drive: dict[str, object] = {
            "prepressure": float(force),
            "frequency_difference": float(rng.uniform(1000, 5000)),
            "periods": m,
            "on_periods": int(rng.integers((m + 1) // 2, m)),
            "phase_lead": int(rng.choice([-1, 1])),
            "start": str(rng.choice(["periodic", "steady", "rest"])),
            "load_torque": float(rng.choice([-1, 1]) * rng.uniform(0.01, 0.6) * 0.0265 * friction * force),
            "load": "weight",
            "load_radius": float(10 ** rng.uniform(-2.3, -0.8)),
            "load_inertia": float(4.5e-6 * 10 ** rng.uniform(-1, 4)),
        }
        found.append(Bench(float(friction), drive))
    return found


class Bodies:
    """Rotor, plate and weight over a drive cycle, in the sense in which friction would lift the weight."""

    def __init__(self, bench: Bench, point: ts.OperatingPoint) -> None:
        from tests.orbit_reference import GATES, Reference, modal, surface  # loads numba

        motor, drive = bench.motor(), ts.Drive(**bench.drive)
        other = Reference(motor, drive, point)
        self.radius, self.cycle_time = other.radius, other.cycle_time
        self._p, self._states, self._gates = other.p, other.states, GATES
        self._edges = np.concatenate([[0.0], np.cumsum(other.durations)])
        self._modal, self._surface = modal, surface
        rotor, plate, r = float(motor.rotor_inertia.value), float(drive.load_inertia), float(drive.load_radius)
        self.string, self._periods = r, int(drive.periods)
        self.sense = float(np.sign(drive.load_torque))
        self.weight = abs(float(drive.load_torque)) / r  # N
        mass = self.weight / GRAVITY
        # unknowns: accelerations of rotor and plate (rad/s^2) and weight (m/s^2), the joint's torque, the string's pull
        system = np.array(
            [
                [rotor, 0, 0, 1, 0],
                [0, plate, 0, -1, r],
                [0, 0, mass, 0, -1],
                [1, -1, 0, 0, 0],
                [0, r, -1, 0, 0],
            ]
        )
        self._inverse = np.linalg.inv(system)
        self._most = float(motor.friction_coefficient.value) * float(drive.prepressure) * self.radius
        self.largest = 4 * float(np.max(np.abs(other.p[6] * other.p[5] * other.p[0]))) / self.radius

    def _torque(self, region: int, since: float, speed: float) -> float:
        w = self._modal(self._p, self._states[region], self._gates[region], since)
        fraction = self._surface(self._p, w, self.sense * speed * self.radius)[0]
        return self.sense * self._most * fraction

    def unknowns(self, region: int, since: float, speed: float) -> np.ndarray:
        return self._inverse @ np.array([self._torque(region, since, speed), 0.0, -self.weight, 0.0, 0.0])

    def lap(self, start: float, samples: int = 0, accuracy: float = ACCURACY) -> tuple[np.ndarray, float]:
        """Changes of the speeds of rotor, plate, weight over a cycle, with their integral and their square's.

        All three begin at t1 as fast as a rotor of ``start``, rad/s; changes are from there.  With samples the least
        pull over the weight comes with them.
        """
        x, least, longest = np.zeros(5), np.inf, self.cycle_time / self._periods / 20
        most = np.abs(self._inverse @ np.array([self._most, 0.0, self.weight, 0.0, 0.0]))
        size = min(self.largest, float(most[0]) * self.cycle_time)
        span = self.cycle_time
        scale = accuracy * np.array([size, size, size * self.string, size * span, size**2 * span])
        for region in range(3):
            span = self._edges[region + 1] - self._edges[region]
            if span <= 0:
                continue

            def rate(t: float, y: np.ndarray, region: int = region) -> np.ndarray:
                return np.array([*self.unknowns(region, t, start + y[0])[:3], y[0], y[0] ** 2])

            done = solve_ivp(
                rate, (0.0, span), x, "DOP853", rtol=accuracy, atol=scale, max_step=longest, dense_output=samples > 0
            )
            if samples:
                times = np.linspace(0, span, samples)
                pulls = [self.unknowns(region, t, start + done.sol(t)[0])[4] for t in times]
                least = min(least, float(np.min(pulls)) / self.weight)
            x = done.y[:, -1]
        return x, least

    def _gain(self, start: float, accuracy: float = ACCURACY) -> float:
        """What a lap adds to the rotor's speed: falling, and 0 for the orbit."""
        return float(self.lap(start, accuracy=accuracy)[0][0])

    def orbit(self) -> tuple[float, float, float, float, float]:
        """Speed at t1, mean, deviation (rad/s, positive as the rotor counts), least tension, drift of constraints."""
        begin = brentq(lambda v: self._gain(v, COARSE), -self.largest, self.largest, xtol=1e-6 * self.largest)
        reach = 1e-5 * self.largest
        while self._gain(begin - reach) <= 0 or self._gain(begin + reach) >= 0:
            reach *= 4
        x = float(brentq(self._gain, begin - reach, begin + reach, xtol=1e-12 * self.largest))
        end, least = self.lap(x, 1000)
        change = end[3] / self.cycle_time
        mean, deviation = x + change, np.sqrt(max(0.0, end[4] / self.cycle_time - change**2))
        drift = abs(end[1] - end[0]) + abs(end[2] / self.string - end[0])
        return self.sense * x, self.sense * mean, float(deviation), least, float(drift)


def answer(bench: Bench, tolerance: float = 1e-8) -> tuple[ts.OperatingPoint, np.ndarray, float]:
    """The product's point, its figures and its largest speed."""
    motor, drive = bench.motor(), ts.Drive(**bench.drive)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        point = ts.evaluate(motor, drive, tolerance=tolerance)
        case = prepare(motor, drive, Levels(), tolerance)
    orbit = solve_orbit(case.arguments, case.symbols)
    radius = float(motor.contact_radius.value)
    figures = [
        float(orbit.raw["start"]) / radius,
        float(point.mean_speed),
        float(point.speed_volatility) * abs(float(point.mean_speed)),
        float(least_tension(case.arguments, case.symbols, orbit)),
    ]
    return point, np.array(figures), max(abs(float(point.min_speed)), abs(float(point.max_speed)))


def disagreement(bench: Bench) -> np.ndarray:
    """Differences of start, mean and deviation over the largest speed, of the least tension over the weight.

    The tension is compared where the product took it from the orbit, that is, where friction could make it slack.
    """
    point, ours, largest = answer(bench)
    *theirs, drift = Bodies(bench, point).orbit()
    found = np.abs(ours - np.array(theirs))
    found[:3] /= largest
    bound = ours[3] >= 0 and theirs[3] >= ours[3] - 1e-9  # the bound for all friction
    return np.append(np.where([False] * 3 + [bound], 0.0, found), drift / largest)


def main(count: int) -> None:
    """Print how far the product and the three bodies are apart."""
    begin, errors = time.perf_counter(), []
    for i, bench in enumerate(benches(count)):
        error = disagreement(bench)
        errors.append(error)
        if not (error[:3] <= 1e-6).all():
            told = ", ".join(f"{name} {value:.1e}" for name, value in zip(FIGURES, error, strict=False))
            print(f"{i}: {told}: {bench}", flush=True)
    spread = np.array(errors)
    print(f"{(time.perf_counter() - begin) / count:.2f} s a point")
    print(f"{count} points; largest error of {', '.join(FIGURES)}, drift of the constraints:", spread.max(axis=0))
    print("median:", np.median(spread, axis=0), " within 1e-6:", int((spread[:, :3].max(axis=1) <= 1e-6).sum()))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
