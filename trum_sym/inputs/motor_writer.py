"""Motor files written: a file's own text with some entries replaced, all else to the letter."""

from __future__ import annotations

import json
import re
import tomllib
from os import PathLike
from pathlib import Path
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.motor import Motor, Parameter
from trum_sym.inputs.motor_file import load_motor, motor_text
from trum_sym.inputs.units import Unit, parse_unit
from trum_sym.output.files import check_target, write_bytes

__all__ = ["write_motor"]

_KEPT = ("unit", "symbol", "note")
_SECTION = re.compile(r"\s*\[+\s*([^\[\]]+?)\s*\]+\s*(#.*)?$")


def write_motor(motor: Motor, base: str | PathLike[str], target: str | PathLike[str], name: str = "motor file") -> None:
    """Write ``base``, with the entries in which ``motor`` differs replaced.

    The other lines, their order and comments stay; a replaced entry keeps its unit, symbol, note and comment.

    Parameters
    ----------
    motor : Motor
        Of single numbers.
    base : path or name
        The motor file that it came from.
    target : path
        A name that ends in .toml; may be ``base`` itself.
    name : str
        What an error calls the target.

    Raises
    ------
    ParameterError
        If the base cannot be read, its layout not be edited, or the target not be written.
    """
    path = Path(target)
    check_target(name, path, (".toml",))
    before = load_motor(base)
    text = motor_text(base)
    wanted = tomllib.loads(text)
    for parameter_name, parameter in motor.parameters():
        if parameter == getattr(before, parameter_name):
            continue
        entry = _entry(parameter, wanted["parameters"].get(parameter_name))
        wanted["parameters"][parameter_name] = entry
        text = _replaced(text, parameter_name, entry)
    try:
        kept = tomllib.loads(text) == wanted
    except tomllib.TOMLDecodeError:
        kept = False
    if not kept:
        raise ParameterError("motor", str(base), "entries of the form NAME = { value = ..., ... } under [parameters]")
    write_bytes(name, text.encode(), path)


def _entry(parameter: Parameter, old: dict[str, Any] | None) -> dict[str, Any]:
    """The entry of a parameter in the unit that the file has for it."""
    kept = {key: old[key] for key in _KEPT if key in old} if old else {"unit": parameter.unit}
    unit = parse_unit(kept["unit"])
    digits = "%.10g" if parameter.interval else "%.17g"
    entry: dict[str, Any] = {"value": _given(float(parameter.value), unit, digits), **kept, "source": parameter.source}
    for key in ("range", "interval"):
        ends = getattr(parameter, key)
        if ends is not None:
            entry[key] = [_given(end, unit, digits) for end in ends]
    for key in ("data", "reason"):
        if getattr(parameter, key):
            entry[key] = getattr(parameter, key)
    return entry


def _given(value: float, unit: Unit, digits: str) -> float:
    """An SI value in a file's unit."""
    return float(digits % (value / unit.to_si(1.0)))


def _toml(value: object) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False)


def _table(entry: dict[str, Any]) -> str:
    return "{ " + ", ".join(f"{key} = {_toml(value)}" for key, value in entry.items()) + " }"


def _replaced(text: str, name: str, entry: dict[str, Any]) -> str:
    """The text with one entry replaced, or added at the end of the parameters."""
    lines = text.splitlines(keepends=True)
    section, last = "", None
    for at, line in enumerate(lines):
        header = _SECTION.match(line)
        if header:
            section = header[1].replace('"', "").replace(" ", "")
            if section == f"parameters.{name}":
                return _with_section(lines, at + 1, entry)
        if section != "parameters":
            continue
        if header or line.split("#")[0].strip():
            last = at
        start = re.match(rf'(\s*"?{name}"?\s*)=', line)
        if start:
            end, comment = _extent(lines, at)
            new = f"{start[1]}= {_table(entry)}" + (f"  {comment}" if comment else "") + "\n"
            return "".join([*lines[:at], new, *lines[end:]])
    if last is None:
        end_of_file = "" if not text or text.endswith("\n") else "\n"
        body = "".join(f"{key} = {_toml(value)}\n" for key, value in entry.items())
        return f"{text}{end_of_file}\n[parameters.{name}]\n{body}"
    if not lines[last].endswith("\n"):
        lines[last] += "\n"
    return "".join([*lines[: last + 1], f"{name} = {_table(entry)}\n", *lines[last + 1 :]])


def _extent(lines: list[str], at: int) -> tuple[int, str]:
    """Where the entry that begins on a line ends, and the comment behind it."""
    for end in range(at + 1, len(lines) + 1):
        whole = "".join(lines[at:end]).rstrip()
        if not _parses(whole):
            continue
        for place in (match.start() for match in re.finditer("#", whole)):
            if _parses(whole[:place]):
                return end, whole[place:]
        return end, ""
    return at + 1, ""  # what is no entry is refused when the whole is read again


def _parses(text: str) -> bool:
    try:
        return len(tomllib.loads(text)) == 1
    except tomllib.TOMLDecodeError:
        return False


def _with_section(lines: list[str], begin: int, entry: dict[str, Any]) -> str:
    """The lines with the keys of one section replaced; its comments stay."""
    end = begin
    while end < len(lines) and not _SECTION.match(lines[end]):
        end += 1
    others = [line for line in lines[begin:end] if not line.split("#")[0].strip()]
    body = [f"{key} = {_toml(value)}\n" for key, value in entry.items()]
    return "".join([*lines[:begin], *body, *others, *lines[end:]])
