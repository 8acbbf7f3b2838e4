"""The table of docs/proofs.md: every kernel's outputs, the ledger's entries they rest on, how they are proved."""

from __future__ import annotations

from derivations.codegen.kernels import kernels
from derivations.proofs import of_kernel
from derivations.proofs.tables import TABLES

__all__ = ["MARKS", "filled", "rests_on"]

MARKS = ("<!-- made by `python -m derivations verify --write` -->", "<!-- end of what is made -->")


def rests_on() -> set[str]:
    """Ids of all entries of the ledger that a proof names."""
    return {name for kernel in kernels() for proof in of_kernel(kernel.name) for name in proof.rests_on.split()}


def _names(names: tuple[str, ...]) -> str:
    shown = [f"`{name}`" for name in names]
    return ", ".join(shown) if len(shown) <= 6 else f"{', '.join(shown[:3])} ... {shown[-1]} ({len(shown)})"


def _table() -> str:
    lines = ["| kernel | outputs | rests on | what they are | proof | where |", "|---|---|---|---|---|---|"]
    for kernel in kernels():
        for index, proof in enumerate(of_kernel(kernel.name)):
            entries = ", ".join(f"({name})" if name.lstrip("A").isdigit() else name for name in proof.rests_on.split())
            first = f"`{kernel.name}`" if index == 0 else ""
            cells = (first, _names(proof.names), entries, proof.statement, proof.kind, proof.where)
            lines.append(f"| {' | '.join(cells)} |")
    count = sum(len(kernel.results) for kernel in kernels())
    lines += ["", f"{len(kernels())} kernels, {count} outputs.", "", "| table | what it is |", "|---|---|"]
    lines += [f"| `{table.name}` | {table.statement} |" for table in TABLES]
    return "\n".join(lines)


def filled(page: str) -> str:
    """A page with the table made anew between its marks.

    Raises
    ------
    ValueError
        If the page lacks the marks.
    """
    head, mark, rest = page.partition(MARKS[0])
    _, end, tail = rest.partition(MARKS[1])
    if not (mark and end):
        raise ValueError(f"the page lacks the marks {MARKS[0]} and {MARKS[1]}")
    return f"{head}{mark}\n\n{_table()}\n\n{end}{tail}"
