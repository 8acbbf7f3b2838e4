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
    assert len(out.splitlines()) == len(SHIPPED) + 2 + 3  # a blank line and the counts


@pytest.mark.parametrize("name", ["6", "(6)", "a13", "A13", "supplement-add"])
def test_one_equation_is_written_out(capsys, name):
    code, out, _ = run(capsys, "--equation", name)
    assert code == 0
    assert "printed" in out
    assert "effect:" in out


def test_the_table_ends_in_counts_by_severity_and_sureness(capsys):
    _, out, _ = run(capsys)
    errata = sum(r["verdict"] == "erratum" for r in SHIPPED)
    structural = sum(r["severity"] == "structural" for r in SHIPPED)
    doubtful = sum(r["copy"] == "doubtful" for r in SHIPPED)
    *_, severities, copies = out.splitlines()
    assert severities.startswith(f"{errata} errata: ")
    assert severities.endswith(f" {structural} structural")
    assert f" {doubtful} doubtful" in copies


@pytest.mark.parametrize(("option", "value"), [("severity", "conditional"), ("verdict", "empirical")])
def test_filters(capsys, option, value):
    code, out, _ = run(capsys, f"--{option}", value, "--json")
    assert code == 0
    wanted = [r["id"] for r in SHIPPED if r[option] == value]
    assert wanted
    assert [r["id"] for r in json.loads(out)] == wanted


@pytest.mark.parametrize("option", ["severity", "verdict"])
def test_an_unknown_filter_is_refused(console_refuses, option):
    console_refuses("equations", f"--{option}", "bad", naming=(option, "bad"))


def test_one_equation_says_how_bad_and_how_sure(capsys):
    _, out, _ = run(capsys, "--equation", "22")
    assert "severity: quantitative" in out
    assert "copy of the paper's text: doubtful" in out
    assert "with zeta_x for zeta_z: verified" in out


def test_one_equation_as_json_is_a_list_of_one(capsys):
    _, out, _ = run(capsys, "--equation", "24", "--json")
    assert [r["id"] for r in json.loads(out)] == ["24"]


def test_an_unknown_equation_is_refused(console_refuses):
    console_refuses("equations", "--equation", "46", naming=("equation", "46", "1 to 45"))


def test_an_incomplete_installation_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(ledger, "_PLACES", (tmp_path,))
    with pytest.raises(FileNotFoundError, match=r"ledger\.json"):
        ledger.load_ledger()
