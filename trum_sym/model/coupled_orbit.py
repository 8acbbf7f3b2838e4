"""Pulse drive with the rotor's reaction on both phases: what a drive cycle of the whole system comes back to.

The state is both phases, the rotor's height with its rate where the rotor has a mass, and the rim's speed.  A lap is a
drive cycle of it (``trum_coupled.h``); an orbit is a lap that ends where it began, found by Newton on the lap with
differences of laps beside it.  Nothing says that there is only one, or that a lap comes back after one cycle at all:
every result names the start that led to it, whether it closes, and the multipliers of a small disturbance over a lap.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.points import one_number
from trum_sym.inputs.schedule import Schedule
from trum_sym.model.coupling import coupled_values, held_wave
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.values import Value

__all__ = [
    "STARTS",
    "CoupledOrbit",
    "coupled_orbits",
    "followed",
    "lap_values",
    "laps",
    "one_phase",
    "orbit_from",
    "start_of",
]

STATE = ("w_A", "v_A", "w_B", "v_B", "height", "climb", "v")
STARTS = ("rest", "steady")
"""Where laps begin: nothing moves, or both phases as without a rotor."""

_SETTLING = 30  # laps before Newton
_NEWTON = 12  # steps of it, at most
_CLOSED = 1e-9  # of a state's size, by which a lap may miss its start
_DIFFERENCE = 1e-5  # of a state's size, to either side
_STEPS = Domain(low=20, low_open=False, high=10_000, integer=True)
_MASS = Domain(low=0.0, low_open=False, high=10.0)


@dataclass(frozen=True, eq=False)
class CoupledOrbit(Value):
    """What laps from one start come to; SI.

    Attributes
    ----------
    start : str
        Where the laps began.
    state : (7,) array
        Displacement and velocity of A and of B, the rotor's height and its rate, speed of the rim, at the cycle's
        start; where no lap closes, that of the last one before Newton's.
    mean_speed, min_speed, max_speed, deviation : float, rad/s
        Of the rotor over the cycle; the extremes at the ends of time steps.
    mean_speed_change : float, rad/s
        Of the mean from half as many time steps: an estimate of its error, no bound.
    contact_fraction : float
        Mean of theta/pi.
    highest_wave : float, m
    input_power : float, W
        Mean of what the modal forces put in.
    missed : float
        By how much the lap misses its start, over the state's size; an orbit if it is small.
    multipliers : (k,) complex array
        Of small disturbances over a lap; the orbit attracts if all are smaller than 1.
    """

    start: str
    state: Array
    mean_speed: float
    min_speed: float
    max_speed: float
    deviation: float
    mean_speed_change: float
    contact_fraction: float
    highest_wave: float
    input_power: float
    missed: float
    multipliers: np.ndarray[tuple[int, ...], np.dtype[np.complex128]]

    @property
    def closed(self) -> bool:
        """Whether a lap ends where it began."""
        return bool(self.missed < _CLOSED)

    @property
    def stable(self) -> bool:
        """Whether a small disturbance dies out."""
        return bool(np.abs(self.multipliers).max() < 1)


def lap_values(
    motor: Motor,
    drive: Drive,
    levels: Levels,
    schedule: Schedule | None = None,
    *,
    rotor_mass: float = 0.0,
    steps: float = 400,
    coverage: float = 1.0,
    reaction: bool = True,
) -> dict[str, float]:
    """What a lap depends on, by symbol, in SI.

    The modal force is that of :func:`trum_sym.model.coupling.coupled_values`.  Phase A's is ahead of the switching by
    the angle that it would be ahead of A's steady swing if the rotor did nothing, as with a prescribed wave.

    Parameters
    ----------
    motor, drive, levels
        Of one point; ``levels.coupling`` is taken as ``contact``.
    schedule : Schedule
        The drive's superimposed pulses if not given.
    rotor_mass : float, kg
        That goes up and down under the prepressure; without one the rotor follows the wave.
    steps : int
        Time steps in a drive period.
    coverage : float
        As for :func:`trum_sym.model.coupling.coupled_values`.
    reaction : bool
        Whether the contact acts on the phases; without, their amplitude is that of the modal force alone.

    Raises
    ------
    ParameterError
        As :func:`trum_sym.model.coupling.coupled_values` does, but for pulses.
    """
    if drive.start != "periodic":
        raise ParameterError("start", drive.start, "periodic where coupling is contact: cycles follow each other")
    plain = Drive(**{**drive.numbers(), **drive.words(), "on_periods": drive.periods})  # type: ignore[arg-type]
    values = coupled_values(motor, plain, Levels(**{**vars(levels), "coupling": "contact"}), coverage=coverage)
    own, turn, xi = (float(values[name]) for name in ("omega_n", "omega_q", "xi"))
    lead = float(np.angle(complex(own**2 - turn**2, 2 * xi * own * turn)))
    return {
        **{name: float(value) for name, value in values.items()},
        **(Schedule() if schedule is None else schedule).symbols(drive),
        "held": held_wave(values) if reaction else 0.0,
        "mass": one_number("rotor_mass", rotor_mass, "kg", _MASS),
        "reaction": float(reaction),
        "steps": one_number("steps", steps, "1", _STEPS),
        "force_phase": float(np.asarray(drive.switching_phase)) + lead,
    }


def laps(values: Mapping[str, float], states: Array) -> tuple[Array, dict[str, Array]]:
    """States (7, n) after a lap from states (7, n), and what each lap comes to."""
    found = call("coupled_lap", {**values, **dict(zip(STATE, states, strict=True))})
    return np.array([found[name] for name in STATE]), {name: np.asarray(value) for name, value in found.items()}


def _sizes(values: Mapping[str, float]) -> Array:
    """A size of each number of the state: of the wave that the modal force makes at resonance."""
    own = values["omega_n0"]
    height = values["F_q"] / (2 * values["xi"] * values["M_q"] * own**2)
    speed = height * own
    return np.array([height, speed, height, speed, height, speed, values["D"] * values["k_c"] * speed])


def start_of(name: str, values: Mapping[str, float]) -> Array:
    """A state (7,) by its name: ``rest``, or ``steady``, both phases in the swing that they have without a rotor."""
    per_height = float(np.asarray(call("trum_engagement", values)["engagement_per_height"]))
    state = np.zeros(len(STATE))
    state[4] = -1 / (np.pi * per_height)  # the layer carries the prepressure all round
    if name == "steady":
        own, turn = values["omega_n0"], values["omega_q"]
        force = values["F_q"] * np.exp(1j * values["force_phase"])
        swing = force / values["M_q"] / complex(own**2 - turn**2, 2 * values["xi"] * own * turn)
        of_A, of_B = values["force_A"] * swing, complex(values["force_B_along"], values["force_B_ahead"]) * swing
        state[:4] = of_A.real, (1j * turn * of_A).real, of_B.real, (1j * turn * of_B).real
        state[4] += float(np.hypot(state[0], state[2]))
    elif name != "rest":
        raise ParameterError("start", name, f"one of {', '.join(STARTS)}")
    return state


def orbit_from(values: Mapping[str, float], start: Array, name: str, settling: int = _SETTLING) -> CoupledOrbit:
    """The orbit that laps from a state lead to.

    Parameters
    ----------
    values : mapping
        From :func:`lap_values`.
    start : (7,) array
        As ``CoupledOrbit.state``.
    name : str
        What the result says of it.
    settling : int
        Laps before Newton.
    """
    sizes = _sizes(values)
    free = np.array([k for k in range(len(STATE)) if values["mass"] > 0 or STATE[k] not in ("height", "climb")])
    state = np.array(start, float)
    for _ in range(settling):
        state = laps(values, state[:, np.newaxis])[0][:, 0]
    settled, best, missed, slopes = state, state, np.inf, np.eye(free.size)
    for _ in range(_NEWTON):
        aside = _DIFFERENCE * np.eye(len(STATE))[:, free] * sizes[:, np.newaxis]
        states = state[:, np.newaxis] + np.concatenate([np.zeros((len(STATE), 1)), aside, -aside], axis=1)
        ends = laps(values, states)[0]
        gap = (ends[:, 0] - state)[free] / sizes[free]
        if not np.isfinite(gap).all():
            break
        found = (ends[free, 1 : 1 + free.size] - ends[free, 1 + free.size :]) / (2 * _DIFFERENCE)
        if np.abs(gap).max() < missed:
            best, missed, slopes = state, float(np.abs(gap).max()), found / sizes[free, np.newaxis]
        if missed < _CLOSED / 100:
            break
        change = np.linalg.lstsq(np.eye(free.size) - found / sizes[free, np.newaxis], gap, rcond=None)[0]
        state = state.copy()
        state[free] += sizes[free] * change / max(1.0, float(np.abs(change).max()))
    return _orbit(values, best if missed < _CLOSED else settled, name, missed, np.linalg.eigvals(slopes))


def _orbit(values: Mapping[str, float], state: Array, name: str, missed: float, multipliers: Any) -> CoupledOrbit:  # noqa: ANN401
    """The figures of the lap from a state."""
    lap = {key: float(value[0]) for key, value in laps(values, state[:, np.newaxis])[1].items()}
    coarse = laps({**values, "steps": float(int(values["steps"]) // 2)}, state[:, np.newaxis])[1]
    radius = values["r_c"]
    return CoupledOrbit(
        start=name,
        state=state,
        mean_speed=lap["mean"] / radius,
        min_speed=lap["low"] / radius,
        max_speed=lap["high"] / radius,
        deviation=float(np.sqrt(max(0.0, lap["square"] - lap["mean"] ** 2))) / radius,
        mean_speed_change=(lap["mean"] - float(coarse["mean"][0])) / radius,
        contact_fraction=lap["touching"],
        highest_wave=lap["highest"],
        input_power=lap["input"],
        missed=missed,
        multipliers=np.asarray(multipliers, np.complex128),
    )


def coupled_orbits(values: Mapping[str, float], starts: Iterable[str] = STARTS) -> tuple[CoupledOrbit, ...]:
    """The different orbits that laps from some starts lead to, and what does not close.

    Parameters
    ----------
    values : mapping
        From :func:`lap_values`.
    starts : iterable of str
        Of :data:`STARTS`.

    Returns
    -------
    tuple of CoupledOrbit
        One for each start, without those that are the same as one before.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.levels import Levels
    >>> values = lap_values(ts.load_motor(), ts.Drive(), Levels(), rotor_mass=0.02, steps=60)
    >>> [(orbit.start, orbit.closed) for orbit in coupled_orbits(values, ("rest",))]
    [('rest', True)]
    """
    found: list[CoupledOrbit] = []
    sizes = _sizes(values)
    for name in starts:
        orbit = orbit_from(values, start_of(name, values), name)
        alike = [o for o in found if o.closed and orbit.closed and np.abs((o.state - orbit.state) / sizes).max() < 1e-4]
        if not alike:
            found.append(orbit)
    return tuple(found)


def followed(points: Iterable[Mapping[str, float]], settling: int = _SETTLING) -> list[CoupledOrbit]:
    """The orbit at each of some points, from that of the point before: a slow sweep, which stays on its branch.

    Parameters
    ----------
    points : iterable of mapping
        From :func:`lap_values`, in the order of the sweep; the first begins at ``steady``.
    settling : int
        Laps before Newton at each point.
    """
    found: list[CoupledOrbit] = []
    for values in points:
        start, name = (found[-1].state, "followed") if found else (start_of("steady", values), "steady")
        found.append(orbit_from(values, start, name, settling))
    return found


def one_phase(motor: Motor, drive: Drive, levels: Levels, rotor_mass: float, steps: float = 400) -> CoupledOrbit:
    """Phase A alone, always on, under a rotor that does not turn: what an amplitude under prepressure is measured on.

    ``highest_wave`` is the amplitude.  The drive's load and pulses do not count.
    """
    alone = Drive(prepressure=drive.prepressure, frequency_difference=drive.frequency_difference, load_torque=0.0)
    values = lap_values(motor, alone, levels, Schedule(kind="single"), rotor_mass=rotor_mass, steps=steps)
    return orbit_from(values, start_of("steady", values), "steady", settling=300)
