"""The electrical port of a phase: force factor, capacitance, equivalent circuit, admittance, what a plain wave draws.

The formulas are those of derivations/port.py.  The force factor is the modal force at hand over the voltage, so that
with ``amplitude = "measured"`` it is that of the free amplitude, which the motor file states at its voltage.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.coupling import PlainWaves
from trum_sym.model.kernels import call

__all__ = ["Drawn", "Port", "drawn", "free_admittance", "has_port", "open_stiffness", "port_of"]

Values = Mapping[str, ArrayLike]
_TURN = 2 * np.pi


@dataclass(frozen=True)
class Port:
    """A phase without a rotor as a circuit: the capacitance beside inductance, capacitance and resistance in series.

    Attributes
    ----------
    force_factor : float, N/V
        Modal force per volt, and charge per displacement.
    capacitance : float, F
        Of the phase, its stator held still.
    inductance, motional_capacitance, resistance : float, H, F, ohm
        Of the motion.
    resonance, open_resonance : float, Hz
        At which the phase swings with short and with open electrodes: series and parallel resonance.  With open
        electrodes a square of angular frequencies is larger by force_factor^2 / (capacitance * modal mass), under
        prepressure too.
    coupling_factor : float
        Effective one, sqrt(1 - (resonance / open_resonance)^2).
    """

    force_factor: float
    capacitance: float
    inductance: float
    motional_capacitance: float
    resistance: float
    resonance: float
    open_resonance: float
    coupling_factor: float


@dataclass(frozen=True)
class Drawn:
    """What plain waves draw; every field an array over the waves, SI.

    Attributes
    ----------
    conductance, susceptance : (k,) array, S
        Of one phase, at its voltage.
    current : (k,) array, A
        Amplitude of a phase's.
    electric_power, dielectric_power : (k,) array, W
        Mean of both phases together; what of it the ceramic's loss takes.
    reactive_power : (k,) array, W
        Of both phases; positive where the current is behind the voltage.
    power_factor : (k,) array
        Active power over the product of effective voltage and current.
    """

    conductance: Array
    susceptance: Array
    current: Array
    electric_power: Array
    dielectric_power: Array
    reactive_power: Array
    power_factor: Array


def has_port(values: Values) -> bool:
    """Whether the motor file says what the capacitance takes."""
    return "eps_33T" in values


def _full(values: Values) -> dict[str, ArrayLike]:
    """Values with force factor and capacitance.

    Raises
    ------
    ParameterError
        Where the permittivity is not known, or is not more than d_31 and s_11E leave of it.
    """
    if not has_port(values):
        raise ParameterError("piezo_permittivity", "nothing", "a value in the motor file, or by --set")
    given = {"tan_delta": 0.0, **values}
    found = {**given, **call("trum_port", given)}
    least = float(np.asarray(given["d_31"])) ** 2 / float(np.asarray(given["s_11E"]))
    if not np.asarray(found["C_0"]) > 0:
        raise ParameterError(
            "piezo_permittivity",
            float(np.asarray(given["eps_33T"])),
            f"more than d_31^2 / s_11E, {least:.6g} F/m: the ceramic would have a coupling factor above 1",
        )
    return found


def port_of(values: Values) -> Port:
    """The circuit of a phase.

    Parameters
    ----------
    values : mapping
        From :func:`trum_sym.model.coupling.coupled_values`, of a motor whose file has ``piezo_permittivity``.

    Raises
    ------
    ParameterError
        Without a permittivity, or for one that is too small.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.coupling import coupled_values
    >>> from trum_sym.model.levels import Levels
    >>> levels = Levels(amplitude="forced", coupling="contact")
    >>> values = coupled_values(ts.load_motor(), ts.Drive(on_periods=20), levels)
    >>> found = port_of(values)
    >>> f"{found.force_factor:.3f} N/V, {1e9 * found.capacitance:.2f} nF, k_eff {found.coupling_factor:.3f}"
    '1.180 N/V, 24.22 nF, k_eff 0.169'
    """
    full = _full(values)
    circuit = {name: float(np.asarray(value)) for name, value in call("trum_port_circuit", full).items()}
    return Port(
        force_factor=float(np.asarray(full["Theta_q"])),
        capacitance=float(np.asarray(full["C_0"])),
        inductance=circuit["L_m"],
        motional_capacitance=circuit["C_m"],
        resistance=circuit["R_m"],
        resonance=float(np.asarray(full["omega_n0"])) / _TURN,
        open_resonance=circuit["omega_open"] / _TURN,
        coupling_factor=float(np.sqrt(circuit["k_eff_square"])),
    )


def open_stiffness(values: Values) -> float:
    """What the voltage of open electrodes adds to a phase's stiffness, N/m: force_factor^2 / capacitance.

    Parameters
    ----------
    values
        As for :func:`port_of`.

    Raises
    ------
    ParameterError
        As :func:`port_of` does.
    """
    return float(np.asarray(call("trum_port_open", _full(values))["K_o"]))


def free_admittance(values: Values, frequencies: Array) -> tuple[Array, Array]:
    """Conductance and susceptance of a phase without a rotor, in S, by frequency in Hz.

    Parameters
    ----------
    values, frequencies
        As for :func:`port_of`; (n,) array.
    """
    found = call("trum_free_admittance", {**_full(values), "omega_q": _TURN * frequencies})
    return np.asarray(found["conductance"]), np.asarray(found["susceptance"])


def drawn(values: Values, waves: PlainWaves) -> Drawn:
    """What the phases draw in each of a plain wave's states.

    Parameters
    ----------
    values, waves
        From :func:`trum_sym.model.coupling.coupled_values` and :func:`trum_sym.model.coupling.plain_waves`.

    Raises
    ------
    ParameterError
        As :func:`port_of` does.
    """
    found = call("trum_plain_port", {**_full(values), "W": waves.amplitude, "lead": waves.lead})
    given = {name: np.broadcast_to(np.asarray(value), waves.amplitude.shape) for name, value in found.items()}
    return Drawn(
        conductance=given["conductance"],
        susceptance=given["susceptance"],
        current=given["current"],
        electric_power=given["P_electric"],
        dielectric_power=given["P_dielectric"],
        reactive_power=given["P_reactive"],
        power_factor=given["power_factor"],
    )
