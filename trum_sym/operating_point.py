"""One operating point, or an array of them: motor and drive in, figures out."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from trum_sym.drive import Drive, choice
from trum_sym.errors import ParameterError
from trum_sym.kernels import call
from trum_sym.modal import check_steady_state, cycle_sums, modal_values
from trum_sym.motor import Motor
from trum_sym.stator import (
    AMPLITUDES,
    CONTACTS,
    FOUNDATIONS,
    RESONANCES,
    Amplitude,
    Contact,
    Foundation,
    Levels,
    Resonance,
    solve_stator,
)
from trum_sym.validate import ArrayLike, Domain, broadcast_shape, number

__all__ = ["OperatingPoint", "evaluate"]


@dataclass(frozen=True, kw_only=True)
class OperatingPoint:
    """What the motor does at a drive; SI units, frequencies in Hz, speeds in rad/s.

    Every number is a float, or an array of the inputs' common shape.  What needs the rotor model, which
    is not part of this version, is None: ``mean_speed`` and all below it.

    Attributes
    ----------
    motor, start, contact : str
        What the figures hold for.
    prepressure : N
    frequency_difference, resonance_frequency, drive_frequency : Hz
    cycle_time : s
        T_Qall, m drive periods.
    amplitude : m
        W_maxf, one phase's steady amplitude.
    neutral_axis : m
    wavenumber : 1/m
    q_ratio, q_square_ratio : 1
        X and Y, forward over backward, of Q and of its square; infinite when Q never turns back.
    q_average, q_volatility : 1/s
        Q_aver and Q_vib (eqs. 43, 44); the sign is the direction.
    """

    motor: str
    start: str
    contact: str
    prepressure: ArrayLike
    frequency_difference: ArrayLike
    resonance_frequency: ArrayLike
    drive_frequency: ArrayLike
    cycle_time: ArrayLike
    amplitude: ArrayLike
    neutral_axis: ArrayLike
    wavenumber: ArrayLike
    q_ratio: ArrayLike
    q_square_ratio: ArrayLike
    q_average: ArrayLike
    q_volatility: ArrayLike
    mean_speed: ArrayLike | None = None
    min_speed: ArrayLike | None = None
    max_speed: ArrayLike | None = None
    speed_volatility: ArrayLike | None = None
    stall_torque: ArrayLike | None = None
    contact_fraction: ArrayLike | None = None
    converged: bool | np.ndarray[tuple[int, ...], np.dtype[np.bool_]] | None = None

    def as_dict(self) -> dict[str, object]:
        """The figures by name, in the order of the fields."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def evaluate(
    motor: Motor,
    drive: Drive | None = None,
    *,
    contact: Contact = "winkler",
    resonance: Resonance = "quartic",
    foundation: Foundation = "harmonic",
    amplitude: Amplitude = "measured",
    sampling_period: ArrayLike | None = None,
) -> OperatingPoint:
    """The operating point of a motor under a drive.

    Parameters
    ----------
    motor : Motor
        Its parameters may be arrays.
    drive : Drive, optional
        The paper's Table 3 if not given.  Its fields and the motor's values broadcast.
    contact : {"winkler", "hertz"}
        How the half-angle of the contact follows from the prepressure (eqs. 25 to 31).
    resonance : {"quartic", "eq6", "printed", "euler"}
        Timoshenko's lower root, its truncation, eq. 6 as printed, Euler-Bernoulli.
    foundation : {"harmonic", "smeared", "printed", "none"}
        How the friction layer stiffens the stator.
    amplitude : {"measured", "forced"}
        Eq. 8 on the measured amplitude, or on the derived forced one (eq. 7 put right).
    sampling_period : float or array, s, optional
        Averaging period of the encoder behind ``speed_volatility``; continuous if not given.

    Returns
    -------
    OperatingPoint

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    ConvergenceError
        If the forced amplitude and the resonance do not settle.
    """
    for name, value, allowed in (
        ("contact", contact, CONTACTS),
        ("resonance", resonance, RESONANCES),
        ("foundation", foundation, FOUNDATIONS),
        ("amplitude", amplitude, AMPLITUDES),
    ):
        choice(name, value, allowed)
    drive = Drive() if drive is None else drive
    if not isinstance(motor, Motor):
        raise ParameterError("motor", motor, "a Motor, as load_motor returns it")
    if not isinstance(drive, Drive):
        raise ParameterError("drive", drive, "a Drive")
    inputs = {**drive.numbers(), **{name: p.value for name, p in motor.parameters()}}
    if sampling_period is not None:
        inputs["sampling_period"] = number("sampling_period", sampling_period, Domain(low=0.0), "s")
    shape = broadcast_shape(inputs)
    check_steady_state(motor.damping_ratio.value, drive)
    stator = solve_stator(motor, drive, Levels(contact, resonance, foundation, amplitude))
    values = modal_values(stator.omega_n, motor.damping_ratio.value, drive)
    timing = call("trum_drive", values)
    turn = 2 * np.pi
    figures: dict[str, ArrayLike] = {
        "prepressure": drive.prepressure,
        "frequency_difference": drive.frequency_difference,
        "resonance_frequency": np.asarray(stator.omega_n) / turn,
        "drive_frequency": np.asarray(timing["omega_q"]) / turn,
        "cycle_time": timing["T"],
        "amplitude": stator.W,
        "neutral_axis": stator.D,
        "wavenumber": stator.k_c,
        **cycle_sums(values),
    }
    shaped: dict[str, Any] = {name: _shaped(value, shape) for name, value in figures.items()}
    return OperatingPoint(motor=motor.name, start=drive.start, contact=contact, **shaped)


def _shaped(value: ArrayLike, shape: tuple[int, ...]) -> ArrayLike:
    return float(value) if shape == () else np.broadcast_to(np.asarray(value, np.float64), shape)
