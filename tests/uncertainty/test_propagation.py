"""Sobol indices, quantiles and probabilities against functions whose own are known exactly."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy
from refusals import refusal

from trum_sym.uncertainty.propagation import propagate, share

WEIGHTS = np.array([0.0, 1.0, 4.5, 9.0])


def unit(share):
    return scipy.stats.uniform().ppf(share)


def turn(share):
    return scipy.stats.uniform(-np.pi, 2 * np.pi).ppf(share)


def ishigami(point):
    x1, x2, x3 = (point[name] for name in ("x1", "x2", "x3"))
    return {"y": np.sin(x1) + 7 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1)}


def ishigami_indices():
    """Ishigami and Homma (1990), a = 7, b = 0.1: variances of x1, x2 and of x1 with x3, over their sum."""
    one, two, both = (1 + 0.1 * np.pi**4 / 5) ** 2 / 2, 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    whole = one + two + both
    return {"x1": (one / whole, (one + both) / whole), "x2": (two / whole,) * 2, "x3": (0.0, both / whole)}


def g_function(point):
    factors = [(abs(4 * x - 2) + a) / (1 + a) for a, x in zip(WEIGHTS, point.values(), strict=True)]
    return {"y": np.prod(factors, axis=0)}


def g_indices():
    """Sobol's g-function: every factor has mean 1 and variance 1 / (3 (1 + a)^2)."""
    own = 1 / (3 * (1 + WEIGHTS) ** 2)
    whole = np.prod(1 + own) - 1
    others = [np.prod(np.delete(1 + own, i)) for i in range(4)]
    return {f"x{i}": (own[i] / whole, own[i] * others[i] / whole) for i in range(4)}


FUNCTIONS = {
    "ishigami": (ishigami, dict.fromkeys(("x1", "x2", "x3"), turn), ishigami_indices()),
    "g": (g_function, {f"x{i}": unit for i in range(4)}, g_indices()),
}


def held(name, samples, seed):
    """Which of the known indices lie in their intervals."""
    function, parameters, known = FUNCTIONS[name]
    indices = propagate(function, parameters, samples=samples, seed=seed).indices["y"]
    found = [(of[p], known[p][order]) for order, of in enumerate((indices.first, indices.total)) for p in parameters]
    return [estimate.low <= exact <= estimate.high for estimate, exact in found]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_known_indices_lie_in_their_intervals(name):
    assert all(held(name, 1024, seed=1))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_indices_come_closer_with_more_samples(name):
    function, parameters, known = FUNCTIONS[name]
    errors = []
    for samples in (64, 4096):
        indices = propagate(function, parameters, samples=samples, seed=2).indices["y"]
        first = [indices.first[p].value - known[p][0] for p in parameters]
        total = [indices.total[p].value - known[p][1] for p in parameters]
        errors.append(np.abs(first + total).max())
    assert errors[1] < 0.02
    assert errors[1] < errors[0] / 8  # 64 times the points; random ones would gain a factor of 8


@pytest.mark.slow
@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("samples", [64, 256, 1024])
def test_intervals_hold_as_often_as_they_say(name, samples):
    seen = [hit for seed in range(60) for hit in held(name, samples, seed)]
    assert np.mean(seen) >= 0.95 - 2 * math.sqrt(0.95 * 0.05 / len(seen))


def test_the_leader_is_what_alone_moves_most():
    function, parameters, _ = FUNCTIONS["ishigami"]
    indices = propagate(function, parameters, samples=256).indices["y"]
    assert indices.leader == "x2", "alone x2 does most, though x1 with x3 does more"
    assert indices.total["x1"].value > indices.total["x2"].value
    assert 0.9 < indices.lead <= 1


def test_one_parameter_does_it_all():
    indices = propagate(lambda p: {"y": p["x"] ** 3}, {"x": unit}, samples=256).indices["y"]
    assert indices.first["x"].value == pytest.approx(1, abs=0.02)
    assert indices.total["x"].value == pytest.approx(1, abs=0.02)
    assert indices.lead == 1


def test_quantiles_and_their_intervals():
    found = propagate(
        lambda p: {"y": p["a"] + p["b"]},
        {"a": scipy.stats.norm(1, 3).ppf, "b": scipy.stats.norm(1, 4).ppf},
        samples=512,
    )
    spread, exact = found.spread("y"), scipy.stats.norm(2, 5)
    assert spread.mean == pytest.approx(2, abs=0.05)
    assert spread.standard_deviation == pytest.approx(5, rel=0.02)
    for level, estimate in spread.quantiles.items():
        assert estimate.low < exact.ppf(level) < estimate.high
        # order statistics of 1024 points: two standard errors of the level, over the density
        reach = 2 * math.sqrt(level * (1 - level) / 1024) / exact.pdf(exact.ppf(level))
        assert estimate.high - estimate.low == pytest.approx(2 * reach, rel=0.35)


def test_a_share_has_the_exact_interval():
    estimate = share(np.arange(128) < 0)
    # no hit in n: (1 - p)^n = 2.5 %
    assert (estimate.value, estimate.low) == (0, 0)
    assert estimate.high == pytest.approx(1 - 0.025 ** (1 / 128))


def test_rows_without_a_value_are_left_out_and_counted():
    """Against the estimators of Saltelli et al. (2010), Table 2 (b) and (f), on the rows that are left."""

    def function(point):
        y = point["a"] + 2 * point["b"] * point["c"]
        return {"y": np.where(point["a"] * point["b"] > 0.5, np.nan, y)}

    found = propagate(function, dict.fromkeys("abc", unit), samples=512, seed=3)
    indices, values = found.indices["y"], found.values["y"]
    kept = values[:, np.isfinite(values).all(axis=0)]
    assert 0 < indices.rows == kept.shape[1] < 512
    kept = kept - kept[:2].mean()
    variance = kept[:2].var()
    for place, name in enumerate("abc"):
        assert indices.first[name].value == pytest.approx(np.mean(kept[1] * (kept[2 + place] - kept[0])) / variance)
        assert indices.total[name].value == pytest.approx(np.mean((kept[0] - kept[2 + place]) ** 2) / variance / 2)
    drawn = values[:2].ravel()
    assert found.spread("y").without_value == np.isnan(drawn).sum() > 0
    assert found.spread("y").mean == pytest.approx(np.nanmean(drawn))


def test_the_design_mixes_a_and_b():
    points = propagate(lambda p: {"y": p["a"] + p["b"]}, {"a": unit, "b": turn}, samples=64).points
    for place, name in enumerate("ab"):
        a, b, *mixed = points[name]
        assert not np.any(a == b)
        for other, column in enumerate(mixed):
            assert np.array_equal(column, b if other == place else a)
    # a net: each half of each axis gets half of the points
    assert (points["a"][0] < 0.5).sum() == (points["b"][1] < 0).sum() == 32


def test_the_same_seed_gives_the_same_bits():
    function, parameters, _ = FUNCTIONS["g"]
    one, same, other = (propagate(function, parameters, samples=64, seed=seed) for seed in (7, 7, 8))
    assert one.indices == same.indices
    assert np.array_equal(one.values["y"], same.values["y"])
    assert not np.array_equal(one.points["x0"], other.points["x0"])
    assert one.indices != other.indices


BAD_DESIGNS = [
    ({"samples": 100}, ("samples: got 100", "a power of two from 64")),
    ({"samples": 32}, ("samples: got 32", "a power of two from 64")),
    ({"samples": 0}, ("samples: got 0", "a power of two")),
    ({"samples": -64}, ("samples: got -64", "a power of two")),
    ({"samples": 2**21}, ("samples: got 2097152", "to 1048576")),
    ({"samples": 64.5}, ("samples: got 64.5", "a power of two")),
    ({"samples": math.nan}, ("samples: got nan", "a power of two")),
    ({"samples": "many"}, ("samples: got many", "a power of two")),
    ({"samples": True}, ("samples: got True", "a power of two")),
    ({"samples": [64, 128]}, ("samples: got [64, 128]", "a power of two")),
    ({"seed": -1}, ("seed: got -1", ">= 0")),
    ({"seed": 0.5}, ("seed: got 0.5", "an integer")),
    ({"seed": [1, 2]}, ("seed: got [1, 2]", "one whole number")),
    ({"seed": None}, ("seed: got None", "an integer")),
]


@pytest.mark.parametrize(("design", "naming"), BAD_DESIGNS, ids=[str(design) for design, _ in BAD_DESIGNS])
def test_bad_designs_are_refused(design, naming):
    with refusal(*naming):
        propagate(ishigami, dict.fromkeys(("x1", "x2", "x3"), turn), **design)


@pytest.mark.parametrize(
    ("function", "naming"),
    [
        (lambda p: {"y": 0 * p["x"] + 0.1}, ("outputs: got y", "that x move", "the same value at 192 of 192 points")),
        (lambda p: {"y": 0.1 + p["x"] * 1e-16}, ("outputs: got y", "that x move")),
        (lambda p: {"y": p["x"] * np.nan}, ("outputs: got y", "it has none at any of the 192 points")),
    ],
    ids=["constant", "rounding", "no-value"],
)
def test_an_output_that_does_not_vary_is_refused(function, naming):
    with refusal(*naming):
        propagate(function, {"x": unit}, samples=64)


def test_no_parameters_are_refused():
    with refusal("parameters: got none"):
        propagate(ishigami, {})
