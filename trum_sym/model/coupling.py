"""The plain wave with the rotor's reaction on it: both phases and the contact as one system (level ``coupling``).

Both phases are alike and always on, so the wave, the contact and the rotor are at rest seen from the crest, and what
has to balance is one number, the height of the wave (derivations/coupling.py).  It may have several solutions; all are
found.  The rotor follows the wave up and down without a mass, which a plain wave never asks of it.

The layer is rigid along the circumference and loses nothing, unless the values have a loss factor ``eta_m`` above 0, or
a ``grip`` (:mod:`trum_sym.model.layer`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import check_point, check_single, numbers_of
from trum_sym.model.kernels import call
from trum_sym.model.layer import lossy_contact, lossy_reaction, sheared_reaction
from trum_sym.model.levels import Levels
from trum_sym.model.roots import rising
from trum_sym.model.stator import solve_stator

__all__ = ["PlainWaves", "check_coupling", "coupled_values", "held_wave", "plain_waves", "standing", "wave_at"]

Values = Mapping[str, ArrayLike]
Rotor = Literal["loaded", "held"]
CArray: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]

_TURN = 2 * np.pi
_LAST = 4e-16  # of an angle, over the contact's
_FIRST = 64  # brackets to begin with, and places in one that has a root
_PARTS = 8  # of a bracket that may have a root
_NARROW = 1e-7  # of a bracket, over the wave's height: roots nearer to each other count as one, at a fold
_LEAST = 1e-12  # of a wave's height, over the largest that could be
_ROUNDS = 5  # of a root's bracket, by _FIRST each, to the last bit
_STEEPEST = 1.5  # above sqrt(1 + eta^2) of any loss factor
_STEP = 1e-6  # of the differences that stability is judged by


@dataclass(frozen=True)
class PlainWaves:
    """All steady states of a plain wave under one load, by rising amplitude; every field an array over them, SI.

    Attributes
    ----------
    amplitude : (k,) array, m
        Height of the wave; 0 where friction holds the stator's surface.
    lead : (k,) array, rad
        By which the modal force is ahead of the wave, pi/2 at resonance.
    half_angle : (k,) array, rad
        Of the contact; pi where the whole wave touches.
    driving_angle : (k,) array, rad
        Half of the part of the contact whose surface is faster than the rotor.
    speed : (k,) array, rad/s
        Of the rotor; positive for a phase lead of 1.
    friction : (k,) array
        Friction's fraction of mu F_c, in the sense in which the wave drives.
    resonance : (k,) array, rad/s
        At which a wave of this height swings by itself.
    input_power, stator_power, contact_power, layer_power, slip_power, output_power : (k,) array, W
        Of both phases' modal forces; lost in the stator; given to the contact; lost in the layer, by slip; on the
        rotor.
    stable : (k,) array of bool
        Whether a small disturbance of wave and rotor dies out.
    whole, stuck : (k,) array of bool
        Whether the whole wave touches; whether all of a layer that is sheared sticks, so that the rotor stands.
    residual : (k,) array
        What is left of the balance of powers, over the input power.
    """

    amplitude: Array
    lead: Array
    half_angle: Array
    driving_angle: Array
    speed: Array
    friction: Array
    resonance: Array
    input_power: Array
    stator_power: Array
    contact_power: Array
    layer_power: Array
    slip_power: Array
    output_power: Array
    stable: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    whole: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    stuck: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    residual: Array

    @property
    def names(self) -> tuple[str, ...]:
        """A word for each state: ``still``, ``whole`` (all of the wave touches), ``unstable``, and ``low`` or ``high``.

        ``stuck`` is one of a sheared layer that sticks all round, under a rotor that stands; ``high`` is the stable
        state of the highest wave; a stable one below it is ``low``.
        """
        best = int(np.flatnonzero(self.stable)[-1]) if self.stable.any() else -1
        found = []
        for k, size in enumerate(self.amplitude):
            word = "still" if size == 0 else "unstable" if not self.stable[k] else "high" if k == best else "low"
            settled = word in ("high", "low")
            found.append("stuck" if settled and self.stuck[k] else "whole" if settled and self.whole[k] else word)
        return tuple(found)

    @property
    def highest(self) -> int:
        """Index of the stable state of the highest wave, -1 if none is stable."""
        return int(np.flatnonzero(self.stable)[-1]) if self.stable.any() else -1


def check_coupling(motor: Motor, drive: Drive, levels: Levels) -> None:
    """Raise a ParameterError for what the level ``coupling = "contact"`` does not know.

    It knows the plain wave over a Winkler layer that loses energy or is sheared, not both: no pulses, no Hertz width;
    and an amplitude that the motor file states under prepressure would contradict it.
    """
    if np.any(np.asarray(drive.on_periods) != drive.periods):
        raise ParameterError("coupling", "contact", "none in pulse drive, or on_periods = periods, the plain wave")
    if drive.start == "rest":
        raise ParameterError("coupling", "contact", "none where start is rest: a wave that grows is no plain one")
    loss = None if motor.layer_loss_factor is None else motor.layer_loss_factor.value
    if levels.tangential != "rigid" and loss is not None and np.any(np.asarray(loss) != 0):
        raise ParameterError(
            "layer_loss_factor", loss, f"0 where coupling is contact and tangential is {levels.tangential}"
        )
    if levels.contact != "winkler":
        raise ParameterError("coupling", "contact", f"none where contact is {levels.contact}")
    if motor.amplitude is not None:
        raise ParameterError("coupling", "contact", "none where the motor's amplitude under prepressure is given")
    for name in ("friction_coefficient", "damping_ratio"):
        if np.any(np.asarray(getattr(motor, name).value) == 0):
            raise ParameterError(name, 0, "a number > 0 where coupling is contact")


def coupled_values(
    motor: Motor, drive: Drive, levels: Levels, *, coverage: float | None = None, rotor_mass: float | None = None
) -> dict[str, ArrayLike]:
    """What the coupled plain wave depends on, by symbol, in SI.

    The drive frequency is that of ``coupling = "none"``: the resonance under prepressure at eq. 8's amplitude, and the
    frequency difference on top.  The stator without a rotor resonates at ``omega_n0``; where the motor file has
    measured the resonance under prepressure, the contact's share is taken off it.

    Parameters
    ----------
    motor, drive, levels
        Of one point: no arrays.
    coverage : float, optional
        Share of the circumference that the electrodes of a phase drive, in place of the motor's ``phase_coverage``;
        counts where ``amplitude`` is ``forced``, and in the capacitance.
    rotor_mass : float, kg, optional
        In place of the motor's, as ``m_r``; no plain wave depends on it.

    Raises
    ------
    ParameterError
        As :func:`check_coupling` does, and for arrays.
    """
    check_point(motor, drive)
    check_single(numbers_of(motor, drive), "one number: a coupled wave is of one motor and drive")
    check_coupling(motor, drive, levels)
    replaced = {"phase_coverage": coverage, "rotor_mass": rotor_mass}
    with unquestioned():  # whoever asks for another value knows the stated range
        motor = motor.with_values({name: value for name, value in replaced.items() if value is not None})
    pressed = solve_stator(motor, drive, replace(levels, amplitude="measured", coupling="none"), warn=False)
    values = {**motor.symbols(), **pressed.values, **drive.symbols()}
    modes = call("trum_resonance", {**values, "k_f": 0.0, "k_dx": 0.0})
    values = {"c_p": 1.0, "m_r": 0.0, **values, "beta": modes["beta"], "omega_n0": modes[levels.resonance]}
    if levels.tangential == "brush":
        sheared = {**call("trum_tangential_stiffness", values), **values}
        values["grip"] = call("trum_brush_coefficient", sheared)["grip"]
    if motor.resonance_frequency is not None:
        found = _reaction(values, np.array([float(np.asarray(values["W"]))]), "held")
        lifts = {name: float(found[name][0]) if name in found else 0.0 for name in ("central", "across")}
        with np.errstate(invalid="ignore"):
            values |= call("trum_without_contact", {**values, **call("trum_modal", values), **lifts})
        if not np.asarray(values["omega_n0"]) > 0:
            raise ParameterError(
                "resonance_frequency", motor.resonance_frequency.value, "more than the contact adds to it"
            )
    modal = call("trum_modal", values)
    values["M_q"] = modal["M_q"]
    values["F_q"] = modal["F_measured" if levels.amplitude == "measured" else "F_ceramic"]
    values["s"] = drive.phase_lead
    values["J_total"] = call("trum_total_inertia", values)["J_total"]
    return {name: float(np.asarray(value)) for name, value in values.items()}


def _contact(values: Values, heights: Array) -> dict[str, Array]:
    """The contact of waves of given heights that carries the prepressure."""
    filled = call("trum_filling", {**call("trum_engagement", values), "W_c": heights})
    full = {"fullness": filled["fullness"], "fullness_root": np.cbrt(filled["fullness"])}
    found = {**call("trum_contact_winkler", full), "engagement": filled["engagement"]}
    return {name: np.asarray(value) for name, value in found.items()}


def _layered(values: Values) -> bool:
    """Whether the layer loses energy or is sheared."""
    return "grip" in values or bool(np.asarray(values.get("eta_m", 0.0)) > 0)


def _reaction(values: Values, heights: Array, rotor: Rotor) -> dict[str, Array]:
    """Contact and reaction of waves of given heights, under a rotor that carries its load or is held still."""
    carried = None if rotor == "held" else _fraction(values)
    if "grip" in values:
        return sheared_reaction(values, _contact(values, heights), heights, carried)
    if _layered(values):
        return lossy_reaction(values, _contact(values, heights)["engagement"], carried)
    contact = _contact(values, heights)
    around = {**values, **contact}

    def at(alpha: Array) -> dict[str, Array]:
        found = call("trum_plain_reaction", {**around, "alpha": alpha})
        return {name: np.asarray(value) for name, value in found.items()}

    theta = contact["theta"]
    if carried is None:
        alpha = np.minimum(theta, np.pi / 2)
        return {**contact, "alpha": alpha, **at(alpha)}
    wanted = carried

    def excess(alpha: Array) -> tuple[Array, Array]:
        """Friction fraction where the surface is faster up to an angle, less the one that carries the load; slope."""
        found = at(alpha)
        return found["f"] - wanted, found["f_alpha"]

    alpha = rising(excess, np.zeros_like(theta), theta, theta / 2, theta, _LAST)
    return {**contact, "alpha": alpha, **at(alpha)}


def _fraction(values: Values) -> float:
    """Of friction that balances the load, in the sense in which the wave drives."""
    most = call("trum_stall_torque", {**values, "f": 1.0})["torque"]
    return float(np.asarray(values["s"]) * np.asarray(values["T_load"]) / np.asarray(most))


def _balance(values: Values, heights: Array, rotor: Rotor) -> dict[str, Array]:
    """Reaction and balance of waves of given heights."""
    found = _reaction(values, heights, rotor)
    kernel = "trum_layer_balance" if _layered(values) else "trum_plain_balance"
    balance = call(kernel, {**values, "lossy": 0.0, **found, "W": heights})
    return {**found, **{name: np.asarray(value) for name, value in balance.items()}}


def _possible(values: Values, low: dict[str, Array], high: dict[str, Array], ends: tuple[Array, Array]) -> Array:
    """Where the balance may hold between two heights, from bounds of all that is in it.

    With the height the contact narrows, so that its pressure, and the part of it that is faster than the rotor, come
    nearer to the crest: the central reaction grows, and so does what friction does beyond its mu-fold negative.

    Of a layer that loses energy or is sheared, the parts of the reaction do not all grow, but cannot change fast
    (:func:`_away`).
    """
    mu, mass = np.asarray(values["mu"]), np.asarray(values["M_q"])
    lever = np.asarray(values["D"]) * values["k_c"]
    spring = mass * (np.asarray(values["omega_n0"]) ** 2 - np.asarray(values["omega_q"]) ** 2)
    damper = 2 * np.asarray(values["xi"]) * values["omega_n0"] * mass * values["omega_q"]
    stiff = np.sort(np.stack([spring * ends[0], spring * ends[1]]), axis=0)
    if _layered(values):
        pressed, rubbed = _away(values, low, high, ends)
        in_phase = stiff + pressed("central") - lever * rubbed("across")[::-1]
        ahead = damper * np.stack(ends) + pressed("lossy") + lever * rubbed("along")
    else:
        in_phase = stiff + np.stack([low["central"], high["central"]])
        least = low["along"] + mu * (low["central"] - high["central"])
        most = high["along"] + mu * (high["central"] - low["central"])
        ahead = damper * np.stack(ends) + lever * np.stack([least, most])

    def squares(bounds: Array) -> Array:
        sizes = bounds**2
        return np.stack([np.where(bounds[0] * bounds[1] <= 0, 0.0, sizes.min(axis=0)), sizes.max(axis=0)])

    total, force = squares(in_phase) + squares(ahead), np.asarray(values["F_q"]) ** 2
    return np.asarray((total[0] <= force) & (force <= total[1]))


def _away(
    values: Values, low: dict[str, Array], high: dict[str, Array], ends: tuple[Array, Array]
) -> tuple[Callable[[str], Array], Callable[[str], Array]]:
    """Bounds, least and most, of parts of pressure and friction between two heights (docs/coupling.md proves them).

    While the height grows by a share s, the pressure that carries F_c moves by 2 F_c s at most, in sum over all places,
    and friction that carries the load by 4 mu F_c s; so what either does times cos u or sin u changes by no more than 2
    F_c s and 4 mu F_c s.  Where the whole wave touches, and bristles all stick, pressure and stress change with the
    height itself, which bounds the way from 0: as if s were that over the height at which 2 k_N W n_j / k_c is F_c,
    times sqrt(1 + eta^2) or half the grip.
    """
    force = float(np.asarray(values["F_c"]))
    with np.errstate(all="ignore"):
        share = np.log(ends[1] / ends[0])
    steady = high["stuck"] > 0 if "stuck" in high else high["theta"] >= np.pi
    steep = max(_STEEPEST, float(np.asarray(values.get("grip", 0.0))) / 2)
    share = np.where(steady, np.minimum(share, steep * high["engagement"] * (1 - ends[0] / ends[1])), share)

    def between(name: str, most: float, rate: float) -> Array:
        middle, reach = (low[name] + high[name]) / 2, rate * share / 2
        return np.clip(np.stack([middle - reach, middle + reach]), -most, most)

    def pressed(name: str) -> Array:
        if name not in high:
            return np.zeros((2, share.size))
        return between(name, force, 2 * force)

    def rubbed(name: str) -> Array:
        most = float(np.asarray(values["mu"])) * force
        return between(name, most, 4 * most)

    return pressed, rubbed


def _heights(values: Values, rotor: Rotor) -> Array:
    """All heights at which the balance holds, from brackets that cover every one that could.

    0 is among them where friction holds the surface against the modal force.
    """
    lever, force = np.asarray(values["D"]) * values["k_c"], np.asarray(values["F_q"])
    damper = 2 * np.asarray(values["xi"]) * values["omega_n0"] * values["M_q"] * values["omega_q"]
    top = float((force + lever * values["mu"] * values["F_c"]) / damper) * (1 + 1e-9)
    edges = np.append(0.0, np.geomspace(1e-6 * top, top, _FIRST))
    low, high = edges[:-1], edges[1:]
    while True:
        at = _balance(values, np.stack([low, high]), rotor)
        ends = tuple({name: value[k] for name, value in at.items()} for k in (0, 1))
        kept = _possible(values, ends[0], ends[1], (low, high))
        low, high = low[kept], high[kept]
        if (high - low <= _NARROW * high).all() or high.max() <= _LEAST * top:
            break
        parts = np.linspace(low, high, _PARTS + 1)
        low, high = parts[:-1].T.ravel(), parts[1:].T.ravel()
    still = _balance(values, np.zeros(1), rotor)["residual"][0] >= 0
    found = [0.0] if still else []
    apart = np.flatnonzero(low[1:] > high[:-1]) + 1
    for left, right in zip(np.split(low, apart), np.split(high, apart), strict=True):
        if left.size and left[0] > 0:
            found += _root(values, float(left[0]), float(right[-1]), rotor)
    return np.array(found)


def _root(values: Values, low: float, high: float, rotor: Rotor) -> list[float]:
    """Where the balance changes its sign in a narrow bracket, none if it does not."""

    def negative(heights: Array) -> Array:
        return np.asarray(_balance(values, heights, rotor)["residual"] < 0)

    ends = negative(np.array([low, high]))
    if ends[0] == ends[1]:
        return []
    for _ in range(_ROUNDS):
        within = np.linspace(low, high, _FIRST)
        other = np.flatnonzero(negative(within) != ends[0])
        if not other.size or other[0] == 0:  # no wider than rounding
            break
        low, high = float(within[other[0] - 1]), float(within[other[0]])
    return [(low + high) / 2]


def held_wave(values: Values) -> float:
    """Height in m up to which friction holds a wave still that nothing drives, under a rotor at rest with its load.

    Pressure is then the same all round, and a traction of its limit takes the load by one part of the circumference and
    the wave by its part in cos u (:func:`derivations.coupling.reaction`).  0 where friction cannot hold the load.

    Parameters
    ----------
    values : mapping
        From :func:`coupled_values`.
    """
    loaded = abs(_fraction(values))
    if not loaded < 1:
        return 0.0
    even = {"engagement": 0.0, "share": 1 / np.pi, "theta": np.pi, "alpha": np.pi * (1 + loaded) / 2}
    reaction = call("trum_plain_reaction", {**values, **even})
    return float(np.asarray(call("trum_held_wave", {**values, **reaction})["W_held"]))


def standing(values: Values) -> tuple[float, float]:
    """Height of the plain wave in m, and modal force in N, up to which the rotor stands as the force rises from none.

    A layer that is rigid along the circumference holds the surface, and there is no wave.  One that is sheared sticks
    all round, and gives way as springs do.

    Parameters
    ----------
    values : mapping
        From :func:`coupled_values`.  NaN where friction cannot hold the load.
    """
    loaded = _fraction(values)
    if not abs(loaded) < 1:
        return float("nan"), float("nan")
    most = float(np.asarray(call("trum_stuck_layer", {**values, "f": loaded})["W_stick"])) if "grip" in values else 0.0
    at = _balance(values, np.array([most]), "loaded")
    return most, float(np.hypot(at["in_phase"], at["ahead"])[0])


def wave_at(values: Values, heights: Array, rotor: Rotor = "loaded") -> PlainWaves:
    """What plain waves of given heights do, whether or not the modal force makes them.

    Parameters
    ----------
    values : mapping
        From :func:`coupled_values`.
    heights : (k,) array
        In m.
    rotor : {"loaded", "held"}
        Whether the rotor turns under its load or is held still.
    """
    at = _balance(values, heights, rotor)
    share = at["ratio"] if "ratio" in at else np.cos(at["alpha"])
    speed = np.asarray(values["D"]) * values["k_c"] * values["omega_q"] * heights * share
    if rotor == "held":
        speed = np.zeros_like(heights)
    kernel = "trum_layer_powers" if _layered(values) else "trum_plain_powers"
    powers = call(kernel, {**values, "lossy": 0.0, **at, "W": heights, "v": speed})
    given = np.asarray(values["F_q"]) * heights * values["omega_q"] * np.sin(at["lead"])
    with np.errstate(all="ignore"):
        residual = np.where(heights > 0, np.asarray(powers["P_in"]) / given - 1, 0.0)
    stable = np.array([_stable(values, at, float(w), k, rotor) for k, w in enumerate(heights)], bool)
    return PlainWaves(
        amplitude=heights,
        lead=at["lead"],
        half_angle=at["theta"],
        driving_angle=at["alpha"],
        speed=np.asarray(values["s"]) * speed / np.asarray(values["r_c"]),
        friction=at["f"],
        resonance=at["omega_r"],
        input_power=np.asarray(powers["P_in"]),
        stator_power=np.asarray(powers["P_stator"]),
        contact_power=np.asarray(powers["P_contact"]),
        layer_power=np.asarray(powers["P_layer"]) if "P_layer" in powers else np.zeros_like(heights),
        slip_power=np.asarray(powers["P_slip"]),
        output_power=np.asarray(powers["P_rotor"]),
        stable=stable,
        whole=at["theta"] >= np.pi,
        stuck=at["stuck"] > 0 if "stuck" in at else np.zeros(heights.shape, bool),
        residual=residual,
    )


def plain_waves(values: Values, rotor: Rotor = "loaded") -> PlainWaves:
    """All steady states of the plain wave that the modal force of both phases makes.

    Parameters
    ----------
    values : mapping
        From :func:`coupled_values`, or of a motor of which modal mass, force and so on are known by themselves:
        ``M_q F_q omega_n0 omega_q xi D k_c k_N n_j F_c mu r_c T_load J_total s``.
    rotor : {"loaded", "held"}
        Whether the rotor turns under its load or is held still.

    Returns
    -------
    PlainWaves
        Without a state where the load is as large as all that friction carries.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.coupling import coupled_values, plain_waves
    >>> from trum_sym.model.levels import Levels
    >>> drive = ts.Drive(on_periods=20, frequency_difference=500, load_torque=0.3)
    >>> waves = plain_waves(coupled_values(ts.load_motor(), drive, Levels(coupling="contact")))
    >>> waves.names, [f"{1e6 * w:.2f} um" for w in waves.amplitude]
    (('high',), ['3.40 um'])
    """
    if rotor == "loaded" and not abs(_fraction(values)) < 1:
        return wave_at(values, np.zeros(0), "held")
    return wave_at(values, _heights(values, rotor), rotor)


def _stable(values: Values, at: Mapping[str, Array], size: float, index: int, rotor: Rotor) -> bool:
    """Whether all eigenvalues of the motion about a plain wave, seen from its crest, have a negative real part.

    The state is the wave's vector in the turning frame (m), its rate (m/s) and the rim's speed (m/s); the rotor
    follows up and down without a mass.  Of a layer that is sheared, whether a higher wave takes more force.
    """
    if size == 0.0 or ("stuck" in at and at["stuck"][index] > 0):
        return True
    if "ratio" in at:  # bristles remember a passage, and longer where the whole wave touches: no state of this motion
        low, high = _balance(values, size * np.array([1 - _STEP, 1 + _STEP]), rotor)["residual"]
        return bool(low < high)
    force = float(at["in_phase"][index]) + 1j * float(at["ahead"][index])
    surface = float(np.asarray(values["D"]) * values["k_c"] * values["omega_q"]) * size
    speed = 0.0 if rotor == "held" else surface * float(np.cos(at["alpha"][index]))
    start = np.array([size, 0.0, 0.0, 0.0, speed])
    steps = _STEP * np.array([size, size, size * values["omega_q"], size * values["omega_q"], surface])
    moved = start + np.concatenate([np.diag(steps), -np.diag(steps)])
    rates = _rates(values, moved, force, held=rotor == "held")
    matrix = ((rates[:5] - rates[5:]) / (2 * steps[:, np.newaxis])).T
    if rotor == "held":
        matrix = matrix[:4, :4]
    return bool(np.linalg.eigvals(matrix).real.max() < 0)


def _rates(values: Values, states: Array, force: complex, *, held: bool) -> Array:
    """Of states (k, 5) in the frame that turns with the drive: the wave's vector, its rate and the rim's speed."""
    omega = float(np.asarray(values["omega_q"]))
    z, rate = states[:, 0] + 1j * states[:, 1], states[:, 2] + 1j * states[:, 3]
    whole = rate + 1j * omega * z  # seen from outside
    act = _acting_lossy if _layered(values) else _acting
    reaction, along = act(values, z, whole, states[:, 4])
    mass, own, xi = (float(np.asarray(values[name])) for name in ("M_q", "omega_n0", "xi"))
    second = (force + reaction) / mass - 2 * xi * own * whole - own**2 * z - 2j * omega * rate + omega**2 * z
    radius = np.asarray(values["r_c"])
    load = np.asarray(values["s"]) * values["T_load"]
    turn = radius * (radius * along - load) / np.asarray(values["J_total"])
    parts = [rate.real, rate.imag, second.real, second.imag, np.zeros_like(turn) if held else turn]
    return np.stack(parts, axis=1)


def _instant(values: Values, z: CArray, whole: CArray, contact: Mapping[str, Array]) -> dict[str, ArrayLike]:
    """Wave and surface of the vectors and their rates, over a contact that carries the prepressure."""
    height = -contact["share"] / np.asarray(call("trum_engagement", values)["engagement_per_height"])
    moving = {"w_B": z.real, "w_A": z.imag, "v_B": whole.real, "v_A": whole.imag, "height": height}
    return call("trum_coupled_instant", {**values, **moving})


def _acting(values: Values, z: CArray, whole: CArray, speed: Array) -> tuple[CArray, Array]:
    """Modal forces of B and A as one number, and the force on the rim."""
    instant = _instant(values, z, whole, _contact(values, np.abs(z)))
    acting = call("trum_coupled_forces", {**values, **instant, "v": speed})
    return np.asarray(acting["Q_B"]) + 1j * np.asarray(acting["Q_A"]), np.asarray(acting["F_x"])


def _acting_lossy(values: Values, z: CArray, whole: CArray, speed: Array) -> tuple[CArray, Array]:
    """The same of a layer that loses energy, as on a wave that keeps its height, its rate and the crest's speed.

    Left out: how fast the rotor rises, and what an element remembers of another wave when it meets the surface.
    """
    heights = np.abs(z)
    growth, runs = (whole * z.conj() / heights).real, (whole * z.conj() / heights).imag  # m/s
    instant = _instant(values, z, whole, _contact(values, heights))
    half = np.arccos(np.clip(speed / np.asarray(instant["R_v"]), -1, 1))
    lag, middle = np.asarray(values["eta_m"]) / np.asarray(values["omega_q"]), np.asarray(instant["phi"])
    pressed = heights + lag * growth  # in phase with the crest; lag * runs is a quarter wave ahead
    slanted = {**values, "eta_m": lag * runs / pressed}
    contact = lossy_contact(slanted, _contact(values, pressed)["engagement"])
    zone = {"zone_low": middle - half, "zone_high": middle + half}
    found = call("trum_layer_reaction", {**slanted, **contact, **zone})
    parts = {name: np.asarray(value) for name, value in found.items()}
    lever = float(np.asarray(values["D"]) * values["k_c"])
    against = parts["central"] - lever * parts["across"] + 1j * (parts["lossy"] + lever * parts["along"])
    return -against * z / heights, float(np.asarray(values["mu"]) * values["F_c"]) * parts["f"]
