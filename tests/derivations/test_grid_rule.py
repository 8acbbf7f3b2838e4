"""What the rule of orbits on a grid leaves is bounded as stated, and refused when a weight or a constant is wrong."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from lazily import lazily

sp = lazily("sympy")
fixed_grid = lazily("derivations.fixed_grid")


def test_the_weights_are_those_of_the_textbooks():
    assert fixed_grid.implicit_weights() == (sp.Rational(5, 12), sp.Rational(2, 3), -sp.Rational(1, 12))
    assert fixed_grid.second_weights() == (sp.Rational(1, 12), sp.Rational(1, 8))
    assert fixed_grid.slope_weight() == sp.Rational(1, 12)
    assert fixed_grid.smooth() == sp.Rational(11, 720)
    fixed_grid.prove()


def rule(values):
    """The integral of a row of values in steps, as the driver takes it."""
    inner, edge = (float(weight) for weight in fixed_grid.second_weights())
    second = np.diff(values, 2)
    return (
        values.sum() - 0.5 * (values[0] + values[-1]) - inner * second.sum() - (edge - inner) * (second[0] + second[-1])
    )


@pytest.mark.parametrize(("event", "power"), [("jump", 0), ("root", 0.5), ("kink", 1), ("curvature", 2)])
def test_what_an_event_leaves_within_a_region_is_less_than_its_constant(event, power):
    """By plain sums over a long row, which share nothing with the zeta function."""
    constant, times = float(fixed_grid.single(event)), np.arange(400.0)
    for place in np.linspace(150.01, 150.99, 23):
        after = np.maximum(times - place, 0.0)
        values = np.where(times > place, after**power, 0.0)
        exact = (times[-1] - place) ** (power + 1) / (power + 1)
        # a smooth far end, where the rule has an error of its own, is taken off
        smooth = (times[-1] - place + 50.0) ** (power + 1) / (power + 1) - (50.0 - 0) ** (power + 1) / (power + 1)
        left = abs(rule(values) - exact)
        assert left <= constant * np.abs(np.diff(values, 4)).sum() + 1e-6 * max(1.0, smooth)


@pytest.mark.parametrize("event", ["jump", "root", "kink", "curvature"])
def test_too_small_a_constant_is_refused(monkeypatch, event):
    fourths = fixed_grid._fourths
    monkeypatch.setattr("derivations.fixed_grid._fourths", lambda power, place: fourths(power, place) / 4)
    with pytest.raises(fixed_grid.ProofError, match=event):
        fixed_grid.single(event)


def test_a_wrong_weight_at_a_region_s_end_is_refused(monkeypatch):
    monkeypatch.setattr("derivations.fixed_grid.second_weights", lambda: (sp.Rational(1, 12), sp.Rational(1, 2)))
    with pytest.raises(fixed_grid.ProofError, match="first cell"):
        fixed_grid.end()


def test_the_driver_counts_twice_what_an_event_leaves():
    found = fixed_grid.bounds()
    assert found["PLAIN"] == 2 * sp.Rational(1, 48)
    assert found["EVENT"] == 2 * sp.Rational(1, 22)
    assert found["END"] == 2 * sp.Rational(3, 4)
    assert found["HELD"] == 4 * sp.Rational(1, 16)
    assert fixed_grid.end() == Fraction(3, 4)


def test_a_peak_s_area_is_bounded_by_where_its_line_passes():
    """By quadrature of the cosine of the phase along random straight lines, which knows nothing of widths."""
    rng, bound = np.random.default_rng(5), fixed_grid.passing()
    share = (np.polynomial.legendre.leggauss(400)[0] + 1) / 2
    weights = np.polynomial.legendre.leggauss(400)[1] / 2
    largest = 0.0
    for _ in range(300):
        nearest, before, after = 10 ** rng.uniform(-3, 0), rng.uniform(0.05, 1), rng.uniform(0.05, 1)
        heights = np.hypot(nearest, [before, after])
        turn = np.arctan(before / nearest) + np.arctan(after / nearest)
        way = heights @ heights - 2 * heights.prod() * np.cos(turn)
        half_width = heights.prod() * np.sin(turn) / way
        span = np.arcsinh(before / nearest) + np.arcsinh(after / nearest)
        times = np.arcsinh(-before / nearest) + share * span
        along = nearest * np.sinh(times)  # so that the nodes gather at the peak
        cosine = nearest / np.hypot(nearest, along)
        area = (weights * cosine * nearest * np.cosh(times)).sum() * span / (before + after)  # in steps
        assert area <= bound * half_width**0.75
        largest = max(largest, area / (bound * half_width**0.75))
    assert largest > 0.9
