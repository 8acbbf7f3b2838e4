"""Effects by roots and converged integrals, held against a second route; statements as theorems; assumptions."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy
from lazily import lazily

sp = lazily("sympy")
ledger = lazily("derivations.ledger")
assumptions = lazily("derivations.ledger.assumptions")
check_effects = lazily("derivations.ledger.check_effects")
circular = lazily("derivations.ledger.circular")
claims = lazily("derivations.ledger.claims")
claims_appendix_c = lazily("derivations.ledger.claims_appendix_c")
command = lazily("derivations.ledger.command")
conditions = lazily("derivations.ledger.conditions")
course = lazily("derivations.ledger.course")
figures = lazily("derivations.ledger.figures")
history = lazily("derivations.ledger.history")
model = lazily("derivations.ledger.model")
operating = lazily("derivations.ledger.operating")
second_route = lazily("derivations.ledger.second_route")
section_4_nonsliding = lazily("derivations.ledger.section_4_nonsliding")
witness = lazily("derivations.ledger.witness")
section = lazily("derivations.section")
transfer = lazily("derivations.transfer")
section_7 = lazily("derivations.ledger.section_7")

ROOT = Path(__file__).parents[2]


# --- exact shares, means and extremes -----------------------------------------------------------------------
def tone(h):
    return np.cos(2 * np.pi * h.time / course.Lap().length)


def test_shares_and_means_of_a_known_tone():
    lap = course.Lap()
    assert course.share(lambda h: tone(h) - 0.5, lap) == pytest.approx(1 / 3, abs=1e-12)
    assert course.zeros(tone, lap) / lap.length == pytest.approx([0.25, 0.75], abs=1e-12)
    assert course.mean(lambda h: np.maximum(0, tone(h)), lap, [tone]) == pytest.approx(1 / np.pi, rel=1e-12)
    assert course.extremes(tone, lap) == pytest.approx((-1, 1), abs=1e-14)
    kinds = course.shares(lambda h: ["high" if v > 0.5 else "low" for v in tone(h)], lap, [lambda h: tone(h) - 0.5])
    assert kinds == pytest.approx({"low": 2 / 3, "high": 1 / 3}, abs=1e-12)


def test_a_stretch_is_cut_where_a_phase_is_switched():
    edges = history.region_edges()
    stretch = course.Lap("steady", low=edges[1] / 2, high=edges[2])
    assert stretch.spans == [(edges[1] / 2, edges[1]), (edges[1], edges[2])]
    assert stretch.length == pytest.approx(edges[2] - edges[1] / 2)


def test_an_integral_that_does_not_stand_still_is_refused(monkeypatch):
    with pytest.raises(ArithmeticError, match="still changes"):
        course.integral(lambda h: np.random.default_rng(h.time.size).normal(size=h.time.size), course.Lap())
    monkeypatch.setattr("derivations.ledger.course._on_panels", lambda *_: (1.0, 1.0))
    assert course.integral(tone, course.Lap()) == 1.0


def test_the_mean_climb_of_the_crest_is_the_change_of_its_height():
    lap = course.Lap("steady")
    ends = lap.at(np.array([0.0, lap.length])).W_c
    assert course.mean(lambda h: h.W_c_rate, lap) * lap.length == pytest.approx(ends[1] - ends[0], rel=1e-6)


# --- the second route ---------------------------------------------------------------------------------------
def test_the_witness_is_the_oscillator():
    drive = witness.Drive("rest")
    own, q, xi, W = (float(witness.stator()[name]) for name in ("f_n", "f_q", "xi", "W"))
    own, q = 2 * np.pi * own, 2 * np.pi * q
    end = 6 / (q / (2 * np.pi))

    def rate(time, y):  # B driven from rest, a quarter ahead
        force = np.real((own**2 - q**2 + 2j * xi * own * q) * 1j * W * np.exp(1j * q * time))
        return [y[1], force - 2 * xi * own * y[1] - own**2 * y[0]]

    found = scipy.integrate.solve_ivp(rate, (0, 0.99 * end), [0, 0], rtol=1e-11, atol=1e-18)
    states = drive.phases(np.array([0.99 * end]))
    assert states.w_B[0] == pytest.approx(found.y[0, -1], rel=1e-7)
    assert states.w_A[0] == pytest.approx(0, abs=1e-20)


def test_witness_and_ledger_agree_on_the_cycle():
    for start in ("periodic", "steady"):
        h = history.history(start, 500)
        s = witness.Drive(start).phases(h.time)
        for name in ("w_A", "w_B", "v_A", "v_B"):
            column = getattr(h, name)
            assert getattr(s, name) == pytest.approx(column, abs=1e-9 * np.abs(column).max())


def test_every_entry_with_figures_has_a_second_route_and_no_other():
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    assert {r["id"] for r in records if r["effect_figures"]} == set(second_route.SECOND_ROUTES)


SAMPLE = (
    "1 equivalent-beam layered-section 5 6 7 13 14 15 20 23 26 31 34 45 table-1-heights table-2 table-5 A13 "
    "claim-proportional claim-add-beat 3 A4"
)


@pytest.mark.parametrize("name", SAMPLE.split())
def test_the_second_route_finds_the_printed_figures(name):
    for found in check_effects.check([ledger.entry(name)]):
        assert isinstance(found, check_effects.Checked), found
        assert found.holds, found


def test_a_figure_off_by_a_digit_is_noticed(monkeypatch, capsys):
    true = list(second_route.SECOND_ROUTES["27"]())
    monkeypatch.setitem(second_route.SECOND_ROUTES, "27", lambda: [float(true[0]) + 1e-3])
    assert command.check_effects((ledger.entry("27"),)) == 1
    assert "(27) states 1.266" in capsys.readouterr().out
    monkeypatch.setitem(second_route.SECOND_ROUTES, "27", list)
    assert command.check_effects((ledger.entry("27"),)) == 1
    assert "has 1 figures, the second route 0" in capsys.readouterr().out


def test_a_number_that_nothing_computes_is_noticed():
    honest = ledger.entry("27")
    typed = replace(honest, effect=lambda: f"{honest.effect()} It is 41.7 % off eq. 31 and Table 3, at 180 N.")
    problems = [found for found in check_effects.check([typed]) if isinstance(found, str)]
    assert problems == ["(27) states 41.7, which nothing computes"]
    assert check_effects.uncounted("Of eqs. 22 and 23, (A4), W^2 and 1/s: 7.5", []) == ["7.5"]


def test_figures_are_recorded_with_their_last_digit():
    with figures.recorded() as seen:
        assert figures.figure(2 / 3, 3) + figures.figure(1234.5, spec="+.1f") == "0.667+1234.5"
    assert [f.half_digit for f in seen] == pytest.approx([0.0005, 0.05])
    assert figures.Figure("1.2e-05", 0).half_digit == pytest.approx(5e-7)
    assert figures.figure(1) == "1"  # outside nothing is kept
    assert len(seen) == 2


def test_an_effect_names_what_it_was_computed_with():
    for e in ledger.ENTRIES:
        if e.id in conditions.ABOUT_A_CYCLE:
            about = conditions.effect_at(e.id, "1 N")
            assert about is not None
            assert about["phase_lead"] == "+1"
            assert set(about["start"].split(", ")) <= {"periodic", "steady", "rest"}
            assert {"prepressure", "frequency_difference", "pulses", "resonance", "foundation", "contact"} <= set(about)
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    for r in records:
        if r["id"] in conditions.ABOUT_A_CYCLE:
            assert any(start in r["effect"] for start in ("periodic", "steady")), r["id"]


# --- checks of a thing against itself -----------------------------------------------------------------------
@pytest.mark.parametrize("name", ["1", "20", "42", "45", "table-2", "claim-half-beat", "A5"])
def test_no_evidence_compares_a_thing_with_itself(name):
    shifted, blind = circular.unnoticed(ledger.entry(name))
    assert blind == []
    assert shifted >= 0


def test_a_check_of_a_thing_against_itself_is_found():
    """A figure derived and judged by the very same function, as the entry on half of the beat once was."""
    value = section_7._value_ms
    period = ledger.entry("45").printed["T_redu"]

    def derive():
        return model.Derivation((model.Step("premise"),), {"beat": sp.Float(section_7._value_ms(period))})

    def judge(forms):
        yield model.Evidence("numeric", abs(float(forms["beat"]) - section_7._value_ms(period)) < 1e-6, "")

    planted = replace(ledger.entry("45"), verdict="reconstructed", printed={}, units={}, derive=derive, judge=judge)
    assert circular.unnoticed(planted) == (1, ["ledger.section_7._value_ms"])
    assert section_7._value_ms is value

    def honest(forms):
        yield model.Evidence(
            "numeric", abs(float(forms["beat"]) * 5.297 - 1 + 0 * section_7._value_ms(period)) < 1e-6, ""
        )

    assert circular.unnoticed(replace(planted, judge=honest)) == (1, [])


# --- statements ---------------------------------------------------------------------------------------------
def test_forward_never_takes_half_of_a_beat_of_T_addredu():
    """The slow vectors' theorem over many drives, and its value for Sect. 5's by an ODE-free count of the exact Q."""
    for difference in (1500.0, 2200.0, 3000.0, 4100.0, 5200.0):
        for pulses in (30, 45, 77):
            assert 0 <= claims._slow_share(difference, pulses, periods=1) < 0.5
    exact = claims._measured_shares()
    assert claims._slow_share(3000.0, 45) == pytest.approx(exact["share_addredu"], abs=0.01)
    assert exact["share_redu"] == pytest.approx(0.5, abs=0.01)


def test_Y_below_1_does_not_tell_the_sign_of_Q_aver():
    Q = witness.Drive("periodic", 100, 55, 4000.0, -1).phases().q
    X, Y = (np.maximum(Q, 0) ** p for p in (1, 2)), (np.maximum(-Q, 0) ** p for p in (1, 2))
    ratios = [float(a.sum() / b.sum()) for a, b in zip(X, Y, strict=True)]
    assert ratios == pytest.approx([1.368, 0.898], abs=5e-4)


def test_the_beat_of_T_add_is_one_for_both_entries():
    redu = sp.Symbol("Delta_omega_redu", real=True)
    stands = ledger.entry("15").subject()["T_add"]
    beat = ledger.entry("claim-add-beat").subject()["T_beat"]
    values_ = {s: {"omega_q": 3, "omega_n": 2}.get(s.name, 1) for s in beat.free_symbols | stands.free_symbols | {redu}}
    assert stands.subs(values_) == beat.subs(values_) == 2 * sp.pi


def test_the_doubled_half_is_the_whole_where_the_wave_is_even_or_all_of_the_contact_slides_one_way():
    symbols = (transfer.phi, transfer.c, transfer.theta)
    forms = transfer.friction_fraction(), transfer.half_zone_fraction()
    whole, half = (sp.lambdify(symbols, form, "numpy") for form in forms)
    rng = np.random.default_rng(36)
    angle, ratio, zone = rng.uniform(-np.pi, np.pi, 4000), rng.uniform(-1, 1, 4000), rng.uniform(0.1, 3.1, 4000)
    assert half(0 * angle, ratio, zone) == pytest.approx(whole(0 * angle, ratio, zone), abs=1e-12)
    gap = np.abs(half(angle, ratio, zone) - whole(angle, ratio, zone))
    saturated = np.abs(whole(angle, ratio, zone)) > 1 - 1e-12
    assert gap[saturated].max() < 1e-12
    assert saturated.sum() > 100
    assert (gap[~saturated] > 1e-6).mean() > 0.99  # elsewhere it is another force


def test_half_of_all_phases_leave_the_stated_range_whatever_the_speed():
    for ratio in np.linspace(-1, 1, 41):
        assert section_4_nonsliding._left_34(float(ratio)) == pytest.approx(0.5, abs=1e-12)


def test_any_two_positive_numbers_are_X_and_Y_of_some_Q():
    for X, Y in ((2.0, 0.55), (0.5, 1.9), (7.0, 0.01), (0.02, 30.0)):
        weights, Q = claims_appendix_c._cycles(X, Y)
        ahead, back = np.maximum(Q, 0), np.maximum(-Q, 0)
        assert weights @ ahead / (weights @ back) == pytest.approx(X)
        assert weights @ ahead**2 / (weights @ back**2) == pytest.approx(Y)


def test_a_rotor_without_load_follows_the_crest_nearly():
    p = history.values()
    assert claims._power_at(p["W"], p["F_c"]) == pytest.approx(1.0057, abs=3e-4)
    short = claims._balanced(1e-3)
    assert (1 - short) / 1e-6 == pytest.approx((2 * np.sin(np.pi / 18)) ** 2 / 2, rel=1e-3)


# --- the section in layers ----------------------------------------------------------------------------------
def test_the_layers_axis_by_hand():
    # moduli 155 and 76.5 GPa, heights 2 to 4.5 mm and 4.5 to 5 mm, equal widths
    weight = 155 * 2.5, 76.5 * 0.5
    by_hand = (weight[0] * 3.25 + weight[1] * 4.75) / sum(weight)
    found = operating.stator(180, layered=True)
    assert float(found["D"]) * 1e3 == pytest.approx(by_hand, rel=1e-12)
    own = 155 * 2.5**3 / 12 + 76.5 * 0.5**3 / 12
    about = own + weight[0] * (3.25 - by_hand) ** 2 + weight[1] * (4.75 - by_hand) ** 2
    assert float(found["E"] * found["I_z"]) == pytest.approx(8 * about * 1e9 * 1e-12, rel=1e-12)
    assert 100 * (float(operating.operating_point()["D"] / found["D"]) - 1) == pytest.approx(-15.6, abs=0.05)


def test_the_layers_stiffness_is_least_about_their_axis():
    D = sp.Symbol("D")
    layers = section.layered()
    own = next(s for s in layers["EI"].free_symbols if s.name == "D")
    assert sp.factor(layers["EI"].diff(own).subs(own, layers["D"])) == 0
    assert D not in layers["D"].free_symbols


# --- assumptions --------------------------------------------------------------------------------------------
def test_the_page_of_assumptions_is_what_is_computed_now():
    assert (ROOT / "docs" / "assumptions.md").read_text("utf-8") == assumptions.page()


def test_assumptions_bear_on_entries_and_stand_in_the_ledger():
    known = {e.id for e in ledger.ENTRIES}
    records = {r["id"]: r for r in json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))}
    for one in assumptions.ASSUMPTIONS:
        assert set(one.about) <= known
        for name in one.about:
            assert one.id in [a["id"] for a in records[name]["assumptions"]]
    assert records["1"]["assumptions"] == assumptions.assumptions_of("1")


def test_the_rig_turns_200_times_the_rotors_inertia():
    assert assumptions._rig_inertia() / history.values()["J"] == pytest.approx(204, abs=1)


def test_every_alternative_changes_something():
    for one in assumptions.ASSUMPTIONS:
        rows = assumptions.assumptions_of(one.about[0])
        (record,) = (r for r in rows if r["id"] == one.id)
        assert record["outcomes"] or record["estimate"]
        seen = [tuple(v for k, v in row.items() if k != "what") for row in record["outcomes"]]
        assert len(set(seen)) == len(seen), one.id
