"""Where inertia, friction and contact radius give Table 4: against evaluate and a root found another way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.published import ENCODER, TABLE_5
from trum_sym.paper.region import COMPARED, region

scipy = lazily("scipy")

J = 4.5e-6
RADIUS = np.array([0.025, 0.0265, 0.030])
INERTIA = np.array([2e-4, 4e-3])
REST = ts.Drive(start="rest", phase_lead=-1)


@pytest.fixture(scope="module")
def found(trum60):
    return region(trum60, "rest", -1.0, 0.0, INERTIA, RADIUS)


def at(trum60, inertia, radius, friction, drive=REST, period=None):
    motor = trum60.with_values({"friction_coefficient": friction, "contact_radius": radius})
    return ts.evaluate(motor, replace(drive, load_inertia=inertia - J), sampling_period=period, tolerance=1e-7)


@pytest.mark.parametrize("place", [(0, 1), (1, 0), (2, 1)])
def test_the_friction_is_where_evaluate_has_table_4_s_speed(trum60, found, place):
    k, i = place

    def excess(friction):
        return at(trum60, INERTIA[i], RADIUS[k], friction).mean_speed / (633 * ARCSEC) - 1

    root = scipy.optimize.brentq(excess, 0.2, 0.3, xtol=1e-10)
    assert found.friction[place] == pytest.approx(root, rel=1e-6)
    steeper = excess(root * (1 + 1e-5)) / 1e-5
    assert found.width[place] == pytest.approx(0.05 / steeper, rel=0.1)
    read = at(trum60, INERTIA[i], RADIUS[k], found.friction[place], period=ENCODER)
    assert found.volatility[place] == pytest.approx(read.speed_volatility, rel=2e-3)


def test_the_region_with_a_flange_is_that_of_evaluate_with_one(trum60):
    alone, found = (
        region(trum60, "rest", -1.0, 0.0, np.array([1e-4]), np.array([0.0265]), of) for of in ("layer", "flange")
    )

    def excess(friction):
        motor = trum60.with_values({"friction_coefficient": friction})
        drive = replace(REST, load_inertia=1e-4 - J)
        return ts.evaluate(motor, drive, compliance="flange", tolerance=1e-7).mean_speed / (633 * ARCSEC) - 1

    root = scipy.optimize.brentq(excess, 0.2, 0.3, xtol=1e-9)
    assert found.friction[0, 0] == pytest.approx(root, rel=1e-6)
    assert found.friction[0, 0] > 1.05 * alone.friction[0, 0]


def test_there_is_none_where_the_speed_keeps_its_sign(trum60, found):
    assert np.isnan(found.friction[2, 0])
    ends = [at(trum60, INERTIA[0], RADIUS[2], friction).mean_speed - 633 * ARCSEC for friction in (0.2, 0.25, 0.3)]
    assert np.all(np.sign(ends) == np.sign(ends[0]))
    assert not found.steps[:, 2, 0].any()


def test_friction_and_contact_radius_count_as_their_product_under_a_heavy_load(found):
    """The rim's speed is that at which friction's mean is T/(mu F_c r_c); 633 arcsec/s are next to none of it."""
    product = found.friction[:, 1] * RADIUS
    assert product == pytest.approx(product[1], rel=1e-3)
    assert found.volatility[:, 1] == pytest.approx(0.173, rel=0.005)  # and the inertia alone is left for the other


def test_the_trends_are_those_of_evaluate(trum60, found):
    """Figs. 30 to 32 at the friction found: six drives each, steps of the speed against those of Q_aver."""
    friction = found.friction[1, 1]
    six = (
        {"frequency_difference": np.linspace(2800, 3300, 6)},
        {"prepressure": np.linspace(160, 210, 6), "frequency_difference": 3300.0},
        dict(TABLE_5),
    )
    for k, drive in enumerate(six):
        point = at(trum60, 4e-3, 0.0265, friction, replace(REST, **drive), ENCODER)
        for row, figure, determinant in (
            (2 * k, point.mean_speed, point.q_average),
            (2 * k + 1, point.speed_volatility, point.q_volatility),
        ):
            same = bool(np.all(np.sign(np.diff(figure)) == np.sign(np.diff(determinant))))
            assert found.steps[row, 1, 1] == same, COMPARED[row]
            if same:
                assert scipy.stats.spearmanr(figure, determinant).statistic == pytest.approx(1.0)
    assert found.steps[:, 1, 1].tolist() == [True, False, True, False, False, False]
