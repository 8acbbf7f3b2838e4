"""What one spring for the rotor's flange leaves out: the plate is stiffer against the shorter waves of the pressure.

The level compliance = "flange" takes the stiffness that the plate has under a pressure of the wave's own length for all
of the pressure.  Here every harmonic of the pressure meets the plate's stiffness at its own wavelength: layer and teeth
are local springs, the contact is found where the pressure would otherwise pull (a quadratic programme, by Nesterov's
projected gradients), and friction is summed point by point.

    python -m studies.flange
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import trum_sym as ts
from trum_sym.inputs.checks import Array
from trum_sym.model.kernels import call

__all__ = ["alike", "pressed", "speed_at"]

_SAMPLES = 512
_STEPS = 4000


def _compliance(motor: ts.Motor, wavenumber: float) -> float:
    """Of layer, teeth and flange under a pressure of that wavenumber; a flange's of no length within rounding is 0."""
    values = motor.symbols()
    values |= call("trum_layer_stiffness", values)
    found = call("trum_contact_stiffness", {**values, "k_c": wavenumber})
    flange = float(found["k_flange"])
    return 1 / float(values["k_N"]) + 1 / float(found["k_tooth"]) + (1 / flange if np.isfinite(flange) else 0.0)


def pressed(motor: ts.Motor, height: float, prepressure: float, *, single: bool) -> tuple[Array, Array]:
    """Place u (rad) over a wavelength and the pressure there over its mean, (n,) each.

    Parameters
    ----------
    motor : Motor
        With a flange.
    height : float, m
        Of the wave.
    prepressure : float, N
    single : bool
        Whether the plate's stiffness under the wave's own length stands for all, as in the level.
    """
    k, crests = float(motor.crests.value / motor.radius.value), int(motor.crests.value)
    u = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES - np.pi
    mean = prepressure / (2 * np.pi * crests / k)
    orders = np.maximum(np.fft.rfftfreq(_SAMPLES, 1 / _SAMPLES), 1.0)  # the mean only moves the rotor up
    compliance = np.array([_compliance(motor, k * (1.0 if single else order)) for order in orders])
    return u, _least_energy(compliance, height * np.cos(u), mean) / mean


def _least_energy(compliance: Array, wave: Array, mean: float) -> Array:
    """The pressure, nowhere negative and of a given mean, under which the bodies just touch the wave."""
    now = ahead = np.full(wave.size, mean)
    momentum = 1.0
    for step in range(_STEPS):
        gap = np.fft.irfft(compliance * np.fft.rfft(ahead), wave.size) - wave
        found = _projected(ahead - gap / compliance.max(), mean)
        following = (1 + np.sqrt(1 + 4 * momentum**2)) / 2
        ahead = found + (momentum - 1) / following * (found - now)
        if step > 50 and np.abs(found - now).max() < 1e-9 * mean:
            return found
        now, momentum = found, following
    raise ArithmeticError("the contact does not settle")


def _projected(pressure: Array, mean: float) -> Array:
    """The nearest pressure that is nowhere negative and has the mean."""
    low, high = float(pressure.min()) - mean * pressure.size, float(pressure.max())
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if np.maximum(pressure - middle, 0).mean() > mean else (low, middle)
    return np.asarray(np.maximum(pressure - low, 0))


def speed_at(u: Array, pressure: Array, fraction: float) -> float:
    """Speed over the crest's at which rigid friction carries a fraction of its most."""
    surface = np.cos(u)
    order = np.argsort(surface, kind="stable")
    slower = (np.cumsum(pressure[order]) - pressure[order] / 2) / pressure.sum()
    return float(np.interp((1 - fraction) / 2, slower, surface[order]))


def alike(motor: ts.Motor, height: float, prepressure: float, fraction: float) -> float:
    """By how much stiffer one spring for the contact falls as far under a load as all harmonics do, 1 to 8 times.

    NaN where the whole wave touches: then the speed does not depend on the stiffness.
    """
    u, every = pressed(motor, height, prepressure, single=False)
    if every.min() > 0:
        return float("nan")
    wanted = speed_at(u, every, fraction) / speed_at(u, every, 0.0)
    single = _compliance(motor, float(motor.crests.value / motor.radius.value))
    mean = prepressure / (2 * np.pi * float(motor.radius.value))
    low, high = 1.0, 8.0
    for _ in range(12):
        middle = float(np.sqrt(low * high))
        pressure = _least_energy(np.full(_SAMPLES // 2 + 1, single / middle), height * np.cos(u), mean)
        found = speed_at(u, pressure, fraction) / speed_at(u, pressure, 0.0)
        low, high = (middle, high) if found < wanted else (low, middle)
    return middle


def main(say: Callable[[str], None] = print) -> None:
    """Print half-angle and speed under load by one spring and by all harmonics, and how stiff a spring is alike."""
    motor = ts.load_motor("trum60")
    say("flange mm  wave um  half-angle rad: one, all  speed at 49 % over none: one, all  at 56 %: one, all  alike")
    for length in (2e-3, 3e-3, 5e-3):
        for height in (1.8e-6, 3e-6, 5.56e-6):
            cells = []
            for single in (True, False):
                u, pressure = pressed(motor.with_values({"flange_length": length}), height, 180.0, single=single)
                free = speed_at(u, pressure, 0.0)
                touching = float(np.abs(u[pressure > 1e-6 * pressure.max()]).max())
                cells.append((touching, *(speed_at(u, pressure, share) / free for share in (0.49, 0.56))))
            pairs = "  ".join(f"{one:.3f} {every:.3f}" for one, every in zip(*cells, strict=True))
            stiffer = alike(motor.with_values({"flange_length": length}), height, 180.0, 0.49)
            say(f"{1e3 * length:9.0f}  {1e6 * height:7.2f}  {pairs}  {stiffer:.2f}")


if __name__ == "__main__":
    main()
