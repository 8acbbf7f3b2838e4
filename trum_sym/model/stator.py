"""The stator under prepressure: section, resonance and amplitude (Sect. 2)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trum_sym.errors import ConvergenceError, ParameterError, ValidityWarning
from trum_sym.inputs.checks import ArrayLike, outside
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import FLANGE, Motor
from trum_sym.model.kernels import call
from trum_sym.model.levels import Contact, Levels

__all__ = ["Stator", "above_free", "solve_stator", "warn_outside_fit"]

_TURN = 2 * np.pi
_MAX_ITERATIONS = 200


@dataclass(frozen=True)
class Stator:
    """The stator at a prepressure, in SI; each value a float or an array.

    Attributes
    ----------
    omega_n : angular resonance, rad/s
    W : amplitude of one phase, m
    D : neutral axis from the tooth surface, m
    k_c : wavenumber, 1/m
    values : all of it by symbol, with the section and the layer
    """

    omega_n: ArrayLike
    W: ArrayLike
    D: ArrayLike
    k_c: ArrayLike
    values: Mapping[str, ArrayLike]


def _contact_half_angle(contact: Contact, values: dict[str, ArrayLike]) -> ArrayLike:
    if contact == "winkler":
        return call("contact_half_angle", values)["theta"]
    theta: ArrayLike = np.minimum(call("trum_hertz_half_angle", values)["theta"], np.pi)
    return theta


def warn_outside_fit(motor: Motor, drive: Drive) -> None:
    """Warn of a prepressure at which eq. 8's amplitude was not measured."""
    low, high = motor.fit_prepressure_min.value, motor.fit_prepressure_max.value
    force = np.asarray(drive.prepressure)
    beyond = outside(force, low, high)
    if beyond.any():
        worst = np.broadcast_to(force, beyond.shape)[beyond].flat[0]
        message = (
            f"prepressure: {worst:g} N lies outside {np.min(low):g} to {np.max(high):g} N, "
            "where eq. 8's amplitude was measured"
        )
        warnings.warn(message, ValidityWarning, stacklevel=5)


def above_free(motor: Motor) -> list[str]:
    """What to say where eq. 8 gives a motor more than its free amplitude, within the prepressures of its fit."""
    least = motor.fit_prepressure_min.value
    amplitude = np.asarray(call("trum_amplitude_measured", {**motor.symbols(), "F_c": least})["W"])
    force, found, free = np.broadcast_arrays(least, amplitude, motor.free_amplitude.value)
    wrong = found > free * (1 + 1e-9)
    if not wrong.any():
        return []
    n, w, most = (float(values[wrong].flat[0]) for values in (force, found, free))
    return [
        f"amplitude_factor: eq. 8 gives {1e6 * w:.6g} um at {n:.6g} N, the least prepressure of its fit, more than "
        f"free_amplitude, {1e6 * most:.6g} um"
    ]


def _check_size(name: str, value: ArrayLike) -> None:
    """Raise a ParameterError unless what follows from the motor's values is finite and positive."""
    values = np.asarray(value)
    good = np.isfinite(values) & (values > 0)
    if not good.all():
        raise ParameterError("motor", f"{name} = {values[~good].flat[0]:g}", "values that give it a finite size")


def _check_prepressure(drive: Drive, values: Mapping[str, ArrayLike]) -> None:
    """Raise a ParameterError where eq. 8, a falling power, gives no wave: one higher than it is long."""
    height, force = np.broadcast_arrays(np.multiply(values["W"], values["k_c"]), drive.prepressure)
    wrong = ~(height < 1)
    if wrong.any():
        allowed = "a force at which eq. 8 gives an amplitude below 1/wavenumber; or set the motor's amplitude"
        raise ParameterError("prepressure", f"{force[wrong].flat[0]:g}", allowed)


def _check_drive_frequency(omega_n: ArrayLike, drive: Drive) -> None:
    """Raise a ParameterError unless the drive frequency is at least a tenth of the resonance."""
    f_n, difference = np.broadcast_arrays(np.asarray(omega_n) / _TURN, drive.frequency_difference)
    wrong = ~(f_n + difference >= 0.1 * f_n)
    if wrong.any():
        raise ParameterError(
            "frequency_difference",
            f"{difference[wrong].flat[0]:g}",
            f"at least -0.9 times the resonance, {f_n[wrong].flat[0]:.6g} Hz",
        )


def solve_stator(motor: Motor, drive: Drive, levels: Levels, *, warn: bool = True) -> Stator:
    """Resonance and amplitude under prepressure at the chosen levels.

    The layer's stiffness depends on the amplitude through the contact, and the forced amplitude on the
    resonance: then both are iterated until the amplitude settles.  ``warn`` says whether a prepressure outside the
    range of eq. 8's fit is worth a warning.

    Raises
    ------
    ParameterError
        If the drive frequency is not well above zero, a value cannot be computed, or the wave is not to be prescribed.
    ConvergenceError
        If forced amplitude and resonance do not settle.
    """
    levels.check_prescribed()
    values = motor.symbols()
    for name in ("trum_neutral_axis", "trum_wavenumber", "trum_layer_stiffness"):
        values = {**call(name, values), **values}
    _contact_stiffness(motor, values, levels)
    values.update(call("trum_section", values))
    values.update(F_c=drive.prepressure, Delta_omega=_TURN * np.asarray(drive.frequency_difference))

    fixed = values.get("W_maxf")
    if fixed is None and warn:
        warn_outside_fit(motor, drive)
    values["W"] = fixed if fixed is not None else call("trum_amplitude_measured", values)["W"]
    for _ in range(_MAX_ITERATIONS):
        _resonance(motor, values, levels)
        _check_size("resonance_frequency", values["omega_n"])
        _check_drive_frequency(values["omega_n"], drive)
        if fixed is not None or levels.amplitude == "measured":
            break
        previous = values["W"]
        found = np.asarray(call("trum_amplitude_forced", values)["W"])
        settled = np.abs(found - previous) <= 1e-13 * found
        values["W"] = np.where(settled, previous, found)  # a point in a batch stays where it would stop alone
        if settled.all():
            break
    else:
        raise ConvergenceError(
            f"forced amplitude and resonance did not settle in {_MAX_ITERATIONS} steps; "
            "set amplitude or resonance_frequency, or use another foundation"
        )
    for name, symbol in (("amplitude", "W"), ("neutral_axis", "D"), ("wavenumber", "k_c")):
        _check_size(name, values[symbol])
    if fixed is None:
        _check_prepressure(drive, values)
    return Stator(values["omega_n"], values["W"], values["D"], values["k_c"], values)


def _contact_stiffness(motor: Motor, values: dict[str, ArrayLike], levels: Levels) -> None:
    """Let k_N in ``values`` be the stiffness of the whole contact: as measured, or in series with teeth and flange.

    Raises
    ------
    ParameterError
        If the motor says nothing of its flange, or the series has no size.
    """
    if motor.contact_stiffness is None:
        if levels.compliance == "layer":
            return
        for name in FLANGE:
            if getattr(motor, name) is None:
                raise ParameterError(name, "nothing", "a value in the motor file where compliance is flange")
        values.update(call("trum_contact_stiffness", values))
    _check_size("contact_stiffness", values["k_con"])
    values["k_N"] = values["k_con"]


def _resonance(motor: Motor, values: dict[str, ArrayLike], levels: Levels) -> None:
    """Update theta, k_f, beta, omega_n and omega_q in ``values`` for the amplitude W there."""
    stiffness: ArrayLike = 0.0
    if levels.foundation != "none":
        values["theta"] = _contact_half_angle(levels.contact, values)
        stiffness = call("trum_foundation", values)[levels.foundation]
    values.update(k_f=stiffness, k_dx=stiffness)  # "printed" uses k_dx's number as it stands, in any level
    modes = call("trum_resonance", values)
    measured = motor.resonance_frequency
    values["omega_n"] = modes[levels.resonance] if measured is None else _TURN * np.asarray(measured.value)
    values["beta"] = modes["beta"]
    values["omega_q"] = np.add(values["omega_n"], values["Delta_omega"])
