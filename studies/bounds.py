"""Stated errors beside true ones: random points against an independent orbit, or the closed form of a plain wave.

python -m studies.bounds BOX COUNT [--seed N] [--file FILE.jsonl] [--method grid] [--finest T]

BOX is one of ``stock`` (the stock motor, 100 to 220 N, +-5 kHz, 1 to 30 periods, loads to 0.99999 of the limit),
``limit`` (the same with loads from 0.9 to 0.999999), ``wide`` (inertia 1e-9 to 1e-2 kg m^2, 1 to 200 periods, loads to
0.9999) and ``wave`` (plain travelling waves, both contacts, loads to 0.999999, against the closed form).  Tolerances
from 1e-2 to 1e-9, or to ``--finest``, are drawn with the points.  ``--method`` is that of :func:`trum_sym.evaluate`,
"adaptive" if not given; of the points that a grid leaves to adaptive steps none is compared.  With a file, points that
stand in it are not computed again.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np

import trum_sym as ts
from studies import witness
from trum_sym.model.levels import METHODS, Method

STARTS = ("steady", "rest", "periodic")
FIGURES = ("mean", "low", "high", "deviation", "held")
_OF_DRIVE = ("prepressure", "frequency_difference", "periods", "on_periods", "switching_phase", "phase_lead")
_BLOCK = 250
_FINEST = 1e-13  # accuracy of the witness
_NEAR = 0.5  # of a stated error: a difference beyond it is looked at with that accuracy
_WITNESS = 10  # what the witness says of its own error is taken so many times


@dataclass
class Found:
    """Counts, and stated over true errors by figure."""

    points: int = 0
    converged: int = 0
    compared: int = 0
    on_grid: int = 0
    beyond: int = 0
    flat: int = 0
    ratios: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in FIGURES})
    worst: list[dict[str, Any]] = field(default_factory=list)

    def add(self, row: dict[str, Any]) -> None:
        """Take in a point's row."""
        self.points += 1
        self.converged += row["converged"]
        self.on_grid += row["on_grid"]
        if not row["converged"] or row["doubt"] is None:
            return
        self.compared += 1
        self.flat += row["flat"]
        for name in FIGURES:
            true, stated, doubt = row["true"][name], row["stated"][name], row["doubt"][name]
            if true > stated + doubt:
                self.beyond += 1
                self.worst.append({"figure": name, **row})
            if true > 3 * doubt and true > 0:
                self.ratios[name].append(stated / true)

    def text(self) -> str:
        """What is to be read."""
        lines = [
            f"{self.points} points, {self.converged} converged, {self.on_grid} on a grid, {self.compared} compared, "
            f"{self.beyond} figures beyond"
        ]
        for name, ratios in self.ratios.items():
            if ratios:
                lines.append(
                    f"{name}: stated over true, of {len(ratios)}: least {min(ratios):.3g}, "
                    f"median {np.median(ratios):.3g}"
                )
        lines += [json.dumps(row) for row in self.worst[:20]]
        return "\n".join(lines)


def draw(
    box: str, count: int, seed: int, most_periods: int | None = None, finest: float = 1e-9
) -> dict[str, np.ndarray]:
    """Random points of a box, as columns."""
    rng = np.random.default_rng([seed, sorted(("stock", "limit", "wide", "wave")).index(box)])
    wide = box == "wide"
    m = np.exp(rng.uniform(0, np.log(200.99), count)).astype(int) if wide else rng.integers(1, 31, count)
    m = np.minimum(m, most_periods) if most_periods else m
    n = m if box == "wave" else rng.integers((m + 1) // 2, m + 1)
    nearest = {"stock": 1e-5, "limit": 1e-6, "wide": 1e-4, "wave": 1e-6}[box]
    near = 1 - 10 ** rng.uniform(np.log10(nearest), -1 if box == "limit" else -0.3, count)
    share = near * rng.choice([-1, 1], count)
    if box != "limit":
        share = np.where(rng.random(count) < 0.6, rng.uniform(-1, 1, count) * (1 - nearest), share)
    start = rng.choice([0, 2], count) if box == "wave" else rng.integers(0, 3, count)
    return {
        "prepressure": rng.uniform(100, 220, count),
        "frequency_difference": rng.uniform(-5000, 5000, count),
        "periods": m,
        "on_periods": n,
        "share": share,
        "start": start,
        "hertz": rng.integers(0, 2, count),
        "switching_phase": rng.uniform(0, 2 * np.pi, count) * (rng.random(count) < 0.5),
        "phase_lead": rng.choice([-1, 1], count),
        "rotor_inertia": 10 ** rng.uniform(-9, -2, count) if wide else np.full(count, 4.5e-6),
        "friction_coefficient": rng.uniform(0.2, 0.3, count) if wide else np.full(count, 0.25),
        "tolerance": 10 ** rng.uniform(np.log10(finest), -2, count),
    }


def _evaluated(
    columns: dict[str, np.ndarray], chosen: np.ndarray, method: Method
) -> tuple[Any, np.ndarray, np.ndarray, float]:
    """The product's answer, the witness's constants, loads and contact radius for points of one start and contact."""
    c = {name: values[chosen] for name, values in columns.items()}
    motor = ts.load_motor("trum60").with_values({name: c[name] for name in ("rotor_inertia", "friction_coefficient")})
    radius = float(motor.contact_radius.value)
    drive = ts.Drive(
        **{name: c[name] for name in _OF_DRIVE},
        load_torque=c["share"] * c["friction_coefficient"] * c["prepressure"] * radius,
        start=STARTS[int(c["start"][0])],
    )
    contact = "hertz" if c["hertz"][0] else "winkler"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        from trum_sym.model.levels import Levels
        from trum_sym.model.operating_point import prepare
        from trum_sym.model.rotor import solve_orbit

        case = prepare(motor, drive, Levels(contact=contact), 1e-3)
        orbit = solve_orbit({**case.arguments, "tolerance": c["tolerance"]}, case.symbols, method=method)
    stator = {
        "wavenumber": np.asarray(case.stator.k_c),
        "amplitude": np.asarray(case.stator.W),
        "neutral_axis": np.asarray(case.stator.D),
        "resonance_frequency": np.asarray(case.stator.omega_n) / (2 * np.pi),
    }
    values = {name: np.asarray(p.value) for name, p in motor.parameters()}
    given = {**c, "load_torque": drive.load_torque}
    return orbit, witness.constants(values, given, stator, contact), np.asarray(drive.load_torque), radius


def _closed(p: np.ndarray, share: mp.mpf) -> mp.mpf:
    """The rim speed of a plain wave's orbit to 30 digits: where friction within the angle a balances the load."""
    with mp.workdps(30):
        height, sense = mp.mpf(p[5]), int(np.sign(p[4]))
        even, weight = mp.mpf(0), mp.mpf(1)
        if p[9]:
            theta = min(mp.pi, mp.mpf(p[8]) / mp.sqrt(height))
            even = -mp.cos(theta)
        elif p[7] < np.pi * p[5]:
            theta = mp.findroot(
                lambda x: mp.sin(x) - x * mp.cos(x) - mp.mpf(p[7]) / height, witness.half_angle(p[7] / p[5])
            )
            even = -mp.cos(theta)
        else:
            theta, weight, even = mp.pi, height / mp.mpf(p[7]), 1 / mp.pi

        def within(a: mp.mpf) -> mp.mpf:
            return weight * mp.sin(a) + even * a

        wanted, low, high = (1 + sense * share) / 2 * within(theta), mp.mpf(0), theta
        for _ in range(100):
            middle = (low + high) / 2
            low, high = (low, middle) if within(middle) > wanted else (middle, high)
        return sense * mp.mpf(p[6]) * height * mp.mpf(p[2]) * mp.cos(low)


def _witnessed(
    p: np.ndarray, cycle: tuple[int, int, int], guess: float, accuracy: float
) -> tuple[np.ndarray | None, float]:
    """The witness's mean, lowest, highest speed and deviation, if it finds them, and how far they may be off."""
    found = witness.orbit(p, *cycle, guess, accuracy)
    if found is None:
        return None, np.nan
    top = max(abs(found.low), abs(found.high))
    return np.array([found.mean, found.low, found.high, found.deviation]), _WITNESS * (found.doubt + accuracy * top)


def rows(
    box: str, columns: dict[str, np.ndarray], wanted: np.ndarray, accuracy: float, method: Method = "adaptive"
) -> Iterator[dict[str, Any]]:
    """A row for every point that is wanted."""
    for key in sorted({(int(columns["start"][i]), int(columns["hertz"][i])) for i in wanted}):
        chosen = np.array([i for i in wanted if (columns["start"][i], columns["hertz"][i]) == key])
        orbit, constants, loads, radius = _evaluated(columns, chosen, method)
        raw = orbit.raw
        for k, i in enumerate(chosen):
            if method != "adaptive" and not orbit.on_grid[k]:
                yield {"index": int(i), "converged": bool(orbit.converged[k]), "on_grid": False, "doubt": None}
                continue
            p = constants[k]
            ours = np.array(
                [raw["mean"][k], raw["low"][k], raw["high"][k], np.sqrt(raw["variance"][k]), raw["held"][k]]
            )
            stated = [raw[f"{name}_error"][k] for name in FIGURES]
            m, n, start = (int(columns[name][i]) for name in ("periods", "on_periods", "start"))
            needed = float(np.clip(1e-5 * columns["tolerance"][i], accuracy, 1e-9))
            held, _, reached = witness.held(p, m, n, start, accuracy)
            if abs(ours[4] - held) > _NEAR * stated[4] + _WITNESS * reached:  # it may have missed an event
                held, _, reached = witness.held(p, m, n, start, _FINEST)
            of_held, doubts = _WITNESS * reached, None
            if box == "wave":
                limit = mp.mpf(columns["friction_coefficient"][i]) * mp.mpf(columns["prepressure"][i]) * mp.mpf(radius)
                speed = float(_closed(p, mp.mpf(loads[k]) / limit))
                speeds, doubts = np.array([speed, speed, speed, 0.0]), [2e-15 * abs(speed)] * 3 + [0.0, of_held]
            else:
                guess = raw["start"][k] if np.isfinite(raw["start"][k]) else 0.0
                speeds, doubt = _witnessed(p, (m, n, start), float(guess), needed)
                if speeds is not None and (np.abs(ours[:4] - speeds) > _NEAR * np.array(stated[:4]) + doubt).any():
                    speeds, doubt = _witnessed(p, (m, n, start), float(guess), _FINEST)  # likewise
                if speeds is not None:
                    doubts = [doubt] * 4 + [of_held]
            row = {
                "index": int(i),
                "converged": bool(orbit.converged[k]),
                "on_grid": bool(orbit.on_grid[k]),
                "flags": int(raw["flags"][k]),
                "doubt": None,
                "flat": False,
            }
            row |= {name: float(columns[name][i]) for name in columns}
            if doubts is not None:
                true = np.abs(ours - np.append(speeds, held))
                row |= {
                    name: dict(zip(FIGURES, map(float, values), strict=True))
                    for name, values in (("true", true), ("stated", stated), ("doubt", doubts))
                }
                row["flat"] = bool(speeds[3] > 1e-9 * abs(speeds[0]) and ours[3] == 0.0)
            yield row


def study(
    count: int,
    seed: int,
    box: str,
    accuracy: float = 1e-12,
    periods: int | None = None,
    method: Method = "adaptive",
    finest: float = 1e-9,
) -> Found:
    """Counts over random points."""
    columns, found = draw(box, count, seed, periods, finest), Found()
    for row in rows(box, columns, np.arange(count), accuracy, method):
        found.add(row)
    return found


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m studies.bounds", description=__doc__.splitlines()[0])
    parser.add_argument("box", choices=("stock", "limit", "wide", "wave"))
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=20211110)
    parser.add_argument("--file", type=Path)
    parser.add_argument("--accuracy", type=float, default=1e-12)
    parser.add_argument("--method", choices=METHODS, default="adaptive")
    parser.add_argument("--finest", type=float, default=1e-9)
    options = parser.parse_args()
    print(f"seed {options.seed}")
    columns = draw(options.box, options.count, options.seed, finest=options.finest)
    found, done = Found(), set()
    if options.file and options.file.exists():
        for line in options.file.read_text().splitlines():
            row = json.loads(line)
            done.add(row["index"])
            found.add(row)
    begin = time.perf_counter()
    left = np.array([i for i in range(options.count) if i not in done], dtype=int)
    for block in np.array_split(left, max(1, -(-left.size // _BLOCK))):
        fresh = list(rows(options.box, columns, block, options.accuracy, options.method)) if block.size else []
        for row in fresh:
            found.add(row)
        if options.file:
            with options.file.open("a") as file:
                file.writelines(json.dumps(row) + "\n" for row in fresh)
        print(f"{found.points} points, {found.beyond} beyond, {time.perf_counter() - begin:.0f} s", flush=True)
    print(found.text())


if __name__ == "__main__":
    main()
