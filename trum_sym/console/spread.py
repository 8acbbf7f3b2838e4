"""``trum-sym spread``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    IN_SWEEPS,
    check_plot,
    chosen_drive,
    chosen_levels,
    chosen_motor,
    examples,
    force_option,
    number_option,
    pairs,
    point_options,
)
from trum_sym.console.say import say

__all__ = ["spread"]


@click.command(
    epilog=examples(
        "trum-sym spread --spread friction_coefficient --samples 64",
        "trum-sym spread --spread motor --spread prepressure=normal:180:3 --spread 'load_torque=10 %' --samples 64",
        "trum-sym spread --spread frequency_difference=2990:3010 --samples 64 --target 'mean_speed >= 600 arcsec/s'",
        figures=IN_SWEEPS,
    )
)
@point_options
@click.option(
    "--spread",
    "spreads",
    multiple=True,
    metavar="NAME[=SPREAD]",
    help="An uncertain number of motor or drive; motor stands for all that the motor file gives a range or a "
    "distribution.  SPREAD: '10 %', LOW:HIGH, triangular:LOW:MODE:HIGH, or normal or "
    "lognormal:MEAN:STANDARD_DEVIATION[:LOW:HIGH]; without, what the motor file states.  [default: motor]",
)
@number_option("--samples", "1", 1024, "Samples, a power of two; each costs a point per parameter and two more.", "N")
@click.option(
    "--output",
    "outputs",
    multiple=True,
    default=("mean_speed", "speed_volatility"),
    show_default=True,
    metavar="NAME",
    help="A figure to study, as evaluate --json names it.",
)
@click.option(
    "--target", multiple=True, metavar="TEXT", help="What has to hold: --target 'mean_speed >= 600 arcsec/s'."
)
@number_option("--seed", "1", 0, "Of the samples; the same seed gives the same figures.", "N")
@number_option(
    "--tolerance", "1", 1e-6, "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2.", "T"
)
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Draw distributions and indices: .png, .svg or .pdf.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write every point: .nc (NetCDF, with every setting and unit) or .csv.",
)
@force_option
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units.")
def spread(
    motor: str,
    overrides: tuple[str, ...],
    spreads: tuple[str, ...],
    samples: float,
    outputs: tuple[str, ...],
    target: tuple[str, ...],
    seed: float,
    tolerance: float,
    plot: Path | None,
    out: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """How uncertain parameters spread an operating point's figures, and which to measure first."""
    from trum_sym.output.files import check_new, check_packages, write

    if plot is not None:
        check_plot(plot, force)
    if out is not None:
        check_new("--out", out, force=force)
        check_packages(out)
    from trum_sym.uncertainty.study import spread as study_of

    study = study_of(
        chosen_motor(motor, overrides),
        chosen_drive(options),
        spreads=pairs("--spread", spreads, "prepressure=normal:180:5", bare=True) or None,
        samples=samples,  # type: ignore[arg-type]
        outputs=outputs,
        target=target,
        seed=seed,  # type: ignore[arg-type]
        tolerance=tolerance,
        progress=True,
        sampling_period=options["sampling_period"],
        **chosen_levels(options),
    )
    if out is not None:
        write("--out", study.to_xarray(), out)
    if plot is not None:
        from trum_sym.plots.tolerance import draw

        draw("--plot", study, plot)
    say(study.to_json() if as_json else study.to_text())
