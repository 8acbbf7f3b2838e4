"""``trum-sym optimize``."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

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
    plot_options,
)
from trum_sym.console.say import say
from trum_sym.text import one_line

__all__ = ["constraint_option", "optimize", "sought", "target_option"]


def constraint_option(text: str) -> Callable[..., Any]:
    """The option ``--constraint``."""
    return click.option("--constraint", "constraints", multiple=True, metavar="TEXT", help=text)


def target_option(text: str) -> Callable[..., Any]:
    """The option ``--target-speed``."""
    return click.option("--target-speed", metavar="SPEED", help=text)


def sought(objective: str | None, target_speed: str | None, constraints: tuple[str, ...]) -> str:
    """The objective: the default where something else says what is wanted.

    Raises
    ------
    ParameterError
        If nothing does.
    """
    from trum_sym.errors import ParameterError

    if objective is None and target_speed is None and not constraints:
        allowed = "a mean speed, such as '633 arcsec/s'; or an --objective or a --constraint, for any speed"
        raise ParameterError("--target-speed", "none", allowed)
    return "volatility" if objective is None else objective


@click.command(
    epilog=examples(
        "trum-sym optimize --target-speed '100000 arcsec/s' --load-torque '0.1 N m'",
        "trum-sym optimize --target-speed '1 rad/s' --prepressure 180 --frequency-difference '2.9 kHz:3.2 kHz' "
        "--load-torque 0.1",
        "trum-sym optimize --target-speed '100000 arcsec/s' --load-torque 0.1 --prepressure 180 --starts '1 ms' "
        "--constraint 'encoder_volatility <= 200 %'",
        "trum-sym optimize --objective wear --constraint 'stall_torque >= 0.2 N*m' --load-torque 0.1 --prepressure 180",
        figures=IN_ARITHMETIC,
    )
)
@box_options
@click.option(
    "--objective",
    metavar="NAME|EXPRESSION",
    help="volatility, q-volatility, speed-error, ripple, wear, encoder-volatility, drift, worst-speed-error, or "
    "arithmetic on figures.  [default: volatility]",
)
@target_option('Mean speed to reach, in rad/s or with a unit: "633 arcsec/s"; its sign is the direction.')
@constraint_option('"stall_torque >= 0.35 N*m": arithmetic on figures, >=, <= or ==, a value.')
@held_options
@plot_options("Draw the box: speeds, the target, borders of the constraints, the optimum")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def optimize(
    motor: str,
    overrides: tuple[str, ...],
    objective: str | None,
    target_speed: str | None,
    constraints: tuple[str, ...],
    spreads: tuple[str, ...],
    plot: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """The operating point of least objective in a box of prepressure and frequency difference, under constraints.

    Exit code 1 where no point of the box meets them; what is nearest is shown.
    """
    from trum_sym.optimiser.search import optimize as find

    check_plot(plot, force)
    held = chosen_held(options, spreads)
    machine, (drive, bounds) = chosen_motor(motor, overrides), chosen_box(options)
    aim = sought(objective, target_speed, constraints)
    found = find(
        machine,
        drive,
        objective=aim,
        target_speed=target_speed,
        bounds=bounds,
        constraints=constraints,
        **held,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: least {aim}" + (f" at {target_speed}" if target_speed else " at any speed")
    say(found.to_json() if as_json else found.to_text(f"{title}, {found.load_text()}"))
    if plot is not None:
        from trum_sym.plots.optimum import draw

        draw(found, plot, "--plot")
    return 0 if found.status == "solved" else 1
