"""The C library on its own: clean, the figures of the Python package, error codes, no finding of the sanitizers."""

from __future__ import annotations

import json
import shutil
import subprocess
import warnings

import c_coverage
import mpmath as mp
import numpy as np
import pytest
from c_coverage import ROOT
from test_generated import exact_outputs, kernels, random_arguments

import trum_sym as ts
from trum_sym.console import main
from trum_sym.inputs.motor import UNCOUPLED
from trum_sym.model.kernels import call
from trum_sym.quantities import ERRORS

SPEEDS = ("mean_speed", "min_speed", "max_speed")
ORBIT = (*SPEEDS, "speed_volatility", "stall_torque", "contact_fraction", *ERRORS)
DRIVES = [
    "",
    "load_torque=0.05",
    "load_torque=0.05 start=rest phase_lead=-1 switching_phase=0.7",
    "load_torque=-0.02 start=steady contact=hertz frequency_difference=-2500 prepressure=160",
    "load_torque=0.05 resonance=eq6 foundation=smeared periods=31 on_periods=17",
    "load_torque=0.05 resonance=printed foundation=printed",
    "load_torque=0.05 resonance=euler foundation=none amplitude=forced",
    "load_torque=0.1 contact=hertz amplitude=forced",
    "load_torque=0.05 resonance_frequency=39703 damping_ratio=0.008 rotor_inertia=1e-3",
    "on_periods=20 load_torque=0.1",
    "load_torque=0.05 compliance=flange",
    "on_periods=20 load_torque=0.3 contact_stiffness=2e9 amplitude=forced frequency_difference=500",
    "on_periods=20 load_torque=-0.3 phase_lead=-1 compliance=flange tangential=brush flange_thickness=1.4e-3",
    "load_torque=2",
    "on_periods=20 load_torque=0.1 tangential=brush prepressure=5000",  # the whole wave touches
    "load_inertia=1e-3 start=rest phase_lead=-1",
    "load=weight load_radius=0.03 load_inertia=5e-3 start=rest phase_lead=-1",
]


def make(folder, target, *variables):
    makefile = ROOT / "examples" / "c" / "Makefile"
    return subprocess.run(
        ["make", "-s", "-f", str(makefile), f"ROOT={ROOT}", *variables, target],
        cwd=folder,
        capture_output=True,
        text=True,
    )


def built(tmp_path_factory, target):
    folder = tmp_path_factory.mktemp("c")
    done = make(folder, target)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / target


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    return built(tmp_path_factory, "trum")


@pytest.fixture(scope="module")
def single(tmp_path_factory):
    return built(tmp_path_factory, "trum-float")


@pytest.fixture(scope="module")
def harness(tmp_path_factory):
    """The harness of the coverage run, under both sanitizers."""
    return c_coverage.build(
        tmp_path_factory.mktemp("sanitized"), ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    )


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def figures(program, *arguments):
    done = run(program, *arguments)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def python(arguments, tolerance):
    """What the package says for the example's arguments."""
    levels, drive, motor = {}, {}, {}
    for argument in arguments:
        name, value = argument.split("=")
        if name in ("contact", "resonance", "foundation", "compliance", "tangential") or value == "forced":
            levels[name] = value
        elif name in ("start", "load"):
            drive[name] = value
        else:
            (drive if name in ts.Drive().numbers() else motor)[name] = float(value)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        point = ts.evaluate(
            ts.load_motor().with_values(motor), ts.Drive(**drive), tolerance=tolerance, **levels
        ).figures
    point.pop("method")  # in C steps are always adaptive
    return {k: None if isinstance(v, float) and not np.isfinite(v) else v for k, v in point.items()}


def test_table_3_has_the_keys_of_the_console_and_its_figures(example, capsys):
    ours = figures(example)
    assert main(["evaluate", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    theirs = {name: record[name] for name in ours}
    assert list(ours) == list(python([], 1e-6))
    for name, value in theirs.items():
        if name not in ORBIT:
            assert ours[name] == (value if isinstance(value, str) else pytest.approx(value, rel=1e-12)), name


@pytest.mark.parametrize("arguments", DRIVES)
def test_every_figure_is_that_of_the_package(example, arguments):
    arguments = arguments.split()
    ours, theirs = figures(example, "tolerance=1e-9", *arguments), python(arguments, 1e-9)
    assert list(ours) == list(theirs)
    largest = max(abs(theirs[name] or 0.0) for name in SPEEDS)
    for name, value in theirs.items():
        if isinstance(value, str | bool) or value is None:
            assert ours[name] == value, name
        elif name in ERRORS:  # bounds that follow the steps, which rounding may choose otherwise
            assert value / 30 - 1e-12 * largest <= ours[name] <= 30 * value + 1e-12 * largest, name
        elif name in SPEEDS:
            assert ours[name] == pytest.approx(value, rel=0, abs=1e-9 * largest), name
        else:  # a held rotor's contact is found to the tolerance, by steps that rounding may choose otherwise
            assert ours[name] == pytest.approx(value, rel=1e-6 if name in ORBIT else 1e-12), name


def test_a_history_ends_where_the_orbit_began_and_means_its_mean(harness):
    done = subprocess.run(
        [harness], input="simulate 2000 load_torque=0.05 tolerance=1e-6\n", text=True, capture_output=True
    )
    status, *numbers = done.stdout.split()
    speed, angle = np.array(numbers, float).reshape(-1, 2).T
    point = python(["load_torque=0.05"], 1e-6)
    assert (done.returncode, status) == (0, "0")
    assert angle[-1] / point["cycle_time"] == pytest.approx(point["mean_speed"], rel=1e-4)
    assert speed.max() == pytest.approx(point["max_speed"], rel=1e-3)
    assert np.diff(angle, prepend=0.0) / point["cycle_time"] * 2000 == pytest.approx(speed, abs=0.2)


def test_scalar_kernels_agree_with_their_expressions_at_50_digits(harness):
    """The arguments of the coverage run, and random ones of every kernel.

    A kernel of derivatives gives the bits of the package's, which ``test_generated`` compares with 50 digits.
    """
    rng = np.random.default_rng(3)
    by_name = kernels()
    lines = c_coverage.friction()
    for kernel in by_name.values():
        for _ in range(3):
            lines.append(" ".join(["kernel", kernel.name, *map(repr, random_arguments(kernel, rng).values())]))
    done = subprocess.run([harness], input="\n".join(lines) + "\n", text=True, capture_output=True, check=True)
    functions = {name: exact_outputs(kernel) for name, kernel in by_name.items()}
    answers = done.stdout.splitlines()
    assert len(answers) == len(lines)
    for line, answer in zip(lines, answers, strict=True):
        _, name, *numbers = line.split()
        kernel = by_name[name]
        if kernel.along:
            arguments = {symbol.name: float(x) for symbol, x in zip(kernel.inputs, numbers, strict=True)}
            assert [float.fromhex(x) for x in answer.split()] == list(call(name, arguments).values()), line
            continue
        with mp.workdps(50):
            values = {out: f(*(mp.mpf(float(x)) for x in numbers)) for out, f in functions[name].items()}
            for (out, value), ours in zip(values.items(), answer.split(), strict=True):
                size = max(abs(v) for other, v in values.items() if kernel.units[other] == kernel.units[out])
                assert abs(float.fromhex(ours) - value) <= 1e-12 * size, (line, out)


def test_a_string_that_friction_could_make_slack_is_said(example):
    """Unless rotor and plate weigh at least mu F_c r_c r/g = 3.648e-3 kg m^2, 0.25 * 180 * 0.0265 * 0.03 / 9.80665."""
    hung = ("load=weight", "load_radius=0.03", "load_torque=0.05")
    for plate, said in (("3.643e-3", "friction could make the string go slack"), ("3.644e-3", "")):
        assert figures(example, *hung, f"load_inertia={plate}")["reason"] == said


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ("prepressure=nan", "prepressure"),
        ("radius=inf", "radius"),
        ("prepressure=0", "prepressure"),
        ("rotor_inertia=-1", "rotor_inertia"),
        ("load_inertia=-1", "load_inertia"),
        ("load=weight", "load_radius"),
        ("load_radius=0.03", "load_radius"),
        ("periods=20.5", "periods"),
        ("on_periods=9", "on_periods"),
        ("phase_lead=0", "phase_lead"),
        ("tooth_height=5e-3", "tooth_height"),
        ("frequency_difference=-36000", "frequency_difference"),
        ("tolerance=1e-12", "tolerance"),
        ("start=never", "start=never"),
        ("mass=1", "mass=1"),
        ("beam_density=1e300", "no finite size"),
    ],
)
def test_bad_input_is_one_line_that_names_the_field(example, argument, words):
    done = run(example, argument)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("trum: ")
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_the_c_library_refuses_what_the_package_refuses(example):
    for line in (
        *c_coverage.edges(),
        *(f"{name}={value}" for name in UNCOUPLED for value in ("-1", "0", "1e309")),
    ):
        arguments = line.split()
        numbers = [a for a in arguments if a.count("=") == 1 and a.split("=")[1] and "tolerance" not in a]
        if len(numbers) < len(arguments) or not numbers or "nothing" in line or "forced" in line:
            continue
        if any(a.startswith("max_steps=") for a in arguments):
            continue  # the package has no such bound
        optional = [name for name, spec in UNCOUPLED.items() if not spec.required]
        if any(f"{name}=0" == a for name in optional for a in arguments):
            continue  # in C, 0 stands for not measured
        try:
            python(arguments, 1e-2)
            refused = False
        except ts.ParameterError:
            refused = True
        assert (run(example, "tolerance=1e-2", *arguments).returncode == 2) == refused, line


@pytest.mark.parametrize("every", [3, pytest.param(1, marks=pytest.mark.slow)])
def test_sanitizers_find_nothing_on_any_level_edge_or_hostile_input(harness, every):
    lines = [line for line in c_coverage.script().splitlines() if "tolerance=" not in line]
    lines = [line for k, line in enumerate(lines) if k % every == 0 or not line.startswith("point ")]
    done = subprocess.run([harness], input="\n".join(lines) + "\n", text=True, capture_output=True)
    assert "Sanitizer" not in done.stderr
    assert "runtime error" not in done.stderr
    assert "wrong:" not in done.stderr
    assert done.returncode == 0


FAULTS = ("int a[2] = {0}; return a[count + 1];", "return 2147483645 + count;")


@pytest.fixture(scope="module")
def sanitized(tmp_path_factory):
    """The example made by ``make sanitize``, with a fault where it has one argument, and another where it has two."""
    copy = tmp_path_factory.mktemp("faulty") / "c"
    shutil.copytree(ROOT / "examples" / "c", copy)
    path, call = copy / "main.c", "  status = trum_evaluate"
    faults = "".join(f"  if (count == {k}) {{ {fault} }}\n" for k, fault in enumerate(FAULTS, 2))
    path.write_text(path.read_text().replace(call, f"{faults}{call}", 1))
    command = ["make", "-s", "sanitize", f"ROOT={ROOT}", "CFLAGS=-O0"]
    return copy / "trum-sanitized", subprocess.run(command, cwd=copy, capture_output=True, text=True)


def test_sanitized_example_runs(sanitized):
    _, done = sanitized
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["converged"] is True


@pytest.mark.parametrize("count", [1, 2])
def test_the_sanitizers_would_find_a_fault(sanitized, count):
    done = run(sanitized[0], *["load_torque=0.1"] * count)
    assert done.returncode != 0
    assert "runtime error" in done.stderr or "Sanitizer" in done.stderr


def test_the_library_holds_no_globals_and_does_not_allocate(tmp_path):
    """Only constants in its objects' data, and no symbol of the heap or of standard streams."""
    source = tmp_path / "library.c"
    source.write_text('#define TRUM_IMPLEMENTATION\n#include "trum.h"\n')
    sources = [source, *sorted((ROOT / "generated").glob("trum_*.c"))]
    includes = [f"-I{path}" for path in c_coverage.FOLDERS]
    subprocess.run(["cc", *c_coverage.FLAGS, "-fno-pie", "-c", *includes, *map(str, sources)], cwd=tmp_path, check=True)
    for built_file in sorted(tmp_path.glob("*.o")):
        symbols = subprocess.run(["nm", built_file], capture_output=True, text=True, check=True).stdout
        for line in symbols.splitlines():
            kind, name = line.split()[-2:]
            assert kind not in "bBdDC", (built_file.name, line)
            assert name not in {"malloc", "calloc", "realloc", "free", "printf", "stdout", "errno"}


def test_the_headers_are_c_plus_plus_as_well(tmp_path):
    source = tmp_path / "library.cpp"
    source.write_text('#define TRUM_IMPLEMENTATION\n#include "trum.h"\n#include "trum60.h"\n')
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-Wno-unused-variable"]
    includes = [f"-I{path}" for path in c_coverage.FOLDERS]
    subprocess.run(["c++", *flags, "-c", *includes, str(source)], cwd=tmp_path, check=True)


def test_single_precision_holds_its_tolerance(single):
    """Largest errors seen: 2.3e-5 of a figure of the determinant, 4e-4 of the largest speed."""
    for line in DRIVES[:4] + DRIVES[7:10]:
        arguments = line.split()
        ours, theirs = figures(single, "tolerance=1e-3", *arguments), python(arguments, 1e-6)
        assert ours["converged"] is True
        largest = max(abs(theirs[name]) for name in SPEEDS)
        for name, value in theirs.items():
            if isinstance(value, float) and name not in ORBIT:
                assert ours[name] == pytest.approx(value, rel=1e-4), name
            elif name in SPEEDS:
                assert ours[name] == pytest.approx(value, rel=0, abs=1e-3 * largest), name


def test_single_precision_refuses_a_finer_tolerance(single):
    done = run(single, "tolerance=1e-4")
    assert done.returncode == 2
    assert "tolerance" in done.stderr


def test_trum60_is_table_1(example):
    """Setting what Table 1 prints, converted by hand, changes nothing."""
    table_1 = (
        "rotor_inertia=4.5e-6 radius=0.03 layer_young_modulus=5e9 perimeter=0.1884 damping_ratio=0.006 voltage=200"
    )
    assert figures(example, *table_1.split()) == figures(example)
