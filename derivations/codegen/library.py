"""Headers of the C library: the motor's and the drive's fields, a table of values by symbol, TRUM-60's numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable

from derivations.codegen.kernels import Kernel
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, LEAD, LOADS, STARTS, Drive
from trum_sym.inputs.motor import SPECS
from trum_sym.inputs.motor_file import load_motor
from trum_sym.model.levels import AMPLITUDES, COMPLIANCES, CONTACTS, FOUNDATIONS, RESONANCES, TANGENTIALS
from trum_sym.quantities import ERRORS, QUANTITIES

__all__ = ["headers"]

_CHOICES = {
    "start": STARTS,
    "load": LOADS,
    "contact": CONTACTS,
    "resonance": RESONANCES,
    "foundation": FOUNDATIONS,
    "amplitude": AMPLITUDES,
    "compliance": COMPLIANCES,
    "tangential": TANGENTIALS,
}
# Fields of the drive by the symbols of the equations; the frequency difference becomes Delta_omega
_DRIVE_SYMBOLS = {
    "prepressure": "F_c",
    "frequency_difference": "Delta_f",
    "periods": "m",
    "on_periods": "n",
    "load_torque": "T_load",
    "load_inertia": "J_load",
    "load_radius": "r_s",
    "switching_phase": "psi",
    "phase_lead": "s",
}


def headers(kernels: Iterable[Kernel], note: str) -> dict[str, str]:
    """The three headers by file name; ``note`` opens each."""
    texts = {"trum_fields.h": _fields(), "trum_values.h": _values(tuple(kernels)), "trum60.h": _trum60()}
    return {name: "\n".join([f"/* {note} */", *lines, ""]) for name, lines in texts.items()}


def _number(value: float) -> str:
    if math.isinf(value):
        return "HUGE_VAL" if value > 0 else "-HUGE_VAL"
    return repr(float(value))


def _field(name: str, symbol: str, unit: str, domain: Domain, required: bool) -> str:
    flags = (domain.low_open, domain.high_open, domain.integer, required)
    bounds = f"{_number(domain.low)}, {_number(domain.high)}, " + ", ".join(str(int(flag)) for flag in flags)
    return f'  X({name}, {symbol}, "{unit}", {bounds})'


def _listed(name: str, rows: Iterable[str]) -> list[str]:
    return [f"#define {name}(X) \\", " \\\n".join(rows)]


def _fields() -> list[str]:
    motor = [_field(name, spec.symbol, spec.unit, spec.domain, spec.required) for name, spec in SPECS.items()]
    domains = {**DRIVE_DOMAINS, "phase_lead": (LEAD, "1")}
    drive = [_field(name, _DRIVE_SYMBOLS[name], unit, domain, True) for name, (domain, unit) in domains.items()]
    outputs = [f'  X({name}, "{output.unit}")' for name, output in {**QUANTITIES, **ERRORS}.items()]
    lines = ["#ifndef TRUM_FIELDS_H", "#define TRUM_FIELDS_H", ""]
    lines += [
        "/* field, symbol, SI unit, lowest, highest, is the lowest excluded, the highest, must it be an integer,",
        " * must it be given: where not, 0 stands for a value that the model is to find */",
        *_listed("TRUM_MOTOR_FIELDS", motor),
        *_listed("TRUM_DRIVE_FIELDS", drive),
        "/* figure, SI unit */",
        *_listed("TRUM_FIGURES", outputs),
        "/* choice, number of words, the words in the order of their numbers */",
        *_listed("TRUM_CHOICES", (f'  X({n}, {len(words)}, "{" ".join(words)}")' for n, words in _CHOICES.items())),
    ]
    for name, words in _CHOICES.items():
        lines.append(f"enum {{ {', '.join(f'TRUM_{name}_{word}'.upper() for word in words)} }};")
    return [*lines, "", "#endif"]


def _values(kernels: tuple[Kernel, ...]) -> list[str]:
    """One position for every symbol, and every kernel called on a table of them."""
    symbols = {spec.symbol for spec in SPECS.values()} | set(_DRIVE_SYMBOLS.values())
    for kernel in kernels:
        symbols |= {symbol.name for symbol in kernel.inputs} | set(kernel.results)
    lines = ["#ifndef TRUM_VALUES_H", "#define TRUM_VALUES_H", '#include "trum_kernels.h"', ""]
    lines += ["/* the position of every symbol in a table of values */", "enum {"]
    lines += [f"  trum_at_{name}," for name in sorted(symbols)]
    lines += ["  TRUM_VALUES", "};", "", "/* kernels on such a table */"]
    for kernel in kernels:
        inputs = ", ".join(f"v + trum_at_{symbol.name}" for symbol in kernel.inputs)
        outputs = ", ".join(f"v + trum_at_{name}" for name in kernel.results)
        lines += [
            f"static inline void trum_call_{kernel.name.removeprefix('trum_')}(trum_real* v) {{",
            f"  const trum_real* arg[{kernel.name}_n_arg] = {{{inputs}}};",
            f"  trum_real* res[{kernel.name}_n_res] = {{{outputs}}};",
            f"  {kernel.name}(arg, res, 0, 0, 0);",
            "}",
            "",
        ]
    return [*lines, "#endif"]


def _trum60() -> list[str]:
    """The motor that the package ships, and the paper's Table 3: the defaults of ``Drive``."""
    motor, drive = load_motor("trum60"), Drive()
    given = dict(motor.parameters())
    lines = ["/* Include after trum.h. */", "#ifndef TRUM60_H", "#define TRUM60_H", ""]
    lines += [f'#define TRUM60_NAME "{motor.name}"', "", "static const struct trum_motor trum60 = {"]
    for name, spec in SPECS.items():
        value = float(given[name].value) if name in given else 0.0
        source = given[name].source if name in given else "not measured"
        lines.append(f"  (trum_real){value!r}, /* {name}, {spec.unit}: {source} */")
    lines += ["};", "", "/* the paper's Table 3 */", "static const struct trum_drive trum_table3 = {"]
    for name in _DRIVE_SYMBOLS:
        lines.append(f"  (trum_real){float(getattr(drive, name))!r}, /* {name} */")
    lines += [f"  TRUM_{name}_{words[0]},".upper() for name, words in _CHOICES.items()]
    return [
        *lines,
        "  (trum_real)(TRUM_FINEST_TOLERANCE > 1e-6 ? TRUM_FINEST_TOLERANCE : 1e-6), /* tolerance */",
        "};",
        "",
        "#endif",
    ]
