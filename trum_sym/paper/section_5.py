"""Claims of Sect. 5: how the surface's particles move in the three regions."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.model.kernels import call
from trum_sym.paper.findings import Beat, Check, Context, Finding, rank_correlation
from trum_sym.paper.readings import DEFAULT, POINTS

__all__ = ["ADD", "ADDREDU", "CHECKS", "REDU", "half_angles"]

_M, _N, _N_ADD = 100, 55, 75  # Sects. 5.2.1, 5.2.3
_DIFFERENCE = 3000.0
_FOLLOWS = 0.9  # rank correlation from which one curve is said to follow another
REDU, ADDREDU, ADD = 0, 1, 2


def _percent(share: Array | float) -> str:
    return f"{100 * float(share):.3g} %"


def _number_of_beats(c: Context, name: str) -> Finding:
    resonance = c.readings.resonance_frequency[:, POINTS.table_3]
    beats = (_M - _N) / (resonance + _DIFFERENCE) * _DIFFERENCE
    one = beats[DEFAULT]
    if name == "T_addredu":  # the beat of eqs. (14), (15), which is twice as long
        return Finding(
            (np.abs(beats - 1) < 0.5) | (np.abs(beats / 2 - 1) < 0.5),
            f"{name} lasts {_M - _N} drive periods, {one:.2f} beats, or {one / 2:.2f} of those of eqs. (14), (15), "
            f"twice as long; {beats.min() / 2:.2f} to {beats.max() / 2:.2f} of the latter over all resonance levels",
        )
    return Finding(
        np.abs(beats - 1) < 0.5,
        f"{name} lasts m - n = {_M - _N} drive periods, {one:.2f} beats of 1/{_DIFFERENCE:.0f} s "
        f"({beats.min():.2f} to {beats.max():.2f} over all resonance levels)",
    )


def _quarters(beat: Beat) -> Array:
    """Signs of the integral of Q over each quarter of the beat that ``beat`` covers, on a new last axis."""
    parts = np.array_split(beat.Q, 4, axis=-1)
    return np.stack([np.sign(part.sum(axis=-1)) for part in parts], axis=-1)


def _pattern(c: Context, region: int, expected: tuple[int, ...], span: float = 1.0) -> Finding:
    signs = _quarters(c.beat((_M, _N), region, span, 16, all_levels=True))
    holds = (signs == np.array(expected)).all(axis=-1)
    words = {1: "+", -1: "-", 0: "0"}
    shown = [
        f"{start} {' '.join(words[int(s)] for s in signs[i, 0, 0, DEFAULT])}"
        for i, start in enumerate(("periodic", "steady", "rest"))
    ]
    return Finding(
        holds,
        f"sign of Q's integral over the quarters of the first {1e3 * span / _DIFFERENCE:.3f} ms, lead +1, "
        f"stated {' '.join(words[s] for s in expected)}: {', '.join(shown)}",
    )


def _pattern_addredu(c: Context) -> Finding:
    """With the exact beat, and with that of eqs. (14), (15), which is twice as long."""
    exact, printed = (_pattern(c, ADDREDU, (-1, -1, 1, 1), span) for span in (1.0, 2.0))
    return Finding(
        exact.holds | printed.holds, f"{exact.computed}; with the beat of eqs. (14), (15): {printed.computed}"
    )


def _turning(c: Context, region: int, on_periods: int) -> Finding:
    """The sense in which the particle's path turns, from its positions alone, against the sign of Q."""
    beat = c.beat((_M, on_periods), region, np.inf, 64)
    across, up = beat.w_A, beat.w_B  # eq. 11 at x = 0; D k_c > 0 stretches the path and turns nothing
    turn = across[..., 1:] * up[..., :-1] - up[..., 1:] * across[..., :-1]
    middle = 0.5 * (beat.Q[..., 1:] + beat.Q[..., :-1])
    clear = np.abs(middle) > 1e-3 * np.abs(middle).max(axis=-1, keepdims=True)
    same = np.sign(turn) == np.sign(middle)
    wrong = (clear & ~same).sum(axis=-1)
    return Finding(
        wrong == 0,
        f"the sampled path turns as Q's sign says at {_percent(1 - wrong.sum() / clear.sum())} of "
        f"{int(clear.sum())} samples where |Q| exceeds a thousandth of its largest",
        levels=(DEFAULT,),
    )


def _crest(c: Context, region: int, on_periods: int) -> Finding:
    """Q against the speed at the crest, over time."""
    beat = c.beat((_M, on_periods), region, np.inf, 32)
    height = np.hypot(beat.w_A, beat.w_B)
    found = rank_correlation(beat.Q, beat.Q / height)
    cells = [f"{start} {found[i, 0, 0, 0]:.3f}" for i, start in enumerate(("periodic", "steady", "rest"))]
    return Finding(
        found >= _FOLLOWS,
        f"v_xmax = Q/zeta_zmax (eq. 42) has Q's sign always; rank correlation over the region, lead +1: "
        f"{', '.join(cells)}; said to follow from {_FOLLOWS}",
        levels=(DEFAULT,),
    )


def _beat_in_add(c: Context) -> Finding:
    beat = c.beat((_M, _N_ADD), ADD, np.inf, 32)
    resonance = float(c.readings.resonance_frequency[DEFAULT, POINTS.table_3])
    carrier = 2 / (2 * resonance + _DIFFERENCE)  # 4 pi/(omega_q + omega_n)
    spacing = np.full(beat.Q.shape[:-1], np.nan)
    for index in np.ndindex(spacing.shape):
        spacing[index] = _envelope_period(beat, index, resonance + _DIFFERENCE / 2)
    seen = float(np.nanmean(spacing))
    return Finding(
        np.abs(spacing / carrier - 1) < 0.2,
        f"4 pi/(omega_q + omega_n) is {1e6 * carrier:.1f} us, the vibration's own period; the displacement's envelope "
        f"at x = 0 has minima every {1e6 * seen:.0f} us on average, one beat being {1e6 / _DIFFERENCE:.0f} us",
        levels=(DEFAULT,),
    )


def _envelope_period(beat: Beat, index: tuple[int, ...], frequency: float) -> float:
    """Mean spacing of the minima of the envelope of w_B; NaN if there are not two."""
    w, v, time = beat.w_B[index], beat.v_B[index], beat.time[index]
    size = w**2 + (v / (2 * np.pi * frequency)) ** 2
    width = round(1 / frequency / (time[1] - time[0]))  # the ripple at twice the frequency is averaged away, twice
    window = np.convolve(np.ones(width), np.ones(width)) / width**2
    smooth = np.convolve(size, window, "valid")
    inner = smooth[1:-1]
    minima = np.flatnonzero((inner < smooth[:-2]) & (inner <= smooth[2:]))
    return float(np.diff(time[minima]).mean()) if minima.size > 1 else np.nan


def _cause(c: Context) -> Finding:
    """Whether the beat in T_add follows the frequency difference: B's free part against its forced part."""
    difference = []
    for step in (0.5, 1.0):
        drive_ = _DIFFERENCE * step
        difference.append(_node_spacing(c, drive_))
    ratio = difference[0] / difference[1]
    return Finding(
        np.full((1, 1, 1, 1), abs(ratio - 1) < 0.2),
        f"minima of phase B's envelope follow every {1e6 * difference[1]:.0f} us at 3000 Hz and every "
        f"{1e6 * difference[0]:.0f} us at 1500 Hz: {ratio:.2f} times as long at half of the difference (start "
        "rest, m = 400, n = 300, so that there are several)",
        levels=(DEFAULT,),
    )


def _node_spacing(c: Context, difference: float) -> float:
    from trum_sym.inputs.drive import Drive
    from trum_sym.model.cycle import modal_values, response

    resonance = float(c.readings.resonance_frequency[DEFAULT, POINTS.table_3])
    drive = Drive(frequency_difference=difference, periods=400, on_periods=300, start="rest")
    values = modal_values(2 * np.pi * resonance, c.motor.damping_ratio.value, drive)
    regions = call("trum_regions", values)
    begin = float(np.asarray(regions["time_redu"])) + float(np.asarray(regions["time_addredu"]))
    length = min(float(np.asarray(regions["time_add"])), 3.4 / difference)
    time = begin + length * (np.arange(6000) + 0.5) / 6000
    found = {name: np.asarray(value) for name, value in response(time, values).items()}
    beat = Beat(time - begin, *(found[name] for name in ("w_A", "w_B", "v_A", "v_B", "Q")))
    return _envelope_period(beat, (...,), resonance + difference / 2)  # type: ignore[arg-type]


def _forward(c: Context) -> Finding:
    beat = c.beat((_M, _N_ADD), ADD, np.inf, 12, all_levels=True)
    back = (beat.Q < 0).mean(axis=-1)
    cells = [
        f"start {start}, lead {lead}: {_percent(back[i, j, 0, DEFAULT])}"
        for i, start in enumerate(("periodic", "steady", "rest"))
        for j, lead in enumerate(("+1", "-1"))
    ]
    return Finding(back == 0, f"share of T_add (n = {_N_ADD}) in which the particle turns backward: {'; '.join(cells)}")


def half_angles(c: Context) -> Array:
    """Contact half-angle over the cycle of Table 3, rad, by (start, phase lead, switching phase, 1, time)."""
    symbols = c.motor.symbols()
    touching = {
        **call("trum_layer_stiffness", symbols),
        **call("trum_wavenumber", symbols),
        "F_c": 180.0,
        "n_j": c.motor.crests.value,
        "W": _heights(c),
    }
    return np.asarray(call("contact_half_angle", touching)["theta"])


def _heights(c: Context) -> Array:
    """Height of the crest over the cycle of Table 3, m."""
    beats = (c.beat((20, 14), region, np.inf, 64) for region in (REDU, ADDREDU, ADD))
    size = float(c.readings.amplitude[DEFAULT, POINTS.table_3])
    return size * np.concatenate([np.hypot(beat.w_A, beat.w_B) for beat in beats], axis=-1)


def _contact(c: Context) -> Finding:
    """Contact half-angle over the cycle of Table 3."""
    share = half_angles(c) / np.pi
    return Finding(
        np.full((1, 1, 1, 1), share.min() > 0),
        f"over Table 3's cycle, all starts and leads, the contact's half-angle is {_percent(share.min())} to "
        f"{_percent(share.max())} of half a wave; the crest is never lower than {1e9 * _heights(c).min():.2g} nm",
        levels=(DEFAULT,),
    )


def _everywhere(c: Context) -> Finding:
    """Direction and crest speed over the whole cycle of Table 3."""
    parts = [c.beat((20, 14), region, np.inf, 64) for region in (REDU, ADDREDU, ADD)]
    Q = np.concatenate([part.Q for part in parts], axis=-1)
    height = np.concatenate([np.hypot(part.w_A, part.w_B) for part in parts], axis=-1)
    found = rank_correlation(Q, Q / height)
    turning = [_turning(c, region, on).holds for region, on in ((REDU, _N), (ADDREDU, _N), (ADD, _N_ADD))]
    return Finding(
        np.all(turning, axis=0) & (found >= _FOLLOWS),
        f"Table 3's cycle: rank correlation of Q with v_xmax {found.min():.3f} to {found.max():.3f} over starts, leads "
        "and switching phases; the rotation has Q's sign in all three regions",
        levels=(DEFAULT,),
    )


CHECKS: Mapping[str, Check] = {
    "beats-redu": lambda c: _number_of_beats(c, "T_redu"),
    "signs-redu": lambda c: _pattern(c, REDU, (1, -1, -1, 1)),
    "turns-redu": lambda c: _turning(c, REDU, _N),
    "crest-redu": lambda c: _crest(c, REDU, _N),
    "beats-addredu": lambda c: _number_of_beats(c, "T_addredu"),
    "signs-addredu": _pattern_addredu,
    "turns-addredu": lambda c: _turning(c, ADDREDU, _N),
    "crest-addredu": lambda c: _crest(c, ADDREDU, _N),
    "beat-add": _beat_in_add,
    "cause-add": _cause,
    "forward-add": _forward,
    "crest-add": lambda c: _crest(c, ADD, _N_ADD),
    "reflects": _everywhere,
    "in-contact": _contact,
}
