"""Section 6, the characteristic variables: eqs. (39) to (44) and Q(t)."""

from __future__ import annotations

import math
import random
import statistics
from collections.abc import Iterator
from functools import cache

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import determinant, transfer
from derivations.ledger.course import Lap, Quantity, extremes, integral, share
from derivations.ledger.history import STARTS, Array, History, Start, history, values
from derivations.ledger.judge import Point, agrees, figure, identical, rounded, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import sym
from trum_sym.inputs.units import parse_unit

__all__ = ["ENTRIES", "cycle_totals", "forward"]

D, k_c, x, T = sym("D k_c x T")
q_plus, q_minus, p_plus, p_minus = sym("q_plus q_minus p_plus p_minus")
zeta_zmax, v_xmax, S_k, S_s, v_s, Q_aver, Q_q, I_all = sym("zeta_zmax v_xmax S_k S_s v_s Q_aver Q_q I")
i = sp.Symbol("i", integer=True, positive=True)
v = sp.IndexedBase("v", real=True)
_KNOWN = {v[i]: parse_unit("rad/s").dimension}


def _speeds(count: int, seed: str) -> list[float]:
    draw = random.Random(seed)
    return [draw.uniform(-0.5, 3.0) for _ in range(count)]


def _of_samples(form: sp.Expr, samples: list[float], **more: float) -> float:
    """A form of the samples v_1 ... v_I, with v_s, S_k given by name."""
    written = form.subs(I_all, len(samples)).doit()
    known = {v[index + 1]: value for index, value in enumerate(samples)}
    known.update({s: more[s.name] for s in written.free_symbols if s.name in more})
    return float(written.subs(known))


# --- (39) ---------------------------------------------------------------------------------------------------
_EQ39: Forms = {"v_s": sp.Sum(v[i], (i, 1, I_all)) / I_all}


def _derive_39() -> Derivation:
    residual = sp.Sum(v[i] - v_s, (i, 1, 5)).doit()
    return Derivation(
        (
            step(
                "The mean is what the samples deviate from by nothing in all:",
                sp.Eq(sp.Sum(v[i] - v_s, (i, 1, I_all)), 0),
                zero=residual.subs(v_s, _EQ39["v_s"].subs(I_all, 5).doit()),
            ),
        ),
        _EQ39,
    )


def _judge_39(forms: Forms) -> Iterator[Evidence]:
    worst = 0.0
    for count in (1, 2, 7, 12):
        samples = _speeds(count, f"39 {count}")
        worst = worse(worst, abs(_of_samples(forms["v_s"], samples) - statistics.fmean(samples)))
    yield evidence("numeric", worst < 1e-12, f"the mean of random samples: off by {rounded(worst)} at most")
    yield evidence("limit", abs(_of_samples(forms["v_s"], [1.7] * 5) - 1.7) < 1e-12, "a constant speed is its own mean")


def _effect_39() -> str:
    p = values()
    return (
        "A number, though printed as v_s(t), and i counts the samples up to I. One sample every 2 ms (Sect. 8.2) "
        f"averages over {figure(0.002 / p['T'])} cycles of {figure(1e3 * p['T'])} ms."
    )


# --- (40), (41) ---------------------------------------------------------------------------------------------
_EQ40: Forms = {"sigma_s": sp.Abs(S_k / v_s)}
_VARIANCE = sp.Sum((v[i] - v_s) ** 2, (i, 1, I_all)) / I_all
_EQ41: Forms = {"variance": sp.Eq(S_s**2, _VARIANCE)}


def _derive_40() -> Derivation:
    scale = sp.Symbol("a", positive=True)
    form = _EQ40["sigma_s"]
    return Derivation(
        (
            step(
                "The standard deviation in units of the mean does not depend on the unit of speed:",
                form,
                zero=form.subs({S_k: scale * S_k, v_s: scale * v_s}, simultaneous=True) - form,
            ),
        ),
        _EQ40,
    )


def _judge_40(forms: Forms) -> Iterator[Evidence]:
    worst = 0.0
    for count in (2, 7, 12):
        for sign in (1, -1):
            samples = [sign * s for s in _speeds(count, f"40 {count}")]
            mean, spread = statistics.fmean(samples), statistics.pstdev(samples)
            found = float(forms["sigma_s"].subs({S_k: spread, v_s: mean}))
            worst = worse(worst, abs(found - spread / abs(mean)))
    yield evidence("numeric", worst < 1e-12, f"spread over mean of random samples: off by {rounded(worst)} at most")
    yield evidence("limit", forms["sigma_s"].subs(S_k, 0) == 0, "a constant speed has no volatility")


def _effect_40() -> str:
    p = values()
    return (
        f"Follows from the sampling: samples every 2 ms (Sect. 8.2) average the {figure(1e3 * p['T'])} ms cycle away, "
        "so Table 4's 17.3 % and a volatility within the cycle are different figures. It has no bound as the mean "
        "speed crosses 0."
    )


def _derive_41() -> Derivation:
    mean_square = sp.Sum(v[i] ** 2, (i, 1, I_all)) / I_all
    four = {I_all: 4}
    mean = (sp.Sum(v[i], (i, 1, I_all)) / I_all).subs(four).doit()
    gap = _VARIANCE.subs(four).doit().subs(v_s, mean) - mean_square.subs(four).doit() + mean**2
    return Derivation(
        (
            step(
                "The variance over all I samples is the mean square less the square of the mean:",
                sp.Eq(S_k**2, mean_square - v_s**2),
                zero=sp.expand(gap),
            ),
            step("Eq. 40 calls its root S_k:", sp.Eq(S_k**2, _VARIANCE)),
        ),
        {"variance": sp.Eq(S_k**2, _VARIANCE)},
    )


def _judge_41(forms: Forms) -> Iterator[Evidence]:
    form = forms["variance"]
    yield evidence("domain", S_k in form.lhs.free_symbols, f"defines the S_k of eq. 40; on the left is {form.lhs}")
    worst = 0.0
    for count in (1, 2, 7):
        samples = _speeds(count, f"41 {count}")
        found = _of_samples(form.rhs, samples, v_s=statistics.fmean(samples))
        worst = worse(worst, abs(found - statistics.pvariance(samples)))
        spread = float(form.lhs.subs({S_k: statistics.pstdev(samples), S_s: statistics.pstdev(samples)}))
        worst = worse(worst, abs(spread - statistics.pvariance(samples)))
    yield evidence("numeric", worst < 1e-12, f"the variance of random samples: off by {rounded(worst)} at most")
    yield evidence("limit", abs(_of_samples(form.rhs, [1.7] * 5, v_s=1.7)) < 1e-12, "a constant speed has none")


def _effect_41() -> str:
    return (
        "None on numbers once S_s is read as S_k. The sum is over I, not I - 1: of the population, not an estimate; "
        f"for {100} samples the difference is {figure(100 * (math.sqrt(100 / 99) - 1), spec='.1f')} % of S_k."
    )


# --- Q(t) ---------------------------------------------------------------------------------------------------
_Q_T: Forms = {
    "Q_plus": sp.Piecewise((Q_q, Q_q >= 0), (0, True)),
    "Q_minus": sp.Piecewise((Q_q, Q_q < 0), (0, True)),
}


def _derive_q_t() -> Derivation:
    parts = {"Q_plus": (Q_q + sp.Abs(Q_q)) / 2, "Q_minus": (Q_q - sp.Abs(Q_q)) / 2}
    at = [form.subs(Q_q, value) - parts[key].subs(Q_q, value) for key, form in _Q_T.items() for value in (-2, 0, 3)]
    return Derivation((step("Positive and negative part, which add up to Q:", *parts.values(), zero=at),), _Q_T)


def _judge_q_t(forms: Forms) -> Iterator[Evidence]:
    h = history(samples=2000)
    signs = {key: sp.lambdify(Q_q, form, "numpy")(h.q) for key, form in forms.items()}
    split = float(np.abs(signs["Q_plus"] + signs["Q_minus"] - h.q).max())
    yield evidence("numeric", split == 0, "both parts add up to Q all through a cycle")
    signed = bool((signs["Q_plus"] >= 0).all() and (signs["Q_minus"] <= 0).all())
    yield evidence("domain", signed, "one is never negative, the other never positive")


def _effect_q_t() -> str:
    parts = ", ".join(f"{figure(100 * share(forward, Lap(start)), 3)} % ({start})" for start in STARTS)
    return (
        f"Phase lead +1: Q is positive during {parts} of a cycle at Table 3; from rest it is 0 all through T_redu, "
        "where A is off and at rest."
    )


# --- (42) ---------------------------------------------------------------------------------------------------
_EQ42: Forms = {"Q_q": zeta_zmax * v_xmax}
_W_A, _W_B, _V_A, _V_B = transfer.w_A, transfer.w_B, transfer.v_A, transfer.v_B
_RANGES = {"w_A": (-8e-6, 8e-6), "w_B": (-8e-6, 8e-6), "v_A": (-1.5, 1.5), "v_B": (-1.5, 1.5), "x": (-0.01, 0.01)}


def _crest_values() -> dict[sp.Basic, sp.Basic]:
    at = transfer.wave_states()
    speed = transfer.surface_speed().subs(transfer.u, 0).subs(at)
    return {zeta_zmax: transfer.crest_amplitude(), v_xmax: speed}


def _derive_42() -> Derivation:
    crest = _crest_values()
    value = determinant.phase_determinant(_W_A, _V_A, _W_B, _V_B)
    return Derivation(
        (
            step("Eq. A5 with the displacements of eq. 11 does not depend on x:", sp.Eq(Q_q, value)),
            step(
                "At the crest zeta_x = 0, so Q is the crest's displacement times its tangential velocity:",
                sp.Eq(zeta_zmax, crest[zeta_zmax]),
                sp.Eq(v_xmax, crest[v_xmax]),
                zero=sp.expand((zeta_zmax * v_xmax).subs(crest) - value),
            ),
        ),
        _EQ42,
    )


def _judge_42(forms: Forms) -> Iterator[Evidence]:
    def anywhere(_: str, point: Point) -> mp.mpf:
        """Eq. A5 at a random place, written out."""
        sine, cosine = mp.sin(point[k_c] * point[x]), mp.cos(point[k_c] * point[x])
        up = point[_W_A] * sine + point[_W_B] * cosine
        up_rate = point[_V_A] * sine + point[_V_B] * cosine
        along = point[D] * point[k_c] * (point[_W_A] * cosine - point[_W_B] * sine)
        along_rate = point[D] * point[k_c] * (point[_V_A] * cosine - point[_V_B] * sine)
        return along_rate * up - up_rate * along

    yield agrees(
        forms,
        anywhere,
        given=_crest_values(),
        ranges=_RANGES,
        symbols=(_W_A, _W_B, _V_A, _V_B, D, k_c, x),
        against="eq. A5 at a random place x",
    )
    concrete = {key: form.subs(_crest_values()) for key, form in forms.items()}
    yield identical(concrete, {"Q_q": determinant.phase_determinant(_W_A, _V_A, _W_B, _V_B)})


def _effect_42() -> str:
    p, lap = values(), Lap()
    wrong = max(abs(end) for end in extremes(lambda h: h.W_c * h.W_c_rate, lap))
    right = p["D"] * p["k_c"] * max(abs(end) for end in extremes(lambda h: h.q, lap))
    flipped = share(lambda h: -h.W_c_rate * h.q, lap)
    return (
        "Exact with the tangential velocity D d2(zeta_z)/dx dt at the crest. With eq. 22 as printed, the vertical "
        f"one, the product would be up to {figure(wrong, 3)} m^2/s where Q reaches {figure(right, 3)} m^2/s at Table "
        "3, "
        f"periodic, phase lead +1, with a wrong sign {figure(100 * flipped, 3)} % of the cycle. zeta_zmax >= 0 always."
    )


# --- (43), (44) ---------------------------------------------------------------------------------------------
_EQ43: Forms = {"Q_aver": (q_plus - q_minus) / (sp.Abs(q_plus + q_minus) * T)}
_EQ44: Forms = {"Q_vib": sp.sqrt(p_plus + p_minus) / (sp.sqrt(p_plus - p_minus) * T**2 * Q_aver)}


def forward(h: History) -> Array:
    """Positive where Q is, beyond rounding."""
    p = values()
    return h.q - 1e-9 * p["W"] ** 2 * p["omega_q"]


def backward(h: History) -> Array:
    """Positive where Q is negative, beyond rounding."""
    p = values()
    return -h.q - 1e-9 * p["W"] ** 2 * p["omega_q"]


@cache
def cycle_totals(start: Start) -> dict[sp.Symbol, float]:
    """The sums of Q and of its square over a cycle at Table 3 as integrals, for D k_c = W = 1."""
    p = values()

    def total(sign: float, power: int) -> float:
        def part(h: History) -> Array:
            return np.maximum(0.0, sign * h.q / p["W"] ** 2) ** power

        return integral(part, Lap(start), [forward, backward])

    return {q_plus: total(1, 1), q_minus: total(-1, 1), p_plus: total(1, 2), p_minus: total(-1, 2)}


def _totals(Q: Array, dt: float) -> dict[sp.Symbol, float]:
    forward, backward = Q[Q > 0], Q[Q < 0]
    return {
        q_plus: float(forward.sum()) * dt,
        q_minus: -float(backward.sum()) * dt,
        p_plus: float((forward**2).sum()) * dt,
        p_minus: float((backward**2).sum()) * dt,
    }


def _synthetic(bias: float) -> tuple[Array, float]:
    """A Q(t) with beats around a bias, over 4.7e-4 s."""
    time = np.linspace(0, 4.7e-4, 4001)
    return np.sin(2 * np.pi * 3000 * time + 0.4) * np.exp(-1500 * time) + bias, float(time[1])


def _derive_43() -> Derivation:
    average, _ = determinant.measures()
    form = _EQ43["Q_aver"]
    return Derivation(
        (
            step(
                "Forward less backward over both, per cycle time; both sums are positive, so |.| changes nothing:",
                sp.Eq(Q_aver, average),
                zero=form - average,
            ),
        ),
        {"Q_aver": form},
    )


def _judge_43(forms: Forms) -> Iterator[Evidence]:
    worst = 0.0
    for bias in (-0.5, -0.1, 0.2, 2.0):
        Q, dt = _synthetic(bias)
        known = {**_totals(Q, dt), T: 4.7e-4}
        found = sp.sympify(forms["Q_aver"].subs(known))
        off = abs(float(found) - Q.sum() / np.abs(Q).sum() / 4.7e-4) * 4.7e-4 if found.is_extended_real else math.inf
        worst = worse(worst, off)
    yield evidence(
        "numeric", worst < 1e-9, f"mean of Q over mean of |Q|, per cycle time, for sampled Q: off by {rounded(worst)}"
    )
    ahead = sp.simplify(forms["Q_aver"].subs(q_minus, 0)), sp.simplify(forms["Q_aver"].subs(q_plus, 0))
    yield evidence("limit", ahead == (1 / T, -1 / T), "between -1/T (all backward) and 1/T (all forward)")


def _positive(quantity: Quantity) -> Quantity:
    return lambda h: np.maximum(0.0, quantity(h))


def _word_by_word(start: Start) -> float:
    """Q_aver with the forward sum taken up to the time T_Q+ and the backward one up to T_Q-, from t_1, times T."""
    lap = Lap(start)
    ends = (share(forward, lap), share(backward, lap))
    sums = []
    for quantity, end in zip((forward, backward), ends, strict=True):
        stretch = Lap(start, high=end * lap.length)
        sums.append(integral(_positive(quantity), stretch, [quantity]))
    return (sums[0] - sums[1]) / (sums[0] + sums[1])


def _effect_43() -> str:
    p, parts = values(), []
    for start in STARTS:
        known = cycle_totals(start)
        whole = (known[q_plus] - known[q_minus]) / (known[q_plus] + known[q_minus])
        parts.append(f"{start} {figure(whole / p['T'])} ({figure(_word_by_word(start) / p['T'])})")
    return (
        "Sums up to T_Q+ and T_Q- mean all of the cycle's forward and backward time, as App. C writes (up to T_Qall). "
        f"Taken word by word, from t = 0 to T_Q+, they would give other figures. 1/s at Table 3, phase lead +1, in "
        f"brackets word by word: {', '.join(parts)}. It bounds at 1/T and knows nothing of Q's size, W, D or k_c."
    )


def _derive_44() -> Derivation:
    average, volatility = determinant.measures()
    form = sp.sqrt((p_plus + p_minus) / sp.Abs(p_plus - p_minus)) / (T**2 * Q_aver)
    printed = _EQ44["Q_vib"]
    return Derivation(
        (
            step(
                "The ratio of root sums; the difference of the squares may have either sign, so its magnitude stands "
                "under the root, and Q_aver brings the direction:",
                sp.Eq(sp.Symbol("Q_vib"), form),
                zero=form.subs(Q_aver, average) - volatility,
            ),
            step(
                "For Y > 1 that is the printed form:",
                zero=[(form - printed).subs({p_plus: a, p_minus: b}).simplify() for a, b in ((3, 2), (7, 1))],
            ),
        ),
        {"Q_vib": form},
    )


def _judge_44(forms: Forms) -> Iterator[Evidence]:
    worst, complex_for = 0.0, []
    for bias in (-0.5, -0.2, 0.2, 0.6):
        Q, dt = _synthetic(bias)
        totals = _totals(Q, dt)
        average = Q.sum() / np.abs(Q).sum() / 4.7e-4
        found = complex(forms["Q_vib"].subs({**totals, T: 4.7e-4, Q_aver: average}))
        signed = (Q * np.abs(Q)).sum()  # squares, each with the direction's sign
        wanted = math.sqrt((Q**2).sum() / abs(signed)) / (4.7e-4**2 * average)
        worst = worse(worst, abs(found - wanted) / abs(wanted))
        if abs(found.imag) > 1e-9 * abs(found):
            complex_for.append(figure(totals[p_plus] / totals[p_minus], 2))
    note = f", but for Y = {', '.join(complex_for)}" if complex_for else ""
    yield evidence("domain", not complex_for, f"real for forward and backward cycles{note}")
    yield evidence(
        "numeric", worst < 1e-9, f"root of summed squares over signed ones, for sampled Q: off by {rounded(worst)}"
    )


def _effect_44() -> str:
    p = values()
    parts = []
    for start in STARTS:
        known = cycle_totals(start)
        average = (known[q_plus] - known[q_minus]) / (known[q_plus] + known[q_minus]) / p["T"]
        numbers = {**known, T: p["T"], Q_aver: average}
        found, right = (complex(f.subs(numbers)) for f in (_EQ44["Q_vib"], _derive_44().forms["Q_vib"]))
        text = figure(found.real) if abs(found.imag) < 1e-6 * abs(found) else f"{figure(found.imag)} i"
        parts.append(
            f"{start} {text}, put right {figure(right.real)} (Y = {figure(known[p_plus] / known[p_minus], 3)})"
        )
    return (
        f"1/s at Table 3, phase lead +1: {'; '.join(parts)}. It divides by 0 at Y = 1 and at Q_aver = 0, takes the "
        f"direction's sign, and gives a wave that turns one way all the time 1/T = {figure(1 / p['T'])} 1/s, not 0."
    )


ENTRIES = (
    Entry(
        id="39",
        section="6.1",
        title="Mean speed",
        place="Sect. 6.1",
        printed=_EQ39,
        units={"v_s": "rad/s"},
        verdict="definition",
        judge=_judge_39,
        derive=_derive_39,
        effect=_effect_39,
        known=_KNOWN,
        reason="The mean of I samples.",
    ),
    Entry(
        id="40",
        section="6.1",
        title="Speed volatility",
        place="Sect. 6.1",
        printed=_EQ40,
        units={"sigma_s": "1"},
        verdict="definition",
        judge=_judge_40,
        derive=_derive_40,
        effect=_effect_40,
        known=_KNOWN,
        reason="Standard deviation over mean, in per cent.",
    ),
    Entry(
        id="41",
        section="6.1",
        title="Variance of the speed",
        place="Sect. 6.1",
        printed=_EQ41,
        units={},
        verdict="erratum",
        judge=_judge_41,
        derive=_derive_41,
        effect=_effect_41,
        known=_KNOWN,
        repair=lambda forms: {"variance": forms["variance"].subs(S_s, S_k)},
        found_by=("domain",),
        reason="Defines S_s^2; what eq. 40 uses and the text announces is S_k^2.",
    ),
    Entry(
        id="Q(t)",
        section="6.1",
        title="Forward and backward part of Q",
        place="above eq. 42",
        printed=_Q_T,
        units={"Q_plus": "m^2/s", "Q_minus": "m^2/s"},
        verdict="definition",
        judge=_judge_q_t,
        derive=_derive_q_t,
        effect=_effect_q_t,
        known=_KNOWN,
        reason="Splits Q by its sign.",
    ),
    Entry(
        id="42",
        section="6.1",
        title="The determinant at the crest",
        place="Sect. 6.1",
        printed=_EQ42,
        units={"Q_q": "m^2/s"},
        verdict="verified",
        judge=_judge_42,
        derive=_derive_42,
        effect=_effect_42,
        known=_KNOWN | transfer.DIMENSIONS,
        reason="An identity with eq. A5 at every instant, if v_xmax is the tangential velocity; eq. 22 prints another.",
    ),
    Entry(
        id="43",
        section="6.1",
        title="Speed determinant",
        place="Sect. 6.1",
        printed=_EQ43,
        units={"Q_aver": "1/s"},
        verdict="definition",
        judge=_judge_43,
        derive=_derive_43,
        effect=_effect_43,
        known=_KNOWN,
        reason="Share of forward over backward turning, per cycle time; Table 4 prints it without its unit, 1/s.",
    ),
    Entry(
        id="44",
        section="6.1",
        title="Volatility determinant",
        place="Sect. 6.1",
        printed=_EQ44,
        units={"Q_vib": "1/s"},
        verdict="erratum",
        judge=_judge_44,
        derive=_derive_44,
        effect=_effect_44,
        known=_KNOWN,
        repair=lambda forms: {"Q_vib": forms["Q_vib"].subs(p_plus - p_minus, sp.Abs(p_plus - p_minus))},
        found_by=("domain", "numeric"),
        reason="Imaginary when backward turning prevails (Y < 1); needs the magnitude of the difference.",
    ),
)
