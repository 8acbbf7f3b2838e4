"""A certificate's statement, read from its data, and the page of all of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from derivations.ledger.html import anchor

__all__ = ["page", "sentence", "written"]


def written(terms: Mapping[str, str]) -> str:
    """A polynomial in words of mathematics, from its data."""
    parts = []
    for monomial, coefficient in terms.items():
        sign, size = ("-", coefficient[1:]) if coefficient.startswith("-") else ("+", coefficient)
        body = " ".join(part for part in (size if size != "1" or not monomial else "", monomial) if part)
        parts.append(f"{sign} {body}")
    text = " ".join(parts) or "0"
    return text.removeprefix("+ ") if text.startswith("+ ") else text.replace("- ", "-", 1)


def sentence(certificate: Mapping[str, Any]) -> list[str]:
    """What a certificate proves, read from its data alone."""
    lines = ["For all real numbers with"]
    lines += [f"    {written(terms)} = 0" for terms in certificate["given"]]
    lines += [f"    {written(terms)} > 0" for terms in certificate["positive"]]
    if certificate["rates"]:
        rates = ", ".join(f"{letter}' = {written(rate)}" for letter, rate in certificate["rates"].items())
        lines += [f"and the derivatives of the equations, {rates},"]
    lines += ["it follows that"]
    for claim in certificate["claims"]:
        if claim["goal"] == {"": "-1"}:
            lines.append(f"    there are no such numbers ({claim['name']})")
        else:
            relation = "> 0" if claim["equals"] else "= 0"
            lines.append(f"    {written(claim['goal'])} {relation} ({claim['name']})")
    return lines


def page(certificates: Iterable[Mapping[str, Any]], records: Iterable[Mapping[str, Any]]) -> str:
    """docs/certificates.md: each statement beside the paper's."""
    by_id = {record["id"]: record for record in records}
    lines = [
        "# Certificates of the algebraic core",
        "",
        "Each certificate is a file in `derivations/certificates/data/` that says what is given, what follows, and the",
        "multipliers that prove it; a checker of some fifty lines replays it in exact fractions with Python's own "
        "library:",
        "",
        "    python derivations/certificates/checker.py derivations/certificates/data/*.json",
        "",
        "What is proved is printed below from the certificate's data, not from what it was made of, beside the paper's",
        "formulas.  `python -m derivations certificates` replays all, and holds what is given and every claim "
        "against the",
        "ledger's own formulas in the letters' places: a certificate that proves something else is refused.",
        "Lean would have been the stronger form; its toolchain was looked for in Debian, PyPI and npm and is in none.",
    ]
    for certificate in certificates:
        about = [by_id[name] for name in certificate["about"]]
        links = ", ".join(f"[{r['id']}](../generated/ledger.html#{anchor(r['id'])})" for r in about)
        lines += ["", f"## {certificate['title']}", "", f"About {links}.", "", "| letter | stands for |", "|---|---|"]
        lines += [f"| {letter} | `{meaning}` |" for letter, meaning in certificate["letters"].items()]
        lines += [
            f"| {letter} | the ledger's form `{name}` of ({identifier}) |"
            for letter, (identifier, name) in certificate["forms"].items()
        ]
        lines += ["", "```", *sentence(certificate), "```", ""]
        lines += [f"* {claim['name']}: {claim['says']}." for claim in certificate["claims"]]
        lines += ["", "In the paper:", ""]
        for record in about:
            for formula in record["printed_latex"] or ():
                lines.append(f"* ({record['id']}), {record['verdict']}: $`{formula}`$")
    return "\n".join(lines) + "\n"
