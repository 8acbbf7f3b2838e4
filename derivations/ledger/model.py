"""What an entry of the ledger is, and when its verdict counts as confirmed.

An entry holds the printed forms (faithful to the paper, misprints included, typed independently of the
derivations), a derivation in checked steps that ends in the derived forms, and a judge.  The judge takes
*any* forms under the entry's names and yields evidence for or against them, the cheapest first, from
premises: it never looks at the verdict and does not know whether it judges the printed form, the
corrected one, or a mutant.  :func:`confirm` then holds the stated verdict against the evidence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

import mpmath as mp
import sympy as sp

from derivations.dimensions import DimensionError, dimension
from derivations.ledger.algebra import vanishes
from derivations.ledger.figures import Figure, recorded
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = [
    "APPROXIMATION_LIMIT",
    "Derivation",
    "Entry",
    "Evidence",
    "Forms",
    "Kind",
    "Picture",
    "Result",
    "Step",
    "Verdict",
    "confirm",
    "evidence",
    "step",
]

Verdict = Literal["verified", "approximation", "erratum", "definition", "reconstructed", "empirical"]
Kind = Literal["dimension", "numeric", "identity", "continuity", "limit", "domain", "error_size", "data", "derivation"]
_NONSENSE = (ArithmeticError, ValueError, TypeError, AttributeError, LookupError, NotImplementedError, StopIteration)
WORKING_DIGITS = 45  # 30 to be trusted and some to spare
Forms = Mapping[str, sp.Basic]
"""Named expressions, or equations (sympy.Eq) and inequalities under any name, in the order of the paper."""


@dataclass(frozen=True)
class Evidence:
    """One finding: its kind, whether it speaks for the forms, and what was found, with figures."""

    kind: Kind
    ok: bool
    detail: str
    size: float | None = None  # of kind error_size: the relative error at Table 3's point


APPROXIMATION_LIMIT = 0.2
"""What an approximation may be off by at Table 3's point, and an erratum may not.

One rule parts the two.  A printed form that is not exact is an approximation if it is free of other faults (its
dimensions agree, every case is covered), its error vanishes in a stated limit of the parameters, and at Table 3's
point the figure that the paper computes from it is off by a fifth at most.  Else it is an erratum.  A fifth, because
no figure from Table 1 is known better: its E, G and mu contradict each other by that much (entry table-1-isotropy).
"""


@dataclass(frozen=True)
class Step:
    """A step of a derivation: what is done, what it shows, and whether the check of it held."""

    text: str
    shows: tuple[sp.Basic, ...] = ()
    holds: bool | None = None  # None: a premise, which needs no check


@dataclass(frozen=True)
class Derivation:
    """Steps from premises to the derived forms, which carry the names of the printed ones."""

    steps: tuple[Step, ...]
    forms: Forms


@dataclass(frozen=True)
class Picture:
    """Curves that show an error better than a figure does: label -> (abscissae, ordinates)."""

    title: str
    abscissa: str
    ordinate: str
    curves: Mapping[str, tuple[list[float], list[float]]]


@dataclass(frozen=True)
class Entry:
    """An equation, definition, table or claim of the paper, with its verdict.

    Attributes
    ----------
    id : str
        The paper's number, "1" to "45", "A1" to "A17"; for the rest a word such as "table-2".
    section, title, place : str
        Section of the paper, a title, and where the text stands.
    printed : mapping
        The forms as printed; empty where the paper lacks them.
    units : mapping
        SI unit of each named expression (equations need none: their sides are compared).
    verdict, reason
        The claim that :func:`confirm` tests, and why, in words.
    judge : callable
        Forms -> evidence, cheapest first; dimensions are checked before it and need not be repeated.
    derive : callable
        The derivation.  Its forms are the corrected ones of an erratum and the reconstructed ones.
    effect : callable
        What the difference does at the paper's operating point, in figures computed there.
    repair : callable, errata only
        Makes the stated correction to the printed forms, and nothing else: what it gives must pass the
        judge, so a slip in the transcription beyond the stated misprint is noticed.
    found_by : tuple of kinds, errata only
        The kinds of evidence that fail on the printed forms: exactly these.
    known : mapping
        Dimensions of symbols and functions that are not in the nomenclature.
    size : callable, optional
        What is off at Table 3's point and by how much, relative, where the values of the forms there do not say it
        (:mod:`derivations.ledger.severity`).
    """

    id: str
    section: str
    title: str
    place: str
    printed: Forms
    units: Mapping[str, str]
    verdict: Verdict
    reason: str
    judge: Callable[[Forms], Iterable[Evidence]]
    derive: Callable[[], Derivation]
    effect: Callable[[], str]
    repair: Callable[[Forms], Forms] | None = None
    found_by: tuple[Kind, ...] = ()
    known: Mapping[sp.Basic, Dimension] = field(default_factory=dict)
    picture: Callable[[], Picture] | None = None
    size: Callable[[], tuple[str, float]] | None = None

    def evidence(self, forms: Forms) -> Iterator[Evidence]:
        """Evidence on any forms: dimensions, then the judge's; forms it cannot evaluate speak against themselves."""
        yield _dimensions(forms, self.units, self.known)
        try:
            yield from self.judge(forms)
        except _NONSENSE as error:
            yield Evidence("domain", False, f"cannot be evaluated: {type(error).__name__}: {error}")

    def evidence_on_repair(self, forms: Forms) -> Iterator[Evidence]:
        """Evidence on forms after the stated correction; where it cannot be made, that speaks against them."""
        if self.repair is None:
            yield Evidence("identity", False, "an erratum states its correction as a repair of the printed form")
            return
        try:
            mended = self.repair(forms)
        except _NONSENSE as error:
            yield Evidence("domain", False, f"cannot be repaired: {type(error).__name__}: {error}")
            return
        yield from self.evidence(mended)

    def rejects(self, forms: Forms) -> Evidence | None:
        """The first evidence that speaks against the forms; None if all speaks for them."""
        with mp.workdps(WORKING_DIGITS):
            return next((found for found in self.evidence(forms) if not found.ok), None)

    def rejects_print(self, forms: Forms) -> Evidence | None:
        """What speaks against forms as the print of an erratum: their repair fails, or they fail as they should not."""
        with mp.workdps(WORKING_DIGITS):
            for found in self.evidence_on_repair(forms):
                if not found.ok:
                    return found
            for found in self.evidence(forms):
                if found.ok == (found.kind in self.found_by):
                    return found
        return None

    def subject(self) -> Forms:
        """The forms that stand: the printed ones, or the corrected or reconstructed ones."""
        return self.derive().forms if self.verdict in ("erratum", "reconstructed") else self.printed


def evidence(kind: Kind, ok: object, detail: str) -> Evidence:
    """Evidence from a condition, which may be a SymPy or NumPy truth value."""
    return Evidence(kind, bool(ok), detail)


def step(text: str, *shows: sp.Basic, zero: sp.Basic | Iterable[sp.Basic] | None = None) -> Step:
    """A step; it holds if every expression in ``zero`` reduces to 0, and is a premise without any."""
    if zero is None:
        return Step(text, shows)
    expressions = [zero] if isinstance(zero, sp.Basic) else list(zero)
    return Step(text, shows, all(vanishes(expression) for expression in expressions))


def _dimensions(forms: Forms, units: Mapping[str, str], known: Mapping[sp.Basic, Dimension]) -> Evidence:
    """Every form has the dimension of its unit, and no terms of unlike dimension meet in it."""
    for name, form in forms.items():
        try:
            found = dimension(form, known)
        except DimensionError as error:
            return Evidence("dimension", False, f"{name}: {error}")
        if name in units and found != parse_unit(units[name]).dimension:
            return Evidence("dimension", False, f"{name} has the dimension {found}, not that of {units[name]}")
    stated = ", ".join(f"{name} [{units[name]}]" for name in forms if name in units) or "both sides agree"
    return Evidence("dimension", True, f"consistent: {stated}")


@dataclass(frozen=True)
class Result:
    """An entry held against its evidence; ``problems`` is empty when the verdict is confirmed."""

    entry: Entry
    derivation: Derivation
    printed: tuple[Evidence, ...]
    corrected: tuple[Evidence, ...]
    problems: tuple[str, ...]
    effect: str
    figures: tuple[Figure, ...] = ()

    @property
    def confirmed(self) -> bool:
        """Whether the evidence bears the stated verdict out."""
        return not self.problems

    @property
    def dimension_ok(self) -> bool | None:
        """Whether the printed forms are dimensionally consistent; None where nothing is printed."""
        found = [e.ok for e in self.printed if e.kind == "dimension"]
        return all(found) if found else None


def _against(found: Iterable[Evidence]) -> list[str]:
    return [f"{e.kind}: {e.detail}" for e in found if not e.ok]


def _too_few_kinds(found: Iterable[Evidence]) -> list[str]:
    kinds = sorted({e.kind for e in found if e.ok})
    return [] if len(kinds) >= 2 else [f"needs two independent kinds of evidence, has {kinds}"]


def _erratum(entry: Entry, printed: tuple[Evidence, ...], corrected: tuple[Evidence, ...]) -> list[str]:
    """Printed fails as stated; the stated repair of it and the derived form both pass."""
    problems = [f"the corrected form fails, {p}" for p in _against(corrected)] + _too_few_kinds(corrected)
    failing = {e.kind for e in printed if not e.ok}
    if not failing:
        problems.append("called an erratum, but nothing speaks against the printed form")
    elif failing != set(entry.found_by):
        problems.append(f"the printed form fails by {sorted(failing)}, stated is {sorted(entry.found_by)}")
    return problems + [f"the repaired print fails, {p}" for p in _against(entry.evidence_on_repair(entry.printed))]


def _passing(found: tuple[Evidence, ...], required: set[str]) -> list[str]:
    missing = required - {e.kind for e in found if e.ok}
    return _against(found) + _too_few_kinds(found) + [f"needs evidence of kind {kind}" for kind in sorted(missing)]


_REQUIRED: dict[str, set[str]] = {"approximation": {"error_size"}, "empirical": {"data"}}


def _too_coarse(found: tuple[Evidence, ...]) -> list[str]:
    """What the rule of :data:`APPROXIMATION_LIMIT` says against an approximation; the limit is in its evidence."""
    sizes = [e.size for e in found if e.kind == "error_size" and e.size is not None]
    if not sizes:
        return ["an approximation states the size of its error at Table 3's point"]
    off = max(abs(size) for size in sizes)
    return [f"off by {100 * off:.3g} % at Table 3's point: an erratum"] if off > APPROXIMATION_LIMIT else []


def confirm(entry: Entry) -> Result:
    """Hold an entry's stated verdict against its evidence, at 45 digits; see :func:`_confirm` for the rules."""
    with mp.workdps(WORKING_DIGITS):
        return _confirm(entry)


def _confirm(entry: Entry) -> Result:
    """Run derivation, judge and rules of an entry.

    verified, definition : every evidence on the printed forms speaks for them, of two kinds at least
    approximation        : the same, and the size of the error is among it, small enough and vanishing in a limit
    empirical            : the same, and data are among it
    erratum              : the printed forms fail by exactly the kinds stated, the derived ones and the
                           repaired print pass, by two kinds at least
    reconstructed        : nothing is printed, the derived forms pass by two kinds at least
    """
    derivation = entry.derive()
    problems = [f"the step does not hold: {s.text}" for s in derivation.steps if s.holds is False]
    printed = tuple(entry.evidence(entry.printed)) if entry.printed else ()
    corrected: tuple[Evidence, ...] = ()
    if entry.verdict in ("erratum", "reconstructed"):
        corrected = tuple(entry.evidence(derivation.forms))
    if entry.verdict == "erratum":
        problems += _erratum(entry, printed, corrected)
    elif entry.verdict == "reconstructed":
        problems += ["called reconstructed, but it is printed"] if entry.printed else []
        problems += _passing(corrected, set())
    else:
        problems += _passing(printed, _REQUIRED.get(entry.verdict, set()))
        problems += _too_coarse(printed) if entry.verdict == "approximation" else []
    if not derivation.steps:
        problems.append("has no derivation")
    with recorded() as figures:
        effect = entry.effect()
    return Result(entry, derivation, printed, corrected, tuple(problems), effect, tuple(figures))
