"""``trum-sym equations`` shows the ledger that ships."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from trum_sym import console
from trum_sym.paper import ledger

SHIPPED = json.loads((Path(__file__).parents[2] / "generated" / "ledger.json").read_text("utf-8"))


def run(capsys, *arguments):
    code = console.main(["equations", *arguments])
    out, err = capsys.readouterr()
    return code, out, err


def test_json_is_the_shipped_ledger(capsys):
    code, out, err = run(capsys, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out) == SHIPPED


def test_the_table_has_a_line_per_entry(capsys):
    code, out, _ = run(capsys)
    assert code == 0
    assert len(out.splitlines()) == len(SHIPPED) + 2


@pytest.mark.parametrize("name", ["6", "(6)", "a13", "A13", "supplement-add"])
def test_one_equation_is_written_out(capsys, name):
    code, out, _ = run(capsys, "--equation", name)
    assert code == 0
    assert "printed" in out
    assert "effect:" in out


def test_one_equation_as_json_is_a_list_of_one(capsys):
    _, out, _ = run(capsys, "--equation", "24", "--json")
    assert [r["id"] for r in json.loads(out)] == ["24"]


def test_an_unknown_equation_is_refused(console_refuses):
    console_refuses("equations", "--equation", "46", naming=("equation", "46", "1 to 45"))


def test_an_incomplete_installation_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(ledger, "_PLACES", (tmp_path,))
    with pytest.raises(FileNotFoundError, match=r"ledger\.json"):
        ledger.load_ledger()
