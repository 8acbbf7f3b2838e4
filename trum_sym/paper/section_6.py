"""Claims of Sect. 6: determinants and speed against frequency difference and prepressure."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.model.operating_point import evaluate
from trum_sym.paper.findings import Check, Context, Finding, Truth, falls, rank_correlation, rises, together
from trum_sym.paper.readings import DEFAULT, POINTS, ROTOR_LEVELS

__all__ = ["CHECKS", "consistent", "predicts"]

_FOLLOWS = 0.9
BY = {"frequency difference": (POINTS.figure_21, "2800 to 3300 Hz"), "prepressure": (POINTS.figure_23, "160 to 210 N")}
_UNITS = {"q_average": "1/s", "q_volatility": "1/s", "q_plus": "mm^2", "q_minus": "mm^2"}
_NAMES = {"q_average": "Q_aver", "q_volatility": "Q_vib", "q_plus": "sum Q+", "q_minus": "sum |Q-|"}


def _ends(c: Context, name: str, part: slice) -> str:
    """First and last values of a curve by start, lead +1 and -1, at the default level."""
    scale = 1e6 if _UNITS[name] == "mm^2" else 1.0
    cells = []
    for i, start in enumerate(("periodic", "steady", "rest")):
        for j, lead in enumerate(("+1", "-1")):
            curve = scale * c.readings.figures[name][i, j, 0, DEFAULT, part]
            cells.append(f"{start} {lead}: {curve[0]:.4g} to {curve[-1]:.4g}")
    return f"{_NAMES[name]} in {_UNITS[name]}, first to last: {'; '.join(cells)}"


def _trend(name: str, by: str, way: Callable[[Array], Truth], beyond_one: bool = False) -> Check:
    part, span = BY[by]

    def check(c: Context) -> Finding:
        holds = way(c.readings.figures[name][..., part])
        if beyond_one:  # the sentence's own condition
            holds = holds & (c.readings.figures["q_square_ratio"][..., part] > 1).all(axis=-1)
        return Finding(holds, f"{_ends(c, name, part)} over {span}, six drives")

    return check


def _cycle_time(by: str) -> Check:
    part, span = BY[by]

    def check(c: Context) -> Finding:
        time = 1 / (c.readings.resonance_frequency[:, part] + POINTS.difference[part])
        change = time[:, -1] / time[:, 0] - 1
        return Finding(
            np.abs(change) < 0.02,
            f"T_Qall changes by {100 * change[DEFAULT]:+.3g} % over {span} ({100 * change.min():+.3g} to "
            f"{100 * change.max():+.3g} % over all levels); constant is said up to 2 %",
        )

    return check


def consistent(speed: str, determinant: str, part: slice, span: str) -> Check:
    """Whether two curves go up and down together, step by step."""

    def check(c: Context) -> Finding:
        figures = c.readings.figures
        a, b = (figures[name][..., ROTOR_LEVELS, part] for name in (speed, determinant))
        found = c.ranges
        corners = together(found[speed][..., part], found[determinant][..., part])
        correlation = rank_correlation(a, b)
        default = ROTOR_LEVELS.index(DEFAULT)
        cells = [
            f"{start} {lead}: {correlation[i, j, 0, default]:+.2f}"
            for i, start in enumerate(("periodic", "steady", "rest"))
            for j, lead in enumerate(("+1", "-1"))
        ]
        return Finding(
            together(a, b),
            f"do both step the same way over {span}? rank correlation: {'; '.join(cells)}",
            levels=ROTOR_LEVELS, assumed=corners,
        )  # fmt: skip

    return check


def predicts(speed: str, determinant: str, where: str) -> Check:
    """Whether a determinant orders the speeds over a whole box of drives."""

    def check(c: Context) -> Finding:
        found = getattr(c, where)
        correlation = rank_correlation(found[speed], found[determinant])
        cells = [
            f"{start} {lead}: {correlation[i, j, 0, 0]:+.2f}"
            for i, start in enumerate(("periodic", "steady", "rest"))
            for j, lead in enumerate(("+1", "-1"))
        ]
        box = "160 to 210 N, 2800 to 3300 Hz" if where == "box" else "100 to 220 N, -5000 to 5000 Hz"
        return Finding(
            correlation >= _FOLLOWS,
            f"rank correlation over {found[speed].shape[-1]} drives, {box}: {'; '.join(cells)}; said to predict from "
            f"{_FOLLOWS}; friction and contact radius at their assumed values",
            levels=(DEFAULT,),
        )

    return check


def _proportional(c: Context) -> Finding:
    """How speed and Q grow with the amplitude, under a continuous drive without load."""
    sizes = np.array([5e-6, 6e-6])
    power = np.log(sizes[1] / sizes[0])
    resonance = c.readings.resonance_frequency[DEFAULT, POINTS.table_3]
    motor = c.motor.with_values({"amplitude": sizes, "resonance_frequency": resonance})

    def exponent(speed: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.asarray(np.log(speed[..., 1] / speed[..., 0]) / power)

    continuous = evaluate(motor, Drive(on_periods=20, load_torque=0.0), tolerance=1e-6)
    pulsed = exponent(c.evaluated(motor, POINTS.prepressure[:1], POINTS.difference[:1], load_torque=0.0)["mean_speed"])
    steady = float(exponent(np.asarray(continuous.mean_speed)))
    holds = (np.abs(pulsed - 1) < 0.05) & (abs(steady - 1) < 0.05)
    return Finding(
        holds,
        f"without load the speed grows as the amplitude to the power {steady:.3f} under a continuous drive, "
        f"{np.nanmin(pulsed):.2f} to {np.nanmax(pulsed):.2f} with 14 of 20 pulses over starts, leads and switching "
        "phases; Q, the product of both, grows as the square; friction and contact radius assumed",
        levels=(DEFAULT,),
    )


def _larger_ratio(c: Context) -> Finding:
    found = c.box
    correlation = rank_correlation(found["q_ratio"], found["mean_speed"])
    return Finding(
        correlation >= _FOLLOWS,
        f"rank correlation of sum Q+ / sum |Q-| with the mean speed over the box: {correlation.min():+.2f} to "
        f"{correlation.max():+.2f} over starts, leads and switching phases; friction and contact radius assumed",
        levels=(DEFAULT,),
    )


CHECKS: Mapping[str, Check] = {
    "proportional": _proportional,
    "ratio-speed": _larger_ratio,
    "plus-difference": _trend("q_plus", "frequency difference", falls),
    "minus-difference": _trend("q_minus", "frequency difference", rises),
    "time-difference": _cycle_time("frequency difference"),
    "average-difference": _trend("q_average", "frequency difference", falls),
    "volatility-difference": _trend("q_volatility", "frequency difference", rises, beyond_one=True),
    "speed-difference": consistent("mean_speed", "q_average", *BY["frequency difference"]),
    "sigma-difference": consistent("speed_volatility", "q_volatility", *BY["frequency difference"]),
    "plus-prepressure": _trend("q_plus", "prepressure", falls),
    "minus-prepressure": _trend("q_minus", "prepressure", falls),
    "time-prepressure": _cycle_time("prepressure"),
    "average-prepressure": _trend("q_average", "prepressure", rises),
    "volatility-prepressure": _trend("q_volatility", "prepressure", falls, beyond_one=True),
    "speed-prepressure": consistent("mean_speed", "q_average", *BY["prepressure"]),
    "sigma-prepressure": consistent("speed_volatility", "q_volatility", *BY["prepressure"]),
}
