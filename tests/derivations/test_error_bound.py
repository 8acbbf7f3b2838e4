"""The theorems of the error bounds hold, and are refused when something in them is wrong."""

from __future__ import annotations

import pytest
from lazily import lazily

sp = lazily("sympy")
collocation = lazily("derivations.collocation")
error_bound = lazily("derivations.error_bound")


def test_every_theorem_is_proved():
    assert set(error_bound.prove()) == {theorem.name for theorem in error_bound.THEOREMS}
    assert all(theorem.rests_on for theorem in error_bound.THEOREMS)


@pytest.mark.parametrize("index", [0, 1, 2])
def test_a_wrong_check_weight_is_refused(monkeypatch, index):
    weights = list(collocation.check_weights())
    weights[index] += sp.Rational(1, 10**6)
    monkeypatch.setattr("derivations.collocation.check_weights", lambda: weights)
    with pytest.raises(error_bound.ProofError, match="Kronrod"):
        error_bound.kronrod()


def test_a_wrong_check_node_is_refused(monkeypatch):
    points = list(collocation.check_nodes())
    points[0] += sp.Rational(1, 10**6)
    monkeypatch.setattr("derivations.collocation.check_nodes", lambda: points)
    with pytest.raises(error_bound.ProofError, match="Kronrod"):
        error_bound.kronrod()
