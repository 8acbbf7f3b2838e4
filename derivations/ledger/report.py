"""The ledger as data: records for JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy as sp

from derivations.ledger.assumptions import assumptions_of
from derivations.ledger.conditions import effect_at
from derivations.ledger.model import Evidence, Forms, Result
from derivations.ledger.referee import Review
from derivations.ledger.second_opinion import as_record, stale
from derivations.ledger.terminal import picture
from derivations.nomenclature import NOMENCLATURE, latex

__all__ = ["forms_latex", "record"]


def _form_latex(name: str, form: sp.Basic) -> str:
    if isinstance(form, sp.core.relational.Relational) or form in (sp.true, sp.false):
        return latex(form)
    first = name.split("_")[0]
    word = len(first) >= 4 and first.isalpha() and sp.latex(sp.Symbol(first)) == first  # share_redu; omega_p is none
    left = rf"\mathrm{{{name.replace('_', ' ')}}}".replace(" ", r"\ ") if word else latex(sp.Symbol(name))
    return f"{NOMENCLATURE[name].latex if name in NOMENCLATURE else left} = {latex(form)}"


def forms_latex(forms: Forms) -> list[str]:
    """One formula per form; a named expression is written as an equation."""
    return [_form_latex(name, form) for name, form in forms.items()]


def _pictures(forms: Forms) -> list[dict[str, Any]]:
    return [picture(name, form) for name, form in forms.items()]


def _evidence(found: Iterable[Evidence], about: str) -> list[dict[str, Any]]:
    return [{"about": about, "kind": e.kind, "ok": e.ok, "detail": e.detail} for e in found]


def record(result: Result, review: Review) -> dict[str, Any]:
    """What ``verify --json`` and ledger.json say of an entry, and its formulas as pictures for a terminal."""
    entry, weight, problems = result.entry, review.severity, [*result.problems, *review.problems]
    outdated = stale(entry, result.derivation.forms)
    problems += [outdated] if outdated else []
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
        "effect_at": effect_at(entry.id, result.effect),
        "effect_figures": [figure.printed for figure in result.figures],
        "assumptions": assumptions_of(entry.id),
        "place": entry.place,
        "found_by": list(entry.found_by),
        "confirmed": not problems,
        "second_opinion": as_record(entry),
        "problems": problems,
        "severity": weight.word if weight else None,
        "severity_detail": weight.why if weight else None,
        "size": float(f"{weight.size:.3g}") if weight and weight.size is not None else None,
        "conditional": review.conditional,
        "copy": review.copy.word,
        "copy_doubt": review.copy.doubt or None,
        "copy_lines": list(review.copy.lines),
        "other_readings": [{"what": r.what, "verdict": r.verdict, "detail": r.detail} for r in review.readings],
        "evidence": _evidence(result.printed, "printed") + _evidence(result.corrected, about),
        "steps": [
            {"text": s.text, "latex": [latex(shown) for shown in s.shows], "holds": s.holds}
            for s in result.derivation.steps
        ],
        "pictures": {
            "printed": _pictures(entry.printed),
            "derived": _pictures(result.derivation.forms),
            "steps": [[picture("", shown) for shown in s.shows] for s in result.derivation.steps],
        },
    }
