"""The paper's statements, Sects. 1 to 9, each computed and judged; and which reading meets which.

A verdict is derived: a claim's check says in which readings it holds, and this module what follows from that.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trum_sym.inputs.drive import STARTS
from trum_sym.inputs.motor import Motor
from trum_sym.output.progress import shown
from trum_sym.paper import section_5, section_6, sections_1_to_4, sections_7_to_9
from trum_sym.paper.findings import ByInertia, Context, Finding, Truth
from trum_sym.paper.readings import AXES, COMBINATIONS, LEADS, Readings
from trum_sym.paper.readings import readings as compute_readings

__all__ = [
    "PARTLY",
    "VERDICTS",
    "Claim",
    "Statement",
    "Varied",
    "best",
    "claims",
    "judged",
    "reading_rows",
    "readings",
    "statements",
    "varied",
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
    rotor : where it holds at each load's inertia, for a claim on the rotor
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
    rotor: ByInertia | None = None

    def as_dict(self) -> dict[str, str]:
        """The words, by name."""
        names = ("id", "place", "quote", "computed", "conditions", "verdict", "anchor")
        return {name: getattr(self, name) for name in names}


def judged(statement: Statement, finding: Finding) -> Claim:
    """The verdict that a finding gives."""
    if finding.settings is not None:
        return _apart(statement, finding, finding.settings)
    levels = tuple(range(len(COMBINATIONS))) if finding.levels is None else finding.levels
    shape = (*_SHAPE, len(COMBINATIONS))
    known, holds = np.zeros(shape, bool), np.zeros(shape, bool)
    known[..., levels] = True
    holds[..., levels] = np.broadcast_to(np.asarray(finding.holds, bool), (*_SHAPE, len(levels)))
    here = holds[..., levels]
    conditions = _where(here, levels)
    if finding.undecidable is not None:
        verdict, conditions = UNDECIDABLE, finding.undecidable
    else:
        verdict = _verdict(here, finding.assumed, finding.possible)
        if finding.assumed is not None:
            conditions = _conditions(verdict, here, finding.assumed, conditions, finding.assumed_of)
    return Claim(
        statement.id,
        statement.place,
        statement.quote,
        finding.computed,
        conditions,
        verdict,
        statement.anchor,
        holds,
        known,
        finding.rotor,
    )


def _apart(statement: Statement, finding: Finding, settings: Mapping[str, bool]) -> Claim:
    """The verdict on a claim that no reading decides, by the same rule over the settings that were compared."""
    none = np.zeros((*_SHAPE, len(COMBINATIONS)), bool)
    held = [setting for setting, holds in settings.items() if holds]
    conditions = f"{'at ' + '; '.join(held) if held else 'at none'}; {len(held)} of {len(settings)} settings"
    verdict = _verdict(np.array(list(settings.values())))
    found = (statement.id, statement.place, statement.quote, finding.computed, conditions, verdict, statement.anchor)
    return Claim(*found, none, none)


def _verdict(holds: Truth, corners: Truth | None = None, possible: Truth | None = None) -> str:
    """The verdict that follows from where a claim holds.

    Where something matters that the paper does not give, a reading counts only if the claim holds at all corners of
    what is plausible; if it holds at some of them only, and in no reading at all, the paper does not decide it.
    """
    if corners is None:
        return REPRODUCED if holds.all() else PARTLY if holds.any() else CONTRADICTED
    if holds.all() and corners.all():
        return REPRODUCED
    if _certain(holds, corners).any():
        return PARTLY
    some = corners.any() or (holds if possible is None else possible).any()
    return UNDECIDABLE if some else CONTRADICTED


def _certain(holds: Truth, corners: Truth) -> Truth:
    """By (start, phase lead, switching phase), whether it holds at all levels and corners."""
    return np.asarray(holds.all(axis=-1) & corners.all(axis=-1))


def _conditions(verdict: str, holds: Truth, corners: Truth, where: str, of_what: str) -> str:
    """In which readings it holds, and at how many corners."""
    of = f"of {corners.shape[-1]} corners of the assumed {of_what}"
    if verdict == REPRODUCED:
        return f"{where}; at all {of}"
    if verdict == PARTLY:
        return f"{_cells(_certain(holds, corners)[..., None])}; at all {of}"
    most = int(corners.sum(axis=-1).max())
    return f"{where}; at the default level at most at {most or 'none'} {of}"


@dataclass(frozen=True)
class Varied:
    """A claim on the rotor, by what was taken for the speed and by the load's inertia.

    Attributes
    ----------
    id, place : of the claim
    measured : whether it is about the motor that was measured, which pulls a weight
    verdicts : what the rule gives for the speed itself of a rotor without a load, and for what is judged (what the
        encoder reads if ``measured``) at each value of ``LOAD_INERTIA``
    verdict : the claim's own
    cells : by (start, phase lead), one letter for each of ``verdicts``: ``+`` where it holds in all switching phases,
        levels and corners, ``-`` where in none, ``o`` where in some
    """

    id: str
    place: str
    measured: bool
    verdicts: tuple[str, ...]
    verdict: str
    cells: tuple[tuple[str, ...], ...]

    @property
    def by_encoder(self) -> bool:
        """Whether what the encoder reads changes where it holds."""
        return any(cell[0] != cell[1] for row in self.cells for cell in row)

    @property
    def by_inertia(self) -> bool:
        """Whether the load's inertia does."""
        return any(len(set(cell[1:])) > 1 for row in self.cells for cell in row)

    @property
    def decided(self) -> int:
        """In how many of the starts and phase leads it surely holds or fails over what is plausible."""
        ends = slice(2, None) if self.measured else slice(1, 2)
        return sum(len(set(cell[ends])) == 1 and "o" not in cell[ends] for row in self.cells for cell in row)


def varied(judged_claims: list[Claim]) -> list[Varied]:
    """The claims on the rotor at each load's inertia, in the paper's order."""
    found = []
    for claim in judged_claims:
        if claim.rotor is None:
            continue
        by = claim.rotor
        holds = [by.speed_holds, *by.holds]
        corners = [by.speed_corners, *(by.corners if by.corners is not None else [None] * len(by.holds))]
        cells = tuple(
            tuple(
                "".join(_letter(h[i, j], None if k is None else k[i, j]) for h, k in zip(holds, corners, strict=True))
                for j in range(len(LEADS))
            )
            for i in range(len(STARTS))
        )
        verdicts = tuple(_verdict(h, k) for h, k in zip(holds, corners, strict=True))
        found.append(Varied(claim.id, claim.place, by.measured, verdicts, claim.verdict, cells))
    return found


def _letter(holds: Truth, corners: Truth | None) -> str:
    every = [holds] if corners is None else [holds, corners]
    return "+" if all(part.all() for part in every) else "o" if any(part.any() for part in every) else "-"


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
            counts.setdefault(COMBINATIONS[level][axis], []).append(bool(truth))
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
    checks = {**sections_1_to_4.CHECKS, **section_5.CHECKS, **section_6.CHECKS, **sections_7_to_9.CHECKS}
    every = shown(list(statements()), "claims" if progress else None)
    return [judged(statement, checks[statement.id](context)) for statement in every]


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
