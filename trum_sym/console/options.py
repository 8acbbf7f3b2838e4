"""Options that the commands share, and what they become: a motor, a drive, levels."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.motor import Motor

__all__ = ["LEVELS", "Quantity", "choice_option", "chosen_drive", "chosen_motor", "number_option", "point_options"]

LEVELS = ("contact", "resonance", "foundation", "amplitude", "sampling_period")
_STARTS = ("periodic", "steady", "rest")


class Quantity(click.ParamType):  # type: ignore[type-arg, unused-ignore]
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
    return click.option(name, type=Quantity(unit), default=default, show_default=shown, help=text, metavar=metavar)


def choice_option(name: str, words: tuple[str, ...], text: str) -> Callable[..., Any]:
    """An option that takes one of some words, the first if not given."""
    return click.option(name, type=click.Choice(words), default=words[0], show_default=True, help=text)


_POINT_OPTIONS = (
    click.option("--motor", default="trum60", show_default=True, metavar="NAME|FILE",
                 help="Motor: trum60 or a TOML file."),
    click.option("--set", "overrides", multiple=True, metavar="NAME=VALUE",
                 help="Replace a value of the motor file, in its SI unit or with one: --set contact_radius='26 mm'."),
    number_option("--prepressure", "N", 180.0, "Prepressure F_c.", "N"),
    number_option("--frequency-difference", "Hz", 3000.0, "Drive frequency less resonance.", "HZ"),
    number_option("--periods", "1", 20, "Drive pulses per cycle, m.", "M"),
    number_option("--on-periods", "1", 14, "Pulses per cycle on each phase, n.", "N"),
    number_option("--load-torque", "N*m", 0.3, "Load torque.", "NM"),
    choice_option("--start", _STARTS, "State in which every cycle begins."),
    number_option("--switching-phase", "rad", 0.0, "Drive phase of A at the switching.", "RAD"),
    click.option("--phase-lead", type=click.Choice(("1", "-1")), default="1", show_default=True,
                 help="Quarter periods by which B leads A."),
    choice_option("--contact", ("winkler", "hertz"), "Contact law."),
    choice_option("--resonance", ("quartic", "eq6", "printed", "euler"), "Level of the resonance."),
    choice_option("--foundation", ("harmonic", "smeared", "printed", "none"),
                  "How the friction layer stiffens the stator."),
    choice_option("--amplitude", ("measured", "forced"), "Level of the amplitude."),
    number_option("--sampling-period", "s", None,
                  "Averaging period of the speed's encoder  [default: continuous]", "S"),
)  # fmt: skip


def point_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command all options of an operating point."""
    for option in reversed(_POINT_OPTIONS):
        command = option(command)
    return command


def chosen_motor(name: str, overrides: tuple[str, ...]) -> Motor:
    """The motor that ``--motor`` and ``--set`` mean."""
    from trum_sym.errors import ParameterError
    from trum_sym.inputs.motor_file import load_motor

    values: dict[str, str] = {}
    for override in overrides:
        key, equals, value = override.partition("=")
        key = key.strip()
        if not equals or not key or not value.strip():
            raise ParameterError("--set", override, "NAME=VALUE, such as friction_coefficient=0.2")
        if key in values:
            raise ParameterError("--set", override, f"each name once; {key} was set to {values[key]} before")
        values[key] = value
    return load_motor(name).with_values(values)


def chosen_drive(options: dict[str, Any]) -> Drive:
    """The drive that an operating point's options mean."""
    from trum_sym.inputs.drive import Drive

    numbers = ("prepressure", "frequency_difference", "periods", "on_periods", "load_torque", "switching_phase")
    return Drive(
        **{name: options[name] for name in numbers}, start=options["start"], phase_lead=int(options["phase_lead"])
    )
