"""Section 3.3, modal responses and rotating vectors: eqs. (9), (10) and (12) to (15)."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import mpmath as mp
import sympy as sp

from derivations import phases, supplement
from derivations.ledger.exact import REGIONS, Cycle, at_table_3
from derivations.ledger.judge import agrees, evaluate, points, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.regions import by_region, context, row_value, rows, worst
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "EQ9", "EQ10", "corrected_10", "rotating_vector"]

t, tau, t_1, t_2, t_3, t_4, xi = sym("t tau t_1 t_2 t_3 t_4 xi")
omega_n, omega_q, omega_d, W_maxf, k_c, x, Delta_omega = sym("omega_n omega_q omega_d W_maxf k_c x Delta_omega")
varphi_Aredu, A_AB, Theta_A, Psi_A, varphi_A = sym(
    "varphi_Aredu A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu"
)
A_Badd, Theta_B, Psi_B, varphi_B = sym("A_Badd Theta_Badd Psi_Badd varphi_Badd")
A_Q, A_A, A_B, t_Q, theta_Q = sym("A_Q A_A A_B t_Q theta_Q")
redu, addredu, add = sym("Delta_omega_redu Delta_omega_addredu Delta_omega_add")
mean = (omega_n + omega_q) / 2
half_A = (Theta_A + Psi_A) / 2
_LIMIT = 0.01


def _sine(argument: sp.Expr) -> sp.Expr:
    """A sine as printed: SymPy would turn sin(u + pi/2) into cos(u)."""
    return sp.sin(argument, evaluate=False)


def _cosine(argument: sp.Expr) -> sp.Expr:
    return sp.cos(argument, evaluate=False)


# --- (9), (10) ----------------------------------------------------------------------------------------------
EQ9: Forms = {
    "w_A": by_region(
        (W_maxf * sp.exp(-xi * omega_n * (t - t_1)) * sp.sin(omega_n * (t - t_1) + varphi_Aredu), 1, 2),
        (A_AB * sp.sin(mean * (t - t_2) + half_A + varphi_A), 2, 3),
        (A_AB * sp.sin(mean * (t - t_3) + mean * (t_3 - t_2) + half_A + varphi_A), 3, 4),
    )
}
EQ10: Forms = {
    "w_B": by_region(
        (W_maxf * _sine(omega_q * (t - t_1) + sp.pi / 2), 1, 2),
        (W_maxf * sp.exp(-xi * omega_n * (t - t_2)) * _cosine(omega_n * (t - t_2) + sp.pi / 2), 2, 3),
        (A_Badd * _sine(mean * (t - t_3) + (Theta_B + sp.pi + Psi_B) / 2 + varphi_B), 3, 4),
    )
}


def _response_error(form: sp.Basic, phase: str) -> Callable[[Cycle, str, mp.mpf], mp.mpf]:
    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        value = row_value(form, context(cycle, region, time))
        return mp.inf if value is None else abs(value - cycle.response(phase, region, time)[0]) / cycle["W"]

    return error


def _shares(found: dict[str, mp.mpf]) -> str:
    return ", ".join(f"{mp.nstr(100 * value, 3)} % in T_{region}" for region, value in found.items())


def _jumps(form: sp.Basic, phase: str) -> mp.mpf:
    """The largest jump of displacement (over W) and velocity (over omega_q W) at t_1, t_2, t_3."""
    cycle = at_table_3()
    lengths = cycle.durations()
    step_ = lengths[0] / 10**7
    found = mp.mpf(0)
    for index, region in enumerate(REGIONS):
        late = [row_value(form, context(cycle, region, i * step_)) for i in (1, 2)]
        if any(value is None for value in late):
            return mp.inf
        after = late[0], (late[1] - late[0]) / step_
        if index:
            end, previous = lengths[index - 1], REGIONS[index - 1]
            early = [row_value(form, context(cycle, previous, end - i * step_)) for i in (2, 1)]
            before = early[1], (early[1] - early[0]) / step_
        else:
            lead = mp.pi / 2 if phase == "B" else 0
            before = cycle["W"] * mp.cos(lead), -cycle["W"] * cycle["omega_q"] * mp.sin(lead)
        found = max(found, abs(after[0] - before[0]) / cycle["W"],
                    abs(after[1] - before[1]) / (cycle["W"] * cycle["omega_q"]))  # fmt: skip
    return found


def _judge_response(name: str, phase: str) -> Callable[[Forms], Iterator[Evidence]]:
    def judge(forms: Forms) -> Iterator[Evidence]:
        form = forms[name]
        found = worst(_response_error(form, phase))
        yield evidence("error_size", max(found.values()) < _LIMIT,
                       f"off the response chained as complex exponentials, in W, by {_shares(found)}; allowed 1 %")  # fmt: skip
        jump = _jumps(form, phase)
        yield evidence("continuity", jump < _LIMIT,
                       f"displacement and velocity jump by {mp.nstr(100 * jump, 3)} % at most at t_1, t_2, t_3")  # fmt: skip

    return judge


def _derive_9() -> Derivation:
    R, theta = supplement.free_polar()
    shifted = mean * (t - t_3) + mean * (t_3 - t_2) - mean * (t - t_2)
    return Derivation(
        (
            step("A is off from t_1: free motion from the steady state's displacement W and velocity 0 (switched at the "
                 "drive's phase 0), so its amplitude is W_maxf/sqrt(1 - xi^2) and its frequency omega_d:", R, theta),
            step("From t_2 A is on: forced and free motion, by the supplement's sum to product a sine of the mean frequency "
                 "with beating amplitude and phase. The paper sets omega_d = omega_n:",
                 sp.Eq(omega_d, supplement.damped_frequency())),
            step("From t_3 on nothing changes for A; the third row is the second with t - t_2 = (t - t_3) + (t_3 - t_2):",
                 EQ9["w_A"].args[2][0], zero=shifted),
        ),
        EQ9,
    )  # fmt: skip


def corrected_10() -> Forms:
    """(10) at the paper's level, omega_d = omega_n, from the steady response and the continuity at t_2."""
    on = W_maxf * sp.sin(omega_q * (t - t_1) + supplement.forced_phase("B").subs(phases.psi, 0))
    start = [v.subs({phases.psi: 0, phases.W: W_maxf}) for v in supplement.free_start("B", "addredu")]
    radius = sp.Abs(start[1]) / omega_n  # the displacement is 0 there
    angle = sp.pi if start[1].is_negative else sp.Integer(0)
    off = radius * sp.exp(-xi * omega_n * (t - t_2)) * sp.sin(omega_n * (t - t_2) + angle)
    again = A_Badd * sp.sin(mean * (t - t_3) + (Theta_B + Psi_B) / 2 + varphi_B + sp.pi / 2)
    return {"w_B": by_region((on, 1, 2), (off, 2, 3), (again, 3, 4))}


def _repair_10(forms: Forms) -> Forms:
    first, second, third = rows(forms["w_B"])
    first = first.replace(lambda e: isinstance(e, sp.sin), lambda e: sp.cos(*e.args))
    return {"w_B": by_region((first, 1, 2), (second * omega_q / omega_n, 2, 3), (third, 3, 4))}


def _derive_10() -> Derivation:
    start = [v.subs({phases.psi: 0, phases.W: W_maxf}) for v in supplement.free_start("B", "addredu")]
    forms = corrected_10()
    first, second, _ = rows(forms["w_B"])
    return Derivation(
        (
            step("B leads A by a quarter period. A begins as W cos(omega_q (t - t_1)), so B is, and (18) and (23) agree,",
                 first, zero=sp.expand_trig(first - W_maxf * sp.cos(omega_q * (t - t_1) + sp.pi / 2))),
            step("As printed, with the sine, both phases would swing together: no travelling wave, and B would jump by "
                 "W_maxf at t_2, where the next row starts from 0."),
            step("B is switched off at t_2 in the zero of its displacement and at the largest velocity:",
                 sp.Tuple(*start), zero=[start[0], start[1] + W_maxf * omega_q]),
            step("The free motion takes this velocity over at its own frequency, so its amplitude is omega_q/omega_n times "
                 "W_maxf:", second,
                 zero=sp.expand(second.diff(t).subs(t, t_2) + W_maxf * omega_q)),
            step("From t_3 on B is forced and free, as in the supplement; Psi_Badd counts without the pi written out.",
                 rows(forms["w_B"])[2]),
        ),
        forms,
    )  # fmt: skip


def _effect_9() -> str:
    cycle = at_table_3()
    found = {r: max(_response_error(EQ9["w_A"], "A")(cycle, r, u) for u in cycle.times(r, 8)) for r in REGIONS}
    names = [context(cycle, r, u) for r, u in zip(REGIONS, cycle.durations(), strict=True)]
    plain = abs(mp.pi / 2 - names[0]["varphi_Aredu"])
    return (
        f"At the operating point off by {_shares(found)} of W. phi_Aredu = pi/2, which (19) and (23) use, is off by "
        f"{mp.nstr(plain, 3)} rad. The amplitude A_ABaddredu is no constant: at t_3 it is "
        f"{mp.nstr(names[1]['A_ABaddredu'] / cycle['W'], 4)} W_maxf, at t_4 {mp.nstr(names[2]['A_ABaddredu'] / cycle['W'], 4)}."
    )


def _effect_10() -> str:
    cycle = at_table_3()
    ratio = cycle["omega_q"] / cycle["omega_n"] - 1
    return (
        f"Row 1 as printed puts B in phase with A: the speed determinant would be 0 at t_1 instead of its maximum. Row 2 "
        f"starts {mp.nstr(100 * ratio, 3)} % too low in velocity and amplitude, "
        f"{mp.nstr(10**6 * cycle['W'] * ratio, 3)} um."
    )


def _picture_10() -> Picture:
    cycle = at_table_3()
    good = corrected_10()["w_B"]
    curves: dict[str, tuple[list[float], list[float]]] = {"(10) as printed": ([], []), "(10) put right": ([], [])}
    middle = cycle.durations()[0]
    pulse = 2 * mp.pi / cycle["omega_q"]
    for i in range(161):
        time = middle + (mp.mpf(i) / 80 - 1) * 2 * pulse
        region, local = ("redu", time) if time < middle else ("addredu", time - middle)
        names = context(cycle, region, local)
        for label, form in (("(10) as printed", EQ10["w_B"]), ("(10) put right", good)):
            curves[label][0].append(float(1000 * time))
            curves[label][1].append(float(10**6 * row_value(form, names)))
    return Picture("Phase B around t_2, where it is switched off", "t - t_1, ms", "w_B, um", curves)


# --- (12) ---------------------------------------------------------------------------------------------------
EQ12: Forms = {"A_Q": sp.sqrt(A_A**2 + A_B**2 + 2 * A_A * A_B * sp.cos(Delta_omega * (t - t_Q) + theta_Q))}


def _derive_12() -> Derivation:
    angle = Delta_omega * (t - t_Q) + theta_Q
    square = (A_A + A_B * sp.cos(angle)) ** 2 + (A_B * sp.sin(angle)) ** 2
    total = sp.sqrt(A_A**2 + A_B**2 + 2 * A_A * A_B * sp.cos(angle))
    return Derivation(
        (
            step("The two oscillations are projections of vectors of length A_A and A_B; in a frame that turns with the "
                 "first, the second turns by", angle),
            step("Squares of the sum's two components:", square,
                 zero=sp.expand(square - total**2).subs(sp.sin(angle) ** 2, 1 - sp.cos(angle) ** 2)),
        ),
        {"A_Q": total},
    )  # fmt: skip


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
    first = W_maxf * shape_B
    return {
        "A_A": by_region((_envelope(A[0]) * shape_A, 1, 2), (_envelope(A[1]) * shape_A, 2, 4)),
        "A_B": by_region((first, 1, 2), (sp.Abs(W_maxf * omega_q / omega_n) * sp.exp(-xi * omega_n * (t - t_2)) * shape_B, 2, 3),
                         (_envelope(B[2]) * shape_B, 3, 4)),
    }  # fmt: skip


def rotating_vector(cycle: Cycle, phase: str, region: str, time: mp.mpf) -> mp.mpc:
    """The phase as a rotating vector: free motion at omega_d with its decay, forced at omega_q."""
    eigenvalue = cycle["omega_n"] * mp.mpc(-cycle["xi"], mp.sqrt(1 - cycle["xi"] ** 2))
    on = {"A": (0, 1, 1), "B": (1, 0, 1)}[phase][REGIONS.index(region)]
    lead = cycle["psi"] + (mp.pi / 2 if phase == "B" else 0)
    free = cycle.free(phase, region) * mp.exp(eigenvalue * time)
    return free + on * cycle["W"] * mp.expj(cycle["omega_q"] * time + lead)


def _judge_13(forms: Forms) -> Iterator[Evidence]:
    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        place = mp.mpf("0.0013")
        names = {**context(cycle, region, time), "x": place}
        found = mp.mpf(0)
        for phase, shape in (("A", mp.sin), ("B", mp.cos)):
            value = row_value(forms[f"A_{phase}"], names)
            wanted = abs(rotating_vector(cycle, phase, region, time)) * shape(cycle["k_c"] * place)
            found = max(found, mp.inf if value is None else abs(value - wanted) / cycle["W"])
        return found

    found = worst(error)
    yield evidence("numeric", max(found.values()) < _LIMIT,
                   f"off the lengths of the two phases' vectors, in W, by {_shares(found)}; allowed 1 %")  # fmt: skip
    zero = all(row.subs(x, 0) == 0 for row in rows(forms["A_A"]))
    nodes = all(row.subs(x, sp.pi / (2 * k_c)) == 0 for row in rows(forms["A_B"]))
    yield evidence("limit", zero and nodes, "A has its node at x = 0, B a quarter wave further")


def _derive_13() -> Derivation:
    forms = corrected_13()
    return Derivation(
        (
            step("The amplitudes are what stands before the sines of (9) and (10), times the mode shapes of (11):",
                 *rows(forms["A_A"])),
            step("With the amplitude that continuity of the velocity gives B after t_2:", *rows(forms["A_B"]),
                 zero=rows(forms["A_B"])[1].subs(t, t_2) - W_maxf * omega_q / omega_n * sp.cos(k_c * x)),
        ),
        forms,
    )  # fmt: skip


def _repair_13(forms: Forms) -> Forms:
    first, second, third = rows(forms["A_B"])
    return {"A_A": forms["A_A"], "A_B": by_region((first, 1, 2), (second * omega_q / omega_n, 2, 3), (third, 3, 4))}


def _effect_13() -> str:
    cycle = at_table_3()
    ratio = 100 * (1 - cycle["omega_n"] / cycle["omega_q"])
    return f"A_B is {mp.nstr(ratio, 3)} % too small from t_2 to t_3 at the operating point; the other rows are right to 0.1 %."


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
        (omega_q * (t - t_1) + sp.pi), omega_n * (t - t_2) + sp.pi, next(iter(B[2].atoms(sp.cos, sp.sin))).args[0]
    ]  # fmt: skip
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
    first, second = rows(forms["Delta_omega"])
    return {
        "Delta_omega": by_region((first, 1, 2), (second, 2, 3), (sp.Integer(0), 3, 4)),
        "t_Q": forms["t_Q"],
        "theta_Q": by_region((sp.pi / 2, 1, 2), (middle, 2, 3), (third, 3, 4)),
    }


def _judge_14(forms: Forms) -> Iterator[Evidence]:
    missing = set()

    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        names = context(cycle, region, time)
        values = [row_value(forms[name], names) for name in ("Delta_omega", "t_Q", "theta_Q")]
        if any(value is None for value in values):
            missing.add(region)
            return mp.mpf(0)
        angle = values[0] * (names["t"] - values[1]) + values[2]
        a, b = (rotating_vector(cycle, phase, region, time) for phase in "AB")
        wanted = mp.arg(b / a)
        return min(abs(mp.expj(angle) - mp.expj(sign * wanted)) for sign in (1, -1))

    found = worst(error)
    absent = ", ".join(f"T_{r}" for r in REGIONS if r in missing) or "none"
    yield evidence("numeric", max(found.values()) < 2 * _LIMIT,
                   f"the angle between the two phases' vectors is off by {_radians(found)}; allowed 0.02 rad")  # fmt: skip
    yield evidence("domain", not missing, f"regions without a row: {absent}")
    plain = [row.subs({omega_q: omega_n}) for row in rows(forms["Delta_omega"])]
    yield evidence("limit", all(vanishes(p) for p in plain), "no beat when driven at resonance")


def _radians(found: dict[str, mp.mpf]) -> str:
    return ", ".join(f"{mp.nstr(value, 3)} rad in T_{region}" for region, value in found.items())


def _derive_14() -> Derivation:
    forms = corrected_14()
    return Derivation(
        (
            step("From t_1 to t_2 B turns with omega_q and leads by pi/2, A turns freely with omega_n:",
                 rows(forms["Delta_omega"])[0], rows(forms["theta_Q"])[0],
                 zero=[rows(forms["Delta_omega"])[0] - (omega_q - omega_n), rows(forms["theta_Q"])[0] - sp.pi / 2]),
            step("From t_2 to t_3 A has the mean frequency and B turns freely: A runs ahead with half the difference. Its "
                 "phase varphi drifts as well, so the true rate is not constant:",
                 rows(forms["Delta_omega"])[1], rows(forms["theta_Q"])[1]),
            step("From t_3 on both have the mean frequency: no frequency difference is left, only the drift of the slow "
                 "phases:", rows(forms["Delta_omega"])[2], rows(forms["theta_Q"])[2], zero=rows(forms["Delta_omega"])[2]),
        ),
        forms,
    )  # fmt: skip


def _effect_14() -> str:
    cycle = at_table_3()
    middle = cycle.durations()[1] / 2
    names = context(cycle, "addredu", middle)
    printed = row_value(EQ14["theta_Q"], names)
    derived = row_value(corrected_14()["theta_Q"], names)
    rate = abs(mp.diff(lambda u: _slow_angle(cycle, u), middle))
    wrapped = mp.arg(mp.expj(printed - derived))
    return (
        f"In the middle of T_addredu the printed theta_Q differs by {mp.nstr(wrapped, 3)} rad. The vectors really part at "
        f"{mp.nstr(rate / (2 * mp.pi), 4)} Hz there, not at half of 3000 Hz: the slow phase adds the rest."
    )


def _slow_angle(cycle: Cycle, time: mp.mpf) -> mp.mpf:
    a, b = (rotating_vector(cycle, phase, "addredu", time) for phase in "AB")
    return mp.arg(b / a)


# --- (15) ---------------------------------------------------------------------------------------------------
EQ15: Forms = {"T_redu": 2 * sp.pi / redu, "T_addredu": 2 * sp.pi / addredu, "T_add": 2 * sp.pi / add}


def _derive_15() -> Derivation:
    period = 2 * sp.pi / sp.Abs(redu)
    forms = {"T_redu": period, "T_addredu": 2 * sp.pi / sp.Abs(addredu), "T_add": sp.oo}
    turn = sp.cos(redu * (t + 2 * sp.pi / redu) + theta_Q) - sp.cos(redu * t + theta_Q)
    return Derivation(
        (
            step("A beat repeats when the phase difference has turned once; a period is positive, also when the drive lies "
                 "below resonance (eq. A9 has the bars):", sp.Eq(sym("T_redu")[0], period),
                 zero=sp.expand_trig(sp.expand(turn))),
            step("In T_add both phases have the same frequency (14), Delta_omega_add = 0: there is no beat and no period."),
        ),
        forms,
    )  # fmt: skip


def _judge_15(forms: Forms) -> Iterator[Evidence]:
    problems = []
    for name, rate in (("T_redu", redu), ("T_addredu", addredu)):
        for value in (18850, -18850):
            if not forms[name].subs(rate, value).is_positive:
                problems.append(f"{name} is not positive for a rate of {value} rad/s")
    if forms["T_add"].subs(add, 0) != sp.oo:
        problems.append("T_add divides by Delta_omega_add = 0")
    yield evidence("domain", not problems, "; ".join(problems) or "positive periods, none where there is no beat")
    size = [
        sp.Abs(forms[name]) * sp.Abs(rate) / (2 * sp.pi) for name, rate in (("T_redu", redu), ("T_addredu", addredu))
    ]
    for point in points(
        (redu, addredu), 3, "eq15", {"Delta_omega_redu": (1e4, 2e4), "Delta_omega_addredu": (5e3, 1e4)}
    ):
        for expr in size:
            if abs(evaluate(expr, point) - 1) > mp.mpf(10) ** -25:
                yield evidence("numeric", False, "the phase difference has not turned once after a period")
                return
    yield evidence("numeric", True, "the phase difference has turned once after T_redu and after T_addredu")


def _repair_15(forms: Forms) -> Forms:
    return {
        "T_redu": forms["T_redu"].subs(redu, sp.Abs(redu)),
        "T_addredu": forms["T_addredu"].subs(addredu, sp.Abs(addredu)),
        "T_add": sp.oo if forms["T_add"].subs(add, 0) == sp.zoo else forms["T_add"],
    }


def _effect_15() -> str:
    cycle = at_table_3()
    beat = 2 * mp.pi / (cycle["omega_q"] - cycle["omega_n"])
    lengths = [1000 * v for v in cycle.durations()]
    return (
        f"At 3000 Hz T_redu = {mp.nstr(1000 * beat, 4)} ms and T_addredu = {mp.nstr(2000 * beat, 4)} ms, but with 14 of 20 "
        f"pulses the regions last {mp.nstr(lengths[0], 4)}, {mp.nstr(lengths[1], 4)} and {mp.nstr(lengths[2], 4)} ms: no "
        "region holds a whole beat."
    )


ENTRIES = (
    Entry(
        id="9", section="3.3", title="Modal response of phase A", place="Sect. 3.3",
        printed=EQ9, units={"w_A": "m"}, verdict="approximation",
        reason="Right with the reconstructed supplement, but for omega_n in place of omega_d; the first row prints zeta for "
        "xi. The amplitude and phase after t_2 are functions of time.",
        judge=_judge_response("w_A", "A"), derive=_derive_9, effect=_effect_9,
    ),
    Entry(
        id="10", section="3.3", title="Modal response of phase B", place="Sect. 3.3",
        printed=EQ10, units={"w_B": "m"}, verdict="erratum",
        reason="Row 1 has a sine for a cosine, which puts B in phase with A and makes it jump at t_2; row 2 keeps the amplitude "
        "W_maxf where continuity of the velocity asks for W_maxf omega_q/omega_n.",
        judge=_judge_response("w_B", "B"), derive=_derive_10, effect=_effect_10, repair=_repair_10,
        found_by=("error_size", "continuity"), picture=_picture_10,
    ),
    Entry(
        id="12", section="3.3", title="Amplitude of the vertical displacement", place="Sect. 3.3",
        printed=EQ12, units={"A_Q": "m"}, verdict="verified",
        reason="The law of cosines for two rotating vectors.",
        judge=_judge_12, derive=_derive_12, effect=_effect_12,
    ),
    Entry(
        id="13", section="3.3", title="Amplitude vectors of the two phases", place="Sect. 3.3",
        printed=EQ13, units={"A_A": "m", "A_B": "m"}, verdict="erratum",
        reason="The second row of A_B inherits the amplitude of (10), omega_n/omega_q too small.",
        judge=_judge_13, derive=_derive_13, effect=_effect_13, repair=_repair_13, found_by=("numeric",),
    ),
    Entry(
        id="14", section="3.3", title="Frequency difference, start and phase difference", place="Sect. 3.3",
        printed=EQ14, units={"Delta_omega": "rad/s", "t_Q": "s", "theta_Q": "rad"}, verdict="erratum",
        reason="theta_Q's one row is printed three times and is not the phase difference of (9) and (10); the row of "
        "Delta omega in T_add is missing, where it is 0.",
        judge=_judge_14, derive=_derive_14, effect=_effect_14, repair=_repair_14, found_by=("numeric", "domain"),
    ),
    Entry(
        id="15", section="3.3", title="Beat periods in the three regions", place="Sect. 3.3",
        printed=EQ15, units={"T_redu": "s", "T_addredu": "s"}, verdict="erratum",
        reason="Negative for a drive below resonance (A9 has the bars that lack here), and T_add divides by zero: in that "
        "region both phases have the same frequency.",
        judge=_judge_15, derive=_derive_15, effect=_effect_15, repair=_repair_15, found_by=("domain",),
    ),
)  # fmt: skip
