"""Section 3.3, the two phases as rotating vectors: eqs. (12) to (15)."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations.ledger.exact import REGIONS, Cycle, at_table_3, random_cycles
from derivations.ledger.judge import agrees, error_size, figure, largest, vanishes, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.regions import anywhere, by_region, context, row_value, rows, turning, within, worst
from derivations.ledger.section_3_phases import EQ9, LIMIT, corrected_10, shares
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

t, t_1, t_2, t_3, xi = sym("t t_1 t_2 t_3 xi")
omega_n, omega_q, W_maxf, k_c, x, Delta_omega = sym("omega_n omega_q W_maxf k_c x Delta_omega")
varphi_Aredu, A_AB, Theta_A, Psi_A, varphi_A = sym(
    "varphi_Aredu A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu"
)
A_Badd, Theta_B, Psi_B, varphi_B = sym("A_Badd Theta_Badd Psi_Badd varphi_Badd")
A_Q, A_A, A_B, t_Q, theta_Q = sym("A_Q A_A A_B t_Q theta_Q")
redu, addredu, add = sym("Delta_omega_redu Delta_omega_addredu Delta_omega_add")
mean = (omega_n + omega_q) / 2
half_A = (Theta_A + Psi_A) / 2


# --- (12) ---------------------------------------------------------------------------------------------------
EQ12: Forms = {"A_Q": sp.sqrt(A_A**2 + A_B**2 + 2 * A_A * A_B * sp.cos(Delta_omega * (t - t_Q) + theta_Q))}


def _derive_12() -> Derivation:
    angle = Delta_omega * (t - t_Q) + theta_Q
    square = (A_A + A_B * sp.cos(angle)) ** 2 + (A_B * sp.sin(angle)) ** 2
    total = sp.sqrt(A_A**2 + A_B**2 + 2 * A_A * A_B * sp.cos(angle))
    return Derivation(
        (
            step(
                "The two oscillations are projections of vectors of length A_A and A_B; in a frame that turns with "
                "the first, the second turns by",
                angle,
            ),
            step(
                "Squares of the sum's two components:",
                square,
                zero=sp.expand(square - total**2).subs(sp.sin(angle) ** 2, 1 - sp.cos(angle) ** 2),
            ),
        ),
        {"A_Q": total},
    )


_RANGES_12 = {"A_A": (-5e-6, 5e-6), "A_B": (-5e-6, 5e-6), "theta_Q": (-3.0, 3.0), "t_Q": (0.0, 1e-4)}


def _judge_12(forms: Forms) -> Iterator[Evidence]:
    def length(_: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = {s.name: number for s, number in point.items()}
        return abs(v["A_A"] + v["A_B"] * mp.expj(v["Delta_omega"] * (v["t"] - v["t_Q"]) + v["theta_Q"]))

    symbols = sym("A_A A_B Delta_omega t t_Q theta_Q")
    yield agrees(forms, length, ranges=_RANGES_12, symbols=symbols, count=8, against="the length of the vectors' sum")
    along = forms["A_Q"].subs({theta_Q: 0, t: t_Q})
    against = forms["A_Q"].subs({theta_Q: sp.pi, t: t_Q})
    ok = vanishes(along**2 - (A_A + A_B) ** 2) and vanishes(against**2 - (A_A - A_B) ** 2)
    yield evidence("limit", ok, "vectors in line add, opposite ones subtract")


def _effect_12() -> str:
    return (
        "None for the formula; its arguments are (13) and (14). A_Q is the envelope of the displacement, not its value."
    )


# --- (13) ---------------------------------------------------------------------------------------------------
EQ13: Forms = {
    "A_A": by_region(
        (W_maxf * sp.exp(-xi * omega_n * (t - t_1)) * sp.sin(k_c * x), 1, 2), (A_AB * sp.sin(k_c * x), 2, 4)
    ),
    "A_B": by_region(
        (W_maxf * sp.cos(k_c * x), 1, 2),
        (W_maxf * sp.cos(k_c * x) * sp.exp(-xi * omega_n * (t - t_2)), 2, 3),
        (A_Badd * sp.cos(k_c * x), 3, 4),
    ),
}


def _envelope(expr: sp.Expr) -> sp.Expr:
    """What stands before the one sine of a row."""
    (sine,) = expr.atoms(sp.sin)
    return expr / sine


def corrected_13() -> Forms:
    """Amplitudes of (9) and of the corrected (10), at the point x."""
    A, B = rows(EQ9["w_A"]), [row.rewrite(sp.sin) for row in rows(corrected_10()["w_B"])]
    shape_A, shape_B = sp.sin(k_c * x), sp.cos(k_c * x)
    first, free_B = W_maxf * shape_B, sp.Abs(W_maxf * omega_q / omega_n) * sp.exp(-xi * omega_n * (t - t_2))
    return {
        "A_A": by_region((_envelope(A[0]) * shape_A, 1, 2), (_envelope(A[1]) * shape_A, 2, 4)),
        "A_B": by_region((first, 1, 2), (free_B * shape_B, 2, 3), (_envelope(B[2]) * shape_B, 3, 4)),
    }


def _off_13(forms: Forms, phase: str, cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
    """An amplitude off the length of the phase's vector, relative to it."""
    place = mp.mpf("0.0013")
    value = row_value(forms[f"A_{phase}"], {**context(cycle, region, time), "x": place})
    shape = mp.sin if phase == "A" else mp.cos
    return value / (abs(cycle.vector(phase, region, time)) * shape(cycle["k_c"] * place)) - 1


def _judge_13(forms: Forms) -> Iterator[Evidence]:
    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        """The rows that are exact but for omega_n in place of omega_d."""
        phases = "A" if region == "addredu" else "AB"
        weights = {p: abs(cycle.vector(p, region, time)) / cycle["W"] for p in phases}
        return largest(abs(_off_13(forms, p, cycle, region, time)) * weights[p] for p in phases)

    found = worst(error)
    yield evidence(
        "numeric",
        largest(found.values()) < LIMIT,
        f"but for A_B in T_addredu off the lengths of the two phases' vectors, in W, by {shares(found)}; allowed 1 %",
    )
    right, slow = corrected_13(), {omega_q: omega_n}
    gaps = [a.subs(slow) - b.subs(slow) for n in forms for a, b in zip(rows(forms[n]), rows(right[n]), strict=True)]
    yield evidence(
        "identity",
        all(vanishes(gap) for gap in gaps)
        and [f.args[i][1] for f in forms.values() for i in range(len(f.args))]
        == [f.args[i][1] for f in right.values() for i in range(len(f.args))],
        "row by row the amplitudes of (9) and (10) put right, for a drive at resonance",
    )

    def of_B(cycle: Cycle) -> float:
        return float(_off_13(forms, "B", cycle, "addredu", cycle.times("addredu", 1)[0]))

    there = at_table_3()
    difference = there["omega_q"] - there["omega_n"]
    near = Cycle({**there.values, "omega_q": there["omega_n"] + difference / 100, "Delta_omega": difference / 100})
    most = largest(abs(of_B(cycle)) for cycle in random_cycles(2, "section 3"))
    yield error_size(
        "A_B in T_addredu",
        lambda: (of_B(there), float(most)),
        "a drive at resonance, omega_q -> omega_n",
        lambda: of_B(near),
    )
    zero = all(row.subs(x, 0) == 0 for row in rows(forms["A_A"]))
    nodes = all(row.subs(x, sp.pi / (2 * k_c)) == 0 for row in rows(forms["A_B"]))
    yield evidence("limit", zero and nodes, "A has its node at x = 0, B a quarter wave further")


def _derive_13() -> Derivation:
    forms = corrected_13()
    return Derivation(
        (
            step(
                "The amplitudes are what stands before the sines of (9) and (10), times the mode shapes of (11):",
                *rows(forms["A_A"]),
            ),
            step(
                "With the amplitude that continuity of the velocity gives B after t_2:",
                *rows(forms["A_B"]),
                zero=rows(forms["A_B"])[1].subs(t, t_2) - W_maxf * omega_q / omega_n * sp.cos(k_c * x),
            ),
        ),
        forms,
    )


def _effect_13() -> str:
    cycle = at_table_3()
    damped = mp.sqrt(1 - cycle["xi"] ** 2)
    short = 1 - damped * cycle["omega_n"] / cycle["omega_q"]
    return (
        f"From t_2 to t_3 A_B is {figure(100 * short, 3)} % too small at Table 3, from a steady start; the other rows "
        f"hold to {figure(100 * (1 / damped - 1), 2)} %, what omega_n in place of omega_d costs, with the amplitudes "
        "of the supplement as reconstructed here."
    )


# --- (14) ---------------------------------------------------------------------------------------------------
EQ14: Forms = {
    "Delta_omega": by_region((omega_q - omega_n, 1, 2), ((omega_q - omega_n) / 2, 2, 3)),
    "t_Q": by_region((t_1, 1, 2), (t_2, 2, 3), (t_3, 3, 4)),
    "theta_Q": by_region((Theta_A - Psi_A - sp.pi, 2, 3)),
}


def corrected_14() -> Forms:
    """Differences of the phases of (9) and the corrected (10), each written as a sine."""
    A, B = rows(EQ9["w_A"]), rows(corrected_10()["w_B"])
    angles_A = [next(iter(row.atoms(sp.sin))).args[0] for row in A]
    angles_B = [
        (omega_q * (t - t_1) + sp.pi),
        omega_n * (t - t_2) + sp.pi,
        next(iter(B[2].atoms(sp.cos, sp.sin))).args[0],
    ]
    if isinstance(next(iter(B[2].atoms(sp.cos, sp.sin))), sp.cos):
        angles_B[2] += sp.pi / 2
    signs, starts = (1, -1, 1), (t_1, t_2, t_3)
    rates, offsets = [], []
    for sign, start, of_A, of_B in zip(signs, starts, angles_A, angles_B, strict=True):
        difference = sp.expand(sign * (of_B - of_A).subs(varphi_Aredu, sp.pi / 2))
        rates.append(sp.factor(difference.diff(t)))
        offsets.append(sp.expand(difference.subs(t, start)))
    spans = ((1, 2), (2, 3), (3, 4))
    return {
        "Delta_omega": by_region(*((rate, *span) for rate, span in zip(rates, spans, strict=True))),
        "t_Q": by_region(*((start, *span) for start, span in zip(starts, spans, strict=True))),
        "theta_Q": by_region(*((offset, *span) for offset, span in zip(offsets, spans, strict=True))),
    }


def _repair_14(forms: Forms) -> Forms:
    shift = varphi_A + half_A - (Theta_A - Psi_A)
    third = (Theta_B + sp.pi + Psi_B) / 2 + varphi_B - mean * (t_3 - t_2) - half_A - varphi_A
    middle = rows(forms["theta_Q"])[0] + shift
    printed = forms["Delta_omega"]
    return {
        "Delta_omega": sp.Piecewise(*printed.args, (sp.Integer(0), within(3, 4)), evaluate=False),
        "t_Q": forms["t_Q"],
        "theta_Q": by_region((sp.pi / 2, 1, 2), (middle, 2, 3), (third, 3, 4)),
    }


def _apart(forms: Forms, names: dict[str, mp.mpf], a: mp.mpc, b: mp.mpc) -> mp.mpf:
    """How far Delta_omega (t - t_Q) + theta_Q is off the angle between two vectors, up to turns and the sense."""
    rate, start, offset = (row_value(forms[name], names) for name in ("Delta_omega", "t_Q", "theta_Q"))
    angle, wanted = rate * (names["t"] - start) + offset, mp.arg(b / a)
    return -worse(*(-abs(mp.expj(angle) - mp.expj(sign * wanted)) for sign in (1, -1)))


def _judge_14(forms: Forms) -> Iterator[Evidence]:
    missing = set()

    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        off = _apart(forms, context(cycle, region, time), *(cycle.vector(phase, region, time) for phase in "AB"))
        if mp.isnan(off):
            missing.add(region)
            return mp.mpf(0)
        return off

    found = worst(error)
    absent = ", ".join(f"T_{r}" for r in REGIONS if r in missing) or "none"
    yield evidence(
        "numeric",
        largest(found.values()) < 2 * LIMIT,
        f"the angle between the two phases' vectors is off by {_radians(found)}; allowed 0.02 rad",
    )
    yield evidence("domain", not missing, f"regions without a row: {absent}")
    off = mp.mpf(0)
    for names in (names for region in REGIONS for names in anywhere(region, 3, "eq14")):
        a, b = turning(EQ9["w_A"], names)[0], turning(corrected_10()["w_B"], names)[0]
        off = worse(off, _apart(forms, names, a, b))
    yield evidence(
        "identity",
        off < mp.mpf(10) ** -8,
        "is the angle between (9) and (10) put right, whatever the supplement's amplitudes and phases",
    )
    starts = [row_value(forms["t_Q"], anywhere(region, 1, "t_Q")[0]) for region in REGIONS]
    wanted = [anywhere(region, 1, "t_Q")[0][f"t_{i}"] for i, region in enumerate(REGIONS, 1)]
    yield evidence("continuity", starts == wanted, "t_Q is where each region starts")
    plain = [row.subs({omega_q: omega_n}) for row in rows(forms["Delta_omega"])]
    yield evidence("limit", all(vanishes(p) for p in plain), "no beat when driven at resonance")


def _radians(found: dict[str, mp.mpf]) -> str:
    return ", ".join(f"{mp.nstr(value, 3)} rad in T_{region}" for region, value in found.items())


def _derive_14() -> Derivation:
    forms = corrected_14()
    return Derivation(
        (
            step(
                "From t_1 to t_2 B turns with omega_q and leads by pi/2, A turns freely with omega_n:",
                rows(forms["Delta_omega"])[0],
                rows(forms["theta_Q"])[0],
                zero=[rows(forms["Delta_omega"])[0] - (omega_q - omega_n), rows(forms["theta_Q"])[0] - sp.pi / 2],
            ),
            step(
                "From t_2 to t_3 A has the mean frequency and B turns freely: A runs ahead with half the difference. "
                "Its phase varphi drifts as well, so this half is the rate of the mean angle only, and the true rate "
                "is not constant:",
                rows(forms["Delta_omega"])[1],
                rows(forms["theta_Q"])[1],
                zero=[rows(forms["Delta_omega"])[1] - (omega_q - omega_n) / 2, rows(forms["theta_Q"])[1].diff(t)],
            ),
            step(
                "From t_3 on both have the mean frequency: no frequency difference is left, only the drift of the "
                "slow phases:",
                rows(forms["Delta_omega"])[2],
                rows(forms["theta_Q"])[2],
                zero=rows(forms["Delta_omega"])[2],
            ),
        ),
        forms,
    )


def _effect_14() -> str:
    cycle = at_table_3()
    middle = cycle.durations()[1] / 2
    names = context(cycle, "addredu", middle)
    printed = row_value(EQ14["theta_Q"], names)
    derived = row_value(corrected_14()["theta_Q"], names)
    rate = abs(mp.diff(lambda u: _slow_angle(cycle, u), middle))
    wrapped = mp.arg(mp.expj(printed - derived))
    return (
        f"At Table 3, from a steady start, in the middle of T_addredu, the printed theta_Q differs by "
        f"{figure(wrapped, 3)} rad. The vectors really part at {figure(rate / (2 * mp.pi), 4)} Hz there, not at half "
        "of 3000 Hz: the slow phase adds the rest."
    )


def _slow_angle(cycle: Cycle, time: mp.mpf) -> mp.mpf:
    a, b = (cycle.vector(phase, "addredu", time) for phase in "AB")
    return mp.arg(b / a)


# --- (15) ---------------------------------------------------------------------------------------------------
EQ15: Forms = {"T_redu": 2 * sp.pi / redu, "T_addredu": 2 * sp.pi / addredu, "T_add": 2 * sp.pi / add}


def _ratio(name: str, difference: float, time: mp.mpf) -> mp.mpc:
    """Vector of B over that of A for constant amplitudes, driven a difference in rad/s off resonance."""
    forced, free = mp.expj(difference * time), mp.mpf("0.6") * mp.expj(mp.mpf("0.4"))
    above = {"T_redu": 1j * forced, "T_addredu": mp.mpc(1), "T_add": 1j * forced + mp.mpf("0.7") * mp.expj(2)}
    return above[name] / (1 if name == "T_redu" else forced + free)


def _derive_15() -> Derivation:
    period = 2 * sp.pi / sp.Abs(redu)
    forms = {"T_redu": period, "T_addredu": sp.pi / sp.Abs(addredu), "T_add": period}
    turn = sp.cos(redu * (t + 2 * sp.pi / redu) + theta_Q) - sp.cos(redu * t + theta_Q)
    forced, free = sp.symbols("F R", positive=True)
    length = forced**2 + free**2 + 2 * forced * free * sp.cos(2 * addredu * t)
    other = sp.Symbol("S", positive=True)
    both = (sp.I * forced * sp.exp(sp.I * redu * t) + other) / (forced * sp.exp(sp.I * redu * t) + free)
    return Derivation(
        (
            step(
                "A beat repeats when the phase difference has turned once; a period is positive, also when the drive "
                "lies below resonance (eq. A9 has the bars):",
                sp.Eq(sym("T_redu")[0], period),
                zero=sp.expand_trig(sp.expand(turn)),
            ),
            step(
                "In T_addredu A is a forced vector of length F, omega_q fast, and a free one of length R, omega_n "
                "fast; B is free. Seen from the free ones the forced one turns with omega_q - omega_n = 2 "
                "Delta_omega_addredu (14), and A's length and direction repeat when that has turned once. Half of it "
                "is the rate of the mean angle alone; the slow phase varphi_Baddredu carries the other half.",
                sp.Eq(sp.Symbol("A") ** 2, length),
                sp.Eq(sym("T_addredu")[0], forms["T_addredu"]),
                zero=sp.expand_trig(sp.expand(length.subs(t, t + sp.pi / addredu) - length)),
            ),
            step(
                "In T_add both phases are forced and free. Their mean angles turn alike, so Delta_omega_add = 0 (14), "
                "but their lengths and slow phases do not stand still: seen from the free vectors both forced ones "
                "turn "
                "with omega_q - omega_n = Delta_omega_redu, and B over A repeats when they have turned once. That is "
                "the beat of the envelope in Sect. 5.2.3 too.",
                both,
                sp.Eq(sym("T_add")[0], forms["T_add"]),
                zero=sp.simplify(both.subs(t, t + 2 * sp.pi / redu) - both),
            ),
        ),
        forms,
    )


def _judge_15(forms: Forms) -> Iterator[Evidence]:
    problems, off, close = [], mp.mpf(0), mp.inf
    for name, share in (("T_redu", sp.Integer(1)), ("T_addredu", sp.Rational(1, 2)), ("T_add", sp.Integer(0))):
        for difference in (18850, -17000):
            rates = {redu: difference, addredu: difference / sp.Integer(2), add: 0}
            period = forms[name].subs(rates)
            if not period.is_finite:
                problems.append(f"{name} divides by a rate of 0 (14)")
                continue
            if not period.is_positive:
                problems.append(f"{name} is not positive for a rate of {difference * share} rad/s")
            length = abs(mp.mpmathify(sp.N(period, 40)))
            for time in (mp.mpf("1e-5"), mp.mpf("1.7e-4")):
                now = _ratio(name, difference, time)
                off = worse(off, abs(_ratio(name, difference, time + length) - now))
                for part in (2, 3, 5):
                    close = -worse(-close, -abs(_ratio(name, difference, time + length / part) - now))
    yield evidence("domain", not problems, "; ".join(dict.fromkeys(problems)) or "positive and finite periods")
    yield evidence(
        "numeric",
        off < mp.mpf(10) ** -25 and close > mp.mpf("0.05"),
        "for constant amplitudes the phases' vectors stand to each other as before after each period, "
        f"off by {mp.nstr(off, 2)}, and not after a half, third or fifth of it, off by "
        f"{mp.nstr(close, 2)}",
    )


def _repair_15(forms: Forms) -> Forms:
    return {
        "T_redu": forms["T_redu"].subs(redu, sp.Abs(redu)),
        "T_addredu": forms["T_addredu"].subs(addredu, 2 * sp.Abs(addredu)),
        "T_add": forms["T_add"].subs(add, sp.Abs(redu)),
    }


def _effect_15() -> str:
    cycle = at_table_3()
    beat = 2 * mp.pi / (cycle["omega_q"] - cycle["omega_n"])
    lengths = ", ".join(figure(1000 * v, 4) for v in cycle.durations())
    return (
        f"At 3000 Hz T_redu = {figure(1000 * beat, 4)} ms; T_addredu and T_add are the same, printed "
        f"{figure(2000 * beat, 4)} ms, {figure(100 * (2000 * beat / (1000 * beat) - 1))} % too long, and no number. "
        f"With 14 of 20 pulses the regions last {lengths} "
        "ms: no region holds a whole beat."
    )


ENTRIES = (
    Entry(
        id="12",
        section="3.3",
        title="Amplitude of the vertical displacement",
        place="Sect. 3.3",
        printed=EQ12,
        units={"A_Q": "m"},
        verdict="verified",
        reason="The law of cosines for two rotating vectors.",
        judge=_judge_12,
        derive=_derive_12,
        effect=_effect_12,
    ),
    Entry(
        id="13",
        section="3.3",
        title="Amplitude vectors of the two phases",
        place="Sect. 3.3",
        printed=EQ13,
        units={"A_A": "m", "A_B": "m"},
        verdict="approximation",
        reason="The amplitudes of (9) and (10), but for A_B after t_2: it takes over (10)'s second row, which lacks "
        "the factor omega_q/omega_n and is exact at resonance only. That row needs no "
        "supplement; the rows with A_ABaddredu and A_Badd are judged with these as reconstructed here.",
        judge=_judge_13,
        derive=_derive_13,
        effect=_effect_13,
    ),
    Entry(
        id="14",
        section="3.3",
        title="Frequency difference, start and phase difference",
        place="Sect. 3.3",
        printed=EQ14,
        units={"Delta_omega": "rad/s", "t_Q": "s", "theta_Q": "rad"},
        verdict="erratum",
        reason="theta_Q's one row is printed three times and is not the phase difference of (9) and (10); the row of "
        "Delta omega in T_add is missing, where it is 0. Its angles are the missing supplement's, judged as "
        "reconstructed here, with mean frequencies and slow phases: whether theta_Q is wrong, and that "
        "Delta omega is 0 rather than (omega_q - omega_n) where the slow phases are counted in, hangs on that.",
        judge=_judge_14,
        derive=_derive_14,
        effect=_effect_14,
        repair=_repair_14,
        found_by=("numeric", "domain", "identity"),
    ),
    Entry(
        id="15",
        section="3.3",
        title="Beat periods in the three regions",
        place="Sect. 3.3",
        printed=EQ15,
        units={"T_redu": "s", "T_addredu": "s", "T_add": "s"},
        verdict="erratum",
        reason="Negative for a drive below resonance (A9 has the bars that lack here); T_addredu is twice the beat, "
        "which repeats with the whole difference; T_add divides by zero: Delta_omega_add is the rate at which "
        "the "
        "mean angles part, 0, while lengths and slow phases beat with the whole difference there as well.",
        judge=_judge_15,
        derive=_derive_15,
        effect=_effect_15,
        repair=_repair_15,
        found_by=("domain", "numeric"),
    ),
)
