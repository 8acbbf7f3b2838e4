"""How far certificates of pulsed orbits can be trusted: at random points, and about a fold.

    python -m studies.orbit_certificate 200 certificates.jsonl
    python -m studies.orbit_certificate fold

At random points the orbit is found again with far finer time steps: it has to begin within the stated errors of the
state, its figures within theirs, its multipliers in their discs.  From states at random in the box in which the orbit
is said to be alone, the steps that the certificate says to contract have to end at it.  Where laps do not close,
nothing may be certified.  The file keeps what is found, a line a point; a run takes up where it ends.

About a fold, where an orbit and its unstable neighbour meet and vanish, the box may not reach the neighbour, and past
it nothing may be certified.  docs/coupling.md has what they print.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from tabulate import tabulate

import trum_sym as ts
from studies.coupling import draw_pulses
from trum_sym.inputs.checks import Array
from trum_sym.model.coupled_orbit import (
    NAMED,
    CoupledOrbit,
    LapSystem,
    lap_values,
    orbit_from,
    random_start,
    start_of,
)
from trum_sym.model.levels import Levels
from trum_sym.model.orbit_certificate import OrbitCertificate, certificate_of
from trum_sym.output.progress import shown

__all__ = ["checked", "led_back", "main"]

_STARTS = 4  # in the box in which an orbit is alone
_STEPS = 60  # of T from each, at most
_ALLOWED = 1e-7  # that time steps may be off there
_BACK = 1e-3  # of the box, or what time steps may make of it, within which a start ends at the orbit
_FINEST = 1e-12  # tolerance of the orbits compared with: steps as fine as they may be


def led_back(values: Mapping[str, float], orbit: CoupledOrbit, half: float, at: np.random.Generator) -> int:
    """From how many of four states in a box the steps of T lead to the orbit."""
    system = LapSystem(values)
    lap = system.around(orbit.state, orbit.cycles, _ALLOWED)
    inverse = np.linalg.inv(lap.slopes[:-1] - np.eye(system.free.size))
    found = 0
    for k in range(_STARTS):
        aside = at.choice([-1.0, 1.0], system.free.size) if k % 2 else at.uniform(-1, 1, system.free.size)
        state = orbit.state.copy()
        state[system.free] += half * aside * system.sizes[system.free]
        for _ in range(_STEPS):
            end = state
            for _ in range(orbit.cycles):
                end = system.after(end, _ALLOWED)
            change = inverse @ ((end - state) / system.sizes)[system.free]
            if not np.isfinite(change).all():
                break
            state[system.free] -= change * system.sizes[system.free]
            if system.distance(state, orbit.state) < max(_BACK * half, 1e3 * _ALLOWED):
                found += 1
                break
    return found


def checked(seed: int) -> dict[str, Any]:
    """A random pulsed point: its certificate beside an orbit of the finest steps, as shares of what is stated."""
    values = draw_pulses(seed)
    began = time.process_time()
    orbit = orbit_from(values, start_of("steady", values), "steady")
    middle = time.process_time()
    found = certificate_of(values, orbit)
    ended = time.process_time()
    record: dict[str, Any] = {
        "seed": seed,
        "closed": orbit.closed,
        "attracts": orbit.stable,
        "certified": found.certified,
        "reason": found.reason,
        "cost": (ended - middle) / (middle - began),
        "laps": found.laps,
    }
    if not found.certified:
        return record
    record |= {"stable": found.stable, "radius": found.radius, "alone": found.alone_within}
    record |= {"disc": float(found.multiplier_error.max()), "back": _back(values, orbit, found, seed)}
    return record | _compared(values, orbit, found)


def _back(values: Mapping[str, float], orbit: CoupledOrbit, found: OrbitCertificate, seed: int) -> int:
    return led_back(values, orbit, found.alone_within, np.random.default_rng(seed))


def _compared(values: Mapping[str, float], orbit: CoupledOrbit, found: OrbitCertificate) -> dict[str, Any]:
    """Of what is stated, how much the orbit is off from that of the finest steps; nothing where these do not close."""
    finer = orbit_from({**values, "wanted": _FINEST}, orbit.state, "finer", settling=0)
    if not (finer.closed and finer.cycles == orbit.cycles):
        return {}
    free = LapSystem(values).free
    off = np.abs(finer.state - orbit.state)[free] / found.state_error[free]
    beyond = np.abs(finer.multipliers[:, np.newaxis] - found.multipliers) / found.multiplier_error
    stated = [getattr(found, f"{name}_error") for name in NAMED]
    figures = [abs(getattr(finer, name) - getattr(orbit, name)) for name in NAMED]
    richardson = [getattr(orbit, f"{name}_error") for name in NAMED]
    return {
        "state": float(off.max()),
        "discs": float(beyond.min(axis=1).max()),
        "figures": [float(one / error) for one, error in zip(figures, stated, strict=True)],
        "by richardson": [float(one / other) for one, other in zip(stated, richardson, strict=True)],
    }


def _share(name: str, values: Array) -> str:
    return f"{name:<26} median {np.median(values):.3f}, largest {values.max():.2f}, above 1: {int((values > 1).sum())}"


def _print(records: list[dict[str, Any]]) -> int:
    certified, closed = [r for r in records if r["certified"]], [r for r in records if r["closed"]]
    wrong = [r["seed"] for r in certified if not r["closed"]]
    print(
        f"{len(records)} pulsed points, laps close at {len(closed)}, of which certified: {len(certified) - len(wrong)}"
    )
    print(
        f"where laps do not close: {len(records) - len(closed)}, certified: {len(wrong)}"
        + (f" {wrong}" if wrong else "")
    )
    if wrong or not certified:
        return 1
    refused = [f"  seed {r['seed']}, refused: {r['reason']}" for r in closed if not r["certified"]]
    print("\n".join(refused), end="\n" * bool(refused))
    print("of {1} certified that attract, {0} are stable beyond their discs".format(*_counts(certified)))
    missed = _print_shares([r for r in certified if "state" in r])
    back = sum(r["back"] for r in certified)
    print(f"starts where the orbit is alone: {_STARTS * len(certified)}, led back to it: {back}")
    for name in ("radius", "alone", "disc"):
        low, middle, high = np.quantile([r[name] for r in certified], (0.05, 0.5, 0.95))
        print(f"{name:<7} 5, 50, 95 %: {low:.1e} {middle:.1e} {high:.1e}")
    cost, laps = np.median([r["cost"] for r in closed]), np.median([r["laps"] for r in closed])
    print(f"time over that of the orbit, where laps close: median {cost:.2g}, of {laps:.0f} laps")
    return int(back < _STARTS * len(certified) or missed > 0)


def _counts(certified: list[dict[str, Any]]) -> list[int]:
    return [sum(r[name] for r in certified) for name in ("stable", "attracts")]


def _print_shares(compared: list[dict[str, Any]]) -> int:
    """Print by how much of what is stated orbits are off; how often by more."""
    print(f"beside orbits of the finest steps, {len(compared)}; difference over what is stated:")
    rows = {name: np.array([r[name] for r in compared]) for name in ("state", "discs")}
    rows |= {name: np.array([r["figures"][k] for r in compared]) for k, name in enumerate(NAMED)}
    for name, values in rows.items():
        print("  " + _share(name, values))
    ratio = np.nanmedian([r["by richardson"][0] for r in compared])
    print(f"stated error of the mean over the orbit's own: median {ratio:.2g}")
    return sum(int((values > 1).sum()) for values in rows.values())


def _at(hertz: float) -> dict[str, float]:
    """Table 3's point at another frequency difference, on the layer, under a rotor of 0.1 kg."""
    return lap_values(ts.load_motor(), ts.Drive(frequency_difference=hertz), Levels(), rotor_mass=0.1)


def _onward(hertz: float, state: Array) -> CoupledOrbit | None:
    """The orbit at a frequency, next to one at another."""
    values = _at(hertz)
    orbit = orbit_from(values, state, "followed", settling=0)
    near = LapSystem(values).distance(orbit.state, state) < 0.3
    return orbit if orbit.closed and orbit.cycles == 1 and near else None


def branch(begin: float = 3000.0) -> list[tuple[float, CoupledOrbit]]:
    """The orbits of the upper branch while the frequency difference in Hz rises, until it ends."""
    at, values = np.random.default_rng(0), _at(begin)
    starts = (orbit_from(values, random_start(values, at), "random") for _ in range(40))
    path = [(begin, next(orbit for orbit in starts if orbit.closed and orbit.stable and orbit.mean_speed < -5.5))]
    step = 50.0
    while step > 1e-3:
        further = _onward(path[-1][0] + step, path[-1][1].state)
        if further is None:
            step /= 4
        else:
            path.append((path[-1][0] + step, further))
    return path


def _fold() -> int:
    """Print certificates along the branch, about its end; 1 if a box reaches the neighbour, or is past the end."""
    path = branch()
    end, last = path[-1]
    rows, wrong = [], False
    for off in (-100.0, -30.0, -10.0, -3.0, -1.0, -0.3, -0.1, 0.01, 0.1, 1.0, 10.0):
        values = _at(end + off)
        before = next((orbit for hertz, orbit in reversed(path[:-1]) if hertz <= end + min(off, -0.1)), last)
        orbit = orbit_from(values, before.state if off < 0 else last.state, "followed", settling=0)
        found, apart = certificate_of(values, orbit), np.nan
        if orbit.closed:
            other = orbit_from(values, 2 * last.state - orbit.state, "neighbour", settling=0)
            apart = LapSystem(values).distance(other.state, orbit.state) if other.closed else np.nan
        wrong = wrong or found.alone_within > apart > 10 * found.radius or (off > 0 and found.certified)
        most = float(np.abs(orbit.multipliers).max())
        shown_ = (found.radius, found.alone_within, apart if apart > 1e-5 else np.nan)
        rows.append(
            (
                f"{off:+g}",
                f"{orbit.mean_speed:.3f}" if orbit.closed else "none",
                *(f"{one:.1e}" if np.isfinite(one) else "" for one in shown_),
                f"{most:.2f}" if orbit.closed else "",
                f"{found.multiplier_error.max():.2f}" if found.certified else "",
                found.reason,
            )
        )
    print(f"the branch ends at {end:.3f} Hz")
    head = ("Hz off", "mean, rad/s", "radius", "alone within", "neighbour at", "multiplier", "its disc", "refused, for")
    print(tabulate(rows, head, disable_numparse=True))
    return int(wrong)


def main(arguments: list[str]) -> int:
    """Check random points and print what comes of them; 1 if one is not as it is certified to be."""
    if arguments == ["fold"]:
        return _fold()
    if not 1 <= len(arguments) <= 2 or not arguments[0].isdecimal():
        print("python -m studies.orbit_certificate COUNT [FILE.jsonl], or fold", file=sys.stderr)
        return 2
    file = Path(arguments[1]) if len(arguments) > 1 else None
    lines = file.read_text(encoding="utf-8").splitlines() if file is not None and file.exists() else []
    records = {record["seed"]: record for record in map(json.loads, lines)}
    for seed in shown([seed for seed in range(int(arguments[0])) if seed not in records], "certificates"):
        records[seed] = checked(seed)
        if file is not None:
            with file.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(records[seed]) + "\n")
    return _print([records[seed] for seed in range(int(arguments[0]))])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
