"""Every figure: the data in its axes against something independent, and the fact that it is there to show.

The witness is ``orbit_reference``: matrix exponentials, a bracketed half-angle, friction cut at its points, an explicit
method of order 8.  It shares no formula with the kernels behind the figures.
"""

from __future__ import annotations

import importlib
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym import plots
from trum_sym.errors import ParameterError
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.cycle import solve
from trum_sym.plots.motion import SECTION_5
from trum_sym.plots.transfer import MODELS
from trum_sym.report.catalogue import PICTURES

orbit_reference = lazily("orbit_reference")
SPEED = 1e6 * ARCSEC


WEIGHT = 0.3 * 0.030 / 9.80665
"""What a weight adds to the rotor's inertia that pulls Table 3's load by a string at 30 mm, kg m^2."""


@cache
def reference(drive, frequency=None, inertia=0.0):
    motor = ts.load_motor("trum60")
    motor = motor.with_values({"rotor_inertia": 4.5e-6 + inertia})
    if frequency is not None:
        motor = motor.with_values({"resonance_frequency": frequency})
    return orbit_reference.Reference(motor, drive, ts.evaluate(motor, drive, tolerance=1e-6))


def states(other, times):
    """w_A, w_B, w_A', w_B' at times of a cycle, (4, n), from matrix exponentials."""
    edges = np.concatenate([[0], np.cumsum(other.durations)])
    columns = []
    for time in np.asarray(times):
        region = min(int(np.searchsorted(edges[1:], time * (1 + 1e-12), side="right")), 2)
        columns.append(
            orbit_reference.modal(other.p, other.states[region], orbit_reference.GATES[region], time - edges[region])
        )
    return np.array(columns).T


def data(axes, index=0):
    """Coordinates of a line of the axes, without gaps."""
    x, y = axes.lines[index].get_data()
    kept = np.isfinite(np.asarray(x, float)) & np.isfinite(np.asarray(y, float))
    return np.asarray(x, float)[kept], np.asarray(y, float)[kept]


def by_label(axes, label):
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def vectors(other, times, region):
    """Both phases as rotating vectors, (2, n), by complex exponentials."""
    omega, xi, omega_q, psi, s, W = other.p[:6]
    start = other.durations[:region].sum()
    tau = np.asarray(times) - start
    eigenvalue = omega * (-xi + 1j * np.sqrt(1 - xi**2))
    found = []
    for i, gate in enumerate(orbit_reference.GATES[region]):
        drive = gate * W * np.exp(1j * (omega_q * tau + psi + i * s * np.pi / 2))
        at = gate * W * np.exp(1j * (psi + i * s * np.pi / 2))
        a, b = other.states[region][2 * i] - at.real, other.states[region][2 * i + 1] - (1j * omega_q * at).real
        free = a + 1j * (eigenvalue.real * a - b) / eigenvalue.imag
        found.append(drive + free * np.exp(eigenvalue * tau))
    return np.array(found)


# --- Figs. 3 and 6 -------------------------------------------------------------------------------------------
def test_fig_3_is_both_phases_and_they_ring_down_with_the_damping():
    figure = plots.phase_responses()
    other = reference(ts.Drive())
    W = other.p[5]
    for axes, row in zip(figure.axes, (0, 1), strict=True):
        time, shown = data(axes)
        assert shown[::7] == pytest.approx(1e6 * states(other, 1e-3 * time[::7])[row], abs=1e-4 * W * 1e6)
        _, envelope = data(axes, 1)
        assert np.all(np.abs(shown) <= envelope * (1 + 1e-9))
        edges = 1e3 * np.concatenate([[0], np.cumsum(other.durations)])
        off = (time >= edges[row]) & (time < edges[row + 1] * 0.9999)
        decay = envelope[off][-1] / envelope[off][0]
        span = 1e-3 * (time[off][-1] - time[off][0])
        assert decay == pytest.approx(np.exp(-other.p[1] * other.p[0] * span), rel=1e-9)
    names = [text.get_text() for text in figure.axes[0].texts]
    assert names == ["A off", "B off", "both on"]


def test_fig_6_is_a_sine_along_the_wave_of_both_phases_velocities():
    (axes,) = plots.tangential_velocity().axes
    other = reference(ts.Drive())
    k = 9 / 30e-3
    edges = np.concatenate([[0], np.cumsum(other.durations)])
    for region in range(3):
        x, v = data(axes, 2 * region)
        middle = (edges[region] + edges[region + 1]) / 2
        w = states(other, [middle])[:, 0]
        expected = other.p[6] * (w[2] * np.cos(k * 1e-3 * x) - w[3] * np.sin(k * 1e-3 * x))
        assert v == pytest.approx(expected, abs=1e-8 * np.abs(v).max())
        assert v[:91] == pytest.approx(-v[90:], abs=1e-9)  # half a wavelength on, the other way
        crest, _ = data(axes, 2 * region + 1)
        height = w[0] * np.sin(k * 1e-3 * crest) + w[1] * np.cos(k * 1e-3 * crest)
        assert height == pytest.approx(np.hypot(w[0], w[1]), rel=1e-9)


# --- Figs. 9 to 17 -------------------------------------------------------------------------------------------
# which quarters of the region's first beat turn clockwise for the most part; with B off it is the end of the fourth
@pytest.mark.parametrize(
    ("region", "clockwise"),
    [(0, (True, False, False, True)), (1, (False, False, False, True)), (2, (True, True, True, True))],
)
def test_figs_9_12_15_the_path_turns_as_its_determinant_says(region, clockwise):
    other = reference(SECTION_5[region])
    k, D = 9 / 30e-3, other.p[6] / (9 / 30e-3)
    low = other.durations[:region].sum()
    for number, axes in enumerate(plots.ellipse(region=region).axes[:4]):
        (x_c, z_c), (x_cc, z_cc) = (
            (np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)) for line in axes.lines[:2]
        )
        x, z = np.where(np.isnan(x_c), x_cc, x_c), np.where(np.isnan(z_c), z_cc, z_c)
        quarter = 1 / 3000 / 4
        time = low + quarter * (number + np.linspace(0, 1, len(x)))
        w = states(other, time)
        angle = np.pi / 4
        assert z == pytest.approx(1e6 * (w[0] * np.sin(angle) + w[1] * np.cos(angle)), abs=2e-3)
        assert x == pytest.approx(1e6 * D * k * (w[0] * np.cos(angle) - w[1] * np.sin(angle)), abs=2e-3)
        turn = x[:-1] * z[1:] - z[:-1] * x[1:]  # < 0: clockwise, seen from the picture alone
        blue = ~np.isnan(x_c[:-1]) & ~np.isnan(x_c[1:])
        assert np.all(turn[blue] < 1e-3)
        assert np.all(turn[~np.isnan(x_cc[:-1]) & ~np.isnan(x_cc[1:])] > -1e-3)
        forward = w[2] * w[1] - w[3] * w[0] > 0
        assert np.mean(~np.isnan(x_c)) == pytest.approx(np.mean(forward), abs=0.01)
        assert (np.mean(forward) > 0.5) == clockwise[number]


@pytest.mark.parametrize("region", [0, 1, 2])
def test_figs_10_13_16_the_displacement_fills_its_envelope_which_beats(region):
    (axes,) = plots.vertical_displacement(region=region).axes
    other = reference(SECTION_5[region])
    time, shown = data(axes)
    at = other.durations[:region].sum() + 1e-3 * time[:-1]
    A, B = vectors(other, at, region)
    turning = (A + B) / np.sqrt(2)
    assert shown[:-1] == pytest.approx(1e6 * turning.real, abs=1e-4)
    _, envelope = data(axes, 1)
    assert envelope[:-1] == pytest.approx(1e6 * np.abs(turning), abs=1e-4)
    lows = np.flatnonzero((envelope[1:-1] < envelope[:-2]) & (envelope[1:-1] < envelope[2:])) + 1
    spacing = np.diff(time[lows])
    assert len(lows) >= 3
    assert spacing[-2:] == pytest.approx(1 / 3, rel=0.05)  # the beat of 3 kHz in ms, in all three regions


SIGNS = {0: (1, -1, 1, -1, 1, -1, 1), 1: (1, -1, 1, -1, 1, -1, 1), 2: (1,)}


@pytest.mark.parametrize("region", [0, 1, 2])
def test_figs_11_14_17_q_and_the_crests_velocity_have_one_sign_pattern(region):
    upper, lower = plots.determinant(region=region).axes
    other = reference(SECTION_5[region])
    time, Q = data(upper)
    _, crest = data(lower)
    w = states(other, other.durations[:region].sum() + 1e-3 * time[:-1])
    exact = other.p[6] * (w[2] * w[1] - w[3] * w[0])
    assert Q[:-1] == pytest.approx(1e6 * exact, abs=1e-5 * np.abs(Q).max())
    assert crest[:-1] == pytest.approx(exact / np.hypot(w[0], w[1]), abs=1e-4)
    assert np.all((Q * crest > 0) | (np.abs(Q) < 1e-9))
    smooth = np.convolve(Q, np.ones(40) / 40, mode="valid")  # over a drive period
    signs = np.sign(smooth[np.abs(smooth) > 0.02 * np.abs(Q).max()])
    assert tuple(signs[np.flatnonzero(np.diff(signs, prepend=0))]) == SIGNS[region]


# --- Figs. 18 and 19 -----------------------------------------------------------------------------------------
def test_fig_18_is_the_independent_orbit_with_its_mean_and_deviation():
    (axes,) = plots.instantaneous_speed().axes
    orbit = reference(ts.Drive()).orbit()
    time, speed = by_label(axes, "v_i")
    assert speed.max() * SPEED == pytest.approx(orbit.high, abs=2e-3 * orbit.largest)
    assert speed.min() * SPEED == pytest.approx(orbit.low, abs=2e-3 * orbit.largest)
    _, mean = by_label(axes, "v_s")
    assert mean[0] * SPEED == pytest.approx(orbit.mean, abs=1e-6 * orbit.largest)
    one = len(time) // 2
    assert np.array_equal(speed[: one + 1], speed[one:])  # periodic
    area = np.sum((speed[1:] + speed[:-1]) / 2 * np.diff(time)) / time[-1]
    assert area == pytest.approx(mean[0], abs=2e-3)
    band = axes.patches[0].get_extents().transformed(axes.transData.inverted())
    assert (band.y1 - band.y0) / 2 * SPEED == pytest.approx(orbit.deviation, rel=1e-5)


def test_fig_19_shades_the_sums_of_eq_43():
    (axes,) = plots.forward_and_backward().axes
    time, Q = by_label(axes, "Q")
    areas = {}
    for shade in axes.collections:
        vertices = np.concatenate([path.vertices for path in shade.get_paths()])
        areas[shade.get_label()] = np.sign(vertices[np.argmax(np.abs(vertices[:, 1])), 1])
    assert areas == {"clockwise": 1.0, "counter-clockwise": -1.0}
    forward, backward = (np.trapezoid(np.clip(sign * Q, 0, None), time) for sign in (1, -1))
    point = ts.evaluate(ts.load_motor("trum60"))
    assert forward / backward == pytest.approx(point.q_ratio, rel=2e-3)
    w = states(reference(ts.Drive()), 1e-3 * time[:-1:9])
    assert Q[:-1:9] == pytest.approx(1e6 * reference(ts.Drive()).p[6] * (w[2] * w[1] - w[3] * w[0]), abs=1e-3)


# --- Figs. 7 and 8, the contact zone -------------------------------------------------------------------------
def panel_shares(figure):
    return [float(axes.get_title(loc="left").split("\n")[-1].split(" ")[0]) for axes in figure.axes]


def test_figs_7_8_each_panel_is_its_model_and_the_zones_have_the_signs_of_friction():
    forward, backward = plots.transfer_models(), plots.transfer_models(forward=False)
    for figure, way in ((forward, 1), (backward, -1)):
        models = [model for model in MODELS if model.forward == (way > 0)]
        for axes, model in zip(figure.axes, models, strict=True):
            u, surface_speed = data(axes)
            rotor = float(axes.lines[1].get_ydata()[0])
            assert np.sign(rotor) == way
            ahead = np.sign(surface_speed - rotor)
            assert (ahead[0], ahead[-1]) == (model.crest, model.edge)
            turns = np.sum(np.diff(np.sign(np.diff(surface_speed))) != 0)
            assert turns == model.extremum
            # a sine of amplitude 1 along the zone: v'' = -v
            second = np.gradient(np.gradient(surface_speed, u), u)[5:-5]
            assert second == pytest.approx(-surface_speed[5:-5], abs=2e-3)
            # "+" where the surface is ahead of the rotor in the rotor's own direction
            marks = [(text.get_position()[0], text.get_text()) for text in axes.texts]
            for place, mark in marks:
                drives = np.interp(place, u, surface_speed) * way > rotor * way
                assert mark == ("+" if drives else "−")
            assert len(marks) == 1 + np.sum(np.diff(ahead) != 0)
    assert sum(panel_shares(forward)) + sum(panel_shares(backward)) == pytest.approx(100, abs=0.5)


def test_figs_7_8_the_shares_are_those_of_the_independent_friction():
    other = reference(ts.Drive())
    orbit = other.orbit()
    assert sum(panel_shares(plots.transfer_models())) == pytest.approx(100 * forward_share(other, orbit), abs=1.5)


def forward_share(other, orbit):
    times = np.linspace(0, other.cycle_time, 81)[1:]
    whole, ahead = other.durations.copy(), 0
    edges = np.concatenate([[0], np.cumsum(whole)])
    for time in times:
        region = min(int(np.searchsorted(edges[1:], time)), 2)
        other.durations = np.where(np.arange(3) < region, whole, 0.0)
        other.durations[region] = time - edges[region]
        ahead += orbit.start + other.lap(orbit.start * other.radius, 1e-8)[0][0] / other.radius > 0
    other.durations = whole
    return ahead / len(times)


def test_the_contact_zone_carries_the_prepressures_friction_within_its_edges():
    figure = plots.contact_zone()
    upper, lower = figure.axes[:2]
    mesh = upper.collections[0]
    traction = 1e3 * np.asarray(mesh.get_array())  # N/m
    time, theta = data(upper, 0)
    _, share = data(lower, 0)
    other = reference(ts.Drive())
    w = states(other, 1e-3 * time[:-1])
    angles = np.array([orbit_reference.half_angle(other.p, height) for height in np.hypot(w[0], w[1])])
    assert theta[:-1] == pytest.approx(angles, rel=1e-6)
    assert share == pytest.approx(theta / np.pi)
    rows = np.asarray(mesh.get_coordinates())[:, 0, 1]
    u = (rows[1:] + rows[:-1]) / 2
    outside = np.abs(u[:, None]) > theta[None, :] + (u[1] - u[0])
    assert np.all(traction[outside] == 0)
    # on all crests the magnitude adds up to mu F_c, its sign to the net friction
    k, crests = 9 / 30e-3, 9
    total = crests * np.sum(np.abs(traction), axis=0) * (u[1] - u[0]) / k
    assert np.median(total) == pytest.approx(0.25 * 180, rel=0.03)
    _, speed, _ = solve(None, None).rotor(len(time) - 1)
    net = [orbit_reference.surface(other.p, w[:, i], speed[i] * other.radius)[0] for i in range(len(time) - 1)]
    ours = crests * np.sum(traction, axis=0) * (u[1] - u[0]) / k / 45
    assert ours[:-1] == pytest.approx(np.array(net), abs=0.12)
    assert np.corrcoef(ours[:-1], net)[0, 1] > 0.998


# --- Figs. 20 to 23 and 30 to 32 -----------------------------------------------------------------------------
@pytest.mark.parametrize("variable", ["frequency_difference", "prepressure"])
def test_figs_20_22_are_independent_orbits_and_the_swing_dwarfs_the_mean(variable):
    four = plots.cycles(variable=variable).axes
    values = {"frequency_difference": np.linspace(2800, 3300, 6), "prepressure": np.linspace(160, 210, 6)}[variable]
    for column, (start, lead) in enumerate((("periodic", 1), ("rest", -1))):
        for index in (0, 5):
            drive = ts.Drive(start=start, phase_lead=lead, **{variable: float(values[index])})
            other = reference(drive)
            orbit = other.orbit()
            time, speed = data(four[column], index)
            assert speed.max() * SPEED == pytest.approx(orbit.high, abs=3e-3 * orbit.largest)
            assert speed.min() * SPEED == pytest.approx(orbit.low, abs=3e-3 * orbit.largest)
            mean = np.trapezoid(speed, time) / time[-1]
            assert mean * SPEED == pytest.approx(orbit.mean, abs=3e-3 * orbit.largest)
            assert speed.max() - speed.min() > 3 * abs(mean)
            time, Q = data(four[2 + column], index)
            w = states(other, 1e-3 * time[:-1:7])
            exact = 1e6 * other.p[6] * (w[2] * w[1] - w[3] * w[0])
            assert Q[:-1:7] == pytest.approx(exact, abs=1e-6 * np.abs(Q).max())
        assert four[column].lines[0].get_label().split()[0] == f"{values[0]:g}"


def trend(values):
    steps = np.diff(values)
    return "rises" if np.all(steps > 0) else "falls" if np.all(steps < 0) else "mixed"


READ = ("periodic, lead +1", "steady, lead −1", "rest, lead −1")
TRENDS = {
    "frequency_difference": {"q_average": ("mixed", "rises", "falls"), "q_volatility": ("mixed", "falls", "rises")},
    "prepressure": {"q_average": ("falls", "falls", "rises"), "q_volatility": ("rises", "rises", "falls")},
}


@pytest.mark.parametrize("variable", ["frequency_difference", "prepressure"])
def test_figs_21_23_have_the_trends_and_the_points_of_the_independent_orbit(variable):
    speed, average, volatility, vibration = plots.trends(variable=variable).axes
    for axes, name in ((average, "q_average"), (vibration, "q_volatility")):
        assert tuple(trend(by_label(axes, label)[1]) for label in READ) == TRENDS[variable][name]
    for label, (start, lead) in zip(READ, (("periodic", 1), ("steady", -1), ("rest", -1)), strict=True):
        for index in (0, 25):
            x, v = by_label(speed, label)
            drive = ts.Drive(start=start, phase_lead=lead, **{variable: float(x[index])})
            other = reference(drive)
            orbit = other.orbit()
            assert v[index] * SPEED == pytest.approx(orbit.mean, abs=2e-3 * orbit.largest)
            sigma = by_label(volatility, label)[1][index]
            assert sigma == pytest.approx(100 * orbit.volatility, rel=0.03)
            times = np.linspace(0, other.cycle_time, 8001)
            w = states(other, times[:-1])
            Q = w[2] * w[1] - w[3] * w[0]
            share = np.sum(Q) / np.sum(np.abs(Q)) / other.cycle_time
            assert by_label(average, label)[1][index] == pytest.approx(share, rel=2e-3)
    for axes, printed in ((average, 1447.5), (vibration, 3446.4), (volatility, 17.3), (speed, 633e-6)):
        x, y = by_label(axes, "Table 4")
        assert y[0] == pytest.approx(printed)
        assert x[0] == {"frequency_difference": 3000, "prepressure": 180}[variable]


def test_figs_30_31_average_over_the_encoder_and_carry_the_weight_and_31_is_at_3300_hz():
    continuous, read = plots.trends().axes[2], plots.trends(sampling_period=2e-3).axes[2]
    for label in READ:
        assert np.all(by_label(read, label)[1] < by_label(continuous, label)[1])
    motor = ts.load_motor("trum60")
    drawn = {
        picture.anchor: picture.draw(motor) for picture in PICTURES if picture.anchor in ("figure-30", "figure-31")
    }
    for anchor, place in (("figure-30", 10), ("figure-31", 3)):
        (x, speed), (_, sigma) = (by_label(drawn[anchor].axes[i], READ[2]) for i in (0, 2))
        setting = (
            {"frequency_difference": float(x[place])}
            if anchor == "figure-30"
            else {"prepressure": float(x[place]), "frequency_difference": 3300.0}
        )
        drive = ts.Drive(**setting, start="rest", phase_lead=-1)
        orbit = reference(drive, inertia=WEIGHT).orbit()
        assert speed[place] * SPEED == pytest.approx(orbit.mean, abs=2e-3 * orbit.largest)
        assert sigma[place] == pytest.approx(100 * windows(drive, WEIGHT).std() / abs(orbit.mean), rel=0.02)


@cache
def windows(drive, inertia=0.0):
    """Readings of a 2 ms encoder from the independent orbit's path, rad/s."""
    return orbit_reference.encoder_readings(reference(drive, inertia=inertia), 2e-3)


def test_fig_32_is_table_5():
    speed, average, *_ = plots.multivariable().axes
    forces, differences = (180, 170, 160, 190, 200, 210), (3300, 3100, 3000, 2800, 2900, 3200)
    for label, (start, lead) in zip(READ[::2], (("periodic", 1), ("rest", -1)), strict=True):
        number, v = by_label(speed, label)
        assert list(number) == [1, 2, 3, 4, 5, 6]
        for i in (0, 3, 5):
            drive = ts.Drive(prepressure=forces[i], frequency_difference=differences[i], start=start, phase_lead=lead)
            orbit = reference(drive).orbit()
            assert v[i] * SPEED == pytest.approx(orbit.mean, abs=2e-3 * orbit.largest)
    assert np.argmin(by_label(average, READ[0])[1]) == 3  # 2800 Hz, the lowest of the six


# --- Figs. 25b to 29 -----------------------------------------------------------------------------------------
def test_fig_25b_orders_the_levels_and_the_layer_only_stiffens():
    (axes,) = plots.resonance_levels().axes
    bare = {level: by_label(axes, f"{level}, none")[1] for level in ("quartic", "eq6", "printed", "euler")}
    assert np.all(bare["eq6"] < bare["quartic"])
    assert np.all(bare["quartic"] < bare["printed"])
    assert np.all(bare["printed"] < bare["euler"])
    for level, frequency in bare.items():
        assert np.ptp(frequency) == 0
        for foundation in ("harmonic", "smeared", "printed"):
            force, loaded = by_label(axes, f"{level}, {foundation}")
            assert np.all(loaded > frequency)
            assert trend(loaded) == "rises"
    assert (force[0], force[-1]) == (100, 220)
    # Timoshenko's equations as a matrix: stiffness and inertia of deflection and rotation, the lower eigenvalue
    motor = ts.load_motor("trum60")
    assert bare["quartic"][0] == pytest.approx(1e-3 * timoshenko(motor), rel=1e-9)
    (line,) = [line for line in axes.lines if line.get_label() == "measured (Sect. 7.3)"]
    assert line.get_ydata()[0] == pytest.approx(39.703)


def timoshenko(motor):
    value = {name: float(parameter.value) for name, parameter in motor.parameters()}
    h_t, h_e, h_p = value["tooth_height"], value["beam_thickness"], value["piezo_thickness"]
    kept = 1 - h_t / h_e * value["tooth_count"] * value["slot_width"] / value["perimeter"]
    E_e, E_p = (1 - h_t / h_e) ** 3 * value["beam_young_modulus"], value["piezo_young_modulus"]
    b_e, b_p = value["beam_width"], value["piezo_width"]
    A_e, A_p = b_e * h_e, b_p * h_p
    D = (E_e * A_e * h_e / 2 + E_p * A_p * (h_e + h_p / 2)) / (E_e * A_e + E_p * A_p)
    I_e = b_e * h_e**3 / 12 + A_e * (D - h_e / 2) ** 2
    I_p = b_p * h_p**3 / 12 + A_p * (h_e + h_p / 2 - D) ** 2
    inertia_of_area, A = I_e + I_p, A_e + A_p
    rho = (kept * value["beam_density"] * A_e + value["piezo_density"] * A_p) / A
    G = (kept * value["beam_shear_modulus"] * A_e + value["piezo_shear_modulus"] * A_p) / A
    EI, shear, k = E_e * I_e + E_p * I_p, value["shear_correction"] * G * A, 9 / value["radius"]
    stiffness = np.array([[shear * k**2, shear * k], [shear * k, EI * k**2 + shear]])
    inertia = np.diag([rho * A, rho * inertia_of_area])
    return np.sqrt(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).min().real) / (2 * np.pi)


def crossings(time, values):
    rising = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    return time[rising] - values[rising] * (time[rising + 1] - time[rising]) / (values[rising + 1] - values[rising])


def test_fig_26b_changes_from_45_khz_to_the_resonance_and_decays_with_the_damping():
    (axes,) = plots.power_off().axes
    time, velocity = by_label(axes, "velocity of M, phase A alone")
    before, after = (np.diff(crossings(time[part], velocity[part])) for part in (time < 0, time > 0))
    assert 1 / before == pytest.approx(45.0, rel=1e-3)  # kHz
    assert 1 / np.mean(after) == pytest.approx(39.703 * np.sqrt(1 - 0.006**2), rel=1e-4)
    peaks = (
        np.abs(velocity[time < 0]).max(),
        *(np.abs(velocity[(time >= 1e3 * n / 39703) & (time < 1e3 * (n + 1) / 39703)]).max() for n in (2, 30)),
    )
    assert peaks[0] == pytest.approx(1.0)
    assert peaks[2] / peaks[1] == pytest.approx(np.exp(-0.006 * 2 * np.pi * 28), rel=0.01)


def test_fig_27b_beats_with_the_difference_of_45_and_39_703_khz():
    (axes,) = plots.beat().axes
    time, velocity = by_label(axes, "velocity of M, both phases")
    assert np.abs(velocity[time < 0]).max() == pytest.approx(1.0)
    per = 48  # samples of a drive period
    envelope = np.array([np.abs(velocity[i : i + per]).max() for i in range(9 * per, len(velocity) - per)])
    at = time[9 * per : len(velocity) - per] + 0.5 / 45
    beats = [
        at[(at > low) & (at < low + 0.1888)][np.argmin(envelope[(at > low) & (at < low + 0.1888)])]
        for low in (0.0, 0.1888, 0.3776)
    ]
    assert np.diff(beats) == pytest.approx(1 / 5.297, rel=0.06)
    drive = ts.Drive(frequency_difference=5297.0, periods=90, on_periods=45, start="steady")
    w = states(reference(drive, 39703.0), 1e-3 * time[time >= 0])
    expected = (w[2] + w[3]) / (np.sqrt(2) * np.pi * 2 * 45e3 * reference(drive, 39703.0).p[5])
    assert velocity[time >= 0] == pytest.approx(expected, abs=2e-3)


def test_fig_29_is_what_an_encoder_reads():
    for axes, (start, lead) in zip(
        plots.measured_speed().axes, (("periodic", 1), ("steady", -1), ("rest", -1)), strict=True
    ):
        time, deviation = data(axes)
        assert np.diff(time) == pytest.approx(2.0)
        drive = ts.Drive(start=start, phase_lead=lead)
        readings = windows(drive)
        expected = 100 * (readings / reference(drive).orbit().mean - 1)
        assert deviation.max() <= expected.max() + 0.3
        assert deviation.min() >= expected.min() - 0.3
        assert np.ptp(deviation) > 0.9 * np.ptp(expected)  # sixty windows come close to both extremes
        assert np.std(deviation) == pytest.approx(np.std(expected), rel=0.1)


# --- what the paper does not show ----------------------------------------------------------------------------
def test_torque_against_speed_falls_and_passes_the_independent_orbits():
    (axes,) = plots.torque_speed().axes
    for label, (start, lead) in zip(READ, (("periodic", 1), ("steady", -1), ("rest", -1)), strict=True):
        load, speed = by_label(axes, label)
        assert trend(speed) == "falls"
        for index in (10, 30, 45):
            drive = ts.Drive(start=start, phase_lead=lead, load_torque=float(load[index]))
            orbit = reference(drive).orbit()
            assert speed[index] * SPEED == pytest.approx(orbit.mean, abs=2e-3 * orbit.largest)
    assert max(load) == pytest.approx(0.98 * 0.25 * 180 * 26.5e-3)
    stalls = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "o"]
    held = []
    for start, lead in (("periodic", 1), ("steady", -1), ("rest", -1)):
        other = reference(ts.Drive(start=start, phase_lead=lead))
        w = states(other, np.linspace(0, other.cycle_time, 2000, endpoint=False) + 1e-12)
        held.append(
            other.radius * 45 * np.mean([orbit_reference.surface(other.p, w[:, i], 0.0)[0] for i in range(2000)])
        )
    assert stalls == pytest.approx(held, abs=3e-3)


def test_the_maps_hold_independent_orbits_and_the_line_is_zero_speed():
    figure = plots.maps()
    for row, spans in ((0, ((2800, 3300), (160, 210))), (1, ((500, 5000), (100, 220)))):
        speed, volatility, average = figure.axes[3 * row : 3 * row + 3]
        mesh = speed.collections[0]
        corners = np.asarray(mesh.get_coordinates())
        x, y = ((corners[:-1, :-1, i] + corners[1:, 1:, i]) / 2 for i in (0, 1))
        assert (x.min(), x.max(), y.min(), y.max()) == pytest.approx((*spans[0], *spans[1]))
        shown = np.asarray(mesh.get_array()).reshape(x.shape)
        for i, j in ((3, 4), (25, 11)):
            orbit = reference(ts.Drive(frequency_difference=x[i, j], prepressure=y[i, j])).orbit()
            assert shown[i, j] * SPEED == pytest.approx(orbit.mean, abs=2e-3 * orbit.largest)
            sigma = np.asarray(volatility.collections[0].get_array()).reshape(x.shape)[i, j]
            assert sigma == pytest.approx(np.log10(100 * orbit.volatility), abs=0.05)
        assert np.ptp(np.asarray(average.collections[0].get_array())) > 100
        (line,) = [c for c in speed.collections if c is not mesh]
        for path in line.get_paths():
            for point in path.vertices[:: max(1, len(path.vertices) // 2)]:
                orbit = reference(ts.Drive(frequency_difference=float(point[0]), prepressure=float(point[1]))).orbit()
                assert abs(orbit.mean) < 0.03 * orbit.largest  # the line runs straight between grid points


def test_the_scatter_of_the_page_has_what_the_encoder_reads_of_a_motor_with_its_weight(monkeypatch):
    maps = importlib.import_module("trum_sym.plots.maps")  # the package has a function of this name
    seen = []
    evaluate = maps.evaluate
    monkeypatch.setattr(maps, "evaluate", lambda *a, **k: seen.append((a, k)) or evaluate(*a, **k))
    (picture,) = [picture for picture in PICTURES if picture.anchor == "speed-determinant"]
    picture.draw(ts.load_motor("trum60"))
    assert len(seen) == 6
    for (motor, _), options in seen:
        assert float(motor.rotor_inertia.value) == pytest.approx(4.5e-6 + WEIGHT, rel=1e-12)
        assert options["sampling_period"] == 2e-3


def test_the_scatter_states_the_rank_correlation_of_its_own_dots():
    stats = pytest.importorskip("scipy.stats")
    four = plots.prediction().axes
    for axes in four:
        for label in READ:
            (line,) = [found for found in axes.lines if found.get_label().startswith(label)]
            x, y = (np.asarray(values, float) for values in line.get_data())
            assert len(x) == 144
            stated = float(line.get_label().split()[-1].replace("−", "-"))
            assert stated == pytest.approx(stats.spearmanr(x, y).statistic, abs=0.006)
    labels = [line.get_label() for line in four[0].lines]
    ranks = {label.split(":")[0]: float(label.split()[-1].replace("−", "-")) for label in labels if "rank" in label}
    assert ranks[READ[1]] > 0.9  # in steady the determinant predicts the speed over the box,
    assert abs(ranks[READ[2]]) < 0.5  # from rest it does not


# --- all of them ---------------------------------------------------------------------------------------------
def test_figures_draw_in_axes_that_are_given_and_refuse_another_number():
    from matplotlib.figure import Figure

    mine = Figure()
    axes = mine.subplots(1, 2)
    assert plots.torque_speed(axes=axes[0]) is mine
    assert axes[0].lines
    assert not axes[1].lines
    with pytest.raises(ParameterError, match="axes: got 2 axes, need 1 of them"):
        plots.torque_speed(axes=axes)


def test_a_motor_of_ones_own_is_drawn():
    motor = ts.load_motor("trum60").with_values({"damping_ratio": 0.02})
    (axes, _) = plots.phase_responses(motor).axes
    (usual, _) = plots.phase_responses().axes
    assert np.abs(data(axes)[1]).max() < 0.9 * np.abs(data(usual)[1]).max()


def test_where_friction_gives_table_4_is_drawn_for_a_motor_that_publishes_nothing():
    """Its own friction and contact radius do not count; a stator that is damped more is another one."""
    motor = replace(ts.load_motor("trum60").with_values({"damping_ratio": 0.007}), published=())
    (left, right) = plots.load_region(motor).axes
    for line in left.get_lines():
        friction = line.get_ydata()
        assert np.isnan(friction[0]) or (np.diff(friction[np.isfinite(friction)]) > 0).all()
    heavy = [line.get_ydata()[-1] for line in left.get_lines()]
    assert np.multiply(heavy, (0.025, 0.0265, 0.030)) == pytest.approx(heavy[1] * 0.0265, rel=2e-3)
    assert right.get_lines()[-1].get_ydata()[0] == pytest.approx(17.3)


def test_the_catalogue_has_every_figure_of_the_paper_that_can_be_drawn():
    anchors = [picture.anchor for picture in PICTURES]
    numbers = ["3", "6", "7", "8", *map(str, range(9, 24)), "25b", "26b", "27b", *map(str, range(29, 33))]
    assert [anchor.removeprefix("figure-") for anchor in anchors if anchor.startswith("figure-")] == numbers
    assert set(anchors) - {f"figure-{n}" for n in numbers} == {
        "map-periodic",
        "map-rest",
        "speed-determinant",
        "torque-speed",
        "load-region",
        "contact-zone",
    }


def test_the_start_and_the_stop_are_the_motion_that_the_engine_makes():
    from trum_sym.model.coupled_orbit import lap_values, laps, start_of
    from trum_sym.model.levels import Levels

    drive, schedule = ts.Drive(load_torque=0.05), ts.Schedule(kind="burst", periods=40, on_periods=10)
    figure = plots.start_and_stop(None, drive, schedule, cycles=2, pause=30, rotor_mass=0, compliance="flange")
    upper, lower = figure.axes
    values = lap_values(ts.load_motor(), drive, Levels(compliance="flange"), schedule, rotor_mass=0.0)
    period = 2e3 * np.pi / values["omega_q"]
    time, speed = data(upper)
    end, lap = laps({**values, "m": 10.0}, start_of("rest", values)[:, np.newaxis])
    assert np.interp(10 * period, time, speed) == pytest.approx(end[6, 0] / values["r_c"], rel=1e-6)
    assert data(lower)[1].max() == pytest.approx(1e6 * lap["highest"][0], rel=0.02)
    assert speed[-1] == 0
    assert [patch.get_x() for patch in upper.patches] == pytest.approx([10 * period, 50 * period])
    assert sum(patch.get_width() for patch in upper.patches) == pytest.approx(90 * period)
