"""How bad an erratum is, computed from the print, the print mended, and their values at Table 3's point.

typographical : no figure changes.  A name, a unit, an index or a statement from which no figure is computed.
conditional   : every fault sits in rows that hold symbols of the electronic supplement, which the paper at hand lacks;
                what they are judged against is our reconstruction of it.
structural    : no repair by a symbol.  No change of :data:`SIGNS` letters, numbers, signs or bars in a row is known to
                mend it, and each single slip (a sign, factor, term, exponent, like symbol) was tried and does not.
quantitative  : the rest; a figure changes, by a size at Table 3's point.

They are tried in this order.  A copy of the text that is doubtful is given the benefit of the doubt: of the readings
that do not clear an erratum of its fault, the mildest counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal

import mpmath as mp
import sympy as sp
from sympy.core.relational import Relational

from derivations.ledger.exact import REGIONS, Cycle, at_table_3
from derivations.ledger.judge import evaluate
from derivations.ledger.model import APPROXIMATION_LIMIT, WORKING_DIGITS, Entry, Forms, Result
from derivations.ledger.mutate import mutants
from derivations.ledger.regions import context
from derivations.ledger.section_2_composite import resolved
from derivations.ledger.section_6 import cycle_totals
from derivations.ledger.table_1 import UNITS
from derivations.ledger.transcription import mends, other_readings
from derivations.nomenclature import NOMENCLATURE, sym

__all__ = ["SEVERITIES", "SIGNS", "Severity", "hangs_on_the_supplement", "severity", "would_approximate"]

Word = Literal["typographical", "conditional", "quantitative", "structural"]
SEVERITIES: tuple[Word, ...] = ("typographical", "conditional", "quantitative", "structural")
SIGNS = 6
"""A repair by a symbol changes so many letters, numbers, signs or bars of a printed row at most."""

_SUPPLEMENT = frozenset(
    sym("A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu A_Badd Theta_Badd Psi_Badd varphi_Badd")
)


@dataclass(frozen=True)
class Severity:
    """A word, why in a sentence, and the relative size at Table 3's point where a figure changes."""

    word: Word
    why: str
    size: float | None = None


def hangs_on_the_supplement(forms: Forms) -> bool:
    """Whether symbols stand in forms that only the electronic supplement defines."""
    return any(form.free_symbols & _SUPPLEMENT for form in forms.values())


# --- values at Table 3's point ------------------------------------------------------------------------------
_RATES = {f"w_{p}": sp.Symbol(f"v_{p}", real=True) for p in "AB"}
_PLACE = mp.mpf("0.0013")
_SAME = 1e-12  # the same figure, written otherwise


@cache
def _states(cycle: Cycle) -> dict[str, list[Mapping[str, mp.mpf]]]:
    """Values by symbol name at times of the three regions, the paper's cycle from the steady state."""
    totals = {symbol.name: mp.mpf(value) for symbol, value in cycle_totals("steady").items()}
    forward, backward, squares, others = (totals[name] for name in ("q_plus", "q_minus", "p_plus", "p_minus"))
    whole = {
        **totals,
        "X": forward / backward,
        "Y": squares / others,
        "A_p": cycle["b_p"] * cycle["h_p"],
        "Q_aver": (forward - backward) / (forward + backward) / (sum(cycle.durations())),
        "T": sum(cycle.durations()),
        "Delta_omega_redu": cycle["omega_q"] - cycle["omega_n"],
        "Delta_omega_add": mp.mpf(0),
        "Delta_omega_addredu": (cycle["omega_q"] - cycle["omega_n"]) / 2,
        "x": _PLACE,
    }
    found: dict[str, list[Mapping[str, mp.mpf]]] = {}
    for region in REGIONS:
        found[region] = []
        for tau in cycle.times(region, 5):
            (a, va), (b, vb) = (cycle.response(p, region, tau) for p in "AB")
            k, W = cycle["k_c"], cycle["W"]
            found[region].append(
                {
                    **context(cycle, region, tau),
                    **whole,
                    "w_A": a,
                    "w_B": b,
                    "v_A": va,
                    "v_B": vb,
                    "M_a": -vb,
                    "M_b": va,
                    "N_a": -vb / W,
                    "N_b": va / W,
                    "P_A": a,
                    "P_B": b,
                    "p_A": a / W,
                    "p_B": b / W,
                    "x_max": mp.atan2(a, b) / k,
                    "zeta_z": a * mp.sin(k * _PLACE) + b * mp.cos(k * _PLACE),
                    "zeta_x": cycle["D"] * k * (a * mp.cos(k * _PLACE) - b * mp.sin(k * _PLACE)),
                }
            )
    return found


def _plain(form: sp.Basic) -> sp.Basic:
    """A form whose values are numbers: derivatives done, responses and rates as symbols, units as 1."""
    done = form.doit() if form.has(sp.Derivative) else form
    for name, rate in _RATES.items():
        response = NOMENCLATURE[name].symbol
        done = done.subs(response.diff(sym("t")[0]), rate).subs(response, sp.Symbol(name, real=True))
    return done.xreplace(dict.fromkeys(UNITS, sp.S.One))


def _values(name: str, form: sp.Basic, cycle: Cycle) -> list[mp.mpc] | None:
    """The values of a form in the region that its name ends in, or in all; None where it has no number."""
    if isinstance(form, Relational) or not isinstance(form, sp.Expr):
        return None
    plain = _plain(form)
    states, ending = _states(cycle), name.split("_")[-1]
    chosen = states[ending] if ending in REGIONS else [state for region in REGIONS for state in states[region]]
    if plain.has(sp.Integral):
        return None
    with mp.workdps(WORKING_DIGITS):
        try:
            return [_number(plain, state) for state in chosen]
        except (ArithmeticError, TypeError, ValueError, NotImplementedError):
            return None


def _number(form: sp.Expr, state: Mapping[str, mp.mpf]) -> mp.mpc:
    """The value in a state; not a number where no row holds, or one with a symbol that has no value."""
    nothing = mp.mpc(mp.nan)
    if isinstance(form, sp.Piecewise):
        for branch, held in form.args:
            if not {s.name for s in held.free_symbols} <= state.keys():
                return nothing
            if held == sp.true or held.subs({s: state[s.name] for s in held.free_symbols}) == sp.true:
                return _number(branch, state)
        return nothing
    if not {s.name for s in form.free_symbols} <= state.keys():
        return nothing
    return mp.mpmathify(evaluate(form, {s: state[s.name] for s in form.free_symbols}))


def _whole(forms: Forms) -> Forms:
    """Forms with each other's names put in, where they are names of the nomenclature, as in (7)."""
    return resolved(forms) if set(forms) <= NOMENCLATURE.keys() and len(forms) > 1 else forms


def _size(printed: Forms, right: Forms, cycle: Cycle) -> tuple[str, float] | None:
    """The form that is off most, and by how much of its largest right value; None where nothing has a number."""
    worst: tuple[str, float] | None = None
    one, other = _whole(printed), _whole(right)
    for name in (name for name in printed if name in right):
        if printed[name] == right[name] and one[name] == other[name]:
            continue
        if isinstance(one[name], sp.Expr) and sp.expand(one[name] + other[name]) == 0:
            return name, 2.0  # the sign
        found, wanted = _values(name, one[name], cycle), _values(name, other[name], cycle)
        if found is None or wanted is None:
            continue
        pairs = [(a, b) for a, b in zip(found, wanted, strict=True) if mp.isfinite(a) and mp.isfinite(b)]
        scale = max((abs(b) for _, b in pairs), default=mp.mpf(0))
        if scale:
            off = float(max(abs(a - b) for a, b in pairs) / scale)
            if off < _SAME:
                continue
            worst = (name, off) if worst is None or off > worst[1] else worst
    return worst


# --- the four kinds -----------------------------------------------------------------------------------------
@dataclass(frozen=True)
class _Case:
    """An erratum as read: the printed forms, and the mended ones with the signs that this took in a row."""

    entry: Entry
    printed: Forms
    mended: Forms
    signs: int | None  # None: no mend is known


def _mend(entry: Entry) -> tuple[int, Forms] | None:
    """The mend of the fewest signs that the judge accepts."""
    passing = [(signs, forms) for signs, forms in mends(entry) if entry.rejects(forms) is None]
    return min(passing, key=lambda found: found[0]) if passing else None


def _defined() -> frozenset[str]:
    """Names that the paper or the motor's table gives a meaning."""
    from derivations.ledger import ENTRIES

    meant = {name for e in ENTRIES for name in e.printed}
    tables = {name for name, e in NOMENCLATURE.items() if e.where in ("motor file", "ours") or "Sect." in e.where}
    return frozenset(meant | tables)


def _only_a_name(printed: sp.Basic, mended: sp.Basic) -> bool:
    """Whether two forms differ in a unit, a left side, a name that nothing defines, or are a mere statement."""
    if isinstance(printed, sp.Equality) and isinstance(mended, sp.Equality):
        return bool(printed.rhs == mended.rhs) and printed.lhs.func == mended.lhs.func
    if isinstance(printed, Relational):
        return True
    units = dict.fromkeys(UNITS, sp.S.One)
    if printed.xreplace(units) == mended.xreplace(units):
        return True
    lost, new = printed.free_symbols - mended.free_symbols, mended.free_symbols - printed.free_symbols
    unknown = {symbol for symbol in lost if symbol.name not in NOMENCLATURE}
    if unknown and unknown == lost:
        return True  # signs without a meaning, such as dx for itself: no figure could be computed
    if len(lost) == len(new) == 1:
        (old,), (put,) = lost, new
        return old.name not in _meanings() and bool(printed.xreplace({old: put}) == mended)
    return False


@cache
def _meanings() -> frozenset[str]:
    return _defined() - {"x_vm"}


def _typographical(case: _Case) -> str | None:
    if case.signs is None:
        return None
    pairs = [(case.printed.get(name), form) for name, form in case.mended.items()]
    changed = [(a, b) for a, b in pairs if a != b]
    if changed and all(a is not None and _only_a_name(a, b) for a, b in changed):
        return "no figure changes: a name, a unit or a statement"
    return None


def _without_the_supplement(case: _Case) -> Forms:
    """The print with every row mended that holds a symbol of the supplement."""
    found = {}
    for name, form in case.printed.items():
        right = case.mended.get(name, form)
        alike = isinstance(form, sp.Piecewise) and isinstance(right, sp.Piecewise) and len(form.args) == len(right.args)
        if alike:
            pairs = zip(form.args, right.args, strict=True)
            rows = [(b if a[0].free_symbols & _SUPPLEMENT else a) for a, b in pairs]
            found[name] = sp.Piecewise(*rows, evaluate=False)
        else:
            found[name] = right if form.free_symbols & _SUPPLEMENT else form
    return found


def _conditional(case: _Case, result: Result) -> str | None:
    if not hangs_on_the_supplement(case.printed):
        return None
    found = result.printed if case.printed == case.entry.printed else tuple(case.entry.evidence(case.printed))
    failing = {e.kind for e in found if not e.ok}
    if "dimension" in failing or case.entry.rejects(_without_the_supplement(case)) is not None:
        return None
    return "every fault sits in rows with symbols of the missing supplement, judged against our reconstruction of it"


def _readings(entry: Entry) -> Iterator[Forms]:
    """The print, and what a doubtful copy may say instead as long as it is still at fault."""
    yield entry.printed
    for _, forms in other_readings(entry):
        if entry.rejects(forms) is not None:
            yield forms


def severity(result: Result) -> Severity | None:
    """How bad an erratum is; None for what is none."""
    entry = result.entry
    if entry.verdict != "erratum":
        return None
    with mp.workdps(WORKING_DIGITS):
        mend, derived = _mend(entry), result.derivation.forms
        cases = [_Case(entry, forms, *((mend[1], mend[0]) if mend else (derived, None))) for forms in _readings(entry)]
        size = entry.size() if entry.size else _size(entry.printed, cases[0].mended, at_table_3())
        for why in filter(None, map(_typographical, cases)):
            return Severity("typographical", why)
        for why in filter(None, (_conditional(case, result) for case in cases)):
            return _sized("conditional", why, size)
        signs = cases[0].signs
        if all(form.is_number for form in entry.printed.values()) and signs is None and size is not None:
            return _sized("quantitative", "a statement, taken as the number that it asserts", size)
        if signs is None or signs > SIGNS:
            slips = list(mutants(entry.printed))
            mending = next((slip for slip in slips if entry.rejects(slip.forms) is None), None)
            if mending is None:
                return _sized("structural", f"none of {len(slips)} single slips in the print mends it", size)
            return _sized("quantitative", f"mended by one slip ({mending.name}: {mending.slip})", size)
        return _sized("quantitative", f"mended by {signs} sign{'s' if signs > 1 else ''} in a row", size)


def _sized(word: Word, why: str, size: tuple[str, float] | None) -> Severity:
    if size is None:
        return Severity(word, f"{why}; it has no value of its own at Table 3's point")
    name = f"the row of T_{size[0]}" if size[0] in REGIONS else size[0]
    return Severity(word, f"{why}; at Table 3's point {name} is off by {100 * size[1]:.3g} % at most", size[1])


# --- the rule for approximations, the other way round -------------------------------------------------------
def _near(name: str) -> Cycle:
    """Table 3's point, a hundred times closer to resonance or to no damping."""
    there = at_table_3()
    difference = (there["omega_q"] - there["omega_n"]) / 100
    changed = {
        "omega_q -> omega_n": {"omega_q": there["omega_n"] + difference, "Delta_omega": difference},
        "xi -> 0": {"xi": there["xi"] / 100},
    }[name]
    return Cycle({**there.values, **changed})


def would_approximate(result: Result) -> str | None:
    """Why an erratum would be an approximation by the rule of APPROXIMATION_LIMIT; None if it would not."""
    entry = result.entry
    failing = {e.kind for e in result.printed if not e.ok}
    if entry.verdict != "erratum" or failing & {"dimension", "domain", "continuity"}:
        return None
    with mp.workdps(WORKING_DIGITS):
        mend = _mend(entry)
        right = mend[1] if mend else result.derivation.forms
        here = _size(entry.printed, right, at_table_3())
        if here is None or here[1] > APPROXIMATION_LIMIT:
            return None
        for limit in ("omega_q -> omega_n", "xi -> 0"):
            left = _size(entry.printed, right, _near(limit))
            if left is None or left[1] <= here[1] / 10:
                return f"{here[0]} is off by {100 * here[1]:.3g} % at Table 3's point and right for {limit}"
    return None
