"""Table 1, the motor's parameters: labels, units, and what the figures say about each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import beam, section
from derivations.ledger.judge import figure, largest, usual
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from trum_sym.inputs.units import Dimension, parse_unit

__all__ = ["ENTRIES", "UNITS", "resonance_with", "unit"]

_SYMBOLS = {"m": "m", "kg": "kg", "s": "s", "V": "V", "Pa": "Pa", "arcsec": "arcsec", "rad": "rad", "N": "N"}
_AS = {text: sp.Symbol(rf"\mathrm{{{name}}}", positive=True) for text, name in _SYMBOLS.items()}
UNITS: dict[sp.Basic, Dimension] = {symbol: parse_unit(text).dimension for text, symbol in _AS.items()}
_MEASURED_HZ = 39703.0  # Sect. 7.3


def unit(text: str) -> sp.Symbol:
    """The SI unit (or arcsec) as a symbol that carries its dimension."""
    return _AS[text]


def _figure_of(form: sp.Expr) -> float:
    """The number of a form in SI units."""
    return float(sp.sympify(form).subs(dict.fromkeys(UNITS, 1)))


def resonance_with(changed: Mapping[str, float]) -> complex:
    """The resonance in Hz, full quartic, with some of Table 1 changed and the foundation of Table 3's point."""
    v = {**operating_point(), **{name: mp.mpf(value) for name, value in changed.items()}}
    v["D"] = at_point(section.neutral_axis(), v)
    v.update({name: at_point(expr, v) for name, expr in section.section().items()})
    return complex(at_point(beam.resonance()["quartic"], v) / (2 * mp.pi))


# --- R ------------------------------------------------------------------------------------------------------
_R: Forms = {"R": sp.Rational(60, 1000) * unit("m")}


def _derive_r() -> Derivation:
    p = usual()
    radius = sp.Rational(30, 1000)
    gap = sp.Abs(2 * sp.pi * radius - sp.nsimplify(p["l_s"], rational=True))
    return Derivation(
        (
            step(
                "The perimeter l_s = 188.4 mm of the same table is the circumference, to its rounding:",
                sp.Eq(sp.Symbol("l_s"), 2 * sp.pi * sp.Symbol("R")),
                zero=sp.floor(gap * 10**4),
            ),
            step("so the 60 mm are the diameter, as the motor's name says:", sp.Eq(sp.Symbol("R"), radius * unit("m"))),
        ),
        {"R": radius * unit("m")},
    )


def _judge_r(forms: Forms) -> Iterator[Evidence]:
    p, radius = usual(), _figure_of(forms["R"])
    around = 2 * np.pi * radius
    yield evidence(
        "numeric",
        abs(around - p["l_s"]) < 1.5e-4,
        f"2 pi R = {1000 * around:.1f} mm, the table's l_s is {1000 * p['l_s']:.1f} mm (pi taken as 3.14)",
    )
    turns = p["n_j"] / radius * p["l_s"] / p["n_j"]  # k_c lambda, with nine waves on the perimeter
    yield evidence(
        "identity", abs(turns - 2 * np.pi) < 0.005, f"k_c = n_j/R times the wavelength is {turns:.4f}, 2 pi is needed"
    )


def _effect_r() -> str:
    p = usual()
    half = {"k_c": p["n_j"] / 0.06}
    return (
        f"With R = 60 mm k_c halves to {figure(half['k_c'])} 1/m and the modelled resonance falls to "
        f"{figure(resonance_with(half).real / 1000)} kHz; with 30 mm it is {figure(resonance_with({}).real / 1000)} "
        "kHz, 39.703 kHz were measured. lambda = pi R/9 below eq. 7 needs the 60 mm, k_c = n_j/R below eq. 4 the 30 "
        "mm."
    )


# --- heights ------------------------------------------------------------------------------------------------
_HEIGHTS: Forms = {"h_tooth": sp.Rational(45, 10**4) * unit("m"), "h_beam": sp.Rational(2, 1000) * unit("m")}


def _derive_heights() -> Derivation:
    k_t = sp.Symbol("k_t")
    return Derivation(
        (
            step("Eq. 2's modulus (1 - k_t)^3 E_e, k_t = h_t/h_e, needs teeth lower than the whole beam:", k_t < 1),
            step(
                "With the text's h_t for the teeth and h_e for the beam:",
                sp.Eq(k_t, sp.Rational(20, 45)),
                zero=sp.Rational(2, 1) / sp.Rational(45, 10) - sp.Rational(4, 9),
            ),
        ),
        {"h_tooth": _HEIGHTS["h_beam"], "h_beam": _HEIGHTS["h_tooth"]},
    )


def _judge_heights(forms: Forms) -> Iterator[Evidence]:
    tooth, whole = (_figure_of(forms[key]) for key in ("h_tooth", "h_beam"))
    factor = (1 - tooth / whole) ** 3
    yield evidence("domain", factor > 0, f"E_eq/E_e = (1 - h_t/h_e)^3 = {factor:.3f}, which must be positive")
    found = resonance_with({"h_t": tooth, "h_e": whole})
    off = abs(found / _MEASURED_HZ - 1)
    yield evidence("numeric", off < 0.05, f"the modelled resonance is {100 * off:.1f} % from the measured 39.703 kHz")


def _effect_heights() -> str:
    swapped = resonance_with({"h_t": 0.0045, "h_e": 0.002})
    modulus = figure((1 - 4.5 / 2) ** 3 * 155, 3)
    imaginary = abs(swapped.real) < 1
    size = figure((swapped.imag if imaginary else swapped.real) / 1000, spec=".1f")
    return (
        f"As described, h_t for the beam and h_e for the teeth, E_eq = {modulus} GPa and the resonance of Table 3's "
        f"point {size}{' i' if imaginary else ''} kHz; the other way round {figure(resonance_with({}).real / 1000)} "
        "kHz."
    )


# --- isotropy -----------------------------------------------------------------------------------------------
_SHEAR: Forms = {"G_e": sp.Integer(46800000000) * unit("Pa"), "G_p": sp.Integer(22900000000) * unit("Pa")}
_PAIRS = {"G_e": ("E_e", "mu_e"), "G_p": ("E_p", "mu_p")}


def _shear(key: str) -> sp.Rational:
    modulus, ratio = (sp.nsimplify(usual()[symbol], rational=True) for symbol in _PAIRS[key])
    return sp.Rational(modulus / (2 * (1 + ratio)))


def _derive_shear() -> Derivation:
    E, G, nu, tau = sp.symbols("E G mu tau", positive=True)
    # pure shear tau is a pull tau at 45 degrees and a push tau across it
    stretch = (tau + nu * tau) / E
    return Derivation(
        (
            step(
                "Pure shear is a pull and an equal push across it at 45 degrees; its angle is twice their strain:",
                sp.Eq(tau / G, 2 * stretch),
                zero=tau / (E / (2 * (1 + nu))) - 2 * stretch,
            ),
            step("so in an isotropic body G = E/(2 (1 + mu)):", *(sp.Symbol(key) for key in _SHEAR)),
        ),
        {key: _shear(key) * unit("Pa") for key in _SHEAR},
    )


def _judge_shear(forms: Forms) -> Iterator[Evidence]:
    off, ratios = {}, {}
    for key, form in forms.items():
        modulus, ratio = (usual()[symbol] for symbol in _PAIRS[key])
        # energy of pure shear against that of its two principal stresses, per volume, at unit stress
        principal = (1 + ratio) / modulus
        off[key] = 1 / (2 * _figure_of(form)) / principal - 1
        ratios[key] = modulus / (2 * _figure_of(form)) - 1
    yield evidence(
        "numeric",
        largest(abs(o) for o in off.values()) < 1e-12,
        "energy of pure shear is that of its principal stresses: off by "
        + ", ".join(f"{key} {100 * o:+.1f} %" for key, o in off.items()),
    )
    yield evidence(
        "domain",
        all(-1 < nu < 0.5 for nu in ratios.values()),
        "Poisson's ratio E/(2 G) - 1 lies between -1 and 0.5: "
        + ", ".join(f"{key} {nu:.3f}" for key, nu in ratios.items()),
    )


def _effect_shear() -> str:
    right = {key: float(_shear(key)) for key in _SHEAR}
    before, after = resonance_with({}).real, resonance_with(right).real
    listed = ", ".join(
        f"{key} {_figure_of(_SHEAR[key]) / 1e9:.1f} instead of {figure(right[key] / 1e9, spec='.1f')} GPa"
        for key in right
    )
    return (
        f"{listed}. Which of E, G, mu is wrong the table does not say; with G from E and mu the modelled resonance "
        f"rises by {figure(after - before, spec='+.0f')} Hz "
        f"({figure(100 * (after / before - 1), spec='+.2f')} %). Poled ceramic is not "
        f"isotropic; metal is."
    )


# --- units of the densities ---------------------------------------------------------------------------------
_DENSITY: Forms = {
    f"rho_{part}": sp.Integer(value) * unit("kg") * unit("m") ** 3
    for part, value in (("e", 8900), ("p", 7500), ("m", 2100))
}


def _derive_density() -> Derivation:
    forms = {key: form / unit("m") ** 6 for key, form in _DENSITY.items()}
    text = "A density is mass over volume; the table prints mass times volume:"
    return Derivation((step(text, *forms.values()),), forms)


def _judge_density(forms: Forms) -> Iterator[Evidence]:
    found = {key: _figure_of(form) for key, form in forms.items()}
    hertz = resonance_with({key: found[key] for key in ("rho_e", "rho_p")}).real
    yield evidence(
        "numeric",
        abs(hertz / _MEASURED_HZ - 1) < 0.05,
        f"with these figures in kg/m^3 the modelled resonance is {hertz / 1000:.2f} kHz, 39.703 kHz was measured",
    )
    yield evidence(
        "data",
        found == {"rho_e": 8900.0, "rho_p": 7500.0, "rho_m": 2100.0}
        and all(1000 < value < 2.2e4 for value in found.values()),
        "the figures that the motor file takes from the table, between water and osmium",
    )


def _effect_density() -> str:
    return "A sign lost in the unit: kg m^3 for kg/m^3. No effect on the figures."


# --- J ------------------------------------------------------------------------------------------------------
_J: Forms = {"J": sp.Rational(45, 10**7)}


def _derive_j() -> Derivation:
    form = _J["J"] * unit("kg") * unit("m") ** 2
    return Derivation((step("A moment of inertia is mass times length squared (eq. 38):", form),), {"J": form})


def _judge_j(forms: Forms) -> Iterator[Evidence]:
    p, value = usual(), _figure_of(forms["J"])
    radius = p["r_c"]
    layer = p["rho_m"] * p["b_m"] * p["h_m"] * 2 * np.pi * radius * radius**2
    disk = np.pi * p["R"] ** 4 / 2 * p["rho_e"] * (p["h_e"] + p["h_p"])
    yield evidence(
        "limit",
        layer < value < disk,
        f"between the layer's own {layer:.1e} and a solid metal disk's {disk:.1e} kg m^2, as thick as the stator",
    )
    yield evidence("data", value == p["J"], "the figure that the motor file takes from the table")


def _effect_j() -> str:
    p = usual()
    torque = p["mu"] * operating_point()["F_c"] * p["r_c"]
    return (
        f"In kg m^2 it is a ring of {figure(1e3 * p['J'] / p['r_c'] ** 2, spec='.1f')} g on the contact radius; mu "
        "F_c r_c "
        f"accelerates it by {figure(float(torque) / p['J'], 3)} rad/s^2. In g cm^2, the other usual unit, it would be "
        "lighter than the layer."
    )


# --- kappa --------------------------------------------------------------------------------------------------
_KAPPA: Forms = {"b_over_h": sp.Rational(9, 10)}


def _derive_kappa() -> Derivation:
    p, form = usual(), sp.Rational(50, 80)  # (h_e + h_p)/b_e in tenths of a millimetre
    return Derivation(
        (
            step(
                "Height of the composite beam over its width, from the same table:",
                form,
                zero=sp.nsimplify((p["h_e"] + p["h_p"]) / p["b_e"], rational=True, tolerance=1e-9) - form,
            ),
        ),
        {"b_over_h": form},
    )


def _judge_kappa(forms: Forms) -> Iterator[Evidence]:
    p, value = usual(), _figure_of(forms["b_over_h"])
    heights = {"with ceramic": p["h_e"] + p["h_p"], "of the metal": p["h_e"], "without teeth": p["h_e"] - p["h_t"]}
    found = {label: height / p["b_e"] for label, height in heights.items()}
    near = min(abs(value - ratio) for ratio in found.values())
    listed = ", ".join(f"{ratio:.3f} {label}" for label, ratio in found.items())
    yield evidence("numeric", near < 0.005, f"a height over the width: {listed}; given is {value:.3f}")
    yield evidence("limit", 0 < value < max(found.values()) + 0.005, "no more than the highest section's ratio")


def _effect_kappa() -> str:
    nu = usual()["mu_e"]
    cowper = 10 * (1 + nu) / (12 + 11 * nu)
    before, after = resonance_with({}).real, resonance_with({"kappa": cowper}).real
    return (
        "kappa stands in two rows with 0.9: as 'height-width ratio', which enters no equation, and as shear "
        f"correction. For a solid rectangle Cowper's coefficient would be {figure(cowper, spec='.3f')}: the "
        "resonance changes by "
        f"{figure(after - before, spec='+.0f')} Hz."
    )


# --- U_s ----------------------------------------------------------------------------------------------------
_U_S: Forms = {"U_s": sp.Integer(400) * unit("V")}


def _derive_voltage() -> Derivation:
    angle = sp.Symbol("alpha", real=True)
    amplitude = sp.Symbol("U", positive=True)
    wave = amplitude * sp.sin(angle)
    swing = wave.subs(angle, sp.pi / 2) - wave.subs(angle, -sp.pi / 2)
    return Derivation(
        (
            step(
                "Peak to peak a sine swings by twice its amplitude:",
                sp.Eq(sp.Symbol("U_pp"), swing),
                zero=swing - 2 * amplitude,
            ),
            step("Sect. 7.1 says 400 V peak to peak, eq. 7 takes the amplitude:", sp.Integer(200) * unit("V")),
        ),
        {"U_s": sp.Integer(200) * unit("V")},
    )


def _judge_voltage(forms: Forms) -> Iterator[Evidence]:
    amplitude = _figure_of(forms["U_s"])
    wave = amplitude * np.sin(np.linspace(0, 2 * np.pi, 10001))
    swing = float(wave.max() - wave.min())
    yield evidence(
        "numeric",
        abs(swing - 400) < 1e-3,
        f"as the amplitude of eq. 7 it swings by {swing:.0f} V; Sects. 7.1 and 7.2 drive with 400 V peak to peak",
    )
    yield evidence("data", amplitude in (200.0, 400.0), "400 V or half of it")


def _effect_voltage() -> str:
    more = figure(100 * (_figure_of(_U_S["U_s"]) / 200 - 1), spec="+.0f")
    return f"W_max of eq. 7 is proportional to U_s: 400 V instead of 200 V makes it twice as large ({more} %)."


def _entry(name: str, **fields: Any) -> Entry:  # noqa: ANN401
    return Entry(id=f"table-1-{name}", section="5.1", place="Table 1", known=UNITS, **fields)


ENTRIES = (
    _entry(
        "R",
        title="Stator radius",
        printed=_R,
        units={"R": "m"},
        verdict="erratum",
        judge=_judge_r,
        derive=_derive_r,
        effect=_effect_r,
        repair=lambda forms: {"R": forms["R"] / 2},
        found_by=("numeric", "identity"),
        reason="The 60 mm are the diameter: the perimeter is pi times 60 mm.",
    ),
    _entry(
        "heights",
        title="Heights of teeth and beam",
        printed=_HEIGHTS,
        units={"h_tooth": "m", "h_beam": "m"},
        verdict="erratum",
        judge=_judge_heights,
        derive=_derive_heights,
        effect=_effect_heights,
        repair=lambda forms: {"h_tooth": forms["h_beam"], "h_beam": forms["h_tooth"]},
        found_by=("domain", "numeric"),
        reason="The descriptions of h_t and h_e are swapped: h_t = 2 mm is the tooth height, h_e = 4.5 mm the beam's.",
    ),
    _entry(
        "isotropy",
        title="E, G and mu of one material",
        printed=_SHEAR,
        units={"G_e": "Pa", "G_p": "Pa"},
        verdict="erratum",
        judge=_judge_shear,
        derive=_derive_shear,
        effect=_effect_shear,
        repair=lambda forms: {key: form * _shear(key) / usual()[key] for key, form in forms.items()},
        found_by=("numeric", "domain"),
        reason="E = 2 G (1 + mu) fails by a fifth for both materials; E and G would need a Poisson's ratio above 0.5.",
    ),
    _entry(
        "densities",
        title="Unit of the densities",
        printed=_DENSITY,
        units=dict.fromkeys(_DENSITY, "kg/m^3"),
        verdict="erratum",
        judge=_judge_density,
        derive=_derive_density,
        effect=_effect_density,
        repair=lambda forms: {key: form.subs(unit("m"), 1 / unit("m")) for key, form in forms.items()},
        found_by=("dimension",),
        reason="Printed in kg m^3; kg/m^3 is meant.",
    ),
    _entry(
        "J",
        title="Unit of the rotor's inertia",
        printed=_J,
        units={"J": "kg*m^2"},
        verdict="erratum",
        judge=_judge_j,
        derive=_derive_j,
        effect=_effect_j,
        repair=lambda forms: {"J": forms["J"] * unit("kg") * unit("m") ** 2},
        found_by=("dimension",),
        reason="Printed without a unit; in kg m^2 the figure is that of a light rotor.",
    ),
    _entry(
        "kappa",
        title="Height-width ratio",
        printed=_KAPPA,
        units={"b_over_h": "1"},
        verdict="erratum",
        judge=_judge_kappa,
        derive=_derive_kappa,
        effect=_effect_kappa,
        repair=lambda _: _derive_kappa().forms,
        found_by=("numeric", "limit"),
        reason="The row repeats symbol and figure of the shear correction; no height of the section over its "
        "width is 0.9.",
    ),
    _entry(
        "U_s",
        title="Voltage",
        printed=_U_S,
        units={"U_s": "V"},
        verdict="erratum",
        judge=_judge_voltage,
        derive=_derive_voltage,
        effect=_effect_voltage,
        repair=lambda forms: {"U_s": forms["U_s"] / 2},
        found_by=("numeric",),
        reason="400 V is peak to peak (Sect. 7.1); eq. 7 takes the amplitude.",
    ),
)
