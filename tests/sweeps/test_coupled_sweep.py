"""Sweeps and spreads of points whose wave feels the rotor: their figures are those of single points."""

from __future__ import annotations

import numpy as np
import pytest
from refusals import refusal

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.coupled_point import COUPLED_FLAGS
from trum_sym.model.levels import Levels
from trum_sym.quantities import COUPLED, COUPLED_ERRORS
from trum_sym.sweeps import run
from trum_sym.sweeps.plan import make_plan
from trum_sym.sweeps.task import compute
from trum_sym.uncertainty.study import _uncertain

LEVELS = {"coupling": "contact", "compliance": "flange"}
DRIVE = ts.Drive(periods=4, on_periods=3)
COUNTS = {"cycles", "largest_multiplier", "branches"}


def test_every_point_has_the_bits_of_evaluate(trum60):
    loads, counts = [0.1, 3.0], [3.0, 1.0]
    found = ts.sweep(trum60, DRIVE, load_torque=loads, on_periods=counts, tolerance=1e-2, **LEVELS)
    assert set(found.data_vars) == {*COUPLED, *COUPLED_ERRORS, *COUPLED_FLAGS, *COUNTS, "status"}
    one = ts.evaluate(trum60, ts.Drive(periods=4, on_periods=3, load_torque=0.1), tolerance=1e-2, **LEVELS)
    here = found.isel(load_torque=0, on_periods=0)
    for name in set(found.data_vars) - {"status"}:
        assert np.array_equal(here[name].item(), getattr(one, name), equal_nan=True), name
    # one period of four is no pulse drive, and 3 N m is more than friction carries
    assert found.status.values.tolist() == [[0, 3], [1, 3]]
    assert found.attrs["coupling"] == "contact"
    assert found.highest_wave.attrs["units"] == "m"


def test_what_does_not_converge_has_its_status(trum60, monkeypatch):
    from dataclasses import replace

    from trum_sym.model import coupled_point

    plain = coupled_point.coupled_orbits
    monkeypatch.setattr(
        coupled_point, "coupled_orbits", lambda v, s: tuple(replace(o, closed=False) for o in plain(v, s))
    )
    found = ts.sweep(trum60, DRIVE, load_torque=[0.1], outputs=("mean_speed", "closed"), tolerance=1e-2, **LEVELS)
    assert found.status.values.tolist() == [2]
    assert found.closed.values.tolist() == [False]


def test_a_store_goes_on_where_it_was_left(trum60, tmp_path, monkeypatch):
    words = {"outputs": ("mean_speed",), "tolerance": 1e-2, "chunk": 1, "out": tmp_path / "map.zarr", **LEVELS}
    done = []
    monkeypatch.setattr(run, "compute_all", lambda tasks, *_: ((t, compute(t)) for k, t in enumerate(tasks) if k < 1))
    ts.sweep(trum60, DRIVE, load_torque=[0.1, 0.2], **words)

    def counted(tasks, *_):
        for task in tasks:
            done.append(task.index)
            yield task, compute(task)

    monkeypatch.setattr(run, "compute_all", counted)
    found = ts.sweep(trum60, DRIVE, load_torque=[0.1, 0.2], **words)
    assert done == [(1,)]
    assert found.status.values.tolist() == [0, 0]


def test_chunks_are_as_small_as_orbits_are_long(trum60):
    def chunk(**levels):
        ranges = {"prepressure": np.linspace(150, 210, 100), "load_torque": np.linspace(0, 0.1, 50)}
        return int(np.prod(make_plan(trum60, DRIVE, Levels(**levels), None, 1e-3, None, None, ranges).chunk))

    assert chunk() >= 1000
    assert chunk(**LEVELS) <= 64


def test_figures_that_take_no_orbit_take_none(trum60, monkeypatch):
    from trum_sym.model import coupled_point

    monkeypatch.setattr(coupled_point, "coupled_orbits", lambda *_: pytest.fail("an orbit"))
    found = ts.sweep(trum60, DRIVE, prepressure=[150.0, 210.0], outputs=("resonance_frequency",), **LEVELS)
    known = ts.evaluate(trum60, ts.Drive(prepressure=[150.0, 210.0]), compliance="flange")
    assert found.resonance_frequency.values == pytest.approx(known.resonance_frequency, rel=1e-14)


def test_figures_that_a_coupled_point_lacks_are_refused_with_the_reason(trum60):
    for figure in ("stall_torque", "q_average", "amplitude", "on_grid"):
        with refusal(f"outputs: got {figure}", "another figure where coupling is contact: "):
            ts.sweep(trum60, prepressure=[170.0, 180.0], outputs=(figure,), coupling="contact")
    with refusal("outputs: got stall_torque", "a rotor that is held still"):
        ts.spread(trum60, outputs=("stall_torque",), samples=64, coupling="contact")
    with refusal("target, highest_wave", "a finite number"):
        ts.spread(trum60, target="highest_wave <= inf um", samples=64, coupling="contact")
    with refusal("outputs: got highest_wave", "one of resonance_frequency"):
        ts.spread(trum60, outputs=("highest_wave",), samples=64)


def test_the_motor_file_s_ranges_have_the_rotor_s_mass_with_coupling(trum60):
    assert "rotor_mass" not in _uncertain(trum60, Levels())
    assert "rotor_mass" in _uncertain(trum60, Levels(coupling="contact"))
    assert "phase_coverage" not in _uncertain(trum60, Levels(coupling="contact"))
    assert "phase_coverage" in _uncertain(trum60, Levels(coupling="contact", amplitude="forced"))
    assert "piezo_permittivity" not in _uncertain(trum60, Levels(coupling="contact", amplitude="forced"))


@pytest.mark.slow
def test_a_spread_is_of_points_of_evaluate(trum60):
    words = {"tolerance": 1e-2, **LEVELS}
    outputs = ("mean_speed", "highest_wave")
    found = ts.spread(trum60, DRIVE, spreads={"rotor_mass": (0.01, 0.03)}, samples=64, outputs=outputs, **words)
    mass = float(found.propagation.points["rotor_mass"][1, 5])
    one = ts.evaluate(trum60.with_values({"rotor_mass": mass}), DRIVE, **words)
    for name in outputs:
        assert found.propagation.values[name][1, 5] == getattr(one, name)
    assert found.nominal == ts.evaluate(trum60, DRIVE, **words)
    assert "highest wave" in found.to_text()
    assert found.to_xarray().highest_wave.attrs["units"] == "m"


def test_the_console_sweeps_and_draws(tmp_path, capsys):
    line = ["sweep", "--coupling", "contact", "--compliance", "flange", "--load-torque", "0.1,0.2"]
    line += ["--tolerance", "1e-2", "--periods", "4", "--on-periods", "3", "--outputs", "mean_speed,highest_wave"]
    assert main([*line, "--out", str(tmp_path / "a.csv"), "--plot", str(tmp_path / "a.png")]) == 0
    assert "2 points of mean_speed highest_wave" in capsys.readouterr().out
    assert (tmp_path / "a.png").stat().st_size > 1000
    assert main([*line, "--out", str(tmp_path / "b.zarr"), "--dry-run"]) == 0
    assert "points a second" in capsys.readouterr().out
