"""Section 2.3, amplitude: eqs. (7) and (8)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import mpmath as mp
import numpy as np
import sympy as sp
from scipy import stats

from derivations import amplitude
from derivations.ledger.judge import Point, agrees, evaluate, figure, identical, largest, points, vanishes, worse
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.ledger.section_2_composite import resolved
from derivations.nomenclature import sym

__all__ = ["ENTRIES", "TABLE_2", "power_law", "refitted"]

M_1, A_zm, lam, W_max, W_maxf = sym("M_1 A_zm lambda W_max W_maxf")
A_p, rho_p, D, b_p, d_31, s_11E, U_s, R = sym("A_p rho_p D b_p d_31 s_11E U_s R")
omega_q, omega_n, xi, k_c, beta, rho, A, I_z = sym("omega_q omega_n xi k_c beta rho A I_z")
h_e, h_p, C_f, F_c, N_1, varsigma, n_j, x = sym("h_e h_p C_f F_c N_1 varsigma n_j x")
_z = sym("z")[0]
RESONATOR = 1 / sp.sqrt((1 - omega_q**2 / omega_n**2) ** 2 + (2 * xi * omega_q / omega_n) ** 2)

# --- (7) ----------------------------------------------------------------------------------------------------
_EQ7: Forms = {
    "W_max": lam * A_zm / (2 * M_1 * omega_n**2) * RESONATOR,
    "M_1": A_p * rho_p * lam / 2,
    "A_zm": D * b_p * d_31 / (2 * s_11E) * 4 * U_s / sp.pi * (2 * sp.pi / lam) ** 2,
    "lambda": sp.pi * R / 9,
}


def _repair_7(forms: Forms) -> Forms:
    """Whole modal mass, true lever arm, curvature of the rotation, magnitude of d31, circumference 2 pi R."""
    lever = (h_e + h_p / 2 - D) / (D / 2)
    return {
        "W_max": forms["W_max"],
        "M_1": forms["M_1"] / (A_p * rho_p) * (rho * A + rho * I_z * beta**2),
        "A_zm": forms["A_zm"].subs(d_31, sp.Abs(d_31)) * lever * beta / (2 * sp.pi / lam),
        "lambda": forms["lambda"] * 2,
    }


def _corrected_7() -> Forms:
    modal_mass = (rho * A + rho * I_z * beta**2) * lam / 2
    force = sp.simplify(amplitude.forced() / RESONATOR * omega_n**2 * (rho * A + rho * I_z * beta**2)).subs(
        k_c, 2 * sp.pi / lam
    )
    return {"W_max": _EQ7["W_max"], "M_1": modal_mass, "A_zm": sp.factor(force), "lambda": 2 * sp.pi * R / 9}


def _derive_7() -> Derivation:
    moment = amplitude.piezo_moment()
    stress = sp.Abs(d_31) / s_11E * U_s / h_p
    arm = sp.Integral(_z, (_z, h_e - D, h_e + h_p - D))
    forms = _corrected_7()
    half = sp.Integral(beta * k_c * sp.cos(k_c * x), (x, -sp.pi / (2 * k_c), sp.pi / (2 * k_c)))
    mass = sp.Integral(
        rho * A * sp.cos(k_c * x) ** 2 + rho * I_z * beta**2 * sp.sin(k_c * x) ** 2, (x, 0, 2 * sp.pi / k_c)
    )
    total = forms["M_1"].subs(lam, 2 * sp.pi / k_c)
    put = resolved(forms)["W_max"].subs(R, 9 / k_c)
    return Derivation(
        (
            step("Held at rest, a poled ceramic under the voltage U_s carries the stress", stress),
            step(
                "Its moment about the neutral axis: the arm reaches to the middle of the ceramic, h_e + h_p/2 - D, "
                "not D/2:",
                stress * b_p * arm,
                zero=stress * b_p * arm.doit() - moment,
            ),
            step(
                "Segments half a wavelength long are poled in turn. On the mode w = W cos(k_c x), theta = -beta W "
                "sin(k_c x), the moment of one of them does the work, per W and unit moment,",
                half,
                zero=half.doit() - 2 * beta,
            ),
            step(
                "The modal mass of one wavelength, of the whole section with its rotary inertia:",
                sp.Eq(M_1, mass),
                zero=mass.doit() - total,
            ),
            step(
                "A phase on the share c of the ring, in segments of half a wave, does c of the whole ring's work, "
                "but the mode swings all round it: its amplitude is c times the whole ring's. (7) has c = 1, one "
                "phase all "
                "round; two phases that drive two modes of one ring have c = 1/2 each at most.",
                sp.Symbol("c") * half,
                zero=sp.Symbol("c") * half.doit() - 2 * beta * sp.Symbol("c"),
            ),
            step(
                "Modal force over modal mass times the resonator's magnification:",
                sp.Eq(W_max, forms["W_max"]),
                zero=put - amplitude.forced(),
            ),
        ),
        forms,
    )


@cache
def _modal_responses() -> list[tuple[Point, mp.mpf]]:
    """Random points, and the amplitude of a wavelength's mode there."""
    names = "D b_p h_e h_p d_31 s_11E U_s rho A I_z beta omega_n omega_q xi R rho_p"
    drawn = points(sym(names), 4, seed="eq7", ranges={"A": (3e-5, 5e-5)})
    return [(point, _modal_response({s.name: number for s, number in point.items()})) for point in drawn]


def _modal_response(v: dict[str, mp.mpf]) -> mp.mpf:
    """Amplitude of a wavelength's mode under the ceramic's moment, force and mass by quadrature."""
    k = mp.mpf(9) / v["R"]
    wave = 2 * mp.pi / k
    stress = abs(v["d_31"]) / v["s_11E"] * v["U_s"] / v["h_p"]
    low = v["h_e"] - v["D"]
    moment = stress * v["b_p"] * mp.quad(lambda u: u, [low, low + v["h_p"]])
    force = mp.quad(
        lambda u: moment * mp.sign(mp.cos(k * u)) * v["beta"] * k * mp.cos(k * u), [-wave / 4, wave / 4, 3 * wave / 4]
    )
    mass = mp.quad(
        lambda u: v["rho"] * (v["A"] * mp.cos(k * u) ** 2 + v["I_z"] * (v["beta"] * mp.sin(k * u)) ** 2),
        [0, wave / 4, wave / 2, 3 * wave / 4, wave],
    )
    # the steady state of mass (q'' + 2 xi omega_n q' + omega_n^2 q) = force cos(omega_q t), as one complex number
    n, q = v["omega_n"], v["omega_q"]
    return abs(force / mass / mp.mpc(n**2 - q**2, 2 * v["xi"] * n * q))


def _judge_7(forms: Forms) -> Iterator[Evidence]:
    form = resolved(forms)["W_max"]
    wide, thick = sym("b_p h_p")
    worst = mp.mpf(0)
    for point, response in _modal_responses():
        found = evaluate(form, {**point, A_p: point[wide] * point[thick]})
        worst = worse(worst, abs(found / response - 1))
    detail = f"off the modal balance by quadrature by {mp.nstr(worst, 3)} relative at most"
    yield evidence("numeric", worst < mp.mpf(10) ** -20, detail)
    static = form.subs(omega_q, 0) * omega_n**2
    resonant = form.subs(omega_q, omega_n) * omega_n**2
    yield evidence("limit", vanishes(sp.simplify(resonant / static - 1 / (2 * xi))), "resonance magnifies by 1/(2 xi)")
    yield identical({"W_max": sp.simplify(form.subs(R, 9 / k_c) / amplitude.forced())}, {"W_max": sp.Integer(1)})


def _effect_7() -> str:
    q = dict(operating_point())
    q["A_p"] = q["b_p"] * q["h_p"]
    printed = resolved(_EQ7)["W_max"]
    on = dict(q, omega_q=q["omega_n"])
    micro = {
        "printed": at_point(printed.subs(R, 2 * R), q),
        "right": at_point(amplitude.forced(), q),
        "printed, resonance": at_point(printed.subs(R, 2 * R), on),
        "right, resonance": at_point(amplitude.forced(), on),
    }
    micro = {name: abs(value) * 10**6 for name, value in micro.items()}
    arm = (q["h_e"] + q["h_p"] / 2 - q["D"]) / (q["D"] / 2)
    mass = (q["rho"] * q["A"] + q["rho"] * q["I_z"] * q["beta"] ** 2) / (q["A_p"] * q["rho_p"])
    return (
        f"At the drive frequency printed {figure(micro['printed'], 4)} um, derived {figure(micro['right'], 4)} um; "
        f"at resonance printed {figure(micro['printed, resonance'], 4)} um, derived "
        f"{figure(micro['right, resonance'], 4)} um; measured 12.6 um. The whole modal mass is {figure(mass, 4)} "
        f"times the ceramic's, the lever arm {figure(arm, 4)} times D/2. With two phases, each on half of the ring, "
        "the "
        f"derived amplitudes halve: {figure(micro['right'] / 2, 3)} um at the drive frequency, "
        f"{figure(micro['right, resonance'] / 2, 3)} um at resonance, "
        f"{figure(100 * (micro['right, resonance'] / 2 / mp.mpf('12.6') - 1), 3)} % off the measured 12.6 um instead "
        "of "
        f"{figure(100 * (micro['right, resonance'] / mp.mpf('12.6') - 1), 3)} %. The computations keep (7)'s one "
        "phase all "
        "round: the text does not say how the electrodes run. d31 is negative: as printed W_max would be negative."
    )


def _size_7() -> tuple[str, float]:
    """Off the derived amplitude with Table 1's R, 60 mm, as the paper puts it in."""
    q = dict(operating_point())
    q["A_p"] = q["b_p"] * q["h_p"]
    printed, right = at_point(resolved(_EQ7)["W_max"].subs(R, 2 * R), q), at_point(amplitude.forced(), q)
    return "W_max", float(abs(printed) / abs(right) - 1)


# --- (8) ----------------------------------------------------------------------------------------------------
TABLE_2 = {100: 8.3, 120: 7.3, 140: 6.6, 160: 6.0, 180: 5.5, 200: 5.2, 220: 4.8}  # prepressure N: amplitude um
_EQ8: Forms = {"W_maxf": C_f * (F_c / N_1) ** (-varsigma) * W_max}


def power_law() -> dict[str, float]:
    """Fit of Table 2 to eq. (8) in logarithms: C_f and varsigma with the half-widths of their 95 % intervals."""
    force = np.log(np.array(list(TABLE_2), dtype=float))
    ratio = np.log(np.array(list(TABLE_2.values())) / 12.6)
    line = stats.linregress(force, ratio)
    quantile = float(stats.t.ppf(0.975, len(TABLE_2) - 2))
    factor = float(np.exp(line.intercept))
    return {
        "varsigma": -float(line.slope),
        "varsigma_width": quantile * float(line.stderr),
        "C_f": factor,
        "C_f_low": float(np.exp(line.intercept - quantile * line.intercept_stderr)),
        "C_f_high": float(np.exp(line.intercept + quantile * line.intercept_stderr)),
        "worst": float(np.abs(np.exp(ratio - line.intercept - line.slope * force) - 1).max()),
    }


def refitted(fit: dict[str, float]) -> bool:
    """Whether another routine, a polynomial in Chebyshev's basis, fits the same law to Table 2."""
    logs = np.log(np.array(list(TABLE_2), dtype=float))
    ratios = np.log(np.array(list(TABLE_2.values())) / 12.6)
    line = np.polynomial.Chebyshev.fit(logs, ratios, 1).convert(kind=np.polynomial.Polynomial)
    return bool(np.allclose(line.coef, [np.log(fit["C_f"]), -fit["varsigma"]], rtol=1e-9, atol=0))


def _derive_8() -> Derivation:
    logarithm = sp.log(W_maxf / W_max)
    straight = sp.log(C_f) - varsigma * sp.log(F_c / N_1)
    return Derivation(
        (
            step("No mechanism is given: a power law is assumed, with F_c as a number of newtons."),
            step(
                "In logarithms it is a straight line, whose slope and intercept are fitted to the seven points of "
                "Table 2 by least squares:",
                sp.Eq(logarithm, straight),
                zero=sp.expand_log(sp.log(amplitude.under_prepressure(W_max) / W_max), force=True)
                - sp.expand_log(straight, force=True),
            ),
        ),
        {"W_maxf": amplitude.under_prepressure(W_max)},
    )


def _judge_8(forms: Forms) -> Iterator[Evidence]:
    form = forms["W_maxf"]
    yield agrees(forms, {"W_maxf": amplitude.under_prepressure(W_max)})
    slope = sp.simplify(form.diff(F_c) * F_c / form + varsigma)
    unit = sp.simplify(form.subs(F_c, N_1) - C_f * W_max)
    yield evidence("limit", slope == 0 and unit == 0, "logarithmic slope -varsigma; C_f W_max at one newton")
    q = operating_point()
    stated = [abs(float(at_point(form, {**q, "F_c": mp.mpf(f)})) * 1e6 / w - 1) for f, w in TABLE_2.items()]
    fit = power_law()
    within = (
        refitted(fit)
        and abs(fit["varsigma"] - float(q["varsigma"])) <= fit["varsigma_width"]
        and fit["C_f_low"] <= float(q["C_f"]) <= fit["C_f_high"]
        and largest(stated) < 0.02
    )
    yield evidence(
        "data",
        within,
        f"Table 2 gives varsigma = {fit['varsigma']:.4f} +- {fit['varsigma_width']:.4f} and C_f = {fit['C_f']:.3f} "
        f"({fit['C_f_low']:.3f} to {fit['C_f_high']:.3f}) at 95 %, largest residual {100 * fit['worst']:.2f} %; the "
        f"stated 0.678 and 14.926 lie within and miss the points by {100 * max(stated):.2f} % at most",
    )


def _effect_8() -> str:
    q = operating_point()
    equal = q["C_f"] ** (1 / q["varsigma"])
    return (
        f"At 180 N {figure(q['W'] * 10**6, 4)} um, measured 5.5 um. It holds for 100 to 220 N only: below "
        f"{figure(equal, 4)} N it exceeds the free amplitude, and it has no limit for F_c -> 0."
    )


ENTRIES = (
    Entry(
        id="7",
        section="2.3",
        title="Amplitude forced by the ceramic",
        place="Sect. 2.3",
        printed=_EQ7,
        units={"W_max": "m", "M_1": "kg", "A_zm": "N/m", "lambda": "m"},
        verdict="erratum",
        reason="The dimensions agree, but the modal mass is the ceramic's alone (A_p rho_p), the lever arm D/2 is not "
        "the ceramic's, the section's rotation is taken as the slope, d31's sign is kept in an amplitude, and "
        "lambda = pi R/9 needs the diameter where k_c = n_j/R needs the radius.",
        judge=_judge_7,
        derive=_derive_7,
        effect=_effect_7,
        repair=_repair_7,
        size=_size_7,
        found_by=("numeric", "identity"),
    ),
    Entry(
        id="8",
        section="2.3",
        title="Amplitude under prepressure",
        place="Sect. 2.3, constants in Sect. 7.1",
        printed=_EQ8,
        units={"W_maxf": "m"},
        verdict="empirical",
        reason="A fitted power law; F_c counts newtons, since the base of a fitted power must be a number.",
        judge=_judge_8,
        derive=_derive_8,
        effect=_effect_8,
    ),
)
