"""The paper's claims with their verdicts, and which reading of what it leaves open comes nearest to it.

    python examples/claims.py

Takes about half a minute on two cores; docs/claims.md has what it prints.
"""

from __future__ import annotations

import textwrap
from collections import Counter

import numpy as np
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.claims import VERDICTS, Claim, best, claims, reading_rows, readings
from trum_sym.paper.readings import AXES, Readings

MARKS = {
    "nearest": "nearest to Table 4's determinants",
    "determinants": "most of the claims on determinants",
    "claims": "most of all claims that depend on the reading",
}


def summary(found: Readings, judged: list[Claim]) -> str:
    """The readings that stand out, and all of start, lead and switching phase at the default level and measured."""
    rows = reading_rows(found, judged)
    lines = []
    for name, row in best(found, judged).items():
        words = ", ".join(f"{axis} {row[axis]}" for axis in AXES)
        lines += textwrap.wrap(f"{MARKS[name]}: {words}", 118, subsequent_indent="    ")
        lines.append(
            f"    Q_aver {row['q_average off %']:+.2f} %, Q_vib {row['q_volatility off %']:+.2f} %, distance "
            f"{row['distance %']:.2f} %; meets {len(row['holds'])} of {len(row['holds']) + len(row['fails'])}"
        )
    default = {"contact": "winkler", "amplitude": "measured"}
    table = [
        (
            row["start"],
            row["phase lead"],
            row["switching phase"][:1],
            row["resonance"],
            row["q_average off %"],
            row["q_volatility off %"],
            row["mean_speed"] / ARCSEC,
            100 * row["speed_volatility"],
            f"{len(row['holds'])} of {len(row['holds']) + len(row['fails'])}",
        )
        for row in rows
        if all(row[axis] == word for axis, word in default.items())
        and (row["resonance"], row["foundation"]) in (("quartic", "harmonic"), ("39703 Hz", "any"))
    ]
    headers = (
        "start",
        "lead",
        "crest",
        "f_n",
        "Q_aver off %",
        "Q_vib off %",
        "v_s arcsec/s",
        "sigma_s %",
        "claims met",
    )
    return "\n".join([*lines, "", tabulate(table, headers, floatfmt=("", "", "", "", "+.2f", "+.2f", ".3g", ".3g"))])


def phases(motor: ts.Motor) -> str:
    """What the determinants of Table 3 span over all switching phases, lead -1; half a turn changes nothing."""
    lines = ["over all switching phases, not only the two that the text writes down, phase lead -1, default level:"]
    for start in ("periodic", "steady", "rest"):
        drive = ts.Drive(start=start, phase_lead=-1, switching_phase=np.arange(36) * np.pi / 36)
        point = ts.evaluate(motor, drive)
        spans = [f"{np.min(q):.0f} to {np.max(q):.0f}" for q in (point.q_average, point.q_volatility)]
        lines.append(f"    {start}: Q_aver {spans[0]}, Q_vib {spans[1]} 1/s")
    return "\n".join(lines)


def listed(judged: list[Claim]) -> str:
    """Every claim: place, verdict, quotation, what was computed, where it holds."""
    counts = Counter(claim.verdict for claim in judged)
    lines = [f"{len(judged)} claims: " + ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)]
    for claim in judged:
        lines += ["", f"{claim.place} [{claim.id}]: {claim.verdict.upper()}"]
        for text in (f'"{claim.quote}"', f"computed: {claim.computed}", f"holds in: {claim.conditions}"):
            lines += textwrap.wrap(text, 116, initial_indent="  ", subsequent_indent="      ")
        lines.append(f"  shown by: {claim.anchor}")
    return "\n".join(lines)


def text(motor: ts.Motor, found: Readings, judged: list[Claim]) -> str:
    """All of it."""
    return f"{summary(found, judged)}\n\n{phases(motor)}\n\n{listed(judged)}"


def main() -> None:
    """Print it."""
    motor = ts.load_motor("trum60")
    found = readings(motor)
    print(text(motor, found, claims(motor, found)))


if __name__ == "__main__":
    main()
