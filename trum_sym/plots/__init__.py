"""The paper's figures redrawn from the compiled kernels, and some that it lacks.

Each function takes a motor and a drive (TRUM-60 and the paper's own settings if not given) and the axes to draw in
(a new figure's if not given), and returns the figure.  Needs the extra ``report``.

>>> from trum_sym import plots
>>> plots.phase_responses().savefig("phases.svg")
"""

from __future__ import annotations

from trum_sym.paper.cycle import READINGS, Reading
from trum_sym.plots.maps import maps, prediction
from trum_sym.plots.motion import (
    determinant,
    ellipse,
    forward_and_backward,
    instantaneous_speed,
    phase_responses,
    tangential_velocity,
    vertical_displacement,
)
from trum_sym.plots.region import load_region
from trum_sym.plots.speed import measured_speed, torque_speed
from trum_sym.plots.style import blank, save, svg
from trum_sym.plots.transfer import contact_zone, transfer_models
from trum_sym.plots.transients import driven, start_and_stop
from trum_sym.plots.trends import cycles, multivariable, trends
from trum_sym.plots.vibration import beat, power_off, resonance_levels

__all__ = [
    "READINGS",
    "Reading",
    "beat",
    "blank",
    "contact_zone",
    "cycles",
    "determinant",
    "driven",
    "ellipse",
    "forward_and_backward",
    "instantaneous_speed",
    "load_region",
    "maps",
    "measured_speed",
    "multivariable",
    "phase_responses",
    "power_off",
    "prediction",
    "resonance_levels",
    "save",
    "start_and_stop",
    "svg",
    "tangential_velocity",
    "torque_speed",
    "transfer_models",
    "trends",
    "vertical_displacement",
]
