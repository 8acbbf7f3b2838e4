"""``ts.optimize``: input, integers, answer."""

from __future__ import annotations

import contextlib
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Unpack

import numpy as np

from trum_sym.errors import ConvergenceError, ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array, outside
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import BOX_NAMES, DRIVE_DOMAINS, LEAD, Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_point, check_single, numbers_of, one_number
from trum_sym.inputs.shown import full
from trum_sym.inputs.spreads import Spread
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import lack_of_damping
from trum_sym.model.holding import SPEED_TIME, WITHIN, Asked, asked_of
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import prepare
from trum_sym.optimiser.chart import basins, chart
from trum_sym.optimiser.expressions import Constraint, Expression, parse_constraint, parse_expression, symbol
from trum_sym.optimiser.held import check_asked
from trum_sym.optimiser.limits import Holds, binding, limits_of
from trum_sym.optimiser.model import Box, functions
from trum_sym.optimiser.result import Evidence, Optimum
from trum_sym.optimiser.solve import Answer, Problem, solve
from trum_sym.output.progress import said, shown

__all__ = [
    "OBJECTIVES",
    "Bound",
    "Counts",
    "aim_of",
    "asked_to",
    "box_of",
    "check_scalars",
    "optimize",
    "warn_of_box",
]

OBJECTIVES: Mapping[str, str] = MappingProxyType(
    {
        "volatility": "speed_volatility",
        "q-volatility": "abs(q_volatility)",
        "speed-error": "speed_volatility",
        "ripple": "(max_speed - min_speed) / abs(mean_speed)",
        "wear": "peak_pressure",
        "encoder-volatility": "encoder_volatility",
        "drift": "drift",
        "worst-speed-error": "worst_speed_error",
    }
)
_VARIABLES = ("prepressure", "frequency_difference", "switching_phase", "load_torque")
_PULSES = ("periods", "on_periods")
_COUNTED = (*_PULSES, "phase_lead")  # what is gone through value by value
Counts = tuple[int, int, int]
"""Periods, on_periods and phase lead."""
_COARSE = 8  # divisions of the maps that rank pulse counts
_MARGIN = 0.25  # by which such a map may overrate a pair's objective
_BEYOND = 0.1  # of the range of speeds, by which it may miss the target

Bound = float | str | tuple[float | str, float | str]


def optimize(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    objective: str = "volatility",
    target_speed: float | str | None = None,
    bounds: Mapping[str, Bound] | None = None,
    constraints: Sequence[str] = (),
    holds: Holds | None = None,
    starts: float | str | None = None,
    within: float | str = WITHIN,
    spreads: Mapping[str, Spread] | None = None,
    sampling_period: float | str | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> Optimum:
    """The operating point of least objective in a box, under constraints.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given.
        Of single values, no arrays.
    drive : Drive, optional
        What does not vary: load torque, start, pulse counts.  By default the paper's Table 3.  Its prepressure and
        frequency difference do not count: ``bounds`` holds or frees them.
    objective : str
        ``"volatility"`` (speed_volatility, eq. 40), ``"q-volatility"`` (the magnitude of Q_vib, eq. 44),
        ``"speed-error"`` (distance of the mean speed from the target, and among points without, the volatility),
        ``"ripple"`` (highest less lowest speed over the mean), ``"wear"`` (highest contact pressure),
        ``"encoder-volatility"`` (of an encoder's readings), ``"drift"`` (sum of what the spreads of single inputs move
        the mean speed by), ``"worst-speed-error"`` (distance from the target with all inputs off, towards what by
        itself gives more speed, or less), or arithmetic on figures,
        ``"speed_volatility + 1e-3 * prepressure"`` (docs/optimise.md).
    target_speed : float or str, rad/s, optional
        Mean speed that the point is to have; text may carry a unit, ``"633 arcsec/s"``.  Its sign is the direction.
    bounds : mapping, optional
        ``{"prepressure": (160, 210), "frequency_difference": ("2.8 kHz", "3.3 kHz")}``: by default the ranges that the
        motor file states in ``[box]``.  One number holds a variable there.  ``switching_phase`` and ``load_torque`` may
        have bounds, too; ``periods``, ``on_periods`` and ``phase_lead``, which is freed by (-1, 1), are enumerated.
    constraints : sequence of str
        ``"stall_torque >= 0.35 N*m"``: arithmetic on figures, ``>=``, ``<=`` or ``==``, a value or more arithmetic.
    holds : float, str or mapping, optional
        The most that the spread of any one input may move the mean speed by: a share of the speed, ``"10 %"``,
        or a speed, ``"60 arcsec/s"``; by input, ``{"friction_coefficient": "10 %"}``, of these only.
    starts : float or str, s, optional
        The rotor is to be at its speed within this time from rest under the load, and not driven back by it.
    within, spreads, sampling_period
        As for :func:`trum_sym.holding`: what the answer says of holding it, and what limits and objectives count with.
    progress : bool
        Whether to say on the standard error what is done, with a bar while pulse counts are gone through.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; ``tangential`` has to be ``"rigid"``.

    Returns
    -------
    Optimum
        Solved, or the nearest point and why it is not; in SI units.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without CasADi.

    Notes
    -----
    A map of the box, descents by IPOPT from its basins, and a check by :func:`trum_sym.evaluate`: docs/optimise.md.
    Everything below works in SI on ``trum_sym.optimiser.solve.Problem``; ``solve(problem)`` there returns an ``Answer``
    for one pair of pulse counts, and takes a map and a model from a problem that differs in bounds of constraints only.

    Examples
    --------
    >>> import trum_sym as ts
    >>> bounds = {"prepressure": 180.0, "frequency_difference": ("2.8 kHz", "3.3 kHz")}
    >>> best = ts.optimize(bounds=bounds, target_speed="633 arcsec/s", constraints=["stall_torque >= 0.1 N*m"])
    >>> print(f"{best.status}: {best.frequency_difference:.0f} Hz, {best.mean_speed:.5f} rad/s")
    solved: 3140 Hz, 0.00307 rad/s
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_scalars(motor, drive)
    target = None if target_speed is None else one_number("target_speed", target_speed, "rad/s")
    box, pulses, drive = box_of(motor, drive, bounds)
    asked = asked_to(motor, within, spreads, sampling_period, starts)
    aim, limits = aim_of(objective, target, constraints)
    limits = (*limits, *limits_of(asked, target, holds, starts))
    problem = Problem(motor, drive, Levels(**levels), box, aim, limits, asked, target)
    check_asked(problem.names, asked, target, motor)
    warn_of_box(problem)
    best, chosen, pruned, evaluations = _over_pulses(
        problem, pulses, ("maps", "pulse counts", "optimize") if progress else (None, None, None)
    )
    if best.best is not None:
        _warn_undamped(chosen, best.best.point, 3)
    return _optimum(objective, target, chosen, best, len(pulses), pruned, evaluations)


def asked_to(
    motor: Motor, within: object, spreads: Mapping[str, Spread] | None, sampling_period: object, starts: object
) -> Asked:
    """What is asked of points that are to be held, with the time to come to speed that ``starts`` states."""
    time = SPEED_TIME if starts is None else one_number("starts", starts, "s", Domain(low=0.0))
    return asked_of(motor, within, spreads, sampling_period, time)


def check_scalars(motor: Motor, drive: Drive) -> None:
    """Refuse what is no motor or drive, and arrays in them: one problem has one answer."""
    check_point(motor, drive)
    check_single(numbers_of(motor, drive), "one number; optimize each case by itself")


def box_of(motor: Motor, drive: Drive, bounds: Mapping[str, Bound] | None) -> tuple[Box, list[Counts], Drive]:
    """The box of what varies, what is enumerated, and the drive with what is held."""
    if bounds is not None and not isinstance(bounds, Mapping):
        raise ParameterError("bounds", bounds, "a mapping of names to (low, high)")
    stated: dict[str, Any] = {name: (allowed.low, allowed.high) for name, allowed in motor.box.items()}
    given: dict[str, Any] = {**stated, **(bounds or {})}
    ranges: dict[str, tuple[float, float]] = {}
    held: dict[str, float] = {}
    for name, value in given.items():
        if name not in (*_VARIABLES, *_COUNTED):
            raise ParameterError("bounds", name, f"one of {', '.join((*_VARIABLES, *_COUNTED))}")
        if isinstance(value, tuple | list):
            ranges[name] = _range(name, value)
        else:
            held[name] = _checked(name, name, value)
    for name in BOX_NAMES:
        if name not in given:
            allowed = "a range to search, or a value that holds it: the motor file states no range in [box]"
            raise ParameterError(f"bounds of {name}", "none", allowed)
    continuous: dict[str, Any] = {name: value for name, value in held.items() if name not in _PULSES}
    drive = replace(drive, **continuous)
    _warn_beyond_hardware(motor, drive, ranges)
    names = tuple(name for name in _VARIABLES if name in ranges)
    if not names:
        raise ParameterError(
            "bounds", "every variable held", f"a range for {', '.join(_VARIABLES[:-1])} or {_VARIABLES[-1]}"
        )
    ends = np.array([ranges[name] for name in names])
    leads = [-1, 1] if "phase_lead" in ranges else [int(np.asarray(drive.phase_lead))]
    counts = [(m, n, lead) for m, n in _pulse_counts(drive, ranges, held) for lead in leads]
    return Box(names, ends[:, 0], ends[:, 1]), counts, drive


def _warn_beyond_hardware(motor: Motor, drive: Drive, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Warn of a search beyond what the motor file says that the hardware can be set to."""
    for name, allowed in motor.allowed.items():
        alone = float(getattr(drive, name))
        low, high = ranges.get(name, (alone, alone))
        if outside(np.array([low, high]), allowed.low, allowed.high).any():
            where = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            unit = DRIVE_DOMAINS[name][1]
            warnings.warn(
                f"{name}: {where} {unit} reaches outside {allowed.low:g} to {allowed.high:g} {unit}, which the "
                f"hardware can be set to ({allowed.source})",
                ValidityWarning,
                stacklevel=4,
            )


def _checked(label: str, name: str, value: object) -> float:
    if name == "phase_lead":
        lead = one_number(label, value, "1", LEAD)
        if lead not in (-1.0, 1.0):
            raise ParameterError(label, full(lead), "1 or -1; -1 to 1 frees it")
        return lead
    domain, unit = DRIVE_DOMAINS[name]
    return one_number(label, value, unit, domain)


def _range(name: str, value: Sequence[object]) -> tuple[float, float]:
    """The ends of a variable's range, checked."""
    label, unit = f"bounds of {name}", "1" if name == "phase_lead" else DRIVE_DOMAINS[name][1]
    if len(value) != 2:
        raise ParameterError(label, value, "two numbers, low and high")
    low, high = (_checked(label, name, end) for end in value)
    if low > high or (low == high and name in _VARIABLES):
        empty = "one number holds it there" if low == high else "these are reversed"
        raise ParameterError(label, f"{low:g} to {high:g}", f"low < high in {unit} ({empty})")
    return low, high


def _pulse_counts(
    drive: Drive, ranges: Mapping[str, tuple[float, float]], held: Mapping[str, float]
) -> list[tuple[int, int]]:
    """The pairs of periods and on_periods that the bounds allow."""
    axes = []
    for name in _PULSES:
        alone = held.get(name, float(getattr(drive, name)))
        axes.append(ranges.get(name, (alone, alone)))
    counts = [range(int(low), int(high) + 1) for low, high in axes]
    pulses = [(m, n) for m in counts[0] for n in counts[1] if m <= 2 * n <= 2 * m]
    if not pulses:
        m, n = axes
        wanted = f"a range with periods/2 to periods in it, with periods {m[0]:g} to {m[1]:g}"
        raise ParameterError("bounds of on_periods", f"{n[0]:g} to {n[1]:g}", wanted)
    return pulses


def aim_of(
    objective: object, target: float | None, constraints: Sequence[str]
) -> tuple[Expression, tuple[Constraint, ...]]:
    """Objective and constraints as expressions."""
    if isinstance(constraints, str) or not isinstance(constraints, Sequence):
        raise ParameterError("constraints", constraints, "a sequence of texts such as 'stall_torque >= 0.35 N*m'")
    limits = [parse_constraint("constraint", text) for text in constraints]
    if not isinstance(objective, str):
        raise ParameterError("objective", objective, f"one of {', '.join(OBJECTIVES)}, or arithmetic on figures")
    if objective == "speed-error" and target is None:
        raise ParameterError("target_speed", "none", "a speed in rad/s for the objective speed-error")
    if target == 0 and objective in ("volatility", "ripple"):
        raise ParameterError(
            "target_speed",
            target,
            f"a speed other than 0 for the objective {objective}, which is "
            "relative to it; speed_deviation and max_speed - min_speed are not",
        )
    try:
        aim = parse_expression("objective", OBJECTIVES.get(objective, objective))
    except ParameterError as error:
        raise ParameterError("objective", objective, f"one of {', '.join(OBJECTIVES)}, or {error.allowed}") from None
    if target is not None:
        limits.insert(0, Constraint(parse_expression("target_speed", "mean_speed"), target, target))
        if aim.text == "speed_volatility":  # the same where the speed is the target, and smooth everywhere
            deviation = symbol("speed_deviation") / (abs(target) or 1.0)
            aim = Expression("speed_volatility", deviation, frozenset({"speed_deviation"}), "1")
        if objective == "ripple":
            swing = (symbol("max_speed") - symbol("min_speed")) / abs(target)
            aim = Expression(aim.text, swing, frozenset({"max_speed", "min_speed"}), "1")
    return aim, tuple(limits)


def warn_of_box(problem: Problem) -> None:
    """Warn of a box that reaches beyond the prepressures on which eq. 8 was fitted, or to an undamped resonance."""
    motor, box = problem.motor, problem.box
    if "frequency_difference" in box.names:
        # as near to the resonance as the box goes, but for what has no state at all
        nearest = box.low + 0.5 * (box.high - box.low)
        k = box.names.index("frequency_difference")
        nearest[k] = np.clip(0.0, box.low[k], box.high[k]) or 1e-3
        _warn_undamped(problem, nearest, 4)
    if motor.amplitude is not None:
        return
    if "prepressure" in box.names:
        k = box.names.index("prepressure")
        low, high = box.low[k], box.high[k]
    else:
        low = high = float(problem.drive.prepressure)
    least, most = float(motor.fit_prepressure_min.value), float(motor.fit_prepressure_max.value)
    if outside(np.array([low, high]), least, most).any():
        where = f"{low:g} to {high:g} N" if high > low else f"{low:g} N"
        warnings.warn(
            f"prepressure: {where} reaches outside {least:g} to {most:g} N, where eq. 8's amplitude was "
            "measured; beyond, the amplitude and every figure of the answer are extrapolated",
            ValidityWarning,
            stacklevel=3,
        )


def _warn_undamped(problem: Problem, place: Array, stacklevel: int) -> None:
    """Warn of a place of the box whose figures a lack of damping makes."""
    at: dict[str, Any] = dict(zip(problem.box.names, place.tolist(), strict=True))
    with contextlib.suppress(ParameterError, ConvergenceError):  # which the search says of its own points
        case = prepare(problem.motor, replace(problem.drive, **at), problem.levels, 1e-2, warn=False)
        if (said := lack_of_damping(case.values)) is not None:
            warnings.warn(said, ValidityWarning, stacklevel=stacklevel)


def _over_pulses(
    problem: Problem, pulses: list[Counts], bars: tuple[str | None, str | None, str | None]
) -> tuple[Answer, Problem, int, int]:
    """The best answer over all periods, on_periods and phase leads.

    A coarse map ranks them; those whose estimate is worse than the best answer by a margin are not solved.
    """

    def at(pair: Counts) -> Problem:
        counted: dict[str, Any] = dict(zip(_COUNTED, pair, strict=True))
        return replace(problem, drive=replace(problem.drive, **counted))

    if len(pulses) == 1:
        chosen = at(pulses[0])
        answer = solve(chosen, tell=said(bars[2]))
        return answer, chosen, 0, answer.evaluations
    low = np.array([constraint.low for constraint in problem.constraints])
    high = np.array([constraint.high for constraint in problem.constraints])
    rows = functions([problem.objective, *(constraint.expression for constraint in problem.constraints)])
    ranked, evaluations = [], 0
    for pair in shown(pulses, bars[0]):
        model = at(pair).model()
        coarse = chart(model, _COARSE)
        values = rows.values(coarse.figures)[:, 1:]
        with np.errstate(all="ignore"):
            span = np.array(
                [np.ptp(column[np.isfinite(column)]) if np.isfinite(column).any() else 1.0 for column in values.T]
            )
        places = basins(coarse, rows, low, high, np.where(span > 0, span, 1.0))
        evaluations += model.evaluations
        if len(places[0]):
            missed = float(places[2][0])
            ranked.append((missed > 1e-12, float(places[1][0]), missed, pair))
    ranked.sort(key=lambda entry: (entry[0], entry[2] if entry[0] else 0.0, entry[1]))
    best: tuple[Answer, Problem] | None = None
    solved = 0
    for missing, estimate, missed, pair in shown(ranked, bars[1]):
        if best is not None and best[0].status == "solved" and best[0].best is not None:
            most = best[0].best.objective + _MARGIN * abs(best[0].best.objective)
            if (missing and missed > _BEYOND) or estimate > most:
                continue
        chosen = at(pair)
        answer = solve(chosen)
        solved, evaluations = solved + 1, evaluations + answer.evaluations
        if best is None or _rank(answer) < _rank(best[0]):
            best = (answer, chosen)
    if best is None:
        chosen = at(pulses[0])
        best = (solve(chosen), chosen)
    return best[0], best[1], len(pulses) - solved, evaluations


def _rank(answer: Answer) -> tuple[int, float, float]:
    if answer.best is None:
        return 2, math.inf, math.inf
    solved = answer.status == "solved"
    return 0 if solved else 1, 0.0 if solved else answer.best.violation, answer.best.objective


def _optimum(
    objective: str, target: float | None, problem: Problem, answer: Answer, pulses: int, pruned: int, evaluations: int
) -> Optimum:
    best = answer.best
    status = answer.status
    reachable = answer.ranges.get(0) if target is not None else None
    figures = {} if best is None else best.figures
    if objective == "speed-error" and best is not None and target is not None:
        error = abs(figures["mean_speed"] - target)
        if status == "infeasible" and len(problem.constraints) == 1:
            status = "solved"
        value: float | None = error
        optima = tuple([error] if status == "solved" else [])
    else:
        value = None if best is None else best.objective
        optima = tuple(entry for _, entry in answer.optima)
    at = [problem.box.at(share).tolist() for share, _ in answer.optima[: len(optima)]]
    places = tuple(dict(zip(problem.box.names, place, strict=True)) for place in at)
    evidence = Evidence(
        map_shape=answer.map_shape,
        basins=answer.basins,
        starts=answer.starts,
        optima=optima,
        places=places,
        stationarity=answer.stationarity,
        pulses=pulses,
        pruned=pruned,
        reachable_speed=reachable,
    )
    drive = problem.drive
    if best is not None:
        drive = replace(drive, **dict(zip(problem.box.names, best.point.tolist(), strict=True)))
    known = (
        {}
        if best is None
        else {
            "prepressure": float(drive.prepressure),
            "frequency_difference": float(drive.frequency_difference),
            "on_periods": int(drive.on_periods),
            "periods": int(drive.periods),
            "switching_phase": float(drive.switching_phase),
            "load_torque": float(drive.load_torque),
            "phase_lead": int(np.asarray(drive.phase_lead)),
            **{name: figures[name] for name in ("mean_speed", "speed_volatility", "q_average", "q_volatility")},
            "constraint_violation": best.violation,
        }
    )
    names = (
        "prepressure",
        "frequency_difference",
        "on_periods",
        "periods",
        "switching_phase",
        "load_torque",
        "phase_lead",
        "mean_speed",
        "speed_volatility",
        "q_average",
        "q_volatility",
        "constraint_violation",
    )
    return Optimum(
        status=status,
        objective=value if status == "solved" else None,
        **{name: known.get(name) for name in names},
        evaluations=evaluations,
        message=_message(status, objective, target, answer, reachable, problem),
        evidence=evidence,
        figures=figures,
        problem=problem,
        objective_unit="rad/s" if objective == "speed-error" else problem.objective.unit,
    )


def _message(
    status: str,
    objective: str,
    target: float | None,
    answer: Answer,
    reachable: tuple[float, float] | None,
    problem: Problem,
) -> str:
    if status == "solved":
        count = len(answer.optima)
        return f"least {objective} in the box; {count} distinct local {'optimum' if count == 1 else 'optima'} found"
    if answer.best is None:
        return "no speed balances the load anywhere in the box: it exceeds what friction can transmit"
    if status == "infeasible" and reachable is not None and target is not None:
        low, high = (speed / ARCSEC for speed in reachable)
        return (
            f"{target / ARCSEC:.6g} arcsec/s cannot be reached in the box: mean speeds are {low:.6g} to {high:.6g} "
            "arcsec/s; the point given is the nearest"
        )
    if status == "infeasible":
        limits = binding(problem.constraints, answer.best.constraints)
        return f"no point of the box meets all constraints; the one given violates them the least: {limits}"
    return "no point that meets the constraints was found, nor evidence that there is none; the nearest is given"
