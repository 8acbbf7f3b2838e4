"""Operating points whose wave feels the rotor: figures of the orbit that laps of wave, contact and rotor lead to.

A class of their own beside :class:`trum_sym.OperatingPoint`: a third of that one's figures do not exist here, there are
others, an orbit need not be the only one, and errors are estimates.  Each point is an orbit of its own
(:mod:`trum_sym.model.coupled_orbit`), so points of an array are the same to the bit as alone.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike, broadcast_shape
from trum_sym.inputs.choices import choice
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import check_point, numbers_of, period_of
from trum_sym.model.batch import over_points
from trum_sym.model.coupled_orbit import STARTS, CoupledOrbit, coupled_orbits, lap_values
from trum_sym.model.drive_orbit import DriveHistory, history_of, read_by_encoder
from trum_sym.model.inputs import Inputs, Point, remarks_of
from trum_sym.model.kernels import call
from trum_sym.model.levels import METHODS, Levels, Method
from trum_sym.model.rotor import RUNAWAY, over_mean
from trum_sym.quantities import COUPLED

__all__ = [
    "ABSENT",
    "COUPLED_FLAGS",
    "COUPLED_RESULTS",
    "FREE_OF_ORBIT",
    "CoupledCase",
    "CoupledPoint",
    "best_of",
    "check_present",
    "coupled_point",
    "coupled_results",
    "gates_of",
    "prepare_coupled",
]

_ELLIPSE = "it is of two phases of prescribed amplitude; with coupling both follow what presses on them"
ABSENT: Mapping[str, str] = {
    "amplitude": "no amplitude is prescribed with coupling: see amplitude_A, amplitude_B and highest_wave",
    **dict.fromkeys(("q_ratio", "q_square_ratio", "q_average", "q_volatility"), _ELLIPSE),
    "stall_torque": "a rotor that is held still makes another wave, which is not computed with coupling",
    "stall_torque_error": "the stall torque is not computed with coupling",
    "method": "there is one with coupling: laps in adaptive steps, closed by Newton",
    "on_grid": "no orbit with coupling is found on a grid",
}
"""Why a coupled point lacks a figure that a prescribed wave's has."""

_TOLERANCE = 1e-6  # where none is given
_SAMPLES = 16  # parts of a drive period, between which the motion is kept
_TURN = 2 * np.pi
_SWUNG = ("amplitude_A", "lag_A", "amplitude_B", "lag_B")
FREE_OF_ORBIT = ("resonance_frequency", "free_resonance", "drive_frequency", "cycle_time", "neutral_axis", "wavenumber")
"""The figures that take no orbit."""

Bools = bool | np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
Words = str | np.ndarray[tuple[int, ...], np.dtype[np.str_]]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class CoupledPoint(Point):
    """What the motor does at a drive whose wave feels the rotor; SI units, frequencies in Hz, speeds in rad/s.

    Every number is a float, or an array of the inputs' common shape.  Figures are those of one orbit: of those that
    laps from rest and from both phases' steady swing lead to, the first that attracts and meets the tolerance.

    Attributes
    ----------
    motor : str
    prepressure : N
    frequency_difference, resonance_frequency, free_resonance, drive_frequency : Hz
        The difference is over eq. 6's resonance under prepressure; the free one is without a rotor.
    cycle_time : s
    neutral_axis : m
    wavenumber : 1/m
    mean_speed, min_speed, max_speed : rad/s
        Of the rotor over its orbit; of the last laps where none closes; NaN where the load exceeds what friction
        carries.
    speed_volatility, contact_fraction : 1
        As of :class:`OperatingPoint`.
    highest_wave : m
    amplitude_A, amplitude_B : m
        Of the part of each phase's displacement that swings with the drive's frequency.
    lag_A, lag_B : rad
        By which that part is behind the phase's modal force; pi/2 at resonance.
    input_power, output_power : W
        Mean of what the modal forces put in and the load takes; the latter negative where the load drives the rotor.
    efficiency : 1
        Output over input power.
    mean_speed_error, min_speed_error, max_speed_error : rad/s
        Estimates, from orbits of shorter and shorter time steps, times a factor of safety: no bounds.  NaN where no
        orbit is.
    speed_volatility_error, contact_fraction_error, efficiency_error : 1
    highest_wave_error, amplitude_A_error, amplitude_B_error : m
    lag_A_error, lag_B_error : rad
    input_power_error, output_power_error : W
        Likewise; that of the volatility is infinite where the mean's sign is uncertain.
    closed, stable, converged : bool
        Whether laps end where they began; whether small disturbances die out; both, and whether the errors of mean and
        extremes meet the tolerance.
    cycles : float
        Drive cycles after which the orbit repeats itself.
    largest_multiplier : float
        By how much a small disturbance is larger after them, at most.
    branches : float
        Different orbits that attract, of those that the starts lead to.
    start : str
        Where the laps began that led to the orbit: ``rest`` or ``steady``.
    branch : str
        ``only``, or which of several it is, as in ``1 of 2``; ``none`` where none attracts.
    reason : str
        Why it is not converged, in words; empty if all is well.
    orbits : tuple of tuples of CoupledOrbit
        For each point, in C order, what its starts lead to: states, multipliers, figures.
    inputs : Inputs
        Motor, drive, levels, encoder and tolerance that the figures hold for.

    Notes
    -----
    What an :class:`OperatingPoint` has beside these is in ``trum_sym.model.coupled_point.ABSENT`` with the reason,
    which asking for it says, too.

    Examples
    --------
    >>> import trum_sym as ts
    >>> point = ts.evaluate(coupling="contact", compliance="flange")
    >>> f"{point.mean_speed:.3f} rad/s, {1e6 * point.highest_wave:.2f} um, {point.branch}", bool(point.converged)
    ('-3.815 rad/s, 2.72 um, only', True)
    """

    motor: str
    prepressure: ArrayLike
    frequency_difference: ArrayLike
    resonance_frequency: ArrayLike
    free_resonance: ArrayLike
    drive_frequency: ArrayLike
    cycle_time: ArrayLike
    neutral_axis: ArrayLike
    wavenumber: ArrayLike
    mean_speed: ArrayLike
    min_speed: ArrayLike
    max_speed: ArrayLike
    speed_volatility: ArrayLike
    contact_fraction: ArrayLike
    highest_wave: ArrayLike
    amplitude_A: ArrayLike  # the paper's phases
    lag_A: ArrayLike
    amplitude_B: ArrayLike
    lag_B: ArrayLike
    input_power: ArrayLike
    output_power: ArrayLike
    efficiency: ArrayLike
    mean_speed_error: ArrayLike
    min_speed_error: ArrayLike
    max_speed_error: ArrayLike
    speed_volatility_error: ArrayLike
    contact_fraction_error: ArrayLike
    highest_wave_error: ArrayLike
    amplitude_A_error: ArrayLike
    lag_A_error: ArrayLike
    amplitude_B_error: ArrayLike
    lag_B_error: ArrayLike
    input_power_error: ArrayLike
    output_power_error: ArrayLike
    efficiency_error: ArrayLike
    cycles: ArrayLike
    largest_multiplier: ArrayLike
    branches: ArrayLike
    closed: Bools
    stable: Bools
    converged: Bools
    start: Words
    branch: Words
    reason: Words
    orbits: tuple[tuple[CoupledOrbit, ...], ...] = field(repr=False)
    inputs: Inputs = field(repr=False)
    quantities: ClassVar = {
        **{name: COUPLED[name] for name in FREE_OF_ORBIT},
        **{name: quantity for name, quantity in COUPLED.items() if name not in FREE_OF_ORBIT},
    }
    unlisted: ClassVar = ("orbits", "inputs")

    if not TYPE_CHECKING:  # which knows the fields, and takes no other

        def __getattr__(self, name: str) -> Any:  # noqa: ANN401
            why = ABSENT.get(name, "no such figure")
            raise AttributeError(f"{name}: a CoupledPoint has none; {why}")

    @property
    def orbit(self) -> CoupledOrbit | None:
        """The orbit of a single point, None where the load exceeds what friction carries."""
        if np.ndim(self.mean_speed):
            raise ParameterError("orbit", "an array of points", "a single point; orbits has those of all")
        return best_of(self.orbits[0])

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures of a single point do not say by themselves."""
        if np.ndim(self.mean_speed):
            return ()
        found, mine = list(remarks_of(self.figures, float(self.inputs.drive.load_torque))), self.orbit
        if mine is not None and mine.cycles > 1 and mine.closed:
            found.append(f"the orbit repeats itself after {mine.cycles} cycles, not every cycle")
        found += [
            f"{phase} hardly swings with the drive, so that its lag has no meaning"
            for phase in "AB"
            if np.isfinite(getattr(self, f"amplitude_{phase}")) and not np.isfinite(getattr(self, f"lag_{phase}"))
        ]
        for other in self.orbits[0]:
            if other is mine or (mine is not None and not mine.closed):
                continue
            if not (other.closed and other.stable):
                found.append(f"from {_NAMES[other.start]} laps come to no orbit that attracts")
            elif self.branches > 1:
                found.append(
                    f"another orbit attracts, from {_NAMES[other.start]}: mean speed {other.mean_speed:.6g} rad/s"
                )
        return tuple(found)

    def to_dict(self) -> dict[str, Any]:
        """Inputs, figures, remarks and units by name, in SI units: what ``--point`` reads.

        ``multipliers`` are the sizes of the orbit's, a row a point; ``absent`` says why figures of a prescribed wave
        are not there.
        """
        found = super().to_dict()
        chosen = [best_of(orbits) for orbits in self.orbits]
        sizes = [[] if orbit is None else np.abs(orbit.multipliers).tolist() for orbit in chosen]
        return {**found, "multipliers": sizes if np.ndim(self.mean_speed) else sizes[0], "absent": dict(ABSENT)}


_NAMES = {"rest": "rest", "steady": "both phases' steady swing"}
COUPLED_FLAGS: Mapping[str, str] = {
    "converged": "whether an orbit attracts whose errors' estimates meet the tolerance",
    "closed": "whether laps end where they began",
    "stable": "whether small disturbances die out",
}
"""The figures that are true or false, and what they say."""
_WORDS = ("start", "branch", "reason")
COUPLED_RESULTS = tuple(f.name for f in fields(CoupledPoint) if f.name not in ("motor", *_WORDS, "orbits", "inputs"))
"""The figures of a coupled point that are numbers, in order."""


def check_present(parameter: str, figure: object, levels: Levels) -> None:
    """Refuse a figure that a point with coupling lacks, and say why.

    Raises
    ------
    ParameterError
    """
    if levels.coupling == "contact" and isinstance(figure, str) and figure in ABSENT:
        raise ParameterError(parameter, figure, f"another figure where coupling is contact: {ABSENT[figure]}")


@dataclass(frozen=True)
class CoupledCase:
    """A checked motor and drive, and what the laps of each point depend on, in C order."""

    motor: Motor
    drive: Drive
    levels: Levels
    shape: tuple[int, ...]
    points: tuple[Mapping[str, float], ...]
    sampling_period: ArrayLike | None
    tolerance: float


def prepare_coupled(
    motor: Motor | None,
    drive: Drive | None,
    levels: Levels,
    tolerance: float | None,
    sampling_period: ArrayLike | None = None,
    *,
    method: Method = "auto",
) -> CoupledCase:
    """Check the input of :func:`trum_sym.evaluate` with ``coupling = "contact"``.

    Raises
    ------
    ParameterError
        As :func:`trum_sym.model.coupled_orbit.lap_values` does; for a weight, and for a grid.
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    period = period_of(sampling_period)
    inputs = numbers_of(motor, drive, period)
    shape = broadcast_shape(inputs)
    choice("method", method, METHODS)
    if method == "grid":
        raise ParameterError("method", method, "auto or adaptive where coupling is contact: there is no grid of it")
    if drive.load == "weight":
        raise ParameterError("load", drive.load, "torque where coupling is contact: a slack string is not known there")
    wanted = _TOLERANCE if tolerance is None else tolerance
    points = []
    for index in np.ndindex(shape):
        machine, one = _at(motor, drive, shape, index)
        points.append(lap_values(machine, one, levels, tolerance=wanted))
    return CoupledCase(motor, drive, levels, shape, tuple(points), period, points[0]["wanted"])


def _at(motor: Motor, drive: Drive, shape: tuple[int, ...], index: tuple[int, ...]) -> tuple[Motor, Drive]:
    """Motor and drive of one point of an array."""

    def picked(numbers: Mapping[str, ArrayLike]) -> dict[str, float]:
        return {name: float(np.broadcast_to(v, shape)[index]) for name, v in numbers.items() if np.ndim(v)}

    of_motor, of_drive = picked({name: p.value for name, p in motor.parameters()}), picked(drive.numbers())
    with unquestioned():  # whoever made the arrays was warned
        machine = motor.with_values(of_motor) if of_motor else motor
    return machine, replace(drive, **of_drive) if of_drive else drive  # type: ignore[arg-type]


def best_of(orbits: Collection[CoupledOrbit]) -> CoupledOrbit | None:
    """Of the orbits that starts lead to: the first that attracts and meets the tolerance, or attracts, or closes."""
    marks = (
        lambda o: o.converged,
        lambda o: o.closed and o.stable,
        lambda o: o.closed,
        lambda o: True,  # noqa: ARG005
    )
    return next((orbit for mark in marks for orbit in orbits if mark(orbit)), None)


def gates_of(values: Mapping[str, float], cycles: int) -> Array:
    """Whether A and B are driven, 1 or 0, in each drive period of some cycles, (m * cycles, 2)."""
    period = np.arange(values["m"])
    off = [(period >= values[f"off_{phase}"]) & (period < values[f"on_{phase}"]) for phase in "AB"]
    return np.tile((1 - np.stack(off, axis=1)).astype(np.float64), (cycles, 1))


def coupled_point(case: CoupledCase, progress: bool = False) -> CoupledPoint:
    """All figures of a case from :func:`prepare_coupled`."""
    found = coupled_results(case, (*COUPLED_RESULTS, *_WORDS, "orbits"), progress)
    inputs = Inputs(case.motor, case.drive, case.levels, case.sampling_period, case.tolerance)
    return CoupledPoint(motor=case.motor.name, **found, inputs=inputs)


def coupled_results(case: CoupledCase, wanted: Collection[str], progress: bool = False) -> dict[str, Any]:
    """Some figures of a case by name, each of the case's shape; what none of them needs is not computed.

    Parameters
    ----------
    case : CoupledCase
        From :func:`prepare_coupled`.
    wanted : names of :data:`COUPLED_RESULTS`, ``"start"``, ``"branch"``, ``"reason"``, ``"runaway"`` or ``"orbits"``
        ``runaway`` is where the load is as large as all that friction carries.
    progress : bool
        As for :func:`trum_sym.evaluate`.
    """
    count = len(case.points)
    periods: list[float | None] = [None] * count
    if case.sampling_period is not None:
        periods = [float(p) for p in np.broadcast_to(case.sampling_period, case.shape).ravel()]
    rows: list[dict[str, Any]] = [{}] * count
    swung = not {"speed_volatility", *_SWUNG, *(f"{name}_error" for name in _SWUNG)}.isdisjoint(wanted)

    def run(place: int) -> None:
        rows[place] = _of_point(case.points[place], periods[place], swung)

    if set(wanted) <= {"prepressure", "frequency_difference", *FREE_OF_ORBIT}:
        rows = [_closed(values) for values in case.points]
    else:
        over_points(run, count, "orbits" if progress else None)
    found: dict[str, Any] = {}
    for name in wanted:
        if name == "orbits":
            found[name] = tuple(row[name] for row in rows)
        elif name in ("prepressure", "frequency_difference"):
            found[name] = np.broadcast_to(getattr(case.drive, name), case.shape)
        else:
            found[name] = np.array([row[name] for row in rows]).reshape(case.shape)
        if not case.shape and name != "orbits":
            found[name] = found[name].item()
    return found


def _closed(values: Mapping[str, float]) -> dict[str, float]:
    """Figures that take no orbit."""
    return {
        "resonance_frequency": values["omega_n"] / _TURN,
        "free_resonance": values["omega_n0"] / _TURN,
        "drive_frequency": values["omega_q"] / _TURN,
        "cycle_time": _TURN * values["m"] / values["omega_q"],
        "neutral_axis": values["D"],
        "wavenumber": values["k_c"],
    }


def _runs_away(values: Mapping[str, float]) -> bool:
    """Whether the load is as large as all that friction carries."""
    most = float(np.asarray(call("trum_stall_torque", {**values, "f": 1.0})["torque"]))
    return not abs(values["T_load"]) < most


def _of_point(values: Mapping[str, float], period: float | None, swung: bool) -> dict[str, Any]:
    """All figures of one point; those of the motion within the cycle only if they are wanted."""
    found: dict[str, Any] = {**dict.fromkeys(COUPLED_RESULTS, np.nan), **dict.fromkeys(COUPLED_FLAGS, False)}
    found |= {**_closed(values), "branches": 0.0, "start": "", "branch": "none", "runaway": False, "orbits": ()}
    if _runs_away(values):
        return {**found, "reason": RUNAWAY, "runaway": True}
    orbits = coupled_orbits(values, STARTS)
    orbit = best_of(orbits)
    assert orbit is not None  # a start leads to one, closed or not
    attracting = [one for one in orbits if one.closed and one.stable]
    named = ("mean_speed", "min_speed", "max_speed", "contact_fraction", "highest_wave", "input_power")
    found |= {name: getattr(orbit, name) for name in named}
    found |= {f"{name}_error": getattr(orbit, f"{name}_error") for name in named}
    found |= _powers(values, found)
    deviation, error = orbit.deviation, orbit.deviation_error
    if swung:
        history = history_of(values, orbit.state, gates_of(values, orbit.cycles), _SAMPLES)
        found |= _swings(values, history, orbit.highest_wave_error)
        if period is not None:
            deviation = read_by_encoder(history.time, history.angle, period)[0]
            coarser = read_by_encoder(history.time[::2], history.angle[::2], period)[0]
            error += abs(deviation - coarser)
    of_mean = np.float64(orbit.mean_speed), np.float64(orbit.mean_speed_error)
    volatility = over_mean(np.float64(deviation), np.float64(error), *of_mean)  # type: ignore[arg-type]
    found["speed_volatility"], found["speed_volatility_error"] = map(float, volatility)
    place = next((k for k, one in enumerate(attracting, 1) if one is orbit), 0)
    several = f"{place} of {len(attracting)}" if len(attracting) > 1 else "only"
    return found | {
        "cycles": float(orbit.cycles),
        "largest_multiplier": float(np.abs(orbit.multipliers).max()),
        "branches": float(len(attracting)),
        "closed": orbit.closed,
        "stable": orbit.stable,
        "converged": orbit.converged,
        "start": orbit.start,
        "branch": several if place else "none",
        "reason": _reason(orbit),
        "orbits": orbits,
    }


def _reason(orbit: CoupledOrbit) -> str:
    """Why an orbit is not converged."""
    if not orbit.closed:
        return "laps come back neither from rest nor from the steady swing within 3 cycles: the figures are of the last"
    if not orbit.stable:
        grown = float(np.abs(orbit.multipliers).max())
        return f"the orbit does not attract: a small disturbance is {grown:.3g} times as large after its cycle"
    return "" if orbit.tolerance_met else "the estimates of the errors miss the tolerance"


def _powers(values: Mapping[str, float], found: Mapping[str, float]) -> dict[str, float]:
    """What the load takes, as friction on the rim that balances it does on average, and the efficiency."""
    most = float(np.asarray(call("trum_stall_torque", {**values, "f": 1.0})["torque"]))
    carried = {**values, "f": values["T_load"] / most, "W": 0.0, "along": 0.0}
    speeds = np.array([found["mean_speed"], found["mean_speed_error"]])
    output, off = map(float, np.asarray(call("trum_plain_powers", {**carried, "v": values["r_c"] * speeds})["P_rotor"]))
    given, wrong = found["input_power"], found["input_power_error"]
    share = output / given if given else np.nan
    least = given - wrong
    return {
        "output_power": output,
        "output_power_error": abs(off),
        "efficiency": share,
        "efficiency_error": (abs(off) + abs(share) * wrong) / least if least > 0 else np.inf,
    }


def _swings(values: Mapping[str, float], history: DriveHistory, off: float) -> dict[str, float]:
    """Amplitude and lag of the part of both phases that swings with the drive, from equal parts of its periods.

    ``off`` is by how much the wave may be off; what half the parts give differs by more than all of them are off.
    """
    found: dict[str, float] = {}
    turned = np.exp(-1j * values["omega_q"] * history.time[:-1])
    forces = {"A": values["force_A"], "B": complex(values["force_B_along"], values["force_B_ahead"])}
    for phase, force in forces.items():
        swing = 2 * history.states[2 * (phase == "B")][:-1] * turned
        whole, half = complex(swing.mean()), complex(swing[::2].mean())
        error = abs(whole - half) + off
        size = abs(whole)
        swings = not size <= error  # the error of what no lap closes is not known
        ahead = force * np.exp(1j * values["force_phase"])
        found |= {
            f"amplitude_{phase}": size,
            f"amplitude_{phase}_error": error,
            f"lag_{phase}": float(np.angle(ahead / whole)) if swings else np.nan,
            f"lag_{phase}_error": error / size if swings else np.nan,
        }
    return found
