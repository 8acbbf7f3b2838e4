"""Robust points: the best worst case over spreads or samples of what is not known exactly."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar, Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import Motor, spec
from trum_sym.inputs.points import one_number
from trum_sym.inputs.shown import full
from trum_sym.inputs.spreads import Spread, read_spread
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import WITHIN, Asked, Holding
from trum_sym.model.inputs import Inputs, remarks_of, units_of
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.optimiser.finish import TOLERANCE
from trum_sym.optimiser.limits import Holds
from trum_sym.optimiser.model import Model
from trum_sym.optimiser.solve import Problem, solve
from trum_sym.output.progress import duration, said
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.studies.minimax import Minimax, Outcome
from trum_sym.studies.posed import Bound, Held, posed
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["RobustCase", "RobustPoint", "robust"]

_MOST_SPREADS, _MOST_SAMPLES = 6, 200
_OF_LOAD = ("load_torque", "load_inertia")  # what may be off beside the motor
_INSIDE = 64  # random cases inside the spreads by which corners are checked
_SEED = 1
_T = TypeVar("_T")


@dataclass(frozen=True, eq=False, kw_only=True)
class RobustCase(Value):
    """One case at the robust point: what differs from the nominal case, and its figures, SI units."""

    changed: Mapping[str, float]
    objective: float
    mean_speed: float
    speed_volatility: float
    stall_torque: float
    violation: float
    reason: str = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class RobustPoint(Result, Value):
    """The point of a box whose worst case is the best.

    Attributes
    ----------
    status : {"solved", "infeasible"}
    objective : str
        What is small in the worst case.
    worst : float
        The objective in the worst of the cases; NaN unless solved.
    nominal : float
        The objective where nothing differs.
    worst_of_nominal_optimum : float
        What the point that :func:`trum_sym.optimize` finds for the nominal case has as its worst; NaN if it finds none.
    worst_inside : float
        The worst of 64 random cases inside the spreads: more than ``worst`` if a corner is not the worst; NaN for
        samples.
    prepressure, frequency_difference, switching_phase : float
    cases : tuple of RobustCase
        The nominal one first.
    constraint_violation : float
        The largest in any case, over the constraint's bound.
    evaluations : int
    message : str
    inputs : Inputs
        Motor, drive at the point, levels.
    terms : Asked
        How near, against what and in what time the point is to be held.
    """

    status: str
    objective: str
    worst: float
    nominal: float
    worst_of_nominal_optimum: float
    worst_inside: float
    prepressure: float
    frequency_difference: float
    switching_phase: float
    constraint_violation: float
    cases: tuple[RobustCase, ...]
    evaluations: int
    message: str
    inputs: Inputs = field(repr=False)
    terms: Asked = field(repr=False, default_factory=Asked)

    @property
    def holding(self) -> Holding | None:
        """What it takes to hold the point in the nominal case; None where none was found."""
        inputs = self.inputs
        return self.terms.of(inputs.motor, inputs.drive, inputs.levels) if self.cases else None

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures of the cases do not say by themselves."""
        return self._remarks(self.holding)

    def _remarks(self, held: Holding | None) -> tuple[str, ...]:
        fragile = () if held is None or not held.fragile else (f"nominal: {held.fragile}",)
        return fragile + tuple(
            f"{_words(case.changed)}: {remark}"
            for case in self.cases
            for remark in remarks_of(
                {"mean_speed": case.mean_speed, "stall_torque": case.stall_torque, "reason": case.reason},
                case.changed.get("load_torque", float(self.inputs.drive.load_torque)),
            )
        )

    def __repr__(self) -> str:
        return f"<RobustPoint {self.status}: {self.message}>"

    def to_dict(self) -> dict[str, Any]:
        """Inputs, the point, every case, remarks and units by name, in SI units."""
        hidden = ("cases", "inputs", "terms")
        own = {name: getattr(self, name) for name in self.__dataclass_fields__ if name not in hidden}
        cases = [{key: getattr(case, key) for key in RobustCase.__dataclass_fields__} for case in self.cases]
        held = self.holding
        remarks = self._remarks(held)
        found = {**self.inputs.record(), **own, "cases": cases, "remarks": remarks}
        found = {**found, "units": units_of(found)}
        return found if held is None else {**held.joined(found), "remarks": remarks}

    def to_text(self, title: str = "") -> str:
        """For people: the point, then every case."""
        lines = [title or one_line(self.inputs.motor.name), "", f"{self.status}: {self.message}"]
        if math.isfinite(self.prepressure):
            at = f"prepressure {full(self.prepressure)} N, frequency difference {full(self.frequency_difference)} Hz"
            lines += ["", f"{at}, switching phase {full(self.switching_phase)} rad"]
            rows = [
                (
                    _words(case.changed),
                    f"{case.objective:.6g}",
                    f"{case.mean_speed / ARCSEC:.6g}",
                    f"{100 * case.speed_volatility:.5g}",
                    f"{case.stall_torque:.5g}",
                    f"{case.violation:.1e}",
                )
                for case in self.cases
            ]
            headers = ("case", self.objective, "mean arcsec/s", "volatility %", "stall N m", "violation")
            lines += ["", text_table(rows, headers, "lrrrrr"), ""]
            held = self.holding
            lines += [*held.lines(), ""] if held is not None else []
            lines += [f"remark on {remark}" for remark in self._remarks(held)]
            if math.isfinite(self.worst_inside):
                lines.append(f"worst of {_INSIDE} random cases inside the spreads: {self.worst_inside:.6g}")
            if math.isfinite(self.worst_of_nominal_optimum):
                lines.append(f"worst case of the nominal optimum: {self.worst_of_nominal_optimum:.6g}")
        return "\n".join([*lines, f"{self.evaluations} orbits computed"])


def _words(changed: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {value:.6g}" for name, value in changed.items()) or "nominal"


def robust(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    objective: str = "volatility",
    spreads: Mapping[str, Spread] | None = None,
    samples: Sequence[Mapping[str, float | str]] | None = None,
    target_speed: float | str | None = None,
    bounds: Mapping[str, Bound] | None = None,
    constraints: Sequence[str] = (),
    holds: Holds | None = None,
    starts: float | str | None = None,
    within: float | str = WITHIN,
    sampling_period: float | str | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> RobustPoint:
    """The point of a box whose worst case over what is not known exactly is the best.

    The target speed is held in the nominal case only, since no fixed drive holds it in all; with the objective
    ``"speed-error"`` it is held in none, and the largest error is what is small.  Constraints hold in every case.

    Parameters
    ----------
    motor, drive, objective, target_speed, bounds, constraints, holds, starts, within, sampling_period
        As for :func:`trum_sym.optimize`; pulse counts have one value each.  With a target, volatility is the speed's
        standard deviation over the target's magnitude in every case.
    spreads : mapping
        By name of the motor file, ``load_torque`` or ``load_inertia``: a share of the value, ``0.1`` or ``"10 %"``, two
        ends, ``(0.2, 0.3)`` or ``"0.2:0.3"``, or None for the range that the motor file states.  The cases are the
        nominal one and all corners; at most six.
    samples : sequence of mappings
        Instead: the cases themselves, each by the same names, ``[{"friction_coefficient": 0.22}, ...]``.
    progress : bool
        Whether to show a bar on the standard error.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; ``tangential`` has to be ``"rigid"``.

    Returns
    -------
    trum_sym.studies.robust.RobustPoint
        The point, its cases, and what the nominal optimum has as its worst; in SI units.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without CasADi or SciPy.

    Notes
    -----
    How it is found, and what it costs against the nominal optimum: docs/studies.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> bounds = {"prepressure": 180.0, "frequency_difference": (3040, 3060)}
    >>> cases = [{"friction_coefficient": 0.252}]
    >>> point = ts.robust(drive=ts.Drive(load_torque=0.1), objective="ripple", samples=cases, bounds=bounds)
    >>> point.status, [case.changed.get("friction_coefficient") for case in point.cases]
    ('solved', [None, 0.252])
    """
    target = None if target_speed is None else one_number("target_speed", target_speed, "rad/s")
    error = isinstance(objective, str) and objective == "speed-error"
    if error and target is None:
        raise ParameterError("target_speed", "none", "a speed in rad/s for the objective speed-error")
    aim, held = ("mean_speed", None) if error else (objective, target)
    terms = Held(holds, starts, within, None, sampling_period, target)
    problem = posed(motor, drive, Levels(**levels), aim, held, bounds, constraints, terms)
    ranges = _ranges(problem, spreads, samples)
    cases = _cases(problem, ranges, samples)
    model = _model(problem, cases)
    task = Minimax(problem, model, len(cases), target if error else None, held=target is not None and not error)
    tell = said("robust" if progress else None)
    tell(f"a map of the box in {len(cases)} cases")
    begin = time.monotonic()
    task.map()
    tell(f"searches from its best places, about {duration(5 * (time.monotonic() - begin))}")
    found = task.solve()
    nominal_optimum = math.nan
    if found is not None and not error:
        nominal = solve(problem)
        task.evaluations += nominal.evaluations
        if nominal.status == "solved" and nominal.best is not None:
            nominal_optimum = max(task.check(nominal.best.share[np.newaxis])[0].objectives)
    inside = math.nan
    if found is not None and ranges:
        rng = np.random.default_rng(_SEED)
        drawn = [{n: float(rng.uniform(low, high)) for n, (low, high) in ranges.items()} for _ in range(_INSIDE)]
        (outcome,) = task.check(found.share[np.newaxis], (_model(problem, drawn), _INSIDE))
        inside = max(outcome.objectives)
    return _result(problem, objective, cases, found, nominal_optimum, inside, task.total())


def _ranges(problem: Problem, spreads: Mapping[str, Spread] | None, samples: object) -> dict[str, tuple[float, float]]:
    """Both ends of every spread, in SI."""
    if (spreads is None) == (samples is None):
        both = "spreads and samples" if samples is not None else "neither spreads nor samples"
        raise ParameterError("spreads", both, "one of the two")
    if spreads is None:
        return {}
    if not isinstance(spreads, Mapping) or not 1 <= len(spreads) <= _MOST_SPREADS:
        raise ParameterError("spreads", spreads, f"1 to {_MOST_SPREADS} names with a share, or two ends")
    found = {}
    for name, given in spreads.items():
        value = _nominal(problem, name)
        domain, unit = _domain(name)
        stated = getattr(problem.motor, name).spread() if name not in DRIVE_DOMAINS else None
        spread = read_spread(name, given, value, unit, domain, stated)
        if spread.kind != "uniform":
            raise ParameterError(
                f"spread of {name}", f"a {spread.kind} distribution", "two ends or a share: cases have ends"
            )
        if not spread.low <= value <= spread.high:
            raise ParameterError(
                f"spread of {name}", f"{spread.low:g} to {spread.high:g}", f"low < high around {value:g}"
            )
        found[name] = (spread.low, spread.high)
    return found


def _nominal(problem: Problem, name: str) -> float:
    if name in _OF_LOAD:
        return float(getattr(problem.drive, name))
    if name in DRIVE_DOMAINS:
        raise ParameterError("spreads", name, f"names of the motor file, {' or '.join(_OF_LOAD)}")
    if spec(name).domain.integer:
        raise ParameterError("spreads", name, "parameters that vary continuously")
    parameter = getattr(problem.motor, name)
    if parameter is None:
        raise ParameterError("spreads", name, "a parameter that the motor has; set it first")
    return float(parameter.value)


def _domain(name: str) -> tuple[Domain, str]:
    return DRIVE_DOMAINS[name] if name in DRIVE_DOMAINS else (spec(name).domain, spec(name).unit)


def _value(name: str, given: float | str) -> float:
    domain, unit = _domain(name)
    return one_number(name, given, unit, domain)


def _cases(
    problem: Problem, ranges: Mapping[str, tuple[float, float]], samples: Sequence[Mapping[str, float | str]] | None
) -> list[dict[str, float]]:
    """What differs in each case; nothing in the first."""
    if samples is None:
        corners = itertools.product(*ranges.values())
        return [{}, *(dict(zip(ranges, corner, strict=True)) for corner in corners)]
    if not isinstance(samples, Sequence) or isinstance(samples, str) or not 1 <= len(samples) <= _MOST_SAMPLES:
        raise ParameterError("samples", samples, f"1 to {_MOST_SAMPLES} mappings of names to values")
    found: list[dict[str, float]] = [{}]
    for sample in samples:
        if not isinstance(sample, Mapping) or not sample:
            raise ParameterError("samples", sample, "mappings of names to values")
        for name in sample:
            _nominal(problem, name)
        found.append({name: _value(name, value) for name, value in sample.items()})
    return found


def _model(problem: Problem, cases: Sequence[Mapping[str, float]]) -> Model:
    """All cases as one model; what a case does not change is there as in the nominal one."""
    names = dict.fromkeys(name for case in cases for name in case)
    values = {name: np.array([case.get(name, _nominal(problem, name)) for case in cases]) for name in names}
    return Model(
        problem.motor, problem.drive, problem.levels, problem.box, problem.names, problem.asked, problem.target, values
    )


def _result(
    problem: Problem,
    objective: str,
    cases: list[dict[str, float]],
    found: Outcome | None,
    nominal_optimum: float,
    inside: float,
    evaluations: int,
) -> RobustPoint:
    if found is None:
        return RobustPoint(
            status="infeasible",
            objective=objective,
            worst=math.nan,
            nominal=math.nan,
            worst_of_nominal_optimum=math.nan,
            worst_inside=math.nan,
            prepressure=math.nan,
            frequency_difference=math.nan,
            switching_phase=math.nan,
            constraint_violation=math.nan,
            cases=(),
            evaluations=evaluations,
            inputs=Inputs(problem.motor, problem.drive, problem.levels, None, TOLERANCE),
            message="no point found that meets the constraints in every case, by map and searches from its best places",
        )
    drive = {**problem.drive.numbers(), **dict(zip(problem.box.names, found.point.tolist(), strict=True))}
    worst = max(found.objectives)
    alike = [case for case, value in zip(cases, found.objectives, strict=True) if value >= worst - 1e-4 * abs(worst)]
    named = " and at ".join(_words(case) for case in alike[:4]) + (" and others" if len(alike) > 4 else "")
    at: dict[str, Any] = {
        name: float(drive[name]) for name in ("prepressure", "frequency_difference", "switching_phase")
    }
    return RobustPoint(
        status="solved",
        objective=objective,
        worst=worst,
        nominal=found.objectives[0],
        worst_of_nominal_optimum=nominal_optimum,
        worst_inside=inside,
        **at,
        inputs=Inputs(problem.motor, replace(problem.drive, **at), problem.levels, None, TOLERANCE),
        constraint_violation=max(found.violations),
        evaluations=evaluations,
        terms=problem.asked,
        cases=tuple(
            RobustCase(
                changed=case,
                objective=value,
                violation=violation,
                **{name: figures[name] for name in ("mean_speed", "speed_volatility", "stall_torque", "reason")},
            )
            for case, value, violation, figures in zip(
                cases, found.objectives, found.violations, found.figures, strict=True
            )
        ),
        message=f"least worst {objective} of {len(cases)} cases, {worst:.6g} at {named}",
    )
