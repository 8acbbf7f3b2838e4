"""Options that the commands share, and what they become: a motor, a drive, levels.

Each field of the drive and of the levels is an option of the same name, with the unit, default and text that the field
carries: a new one is added there and nowhere else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import Field, fields
from typing import TYPE_CHECKING, Any, cast

import click

from trum_sym.inputs.drive import Drive
from trum_sym.model.levels import LEVEL_NAMES, LevelChoice, Levels

if TYPE_CHECKING:
    from trum_sym.inputs.motor import Motor

__all__ = [
    "QuantityType",
    "choice_option",
    "chosen_drive",
    "chosen_levels",
    "chosen_motor",
    "number_option",
    "option_name",
    "point_options",
    "refuse_sampling_period",
    "tolerance_option",
]


class QuantityType(click.ParamType):  # type: ignore[type-arg, unused-ignore]
    """A number, bare in its SI unit or with a unit that converts to it."""

    def __init__(self, unit: str) -> None:
        self.name = unit
        self.unit = unit

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401, ARG002
        """The value in the SI unit."""
        from trum_sym.inputs.units import parse_quantity

        if isinstance(value, float | int):
            return float(value)
        return parse_quantity(param.name if param and param.name else "value", str(value), self.unit)


def number_option(name: str, unit: str, default: float | None, text: str, metavar: str) -> Callable[..., Any]:
    """An option that takes a quantity."""
    shown = False if default is None else f"{default:g}"
    return click.option(name, type=QuantityType(unit), default=default, show_default=shown, help=text, metavar=metavar)


def choice_option(name: str, words: tuple[str, ...], text: str) -> Callable[..., Any]:
    """An option that takes one of some words, the first if not given."""
    return click.option(name, type=click.Choice(words), default=words[0], show_default=True, help=text)


def _drive_option(quantity: Field[Any]) -> Callable[..., Any]:
    """The option of one field of the drive."""
    about, name = quantity.metadata, option_name(quantity.name)
    if "words" in about:
        return choice_option(name, about["words"], about["text"])
    default: float = quantity.default  # type: ignore[assignment]  # every quantity of the drive has one
    return number_option(name, about["unit"], default, about["text"], about["metavar"])


def option_name(name: str) -> str:
    """How the console calls a parameter."""
    return "--" + name.replace("_", "-")


_POINT_OPTIONS = (
    click.option(
        "--motor", default="trum60", show_default=True, metavar="NAME|FILE", help="Motor: trum60 or a TOML file."
    ),
    click.option(
        "--set",
        "overrides",
        multiple=True,
        metavar="NAME=VALUE",
        help="Replace a value of the motor file, in its SI unit or with one: --set contact_radius='26 mm'.",
    ),
    *(_drive_option(quantity) for quantity in fields(Drive)),
    *(
        choice_option(option_name(level.name), level.metadata["words"], level.metadata["text"])
        for level in fields(Levels)
    ),
    number_option(
        "--sampling-period", "s", None, "Averaging period of the speed's encoder  [default: continuous]", "S"
    ),
)


def tolerance_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the option ``--tolerance``, which is None where it is not given."""
    text = (
        "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2  "
        "[default: 1e-6, or what four digits of the mean speed need]"
    )
    option: Callable[..., Any] = number_option("--tolerance", "1", None, text, "T")(command)
    return option


def point_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command all options of an operating point."""
    for option in reversed(_POINT_OPTIONS):
        command = option(command)
    return command


def chosen_motor(name: str, overrides: tuple[str, ...]) -> Motor:
    """The motor that ``--motor`` and ``--set`` mean."""
    from trum_sym.errors import ParameterError
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.plausible import unquestioned

    values: dict[str, str] = {}
    for override in overrides:
        key, equals, value = override.partition("=")
        key = key.strip()
        if not equals or not key or not value.strip():
            raise ParameterError("--set", override, "NAME=VALUE, such as friction_coefficient=0.2")
        if key in values:
            raise ParameterError("--set", override, f"each name once; {key} was set to {values[key]} before")
        values[key] = value
    if not values:
        return load_motor(name)
    with unquestioned():  # with_values warns of what is left
        machine = load_motor(name)
    return machine.with_values(values)


def chosen_drive(options: dict[str, Any]) -> Drive:
    """The drive that an operating point's options mean."""
    values = {quantity.name: options[quantity.name] for quantity in fields(Drive)}
    return Drive(**{**values, "phase_lead": int(values["phase_lead"])})


def chosen_levels(options: dict[str, Any]) -> LevelChoice:
    """The levels that an operating point's options mean, as keyword arguments."""
    return cast("LevelChoice", {name: options[name] for name in LEVEL_NAMES})


def refuse_sampling_period(options: dict[str, Any], reason: str = "what is optimised is continuous") -> None:
    """For commands that look at the continuous speed only; ``reason`` says why.

    Raises
    ------
    ParameterError
        If an encoder's period is given.
    """
    from trum_sym.errors import ParameterError

    if options["sampling_period"] is not None:
        raise ParameterError("sampling_period", options["sampling_period"], f"none: {reason}")
