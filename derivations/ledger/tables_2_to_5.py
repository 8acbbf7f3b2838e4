"""Tables 2 to 5: the power law's constants, missing labels, units of speeds and of the frequency difference."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import sympy as sp
from scipy.optimize import linprog

from derivations.ledger.history import Array, values
from derivations.ledger.judge import figure, usual
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.section_2_amplitude import TABLE_2, power_law, refitted
from derivations.ledger.table_1 import UNITS, unit

__all__ = ["ENTRIES", "reachable_by_rounding", "resampled_interval"]

_FORCE = np.array(sorted(TABLE_2), dtype=float)
_AMPLITUDE = np.array([TABLE_2[int(force)] for force in _FORCE])


# --- Table 2 ------------------------------------------------------------------------------------------------
_TABLE_2: Forms = {"C_f": sp.Float("14.926"), "varsigma": sp.Float("0.678")}


def _regression() -> tuple[Array, Array]:
    """Weights by which the logarithms of the amplitudes give the fitted exponent and the logarithm of the factor."""
    logs = np.log(_FORCE)
    centred = logs - logs.mean()
    slope = centred / (centred**2).sum()
    return -slope, 1 / len(logs) - logs.mean() * slope


def reachable_by_rounding(factor: float, exponent: float, half_digit: float = 0.05) -> bool:
    """Whether amplitudes that round to Table 2 exist whose least-squares fit is exactly this law.

    The fit is linear in the logarithms of the amplitudes, each of which lies in an interval: a linear program.
    """
    weights = np.vstack(_regression())
    free = usual()["W_max"] * 1e6
    bounds = [(math.log((w - half_digit) / free), math.log((w + half_digit) / free)) for w in _AMPLITUDE]
    target = [exponent, math.log(factor)]
    return bool(linprog(np.zeros(len(_FORCE)), A_eq=weights, b_eq=target, bounds=bounds).status == 0)


def resampled_interval(count: int = 2000, level: float = 0.95) -> dict[str, tuple[float, float]]:
    """Percentile intervals of both constants when the fit's residuals are drawn anew, always the same draws."""
    weights = np.vstack(_regression())
    logs = np.log(_AMPLITUDE / (usual()["W_max"] * 1e6))
    exponent, log_factor = weights @ logs
    fitted = log_factor - exponent * np.log(_FORCE)
    residuals = (logs - fitted) * math.sqrt(len(logs) / (len(logs) - 2))
    drawn = np.random.default_rng(304).choice(residuals, (count, len(logs)))
    exponents, log_factors = weights @ (fitted + drawn).T
    ends = [(1 - level) / 2, (1 + level) / 2]
    low, high = np.quantile(exponents, ends), np.exp(np.quantile(log_factors, ends))
    return {"varsigma": (float(low[0]), float(low[1])), "C_f": (float(high[0]), float(high[1]))}


def _derive_2() -> Derivation:
    a, b = sp.symbols("a b", real=True)
    logs, targets = sp.symbols("x_1:4", real=True), sp.symbols("y_1:4", real=True)
    squares = sum((y - a + b * x) ** 2 for x, y in zip(logs, targets, strict=True))
    solved = sp.solve([squares.diff(a), squares.diff(b)], [a, b])
    mean_x, mean_y = sum(logs) / 3, sum(targets) / 3
    slope = sum((x - mean_x) * y for x, y in zip(logs, targets, strict=True)) / sum((x - mean_x) ** 2 for x in logs)
    fitted = power_law()
    return Derivation(
        (
            step(
                "log(W_maxf/W_max) = log C_f - varsigma log F_c; least squares make varsigma the negative slope of "
                "the logarithms about their means (three points written out):",
                -slope,
                zero=[sp.simplify(solved[b] + slope), sp.simplify(solved[a] - (mean_y - slope * mean_x))],
            ),
            step(
                f"Table 2's seven points: C_f = {fitted['C_f']:.3f}, varsigma = {fitted['varsigma']:.4f}; printed are "
                "14.926 and 0.678."
            ),
        ),
        {"C_f": sp.Float(fitted["C_f"]), "varsigma": sp.Float(fitted["varsigma"])},
    )


def _judge_2(forms: Forms) -> Iterator[Evidence]:
    factor, exponent = float(forms["C_f"]), float(forms["varsigma"])
    fitted, resampled = power_law(), resampled_interval()
    low, high = fitted["varsigma"] - fitted["varsigma_width"], fitted["varsigma"] + fitted["varsigma_width"]
    inside = low <= exponent <= high and fitted["C_f_low"] <= factor <= fitted["C_f_high"]
    yield evidence(
        "data",
        inside and refitted(fitted),
        f"least squares give C_f = {fitted['C_f']:.3f} ({fitted['C_f_low']:.3f} to "
        f"{fitted['C_f_high']:.3f}) and varsigma = {fitted['varsigma']:.4f} ({low:.4f} to "
        f"{high:.4f}) at 95 %; residuals drawn anew {resampled['C_f'][0]:.3f} to "
        f"{resampled['C_f'][1]:.3f} and {resampled['varsigma'][0]:.4f} to "
        f"{resampled['varsigma'][1]:.4f}",
    )
    yield evidence(
        "numeric",
        reachable_by_rounding(factor, exponent),
        "some amplitudes that round to Table 2 have exactly this fit (linear program)",
    )
    free = usual()["W_max"] * 1e6
    misses = factor * _FORCE**-exponent * free - _AMPLITUDE
    worst = int(np.abs(misses).argmax())
    yield evidence(
        "error_size",
        abs(misses[worst]) < 0.1,
        f"misses the points by {misses[worst]:+.3f} um at most, at "
        f"{_FORCE[worst]:.0f} N; the table's half digit is 0.05 um",
    )


def _effect_2() -> str:
    fitted, free = power_law(), usual()["W_max"] * 1e6
    ours = fitted["C_f"] * 180 ** -fitted["varsigma"] * free
    theirs = 14.926 * 180**-0.678 * free
    meet = 14.926 ** (1 / 0.678)
    return (
        f"At 180 N {figure(ours, spec='.3f')} um by our fit, {figure(theirs, spec='.3f')} um with the printed "
        f"constants, 5.5 um measured; our exponent is {figure(fitted['varsigma'] - 0.678, spec='+.4f')} off theirs. "
        "The "
        f"law exceeds W_max below {figure(meet, spec='.0f')} N."
    )


# --- Table 3 ------------------------------------------------------------------------------------------------
def _derive_3() -> Derivation:
    first, second = 14, 20
    return Derivation(
        (
            step(
                "A phase cannot get more pulses than the cycle has, n <= m, and both must overlap, 2 n >= m: of the "
                "two unlabelled 'Number' rows, 14 and 20, only the first can be n.",
                sp.Symbol("n") <= sp.Symbol("m"),
                2 * sp.Symbol("n") >= sp.Symbol("m"),
                zero=sp.Integer(0 if first <= second <= 2 * first and not second <= first else 1),
            ),
            step("Sect. 6.2 names m = 20 and n = 14."),
        ),
        {"n": sp.Integer(first), "m": sp.Integer(second)},
    )


def _judge_3(forms: Forms) -> Iterator[Evidence]:
    m, n = int(forms["m"]), int(forms["n"])
    yield evidence("domain", n <= m <= 2 * n, "n pulses of m, with all three regions of the cycle")
    yield evidence("data", {m, n} == {20, 14}, "the two figures of the table")
    p = values()
    seconds = [pulses / (p["omega_q"] / (2 * math.pi)) for pulses in (m - n, m - n, 2 * n - m)]
    yield evidence(
        "numeric",
        min(seconds) >= 0 and abs(sum(seconds) - p["T"]) < 1e-12,
        "the regions last " + ", ".join(f"{1e3 * s:.4f}" for s in seconds) + " ms, together T_Qall",
    )


def _effect_3() -> str:
    left = figure(14 - 20)
    return f"Read the other way, n = 20 of m = 14, T_redu would last a negative time: {left} pulses."


# --- Table 4 ------------------------------------------------------------------------------------------------
_TABLE_4: Forms = {"v_s": 633 * unit("arcsec"), "v_range": 400 * unit("arcsec") / unit("s")}


def _derive_4() -> Derivation:
    forms = {"v_s": _TABLE_4["v_s"] / unit("s"), "v_range": _TABLE_4["v_range"]}
    return Derivation(
        (step("A speed is an angle per time; 'acr s' is a second of arc without the second:", *forms.values()),), forms
    )


def _judge_4(forms: Forms) -> Iterator[Evidence]:
    speeds = [form * unit("s") / unit("arcsec") for form in forms.values()]
    mean, width = (float(speed.subs(dict.fromkeys(UNITS, 1))) for speed in speeds)
    spread = 0.173 * mean
    named = all(speed.is_number for speed in speeds)
    yield evidence("numeric", named and (mean, width) == (633, 400), f"{mean:g} and {width:g} arcsec/s")
    yield evidence(
        "limit", width >= 2 * spread, f"the range is at least two standard deviations at 17.3 %: {width / spread:.2f}"
    )


def _effect_4() -> str:
    speed = 633 * math.pi / 648000
    return (
        f"633 arcsec/s = {figure(speed)} rad/s. Q_aver = 1447.5 and Q_vib = 3446.4 have the unit 1/s, which is not "
        "printed; the row 'Determinant of the direction of the ellipse' is Q_aver, and 'range of motor speed v_aver' "
        "no average."
    )


# --- Table 5 ------------------------------------------------------------------------------------------------
_ROWS = (3300, 3100, 3000, 2800, 2900, 3200)
_TABLE_5: Forms = {f"Delta_omega_{i}": row * unit("rad") / unit("s") for i, row in enumerate(_ROWS, 1)}


def _derive_5() -> Derivation:
    forms = {key: 2 * sp.pi * form for key, form in _TABLE_5.items()}
    return Derivation(
        (
            step(
                "Sects. 6.2, 8.3 and the conclusions vary Delta omega from 2 pi 2800 to 2 pi 3300 rad/s; Table 5's "
                "figures are these without 2 pi, in Hz:",
                *forms.values(),
            ),
        ),
        forms,
    )


def _judge_5(forms: Forms) -> Iterator[Evidence]:
    turns = [form * unit("s") / unit("rad") / (2 * sp.pi) for form in forms.values()]
    hertz = [float(turn.subs(dict.fromkeys(UNITS, 1))) for turn in turns]
    inside = all(2800 - 1e-6 <= f <= 3300 + 1e-6 for f in hertz)
    yield evidence("domain", inside, f"within the stated 2800 to 3300 Hz: {min(hertz):.0f} to {max(hertz):.0f} Hz")
    rows = all(turn == row for turn, row in zip(turns, _ROWS, strict=True))
    yield evidence("numeric", rows, "2 pi times the figures of the table in rad/s, row by row")


def _effect_5() -> str:
    p = values()
    low = 3300 / (2 * math.pi)
    resonance = p["omega_n"] / (2 * math.pi)
    cycle = p["m"] / (resonance + low)
    return (
        f"3300 rad/s would be {figure(low, spec='.1f')} Hz: a beat of {figure(1e3 / low, 3)} ms, "
        f"{figure(1 / low / cycle, 2)} drive cycles, instead of {figure(1e3 / 3300, 3)} ms, "
        f"{figure((resonance + 3300) / p['m'] / 3300, 2)}."
    )


ENTRIES = (
    Entry(
        id="table-2",
        section="7.1",
        title="Constants of the amplitude law",
        place="Table 2 and above",
        printed=_TABLE_2,
        units={},
        verdict="empirical",
        judge=_judge_2,
        derive=_derive_2,
        effect=_effect_2,
        reason="Within the 95 % intervals of the fit, and exactly the fit of some amplitudes that round to the table.",
    ),
    Entry(
        id="table-3",
        section="8.2",
        title="The two unlabelled numbers",
        place="Table 3",
        printed={},
        units={},
        verdict="reconstructed",
        judge=_judge_3,
        derive=_derive_3,
        effect=_effect_3,
        reason="Two rows are called 'Number', 14 and 20: n and m, as only that order gives a cycle.",
    ),
    Entry(
        id="table-4",
        section="8.2",
        title="Units of the measured speeds",
        place="Table 4",
        printed=_TABLE_4,
        units={"v_s": "rad/s", "v_range": "rad/s"},
        verdict="erratum",
        judge=_judge_4,
        derive=_derive_4,
        effect=_effect_4,
        repair=lambda forms: {**forms, "v_s": forms["v_s"] / unit("s")},
        found_by=("dimension", "numeric"),
        known=UNITS,
        reason="The mean speed is printed in 'acr s', an angle; arcsec/s is meant, as in the next row.",
    ),
    Entry(
        id="table-5",
        section="8.3.2",
        title="Unit of the frequency difference",
        place="Table 5",
        printed=_TABLE_5,
        units=dict.fromkeys(_TABLE_5, "rad/s"),
        verdict="erratum",
        judge=_judge_5,
        derive=_derive_5,
        effect=_effect_5,
        repair=lambda forms: {key: 2 * sp.pi * form for key, form in forms.items()},
        found_by=("domain", "numeric"),
        known=UNITS,
        reason="Printed in rad/s; the figures are Hz.",
    ),
)
