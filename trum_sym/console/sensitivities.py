"""``trum-sym sensitivities``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    check_plot,
    chosen_drive,
    chosen_levels,
    chosen_motor,
    continuous_options,
    examples,
    number_option,
    plot_options,
)
from trum_sym.console.say import say

__all__ = ["sensitivities"]


@click.command(
    epilog=examples(
        "trum-sym sensitivities --load-torque '0.1 N m'",
        "trum-sym sensitivities --point point.json --json",
        "trum-sym sensitivities --load-torque 0.1 --plot slopes.png",
        "trum-sym sensitivities --coupling contact --compliance flange --tolerance 1e-4",
    )
)
@continuous_options
@number_option(
    "--tolerance", "1", 1e-6, "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2.", "T"
)
@plot_options("Draw what one percent of each input changes, the largest on top")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def sensitivities(
    motor: str,
    overrides: tuple[str, ...],
    tolerance: float,
    plot: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """How the figures of one operating point change with what it depends on.

    Of the continuous speed.  With --coupling contact differences of orbits on one branch, with estimates of their
    errors.  Exit code 1 where no speed balances the load.
    """
    import numpy as np

    from trum_sym.model.sensitivities import sensitivities as slopes_of

    check_plot(plot, force)
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    found = slopes_of(machine, drive, tolerance=tolerance, **chosen_levels(options))
    say(found.to_json() if as_json else found.to_text())
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.slopes(found), plot)
    return 0 if np.isfinite(found["mean_speed"]["prepressure"]) else 1
