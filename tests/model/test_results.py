"""Results as users of NumPy, xarray and pandas expect them: units, labels, short representations, one set of names."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from refusals import refusal

import trum_sym as ts
from trum_sym.model.kernels import check_build
from trum_sym.quantities import ERRORS, QUANTITIES

ROOT = Path(__file__).parents[2]
GRID = ts.Drive(prepressure=np.array([[160.0], [170.0]]), frequency_difference=[2900.0, 3000.0, 3100.0])


def test_a_point_needs_nothing(trum60):
    assert ts.evaluate() == ts.evaluate(trum60, ts.Drive())
    assert ts.sensitivities() == ts.sensitivities(trum60)


def test_text_with_a_unit_goes_wherever_a_number_goes():
    given = ts.Drive(prepressure="0.17 kN", frequency_difference=["2.9 kHz", "3000"], load_torque="50 mN m")
    assert given == ts.Drive(prepressure=170.0, frequency_difference=[2900.0, 3000.0], load_torque=0.05)
    assert ts.evaluate(sampling_period="2 ms", tolerance="1e-5") == ts.evaluate(sampling_period=2e-3, tolerance=1e-5)
    with refusal("prepressure: got 170 Hz", "in N"):
        ts.Drive(prepressure="170 Hz")
    with refusal("prepressure: got strong", "in N"):
        ts.Drive(prepressure=["170 N", "strong"])
    with refusal("prepressure", "a finite number"):
        ts.Drive(prepressure=["170 N", 180.0])


def test_every_figure_has_its_unit():
    point = ts.evaluate()
    known = {**QUANTITIES, **ERRORS}
    assert {name: unit for name, unit in point.units.items() if name in known} == {
        name: quantity.unit for name, quantity in known.items()
    }
    assert (point.units["prepressure"], point.units["frequency_difference"]) == ("N", "Hz")


def test_a_grid_is_a_labelled_data_set(trum60):
    point = ts.evaluate(trum60, GRID)
    data = point.to_xarray()
    assert data.mean_speed.shape == (2, 3)
    assert np.array_equal(data.mean_speed, point.mean_speed)
    assert data.mean_speed.units == "rad/s"
    assert data.prepressure.units == "N"
    assert data.attrs["contact_level"] == "winkler"
    assert data.attrs["load_torque"] == 0.3


def test_labels_of_inputs_are_those_of_the_data_set():
    import xarray as xr

    forces = xr.DataArray([160.0, 170.0], {"spring": ["soft", "hard"]}, ["spring"], attrs={"units": "N"})
    data = ts.evaluate(drive=ts.Drive(prepressure=forces)).to_xarray()
    assert data.mean_speed.dims == ("spring",)
    assert float(data.mean_speed.sel(spring="hard")) == ts.evaluate(
        drive=ts.Drive(prepressure=170.0), tolerance=1e-6
    ).mean_speed  # fmt: skip


def test_a_frame_has_a_row_a_point(trum60):
    frame = ts.evaluate(trum60, GRID).to_frame()
    assert len(frame) == 6
    assert list(frame.prepressure) == [160.0] * 3 + [170.0] * 3
    assert frame.attrs["units"]["mean_speed"] == "rad/s"
    assert len(ts.evaluate().to_frame()) == 1


def test_slopes_are_labelled_and_have_units():
    """2900 Hz to 3100 Hz in steps of 1 Hz would do as well: a difference against the slope by name and unit."""
    slopes = ts.sensitivities(drive=ts.Drive(load_torque=0.1), tolerance=1e-9)
    near = [ts.evaluate(drive=ts.Drive(load_torque=0.1 + h), tolerance=1e-9).mean_speed for h in (1e-5, -1e-5)]
    assert float(slopes["mean_speed"]["load_torque"]) == pytest.approx((near[0] - near[1]) / 2e-5, rel=1e-4)
    assert slopes.units["mean_speed"]["load_torque"] == "rad/s/(N*m)"
    assert slopes.units["speed_volatility"]["friction_coefficient"] == "1"
    frame = slopes.to_frame()
    assert frame.loc["mean_speed", "load_torque"] == slopes["mean_speed"]["load_torque"]
    data = slopes.to_xarray()
    assert float(data.mean_speed.sel(parameter="load_torque")) == slopes["mean_speed"]["load_torque"]
    assert "per load_torque" in slopes.to_text()
    record = json.loads(slopes.to_json())
    assert record["slopes"]["mean_speed"]["load_torque"] == slopes["mean_speed"]["load_torque"]
    assert record["units"]["slopes"]["mean_speed"]["load_torque"] == "rad/s/(N*m)"


def test_representations_are_short(trum60):
    results = [trum60, ts.evaluate(), ts.evaluate(trum60, GRID), ts.evaluate().inputs, ts.sensitivities()]
    for result in results:
        assert len(repr(result)) < 250
        assert "\n" not in repr(result)
    assert "mean_speed -2.30" in repr(results[1])
    assert "(2, 3)" in repr(results[2])
    assert results[1]._repr_html_().startswith("<pre>&lt;OperatingPoint TRUM-60")


def test_the_same_names_turn_every_result_into_something_else():
    from trum_sym.calibration.result import Calibration
    from trum_sym.optimiser.result import Optimum
    from trum_sym.studies.pareto import ParetoFront
    from trum_sym.studies.robust import RobustPoint
    from trum_sym.studies.speed_table_result import SpeedTable
    from trum_sym.uncertainty.study import Study

    kinds = (ts.OperatingPoint, ts.Sensitivities, Optimum, ParetoFront, RobustPoint, SpeedTable, Study, Calibration)
    for kind in kinds:
        assert all(callable(getattr(kind, name)) for name in ("to_dict", "to_json", "to_text"))
        assert not [name for name in dir(kind) if re.match(r"as_(dict|json|table|text)|dataset", name)], kind


def test_the_version_is_the_packages():
    assert ts.__version__ == version("trum-sym")


def test_the_snippet_of_the_readme_prints_the_readmes_figures():
    text = (ROOT / "README.md").read_text("utf-8")
    code = re.search(r"```python\n(.*?)```", text, re.DOTALL)[1]
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, encoding="utf-8", check=True)
    for name in ("q_average", "resonance_frequency", "mean_speed"):
        (line,) = (line for line in done.stdout.splitlines() if line.startswith(name))
        value = float(line.split()[1])
        label = {"q_average": "Q_aver", "resonance_frequency": "f_n", "mean_speed": "v_s"}[name]
        (row,) = (row for row in text.splitlines() if re.match(rf"[a-z ]+ {label}  ", row))
        assert float(row.split(label)[1].split()[0]) == pytest.approx(value, rel=1e-5)


def test_a_build_older_than_its_sources_is_noticed(tmp_path):
    import warnings

    from trum_sym import _kernels

    for folder in ("generated", "trum_sym/_driver"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_build(tmp_path, _kernels.made_of, 0.0)  # older, but of the same sources
    source = tmp_path / "generated" / "trum_drive.c"
    source.write_text(source.read_text("utf-8") + "\n", "utf-8")
    with pytest.warns(ts.StaleBuildWarning, match=r"older than their sources .*pip install -e"):
        check_build(tmp_path, _kernels.made_of, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_build(tmp_path / "nowhere", _kernels.made_of, 0.0)
