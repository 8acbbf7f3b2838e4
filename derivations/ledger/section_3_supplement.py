"""The missing supplement of Section 3.3: amplitudes and phases in the three regions, reconstructed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial

import mpmath as mp
import sympy as sp

from derivations import phases, supplement
from derivations.ledger.exact import Cycle, at_table_3, random_cycles
from derivations.ledger.judge import evaluate, figure, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "displacement", "supplement_forms", "values"]

tau, omega_n, omega_q, omega_d, xi, W, a, b = sym("tau omega_n omega_q omega_d xi W a b")
# region -> (phase, amplitude of the free motion, Theta, Psi, A, varphi)
_NAMES = {
    "redu": ("A", "A_Aredu", "varphi_Aredu", "", "", ""),
    "addredu": ("A", "R_Aaddredu", "Theta_Baddredu", "Psi_Aaddredu", "A_ABaddredu", "varphi_Baddredu"),
    "add": ("B", "R_Badd", "Theta_Badd", "Psi_Badd", "A_Badd", "varphi_Badd"),
}


@cache
def supplement_forms(region: str) -> dict[str, sp.Expr]:
    """Initial conditions, free motion, and product form of the phase that the region needs them for."""
    phase, radius, theta, psi, amplitude, slow = _NAMES[region]
    start = supplement.free_start(phase, region)
    initial = dict(zip((f"a_{phase}", f"b_{phase}"), start, strict=True))
    local = dict(zip((a, b), sym(" ".join(initial)), strict=True))
    polar = [value.subs(local) for value in supplement.free_polar()]
    forms = {"omega_d": supplement.damped_frequency(), **initial, radius: polar[0], theta: polar[1]}
    if not psi:
        return forms
    offset = sp.pi if phase == "B" else 0  # (10) writes the pi of B's forced phase out
    forms[psi] = supplement.forced_phase(phase) - offset
    symbols = sym(f"{radius} {theta} {psi}")
    forms[amplitude], forms[slow] = supplement.beating(symbols[0], symbols[1], symbols[2] + offset)
    return forms


def values(forms: Forms, cycle: Cycle, time: mp.mpf) -> dict[str, mp.mpf]:
    """The forms' values, each from those before it, tau after the start of their region."""
    names = {**cycle.values, "tau": time}
    for name, form in forms.items():
        expr = sp.sympify(form)
        names[name] = evaluate(expr, {symbol: names[symbol.name] for symbol in expr.free_symbols})
    return {name: names[name] for name in forms}


def displacement(region: str, forms: Forms, cycle: Cycle, time: mp.mpf) -> mp.mpf:
    """W of the region's phase from the forms."""
    phase, radius, theta, psi, amplitude, slow = _NAMES[region]
    v = values(forms, cycle, time)
    if not psi:
        decay = mp.exp(-cycle["xi"] * cycle["omega_n"] * time)
        return v[radius] * decay * mp.sin(v["omega_d"] * time + v[theta])
    offset = mp.pi if phase == "B" else 0
    mean = ((v["omega_d"] + cycle["omega_q"]) * time + v[theta] + v[psi] + offset) / 2
    return v[amplitude] * mp.sin(mean + v[slow])


def _judge(region: str) -> Callable[[Forms], Iterator[Evidence]]:
    phase = _NAMES[region][0]

    def judge(forms: Forms) -> Iterator[Evidence]:
        def at(cycle: Cycle, time: mp.mpf) -> mp.mpf:
            return displacement(region, forms, cycle, time)

        for cycle in random_cycles(2, "damped"):
            roots = mp.polyroots([1, 2 * cycle["xi"], 1])
            rate = values({"omega_d": forms["omega_d"]}, cycle, mp.mpf(0))["omega_d"]
            off = abs(rate / cycle["omega_n"] / max(mp.im(root) for root in roots) - 1)
            if not off <= mp.mpf(10) ** -25:
                yield evidence("domain", False, "omega_d is not the frequency of the oscillator's free motion")
                return
        worst = worst_start = worst_ode = mp.mpf(0)
        for cycle in random_cycles(4, f"supplement {region}", psi=True):
            size = cycle["W"]
            for time in cycle.times(region, 3):
                worst = worse(worst, abs(at(cycle, time) - cycle.response(phase, region, time)[0]) / size)
        yield evidence(
            "numeric",
            worst < mp.mpf(10) ** -25,
            "w from these amplitudes and phases is the response chained as complex exponentials from t_1 "
            f"on, to {mp.nstr(worst, 2)} of W",
        )
        for cycle in random_cycles(3, f"start {region}", psi=True):
            before = _before(cycle, phase, region)
            now = at(cycle, mp.mpf(0)), mp.diff(lambda u, c=cycle: at(c, u), 0)
            rate = cycle["omega_q"]
            jump = worse(abs(now[0] - before[0]), abs(now[1] - before[1]) / rate) / cycle["W"]
            worst_start = worse(worst_start, jump)
        yield evidence(
            "continuity",
            worst_start < mp.mpf(10) ** -15,
            f"displacement and velocity pass the switching with a jump of {mp.nstr(worst_start, 2)} of W",
        )
        for cycle in random_cycles(2, f"ode {region}", psi=True):
            worst_ode = worse(worst_ode, _residual(cycle, phase, region, partial(at, cycle)))
        yield evidence(
            "identity",
            worst_ode < mp.mpf(10) ** -10,
            f"solves w'' + 2 xi omega_n w' + omega_n^2 w = forcing to {mp.nstr(worst_ode, 2)} of omega_n^2 "
            "W, derivatives taken numerically",
        )

    return judge


def _before(cycle: Cycle, phase: str, region: str) -> tuple[mp.mpf, mp.mpf]:
    """Displacement and velocity at the end of what precedes a region; before t_1 the steady state."""
    order = ("redu", "addredu", "add")
    index = order.index(region)
    if index:
        return cycle.response(phase, order[index - 1], cycle.durations()[index - 1])
    angle = cycle["psi"] + (mp.pi / 2 if phase == "B" else 0)
    return cycle["W"] * mp.cos(angle), -cycle["W"] * cycle["omega_q"] * mp.sin(angle)


def _residual(cycle: Cycle, phase: str, region: str, w: Callable[[mp.mpf], mp.mpf]) -> mp.mpf:
    """Of the oscillator's equation at three times, over omega_n^2 W."""
    rate, n, damping = cycle["omega_q"], cycle["omega_n"], cycle["xi"]
    gate = 0 if region == "redu" else 1
    shift = cycle["psi"] + (mp.pi / 2 if phase == "B" else 0)
    worst = mp.mpf(0)
    for time in cycle.times(region, 3):
        steady = cycle["W"] * mp.expj(rate * time + shift)
        force = gate * mp.re((n**2 - rate**2 + 2j * damping * n * rate) * steady)
        left = mp.diff(w, time, 2) + 2 * damping * n * mp.diff(w, time) + n**2 * w(time)
        worst = worse(worst, abs(left - force) / (n**2 * cycle["W"]))
    return worst


def _derive(region: str) -> Callable[[], Derivation]:
    def derive() -> Derivation:
        phase, radius, theta, psi, amplitude, slow = _NAMES[region]
        forms = supplement_forms(region)
        free_w, free_v = phases.free()
        R, _ = supplement.free_polar()
        polar = sp.Symbol("R") * sp.exp(-xi * omega_n * tau) * sp.sin(omega_d * tau + sp.Symbol("Theta"))
        rows = sp.expand(sp.expand_trig(polar))
        rows = rows.subs(
            {sp.sin(sp.Symbol("Theta")): a / R, sp.cos(sp.Symbol("Theta")): (b + xi * omega_n * a) / omega_d / R}
        )
        rows = rows.subs(sp.Symbol("R"), R).subs(omega_d, supplement.damped_frequency())
        steps = [
            step("Free motion from displacement a and velocity b at the region's start:", free_w, free_v),
            step(
                "Displacement and velocity are continuous at the switching, so the free motion is what the phase "
                "does less what it would do in steady state. From the steady state before t_1 this gives, at the "
                "region's start,",
                *(sp.Eq(sym(f"{letter}_{phase}")[0], forms[f"{letter}_{phase}"]) for letter in "ab"),
            ),
            step(
                "As one sine, R exp(-xi omega_n tau) sin(omega_d tau + Theta):",
                sp.Eq(sym(radius)[0], forms[radius]),
                sp.Eq(sym(theta)[0], forms[theta]),
                zero=sp.expand(rows - free_w),
            ),
        ]
        if psi:
            offset = sp.pi if phase == "B" else 0
            mean, half, P, Q = sp.symbols("mu delta P R", real=True)
            sum_of_sines = P * sp.sin(mean + half) + Q * sp.sin(mean - half)
            product = (P + Q) * sp.cos(half) * sp.sin(mean) + (P - Q) * sp.sin(half) * sp.cos(mean)
            steps += [
                step(
                    "Forced motion W sin(omega_q tau + Psi" + (" + pi)" if offset else ")") + ":",
                    sp.Eq(sym(psi)[0], forms[psi]),
                ),
                step(
                    "Sum to product, with the mean mu and half the difference delta of the two angles:",
                    sp.Eq(sum_of_sines, product),
                    zero=sum_of_sines - product,
                ),
                step(
                    "This is A sin(mu + varphi). A and varphi are no constants: they beat with omega_q - omega_d and "
                    "follow the decay.",
                    sp.Eq(sym(amplitude)[0], forms[amplitude]),
                    sp.Eq(sym(slow)[0], forms[slow]),
                    zero=_polar_zero(P, Q, half),
                ),
            ]
        return Derivation(tuple(steps), forms)

    return derive


def _polar_zero(P: sp.Symbol, R: sp.Symbol, half: sp.Symbol) -> sp.Expr:
    sides = ((P + R) * sp.cos(half)) ** 2 + ((P - R) * sp.sin(half)) ** 2
    return sp.expand(sp.expand_trig(sides - (P**2 + R**2 + 2 * P * R * sp.cos(2 * half)))).subs(
        sp.sin(half) ** 2, 1 - sp.cos(half) ** 2
    )


def _effect(region: str) -> Callable[[], str]:
    def effect() -> str:
        cycle = at_table_3()
        _, radius, theta, psi, amplitude, slow = _NAMES[region]
        length = cycle.durations()[("redu", "addredu", "add").index(region)]
        first, last = (values(supplement_forms(region), cycle, u) for u in (mp.mpf(0), length))
        text = (
            f"At Table 3, from a steady start, the free motion: {figure(10**6 * first[radius], 5)} um at phase "
            f"{figure(first[theta], 5)} rad"
        )
        if psi:
            text += (
                f"; the amplitude runs from {figure(10**6 * first[amplitude], 5)} to "
                f"{figure(10**6 * last[amplitude], 5)} um over the region, its slow phase from "
                f"{figure(first[slow], 4)} to {figure(last[slow], 4)} rad"
            )
        return text + "."

    return effect


def _picture() -> Picture:
    cycle = at_table_3()
    curves: dict[str, tuple[list[float], list[float]]] = {}
    shift = cycle.durations()[0]
    for region, label in (("addredu", "A_ABaddredu"), ("add", "A_Badd")):
        start = shift if region == "addredu" else 2 * shift
        length = cycle.durations()[1 if region == "addredu" else 2] * (1 if region == "add" else 3)
        times = [length * i / 160 for i in range(161)]
        heights = [float(10**6 * values(supplement_forms(region), cycle, u)[label]) for u in times]
        curves[label] = ([float(1000 * (start + u)) for u in times], heights)
    return Picture("Beating amplitudes of the missing supplement", "t - t_1, ms", "um", curves)


def _entry(region: str, title: str, reason: str, picture: Callable[[], Picture] | None = None) -> Entry:
    phase, radius, theta, psi, amplitude, slow = _NAMES[region]
    units: Mapping[str, str] = {"omega_d": "rad/s", f"a_{phase}": "m", f"b_{phase}": "m/s", radius: "m", theta: "rad"}
    if psi:
        units = {**units, psi: "rad", amplitude: "m", slow: "rad"}
    return Entry(
        id=f"supplement-{region}",
        section="3.3",
        title=title,
        place="electronic supplement, missing",
        printed={},
        units=units,
        verdict="reconstructed",
        reason=reason,
        judge=_judge(region),
        derive=_derive(region),
        effect=_effect(region),
        picture=picture,
    )


ENTRIES = (
    _entry(
        "redu",
        "Supplement: phase A decays after t_1",
        "phi_Aredu is not pi/2 but atan2(sqrt(1 - xi^2), xi) for psi = 0: the velocity is continuous too.",
    ),
    _entry(
        "addredu",
        "Supplement: phase A grows again after t_2",
        "Defined in words only in the text; from continuity of displacement and velocity at t_2.",
        _picture,
    ),
    _entry(
        "add",
        "Supplement: phase B grows again after t_3",
        "Defined in words only in the text; from continuity of displacement and velocity at t_3.",
    ),
)
