"""The C library as a folder, in both types of number, bounded; and as a unit for simulation tools."""

from __future__ import annotations

import json
import shutil
import subprocess

import numpy as np
import pytest
from c_coverage import ROOT

import trum_sym as ts
from studies import metal
from trum_sym.c_library.export import exported
from trum_sym.c_library.sources import amalgamated, library
from trum_sym.console import main

TABLE_3 = -2.30366  # rad/s, with an error of 2e-5 of the largest speed, 17.2 rad/s, in double
STRICT = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-pedantic", "-Werror"]


def figures(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    return done, json.loads(done.stdout) if done.stdout else {}


@pytest.mark.parametrize(("real", "more"), [("double", ()), ("float", ("--amalgamated", "--fix-levels"))])
def test_the_folder_builds_and_its_example_prints_table_3(tmp_path, real, more):
    folder = tmp_path / "é library"
    assert main(["c-library", str(folder), "--real", real, *more]) == 0
    done = subprocess.run(["make", "-s", "CFLAGS=-O0"], cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    _, point = figures(folder / "example")
    assert point["converged"] is True
    assert point["mean_speed"] == pytest.approx(TABLE_3, abs=1e-3 * 17.2 if real == "float" else 1e-5)
    assert point["max_speed"] - point["min_speed"] == pytest.approx(30.182, abs=2e-3 * 17.2)
    done, _ = figures(folder / "example", "tolerance=1e-6")
    assert (done.returncode, "this build keeps 0.001 to 0.01" in done.stderr) == (
        (2, True) if real == "float" else (0, False)
    )
    done, _ = figures(folder / "example", "contact=hertz")
    assert done.returncode == (2 if more else 0)
    assert ("contact is outside its domain" in done.stderr) == bool(more)


def test_the_example_computes_the_motor_and_the_drive_that_were_asked_for(tmp_path):
    options = ("--load-torque", "0.05", "--start", "rest", "--set", "contact_radius=27 mm")
    assert main(["c-library", str(tmp_path / "a"), "--amalgamated", *options]) == 0
    subprocess.run(["make", "-s", "CFLAGS=-O0"], cwd=tmp_path / "a", check=True)
    motor = ts.load_motor().with_values({"contact_radius": 0.027})
    theirs = ts.evaluate(motor, ts.Drive(load_torque=0.05, start="rest"), tolerance=1e-6)
    _, ours = figures(tmp_path / "a" / "example")
    assert ours["start"] == "rest"
    assert ours["mean_speed"] == pytest.approx(float(theirs.mean_speed), abs=2e-6 * abs(float(theirs.max_speed)))


def test_a_folder_with_something_in_it_is_left_alone(tmp_path, capsys):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    assert main(["c-library", str(tmp_path / "mine")]) == 2
    assert "DIR: got" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["notes.txt"]
    assert main(["c-library", str(tmp_path / "mine"), "--force"]) == 0
    assert {"notes.txt", "Makefile", "motor.h", "trum"} <= {path.name for path in (tmp_path / "mine").iterdir()}
    assert main(["c-library", str(tmp_path / "mine" / "notes.txt")]) == 2
    assert main(["c-library", str(tmp_path / "nowhere" / "a")]) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine"]


def test_one_pair_holds_every_kernel_and_includes_nothing_else():
    pair = amalgamated(library())
    assert set(pair) == {"trum.h", "trum.c"}
    for name in json.loads((ROOT / "generated" / "manifest.json").read_text())["kernels"]:
        assert pair["trum.c"].count(f"int {name['name']}(const trum_real** arg") == 1
    quoted = [line for text in pair.values() for line in text.splitlines() if line.startswith('#include "')]
    assert quoted == ['#include "trum.h"']


def compiled(flags, text):
    command = ["cc", *STRICT, *flags, f"-I{ROOT / 'generated'}", f"-I{ROOT / 'trum_sym' / '_driver'}", "-fsyntax-only"]
    return subprocess.run([*command, "-x", "c", "-"], input=text, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (["-DTRUM_REAL_BITS=16"], "TRUM_REAL_BITS has to be 64 or 32"),
        (["-Dcasadi_real=float"], "not by casadi_real"),
        (["-U__DBL_MANT_DIG__", "-D__DBL_MANT_DIG__=24"], "compile all files with -DTRUM_REAL_BITS=32"),
    ],
)
def test_a_type_that_cannot_be_kept_is_refused(flags, said):
    done = compiled(flags, '#define TRUM_IMPLEMENTATION\n#include "trum.h"\n')
    assert done.returncode != 0
    assert said in done.stderr
    assert compiled([], '#define TRUM_IMPLEMENTATION\n#include "trum.h"\n').returncode == 0


def test_a_folder_made_for_one_type_refuses_the_other(tmp_path):
    files = exported(ts.load_motor(), ts.Drive(), {}, real="float", single=True)
    (tmp_path / "trum.h").write_text(files["trum.h"])
    for bits, good in (("64", False), ("32", True)):
        done = subprocess.run(
            ["cc", "-fsyntax-only", f"-DTRUM_REAL_BITS={bits}", tmp_path / "trum.h"], capture_output=True, text=True
        )
        assert (done.returncode == 0) == good
        assert good or "made for TRUM_REAL_BITS 32" in done.stderr


def test_double_under_the_name_of_float_is_refused_or_right():
    assert metal.narrow(6) == []


BOUNDED = """
#include <stdio.h>
#include "trum.h"
#include "motor.h"
int main(void) {
  long n;
  for (n = 0; n < 12000; n = n * 2 + 1) {
    struct trum_drive d = my_drive;
    struct trum_point p;
    trum_real v[3], a[3];
    int s;
    d.max_steps = (int_least32_t)n, d.tolerance = 1e-3;
    s = (int)trum_evaluate(&my_motor, &d, &p);
    printf("%ld %d %ld %g\\n", n, s, (long)p.steps, p.q_average);
    d.max_steps = p.steps;
    s = (int)trum_simulate(&my_motor, &d, &p, v, a, 3);
    if (n == 0) printf("simulate %d %d\\n", s, v[2] != v[2]);
  }
  return 0;
}
"""


def test_a_call_returns_within_its_steps(tmp_path):
    files = exported(ts.load_motor(), ts.Drive(), {}, single=True)
    for name in ("trum.h", "trum.c", "motor.h"):
        (tmp_path / name).write_text(files[name])
    (tmp_path / "main.c").write_text(BOUNDED)
    subprocess.run(["cc", *STRICT[:2], "main.c", "trum.c", "-lm", "-o", "main"], cwd=tmp_path, check=True)
    lines = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout.splitlines()
    assert lines[1] == "simulate 7 1"  # what the orbit took leaves no step for the history
    free, *bounded = ([float(x) for x in line.split()] for line in lines if "simulate" not in line)
    assert free[1] == 0
    for allowed, status, steps, q_average in bounded:
        assert steps <= allowed
        assert status == (0 if allowed >= free[2] else 7)
        assert q_average == free[3]
    assert {row[1] for row in bounded} == {0, 7}


def test_objects_hold_no_globals_no_heap_and_no_function_calls_itself(monkeypatch):
    monkeypatch.setattr(metal, "MACHINES", {})
    assert metal.clean(0) == []


def test_a_function_that_calls_itself_would_be_found(monkeypatch):
    calls = {"trum_evaluate": {"step", "__indirect_call"}, "step": set(), "__indirect_call": {"curve"}, "curve": set()}
    monkeypatch.setattr(metal, "frames", lambda *_: ({"trum_evaluate": 8, "step": 4, "curve": 16}, calls))
    assert metal.deepest(ROOT, metal.PC) == 24
    calls["curve"] = {"trum_evaluate"}
    with pytest.raises(RecursionError, match="can call itself"):
        metal.deepest(ROOT, metal.PC)


def test_figures_beyond_their_errors_would_be_found():
    own = metal.kept(2)
    assert metal.compared(own[0], own[0]) == []
    off = {**own[0], "mean_speed": own[0]["mean_speed"] + 1e-2, "q_average": own[0]["q_average"] * 1.01}
    assert [text.split()[0] for text in metal.compared(off, own[0])] == ["q_average", "q_volatility", "mean_speed"]


def test_the_points_of_every_machine_are_what_the_package_says():
    for point in metal.kept(12):
        words = {"start": ("periodic", "steady", "rest")[int(point["start"])]}
        drive = ts.Drive(
            **{n: point[n] for n in metal.NUMBERS[:5]},
            phase_lead=int(point["phase_lead"]),
            **words,
        )
        found = ts.evaluate(drive=drive, tolerance=1e-7, contact=("winkler", "hertz")[int(point["contact"])])
        for name in ("mean_speed", "min_speed", "max_speed"):
            allowed = point[f"{name}_error"] + float(getattr(found, f"{name}_error")) + 1e-8 * abs(point[name])
            assert float(getattr(found, name)) == pytest.approx(point[name], rel=0, abs=allowed)


@pytest.mark.skipif(
    not shutil.which("arm-none-eabi-gcc") or not shutil.which("qemu-system-arm"), reason="no Cortex-M here"
)
def test_a_point_on_an_emulated_cortex_m_is_within_its_errors(monkeypatch):
    monkeypatch.setattr(metal, "MACHINES", dict(list(metal.MACHINES.items())[:1]))
    assert metal.on_machines(1) == []


# --- FMI ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ünit")
    assert main(["fmu", str(folder / "motor.fmu"), "--load-torque", "0.05"]) == 0
    return folder / "motor.fmu"


def simulated(unit, stop, step, start_values=None, **more):
    fmpy = pytest.importorskip("fmpy")
    return fmpy.simulate_fmu(
        str(unit), start_time=0, stop_time=stop, output_interval=step, start_values=start_values or {}, **more
    )


def test_the_unit_is_valid_and_gives_the_same_bits_under_both_versions_of_the_standard(unit, tmp_path):
    validation = pytest.importorskip("fmpy.validation")
    assert validation.validate_fmu(str(unit)) == []
    older = tmp_path / "motor.fmu"
    assert main(["fmu", str(older), "--load-torque", "0.05", "--fmi", "2"]) == 0
    assert validation.validate_fmu(str(older)) == []
    values = {"prepressure": 177.0, "settled": False, "encoder_counts": 4096}
    new, old = (simulated(each, 2e-3, 1e-5, values) for each in (unit, older))
    assert len(new) > 100
    for name in new.dtype.names:
        assert np.array_equal(new[name], old[name]), name


def test_the_unit_follows_simulate_and_starts_up_as_an_integration_does():
    pytest.importorskip("fmpy")
    from studies import unit as study

    orbits, starts = study.study(4, seed=240)
    assert orbits[:, 0].max() < 4e-6
    assert orbits[:, 1].max() < 1e-6
    assert starts.size
    assert starts.max() < 4e-6


def test_the_unit_counts_its_encoder_and_is_told_apart_from_a_start_at_rest(unit):
    pytest.importorskip("fmpy")
    cycle = 20 / 42043.4937
    free = simulated(unit, 2 * cycle, cycle / 64, {"settled": False, "start_speed": 0.0})
    orbit = simulated(unit, 2 * cycle, cycle / 64)
    assert free["speed"][0] == 0
    assert abs(free["speed"][2] - orbit["speed"][2]) > 1e-2 * float(np.abs(orbit["speed"]).max())
    assert orbit["encoder"][-1] == np.floor(orbit["angle"][-1] / (2 * np.pi) * 2097152)


def test_the_unit_refuses_input_outside_its_domain(unit):
    said = []
    with pytest.raises(Exception, match="fmi3"):
        simulated(unit, 1e-3, 1e-4, {"prepressure": -1.0}, logger=lambda *words: said.append(str(words)))
    assert any("prepressure" in words for words in said)
    with pytest.raises(Exception, match="fmi3"):
        simulated(unit, 1e-3, 1e-4, {"encoder_counts": 0})


def test_a_unit_with_a_string_is_refused(console_refuses, tmp_path):
    words = ("fmu", str(tmp_path / "a.fmu"), "--load", "weight", "--load-radius", "0.03")
    assert "torque" in console_refuses(*words, naming=())
    assert list(tmp_path.iterdir()) == []
