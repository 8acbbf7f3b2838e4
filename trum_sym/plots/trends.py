"""Speed and determinants against frequency difference and prepressure (Figs. 20 to 23, 30 to 32)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.units import ARCSEC, parse_unit
from trum_sym.model.operating_point import OperatingPoint, evaluate
from trum_sym.paper.cycle import READINGS, solve
from trum_sym.paper.published import BOX, ENCODER, TABLE_5
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, panels, styled
from trum_sym.text import one_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["MEASURES", "Variable", "cycles", "measures", "multivariable", "trends"]

Variable = Literal["frequency_difference", "prepressure"]
_LABELS = {"frequency_difference": "frequency difference Δf (Hz)", "prepressure": "prepressure F_c (N)"}


class _Measure(NamedTuple):
    name: str
    label: str
    unit: float
    logarithmic: bool = False


MEASURES = (
    _Measure("mean_speed", "v_s (10⁶ arcsec/s)", 1e6 * ARCSEC),
    _Measure("q_average", "Q_aver (1/s)", 1.0),
    _Measure("speed_volatility", "σ_s (%)", 0.01, logarithmic=True),
    _Measure("q_volatility", "Q_vib (1/s)", 1.0),
)


def measures(point: OperatingPoint) -> dict[str, Array]:
    """v_s, Q_aver, sigma_s and Q_vib of a point in the units of the figures."""
    return {measure.name: np.asarray(getattr(point, measure.name)) / measure.unit for measure in MEASURES}


@styled
def cycles(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    variable: Variable = "frequency_difference",
    axes: Panels = None,
) -> Figure:
    """Figs. 20 and 22: rotor speed and determinant over a cycle at six values, as the motor runs and from rest.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    variable : {"frequency_difference", "prepressure"}
        What the six values are of, across Sect. 6.2's range.
    axes : four Axes, optional
        A new figure's if not given.
    """
    four = panels(axes, 2, 2, 4.6, sharex=True, sharey="row")
    drive = Drive() if drive is None else drive
    readings = (READINGS[0], READINGS[-1])
    for column, reading in enumerate(readings):
        for value, colour in zip(np.linspace(*BOX[variable], 6), COLOURS, strict=True):
            cycle = solve(motor, _at(reading.of(drive), variable, float(value)), tolerance=1e-3)
            time, speed, _ = cycle.rotor(320)
            unit = "Hz" if variable == "frequency_difference" else "N"
            style: dict[str, Any] = {"color": colour, "linewidth": 0.9, "label": f"{value:g} {unit}"}
            four[column].plot(1e3 * time, speed / (1e6 * ARCSEC), **style)
            turning = cycle.phases(np.minimum(time, np.nextafter(time[-1], 0)))["Q"]
            four[2 + column].plot(1e3 * time, 1e6 * np.asarray(turning), **style)
        four[column].set_title(f"start {reading.label}")
        four[2 + column].set_xlabel("time since t₁ (ms)")
    for ax in four:
        ax.axhline(0, color=INK, linewidth=0.5)
    four[0].set_ylabel("rotor speed (10⁶ arcsec/s)")
    four[2].set_ylabel("Q (mm²/s)")
    figure = figure_of(four[0])
    handles, labels = four[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6)
    return figure


@styled
def trends(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    variable: Variable = "frequency_difference",
    sampling_period: float | None = None,
    axes: Panels = None,
) -> Figure:
    """Figs. 21 and 23 (continuous) or 30 and 31 (an encoder): speed, volatility and their determinants.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    variable : {"frequency_difference", "prepressure"}
        What changes, across Sect. 6.2's range.
    sampling_period : float, s, optional
        Of the encoder behind the volatility; continuous if not given.
    axes : four Axes, optional
        v_s, Q_aver, sigma_s, Q_vib.
    """
    values = np.linspace(*BOX[variable], 26)
    drive = Drive() if drive is None else drive
    four = _measured(motor, _at(drive, variable, values), values, sampling_period, axes)
    for ax, measure in zip(four, MEASURES, strict=True):
        _print_marks(ax, motor, drive, variable, measure)
    for ax in four[2:]:
        ax.set_xlabel(_LABELS[variable])
    return figure_of(four[0])


@styled
def multivariable(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """Fig. 32, the model's side: the six points of Table 5, volatility as the encoder of Sect. 8 reads it.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given, but for the two variables.
    axes : four Axes, optional
        A new figure's if not given.
    """
    drive = replace(
        Drive() if drive is None else drive,
        prepressure=TABLE_5["prepressure"],
        frequency_difference=TABLE_5["frequency_difference"],
    )
    number = np.arange(1.0, 7.0)
    four = _measured(motor, drive, number, ENCODER, axes, marker="o", linewidth=0.7, markersize=4)
    for ax in four[2:]:
        ax.set_xlabel("number of the experiment (Table 5)")
        ax.set_xticks(number)
    return figure_of(four[0])


def _at(drive: Drive, variable: Variable, values: ArrayLike) -> Drive:
    if variable == "prepressure":
        return replace(drive, prepressure=values)
    return replace(drive, frequency_difference=values)


def _measured(
    motor: Motor | None,
    drive: Drive,
    x: ArrayLike,
    sampling_period: float | None,
    axes: Panels,
    **style: Any,  # noqa: ANN401
) -> list[Axes]:
    four = panels(axes, 2, 2, 4.4, sharex=True)
    machine = load_motor("trum60") if motor is None else motor
    for reading, colour, line in zip(READINGS, COLOURS, ("-", "--", "-."), strict=False):
        found = measures(evaluate(machine, reading.of(drive), sampling_period=sampling_period))
        for ax, measure in zip(four, MEASURES, strict=True):
            ax.plot(x, found[measure.name], line, color=colour, label=reading.label, **style)
    for ax, measure in zip(four, MEASURES, strict=True):
        ax.set_ylabel(measure.label)
        if measure.logarithmic:
            ax.set_yscale("log")
    figure = figure_of(four[0])
    handles, labels = four[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=3)
    return four


def _print_marks(axes: Axes, motor: Motor | None, drive: Drive, variable: Variable, measure: _Measure) -> None:
    """What the paper prints at a point of this curve."""
    settings = {name: value for name, value in drive.numbers().items() if name != variable}
    for entry in (load_motor("trum60") if motor is None else motor).published:
        same = all(settings[name] == value for name, value in entry.drive.items() if name != variable)
        if entry.output == measure.name and variable in entry.drive and same:
            size = parse_unit(entry.unit).to_si(entry.value) / measure.unit
            axes.plot(
                [entry.drive[variable]],
                [size],
                "*",
                color=INK,
                markersize=8,
                label=one_line(entry.source).replace("$", r"\$"),
            )
