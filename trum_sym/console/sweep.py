"""``trum-sym sweep``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import (
    IN_SWEEPS,
    QuantityType,
    check_plot,
    chosen_levels,
    chosen_motor,
    examples,
    method_option,
    number_option,
    plot_options,
    point_options,
)
from trum_sym.console.say import say
from trum_sym.model.levels import Method

if TYPE_CHECKING:
    from trum_sym.sweeps.plan import Plan
    from trum_sym.sweeps.run import Summary, Workload

__all__ = ["sweep"]


class Range(click.ParamType):  # type: ignore[type-arg, unused-ignore]
    """Text that the sweep itself reads: a number or a range."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:  # noqa: ANN401, ARG002
        """As it is."""
        return str(value)


@click.command(
    epilog=examples(
        "trum-sym sweep --prepressure 160:210:6 --out force.csv --plot force.png",
        "trum-sym sweep --prepressure 160:210:51 --frequency-difference 2800:3300:by=10 --dry-run",
        "trum-sym sweep --set friction_coefficient=0.2,0.25,0.3 --load-torque 0:0.1:3 --out friction.zarr",
        figures=IN_SWEEPS,
    )
)
@point_options
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="NAME.zarr|FILE",
    help="A Zarr store, which the same command goes on with; or a small .nc, .parquet or .csv file.",
)
@click.option("--outputs", metavar="NAME,...", help="Figures to compute, as in evaluate --json.  [default: all]")
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="A Dask scheduler, such as tcp://host:8786.  [default: this process, all cores]",
)
@number_option("--chunk", "1", None, "Points a chunk, at most.  [default: by grid and memory]", "POINTS")
@number_option(
    "--tolerance", "1", 1e-6, "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2.", "T"
)
@method_option
@plot_options("Draw lines over one axis, maps over two")
@click.option("--dry-run", is_flag=True, help="Say points, chunks, size and time, from a sample that is measured.")
def sweep(
    motor: str,
    overrides: tuple[str, ...],
    out: Path | None,
    outputs: str | None,
    scheduler: str | None,
    chunk: float | None,
    tolerance: float,
    method: Method,
    plot: Path | None,
    force: bool,
    dry_run: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """Operating points on a grid: every number may be a range, in --set too.

    \b
    160:210:51      51 values from 160 to 210, both among them
    160:210:by=1    from 160 to 210 in steps of 1
    160,180,200     these
    @forces.csv     the column of the option's name; columns of one file vary together
    """  # noqa: D301
    from trum_sym.errors import ParameterError
    from trum_sym.inputs.drive import Drive
    from trum_sym.model.levels import Levels
    from trum_sym.sweeps.plan import make_plan
    from trum_sym.sweeps.run import check_out, estimate, run

    if out is None and not dry_run:
        raise ParameterError("--out", "nothing", "the name of a .zarr store, or of a .nc, .parquet or .csv file")
    check_out("--out", out)
    check_plot(plot, force)
    if out is not None and out.suffix != ".zarr" and out.exists() and not force and not dry_run:
        raise ParameterError("--out", str(out), "a new file, or --force to replace it: this one exists")
    fixed = tuple(text for text in overrides if not _is_range(text))
    ranges = _ranges(options, overrides, fixed)
    levels = Levels(**chosen_levels(options))
    names = None if outputs is None else tuple(name.strip() for name in outputs.split(","))
    words: dict[str, Any] = {name: options[name] for name in ("start", "load")}
    if words["load"] == "weight" and "load_radius" in ranges:
        words["load_radius"] = 1.0  # the range's values take its place
    machine = chosen_motor(motor, fixed)
    plan = make_plan(machine, Drive(**words), levels, None, tolerance, names, chunk, ranges, method)
    if plot is not None:
        from trum_sym.plots import answers

        answers.check_swept(len(plan.grid.axes))
    if dry_run:
        say(_estimate(estimate("--out", plan, out, scheduler, chunk is not None), out))
        return
    found, summary = run("--out", plan, out, scheduler, chunk is not None, sys.stderr)
    say(f"{out}: {_summary(plan, summary)}")
    if plot is not None:
        answers.write_picture("--plot", answers.swept(found), plot)


def _ranges(options: dict[str, Any], overrides: tuple[str, ...], fixed: tuple[str, ...]) -> dict[str, str]:
    """What takes several values, by name: of the drive's options and of ``--set``."""
    from trum_sym.errors import ParameterError

    ranges = {name: text for name in _RANGED if (text := options[name]) is not None}
    for text in overrides:
        if text not in fixed:
            name, _, given = text.partition("=")
            if name.strip() in (*ranges, *(other.partition("=")[0].strip() for other in fixed)):
                raise ParameterError("--set", text, "each name once")
            ranges[name.strip()] = given
    return ranges


def _is_range(override: str) -> bool:
    from trum_sym.sweeps.notation import is_range

    return is_range(override.partition("=")[2])


def _summary(plan: Plan, summary: Summary) -> str:
    text = f"{summary.points} points of {' '.join(plan.settings.outputs)}"
    if summary.computed < summary.points:
        text += f"; {summary.computed} of them computed now"
    if summary.damaged:
        text += f", {summary.damaged} damaged chunks among them"
    if summary.failed:
        text += f"; {summary.failed} failed, see status"
    if summary.refusal:
        text += f" (the first refused: {summary.refusal})"
    return text


def _estimate(found: Workload, out: Path | None) -> str:
    from trum_sym.output.progress import duration

    plan, shape = found.plan, " x ".join(f"{axis.name} {axis.size}" for axis in found.plan.grid.axes)
    chunks = 1
    for count in plan.chunks:
        chunks *= count
    lines = [
        f"{plan.grid.size} points: {shape}",
        f"{chunks} chunks of {' x '.join(map(str, plan.chunk))} points",
        f"{plan.size_bytes / 2**20:.3g} MiB before compression: {' '.join(plan.settings.outputs)} status",
        f"{duration(found.seconds)} at {found.rate:.3g} points a second on {found.threads} threads, "
        f"measured on a sample of {found.sample}",
    ]
    if found.missing_points < plan.grid.size:
        lines.insert(3, f"{found.missing_points} points in {found.missing_chunks} chunks are missing in {out}")
    return "\n".join(lines)


_RANGED = []
for _option in sweep.params:  # the options of a point, but with ranges
    if _option.name in ("chunk", "motor", "tolerance"):
        continue
    if isinstance(_option.type, QuantityType) or _option.name == "phase_lead":
        _option.type = Range()
        _RANGED.append(str(_option.name))
