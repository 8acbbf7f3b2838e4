"""The plain notation of the second transcription, read into SymPy, and held against the line that it quotes.

A line says ``left = right ; condition``; a left side with nothing behind its = has its rows below it, indented.
Names are the paper's letters spelled out (``omega_n``); ``diff2(f, x**2)`` is a second derivative, ``.at(x, a)``
an expression taken at x = a, ``.plus`` a superscript +.  What is written is Python's syntax of expressions, read
by Python's own parser; the meaning of each node is given here.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

__all__ = ["Line", "NotationError", "atoms_of_notation", "atoms_of_tex", "condition", "expression", "lines"]


class NotationError(ValueError):
    """A line that is not in the notation, or a quote with something unknown in it; says what."""


@dataclass(frozen=True)
class Line:
    """One printed equality or row: its sides from left to right, and the condition behind it ('' for none)."""

    sides: tuple[str, ...]
    condition: str = ""


_EQUALS = re.compile(r"(?<![<>=!])=(?!=)|≈")


def lines(text: str) -> Iterator[Line]:
    """The lines of a quote; a row carries the left side that it stands under, as does a condition of all rows."""
    head = ""
    for raw in text.splitlines():
        if not raw.strip():
            continue
        body, _, behind = raw.partition(";")
        sides = tuple(side.strip() for side in _EQUALS.split(body))
        if raw[0] != " ":
            head = sides[0]
            if sides[1:] != ("",):
                yield Line(sides, behind.strip())
        elif sides == ("",):
            yield Line((head,), behind.strip())
        else:
            yield Line((head, *sides), behind.strip())


# --- from the notation to SymPy -----------------------------------------------------------------------------
Resolve = Callable[[str, tuple[sp.Expr, ...]], sp.Expr]
"""What a name with its arguments (none for a plain one) stands for."""

_FUNCTIONS: dict[str, Callable[[sp.Expr], sp.Expr]] = {
    "sin": lambda u: sp.sin(u, evaluate=False),
    "cos": lambda u: sp.cos(u, evaluate=False),
    "tan": lambda u: sp.tan(u, evaluate=False),
    "arcsin": sp.asin,
    "arctan": sp.atan,
    "sqrt": sp.sqrt,
    "abs": sp.Abs,
    "sign": sp.sign,
}
_CONSTANTS: dict[str, sp.Expr] = {"pi": sp.pi, "e": sp.E, "percent": sp.Rational(1, 100), "ms": sp.S.One}
_RELATIONS: dict[type, Callable[[sp.Expr, sp.Expr], sp.Basic]] = {
    ast.Lt: sp.Lt,
    ast.LtE: sp.Le,
    ast.Gt: sp.Gt,
    ast.GtE: sp.Ge,
    ast.Eq: sp.Eq,
}
_OPERATIONS: dict[type, Callable[[sp.Expr, sp.Expr], sp.Basic]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: a**b,
}


def _parsed(text: str) -> ast.expr:
    try:  # lambda is a letter here
        return ast.parse(re.sub(r"\blambda\b", "lambda_", text), mode="eval").body
    except SyntaxError as error:
        raise NotationError(f"cannot be read: {text!r}: {error.msg}") from error


def expression(text: str, resolve: Resolve) -> sp.Basic:
    """The SymPy expression that a side stands for, with every name put in by ``resolve``."""
    return _value(_parsed(text), resolve)


def condition(text: str, resolve: Resolve) -> sp.Basic:
    """The condition behind a row: commas join, ``or`` parts, ``t in [a, b]`` is the closed interval."""
    if text == "i = (1, 2, 3, dots, I)":  # every sample
        return sp.true
    return _truth(_parsed(text), resolve)


def _value(node: ast.expr, resolve: Resolve) -> sp.Basic:
    match node:
        case ast.Constant(value=int() | float() as number):
            return sp.Rational(str(number))
        case ast.Name(id=name):
            return _CONSTANTS[name] if name in _CONSTANTS else resolve(name.removesuffix("_"), ())
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_value(inner, resolve)
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) in _OPERATIONS:
            return _OPERATIONS[type(operator)](_value(left, resolve), _value(right, resolve))
        case ast.Call(func=ast.Attribute(value=inner, attr="at"), args=[variable, place]):
            by, taken = _value(variable, resolve), _value(inner, resolve)
            if any(by in derivative.variables for derivative in taken.atoms(sp.Derivative)):
                taken = taken.doit()
            return taken.xreplace({by: _value(place, resolve)})
        case ast.Attribute(value=inner, attr="plus" | "minus" as sign):
            return sp.Function(sign)(_value(inner, resolve))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _called(name, arguments, resolve)
    raise NotationError(f"cannot be read: {ast.unparse(node)}")


def _called(name: str, arguments: Sequence[ast.expr], resolve: Resolve) -> sp.Basic:
    values = [_value(argument, resolve) for argument in arguments]
    if re.fullmatch(r"diff\d*", name):
        orders = [_order(node, resolve) for node in arguments[1:]]
        if name != "diff" and sum(order for _, order in orders) != int(name.removeprefix("diff")):
            raise NotationError(f"{name} of another order than its variables")
        if name == "diff" and len(orders) > 1:  # the numerator's order is missing: differences over each other
            steps = [sp.Symbol(f"d{variable}", positive=True) for variable, _ in orders]
            return sp.Symbol(f"d{_letter(arguments[0])}", positive=True) / sp.Mul(*steps)
        return sp.Derivative(values[0], *sorted(orders, key=str))
    if name == "integral":
        return sp.Integral(values[2], (values[3], values[0], values[1]))
    if name == "sum":
        return sp.Function("total")(values[4], values[0], values[1], values[3])
    if name in _FUNCTIONS and len(values) == 1:
        return _FUNCTIONS[name](values[0])
    return resolve(name, tuple(values))


def _letter(node: ast.expr) -> str:
    match node:
        case ast.Call(func=ast.Name(id=name)):
            return name
    raise NotationError(f"no displacement: {ast.unparse(node)}")


def _order(node: ast.expr, resolve: Resolve) -> tuple[sp.Basic, int]:
    match node:
        case ast.BinOp(left=variable, op=ast.Pow(), right=ast.Constant(value=int() as order)):
            return _value(variable, resolve), order
    return _value(node, resolve), 1


def _truth(node: ast.expr, resolve: Resolve) -> sp.Basic:
    match node:
        case ast.Tuple(elts=parts):
            return sp.And(*(_truth(part, resolve) for part in parts))
        case ast.BoolOp(op=ast.Or(), values=parts):
            return sp.Or(*(_truth(part, resolve) for part in parts))
        case ast.Compare(left=left, ops=[ast.In()], comparators=[ast.List(elts=[low, high])]):
            value = _value(left, resolve)
            return sp.And(sp.Ge(value, _value(low, resolve)), sp.Le(value, _value(high, resolve)))
        case ast.Compare(left=left, ops=operators, comparators=others) if all(type(o) in _RELATIONS for o in operators):
            sides = [_value(side, resolve) for side in (left, *others)]
            found = [_RELATIONS[type(o)](a, b) for o, a, b in zip(operators, sides, sides[1:], strict=False)]
            return sp.And(*found)
    raise NotationError(f"not a condition: {ast.unparse(node)}")


# --- what is quoted -----------------------------------------------------------------------------------------
# Letters, numbers, signs and relations in reading order, of the quoted TeX and of the notation: they must be the same.
_WORDS = frozenset(
    (
        "sin",
        "cos",
        "tan",
        "arctan",
        "arcsin",
        "sqrt",
        "sign",
        "sum",
        "int",
        "pi",
        "percent",
        "plus",
        "minus",
        "dots",
        "ms",
        "or",
    )
)
_GREEK = frozenset(
    (
        "delta",
        "zeta",
        "theta",
        "kappa",
        "lambda",
        "mu",
        "xi",
        "rho",
        "sigma",
        "varsigma",
        "phi",
        "varphi",
        "psi",
        "omega",
        "Gamma",
        "Theta",
        "Psi",
        "Deltaomega",
        "Deltavarphi",
        "tildezeta",
    )
)
_REWRITES = tuple(
    (re.compile(pattern), new)
    for pattern, new in (
        (
            r"\\tag ?\{[^}]*\}|\\begin\{\w+\}|\\end\{\w+\}|&\s*\(\d\)|\\left\.?|\\right|\\rm\b|\\quad|\\in\b|\\partial",
            " ",
        ),
        (r"100\s*\\frac\{0\}\{0\}|100\s*\\frac\s*0\s*0", r"100 \\percent "),
        (r"\\times|\\gg", lambda found: " >> " if found[0] == r"\gg" else " "),
        (r"\\mathrm\{\\?,?\s*ms\}", r"\\ms "),
        (r"\\text\{(\w+)\}", r"\1"),
        (r"\\max f", "maxf"),
        (r"\bsign\b", r"\\sign "),
        (r"\\tilde\{\\zeta\}", r"\\tildezeta "),
        (r"\\Delta\s*\\(omega|varphi)", r"\\Delta\1"),
        (r"\{11\}\^E", "{11E}"),
        (r"\{Q\^\+\}", "{Qplus}"),
        (r"\{Q\^-\}", "{Qminus}"),
        (r"\{Qall\^2\}", "{Qall}^2"),
        (r"\^\+", r"\\plus "),
        (r"\^-(?!\{)", r"\\minus "),
        (r"_\{(\w+)\(t\)\}", r"_{\1}(t)"),
        (r"\\geq?\b", " >= "),
        (r"\\leq?\b", " <= "),
        (r"\\cup\b", r"\\or "),
        (r"\\approx\b", "="),
    )
)
_ATOM = re.compile(r"\\([A-Za-z]+)|(\d+(?:\.\d+)?)|(<=|>=|>>|[<>+-])|([A-Za-z])")
_INDEX = re.compile(r"\s*_(?:\{\s*(\w+)\s*\}|(\w))")
_SILENT = frozenset(("frac", "d"))


def atoms_of_tex(text: str) -> list[str]:
    """Names, numbers, signs and relations of a quoted formula in reading order; names without underscores."""
    for pattern, new in _REWRITES:
        text = pattern.sub(new, text)
    found, place = [], 0
    while match := _ATOM.search(text, place):
        command, number, sign, letter = match.groups()
        place = match.end()
        name = command or letter
        if number or sign or command in _WORDS:
            found.append(match[0].removeprefix("\\"))
        elif letter or command in _GREEK:
            index = _INDEX.match(text, place)
            place = index.end() if index else place
            name += (index[1] or index[2]) if index else ""
            found += [] if name in _SILENT else [name]
        elif command not in _SILENT:
            raise NotationError(f"unknown in a quote: \\{command}")
    return found


_TOKEN = re.compile(r"(?P<name>[A-Za-z]\w*)|(?P<number>\d+(?:\.\d+)?)|(?P<sign><=|>=|>>|[<>+-])")
_UNSEEN = frozenset(("at", "abs", "in"))
_SPOKEN = {"integral": "int"}


def atoms_of_notation(text: str, *, bars: bool = False) -> list[str]:
    """The same of the notation: ``diff2`` leaves its 2, names lose their underscores; ``abs`` counts on request."""
    found = []
    for match in _TOKEN.finditer(text):
        name = match["name"]
        if name is None:
            found.append(match[0])
        elif re.fullmatch(r"diff\d*", name):
            found += [name.removeprefix("diff")] if name != "diff" else []
        elif name == "tilde_zeta":
            found.append("tildezeta")
        elif name not in _UNSEEN or (bars and name == "abs"):
            found.append(_SPOKEN.get(name, name.replace("_", "")))
    return found
