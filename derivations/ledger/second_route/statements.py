"""Statements that the paper makes in words."""

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger import witness
from derivations.ledger.second_route.common import STARTS, at_table_3, route, whole_cycle
from derivations.ledger.second_route.sections_6_and_7 import senses, sums
from derivations.ledger.witness import Drive, cycle, stator


@route("claim-half-beat")
def _half_beat() -> list[Any]:
    found: list[Any] = []
    for start in STARTS:
        s = cycle(start)
        ahead = senses(s)[0] > 0
        found += [100 * ahead[s.region == region].mean() for region in range(3)]
    return [*found, 6 * 3000 / at_table_3("f_q")]


@route("claim-crest")
def _crest() -> list[Any]:
    speed = whole_cycle(lambda s: np.hypot(s.v_A, s.v_B), "periodic", True)
    rms = math.sqrt(float((Drive("periodic").phases(count=4 * witness.MANY).climb ** 2).mean()))
    return [
        1e3 * whole_cycle(lambda s: np.abs(s.climb), "periodic", True),
        1e3 * rms,
        1e3 * at_table_3("D") * at_table_3("k_c") * speed,
    ]


def _balanced(W: mp.mpf) -> mp.mpf:
    """The no-load rotor's share of the crest's speed on a steady wave of a height: friction's halves bisected."""
    v = stator()
    zone = witness.contact_angle(v["F_c"] * v["k_c"] / (v["n_j"] * v["k_N"] * W))
    load = mp.quad(lambda u: mp.cos(u) - mp.cos(zone), [0, zone])
    low, high = mp.mpf(0), zone
    for _ in range(100):
        middle = (low + high) / 2
        inside = mp.quad(lambda u: mp.cos(u) - mp.cos(zone), [0, middle])
        low, high = (middle, high) if 2 * inside < load else (low, middle)
    return mp.cos(low)


@route("claim-proportional")
def _proportional() -> list[Any]:
    W, step = stator()["W"], mp.mpf("1e-4")
    ends = [mp.log(_balanced(W * mp.exp(side * step)) * mp.exp(side * step)) for side in (-1, 1)]
    sizes = stator(210)["W"] / stator(160)["W"]
    return [_balanced(W), (ends[1] - ends[0]) / (2 * step), 100 * (1 - sizes), 100 * (1 - sizes**2)]


@route("claim-contact")
def _contact() -> list[Any]:
    v = stator()
    lowest = [1e9 * whole_cycle(lambda s: s.height, start, False) for start in ("periodic", "steady")]
    return [*lowest, 1e9 * v["F_c"] / (v["n_j"] * 2 * mp.pi / v["k_c"]) / v["k_N"]]


@route("claim-T_Qall")
def _constant() -> list[Any]:
    f_n = {force: stator(force)["f_n"] for force in (160, 180, 210)}
    return [100 * ((f_n[180] + 2800) / (f_n[180] + 3300) - 1), 100 * ((f_n[160] + 3000) / (f_n[210] + 3000) - 1)]


@route("claim-one-beat")
def _one_beat() -> list[Any]:
    return [45 * 3000 / at_table_3("f_q"), 6 * 3000 / at_table_3("f_q")]


@route("claim-add-beat")
def _add_beat() -> list[Any]:
    return [2e6 / (at_table_3("f_n") + at_table_3("f_q")), (at_table_3("f_n") + at_table_3("f_q")) / 2 / 3000]


@route("claim-Q_vib")
def _trend() -> list[Any]:
    found: list[Any] = []
    for start in STARTS:
        ahead, back, ahead_2, back_2 = sums(start)
        found += [ahead / back, ahead_2 / back_2]
    forward, backward = senses(Drive("periodic", 100, 55, 4000.0, 1).phases(count=3_000_000))
    return [*found, backward.sum() / forward.sum(), (backward**2).sum() / (forward**2).sum()]
