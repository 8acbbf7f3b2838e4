"""Which inertia, friction and contact radius give what was measured: Table 4's speed and volatility, and the trends.

For a reading of the paper, the friction at which the mean speed is Table 4's is found for every inertia and contact
radius.  What the encoder reads there, and whether speed and volatility step as the determinants do over the drives of
Figs. 30 to 32, is computed at that friction.  Nothing is fitted: what is returned is where the figures meet.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive, Start
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.levels import Compliance
from trum_sym.paper.findings import ASSUMED, Context, Truth, together
from trum_sym.paper.readings import POINTS, published

__all__ = ["COMPARED", "Region", "region"]

COMPARED = (
    ("mean_speed", "q_average", POINTS.figure_21),
    ("encoder_volatility", "q_volatility", POINTS.figure_21),
    ("mean_speed", "q_average", POINTS.figure_31),
    ("encoder_volatility", "q_volatility", POINTS.figure_31),
    ("mean_speed", "q_average", POINTS.figure_32),
    ("encoder_volatility", "q_volatility", POINTS.figure_32),
)
"""What Figs. 30a, 30b, 31a, 31b, 32a and 32b compare, and at which drives."""
_FRICTIONS = 9  # in the assumed range, between which the speed is looked for
_STEPS = 40  # of a bisection that secants shorten


@dataclass(frozen=True)
class Region:
    """Where a reading has Table 4's mean speed; arrays by (contact radius, inertia).

    Attributes
    ----------
    inertia : (n,) array, kg m^2
        Of all that turns with the rotor, its own with it.
    radius : (k,) array, m
    friction : (k, n) array
        The least of the assumed range that gives the mean speed; NaN where none does.
    width : (k, n) array
        By what share of itself friction may be off for a speed within 5 %.
    volatility : (k, n) array
        What the encoder of 2 ms reads there.
    steps : (6, k, n) array of bool
        Whether each of :data:`COMPARED` steps as its determinant does.
    """

    inertia: Array
    radius: Array
    friction: Array
    width: Array
    volatility: Array
    steps: Truth


def region(
    motor: Motor,
    start: Start,
    phase_lead: float,
    switching_phase: float,
    inertia: Array,
    radius: Array,
    compliance: Compliance = "layer",
) -> Region:
    """The region of a reading, at the default levels but for the compliance.

    Parameters
    ----------
    motor : Motor
        Of single numbers; its friction and contact radius do not count.
    start, phase_lead, switching_phase
        The reading.
    inertia : (n,) array, kg m^2
        Of rotor and load together, more than the rotor's.
    radius : (k,) array, m
        Contact radii.
    compliance : {"layer", "flange"}
        What gives in the contact.
    """
    wanted = published(load_motor("trum60"))["mean_speed"]
    own = float(motor.rotor_inertia.value)
    grid = np.broadcast_shapes((radius.size, 1), (1, inertia.size))
    load = np.broadcast_to(inertia - own, grid)
    contact = np.broadcast_to(radius[:, None], grid)

    def figures(friction: Array, place: Truth, points: bool = False, tolerance: float = 1e-6) -> dict[str, Array]:
        """At frictions of the grid's chosen places; the last axis are the paper's drives if these are wanted."""
        shape = (-1, 1) if points else (-1,)
        with unquestioned():
            machine = motor.with_values(
                {
                    "friction_coefficient": friction.reshape(shape),
                    "contact_radius": contact[place].reshape(shape),
                }
            )
        drive = Drive(
            prepressure=POINTS.prepressure if points else 180.0,
            frequency_difference=POINTS.difference if points else 3000.0,
            start=start,
            phase_lead=phase_lead,
            switching_phase=switching_phase,
            load_inertia=load[place].reshape(shape),
        )
        return dict(Context.figures(machine, drive, tolerance, encoder=points, compliance=compliance))

    every = np.ones(grid, bool)
    frictions = np.linspace(*ASSUMED["friction_coefficient"], _FRICTIONS)
    off = np.array([figures(np.full(load.size, f), every)["mean_speed"] - wanted for f in frictions])
    turns = np.sign(off[1:]) != np.sign(off[:-1])
    found, first = turns.any(axis=0), turns.argmax(axis=0)
    place, at = found.reshape(grid), np.flatnonzero(found)
    low, high = frictions[first[at]], frictions[first[at] + 1]
    left, right = off[first[at], at], off[first[at] + 1, at]
    friction, width, volatility = (np.full(grid, np.nan) for _ in range(3))
    steps = np.zeros((len(COMPARED), *grid), bool)
    if at.size:
        middle = low
        for step in range(_STEPS):
            secant = low - left * (high - low) / (right - left)
            middle = (low + high) / 2 if step % 3 == 2 else secant
            value = figures(middle, place, tolerance=1e-8)["mean_speed"] - wanted
            same = np.sign(value) == np.sign(left)
            slope = (right - left) / (high - low)
            low, left = np.where(same, middle, low), np.where(same, value, left)
            high, right = np.where(same, high, middle), np.where(same, right, value)
            if np.all(np.abs(value) < 1e-3 * wanted):
                break
        friction[place], width[place] = middle, 0.05 * wanted / np.abs(slope) / middle
        there = figures(middle, place, points=True)
        volatility[place] = there["encoder_volatility"][:, POINTS.table_3]
        for k, (figure, determinant, of) in enumerate(COMPARED):
            steps[k][place] = together(there[figure][:, of], there[determinant][:, of])
    return Region(inertia, radius, friction, width, volatility, steps)
