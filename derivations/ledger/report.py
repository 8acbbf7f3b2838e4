"""The ledger as data and as text: records for JSON, the table, one entry written out."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy as sp
from tabulate import tabulate

from derivations.ledger.model import Evidence, Forms, Result
from derivations.nomenclature import NOMENCLATURE, latex

__all__ = ["forms_latex", "record", "table", "written_out"]


def _form_latex(name: str, form: sp.Basic) -> str:
    if isinstance(form, sp.core.relational.Relational) or form in (sp.true, sp.false):
        return latex(form)
    left = NOMENCLATURE[name].latex if name in NOMENCLATURE else latex(sp.Symbol(name))
    return f"{left} = {latex(form)}"


def forms_latex(forms: Forms) -> list[str]:
    """One formula per form; a named expression is written as an equation."""
    return [_form_latex(name, form) for name, form in forms.items()]


def _evidence(found: Iterable[Evidence], about: str) -> list[dict[str, Any]]:
    return [{"about": about, "kind": e.kind, "ok": e.ok, "detail": e.detail} for e in found]


def record(result: Result) -> dict[str, Any]:
    """What ``verify --json`` and ledger.json say of an entry."""
    entry = result.entry
    about = "reconstructed" if entry.verdict == "reconstructed" else "corrected"
    return {
        "id": entry.id,
        "section": entry.section,
        "title": entry.title,
        "verdict": entry.verdict,
        "reason": entry.reason,
        "printed_latex": forms_latex(entry.printed) or None,
        "derived_latex": forms_latex(result.derivation.forms) or None,
        "dimension_ok": result.dimension_ok,
        "effect": result.effect,
        "place": entry.place,
        "found_by": list(entry.found_by),
        "confirmed": result.confirmed,
        "problems": list(result.problems),
        "evidence": _evidence(result.printed, "printed") + _evidence(result.corrected, about),
        "steps": [
            {"text": s.text, "latex": [latex(shown) for shown in s.shows], "holds": s.holds}
            for s in result.derivation.steps
        ],
    }


def table(records: list[dict[str, Any]]) -> str:
    """One line per entry."""
    rows = []
    for r in records:
        printed = [e for e in r["evidence"] if e["ok"]]
        kinds = ", ".join(dict.fromkeys(e["kind"] for e in printed))
        rows.append((r["id"], r["title"], r["verdict"], "confirmed" if r["confirmed"] else "NOT CONFIRMED", kinds))
    return str(tabulate(rows, headers=("id", "title", "verdict", "", "evidence"), disable_numparse=True))


def written_out(r: dict[str, Any]) -> str:
    """One entry: printed, derivation step by step, derived, evidence, effect."""
    lines = [f"({r['id']}) {r['title']}  [{r['place']}]", f"verdict: {r['verdict']}. {r['reason']}", "", "printed"]
    lines += [f"    {formula}" for formula in r["printed_latex"] or ["nothing: missing from the paper"]]
    lines += ["", "derivation"]
    marks = {None: "premise", True: "checked", False: "DOES NOT HOLD"}
    for number, s in enumerate(r["steps"], 1):
        lines.append(f"{number:3}. {s['text']} [{marks[s['holds']]}]")
        lines += [f"        {formula}" for formula in s["latex"]]
    lines += ["", "derived"] + [f"    {formula}" for formula in r["derived_latex"] or []] + ["", "evidence"]
    for e in r["evidence"]:
        lines.append(f"    {'for    ' if e['ok'] else 'against'} {e['about']:<9} {e['kind']}: {e['detail']}")
    lines += ["", f"effect: {r['effect']}"]
    lines += [f"NOT CONFIRMED: {problem}" for problem in r["problems"]]
    return "\n".join(lines)
