"""Formulas of the ledger in a terminal: none is wider than it, and none loses anything where it is broken."""

from __future__ import annotations

import json
import re
from collections import Counter
from itertools import pairwise
from pathlib import Path

import pytest
from lazily import lazily

from trum_sym import console
from trum_sym.paper.terminal import beside, laid_out

sp = lazily("sympy")
terminal = lazily("derivations.ledger.terminal")
GENERATED = Path(__file__).parents[2] / "generated"
WIDTHS = (52, 72, 92)  # of a terminal of 60, 80, 100 columns, less the most that a formula is indented by


@pytest.fixture(scope="module")
def formulas():
    """Every formula, by its entry."""
    entries = json.loads((GENERATED / "ledger.pictures.json").read_text("utf-8"))
    return [
        (name, picture)
        for name, entry in entries.items()
        for picture in [*entry["printed"], *entry["derived"], *(p for step in entry["steps"] for p in step)]
    ]


def letters(lines):
    return Counter(c for line in lines for c in line if c.isalnum() or c == "∂")


def inside(picture):
    yield picture
    for part in picture.get("parts", ()):
        yield from inside(part)


def test_there_is_a_picture_for_every_formula_in_latex(formulas):
    records = json.loads((GENERATED / "ledger.json").read_text("utf-8"))
    listed = [
        r["id"]
        for r in records
        for _ in [
            *(r["printed_latex"] or ()),
            *(r["derived_latex"] or ()),
            *(f for s in r["steps"] for f in s["latex"]),
        ]
    ]
    assert [name for name, _ in formulas] == listed


@pytest.mark.parametrize("width", WIDTHS)
def test_no_formula_is_wider_than_the_terminal(formulas, width):
    assert [name for name, picture in formulas if max(map(len, laid_out(picture, width))) > width] == []


def test_a_broken_formula_has_all_letters_and_figures_of_the_whole(formulas):
    compared = 0
    for name, top in formulas:
        for picture in inside(top):
            whole = picture["lines"]
            if whole and "parts" in picture and "∫" not in "".join(whole) and "⌠" not in "".join(whole):
                broken = laid_out({**picture, "lines": []}, 44)
                assert letters(broken) == letters(whole), name
                compared += 1
    assert compared > 500


def test_what_is_narrow_is_what_sympy_draws():
    a, b, k_c = sp.symbols("a b k_c")
    form = a / (b + k_c) + sp.sqrt(a)
    drawn = laid_out(terminal.picture("", form), 60)
    assert drawn == [line.rstrip() for line in sp.pretty(form, use_unicode=True).splitlines()]


def test_what_is_wide_is_broken_before_an_operator():
    x = sp.symbols("x_1:9")
    total = sp.Add(*(sp.sin(a) * sp.cos(b) for a, b in pairwise(x)))
    lines = laid_out(terminal.picture("total", total), 52)
    assert len(lines) == 4
    assert all(re.match(r" +[+-] ", line) for line in lines[1:])
    assert "".join(line.strip() for line in lines).count("sin") == 7


def test_a_partial_derivative_stays_one():
    t, x = sp.symbols("t x")
    w = sp.Function("w")(x, t)
    inner = sum(sp.cos(n * w) for n in range(1, 6))
    for expression, sign in ((inner, "∂"), (inner.subs(x, t), "d")):
        lines = laid_out(terminal.picture("", sp.Derivative(expression, t, evaluate=False)), 36)
        assert sign in "".join(lines).replace("d(", "")


def test_pictures_stand_on_one_line():
    fraction = {"lines": ["1", "─", "2"], "baseline": 1}
    assert beside([{"lines": ["x = "], "baseline": 0}, fraction])[0] == ["    1", "x = ─", "    2"]


@pytest.mark.parametrize("equation", ["24", "6", "A17", "rotor-flange", "table-1-J"])
def test_the_console_keeps_to_the_width(capsys, monkeypatch, equation):
    for width in (60, 100):
        monkeypatch.setenv("COLUMNS", str(width))
        assert console.main(["equations", "--equation", equation]) == 0
        out = capsys.readouterr().out
        assert max(map(len, out.splitlines())) <= width
        assert "\\" not in out  # LaTeX
