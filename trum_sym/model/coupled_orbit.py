"""Pulse drive with the rotor's reaction on both phases: what a drive cycle of the whole system comes back to.

The state is both phases, the rotor's height with its rate where the rotor has a mass, and the rim's speed.  A lap is a
drive cycle of it (``trum_coupled.h``); an orbit is a lap, or two or three, that end where they began, found by Newton
on laps with their slopes.  Nothing says that there is only one, or that laps come back at all: every result names the
start that led to it, whether it closes and after how many cycles, and the multipliers of a small disturbance.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.points import one_number
from trum_sym.inputs.schedule import Schedule
from trum_sym.model.coupling import coupled_values, held_wave
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.port import open_stiffness
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
    "random_start",
    "same_orbit",
    "start_of",
]

STATE = ("w_A", "v_A", "w_B", "v_B", "height", "climb", "v")
STARTS = ("rest", "steady")
"""Where laps begin: nothing moves, or both phases as without a rotor."""

_SETTLING = 2000  # drive periods before Newton, at most
_NEWTON = 8  # steps of it, at most
_NEAR = 0.1  # of a state's size, by which a lap may miss its start where Newton is tried while laps settle
_MOVED = 0.4  # of a state's size, by which Newton may move it then
_SPREAD = 1.5  # of a state's size, of random starts about the steady swing
_CYCLES = 3  # drive cycles of an orbit, at most
_APART = 1e-3  # of a state's size, between states that are not the same
_ROUGH = (3e-4, 1e-6)  # of a state's size, that a time step may be off while laps settle: at first, and if they do not
_COARSE = 3e-5  # for Newton at first
_FIRST = 1e-6  # at the first level of an orbit
_TIGHT = 1e-8  # of a state's size, by which a lap may miss its start however fine its steps: rounding
_LOOSE = 0.02  # of a state's size, by which a lap may miss its start where time steps are coarse
_ENOUGH = 300.0  # of what a time step may be off, by which Newton would move an orbit that is left as it is
_CLOSED = 3000.0  # of what a time step may be off, by which a lap may miss its start: its own error is about a hundred
_FINER = 32.0  # times at the next levels
_FINE = 1e-7  # where laps close if they ever do
_FINEST = 1e-13
ORDERS = (0.7, 1.0)  # of an error in what a step may be off: the least and the most that is believed
SAFETY = np.array([20.0, 20.0, 20.0, 20.0, 50.0, 30.0, 20.0])
"""Of the errors of ``NAMED``; time steps are not chosen by the contact's width.  studies/coupling.py tries it."""
SHARE = 0.1  # of the largest error of a speed, that each has at least
_STEP = 1e-2  # that a lap's time step may be off where no orbit is asked for, over the figures' tolerance
_TOLERANCE = Domain(low=1e-9, low_open=False, high=1e-2, high_open=False)
_MASS = Domain(low=0.0, low_open=False, high=10.0)
NAMED = ("mean_speed", "min_speed", "max_speed", "deviation", "contact_fraction", "highest_wave", "input_power")
MOVING = [STATE.index(name) for name in ("w_A", "v_A", "w_B", "v_B", "v")]
_SUMMED = ("mean", "low", "high", "variance", "touching", "highest", "input")

Complex = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]


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
    cycles : int
        Drive cycles after which it repeats itself; figures are of all of them.
    mean_speed, min_speed, max_speed, deviation : float, rad/s
        Of the rotor.
    contact_fraction : float
        Mean of theta/pi.
    highest_wave : float, m
    input_power : float, W
        Mean of what the modal forces put in.
    mean_speed_error, min_speed_error, max_speed_error, deviation_error : float, rad/s
    contact_fraction_error : float
    highest_wave_error : float, m
    input_power_error : float, W
        Estimates, from orbits of shorter and shorter time steps, times a factor of safety; no bounds.  NaN where no
        lap closes.
    missed : float
        By how much the last lap misses the first one's start, over the state's size; an orbit if it is small.
    multipliers : (k,) complex array
        Of small disturbances over all cycles; the orbit attracts if all are smaller than 1.  NaN if the last lap
        cannot be stepped.
    order : float
        With which power of what a time step may be off the figures' changes fell.
    closed : bool
        Whether the last lap ends where the first began, as nearly as time steps tell.
    tolerance_met : bool
        Whether the errors of mean and extremes are no larger than asked for.
    """

    start: str
    state: Array
    cycles: int
    mean_speed: float
    min_speed: float
    max_speed: float
    deviation: float
    contact_fraction: float
    highest_wave: float
    input_power: float
    mean_speed_error: float
    min_speed_error: float
    max_speed_error: float
    deviation_error: float
    contact_fraction_error: float
    highest_wave_error: float
    input_power_error: float
    missed: float
    multipliers: Complex
    order: float
    closed: bool
    tolerance_met: bool

    @property
    def stable(self) -> bool:
        """Whether a small disturbance dies out."""
        return bool(np.abs(self.multipliers).max() < 1)

    @property
    def converged(self) -> bool:
        """Whether it closes, attracts, and its errors meet the tolerance."""
        return self.closed and self.stable and self.tolerance_met


def lap_values(
    motor: Motor,
    drive: Drive,
    levels: Levels,
    schedule: Schedule | None = None,
    *,
    rotor_mass: float | str | None = None,
    tolerance: float = 1e-6,
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
    rotor_mass : float, kg, optional
        That goes up and down under the prepressure; the motor file's if not given, none where it states none.  A rotor
        without a mass follows the wave.
    tolerance : float
        Of an orbit's mean, lowest and highest speed, over the largest speed, or over a thousandth of the surface's
        where the rotor hardly turns; 1e-9 to 1e-2.
    reaction : bool
        Whether the contact acts on the phases; without, their amplitude is that of the modal force alone.

    Raises
    ------
    ParameterError
        As :func:`trum_sym.model.coupling.coupled_values` does, but for pulses; as
        :func:`trum_sym.model.port.open_stiffness` does where terminals are open.
    """
    if drive.start != "periodic":
        raise ParameterError("start", drive.start, "periodic where coupling is contact: cycles follow each other")
    if levels.tangential != "rigid":
        raise ParameterError(
            "coupling", "contact", f"none where tangential is {levels.tangential}, but for the plain wave"
        )
    loss = motor.layer_loss_factor
    if loss is not None and np.any(np.asarray(loss.value) != 0):
        raise ParameterError(
            "layer_loss_factor", loss.value, "0: characteristics alone knows a layer's loss, of the plain wave"
        )
    plain = Drive(**{**drive.numbers(), **drive.words(), "on_periods": drive.periods})  # type: ignore[arg-type]
    values = coupled_values(motor, plain, Levels(**{**vars(levels), "coupling": "contact"}))
    prescribed = _swing({**values, "omega_n0": values["omega_n"]})
    mass = values["m_r"] if rotor_mass is None else rotor_mass
    chosen = Schedule() if schedule is None else schedule
    return {
        **{name: float(value) for name, value in values.items()},
        **chosen.symbols(drive),
        "K_o": open_stiffness(values) if chosen.off_terminals == "open" else 0.0,
        "held": held_wave(values) if reaction else 0.0,
        "mass": one_number("rotor_mass", mass, "kg", _MASS),
        "reaction": float(reaction),
        "size": prescribed["swing"],
        "wanted": one_number("tolerance", tolerance, "1", _TOLERANCE),
        "tolerance": _STEP * one_number("tolerance", tolerance, "1", _TOLERANCE),
        "force_phase": float(np.asarray(drive.switching_phase)) + prescribed["lead"],
    }


def _swing(values: Mapping[str, ArrayLike]) -> dict[str, float]:
    """Steady swing of a phase under the modal force, without a rotor, and the angle by which the force is ahead."""
    return {name: float(np.asarray(value)) for name, value in call("trum_mode_swing", values).items()}


def laps(values: Mapping[str, float], states: Array) -> tuple[Array, dict[str, Array]]:
    """States (7, n) after a lap from states (7, n), and what each lap comes to.

    A time step may be off by ``values["tolerance"]`` of a state's size; what cannot be stepped is NaN.
    """
    found = call("coupled_lap", {**values, **dict(zip(STATE, states, strict=True))})
    return np.array([found[name] for name in STATE]), {name: np.asarray(value) for name, value in found.items()}


def _sizes(values: Mapping[str, float]) -> Array:
    """A size of each number of the state: of the wave that the modal force makes without a rotor."""
    height = values["size"]
    speed = height * values["omega_n0"]
    return np.array([height, speed, height, speed, height, speed, values["D"] * values["k_c"] * speed])


def start_of(name: str, values: Mapping[str, float]) -> Array:
    """A state (7,) by its name: ``rest``, or ``steady``, both phases in the swing that they have without a rotor."""
    per_height = float(np.asarray(call("trum_engagement", values)["engagement_per_height"]))
    state = np.zeros(len(STATE))
    state[4] = -1 / (np.pi * per_height)  # the layer carries the prepressure all round
    if name == "steady":
        free, turn = _swing(values), values["omega_q"]
        swing = free["swing"] * np.exp(1j * (values["force_phase"] - free["lead"]))
        of_A, of_B = values["force_A"] * swing, complex(values["force_B_along"], values["force_B_ahead"]) * swing
        state[:4] = of_A.real, (1j * turn * of_A).real, of_B.real, (1j * turn * of_B).real
        state[4] += float(np.hypot(state[0], state[2]))
    elif name != "rest":
        raise ParameterError("start", name, f"one of {', '.join(STARTS)}")
    return state


def random_start(values: Mapping[str, float], at: np.random.Generator) -> Array:
    """A state (7,) at random about ``steady``, normal with 1.5 of a state's size."""
    return np.asarray(start_of("steady", values) + _SPREAD * _sizes(values) * at.normal(size=len(STATE)))


@dataclass(frozen=True)
class Lap:
    """Laps one after another.

    Attributes
    ----------
    state, end : (7,) array
        Where they begin and end, in SI.
    figures : (7,) array
        As ``NAMED``, speeds in m/s.
    slopes : (k + 1, k) array
        Of the end's k free numbers, in their sizes, and of the mean speed, in m/s, by those of the start.
    gap : (k,) array
        By which the free numbers miss the start, in their sizes.
    """

    state: Array
    end: Array
    figures: Array
    slopes: Array
    gap: Array

    @property
    def missed(self) -> float:
        known = np.isfinite(self.gap).all() and np.isfinite(self.slopes).all()
        return float(np.abs(self.gap).max()) if known else np.inf

    @property
    def multipliers(self) -> Complex:
        square = self.slopes[:-1]
        if not np.isfinite(square).all():
            return np.full(len(square), np.nan + 0j)
        return np.asarray(np.linalg.eigvals(square), np.complex128)


class LapSystem:
    """Laps of one point, in sizes of its state."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = dict(values)
        self.sizes = _sizes(values)
        massive = values["mass"] > 0
        self.free = np.array([k for k in range(len(STATE)) if massive or STATE[k] not in ("height", "climb")])

    def after(self, state: Array, allowed: float) -> Array:
        """The state after a lap."""
        start = dict(zip(STATE, state, strict=True))
        found = call("coupled_lap", {**self.values, "tolerance": allowed, **start})
        return np.array([found[name] for name in STATE])

    def around(self, state: Array, cycles: int, allowed: float) -> Lap:
        """So many laps with their slopes."""
        of_state, of_mean = np.eye(self.free.size), np.zeros(self.free.size)
        rows, at = [], state
        for _ in range(cycles):
            start = dict(zip(STATE, at, strict=True))
            found = call("coupled_slopes", {**self.values, "tolerance": allowed, **start})
            slopes = np.asarray(found["slopes"])[:, self.free] * self.sizes[self.free]
            of_mean = of_mean + slopes[-1] @ of_state / cycles
            of_state = slopes[self.free] / self.sizes[self.free, np.newaxis] @ of_state
            rows.append([float(np.asarray(found[name])) for name in _SUMMED])
            at = np.array([found[name] for name in STATE])
        gap = ((at - state) / self.sizes)[self.free]
        held = np.setdiff1d(np.arange(len(STATE)), self.free)
        state = state.copy()
        state[held] = at[held]  # what follows from the others
        return Lap(state, at, _figures(np.array(rows)), np.vstack([of_state, of_mean]), gap)

    def orbit(self, state: Array, cycles: int, allowed: float) -> Lap:
        """The laps that come nearest to their start, by Newton from a state."""
        best = lap = self.around(state, cycles, allowed)
        for step in range(_NEWTON):
            change = self.newton(lap) if lap.missed < np.inf else np.zeros(0)
            most = float(np.abs(change).max(initial=0.0))
            if most < _ENOUGH * allowed or (step > 0 and self.closed(best, allowed)):
                break
            state = lap.state.copy()
            state[self.free] += self.sizes[self.free] * change / max(1.0, most)
            lap = self.around(state, cycles, allowed)
            best = lap if lap.missed < best.missed else best
        return best

    def first(self, state: Array, cycles: int) -> Lap:
        """Laps next to a state that close at the first level, by Newton with coarser steps and then with its own."""
        lap = self.orbit(state, cycles, _COARSE)
        return self.orbit(lap.state, cycles, _FIRST) if self.closed(lap, _COARSE) else lap

    def closed(self, lap: Lap, allowed: float) -> bool:
        """Whether laps end where they began, as nearly as time steps tell."""
        return lap.missed < min(max(_CLOSED * allowed, _TIGHT), _LOOSE)

    def attracts(self, lap: Lap, allowed: float) -> bool:
        """Whether laps close, as nearly as time steps tell, where Newton leaves them, and disturbances die out."""
        if not (self.closed(lap, allowed) and float(np.abs(lap.multipliers).max()) < 1):
            return False
        return float(np.abs(self.newton(lap)).max()) < _NEAR

    def newton(self, lap: Lap) -> Array:
        """By how much the start has to change for the laps to close, were their slopes to stay."""
        return np.asarray(np.linalg.lstsq(np.eye(self.free.size) - lap.slopes[:-1], lap.gap, rcond=None)[0], float)

    def missing(self, lap: Lap) -> Array:
        """Twice what figures miss because laps do not quite close: the mean by its slopes, the others by sizes."""
        change, (_, _, _, _, height, speed, rim) = self.newton(lap), self.sizes
        sizes = np.array([0.0, rim, rim, rim, 1.0, height, self.values["F_q"] * speed])
        sizes *= np.abs(change).max()
        sizes[0] = abs(float(lap.slopes[-1] @ change))
        return 2 * sizes

    def speed(self, figures: Array) -> float:
        """By which errors of speeds are measured: the rotor's largest, or a thousandth of the surface's."""
        return max(float(np.abs(figures[1:3]).max()), float(self.sizes[-1]) / 1000)

    def settled(self, state: Array, settling: int, allowed: float) -> tuple[list[Array], Lap | None]:
        """The states after each of some laps, and the orbit that attracts them if one is seen before they are over."""
        tried, states = 2 * _NEAR, [state]
        for _ in range(settling):
            states.append(self.after(states[-1], allowed))
            gap = self.distance(states[-1], states[-2])
            if gap < tried / 2:
                tried = gap
                lap = self.first(states[-1], 1)
                if self.attracts(lap, _FIRST) and self.distance(lap.state, states[-1]) < _MOVED:
                    return states, lap
            if not np.isfinite(gap):
                break
        return states, None

    def several(self, states: list[Array]) -> tuple[int, Lap] | None:
        """An attracting orbit over two or three cycles, and none of one, from where laps come back most nearly."""
        for cycles in range(2, _CYCLES + 1):
            pairs = list(zip(states, states[cycles:]))  # noqa: B905
            if not pairs:
                continue
            nearest = min(pairs, key=lambda pair: self.distance(*pair))[0]
            lap = self.first(nearest, cycles)
            if self.attracts(lap, _FIRST) and self.distance(self.after(lap.state, _FIRST), lap.state) > _NEAR:
                return cycles, lap
        return None

    def rests(self, state: Array) -> bool:
        """Whether friction holds wave and rotor at rest through a lap from a state."""
        if state[MOVING].any():
            return False
        found = call("coupled_lap", {**self.values, **dict(zip(STATE, state, strict=True))})
        return not any(float(np.asarray(found[name])) for name in ("highest", "low", "high"))

    def at_rest(self, name: str) -> CoupledOrbit:
        """The orbit of what rests: friction takes what disturbs it.

        A rotor that still goes up and down counts as at rest.
        """
        nothing = dict.fromkeys((*NAMED, *(f"{of}_error" for of in NAMED), "missed"), 0.0) | {"contact_fraction": 1.0}
        return CoupledOrbit(
            start=name,
            state=start_of("rest", self.values),
            cycles=1,
            **nothing,
            multipliers=np.zeros(self.free.size, np.complex128),
            order=np.nan,
            closed=True,
            tolerance_met=True,
        )

    def distance(self, one: Array, other: Array) -> float:
        """Between two states, by the number that differs most."""
        return float(np.abs(((one - other) / self.sizes)[self.free]).max())


def _figures(rows: Array) -> Array:
    """Of laps after one another, from what each comes to (n, 7)."""
    mean, low, high, variance, touching, highest, power = rows.T
    spread = np.mean(variance + (mean - mean.mean()) ** 2)
    ends = (mean.mean(), low.min(), high.max(), np.sqrt(max(0.0, float(spread))))
    return np.array([*ends, touching.mean(), highest.max(), power.mean()])


def figures_in_units(figures: Array, values: Mapping[str, float]) -> Array:
    """As a result has them, by ``NAMED``: speeds are the rotor's."""
    return np.asarray(figures * np.array([1 / values["r_c"]] * 4 + [1.0] * 3))


def orbit_from(values: Mapping[str, float], start: Array, name: str, settling: int | None = None) -> CoupledOrbit:
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
        Laps before Newton, at most, those of 2000 drive periods if not given, and as many again with finer time steps
        if they do not settle: it begins where laps hardly change and an orbit that attracts is near.
    """
    system = LapSystem(values)
    most = math.ceil(_SETTLING / values["m"]) if settling is None else settling
    states, lap = [np.array(start, float)], None
    for allowed in _ROUGH:
        if lap is None and system.rests(states[-1]):
            return system.at_rest(name)
        if lap is None:
            states, lap = system.settled(states[-1], most, allowed)
    if lap is None and system.rests(states[-1]):
        return system.at_rest(name)
    lap = lap or system.first(states[-1], 1)
    orbit = _refined(system, lap, 1, states[-1], name)
    if not (orbit.closed and orbit.stable):
        more = system.several(states)
        longer = _refined(system, more[1], more[0], states[-1], name) if more else orbit
        orbit = longer if longer.closed else orbit
    return orbit


def _refined(system: LapSystem, lap: Lap, cycles: int, settled: Array, name: str) -> CoupledOrbit:
    """An orbit at finer and finer time steps, until its errors are as small as wanted."""
    wanted, allowed = system.values["wanted"], _FIRST
    levels, errors, met, finer = _Levels(allowed, lap.figures), np.full(len(NAMED), np.nan), False, lap
    closed = False
    while allowed > _FINEST and not met:
        allowed = levels.next(allowed, wanted * system.speed(lap.figures))
        finer = system.orbit(lap.state, cycles, allowed)
        closed = system.closed(finer, allowed)
        if closed:
            lap = finer
            if levels.add(allowed, lap.figures):
                errors = levels.errors + system.missing(lap)
                met = bool(errors[:3].max() <= wanted * system.speed(lap.figures))
        elif allowed < _FINE:
            break
    missed, multipliers = finer.missed, finer.multipliers
    if not closed:
        errors = np.full(len(NAMED), np.nan)
        lap = system.around(settled, cycles, allowed)
    in_units = (figures_in_units(of, system.values) for of in (lap.figures, errors))
    figures, off = (dict(zip(NAMED, map(float, of), strict=True)) for of in in_units)
    return CoupledOrbit(
        start=name,
        state=lap.state,
        cycles=cycles,
        missed=missed,
        multipliers=multipliers,
        order=levels.order,
        closed=closed,
        tolerance_met=met,
        **figures,
        **{f"{figure}_error": error for figure, error in off.items()},
    )


class _Levels:
    """Figures of an orbit by what a time step may be off, and their errors by Richardson's extrapolation.

    A change from level to level is about the error of the coarser one.  The order is that with which changes of speeds
    fell from the first to the last, within bounds; an error is the larger of what the last change and the one before it
    make of it, times a factor of safety; and no speed's is less than a tenth of another's.
    """

    def __init__(self, allowed: float, figures: Array) -> None:
        self.allowed, self.figures, self.order, self.count = [allowed], figures, np.nan, 0
        self.first = self.last = np.zeros(len(figures))
        self.errors = np.full(len(figures), np.nan)

    def next(self, allowed: float, wanted: float) -> float:
        """What a step may be off at the level after one, for half the error of speeds that is wanted."""
        if self.count < 2 or allowed < self.allowed[-1]:
            return allowed / _FINER
        aim = wanted / 2 / max(float(self.errors[:3].max()), 1e-300)
        return allowed * float(np.clip(aim, 1 / _FINER, 1 / 4))

    def add(self, allowed: float, figures: Array) -> bool:
        """Take a level; whether there are errors, from the third on."""
        change, gain = np.abs(figures - self.figures), self.allowed[-1] / allowed
        if self.count == 0:
            self.first = change
        else:
            fell = float(self.first[:4].max()) / max(float(change[:4].max()), 1e-300)
            span = self.allowed[0] / self.allowed[-1]
            self.order = float(np.clip(np.log(max(fell, 1e-300)) / np.log(span), *ORDERS))
            before = self.last / ((self.allowed[-2] / self.allowed[-1]) ** self.order - 1) / gain**self.order
            self.errors = SAFETY * np.maximum(change / (gain**self.order - 1), before)
            self.errors[:4] = np.maximum(self.errors[:4], SHARE * self.errors[:4].max())
        self.allowed, self.figures, self.last, self.count = [*self.allowed, allowed], figures, change, self.count + 1
        return self.count > 1


def coupled_orbits(
    values: Mapping[str, float], starts: Iterable[str] = STARTS, draws: int = 0
) -> tuple[CoupledOrbit, ...]:
    """The different orbits that laps from some starts lead to, and what does not close.

    Parameters
    ----------
    values : mapping
        From :func:`lap_values`.
    starts : iterable of str
        Of :data:`STARTS`.
    draws : int
        Starts at random beside these, about ``steady``; the same ones each time.

    Returns
    -------
    tuple of CoupledOrbit
        One for each start, without those that are the same as one before.  An orbit over two or three cycles is
        found where laps come to none of one; others, and orbits over more, are missed.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.levels import Levels
    >>> values = lap_values(ts.load_motor(), ts.Drive(), Levels(), rotor_mass=0.02, tolerance=1e-3)
    >>> [(orbit.start, orbit.closed, orbit.cycles) for orbit in coupled_orbits(values, ("steady",))]
    [('steady', True, 1)]
    """
    found: list[CoupledOrbit] = []
    at = np.random.default_rng(0)
    begun = [(name, start_of(name, values)) for name in starts]
    begun += [(f"random {k}", random_start(values, at)) for k in range(draws)]
    for name, start in begun:
        orbit = orbit_from(values, start, name)
        if not any(same_orbit(values, one, orbit) for one in found):
            found.append(orbit)
    return tuple(found)


def same_orbit(values: Mapping[str, float], one: CoupledOrbit, other: CoupledOrbit) -> bool:
    """Whether two orbits are one, perhaps begun a cycle or two apart."""
    if not (one.closed and other.closed and one.cycles == other.cycles):
        return False
    system, state = LapSystem(values), other.state
    for _ in range(one.cycles):
        if system.distance(one.state, state) < _APART:
            return True
        state = system.after(state, _FINE)
    return False


def followed(points: Iterable[Mapping[str, float]], settling: int | None = None) -> list[CoupledOrbit]:
    """The orbit at each of some points, from that of the point before: a slow sweep, which stays on its branch.

    Parameters
    ----------
    points : iterable of mapping
        From :func:`lap_values`, in the order of the sweep; the first begins at ``steady``.
    settling : int
        Laps before Newton at each point, as for :func:`orbit_from`.
    """
    found: list[CoupledOrbit] = []
    for values in points:
        start, name = (found[-1].state, "followed") if found else (start_of("steady", values), "steady")
        found.append(orbit_from(values, start, name, settling))
    return found


def one_phase(
    motor: Motor, drive: Drive, levels: Levels, rotor_mass: float | None = None, tolerance: float = 1e-6
) -> CoupledOrbit:
    """Phase A alone, always on, under a rotor that does not turn: what an amplitude under prepressure is measured on.

    ``highest_wave`` is the amplitude.  The drive's load and pulses do not count; ``rotor_mass`` and ``tolerance`` are
    those of :func:`lap_values`.
    """
    alone = Drive(prepressure=drive.prepressure, frequency_difference=drive.frequency_difference, load_torque=0.0)
    values = lap_values(motor, alone, levels, Schedule(kind="single"), rotor_mass=rotor_mass, tolerance=tolerance)
    return orbit_from(values, start_of("steady", values), "steady")
