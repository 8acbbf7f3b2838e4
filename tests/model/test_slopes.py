"""Derivatives of the figures, against differences of evaluate and closed forms."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import trum_sym as ts
from studies import slopes as slopes_study
from trum_sym.model.kernels import call
from trum_sym.model.operating_point import prepare
from trum_sym.model.sensitivities import DIFFERENTIATED, PARAMETERS, orbit_with_slopes

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")  # friction from none to any

# relative steps of the differences
STEPS = {
    "prepressure": 1e-4,
    "frequency_difference": 1e-4,
    "load_torque": 1e-4,
    "load_inertia": 1e-4,
    "friction_coefficient": 1e-4,
    "amplitude": 1e-4,
    "resonance_frequency": 1e-5,
}


def changed(motor, drive, point, name, factor):
    """Motor and drive with one parameter changed and, for the stator's own, nothing else."""
    if name in ("prepressure", "frequency_difference", "load_torque"):
        return motor, replace(drive, **{name: getattr(drive, name) * factor})
    if name == "friction_coefficient":
        return motor.with_values({name: motor.friction_coefficient.value * factor}), drive
    if name == "load_inertia":  # a rotor that is so much heavier
        return motor.with_values({"rotor_inertia": motor.rotor_inertia.value * factor}), drive
    fixed = {"amplitude": point.amplitude, "resonance_frequency": point.resonance_frequency}
    fixed[name] = fixed[name] * factor
    return motor.with_values(fixed), drive


@pytest.mark.parametrize("contact", ["winkler", "hertz"])
@pytest.mark.parametrize("start", ["periodic", "steady", "rest"])
def test_derivatives_are_those_of_evaluate(trum60, start, contact):
    drive = ts.Drive(start=start, load_torque=0.05)
    options = {"contact": contact, "tolerance": 1e-9}
    point = ts.evaluate(trum60, drive, **options)
    found = ts.sensitivities(trum60, drive, **options)
    assert tuple(found) == DIFFERENTIATED
    for name in PARAMETERS:
        step = STEPS[name]
        up, down = (ts.evaluate(*changed(trum60, drive, point, name, 1 + e), **options) for e in (step, -step))
        base = getattr(drive, name, None) or getattr(point, name, None) or trum60.friction_coefficient.value
        base = trum60.rotor_inertia.value if name == "load_inertia" else base
        for figure in DIFFERENTIATED:
            difference = (getattr(up, figure) - getattr(down, figure)) / (2 * step * base)
            # differences see the orbit's own tolerance
            scale = abs(getattr(point, figure) / base) * (1e-3 if figure == "contact_fraction" else 2e-4)
            assert found[figure][name] == pytest.approx(difference, rel=2e-4, abs=scale), (figure, name)


@pytest.mark.parametrize("seed", [3, 16, *(pytest.param(k, marks=pytest.mark.slow) for k in (23, 25, 37, 38))])
def test_slopes_of_random_points_are_exact_to_1e_7(seed):
    """Motors and drives whose events took most care: rotors that almost follow, grazed crests, standing waves."""
    errors = np.array(list(slopes_study.record(seed)["errors"].values()))
    smooth = errors[errors[:, 0] <= slopes_study.AGREE, 1:]
    assert len(smooth) >= 20
    allowed = 3e-6 if seed in (16, 23) else 1e-7  # by the frequencies, which nearly cancel there
    assert smooth[:, -1].max() <= allowed
    assert np.median(smooth[:, 1]) <= 1e-6


def test_slopes_change_no_figure(trum60):
    """They are taken along an orbit that is found without them."""
    drive = ts.Drive(prepressure=np.linspace(150, 200, 11), load_torque=0.05)
    case = prepare(trum60, drive, slopes_study.LEVELS, 1e-6)
    orbit, _ = orbit_with_slopes(case)
    assert np.array_equal(orbit.mean_speed, ts.evaluate(trum60, drive, tolerance=1e-6).mean_speed)


def test_derivatives_broadcast_and_are_nan_without_an_orbit(trum60):
    drive = ts.Drive(prepressure=np.array([160.0, 180.0, 200.0]), load_torque=np.array([[0.1], [5.0]]))
    found = ts.sensitivities(trum60, drive)
    single = ts.sensitivities(trum60, ts.Drive(prepressure=180.0, load_torque=0.1))
    for figure in DIFFERENTIATED:
        for name in PARAMETERS:
            assert found[figure][name].shape == (2, 3)
            assert found[figure][name][0, 1] == single[figure][name]
    assert np.isnan(found["mean_speed"]["prepressure"][1]).all()
    assert np.isfinite(found["stall_torque"]["prepressure"][1]).all()


def test_a_plain_wave_is_as_fast_as_its_amplitude(trum60):
    """Without load the rotor's speed on a plain travelling wave is in proportion to the amplitude."""
    drive = ts.Drive(on_periods=20, start="steady", load_torque=0.0)
    motor = trum60.with_values({"amplitude": 5e-6, "resonance_frequency": 39e3})
    heavy = motor.with_values({"layer_young_modulus": 1e15})  # a line of contact, whatever the amplitude
    point, found = ts.evaluate(heavy, drive, tolerance=1e-8), ts.sensitivities(heavy, drive, tolerance=1e-8)
    assert found["mean_speed"]["amplitude"] == pytest.approx(point.mean_speed / 5e-6, rel=1e-3)


def test_bad_input_is_refused(trum60):
    with pytest.raises(ts.ParameterError, match="contact"):
        ts.sensitivities(trum60, contact="glue")
    with pytest.raises(ts.ParameterError, match="motor"):
        ts.sensitivities("trum60")


def test_friction_follows_engagement_and_angle():
    """Differences of the friction kernel, with the contact solved anew for every engagement."""

    def at(engagement, phi):
        fullness = 1 / (np.pi * engagement)
        touching = call("trum_contact_winkler", {"fullness": fullness, "fullness_root": np.cbrt(fullness)})
        values = {"engagement": engagement, "phi": phi, "cos_phi": np.cos(phi), "sin_phi": np.sin(phi)}
        return {**values, "R_v": 0.5, "v": 0.4, **touching}

    def friction(engagement, phi):
        return call("trum_friction", at(engagement, phi))["f"]

    rng, e = np.random.default_rng(8), 1e-5
    for engagement, phi in zip(10 ** rng.uniform(-0.4, 2, 200), rng.uniform(-np.pi, np.pi, 200), strict=True):
        slopes = call("trum_friction_slopes", at(engagement, phi))
        more, less = engagement * np.exp(e), engagement * np.exp(-e)
        assert slopes["f_E"] == pytest.approx((friction(more, phi) - friction(less, phi)) / (2 * e), abs=3e-5)
        assert slopes["theta_E"] == pytest.approx((at(more, phi)["theta"] - at(less, phi)["theta"]) / (2 * e), abs=3e-5)
        turned = (friction(engagement, phi + e) - friction(engagement, phi - e)) / (2 * e)
        assert slopes["f_phi"] == pytest.approx(turned, abs=3e-4)


def test_the_paper_s_width_follows_the_height():
    """d ln E / d ln W_c for Hertz' width, against a difference."""
    height, full, e = 3e-6, 1e-7, 1e-6
    values = [call("trum_contact_hertz", {"W_c": height * np.exp(k * e), "W_full": full}) for k in (-1, 0, 1)]
    slopes = call(
        "trum_friction_slopes", {**values[1], "phi": 0.1, "cos_phi": 1.0, "sin_phi": 0.1, "R_v": 1.0, "v": 0.1}
    )
    difference = np.log(values[2]["engagement"] / values[0]["engagement"]) / (2 * e)
    assert slopes["E_height"] == pytest.approx(difference, rel=1e-8)


def test_warnings_are_given_once(trum60):
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        ts.sensitivities(trum60, ts.Drive(prepressure=219.9))
    assert not given


def test_slopes_over_a_bent_step_have_the_limits_of_the_kernels():
    """Friction's slope and the half-angle's, times dt/dsigma = 2 h sigma, the time h sigma^2 after a square root."""
    step, near = 1e-7, 1e-3
    after = step * near**2
    fastest, faster, faster_rim, engagement = 0.4, 2e3, -3e4, 3.0
    touching = call("trum_contact_winkler", {"fullness": 1 / (np.pi * 3), "fullness_root": np.cbrt(1 / (np.pi * 3))})
    for way in (1, -1):
        there = {**touching, "engagement": engagement, "phi": 0.2, "cos_phi": np.cos(0.2), "sin_phi": np.sin(0.2)}
        of_root = call("trum_friction", {**there, "R_v": fastest, "v": way * fastest})
        pressures = sorted((float(of_root["p_1"]), float(of_root["p_2"])))
        assert pressures[0] == pytest.approx(pressures[1]), "the two points are one"
        limit = call(
            "trum_friction_limit",
            {
                "R_v": fastest,
                "R_v_rate": faster,
                "v": way * fastest,
                "v_rate": way * faster_rim,
                "step": step,
                "p_smaller": pressures[0],
                "p_larger": pressures[1],
            },
        )["T_f_v"]
        moved = {"R_v": fastest + faster * after, "v": way * (fastest + faster_rim * after)}
        slope = call("trum_friction", {**there, **moved})["f_v"]
        assert slope * 2 * step * near == pytest.approx(limit, rel=1e-4)
    full, growth = 2e-7, 0.05
    engagement = (1 + growth * after / full) / np.pi
    touching = call(
        "trum_contact_winkler",
        {"fullness": 1 / (np.pi * engagement), "fullness_root": np.cbrt(1 / (np.pi * engagement))},
    )
    opening = call("trum_friction_slopes", {**there, **moved, **touching, "engagement": engagement})["theta_E"]
    limit = call("trum_contact_limit", {"W_full": full, "W_c_rate": -growth, "step": step})["T_theta_E"]
    assert opening * 2 * step * near == pytest.approx(limit, rel=1e-3)


def test_at_a_kink_the_slope_is_that_of_one_side(trum60):
    """Two peaks of a cycle's speed are equally high at some frequency difference: the highest has a kink there."""

    def drive(difference):
        return ts.Drive(prepressure=180.0, frequency_difference=difference, load_torque=0.1)

    def slope(difference):
        found = ts.sensitivities(trum60, drive(difference), tolerance=1e-9)
        return float(found["max_speed"]["frequency_difference"])

    low, high = 3165.0, 3170.0
    left, right = slope(low), slope(high)
    while high - low > 1e-7:
        middle = (low + high) / 2
        here = slope(middle)
        nearer = abs(here - left) < abs(here - right)
        low, high, left, right = (middle, high, here, right) if nearer else (low, middle, left, here)
    assert right - left > 3e-3
    reach = 0.5 * np.arange(4)
    for side, way in ((left, -1.0), (right, 1.0)):  # one-sided differences of third order
        speeds = ts.evaluate(trum60, drive((low + high) / 2 + way * reach), tolerance=1e-9).max_speed
        one_sided = way * (-11 * speeds[0] + 18 * speeds[1] - 9 * speeds[2] + 2 * speeds[3]) / (6 * reach[1])
        assert side == pytest.approx(one_sided, rel=1e-3)
    assert slope((low + high) / 2) == pytest.approx(left, rel=1e-6) or slope((low + high) / 2) == pytest.approx(
        right, rel=1e-6
    )
