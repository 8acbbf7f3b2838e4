"""Operating points whose wave feels the rotor: what evaluate and simulate make of coupled orbits."""

from __future__ import annotations

import json
import math
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from refusals import assert_one_clear_line

import trum_sym as ts
from trum_sym.model import coupled_point
from trum_sym.model.coupled_orbit import coupled_orbits, lap_values
from trum_sym.model.coupled_point import ABSENT, COUPLED_RESULTS
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels
from trum_sym.model.rotor import RUNAWAY

FLANGE = {"compliance": "flange", "coupling": "contact"}


@pytest.fixture(scope="module")
def motor():
    return ts.load_motor()


@pytest.fixture(scope="module")
def table_3(motor):
    return ts.evaluate(motor, **FLANGE)


def test_a_point_has_the_figures_of_the_orbits_to_the_bit(motor, table_3):
    values = lap_values(motor, ts.Drive(), Levels(**FLANGE))
    assert values["mass"] == motor.rotor_mass.value == 0.02  # the motor file's
    (orbit,) = coupled_orbits(values)  # both starts lead to one
    assert table_3.orbits == ((orbit,),)
    for name in ("mean_speed", "min_speed", "max_speed", "contact_fraction", "highest_wave", "input_power"):
        assert getattr(table_3, name) == getattr(orbit, name)
        assert getattr(table_3, f"{name}_error") == getattr(orbit, f"{name}_error")
    assert table_3.speed_volatility == orbit.deviation / abs(orbit.mean_speed)
    assert table_3.largest_multiplier == np.abs(orbit.multipliers).max() < 1
    assert (table_3.start, table_3.branch, table_3.branches, table_3.cycles) == ("rest", "only", 1, 1)
    assert table_3.converged
    assert table_3.reason == ""
    assert table_3.remarks == ("the load drives the rotor back",)
    assert table_3.output_power == pytest.approx(0.3 * orbit.mean_speed, rel=1e-12)
    assert table_3.efficiency == pytest.approx(0.3 * orbit.mean_speed / orbit.input_power, rel=1e-12)


def test_figures_that_take_no_orbit_are_those_of_a_prescribed_wave(motor, table_3):
    prescribed = ts.evaluate(motor, compliance="flange")
    for name in ("resonance_frequency", "drive_frequency", "cycle_time", "neutral_axis", "wavenumber"):
        assert getattr(table_3, name) == pytest.approx(getattr(prescribed, name), rel=1e-14)
    light = ts.evaluate(motor, foundation="none")  # of a stator that nothing presses on
    assert table_3.free_resonance == pytest.approx(light.resonance_frequency, rel=1e-14)


def test_points_of_an_array_are_those_alone_to_the_bit(motor):
    loads, masses = np.array([0.1, 0.3, 3.0]), np.array([[0.0], [0.02]])
    words = {**FLANGE, "tolerance": 1e-3}
    light = motor.with_values({"contact_radius": 0.0265})
    with pytest.warns(ts.ValidityWarning, match="rotor_mass"):
        every = light.with_values({"rotor_mass": masses})
    found = ts.evaluate(every, ts.Drive(load_torque=loads), **words)
    assert found.mean_speed.shape == (2, 3)
    for index in np.ndindex(2, 3):
        with pytest.warns(ts.ValidityWarning) if masses[index[0], 0] == 0 else nullcontext():
            one = light.with_values({"rotor_mass": float(masses[index[0], 0])})
        alone = ts.evaluate(one, ts.Drive(load_torque=float(loads[index[1]])), **words)
        for name in (*COUPLED_RESULTS, "start", "branch", "reason"):
            assert np.array_equal(getattr(found, name)[index], getattr(alone, name), equal_nan=name in COUPLED_RESULTS)
        assert found.orbits[3 * index[0] + index[1]] == alone.orbits[0]
    assert (found.reason[:, 2] == RUNAWAY).all()
    assert not found.converged[:, 2].any()
    assert np.isnan(found.mean_speed[:, 2]).all()
    assert found.to_frame().shape[0] == 6
    assert found.to_xarray().highest_wave.attrs["units"] == "m"


def test_a_plain_wave_s_point_is_its_balance(motor):
    drive = ts.Drive(on_periods=20, frequency_difference=500.0)
    point = ts.evaluate(motor, drive, **FLANGE)
    waves = plain_waves(coupled_values(motor, drive, Levels(**FLANGE)))
    at = waves.highest
    known = {
        "mean_speed": waves.speed[at],
        "highest_wave": waves.amplitude[at],
        "amplitude_A": waves.amplitude[at],
        "amplitude_B": waves.amplitude[at],
        "lag_A": waves.lead[at],
        "lag_B": waves.lead[at],
        "input_power": waves.input_power[at],
        "output_power": waves.output_power[at],
        "efficiency": waves.output_power[at] / waves.input_power[at],
        "contact_fraction": waves.half_angle[at] / math.pi,
    }
    for name, wanted in known.items():
        error = getattr(point, f"{name}_error")
        assert abs(getattr(point, name) - wanted) <= max(error, 1e-9 * abs(wanted)), name
        assert error < 1e-4 * abs(wanted), name


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
def test_with_light_contact_its_figures_tend_to_those_of_a_prescribed_wave(motor):
    names = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "contact_fraction")
    gaps = []
    for force in (2.0, 0.5):
        drive = ts.Drive(prepressure=force, frequency_difference=2e3, load_torque=0.0)
        light = motor.with_values({"rotor_mass": 0.0})
        point = ts.evaluate(light, drive, coupling="contact")
        values = lap_values(light, drive, Levels())
        own, turn = values["omega_n0"], values["omega_q"]
        size = values["F_q"] / values["M_q"] / abs(complex(own**2 - turn**2, 2 * values["xi"] * own * turn))
        given = motor.with_values({"amplitude": size, "resonance_frequency": point.free_resonance})
        offset = point.drive_frequency - point.free_resonance
        other = ts.evaluate(given, replace(drive, frequency_difference=offset))
        assert point.converged
        gaps.append([abs(getattr(point, name) / getattr(other, name) - 1) for name in names])
    assert max(gaps[1]) < 0.01
    assert (np.array(gaps[1]) < 0.5 * np.array(gaps[0])).all()


@pytest.fixture(scope="module")
def motion(motor):
    return ts.simulate(motor, cycles=2, **FLANGE)


def test_the_motion_carries_prepressure_and_load_and_has_the_points_figures(table_3, motion):
    assert motion.sizes == {"time": 2 * 20 * 64}
    assert float(motion.pressure_force.mean()) == pytest.approx(180.0, rel=1e-4)  # nothing accelerates it on average
    torque = 0.25 * 180.0 * 0.0265 * float(motion.friction.mean())
    assert torque == pytest.approx(0.3, rel=5e-3)
    assert float(motion.rotor_speed.mean()) == pytest.approx(table_3.mean_speed, rel=1e-4)
    assert float(motion.rotor_speed.max()) == pytest.approx(table_3.max_speed, abs=1e-3 * abs(table_3.min_speed))
    wave = np.hypot(motion.w_A, motion.w_B)
    assert float(wave.max()) == pytest.approx(table_3.highest_wave, rel=1e-3)
    assert float(motion.theta.mean()) / math.pi == pytest.approx(table_3.contact_fraction, rel=1e-3)
    advance = float(motion.rotor_angle[1280] - motion.rotor_angle[0])
    assert advance == pytest.approx(table_3.mean_speed * table_3.cycle_time, rel=1e-5)
    assert motion.attrs["coupling"] == "contact"
    assert (motion.attrs["closed"], motion.attrs["converged"], motion.attrs["runaway"]) == (1, 1, 0)
    assert "Q" not in motion
    assert np.array_equal(motion.region, ts.simulate(cycles=2).region)


def test_amplitude_and_lag_are_those_of_the_motion_s_spectrum(table_3, motion):
    """By its line at the drive's frequency, of four times as many times."""
    values = lap_values(ts.load_motor(), ts.Drive(), Levels(**FLANGE))
    for phase, force in (("A", 1.0), ("B", 1j)):
        line = 2 * np.fft.rfft(motion[f"w_{phase}"].to_numpy()[:1280])[20] / 1280
        assert abs(abs(line) - getattr(table_3, f"amplitude_{phase}")) < getattr(table_3, f"amplitude_{phase}_error")
        lag = float(np.angle(force * np.exp(1j * values["force_phase"]) / line))
        assert abs(lag - getattr(table_3, f"lag_{phase}")) < getattr(table_3, f"lag_{phase}_error")


def test_an_encoder_reads_as_little_as_of_the_drive_s_orbit(motor, table_3):
    read = ts.evaluate(motor, sampling_period="2 ms", **FLANGE)
    other = ts.drive_orbit(motor, sampling_period="2 ms", samples_per_period=64, compliance="flange")
    wanted = other.encoder_deviation / abs(other.orbit.mean_speed)
    assert abs(read.speed_volatility - wanted) < read.speed_volatility_error < 1e-3 * wanted
    assert read.mean_speed == table_3.mean_speed


def test_what_a_point_lacks_says_why(table_3):
    for name in ABSENT:
        with pytest.raises(AttributeError, match=name):
            getattr(table_3, name)
    with pytest.raises(AttributeError, match="no such figure"):
        _ = table_3.nonsense
    record = json.loads(table_3.to_json())
    assert record["absent"]["stall_torque"].startswith("a rotor that is held still")
    assert set(ts.evaluate().figures) - set(table_3.figures) == {*ABSENT, "contact"} - {"on_grid"}
    assert not [name for name, value in record.items() if value is None and name != "sampling_period"]


def changed(monkeypatch, **fields):
    """Let orbits be other than they are; one for each start."""

    def other(values, starts):
        orbits = coupled_orbits(values, ("steady",))
        return tuple(replace(orbits[0], start=start, **of) for start, of in zip(starts, fields["of"], strict=True))

    monkeypatch.setattr(coupled_point, "coupled_orbits", other)


CASES = [
    ([{"closed": False}] * 2, "none", "laps come back neither from rest nor from the steady swing", "laps come back"),
    ([{"multipliers": np.array([1.5 + 0j])}] * 2, "none", "a small disturbance is 1.5 times as large", "no orbit"),
    ([{"tolerance_met": False}] * 2, "1 of 2", "the estimates of the errors miss the tolerance", "another orbit"),
    ([{"closed": False}, {}], "only", "", "from rest laps come to no orbit that attracts"),
    ([{"mean_speed": 1.0}, {}], "1 of 2", "", "another orbit attracts, from both phases' steady swing"),
    ([{"cycles": 2}, {"closed": False}], "only", "", "the orbit repeats itself after 2 cycles, not every cycle"),
]


@pytest.mark.parametrize(("of", "branch", "reason", "remark"), CASES)
def test_the_flag_says_why_not(monkeypatch, motor, of, branch, reason, remark):
    changed(monkeypatch, of=of)
    point = ts.evaluate(motor, tolerance=1e-2, **FLANGE)
    assert point.branch == branch
    assert point.converged == (reason == "")
    assert reason in point.reason
    assert any(remark in said for said in point.remarks)
    assert len(set(point.remarks)) == len(point.remarks)
    assert np.isfinite(point.lag_A)
    assert point.to_text().startswith("<CoupledPoint TRUM-60, mean_speed")


def test_a_plain_wave_s_slopes_are_those_of_its_balance(motor):
    """Of the closed form, by differences a hundred times smaller."""
    drive = ts.Drive(on_periods=20, frequency_difference=500.0)
    slopes = ts.sensitivities(motor, drive, tolerance=1e-7, **FLANGE)
    levels = Levels(**FLANGE)

    def speed(machine=motor, **changed):
        waves = plain_waves(coupled_values(machine, replace(drive, **changed), levels))
        return np.array([waves.speed[waves.highest], waves.amplitude[waves.highest], waves.input_power[waves.highest]])

    def by_friction(off):
        return speed(motor.with_values({"friction_coefficient": 0.25 + off}))

    wanted = {
        "prepressure": (speed(prepressure=180.002) - speed(prepressure=179.998)) / 0.004,
        "load_torque": (speed(load_torque=0.30001) - speed(load_torque=0.29999)) / 2e-5,
        "friction_coefficient": (by_friction(1e-5) - by_friction(-1e-5)) / 2e-5,
    }
    for parameter, (of_speed, of_wave, of_power) in wanted.items():
        for figure, known in (("mean_speed", of_speed), ("highest_wave", of_wave), ("input_power", of_power)):
            error = float(slopes.errors[figure][parameter])
            assert abs(float(slopes[figure][parameter]) - known) < 1.05 * error + 1e-6 * abs(known), (parameter, figure)
            assert error < 0.02 * abs(known), (parameter, figure)
    assert float(slopes["mean_speed"]["load_inertia"]) == pytest.approx(0, abs=1e-3)  # nothing is accelerated
    assert slopes.remarks == ()


def test_slopes_are_what_points_differ_by(motor, capsys):
    from trum_sym import console

    words = ["sensitivities", "--coupling", "contact", "--compliance", "flange", "--tolerance", "1e-5"]
    assert console.main([*words, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    loads = ts.Drive(load_torque=[0.295, 0.305])
    ends = ts.evaluate(motor, loads, tolerance=1e-6, **FLANGE)
    slope, error = (record[name]["mean_speed"]["load_torque"] for name in ("slopes", "slope_errors"))
    assert abs((ends.mean_speed[1] - ends.mean_speed[0]) / 0.01 - slope) < error + 2e-3 * abs(slope)
    assert list(record["slopes"]["mean_speed"])[-1] == "rotor_mass"


def test_an_orbit_that_does_not_attract_has_no_slopes(monkeypatch, motor):
    changed(monkeypatch, of=[{"closed": False}] * 2)
    with pytest.raises(ts.ParameterError) as caught:
        ts.sensitivities(motor, **FLANGE)
    assert_one_clear_line(str(caught.value), "coupling: got contact, need none here, where laps come back neither")


def test_orbits_off_the_branch_give_no_slope_and_say_so(monkeypatch, motor):
    from trum_sym.model import coupled_slopes

    plain = coupled_slopes.orbit_from

    def other(values, *rest):
        orbit = plain(values, *rest)
        return replace(orbit, cycles=2) if values["mu"] != 0.25 else orbit

    monkeypatch.setattr(coupled_slopes, "orbit_from", other)
    slopes = ts.sensitivities(motor, tolerance=1e-3, **FLANGE)
    assert slopes.remarks == ("no slope by friction_coefficient: an orbit beside the point's is not on its branch",)
    assert slopes.to_dict()["remarks"] == list(slopes.remarks)
    assert " +- " in slopes.to_text()
    assert slopes.to_text().endswith(f"remark: {slopes.remarks[0]}")
    assert np.isfinite(slopes["mean_speed"]["prepressure"])


@pytest.mark.parametrize(
    ("drive", "words", "naming"),
    [
        ({"start": "rest"}, {}, ("start: got rest", "periodic where coupling is contact")),
        ({"load": "weight", "load_radius": 0.03}, {}, ("load: got weight", "torque where coupling is contact")),
        ({}, {"method": "grid"}, ("method: got grid", "auto or adaptive")),
        ({}, {"tangential": "brush"}, ("coupling: got contact", "none where tangential is brush")),
        ({}, {"contact": "hertz"}, ("coupling: got contact", "none where contact is hertz")),
        ({}, {"tolerance": 1.0}, ("tolerance: got 1",)),
        ({}, {"sampling_period": -1.0}, ("sampling_period: got -1",)),
    ],
)
def test_what_has_no_coupled_point_is_refused(motor, drive, words, naming):
    with pytest.raises(ts.ParameterError) as caught:
        ts.evaluate(motor, ts.Drive(**drive), coupling="contact", **words)
    assert_one_clear_line(str(caught.value), *naming)


ONES = {
    "holding": (ts.holding, {}),
    "optimize": (ts.optimize, {"target_speed": 1.0}),
    "pareto": (ts.pareto, {"objective": "wear", "points": 3}),
    "robust": (ts.robust, {"objective": "wear", "spreads": {"friction_coefficient": 0.01}}),
    "speed_table": (ts.speed_table, {"slowest": 1.0, "fastest": 2.0, "points": 2}),
    "track": (ts.track, {"target_speed": 1.0}),
}


@pytest.mark.parametrize("name", ONES)
def test_what_does_not_take_the_level_says_why_in_one_line(name):
    function, words = ONES[name]
    with pytest.raises(ts.ParameterError) as caught:
        function(coupling="contact", **words)
    assert_one_clear_line(str(caught.value), "coupling: got contact, need none: ", "need not be the only one")


CONSOLE = {
    "c-library": ("{folder}/library",),
    "fmu": ("{folder}/motor.fmu", "--sources-only"),
    "speed-table": ("--from", "1 arcsec/s", "--to", "2 arcsec/s", "--points", "2"),
    "evaluate": ("--hold-within", "0.01", "--compliance", "flange"),
}


@pytest.mark.parametrize("command", CONSOLE)
def test_the_console_refuses_it_too_and_writes_nothing(console_refuses, tmp_path, command):
    line = [word.format(folder=tmp_path) for word in CONSOLE[command]]
    console_refuses(command, *line, "--coupling", "contact", naming=("--coupling: got contact, need none: ",))
    assert list(tmp_path.iterdir()) == []


def test_the_table_names_the_orbit_and_the_console_ends_with_what_became_of_it(capsys):
    from trum_sym import console

    words = ["evaluate", "--coupling", "contact", "--compliance", "flange", "--tolerance", "1e-3"]
    assert console.main(words) == 0
    out = capsys.readouterr().out
    assert "orbit: from rest, closed after 1 cycle, branch only, multipliers up to 0.931; rotor of 20 g" in out
    assert "highest wave" in out
    assert "stall torque" not in out
    assert "rotor_mass 0.02 kg (0.0064" in out
    assert console.main([*words, "--load-torque", "5"]) == 1
    assert "orbit: none" in capsys.readouterr().out
