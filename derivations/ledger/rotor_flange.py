"""What gives beside the friction layer, which the paper's contact leaves out: the teeth and the rotor's flange."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import mpmath as mp
import sympy as sp

from derivations import contact, flange
from derivations.ledger.judge import Point, agrees, figure
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

k_N, k_c, k_tooth, k_flange = sym("k_N k_c k_tooth k_flange")
E_e, b_e, h_t, n_s, b_s, l_s, E_f, mu_f, h_f, l_f = sym("E_e b_e h_t n_s b_s l_s E_f mu_f h_f l_f")
_y = sp.Symbol("y", positive=True)
_RANGES = {"k_tooth": (2e11, 6e11), "k_flange": (2e8, 8e9), "l_f": (2e-3, 5e-3), "h_f": (0.5e-3, 1.5e-3)}


def _derive() -> Derivation:
    Y = flange.plate()[0]
    stiffness = flange.flange_stiffness()
    deflection = Y.subs(_y, l_f)
    return Derivation(
        (
            step(
                "The flange is a thin plate, clamped to the rotor's body at y = 0 and loaded by the layer at y = l_f; "
                "under a load per length p cos(k_c x) it bends to w = Y(y) cos(k_c x), statically.  Y solves the "
                "plate's equation and is clamped:",
                zero=(
                    sp.simplify(
                        (Y.diff(_y, 4) - 2 * k_c**2 * Y.diff(_y, 2) + k_c**4 * Y).subs({E_f: 1, h_f: 1}).rewrite(sp.exp)
                    ),
                    Y.subs(_y, 0),
                    sp.expand(Y.diff(_y).subs(_y, 0)),
                ),
            ),
            step(
                "Load over deflection at the loaded edge, where the plate has no moment:",
                sp.Eq(k_flange, stiffness),
                zero=sp.simplify((stiffness * deflection - 1).rewrite(sp.exp)),
            ),
            step(
                "A tooth is a column h_t high and as wide as the beam; of the circumference the grooves take "
                "n_s b_s / l_s:",
                sp.Eq(k_tooth, flange.tooth_stiffness()),
            ),
            step("Layer, tooth and flange carry one force, and their approaches add."),
        ),
        {
            "k_flange": stiffness,
            "k_tooth": flange.tooth_stiffness(),
            "k_con": 1 / (1 / k_N + 1 / k_tooth + 1 / k_flange),
        },
    )


def _ritz(q: Point, powers: int = 26) -> mp.mpf:
    """Load over deflection of the edge by Ritz: the plate's energy is least over polynomials that are clamped.

    In s = y / l_f; per unit of B / l_f^3 and with a = k_c l_f the energy of Y cos(k_c x), times 4 over a wavelength's
    mean, is the integral of (Y'' - a^2 Y)^2 + 2 (1 - nu) a^2 (Y Y'' + Y'^2).
    """
    a, nu = q[k_c] * q[l_f], q[mu_f]
    orders = range(2, 2 + powers)

    def over(i: int, j: int) -> mp.mpf:
        bent, flat, turned = i * (i - 1) * j * (j - 1), (i * (i - 1) + j * (j - 1)), i * j
        mean = mp.mpf(1)
        return (
            bent * mean / (i + j - 3)
            + a**4 * mean / (i + j + 1)
            + (-(a**2) * flat + (1 - nu) * a**2 * (flat + 2 * turned)) * mean / (i + j - 1)
        )

    with mp.workdps(90):
        matrix = mp.matrix([[over(i, j) for j in orders] for i in orders])
        shape = mp.lu_solve(matrix, mp.matrix([1] * powers))
        bending = q[E_f] * q[h_f] ** 3 / (12 * (1 - nu**2))
        return bending / q[l_f] ** 3 / mp.fsum(shape)


def _approach(name: str, q: Point) -> mp.mpf:
    if name == "k_flange":
        return _ritz(q)
    if name == "k_tooth":
        metal = q[b_e] * (q[l_s] - q[n_s] * q[b_s])  # area of all teeth
        shortened = q[h_t] / (q[E_e] * metal)  # by one newton
        return 1 / shortened / q[l_s]
    return 1 / mp.fsum(1 / q[part] for part in (k_N, k_tooth, k_flange))


def _judge(forms: Forms) -> Iterator[Evidence]:
    symbols = {
        "k_flange": (E_f, mu_f, h_f, l_f, k_c),
        "k_tooth": (E_e, b_e, h_t, n_s, b_s, l_s),
        "k_con": (k_N, k_tooth, k_flange),
    }
    for name in forms:
        yield agrees(
            {name: forms[name]},
            _approach,
            symbols=symbols[name],
            ranges=_RANGES,
            count=3,
            tolerance=1e-20,
            against={
                "k_flange": "the least energy over 26 polynomials (Ritz)",
                "k_tooth": "all teeth under one newton",
                "k_con": "the sum of the approaches",
            }[name],
        )
    bending = E_f * h_f**3 / (12 * (1 - mu_f**2))
    slender = sp.limit(sp.simplify(forms["k_flange"].subs(E_f, 1)), k_c, 0)
    yield evidence(
        "limit",
        sp.simplify(slender - (3 * bending / l_f**3).subs(E_f, 1)) == 0,
        "under a load that is the same all round it is a cantilever, 3 B / l_f^3",
    )
    rigid = forms["k_con"].subs({k_tooth: sp.oo, k_flange: sp.oo})
    yield evidence("limit", sp.simplify(rigid - k_N) == 0, "without teeth and flange the layer is left")


@cache
def _half_angle(stiffness: mp.mpf) -> mp.mpf:
    balance, _ = contact.winkler_balance()
    values = {**operating_point(), "k_N": stiffness}
    return mp.findroot(
        lambda angle: at_point(balance, {**values, "theta": angle}), (mp.mpf("0.05"), mp.mpf(3)), solver="anderson"
    )


def _effect() -> str:
    q = operating_point()
    parts = flange.contact_stiffness()
    found = {name: at_point(expr, q) for name, expr in parts.items()}
    return (
        f"For a flange of {figure(1e3 * q['h_f'])} mm by {figure(1e3 * q['l_f'])} mm, which is assumed: "
        f"{figure(found['k_flange'] / 1e9)} GN/m^2, teeth {figure(found['k_tooth'] / 1e9)}, layer "
        f"{figure(q['k_N'] / 1e9)}; in series {figure(found['k_con'] / 1e9)} GN/m^2. A steady wave of one phase's "
        f"amplitude then touches over a half-angle of {figure(_half_angle(found['k_con']))} rad, not "
        f"{figure(q['theta'])}."
    )


ENTRIES = (
    Entry(
        id="rotor-flange",
        section="4.1",
        title="Stiffness of the whole contact: layer, tooth and rotor flange",
        place="left out by eq. 30; ours",
        printed={},
        units={"k_flange": "N/m^2", "k_tooth": "N/m^2", "k_con": "N/m^2"},
        verdict="reconstructed",
        reason="Eq. 30 lets the friction layer alone give way. It is stiff; the flange that carries it is not, and "
        "what is in series with it sets the contact's width. Thin plate, unrolled, static; the flange's size is "
        "assumed.",
        judge=_judge,
        derive=_derive,
        effect=_effect,
    ),
)
