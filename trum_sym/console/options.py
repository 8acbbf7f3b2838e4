"""Options that the commands share, and what they become: a motor, a drive, levels.

Each field of the drive and of the levels is an option of the same name, with the unit, default and text that the field
carries: a new one is added there and nowhere else.  A command that searches takes ranges for some of them: one value
holds the quantity, ``LOW:HIGH`` frees it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import Field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from trum_sym.console.words import typed
from trum_sym.inputs.drive import BOX_NAMES, Drive
from trum_sym.model.levels import LEVEL_NAMES, METHODS, LevelChoice, Levels
from trum_sym.quantities import COUPLED, MORE, QUANTITIES, in_help

if TYPE_CHECKING:
    from trum_sym.inputs.motor import Motor

__all__ = [
    "COUPLED_LEVELS",
    "FREED",
    "IN_ARITHMETIC",
    "IN_SWEEPS",
    "QuantityType",
    "box_options",
    "check_plot",
    "choice_option",
    "chosen_box",
    "chosen_drive",
    "chosen_held",
    "chosen_levels",
    "chosen_motor",
    "chosen_spreads",
    "continuous_options",
    "examples",
    "force_option",
    "held_options",
    "holding_options",
    "method_option",
    "number_option",
    "option_name",
    "pairs",
    "plain_wave_options",
    "plot_options",
    "point_options",
    "robust_held_options",
    "schedule_options",
    "tolerance_option",
]

FREED = (
    "prepressure",
    "frequency_difference",
    "switching_phase",
    "load_torque",
    "periods",
    "on_periods",
    "phase_lead",
)
"""What a search may vary: these options take ``LOW:HIGH``."""

IN_SWEEPS = (*QUANTITIES, *(name for name in COUPLED if name not in QUANTITIES))
"""Figures that ``sweep`` and ``spread`` compute; those of a wave that feels the rotor with coupling alone."""
IN_ARITHMETIC = (*QUANTITIES, *(name for name in MORE if name in ("speed_deviation", "peak_pressure")))
"""Those of objectives and constraints."""


class QuantityType(click.ParamType):  # type: ignore[type-arg, unused-ignore]
    """A number, bare in its SI unit or with a unit that converts to it."""

    def __init__(self, unit: str) -> None:
        self.name = unit
        self.unit = unit

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401
        """The value in the SI unit."""
        from trum_sym.inputs.units import parse_quantity

        if isinstance(value, float | int):
            return float(value)
        name = param.name if param and param.name else "value"
        found = parse_quantity(name, str(value), self.unit)
        typed(ctx, name, str(value).strip(), found)
        return found


class RangeType(click.ParamType):  # type: ignore[type-arg, unused-ignore]
    """``VALUE`` or ``LOW:HIGH``, each with or without a unit; read where the motor is known."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:  # noqa: ANN401, ARG002
        """As it is."""
        return repr(value) if isinstance(value, float | int) else str(value)


def number_option(
    name: str, unit: str, default: float | None, text: str, metavar: str, argument: str | None = None
) -> Callable[..., Any]:
    """An option that takes a quantity; ``argument`` is what Python calls it, if that is another word."""
    if default is not None:  # click would put a default that is text in brackets
        text += f"  [default: {default:g}{'' if unit == '1' else f' {unit}'}]"
    names = (name,) if argument is None else (name, argument)
    return click.option(*names, type=QuantityType(unit), default=default, help=text, metavar=metavar)


def choice_option(name: str, words: tuple[str, ...], text: str) -> Callable[..., Any]:
    """An option that takes one of some words, the first if not given."""
    return click.option(name, type=click.Choice(words), default=words[0], show_default=True, help=text)


def _drive_option(quantity: Field[Any]) -> Callable[..., Any]:
    """The option of one field of the drive or of a schedule."""
    about, name = quantity.metadata, option_name(quantity.name)
    if "words" in about:
        return choice_option(name, about["words"], about["text"])
    default: float | None = quantity.default  # type: ignore[assignment]  # every quantity has one
    return number_option(name, about["unit"], default, about["text"], about["metavar"])


def _range_option(quantity: Field[Any]) -> Callable[..., Any]:
    """The option of a field of the drive that a search may vary."""
    about, default = quantity.metadata, f"{quantity.default:g}"
    if about.get("unit", "1") != "1":
        default += f" {about['unit']}"
    default = "the motor file's range" if quantity.name in BOX_NAMES else default
    text = f"{about['text'].rstrip('.')}: a value holds it, LOW:HIGH frees it.  [default: {default}]"
    # the load has its default here, so that a motor of one's own is told whose it is
    own = f"{quantity.default:g}" if quantity.name == "load_torque" else None
    return click.option(option_name(quantity.name), type=RangeType(), default=own, help=text, metavar="VALUE|LOW:HIGH")


COUPLED_LEVELS = ("resonance", "foundation", "amplitude", "compliance")
"""Levels that a wave which feels the rotor has a choice of."""
WITHIN_DEFAULT = 0.01
"""Of ``--hold-within`` where it has one; that of :func:`trum_sym.holding`, which takes NumPy to import."""


def option_name(name: str) -> str:
    """How the console calls a parameter."""
    return "--" + name.replace("_", "-")


def examples(*lines: str, figures: tuple[str, ...] = ()) -> str:
    """Examples at the end of a command's help, a test runs each; before them the figures that options name."""
    known = in_help(figures) + "\n\n" if figures else ""
    return known + "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def _take_point(ctx: click.Context, _: click.Parameter, path: Path | None) -> None:
    """Let a point's file stand for the options that are not given."""
    if path is None:
        return
    from trum_sym.console.point_file import read_point

    found = read_point(path)
    ctx.meta["trum_sym.point"] = found
    known = {p.name for p in ctx.command.params}
    ctx.default_map = {**(ctx.default_map or {}), **{k: v for k, v in found.options.items() if k in known}}


_MOTOR = (
    click.option("--motor", default="trum60", show_default=True, metavar="NAME|FILE", help="trum60 or a TOML file."),
    click.option(
        "--set",
        "overrides",
        multiple=True,
        metavar="NAME=VALUE",
        help="Replace a value of the motor file, in its SI unit or with one: --set contact_radius='26 mm'.",
    ),
)
_POINT = click.option(
    "--point",
    type=click.Path(path_type=Path),
    metavar="FILE[#K]",
    is_eager=True,
    expose_value=False,
    callback=_take_point,
    help="What is not given is taken from a point that any command wrote with --json; K-th of several.",
)
_LEVELS = tuple(
    choice_option(option_name(level.name), level.metadata["words"], level.metadata["text"]) for level in fields(Levels)
)
_SAMPLING = number_option(
    "--sampling-period", "s", None, "Averaging period of the speed's encoder  [default: continuous]", "S"
)


_HOLDS = click.option(
    "--holds",
    multiple=True,
    metavar="LIMIT|NAME=LIMIT",
    help="The most that the spread of an input may move the speed by, as a share of it or a speed: '10 %', "
    "friction_coefficient='60 arcsec/s'; repeat it for more.",
)
_STARTS = click.option(
    "--starts", metavar="TIME", help="At its speed from rest within this time, and not driven back: '10 ms'."
)


def held_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a search what asks for points that can be held: ``--holds``, ``--starts``, ``--spread`` and so on."""
    return _given(command, (_HOLDS, _STARTS, _SAMPLING, *_holding(WITHIN_DEFAULT)))


def robust_held_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The same without ``--spread``, which says more there."""
    return _given(command, (_HOLDS, _STARTS, _SAMPLING, _holding(WITHIN_DEFAULT)[0]))


def chosen_held(options: dict[str, Any], spreads: tuple[str, ...] | None) -> dict[str, Any]:
    """What :func:`held_options` gave, as ``ts.optimize`` takes it; ``options`` loses it."""
    from trum_sym.errors import ParameterError

    holds: Any = None
    for text in options.pop("holds"):
        name, equals, limit = (part.strip() for part in text.partition("="))
        if not equals:
            if holds is not None:
                raise ParameterError("--holds", text, "one limit for all inputs, or NAME=LIMIT for each")
            holds = text
        elif isinstance(holds, str) or not limit or name in (holds or {}):
            raise ParameterError("--holds", text, "one limit for all inputs, or NAME=LIMIT for each, each name once")
        else:
            holds = {**(holds or {}), name: limit}
    return {
        "holds": holds,
        "starts": options.pop("starts"),
        "within": options.pop("within"),
        "sampling_period": options.pop("sampling_period"),
        **({} if spreads is None else {"spreads": chosen_spreads(spreads)}),
    }


def _holding(within: float | None) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """``--hold-within`` and ``--spread``; without a default for the first, nothing is said unless asked."""
    hold = number_option(
        "--hold-within",
        "1",
        within,
        "Say what it takes to hold the speed within this share of it: slopes, drifts, precision, start, return"
        + (".  [default: not said]" if within is None else "."),
        "SHARE",
        "within",
    )
    spread = click.option(
        "--spread",
        "spreads",
        multiple=True,
        metavar="NAME=AMOUNT",
        help="How far an input may be off: prepressure='+-1 N', friction_coefficient='1 %'; repeat it for more.  "
        "[default: the motor file's spreads]",
    )
    return hold, spread


def holding_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options ``--hold-within`` and ``--spread`` of a point, of which nothing is said unless asked."""
    return _given(command, _holding(None))


def chosen_spreads(spreads: tuple[str, ...]) -> dict[str, str | None] | None:
    """How far inputs may be off, by name, as ``ts.holding`` takes it."""
    return pairs("--spread", spreads, "prepressure='+-1 N'") or None


def force_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the option ``--force``: files that exist are replaced by nothing else."""
    return click.option("--force", is_flag=True, help="Replace files that exist.")(command)


def plot_options(text: str) -> Callable[..., Any]:
    """The options ``--plot`` and ``--force``."""

    def given(command: Callable[..., Any]) -> Callable[..., Any]:
        plot = click.option(
            "--plot", type=click.Path(path_type=Path), metavar="FILE", help=f"{text} (.png, .svg, .pdf)."
        )
        return _given(command, (plot, force_option))

    return given


def check_plot(plot: Path | None, force: bool) -> None:
    """Refuse, before any work is done, a picture that cannot be written, or would replace a file.

    Raises
    ------
    ParameterError
        For another suffix, a place that cannot be written to, or a file that exists and no ``--force``.
    MissingExtraError
        Without matplotlib.
    """
    if plot is None:
        return
    from trum_sym.errors import MissingExtraError
    from trum_sym.output.files import check_new

    check_new("--plot", plot, (".png", ".svg", ".pdf"), force)
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtraError("a picture", "matplotlib", "report") from None


def tolerance_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the option ``--tolerance``, which is None where it is not given."""
    text = (
        "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2  "
        "[default: 1e-6, or what four digits of the mean speed need]"
    )
    option: Callable[..., Any] = number_option("--tolerance", "1", None, text, "T")(command)
    return option


def method_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the option ``--method``."""
    text = "How orbits are found: in adaptive steps, on a grid of equal ones, or by what is faster at the tolerance."
    option: Callable[..., Any] = choice_option("--method", METHODS, text)(command)
    return option


def point_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command all options of an operating point."""
    return continuous_options(_SAMPLING(command))


def continuous_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command all options of an operating point but the encoder's."""
    drive = (_drive_option(quantity) for quantity in fields(Drive))
    return _given(command, (*_MOTOR, _POINT, *drive, *_LEVELS))


def plain_wave_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command motor and what counts of drive and levels for a plain wave that the rotor acts back on."""
    drive = (_drive_option(q) for q in fields(Drive) if q.name in ("prepressure", "load_torque", "phase_lead"))
    kept = zip(fields(Levels), _LEVELS, strict=True)
    levels = (option for level, option in kept if level.name in ("resonance", "amplitude", "compliance"))
    return _given(command, (*_MOTOR, *drive, *levels))


def schedule_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command motor, a schedule with what counts of the drive beside it, and the levels that coupling knows."""
    from trum_sym.inputs.schedule import SCHEDULES, Schedule

    known = ("prepressure", "frequency_difference", "load_torque", "load_inertia", "switching_phase", "phase_lead")
    drive = (_drive_option(q) for q in fields(Drive) if q.name in known)
    kind, *numbers = fields(Schedule)
    schedule = (
        choice_option("--schedule", SCHEDULES, kind.metadata["text"]),
        *(_drive_option(quantity) for quantity in numbers),
    )
    kept = zip(fields(Levels), _LEVELS, strict=True)
    levels = (option for level, option in kept if level.name in COUPLED_LEVELS)
    return _given(command, (*_MOTOR, *schedule, *drive, *levels))


def box_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command that searches all options of an operating point, some of which take ranges."""
    drive = (_range_option(q) if q.name in FREED else _drive_option(q) for q in fields(Drive))
    return _given(command, (*_MOTOR, _POINT, *drive, *_LEVELS))


def _given(command: Callable[..., Any], options: tuple[Callable[..., Any], ...]) -> Callable[..., Any]:
    for option in reversed(options):
        command = option(command)
    return command


def pairs(option: str, texts: tuple[str, ...], example: str, *, bare: bool = False) -> dict[str, str | None]:
    """``NAME=VALUE`` of an option that may be repeated, by name, each once; None for a ``bare`` name.

    Raises
    ------
    ParameterError
        For a text of another form, or a name twice.
    """
    from trum_sym.errors import ParameterError

    found: dict[str, str | None] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not name or (not value if equals else not bare):
            raise ParameterError(option, text, ("NAME or " if bare else "") + f"NAME=VALUE, such as {example}")
        if name in found:
            raise ParameterError(option, text, f"each name once; {name} was set to {found[name]} before")
        found[name] = value or None
    return found


def chosen_motor(name: str, overrides: tuple[str, ...]) -> Motor:
    """The motor that ``--motor``, ``--set`` and ``--point`` mean."""
    from trum_sym.errors import ParameterError
    from trum_sym.inputs.motor import SPECS
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.plausible import unquestioned
    from trum_sym.inputs.units import parse_quantity

    values: dict[str, str] = pairs("--set", overrides, "friction_coefficient=0.2")  # type: ignore[assignment]
    context = click.get_current_context(silent=True)
    for key, text in values.items():
        if key in SPECS:
            try:
                typed(context, key, text, parse_quantity(key, text, SPECS[key].unit))
            except ParameterError:
                continue  # with_values says what is wrong
    point = context.meta.get("trum_sym.point") if context else None
    given = context is not None and context.get_parameter_source("motor") is click.core.ParameterSource.COMMANDLINE

    def stated() -> Motor:
        if point is not None and not given:
            return cast("Motor", point.motor())
        machine = load_motor(name)
        if context is not None and name != "trum60" and machine.name != load_motor().name:
            _warn_borrowed(context)
        return machine

    if not values:
        return stated()
    with unquestioned():  # with_values warns of what is left
        machine = stated()
    return machine.with_values(values)


def _warn_borrowed(context: click.Context) -> None:
    """Say which numbers of the drive are the TRUM-60's, where a motor of one's own is driven by them."""
    import warnings

    from trum_sym.errors import ValidityWarning

    options = {p.name: p for p in context.command.params if isinstance(p, click.Option)}
    left = [
        f"{option_name(quantity.name)} {quantity.default:g}"
        for quantity in fields(Drive)
        if quantity.name in ("prepressure", "frequency_difference", "load_torque")
        and quantity.name in options
        and options[quantity.name].default is not None
        and context.get_parameter_source(quantity.name) is click.core.ParameterSource.DEFAULT
    ]
    if left:
        warnings.warn(f"not given, so as for TRUM-60: {', '.join(left)}", ValidityWarning, stacklevel=2)


def chosen_drive(options: dict[str, Any]) -> Drive:
    """The drive that an operating point's options mean."""
    values = {q.name: options[q.name] for q in fields(Drive) if options[q.name] is not None}
    if "phase_lead" in values:
        values["phase_lead"] = int(values["phase_lead"])
    return Drive(**values)


def chosen_box(options: dict[str, Any]) -> tuple[Drive, dict[str, Any]]:
    """The drive without what may vary, and ``bounds`` as ``ts.optimize`` takes them."""
    from trum_sym.errors import ParameterError

    bounds: dict[str, Any] = {}
    for name in FREED:
        text = options[name]
        if text is None:
            continue
        ends = [end.strip() for end in text.split(":")]
        if not all(ends) or len(ends) > 2:
            raise ParameterError(option_name(name), text, "a value, which holds it, or LOW:HIGH, which frees it")
        bounds[name] = (ends[0], ends[1]) if len(ends) == 2 else ends[0]
    return chosen_drive({**options, **dict.fromkeys(FREED)}), bounds


def chosen_levels(options: dict[str, Any]) -> LevelChoice:
    """The levels that an operating point's options mean, as keyword arguments."""
    return cast("LevelChoice", {name: options[name] for name in LEVEL_NAMES})
