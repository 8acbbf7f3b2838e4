"""Section 3.3, modal responses of the two phases: eqs. (9) and (10)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

import mpmath as mp
import sympy as sp

from derivations import phases, supplement
from derivations.ledger.course import Quantity
from derivations.ledger.exact import REGIONS, Cycle, at_table_3
from derivations.ledger.judge import error_size, figure, largest, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.regions import (
    anywhere,
    by_region,
    context,
    largest_in,
    over_time,
    row_value,
    rows,
    with_rows,
    worst,
)
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "EQ9", "EQ10", "LIMIT", "corrected_10", "shares"]

t, t_1, t_2, t_3, xi = sym("t t_1 t_2 t_3 xi")
omega_n, omega_q, omega_d, W_maxf = sym("omega_n omega_q omega_d W_maxf")
varphi_Aredu, A_AB, Theta_A, Psi_A, varphi_A = sym(
    "varphi_Aredu A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu"
)
A_Badd, Theta_B, Psi_B, varphi_B = sym("A_Badd Theta_Badd Psi_Badd varphi_Badd")
mean = (omega_n + omega_q) / 2
half_A = (Theta_A + Psi_A) / 2
LIMIT = 0.01


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
        return abs(value - cycle.response(phase, region, time)[0]) / cycle["W"]

    return error


def shares(found: dict[str, mp.mpf]) -> str:
    """Errors by region, for a sentence."""
    return ", ".join(f"{mp.nstr(100 * value, 3)} % in T_{region}" for region, value in found.items())


def _jumps(form: sp.Basic, phase: str) -> mp.mpf:
    """The largest jump of displacement (over W) and velocity (over omega_q W) at t_1, t_2, t_3."""
    cycle = at_table_3()
    lengths = cycle.durations()
    step_ = lengths[0] / 10**7
    found = mp.mpf(0)
    for index, region in enumerate(REGIONS):
        late = [row_value(form, context(cycle, region, i * step_)) for i in (1, 2)]
        after = late[0], (late[1] - late[0]) / step_
        if index:
            end, previous = lengths[index - 1], REGIONS[index - 1]
            early = [row_value(form, context(cycle, previous, end - i * step_)) for i in (2, 1)]
            before = early[1], (early[1] - early[0]) / step_
        else:
            lead = mp.pi / 2 if phase == "B" else 0
            before = cycle["W"] * mp.cos(lead), -cycle["W"] * cycle["omega_q"] * mp.sin(lead)
        found = worse(found, abs(after[0] - before[0]) / cycle["W"])
        found = worse(found, abs(after[1] - before[1]) / (cycle["W"] * cycle["omega_q"]))
    return found


_FORCED = {"A": ("addredu", "add"), "B": ("add",)}


def _off_the_sum(form: sp.Basic, phase: str, names: dict[str, mp.mpf]) -> mp.mpf:
    """A row off W sin(omega_q tau + Psi) + R sin(omega_n tau + Theta), with the A and varphi of that sum, over W."""
    first, suffix = ("t_2", "addredu") if phase == "A" else ("t_3", "add")
    theta, psi = names[f"Theta_B{suffix}"], names["Psi_Aaddredu" if phase == "A" else "Psi_Badd"]
    psi += mp.pi if phase == "B" else 0  # (10) writes the pi of B's forced motion out
    tau, n, q = names["t"] - names[first], names["omega_n"], names["omega_q"]
    free = names["W_maxf"] * mp.mpf("0.7") * mp.expj(n * tau + theta)
    total = names["W_maxf"] * mp.expj(q * tau + psi) + free
    slow = mp.arg(total * mp.expj(-((n + q) * tau + theta + psi) / 2))
    amplitude = "A_ABaddredu" if phase == "A" else "A_Badd"
    value = row_value(form, {**names, amplitude: abs(total), f"varphi_B{suffix}": slow})
    return abs(value - mp.im(total)) / names["W_maxf"]


def _judge_response(name: str, phase: str) -> Callable[[Forms], Iterator[Evidence]]:
    def judge(forms: Forms) -> Iterator[Evidence]:
        form = forms[name]
        sums = largest(
            _off_the_sum(form, phase, names)
            for region in _FORCED[phase]
            for names in anywhere(region, 3, f"sum {name}")
        )
        yield evidence(
            "identity",
            sums < mp.mpf(10) ** -25,
            "with the amplitude and the phase of the sum, whatever they are, it is the sum of forced and "
            f"free motion, to {mp.nstr(sums, 2)} of W",
        )
        found = worst(_response_error(form, phase))
        yield evidence(
            "error_size",
            largest(found.values()) < LIMIT,
            f"off the response chained as complex exponentials, in W, by {shares(found)}; allowed 1 %",
        )
        if phase == "A":  # (9) takes omega_n for omega_d; (10) does too, but has worse faults

            def off(cycle: Cycle) -> float:
                error = _response_error(form, phase)
                return float(largest(error(cycle, region, u) for region in REGIONS for u in cycle.times(region, 4)))

            damped = at_table_3()
            undamped = Cycle({**damped.values, "xi": damped["xi"] / 100})
            most = float(largest(found.values()))
            yield error_size("w_A, in W,", lambda: (off(damped), most), "small damping, xi -> 0", lambda: off(undamped))
        jump = _jumps(form, phase)
        yield evidence(
            "continuity",
            jump < LIMIT,
            f"displacement and velocity jump by {mp.nstr(100 * jump, 3)} % at most at t_1, t_2, t_3",
        )

    return judge


def _derive_9() -> Derivation:
    R, theta = supplement.free_polar()
    shifted = mean * (t - t_3) + mean * (t_3 - t_2) - mean * (t - t_2)
    return Derivation(
        (
            step(
                "A is off from t_1: free motion from the steady state's displacement W and velocity 0 (switched at "
                "the drive's phase 0), so its amplitude is W_maxf/sqrt(1 - xi^2) and its frequency omega_d:",
                R,
                theta,
            ),
            step(
                "From t_2 A is on: forced and free motion, by the supplement's sum to product a sine of the mean "
                "frequency with beating amplitude and phase. The paper sets omega_d = omega_n:",
                sp.Eq(omega_d, supplement.damped_frequency()),
            ),
            step(
                "From t_3 on nothing changes for A; the third row is the second with t - t_2 = (t - t_3) + (t_3 - "
                "t_2):",
                EQ9["w_A"].args[2][0],
                zero=shifted,
            ),
        ),
        EQ9,
    )


@cache
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
    return {"w_B": with_rows(forms["w_B"], (first, second * omega_q / omega_n, third))}


def _derive_10() -> Derivation:
    start = [v.subs({phases.psi: 0, phases.W: W_maxf}) for v in supplement.free_start("B", "addredu")]
    forms = corrected_10()
    first, second, _ = rows(forms["w_B"])
    return Derivation(
        (
            step(
                "B leads A by a quarter period. A begins as W cos(omega_q (t - t_1)), so B is, and (18) and (23) "
                "agree,",
                first,
                zero=sp.expand_trig(first - W_maxf * sp.cos(omega_q * (t - t_1) + sp.pi / 2)),
            ),
            step(
                "As printed, with the sine, both phases would swing together: no travelling wave, and B would jump by "
                "W_maxf at t_2, where the next row starts from 0."
            ),
            step(
                "B is switched off at t_2 in the zero of its displacement and at the largest velocity:",
                sp.Tuple(*start),
                zero=[start[0], start[1] + W_maxf * omega_q],
            ),
            step(
                "The free motion takes this velocity over at its own frequency, so its amplitude is omega_q/omega_n "
                "times W_maxf:",
                second,
                zero=sp.expand(second.diff(t).subs(t, t_2) + W_maxf * omega_q),
            ),
            step(
                "From t_3 on B is forced and free, as in the supplement; Psi_Badd counts without the pi written out.",
                rows(forms["w_B"])[2],
            ),
        ),
        forms,
    )


def _off_A(printed: Quantity) -> Quantity:
    return lambda h: printed(h) - h.w_A


def _effect_9() -> str:
    cycle, row = at_table_3(), EQ9["w_A"]
    sizes = []
    for region in REGIONS:
        off = largest_in(region, _off_A(over_time(row, region)))
        sizes.append(f"{figure(100 * off / float(cycle['W']), 3)} % in T_{region}")
    names = [context(cycle, r, u) for r, u in zip(REGIONS, cycle.durations(), strict=True)]
    plain = abs(mp.pi / 2 - names[0]["varphi_Aredu"])
    return (
        f"At Table 3, from a steady start, off by at most {', '.join(sizes)}, of W. phi_Aredu = pi/2, which (19) and "
        f"(23) use, is off by {figure(plain, 3)} rad. The amplitude A_ABaddredu is no constant: at t_3 it is "
        f"{figure(names[1]['A_ABaddredu'] / cycle['W'], 4)} W_maxf, at t_4 "
        f"{figure(names[2]['A_ABaddredu'] / cycle['W'], 4)}."
    )


def _effect_10() -> str:
    cycle = at_table_3()
    ratio = cycle["omega_q"] / cycle["omega_n"] - 1
    return (
        "At Table 3, from a steady start: row 1 as printed puts B in phase with A, and the determinant would be 0 at "
        "t_1 instead of D k_c W^2 omega_q. Row "
        f"2 starts with an amplitude and a velocity from which {figure(100 * ratio, 3)} % of W are missing, "
        f"{figure(10**6 * cycle['W'] * ratio, 3)} um."
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


ENTRIES = (
    Entry(
        id="9",
        section="3.3",
        title="Modal response of phase A",
        place="Sect. 3.3",
        printed=EQ9,
        units={"w_A": "m"},
        verdict="approximation",
        reason="Right with the supplement as reconstructed here, but for omega_n in place of omega_d; the first row "
        "prints zeta for xi. The amplitude and phase after t_2 are functions of time. The supplement that "
        "defines "
        "them is not at hand: another one that also keeps displacement and velocity continuous would be the "
        "same "
        "motion in other symbols, which the rows might then fit or not.",
        judge=_judge_response("w_A", "A"),
        derive=_derive_9,
        effect=_effect_9,
    ),
    Entry(
        id="10",
        section="3.3",
        title="Modal response of phase B",
        place="Sect. 3.3",
        printed=EQ10,
        units={"w_B": "m"},
        verdict="erratum",
        reason="Row 1 has a sine for a cosine, which puts B in phase with A and makes it jump at t_2; row 2 keeps the "
        "amplitude W_maxf where continuity of the velocity asks for W_maxf omega_q/omega_n.",
        judge=_judge_response("w_B", "B"),
        derive=_derive_10,
        effect=_effect_10,
        repair=_repair_10,
        found_by=("error_size", "continuity"),
        picture=_picture_10,
    ),
)
