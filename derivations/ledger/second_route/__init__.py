"""Every figure of the effects once more, by the second witness: what ``verify`` holds the printed figures against.

One function per entry, in the order in which the entry's effect computes its figures.  Laws that the paper prints
wrongly are typed here a second time, from the paper; nothing is taken from the entries but the table (35).
"""

from derivations.ledger.second_route import (
    appendices,
    own_entries,
    section_2,
    section_3,
    section_4,
    sections_6_and_7,
    statements,
    tables,
)
from derivations.ledger.second_route.common import SECOND_ROUTES

__all__ = [
    "SECOND_ROUTES",
    "appendices",
    "own_entries",
    "section_2",
    "section_3",
    "section_4",
    "sections_6_and_7",
    "statements",
    "tables",
]
