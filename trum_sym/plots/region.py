"""Where friction, contact radius and inertia give what was measured (Sect. 8.2, Table 4)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.paper.cycle import READINGS, Reading
from trum_sym.paper.findings import ASSUMED
from trum_sym.paper.readings import published
from trum_sym.paper.region import region
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, legend, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["load_region"]

_INERTIA = np.geomspace(1e-5, 1e-2, 10)  # kg m^2
_RADIUS = np.array([0.025, 0.0265, 0.030])  # m, the assumed value between the ends of its range


@styled
def load_region(motor: Motor | None = None, reading: Reading = READINGS[2], *, axes: Panels = None) -> Figure:
    """The friction that gives Table 4's mean speed, by inertia and contact radius, and what the encoder reads there.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given.
    reading : Reading
        Start and phase lead.
    axes : two Axes, optional
        A new figure's if not given.
    """
    machine = load_motor("trum60") if motor is None else motor
    left, right = panels(axes, 1, 2, 3.2)
    found = region(machine, reading.start, float(reading.phase_lead), 0.0, _INERTIA, _RADIUS)
    wanted = published(load_motor("trum60"))["speed_volatility"]
    for k, (colour, line) in enumerate(zip(COLOURS, ("-", "--", "-."), strict=False)):
        left.plot(found.inertia, found.friction[k], line, color=colour, label=f"r_c {1e3 * found.radius[k]:g} mm")
        right.plot(found.inertia, 100 * found.volatility[k], line, color=colour)
    left.set_ylim(*ASSUMED["friction_coefficient"])
    left.set_ylabel("friction where v_s is Table 4's")
    right.axhline(100 * wanted, color=INK, linewidth=0.8, linestyle=":", label="Table 4")
    right.set_yscale("log")
    right.set_ylabel("encoder's σ_s there (%)")
    for ax in (left, right):
        ax.set_xscale("log")
        ax.set_xlabel("inertia of rotor and load (kg m²)")
        legend(ax)
    return figure_of(left)
