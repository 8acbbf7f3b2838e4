"""Headers of the C library: the motor's and the drive's fields, a table of values by symbol, TRUM-60's numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable

from derivations.codegen.kernels import Kernel
from trum_sym.c_library.numbers import CHOICES, DRIVE_SYMBOLS, motor_header
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, LEAD, Drive
from trum_sym.inputs.motor import UNCOUPLED
from trum_sym.inputs.motor_file import load_motor
from trum_sym.quantities import ERRORS, QUANTITIES

__all__ = ["headers"]


def headers(kernels: Iterable[Kernel], note: str) -> dict[str, str]:
    """The three headers by file name; ``note`` opens each."""
    texts = {"trum_fields.h": _fields(), "trum_values.h": _values(tuple(kernels)), "trum60.h": _trum60()}
    return {name: "\n".join([f"/* {note} */", *lines, ""]) for name, lines in texts.items()}


def _number(value: float) -> str:
    if math.isinf(value):
        return "TRUM_HUGE" if value > 0 else "-TRUM_HUGE"
    return f"TRUM_C({float(value)!r})"


def _field(name: str, symbol: str, unit: str, domain: Domain, required: bool) -> str:
    flags = (domain.low_open, domain.high_open, domain.integer, required)
    bounds = f"{_number(domain.low)}, {_number(domain.high)}, " + ", ".join(str(int(flag)) for flag in flags)
    return f'  X({name}, {symbol}, "{unit}", {bounds})'


def _listed(name: str, rows: Iterable[str]) -> list[str]:
    return [f"#define {name}(X) \\", " \\\n".join(rows)]


def _fields() -> list[str]:
    motor = [_field(name, spec.symbol, spec.unit, spec.domain, spec.required) for name, spec in UNCOUPLED.items()]
    domains = {**DRIVE_DOMAINS, "phase_lead": (LEAD, "1")}
    drive = [_field(name, DRIVE_SYMBOLS[name], unit, domain, True) for name, (domain, unit) in domains.items()]
    outputs = [f'  X({name}, "{output.unit}")' for name, output in {**QUANTITIES, **ERRORS}.items()]
    lines = ["#ifndef TRUM_FIELDS_H", "#define TRUM_FIELDS_H", "", '#include "trum_math.h"', ""]
    lines += [
        "/* field, symbol, SI unit, lowest, highest, is the lowest excluded, the highest, must it be an integer,",
        " * must it be given: where not, 0 stands for a value that the model is to find */",
        *_listed("TRUM_MOTOR_FIELDS", motor),
        *_listed("TRUM_DRIVE_FIELDS", drive),
        "/* figure, SI unit */",
        *_listed("TRUM_FIGURES", outputs),
        "/* choice, number of words, the words in the order of their numbers */",
        *_listed("TRUM_CHOICES", (f'  X({n}, {len(words)}, "{" ".join(words)}")' for n, words in CHOICES.items())),
    ]
    for name, words in CHOICES.items():
        lines.append(f"enum {{ {', '.join(f'TRUM_{name}_{word}'.upper() for word in words)} }};")
    lines += ["", "/* a drive's choice; one that a build has fixed, -DTRUM_FIXED_CONTACT=0 and so on, is a constant */"]
    for name in CHOICES:
        fixed = f"TRUM_FIXED_{name}".upper()
        lines += [f"#ifdef {fixed}", f"#define TRUM_LEVEL_{name}(drive) ((void)(drive), {fixed})"]
        lines += ["#else", f"#define TRUM_LEVEL_{name}(drive) ((drive)->{name})", "#endif"]
    return [*lines, "", "#endif"]


def _values(kernels: tuple[Kernel, ...]) -> list[str]:
    """One position for every symbol, and every kernel called on a table of them."""
    symbols = {spec.symbol for spec in UNCOUPLED.values()} | set(DRIVE_SYMBOLS.values())
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
            f"  (void){kernel.name}(arg, res, 0, 0, 0);",
            "}",
            "",
        ]
    return [*lines, "#endif"]


def _trum60() -> list[str]:
    """The motor that the package ships, and the paper's Table 3: the defaults of ``Drive``."""
    return motor_header(load_motor("trum60"), Drive(), {}, ("TRUM60_H", "TRUM60_NAME", "trum60", "trum_table3"))
