"""A study of spread as a picture: how each output is distributed, and its Sobol indices with their intervals."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.shown import quantity_of
from trum_sym.output.files import check_target, write_bytes
from trum_sym.plots.style import without_tex
from trum_sym.text import one_line
from trum_sym.uncertainty.propagation import CONFIDENCE, Estimate, Indices
from trum_sym.uncertainty.result import BALANCED, MISSED
from trum_sym.uncertainty.study import Study
from trum_sym.uncertainty.tables import label, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["check_picture", "draw"]

_PICTURES = (".png", ".svg", ".pdf")


def check_picture(name: str, target: Path) -> None:
    """Refuse, before any work is done, a picture that cannot be written.

    Raises
    ------
    ParameterError
        For another suffix than .png, .svg and .pdf, or a place that is not ours to write in.
    MissingExtraError
        Without matplotlib.
    """
    check_target(name, target, _PICTURES)
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtraError("a picture", "matplotlib", "report") from None


@without_tex
def draw(name: str, study: Study, target: Path) -> None:
    """Write the picture, whole or not at all.

    One row an output: left its distribution over A and B, right the indices.  What decides whether a speed balances
    the load, or a target is missed, follows where that varies.

    Raises
    ------
    ParameterError, MissingExtraError
        As :func:`check_picture` does, or if the file cannot be written.
    """
    check_picture(name, target)
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    found = {output: indices for output, indices in study.propagation.indices.items() if indices is not None}
    height = 0.9 + 0.34 * len(study.distributions)
    figure = Figure(figsize=(11, len(found) * max(2.6, height) + 0.5), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(found), 2, squeeze=False)
    for (left, right), (output, indices) in zip(rows, found.items(), strict=True):
        if output in (BALANCED, MISSED):
            _draw_share(left, study, output)
        else:
            _draw_distribution(left, study, output)
        _draw_indices(right, indices, legend=right is rows[0][1])
        right.set_title(_title(study, output), fontsize="medium")
    rows[-1][1].set_xlabel(f"Sobol index, interval at {100 * CONFIDENCE:g} %")
    drive = study.drive
    figure.suptitle(
        f"{one_line(study.motor.name)}, "
        f"{drive.prepressure:g} N, {drive.frequency_difference:+g} Hz, {drive.on_periods:g} of "
        f"{drive.periods:g} periods on, {drive.load_text()}; {study.samples} samples, seed {study.seed}",
        parse_math=False,
    )
    content = BytesIO()
    figure.savefig(content, format=target.suffix[1:], dpi=120)
    write_bytes(name, content.getvalue(), target)


def _title(study: Study, output: str) -> str:
    if output in study.unbounded:
        return f"{label(output)}: no variance, the mean speed passes zero"
    return f"variance of {label(output)}" if output in study.outputs else label(output)


def _draw_distribution(axes: Axes, study: Study, output: str) -> None:
    drawn = study.propagation.values[output][:2].ravel()
    values = np.array([shown(output, value) for value in drawn[np.isfinite(drawn)]])
    spread, unit = study.propagation.spread(output), quantity_of(output).shown
    # a few far values would squeeze all others into one bar
    low, high = np.quantile(values, (0.005, 0.995))
    beyond = int(((values < low) | (values > high)).sum())
    axes.hist(values, bins="auto", range=(low, high), color="0.75")
    for level, style in ((0.05, ":"), (0.5, "-"), (0.95, ":")):
        at = spread.quantiles[level]
        text = "median" if level == 0.5 else ("5 % and 95 %" if level == 0.05 else None)
        axes.axvline(shown(output, at.value), color="C0", linestyle=style, label=text)
        axes.axvspan(shown(output, at.low), shown(output, at.high), color="C0", alpha=0.15, linewidth=0)
    nominal = getattr(study.nominal, output)
    if np.isfinite(nominal):
        axes.axvline(shown(output, nominal), color="C3", linestyle="--", label="nominal")
    for target in study.targets:
        if target.output == output:
            axes.axvline(shown(output, target.bound), color="k", label=target.text)
    marks = [line.get_xdata()[0] for line in axes.lines]  # type: ignore[index]
    ends = min(low, *marks), max(high, *marks)
    axes.set_xlim(ends[0] - 0.02 * (ends[1] - ends[0]), ends[1] + 0.02 * (ends[1] - ends[0]))
    axes.set_xlabel(label(output) + (f", {unit}" if unit != "1" else "") + (f"; {beyond} beyond" if beyond else ""))
    axes.set_ylabel("points")
    axes.legend(fontsize="small", loc="lower left", bbox_to_anchor=(0, 1), ncols=2, borderaxespad=0.3)


def _draw_share(axes: Axes, study: Study, output: str) -> None:
    estimates: dict[str, Estimate]
    if output == BALANCED:
        estimates = {"no speed balances the load": study.unbalanced}
    else:
        estimates = {f"missing {target.text}": study.missing(target) for target in study.targets}
        if len(study.targets) > 1:
            estimates["missing any"] = study.missing()
    values = list(estimates.values())
    _draw_bars(axes, [""] * len(values), [values], ("C3",), (None,), room=0.4)
    for place, text in enumerate(estimates):  # above its bar: a long label beside it would squeeze all rows
        axes.text(0.01, place - 0.22, text, va="bottom", fontsize="small")
    axes.set_yticks([])
    axes.set_ylim(len(values) - 0.6, -0.7)
    axes.set_xlim(0, 1)
    axes.set_xlabel("probability")


def _draw_indices(axes: Axes, indices: Indices, legend: bool) -> None:
    names = sorted(indices.total, key=lambda name: -indices.total[name].value)
    series = [[order[name] for name in names] for order in (indices.first, indices.total)]
    _draw_bars(axes, names, series, ("C0", "C1"), ("alone (first order)", "with others (total)"))
    axes.axvline(0, color="0.2", linewidth=0.8)
    if legend:
        axes.legend(fontsize="small", loc="lower right")


def _draw_bars(
    axes: Axes,
    names: list[str],
    series: list[list[Estimate]],
    colours: tuple[str, ...],
    labels: tuple[str | None, ...],
    room: float = 0.8,
) -> None:
    """Horizontal bars with intervals, the first name on top."""
    thick = room / len(series)
    for place, (estimates, colour, text) in enumerate(zip(series, colours, labels, strict=True)):
        at = np.arange(len(names)) + (place - (len(series) - 1) / 2) * thick
        values = np.array([e.value for e in estimates])
        # a percentile interval need not hold the estimate itself
        reach = np.maximum([values - [e.low for e in estimates], [e.high for e in estimates] - values], 0)
        axes.barh(at, values, thick, xerr=reach, color=colour, label=text, capsize=2, ecolor="0.2")
    axes.set_yticks(np.arange(len(names)), names)
    axes.invert_yaxis()
