"""The ledger that ships with the package: every equation of the paper, printed and derived, with its verdict."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from trum_sym.errors import ParameterError

__all__ = ["ledger_page", "load_ledger", "select", "table", "written_out"]

Record = dict[str, Any]
_PLACES = (
    Path(__file__).parents[1] / "data",  # in an installed package
    Path(__file__).parents[2] / "generated",  # in a source tree
)


def _read(name: str) -> str:
    for folder in _PLACES:
        if (folder / name).is_file():
            return (folder / name).read_text("utf-8")
    raise FileNotFoundError(f"no {name} in {' or '.join(str(folder) for folder in _PLACES)}")


def ledger_page() -> str:
    """The ledger as one HTML page, as ``python -m derivations verify --write`` made it."""
    return _read("ledger.html")


def load_ledger() -> list[Record]:
    """All records, in the order of the paper; keys as ``python -m derivations verify --json`` writes them."""
    records: list[Record] = json.loads(_read("ledger.json"))
    return records


def select(records: list[Record], equation: str) -> Record:
    """The record of an equation, "6", "(6)" or "A13"; a ParameterError for an unknown one."""
    name = equation.strip().strip("()")
    for record in records:
        if record["id"].lower() == name.lower():
            return record
    others = ", ".join(r["id"] for r in records if not r["id"].removeprefix("A").isdigit())
    raise ParameterError("equation", equation, f"1 to 45, A1 to A17, or one of {others}")


def table(records: list[Record]) -> str:
    """One line per entry: id, title, verdict, whether it is confirmed, and by which kinds of evidence."""
    from tabulate import tabulate

    rows = []
    for r in records:
        kinds = dict.fromkeys(e["kind"] for e in r["evidence"])
        state = "confirmed" if r["confirmed"] else "NOT CONFIRMED"
        rows.append((r["id"], r["title"], r["verdict"], state, ", ".join(kinds)))
    return str(tabulate(rows, headers=("id", "title", "verdict", "", "evidence"), disable_numparse=True))


_MARKS = {None: "premise", True: "checked", False: "DOES NOT HOLD"}


def written_out(record: Record) -> str:
    """One entry: printed, derivation step by step, derived, evidence, effect; formulas in LaTeX."""
    r = record
    lines = [f"({r['id']}) {r['title']}  [{r['place']}]", f"verdict: {r['verdict']}. {r['reason']}", "", "printed"]
    lines += [f"    {formula}" for formula in r["printed_latex"] or ["nothing: missing from the paper"]]
    lines += ["", "derivation"]
    for number, s in enumerate(r["steps"], 1):
        lines.append(f"{number:3}. {s['text']} [{_MARKS[s['holds']]}]")
        lines += [f"        {formula}" for formula in s["latex"]]
    lines += ["", "derived"] + [f"    {formula}" for formula in r["derived_latex"] or []] + ["", "evidence"]
    for e in r["evidence"]:
        lines.append(f"    {'for    ' if e['ok'] else 'against'} {e['about']:<9} {e['kind']}: {e['detail']}")
    lines += ["", f"effect: {r['effect']}"]
    lines += [f"NOT CONFIRMED: {problem}" for problem in r["problems"]]
    return "\n".join(lines)
