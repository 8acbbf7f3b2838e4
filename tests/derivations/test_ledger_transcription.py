"""Both transcriptions of the paper's equations agree, and a character changed in either is noticed."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import pytest
from lazily import lazily

sp = lazily("sympy")
ledger = lazily("derivations.ledger")
command = lazily("derivations.ledger.command")
copy_mutants = lazily("derivations.ledger.copy_mutants")
notation = lazily("derivations.ledger.notation")
transcription = lazily("derivations.ledger.transcription")
nomenclature = lazily("derivations.nomenclature")

NUMBERED = [str(n) for n in range(1, 46)] + [f"A{n}" for n in range(1, 18)]


def changed(name, old, new, field="forms"):
    """The data with a text replaced in an entry's quotes; the text must be there."""
    data = deepcopy(dict(transcription.load()))
    found = [quote for quote in data[name]["quote"] if old in quote.get(field, "")]
    assert found
    for quote in found:
        quote[field] = quote[field].replace(old, new)
    return data


def test_both_transcriptions_agree():
    assert [line for e in ledger.ENTRIES for line in transcription.differences(e)] == []


def test_all_62_equations_are_transcribed_twice_but_for_the_one_that_the_copy_lost():
    assert set(NUMBERED) <= transcription.load().keys()
    without = [n for n in NUMBERED if not any("forms" in quote for quote in transcription.load()[n]["quote"])]
    assert without == ["32"]
    assert ledger.entry("32").printed == {}


def test_every_printed_form_is_transcribed_twice_but_for_sentences():
    once = [e.id for e in ledger.ENTRIES if e.printed and e.id not in transcription.load()]
    assert all(name.startswith("claim-") for name in once)
    for e in ledger.ENTRIES:
        if e.printed and e.id in transcription.load() and e.id != "32":
            assert transcription.second(e.id).keys() == e.printed.keys(), e.id


def test_every_quote_is_the_one_that_was_copied():
    for name, block in transcription.load().items():
        for quote in block["quote"]:
            assert transcription.checksum(quote["text"]) == quote["checksum"], name
            assert 1 <= quote["line"] <= 821


# --- what the comparison finds ------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("6", "k_c**4", "k_c**3"),
        ("9", "varphi_Aredu)", "varphi_Badd)"),
        ("10", "cos(", "sin("),
        ("17", "; t in [t_2, t_4]", "; t in [t_2, t_3]"),
        ("23", "(P_Bredu/W_maxf)**2", "(P_Bredu*W_maxf)**2"),
        ("24", "(t_3 - t_2)*((Theta", "(t_3 - t_2) - ((Theta"),
        ("35", "< v_xm(t) < 0", "> v_xm(t) < 0"),
        ("37", "> 0, v_xp(x,t) < 0", "> 0, v_xp(x,t) > 0"),
        ("43", "abs(Q_q(t).plus)) - sum", "abs(Q_q(t).plus)) + sum"),
        ("A12", "P_A*cos(k_c*x) - P_B", "P_A*cos(k_c*x) + P_B"),
        ("table-1-R", "60*mm", "6*mm"),
    ],
)
def test_a_changed_notation_differs_from_the_first_and_from_the_quote(name, old, new):
    found = transcription.differences(ledger.entry(name), changed(name, old, new))
    assert found
    assert all(line.startswith(f"({name})") for line in found)


def test_the_faults_that_the_second_transcription_found_would_be_found_again():
    v_xm, v_xmax, M_a, M_b, D, k_c = nomenclature.sym("v_xm v_xmax M_a M_b D k_c")
    falling, hastening = sp.And(v_xm < v_xmax, v_xmax < 0), sp.And(v_xmax < v_xm, v_xm < 0)
    rows = list(ledger.entry("35").printed["x_p"].args)
    for index in (9, 10):
        rows[index] = (rows[index][0], sp.And(*(set(rows[index][1].args) - set(hastening.args)), *falling.args))
    slipped = {"x_p": sp.Piecewise(*rows, evaluate=False)}
    assert (
        len([line for line in transcription.differences(ledger.entry("35"), printed=slipped) if "condition" in line])
        == 2
    )
    one_row = {**ledger.entry("17").printed, "A_v": D * k_c * sp.sqrt(M_a**2 + M_b**2)}
    assert any("A_v" in line for line in transcription.differences(ledger.entry("17"), printed=one_row))
    without = {name: form for name, form in ledger.entry("23").printed.items() if name != "p_A"}
    assert any(
        "p_A stands in the second only" in line
        for line in transcription.differences(ledger.entry("23"), printed=without)
    )


def test_a_changed_quote_is_noticed_by_checksum_and_by_its_signs():
    data = changed("12", "A_B^2", "A_B^3", "text")
    found = transcription.differences(ledger.entry("12"), data)
    assert any("not the one that was copied" in line for line in found)
    assert any("the quote has 3 where the notation has 2" in line for line in found)


def test_verify_fails_where_the_two_disagree():
    (record,) = command.prove((replace(ledger.entry("12"), printed={"A_Q": 2 * ledger.entry("12").printed["A_Q"]}),))
    assert not record["confirmed"]
    assert any(problem.startswith("(12) A_Q: ") for problem in record["problems"])


def test_the_command_says_that_they_agree_and_is_1_where_not(capsys, monkeypatch):
    assert command.transcription(mutants=False) == 0
    assert "0 differences" in capsys.readouterr().out
    monkeypatch.setattr(
        "derivations.ledger.command.ENTRIES",
        (replace(ledger.entry("27"), printed={"x_xm": nomenclature.sym("x_m")[0]}),),
    )
    assert command.transcription(mutants=False) == 1
    assert "(27) x_xm: x_m against" in capsys.readouterr().out


def test_a_character_changed_in_either_is_noticed():
    mutants = list(copy_mutants.copy_mutants(30, "a test's"))
    read = [m for m in mutants if m.noticed != copy_mutants.UNREADABLE]
    assert len(read) == 30
    assert [m for m in mutants if not m.noticed] == []
    assert {".py:" in m.where for m in read} == {True, False}
    assert copy_mutants.tally(mutants).startswith("30 characters changed in either transcription: 30 noticed")


def test_the_mutants_of_a_comparison_that_compares_nothing_are_not_noticed(monkeypatch):
    monkeypatch.setattr("derivations.ledger.copy_mutants.differences", lambda *_: [])
    assert any(not m.noticed for m in copy_mutants.copy_mutants(4))


# --- how sure the copy is, and what it may have lost ---------------------------------------------------------
def test_a_copy_is_clear_or_says_what_could_be_lost(monkeypatch):
    assert transcription.copy_of(ledger.entry("1")) == transcription.Copy("clear", "", (41,))
    assert transcription.copy_of(ledger.entry("28")).word == "doubtful"
    assert transcription.copy_of(ledger.entry("28")).doubt
    assert transcription.copy_of(ledger.entry("supplement-add")).word == "missing"
    for wrong in ("sure", "doubtful", "clear: but"):
        data = deepcopy(dict(transcription.load()))
        data["1"]["copy"] = wrong
        monkeypatch.setattr("derivations.ledger.transcription.load", lambda data=data: data)
        with pytest.raises(notation.NotationError, match="copy is"):
            transcription.copy_of(ledger.entry("1"))


def test_other_readings_change_the_print_and_only_there():
    for e in ledger.ENTRIES:
        for what, forms in transcription.other_readings(e):
            assert transcription.copy_of(e).word == "doubtful", e.id
            assert forms.keys() == e.printed.keys(), (e.id, what)
            assert forms != e.printed, (e.id, what)
        for signs, forms in transcription.mends(e):
            assert signs >= 1, e.id
            assert forms.keys() == e.printed.keys(), e.id
            assert forms != e.printed, e.id


def test_a_reading_of_what_is_not_there_is_refused(monkeypatch):
    data = deepcopy(dict(transcription.load()))
    data["28"]["otherwise"][0]["replace"] = [["x_zm", "x_xm"]]
    monkeypatch.setattr("derivations.ledger.transcription.load", lambda: data)
    with pytest.raises(notation.NotationError, match="x_zm"):
        list(transcription.other_readings(ledger.entry("28")))


# --- the notation -------------------------------------------------------------------------------------------
def plain(name, arguments):
    return sp.Function(name)(*arguments) if arguments else sp.Symbol(name)


def test_lines_carry_their_left_side_and_condition():
    text = "A = b\nM(t) =\n  c ; x > 0\n  d\n  ; t in [t_1, t_4]\n"
    whole = notation.Line(("M(t)",), "t in [t_1, t_4]")
    assert list(notation.lines(text)) == [
        notation.Line(("A", "b")),
        notation.Line(("M(t)", "c"), "x > 0"),
        notation.Line(("M(t)", "d")),
        whole,
    ]


def test_the_notation_is_read_as_it_says():
    x, t, a = sp.symbols("x t a")
    f = sp.Function("f")(x, t)
    assert notation.expression("diff2(f(x,t), x, t)", plain) == sp.Derivative(f, t, x)
    assert notation.expression("diff4(f(x,t), x**2, t**2)", plain) == sp.Derivative(f, (t, 2), (x, 2))
    assert notation.expression("(x**2*a).at(x, t)", plain) == t**2 * a
    assert notation.expression("1.6*lambda", plain) == sp.Rational(8, 5) * sp.Symbol("lambda")
    assert notation.expression("integral(a, t, f(x,t), x)", plain) == sp.Integral(f, (x, a, t))
    assert notation.condition("a < x < t, t in [a, x]", plain) == sp.And(a < x, x < t, t >= a, t <= x)


@pytest.mark.parametrize("text", ["a +", "diff3(f(x,t), x**2)", "a if b else c", "x[1]", "'a'"])
def test_what_is_not_in_the_notation_is_refused(text):
    with pytest.raises(notation.NotationError):
        notation.expression(text, plain)


@pytest.mark.parametrize("text", ["a + b", "t in (a, b)", "a != b"])
def test_what_is_no_condition_is_refused(text):
    with pytest.raises(notation.NotationError):
        notation.condition(text, plain)


def test_quote_and_notation_have_the_same_signs():
    quote = (
        r"$$v = \left. D \frac{\partial^2 \zeta_z(x,t)}{\partial x \partial t} \right|_{x=x_{xm(t)}}, t \in [t_1, t_4]"
    )
    written = "v = (D*diff2(zeta_z(x,t), x, t)).at(x, x_xm(t)) ; t in [t_1, t_4]"
    assert notation.atoms_of_tex(quote) == notation.atoms_of_notation(written)
    assert notation.atoms_of_tex(quote.replace("^2", "")) != notation.atoms_of_notation(written)
    with pytest.raises(notation.NotationError, match="aleph"):
        notation.atoms_of_tex(r"\aleph_0")
