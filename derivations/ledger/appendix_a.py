"""Appendix A, the direction determinant: eqs. (A1) to (A9)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import mpmath as mp
import sympy as sp

from derivations import determinant
from derivations.ledger.exact import vertical_displacement
from derivations.ledger.judge import agrees, error_size, evaluate, figure, identical, largest, points, vanishes, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import operating_point
from derivations.nomenclature import sym
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = ["ENTRIES"]

x, t, D, k_c = sym("x t D k_c")
W_a, W_b, omega_a, omega_b, varphi_a, varphi_b = sym("W_a W_b omega_a omega_b varphi_a varphi_b")
T_q = sym("T_q")[0]
alpha, beta = omega_a * t + varphi_a, omega_b * t + varphi_b
P_A, P_B = W_a * sp.cos(alpha), W_b * sp.cos(beta)
xi_z, xi_x = (sp.Function(name, real=True)(t) for name in ("xi_z", "xi_x"))
phi_q = sp.Function("phi_q", real=True)(t)
_METRE = parse_unit("m").dimension
_KNOWN = {xi_z: _METRE, xi_x: _METRE, phi_q: Dimension()}
_RANGES = {
    "W_a": (2e-6, 9e-6),
    "W_b": (2e-6, 9e-6),
    "omega_a": (2.3e5, 2.6e5),
    "omega_b": (2.6e5, 2.8e5),
    "varphi_a": (-3.0, 3.0),
    "varphi_b": (-3.0, 3.0),
}
_SYMBOLS = sym("x t D k_c W_a W_b omega_a omega_b varphi_a varphi_b")
_MOTION = {xi_x: W_a * sp.cos(omega_a * t), xi_z: W_b * sp.sin(omega_b * t + varphi_b)}


def _numbers(point: dict[sp.Symbol, mp.mpf]) -> dict[str, mp.mpf]:
    return {symbol.name: number for symbol, number in point.items()}


def _responses(v: dict[str, mp.mpf], time: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """The two modal responses as real parts of rotating vectors."""
    return (
        mp.re(v["W_a"] * mp.expj(v["omega_a"] * time + v["varphi_a"])),
        mp.re(v["W_b"] * mp.expj(v["omega_b"] * time + v["varphi_b"])),
    )


# --- (A1), (A2) ---------------------------------------------------------------------------------------------
_A1: Forms = {
    "w_A": W_a * sp.sin(k_c * x) * sp.cos(omega_a * t + varphi_a),
    "w_B": W_b * sp.cos(k_c * x) * sp.cos(omega_b * t + varphi_b),
}
_A2: Forms = {
    "zeta_z": W_a * sp.sin(k_c * x) * sp.cos(omega_a * t + varphi_a)
    + W_b * sp.cos(k_c * x) * sp.cos(omega_b * t + varphi_b),
    "zeta_x": D
    * k_c
    * (W_a * sp.cos(k_c * x) * sp.cos(omega_a * t + varphi_a) - W_b * sp.sin(k_c * x) * sp.cos(omega_b * t + varphi_b)),
}


def _derive_a1() -> Derivation:
    return Derivation(
        (
            step("Every phase is its mode shape times a response of its own frequency, amplitude and phase:", P_A, P_B),
            step(
                "The shapes are a quarter wave apart, each a solution of the wave's equation in x:",
                *_A1.values(),
                zero=[form.diff(x, 2) + k_c**2 * form for form in _A1.values()],
            ),
        ),
        {"w_A": P_A * sp.sin(k_c * x), "w_B": P_B * sp.cos(k_c * x)},
    )


def _judge_a1(forms: Forms) -> Iterator[Evidence]:
    def product(name: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = _numbers(point)
        a, b = _responses(v, v["t"])
        return a * mp.sin(v["k_c"] * v["x"]) if name == "w_A" else b * mp.cos(v["k_c"] * v["x"])

    yield agrees(forms, product, symbols=_SYMBOLS, ranges=_RANGES, against="shape times rotating vector")
    rates = ((forms["w_A"], omega_a), (forms["w_B"], omega_b))
    free = all(vanishes(form.diff(t, 2) + rate**2 * form) for form, rate in rates)
    yield evidence("identity", free, "each swings with its own frequency")
    nodes = forms["w_A"].subs(x, 0) == 0 and forms["w_B"].subs(x, sp.pi / (2 * k_c)) == 0
    yield evidence("limit", nodes, "A's node is at x = 0, B's a quarter wave further")


def _derive_a2() -> Derivation:
    vertical = sum(_A1.values())
    along = sp.expand(D * vertical.diff(x))
    return Derivation(
        (
            step("Displacements add:", vertical),
            step(
                "The tangential one is D times the slope, as in (11):",
                along,
                zero=along - sp.expand(D * k_c * (P_A * sp.cos(k_c * x) - P_B * sp.sin(k_c * x))),
            ),
        ),
        {"zeta_z": vertical, "zeta_x": along},
    )


def _judge_a2(forms: Forms) -> Iterator[Evidence]:
    def displacement(name: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = _numbers(point)
        a, b = _responses(v, v["t"])
        vertical = partial(vertical_displacement, a, b, v["k_c"])
        return vertical(v["x"]) if name == "zeta_z" else v["D"] * mp.diff(vertical, v["x"])

    yield agrees(
        forms, displacement, symbols=_SYMBOLS, ranges=_RANGES, tolerance=1e-18, against="(11) taken numerically"
    )
    yield identical(forms, _derive_a2().forms)


# --- (A3) to (A5) -------------------------------------------------------------------------------------------
_A3: Forms = {"angle": sp.Eq(sp.tan(phi_q), xi_z / xi_x)}
_RATE = (xi_x.diff(t) * xi_z - xi_z.diff(t) * xi_x) / xi_x**2
_A4: Forms = {
    "rate": _RATE * sp.cos(phi_q) ** 2,
    "reduced": (xi_x.diff(t) * xi_z - xi_z.diff(t) * xi_x) / (xi_x**2 + xi_z**2),
}
_A5: Forms = {"Q_q": xi_x.diff(t) * xi_z - xi_z.diff(t) * xi_x}


def _derive_a3() -> Derivation:
    radius = sp.Symbol("r", positive=True)
    polar = {xi_x: radius * sp.cos(phi_q), xi_z: radius * sp.sin(phi_q)}
    return Derivation(
        (
            step(
                "In polar coordinates of the particle's path, xi_x = r cos(phi_q) and xi_z = r sin(phi_q):",
                _A3["angle"],
                zero=sp.simplify((_A3["angle"].lhs - _A3["angle"].rhs).subs(polar)),
            ),
        ),
        _A3,
    )


def _judge_a3(forms: Forms) -> Iterator[Evidence]:
    form = forms["angle"]
    sides = {"angle": form.lhs - form.rhs} if isinstance(form, sp.Eq) else {"angle": sp.Integer(1)}
    plain = {"angle": sides["angle"].subs(phi_q, sp.atan2(xi_z, xi_x))}
    worst = mp.mpf(0)
    for point in points(sym("W_a W_b omega_a omega_b varphi_b t"), 8, "A3", _RANGES):
        worst = worse(worst, abs(evaluate(plain["angle"].subs(_MOTION), point)))
    yield evidence(
        "numeric",
        worst < mp.mpf(10) ** -20,
        f"holds for the direction of the path's point in all quadrants, to {mp.nstr(worst, 2)}",
    )
    flat = form.subs({xi_z: 0, phi_q: 0})
    yield evidence("limit", flat == sp.true, "angle 0 along the surface")


def _corrected_a4() -> Forms:
    return {"rate": -_A4["rate"], "reduced": sp.together(-_A4["reduced"])}


def _derive_a4() -> Derivation:
    slope = (xi_z / xi_x).diff(t)
    forms = _corrected_a4()
    square = 1 / (1 + (xi_z / xi_x) ** 2)
    return Derivation(
        (
            step(
                "The left side of (A3), differentiated, is the angle's rate over cos(phi_q)^2; the right side by the "
                "quotient rule:",
                slope,
                zero=sp.expand(slope + _RATE),
            ),
            step("So the rate is", forms["rate"], zero=sp.simplify(forms["rate"] - slope * sp.cos(phi_q) ** 2)),
            step(
                "With cos^2 = 1/(1 + tan^2):",
                forms["reduced"],
                zero=sp.simplify((forms["rate"]).subs(sp.cos(phi_q) ** 2, square) - forms["reduced"]),
            ),
            step(
                "The print has both differences the other way round: it is minus the angle's rate, positive for a "
                "clockwise turn (x to the right, z up). That suits (A5), which takes clockwise as positive."
            ),
        ),
        forms,
    )


def _path(v: dict[str, mp.mpf], time: mp.mpf) -> mp.mpc:
    """Place of a point that runs as ``_MOTION`` says, x + i z."""
    return mp.mpc(v["W_a"] * mp.cos(v["omega_a"] * time), v["W_b"] * mp.sin(v["omega_b"] * time + v["varphi_b"]))


def _turned(place: Callable[[mp.mpf], mp.mpc], here: mp.mpc, time: mp.mpf) -> mp.mpf:
    """Angle from a direction; counted from the present one it has no cut nearby."""
    return mp.arg(place(time) / here)


def _judge_a4(forms: Forms) -> Iterator[Evidence]:
    worst = mp.mpf(0)
    for point in points(sym("W_a W_b omega_a omega_b varphi_b t"), 6, "A4", _RANGES):
        v = _numbers(point)
        place = partial(_path, v)
        rate = mp.diff(partial(_turned, place, place(v["t"])), v["t"])
        for form in forms.values():
            put = form.subs(phi_q, sp.atan2(xi_z, xi_x)).subs(_MOTION).doit()
            worst = worse(worst, abs(evaluate(put, point) / rate - 1))
    yield evidence(
        "numeric",
        worst < mp.mpf(10) ** -12,
        f"off the rate of the path's direction, taken numerically, by {mp.nstr(worst, 3)} relative",
    )
    circle = {xi_x: sp.cos(omega_a * t), xi_z: sp.sin(omega_a * t)}
    value = sp.simplify(forms["reduced"].subs(circle).doit())
    yield evidence("limit", value == omega_a, f"a counterclockwise unit circle turns with {value}")


def _effect_a4() -> str:
    return (
        "The sign: as printed the angle of a counterclockwise circle would fall. Nothing else of the paper changes, "
        "since (A5) takes clockwise as positive, and so Q = -(xi_x^2 + xi_z^2) d(phi_q)/dt."
    )


def _derive_a5() -> Derivation:
    turning = -(xi_x**2 + xi_z**2) * _corrected_a4()["reduced"]
    return Derivation(
        (
            step(
                "The denominator of (A4) is positive, so its numerator decides on the sense; clockwise is to be "
                "positive:",
                _A5["Q_q"],
                zero=sp.simplify(_A5["Q_q"] - turning),
            ),
        ),
        {"Q_q": _A5["Q_q"]},
    )


def _judge_a5(forms: Forms) -> Iterator[Evidence]:
    form = forms["Q_q"]

    def area(_: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        """Minus twice the area that the path's point sweeps per time."""
        v = _numbers(point)
        place = partial(_path, v)
        return -mp.im(mp.conj(place(v["t"])) * mp.diff(place, v["t"]))

    symbols = sym("W_a W_b omega_a omega_b varphi_b t")
    yield agrees(
        {"Q_q": form.subs(_MOTION).doit()},
        area,
        symbols=symbols,
        ranges=_RANGES,
        tolerance=1e-18,
        against="minus twice the area swept per time",
    )
    clockwise = {xi_x: sp.cos(omega_a * t), xi_z: -sp.sin(omega_a * t)}
    value = sp.simplify(form.subs(clockwise).doit())
    yield evidence("limit", value == omega_a, f"a clockwise unit circle has Q = {value}, positive")


# --- (A6) to (A9) -------------------------------------------------------------------------------------------
_SUM, _DIFFERENCE = (omega_b + omega_a) * t + (varphi_b + varphi_a), (omega_b - omega_a) * t + (varphi_b - varphi_a)
_A6: Forms = {
    "Q_q": D * k_c * W_a * W_b / 2 * ((omega_b - omega_a) * sp.sin(_SUM) + (omega_b + omega_a) * sp.sin(_DIFFERENCE))
}
_A7: Forms = {"much_greater": sp.Gt(varphi_b + varphi_a, varphi_b - varphi_a)}
_A8: Forms = {"Q_q": (omega_b + omega_a) * D * k_c * W_a * W_b / 2 * sp.sin(_DIFFERENCE)}
_A9: Forms = {"T_q": 2 * sp.pi / sp.Abs(omega_b - omega_a)}


def _exact() -> sp.Expr:
    return determinant.phase_determinant(P_A, P_A.diff(t), P_B, P_B.diff(t))


def _derive_a6() -> Derivation:
    exact = _exact()
    return Derivation(
        (
            step("The determinant for any two phases, independent of x:", determinant.determinant()),
            step("With the responses of (A1):", exact),
            step(
                "Products of a sine and a cosine as sums; all four signs are as printed:",
                _A6["Q_q"],
                zero=sp.expand(sp.expand_trig(exact - _A6["Q_q"])),
            ),
        ),
        {"Q_q": exact},
    )


def _judge_a6(forms: Forms) -> Iterator[Evidence]:
    def swept(_: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = _numbers(point)

        def place(time: mp.mpf) -> mp.mpc:
            a, b = _responses(v, time)
            s, c = mp.sin(v["k_c"] * v["x"]), mp.cos(v["k_c"] * v["x"])
            return mp.mpc(v["D"] * v["k_c"] * (a * c - b * s), a * s + b * c)

        return -mp.im(mp.conj(place(v["t"])) * mp.diff(place, v["t"]))

    yield agrees(
        forms,
        swept,
        symbols=_SYMBOLS,
        ranges=_RANGES,
        tolerance=1e-18,
        against="minus twice the area that the particle of (A2) sweeps per time",
    )
    same = forms["Q_q"].subs({omega_b: omega_a, varphi_b: varphi_a + sp.pi / 2})
    yield evidence(
        "limit", vanishes(same - D * k_c * W_a * W_b * omega_a), "steady wave: constant, D k_c W_a W_b omega"
    )
    yield identical(forms, {"Q_q": _exact()})


def _derive_a7() -> Derivation:
    return Derivation(
        (
            step(
                "(A6) has one term of the size omega_b - omega_a and one of the size omega_b + omega_a. The first "
                "may be dropped because",
                sp.Gt(omega_b + omega_a, sp.Abs(omega_b - omega_a)),
                zero=(omega_b + omega_a) ** 2 - (omega_b - omega_a) ** 2 - 4 * omega_a * omega_b,
            ),
            step(
                "which holds by far at 40 kHz with differences of 3 kHz. Phases are known up to whole turns, so no "
                "comparison of their sizes can say anything."
            ),
        ),
        {"much_greater": sp.Gt(omega_b + omega_a, sp.Abs(omega_b - omega_a))},
    )


def _judge_a7(forms: Forms) -> Iterator[Evidence]:
    relation = forms["much_greater"]
    ratios = []
    for point in points(sym("omega_a omega_b varphi_a varphi_b"), 12, "A7", _RANGES):
        large, small = (
            evaluate(side, {s: point[s] for s in side.free_symbols}) for side in (relation.gts, relation.lts)
        )
        ratios.append(large / abs(small) if small else mp.inf)
    least = -largest(-ratio for ratio in ratios)
    yield evidence(
        "numeric", least > 10, f"the greater side is {mp.nstr(least, 3)} times the smaller one at least; asked: 10"
    )
    turn = relation.subs(varphi_a, varphi_a - 2 * sp.pi)
    yield evidence("domain", turn == relation, "does not change when a phase is counted a turn further")
    drops = forms["much_greater"].has(omega_a) and forms["much_greater"].has(omega_b)
    yield evidence("identity", drops, "compares the factors of the two terms of (A6)")


def _repair_a7(forms: Forms) -> Forms:
    swap = {varphi_a: omega_a, varphi_b: omega_b}
    relation = forms["much_greater"]
    return {"much_greater": sp.Gt(relation.gts.subs(swap), sp.Abs(relation.lts.subs(swap)))}


def _share() -> float:
    q = operating_point()
    return float(q["Delta_omega"] / (2 * q["omega_n"] + q["Delta_omega"]))


def _derive_a8() -> Derivation:
    dropped = sp.expand(_A6["Q_q"] - _A8["Q_q"])
    return Derivation(
        (
            step("Of (A6) only the slow term stays:", _A8["Q_q"]),
            step(
                "What is dropped has the share |omega_b - omega_a|/(omega_b + omega_a) of it and averages to zero "
                "over a period of the sum frequency:",
                dropped,
                zero=dropped - sp.expand(D * k_c * W_a * W_b / 2 * (omega_b - omega_a) * sp.sin(_SUM)),
            ),
        ),
        {"Q_q": _A8["Q_q"]},
    )


def _judge_a8(forms: Forms) -> Iterator[Evidence]:
    def sizes() -> tuple[float, float]:
        most = mp.mpf(0)
        for point in points(_SYMBOLS, 12, "A8", _RANGES):
            scale = evaluate(D * k_c * W_a * W_b * (omega_a + omega_b) / 2, point)
            most = worse(most, abs(evaluate(forms["Q_q"] - _exact(), point)) / scale)
        return _share(), float(most)

    yield error_size(
        "Q_q, in D k_c W_a W_b times the mean frequency,", sizes, "equal frequencies", lambda: _share() / 100
    )
    same = forms["Q_q"].subs({omega_b: omega_a})
    yield evidence("limit", vanishes(same - _exact().subs(omega_b, omega_a)), "exact for equal frequencies")
    average = sp.integrate(sp.expand_trig(sp.sin(omega_a * t)), (t, 0, 2 * sp.pi / omega_a))
    yield evidence(
        "identity",
        average == 0 and vanishes(forms["Q_q"] - _A6["Q_q"].subs(sp.sin(_SUM), 0)),
        "is (A6) without the sum frequency, which averages to zero",
    )


def _derive_a9() -> Derivation:
    rate = omega_b - omega_a
    turned = _DIFFERENCE.subs(t, t + 2 * sp.pi / rate) - _DIFFERENCE - 2 * sp.pi
    half = _DIFFERENCE.subs(t, t + sp.pi / rate) - _DIFFERENCE - sp.pi
    return Derivation(
        (
            step("(A8) repeats when its angle has turned once:", _A9["T_q"], zero=sp.cancel(turned)),
            step(
                "After half of it the sign changes, so each sense of rotation lasts T_q/2, as the text says:",
                _A9["T_q"] / 2,
                zero=sp.cancel(half),
            ),
        ),
        {"T_q": _A9["T_q"]},
    )


def _judge_a9(forms: Forms) -> Iterator[Evidence]:
    form = forms["T_q"]
    worst = mp.mpf(0)
    for point in points(sym("omega_a omega_b varphi_a varphi_b W_a W_b D k_c t"), 6, "A9", _RANGES):
        period = evaluate(form, {s: point[s] for s in form.free_symbols})
        angle = {s: point[s] for s in _DIFFERENCE.free_symbols}
        now, later, half = (
            evaluate(sp.sin(_DIFFERENCE), {**angle, t: point[t] + part}) for part in (0, period, period / 2)
        )
        whole, part = later - now, half + now
        worst = worse(worse(worst, abs(whole)), abs(part))
    yield evidence("numeric", worst < mp.mpf(10) ** -20, "the shortest period: the sign turns after half of it")
    swapped = form.subs({omega_a: omega_b, omega_b: omega_a}, simultaneous=True)
    yield evidence(
        "domain",
        vanishes(swapped - form) and bool(form.subs({omega_a: 3, omega_b: 2}) > 0),
        "positive, whichever phase is the faster",
    )
    yield evidence("limit", sp.limit(form.subs(omega_a, 1), omega_b, 1) == sp.oo, "no beat at equal frequencies")


def _none() -> str:
    return "None: printed and derived agree."


def _effect_a8() -> str:
    return (
        f"The dropped term is {figure(100 * _share(), 3)} % of the kept one's amplitude with a free and a forced "
        "phase 3000 "
        "Hz apart. The drift of the amplitudes, which (A6) takes as constant, costs more: see (24)."
    )


def _effect_a9() -> str:
    q = operating_point()
    beat = figure(1000 * 2 * mp.pi / q["Delta_omega"], 4)
    return f"{beat} ms at 3000 Hz. Decay and the third region are not in it (15)."


def _effect_a7() -> str:
    return (
        f"None on (A8): with frequencies the ratio is {figure(1 / _share())} at the operating point. With the phases "
        "of "
        "T_redu, 0 and pi/2, the printed statement compares equal numbers."
    )


ENTRIES = (
    Entry(
        id="A1",
        section="A",
        title="Two-phase modal response",
        place="Appendix A",
        printed=_A1,
        units={"w_A": "m", "w_B": "m"},
        verdict="definition",
        reason="Each phase its mode shape times a cosine of its own; here w includes the shape, in (9) and (10) not.",
        judge=_judge_a1,
        derive=_derive_a1,
        effect=_none,
    ),
    Entry(
        id="A2",
        section="A",
        title="Vertical and tangential displacement",
        place="Appendix A",
        printed=_A2,
        units={"zeta_z": "m", "zeta_x": "m"},
        verdict="verified",
        reason="(11) for the phases of (A1), with xi for zeta; shares (11)'s slope for the rotation.",
        judge=_judge_a2,
        derive=_derive_a2,
        effect=_none,
    ),
    Entry(
        id="A3",
        section="A",
        title="Direction of the path's point",
        place="Appendix A",
        printed=_A3,
        units={},
        known=_KNOWN,
        verdict="definition",
        reason="The polar angle of the displacement; the tangent leaves it open by half turns.",
        judge=_judge_a3,
        derive=_derive_a3,
        effect=_none,
    ),
    Entry(
        id="A4",
        section="A",
        title="Rate of the direction",
        place="Appendix A",
        printed=_A4,
        units={"rate": "1/s", "reduced": "1/s"},
        known=_KNOWN,
        verdict="erratum",
        reason="The quotient rule gives both differences the other way round: the print is minus the angle's rate.",
        judge=_judge_a4,
        derive=_derive_a4,
        effect=_effect_a4,
        repair=lambda forms: {name: -form for name, form in forms.items()},
        found_by=("numeric", "limit"),
    ),
    Entry(
        id="A5",
        section="A",
        title="Direction determinant",
        place="Appendix A",
        printed=_A5,
        units={"Q_q": "m^2/s"},
        known=_KNOWN,
        verdict="definition",
        reason="Minus twice the area swept per time, so clockwise is positive, as Section 5 has it.",
        judge=_judge_a5,
        derive=_derive_a5,
        effect=_none,
    ),
    Entry(
        id="A6",
        section="A",
        title="Determinant of two phases",
        place="Appendix A",
        printed=_A6,
        units={"Q_q": "m^2/s"},
        verdict="verified",
        reason="Exact for constant amplitudes, sign by sign, and independent of x.",
        judge=_judge_a6,
        derive=_derive_a6,
        effect=_none,
    ),
    Entry(
        id="A7",
        section="A",
        title="Why the sum frequency may be dropped",
        place="Appendix A",
        printed=_A7,
        units={},
        verdict="erratum",
        reason="Compares the phases where the frequencies are meant; phases are only known up to whole turns.",
        judge=_judge_a7,
        derive=_derive_a7,
        effect=_effect_a7,
        repair=_repair_a7,
        found_by=("numeric", "domain", "identity"),
    ),
    Entry(
        id="A8",
        section="A",
        title="Simplified determinant",
        place="Appendix A",
        printed=_A8,
        units={"Q_q": "m^2/s"},
        verdict="approximation",
        reason="(A6) without its small fast term.",
        judge=_judge_a8,
        derive=_derive_a8,
        effect=_effect_a8,
    ),
    Entry(
        id="A9",
        section="A",
        title="Period of the determinant",
        place="Appendix A",
        printed=_A9,
        units={"T_q": "s"},
        verdict="verified",
        reason="The period of (A8), each sense of rotation half of it; of (A6) only nearly.",
        judge=_judge_a9,
        derive=_derive_a9,
        effect=_effect_a9,
    ),
)
