"""A vibration after power-off: damping ratio and resonance from displacement, velocity or envelope against time.

The free motion is the cycle's own, in the region in which phase A is off: with no drive (W = 0) both phases move
freely from the states they are given, and their determinant (eq. A5) is, by Liouville's theorem, the square of the
envelope.  No formula of it stands here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.kernels import call

__all__ = ["SIGNAL_PARAMETERS", "Motion", "first_guess", "free_motion", "slopes_of"]

Motion = Callable[[Array, Array, Array], Array]  # what :func:`free_motion` gives, made a signal or an envelope

_TURN = 2 * np.pi
SIGNAL_PARAMETERS = ("cosine", "sine", "offset")  # what a signal has beside damping and resonance
_SEARCHED_DAMPING = np.geomspace(1e-4, 0.5, 40)
_OVERSAMPLING = 8  # of the spectrum in which the resonance is first sought


def free_motion(elapsed: Array, damping_ratio: ArrayLike, frequency: ArrayLike) -> tuple[Array, Array, Array]:
    """Free motions from unit displacement and from unit velocity over omega_n, and the envelope of both.

    Parameters
    ----------
    elapsed : (n,) array, s
        Since the record's first row.
    damping_ratio, frequency : float or array
        The frequency is the undamped one, omega_n / (2 pi), in Hz; arrays broadcast against the times.
    """
    omega_n = _TURN * np.asarray(frequency)
    lasting = 1.01 * float(elapsed[-1])  # m - n = 1 pulse of a drive so slow that A is off all the while
    found = call(
        "cycle_response",
        {
            "t": elapsed,
            "omega_n": omega_n,
            "Delta_omega": _TURN / lasting - omega_n,
            "xi": damping_ratio,
            "psi": 0.0,
            "s": 1.0,
            "m": 2.0,
            "n": 1.0,
            "a_A": 1.0,
            "b_A": 0.0,
            "a_B": 0.0,
            "b_B": 1.0,
            "W": 0.0,
            "D": 1.0,
            "k_c": 1.0,
        },
    )
    return np.asarray(found["w_A"]), np.asarray(found["w_B"]) * omega_n, np.sqrt(-np.asarray(found["Q"]))


def slopes_of(model: Motion, elapsed: Array, damping_ratio: float, frequency: float) -> tuple[Array, Array]:
    """Derivatives of a model of the free motion by damping ratio and frequency.

    Parameters
    ----------
    model : callable
        From :func:`free_motion`'s three arrays to one.
    elapsed, damping_ratio, frequency
        As there.
    """
    # steps that turn the phase and change the decay by about 1e-5 at the record's end: errors of 1e-10
    turns = _TURN * frequency * float(elapsed[-1])
    step = min(1e-5 / turns, 1e-4)
    up, down = min(damping_ratio + step, 1 - 1e-12), max(damping_ratio - step, 0.0)

    def at(damping: float, f: float) -> Array:
        return model(*free_motion(elapsed, damping, f))

    by_damping = (at(up, frequency) - at(down, frequency)) / (up - down)
    high, low = frequency * (1 + step), frequency * (1 - step)
    return by_damping, (at(damping_ratio, high) - at(damping_ratio, low)) / (high - low)


def first_guess(elapsed: Array, signal: Array, expected: float) -> tuple[float, float]:
    """Damping ratio and frequency near which a signal's best fit lies: the spectrum's peak, and the best of some.

    Raises
    ------
    ParameterError
        If the rows are too few or too far apart to show the vibration.
    """
    if elapsed.size < 2:
        raise ParameterError("data", "1 row of a decay", "at least 2, to tell how the vibration goes on")
    spacing = float(np.max(np.diff(elapsed)))
    if spacing > 0.5 / expected:
        allowed = f"less than half a period of the resonance, {0.5 / expected:.3g} s"
        raise ParameterError("time", f"rows up to {spacing:.3g} s apart", allowed)
    count = max(elapsed.size, int(np.ceil(elapsed[-1] / float(np.median(np.diff(elapsed))))) + 1)
    even = np.interp(np.linspace(0.0, elapsed[-1], count), elapsed, signal - np.mean(signal))
    spectrum = np.abs(np.fft.rfft(even, _OVERSAMPLING * count))
    bin_width = (count - 1) / elapsed[-1] / (_OVERSAMPLING * count)
    peak = bin_width * max(int(np.argmax(spectrum)), 1)
    best = (np.inf, 0.0)
    for damping in _SEARCHED_DAMPING:
        cosine, sine, _ = free_motion(elapsed, damping, peak)
        basis = np.stack([cosine, sine, np.ones_like(signal)], axis=1)
        weights, *_ = np.linalg.lstsq(basis, signal, rcond=None)
        best = min(best, (float(np.sum((basis @ weights - signal) ** 2)), float(damping)))
    return best[1], peak
