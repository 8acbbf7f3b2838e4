"""Section 2, the stator: eqs. (1) to (8) and the definitions between them."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations import section
from derivations.ledger.judge import agrees, identical
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

E_eq, h_e, b_e, E_p, h_p, b_p, D, z = sym("E_eq h_e b_e E_p h_p b_p D z")

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
            step("Plane sections stay plane: the bending stress at depth z below the tooth surface grows as "
                 "the modulus times z - D. Bending alone carries no axial force:", sp.Eq(strain, 0)),
            step("The integrals are elementary, and linear in D:", sp.Eq(strain.doit(), 0)),
            step("Solved for D; put back, the axial force vanishes:", sp.Eq(D, axis), zero=strain.doit().subs(D, axis)),
        ),
        {"D": axis},
    )  # fmt: skip


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


def _effect_1() -> str:
    p = operating_point()
    return f"D = {mp.nstr(1000 * at_point(_EQ1['D'], p), 5)} mm; printed and derived agree."


ENTRIES = (
    Entry(
        id="1", section="2.1", title="Distance from the tooth surface to the neutral layer", place="Sect. 2.1",
        printed=_EQ1, units={"D": "m"}, verdict="verified",
        reason="Follows from zero axial force; z counts from the tooth surface.",
        judge=_judge_1, derive=_derive_1, effect=_effect_1,
    ),
)  # fmt: skip
