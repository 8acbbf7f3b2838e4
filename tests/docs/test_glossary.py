"""The glossary's names exist in the source, its units are the kernels', its equations the paper's."""

from __future__ import annotations

import ast
import json
import re
from collections import Counter
from pathlib import Path

import pytest

from trum_sym.quantities import in_glossary

ROOT = Path(__file__).parents[2]
NAME = re.compile(r"`([^`]+)`")


def rows():
    text = (ROOT / "docs" / "glossary.md").read_text("utf-8")
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]
    return [row for row in cells if row[0] != "term" and row[0].strip("-")]


def of_python(path):
    """A module's name, what it defines, assigns or takes, and its words of data; not its docstrings and comments."""
    yield path.parent.name if path.stem == "__init__" else path.stem
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
                yield name
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.Constant(value=str(text)) if text.isidentifier():
                yield text


def of_c(path):
    return re.findall(
        r"[A-Za-z_]\w*", re.sub(r"/\*.*?\*/|//[^\n]*|\"[^\"\n]*\"", "", path.read_text("utf-8"), flags=re.S)
    )


@pytest.fixture(scope="module")
def units():
    """Of the kernels' arguments and results."""
    kernels = json.loads((ROOT / "generated" / "manifest.json").read_text("utf-8"))["kernels"]
    return {value["name"]: value["unit"] for kernel in kernels for value in kernel["inputs"] + kernel["outputs"]}


@pytest.fixture(scope="module")
def names(units):
    python = [path for part in ("trum_sym", "derivations") for path in (ROOT / part).rglob("*.py")]
    c = [path for part in ("trum_sym/_driver", "generated") for path in (ROOT / part).rglob("*.[ch]*")]
    return {*units, *(n for path in python for n in of_python(path)), *(n for path in c for n in of_c(path))}


def test_every_name_in_the_last_column_is_in_the_source(names):
    stated = {row[0]: NAME.findall(row[5]) for row in rows()}
    assert all(stated.values()), "each term has a name in the code"
    assert {(term, name) for term, found in stated.items() for name in found if name not in names} == set()


def test_units_are_those_of_the_kernels_arguments(units):
    wrong = [
        (row[0], name, units[name])
        for row in rows()
        for name in NAME.findall(row[5])
        if row[3] and name in units and units[name] not in row[3].split(", ")
    ]
    assert wrong == []


def test_equations_are_the_papers_and_terms_are_there_once():
    ids = {entry["id"] for entry in json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))}
    assert {n for row in rows() for n in re.findall(r"A?\d+", row[4]) if "Sect" not in row[4]} <= ids
    assert [term for term, count in Counter(row[0] for row in rows()).items() if count > 1] == []
    assert all(len(row) == 6 for row in rows())
    assert len(rows()) > 50


def test_the_figures_are_those_of_the_table():
    text = (ROOT / "docs" / "glossary.md").read_text("utf-8")
    section = text.split("## Figures of an operating point")[1].split("\n## ")[0]
    assert section.strip().split("|---|\n")[1] == in_glossary(), "paste trum_sym.quantities.in_glossary()"
