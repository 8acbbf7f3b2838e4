"""The paper's claims with their verdicts, and which reading of what it leaves open comes nearest to it.

    python examples/claims.py

Takes about a minute on two cores; docs/claims.md has what it prints.
"""

from __future__ import annotations

import textwrap
from collections import Counter
from itertools import product

import numpy as np
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.drive import STARTS
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.claims import VERDICTS, Claim, best, claims, reading_rows, readings, varied
from trum_sym.paper.findings import Context
from trum_sym.paper.readings import AXES, LEADS, LOAD_INERTIA, Readings
from trum_sym.paper.region import region
from trum_sym.paper.trends import PAIRS, Trend, trends

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
            *(row["mean_speed"][i] / ARCSEC for i in (0, -1)),
            *(100 * row["speed_volatility"][i] for i in (0, -1)),
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
        "with load",
        "sigma_s %",
        "with load",
        "claims met",
    )
    loaded = f"with load: with {LOAD_INERTIA[-1]:.1e} kg m^2, the heaviest torque plate that the motor file states"
    formats = ("", "", "", "", "+.2f", "+.2f", ".3g", ".3g", ".3g", ".3g")
    return "\n".join([*lines, "", tabulate(table, headers, floatfmt=formats), "", loaded])


def phases(motor: ts.Motor) -> str:
    """What the determinants of Table 3 span over all switching phases, lead -1; half a turn changes nothing."""
    lines = ["over all switching phases, not only the two that the text writes down, phase lead -1, default level:"]
    for start in ("periodic", "steady", "rest"):
        drive = ts.Drive(start=start, phase_lead=-1, switching_phase=np.arange(36) * np.pi / 36)
        point = ts.evaluate(motor, drive)
        spans = [f"{np.min(q):.0f} to {np.max(q):.0f}" for q in (point.q_average, point.q_volatility)]
        lines.append(f"    {start}: Q_aver {spans[0]}, Q_vib {spans[1]} 1/s")
    return "\n".join(lines)


SHORT = dict(zip(VERDICTS, ("reproduced", "only under", "contradicted", "undecidable"), strict=True))


def by_inertia(judged: list[Claim]) -> str:
    """The claims on the rotor, reading by reading and inertia by inertia."""
    found = varied(judged)
    names = [f"{start} {lead}" for start in ("periodic", "steady", "rest") for lead in ("+1", "-1")]
    table = [
        (
            row.id,
            *(cell for cells in row.cells for cell in cells),
            *(SHORT[v] for v in row.verdicts[:2]),
            SHORT[row.verdict],
            f"{row.decided} of 6",
        )
        for row in found
    ]
    measured = [row for row in found if row.measured]
    cells = [cell for row in found for cells in row.cells for cell in cells]
    loads = ", ".join(f"{value:.1e}" for value in LOAD_INERTIA[1:])
    legend = (
        "where a claim on the rotor holds: + in all switching phases, levels and corners of what is assumed, o in some"
        ", - in none.  First letter: the speed itself of a rotor without a load; second: what the encoder reads of it, "
        f"for what was measured; third and fourth: the same with a load's inertia of {loads} kg m^2.  By speed, by "
        "encoder: verdict by the first and by the second letter; judged: by the last two for what was measured, by the "
        "second for what was simulated; decided: readings in which these are all + or all -"
    )
    counts = (
        f"{len(found)} claims on the rotor, {len(measured)} of them on the measured one, in six readings: "
        f"{sum(row.decided for row in found)} of {len(cells)} cells decided.  Changed by the encoder: "
        f"{sum(row.by_encoder for row in found)} claims, {sum(c[0] != c[1] for c in cells)} cells, "
        f"{sum(row.verdicts[0] != row.verdicts[1] for row in found)} verdicts; by the load's inertia: "
        f"{sum(row.by_inertia for row in found)} claims, {sum(len(set(c[1:])) > 1 for c in cells)} cells, "
        f"{sum(row.verdicts[1] != row.verdict for row in measured)} verdicts of measured ones"
    )
    head = ("claim", *names, "by speed", "by encoder", "judged", "decided")
    return "\n".join([*_wrapped(legend), "", tabulate(table, head, disable_numparse=True), "", *_wrapped(counts)])


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, 118)


def followed(found: list[Trend]) -> str:
    """From what inertia on the trends are those of the determinants."""
    rows: dict[tuple[str, str, str], list[str]] = {}
    for trend in found:
        cells = rows.setdefault((trend.start, f"{trend.lead:+.0f}", trend.variable), [])
        cells.append(" ".join(f"{value:+.2f}" for value in trend.at_ends))
        cells.append(
            "never" if trend.follows_from is None else f"{trend.follows_from or 0:.1e}".replace("0.0e+00", "0")
        )
    head = ("start", "lead", "over", *(word for pair in PAIRS for word in (pair, "from")))
    words = (
        "rank correlation of v_s with Q_aver and of sigma_s with Q_vib at the default level, A at its crest, without a "
        f"load's inertia and with {LOAD_INERTIA[1]:.1e} and {LOAD_INERTIA[2]:.1e} kg m^2; from: the inertia from which "
        "on it is at least 0.9; over 2800 to 3300 Hz and 160 to 210 N"
    )
    table = [(*key, *cells) for key, cells in rows.items()]
    return "\n".join([*_wrapped(words), "", tabulate(table, head, disable_numparse=True)])


INERTIA = np.array([5e-6, 2e-5, 5e-5, 1e-4, 2e-4, 4e-4, 9.2e-4, 2e-3, 4e-3, 6e-3])
RADIUS = np.array([0.025, 0.0265, 0.030])
TRENDS = ("30a", "30b", "31a", "31b", "32a", "32b")


def possible(motor: ts.Motor) -> str:
    """Where each reading has Table 4's mean speed, what the encoder reads there, and which trends hold."""
    words = (
        "the friction coefficient at which v_s is 633 arcsec/s, at the least, the middle and the most of the assumed "
        "contact radii (25, 26.5, 30 mm), default level, A at its crest; sigma_s is the encoder's there, at 26.5 mm or "
        "else the nearest; within: by how much friction may be off for 5 % of 633; trends: those of Figs. 30 to 32 "
        "that step as their determinants do.  Left out are inertias at which no friction from 0.2 to 0.3 gives it."
    )
    table = []
    for start, lead in product(STARTS, LEADS):
        found = region(motor, start, lead, 0.0, INERTIA, RADIUS)
        for i, inertia in enumerate(INERTIA):
            there = np.flatnonzero(np.isfinite(found.friction[:, i]))
            if there.size:
                k = there[np.abs(RADIUS[there] - 0.0265).argmin()]
                frictions = " ".join("-" if np.isnan(f) else f"{f:.4f}" for f in found.friction[:, i])
                trends_there = " ".join(name for name, holds in zip(TRENDS, found.steps[:, k, i], strict=True) if holds)
                table.append(
                    (
                        f"{start} {lead:+.0f}",
                        f"{inertia:.1e}",
                        frictions,
                        f"{100 * found.width[k, i]:.1g} %",
                        f"{100 * found.volatility[k, i]:.3g}",
                        trends_there or "none",
                    )
                )
    head = ("reading", "J kg m^2", "friction at 25, 26.5, 30 mm", "within", "sigma_s %", "trends")
    return "\n".join([*_wrapped(words), "", tabulate(table, head, disable_numparse=True)])


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


def text(motor: ts.Motor, found: Readings, judged: list[Claim], followed_from: list[Trend]) -> str:
    """All of it."""
    parts = (
        summary(found, judged),
        phases(motor),
        by_inertia(judged),
        followed(followed_from),
        possible(motor),
        listed(judged),
    )
    return "\n\n".join(parts)


def main() -> None:
    """Print it."""
    motor = ts.load_motor("trum60")
    found = readings(motor)
    print(text(motor, found, claims(motor, found), trends(Context(motor, found))))


if __name__ == "__main__":
    main()
