"""Pareto fronts: what less volatility costs in speed error or in torque margin."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.points import one_number
from trum_sym.inputs.shown import full
from trum_sym.inputs.spreads import Spread
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import WITHIN, Asked, Holding, compared
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.optimiser.expressions import Constraint, Expression, parse_expression
from trum_sym.optimiser.finish import TOLERANCE, Finished
from trum_sym.optimiser.limits import Holds
from trum_sym.optimiser.model import Model, functions
from trum_sym.optimiser.solve import Answer, Problem, map_of, solve
from trum_sym.output.progress import shown
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.studies.posed import Bound, Held, posed
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["AGAINST", "ParetoFront", "ParetoPoint", "pareto"]

AGAINST = ("torque-margin", "speed-error")
_COUNT = Domain(low=3, low_open=False, high=201, high_open=False, integer=True)
_SAME = 1e-6  # points whose two figures agree to this share of the front are one


@dataclass(frozen=True, eq=False, kw_only=True)
class ParetoPoint(Value):
    """A point of a front that no other point of it beats in both figures; SI units.

    ``objective`` and ``against`` are the two figures; ``figures`` has all of the point.
    """

    objective: float
    against: float
    prepressure: float
    frequency_difference: float
    mean_speed: float
    speed_volatility: float
    stall_torque: float
    constraint_violation: float
    figures: Mapping[str, Any]


@dataclass(frozen=True, eq=False, kw_only=True)
class ParetoFront(Result, Value):
    """A front, from the least ``objective`` to the best ``against``.

    Attributes
    ----------
    status : {"solved", "infeasible", "failed"}
        As of :func:`trum_sym.optimize`.
    objective, against : str
        The two figures.
    larger_is_better : bool
        Of ``against``.
    points : tuple of ParetoPoint
    gaps : tuple of (float, float)
        Ranges of ``against`` without a point of the front: a limit inside was not used up.
    asked, evaluations : int
        Problems solved, orbits computed.
    message : str
    inputs : Inputs
        What all points share.
    terms : Asked
        How near, against what and in what time the points are to be held.
    """

    status: str
    objective: str
    against: str
    larger_is_better: bool
    points: tuple[ParetoPoint, ...]
    gaps: tuple[tuple[float, float], ...]
    asked: int
    evaluations: int
    message: str
    inputs: Inputs = field(repr=False)
    terms: Asked = field(repr=False, default_factory=Asked)

    @property
    def holdings(self) -> list[Holding]:
        """What it takes to hold each point."""
        if not self.points:
            return []
        names = ("prepressure", "frequency_difference", "switching_phase")
        rows: dict[str, Any] = {name: np.array([p.figures[name] for p in self.points]) for name in names}
        inputs = self.inputs
        return self.terms.each(inputs.motor, replace(inputs.drive, **rows), inputs.levels)

    def __repr__(self) -> str:
        return f"<ParetoFront {self.status}: {self.message}>"

    def to_dict(self) -> dict[str, Any]:
        """Inputs, points with their drives and remarks, and units by name, in SI units."""
        holdings = self.holdings
        keys = [name for name in ParetoPoint.__dataclass_fields__ if name != "figures"]
        points = [
            {
                **{key: getattr(point, key) for key in keys},
                "drive": {
                    name: point.figures[name] for name in ("prepressure", "frequency_difference", "switching_phase")
                },
                "holding": holding.entries(),
                "remarks": holding.remarks,
            }
            for point, holding in zip(self.points, holdings, strict=True)
        ]
        hidden = ("points", "inputs", "terms")
        own = {name: getattr(self, name) for name in self.__dataclass_fields__ if name not in hidden}
        found = {**self.inputs.record(), **own, "points": points, "remarks": []}
        units = {**units_of(found), "holding": holdings[0].units} if holdings else units_of(found)
        return {**found, "units": units}

    def to_text(self, title: str = "") -> str:
        """For people."""
        rows = [
            (
                f"{number}",
                f"{p.objective:.6g}",
                f"{p.against:.6g}",
                f"{full(p.prepressure)}",
                f"{full(p.frequency_difference)}",
                f"{p.mean_speed / ARCSEC:.6g}",
                f"{100 * p.speed_volatility:.5g}",
                f"{p.stall_torque:.5g}",
            )
            for number, p in enumerate(self.points, 1)
        ]
        headers = (
            "#",
            self.objective,
            self.against,
            "prepressure N",
            "frequency difference Hz",
            "mean arcsec/s",
            "volatility %",
            "stall N m",
        )
        lines = [title or one_line(self.inputs.motor.name), "", f"{self.status}: {self.message}"]
        if rows:
            lines += ["", text_table(rows, headers, "r" * 8)]
        holdings = self.holdings
        if holdings:
            lines += ["", compared([f"{k}" for k in range(1, len(holdings) + 1)], holdings, "#"), ""]
        for number, holding in enumerate(holdings, 1):
            lines += [f"remark on #{number}: {remark}" for remark in holding.remarks]
        lines += [f"gap: nothing between {self.against} {low:.6g} and {high:.6g}" for low, high in self.gaps]
        return "\n".join([*lines, "", f"{self.asked} problems, {self.evaluations} orbits computed"])


def pareto(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    objective: str = "volatility",
    against: str = "torque-margin",
    target_speed: float | str | None = None,
    points: int = 11,
    bounds: Mapping[str, Bound] | None = None,
    constraints: Sequence[str] = (),
    holds: Holds | None = None,
    starts: float | str | None = None,
    within: float | str = WITHIN,
    spreads: Mapping[str, Spread] | None = None,
    sampling_period: float | str | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> ParetoFront:
    """The points of a box that cannot be bettered in one figure without losing in another.

    The least ``objective`` is sought under limits on ``against`` that run from its value at the least objective to its
    best value (the epsilon-constraint method), each from the whole map of the box, so that fronts that bend either way
    are found; what another point beats in both is left out.

    Parameters
    ----------
    motor, drive, target_speed, bounds, constraints, holds, starts, within, spreads, sampling_period
        As for :func:`trum_sym.optimize`; pulse counts have one value each.
    objective : str
        What is to be small, as there.
    against : str
        ``"torque-margin"``: stall torque less load in the direction of the target (of the clockwise direction if there
        is none), which is to be large; ``"speed-error"``: distance of the mean speed from the target, small, and the
        speed is then not held; or arithmetic on figures, small.
    points : int
        Problems solved along the front, 3 to 201.
    progress : bool
        Whether to show a bar on the standard error.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; ``tangential`` has to be ``"rigid"``.

    Returns
    -------
    trum_sym.studies.pareto.ParetoFront
        Its points from the least ``objective`` to the best ``against``, in SI units.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without CasADi.

    Notes
    -----
    The volatility is eq. 40; fronts of the paper's motor and how they were checked: docs/studies.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> bounds = {"prepressure": 180.0, "frequency_difference": (3000, 3300)}
    >>> front = ts.pareto(drive=ts.Drive(load_torque=0.1), bounds=bounds, points=3)
    >>> [f"{point.objective:.3f} {point.against:.3f} N m" for point in front.points]
    ['3.362 0.124 N m', '3.364 0.126 N m', '3.395 0.128 N m']
    """
    count = int(one_number("points", points, "1", _COUNT))
    target = None if target_speed is None else one_number("target_speed", target_speed, "rad/s")
    if not isinstance(against, str):
        raise ParameterError("against", against, f"one of {', '.join(AGAINST)}, or arithmetic on figures")
    if against == "speed-error" and target is None:
        raise ParameterError("target_speed", "none", "a speed in rad/s for speed-error")
    held = None if against == "speed-error" else target
    terms = Held(holds, starts, within, spreads, sampling_period, target)
    problem = posed(motor, drive, Levels(**levels), objective, held, bounds, constraints, terms)
    expression, sign = _against(against, target)
    walk = _walk(problem, expression, sign, target if against == "speed-error" else None, count, progress)
    best, answers = walk.answers[0], walk.answers
    status, message, found = best.status, "no point of the box meets the constraints", list[_Candidate]()
    if best.status == "solved":
        found = _front(walk.candidates(problem.objective), sign)
        message = f"{len(found)} points of the front of {objective} against {against}"
    return ParetoFront(
        status=status,
        objective=objective,
        against=against,
        larger_is_better=sign < 0,
        points=tuple(_point(problem, candidate) for candidate in found),
        gaps=_gaps(found, walk.limits),
        asked=len(answers),
        evaluations=walk.model.evaluations,
        message=message,
        inputs=Inputs(problem.motor, problem.drive, problem.levels, None, TOLERANCE),
        terms=problem.asked,
    )


def _against(against: str, target: float | None) -> tuple[Expression, float]:
    """The second figure, and -1 if it is to be large."""
    if against == "torque-margin":
        backward = target is not None and target < 0
        return parse_expression(
            "against", "load_torque - stall_torque" if backward else "stall_torque - load_torque"
        ), -1.0
    if against == "speed-error":
        return parse_expression("against", "mean_speed"), 1.0
    return parse_expression("against", against), 1.0


@dataclass(frozen=True)
class _Candidate:
    objective: float
    against: float
    point: Finished


@dataclass
class _Walk:
    """The problems solved along a front, on one map: the first for the least objective, the second the other end."""

    model: Model
    against: Expression
    target: float | None
    answers: list[Answer]
    limits: list[float]

    def value(self, point: Finished) -> float:
        """The second figure of a point."""
        value = _figure(self.against, point)
        return value if self.target is None else abs(value - self.target)

    def candidates(self, objective: Expression) -> list[_Candidate]:
        """What was solved."""
        points = [a.best for a in self.answers if a.status == "solved" and a.best is not None]
        return [_Candidate(_figure(objective, point), self.value(point), point) for point in points]


def _figure(expression: Expression, point: Finished) -> float:
    rows = functions([expression])
    return float(rows.values({name: np.array([point.figures[name]]) for name in rows.names})[0, 0])


def _walk(
    problem: Problem, expression: Expression, sign: float, target: float | None, count: int, progress: bool
) -> _Walk:
    shared = replace(problem, constraints=(*problem.constraints, Constraint(expression, -math.inf, math.inf)))
    model = shared.model()
    known = map_of(shared, model)

    def ask(objective: Expression, *extra: Constraint) -> Answer:
        limited = replace(problem, objective=objective, constraints=(*problem.constraints, *extra))
        return solve(limited, model, known)

    walk = _Walk(model, expression, target, [ask(problem.objective)], [])
    if walk.answers[0].status != "solved":
        return walk
    if target is None:
        turned = Expression(expression.text, sign * expression.graph, expression.names, expression.unit)
        walk.answers.append(ask(turned))
    else:
        walk.answers.append(ask(problem.objective, Constraint(expression, target, target)))
    first, last = (walk.value(answer.best) for answer in walk.answers if answer.best is not None)
    walk.limits += [*np.linspace(first, last, count)[1:-1]] if target is None else _towards_zero(first, last, count)
    for limit in shown(walk.limits, "front" if progress else None):
        if target is None:
            ends = (-math.inf, limit) if sign > 0 else (limit, math.inf)
            walk.answers.append(ask(problem.objective, Constraint(expression, *ends)))
            continue
        low, high = Constraint(expression, target - limit, math.inf), Constraint(expression, -math.inf, target + limit)
        far = target + math.copysign(limit, target)  # a narrow band is best met at its fast end
        walk.answers.append(ask(problem.objective, low, high))
        walk.answers.append(ask(problem.objective, Constraint(expression, far, far)))
    return walk


def _towards_zero(first: float, last: float, count: int) -> list[float]:
    """Limits on an error, half of them in equal steps and half in equal ratios, largest first."""
    least = max(last, 1e-4 * first)
    even, ratio = np.linspace(first, least, count // 2 + 1)[1:], np.geomspace(first, least, count - count // 2)[1:-1]
    return sorted((float(limit) for limit in {*even, *ratio}), reverse=True)


def _front(found: list[_Candidate], sign: float) -> list[_Candidate]:
    """Those that no other beats in both figures, by rising objective."""
    kept: list[_Candidate] = []
    spread = max(c.against for c in found) - min(c.against for c in found)
    for candidate in sorted(found, key=lambda c: (c.objective, sign * c.against)):
        if not kept or sign * candidate.against < sign * kept[-1].against - _SAME * spread:
            kept.append(candidate)
    return kept


def _gaps(front: list[_Candidate], limits: Sequence[float]) -> tuple[tuple[float, float], ...]:
    """Neighbours with a limit between them that neither used up: whatever lies there is beaten."""
    found = []
    for one, other in pairwise(front):
        low, high = sorted((one.against, other.against))
        margin = 1e-3 * (high - low)
        if any(low + margin < limit < high - margin for limit in limits):
            found.append((low, high))
    return tuple(found)


def _point(problem: Problem, found: _Candidate) -> ParetoPoint:
    drive = {**problem.drive.numbers(), **dict(zip(problem.box.names, found.point.point.tolist(), strict=True))}
    figures = found.point.figures
    return ParetoPoint(
        objective=found.objective,
        against=found.against,
        prepressure=float(drive["prepressure"]),
        frequency_difference=float(drive["frequency_difference"]),
        constraint_violation=found.point.violation,
        figures=figures,
        **{name: figures[name] for name in ("mean_speed", "speed_volatility", "stall_torque")},
    )
