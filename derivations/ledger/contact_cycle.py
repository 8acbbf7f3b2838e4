"""The contact over a drive cycle: where the surface is fastest, how fast, how wide the contact is, and its friction."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
import sympy as sp

from derivations import transfer
from derivations.ledger.course import Quantity
from derivations.ledger.history import Array, History, numeric, values

__all__ = ["contact_motion", "friction", "friction_kinks", "table_4_speed"]

_ARCSEC = math.pi / 648000
_ANGLES = np.linspace(0, np.pi, 4001)
_CARRIED = np.sin(_ANGLES) - _ANGLES * np.cos(_ANGLES)


def table_4_speed() -> float:
    """The rim's speed at Table 4's mean of 633 arcsec/s, m/s."""
    return 633 * _ARCSEC * values()["r_c"]


@lru_cache(maxsize=32)
def contact_motion(h: History) -> tuple[Array, Array, Array]:
    """phi, R and the contact's half-angle at Table 3's prepressure.

    The half-angle follows the crest's height (eq. 31): Newton's steps on sin theta - theta cos theta, up to pi.
    """
    v = values()
    angle = numeric(transfer.speed_angle(), (transfer.W_c, transfer.W_c_rate, transfer.q))(h.W_c, h.W_c_rate, h.q)
    load = v["F_c"] * v["k_c"] / (2 * v["n_j"] * v["k_N"] * h.W_c)
    zone = np.interp(load, _CARRIED, _ANGLES)
    for _ in range(12):
        slope = np.maximum(zone * np.sin(zone), 1e-300)
        zone = np.clip(zone - (np.sin(zone) - zone * np.cos(zone) - load) / slope, 0.0, np.pi)
    zone = np.where(load >= np.pi, np.pi, zone)
    return angle, v["D"] * v["k_c"] * np.hypot(h.v_A, h.v_B), zone


def friction(speed: float, form: sp.Expr | None = None) -> Quantity:
    """Net friction over mu F_c on a rotor whose rim runs at a speed; ``form`` in phi, c, theta, or the closed form."""
    chosen = transfer.friction_fraction() if form is None else form
    function = numeric(chosen, (transfer.phi, transfer.c, transfer.theta))

    def value(h: History) -> Array:
        angle, R, zone = contact_motion(h)
        found: Array = function(angle, speed / R, zone)
        return found

    return value


def friction_kinks(speed: float, half: bool = False) -> list[Quantity]:
    """Where friction has a kink: a nonsliding point passes an end of the contact, or appears, or all of it touches."""

    def against(place: Callable[[Array], Array]) -> Quantity:
        def value(h: History) -> Array:
            angle, R, zone = contact_motion(h)
            found: Array = np.cos(place(zone) - angle) - speed / R
            return found

        return value

    def touching(h: History) -> Array:
        v = values()
        return v["F_c"] * v["k_c"] / (2 * v["n_j"] * v["k_N"] * h.W_c) - np.pi

    ends = [lambda zone: zone, (lambda zone: 0 * zone) if half else (lambda zone: -zone)]
    return [*(against(end) for end in ends), lambda h: contact_motion(h)[1] - abs(speed), touching]
