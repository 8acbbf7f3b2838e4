"""The paper's statements of results, Sects. 5 to 9, each computed and judged; and which reading meets which.

A verdict is derived: a claim's check says in which readings it holds, and this module what follows from that.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trum_sym.inputs.drive import STARTS
from trum_sym.inputs.motor import Motor
from trum_sym.paper import section_5, section_6, sections_7_to_9
from trum_sym.paper.findings import Context, Finding, Truth
from trum_sym.paper.readings import AXES, LEADS, LEVELS, Readings
from trum_sym.paper.readings import readings as compute_readings

__all__ = [
    "PARTLY",
    "VERDICTS",
    "Claim",
    "Statement",
    "best",
    "claims",
    "judged",
    "reading_rows",
    "readings",
    "statements",
]

REPRODUCED, PARTLY, CONTRADICTED = "reproduced", "reproduced only under", "contradicted"
UNDECIDABLE = "not decidable from the paper"
VERDICTS = (REPRODUCED, PARTLY, CONTRADICTED, UNDECIDABLE)

_SHAPE = (len(STARTS), len(LEADS), 2)


@dataclass(frozen=True)
class Statement:
    """A sentence of the paper, where it stands, and the anchor of the figure or table that shows it."""

    id: str
    place: str
    quote: str
    anchor: str


def statements() -> tuple[Statement, ...]:
    """All of them, from ``claims.toml``, in the paper's order."""
    text = (Path(__file__).parent / "claims.toml").read_text("utf-8")
    return tuple(Statement(id=name, **entry) for name, entry in tomllib.loads(text).items())


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper and what became of it.

    Attributes
    ----------
    id : short name
    place : section, and figure or table
    quote : the sentence, shortened with dots
    computed : what was computed, with its figures
    conditions : the starts and phase leads in which it holds, or why that does not matter
    verdict : one of ``VERDICTS``
    anchor : of the figure or table that shows it
    holds : by (start, phase lead, switching phase, level); False where it was not computed, as ``known`` says
    known : the same shape
    """

    id: str
    place: str
    quote: str
    computed: str
    conditions: str
    verdict: str
    anchor: str
    holds: Truth
    known: Truth

    def as_dict(self) -> dict[str, str]:
        """The words, by name."""
        names = ("id", "place", "quote", "computed", "conditions", "verdict", "anchor")
        return {name: getattr(self, name) for name in names}


def judged(statement: Statement, finding: Finding) -> Claim:
    """The verdict that a finding gives."""
    levels = tuple(range(len(LEVELS))) if finding.levels is None else finding.levels
    shape = (*_SHAPE, len(LEVELS))
    known, holds = np.zeros(shape, bool), np.zeros(shape, bool)
    known[..., levels] = True
    holds[..., levels] = np.broadcast_to(np.asarray(finding.holds, bool), (*_SHAPE, len(levels)))
    here = holds[..., levels]
    conditions = _where(here, levels)
    if finding.undecidable is not None:
        verdict, conditions = UNDECIDABLE, finding.undecidable
    elif finding.assumed is not None:
        verdict, conditions = _assumed(here, finding.assumed, conditions)
    else:
        verdict = REPRODUCED if here.all() else PARTLY if here.any() else CONTRADICTED
    return Claim(
        statement.id, statement.place, statement.quote, finding.computed, conditions, verdict, statement.anchor,
        holds, known,
    )  # fmt: skip


def _assumed(holds: Truth, corners: Truth, conditions: str) -> tuple[str, str]:
    """The verdict where friction or contact radius matter, which the paper does not give.

    A reading counts only if the claim holds at all values of both that are plausible; if it holds at some of them only,
    and in no reading at all, the paper does not decide it.
    """
    always, sometimes = corners.all(axis=-1), corners.any(axis=-1)
    of = f"of {corners.shape[-1]} corners of the assumed friction (0.2 to 0.3) and contact radius (25 to 30 mm)"
    if holds.all() and always.all():
        return REPRODUCED, f"{conditions}; at all {of}"
    if (holds.all(axis=-1) & always).any():
        cells = _cells(np.asarray(holds.all(axis=-1) & always)[..., None])
        return PARTLY, f"{cells}; at all {of}"
    if sometimes.any() or holds.any():
        most = int(corners.sum(axis=-1).max())
        return UNDECIDABLE, f"{conditions}; at the default level at most at {most} {of}"
    return CONTRADICTED, f"{conditions}; at none {of}"


def _cells(holds: Truth) -> str:
    """Starts and leads of the readings that hold, with how many of each."""
    parts = []
    for i, start in enumerate(STARTS):
        for j, lead in enumerate(LEADS):
            count, of = int(holds[i, j].sum()), holds[i, j].size
            if count:
                share = "" if count == of else f" ({count} of {of})"
                parts.append(f"start {start}, lead {lead:+.0f}{share}")
    return "; ".join(parts)


def _where(holds: Truth, levels: tuple[int, ...]) -> str:
    """In which readings it holds."""
    if holds.all():
        return f"all {holds.size} readings"
    if not holds.any():
        return f"none of {holds.size} readings"
    if (holds == holds[:1, :1, :1]).all():
        return f"any start and lead; {_of_levels(holds[0, 0, 0], levels)}"
    return _cells(holds)


def _of_levels(holds: Truth, levels: tuple[int, ...]) -> str:
    """The values of the one convention among the last four that tells most, with how many levels of each."""
    best: tuple[int, str] = (-1, "")
    for axis, name in enumerate(AXES[3:]):
        counts: dict[str, list[bool]] = {}
        for truth, level in zip(holds, levels, strict=True):
            counts.setdefault(LEVELS[level][axis], []).append(bool(truth))
        pure = sum(len(found) for found in counts.values() if all(found) or not any(found))
        parts = [
            f"{name} {word}" + ("" if all(found) else f" ({sum(found)} of {len(found)})")
            for word, found in counts.items()
            if any(found)
        ]
        best = max(best, (pure, "; ".join(parts)), key=lambda pair: pair[0])
    return best[1]


def claims(motor: Motor, found: Readings | None = None, progress: bool = False) -> list[Claim]:
    """Every statement, judged.

    Parameters
    ----------
    motor : Motor
        The paper's.
    found : Readings, optional
        From :func:`readings`, which is called if they are not given.
    progress : bool
        Whether to show bars on the standard error.
    """
    context = Context(motor, found or readings(motor, progress))
    checks = {**section_5.CHECKS, **section_6.CHECKS, **sections_7_to_9.CHECKS}
    return [judged(statement, checks[statement.id](context)) for statement in statements()]


def readings(motor: Motor, progress: bool = False) -> Readings:
    """Every reading of the conventions that the paper leaves open; see :mod:`trum_sym.paper.readings`."""
    return compute_readings(motor, progress)


def reading_rows(found: Readings, judged_claims: list[Claim]) -> list[dict[str, Any]]:
    """A record a reading, nearest to Table 4 first: its figures, and which of the claims hold that not all meet."""
    open_claims = [c for c in judged_claims if c.holds[c.known].any() and not c.holds[c.known].all()]
    rows = found.rows()
    for row in rows:
        index = row["index"]
        row["holds"] = [claim.id for claim in open_claims if claim.holds[index]]
        row["fails"] = [claim.id for claim in open_claims if claim.known[index] and not claim.holds[index]]
    return rows


def best(found: Readings, judged_claims: list[Claim]) -> dict[str, dict[str, Any]]:
    """The rows of :func:`reading_rows` that stand out.

    ``nearest``: both determinants of Table 4 together; ``determinants``: most of the claims on determinants alone,
    which are known for every reading, the nearest to Table 4 of those; ``claims``: the same for all claims that depend
    on the reading, among the readings for which all are known.
    """
    everywhere = {claim.id for claim in judged_claims if claim.known.all()}
    rows = reading_rows(found, judged_claims)
    whole = max(len(row["holds"]) + len(row["fails"]) for row in rows)
    complete = [row for row in rows if len(row["holds"]) + len(row["fails"]) == whole]
    return {
        "nearest": rows[0],
        "determinants": min(rows, key=lambda row: (-len(everywhere & set(row["holds"])), row["distance %"])),
        "claims": min(complete, key=lambda row: (-len(row["holds"]), row["distance %"])),
    }
