"""``trum-sym track``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    box_options,
    check_plot,
    chosen_box,
    chosen_levels,
    chosen_motor,
    examples,
    number_option,
    plot_options,
)
from trum_sym.console.say import say

__all__ = ["track"]


@click.command(
    epilog=examples(
        "trum-sym track --target-speed '100000 arcsec/s' --load-torque 0.1 --prepressure 180 --duration '12 ms'",
        "trum-sym track --target-speed '100000 arcsec/s' --load-torque 0.1 --prepressure 180 --duration '8 ms' "
        "--disturb 'load_torque=+2 %@4 ms' --control-period '1 ms'",
    )
)
@click.option(
    "--target-speed",
    required=True,
    metavar="SPEED",
    help='Mean speed, in rad/s or with a unit: "633 arcsec/s"; its sign is the direction.',
)
@number_option("--duration", "s", 0.5, "Of the run.", "S")
@number_option("--control-period", "s", 2e-3, "Of the controller and its encoder.", "S")
@number_option("--encoder-counts", "1", None, "Counts of a revolution.  [default: the motor file's]", "N")
@click.option(
    "--disturb",
    "disturbances",
    multiple=True,
    metavar="NAME=CHANGE@TIME[:TIME]",
    help="A step, or a ramp between two times: 'friction_coefficient=+1 %@0.1 s:0.2 s'; of prepressure, load_torque, "
    "friction_coefficient, resonance_frequency; repeat it for more.  [default: the motor file's spreads in turn]",
)
@plot_options("Draw speed, frequency and disturbances, in closed loop and in open loop")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units, speeds in rad/s.")
@box_options
def track(
    target_speed: str,
    duration: float,
    control_period: float,
    encoder_counts: float | None,
    disturbances: tuple[str, ...],
    plot: Path | None,
    force: bool,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """A speed in closed loop: an encoder's counts, a speed table, a PI controller of the frequency, and what drifts.

    The gains follow from the motor's slopes.  Exit code 1 where the loop is unstable, or no frequency that may be set
    takes a disturbance up.
    """
    from trum_sym.studies.track import track as follow

    check_plot(plot, force)
    machine, (drive, bounds) = chosen_motor(motor, overrides), chosen_box(options)
    found = follow(
        machine,
        drive,
        target_speed=target_speed,
        duration=duration,
        control_period=control_period,
        encoder_counts=encoder_counts,
        disturbances=disturbances or None,
        bounds=bounds,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    say(found.to_json() if as_json else found.to_text())
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.tracked(found), plot)
    return 0 if found.loop.gain_margin > 1 and not found.beyond else 1
