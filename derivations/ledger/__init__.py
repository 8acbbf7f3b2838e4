"""The ledger: every equation of the paper as printed, as derived, with a verdict and the evidence for it."""

from __future__ import annotations

from derivations.ledger import (
    appendix_a,
    appendix_b_c,
    bench_load,
    claims,
    claims_appendix_c,
    electrical_port,
    layers,
    rotor_flange,
    rotor_orbit,
    section_2_amplitude,
    section_2_composite,
    section_2_vibration,
    section_3_conic,
    section_3_crest,
    section_3_determinant,
    section_3_phases,
    section_3_supplement,
    section_3_vectors,
    section_3_velocity,
    section_4_hertz,
    section_4_layer,
    section_4_nonsliding,
    section_4_transfer,
    section_6,
    section_7,
    table_1,
    tables_2_to_5,
    wave_reaction,
)
from derivations.ledger.model import Entry

__all__ = ["ENTRIES", "entry"]


def _in_order(entries: tuple[Entry, ...]) -> tuple[Entry, ...]:
    """By the paper's numbers, the appendices last; what has no number stays behind what it stands behind."""
    place, keyed = (False, 0), []
    for index, candidate in enumerate(entries):
        digits = candidate.id.removeprefix("A")
        if digits.isdigit():
            place = (digits != candidate.id, int(digits))
        keyed.append((place, index, candidate))
    return tuple(candidate for _, _, candidate in sorted(keyed, key=lambda item: item[:2]))


_ALL: tuple[Entry, ...] = (
    *section_2_composite.ENTRIES,
    *section_2_vibration.ENTRIES,
    *section_2_amplitude.ENTRIES,
    *section_3_supplement.ENTRIES,
    *section_3_phases.ENTRIES,
    *section_3_vectors.ENTRIES,
    *section_3_velocity.ENTRIES,
    *section_3_crest.ENTRIES,
    *section_3_conic.ENTRIES,
    *section_3_determinant.ENTRIES,
    *section_4_hertz.ENTRIES,
    *section_4_layer.ENTRIES,
    *rotor_flange.ENTRIES,
    *section_4_nonsliding.ENTRIES,
    *section_4_transfer.ENTRIES,
    *rotor_orbit.ENTRIES,
    *bench_load.ENTRIES,
    *wave_reaction.ENTRIES,
    *layers.ENTRIES,
    *electrical_port.ENTRIES,
    *table_1.ENTRIES,
    *section_6.ENTRIES,
    *section_7.ENTRIES,
    *tables_2_to_5.ENTRIES,
    *appendix_a.ENTRIES,
    *appendix_b_c.ENTRIES,
    *claims.ENTRIES,
    *claims_appendix_c.ENTRIES,
)
ENTRIES = _in_order(_ALL)


def entry(name: str) -> Entry:
    """The entry of an id; a LookupError that lists the ids for an unknown one."""
    for candidate in ENTRIES:
        if candidate.id == name:
            return candidate
    raise LookupError(f"no equation {name}; there are {', '.join(e.id for e in ENTRIES)}")
