"""``trum-sym evaluate``."""

from __future__ import annotations

from typing import Any

import click

from trum_sym.console.options import chosen_drive, chosen_levels, chosen_motor, point_options, tolerance_option
from trum_sym.console.say import say

__all__ = ["evaluate"]


@click.command()
@point_options
@tolerance_option
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def evaluate(
    motor: str,
    overrides: tuple[str, ...],
    tolerance: float | None,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """One operating point; with no options, TRUM-60 at the paper's Table 3.

    Numbers are in the unit shown, or carry one: --frequency-difference "3 kHz".  Exit code 1 where no speed balances
    the load, or the errors' bounds miss the tolerance.
    """
    from trum_sym.model.operating_point import evaluate as evaluate_point

    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    levels, period = chosen_levels(options), options["sampling_period"]
    point = evaluate_point(machine, drive, sampling_period=period, tolerance=tolerance, **levels)
    if as_json:
        from trum_sym.console.tables import as_json_text

        say(as_json_text(point))
    else:
        from trum_sym.console.tables import as_table

        say(as_table(machine, drive, point, {**levels, "sampling_period": period}))
    return 0 if point.converged else 1
