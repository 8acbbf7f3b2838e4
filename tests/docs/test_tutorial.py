"""The tutorial and the pages on libraries, cell by cell."""

from __future__ import annotations

from pathlib import Path

import pytest
from cells import cells, not_to_be_pasted, wrong

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [path.name for path in sorted(DOCS.glob("*.md")) if cells(path)]
LONGER = {"libraries.md": pytest.mark.slow}  # which .ci/run runs beside the site


def marked(names):
    return [pytest.param(name, marks=LONGER.get(name, ())) for name in names]


@pytest.mark.parametrize("page", marked(PAGES))
def test_a_page_s_cells_print_what_stands_below_them(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert wrong(DOCS / page) == ""


@pytest.mark.parametrize("page", PAGES)
def test_a_cell_can_be_pasted_at_python_s_prompt(page):
    assert not_to_be_pasted(DOCS / page) == []


def test_the_pages_with_cells_are_found():
    assert {"tutorial.md", "parameter-sets.md", "libraries.md"} <= set(PAGES)


def test_the_tutorial_has_eight_steps():
    steps = [line for line in (DOCS / "tutorial.md").read_text("utf-8").splitlines() if line[:3] == "## "]
    assert [step[3:5] for step in steps[:8]] == [f"{number}." for number in range(1, 9)]


def test_another_output_is_noticed(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("```pycon\n>>> x = 1\n```\n\n```pycon\n>>> x + 1\n3\n```\n", "utf-8")
    assert "Expected:\n    3\nGot:\n    2" in wrong(page)
