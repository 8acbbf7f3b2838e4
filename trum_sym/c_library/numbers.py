"""A motor and a drive as a C header."""

from __future__ import annotations

from trum_sym.inputs.drive import LOADS, STARTS, Drive
from trum_sym.inputs.motor import UNCOUPLED, Motor
from trum_sym.model.levels import (
    AMPLITUDES,
    COMPLIANCES,
    CONTACTS,
    FOUNDATIONS,
    RESONANCES,
    TANGENTIALS,
    LevelChoice,
    Levels,
)
from trum_sym.output.c_text import as_comment

__all__ = ["CHOICES", "DRIVE_SYMBOLS", "chosen", "motor_header"]

CHOICES = {
    "start": STARTS,
    "load": LOADS,
    "contact": CONTACTS,
    "resonance": RESONANCES,
    "foundation": FOUNDATIONS,
    "amplitude": AMPLITUDES,
    "compliance": COMPLIANCES,
    "tangential": TANGENTIALS,
}
"""Words of the drive and of the levels, in the order of their numbers in C."""

DRIVE_SYMBOLS = {
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
"""Fields of the drive by the symbols of the equations; the frequency difference becomes Delta_omega."""


def chosen(drive: Drive, levels: LevelChoice) -> dict[str, str]:
    """The C names of the words that a drive and the levels say, first ones where they say nothing.

    Raises
    ------
    ParameterError
        For levels that do not go together, or that C does not know.
    """
    Levels(**levels).check_prescribed("the library's points have a prescribed wave (docs/coupling.md)")
    given = {"start": drive.start, "load": drive.load, **levels}
    return {name: f"TRUM_{name}_{given.get(name) or words[0]}".upper() for name, words in CHOICES.items()}


def motor_header(motor: Motor, drive: Drive, levels: LevelChoice, names: tuple[str, str, str, str]) -> list[str]:
    """Lines of a header with a motor's numbers and a drive's, to be included after ``trum.h``.

    Parameters
    ----------
    motor, drive
        Of one point: no arrays.
    levels : LevelChoice
        Words of the model's levels; the first of each where one is not given.
    names : tuple of str
        Of the guard, of the macro of the motor's name, of the motor and of the drive.
    """
    guard, title, machine, point = names
    given = dict(motor.parameters())
    lines = ["/* Include after trum.h. */", f"#ifndef {guard}", f"#define {guard}", ""]
    quoted = as_comment(motor.name).replace('"', "'")
    lines += [f'#define {title} "{quoted}"', "", f"static const struct trum_motor {machine} = {{"]
    for name, spec in UNCOUPLED.items():
        value = float(given[name].value) if name in given else 0.0
        source = as_comment(given[name].source) if name in given else "not measured"
        lines.append(f"  TRUM_C({value!r}), /* {name}, {spec.unit}: {source} */")
    lines += ["};", ""]
    if drive == Drive():
        lines.append("/* the paper's Table 3 */")
    lines.append(f"static const struct trum_drive {point} = {{")
    lines += [f"  TRUM_C({float(getattr(drive, name))!r}), /* {name} */" for name in DRIVE_SYMBOLS]
    lines += [f"  {word}," for word in chosen(drive, levels).values()]
    return [
        *lines,
        "  TRUM_EITHER(1e-6, TRUM_FINEST_TOLERANCE), /* tolerance */",
        "  0, /* max_steps: 2^31 - 1 */",
        "};",
        "",
        "#endif",
    ]
