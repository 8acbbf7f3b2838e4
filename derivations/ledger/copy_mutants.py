"""One character changed in either transcription, to see whether the comparison notices.

In the second one a character of a quoted line or of its notation; in the first one a character of the source that
makes the printed forms, which is then run again.  White space, comments, annotations and the lines that give symbols
their Python names are left alone, and a change that leaves every form as it was (another way to write the same) is
drawn again: neither changes what is transcribed.
"""

from __future__ import annotations

import ast
import importlib
import io
import random
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from derivations.ledger import ENTRIES
from derivations.ledger.model import Entry
from derivations.ledger.notation import lines
from derivations.ledger.transcription import Data, differences, load

__all__ = ["CopyMutant", "copy_mutants"]

_KINDS = ("abcdefghijklmnopqrstuvwxyz", "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "0123456789", "+-*/", "()[]{}", "<>=", "^_,.;\\|")


UNREADABLE = "not to be read"
"""An unknown name, a bracket without its partner: noticed by the reader, and too easy to count."""


@dataclass(frozen=True)
class CopyMutant:
    """Where a character was changed, what it was and is, and what noticed it ('' if nothing did)."""

    where: str
    old: str
    new: str
    noticed: str


def _other(draw: random.Random, char: str) -> str | None:
    """Another character of the same kind."""
    kind = next((kind for kind in _KINDS if char in kind), None)
    return draw.choice([c for c in kind if c != char]) if kind else None


def _kind_of(found: list[str]) -> str:
    first = found[0]
    if "not the one that was copied" in first:
        return "checksum"
    if "the quote" in first:
        return "quote against notation"
    return "tree" if "against" in first or " only" in first else UNREADABLE


# --- the second one -----------------------------------------------------------------------------------------
_BY_ID = {entry.id: entry for entry in ENTRIES}


def _same(one: Data, other: Data, name: str, index: int) -> bool:
    """Whether a notation says the same, but for white space."""
    texts = (data[name]["quote"][index]["forms"] for data in (one, other))
    said = [[(*line.sides, line.condition) for line in lines(text)] for text in texts]
    first, second = ([[part.replace(" ", "") for part in line] for line in found] for found in said)
    return first == second


def _of_second(draw: random.Random) -> CopyMutant | None:
    quotes = [(n, i) for n, block in load().items() for i, quote in enumerate(block["quote"]) if "forms" in quote]
    name, index = draw.choice(quotes)
    field = draw.choice(("text", "forms", "forms"))
    text = load()[name]["quote"][index][field]
    place = draw.randrange(len(text))
    new = _other(draw, text[place])
    if new is None:
        return None
    data: dict[str, Any] = deepcopy(dict(load()))
    data[name]["quote"][index][field] = text[:place] + new + text[place + 1 :]
    if field == "forms" and _same(load(), data, name, index):
        return None
    found = differences(_BY_ID[name], data)
    where = f"({name}) line {load()[name]['quote'][index]['line']}, {'quote' if field == 'text' else 'notation'}"
    return CopyMutant(where, text[place], new, _kind_of(found) if found else "")


# --- the first one ------------------------------------------------------------------------------------------
def _modules() -> list[str]:
    """Modules of the ledger with printed forms that are transcribed twice."""
    found = []
    for name, module in sorted(sys.modules.items()):
        entries = getattr(module, "ENTRIES", ())
        if name.startswith("derivations.ledger.") and any(e.id in load() and e.printed for e in entries):
            found.append(name)
    return found


def _makers(tree: ast.Module) -> list[ast.AST]:
    """The statements and expressions of a module that its printed forms are made of."""
    top: dict[str, ast.stmt] = {}
    for statement in tree.body:
        targets: list[ast.expr] = []
        if isinstance(statement, ast.Assign):
            targets = statement.targets
        elif isinstance(statement, ast.AnnAssign):
            targets = [statement.target]
        elif isinstance(statement, ast.FunctionDef):
            top[statement.name] = statement
        for target in targets:
            for node in ast.walk(target):
                if isinstance(node, ast.Name):
                    top[node.id] = statement
    todo: list[ast.AST] = [
        k.value for n in ast.walk(tree) if isinstance(n, ast.Call) for k in n.keywords if k.arg == "printed"
    ]
    found: dict[int, ast.AST] = {}
    while todo:
        node = todo.pop()
        for name in {n.id for n in ast.walk(node) if isinstance(n, ast.Name)} & top.keys():
            statement = top[name]
            if id(statement) not in found and not _gives_names(statement):
                found[id(statement)] = statement
                todo.append(statement)
    return list(found.values())


def _gives_names(statement: ast.stmt) -> bool:
    """Whether a statement only gives symbols their Python names."""
    calls = [n.func for n in ast.walk(statement) if isinstance(n, ast.Call)]
    names = {c.id for c in calls if isinstance(c, ast.Name)} | {c.attr for c in calls if isinstance(c, ast.Attribute)}
    return bool(names) and names <= {"sym", "symbols", "Symbol", "Function", "IndexedBase", "parse_unit", "items"}


@cache
def _source(name: str) -> tuple[str, list[int]]:
    """The source of a module, and the places in it at which a character may be changed."""
    path = Path(str(importlib.import_module(name).__file__))
    text = path.read_text("utf-8")
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    spans = []
    for node in _makers(ast.parse(text)):
        body = node.value if isinstance(node, ast.AnnAssign | ast.Assign) and node.value else node
        spans.append((body.lineno, body.end_lineno))  # type: ignore[attr-defined]
    places: list[int] = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        inside = any(first <= token.start[0] <= last for first, last in spans)
        if inside and token.type in (tokenize.NAME, tokenize.NUMBER, tokenize.OP):
            begin = starts[token.start[0] - 1] + token.start[1]
            places += range(begin, begin + len(token.string))
    return text, places


def _again(name: str, text: str) -> tuple[Entry, ...]:
    """The entries of a module run from another source."""
    module = ModuleType(name)
    module.__file__ = str(importlib.import_module(name).__file__)
    module.__package__ = "derivations.ledger"
    exec(compile(text, f"<{name}>", "exec"), module.__dict__)
    return tuple(module.ENTRIES)


def _of_first(draw: random.Random) -> CopyMutant | None:
    name = draw.choice(_modules())
    text, places = _source(name)
    if not places:
        return None
    place = draw.choice(places)
    new = _other(draw, text[place])
    if new is None:
        return None
    where = f"{name.rpartition('.')[2]}.py:{text.count(chr(10), 0, place) + 1}"
    try:
        entries = _again(name, text[:place] + new + text[place + 1 :])
    except Exception:  # whatever the changed source raises
        return CopyMutant(where, text[place], new, UNREADABLE)
    changed = [e for e in entries if e.id in load() and e.printed != _BY_ID[e.id].printed]
    if not changed:
        return None
    found = [line for e in changed for line in differences(e)]
    return CopyMutant(where, text[place], new, _kind_of(found) if found else "")


def copy_mutants(count: int = 200, seed: str = "one character") -> Iterator[CopyMutant]:
    """Characters changed in turn in the second and in the first, until so many of them can still be read."""
    draw, read, number = random.Random(seed), 0, 0
    while read < count:
        attempt = _of_first if number % 2 else _of_second
        found = None
        while found is None:
            found = attempt(draw)
        read += found.noticed != UNREADABLE
        number += found.noticed != UNREADABLE
        yield found


def tally(mutants: list[CopyMutant]) -> str:
    """How many were noticed, and by what; those that cannot even be read are counted apart."""
    kinds = Counter(m.noticed for m in mutants if m.noticed)
    broken = kinds.pop(UNREADABLE, 0)
    read = len(mutants) - broken
    by = ", ".join(f"{count} by {kind}" for kind, count in kinds.most_common())
    return (
        f"{read} characters changed in either transcription: {kinds.total()} noticed ({by}), {read - kinds.total()} "
        f"not; {broken} more cannot be read"
    )
