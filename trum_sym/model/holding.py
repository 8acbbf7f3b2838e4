"""What it takes to hold an operating point: slopes of its mean speed, drifts, precision, start and return, encoder."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Unpack

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, SPREADING, Drive
from trum_sym.inputs.motor import COUPLED, SPECS, Amount, Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import check_point, check_single, numbers_of, one_number
from trum_sym.inputs.spreads import Spread
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.inputs import Inputs, remarks_of, units_of
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import Case, encoder_deviation_of, prepare
from trum_sym.model.rotor import RUNAWAY, solve_orbit
from trum_sym.model.sensitivities import orbit_with_slopes
from trum_sym.model.settling import RimOrbit, rim_orbits, settling_time
from trum_sym.model.spreading import amounts_at, amounts_of, speeds_off, unit_of
from trum_sym.model.string import SLACK, least_tension
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.values import FrozenDict, Value

__all__ = [
    "SPEED_TIME",
    "WITHIN",
    "Asked",
    "Holding",
    "asked_of",
    "compared",
    "hold",
    "holding",
]

WITHIN = 0.01
"""Share of its mean speed that a point is to be held within, where none is given."""
SPEED_TIME = 1.0
"""Time in s within which a rotor is to come to speed from rest, or back after a disturbance, where none is given."""

_TOLERANCE = 1e-9  # of the orbits
_SHIFTS = np.array([1.0, -1.0, 2.0, -2.0, 3.0, -3.0])
_WEIGHTS = np.array([45.0, -45.0, -9.0, 9.0, 1.0, -1.0]) / 60
_STEPS = np.array([1.0, 0.25, 0.0625])  # of the differences where no slope is known; next to a cusp only small ones do
_STEP, _PHASE_STEP = 1e-3, 4e-3  # the largest of them, of a value; rad
_SHARE = Domain(low=0.0, high=1.0)
_POSITIVE = Domain(low=0.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class Asked(Value):
    """What is asked of points that are to be held: how near to their speed, against what, in what time, read how.

    Attributes
    ----------
    within : float
        Share of the mean speed.
    amounts : mapping of Amount
        How far inputs may be off, by name.
    sampling_period : float or None
        Of an encoder, s; None for what the motor file states.
    speed_time : float
        From rest, and after a disturbance, s.
    """

    within: float = WITHIN
    amounts: Mapping[str, Amount] = field(default_factory=FrozenDict)
    sampling_period: float | None = None
    speed_time: float = SPEED_TIME

    def period(self, motor: Motor) -> float | None:
        """The encoder's sampling period: the one asked for, else the motor file's, else None."""
        if self.sampling_period is not None or "sampling_period" not in motor.bench:
            return self.sampling_period
        return float(np.asarray(motor.bench["sampling_period"].value))

    def of(self, motor: Motor, drive: Drive, levels: Levels) -> Holding:
        """What it takes to hold a single point."""
        return hold(prepare(motor, drive, levels, _TOLERANCE, warn=False), self)

    def each(self, motor: Motor, drive: Drive, levels: Levels) -> list[Holding]:
        """The same of a row of drives, with the exact slopes alone."""
        case = prepare(motor, drive, levels, _TOLERANCE, warn=False)
        return _hold_all(case, self, {})


def asked_of(
    motor: Motor,
    within: object = WITHIN,
    spreads: Mapping[str, Spread] | None = None,
    sampling_period: object = None,
    speed_time: object = SPEED_TIME,
) -> Asked:
    """The same from what was given, checked.

    Raises
    ------
    ParameterError
        For bad input.
    """
    period = None if sampling_period is None else one_number("sampling_period", sampling_period, "s", _POSITIVE)
    return Asked(
        within=one_number("within", within, "1", _SHARE),
        amounts=amounts_of(motor, spreads),
        sampling_period=period,
        speed_time=one_number("speed_time", speed_time, "s", _POSITIVE),
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class Holding(Result, Value):
    """What it takes to hold an operating point; SI units, frequencies in Hz, speeds in rad/s.

    Attributes
    ----------
    mean_speed : float
        NaN where no speed balances the load, and so is all that follows from it.
    within : float
        Share of the mean speed that the speed is to stay within.
    slopes : mapping
        Of the mean speed, by every number of the drive and every uncertain value of the motor that it depends on.
    spreads : mapping
        How far inputs may be off to either side: the motor file's ``[spreads]``, or what was given.
    drifts : mapping
        What each of these moves the mean speed by: the larger of the changes with the input off by that much to either
        side, with its sign.
    precisions : mapping
        How well each input has to be kept, alone, for the speed to stay within ``within``; infinite where it does not
        matter.
    start_time : float
        From rest under the load until the rotor's speed differs from the orbit's by no more than ``within`` of the
        mean: whole drive cycles, the last one shared out; in s.
    return_time : float
        The same after a disturbance by a tenth of the largest speed, the slower of more and less.
    starts, returns : bool
        Whether these are at most ``speed_time``, and the load does not drive the rotor back.
    speed_time : float
        In s.
    swing : float
        Highest less lowest speed.
    sampling_period : float or None
        Of an encoder, in s.
    encoder_volatility : float or None
        Standard deviation of its readings over the mean.
    figures : mapping
        Every figure of the point.
    inputs : Inputs
        Motor, drive, levels and tolerance that all of this holds for.

    Examples
    --------
    >>> import trum_sym as ts
    >>> found = ts.holding(drive=ts.Drive(load_torque=0.1, load_inertia="9.2e-4 kg*m^2"))
    >>> f"{found.precisions['frequency_difference']:.2f} Hz, {1e3 * found.start_time:.0f} ms from rest"
    '0.89 Hz, 133 ms from rest'
    """

    mean_speed: float
    within: float
    slopes: Mapping[str, float]
    spreads: Mapping[str, float]
    drifts: Mapping[str, float]
    precisions: Mapping[str, float]
    start_time: float
    return_time: float
    starts: bool
    returns: bool
    speed_time: float
    swing: float
    sampling_period: float | None
    encoder_volatility: float | None
    figures: Mapping[str, Any] = field(repr=False)
    inputs: Inputs = field(repr=False)

    def __repr__(self) -> str:
        return f"<Holding at {self.mean_speed / ARCSEC:.6g} arcsec/s: drift {self.drift / ARCSEC:.4g} arcsec/s>"

    @property
    def drift(self) -> float:
        """The sum of the drifts' sizes: what all spreads together may move the mean speed by, as far as they add."""
        return math.fsum(abs(drift) for drift in self.drifts.values())

    @property
    def fragile(self) -> str:
        """One sentence where the spread of a single input moves the mean speed by as much as there is of it."""
        known = {name: abs(drift) for name, drift in self.drifts.items() if np.isfinite(drift)}
        worst = max(known, key=lambda name: known[name], default=None)
        if worst is None or not known[worst] >= abs(self.mean_speed):
            return ""
        slope = self.slopes[worst]
        off = _in_words(worst, abs(self.mean_speed / slope), self.values[worst])
        more, less = ("doubles", "stops") if slope * self.mean_speed >= 0 else ("stops", "doubles")
        allowed = _in_words(worst, self.spreads[worst], self.values[worst])
        name = worst.replace("_", " ")
        return f"{off} more of {name} {more} this speed, as much less {less} it; it may be off by {allowed}"

    @property
    def values(self) -> dict[str, float]:
        """The inputs' own values, by name."""
        numbers = numbers_of(self.inputs.motor, self.inputs.drive)
        return {name: float(np.asarray(self.figures.get(name, numbers.get(name, np.nan)))) for name in self.slopes}

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures do not say by themselves."""
        found = list(remarks_of(self.figures, float(np.asarray(self.inputs.drive.load_torque))))
        if np.isfinite(self.mean_speed):
            found += [self.fragile] if self.fragile else []
            found += self.slowness
        return tuple(found)

    @property
    def slowness(self) -> list[str]:
        """That the rotor does not come to speed, or back to it, in the time that it has."""
        limit = f"{self.speed_time:g} s"
        found = []
        if self.start_time > self.speed_time:
            found.append(f"from rest the rotor is not at this speed within {limit}")
        if self.return_time > self.speed_time:
            found.append(f"after a disturbance by 10 % the rotor is not back at this speed within {limit}")
        return found

    def entries(self) -> dict[str, Any]:
        """All of it by name, for the record of a point."""
        hidden = ("inputs", "figures")
        found = {name: getattr(self, name) for name in self.__dataclass_fields__ if name not in hidden}
        return {**found, "drift": self.drift, "fragile": self.fragile}

    def joined(self, record: Mapping[str, Any]) -> dict[str, Any]:
        """The record of a point with all of this under ``holding``, and the units of it."""
        units = {**record["units"], "holding": {**units_of(self.entries()), **self.units}}
        remarks = (*record["remarks"], *(remark for remark in self.remarks if remark not in record["remarks"]))
        return {**record, "holding": self.entries(), "remarks": remarks, "units": units}

    def to_dict(self) -> dict[str, Any]:
        """Inputs, all figures, remarks and units by name, in SI units."""
        found = {**self.inputs.record(), **self.entries(), "remarks": self.remarks}
        return {**found, "units": {**units_of(found), **self.units}}

    @property
    def units(self) -> dict[str, Any]:
        """The SI units of the mappings' numbers."""
        return {
            "slopes": {name: _per(unit_of(name)) for name in self.slopes},
            "spreads": {name: unit_of(name) for name in self.spreads},
            "drifts": dict.fromkeys(self.drifts, "rad/s"),
            "precisions": {name: unit_of(name) for name in self.precisions},
        }

    def to_text(self) -> str:
        """The table, and what else it takes, in the units that people read."""
        return "\n".join([*self.lines(), *(f"remark: {remark}" for remark in self.remarks)])

    def lines(self) -> list[str]:
        """The table and what else it takes, without the remarks."""
        rows = [
            (
                name,
                _signed(self.slopes[name] / ARCSEC),
                f"arcsec/s{_after(unit_of(name))}",
                _in_words(name, self.spreads[name], self.values[name]) if name in self.spreads else "",
                _signed(self.drifts[name] / ARCSEC) if name in self.drifts else "",
                _in_words(name, self.precisions[name], self.values[name]),
            )
            for name in self.slopes
        ]
        headers = (
            "to hold the speed",
            "slope",
            "",
            "may be off by",
            "drift arcsec/s",
            f"for {100 * self.within:g} % keep within",
        )
        table = text_table(rows, headers, "lrlrrr")
        speed = abs(self.mean_speed)
        of_mean = f", {100 * self.drift / speed:.4g} % of the mean" if speed > 0 else ""
        lines = [table, "", f"all of these off at once: {self.drift / ARCSEC:.4g} arcsec/s{of_mean}"] if rows else []
        lines.append(
            f"from rest under the load: {_time(self.start_time)}; "
            f"after a disturbance by 10 %: {_time(self.return_time)}"
        )
        lines.append(f"swing within a cycle: {self.swing / ARCSEC:.4g} arcsec/s")
        if self.encoder_volatility is not None and self.sampling_period is not None:
            volatility = f"{100 * self.encoder_volatility:.4g} %"
            lines.append(f"volatility read by an encoder every {1e3 * self.sampling_period:g} ms: {volatility}")
        return lines


def compared(labels: Sequence[str], holdings: Sequence[Holding], heading: str) -> str:
    """A table of what it takes to hold several points, a line a point: drifts by input, then start and encoder."""
    names = list(dict.fromkeys(name for holding in holdings for name in holding.drifts))
    spreads = [_in_words(name, holdings[0].spreads[name], holdings[0].values[name]) for name in names]
    headers = [heading, *(f"drift by {off}\n{name}" for off, name in zip(spreads, names, strict=True))]
    headers += ["all, % of\nthe mean", "from rest\nms", "encoder\n%"]
    rows = []
    for label, holding in zip(labels, holdings, strict=True):
        speed, volatility = abs(holding.mean_speed), holding.encoder_volatility
        rows.append(
            (
                label,
                *(_signed(holding.drifts[name] / ARCSEC) for name in names),
                f"{100 * holding.drift / speed:.4g}" if speed else "-",
                f"{1e3 * holding.start_time:.3g}",
                "-" if volatility is None else f"{100 * volatility:.4g}",
            )
        )
    table = text_table(rows, headers, "r" * len(headers))
    return f"to hold these points: what the mean speed drifts by, arcsec/s\n\n{table}"


def _per(unit: str) -> str:
    return "rad/s" if unit == "1" else f"rad/s/{unit}" if unit.isalpha() else f"rad/s/({unit})"


def _after(unit: str) -> str:
    return "" if unit == "1" else f" / {unit}" if unit.isalpha() else f" / ({unit})"


def _signed(value: float) -> str:
    return f"{value:+.4g}" if np.isfinite(value) else "-"


def _in_words(name: str, amount: float, value: float) -> str:
    """An amount of an input: in its unit where a drive is set in it, else in percent of its value."""
    if not np.isfinite(amount):
        return "any"
    if name in ("prepressure", "frequency_difference", "resonance_frequency", "switching_phase"):
        return f"{amount:.3g} {unit_of(name)}"
    return f"{100 * amount / abs(value):.3g} %" if value else f"{amount:.3g} {unit_of(name)}"


def _time(seconds: float) -> str:
    return f"at this speed after {1e3 * seconds:.3g} ms" if np.isfinite(seconds) else "never at this speed"


def holding(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    within: float | str = WITHIN,
    spreads: Mapping[str, Spread] | None = None,
    sampling_period: float | str | None = None,
    speed_time: float | str = SPEED_TIME,
    **levels: Unpack[LevelChoice],
) -> Holding:
    """What it takes to hold an operating point.

    Parameters
    ----------
    motor, drive, contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; every number a single one.  ``tangential`` has to be ``"rigid"``.
    within : float
        Share of the mean speed that the speed is to be held within.
    spreads : mapping, optional
        How far inputs may be off: ``{"prepressure": "+-1 N", "friction_coefficient": "1 %"}``.  What is not named is
        as the motor file states it in ``[spreads]``.
    sampling_period : float, s, optional
        Of an encoder; the motor file's if it states one.
    speed_time : float, s
        Within which the rotor is to be at its speed from rest, and back at it after a disturbance.

    Returns
    -------
    Holding
        Slopes, drifts, precisions, start and return, in SI units.

    Raises
    ------
    ParameterError
        For bad input, and for a layer that is a brush, whose slopes are not known.

    Notes
    -----
    What is said, and how it was checked: docs/holding.md.  Slopes by prepressure, frequency difference, load,
    friction, amplitude and resonance are exact (:func:`trum_sym.sensitivities`); those by the switching phase and by
    the motor's other uncertain values are differences of sixth order on orbits at 1e-9.  A drift is no slope times a
    spread: next to where the contact opens or closes anew within a cycle slopes change within a thousandth of a newton,
    and a spread is wider than that.

    From rest and from a disturbance the rotor is followed lap by lap.  Laps draw speeds together; from the thirteenth
    on, by how much is told by four laps in every decade of the distance that is left.

    Examples
    --------
    >>> import trum_sym as ts
    >>> found = ts.holding(drive=ts.Drive(load_torque=0.1))
    >>> found.starts, sorted(found.drifts) == sorted(found.spreads)
    (True, True)
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    check_single(numbers_of(motor, drive))
    asked = asked_of(motor, within, spreads, sampling_period, speed_time)
    return hold(prepare(motor, drive, Levels(**levels), _TOLERANCE), asked)


def hold(case: Case, asked: Asked) -> Holding:
    """:func:`holding` of a case that is checked, of single numbers."""
    (found,) = _hold_all(case, asked, _other_slopes(case))
    return found


def _hold_all(case: Case, asked: Asked, others: Mapping[str, float]) -> list[Holding]:
    orbit, by = orbit_with_slopes(case)
    amounts = {name: np.ravel(off) for name, off in amounts_at(case, asked.amounts).items()}
    moved = {name: np.reshape(both, (2, -1)) for name, both in speeds_off(case, asked.amounts).items()}
    sampling_period = asked.period(case.motor)
    own = {
        "amplitude": np.broadcast_to(case.stator.W, case.shape),
        "resonance_frequency": np.broadcast_to(np.asarray(case.stator.omega_n) / (2 * np.pi), case.shape),
    }
    rows = list[Holding]()
    drives = {name: np.broadcast_to(value, case.shape).ravel() for name, value in case.drive.numbers().items()}
    encoder = None if sampling_period is None else np.ravel(encoder_deviation_of(case, orbit, sampling_period))
    of_orbit = {
        name: np.ravel(getattr(orbit, name)) for name in ("mean_speed", "min_speed", "max_speed", "stall_torque")
    }
    reasons = np.where(np.ravel(orbit.runaway), RUNAWAY, "")
    if case.drive.load == "weight":
        slack = np.ravel(least_tension(case.arguments, case.symbols, orbit)) < 0
        reasons = np.where(slack & (reasons == ""), SLACK, reasons)
    for k, point in enumerate(rim_orbits(case, orbit)):
        figures: dict[str, Any] = {name: float(values[k]) for name, values in of_orbit.items()}
        figures["reason"] = str(reasons[k])
        figures |= {name: float(np.ravel(own[name])[k]) for name in own}
        found = {name: float(np.ravel(slope)[k]) for name, slope in by["mean_speed"].items()} | dict(others)
        at: dict[str, Any] = {name: values[k] for name, values in drives.items()}
        drive = replace(case.drive, **at) if case.shape else case.drive
        rows.append(
            _holding(
                point,
                figures,
                found,
                {name: float(off[k]) for name, off in amounts.items()},
                {name: _larger(both[:, k] - figures["mean_speed"]) for name, both in moved.items()},
                asked,
                None if encoder is None else float(encoder[k]),
                Inputs(case.motor, drive, case.levels, sampling_period, case.tolerance),
            )
        )
    return rows


def _holding(
    point: RimOrbit,
    figures: Mapping[str, Any],
    slopes: Mapping[str, float],
    spreads: Mapping[str, float],
    drifts: Mapping[str, float],
    asked: Asked,
    deviation: float | None,
    inputs: Inputs,
) -> Holding:
    """From numbers of one point to what they mean."""
    within, speed_time = asked.within, asked.speed_time
    mean, load = figures["mean_speed"], float(np.asarray(inputs.drive.load_torque))
    error = within * abs(mean)
    start_time, return_time = (settling_time(point, begins, error) for begins in (("rest",), ("more", "less")))
    pushed_back = not np.isfinite(mean) or mean * load < 0
    shown = {name: slope for name, slope in slopes.items() if name in spreads or slope != 0}
    with np.errstate(all="ignore"):
        precisions = {name: float(np.divide(error, abs(slope))) for name, slope in shown.items()}
    return Holding(
        mean_speed=mean,
        within=within,
        slopes=shown,
        spreads=spreads,
        drifts=drifts,
        precisions=precisions,
        start_time=start_time,
        return_time=return_time,
        starts=start_time <= speed_time and not pushed_back,
        returns=return_time <= speed_time and not pushed_back,
        speed_time=speed_time,
        swing=figures["max_speed"] - figures["min_speed"],
        sampling_period=inputs.sampling_period,  # type: ignore[arg-type]  # of a single point
        encoder_volatility=deviation / abs(mean) if deviation is not None and mean and np.isfinite(mean) else None,
        figures=figures,
        inputs=inputs,
    )


def _larger(changes: Array) -> float:
    return float(changes[int(np.argmax(np.abs(changes)))])


def _other_slopes(case: Case) -> dict[str, float]:
    """Slopes by the switching phase and by assumed values that count, by differences of sixth order, in one batch."""
    steps = {"switching_phase": _PHASE_STEP}
    for name, parameter in case.motor.assumed().items():
        if name in (*SPREADING, *COUPLED) or SPECS[name].domain.integer:
            continue
        step = _STEP * abs(float(np.asarray(parameter.value)))
        if step and _counts(case, name, step):
            steps[name] = step
    shifts = (_STEPS[:, np.newaxis] * _SHIFTS).ravel()
    moved = [_moved(case, name, step * shifts) for name, step in steps.items()]
    arguments = _joined([one.arguments for one in moved], shifts.size)
    speeds = solve_orbit({**arguments, "held": 0.0}, _joined([one.symbols for one in moved], shifts.size)).mean_speed
    by_step = np.asarray(speeds).reshape(len(steps), _STEPS.size, _SHIFTS.size) @ _WEIGHTS
    return {name: _agreed(found / (step * _STEPS)) for (name, step), found in zip(steps.items(), by_step, strict=True)}


def _joined(parts: Sequence[Mapping[str, ArrayLike]], size: int) -> dict[str, ArrayLike]:
    """Values of as many points each, one after the other."""
    return {name: np.concatenate([np.broadcast_to(part[name], size) for part in parts]) for name in parts[0]}


def _counts(case: Case, name: str, step: float) -> bool:
    """Whether the rotor's equation changes with a value of the motor."""
    moved = _moved(case, name, np.array([step]))
    if not np.array_equal(moved.symbols["r_c"], case.symbols["r_c"]):
        return True
    return any(np.any(np.asarray(value) != np.asarray(case.arguments[key])) for key, value in moved.arguments.items())


def _moved(case: Case, name: str, by: np.ndarray[Any, Any]) -> Case:
    motor, drive = case.motor, case.drive
    if name in DRIVE_DOMAINS:
        to: dict[str, Any] = {name: float(np.asarray(getattr(drive, name))) + by}
        drive = replace(drive, **to)
    else:
        with unquestioned():
            motor = motor.with_values({name: float(np.asarray(getattr(motor, name).value)) + by})
    return prepare(motor, drive, case.levels, case.tolerance, warn=False)


def _agreed(slopes: Array) -> float:
    """Of the slopes by several steps the two neighbours that agree best, the smaller step's."""
    with np.errstate(invalid="ignore"):
        apart = np.abs(np.diff(slopes))
    return float(slopes[1 + int(np.argmin(apart))])
