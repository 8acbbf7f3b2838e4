"""The claims: every reading computed right, every verdict by rule, and figures that others find too."""

from __future__ import annotations

import importlib.util
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import scipy
from lazily import lazily
from reference import integrate_regions, reference_measures, steady_state

import trum_sym as ts
from trum_sym.paper import section_5, section_6, sections_1_to_4, sections_7_to_9
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
    varied,
)
from trum_sym.paper.findings import ByInertia, Context, Finding, falls, of_rotor, rank_correlation, rises, together
from trum_sym.paper.published import ENCODER, TABLE_2
from trum_sym.paper.readings import (
    AXES,
    COMBINATIONS,
    DEFAULT,
    LEADS,
    LOAD_INERTIA,
    MEASURED,
    PHASES,
    POINTS,
    ROTOR_LEVELS,
)
from trum_sym.paper.trends import Trend, inertias, trends

orbit_reference = lazily("orbit_reference")
ROOT = Path(__file__).parents[2]
STARTS = ("periodic", "steady", "rest")
NUMBERS = (3, 6, 7, 10, 11, 13, 14, 16, 17, 18, 19, 20, 21, 22, 23, "25b", "26b", "27b", 29, 30, 31, 32)
FIGURES = {
    *(f"figure-{n}" for n in NUMBERS),
    "table-1",
    "table-2",
    "table-4",
    "map-periodic",
    "contact-zone",
    "speed-determinant",
    "coupling-pulses",
}
J = 4.5e-6  # kg m^2, Table 1


@pytest.fixture(scope="module")
def found(trum60):
    return readings(trum60)


@pytest.fixture(scope="module")
def judgements(trum60, found):
    return {claim.id: claim for claim in claims(trum60, found)}


@pytest.fixture(scope="module")
def context(trum60, found):
    return Context(trum60, found)


@pytest.fixture(scope="module")
def followed(context):
    return trends(context)


# --- readings ---------------------------------------------------------------------------------------------------
def test_every_combination_of_the_open_conventions_is_there_once(found, judgements):
    rows = reading_rows(found, list(judgements.values()))
    assert len({tuple(row[axis] for axis in AXES) for row in rows}) == len(rows)
    assert len(rows) == 3 * 2 * 2 * (2 * 2 * (4 * 4 + 1))  # a measured resonance needs no foundation
    assert sorted(row["distance %"] for row in rows) == [row["distance %"] for row in rows]


def evaluated(motor, index, point):
    """The same reading through the public door."""
    start, lead, phase, level = index
    contact, resonance, foundation, amplitude = COMBINATIONS[level]
    drive = ts.Drive(
        start=STARTS[start],
        phase_lead=LEADS[lead],
        switching_phase=[*PHASES.values()][phase],
        prepressure=POINTS.prepressure[point],
        frequency_difference=POINTS.difference[point],
    )
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
    return [ts.evaluate(motor, drive, **options, tolerance=1e-4, sampling_period=p) for p in (None, 2e-3)]


def test_readings_are_what_evaluate_gives(trum60, found):
    rng = np.random.default_rng(11)
    compared = 0
    for k in range(24):
        level = int(rng.choice(ROTOR_LEVELS)) if k % 2 else int(rng.integers(len(COMBINATIONS)))
        point = 0 if k % 3 == 0 else int(rng.integers(POINTS.prepressure.size))
        index = (*(int(rng.integers(n)) for n in (3, 2, 2)), level)
        load = k % 3
        loaded = trum60.with_values({"rotor_inertia": J + (0.0, 1.7e-5, 4e-3)[load]})
        expected, read = evaluated(loaded, index, point)
        for name in ("q_average", "q_volatility", "q_square_ratio"):
            assert found.figures[name][*index, point] == pytest.approx(getattr(expected, name), rel=1e-10), (
                index,
                name,
            )
        speed, own, encoder = (
            found.loaded[name][load, *index, point] for name in ("mean_speed", "speed_volatility", "encoder_volatility")
        )
        if point and level not in ROTOR_LEVELS:
            assert np.isnan(speed)
            continue
        compared += 1
        largest = max(abs(expected.min_speed), abs(expected.max_speed))
        assert speed == pytest.approx(expected.mean_speed, rel=0, abs=2e-4 * largest)
        for mine, other in ((own, expected), (encoder, read)):
            deviation = other.speed_volatility * abs(other.mean_speed)
            assert mine * abs(speed) == pytest.approx(deviation, rel=0, abs=1e-3 * largest)
    assert compared > 12


def test_the_load_s_inertia_is_that_of_a_torque_plate():
    """Half of mass times radius squared: aluminium, 30 mm and 5 mm thick, to steel, 75 mm and 10 mm thick."""
    light, heavy = (rho * np.pi * r**2 * h * r**2 / 2 for rho, r, h in ((2700, 0.030, 5e-3), (7850, 0.075, 10e-3)))
    assert pytest.approx([0.0, light, heavy], rel=0.03) == LOAD_INERTIA


@pytest.mark.parametrize("index", [(2, 1), (0, 0)])
def test_a_loaded_motor_s_speed_and_what_an_encoder_reads_by_an_independent_orbit(trum60, found, index):
    """Matrix exponentials and DOP853 with the heaviest plate's inertia; the readings' mean is the orbit's."""
    start, lead = index
    point = POINTS.figure_21.start if start else POINTS.figure_21.stop - 1
    drive = ts.Drive(
        start=STARTS[start],
        phase_lead=LEADS[lead],
        prepressure=POINTS.prepressure[point],
        frequency_difference=POINTS.difference[point],
    )
    motor = trum60.with_values({"rotor_inertia": J + 4e-3})
    other = orbit_reference.Reference(motor, drive, ts.evaluate(motor, drive, tolerance=1e-6))
    orbit, reads = other.orbit(), orbit_reference.encoder_readings(other, ENCODER)
    at = (2, start, lead, 0, DEFAULT, point)
    assert found.loaded["mean_speed"][at] == pytest.approx(orbit.mean, rel=0, abs=2e-4 * orbit.largest)
    assert reads.mean() == pytest.approx(orbit.mean, rel=1e-4)
    assert found.loaded["encoder_volatility"][at] == pytest.approx(reads.std() / abs(orbit.mean), rel=0.01)


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
    most = max(len(row["holds"]) for row in rows if len(row["holds"]) + len(row["fails"]) == 41)
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
        (np.arange(len(COMBINATIONS)) == DEFAULT, PARTLY, "any start and lead; resonance quartic (1 of 16)"),
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


def test_what_is_measured_is_judged_with_the_load_and_what_is_simulated_without():
    """By hand: holds nowhere without a load and everywhere with it, or the other way round."""
    with_load, without = np.zeros((3, 3, 2, 2, 1), bool), np.zeros((3, 3, 2, 2, 1), bool)
    with_load[1:], without[0] = True, True
    for holds, measured, verdict in (
        (with_load, True, REPRODUCED),
        (with_load, False, CONTRADICTED),
        (without, True, CONTRADICTED),
        (without, False, REPRODUCED),
    ):
        corners = np.repeat(holds, 4, axis=-1)
        claim = judged(ONE, of_rotor(ByInertia(holds, corners, holds[0], corners[0], measured), "", (DEFAULT,)))
        assert claim.verdict == verdict
        assert claim.holds[..., DEFAULT].all() == (verdict == REPRODUCED)
        (row,) = varied([claim])
        assert row.verdicts == tuple(REPRODUCED if h.all() else CONTRADICTED for h in (holds[0], *holds))
        assert set(row.cells[0]) == {"--++" if holds is with_load else "++--"}
        assert (row.by_encoder, row.by_inertia, row.decided) == (False, True, 6)


def test_a_measured_claim_that_one_end_of_the_load_s_inertia_refutes_is_not_reproduced():
    holds = np.ones((3, 3, 2, 2, 1), bool)
    holds[2, :2] = False  # at the greatest inertia two of three starts fail
    none = np.zeros_like(holds)
    claim = judged(ONE, of_rotor(ByInertia(holds, holds, none[0], none[0], measured=True), "", (DEFAULT,)))
    assert claim.verdict == PARTLY
    assert claim.conditions.startswith("start rest, lead +1; start rest, lead -1; at all of 2 corners")
    assert "load's inertia" in claim.conditions
    assert not claim.holds[:2].any()
    holds[2] = False
    claim = judged(ONE, of_rotor(ByInertia(holds, holds, none[0], none[0], measured=True), "", (DEFAULT,)))
    assert claim.verdict == UNDECIDABLE
    (row,) = varied([claim])
    assert (row.by_encoder, row.by_inertia, row.decided) == (True, True, 0)
    assert row.cells[0][0] == "-++-"


def test_a_cell_tells_some_from_all_and_none():
    """One level or one corner that fails, or that alone holds, makes it open and undecided."""
    holds, corners = np.ones((3, 3, 2, 2, 2), bool), np.ones((3, 3, 2, 2, 4), bool)
    holds[1, 0, 0, 0, 1] = False  # a level at the weight's inertia
    corners[2, 1, 0, 1, 3] = False  # a corner at the greatest
    holds[:, 2], corners[:, 2] = False, False
    corners[2, 2, 1, 0, 0] = True
    levels = (DEFAULT, DEFAULT + 1)
    (row,) = varied([judged(ONE, of_rotor(ByInertia(holds, corners, holds[0], corners[0], True), "", levels))])
    assert row.cells == (("++o+", "++++"), ("+++o", "++++"), ("----", "---o"))
    assert row.decided == 3


def test_every_claim_on_the_measured_rotor_is_judged_as_measured(judgements):
    for claim in judgements.values():
        if claim.rotor is not None:
            assert claim.rotor.measured == (claim.place[:7] in ("Sect. 1", "Sect. 8", "Sect. 9")), claim.id
    sections = {claim.place[:7] for claim in judgements.values() if claim.rotor is not None}
    assert sections == {f"Sect. {n}" for n in (1, 4, 6, 8, 9)}
    for name in ("measured-difference-sigma", "several-sigma", "box-sigma", "only-determinants-sigma"):
        assert "of the speed itself, not of what the encoder reads" in judgements[name].computed


def test_the_claims_cover_the_sections_and_are_all_checked(judgements):
    named = [statement.id for statement in statements()]
    assert named == list(judgements)
    checks = (sections_1_to_4.CHECKS, section_5.CHECKS, section_6.CHECKS, sections_7_to_9.CHECKS)
    assert set(named) == {name for part in checks for name in part}
    assert len(named) == sum(len(part) for part in checks) == 80
    assert {claim.place[:7] for claim in judgements.values()} == {f"Sect. {n}" for n in range(1, 10)}
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
    for name in ("several-sigma", "low-speed", "box-speed", "table-4-range", "mechanism"):
        assert "load's inertia (1.7e-05 to 4.0e-03 kg m^2)" in judgements[name].conditions, name
    assert "friction coefficient, contact radius and the load's inertia" in judgements["table-4-speed"].conditions


# --- measures of a curve ----------------------------------------------------------------------------------------
def test_rank_correlation_is_spearman_s():
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(2, 5, 36))
    expected = [scipy.stats.spearmanr(x, y).statistic for x, y in zip(a, b, strict=True)]
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
    line = scipy.stats.linregress(np.log(force), np.log(size / 12.6e-6))
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
    expected = scipy.stats.spearmanr(point.mean_speed, point.q_average).statistic
    assert number(judgements["box-speed"].computed, r"steady -1: ([+\-\d.]+)") == pytest.approx(expected, abs=0.01)


def test_the_encoder_turns_the_volatility_s_trends_without_a_load(trum60, judgements):
    """Fig. 30b and the box from rest, lead -1: the speed's own volatility against what an encoder of 2 ms reads."""
    force, difference = np.meshgrid(np.linspace(160, 210, 6), np.linspace(2800, 3300, 6))
    for name, F, df, own, read in (
        ("measured-difference-sigma", 180.0, np.linspace(2800, 3300, 6), -0.66, 1.00),
        ("box-sigma", force.ravel(), difference.ravel(), -0.27, 0.81),
    ):
        drive = ts.Drive(start="rest", phase_lead=-1, prepressure=F, frequency_difference=df)
        shown = judgements[name].computed.split("; of the speed itself")
        for text, period, expected in zip(reversed(shown), (None, 2e-3), (own, read), strict=True):
            point = ts.evaluate(trum60, drive, sampling_period=period, tolerance=1e-5)
            found = scipy.stats.spearmanr(point.speed_volatility, point.q_volatility).statistic
            assert found == pytest.approx(expected, abs=0.01)
            assert number(text, r"rest -1: ([+\-\d.]+)") == pytest.approx(expected, abs=0.011)


def test_the_load_s_inertia_turns_the_speed_s_trend_from_rest(trum60, followed):
    """v_s and Q_aver over the frequency difference: against each other without a load, together with a heavy plate."""
    drive = ts.Drive(start="rest", phase_lead=-1, frequency_difference=np.linspace(2800, 3300, 6))
    (trend,) = [t for t in followed if (t.start, t.lead, t.variable, t.pair) == ("rest", -1.0, "df", "v_s")]
    turns = []
    for inertia, stated in zip(LOAD_INERTIA, trend.at_ends, strict=True):
        point = ts.evaluate(trum60.with_values({"rotor_inertia": J + inertia}), drive, tolerance=1e-5)
        turns.append(scipy.stats.spearmanr(point.mean_speed, point.q_average).statistic)
        assert stated == pytest.approx(turns[-1], abs=1e-9)
    assert turns == pytest.approx([-0.83, -0.94, 1.0], abs=0.01)
    low = inertias()[np.flatnonzero(inertias() == trend.follows_from)[0] - 1]
    for inertia, together_ in ((low, False), (trend.follows_from, True)):
        point = ts.evaluate(trum60.with_values({"rotor_inertia": J + inertia}), drive, tolerance=1e-5)
        assert (scipy.stats.spearmanr(point.mean_speed, point.q_average).statistic >= 0.9) == together_


def test_a_trend_follows_from_the_last_failure_on():
    values = np.ones(inertias().size)
    assert Trend("rest", 1.0, "df", "v_s", values).follows_from == 0.0
    values[[0, 4]] = 0.5
    assert Trend("rest", 1.0, "df", "v_s", values).follows_from == inertias()[5]
    values[-1] = np.nan
    assert Trend("rest", 1.0, "df", "v_s", values).follows_from is None
    assert set(LOAD_INERTIA) <= set(inertias())


def test_633_and_17_percent_together_are_two_values_for_two_figures(trum60):
    """A load's inertia of 4e-3 kg m^2 and a friction coefficient in its range: both of Table 4's figures."""
    motor = trum60.with_values({"rotor_inertia": J + 4e-3, "friction_coefficient": 0.2369})
    drive = ts.Drive(start="rest", phase_lead=-1)
    near, more = (
        ts.evaluate(motor.with_values({"friction_coefficient": mu}), drive, sampling_period=2e-3, tolerance=1e-6)
        for mu in (0.2368, 0.2370)
    )
    assert near.mean_speed < 633 * np.pi / 648000 < more.mean_speed
    share = (633 * np.pi / 648000 - near.mean_speed) / (more.mean_speed - near.mean_speed)
    deviation = near.speed_volatility * abs(near.mean_speed)
    assert 0 < share < 1
    assert deviation / (633 * np.pi / 648000) == pytest.approx(0.173, rel=0.01)


# --- Sects. 1 to 4 ----------------------------------------------------------------------------------------------
def section_by_hand(h_e, h_t):
    """E I (N m^2) and f_n (Hz) of Table 1's beam: eqs. 1 and 2 by numbers, the quartic of eqs. 3 by its roots."""
    b, h_p, E_p, rho_p, G_p = 8e-3, 0.5e-3, 76.5e9, 7500.0, 22.9e9
    k_t, k_s = h_t / h_e, 72 * 0.8e-3 / 188.4e-3
    E_q, k_d = (1 - k_t) ** 3 * 155e9, 1 - k_t * k_s
    D = (E_q * h_e**2 * b + 2 * E_p * h_p * h_e * b + E_p * h_p**2 * b) / (2 * b * (E_q * h_e + E_p * h_p))
    I_e, I_p = b * (D**3 + (h_e - D) ** 3) / 3, b * ((h_e + h_p - D) ** 3 - (h_e - D) ** 3) / 3
    A_e, A_p = b * h_e, b * h_p
    A, I_z, EI = A_e + A_p, I_e + I_p, E_q * I_e + E_p * I_p
    rho, G = (k_d * 8900 * A_e + rho_p * A_p) / A, (k_d * 46.8e9 * A_e + G_p * A_p) / A
    k, shear = 9 / 0.03, 0.9 * G * A
    # determinant of the harmonic wave in eqs. 3: (shear k^2 - rho A w^2)(EI k^2 + shear - rho I w^2) = (shear k)^2
    squares = np.roots(
        [
            rho * A * rho * I_z,
            -(rho * A * (EI * k**2 + shear) + rho * I_z * shear * k**2),
            shear * k**2 * (EI * k**2 + shear) - (shear * k) ** 2,
        ]
    )
    return EI, np.sqrt(squares.min()) / (2 * np.pi)


def test_teeth_affect_stiffness_and_frequency_by_hand(judgements):
    (EI, f), (bare_EI, bare_f) = section_by_hand(4.5e-3, 2e-3), section_by_hand(2.5e-3, 0.0)
    assert (100 * (EI / bare_EI - 1), 1e-3 * bare_f, 1e-3 * f) == pytest.approx((36.6, 41.69, 38.73), abs=0.05)
    claim = judgements["teeth-stiffness"]
    assert claim.verdict == CONTRADICTED
    assert number(claim.computed, r"N m\^2 \(([+\d.]+) %\)") == pytest.approx(100 * (EI / bare_EI - 1), abs=0.06)
    assert number(claim.computed, r"prepressure ([\d.]+) to") == pytest.approx(1e-3 * bare_f, abs=0.006)
    assert number(claim.computed, r"prepressure [\d.]+ to ([\d.]+) kHz") == pytest.approx(1e-3 * f, abs=0.006)


def peaks(w):
    size = np.abs(w)
    return size[1:-1][(size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])]


def states_by_ode(found, start, n, m, fractions):
    f_n = np.array([found.resonance_frequency[DEFAULT, 0]])
    begin = np.zeros((4, 1)) if start == "rest" else steady_state(f_n, 3000.0, 0.0, 1.0, 0.0)
    states, end = integrate_regions(begin, f_n, 3000.0, 0.006, np.zeros(1), np.ones(1), m, n, fractions)
    return states[..., 0], end


def test_phase_a_does_not_keep_its_amplitude_by_an_ode_solver(found, judgements):
    fractions = (np.arange(50 * 80) + 0.5) / 4000
    f_n = found.resonance_frequency[DEFAULT, 0]
    size = []
    for n, m in ((14, 20), (75, 100)):
        states = states_by_ode(found, "steady", n, m, fractions)[0][2]
        time = (2 * (m - n) + (2 * n - m) * fractions) / (f_n + 3000.0)
        forced = steady_state(f_n, 3000.0, 0.0, 1.0, time)
        turned = (states[:, 2] - forced[2]) / f_n + forced[2] / (f_n + 3000.0)  # each part at its own frequency
        size.append(np.hypot(states[:, 0], turned / (2 * np.pi)))
        assert peaks(states[:, 0]).max() <= size[-1].max() + 1e-3
    low, high = np.min(np.concatenate(size)), np.max(np.concatenate(size))
    assert high == pytest.approx(2.37, abs=0.01)
    claim = judgements["keeps-add"]
    assert claim.verdict == CONTRADICTED
    assert number(claim.computed, r"largest: .*?steady \+1: ([\d.]+)") == pytest.approx(high, abs=0.011)
    assert number(claim.computed, r"least: .*?steady \+1: ([\d.]+)") == pytest.approx(low, abs=0.011)


def test_phases_grow_and_are_constant_as_an_ode_solver_says(found, judgements):
    fractions = (np.arange(8 * 200) + 0.5) / 1600
    states, _ = states_by_ode(found, "steady", 14, 20, fractions)
    assert np.ptp(peaks(states[0, :, 1])) < 0.001  # B in T_redu from a steady start
    assert judgements["steady-other"].holds[1, 0, 0, DEFAULT]
    b_add = peaks(states[2, :, 1])
    assert b_add.argmax() < b_add.size - 1  # B's amplitude turns back before T_add ends
    assert judgements["grows-add"].verdict == CONTRADICTED
    rest, _ = states_by_ode(found, "rest", 14, 20, fractions)
    assert np.all(np.diff(peaks(rest[1, :, 0])) > 0)  # A in T_addredu, from rest
    assert judgements["grows-addredu"].holds[2, 0, 0, DEFAULT]
    f_n = found.resonance_frequency[DEFAULT, 0]
    left = np.exp(-0.006 * 2 * np.pi * f_n * 6 / (f_n + 3000.0))  # of A at the end of T_redu, from a steady start
    assert peaks(states[1, :, 0])[1] < left  # what is left first works against the drive
    assert not judgements["grows-addredu"].holds[1, 0, 0, DEFAULT]


def test_a_is_far_from_its_amplitude_before_it_is_switched_off_as_the_motor_keeps_running(found, judgements):
    f_n = np.array([found.resonance_frequency[DEFAULT, 0]])
    y = np.zeros((4, 1))
    for _ in range(12):  # until the cycle repeats itself
        states, y = integrate_regions(
            y, f_n, 3000.0, 0.006, np.zeros(1), np.ones(1), 20, 14, np.array([1 - 1e-6]), rtol=1e-8
        )
        y = y.reshape(4, 1)
    last = states[2, 0, :, 0]
    forced = steady_state(f_n, 3000.0, 0.0, 1.0, 0.0)[:, 0]
    omega = 2 * np.pi * f_n[0]
    free = complex(last[0] - forced[0], -(last[2] - forced[2]) / omega)
    assert number(judgements["steady-before"].computed, r"periodic \+1: ([\d.]+)") == pytest.approx(
        abs(1 + free), abs=0.03
    )


def test_the_crest_rises_and_falls_by_differences(found, judgements):
    """Rate of the crest's height against the surface's velocity, from the states alone."""
    fractions = (np.arange(8 * 400) + 0.5) / 3200
    states, _ = states_by_ode(found, "steady", 14, 20, fractions)
    f_q = found.resonance_frequency[DEFAULT, 0] + 3000.0
    up, size, weight = 0.0, 0.0, 0.0
    for region, pulses in zip(states, (6, 6, 8), strict=True):
        step = pulses / f_q / fractions.size
        rate = np.gradient(np.hypot(region[:, 0], region[:, 1]), step)
        up += (rate**2).mean() * pulses
        size += (region[:, 2] ** 2 + region[:, 3] ** 2).mean() * pulses
        weight += pulses
    claim = judgements["crest-at-rest"]
    assert claim.verdict == CONTRADICTED
    assert number(claim.computed, r"steady \+1: ([\d.]+)") == pytest.approx(np.sqrt(up / size), abs=0.02)


def test_forward_rotation_is_not_half_of_a_beat_by_an_ode_solver(found, judgements):
    beat = (found.resonance_frequency[DEFAULT, 0] + 3000.0) / 3000.0 / 45
    Q = cycle_by_ode(found, "steady", 1.0, 55, (np.arange(3 * 600) + 0.5) / 600 * beat)
    shares = (Q[:2] > 0).mean(axis=-1)
    text = judgements["half-beat"].computed
    for part, share in zip(text.split("in T_addredu"), shares, strict=True):
        assert number(part, r"steady \+1: ([\d.]+)") == pytest.approx(share, abs=0.011)
    assert judgements["half-beat"].verdict == CONTRADICTED


def test_a_stator_on_its_layer_is_not_linear_by_evaluate(trum60, judgements):
    full, half = (
        ts.evaluate(trum60.with_values({"voltage": volts}), ts.Drive(), amplitude="forced") for volts in (200.0, 100.0)
    )
    claim = judgements["linear-stator"]
    assert claim.verdict == UNDECIDABLE
    ratio = 100 * half.amplitude / full.amplitude
    shift = 100 * (half.resonance_frequency / full.resonance_frequency - 1)
    assert number(claim.computed, r"falls to ([\d.]+) %") == pytest.approx(ratio, abs=0.06)
    assert number(claim.computed, r"moves by ([+\d.]+) %") == pytest.approx(shift, abs=0.06)
    none = COMBINATIONS.index(("winkler", "quartic", "none", "forced"))
    assert claim.holds[..., none].all()
    assert not claim.holds[..., COMBINATIONS.index(("winkler", "quartic", "harmonic", "forced"))].any()


def test_the_metal_s_part_of_the_contact_by_hand(judgements):
    metal, layer = (1 - 0.33**2) / ((1 - 2 / 4.5) ** 3 * 155e9), (1 - 0.3**2) / 5e9  # eq. 26's C_E
    shorter = 100 * (1 - np.sqrt(layer / (metal + layer)))
    assert number(judgements["rigid-metal"].computed, r"is ([\d.]+) % shorter") == pytest.approx(shorter, abs=0.06)


def test_places_as_fast_as_the_rotor_by_the_data_set_of_simulate(trum60, judgements):
    pytest.importorskip("xarray")
    data = ts.simulate(trum60, ts.Drive(), samples_per_period=64, tolerance=1e-4)
    point = ts.evaluate(trum60, ts.Drive())
    kx = np.arctan2(data["w_A"].values, data["w_B"].values)
    from trum_sym.model.cycle import modal_values, response

    values = modal_values(2 * np.pi * point.resonance_frequency, 0.006, ts.Drive(), point.amplitude)
    found = response(data["time"].values, values)
    angle = kx[:, None] + np.linspace(0, 1, 400) * data["theta"].values[:, None]
    speed = np.cos(angle) * np.asarray(found["v_A"])[:, None] - np.sin(angle) * np.asarray(found["v_B"])[:, None]
    slip = point.neutral_axis * point.wavenumber * speed - (data["rotor_speed"].values * 0.0265)[:, None]
    once = ((np.diff(np.sign(slip), axis=1) != 0).sum(axis=1) == 1).mean()
    assert number(judgements["one-point"].computed, r"periodic \+1: (\d+)") == pytest.approx(100 * once, abs=1.5)
    worst = np.cos(data["theta"].values.max())
    assert judgements["equal-curvature"].verdict == CONTRADICTED
    assert number(judgements["equal-curvature"].computed, r"falls to ([+\-\d.]+)") <= worst + 0.01


def test_the_rotor_alone_is_not_what_was_measured_by_evaluate(trum60, judgements):
    alone, loaded = (
        ts.evaluate(
            trum60.with_values({"rotor_inertia": J + inertia}),
            ts.Drive(start="rest", phase_lead=-1),
            sampling_period=2e-3,
            tolerance=1e-5,
        )
        for inertia in (0.0, 1.7e-5)
    )
    speed = 100 * (loaded.mean_speed / alone.mean_speed - 1)
    claim = judgements["rotor-alone"]
    assert claim.verdict == CONTRADICTED
    assert number(claim.computed, r"889 times .*?rest -1: ([+\-\d.]+)") == pytest.approx(speed, abs=0.2)


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


def test_the_docs_show_what_the_example_prints(trum60, found, judgements, followed):
    spec = importlib.util.spec_from_file_location("claims_example", ROOT / "examples" / "claims.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    text = (ROOT / "docs" / "claims.md").read_text("utf-8")
    shown = re.search(r"<!-- examples/claims.py -->\n```\n(.*?)```", text, re.DOTALL)[1]
    words, numbers = split(example.text(trum60, found, list(judgements.values()), followed))
    shown_words, shown_numbers = split(shown)
    assert words == shown_words
    assert numbers == pytest.approx(shown_numbers, rel=0.01, abs=0.011)  # another CPU rounds otherwise


# --- a claim that no reading decides ------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("settings", "verdict", "words"),
    [
        ({"a": True, "b": True}, REPRODUCED, "at a; b; 2 of 2 settings"),
        ({"a": False, "b": True}, PARTLY, "at b; 1 of 2 settings"),
        ({"a": False, "b": False}, CONTRADICTED, "at none; 0 of 2 settings"),
    ],
)
def test_a_claim_apart_from_the_readings_is_judged_by_its_settings(settings, verdict, words):
    claim = judged(ONE, Finding(False, "computed", settings=settings))
    assert (claim.verdict, claim.conditions) == (verdict, words)
    assert not claim.known.any()


def test_pulses_are_steadier_than_bursts_only_as_an_encoder_reads_a_plate(judgements):
    """What the study of all drives has, by other roots and other code, is printed in docs/coupling.md."""
    claim = judgements["steadier"]
    assert claim.verdict == PARTLY
    held = claim.conditions.removeprefix("at ").split("; ")
    assert held == [
        *(f"an encoder of 2 ms, with the bench's plate, bursts of 20, {mean} arcsec/s" for mean in (100, 1000)),
        "2 of 24 settings",
    ]
    text = (ROOT / "docs" / "coupling.md").read_text("utf-8")
    for place, name in (("alone", "the rotor alone"), ("plate", "with the bench's plate")):
        printed = {
            drive: re.split(r"\s{2,}", re.search(rf"^flange {place} 0 +{drive}  +(.*)$", text, re.MULTILINE)[1])
            for drive in ("pulses, 14 of 20", "bursts of 1", "bursts of 20")
        }
        for reading, column in (("the speed itself", 2), ("an encoder of 2 ms", 6)):
            for on in (1, 20):
                said = re.search(
                    f"{reading}, {name}, bursts of {on}, 100 arcsec/s: (.*?) / ([0-9.e+]*)", claim.computed
                )
                pulses, bursts = (float(printed[d][column]) for d in ("pulses, 14 of 20", f"bursts of {on}"))
                assert float(said[1]) == pytest.approx(pulses, rel=0.06)
                assert float(said[2]) == pytest.approx(bursts, rel=0.06)
