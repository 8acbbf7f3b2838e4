"""Motor files written: a file's own text with some entries replaced, all else to the letter."""

from __future__ import annotations

from os import PathLike
from typing import Any

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.choices import path_of
from trum_sym.inputs.motor import Motor, Parameter
from trum_sym.inputs.motor_file import load_motor, motor_text
from trum_sym.inputs.units import Unit, parse_unit
from trum_sym.output.files import check_target, write_bytes

__all__ = ["write_motor"]

_KEPT = ("unit", "symbol", "note")


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
        If the base cannot be read or the target not be written.
    MissingExtraError
        Without tomlkit.
    """
    try:
        import tomlkit
    except ImportError:
        raise MissingExtraError("a motor file", "tomlkit", "optimize") from None
    path = path_of(name, target)
    check_target(name, path, (".toml",))
    before = load_motor(base)
    text = tomlkit.parse(motor_text(base))
    parameters: Any = text["parameters"]
    for parameter_name, parameter in motor.parameters():
        if parameter != getattr(before, parameter_name):
            _replace(parameters, parameter_name, _entry(parameter, parameters.get(parameter_name)))
    write_bytes(name, tomlkit.dumps(text).encode(), path)


def _entry(parameter: Parameter, old: dict[str, Any] | None) -> dict[str, Any]:
    """The entry of a parameter in the unit that the file has for it."""
    kept = {key: str(old[key]) for key in _KEPT if key in old} if old else {"unit": parameter.unit}
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


def _inline(entry: dict[str, Any]) -> Any:  # noqa: ANN401
    """An entry on one line, laid out as the shipped motor file is."""
    import tomlkit

    parts = (f"{key} = {tomlkit.item(value).as_string()}" for key, value in entry.items())
    return tomlkit.value("{ " + ", ".join(parts) + " }")


def _replace(parameters: Any, name: str, entry: dict[str, Any]) -> None:  # noqa: ANN401
    """Replace one entry of the parameters, or add it; comments stay."""
    from tomlkit.items import Table

    old = parameters.get(name)
    if not isinstance(old, Table) or old.is_super_table() or old.display_name is None:
        parameters[name] = _inline(entry)
        return
    for key in [key for key in old if key not in entry]:  # a section of its own
        del old[key]
    for key, value in entry.items():
        old[key] = value
