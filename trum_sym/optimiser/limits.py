"""Limits on what it takes to hold a point, and the constraints that bind, in words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.points import one_number
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import Asked
from trum_sym.optimiser.expressions import Constraint, Expression, parse_expression, symbol
from trum_sym.optimiser.extra import casadi

__all__ = ["Holds", "binding", "limits_of"]

Holds = float | str | Mapping[str, float | str]

_POSITIVE = Domain(low=0.0)
_ALIKE = 0.99  # of the worst violation: constraints that are violated as much bind together


def limits_of(asked: Asked, target: float | None, holds: object, starts: object) -> tuple[Constraint, ...]:
    """The constraints that ``holds`` and ``starts`` of :func:`trum_sym.optimize` mean.

    Raises
    ------
    ParameterError
        For a limit that is none, or of an input without a spread.
    """
    found = []
    for name, limit in _by_input(asked, holds).items():
        share, speed = _limit(f"holds of {name}", limit)
        drift = parse_expression("holds", f"{name}_drift")
        if speed is None and not target:
            left = drift.graph - share * casadi.fabs(symbol("mean_speed"))
            text = f"{drift.text} - {share:g} * abs(mean_speed)"
            found.append(Constraint(Expression(text, left, drift.names | {"mean_speed"}, drift.unit), -math.inf, 0.0))
        else:
            most = share * abs(target or 0.0) if speed is None else speed
            found.append(Constraint(drift, -math.inf, most))
    if starts is not None:
        found.append(Constraint(parse_expression("starts", "start_time"), -math.inf, asked.speed_time))
        found.append(Constraint(parse_expression("starts", "mean_speed * load_torque"), 0.0, math.inf))
    return tuple(found)


def _by_input(asked: Asked, holds: object) -> dict[str, object]:
    if holds is None:
        return {}
    given: dict[str, object] = dict(holds) if isinstance(holds, Mapping) else dict.fromkeys(asked.amounts, holds)
    if not given:
        raise ParameterError("holds", "no spreads", "how far inputs may be off, in spreads or in the motor file")
    for name in given:
        if name not in asked.amounts:
            raise ParameterError("holds", name, f"an input with a spread: {', '.join(asked.amounts) or 'none has one'}")
    return given


def _limit(name: str, limit: object) -> tuple[float, float | None]:
    """A share of the speed, or a speed in rad/s."""
    try:
        return one_number(name, limit, "1", _POSITIVE), None
    except ParameterError:
        if not isinstance(limit, str):
            raise
    return 0.0, one_number(name, limit, "rad/s", _POSITIVE)


def binding(constraints: Sequence[Constraint], values: Array) -> str:
    """The constraints that a point violates the most, with what they are there."""
    below = np.array([constraint.low for constraint in constraints]) - values
    above = values - np.array([constraint.high for constraint in constraints])
    bounds = [c.low if math.isfinite(c.low) else c.high for c in constraints]
    unit = np.array([abs(bound) or abs(value) or 1.0 for bound, value in zip(bounds, values, strict=True)])
    excess = np.maximum(below, above) / unit
    worst = float(np.max(excess, initial=0.0))
    said = []
    for constraint, value, much in zip(constraints, values, excess, strict=True):
        if worst > 0 and much >= _ALIKE * worst:
            scale, name = (
                (ARCSEC, "arcsec/s") if constraint.expression.unit == "rad/s" else (1.0, constraint.expression.unit)
            )
            bound = constraint.low if value < constraint.low else constraint.high
            relation = ">=" if value < constraint.low else "<="
            shown = f"{value / scale:.6g}" + ("" if name == "1" else f" {name}")
            said.append(f"{constraint.expression.text} is {shown} where {relation} {bound / scale:.6g} is asked")
    return "; ".join(said)
