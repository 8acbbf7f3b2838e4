"""Sects. 6 and 7: measured quantities, determinants of a cycle."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from derivations.ledger.second_route.common import STARTS, at_table_3, rate_of, route, whole_cycle
from derivations.ledger.witness import Array, Sampled, cycle


@route("39")
def _thirty_nine() -> list[Any]:
    return [2e-3 * at_table_3("f_q") / 20, 2e4 / at_table_3("f_q")]


@route("40")
def _forty() -> list[Any]:
    return [2e4 / at_table_3("f_q")]


@route("41")
def _forty_one() -> list[Any]:
    draw = np.random.default_rng(1).normal(size=100)
    return [100 * (draw.std(ddof=1) / draw.std() - 1)]


_NOTHING = 1e-9  # of W^2 omega_q: what rounding leaves where only one phase moves


def senses(s: Sampled) -> tuple[Array, Array]:
    """Q over D k_c W^2 omega_q, its forward part and its backward part."""
    q = s.q / (at_table_3("W") ** 2 * rate_of("q"))
    return np.where(q > _NOTHING, q, 0.0), np.where(q < -_NOTHING, -q, 0.0)


@route("Q(t)")
def _q_t() -> list[Any]:
    return [100 * (senses(cycle(start))[0] > 0).mean() for start in STARTS]


@route("42")
def _forty_two() -> list[Any]:
    rise, q = (lambda s: np.abs(s.w_A * s.v_A + s.w_B * s.v_B)), (lambda s: np.abs(s.q))
    s = cycle()
    return [
        whole_cycle(rise, "periodic", True),
        at_table_3("D") * at_table_3("k_c") * whole_cycle(q, "periodic", True),
        100 * (s.climb * s.q < 0).mean(),
    ]


@cache
def sums(start: str) -> tuple[float, float, float, float]:
    """Over a cycle, of the determinant's parts of either sense, and of their squares."""
    ahead, back = senses(cycle(start))
    return float(ahead.sum()), float(back.sum()), float((ahead**2).sum()), float((back**2).sum())


def average(start: str) -> float:
    """Eq. 43's average determinant."""
    ahead, back, _, _ = sums(start)
    return (ahead - back) / (ahead + back) * at_table_3("f_q") / 20


@route("43")
def _forty_three() -> list[Any]:
    found = []
    for start in STARTS:
        ahead, back = senses(cycle(start))
        last = [int((part > 0).sum()) for part in (ahead, back)]
        whole = ahead[: last[0]].sum(), back[: last[1]].sum()
        found += [average(start), (whole[0] - whole[1]) / (whole[0] + whole[1]) * at_table_3("f_q") / 20]
    return found


def root_of_mean(start: str) -> complex:
    """Eq. 44's quotient of roots as printed, which may be imaginary."""
    _, _, ahead, back = sums(start)
    return complex(ahead + back) ** 0.5 / complex(ahead - back) ** 0.5


@route("44")
def _forty_four() -> list[Any]:
    found, per = [], at_table_3("f_q") / 20
    for start in STARTS:
        printed = root_of_mean(start) * per**2 / average(start)
        ratio = sums(start)[2] / sums(start)[3]
        found += [
            printed.real if abs(printed.imag) < 1e-6 * abs(printed) else printed.imag,
            abs(root_of_mean(start)) * per**2 / average(start),
            ratio,
        ]
    return [*found, per]


@route("45")
def _forty_five() -> list[Any]:
    beat = 1e3 / (45000 - 39703)
    damped = 39703 * math.sqrt(1 - at_table_3("xi") ** 2)
    change = 100 * (1 - 1e3 / (45000 - damped) / beat)
    return [beat, 100 * (0.188 - beat) / beat, 100 * (0.19 - beat) / beat, change]


@route("decay")
def _decay() -> list[Any]:
    seconds = 1 / (0.006 * rate_of("n"))
    return [math.exp(2 * math.pi * 0.006), 1e3 * seconds, seconds * at_table_3("f_q") / 20]
