"""Sect. 4: contact, transfer, rotor."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger import witness
from derivations.ledger.second_route.common import at_table_3, rate_of, route, whole_cycle
from derivations.ledger.witness import Array, Drive, Sampled, cycle, friction, motor, stator, zones


@route("25")
def _twenty_five() -> list[Any]:
    p, W = motor(), stator()["W"]
    curve = 2 * p["r_t"] ** 2 / (p["n_j"] ** 2 * W)
    return [curve, 20, 2 * p["r_t"] ** 2 / (20**2 * W), 2 * (2 * p["r_t"]) ** 2 / (p["n_j"] ** 2 * W)]


def _compliances() -> tuple[mp.mpf, mp.mpf]:
    p = motor()
    soft = (1 - p["h_t"] / p["h_e"]) ** 3 * p["E_e"]
    layer = (1 - p["mu_m"] ** 2) / p["E_m"]
    return (1 - p["mu_e"] ** 2) / soft + layer, (1 - p["mu_e"] ** 2) / p["E_e"] + layer


@route("C_E")
def _compliance() -> list[Any]:
    soft, solid = _compliances()
    return [soft, solid, 100 * (mp.sqrt(solid) - mp.sqrt(soft)) / mp.sqrt(soft)]


@route("26")
def _twenty_six() -> list[Any]:
    v = stator()
    curve = 2 * v["r_t"] ** 2 / (v["n_j"] ** 2 * v["W"])
    half = mp.mpf("0.8") * mp.sqrt(v["F_c"] * curve * _compliances()[0] / (v["n_j"] * v["b_m"]))
    exact = mp.sqrt(8 / mp.pi)
    return [
        exact,
        100 * (mp.mpf("1.6") - exact) / exact,
        1e3 * half,
        half / v["h_m"],
        1e3 * v["h_m"],
        v["theta"],
        v["k_c"] * half,
    ]


@route("27")
def _twenty_seven() -> list[Any]:
    return [1e3 * stator()["theta"] / stator()["k_c"]]


@route("28")
def _twenty_eight() -> list[Any]:
    W, edge = stator()["W"], mp.cos(stator()["theta"])
    return [1e6 * W * edge, 1e6 * W, 1e6 * W * (1 - edge)]


@route("29")
def _twenty_nine() -> list[Any]:
    v = stator()
    crest = 1e3 * v["D"] * v["k_c"] * 2 * mp.pi * v["f_q"] * v["W"]
    return [crest * mp.cos(v["theta"]), crest]


@route("30")
def _thirty() -> list[Any]:
    v, nu = stator(), stator()["mu_m"]
    # strains 0 across and along, 1 upward, in Hooke's law
    hooke = mp.matrix([[1, -nu, -nu], [-nu, 1, -nu], [-nu, -nu, 1]])
    held = mp.lu_solve(hooke, mp.matrix([0, 0, 1]))[2]
    return [v["E_m"] * v["b_m"] / v["h_m"], held]


@route("31")
def _thirty_one() -> list[Any]:
    v = stator()
    one = witness.contact_angle(2 * v["F_c"] * v["k_c"] / (v["k_N"] * v["W"]))
    rub = v["mu"] * v["F_c"]
    return [v["n_j"], one, v["theta"], v["F_c"], rub * 2 * v["n_j"], 2 * v["n_j"], rub]


@route("32")
def _thirty_two() -> list[Any]:
    v = stator()
    top = v["k_N"] * v["W"] * (1 - mp.cos(v["theta"]))
    return [top, top / v["b_m"] / 1e6]


@route("33")
def _thirty_three() -> list[Any]:
    return [100 * (cycle().v_A < 0).mean()]


@route("34")
def _thirty_four() -> list[Any]:
    edge = at_table_3("D") * at_table_3("k_c") * rate_of("q") * at_table_3("W")
    shift = (math.pi / 6 - math.asin(at_table_3("W") / 2)) / at_table_3("k_c")
    angle, ratio = np.meshgrid((np.arange(4000) + 0.5) / 4000 * 2 * np.pi - np.pi / 2, np.linspace(-0.99, 0.99, 100))
    a, b, arc = np.cos(angle), np.sin(angle), np.arcsin(ratio)
    place = np.select([b >= 0, a > 0], [arc - angle, -np.pi - arc - angle], np.pi - arc - angle)
    return [at_table_3("W"), 1e3 * edge, 1e3 * shift, 100 * ((place < -np.pi / 2) | (place > 1.5 * np.pi)).mean()]


def _table_4() -> float:
    return 633 / 3600 * math.pi / 180 * at_table_3("r_c")


def seen_from_crest(s: Sampled) -> tuple[Array, Array, Array, Array]:
    """phi, R, theta, and the crest's place, from the surface's velocity at the crest and a quarter wave on."""
    scale, crest = at_table_3("D") * at_table_3("k_c"), np.arctan2(s.w_A, s.w_B)
    at = [scale * (s.v_A * np.cos(u) - s.v_B * np.sin(u)) for u in (crest, crest + np.pi / 2)]
    return np.arctan2(at[1], at[0]), np.hypot(*at), zones(s.height), crest


@route("35")
def _thirty_five() -> list[Any]:
    import sympy as sp

    from derivations.ledger.section_4_nonsliding import EQ35
    from derivations.nomenclature import sym

    x_px, k_c = sym("x_px k_c")
    s = Drive("periodic").phases(count=400000)
    angle, R, zone, crest = seen_from_crest(s)
    crest, ratio = (crest + np.pi / 2) % (2 * np.pi) - np.pi / 2, _table_4() / R
    opening = np.arccos(np.clip(ratio, -1, 1))
    ends = np.array([angle + side * opening + turn for side in (1, -1) for turn in (-2 * np.pi, 0, 2 * np.pi)])
    inside = (ends > 0) & (ends < zone)
    single = inside.sum(0) == 1
    root = np.where(inside, ends, 0).sum(0)
    psi = (np.pi / 2 - angle - crest + np.pi / 2) % (2 * np.pi) - np.pi / 2
    arc = np.arcsin(np.clip(ratio, -1, 1))
    place = np.where(np.sin(psi) >= 0, arc - psi, np.where(np.cos(psi) > 0, -np.pi, np.pi) - arc - psi)
    first, k = np.arctan(np.cos(psi) / np.sin(psi)), at_table_3("k_c")
    known = {
        "x_px": place / k,
        "phi_vm1": first / k,
        "phi_vm2": (first + np.pi) / k,
        "x_max": crest / k,
        "x_xm": (crest + zone) / k,
        "v_xm": np.cos(zone - angle),
        "v_xmax": np.cos(angle),
        "k_c": k + 0 * k,
    }
    found: list[Any] = []
    for form in (EQ35["x_p"], EQ35["x_p"].subs(x_px + 2 * sp.pi, x_px + 2 * sp.pi / k_c)):
        symbols = sorted(form.free_symbols, key=lambda symbol: symbol.name)
        placed = np.asarray(sp.lambdify(symbols, form, "numpy")(*(known[symbol.name] for symbol in symbols)))
        none = np.isnan(placed)
        right = np.abs(k * placed - crest - root) < 1e-9
        found += [100 * part[single].mean() for part in (right, ~right & ~none, none)]
    return [*found, 100 * single.mean(), k, 2e3 * math.pi / k]


@cache
def _rubbed(speed: float, half: bool) -> Array:
    return friction(Drive("periodic").phases(count=40000), speed, half)


@route("36")
def _thirty_six() -> list[Any]:
    speed, rub = _table_4(), at_table_3("mu") * at_table_3("F_c")
    whole, half = (_rubbed(speed, part) for part in (False, True))
    heights = [whole_cycle(lambda s: s.height, "periodic", top) for top in (True, False)]
    gap = half - whole
    return [
        *zones(np.array(heights)),
        rub * math.sqrt((gap**2).mean()),
        rub * np.abs(gap).max(),
        rub,
        100 * (half * whole < 0).mean(),
        rub * half.mean(),
        rub * whole.mean(),
    ]


def _at_rest() -> float:
    return float(_rubbed(0.0, half=False).mean()) * at_table_3("mu") * at_table_3("F_c") * at_table_3("r_c")


@route("37")
def _thirty_seven() -> list[Any]:
    return [_at_rest()]


@route("transfer-cases")
def _cases() -> list[Any]:
    s = cycle()
    angle, R, zone, _ = seen_from_crest(s)
    ratio = _table_4() / R
    ends = [np.cos(u - angle) > ratio for u in (0.0, zone)]
    turns = (np.sin(-angle) > 0) != (np.sin(zone - angle) > 0)
    parts = [
        100 * float(((ends[0] == a) & (ends[1] == b) & (turns == c)).mean())
        for a in (True, False)
        for b in (True, False)
        for c in (True, False)
    ]
    return [*sorted((p for p in parts if p > 0.01), reverse=True), sum(p > 0 for p in parts)]


@route("38")
def _thirty_eight() -> list[Any]:
    return [at_table_3("mu") * at_table_3("F_c") * at_table_3("r_c"), _at_rest()]


@route("reverse-model")
def _reverse() -> list[Any]:
    return [2 * at_table_3("mu") * at_table_3("F_c")]
