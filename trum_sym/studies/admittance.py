"""Admittance of a phase over frequency: without a rotor, and under one that the wave drives."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Unpack

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.inputs.checks import Array, ArrayLike, number
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import one_number
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.kernels import call
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.port import Port, drawn, free_admittance, port_of
from trum_sym.text import one_line, plain

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["STATES", "admittance", "frequencies_of"]

STATES = ("free", "pressed")
_POINTS = Domain(low=2, low_open=False, high=100001, integer=True)
_HERTZ = Domain(low=0.0, high=1e9)
_TURN = 2 * np.pi
_BEYOND = 1000.0  # Hz, below and above both resonances
_UNITS = {
    "conductance": ("S", "real part of the admittance of a phase"),
    "susceptance": ("S", "imaginary part of the admittance of a phase"),
    "amplitude": ("m", "height of the wave at the motor's voltage"),
    "electric_power": ("W", "that both phases draw at the motor's voltage"),
}
_OF_PORT = {
    "force_factor": "N/V",
    "capacitance": "F",
    "inductance": "H",
    "motional_capacitance": "F",
    "resistance": "ohm",
    "resonance": "Hz",
    "open_resonance": "Hz",
    "coupling_factor": "1",
}


def frequencies_of(low: float, high: float, points: float) -> Array:
    """Evenly spaced frequencies, checked.

    Raises
    ------
    ParameterError
        For ends that do not rise, or fewer than two points.
    """
    count = int(one_number("points", points, "1", _POINTS))
    first, last = one_number("from", low, "Hz", _HERTZ), one_number("to", high, "Hz", _HERTZ)
    if not first < last:
        raise ParameterError("to", last, f"more than the first frequency, {first:g} Hz")
    return np.linspace(first, last, count)


def admittance(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    frequencies: ArrayLike | None = None,
    points: float = 201,
    **levels: Unpack[LevelChoice],
) -> xr.Dataset:
    """The admittance of a phase over frequency, without a rotor and under one.

    Under the rotor (``pressed``) both phases drive a plain wave at the motor's voltage, at which the contact is far
    from linear: of several steady states, the stable one of the highest wave is shown, and a wave that friction holds
    back draws the current of the capacitance alone.  Without one (``free``) a phase is a circuit that any voltage
    shows.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given; with ``piezo_permittivity``, and of plain numbers.
    drive : Drive, optional
        Its prepressure, load and phase lead count, those of Table 3 if not given; both phases are always on.
    frequencies : (n,) array, Hz, optional
        From 1 kHz below the free resonance to 1 kHz above that with open electrodes if not given.
    points : int
        How many, if no frequencies are given.
    resonance, amplitude, compliance
        As for :func:`trum_sym.evaluate`.  ``amplitude = "measured"`` has the modal force that makes the free amplitude,
        ``"forced"`` that of the ceramic's data.
    contact, foundation, tangential, coupling
        Refused but for their defaults here, ``"winkler"``, ``"harmonic"``, ``"rigid"`` and ``"contact"``: they have no
        effect.

    Returns
    -------
    xarray.Dataset
        Over ``state`` (free, pressed) and ``frequency`` (Hz): conductance, susceptance (S), amplitude (m),
        electric_power (W); over ``frequency`` states, the steady states under the rotor; and the circuit of the free
        phase: force_factor (N/V), capacitance, motional_capacitance (F), inductance (H), resistance (ohm), resonance
        and open_resonance (Hz), coupling_factor.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    MissingExtraError
        Without xarray.

    Examples
    --------
    >>> import trum_sym as ts
    >>> found = ts.admittance(frequencies=[38000.0, 38730.0, 39500.0], compliance="flange")
    >>> f"{1e9 * float(found.capacitance):.2f} nF, free to {float(found.open_resonance):.0f} Hz"
    '24.22 nF, free to 39616 Hz'
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise MissingExtraError("admittance", str(error.name), "data") from None
    motor = load_motor() if motor is None else motor
    given = Drive() if drive is None else drive
    if not isinstance(given, Drive):
        raise ParameterError("drive", given, "a Drive")
    chosen = _chosen(levels)
    whole = replace(given, periods=1, on_periods=1, start="periodic")
    values = coupled_values(motor, whole, chosen)
    port = port_of(values)
    axis = _axis(frequencies, points, port)
    free, pressed = _free(values, axis), _pressed(values, axis)
    return xr.Dataset(
        {
            **{
                name: (("state", "frequency"), np.stack([free[name], pressed[name]]), {"units": u, "long_name": m})
                for name, (u, m) in _UNITS.items()
            },
            "states": ("frequency", pressed["states"], {"units": "1", "long_name": "steady states under the rotor"}),
            **{name: ((), value, {"units": _OF_PORT[name]}) for name, value in asdict(port).items()},
        },
        coords={"state": list(STATES), "frequency": ("frequency", axis, {"units": "Hz"})},
        attrs={
            "title": f"{one_line(motor.name)}: admittance of a phase",
            "motor": plain(motor.name),
            "prepressure": float(np.asarray(given.prepressure)),
            "load_torque": float(np.asarray(given.load_torque)),
            "phase_lead": float(np.asarray(given.phase_lead)),
            "voltage": float(np.asarray(values["U_s"])),
            **{f"{name}_level": getattr(chosen, name) for name in ("resonance", "amplitude", "compliance")},
        },
    )


def _chosen(levels: LevelChoice) -> Levels:
    """Levels of the system that acts back; those without effect refused."""
    given: LevelChoice = {"coupling": "contact", **levels}
    chosen, usual = Levels(**given), Levels(coupling="contact")
    for name in ("contact", "foundation", "tangential", "coupling"):
        if getattr(chosen, name) != getattr(usual, name):
            raise ParameterError(name, getattr(chosen, name), f"{getattr(usual, name)} for an admittance")
    return chosen


def _axis(frequencies: ArrayLike | None, points: float, port: Port) -> Array:
    if frequencies is None:
        return frequencies_of(max(port.resonance - _BEYOND, 1.0), port.open_resonance + _BEYOND, points)
    one_number("points", points, "1", _POINTS)
    axis = np.atleast_1d(np.array(number("frequencies", frequencies, _HERTZ, "Hz")))
    if axis.ndim != 1:
        raise ParameterError("frequencies", f"an array of shape {axis.shape}", "a row of numbers")
    if np.any(np.diff(axis) <= 0):
        raise ParameterError("frequencies", plain(str(frequencies)), "numbers that rise")
    return axis


def _free(values: dict[str, ArrayLike], axis: Array) -> dict[str, Array]:
    """Without a rotor, where each phase is for itself."""
    conductance, susceptance = free_admittance(values, axis)
    nothing = {**values, "omega_q": _TURN * axis, "W": 1.0, "central": 0.0, "along": 0.0}
    stiffness = call("trum_plain_balance", nothing)
    size = np.hypot(np.asarray(stiffness["in_phase"]), np.asarray(stiffness["ahead"]))
    return {
        "conductance": conductance,
        "susceptance": susceptance,
        "amplitude": float(np.asarray(values["F_q"])) / size,
        "electric_power": float(np.asarray(values["U_s"])) ** 2 * conductance,
    }


def _pressed(values: dict[str, ArrayLike], axis: Array) -> dict[str, Array]:
    """Under the rotor, in the stable state of the highest wave; NaN where there is none."""
    found = {name: np.full(axis.size, np.nan) for name in (*_UNITS, "states")}
    for place, frequency in enumerate(axis):
        at = {**values, "omega_q": _TURN * frequency}
        waves = plain_waves(at)
        found["states"][place] = waves.amplitude.size
        if waves.highest < 0:
            continue
        draws = drawn(at, waves)
        found["amplitude"][place] = waves.amplitude[waves.highest]
        for name in ("conductance", "susceptance", "electric_power"):
            found[name][place] = getattr(draws, name)[waves.highest]
    return found
