"""One operating point, or an array of them: motor and drive in, figures out."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Unpack, overload

import numpy as np

from trum_sym.errors import ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array, ArrayLike, broadcast_shape
from trum_sym.inputs.choices import choice
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_point, numbers_of, one_number, period_of
from trum_sym.model.brush import brush_values, check_drive
from trum_sym.model.cycle import check_steady_state, cycle_sums, lack_of_damping, modal_values, scaled
from trum_sym.model.inputs import Inputs, Point, remarks_of
from trum_sym.model.kernels import call
from trum_sym.model.levels import METHODS, LevelChoice, Levels, Method, PrescribedChoice
from trum_sym.model.rotor import Orbit, encoder_deviation, history, orbit_values, over_mean, reasons, solve_orbit
from trum_sym.model.stator import Stator, solve_stator
from trum_sym.model.string import SLACK, least_tension
from trum_sym.quantities import QUANTITIES

if TYPE_CHECKING:
    from trum_sym.model.coupled_point import CoupledPoint

__all__ = [
    "OF_CYCLE",
    "OF_ORBIT",
    "RESULTS",
    "TOLERANCES",
    "Case",
    "OperatingPoint",
    "encoder_deviation_of",
    "evaluate",
    "point_of",
    "prepare",
    "results",
    "settle",
]

OF_CYCLE = frozenset(("q_ratio", "q_square_ratio", "q_average", "q_volatility"))
"""The figures that take the sums over a cycle."""
OF_ORBIT = frozenset(
    (
        "mean_speed",
        "min_speed",
        "max_speed",
        "speed_volatility",
        "stall_torque",
        "contact_fraction",
        "mean_speed_error",
        "min_speed_error",
        "max_speed_error",
        "speed_volatility_error",
        "stall_torque_error",
        "converged",
        "runaway",
        "slack",
        "reason",
        "method",
        "on_grid",
    )
)
"""The figures that take the rotor's orbit; ``runaway`` is where no speed balances the load, ``slack`` where the string
that bears a weight would have to push, ``reason`` why an orbit is not converged or cannot be, in words, ``method`` how
it was found, ``on_grid`` whether on a grid."""

_TOLERANCE, _FINEST = 1e-6, 1e-9  # where none is given: at first, and the finest that a single point goes to
_DIGITS = 5e-5  # of the mean speed: four digits of it are right
TOLERANCES = Domain(low=1e-9, low_open=False, high=1e-2, high_open=False)
"""Of a rotor's speeds, relative to the largest."""
_ENCODER_SAMPLES = 64  # per drive period, of the path that the encoder differences
_SAMPLED_PERIODS = 10_000  # that are kept as samples


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class OperatingPoint(Point):
    """What the motor does at a drive; SI units, frequencies in Hz, speeds in rad/s.

    Every number is a float, or an array of the inputs' common shape.

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
    mean_speed, min_speed, max_speed : rad/s
        Of the rotor over its periodic orbit; NaN where no speed balances the load.
    speed_volatility : 1
        Standard deviation over the mean's magnitude (eq. 40), continuous or as an encoder averages.
    stall_torque : N m
        Mean torque on the rotor held still: a larger load drives it back.
    contact_fraction : 1
        Mean share of the wave in contact, theta/pi.
    mean_speed_error, min_speed_error, max_speed_error : rad/s
        Bounds of the errors of these speeds: the true figure of the model lies within them (docs/rotor.md).
    speed_volatility_error : 1
        Likewise; infinite where the mean's sign is uncertain.
    stall_torque_error : N m
        Likewise.
    converged : bool
        Whether all these bounds meet the tolerance.
    reason : str
        Why not, in words, or that a weight's string goes slack, where the figures do not hold; empty if all is well.
    method : str
        How the orbit was found: ``"adaptive"`` steps, or a ``"grid"`` of equal ones (docs/rotor.md).
    inputs : Inputs
        Motor, drive, levels, encoder and tolerance that the figures hold for.

    Examples
    --------
    >>> import trum_sym as ts
    >>> point = ts.evaluate(drive=ts.Drive(prepressure=[170.0, 180.0]))
    >>> point.mean_speed.shape, point.units["mean_speed"], bool(point.converged.all())
    ((2,), 'rad/s', True)
    >>> point.to_frame()[["prepressure", "q_average"]].round(1)
       prepressure  q_average
    0        170.0      940.7
    1        180.0      938.8
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
    mean_speed: ArrayLike
    min_speed: ArrayLike
    max_speed: ArrayLike
    speed_volatility: ArrayLike
    stall_torque: ArrayLike
    contact_fraction: ArrayLike
    mean_speed_error: ArrayLike
    min_speed_error: ArrayLike
    max_speed_error: ArrayLike
    speed_volatility_error: ArrayLike
    stall_torque_error: ArrayLike
    converged: bool | np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    reason: str | np.ndarray[tuple[int, ...], np.dtype[np.str_]]
    method: str | np.ndarray[tuple[int, ...], np.dtype[np.str_]]
    inputs: Inputs = field(repr=False)
    quantities: ClassVar = QUANTITIES
    shared: ClassVar = ("motor", "start", "contact")

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures of a single point do not say by themselves: a load that drives the rotor back, and so on."""
        return () if np.ndim(self.mean_speed) else remarks_of(self.figures, float(self.inputs.drive.load_torque))


_WORDS = ("reason", "method")
RESULTS = tuple(
    field.name for field in fields(OperatingPoint) if field.name not in ("motor", "start", "contact", *_WORDS, "inputs")
)
"""The figures of an operating point that depend on its numbers, in order."""


@overload
def evaluate(  # type: ignore[overload-overlap]  # the other one's levels have coupling, too, but not as "contact"
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    sampling_period: ArrayLike | None = None,
    tolerance: float | None = None,
    method: Method = "auto",
    progress: bool = False,
    coupling: Literal["contact"],
    **levels: Unpack[PrescribedChoice],
) -> CoupledPoint: ...


@overload
def evaluate(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    sampling_period: ArrayLike | None = None,
    tolerance: float | None = None,
    method: Method = "auto",
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> OperatingPoint: ...


def evaluate(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    sampling_period: ArrayLike | None = None,
    tolerance: float | None = None,
    method: Method = "auto",
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> OperatingPoint | CoupledPoint:
    """The operating point of a motor under a drive.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given.  Its parameters may be arrays.
    drive : Drive, optional
        The paper's Table 3 if not given.  Its fields and the motor's values broadcast.
    sampling_period : float or array, s, optional
        Averaging period of the encoder behind ``speed_volatility``; continuous if not given.
    tolerance : float, optional
        What the bounds of the errors of mean, extremes and deviation may be, relative to the largest speed, and those
        of contact and stall torque, relative to 1 and to the largest friction; from 1e-9 to 1e-2.  If not given it is
        1e-6, and a single point goes on until its mean speed has four digits or 1e-9 is reached; with coupling it stays
        1e-6.
    method : {"auto", "adaptive", "grid"}, optional
        How orbits are found: in adaptive steps; on a grid of equal steps, but for points where its bounds miss the
        tolerance; or so from a tolerance of 1e-3 on, where that is faster.  ``method`` of the result says which it was.
    progress : bool
        Whether to show a bar on the standard error while many points are computed.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling : str, optional
        Levels of the model, see :class:`trum_sym.model.levels.Levels`.

    Returns
    -------
    OperatingPoint
        Floats, or arrays of the inputs' common shape.  With ``coupling = "contact"`` a :class:`CoupledPoint`, whose
        figures are those of the orbit of wave, contact and rotor together: some of them others, each point an orbit of
        its own (some 0.1 s), errors that are estimates and no bounds.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    ConvergenceError
        If the forced amplitude and the resonance do not settle.

    Notes
    -----
    Section and resonance are eqs. 1 to 6, the amplitude eqs. 7 and 8, the phases eqs. 9 and 10, the determinants
    eqs. 43 and 44, contact and friction eqs. 25 to 37, the rotor eq. 38, each as the ledger puts it right
    (docs/ledger.md); how the orbit is found and how exact it is: docs/rotor.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> point = ts.evaluate(drive=ts.Drive(prepressure="170 N", load_torque=0.1))
    >>> f"{point.cycle_time * 1e3:.4f} ms, {point.units['mean_speed']}"
    '0.4760 ms, rad/s'
    """
    chosen = Levels(**levels)
    if chosen.coupling == "contact":
        from trum_sym.model.coupled_point import coupled_point, prepare_coupled

        case = prepare_coupled(motor, drive, chosen, tolerance, sampling_period, method=method)
        return coupled_point(case, progress)
    return settle(motor, drive, chosen, tolerance, sampling_period, progress, method)[1]


def settle(
    motor: Motor | None,
    drive: Drive | None,
    levels: Levels,
    tolerance: float | None,
    sampling_period: ArrayLike | None = None,
    progress: bool = False,
    method: Method = "auto",
) -> tuple[Case, OperatingPoint]:
    """The case and the point of :func:`evaluate`, at the tolerance that it comes to if none is given."""
    rough = _TOLERANCE if tolerance is None else tolerance
    case = prepare(motor, drive, levels, rough, sampling_period, method=method)
    point = point_of(case, progress)
    if tolerance is None and not case.shape:
        wanted, error = _DIGITS * abs(float(point.mean_speed)), float(point.mean_speed_error)
        if error > wanted:
            finer = max(_FINEST, 0.3 * _TOLERANCE * wanted / error)
            case = prepare(motor, drive, levels, finer, sampling_period, warn=False, method=method)
            point = point_of(case)
    return case, point


@dataclass(frozen=True)
class Case:
    """A checked motor and drive, and what the orbit's driver is told of them."""

    motor: Motor
    drive: Drive
    levels: Levels
    shape: tuple[int, ...]
    stator: Stator
    values: dict[str, ArrayLike]  # of the phases, for an amplitude of 1
    symbols: dict[str, ArrayLike]
    arguments: dict[str, ArrayLike]
    sampling_period: ArrayLike | None
    tolerance: float
    method: Method = "adaptive"


def prepare(
    motor: Motor | None,
    drive: Drive | None,
    levels: Levels,
    tolerance: float,
    sampling_period: ArrayLike | None = None,
    *,
    warn: bool = True,
    method: Method = "adaptive",
) -> Case:
    """Check the input of :func:`evaluate` and solve the stator.

    Raises
    ------
    ParameterError, ConvergenceError
        As :func:`evaluate` does.
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    inputs = numbers_of(motor, drive)
    sampling_period = period_of(sampling_period)
    if sampling_period is not None:
        inputs["sampling_period"] = sampling_period
    shape = broadcast_shape(inputs)
    tolerance = one_number("tolerance", tolerance, "1", TOLERANCES)
    choice("method", method, METHODS)
    check_steady_state(motor.damping_ratio.value, drive)
    if levels.tangential == "brush":
        check_drive(drive)
    _check_sampled(drive, sampling_period)
    stator = solve_stator(motor, drive, levels, warn=warn)
    values = modal_values(stator.omega_n, motor.damping_ratio.value, drive)
    if warn and (said := lack_of_damping(values)) is not None:
        warnings.warn(said, ValidityWarning, stacklevel=3)
    symbols = {**motor.symbols(), **stator.values, **drive.symbols()}
    arguments = orbit_values(scaled(values, stator.W), symbols, levels.contact, tolerance)
    if levels.tangential == "brush":
        arguments |= brush_values(symbols)
    return Case(motor, drive, levels, shape, stator, values, symbols, arguments, sampling_period, tolerance, method)


def _check_sampled(drive: Drive, sampling_period: ArrayLike | None) -> None:
    """Raise a ParameterError for a cycle too long to be kept as samples, where an encoder or a string ask for them."""
    longest = np.max(drive.periods)
    if longest <= _SAMPLED_PERIODS:
        return
    why = f"with periods = {longest:g}: at most {_SAMPLED_PERIODS} are kept as samples"
    if sampling_period is not None:
        raise ParameterError("sampling_period", np.asarray(sampling_period).flat[0], f"none {why}")
    if drive.load == "weight":
        raise ParameterError("load", drive.load, f"torque {why}")


def point_of(case: Case, progress: bool = False) -> OperatingPoint:
    """All figures of a case from :func:`prepare`."""
    found = results(case, (*RESULTS, *_WORDS), progress)
    inputs = Inputs(case.motor, case.drive, case.levels, case.sampling_period, case.tolerance)
    return OperatingPoint(
        motor=case.motor.name, start=case.drive.start, contact=case.levels.contact, **found, inputs=inputs
    )


def results(case: Case, wanted: Collection[str], progress: bool = False) -> dict[str, Any]:
    """Some figures of a case by name, each of the case's shape; what none of them needs is not computed.

    Parameters
    ----------
    case : Case
        From :func:`prepare`.
    wanted : names of :data:`RESULTS`, ``"runaway"``, ``"slack"``, ``"reason"``, ``"method"`` or ``"on_grid"``
        The last five say where no speed balances the load, where a weight's string goes slack, why an orbit is
        not converged or cannot be, how it was found, and whether on a grid.
    progress : bool
        As for :func:`evaluate`.
    """
    drive, stator = case.drive, case.stator
    timing = call("trum_drive", case.values)
    turn = 2 * np.pi
    found: dict[str, Any] = {
        "prepressure": drive.prepressure,
        "frequency_difference": drive.frequency_difference,
        "resonance_frequency": np.asarray(stator.omega_n) / turn,
        "drive_frequency": np.asarray(timing["omega_q"]) / turn,
        "cycle_time": timing["T"],
        "amplitude": stator.W,
        "neutral_axis": stator.D,
        "wavenumber": stator.k_c,
    }
    if not OF_CYCLE.isdisjoint(wanted):
        found |= cycle_sums(case.values)
    if not OF_ORBIT.isdisjoint(wanted):
        found |= _of_orbit(case, timing["T"], wanted, progress)
    return {name: _shaped(found[name], case.shape) for name in wanted}


def _of_orbit(case: Case, cycle_time: ArrayLike, wanted: Collection[str], progress: bool) -> dict[str, ArrayLike]:
    orbit = solve_orbit(case.arguments, case.symbols, progress, case.method)
    further = {"speed_volatility", "speed_volatility_error", "slack", "reason", "method"}
    found = {name: getattr(orbit, name) for name in OF_ORBIT - further}
    found["slack"], found["reason"] = np.zeros(orbit.converged.shape, bool), reasons(orbit.raw)
    found["method"] = np.where(orbit.on_grid, "grid", "adaptive")
    if case.drive.load == "weight" and not {"slack", "reason"}.isdisjoint(wanted):
        found["slack"] = least_tension(case.arguments, case.symbols, orbit) < 0
        found["reason"] = np.where(found["slack"] & (found["reason"] == ""), SLACK, found["reason"])
    if not {"speed_volatility", "speed_volatility_error"}.isdisjoint(wanted):
        deviation, deviation_error = np.sqrt(orbit.variance), orbit.deviation_error
        if case.sampling_period is not None:
            readings = _encoder(case.arguments, orbit, cycle_time, case.sampling_period)
            deviation = readings[..., 0] / np.asarray(case.symbols["r_c"])
            # averaging makes no deviation larger, so that of the error holds for an encoder, too
            deviation_error = deviation_error + readings[..., 1] / np.asarray(case.symbols["r_c"])
        of_mean = orbit.mean_speed, orbit.mean_speed_error
        found["speed_volatility"], found["speed_volatility_error"] = over_mean(deviation, deviation_error, *of_mean)
    return found


def encoder_deviation_of(case: Case, orbit: Orbit, period: ArrayLike) -> Array:
    """Standard deviation of an encoder's readings over a period in s, at every point of a case; rad/s."""
    _check_sampled(case.drive, period)
    cycle_time = call("trum_drive", case.values)["T"]
    readings = _encoder(case.arguments, orbit, cycle_time, period)
    return np.asarray(readings[..., 0] / np.asarray(case.symbols["r_c"]))


def _encoder(arguments: Mapping[str, ArrayLike], orbit: Orbit, cycle_time: ArrayLike, period: ArrayLike) -> Array:
    """Standard deviation of an encoder's readings at every point, and its change from half the samples; m/s."""
    names = list(arguments)
    raw = {name: orbit.raw[name] for name in ("low", "high", "start", "level")}
    columns = np.broadcast_arrays(*arguments.values(), *raw.values(), cycle_time, period)
    result = np.full((*columns[0].shape, 2), np.nan)
    for index in np.ndindex(columns[0].shape):
        at = [float(column[index]) for column in columns]
        point = dict(zip([*names, *raw], at[:-2], strict=True))
        if np.isfinite(point["start"]):
            count = int(_ENCODER_SAMPLES * point["m"])
            path = history(point, point, count)["distance"]
            deviation = encoder_deviation(path, at[-2], at[-1])
            result[index] = deviation, abs(deviation - encoder_deviation(path[1::2], at[-2], at[-1]))
    return result


def _shaped(value: Any, shape: tuple[int, ...]) -> Any:  # noqa: ANN401
    return np.broadcast_to(value, shape) if shape else np.asarray(value).item()
