"""One friction step (wave, filling, contact, friction) in every form that a user could run it in."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections import Counter
from collections.abc import Callable
from functools import reduce
from pathlib import Path

import casadi as ca
import numpy as np
import sympy as sp

import trum_sym as ts
from benchmarks.rows import Row, least
from derivations.codegen.emit import GENERATED, casadi_function, operations
from derivations.codegen.kernels import Kernel, kernels
from derivations.nomenclature import CONSTANTS
from trum_sym import _kernels
from trum_sym.model.kernels import call

__all__ = ["rows"]

SECTION = "one friction step"
DRIVER = Path(ts.__file__).parent / "_driver"  # of a source tree: its header names the type of all numbers
STEP = ("trum_wave", "trum_filling", "trum_contact_winkler", "trum_friction")
BATCH = 1024
RESULT = "f"
ROOT = {"fullness_root": "fullness"}  # an argument that is the cube root of an earlier result


def _chain() -> tuple[list[Kernel], list[str]]:
    """The kernels of a step and the arguments that none of them computes."""
    known = {kernel.name: kernel for kernel in kernels()}
    chain = [known[name] for name in STEP]
    made: set[str] = set()
    outside: list[str] = []
    for kernel in chain:
        outside += [s.name for s in kernel.inputs if s.name not in made | set(outside) | set(ROOT)]
        made |= set(kernel.outputs)
    return chain, outside


def _values(outside: list[str]) -> dict[str, np.ndarray]:
    """TRUM-60 at Table 3, each of the batch at another instant and speed."""
    rng = np.random.default_rng(1)
    point = ts.evaluate(ts.load_motor("trum60"), ts.Drive())
    omega, W = 2 * np.pi * point.resonance_frequency, point.amplitude
    angle = rng.uniform(-np.pi, np.pi, (4, BATCH))
    known = {
        "omega_n": omega,
        "Delta_omega": 2 * np.pi * 3000.0,
        "xi": 0.006,
        "s": 1.0,
        "W": W,
        "D": point.neutral_axis,
        "k_c": point.wavenumber,
        "g_A": 1.0,
        "g_B": 1.0,
        "v": rng.uniform(-1, 1, BATCH),
        "engagement_per_height": 2 * 9 * 3e10 / (point.wavenumber * 180.0),
        "f_A_re": W * np.cos(angle[0]),
        "f_A_im": W * np.sin(angle[0]),
        "f_B_re": W * np.cos(angle[1]),
        "f_B_im": W * np.sin(angle[1]),
        "e_re": 0.9 * np.cos(angle[2]),
        "e_im": 0.9 * np.sin(angle[2]),
        "d_re": np.cos(angle[3]) - 0.9 * np.cos(angle[2]),
        "d_im": np.sin(angle[3]) - 0.9 * np.sin(angle[2]),
        "p_re": 1.0,
        "p_im": 0.0,
    }
    return {name: np.ascontiguousarray(np.broadcast_to(known[name], BATCH), dtype=float) for name in outside}


def _compiled(chain: list[Kernel], values: dict[str, np.ndarray]) -> np.ndarray:
    """The generated C through the package's NumPy ufuncs."""
    now = dict(values)
    for kernel in chain:
        for root, of in ROOT.items():
            if of in now:
                now[root] = np.cbrt(now[of])
        now.update(call(kernel.name, now))
    return np.asarray(now[RESULT])


def _c_program(chain: list[Kernel], outside: list[str]) -> str:
    """A C program: the batch from standard input, its results to standard output, ns per step on standard error."""
    names = [*outside, *ROOT, *(name for kernel in chain for name in kernel.outputs)]
    places = {name: f"&v[{i}]" for i, name in enumerate(dict.fromkeys(names))}
    lines = [
        "#include <math.h>",
        "#include <stdio.h>",
        "#include <stdlib.h>",
        "#include <time.h>",
        '#include "trum_kernels.h"',
        f"enum {{ batch = {BATCH}, outside = {len(outside)} }};",
        f"static double in[outside][batch], out[batch], v[{len(places)}];",
        "static void step(int i) {",
        "  for (int k = 0; k < outside; ++k) v[k] = in[k][i];",
    ]
    for number, kernel in enumerate(chain):
        for root, of in ROOT.items():
            if any(symbol.name == root for symbol in kernel.inputs):
                lines.append(f"  *({places[root]}) = cbrt(*({places[of]}));")
        arguments = ", ".join(places[symbol.name] for symbol in kernel.inputs)
        results = ", ".join(places[name] for name in kernel.outputs)
        lines += [
            f"  static const double* arg{number}[] = {{{arguments}}};",
            f"  static double* res{number}[] = {{{results}}};",
            f"  {kernel.name}(arg{number}, res{number}, NULL, NULL, 0);",
        ]
    lines += [
        f"  out[i] = *({places[RESULT]});",
        "}",
        "int main(int argc, char** argv) {",
        "  const int rounds = argc > 1 ? atoi(argv[1]) : 1;",
        "  if (fread(in, sizeof in, 1, stdin) != 1) return 1;",
        "  struct timespec a, b;",
        "  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);",
        "  for (int r = 0; r < rounds; ++r) for (int i = 0; i < batch; ++i) step(i);",
        "  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);",
        '  fprintf(stderr, "%.17g", ((double)(b.tv_sec - a.tv_sec) * 1e9 + (double)(b.tv_nsec - a.tv_nsec))'
        " / rounds / batch);",
        "  return fwrite(out, sizeof out, 1, stdout) != 1;",
        "}",
    ]
    return "\n".join(lines) + "\n"


def _scalar_c(chain: list[Kernel], values: dict[str, np.ndarray], repeats: int) -> tuple[list[float], np.ndarray]:
    """Nanoseconds a step of the generated C, compiled as it stands with the system's compiler, and its results."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        raise RuntimeError("no C compiler: install one, or leave out the step's benchmark")
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "step.c", Path(folder) / "step"
        source.write_text(_c_program(chain, list(values)))
        files = [str(GENERATED / f"{kernel.name}.c") for kernel in chain]
        folders = [part for where in (GENERATED, DRIVER) for part in ("-I", str(where))]
        command = [compiler, "-O2", "-std=gnu99", *folders, str(source), *files, "-lm", "-o", str(program)]
        subprocess.run(command, check=True)
        batch = b"".join(column.tobytes() for column in values.values())
        times = []
        for _ in range(repeats):
            done = subprocess.run([str(program), "400"], input=batch, capture_output=True, check=True)
            times.append(float(done.stderr))
    return times, np.frombuffer(done.stdout)


def _casadi(chain: list[Kernel], values: dict[str, np.ndarray], own_c: bool) -> Callable[[], np.ndarray]:
    """CasADi over the batch: its virtual machine, or the C that it writes, compiled by the system's compiler."""
    symbols: dict[str, ca.SX] = {name: ca.SX.sym(name) for name in values}
    now = dict(symbols)
    for kernel in chain:
        for root, of in ROOT.items():
            if of in now:
                now[root] = now[of] ** (1 / 3)
        results = casadi_function(kernel)(*(now[symbol.name] for symbol in kernel.inputs))
        now.update(zip(kernel.outputs, results if len(kernel.outputs) > 1 else (results,), strict=True))
    jit = {"jit": True, "compiler": "shell", "jit_options": {"flags": ["-O3", "-march=native"]}} if own_c else {}
    step = ca.Function("step", list(symbols.values()), [now[RESULT]])
    mapped = step.map(BATCH)
    if own_c:
        columns = [ca.MX.sym(name, 1, BATCH) for name in symbols]
        mapped = ca.Function("steps", columns, [mapped(*columns)], jit)
    rows_ = [ca.DM(column).T for column in values.values()]
    return lambda: np.asarray(mapped(*rows_)).ravel()


def _less(x: float, y: float) -> float:
    return 1.0 if x < y else 0.0


def _expressions(kernel: Kernel) -> list[sp.Expr]:
    return [sp.sympify(expr).subs(CONSTANTS) for expr in kernel.outputs.values()]


def _pairwise(expr: sp.Expr) -> sp.Expr:
    """Extremes as NumPy's functions of two arrays: SymPy would print a reduction over stacked arrays, far slower."""
    for kind, name in ((sp.Max, "maximum"), (sp.Min, "minimum")):
        expr = expr.replace(kind, lambda *arguments, name=name: reduce(sp.Function(name), arguments))
    return expr


def _numpy(chain: list[Kernel], values: dict[str, np.ndarray]) -> Callable[[], np.ndarray]:
    """The derivations' expressions, printed for NumPy, over the batch."""
    modules = [{"less": lambda x, y: np.less(x, y).astype(float)}, "numpy"]
    calls = [
        (
            [symbol.name for symbol in kernel.inputs],
            list(kernel.outputs),
            sp.lambdify(kernel.inputs, [_pairwise(expr) for expr in _expressions(kernel)], modules, cse=True),
        )
        for kernel in chain
    ]

    def run() -> np.ndarray:
        now = dict(values)
        for inputs, outputs, function in calls:
            for root, of in ROOT.items():
                if root in inputs:
                    now[root] = np.cbrt(now[of])
            now.update(zip(outputs, function(*(now[name] for name in inputs)), strict=True))
        return np.asarray(now[RESULT])

    return run


def _numba(chain: list[Kernel], values: dict[str, np.ndarray]) -> Callable[[], np.ndarray]:
    """The same printed for scalars and compiled by Numba, in a loop over the batch."""
    import numba

    less = numba.njit(_less)
    space: dict[str, object] = {"cbrt": np.cbrt}
    lines = ["def loop(columns, out):", "  for i in range(out.size):"]
    lines += [f"    {name} = columns[{k}, i]" for k, name in enumerate(values)]
    for kernel in chain:
        function = sp.lambdify(kernel.inputs, _expressions(kernel), [{"less": less}, "math"], cse=True)
        space[kernel.name] = numba.njit(function)
        lines += [f"    {root} = cbrt({of})" for root, of in ROOT.items() if root in map(str, kernel.inputs)]
        arguments = ", ".join(symbol.name for symbol in kernel.inputs)
        lines.append(f"    {', '.join(kernel.outputs)}{',' * (len(kernel.outputs) == 1)} = {kernel.name}({arguments})")
    lines.append(f"    out[i] = {RESULT}")
    exec("\n".join(lines), space)
    loop = numba.njit(space["loop"])
    columns, out = np.array(list(values.values())), np.empty(BATCH)

    def run() -> np.ndarray:
        loop(columns, out)
        return out

    return run


def rows(repeats: int) -> list[Row]:
    """Nanoseconds a step; the ratio says how many times as fast as the scalar generated C."""
    chain, outside = _chain()
    values = _values(outside)
    expected = _compiled(chain, values)
    times, results = _scalar_c(chain, values, repeats)
    scalar = min(times)
    found = [Row(SECTION, "generated C, scalar, in a C loop", scalar, "ns", max(times) / scalar - 1, 1.0)]
    _agree("generated C", results, expected)

    def add(name: str, run: Callable[[], np.ndarray]) -> None:
        _agree(name, run(), expected)
        shortest, spread = least(lambda: [run() for _ in range(20)], repeats)
        each = shortest / 20 / BATCH * 1e9
        found.append(Row(SECTION, name, each, "ns", spread, scalar / each, f"batch of {BATCH}"))

    add("generated C, as NumPy ufuncs", lambda: _compiled(chain, values))
    add("CasADi VM, map", _casadi(chain, values, own_c=False))
    add("CasADi's own C, -O3, map", _casadi(chain, values, own_c=True))
    add("NumPy", _numpy(chain, values))
    add("Numba", _numba(chain, values))
    found += _lanes(chain, repeats, scalar)
    return found


# Operations as CasADi counts them, by the operation of the lanes that they cost
COST = {
    "add": "add",
    "sub": "add",
    "neg": "add",
    "twice": "add",
    "mul": "mul",
    "sq": "mul",
    "div": "div",
    "inv": "div",
    "sqrt": "sqrt",
    "fmin": "fmin",
    "fmax": "fmin",
    "lt": "lt",
    "fabs": "fabs",
    "sin": "sin",
    "cos": "cos",
    "atan2": "atan2",
}


def _lanes(chain: list[Kernel], repeats: int, scalar: float) -> list[Row]:
    """The driver's lanes, and the bound: every operation of a step at its own measured throughput."""
    count = 400 * BATCH

    def each(name: str) -> tuple[float, float]:
        shortest, spread = least(lambda: _kernels.step_benchmark(name, count), repeats)
        return shortest / count * 1e9, spread

    counts = Counter({"cbrt": 1})
    for kernel in chain:
        for name, times in operations(casadi_function(kernel)).items():
            counts[COST[name]] += times
    lanes, spread = each("step")
    bound = sum(times * each(name)[0] for name, times in counts.items())
    best = list(_kernels.instruction_sets())[-1].removeprefix("orbit_")
    note = f"{best}; {100 * bound / lanes:.0f} % of the bound"
    return [
        Row(SECTION, "the driver's lanes", lanes, "ns", spread, scalar / lanes, note),
        Row(SECTION, "throughput bound of its operations", bound, "ns", 0.0, scalar / bound, "measured one by one"),
    ]


def _agree(name: str, results: np.ndarray, expected: np.ndarray) -> None:
    """All forms must compute the same; the cube root is a guess that the contact refines."""
    difference = np.max(np.abs(results - expected))
    if not difference < 1e-9:
        raise RuntimeError(f"{name} differs from the package's kernels by {difference:g}")
