"""The ledger: every equation of the paper as printed, as derived, with a verdict and the evidence for it."""

from __future__ import annotations

from derivations.ledger import (
    section_2_amplitude,
    section_2_composite,
    section_2_vibration,
    section_3_phases,
    section_3_supplement,
)
from derivations.ledger.model import Entry

__all__ = ["ENTRIES", "entry"]

ENTRIES: tuple[Entry, ...] = (
    *section_2_composite.ENTRIES,
    *section_2_vibration.ENTRIES,
    *section_2_amplitude.ENTRIES,
    *section_3_supplement.ENTRIES,
    *section_3_phases.ENTRIES,
)


def entry(name: str) -> Entry:
    """The entry of an id; a LookupError that lists the ids for an unknown one."""
    for candidate in ENTRIES:
        if candidate.id == name:
            return candidate
    raise LookupError(f"no equation {name}; there are {', '.join(e.id for e in ENTRIES)}")
