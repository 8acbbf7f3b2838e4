"""generated/ computes what the derivations say, at 50 digits, and is refused where it is not what they give.

That it is so byte for byte, ``python -m derivations generate --check`` says, which ``.ci/run`` runs.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.model.kernels import SLOPE_FIGURES, SLOPE_PARAMETERS, call, expect, signature

sp = lazily("sympy")
command = lazily("derivations.__main__")
driver = lazily("derivations.codegen.driver")
emit = lazily("derivations.codegen.emit")
nomenclature = lazily("derivations.nomenclature")
proofs = lazily("derivations.proofs")
page = lazily("derivations.proofs.page")
mutants = lazily("derivations.proofs.mutants")
tables = lazily("derivations.proofs.tables")
ledger = lazily("derivations.ledger")

ROOT = Path(__file__).parents[2]
GENERATED = ROOT / "generated"
NAMES = [entry["name"] for entry in json.loads((GENERATED / "manifest.json").read_text("utf-8"))["kernels"]]
DERIVATIVES = ["trum_start_periodic_slopes", "trum_start_rest_slopes", "trum_regions_slopes", "trum_wave_slopes"]


def kernels():
    from derivations.codegen.kernels import kernels

    return {kernel.name: kernel for kernel in kernels()}


def generate(folder, *arguments, seed="0"):
    return subprocess.run(
        [sys.executable, "-m", "derivations", "generate", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONHASHSEED": seed},
        capture_output=True,
        text=True,
    )


def copied(folder, *names):
    for name in names:
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


@pytest.fixture(scope="module")
def files():
    """What is checked in; .ci/run compares it with what the derivations give now."""
    ours = (path for path in GENERATED.iterdir() if not path.name.startswith("ledger."))
    return {path.name: path.read_bytes().decode() for path in ours}


def test_one_kernel_is_one_file_of_its_name(files):
    names = list(kernels())
    assert {name for name in files if name.endswith(".c")} == {f"{name}.c" for name in names}
    assert [entry["name"] for entry in json.loads(files["manifest.json"])["kernels"]] == names


def test_every_file_states_its_operations_and_arguments(files):
    manifest = json.loads(files["manifest.json"])
    for entry in manifest["kernels"]:
        text = files[f"{entry['name']}.c"]
        assert f"{sum(entry['operations'].values())} operations" in text
        for argument in entry["inputs"]:
            assert f": {argument['name']} [{argument['unit']}]" in text


@pytest.fixture
def tree(tmp_path):
    """A copy of the derivations and what they generated, free to be broken."""
    return copied(tmp_path, "derivations", "generated")


@pytest.mark.slow
def test_generation_does_not_depend_on_the_hash_seed(tree, files):
    shutil.rmtree(tree / "generated")
    assert generate(tree, seed="4242").returncode == 0
    assert files == {path.name: path.read_bytes().decode() for path in (tree / "generated").iterdir()}


@pytest.mark.slow  # .ci/run runs that very command
def test_check_is_silent_and_0_when_nothing_is_stale(tree):
    done = generate(tree, "--check")
    assert (done.returncode, done.stderr) == (0, "")


def test_a_changed_title_is_stale_and_changes_nothing(files, monkeypatch, capsys):
    (title,) = {kernel.title for kernel in kernels().values() if kernel.name == "trum_wavenumber"}
    changed = {name: text.replace(title, "Wavenumber") for name, text in files.items()}
    assert changed != files
    monkeypatch.setattr("derivations.__main__.render", lambda: changed)
    for module in ("__main__", "error_bound", "fixed_grid"):  # proofs of what is not changed here
        monkeypatch.setattr(f"derivations.{module}.prove", lambda *_: None)
    before = {path.name: path.read_bytes() for path in GENERATED.iterdir()}
    assert command.main(["generate", "--check"]) == 1
    out, err = capsys.readouterr()
    assert "(checked in)" in out
    assert "stale" in err
    assert before == {path.name: path.read_bytes() for path in GENERATED.iterdir()}


@pytest.mark.parametrize(
    ("module", "right", "wrong"),
    [
        pytest.param("phases.py", "(omega_n * a + xi * b)", "(omega_n * a - xi * b)", marks=pytest.mark.slow),
        pytest.param(
            "phases.py",
            "return omega_n + Delta_omega",
            "return omega_n - Delta_omega",
            marks=pytest.mark.slow,
        ),
        ("beam.py", "theta.diff(x) ** 2 + kappa", "theta.diff(x) ** 3 + kappa"),
    ],
)
def test_a_broken_proof_or_dimension_stops_the_generation(tree, module, right, wrong):
    path = tree / "derivations" / module
    text = path.read_text()
    assert right in text
    path.write_text(text.replace(right, wrong, 1))
    assert generate(tree, "--check").returncode != 0


def test_a_kernel_or_table_without_a_proof_is_refused_by_name(files):
    (kernel,) = (k for k in kernels().values() if k.name == "trum_displacement")
    more = replace(kernel, outputs={**kernel.outputs, "w": kernel.outputs["zeta_z"]}, units={**kernel.units, "w": "m"})
    with pytest.raises(ArithmeticError, match=r"trum_displacement\.w has no proof"):
        proofs.prove([*(k for k in kernels().values() if k != kernel), more], files)
    table = files["trum_quadrature.h"] + "#define TRUM_NEW_TABLE {1.0, 2.0}\n"
    with pytest.raises(ArithmeticError, match="TRUM_NEW_TABLE has no proof"):
        proofs.prove(kernels().values(), {**files, "trum_quadrature.h": table})


@pytest.mark.parametrize(
    ("right", "slip", "name"),
    [
        ("0.97777777777777777778", "0.97777777777777787778", "TRUM_RUNGE_KUTTA_WITHIN"),  # 44/45 in stage 4
        ("TRUM_C(0.80000000000000000000)", "TRUM_C(0.75)", "TRUM_RUNGE_KUTTA_NODES"),
        ("-0.025000000000000000000", "0.025", "TRUM_RUNGE_KUTTA_ERROR"),
    ],
)
def test_a_slip_in_the_rule_of_time_steps_is_refused(files, right, slip, name):
    text = files["trum_runge_kutta.h"]
    table = next(table for table in tables.TABLES if table.name == name)
    assert tables.wrong(table, tables.read(text)) == ""
    assert right in text
    assert "is off" in tables.wrong(table, tables.read(text.replace(right, slip)))


def test_the_table_of_proofs_in_the_docs_is_made_anew():
    text = (ROOT / "docs" / "proofs.md").read_text("utf-8")
    assert page.filled(text) == text
    for entry in page.rests_on():
        assert ledger.entry(entry)


@pytest.mark.parametrize("name", ["trum_wave", "trum_peak_pressure", "trum_contact_limit", "trum_measures"])
def test_no_slip_in_a_kernel_survives_its_proof(name):
    found = list(mutants.kernel_mutants(kernels()[name]))
    assert found
    assert [slip for slip in found if not slip.rejected and not slip.equivalent] == []


def test_slips_survive_a_proof_that_is_too_lenient(monkeypatch):
    lenient = tuple(replace(proof, tolerance=3.0) for proof in proofs.of_kernel("trum_peak_pressure"))
    monkeypatch.setattr("derivations.proofs.mutants.of_kernel", lambda _: lenient)
    found = list(mutants.kernel_mutants(kernels()["trum_peak_pressure"]))
    assert [slip for slip in found if not slip.rejected and not slip.equivalent]


# What the ledger alone did not see: in kernels of the rotor, and in its time steps' rule
SLIPS = (
    ("rotor", "net = 2 * (shares[0] - shares[1]) - 1", "net = 2 * (shares[0] - shares[1]) + 1", "trum_friction: f "),
    ("rotor", 'q = velocity["A"] * w["B"] - ', 'q = velocity["A"] * w["B"] + ', "trum_wave: "),
    ("rotor", "u = phi + sign * alpha", "u = phi - sign * alpha", "trum_friction: "),
    ("collocation", "(1 + root) / 2)", "(1 + root**3) / 2)", "TRUM_COLLOCATION_POINTS is off"),
    ("contact", "sp.cos(_u) - sp.cos(theta)", "sp.cos(_u) + sp.cos(theta)", "trum_winkler_balance: "),
    ("section", "1 - k_t * k_s", "1 + k_t * k_s", "trum_section: "),
)


@pytest.mark.slow  # .ci/run runs it
def test_slips_in_the_source_are_refused_by_a_proof():
    edits = [part for module, old, new, _ in SLIPS for part in ("--edit", module, old, new)]
    done = subprocess.run(
        [sys.executable, "-m", "derivations.source_mutants", *edits], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line for line in done.stdout.splitlines() if line.startswith("[")]
    for line, (*_, by) in zip(lines, SLIPS, strict=True):
        assert f": proof: {by}" in line


def test_missing_and_extra_files_are_stale(files, tmp_path):
    emit.write(files, tmp_path)
    assert emit.stale(files, tmp_path) == ""
    (tmp_path / "trum_regions.c").unlink()
    (tmp_path / "trum_old.c").write_text("int old;\n")
    assert "trum_regions.c" in emit.stale(files, tmp_path)
    assert "trum_old.c" in emit.stale(files, tmp_path)
    assert emit.write(files, tmp_path) == ["trum_regions.c", "trum_old.c"]
    assert emit.stale(files, tmp_path) == ""


def expm1_exact(z):
    return sp.exp(z) - 1


def random_arguments(kernel, rng):
    """Arguments around TRUM-60 and Table 3, each 20 % to either side."""
    usual = ts.load_motor().symbols()
    for name in ("trum_neutral_axis", "trum_section", "trum_wavenumber", "trum_layer_stiffness"):
        usual.update(call(name, usual))
    usual.update(
        k_f=3e8,
        k_dx=3e8,
        omega_n=2.45e5,
        omega_q=2.65e5,
        Delta_omega=1.9e4,
        beta=280.0,
        theta=0.4,
        W=5.5e-6,
        F_c=180.0,
        m=20,
        n=14,
        psi=0.7,
        s=-1,
        tau=8e-5,
        T=4.7e-4,
        a_A=3e-6,
        b_A=-0.7,
        a_B=-4e-6,
        b_B=0.5,
        g_A=1,
        g_B=0,
        J_load=1e-3,
        r_s=0.03,
        q_plus=80.0,
        q_minus=30.0,
        p_plus=3e6,
        p_minus=7e5,
        a=3e-6,
        b=-0.7,
        T_load=0.3,
        f_A_re=3e-6,
        f_A_im=-2e-6,
        f_B_re=-4e-6,
        f_B_im=1e-6,
        p_re=0.6,
        p_im=0.8,
        e_re=0.9,
        e_im=0.4,
        d_re=0.8,
        d_im=0.5,
        W_c=5e-6,
        engagement=40.0,
        engagement_per_height=1e7,
        W_full=4e-7,
        share=-38.0,
        fullness=0.008,
        fullness_root=0.2,
        sin_theta=0.39,
        phi=0.2,
        cos_phi=0.98,
        sin_phi=0.2,
        R_v=1.2,
        v=0.3,
        f=0.4,
        x=3.1e-3,
        x_max=3e-3,
        w_A=3e-6,
        w_B=-4e-6,
        R_v_rate=2e3,
        v_rate=-3e4,
        W_c_rate=-0.4,
        k_T=1.2e10,
        grip=5.0,
        ratio=0.5,
        t_0=0.3,
        u=0.1,
        u_0=-0.2,
        p_larger=1.4,
        p_smaller=1.1,
        step=2e-7,
        M_q=0.033,
        F_q=240.0,
        c_p=0.7,
        omega_n0=2.43e5,
        central=170.0,
        along=25.0,
        alpha=0.2,
        height=2.5e-6,
        v_A=0.7,
        v_B=-0.4,
        cos_theta=0.92,
        sin_crest=0.6,
        cos_crest=0.8,
        Theta_q=1.2,
        C_0=2.4e-8,
        lead=1.1,
        eta_m=0.2,
        leaving=1.9,
        free=2.8,
        u_in=1.4,
        u_out=-1.1,
        zone_low=-0.8,
        zone_high=0.9,
        across=-7.0,
        lossy=15.0,
        level=-0.4,
        sheared=0.3,
        sheared_cos=0.2,
        sheared_sin=0.1,
        sheared_ratio=-0.9,
    )
    for name, rate in (("a_A", 4e-11), ("b_A", 6e-6), ("a_B", -3e-11), ("b_B", 5e-6)):
        usual |= {f"{name}_omega_n": rate, f"{name}_Delta_omega": -2 * rate}
    for name in ("f_A_re", "f_A_im", "f_B_re", "f_B_im"):
        usual |= {f"{name}_omega_n": 4e-11, f"{name}_Delta_omega": -5e-11}
    whole = {"m", "n", "s", "g_A", "g_B", "n_s", "n_j"}
    return {
        symbol.name: float(usual[symbol.name]) * (1.0 if symbol.name in whole else rng.uniform(0.8, 1.2))
        for symbol in kernel.inputs
    }


def exact_outputs(kernel):
    """The outputs' expressions as functions of 50-digit numbers."""
    constants = {symbol: sp.Float(value, 60) for symbol, value in nomenclature.CONSTANTS.items()}
    return {
        output: sp.lambdify(
            list(kernel.inputs),
            sp.sympify(expr).subs(constants).replace(sp.Function("expm1"), expm1_exact),
            [{"less": lambda x, y: mp.mpf(x < y)}, "mpmath"],
        )
        for output, expr in kernel.outputs.items()
    }


@pytest.mark.parametrize("name", DERIVATIVES)
def test_compiled_slopes_are_derivatives_at_50_digits(name):
    """CasADi's derivative in double precision beside a difference quotient of the SymPy expression."""
    kernel = kernels()[name]
    assert kernel.along
    rng, names = np.random.default_rng(17), list(kernel.inputs)
    exact, step = exact_outputs(kernel), mp.mpf(10) ** -20
    for _ in range(3):
        arguments = random_arguments(kernel, rng)
        ours = call(kernel.name, arguments)
        with mp.workdps(60):
            point = [mp.mpf(arguments[s.name]) for s in names]
            for direction, rates in kernel.along.items():
                rate = [
                    sp.lambdify(names, sp.sympify(rates.get(symbol, sp.Integer(0))), "mpmath")(*point)
                    for symbol in names
                ]
                ahead, behind = ([x + e * step * r for x, r in zip(point, rate, strict=True)] for e in (1, -1))
                slopes = {name: (f(*ahead) - f(*behind)) / (2 * step) for name, f in exact.items()}
                for name, value in slopes.items():
                    size = max(abs(v) for other, v in slopes.items() if kernel.units[other] == kernel.units[name])
                    assert abs(ours[f"{name}_{direction}"] - value) <= 1e-11 * size, (name, direction)


@pytest.mark.parametrize("name", [name for name in NAMES if name not in DERIVATIVES])
def test_compiled_kernel_agrees_with_its_expression_at_50_digits(name):
    kernel = kernels()[name]
    assert not kernel.along
    rng = np.random.default_rng(17)
    names = list(kernel.inputs)
    exact = exact_outputs(kernel)
    for _ in range(20):
        arguments = random_arguments(kernel, rng)
        ours = call(kernel.name, arguments)
        with mp.workdps(50):
            values = {name: f(*(mp.mpf(arguments[s.name]) for s in names)) for name, f in exact.items()}
            # free motion and Q are sums that may cancel: compare with the largest output of the same unit
            for name, value in values.items():
                size = max(abs(v) for other, v in values.items() if kernel.units[other] == kernel.units[name])
                assert abs(ours[name] - value) <= 1e-12 * size, name


def test_a_call_whose_structs_lack_an_argument_or_have_it_twice_is_not_generated():
    kernel = kernels()["trum_filling"]
    layer = driver.Struct("layer", "layer", ("W_c", "engagement", "fullness"), "a layer")
    height = driver.Struct("height", "height", ("engagement_per_height", "W_c"), "twice")
    for structs, name in (((layer,), "engagement_per_height is in 0"), ((layer, height), "W_c is in 2")):
        call = driver.Call("trum_filling", tuple(struct.name for struct in structs))
        with pytest.raises(ValueError, match=name):
            driver.called(call, kernel, structs, "", "double", "{}")


def test_the_manifest_lists_the_drivers_fields_in_its_order(files):
    orbit = json.loads(files["manifest.json"])["orbit"]
    for kernel, (inputs, outputs) in {
        "rotor_orbit": (["orbit_in"], ["orbit_out"]),
        "rotor_slopes": (["orbit_in", "slopes_in"], ["orbit_out"]),
        "rotor_history": (["orbit_in", "history_in"], []),
        "cycle_sums": (["cycle_sums_in"], ["cycle_sums_out"]),
        "cycle_response": (["cycle_response_in"], ["cycle_response_out"]),
        "contact_half_angle": (["half_angle_in"], []),
    }.items():
        for names, lists in zip(signature(kernel), (inputs, outputs), strict=True):
            listed = [field["name"] for name in lists for field in orbit[name]]
            assert names[: len(listed)] == listed, kernel
    assert [field["name"] for field in orbit["slope_figures"]] == list(SLOPE_FIGURES)
    assert [field["name"] for field in orbit["slope_parameters"]] == list(SLOPE_PARAMETERS)


def test_compiled_kernels_of_another_version_are_refused_by_name():
    with pytest.raises(ImportError, match=r"an orbit's inputs differ by drag, load; install"):
        expect("an orbit's inputs", ("push", "load"), ("push", "drag"))
