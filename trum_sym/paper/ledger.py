"""The ledger that ships with the package: every equation of the paper, printed and derived, with its verdict."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.output.text_table import text_table

__all__ = [
    "SEVERITIES",
    "VERDICTS",
    "counted",
    "filtered",
    "ledger_page",
    "ledger_path",
    "load_ledger",
    "load_pictures",
    "select",
    "table",
    "written_out",
]

Record = dict[str, Any]
VERDICTS = ("verified", "approximation", "erratum", "definition", "reconstructed", "empirical")
SEVERITIES = ("typographical", "conditional", "quantitative", "structural")
"""Of an erratum: no figure changes; judged against a reconstruction; a figure changes; no repair by a symbol."""
_PLACES = (
    Path(__file__).parents[1] / "data",  # in an installed package
    Path(__file__).parents[2] / "generated",  # in a source tree
)


def _place(name: str) -> Path:
    for folder in _PLACES:
        if (folder / name).is_file():
            return folder / name
    raise FileNotFoundError(f"no {name} in {' or '.join(str(folder) for folder in _PLACES)}")


def _read(name: str) -> str:
    return _place(name).read_text("utf-8")


def ledger_path() -> Path:
    """Where the ledger's page lies."""
    return _place("ledger.html")


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


def filtered(records: list[Record], *, verdict: str | None = None, severity: str | None = None) -> list[Record]:
    """The records of a verdict, of errata of a severity, or of both; all of them without either.

    Raises
    ------
    ParameterError
        For a verdict or severity that there is not.

    Examples
    --------
    >>> {r["verdict"] for r in filtered(load_ledger(), severity="structural")}
    {'erratum'}
    """
    for name, value, allowed in (("verdict", verdict, VERDICTS), ("severity", severity, SEVERITIES)):
        if value is not None and value not in allowed:
            raise ParameterError(name, value, f"one of {', '.join(allowed)}")
    return [
        r
        for r in records
        if (verdict is None or r["verdict"] == verdict) and (severity is None or r["severity"] == severity)
    ]


def counted(records: list[Record]) -> str:
    """How many errata there are of each severity, and how sure the copies of the paper's text are, in a line each."""
    by_severity = [(word, sum(r["severity"] == word for r in records)) for word in SEVERITIES]
    by_copy = [(word, sum(r["copy"] == word for r in records)) for word in ("clear", "doubtful", "missing")]
    errata = sum(count for _, count in by_severity)
    return "\n".join(
        (
            f"{errata} errata: {', '.join(f'{count} {word}' for word, count in by_severity)}",
            f"copy of the paper's text: {', '.join(f'{count} {word}' for word, count in by_copy)}",
        )
    )


def table(records: list[Record]) -> str:
    """One line per entry: id, title, verdict, how bad, how sure, whether confirmed, and by which kinds of evidence."""
    rows = []
    for r in records:
        kinds = dict.fromkeys(e["kind"] for e in r["evidence"])
        state = "confirmed" if r["confirmed"] else "NOT CONFIRMED"
        rows.append((r["id"], r["title"], r["verdict"], r["severity"] or "", r["copy"], state, ", ".join(kinds)))
    headers = ("id", "title", "verdict", "severity", "copy", "", "evidence")
    return text_table(rows, headers)


_MARKS = {None: "premise", True: "checked", False: "DOES NOT HOLD"}


def _systems(record: Record) -> str:
    """The algebra systems that confirm a verdict, with the second one's means or why it was not asked."""
    second = record["second_opinion"]
    systems = ", ".join(second["confirmed_by"]) if record["confirmed"] else "nobody"
    means = second["undecided"] or "; ".join(second["methods"])
    return f"{systems} ({means})" if means else systems


def load_pictures(equation: str) -> dict[str, Any]:
    """The formulas of an entry as pictures of characters, which :mod:`trum_sym.paper.terminal` lays out."""
    found: dict[str, Any] = json.loads(_read("ledger.pictures.json"))[equation]
    return found


def written_out(record: Record, pictures: dict[str, Any], width: int | None = None) -> str:
    """One entry: printed, derivation step by step, derived, evidence, effect; formulas as pictures of characters.

    Parameters
    ----------
    record : dict
        Of :func:`load_ledger`.
    pictures : dict
        Of :func:`load_pictures`.
    width : int, optional
        Columns; the terminal's if not given.  At least 60.
    """
    import shutil

    columns = max(60, shutil.get_terminal_size().columns if width is None else width)
    r = record
    lines = [f"({r['id']}) {r['title']}  [{r['place']}]", f"verdict: {r['verdict']}. {r['reason']}", "", "printed"]
    lines += _formulas(pictures["printed"], columns) or ["    nothing: missing from the paper"]
    lines += ["", f"copy of the paper's text: {r['copy']}{': ' + r['copy_doubt'] if r['copy_doubt'] else ''}"]
    lines += [f"    {o['what']}: {o['verdict']}; {o['detail']}" for o in r["other_readings"]]
    if r["severity"]:
        lines.append(f"severity: {r['severity']}; {r['severity_detail']}")
    elif r["conditional"]:
        lines.append("conditional: judged against the reconstruction of the supplement that the paper lacks")
    lines += ["", "derivation"]
    for number, (s, shown) in enumerate(zip(r["steps"], pictures["steps"], strict=True), 1):
        lines.append(f"{number:3}. {s['text']} [{_MARKS[s['holds']]}]")
        lines += _formulas(shown, columns, 8)
    lines += ["", "derived", *_formulas(pictures["derived"], columns), "", "evidence"]
    for e in r["evidence"]:
        lines.append(f"    {'for    ' if e['ok'] else 'against'} {e['about']:<9} {e['kind']}: {e['detail']}")
    lines += ["", f"confirmed by: {_systems(r)}"]
    lines += ["", f"effect: {r['effect']}"]
    if r["effect_at"]:
        listed = ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in r["effect_at"].items())
        lines.append(f"computed with: {listed}")
    lines += [f"assumed: {a['taken']}" for a in r["assumptions"]]
    lines += [f"NOT CONFIRMED: {problem}" for problem in r["problems"]]
    return "\n".join(part for line in lines for part in _wrapped(line, columns))


def _formulas(pictures: list[dict[str, Any]], width: int, indent: int = 4) -> list[str]:
    """Formulas one below the other, an empty line round those that are taller than one."""
    from trum_sym.paper.terminal import laid_out

    found: list[str] = []
    tall = False
    for picture in pictures:
        rows = laid_out(picture, width - indent)
        apart = bool(found) and (tall or len(rows) > 1)
        tall = len(rows) > 1
        found += [""] * apart + [(" " * indent + row).rstrip() for row in rows]
    return found


def _wrapped(line: str, width: int) -> list[str]:
    """A line of words within the width, its continuation indented; what fits, pictures among it, as it is."""
    import textwrap

    if len(line) <= width:
        return [line]
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    return textwrap.wrap(line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
