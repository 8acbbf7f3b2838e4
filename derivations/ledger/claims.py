"""Statements in words: what the text says about rotation, contact, periods and trends, held against the derivation.

A statement is written as the number that it asserts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import sympy as sp

from derivations import transfer
from derivations.ledger.history import STARTS, history, values
from derivations.ledger.judge import error_size, figure, largest, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import stator
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

m, n, Delta_omega, omega_q, omega_n, k_N, k_c, n_j, F_c, T = sym("m n Delta_omega omega_q omega_n k_N k_c n_j F_c T")
X, Y = sym("X Y")
_HALF = sp.Rational(1, 2)


# --- half of the beat period --------------------------------------------------------------------------------
_SHARES: Forms = {"share_redu": _HALF, "share_addredu": _HALF}


@cache
def _forward_shares() -> dict[str, float]:
    """Share of clockwise turning over the whole beats of T_redu and T_addredu, m = 100, n = 55, as in Sect. 5."""
    h = history("steady", 60000, 100.0, 55.0)
    found = {}
    for region, label in enumerate(_SHARES):
        here = h.region == region
        time = h.time[here] - h.time[here][0]
        whole = math.floor(time[-1] * _difference_hz()) / _difference_hz()
        found[label] = float((h.q[here][time < whole] > 0).mean())
    return found


def _difference_hz() -> float:
    return values()["Delta_omega"] / (2 * math.pi)


def _derive_half() -> Derivation:
    delta, step_ = sp.symbols("delta Omega", real=True)
    slow = sp.sin(step_ + delta)
    found = _forward_shares()
    return Derivation(
        (
            step("With constant amplitudes Q runs as the sine of the phases' difference (A8), which changes sign "
                 "every half beat: forward and backward take half each.", slow,
                 zero=sp.expand_trig(slow.subs(step_, step_ + sp.pi) + slow)),
            step("A decaying amplitude scales Q but does not move its zeros, so in T_redu that stays so; measured on "
                 f"the exact Q over whole beats, {found['share_redu']:.3f}."),
            step("In T_addredu phase A vibrates at two frequencies, its own free one and the drive's, while B is "
                 "free: the part at equal frequencies adds a constant to the sine and shifts its zeros; "
                 f"{found['share_addredu']:.3f}."),
        ),
        {key: sp.Float(f"{value:.3f}") for key, value in found.items()},
    )  # fmt: skip


def _phasor_shares() -> dict[str, float]:
    """The same shares from slow phasors alone: w = Re(z exp(i omega_n t)), Q ~ Im(z_B conj(z_A))."""
    p = values()
    beat, decay = p["Delta_omega"], p["xi"] * p["omega_n"]
    pulses = 100 - 55
    time = np.linspace(0, pulses / (p["omega_q"] / (2 * math.pi)), 60001)
    whole = time < math.floor(time[-1] * beat / (2 * math.pi)) * 2 * math.pi / beat
    free, forced = np.exp(-decay * time), np.exp(1j * beat * time)
    redu = (1j * forced * np.conj(free))[whole].imag > 0
    at_switch = free[-1] * np.exp(-1j * beat * time[-1])  # phase A's rest, seen from the drive's phase at t2
    phase_a = forced + (at_switch - 1) * free
    addredu = (1j * free * np.conj(phase_a))[whole].imag > 0
    return {"share_redu": float(redu.mean()), "share_addredu": float(addredu.mean())}


def _repair_half(forms: Forms) -> Forms:
    """The measured share in place of one half."""
    return {**forms, "share_addredu": forms["share_addredu"] * 2 * sp.Float(_forward_shares()["share_addredu"])}


def _judge_half(forms: Forms) -> Iterator[Evidence]:
    exact, slow = _forward_shares(), _phasor_shares()
    listed = ", ".join(f"{key} {value:.3f}" for key, value in exact.items())
    yield evidence("numeric", all(abs(float(forms[key]) - exact[key]) < 0.005 for key in forms),
                   f"share of forward turning over whole beats, from the exact Q: {listed}")  # fmt: skip
    listed = ", ".join(f"{key} {value:.3f}" for key, value in slow.items())
    yield evidence("limit", all(abs(float(forms[key]) - slow[key]) < 0.02 for key in forms),
                   f"the same from slow phasors, without ripple: {listed}")  # fmt: skip


def _effect_half() -> str:
    shares = []
    for start in STARTS:
        h = history(start)
        parts = [f"{100 * float((h.q[h.region == region] > 0).mean()):.0f}" for region in range(3)]
        shares.append(f"{start} {' / '.join(parts)} %")
    p = values()
    beats = (p["m"] - p["n"]) * _difference_hz() / (p["omega_q"] / (2 * math.pi))
    return (
        f"At Table 3 T_redu lasts {figure(beats, 3)} of a beat, so no beat is completed. Forward in the three regions, "
        f"phase lead +1: {'; '.join(shares)}."
    )


# --- vertical velocity at the crest -------------------------------------------------------------------------
_RATE = (transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B)
_CREST: Forms = {"zeta_z_rate": sp.Integer(0) * transfer.v_A}


def _derive_crest() -> Derivation:
    rate = transfer.wave_states()[transfer.W_c_rate]
    A, B, vA, vB = transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B
    sine, cosine = A / sp.sqrt(A**2 + B**2), B / sp.sqrt(A**2 + B**2)
    return Derivation(
        (
            step("The crest is where the slope d(zeta_z)/dx vanishes (eq. 20); the vertical velocity there is "
                 "w_A' sin(k_c x_max) + w_B' cos(k_c x_max):", vA * sine + vB * cosine,
                 zero=sp.expand(vA * sine + vB * cosine - rate)),
            step("the rate of the crest's height, which is 0 only if the height does not change: in a steady wave, "
                 "not in a beat.", rate),
        ),
        {"zeta_z_rate": rate},
    )  # fmt: skip


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
    h = history()
    p = values()
    return (
        f"At Table 3 (periodic) the crest moves vertically at up to {1e3 * float(np.abs(h.W_c_rate).max()):.0f} mm/s "
        f"and {1e3 * float(np.sqrt((h.W_c_rate**2).mean())):.0f} mm/s rms, where the largest tangential velocity is "
        f"{1e3 * p['D'] * p['k_c'] * float(np.hypot(h.v_A, h.v_B).max()):.0f} mm/s. The condition printed beside it, "
        "d(zeta_z)/dx = 0, is the right one."
    )


# --- proportional to the speed ------------------------------------------------------------------------------
_POWERS: Forms = {"power_of_W_in_Q": sp.Integer(1), "power_of_W_in_v": sp.Integer(1)}


def _derive_power() -> Derivation:
    W, omega, angle = sp.symbols("W Omega alpha", positive=True)
    steady = {transfer.w_A: W * sp.sin(angle), transfer.w_B: W * sp.cos(angle),
              transfer.v_A: W * omega * sp.cos(angle), transfer.v_B: -W * omega * sp.sin(angle)}  # fmt: skip
    states = {key: sp.simplify(value.subs(steady)) for key, value in transfer.wave_states().items()}
    speed = sp.simplify(transfer.surface_speed().subs(transfer.u, 0).subs(states))
    product = sp.simplify(speed * states[transfer.W_c])
    powers = [sp.simplify(W * f.diff(W) / f) for f in (product, speed)]
    return Derivation(
        (
            step("In a steady wave of amplitude W the crest runs at", speed),
            step("and Q is that times W, so it grows as the square where the speed grows as W:", product,
                 zero=(powers[0] - 2, powers[1] - 1)),
        ),
        {"power_of_W_in_Q": powers[0], "power_of_W_in_v": powers[1]},
    )  # fmt: skip


def _judge_power(forms: Forms) -> Iterator[Evidence]:
    p = values()
    sizes = np.array([3e-6, 6e-6])
    crest = p["D"] * p["k_c"] * p["omega_q"] * sizes
    wave = [sizes[i] * np.array([math.sin(0.3), math.cos(0.3)]) for i in (0, 1)]
    rates = [p["omega_q"] * sizes[i] * np.array([math.cos(0.3), -math.sin(0.3)]) for i in (0, 1)]
    Q = np.array([p["D"] * p["k_c"] * (r[0] * w[1] - r[1] * w[0]) for w, r in zip(wave, rates, strict=True)])
    grows = [float(np.log(f[1] / f[0]) / math.log(2)) for f in (Q, crest)]
    off = largest(abs(float(form) - found) for form, found in zip(forms.values(), grows, strict=True))
    yield evidence(
        "numeric", off < 1e-9, f"twice the amplitude: Q grows by 2^{grows[0]:.0f}, the speed by 2^{grows[1]:.0f}"
    )
    product = forms["power_of_W_in_Q"] - forms["power_of_W_in_v"]
    yield evidence("identity", product == 1, "Q is the speed times a height (eq. 42), one power more")


def _effect_power() -> str:
    light, heavy = (stator(force) for force in (160, 210))
    ratio = float(heavy["W"] / light["W"])
    return (
        f"From 160 to 210 N the amplitude falls by {100 * (ratio - 1):.1f} %; the crest's speed with it, Q by "
        f"{100 * (ratio**2 - 1):.1f} %. Q_aver and Q_vib do not depend on the amplitude at all."
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
            step("The load grows with theta, so there is one theta for every W_c, up to theta = pi:",
                 load.diff(theta), zero=load.diff(theta) - 2 * n_j * k_N * W_c / k_c * theta * sp.sin(theta)),
            step("Below a height of F_c k_c/(2 pi n_j k_N) even theta = pi cannot carry it, and the whole wave is in "
                 "contact:", F_c * k_c / (2 * sp.pi * n_j * k_N),
                 zero=sp.simplify(load.subs(theta, sp.pi).subs(W_c, F_c * k_c / (2 * sp.pi * n_j * k_N)) - F_c)),
        ),
        _CONTACT,
    )  # fmt: skip


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
    yield evidence("numeric", abs(float(forms["share_in_contact"]) - share) < 1e-12,
                   "the layer lowered until it carries the load stands deepest on the crest at every moment, under "
                   f"any start: {100 * share:.0f} %")  # fmt: skip
    depths = [_settled(values()["W"], factor * load)[1] for factor in (0.5, 1.0)]
    power = math.log(depths[1] / depths[0]) / math.log(2)
    yield evidence("limit", abs(power - 2 / 3) < 0.02,
                   f"the depth grows as the load to the power {power:.3f}, 2/3 for a short contact: it ends at no "
                   "load, not before")  # fmt: skip


def _effect_contact() -> str:
    parts = [f"{start} {1e9 * float(history(start).W_c.min()):.3g} nm" for start in STARTS]
    return (
        "True for a constant prepressure, without the rotor's own inertia upward. The crest's height falls to "
        f"{', '.join(parts)} within a cycle of Table 3; below {1e9 * _threshold():.3g} nm the whole wave touches."
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
            step("It changes with Delta omega by its share of the drive's frequency:", change,
                 zero=change + Delta_omega / (omega_n + Delta_omega)),
        ),
        _CONSTANT,
    )  # fmt: skip


def _judge_constant(forms: Forms) -> Iterator[Evidence]:
    stated = float(forms["T_over_T"])
    over_f, over_p = (_period(180, 3300) / _period(180, 2800), _period(210, 3000) / _period(160, 3000))
    worst = largest(abs(stated / found - 1) for found in (over_f, over_p))
    closer = stated / (_period(180, 2805) / _period(180, 2800)) - 1
    yield error_size(
        f"T (at 3300 over 2800 Hz {over_f:.5f}, at 210 over 160 N {over_p:.5f})",
        lambda: (float(worst), float(worst)), "a narrow range of frequency differences", lambda: float(closer),
    )  # fmt: skip
    yield evidence("limit", stated == 1, "no change of the drive, no change of T")


def _effect_constant() -> str:
    return (
        f"T_Qall changes by {100 * (_period(180, 3300) / _period(180, 2800) - 1):+.2f} % from 2800 to 3300 Hz and by "
        f"{100 * (_period(210, 3000) / _period(160, 3000) - 1):+.3f} % from 160 to 210 N; Q_aver and Q_vib "
        f"change as 1/T."
    )


# --- one beat period in T_reduT -----------------------------------------------------------------------------
_BEATS: Forms = {"beats_in_T_redu": sp.Integer(1)}


def _derive_beats() -> Derivation:
    beats = (m - n) * Delta_omega / omega_q
    return Derivation(
        (
            step("T_redu lasts m - n drive periods, a beat 2 pi/Delta omega:", beats,
                 zero=beats - (m - n) * 2 * sp.pi / omega_q / (2 * sp.pi / Delta_omega)),
        ),
        {"beats_in_T_redu": beats},
    )  # fmt: skip


def _judge_beats(forms: Forms) -> Iterator[Evidence]:
    h = history("steady", 60000, 100.0, 55.0)
    q = h.q[h.region == 0]
    turns = int((np.sign(q[1:]) != np.sign(q[:-1])).sum())
    at = {m: 100, n: 55, Delta_omega: values()["Delta_omega"], omega_q: values()["omega_q"]}
    found = float(forms["beats_in_T_redu"].subs(at))
    yield evidence("numeric", abs(found - turns / 2) < 0.5,
                   f"Q changes sign {turns} times in T_redu for m = 100, n = 55 (steady start): {turns / 2:.1f} "
                   f"beats; stated {found:.2f}")  # fmt: skip
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
            step("Forced and free vibration added are a carrier times an envelope:", sp.Eq(total, product),
                 zero=sp.expand((total - product).rewrite(sp.exp))),
            step("4 pi/(omega_q + omega_n) is the carrier's period; the envelope's magnitude repeats after", form),
        ),
        {"T_beat": form},
    )  # fmt: skip


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
    yield evidence("numeric", abs(found / seen - 1) < 1e-4,
                   f"nodes of two added vibrations follow every "
                   f"{1e6 * seen:.1f} us; "
                   f"stated {1e6 * found:.1f} us")  # fmt: skip
    near = abs(float(forms["T_beat"].subs({omega_q: 1.000001, omega_n: 1})))
    yield evidence("limit", near > 1e6, "grows without bound as the frequencies meet")


def _effect_add() -> str:
    p = values()
    carrier = float(_ADD["T_beat"].subs({omega_q: p["omega_q"], omega_n: p["omega_n"]}))
    beat = 2 * math.pi / p["Delta_omega"]
    times = f"{beat / carrier:.1f} times"
    return f"{1e6 * carrier:.2f} us at Table 3, the vibration's own period; the beat is {times} as long."


def _entry(identifier: str, **fields: Any) -> Entry:  # noqa: ANN401
    return Entry(id=identifier, **{"units": {}, **fields})


ENTRIES = (
    _entry(
        "claim-half-beat", section="3.5", place="Sect. 3.5, Appendix A", printed=_SHARES, verdict="erratum",
        title="'The time for both phases is half of the beat period'",
        judge=_judge_half, derive=_derive_half, effect=_effect_half,
        repair=_repair_half,
        found_by=("numeric", "limit"),
        reason="True for constant amplitudes and, nearly, in T_redu; in T_addredu one third turns forward, two "
               "thirds backward.",
    ),
    _entry(
        "claim-crest", section="3.4", place="Sect. 3.4", title="'At the wave peak the vertical velocity is zero'",
        printed=_CREST, verdict="erratum", judge=_judge_crest, derive=_derive_crest, effect=_effect_crest,
        repair=lambda _: _derive_crest().forms, found_by=("numeric",), units={},
        known=transfer.DIMENSIONS,
        reason="The slope is zero at the crest; the vertical velocity is the rate of its height, zero in a "
               "steady wave only.",
    ),
    _entry(
        "claim-proportional", section="6.1", place="below eq. 42", title="'Directly proportional to the rotor speed'",
        printed=_POWERS, verdict="erratum", judge=_judge_power, derive=_derive_power, effect=_effect_power,
        repair=lambda forms: {**forms, "power_of_W_in_Q": sp.Integer(2)}, found_by=("numeric", "identity"),
        reason="The surface speed grows as the amplitude, Q as its square; it gives the direction, not the speed.",
    ),
    _entry(
        "claim-contact", section="5.3", place="Sects. 3.1, 5.3", title="The crest 'is always in contact'",
        printed=_CONTACT,
        verdict="verified", judge=_judge_contact, derive=_derive_contact, effect=_effect_contact,
        reason="Under a constant prepressure the crest always stands in the layer.",
    ),
    _entry(
        "claim-T_Qall", section="6.2", place="Sects. 6.2.1, 6.2.2", title="T_Qall 'remains almost constant'",
        printed=_CONSTANT, verdict="approximation", judge=_judge_constant, derive=_derive_constant,
        effect=_effect_constant, reason="It changes by about one per cent over the range of frequency differences.",
    ),
    _entry(
        "claim-one-beat", section="5.2.1", place="Sect. 5.2.1", title="'One beat period in T_reduT'", printed=_BEATS,
        verdict="erratum", judge=_judge_beats, derive=_derive_beats, effect=_effect_beats,
        repair=lambda _: _derive_beats().forms, found_by=("numeric", "limit"),
        reason="With m = 100 and n = 55 there are more than three.",
    ),
    _entry(
        "claim-add-beat", section="5.2.3", place="Sect. 5.2.3", title="Beat period in T_addT", printed=_ADD,
        units={"T_beat": "s"}, verdict="erratum", judge=_judge_add, derive=_derive_add, effect=_effect_add,
        repair=_repair_add, found_by=("numeric", "limit"),
        reason="4 pi/(omega_q + omega_n) is the period of the vibration itself, not of its envelope.",
    ),
)  # fmt: skip
