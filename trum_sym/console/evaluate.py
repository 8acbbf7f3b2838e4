"""``trum-sym evaluate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import (
    check_plot,
    chosen_drive,
    chosen_levels,
    chosen_motor,
    chosen_spreads,
    examples,
    holding_options,
    method_option,
    plot_options,
    point_options,
    tolerance_option,
)
from trum_sym.console.say import say
from trum_sym.model.levels import Method

if TYPE_CHECKING:
    from trum_sym.model.coupled_point import CoupledPoint
    from trum_sym.model.operating_point import OperatingPoint

__all__ = ["evaluate"]


@click.command(
    epilog=examples(
        "trum-sym evaluate",
        "trum-sym evaluate --load-torque '0.1 N m' --sampling-period '2 ms'",
        "trum-sym evaluate --set friction_coefficient=0.3 --json",
        "trum-sym evaluate --load-torque 0.1 --out point.csv --plot point.png",
        "trum-sym evaluate --load-torque 0.1 --hold-within '1 %' --spread prepressure='+-0.2 N'",
        "trum-sym evaluate --coupling contact --compliance flange",
    )
)
@point_options
@tolerance_option
@method_option
@holding_options
@plot_options("Draw the rotor's speed over two cycles")
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="FILE", help="Write the figures with their units: .csv or .nc."
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def evaluate(
    motor: str,
    overrides: tuple[str, ...],
    tolerance: float | None,
    method: Method,
    within: float | None,
    spreads: tuple[str, ...],
    plot: Path | None,
    force: bool,
    out: Path | None,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """One operating point; with no options, TRUM-60 at the paper's Table 3.

    Numbers are in the unit shown, or carry one: --frequency-difference "3 kHz".  Exit code 1 where no speed balances
    the load, or the errors' bounds miss the tolerance; with --coupling contact also where no orbit attracts.
    """
    from trum_sym.model.operating_point import evaluate as evaluate_point

    check_plot(plot, force)
    if out is not None:
        from trum_sym.output.files import check_new, check_packages

        check_new("--out", out, (".csv", ".nc"), force)
        check_packages(out)
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    period = options["sampling_period"]
    levels = chosen_levels(options)
    point: OperatingPoint | CoupledPoint = evaluate_point(
        machine, drive, sampling_period=period, tolerance=tolerance, method=method, **levels
    )
    from trum_sym.model.tables import as_table, compared

    held = None
    if within is not None or spreads:
        from trum_sym.model.holding import WITHIN, holding

        held = holding(
            machine,
            drive,
            within=WITHIN if within is None else within,
            spreads=chosen_spreads(spreads),
            sampling_period=period,
            **chosen_levels(options),
        )
    if as_json:
        from trum_sym.output.json_text import json_text

        record = {**point.to_dict(), "published": compared(point)}
        say(json_text(record if held is None else held.joined(record)))
    else:
        say("\n".join([as_table(point), *(["", held.to_text()] if held is not None else [])]))
    if out is not None:
        from trum_sym.output.files import write

        write("--out", point.to_xarray().expand_dims("point"), out)
    if plot is not None:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.point(point), plot)
    return 0 if point.converged else 1
