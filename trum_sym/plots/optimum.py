"""A picture of the box: speed contours, the target, borders of the constraints, the optimum."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.units import ARCSEC
from trum_sym.optimiser.chart import chart
from trum_sym.optimiser.expressions import parse_expression
from trum_sym.optimiser.model import functions
from trum_sym.optimiser.result import Optimum
from trum_sym.optimiser.solve import Problem
from trum_sym.output.files import check_target, write_bytes
from trum_sym.plots.style import without_tex
from trum_sym.text import one_line

__all__ = ["SUFFIXES", "draw"]

SUFFIXES = (".png", ".svg", ".pdf")
_DIVISIONS = {1: 201, 2: 41}
_AXES = {
    "prepressure": "prepressure / N",
    "frequency_difference": "frequency difference / Hz",
    "switching_phase": "switching phase / rad",
}


@without_tex
def draw(optimum: Optimum, target: Path, name: str = "plot") -> None:
    """Write the picture; of three variables, the plane of the first two through the optimum.

    Parameters
    ----------
    optimum : Optimum
        The answer.
    target : Path
        Where to; the suffix says as what, .png, .svg or .pdf.
    name : str
        The parameter, for errors.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    MissingExtraError
        Without matplotlib.
    """
    check_target(name, target, SUFFIXES)
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtraError("a picture", str(error.name), "report") from None
    figure = Figure(figsize=(8.0, 5.6), layout="constrained")
    axes = figure.add_subplot()
    problem = _plane(optimum)
    model = problem.model()
    found = chart(model, _DIVISIONS[len(problem.box.names)])
    speed = parse_expression("speed", "mean_speed")
    rows = functions([speed, *(constraint.expression for constraint in problem.constraints)])
    values = rows.values(found.figures)
    (_line if len(found.shape) == 1 else _map)(axes, problem, model.box.at(found.share), found.shape, values)
    _optima(axes, optimum, problem)
    drive = problem.drive
    pulses = f"{drive.on_periods:g} of {drive.periods:g} periods on"
    title = f"{one_line(problem.motor.name)}, {drive.load_text()}, {pulses}\n{optimum.status}: {optimum.message}"
    axes.set_title(title, fontsize=9, wrap=True, parse_math=False)
    figure.legend(loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    content = BytesIO()
    figure.savefig(content, format=target.suffix[1:], dpi=150)
    write_bytes(name, content.getvalue(), target)


def _plane(optimum: Optimum) -> Problem:
    """The problem in its first two variables."""
    problem = optimum.problem
    box = problem.box
    if len(box.names) < 3:
        return problem
    held = {name: getattr(optimum, name) for name in box.names[2:] if getattr(optimum, name) is not None}
    box = replace(box, names=box.names[:2], low=box.low[:2], high=box.high[:2])
    return replace(problem, box=box, drive=replace(problem.drive, **held))


def _beyond(problem: Problem, values: Array) -> list[tuple[str, Array]]:
    """Of every constraint that is no target: its words, and how far values are inside, negative outside."""
    found = []
    for constraint, column in zip(problem.constraints, values.T[1:], strict=True):
        if constraint.low != constraint.high:
            found.append((constraint.text, np.minimum(column - constraint.low, constraint.high - column)))
    return found


def _targets(problem: Problem) -> list[tuple[int, float, str]]:
    return [
        (1 + k, constraint.low, constraint.text)
        for k, constraint in enumerate(problem.constraints)
        if constraint.low == constraint.high
    ]


def _map(axes: Any, problem: Problem, points: Array, shape: tuple[int, ...], values: Array) -> None:  # noqa: ANN401
    """Two variables: the frequency difference, or what comes second, to the right."""
    up, right = (points[:, k].reshape(shape) for k in (0, 1))
    speed = values[:, 0].reshape(shape) / ARCSEC
    filled = axes.contourf(right, up, speed, 20, cmap="viridis")
    axes.figure.colorbar(filled, ax=axes, label="mean speed / (arcsec/s)")
    axes.contour(right, up, speed, filled.levels, colors="k", linewidths=0.3, alpha=0.5)
    for k, value, text in _targets(problem):
        column = values[:, k].reshape(shape)
        if np.nanmin(column) < value < np.nanmax(column):
            axes.contour(right, up, column, [value], colors="magenta", linewidths=2)
            axes.plot([], [], color="magenta", linewidth=2, label=_words(text))
    for number, (text, inside) in enumerate(_beyond(problem, values)):
        color = f"C{1 + number}"
        grid = inside.reshape(shape)
        if np.nanmin(grid) < 0 < np.nanmax(grid):
            axes.contour(right, up, grid, [0], colors=color, linewidths=1.5)
        axes.contourf(right, up, grid, [-np.inf, 0], colors="none", hatches=["//"])
        axes.plot([], [], color=color, label=f"{_words(text)}; hatched: not met")
    axes.set_xlabel(_AXES[problem.box.names[1]])
    axes.set_ylabel(_AXES[problem.box.names[0]])


def _line(axes: Any, problem: Problem, points: Array, _: tuple[int, ...], values: Array) -> None:  # noqa: ANN401
    """One variable: the speed over it."""
    across = points[:, 0]
    axes.plot(across, values[:, 0] / ARCSEC, color="C0")
    for k, value, text in _targets(problem):
        if problem.constraints[k - 1].expression.text == "mean_speed":
            axes.axhline(value / ARCSEC, color="grey", label=_words(text))
    for number, (text, inside) in enumerate(_beyond(problem, values)):
        bad = ~(inside >= 0)
        axes.fill_between(
            across,
            0,
            1,
            where=bad,
            transform=axes.get_xaxis_transform(),
            alpha=0.25,
            color=f"C{1 + number}",
            label=f"not met: {_words(text)}",
        )
    axes.set_xlabel(_AXES[problem.box.names[0]])
    axes.set_ylabel("mean speed / (arcsec/s)")


def _words(text: str) -> str:
    """A target speed in the unit that people read."""
    name, _, rest = text.partition(" == ")
    return f"mean speed {float(rest.split()[0]) / ARCSEC:.6g} arcsec/s" if name == "mean_speed" and rest else text


def _optima(axes: Any, optimum: Optimum, problem: Problem) -> None:  # noqa: ANN401
    names = problem.box.names

    def coordinates(place: dict[str, float], speed: float | None) -> tuple[float, float]:
        if len(names) == 2:
            return place[names[1]], place[names[0]]
        return place[names[0]], (speed or 0.0) / ARCSEC

    for k, place in enumerate(optimum.evidence.places[1:]):
        if len(names) == 2:
            axes.plot(
                *coordinates(place, None),
                "o",
                color="w",
                markeredgecolor="k",
                clip_on=False,
                label="other local optima" if k == 0 else None,
            )
    if optimum.prepressure is not None:
        best = {name: getattr(optimum, name) for name in names}
        label = "optimum" if optimum.status == "solved" else "nearest that can be reached"
        axes.plot(
            *coordinates(best, optimum.mean_speed),
            "*",
            color="r",
            markeredgecolor="w",
            markersize=16,
            clip_on=False,
            zorder=5,
            label=label,
        )
