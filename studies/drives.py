"""Which drive is steadiest at low speeds: superimposed pulses, bursts, phase difference, ratio of voltages, voltage.

For mean speeds from 1 to 1000 arcsec/s, a contact with and without the rotor's flange, a rotor with and without the
bench's plate, with and without a load, the setting of each drive that gives the mean speed is found in the coupled
engine, and how steady the speed is there: by itself, and read by an encoder that averages over 2 ms (Sect. 8.2).
docs/coupling.md has what it prints.

    python -m studies.drives drives.jsonl docs/pictures/drives.png

The file keeps what is found, a line a drive and condition; a run takes up where it ends.  With a third argument, a
number, only so many lines are made.
"""

from __future__ import annotations

import itertools
import json
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.checks import Array
from trum_sym.inputs.schedule import Schedule
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.coupled_orbit import CoupledOrbit, lap_values, orbit_from, start_of
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.drive_orbit import drive_orbit, history_of, read_by_encoder
from trum_sym.model.levels import Levels
from trum_sym.output.progress import shown
from trum_sym.plots.style import COLOURS, INK, figure_of, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["DRIVES", "TARGETS", "Condition", "conditions", "main", "solved"]

TARGETS = tuple(float(x) for x in np.geomspace(1, 1000, 7))
"""Mean speeds, arcsec/s."""
_SHOWN = (TARGETS[0], TARGETS[2], TARGETS[4], TARGETS[6])
_LOAD = 0.05  # N m: a twenty-fourth of what friction can carry
_ENCODER = 2e-3  # s
_TOLERANCE, _SAMPLES = (
    1e-8,
    8,
)  # of an orbit, so that a mean of 1 arcsec/s is found; parts of a drive period for the encoder
_PERIODS = 20  # of Table 3's cycle
_NEAR = 1e-3  # of a target, by which a mean may miss it
_DRIFT = 1.01  # of the friction
_OFTEN = 5000  # drive periods between bursts that figures are first found for


@dataclass(frozen=True)
class Condition:
    """What a drive is set for."""

    contact: str
    inertia: float
    load: float

    @property
    def levels(self) -> Levels:
        """With coupling."""
        return Levels(compliance=self.contact, coupling="contact")  # type: ignore[arg-type]  # one of its words

    def drive(self, frequency: float) -> ts.Drive:
        """Table 3's but for load and frequency difference (Hz)."""
        return ts.Drive(load_torque=self.load, load_inertia=self.inertia, frequency_difference=frequency)


@dataclass(frozen=True)
class Rival:
    """A drive with one number to set.

    Attributes
    ----------
    name, unit : str
        Of the drive, and of its setting.
    at : callable
        Schedule and frequency difference (Hz) at a setting.
    settings : tuple of float
        Along which the orbit is followed until its mean speed is between two of them.
    """

    name: str
    unit: str
    at: Callable[[float], tuple[Schedule, float]]
    settings: tuple[float, ...]


def _pulses(on_periods: int) -> Rival:
    schedule = Schedule(periods=_PERIODS, on_periods=on_periods)
    falling = tuple(float(f) for f in np.arange(4000.0, 400.0, -200.0))
    return Rival(f"pulses, {on_periods} of {_PERIODS}", "Hz", lambda f: (schedule, f), falling)


_PLACE = 3000.0  # Hz, Table 3's frequency difference, of all but the pulses
_ANGLES = tuple(float(x) for x in np.radians([90, 60, 40, 25, 15, 10, 7, 5, 3, 2, 1, 0.5, 0, -1, -2, -4]))
_RATIOS = (1.0, 0.6, 0.4, 0.25, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01, 0.005, 0.0)
_FOLLOWED = (
    _pulses(14),
    _pulses(10),
    Rival("phase difference", "rad", lambda x: (Schedule(kind="continuous", phase_difference=x), _PLACE), _ANGLES),
    Rival("ratio of voltages", "1", lambda x: (Schedule(kind="continuous", ratio=max(0.0, x)), _PLACE), _RATIOS),
)
_BURSTS = {"bursts of 1": 1, "bursts of 20": 20}
_VOLTAGE = "voltage"
DRIVES = (*(rival.name for rival in _FOLLOWED[:2]), *_BURSTS, *(rival.name for rival in _FOLLOWED[2:]), _VOLTAGE)


def conditions(motor: ts.Motor) -> list[Condition]:
    """All of them: contact, without and with the bench's plate, without and with a load."""
    plate = float(motor.bench["load_inertia"].value)
    return [Condition(*of) for of in itertools.product(("layer", "flange"), (0.0, plate), (0.0, _LOAD))]


def _orbit(values: dict[str, float], state: Array, laps: int) -> CoupledOrbit:
    return orbit_from(values, state, "followed", laps)


def _figures(orbit: CoupledOrbit, time: Array, angle: Array) -> dict[str, float]:
    spread, low, high = read_by_encoder(time, angle, _ENCODER)
    return {
        "mean": orbit.mean_speed / ARCSEC,
        "deviation": orbit.deviation / ARCSEC,
        "width": (orbit.max_speed - orbit.min_speed) / ARCSEC,
        "encoder": spread / ARCSEC,
        "encoder_width": (high - low) / ARCSEC,
        "change": orbit.mean_speed_error / ARCSEC,
    }


def _along(rival: Rival, values_at: Callable[[float], dict[str, float]], highest: float) -> list[CoupledOrbit]:
    """Orbits at the rival's settings, until the mean speed was both above the highest wanted (rad/s) and below 0."""
    first = values_at(rival.settings[0])
    settle = _settling(first)
    found = [_orbit(first, start_of("steady", first), 10 * settle)]
    for setting in rival.settings[1:]:
        found.append(_orbit(values_at(setting), found[-1].state, settle))
        speeds = [orbit.mean_speed for orbit in found]
        if max(speeds) > highest and min(speeds) < 0:
            break
    return found


def _settling(values: dict[str, float]) -> int:
    return 12 if values["m"] > 1 else 60


def _between(
    values_at: Callable[[float], dict[str, float]], known: dict[float, CoupledOrbit], wanted: float
) -> tuple[float, dict[float, CoupledOrbit]]:
    """Between two settings with their orbits: the setting whose mean speed (rad/s) is wanted, and all orbits tried."""
    states = dict(known)

    def at(setting: float) -> CoupledOrbit:
        if setting not in states:
            near = states[min(states, key=lambda x: abs(x - setting))]
            states[setting] = _orbit(values_at(setting), near.state, 2)
        return states[setting]

    ends = tuple(known)
    slope = abs(known[ends[0]].mean_speed - known[ends[1]].mean_speed) / wanted / abs(ends[1] - ends[0])
    near = {"xtol": max(_NEAR / slope / 4, 1e-300), "rtol": 8.9e-16}
    setting = float(brentq(lambda x: at(x).mean_speed / wanted - 1, *ends, **near))
    at(setting)
    return setting, states


def _branch(
    rival: Rival, values_at: Callable[[float], dict[str, float]], targets: Sequence[float]
) -> dict[float, tuple[str, float, CoupledOrbit | None]]:
    """For each target on the branch along the rival's settings: a word, empty if it is reached, setting and orbit."""
    found = _along(rival, values_at, max(targets) * ARCSEC)
    speeds = np.array([orbit.mean_speed for orbit in found])
    answers: dict[float, tuple[str, float, CoupledOrbit | None]] = {}
    jumps: dict[int, tuple[str, float, CoupledOrbit | None]] = {}  # over all targets, by where
    for target in targets:
        wanted = target * ARCSEC
        across = np.flatnonzero((speeds[:-1] - wanted) * (speeds[1:] - wanted) < 0)
        if not across.size:
            answers[target] = f"never below {speeds.min() / ARCSEC:.2g}", math.nan, None
            continue
        k = int(across[0])
        if k in jumps:
            answers[target] = jumps[k]
            continue
        setting, states = _between(
            values_at, dict(zip(rival.settings[k : k + 2], found[k : k + 2], strict=True)), wanted
        )
        orbit = states[setting]
        if abs(orbit.mean_speed / wanted - 1) > 10 * _NEAR:
            answers[target] = "jumps", setting, None
            near = [abs(state.mean_speed) for state in states.values()]
            if min(near) > 2 * max(targets) * ARCSEC:
                jumps[k] = answers[target]
        elif not orbit.closed or not orbit.stable:
            answers[target] = "unstable" if orbit.closed else "does not close", setting, None
        else:
            answers[target] = "", setting, orbit
    return answers


def _followed(motor: ts.Motor, condition: Condition, rival: Rival, targets: Sequence[float]) -> list[dict[str, Any]]:
    """The figures at each target, on the branch from the rival's first setting or, failing that, from its last."""

    def values_at(setting: float, machine: ts.Motor = motor) -> dict[str, float]:
        schedule, frequency = rival.at(setting)
        drive = condition.drive(frequency)
        return lap_values(machine, drive, condition.levels, schedule, rotor_mass=0.0, tolerance=_TOLERANCE)

    answers = _branch(rival, values_at, targets)
    lacking = [target for target in targets if answers[target][0]]
    if lacking:
        other = _branch(replace(rival, settings=rival.settings[::-1]), values_at, lacking)
        answers |= {target: answer for target, answer in other.items() if not answer[0]}
    records: list[dict[str, Any]] = []
    for target, (why, setting, orbit) in answers.items():
        if orbit is None:
            records.append({"target": target, "reached": False, "why": why})
            continue
        values = values_at(setting)
        gates = np.tile(rival.at(setting)[0].gates(condition.drive(0.0)), (orbit.cycles, 1))
        walked = history_of(values, orbit.state, gates, _SAMPLES)
        more = _orbit(values_at(setting, _more_friction(motor)), orbit.state, _settling(values))
        figures = _figures(orbit, walked.time, walked.angle)
        drift = (more.mean_speed - orbit.mean_speed) / ARCSEC
        records.append({"target": target, "reached": True, "setting": setting, **figures, "drift": drift})
    return records


def _more_friction(motor: ts.Motor) -> ts.Motor:
    return motor.with_values({"friction_coefficient": _DRIFT * float(motor.friction_coefficient.value)})


def _bursts(motor: ts.Motor, condition: Condition, on: int, targets: Sequence[float]) -> list[dict[str, Any]]:
    """Bursts so many drive periods apart that the mean speed is the target's.

    Between two of them everything comes to rest, so one is like the other however far apart they are: figures over a
    longer pause follow from those over a shorter one.
    """
    drive, schedule = condition.drive(_PLACE), Schedule(kind="burst", periods=_OFTEN, on_periods=on)

    def of(machine: ts.Motor) -> ts.DriveOrbit:
        words = {"compliance": condition.contact, "tolerance": _TOLERANCE, "samples_per_period": _SAMPLES}
        return drive_orbit(machine, drive, schedule, rotor_mass=0.0, **words)  # type: ignore[arg-type]

    found = of(motor)
    time, angle, orbit = found.history.time, found.history.angle, found.orbit
    step, more = float(angle[-1]), float(of(_more_friction(motor)).history.angle[-1])
    period = float(time[-1]) / _OFTEN
    still = float(time[np.flatnonzero(found.history.wave > 0)[-1] + 1])
    if not orbit.closed or found.history.speed[-1]:
        return [{"target": target, "reached": False, "why": "does not come to rest"} for target in targets]
    records: list[dict[str, Any]] = []
    for target in targets:
        periods = round(step / (target * ARCSEC) / period)
        if periods * period <= still:
            why = "no step forward" if step <= 0 else "overlap"
            records.append({"target": target, "reached": False, "why": why})
            continue
        share, mean = _OFTEN / periods, step / (periods * period)
        square = share * (orbit.deviation**2 + orbit.mean_speed**2)
        longer = replace(
            orbit,
            mean_speed=mean,
            deviation=math.sqrt(square - mean**2),
            mean_speed_error=share * orbit.mean_speed_error,
        )
        figures = _figures(longer, np.append(time[:-1], periods * period), angle)
        drift = (more / step - 1) * target
        records.append({"target": target, "reached": True, "setting": periods, **figures, "drift": drift})
    return records


def _voltage(motor: ts.Motor, condition: Condition, targets: Sequence[float]) -> list[dict[str, Any]]:
    """The plain wave as the voltage rises from none: the stable state of the lowest wave, exact, without ripple."""

    def speed(voltage: float, machine: ts.Motor = motor) -> float:
        drive = condition.drive(_PLACE)
        values = coupled_values(machine, replace(drive, on_periods=drive.periods), condition.levels)
        waves = plain_waves({**values, "F_q": float(values["F_q"]) * voltage})
        moving = np.flatnonzero(waves.stable)
        return float(waves.speed[moving[0]]) if moving.size else math.nan

    voltages = np.geomspace(0.05, 1.0, 40)
    speeds = np.array([speed(float(u)) for u in voltages])
    records = []
    for target in targets:
        wanted = target * ARCSEC
        across = np.flatnonzero((speeds[:-1] < wanted) & (speeds[1:] >= wanted))
        if not across.size:
            records.append({"target": target, "reached": False, "why": "no state"})
            continue
        k = int(across[0])
        ends = float(voltages[k]), float(voltages[k + 1])
        setting = float(brentq(lambda u: speed(u) - wanted, *ends, xtol=1e-15, rtol=8.9e-16))  # noqa: B023
        mean = speed(setting)
        if abs(mean / wanted - 1) > 10 * _NEAR:
            records.append({"target": target, "reached": False, "why": "jumps", "setting": setting})
            continue
        zero = dict.fromkeys(("deviation", "width", "encoder", "encoder_width", "change"), 0.0)
        drift = (speed(setting, _more_friction(motor)) - mean) / ARCSEC
        records.append(
            {"target": target, "reached": True, "setting": setting, "mean": mean / ARCSEC, **zero, "drift": drift}
        )
    return records


def solved(
    motor: ts.Motor, condition: Condition, name: str, targets: Sequence[float] = TARGETS
) -> list[dict[str, Any]]:
    """A record a target (arcsec/s): setting and figures, or why none was found.

    Parameters
    ----------
    motor : Motor
    condition : Condition
    name : str
        Of :data:`DRIVES`.
    targets : sequence of float, arcsec/s
    """
    if name in _BURSTS:
        return _bursts(motor, condition, _BURSTS[name], targets)
    if name == _VOLTAGE:
        return _voltage(motor, condition, targets)
    rival = next(rival for rival in _FOLLOWED if rival.name == name)
    return _followed(motor, condition, rival, targets)


def _read(file: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []


def _key(condition: Condition, name: str) -> list[Any]:
    return [condition.contact, condition.inertia, condition.load, name]


def _shown(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 1e5 else f"{value:.1e}"


def rows(records: Iterable[dict[str, Any]]) -> list[tuple[str, ...]]:
    """A row a record: deviations of the speed and of the encoder's readings, drift, and why there is none."""
    found = []
    for record in records:
        of = {round(answer["target"]): answer for answer in record["found"]}
        shown_at = [("deviation", _SHOWN), ("encoder", _SHOWN), ("drift", _SHOWN[2:3])]
        cells = [
            _shown(of[round(target)][name]) if of[round(target)]["reached"] else "-"
            for name, targets in shown_at
            for target in targets
        ]
        lacking = next((answer["why"] for answer in record["found"] if not answer["reached"]), "")
        place = f"{record['contact']} {'plate' if record['inertia'] else 'alone'} {record['load']:g}"
        found.append((place, record["drive"], *cells, lacking))
    return found


def table(records: Iterable[dict[str, Any]]) -> str:
    """Deviations in arcsec/s at some mean speeds; what more friction does to the mean at 100 arcsec/s."""
    head = ["contact, rotor,\nload in N m", "drive"]
    for name in ("speed", "2 ms"):
        head += [f"{name}\n{target:g}" for target in _SHOWN]
    return tabulate(rows(records), (*head, "drift\n100", "where not"), disable_numparse=True)


@styled
def picture(records: Iterable[dict[str, Any]]) -> Figure:
    """Deviation of the speed, and of what the encoder reads, against the mean speed, under the load."""
    axes = panels(None, 2, 2, 5.6, sharex=True, sharey="row")
    loaded = [record for record in records if record["load"]]
    inertias = sorted({record["inertia"] for record in loaded})
    for record in loaded:
        speeds = [answer["target"] for answer in record["found"] if answer["reached"]]
        column, colour = inertias.index(record["inertia"]), COLOURS[DRIVES.index(record["drive"]) % len(COLOURS)]
        for row, name in enumerate(("deviation", "encoder")):
            values = [answer[name] for answer in record["found"] if answer["reached"]]
            if any(values):  # a plain wave has none
                line = "-" if record["contact"] == "layer" else "--"
                label = f"{record['drive']} ({record['contact']})"
                axes[2 * row + column].loglog(speeds, values, line, marker=".", color=colour, label=label)
    for k, ax in enumerate(axes):
        ax.loglog(TARGETS, TARGETS, ":", color=INK, linewidth=0.8, label="as large as the mean")
        ax.set_title("rotor alone" if k % 2 == 0 else "with the bench's plate")
        if k > 1:
            ax.set_xlabel("mean speed (arcsec/s)")
    axes[0].set_ylabel("deviation of the speed (arcsec/s)")
    axes[2].set_ylabel("of readings over 2 ms (arcsec/s)")
    figure = figure_of(axes[0])
    named = {label: line for ax in axes for line, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(named.values(), named.keys(), loc="outside upper left", ncols=3)
    return figure


def main(arguments: list[str]) -> int:
    """Find what the file lacks, print the table, draw the picture."""
    if not arguments:
        print("python -m studies.drives FILE.jsonl [PICTURE.png [LINES]]", file=sys.stderr)
        return 2
    file, motor = Path(arguments[0]), ts.load_motor()
    done = [[record[name] for name in ("contact", "inertia", "load", "drive")] for record in _read(file)]
    missing = [pair for pair in itertools.product(conditions(motor), DRIVES) if _key(*pair) not in done]
    for condition, name in shown(missing[: int(arguments[2])] if len(arguments) > 2 else missing, "drives"):
        found = solved(motor, condition, name)
        with file.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps({**vars(condition), "drive": name, "found": found}) + "\n")
    order = {json.dumps(_key(*pair)): k for k, pair in enumerate(itertools.product(conditions(motor), DRIVES))}
    records = sorted(_read(file), key=lambda r: order[json.dumps([r["contact"], r["inertia"], r["load"], r["drive"]])])
    print(table(records))
    if len(arguments) > 1:
        picture(records).savefig(arguments[1], dpi=120, facecolor="white", metadata={"Software": None})
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
