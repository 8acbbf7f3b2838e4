"""The ledger of equations as pages of the site: one an entry, made of ``generated/``."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from docs.site import kernels

__all__ = ["anchor", "pages"]

Record = dict[str, Any]
_MARKS = {None: "", True: " ✓", False: " ✗"}
_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|$~^])")
_SECTIONS = {"A": "Appendix A", "B": "Appendix B", "C": "Appendix C"}


def anchor(name: str) -> str:
    """The page of an entry: eq-6, eq-A13, or the word itself."""
    return f"eq-{name}" if name.removeprefix("A").isdigit() else re.sub(r"[^\w-]", "", name)


def _label(name: str) -> str:
    return f"({name})" if name.removeprefix("A").isdigit() else name


def _prose(text: str) -> str:
    """Text in which nothing is Markdown's."""
    return _SPECIAL.sub(r"\\\1", text)


def _formulas(formulas: list[str] | None, indent: str = "") -> str:
    """Each formula as a block."""
    return "".join(f"\n{indent}:::{{math}}\n{indent}{formula}\n{indent}:::\n" for formula in formulas or ())


def _evidence(found: list[dict[str, Any]]) -> str:
    rows = (
        f"- {'✓' if e['ok'] else '✗'} {_prose(e['about'])}, **{e['kind'].replace('_', ' ')}**: {_prose(e['detail'])}"
        for e in found
    )
    return "\n".join(rows) + "\n"


def _second(r: Record) -> list[dict[str, Any]]:
    """What the second algebra system found, in the form of evidence."""
    words = {"printed": "printed", "standing": "reconstructed" if r["verdict"] == "reconstructed" else "put right"}
    return [
        {"ok": f["ok"], "about": words[part], "kind": "Maxima", "detail": f"{f['detail']} ({f['method']})"}
        for part, findings in r["second_opinion"]["findings"].items()
        for f in findings
    ]


def _verdict(r: Record) -> list[str]:
    """The verdict, how bad it is, how sure, and who says so."""
    lines = [f"**{r['verdict'].capitalize()}**{', ' + r['severity'] if r['severity'] else ''}: {_prose(r['reason'])}"]
    if r["severity"]:
        lines.append(f"Severity: {_prose(r['severity_detail'])}.")
    elif r["conditional"]:
        lines.append("Conditional: judged against the reconstruction of the supplement that the paper lacks.")
    if r["found_by"]:
        lines.append(f"Found by {', '.join(r['found_by']).replace('_', ' ')}.")
    if r["copy"] == "doubtful":
        lines.append(f"The copy of the text may have lost a sign: {_prose(r['copy_doubt'])}.")
        lines += [f"- {_prose(o['what'])}: **{o['verdict']}**; {_prose(o['detail'])}" for o in r["other_readings"]]
    second = r["second_opinion"]
    systems = ", ".join(second["confirmed_by"]) if r["confirmed"] else "nobody"
    means = second["undecided"] or "; ".join(second["methods"])
    lines.append(f"Confirmed by {systems}{' (' + _prose(means) + ')' if means else ''}.")
    return lines


def _page(r: Record, picture: str, used: list[kernels.Kernel]) -> str:
    """The page of one entry."""
    corrected = {"erratum": "Put right", "reconstructed": "Reconstructed"}.get(r["verdict"], "Derived")
    at = r["effect_at"] or {}
    conditions = "; ".join(f"{key.replace('_', ' ')} {value}" for key, value in at.items())
    parts = [
        f"# {_label(r['id'])} {_prose(r['title'])}",
        f"{_prose(r['place'])} of the paper; [all entries](index.md).",
        "\n\n".join(_verdict(r)),
        "## Printed",
        _formulas(r["printed_latex"]) or "Missing from the paper.",
        f"## {corrected}",
        _formulas(r["derived_latex"]) or "Nothing.",
        "## Effect",
        _prose(r["effect"]),
    ]
    parts += [f"Computed with {_prose(conditions)}."] if conditions else []
    parts += [f"```{{raw}} html\n<figure class='of-entry' tabindex='0'>{picture}</figure>\n```"] if picture else []
    steps = [f"1. {_prose(s['text'])}{_MARKS[s['holds']]}\n{_formulas(s['latex'], '   ')}" for s in r["steps"]]
    parts += ["## Derivation", "A tick marks a step that is checked by machine.", "\n".join(steps)]
    parts += ["## Evidence", _evidence([*r["evidence"], *_second(r)])]
    if r["assumptions"]:
        named = "\n".join(f"- {_prose(a['taken'])}" for a in r["assumptions"])
        parts += ["## Assumed", f"{named}\n\nWhat changes if it is otherwise: [assumptions](../assumptions.md)."]
    parts += ["## Kernels that use it"]
    rows = "\n".join(f"- [`{k.name}`](../kernels.md#{k.place}): {_prose(k.title)}" for k in used)
    parts.append(rows or "No kernel is made of it by itself.")
    return "\n\n".join(parts) + "\n"


class _Figures(HTMLParser):
    """The drawings on the ledger's own page, by the entry that they are in."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text, self.found, self._entry, self._from = text, dict[str, str](), "", 0
        self._lines = [0]
        for line in text.splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))
        self.feed(text)

    def _here(self) -> int:
        line, column = self.getpos()
        return self._lines[line - 1] + column

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Where an entry or a drawing begins."""
        if tag == "article":
            self._entry = dict(attrs)["id"] or ""
        elif tag == "svg":
            self._from = self._here()

    def handle_endtag(self, tag: str) -> None:
        """Where a drawing ends."""
        if tag == "svg" and self._entry:
            self.found[self._entry] = self.text[self._from : self._here()] + "</svg>"


def _index(records: list[Record]) -> str:
    rows = [
        f"| [{_label(r['id'])}]({anchor(r['id'])}.md) | {_prose(r['title'])} | {r['verdict']} | {r['severity'] or ''} "
        f"| {_prose(r['place'])} |"
        for r in records
    ]
    table = "| entry | what it is | verdict | severity | place |\n|---|---|---|---|---|\n" + "\n".join(rows)
    tree = "\n".join(anchor(r["id"]) for r in records)
    return (
        "# Entries of the ledger\n\nEvery numbered equation of the paper, the definitions between them, its tables and "
        "statements: what is printed, what follows from first principles, the verdict, the evidence, what the "
        "difference does to TRUM-60 at Table 3's point, and the kernels that use it.  How it is judged: "
        f"[the ledger](../ledger.md).\n\n{table}\n\n```{{toctree}}\n:hidden:\n:maxdepth: 1\n\n{tree}\n```\n"
    )


def pages(root: Path) -> dict[str, str]:
    """The pages of all entries and their index, by path."""
    records: list[Record] = json.loads((root / "generated" / "ledger.json").read_text("utf-8"))
    drawings = _Figures((root / "generated" / "ledger.html").read_text("utf-8")).found
    listed = kernels.load(root)
    found = {"ledger/index.md": _index(records)}
    for r in records:
        used = [kernel for kernel in listed if r["id"] in kernel.equations]
        found[f"ledger/{anchor(r['id'])}.md"] = _page(r, drawings.get(anchor(r["id"]), ""), used)
    return found
