"""docs/article.md: a draft of the replication article, from the ledger's records and the pages that tests hold true."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from derivations.ledger.second_opinion import SAMPLED
from trum_sym.paper.ledger import SEVERITIES, VERDICTS

__all__ = ["REPLICATION", "claims_line", "label", "page", "rows"]

DOCS = Path(__file__).parents[2] / "docs"
Record = dict[str, Any]
REPLICATION = "[¬Re]"
"""ReScience's mark of a replication that does not reproduce the original's central figures."""


def label(record: Record) -> str:
    """A link to an entry of the ledger's page."""
    name = record["id"]
    numbered = name.removeprefix("A").isdigit()
    return f"[{f'({name})' if numbered else name}](../generated/ledger.html#{f'eq-{name}' if numbered else name})"


def _plain(text: str) -> str:
    """A sentence for a cell of a table."""
    return " ".join(text.replace("|", r"\|").replace("*", r"\*").split())


def rows(head: Sequence[str], body: Iterable[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(_plain(cell) for cell in row) + " |" for row in body]


def _numbered(records: Iterable[Record]) -> list[Record]:
    return [r for r in records if r["id"].removeprefix("A").isdigit()]


def _shown(document: str, marker: str) -> str:
    """What a page shows of a command's output."""
    text = (DOCS / document).read_text("utf-8")
    found = re.search(rf"<!-- {re.escape(marker)} -->\n```\n(.*?)```", text, re.DOTALL)
    if found is None:
        raise LookupError(f"docs/{document} shows nothing of {marker}")
    return found[1].rstrip()


def claims_line() -> str:
    """How many of the paper's claims hold, as ``examples/claims.py`` prints it."""
    (line,) = re.findall(r"^\d+ claims: .*$", _shown("claims.md", "examples/claims.py"), re.MULTILINE)
    return str(line)


def _abstract(records: list[Record]) -> str:
    numbered = _numbered(records)
    verdicts = Counter(r["verdict"] for r in numbered)
    severities = Counter(r["severity"] for r in numbered)
    doubtful = sum(r["copy"] == "doubtful" for r in numbered)
    listed = ", ".join(f"{severities[s]} {s}" for s in SEVERITIES)
    return (
        f"We derive each of the paper's {len(numbered)} numbered equations from first principles and hold the print "
        f"against "
        f"it: {verdicts['verified']} are verified, {verdicts['approximation']} are approximations within a fifth, "
        f"{verdicts['erratum']} are errata ({listed}), {verdicts['definition']} are definitions, "
        f"{verdicts['empirical']} is "
        f"empirical and {verdicts['reconstructed']} is lost and reconstructed. At {doubtful} of them the copy of the "
        f"text "
        "may have lost a sign, and both outcomes are given. The model as printed does not give the published speed and "
        "volatility determinants in the state that a running motor is in; of the readings that the text leaves open "
        "some "
        f"do. Of the paper's statements in words: {claims_line()}."
    )


def _methods(records: list[Record]) -> list[str]:
    kinds = Counter(e["kind"] for r in records for e in r["evidence"])
    second = [r["second_opinion"] for r in records]
    both = sum(s["confirmed_by"] == ["SymPy", "Maxima"] for s in second)
    methods = Counter(f["method"] for s in second for found in s["findings"].values() for f in found)
    for_a_form = [f for s in second for found in s["findings"].values() for f in found if f["ok"]]
    sampled = sum(bool(SAMPLED.search(f["method"])) for f in for_a_form)
    steps = [s for r in records for s in r["steps"]]
    return [
        "## Methods",
        "",
        f"The ledger holds {len(records)} entries: the numbered equations, the definitions between them, tables and "
        f"statements. Each has a derivation in steps, {len(steps)} in all, of which "
        f"{sum(bool(s['holds']) for s in steps)} "
        "are checked by machine and the others are premises, and a judge that takes any form and yields evidence for "
        "or "
        "against it: "
        + ", ".join(f"{count} times {kind.replace('_', ' ')}" for kind, count in kinds.most_common())
        + ". An erratum counts only if the print fails by exactly the kinds of evidence that are stated, and both "
        "the derived "
        "form and the print after the stated correction pass.",
        "",
        f"A second computer algebra system, Maxima, derives what must hold on its own and confirms {both} entries, in "
        f"{methods.total()} findings: {len(for_a_form)} for a form, {sampled} of these at sampled points or states "
        f"and the "
        f"others exact, and {methods.total() - len(for_a_form)} against a print. The algebraic core carries "
        f"certificates "
        "that a checker replays in exact fractions ([certificates](certificates.md)).",
        "",
        "Every small slip that happens in print is made once in every form that stands, and in the print of every "
        "erratum:",
        "",
        "```",
        _shown("ledger.md", "python -m derivations verify --mutants"),
        "```",
    ]


def _errata(records: list[Record]) -> list[str]:
    lines = ["### Errata", ""]
    for severity in SEVERITIES:
        chosen = [r for r in records if r["severity"] == severity]
        lines += [f"**{severity.capitalize()}** ({len(chosen)}).", ""]
        size = {r["id"]: "" if r["size"] is None else f"{100 * r['size']:.3g} %" for r in chosen}
        lines += rows(
            ("where", "what", "off by", "why"), ((label(r), r["title"], size[r["id"]], r["reason"]) for r in chosen)
        )
        lines.append("")
    return lines


def _results(records: list[Record]) -> list[str]:
    numbered = _numbered(records)
    counts = [
        (v, str(sum(r["verdict"] == v for r in records)), str(sum(r["verdict"] == v for r in numbered)))
        for v in VERDICTS
    ]
    approximations = [r for r in records if r["verdict"] == "approximation"]
    missing = [r for r in records if r["verdict"] == "reconstructed"]
    readings = [(label(r), o["what"], o["verdict"]) for r in records for o in r["other_readings"]]
    return [
        "## Results",
        "",
        *rows(("verdict", "entries", f"of the {len(numbered)}"), counts),
        "",
        *_errata(records),
        "### Approximations",
        "",
        *rows(("where", "what", "why"), ((label(r), r["title"], r["reason"]) for r in approximations)),
        "",
        "### Reconstructed",
        "",
        *rows(("where", "what", "why"), ((label(r), r["title"], r["reason"]) for r in missing)),
        "",
        "### What a doubtful copy may have lost",
        "",
        *rows(("where", "read otherwise", "verdict then"), readings),
        "",
        "### What it does to the motor",
        "",
        "Each entry's effect at the operating point of Table 3 stands in the ledger. Over all readings that the text "
        "allows, "
        f"with the claims that hold in each ([claims](claims.md)): {claims_line()}.",
        "",
    ]


def _assumptions(records: list[Record]) -> list[str]:
    found = {a["id"]: a for r in records for a in r["assumptions"]}
    body = ((a["title"], a["taken"], ", ".join(a["about"])) for _, a in sorted(found.items()))
    return [
        "## What is assumed",
        "",
        *rows(("what", "taken", "bears on"), body),
        "",
        "What each alternative changes: [assumptions](assumptions.md); what is outside of the model, and how to "
        "check all "
        "of this in five minutes: [for the referee](referee.md).",
        "",
    ]


def page(records: list[Record]) -> str:
    """The article, in the order of ReScience's template."""
    lines = [
        f"# {REPLICATION} Low-speed driving model of an ultrasonic motor based on beat travelling wave theory",
        "",
        "A draft, written by `python -m derivations verify --write` from the ledger's data; its words are few, its "
        "figures "
        "come from runs.",
        "",
        "* Original: *Research on Low-Speed Driving Model of Ultrasonic Motor Based on Beat Traveling Wave Theory*, "
        "Actuators "
        "2021, 10(11), 304",
        f"* Type: {REPLICATION}, a replication of the computations from the text alone, without the original's code, "
        f"data or "
        "supplement",
        "* Code: this repository, MIT licence; language Python and C; cite by `CITATION.cff`",
        "* Keywords: ultrasonic motor, travelling wave, beat, replication, errata, computer algebra",
        "",
        "## Abstract",
        "",
        _abstract(records),
        "",
        "## Introduction",
        "",
        "The paper proposes to drive a travelling-wave motor at very low speed by switching its two phases off and "
        "on in turn, "
        "models the beat that this makes, and introduces two determinants that are to predict the rotor's speed and "
        "its "
        "volatility. It was published without code, and its electronic supplement, which defines the amplitudes of "
        "the second "
        "half of its derivation, is not at hand. A reader who wants to use the model has to know which of its "
        "equations hold.",
        "",
        *_methods(records),
        "",
        *_results(records),
        *_assumptions(records),
        "## Conclusion",
        "",
        f"{REPLICATION}: the published figures follow from the printed equations neither as they stand nor put right "
        f"in the state "
        "of a running motor; the method itself, that switched phases beat and the rotor follows the beat's "
        "direction, does "
        "follow. What holds under which reading is said claim by claim.",
    ]
    return "\n".join(lines) + "\n"
