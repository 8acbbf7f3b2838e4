"""``trum-sym``: the console.  Heavy imports wait until a command runs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from trum_sym.drive import Drive
    from trum_sym.motor import Motor

__all__ = ["main"]

_LEVELS = ("contact", "resonance", "foundation", "amplitude", "sampling_period")
_STARTS = ("periodic", "steady", "rest")


class _Quantity(click.ParamType):  # type: ignore[type-arg, unused-ignore]
    """A number, bare in its SI unit or with a unit that converts to it."""

    def __init__(self, unit: str) -> None:
        self.name = unit
        self.unit = unit

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401, ARG002
        from trum_sym.units import parse_quantity

        if isinstance(value, float | int):
            return float(value)
        return parse_quantity(param.name if param and param.name else "value", str(value), self.unit)


def _option(name: str, unit: str, default: float | None, text: str, metavar: str) -> Callable[..., Any]:
    shown = False if default is None else f"{default:g}"
    return click.option(name, type=_Quantity(unit), default=default, show_default=shown, help=text, metavar=metavar)


def _choice(name: str, words: tuple[str, ...], text: str) -> Callable[..., Any]:
    return click.option(name, type=click.Choice(words), default=words[0], show_default=True, help=text)


_POINT_OPTIONS = (
    click.option("--motor", default="trum60", show_default=True, metavar="NAME|FILE",
                 help="Motor: trum60 or a TOML file."),
    click.option("--set", "overrides", multiple=True, metavar="NAME=VALUE",
                 help="Replace a value of the motor file, in its SI unit or with one: --set contact_radius='26 mm'."),
    _option("--prepressure", "N", 180.0, "Prepressure F_c.", "N"),
    _option("--frequency-difference", "Hz", 3000.0, "Drive frequency less resonance.", "HZ"),
    _option("--periods", "1", 20, "Drive pulses per cycle, m.", "M"),
    _option("--on-periods", "1", 14, "Pulses per cycle on each phase, n.", "N"),
    _option("--load-torque", "N*m", 0.3, "Load torque.", "NM"),
    _choice("--start", _STARTS, "State in which every cycle begins."),
    _option("--switching-phase", "rad", 0.0, "Drive phase of A at the switching.", "RAD"),
    click.option("--phase-lead", type=click.Choice(("1", "-1")), default="1", show_default=True,
                 help="Quarter periods by which B leads A."),
    _choice("--contact", ("winkler", "hertz"), "Contact law."),
    _choice("--resonance", ("quartic", "eq6", "printed", "euler"), "Level of the resonance."),
    _choice("--foundation", ("harmonic", "smeared", "printed", "none"), "How the friction layer stiffens the stator."),
    _choice("--amplitude", ("measured", "forced"), "Level of the amplitude."),
    _option("--sampling-period", "s", None, "Averaging period of the speed's encoder  [default: continuous]", "S"),
)  # fmt: skip


def _point_options(command: Callable[..., Any]) -> Callable[..., Any]:
    for option in reversed(_POINT_OPTIONS):
        command = option(command)
    return command


def _motor(name: str, overrides: tuple[str, ...]) -> Motor:
    from trum_sym.errors import ParameterError
    from trum_sym.motor_file import load_motor

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


def _drive(options: dict[str, Any]) -> Drive:
    from trum_sym.drive import Drive

    numbers = ("prepressure", "frequency_difference", "periods", "on_periods", "load_torque", "switching_phase")
    return Drive(
        **{name: options[name] for name in numbers}, start=options["start"], phase_lead=int(options["phase_lead"])
    )


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(package_name="trum-sym")
def _cli() -> None:
    """Travelling-wave ultrasonic motors at very low speed (superimposed pulse driving).

    Exit codes: 0 done; 1 the work was done and its answer is no; 2 bad input.
    """


@_cli.command()
@_point_options
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def evaluate(motor: str, overrides: tuple[str, ...], as_json: bool, **options: Any) -> None:  # noqa: ANN401
    """One operating point; with no options, TRUM-60 at the paper's Table 3.

    Numbers are in the unit shown, or carry one: --frequency-difference "3 kHz".
    """
    from trum_sym.operating_point import evaluate as evaluate_point

    machine, drive = _motor(motor, overrides), _drive(options)
    levels = {name: options[name] for name in _LEVELS}
    point = evaluate_point(machine, drive, **levels)
    if as_json:
        from trum_sym.tables import as_json_text

        click.echo(as_json_text(point))
    else:
        from trum_sym.tables import as_table

        click.echo(as_table(machine, drive, point, levels))


@_cli.command()
@_point_options
@_option("--cycles", "1", 1, "Drive cycles.", "K")
@_option("--samples-per-period", "1", 64, "Samples in a drive period.", "K")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the histories: .nc (NetCDF, with every setting and unit) or .csv.  [default: a summary]",
)
def simulate(
    motor: str,
    overrides: tuple[str, ...],
    cycles: float,
    samples_per_period: float,
    out: Path | None,
    **options: Any,  # noqa: ANN401
) -> None:
    """Time histories of one operating point on its periodic orbit.

    Phases, surface, determinant, contact, friction, and the rotor's speed and angle.
    """
    from trum_sym.files import check_target, write
    from trum_sym.histories import simulate as simulate_point

    if out is not None:
        check_target("--out", out)
    levels = {name: options[name] for name in _LEVELS}
    histories = simulate_point(
        _motor(motor, overrides), _drive(options), cycles=cycles, samples_per_period=samples_per_period, **levels
    )
    if out is not None:
        write("--out", histories, out)
        click.echo(f"{out}: {histories.sizes['time']} times of {len(histories.data_vars)} histories")
    else:
        from trum_sym.tables import histories_table

        click.echo(histories_table(histories))


@_cli.command()
@click.option("--equation", metavar="ID", help="The paper's number, such as 6 or A13: its derivation written out.")
@click.option("--json", "as_json", is_flag=True, help="The records instead of a table.")
def equations(equation: str | None, as_json: bool) -> None:
    """The ledger: what the paper printed, what follows from first principles, the verdict and its effect."""
    from trum_sym.ledger import load_ledger, select, table, written_out

    records = load_ledger()
    chosen = records if equation is None else [select(records, equation)]
    if as_json:
        import json

        click.echo(json.dumps(chosen, indent=1, ensure_ascii=False))
    elif equation is not None:
        click.echo(written_out(chosen[0]))
    else:
        click.echo(table(chosen))


def _one_line(message: str) -> str:
    return " ".join(message.split())


def main(arguments: list[str] | None = None) -> int:
    """Run the console; returns the exit code and never lets a traceback through for bad input."""
    import warnings

    def show(message: Warning | str, *_: object, **__: object) -> None:
        click.echo(f"trum-sym: warning: {_one_line(str(message))}", err=True)

    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = show
        try:
            result = _cli.main(args=arguments, prog_name="trum-sym", standalone_mode=False)
        except click.exceptions.NoArgsIsHelpError as help_shown:
            click.echo(help_shown.format_message())
            return 2
        except click.ClickException as error:
            click.echo(f"trum-sym: {_one_line(error.format_message())}", err=True)
            return 2
        except click.Abort:
            click.echo("trum-sym: interrupted", err=True)
            return 130
        except ValueError as error:
            from trum_sym.errors import ParameterError

            if not isinstance(error, ParameterError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 2
        except ImportError as error:
            from trum_sym.errors import MissingExtraError

            if not isinstance(error, MissingExtraError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 2
        except RuntimeError as error:
            from trum_sym.errors import ConvergenceError

            if not isinstance(error, ConvergenceError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 1
    return result if isinstance(result, int) else 0


if __name__ == "__main__":
    sys.exit(main())
