"""Derivatives of the figures, against differences of evaluate and closed forms."""

from __future__ import annotations

import warnings
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

import trum_sym as ts
from derivations import rotor
from derivations.kernels import kernels
from derivations.nomenclature import CONSTANTS
from trum_sym.kernels import call
from trum_sym.slopes import FIGURES, PARAMETERS

# relative steps of the differences
STEPS = {
    "prepressure": 1e-4, "frequency_difference": 1e-4, "load_torque": 1e-4,
    "friction_coefficient": 1e-4, "amplitude": 1e-4, "resonance_frequency": 1e-5,
}  # fmt: skip


def changed(motor, drive, point, name, factor):
    """Motor and drive with one parameter changed and, for the stator's own, nothing else."""
    if name in ("prepressure", "frequency_difference", "load_torque"):
        return motor, replace(drive, **{name: getattr(drive, name) * factor})
    if name == "friction_coefficient":
        return motor.with_values({name: motor.friction_coefficient.value * factor}), drive
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
    assert tuple(found) == FIGURES
    for name in PARAMETERS:
        step = STEPS[name]
        up, down = (ts.evaluate(*changed(trum60, drive, point, name, 1 + e), **options) for e in (step, -step))
        base = getattr(drive, name, None) or getattr(point, name, None) or trum60.friction_coefficient.value
        for figure in FIGURES:
            difference = (getattr(up, figure) - getattr(down, figure)) / (2 * step * base)
            scale = abs(getattr(point, figure) / base)  # differences see the orbit's own tolerance
            assert found[figure][name] == pytest.approx(difference, rel=2e-4, abs=2e-4 * scale), (figure, name)


def test_derivatives_broadcast_and_are_nan_without_an_orbit(trum60):
    drive = ts.Drive(prepressure=np.array([160.0, 180.0, 200.0]), load_torque=np.array([[0.1], [5.0]]))
    found = ts.sensitivities(trum60, drive)
    single = ts.sensitivities(trum60, ts.Drive(prepressure=180.0, load_torque=0.1))
    for figure in FIGURES:
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
    assert found["mean_speed"]["amplitude"] == pytest.approx(point.mean_speed / 5e-6, rel=1e-4)


def test_bad_input_is_refused(trum60):
    with pytest.raises(ts.ParameterError, match="contact"):
        ts.sensitivities(trum60, contact="glue")
    with pytest.raises(ts.ParameterError, match="motor"):
        ts.sensitivities("trum60")


def numbers(kernel, rng):
    """Arguments of ordinary size for a kernel of slopes."""
    sizes = {
        "omega_n": 2.4e5, "Delta_omega": 1.9e4, "xi": 0.006, "psi": 0.3, "s": 1.0, "m": 20.0, "n": 14.0, "W": 5e-6,
        "D": 2.8e-3, "k_c": 300.0, "tau": 3e-5, "g_A": 1.0, "g_B": 0.0, "p_re": 0.8, "p_im": 0.6, "R_v": 1.2,
        "engagement": 40.0, "phi": 0.2, "share": -30.0, "theta": 0.7, "sin_theta": 0.64, "cos_phi": 0.98,
        "sin_phi": 0.19, "v": 0.9,
    }  # fmt: skip
    lengths = {"a": 3e-6, "b": 0.7, "f": 4e-6}
    return {
        symbol.name: sizes.get(symbol.name)
        or lengths[symbol.name[0]] * (1e-5 if "omega" in symbol.name else 1) * rng.uniform(0.5, 1.5)
        for symbol in kernel.inputs
    }


@pytest.mark.parametrize("kernel", [k for k in kernels() if k.along], ids=lambda kernel: kernel.name)
def test_slopes_along_directions_are_derivatives_at_50_digits(kernel):
    """CasADi's derivative in double precision beside a difference quotient of the SymPy expression."""
    values = numbers(kernel, np.random.default_rng(4))
    compiled = call(kernel.name, values)
    symbols = {symbol: sp.Float(values[symbol.name], 60) for symbol in kernel.inputs}
    with mp.workdps(60):
        for direction, rates in kernel.along.items():
            rate = {s: sp.sympify(r).subs(symbols) for s, r in rates.items()}
            step = mp.mpf(10) ** -20
            moved = [{**symbols, **{s: symbols[s] + e * step * r for s, r in rate.items()}} for e in (1, -1)]
            for name, expr in kernel.outputs.items():
                base = [mp.mpf(sp.N(sp.sympify(expr).subs(CONSTANTS).subs(to), 60)) for to in moved]
                expected = (base[0] - base[1]) / (2 * step)
                size = max(abs(expected), abs(base[0]) * mp.mpf("1e-7"))
                assert abs(compiled[f"{name}_{direction}"] - expected) < 1e-10 * size, (name, direction)


def test_friction_follows_engagement_and_angle():
    """Differences of the friction kernel, with the contact solved anew for every engagement."""

    def at(engagement, phi, v=0.4, R_v=0.5):
        fullness = 1 / (np.pi * engagement)
        touching = call("trum_contact_winkler", {"fullness": fullness, "fullness_root": np.cbrt(fullness)})
        values = {"engagement": engagement, "phi": phi, "cos_phi": np.cos(phi), "sin_phi": np.sin(phi)}
        values |= {"R_v": R_v, "v": v, **touching}
        return call("trum_friction", values)["f"], touching["theta"], call("trum_friction_slopes", values)

    rng = np.random.default_rng(8)
    for engagement, phi in zip(10 ** rng.uniform(-0.4, 2, 200), rng.uniform(-np.pi, np.pi, 200), strict=True):
        *_, slopes = at(engagement, phi)
        e = 1e-5
        by_E = [np.subtract(a, b) / (2 * e) for a, b in zip(at(engagement * np.exp(e), phi), at(engagement * np.exp(-e), phi), strict=True) if np.ndim(a) == 0 and not isinstance(a, dict)]  # fmt: skip
        by_phi = (at(engagement, phi + e)[0] - at(engagement, phi - e)[0]) / (2 * e)
        assert slopes["f_E"] == pytest.approx(by_E[0], abs=3e-5)
        assert slopes["theta_E"] == pytest.approx(by_E[1], abs=3e-5)
        assert slopes["f_phi"] == pytest.approx(by_phi, abs=3e-4)


def test_the_paper_s_width_follows_the_height():
    """d ln E / d ln W_c for Hertz' width, against a difference."""
    height, full, e = 3e-6, 1e-7, 1e-6
    values = [call("trum_contact_hertz", {"W_c": height * np.exp(k * e), "W_full": full}) for k in (-1, 0, 1)]
    slopes = call("trum_friction_slopes", {**values[1], "phi": 0.1, "cos_phi": 1.0, "sin_phi": 0.1, "R_v": 1.0, "v": 0.1})
    difference = np.log(values[2]["engagement"] / values[0]["engagement"]) / (2 * e)
    assert slopes["E_height"] == pytest.approx(difference, rel=1e-8)
    assert rotor.friction_slopes()["E_height"].has(sp.sin) is False


def test_warnings_are_given_once(trum60):
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        ts.sensitivities(trum60, ts.Drive(prepressure=219.9))
    assert not given
