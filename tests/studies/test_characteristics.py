"""Characteristics: curves against single points, power by sums of its own, measured points read and refused."""

from __future__ import annotations

import json

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.console import main
from trum_sym.inputs.measured_points import load_measured, measured_of
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.kernels import call
from trum_sym.studies.characteristics import predicted

orbit_reference = lazily("orbit_reference")


@pytest.fixture(scope="module", autouse=True)
def xarray_is_there():
    pytest.importorskip("xarray")


DRIVE = ts.Drive(frequency_difference=500.0)
LEVELS = {"amplitude": "forced", "compliance": "flange"}


@pytest.fixture(scope="module")
def curves():
    return ts.characteristics(ts.load_motor(), DRIVE, points=7, tolerance=1e-5, **LEVELS)


def test_curves_are_those_of_single_points(curves, trum60):
    for form, pulses in (("plain", 20), ("pulse", 14)):
        of = curves.sel(drive=form)
        load = float(of["torque"][3])
        assert float(of["direction"]) == 1
        point = ts.evaluate(
            trum60, ts.Drive(frequency_difference=500.0, on_periods=pulses, load_torque=load), tolerance=1e-5, **LEVELS
        )
        assert float(of["mean_speed"][3]) == point.mean_speed
        assert float(of["output_power"][3]) == pytest.approx(load * point.mean_speed, rel=1e-12)
        force = float(of["prepressure"][2])
        free = ts.Drive(prepressure=force, frequency_difference=500.0, on_periods=pulses, load_torque=0.0)
        there = ts.evaluate(trum60, free, tolerance=1e-5, **LEVELS)
        assert float(of["speed_by_prepressure"][2]) == there.mean_speed
        assert float(of["stall_by_prepressure"][2]) == there.stall_torque


def test_speed_falls_with_load_and_frequency_and_power_has_a_top(curves):
    plain = curves.sel(drive="plain")
    assert (np.diff(plain["mean_speed"].values[:6]) < 0).all()
    assert (np.diff(plain["speed_by_frequency"].values) < 0).all()
    assert 0 < int(np.argmax(plain["output_power"].values)) < 6
    assert float(curves["stall_torque"][1]) < float(curves["stall_torque"][0]) < 0.25 * 180 * 0.0265


def test_efficiency_is_what_the_surface_gives_against_what_the_rotor_takes(curves, trum60):
    """Of a plain wave, by a sum over the contact: traction times the surface's speed is what goes in."""
    plain = curves.sel(drive="plain")
    load = float(plain["torque"][3])
    point = ts.evaluate(trum60, ts.Drive(frequency_difference=500.0, on_periods=20, load_torque=load), **LEVELS)
    theta, crest = np.pi * point.contact_fraction, 2 * np.pi * point.drive_frequency * point.amplitude
    crest *= point.neutral_axis * point.wavenumber
    u = theta * (2 * (np.arange(400_000) + 0.5) / 400_000 - 1)
    press = np.cos(u) - np.cos(theta)
    press *= 180.0 / press.sum()
    drive = 0.25 * press * np.sign(crest * np.cos(u) - point.mean_speed * 0.0265)
    given = float((drive * crest * np.cos(u)).sum())
    assert float(plain["contact_efficiency"][3]) == pytest.approx(load * point.mean_speed / given, rel=1e-4)
    efficiency = curves["contact_efficiency"].values
    assert ((efficiency[np.isfinite(efficiency)] >= 0) & (efficiency[np.isfinite(efficiency)] < 1)).all()


def test_the_heat_of_a_pulse_drive_is_that_of_another_integration(curves, trum60):
    pulse = curves.sel(drive="pulse")
    drive = ts.Drive(frequency_difference=500.0, load_torque=float(pulse["torque"][2]))
    point = ts.evaluate(trum60, drive, tolerance=1e-7, **LEVELS)
    values = {**trum60.symbols(), "k_N": 3e10, "k_c": 300.0}
    whole = float(call("trum_contact_stiffness", values)["k_con"])
    with unquestioned():
        alike = trum60.with_values({"layer_young_modulus": whole * 0.2e-3 / 1.2e-3})
    orbit = orbit_reference.Reference(alike, drive, point).orbit()
    power = float(pulse["output_power"][2])
    assert float(pulse["contact_efficiency"][2]) == pytest.approx(power / (power + orbit.heat), rel=2e-3)


def test_a_stiff_brush_has_the_efficiency_of_the_rigid_layer(trum60):
    stiff = trum60.with_values({"tangential_stiffness": 1e18})
    plain = ts.Drive(frequency_difference=500.0, on_periods=20)
    rigid, brush = (
        ts.characteristics(motor, plain, points=4, tangential=level)
        for motor, level in ((trum60, "rigid"), (stiff, "brush"))
    )
    assert brush["contact_efficiency"].values == pytest.approx(rigid["contact_efficiency"].values, rel=2e-3)
    soft = ts.characteristics(trum60, plain, points=4, tangential="brush")
    assert (soft["mean_speed"].values[0, 1:] < rigid["mean_speed"].values[0, 1:]).all()


def test_the_shipped_motors_have_their_sources_and_their_points_apart():
    for name in ("dual60", "ring60"):
        motor = ts.load_motor(name)
        points = load_measured(measured_of(name))
        assert all(point.source for point in points)
        text = motor.text
        assert "120" not in {
            line.split("value = ")[1].split(",")[0] for line in text.splitlines() if "value = " in line
        }
        for parameter_name, parameter in motor.parameters():
            assert parameter.source, parameter_name
            assert parameter.source != "assumed" or parameter.range, parameter_name
    half = [point for point in load_measured(measured_of("dual60")) if point.x > 0]
    assert [(point.x, round(point.y * 30 / np.pi)) for point in half] == [(0.45, 54), (0.8, 0)]
    # 4e7 N/m over 30 mm; eq. 31 with it is that model's balance 2 k_r w0 (sin t - t cos t)
    assert ts.load_motor("ring60").contact_stiffness.value == pytest.approx(4e7 / 0.03, rel=1e-7)


def test_prediction_stands_beside_every_measured_point():
    motor, points = ts.load_motor("dual60"), load_measured(measured_of("dual60"))
    drive = ts.Drive(frequency_difference=500.0, on_periods=20)
    found = ts.characteristics(motor, drive, points=5, measured=points, compliance="flange")
    at = ts.evaluate(motor, ts.Drive(frequency_difference=500.0, on_periods=20, load_torque=0.0), compliance="flange")
    assert predicted(found)[0] == pytest.approx(at.mean_speed, rel=1e-5)
    assert np.isfinite(predicted(found)).all()
    assert found["measured_source"].values[0].startswith("Lu, Hu, Yang, Zhao")


@pytest.mark.parametrize(
    ("text", "naming"),
    [
        ("point = 3", "tables [[point]]"),
        ("[[point]]\ncurve = 'speed'", "point.drive: got nothing"),
        ("[[point]]\ncolour = 'red'", "point: got colour, need no other keys"),
        (
            "[[point]]\ncurve='speed_torque'\ndrive='plain'\nsource='x'\nx={value=1,unit='m'}\ny={value=1,unit='rpm'}",
            "point.x: got m, need a unit that converts to N*m",
        ),
        ("[[point]", "a valid TOML file"),
    ],
)
def test_a_file_of_measured_points_that_is_none_is_refused(tmp_path, text, naming):
    path = tmp_path / "x.toml"
    path.write_text(text)
    with pytest.raises(ts.ParameterError) as refusal:
        load_measured(path)
    assert naming in str(refusal.value)


def test_the_console_writes_table_json_csv_netcdf_and_picture(tmp_path, capsys):
    wide = ["--points", "3", "--on-periods", "20", "--frequency-difference", "500", "--compliance", "flange"]
    for name in ("x.csv", "x.nc"):
        plot = ["--plot", str(tmp_path / "x.png")] if name == "x.csv" else ["--json"]
        assert main(["characteristics", "--motor", "dual60", *wide, "--out", str(tmp_path / name), *plot]) == 0
        out = capsys.readouterr().out
        if name == "x.csv":
            assert "no load, rpm" in out
            assert "half of the torque of two rotors" in out
        else:
            assert json.loads(out)["variables"]["mean_speed"]["units"] == "rad/s"
    rows = (tmp_path / "x.csv").read_text().splitlines()
    assert rows[0] == "curve,drive,x,y,x_unit,y_unit,kind"
    assert sum(row.endswith("measured") for row in rows) == 3
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")
    import xarray as xr

    with xr.open_dataset(tmp_path / "x.nc", engine="h5netcdf") as found:
        assert found["mean_speed"].shape == (1, 3)


@pytest.mark.parametrize(
    ("arguments", "naming"),
    [
        (("--points", "1"), ("points: got 1", "2")),
        (("--out", "x.txt"), ("--out: got x.txt", ".nc or .csv")),
        (("--measured", "nothing.toml"), ("measured: got nothing.toml", "exists")),
        (("--load-torque", "0.1"), ("--load-torque: got 0.1", "over all loads")),
    ],
)
def test_bad_input_is_one_line(console_refuses, arguments, naming):
    console_refuses("characteristics", *arguments, naming=naming)


@pytest.mark.parametrize("name", ["", ".", "/"])
def test_a_motor_whose_path_has_no_name_is_refused_in_one_line(name, capsys):
    assert main(["characteristics", "--motor", name]) == 2
    said = capsys.readouterr().err
    assert said.startswith("trum-sym: --motor: got ")
    assert said.count("\n") == 1
