"""Section 4.1, Hertz's contact: eqs. (25), (26) and C_E."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import mpmath as mp
import sympy as sp

from derivations import line_contact
from derivations.ledger.judge import Point, agrees, error_size, figure, identical
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, Picture, evidence, step
from derivations.ledger.operating import at_point, operating_point, stator
from derivations.nomenclature import sym

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


# --- (25) ---------------------------------------------------------------------------------------------------
_EQ25: Forms = {"rho_k": 2 * r_t**2 / (n_j**2 * zeta_zmax)}


def _derive_25() -> Derivation:
    wave = zeta_zmax * sp.cos(k_c * x)
    diameter = line_contact.curvature_diameter(zeta_zmax, k_c)
    form = diameter.subs(k_c, n_j / r_t)
    return Derivation(
        (
            step("The crest has slope 0, so its curvature is the second derivative:", wave.diff(x, 2).subs(x, 0)),
            step(
                "The diameter of the cylinder that osculates it is twice the inverse of that:",
                sp.Eq(rho_k, diameter),
                zero=diameter * wave.diff(x, 2).subs(x, 0) + 2,
            ),
            step("n_j waves close on the circumference 2 pi r_t, so k_c = n_j/r_t:", sp.Eq(rho_k, form)),
        ),
        {"rho_k": form},
    )


def _judge_25(forms: Forms) -> Iterator[Evidence]:
    def osculating(_: str, point: Point) -> mp.mpf:
        """2 h / (1 - cos) of a far smaller circle through three points of the crest: chord^2/(4 sagitta), doubled."""
        k, height, step_x = point[n_j] / point[r_t], point[zeta_zmax], mp.mpf("1e-9")
        sagitta = 2 * height * mp.sin(k * step_x / 2) ** 2
        return (step_x**2 + sagitta**2) / sagitta

    yield agrees(
        forms,
        osculating,
        symbols=(n_j, r_t, zeta_zmax),
        ranges=RANGES,
        tolerance=1e-11,
        against="the circle through three neighbouring points of the crest",
    )
    yield identical(forms, _derive_25().forms)


def _effect_25() -> str:
    q = operating_point()
    value = at_point(_EQ25["rho_k"].subs(zeta_zmax, sp.Symbol("W")), q)
    pulses = value * (q["n_j"] / q["m"]) ** 2
    return (
        f"rho_k = {figure(value, 4)} m at the amplitude of one phase. The letter m is the number of crests; read as "
        f"the {figure(q['m'], 3)} pulses of Sect. 5 it would be {figure(pulses, 4)} m, with Table 1's R = 60 mm for "
        f"r_t {figure(4 * value, 4)} m. It has no bound as the crest's height beats towards 0."
    )


# --- C_E ----------------------------------------------------------------------------------------------------
_C_E: Forms = {"C_E": (1 - mu_e**2) / E_eq + (1 - mu_m**2) / E_m}


def _compliance(point: Mapping[sp.Symbol, mp.mpf]) -> mp.mpf:
    """From plane strain: strain along a uniaxial stress with the strain across the plane held at 0, body by body."""
    total = mp.mpf(0)
    for modulus, ratio in ((E_eq, mu_e), (E_m, mu_m)):
        E, nu = point[modulus], point[ratio]
        held = mp.lu_solve(mp.matrix([[1 / E, -nu / E], [-nu / E, 1 / E]]), mp.matrix([1, 0]))  # strains 1, 0
        total += 1 / held[0]
    return total


def _derive_c_e() -> Derivation:
    stress, across, strain, E, nu = sp.symbols("sigma sigma_y varepsilon E nu", positive=True)
    (hold,) = sp.solve((across - nu * stress) / E, across)
    plane = sp.factor((stress - nu * hold) / E)
    return Derivation(
        (
            step(
                "A contact long across the page deforms in plane strain. The stress that holds the strain across at 0:",
                sp.Eq(across, hold),
            ),
            step("leaves along the load:", sp.Eq(strain, plane), zero=plane - stress * (1 - nu**2) / E),
            step("Both surfaces yield, so their compliances add:", sp.Eq(C_E, _C_E["C_E"])),
        ),
        {"C_E": sum(plane.subs({stress: 1, E: e, nu: m}) for e, m in ((E_eq, mu_e), (E_m, mu_m)))},
    )


def _judge_c_e(forms: Forms) -> Iterator[Evidence]:
    yield agrees(
        forms,
        lambda _, point: _compliance(point),
        symbols=(E_eq, mu_e, E_m, mu_m),
        ranges=RANGES,
        against="the plane-strain compliance from Hooke's law solved as a linear system",
    )
    rigid = forms["C_E"].subs({E_eq: sp.oo, mu_m: 0})
    yield evidence("limit", rigid == 1 / E_m, "a rigid stator on a layer without Poisson's effect leaves 1/E_m")
    yield identical(forms, _derive_c_e().forms)


def _effect_c_e() -> str:
    q = dict(operating_point())
    value = at_point(_C_E["C_E"], q)
    solid = at_point(_C_E["C_E"].subs(E_eq, E_e), q)
    return (
        f"C_E = {figure(value, 4)} 1/Pa. E_eq is the bending modulus softened for the grooves; the teeth that touch "
        f"are solid metal, with whose E_e it is {figure(solid, 4)} 1/Pa and the contact of eq. 26 "
        f"{figure(100 * (mp.sqrt(solid / value) - 1), 2)} % longer. mu_m is the layer's, mu_e the stator's ratio."
    )


# --- (26) ---------------------------------------------------------------------------------------------------
_EQ26: Forms = {"2x_m": sp.Rational(8, 5) * sp.sqrt(F_c * rho_k * C_E / (n_j * b_m))}


def _derive_26() -> Derivation:
    width = line_contact.full_width()
    s, load = sp.Symbol("s", real=True), sp.Symbol("P", positive=True)
    form = width.subs(load, F_c / (n_j * b_m))
    return Derivation(
        (
            step(
                "Pressure p_0 sqrt(1 - s^2) on |s| < 1, s = x/a, bends the two half-planes to the slope "
                "-(2 C_E/pi) p_0 times the principal value"
            ),
            step("which is", line_contact.gap_slope_integral(), zero=line_contact.gap_slope_integral() - sp.pi * s),
            step(
                "It closes the gap x^2/rho_k if the slope is -2 x/rho_k; with the load P per width that fixes the "
                "width:",
                sp.Eq(sp.Symbol("2x_m"), width),
                zero=width**2 - 8 * load * rho_k * C_E / sp.pi,
            ),
            step(
                "Each of the n_j crests carries F_c/(n_j b_m) per width; the factor sqrt(8/pi) = 1.596 is rounded to "
                "1.6 in print:",
                sp.Eq(sp.Symbol("2x_m"), form),
            ),
        ),
        {"2x_m": form},
    )


def _closing_width(_: str, point: Point) -> mp.mpf:
    """The width at which the half-planes' displacements, by quadrature of log|x - s|, close the gap."""
    load = point[F_c] / (point[n_j] * point[b_m])

    def sunk(at: mp.mpf) -> mp.mpf:
        """Displacement relative to the centre, over (2 C_E/pi) p_0 a, at x/a = at."""
        return mp.quad(lambda s: mp.sqrt(1 - s**2) * mp.log(abs((at - s) / s)), [-1, 0, at, 1])

    with mp.workdps(15):
        squares = [
            4 * point[C_E] * load * point[rho_k] / mp.pi**2 * sunk(mp.mpf(at)) / mp.mpf(at) ** 2
            for at in ("0.5", "0.9")
        ]
    if abs(squares[0] - squares[1]) > 1e-9 * squares[0]:
        return mp.nan  # the pressure does not close the gap everywhere
    return 2 * mp.sqrt(squares[0])


def _judge_26(forms: Forms) -> Iterator[Evidence]:
    symbols = (F_c, rho_k, C_E, n_j, b_m)
    yield agrees(
        forms,
        _closing_width,
        symbols=symbols,
        ranges=RANGES,
        count=2,
        tolerance=5e-3,
        against="the width that closes the gap between two half-planes, by quadrature, to 0.5 %",
    )
    exact = _derive_26().forms["2x_m"]
    ratio = sp.simplify(forms["2x_m"] / exact)
    constant = not ratio.free_symbols
    yield evidence("identity", constant, "depends on every quantity as the derivation does; only the factor differs")
    if constant:
        off = float(ratio) - 1
        digits = round(1 / float(ratio) * 1.6, 3) / 1.6 * float(ratio) - 1  # 1.596 for 1.6
        yield error_size("2x_m", lambda: (off, abs(off)), "sqrt(8/pi) with two more digits", lambda: digits)


def _hertz_half_length() -> mp.mpf:
    q = dict(operating_point())
    q["C_E"] = at_point(_C_E["C_E"], q)
    q["rho_k"] = at_point(_EQ25["rho_k"].subs(zeta_zmax, sp.Symbol("W")), q)
    return at_point(_EQ26["2x_m"], q) / 2


def _effect_26() -> str:
    q, half = operating_point(), _hertz_half_length()
    hertz, winkler = q["k_c"] * half, q["theta"]
    return (
        f"1.6 for sqrt(8/pi) = {figure(mp.sqrt(8 / mp.pi), 5)}: {figure(100 * (1.6 / mp.sqrt(8 / mp.pi) - 1), 3)} % "
        f"too long. x_m = {figure(1000 * half, 4)} mm, {figure(half / q['h_m'], 3)} times the layer's thickness of "
        f"{figure(1000 * q['h_m'], 2)} mm: the layer is no half-plane. As a thin layer it gives a half-angle of "
        f"{figure(winkler, 4)} rad, eq. 26 one of {figure(hertz, 4)} rad."
    )


def _picture_26() -> Picture:
    """Contact half-angle over the prepressure: Hertz's half-planes against the thin layer."""
    forces = list(range(100, 221, 10))
    hertz, layer = [], []
    for force in forces:
        q = dict(stator(force))
        q["C_E"] = at_point(_C_E["C_E"], q)
        q["rho_k"] = at_point(_EQ25["rho_k"].subs(zeta_zmax, sp.Symbol("W")), q)
        hertz.append(float(q["k_c"] * at_point(_EQ26["2x_m"], q) / 2))
        layer.append(float(q["theta"]))
    axis = [float(force) for force in forces]
    curves = {"printed: Hertz's half-planes": (axis, hertz), "the layer as thin as it is": (axis, layer)}
    return Picture("Half-angle of the contact", "prepressure in N", "k_c x_m in rad", curves)


_PLACE = "Sect. 4.1"
ENTRIES = (
    Entry(
        id="25",
        section="4.1",
        title="Equivalent curvature diameter of the crest",
        place=_PLACE,
        printed=_EQ25,
        units={"rho_k": "m"},
        verdict="verified",
        judge=_judge_25,
        derive=_derive_25,
        effect=_effect_25,
        reason="Twice the crest's radius of curvature, with m the number of crests and r_t the radius on which k_c = "
        "m/r_t.",
    ),
    Entry(
        id="C_E",
        section="4.1",
        title="Contact compliance",
        place="below eq. 26",
        printed=_C_E,
        units={"C_E": "1/Pa"},
        verdict="verified",
        judge=_judge_c_e,
        derive=_derive_c_e,
        effect=_effect_c_e,
        reason="The joint plane-strain compliance of two half-planes, one of which has the modulus E_eq.",
    ),
    Entry(
        id="26",
        section="4.1",
        title="Length of the contact",
        place=_PLACE,
        printed=_EQ26,
        units={"2x_m": "m"},
        verdict="approximation",
        judge=_judge_26,
        derive=_derive_26,
        effect=_effect_26,
        picture=_picture_26,
        reason="Hertz's line contact with sqrt(8/pi) rounded to 1.6; its premise, bodies far thicker than the contact "
        "is long, does not hold for the layer.",
    ),
)
