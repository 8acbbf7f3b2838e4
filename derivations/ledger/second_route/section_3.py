"""Sect. 3: the three regions, after a steady start where nothing else is said."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from derivations.ledger import witness
from derivations.ledger.second_route.common import at_table_3, rate_of, region_ends, route, whole_cycle, within_region
from derivations.ledger.witness import Array, Drive, Sampled, cycle, stator


def _turn(angle: Any) -> Any:  # noqa: ANN401
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _supplement(phase: str, s: Sampled, since: Array, start: complex) -> tuple[Array, float, Array]:
    """Length, (Theta + Psi)/2 and slow phase varphi of a phase that is forced and free, by its vector."""
    vector = s.a if phase == "A" else s.b
    psi = np.pi / 2 if phase == "A" else 0.0
    half = float((_turn(np.angle(start) + np.pi / 2) + psi) / 2)
    mean = (rate_of("d") + rate_of("q")) * since / 2 + (np.pi / 2 if phase == "B" else 0.0)
    return np.abs(vector), half, _turn(np.angle(vector) + np.pi / 2 - mean - half)


def _free(phase: str, index: int) -> complex:
    """The free motion's vector of a phase at the start of a region, after a steady start."""
    at = np.array([region_ends()[index] * (1 + 1e-15) + 1e-18])
    s = Drive("steady").phases(at)
    forced = at_table_3("W") * np.exp(1j * rate_of("q") * s.since) * (1 if phase == "A" else 1j)
    on = {"A": (0, 1, 1), "B": (1, 0, 1)}[phase][index]
    return complex(((s.a if phase == "A" else s.b) - on * forced)[0])


@route("supplement-redu")
def _s_redu() -> list[Any]:
    z = _free("A", 0)
    return [1e6 * abs(z), float(np.angle(z) + np.pi / 2)]


def _s_beating(phase: str, index: int) -> list[Any]:
    z, low, high = _free(phase, index), region_ends()[index], region_ends()[index + 1]
    tiny = 1e-12 * (high - low)
    s = Drive("steady").phases(np.array([low + tiny, high - tiny]))
    length, _, slow = _supplement(phase, s, s.since, z)
    return [1e6 * abs(z), _turn(np.angle(z) + np.pi / 2), 1e6 * length[0], 1e6 * length[1], slow[0], slow[1]]


@route("supplement-addredu")
def _s_addredu() -> list[Any]:
    return _s_beating("A", 1)


@route("supplement-add")
def _s_add() -> list[Any]:
    return _s_beating("B", 2)


def _since_t2(s: Sampled) -> Array:
    return s.time - region_ends()[1]


def _slip(since: Array) -> Array:
    """By how much the paper's mean angle, with omega_n for omega_d, runs ahead."""
    return (rate_of("n") - rate_of("d")) / 2 * since


@route("9")
def _nine() -> list[Any]:
    W, n, decay = at_table_3("W"), rate_of("n"), at_table_3("xi") * rate_of("n")
    phase = float(np.angle(_free("A", 0)) + np.pi / 2)

    def first(s: Sampled) -> Array:
        return W * np.exp(-decay * s.time) * np.sin(n * s.time + phase) - s.w_A

    def later(s: Sampled) -> Array:
        return np.abs(s.a) * np.cos(np.angle(s.a) + _slip(_since_t2(s))) - s.w_A

    sizes = [100 * within_region(i, form) / W for i, form in enumerate((first, later, later))]
    ends = Drive("steady").phases(np.array([region_ends()[2], region_ends()[3] * (1 - 1e-15)]))
    return [*sizes, math.pi / 2 - phase, *(np.abs(ends.a) / W)]


@route("10")
def _ten() -> list[Any]:
    more = 3000 / at_table_3("f_n")
    return [100 * more, 1e6 * at_table_3("W") * more]


@route("11")
def _eleven() -> list[Any]:
    v, layers, edge = stator(), stator(180, True), 2 * math.pi * at_table_3("f_q") * at_table_3("W") * 1e3
    return [
        100 * (v["k_c"] - v["beta"]) / v["beta"],
        edge * at_table_3("D") * at_table_3("k_c"),
        edge * at_table_3("D") * at_table_3("beta"),
        100 * (v["D"] * v["k_c"] / (layers["D"] * layers["beta"]) - 1),
    ]


@route("13")
def _thirteen() -> list[Any]:
    W, decay = at_table_3("W"), at_table_3("xi") * rate_of("n")
    free = abs(_free("B", 1))
    first = within_region(0, lambda s: (W * np.exp(-decay * s.time) - np.abs(s.a)) / W)
    return [100 * (1 - W / free), 100 * first]


@route("14")
def _fourteen() -> list[Any]:
    middle = np.array([(region_ends()[1] + region_ends()[2]) / 2])
    s, z = Drive("steady").phases(middle), _free("A", 1)
    theta = _turn(np.angle(z) + np.pi / 2)
    _, half, slow = _supplement("A", s, s.since, z)
    printed, derived = theta - np.pi / 2 - np.pi, half + slow[0] - np.pi
    step = 1e-9
    before, after = (Drive("steady").phases(middle + side * step) for side in (-1, 1))
    turned = np.angle(after.b / after.a / (before.b / before.a))[0]
    return [_turn(printed - derived), abs(turned) / (2 * step) / (2 * math.pi)]


@route("15")
def _fifteen() -> list[Any]:
    lengths = np.diff(region_ends()) * 1e3
    return [*lengths, 1e3 / 3000, 2e3 / 3000, 100]


def _off_rate(index: int, row: Callable[[Sampled], Array], phase: str) -> float:
    speed = at_table_3("W") * rate_of("q")

    def off(s: Sampled) -> Array:
        return (row(s) - (-s.v_B if phase == "B" else s.v_A)) / speed

    return 100 * within_region(index, off)


@route("18")
def _eighteen() -> list[Any]:
    W, n, xi = at_table_3("W"), rate_of("n"), at_table_3("xi")
    mean = (n + rate_of("q")) / 2

    def second(s: Sampled) -> Array:
        angle = n * s.since + np.pi / 2
        return W * n * np.exp(-xi * n * s.since) * (xi * np.cos(angle) + np.sin(angle))

    def third(s: Sampled) -> Array:
        return np.abs(s.b) * np.cos(np.angle(s.b) + _slip(s.since) + np.pi / 2)

    right = [lambda s: second(s) * rate_of("q") / n, lambda s: -mean * third(s)]
    sizes = [_off_rate(index, row, "B") for index, row in ((1, second), (2, third), (1, right[0]), (2, right[1]))]
    return [*sizes, W * rate_of("q")]


@route("19")
def _nineteen() -> list[Any]:
    W, n, xi = at_table_3("W"), rate_of("n"), at_table_3("xi")
    mean = (n + rate_of("q")) / 2

    def first(s: Sampled) -> Array:
        angle = n * s.time + np.pi / 2
        return W * n * np.exp(-xi * n * s.time) * (np.cos(angle) - xi * np.sin(angle))

    def later(s: Sampled) -> Array:
        return np.abs(s.a) * np.cos(np.angle(s.a) + np.pi / 2 + _slip(_since_t2(s)))

    start = _off_rate(0, first, "A")
    printed = [_off_rate(i, later, "A") for i in (1, 2)]
    right = [_off_rate(i, lambda s: mean * later(s), "A") for i in (1, 2)]
    return [start, *printed, start, *right, W * rate_of("q")]


@route("20")
def _twenty() -> list[Any]:
    return [100 * (cycle("steady").w_B < 0).mean(), 1e3 * math.pi / at_table_3("k_c")]


@route("22")
def _twenty_two() -> list[Any]:
    ends = Drive("steady").phases(np.array([0.0, region_ends()[3] * (1 - 1e-15)])).height
    scale = at_table_3("D") * at_table_3("k_c")

    def along(s: Sampled) -> Array:
        return scale * s.q / s.height

    return [
        (ends[1] - ends[0]) / region_ends()[3],
        *(whole_cycle(lambda s: s.climb, "steady", top) for top in (False, True)),
        along(Drive("steady").phases(count=4 * witness.MANY)).mean(),
        *(whole_cycle(along, "steady", top) for top in (False, True)),
    ]


@route("23")
def _twenty_three() -> list[Any]:
    s = Drive("steady").phases(np.array([region_ends()[1] / 7]))
    scale, a, b = at_table_3("D") * at_table_3("k_c"), s.w_A[0], s.w_B[0]
    along = scale * a  # at x = 0
    return [100 * (((a / scale) ** 2 * along**2 + b**2 * along**2) / (a**2 + b**2) ** 2 - 1)]


def _less_q(form: Callable[[Sampled], Array], unit: float) -> Callable[[Sampled], Array]:
    def off(s: Sampled) -> Array:
        return (form(s) - s.q) / unit

    return off


@route("24")
def _twenty_four() -> list[Any]:
    W, n, q, xi = at_table_3("W"), rate_of("n"), rate_of("q"), at_table_3("xi")
    mean, unit = (n + q) / 2, W**2 * q
    start_a, start_b = _free("A", 1), _free("B", 2)

    def first(s: Sampled) -> Array:
        return W * np.exp(-xi * n * s.time) * W * mean * np.sin((q - n) * s.time + np.pi / 2)

    def second(s: Sampled) -> Array:
        length, half, slow = _supplement("A", s, s.since, start_a)
        angle = (q - n) / 2 * s.since + np.pi - slow - half
        return length * W * np.exp(-xi * n * s.since) * (mean + n) / 2 * np.sin(angle)

    def third(s: Sampled) -> Array:
        length_a, half_a, slow_a = _supplement("A", s, _since_t2(s), start_a)
        length_b, half_b, slow_b = _supplement("B", s, s.since, start_b)
        angle = half_b + slow_b - mean * (region_ends()[2] - region_ends()[1]) * (half_a + slow_a - np.pi / 2)
        return length_a * length_b * mean * np.sin(angle)

    def second_right(s: Sampled) -> Array:
        angle = n * s.since + np.pi / 2 - np.angle(s.a) - _slip(s.since)
        return np.abs(s.a) * W * q / n * np.exp(-xi * n * s.since) * (mean + n) / 2 * np.sin(angle)

    def third_right(s: Sampled) -> Array:
        angle = np.angle(s.b) + _slip(s.since) - np.angle(s.a) - _slip(_since_t2(s))
        return np.abs(s.a) * np.abs(s.b) * mean * np.sin(angle)

    found: list[Any] = []
    for index, (printed, right) in enumerate(((first, first), (second, second_right), (third, third_right))):
        low, high = region_ends()[index], region_ends()[index + 1]
        s = Drive("steady").phases(low + (np.arange(400000) + 0.5) / 400000 * (high - low))
        first_size, last_size = (100 * within_region(index, _less_q(form, unit)) for form in (printed, right))
        found += [first_size, 100 * (printed(s) * s.q < 0).mean(), last_size]
    return found
