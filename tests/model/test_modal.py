"""Modal responses against an ODE solver, continuity, and the three starts."""

from __future__ import annotations

import numpy as np
import pytest
from reference import integrate_regions, steady_state

import trum_sym as ts
from trum_sym.model.cycle import modal_values, response
from trum_sym.model.kernels import call

STARTS = ("periodic", "steady", "rest")
FRACTIONS = (0.0, 0.137, 0.5, 0.83)


def random_drives(count, seed, most_periods=200):
    rng = np.random.default_rng(seed)
    m = rng.integers(2, most_periods + 1, count)
    n = np.array([rng.integers((p + 1) // 2, p + 1) for p in m])
    return {
        "f_n": rng.uniform(20e3, 60e3, count),
        "df": rng.uniform(-5e3, 5e3, count),
        "xi": np.where(rng.random(count) < 0.1, 0.0, rng.uniform(0, 0.1, count)),
        "psi": rng.uniform(-np.pi, np.pi, count),
        "s": rng.choice([-1.0, 1.0], count),
        "m": m,
        "n": n,
    }


def values_of(d, start):
    drive = ts.Drive(
        frequency_difference=d["df"],
        periods=d["m"],
        on_periods=d["n"],
        start=start,
        switching_phase=d["psi"],
        phase_lead=d["s"],
    )
    return modal_values(2 * np.pi * d["f_n"], d["xi"], drive)


def region_edges(values):
    regions = call("trum_regions", values)
    return np.cumsum([np.zeros_like(values["omega_n"])] + [regions[f"time_{r}"] for r in ("redu", "addredu", "add")], 0)


def state_at(time, values):
    out = response(time, values)
    return np.stack([out["w_A"], out["w_B"], out["v_A"], out["v_B"]])


def next_cycle(values):
    """The free motion at the cycle's end begins the next one."""
    end = call("trum_regions", values)
    return {**values, **{k: end[f"{k}_end"] for k in ("a_A", "b_A", "a_B", "b_B")}}


def largest_error(drives, start, cycles=3):
    """Of w/W and v/(omega_q W), against DOP853 run through consecutive cycles, relative to the largest state."""
    values = values_of(drives, start)
    scale = np.stack([np.ones_like(drives["f_n"])] * 2 + [2 * np.pi * (drives["f_n"] + drives["df"])] * 2)
    if start == "rest":
        y = np.zeros_like(scale)
    elif start == "steady":
        y = steady_state(drives["f_n"], drives["df"], drives["psi"], drives["s"], 0.0)
    else:
        y = state_at(0.0, values)
    worst = 0.0
    for _ in range(cycles):
        seen, y = integrate_regions(y, **drives, fractions=FRACTIONS)
        edges = region_edges(values)
        size = np.maximum(1.0, np.abs(seen / scale).max(axis=(0, 1, 2)))
        for r in range(3):
            for i, fraction in enumerate(FRACTIONS):
                time = edges[r] + fraction * (edges[r + 1] - edges[r])
                if fraction == 0.0 and r > 0:
                    time = np.nextafter(time, np.inf)
                worst = max(worst, np.max(np.abs((state_at(time, values) - seen[r, i]) / scale) / size))
        values = next_cycle(values)
    return worst


@pytest.mark.parametrize("start", STARTS)
def test_three_consecutive_cycles_follow_the_ode_for_random_drives(start):
    assert largest_error(random_drives(16, seed=7, most_periods=24), start) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("start", STARTS)
def test_three_consecutive_cycles_follow_the_ode_for_200_random_drives(start):
    error = largest_error(random_drives(200, seed=11), start)
    print(f"{start}: {error:.2e}")
    assert error < 1e-9


def test_periodic_start_repeats_itself():
    drives = random_drives(2000, seed=3)
    values = values_of(drives, "periodic")
    again = next_cycle(values)
    omega_q = 2 * np.pi * (drives["f_n"] + drives["df"])
    for phase in "AB":
        size = np.hypot(values[f"a_{phase}"], values[f"b_{phase}"] / omega_q) + 1.0
        assert np.max(np.abs(again[f"a_{phase}"] - values[f"a_{phase}"]) / size) < 1e-12
        assert np.max(np.abs(again[f"b_{phase}"] - values[f"b_{phase}"]) / omega_q / size) < 1e-12


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_cycles_from_any_start_settle_into_the_periodic_state(start):
    drive = {"f_n": 39e3, "df": 3e3, "xi": 0.006, "psi": 0.4, "s": 1.0, "m": 20, "n": 14}
    values, target = values_of(drive, start), values_of(drive, "periodic")
    for _ in range(60):
        values = next_cycle(values)
    assert values["a_A"] == pytest.approx(target["a_A"], abs=1e-12)
    assert values["b_B"] == pytest.approx(target["b_B"], rel=1e-9)


def test_displacement_and_velocity_are_continuous_at_every_switching():
    drives = random_drives(500, seed=5)
    for start in STARTS:
        values = values_of(drives, start)
        edges = region_edges(values)
        omega = 2 * np.pi * (drives["f_n"] + np.abs(drives["df"]))
        for edge in edges[1:3]:
            before, after = state_at(np.nextafter(edge, 0), values), state_at(np.nextafter(edge, 1), values)
            scale = np.stack([np.ones_like(omega)] * 2 + [omega] * 2)
            size = np.maximum(1.0, np.abs(before / scale).max(axis=0))
            assert np.max(np.abs(after - before) / scale / size) < 1e-10


def test_rest_starts_with_no_motion_and_steady_with_full_motion():
    drive = {"f_n": 39e3, "df": 3e3, "xi": 0.006, "psi": 0.4, "s": -1.0, "m": 20, "n": 14}
    assert np.abs(state_at(0.0, values_of(drive, "rest"))).max() < 1e-10
    expected = steady_state(39e3, 3e3, 0.4, -1.0, 0.0)
    assert state_at(0.0, values_of(drive, "steady")) == pytest.approx(expected, rel=1e-14)


def test_a_phase_that_is_off_from_rest_stays_at_rest():
    drive = {"f_n": 39e3, "df": 3e3, "xi": 0.006, "psi": 0.4, "s": 1.0, "m": 20, "n": 14}
    values = values_of(drive, "rest")
    time = np.linspace(0, 0.999 * region_edges(values)[1], 50)
    assert np.abs(response(time, values)["w_A"]).max() < 1e-13


def test_without_switching_the_periodic_state_is_the_steady_wave():
    drive = {"f_n": 39e3, "df": -2e3, "xi": 0.01, "psi": 1.1, "s": 1.0, "m": 12, "n": 12}
    time = np.linspace(0, 12 / 37e3, 40)
    out = response(time, values_of(drive, "periodic"))
    assert out["w_A"] == pytest.approx(np.cos(2 * np.pi * 37e3 * time + 1.1), abs=1e-12)
    assert out["w_B"] == pytest.approx(-np.sin(2 * np.pi * 37e3 * time + 1.1), abs=1e-12)
    assert out["Q"] == pytest.approx(2 * np.pi * 37e3, rel=1e-12)
