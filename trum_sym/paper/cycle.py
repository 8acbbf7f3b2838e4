"""What the pictures of a drive cycle show, from the compiled kernels: phases, surface, contact, rotor."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive, Start
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.model.cycle import response
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import Case, prepare
from trum_sym.model.rotor import Orbit, history, solve_orbit, surface_and_contact, weight_inertia

__all__ = ["READINGS", "Cycle", "Reading", "pulling", "solve"]

_GATES = {"A": np.array([0.0, 1.0, 1.0]), "B": np.array([1.0, 0.0, 1.0])}
_STATES = ("redu", "addredu", "add")


class Reading(NamedTuple):
    """In which state a cycle begins and which phase leads: what the paper leaves open."""

    start: Start
    phase_lead: int

    @property
    def label(self) -> str:
        """Such as ``rest, lead −1``."""
        return f"{self.start}, lead {'+' if self.phase_lead > 0 else '−'}1"

    def of(self, drive: Drive) -> Drive:
        """The drive read this way."""
        return replace(drive, start=self.start, phase_lead=self.phase_lead)


READINGS = (Reading("periodic", 1), Reading("steady", -1), Reading("rest", -1))
"""Each start with the lead that makes Q_aver positive at Table 3; the other lead mirrors every figure."""


def pulling(motor: Motor, torque: float = 0.3) -> Motor:
    """The motor with a load's inertia in the range of what it was measured with (Sect. 8.1).

    That of a weight which pulls by a string at the least radius, the stator's, were the string taut and stiff; a torque
    plate may have as much.
    """
    weight = weight_inertia({"J": 0.0, "J_load": 0.0, "T_load": torque, "r_s": motor.radius.value})
    return motor.with_values({"rotor_inertia": np.asarray(motor.rotor_inertia.value) + weight})


@dataclass(frozen=True)
class Cycle:
    """One operating point, ready to be looked at in time."""

    case: Case

    @cached_property
    def edges(self) -> Array:
        """Times of t1, t2, t3 and t4, s, shape (4,)."""
        regions = call("trum_regions", self.case.arguments)
        return np.concatenate([[0.0], np.cumsum([float(regions[f"time_{name}"]) for name in _STATES])])

    @property
    def period(self) -> float:
        """Of the drive, s."""
        return float(self.edges[-1] / np.asarray(self.case.drive.periods))

    def times(self, per_period: int, region: int | None = None) -> Array:
        """Equal times of the whole cycle or of one region, both ends included, s."""
        low, high = (self.edges[0], self.edges[-1]) if region is None else self.edges[region : region + 2]
        return np.linspace(low, high, round((high - low) / self.period) * per_period + 1)

    def phases(self, time: ArrayLike) -> dict[str, ArrayLike]:
        """w_A, w_B (m), v_A, v_B (m/s), Q (m^2/s)."""
        arguments = self.case.arguments
        return response(time, dict(arguments), arguments["D"], arguments["k_c"])

    def surface(self, time: ArrayLike, x: ArrayLike) -> dict[str, Array]:
        """zeta_z, zeta_x (m), v_x (m/s), envelope A_Q (m) of the point x, and x_max (m) of the crest."""
        arguments = self.case.arguments
        regions = call("trum_regions", arguments)
        now = np.asarray(time)
        region = np.clip(np.searchsorted(self.edges[1:], now, side="right"), 0, 2)
        free = {
            f"{part}_{phase}": np.choose(region, [np.asarray(regions[f"{part}_{phase}_{name}"]) for name in _STATES])
            for part in "ab"
            for phase in "AB"
        }
        gates = {f"g_{phase}": gate[region] for phase, gate in _GATES.items()}
        found = call("trum_particle", {**arguments, **free, **gates, "tau": now - self.edges[region], "x": x})
        return {name: np.asarray(value) for name, value in found.items()}

    def touching(self, time: ArrayLike) -> dict[str, ArrayLike]:
        """Wave height W_c, surface speed R_v at phase phi from the crest, contact half-angle theta, by symbol."""
        return surface_and_contact(self.case.arguments, self.phases(time))

    def interface(self, time: ArrayLike, u: ArrayLike, speed: ArrayLike) -> dict[str, Array]:
        """Surface speed v_x (m/s), pressure p and traction (N/m) at the angle u from the crest, rotor at ``speed``.

        Parameters
        ----------
        time : float or array, s
            Since t1, within a cycle.
        u : float or array, rad
            Angle.
        speed : float or array, m/s
            Of the rotor's rim.
        """
        touching = self.touching(time)
        here = {"x": np.asarray(u) / np.asarray(self.case.arguments["k_c"]), "x_max": 0.0, "v": speed}
        found = call("trum_interface", {**self.case.symbols, **touching, **here})
        return {name: np.asarray(value) for name, value in found.items()}

    @cached_property
    def orbit(self) -> Orbit:
        """The rotor's periodic orbit."""
        return solve_orbit(self.case.arguments, self.case.symbols)

    def rotor(self, count: int) -> tuple[Array, Array, Array]:
        """Times (s), speed (rad/s) and angle (rad) of the rotor at ``count`` + 1 equal times of a cycle."""
        lap = history(self.case.arguments, self.orbit.raw, count)
        radius = np.asarray(self.case.symbols["r_c"])
        speed = np.concatenate([lap["speed"][-1:], lap["speed"]]) / radius
        angle = np.concatenate([[0.0], lap["distance"]]) / radius
        return np.linspace(0.0, self.edges[-1], count + 1), speed, angle


def solve(motor: Motor | None, drive: Drive | None, tolerance: float = 1e-6) -> Cycle:
    """A single operating point at the default levels; TRUM-60 and Table 3 if not given.

    Raises
    ------
    ParameterError
        For bad input.
    """
    levels = Levels()
    return Cycle(prepare(load_motor("trum60") if motor is None else motor, drive, levels, tolerance))
