"""What the layer of eq. 30 leaves out under a wave that the rotor acts back on: loss of its own, and shear."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import mpmath as mp
import sympy as sp

from derivations import brush, flange, layer
from derivations.ledger.judge import Point, agrees, figure, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

eta, free, u_in, u_out, engagement = sym("eta_m free u_in u_out engagement")
F_c, F_q, mu, W, D, k_c, k_N, n_j, omega_q = sym("F_c F_q mu W D k_c k_N n_j omega_q")
M_q, omega_n0, xi, central, along, across, lossy = sym("M_q omega_n0 xi central along across lossy")
grip, ratio, u, u_0, t_0, f = sym("grip ratio u u_0 t_0 f")
_u = sp.Symbol("u_s", real=True)
_RANGES = {
    "eta_m": (0.02, 0.4),
    "free": (0.5, 5.0),
    "u_out": (-2.8, -0.3),
    "u_in": (0.3, 3.0),
    "engagement": (0.2, 40.0),
    "grip": (0.5, 60.0),
    "ratio": (-1.2, 1.2),
    "u": (-2.0, 2.0),
    "u_0": (-2.0, 2.0),
    "t_0": (-1.0, 1.0),
    "f": (-0.9, 0.9),
}
_ETA = mp.mpf("0.1")


def _density() -> sp.Expr:
    """Pressure's share per angle of a contact that ends without pressure."""
    ends = sp.cos(u_out) + eta * sp.sin(u_out)
    return engagement * (sp.cos(_u) + eta * sp.sin(_u) - ends) / 2


def _loss() -> Derivation:
    share = _density()
    forms = {
        "gap": sp.cos(u_out - free) - sp.cos(u_out) - eta * sp.sin(u_out) * (1 - sp.exp(-free / eta)),
        "carried": sp.integrate(share, (_u, u_out, u_in)),
        "lossy": F_c * sp.integrate(sp.expand(share * sp.sin(_u)), (_u, u_out, u_in)),
        "whole": sp.pi * eta * k_N * W**2 * omega_q * n_j / k_c,
        "balance": sp.Eq(F_q**2, layer.balance()["in_phase"] ** 2 + layer.balance()["ahead"] ** 2),
    }
    powers = layer.powers()
    return Derivation(
        (
            step(
                "An element of the layer is a spring beside a dashpot that only push. It leaves behind the "
                "crest, where cos u + eta sin u has fallen to the rotor's level and there is no pressure, still "
                "pressed in by eta sin(-u_out) W. It recovers by itself; the surface is above it, over W, after "
                "the wave has moved on by an angle, by",
                forms["gap"],
            ),
            step(
                "Contact begins anew where that is 0 again, ahead of the crest, with a jump of the pressure. The layer "
                "carries, over the prepressure, and takes power by its pressure's part in sin u:",
                forms["carried"],
                sp.Eq(lossy, forms["lossy"]),
            ),
            step("Where the whole wave touches, that power is exactly", forms["whole"]),
            step(
                "Pressure and friction are no longer alike on both sides of the crest; all four of their parts act on "
                "the wave:",
                forms["balance"],
            ),
            step(
                "What the modal forces put in is lost in stator, layer and slip, and reaches the rotor:",
                zero=powers["P_in"] - powers["P_stator"] - powers["P_layer"] - powers["P_slip"] - powers["P_rotor"],
            ),
        ),
        forms,
    )


def _loss_reference(name: str, q: Point) -> mp.mpf:
    level_ = mp.cos(q[u_out]) + q[eta] * mp.sin(q[u_out]) if u_out in q else mp.mpf(0)
    if name == "gap":
        # the element's own equation, d d/d phi = -d / eta, as a matrix's exponential
        kept = mp.expm(mp.matrix([[-q[free] / q[eta]]]))[0] * (mp.cos(q[u_out]) - level_)
        return mp.cos(q[u_out] - q[free]) - level_ - kept
    if name == "whole":
        rate = mp.quad(lambda s: (q[omega_q] * q[W] * mp.sin(s)) ** 2, mp.linspace(-mp.pi, mp.pi, 5))
        return q[k_N] * q[eta] / q[omega_q] * rate * q[n_j] / q[k_c]  # of the dashpots
    places = mp.linspace(q[u_out], q[u_in], 5)
    if name == "carried":
        return q[engagement] / 2 * mp.quad(lambda s: mp.cos(s) + q[eta] * mp.sin(s) - level_, places)
    dashpots = mp.quad(lambda s: q[eta] * mp.sin(s) ** 2, places)
    kept = ((mp.cos(q[u_out]) - level_) ** 2 - (mp.cos(q[u_in]) - level_) ** 2) / 2  # of the springs, lost or brought
    return q[F_c] * q[engagement] / 2 * (dashpots + kept)


def _judge_loss(forms: Forms) -> Iterator[Evidence]:
    symbols = {
        "gap": (eta, u_out, free),
        "carried": (eta, u_out, u_in, engagement),
        "lossy": (eta, u_out, u_in, engagement, F_c),
        "whole": (eta, k_N, W, omega_q, n_j, k_c),
    }
    against = {
        "gap": "the exponential of the element's equation of motion",
        "carried": "the pressure summed over the contact",
        "lossy": "what the dashpots lose and what elements keep when they leave",
        "whole": "what the dashpots lose",
    }
    for name, words in against.items():
        yield agrees(
            {name: forms[name]},
            _loss_reference,
            symbols=symbols[name],
            ranges=_RANGES,
            count=4,
            against=words,
            tolerance=1e-12,
        )
    yield _moves(forms["balance"])
    yield evidence(
        "limit",
        vanishes(forms["lossy"].subs(eta, 0).subs(u_in, -u_out)),
        "a layer without loss, alike on both sides, takes no power",
    )


def _moves(equation: sp.Basic) -> Evidence:
    """Pressure and traction as complex numbers, the force on the crest, its size."""
    reaction = (central + sp.I * lossy) + sp.I * D * k_c * (along + sp.I * across)
    own = M_q * W * (omega_n0**2 - omega_q**2 + 2 * sp.I * xi * omega_n0 * omega_q)
    real, imaginary = sp.expand(own + reaction).as_real_imag()
    squares = real**2 + imaginary**2
    gap = equation.lhs - equation.rhs
    ok = vanishes(gap - (F_q**2 - squares)) or vanishes(gap + (F_q**2 - squares))
    return evidence("identity", ok, "the size of dynamic stiffness and reaction as complex numbers is the force's")


def _contact(q: Mapping[str, mp.mpf]) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Where a layer of loss factor _ETA begins and ends to touch, and the power that it takes."""
    full = 2 * q["n_j"] * q["k_N"] * q["W"] / (q["k_c"] * q["F_c"])
    angles = sym("leaving free")
    forms = (layer.meeting()["gap"], layer.carried()["carried"] - 1)
    known = {eta: _ETA, engagement: full}
    both = sp.lambdify(angles, [form.subs(known) for form in forms], [{"expm1": mp.expm1}, "mpmath"])
    leaving, way = mp.findroot(both, (mp.mpf("0.5"), mp.mpf("5.4")))
    ends = {"leaving": leaving, "free": way, "eta_m": _ETA}
    into, out = (at_point(layer.meeting()[name], ends) for name in ("u_in", "u_out"))
    around = {"eta_m": _ETA, "u_in": into, "u_out": out, "engagement": full, "F_c": q["F_c"]}
    return into, out, at_point(_loss().forms["lossy"], around) * q["omega_q"] * q["W"]


def _effect_loss() -> str:
    q = operating_point()
    into, out, power = _contact(q)
    theta = q["theta"]
    whole = at_point(_loss().forms["whole"], {**q, "eta_m": _ETA})
    first = whole * (theta - mp.sin(theta) * mp.cos(theta)) / mp.pi
    return (
        f"A loss factor of {figure(_ETA, 2)} takes {figure(power)} W of a plain wave of {figure(1e6 * q['W'])} "
        f"um on the layer alone, under {figure(q['F_c'])} N. Contact is from {figure(out)} to {figure(into)} "
        f"rad about the crest, where without loss it is {figure(theta)} rad to either side; on that contact the "
        f"same layer would take {figure(first)} W."
    )


def _shear() -> Derivation:
    found = layer.passage()
    forms = {
        "stress": found["stress"],
        "stuck_cos": found["stuck_cos"],
        "stuck_sin": found["stuck_sin"],
        "W_stick": layer.stuck()["W_stick"],
        "stiff": sp.pi * grip,
    }
    return Derivation(
        (
            step(
                "A bristle passes under the crest and is sheared by the slip between surface and rotor, over mu k_N W:",
                forms["stress"],
            ),
            step(
                "While it sticks it adds to friction's parts in cos u, which hold the wave back, and in sin u, which "
                "stiffen it; while it slides, the limit does:",
                forms["stuck_cos"],
                forms["stuck_sin"],
            ),
            step(
                "Where the whole wave touches and all bristles stick, under a rotor that stands, they take no "
                "power and have, times sin u, as springs:",
                forms["stiff"],
            ),
            step(
                "That lasts until stress and limit meet in one place; with the load's share f of friction:",
                forms["W_stick"],
            ),
            step(
                "Without load and with normal stiffness small that is where the surface's displacement D k_c W shears "
                "the layer by friction's mean limit:",
                zero=sp.limit(forms["W_stick"].subs(f, 0) * grip, grip, sp.oo) - F_c * k_c / (2 * sp.pi * n_j * k_N),
            ),
        ),
        forms,
    )


def _shear_reference(name: str, q: Point) -> mp.mpf:
    if name == "W_stick":
        length = 2 * mp.pi * q[n_j] / q[k_c]
        place = mp.findroot(lambda s: q[grip] * mp.cos(s) + mp.sin(s), 2.2)
        most = q[grip] * mp.sin(place) - mp.cos(place)  # stress less the limit's wave, of a wave of 1
        return (1 - abs(q[f])) * q[F_c] / length / q[k_N] / most
    if name == "stiff":
        return mp.quad(lambda s: q[grip] * mp.sin(s) ** 2, [-mp.pi, 0, mp.pi])

    def gained(weight: Callable[[mp.mpf], mp.mpf]) -> mp.mpf:
        """Each bit of slip times the weight of the way that is left from there."""
        slips = mp.quad(lambda s: (mp.cos(s) - q[ratio]) * weight(s), [q[u_0], q[u]])
        return q[t_0] * weight(q[u_0]) + q[grip] * slips

    left = {
        "stress": lambda s: s**0,
        "stuck_cos": lambda s: mp.sin(q[u]) - mp.sin(s),
        "stuck_sin": lambda s: mp.cos(s) - mp.cos(q[u]),
    }
    return gained(left[name])


def _judge_shear(forms: Forms) -> Iterator[Evidence]:
    passing = (t_0, grip, ratio, u_0, u)
    symbols = {
        "stress": passing,
        "stuck_cos": passing,
        "stuck_sin": passing,
        "W_stick": (F_c, n_j, k_c, k_N, f, grip),
        "stiff": (grip,),
    }
    against = {
        "stress": "the slip summed over the way",
        "stuck_cos": "the stress times cos u summed over the way",
        "stuck_sin": "the stress times sin u summed over the way",
        "W_stick": "where the greatest of stress less limit is 0",
        "stiff": "the springs' stress summed over a wave",
    }
    for name, words in against.items():
        yield agrees(
            {name: forms[name]}, _shear_reference, symbols=symbols[name], ranges=_RANGES, count=4, against=words
        )
    mean = F_c * k_c / (2 * sp.pi * n_j * k_N)
    yield evidence(
        "limit",
        vanishes(sp.limit(forms["W_stick"], grip, 0) - mean * (1 - sp.Abs(f))),
        "a layer that is soft in shear sticks up to where the wave begins to leave the rotor",
    )


def _effect_shear() -> str:
    q = operating_point()
    whole = {**q, "k_T": at_point(flange.tangential_stiffness(), q), "f": mp.mpf(0)}
    gripped = at_point(brush.coefficient(), whole)
    found = {name: at_point(expr, {**whole, "grip": gripped}) for name, expr in layer.stuck().items()}
    full = q["F_c"] * q["k_c"] / (2 * mp.pi * q["n_j"] * q["k_N"])
    return (
        f"A layer that is sheared has a grip of {figure(gripped)}. Under {figure(q['F_c'])} N and without load "
        f"it sticks all round up to a wave of {figure(1e9 * found['W_stick'], 3)} nm, "
        f"{figure(found['W_stick'] / full, 3)} of the height at which the wave begins to leave the rotor; below, the "
        "rotor stands."
    )


ENTRIES = (
    Entry(
        id="lossy-layer",
        section="4",
        title="A layer that loses energy under a plain wave",
        place="left out by eq. 30, whose layer is a spring; ours",
        printed={},
        units={"gap": "1", "carried": "1", "lossy": "N", "whole": "W"},
        verdict="reconstructed",
        reason="The paper's layer gives back all that it takes. One of a loss factor leaves the crest before it is as "
        "long as it was, so that contact, pressure and friction are not alike on both sides of it.",
        judge=_judge_loss,
        derive=_loss,
        effect=_effect_loss,
    ),
    Entry(
        id="sheared-layer",
        section="4",
        title="A layer that is sheared, and sticks and slides, under a wave that the rotor acts back on",
        place="left out by eqs. 33 to 37, whose layer is rigid along the circumference; ours",
        printed={},
        units={"stress": "1", "stuck_cos": "1", "stuck_sin": "1", "W_stick": "m", "stiff": "1"},
        verdict="reconstructed",
        reason="Where the paper's layer slides everywhere, one that gives way sticks in part of the contact, "
        "acts on the wave's height as well, and holds a wave that is low enough altogether.",
        judge=_judge_shear,
        derive=_shear,
        effect=_effect_shear,
    ),
)
