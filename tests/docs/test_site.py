"""The site's pages say what their sources say, and its check of links notices what is broken.

The build itself, ``python -m docs``, is a step of ``.ci/run``.
"""

from __future__ import annotations

import doctest
import json
import re
from pathlib import Path

import pytest

from docs.site import c_header, kernels, ledger, links, staging

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def made():
    return {**ledger.pages(ROOT), **kernels.pages(ROOT), **c_header.pages(ROOT)}


def test_every_entry_of_the_ledger_has_a_page_with_all_of_its_formulas(made):
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    assert len(made) == len(records) + 3  # their index, kernels, header
    for r in records:
        page = made[f"ledger/{ledger.anchor(r['id'])}.md"]
        shown = [*(r["printed_latex"] or ()), *(r["derived_latex"] or ()), *(f for s in r["steps"] for f in s["latex"])]
        assert [formula for formula in shown if formula not in page] == []
        assert f"**{r['verdict'].capitalize()}**" in page
        assert "## Effect" in page


def test_an_entry_names_the_kernels_whose_titles_name_it(made):
    assert "`trum_resonance`" in made["ledger/eq-6.md"]
    assert "`trum_rotor_coefficients`" in made["ledger/eq-38.md"]
    assert "No kernel" in made["ledger/table-4.md"]
    ids = {r["id"] for r in json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))}
    named = [kernel for kernel in kernels.load(ROOT) if kernel.equations]
    assert len(named) > 25
    assert all(kernel.equations <= ids for kernel in named)


def test_the_header_s_page_has_every_declaration_with_its_comment(made):
    header = (ROOT / "trum_sym" / "_driver" / "trum.h").read_text("utf-8")
    names = set(re.findall(r"^(?:struct|enum) (\w+) \{|^[^#/\n]*?(trum_\w+)\(", header, re.M))
    for name in {one or other for one, other in names}:
        assert f"## `{name}`" in made["c-header.md"], name
    assert "The name of a field by its number" in made["c-header.md"]
    assert "| `prepressure` | F_c | N |" in made["c-header.md"]


def test_examples_of_the_site_s_modules_run():
    assert [doctest.testmod(module).failed for module in (staging, kernels)] == [0, 0]


def written(folder, **pages):
    for name, text in pages.items():
        (folder / f"{name}.html").write_text(text, "utf-8")
    return folder


def test_a_broken_link_and_what_comes_from_a_network_are_noticed(tmp_path):
    good = '<h1 id="top">a</h1><a href="b.html#there">b</a><a href="https://example.org">c</a><img src="data:,">'
    assert links.check(written(tmp_path, a=good, b='<p id="there">')) == []
    for text, word in (
        ('<a href="c.html">', "c.html is not there"),
        ('<a href="b.html#here">', "no such place"),
        ('<a href="#here">', "no such place"),
        ('<script src="https://example.org/x.js"></script>', "loads https://example.org/x.js"),
        ('<link rel="stylesheet" href="//example.org/x.css">', "loads //example.org/x.css"),
        ('<img src="picture.png">', "which is not there"),
    ):
        (said,) = links.check(written(tmp_path, a=text))
        assert word in said
    written(tmp_path, a=good)
    (tmp_path / "x.css").write_text('@font-face { src: url("https://example.org/font.woff2") }', "utf-8")
    assert links.check(tmp_path) == ["x.css: loads https://example.org/font.woff2"]
