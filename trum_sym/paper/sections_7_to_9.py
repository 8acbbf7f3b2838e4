"""Claims of Sects. 7 to 9: vibration measured, speed measured, conclusions."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Mapping

import numpy as np

from trum_sym.errors import ValidityWarning
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import STARTS, Drive
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import modal_values, response
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import evaluate
from trum_sym.model.stator import solve_stator
from trum_sym.paper.findings import (
    LOADS,
    SAMPLED,
    ByInertia,
    Check,
    Context,
    Finding,
    Truth,
    by_load,
    of_rotor,
    rises,
    spans,
)
from trum_sym.paper.published import TABLE_2
from trum_sym.paper.readings import COMBINATIONS, DEFAULT, LEADS, LOAD_INERTIA, POINTS, RIG, ROTOR_LEVELS
from trum_sym.paper.section_6 import consistent, predicts

__all__ = ["CHECKS"]


_NEAR = 0.05  # a printed figure is met within this share of it
_LOW = 0.01  # of the speed under a continuous drive
_DRIVEN = 45000.0  # Hz, Sects. 7.3, 7.4


def _holds(value: bool | np.bool_) -> Truth:
    """One answer for the default level of every start, lead and switching phase."""
    return np.full((1, 1, 1, 1), bool(value))


def _fit(c: Context) -> Finding:
    """Eq. 8's constants from Table 2, by least squares in logarithms and as printed."""
    force, size = np.array(list(TABLE_2)), np.array(list(TABLE_2.values()))
    free = float(c.motor.free_amplitude.value)
    exponent, constant = np.polyfit(np.log(force), np.log(size / free), 1)
    factor = float(np.exp(constant))
    printed = np.asarray(call("trum_amplitude_measured", {**c.motor.symbols(), "F_c": force})["W"])
    worst = float(np.abs(printed - size).max())
    near = abs(factor / 14.926 - 1) < _NEAR and abs(-exponent / 0.678 - 1) < _NEAR
    return Finding(
        _holds(near and worst < 0.1e-6),
        f"our fit of Table 2: C_f = {factor:.3f}, exponent {-exponent:.4f}; eq. (8) with the printed constants is "
        f"within {1e6 * worst:.3f} um of every row",
        levels=(DEFAULT,),
    )


def _free_amplitude(c: Context) -> Finding:
    """Eq. 7, put right, without prepressure, over what the paper leaves open."""
    ceramics = ((-97e-12, 11.5e-12), (-123e-12, 12.3e-12))
    found = []
    for (strain, compliance), width, difference in itertools.product(ceramics, (6e-3, 8e-3), (0.0, 3000.0)):
        motor = c.motor.with_values(
            {"piezo_strain_constant": strain, "piezo_compliance": compliance, "piezo_width": width}
        )
        stator = solve_stator(
            motor, Drive(frequency_difference=difference), Levels("winkler", "quartic", "none", "forced")
        )
        reduced = np.asarray(call("trum_amplitude_measured", stator.values)["W"]) / np.asarray(stator.values["W_max"])
        found.append(float(np.asarray(stator.W) / reduced))
    low, high, measured = min(found), max(found), float(c.motor.free_amplitude.value)
    words = (
        f"eq. (7) put right gives {1e6 * low:.2f} um (3000 Hz above resonance) to {1e6 * high:.2f} um (at resonance) "
        f"over the plausible ceramics and widths, {100 * (high / measured - 1):+.0f} % at most"
    )
    missing = "drive frequency, d31, s11 and the ceramic's width are not given"
    inside = low <= measured <= high or abs(high / measured - 1) < 0.1
    return Finding(_holds(inside), words, levels=(DEFAULT,), undecidable=missing if inside else None)


def _resonance(c: Context) -> Finding:
    levels = tuple(i for i, level in enumerate(COMBINATIONS) if level[1] in ("quartic", "eq6", "printed", "euler"))
    off = c.readings.resonance_frequency[:, POINTS.table_3] / c.readings.paper["resonance_frequency"] - 1
    plain = {
        f"{level} {foundation}": 100 * off[COMBINATIONS.index(("winkler", level, foundation, "measured"))]
        for level in ("printed", "eq6", "quartic")
        for foundation in ("harmonic", "printed")
    }
    listed = ", ".join(f"{name} {value:+.1f} %" for name, value in plain.items())
    near = [f"{COMBINATIONS[i][1]}/{COMBINATIONS[i][2]}/{COMBINATIONS[i][3]}" for i in levels if abs(off[i]) < 0.02]
    as_printed = [i for i in levels if COMBINATIONS[i][1] == "printed"]
    return Finding(
        np.abs(off[list(levels)]) < 0.02,
        f"against the one measured value in the text, 39703 Hz, at 180 N (level and foundation): {listed}; eq. (6) "
        f"exactly as printed is {100 * min(off[i] for i in as_printed):+.1f} % at best; within 2 %: "
        f"{', '.join(dict.fromkeys(near))}",
        levels=levels,
    )


def _power_off(c: Context) -> tuple[dict[str, Array], Array, float]:
    """Phases of Sect. 7.3 and 7.4 after A is switched off at t1, from steady vibration at 45 kHz."""
    resonance = c.readings.paper["resonance_frequency"]
    drive = Drive(frequency_difference=_DRIVEN - resonance, periods=100, on_periods=55, start="steady")
    values = modal_values(2 * np.pi * resonance, c.motor.damping_ratio.value, drive)
    time = (np.arange(45 * 128) + 0.5) / 128 / _DRIVEN
    return {k: np.asarray(v) for k, v in response(time, values).items()}, time, resonance


def _frequency(time: Array, wave: Array) -> float:
    """From the first to the last upward crossing of zero."""
    up = np.flatnonzero((wave[:-1] < 0) & (wave[1:] >= 0))
    at = time[up] - wave[up] * (time[up + 1] - time[up]) / (wave[up + 1] - wave[up])
    return float((at.size - 1) / (at[-1] - at[0]))


def _changes(c: Context) -> Finding:
    found, time, resonance = _power_off(c)
    free, driven = _frequency(time, found["v_A"]), _frequency(time, found["v_B"])
    return Finding(
        _holds(abs(free / resonance - 1) < 1e-3 and abs(driven / _DRIVEN - 1) < 1e-3),
        f"counted from zero crossings: the phase still driven {driven:.1f} Hz, the one switched off {free:.1f} Hz",
        levels=(DEFAULT,),
    )


def _decays(c: Context) -> Finding:
    found, time, resonance = _power_off(c)
    v = found["v_A"]
    top = np.flatnonzero((v[1:-1] > v[:-2]) & (v[1:-1] >= v[2:])) + 1
    rate, _ = np.polyfit(time[top], np.log(v[top]), 1)
    ratio = -rate / (2 * np.pi * resonance)
    left = np.log(v[top]) - np.polyval(np.polyfit(time[top], np.log(v[top]), 1), time[top])
    return Finding(
        _holds(abs(ratio / float(c.motor.damping_ratio.value) - 1) < 0.01 and np.abs(left).max() < 0.01),
        f"logarithms of the peaks lie on a line within {np.abs(left).max():.1e}; its slope gives a damping ratio of "
        f"{ratio:.5f}, Table 1 has 0.006",
        levels=(DEFAULT,),
    )


def _beat_period(c: Context) -> Finding:
    beat = 1 / (_DRIVEN - c.readings.paper["resonance_frequency"])
    return Finding(
        _holds(abs(beat - 0.188e-3) < 0.001e-3),
        f"2 pi/(omega_q - omega_n) = {1e3 * beat:.4f} ms: printed cut off, not rounded",
        levels=(DEFAULT,),
    )


def _measured_beat(c: Context) -> Finding:
    found, time, resonance = _power_off(c)
    speed = found["v_A"] + found["v_B"]  # where both phases count alike, k_c x = pi/4
    size = np.abs(speed)
    top = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    envelope = size[top]
    low = np.flatnonzero((envelope[1:-1] < envelope[:-2]) & (envelope[1:-1] <= envelope[2:])) + 1
    spacing = float(np.diff(time[top][low]).mean())
    return Finding(
        _holds(abs(spacing - 0.19e-3) < 0.005e-3),
        f"minima of the envelope of the computed vertical velocity, 45 kHz and {resonance:.0f} Hz, follow every "
        f"{1e3 * spacing:.3f} ms on average",
        levels=(DEFAULT,),
    )


def _beating_wave(c: Context) -> Finding:
    found, time, resonance = _power_off(c)
    Q = found["Q"]
    turns = int((np.sign(Q[1:]) != np.sign(Q[:-1])).sum())
    beats = float(time[-1]) * (_DRIVEN - resonance)
    return Finding(
        _holds(abs(turns / (2 * beats) - 1) < 0.1),
        f"Q changes its sign {turns} times in {beats:.2f} beats after the switching, where two changes a beat are due",
        levels=(DEFAULT,),
    )


def _table_4(name: str, label: str) -> Check:
    """A determinant against Table 4."""

    def check(c: Context) -> Finding:
        off, value = c.readings.off[name], c.readings.paper[name]
        at = off[:, :, 0, DEFAULT]
        cells = [
            f"{start} {lead:+.0f}: {(1 + at[i, j]) * value:.1f} ({100 * at[i, j]:+.3g} %)"
            for i, start in enumerate(STARTS)
            for j, lead in enumerate(LEADS)
        ]
        words = f"{label} at the default level: {'; '.join(cells)}; met within {100 * _NEAR:.0f} %"
        return Finding(np.abs(off) < _NEAR, words)

    return check


def _table_4_rotor(name: str, label: str, scale: float) -> Check:
    """Mean speed or volatility against Table 4, without a load's inertia and with it."""

    def check(c: Context) -> Finding:
        value, read, at = c.readings.paper[name], SAMPLED[name], POINTS.table_3
        found, own = (c.readings.loaded[key][..., at] for key in (read, name))
        corners, own_corners = (c.ranges[key][..., at] for key in (read, name))
        near = [np.abs(figures / value - 1) < _NEAR for figures in (found, corners, own, own_corners)]
        nearest = " / ".join(f"{_nearest(row, value) / scale:.4g}" for row in found)
        words = (
            f"{label} at the default level {LOADS}: {by_load(found[:, :, :, 0, DEFAULT] / scale, '.3g')}; nearest of "
            f"all readings {nearest}; met within {100 * _NEAR:.0f} %"
        )
        ends, speed = corners[RIG], c.ranges["mean_speed"][RIG, ..., at]
        above = ends.max(axis=(0, -1)) >= value
        if name == "speed_volatility":  # it has no bound where the mean speed passes through zero
            above |= (speed.min(axis=(0, -1)) < 0) & (speed.max(axis=(0, -1)) > 0)
        between = (ends.min(axis=(0, -1)) <= value) & above
        missing = "friction coefficient, contact radius and the load's inertia are not given"
        if between.any():
            where = ", ".join(
                f"{start} {lead:+.0f}"
                for i, start in enumerate(STARTS)
                for j, lead in enumerate(LEADS)
                if between[i, j].any()
            )
            missing += f"; within their plausible ranges the figure passes through the printed one ({where})"
        by = ByInertia(near[0], near[1], near[2][0], near[3][0], measured=True)
        return of_rotor(by, words, tuple(range(len(COMBINATIONS))), undecidable=missing if between.any() else None)

    return check


def _nearest(figures: Array, value: float) -> float:
    """The figure of all readings that is nearest to a value."""
    return float(figures.flat[np.abs(figures - value).argmin()])


def _range(c: Context) -> Finding:
    """A spread of readings with standard deviation s spans 2 s at least."""
    least, corners, own, own_corners = (
        2 * np.abs(figures["mean_speed"][..., POINTS.table_3]) * figures[name][..., POINTS.table_3] / ARCSEC
        for name in ("encoder_volatility", "speed_volatility")
        for figures in (c.readings.loaded, c.ranges)
    )
    smallest = " / ".join(f"{row.min():.3g}" for row in least)
    return of_rotor(
        ByInertia(least <= 400, corners <= 400, own[0] <= 400, own_corners[0] <= 400, measured=True),
        f"the encoder's readings (2 ms) span at least twice their standard deviation, in arcsec/s {LOADS}: "
        f"{by_load(least[:, :, :, 0, DEFAULT], '.3g')}; over all readings {smallest} at least, above 400 it is "
        "excluded; friction and contact radius assumed",
        tuple(range(len(COMBINATIONS))),
    )


def _higher(c: Context) -> Finding:
    del c
    return Finding(
        _holds(False),
        "measured and simulated curves are pictures only; Table 4 has one point of one of them",
        levels=(DEFAULT,),
        undecidable="the text gives no figures of Figs. 21, 23, 30 and 31",
    )


def _with_prepressure(c: Context) -> Finding:
    levels = tuple(i for i, level in enumerate(COMBINATIONS) if level[1] != "39703 Hz" and level[2] != "none")
    curves = c.readings.resonance_frequency[list(levels), POINTS.figure_23]
    one = c.readings.resonance_frequency[DEFAULT, POINTS.figure_23]
    return Finding(
        rises(curves),
        f"{one[0]:.0f} Hz at 160 N to {one[-1]:.0f} Hz at 210 N at the default level",
        levels=levels,
    )


def _low_speed(c: Context) -> Finding:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        fast = abs(float(np.asarray(evaluate(c.motor, Drive(on_periods=20), tolerance=1e-4).mean_speed)))
    ratio = np.abs(c.readings.loaded["mean_speed"][..., ROTOR_LEVELS, POINTS.table_3]) / fast
    corners = np.abs(c.ranges["mean_speed"][..., POINTS.table_3]) / fast < _LOW
    return of_rotor(
        ByInertia(ratio < _LOW, corners, ratio[0] < _LOW, corners[0], measured=True),
        f"mean speed with 14 of 20 pulses over that of a continuous drive ({fast / ARCSEC:.3g} arcsec/s) {LOADS}: "
        f"{spans(ratio, '.2g')}; low is said below a hundredth, 633 arcsec/s is "
        f"{c.readings.paper['mean_speed'] / fast:.1e}",
        ROTOR_LEVELS,
    )


def _mechanism(c: Context) -> Finding:
    """What fluctuates under a continuous drive, and what with pulses."""
    motor = c.motor.with_values({"rotor_inertia": np.asarray(c.motor.rotor_inertia.value) + LOAD_INERTIA})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        still = evaluate(motor, Drive(on_periods=20), tolerance=1e-6)
    least = np.asarray(still.max_speed) - np.asarray(still.min_speed)
    swing = c.loaded(c.motor, np.array(180.0), np.array(3000.0))["swing"]
    ratio = least[:, None, None, None] / swing
    holds = (ratio < 0.01)[..., None]
    bound = 10 ** np.ceil(np.log10(max(float(ratio.max()), 1e-9)))
    return of_rotor(
        ByInertia(holds, None, holds[0], None, measured=True),
        f"the speed swings in a cycle with 14 of 20 pulses, in arcsec/s {LOADS}: "
        f"{by_load(swing[:, :, :, 0] / ARCSEC, '.3g')}; under a "
        f"continuous drive by less than {bound:.0e} of that; friction and contact radius assumed",
        (DEFAULT,),
    )


def _all_trends(c: Context) -> Finding:
    parts = [
        consistent(*_BOTH[both], part, "", measured=True)(c).rotor
        for both in _BOTH
        for part in (POINTS.figure_21, POINTS.figure_23, POINTS.figure_32)
    ]

    def every(name: str) -> Truth:
        return np.asarray(np.all([getattr(part, name) for part in parts], axis=0))

    found = ByInertia(every("holds"), every("corners"), every("speed_holds"), every("speed_corners"), measured=True)
    counts = np.sum([part.holds for part in parts if part is not None], axis=0)
    most = " / ".join(str(row.max()) for row in counts)
    return of_rotor(
        found,
        "six comparisons, v_s with Q_aver and the encoder's sigma_s with Q_vib over frequency difference, "
        f"prepressure and Table 5's drives; of them the best reading has, step by step, {LOADS} {most}",
        ROTOR_LEVELS,
    )


_BOTH = {"a": ("mean_speed", "q_average"), "b": ("speed_volatility", "q_volatility")}


CHECKS: Mapping[str, Check] = {
    "free-amplitude": _free_amplitude,
    "fit": _fit,
    "resonance": _resonance,
    "power-off": _changes,
    "decay": _decays,
    "beat-period": _beat_period,
    "beat-measured": _measured_beat,
    "beat-wave": _beating_wave,
    "table-4-average": _table_4("q_average", "Q_aver in 1/s"),
    "table-4-volatility": _table_4("q_volatility", "Q_vib in 1/s"),
    "table-4-speed": _table_4_rotor("mean_speed", "v_s in arcsec/s", ARCSEC),
    "table-4-sigma": _table_4_rotor("speed_volatility", "sigma_s in % (encoder of 2 ms)", 0.01),
    "table-4-range": _range,
    "measured-difference": consistent(*_BOTH["a"], POINTS.figure_21, "2800 to 3300 Hz", measured=True),
    "measured-difference-sigma": consistent(*_BOTH["b"], POINTS.figure_21, "2800 to 3300 Hz", measured=True),
    "measured-prepressure": consistent(*_BOTH["a"], POINTS.figure_31, "160 to 210 N at 3300 Hz", measured=True),
    "measured-prepressure-sigma": consistent(*_BOTH["b"], POINTS.figure_31, "160 to 210 N at 3300 Hz", measured=True),
    "higher": _higher,
    "several": consistent(*_BOTH["a"], POINTS.figure_32, "Table 5", measured=True),
    "several-sigma": consistent(*_BOTH["b"], POINTS.figure_32, "Table 5", measured=True),
    "box-speed": predicts("mean_speed", "q_average", "box"),
    "box-sigma": predicts("speed_volatility", "q_volatility", "box"),
    "low-speed": _low_speed,
    "resonance-relation": _with_prepressure,
    "mechanism": _mechanism,
    "all-trends": _all_trends,
    "only-determinants": predicts("mean_speed", "q_average", "beyond"),
    "only-determinants-sigma": predicts("speed_volatility", "q_volatility", "beyond"),
}
