"""The load's inertia, derived: against numbers by hand, and its proofs raise where a step is wrong."""

from __future__ import annotations

import pytest
import sympy as sp

from derivations import bench
from derivations.nomenclature import sym

J, J_load, T_load, r_s, r_c, mu, F_c, f, g = sym("J J_load T_load r_s r_c mu F_c f g")
TABLE_3 = {J: 4.5e-6, J_load: 0, T_load: 0.3, r_s: 0.03, r_c: 0.0265, mu: 0.25, F_c: 180, g: 9.80665}


def test_table_3_by_hand():
    """m = 0.3/(9.80665 * 0.03) = 1.019716 kg, m r^2 = 9.177446e-4 kg m^2."""
    assert float(bench.mass().subs(TABLE_3)) == pytest.approx(1.019716, rel=1e-6)
    assert float(bench.inertia().subs(TABLE_3)) == pytest.approx(9.177446e-4 + 4.5e-6, rel=1e-6)
    # friction that just carries the load: nothing accelerates, the string holds the weight
    level = {**TABLE_3, f: 0.3 / (0.25 * 180 * 0.0265)}
    assert float(bench.tension().subs(level)) == pytest.approx(1.0, rel=1e-9)
    # at the limit the string's end falls as the weight does, with g/r = 326.9 1/s^2: J g/r = -1.471e-3 N m of friction
    limit = {**TABLE_3, f: -1.4709975e-3 / (0.25 * 180 * 0.0265)}
    assert float(bench.tension().subs(limit)) == pytest.approx(0.0, abs=1e-6)


def test_either_sense_of_the_load_has_the_same_weight():
    assert bench.inertia().subs(T_load, -0.3) == bench.inertia().subs(T_load, 0.3)


@pytest.mark.parametrize("result", [bench.inertia, bench.tension, bench.stretched])
def test_a_slip_in_a_premise_is_noticed(monkeypatch, result):
    """Of the weight's mass, twice: every result is held against the two bodies' equations."""
    monkeypatch.setattr(bench, "mass", lambda: 2 * sp.Abs(T_load) / (g * r_s))
    with pytest.raises(bench.DynamicsError, match="is not 0"):
        result.__wrapped__()


def test_a_slip_in_a_result_is_noticed(monkeypatch):
    monkeypatch.setattr(bench, "inertia", lambda: J + J_load)
    for result in (bench.tension, bench.stretched):
        with pytest.raises(bench.DynamicsError, match="is not 0"):
            result.__wrapped__()
