"""Mutants: one small slip each in the forms that stand, to see whether the evidence notices it.

Slips as they happen in print: a sign flipped, a factor or term dropped, sine for cosine, an exponent one
more or less, two like symbols swapped, 2 for 3.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache

import mpmath as mp
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from derivations.ledger.judge import difference, evaluate, vanishes
from derivations.ledger.model import Entry, Evidence, Forms
from derivations.nomenclature import NOMENCLATURE

__all__ = [
    "MUTATED",
    "Mutant",
    "Outcome",
    "changes_nothing",
    "equivalent",
    "mutants",
    "try_misreadings",
    "try_mutants",
]

MUTATED = ("verified", "erratum", "reconstructed")
"""Verdicts whose standing forms are mutated: printed and verified, corrected, reconstructed."""
_TURNED = {sp.sin: sp.cos, sp.cos: sp.sin, sp.asin: sp.acos, sp.acos: sp.asin}


@dataclass(frozen=True)
class Mutant:
    """Forms with one slip, and what the slip is."""

    name: str
    slip: str
    forms: Forms


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant: the evidence that rejects it, or a proof that it changes nothing.

    A misreading may also lie in what the stated correction of an erratum discards, whatever stands there.
    """

    mutant: Mutant
    rejected_by: Evidence | None
    equivalent: bool
    discarded: bool = False

    @property
    def survives(self) -> bool:
        """Whether the slip went unnoticed."""
        return self.rejected_by is None and not self.equivalent and not self.discarded


def _like(symbol: sp.Symbol, others: list[sp.Symbol]) -> sp.Symbol | None:
    """The next other symbol of the same dimension, with which it may be confused."""
    if symbol.name not in NOMENCLATURE:
        return None
    unit = NOMENCLATURE[symbol.name].dimension
    alike = [s for s in others if s != symbol and s.name in NOMENCLATURE and NOMENCLATURE[s.name].dimension == unit]
    later = [s for s in alike if s.name > symbol.name]
    return later[0] if later else None


def _slips(node: sp.Basic) -> Iterator[tuple[str, sp.Basic]]:
    """Replacements for one node of an expression."""
    if isinstance(node, sp.Add):
        for index, term in enumerate(node.args):
            rest = [a for i, a in enumerate(node.args) if i != index]
            yield f"sign of {term}", sp.Add(*rest, -term)
            yield f"term {term} dropped", sp.Add(*rest)
    elif isinstance(node, sp.Mul):
        for index, factor in enumerate(node.args):
            rest = [a for i, a in enumerate(node.args) if i != index]
            if factor != -1:
                yield f"factor {factor} dropped", sp.Mul(*rest)
        yield "sign", -node
    elif isinstance(node, sp.Pow) and node.exp.is_Rational:
        yield f"exponent of {node.base} one more", node.base ** (node.exp + 1)
        yield f"exponent of {node.base} one less", node.base ** (node.exp - 1)
    elif node.func in _TURNED:
        turned = _TURNED[node.func]
        yield f"{turned.__name__} for {node.func.__name__}", turned(*node.args)
    elif isinstance(node, sp.Rational) and 2 in (abs(node.p), node.q):
        yield (
            f"3 for 2 in {node}",
            sp.Rational(node.p, node.q) * (sp.Rational(3, 2) if abs(node.p) == 2 else sp.Rational(2, 3)),
        )
    elif node == 3:
        yield "2 for 3", sp.Integer(2)


def _places(expr: sp.Basic, path: tuple[int, ...] = ()) -> Iterator[tuple[tuple[int, ...], sp.Basic]]:
    """Every node with its path; conditions, and what is differentiated or integrated by, stay as they are."""
    yield path, expr
    if isinstance(expr, sp.Piecewise):
        for index, (branch, _) in enumerate(expr.args):
            yield from _places(branch, (*path, index, 0))
        return
    inner = expr.args[:1] if isinstance(expr, (sp.Derivative, sp.Integral, sp.Sum, sp.Subs)) else expr.args
    if isinstance(expr, sp.Pow) and expr.exp.is_Rational:
        inner = expr.args[:1]  # its exponent is a slip of the power
    for index, argument in enumerate(inner):
        if not (isinstance(expr, sp.Function) and not expr.args[0].has(sp.Symbol)):
            yield from _places(argument, (*path, index))


def _put(expr: sp.Basic, path: tuple[int, ...], new: sp.Basic) -> sp.Basic:
    if not path:
        return new
    arguments = list(expr.args)
    arguments[path[0]] = _put(arguments[path[0]], path[1:], new)
    if isinstance(expr, (sp.Piecewise, Relational)):
        return expr.func(*arguments, evaluate=False)
    return expr.func(*arguments)


def mutants(forms: Forms) -> Iterator[Mutant]:
    """All forms with one slip in them."""
    for name, form in forms.items():
        seen: set[sp.Basic] = {form}
        for path, node in _places(form):
            for slip, new in _slips(node):
                mutated = _put(form, path, new)
                if mutated not in seen and mutated not in (sp.true, sp.false):
                    seen.add(mutated)
                    yield Mutant(name, slip, {**forms, name: mutated})
        symbols = sorted((s for s in form.free_symbols if isinstance(s, sp.Symbol)), key=lambda s: s.name)
        for symbol in symbols:
            other = _like(symbol, symbols)
            if other is not None:
                mutated = form.xreplace({symbol: other, other: symbol})
                if mutated not in seen:
                    seen.add(mutated)
                    yield Mutant(name, f"{symbol} and {other} swapped", {**forms, name: mutated})


def _differs(expr: sp.Basic) -> bool:
    """Whether an expression is surely not 0: some number of it is not, at points without meaning."""
    calculus = expr.atoms(sp.Derivative, sp.Integral, sp.Sum, sp.Subs)
    functions = expr.atoms(AppliedUndef)
    plain = expr.xreplace({node: sp.Dummy() for node in calculus}).xreplace({f: sp.Dummy() for f in functions})
    if plain.atoms(AppliedUndef):
        return False
    free = sorted(plain.free_symbols, key=str)
    for seed in ("one", "two", "three"):
        draw = random.Random(seed)
        value = evaluate(plain, {symbol: mp.mpf(draw.uniform(0.3, 0.9)) for symbol in free})
        if mp.isfinite(value) and abs(value) > mp.mpf(10) ** -20:
            return True
    return False


@cache
def equivalent(mutated: sp.Basic, form: sp.Basic) -> bool:
    """Whether a mutant is the same formula: equal branches, or an equation with the same solutions."""
    if isinstance(mutated, sp.Piecewise) and isinstance(form, sp.Piecewise):
        pairs = zip(mutated.args, form.args, strict=True)
        return all(a[1] == b[1] and equivalent(a[0], b[0]) for a, b in pairs)
    if isinstance(form, sp.Equality):
        if not isinstance(mutated, sp.Equality):
            return False
        sides = [sp.expand(e.lhs - e.rhs) for e in (mutated, form)]
        gaps = (sides[0] - sides[1], sides[0] + sides[1])
        return any(not _differs(gap) and vanishes(gap) for gap in gaps)
    if isinstance(form, Relational):
        return bool(mutated == form)
    gap = difference(mutated, form)
    return not _differs(gap) and bool(vanishes(gap))


def _whole_turns(mutated: sp.Basic, form: sp.Basic) -> bool:
    """Whether two angles differ by whole turns, or two places by whole waves, branch by branch."""
    if isinstance(mutated, sp.Piecewise) and isinstance(form, sp.Piecewise):
        pairs = zip(mutated.args, form.args, strict=True)
        return all(a[1] == b[1] and _whole_turns(a[0], b[0]) for a, b in pairs)
    turns = sp.expand(mutated - form) / (2 * sp.pi)
    return any((turns * per).is_integer for per in (1, NOMENCLATURE["k_c"].symbol))


def changes_nothing(entry: Entry, mutant: Mutant, forms: Forms) -> bool:
    """Whether a mutant is the same formula, or the same angle or place up to whole turns."""
    pair = mutant.forms[mutant.name], forms[mutant.name]
    return equivalent(*pair) or (entry.units.get(mutant.name) in ("rad", "m") and _whole_turns(*pair))


def _try(entry: Entry, forms: Forms, rejects: Callable[[Forms], Evidence | None]) -> list[Outcome]:
    outcomes = []
    for mutant in mutants(forms):
        against = rejects(mutant.forms)
        outcomes.append(Outcome(mutant, against, against is None and changes_nothing(entry, mutant, forms)))
    return outcomes


def try_mutants(entry: Entry) -> list[Outcome]:
    """Every mutant of an entry's standing forms, held against the entry's evidence."""
    return _try(entry, entry.subject(), entry.rejects)


def try_misreadings(entry: Entry) -> list[Outcome]:
    """Every slip that could have been made in transcribing an erratum's print, held against its stated repair."""
    if entry.repair is None:
        return []
    mended = entry.repair(entry.printed)
    return [
        replace(o, discarded=o.survives and entry.repair(o.mutant.forms) == mended)
        for o in _try(entry, entry.printed, entry.rejects_print)
    ]
