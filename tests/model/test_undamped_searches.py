"""A lack of damping is said wherever it makes figures: in searches and sweeps too, and once."""

from __future__ import annotations

import warnings

import pytest

import trum_sym as ts

BOX = {"prepressure": 180.0, "frequency_difference": (1.0, 100.0)}


def said_of(call):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        call()
    return [warning for warning in said if "damping_ratio" in str(warning.message)]


def optimum(motor):
    return ts.optimize(motor, ts.Drive(load_torque=0.05), bounds=BOX, constraints=["mean_speed >= 0 rad/s"])


def sweep(motor, nearest):
    return ts.sweep(motor, frequency_difference=[nearest, 500.0, 3000.0], outputs=("q_average",))


@pytest.mark.parametrize("damping", [0, 0.006])
def test_searches_and_sweeps_say_it(trum60, damping):
    motor = trum60.with_values({"damping_ratio": damping})
    for call in (lambda: optimum(motor), lambda: sweep(motor, 1e-3)):
        said = said_of(call)
        assert len(said) >= 1 if damping == 0 else not said
        assert {warning.filename for warning in said} <= {__file__}
    assert not said_of(lambda: sweep(motor, 100.0))


def test_a_sweep_finds_the_one_point_that_its_sample_leaves_out(trum60):
    motor = trum60.with_values({"damping_ratio": 0})
    ranges = {"prepressure": "160:210:101", "frequency_difference": [1e-3, *range(200, 400)]}
    assert said_of(lambda: ts.sweep(motor, outputs=("cycle_time",), **ranges))
