"""``trum-sym pareto``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from trum_sym.console.optimize import constraint_option, sought, target_option
from trum_sym.console.options import (
    IN_ARITHMETIC,
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
from trum_sym.text import one_line

__all__ = ["pareto"]


@click.command(
    epilog=examples(
        "trum-sym pareto --target-speed '300000 arcsec/s' --load-torque '0.05 N m' --prepressure 180 --points 3",
        "trum-sym pareto --objective ripple --load-torque 0.05 --prepressure 180 --points 3",
        figures=IN_ARITHMETIC,
    )
)
@click.option(
    "--objective",
    metavar="NAME|EXPRESSION",
    help="What is to be small, as for optimize.  [default: volatility]",
)
@click.option(
    "--against",
    default="torque-margin",
    show_default=True,
    metavar="NAME|EXPRESSION",
    help="torque-margin (large), speed-error (small), or arithmetic on figures (small).",
)
@target_option('Mean speed to hold, or to be near, in rad/s or with a unit: "633 arcsec/s".')
@number_option("--points", "1", 11, "Limits along the front.", "K")
@constraint_option("As for optimize.")
@held_options
@plot_options("Draw the front")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
@box_options
def pareto(
    objective: str | None,
    against: str,
    target_speed: str | None,
    points: Any,  # noqa: ANN401  # a number, which has to be an integer
    constraints: tuple[str, ...],
    spreads: tuple[str, ...],
    plot: Path | None,
    force: bool,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """Operating points that cannot be bettered in one figure without losing in another.

    Exit code 1 where no point of the box meets the constraints.
    """
    from trum_sym.studies.pareto import pareto as find

    check_plot(plot, force)
    held = chosen_held(options, spreads)
    machine, (drive, bounds) = chosen_motor(motor, overrides), chosen_box(options)
    aim = sought(objective, target_speed, constraints)
    front = find(
        machine,
        drive,
        objective=aim,
        against=against,
        target_speed=target_speed,
        points=points,
        bounds=bounds,
        constraints=constraints,
        **held,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: {aim} against {against}" + (
        f" at {target_speed}" if target_speed else " at any speed"
    )
    say(front.to_json() if as_json else front.to_text(f"{title}, {front.inputs.drive.load_text()}"))
    if plot is not None and front.points:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.front(front), plot)
    return 0 if front.status == "solved" else 1
