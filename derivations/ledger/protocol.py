"""docs/referee.md: what an outside checker needs on one page, from the ledger's records."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from derivations.ledger.article import REPLICATION, Record, claims_line, label, rows
from derivations.ledger.second_opinion import ASKED
from trum_sym.paper.ledger import SEVERITIES

__all__ = ["PREMISES", "page"]

PREMISES: tuple[tuple[str, tuple[str, ...], str], ...] = (
    (
        "Isotropic layers; one beam around the ring, no twist and no curvature",
        ("2", "3", "6", "table-1-isotropy"),
        "the resonance; the table's own moduli contradict each other, see the effect of table-1-isotropy",
    ),
    (
        "A rigid rotor under a constant prepressure, which does not move up and down",
        ("31", "32", "38", "claim-contact"),
        "contact and friction; a rotor with axial inertia would leave the wave at 40 kHz and is not computed",
    ),
    (
        "No stick: every element of the contact slides, with one coefficient of friction at all speeds",
        ("36", "37", "38", "rotor-orbit"),
        "the rotor's speed and its swing, not the determinants; the coefficient is varied in docs/tolerance.md and "
        "in the "
        "claims, a friction that depends on speed is not computed",
    ),
    (
        "A load that is a torque, a plate's inertia or a weight on a string that does not give",
        ("38", "load-inertia"),
        "the rotor's swing and, through it, its mean speed; a slack string is named, its motion not computed",
    ),
    (
        "A prescribed wave: the rotor does not act back on the phases",
        ("8", "9", "10", "11", "wave-reaction"),
        "amplitude and direction of the wave; the mean effect of the prepressure is in eqs. 6 and 8, none within a "
        "cycle; for the plain wave the level coupling = contact computes it (docs/coupling.md)",
    ),
    (
        "No temperature, wear or humidity",
        ("6", "8"),
        "the resonance, to which a drive 3000 Hz above it is the less sensitive the further it is; not computed",
    ),
    (
        "Phases switched at whole drive periods, in no time and without electrical transients",
        ("10", "14", "45", "electrical-port"),
        "the start of each region; open or shorted electrodes are estimated in docs/assumptions.md, what a steady wave "
        "draws is computed (docs/coupling.md)",
    ),
)
"""Premises of the model itself that no level varies: what, the entries that rest on it, and how far it reaches."""


def _reach(assumption: dict[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    """Per reading: the ranges over which determinants and mean speed go with the alternatives."""
    outcomes = assumption["outcomes"]
    for reading in dict.fromkeys(o["reading"] for o in outcomes):
        chosen = [o for o in outcomes if o["reading"] == reading]

        def span(key: str, chosen: list[dict[str, str]] = chosen) -> str:
            numbers = sorted((o[key] for o in chosen), key=float)
            return numbers[0] if numbers[0] == numbers[-1] else f"{numbers[0]} to {numbers[-1]}"

        yield reading, span("q_average"), span("q_volatility"), span("mean_speed")


def _assumptions(records: list[Record]) -> list[str]:
    found = {a["id"]: a for r in records for a in r["assumptions"]}
    body = []
    for assumption in found.values():
        reach = list(_reach(assumption)) or [("estimated only", "", "", "")]
        for index, (reading, average, volatility, speed) in enumerate(reach):
            first = (assumption["title"], ", ".join(assumption["about"])) if index == 0 else ("", "")
            body.append((*first, reading, average, volatility, speed))
    return rows(("assumption", "bears on", "reading", "Q_aver, 1/s", "Q_vib, 1/s", "mean speed, rad/s"), body)


def page(records: list[Record]) -> str:
    """The page, written by ``verify --write``."""
    by_id = {r["id"]: r for r in records}
    by_severity = Counter(r["severity"] for r in records if r["severity"])
    both = sum(r["second_opinion"]["confirmed_by"] == ["SymPy", "Maxima"] for r in records)
    undecided = [
        label(r) for r in records if r["second_opinion"]["confirmed_by"] == ["SymPy"] and r["verdict"] in ASKED
    ]
    saved = [(r, o) for r in records for o in r["other_readings"] if o["verdict"] != "erratum"]
    lines = [
        "# For the referee",
        "",
        "One page for whoever wants to check this from outside. Written by `python -m derivations verify --write`.",
        "",
        "## What kind of replication",
        "",
        f"{REPLICATION}, by ReScience's mark: the paper's equations were derived anew and computed without its code, "
        f"data or "
        "supplement, and its central figures, Table 4's determinants and speed, do not follow in the state of a "
        "motor that "
        f"keeps running. Statement by statement: {claims_line()}. The same in the order of an article: "
        "[article](article.md).",
        "",
        "## Check it in five minutes",
        "",
        "With Python 3.11 or newer, a C/C++ compiler and, for the fourth line, Maxima (`apt-get install maxima "
        "maxima-share`):",
        "",
        "    python3 -m venv .venv && .venv/bin/pip install -c requirements.lock -e '.[dev]'",
        "    .venv/bin/trum-sym equations                        # every verdict; --equation 24 writes one out",
        "    .venv/bin/python -m derivations verify --equation 6  # proves one again, step by step",
        "    .venv/bin/python -m derivations verify --second-opinion",
        "    .venv/bin/python derivations/certificates/checker.py derivations/certificates/data/*.json",
        "    .venv/bin/trum-sym evaluate                         # Table 3's point beside what the tables print",
        "",
        "Everything, in a few minutes more, with the outputs that `codecheck.yml` lists compared with those kept here:",
        "",
        "    .venv/bin/python -m derivations codecheck OUT",
        "",
        "To be convinced that the checks can say no: change a sign in a formula module of `derivations/` and run "
        "`generate`, "
        "or in a printed form of `derivations/ledger/` and run `verify`; `verify --mutants` and `verify "
        "--second-opinion "
        "--mutants` do so some thousand times.",
        "",
        "## Who confirms what",
        "",
        f"SymPy all {len(records)} entries, Maxima {both} of them; a definition follows from nothing and is not put "
        f"to it." + (f" It cannot decide {', '.join(undecided)}; why is on the ledger's page." if undecided else ""),
        "",
        "## What fails, and under which reading",
        "",
        *rows(
            ("errata", "entries", "which"),
            ((s, str(by_severity[s]), ", ".join(label(r) for r in records if r["severity"] == s)) for s in SEVERITIES),
        ),
        "",
        "No longer an erratum if the copy of the text has lost what is put back:",
        "",
        *rows(("where", "read", "then"), ((label(r), o["what"], o["verdict"]) for r, o in saved)),
        "",
        "Conditional on our reconstruction of the supplement: "
        + ", ".join(label(r) for r in records if r["conditional"])
        + ". Which start, phase lead and level meet Table 4, and which claims fail in all readings: "
        "[claims](claims.md).",
        "",
        "## What is assumed, and how far it reaches",
        "",
        "What the computations take where the paper is silent, with the range that the alternatives of each span at "
        "Table 3's "
        "point; value by value in [assumptions](assumptions.md):",
        "",
        *_assumptions(records),
        "",
        "What the model itself takes for granted, which no level varies:",
        "",
        *rows(
            ("premise", "rests on it", "reach"),
            ((what, ", ".join(label(by_id[name]) for name in names), reach) for what, names, reach in PREMISES),
        ),
    ]
    return "\n".join(lines) + "\n"
