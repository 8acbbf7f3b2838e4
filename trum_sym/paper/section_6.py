"""Claims of Sect. 6: determinants and speed against frequency difference and prepressure."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.model.operating_point import evaluate
from trum_sym.paper.findings import (
    LOADS,
    SAMPLED,
    ByInertia,
    Check,
    Context,
    Finding,
    Truth,
    by_load,
    falls,
    of_rotor,
    rank_correlation,
    rises,
    spans,
    together,
)
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


def consistent(speed: str, determinant: str, part: slice, span: str, *, measured: bool) -> Check:
    """Whether two curves go up and down together, step by step; ``measured`` is as for :class:`ByInertia`."""

    def check(c: Context) -> Finding:
        read = SAMPLED[speed] if measured else speed
        of = {name: _steps(c, name, determinant, part) for name in (read, speed)}
        (holds, corners, correlation), (own_holds, own_corners, own) = of[read], of[speed]
        found = ByInertia(holds, corners, own_holds[0], own_corners[0], measured, correlation, own)
        return of_rotor(found, f"do both step the same way over {span}? {_words(found, speed)}", ROTOR_LEVELS)

    return check


def _steps(c: Context, speed: str, determinant: str, part: slice) -> tuple[Truth, Truth, Array]:
    """Whether both step the same way by load's inertia and reading, the same at the corners, rank correlations."""
    a, b = c.readings.loaded[speed][..., ROTOR_LEVELS, part], c.readings.figures[determinant][..., ROTOR_LEVELS, part]
    corners = together(c.ranges[speed][..., part], c.ranges[determinant][..., part])
    return together(a, b), corners, rank_correlation(a, b)[:, :, :, 0, ROTOR_LEVELS.index(DEFAULT)]


def _words(found: ByInertia, speed: str) -> str:
    """Rank correlations by reading and load's inertia, and with the speed itself where that is not what was read."""
    assert found.correlation is not None
    assert found.speed_correlation is not None
    words = f"rank correlation {LOADS}: {by_load(found.correlation, '+.2f')}"
    if found.measured and speed == "speed_volatility":
        words += f"; of the speed itself, not of what the encoder reads: {by_load(found.speed_correlation, '+.2f')}"
    return words


def predicts(speed: str, determinant: str, where: str) -> Check:
    """Whether a determinant orders the measured speeds over a whole box of drives."""

    def check(c: Context) -> Finding:
        figures = getattr(c, where)
        drives = figures[speed].shape[-1]
        own, read = (rank_correlation(figures[name], figures[determinant]) for name in (speed, SAMPLED[speed]))
        found = ByInertia(
            read[..., None] >= _FOLLOWS,
            None,
            own[0, ..., None] >= _FOLLOWS,
            None,
            measured=True,
            correlation=read[:, :, :, 0],
            speed_correlation=own[:, :, :, 0],
        )
        box = "160 to 210 N, 2800 to 3300 Hz" if where == "box" else "100 to 220 N, -5000 to 5000 Hz"
        return of_rotor(
            found,
            f"over {drives} drives, {box}: {_words(found, speed)}; said to predict from "
            f"{_FOLLOWS}; friction and contact radius at their assumed values",
            (DEFAULT,),
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
    speeds = c.loaded(motor, np.full(2, 180.0), np.full(2, 3000.0), load_torque=0.0)["mean_speed"]
    pulsed = exponent(speeds)[..., None]
    steady = float(exponent(np.asarray(continuous.mean_speed)))
    holds = (np.abs(pulsed - 1) < 0.05) & (abs(steady - 1) < 0.05)
    return of_rotor(
        ByInertia(holds, None, holds[0], None, measured=False),
        f"without load torque the speed grows as the amplitude to the power {steady:.3f} under a continuous drive, "
        f"with 14 of 20 pulses over starts, leads and switching phases {LOADS} {spans(pulsed, '.2f')}; Q, the product "
        "of both, grows as the square; friction and contact radius assumed",
        (DEFAULT,),
    )


def _larger_ratio(c: Context) -> Finding:
    correlation = rank_correlation(c.box["q_ratio"], c.box["mean_speed"])
    holds = correlation[..., None] >= _FOLLOWS
    return of_rotor(
        ByInertia(holds, None, holds[0], None, False, correlation[:, :, :, 0], correlation[:, :, :, 0]),
        f"rank correlation of sum Q+ / sum |Q-| with the mean speed over the box, over starts, leads and switching "
        f"phases, {LOADS}: {spans(correlation, '+.2f')}; friction and contact radius assumed",
        (DEFAULT,),
    )


CHECKS: Mapping[str, Check] = {
    "proportional": _proportional,
    "ratio-speed": _larger_ratio,
    "plus-difference": _trend("q_plus", "frequency difference", falls),
    "minus-difference": _trend("q_minus", "frequency difference", rises),
    "time-difference": _cycle_time("frequency difference"),
    "average-difference": _trend("q_average", "frequency difference", falls),
    "volatility-difference": _trend("q_volatility", "frequency difference", rises, beyond_one=True),
    "speed-difference": consistent("mean_speed", "q_average", *BY["frequency difference"], measured=False),
    "sigma-difference": consistent("speed_volatility", "q_volatility", *BY["frequency difference"], measured=False),
    "plus-prepressure": _trend("q_plus", "prepressure", falls),
    "minus-prepressure": _trend("q_minus", "prepressure", falls),
    "time-prepressure": _cycle_time("prepressure"),
    "average-prepressure": _trend("q_average", "prepressure", rises),
    "volatility-prepressure": _trend("q_volatility", "prepressure", falls, beyond_one=True),
    "speed-prepressure": consistent("mean_speed", "q_average", *BY["prepressure"], measured=False),
    "sigma-prepressure": consistent("speed_volatility", "q_volatility", *BY["prepressure"], measured=False),
}
