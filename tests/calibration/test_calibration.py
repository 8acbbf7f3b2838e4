"""Calibration recovers what is known, and says so when it cannot."""

from __future__ import annotations

import contextlib
import json
import warnings
from dataclasses import replace

import numpy as np
import pytest
import scipy

import trum_sym as ts
from trum_sym import console
from trum_sym.calibration.models import PointModel
from trum_sym.inputs.measurements import from_columns
from trum_sym.inputs.motor import SPECS
from trum_sym.model.coupling import coupled_values
from trum_sym.model.levels import Levels
from trum_sym.model.port import free_admittance

LEVELS = Levels()
FORCE = np.array([100.0, 120, 140, 160, 180, 200, 220])
AMPLITUDE = 1e-6 * np.array([8.3, 7.3, 6.6, 6.0, 5.5, 5.2, 4.8])  # Table 2
TABLE_2 = {"prepressure": FORCE, "amplitude": AMPLITUDE}
FREE = 12.6e-6


def noise(seed):
    return np.random.default_rng(seed)


# --- Eq. 8: against the straight line of logarithms, and SciPy on a power law of its own -----------


def test_relative_errors_give_the_straight_line_of_logarithms():
    found = ts.calibrate(TABLE_2, errors="relative")
    line = scipy.stats.linregress(np.log(FORCE), np.log(AMPLITUDE / FREE))
    t = scipy.stats.t.ppf(0.975, 5)
    exponent, factor = found["amplitude_exponent"], found["amplitude_factor"]
    assert exponent.value == pytest.approx(-line.slope, rel=1e-9)
    assert exponent.high - exponent.value == pytest.approx(t * line.stderr, rel=1e-6)
    assert factor.value == pytest.approx(np.exp(line.intercept), rel=1e-9)
    # of exp(intercept) to first order
    assert factor.value - factor.low == pytest.approx(t * factor.value * line.intercept_stderr, rel=1e-6)
    assert found.explained == pytest.approx(line.rvalue**2, abs=1e-9)
    assert found.residuals.degrees_of_freedom == 5


def test_absolute_errors_give_what_curve_fit_gives():
    found = ts.calibrate(TABLE_2)
    best, covariance = scipy.optimize.curve_fit(
        lambda f, c, e: FREE * c * f**-e, FORCE, AMPLITUDE, [10, 0.5], method="lm", xtol=1e-14, ftol=1e-14
    )
    assert [e.value for e in found.estimates] == pytest.approx(best, rel=1e-7)
    assert found.covariance == pytest.approx(covariance, rel=1e-4)
    assert found.correlation[0, 1] == pytest.approx(covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))


def test_the_papers_constants_lie_within_table_2s_intervals():
    found = ts.calibrate(TABLE_2)
    assert found["amplitude_exponent"].low < 0.678 < found["amplitude_exponent"].high
    assert found["amplitude_factor"].low < 14.926 < found["amplitude_factor"].high


def test_an_uncertainty_weighs_its_row():
    sigma = 1e-7 * np.array([1.0, 1, 1, 1, 1, 1, 50])
    found = ts.calibrate({**TABLE_2, "amplitude_uncertainty": sigma})
    best, covariance = scipy.optimize.curve_fit(
        lambda f, c, e: FREE * c * f**-e, FORCE, AMPLITUDE, [10, 0.5], sigma=sigma
    )
    assert [e.value for e in found.estimates] == pytest.approx(best, rel=1e-5)
    assert found.covariance == pytest.approx(covariance, rel=1e-3)


# --- Decay: against the logarithmic decrement and SciPy on a closed form ---------------------------


def decay(time, damping, frequency, amplitude=2e-6, phase=0.3):
    omega = 2 * np.pi * frequency
    turn = omega * np.sqrt(1 - damping**2) * time + phase
    return amplitude * np.exp(-damping * omega * time) * np.cos(turn)


@pytest.mark.parametrize("damping", [0.0006, 0.006, 0.05])
def test_a_decay_without_noise_gives_back_its_damping_and_resonance(damping):
    time = np.arange(400) / 300e3 + 0.02
    found = ts.calibrate(
        {"time": time, "displacement": 1e-7 + decay(time - 0.02, damping, 39703.0)},
        parameters=["damping_ratio", "resonance_frequency"],
    )
    assert found["damping_ratio"].value == pytest.approx(damping, rel=1e-8)
    assert found["resonance_frequency"].value == pytest.approx(39703.0, rel=1e-9)
    assert found["offset"].value == pytest.approx(1e-7, rel=1e-6)
    assert not found["offset"].in_motor


def test_a_signal_gives_what_curve_fit_gives():
    time = np.arange(300) / 250e3
    signal = decay(time, 0.006, 39000.0) + noise(1).normal(0, 5e-8, time.size)
    found = ts.calibrate({"time": time, "velocity": signal})
    best, covariance = scipy.optimize.curve_fit(
        decay, time, signal, [0.005, 39000.0, 2e-6, 0.3], x_scale=[1e-3, 10, 1e-6, 1], method="trf"
    )
    assert found["damping_ratio"].value == pytest.approx(best[0], rel=0.02)  # it has no offset
    assert found["damping_ratio"].standard_error == pytest.approx(np.sqrt(covariance[0, 0]), rel=0.02)
    assert found["resonance_frequency"].value == pytest.approx(best[1], abs=1.0)


def test_an_envelope_gives_the_logarithmic_decrement():
    frequency, damping = 40e3, 0.008
    peaks = np.arange(12) / (frequency * np.sqrt(1 - damping**2))  # one a period
    decrement = 2 * np.pi * damping / np.sqrt(1 - damping**2)
    envelope = 3e-6 * np.exp(-decrement * np.arange(12)) * np.exp(noise(2).normal(0, 0.02, 12))
    motor = ts.load_motor("trum60").with_values({"resonance_frequency": frequency})
    found = ts.calibrate({"time": peaks, "envelope": envelope}, motor, errors="relative")
    line = scipy.stats.linregress(np.arange(12), np.log(envelope))
    measured = -line.slope / np.sqrt(4 * np.pi**2 + line.slope**2)
    assert found["damping_ratio"].value == pytest.approx(measured, rel=1e-5)
    width = found["damping_ratio"].high - found["damping_ratio"].value
    assert width == pytest.approx(scipy.stats.t.ppf(0.975, 10) * line.stderr * measured / -line.slope, rel=1e-3)


# --- Operating points -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "drive", [ts.Drive(), ts.Drive(load="weight", load_radius=0.03, load_inertia=2e-5)], ids=["torque", "weight"]
)
@pytest.mark.parametrize("figure", ["mean_speed", "max_speed", "speed_volatility", "contact_fraction", "stall_torque"])
def test_slopes_of_the_model_are_those_of_evaluate(trum60, figure, drive):
    data = from_columns("rows", {"load_torque": np.array([-0.05, 0.08]), figure: np.array([0.5, 0.6])}, {}, False)
    names = ("friction_coefficient", "contact_radius", "rotor_inertia")
    model = PointModel(data, trum60, names, drive, LEVELS, None)
    assert model.exact == (True, True, True)
    values = model.start
    slopes = model.slopes(values)
    for k in range(3):
        h = 1e-4 * values[k]
        shift = h * np.eye(3)[k]
        difference = (model.predict(values + shift) - model.predict(values - shift)) / (2 * h)
        scale = np.max(np.abs(model.predict(values))) / values[k]
        assert slopes[:, k] == pytest.approx(difference, rel=1e-3, abs=1e-3 * scale), names[k]


def test_differences_agree_with_the_exact_slopes(trum60):
    columns = {"load_torque": np.array([-0.05, 0.08]), "mean_speed": np.array([0.5, 0.6])}
    model = PointModel(from_columns("rows", columns, {}, False), trum60, ("contact_radius",), ts.Drive(), LEVELS, None)
    exact = model.slopes(model.start)
    model.exact = (False,)
    assert model.slopes(model.start) == pytest.approx(exact, rel=1e-3)


def test_torque_and_speed_give_back_friction_and_radius(trum60):
    known = {"friction_coefficient": 0.22, "contact_radius": 0.0283}
    load = np.linspace(-0.1, 0.1, 7)
    speed = ts.evaluate(trum60.with_values(known), ts.Drive(load_torque=load), tolerance=1e-8).mean_speed
    found = ts.calibrate({"load_torque": load, "mean_speed": speed})
    for name, value in known.items():
        assert found[name].value == pytest.approx(value, rel=1e-5)
        assert found[name].exact_slopes
        assert found.motor.contact_radius.source == "calibrated"
    assert found.status == "solved"


def test_any_parameter_can_be_fitted(trum60):
    known = {"beam_young_modulus": 150e9, "damping_ratio": 0.0065}
    columns = {
        "prepressure": np.array([150.0, 180.0, 210.0]),
        "frequency_difference": np.array([2900.0, 3000.0, 3200.0]),
    }
    motor = trum60.with_values(known)
    point = ts.evaluate(motor, ts.Drive(load_torque=0.0, **columns), tolerance=1e-8)
    figures = {"mean_speed": point.mean_speed, "resonance_frequency": point.resonance_frequency}
    sigma = {f"{name}_uncertainty": np.full(3, s) for name, s in (("mean_speed", 1e-3), ("resonance_frequency", 1.0))}
    found = ts.calibrate({**columns, **figures, **sigma}, parameters=list(known), drive=ts.Drive(load_torque=0.0))
    for name, value in known.items():
        assert found[name].value == pytest.approx(value, rel=1e-5)
        assert not found[name].exact_slopes


# --- What the data cannot tell --------------------------------------------------------------------


def test_stall_torque_alone_cannot_separate_friction_and_radius(trum60):
    force = np.linspace(120, 220, 8)
    stall = ts.evaluate(trum60, ts.Drive(prepressure=force)).stall_torque
    found = ts.calibrate({"prepressure": force, "stall_torque": stall + noise(3).normal(0, 1e-4, 8)})
    assert found.status == "unidentifiable"
    assert "cannot separate friction_coefficient, contact_radius" in found.message
    direction = found.separation.direction  # their product stays: +1 % and -1 %
    assert direction["friction_coefficient"] == pytest.approx(-direction["contact_radius"], rel=1e-3)
    assert found.motor == trum60
    with pytest.raises(ts.ParameterError, match="unidentifiable"):
        found.save("never.toml")
    alone = ts.calibrate({"prepressure": force, "stall_torque": stall}, parameters=["friction_coefficient"])
    assert alone["friction_coefficient"].value == pytest.approx(0.25, rel=1e-3)


def test_a_parameter_without_effect_is_named(trum60):
    fixed = trum60.with_values({"resonance_frequency": 39e3})
    data = {"prepressure": FORCE, "resonance_frequency": np.full(7, 39e3) + noise(4).normal(0, 1, 7)}
    found = ts.calibrate(data, fixed)
    assert (found.status, found.message) == ("unidentifiable", "layer_stiffness has no effect on these data")


def test_scatter_that_swallows_the_value_is_no_measurement(trum60):
    force = np.linspace(100, 220, 13)
    resonance = ts.evaluate(trum60, ts.Drive(prepressure=force)).resonance_frequency
    found = ts.calibrate({"prepressure": force, "resonance_frequency": resonance + noise(5).normal(0, 20, 13)})
    assert found.status == "unidentifiable"
    assert "layer_stiffness" in found.message


def test_a_fit_that_runs_to_its_end_is_not_solved(trum60):
    time = np.arange(200) / 250e3
    growing = decay(time, -0.003, 39e3)
    found = ts.calibrate({"time": time, "displacement": growing}, trum60)
    assert found.status == "unidentifiable"
    assert "damping_ratio" in found.message


def test_a_parameter_at_the_end_of_its_range_is_not_solved(trum60):
    stiff = trum60.with_values({"beam_young_modulus": 180e9})
    resonance = ts.evaluate(stiff, ts.Drive(prepressure=FORCE)).resonance_frequency
    found = ts.calibrate({"prepressure": FORCE, "resonance_frequency": resonance}, parameters=["shear_correction"])
    assert found["shear_correction"].value == pytest.approx(1.0)  # at most 1, and it would need more
    assert found.status == "unidentifiable"
    assert "shear_correction to the end of its range" in found.message


@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_a_search_cannot_begin_where_the_model_has_no_answer(trum60):
    slippery = trum60.with_values({"friction_coefficient": 0.01})
    data = {"load_torque": np.array([0.0, 0.1, 0.2]), "mean_speed": np.array([1.0, 0.5, 0.1])}
    with pytest.raises(ts.ConvergenceError, match=r"row 2.*--set"):
        ts.calibrate(data, slippery)


# --- Admittance sweep: against a circuit typed here, and SciPy on it ------------------------------

HERTZ = np.linspace(37.2e3, 40.6e3, 121)


def circuit(hertz, damping, resonance, factor, capacitance, loss, mass):
    """Admittance of L, C and R in series beside a capacitance with loss."""
    omega, own = 2 * np.pi * hertz, 2 * np.pi * resonance
    inductance, held = mass / factor**2, factor**2 / (mass * own**2)
    series = 2 * damping * own * inductance + 1j * omega * inductance + 1 / (1j * omega * held)
    return 1 / series + 1j * omega * capacitance * (1 - 1j * loss)


SWEPT = {
    "damping_ratio": 0.0017,
    "free_resonance": 38950.0,
    "force_factor": 0.53,
    "capacitance": 11e-9,
    "loss_factor": 0.006,
}


def modal_mass():
    plain = ts.Drive(on_periods=20)
    return float(coupled_values(ts.load_motor(), plain, Levels(coupling="contact"))["M_q"])


def swept(rng=None, size=2e-5, **changed):
    made = circuit(HERTZ, *(SWEPT | changed).values(), modal_mass())
    scatter = np.zeros((2, HERTZ.size)) if rng is None else rng.normal(0, size, (2, HERTZ.size))
    return {"frequency": HERTZ, "conductance": made.real + scatter[0], "susceptance": made.imag + scatter[1]}


def test_a_sweep_without_noise_gives_back_its_circuit():
    found = ts.calibrate(swept())
    assert {name: found[name].value for name in SWEPT} == pytest.approx(SWEPT, rel=1e-7)
    assert [e.name for e in found.estimates if e.in_motor] == ["damping_ratio"]
    assert found.motor.damping_ratio.source == "calibrated"


def test_a_sweep_gives_what_curve_fit_gives():
    data, mass = swept(noise(3)), modal_mass()

    def both(hertz, *values):
        made = circuit(hertz, *values, mass)
        return np.concatenate([made.real, made.imag])

    measured = np.concatenate([data["conductance"], data["susceptance"]])
    best, covariance = scipy.optimize.curve_fit(
        both, HERTZ, measured, [0.003, 38900.0, 0.6, 1e-8, 0.01], x_scale=[1e-3, 10, 0.1, 1e-9, 1e-2], method="trf"
    )
    found = ts.calibrate(data)
    assert [found[name].value for name in SWEPT] == pytest.approx(best, rel=1e-4)
    assert [found[name].standard_error for name in SWEPT] == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-3)
    assert found.residual_unit == "S"
    assert found.residuals.standard_deviation == pytest.approx(2e-5, rel=0.2)


@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_the_ceramics_data_can_be_asked_for():
    """That make the same factor and capacitance: d_31 goes with the factor, eps_33T is over d_31^2/s_11E."""
    names = ["damping_ratio", "piezo_strain_constant", "piezo_permittivity", "piezo_loss_factor"]
    known = {"piezo_strain_constant": -110e-12, "piezo_permittivity": 10e-9, "piezo_loss_factor": 0.01}
    truth = ts.load_motor().with_values(known)
    levels = Levels(amplitude="forced", coupling="contact")
    curve = free_admittance(coupled_values(truth, ts.Drive(on_periods=20), levels), HERTZ)
    data = {"frequency": HERTZ, **dict(zip(("conductance", "susceptance"), curve, strict=True))}
    found = ts.calibrate(data, parameters=names)
    assert {name: found[name].value for name in known} == pytest.approx(known, rel=1e-6)
    assert found.motor.piezo_permittivity.interval is not None
    halved = ts.calibrate(data, ts.load_motor().with_values({"phase_coverage": 0.5}), parameters=names)
    assert halved["piezo_strain_constant"].value == pytest.approx(-220e-12, rel=1e-6)


def test_size_and_phase_are_the_same_data():
    data = swept(noise(4))
    whole = data["conductance"] + 1j * data["susceptance"]
    polar = {"frequency": HERTZ, "admittance": np.abs(whole), "phase": np.angle(whole)}
    one, other = ts.calibrate(data), ts.calibrate(polar)
    assert [e.value for e in other.estimates] == pytest.approx([e.value for e in one.estimates], rel=1e-6)


def test_uncertainties_weigh_the_parts_of_a_sweep():
    data = swept(noise(5))
    data["conductance"][40] += 1.0
    sigma = np.full(HERTZ.size, 2e-5)
    far = sigma.copy()
    far[40] = 1e6
    found = ts.calibrate({**data, "conductance_uncertainty": far, "susceptance_uncertainty": sigma})
    assert found["damping_ratio"].value == pytest.approx(SWEPT["damping_ratio"], rel=0.05)


# --- Coverage: known parameters lie in their own 95 % intervals in 95 +- 3 % of 500 trials --------


def law_trial(rng, motor):
    truth = {"amplitude_factor": 14.9, "amplitude_exponent": 0.68}
    clean = FREE * truth["amplitude_factor"] * FORCE ** -truth["amplitude_exponent"]
    return truth, {"prepressure": FORCE, "amplitude": clean + rng.normal(0, 4e-8, 7)}, motor


def decay_trial(rng, motor):
    time = np.arange(160) / 200e3
    signal = decay(time, 0.006, 39500.0, phase=rng.uniform(0, 6)) + rng.normal(0, 1e-7, time.size)
    return {"damping_ratio": 0.006, "resonance_frequency": 39500.0}, {"time": time, "velocity": signal}, motor


RESONANT = np.linspace(100, 220, 12)


def resonance_trial(rng, motor):
    if not hasattr(resonance_trial, "clean"):
        point = ts.evaluate(motor.with_values({"layer_stiffness": 2.4e10}), ts.Drive(prepressure=RESONANT))
        resonance_trial.clean = point.resonance_frequency
    data = {"prepressure": RESONANT, "resonance_frequency": resonance_trial.clean + rng.normal(0, 1.0, 12)}
    return {"layer_stiffness": 2.4e10}, data, motor


LOADS = np.linspace(-0.1, 0.1, 8)
SHORT = ts.Drive(periods=10, on_periods=8)


def speed_trial(rng, motor):
    truth = {"friction_coefficient": 0.23, "contact_radius": 0.0275}
    if not hasattr(speed_trial, "clean"):
        point = ts.evaluate(motor.with_values(truth), replace(SHORT, load_torque=LOADS), tolerance=1e-7)
        speed_trial.clean = point.mean_speed
    return truth, {"load_torque": LOADS, "mean_speed": speed_trial.clean + rng.normal(0, 0.02, 8)}, motor


def sweep_trial(rng, motor):
    return {name: SWEPT[name] for name in list(SWEPT)[:4]}, swept(rng), motor


def covered(trial, trials, seed, motor):
    """How often each parameter's interval holds the truth, over fits none of which may be given up."""
    rng, hits = noise(seed), {}
    for _ in range(trials):
        truth, data, machine = trial(rng, motor)
        asked = [name for name in truth if name in SPECS]
        found = ts.calibrate(data, machine, parameters=asked, drive=SHORT)
        assert found.status == "solved"
        for name, value in truth.items():
            hits[name] = hits.get(name, 0) + (found[name].low <= value <= found[name].high)
    return {name: count / trials for name, count in hits.items()}


@pytest.mark.slow
@pytest.mark.parametrize("trial", [law_trial, decay_trial, resonance_trial, speed_trial, sweep_trial])
def test_500_intervals_hold_the_truth_in_95_percent(trum60, trial):
    for name, share in covered(trial, 500, 95, trum60).items():
        print(f"{trial.__name__}: {name} {100 * share:.1f} %")
        assert share == pytest.approx(0.95, abs=0.03), name


@pytest.mark.parametrize("trial", [law_trial, decay_trial, resonance_trial, sweep_trial])
def test_a_sample_of_intervals_holds_the_truth(trum60, trial):
    # 60 trials at 95 %: fewer than 50 hits has a chance of 4e-5
    for name, share in covered(trial, 60, 7, trum60).items():
        assert share >= 50 / 60, name


# --- The console ----------------------------------------------------------------------------------


@pytest.fixture
def csv_file(tmp_path):
    def write(text, name="data.csv"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return str(path)

    return write


LAW = "prepressure [N],amplitude [um]\n100,8.3\n120,7.3\n140,6.6\n160,6.0\n"


def test_console_reports_and_writes_a_motor_file(capsys, csv_file, tmp_path):
    out = tmp_path / "motor.toml"
    assert console.main(["calibrate", csv_file("# synthetic\n" + LAW), "--json", "--out", str(out)]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["status"] == "solved"
    written = ts.load_motor(out).amplitude_exponent
    assert (written.source, written.data) == ("calibrated", "data.csv (synthetic)")
    assert written.value == pytest.approx(record["parameters"]["amplitude_exponent"]["value"], rel=1e-9)
    assert written.interval[0] == pytest.approx(record["parameters"]["amplitude_exponent"]["low"], rel=1e-9)
    assert ts.load_motor(out).fit_prepressure_max.value == 160
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        ts.evaluate(ts.load_motor(out))


def test_console_says_no_with_exit_code_1_and_writes_nothing(capsys, csv_file, tmp_path):
    out = tmp_path / "motor.toml"
    path = csv_file("prepressure [N],stall_torque [mN*m]\n100,80\n140,122\n180,156\n220,180\n")
    assert console.main(["calibrate", path, "--out", str(out)]) == 1
    assert "cannot separate" in capsys.readouterr().out
    assert not out.exists()


def test_console_reads_units_and_comments(capsys, csv_file):
    micro, metre = (
        csv_file(text, name)
        for text, name in (
            (LAW, "a.csv"),
            (
                "\ufeff# a comment\n\namplitude [m] , prepressure [kN]\n"
                "8.3e-6,0.1\n7.3e-6,0.12\n6.6e-6,0.14\n6e-6,0.16\n",
                "b.csv",
            ),
        )
    )
    found = []
    for path in (micro, metre):
        assert console.main(["calibrate", path, "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out)["parameters"]["amplitude_factor"]["value"])
    assert found[0] == pytest.approx(found[1], rel=1e-9)


BAD_DATA = [
    ("", ("data", "header line")),
    ("prepressure [N],amplitude [um]\n", ("data", "no rows")),
    ("prepressure [N],amplitude [um]\n100,8.3\n120,7.3\n", ("data: got 2 measured values", "more than the 2")),
    (
        "prepressure [N],amplitude [um]\n100,8.3\n120,nan\n140,6\n",
        ("amplitude: line 3", "got nan", "finite number in um"),
    ),
    ("prepressure [N],amplitude [um]\n100,8.3\n120,\n140,6\n", ("amplitude: line 3", "got empty text")),
    ("prepressure [N],amplitude [um]\n100,8.3\n120\n140,6\n", ("data: line 3", "1 cells", "2, one for each")),
    ("prepressure [N],amplitude [um]\n100,8.3\n-120,7\n140,6\n", ("prepressure: got -120", "> 0", "in N")),
    ("prepressure [N],amplitude [um]\n100,8.3\n120,-7\n140,6\n", ("amplitude: got -7e-06", "> 0", "in m")),
    ("prepressure [Hz],amplitude [um]\n100,8.3\n", ("column prepressure: got Hz", "converts to N")),
    ("prepressure [furlong],amplitude [um]\n100,8.3\n", ("column prepressure", "unknown unit")),
    ("prepressure,amplitude [um]\n100,8.3\n", ("column: got prepressure", "prepressure [N]")),
    ("prepressure [N,amplitude [um]\n100,8.3\n", ("column", "a header such as")),
    ("prepresure [N],amplitude [um]\n100,8.3\n", ("column: got prepresure", "close names: prepressure")),
    ("force [N],amplitude [um]\n100,8.3\n", ("column: got force", "a field of the drive")),
    ("prepressure [N],prepressure [N],amplitude [um]\n1,1,8.3\n", ("column: got prepressure", "each column once")),
    ("prepressure [N],load_torque [N*m]\n100,0.1\n", ("data: got no measured column", "mean_speed")),
    ("prepressure [N],amplitude_uncertainty [um]\n100,0.1\n", ("data: got no measured column",)),
    ("amplitude [um],mean_speed [rad/s]\n5,1\n", ("amplitude and mean_speed", "amplitude_uncertainty")),
    ("amplitude [um],mean_speed_uncertainty [rad/s]\n5,1\n", ("mean_speed_uncertainty", "a column mean_speed")),
    ("displacement [um]\n5\n4\n", ("displacement without time",)),
    ("time [s]\n5\n6\n", ("time", "displacement, velocity, envelope")),
    ("time [s],envelope [um],prepressure [N]\n0,5,1\n1,4,1\n", ("column: got prepressure", "time and envelope only")),
    ("time [s],envelope [um]\n0,5\n1,4\n1,3\n2,2\n", ("time: row 3", "rise")),
    (
        "time [ms],displacement [um]\n0,5\n1,4\n2,3\n3,2\n4,1\n5,1\n",
        ("time", "rows up to 0.001 s apart", "half a period"),
    ),
    ("frequency [kHz],conductance [mS]\n38,1\n39,2\n", ("data: got conductance and frequency", "susceptance")),
    ("frequency [kHz],admittance [mS],susceptance [mS]\n38,1,1\n", ("data: got admittance", "admittance and phase")),
    ("frequency [kHz],conductance [mS],susceptance [S],time [s]\n38,1,1,0\n", ("data", "frequency with conductance")),
    (
        "frequency [kHz],conductance [mS],susceptance [mS]\n38,1,1\n39,2,1\n39,1,1\n",
        ("frequency: row 3: got 39000", "rise"),
    ),
    (
        "frequency [kHz],conductance [mS],susceptance [mS]\n38,1,1\n39,2,1\n40,3,1\n41,4,1\n",
        ("frequency: got 38000 to 41000 Hz", "largest conductance"),
    ),
    ("frequency [kHz],conductance [mS],susceptance [mS]\n38,1,1\n39,2,1\n", ("frequency", "inside")),
    ("frequency [Hz],conductance [ohm],susceptance [S]\n38,1,1\n", ("column conductance: got ohm", "converts to S")),
    (b"\xff\xfe\x00", ("data", "not UTF-8")),
    ('prepressure [N],amplitude [um]\n"100,8.3\n120,7.3\n', ("data", "CSV file")),
]


@pytest.mark.parametrize(
    ("text", "naming"), BAD_DATA, ids=[str(naming[-1]) + str(k) for k, (_, naming) in enumerate(BAD_DATA)]
)
def test_console_refuses_bad_data(console_refuses, csv_file, text, naming):
    console_refuses("calibrate", csv_file(text), naming=naming)


BAD_OPTIONS = [
    (("--fit", "nonsense"), ("nonsense", "a name of the motor file")),
    (("--fit", "crests"), ("--fit: got crests", "vary continuously")),
    (("--fit", "amplitude_factor", "--fit", "amplitude_factor"), ("--fit", "each name once")),
    (("--confidence", "1"), ("confidence: got 1", "> 0 and < 1")),
    (("--confidence", "nan"), ("confidence: got nan",)),
    (("--errors", "none"), ("--errors", "'absolute', 'relative'")),
    (("--out", "motor.txt"), ("--out: got motor.txt", ".toml")),
    (("--out", "/nowhere/motor.toml"), ("--out", "a folder that exists")),
    (("--start", "periodik"), ("--start",)),
]


@pytest.mark.parametrize(("options", "naming"), BAD_OPTIONS, ids=[" ".join(o) for o, _ in BAD_OPTIONS])
def test_console_refuses_bad_options(console_refuses, csv_file, options, naming):
    console_refuses("calibrate", csv_file(LAW), *options, naming=naming)


def test_console_refuses_a_file_that_is_not_there(console_refuses):
    console_refuses("calibrate", "nowhere.csv", naming=("data: got nowhere.csv", "exists"))


def test_console_refuses_logarithms_of_negative_speeds(console_refuses, csv_file):
    path = csv_file("load_torque [N*m],mean_speed [rad/s]\n0,1\n0.1,-1\n0.05,0.5\n")
    console_refuses("calibrate", path, "--errors", "relative", naming=("errors: got relative", "all > 0"))


def test_console_refuses_what_a_decay_does_not_know(console_refuses, csv_file):
    path = csv_file("time [us],displacement [um]\n" + "".join(f"{k},1\n" for k in range(9)))
    console_refuses("calibrate", path, "--fit", "contact_radius", naming=("--fit: got contact_radius", "decay"))
    console_refuses("calibrate", path, "--fit", "resonance_frequency", naming=("damping_ratio among them",))


def test_speed_under_load_identifies_the_contact_stiffness():
    """Synthetic: of a contact of 1.4 GN/m^2, speeds scattered by 0.3 %; the fit begins at the flange's 1.0 GN/m^2."""
    loads, drive = np.linspace(0.0, 0.9, 12), {"on_periods": 20, "frequency_difference": 500.0}
    true = ts.load_motor().with_values({"contact_stiffness": 1.4e9})
    speed = np.asarray(ts.evaluate(true, ts.Drive(load_torque=loads, **drive)).mean_speed)
    speed = speed * (1 + 0.003 * np.random.default_rng(3).standard_normal(12))
    data = {"load_torque": loads, "mean_speed": speed}
    names = ("contact_stiffness", "friction_coefficient")
    found = ts.calibrate(data, parameters=names, drive=ts.Drive(**drive), compliance="flange")
    assert found.status == "solved"
    for name, value in (("contact_stiffness", 1.4e9), ("friction_coefficient", 0.25)):
        assert found[name].low < value < found[name].high
        assert found[name].high - found[name].low < 0.3 * value
    assert found.motor.contact_stiffness.interval == (found["contact_stiffness"].low, found["contact_stiffness"].high)


@pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")
def test_a_fit_that_no_motor_gives_ends_at_ten_times_what_is_usual():
    """Speeds of the Winkler contact read as those of the Hertz width drove friction on for ever."""
    data = {"load_torque": [-0.1, 0.0, 0.1], "mean_speed": [4.409, 2.727, 1.069]}
    found = ts.calibrate(data, parameters=("friction_coefficient",), contact="hertz")
    assert found["friction_coefficient"].value == pytest.approx(15.0)
    assert found.status == "unidentifiable"


@pytest.mark.parametrize(
    "columns",
    [
        "time displacement",
        "prepressure amplitude",
        "load_torque mean_speed",
        "prepressure resonance_frequency",
        "frequency amplitude",
    ],
)
@pytest.mark.parametrize("rows", [0, 1, 2, 3])
def test_few_rows_are_answered_or_refused(trum60, columns, rows):
    by, observed = columns.split()
    data = {by: np.arange(rows) * 1e-6 + (0 if by == "time" else 100), observed: np.arange(rows) * 1e-6 + 1e-6}
    with warnings.catch_warnings(), contextlib.suppress(ts.ParameterError, ts.ConvergenceError):
        warnings.simplefilter("ignore")
        ts.calibrate(data, trum60)
