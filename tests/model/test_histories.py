"""Time histories against ``evaluate``, the independent orbit and eq. 11; files and bad input."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.histories import VARIABLES

xr = lazily("xarray")
orbit_reference = lazily("orbit_reference")
DRIVE = {"periods": 6, "on_periods": 4, "load_torque": 0.1}


@pytest.fixture(scope="module", params=["periodic", "steady", "rest"])
def drive(request):
    return ts.Drive(**DRIVE, start=request.param)


@pytest.fixture(scope="module")
def found(trum60, drive):
    return ts.simulate(trum60, drive, cycles=2, samples_per_period=32, tolerance=1e-7)


@pytest.fixture(scope="module")
def reference(trum60, drive):
    other = orbit_reference.Reference(trum60, drive, ts.evaluate(trum60, drive, tolerance=1e-7))
    return other, other.orbit()


def test_every_history_has_one_value_a_time_its_unit_and_its_meaning(found):
    assert dict(found.sizes) == {"time": 2 * 6 * 32}
    assert list(found.data_vars) == list(VARIABLES)
    for name, (unit, meaning) in VARIABLES.items():
        assert (found[name].units, found[name].long_name) == (unit, meaning)
        assert np.isfinite(found[name]).all()
    assert found.time.units == "s"
    assert np.diff(found.time) == pytest.approx(found.attrs["cycle_time"] / (6 * 32), rel=1e-9)
    assert [int((found.region == r).sum()) for r in range(3)] == [2 * 32 * 2, 2 * 32 * 2, 2 * 32 * 2]


def test_attributes_hold_every_setting_and_figure(found, trum60, drive):
    point = ts.evaluate(trum60, drive, tolerance=1e-7)
    known = found.attrs
    for name, value in {**drive.numbers(), **point.figures}.items():
        assert known[name] == value
    assert known["runaway"] == 0
    assert known["source"].startswith("trum-sym ")
    assert known["motor_rotor_inertia"] == "4.5e-06 kg*m^2 (Table 1)"
    assert all(f"motor_{name}" in known for name, _ in trum60.parameters())


def test_the_rotors_history_has_the_mean_and_extremes_of_the_operating_point(found, trum60, drive):
    point = ts.evaluate(trum60, drive, tolerance=1e-7)
    one = found.sizes["time"] // 2
    scale = max(abs(point.min_speed), abs(point.max_speed))
    advance = float(found.rotor_angle[one] - found.rotor_angle[0])
    assert advance / point.cycle_time == pytest.approx(point.mean_speed, abs=1e-6 * scale)
    speed = found.rotor_speed.values
    assert np.array_equal(speed[:one], speed[one:])
    assert point.min_speed - 1e-6 * scale <= speed.min() < point.min_speed + 0.02 * scale
    assert point.max_speed + 1e-6 * scale >= speed.max() > point.max_speed - 0.02 * scale
    angle = found.rotor_angle.values
    trapezoid = np.cumsum((speed[1:] + speed[:-1]) / 2) * (found.time.values[1] - found.time.values[0])
    assert np.abs(angle[1:] - angle[0] - trapezoid).max() < 2e-3 * np.abs(angle).max()


def test_histories_agree_with_the_independent_orbit(found, reference):
    other, orbit = reference
    whole = other.durations.copy()
    for i in range(0, 6 * 32, 7):
        time, region, at = float(found.time[i]), int(found.region[i]), found.isel(time=i)
        tau = time - whole[:region].sum()
        w = orbit_reference.modal(other.p, other.states[region], orbit_reference.GATES[region], tau)
        height = np.hypot(w[0], w[1])
        other.durations = np.where(np.arange(3) < region, whole, 0.0)
        other.durations[region] = tau
        x = other.lap(orbit.start * other.radius, 1e-12)[0]
        speed = orbit.start + x[0] / other.radius
        W = other.p[5]
        assert float(at.w_A) == pytest.approx(w[0], abs=1e-10 * W)
        assert float(at.w_B) == pytest.approx(w[1], abs=1e-10 * W)
        along = other.p[6] * (w[2] * w[1] - w[3] * w[0])
        assert float(at.Q) == pytest.approx(along, abs=1e-10 * other.p[6] * W**2 * other.p[0])
        if height > 0:  # the very first instant of a start from rest
            assert float(at.crest_speed) == pytest.approx(along / height, rel=1e-9, abs=1e-12)
        assert float(at.theta) == pytest.approx(orbit_reference.half_angle(other.p, height), rel=1e-9)
        assert float(at.rotor_speed) == pytest.approx(speed, abs=2e-5 * orbit.largest)  # a cubic between steps
        net = orbit_reference.surface(other.p, w, float(at.rotor_speed) * other.radius)[0]
        assert float(at.friction) == pytest.approx(net, abs=1e-7)
        angle = orbit.start * time + x[1] / other.radius
        assert float(at.rotor_angle) == pytest.approx(angle, abs=1e-5 * orbit.largest * other.cycle_time)
    other.durations = whole


def test_the_surface_moves_as_eq_11_says(found):
    import sympy as sp

    w_A, w_B, k, D, x = sp.symbols("w_A w_B k D x")
    zeta_z = w_A * sp.sin(k * x) + w_B * sp.cos(k * x)
    values = (found.w_A.values, found.w_B.values, found.attrs["wavenumber"], found.attrs["neutral_axis"])
    for name, law in (("zeta_z", zeta_z), ("zeta_x", D * zeta_z.diff(x))):
        expected = sp.lambdify((w_A, w_B, k, D), law.subs(x, 0), "numpy")(*values)
        assert found[name].values == pytest.approx(expected, rel=1e-12)


def test_a_runaway_rotor_leaves_the_stators_histories(trum60):
    found = ts.simulate(trum60, ts.Drive(**{**DRIVE, "load_torque": 2.0}))
    assert found.attrs["runaway"] == 1
    assert found.attrs["converged"] == 0
    lost = {name for name in found.data_vars if np.isnan(found[name]).any()}
    assert lost == {"friction", "rotor_speed", "rotor_angle"}
    assert all(np.isnan(found[name]).all() for name in lost)


def test_hertz_contact_has_its_own_half_angle(trum60):
    drive = ts.Drive(**DRIVE)
    found = ts.simulate(trum60, drive, contact="hertz")
    other = orbit_reference.Reference(trum60, drive, ts.evaluate(trum60, drive, contact="hertz"), contact="hertz")
    height = np.hypot(found.w_A, found.w_B).values
    assert found.theta.values == pytest.approx([orbit_reference.half_angle(other.p, h) for h in height], rel=1e-9)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"cycles": 0}, "cycles: got 0"),
        ({"cycles": 1.5}, "cycles: got 1.5"),
        ({"cycles": "two"}, "cycles: got two"),
        ({"cycles": np.array([1, 2])}, r"cycles: got an array of shape \(2,\)"),
        ({"samples_per_period": -1}, "samples_per_period: got -1"),
        ({"cycles": 10**6}, "cycles: got 1000000, need at most"),
        ({"drive": ts.Drive(prepressure=np.array([150.0, 180.0]))}, r"prepressure: got an array of shape \(2,\)"),
        ({"drive": 3}, "drive: got 3"),
        ({"contact": "glue"}, "contact: got glue"),
        ({"tolerance": 1.0}, "tolerance: got 1"),
        ({"sampling_period": np.array([1e-3])}, r"sampling_period: got an array of shape \(1,\)"),
    ],
)
def test_bad_input_is_named(trum60, wrong, message):
    with pytest.raises(ts.ParameterError, match=message):
        ts.simulate(trum60, **wrong)


def test_without_xarray_the_extra_is_named(trum60, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ts.MissingExtraError, match=r"simulate needs xarray: pip install 'trum-sym\[data\]'"):
        ts.simulate(trum60)
    assert main(["simulate"]) == 2
    assert capsys.readouterr().err == "trum-sym: simulate needs xarray: pip install 'trum-sym[data]'\n"


@pytest.mark.parametrize("suffix", [".nc", ".csv"])
def test_the_console_writes_what_python_gives(trum60, tmp_path, suffix, capsys):
    target = tmp_path / f"histories{suffix}"
    options = ["--periods", "6", "--on-periods", "4", "--load-torque", "0.1", "--cycles", "2"]
    assert main(["simulate", *options, "--out", str(target)]) == 0
    assert capsys.readouterr().out == f"{target}: 768 times of 10 histories\n"
    assert [path.name for path in tmp_path.iterdir()] == [target.name]
    ours = ts.simulate(trum60, ts.Drive(**DRIVE), cycles=2)
    if suffix == ".nc":
        with xr.open_dataset(target) as written:
            assert written.load().equals(ours)
            assert written.attrs["motor_rotor_inertia"] == ours.attrs["motor_rotor_inertia"]
            assert written.theta.units == "rad"
    else:
        lines = target.read_text().splitlines()
        assert lines[0].split(",")[:3] == ["time [s]", "w_A [m]", "w_B [m]"]
        assert float(lines[-1].split(",")[1]) == float(ours.w_A[-1])
        assert len(lines) == 769


def test_the_console_prints_a_summary(capsys):
    assert main(["simulate", "--load-torque", "2"]) == 1
    out = capsys.readouterr().out
    assert "rotor_speed" in out
    assert "no speed balances the load" in out


@pytest.mark.parametrize("name", ["histories.txt", "histories", "missing/histories.nc", "folder.nc", "file/x.csv"])
def test_a_file_that_cannot_be_written_is_refused_before_any_work(console_refuses, tmp_path, name):
    (tmp_path / "folder.nc").mkdir()
    (tmp_path / "file").write_text("")
    console_refuses("simulate", "--out", str(tmp_path / name), naming=("--out", "got", "need a file"))


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(console_refuses, tmp_path, monkeypatch):
    def fails(_handle):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fails)
    (tmp_path / "histories.nc").write_text("old")
    console_refuses(
        "simulate", "--force", "--out", str(tmp_path / "histories.nc"), naming=("--out", "No space left on device")
    )
    assert [path.name for path in tmp_path.iterdir()] == ["histories.nc"]
    assert (tmp_path / "histories.nc").read_text() == "old"


@pytest.mark.parametrize("option", [["--cycles", "0"], ["--cycles", "2.5"], ["--samples-per-period", "none"]])
def test_bad_options_are_one_line(console_refuses, option):
    console_refuses("simulate", *option, naming=(option[0], f"got {option[1]}"))


def test_evaluate_does_not_wait_for_xarray():
    code = (
        "import sys\nfrom trum_sym.console import main\nmain(['evaluate', '--json'])\n"
        "sys.exit(bool({'xarray', 'pandas', 'scipy'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, check=False).returncode == 0
