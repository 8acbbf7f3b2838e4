"""Formulas of Section 3, which change from region to region, evaluated within a drive cycle."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

import mpmath as mp
import sympy as sp

from derivations.ledger.course import Lap, Quantity, extremes
from derivations.ledger.exact import REGIONS, Cycle, at_table_3, random_cycles
from derivations.ledger.history import Array, History, numeric, region_edges
from derivations.ledger.history import values as at_point
from derivations.ledger.judge import evaluate, worse
from derivations.ledger.model import WORKING_DIGITS
from derivations.ledger.operating import operating_point
from derivations.ledger.section_3_supplement import supplement_forms, values
from derivations.nomenclature import NOMENCLATURE, sym

__all__ = [
    "anywhere",
    "by_region",
    "context",
    "largest_in",
    "over_time",
    "row_value",
    "rows",
    "turning",
    "with_rows",
    "within",
    "worst",
]

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


def with_rows(form: sp.Piecewise, new: Iterable[sp.Expr]) -> sp.Piecewise:
    """The form with other branches in the same intervals."""
    pairs = zip(new, form.args, strict=True)
    return sp.Piecewise(*((row, condition) for row, (_, condition) in pairs), evaluate=False)


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


_ANGLES = ("Theta_Baddredu", "Psi_Aaddredu", "varphi_Baddredu", "Theta_Badd", "Psi_Badd", "varphi_Badd")


def anywhere(region: str, count: int, seed: str) -> list[dict[str, mp.mpf]]:
    """Values by symbol name at a time of the region, the supplement's amplitudes and phases and the edges at will.

    Formulas of a region must fit each other whatever the supplement says.  A cycle that is switched at the
    drive's phase 0 has Psi_Badd = 0 and regions of whole pulses, which would hide a slip in either.
    """
    index, found = REGIONS.index(region), []
    for number in range(count):
        uniform = random.Random(f"{seed} {region} {number}").uniform
        edges = [mp.mpf(uniform(1e-3 * i, 1e-3 * i + 4e-4)) for i in range(1, 5)]
        names = {f"t_{i}": edge for i, edge in enumerate(edges, 1)} | {name: mp.mpf(uniform(-3, 3)) for name in _ANGLES}
        names |= {name: mp.mpf(uniform(3e-6, 9e-6)) for name in ("W_maxf", "A_ABaddredu", "A_Badd")}
        ranges = {"omega_n": (2.2e5, 2.4e5), "omega_q": (2.5e5, 2.7e5), "xi": (1e-4, 3e-4), "x": (1e-3, 2e-3)}
        names |= {name: mp.mpf(uniform(*limits)) for name, limits in ranges.items()}
        names["t"] = edges[index] + mp.mpf(uniform(0.1, 0.9)) * (edges[index + 1] - edges[index])
        names |= {name: operating_point()[name] for name in ("D", "k_c")}
        names |= {"varphi_Aredu": mp.pi / 2, "Delta_omega_add": mp.mpf(0)}  # (18) to (24); (14)
        found.append(names)
    return found


def _row_at(form: sp.Basic, names: Mapping[str, object]) -> sp.Expr:
    """The branch that holds at the time; not a number where none does."""
    if not isinstance(form, sp.Piecewise):
        return form
    for branch, condition in form.args:
        if condition == sp.true or condition.subs({s: names[s.name] for s in condition.free_symbols}) == sp.true:
            return branch
    return sp.nan


def row_value(form: sp.Basic, names: Mapping[str, object], functions: Mapping[sp.Basic, str] | None = None) -> mp.mpf:
    """The value of the branch that holds at the time; not a number where none does."""
    chosen = _row_at(form, names)
    if functions:
        chosen = chosen.subs({f: NOMENCLATURE[name].symbol for f, name in functions.items()})
    return evaluate(chosen, {symbol: names[symbol.name] for symbol in chosen.free_symbols})


def _along(region: str, time: Array) -> dict[str, Any]:
    """Values by symbol name at times of Table 3's cycle from a steady start, the supplement's among them."""
    edges, index = region_edges(), REGIONS.index(region)
    names: dict[str, Any] = {**at_point(), "t": time, **{f"t_{i}": edge for i, edge in enumerate(edges, 1)}}
    names |= {"W_maxf": names["W"], "Delta_omega_add": 0.0}
    for known in range(index + 1):
        names["tau"] = time - edges[known]
        for name, form in supplement_forms(REGIONS[known]).items():
            expr = sp.sympify(form)
            symbols = tuple(sorted(expr.free_symbols, key=lambda s: s.name))
            names[name] = numeric(expr, symbols)(*(names[s.name] for s in symbols))
    return names


def over_time(form: sp.Basic, region: str) -> Quantity:
    """The value of a form's row for the region over the time of Table 3's cycle from a steady start."""
    middle = at_table_3().durations()[REGIONS.index(region)] / 2
    row = _row_at(form, context(at_table_3(), region, middle))
    symbols = tuple(sorted(row.free_symbols, key=lambda s: s.name))

    def value(h: History) -> Array:
        names = _along(region, h.time)
        found: Array = numeric(row, symbols)(*(names[s.name] for s in symbols)) + 0 * h.time
        return found

    return value


def largest_in(region: str, quantity: Quantity) -> float:
    """The largest magnitude of a quantity in a region of Table 3's cycle from a steady start."""
    return max(abs(end) for end in extremes(quantity, Lap("steady").region(REGIONS.index(region))))


def _number(expr: sp.Expr, names: Mapping[sp.Symbol, mp.mpf]) -> sp.Float:
    return sp.Float(evaluate(expr, {s: names[s] for s in expr.free_symbols}), WORKING_DIGITS)


def turning(form: sp.Basic, names: Mapping[str, mp.mpf]) -> tuple[mp.mpc, mp.mpf]:
    """A response w as Re(z), amplitude and decay held: the rotating vector z and the rate at which it turns."""
    row = _row_at(form, names)
    here = {s: names[s.name] for s in row.free_symbols}
    row = row.xreplace({e: _number(e, here) for e in row.atoms(sp.exp)})
    w, velocity, acceleration = (_number(row.diff(t, order), here) for order in range(3))
    rate = mp.sqrt(-acceleration / w)
    return mp.mpc(w, -velocity / rate), rate


def worst(
    error: Callable[[Cycle, str, mp.mpf], mp.mpf], cycles: int = 2, times: int = 3, regions: tuple[str, ...] = REGIONS
) -> dict[str, mp.mpf]:
    """The largest error per region over random drives and times."""
    found = dict.fromkeys(regions, mp.mpf(0))
    for cycle in random_cycles(cycles, "section 3"):
        for region in regions:
            for tau in cycle.times(region, times):
                found[region] = worse(found[region], error(cycle, region, tau))
    return found
