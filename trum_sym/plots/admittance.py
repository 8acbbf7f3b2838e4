"""The admittance of a phase over frequency as a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.plots.style import COLOURS, blank, figure_of, styled, without_tex, write_picture
from trum_sym.plots.tolerance import check_picture

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

__all__ = ["check_picture", "draw"]

_LINES = ("-", "--")


@without_tex
def draw(name: str, found: xr.Dataset, target: Path) -> None:
    """Write the picture, whole or not at all.

    Parameters
    ----------
    name : str
        What a refusal calls the file.
    found : xarray.Dataset
        From :func:`trum_sym.studies.admittance.admittance`.
    target : Path
        A .png, .svg or .pdf file.

    Raises
    ------
    ParameterError, MissingExtraError
        As :func:`check_picture` does, or if the file cannot be written.
    """
    check_picture(name, target)
    write_picture(name, _figure(found), target)


@styled
def _figure(found: xr.Dataset) -> Figure:
    size, angle, circle, wave = blank(2, 2, 6.0)
    frequency = found["frequency"].values / 1e3
    for k, state in enumerate(found["state"].values):
        of, line = found.sel(state=state), _LINES[k]
        conductance, susceptance = of["conductance"].values, of["susceptance"].values
        size.plot(frequency, 1e3 * np.hypot(conductance, susceptance), line, color=COLOURS[k], label=str(state))
        angle.plot(
            frequency, np.degrees(np.arctan2(susceptance, conductance)), line, color=COLOURS[k], label=str(state)
        )
        circle.plot(1e3 * conductance, 1e3 * susceptance, line, color=COLOURS[k], label=str(state))
        wave.plot(frequency, 1e6 * of["amplitude"].values, line, color=COLOURS[k], label=str(state))
    for panel, label in ((size, "admittance (mS)"), (angle, "phase (deg)"), (wave, "wave (um)")):
        panel.set_xlabel("frequency (kHz)")
        panel.set_ylabel(label)
    size.set_yscale("log")
    circle.set_xlabel("conductance (mS)")
    circle.set_ylabel("susceptance (mS)")
    figure = figure_of(size)
    handles, labels = size.get_legend_handles_labels()
    figure.suptitle(str(found.attrs["title"]), x=0.02, ha="left", fontsize=9)
    figure.legend(handles, labels, loc="upper right", ncols=len(labels), fontsize=8, frameon=False)
    return figure
