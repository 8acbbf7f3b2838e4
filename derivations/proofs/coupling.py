"""Proofs of the kernels of the rotor's reaction on the wave: modal mass and forces, plain wave, any instant."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from functools import partial
from itertools import pairwise

import mpmath as mp

from derivations.proofs.contact import TINY, balanced
from derivations.proofs.friction import changes, states
from derivations.proofs.maths import NUMBERS, Maths, Number, Point
from derivations.proofs.proof import Proof, draw, grid

__all__ = ["PROOFS"]

Found = Mapping[str, Number | None]


def _modal(p: Point, m: Maths) -> Found:
    """Twice the kinetic energy of a mode at unit speed; the ceramic's work; the damping's force at resonance."""
    zero = 0 * p.k_c
    wave = m.integral(
        lambda angle: p.rho * (p.A * m.cos(angle) ** 2 + p.I_z * (p.beta * m.sin(angle)) ** 2), zero, 2 * m.pi
    )
    mass = p.n_j * wave / p.k_c
    arm = p.h_e + p.h_p / 2 - p.D
    moment = m.absolute(p.d_31) * p.U_s / (p.s_11E * p.h_p) * p.b_p * p.h_p * arm
    work = p.c_p * p.n_j * 4 * m.integral(lambda angle: moment * p.beta * m.cos(angle), zero, m.pi / 2)
    speed = p.omega_n0 * p.W_max
    return {"M_q": mass, "F_ceramic": work, "F_measured": 2 * p.xi * p.omega_n0 * mass * speed}


def _reaction(p: Point, m: Maths) -> Found:
    """Pressure and friction, a sign times the pressure, summed over the contact, alone and times cos u."""

    def over(weight: Callable[[Number], Number], low: Number, high: Number) -> Number:
        return m.integral(lambda u: (p.engagement * m.cos(u) + p.share) / 2 * weight(u), low, high)

    def slipping(weight: Callable[[Number], Number], alpha: Number) -> Number:
        sides = over(weight, -p.theta, -alpha) + over(weight, alpha, p.theta)
        return over(weight, -alpha, alpha) - sides

    all_of_it = over(lambda u: u**0, -p.theta, p.theta)  # 1 where the contact carries its load

    def fraction(alpha: Number) -> Number:
        return slipping(lambda u: u**0, alpha) + all_of_it - 1

    return {
        "f": fraction(p.alpha),
        "f_alpha": m.derivative(fraction, p.alpha),
        "central": p.F_c * over(m.cos, -p.theta, p.theta),
        "along": p.mu * p.F_c * slipping(m.cos, p.alpha),
    }


def _loaded(values: dict[str, Number], at: random.Random) -> None:
    """A contact that carries its load, and a part of it that is faster than the rotor."""
    balanced(values, at)
    values["alpha"] = values["theta"] * mp.mpf(at.uniform(0.05, 0.95))


def _balance(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Dynamic stiffness and reaction as complex numbers; the frequency at which their real part is 0, by secants."""

    def force(omega: Number) -> Number:
        stiffness = p.M_q * mp.mpc(p.omega_n0**2 - omega**2, 2 * p.xi * p.omega_n0 * omega)
        return stiffness * p.W + mp.mpc(p.central, p.D * p.k_c * p.along)

    whole = force(p.omega_q)
    before, at = p.omega_n0, p.omega_n0 * mp.mpf("1.001")
    for _ in range(14):
        one, other = force(before).real, force(at).real
        if one == other:
            break
        before, at = at, at - other * (at - before) / (other - one)
    return {
        "in_phase": whole.real,
        "ahead": whole.imag,
        "residual": abs(whole) ** 2 - p.F_q**2,
        "lead": mp.arg(whole),
        "omega_r": at,
    }


def _powers(p: Point, m: Maths) -> Found:
    """Means over a period of force times speed: damping on phases, traction on the surface, friction on the rim."""
    period = 2 * m.pi / p.omega_q
    size = p.omega_q * p.W

    def damped(t: Number) -> Number:
        speeds = (size * m.cos(p.omega_q * t), size * m.sin(p.omega_q * t))
        return sum(2 * p.xi * p.omega_n0 * p.M_q * speed**2 for speed in speeds)

    stator = m.integral(damped, 0 * period, period) / period
    surface = m.integral(
        lambda u: p.along * m.cos(u) / m.pi * (p.D * p.k_c * size * m.cos(u)), -m.pi + 0 * p.W, m.pi + 0 * p.W
    )
    rim = p.f * p.mu * p.F_c * p.v
    return {
        "P_in": stator + surface,
        "P_stator": stator,
        "P_contact": surface,
        "P_slip": surface - rim,
        "P_rotor": rim,
    }


def _swing(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The phase's equation of motion for complex amplitudes: the force over the swing that it makes."""
    over = p.M_q * (-(p.omega_q**2) + 2 * p.xi * p.omega_n0 * mp.mpc(0, p.omega_q) + p.omega_n0**2)
    return {"swing": abs(p.F_q / over), "lead": mp.arg(over)}


def _held(p: Point, m: Maths) -> Found:
    """Where the strain energy of a wave at rest grows with its height as fast as the traction takes up work."""

    def work(height: Number) -> Number:
        """Of a traction along cos(u) / pi, as the wave's displacement along the surface grows with its height."""
        whole = (-m.pi + 0 * height, m.pi + 0 * height)
        return m.integral(lambda u: p.along * m.cos(u) / m.pi * (p.D * p.k_c * height * m.cos(u)), *whole)

    def energy(height: Number) -> Number:
        """Of twice the kinetic energy that the mode has as it passes zero, over two."""
        return p.M_q * (p.omega_n0 * height) ** 2 / 2

    one = 0 * p.along + 1
    return {"W_held": m.derivative(work, one) / m.derivative(energy, one)}


def _flow(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The exponential of the oscillator's matrix."""
    moved = mp.expm(mp.matrix([[0, 1], [-(p.omega_n0**2), -2 * p.xi * p.omega_n0]]) * p.tau)
    return {"w_w": moved[0, 0], "w_v": moved[0, 1], "v_w": moved[1, 0], "v_v": moved[1, 1]}


def _instant(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """The crest as a complex number's angle; the surface's speed there and a quarter wave on; where the layer ends."""
    crest = mp.mpc(p.w_B, p.w_A)
    size, angle = abs(crest), mp.arg(crest)

    def speed(u: Number) -> Number:
        return p.D * p.k_c * (p.v_A * mp.cos(angle + u) - p.v_B * mp.sin(angle + u))

    there = mp.mpc(speed(mp.mpf(0)), speed(mp.pi / 2))
    free = p.height / size
    theta = mp.mpf(0) if free >= 1 else +mp.pi if free <= -1 else mp.acos(free)
    spring = p.n_j * p.k_N / p.k_c * 2  # of all crests, per radian to either side
    return {
        "W_c": size,
        "sin_crest": mp.sin(angle),
        "cos_crest": mp.cos(angle),
        "R_v": abs(there),
        "phi": mp.arg(there),
        "cos_phi": there.real / abs(there),
        "sin_phi": there.imag / abs(there),
        "theta": theta,
        "sin_theta": mp.sin(theta) if abs(free) < 1 else mp.mpf(0),
        "cos_theta": mp.cos(theta),
        "engagement": spring * size / p.F_c,
        "share": -spring * p.height / p.F_c,
    }


def _moving(values: dict[str, Number], at: random.Random) -> None:
    """Heights at which the wave is clear of the rotor, touches partly, or all round."""
    values["v_A"], values["v_B"] = (mp.mpf(at.uniform(-1, 1)) for _ in range(2))
    size = mp.sqrt(values["w_A"] ** 2 + values["w_B"] ** 2)
    values["height"] = size * mp.mpf(at.choice((at.uniform(-3, -1.01), at.uniform(-0.99, 0.99), at.uniform(1.01, 2))))


def _forces(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Pressure and traction summed over the contact, alone and times what the surface moves with each phase."""
    angle = mp.arg(mp.mpc(p.cos_crest, p.sin_crest))
    stops = [-p.theta, *changes(p), p.theta]

    def pressure(u: Number) -> Number:
        return p.F_c * (p.engagement * mp.cos(u) + p.share) / 2

    def over(of: Callable[[Number, Number, Number], Number]) -> Number:
        """Of a function of place, pressure and traction."""
        total = mp.mpf(0)
        for low, high in pairwise(stops):
            way = 1 if p.R_v * mp.cos((low + high) / 2 - p.phi) > p.v else -1
            total += NUMBERS.integral(partial(_element, of, pressure, way * p.mu), low, high)
        return total

    lever = p.D * p.k_c
    return {
        "F_z": over(lambda u, press, pull: press),  # noqa: ARG005
        "F_x": over(lambda u, press, pull: pull),  # noqa: ARG005
        "Q_A": -over(lambda u, press, pull: press * mp.sin(u + angle) + pull * lever * mp.cos(u + angle)),
        "Q_B": -over(lambda u, press, pull: press * mp.cos(u + angle) - pull * lever * mp.sin(u + angle)),
    }


def _element(
    of: Callable[[Number, Number, Number], Number], pressure: Callable[[Number], Number], drag: Number, u: Number
) -> Number:
    return of(u, pressure(u), drag * pressure(u))


def _contacts() -> list[Point]:
    """The states of friction's proof, with crests anywhere, pressed by other than the prepressure."""
    found = []
    for index, point in enumerate(states()):
        at = random.Random(f"contact {index}")
        crest, pressed = mp.mpf(at.uniform(-3.1, 3.1)), mp.mpf(at.uniform(0.3, 3))
        found.append(
            point.with_(
                **{name: draw(name, index) for name in ("D", "F_c", "k_c", "mu")},
                sin_crest=mp.sin(crest),
                cos_crest=mp.cos(crest),
                cos_theta=mp.cos(point.theta),
                engagement=pressed * point.engagement,
                share=pressed * point.share,
            )
        )
    return found


def _faster() -> list[Point]:
    """The same contacts under a rotor that is faster than all of the surface, one way or the other."""
    return [p.with_(v=p.R_v * way * mp.mpf("1.3")) for p, way in zip(_contacts()[:8], (1, -1) * 4, strict=True)]


def _standing() -> list[Point]:
    """Surface and rotor stand still."""
    return [_contacts()[0].with_(R_v=mp.mpf(0), v=mp.mpf(0), tiny=TINY)]


def _held_up(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """What the pressure alone does; friction of what does not slip is any, but finite."""
    return {"F_z": p.F_c * (p.engagement * p.sin_theta + p.share * p.theta), "F_x": None, "Q_A": None, "Q_B": None}


def _apart() -> list[Point]:
    """A wave that is clear of the rotor."""
    return [_contacts()[0].with_(theta=mp.mpf(0), sin_theta=mp.mpf(0), cos_theta=mp.mpf(1), tiny=TINY)]


def _nothing(p: Point, m: Maths) -> Found:  # noqa: ARG001
    return dict.fromkeys(("F_z", "F_x", "Q_A", "Q_B"), mp.mpf(0))


def _no_wave() -> list[Point]:
    """Both phases at rest, under a rotor that presses and under one that is clear."""
    still = grid("D F_c height k_N k_c n_j v_A v_B w_A w_B", 2, _moving)()
    zero = mp.mpf(0)
    stopped = dict.fromkeys(("w_A", "w_B", "v_A", "v_B"), zero)
    return [p.with_(**stopped, height=at * mp.mpf("1e-6"), tiny=TINY) for p, at in zip(still, (-1, 1), strict=True)]


def _flat(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """A surface without a crest touches all round or nowhere."""
    theta = +mp.pi if p.height < 0 else mp.mpf(0)
    spring = p.n_j * p.k_N / p.k_c * 2
    zero = dict.fromkeys(("W_c", "sin_crest", "cos_crest", "R_v", "sin_theta", "engagement"), mp.mpf(0))
    return {**zero, "theta": theta, "cos_theta": mp.cos(theta), "share": -spring * p.height / p.F_c}


_RESTS = "wave-reaction"
PROOFS = (
    Proof(
        "trum_modal",
        "M_q F_ceramic F_measured",
        f"7 {_RESTS}",
        "twice the kinetic energy at unit speed; the ceramic's work on the mode; damping's force at resonance",
        _modal,
        grid("A D I_z U_s W_max b_p beta c_p d_31 h_e h_p k_c n_j omega_n0 rho s_11E xi"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_plain_reaction",
        "f f_alpha central along",
        f"30 36 {_RESTS}",
        "pressure and friction summed over the contact, alone and times cos u",
        _reaction,
        grid("F_c mu", 12, _loaded),
        "random contacts that carry their load, partial and full",
    ),
    Proof(
        "trum_plain_balance",
        "in_phase ahead residual lead omega_r",
        _RESTS,
        "dynamic stiffness and reaction as complex numbers; where the real part is 0",
        _balance,
        grid("D F_q M_q W along central k_c omega_n0 omega_q xi", 12),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_plain_powers",
        "P_in P_stator P_contact P_slip P_rotor",
        _RESTS,
        "means over a period of force times speed",
        _powers,
        grid("D F_c M_q W along f k_c mu omega_n0 omega_q v xi"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_mode_swing",
        "swing lead",
        f"7 {_RESTS}",
        "the phase's equation of motion for complex amplitudes",
        _swing,
        grid("F_q M_q omega_n0 omega_q xi", 12),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_held_wave",
        "W_held",
        _RESTS,
        "slopes of strain energy and of the traction's work by the height",
        _held,
        grid("D M_q along k_c omega_n0"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_engagement",
        "engagement_per_height",
        "30 31",
        "force of all crests under a wave that just touches all round, over the prepressure, for pi",
        lambda p, m: {
            "engagement_per_height": p.n_j
            * m.integral(lambda u: p.k_N * (m.cos(u) + 1), -m.pi + 0 * p.k_c, m.pi + 0 * p.k_c)
            / (m.pi * p.k_c * p.F_c)
        },
        grid("F_c k_N k_c n_j"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_mode_flow",
        "w_w w_v v_w v_v",
        f"9 10 {_RESTS}",
        "the exponential of the oscillator's matrix",
        _flow,
        grid("omega_n0 tau xi"),
        "random times up to eight periods",
    ),
    Proof(
        "trum_coupled_instant",
        "W_c sin_crest cos_crest R_v phi cos_phi sin_phi theta sin_theta cos_theta engagement share",
        f"11 16 20 31 {_RESTS}",
        "the crest as a complex number; the surface's speed at two places; where the layer ends",
        _instant,
        grid("D F_c height k_N k_c n_j v_A v_B w_A w_B", 18, _moving),
        "random instants: clear of the rotor, touching partly, all round",
    ),
    Proof(
        "trum_coupled_instant",
        "W_c sin_crest cos_crest R_v theta sin_theta cos_theta engagement share",
        _RESTS,
        "without a crest all round or nowhere",
        _flat,
        _no_wave,
        "no wave",
    ),
    Proof(
        "trum_coupled_forces",
        "F_z F_x Q_A Q_B",
        f"11 30 36 {_RESTS}",
        "pressure and traction summed over the contact, times what the surface moves with each phase",
        _forces,
        _contacts,
        "64 states: points as fast as the rotor inside, beside, far from the contact, about half a turn",
    ),
    Proof(
        "trum_coupled_forces",
        "F_z F_x Q_A Q_B",
        f"36 {_RESTS}",
        "the same, all friction one way",
        _forces,
        _faster,
        "a rotor beyond the surface's speeds, either way",
    ),
    Proof(
        "trum_coupled_forces",
        "F_z F_x Q_A Q_B",
        _RESTS,
        "the layer's force; friction finite",
        _held_up,
        _standing,
        "surface and rotor at rest",
    ),
    Proof(
        "trum_coupled_forces",
        "F_z F_x Q_A Q_B",
        _RESTS,
        "no contact, no force",
        _nothing,
        _apart,
        "a wave that is clear of the rotor",
    ),
)
