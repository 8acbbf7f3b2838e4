"""Pictures of answers: what their axes hold, against the answers and against other libraries."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC

answers = lazily("trum_sym.plots.answers")
optimize = lazily("scipy.optimize")
stats = lazily("scipy.stats")
DATA = Path(__file__).parents[2] / "examples" / "data"
LOAD = ts.Drive(load_torque=0.1)


def labels(figure):
    return [(ax.get_xlabel(), ax.get_ylabel()) for ax in figure.axes]


def test_histories_show_phases_contact_speed_and_angle_with_units():
    found = ts.simulate(drive=LOAD, cycles=2, samples_per_period=16)
    figure = answers.histories(found)
    phases, contact, speed, angle = figure.axes
    for line, name, scale in (
        (phases.lines[0], "w_A", 1e6),
        (phases.lines[1], "w_B", 1e6),
        (contact.lines[0], "theta", 180 / np.pi),
        (speed.lines[0], "rotor_speed", 1e-6 / ARCSEC),
        (angle.lines[0], "rotor_angle", 1 / ARCSEC),
    ):
        x, y = line.get_data()
        assert np.array_equal(x, 1e3 * found.time)
        assert y == pytest.approx(scale * found[name].to_numpy(), rel=1e-12)
    assert [label for _, label in labels(figure)] == [
        "displacement (µm)",
        "contact (°)",
        "speed (10⁶ arcsec/s)",
        "angle (arcsec)",
    ]
    assert labels(figure)[-1][0].endswith("(ms)")
    # A is off in the first 6 of 20 periods, B in the next 6, in both cycles
    cycle = 1e3 * found.attrs["cycle_time"]
    bands = sorted((p.get_x() / cycle, (p.get_x() + p.get_width()) / cycle) for p in contact.patches)
    assert bands == [pytest.approx(ends) for ends in ((0, 0.3), (0.3, 0.6), (1, 1.3), (1.3, 1.6))]


def test_a_sweep_over_one_axis_is_lines_in_the_units_that_people_read():
    force = np.array([165.0, 175.0, 185.0])
    found = ts.sweep(prepressure=force, load_torque=0.1, outputs=("mean_speed", "amplitude"))
    figure = answers.swept(found)
    point = ts.evaluate(drive=ts.Drive(prepressure=force, load_torque=0.1))
    assert labels(figure) == [
        ("prepressure (N)", "mean speed v_s (arcsec/s)"),
    ]
    x, y = figure.axes[0].lines[0].get_data()
    assert np.array_equal(x, force)
    assert y == pytest.approx(point.mean_speed / ARCSEC, rel=1e-5)


def test_a_sweep_over_two_axes_is_a_map_that_leaves_out_what_has_no_answer():
    found = ts.sweep(
        prepressure=[165.0, 185.0], load_torque=[0.0, 0.1, 3.0], outputs=("q_average", "mean_speed"), tolerance=1e-4
    )
    figure = answers.swept(found)
    maps = [ax for ax in figure.axes if ax.get_xlabel() and ax.get_ylabel()]
    assert [(ax.get_xlabel(), ax.get_ylabel()) for ax in maps] == 2 * [("load torque (N*m)", "prepressure (N)")]
    values = maps[0].collections[0].get_array()
    assert values.shape == (2, 3)
    assert np.array_equal(np.ma.getmaskarray(values), [[False, False, True]] * 2)
    assert figure.get_suptitle() == "TRUM-60; blank: 2 of 6 without an answer"


def test_a_sweep_over_three_axes_has_no_picture():
    with pytest.raises(ts.ParameterError, match=r"--plot: got 3 axes"):
        answers.check_swept(3)


def test_a_fit_is_drawn_with_the_band_that_scipy_gives_it():
    found = ts.calibrate(DATA / "table2.csv")
    (ax,) = answers.fitted(found).axes
    force, amplitude = (found.measurements.columns[name] for name in ("prepressure", "amplitude"))
    free = 12.6e-6
    law = lambda f, factor, exponent: factor * free * f**-exponent  # noqa: E731
    best, covariance = optimize.curve_fit(law, force, amplitude, p0=(15, 0.7))
    slopes = np.stack([free * force ** -best[1], -np.log(force) * law(force, *best)])
    half = stats.t.ppf(0.975, force.size - 2) * np.sqrt(np.einsum("in,ij,jn->n", slopes, covariance, slopes))
    fit, measured = ax.lines
    assert fit.get_ydata() == pytest.approx(1e6 * law(force, *best), rel=1e-6)
    assert measured.get_ydata() == pytest.approx(1e6 * amplitude)
    corners = ax.collections[0].get_paths()[0].vertices
    for x, y, width in zip(force, law(force, *best), half, strict=True):
        ends = corners[corners[:, 0] == x, 1]
        assert (ends.min(), ends.max()) == pytest.approx((1e6 * (y - width), 1e6 * (y + width)), rel=1e-5)
    assert labels(ax.figure) == [("prepressure (N)", "amplitude of a phase W_maxf (µm)")]


def test_a_decay_is_drawn_over_time():
    found = ts.calibrate(DATA / "decay_synthetic.csv")
    (ax,) = answers.fitted(found).axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time (s)", "velocity (m/s)")
    fit, measured = (line.get_ydata() for line in ax.lines)
    left = found.residuals
    assert np.sum((fit - measured) ** 2) == pytest.approx(left.degrees_of_freedom * left.standard_deviation**2)


def test_a_fit_keeps_its_inputs_for_other_commands(tmp_path):
    from trum_sym.console.point_file import read_point

    found = ts.calibrate(DATA / "table2.csv", drive=LOAD, compliance="flange")
    path = tmp_path / "fit.json"
    path.write_text(found.to_json(), "utf-8")
    point = read_point(path)
    assert point.motor().amplitude_factor.value == found["amplitude_factor"].value
    assert (point.options["load_torque"], point.options["compliance"]) == (0.1, "flange")
