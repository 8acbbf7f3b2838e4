"""Section 4.1, the friction layer under the wave: eqs. (27) to (32)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import contact, phases, transfer
from derivations.ledger.history import numeric
from derivations.ledger.judge import Point, agrees, evaluate, figure, identical, points, rounded, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import operating_point
from derivations.nomenclature import sym
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = ["ENTRIES", "RANGES"]

F_c, n_j, b_m, h_m, r_t, D, k_c, k_N, theta = sym("F_c n_j b_m h_m r_t D k_c k_N theta")
E_eq, E_m, E_e, mu_e, mu_m, x, t, p, w_A, w_B, k_f = sym("E_eq E_m E_e mu_e mu_m x t p w_A w_B k_f")
rho_k, zeta_zmax, C_E, x_m, x_max, x_xm, x_vm = sym("rho_k zeta_zmax C_E x_m x_max x_xm x_vm")
delta_0, zeta_z, A_p = sym("delta_0 zeta_z A_p")
a_w, b_w, a_v, b_v = sp.symbols("a_w b_w a_v b_v", real=True)  # values of w_A, w_B and of their rates

RANGES: dict[str, tuple[float, float]] = {
    "rho_k": (3.0, 5.0),
    "zeta_zmax": (3e-6, 9e-6),
    "C_E": (1.5e-10, 2.5e-10),
    "x_m": (0.5e-3, 3e-3),
    "x_max": (-5e-3, 5e-3),
    "x_xm": (-5e-3, 5e-3),
    "x_vm": (-5e-3, 5e-3),
    "delta_0": (2e-6, 8e-6),
    "zeta_z": (2e-6, 9e-6),
    "A_p": (3e-6, 5e-6),
    "a_w": (-8e-6, 8e-6),
    "b_w": (-8e-6, 8e-6),
    "a_v": (-1.5, 1.5),
    "b_v": (-1.5, 1.5),
    "s": (1.0, 1.0),
    "W_c": (3e-6, 9e-6),
}


def _crest(point: Mapping[sp.Symbol, mp.mpf]) -> tuple[mp.mpf, mp.mpf]:
    """Height and position of the crest of w_A sin(k_c x) + w_B cos(k_c x)."""
    A, B = point[a_w], point[b_w]
    return mp.hypot(A, B), mp.atan2(A, B) / point[k_c]


# --- (27) ---------------------------------------------------------------------------------------------------
_EQ27: Forms = {"x_xm": x_max + x_m}


def _derive_27() -> Derivation:
    left = x_max - x_m
    return Derivation(
        (
            step(
                "The wave is even about its crest, so both ends of the contact lie x_m from it:",
                zero=(sp.cos(k_c * (x - x_max)).subs(x, x_max + x_m) - sp.cos(k_c * (x - x_max)).subs(x, left)),
            ),
            step("x_xm is the right end; the left one, which eq. 31 and eq. 36 also need, is", left),
        ),
        _EQ27,
    )


def _judge_27(forms: Forms) -> Iterator[Evidence]:
    def right_end(_: str, point: Point) -> mp.mpf:
        """Where a unit wave falls through cos(k x_m) to the right of its crest, by bisection."""
        k = mp.mpf(300)
        low, high = point[x_max], point[x_max] + mp.pi / k
        level = mp.cos(k * point[x_m])
        for _turn in range(120):
            middle = (low + high) / 2
            low, high = (middle, high) if mp.cos(k * (middle - point[x_max])) > level else (low, middle)
        return low

    yield agrees(
        forms,
        right_end,
        symbols=(x_max, x_m),
        ranges=RANGES,
        tolerance=1e-20,
        against="where the wave falls through the layer's surface, by bisection",
    )
    yield evidence("limit", forms["x_xm"].subs(x_m, 0) == x_max, "a contact of length 0 is the crest")


def _effect_27() -> str:
    return f"x_m = {figure(1000 * operating_point()['theta'] / operating_point()['k_c'], 4)} mm on both sides."


# --- (28) ---------------------------------------------------------------------------------------------------
_WAVE = w_A * sp.sin(k_c * x) + w_B * sp.cos(k_c * x)
_EQ28: Forms = {"delta_0": _WAVE.subs(x, x_vm)}
_VALUES: dict[sp.Basic, sp.Basic] = {w_A: a_w, w_B: b_w}


def _derive_28() -> Derivation:
    form = _WAVE.subs(x, x_xm)
    turn = sp.sin(k_c * x_m) * b_w + sp.cos(k_c * x_m) * a_w, sp.cos(k_c * x_m) * b_w - sp.sin(k_c * x_m) * a_w
    height = transfer.crest_amplitude().subs({transfer.w_A: a_w, transfer.w_B: b_w})
    return Derivation(
        (
            step("Eq. 11 at the right end of the contact (eq. 27):", sp.Eq(delta_0, form)),
            step(
                "With k_c x_xm = atan2(w_A, w_B) + k_c x_m this is the crest's displacement times cos(k_c x_m):",
                zero=sp.expand((turn[0] * a_w + turn[1] * b_w) / height - height * sp.cos(k_c * x_m)).simplify(),
            ),
        ),
        {"delta_0": form},
    )


def _judge_28(forms: Forms) -> Iterator[Evidence]:
    undefined = sorted(s.name for form in forms.values() for s in form.free_symbols & {x_vm})
    yield evidence(
        "domain", not undefined, f"every symbol is defined{', but for ' if undefined else ''}" + ", ".join(undefined)
    )
    edge = {x_xm: sp.atan2(a_w, b_w) / k_c + x_m}
    yield agrees(
        forms,
        lambda _, q: _crest(q)[0] * mp.cos(q[k_c] * q[x_m]),
        given={**_VALUES, **edge},
        ranges=RANGES,
        symbols=(a_w, b_w, k_c, x_m),
        against="W_c cos(k_c x_m)",
    )
    symmetric = forms["delta_0"].subs(_VALUES).subs(x_xm, sp.Symbol("e")).subs(a_w, 0)
    yield evidence("identity", symmetric - b_w * sp.cos(k_c * sp.Symbol("e")) == 0, "for a crest at x = 0 it is even")


def _effect_28() -> str:
    q = operating_point()
    level = q["W"] * mp.cos(q["theta"])
    return (
        f"None once x_vm is read as x_xm: delta_0 = {figure(1e6 * level, 4)} um for a steady wave of "
        f"{figure(1e6 * q['W'], 4)} um, an indentation of {figure(1e6 * (q['W'] - level), 3)} um at the crest."
    )


# --- (29) ---------------------------------------------------------------------------------------------------
first_difference, second_difference, dx, dt = sp.symbols("dzeta_z d2zeta_z dx dt", positive=True)
_EQ29: Forms = {"v_xm": D * first_difference / (dx * dt)}
_STEPS: dict[sp.Basic, Dimension] = {
    s: parse_unit("s" if s == dt else "m").dimension for s in (first_difference, second_difference, dx, dt)
}


def _derive_29() -> Derivation:
    form = D * sp.Derivative(_WAVE, x, t).doit().subs(x, x_xm)
    return Derivation(
        (
            step(
                "Tangential displacement D d(zeta_z)/dx (eq. 11); its rate is the mixed second derivative:",
                sp.Eq(sp.Symbol("v_x"), D * sp.Derivative(_WAVE, x, t)),
            ),
            step(
                "at the right end of the contact:",
                sp.Eq(sp.Symbol("v_xm"), form),
                zero=form - (D * _WAVE.diff(x)).diff(t).subs(x, x_xm),
            ),
        ),
        {"v_xm": form},
    )


def _differences(point: Mapping[sp.Symbol, mp.mpf], h: mp.mpf) -> dict[sp.Basic, mp.mpf]:
    """First and mixed second difference of the wave at x_xm for steps of h in space and time."""
    A, B, vA, vB, k, at = (point[s] for s in (a_w, b_w, a_v, b_v, k_c, x_xm))

    def wave(i: int, j: int) -> mp.mpf:
        angle = k * (at + i * h)
        return (A + j * h * vA) * mp.sin(angle) + (B + j * h * vB) * mp.cos(angle)

    second = wave(1, 1) - wave(1, 0) - wave(0, 1) + wave(0, 0)
    return {first_difference: wave(1, 1) - wave(0, 0), second_difference: second, dx: h, dt: h}


def _judge_29(forms: Forms) -> Iterator[Evidence]:
    form = forms["v_xm"].subs({w_A.diff(t): a_v, w_B.diff(t): b_v}).subs(_VALUES)
    (q,) = points((a_w, b_w, a_v, b_v, k_c, D, x_xm), 1, "29", RANGES)

    def at_step(exponent: int) -> mp.mpf:
        with mp.workdps(60):
            known = {**q, **_differences(q, mp.mpf(10) ** exponent)}
            return evaluate(form, {s: known[s] for s in form.free_symbols})

    coarse, fine = at_step(-12), at_step(-14)
    angle = q[k_c] * q[x_xm]
    wanted = q[D] * q[k_c] * (q[a_v] * mp.cos(angle) - q[b_v] * mp.sin(angle))
    yield evidence("limit", abs(coarse - fine) < 1e-8 * abs(fine), "has a limit for ever smaller steps")
    yield evidence(
        "numeric",
        abs(fine - wanted) < 1e-8 * abs(wanted),
        "is the rate of the tangential displacement, D k_c (w_A' cos k_c x - w_B' sin k_c x)",
    )


def _effect_29() -> str:
    q = operating_point()
    crest = q["D"] * q["k_c"] * q["omega_q"] * q["W"]
    return (
        "None once the numerator's missing exponent 2 is put in. For the steady wave the surface runs at "
        f"{figure(1000 * crest * mp.cos(q['theta']), 4)} mm/s at the ends of the contact, {figure(1000 * crest, 4)} "
        "mm/s at the crest."
    )


# --- (30) ---------------------------------------------------------------------------------------------------
_EQ30: Forms = {"p": k_f * A_p * (zeta_z - delta_0)}


def _derive_30() -> Derivation:
    form = contact.layer_stiffness() * (sp.Max(zeta_z, delta_0) - delta_0)
    return Derivation(
        (
            step(
                "Where the wave stands above the undeformed surface, at delta_0, the layer of thickness h_m is "
                "strained by",
                (zeta_z - delta_0) / h_m,
            ),
            step(
                "times E_m it is the stress, times the width b_m the load per length; a layer that does not stick "
                "cannot pull:",
                sp.Eq(sp.Symbol("p"), form),
            ),
        ),
        {"p": form},
    )


def _judge_30(forms: Forms) -> Iterator[Evidence]:
    def layer(_: str, q: Point) -> mp.mpf:
        """Elastic energy of a strip of the layer, differentiated by its compression."""
        sunk = max(mp.mpf(0), q[zeta_z] - q[delta_0])

        def energy(s: mp.mpf) -> mp.mpf:
            return q[E_m] * (s / q[h_m]) ** 2 / 2 * q[b_m] * q[h_m]

        return (energy(sunk + mp.mpf("1e-9")) - energy(sunk - mp.mpf("1e-9"))) / mp.mpf("2e-9")

    yield agrees(
        forms,
        layer,
        symbols=(zeta_z, delta_0, E_m, h_m, b_m),
        ranges=RANGES,
        count=8,
        tolerance=1e-20,
        against="the rate of the layer's energy with its compression, 0 out of contact",
    )
    outside = forms["p"].subs({zeta_z: 1, delta_0: 2})
    yield evidence("domain", outside.is_zero or not outside.is_negative, "the layer never pulls")


def _repair_30(forms: Forms) -> Forms:
    return {"p": forms["p"].subs(k_f * A_p, E_m * b_m / h_m).subs(zeta_z, sp.Max(zeta_z, delta_0))}


def _effect_30() -> str:
    q = operating_point()
    return (
        "k_f is given nowhere and A_p is the ceramic's section (eq. 2); no stiffness in N/m, N/m^2 or N/m^3 gives the "
        f"N/m that eq. 31 integrates. The layer has k_N = E_m b_m/h_m = {figure(q['k_N'], 3)} N/m^2 (with its sides "
        f"held, {figure((1 - q['mu_m']) / (1 + q['mu_m']) / (1 - 2 * q['mu_m']), 4)} times as much)."
    )


# --- (31) ---------------------------------------------------------------------------------------------------
_EQ31: Forms = {"F_c": sp.Integral(p, (x, x_max, x_xm))}
_LAYER = k_N * zeta_zmax * (sp.cos(k_c * (x - x_max)) - sp.cos(theta))


def _derive_31() -> Derivation:
    form = n_j * sp.Integral(p, (x, 2 * x_max - x_xm, x_xm))
    whole = form.subs({p: _LAYER, x_xm: x_max + theta / k_c}).doit()
    balance, _ = contact.winkler_balance()
    scale = 2 * n_j * k_N * zeta_zmax / k_c
    return Derivation(
        (
            step(
                "The prepressure is the sum of the pressure over the whole length of all n_j contacts, from "
                "x_max - x_m = 2 x_max - x_xm to x_xm:",
                sp.Eq(F_c, form),
            ),
            step(
                "For the layer of eq. 30 that is the balance of the half-angle theta = k_c x_m:",
                sp.Eq(F_c, whole),
                zero=sp.expand_trig(sp.expand(whole / scale + balance.subs(sym("W")[0], zeta_zmax) - F_c / scale)),
            ),
        ),
        {"F_c": form},
    )


def _judge_31(forms: Forms) -> Iterator[Evidence]:
    given = {p: _LAYER, x_xm: x_max + theta / k_c}

    def around(_: str, q: Point) -> mp.mpf:
        """Everything that presses on the circumference, crest by crest, by quadrature with cuts at the edges."""
        total, half = mp.mpf(0), q[theta] / q[k_c]
        for crest in range(9):
            middle = q[x_max] + 2 * mp.pi * crest / q[k_c]
            press = lambda s, c=middle: max(mp.mpf(0), mp.cos(q[k_c] * (s - c)) - mp.cos(q[theta]))  # noqa: E731
            edges = [middle - mp.pi / q[k_c], middle - half, middle + half, middle + mp.pi / q[k_c]]
            total += mp.quad(press, edges)
        return q[k_N] * q[zeta_zmax] * total

    at_nine = {key: form.subs(n_j, 9) for key, form in forms.items()}
    yield agrees(
        at_nine,
        around,
        given=given,
        symbols=(k_c, k_N, zeta_zmax, theta, x_max),
        ranges=RANGES,
        count=2,
        tolerance=1e-14,
        against="the layer's pressure summed around the circumference of nine crests",
    )
    concrete = {key: form.subs(given).doit() for key, form in forms.items()}
    derived = {key: form.subs(given).doit() for key, form in _derive_31().forms.items()}
    yield identical(concrete, derived)


def _repair_31(forms: Forms) -> Forms:
    return {"F_c": n_j * forms["F_c"].subs(x_max, 2 * x_max - x_xm)}


def _half_angle_31() -> mp.mpf:
    """The contact half-angle if one half of one contact carries the prepressure."""
    q = operating_point()
    share = q["F_c"] * q["k_c"] / (q["k_N"] * q["W"])
    return mp.findroot(lambda a: mp.sin(a) - a * mp.cos(a) - share, (mp.mpf("0.1"), mp.mpf(2)), solver="anderson")


def _effect_31() -> str:
    q, printed = operating_point(), _half_angle_31()
    factor = 2 * q["n_j"]
    return (
        f"One half of one of {figure(q['n_j'], 2)} contacts carries all: the half-angle becomes {figure(printed, 4)} "
        f"rad instead of {figure(q['theta'], 4)} rad. Eq. 36 has the factor 2 m, so together they let a prepressure of "
        f"{figure(q['F_c'], 3)} N rub with up to {figure(q['mu'] * q['F_c'] * factor, 3)} N, {figure(factor, 2)} "
        f"times mu F_c = {figure(q['mu'] * q['F_c'], 3)} N."
    )


# --- (32) ---------------------------------------------------------------------------------------------------
def _derive_32() -> Derivation:
    general = transfer.pressure_distribution()
    crest = sp.sqrt(w_A**2 + w_B**2)
    form = general.subs(sp.cos(transfer.u), _WAVE / crest)
    responses = [sp.Symbol(f"w_{phase}^{region}") for region in phases.REGIONS for phase in phases.PHASES]
    return Derivation(
        (
            step(
                "k_N from eq. 31 put into eq. 30, with zeta_z - delta_0 = W_c (cos u - cos theta) (eq. 28):",
                sp.Eq(sp.Symbol("p"), general),
            ),
            step("cos u is zeta_z over the crest's height (eqs. 11, 21):", sp.Eq(sp.cos(transfer.u), _WAVE / crest)),
            step("The same holds in all three regions, each with its own responses (eqs. 9, 10):", *responses),
        ),
        {"p": form},
    )


@cache
def _region_values() -> dict[str, tuple[mp.mpf, mp.mpf]]:
    """w_A and w_B in each region, at a random moment and state."""
    found = {}
    for index, region in enumerate(phases.REGIONS):
        pair = []
        for phase in phases.PHASES:
            gate = sym(f"g_{phase}")[0]
            response = phases.response(phase)[0].subs(gate, phases.GATES[phase][index])
            (q,) = points(response.free_symbols, 1, f"32 {region}", RANGES)
            pair.append(evaluate(response, q))
        found[region] = (pair[0], pair[1])
    return found


def _judge_32(forms: Forms) -> Iterator[Evidence]:
    (q,) = points({F_c, n_j, k_c, theta}, 1, "32", RANGES)
    load, crests, k, angle = (float(q[s]) for s in (F_c, n_j, k_c, theta))
    function = numeric(forms["p"].subs(_VALUES), (x, a_w, b_w, F_c, n_j, k_c, theta))
    worst = beyond = least = 0.0
    for A, B in _region_values().values():
        crest = float(mp.atan2(A, B))
        turns = np.concatenate(
            [
                crest + edge + (np.arange(8000) + 0.5) / 8000 * width
                for edge, width in ((-np.pi, np.pi - angle), (-angle, 2 * angle), (angle, np.pi - angle))
            ]
        )
        widths = np.repeat([np.pi - angle, 2 * angle, np.pi - angle], 8000) / 8000 / k
        pressed = np.real(function(turns / k, float(A), float(B), load, crests, k, angle) + 0 * turns)
        outside = np.abs(turns - crest) > angle
        worst = worse(worst, abs(crests * float((pressed * widths).sum()) / load - 1))
        beyond = worse(beyond, float(np.abs(pressed[outside]).max()) / k / load)
        least = -worse(-least, -float(pressed.min()))
    yield evidence("numeric", worst < 1e-6, f"carries F_c on all crests in every region, to {rounded(worst)}")
    yield evidence("limit", beyond < 1e-12, "is 0 outside the ends of the contact")
    yield evidence("domain", least >= 0, "never pulls")


def _effect_32() -> str:
    q = operating_point()
    peak = q["F_c"] * q["k_c"] * (1 - mp.cos(q["theta"]))
    peak /= 2 * q["n_j"] * (mp.sin(q["theta"]) - q["theta"] * mp.cos(q["theta"]))
    return (
        f"The equation is missing from the text. At the crest the layer presses with {figure(peak, 4)} N/m, "
        f"{figure(peak / q['b_m'] / 1e6, 3)} MPa on its width; between the crests with nothing."
    )


_PLACE = "Sect. 4.1"
ENTRIES = (
    Entry(
        id="27",
        section="4.1",
        title="End of the contact",
        place=_PLACE,
        printed=_EQ27,
        units={"x_xm": "m"},
        verdict="definition",
        judge=_judge_27,
        derive=_derive_27,
        effect=_effect_27,
        reason="The right end of a contact that has two; the left one is x_max - x_m.",
    ),
    Entry(
        id="28",
        section="4.1",
        title="Undeformed surface of the layer",
        place=_PLACE,
        printed=_EQ28,
        units={"delta_0": "m"},
        verdict="erratum",
        judge=_judge_28,
        derive=_derive_28,
        effect=_effect_28,
        repair=lambda forms: {key: form.subs(x_vm, x_xm) for key, form in forms.items()},
        found_by=("domain", "identity", "numeric"),
        reason="Printed at x_vm, a symbol that is defined nowhere; the ends of the contact are x_xm (eq. 27).",
    ),
    Entry(
        id="29",
        section="4.1",
        title="Tangential velocity at the end of the contact",
        place=_PLACE,
        printed=_EQ29,
        units={"v_xm": "m/s"},
        verdict="erratum",
        judge=_judge_29,
        derive=_derive_29,
        effect=_effect_29,
        repair=lambda forms: {key: form.subs(first_difference, second_difference) for key, form in forms.items()},
        found_by=("limit", "numeric"),
        known=_STEPS,
        reason="The numerator lacks its exponent 2: a first difference over dx dt has no limit.",
    ),
    Entry(
        id="30",
        section="4.1",
        title="Pressure distribution",
        place=_PLACE,
        printed=_EQ30,
        units={"p": "N/m"},
        verdict="erratum",
        judge=_judge_30,
        derive=_derive_30,
        effect=_effect_30,
        repair=_repair_30,
        found_by=("dimension", "numeric", "domain"),
        reason="k_f is undefined and A_p the ceramic's section; the product has no dimension that eq. 31 could "
        "integrate to a force, and nothing keeps the layer from pulling. A Winkler layer has E_m b_m/h_m.",
    ),
    Entry(
        id="31",
        section="4.1",
        title="Balance with the prepressure",
        place=_PLACE,
        printed=_EQ31,
        units={"F_c": "N"},
        verdict="erratum",
        judge=_judge_31,
        derive=_derive_31,
        effect=_effect_31,
        size=lambda: ("the contact half-angle", float(_half_angle_31() / operating_point()["theta"] - 1)),
        repair=_repair_31,
        found_by=("numeric", "identity"),
        reason="Sums over one half of one contact; the prepressure rests on both halves of all crests. Eq. 36, which "
        "has the factor 2 m, contradicts it.",
    ),
    Entry(
        id="32",
        section="4.1",
        title="Pressure in the three regions",
        place=_PLACE,
        printed={},
        units={"p": "N/m"},
        verdict="reconstructed",
        judge=_judge_32,
        derive=_derive_32,
        effect=_effect_32,
        reason="Missing from the text; follows from eqs. 28, 30 and 31, put right, with the phases' responses.",
    ),
)
