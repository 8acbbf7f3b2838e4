"""Section 2.2, natural frequency: eqs. (3) to (6) and the stiffness below (5)."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations import beam, contact
from derivations.ledger.judge import agrees, evaluate, figure, identical, points, vanishes, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

x, t, E, rho, I_z, G, A, kappa = sym("x t E rho I_z G A kappa")
k_c, k_f, k_dx, k_ds, omega_n, omega_n0 = sym("k_c k_f k_dx k_ds omega_n omega_n0")
w, p, a_1, a_2, a_3, a_4, W_max, n_j, R = sym("w p a_1 a_2 a_3 a_4 W_max n_j R")
x_m, E_m, b_m, h_m, k_N, theta_c = sym("x_m E_m b_m h_m k_N theta")
theta = sp.Function("theta")(x, t)
_omega, _k = sp.Symbol("omega", positive=True), sp.Symbol("k", positive=True)
SHEAR = kappa * G * A

# --- (3) ----------------------------------------------------------------------------------------------------
_EQ3: Forms = {
    "force": sp.Eq(rho * A * w.diff(t, 2) + SHEAR * (theta.diff(x) - w.diff(x, 2)), p),
    "moment": sp.Eq(rho * I_z * theta.diff(t, 2) - E * I_z * theta.diff(x, 2) + SHEAR * (theta - w.diff(x)), 0),
}


def _timoshenko() -> Forms:
    force, moment = (sp.expand(e.subs(k_f, 0)) for e in beam.equations_of_motion())
    return {"force": sp.Eq(force + p, p), "moment": sp.Eq(moment, 0)}


def _derive_3() -> Derivation:
    kinetic = (rho * A * w.diff(t) ** 2 + rho * I_z * theta.diff(t) ** 2) / 2
    strain = (E * I_z * theta.diff(x) ** 2 + SHEAR * (w.diff(x) - theta) ** 2) / 2
    forms = _timoshenko()
    rest = [form.lhs - form.rhs for form in forms.values()]
    variation = [sp.diff(kinetic - strain + p * w, field) for field in (w, theta)]
    for index, field in enumerate((w, theta)):
        for variable in (t, x):
            variation[index] -= sp.diff(kinetic - strain, field.diff(variable)).diff(variable)
    return Derivation(
        (
            step("Kinetic energy per length, of translation and of rotation of the section:", kinetic),
            step(
                "Strain energy per length, of bending and of shear (the section turns by theta, the axis by w'):",
                strain,
            ),
            step("Hamilton's principle for T - V + p w, varied in w:", forms["force"], zero=variation[0] + rest[0]),
            step("and in theta:", forms["moment"], zero=variation[1] + rest[1]),
        ),
        forms,
    )


def _judge_3(forms: Forms) -> Iterator[Evidence]:
    trial = {
        w: sp.sin(_k * x) * sp.cos(_omega * t),
        theta: sp.cos(_k * x) * sp.cos(_omega * t) / 2 + sp.sin(2 * _omega * t) * _k * x,
        p: E * I_z * sp.cos(_k * x),
    }
    ranges = {"omega": (2e5, 3e5), "k": (200.0, 400.0)}
    yield agrees(forms, _timoshenko(), given=trial, ranges=ranges)
    # Energy: w_t force + theta_t moment must be d/dt of the energy less the flux through the ends less the load's
    # power.
    force, moment = (f.lhs - f.rhs for f in forms.values())
    energy = (rho * A * w.diff(t) ** 2 + rho * I_z * theta.diff(t) ** 2) / 2
    energy += (E * I_z * theta.diff(x) ** 2 + SHEAR * (w.diff(x) - theta) ** 2) / 2
    flux = E * I_z * theta.diff(x) * theta.diff(t) + SHEAR * (w.diff(x) - theta) * w.diff(t)
    balance = w.diff(t) * force + theta.diff(t) * moment - energy.diff(t) + flux.diff(x) + p * w.diff(t)
    yield evidence("identity", sp.expand(balance) == 0, "the power of the load is what energy and flux gain")
    stiff = {theta: w.diff(x)}
    euler = (force + moment.diff(x)).subs(stiff).doit()
    classic = rho * A * w.diff(t, 2) + E * I_z * 0
    rayleigh = euler - classic - rho * I_z * w.diff(x, 2, t, 2) + E * I_z * w.diff(x, 4) + p
    yield evidence("limit", sp.expand(rayleigh) == 0, "without shear (theta = w') it is Rayleigh's beam, sign by sign")


def _effect_3() -> str:
    return "None: printed and derived agree. The text writes the displacement omega, and the load once P, once p."


# --- (4) ----------------------------------------------------------------------------------------------------
_EQ4: Forms = {"w": W_max * sp.cos(k_c * x) * sp.sin(omega_n0 * t), "k_c": n_j / R}


def _derive_4() -> Derivation:
    a, b, c = (e.subs(k_f, 0) for e in beam.dispersion())
    e = {name: value.subs(k_f, 0) for name, value in beam.elimination().items()}
    form = _EQ4["w"]
    orders = {"xxxx": (x,) * 4, "xxtt": (x, x, t, t), "tttt": (t,) * 4, "tt": (t, t), "xx": (x, x), "1": ()}
    left = sum(e[name] * (form.diff(*orders[name]) if orders[name] else form) for name in e)
    quartic = a * omega_n0**4 - b * omega_n0**2 + c
    closes = sp.Eq(k_c * 2 * sp.pi * R, 2 * sp.pi * n_j)
    return Derivation(
        (
            step(
                "Put into the beam's equation (5) without foundation, the shape leaves a condition on the frequency "
                "alone:",
                sp.Eq(quartic, 0),
                zero=sp.expand(left / form - quartic),
            ),
            step(
                "The ring closes on itself when a whole number n_j of waves fits the circumference 2 pi R:",
                closes,
                zero=(closes.lhs - closes.rhs).subs(k_c, n_j / R),
            ),
        ),
        {"w": form, "k_c": contact.wavenumber()},
    )


def _judge_4(forms: Forms) -> Iterator[Evidence]:
    form, values = forms["w"], {k_c: forms["k_c"]}
    start = form.subs(t, 0) == 0 and vanishes(form.diff(t).subs({t: 0, x: 0}) - W_max * omega_n0)
    yield evidence("limit", start, "starts from zero with the crest's velocity W_max omega_n0")
    closed = form.subs(values)
    ranges = {"omega_n0": (2.3e5, 2.6e5)}
    nine = {n_j: 9}
    shifted = {"w": closed.subs(nine).subs(x, x + 2 * sp.pi * R)}
    yield agrees(shifted, {"w": closed.subs(nine)}, ranges=ranges, against="itself once around the ring of nine waves")
    yield agrees({"waves": forms["k_c"] * R}, {"waves": n_j}, against="n_j waves on the circumference", kind="domain")
    waves = vanishes(form.diff(t, 2) + omega_n0**2 * form) and vanishes(form.diff(x, 2) + k_c**2 * form)
    yield evidence(
        "identity", waves, "w_tt = -omega_n0^2 w and w_xx = -k_c^2 w, so (5) reduces to the dispersion relation"
    )
    ahead = form.subs({sp.cos(k_c * x): 1, x: 0})
    yield evidence("domain", ahead == W_max * sp.sin(omega_n0 * t), "the largest displacement is W_max, at x = 0")


def _effect_4() -> str:
    q = operating_point()
    half = q["n_j"] / mp.mpf("0.06") * q["l_s"] / (2 * mp.pi)
    return (
        f"k_c = {figure(q['k_c'], 5)} 1/m with R = 30 mm. Table 1's R = 60 mm would put {figure(half, 3)} waves on "
        "the perimeter of 188.4 mm, which does not close."
    )


# --- (5) ----------------------------------------------------------------------------------------------------
_EQ5: Forms = {
    "beam": sp.Eq(
        a_1 * w.diff(x, 4) + a_2 * w.diff(x, 2, t, 2) + a_3 * w.diff(t, 2) + a_4 * w.diff(t, 4) + k_ds * w, 0
    ),
    "a_1": E * I_z,
    "a_2": -(rho / (kappa * G) + rho / E) * E * I_z,
    "a_3": rho * A,
    "a_4": rho**2 * E * I_z / (E * kappa * G),
}
_COEFFICIENTS = {a_1: "xxxx", a_2: "xxtt", a_4: "tttt"}


def _corrected_5() -> Forms:
    e = beam.elimination()
    without = {name: value.subs(k_f, 0) for name, value in e.items()}
    extra_tt, extra_xx = sp.expand(e["tt"] - without["tt"]), sp.expand(e["xx"])
    foundation = k_f * w + extra_tt * w.diff(t, 2) + extra_xx * w.diff(x, 2)
    printed = a_1 * w.diff(x, 4) + a_2 * w.diff(x, 2, t, 2) + a_3 * w.diff(t, 2) + a_4 * w.diff(t, 4)
    return {
        "beam": sp.Eq(printed + foundation, 0),
        **{a.name: e[name] for a, name in _COEFFICIENTS.items()},
        "a_3": without["tt"],
    }


def _repair_5(forms: Forms) -> Forms:
    """k_f for k_ds, and the two terms of the foundation that were dropped."""
    cross = k_f * rho * I_z / SHEAR * w.diff(t, 2) - k_f * E * I_z / SHEAR * w.diff(x, 2)
    return {**forms, "beam": sp.Eq(forms["beam"].lhs.subs(k_ds, k_f) + cross, forms["beam"].rhs)}


def _derive_5() -> Derivation:
    force, moment = beam.equations_of_motion()
    forms = _corrected_5()
    slope = sp.solve(force.subs(p, 0), theta.diff(x))[0]
    bending = E * I_z * sp.Symbol("theta_xxx") - SHEAR * (sp.Symbol("theta_x") - w.diff(x, 2))
    bending -= rho * I_z * sp.Symbol("theta_xtt")
    values = {"theta_x": slope, "theta_xxx": slope.diff(x, 2), "theta_xtt": slope.diff(t, 2)}
    single = bending.subs({sp.Symbol(name): value for name, value in values.items()}).doit()
    definitions = {sym(name)[0]: form for name, form in forms.items() if name != "beam"}
    final = forms["beam"].lhs.subs(definitions)
    return Derivation(
        (
            step(
                "Timoshenko's equations on a foundation that presses back with k_f w, load p = 0:",
                sp.Eq(force.subs(p, 0), 0),
                sp.Eq(moment, 0),
            ),
            step(
                "The first gives the rotation's slope:",
                sp.Eq(theta.diff(x), slope),
                zero=force.subs(p, 0).subs(theta.diff(x), slope),
            ),
            step(
                "The second, differentiated by x, holds only slopes of theta. With the first put in, one equation "
                "for w is left; the foundation appears three times, also with shear and rotation:",
                forms["beam"],
                zero=sp.expand(single - final),
            ),
            step(
                "A wave W cos(k_c x) cos(omega t) turns it into a quadratic in omega^2, the dispersion relation:",
                sp.Eq(sum(c * s for c, s in zip(beam.dispersion(), (_omega**4, -(_omega**2), 1), strict=True)), 0),
            ),
        ),
        forms,
    )


def _wave_value(forms: Forms, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
    """What the single equation leaves of cos(k x) cos(omega t), at the crest."""
    definitions = {sym(name)[0]: form for name, form in forms.items() if name != "beam"}
    left = (forms["beam"].lhs - forms["beam"].rhs).subs(definitions)
    value = left.subs(w, sp.cos(_k * x) * sp.cos(_omega * t)).doit().subs({x: 0, t: 0})
    return evaluate(value, point)


def _judge_5(forms: Forms) -> Iterator[Evidence]:
    symbols = (*sym("E rho I_z G A kappa k_f"), _k, _omega)
    ranges = {"omega": (1.5e5, 3e5), "k": (200.0, 400.0)}
    worst = mp.mpf(0)
    for point in points(symbols, 5, seed="eq5", ranges=ranges):
        e, r, i, g, a, shear, f = (point[s] for s in sym("E rho I_z G A kappa k_f"))
        k, o = point[_k], point[_omega]
        shear *= g * a
        # the 2 x 2 system for w = cos cos, theta = -B sin cos, taken as numbers
        bend = r * i * o**2 - e * i * k**2 - shear
        matrix = mp.matrix([[-r * a * o**2 + shear * k**2 + f, -shear * k], [shear * k, bend]])
        wanted = -mp.det(matrix) / shear
        found = _wave_value(forms, {**point, k_ds: f, k_dx: f})
        worst = worse(worst, abs(found / wanted - 1))
    yield evidence(
        "numeric",
        worst < mp.mpf(10) ** -20,
        f"differs from the determinant of the two equations (3) by {mp.nstr(worst, 3)} relative at most",
    )
    symbolic = identical(
        {"beam": forms["beam"].subs({sym(n)[0]: f for n, f in forms.items() if n != "beam"})}, {"beam": beam_equation()}
    )
    yield symbolic
    drop = {k_f: 0, k_ds: 0}
    plain = (forms["beam"].lhs.subs(drop) - _EQ5_FREE) if isinstance(forms["beam"], sp.Eq) else sp.Integer(1)
    yield evidence("limit", sp.expand(plain) == 0, "without foundation it is the usual single Timoshenko equation")


_EQ5_FREE = a_1 * w.diff(x, 4) + a_2 * w.diff(x, 2, t, 2) + a_3 * w.diff(t, 2) + a_4 * w.diff(t, 4)


def beam_equation() -> sp.Eq:
    """The single equation by elimination of theta with operators, foundation kept."""
    orders = {"xxxx": (x,) * 4, "xxtt": (x, x, t, t), "tttt": (t,) * 4, "tt": (t, t), "xx": (x, x), "1": ()}
    terms = [value * (w.diff(*orders[name]) if orders[name] else w) for name, value in beam.elimination().items()]
    return sp.Eq(sum(terms), 0)


def _effect_5() -> str:
    q = dict(operating_point())
    a, b, c = beam.dispersion()
    bare = {"b": b.subs(k_f, 0), "c": c.subs(k_f, 0) + k_f}
    full = at_point(beam.resonance()["quartic"], q)
    av, bv, cv = at_point(a, q), at_point(bare["b"], q), at_point(bare["c"], q)
    without = mp.sqrt(2 * cv / (bv + mp.sqrt(bv**2 - 4 * av * cv)))
    hertz = (without - full) / (2 * mp.pi)
    printed = dict(q, k_f=q["k_dx"])
    stiff = at_point(beam.resonance()["quartic"], printed) - full
    return (
        f"Leaving out the two cross terms moves the resonance by {figure(hertz, 4)} Hz; k_dx's number, "
        f"{figure(q['k_dx'], 4)} N/m, in place of k_f = {figure(q['k_f'], 4)} N/m^2 by "
        f"{figure(stiff / (2 * mp.pi), 4)} Hz."
    )


def _size_5() -> tuple[str, float]:
    q = dict(operating_point())
    full = at_point(beam.resonance()["quartic"], q)
    return "the resonance", float(at_point(beam.resonance()["quartic"], dict(q, k_f=q["k_dx"])) / full - 1)


# --- k_dx below (5) -----------------------------------------------------------------------------------------
_KDX: Forms = {"k_dx": 2 * n_j * x_m * E_m * b_m / h_m}


def _derive_kdx() -> Derivation:
    total = contact.foundation()["printed"].subs({k_N: contact.layer_stiffness(), theta_c: k_c * x_m})
    return Derivation(
        (
            step(
                "A strip of the layer, as long as dx, resists indentation by E_m b_m / h_m dx:",
                sp.Eq(k_N, contact.layer_stiffness()),
            ),
            step(
                "n_j contacts of the length 2 x_m together, all indented alike, resist by",
                total,
                zero=total - sp.Integral(contact.layer_stiffness(), (x, -x_m, x_m)).doit() * n_j,
            ),
        ),
        {"k_dx": total},
    )


def _judge_kdx(forms: Forms) -> Iterator[Evidence]:
    derived = _derive_kdx().forms
    yield agrees(forms, derived, ranges={"x_m": (5e-4, 2e-3)})
    yield identical(forms, derived)
    yield evidence("limit", forms["k_dx"].subs(x_m, 0) == 0, "no contact, no stiffness")


def _effect_kdx() -> str:
    q = operating_point()
    smeared = at_point(contact.foundation()["smeared"], q)
    return (
        f"k_dx = {figure(q['k_dx'], 4)} N/m in all at Table 3. Spread over the circumference 2 pi R it is "
        f"{figure(smeared, 4)} N/m^2, its fundamental harmonic {figure(q['k_f'], 4)} N/m^2."
    )


# --- (6) ----------------------------------------------------------------------------------------------------
_EQ6: Forms = {
    "omega_n": sp.sqrt((E * I_z * k_c**4 + k_dx) / (rho * A + rho * (1 / (kappa * G) + 1 / E) * k_c**2)),
}


def _repair_6(forms: Forms) -> Forms:
    """k_f for k_dx and its two lost terms, and the factor E I_z of the second term below."""
    above, below = sp.fraction(forms["omega_n"] ** 2)
    lower = rho * A + sp.expand(below - rho * A) * E * I_z + k_f * rho * I_z / SHEAR
    upper = above.subs(k_dx, k_f) + k_f * E * I_z * k_c**2 / SHEAR
    return {"omega_n": forms["omega_n"] * sp.sqrt(upper * below / (lower * above))}


def _derive_6() -> Derivation:
    a, b, c = (sp.expand(coefficient) for coefficient in beam.dispersion())
    root, lower = sp.sqrt(c / b), 2 * c / (b + sp.sqrt(b**2 - 4 * a * c))
    quartic = a * _omega**4 - b * _omega**2 + c
    wave = sp.cos(k_c * x) * sp.sin(_omega * t)
    corrected = _corrected_5()
    values = {sym(name)[0]: form for name, form in corrected.items() if name != "beam"}
    left = corrected["beam"].lhs.subs(values)
    return Derivation(
        (
            step(
                "Eq. (5) put right, with the foundation's two further terms, which arise where its force enters the "
                "elimination of the rotation from (3):",
                corrected["beam"],
                *(sp.Eq(symbol, form) for symbol, form in values.items()),
                zero=left - beam_equation().lhs,
            ),
            step(
                "The wave (4) put into it leaves of every term a number times the same shape; with omega for its "
                "frequency:",
                sp.Eq(w, wave),
                sp.Eq(quartic, 0),
                zero=sp.expand(left.subs(w, wave).doit() / wave - quartic),
            ),
            step(
                "The paper drops a_4 omega^4 without a word (what that costs is under Effect). What is left is "
                "linear in omega^2:",
                sp.Eq(_omega**2 * b, c),
                zero=_omega**2 * b - c - (a * _omega**4 - quartic),
            ),
            step(
                "Solved for omega. Each term below carries the inertia it comes from. The printed one, rho (1/(kappa "
                "G) + 1/E) k_c^2, lost a_2's factor E I_z, so that kg/m and s^2/m^4 would be added:",
                sp.Eq(omega_n, root),
                zero=[root**2 * b - c, root**2 - beam.resonance()["eq6"] ** 2],
            ),
            step(
                "With a_4 kept there are two roots omega^2; the lower one is the bending mode. It is what the figures "
                "under Effect call the full quartic:",
                sp.Eq(omega_n, beam.resonance()["quartic"]),
                zero=sp.radsimp(quartic.subs(_omega, sp.sqrt(lower))),
            ),
        ),
        {"omega_n": root},
    )


def _judge_6(forms: Forms) -> Iterator[Evidence]:
    form = forms["omega_n"]
    symbols = sym("E rho I_z G A kappa k_c k_f")
    worst = worst_exact = mp.mpf(0)
    for point in points(symbols, 6, seed="eq6"):
        e, r, i, g, a, shear, k, f = (point[s] for s in symbols)
        shear *= g * a
        found = evaluate(form, {**point, k_dx: f})
        # squared frequencies of w = cos, theta = -B sin, from the stiffness and mass matrices of (3)
        stiffness = mp.matrix([[shear * k**2 + f, -shear * k], [-shear * k, e * i * k**2 + shear]])
        product, trace = mp.det(stiffness), stiffness[0, 0] * r * i + stiffness[1, 1] * r * a
        worst = worse(worst, abs(found**2 * trace / product - 1))
        scale = mp.diag([1 / mp.sqrt(r * a), 1 / mp.sqrt(r * i)])
        squares = mp.eigsy(scale * stiffness * scale, eigvals_only=True)
        worst_exact = worse(worst_exact, abs(found / mp.sqrt(min(squares)) - 1))
    yield evidence(
        "numeric",
        worst < mp.mpf(10) ** -20,
        f"differs from det K / tr(K, M) of (3), the root without a_4, by {mp.nstr(worst, 3)} relative at most",
    )
    slender = sp.limit(form.subs({k_f: 0, k_dx: 0}) / k_c**2, k_c, 0)
    euler = sp.sqrt(E * I_z / (rho * A))
    yield evidence("limit", vanishes(slender - euler), "long waves: Euler and Bernoulli's beam")
    yield identical(forms, {"omega_n": beam.resonance()["eq6"]})
    yield evidence(
        "error_size",
        worst_exact < 0.05,
        f"off the exact lower eigenvalue by {mp.nstr(100 * worst_exact, 3)} % at most; allowed 5 %",
    )


def _effect_6() -> str:
    q = dict(operating_point())
    free = dict(q, k_f=mp.mpf(0), k_dx=mp.mpf(0))
    hertz = {name: at_point(expr, q) / (2 * mp.pi) for name, expr in beam.resonance().items()}
    unloaded = {name: at_point(expr, free) / (2 * mp.pi) for name, expr in beam.resonance().items()}
    error = 100 * (hertz["printed"] / hertz["eq6"] - 1)
    return (
        f"At 180 N: printed {figure(hertz['printed'], 6)} Hz, put right {figure(hertz['eq6'], 6)} Hz "
        f"({figure(error, 3)} %), full quartic {figure(hertz['quartic'], 6)} Hz (dropping a_4 costs "
        f"{figure(hertz['eq6'] - hertz['quartic'], 4)} Hz), Euler-Bernoulli {figure(hertz['euler'], 6)} Hz; "
        f"measured 39703 Hz. Without prepressure: printed {figure(unloaded['printed'], 6)} Hz, put right "
        f"{figure(unloaded['eq6'], 6)} Hz, quartic {figure(unloaded['quartic'], 6)} Hz."
    )


def _picture_6() -> Picture:
    q = dict(operating_point(), k_f=mp.mpf(0), k_dx=mp.mpf(0))
    waves = [20 * i for i in range(1, 31)]
    labels = {
        "printed": "(6) as printed",
        "eq6": "(6) put right",
        "quartic": "full quartic",
        "euler": "Euler-Bernoulli",
    }
    curves = {}
    for name, label in labels.items():
        values = [at_point(beam.resonance()[name], {**q, "k_c": mp.mpf(k)}) / (2 * mp.pi * 1000) for k in waves]
        curves[label] = ([float(k) for k in waves], [float(v) for v in values])
    return Picture("Resonance over wavenumber, no prepressure", "k_c, 1/m", "f_n, kHz", curves)


ENTRIES = (
    Entry(
        id="3",
        section="2.2",
        title="Timoshenko's equations of the beam",
        place="Sect. 2.2",
        printed=_EQ3,
        units={},
        verdict="verified",
        reason="Hamilton's principle gives the same two equations, sign by sign.",
        judge=_judge_3,
        derive=_derive_3,
        effect=_effect_3,
    ),
    Entry(
        id="4",
        section="2.2",
        title="Standing wave and wavenumber",
        place="Sect. 2.2",
        printed=_EQ4,
        units={"w": "m", "k_c": "1/m"},
        verdict="verified",
        reason="A mode of the closed ring; its mate is the one with sin(k_c x). R is the radius, 30 mm.",
        judge=_judge_4,
        derive=_derive_4,
        effect=_effect_4,
    ),
    Entry(
        id="5",
        section="2.2",
        title="Single equation of the beam under prepressure",
        place="Sect. 2.2",
        printed=_EQ5,
        units={"a_1": "N*m^2", "a_2": "kg*m", "a_3": "kg/m", "a_4": "kg*s^2/m"},
        verdict="erratum",
        reason="k_ds (below it k_dx) is a stiffness in N/m where one per length, N/m^2, is needed, and eliminating "
        "theta with a foundation leaves two more terms, in w_tt and w_xx. The coefficients a_1 to a_4 are "
        "right.",
        judge=_judge_5,
        derive=_derive_5,
        effect=_effect_5,
        repair=_repair_5,
        size=_size_5,
        found_by=("dimension", "numeric", "identity"),
    ),
    Entry(
        id="k_dx",
        section="2.2",
        title="Stiffness of the friction layer",
        place="below eq. (5)",
        printed=_KDX,
        units={"k_dx": "N/m"},
        verdict="definition",
        reason="The stiffness of n_j contacts indented alike, in N/m; as a foundation of eq. (5) it does not fit. Its "
        "m is the number of crests, not of pulses.",
        judge=_judge_kdx,
        derive=_derive_kdx,
        effect=_effect_kdx,
    ),
    Entry(
        id="6",
        section="2.2",
        title="Resonance under prepressure",
        place="Sect. 2.2",
        printed=_EQ6,
        units={"omega_n": "rad/s"},
        verdict="erratum",
        reason="The denominator lost the factor E I_z of a_2, the numerator holds k_dx [N/m] where k_f [N/m^2] "
        "belongs, the foundation's cross terms are missing, and a_4 is dropped in silence.",
        judge=_judge_6,
        derive=_derive_6,
        effect=_effect_6,
        repair=_repair_6,
        found_by=("dimension", "numeric", "identity", "error_size"),
        picture=_picture_6,
    ),
)
