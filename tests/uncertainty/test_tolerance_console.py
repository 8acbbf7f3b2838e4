"""trum-sym spread: what it prints and writes, an optimiser's point, and what it refuses."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest
from refusals import MOTOR, assert_one_clear_line

import trum_sym as ts
from trum_sym import console
from trum_sym.plots.tolerance import draw

SHORT = ("--periods", "4", "--on-periods", "3", "--load-torque", "0.05", "--samples", "64")
VARY = ("--spread", "friction_coefficient", "--spread", "prepressure=normal:180:5")


def run(*arguments):
    return console.main(["spread", *SHORT, *arguments])


def test_console_gives_what_python_gives(capsys):
    assert run(*VARY, "--json", "--seed", "3", "--output", "max_speed", "--target", "max_speed > 0 rpm") == 0
    out = capsys.readouterr().out
    spread = ts.Distribution("normal", mean=180.0, standard_deviation=5.0)
    study = ts.spread(
        MOTOR,
        ts.Drive(periods=4, on_periods=3, load_torque=0.05),
        spreads={"friction_coefficient": None, "prepressure": spread},
        samples=64,
        seed=3,
        outputs=["max_speed"],
        target="max_speed > 0 rpm",
    )
    assert out.strip() == study.to_json()
    record = json.loads(out)
    described = {"kind": "normal", "mean": 180.0, "standard_deviation": 5.0, "unit": "N"}
    assert record["parameters"]["prepressure"] == {**described, "low": None, "high": None, "mode": None}
    assert (record["count"], record["seed"], record["samples"]) == (256, 3, 64)
    assert record["targets"][0]["value"] == 0
    assert record["targets"][0]["high"] == pytest.approx(1 - 0.025 ** (1 / 128))


def test_the_same_seed_prints_the_same(capsys):
    printed = []
    for seed in ("1", "1", "2"):
        run(*VARY, "--json", "--seed", seed)
        printed.append(capsys.readouterr().out)
    assert printed[0] == printed[1] != printed[2]


def test_every_point_is_written(capsys, tmp_path):
    import xarray as xr

    for name in ("points.csv", "points.nc"):
        assert run(*VARY, "--out", str(tmp_path / name)) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["points.csv", "points.nc"]
    lines = (tmp_path / "points.csv").read_text().splitlines()
    assert len(lines) == 257
    assert lines[0].startswith("matrix,sample,friction_coefficient [1],prepressure [N],resonance_frequency [Hz]")
    with xr.open_dataset(tmp_path / "points.nc", engine="h5netcdf") as data:
        assert data.mean_speed.units == "rad/s"
        column = lines[0].split(",").index("mean_speed [rad/s]")
        assert float(data.mean_speed[3, 5]) == float(lines[1 + 3 * 64 + 5].split(",")[column])
    assert "friction_coefficient" in capsys.readouterr().out


def test_the_picture_is_drawn(tmp_path):
    target = tmp_path / "study.png"
    assert run(*VARY, "--plot", str(target)) == 0
    assert target.read_bytes().startswith(b"\x89PNG")
    assert list(tmp_path.iterdir()) == [target]


def test_the_picture_shows_intervals_and_indices(tmp_path):
    import matplotlib as mpl

    drive = ts.Drive(periods=4, on_periods=3, load_torque=1.1)
    parameters = {"friction_coefficient": None, "prepressure": "normal:180:5"}
    study = ts.spread(MOTOR, drive, spreads=parameters, samples=64, target="mean_speed >= 6000000 arcsec/s")
    with mpl.rc_context({"svg.fonttype": "none"}):
        draw("--plot", study, tmp_path / "study.svg")
    text = (tmp_path / "study.svg").read_text("utf-8")
    for words in (
        "median",
        "nominal",
        "mean_speed &gt;= 6000000 arcsec/s",
        "alone (first order)",
        "with others (total)",
        "interval at 95",
        "no speed balances the load",
        "prepressure",
        "variance of speed volatility",
    ):
        assert words in text


def test_an_interruption_leaves_no_file(tmp_path, monkeypatch, capsys):
    def half(_handle):
        assert len(list(tmp_path.iterdir())) == 1
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", half)
    assert run(*VARY, "--plot", str(tmp_path / "study.png")) == 130
    out, err = capsys.readouterr()
    assert out == ""
    assert "interrupted" in err
    assert list(tmp_path.iterdir()) == []


# --- What is refused -----------------------------------------------------------------------------

REFUSALS = [
    (("--spread", "frictoin"), ("--spread: got frictoin", "motor file or the drive")),
    (("--spread", "voltage"), ("--spread voltage: got nothing", "LOW:HIGH")),
    (("--spread", "voltage="), ("--spread: got voltage=", "NAME=VALUE")),
    (("--spread", ""), ("--spread: got empty text", "NAME=VALUE")),
    (("--spread", "=uniform:1:2"), ("--spread: got =uniform:1:2", "NAME=VALUE")),
    (("--spread", "voltage=flat:1:2"), ("voltage: got flat", "uniform, triangular, normal, lognormal")),
    (("--spread", "voltage=normal:200:-2"), ("voltage: got standard_deviation = -2", "> 0, in V")),
    (("--spread", "voltage=normal:200 V:2 A"), ("voltage, standard_deviation: got 2 A", "in V")),
    (("--spread", "voltage=uniform:-200:200"), ("voltage: got uniform with low = -200", "> 0 in V")),
    (
        ("--spread", "voltage=normal:200:2", "--spread", "voltage=normal:210:2"),
        ("--spread: got voltage", "each name once"),
    ),
    (("--spread", "motor=normal:200:2"), ("--spread: got motor", "motor file or the drive")),
    (("--samples", "100"), ("--samples: got 100", "a power of two from 64 to 1048576")),
    (("--samples", "32"), ("--samples: got 32", "a power of two from 64")),
    (("--samples", "many"), ("--samples: got many", "a number")),
    (("--seed", "-1"), ("--seed: got -1", ">= 0")),
    (("--seed", "0.5"), ("--seed: got 0.5", "an integer")),
    (("--tolerance", "1"), ("--tolerance: got 1", "<= 0.01")),
    (("--output", "speed"), ("--output: got speed", "mean_speed")),
    (("--spread", "friction_coefficient", "--output", "cycle_time"), ("--output: got cycle_time", "the same value")),
    (("--target", "600 arcsec/s"), ("--target: got 600 arcsec/s", "OUTPUT >= NUMBER")),
    (("--target", "mean_speed >= 600 arcsec"), ("target, mean_speed: got 600 arcsec", "rad/s")),
    (("--plot", "study.bmp"), ("--plot: got study.bmp", ".png, .svg or .pdf")),
    (("--plot", "/nowhere/study.png"), ("--plot: got /nowhere/study.png", "a folder that exists")),
    (("--out", "points.xlsx"), ("--out: got points.xlsx", ".nc, .parquet or .csv")),
    (("--out", "/nowhere/points.nc"), ("--out: got /nowhere/points.nc", "a folder that exists")),
    (("--set", "friction_coefficient=2 N"), ("friction_coefficient: got 2 N",)),
]


@pytest.mark.parametrize(("options", "naming"), REFUSALS, ids=[" ".join(options) for options, _ in REFUSALS])
def test_bad_options_are_one_line(console_refuses, options, naming):
    console_refuses("spread", *SHORT, *options, naming=naming)


def test_a_file_that_cannot_be_written_is_refused_before_the_work(monkeypatch, console_refuses):
    from trum_sym.uncertainty import study

    monkeypatch.setattr(study, "spread", None)  # called, it would raise
    console_refuses("spread", "--plot", "study.bmp", naming=("--plot",))
    console_refuses("spread", "--out", "points.xlsx", naming=("--out",))


@pytest.mark.parametrize(
    ("package", "options", "extra"),
    [
        ("scipy", (), "sweep"),
        ("matplotlib", ("--plot", "study.png"), "report"),
        ("xarray", ("--out", "points.csv"), "data"),
        ("h5netcdf", ("--out", "points.nc"), "data"),
    ],
)
def test_a_missing_package_is_named_before_the_work(monkeypatch, capsys, tmp_path, package, options, extra):
    from trum_sym.uncertainty import propagation

    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(__import__("sys").modules, package, None)
    monkeypatch.setattr(propagation, "propagate", None)
    assert run(*options) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert_one_clear_line(err, package, f"trum-sym[{extra}]")
    assert list(tmp_path.iterdir()) == []


def test_distributions_in_the_motor_file_are_used(motor_file, capsys):
    from refusals import voltage

    path = motor_file(voltage(distribution='"normal"', standard_deviation="2.0"))
    arguments = (
        "--motor",
        str(path),
        "--spread",
        "voltage",
        "--spread",
        "contact_radius",
        "--amplitude",
        "forced",
        "--json",
    )
    assert run(*arguments) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["parameters"]["voltage"]["standard_deviation"] == 2.0
    assert record["parameters"]["contact_radius"]["kind"] == "uniform"
    assert record["outputs"]["mean_speed"]["indices"]["parameters"]["voltage"]["total"]["value"] > 0
    assert np.isfinite(record["outputs"]["mean_speed"]["mean"])
