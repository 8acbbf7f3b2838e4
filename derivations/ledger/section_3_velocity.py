"""Section 3.3, displacements and tangential velocity: eqs. (11) and (16) to (19)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial

import mpmath as mp
import sympy as sp

from derivations import beam
from derivations.ledger.course import Quantity
from derivations.ledger.exact import REGIONS, Cycle, vertical_displacement
from derivations.ledger.history import Array, History, values
from derivations.ledger.judge import agrees, error_size, evaluate, figure, largest, points, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import DRIVE, at_point, operating_point, stator
from derivations.ledger.regions import anywhere, by_region, context, largest_in, over_time, row_value, rows, worst
from derivations.ledger.section_3_phases import EQ9, corrected_10
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "EQ11"]

x, t, D, k_c, beta, W, omega_n, omega_q, xi = sym("x t D k_c beta W omega_n omega_q xi")
w_A, w_B, zeta_z, W_maxf = sym("w_A w_B zeta_z W_maxf")
v_x, A_v, Psi_v, M_a, M_b, N_a, N_b = sym("v_x A_v Psi_v M_a M_b N_a N_b")
t_1, t_2, t_3, varphi_Aredu = sym("t_1 t_2 t_3 varphi_Aredu")
A_AB, Theta_A, Psi_A, varphi_A = sym("A_ABaddredu Theta_Baddredu Psi_Aaddredu varphi_Baddredu")
A_Badd, Theta_B, Psi_B, varphi_B = sym("A_Badd Theta_Badd Psi_Badd varphi_Badd")
mean = (omega_n + omega_q) / 2
half_A, half_B = (Theta_A + Psi_A) / 2, (Theta_B + Psi_B) / 2
TRIAL = {w_A: W * sp.cos(omega_q * t), w_B: W * sp.sin(omega_n * t) / 2}

# --- (11) ---------------------------------------------------------------------------------------------------
_SHAPE = w_A * sp.sin(k_c * x) + w_B * sp.cos(k_c * x)
EQ11: Forms = {"zeta_z": _SHAPE, "zeta_x": D * sp.Derivative(_SHAPE, x)}


def _derive_11() -> Derivation:
    rotation = sp.Function("theta")(x, t)
    slender = beta / k_c
    _, moment = beam.equations_of_motion()
    shape = _SHAPE.subs({w_A: 0, w_B: W * sp.cos(omega_n * t)})
    turned = {beam.w: shape, beam.theta: slender * shape.diff(x)}
    left = sp.expand(moment.subs(turned).doit().subs(beta, beam.rotation_ratio()))
    return Derivation(
        (
            step("The phases' mode shapes are sin and cos; displacements add:", sp.Eq(zeta_z, _SHAPE)),
            step(
                "A section turns by theta, so the surface at the distance D moves along by D theta, in the paper's "
                "sense of x:",
                sp.Eq(sym("zeta_x")[0], D * rotation),
            ),
            step(
                "In Timoshenko's beam, which the paper uses, the rotation is not the slope but beta/k_c times it "
                "(eq. 3):",
                sp.Eq(rotation, slender * sp.Derivative(zeta_z, x)),
                zero=sp.simplify(left),
            ),
            step("The printed form sets the factor to 1, as Euler and Bernoulli do."),
        ),
        EQ11,
    )


def _judge_11(forms: Forms) -> Iterator[Evidence]:
    def displacement(name: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = {s.name: number for s, number in point.items()}
        A, B = v["W"] * mp.cos(v["omega_q"] * v["t"]), v["W"] * mp.sin(v["omega_n"] * v["t"]) / 2
        vertical = partial(vertical_displacement, A, B, v["k_c"])
        return vertical(v["x"]) if name == "zeta_z" else v["D"] * mp.diff(vertical, v["x"])

    names = sym("W omega_q omega_n t x k_c D")
    yield agrees(
        forms, displacement, given=TRIAL, symbols=names, tolerance=1e-18, against="the slope taken numerically"
    )
    tangential = forms["zeta_x"].doit()
    quarter = vanishes(tangential.subs(x, x + 2 * sp.pi / k_c) - tangential)
    yield evidence("limit", quarter, "both displacements repeat after a wavelength")

    def sizes() -> tuple[float, float]:
        q = operating_point()
        there = q["k_c"] / q["beta"] - 1
        ratio = k_c / beam.rotation_ratio()
        around = points(sorted(ratio.free_symbols, key=lambda s: s.name), 8, "eq11")
        return float(there), float(largest(abs(evaluate(ratio, p) - 1) for p in around))

    def slender() -> float:
        q = dict(operating_point())
        q |= {"k_c": q["k_c"] / 100, "k_f": mp.mpf(0)}  # a free beam, at its own frequency
        q["omega_n"] = at_point(beam.resonance()["quartic"], q)
        return float(q["k_c"] / at_point(beam.rotation_ratio(), q) - 1)

    yield error_size(
        "zeta_x, by taking the slope for the rotation,", sizes, "waves far longer than the beam is high", slender
    )


def _effect_11() -> str:
    q, layers = operating_point(), stator(DRIVE["F_c"], layered=True)
    slope = q["k_c"] / q["beta"] - 1
    both = q["D"] * q["k_c"] / (layers["D"] * layers["beta"]) - 1
    return (
        f"Tangential displacement and velocity come out {figure(100 * slope, 4)} % too large at Table 3, whatever the "
        "start. It cancels in Q_aver and Q_vib, not in the rotor's speed: the speed of the surface that the rotor "
        "meets "
        f"is {figure(1000 * q['D'] * q['k_c'] * q['omega_q'] * q['W'])} mm/s with the slope, "
        f"{figure(1000 * q['D'] * q['beta'] * q['omega_q'] * q['W'])} mm/s with the rotation, in a steady wave at the "
        "crest. The computations keep the slope, which is the paper's model; D times beta/k_c given for D computes "
        f"with the rotation. Eq. 1's axis is off the other way: with the section in layers, its axis and its rotation "
        f"together, the product is off by {figure(100 * both, 3)} % only. The sign fixes the sense of x only."
    )


# --- (16), (17) ---------------------------------------------------------------------------------------------
_EQ16: Forms = {"v_x": A_v * sp.sin(k_c * x + Psi_v)}
_ARCTAN = sp.atan(M_b / M_a)
_EQ17: Forms = {
    "A_v": by_region(  # from t_1 to t_2 (18) and (19) print M_a and M_b over W_maxf: N_a and N_b
        (W_maxf * D * k_c * sp.sqrt(N_a**2 + N_b**2), 1, 2), (D * k_c * sp.sqrt(M_a**2 + M_b**2), 2, 4)
    ),
    "Psi_v": sp.Piecewise((_ARCTAN, sp.Ge(M_a, 0)), (_ARCTAN + sp.pi, sp.Lt(M_a, 0)), evaluate=False),
}
_RANGES_17 = {
    "M_a": (-1.5, 1.5),
    "M_b": (-1.5, 1.5),
    "N_a": (-2e5, 2e5),
    "N_b": (-2e5, 2e5),
    "W_maxf": (4e-6, 7e-6),
    "A_v": (0.1, 2.0),
    "Psi_v": (-3.0, 3.0),
}
_PAIR = {A_v: D * k_c * sp.sqrt(M_a**2 + M_b**2), Psi_v: sp.atan2(M_b, M_a)}


def _derive_16() -> Derivation:
    velocity = sp.expand((D * _SHAPE.diff(x)).diff(t))
    parts = D * k_c * (M_a * sp.sin(k_c * x) + M_b * sp.cos(k_c * x))
    put = {M_a: -w_B.diff(t), M_b: w_A.diff(t)}
    one = sp.expand(sp.expand_trig((A_v * sp.sin(k_c * x + Psi_v)).subs(_PAIR)))
    return Derivation(
        (
            step("The tangential velocity is the time derivative of zeta_x (11):", sp.Eq(v_x, velocity)),
            step("With M_a = -w_B' and M_b = w_A' it is", parts, zero=sp.expand(parts.subs(put)) - velocity),
            step(
                "A sine and a cosine of the same wave are one sine:",
                sp.Eq(v_x, A_v * sp.sin(k_c * x + Psi_v)),
                zero=sp.simplify(one - sp.expand(parts)),
            ),
        ),
        {"v_x": A_v * sp.sin(k_c * x + Psi_v), "A_v": _PAIR[A_v], "Psi_v": _PAIR[Psi_v]},
    )


def _derive_17() -> Derivation:
    whole = _derive_16()
    size = {"redu": W_maxf * D * k_c * sp.sqrt(N_a**2 + N_b**2), "later": _PAIR[A_v]}
    per_W = {M_a: W_maxf * N_a, M_b: W_maxf * N_b}
    return Derivation(
        (
            *whole.steps,
            step(
                "From t_1 to t_2 the paper prints M_a and M_b without their common factor W_maxf, which leaves the "
                "phase alone and stands before the root:",
                size["redu"],
                zero=sp.simplify(_PAIR[A_v].subs(per_W) - size["redu"]),
            ),
        ),
        {"A_v": by_region((size["redu"], 1, 2), (size["later"], 2, 4)), "Psi_v": _PAIR[Psi_v]},
    )


def _judge_16(forms: Forms) -> Iterator[Evidence]:
    whole = {"v_x": forms["v_x"].subs(_PAIR)}
    parts = {"v_x": D * k_c * (M_a * sp.sin(k_c * x) + M_b * sp.cos(k_c * x))}
    yield agrees(whole, parts, ranges=_RANGES_17, count=8, against="M_a sin(k_c x) + M_b cos(k_c x), times D k_c")
    at_zero = forms["v_x"].subs(x, 0).subs(_PAIR)
    yield evidence(
        "limit", vanishes(sp.simplify(at_zero - D * k_c * M_b)), "at x = 0 only phase A moves the surface along"
    )


def _judge_17(forms: Forms) -> Iterator[Evidence]:
    redu, later = rows(forms["A_v"])
    per_W = {M_a: N_a, M_b: N_b}
    sizes = {"v_x in T_redu": (redu, forms["Psi_v"].subs(per_W)), "v_x later": (later, forms["Psi_v"])}
    wave = {name: (A_v * sp.sin(k_c * x + Psi_v)).subs({A_v: a, Psi_v: b}) for name, (a, b) in sizes.items()}
    part = D * k_c * (M_a * sp.sin(k_c * x) + M_b * sp.cos(k_c * x))
    parts = {"v_x in T_redu": W_maxf * part.subs(per_W), "v_x later": part}
    yield agrees(wave, parts, ranges=_RANGES_17, count=12, against="M_a sin(k_c x) + M_b cos(k_c x), times D k_c")
    sizes_there = {
        "W_maxf": mp.mpf("5e-6"),
        "M_a": mp.mpf("0.7"),
        "M_b": mp.mpf("0.4"),
        "N_a": mp.mpf(2e5),
        "N_b": mp.mpf(1e5),
    }
    held = [(region, row_value(forms["A_v"], {**anywhere(region, 1, "eq17")[0], **sizes_there})) for region in REGIONS]
    at = {**anywhere("redu", 1, "eq17")[0], **sizes_there}
    wanted = {region: row_value(redu if region == "redu" else later, at) for region in REGIONS}
    yield evidence("domain", dict(held) == wanted, "the row with W_maxf holds in T_redu, the other later")
    angle = forms["Psi_v"].subs(M_b, 1)
    ends = sp.limit(angle.args[0][0], M_a, 0, "+"), sp.limit(angle.args[1][0], M_a, 0, "-")
    yield evidence(
        "continuity", ends == (sp.pi / 2, sp.pi / 2), "both branches meet at M_a = 0, where the first divides by zero"
    )
    alone = later.subs(M_b, 0) == D * k_c * sp.Abs(M_a) and redu.subs(N_b, 0) == D * k_c * W_maxf * sp.Abs(N_a)
    yield evidence("limit", alone, "one part alone is its own amplitude")


def _effect_16() -> str:
    return "None for the formula; its parts M_a and M_b, (18) and (19), are wrong after t_2."


def _effect_17() -> str:
    return "None, away from M_a = 0; there the arctangent divides by zero and atan2(M_b, M_a) is to be used."


# --- (18), (19) ---------------------------------------------------------------------------------------------
def _s(argument: sp.Expr) -> sp.Expr:
    return sp.sin(argument, evaluate=False)


def _c(argument: sp.Expr) -> sp.Expr:
    return sp.cos(argument, evaluate=False)


_HALF = sp.pi / 2
_FREE_A, _FREE_B = omega_n * (t - t_1) + _HALF, omega_n * (t - t_2) + _HALF
_DECAY_A, _DECAY_B = sp.exp(-xi * omega_n * (t - t_1)), sp.exp(-xi * omega_n * (t - t_2))
_EQ18: Forms = {
    "M_a": by_region(
        (omega_q * _s(omega_q * (t - t_1) + _HALF), 1, 2),
        (W_maxf * omega_n * _DECAY_B * (xi * _c(_FREE_B) + _s(_FREE_B)), 2, 3),
        (A_Badd * _c(mean * (t - t_3) + half_B + varphi_B + _HALF), 3, 4),
    )
}
_ANGLE_2 = mean * (t - t_2) + half_A + varphi_A
_ANGLE_3 = mean * (t - t_3) + mean * (t_3 - t_2) + half_A + varphi_A
_EQ19: Forms = {
    "M_b": by_region(
        (omega_n * _DECAY_A * _c(_FREE_A) - xi * omega_n * _DECAY_A * _s(_FREE_A), 1, 2),
        (A_AB * _c(_ANGLE_2), 2, 3),
        (A_AB * _c(_ANGLE_3), 3, 4),
    )
}
_UNITS_FIRST = {"redu": "1/s", "addredu": "m/s", "add": "m/s"}


def _by_rows(form: sp.Piecewise) -> dict[str, sp.Expr]:
    """The rows as forms of their own: the first is per W_maxf, as (17) has it."""
    return dict(zip(("redu", "addredu", "add"), rows(form), strict=True))


@cache
def rates(name: str) -> dict[str, sp.Expr]:
    """M_a = -w_B' or M_b = w_A' by row, amplitude and slow phase held, the first over W_maxf."""
    source, sign = (corrected_10()["w_B"], -1) if name == "M_a" else (EQ9["w_A"], 1)
    found = {}
    for region, row in zip(REGIONS, rows(source), strict=True):
        rate = sign * row.subs(varphi_Aredu, _HALF).diff(t)
        found[region] = sp.simplify(rate / W_maxf) if region == "redu" else sp.factor(rate)
    return found


def _velocity_error(form: Forms, phase: str, sign: int) -> Callable[[Cycle, str, mp.mpf], mp.mpf]:
    def error(cycle: Cycle, region: str, time: mp.mpf) -> mp.mpf:
        value = row_value(form[region], context(cycle, region, time))
        scale = cycle["W"] if region == "redu" else 1
        exact = sign * cycle.response(phase, region, time)[1]
        return abs(value * scale - exact) / (cycle["W"] * cycle["omega_q"])

    return error


def _judge_rates(name: str) -> Callable[[Forms], Iterator[Evidence]]:
    phase, sign = ("B", -1) if name == "M_a" else ("A", 1)
    wide = {
        "A_Badd": (3e-6, 9e-6),
        "A_ABaddredu": (3e-6, 9e-6),
        "t_1": (0.0, 1e-6),
        "t_2": (1e-4, 2e-4),
        "t_3": (3e-4, 4e-4),
        "W_maxf": (4e-6, 7e-6),
        "t": (4e-4, 6e-4),
    } | {s.name: (-3.0, 3.0) for s in (Theta_A, Psi_A, varphi_A, Theta_B, Psi_B, varphi_B)}

    def judge(forms: Forms) -> Iterator[Evidence]:
        yield agrees(
            forms,
            rates(name),
            ranges=wide,
            count=4,
            tolerance=1e-20,
            against=f"the derivative of ({'10' if phase == 'B' else '9'}), amplitude and slow phase held",
        )
        found = worst(_velocity_error(forms, phase, sign))
        text = ", ".join(f"{mp.nstr(100 * value, 3)} % in T_{region}" for region, value in found.items())
        yield evidence(
            "error_size",
            largest(found.values()) < 0.25,
            f"off the velocity chained as complex exponentials, in omega_q W, by {text}; allowed 25 %",
        )

    return judge


def _repair_18(forms: Forms) -> Forms:
    second = forms["addredu"] * omega_q / omega_n
    return {"redu": forms["redu"], "addredu": second, "add": -mean * forms["add"]}


def _repair_19(forms: Forms) -> Forms:
    return {"redu": forms["redu"], "addredu": mean * forms["addredu"], "add": mean * forms["add"]}


def _derive_rates(name: str) -> Callable[[], Derivation]:
    def derive() -> Derivation:
        printed = _by_rows((_EQ18 if name == "M_a" else _EQ19)[name])
        derived = rates(name)
        source = "M_a = -w_B', from (10) put right" if name == "M_a" else "M_b = w_A', from (9) with phi_Aredu = pi/2"
        repair = _repair_18(printed) if name == "M_a" else _repair_19(printed)
        return Derivation(
            (
                step(
                    f"{source}. From t_1 to t_2, over W_maxf:", derived["redu"], zero=derived["redu"] - repair["redu"]
                ),
                step("From t_2 to t_3:", derived["addredu"], zero=sp.expand(derived["addredu"] - repair["addredu"])),
                step(
                    "From t_3 to t_4; a derivative of a sine brings its frequency down, which the print forgot. "
                    "Amplitude and slow phase are held, what that costs is under Evidence:",
                    derived["add"],
                    zero=sp.expand(derived["add"] - repair["add"]),
                ),
            ),
            derived,
        )

    return derive


def _effect_rates(name: str) -> Callable[[], str]:
    def effect() -> str:
        p = values()
        phase, sign = ("B", -1) if name == "M_a" else ("A", 1)
        parts = []
        for label, form in (
            ("printed", _by_rows((_EQ18 if name == "M_a" else _EQ19)[name])),
            ("put right", rates(name)),
        ):
            errors = []
            for region in REGIONS:
                row, scale = over_time(form[region], region), p["W"] if region == "redu" else 1.0

                def off(h: History, row: Quantity = row, scale: float = scale) -> Array:
                    exact = h.v_B if phase == "B" else h.v_A
                    return (scale * row(h) - sign * exact) / (p["W"] * p["omega_q"])

                size = 100 * largest_in(region, off)
                errors.append(f"{figure(size, 3)} %" if size > 1e-9 else "nothing")
            parts.append(f"{label} off by {', '.join(errors)}")
        speed = figure(p["W"] * p["omega_q"])
        return (
            "At most, in the three regions at Table 3, from a steady start, phase lead +1, of omega_q W = "
            f"{speed} m/s: {'; '.join(parts)}."
        )

    return effect


ENTRIES = (
    Entry(
        id="11",
        section="3.3",
        title="Vertical and tangential displacement",
        place="Sect. 3.3",
        printed=EQ11,
        units={"zeta_z": "m", "zeta_x": "m"},
        verdict="approximation",
        reason="The superposition is right. zeta_x takes the slope for the section's rotation, which Timoshenko's "
        "beam (3) tells apart; first principles ask for the rotation, about the layers' axis. With z towards "
        "the rotor a positive slope moves the surface to -x: the sign is "
        "a convention.",
        judge=_judge_11,
        derive=_derive_11,
        effect=_effect_11,
    ),
    Entry(
        id="16",
        section="3.3",
        title="Tangential velocity as one sine",
        place="Sect. 3.3",
        printed=_EQ16,
        units={"v_x": "m/s"},
        verdict="verified",
        reason="The time derivative of zeta_x is a sine and a cosine of k_c x, hence one sine.",
        judge=_judge_16,
        derive=_derive_16,
        effect=_effect_16,
    ),
    Entry(
        id="17",
        section="3.3",
        title="Amplitude and phase of the tangential velocity",
        place="Sect. 3.3",
        printed=_EQ17,
        units={"A_v": "m/s", "Psi_v": "rad"},
        verdict="verified",
        reason="Polar form of M_a and M_b, both branches right; from t_1 to t_2 W_maxf stands before the root because "
        "M_a and M_b are printed without it there.",
        judge=_judge_17,
        derive=_derive_17,
        effect=_effect_17,
    ),
    Entry(
        id="18",
        section="3.3",
        title="Sine's part M_a of the tangential velocity",
        place="Sect. 3.3",
        printed=_by_rows(_EQ18["M_a"]),
        units=_UNITS_FIRST,
        verdict="erratum",
        reason="The third row lost the factor -(omega_n + omega_q)/2 and is a length, not a velocity; the second "
        "keeps (10)'s amplitude.",
        judge=_judge_rates("M_a"),
        derive=_derive_rates("M_a"),
        effect=_effect_rates("M_a"),
        repair=_repair_18,
        found_by=("dimension", "numeric", "error_size"),
    ),
    Entry(
        id="19",
        section="3.3",
        title="Cosine's part M_b of the tangential velocity",
        place="Sect. 3.3",
        printed=_by_rows(_EQ19["M_b"]),
        units=_UNITS_FIRST,
        verdict="erratum",
        reason="The second and third rows lost the factor (omega_n + omega_q)/2 and are lengths, not velocities.",
        judge=_judge_rates("M_b"),
        derive=_derive_rates("M_b"),
        effect=_effect_rates("M_b"),
        repair=_repair_19,
        found_by=("dimension", "numeric", "error_size"),
    ),
)
