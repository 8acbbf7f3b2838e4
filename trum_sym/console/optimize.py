"""``trum-sym optimize``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import chosen_drive, chosen_levels, chosen_motor, point_options, refuse_sampling_period
from trum_sym.console.say import say
from trum_sym.text import one_line

__all__ = ["optimize", "ranges_of"]


@click.command()
@point_options
@click.option(
    "--objective",
    default="volatility",
    show_default=True,
    metavar="NAME|EXPRESSION",
    help="volatility, q-volatility, speed-error, ripple, wear, or arithmetic on figures.",
)
@click.option("--target-speed", metavar="SPEED", help='Mean speed to reach, rad/s or with a unit: "633 arcsec/s".')
@click.option(
    "--bounds",
    "bounds",
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="Range of prepressure, frequency_difference, periods or on_periods; NAME=VALUE holds it.  "
    "[default: prepressure=160:210, frequency_difference=2800:3300]",
)
@click.option(
    "--constraint",
    "constraints",
    multiple=True,
    metavar="TEXT",
    help='"stall_torque >= 0.35 N*m": arithmetic on figures, >=, <= or ==, a value.',
)
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Draw the box: speeds, the target, borders of the constraints, the optimum (.png, .svg, .pdf).",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def optimize(
    motor: str,
    overrides: tuple[str, ...],
    objective: str,
    target_speed: str | None,
    bounds: tuple[str, ...],
    constraints: tuple[str, ...],
    plot: Path | None,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """The operating point of least objective in a box of prepressure and frequency difference, under constraints.

    Exit code 1 where no point of the box meets them; what is nearest is shown.
    """
    from trum_sym.optimiser.result import as_json_text, as_table
    from trum_sym.optimiser.search import optimize as find

    refuse_sampling_period(options)
    if plot is not None:
        from trum_sym.output.files import check_target
        from trum_sym.plots.optimum import SUFFIXES, draw

        check_target("--plot", plot, SUFFIXES)
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    found = find(
        machine,
        drive,
        objective=objective,
        target_speed=target_speed,
        bounds=ranges_of(bounds),
        constraints=constraints,
        **chosen_levels(options),
    )
    title = f"{one_line(machine.name)}: least {objective}" + (f" at {target_speed}" if target_speed else "")
    say(as_json_text(found) if as_json else as_table(found, f"{title}, {drive.load_text()}"))
    if plot is not None:
        draw(found, plot, "--plot")
    return 0 if found.status == "solved" else 1


def ranges_of(texts: tuple[str, ...]) -> dict[str, Any]:
    """Bounds by name, as ``optimize`` takes them."""
    from trum_sym.errors import ParameterError

    found: dict[str, Any] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        ends = [end.strip() for end in value.split(":")]
        name = name.strip().replace("-", "_")
        if not equals or not name or not all(ends) or len(ends) > 2:
            raise ParameterError("--bounds", text, "NAME=LOW:HIGH, such as prepressure=160:210")
        if name in found:
            raise ParameterError("--bounds", text, "each name once")
        found[name] = (ends[0], ends[1]) if len(ends) == 2 else ends[0]
    return found
