"""The rotor's periodic orbit under a repeated drive cycle: it exists, is unique and attracts, with what it needs.

The paper draws the speed as periodic (Fig. 18) without asking.  Everything follows from one fact: friction does
not grow with the rotor's speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import transfer
from derivations.ledger.contact_cycle import contact_motion
from derivations.ledger.friction_states import brute_fraction, states
from derivations.ledger.history import Array, history, values
from derivations.ledger.judge import figure, largest
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import sym
from trum_sym.inputs.units import parse_unit

__all__ = ["ENTRIES"]

theta, r_c, mu, F_c, J, T, T_load = sym("theta r_c mu F_c J T T_load")
phi, u, v, R_v = transfer.phi, transfer.u, transfer.v, transfer.R_v
slope_sum = sp.Symbol("S", real=True)  # the slope df/dv integrated over the lap
_KNOWN = {**transfer.DIMENSIONS, slope_sum: parse_unit("s^2/m").dimension}
_LOAD = sp.sin(theta) - theta * sp.cos(theta)
_OPENING = sp.acos(v / R_v)
_TABLE_LOAD = 0.3  # N m, Table 1
_STARTS = tuple(-4 + 0.5 * i for i in range(17))  # m/s


def _forms() -> Forms:
    """Slope of the friction, gain of the lap, and what a load beyond the friction adds to the speed at least."""
    pressed = [sp.Max(0, sp.cos(phi + side * _OPENING, evaluate=False) - sp.cos(theta)) for side in (1, -1)]
    return {
        "df/dv": -sum(pressed) / (_LOAD * sp.sqrt(R_v**2 - v**2)),
        "gain": sp.exp(r_c**2 * mu * F_c / J * slope_sum),
        "least_change": r_c * (sp.Abs(T_load) - r_c * mu * F_c) * T / J,
    }


def _derive() -> Derivation:
    a = sp.Symbol("a", positive=True)
    share, forms = (sp.sin(u) - u * sp.cos(theta)) / (2 * _LOAD), _forms()
    density = share.diff(u)
    f = 2 * (share.subs(u, phi + a) - share.subs(u, phi - a)) - 1
    inside = -2 * (density.subs(u, phi + a) + density.subs(u, phi - a)) / (R_v * sp.sin(a))
    tau, rate = sp.symbols("tau c_f", positive=True)
    slope, gap = sp.Function("f_v")(tau), sp.Function("delta")(tau)
    grown = sp.exp(rate * sp.Integral(slope, (tau, 0, tau)))
    torque = r_c * mu * F_c
    return Derivation(
        (
            step(
                "The surface outruns the rotor between u = phi - a and phi + a, a = acos(v/R) (eqs. 34, 36). With "
                "C(u) the share of the load left of u and p = C' its density, the net friction over mu F_c is",
                sp.Eq(sp.Symbol("f"), f),
                sp.Eq(sp.Symbol("p"), density),
            ),
            step(
                "A faster rotor narrows that stretch:",
                sp.Eq(sp.Derivative(_OPENING, v), -1 / sp.sqrt(R_v**2 - v**2)),
                zero=_OPENING.diff(v) + 1 / sp.sqrt(R_v**2 - v**2),
            ),
            step(
                "so with a nonsliding point at each end f falls by the pressure there, df/dv = -2 (p(phi + a) + "
                "p(phi - a))/(R sin a):",
                inside,
                zero=sp.simplify(f.diff(a) * (-1 / (R_v * sp.sin(a))) - inside),
            ),
            step(
                "An end outside the contact, where p = 0, adds nothing, so for |v| < R, whatever the wave,",
                sp.Eq(sp.Symbol("f_v"), forms["df/dv"]),
            ),
            step(
                "This is never positive, nor is it where the whole wave touches, with the density below for p. For "
                "v >= R friction is -1, for v <= -R +1: f never grows with v.",
                sp.Eq(sp.Symbol("p"), transfer.whole_wave_share().subs(sp.Max(-sp.pi, sp.Min(sp.pi, u)), u).diff(u)),
            ),
            step(
                "Eq. 38 for the rim v = r_c omega_p: two rotors a small gap delta apart, c_f = r_c^2 mu F_c/J, follow",
                sp.Eq(gap.diff(tau), rate * slope * gap),
                sp.Eq(sp.Symbol(r"\delta/\delta_0"), grown),
                zero=sp.simplify(grown.diff(tau).doit() - rate * slope * grown),
            ),
            step(
                "Over a lap of the drive cycle the gap is multiplied by the gain, with S the integral of f_v over the "
                "lap. S <= 0, so the lap's map P(v) of start speeds is monotone with a slope between 0 and 1:",
                sp.Eq(sp.Symbol("gain"), forms["gain"]),
            ),
            step(
                "It exists: if |T_load| < r_c mu F_c, a rotor faster than every point of the surface all lap is "
                "slowed and one slower than every point is sped up, by",
                -r_c * (torque + T_load) * T / J,
                r_c * (torque - T_load) * T / J,
                zero=[
                    r_c * (sign * torque - T_load) * T / J - sign * r_c * (torque - sign * T_load) * T / J
                    for sign in (1, -1)
                ],
            ),
            step("so P, which is continuous, crosses the diagonal in between."),
            step(
                "It is unique and attracts: two periodic orbits v_1 < v_2 gain the same, 0, though f(v_1) >= f(v_2) "
                "at "
                "every moment; so f is the same for both at every moment and all speeds between. Where f_v < 0 for "
                "any part of the lap that cannot be, the gain is below 1, and every start comes to the one orbit."
            ),
            step(
                "The exception has a name, the neutral interval: no nonsliding point is in the contact all lap, so "
                "friction is saturated, f = +1 or -1 at every moment, and its mean is T_load/(r_c mu F_c). Then every "
                "speed of an interval is periodic and none attracts."
            ),
            step(
                "Runaway: if |T_load| >= r_c mu F_c no friction can hold the load; each lap changes the speed in the "
                "load's sense by at least",
                forms["least_change"],
                zero=forms["least_change"].subs(sp.Abs(T_load), torque),
            ),
        ),
        forms,
    )


@dataclass(frozen=True)
class _Wave:
    """One lap sampled at midpoints of equal steps: largest surface speed, where it is, contact half-angle."""

    R: Array
    phi: Array
    theta: Array
    step: float


@cache
def _at_table_3(samples: int = 1500) -> _Wave:
    """The repeated lap at Table 3, whose wave is never so low that the whole of it touches."""
    h = history("periodic", samples)
    angle, speed, half = contact_motion(h)
    return _Wave(speed, angle, half, h.step)


@cache
def _friction() -> Callable[..., Any]:
    ratio = transfer.friction_fraction()
    return sp.lambdify((transfer.phi, transfer.c, transfer.theta), ratio, "numpy")  # type: ignore[no-any-return]


def _path(wave: _Wave, start: Array, inertia: float, load: float) -> Array:
    """Speeds of the rim from start speeds, before every step and after the lap, by Heun's steps over eq. 38."""
    f, path, capacity = _friction(), [np.asarray(start, dtype=np.float64)], _capacity()
    per = values()["r_c"] * wave.step / inertia
    for R, at, half in zip(wave.R, wave.phi, wave.theta, strict=True):
        first = capacity * f(at, path[-1] / R, half) - load
        second = capacity * f(at, (path[-1] + per * first) / R, half) - load
        path.append(path[-1] + per * (first + second) / 2)
    return np.array(path)


@cache
def _lap(starts: tuple[float, ...], load: float) -> Array:
    """Change of the rim's speed over a lap at Table 3, from start speeds, under a load over what friction can hold."""
    path = _path(_at_table_3(), np.array(starts), values()["J"], load * _capacity())
    change: Array = path[-1] - path[0]
    return change


@cache
def _heavy(gap: float) -> tuple[float, Array]:
    """How many times the gap of two rotors of 200 times the inertia a lap makes, and the speed of one between them."""
    p = values()
    low, middle, high = _path(_at_table_3(), np.array([-gap, 0, gap]), 200 * p["J"], _TABLE_LOAD).T
    return float(high[-1] - low[-1]) / (2 * gap), (middle[1:] + middle[:-1]) / 2


def _capacity() -> float:
    p = values()
    return p["r_c"] * p["mu"] * p["F_c"]


_AMPLITUDE = "1.3"  # of the surface speed, m/s


@cache
def _closed_slopes() -> list[mp.mpf]:
    """The slope of friction's closed form, taken numerically, at random states."""
    closed = sp.lambdify((transfer.phi, transfer.c, transfer.theta), transfer.friction_fraction(), "mpmath")
    R = mp.mpf(_AMPLITUDE)
    return [mp.diff(lambda at, s=s: closed(s.phi, at / R, s.theta), R * s.c) for s in states(60, "orbit")]


def _slopes(forms: Forms) -> Iterator[tuple[mp.mpf, mp.mpf]]:
    """The form's slope and that of the closed form at these states."""
    form = sp.lambdify((v, R_v, phi, theta), forms["df/dv"], "mpmath")
    R = mp.mpf(_AMPLITUDE)
    for s, wanted in zip(states(60, "orbit"), _closed_slopes(), strict=True):
        yield form(R * s.c, R, s.phi, s.theta), wanted


def _judge(forms: Forms) -> Iterator[Evidence]:
    pairs = list(_slopes(forms))
    off = largest(abs(found - wanted) for found, wanted in pairs)
    yield evidence(
        "numeric",
        off < 1e-8,
        "the slope is that of the friction's closed form, taken numerically at 60 "
        f"random states, off by {mp.nstr(off, 2)} s/m",
    )
    rises = _largest_rise()
    yield evidence(
        "domain",
        all(found <= 0 for found, _ in pairs) and rises <= 0,
        "never positive; and friction summed point by point never grows from a slower rotor to a faster "
        f"one, by {figure(rises)} at most",
    )
    yield from _judge_lap(forms)
    yield from _judge_loads(forms)


@cache
def _largest_rise() -> float:
    """By which friction, summed point by point, is more for a slower rotor than for a faster one, at random states."""
    rises = (
        brute_fraction(s, whole=True, steps=4001) - brute_fraction(slower, whole=True, steps=4001)
        for s, slower in _slower(80)
    )
    return float(largest(rises))


def _slower(count: int) -> Iterator[tuple[Any, Any]]:
    """States, and the same with a slower rotor."""
    for faster, other in zip(states(count, "fast"), states(count, "slow"), strict=True):
        low, high = sorted((faster.c, other.c))
        yield replace(faster, c=high), replace(faster, c=low)


def _judge_lap(forms: Forms) -> Iterator[Evidence]:
    p, wave = values(), _at_table_3()
    seen, speed = _heavy(1e-3)
    form = sp.lambdify((v, R_v, phi, theta), forms["df/dv"], "numpy")
    slopes = form(np.clip(speed, -wave.R, wave.R) * (1 - 1e-12), wave.R, wave.phi, wave.theta)
    S = wave.step * float(slopes[np.abs(speed) < wave.R].sum())
    known = {r_c: p["r_c"], mu: p["mu"], F_c: p["F_c"], J: 200 * p["J"], slope_sum: S}
    stated = float(forms["gain"].subs(known))
    yield evidence(
        "identity",
        abs(stated / seen - 1) < 1e-3,
        f"the gain of a lap at Table 3 with 200 times the inertia is {figure(stated, 5)}; two rotors "
        f"started 2 mm/s apart end {figure(seen, 5)} times as far apart",
    )
    gains = 1 + np.diff(_lap(_STARTS, _TABLE_LOAD / _capacity())) / np.diff(_STARTS)
    yield evidence(
        "limit",
        bool((gains >= -1e-9).all() and (gains <= 1 + 1e-9).all() and gains.min() < 0.01),
        f"with the rotor's own inertia starts from -4 to 4 m/s, 0.5 m/s apart, end {figure(gains.min(), 2)} "
        f"to {figure(gains.max(), 3)} times as far apart, in the same order",
    )


def _judge_loads(forms: Forms) -> Iterator[Evidence]:
    p, most = values(), _capacity()
    known = {r_c: p["r_c"], mu: p["mu"], F_c: p["F_c"], J: p["J"], T: p["T"]}
    least = {load: float(forms["least_change"].subs({**known, T_load: load * most})) for load in (1.2, -1.2)}
    over = [-np.sign(load) * _lap(_STARTS, load) - change for load, change in least.items()]
    slowest = -_lap(_STARTS, 1.2)[0]  # slower than the surface all lap: all friction drives it
    exact = abs(slowest / least[1.2] - 1) if least[1.2] > 0 else np.inf
    yield evidence(
        "domain",
        bool(np.min(over) > -1e-6) and exact < 1e-6,
        f"beyond r_c mu F_c = {figure(most)} N m every start loses at least the stated speed a lap, "
        f"{figure(least[1.2])} m/s at 1.2 times, which the slowest loses exactly",
    )
    back = _lap((-9.0, 9.0), 0.9)
    yield evidence(
        "continuity",
        bool(back[0] > 0 > back[1]),
        "below it a rotor far too slow is sped up and one far too fast slowed, so a speed in between repeats",
    )


def _neutral() -> float:
    """The largest change of speed over a lap, of four starts, in a wave that turns round at once, without load."""
    count, p = 1000, values()
    angle = np.where(np.arange(count) < count // 2, 0.0, np.pi)
    swing = _Wave(np.full(count, 1.2), angle, np.full(count, 0.4), p["T"] / count)
    path = _path(swing, np.array([-0.7, -0.4, 0.0, 0.3]), 20 * p["J"], 0.0)
    return float(np.abs(path[-1] - path[0]).max())


@cache
def _drawn_together() -> float:
    """Distance after a lap over that before it, of starts at -4 and 4 m/s: finer steps until it stands still.

    Raises
    ------
    ArithmeticError
        If finer steps keep changing it.
    """
    before = math.inf
    for samples in (2000, 4000, 8000, 16000):
        ends = _path(_at_table_3(samples), np.array([_STARTS[0], _STARTS[-1]]), values()["J"], _TABLE_LOAD)[-1]
        after = float(ends[1] - ends[0]) / (_STARTS[-1] - _STARTS[0])
        if abs(after - before) < 2e-5:
            return after
        before = after
    raise ArithmeticError("the rotor's lap does not converge")


def _effect() -> str:
    if _neutral() > 1e-9:
        raise ArithmeticError("a rotor in a neutral interval does not come back to its own speed")
    return (
        "At Table 3, periodic, phase lead +1, one lap draws starts from -4 to 4 m/s together to "
        f"{figure(100 * _drawn_together(), 3)} % of their distance: the orbit is reached within a few cycles, and "
        "can be "
        f"found as a root of P(v) - v instead of by waiting. A rotor runs away beyond {figure(_capacity())} N m; the "
        "load "
        "is 0.3 N m. A neutral interval needs a wave that turns round at once, twice a lap, without load: there a "
        "rotor "
        "comes back to its own speed, whatever it is."
    )


ENTRIES = (
    Entry(
        id="rotor-orbit",
        section="4.2.3",
        title="The rotor's periodic orbit exists, is unique and attracts",
        place="presumed by eq. 38, Figs. 18 and 20, not stated",
        printed={},
        units={"df/dv": "s/m", "gain": "1", "least_change": "m/s"},
        known=_KNOWN,
        verdict="reconstructed",
        reason="Friction never grows with the rotor's speed, so the lap of a drive cycle brings any two start speeds "
        "nearer: one orbit, reached from every start, unless the load exceeds r_c mu F_c (runaway) or friction "
        "is saturated at every moment of the lap (neutral interval).",
        judge=_judge,
        derive=_derive,
        effect=_effect,
    ),
)
