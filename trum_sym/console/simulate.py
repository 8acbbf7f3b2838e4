"""``trum-sym simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
    tolerance_option,
)
from trum_sym.console.say import say

__all__ = ["simulate"]


@click.command(
    epilog=examples(
        "trum-sym simulate --load-torque '0.1 N m'",
        "trum-sym simulate --cycles 2 --out histories.csv --plot histories.png",
    )
)
@point_options
@tolerance_option
@number_option("--cycles", "1", 1, "Drive cycles.", "K")
@number_option("--samples-per-period", "1", 64, "Samples in a drive period.", "K")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the histories: .nc (NetCDF, with every setting and unit) or .csv.  [default: a summary]",
)
@plot_options("Draw phases, contact, speed and angle")
def simulate(
    motor: str,
    overrides: tuple[str, ...],
    cycles: float,
    samples_per_period: float,
    out: Path | None,
    plot: Path | None,
    force: bool,
    tolerance: float | None,
    **options: Any,  # noqa: ANN401
) -> int:
    """Time histories of one operating point on its periodic orbit.

    Phases, surface, determinant, contact, friction, and the rotor's speed and angle.  Exit code 1 where no speed
    balances the load, or the errors' bounds miss the tolerance.
    """
    from trum_sym.model.histories import simulate as simulate_point
    from trum_sym.output.files import check_new, write

    check_plot(plot, force)
    if out is not None:
        check_new("--out", out, force=force)
    histories = simulate_point(
        chosen_motor(motor, overrides),
        chosen_drive(options),
        cycles=cycles,
        samples_per_period=samples_per_period,
        sampling_period=options["sampling_period"],
        tolerance=tolerance,
        **chosen_levels(options),
    )
    if out is not None:
        write("--out", histories, out)
        say(f"{out}: {histories.sizes['time']} times of {len(histories.data_vars)} histories")
    else:
        from trum_sym.model.tables import histories_table

        say(histories_table(histories))
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.histories(histories), plot)
    return 0 if histories.attrs["converged"] else 1
