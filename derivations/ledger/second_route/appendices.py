"""Appendices A to C."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from derivations.ledger.second_route.common import at_table_3, region_ends, route
from derivations.ledger.second_route.sections_6_and_7 import average, root_of_mean, sums
from derivations.ledger.witness import Drive


@route("A7")
def _a7() -> list[Any]:
    return [(at_table_3("f_n") + at_table_3("f_q")) / 3000]


@route("A8")
def _a8() -> list[Any]:
    return [100 * 3000 / (at_table_3("f_n") + at_table_3("f_q"))]


@route("A9")
def _a9() -> list[Any]:
    return [1 / 3]


@route("A11")
def _a11() -> list[Any]:
    return [1e6 * at_table_3("W"), 1e6 * at_table_3("W") * at_table_3("D") * at_table_3("k_c")]


def _enclosed(a: complex, b: complex) -> float:
    """Area in um^2 of the path of two turning phases of constant size, as a polygon."""
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 200001))
    up, along = (b * turn).real, at_table_3("D") * at_table_3("k_c") * (a * turn).real  # at x = 0
    return 1e12 * abs(float((along[:-1] * up[1:] - along[1:] * up[:-1]).sum())) / 2


@route("A13")
def _a13() -> list[Any]:
    W, end = at_table_3("W"), region_ends()[1]
    s = Drive("steady").phases(np.array([end * (1 - 1e-14)]))
    drift = 2 * math.pi * 3000 * end
    return [_enclosed(W, 1j * W), 1e6 * abs(s.a[0]), drift, _enclosed(complex(s.a[0]), complex(s.b[0]))]


@route("A14")
def _a14() -> list[Any]:
    ahead, back, _, _ = sums("periodic")
    return [ahead / back, average("periodic")]


@route("A15")
def _a15() -> list[Any]:
    ahead, back, _, _ = sums("periodic")
    X, h = ahead / back, 1e-4
    slope = ((X + h - 1) / (X + h + 1) - (X - h - 1) / (X - h + 1)) / (2 * h) * at_table_3("f_q") / 20
    return [slope, 100 * ((at_table_3("f_n") + 2800) / (at_table_3("f_n") + 3300) - 1)]


@route("A16")
def _a16() -> list[Any]:
    found: list[Any] = []
    for start in ("periodic", "steady"):
        root, ratio = root_of_mean(start), sums(start)[2] / sums(start)[3]
        found += [root.real if abs(root.imag) < 1e-9 else root.imag, ratio, abs(root)]
    return found


@route("A17")
def _a17() -> list[Any]:
    _, _, ahead, back = sums("periodic")
    Y, h = ahead / back, 1e-5
    slope = (math.sqrt((Y + h + 1) / (Y + h - 1)) - math.sqrt((Y - h + 1) / (Y - h - 1))) / (2 * h)
    return [Y, -2 / (Y - 1), slope, -2 / (Y - 1) / slope]
