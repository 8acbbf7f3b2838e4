"""``trum-sym speed-table``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    box_options,
    check_plot,
    chosen_box,
    chosen_held,
    chosen_levels,
    chosen_motor,
    examples,
    held_options,
    number_option,
    plot_options,
)
from trum_sym.console.say import say

__all__ = ["speed_table"]


@click.command(
    "speed-table",
    epilog=examples(
        "trum-sym speed-table --from '500 arcsec/s' --to '50000 arcsec/s' --load-torque '0.05 N m' --prepressure 180 "
        "--points 3",
        "trum-sym speed-table --from '500 arcsec/s' --to '50000 arcsec/s' --load-torque 0.05 --prepressure 180 "
        "--points 3 --out table.h",
    ),
)
@click.option("--from", "slowest", required=True, metavar="SPEED", help='Slowest speed: "500 arcsec/s".')
@click.option("--to", "fastest", required=True, metavar="SPEED", help='Fastest speed: "50000 arcsec/s".')
@click.option(
    "--direction",
    type=click.Choice(("both", "positive", "negative")),
    default="both",
    show_default=True,
    help="Sign of the mean speed.",
)
@number_option("--points", "1", 31, "Speeds in each direction, in equal ratios; more are added as needed.", "K")
@number_option("--error", "1", 0.01, "Allowed error of interpolated speeds, over the speed.", "E")
@click.option(
    "--constraint", "constraints", multiple=True, metavar="TEXT", help='"stall_torque >= 0.1 N*m", as for optimize.'
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the table: .csv, or .h for a C header that interpolates.",
)
@held_options
@plot_options("Draw the drive against the speed")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a summary; SI units.")
@box_options
def speed_table(
    slowest: str,
    fastest: str,
    direction: str,
    points: Any,  # noqa: ANN401  # a number, which has to be an integer
    error: float,
    constraints: tuple[str, ...],
    spreads: tuple[str, ...],
    out: Path | None,
    plot: Path | None,
    force: bool,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """The drive for every mean speed of a range, for a controller to interpolate.

    Exit code 1 where the box has none of the speeds; gaps are named.
    """
    from trum_sym.output.files import check_new
    from trum_sym.studies.speed_table import speed_table as make

    if out is not None:
        check_new("--out", out, (".csv", ".h"), force)
    check_plot(plot, force)
    held = chosen_held(options, spreads)
    machine, (drive, bounds) = chosen_motor(motor, overrides), chosen_box(options)
    table = make(
        machine,
        drive,
        slowest=slowest,
        fastest=fastest,
        direction=direction,
        points=points,
        error=error,
        bounds=bounds,
        constraints=constraints,
        **held,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    say(table.to_json() if as_json else table.to_text())
    if not table.segments:
        return 1
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.table(table), plot)
    if out is not None:
        table.save(out, "--out")
        if not as_json:
            say(f"\n{out}: {len(table)} entries")
    return 0
