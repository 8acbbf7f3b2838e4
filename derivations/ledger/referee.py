"""What a referee asks of an entry beyond its verdict: is the copy right, how sure is it, how bad is the erratum."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import mpmath as mp

from derivations.ledger.model import WORKING_DIGITS, Entry, Forms, Result
from derivations.ledger.severity import Severity, hangs_on_the_supplement, severity, would_approximate
from derivations.ledger.transcription import Copy, copy_of, differences, mends, other_readings

__all__ = ["Reading", "Review", "review"]


@dataclass(frozen=True)
class Reading:
    """What the verdict would be if a doubtful copy lost what is put back here."""

    what: str
    verdict: str
    detail: str


@dataclass(frozen=True)
class Review:
    """Sureness of the copy with both outcomes, severity, whether the verdict is conditional, and what is wrong."""

    copy: Copy
    readings: tuple[Reading, ...]
    severity: Severity | None
    conditional: bool
    problems: tuple[str, ...]


def _reading(entry: Entry, what: str, forms: Forms) -> Reading:
    failing = [e for e in entry.evidence(forms) if not e.ok]
    if not failing:
        return Reading(what, "verified", "the print passes every test then")
    return Reading(what, "erratum", "; ".join(f"{e.kind}: {e.detail}" for e in failing))


def _stale_mends(entry: Entry) -> Iterator[str]:
    """Mends that the judge refuses; those of a doubtful copy may fail, they are readings first."""
    readings = [forms for _, forms in other_readings(entry)]
    for signs, forms in mends(entry):
        against = entry.rejects(forms) if forms not in readings else None
        if against is not None:
            yield f"the print mended by {signs} signs fails, {against.kind}: {against.detail}"


def review(result: Result) -> Review:
    """Compare both transcriptions of an entry, try its other readings, and weigh an erratum."""
    entry = result.entry
    problems = differences(entry)
    if problems:
        return Review(copy_of(entry), (), None, False, tuple(problems))
    with mp.workdps(WORKING_DIGITS):
        readings = tuple(_reading(entry, what, forms) for what, forms in other_readings(entry))
        problems += _stale_mends(entry)
    rule = would_approximate(result)
    problems += [f"called an erratum, but by the rule an approximation: {rule}"] if rule else []
    found = severity(result)
    conditional = found.word == "conditional" if found else hangs_on_the_supplement(entry.printed)
    return Review(copy_of(entry), readings, found, conditional, tuple(problems))
