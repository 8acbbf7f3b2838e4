"""Kernel mutants: one slip in one part of a kernel's expressions, to see whether its proof notices.

A part is mutated wherever it occurs, as a slip where the formula is typed would.  Slips: a sign, a dropped term or
factor, an exponent one more or less, sine for cosine, arguments exchanged, the lesser for the greater, a missing
magnitude, a condition the other way round, a number one off or its sign, two like symbols or outputs exchanged.  In the
tables: a sign, a number one part in a thousand off, two neighbours exchanged.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeAlias

import mpmath as mp
import sympy as sp

from derivations.codegen.emit import check_dimensions
from derivations.codegen.kernels import Kernel
from derivations.dimensions import DimensionError
from derivations.nomenclature import NOMENCLATURE, TINY, sym
from derivations.proofs import numbers, of_kernel
from derivations.proofs.graph import Graph
from derivations.proofs.maths import DIGITS, Number
from derivations.proofs.proof import NONSENSE, Proof, Subject, check, identical, reference
from derivations.proofs.tables import TABLES, wrong

__all__ = ["Slip", "kernel_mutants", "slips", "table_mutants"]

Pairs: TypeAlias = list[tuple[sp.Expr, sp.Expr]]
_TURNED = {sp.sin: sp.cos, sp.cos: sp.sin}
_PICKED = {sp.Min: sp.Max, sp.Max: sp.Min}


@dataclass(frozen=True)
class Slip:
    """A slip in a kernel or table, and what became of it: ``rejected``, ``equivalent`` with a reason, or neither."""

    of: str
    what: str
    rejected: bool
    equivalent: str = ""


def _number_slips(number: sp.Basic) -> Iterator[sp.Basic]:
    if isinstance(number, sp.Float):
        yield from (-number, number * sp.Rational(1001, 1000))
    elif isinstance(number, sp.Integer):
        yield from (number + 1, number - 1, -number)
    elif isinstance(number, sp.Rational):
        yield from (1 / number, -number, sp.Rational(number.p + 1, number.q), sp.Rational(number.p, number.q + 1))
    elif number == sp.pi:
        yield from (sp.Integer(3), sp.pi / 2, 2 * sp.pi)


def _structure(part: sp.Basic) -> Iterator[tuple[str, sp.Basic]]:
    """Slips in how a part is put together."""
    args = list(part.args)
    if isinstance(part, sp.Add):
        for i, term in enumerate(args):
            rest = args[:i] + args[i + 1 :]
            yield f"sign of {term}", sp.Add(*rest, -term)
            yield f"term {term} dropped", sp.Add(*rest)
    elif isinstance(part, sp.Mul):
        for i, factor in enumerate(args):
            yield f"factor {factor} dropped", sp.Mul(*args[:i], *args[i + 1 :])
        yield "sign", -part
    elif isinstance(part, sp.Pow):
        if part.exp.is_Rational:
            yield "exponent one more", part.base ** (part.exp + 1)
            yield "exponent one less", part.base ** (part.exp - 1)
        else:
            yield "sign of the exponent", part.base ** (-part.exp)
            yield "exponent dropped", part.base
    elif part.func in _TURNED:
        yield f"{_TURNED[part.func].__name__} for {part.func.__name__}", _TURNED[part.func](*args)
        yield f"{part.func.__name__} dropped", args[0]
    elif part.func in _PICKED:
        yield f"{_PICKED[part.func].__name__} for {part.func.__name__}", _PICKED[part.func](*args)
        for i, kept in enumerate(args):
            yield f"only argument {i + 1} of {part.func.__name__}", kept
    elif isinstance(part, sp.Abs):
        yield "magnitude dropped", args[0]
    elif isinstance(part, sp.exp):
        yield "sign of the exponent", sp.exp(-args[0])
        yield "exp dropped", args[0]
    elif isinstance(part, sp.Function):
        name = part.func.__name__
        if len(args) == 2:
            yield f"arguments of {name} exchanged", part.func(args[1], args[0])
            yield f"sign of {name}'s first argument", part.func(-args[0], args[1])
            yield f"sign of {name}'s second argument", part.func(args[0], -args[1])
        else:
            yield f"{name} dropped", args[0]
            yield f"sign of {name}'s argument", part.func(-args[0])


def _like(symbol: sp.Symbol, others: Iterable[sp.Symbol]) -> list[sp.Symbol]:
    """Other symbols of the same dimension."""
    unit = NOMENCLATURE[symbol.name].dimension if symbol.name in NOMENCLATURE else None
    names = (s for s in others if s != symbol and s.name in NOMENCLATURE)
    return [s for s in names if NOMENCLATURE[s.name].dimension == unit]


def _short(text: str) -> str:
    return text if len(text) < 160 else text[:100] + " ... " + text[-50:]


def slips(part: sp.Basic, symbols: Iterable[sp.Symbol]) -> Iterator[tuple[str, sp.Basic]]:
    """Every slip in a part itself, its arguments' own slips left out: what it is, and the part with it."""
    seen = {part}
    if not part.args:
        return
    found = list(_structure(part))
    powers = isinstance(part, sp.Pow) and part.exp.is_Rational
    for i, argument in enumerate(part.args[:1] if powers else part.args):
        others: list[tuple[str, sp.Basic]] = []
        if argument.is_number and not argument.args:
            others = [(f"{new} for {argument}", new) for new in _number_slips(argument)]
        elif isinstance(argument, sp.Symbol):
            others = [(f"{new} for {argument}", new) for new in _like(argument, symbols)[:3]]
        for text, new in others:
            found.append((text, part.func(*part.args[:i], new, *part.args[i + 1 :])))
    for text, new in found:
        if new not in seen:
            seen.add(new)
            yield _short(f"{text} in {part}"), new


class _Prepared:
    """A kernel with the points of its proofs, what is wanted there, and the values of all its parts."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel, self.subject = kernel, Subject(kernel)
        self.proofs: tuple[Proof, ...] = of_kernel(kernel.name)
        self.wanted = {proof: reference(proof) for proof in self.proofs}
        with mp.workdps(DIGITS):
            self.evaluations = {
                proof: [self.subject.evaluations(point) for point, _ in wanted] for proof, wanted in self.wanted.items()
            }

    def notices(self, part: int, new: sp.Basic) -> bool:
        """Whether a proof does, with ``new`` in place of a part."""
        affected = self.subject.graph.affected(part)
        with mp.workdps(DIGITS):
            for proof in self.proofs:
                for (point, wanted), evaluated in zip(self.wanted[proof], self.evaluations[proof], strict=True):
                    try:
                        results = self.subject.with_part(point, evaluated, part, new, affected)
                        if proof.differs(results, wanted):
                            return True
                    except NONSENSE:
                        return True
        return False

    def rejects(self, kernel: Kernel) -> bool:
        """Whether a proof rejects another kernel in place of this one."""
        subject = Subject(kernel)
        return any(check(proof, subject, iter(self.wanted[proof])) for proof in self.proofs)


_SWITCHES = {"s": (1, -1), "g_A": (0, 1), "g_B": (0, 1)}
_FULLNESS = {NOMENCLATURE[name].symbol for name in ("fullness", "fullness_root")}
_PHI = NOMENCLATURE["phi"].symbol
_HIGHEST = 6  # parts above a slip that are looked at for whether they still see it


def _differ(one: sp.Expr, other: sp.Expr) -> bool:
    """Whether two expressions have unlike numbers somewhere."""
    graph = Graph({"one": one, "other": other})
    at = random.Random("differ")
    with mp.workdps(DIGITS):
        for _ in range(4):
            symbols = sorted(one.free_symbols | other.free_symbols, key=str)
            values = {s.name: mp.mpf(at.uniform(0.2 if s.is_positive else -0.9, 0.9)) for s in symbols}
            try:
                found = graph.values(values)
            except NONSENSE:
                continue
            one_, other_ = (found[graph.outputs[name]] for name in ("one", "other"))
            if abs(one_ - other_) > mp.mpf("1e-40") * abs(one_):
                return True
    return False


def _same(one: sp.Expr, other: sp.Expr) -> str:
    """Why two expressions are the same, '' if they are not shown to be: for the values that switches can have."""
    if not _differ(one, other) and identical(one, other):
        return "identically the same"
    symbols = [s for s in one.free_symbols | other.free_symbols if s.name in _SWITCHES]
    for symbol in sorted(symbols, key=str):
        pairs = [(one.subs(symbol, value), other.subs(symbol, value)) for value in _SWITCHES[symbol.name]]
        if all(a == b or (not _differ(a, b) and identical(a, b)) for a, b in pairs):
            return f"the same for each value of {symbol}"
    return ""


def _equivalent(graph: Graph, part: sp.Basic, new: sp.Basic) -> str:
    """Why a slip changes nothing, '' if that is not shown.

    Each part that is made of the slipped one is looked at, or in its place all that are made of that, with a symbol for
    whatever the slip does not touch.
    """
    untouched: dict[sp.Basic, sp.Symbol] = {}

    def bare(expr: sp.Basic) -> sp.Basic:
        """With symbols for arguments that are no symbols or numbers."""
        if not expr.args:
            return expr
        return untouched.setdefault(expr, sp.Symbol(f"part_{len(untouched)}", real=True))

    def skeleton(expr: sp.Basic, at: sp.Basic) -> sp.Basic:
        if expr == part:
            return at
        if not expr.has(part):
            return bare(expr)
        return expr.func(*(skeleton(argument, at) for argument in expr.args))

    inner = {argument: bare(argument) for argument in part.args}
    old, changed = part.xreplace(inner), new.xreplace(inner)

    def seen(expr: sp.Basic, level: int) -> str:
        reason = _same(skeleton(expr, old), skeleton(expr, changed))
        place = graph.place(expr)
        if reason or level == _HIGHEST or place in graph.outputs.values():
            return reason
        above = {seen(higher, level + 1) for higher in graph.above(place)}
        return "" if "" in above else "; ".join(sorted(above))

    return seen(part, 0)


def _bounds(expr: sp.Basic) -> tuple[sp.Expr, sp.Expr] | None:
    """Between which numbers an angle lies: phi within half a turn, that of a point above the axis too."""
    if expr.is_number:
        return expr, expr
    if expr == _PHI:
        return -sp.pi, sp.pi
    if isinstance(expr, sp.atan2) and isinstance(expr.args[0], sp.Pow) and expr.args[0].exp == sp.Rational(1, 2):
        return sp.Integer(0), sp.pi
    if isinstance(expr, sp.Mul) and expr.args[0] == -1 and len(expr.args) == 2:
        inner = _bounds(expr.args[1])
        return None if inner is None else (-inner[1], -inner[0])
    if isinstance(expr, sp.Add):
        terms = [_bounds(term) for term in expr.args]
        if all(term is not None for term in terms):
            return sp.Add(*(t[0] for t in terms if t)), sp.Add(*(t[1] for t in terms if t))
    return None


def _decided(expr: sp.Expr) -> sp.Expr:
    """An expression with the comparisons done that come out the same for all angles."""

    def decide(comparison: sp.Basic) -> sp.Basic:
        first, second = (_bounds(argument) for argument in comparison.args)
        if first and second and first[0] >= second[1]:
            return sp.Integer(0)
        return sp.Integer(1) if first and second and first[1] < second[0] else comparison

    return expr.replace(lambda e: type(e).__name__ == "less", decide)


def _still(kernel: Kernel, other: Kernel) -> bool:
    """Whether the outputs of two kernels with directions differ by what no direction changes."""
    moving = {symbol for rates in kernel.along.values() for symbol in rates}
    pairs = [(sp.sympify(output), sp.sympify(other.outputs[name])) for name, output in kernel.outputs.items()]
    return bool(kernel.along) and not any(sp.expand(a - b).free_symbols & moving for a, b in pairs if a != b)


def _either_way(pairs: Pairs) -> bool:
    """Whether pairs of expressions are the same for either outcome of some comparison that both have."""

    def comparisons(expr: sp.Expr) -> set[sp.Basic]:
        return {node for node in sp.preorder_traversal(expr) if type(node).__name__ == "less"}

    for node in sorted(set.intersection(*(comparisons(e) for pair in pairs for e in pair)), key=sp.count_ops):
        outcomes = [
            (a.xreplace({node: sp.Integer(k)}), b.xreplace({node: sp.Integer(k)})) for a, b in pairs for k in (0, 1)
        ]
        if all(sp.expand(a - b) == 0 for a, b in outcomes):
            return True
    return False


def _never_reached(pairs: Pairs) -> bool:
    """Whether what is held at pi, in one of each pair, stays below pi by itself at all fullnesses of the contact.

    Near the whole wave in contact, at 1 - t = n^2/2, the balance is a parabola in the distance n from pi, and Halley's
    step from n_g ends at n_g (n_g^2 + 3 n^2)/(3 n_g^2 + n^2) > 0; before that 600 fullnesses are tried.
    """
    for one, other in pairs:
        held = [node for node in one.atoms(sp.Min) if sp.pi in node.args and node not in other.atoms(sp.Min)]
        if one.free_symbols - {*_FULLNESS, TINY} or len(held) != 1:
            return False
        (free,) = (argument for argument in held[0].args if argument != sp.pi)
        if other not in (one.xreplace({held[0]: free}), one.xreplace({held[0]: sp.Min(2 * sp.pi, free)})):
            return False
        graph = Graph({"free": free})
        with mp.workdps(200):
            for k in range(600):
                full = 1 - mp.mpf(2) ** (-mp.mpf(k + 1) / 2)
                point = {"fullness": full, "fullness_root": mp.cbrt(full), TINY.name: mp.mpf("1e-190")}
                if not graph.values(point)[graph.outputs["free"]] < mp.pi:
                    return False
    return True


def _in_balance(kernel: Kernel, pairs: Pairs) -> bool:
    """Whether pairs are the same where engagement sin theta + share theta is 1."""
    theta, engagement, share, sin_theta = sym("theta engagement share sin_theta")
    balance = {share: (1 - engagement * sin_theta) / theta}
    known = {share, theta, sin_theta} <= set(kernel.inputs)
    return known and _either_way([(a.subs(balance), b.subs(balance)) for a, b in pairs])


def _at_saturation(kernel: Kernel, pairs: Pairs) -> bool:
    """Whether pairs are the same for R_v = |v|, at which the kernel of that name is a limit."""
    R_v, v = sym("R_v v")
    at = [(a.subs(v, sign * R_v), b.subs(v, sign * R_v)) for a, b in pairs for sign in (1, -1)]
    return kernel.name == "trum_friction_limit" and all(identical(a, b) for a, b in at)


_DOMAIN: tuple[tuple[str, Callable[[Kernel, Pairs], bool]], ...] = (
    ("phi and alpha are half a turn at most", lambda _, pairs: all(_decided(a) == _decided(b) for a, b in pairs)),
    ("the same whether a comparison holds or not", lambda _, pairs: _either_way(pairs)),
    ("the same where the contact carries its load", _in_balance),
    ("the same where the rotor is as fast as the surface", _at_saturation),
    ("the angle stays below pi by itself", lambda _, pairs: _never_reached(pairs)),
    (
        "what keeps a quotient finite may have either sign",
        lambda _, pairs: all(a == b.xreplace({TINY: -TINY}) for a, b in pairs),
    ),
)
"""What the arguments of kernels can be, and whether unlike outputs are the same for that."""


def _by_domain(kernel: Kernel, other: Kernel) -> str:
    """Why two kernels compute the same by what their arguments can be, '' if that is not shown."""
    if kernel.along != other.along:
        return ""
    if _still(kernel, other):
        return "differs by what no direction changes"
    pairs = [(sp.sympify(output), sp.sympify(other.outputs[name])) for name, output in kernel.outputs.items()]
    unlike = [(a, b) for a, b in pairs if a != b]
    return next((reason for reason, holds in _DOMAIN if unlike and holds(kernel, unlike)), "")


def _swapped_symbols(kernel: Kernel) -> Iterator[tuple[str, Kernel]]:
    for i, symbol in enumerate(kernel.inputs):
        for other in _like(symbol, kernel.inputs[i + 1 :])[:1]:
            exchange = {symbol: other, other: symbol}
            outputs = {name: sp.sympify(expr).xreplace(exchange) for name, expr in kernel.outputs.items()}
            if outputs != dict(kernel.outputs):
                yield f"{symbol} and {other} exchanged", replace(kernel, outputs=outputs)


def _swapped_outputs(kernel: Kernel) -> Iterator[tuple[str, Kernel]]:
    names = list(kernel.outputs)
    for i, name in enumerate(names):
        alike = [n for n in names[i + 1 :] if kernel.units[n] == kernel.units[name]]
        for other in [n for n in alike if kernel.outputs[n] != kernel.outputs[name]][:1]:
            exchanged = {**kernel.outputs, name: kernel.outputs[other], other: kernel.outputs[name]}
            yield f"{name} and {other} exchanged", replace(kernel, outputs=exchanged)


def _other_rates(kernel: Kernel) -> Iterator[tuple[str, Kernel]]:
    for direction, rates in kernel.along.items():
        for symbol, rate in rates.items():
            whole = sp.sympify(rate)
            changed = [("dropped", sp.Integer(0)), ("sign", -whole)]
            for part in Graph({"rate": whole}).parts:
                changed += [(text, whole.xreplace({part: new})) for text, new in slips(part, kernel.inputs)]
            for text, new in changed:
                if new != whole:
                    along = {**kernel.along, direction: {**rates, symbol: new}}
                    yield f"rate of {symbol} along {direction}: {text}", replace(kernel, along=along)


def kernel_mutants(kernel: Kernel) -> Iterator[Slip]:
    """Every slip in a kernel's expressions, rates and order of outputs, and what becomes of it."""
    prepared = _Prepared(kernel)
    outputs = {name: sp.sympify(expr) for name, expr in kernel.outputs.items()}
    for place, part in enumerate(prepared.subject.graph.parts):
        for text, new in slips(part, kernel.inputs):
            if prepared.notices(place, new):
                yield Slip(kernel.name, text, True)
            else:
                changed = {name: expr.xreplace({part: new}) for name, expr in outputs.items()}
                graph = prepared.subject.graph
                yield _unnoticed(text, kernel, replace(kernel, outputs=changed), partial(_equivalent, graph, part, new))
    for text, other in (*_swapped_symbols(kernel), *_swapped_outputs(kernel), *_other_rates(kernel)):
        if prepared.rejects(other):
            yield Slip(kernel.name, text, True)
        else:
            yield _unnoticed(text, kernel, other, partial(_same_outputs, kernel, other))


def _unnoticed(text: str, kernel: Kernel, other: Kernel, equivalent: Callable[[], str]) -> Slip:
    """A slip that no proof notices: the dimensions may, or it changes nothing."""
    try:
        check_dimensions(other)
    except DimensionError:
        return Slip(kernel.name, text, True)
    return Slip(kernel.name, text, False, _by_domain(kernel, other) or equivalent())


def _same_outputs(kernel: Kernel, other: Kernel) -> str:
    if kernel.along != other.along:
        return ""
    pairs = [(sp.sympify(output), sp.sympify(other.outputs[name])) for name, output in kernel.outputs.items()]
    return "" if not all(identical(*pair) for pair in pairs) else "identically the same"


def _changed_tables(values: list[Number]) -> Iterator[tuple[str, list[Number]]]:
    for i, value in enumerate(values):
        others = [-value, value * mp.mpf("1.001"), value + 1] if value else [mp.mpf(1)]
        for other in others:
            yield f"{mp.nstr(other, 8)} for number {i + 1}", [*values[:i], other, *values[i + 1 :]]
        if i + 1 < len(values) and values[i + 1] != value:
            yield f"numbers {i + 1} and {i + 2} exchanged", [*values[:i], values[i + 1], value, *values[i + 2 :]]


def table_mutants(files: Mapping[str, str]) -> Iterator[Slip]:
    """Every slip in a table of the generated headers, and whether a table's proof notices."""
    tables = numbers(files)
    for name, values in tables.items():
        for text, other in _changed_tables(values):
            changed = {**tables, name: other}
            first_its_own = sorted(TABLES, key=lambda table: table.name != name)
            yield Slip(name, text, any(wrong(table, changed) for table in first_its_own))
