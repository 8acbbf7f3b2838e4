"""Superimposed pulses beside microstepping: bursts of both phases with a pause, at the same mean speed (Sect. 1).

In the model both need a wave that comes and goes with the rotor on it, so they are judged at the level
``coupling = "contact"`` and not in the readings, none of which has it (docs/coupling.md has the whole comparison).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.schedule import Schedule
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.coupled_orbit import CoupledOrbit, lap_values, orbit_from, start_of
from trum_sym.model.drive_orbit import drive_orbit, history_of, read_by_encoder
from trum_sym.model.levels import Levels
from trum_sym.paper.published import ENCODER

__all__ = ["MEANS", "Steadiness", "compared"]

MEANS = (1.0, 100.0, 1000.0)  # arcsec/s
_BURSTS = (1, 20)  # drive periods of a burst
_LEVELS = Levels(compliance="flange", coupling="contact")
_MASS = 0.0  # kg: the rotor follows the wave, so that everything comes to rest between bursts
_OFTEN = 5000  # drive periods between bursts that a step is found with; further apart it is the same
_SAMPLES = 16  # parts of a drive period
_TOLERANCE = 1e-8
_FIRST = (3000.0, 3200.0)  # Hz, frequency differences that the search for a mean speed begins with
_NEAR = 0.02  # of a mean speed, by which pulses may miss it: their deviation does not depend on it
_TRIES = 12


@dataclass(frozen=True)
class Steadiness:
    """Of pulses and of a burst at one mean speed.

    Attributes
    ----------
    setting : str
        What is compared, in words.
    mean : float, arcsec/s
        Speed of both.
    pulses, bursts : float, rad/s
        Standard deviations.
    """

    setting: str
    mean: float
    pulses: float
    bursts: float

    @property
    def holds(self) -> bool:
        """Whether the pulses are steadier."""
        return self.pulses < self.bursts


def compared(motor: Motor) -> tuple[Steadiness, ...]:
    """All settings: the speed itself and an encoder's readings, without and with the bench's plate, by mean and burst.

    Parameters
    ----------
    motor : Motor
        The paper's: of single numbers, with a bench.  A loss of its layer is left out, which pulses do not know.
    """
    found, motor = [], replace(motor, layer_loss_factor=None)
    for inertia, on in product((0.0, float(motor.bench["load_inertia"].value)), _BURSTS):
        drive = Drive(load_torque=0.0, load_inertia=inertia)
        pulses, step = _pulses(motor, drive), _step(motor, drive, on)
        place = "with the bench's plate" if inertia else "the rotor alone"
        for mean in MEANS:
            bursts = step.at(mean * ARCSEC)
            both = zip(("the speed itself", f"an encoder of {1e3 * ENCODER:g} ms"), pulses, bursts, strict=True)
            for reading, ours, theirs in both:
                setting = f"{reading}, {place}, bursts of {on}, {mean:g} arcsec/s"
                found.append(Steadiness(setting, mean, ours, theirs))
    return tuple(found)


def _pulses(motor: Motor, drive: Drive) -> tuple[float, float]:
    """Deviations of Table 3's pulses, of the speed and of an encoder, at the frequency at which they creep."""
    wanted = MEANS[1] * ARCSEC

    def at(offset: float, before: CoupledOrbit | None) -> tuple[dict[str, float], CoupledOrbit]:
        near = replace(drive, frequency_difference=offset)
        values = lap_values(motor, near, _LEVELS, rotor_mass=_MASS, tolerance=_TOLERANCE)
        start = start_of("steady", values) if before is None else before.state
        return values, orbit_from(values, start, "steady" if before is None else "followed")

    one, other = _FIRST
    _, first = at(one, None)
    values, orbit = at(other, first)
    for _ in range(_TRIES):
        if abs(orbit.mean_speed - wanted) < _NEAR * wanted:
            break
        slope = (orbit.mean_speed - first.mean_speed) / (other - one)
        one, other, first = other, other + (wanted - orbit.mean_speed) / slope, orbit
        values, orbit = at(other, orbit)
    gates = np.tile(Schedule().gates(drive), (orbit.cycles, 1))
    walked = history_of(values, orbit.state, gates, _SAMPLES)
    known = orbit.closed and orbit.stable and abs(orbit.mean_speed - wanted) < _NEAR * wanted
    return (orbit.deviation, read_by_encoder(walked.time, walked.angle, ENCODER)[0]) if known else (math.nan, math.nan)


@dataclass(frozen=True)
class _Step:
    """What a burst does before everything rests again: the rotor's path, and the integral of its speed's square."""

    time: Array
    angle: Array
    square: float
    rests: bool

    def at(self, mean: float) -> tuple[float, float]:
        """Deviations of speed and encoder where bursts are so far apart that the mean speed is this, rad/s."""
        cycle = float(self.angle[-1]) / mean
        if not self.rests or cycle < self.time[-1]:
            return math.nan, math.nan
        time, angle = np.append(self.time, cycle), np.append(self.angle, self.angle[-1])
        return math.sqrt(self.square / cycle - mean**2), read_by_encoder(time, angle, ENCODER)[0]


def _step(motor: Motor, drive: Drive, on: int) -> _Step:
    burst = Schedule(kind="burst", periods=_OFTEN, on_periods=on)
    found = drive_orbit(
        motor,
        drive,
        burst,
        rotor_mass=_MASS,
        samples_per_period=_SAMPLES,
        tolerance=_TOLERANCE,
        compliance=_LEVELS.compliance,
    )
    history, orbit = found.history, found.orbit
    whole = float(history.time[-1])
    moving = int(np.flatnonzero((history.wave > 0) | (history.speed != 0))[-1]) + 2
    square = (orbit.deviation**2 + orbit.mean_speed**2) * whole
    rests = orbit.closed and not history.speed[-1] and moving < history.time.size
    return _Step(history.time[:moving], history.angle[:moving], square, rests)
