"""Proofs of the tables of numbers in the generated headers, read from the headers' text as the compiler reads them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import mpmath as mp

from derivations.proofs.maths import DIGITS, Number

__all__ = ["HEADERS", "TABLES", "Table", "read", "wrong"]

HEADERS = ("trum_collocation.h", "trum_quadrature.h", "trum_elementary.h", "trum_runge_kutta.h", "trum_kernels.h")
Tables = Mapping[str, list[Number]]
_DEFINE = re.compile(r"^#define (TRUM_\w+) +([-{\d].*)$", re.MULTILINE)
_DIGITS = mp.mpf("2e-19")  # the headers have 20 digits, the last one rounded
_OFFSET = mp.mpf("0.31")  # where polynomials are tried out, between the nodes


def read(text: str) -> dict[str, list[Number]]:
    """All tables of numbers of a header by name, nested ones row after row."""
    with mp.workdps(DIGITS):
        return {
            name: [mp.mpf(number) for number in re.findall(r"-?\d[\d.]*(?:e[-+]?\d+)?", value)]
            for name, value in _DEFINE.findall(text)
        }


Errors: TypeAlias = Callable[[Tables], list[Number]]
"""Errors of a table over what is allowed, each 1 at most where its statement holds."""


@dataclass(frozen=True)
class Table:
    """What a table is: by its definition, not by how it is made.

    Attributes
    ----------
    name : str
        Of the macro.
    statement : str
        In words.
    errors : callable
        (all tables) -> errors over what is allowed.
    """

    name: str
    statement: str
    errors: Errors


def _square(values: list[Number]) -> list[list[Number]]:
    size = round(len(values) ** 0.5)
    if size * size != len(values):
        raise ArithmeticError(f"{len(values)} numbers are no square")
    return [values[size * i : size * (i + 1)] for i in range(size)]


def _same(found: Number, wanted: Number, scale: Number = 1) -> Number:
    return abs(found - wanted) / (_DIGITS * scale)


def _nodes(t: Tables) -> list[Number]:
    """Ends and inner points: the polynomial that vanishes there is orthogonal on [0, 1] to all of n - 3 degrees."""
    z = t["TRUM_COLLOCATION_POINTS"]

    def moment(k: int) -> Number:
        coefficients = [mp.mpf(1)]
        for node in z:
            coefficients = [
                a - node * b for a, b in zip([mp.mpf(0), *coefficients], [*coefficients, mp.mpf(0)], strict=True)
            ]
        return mp.fsum(c / (j + k + 1) for j, c in enumerate(coefficients))

    order = [mp.mpf(0) if a < b else mp.mpf(2) for a, b in pairwise(z)]
    return [_same(z[0], 0), _same(z[-1], 1), *order, *(_same(moment(k), 0) for k in range(len(z) - 2))]


def _count(t: Tables, name: str, of: str) -> list[Number]:
    return [mp.mpf(0) if t[name] == [len(t[of])] else mp.mpf(2)]


def _integrals(t: Tables) -> list[Number]:
    """Every power below n is integrated exactly from 0 to each node."""
    z = t["TRUM_COLLOCATION_POINTS"]
    found = []
    for node, weights in zip(z, _square(t["TRUM_COLLOCATION_INTEGRALS"]), strict=True):
        for k in range(len(z)):
            found.append(_same(mp.fsum(w * x**k for w, x in zip(weights, z, strict=True)), node ** (k + 1) / (k + 1)))
    return found


def _powers(t: Tables) -> list[Number]:
    """Of the values of s^k at the nodes, the coefficients are 1 for the power k and 0 for the others."""
    z = t["TRUM_COLLOCATION_POINTS"]
    return [
        _same(mp.fsum(w * x**k for w, x in zip(weights, z, strict=True)), int(k == row), 100)
        for row, weights in enumerate(_square(t["TRUM_COLLOCATION_POWERS"]))
        for k in range(len(z))
    ]


def _legendre(t: Tables) -> list[Number]:
    """Of the values of s^k at the nodes: sum of the coefficients times the shifted Legendre polynomials is s^k."""
    z = t["TRUM_COLLOCATION_POINTS"]
    rows = _square(t["TRUM_COLLOCATION_LEGENDRE"])
    found = []
    for k in range(len(z)):
        coefficients = [mp.fsum(w * x**k for w, x in zip(weights, z, strict=True)) for weights in rows]
        for s in (_OFFSET + mp.mpf(i) / 7 for i in range(len(z))):
            total = mp.fsum(c * mp.legendre(j, 2 * s - 1) for j, c in enumerate(coefficients))
            found.append(_same(total, s**k, 100))
    return found


def _outward(t: Tables) -> list[Number]:
    """Of the values of s^k, k below n - 1, at the nodes but the first: their value at the first; its own counts 0."""
    z, weights = t["TRUM_COLLOCATION_POINTS"], t["TRUM_COLLOCATION_OUTWARD"]
    sums = [mp.fsum(w * x**k for w, x in zip(weights[1:], z[1:], strict=True)) for k in range(len(z) - 1)]
    return [_same(weights[0], 0), *(_same(total, z[0] ** k if k else 1, 10) for k, total in enumerate(sums))]


def _check_rule(t: Tables) -> list[Number]:
    """Kronrod's nodes lie between Lobatto's; together they integrate every power up to 9 exactly from 0 to 1."""
    z, checks = t["TRUM_COLLOCATION_POINTS"], t["TRUM_CHECK_POINTS"]
    weights = [*t["TRUM_CHECK_FULL_WEIGHTS"], *t["TRUM_CHECK_WEIGHTS"]]
    found = [mp.mpf(0) if low < x < high else mp.mpf(2) for low, x, high in zip(z, checks, z[1:], strict=False)]
    for k in range(10):
        total = mp.fsum(w * x**k for w, x in zip(weights, [*z, *checks], strict=True))
        found.append(_same(total, mp.mpf(1) / (k + 1)))
    return found


def _rows(values: list[Number], width: int) -> list[list[Number]]:
    if len(values) % width:
        raise ArithmeticError(f"{len(values)} numbers are no rows of {width}")
    return [values[i : i + width] for i in range(0, len(values), width)]


def _check_values(t: Tables) -> list[Number]:
    """Powers below n reproduced at the check nodes."""
    z, checks = t["TRUM_COLLOCATION_POINTS"], t["TRUM_CHECK_POINTS"]
    rows = _rows(t["TRUM_CHECK_VALUES"], len(z))
    return [
        _same(mp.fsum(w * x**k for w, x in zip(weights, z, strict=True)), at**k, 10)
        for at, weights in zip(checks, rows, strict=True)
        for k in range(len(z))
    ]


def _check_integrals(t: Tables) -> list[Number]:
    """Powers below n integrated exactly from 0 to each check node."""
    z, checks = t["TRUM_COLLOCATION_POINTS"], t["TRUM_CHECK_POINTS"]
    rows = _rows(t["TRUM_CHECK_INTEGRALS"], len(z))
    return [
        _same(mp.fsum(w * x**k for w, x in zip(weights, z, strict=True)), at ** (k + 1) / (k + 1), 10)
        for at, weights in zip(checks, rows, strict=True)
        for k in range(len(z))
    ]


def _gauss_nodes(t: Tables) -> list[Number]:
    """Zeros of Legendre's polynomial of their number, in order: 20 digits of each."""
    nodes = t["TRUM_GAUSS_NODES"]
    found = [mp.mpf(0) if a < b else mp.mpf(2) for a, b in pairwise(nodes)]
    for x in nodes:
        slope = mp.diff(lambda at: mp.legendre(len(nodes), at), x)
        found.append(_same(mp.legendre(len(nodes), x) / slope, 0))
    return found


def _gauss_weights(t: Tables) -> list[Number]:
    """Every power below twice their number is integrated exactly over [-1, 1]."""
    nodes, weights = t["TRUM_GAUSS_NODES"], t["TRUM_GAUSS_WEIGHTS"]
    found = []
    for k in range(2 * len(nodes)):
        total = mp.fsum(w * x**k for w, x in zip(weights, nodes, strict=True))
        found.append(_same(total, 2 / mp.mpf(k + 1) if k % 2 == 0 else 0, 10))
    return found


def _taylor(name: str, function: Callable[[Number], Number]) -> Errors:
    """Coefficients that are not 0 of a power series, by mpmath's own."""

    def errors(t: Tables) -> list[Number]:
        wanted = [c for c in mp.taylor(function, 0, 2 * len(t[name])) if abs(c) > mp.mpf("1e-60")]
        return [_same(c, w, abs(w)) for c, w in zip(t[name], wanted, strict=False)]

    return errors


def _close(value: Callable[[Tables, Number], Number], to: Callable[[Number], Number], reach: str, error: str) -> Errors:
    """Of a polynomial's values at 401 points to either side of 0."""

    def errors(t: Tables) -> list[Number]:
        end = _REACH[reach]()
        points = (end * i / 200 for i in range(-200, 201))
        return [abs(value(t, x) - to(x)) / mp.mpf(error) for x in points]

    return errors


def _polynomial(coefficients: list[Number], x: Number) -> Number:
    return mp.polyval(coefficients[::-1], x)


def _both(*parts: Errors) -> Errors:
    return lambda t: [error for part in parts for error in part(t)]


def _gates(t: Tables) -> list[Number]:
    """Over a cycle of the regions, m - n, m - n and 2 n - m pulses long, each phase is driven for n pulses.

    With the gates 0 or 1 and no region without drive, A off first: that leaves one choice.
    """
    a, b = t["TRUM_GATES_A"], t["TRUM_GATES_B"]
    found = [mp.mpf(0) if t["TRUM_REGIONS"] == [len(a)] == [len(b)] and len(a) == 3 else mp.mpf(2)]
    for m, n in ((20, 14), (31, 17)):
        pulses = (m - n, m - n, 2 * n - m)
        found += [_same(sum(g * count for g, count in zip(gates, pulses, strict=True)), n) for gates in (a, b)]
    found += [mp.mpf(0) if gate in (0, 1) else mp.mpf(2) for gate in (*a, *b)]
    return [*found, _same(a[0], 0), *(mp.mpf(0) if x or y else mp.mpf(2) for x, y in zip(a, b, strict=True))]


def _odd(name: str) -> Callable[[Tables, Number], Number]:
    return lambda t, x: x * _polynomial(t[name], x * x)


def _even(name: str) -> Callable[[Tables, Number], Number]:
    return lambda t, x: _polynomial(t[name], x * x)


_REACH: dict[str, Callable[[], Number]] = {
    "pi/4": lambda: mp.pi / 4,
    "ln(2)/2": lambda: mp.log(2) / 2,
    "tan(pi/8)": lambda: mp.tan(mp.pi / 8),
}
_SIN, _COS, _EXP, _EXPM1, _ATAN = (f"TRUM_{name}_COEFFICIENTS" for name in ("SIN", "COS", "EXP", "EXPM1", "ATAN"))


def _mean_of_exp(x: mp.mpf) -> mp.mpf:
    """(exp(x) - 1) / x, the mean of exp between 0 and x."""
    return mp.expm1(x) / x if x else mp.mpf(1)


_Tree: TypeAlias = tuple["_Tree", ...]


def _rooted(count: int) -> list[_Tree]:
    """All rooted trees of so many nodes, each by its branches, these in order."""
    if count == 1:
        return [()]

    def forests(left: int, most: _Tree | None) -> list[_Tree]:
        if left == 0:
            return [()]
        found: list[_Tree] = []
        for size in range(1, left + 1):
            for first in _rooted(size):
                if most is None or (size, first) <= (_nodes_of(most), most):
                    found += [(first, *rest) for rest in forests(left - size, first)]
        return found

    return forests(count - 1, None)


def _nodes_of(tree: _Tree) -> int:
    return 1 + sum(map(_nodes_of, tree))


def _conditions(t: Tables, order: int) -> list[tuple[list[Number], Number]]:
    """Butcher's: weights of an order times the first are one over the second, for each rooted tree."""
    within = _square(t["TRUM_RUNGE_KUTTA_WITHIN"])

    def inner(tree: _Tree) -> tuple[list[Number], Number]:
        products, density = [mp.mpf(1)] * len(within), mp.mpf(_nodes_of(tree))
        for branch in tree:
            values, own = inner(branch)
            sums = [mp.fsum(a * b for a, b in zip(row, values, strict=True)) for row in within]
            products, density = [a * b for a, b in zip(products, sums, strict=True)], density * own
        return products, density

    return [inner(tree) for count in range(1, order + 1) for tree in _rooted(count)]


def _stages(t: Tables) -> list[Number]:
    """Explicit, and the last row is of order 5."""
    within = _square(t["TRUM_RUNGE_KUTTA_WITHIN"])
    explicit = [_same(weight, 0) for i, row in enumerate(within) for weight in row[i:]]
    sums = [(mp.fsum(a * b for a, b in zip(within[-1], values, strict=True)), g) for values, g in _conditions(t, 5)]
    return explicit + [_same(found, 1 / density, 20) for found, density in sums]


def _stage_places(t: Tables) -> list[Number]:
    """Each node is the sum of its row."""
    rows = _square(t["TRUM_RUNGE_KUTTA_WITHIN"])
    return [_same(node, mp.fsum(row), 20) for node, row in zip(t["TRUM_RUNGE_KUTTA_NODES"], rows, strict=True)]


def _stage_error(t: Tables) -> list[Number]:
    """Nothing to order 4, something to order 5: the conditions of the last order are the last nine."""
    off = t["TRUM_RUNGE_KUTTA_ERROR"]
    sums = [mp.fsum(a * b for a, b in zip(off, values, strict=True)) for values, _ in _conditions(t, 5)]
    return [*(_same(found, 0, 20) for found in sums[:8]), mp.mpf(0 if any(abs(x) > 1e-4 for x in sums[8:]) else 2)]


def _hidden_peak(t: Tables) -> list[Number]:
    """Of peaks 1/sqrt(1 + (s - c)^2/w^2), the integral from 0 to 1 over the nodes' range: at most that, rounded up."""
    z, (bound,) = t["TRUM_COLLOCATION_POINTS"], t["TRUM_HIDDEN_PEAK"]
    found = []
    for wide in ("1.46", "10", "1e2", "1e3", "1e4", "1e5", "1e6"):  # half a step over the peak's half-width
        for place in ("0.5", "0.4", "0.2764", "0.1", "0"):
            width, centre = mp.mpf("0.5") / mp.mpf(wide), mp.mpf(place)

            def peak(s: Number, w: Number = width, c: Number = centre) -> Number:
                return 1 / mp.sqrt(1 + ((s - c) / w) ** 2)

            ends = [mp.mpf(0), *(x for x in (centre - width, centre, centre + width) if 0 < x < 1), mp.mpf(1)]
            seen = [peak(s) for s in z]
            found.append(mp.quad(peak, ends) / (max(seen) - min(seen)))
    return [_same(bound, mp.ceil(max(found)))]


_SHARED = "each phase has n pulses, A is off in the first region, never are both"
_CHECKED = "with Lobatto's nodes they integrate powers up to 9 exactly"
TABLES = (
    Table(
        "TRUM_COLLOCATION_NODES",
        "how many nodes there are",
        lambda t: _count(t, "TRUM_COLLOCATION_NODES", "TRUM_COLLOCATION_POINTS"),
    ),
    Table(
        "TRUM_COLLOCATION_POINTS",
        "0, 1 and between: their polynomial is orthogonal on [0, 1] to all of degree n - 3",
        _nodes,
    ),
    Table("TRUM_COLLOCATION_INTEGRALS", "powers below n integrated exactly up to each node", _integrals),
    Table("TRUM_COLLOCATION_POWERS", "powers below n reproduced", _powers),
    Table("TRUM_COLLOCATION_LEGENDRE", "powers below n reproduced by Legendre's polynomials", _legendre),
    Table("TRUM_COLLOCATION_OUTWARD", "powers below n - 1 extrapolated exactly", _outward),
    Table("TRUM_CHECK_POINTS", f"between the nodes; {_CHECKED}", _check_rule),
    Table("TRUM_CHECK_WEIGHTS", _CHECKED, _check_rule),
    Table("TRUM_CHECK_FULL_WEIGHTS", _CHECKED, _check_rule),
    Table("TRUM_CHECK_VALUES", "powers below n reproduced at the check nodes", _check_values),
    Table("TRUM_CHECK_INTEGRALS", "powers below n integrated exactly up to each check node", _check_integrals),
    Table(
        "TRUM_HIDDEN_PEAK",
        "the whole number that a peak's integral over what the nodes see of it does not exceed",
        _hidden_peak,
    ),
    Table(
        "TRUM_RUNGE_KUTTA_STAGES",
        "how many stages there are",
        lambda t: _count(t, "TRUM_RUNGE_KUTTA_STAGES", "TRUM_RUNGE_KUTTA_NODES"),
    ),
    Table("TRUM_RUNGE_KUTTA_NODES", "sums of the rows", _stage_places),
    Table(
        "TRUM_RUNGE_KUTTA_WITHIN",
        "explicit; the last row meets the conditions of all rooted trees of 5 nodes and fewer",
        _stages,
    ),
    Table("TRUM_RUNGE_KUTTA_ERROR", "the same of 4 nodes and fewer with 0, and not those of 5", _stage_error),
    Table(
        "TRUM_GAUSS_POINTS", "how many nodes there are", lambda t: _count(t, "TRUM_GAUSS_POINTS", "TRUM_GAUSS_NODES")
    ),
    Table("TRUM_GAUSS_NODES", "zeros of Legendre's polynomial", _gauss_nodes),
    Table("TRUM_GAUSS_WEIGHTS", "powers below 2 n integrated exactly over [-1, 1]", _gauss_weights),
    Table(
        _SIN,
        "Taylor's; off by 1e-19 at most up to pi/4",
        _both(_taylor(_SIN, mp.sin), _close(_odd(_SIN), mp.sin, "pi/4", "1e-19")),
    ),
    Table(
        _COS,
        "Taylor's; off by 1e-19 at most up to pi/4",
        _both(_taylor(_COS, mp.cos), _close(_even(_COS), mp.cos, "pi/4", "1e-19")),
    ),
    Table(
        _EXP,
        "Taylor's; off by 1e-17 at most up to ln(2)/2",
        _both(_taylor(_EXP, mp.exp), _close(lambda t, x: _polynomial(t[_EXP], x), mp.exp, "ln(2)/2", "1e-17")),
    ),
    Table(
        _EXPM1,
        "Taylor's, times x; off by 2e-17 of it at most up to ln(2)/2",
        _both(
            _taylor(_EXPM1, mp.expm1),
            _close(lambda t, x: _polynomial(t[_EXPM1], x), _mean_of_exp, "ln(2)/2", "2e-17"),
        ),
    ),
    Table(_ATAN, "off by 1e-19 at most up to tan(pi/8)", _close(_odd(_ATAN), mp.atan, "tan(pi/8)", "1e-19")),
    Table("TRUM_REGIONS", "how many regions there are", _gates),
    Table("TRUM_GATES_A", _SHARED, _gates),
    Table("TRUM_GATES_B", _SHARED, _gates),
)


def wrong(table: Table, tables: Tables) -> str:
    """What is wrong with a table, '' if nothing."""
    with mp.workdps(DIGITS):
        try:
            worst = max(table.errors(tables))
        except (ArithmeticError, ValueError, KeyError, IndexError, TypeError) as error:
            return f"{table.name}: {str(error) or type(error).__name__}"
        return "" if worst <= 1 else f"{table.name} is off by {mp.nstr(worst, 3)} times what is allowed"
