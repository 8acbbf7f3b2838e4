"""The claims: every reading computed right, every verdict by rule, and figures that others find too."""

from __future__ import annotations

import importlib.util
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from reference import integrate_regions, reference_measures, steady_state
from scipy import stats

import trum_sym as ts
from trum_sym.paper import section_5, section_6, sections_7_to_9
from trum_sym.paper.claims import (
    CONTRADICTED,
    PARTLY,
    REPRODUCED,
    UNDECIDABLE,
    VERDICTS,
    Statement,
    best,
    claims,
    judged,
    reading_rows,
    readings,
    statements,
)
from trum_sym.paper.findings import Context, Finding, falls, rank_correlation, rises, together
from trum_sym.paper.published import TABLE_2
from trum_sym.paper.readings import AXES, DEFAULT, LEADS, LEVELS, MEASURED, PHASES, POINTS, ROTOR_LEVELS

ROOT = Path(__file__).parents[2]
STARTS = ("periodic", "steady", "rest")
FIGURES = {*(f"figure-{n}" for n in (10, 11, 13, 14, 16, 17, 20, 21, 22, 23, "25b", "26b", "27b", 30, 31, 32)),
           "table-2", "table-4", "map-periodic", "contact-zone", "speed-determinant"}  # fmt: skip


@pytest.fixture(scope="module")
def found(trum60):
    return readings(trum60)


@pytest.fixture(scope="module")
def judgements(trum60, found):
    return {claim.id: claim for claim in claims(trum60, found)}


@pytest.fixture(scope="module")
def context(trum60, found):
    return Context(trum60, found)


# --- readings ---------------------------------------------------------------------------------------------------
def test_every_combination_of_the_open_conventions_is_there_once(found, judgements):
    rows = reading_rows(found, list(judgements.values()))
    assert len({tuple(row[axis] for axis in AXES) for row in rows}) == len(rows)
    assert len(rows) == 3 * 2 * 2 * (2 * 2 * (4 * 4 + 1))  # a measured resonance needs no foundation
    assert sorted(row["distance %"] for row in rows) == [row["distance %"] for row in rows]


def evaluated(motor, index, point):
    """The same reading through the public door."""
    start, lead, phase, level = index
    contact, resonance, foundation, amplitude = LEVELS[level]
    drive = ts.Drive(
        start=STARTS[start], phase_lead=LEADS[lead], switching_phase=[*PHASES.values()][phase],
        prepressure=POINTS.prepressure[point], frequency_difference=POINTS.difference[point],
    )  # fmt: skip
    options = {"contact": contact, "resonance": resonance, "foundation": foundation, "amplitude": amplitude}
    if resonance == MEASURED:
        shift = [
            ts.evaluate(motor, ts.Drive(prepressure=F, frequency_difference=d), contact=contact, amplitude=amplitude)
            for F, d in ((drive.prepressure, drive.frequency_difference), (180.0, 3000.0))
        ]
        moved = shift[0].resonance_frequency - shift[1].resonance_frequency
        size = float(shift[0].amplitude)
        motor = motor.with_values({"resonance_frequency": 39703.0 + moved, "amplitude": size})
        options = {"contact": contact}
    return ts.evaluate(motor, drive, **options, tolerance=1e-4, sampling_period=2e-3 if point == 0 else None)


def test_readings_are_what_evaluate_gives(trum60, found):
    rng = np.random.default_rng(11)
    compared = 0
    for k in range(24):
        level = int(rng.choice(ROTOR_LEVELS)) if k % 2 else int(rng.integers(len(LEVELS)))
        point = 0 if k % 3 == 0 else int(rng.integers(POINTS.prepressure.size))
        index = (*(int(rng.integers(n)) for n in (3, 2, 2)), level)
        expected = evaluated(trum60, index, point)
        for name in ("q_average", "q_volatility", "q_square_ratio"):
            assert found.figures[name][*index, point] == pytest.approx(getattr(expected, name), rel=1e-10), (
                index,
                name,
            )
        speed = found.figures["mean_speed"][*index, point]
        if point and level not in ROTOR_LEVELS:
            assert np.isnan(speed)
            continue
        compared += 1
        largest = max(abs(expected.min_speed), abs(expected.max_speed))
        assert speed == pytest.approx(expected.mean_speed, rel=0, abs=2e-4 * largest)
        if point == 0:
            deviation = expected.speed_volatility * abs(expected.mean_speed)
            read = found.encoder_volatility[index] * abs(speed)
            assert read == pytest.approx(deviation, rel=0, abs=1e-3 * largest)
    assert compared > 12


@pytest.mark.parametrize("index", [(2, 1, 0, DEFAULT), (0, 0, 1, DEFAULT), (1, 1, 1, DEFAULT)])
def test_determinants_agree_with_50_digits(found, index):
    start, lead, phase, level = index
    psi, f_n = [*PHASES.values()][phase], found.resonance_frequency[level, 0]
    exact = reference_measures(f_n, 3000.0, 0.006, psi, LEADS[lead], 20, 14, STARTS[start])
    for name, value in zip(("q_average", "q_volatility"), exact[2:], strict=True):
        assert found.figures[name][*index, 0] == pytest.approx(float(value), rel=1e-9)


def test_sums_of_the_determinant_carry_the_amplitude(trum60, found):
    """Q is bilinear in the phases: at 210 N both sums are those of unit phases times D k_c W^2."""
    point = int(np.flatnonzero((POINTS.prepressure == 210) & (POINTS.difference == 3000))[0])
    alone = ts.evaluate(trum60, ts.Drive(prepressure=210.0))
    size = alone.neutral_axis * alone.wavenumber * alone.amplitude**2
    plus, minus = (found.figures[name][0, 0, 0, DEFAULT, point] for name in ("q_plus", "q_minus"))
    assert plus / minus == pytest.approx(alone.q_ratio, rel=1e-12)
    assert (plus - minus) / (plus + minus) / alone.cycle_time == pytest.approx(alone.q_average, rel=1e-10)
    time = (np.arange(200_000) + 0.5) / 200_000 * alone.cycle_time
    from trum_sym.model.cycle import modal_values, response

    values = modal_values(2 * np.pi * alone.resonance_frequency, 0.006, ts.Drive(prepressure=210.0))
    Q = np.asarray(response(time, values)["Q"]) * size
    assert plus == pytest.approx(np.maximum(Q, 0).mean() * alone.cycle_time, rel=1e-6)


def test_the_best_readings_stand_out(found, judgements):
    rows = reading_rows(found, list(judgements.values()))
    stands = best(found, list(judgements.values()))
    assert stands["nearest"]["distance %"] == min(row["distance %"] for row in rows)
    worst = max(abs(stands["nearest"]["q_average off %"]), abs(stands["nearest"]["q_volatility off %"]))
    assert worst == pytest.approx(stands["nearest"]["distance %"])
    assert stands["nearest"]["q_average"] / 1447.5 - 1 == pytest.approx(stands["nearest"]["q_average off %"] / 100)
    most = max(len(row["holds"]) for row in rows if len(row["holds"]) + len(row["fails"]) == 37)
    assert len(stands["claims"]["holds"]) == most


def test_another_motor_is_refused(trum60):
    from dataclasses import replace

    with pytest.raises(ts.ParameterError, match="publishes"):
        readings(replace(trum60, published=()))


# --- verdicts ---------------------------------------------------------------------------------------------------
ONE = Statement("x", "here", "words", "figure-20")
NO, YES = np.zeros((3, 2, 2, 1), bool), np.ones((3, 2, 2, 1), bool)


def some(start, lead):
    holds = NO.copy()
    holds[start, lead] = True
    return holds


@pytest.mark.parametrize(
    ("holds", "verdict", "words"),
    [
        (YES, REPRODUCED, "all 816 readings"),
        (NO, CONTRADICTED, "none of 816 readings"),
        (some(2, 1), PARTLY, "start rest, lead -1"),
        (np.arange(len(LEVELS)) == DEFAULT, PARTLY, "any start and lead; resonance quartic (1 of 16)"),
    ],
)
def test_a_verdict_follows_from_where_a_claim_holds(holds, verdict, words):
    claim = judged(ONE, Finding(holds, ""))
    assert (claim.verdict, claim.conditions) == (verdict, words)


@pytest.mark.parametrize(
    ("holds", "corners", "verdict"),
    [
        (YES, YES, REPRODUCED),
        (some(1, 0), some(1, 0), PARTLY),
        (some(1, 0), NO, UNDECIDABLE),
        (NO, some(1, 0), UNDECIDABLE),
        (some(1, 0), some(0, 0), UNDECIDABLE),
        (NO, NO, CONTRADICTED),
        (YES, some(1, 0), PARTLY),
    ],
)
def test_what_the_paper_does_not_give_must_not_matter(holds, corners, verdict):
    assert judged(ONE, Finding(holds, "", assumed=np.repeat(corners, 4, axis=-1))).verdict == verdict


def test_a_claim_that_holds_at_some_corners_only_is_not_reproduced():
    corners = np.ones((3, 2, 2, 4), bool)
    corners[..., 0] = False
    assert judged(ONE, Finding(YES, "", assumed=corners)).verdict == UNDECIDABLE
    assert judged(ONE, Finding(YES, "", undecidable="not printed")).conditions == "not printed"


def test_the_claims_cover_the_sections_and_are_all_checked(judgements):
    named = [statement.id for statement in statements()]
    assert named == list(judgements)
    assert set(named) == {*section_5.CHECKS, *section_6.CHECKS, *sections_7_to_9.CHECKS}
    assert len(named) >= 25
    assert {claim.place[:7] for claim in judgements.values()} == {f"Sect. {n}" for n in range(5, 10)}
    assert {claim.anchor for claim in judgements.values()} <= FIGURES
    assert {claim.verdict for claim in judgements.values()} == set(VERDICTS)
    for claim in judgements.values():
        assert len(claim.quote) > 5
        assert re.search(r"\d", claim.computed) or claim.verdict == UNDECIDABLE, claim.id
        assert not claim.holds[~claim.known].any()


def test_what_speaks_of_the_rotor_says_that_it_rests_on_assumptions(judgements):
    rotor = {"proportional", "ratio-speed", "box-speed", "box-sigma", "only-determinants", "mechanism", "table-4-range"}
    for name in rotor:
        assert "assumed" in judgements[name].computed, name
    for name in ("speed-difference", "speed-prepressure", "several-sigma", "low-speed", "all-trends"):
        assert "corners of the assumed friction" in judgements[name].conditions, name
    assert "friction coefficient and contact radius" in judgements["table-4-speed"].conditions


# --- measures of a curve ----------------------------------------------------------------------------------------
def test_rank_correlation_is_spearman_s():
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(2, 5, 36))
    expected = [stats.spearmanr(x, y).statistic for x, y in zip(a, b, strict=True)]
    assert rank_correlation(a, b) == pytest.approx(expected, rel=1e-12)
    a[0, 3] = np.nan
    assert np.isnan(rank_correlation(a, b)[0])


def test_trends_count_every_step():
    up, bent = np.array([1.0, 2.0, 3.0]), np.array([1.0, 3.0, 2.0])
    assert rises(np.stack([up, bent])).tolist() == [True, False]
    assert falls(-np.stack([up, bent])).tolist() == [True, False]
    assert together(np.stack([up, up, bent]), np.stack([2 * up, bent, -bent])).tolist() == [True, False, False]


# --- figures that others find too -------------------------------------------------------------------------------
def cycle_by_ode(found, start, lead, n, fractions, difference=3000.0):
    """Q of Sect. 5's cycle, m = 100, from an integrator that knows only the oscillators: (region, fraction)."""
    f_n = np.array([found.resonance_frequency[DEFAULT, 0]])
    begin = np.zeros((4, 1)) if start == "rest" else steady_state(f_n, difference, 0.0, lead, 0.0)
    states, _ = integrate_regions(begin, f_n, difference, 0.006, np.zeros(1), np.full(1, lead), 100, n, fractions)
    w_A, w_B, v_A, v_B = np.moveaxis(states[..., 0], -1, 0)
    return v_A * w_B - v_B * w_A


def test_directions_in_the_regions_by_an_ode_solver(found, context):
    beat = (found.resonance_frequency[DEFAULT, 0] + 3000.0) / 3000.0 / 45  # in T_redu's length
    fractions = (np.arange(4 * 60) + 0.5) / 240 * beat
    Q = cycle_by_ode(found, "steady", 1.0, 55, fractions)
    by_quarter = np.sign(Q[:2].reshape(2, 4, 60).sum(axis=-1))
    assert by_quarter[0].tolist() == [1, -1, -1, 1]
    assert by_quarter[1].tolist() == [-1, -1, -1, 1]  # where the paper has - - + +
    for region, signs in enumerate(by_quarter):
        ours = section_5._quarters(context.beat((100, 55), region, 1.0, 16))
        assert ours[1, 0, 0, 0].tolist() == signs.tolist()


def test_rotation_in_t_add_by_an_ode_solver(found, judgements):
    fractions = (np.arange(50 * 40) + 0.5) / 2000
    rest = cycle_by_ode(found, "rest", 1.0, 75, fractions)[2]
    steady = cycle_by_ode(found, "steady", 1.0, 75, fractions)[2]
    assert (rest < 0).mean() == 0
    assert 0.005 < (steady < 0).mean() < 0.015
    claim = judgements["forward-add"]
    assert claim.verdict == PARTLY
    assert claim.holds[2, 0, 0, DEFAULT]
    assert not claim.holds[1, 0, 0, DEFAULT]
    assert not claim.holds[:, 1].any()  # lead -1 turns the other way


def test_the_speed_at_the_crest_by_its_definition(context):
    """D d2(zeta_z)/dx dt where the slope of zeta_z vanishes, from the phases on a fine grid of places."""
    beat = context.beat((100, 75), 2, 0.2, 16)
    k = np.linspace(-np.pi, np.pi, 40001)
    for i in range(0, beat.Q.shape[-1], 7):
        w_A, w_B, v_A, v_B = (a[0, 0, 0, 0, i] for a in (beat.w_A, beat.w_B, beat.v_A, beat.v_B))
        crest = k[np.argmax(w_A * np.sin(k) + w_B * np.cos(k))]
        speed = v_A * np.cos(crest) - v_B * np.sin(crest)
        scale = np.hypot(v_A, v_B)
        assert speed == pytest.approx(beat.Q[0, 0, 0, 0, i] / np.hypot(w_A, w_B), rel=0, abs=1e-3 * scale)


def number(text, pattern):
    return float(re.search(pattern, text)[1])


def test_beats_and_periods_by_hand(judgements):
    # T_redu is 45 of 42043 Hz, a beat 1/3000 s: 45 * 3000 / 42043.5 = 3.211
    assert number(judgements["beats-redu"].computed, r"([\d.]+) beats of") == pytest.approx(3.21)
    # 1/(45000 - 39703) s
    assert number(judgements["beat-period"].computed, r"= ([\d.]+) ms") == pytest.approx(0.1888)
    assert number(judgements["beat-measured"].computed, r"every ([\d.]+) ms") == pytest.approx(0.189, abs=0.001)
    assert number(judgements["beat-add"].computed, r"every (\d+) us") == pytest.approx(1e6 / 3000, rel=0.02)
    assert number(judgements["cause-add"].computed, r": ([\d.]+) times") == pytest.approx(2.0, abs=0.05)
    # omega_d = omega_n sqrt(1 - xi^2)
    free = number(judgements["power-off"].computed, r"switched off ([\d.]+) Hz")
    assert free == pytest.approx(39703 * np.sqrt(1 - 0.006**2), abs=0.1)
    assert number(judgements["decay"].computed, r"ratio of ([\d.]+)") == pytest.approx(0.006, abs=1e-5)


def test_the_fit_of_table_2_by_another_regression(judgements):
    force, size = np.array([*TABLE_2]), np.array([*TABLE_2.values()])
    line = stats.linregress(np.log(force), np.log(size / 12.6e-6))
    assert number(judgements["fit"].computed, r"C_f = ([\d.]+)") == pytest.approx(np.exp(line.intercept), abs=1e-3)
    assert number(judgements["fit"].computed, r"exponent ([\d.]+)") == pytest.approx(-line.slope, abs=1e-4)


def test_table_4_by_evaluate(trum60, judgements):
    point = ts.evaluate(trum60, ts.Drive(start="rest", phase_lead=-1))
    assert f"rest -1: {point.q_average:.1f} ({100 * (point.q_average / 1447.5 - 1):+.3g} %)" in (
        judgements["table-4-average"].computed
    )
    assert judgements["table-4-average"].holds[2, 1, 0, DEFAULT]
    assert not judgements["table-4-average"].holds[2, 0].any()  # a direction is no magnitude


def test_speed_and_determinant_over_the_box_by_evaluate(trum60, judgements):
    force, difference = np.meshgrid(np.linspace(160, 210, 6), np.linspace(2800, 3300, 6))
    drive = ts.Drive(start="steady", phase_lead=-1, prepressure=force.ravel(), frequency_difference=difference.ravel())
    point = ts.evaluate(trum60, drive, tolerance=1e-5)
    expected = stats.spearmanr(point.mean_speed, point.q_average).statistic
    assert number(judgements["box-speed"].computed, r"steady -1: ([+\-\d.]+)") == pytest.approx(expected, abs=0.01)


def test_trends_by_evaluate(trum60, judgements):
    """Q_aver over the frequency difference, start by start, at other drives in between as well."""
    for i, start in enumerate(STARTS):
        for j, lead in enumerate(LEADS):
            drive = ts.Drive(start=start, phase_lead=lead, frequency_difference=np.linspace(2800, 3300, 6))
            steps = [b - a for a, b in pairwise(np.asarray(ts.evaluate(trum60, drive).q_average))]
            assert judgements["average-difference"].holds[i, j, 0, DEFAULT] == all(step < 0 for step in steps)


# --- the page of the documentation ------------------------------------------------------------------------------
def split(text):
    """Words and numbers of a text, apart."""
    pattern = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
    return re.sub(r"\s+", " ", re.sub(pattern, "#", text)).strip(), [float(n) for n in re.findall(pattern, text)]


def test_the_docs_show_what_the_example_prints(trum60, found, judgements):
    spec = importlib.util.spec_from_file_location("claims_example", ROOT / "examples" / "claims.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    text = (ROOT / "docs" / "claims.md").read_text("utf-8")
    shown = re.search(r"<!-- examples/claims.py -->\n```\n(.*?)```", text, re.DOTALL)[1]
    words, numbers = split(example.text(trum60, found, list(judgements.values())))
    shown_words, shown_numbers = split(shown)
    assert words == shown_words
    assert numbers == pytest.approx(shown_numbers, rel=0.01, abs=0.011)  # another CPU rounds otherwise
