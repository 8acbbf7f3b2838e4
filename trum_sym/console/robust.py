"""``trum-sym robust``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import chosen_drive, chosen_levels, chosen_motor, point_options, refuse_sampling_period
from trum_sym.console.say import say
from trum_sym.text import one_line

__all__ = ["robust"]


@click.command()
@click.option(
    "--spread",
    "tolerances",
    multiple=True,
    metavar="NAME=SHARE|LOW:HIGH",
    help='What is not known exactly: "friction_coefficient=10 %", "load_torque=0.04:0.06"; repeat it for more.',
)
@click.option(
    "--samples",
    type=click.Path(path_type=Path),
    metavar="FILE.csv",
    help="Instead: one case a row, with headers such as friction_coefficient,contact_radius [mm].",
)
@click.option(
    "--objective",
    default="volatility",
    show_default=True,
    metavar="NAME|EXPRESSION",
    help="What is to be small in the worst case, as for optimize.",
)
@click.option("--target-speed", metavar="SPEED", help="Held in the nominal case; for speed-error, in none.")
@click.option("--bounds", "bounds", multiple=True, metavar="NAME=LOW:HIGH", help="As for optimize.")
@click.option("--constraint", "constraints", multiple=True, metavar="TEXT", help="As for optimize, in every case.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units, speeds in rad/s.")
@point_options
def robust(
    tolerances: tuple[str, ...],
    samples: Path | None,
    objective: str,
    target_speed: str | None,
    bounds: tuple[str, ...],
    constraints: tuple[str, ...],
    as_json: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> int:
    """The operating point whose worst case over tolerances, or over samples, is the best.

    Exit code 1 where no point meets the constraints in every case.
    """
    from trum_sym.console.optimize import ranges_of
    from trum_sym.errors import ParameterError
    from trum_sym.studies.robust import robust as find
    from trum_sym.studies.samples import read_samples

    refuse_sampling_period(options)
    given: dict[str, Any] = {}
    for text in tolerances:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise ParameterError("--spread", text, "NAME=SHARE, such as friction_coefficient='10 %', or NAME=LOW:HIGH")
        if name in given:
            raise ParameterError("--spread", text, "each name once")
        low, colon, high = value.partition(":")
        given[name] = (low, high) if colon else value
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    found = find(
        machine,
        drive,
        objective=objective,
        tolerances=given or None,
        samples=None if samples is None else read_samples(samples),
        target_speed=target_speed,
        bounds=ranges_of(bounds),
        constraints=constraints,
        progress=sys.stderr.isatty(),
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: least worst {objective}" + (f" at {target_speed}" if target_speed else "")
    say(found.as_json_text() if as_json else found.as_table(f"{title}, {drive.load_text()}"))
    return 0 if found.status == "solved" else 1
