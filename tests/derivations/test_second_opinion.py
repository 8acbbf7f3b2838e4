"""The second algebra system: what it is told is what the ledger holds, and what it says reaches the records."""

from __future__ import annotations

import json
import math
import os
import random
import re
import stat
from pathlib import Path

import pytest
from lazily import lazily

sp = lazily("sympy")
judge = lazily("derivations.ledger.judge")
ledger = lazily("derivations.ledger")
main = lazily("derivations.__main__")
model = lazily("derivations.ledger.model")
mutate = lazily("derivations.ledger.mutate")
opinion = lazily("derivations.ledger.second_opinion")
printer = lazily("derivations.maxima.printer")
session = lazily("derivations.maxima.session")

ROOT = Path(__file__).parents[2]
JUDGES = ROOT / "derivations" / "maxima" / "judges"


@pytest.fixture(scope="module")
def records():
    return json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))


# --- the printer --------------------------------------------------------------------------------------------
MEANINGS = {name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "sqrt")}
MEANINGS |= {"abs": abs, "max": max, "min": min, "angle2": math.atan2, "signum": lambda u: (u > 0) - (u < 0)}


def value(text, values):
    """A Maxima text by Python's arithmetic, which writes powers otherwise."""
    return eval(text.replace("^", "**").replace("%pi", "pi"), {**MEANINGS, "pi": math.pi, **values})


def test_what_is_printed_has_the_value_of_what_is_held():
    seen = 0
    for entry in ledger.ENTRIES:
        for name, form in entry.printed.items():
            symbols = sorted(form.free_symbols, key=str) if isinstance(form, sp.Expr) else []
            if (
                not symbols
                or form.has(sp.Piecewise, sp.Derivative, sp.Integral, sp.Sum, sp.Indexed)
                or form.atoms(sp.core.function.AppliedUndef)
            ):
                continue
            draw = random.Random(f"{entry.id} {name}")
            values = {symbol: draw.uniform(0.2, 0.9) for symbol in symbols}
            wanted = complex(judge.evaluate(form, values))
            if abs(wanted.imag) > 1e-12:
                continue
            found = value(printer.text(form), {printer.name_of(s.name): v for s, v in values.items()})
            assert found == pytest.approx(wanted.real, rel=1e-11), (entry.id, name)
            seen += 1
    assert seen > 80


def test_what_has_no_text_is_refused_by_name():
    with pytest.raises(printer.PrintError, match="gamma"):
        printer.text(sp.gamma(sp.Symbol("a")))
    with pytest.raises(printer.PrintError, match="no text"):
        printer.text(sp.zoo)


def test_words_of_the_language_are_no_symbols():
    assert printer.text(sp.Symbol("lambda") + sp.Symbol("step")) == "(lambda_ + step_)"
    assert printer.text(sp.Symbol(r"\mathrm{kg}")) == "u_kg"


# --- the session --------------------------------------------------------------------------------------------
def stand_in(folder, body):
    """A program called maxima that reads statements and answers as told."""
    path = folder / "maxima"
    path.write_text(f"#!/bin/sh\n{body}\n", "utf-8")
    path.chmod(path.stat().st_mode | stat.S_IEXEC)
    return path


LOADS = 'while read -r line; do case "$line" in *@@end*) printf "\\n@@end\\n";; *opinion*) {said};; esac; done'


def asked(monkeypatch, folder, said, seconds=2.0):
    stand_in(folder, LOADS.format(said=said))
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    with session.Session("", seconds) as running:
        return running.ask("judge_1", "[]")


def test_findings_are_read(monkeypatch, tmp_path):
    said = r'printf "\n@@yes|ratsimp|D is right\n\n@@no|50 digits|E is not\n"'
    assert asked(monkeypatch, tmp_path, said) == [
        session.Finding(True, "ratsimp", "D is right"),
        session.Finding(False, "50 digits", "E is not"),
    ]


def test_a_question_a_long_silence_and_an_end_are_no_answers(monkeypatch, tmp_path):
    assert "Is k zero or nonzero?" in asked(monkeypatch, tmp_path, 'printf "Is k zero or nonzero?\\n"; read -r more')
    assert "none within 0.5 s" in asked(monkeypatch, tmp_path, "exec sleep 20", 0.5)
    assert "ended" in asked(monkeypatch, tmp_path, "exit 3")
    assert asked(monkeypatch, tmp_path, 'printf "nonsense\\n"').startswith("no finding: nonsense")


def test_without_maxima_the_command_says_so_in_a_line(monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for more in ((), ("--mutants",)):
        assert main.main(["verify", "--second-opinion", "--equation", "A15", *more]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert err.count("\n") == 1
        assert "Maxima is not installed" in err


@pytest.mark.parametrize("every", ["0", "-1", "some"])
def test_a_step_through_the_mutants_is_a_whole_number(every, capsys):
    with pytest.raises(SystemExit):
        main.main(["verify", "--second-opinion", "--mutants", "--every", every])
    assert f"is '{every}'; a whole number from 1 on is needed" in capsys.readouterr().err


# --- the verdicts -------------------------------------------------------------------------------------------
def told(printed=None, standing=None):
    """An opinion with a finding for or against each part."""
    parts = {"printed": printed, "standing": standing}
    return opinion.Opinion(
        "0", {part: [session.Finding(ok, "ratsimp", "x")] for part, ok in parts.items() if ok is not None}
    )


def test_an_erratum_needs_a_print_that_fails_and_a_correction_that_holds():
    erratum, verified = ledger.entry("6"), ledger.entry("2")
    assert told(printed=False, standing=True).problems(erratum) == []
    assert told(printed=True, standing=True).problems(erratum) == ["nothing speaks against the print"]
    assert told(printed=False, standing=False).problems(erratum) == ["standing: x (ratsimp)"]
    assert told(printed=True).problems(verified) == []
    assert told(printed=False).problems(verified) == ["printed: x (ratsimp)"]
    no_value = opinion.Opinion("0", {"printed": [session.Finding(False, "no value", "x")], "standing": []})
    assert no_value.problems(erratum) == ["nothing speaks against the print"]


def test_every_entry_that_is_asked_has_a_judge_and_no_other():
    text = "".join(path.read_text("utf-8") for path in JUDGES.glob("*.mac"))
    judges = set(re.findall(r"^(judge_\w+)\(\) :=", text, re.MULTILINE))
    assert judges == {opinion.judge_of(e) for e in ledger.ENTRIES if e.verdict in opinion.ASKED}
    assert {path.name for path in JUDGES.glob("*.mac")} == set(session.SCRIPTS)


def test_nine_of_ten_are_confirmed_by_both_and_the_rest_says_why(records):
    asked = [r for r in records if r["verdict"] in opinion.ASKED]
    both = [r for r in asked if r["second_opinion"]["confirmed_by"] == ["SymPy", "Maxima"]]
    assert len(both) >= 0.9 * len(asked) > 70
    assert all(r["second_opinion"]["undecided"] for r in asked if r not in both)
    for r in both:
        printed = r["second_opinion"]["findings"].get("printed")
        assert r["verdict"] == "reconstructed" or all(f["ok"] for f in printed) == (r["verdict"] != "erratum"), r["id"]


def test_the_page_says_by_whom_and_how(records):
    page = (ROOT / "generated" / "ledger.html").read_text("utf-8")
    both = sum(r["second_opinion"]["confirmed_by"] == ["SymPy", "Maxima"] for r in records)
    assert page.count("<b>Confirmed by:</b> SymPy, Maxima ") == both
    assert page.count("<summary>Second opinion</summary>") == sum(
        bool(r["second_opinion"]["findings"]) for r in records
    )


@pytest.mark.parametrize("name", ["2", "38", "A17"])
def test_another_form_or_judge_makes_an_opinion_stale(name, monkeypatch):
    entry = ledger.entry(name)
    derived = dict(entry.derive().forms)
    assert opinion.stale(entry, derived) is None
    if entry.verdict == "erratum":
        key, form = next(iter(derived.items()))
        assert "asked of other forms" in opinion.stale(entry, {**derived, key: -form})
    monkeypatch.setattr("derivations.ledger.second_opinion._scripts", lambda: "another judge")
    assert "asked of other forms" in opinion.stale(entry, derived)


# --- with Maxima --------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def maxima():
    with opinion.new_session() as running:
        yield running


@pytest.mark.maxima
def test_no_symbol_of_a_form_is_a_name_of_the_judges(maxima):
    maxima.ask("judge_A15", "[]")
    said = maxima._said('printf(true, "~a~%", string(values))$')
    names = set(re.findall(r"\w+", said))
    forms = [form for e in ledger.ENTRIES for form in e.printed.values()]
    used = {printer.name_of(s.name) for form in forms for s in getattr(form, "free_symbols", ()) if hasattr(s, "name")}
    assert len(names) > 20
    assert names & used == set()


@pytest.mark.maxima
@pytest.mark.parametrize(
    ("name", "form", "slip"),
    [
        ("2", "I_e", lambda f: f * 2),
        ("6", "omega_n", lambda f: f.subs(sp.Symbol("kappa", positive=True), 1)),
        ("36", "f_n", lambda f: -f),
        ("A6", "Q_q", lambda f: f.xreplace({sp.Integer(-1): sp.Integer(1)})),
        ("42", "Q_q", lambda f: f**2),
    ],
)
def test_a_slip_is_noticed_by_maxima_too(maxima, name, form, slip):
    entry = ledger.entry(name)
    forms = entry.subject()
    right = maxima.ask(opinion.judge_of(entry), printer.forms_text(forms))
    wrong = maxima.ask(opinion.judge_of(entry), printer.forms_text({**forms, form: slip(forms[form])}))
    assert all(f.ok for f in right)
    assert not all(f.ok for f in wrong)


@pytest.mark.maxima
def test_a_form_that_is_missing_speaks_against_itself(maxima):
    (found,) = maxima.ask("judge_A15", "[]")
    assert (found.ok, found.method) == (False, "no value")


def test_the_docs_show_what_maxima_found():
    text = (ROOT / "docs" / "ledger.md").read_text("utf-8")
    shown = re.search(r"<!-- python -m derivations verify --second-opinion -->\n```\n(.*?)\n```", text, re.DOTALL)[1]
    kept = json.loads(opinion.FILE.read_text("utf-8"))
    assert shown == opinion._summary(kept, 0)
