"""``trum-sym calibrate``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    chosen_drive,
    chosen_levels,
    chosen_motor,
    examples,
    number_option,
    point_options,
)
from trum_sym.console.say import say

__all__ = ["calibrate"]


@click.command(
    epilog=examples(
        "trum-sym calibrate examples/data/table2.csv",
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
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units, speeds in rad/s.")
@point_options
def calibrate(
    data: Path,
    parameters: tuple[str, ...],
    errors: str,
    confidence: float,
    out: Path | None,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """Fit uncertain parameters of the motor to measured data.

    DATA.csv has a header with units: prepressure [N],amplitude [um] for eq. 8; prepressure [N],resonance_frequency
    [Hz]; load_torque [N*m],mean_speed [arcsec/s] or other figures of evaluate; time [s] with displacement, velocity or
    envelope for a decay.  What has no column is taken from the options.  Exit code 1: the data cannot fix these
    parameters.
    """
    from trum_sym.calibration.calibrate import calibrate as fit_motor
    from trum_sym.calibration.tables import calibration_json, calibration_table
    from trum_sym.output.files import check_target

    if out is not None:
        check_target("--out", out, (".toml",))
    machine = chosen_motor(motor, overrides)
    found = fit_motor(
        data,
        machine,
        parameters=parameters or None,
        drive=chosen_drive(options),
        errors=errors,
        confidence=confidence,
        progress=sys.stderr.isatty(),
        sampling_period=options["sampling_period"],
        **chosen_levels(options),
    )
    say(calibration_json(found) if as_json else calibration_table(found, machine))
    if found.status != "solved":
        return 1
    if out is not None:
        from trum_sym.inputs.motor_writer import write_motor

        write_motor(found.motor, motor, out, "--out")
        if not as_json:
            say(f"\n{out}: {', '.join(e.name for e in found.estimates if e.in_motor)} calibrated")
    return 0
