"""Proofs of the stator's kernels: section, resonance, amplitude, the layer's stiffness (Sect. 2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import mpmath as mp
import sympy as sp

from derivations.proofs.maths import Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS"]

Found = Mapping[str, Number]
_ANYWHERE = "random points around TRUM-60"


def _toothed_modulus(p: Point, m: Maths) -> Number:  # noqa: ARG001
    """The solid beam's modulus: the metal below the teeth bends about its own middle as a beam of the full height."""
    return p.E_e * (p.h_e - p.h_t) ** 3 / p.h_e**3


def _axis(p: Point, m: Maths) -> Found:
    """Centroid of the layers, each weighted by its axial stiffness."""
    metal, ceramic = _toothed_modulus(p, m) * p.b_e * p.h_e, p.E_p * p.b_p * p.h_p
    return {"D": (metal * p.h_e / 2 + ceramic * (p.h_e + p.h_p / 2)) / (metal + ceramic)}


def _section(p: Point, m: Maths) -> Found:
    """Second moments by Steiner's theorem; mass and shear by what the grooves leave of the metal."""
    metal, ceramic = p.b_e * p.h_e, p.b_p * p.h_p
    of_metal = p.b_e * p.h_e**3 / 12 + metal * (p.h_e / 2 - p.D) ** 2
    of_ceramic = p.b_p * p.h_p**3 / 12 + ceramic * (p.h_e + p.h_p / 2 - p.D) ** 2
    left = p.b_e * (p.h_e - p.n_s * p.b_s * p.h_t / p.l_s)  # area of the metal less that of the grooves, on average
    second, modulus = of_metal + of_ceramic, _toothed_modulus(p, m)
    return {
        "E": (modulus * of_metal + p.E_p * of_ceramic) / second,
        "rho": (p.rho_e * left + p.rho_p * ceramic) / (metal + ceramic),
        "I_z": second,
        "G": (p.G_e * left + p.G_p * ceramic) / (metal + ceramic),
        "A": metal + ceramic,
        "E_eq": modulus,
    }


def _wavenumber(p: Point, m: Maths) -> Found:
    """n_j wavelengths are once around."""
    wavelength = 2 * m.pi * p.R / p.n_j
    return {"k_c": 2 * m.pi / wavelength}


def _resonance(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Lowest eigenvalue of the two energies, and its eigenvector."""
    shear, inertia = p.kappa * p.G * p.A, (p.rho * p.A, p.rho * p.I_z)
    stiffness = mp.matrix(
        [[shear * p.k_c**2 + p.k_f, -shear * p.k_c], [-shear * p.k_c, shear + p.E * p.I_z * p.k_c**2]]
    )
    roots = [mp.sqrt(mass) for mass in inertia]
    scaled = mp.matrix(2, 2)
    for i in range(2):
        for j in range(2):
            scaled[i, j] = stiffness[i, j] / (roots[i] * roots[j])
    squares, modes = mp.eigsy(scaled)
    lowest = min(range(2), key=lambda i: squares[i])
    return {
        "quartic": mp.sqrt(squares[lowest]),
        "beta": modes[1, lowest] / roots[1] / (modes[0, lowest] / roots[0]),
    }


def _truncated(p: Point, m: Maths) -> Found:
    """Rayleigh's quotient of a beam that neither shears nor turns; the determinant without its square in omega^2."""
    shear = p.kappa * p.G * p.A
    bending = p.E * p.I_z * p.k_c**2
    first, second, off = shear * p.k_c**2 + p.k_f, shear + bending, shear * p.k_c
    return {
        "euler": m.sqrt((bending * p.k_c**2 + p.k_f) / (p.rho * p.A)),
        "eq6": m.sqrt((first * second - off**2) / (first * p.rho * p.I_z + second * p.rho * p.A)),
    }


def _printed_resonance(p: Point, m: Maths) -> Found:
    """Eq. 6 typed again from the print."""
    flexible = 1 / (p.kappa * p.G) + 1 / p.E
    return {"printed": m.sqrt(p.E * p.I_z * p.k_c**4 + p.k_dx) / m.sqrt(p.rho * p.A + p.rho * flexible * p.k_c**2)}


def _measured(p: Point, m: Maths) -> Found:
    """Straight in logarithms: at one newton C_f W_max, and the slope is -varsigma."""
    return {"W": p.C_f * p.W_max * m.exp(-p.varsigma * m.log(p.F_c))}


def _forced(p: Point, m: Maths) -> Found:
    """Virtual work of the ceramic's moment on a wavelength of the mode, over its modal mass, at resonance omega_n."""
    arm = p.h_e + p.h_p / 2 - p.D
    moment = m.absolute(p.d_31) * p.U_s / (p.s_11E * p.h_p) * p.b_p * p.h_p * arm
    work = 4 * m.integral(lambda angle: moment * p.beta * m.cos(angle), 0 * p.k_c, m.pi / 2)
    mass = m.integral(
        lambda angle: p.rho * (p.A * m.cos(angle) ** 2 + p.I_z * p.beta**2 * m.sin(angle) ** 2), 0 * p.k_c, 2 * m.pi
    )
    dynamic = (p.omega_n**2 - p.omega_q**2) ** 2 + (2 * p.xi * p.omega_n * p.omega_q) ** 2
    unloaded = work * p.k_c / mass / m.sqrt(dynamic)
    return {"W": p.C_f * unloaded * m.exp(-p.varsigma * m.log(p.F_c))}


def _layer(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """A strip pressed by delta has the strain delta/h_m and the force E_m b_m times that."""
    delta = p.h_m / 1000
    return {"k_N": p.E_m * p.b_m * (delta / p.h_m) / delta}


def _pressed(p: Point, m: Maths, theta: Number) -> Number:
    """Force of the layer over one crest: springs compressed by the wave's height above the contact's edge."""
    return m.integral(lambda u: p.k_N * p.W * (m.cos(u) - m.cos(theta)), -theta, theta) / p.k_c


def _balance(p: Point, m: Maths) -> Found:
    """Prepressure less the force of all crests, over 2 n_j k_N W / k_c, and its derivative."""

    def residual(theta: Number) -> Number:
        return (p.F_c - p.n_j * _pressed(p, m, theta)) * p.k_c / (2 * p.n_j * p.k_N * p.W)

    return {"residual": residual(p.theta), "slope": m.derivative(residual, p.theta)}


def _hertz(p: Point, m: Maths) -> Found:
    """Half of Hertz's width 2 sqrt(8/pi P rho_k C_E)/2, its factor rounded to one digit as the paper prints it."""
    rounded = sp.Rational(str(round(float(mp.sqrt(8 / mp.pi)), 1)))
    diameter = 2 / (p.W * (p.n_j / p.r_t) ** 2)  # twice the crest's radius of curvature, at the teeth's radius
    compliance = (1 - p.mu_e) * (1 + p.mu_e) / p.E_eq + (1 - p.mu_m) * (1 + p.mu_m) / p.E_m
    width = m.sqrt(p.F_c / (p.n_j * p.b_m) * diameter * compliance) * int(rounded.p) / int(rounded.q)
    return {"theta": p.k_c * width / 2}


def _foundation(p: Point, m: Maths) -> Found:
    """Fourier's first coefficient of the layer's reaction; the layer's share of the circumference; the print."""
    reaction = m.integral(lambda u: p.k_N * (m.cos(u) - m.cos(p.theta)) * m.cos(u), -p.theta, p.theta)
    around, touching = 2 * m.pi * p.n_j / p.k_c, p.n_j * (2 * p.theta / p.k_c)
    return {"harmonic": reaction / m.pi, "smeared": p.k_N * touching / around, "printed": p.k_N * touching}


def _proof(
    kernel: str,
    outputs: str,
    rests_on: str,
    statement: str,
    wanted: Callable[[Point, Maths], Found],
    names: str,
    *,
    symbolic: bool = True,
) -> Proof:
    return Proof(kernel, outputs, rests_on, statement, wanted, grid(names), _ANYWHERE, symbolic)


def _edge(p: Point) -> Number:
    """Deflection of a plate's edge under a unit load: the exponential carries its state (w, w', w'', w''') across.

    The plate's equation for w cos(k x) is w'''' - 2 k^2 w'' + k^4 w = 0.  Clamped at one edge; at the other no moment,
    and the shear and the change of twist along the edge balance the load.
    """
    k, nu = p.k_c, p.mu_f
    bending = p.E_f * p.h_f**3 / 12 / (1 - nu) / (1 + nu)
    across = mp.expm(mp.matrix([[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [-(k**4), 0, 2 * k**2, 0]]) * p.l_f)
    moment = [across[2, j] - nu * k**2 * across[0, j] for j in (2, 3)]
    force = [-bending * (across[3, j] - (2 - nu) * k**2 * across[1, j]) for j in (2, 3)]
    size = moment[0] * force[1] - moment[1] * force[0]
    start = -moment[1] / size, moment[0] / size  # w'' and w''' at the clamped edge
    return across[0, 2] * start[0] + across[0, 3] * start[1]


def _series(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """A unit load per length shortens layer, tooth and flange, and their approaches add."""
    pitch = p.l_s / p.n_s
    tooth = p.h_t / (p.E_e * p.b_e * (pitch - p.b_s) / pitch)  # one strut a pitch
    flange = _edge(p)
    return {"k_tooth": 1 / tooth, "k_flange": 1 / flange, "k_con": 1 / (1 / p.k_N + tooth + flange)}


def _sheared(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Shear is a tension and an equal pressure across it, at 45 degrees: the angle is twice the strain of either."""
    stress = p.E_m / 1000
    strain = (stress + p.mu_m * stress) / p.E_m
    return {"k_T": stress * p.b_m / (2 * strain * p.h_m)}


_BEAM = "A E G I_z k_c k_dx k_f kappa rho"
PROOFS = (
    _proof(
        "trum_neutral_axis",
        "D",
        "1 equivalent-beam",
        "centroid of the layers weighted by axial stiffness",
        _axis,
        "E_e E_p b_e b_p h_e h_p h_t",
    ),
    _proof(
        "trum_section",
        "E rho I_z G A E_eq",
        "2 equivalent-beam",
        "means over the layers, second moments by Steiner's theorem",
        _section,
        "D E_e E_p G_e G_p b_e b_p b_s h_e h_p h_t l_s n_s rho_e rho_p",
    ),
    _proof("trum_wavenumber", "k_c", "4", "n_j wavelengths are once around", _wavenumber, "R n_j"),
    _proof(
        "trum_resonance",
        "quartic beta",
        "3 5 6",
        "lowest eigenvalue and eigenvector of the wave's two energies",
        _resonance,
        _BEAM,
        symbolic=False,
    ),
    _proof(
        "trum_resonance",
        "euler eq6",
        "3 5 6",
        "Rayleigh's quotient without shear and rotation; the determinant without its square in omega^2",
        _truncated,
        _BEAM,
    ),
    _proof("trum_resonance", "printed", "6", "the print, typed again", _printed_resonance, _BEAM),
    _proof(
        "trum_amplitude_measured",
        "W",
        "8",
        "straight in logarithms of amplitude and prepressure",
        _measured,
        "C_f F_c W_max varsigma",
    ),
    _proof(
        "trum_amplitude_forced",
        "W",
        "7 8",
        "virtual work of the ceramic's moment on the mode over its modal mass",
        _forced,
        "A C_f D F_c I_z U_s b_p beta d_31 h_e h_p k_c omega_n omega_q rho s_11E varsigma xi",
    ),
    _proof("trum_layer_stiffness", "k_N", "30", "force of a strip pressed by a thousandth", _layer, "E_m b_m h_m"),
    _proof(
        "trum_contact_stiffness",
        "k_tooth k_flange k_con",
        "30 rotor-flange",
        "approaches of layer, strut and plate under a unit load, the plate's by the exponential of its equation",
        _series,
        "E_e E_f b_e b_s h_f h_t k_N k_c l_f l_s mu_f n_s",
        symbolic=False,
    ),
    _proof(
        "trum_tangential_stiffness",
        "k_T",
        "30",
        "shear as tension and pressure at 45 degrees",
        _sheared,
        "E_m b_m h_m mu_m",
    ),
    _proof(
        "trum_winkler_balance",
        "residual slope",
        "28 30 31",
        "prepressure less the integral of the layer's pressure; its derivative",
        _balance,
        "F_c W k_N k_c n_j theta",
    ),
    _proof(
        "trum_hertz_half_angle",
        "theta",
        "25 26 C_E",
        "Hertz's width with sqrt(8/pi) rounded to one digit, on the crest's curvature",
        _hertz,
        "E_eq E_m F_c W b_m k_c mu_e mu_m n_j r_t",
    ),
    _proof(
        "trum_foundation",
        "harmonic smeared printed",
        "5 k_dx 30",
        "Fourier's first coefficient of the layer's reaction; its share of the circumference; the print",
        _foundation,
        "k_N k_c n_j theta",
    ),
)
