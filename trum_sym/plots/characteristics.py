"""A motor's characteristics as a picture, with measured points beside the curves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.plots.style import COLOURS, blank, figure_of, styled, without_tex, write_picture
from trum_sym.plots.tolerance import check_picture

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["check_picture", "draw"]

_RPM = 30 / np.pi
_LINES = {"plain": "-", "pulse": "--"}
_MARKS = {"plain": "o", "pulse": "s"}


@without_tex
def draw(name: str, curves: xr.Dataset, target: Path) -> None:
    """Write the picture, whole or not at all.

    Parameters
    ----------
    name : str
        What a refusal calls the file.
    curves : xarray.Dataset
        From :func:`trum_sym.studies.characteristics.characteristics`.
    target : Path
        A .png, .svg or .pdf file.

    Raises
    ------
    ParameterError, MissingExtraError
        As :func:`check_picture` does, or if the file cannot be written.
    """
    check_picture(name, target)
    write_picture(name, _figure(curves), target)


@styled
def _figure(curves: xr.Dataset) -> Figure:
    panels = blank(3, 2, 7.0)
    torque, power, efficiency, frequency, speed, stall = panels
    _draw(torque, curves, "mean_speed", "torque", "load torque (N m)", "speed (rpm)", _RPM)
    _points(torque, curves, "speed_torque", _RPM)
    _draw(power, curves, "output_power", "torque", "load torque (N m)", "output power (W)", 1.0)
    _draw(efficiency, curves, "contact_efficiency", "torque", "load torque (N m)", "contact efficiency (%)", 100.0)
    _draw(frequency, curves, "speed_by_frequency", "drive_frequency", "drive frequency (kHz)", "no-load (rpm)", _RPM)
    _points(frequency, curves, "speed_frequency", _RPM, 1e-3)
    _draw(speed, curves, "speed_by_prepressure", "prepressure", "prepressure (N)", "no-load (rpm)", _RPM)
    _points(speed, curves, "speed_prepressure", _RPM)
    _draw(stall, curves, "stall_by_prepressure", "prepressure", "prepressure (N)", "stall torque (N m)", 1.0)
    _points(stall, curves, "stall_prepressure", 1.0)
    handles, labels = torque.get_legend_handles_labels()
    figure = figure_of(torque)
    figure.suptitle(str(curves.attrs["title"]), x=0.02, ha="left", fontsize=9)
    figure.legend(handles, labels, loc="upper right", ncols=len(labels), fontsize=8, frameon=False)
    return figure


def _draw(ax: Axes, curves: xr.Dataset, ordinate: str, abscissa: str, x: str, y: str, scale: float) -> None:
    for k, form in enumerate(curves["drive"].values):
        along = curves[abscissa].values
        along = along[k] / 1e3 if along.ndim == 2 else along
        ax.plot(
            along, scale * curves[ordinate].values[k], _LINES[str(form)], color=COLOURS[k], label=f"{form}, computed"
        )
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))


def _points(ax: Axes, curves: xr.Dataset, curve: str, scale: float, along: float = 1.0) -> None:
    if "point" not in curves.sizes:
        return
    forms = curves["measured_drive"].values
    for k, form in enumerate(("plain", "pulse")):
        here = (curves["measured_curve"].values == curve) & (forms == form)
        if here.any():
            ax.plot(
                along * curves["measured_x"].values[here],
                scale * curves["measured_y"].values[here],
                _MARKS[form],
                color=COLOURS[k],
                markersize=4.5,
                label=f"{form}, published",
            )
