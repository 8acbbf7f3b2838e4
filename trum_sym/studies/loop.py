"""A speed loop about an operating point: what the motor does to a small change of frequency, gains, margins."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import lap_from
from trum_sym.model.sensitivities import orbit_with_slopes
from trum_sym.model.settling import RimOrbit, rim_orbits

__all__ = ["Loop", "loop_at"]

_TOLERANCE = 1e-9
_BESIDE = 1e-3  # of the largest speed, by which a lap begins beside the orbit
_HALF = 0.5  # of a small error that is left after a control period, at the fastest
_FREQUENCIES = 4001  # at which the loop's margins are looked for, from 1e-3 to 1 of half the sampling rate


@dataclass(frozen=True)
class Loop:
    """A discrete PI controller of the frequency difference about an operating point.

    Attributes
    ----------
    slope : float
        Of the mean speed by the frequency difference, rad/s/Hz.
    rotor, stator : float
        What is left after a control period of a small change of the rotor's speed, and of the stator's free motion.
    proportional, integral : float
        Gains, Hz/(rad/s); the integral one by period.
    gain_margin : float
        By what factor the motor's slope may rise before the loop is unstable.
    phase_margin : float
        In rad.
    """

    slope: float
    rotor: float
    stator: float
    proportional: float
    integral: float
    gain_margin: float
    phase_margin: float


def loop_at(motor: Motor, drive: Drive, levels: Levels, period: float) -> Loop:
    """The loop by the rule: the controller's zero cancels the rotor's pole, and of a small error half is left after a
    control period, or as much as the rotor leaves by itself where that is more.

    Parameters
    ----------
    motor, drive, levels
        Of a single point.
    period : float
        Control period, s.
    """
    case = prepare(motor, drive, levels, _TOLERANCE, warn=False)
    orbit, by = orbit_with_slopes(case)
    (point,) = rim_orbits(case, orbit)
    slope = float(by["mean_speed"]["frequency_difference"])
    rotor = _kept(point) ** (period / point.cycle_time)
    damping = float(np.asarray(motor.damping_ratio.value)) * float(np.asarray(case.stator.omega_n))
    stator = math.exp(-damping * period)
    left = max(_HALF, rotor)
    together = (1.0 - left) / (slope * (1.0 - rotor))
    proportional, integral = rotor * together, (1.0 - rotor) * together
    margins = _margins(slope, rotor, stator, proportional, integral)
    return Loop(slope, rotor, stator, proportional, integral, *margins)


def _kept(point: RimOrbit) -> float:
    """What a drive cycle leaves of a small change of the rotor's speed."""
    ends = [
        float(lap_from(point.arguments, point.raw, point.raw["start"] + off, 1, point.raw["level"])["speed"][-1])
        for off in (-_BESIDE * point.top, _BESIDE * point.top)
    ]
    return min(max((ends[1] - ends[0]) / (2 * _BESIDE * point.top), 1e-12), 1 - 1e-12)


def _margins(slope: float, rotor: float, stator: float, proportional: float, integral: float) -> tuple[float, float]:
    """Gain and phase margin of controller, motor and an encoder that averages over the period."""
    z = np.exp(1j * np.pi * np.geomspace(1e-3, 1.0, _FREQUENCIES))
    lag = -1.0 / math.log(rotor)  # the rotor's time constant in periods
    mean = lag * (1.0 - rotor)  # share of the reading that is of the speed before
    motor = slope * ((1.0 - mean) + mean * (1.0 - rotor) / (z - rotor)) / z
    settled = (1.0 - stator) / (1.0 - stator / z)
    loop = (proportional + integral * z / (z - 1.0)) * motor * settled
    phase = np.unwrap(np.angle(loop))
    below = np.flatnonzero((phase[:-1] > -np.pi) & (phase[1:] <= -np.pi))
    gain = 1.0 / abs(loop[below[0]]) if below.size else 1.0 / abs(loop[-1])
    size = np.abs(loop)
    crossing = np.flatnonzero((size[:-1] > 1.0) & (size[1:] <= 1.0))
    return float(gain), float(np.pi + phase[crossing[0]]) if crossing.size else math.pi
