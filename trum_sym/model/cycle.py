"""Modal responses of the two phases over a drive cycle, and what the determinant sums to (Sects. 3, 6)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.model.batch import call_in_blocks
from trum_sym.model.kernels import call

__all__ = ["check_steady_state", "cycle_sums", "lack_of_damping", "modal_values", "response", "scaled"]

_MIN_REPETITION = 1e-9
_FREE = 10.0  # times the forced amplitude: the free vibration of TRUM-60 is at most twice that
_BEAT = 1e-2  # of a beat in a cycle: the drive is at the resonance as far as the cycle can tell
PANELS_PER_PERIOD = 2
_SMALLEST = 64  # points whose sums are not worth sharing out


def check_steady_state(damping_ratio: ArrayLike, drive: Drive) -> None:
    """Raise a ParameterError for an undamped drive at resonance."""
    if np.any((np.asarray(damping_ratio) == 0) & (np.asarray(drive.frequency_difference) == 0)):
        raise ParameterError(
            "damping_ratio", 0, "a number > 0 when frequency_difference is 0 Hz: undamped resonance has no steady state"
        )


def modal_values(
    omega_n: ArrayLike, damping_ratio: ArrayLike, drive: Drive, amplitude: ArrayLike = 1.0
) -> dict[str, ArrayLike]:
    """The kernels' arguments for a drive cycle, with the free motion before t1 that ``drive.start`` asks for.

    Raises
    ------
    ParameterError
        For an undamped resonant drive, or a periodic start that the cycle does not fix.
    """
    check_steady_state(damping_ratio, drive)
    values: dict[str, ArrayLike] = {
        "omega_n": omega_n,
        "Delta_omega": 2 * np.pi * np.asarray(drive.frequency_difference),
        "xi": damping_ratio,
        "psi": drive.switching_phase,
        "s": drive.phase_lead,
        "m": drive.periods,
        "n": drive.on_periods,
        "W": amplitude,
    }
    if drive.start == "steady":
        return {**values, "a_A": 0.0, "b_A": 0.0, "a_B": 0.0, "b_B": 0.0}
    if drive.start == "rest":
        return {**values, **call("trum_start_rest", values)}
    start = call("trum_start_periodic", values)
    if np.any(np.asarray(start.pop("repetition")) < _MIN_REPETITION):
        raise ParameterError(
            "start",
            "periodic, but the free vibration comes back undamped and in phase every cycle",
            "more damping, another frequency_difference or periods, or start = steady or rest",
        )
    return {**values, **start}


def lack_of_damping(values: Mapping[str, ArrayLike]) -> str | None:
    """What to say where a lack of damping, not the motor, makes the figures of :func:`modal_values`' points.

    That is without damping less than a hundredth of a beat from the resonance, where a cycle has no steady state, and
    where a cycle repeats its own free vibration so nearly that it grows to ten times the forced one.
    """
    omega, difference, damping = (np.asarray(values[name]) for name in ("omega_n", "Delta_omega", "xi"))
    with np.errstate(all="ignore"):
        beats = np.abs(difference) * np.asarray(values["m"]) / (omega + difference)
        free = [np.hypot(values[f"a_{phase}"], values[f"b_{phase}"] / omega) for phase in ("A", "B")]
        times = np.maximum(*free) / np.asarray(values["W"])
    if np.any((damping == 0) & (beats < _BEAT)):
        message = "damping_ratio: 0 so near the resonance, where an undamped drive has no steady state"
    elif np.any(times > _FREE):
        message = (
            f"damping_ratio: so little that the free vibration is {np.max(times):.3g} times the forced one, for a "
            "cycle repeats it nearly in phase"
        )
    else:
        return None
    return f"{message}; the figures are the lack of damping's, not a motor's"


def scaled(values: dict[str, ArrayLike], amplitude: ArrayLike) -> dict[str, ArrayLike]:
    """The arguments of another amplitude: the phases are linear, so the free motion scales with it."""
    lengths = {name: np.multiply(values[name], amplitude) for name in ("W", "a_A", "b_A", "a_B", "b_B")}
    return {**values, **lengths}


def response(
    time: ArrayLike, values: dict[str, ArrayLike], D: ArrayLike = 1.0, k_c: ArrayLike = 1.0
) -> dict[str, ArrayLike]:
    """w_A, w_B (m), v_A, v_B (m/s) and the determinant Q (m^2/s) at times within one cycle (eqs. 9, 10, A5).

    Parameters
    ----------
    time : float or array, s
        Since t1, from 0 to the cycle time; broadcasts with the values.
    values : dict
        From :func:`modal_values`.
    D, k_c : float or array
        Neutral axis (m) and wavenumber (1/m), which scale Q.
    """
    return call("cycle_response", {**values, "t": time, "D": D, "k_c": k_c})


def cycle_sums(values: dict[str, ArrayLike], panels_per_period: float = PANELS_PER_PERIOD) -> dict[str, ArrayLike]:
    """Speed determinants of a cycle: q_ratio, q_square_ratio, q_average, q_volatility (eqs. 43, 44).

    The sums are integrals over time, by 12-point Gauss-Legendre quadrature cut at every sign change of Q;
    ``panels_per_period`` panels cover a period of the faster of drive and resonance.
    """
    sums = call_in_blocks("cycle_sums", {**values, "panels": panels_per_period}, smallest=_SMALLEST)
    return call("trum_measures", {**sums, **call("trum_drive", values)})
