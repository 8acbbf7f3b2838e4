"""What the figures of an effect were computed with: drive, start, phase lead, switching phase and levels."""

from __future__ import annotations

import re

__all__ = ["ABOUT_A_CYCLE", "effect_at"]

_DRIVE = {"prepressure": "180 N", "frequency_difference": "3000 Hz", "pulses": "14 of 20"}
_LEVELS = {
    "contact": "winkler",
    "resonance": "quartic",
    "foundation": "harmonic",
    "amplitude": "measured",
    "axis": "eq. 1",
    "rotation": "slope",
    "damping_ratio": "0.006 throughout",
}
_EACH = "periodic, steady, rest"
ABOUT_A_CYCLE = {
    **dict.fromkeys(
        (
            "supplement-redu",
            "supplement-addredu",
            "supplement-add",
            "9",
            "10",
            "13",
            "14",
            "18",
            "19",
            "20",
            "22",
            "23",
            "24",
            "A13",
        ),
        "steady",
    ),
    **dict.fromkeys(
        ("33", "35", "36", "37", "38", "transfer-cases", "rotor-orbit", "42", "A14", "A15", "A17", "claim-crest"),
        "periodic",
    ),
    **dict.fromkeys(("Q(t)", "43", "44", "A16", "claim-half-beat", "claim-contact", "claim-Q_vib"), _EACH),
    "A16": "periodic, steady",
    "claim-contact": "periodic, steady",
}
"""Entries whose figures are of a drive cycle, and what it starts from."""
_STEADY_WAVE = ("11", "25", "26", "27", "28", "29", "31", "32", "34", "A11", "claim-proportional")
_OF_A_LATER_TABLE = {"35", "36", "transfer-cases"}


def effect_at(entry: str, effect: str) -> dict[str, str] | None:
    """Drive, start, lead and levels of the figures; None where an effect has no figure of the operating point."""
    if not re.search(r"[1-9]", effect) or effect.startswith("None: printed"):
        return None
    about: dict[str, str] = {**_DRIVE}
    if entry in ABOUT_A_CYCLE:
        about |= {"start": ABOUT_A_CYCLE[entry], "phase_lead": "+1", "switching_phase": "0"}
    elif entry in _STEADY_WAVE:
        about |= {"start": "steady wave of the amplitude of one phase"}
    if entry in _OF_A_LATER_TABLE:
        about |= {"rotor": "633 arcsec/s, Table 4"}
    if entry in ("37", "38"):
        about |= {"rotor": "at rest"}
    if entry == "claim-Q_vib":
        about |= {"besides": "4000 Hz, 55 of 100 pulses, periodic, phase lead -1"}
    if entry in ("claim-one-beat",):
        about |= {"besides": "55 of 100 pulses"}
    return {**about, **_LEVELS}
