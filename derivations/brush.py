"""Friction of a plain travelling wave with a layer that gives way along the circumference: a brush (our own).

Bristles of stiffness k_T, side by side on the rotor, pass under a crest from one end of the contact to the other while
the wave runs on.  Each enters unstressed, is sheared by the difference of the speeds of surface and rotor as long as it
sticks, and slides where its stress would exceed mu times the pressure.  Stresses here are over mu k_N W, so that the
greatest that friction holds is cos u - cos theta; u = k_c (x - x_max) runs from -theta to theta.  Both ends of the
contact, pressure and surface speed are even about the crest, so it does not matter from which side bristles enter.

A bristle passes du in the time du / omega_q, for the rotor is slow beside the wave (a thousandth for TRUM-60), so it is
sheared by d u (R_v cos u - v) / omega_q.  Over its greatest stress that is grip (cos u - ratio) du, with
grip = k_T D k_c / (mu k_N), since R_v = D k_c omega_q W, and ratio = v / R_v.  Without bound, grip is the rigid layer.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import sym

__all__ = ["coefficient", "held", "passage", "speed_amplitude", "turns"]

k_T, k_N, D, k_c, mu, W, omega_q = sym("k_T k_N D k_c mu W omega_q")
grip, ratio, theta, u, u_0, t_0 = sym("grip ratio theta u u_0 t_0")
_at = sp.Symbol("s", real=True)


def coefficient() -> sp.Expr:
    """Grip: how fast the stress of a bristle that sticks grows with the angle, over what friction holds at most."""
    return k_T * speed_amplitude() / omega_q / (mu * k_N * W)


def speed_amplitude() -> sp.Expr:
    """R_v of a plain wave: D times the slope's rate (eqs. 16, 20)."""
    return D * k_c * omega_q * W


@cache
def passage() -> dict[str, sp.Expr]:
    """From u_0, where it has the stress t_0, to u: stress of a bristle that sticks, its integral, and friction's limit.

    In terms of u - u_0: with much grip a bristle sticks on a way that is short, over which differences of sines would
    lose it.

    Raises
    ------
    ArithmeticError
        If these are not the integrals.
    """
    way = u - u_0
    swept = 2 * sp.cos((u + u_0) / 2) * sp.sin(way / 2)  # sin u - sin u_0
    raised = 2 * sp.sin((u + u_0) / 2) * sp.sin(way / 2)  # cos u_0 - cos u
    stress = t_0 + grip * (swept - ratio * way)
    limit = sp.cos(u) - sp.cos(theta)
    found = {
        "stress": stress,
        "limit": limit,
        "stuck": t_0 * way + grip * (raised - sp.sin(u_0) * way - ratio * way**2 / 2),
        "slid": swept - sp.cos(theta) * way,
    }
    rates = {"stress": grip * (sp.cos(u) - ratio), "stuck": stress, "slid": limit}
    starts = {"stress": t_0, "stuck": sp.Integer(0), "slid": sp.Integer(0)}
    for name, rate in rates.items():
        gaps = (found[name].diff(u) - rate, found[name].subs(u, u_0) - starts[name])
        if any(sp.expand(sp.expand_trig(sp.simplify(gap))) != 0 for gap in gaps):
            raise ArithmeticError(f"{name} is not the integral along the way")
    return found


@cache
def turns() -> dict[str, sp.Expr]:
    """Where a sliding bristle could begin to stick: stress and limit then grow alike.

    Sliding on, at the limit, lasts while the stress would grow faster than the limit does,
    grip (cos u - ratio) > -sin u: that is |u - delay| < span.  Sliding back, at the limit's negative, it lasts while
    |u + delay| > span.  ``span`` is pi or 0 where one of them lasts all the way.

    Raises
    ------
    ArithmeticError
        If stress and limit do not grow alike there.
    """
    length = sp.sqrt(1 + grip**2)
    delay = sp.atan2(1, grip)
    cosine = grip * ratio / length
    growth = sp.diff(passage()["stress"], u) - sp.diff(passage()["limit"], u)
    turned = growth.subs(u, delay + sp.acos(cosine))
    if sp.simplify(sp.expand_trig(turned)) != 0:
        raise ArithmeticError("a sliding bristle does not stick where stress and limit grow alike")
    held_cosine = sp.Max(-1, sp.Min(1, cosine))
    return {"delay": delay, "span": sp.atan2(sp.sqrt(1 - held_cosine**2), held_cosine)}


@cache
def held() -> sp.Expr:
    """Friction fraction of a rotor that is held, ratio = 0, for theta between atan(grip) and pi/2.

    The bristles stick up to u = theta - 2 atan(grip), then slide on.  Below atan(grip) they slide all the way.
    """
    end = theta - 2 * sp.atan(grip)
    part = {ratio: 0, u_0: -theta, t_0: 0, u: end}
    whole = passage()["slid"].subs({u_0: -theta, u: theta})
    return (passage()["stuck"].subs(part) + passage()["slid"].subs({u_0: end, u: theta})) / whole
