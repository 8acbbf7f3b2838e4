"""The ledger's verdicts put to a second algebra system, Maxima, which derives what must hold on its own.

What is printed comes from the second transcription, what stands from the derivation, both as text by
:mod:`derivations.maxima.printer`.  The premises stand in ``derivations/maxima/judges/``, written for Maxima; a judge
does not know whether it is given a print, a correction or a mutant.  What it found is kept in
``generated/ledger.second_opinion.json`` with a checksum of what it was asked, so that ``verify`` sees when that has
changed without needing Maxima.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from queue import SimpleQueue
from typing import Any, TypeVar

import sympy as sp

from derivations.codegen.emit import GENERATED
from derivations.ledger.judge import usual
from derivations.ledger.model import Entry, Forms
from derivations.ledger.mutate import MUTATED, Mutant, changes_nothing, mutants
from derivations.ledger.transcription import load, second
from derivations.maxima.printer import PrintError, forms_text, name_of
from derivations.maxima.session import JUDGES, NO_VALUE, SCRIPTS, Finding, MaximaError, Session, preamble
from derivations.nomenclature import NOMENCLATURE

__all__ = [
    "ASKED",
    "FILE",
    "SAMPLED",
    "Opinion",
    "as_record",
    "ask",
    "checksum",
    "new_session",
    "run",
    "run_mutants",
    "stale",
]

ASKED = ("verified", "approximation", "erratum", "reconstructed")
"""Verdicts that are put to Maxima; a definition follows from nothing, and data are no algebra."""
FILE = GENERATED / "ledger.second_opinion.json"
SAMPLED = re.compile("digits|QUADPACK|cases")
"""Methods that are no proof but numbers at points or states."""
_SECONDS = 60.0
T = TypeVar("T")
R = TypeVar("R")
_PARTS = {"verified": ("printed",), "approximation": ("printed",), "reconstructed": ("standing",)}


@dataclass(frozen=True)
class Opinion:
    """What Maxima found on the forms of an entry, or in words why it could not decide ('' if it could)."""

    asked: str  # checksum
    findings: dict[str, list[Finding]]
    undecided: str = ""

    def problems(self, entry: Entry) -> list[str]:
        """What speaks against the entry's verdict."""
        against = {part: [f for f in found if not f.ok] for part, found in self.findings.items()}
        said = [f"{part}: {f.detail} ({f.method})" for part, found in against.items() for f in found]
        if entry.verdict != "erratum":
            return said
        faults = [f"standing: {f.detail} ({f.method})" for f in against.get("standing", ())]
        if not any(f.method != NO_VALUE for f in against.get("printed", ())):  # a print without a value refutes nothing
            faults.append("nothing speaks against the print")
        return faults


def _asked(entry: Entry, derived: Forms | None = None) -> dict[str, str]:
    """What is put to Maxima, as text: the print by the second transcription, and what stands of errata."""
    parts = _PARTS.get(entry.verdict, ("printed", "standing"))
    forms: dict[str, Forms] = {}
    if "printed" in parts:
        forms["printed"] = second(entry.id) if entry.id in load() else entry.printed
    if "standing" in parts:
        forms["standing"] = entry.derive().forms if derived is None else derived
    return {part: forms_text(found) for part, found in forms.items()}


def judge_of(entry: Entry) -> str:
    """The name of an entry's judge in Maxima."""
    return "judge_" + re.sub(r"\W+", "_", entry.id)


@cache
def _scripts() -> str:
    return "".join((JUDGES / name).read_text("utf-8") for name in SCRIPTS)


@cache
def _data() -> str:
    """The preamble: which symbols are positive, and the motor's values as fractions."""
    plain = {n: e.symbol for n, e in NOMENCLATURE.items() if isinstance(e.symbol, sp.Symbol)}
    positive = [name_of(name) for name, symbol in plain.items() if symbol.is_positive]
    signed = [name_of(name) for name, symbol in plain.items() if not symbol.is_positive]
    return preamble(positive, signed, {name_of(n): str(sp.Rational(repr(v))) for n, v in usual().items()})


def checksum(asked: Mapping[str, str]) -> str:
    """Of all that Maxima is told: data, judges, forms."""
    return f"{zlib.crc32((_data() + _scripts() + ''.join(asked.values())).encode()):08x}"


def new_session() -> Session:
    """A Maxima with the judges and the motor's data."""
    return Session(_data(), _SECONDS)


def ask(entry: Entry, session: Session) -> Opinion:
    """Put an entry to Maxima."""
    findings: dict[str, list[Finding]] = {}
    asked = _asked(entry)
    for part, forms in asked.items():
        found = session.ask(judge_of(entry), forms)
        if isinstance(found, str):
            return Opinion(checksum(asked), findings, f"{part}: {found}")
        findings[part] = found
    return Opinion(checksum(asked), findings)


def _each(work: Callable[[T, Session], R], items: Iterable[T]) -> Iterator[R]:
    """Work on items in their order, as many at a time as there are processors, each with a Maxima of its own."""
    count = min(4, os.cpu_count() or 1)
    idle: SimpleQueue[Session] = SimpleQueue()
    sessions = [new_session() for _ in range(count)]
    for session in sessions:
        idle.put(session)

    def with_session(item: T) -> R:
        session = idle.get()
        try:
            return work(item, session)
        finally:
            idle.put(session)

    try:
        with ThreadPoolExecutor(count) as pool:
            yield from pool.map(with_session, items)
    finally:
        for session in sessions:
            session.close()


def _progress(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _kept(entry: Entry, opinion: Opinion) -> dict[str, Any]:
    """What is kept of an opinion; methods sorted, so that the file does not hang on their order."""
    return {
        "asked": opinion.asked,
        "confirmed": not opinion.undecided and not opinion.problems(entry),
        "undecided": opinion.undecided or None,
        "methods": sorted({f.method for found in opinion.findings.values() for f in found}),
        "findings": {
            part: [{"ok": f.ok, "method": f.method, "detail": f.detail} for f in found]
            for part, found in opinion.findings.items()
        },
    }


def _summary(found: Mapping[str, dict[str, Any]], wrong: int) -> str:
    """Counts by outcome, and of findings by the means that decided."""
    undecided = [name for name, kept in found.items() if kept["undecided"]]
    findings = [f for kept in found.values() for part in kept["findings"].values() for f in part]
    sampled = sum(bool(SAMPLED.search(f["method"])) for f in findings if f["ok"])
    speaking = sum(f["ok"] for f in findings)
    return (
        f"{len(found)} entries put to Maxima: {sum(kept['confirmed'] for kept in found.values())} confirmed, {wrong} "
        f"not, "
        f"{len(undecided)} undecided{': ' + ', '.join(undecided) if undecided else ''}\n"
        f"{len(findings)} findings: {speaking - sampled} for a form by exact means, {sampled} for one at sampled "
        f"points or "
        f"states, {len(findings) - speaking} against a print"
    )


def run(entries: tuple[Entry, ...], *, write: bool) -> int:
    """Put entries to Maxima; 0 if it confirms all that it can decide and the file says the same, 2 without Maxima."""
    chosen, start = [e for e in entries if e.verdict in ASKED], time.perf_counter()
    found: dict[str, dict[str, Any]] = {}
    wrong = 0
    try:
        for candidate, opinion in zip(chosen, _each(ask, chosen), strict=True):
            problems = opinion.problems(candidate)
            found[candidate.id] = _kept(candidate, opinion)
            said = f"undecided: {opinion.undecided}" if opinion.undecided else "; ".join(problems) or "confirmed"
            wrong += bool(problems) and not opinion.undecided
            methods = ", ".join(found[candidate.id]["methods"])
            _progress(f"[{len(found)}/{len(chosen)}] ({candidate.id}) {candidate.verdict}: {said} [{methods}]")
    except MaximaError as error:
        print(f"derivations: {error}", file=sys.stderr)
        return 2
    print(_summary(found, wrong))
    _progress(f"{time.perf_counter() - start:.1f} s")
    if write:
        FILE.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", "utf-8")
        _kept_file.cache_clear()
    differing = [name for name in found if _kept_file().get(name) != found[name]]
    for name in differing:
        _progress(f"({name}) {FILE.name} is stale: run `python -m derivations verify --second-opinion --write`")
    return 1 if wrong or differing else 0


@cache
def _kept_file() -> dict[str, dict[str, Any]]:
    return dict(json.loads(FILE.read_text("utf-8"))) if FILE.is_file() else {}


def stale(entry: Entry, derived: Forms) -> str | None:
    """Why the kept opinion on an entry whose derived forms are given does not count; None if it does."""
    if entry.verdict not in ASKED:
        return None
    kept = _kept_file().get(entry.id)
    if kept is None or kept["asked"] != checksum(_asked(entry, derived)):
        return (
            "the second opinion was asked of other forms or of another judge: run "
            "`python -m derivations verify --second-opinion --write`"
        )
    if not kept["confirmed"] and not kept["undecided"]:
        return "Maxima does not confirm it"
    return None


def as_record(entry: Entry) -> dict[str, Any]:
    """What ledger.json says of the second opinion: by whom the verdict is confirmed, by which means, or why not."""
    if entry.verdict not in ASKED:
        why = f"{'a definition' if entry.verdict == 'definition' else 'data'}, not put to Maxima"
        return {"confirmed_by": ["SymPy"], "methods": [], "findings": {}, "undecided": why}
    kept = _kept_file().get(entry.id, {"confirmed": False, "undecided": None, "methods": [], "findings": {}})
    by = ["SymPy", "Maxima"] if kept["confirmed"] else ["SymPy"]
    return {"confirmed_by": by, **{key: kept[key] for key in ("methods", "findings", "undecided")}}


# --- mutants ------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Tried:
    """What became of the mutants of an entry."""

    rejected: Counter[str]  # by the method of the first finding against each
    equivalent: int
    without_text: int
    surviving: tuple[str, ...]


def _changes_nothing(entry: Entry, mutant: Mutant, forms: Forms) -> bool:
    """Whether a mutant is proved to be the same formula; not where one of both has no value."""
    try:
        return changes_nothing(entry, mutant, forms)
    except (ArithmeticError, AttributeError, TypeError, ValueError):
        return False


def try_entry(entry: Entry, session: Session, every: int = 1) -> Tried:
    """Put every so manieth mutant of what stands of an entry to Maxima."""
    forms = entry.subject()
    rejected: Counter[str] = Counter()
    equivalent = without = 0
    surviving = []
    for mutant in list(mutants(forms))[::every]:
        try:
            ordered = {mutant.name: mutant.forms[mutant.name], **mutant.forms}  # the changed one is looked at first
            found = session.ask(judge_of(entry), forms_text(ordered), hasty=True)
        except PrintError:
            without += 1
            continue
        against = next((f for f in found if not f.ok), None) if not isinstance(found, str) else None
        if against is not None:
            rejected[against.method] += 1
        elif _changes_nothing(entry, mutant, forms):
            equivalent += 1
        else:
            why = f" ({found})" if isinstance(found, str) else ""
            surviving.append(f"({entry.id}) {mutant.name}: {mutant.slip}{why}")
    return Tried(rejected, equivalent, without, tuple(surviving))


def run_mutants(entries: tuple[Entry, ...], every: int = 1) -> int:
    """Put mutants of all standing forms to Maxima; 1 if it takes one for right that changes something."""
    chosen, start = [e for e in entries if e.verdict in MUTATED], time.perf_counter()
    rejected: Counter[str] = Counter()
    equivalent = without = 0
    surviving: list[str] = []
    try:
        for candidate, tried in zip(chosen, _each(lambda e, s: try_entry(e, s, every), chosen), strict=True):
            rejected += tried.rejected
            equivalent, without = equivalent + tried.equivalent, without + tried.without_text
            surviving += tried.surviving
            count = tried.rejected.total()
            _progress(f"({candidate.id}) {count} rejected, {len(tried.surviving)} surviving")
    except MaximaError as error:
        print(f"derivations: {error}", file=sys.stderr)
        return 2
    total = rejected.total() + equivalent + without + len(surviving)
    by = ", ".join(f"{count} by {method}" for method, count in rejected.most_common(6))
    print(
        f"{total} mutants of {len(chosen)} entries put to Maxima: {rejected.total()} rejected ({by}), {equivalent} "
        f"proved "
        f"equivalent, {without} without a value, {len(surviving)} surviving"
    )
    for line in surviving:
        print(f"surviving {line}")
    _progress(f"{time.perf_counter() - start:.1f} s")
    return 1 if surviving else 0
