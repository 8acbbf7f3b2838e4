"""``trum-sym pareto``."""

from __future__ import annotations

import sys
from typing import Any

import click

from trum_sym.console.options import (
    chosen_drive,
    chosen_levels,
    chosen_motor,
    number_option,
    point_options,
    refuse_sampling_period,
)
from trum_sym.console.say import say
from trum_sym.text import one_line

__all__ = ["pareto"]


@click.command()
@click.option(
    "--objective",
    default="volatility",
    show_default=True,
    metavar="NAME|EXPRESSION",
    help="What is to be small, as for optimize.",
)
@click.option(
    "--against",
    default="torque-margin",
    show_default=True,
    metavar="NAME|EXPRESSION",
    help="torque-margin (large), speed-error (small), or arithmetic on figures (small).",
)
@click.option("--target-speed", metavar="SPEED", help='Mean speed to hold, or to be near: "633 arcsec/s".')
@number_option("--points", "1", 11, "Limits along the front.", "K")
@click.option("--bounds", "bounds", multiple=True, metavar="NAME=LOW:HIGH", help="As for optimize.")
@click.option("--constraint", "constraints", multiple=True, metavar="TEXT", help="As for optimize.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
@point_options
def pareto(
    objective: str,
    against: str,
    target_speed: str | None,
    points: Any,  # noqa: ANN401  # a number, which has to be an integer
    bounds: tuple[str, ...],
    constraints: tuple[str, ...],
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """Operating points that cannot be bettered in one figure without losing in another.

    Exit code 1 where no point of the box meets the constraints.
    """
    from trum_sym.console.optimize import ranges_of
    from trum_sym.studies.pareto import pareto as find

    refuse_sampling_period(options)
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    front = find(
        machine,
        drive,
        objective=objective,
        against=against,
        target_speed=target_speed,
        points=points,
        bounds=ranges_of(bounds),
        constraints=constraints,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: {objective} against {against}" + (f" at {target_speed}" if target_speed else "")
    say(front.as_json_text() if as_json else front.as_table(f"{title}, {drive.load_text()}"))
    return 0 if front.status == "solved" else 1
