"""The load's inertia, derived: against numbers by hand, and its proofs raise where a step is wrong."""

from __future__ import annotations

import pytest
from lazily import lazily

sp = lazily("sympy")
bench = lazily("derivations.bench")
nomenclature = lazily("derivations.nomenclature")
TABLE_3 = {"J": 4.5e-6, "J_load": 0, "T_load": 0.3, "r_s": 0.03, "r_c": 0.0265, "mu": 0.25, "F_c": 180, "g": 9.80665}


def symbol(name):
    return nomenclature.sym(name)[0]


def at(expr, **more):
    """An expression's value at Table 3."""
    return float(expr.subs({symbol(name): value for name, value in {**TABLE_3, **more}.items()}))


def test_table_3_by_hand():
    """m = 0.3/(9.80665 * 0.03) = 1.019716 kg, m r^2 = 9.177446e-4 kg m^2."""
    assert at(bench.mass()) == pytest.approx(1.019716, rel=1e-6)
    assert at(bench.inertia()) == pytest.approx(9.177446e-4 + 4.5e-6, rel=1e-6)
    # friction that just carries the load: nothing accelerates, the string holds the weight
    assert at(bench.tension(), f=0.3 / (0.25 * 180 * 0.0265)) == pytest.approx(1.0, rel=1e-9)
    # at the limit the string's end falls as the weight does, with g/r = 326.9 1/s^2: J g/r = -1.471e-3 N m of friction
    assert at(bench.tension(), f=-1.4709975e-3 / (0.25 * 180 * 0.0265)) == pytest.approx(0.0, abs=1e-6)


def test_either_sense_of_the_load_has_the_same_weight():
    assert at(bench.inertia(), T_load=-0.3) == at(bench.inertia())


@pytest.mark.parametrize("result", ["inertia", "tension", "stretched"])
def test_a_slip_in_a_premise_is_noticed(monkeypatch, result):
    """Of the weight's mass, twice: every result is held against the two bodies' equations."""
    T_load, g, r_s = (symbol(name) for name in ("T_load", "g", "r_s"))
    monkeypatch.setattr("derivations.bench.mass", lambda: 2 * sp.Abs(T_load) / (g * r_s))
    with pytest.raises(bench.DynamicsError, match="is not 0"):
        getattr(bench, result).__wrapped__()


def test_a_slip_in_a_result_is_noticed(monkeypatch):
    monkeypatch.setattr("derivations.bench.inertia", lambda: symbol("J") + symbol("J_load"))
    for result in (bench.tension, bench.stretched):
        with pytest.raises(bench.DynamicsError, match="is not 0"):
            result.__wrapped__()
