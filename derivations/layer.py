"""A layer that loses energy, or is sheared, under a plain wave that the rotor acts back on (our own).

**Loss.**  An element of the layer is a spring beside a dashpot (Kelvin and Voigt): pressed in by d, it pushes with
k_N (d + (eta / omega_q) d'), eta its loss factor at the drive's frequency, and it only pushes.  The wave runs towards
greater u, so d' of d = W cos u - height is omega_q W sin u, and the pressure over k_N W is

    cos u + eta sin u - level = sqrt(1 + eta^2) cos(u - atan eta) - level,    level = height / W.

It is greatest ahead of the crest, at atan eta.  An element meets the surface ahead of the crest, at ``u_in``, where the
wave is rising against it, so that the pressure begins with a jump.  It leaves behind the crest, at ``u_out``, where the
pressure ends; there it is still pressed in, by eta sin(-u_out) W, and recovers by itself: as exp(-phi / eta) while the
wave runs on by phi.  Where the surface comes up to it again, after phi = ``free``, contact begins anew.

What decides all this is one angle, ``leaving`` = atan eta - u_out, from the pressure's peak back to the contact's end:
level = sqrt(1 + eta^2) cos(leaving).  As it grows from atan eta to pi, the contact widens at both ends and carries
more, so that for each load there is one (:func:`meeting`, :func:`carried`).  At pi the whole wave touches.

**Shear.**  Bristles as in :mod:`derivations.brush`, on a contact that carries the prepressure.  Where the whole wave
touches, no bristle leaves, and its stress has to come back to itself after a turn.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations import brush, coupling, surface
from derivations.coupling import CouplingError
from derivations.nomenclature import sym
from derivations.rotor import less

__all__ = [
    "balance",
    "carried",
    "meeting",
    "moments",
    "passage",
    "powers",
    "reaction",
    "resonance",
    "sheared",
    "stuck",
    "without_contact",
]

eta, leaving, free, u_in, u_out, zone_low, zone_high = sym("eta_m leaving free u_in u_out zone_low zone_high")
engagement, share, F_c, mu, W = sym("engagement share F_c mu W")
central, along, across, lossy = sym("central along across lossy")
D, k_c, omega_q, v, f, k_N, n_j = sym("D k_c omega_q v f k_N n_j")
grip, ratio, theta, u, u_0, t_0, level = sym("grip ratio theta u u_0 t_0 level")
sheared_1, sheared_cos, sheared_sin, sheared_ratio = sym("sheared sheared_cos sheared_sin sheared_ratio")
_u, _s = sp.symbols("u_s s_s", real=True)
_turn = 2 * sp.pi


def _zero(expression: sp.Expr, what: str) -> None:
    waves = sp.powsimp(sp.expand(expression.rewrite(sp.exp)))
    if sp.expand(waves) != 0 and sp.simplify(sp.expand(sp.expand_trig(expression))) != 0:
        raise CouplingError(f"{what}: {sp.simplify(expression)} is not 0")


_out, _in = sp.symbols("out_s in_s", real=True)
_EXPM1 = sp.Function("expm1")
_LEVEL = sp.cos(_out) + eta * sp.sin(_out)
_ENDS = {_out: sp.atan(eta) - leaving, _in: sp.atan(eta) - leaving + _turn - free}
"""Where the layer leaves, and where it meets the surface again, by ``leaving`` and ``free``."""


def _plain(expression: sp.Expr) -> sp.Expr:
    return expression.replace(_EXPM1, lambda x: sp.exp(x) - 1)


def _gap() -> sp.Expr:
    lost = -eta * _EXPM1(-free / eta)
    return sp.sin(_out) * (sp.sin(free) - lost) - 2 * sp.cos(_out) * sp.sin(free / 2) ** 2


@cache
def meeting() -> dict[str, sp.Expr]:
    """How high the surface is above a layer that recovers, over W, after the wave has moved on by ``free``; its slope.

    Both are 0 at first.  The surface falls below the layer and comes up once, to where contact begins, at ``u_in``.

    Raises
    ------
    CouplingError
        If it is not what surface and recovering layer are apart, or does not start with a slope of 0.
    """
    gap, slope = _gap(), sp.sin(_out - free) - sp.sin(_out) * (_EXPM1(-free / eta) + 1)
    kept = -eta * sp.sin(_out) * sp.exp(-free / eta)
    _zero(_plain(gap) - (sp.cos(_out - free) - _LEVEL - kept), "the surface over the recovering layer")
    _zero(_plain(gap).diff(free) - _plain(slope), "its slope")
    _zero(_plain(slope).subs(free, 0), "its slope at the start")
    greatest = sp.atan(eta)
    _zero(_LEVEL.subs(_out, greatest - leaving) - sp.sqrt(1 + eta**2) * sp.cos(leaving), "the level")
    return {
        name: expr.subs(_ENDS) for name, expr in (("gap", gap), ("gap_free", slope), ("u_in", _in), ("u_out", _out))
    }


@cache
def carried() -> dict[str, sp.Expr]:
    """The layer's force over the prepressure, its slope by ``leaving``, and the pressure's constant part.

    ``engagement`` is 2 n_j k_N W / (k_c F_c), so that the pressure's share per angle is
    (engagement (cos u + eta sin u) + share) / 2.  Both terms of the slope are at least 0: the contact deepens
    everywhere, by engagement sqrt(1 + eta^2) sin(leaving) / 2, and its beginning, where pressure jumps, moves ahead.

    Raises
    ------
    CouplingError
        If the slope is not that along contacts that begin where surface and recovering layer meet.
    """
    density = engagement * (sp.cos(_u) + eta * sp.sin(_u) - _LEVEL) / 2
    force = sp.integrate(density, (_u, _out, _in))
    kept = sp.exp(-free / eta)
    deeper = eta * sp.cos(_out) - sp.sin(_out)
    ahead = deeper * (1 - kept) / (sp.sin(_in) - sp.sin(_out) * kept)  # d u_in / d leaving
    deepens = engagement * deeper * (_in - _out) / 2
    _zero(-force.diff(_out) - deepens, "what the contact carries as it deepens")
    _zero(force.diff(_in) - density.subs(_u, _in), "what its beginning adds")
    _zero(deeper.subs(_out, sp.atan(eta) - leaving) - sp.sqrt(1 + eta**2) * sp.sin(leaving), "how much deeper")
    # where they meet, gap is 0 and u_in = u_out + 2 pi - free: (d u_in + d leaving) gap_free = -d gap / d leaving
    meets = {_in: _out - free}
    gap = _plain(_gap())
    _zero(ahead.subs(meets) * gap.diff(free) + gap.diff(free) + gap.diff(_out), "how the meeting moves")
    found = {
        "carried": force,
        "carried_leaving": deepens + density.subs(_u, _in) * ahead,
        "share": -engagement * _LEVEL,
    }
    return {name: expr.subs(_ENDS) for name, expr in found.items()}


@cache
def moments() -> dict[str, sp.Expr]:
    """Integrals from 0 to u of the pressure's share per angle, alone and times cos u and sin u; all of it is 1.

    Raises
    ------
    CouplingError
        If they are not.
    """
    density = (engagement * (sp.cos(_u) + eta * sp.sin(_u)) + share) / 2
    sine, cosine = sp.sin(_u), sp.cos(_u)
    found = {
        "1": (engagement * (sine + eta * (1 - cosine)) + share * _u) / 2,
        "cos": (engagement * (_u + sine * cosine + eta * sine**2) / 2 + share * sine) / 2,
        "sin": (engagement * (sine**2 + eta * (_u - sine * cosine)) / 2 + share * (1 - cosine)) / 2,
    }
    for name, weight in (("1", 1), ("cos", cosine), ("sin", sine)):
        _zero(found[name].diff(_u) - density * weight, f"the integral with {name}")
        _zero(found[name].subs(_u, 0), f"its start with {name}")
    return found


@cache
def reaction() -> dict[str, sp.Expr]:
    """Of a lossy contact from ``u_out`` to ``u_in`` on the wave, its driving zone from ``zone_low`` to ``zone_high``.

    A contact may reach beyond half a wave, into the zone of the next one; both are within a turn of the crest.  ``f``
    is the friction fraction, ``f_alpha`` its slope as the zone widens at both ends.  ``central`` acts against the
    height of the wave, ``lossy`` and friction's ``along`` against its running, friction's ``across`` along the
    height.

    Raises
    ------
    CouplingError
        If the layer does not lose what its pressure takes: in contact k_N (eta / omega_q) d'^2, and what an element
        that leaves keeps, less what it has when it meets the surface; pi eta k_N W^2 omega_q n_j / k_c where the whole
        wave touches.
    """

    def held(place: sp.Expr) -> sp.Expr:
        return sp.Max(u_out, sp.Min(u_in, place))

    def up_to(name: str, place: sp.Expr) -> sp.Expr:
        return moments()[name].subs(_u, place)

    before, after = zone_high - _turn, zone_low + _turn  # the zone of the wave before, and of the next

    def within(name: str) -> sp.Expr:
        own = up_to(name, held(zone_high)) - up_to(name, held(zone_low))
        behind = up_to(name, sp.Max(u_out, before)) - up_to(name, u_out)
        return own + behind + up_to(name, u_in) - up_to(name, sp.Min(u_in, after))

    def over(name: str) -> sp.Expr:
        return up_to(name, u_in) - up_to(name, u_out)

    def density(place: sp.Expr) -> sp.Expr:
        return (engagement * (sp.cos(place) + eta * sp.sin(place)) + share) / 2

    def inside(place: sp.Expr) -> sp.Expr:
        return less(u_out, place) * less(place, u_in)

    _layer_takes()
    slope = inside(zone_high) * density(zone_high) + inside(zone_low) * density(zone_low)
    slope += less(u_out, before) * density(before) + less(after, u_in) * density(after)
    return {
        "f": 2 * within("1") - 1,
        "f_alpha": 2 * slope,
        "central": F_c * over("cos"),
        "lossy": F_c * over("sin"),
        "along": mu * F_c * (2 * within("cos") - over("cos")),
        "across": mu * F_c * (2 * within("sin") - over("sin")),
    }


def _layer_takes() -> None:
    """Raise a CouplingError unless the pressure's part in sin u is what the layer loses, over omega_q W."""
    level, start, end = sp.symbols("level_s start_s end_s", real=True)
    depth = sp.cos(_u) - level
    taken = sp.integrate(sp.expand((depth + eta * sp.sin(_u)) * sp.sin(_u)), (_u, start, end))
    in_contact = sp.integrate(eta * sp.sin(_u) ** 2, (_u, start, end))
    kept = (depth.subs(_u, start) ** 2 - depth.subs(_u, end) ** 2) / 2
    _zero(taken - in_contact - kept, "what the layer loses")
    whole = sp.integrate(sp.expand((depth + eta * sp.sin(_u)) * sp.sin(_u)), (_u, -sp.pi, sp.pi))
    _zero(whole - sp.pi * eta, "what a layer loses that touches all of the wave")


_ALSO = {central: central - D * k_c * across, along: along + lossy / (D * k_c)}
"""What a layer adds to the reaction that :func:`derivations.coupling.balance` knows."""


@cache
def balance() -> dict[str, sp.Expr]:
    """Balance of a plain wave as :func:`derivations.coupling.balance` has it, with all four parts of the reaction.

    Raises
    ------
    CouplingError
        If the plain wave does not solve both phases' equations of motion with it.
    """
    found = {name: sp.expand(expr.subs(_ALSO, simultaneous=True)) for name, expr in coupling.balance().items()}
    found["residual"] = found["in_phase"] ** 2 + found["ahead"] ** 2 - coupling.F_q**2
    found["lead"] = sp.atan2(found["ahead"], found["in_phase"])
    _moves(found)
    return found


def _moves(found: dict[str, sp.Expr]) -> None:
    """Raise a CouplingError unless virtual work on both phases, eq. 11, has the sum of stress and pressure act so."""
    t = sp.Symbol("t", real=True)
    w_A, w_B = coupling.w_A, coupling.w_B
    place, turn = _u + omega_q * t, omega_q * t
    pressure = (central * sp.cos(_u) + lossy * sp.sin(_u)) / sp.pi
    traction = (along * sp.cos(_u) + across * sp.sin(_u)) / sp.pi
    zeta_z, zeta_x = surface.displacements(w_A, w_B).values()
    at = {k_c * coupling.x: place}
    own = coupling.M_q, coupling.xi, coupling.omega_n0
    for wave, coordinate in ((W * sp.sin(turn), w_A), (W * sp.cos(turn), w_B)):
        virtual = -pressure * zeta_z.diff(coordinate).subs(at) - traction * zeta_x.diff(coordinate).subs(at)
        reacts = sp.integrate(sp.expand(sp.expand_trig(virtual)), (_u, -sp.pi, sp.pi))
        moved = own[0] * (wave.diff(t, 2) + 2 * own[1] * own[2] * wave.diff(t) + own[2] ** 2 * wave) - reacts
        drive = found["in_phase"] * wave / W + found["ahead"] * wave.diff(t) / (omega_q * W)
        _zero(moved - drive, f"the equation of motion of {coordinate}")


def resonance() -> sp.Expr:
    """Angular frequency at which a plain wave of height W swings by itself, what it loses made up for."""
    return coupling.resonance().subs(_ALSO, simultaneous=True)


def without_contact() -> sp.Expr:
    """Natural frequency of the stator without a rotor, from the one that a wave of height W has with it."""
    return coupling.without_contact().subs(_ALSO, simultaneous=True)


@cache
def powers() -> dict[str, sp.Expr]:
    """Mean powers of a plain wave over such a layer; ``P_contact`` is what the surface gives to friction and layer.

    Raises
    ------
    CouplingError
        If stator, layer, slip and rotor do not share the power that goes in.
    """
    layer = omega_q * W * lossy
    found = {
        "P_in": sp.expand(balance()["ahead"]) * omega_q * W,
        "P_stator": coupling.powers()["P_stator"],
        "P_contact": D * k_c * omega_q * W * along + layer,
        "P_layer": layer,
        "P_slip": D * k_c * omega_q * W * along - mu * F_c * f * v,
        "P_rotor": mu * F_c * f * v,
    }
    _zero(
        found["P_in"] - found["P_stator"] - found["P_layer"] - found["P_slip"] - found["P_rotor"],
        "the powers",
    )
    return found


@cache
def passage() -> dict[str, sp.Expr]:
    """A bristle's stress and limit as in :func:`derivations.brush.passage`, their integrals times cos u and sin u.

    ``stuck_ratio`` is how the integral of the stress follows the rotor's speed: where a bristle begins to stick, stress
    and limit grow alike, so that this place may move without changing it.  The layer's level over W is cos theta where
    the contact is partial, and below -1 where the whole wave touches.

    Raises
    ------
    CouplingError
        If these are not the integrals.
    """
    way = u - u_0
    swept, raised = 2 * sp.cos((u + u_0) / 2) * sp.sin(way / 2), 2 * sp.sin((u + u_0) / 2) * sp.sin(way / 2)
    twice = sp.cos(u + u_0) * sp.sin(way) / 2
    found = {name: expr.subs(sp.cos(theta), level) for name, expr in brush.passage().items()}
    found |= {
        "stuck_cos": t_0 * swept + grip * (swept**2 / 2 - ratio * (way * sp.sin(u) - raised)),
        "stuck_sin": t_0 * raised + grip * (way / 2 - twice - sp.sin(u_0) * raised - ratio * (swept - way * sp.cos(u))),
        "slid_cos": way / 2 + twice - level * swept,
        "slid_sin": swept * (sp.sin(u) + sp.sin(u_0)) / 2 - level * raised,
        "stress_u": grip * (sp.cos(u) - ratio),
        "limit_u": -sp.sin(u),
        "stuck_ratio": found["stuck"].diff(ratio),
    }
    _zero(found["stress"].diff(u) - found["stress_u"], "the stress's slope")
    _zero(found["limit"].diff(u) - found["limit_u"], "the limit's slope")
    for kind, density in (("stuck", found["stress"]), ("slid", found["limit"])):
        for name, weight in (("", sp.Integer(1)), ("_cos", sp.cos(u)), ("_sin", sp.sin(u))):
            _zero(found[kind + name].diff(u) - density * weight, f"the integral {kind}{name}")
            _zero(found[kind + name].subs(u, u_0), f"the start of {kind}{name}")
    return found


@cache
def sheared() -> dict[str, sp.Expr]:
    """Reaction of a contact |u| < theta on the wave, from integrals of its bristles' stress.

    Bristles count their angle u as they pass, against that of the wave, so that sin u changes its sign.
    """
    unit = mu * F_c * engagement / 2  # mu k_N W n_j / k_c
    return {
        "f": engagement / 2 * sheared_1,
        "f_ratio": engagement / 2 * sheared_ratio,
        "central": coupling.reaction()["central"],
        "along": unit * sheared_cos,
        "across": -unit * sheared_sin,
    }


@cache
def stuck() -> dict[str, sp.Expr]:
    """Height of the wave up to which all of the layer sticks, under a rotor that stands, and its stress times sin u.

    ``ratio_most`` is the speed of the rotor over the surface's from which on no bristle sticks anywhere.

    The whole wave touches then: bristles carry grip sin u about a mean of f times the limit's, below
    cos u + F_c k_c / (2 pi n_j k_N W) everywhere.

    Raises
    ------
    CouplingError
        If stress and limit do not just meet at that height, in one place.
    """
    mean = F_c * k_c / (2 * sp.pi * n_j * k_N)  # of the limit, times W
    most = mean * (1 - sp.Abs(f)) / sp.sqrt(1 + grip**2)
    place = sp.pi - sp.atan(grip)
    share_ = sp.Symbol("f_s", positive=True)  # of the limit's mean, in the sense in which the stress is
    room = most.subs(sp.Abs(f), share_) * (sp.cos(u) - grip * sp.sin(u)) + mean * (1 - share_)
    _zero(room.subs(u, place), "the room that is left where stress and limit meet")
    _zero(room.diff(u).subs(u, place), "its slope")
    held = sp.integrate(grip * sp.sin(u) ** 2, (u, -sp.pi, sp.pi))
    fastest = sp.sqrt(1 + grip**2) / grip  # grip (cos u - ratio) = -+sin u has no solution beyond
    return {"W_stick": most, "sheared_sin": held, "ratio_most": fastest}
