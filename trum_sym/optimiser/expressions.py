"""Objectives and constraints as users write them: arithmetic on named figures, checked for dimension.

``"max_speed - min_speed"`` is an objective, ``"stall_torque - load_torque >= 0.05 N*m"`` a constraint.  The text is
parsed by Python's own parser; only arithmetic, a few functions and the names of :data:`VARIABLES` pass, and nothing is
ever executed.  What comes out is a CasADi expression, so its derivatives are exact.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from fractions import Fraction
from types import MappingProxyType
from typing import Any

from trum_sym.errors import ParameterError, shorten
from trum_sym.inputs.units import Dimension, Kind, parse_quantity, parse_unit
from trum_sym.optimiser.extra import casadi
from trum_sym.optimiser.held import DRIFTS, HELD_FIGURES
from trum_sym.quantities import QUANTITIES
from trum_sym.values import Value

__all__ = ["VARIABLES", "Constraint", "Expression", "parse_constraint", "parse_expression"]

_INPUTS = {
    "prepressure": "N",
    "frequency_difference": "Hz",
    "switching_phase": "rad",
    "load_torque": "N*m",
    "periods": "1",
    "on_periods": "1",
}
# what an expression may name, with its SI unit
VARIABLES: Mapping[str, str] = MappingProxyType(
    {
        **{name: output.unit for name, output in QUANTITIES.items()},
        "speed_deviation": "rad/s",
        "peak_pressure": "Pa",
        **HELD_FIGURES,
        **_INPUTS,
    }
)
# what stands for arithmetic on those, with its SI unit
_MADE = {
    "swing": "rad/s",
    "encoder_volatility": "1",
    "drift": "rad/s",
}
_LONGEST = 500
_DEEPEST = 50


@dataclass(frozen=True, eq=False)
class Expression(Value):
    """Arithmetic on figures.

    Attributes
    ----------
    text : str
        As written.
    graph : casadi.SX
        A scalar of the symbols :func:`symbol` names.
    names : frozenset of str
        The figures that occur.
    unit : str
        SI unit of its value.
    """

    text: str
    graph: Any = field(repr=False, compare=False)
    names: frozenset[str]
    unit: str

    def __reduce__(self) -> tuple[Any, ...]:
        names = sorted(self.names)
        symbols = [_SYMBOLS[name] for name in names]
        return _expression, (self.text, casadi.Function("graph", symbols, [self.graph]).serialize(), names, self.unit)


@dataclass(frozen=True, eq=False)
class Constraint(Value):
    """An expression with bounds in its SI unit; equal ones ask for a value."""

    expression: Expression
    low: float
    high: float

    @property
    def text(self) -> str:
        """The constraint in words."""
        name, unit = self.expression.text, "" if self.expression.unit == "1" else f" {self.expression.unit}"
        if self.low == self.high:
            return f"{name} == {self.low:.10g}{unit}"
        return f"{name} >= {self.low:.10g}{unit}" if math.isfinite(self.low) else f"{name} <= {self.high:.10g}{unit}"


_SYMBOLS = {name: casadi.SX.sym(name) for name in VARIABLES}


def _expression(text: str, graph: str, names: list[str], unit: str) -> Expression:
    """An expression out of a pickle or a copy, in the symbols of this process."""
    found = casadi.Function.deserialize(graph)(*(_SYMBOLS[name] for name in names))
    return Expression(text, found, frozenset(names), unit)


def symbol(name: str) -> Any:  # noqa: ANN401
    """The CasADi symbol of a figure."""
    return _SYMBOLS[name]


def _made(name: str) -> tuple[tuple[str, ...], Any]:
    """The figures of which one of :data:`_MADE` is made, and how."""
    if name == "swing":
        return ("max_speed", "min_speed"), _SYMBOLS["max_speed"] - _SYMBOLS["min_speed"]
    if name == "encoder_volatility":
        names = "encoder_deviation", "mean_speed"
        return names, _SYMBOLS["encoder_deviation"] / casadi.fabs(_SYMBOLS["mean_speed"])
    return tuple(DRIFTS), sum(_SYMBOLS[drift] for drift in DRIFTS)


@dataclass(frozen=True)
class _Term:
    """A part of an expression.

    The kind of a bare number is open, and a figure that it multiplies is weighted: in a sum a weight may carry
    any unit.
    """

    graph: Any
    kind: Kind | None
    number: float | None = None
    weighted: bool = False


def _all_weighted(terms: list[_Term]) -> bool:
    return all(term.weighted or term.kind is None for term in terms)


class _Reader:
    def __init__(self, name: str, text: str) -> None:
        self.name, self.text = name, text
        self.names: set[str] = set()

    def refuse(self, why: str) -> ParameterError:
        return ParameterError(self.name, self.text, f"arithmetic on figures such as mean_speed ({why})")

    def read(self, node: ast.expr, depth: int = 0) -> _Term:
        if depth > _DEEPEST:
            raise self.refuse("nested too deeply")
        match node:
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                try:
                    number = float(value)
                except OverflowError:
                    number = math.inf
                if not math.isfinite(number):
                    raise self.refuse("numbers have to be finite")
                return _Term(casadi.SX(number), None, number)
            case ast.Name(id=figure):
                return self.figure(figure)
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                term = self.read(inner, depth + 1)
                negative = None if term.number is None else -term.number
                return _Term(-term.graph, term.kind, negative, term.weighted)
            case ast.UnaryOp(op=ast.UAdd(), operand=inner):
                return self.read(inner, depth + 1)
            case ast.BinOp(left=left, op=op, right=right):
                return self.combine(op, self.read(left, depth + 1), self.read(right, depth + 1))
            case ast.Call(func=ast.Name(id=function), args=args, keywords=[]):
                return self.apply(function, [self.read(argument, depth + 1) for argument in args])
        raise self.refuse(f"not {type(node).__name__.lower()}")

    def figure(self, figure: str) -> _Term:
        if figure in _MADE:
            names, graph = _made(figure)
            self.names.update(names)
            return _Term(graph, parse_unit(_MADE[figure]).kind)
        if figure not in VARIABLES:
            known = (*VARIABLES, *_MADE)
            close = get_close_matches(figure, known, n=3, cutoff=0.5)
            hint = f"close names: {', '.join(close)}" if close else f"names are {', '.join(known)}"
            raise self.refuse(f"no figure is called {shorten(figure)}; {hint}")
        self.names.add(figure)
        return _Term(_SYMBOLS[figure], parse_unit(VARIABLES[figure]).kind)

    def same(self, terms: list[_Term]) -> Kind | None:
        """The one kind of terms that are added or compared; numbers and weights take what the others need."""
        found = {term.kind.compared for term in terms if term.kind is not None and not term.weighted}
        if len(found) > 1:
            raise self.refuse(f"{' and '.join(sorted(map(str, found)))} do not add; a weight may take a unit away")
        weighted = {term.kind.compared for term in terms if term.kind is not None}
        return found.pop() if found else weighted.pop() if len(weighted) == 1 else None

    def combine(self, op: ast.operator, left: _Term, right: _Term) -> _Term:
        first, second = left.kind or Kind(), right.kind or Kind()
        bare = left.kind is None and right.kind is None
        weighted = left.kind is None or right.kind is None or left.weighted or right.weighted
        match op:
            case ast.Add():
                return _Term(left.graph + right.graph, self.same([left, right]), weighted=_all_weighted([left, right]))
            case ast.Sub():
                return _Term(left.graph - right.graph, self.same([left, right]), weighted=_all_weighted([left, right]))
            case ast.Mult():
                return _Term(left.graph * right.graph, None if bare else first.times(second), weighted=weighted)
            case ast.Div():
                return _Term(
                    left.graph / right.graph, None if bare else first.times(second.power(-1)), weighted=weighted
                )
            case ast.Pow():
                if right.number is None or not float(right.number).is_integer() or abs(right.number) > 9:
                    raise self.refuse("exponents are integers from -9 to 9; sqrt() takes roots")
                power = int(right.number)
                kind = None if left.kind is None else first.power(power)
                return _Term(left.graph**power, kind, weighted=left.weighted)
        raise self.refuse(f"not the operator {type(op).__name__.lower()}")

    def apply(self, function: str, terms: list[_Term]) -> _Term:
        many: dict[str, Callable[[Any, Any], Any]] = {"min": casadi.fmin, "max": casadi.fmax}
        if function in many and len(terms) >= 2:
            graph = terms[0].graph
            for term in terms[1:]:
                graph = many[function](graph, term.graph)
            return _Term(graph, self.same(terms), weighted=_all_weighted(terms))
        if len(terms) == 1:
            (term,) = terms
            if function == "abs":
                return _Term(casadi.fabs(term.graph), term.kind, weighted=term.weighted)
            if function == "sqrt":
                powers = None if term.kind is None else term.kind.power(Fraction(1, 2))
                return _Term(casadi.sqrt(term.graph), powers, weighted=term.weighted)
            if function in ("exp", "log"):
                if term.kind is not None and term.kind.dimension != Dimension() and not term.weighted:
                    raise self.refuse(f"{function} takes a pure number")
                return _Term(getattr(casadi, function)(term.graph), Kind())
        raise self.refuse("functions are abs, sqrt, exp and log of one value, min and max of several")


def parse_expression(name: str, text: object) -> Expression:
    """Read arithmetic on figures.

    Parameters
    ----------
    name : str
        The parameter, for the error.
    text : str
        Such as ``"speed_volatility + 0.1 * abs(mean_speed)"``.

    Raises
    ------
    ParameterError
        For anything but arithmetic on :data:`VARIABLES`, or a sum of unlike dimensions.
    """
    if not isinstance(text, str) or not text.strip():
        raise ParameterError(name, text, "text: arithmetic on figures such as mean_speed")
    if len(text) > _LONGEST:
        raise ParameterError(name, text, f"arithmetic on figures of at most {_LONGEST} characters")
    reader = _Reader(name, text)
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise reader.refuse("this is none") from None
    term = reader.read(tree.body)
    if not reader.names:
        raise reader.refuse("no figure occurs in it")
    kind = term.kind or Kind()
    if any(exponent.denominator != 1 for exponent in (*kind.dimension, kind.angle)):
        raise reader.refuse(f"the root of a unit is left, {kind}")
    unit = {**VARIABLES, **_MADE}[tree.body.id] if isinstance(tree.body, ast.Name) else str(kind)
    return Expression(text.strip(), term.graph, frozenset(reader.names), unit)


def parse_constraint(name: str, text: object) -> Constraint:
    """Read ``expression >= value``, ``<=`` or ``==``; the value may carry a unit or be an expression itself.

    Raises
    ------
    ParameterError
        If a side cannot be read, or the two are of unlike dimensions.
    """
    wanted = "an expression, >=, <= or ==, and a value, such as 'stall_torque >= 0.35 N*m'"
    if not isinstance(text, str):
        raise ParameterError(name, text, wanted)
    operators = [op for op in (">=", "<=", "==") if op in text]
    if len(operators) != 1 or text.count(operators[0]) != 1:
        raise ParameterError(name, text, wanted)
    left, right = (side.strip() for side in text.split(operators[0]))
    expression = parse_expression(name, left)
    if any(figure in right for figure in (*VARIABLES, *_MADE)):
        expression, value = parse_expression(name, f"({left}) - ({right})"), 0.0
    else:
        value = parse_quantity(f"{name} {shorten(left)}", right, expression.unit)
        if not math.isfinite(value):
            raise ParameterError(name, text, "a finite value")
    low = value if operators[0] != "<=" else -math.inf
    high = value if operators[0] != ">=" else math.inf
    return Constraint(expression, low, high)
