"""Q, Q_aver and Q_vib against 50-digit sums, closed forms and their own refinement."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from reference import reference_measures

import trum_sym as ts
from trum_sym.model.cycle import PANELS_PER_PERIOD, cycle_sums, modal_values

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")  # friction from none to any

STARTS = ("periodic", "steady", "rest")
MEASURES = ("q_ratio", "q_square_ratio", "q_average", "q_volatility")
TABLE_3 = {"f_n": 39703.0, "df": 3000.0, "xi": 0.006, "psi": 0.0, "s": 1, "m": 20, "n": 14}


def compiled(f_n, df, xi, psi, s, m, n, start, panels=PANELS_PER_PERIOD):
    drive = ts.Drive(frequency_difference=df, periods=m, on_periods=n, start=start, switching_phase=psi, phase_lead=s)
    return cycle_sums(modal_values(2 * np.pi * np.asarray(f_n), xi, drive), panels)


def random_point(seed):
    rng = np.random.default_rng(seed)
    m = int(rng.integers(4, 31))
    return {
        "f_n": float(rng.uniform(20e3, 60e3)),
        "df": float(rng.uniform(-5e3, 5e3)),
        "xi": float(rng.uniform(1e-3, 0.1)),
        "psi": float(rng.uniform(-3, 3)),
        "s": int(rng.choice([-1, 1])),
        "m": m,
        "n": int(rng.integers((m + 1) // 2, m)),
    }


def agrees_with_50_digits(point, start, tolerance=1e-12):
    ours = compiled(**point, start=start)
    with mp.workdps(50):
        X, Y, average, volatility = reference_measures(**point, start=start)
        T = point["m"] / (mp.mpf(point["f_n"]) + mp.mpf(point["df"]))
        # Q_aver as a share of 1/T, and Q_vib with what its denominator Y - 1 and X - 1 cancel
        assert abs(ours["q_average"] - average) * T < tolerance
        loss = max(1, abs((Y + 1) / (Y - 1)), abs((X + 1) / (X - 1)))
        assert abs(ours["q_volatility"] / volatility - 1) < tolerance * loss
        for name, ratio in (("q_ratio", X), ("q_square_ratio", Y)):  # compared as shares of the whole, in [0, 1]
            assert abs(1 / (1 + ours[name]) - 1 / (1 + ratio)) < tolerance


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("s", [1, -1])
def test_table_3_agrees_with_50_digits_to_1e_12(start, s):
    agrees_with_50_digits({**TABLE_3, "s": s}, start)


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("seed", range(4))
def test_random_points_agree_with_50_digits(start, seed):
    agrees_with_50_digits(random_point(seed), start)


@pytest.mark.slow
@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("seed", range(4, 44))
def test_many_random_points_agree_with_50_digits(start, seed):
    agrees_with_50_digits(random_point(seed), start)


@pytest.mark.parametrize("count", [150, pytest.param(3000, marks=pytest.mark.slow)])
def test_halving_the_step_changes_nothing(count):
    rng = np.random.default_rng(2)
    m = rng.integers(2, 101, count)
    point = {
        "f_n": rng.uniform(20e3, 60e3, count),
        "df": rng.uniform(-5e3, 5e3, count),
        "xi": rng.uniform(0, 0.1, count),
        "psi": rng.uniform(-3, 3, count),
        "s": rng.choice([-1, 1], count),
        "m": m,
        "n": np.array([rng.integers((p + 1) // 2, p + 1) for p in m]),
    }
    for start in STARTS:
        coarse, fine = compiled(**point, start=start), compiled(**point, start=start, panels=8)
        T = m / (point["f_n"] + point["df"])
        assert np.max(np.abs(fine["q_average"] - coarse["q_average"]) * T) < 1e-11
        with np.errstate(all="ignore"):
            change = np.abs(fine["q_volatility"] / coarse["q_volatility"] - 1)
            Y, X = coarse["q_square_ratio"], coarse["q_ratio"]
            loss = np.maximum(np.abs((Y + 1) / (Y - 1)), np.abs((X + 1) / (X - 1)))
        usable = np.isfinite(loss) & (loss < 1e6)
        assert usable.mean() > 0.8
        assert np.max((change / loss)[usable]) < 1e-11


def test_a_plain_travelling_wave_always_turns_one_way():
    for s in (1, -1):
        point = compiled(f_n=39e3, df=3e3, xi=0.006, psi=0.0, s=s, m=20, n=20, start="steady")
        T = 20 / 42e3
        assert point["q_average"] == pytest.approx(s / T, rel=1e-14)
        assert point["q_volatility"] == pytest.approx(s / T, rel=1e-14)
        assert point["q_ratio"] == (np.inf if s == 1 else 0.0)


def test_reversing_the_phase_lead_mirrors_the_motion_at_switching_phases_0_and_90_degrees():
    for psi in (0.0, np.pi / 2):
        forward, backward = (compiled(**{**TABLE_3, "psi": psi, "s": s}, start="periodic") for s in (1, -1))
        assert backward["q_average"] == pytest.approx(-forward["q_average"], rel=1e-11)
        assert backward["q_ratio"] == pytest.approx(1 / forward["q_ratio"], rel=1e-11)


def test_average_does_not_depend_on_what_cancels():
    motor = ts.load_motor()
    base = ts.evaluate(motor)
    scaled = ts.evaluate(
        motor.with_values(
            {
                "amplitude": 1e-6,
                "neutral_axis": 1e-3,
                "wavenumber": 100.0,
                "resonance_frequency": base.resonance_frequency,
            }
        )
    )
    assert scaled.q_average == pytest.approx(base.q_average, rel=1e-12)
    assert scaled.q_volatility == pytest.approx(base.q_volatility, rel=1e-12)


def test_determinant_is_crest_height_times_tangential_velocity():
    from trum_sym.model.cycle import response

    D, k = 2.9e-3, 300.0
    drive = ts.Drive(start="rest", switching_phase=0.3)
    values = modal_values(2 * np.pi * 39e3, 0.006, drive, amplitude=5e-6)
    time = np.linspace(1e-6, 20 / 42e3, 400, endpoint=False)
    out = response(time, values, D, k)
    x = np.arctan2(out["w_A"], out["w_B"]) / k
    height = out["w_A"] * np.sin(k * x) + out["w_B"] * np.cos(k * x)
    velocity = D * k * (out["v_A"] * np.cos(k * x) - out["v_B"] * np.sin(k * x))
    assert np.all(height >= 0)
    assert out["Q"] == pytest.approx(height * velocity, rel=1e-9, abs=1e-12 * np.abs(out["Q"]).max())
