"""Any drive on the coupled engine: the cycle that it comes back to, its start from rest and its stop (Sects. 1, 2).

The laps are those of :mod:`trum_sym.model.coupled_orbit`.  Here they follow each other in parts of a drive period, so
that the rotor's path is known: what an encoder reads is differences of it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.choices import choice
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_point, one_number
from trum_sym.inputs.schedule import Schedule
from trum_sym.inputs.shown import full
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.coupled_orbit import MOVING, STARTS, STATE, CoupledOrbit, lap_values, laps, orbit_from, start_of
from trum_sym.model.inputs import Inputs
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.orbit_certificate import OrbitCertificate, certificate_of
from trum_sym.output.digits import with_error
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["DriveHistory", "DriveOrbit", "drive_history", "drive_orbit", "history_of", "read_by_encoder"]

_COUNT = Domain(low=1, low_open=False, high=1e6, integer=True)
_PAUSE = Domain(low=0, low_open=False, high=1e6, integer=True)
_PERIOD = Domain(low=0.0, high=1e6)


@dataclass(frozen=True, eq=False)
class DriveHistory(Value):
    """A motion in time: its k + 1 instants and the k spans between them; SI.

    Attributes
    ----------
    time : (k + 1,) array, s
    speed, angle : (k + 1,) array, rad/s and rad
        Of the rotor.
    wave : (k + 1,) array, m
        Height of the wave.
    states : (7, k + 1) array
        Both phases' displacement and velocity, the rotor's height and its rate, speed of the rim.
    driven : (k, 2) array
        Whether A and B are driven, 1 or 0.
    input_power : (k,) array, W
        Mean of what the modal forces put in.
    """

    time: Array
    speed: Array
    angle: Array
    wave: Array
    states: Array
    driven: Array
    input_power: Array


def history_of(values: Mapping[str, float], state: Array, gates: Array, samples: int) -> DriveHistory:
    """A motion through drive periods with given gates, in parts of a period; a span at rest is one part.

    Parameters
    ----------
    values : mapping
        From :func:`trum_sym.model.coupled_orbit.lap_values`; of its own gates only what they are at the cycle's end
        counts, before the motion.
    state : (7,) array
        At the start.
    gates : (m, 2) array
        Whether A and B are driven, 1 or 0, in each drive period.
    samples : int
        Parts of a drive period.
    """
    span = 2 * np.pi / values["omega_q"]
    always = {"off_A": 0.0, "off_B": 0.0}
    ends, times, paths, powers, driven = [state], [0.0], [0.0], [], []
    before = {name: values[name] for name in ("driven_A", "driven_B", "pull_A", "pull_B")}
    changes = np.flatnonzero(np.any(np.diff(gates, axis=0) != 0, axis=1)) + 1
    period = 0
    while period < len(gates):
        gate = {"on_A": 1.0 - gates[period, 0], "on_B": 1.0 - gates[period, 1]}
        later = changes[changes > period]
        parts = np.full(samples, 1 / samples)
        if not gates[period].any() and not values["mass"] and not ends[-1][MOVING].any():
            parts = np.array([float((later[0] if later.size else len(gates)) - period)])
            gate = {"on_A": parts[0], "on_B": parts[0]}
        for k, part in enumerate(parts):
            turned = values["force_phase"] + 2 * np.pi * k / samples
            now = {**values, **always, **gate, **before, "m": float(part), "force_phase": turned}
            end, lap = laps(now, ends[-1][:, np.newaxis])
            before = {"driven_A": gates[period, 0], "driven_B": gates[period, 1]}
            before |= {name: float(lap[name][0]) for name in ("pull_A", "pull_B")}
            ends.append(end[:, 0])
            times.append(period + float(parts[: k + 1].sum()))
            paths.append(paths[-1] + float(lap["mean"][0]) * float(part) * span)
            powers.append(float(lap["input"][0]))
            driven.append(gates[period])
        period += max(1, round(float(parts.sum())))
    states = np.array(ends).T
    radius = values["r_c"]
    return DriveHistory(
        time=np.array(times) * span,
        speed=states[STATE.index("v")] / radius,
        angle=np.array(paths) / radius,
        wave=np.hypot(states[STATE.index("w_A")], states[STATE.index("w_B")]),
        states=states,
        driven=np.array(driven),
        input_power=np.array(powers),
    )


def read_by_encoder(time: Array, angle: Array, period: float) -> tuple[float, float, float]:
    """What an encoder that averages over a period reads of a cycle: standard deviation, least and largest, rad/s.

    Its windows begin anywhere in the cycle with equal chance.  Between the instants the speed counts as constant, so
    that a reading is linear in the window's start between the instants at which it begins or ends: the deviation is
    exact.

    Parameters
    ----------
    time, angle : (k,) array, s and rad
        Of a whole cycle, from 0 to its end.
    period : float, s
        Of the encoder.

    Examples
    --------
    A rotor that turns for one second of ten, read every second: a reading is anything from 0 to 1 rad/s.

    >>> spread, low, high = read_by_encoder(np.array([0.0, 1.0, 10.0]), np.array([0.0, 1.0, 1.0]), 1.0)
    >>> bool(abs(spread**2 - (2 / 3 / 10 - 0.1**2)) < 1e-15), float(low), float(high)
    (True, 0.0, 1.0)
    """
    cycle, advance = float(time[-1]), float(angle[-1])
    ends = np.concatenate([time, (time - period) % cycle, [0.0, cycle]])
    starts = np.unique(np.clip(ends, 0.0, cycle))

    def path(at: Array) -> Array:
        whole = np.floor(at / cycle)
        return np.interp(at - whole * cycle, time, angle) + whole * advance

    off = (path(starts + period) - path(starts)) / period - advance / cycle
    a, b = off[:-1], off[1:]
    variance = float(np.sum((a * a + a * b + b * b) / 3 * np.diff(starts))) / cycle
    return variance**0.5, float(off.min()) + advance / cycle, float(off.max()) + advance / cycle


@dataclass(frozen=True, eq=False)
class DriveOrbit(Result, Value):
    """The cycle that a drive comes back to from a start, with the rotor's reaction on the wave; SI.

    Attributes
    ----------
    schedule : Schedule
    orbit : CoupledOrbit
        Mean, extremes and deviation of the speed, wave, power, whether it closes and is stable.
    history : DriveHistory
        Of the orbit's cycles.
    encoder_deviation, encoder_low, encoder_high : float or None, rad/s
        Standard deviation, least and largest of what the encoder reads; None without a sampling period.
    inputs : Inputs
        Motor, drive, levels and sampling period.
    certificate : OrbitCertificate or None
        Whether the orbit is there, alone and stable for certain; None if it was not asked for.

    Examples
    --------
    :func:`trum_sym.drive_orbit` makes one; ``print(found.to_text())`` shows it.

    >>> import trum_sym as ts
    >>> "orbit" in ts.DriveOrbit.__dataclass_fields__
    True
    """

    schedule: Schedule
    orbit: CoupledOrbit
    history: DriveHistory = field(repr=False)
    encoder_deviation: float | None
    encoder_low: float | None
    encoder_high: float | None
    inputs: Inputs = field(repr=False)
    certificate: OrbitCertificate | None = None

    def to_dict(self) -> dict[str, Any]:
        """Schedule, figures and inputs by name, in SI units; multipliers by their size."""
        skip = ("state", "multipliers")
        numbers = {name: value for name, value in vars(self.orbit).items() if name not in skip}
        return {
            **self.inputs.record(),
            "schedule": dict(vars(self.schedule)),
            **numbers,
            "stable": self.orbit.stable,
            "converged": self.converged,
            "largest_multiplier": float(np.abs(self.orbit.multipliers).max()),
            **{name: getattr(self, name) for name in ("encoder_deviation", "encoder_low", "encoder_high")},
            **({} if self.certificate is None else {"certificate": _record(self.certificate)}),
        }

    @property
    def converged(self) -> bool:
        """Whether the orbit closes, attracts, and has errors that meet the tolerance."""
        return self.orbit.converged

    def to_text(self) -> str:
        """A table of the speed's figures in arcsec/s, then wave and power, with the estimates of their errors."""
        orbit, rows = self.orbit, []
        for name, label, unit, scale in _SHOWN:
            value, error = getattr(orbit, name), getattr(orbit, f"{name}_error")
            rows.append((label, *with_error(value / scale, error / scale), unit))
        read = (self.encoder_deviation, self.encoder_low, self.encoder_high)
        for label, figure in zip(_READ, read, strict=True):
            if figure is not None:
                rows.append((label, f"{figure / ARCSEC:.6g}", "", "arcsec/s"))
        state = f"closed after {orbit.cycles} cycle{'s' * (orbit.cycles != 1)}" if orbit.closed else "comes to no orbit"
        most = float(np.abs(orbit.multipliers).max())
        state += ", attracts" if orbit.stable else f", does not attract: multipliers up to {most:.4g}" * orbit.closed
        state += ", errors miss the tolerance" if orbit.closed and not orbit.tolerance_met else ""
        drive, motor = self.inputs.drive, one_line(self.inputs.motor.name)
        title = (
            f"{motor}, {self._schedule()}, at {full(drive.prepressure)} N, "
            f"{float(drive.frequency_difference):+.10g} Hz, {drive.load_text()}"
        )
        table = text_table(rows, ("", "value", "+-", "unit"), "lrll")
        certain = "" if self.certificate is None else f"\n{_certainty(self.certificate)}"
        return f"{title}\nfrom {orbit.start}: {state}{certain}\n\n{table}"

    def _schedule(self) -> str:
        """The schedule in words."""
        schedule = self.schedule
        m, n = schedule.counts(self.inputs.drive)
        found = [schedule.kind + (f", {n} of {m} periods on" if schedule.kind in ("pulses", "burst") else "")]
        if schedule.off_terminals != "short":
            found.append(f"{schedule.off_terminals} terminals when off")
        plain = Schedule()
        for name, unit, scale in (("phase_difference", "deg", math.degrees(1.0)), ("voltage", "", 1), ("ratio", "", 1)):
            if getattr(schedule, name) != getattr(plain, name):
                found.append(f"{name.replace('_', ' ')} {scale * getattr(schedule, name):.6g} {unit}".rstrip())
        return ", ".join(found)


_SHOWN = (
    ("mean_speed", "mean speed", "arcsec/s", ARCSEC),
    ("deviation", "standard deviation", "arcsec/s", ARCSEC),
    ("min_speed", "lowest speed", "arcsec/s", ARCSEC),
    ("max_speed", "highest speed", "arcsec/s", ARCSEC),
    ("contact_fraction", "contact fraction", "", 1.0),
    ("highest_wave", "highest wave", "µm", 1e-6),
    ("input_power", "input power", "W", 1.0),
)
_READ = ("encoder's deviation", "its least reading", "its largest reading")


def _certainty(found: OrbitCertificate) -> str:
    """A certificate in words."""
    if not found.certified:
        return f"not certified: {found.reason}"
    stable = "stable for certain" if found.stable else "not stable for certain"
    return (
        f"certified: begins within {found.radius:.2g} of the state's size, alone within {found.alone_within:.2g}, "
        f"mean +- {found.mean_speed_error / ARCSEC:.2g} arcsec/s, {stable}"
    )


def _record(found: OrbitCertificate) -> dict[str, Any]:
    """A certificate's numbers and words by name; multipliers by their size."""
    skip = ("state_error", "multipliers", "multiplier_error")
    kept = {name: value for name, value in vars(found).items() if name not in skip}
    return {**kept, "largest_multiplier_error": float(np.max(found.multiplier_error, initial=0.0))}


def _values(
    motor: Motor,
    drive: Drive,
    schedule: Schedule | None,
    levels: Levels,
    rotor_mass: float | str | None,
    tolerance: float,
) -> tuple[Schedule, dict[str, float]]:
    """The schedule and what its laps depend on.

    Raises
    ------
    ParameterError
        For what is no schedule, a level of coupling that is not ``contact``, and as :func:`lap_values` does.
    """
    check_point(motor, drive)
    chosen = Schedule() if schedule is None else schedule
    if not isinstance(chosen, Schedule):
        raise ParameterError("schedule", chosen, "a Schedule")
    return chosen, lap_values(motor, drive, levels, chosen, rotor_mass=rotor_mass, tolerance=tolerance)


def _coupled(levels: LevelChoice) -> Levels:
    """The levels with coupling, which no other word may deny."""
    if levels.get("coupling", "contact") != "contact":
        raise ParameterError("coupling", levels["coupling"], "contact: a wave that feels the rotor")
    return replace(Levels(**levels), coupling="contact")


def drive_orbit(
    motor: Motor | None = None,
    drive: Drive | None = None,
    schedule: Schedule | None = None,
    *,
    rotor_mass: float | str | None = None,
    start: str = "rest",
    sampling_period: float | str | None = None,
    samples_per_period: float = 8,
    tolerance: float = 1e-6,
    certify: bool = False,
    **levels: Unpack[LevelChoice],
) -> DriveOrbit:
    """The cycle that any drive comes back to, with the rotor's reaction on the wave (docs/coupling.md).

    Parameters
    ----------
    motor, drive
        As for :func:`trum_sym.evaluate`, but every number a single one.
    schedule : Schedule, optional
        Which phase is driven when; the drive's superimposed pulses if not given.
    rotor_mass : float, kg, optional
        That goes up and down under the prepressure; the motor file's if not given, none where it states none.  A rotor
        without a mass follows the wave.
    start : {"rest", "steady"}
        Where the laps begin that lead to the orbit: another start may lead to another one.
    sampling_period : float, s, optional
        Of an encoder that averages over it.
    samples_per_period : whole number
        Parts of a drive period between which the rotor's path is taken for the encoder.
    tolerance : float
        Of mean, lowest and highest speed over the largest, 1e-9 to 1e-2.
    certify : bool
        Whether to look for what is certain of the orbit (``trum_sym.model.orbit_certificate``), which takes about
        as long as the orbit.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        Levels, as for :func:`trum_sym.evaluate`; ``coupling`` is ``contact`` here.

    Returns
    -------
    DriveOrbit

    Raises
    ------
    ParameterError
        For bad input, and for what the level ``contact`` does not know; names the parameter, what it got, what is
        allowed.

    Examples
    --------
    Of a burst of one period in a thousand everything comes to rest again; a step is 184 arcsec under a rotor that
    follows the wave:

    >>> import trum_sym as ts
    >>> drive = ts.Drive(frequency_difference=500, load_torque=0)
    >>> burst = ts.Schedule(kind="burst", periods=1000, on_periods=1)
    >>> found = ts.drive_orbit(drive=drive, schedule=burst, rotor_mass=0)
    >>> found.orbit.closed, f"{found.history.angle[-1] * 206264.8:.0f} arcsec"
    (True, '184 arcsec')
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    choice("start", start, STARTS)
    chosen_levels = _coupled(levels)
    samples = _samples(samples_per_period)
    period = None if sampling_period is None else one_number("sampling_period", sampling_period, "s", _PERIOD)
    chosen, values = _values(motor, drive, schedule, chosen_levels, rotor_mass, tolerance)
    begun = start_of(start, values)
    first = laps(values, begun[:, np.newaxis])[0][:, 0]
    again = np.array_equal(first[MOVING], begun[MOVING]) and not values["mass"]  # all has come to rest
    settling = 0 if again else None
    orbit = orbit_from(values, begun, start, settling)
    found = _answer(values, orbit, chosen, samples, motor, drive, chosen_levels, period)
    return replace(found, certificate=certificate_of(values, orbit)) if certify else found


def _samples(samples_per_period: object) -> int:
    """Parts of a drive period."""
    return int(one_number("samples_per_period", samples_per_period, "1", _COUNT))


def _answer(
    values: Mapping[str, float],
    orbit: CoupledOrbit,
    schedule: Schedule,
    samples: int,
    motor: Motor,
    drive: Drive,
    levels: Levels,
    period: float | None,
) -> DriveOrbit:
    """The orbit with the history of its cycles and what an encoder reads of it."""
    gates = np.tile(schedule.gates(drive), (orbit.cycles, 1))
    walked = history_of(values, orbit.state, gates, samples)
    spread, low, high = (None,) * 3 if period is None else read_by_encoder(walked.time, walked.angle, period)
    return DriveOrbit(schedule, orbit, walked, spread, low, high, Inputs(motor, drive, levels, period))


def drive_history(
    motor: Motor | None = None,
    drive: Drive | None = None,
    schedule: Schedule | None = None,
    *,
    cycles: float = 1,
    pause: float = 0,
    rotor_mass: float | str | None = None,
    samples_per_period: float = 8,
    tolerance: float = 1e-6,
    **levels: Unpack[LevelChoice],
) -> DriveHistory:
    """How a motor starts from rest under a drive, and how it stops when the drive is switched off (docs/coupling.md).

    Parameters
    ----------
    motor, drive, schedule, rotor_mass, tolerance
        As for :func:`drive_orbit`.
    cycles : whole number
        Of the schedule, from rest.
    pause : whole number
        Drive periods after them with both phases off; none where their terminals are open.
    samples_per_period : whole number
        Of each drive period in which anything moves.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`drive_orbit`.

    Returns
    -------
    DriveHistory

    Raises
    ------
    ParameterError
        As :func:`drive_orbit` does.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.drive_orbit import drive_history
    >>> drive = ts.Drive(frequency_difference=500, load_torque=0)
    >>> always = ts.Schedule(kind="continuous")
    >>> found = drive_history(drive=drive, schedule=always, cycles=100, pause=100, tolerance=1e-4)
    >>> bool(found.speed.max() > 40), float(found.speed[-1])
    (True, 0.0)
    """
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    chosen_levels = _coupled(levels)
    samples = _samples(samples_per_period)
    repeats = int(one_number("cycles", cycles, "1", _COUNT))
    still = int(one_number("pause", pause, "1", _PAUSE))
    chosen, values = _values(motor, drive, schedule, chosen_levels, rotor_mass, tolerance)
    if still and chosen.off_terminals == "open":
        raise ParameterError("pause", pause, "0 where off_terminals is open: charges would hold the wave aside at rest")
    gates = np.concatenate([np.tile(chosen.gates(drive), (repeats, 1)), np.zeros((still, 2))])
    values |= {"driven_A": 0.0, "driven_B": 0.0}  # nothing was before: no charge is held
    return history_of(values, start_of("rest", values), gates, samples)
