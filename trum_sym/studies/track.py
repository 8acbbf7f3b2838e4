"""Speed in closed loop: an encoder that counts, a speed table, a PI controller of the frequency, and what drifts."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import one_number
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import modal_values, response, scaled
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.model.kernels import call
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import Case, prepare
from trum_sym.model.rotor import lap_from, orbit_values, solve_orbit
from trum_sym.model.spreading import unit_of
from trum_sym.optimiser.search import check_scalars
from trum_sym.output.progress import shown
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.studies.loop import Loop, loop_at
from trum_sym.studies.posed import Bound
from trum_sym.studies.speed_table import speed_table
from trum_sym.studies.speed_table_result import SpeedTable
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["DISTURBED", "Disturbance", "Run", "Tracking", "track"]

DISTURBED = ("prepressure", "load_torque", "friction_coefficient", "resonance_frequency")
"""What may change while the motor is tracked."""
_TOLERANCE = 1e-6  # of the orbits that laps are measured by
_PERIODS = 4  # samples of a drive period, between which the rotor's path is a cubic
_POSITIVE = Domain(low=0.0)
_LONGEST = 60.0  # s
_GRID, _ROUGH = 101, 1e-5  # frequencies to either side at which the reach is looked for; tolerance of their orbits
_COUNTS = Domain(low=1.0, low_open=False, integer=True)
_TEXT = re.compile(r"\s*(\w+)\s*=\s*([^@]+)@([^:]+)(?::(.+))?", re.DOTALL)
_FORM = "NAME=CHANGE@TIME or @FROM:TO, such as friction_coefficient=+1 %@0.1 s:0.2 s"


@dataclass(frozen=True, eq=False)
class Disturbance(Value):
    """A step or a ramp of an input, which stays: from ``begin`` to ``end``, s, by ``change``, in SI or a share."""

    name: str
    change: float
    share: bool
    begin: float
    end: float

    def at(self, time: float) -> float:
        """How much of it has come, 0 to 1."""
        if time < self.begin:
            return 0.0
        return 1.0 if time >= self.end else (time - self.begin) / (self.end - self.begin)

    @property
    def text(self) -> str:
        """In words."""
        unit = unit_of(self.name)
        by = f"{100 * self.change:+g} %" if self.share else f"{self.change:+g} {'' if unit == '1' else unit}".rstrip()
        when = f"at {self.begin:g} s" if self.end == self.begin else f"from {self.begin:g} to {self.end:g} s"
        return f"{self.name.replace('_', ' ')} {by} {when}"


@dataclass(frozen=True, eq=False)
class Reach(Value):
    """The frequency differences around a drive, Hz, over which the mean speed keeps rising or keeps falling, and the
    mean speeds at both, rad/s: beyond, more of the same correction would take the speed away from its target.
    """

    frequencies: tuple[float, float]
    speeds: tuple[float, float]


def _reach(motor: Motor, drive: Drive, levels: Levels, slope: float) -> Reach:
    """Within what the motor file's ``[allowed]`` or ``[box]`` says, on a grid."""
    feed = float(np.asarray(drive.frequency_difference))
    known = motor.allowed.get("frequency_difference", motor.box.get("frequency_difference"))
    low, high = (known.low, known.high) if known is not None else (0.9 * feed, 1.1 * feed)
    grids = (np.linspace(feed, low, _GRID), np.linspace(feed, high, _GRID))
    case = prepare(motor, replace(drive, frequency_difference=np.concatenate(grids)), levels, _ROUGH, warn=False)
    speeds = np.asarray(solve_orbit({**case.arguments, "held": 0.0}, case.symbols).mean_speed)
    ends: list[tuple[float, float]] = []
    for grid, there, way in zip(grids, (speeds[:_GRID], speeds[_GRID:]), (-1.0, 1.0), strict=True):
        wrong = ~(np.diff(there) * way * slope > 0)
        last = int(np.argmax(wrong)) if wrong.any() else _GRID - 1
        ends.append((float(grid[last]), float(there[last])))
    return Reach((ends[0][0], ends[1][0]), (ends[0][1], ends[1][1]))


@dataclass(frozen=True, eq=False)
class Run(Value):
    """A run, a number a control period: its end in s, the true mean speed over it, the encoder's reading, rad/s; the
    frequency difference that was set, Hz.
    """

    time: Array
    speed: Array
    reading: Array
    frequency_difference: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Tracking(Result, Value):
    """What a motor does in closed loop, and in open loop beside it, while its inputs drift.

    Attributes
    ----------
    target_speed : float, rad/s
    control_period : float, s
    encoder_counts : int
        In a revolution.
    disturbances : tuple of Disturbance
    closed, open : Run
        Under the same disturbances.
    loop : Loop
        Gains and margins at the target.
    loops : mapping
        The same at the other speeds of the table, rad/s.
    reach : Reach
        Where the controller may set the frequency.
    changes : tuple of float
        What each disturbance by itself changes the mean speed by in open loop, rad/s.
    windows : tuple of dict
        For each stretch between disturbances: begin and end, s, and of both runs mean speed, largest error of the mean
        over five control periods, standard deviation of the readings over the target's size, in its last half.
    inputs : Inputs
        Motor and drive at the target.

    Examples
    --------
    :func:`trum_sym.track` makes one; ``print(found.to_text())`` shows both runs.

    >>> import trum_sym as ts
    >>> [name for name in ts.Tracking.__dataclass_fields__ if name in ("closed", "open")]
    ['closed', 'open']
    """

    target_speed: float
    control_period: float
    encoder_counts: int
    disturbances: tuple[Disturbance, ...]
    closed: Run
    open: Run
    loop: Loop
    loops: Mapping[float, Loop]
    reach: Reach
    changes: tuple[float, ...]
    windows: tuple[Mapping[str, float], ...]
    inputs: Inputs = field(repr=False)

    def set_values(self, disturbance: Disturbance) -> Array:
        """How much of a disturbance has come at the ends of the control periods, 0 to 1."""
        return np.array([disturbance.at(float(time)) for time in self.closed.time])

    def __repr__(self) -> str:
        return f"<Tracking at {self.target_speed / ARCSEC:.6g} arcsec/s, {self.closed.time.size} control periods>"

    @property
    def beyond(self) -> list[Disturbance]:
        """The disturbances that no frequency which may be set takes up."""
        low, high = sorted(self.reach.speeds)
        pairs = zip(self.disturbances, self.changes, strict=True)
        return [disturbance for disturbance, change in pairs if not low < self.target_speed - change < high]

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures do not say by themselves."""
        found = []
        count = 2 * np.pi / self.encoder_counts / self.control_period
        if count > 0.1 * abs(self.target_speed):
            share = 100 * count / abs(self.target_speed)
            found.append(f"one count in a control period is {count / ARCSEC:.4g} arcsec/s, {share:.3g} % of the target")
        found += [f"no frequency that may be set takes up {disturbance.text}" for disturbance in self.beyond]
        if self.loop.gain_margin < 2:
            found.append(f"the loop is unstable where the motor's slope is {self.loop.gain_margin:.2g} times its own")
        return tuple(found)

    def to_dict(self) -> dict[str, Any]:
        """Inputs, both runs, loops, windows, remarks and units by name, in SI units."""
        runs = {
            name: {key: getattr(run, key).tolist() for key in Run.__dataclass_fields__}
            for name, run in (("closed", self.closed), ("open", self.open))
        }
        found = {
            **self.inputs.record(),
            "target_speed": self.target_speed,
            "control_period": self.control_period,
            "encoder_counts": self.encoder_counts,
            "disturbances": [vars(disturbance) for disturbance in self.disturbances],
            "loop": vars(self.loop),
            "reach": {"frequency_difference": self.reach.frequencies, "mean_speed": self.reach.speeds},
            "changes": self.changes,
            "loops": [{"mean_speed": speed, **vars(loop)} for speed, loop in self.loops.items()],
            "windows": [dict(window) for window in self.windows],
            **runs,
            "remarks": self.remarks,
        }
        units = {"target_speed": "rad/s", "control_period": "s", "slope": "rad/s/Hz", "phase_margin": "rad"}
        return {**found, "units": {**units_of(found), **units}}

    def to_text(self) -> str:
        """Both runs between disturbances, and the loop at every speed of the table."""
        target = self.target_speed / ARCSEC
        head = (
            f"{one_line(self.inputs.motor.name)} tracked at {target:.6g} arcsec/s: PI every "
            f"{1e3 * self.control_period:g} ms, {self.encoder_counts} counts in a revolution, "
            f"{self.inputs.drive.load_text()}"
        )
        rows = [
            (
                f"{w['begin']:g} to {w['end']:g}",
                *(f"{w[f'{run} {key}'] / unit:.5g}" for run in ("closed", "open") for key, unit in _SHOWN),
            )
            for w in self.windows
        ]
        headers = ["s", *(f"{run} loop\n{key}" for run in ("closed", "open") for key in ("mean", "error", "sigma %"))]
        table = text_table(rows, headers, "r" * 7)
        loops = [
            (
                f"{speed / ARCSEC:.6g}",
                f"{loop.slope / ARCSEC:.5g}",
                f"{loop.rotor:.3g}",
                f"{loop.proportional * ARCSEC:.3g}",
                f"{loop.integral * ARCSEC:.3g}",
                f"{loop.gain_margin:.3g}",
                f"{np.degrees(loop.phase_margin):.3g} deg",
            )
            for speed, loop in sorted({**self.loops, self.target_speed: self.loop}.items())
        ]
        names = (
            "arcsec/s",
            "slope\narcsec/s/Hz",
            "rotor\nkeeps",
            "P\nHz s/arcsec",
            "I",
            "gain\nmargin",
            "phase\nmargin",
        )
        margins = text_table(loops, names, "r" * 7)
        changes = zip(self.disturbances, self.changes, strict=True)
        said = [f"{d.text}: {change / ARCSEC:+.5g} arcsec/s by itself" for d, change in changes]
        (low, high), speeds = self.reach.frequencies, [speed / ARCSEC for speed in self.reach.speeds]
        said.append(
            f"the frequency is set from {low:.6g} to {high:.6g} Hz: {speeds[0]:.5g} to {speeds[1]:.5g} arcsec/s"
        )
        lines = [head, "", *said, "", table]
        lines += ["mean, error (the largest of means over five periods) in arcsec/s; sigma of the encoder's readings"]
        return "\n".join([*lines, "", margins, *(f"remark: {remark}" for remark in self.remarks)])


_SHOWN = (("mean", ARCSEC), ("error", ARCSEC), ("volatility", 0.01))


def track(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    target_speed: float | str,
    duration: float | str = 0.5,
    control_period: float | str = 2e-3,
    encoder_counts: float | None = None,
    disturbances: Sequence[str] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    table: SpeedTable | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> Tracking:
    """A motor at a speed in closed loop, cycle by cycle on the kernels of :func:`trum_sym.simulate`, and in open loop.

    The drive of a speed table is fed forward; a PI controller adds to its frequency what the counts of an encoder ask
    for, once in a control period; it takes effect in the next drive cycle.  The rotor starts from rest.

    Parameters
    ----------
    motor, drive, bounds, contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.speed_table`.
    target_speed : float or str, rad/s
        The mean speed, in the direction of its sign.
    duration, control_period : float or str, s
        Of the run, and of the controller and its encoder.
    encoder_counts : int, optional
        In a revolution; the motor file's if it states them.
    disturbances : sequence of str, optional
        ``"friction_coefficient=+1 %@0.1 s:0.2 s"``, a ramp, or ``"load_torque=+1 %@0.3 s"``, a step; of prepressure,
        load_torque, friction_coefficient and resonance_frequency, which may be in % of their values.  If not given,
        what the motor file states in ``[spreads]``, one after the other.
    table : SpeedTable, optional
        One that is there already; else one from half to twice the target is made.
    progress : bool
        Whether to show bars on the standard error.

    Returns
    -------
    Tracking
        Both runs, the loop's gains and margins; SI units.

    Raises
    ------
    ParameterError
        For bad input, and for a speed that the table does not have.
    MissingExtraError
        Without CasADi.

    Notes
    -----
    The resonance that the controller knows is that without disturbances: a drift of the resonance changes the frequency
    difference by as much.  Of the start "periodic" every drive cycle goes on with the free motion that the one before
    has left, whatever its frequency was.  The frequency is set only as far as the mean speed keeps rising, or falling,
    with it, and within what the motor file's ``[allowed]`` or ``[box]`` says.  Runs of the paper's motor:
    docs/holding.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> drive = ts.Drive(load_torque=0.1)
    >>> bounds = {"prepressure": 180.0, "frequency_difference": (2800, 3300)}
    >>> speeds = {"slowest": "50000 arcsec/s", "fastest": "100000 arcsec/s", "direction": "positive", "points": 2}
    >>> found = ts.track(
    ...     drive=drive,
    ...     target_speed="70000 arcsec/s",
    ...     duration="6 ms",
    ...     disturbances=["load_torque=+1 %@4 ms"],
    ...     table=ts.speed_table(drive=drive, bounds=bounds, **speeds),
    ... )
    >>> found.closed.time.size, len(found.windows)
    (3, 2)
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_scalars(motor, drive)
    target = one_number("target_speed", target_speed, "rad/s")
    if target == 0:
        raise ParameterError("target_speed", target, "a speed other than 0")
    period = one_number("control_period", control_period, "s", _POSITIVE)
    length = one_number("duration", duration, "s", Domain(low=period, high=_LONGEST, high_open=False))
    counts = _counts(motor, encoder_counts)
    chosen = Levels(**levels)
    if table is None:
        table = speed_table(
            motor,
            drive,
            slowest=0.5 * abs(target),
            fastest=2 * abs(target),
            direction="positive" if target > 0 else "negative",
            points=3,
            bounds=bounds,
            progress=progress,
            **levels,
        )
    at: dict[str, Any] = table.at(target)
    drive = replace(table.drive, **at)
    told = _disturbances(motor, length, disturbances)
    loop = loop_at(motor, drive, chosen, period)
    speeds = np.concatenate([segment.speed for segment in table.segments])
    loops = {}
    for speed in speeds[np.unique(np.linspace(0, speeds.size - 1, 5).round().astype(int))]:
        if np.isclose(speed, target, rtol=1e-6):
            continue
        there: dict[str, Any] = table.at(float(speed))
        loops[float(speed)] = loop_at(motor, replace(table.drive, **there), chosen, period)
    reach = _reach(motor, drive, chosen, loop.slope)
    plant = _Plant(motor, drive, chosen, told)
    runs = {}
    for name, gains in (("closed", loop), ("open", None)):
        bar: Callable[..., Any] = lambda steps, label=name: shown(steps, f"{label} loop" if progress else None)  # noqa: E731
        runs[name] = _run(plant, target, gains, period, length, counts, reach.frequencies, bar)
    return Tracking(
        target_speed=target,
        control_period=period,
        encoder_counts=counts,
        disturbances=told,
        closed=runs["closed"],
        open=runs["open"],
        loop=loop,
        loops=loops,
        reach=reach,
        changes=_changes(plant, told),
        windows=_windows(runs, told, target, length),
        inputs=Inputs(motor, drive, chosen, period, _TOLERANCE),
    )


def _counts(motor: Motor, given: float | None) -> int:
    if given is None and "encoder_counts" not in motor.bench:
        raise ParameterError("encoder_counts", "none", "counts of a revolution: the motor file states none in [bench]")
    value = float(np.asarray(motor.bench["encoder_counts"].value)) if given is None else given
    return int(one_number("encoder_counts", value, "1", _COUNTS))


def _disturbances(motor: Motor, length: float, texts: Sequence[str] | None) -> tuple[Disturbance, ...]:
    """What is given, or the motor file's spreads one after the other: half of each stretch a ramp, the load a step."""
    if texts is not None:
        if isinstance(texts, str) or not isinstance(texts, Sequence):
            raise ParameterError("disturbances", texts, f"a sequence of texts: {_FORM}")
        return tuple(_read(text, length) for text in texts)
    states = {name: motor.spreads[name] for name in DISTURBED if name in motor.spreads}
    if "frequency_difference" in motor.spreads:  # at a frequency that is set, the resonance drifts
        states["resonance_frequency"] = motor.spreads["frequency_difference"]
    found, step = [], length / (len(states) + 1)
    for k, (name, amount) in enumerate(states.items(), 1):
        ramp = 0.0 if name == "load_torque" else 0.5 * step
        found.append(Disturbance(name, amount.value, amount.share, k * step, k * step + ramp))
    return tuple(found)


def _read(text: object, length: float) -> Disturbance:
    parts = _TEXT.fullmatch(text) if isinstance(text, str) else None
    if parts is None:
        raise ParameterError("disturbances", text, _FORM)
    name, change, begin, end = parts.groups()
    if name not in DISTURBED:
        raise ParameterError("disturbances", name, f"one of {', '.join(DISTURBED)}")
    share = "%" in change
    by = one_number(f"change of {name}", change.strip(), "1" if share else unit_of(name))
    times = Domain(low=0.0, low_open=False, high=length, high_open=False)
    first = one_number(f"time of {name}", begin.strip(), "s", times)
    last = first if end is None else one_number(f"time of {name}", end.strip(), "s", times)
    if last < first:
        raise ParameterError(f"time of {name}", f"{first:g} to {last:g} s", "a ramp that ends after it begins")
    return Disturbance(name, by, share, first, last)


class _Plant:
    """The motor from one drive cycle to the next."""

    def __init__(self, motor: Motor, drive: Drive, levels: Levels, disturbances: Sequence[Disturbance]) -> None:
        self.motor, self.drive, self.levels, self.disturbances = motor, drive, levels, disturbances
        case = prepare(motor, drive, levels, _TOLERANCE, warn=False)
        self.resonance = float(np.asarray(case.stator.omega_n)) / (2 * np.pi)
        self.raw = {name: float(value) for name, value in solve_orbit(case.arguments, case.symbols).raw.items()}
        self.radius = float(np.asarray(case.symbols["r_c"]))
        self.start = case
        self._known: tuple[tuple[float, ...], Case] | None = None

    def case(self, time: float, difference: float) -> Case:
        """What holds in a cycle that begins at a time, for a frequency difference that is set."""
        values = {name: self._value(name) for name in DISTURBED}
        for disturbance in self.disturbances:
            by = disturbance.change * (abs(self._value(disturbance.name)) if disturbance.share else 1.0)
            values[disturbance.name] += by * disturbance.at(time)
        key = (*values.values(), difference)
        if self._known is not None and self._known[0] == key:
            return self._known[1]
        drive = replace(self.drive, prepressure=values["prepressure"], load_torque=values["load_torque"])
        drifted = values["resonance_frequency"] - self.resonance
        with unquestioned():
            motor = self.motor.with_values({"friction_coefficient": values["friction_coefficient"]})
            alone = prepare(motor, drive, self.levels, _TOLERANCE, warn=False)
            own = float(np.asarray(alone.stator.omega_n)) / (2 * np.pi) + drifted
            set_to = self.resonance + difference - own
            motor = motor.with_values({"resonance_frequency": own})
            case = prepare(motor, replace(drive, frequency_difference=set_to), self.levels, _TOLERANCE, warn=False)
        self._known = key, case
        return case

    def _value(self, name: str) -> float:
        if name == "resonance_frequency":
            return self.resonance
        of = getattr(self.drive, name) if name in DRIVE_DOMAINS else getattr(self.motor, name).value
        return float(np.asarray(of))


@dataclass
class _State:
    """Where the motor is at the start of a drive cycle: time, rim speed and path, the phases."""

    time: float
    speed: float
    path: float
    phases: dict[str, ArrayLike] | None


def _run(
    plant: _Plant,
    target: float,
    gains: Loop | None,
    period: float,
    length: float,
    counts: int,
    ends: tuple[float, float],
    bar: Callable[..., Any],
) -> Run:
    """Control periods one after the other, each through the drive cycles that end in it."""
    feed = float(np.asarray(plant.drive.frequency_difference))
    state, difference, summed, count = _State(0.0, 0.0, 0.0, None), feed, 0.0, 0
    course = _Course(plant)
    columns: dict[str, list[float]] = {name: [] for name in Run.__dataclass_fields__}
    before, width = 0.0, 2 * np.pi / counts
    for k in bar(range(1, round(length / period) + 1)):
        now = k * period
        angle = course.to(state, now, difference) / plant.radius
        counted = int(np.floor(angle / width))
        reading = (counted - count) * width / period
        for name, value in zip(columns, (now, (angle - before) / period, reading, difference), strict=True):
            columns[name].append(value)
        before, count = angle, counted
        if gains is not None:
            error = target - reading
            wanted = feed + gains.proportional * error + gains.integral * (summed + error)
            difference = min(max(wanted, ends[0]), ends[1])
            if wanted == difference:  # else the sum would grow for nothing
                summed += error
    return Run(**{name: np.array(values) for name, values in columns.items()})


class _Course:
    """The rotor's path over time, computed a drive cycle ahead."""

    def __init__(self, plant: _Plant) -> None:
        self.plant = plant
        self.nodes = np.zeros(1), np.zeros(1), np.zeros(1)  # times, path, speed

    def to(self, state: _State, time: float, difference: float) -> float:
        """The path at a time, with a frequency difference from the next cycle on."""
        while state.time < time:
            self._cycle(state, difference)
        times, path, speed = self.nodes
        k = min(max(int(np.searchsorted(times, time)), 1), times.size - 1)
        h = times[k] - times[k - 1]
        s = (time - times[k - 1]) / h
        change, first, last = path[k] - path[k - 1], h * speed[k - 1], h * speed[k]
        bent = (3 * change - 2 * first - last) + s * (first + last - 2 * change)
        return float(path[k - 1] + s * (first + s * bent))

    def _cycle(self, state: _State, difference: float) -> None:
        plant = self.plant
        case = plant.case(state.time, difference)
        values = _carried(case, state.phases)
        arguments = orbit_values(values, case.symbols, case.levels.contact, _TOLERANCE)
        count = _PERIODS * int(np.asarray(case.drive.periods))
        lap = lap_from(arguments, plant.raw, state.speed, count, plant.raw["level"])
        length = float(np.asarray(call("trum_drive", case.values)["T"]))
        times = state.time + length * np.arange(count + 1) / count
        path = state.path + np.concatenate([[0.0], lap["distance"]])
        self.nodes = times, path, np.concatenate([[state.speed], lap["speed"]])
        state.phases = response(length, values, case.stator.D, case.stator.k_c)
        state.time, state.path, state.speed = float(times[-1]), float(path[-1]), float(lap["speed"][-1])


def _carried(case: Case, phases: Mapping[str, ArrayLike] | None) -> dict[str, ArrayLike]:
    """The cycle's arguments with the free motion that the phases' state leaves; the start's own for the first cycle."""
    own = scaled(case.values, case.stator.W)
    if phases is None or case.drive.start != "periodic":
        return own
    still = modal_values(case.stator.omega_n, case.motor.damping_ratio.value, replace(case.drive, start="rest"))
    cancelling = scaled(still, case.stator.W)  # the free motion of phases at rest, less their steady one
    moving = {f"{part}_{p}": phases[f"{of}_{p}"] for p in "AB" for part, of in (("a", "w"), ("b", "v"))}
    return {**own, **{name: np.asarray(cancelling[name]) + np.asarray(value) for name, value in moving.items()}}


def _changes(plant: _Plant, disturbances: Sequence[Disturbance]) -> tuple[float, ...]:
    feed = float(np.asarray(plant.drive.frequency_difference))
    still = float(solve_orbit(plant.start.arguments, plant.start.symbols).mean_speed)
    found = []
    for disturbance in disturbances:
        alone = _Plant(plant.motor, plant.drive, plant.levels, (disturbance,))
        case = alone.case(disturbance.end, feed)
        found.append(float(solve_orbit(case.arguments, case.symbols).mean_speed) - still)
    return tuple(found)


def _windows(
    runs: Mapping[str, Run], disturbances: Sequence[Disturbance], target: float, length: float
) -> tuple[Mapping[str, float], ...]:
    """Figures of the last half of every stretch between disturbances."""
    marks = sorted({0.0, length, *(d.begin for d in disturbances), *(d.end for d in disturbances)})
    found = []
    for begin, end in pairwise(marks):
        window: dict[str, float] = {"begin": begin, "end": end}
        for name, run in runs.items():
            inside = (run.time > 0.5 * (begin + end)) & (run.time <= end + 1e-12)
            if not inside.any():
                continue
            speed = run.speed[inside]
            few = min(5, speed.size)
            means = np.convolve(speed, np.full(few, 1 / few), "valid")
            window[f"{name} mean"] = float(speed.mean())
            window[f"{name} error"] = float(np.max(np.abs(means - target)))
            window[f"{name} volatility"] = float(np.std(run.reading[inside])) / abs(target)
        if len(window) == 2 + 3 * len(runs):
            found.append(window)
    return tuple(found)
