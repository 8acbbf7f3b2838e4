"""``trum-sym calibrate``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import (
    check_plot,
    chosen_drive,
    chosen_levels,
    chosen_motor,
    examples,
    number_option,
    plot_options,
    point_options,
)
from trum_sym.console.say import say

if TYPE_CHECKING:
    from trum_sym.inputs.measurements import Measurements

__all__ = ["calibrate"]


@click.command(
    epilog=examples(
        "trum-sym calibrate examples/data/table2.csv --plot fit.png",
        "trum-sym calibrate examples/data/table2.csv --fit amplitude_factor --errors relative --out my-motor.toml",
    )
)
@click.argument("data", type=click.Path(path_type=Path), metavar="DATA.csv")
@click.option(
    "--fit",
    "parameters",
    multiple=True,
    metavar="NAME",
    help="A parameter of the motor to fit; repeat it for more.  [default: by what was measured]",
)
@click.option(
    "--errors",
    type=click.Choice(("absolute", "relative")),
    default="absolute",
    show_default=True,
    help="Whether all rows scatter by the same amount, or by the same share of their value.",
)
@number_option("--confidence", "1", 0.95, "Confidence of the intervals.", "P")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="MOTOR.toml",
    help="Write the motor file with the fitted values in place.",
)
@plot_options("Draw the data, the fit and its band")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units, speeds in rad/s.")
@point_options
def calibrate(
    data: Path,
    parameters: tuple[str, ...],
    errors: str,
    confidence: float,
    out: Path | None,
    plot: Path | None,
    force: bool,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """Fit uncertain parameters of the motor to measured data.

    DATA.csv has a header with units: prepressure [N],amplitude [um] for eq. 8; prepressure [N],resonance_frequency
    [Hz]; load_torque [N*m],mean_speed [arcsec/s] or other figures of evaluate; time [s] with displacement, velocity or
    envelope for a decay; frequency [Hz] with conductance [S] and susceptance [S] for an admittance sweep without a
    rotor.  What has no column is taken from the options.  Exit code 1: the data cannot fix these parameters.
    """
    from trum_sym.calibration.calibrate import calibrate as fit_motor
    from trum_sym.inputs.measurements import read_measurements
    from trum_sym.output.files import check_new

    check_plot(plot, force)
    if out is not None:
        check_new("--out", out, (".toml",), force)
    machine = chosen_motor(motor, overrides)
    measured = read_measurements(data)
    _refuse_unused(measured)
    found = fit_motor(
        measured,
        machine,
        parameters=parameters or None,
        drive=chosen_drive(options),
        errors=errors,
        confidence=confidence,
        progress=sys.stderr.isatty(),
        sampling_period=options["sampling_period"],
        **chosen_levels(options),
    )
    say(found.to_json() if as_json else found.to_text(machine))
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.fitted(found), plot)
    if found.status != "solved":
        return 1
    if out is not None:
        from trum_sym.inputs.motor_writer import write_motor

        write_motor(found.motor, motor, out, "--out")
        if not as_json:
            say(f"\n{out}: {', '.join(e.name for e in found.estimates if e.in_motor)} calibrated")
    return 0


def _refuse_unused(measured: Measurements) -> None:
    """Refuse options that the data leave without effect.

    Raises
    ------
    ParameterError
        For a number of the drive of which the data have a column, and for an encoder where no volatility was measured.
    """
    from trum_sym.errors import ParameterError

    context = click.get_current_context()
    for option in context.command.params:
        name = option.name or ""
        if context.get_parameter_source(name) is not click.core.ParameterSource.COMMANDLINE:
            continue
        if name in measured.columns:
            raise ParameterError(option.opts[0], context.params[name], "no value here: the data have a column of it")
        if name == "sampling_period" and "speed_volatility" not in measured.columns:
            raise ParameterError(option.opts[0], context.params[name], "none: the data have no speed_volatility")
