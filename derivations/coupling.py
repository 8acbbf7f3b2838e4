"""The rotor acts back on the wave: both phases' standing waves as coordinates of one system with the contact (our own).

A phase's standing wave w_A sin(k_c x) or w_B cos(k_c x) has a modal mass, the ceramic drives it with a modal force, and
the layer's pressure p and traction tau do virtual work on it through the surface's displacements (eq. 11).  As numbers
of one vector, (w_A, w_B) = W_c (sin a, cos a) with a the crest's angle k_c x_max; u = k_c x - a counts from the crest.
The rotor stands ``height`` above the surface of a stator at rest, so the layer is pressed in by W_c cos u - height.

Where both phases are alike and always on, the wave W_c = W, a = omega_q t is at rest seen from its crest, whatever the
contact does, and so are rotor and pressure: a balance of numbers, without averaging.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations import amplitude, rotor, surface
from derivations.nomenclature import TINY, sym

__all__ = [
    "CouplingError",
    "balance",
    "elastic_energy",
    "flow",
    "forces",
    "held_height",
    "instant",
    "modal",
    "moments",
    "powers",
    "reaction",
    "resonance",
    "swing",
    "without_contact",
    "work",
]

M_q, F_q, c_p, omega_n0, omega_q, xi, W_max = sym("M_q F_q c_p omega_n0 omega_q xi W_max")
rho, A, I_z, beta, k_c, D, n_j, k_N, F_c, mu, W, W_c = sym("rho A I_z beta k_c D n_j k_N F_c mu W W_c")
engagement, share, theta, sin_theta, cos_theta = sym("engagement share theta sin_theta cos_theta")
alpha, height, v, R_v, phi, cos_phi, sin_phi = sym("alpha height v R_v phi cos_phi sin_phi")
central, along, sin_crest, cos_crest = sym("central along sin_crest cos_crest")
w_A, w_B, v_A, v_B = sp.symbols("w_A w_B v_A v_B", real=True)
x = sym("x")[0]
_u, _a = sp.symbols("u_s a_s", real=True)
_p, _tau = sp.Function("p_s"), sp.Function("tau_s")


class CouplingError(ArithmeticError):
    """A result is not what the equations of motion, or the balance of energy, make it."""


def _zero(expression: sp.Expr, what: str) -> None:
    if sp.simplify(sp.expand(expression)) != 0:
        raise CouplingError(f"{what}: {sp.simplify(expression)} is not 0")


@cache
def modal() -> dict[str, sp.Expr]:
    """Modal mass of a phase on the whole ring; its modal force by the ceramic, and by the amplitude at resonance.

    The mass is that of the section, grooves taken off, with its rotary inertia: the mode's rotation is beta times the
    displacement, a quarter wave on.  Electrodes that drive a share of the circumference do that share of eq. 7's work.

    Raises
    ------
    CouplingError
        If the phases' masses differ or couple, or the forced amplitude of a full ring is not that of eq. 7 put right.
    """
    ring = 2 * sp.pi * n_j / k_c
    shapes = [(sp.sin(k_c * x), beta * sp.cos(k_c * x)), (sp.cos(k_c * x), -beta * sp.sin(k_c * x))]

    def mass(one: tuple[sp.Expr, sp.Expr], other: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
        wave = (x, 0, 2 * sp.pi / k_c)
        return n_j * sp.integrate(rho * A * one[0] * other[0] + rho * I_z * one[1] * other[1], wave)

    own = sp.factor(mass(shapes[0], shapes[0]))
    _zero(mass(shapes[1], shapes[1]) - own, "the masses of both phases")
    _zero(mass(shapes[0], shapes[1]), "a mass between the phases")
    quarter = sp.pi / 2 / k_c
    bending = beta * k_c * sp.cos(k_c * x)
    segment = sp.integrate(bending, (x, -quarter, quarter)) - sp.integrate(bending, (x, quarter, 3 * quarter))
    force = sp.simplify(amplitude.piezo_moment() * segment * ring * k_c / (2 * sp.pi))
    ratio = omega_q / omega_n0
    resonator = sp.sqrt((1 - ratio**2) ** 2 + (2 * xi * ratio) ** 2)
    alone = amplitude.forced().subs(sym("omega_n")[0], omega_n0)
    _zero(force / (own * omega_n0**2 * resonator) - alone, "the forced amplitude without a rotor")
    return {
        "M_q": own,
        "F_ceramic": c_p * force,
        "F_measured": 2 * xi * omega_n0**2 * own * W_max,
    }


@cache
def elastic_energy() -> sp.Expr:
    """Of the layer under all crests, over the squares of W_c cos u - height; its slopes are the layer's forces.

    Raises
    ------
    CouplingError
        If the pressure's modal part is not its slope by the height of the wave, or the force not that by the rotor's.
    """
    pressed = W_c * sp.cos(_u) - height
    energy = n_j * k_N / (2 * k_c) * sp.integrate(sp.expand(pressed**2), (_u, -theta, theta))
    edge = sp.acos(height / W_c)
    pressure = k_N * pressed
    central_ = n_j / k_c * sp.integrate(sp.expand(pressure * sp.cos(_u)), (_u, -theta, theta))
    normal = n_j / k_c * sp.integrate(pressure, (_u, -theta, theta))
    _zero(energy.subs(theta, edge).diff(W_c) - central_.subs(theta, edge), "the modal part of the pressure")
    _zero(energy.subs(theta, edge).diff(height) + normal.subs(theta, edge), "the force on the rotor")
    whole = energy.subs(theta, sp.pi)
    _zero(whole.diff(W_c) - central_.subs(theta, sp.pi), "the modal part where the whole wave touches")
    _zero(whole.diff(height) + normal.subs(theta, sp.pi), "the force where the whole wave touches")
    return energy


@cache
def work() -> dict[str, sp.Expr]:
    """Modal forces of pressure and traction from their parts in cos u and sin u, by virtual work (eq. 11).

    ``central`` is the pressure's part in cos u, C and S are the traction's in cos u and sin u, over all crests.  C acts
    across the vector (w_A, w_B), it holds the wave back; S acts along it.

    Raises
    ------
    CouplingError
        If they do not do the work of pressure and traction on the surface.
    """
    C, S = sp.symbols("C_s S_s", real=True)
    zeta_z, zeta_x = surface.displacements(w_A, w_B).values()
    of_A = -central * sp.sin(_a) - D * k_c * (C * sp.cos(_a) - S * sp.sin(_a))
    of_B = -central * sp.cos(_a) + D * k_c * (S * sp.cos(_a) + C * sp.sin(_a))
    # a pressure and a traction that have those parts; other harmonics do no work on a wave of this length
    place = _u + _a
    at = {k_c * x: place}
    pressure, traction = central * sp.cos(_u) / sp.pi, (C * sp.cos(_u) + S * sp.sin(_u)) / sp.pi
    for coordinate, modal_force in ((w_A, of_A), (w_B, of_B)):
        virtual = -pressure * zeta_z.diff(coordinate).subs(at) - traction * zeta_x.diff(coordinate).subs(at)
        _zero(
            sp.integrate(sp.expand(sp.expand_trig(virtual)), (_u, -sp.pi, sp.pi)) - sp.expand_trig(modal_force), "work"
        )
    return {"Q_A": of_A, "Q_B": of_B}


@cache
def moments() -> dict[str, sp.Expr]:
    """Integrals from 0 to u of the pressure's share per angle, alone and times cos u and sin u; all of it is 1.

    Raises
    ------
    CouplingError
        If they are not.
    """
    density = (engagement * sp.cos(_u) + share) / 2
    found = {
        "1": (engagement * sp.sin(_u) + share * _u) / 2,
        "cos": (engagement * (_u + sp.sin(_u) * sp.cos(_u)) / 2 + share * sp.sin(_u)) / 2,
        "sin": (engagement * sp.sin(_u) ** 2 / 2 + share * (1 - sp.cos(_u))) / 2,
    }
    for name, weight in (("1", 1), ("cos", sp.cos(_u)), ("sin", sp.sin(_u))):
        _zero(found[name].diff(_u) - density * weight, f"the integral with {name}")
        _zero(found[name].subs(_u, 0), f"its start with {name}")
    return found


def _within(name: str, angle: sp.Expr) -> sp.Expr:
    """Twice the integral up to an angle: what lies between it and its mirror image."""
    return 2 * moments()[name].subs(_u, angle)


@cache
def reaction() -> dict[str, sp.Expr]:
    """Of a plain wave's contact on the wave, whose surface is faster than the rotor where |u| < alpha.

    ``f`` is the friction fraction of mu F_c and ``f_alpha`` its slope; ``central`` acts against the height of the wave
    and ``along`` against its running.  A contact near its crest reacts with F_c and, at stall, mu F_c.

    Raises
    ------
    CouplingError
        If a narrow contact does not react with F_c, or the surface's power is not the rotor's and slip's heat.
    """
    whole = _within("cos", theta)
    faster = _within("cos", alpha)
    fraction = 2 * _within("1", alpha) - 1
    found = {
        "f": fraction,
        "f_alpha": sp.diff(fraction, alpha),
        "central": F_c * whole,
        "along": mu * F_c * (2 * faster - whole),
    }
    carried = {engagement: 1 / (sp.sin(theta) - theta * sp.cos(theta))}
    carried[share] = -sp.cos(theta) * carried[engagement]
    narrow = sp.series(sp.simplify(whole.subs(carried)), theta, 0, 2).removeO()
    _zero(narrow - 1, "the reaction of a narrow contact over F_c")
    # heat of slip, mu p |v_x - v| with v_x = R_v cos u and v = R_v cos alpha, over half the contact
    density = engagement * sp.cos(_u) + share
    slip = density * (sp.cos(_u) - sp.cos(alpha))
    heat = sp.integrate(sp.expand(slip), (_u, 0, alpha)) - sp.integrate(sp.expand(slip), (_u, alpha, theta))
    total = {share: (1 - engagement * sp.sin(theta)) / theta}  # all of the pressure is F_c
    given = (2 * faster - whole) - sp.cos(alpha) * fraction
    _zero((heat - given).subs(total), "the power of the contact")
    return found


@cache
def balance() -> dict[str, sp.Expr]:
    """Balance of a plain wave of height W: what the modal force has to be, in phase with the wave and ahead of it.

    ``in_phase`` holds stiffness, inertia and central reaction, ``ahead`` damping and friction; the squares of both sum
    to that of F_q.  ``residual`` is what is left over, ``lead`` the angle by which the force is ahead of the wave.

    Raises
    ------
    CouplingError
        If the plain wave does not solve both phases' equations of motion with it.
    """
    in_phase = M_q * (omega_n0**2 - omega_q**2) * W + central
    ahead = 2 * xi * omega_n0 * M_q * omega_q * W + D * k_c * along
    t = sp.Symbol("t", real=True)
    turn = omega_q * t
    parts = {sp.Symbol("C_s", real=True): along, sp.Symbol("S_s", real=True): 0}
    modal_forces = {name: force.subs(parts).subs(_a, turn) for name, force in work().items()}
    for wave, of in ((W * sp.sin(turn), "Q_A"), (W * sp.cos(turn), "Q_B")):
        moved = M_q * (wave.diff(t, 2) + 2 * xi * omega_n0 * wave.diff(t) + omega_n0**2 * wave) - modal_forces[of]
        drive = in_phase * wave / W + ahead * wave.diff(t) / (omega_q * W)
        _zero(moved - drive, f"the equation of motion with {of}")
    return {
        "in_phase": in_phase,
        "ahead": ahead,
        "residual": in_phase**2 + ahead**2 - F_q**2,
        "lead": sp.atan2(ahead, in_phase),
    }


@cache
def swing() -> dict[str, sp.Expr]:
    """Steady swing of a phase that its modal force alone acts on, and the angle by which the force is ahead of it.

    It is the plain wave's balance without a contact, where both phases swing as if alone.

    Raises
    ------
    CouplingError
        If it is not the amplitude at resonance where the modal force is that of the measured amplitude.
    """
    alone = {central: 0, along: 0, W: 1}
    in_phase, ahead = (balance()[name].subs(alone) for name in ("in_phase", "ahead"))
    found = {"swing": F_q / sp.sqrt(in_phase**2 + ahead**2), "lead": sp.atan2(ahead, in_phase)}
    at_resonance = {omega_q: omega_n0, F_q: modal()["F_measured"].subs(modal()["M_q"], M_q)}
    _zero(found["swing"].subs(at_resonance) - W_max, "the swing at resonance")
    _zero(found["lead"].subs(omega_q, omega_n0) - sp.pi / 2, "the force's lead at resonance")
    return found


def resonance() -> sp.Expr:
    """Angular frequency at which a plain wave of height W swings by itself, its damping and friction made up for."""
    return sp.sqrt(omega_n0**2 + central / (M_q * W))


@cache
def without_contact() -> sp.Expr:
    """Natural frequency of the stator without a rotor, from the one that a wave of height W has with it.

    Raises
    ------
    CouplingError
        If :func:`resonance` does not lead back to the latter.
    """
    omega_n = sym("omega_n")[0]
    found = sp.sqrt(omega_n**2 - central / (M_q * W))
    _zero(resonance().subs(omega_n0, found) - omega_n, "the resonance with the contact")
    return found


@cache
def held_height() -> sp.Expr:
    """Height of a wave that stands still and that friction alone holds, of the traction's part in cos u.

    Raises
    ------
    CouplingError
        If the mode's stiffness and the traction, without pressure, motion and force, are not as large.
    """
    found = D * k_c * along / (M_q * omega_n0**2)
    still = {central: 0, omega_q: 0, W: found}
    in_phase, ahead = (balance()[name].subs(still) for name in ("in_phase", "ahead"))
    _zero(in_phase - ahead, "stiffness and traction of a wave that is held")
    return found


@cache
def powers() -> dict[str, sp.Expr]:
    """Mean powers of a plain wave: put in, lost in the stator, given to the contact, lost by slip, on the rotor.

    ``P_in`` is what the forces do where the balance holds, F_q W omega_q sin(lead) of two phases in quadrature.

    Raises
    ------
    CouplingError
        If stator, contact and rotor do not share the power that goes in.
    """
    given = balance()["ahead"] * omega_q * W
    fraction = sym("f")[0]
    found = {
        "P_in": given,
        "P_stator": 2 * xi * omega_n0 * M_q * omega_q**2 * W**2,
        "P_contact": D * k_c * omega_q * W * along,
        "P_slip": D * k_c * omega_q * W * along - mu * F_c * fraction * v,
        "P_rotor": mu * F_c * fraction * v,
    }
    _zero(found["P_in"] - found["P_stator"] - found["P_slip"] - found["P_rotor"], "the powers")
    lead = balance()["lead"]
    force = sp.sqrt(balance()["in_phase"] ** 2 + balance()["ahead"] ** 2)
    _zero(
        sp.powdenest(sp.simplify(force * sp.sin(lead) * omega_q * W - found["P_in"]), force=True), "the force's power"
    )
    return found


@cache
def flow() -> dict[str, sp.Expr]:
    """What displacement and velocity of a phase that nothing acts on become in the time tau, each of each.

    Raises
    ------
    CouplingError
        If they do not move as the phase's free oscillator, from what they are at tau = 0.
    """
    tau = sym("tau")[0]
    omega_d = omega_n0 * sp.sqrt(1 - xi**2)
    decay, sine, cosine = sp.exp(-xi * omega_n0 * tau), sp.sin(omega_d * tau), sp.cos(omega_d * tau)
    lag = xi / sp.sqrt(1 - xi**2) * sine
    moved = sp.Matrix(
        [
            [decay * (cosine + lag), decay * sine / omega_d],
            [-(omega_n0**2) * decay * sine / omega_d, decay * (cosine - lag)],
        ]
    )
    oscillator = sp.Matrix([[0, 1], [-(omega_n0**2), -2 * xi * omega_n0]])
    for gap in (*(moved.diff(tau) - oscillator * moved), *(moved.subs(tau, 0) - sp.eye(2))):
        _zero(gap, "a phase that moves freely")
    return dict(zip(("w_w", "w_v", "v_w", "v_v"), moved, strict=True))


def instant() -> dict[str, sp.Expr]:
    """Wave, surface speed and contact at any displacements and velocities of the phases and any height of the rotor."""
    length = sp.sqrt(w_A**2 + w_B**2)
    q, growth = v_A * w_B - v_B * w_A, w_A * v_A + w_B * v_B
    size = sp.sqrt(q**2 + growth**2) + TINY
    cosine = sp.Max(-1, sp.Min(1, height / (length + TINY)))
    sine = sp.sqrt((1 - cosine) * (1 + cosine))
    per_height = rotor.coefficients()["engagement_per_height"]
    return {
        "W_c": length,
        "sin_crest": w_A / (length + TINY),
        "cos_crest": w_B / (length + TINY),
        "R_v": D * k_c * sp.sqrt(v_A**2 + v_B**2),
        "phi": sp.atan2(-growth, q),
        "cos_phi": q / size,
        "sin_phi": -growth / size,
        "theta": sp.atan2(sine, cosine),
        "sin_theta": sine,
        "cos_theta": cosine,
        "engagement": per_height * length,
        "share": -per_height * height,
    }


@cache
def forces() -> dict[str, sp.Expr]:
    """Of the contact at any instant: on the rotor upward and along, and on both modes, by virtual work.

    The surface is faster than the rotor between the two points where it is as fast
    (:func:`derivations.rotor.friction`); here engagement and share need not carry F_c, since the rotor moves up and
    down.
    """
    ends = {
        "1": engagement * sin_theta + share * theta,
        "cos": engagement * (theta + sin_theta * cos_theta) / 2 + share * sin_theta,
        "sin": sp.Integer(0),
    }
    between: dict[str, sp.Expr] = dict.fromkeys(ends, sp.Integer(0))
    for sign, (turns, u, sin_u, inside, cos_u) in zip((1, -1), rotor.nonsliding(), strict=True):
        clipped = inside * cos_u + (1 - inside) * cos_theta
        up_to = {
            "1": (engagement * sin_u + share * u) / 2,
            "cos": (engagement * (u + sin_u * clipped) / 2 + share * sin_u) / 2,
            "sin": (engagement * sin_u**2 / 2 + share * (1 - clipped)) / 2,
        }
        for name in between:
            between[name] += sign * (turns * ends[name] + up_to[name])
    parts = {name: mu * F_c * (2 * between[name] - ends[name]) for name in ends}
    crest = {sp.sin(_a): sin_crest, sp.cos(_a): cos_crest, central: F_c * ends["cos"]}
    crest |= {sp.Symbol("C_s", real=True): parts["cos"], sp.Symbol("S_s", real=True): parts["sin"]}
    modal_forces = {name: force.subs(crest) for name, force in work().items()}
    return {"F_z": F_c * ends["1"], "F_x": parts["1"], **modal_forces}
