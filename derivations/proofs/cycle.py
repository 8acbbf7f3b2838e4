"""Proofs of the drive cycle's kernels: both phases through the regions, the determinant, its measures (Sect. 3).

The phases are followed as an oscillator's state by the exponential of its matrix, from switching to switching at the
times at which they happen; no closed form of free motion is used, nor that the switchings fall on one drive phase.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import mpmath as mp

from derivations.proofs.maths import DIGITS, Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS", "phase_at", "state_after", "steady"]

Found = Mapping[str, Number]
Free = tuple[Number, Number]
_SWITCHED = {"A": ("off", "on", "on"), "B": ("on", "off", "on")}  # in the regions, by their definition
_REGIONS = ("redu", "addredu", "add")


@cache
def _exponential(omega_n: Number, xi: Number, time: Number, digits: int) -> Number:
    """Of the oscillator's matrix over a time, on displacement and velocity over omega_n."""
    with mp.workdps(digits + 25):
        turn = omega_n * time
        return mp.expm(mp.matrix([[0, turn], [-turn, -2 * xi * turn]]))


def state_after(p: Point, free: Free, time: Number) -> Free:
    """Displacement and velocity of free motion after a time."""
    turned = _exponential(p.omega_n, p.xi, time, mp.mp.dps)
    w, v = free[0], free[1] / p.omega_n
    return turned[0, 0] * w + turned[0, 1] * v, (turned[1, 0] * w + turned[1, 1] * v) * p.omega_n


def steady(p: Point, phase: str, time: Number) -> Free:
    """Displacement and velocity of a phase that has long been on; B is s quarter periods ahead."""
    frequency = p.omega_n + p.Delta_omega
    angle = frequency * time + p.psi + (p.s * mp.pi / 2 if phase == "B" else 0)
    return p.W * mp.cos(angle), -frequency * p.W * mp.sin(angle)


def phase_at(p: Point, phase: str, time: Number) -> Free:
    """Displacement and velocity of a phase, a time after the start of a region."""
    w, v = state_after(p, (p.values[f"a_{phase}"], p.values[f"b_{phase}"]), time)
    on_w, on_v = steady(p, phase, time)
    gate = p.values[f"g_{phase}"]
    return w + gate * on_w, v + gate * on_v


def _lengths(p: Point) -> tuple[Number, ...]:
    """Of the regions: each phase misses m - n of m pulses, A first, then B; they share the rest."""
    pulse = 2 * mp.pi / (p.omega_n + p.Delta_omega)
    missed = p.m - p.n
    return missed * pulse, missed * pulse, (p.m - 2 * missed) * pulse


def _through(p: Point, phase: str, free: Free) -> list[Free]:
    """Free motion at the start of each region and at the end, from that before the cycle, when the phase was on.

    Displacement and velocity go on where the phase is switched; free motion is what they are without the steady state.
    """
    time, on, states = mp.mpf(0), True, []
    for switched, length in zip(_SWITCHED[phase], _lengths(p), strict=True):
        now = switched == "on"
        if now != on:
            w, v = steady(p, phase, time)
            sign = 1 if on else -1
            free = free[0] + sign * w, free[1] + sign * v
        states.append(free)
        free, time, on = state_after(p, free, length), time + length, now
    return [*states, free]


def _drive(p: Point, m: Maths) -> Found:
    """The drive is Delta_omega above the resonance; a cycle is m of its periods."""
    frequency = p.omega_n + p.Delta_omega
    return {"omega_q": frequency, "T": p.m / (frequency / (2 * m.pi))}


def _rest(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """A phase at rest is its steady state and the free motion that cancels it."""
    found: dict[str, Number] = {}
    for phase in "AB":
        w, v = steady(p, phase, mp.mpf(0))
        found |= {f"a_{phase}": -w, f"b_{phase}": -v}
    return found


def _periodic(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Free motion that a cycle turns into itself: two linear equations, from three cycles each."""
    found: dict[str, Number] = {}
    scale = p.omega_n
    for phase in "AB":
        none, of_w, of_v = (_through(p, phase, start)[-1] for start in ((0, 0), (1, 0), (0, scale)))
        turned = mp.matrix(
            [
                [1 - (of_w[0] - none[0]), -(of_v[0] - none[0])],
                [-(of_w[1] - none[1]) / scale, 1 - (of_v[1] - none[1]) / scale],
            ]
        )
        size = turned[0, 0] * turned[1, 1] - turned[0, 1] * turned[1, 0]
        right = none[0], none[1] / scale
        found[f"a_{phase}"] = (right[0] * turned[1, 1] - turned[0, 1] * right[1]) / size
        found[f"b_{phase}"] = (turned[0, 0] * right[1] - turned[1, 0] * right[0]) / size * scale
        found["repetition"] = mp.sqrt(size)  # of the eigenvalues 1 - exp(lambda T), a conjugate pair, the product
    return found


def _regions(p: Point, m: Maths) -> Found:  # noqa: ARG001
    found = {f"time_{region}": length for region, length in zip(_REGIONS, _lengths(p), strict=True)}
    for phase in "AB":
        states = _through(p, phase, (p.values[f"a_{phase}"], p.values[f"b_{phase}"]))
        for region, (w, v) in zip((*_REGIONS, "end"), states, strict=True):
            found |= {f"a_{phase}_{region}": w, f"b_{phase}_{region}": v}
    return found


def _response(p: Point, m: Maths) -> Found:
    """Both phases; the vector product of a surface point's displacement and velocity, anywhere, and its rate."""
    place = mp.mpf("0.37")  # k_c x

    def determinant(tau: Number) -> Number:
        (w_A, v_A), (w_B, v_B) = (phase_at(p, phase, tau) for phase in "AB")
        vertical = w_A * mp.sin(place) + w_B * mp.cos(place)
        along = p.D * p.k_c * (w_A * mp.cos(place) - w_B * mp.sin(place))  # D times the slope
        vertical_rate = v_A * mp.sin(place) + v_B * mp.cos(place)
        along_rate = p.D * p.k_c * (v_A * mp.cos(place) - v_B * mp.sin(place))
        return along_rate * vertical - vertical_rate * along

    (w_A, v_A), (w_B, v_B) = (phase_at(p, phase, p.tau) for phase in "AB")
    return {
        "w_A": w_A,
        "w_B": w_B,
        "v_A": v_A,
        "v_B": v_B,
        "Q": determinant(p.tau),
        "Q_rate": m.derivative(determinant, p.tau),
    }


def _measures(p: Point, m: Maths) -> Found:
    """Eqs. 43 and 44 in the ratios X and Y."""
    X, Y = p.q_plus / p.q_minus, p.p_plus / p.p_minus
    average = (X - 1) / (X + 1) / p.T
    return {
        "q_ratio": X,
        "q_square_ratio": Y,
        "q_average": average,
        "q_volatility": m.sqrt((Y + 1) / m.absolute(Y - 1)) / (p.T**2 * average),
    }


def _phasor(p: Point, free: Free) -> tuple[Number, Number]:
    """Z with Re z = w, Re(lambda z) = v; lambda solves lambda^2 + 2 xi omega_n lambda + omega_n^2 = 0."""
    re, im = -p.xi * p.omega_n, mp.sqrt(p.omega_n**2 - (p.xi * p.omega_n) ** 2)
    return free[0], (re * free[0] - free[1]) / im


def _along(
    p: Point,
    names: str,
    outputs: Callable[[Point], Mapping[str, Number]],
    directions: Mapping[str, Callable[..., Point]],
) -> Found:
    """Derivatives of outputs along curves through a point: ``directions`` give its points by the parameter."""
    found = {}
    step = mp.mpf(10) ** (-DIGITS // 2)
    with mp.workdps(2 * DIGITS):
        for direction, curve in directions.items():
            size = step * p.values[direction]
            ahead, behind = outputs(curve(p, size)), outputs(curve(p, -size))
            for name in names.split():
                found[f"{name}_{direction}"] = (ahead[name] - behind[name]) / (2 * size)
    return found


def follow(direction: str, following: str = "") -> Callable[[Point, Number], Point]:
    """The curve on which a frequency changes, and with it at stated rates what follows it."""

    def curve(p: Point, by: Number) -> Point:
        moved = {name: p.values[name] + by * p.values[f"{name}_{direction}"] for name in following.split()}
        return p.with_(**moved, **{direction: p.values[direction] + by})

    return curve


_FREQUENCIES = ("omega_n", "Delta_omega")
_STATES = "a_A b_A a_B b_B"


def _periodic_slopes(p: Point, m: Maths) -> Found:
    return _along(p, _STATES, lambda at: _periodic(at, m), {name: follow(name) for name in _FREQUENCIES})


def _rest_slopes(p: Point, m: Maths) -> Found:
    return _along(p, _STATES, lambda at: _rest(at, m), {name: follow(name) for name in _FREQUENCIES})


def _region_phasors(p: Point) -> dict[str, Number]:
    """Free motion's phasor and, where the phase is on, that of the steady state: Re z = w, Re(i omega_q z) = v."""
    found = {}
    starts = [sum(_lengths(p)[:k], mp.mpf(0)) for k in range(3)]
    for phase in "AB":
        states = _through(p, phase, (p.values[f"a_{phase}"], p.values[f"b_{phase}"]))
        for region, switched, start, state in zip(_REGIONS, _SWITCHED[phase], starts, states, strict=False):
            re, im = _phasor(p, state)
            if switched == "on":
                w, v = steady(p, phase, start)
                re, im = re + w, im - v / (p.omega_n + p.Delta_omega)
            found[f"re_{phase}_{region}"], found[f"im_{phase}_{region}"] = re, im
    return found


_PHASORS = " ".join(f"{part}_{phase}_{region}" for phase in "AB" for region in _REGIONS for part in ("re", "im"))


def _regions_slopes(p: Point, m: Maths) -> Found:  # noqa: ARG001
    return _along(p, _PHASORS, _region_phasors, {name: follow(name, _STATES) for name in _FREQUENCIES})


def directed(names: str) -> str:
    """Names with both frequencies' behind them."""
    return " ".join(f"{name}_{frequency}" for frequency in _FREQUENCIES for name in names.split())


_CYCLE = "Delta_omega W m n omega_n psi s xi"
_WHERE = "random drives around Table 3, both phase leads"
_BOTH = " ".join(f"{letter}_{phase}_{region}" for region in (*_REGIONS, "end") for phase in "AB" for letter in "ab")
PROOFS = (
    Proof(
        "trum_drive",
        "omega_q T",
        "14 43",
        "a cycle is m periods of the frequency that is Delta_omega above resonance",
        _drive,
        grid("Delta_omega m omega_n"),
        _WHERE,
        symbolic=True,
    ),
    Proof(
        "trum_start_periodic",
        "a_A b_A a_B b_B repetition",
        "9 10",
        "what a cycle, followed by the oscillator's matrix exponential, turns into itself; root of det(I - M)",
        _periodic,
        grid(_CYCLE),
        _WHERE,
    ),
    Proof(
        "trum_start_rest",
        "a_A b_A a_B b_B",
        "9 10",
        "cancels the steady state",
        _rest,
        grid("Delta_omega W omega_n psi s"),
        _WHERE,
    ),
    Proof(
        "trum_regions",
        "time_redu time_addredu time_add " + _BOTH,
        "9 10",
        "oscillator's matrix exponential from switching to switching, displacement and velocity continuous",
        _regions,
        grid(f"{_CYCLE} a_A a_B b_A b_B"),
        _WHERE,
    ),
    Proof(
        "trum_region_phasors",
        _PHASORS,
        "9 10 12",
        "oscillator's matrix exponential from switching to switching, and the steady state, as phasors",
        lambda p, m: _region_phasors(p),  # noqa: ARG005
        grid(f"{_CYCLE} a_A a_B b_A b_B"),
        _WHERE,
    ),
    Proof(
        "trum_response",
        "w_A w_B v_A v_B Q Q_rate",
        "9 10 24 A5",
        "oscillator's matrix exponential and steady state; vector product at a point off the crest, its rate",
        _response,
        grid("D Delta_omega W a_A a_B b_A b_B g_A g_B k_c omega_n psi s tau xi", 8),
        _WHERE + ", gates on and off",
    ),
    Proof(
        "trum_measures",
        "q_ratio q_square_ratio q_average q_volatility",
        "43 44 A14 A16",
        "in the ratios X and Y",
        _measures,
        grid("T p_minus p_plus q_minus q_plus"),
        "random sums, X and Y to either side of 1",
        symbolic=True,
    ),
    Proof(
        "trum_start_periodic_slopes",
        directed(_STATES),
        "9 10",
        "difference quotients of the matrix exponential's fixed point",
        _periodic_slopes,
        grid(_CYCLE, 4),
        _WHERE,
    ),
    Proof(
        "trum_start_rest_slopes",
        directed(_STATES),
        "9 10",
        "difference quotients of the state that cancels the steady one",
        _rest_slopes,
        grid("Delta_omega W omega_n psi s", 4),
        _WHERE,
    ),
    Proof(
        "trum_regions_slopes",
        directed(_PHASORS),
        "9 10",
        "difference quotients of those phasors, by the matrix exponential",
        _regions_slopes,
        grid(f"{_CYCLE} {_STATES} {directed(_STATES)}", 4),
        _WHERE,
    ),
)
