"""``trum-sym tolerance``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import chosen_drive, chosen_levels, chosen_motor, number_option, point_options
from trum_sym.console.say import say

if TYPE_CHECKING:
    from trum_sym.model.operating_point import OperatingPoint

__all__ = ["tolerance"]

_MAX_BYTES = 10_000_000  # of an optimiser's point
_OF_POINT = ("prepressure", "frequency_difference", "periods", "on_periods")


@click.command()
@point_options
@click.option(
    "--vary",
    multiple=True,
    metavar="NAME[=DISTRIBUTION]",
    help="An uncertain number of motor or drive; motor stands for all that the motor file gives a range or a "
    "distribution.  DISTRIBUTION: uniform:LOW:HIGH, triangular:LOW:MODE:HIGH, or normal or "
    "lognormal:MEAN:STANDARD_DEVIATION[:LOW:HIGH].  [default: motor]",
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
@number_option("--tolerance", "1", 1e-6, "Of the rotor's speeds, relative to the largest.", "T")
@click.option(
    "--point",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Take the drive from an optimiser's point, as optimize --json prints it.",
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
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units.")
def tolerance(
    motor: str,
    overrides: tuple[str, ...],
    vary: tuple[str, ...],
    samples: float,
    outputs: tuple[str, ...],
    target: tuple[str, ...],
    seed: float,
    tolerance: float,
    point: Path | None,
    plot: Path | None,
    out: Path | None,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """How uncertain parameters spread an operating point's figures, and which to measure first."""
    from trum_sym.output.files import check_packages, check_target, write

    if plot is not None:
        from trum_sym.plots.tolerance import check_picture

        check_picture("--plot", plot)
    if out is not None:
        check_target("--out", out)
        check_packages(out)
    expected = _take_point(point, options) if point is not None else None
    from trum_sym.uncertainty.study import tolerance as study_of

    study = study_of(
        chosen_motor(motor, overrides),
        chosen_drive(options),
        parameters=_chosen(vary) if vary else None,
        samples=samples,  # type: ignore[arg-type]
        outputs=outputs,
        target=target,
        seed=seed,  # type: ignore[arg-type]
        tolerance=tolerance,
        progress=True,
        sampling_period=options["sampling_period"],
        **chosen_levels(options),
    )
    if expected is not None:
        _compare(expected, study.nominal)
    if out is not None:
        write("--out", study.dataset(), out)
    if plot is not None:
        from trum_sym.plots.tolerance import draw

        draw("--plot", study, plot)
    from trum_sym.uncertainty.tables import as_json_text, as_text

    say(as_json_text(study) if as_json else as_text(study))


def _chosen(vary: tuple[str, ...]) -> dict[str, str | None]:
    """The uncertain parameters by name, each once."""
    from trum_sym.errors import ParameterError

    chosen: dict[str, str | None] = {}
    for text in vary:
        name, equals, distribution = (part.strip() for part in text.partition("="))
        if not name or (equals and not distribution):
            raise ParameterError("--vary", text, "NAME or NAME=DISTRIBUTION, such as prepressure=normal:180:5")
        if name in chosen:
            raise ParameterError("--vary", text, "each name once")
        chosen[name] = distribution or None
    return chosen


def _take_point(path: Path, options: dict[str, Any]) -> float | None:
    """Put an optimiser's point into the options; returns the mean speed that it expects (rad/s)."""
    import json

    from trum_sym.errors import ParameterError
    from trum_sym.inputs.checks import number
    from trum_sym.inputs.domain import Domain
    from trum_sym.inputs.reading import read_text

    context = click.get_current_context()
    for name in _OF_POINT:
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            raise ParameterError(f"--{name.replace('_', '-')}", options[name], "no value here: --point FILE gives it")
    try:
        found = json.loads(read_text(path, _MAX_BYTES))
    except (OSError, ValueError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not JSON"
        raise ParameterError("--point", str(path), f"a file that trum-sym optimize --json wrote ({reason})") from None
    if not isinstance(found, dict):
        raise ParameterError("--point", str(path), "one JSON object, as trum-sym optimize --json prints it")
    for name in _OF_POINT:
        value = found.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float):
            status = f" (its status is {found['status']})" if found.get("status", "solved") != "solved" else ""
            raise ParameterError(f"--point, {name}", value, f"a number{status}")
        options[name] = value
    speed = found.get("mean_speed")
    return None if speed is None else float(number("--point, mean_speed", speed, Domain(), "rad/s"))


def _compare(expected: float, nominal: OperatingPoint) -> None:
    """Warn if the point does not do here what its file says."""
    import warnings

    from trum_sym.errors import ValidityWarning

    swing = max(abs(float(nominal.max_speed)), abs(float(nominal.min_speed)))
    if not abs(float(nominal.mean_speed) - expected) <= 1e-3 * swing:
        warnings.warn(
            f"--point: its mean speed is {expected:.6g} rad/s, here it is {float(nominal.mean_speed):.6g} rad/s; give "
            "the motor, load, start and levels that it was found for",
            ValidityWarning,
            stacklevel=2,
        )
