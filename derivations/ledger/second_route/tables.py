"""The paper's tables."""

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger.second_route.common import at_table_3, beam_of, hertz_of, route
from derivations.ledger.witness import motor, resonance, stator


@route("table-1-R")
def _table_r() -> list[Any]:
    return [motor()["n_j"] / mp.mpf("0.06"), hertz_of(beam_of(), k=mp.mpf(150)) / 1e3, stator()["f_n"] / 1e3]


@route("table-1-heights")
def _table_heights() -> list[Any]:
    v, changed = stator(), {"h_t": mp.mpf("0.0045"), "h_e": mp.mpf("0.002")}
    swapped, _ = resonance(beam_of(**changed), v["k_c"], v["k_f"])
    return [motor()["E_e"] * (1 - mp.mpf("2.25")) ** 3 / 1e9, mp.im(swapped) / 1e3, v["f_n"] / 1e3]


@route("table-1-isotropy")
def _table_isotropy() -> list[Any]:
    p = motor()
    shear = {f"G_{part}": p[f"E_{part}"] / 2 / (1 + p[f"mu_{part}"]) for part in "ep"}
    found = hertz_of(beam_of(**shear))
    return [shear["G_e"] / 1e9, shear["G_p"] / 1e9, found - stator()["f_n"], 100 * (found / stator()["f_n"] - 1)]


@route("table-1-J")
def _table_j() -> list[Any]:
    return [
        1e3 * at_table_3("J") / at_table_3("r_c") ** 2,
        at_table_3("mu") * 180 * at_table_3("r_c") / at_table_3("J"),
    ]


@route("table-1-kappa")
def _table_kappa() -> list[Any]:
    nu = motor()["mu_e"]
    cowper = (10 + 10 * nu) / (12 + 11 * nu)
    return [cowper, hertz_of(beam_of(kappa=cowper)) - stator()["f_n"]]


@route("table-1-U_s")
def _table_voltage() -> list[Any]:
    return [100 * (400 / 200) - 100]


@route("table-2")
def _table_2() -> list[Any]:
    force = np.array([100, 120, 140, 160, 180, 200, 220.0])
    size = np.array([8.3, 7.3, 6.6, 6.0, 5.5, 5.2, 4.8])
    slope, level = np.polyfit(np.log(force), np.log(size), 1)
    p = motor()
    printed = [float(p[name]) for name in ("C_f", "varsigma", "W_max")]
    meet = mp.findroot(lambda f: printed[0] * f ** -printed[1] - 1, 50)
    return [math.exp(level + slope * math.log(180)), 1e6 * at_table_3("W"), -slope - 0.678, meet]


@route("table-3")
def _table_3() -> list[Any]:
    return [-(20 - 14)]


@route("table-4")
def _table_4_units() -> list[Any]:
    return [math.radians(633 / 3600)]


@route("table-5")
def _table_5() -> list[Any]:
    turns, f_n = 3300 / 2 / math.pi, at_table_3("f_n")
    return [turns, 1e3 / turns, (f_n + turns) / 20 / turns, 1 / 3.3, (f_n + 3300) / 20 / 3300]
