"""Pareto fronts, robust points and speed tables, against evaluate, dense maps and a C compiler."""

from __future__ import annotations

import csv
import json
import shutil
import subprocess

import numpy as np
import pytest

import trum_sym as ts
from trum_sym import console
from trum_sym.inputs.units import ARCSEC
from trum_sym.optimiser.chart import Chart
from trum_sym.studies.pareto import _Candidate, _front
from trum_sym.studies.path import Candidates, choose
from trum_sym.studies.table_builder import Builder

LOAD = ts.Drive(load_torque=0.05)  # below the stall torque, which 0.3 N m is not
HELD = {"prepressure": 180}
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror"]


# --- Speed tables ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def table(trum60):
    return ts.speed_table(trum60, LOAD, slowest="500 arcsec/s", fastest="500000 arcsec/s", points=13, bounds=HELD)


def speeds_at(motor, drives):
    points = [ts.evaluate(motor, ts.Drive(load_torque=0.05, **drive), tolerance=1e-9) for drive in drives]
    return np.array([point.mean_speed for point in points])


def test_a_table_goes_through_both_directions_a_thousandfold(table):
    (segment,) = table.segments
    assert segment.speed[0] == pytest.approx(-500000 * ARCSEC)
    assert segment.speed[-1] == pytest.approx(500000 * ARCSEC)
    assert np.all(np.diff(segment.speed) > 0)
    assert not table.gaps
    assert np.min(np.abs(segment.speed)) <= 500 * ARCSEC * (1 + 1e-9)


def test_entries_have_the_speeds_that_they_say(trum60, table):
    (segment,) = table.segments
    found = speeds_at(
        trum60, [{"prepressure": 180.0, "frequency_difference": x} for x in segment.drive["frequency_difference"]]
    )
    assert found == pytest.approx(segment.speed, rel=2e-6, abs=3e-8)


def test_interpolated_drives_meet_their_speeds_within_the_stated_error(trum60, table):
    rng = np.random.default_rng(5)
    wanted = (
        np.concatenate(
            [rng.choice([-1, 1], 40) * np.exp(rng.uniform(np.log(500), np.log(5e5), 40)), rng.uniform(-500, 500, 10)]
        )
        * ARCSEC
    )
    found = speeds_at(trum60, [{"prepressure": 180.0, **table.at(speed)} for speed in wanted])
    off = np.abs(found - wanted) / np.maximum(np.abs(wanted), table.floor)
    assert np.max(off) <= table.error
    assert table.largest_error <= table.error


def test_the_drive_frequency_is_evaluates(trum60, table):
    (segment,) = table.segments
    drive = ts.Drive(load_torque=0.05, prepressure=180.0, frequency_difference=segment.drive["frequency_difference"])
    assert segment.drive_frequency == pytest.approx(ts.evaluate(trum60, drive).drive_frequency, rel=1e-12)
    assert segment.deviation == pytest.approx(
        ts.evaluate(trum60, drive, tolerance=1e-6).speed_volatility * np.abs(segment.speed), rel=1e-3
    )


def test_csv_has_every_entry_and_says_what_it_is(table, tmp_path):
    table.save(tmp_path / "table.csv")
    lines = (tmp_path / "table.csv").read_text("utf-8").splitlines()
    assert any("TRUM-60" in line for line in lines if line.startswith("#"))
    assert "# no gaps" in lines
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == len(table)
    assert float(rows[0]["mean_speed [arcsec/s]"]) == pytest.approx(-500000)
    assert {float(row["prepressure [N]"]) for row in rows} == {180.0}


@pytest.mark.skipif(not (shutil.which("cc") and shutil.which("c++")), reason="no compiler")
@pytest.mark.parametrize("compiler", [("cc", "-std=c99"), ("cc", "-std=c11"), ("c++", "-std=c++17")], ids=" ".join)
def test_the_c_table_compiles_strictly_and_interpolates_as_python_does(table, tmp_path, compiler):
    table.save(tmp_path / "slow-speeds.h")
    wanted = [-500000 * ARCSEC, -1.0, -0.001, 0.0, 0.002, 0.77, 500000 * ARCSEC, 3.0, -3.0]
    calls = "".join(f"  show({speed!r});\n" for speed in wanted)
    program = f"""#include <stdio.h>
#include "slow-speeds.h"
static void show(double speed) {{
  double drive[SLOW_SPEEDS_COLUMNS] = {{0, 0, 0}};
  const int known = slow_speeds_drive(speed, drive);
  printf("%d %.17g %.17g\\n", known, drive[SLOW_SPEEDS_PREPRESSURE], drive[SLOW_SPEEDS_FREQUENCY_DIFFERENCE]);
}}
int main(void) {{
{calls}  return 0;
}}
"""
    source = tmp_path / ("main.cpp" if compiler[0] == "c++" else "main.c")
    source.write_text(program)
    subprocess.run([*compiler, *STRICT, source, "-o", tmp_path / "main"], check=True)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    for speed, line in zip(wanted, done.stdout.splitlines(), strict=True):
        known, force, difference = (float(word) for word in line.split())
        if abs(speed) > 500000 * ARCSEC:
            assert known == 0
            with pytest.raises(ts.ParameterError, match="in a segment"):
                table.at(speed)
        else:
            assert (known, force) == (1, 180.0)
            assert difference == pytest.approx(table.at(speed)["frequency_difference"], rel=1e-13)


def test_speeds_beyond_the_box_are_named_gaps(trum60):
    found = ts.speed_table(trum60, LOAD, slowest="0.01", fastest="30", direction="positive", points=5, bounds=HELD)
    (gap,) = found.gaps
    assert gap.high == pytest.approx(30)
    assert gap.low == pytest.approx(found.reachable[1], rel=0.05)
    assert gap.reason == "beyond the mean speeds of the box"
    assert found.segments[-1].speed[-1] == gap.low


def test_speeds_that_a_constraint_excludes_are_named_gaps(trum60):
    found = ts.speed_table(
        trum60,
        LOAD,
        slowest="0.01",
        fastest="3",
        direction="positive",
        points=7,
        bounds=HELD,
        constraints=["abs(frequency_difference - 2990) >= 20 Hz"],
    )
    assert len(found.segments) == 2
    (gap,) = found.gaps
    assert "constraints" in gap.reason
    ends = speeds_at(trum60, [{"prepressure": 180.0, "frequency_difference": x} for x in (2970.0, 3010.0)])
    assert ends[0] * 0.9 < gap.low <= ends[0] * (1 + 1e-6)
    assert ends[1] * (1 - 1e-6) <= gap.high < ends[1] * 1.2


class Folded:
    """A motor of one variable whose mean speed folds back: x^3 - x on -1.5 to 1.5."""

    class box:
        names = ("x",)
        width = np.array([3.0])

        @staticmethod
        def at(share):
            return np.clip(-1.5 + 3.0 * share, -1.5, 1.5)

    def results(self, points, _):
        x = points[:, 0]
        speed = x**3 - x
        swing = np.full(x.size, 2.0)
        return {
            "mean_speed": speed,
            "speed_deviation": swing,
            "min_speed": -swing,
            "max_speed": swing,
            "drive_frequency": 4e4 + x,
        }

    def results_with_slopes(self, points, tolerance):
        return self.results(points, tolerance), {"mean_speed": 3 * points**2 - 1}


def test_a_fold_makes_a_jump_and_no_more_than_one():
    model = Folded()
    share = np.linspace(0, 1, 61)[:, np.newaxis]
    known = Chart(share, (61,), model.results(model.box.at(share), 0))
    speeds = np.linspace(-1.5, 1.5, 31)
    builder = Builder(model, known, (), speeds, 0.1, 0.01, lambda _: None)
    segments = builder.build()
    assert len(segments) == 2  # the rising branches on both sides of the fold
    (gap,) = builder.gaps
    assert gap[2].startswith("a jump")
    assert gap[1] - gap[0] < 1e-3
    for segment in segments:
        x = model.box.at(np.array([entry.share for entry in segment]))[:, 0]
        assert np.all(np.diff(x) > 0)
        between = np.linspace(segment[0].speed, segment[-1].speed, 301)
        drive = np.interp(between, [entry.speed for entry in segment], x)
        assert np.max(np.abs(drive**3 - drive - between) / np.maximum(np.abs(between), 0.1)) <= 0.01


def test_the_path_keeps_near_itself_where_costs_are_alike():
    left, right = np.array([[0.1]]), np.array([[0.9]])
    levels = [
        Candidates(left, np.array([1.0])),
        *(Candidates(np.concatenate([left, right]), np.array([1.05, 1.0])) for _ in range(5)),
        Candidates(left, np.array([1.0])),
    ]
    assert choose(levels) == [0] * 7  # 5 % less are not worth the way there and back
    levels[1:6] = [Candidates(np.concatenate([left, right]), np.array([5.0, 1.0]))] * 5
    assert choose(levels) == [0, 1, 1, 1, 1, 1, 0]
    assert choose([levels[0], Candidates(np.empty((0, 1)), np.empty(0)), levels[0]]) == [0, -1, 0]


# --- Pareto fronts --------------------------------------------------------------------------------


def dense(motor, count=41):
    force, difference = np.meshgrid(np.linspace(160, 210, count), np.linspace(2800, 3300, count), indexing="ij")
    return ts.evaluate(motor, ts.Drive(prepressure=force, frequency_difference=difference, load_torque=0.05))


@pytest.fixture(scope="module")
def front(trum60):
    return ts.pareto(trum60, LOAD, points=5)


def test_no_point_of_a_dense_map_beats_the_front_in_both(trum60, front):
    grid = dense(trum60)
    margin, volatility = grid.stall_torque - 0.05, grid.speed_volatility
    assert front.status == "solved"
    for point in front.points:
        # by 0.2 %: the map's orbits are rougher
        better = (volatility < point.objective * (1 - 2e-3)) & (margin >= point.against)
        better &= grid.mean_speed > 0
        assert not better.any()


def test_a_front_rises_and_its_figures_are_evaluates(trum60, front):
    assert len(front.points) >= 3
    assert np.all(np.diff([p.objective for p in front.points]) > 0)
    assert np.all(np.diff([p.against for p in front.points]) > 0)  # a larger margin is better, and costs
    for p in front.points:
        drive = ts.Drive(prepressure=p.prepressure, frequency_difference=p.frequency_difference, load_torque=0.05)
        point = ts.evaluate(trum60, drive, tolerance=1e-9)
        assert p.objective == pytest.approx(point.speed_volatility, rel=1e-7)
        assert p.against == pytest.approx(point.stall_torque - 0.05, rel=1e-7)


def test_what_another_point_beats_in_both_is_no_point_of_a_front():
    found = [
        _Candidate(f, g, None) for f, g in ((1.0, 5.0), (2.0, 4.0), (3.0, 6.0), (2.5, 5.5), (2.5, 5.7), (4.0, 6.0))
    ]
    assert [(c.objective, c.against) for c in _front(found, -1.0)] == [(1.0, 5.0), (2.5, 5.7), (3.0, 6.0)]  # large
    assert [(c.objective, c.against) for c in _front(found, 1.0)] == [(1.0, 5.0), (2.0, 4.0)]  # small


def test_ends_of_the_front_are_the_two_optima(trum60, front):
    least = ts.optimize(trum60, LOAD, objective="volatility")
    most = ts.optimize(trum60, LOAD, objective="-stall_torque")
    assert front.points[0].objective == pytest.approx(least.objective, rel=1e-6)
    assert front.points[-1].against == pytest.approx(-most.objective - 0.05, rel=1e-6)


def test_less_error_costs_volatility(trum60):
    target = 300000 * ARCSEC
    front = ts.pareto(trum60, LOAD, against="speed-error", target_speed=target, points=5, bounds=HELD)
    assert front.points[-1].against == pytest.approx(0, abs=1e-7)
    assert np.all(np.diff([p.against for p in front.points]) < 0)
    for p in front.points:
        assert p.against == pytest.approx(abs(p.mean_speed - target), abs=1e-12)


def test_a_front_without_a_feasible_point_says_so(trum60):
    front = ts.pareto(trum60, LOAD, points=3, constraints=["stall_torque >= 5 N*m"], bounds=HELD)
    assert (front.status, front.points) == ("infeasible", ())


# --- Robust points --------------------------------------------------------------------------------


def test_the_worst_speed_error_is_the_least_on_a_dense_line(trum60):
    target = 300000 * ARCSEC
    found = ts.robust(
        trum60,
        LOAD,
        objective="speed-error",
        spreads={"friction_coefficient": "10 %"},
        target_speed=target,
        bounds=HELD,
    )
    assert found.status == "solved"
    line = np.linspace(2800, 3300, 401)
    worst = np.max(
        [
            np.abs(
                ts.evaluate(
                    trum60.with_values({"friction_coefficient": mu}),
                    ts.Drive(frequency_difference=line, load_torque=0.05),
                ).mean_speed
                - target
            )
            for mu in (0.225, 0.25, 0.275)
        ],
        axis=0,
    )
    assert found.worst <= np.min(worst) * (1 + 1e-3)
    assert found.frequency_difference == pytest.approx(line[np.argmin(worst)], abs=2.0)
    ends = sorted(case.objective for case in found.cases)[-2:]
    assert ends[0] == pytest.approx(ends[1], rel=1e-5)  # the two worst cases are equally bad at the optimum
    assert found.worst_inside <= found.worst * (1 + 1e-6)


def test_a_robust_point_is_no_worse_than_the_nominal_optimum(trum60):
    target = 300000 * ARCSEC
    found = ts.robust(trum60, LOAD, spreads={"friction_coefficient": 0.1}, target_speed=target)
    assert found.status == "solved"
    assert found.cases[0].mean_speed == pytest.approx(target, rel=1e-8)
    assert found.worst <= found.worst_of_nominal_optimum * (1 + 1e-6)
    assert found.constraint_violation <= 1e-8
    for case in found.cases:
        motor = trum60.with_values(dict(case.changed))
        drive = ts.Drive(
            prepressure=found.prepressure, frequency_difference=found.frequency_difference, load_torque=0.05
        )
        assert ts.evaluate(motor, drive, tolerance=1e-9).mean_speed == pytest.approx(case.mean_speed, rel=1e-9)


def test_constraints_hold_in_every_sample(trum60):
    samples = [{"friction_coefficient": 0.23}, {"friction_coefficient": 0.27, "contact_radius": "27 mm"}]
    found = ts.robust(trum60, LOAD, samples=samples, constraints=["stall_torque >= 0.2 N*m"], bounds=HELD)
    assert found.status == "solved"
    assert all(case.stall_torque >= 0.2 * (1 - 1e-8) for case in found.cases)
    none = ts.robust(trum60, LOAD, samples=samples, constraints=["stall_torque >= 0.6 N*m"], bounds=HELD)
    assert none.status == "infeasible"
    assert np.isnan(none.worst)


# --- The console ----------------------------------------------------------------------------------

SLOW = ("--from", "500 arcsec/s", "--to", "50000 arcsec/s", "--points", "3", "--prepressure", "180")


def test_console_writes_tables(capsys, tmp_path):
    out = tmp_path / "table.h"
    assert console.main(["speed-table", *SLOW, "--load-torque", "0.05", "--out", str(out)]) == 0
    assert "linear interpolation" in capsys.readouterr().out
    assert "static inline int table_drive" in out.read_text()
    assert console.main(["speed-table", *SLOW, "--load-torque", "0.05", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["gaps"] == []


def test_console_says_no_where_the_box_has_no_such_speed(capsys, tmp_path):
    out = tmp_path / "table.csv"
    arguments = ["--from", "50", "--to", "60", "--points", "3", "--prepressure", "180", "--load-torque", "0.05"]
    assert console.main(["speed-table", *arguments, "--out", str(out)]) == 1
    assert "gap: " in capsys.readouterr().out
    assert not out.exists()


def test_console_reads_samples(capsys, tmp_path):
    path = tmp_path / "samples.csv"
    path.write_text("friction_coefficient,contact_radius [mm]\n0.24,26\n0.26,27\n")
    arguments = ["--samples", str(path), "--prepressure", "180", "--load-torque", "0.05", *AIM, "--json"]
    assert console.main(["robust", *arguments]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["cases"][1]["changed"] == {"friction_coefficient": 0.24, "contact_radius": 0.026}
    assert record["cases"][2]["changed"] == {"friction_coefficient": 0.26, "contact_radius": 0.027}


AIM = ("--objective", "volatility")
BAD = [
    (("speed-table", "--from", "0", "--to", "1"), ("--from: got 0", "> 0")),
    (("speed-table", "--from", "2", "--to", "1"), ("--from: got 2", "less than --to, 1")),
    (("speed-table", "--from", "1 mm", "--to", "1"), ("--from: got 1 mm", "rad/s")),
    (("speed-table", "--from", "nan", "--to", "1"), ("--from: got nan",)),
    (("speed-table", *SLOW, "--points", "1"), ("points: got 1", ">= 2")),
    (("speed-table", *SLOW, "--error", "0"), ("error: got 0", ">= 1e-06")),
    (("speed-table", *SLOW, "--out", "table.txt"), ("--out", ".csv or .h")),
    (("speed-table", *SLOW, "--periods", "10:20"), ("--periods: got 7 combinations", "one value of each")),
    (("speed-table", *SLOW, "--sampling-period", "-2 ms"), ("--sampling-period: got -2 ms", "> 0")),
    (("speed-table", *SLOW, "--load-torque", "0.1:0.2"), ("--load-torque: got a range", "one value in a study")),
    (("speed-table", *SLOW, "--phase-lead", "-1:1"), ("--periods: got 2 combinations", "one value of each")),
    (("speed-table", "--from", "1e-7", "--to", "1e-6", "--prepressure", "180"), ("--error: got 0.01", "at least")),
    (("pareto", "--objective", "ripple", "--points", "2"), ("points: got 2", ">= 3")),
    (("pareto", "--objective", "ripple", "--against", "speed-error"), ("--target-speed: got none", "speed-error")),
    (("pareto", "--objective", "ripple", "--against", "nonsense"), ("against: got nonsense", "no figure")),
    (("pareto", "--objective", "nonsense"), ("objective: got nonsense",)),
    (("robust", *AIM), ("--spread: got neither",)),
    (("robust", *AIM, "--spread", "voltage"), ("--spread voltage: got nothing", "states none")),
    (("robust", *AIM, "--spread", "friction_coefficient=2"), ("--spread friction_coefficient: got 2", "< 1")),
    (("robust", *AIM, "--spread", "friction_coefficient=0.3:0.4"), ("--spread friction_coefficient", "around 0.25")),
    (("robust", *AIM, "--spread", "crests=0.1"), ("--spread: got crests", "continuously")),
    (("robust", *AIM, "--spread", "prepressure=0.1"), ("--spread: got prepressure", "load_torque")),
    (("robust", *AIM, "--spread", "nonsense=0.1"), ("got nonsense", "motor file")),
    (("robust", *AIM, "--spread", "layer_stiffness=0.1"), ("--spread: got layer_stiffness", "set it first")),
    (("robust", *AIM, "--samples", "nowhere.csv"), ("nowhere.csv", "exists")),
    (
        ("robust", *AIM, "--spread", "friction_coefficient=0.1", "--objective", "speed-error"),
        ("--target-speed: got none",),
    ),
]


@pytest.mark.parametrize(("arguments", "naming"), BAD, ids=[" ".join(a) for a, _ in BAD])
def test_console_refuses_bad_studies(console_refuses, arguments, naming):
    console_refuses(*arguments, naming=naming)
