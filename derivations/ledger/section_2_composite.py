"""Section 2.1, the composite section: eqs. (1), (2) and the equivalent beam between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import mpmath as mp
import sympy as sp

from derivations import amplitude, beam, section
from derivations.ledger.judge import agrees, error_size, figure, identical, largest, points, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import DRIVE, at_point, operating_point, stator
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "resolved"]

E_eq, h_e, b_e, E_p, h_p, b_p, D, z = sym("E_eq h_e b_e E_p h_p b_p D z")
E_e, G_e, rho_e, h_t, n_s, b_s, l_s = sym("E_e G_e rho_e h_t n_s b_s l_s")
k_t, k_s, k_d, rho_eq, G_eq, A_eq, A_p, A = sym("k_t k_s k_d rho_eq G_eq A_eq A_p A")
I_e, I_p, I_z, h, E, rho, G, rho_p, G_p = sym("I_e I_p I_z h E rho G rho_p G_p")

# --- (1) ----------------------------------------------------------------------------------------------------
_EQ1: Forms = {
    "D": (E_eq * h_e**2 * b_e + 2 * E_p * h_p * h_e * b_p + E_p * h_p**2 * b_p)
    / (2 * (E_eq * h_e * b_e + E_p * h_p * b_p))
}


def _axis() -> sp.Expr:
    return section.neutral_axis().subs(section.equivalent_beam()["E_eq"], E_eq)


def _derive_1() -> Derivation:
    strain = sp.Integral(E_eq * b_e * (z - D), (z, 0, h_e)) + sp.Integral(E_p * b_p * (z - D), (z, h_e, h_e + h_p))
    axis = _axis()
    return Derivation(
        (
            step(
                "Plane sections stay plane: the bending stress at depth z below the tooth surface grows as "
                "the modulus times z - D. Bending alone carries no axial force:",
                sp.Eq(strain, 0),
            ),
            step("The integrals are elementary, and linear in D:", sp.Eq(strain.doit(), 0)),
            step("Solved for D; put back, the axial force vanishes:", sp.Eq(D, axis), zero=strain.doit().subs(D, axis)),
        ),
        {"D": axis},
    )


def _judge_1(forms: Forms) -> Iterator[Evidence]:
    def moment(_: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        """First moment over zeroth, by quadrature."""
        E, be, he, Ep, bp, hp = (point[s] for s in (E_eq, b_e, h_e, E_p, b_p, h_p))
        layers = ((E * be, [0, he]), (Ep * bp, [he, he + hp]))
        return sum(k * mp.quad(lambda u: u, span) for k, span in layers) / sum(
            k * mp.quad(lambda _: 1, span) for k, span in layers
        )

    symbols = (E_eq, b_e, h_e, E_p, b_p, h_p)
    yield agrees(forms, moment, symbols=symbols, against="the centroid by quadrature")
    yield evidence("limit", sp.limit(forms["D"], h_p, 0) == h_e / 2, "without ceramic D is half the beam's height")
    yield identical(forms, {"D": _axis()})

    put = forms["D"].subs(E_eq, section.equivalent_beam()["E_eq"])

    def sizes() -> tuple[float, float]:
        names = sym("E_e E_p h_e h_t h_p b_e b_p")
        around = [{s.name: v for s, v in point.items()} for point in points(names, 8, seed="axis")]
        off = [at_point(put, p) / _layers(p)[0] - 1 for p in (dict(operating_point()), *around)]
        return float(off[0]), float(largest(abs(o) for o in off))

    def low_teeth() -> float:
        p = dict(operating_point())
        p["h_t"] /= 100
        return float(at_point(put, p) / _layers(p)[0] - 1)

    yield error_size("D, against the axis of the layers that carry stress,", sizes, "low teeth, h_t -> 0", low_teeth)


def _effect_1() -> str:
    p, layers = dict(operating_point()), stator(DRIVE["F_c"], layered=True)
    middle = p["h_e"] + p["h_p"] / 2
    arm = (middle - p["D"]) / (middle - layers["D"]) - 1
    forced = [at_point(amplitude.forced(), {**p, "D": axis}) for axis in (p["D"], layers["D"])]
    softer = _hertz({**p, "E": layers["E"] * layers["I_z"] / p["I_z"]})
    return (
        f"D = {figure(1000 * p['D'], 5)} mm. The metal below the teeth and the ceramic, each with its own modulus, "
        f"have their axis at {figure(1000 * layers['D'], 5)} mm: eq. 1 is "
        f"{figure(100 * (p['D'] / layers['D'] - 1), 3)} % "
        f"off. Down the line D multiplies the surface's tangential displacement and speed, so these are as much too "
        f"small; the ceramic's arm of eq. 7 is {figure(100 * arm, 3)} % too long, and with it the amplitude forced at "
        f"the drive frequency: {figure(1e6 * forced[0], 4)} um, {figure(1e6 * forced[1], 4)} um with the layers' axis. "
        f"With the layers' bending stiffness the resonance is {figure(softer / 1000, 4)} kHz instead of "
        f"{figure(_hertz(p) / 1000, 4)} kHz, with their axis for the rotary inertia too "
        f"{figure(_hertz(layers) / 1000, 4)} kHz; measured 39.703 kHz."
    )


# --- definitions between (1) and (2) ------------------------------------------------------------------------
_BEAM: Forms = {
    "rho_eq": k_d * rho_e,
    "E_eq": (1 - k_t) ** 3 * E_e,
    "G_eq": k_d * G_e,
    "k_d": 1 - k_t * k_s,
    "k_t": h_t / h_e,
    "k_s": n_s * b_s / l_s,
    "A_eq": h_e * b_e,
    "A_p": h_p * b_p,
    "A": A_eq + A_p,
}


def resolved(forms: Forms) -> dict[str, sp.Expr]:
    """The named expressions with each other put in, until only basic symbols are left."""
    values = {sym(name)[0]: sp.sympify(form) for name, form in forms.items()}
    result = {name: sp.sympify(form) for name, form in forms.items()}
    for _ in forms:
        known = {name: form.free_symbols & values.keys() for name, form in result.items()}
        if not any(known.values()):
            break
        put = {n: {s: values[s] for s in known[n] if s.name != n} for n in result}
        result = {name: form.subs(put[name]) if put[name] else form for name, form in result.items()}
    return result


def _derive_beam() -> Derivation:
    beam = section.equivalent_beam()
    bent = sp.Integral(z**2, (z, -(h_e - h_t) / 2, (h_e - h_t) / 2))
    full = sp.Integral(z**2, (z, -h_e / 2, h_e / 2))
    grooves = n_s * b_s * h_t / (l_s * h_e)
    ratio = bent.doit() / full.doit()
    return Derivation(
        (
            step(
                "The grooves take n_s b_s of the circumference l_s to the depth h_t: their share of the metal's "
                "volume, which mass and shear area lose, is",
                grooves,
                zero=beam["rho_eq"] / rho_e - (1 - grooves),
            ),
            step(
                "Teeth carry no bending stress, so only h_e - h_t bends; about its own middle it has, against the "
                "whole height, the fraction",
                sp.Eq(bent / full, sp.factor(ratio)),
                zero=ratio - beam["E_eq"] / E_e,
            ),
            step(
                "This scales the modulus so that the full height h_e may be used. It is exact for the metal alone. "
                "In the composite the stress lies about another axis, so the bending stiffness is an approximation."
            ),
        ),
        {
            **beam,
            "k_t": h_t / h_e,
            "k_s": n_s * b_s / l_s,
            "k_d": 1 - grooves,
            "A_eq": b_e * h_e,
            "A_p": b_p * h_p,
            "A": b_e * h_e + b_p * h_p,
        },
    )


def _layers(values: dict[str, mp.mpf]) -> tuple[mp.mpf, mp.mpf]:
    """Axis and bending stiffness of metal below the teeth and ceramic, each with its own modulus, by quadrature."""
    v = values
    layers = (
        (v["E_e"] * v["b_e"], v["h_t"], v["h_e"]),
        (v["E_p"] * v["b_p"], v["h_e"], v["h_e"] + v["h_p"]),
    )
    zeroth = sum(k * mp.quad(lambda _: 1, [low, high]) for k, low, high in layers)
    axis = sum(k * mp.quad(lambda u: u, [low, high]) for k, low, high in layers) / zeroth
    return axis, sum(k * mp.quad(lambda u: (u - axis) ** 2, [low, high]) for k, low, high in layers)


def _stiffness_error(forms: Forms, values: dict[str, mp.mpf]) -> mp.mpf:
    """Relative error of E I_z when the equivalent beam of the forms is used."""
    modulus = section.section()["E_eq"]
    whole = (section.section()["E"] * section.section()["I_z"]).subs(D, section.neutral_axis())
    return at_point(whole.subs(modulus, resolved(forms)["E_eq"]), values) / _layers(values)[1] - 1


def _judge_beam(forms: Forms) -> Iterator[Evidence]:
    derived = _derive_beam().forms
    found = resolved(forms)
    yield agrees(found, derived)
    yield identical(found, derived)
    plain = {name: form.subs(h_t, 0) for name, form in found.items()}
    same = plain["E_eq"] == E_e and plain["G_eq"] == G_e and plain["rho_eq"] == rho_e
    yield evidence("limit", same, "without teeth the equivalent beam is the metal's")

    def pitch(values: dict[str, mp.mpf]) -> mp.mpf:
        """Relative error of the resonance, which is what the paper computes from the equivalent beam."""
        whole = {**values, "D": at_point(section.neutral_axis(), values)}
        whole |= {name: at_point(expr, whole) for name, expr in section.section().items()}
        layered = {**whole, "E": whole["E"] / (1 + _stiffness_error(forms, values))}
        quartic = beam.resonance()["quartic"]
        return at_point(quartic, whole) / at_point(quartic, layered) - 1

    def sizes() -> tuple[float, float]:
        around = [
            {s.name: v for s, v in point.items()}
            for point in points(sym("E_e E_p h_e h_t h_p b_e b_p n_s b_s l_s"), 8, seed="beam")
        ]
        fixed = {name: value for name, value in operating_point().items() if name not in around[0]}
        return float(pitch(dict(operating_point()))), float(largest(abs(pitch({**fixed, **p})) for p in around))

    def thin() -> float:
        q = dict(operating_point())
        return float(pitch({**q, "h_p": q["h_p"] / 100}))

    yield error_size("the resonance, by way of E I_z,", sizes, "a thin ceramic, h_p -> 0", thin)


def _hertz(values: Mapping[str, mp.mpf]) -> mp.mpf:
    return at_point(beam.resonance()["quartic"], values) / (2 * mp.pi)


def _effect_beam() -> str:
    p = dict(operating_point())
    exact = at_point(section.layered()["EI"].subs(D, section.layered()["D"]), p)
    softer = _hertz({**p, "E": exact / p["I_z"]})
    return (
        f"E I_z = {figure(p['E'] * p['I_z'], 5)} N m^2 by the equivalent beam, {figure(exact, 5)} N m^2 by layers "
        f"({figure(100 * (p['E'] * p['I_z'] / exact - 1), 3, '+.1f')} %), which moves the resonance from "
        f"{figure(softer / 1000, 4)} to {figure(_hertz(p) / 1000, 4)} kHz "
        f"({figure(100 * (_hertz(p) / softer - 1), 3, '+.1f')} %; full quartic, same inertias)."
    )


# --- the section in layers ----------------------------------------------------------------------------------
def _derive_layers() -> Derivation:
    strain = sp.Integral(E_e * b_e * (z - D), (z, h_t, h_e)) + sp.Integral(E_p * b_p * (z - D), (z, h_e, h_e + h_p))
    bent = sp.Integral(E_e * b_e * (z - D) ** 2, (z, h_t, h_e))
    bent += sp.Integral(E_p * b_p * (z - D) ** 2, (z, h_e, h_e + h_p))
    forms = {"D": section.layered()["D"], "EI": section.layered()["EI"]}
    alone = sp.Rational(1, 12) * E_e * b_e * (h_e - h_t) ** 3
    softened = section.equivalent_beam()["E_eq"] * b_e * h_e**3 / 12
    middle = sp.integrate(E_e * b_e * z, (z, h_t, h_e)) / sp.integrate(E_e * b_e, (z, h_t, h_e))
    return Derivation(
        (
            step(
                "The teeth end freely along the ring, so stress begins below them, at z = h_t. The metal there and "
                "the ceramic carry it, each with its own modulus; no axial force:",
                sp.Eq(strain, 0),
            ),
            step("Solved for the axis:", sp.Eq(D, forms["D"]), zero=sp.factor(strain.doit().subs(D, forms["D"]))),
            step("The moment per curvature about that axis:", bent, zero=sp.expand(bent.doit() - forms["EI"])),
            step(
                "Without ceramic this is (1 - k_t)^3 E_e over the whole height, the equivalent modulus of the text: "
                "in bending about the metal's own middle both agree.",
                alone,
                zero=[
                    sp.expand(forms["EI"].subs(D, (h_t + h_e) / 2).subs(b_p, 0) - alone),
                    sp.simplify(alone - softened),
                ],
            ),
            step(
                "But that middle lies at (h_t + h_e)/2, not at h_e/2 where eq. 1 has it, and the modulus that an "
                "axial force meets is E_e over the height h_e - h_t, (1 - k_t) E_e over the whole: eq. 1 takes "
                "(1 - k_t)^3 E_e.",
                middle,
                zero=sp.simplify(middle - (h_t + h_e) / 2),
            ),
        ),
        forms,
    )


def _judge_layers(forms: Forms) -> Iterator[Evidence]:
    whole = {"D": forms["D"], "EI": forms["EI"].subs(D, forms["D"])}

    def by_strips(name: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        return _layers({s.name: number for s, number in point.items()})[name == "EI"]

    symbols = sym("E_e E_p h_e h_t h_p b_e b_p")
    yield agrees(whole, by_strips, symbols=symbols, against="the layers by quadrature")
    least = forms["EI"].diff(D).subs(D, forms["D"])
    yield evidence("identity", vanishes(sp.factor(least)), "the stiffness is least about the axis, as it must be")
    one = whole["EI"].subs({E_p: E_e, b_p: b_e, h_t: 0})
    solid = vanishes(sp.simplify(one - E_e * b_e * (h_e + h_p) ** 3 / 12))
    yield evidence("limit", solid, "one metal without teeth is a solid bar")


def _effect_layers() -> str:
    p, layers = operating_point(), stator(DRIVE["F_c"], layered=True)
    D_off = 100 * (layers["D"] / p["D"] - 1)
    return (
        f"At Table 3 the layers' axis and stiffness give a resonance of {figure(_hertz(layers) / 1000, 5)} kHz, "
        f"{figure(100 * (_hertz(layers) * 1000 / 39703000 - 1), 3, '+.1f')} % off the measured 39.703 kHz; eqs. 1 and "
        f"2 give {figure(_hertz(p) / 1000, 5)} kHz, {figure(100 * (_hertz(p) / 39703 - 1), 3, '+.1f')} %. Their axis "
        f"makes the surface {figure(D_off, 3, '+.1f')} % faster. The computations keep the axis of eq. 1: they compute "
        "what the paper's model says, its equivalent beam and its axis belong together, and teeth that carry no stress "
        "at all are a limit, which the measured resonance does not bear out. Another axis can be given for D."
    )


# --- (2) ----------------------------------------------------------------------------------------------------
_EQ2: Forms = {
    "E": (E_eq * I_e + E_p * I_p) / I_z,
    "rho": (rho_eq * A_eq + rho_p * A_p) / A,
    "I_z": I_e + I_p,
    "G": (G_eq * A_eq + G_p * A_p) / A,
    "I_e": b_e * (D**3 + (h_e - D) ** 3) / 3,
    "I_p": b_p * ((h - D) ** 3 - (h_e - D) ** 3) / 3,
    "h": h_e + h_p,
    "A_eq": h_e * b_e,
    "A_p": h_p * b_p,
    "A": A_eq + A_p,
}


def _derive_2() -> Derivation:
    beam, whole = section.equivalent_beam(), section.section()
    back = {beam["E_eq"]: E_eq, beam["rho_eq"]: rho_eq, beam["G_eq"]: G_eq}
    of_metal = sp.Integral(z**2, (z, -D, h_e - D)) * b_e
    of_ceramic = sp.Integral(z**2, (z, h_e - D, h_e + h_p - D)) * b_p
    forms = {name: whole[name].subs(back) for name in ("E", "rho", "I_z", "G")}
    forms |= {"I_e": of_metal.doit(), "I_p": of_ceramic.doit(), "h": h_e + h_p}
    forms |= {"A_eq": b_e * h_e, "A_p": b_p * h_p, "A": whole["A"]}
    total = E_eq * of_metal + E_p * of_ceramic
    return Derivation(
        (
            step(
                "From the neutral axis z, the second moments of metal and ceramic are integrals over their heights:",
                sp.Eq(I_e, of_metal),
                sp.Eq(I_p, of_ceramic),
            ),
            step(
                "A curvature strains both alike, so bending stiffnesses add; E is what multiplies I_z = I_e + I_p to "
                "give their sum:",
                sp.Eq(E * I_z, total),
                zero=forms["E"] * forms["I_z"] - total.doit(),
            ),
            step(
                "Masses add:",
                sp.Eq(rho * A, rho_eq * A_eq + rho_p * A_p),
                zero=forms["rho"] * forms["A"] - rho_eq * forms["A_eq"] - rho_p * forms["A_p"],
            ),
            step(
                "Shear stiffnesses add if both layers shear by the same angle, which kappa then corrects:",
                sp.Eq(G * A, G_eq * A_eq + G_p * A_p),
                zero=forms["G"] * forms["A"] - G_eq * forms["A_eq"] - G_p * forms["A_p"],
            ),
        ),
        forms,
    )


def _judge_2(forms: Forms) -> Iterator[Evidence]:
    found = resolved(forms)
    names = "E_eq E_p rho_eq rho_p G_eq G_p b_e b_p h_e h_p D"

    def by_quadrature(name: str, point: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
        v = {s.name: number for s, number in point.items()}
        low, middle = -v["D"], v["h_e"] - v["D"]
        high = middle + v["h_p"]
        metal = v["b_e"] * mp.quad(lambda u: u**2, [low, middle])
        ceramic = v["b_p"] * mp.quad(lambda u: u**2, [middle, high])
        areas = v["b_e"] * (middle - low), v["b_p"] * (high - middle)
        rho, G = (mp.fdot(areas, (v[f"{s}_eq"], v[f"{s}_p"])) / sum(areas) for s in ("rho", "G"))
        return {
            "E": (v["E_eq"] * metal + v["E_p"] * ceramic) / (metal + ceramic),
            "I_z": metal + ceramic,
            "rho": rho,
            "G": G,
            "I_e": metal,
            "I_p": ceramic,
            "h": high - low,
            "A_eq": areas[0],
            "A_p": areas[1],
            "A": sum(areas),
        }[name]

    ranges = {"rho_eq": (7e3, 9e3), "G_eq": (3e10, 5e10)}
    yield agrees(found, by_quadrature, symbols=sym(names), ranges=ranges, against="the section by quadrature")
    one = found["E"].subs({E_p: E_eq})
    yield evidence("limit", sp.simplify(one - E_eq) == 0, "a section of one material has its modulus")
    yield identical(found, _derive_2().forms)


def _effect_2() -> str:
    p = operating_point()
    listed = ", ".join(f"{name} = {figure(p[name], 5)} {unit}" for name, unit in _UNITS_2.items() if name in p)
    return f"{listed}; printed and derived agree."


_UNITS_2 = {
    "E": "Pa",
    "rho": "kg/m^3",
    "I_z": "m^4",
    "G": "Pa",
    "I_e": "m^4",
    "I_p": "m^4",
    "h": "m",
    "A_eq": "m^2",
    "A_p": "m^2",
    "A": "m^2",
}


ENTRIES = (
    Entry(
        id="1",
        section="2.1",
        title="Distance from the tooth surface to the neutral layer",
        place="Sect. 2.1",
        printed=_EQ1,
        units={"D": "m"},
        verdict="approximation",
        reason="Follows from zero axial force if E_eq is the modulus that an axial force meets; z counts from the "
        "tooth surface. But E_eq is made for bending: stretched, a metal of whose height the part 1 - k_t "
        "carries stress has (1 - k_t) E_e, and its middle lies below the teeth. See the section in layers.",
        judge=_judge_1,
        derive=_derive_1,
        effect=_effect_1,
    ),
    Entry(
        id="equivalent-beam",
        section="2.1",
        title="Equivalent beam for the toothed ring",
        place="below eq. (1)",
        printed=_BEAM,
        units={
            "rho_eq": "kg/m^3",
            "E_eq": "Pa",
            "G_eq": "Pa",
            "k_d": "1",
            "k_t": "1",
            "k_s": "1",
            "A_eq": "m^2",
            "A_p": "m^2",
            "A": "m^2",
        },
        verdict="approximation",
        reason="Density and shear area lose the grooves' volume. The modulus is scaled by the cube of the height that "
        "bends, which is exact for the metal alone but not about the composite's neutral axis. The text calls "
        "the beam's thickness k_e once, and Young's and the shear modulus both E_e: h_e and G_e are meant.",
        judge=_judge_beam,
        derive=_derive_beam,
        effect=_effect_beam,
    ),
    Entry(
        id="layered-section",
        section="2.1",
        title="Axis and bending stiffness of the section in layers",
        place="behind eqs. (1) and (2), not in the text",
        printed={},
        units={"D": "m", "EI": "N*m^2"},
        verdict="reconstructed",
        reason="What carries stress along the ring is the metal below the teeth and the ceramic, each with its own "
        "modulus; the axis of (1) and the stiffness of (2) approximate it.",
        judge=_judge_layers,
        derive=_derive_layers,
        effect=_effect_layers,
    ),
    Entry(
        id="2",
        section="2.1",
        title="Modulus, density, second moment and shear modulus of the section",
        place="Sect. 2.1",
        printed=_EQ2,
        units=_UNITS_2,
        verdict="verified",
        reason="Bending and shear stiffnesses and masses add; G takes equal shear in both layers.",
        judge=_judge_2,
        derive=_derive_2,
        effect=_effect_2,
    ),
)
