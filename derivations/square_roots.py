"""What a step's rate of time leaves of slopes that are infinite (docs/rotor.md).

Where the rotor is as fast as all of the surface, df/dv is infinite like one over a square root of time, and so is
d theta/d ln E where the whole wave begins to touch the layer.  There the time in a step of length h runs as h sigma^2:
slopes times dt/dsigma have a limit.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations.nomenclature import TINY, sym
from derivations.rotor import coefficients, friction_slope, pressed, widening, winkler_full_height

__all__ = ["contact_limit", "friction_limit"]

R_v, R_v_rate, v, v_rate, W_full, W_c_rate, step = sym("R_v R_v_rate v v_rate W_full W_c_rate step")
p_larger, p_smaller = sym("p_larger p_smaller")
_sigma, _rate, _bend, _near = sp.symbols("sigma rate bend near", positive=True)


@cache
def friction_limit() -> sp.Expr:
    """Of df/dv dt/dsigma where the rotor is as fast as all of the surface, R_v = |v|.

    R_v^2 - v^2 is there its rate times the time, and bends from that in the time's square.
    """
    time = step * _sigma**2
    rub = friction_slope(sp.Symbol("p", positive=True), sp.sqrt(_rate * time + _bend * time**2)).subs(TINY, 0)
    limit = sp.limit(rub * time.diff(_sigma), _sigma, 0, "+")
    faster = (R_v**2).diff(R_v) * R_v_rate - (v**2).diff(v) * v_rate
    return limit.subs({sp.Symbol("p", positive=True): pressed(p_larger, p_smaller), _rate: sp.Abs(faster) + TINY})


@cache
def contact_limit() -> sp.Expr:
    """Of d theta/d ln E dt/dsigma where the wave's height passes that of full contact, theta = pi.

    E (sin theta - theta cos theta) = 1 is the load's balance, E is in proportion to the height, and the height grows
    at its rate.
    """
    theta = sp.pi - _near
    engaged = 1 / (sp.sin(theta) - theta * sp.cos(theta))
    at_full = winkler_full_height() * coefficients()["engagement_per_height"]
    time = (engaged / at_full - 1) * W_full / _rate
    opening = widening(engaged, theta, sp.sin(theta)).subs(TINY, 0)
    square = sp.limit(sp.simplify(opening**2 * 4 * step * time), _near, 0, "+")  # dt/dsigma = 2 sqrt(h t)
    return -sp.sqrt(square.subs(_rate, sp.Abs(W_c_rate) + TINY))
