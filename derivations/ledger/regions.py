"""Formulas of Section 3, which change from region to region, evaluated within a drive cycle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import mpmath as mp
import sympy as sp

from derivations.ledger.exact import REGIONS, Cycle, random_cycles
from derivations.ledger.judge import evaluate
from derivations.ledger.section_3_supplement import supplement_forms, values
from derivations.nomenclature import NOMENCLATURE, sym

__all__ = ["by_region", "context", "row_value", "rows", "within", "worst"]

t = sym("t")[0]
_EDGES = sym("t_1 t_2 t_3 t_4")
_T_1 = mp.mpf("0.00123")  # some other time than 0, so that a slip in t - t_1 shows


def within(first: int, last: int) -> sp.Basic:
    """The paper's t in [t_first, t_last]."""
    return sp.And(sp.Ge(t, _EDGES[first - 1]), sp.Le(t, _EDGES[last - 1]))


def by_region(*branches: tuple[sp.Expr, int, int]) -> sp.Piecewise:
    """Branches with the edges of their intervals, as the paper writes them."""
    return sp.Piecewise(*((expr, within(first, last)) for expr, first, last in branches), evaluate=False)


def rows(form: sp.Basic) -> list[sp.Expr]:
    """The branches of a form."""
    return [branch for branch, _ in form.args] if isinstance(form, sp.Piecewise) else [form]


@cache
def context(cycle: Cycle, region: str, tau: mp.mpf) -> dict[str, mp.mpf]:
    """Values by symbol name at a time of the cycle, those of the reconstructed supplement among them."""
    first, second, third = cycle.durations()
    edges = tuple(_T_1 + shift for shift in (mp.mpf(0), first, first + second, first + second + third))
    index = REGIONS.index(region)
    time = edges[index] + tau
    names = {**cycle.values, "t": time, "W_maxf": cycle["W"], **{f"t_{i + 1}": edge for i, edge in enumerate(edges)}}
    for known in range(index + 1):
        names.update(values(supplement_forms(REGIONS[known]), cycle, time - edges[known]))
    return names


def row_value(
    form: sp.Basic, names: Mapping[str, object], functions: Mapping[sp.Basic, str] | None = None
) -> mp.mpf | None:
    """The value of the branch that holds at the time; None where no branch does."""
    chosen = form
    if isinstance(form, sp.Piecewise):
        for branch, condition in form.args:
            if condition == sp.true or condition.subs({s: names[s.name] for s in condition.free_symbols}) == sp.true:
                chosen = branch
                break
        else:
            return None
    if functions:
        chosen = chosen.subs({f: NOMENCLATURE[name].symbol for f, name in functions.items()})
    return evaluate(chosen, {symbol: names[symbol.name] for symbol in chosen.free_symbols})


def worst(
    error: Callable[[Cycle, str, mp.mpf], mp.mpf], cycles: int = 2, times: int = 3, regions: tuple[str, ...] = REGIONS
) -> dict[str, mp.mpf]:
    """The largest error per region over random drives and times."""
    found = dict.fromkeys(regions, mp.mpf(0))
    for cycle in random_cycles(cycles, "section 3"):
        for region in regions:
            for tau in cycle.times(region, times):
                found[region] = max(found[region], error(cycle, region, tau))
    return found
