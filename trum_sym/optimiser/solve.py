"""A problem and its answer: map, basins, IPOPT from each, a checked point, or the evidence that there is none."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.holding import Asked
from trum_sym.model.levels import Levels
from trum_sym.optimiser.chart import Chart, basins, chart
from trum_sym.optimiser.descent import Task, Visit, descend
from trum_sym.optimiser.expressions import Constraint, Expression, symbol
from trum_sym.optimiser.extra import casadi
from trum_sym.optimiser.finish import ALLOWED, TOLERANCE, Bounds, Finished, checked, finish
from trum_sym.optimiser.held import HELD_FIGURES
from trum_sym.optimiser.kinks import compass, stationarity
from trum_sym.optimiser.level import Place, seek
from trum_sym.optimiser.model import Box, Functions, Model, functions
from trum_sym.output.progress import duration
from trum_sym.values import Value

__all__ = ["Answer", "Problem", "map_of", "solve"]

_MOST_STARTS = 8
_DESCENTS = 6  # times the map's time that descents take, as measured: from 3 to 20
_DESCENT = 1e-6  # tolerance of IPOPT's orbits
_CLOSE = 1e-3  # objectives closer than this share are finished too; optima closer than this in the box are one
_STEPS = 60  # of a bisection
_STATIONARY = 3e-3  # slope of the scaled objective across the box that is left to a minimum
_DENSE = {1: 65, 2: 25, 3: 9, 4: 6}  # places along a side of the map where drifts and the like are sought
_HELD_STARTS, _FINISHED = 6, 3  # starts; ends of its searches that are gone on from on the finest orbits
_NEAR = 0.1  # of the best one's figures, by which others are worse that are gone on from
_ROUGH, _FINE = 2e-3, 3e-9  # last radii of these, of the box's side
_ROUGHER = 1e-5  # tolerance of the orbits of the first of them


@dataclass(frozen=True, eq=False)
class Problem(Value):
    """Least objective in a box under constraints, for a motor and what of its drive does not vary."""

    motor: Motor
    drive: Drive
    levels: Levels
    box: Box
    objective: Expression
    constraints: tuple[Constraint, ...] = ()
    asked: Asked = field(default_factory=Asked)
    target: float | None = None  # the mean speed that is wanted, rad/s, whether or not a constraint holds it

    @property
    def names(self) -> frozenset[str]:
        """The figures that occur."""
        return self.objective.names.union(*(constraint.expression.names for constraint in self.constraints))

    def model(self) -> Model:
        """The figures of this problem's points; problems that differ in the constraints' bounds only may share it."""
        return Model(self.motor, self.drive, self.levels, self.box, self.names, self.asked, self.target)


@dataclass(frozen=True)
class Answer:
    """What was found, and why it is to be believed.

    Attributes
    ----------
    status : {"solved", "infeasible", "failed"}
        ``infeasible``: the least violation, or a constraint's whole range in the box, was found and excludes it;
        ``failed``: neither a point nor such evidence was found.
    best : Finished or None
        The optimum, or the nearest point that can be reached; None where no speed balances the load anywhere.
    optima : list of (share, objective)
        Local optima that are distinct, best first, as IPOPT left them.
    map_shape : tuple of int
    basins : int
        Places of the map that no place around beats.
    starts : int
        Those that IPOPT started from.
    stationarity : float or None
        Slope of the objective across the box, over the objective, that the constraints and edges leave at the best of
        IPOPT's places; above 3e-3 a kink has stopped it, and a compass search has gone on from there.
    ranges : dict
        Lowest and highest value of an equality's expression in the box, where they were looked for.
    evaluations : int
        Orbits computed.
    """

    status: str
    best: Finished | None
    optima: list[tuple[Array, float]]
    map_shape: tuple[int, ...]
    basins: int
    starts: int
    stationarity: float | None
    ranges: dict[int, tuple[float, float]]
    evaluations: int


@dataclass
class _Search:
    """A problem under way."""

    problem: Problem
    model: Model
    map: Chart
    functions: Functions
    bounds: Bounds
    span: Array  # of the constraints over the map
    optima: list[tuple[Array, float]] = field(default_factory=list)
    basins: int = 0
    starts: int = 0
    stationarity: float | None = None
    ranges: dict[int, tuple[float, float]] = field(default_factory=dict)

    def answer(self, status: str, best: Finished | None) -> Answer:
        """As it stands."""
        return Answer(
            status=status,
            best=best,
            optima=self.optima,
            map_shape=self.map.shape,
            basins=self.basins,
            starts=self.starts,
            stationarity=self.stationarity,
            ranges=self.ranges,
            evaluations=self.model.evaluations,
        )


def solve(
    problem: Problem,
    model: Model | None = None,
    known: Chart | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> Answer:
    """Find the least objective in the box.

    Parameters
    ----------
    problem : Problem
        Objective, constraints and box.
    model : Model, optional
        From a problem that names the same figures; counts the evaluations.
    known : Chart, optional
        Its map, if it is there already.
    tell : callable
        Told what is begun, and how long that may take, by the map's time.
    """
    begin = time.monotonic()
    model = problem.model() if model is None else model
    held = bool(problem.names & set(HELD_FIGURES))
    tell("a map of the box")
    known = map_of(problem, model) if known is None else known
    tell(f"descents from its basins, about {duration(_DESCENTS * (time.monotonic() - begin))}")
    rows = functions([problem.objective, *(constraint.expression for constraint in problem.constraints)])
    values = rows.values(known.figures)
    low = np.array([constraint.low for constraint in problem.constraints])
    high = np.array([constraint.high for constraint in problem.constraints])
    span, size = _extent(values[:, 1:])
    bound = np.where(np.isfinite(low), low, high)
    search = _Search(problem, model, known, rows, Bounds(low, high, np.where(bound == 0, size, np.abs(bound))), span)
    if not np.isfinite(known.figures["mean_speed"]).any():
        return search.answer("infeasible", None)
    places, objective, violation = basins(known, rows, low, high, span)
    if held:
        return _solve_held(search, places, violation)
    met = violation <= 1e-12
    search.basins = int(met.sum())
    best = _descend_and_finish(search, places[met], objective[met]) if met.any() else None
    if best is None or not best.feasible:
        begun, nearest = _towards_feasible(search, places[~met])
        again = _descend_and_finish(search, begun, objective) if len(begun) else None
        found = [point for point in (best, again, nearest) if point is not None]
        best = min(found, key=_order, default=None)
    if best is not None and best.feasible:
        return search.answer("solved", best)
    return search.answer("infeasible" if _excluded(search, best) else "failed", best)


def map_of(problem: Problem, model: Model) -> Chart:
    """The map of a problem's box, denser where drifts and the like are sought."""
    dense = _DENSE[len(problem.box.names)] if problem.names & set(HELD_FIGURES) else None
    return chart(model, dense)


def _solve_held(search: _Search, places: Array, violation: Array) -> Answer:
    """The least objective, or the least violation, where figures have no slopes that are worth their price."""
    model, rows, bounds, constraints = search.model, search.functions, search.bounds, search.problem.constraints
    search.basins = int((violation <= 1e-12).sum())
    spacing = 1.0 / (max(search.map.shape) - 1)
    starts = places[:_HELD_STARTS]
    search.starts = len(starts)
    ends: list[Place] = []
    for end in sorted(
        seek(model, rows, constraints, bounds, starts, (spacing, _ROUGH), _ROUGHER), key=lambda e: e.rank
    ):
        if all(np.max(np.abs(end.share - other.share)) > _CLOSE for other in ends):
            ends.append(end)
    if not ends:
        return _without_level(search)
    begun = np.array([end.share for end in ends[:_FINISHED] if _near(end, ends[0])])
    found = sorted(seek(model, rows, constraints, bounds, begun, (_ROUGH, _FINE), TOLERANCE), key=lambda end: end.rank)
    others = [end for end in ends if not any(np.array_equal(end.share, share) for share in begun)]
    met = sorted((end for end in (*found, *others) if end.violation <= ALLOWED), key=lambda end: end.rank)
    search.optima = [(end.share, float(end.values[0])) for end in met]
    points = [checked(model, rows, bounds, end.share) for end in found or ends[:1]]
    best = min(points, key=_order)
    if not best.feasible:  # by a hair, which Newton's method may leave
        (looked,) = _looked(search, rows, best.share[np.newaxis])
        brought = finish(model, rows, bounds, looked)
        best = brought if brought.feasible else best
    return search.answer("solved" if best.feasible else "infeasible", best)


def _near(end: Place, best: Place) -> bool:
    """Whether what is left of a search may still end better than the best so far."""
    if end.violation > ALLOWED or best.violation > ALLOWED:
        return end.violation <= (1 + _NEAR) * best.violation + _NEAR * ALLOWED
    return bool(end.values[0] <= best.values[0] + _NEAR * abs(best.values[0]))


def _without_level(search: _Search) -> Answer:
    """Where no search has met the equalities: what those say by themselves."""
    problem = search.problem
    equal = tuple(c for c in problem.constraints if c.low == c.high)
    aim = Expression("speed_deviation", symbol("speed_deviation"), frozenset({"speed_deviation"}), "rad/s")
    alone = solve(replace(problem, objective=aim, constraints=equal))
    search.model.evaluations += alone.evaluations
    search.ranges = alone.ranges
    nearest = None if alone.best is None else checked(search.model, search.functions, search.bounds, alone.best.share)
    return search.answer("infeasible" if alone.status == "infeasible" else "failed", nearest)


def _extent(values: Array) -> tuple[Array, Array]:
    """Range and largest size of the map's columns, 1 where they do not tell."""
    with np.errstate(all="ignore"):
        columns = np.where(np.isfinite(values), values, np.nan)
        known = np.isfinite(columns).any(axis=0)
        columns = np.where(known, columns, 1.0)
        span, size = np.nanmax(columns, axis=0) - np.nanmin(columns, axis=0), np.nanmax(np.abs(columns), axis=0)
    return np.where(span > 0, span, np.where(size > 0, size, 1.0)), np.where(size > 0, size, 1.0)


def _descend_and_finish(search: _Search, starts: Array, objective: Array) -> Finished | None:
    """IPOPT from each start; the best of what comes out, onto its constraints and checked."""
    model, rows, bounds = search.model, search.functions, search.bounds
    scale = np.concatenate([[_size(search, objective)], search.span])
    tasks = [Task(rows, bounds.low, bounds.high, scale, start) for start in starts[:_MOST_STARTS]]
    found = descend(model, tasks, _DESCENT)
    search.starts += len(tasks)
    missed = [
        float(np.max(np.abs(bounds.excess(v.values[1:])) * bounds.unit / search.span, initial=0.0)) for v in found
    ]
    missed = [
        miss if np.isfinite(miss) and np.isfinite(v.values[0]) else math.inf
        for miss, v in zip(missed, found, strict=True)
    ]
    best: Finished | None = None
    for k in sorted(range(len(found)), key=lambda k: (max(missed[k], 1e-5), found[k].values[0])):
        place, value = found[k].share, float(found[k].values[0])
        distinct = all(np.max(np.abs(place - other)) > _CLOSE for other, _ in search.optima)
        if distinct and missed[k] <= 1e-4:
            search.optima.append((place, value))
        if (
            best is not None
            and best.feasible
            and (not distinct or value > best.objective + _CLOSE * abs(best.objective))
        ):
            continue
        point, left = finish(model, rows, bounds, found[k]), stationarity(found[k], bounds, scale)
        if left > _STATIONARY and missed[k] <= 1e-4:
            further = compass(model, rows, bounds, scale, found[k], _DESCENT)
            if further.values[0] < value:
                point = min(point, finish(model, rows, bounds, further), key=_order)
        if best is None or _order(point) < _order(best):
            best, search.stationarity = point, left
    search.optima.sort(key=lambda optimum: optimum[1])
    return best


def _size(search: _Search, objective: Array) -> float:
    """What the objective is divided by: its least size at the basins, but not much less than its range in the box."""
    of_map = search.functions.values(search.map.figures)[:, 0]
    quarters = np.quantile(of_map[np.isfinite(of_map)], (0.25, 0.75)) if np.isfinite(of_map).any() else np.zeros(2)
    least = float(np.min(np.abs(objective[np.isfinite(objective)]), initial=np.inf))
    size = max(least if np.isfinite(least) else 0.0, 0.01 * float(quarters[1] - quarters[0]))
    return size if 0 < size < np.inf else 1.0


def _order(point: Finished) -> tuple[float, float]:
    """By violation, and among points without by the objective."""
    return max(point.violation, ALLOWED), point.objective


def _towards_feasible(search: _Search, places: Array) -> tuple[Array, Finished | None]:
    """Starts that meet the constraints, which the map does not show; and the nearest point to that."""
    model, rows, bounds = search.model, search.functions, search.bounds
    equal = np.flatnonzero(bounds.low == bounds.high)
    nearest: Finished | None = None
    if equal.size == 1:
        started, nearest = _by_extremes(search, int(equal[0]))
        if started is not None:
            return started[np.newaxis], nearest
    starts = places[:_MOST_STARTS]
    merit = functions([_merit(search)])
    none = np.empty(0)
    found = descend(model, [Task(merit, none, none, np.ones(1), start) for start in starts], _DESCENT)
    search.starts += len(found)
    places = np.array([visit.share for visit in _distinct(found)])
    points = [finish(model, rows, bounds, visit) for visit in _looked(search, rows, places)]
    if nearest is not None:
        points.append(nearest)
    good = [point.share for point in points if point.feasible]
    return np.array(good).reshape(len(good), len(model.box.names)), min(points, key=_order, default=None)


def _merit(search: _Search) -> Expression:
    """The sum of the violations' squares, over the constraints' ranges in the box."""
    terms = []
    for constraint, span in zip(search.problem.constraints, search.span, strict=True):
        graph = constraint.expression.graph
        if constraint.low == constraint.high:
            terms.append((graph - constraint.low) / span)
        elif math.isfinite(constraint.low):
            terms.append(casadi.fmax(0, constraint.low - graph) / span)
        else:
            terms.append(casadi.fmax(0, graph - constraint.high) / span)
    return Expression("violation", casadi.sumsqr(casadi.vertcat(*terms)), search.problem.names, "1")


def _looked(search: _Search, rows: Functions, places: Array) -> list[Visit]:
    """Places with values and slopes of other functions than those that led to them."""
    if not len(places):
        return []
    model = search.model
    figures, by = model.results_with_slopes(model.box.at(places), _DESCENT)
    slopes = rows.slopes(figures, {name: slope * model.box.width for name, slope in by.items()})
    return [Visit(*entry) for entry in zip(places, rows.values(figures), slopes, strict=True)]


def _distinct(found: list[Visit]) -> list[Visit]:
    kept: list[Visit] = []
    for visit in found:
        if all(np.max(np.abs(visit.share - other.share)) > _CLOSE for other in kept):
            kept.append(visit)
    return kept


def _by_extremes(search: _Search, k: int) -> tuple[Array | None, Finished | None]:
    """The range of an expression that is to have a value, under the other constraints.

    If the value is inside, a place that has it, found between two places on its two sides; else the nearer end.
    """
    model, bounds = search.model, search.bounds
    constraints = search.problem.constraints
    others = [constraint for i, constraint in enumerate(constraints) if i != k]
    keep = [i for i in range(len(constraints)) if i != k]
    rest = Bounds(bounds.low[keep], bounds.high[keep], bounds.unit[keep])
    own, value = constraints[k].expression, float(bounds.low[k])
    tasks: list[Task] = []
    signs: list[float] = []
    for sign in (1.0, -1.0):
        turned = Expression(own.text, sign * own.graph, own.names, own.unit)
        rows = functions([turned, *(constraint.expression for constraint in others)])
        places, _, violation = basins(search.map, rows, rest.low, rest.high, search.span[keep])
        for place in places[violation <= 1e-12][: _MOST_STARTS // 2]:
            tasks.append(Task(rows, rest.low, rest.high, np.concatenate([[search.span[k]], search.span[keep]]), place))
            signs.append(sign)
    if not tasks:
        return None, None
    found = descend(model, tasks, _DESCENT)
    search.starts += len(found)
    rows = functions([own, *(constraint.expression for constraint in others)])
    for visit, sign in zip(found, signs, strict=True):
        visit.values[0], visit.slopes[0] = sign * visit.values[0], sign * visit.slopes[0]
    ends = [point for point in (finish(model, rows, rest, visit) for visit in _distinct(found)) if point.feasible]
    if not ends:
        return None, None
    lowest, highest = min(ends, key=lambda e: e.objective), max(ends, key=lambda e: e.objective)
    search.ranges[k] = (lowest.objective, highest.objective)
    nearer = min(ends, key=lambda end: abs(end.objective - value))
    nearest = checked(model, search.functions, bounds, nearer.share)
    if not lowest.objective <= value <= highest.objective:
        return None, nearest
    return _between(search, functions([own]), lowest.share, highest.share, value), nearest


def _between(search: _Search, rows: Functions, low: Array, high: Array, value: float) -> Array:
    """A place on the line between two where an expression has a value that lies between theirs, by bisection.

    Eight places at a time, which cost what one does.
    """
    model, d = search.model, len(search.model.box.names)
    for _ in range(_STEPS):
        along = np.linspace(0.0, 1.0, 10)[1:-1, np.newaxis]
        places = low + along * (high - low)
        found = rows.values(model.results(model.box.at(places), TOLERANCE))[:, 0]
        below = np.flatnonzero(found <= value)
        above = np.flatnonzero(found > value)
        if below.size + above.size < len(places):  # no orbit in between
            return low
        last = below.max() if below.size else -1
        new_low = low if last < 0 else places[last]
        new_high = high if last + 1 == len(places) else places[last + 1]
        low, high = new_low, new_high
        if np.max(np.abs(high - low)) < 1e-9 * max(d, 1):
            break
    return low


def _excluded(search: _Search, best: Finished | None) -> bool:
    """Whether what was found excludes a feasible point: an end of the range, or a least violation above rounding."""
    for k, (lowest, highest) in search.ranges.items():
        if not lowest <= search.bounds.low[k] <= highest:
            return True
    return best is not None and 1e-6 < best.violation < math.inf and not search.ranges
