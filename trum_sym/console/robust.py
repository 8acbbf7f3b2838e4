"""``trum-sym robust``."""

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
    pairs,
    plot_options,
    robust_held_options,
)
from trum_sym.console.say import say
from trum_sym.text import one_line

__all__ = ["robust"]


@click.command(
    epilog=examples(
        "trum-sym robust --spread 'friction_coefficient=2 %' --target-speed '300000 arcsec/s' --load-torque 0.05 "
        "--prepressure 180 --frequency-difference 2900:3000",
        "trum-sym robust --spread load_torque=0.04:0.06 --objective speed-error --target-speed '300000 arcsec/s' "
        "--load-torque 0.05 --prepressure 180 --frequency-difference 2900:3000",
        figures=IN_ARITHMETIC,
    )
)
@click.option(
    "--spread",
    "spreads",
    multiple=True,
    metavar="NAME[=SPREAD]",
    help="What is not known exactly: friction_coefficient='10 %', load_torque=0.04:0.06, or a name alone for the range "
    "that the motor file states; repeat it for more.",
)
@click.option(
    "--samples",
    type=click.Path(path_type=Path),
    metavar="FILE.csv",
    help="Instead: one case a row, with headers such as friction_coefficient,contact_radius [mm].",
)
@click.option(
    "--objective",
    metavar="NAME|EXPRESSION",
    help="What is to be small in the worst case, as for optimize.  [default: volatility]",
)
@target_option("Held in the nominal case; for speed-error, in none.  In rad/s or with a unit.")
@constraint_option("As for optimize, in every case.")
@robust_held_options
@plot_options("Draw the objective in every case")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units, speeds in rad/s.")
@box_options
def robust(
    spreads: tuple[str, ...],
    samples: Path | None,
    objective: str | None,
    target_speed: str | None,
    constraints: tuple[str, ...],
    plot: Path | None,
    force: bool,
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """The operating point whose worst case over spreads, or over samples, is the best.

    Exit code 1 where no point meets the constraints in every case.
    """
    from trum_sym.studies.robust import robust as find
    from trum_sym.studies.samples import read_samples

    given = pairs("--spread", spreads, "friction_coefficient='10 %'", bare=True)
    check_plot(plot, force)
    held = chosen_held(options, None)
    machine, (drive, bounds) = chosen_motor(motor, overrides), chosen_box(options)
    aim = sought(objective, target_speed, constraints)
    found = find(
        machine,
        drive,
        objective=aim,
        spreads=given or None,
        samples=None if samples is None else read_samples(samples),
        target_speed=target_speed,
        bounds=bounds,
        constraints=constraints,
        **held,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: least worst {aim}" + (
        f" at {target_speed}" if target_speed else " at any speed"
    )
    say(found.to_json() if as_json else found.to_text(f"{title}, {found.inputs.drive.load_text()}"))
    if plot is not None and found.cases:
        from trum_sym.plots import answers

        answers.write_picture("--plot", answers.worst_case(found), plot)
    return 0 if found.status == "solved" else 1
