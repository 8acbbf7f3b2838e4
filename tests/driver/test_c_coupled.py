"""Coupled laps of the C library, one state after another, beside the Python package's, which has them in lanes."""

from __future__ import annotations

import json
import subprocess

import c_coverage
import numpy as np
import pytest
from c_coverage import ROOT

import trum_sym as ts
from trum_sym.c_library.sources import amalgamated, library
from trum_sym.model.coupled_orbit import STATE, lap_values, start_of
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels

POINTS = [  # rotor's mass, coverage, motor, drive, levels
    (0.02, 1.0, {}, {}, {}),
    (0.0, 1.0, {}, {"load_torque": 0.1, "frequency_difference": 1000.0}, {"compliance": "flange"}),
    (0.1, 4 / 9, {}, {"phase_lead": -1.0, "prepressure": 150.0}, {"amplitude": "forced", "resonance": "eq6"}),
    (0.02, 1.0, {"resonance_frequency": 39703.0}, {"periods": 4, "on_periods": 2}, {"foundation": "smeared"}),
    (0.0, 1.0, {"contact_stiffness": 2e9}, {"load_inertia": 2.7e-4, "switching_phase": 0.7, "load_torque": 1.5}, {}),
    (0.05, 1.0, {}, {"periods": 3, "on_periods": 3, "load_torque": 0.0}, {"resonance": "euler"}),
]


def build(folder, number, *flags):
    """The program; what ``flags`` say is of the driver alone."""
    includes = [f"-I{path}" for path in c_coverage.FOLDERS]
    kernels = map(str, sorted((ROOT / "generated").glob("trum_*.c")))
    subprocess.run(["cc", "-std=c99", "-O0", "-c", *number, *includes, *kernels], cwd=folder, check=True)
    driver = [*c_coverage.FLAGS, *number, *flags, *includes, str(ROOT / "tests" / "driver" / "c_coupled.c")]
    objects = map(str, sorted(folder.glob("*.o")))
    subprocess.run(["cc", *driver, *objects, "-lm", "-o", "coupled"], cwd=folder, check=True)
    return folder / "coupled"


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """Under both sanitizers."""
    sanitized = ["-O0", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    return build(tmp_path_factory.mktemp("coupled"), [], *sanitized)


@pytest.fixture(scope="module")
def single(tmp_path_factory):
    return build(tmp_path_factory.mktemp("single"), ["-DTRUM_REAL_BITS=32"], "-O0", "-Wdouble-promotion")


def numbers(found):
    return {name: float.fromhex(value) for name, value in found.items() if name != "of"}


def run(program, lines):
    done = subprocess.run([program], input="\n".join(lines) + "\n", capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return [json.loads(line) for line in done.stdout.splitlines()]


def told(point, more=()):
    mass, coverage, motor, drive, levels = point
    words = [f"{name}={value!r}" for name, value in {**motor, **drive}.items()]
    words += [f"{name}={value}" for name, value in levels.items()]
    return " ".join([repr(mass), repr(coverage), *words, *more])


def theirs(point, tolerance):
    mass, coverage, motor, drive, levels = point
    machine = ts.load_motor().with_values({**motor, "phase_coverage": coverage})
    return lap_values(machine, ts.Drive(**drive), Levels(**levels), rotor_mass=mass, tolerance=tolerance)


@pytest.mark.parametrize("point", POINTS)
def test_a_lap_depends_on_what_the_package_has_and_comes_to_the_same(program, point):
    """Steps are chosen by the same rule; only sines, roots and their order in sums differ by their last digits."""
    values = theirs(point, 1e-6) | {"tolerance": 1e-9}
    start = dict(zip(STATE, map(float, start_of("steady", values)), strict=True))
    more = [f"lap.{name}={value!r}" for name, value in {**start, "tolerance": 1e-9}.items()]
    (found,) = run(program, [told(point, more)])
    assert (found["status"], found["done"], found["alone"]) == (0, 1, 1)
    for name, value in numbers(found["in"]).items():
        assert value == pytest.approx({**values, **start}[name], rel=1e-11, abs=1e-25), name
    lap = call("coupled_slopes", {**values, **start})
    out, speed = numbers(found["out"]), values["size"] * values["omega_n0"]
    sizes = np.array([values["size"], speed] * 3 + [values["D"] * values["k_c"] * speed])
    for name, size in zip(STATE, sizes, strict=True):
        assert out[name] == pytest.approx(float(lap[name]), abs=1e-6 * size), name
    for name, size in (
        ("mean", sizes[6]),
        ("low", sizes[6]),
        ("high", sizes[6]),
        ("highest", sizes[0]),
        ("touching", 10),
    ):
        assert out[name] == pytest.approx(float(lap[name]), abs=1e-6 * size), name
    assert out["input"] == pytest.approx(float(lap["input"]), rel=1e-6)
    slopes = np.array([float.fromhex(value) for value in found["slopes"]]).reshape(8, 7)
    scale = np.append(sizes, sizes[6])[:, np.newaxis] / sizes
    assert np.abs((slopes - np.asarray(lap["slopes"])) / scale).max() < 5e-3


def test_a_float_keeps_a_lap_to_its_digits(single):
    """Of a rotor without a mass on the flange, whose laps a small disturbance does not change much."""
    point = POINTS[1]
    values = theirs(point, 1e-6) | {"tolerance": 1e-9}
    start = dict(zip(STATE, map(float, start_of("steady", values)), strict=True))
    more = [f"lap.{name}={value!r}" for name, value in {**start, "tolerance": 1e-5}.items()]
    (found,) = run(single, [told(point, more)])
    lap = call("coupled_lap", {**values, **start})
    out = numbers(found["out"])
    assert out["mean"] == pytest.approx(float(lap["mean"]), rel=1e-3)
    assert out["highest"] == pytest.approx(float(lap["highest"]), rel=1e-3)
    assert out["input"] == pytest.approx(float(lap["input"]), rel=1e-3)


@pytest.mark.parametrize(
    ("words", "field"),
    [
        ("0.02 1 start=steady", "start"),
        ("0.02 1 contact=hertz", "contact"),
        ("0.02 1 on_periods=20 tangential=brush", "tangential"),
        ("0.02 1 amplitude=5e-6", "amplitude"),
        ("0.02 1 friction_coefficient=0", "friction_coefficient"),
        ("0.02 1 damping_ratio=0", "damping_ratio"),
        ("0.02 1 prepressure=-1", "prepressure"),
        ("-1 1", ""),
        ("11 1", ""),
        ("0.02 0", ""),
        ("0.02 1.1", ""),
        ("nan 1", ""),
    ],
)
def test_what_the_coupled_system_does_not_know_is_refused(program, words, field):
    (found,) = run(program, [words])
    assert (found["status"], found["field"]) == (1, field)


def test_a_state_that_cannot_be_stepped_is_no_number(program):
    (found,) = run(program, ["0.02 1 lap.w_A=nan"])
    assert (found["status"], found["done"], found["alone"]) == (0, 0, 0)
    assert np.isnan(numbers(found["out"])["v"])


def test_without_the_word_there_is_no_trace_of_it(tmp_path):
    pair = amalgamated(library())
    for name, text in pair.items():
        (tmp_path / name).write_text(text)
    for flags, there in (([], False), (["-DTRUM_COUPLED"], True)):
        subprocess.run(["cc", "-std=c99", "-O0", *flags, "-c", "trum.c", "-o", "trum.o"], cwd=tmp_path, check=True)
        symbols = subprocess.run(["nm", "trum.o"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
        assert ("trum_coupled_lap" in symbols) is there
