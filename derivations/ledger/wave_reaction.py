"""What eqs. 8 to 10 prescribe: the rotor acts back on the wave, through pressure and friction of its contact."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import mpmath as mp
import sympy as sp

from derivations import beam, coupling
from derivations.ledger.judge import Point, agrees, figure, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

M_q, F_q, c_p, omega_n0, omega_q, xi = sym("M_q F_q c_p omega_n0 omega_q xi")
rho, A, I_z, beta, k_c, D, n_j, F_c, mu, W = sym("rho A I_z beta k_c D n_j F_c mu W")
engagement, share, theta, alpha, central, along, f = sym("engagement share theta alpha central along f")
_RANGES = {
    "theta": (0.2, 3.0),
    "alpha": (0.02, 0.19),
    "M_q": (0.03, 0.2),
    "F_q": (20.0, 400.0),
    "omega_n0": (2.3e5, 2.6e5),
    "central": (80.0, 220.0),
    "along": (-50.0, 60.0),
    "c_p": (0.3, 1.0),
}


def _loaded(expr: sp.Expr) -> sp.Expr:
    """With the pressure of a partial contact that carries the prepressure (eq. 32)."""
    size = 1 / (sp.sin(theta) - theta * sp.cos(theta))
    return sp.simplify(expr.subs({engagement: size, share: -size * sp.cos(theta)}))


def _derive() -> Derivation:
    found, of = coupling.modal(), coupling.reaction()
    parts = coupling.balance()
    forms = {
        "M_q": found["M_q"],
        "F_q": found["F_ceramic"],
        "f": _loaded(of["f"]),
        "central": _loaded(of["central"]),
        "along": _loaded(of["along"]),
        "balance": sp.Eq(F_q**2, parts["in_phase"] ** 2 + parts["ahead"] ** 2),
    }
    powers = coupling.powers()
    return Derivation(
        (
            step(
                "A phase's standing wave moves the whole ring: twice its kinetic energy at unit speed is its modal "
                "mass; both phases have the same, and none between them:",
                sp.Eq(M_q, forms["M_q"]),
            ),
            step(
                "The ceramic's moment works on the mode's curvature, under a share of the ring:",
                sp.Eq(F_q, forms["F_q"]),
            ),
            step(
                "Pressure and traction do virtual work on both phases through the surface's displacements (11).  The "
                "pressure's part in cos u acts against the wave's height, friction's against its running.  Of a "
                "contact that carries F_c, whose surface is faster than the rotor where |u| < alpha:",
                sp.Eq(f, forms["f"]),
                sp.Eq(central, forms["central"]),
                sp.Eq(along, forms["along"]),
            ),
            step(
                "A narrow contact reacts with F_c, whatever its stiffness:",
                zero=sp.limit(forms["central"], theta, 0) - F_c,
            ),
            step(
                "Where both phases are alike and always on, all of this stands still seen from the crest, and the "
                "equations of motion of both phases are one balance:",
                forms["balance"],
            ),
            step(
                "What the modal forces put in is lost in the stator and by slip, and reaches the rotor:",
                zero=powers["P_in"] - powers["P_stator"] - powers["P_slip"] - powers["P_rotor"],
            ),
        ),
        forms,
    )


def _angle_sum(q: Point, weight: Callable[[mp.mpf], mp.mpf], slip: bool) -> mp.mpf:
    """Over the contact, pressure or friction times a weight, over all of the pressure."""
    edge, inner = q[theta], q[alpha] * q[theta]

    def press(u: mp.mpf) -> mp.mpf:
        return mp.cos(u) - mp.cos(edge)

    places = [-edge, -inner, inner, edge]
    ways = (-1, 1, -1) if slip else (1, 1, 1)
    parts = zip(ways, places[:-1], places[1:], strict=True)
    total = mp.quad(press, [-edge, 0, edge])
    return mp.fsum(way * mp.quad(lambda u: press(u) * weight(u), [low, high]) for way, low, high in parts) / total


def _reference(name: str, q: Point) -> mp.mpf:
    if name == "M_q":
        energy = mp.quad(
            lambda s: (q[rho] * q[A] * mp.sin(s) ** 2 + q[rho] * q[I_z] * (q[beta] * mp.cos(s)) ** 2) / 2,
            [0, mp.pi / 2, mp.pi, 2 * mp.pi],
        )
        return 2 * q[n_j] * energy / q[k_c]
    if name == "F_q":
        low, thick = q[sym("h_e")[0]] - q[D], q[sym("h_p")[0]]
        stress = abs(q[sym("d_31")[0]]) / q[sym("s_11E")[0]] * q[sym("U_s")[0]] / thick
        moment = stress * q[sym("b_p")[0]] * mp.quad(lambda z: z, [low, low + thick])
        segments = 2 * q[n_j] * q[c_p]  # half a wave long, poled in turn
        return segments * mp.quad(lambda s: moment * q[beta] * mp.cos(s), [-mp.pi / 2, 0, mp.pi / 2])
    if name == "f":
        return _angle_sum(q, lambda u: mp.mpf(1), slip=True)  # noqa: ARG005
    if name == "central":
        return q[F_c] * _angle_sum(q, mp.cos, slip=False)
    return q[mu] * q[F_c] * _angle_sum(q, mp.cos, slip=True)


def _judge(forms: Forms) -> Iterator[Evidence]:
    scaled = {name: form.subs(alpha, alpha * theta) for name, form in forms.items() if name != "balance"}
    symbols = {
        "M_q": (rho, A, I_z, beta, n_j, k_c),
        "F_q": (D, beta, n_j, c_p, *sym("h_e h_p d_31 s_11E U_s b_p")),
        "f": (theta, alpha),
        "central": (theta, alpha, F_c),
        "along": (theta, alpha, F_c, mu),
    }
    against = {
        "M_q": "twice the kinetic energy at unit speed",
        "F_q": "the moments' work, segment by segment",
        "f": "friction summed over the contact",
        "central": "pressure times cos u summed over the contact",
        "along": "friction times cos u summed over the contact",
    }
    for name, words in against.items():
        yield agrees(
            {name: scaled[name]},
            _reference,
            symbols=symbols[name],
            ranges={**_RANGES, "alpha": (0.1, 0.9)},
            count=4,
            against=words,
        )
    yield _moves(forms["balance"])
    narrow = sp.limit(forms["central"], theta, 0)
    whole = forms["central"].subs(theta, sp.pi)
    yield evidence(
        "limit",
        vanishes(narrow - F_c) and vanishes(whole - F_c / 2),
        "a narrow contact reacts with F_c, one that just touches all round with half of it",
    )


def _moves(equation: sp.Basic) -> Evidence:
    """Phase A's equation of motion at a quarter of the period, stiffness, inertia and reaction, and a quarter on."""
    squares = (M_q * omega_n0**2 * W - M_q * omega_q**2 * W + central) ** 2
    squares += (2 * xi * omega_n0 * omega_q * M_q * W + D * k_c * along) ** 2
    gap = equation.lhs - equation.rhs
    ok = vanishes(gap - (F_q**2 - squares)) or vanishes(gap + (F_q**2 - squares))
    return evidence(
        "identity", ok, "the squares of what a phase's crest and its passage through 0 need are the force's"
    )


def _effect() -> str:
    q = operating_point()
    own = at_point(beam.resonance()["quartic"], {**q, "k_f": mp.mpf(0)})
    found = {name: at_point(expr, {**q, "omega_n0": own, "c_p": 1}) for name, expr in coupling.modal().items()}
    mass, most = found["M_q"], found["F_measured"]

    def shift(height: float) -> mp.mpf:
        """By F_c, of a wave this high, in Hz."""
        return (mp.sqrt(own**2 + q["F_c"] / (mass * height)) - own) / (2 * mp.pi)

    needed = (
        mass * q["W"] * abs(mp.mpc(q["omega_n"] ** 2 - q["omega_q"] ** 2, 2 * q["xi"] * q["omega_n"] * q["omega_q"]))
    )
    return (
        f"A phase weighs {figure(1e3 * mass)} g. The {figure(1e6 * q['W_max'])} um measured at resonance are a modal "
        f"force of {figure(most)} N; the ceramic's data give {figure(found['F_ceramic'])} N under the whole ring and "
        f"{figure(found['F_ceramic'] * 4 / 9)} N under four of nine waves. A contact near the crests reacts with "
        f"{figure(q['F_c'])} N and lifts the resonance by {figure(shift(12.6e-6), 3)} Hz at 12.6 um, "
        f"{figure(shift(5.56e-6), 3)} Hz at 5.56 um and {figure(shift(1.5e-6), 3)} Hz at 1.5 um. The amplitude that "
        f"(8) prescribes, {figure(1e6 * q['W'])} um, would need {figure(needed)} N 3000 Hz above the resonance, "
        f"{figure(needed / most, 2)} times what those 12.6 um stand for: off resonance (8) is not what a motor does."
    )


ENTRIES = (
    Entry(
        id="wave-reaction",
        section="3",
        title="The rotor's reaction on the wave: modal mass, modal forces, balance of a plain wave",
        place="left out by eqs. 8 to 10, which prescribe each phase; ours",
        printed={},
        units={"M_q": "kg", "F_q": "N", "f": "1", "central": "N", "along": "N"},
        verdict="reconstructed",
        reason="Amplitude and resonance under prepressure are a fit and a constant in the paper. The contact's "
        "pressure and friction do work on both phases; for a plain wave that is a balance of numbers, seen from its "
        "crest.",
        judge=_judge,
        derive=_derive,
        effect=_effect,
    ),
)
