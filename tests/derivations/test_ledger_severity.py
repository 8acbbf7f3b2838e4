"""How bad an erratum is, how sure its copy, and the one rule that parts approximations from errata."""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from lazily import lazily

from trum_sym.paper.ledger import SEVERITIES, filtered, load_ledger

sp = lazily("sympy")
ledger = lazily("derivations.ledger")
judge = lazily("derivations.ledger.judge")
model = lazily("derivations.ledger.model")
referee = lazily("derivations.ledger.referee")
severity = lazily("derivations.ledger.severity")

ROOT = Path(__file__).parents[2]
RECORDS = load_ledger()
BY_ID = {r["id"]: r for r in RECORDS}
NUMBERED = [str(n) for n in range(1, 46)] + [f"A{n}" for n in range(1, 18)]


def test_every_erratum_has_a_severity_and_nothing_else_has():
    for r in RECORDS:
        assert (r["severity"] in SEVERITIES) == (r["verdict"] == "erratum"), r["id"]
        assert (r["severity_detail"] is None) == (r["severity"] is None), r["id"]


def test_a_figure_changes_in_quantitative_errata_and_in_none_that_is_typographical():
    for r in RECORDS:
        if r["severity"] == "quantitative":
            assert r["size"] > 0, r["id"]
        if r["severity"] == "typographical":
            assert r["size"] is None, r["id"]


def test_a_verdict_that_hangs_on_a_doubtful_sign_says_both_outcomes():
    for name, outcome in {
        "14": "erratum",
        "22": "verified",
        "24": "erratum",
        "28": "verified",
        "29": "verified",
        "33": "verified",
        "41": "verified",
        "table-1-densities": "verified",
    }.items():
        r = BY_ID[name]
        assert r["copy"] == "doubtful", name
        assert {o["verdict"] for o in r["other_readings"]} == {outcome}, name


@pytest.mark.parametrize(
    ("name", "word", "size"),
    [
        ("28", "typographical", None),  # an index
        ("table-1-densities", "typographical", None),  # a unit
        ("14", "conditional", None),
        ("45", "quantitative", 0.189 / 0.188 - 1),
        ("A4", "quantitative", 2.0),  # the sign
        ("15", "structural", 1.0),  # a period twice too long, and one that does not exist
    ],
)
def test_severity_follows_from_print_and_mend(name, word, size):
    found = severity.severity(model.confirm(ledger.entry(name)))
    assert found is not None
    assert found.word == word
    if size is not None:
        assert found.size == pytest.approx(size, rel=0.01)


def test_a_typographical_erratum_whose_figure_changes_is_not_typographical_any_more():
    """The same entry with a factor 2 beside its name."""
    honest = ledger.entry("28")
    twice = replace(honest, printed={"delta_0": 2 * honest.printed["delta_0"]})
    found = severity.severity(model.confirm(twice))
    assert found is not None
    assert found.word != "typographical"


def test_a_fault_outside_the_supplement_is_not_conditional(monkeypatch):
    monkeypatch.setattr("derivations.ledger.severity.other_readings", lambda _: iter(()))
    honest = ledger.entry("24")
    assert next(r for r in RECORDS if r["id"] == "24")["severity"] == "conditional"
    first, *rest = honest.printed["Q_q"].args
    doubled = {"Q_q": sp.Piecewise((2 * first[0], first[1]), *rest, evaluate=False)}
    found = severity.severity(model.confirm(replace(honest, printed=doubled)))
    assert found is not None
    assert found.word != "conditional"


def test_a_repair_by_a_symbol_is_of_few_signs():
    for r in RECORDS:
        changed = re.match(r"mended by (\d+) sign", r["severity_detail"] or "")
        if changed:
            assert 1 <= int(changed[1]) <= severity.SIGNS, r["id"]


# --- one rule for approximations ----------------------------------------------------------------------------
def test_the_limit_is_how_far_table_1_contradicts_itself():
    p = judge.usual()
    off = [abs(1 - p[f"G_{x}"] * 2 * (1 + p[f"mu_{x}"]) / p[f"E_{x}"]) for x in "ep"]
    assert all(round(gap, 1) == model.APPROXIMATION_LIMIT for gap in off), off


def test_approximations_state_a_size_within_the_limit():
    for e in ledger.ENTRIES:
        if e.verdict == "approximation":
            sizes = [found.size for found in model.confirm(e).printed if found.size is not None]
            assert sizes, e.id
            assert all(abs(size) <= model.APPROXIMATION_LIMIT for size in sizes), e.id


def test_an_error_that_is_no_number_somewhere_in_the_domain_is_noticed():
    assert not judge.error_size("x", lambda: (0.1, float("nan")), "y -> 0", lambda: 0.001).ok


@pytest.mark.parametrize(
    ("there", "left", "ok"), [(0.19, 0.001, True), (-0.19, 0.001, True), (0.21, 0.001, False), (0.1, 0.05, False)]
)
def test_an_error_is_small_and_vanishes_in_its_limit(there, left, ok):
    assert judge.error_size("x", lambda: (there, 9.0), "y -> 0", lambda: left).ok == ok


def test_an_approximation_that_is_off_by_more_is_an_erratum():
    honest = ledger.entry("26")
    coarse = model.Evidence("error_size", True, "", 0.3)
    found = model.confirm(replace(honest, judge=lambda forms: [*honest.judge(forms), coarse]))
    assert any("30 % at Table 3's point: an erratum" in problem for problem in found.problems)
    unsized = model.confirm(
        replace(honest, judge=lambda _: [model.Evidence("error_size", True, ""), model.Evidence("limit", True, "")])
    )
    assert any("states the size" in problem for problem in unsized.problems)


def test_an_erratum_that_the_rule_makes_an_approximation_is_not_confirmed():
    """A_B of (13) short of omega_q/omega_n: off by 7 %, exact at resonance, no other fault."""
    honest = ledger.entry("13")
    right = honest.derive().forms
    assert right != honest.printed

    def judge(forms):
        yield model.Evidence("numeric", forms == right, "")
        yield model.Evidence("limit", True, "")

    called = replace(honest, verdict="erratum", judge=judge, repair=lambda _: right, found_by=("numeric",))
    result = model.confirm(called)
    assert "omega_q -> omega_n" in (severity.would_approximate(result) or "")
    assert any("by the rule an approximation" in problem for problem in referee.review(result).problems)


# --- what is said of it -------------------------------------------------------------------------------------
def test_filters_agree_with_the_records():
    for word in SEVERITIES:
        assert {r["id"] for r in filtered(RECORDS, severity=word)} == {
            i for i, r in BY_ID.items() if r["severity"] == word
        }
    assert {r["verdict"] for r in filtered(RECORDS, verdict="empirical")} == {"empirical"}
    assert filtered(RECORDS, verdict="verified", severity="structural") == []


def _text(name):
    return (ROOT / name).read_text("utf-8").replace("\n", " ").replace("  ", " ")


def test_readme_and_findings_count_by_severity_and_sureness():
    of_the_62 = [BY_ID[name] for name in NUMBERED]
    errata = Counter(r["severity"] for r in of_the_62 if r["severity"])
    counted = " and ".join(
        [", ".join(f"{errata[word]} {word}" for word in SEVERITIES[:-1]), f"{errata[SEVERITIES[-1]]} {SEVERITIES[-1]}"]
    )
    doubtful = sum(r["copy"] == "doubtful" for r in of_the_62)
    found = _text("docs/findings.md")
    assert f"**{errata.total()} of the 62 numbered equations are errata**, {counted}" in found
    assert f"at {doubtful} of the 62 the copy" in found
    assert f"{errata.total()} are errata" in _text("README.md")


def test_the_docs_count_by_severity_and_sureness():
    text = (ROOT / "docs" / "ledger.md").read_text("utf-8")
    for key, words in (("severity", SEVERITIES), ("copy", ("clear", "doubtful", "missing"))):
        for word in words:
            everywhere = sum(r[key] == word for r in RECORDS)
            numbered = sum(BY_ID[name][key] == word for name in NUMBERED)
            assert re.search(rf"^\| {word} \| {everywhere} \| {numbered} \|", text, re.MULTILINE), (word, everywhere)


def test_the_page_has_a_button_for_each_severity_and_says_both_outcomes():
    page = (ROOT / "generated" / "ledger.html").read_text("utf-8")
    for word in SEVERITIES:
        count = sum(r["severity"] == word for r in RECORDS)
        assert f'<button data-kind="{word}" aria-pressed="false">{word} {count}</button>' in page
        assert page.count(f'data-severity="{word}"') == count
    assert page.count('data-copy="doubtful"') == sum(r["copy"] == "doubtful" for r in RECORDS)
    assert "What it may have lost" in page


def test_ledger_json_has_the_new_keys():
    new = {"severity", "severity_detail", "size", "conditional", "copy", "copy_doubt", "copy_lines", "other_readings"}
    shipped = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    assert all(set(r) >= new for r in shipped)
