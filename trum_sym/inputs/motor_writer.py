"""Motor files written: a file's own text with some entries replaced, all else to the letter."""

from __future__ import annotations

from os import PathLike
from typing import Any

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.inputs.choices import path_of
from trum_sym.inputs.motor import Motor, Parameter
from trum_sym.inputs.motor_file import load_motor, motor_of
from trum_sym.inputs.units import Unit, parse_unit
from trum_sym.output.files import check_target, write_bytes

__all__ = ["save_motor", "write_motor"]

_KEPT = ("unit", "symbol", "note")
_OTHERS = ("name", "bench", "box", "allowed", "spreads", "published")


def save_motor(motor: Motor, target: str | PathLike[str]) -> None:
    """Write a motor file: the text that the motor was read from, with the values that were changed since in place.

    The other lines, their order and comments stay; a changed entry keeps its unit, symbol, note and comment, and says
    its source.

    Parameters
    ----------
    motor : Motor
        That :func:`trum_sym.load_motor` has read, of single numbers, whatever :meth:`trum_sym.Motor.with_values` has
        changed.
    target : path
        A name that ends in .toml.

    Raises
    ------
    ParameterError
        For a motor that no file has, or whose name or other tables differ from its file's; and where nothing can be
        written.
    MissingExtraError
        Without tomlkit.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import trum_sym as ts
    >>> motor = ts.load_motor("trum60").with_values({"contact_radius": "26 mm"}, source="drawing 7")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "mine.toml"
    ...     ts.save_motor(motor, path)
    ...     ts.load_motor(path).contact_radius.source
    'drawing 7'
    """
    if not isinstance(motor, Motor) or not motor.text:
        raise ParameterError("motor", motor, "a motor that load_motor has read")
    before = motor_of("motor", motor.text)
    for table in _OTHERS:
        if getattr(motor, table) != getattr(before, table):
            raise ParameterError(f"motor: {table}", "another one", "that of its file, in which it is to be changed")
    _write(motor, before, target, "motor file")


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
    before = load_motor(base)
    _write(motor, before, target, name)


def _write(motor: Motor, before: Motor, target: str | PathLike[str], name: str) -> None:
    """Write the text that a motor was read from with the entries in which another one differs replaced."""
    try:
        import tomlkit
    except ImportError:
        raise MissingExtraError("a motor file", "tomlkit", "optimize") from None
    path = path_of(name, target)
    check_target(name, path, (".toml",))
    text = tomlkit.parse(before.text)
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
