"""Statements in words: what the text says about rotation, contact, periods and trends, held against the derivation.

A statement is written as the number that it asserts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp
from scipy.optimize import brentq

from derivations import transfer
from derivations.ledger.course import Lap, extremes, root_mean_square, share
from derivations.ledger.history import STARTS, history, region_edges, values
from derivations.ledger.judge import error_size, figure, largest, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import DRIVE, stator
from derivations.ledger.section_6 import forward
from derivations.ledger.witness import Drive
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

m, n, Delta_omega, omega_q, omega_n, k_N, k_c, n_j, F_c, T = sym("m n Delta_omega omega_q omega_n k_N k_c n_j F_c T")
X, Y = sym("X Y")
_HALF = sp.Rational(1, 2)


# --- half of the beat period --------------------------------------------------------------------------------
_SHARES: Forms = {"share_redu": _HALF, "share_addredu": _HALF}
_SECT_5 = Lap("steady", 100.0, 55.0)


def _whole_beats(pulses: float) -> float:
    """How long the whole beats of a stretch of drive pulses last, s."""
    p = values()
    beat = 2 * math.pi / p["Delta_omega"]
    return math.floor(pulses * 2 * math.pi / p["omega_q"] / beat) * beat


def _measured_shares() -> dict[str, float]:
    """Share of clockwise turning over the whole beats of T_redu and T_addredu by the roots of Q, as in Sect. 5."""
    found = {}
    for region, label in enumerate(_SHARES):
        low = region_edges(100.0, 55.0)[region]
        stretch = replace(_SECT_5, low=low, high=low + _whole_beats(100 - 55))
        found[label] = share(lambda h: h.q, stretch)
    return found


def _slow_share(difference: float, pulses: int, periods: int | None = None) -> float:
    """Forward share over the first whole beats of T_addredu: cos(Delta tau) > kappa exp(-sigma tau), by its roots.

    kappa = 1 - rho cos(Delta T_redu) is what is left of A's rest of T_redu against the drive, B's free motion 1.
    """
    p = values()
    beat, sigma = 2 * math.pi * difference, p["xi"] * p["omega_n"]
    length = pulses * 2 * math.pi / (p["omega_n"] + beat)
    kappa = 1 - math.exp(-sigma * length) * math.cos(beat * length)
    turns = math.floor(length * beat / (2 * math.pi)) if periods is None else periods
    total = 0.0
    for k in range(turns):  # one stretch of cos > 0 around every 2 pi k and half ones at the ends

        def ahead(turn: float) -> float:
            return math.cos(turn) - kappa * math.exp(-sigma * turn / beat)

        ends = np.linspace(2 * math.pi * k, 2 * math.pi * (k + 1), 2001)
        signs = [ahead(end) > 0 for end in ends]
        roots = [brentq(ahead, ends[i], ends[i + 1]) for i in range(2000) if signs[i] != signs[i + 1]]
        cuts = [ends[0], *roots, ends[-1]]
        total += float(sum(high - low for low, high in pairwise(cuts) if ahead((low + high) / 2) > 0))
    return float(total) / (2 * math.pi * turns) if turns else math.nan


def _derive_half() -> Derivation:
    delta, step_ = sp.symbols("delta Omega", real=True)
    slow = sp.sin(step_ + delta)
    forced, rest, turn = sp.exp(sp.I * step_), sp.Symbol("r", complex=True), sp.Symbol("g", positive=True)
    phase_a, phase_b = forced + (rest - 1) * turn, sp.I * turn
    product = sp.re(sp.expand(phase_b * sp.conjugate(phase_a) / sp.I))
    kappa = 1 - sp.re(rest)
    gap = sp.expand(product.rewrite(sp.cos) / turn - (sp.cos(step_) - kappa * turn), complex=True)
    found = _slow_share(_difference_hz(), 100 - 55)
    return Derivation(
        (
            step(
                "With constant amplitudes Q runs as the sine of the phases' difference (A8), which changes sign "
                "every half beat: forward and backward take half each.",
                slow,
                zero=sp.expand_trig(slow.subs(step_, step_ + sp.pi) + slow),
            ),
            step(
                "A decaying amplitude scales Q but does not move its zeros, so over whole beats of T_redu that stays "
                "so, up to the ripple of the sum frequency."
            ),
            step(
                "In T_addredu B is free, i g, where g is the decay since t_2, and A forced and free: at t_2 it is the "
                "rest r of T_redu. Against the drive's angle Omega, both over W, Q has the sign of",
                sp.cos(step_) - kappa * turn,
                zero=gap,
            ),
            step(
                "|r| is the decay over T_redu, below 1, so 1 - Re r > 0: Q is positive only where cos Omega > "
                "(1 - Re r) g > 0, which is less than half of every beat, whatever the drive. Forward never takes "
                "half. How much less depends on where in its beat the drive is at t_2, and on the decay."
            ),
            step(
                f"For Sect. 5's m = 100, n = 55 at 3000 Hz that is {found:.3f} of the whole beats; over other "
                "drives anything from 0 to below one half."
            ),
        ),
        {"share_redu": _HALF, "share_addredu": sp.Float(f"{found:.3f}")},
    )


def _repair_half(forms: Forms) -> Forms:
    """The share by the slow vectors in place of one half."""
    found = sp.Float(f"{_slow_share(_difference_hz(), 100 - 55):.3f}")
    return {**forms, "share_addredu": forms["share_addredu"] * 2 * found}


@cache
def _most_over_drives() -> tuple[float, float, int]:
    """Smallest and largest forward share over one beat of T_addredu from the exact Q, and of how many drives."""
    found = []
    for difference in np.linspace(2000, 5000, 13):
        for pulses in (30, 37, 45, 60):
            states = Drive("steady", 2 * pulses, pulses, float(difference))
            f_q = float(stator(DRIVE["F_c"])["omega_n"]) / (2 * math.pi) + float(difference)
            low = pulses / f_q
            time = low + (np.arange(20000) + 0.5) / 20000 * min(1 / float(difference), low)
            found.append(float((states.phases(time).q > 0).mean()))
    return min(found), max(found), len(found)


def _judge_half(forms: Forms) -> Iterator[Evidence]:
    exact = _measured_shares()
    listed = ", ".join(f"{key} {value:.3f}" for key, value in exact.items())
    yield evidence(
        "numeric",
        all(abs(float(forms[key]) - exact[key]) < 0.01 for key in forms),
        f"share of forward turning over whole beats, by the roots of the exact Q: {listed}",
    )
    low, high, count = _most_over_drives()
    yield evidence(
        "limit",
        float(forms["share_addredu"]) < 0.5 and high < 0.5,
        "forward takes less than half of the first beat of T_addredu: over "
        f"{count} drives, 2000 to 5000 Hz and 30 to 60 pulses, {low:.3f} to {high:.3f} of it",
    )


def _effect_half() -> str:
    parts = []
    for start in STARTS:
        regions = [100 * share(forward, Lap(start).region(region)) for region in range(3)]
        parts.append(f"{start} {' / '.join(figure(part, 3) for part in regions)} %")
    p = values()
    beats = (p["m"] - p["n"]) * _difference_hz() / (p["omega_q"] / (2 * math.pi))
    return (
        f"At Table 3 T_redu lasts {figure(beats, 3)} of a beat, so no beat is completed. Forward in the three regions, "
        f"phase lead +1: {'; '.join(parts)}; from rest Q is 0 all through T_redu."
    )


def _difference_hz() -> float:
    return values()["Delta_omega"] / (2 * math.pi)


# --- vertical velocity at the crest -------------------------------------------------------------------------
_RATE = (transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B)
_CREST: Forms = {"zeta_z_rate": sp.Integer(0) * transfer.v_A}


def _derive_crest() -> Derivation:
    rate = transfer.wave_states()[transfer.W_c_rate]
    A, B, vA, vB = transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B
    sine, cosine = A / sp.sqrt(A**2 + B**2), B / sp.sqrt(A**2 + B**2)
    return Derivation(
        (
            step(
                "The crest is where the slope d(zeta_z)/dx vanishes (eq. 20); the vertical velocity there is "
                "w_A' sin(k_c x_max) + w_B' cos(k_c x_max):",
                vA * sine + vB * cosine,
                zero=sp.expand(vA * sine + vB * cosine - rate),
            ),
            step(
                "the rate of the crest's height, which is 0 only if the height does not change: in a steady wave, "
                "not in a beat.",
                rate,
            ),
        ),
        {"zeta_z_rate": rate},
    )


def _judge_crest(forms: Forms) -> Iterator[Evidence]:
    form = forms["zeta_z_rate"]
    worst = 0.0
    for A, B, vA, vB in ((4e-6, 3e-6, 0.5, -0.2), (-2e-6, 5e-6, 0.9, 0.4), (1e-6, -6e-6, -1.1, 0.3)):
        h = 1e-9
        height = [math.hypot(A + side * h * vA, B + side * h * vB) for side in (-1, 1)]
        found = complex(form.subs(dict(zip(_RATE, (A, B, vA, vB), strict=True))))
        worst = worse(worst, abs(found - (height[1] - height[0]) / (2 * h)))
    yield evidence("numeric", worst < 1e-6, f"the crest's height by differences in time: off by {worst:.2g} m/s")
    steady = form.subs({transfer.v_A: transfer.w_B, transfer.v_B: -transfer.w_A})
    yield evidence("limit", sp.simplify(steady) == 0, "0 in a steady wave")


def _effect_crest() -> str:
    p, lap = values(), Lap()
    climb = max(abs(end) for end in extremes(lambda h: h.W_c_rate, lap))
    surface = p["D"] * p["k_c"] * extremes(lambda h: np.hypot(h.v_A, h.v_B), lap)[1]
    usual = root_mean_square(lambda h: h.W_c_rate, lap)
    return (
        f"At Table 3, periodic, phase lead +1, the crest moves vertically at up to {figure(1e3 * climb, spec='.0f')} "
        f"mm/s and {figure(1e3 * usual, spec='.0f')} mm/s rms, where the largest tangential velocity is "
        f"{figure(1e3 * surface, spec='.0f')} mm/s. The condition printed beside it, d(zeta_z)/dx = 0, is the right "
        "one."
    )


# --- proportional to the speed ------------------------------------------------------------------------------
_POWERS: Forms = {"power_of_W": sp.Integer(1), "power_of_v_xmax": sp.Integer(1)}


def _balanced(zone: float) -> float:
    """Cos a, where the stretch |u| < a of a steady wave's contact carries half of the load: no net friction."""
    carried = math.sin(zone) - zone * math.cos(zone)
    return math.cos(brentq(lambda a: math.sin(a) - a * math.cos(zone) - carried / 2, 0.0, zone))


def _power_at(height: float, force: float) -> float:
    """D log(speed)/d log(W) of a rotor without load on a steady wave, by the balance's differentials."""
    p = values()
    load = force * p["k_c"] / (2 * p["n_j"] * p["k_N"] * height)
    zone = brentq(lambda at: math.sin(at) - at * math.cos(at) - load, 1e-6, math.pi)
    a = math.acos(_balanced(zone))
    # sin a - a cos zone = load/2 and sin zone - zone cos zone = load, with d load = -load d log W
    d_zone = -load / (zone * math.sin(zone))
    d_a = (-load / 2 - a * math.sin(zone) * d_zone) / (math.cos(a) - math.cos(zone))
    return float(1 - math.tan(a) * d_a)


def _derive_power() -> Derivation:
    W, omega, angle = sp.symbols("W Omega alpha", positive=True)
    steady = {
        transfer.w_A: W * sp.sin(angle),
        transfer.w_B: W * sp.cos(angle),
        transfer.v_A: W * omega * sp.cos(angle),
        transfer.v_B: -W * omega * sp.sin(angle),
    }
    states = {key: sp.simplify(value.subs(steady)) for key, value in transfer.wave_states().items()}
    speed = sp.simplify(transfer.surface_speed().subs(transfer.u, 0).subs(states))
    product = sp.simplify(speed * states[transfer.W_c])
    a, zone = sp.symbols("a theta", positive=True)
    balance = transfer.steady_wave_fraction().subs(sym("theta")[0], zone)
    own = next(s for s in balance.free_symbols if s.name == "a")
    balance = balance.subs(own, a)
    half = 2 * (sp.sin(a) - a * sp.cos(zone)) - (sp.sin(zone) - zone * sp.cos(zone))
    short = sp.Rational(3, 2) * a - sp.Rational(1, 2) * a**3  # a over theta: share of a parabola's load inside
    return Derivation(
        (
            step(
                "In a steady wave of amplitude W the crest runs at", speed, zero=sp.simplify(W * speed.diff(W) - speed)
            ),
            step(
                "so both parameters are one: v_xmax grows as W. A rotor without load runs at v_xmax cos(a), where the "
                "faster stretch |u| < a of the contact carries half of the load:",
                sp.Eq(half, 0),
                zero=sp.simplify(balance * (sp.sin(zone) - zone * sp.cos(zone)) - half),
            ),
            step(
                "a follows theta, which a higher wave makes smaller under the same prepressure; so the rotor gains a "
                "little more than the surface. In a short contact a/theta is the root of",
                sp.Eq(short, _HALF),
                zero=sp.Rational(3, 2) * 2 * sp.sin(sp.pi / 18)
                - sp.Rational(1, 2) * (2 * sp.sin(sp.pi / 18)) ** 3
                - sp.sin(sp.pi / 6),
            ),
            step(
                "and cos(a) tends to 1: proportional in the limit, and by how much not is under Evidence. The "
                "product of both parameters, Q, goes as W squared, so it grows as the square of that speed; it gives "
                "the direction.",
                product,
                zero=sp.simplify(W * product.diff(W) - 2 * product),
            ),
        ),
        _POWERS,
    )


def _free_speed(height: float, force: float) -> float:
    """Speed over v_xmax at which friction summed over a sampled contact vanishes, on a steady wave of a height."""
    _, depth = _settled(height, force)
    zone = math.acos(1 - depth / height)
    u = (np.arange(200000) + 0.5) / 200000 * zone
    press = np.cos(u) - math.cos(zone)
    carried = np.cumsum(press) / press.sum()
    return math.cos(float(np.interp(0.5, carried, u + zone / 400000)))


def _judge_power(forms: Forms) -> Iterator[Evidence]:
    p, h = values(), 0.02
    heights = p["W"] * math.exp(-h), p["W"] * math.exp(h)
    slope = (math.log(_free_speed(heights[1], p["F_c"]) / _free_speed(heights[0], p["F_c"])) + 2 * h) / (2 * h)
    off = largest(abs(float(form) - slope) for form in forms.values())
    yield evidence(
        "numeric",
        off < 0.02,
        f"on a steady wave twice as high at one percent the speed of a free rotor "
        f"grows by the power {slope:.4f} of the height, friction summed over the settled "
        "contact",
    )
    both = sp.simplify(forms["power_of_W"] - forms["power_of_v_xmax"])
    yield evidence("identity", both == 0, "in a steady wave v_xmax grows as W, so both powers are the same")

    def sizes() -> tuple[float, float]:
        stated = float(forms["power_of_W"])
        grid = [stated / _power_at(W, force) - 1 for W in np.linspace(3e-6, 9e-6, 7) for force in (100, 160, 220)]
        return stated / _power_at(p["W"], p["F_c"]) - 1, largest(abs(g) for g in grid)

    def narrow() -> float:
        return float(forms["power_of_W"]) / _power_at(p["W"], p["F_c"] / 100) - 1

    yield error_size(
        "the power of the speed, W from 3 to 9 um and 100 to 220 N,", sizes, "a narrow contact, F_c -> 0", narrow
    )


def _effect_power() -> str:
    light, heavy = (stator(force) for force in (160, 210))
    p, ratio = values(), float(heavy["W"] / light["W"])
    return (
        f"On a steady wave at Table 3 a rotor without load runs at {figure(_balanced(p['theta']))} of v_xmax, and its "
        f"speed goes as W to the power {figure(_power_at(p['W'], p['F_c']))}: nearly proportional, to each of the two "
        f"and not to their product. From 160 to 210 N the amplitude falls by {figure(100 * (1 - ratio), spec='.1f')} "
        "%; "
        f"the crest's speed with it, Q by {figure(100 * (1 - ratio**2), spec='.1f')} %. Q_aver and Q_vib do not depend "
        "on the amplitude at all."
    )


# --- always in contact --------------------------------------------------------------------------------------
_CONTACT: Forms = {"share_in_contact": sp.Integer(1)}


def _derive_contact() -> Derivation:
    W_c, theta = transfer.W_c, sym("theta")[0]
    depth = W_c * (1 - sp.cos(theta))
    load = 2 * n_j * k_N * W_c / k_c * (sp.sin(theta) - theta * sp.cos(theta))
    return Derivation(
        (
            step("A layer that carries F_c > 0 touches somewhere, and the crest is highest:", depth, sp.Eq(F_c, load)),
            step(
                "The load grows with theta, so there is one theta for every W_c, up to theta = pi:",
                load.diff(theta),
                zero=load.diff(theta) - 2 * n_j * k_N * W_c / k_c * theta * sp.sin(theta),
            ),
            step(
                "Below a height of F_c k_c/(2 pi n_j k_N) even theta = pi cannot carry it, and the whole wave is in "
                "contact:",
                F_c * k_c / (2 * sp.pi * n_j * k_N),
                zero=sp.simplify(load.subs(theta, sp.pi).subs(W_c, F_c * k_c / (2 * sp.pi * n_j * k_N)) - F_c),
            ),
        ),
        _CONTACT,
    )


def _threshold() -> float:
    p = values()
    return p["F_c"] * p["k_c"] / (2 * math.pi * p["n_j"] * p["k_N"])


def _settled(W_c: float, load: float) -> tuple[float, float]:
    """Where the sampled wave stands deepest in the layer that carries the load, and how deep."""
    p = values()
    u = np.linspace(-np.pi, np.pi, 7201)[:-1]
    wave = W_c * np.cos(u)
    low, high = -W_c - load * p["k_c"] / (2 * np.pi * p["n_j"] * p["k_N"]), W_c  # carries more than the load; nothing
    for _ in range(80):
        level = (low + high) / 2
        carried = p["n_j"] * p["k_N"] / p["k_c"] * 2 * np.pi * float(np.maximum(0, wave - level).mean())
        low, high = (low, level) if carried < load else (level, high)
    if abs(carried - load) > 1e-6 * load:
        return math.nan, math.nan
    deepest = int(np.argmax(wave - level))
    return float(u[deepest]), float(wave[deepest] - level)


def _judge_contact(forms: Forms) -> Iterator[Evidence]:
    load = values()["F_c"]
    settled = [_settled(float(W_c), load) for start in STARTS for W_c in history(start).W_c[::200]]
    share = float(np.mean([abs(at) < 1e-3 and depth > 0 for at, depth in settled]))
    yield evidence(
        "numeric",
        abs(float(forms["share_in_contact"]) - share) < 1e-12,
        "the layer lowered until it carries the load stands deepest on the crest at every moment, under "
        f"any start: {100 * share:.0f} %",
    )
    depths = [_settled(values()["W"], factor * load)[1] for factor in (0.5, 1.0)]
    power = math.log(depths[1] / depths[0]) / math.log(2)
    yield evidence(
        "limit",
        abs(power - 2 / 3) < 0.02,
        f"the depth grows as the load to the power {power:.3f}, 2/3 for a short contact: it ends at no "
        "load, not before",
    )


def _effect_contact() -> str:
    parts = [f"{start} {figure(1e9 * extremes(lambda h: h.W_c, Lap(start))[0], 3)} nm" for start in STARTS[:2]]
    return (
        "True for a constant prepressure, without the rotor's own inertia upward. Within a cycle of Table 3, phase "
        f"lead +1, the crest's height falls to {', '.join(parts)}, and it begins at 0 from rest; below "
        f"{figure(1e9 * _threshold(), 3)} nm the whole wave touches."
    )


# --- T_Qall almost constant ---------------------------------------------------------------------------------
_CONSTANT: Forms = {"T_over_T": sp.Integer(1)}


def _period(force: int, difference: float) -> float:
    point = stator(force)
    return float(point["m"]) / (float(point["omega_n"]) / (2 * math.pi) + difference)


def _derive_constant() -> Derivation:
    period = 2 * sp.pi * m / (omega_n + Delta_omega)
    change = sp.simplify(period.diff(Delta_omega) * Delta_omega / period)
    return Derivation(
        (
            step("T_Qall is m periods of the drive:", period),
            step(
                "It changes with Delta omega by its share of the drive's frequency:",
                change,
                zero=change + Delta_omega / (omega_n + Delta_omega),
            ),
        ),
        _CONSTANT,
    )


def _judge_constant(forms: Forms) -> Iterator[Evidence]:
    stated = float(forms["T_over_T"])
    over_f, over_p = (_period(180, 3300) / _period(180, 2800), _period(210, 3000) / _period(160, 3000))
    worst = largest(abs(stated / found - 1) for found in (over_f, over_p))
    closer = stated / (_period(180, 2805) / _period(180, 2800)) - 1
    yield error_size(
        f"T (at 3300 over 2800 Hz {over_f:.5f}, at 210 over 160 N {over_p:.5f})",
        lambda: (float(worst), float(worst)),
        "a narrow range of frequency differences",
        lambda: float(closer),
    )
    yield evidence("limit", stated == 1, "no change of the drive, no change of T")


def _effect_constant() -> str:
    return (
        f"T_Qall changes by {figure(100 * (_period(180, 3300) / _period(180, 2800) - 1), spec='+.2f')} % from 2800 to "
        f"3300 Hz and by {figure(100 * (_period(210, 3000) / _period(160, 3000) - 1), spec='+.3f')} % from 160 to 210 "
        f"N; Q_aver and Q_vib "
        f"change as 1/T."
    )


# --- one beat period in T_reduT -----------------------------------------------------------------------------
_BEATS: Forms = {"beats_in_T_redu": sp.Integer(1)}


def _derive_beats() -> Derivation:
    beats = (m - n) * Delta_omega / omega_q
    return Derivation(
        (
            step(
                "T_redu lasts m - n drive periods, a beat 2 pi/Delta omega:",
                beats,
                zero=beats - (m - n) * 2 * sp.pi / omega_q / (2 * sp.pi / Delta_omega),
            ),
        ),
        {"beats_in_T_redu": beats},
    )


def _judge_beats(forms: Forms) -> Iterator[Evidence]:
    h = history("steady", 60000, 100.0, 55.0)
    q = h.q[h.region == 0]
    turns = int((np.sign(q[1:]) != np.sign(q[:-1])).sum())
    at = {m: 100, n: 55, Delta_omega: values()["Delta_omega"], omega_q: values()["omega_q"]}
    found = float(forms["beats_in_T_redu"].subs(at))
    yield evidence(
        "numeric",
        abs(found - turns / 2) < 0.5,
        f"Q changes sign {turns} times in T_redu for m = 100, n = 55 (steady start): {turns / 2:.1f} "
        f"beats; stated {found:.2f}",
    )
    longer = float(forms["beats_in_T_redu"].subs({**at, m: 145})) / found
    yield evidence("limit", abs(longer - 2) < 1e-12, "twice the pulses, twice the beats")


def _effect_beats() -> str:
    form = _derive_beats().forms["beats_in_T_redu"]
    p = values()
    at = {Delta_omega: p["Delta_omega"], omega_q: p["omega_q"]}
    return (
        f"{figure(float(form.subs({**at, m: 100, n: 55})))} beats at Sect. 5's m = 100, n = 55; "
        f"{figure(float(form.subs({**at, m: 20, n: 14})))} of a beat at Table 3. Figs. 10 and 11 show one of them."
    )


# --- beat period in T_addT ----------------------------------------------------------------------------------
_ADD: Forms = {"T_beat": 4 * sp.pi / (omega_q + omega_n)}


def _derive_add() -> Derivation:
    t = sym("t")[0]
    total = sp.cos(omega_q * t) + sp.cos(omega_n * t)
    product = 2 * sp.cos((omega_q + omega_n) * t / 2) * sp.cos((omega_q - omega_n) * t / 2)
    form = 2 * sp.pi / (omega_q - omega_n)
    return Derivation(
        (
            step(
                "Forced and free vibration added are a carrier times an envelope:",
                sp.Eq(total, product),
                zero=sp.expand((total - product).rewrite(sp.exp)),
            ),
            step("4 pi/(omega_q + omega_n) is the carrier's period; the envelope's magnitude repeats after", form),
        ),
        {"T_beat": form},
    )


def _repair_add(forms: Forms) -> Forms:
    """Half the difference of the frequencies in place of half their sum, as the envelope's magnitude has it."""
    return {"T_beat": forms["T_beat"] * (omega_q + omega_n) / (2 * (omega_q - omega_n))}


def _judge_add(forms: Forms) -> Iterator[Evidence]:
    p = values()
    time = np.linspace(0, 1e-3, 400001)
    size = np.abs(np.exp(1j * p["omega_q"] * time) + np.exp(1j * p["omega_n"] * time))
    nodes = time[1:-1][(size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:])]
    seen = float(np.diff(nodes).mean())
    found = float(forms["T_beat"].subs({omega_q: p["omega_q"], omega_n: p["omega_n"]}))
    yield evidence(
        "numeric",
        abs(found / seen - 1) < 1e-4,
        f"nodes of two added vibrations follow every {1e6 * seen:.1f} us; stated {1e6 * found:.1f} us",
    )
    near = abs(float(forms["T_beat"].subs({omega_q: 1.000001, omega_n: 1})))
    yield evidence("limit", near > 1e6, "grows without bound as the frequencies meet")


def _effect_add() -> str:
    p = values()
    carrier = float(_ADD["T_beat"].subs({omega_q: p["omega_q"], omega_n: p["omega_n"]}))
    beat = 2 * math.pi / p["Delta_omega"]
    return (
        f"{figure(1e6 * carrier, spec='.2f')} us at Table 3, the vibration's own period; the beat is "
        f"{figure(beat / carrier, spec='.1f')} times as long, in T_add as in the other regions (15)."
    )


def _entry(identifier: str, **fields: Any) -> Entry:  # noqa: ANN401
    return Entry(id=identifier, **{"units": {}, **fields})


ENTRIES = (
    _entry(
        "claim-half-beat",
        section="3.5",
        place="Sect. 3.5, Appendix A",
        printed=_SHARES,
        verdict="erratum",
        title="'The time for both phases is half of the beat period'",
        judge=_judge_half,
        derive=_derive_half,
        effect=_effect_half,
        repair=_repair_half,
        found_by=("numeric", "limit"),
        reason="True for constant amplitudes and, over whole beats, in T_redu; in T_addredu forward turning takes less "
        "than half of every beat, whatever the drive, and how much less depends on the drive.",
    ),
    _entry(
        "claim-crest",
        section="3.4",
        place="Sect. 3.4",
        title="'At the wave peak the vertical velocity is zero'",
        printed=_CREST,
        verdict="erratum",
        judge=_judge_crest,
        derive=_derive_crest,
        effect=_effect_crest,
        repair=lambda _: _derive_crest().forms,
        found_by=("numeric",),
        units={},
        known=transfer.DIMENSIONS,
        reason="The slope is zero at the crest; the vertical velocity is the rate of its height, zero all the time "
        "only where the height does not change, as in a steady wave.",
    ),
    _entry(
        "claim-proportional",
        section="6.1",
        place="below eq. 42",
        printed=_POWERS,
        verdict="approximation",
        title="Amplitude and tangential velocity are 'directly proportional to the rotor speed'",
        judge=_judge_power,
        derive=_derive_power,
        effect=_effect_power,
        reason="Said of the amplitude and of the tangential velocity at the crest, not of their product. On a steady "
        "wave, without load, each holds nearly; then the product Q grows as the square of the speed.",
    ),
    _entry(
        "claim-contact",
        section="5.3",
        place="Sects. 3.1, 5.3",
        title="The crest 'is always in contact'",
        printed=_CONTACT,
        verdict="verified",
        judge=_judge_contact,
        derive=_derive_contact,
        effect=_effect_contact,
        reason="Under a constant prepressure the crest always stands in the layer.",
    ),
    _entry(
        "claim-T_Qall",
        section="6.2",
        place="Sects. 6.2.1, 6.2.2",
        title="T_Qall 'remains almost constant'",
        printed=_CONSTANT,
        verdict="approximation",
        judge=_judge_constant,
        derive=_derive_constant,
        effect=_effect_constant,
        reason="It changes by about one per cent over the range of frequency differences.",
    ),
    _entry(
        "claim-one-beat",
        section="5.2.1",
        place="Sect. 5.2.1",
        title="'One beat period in T_reduT'",
        printed=_BEATS,
        verdict="erratum",
        judge=_judge_beats,
        derive=_derive_beats,
        effect=_effect_beats,
        repair=lambda _: _derive_beats().forms,
        found_by=("numeric", "limit"),
        reason="With m = 100 and n = 55 there are more than three.",
    ),
    _entry(
        "claim-add-beat",
        section="5.2.3",
        place="Sect. 5.2.3",
        title="Beat period in T_addT",
        printed=_ADD,
        units={"T_beat": "s"},
        verdict="erratum",
        judge=_judge_add,
        derive=_derive_add,
        effect=_effect_add,
        repair=_repair_add,
        found_by=("numeric", "limit"),
        reason="4 pi/(omega_q + omega_n) is the period of the vibration itself, not of its envelope, which "
        "repeats with the whole difference of the frequencies, as (15) put right has it for the two phases.",
    ),
)
