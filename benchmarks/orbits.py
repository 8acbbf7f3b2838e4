"""The rotor's orbit beside what a user would write in an afternoon, each at the setting that just meets an error.

python -m benchmarks --only peers
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

import trum_sym as ts
from benchmarks import peers
from benchmarks.rows import Row, least
from trum_sym.model.levels import Levels, Method
from trum_sym.model.operating_point import Case, prepare
from trum_sym.model.rotor import Orbit, grid_is_tried, solve_orbit

__all__ = ["rows"]

ERRORS = (1e-3, 1e-6, 1e-9)
POINTS = 16  # from 160 to 210 N, the rest as in Table 3
STEPS = (8, 16, 25, 50, 100, 200, 400, 800, 1600, 3200, 6400)  # a drive period
SHARES = tuple(10.0**-k for k in range(3, 13))
_LONG = 4.0  # s: settings that take longer for all points are not gone on from

Way = Callable[[peers.Point, float, float], Callable[[], peers.Figures]]
"""From a point, a setting, and the error that is asked for."""


Found = tuple[float, float, float, float]
"""A setting, the worst error of the points with it, least seconds a point, and the spread of these."""


def _of_peer(
    points: Sequence[peers.Point], known: Sequence[peers.Figures], way: Way, settings: Sequence[float], repeats: int
) -> Iterator[Found]:
    """For every error: the first setting whose worst error meets it, with that error and seconds a point; else NaN."""
    k, worst = 0, np.inf
    for error in ERRORS:
        while k < len(settings):
            begin = time.process_time()
            runs = [way(point, settings[k], error) for point in points]
            worst = max(run().error(of) for run, of in zip(runs, known, strict=True))
            if worst <= error:
                break
            k = len(settings) if time.process_time() - begin > _LONG else k + 1
        if k == len(settings):
            yield np.nan, worst, np.nan, 0.0
        else:
            shortest, spread = least(lambda runs=runs: [run() for run in runs], repeats)
            yield settings[k], worst, shortest / len(points), spread


def _figures(orbit: Orbit, radius: float) -> list[peers.Figures]:
    columns = (orbit.mean_speed, orbit.min_speed, orbit.max_speed, np.sqrt(orbit.variance))
    return [peers.Figures(*(radius * float(x) for x in row)) for row in zip(*map(np.atleast_1d, columns), strict=True)]


def _ours(case: Case, method: Method) -> Callable[[], Orbit]:
    """The orbit without the lap of a rotor that is held, which peers do not integrate."""
    return lambda: solve_orbit({**case.arguments, "held": 0.0}, case.symbols, method=method)


def _rows_of_ours(
    motor: ts.Motor,
    forces: np.ndarray,
    known: Sequence[peers.Figures],
    error: float,
    count: int,
    repeats: int,
    method: Method,
) -> list[tuple[str, Found]]:
    """One point after the other, and a batch."""
    radius, drive = float(motor.contact_radius.value), ts.Drive()
    singles = [_ours(prepare(motor, replace(drive, prepressure=float(f)), Levels(), error), method) for f in forces]
    worst = max(_figures(run(), radius)[0].error(of) for run, of in zip(singles, known, strict=True))
    alone, apart = least(lambda: [run() for run in singles], repeats)
    many = np.linspace(forces[0], forces[-1], count)
    batch = _ours(prepare(motor, replace(drive, prepressure=many), Levels(), error), method)
    together, spread = least(batch, repeats)
    return [
        (f"ours, {method}, a point alone", (error, worst, alone / len(singles), apart)),
        (f"ours, {method}, a batch of {count}", (error, worst, together / count, spread)),
    ]


def rows(repeats: int, count: int) -> list[Row]:
    """Least processor time a point, one thread; the ratio is of the fastest peer's time to it, at equal measured error.

    Errors are those of mean, extremes and deviation over the largest speed, the worst of the points, against the
    witness at 1e-12; those of SciPy and diffrax of the mean alone, over one lap from a start that they are given.
    """
    motor = ts.load_motor("trum60")
    forces = np.linspace(160.0, 210.0, POINTS)
    points = [peers.Point.of(motor, ts.Drive(prepressure=float(f))) for f in forces]
    known, starts = zip(*(point.reference() for point in points), strict=True)
    begun = {id(point): start for point, start in zip(points, starts, strict=True)}
    ways: dict[str, tuple[Way, Sequence[float]]] = {
        "Numba, RK4, surface computed once": (lambda point, s, error: peers.fixed(point, int(s), error), STEPS),
        "Numba, Dormand-Prince": (lambda point, s, error: peers.adaptive(point, s, max(error, 100 * s)), SHARES),
        "SciPy odeint, Numba's right-hand side, one lap": (
            lambda point, s, _: peers.scipy_lap(point, begun[id(point)], s),
            SHARES,
        ),
    }
    found: dict[str, list[Found]] = {
        name: list(_of_peer(points, known, way, settings, repeats)) for name, (way, settings) in ways.items()
    }
    try:
        found["diffrax, Tsit5, vmap, one lap"] = list(_of_diffrax(points, known, starts, repeats))
    except ImportError:
        found["diffrax, not installed"] = [(np.nan, np.nan, np.nan, 0.0)] * len(ERRORS)
    shown: list[Row] = []
    for k, error in enumerate(ERRORS):
        section = f"an orbit to {error:g} of the largest speed"
        times = [entry[k][2] for entry in found.values() if np.isfinite(entry[k][2])]
        methods: list[Method] = ["grid", "adaptive"] if grid_is_tried("auto", error) else ["adaptive"]
        ours = [row for m in methods for row in _rows_of_ours(motor, forces, known, error, count, repeats, m)]
        for name, (setting, worst, seconds, spread) in [*ours, *((n, entry[k]) for n, entry in found.items())]:
            if np.isnan(seconds):
                note = "" if np.isnan(worst) else f"not met in {_LONG:g} s: {worst:.1e}"
                shown.append(Row(section, name, None, "ms", note=note))
            else:
                ratio = min(times) / seconds if times else None
                note = f"worst error {worst:.1e} at {setting:g}"
                shown.append(Row(section, name, 1e3 * seconds, "ms", spread, ratio, note))
    return shown


def _of_diffrax(
    points: list[peers.Point], known: Sequence[peers.Figures], starts: Sequence[float], repeats: int
) -> Iterator[Found]:
    k, worst = 0, np.inf
    for error in ERRORS:
        while k < len(SHARES):
            begin = time.process_time()
            run = peers.diffrax_lap(points, list(starts), SHARES[k])
            worst = max(peers.Figures(x).error(of) for x, of in zip(run(), known, strict=True))
            if worst <= error:
                break
            k = len(SHARES) if time.process_time() - begin > 3 * _LONG else k + 1
        if k == len(SHARES):
            yield np.nan, worst, np.nan, 0.0
        else:
            shortest, spread = least(run, repeats)
            yield SHARES[k], worst, shortest / len(points), spread
