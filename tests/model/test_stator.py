"""Section, resonance, contact half-angle, foundation and amplitude, each against something independent."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

import trum_sym as ts
from trum_sym.model.kernels import call

TURN = 2 * np.pi


@pytest.fixture(scope="module")
def values(trum60):
    """Table 1 by symbol, with the section that follows from it and no foundation."""
    found = trum60.symbols()
    for kernel in ("trum_neutral_axis", "trum_section", "trum_wavenumber", "trum_layer_stiffness"):
        found.update(call(kernel, found))
    return {**found, "k_f": 0.0, "k_dx": 0.0}


def layers(v):
    """(bottom, top, modulus, density, shear modulus, width) of the two layers, from the tooth surface down."""
    k_t, k_s = v["h_t"] / v["h_e"], v["n_s"] * v["b_s"] / v["l_s"]
    k_d = 1 - k_t * k_s
    metal = (0.0, v["h_e"], (1 - k_t) ** 3 * v["E_e"], k_d * v["rho_e"], k_d * v["G_e"], v["b_e"])
    return metal, (v["h_e"], v["h_e"] + v["h_p"], v["E_p"], v["rho_p"], v["G_p"], v["b_p"])


def test_neutral_axis_balances_the_bending_stress(values):
    force = sum(
        scipy.integrate.quad(lambda z, E=E, b=b: E * b * (z - values["D"]), lo, hi)[0]
        for lo, hi, E, _, _, b in layers(values)
    )
    scale = sum(E * b * (hi - lo) ** 2 for lo, hi, E, _, _, b in layers(values))
    assert abs(force) < 1e-12 * scale


def test_section_by_numerical_integration(values):
    parts = layers(values)
    bending = sum(
        scipy.integrate.quad(lambda z, E=E, b=b: E * b * (z - values["D"]) ** 2, lo, hi)[0]
        for lo, hi, E, _, _, b in parts
    )
    second = sum(
        scipy.integrate.quad(lambda z, b=b: b * (z - values["D"]) ** 2, lo, hi)[0] for lo, hi, _, _, _, b in parts
    )
    assert values["E"] * values["I_z"] == pytest.approx(bending, rel=1e-12)
    assert values["I_z"] == pytest.approx(second, rel=1e-12)
    assert values["rho"] * values["A"] == pytest.approx(
        sum(r * b * (hi - lo) for lo, hi, _, r, _, b in parts), rel=1e-14
    )
    assert values["G"] * values["A"] == pytest.approx(sum(g * b * (hi - lo) for lo, hi, _, _, g, b in parts), rel=1e-14)


def test_neutral_axis_of_table_1_by_hand(values):
    # E_eq = (1 - 2/4.5)^3 155 GPa = 26.57750 GPa; per width: (26.5775 * 20.25 + 2 * 76.5 * 2.25 + 76.5 * 0.25)
    # over 2 (26.5775 * 4.5 + 76.5 * 0.5), in GPa mm^2 over GPa mm: 901.5694 / 315.6975 = 2.85580 mm
    assert values["D"] == pytest.approx(2.85580e-3, abs=5e-9)


def stiffness_and_mass(v, k_f=0.0):
    k, shear = v["k_c"], v["kappa"] * v["G"] * v["A"]
    K = np.array([[shear * k**2 + k_f, -shear * k], [-shear * k, v["E"] * v["I_z"] * k**2 + shear]])
    return K, np.diag([v["rho"] * v["A"], v["rho"] * v["I_z"]])


@pytest.mark.parametrize("k_f", [0.0, 3e8, 3e10])
def test_quartic_is_the_lower_eigenvalue_of_the_two_field_system(values, k_f):
    squares, modes = scipy.linalg.eigh(*stiffness_and_mass(values, k_f))
    found = call("trum_resonance", {**values, "k_f": k_f})
    assert found["quartic"] == pytest.approx(np.sqrt(squares[0]), rel=1e-12)
    assert found["beta"] == pytest.approx(modes[1, 0] / modes[0, 0], rel=1e-11)


def test_levels_order_as_shear_and_rotation_soften_the_beam(values):
    f = call("trum_resonance", values)
    assert f["eq6"] < f["quartic"] < f["euler"]


def test_all_levels_but_the_printed_one_meet_for_a_slender_beam(values):
    slender = {**values, "k_c": values["k_c"] / 1000}
    f = call("trum_resonance", slender)
    euler = slender["k_c"] ** 2 * np.sqrt(values["E"] * values["I_z"] / (values["rho"] * values["A"]))
    assert f["euler"] == pytest.approx(euler, rel=1e-14)
    assert f["quartic"] == pytest.approx(euler, rel=1e-5)
    assert f["eq6"] == pytest.approx(euler, rel=1e-5)
    assert f["beta"] == pytest.approx(slender["k_c"], rel=1e-5)


def test_printed_resonance_loses_the_factor_E_I_z(values):
    # with E I_z = 1 in both places of the denominator the printed form would be the derived one without a foundation
    v = values
    c = v["E"] * v["I_z"] * v["k_c"] ** 4
    printed = np.sqrt(c / (v["rho"] * v["A"] + v["rho"] * (1 / (v["kappa"] * v["G"]) + 1 / v["E"]) * v["k_c"] ** 2))
    assert call("trum_resonance", v)["printed"] == pytest.approx(printed, rel=1e-14)


def contact_force(v, theta):
    k, W = v["k_c"], v["W"]
    per_crest, _ = scipy.integrate.quad(lambda x: v["k_N"] * W * (np.cos(k * x) - np.cos(theta)), -theta / k, theta / k)
    return v["n_j"] * per_crest


@pytest.mark.parametrize("prepressure", [0.01, 20.0, 180.0, 400.0, 20e3])
def test_winkler_half_angle_carries_the_prepressure(values, prepressure):
    v = {**values, "W": 5.5e-6, "F_c": prepressure}
    theta = call("contact_half_angle", v)["theta"]
    assert 0 < theta < np.pi
    assert contact_force(v, theta) == pytest.approx(prepressure, rel=1e-9)


def test_winkler_half_angle_agrees_with_a_bracketed_root_over_its_whole_range():
    y = np.concatenate([np.geomspace(1e-6, 3, 60), np.pi - np.geomspace(1e-6, 0.1, 20)])
    unit = {"k_N": 0.5, "W": 1.0, "k_c": 1.0, "n_j": 1.0}
    ours = call("contact_half_angle", {**unit, "F_c": y})["theta"]
    for value, theta in zip(y, ours, strict=True):
        root = scipy.optimize.brentq(
            lambda t, value=value: np.sin(t) - t * np.cos(t) - value, 0, np.pi, xtol=1e-16, rtol=1e-15
        )
        assert theta == pytest.approx(root, rel=1e-9)


def test_a_prepressure_beyond_the_whole_wave_is_full_contact():
    unit = {"k_N": 0.5, "W": 1.0, "k_c": 1.0, "n_j": 1.0}
    assert call("contact_half_angle", {**unit, "F_c": 3.2})["theta"] == pytest.approx(np.pi, rel=1e-15)


@pytest.mark.parametrize("theta", [0.05, 0.4, 1.5, 3.0])
def test_harmonic_foundation_is_the_fundamental_of_the_layers_reaction(values, theta):
    u = (np.arange(200_000) + 0.5) * TURN / 200_000 - np.pi
    reaction = np.where(np.abs(u) < theta, np.cos(u) - np.cos(theta), 0.0)
    fundamental = values["k_N"] * 2 * np.mean(reaction * np.cos(u))
    assert call("trum_foundation", {**values, "theta": theta})["harmonic"] == pytest.approx(fundamental, rel=1e-4)


def test_full_contact_makes_every_distributed_foundation_the_layer_itself(values):
    found = call("trum_foundation", {**values, "theta": np.pi})
    assert found["harmonic"] == pytest.approx(values["k_N"], rel=1e-15)
    assert found["smeared"] == pytest.approx(values["k_N"], rel=1e-15)
    assert values["k_N"] == pytest.approx(3e10, rel=1e-12)  # 5 GPa * 1.2 mm / 0.2 mm


def test_hertz_half_angle_by_hand(values):
    # rho_k = 2 (30 mm)^2 / (81 * 5.5 um) = 4.04040 m; C_E = 0.8911 / 26.5775 GPa + 0.91 / 5 GPa = 2.155284e-10 1/Pa
    # 2 x_m = 1.6 sqrt(180 * 4.04040 * 2.155284e-10 / (9 * 1.2 mm)) = 6.0956 mm; theta = 300 * 3.0478 mm
    v = {**values, "W": 5.5e-6, "F_c": 180.0}
    assert call("trum_hertz_half_angle", v)["theta"] == pytest.approx(0.91434, abs=2e-4)


def test_measured_amplitude_follows_table_2_within_two_percent(trum60):
    force = np.array([100, 120, 140, 160, 180, 200, 220.0])
    table = np.array([8.3, 7.3, 6.6, 6.0, 5.5, 5.2, 4.8]) * 1e-6
    ours = ts.evaluate(trum60, ts.Drive(prepressure=force)).amplitude
    assert ours == pytest.approx(table, rel=0.02)


def test_forced_amplitude_is_the_two_field_response_near_resonance(values):
    v = {**values, "F_c": 1.0, "C_f": 1.0, "varsigma": 0.0, "xi": 0.0}
    K, M = stiffness_and_mass(v)
    found = call("trum_resonance", v)
    arm = v["h_e"] + v["h_p"] / 2 - v["D"]
    moment = abs(v["d_31"]) / v["s_11E"] * v["U_s"] * v["b_p"] * arm * 4 / np.pi
    for detuning, tolerance in ((1e-5, 1e-4), (1e-3, 1e-2)):
        omega_q = found["quartic"] * (1 + detuning)
        exact = scipy.linalg.solve(K - omega_q**2 * M, [0.0, moment * v["k_c"]])[0]
        ours = call(
            "trum_amplitude_forced", {**v, "omega_n": found["quartic"], "omega_q": omega_q, "beta": found["beta"]}
        )
        assert ours["W"] == pytest.approx(abs(exact), rel=tolerance)


def test_forced_amplitude_at_resonance_falls_with_damping(values):
    found = call("trum_resonance", values)
    v = {**values, "F_c": 180.0, "omega_n": found["quartic"], "omega_q": found["quartic"], "beta": found["beta"]}
    ours = call("trum_amplitude_forced", {**v, "xi": np.array([0.006, 0.012])})["W"]
    assert ours[0] == pytest.approx(2 * ours[1], rel=1e-12)


def test_forced_amplitude_and_resonance_agree_with_each_other(trum60):
    point = ts.evaluate(trum60, amplitude="forced")
    again = ts.evaluate(trum60.with_values({"amplitude": point.amplitude}))
    assert again.resonance_frequency == pytest.approx(point.resonance_frequency, rel=1e-11)


def test_measured_values_replace_the_modelled_ones(trum60):
    motor = trum60.with_values(
        {"resonance_frequency": 39703, "amplitude": 5e-6, "neutral_axis": 3e-3, "wavenumber": 290}
    )
    point = ts.evaluate(motor)
    assert point.resonance_frequency == pytest.approx(39703, rel=1e-15)
    assert (point.amplitude, point.neutral_axis, point.wavenumber) == (5e-6, 3e-3, 290)
    assert point.drive_frequency == pytest.approx(42703, rel=1e-15)


def test_prepressure_stiffens_the_stator_and_no_foundation_leaves_it_alone(trum60):
    drive = ts.Drive(prepressure=np.array([160.0, 180.0, 210.0]))
    loaded = ts.evaluate(trum60, drive).resonance_frequency
    free = ts.evaluate(trum60, drive, foundation="none").resonance_frequency
    assert np.all(np.diff(loaded) > 0)
    assert np.ptp(free) == 0
    assert np.all(loaded > free)
