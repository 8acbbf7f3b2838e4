"""Every figure of the effects once more, by the second witness: what ``verify`` holds the printed figures against.

One function per entry, in the order in which the entry's effect computes its figures.  Laws that the paper prints
wrongly are typed here a second time, from the paper; nothing is taken from the entries but the table (35).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger import witness
from derivations.ledger.witness import Array, Drive, Sampled, cycle, friction, motor, peak, resonance, stator, zones

__all__ = ["SECOND_ROUTES"]

_Route = Callable[[], Iterable[Any]]
SECOND_ROUTES: dict[str, _Route] = {}
"""Entry -> figures of its effect, in the order of their computation."""
_STARTS = ("periodic", "steady", "rest")


def _route(*names: str) -> Callable[[_Route], _Route]:
    def keep(route: _Route) -> _Route:
        SECOND_ROUTES.update(dict.fromkeys(names, route))
        return route

    return keep


@cache
def _v(name: str) -> float:
    """A value at Table 3's point."""
    return float(stator()[name])


@cache
def _rate(name: str) -> float:
    """omega_n, omega_q, omega_d, or the drive's less the resonance's."""
    own, drive = 2 * math.pi * _v("f_n"), 2 * math.pi * _v("f_q")
    return {"n": own, "q": drive, "d": own * math.sqrt(1 - _v("xi") ** 2), "delta": drive - own}[name]


def _whole(quantity: Callable[[Sampled], Array], start: str, largest: bool) -> float:
    """The largest or smallest value of a cycle, looked for region by region."""
    drive, ends = Drive(start), _ends()
    found = [peak(quantity, drive, low, high, largest) for low, high in pairwise(ends)]
    return max(found) if largest else min(found)


@cache
def _ends() -> list[float]:
    return [pulses / _v("f_q") for pulses in (0, 6, 12, 20)]


def _within(index: int, quantity: Callable[[Sampled], Array]) -> float:
    """The largest magnitude in a region after a steady start; the edges belong to it."""
    low, high = _ends()[index], _ends()[index + 1]
    tiny = 1e-9 * (high - low)
    return peak(lambda s: np.abs(quantity(s)), Drive("steady"), low + tiny, high - tiny)


def _sections(**changed: Any) -> dict[str, mp.mpf]:  # noqa: ANN401
    return witness.beam(**changed)


def _hertz(b: Any, k: Any = None, k_f: Any = None) -> mp.mpf:  # noqa: ANN401
    v = stator()
    return mp.re(resonance(b, v["k_c"] if k is None else k, v["k_f"] if k_f is None else k_f)[0])


# --- Section 2 ----------------------------------------------------------------------------------------------
def _forced(axis: mp.mpf, hertz: mp.mpf) -> mp.mpf:
    """Amplitude of a wavelength's mode under the ceramic's moment, driven at a frequency; quadratures over the wave."""
    v = stator()
    wave, low = 2 * mp.pi / v["k_c"], v["h_e"] - axis
    moment = abs(v["d_31"]) / v["s_11E"] * v["U_s"] / v["h_p"] * v["b_p"] * mp.quad(lambda z: z, [low, low + v["h_p"]])
    force = 4 * mp.quad(lambda x: moment * v["beta"] * v["k_c"] * mp.cos(v["k_c"] * x), [0, wave / 4])
    mass = mp.quad(
        lambda x: v["rho A"] * mp.cos(v["k_c"] * x) ** 2 + v["rho I"] * (v["beta"] * mp.sin(v["k_c"] * x)) ** 2,
        [0, wave / 4, wave / 2, wave],
    )
    own, drive = 2 * mp.pi * v["f_n"], 2 * mp.pi * hertz
    return abs(force / mass / mp.mpc(own**2 - drive**2, 2 * v["xi"] * own * drive))


@_route("1")
def _one() -> list[Any]:
    v, layers = stator(), stator(180, True)
    middle = v["h_e"] + v["h_p"] / 2
    softer = _hertz({**_sections(), "EI": layers["EI"]})
    return [
        1e3 * v["D"],
        1e3 * layers["D"],
        100 * (v["D"] - layers["D"]) / layers["D"],
        100 * (layers["D"] - v["D"]) / (middle - layers["D"]),
        1e6 * _forced(v["D"], v["f_q"]),
        1e6 * _forced(layers["D"], v["f_q"]),
        softer / 1e3,
        v["f_n"] / 1e3,
        layers["f_n"] / 1e3,
    ]


@_route("equivalent-beam")
def _equivalent() -> list[Any]:
    whole, layers = _sections(), _sections(layered=True)
    softer = _hertz({**whole, "EI": layers["EI"]})
    return [
        whole["EI"],
        layers["EI"],
        100 * (whole["EI"] - layers["EI"]) / layers["EI"],
        softer / 1e3,
        _hertz(whole) / 1e3,
        100 * (_hertz(whole) - softer) / softer,
    ]


@_route("layered-section")
def _layers() -> list[Any]:
    v, layers = stator(), stator(180, True)
    off = [100 * (s["f_n"] - 39703) / 39703 for s in (layers, v)]
    return [layers["f_n"] / 1e3, off[0], v["f_n"] / 1e3, off[1], 100 * (layers["D"] - v["D"]) / v["D"]]


@_route("2")
def _two() -> list[Any]:
    b = _sections()
    return [b["EI"] / b["I_z"], b["rho"], b["I_z"], b["G"], b["A"]]


@_route("4")
def _four() -> list[Any]:
    p = motor()
    return [2 * mp.pi * p["n_j"] / (2 * mp.pi * p["R"]), p["n_j"] / mp.mpf("0.06") * p["l_s"] / (2 * mp.pi)]


def _polynomial(k_f: mp.mpf, cross: bool) -> mp.mpf:
    """The lower root in Hz of the determinant of (3) over kappa G A, with or without what the foundation adds to it."""
    b, k = _sections(), stator()["k_c"]
    S = b["shear"]
    # (S k^2 - rho A w)(EI k^2 + S - rho I w)/S - S k^2 + k_f [1 + (EI k^2 - rho I w)/S]
    squared = b["rho A"] * b["rho I"] / S
    linear = -(b["rho A"] * (b["EI"] * k**2 + S) + b["rho I"] * S * k**2) / S
    constant = b["EI"] * k**4 + k_f
    if cross:
        linear, constant = linear - k_f * b["rho I"] / S, constant + k_f * b["EI"] * k**2 / S
    with mp.workdps(40):
        spread = mp.sqrt(linear**2 - 4 * squared * constant)
        return mp.sqrt((-linear - spread) / (2 * squared)) / (2 * mp.pi)


@_route("5")
def _five() -> list[Any]:
    v = stator()
    full = _polynomial(v["k_f"], cross=True)
    return [_polynomial(v["k_f"], cross=False) - full, v["k_dx"], v["k_f"], _polynomial(v["k_dx"], cross=True) - full]


@_route("k_dx")
def _foundation() -> list[Any]:
    v = stator()
    return [v["k_dx"], v["smeared"], v["k_f"]]


def _eq6(k_f: mp.mpf, k_dx: mp.mpf) -> dict[str, mp.mpf]:
    b, k = _sections(), stator()["k_c"]
    E, density = b["EI"] / b["I_z"], b["rho"]
    S, kappa = b["shear"], motor()["kappa"]
    stiff = mp.matrix([[S * k**2 + k_f, -S * k], [-S * k, b["EI"] * k**2 + S]])
    squares = {
        "printed": (E * b["I_z"] * k**4 + k_dx) / (density * b["A"] + density * (1 / (kappa * b["G"]) + 1 / E) * k**2),
        "eq6": mp.det(stiff) / (stiff[0, 0] * b["rho I"] + stiff[1, 1] * b["rho A"]),
        "euler": (b["EI"] * k**4 + k_f) / b["rho A"],
    }
    found = {name: mp.sqrt(square) / (2 * mp.pi) for name, square in squares.items()}
    return {**found, "quartic": _polynomial(k_f, cross=True)}


@_route("6")
def _six() -> list[Any]:
    v = stator()
    held, free = _eq6(v["k_f"], v["k_dx"]), _eq6(mp.mpf(0), mp.mpf(0))
    return [
        held["printed"],
        held["eq6"],
        100 * (held["printed"] / held["eq6"] - 1),
        held["quartic"],
        held["eq6"] - held["quartic"],
        held["euler"],
        free["printed"],
        free["eq6"],
        free["quartic"],
    ]


@_route("7")
def _seven() -> list[Any]:
    v = stator()
    wave = 2 * mp.pi / v["k_c"]
    ceramic = v["b_p"] * v["h_p"] * v["rho_p"]

    def printed(hertz: mp.mpf) -> mp.mpf:
        ratio, own = hertz / v["f_n"], 2 * mp.pi * v["f_n"]
        push = v["D"] * v["b_p"] * abs(v["d_31"]) / (2 * v["s_11E"]) * 4 * v["U_s"] / mp.pi * (2 * mp.pi / wave) ** 2
        magnified = 1 / abs(mp.mpc(1 - ratio**2, 2 * v["xi"] * ratio))
        return wave * push / (2 * ceramic * wave / 2 * own**2) * magnified

    whole = v["rho A"] + v["rho I"] * v["beta"] ** 2
    on, off = 1e6 * _forced(v["D"], v["f_n"]), 1e6 * _forced(v["D"], v["f_q"])
    return [
        1e6 * printed(v["f_q"]),
        off,
        1e6 * printed(v["f_n"]),
        on,
        whole / ceramic,
        (v["h_e"] + v["h_p"] / 2 - v["D"]) / (v["D"] / 2),
        off / 2,
        on / 2,
        100 * (on - 25.2) / 25.2,
        100 * (on - 12.6) / 12.6,
    ]


@_route("8")
def _eight() -> list[Any]:
    p = motor()
    factor, power = p["C_f"], p["varsigma"]
    return [1e6 * _v("W"), mp.findroot(lambda force: factor * force**-power - 1, mp.mpf(50))]


# --- Section 3: the cycle after a steady start --------------------------------------------------------------
def _turn(angle: Any) -> Any:  # noqa: ANN401
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _supplement(phase: str, s: Sampled, since: Array, start: complex) -> tuple[Array, float, Array]:
    """Length, (Theta + Psi)/2 and slow phase varphi of a phase that is forced and free, by its vector."""
    vector = s.a if phase == "A" else s.b
    psi = np.pi / 2 if phase == "A" else 0.0
    half = float((_turn(np.angle(start) + np.pi / 2) + psi) / 2)
    mean = (_rate("d") + _rate("q")) * since / 2 + (np.pi / 2 if phase == "B" else 0.0)
    return np.abs(vector), half, _turn(np.angle(vector) + np.pi / 2 - mean - half)


def _free(phase: str, index: int) -> complex:
    """The free motion's vector of a phase at the start of a region, after a steady start."""
    at = np.array([_ends()[index] * (1 + 1e-15) + 1e-18])
    s = Drive("steady").phases(at)
    forced = _v("W") * np.exp(1j * _rate("q") * s.since) * (1 if phase == "A" else 1j)
    on = {"A": (0, 1, 1), "B": (1, 0, 1)}[phase][index]
    return complex(((s.a if phase == "A" else s.b) - on * forced)[0])


@_route("supplement-redu")
def _s_redu() -> list[Any]:
    z = _free("A", 0)
    return [1e6 * abs(z), float(np.angle(z) + np.pi / 2)]


def _s_beating(phase: str, index: int) -> list[Any]:
    z, low, high = _free(phase, index), _ends()[index], _ends()[index + 1]
    tiny = 1e-12 * (high - low)
    s = Drive("steady").phases(np.array([low + tiny, high - tiny]))
    length, _, slow = _supplement(phase, s, s.since, z)
    return [1e6 * abs(z), _turn(np.angle(z) + np.pi / 2), 1e6 * length[0], 1e6 * length[1], slow[0], slow[1]]


@_route("supplement-addredu")
def _s_addredu() -> list[Any]:
    return _s_beating("A", 1)


@_route("supplement-add")
def _s_add() -> list[Any]:
    return _s_beating("B", 2)


def _since_t2(s: Sampled) -> Array:
    return s.time - _ends()[1]


def _slip(since: Array) -> Array:
    """By how much the paper's mean angle, with omega_n for omega_d, runs ahead."""
    return (_rate("n") - _rate("d")) / 2 * since


@_route("9")
def _nine() -> list[Any]:
    W, n, decay = _v("W"), _rate("n"), _v("xi") * _rate("n")
    phase = float(np.angle(_free("A", 0)) + np.pi / 2)

    def first(s: Sampled) -> Array:
        return W * np.exp(-decay * s.time) * np.sin(n * s.time + phase) - s.w_A

    def later(s: Sampled) -> Array:
        return np.abs(s.a) * np.cos(np.angle(s.a) + _slip(_since_t2(s))) - s.w_A

    sizes = [100 * _within(i, form) / W for i, form in enumerate((first, later, later))]
    ends = Drive("steady").phases(np.array([_ends()[2], _ends()[3] * (1 - 1e-15)]))
    return [*sizes, math.pi / 2 - phase, *(np.abs(ends.a) / W)]


@_route("10")
def _ten() -> list[Any]:
    more = 3000 / _v("f_n")
    return [100 * more, 1e6 * _v("W") * more]


@_route("11")
def _eleven() -> list[Any]:
    v, layers, edge = stator(), stator(180, True), 2 * math.pi * _v("f_q") * _v("W") * 1e3
    return [
        100 * (v["k_c"] - v["beta"]) / v["beta"],
        edge * _v("D") * _v("k_c"),
        edge * _v("D") * _v("beta"),
        100 * (v["D"] * v["k_c"] / (layers["D"] * layers["beta"]) - 1),
    ]


@_route("13")
def _thirteen() -> list[Any]:
    W, decay = _v("W"), _v("xi") * _rate("n")
    free = abs(_free("B", 1))
    first = _within(0, lambda s: (W * np.exp(-decay * s.time) - np.abs(s.a)) / W)
    return [100 * (1 - W / free), 100 * first]


@_route("14")
def _fourteen() -> list[Any]:
    middle = np.array([(_ends()[1] + _ends()[2]) / 2])
    s, z = Drive("steady").phases(middle), _free("A", 1)
    theta = _turn(np.angle(z) + np.pi / 2)
    _, half, slow = _supplement("A", s, s.since, z)
    printed, derived = theta - np.pi / 2 - np.pi, half + slow[0] - np.pi
    step = 1e-9
    before, after = (Drive("steady").phases(middle + side * step) for side in (-1, 1))
    turned = np.angle(after.b / after.a / (before.b / before.a))[0]
    return [_turn(printed - derived), abs(turned) / (2 * step) / (2 * math.pi)]


@_route("15")
def _fifteen() -> list[Any]:
    lengths = np.diff(_ends()) * 1e3
    return [*lengths, 1e3 / 3000, 2e3 / 3000, 100]


def _off_rate(index: int, row: Callable[[Sampled], Array], phase: str) -> float:
    speed = _v("W") * _rate("q")

    def off(s: Sampled) -> Array:
        return (row(s) - (-s.v_B if phase == "B" else s.v_A)) / speed

    return 100 * _within(index, off)


@_route("18")
def _eighteen() -> list[Any]:
    W, n, xi = _v("W"), _rate("n"), _v("xi")
    mean = (n + _rate("q")) / 2

    def second(s: Sampled) -> Array:
        angle = n * s.since + np.pi / 2
        return W * n * np.exp(-xi * n * s.since) * (xi * np.cos(angle) + np.sin(angle))

    def third(s: Sampled) -> Array:
        return np.abs(s.b) * np.cos(np.angle(s.b) + _slip(s.since) + np.pi / 2)

    right = [lambda s: second(s) * _rate("q") / n, lambda s: -mean * third(s)]
    sizes = [_off_rate(index, row, "B") for index, row in ((1, second), (2, third), (1, right[0]), (2, right[1]))]
    return [*sizes, W * _rate("q")]


@_route("19")
def _nineteen() -> list[Any]:
    W, n, xi = _v("W"), _rate("n"), _v("xi")
    mean = (n + _rate("q")) / 2

    def first(s: Sampled) -> Array:
        angle = n * s.time + np.pi / 2
        return W * n * np.exp(-xi * n * s.time) * (np.cos(angle) - xi * np.sin(angle))

    def later(s: Sampled) -> Array:
        return np.abs(s.a) * np.cos(np.angle(s.a) + np.pi / 2 + _slip(_since_t2(s)))

    start = _off_rate(0, first, "A")
    printed = [_off_rate(i, later, "A") for i in (1, 2)]
    right = [_off_rate(i, lambda s: mean * later(s), "A") for i in (1, 2)]
    return [start, *printed, start, *right, W * _rate("q")]


@_route("20")
def _twenty() -> list[Any]:
    return [100 * (cycle("steady").w_B < 0).mean(), 1e3 * math.pi / _v("k_c")]


@_route("22")
def _twenty_two() -> list[Any]:
    ends = Drive("steady").phases(np.array([0.0, _ends()[3] * (1 - 1e-15)])).height
    scale = _v("D") * _v("k_c")

    def along(s: Sampled) -> Array:
        return scale * s.q / s.height

    return [
        (ends[1] - ends[0]) / _ends()[3],
        *(_whole(lambda s: s.climb, "steady", top) for top in (False, True)),
        along(Drive("steady").phases(count=4 * witness.MANY)).mean(),
        *(_whole(along, "steady", top) for top in (False, True)),
    ]


@_route("23")
def _twenty_three() -> list[Any]:
    s = Drive("steady").phases(np.array([_ends()[1] / 7]))
    scale, a, b = _v("D") * _v("k_c"), s.w_A[0], s.w_B[0]
    along = scale * a  # at x = 0
    return [100 * (((a / scale) ** 2 * along**2 + b**2 * along**2) / (a**2 + b**2) ** 2 - 1)]


def _less_q(form: Callable[[Sampled], Array], unit: float) -> Callable[[Sampled], Array]:
    def off(s: Sampled) -> Array:
        return (form(s) - s.q) / unit

    return off


@_route("24")
def _twenty_four() -> list[Any]:
    W, n, q, xi = _v("W"), _rate("n"), _rate("q"), _v("xi")
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
        angle = half_b + slow_b - mean * (_ends()[2] - _ends()[1]) * (half_a + slow_a - np.pi / 2)
        return length_a * length_b * mean * np.sin(angle)

    def second_right(s: Sampled) -> Array:
        angle = n * s.since + np.pi / 2 - np.angle(s.a) - _slip(s.since)
        return np.abs(s.a) * W * q / n * np.exp(-xi * n * s.since) * (mean + n) / 2 * np.sin(angle)

    def third_right(s: Sampled) -> Array:
        angle = np.angle(s.b) + _slip(s.since) - np.angle(s.a) - _slip(_since_t2(s))
        return np.abs(s.a) * np.abs(s.b) * mean * np.sin(angle)

    found: list[Any] = []
    for index, (printed, right) in enumerate(((first, first), (second, second_right), (third, third_right))):
        low, high = _ends()[index], _ends()[index + 1]
        s = Drive("steady").phases(low + (np.arange(400000) + 0.5) / 400000 * (high - low))
        first_size, last_size = (100 * _within(index, _less_q(form, unit)) for form in (printed, right))
        found += [first_size, 100 * (printed(s) * s.q < 0).mean(), last_size]
    return found


# --- Section 4 ----------------------------------------------------------------------------------------------
@_route("25")
def _twenty_five() -> list[Any]:
    p, W = motor(), stator()["W"]
    curve = 2 * p["r_t"] ** 2 / (p["n_j"] ** 2 * W)
    return [curve, 20, 2 * p["r_t"] ** 2 / (20**2 * W), 2 * (2 * p["r_t"]) ** 2 / (p["n_j"] ** 2 * W)]


def _compliances() -> tuple[mp.mpf, mp.mpf]:
    p = motor()
    soft = (1 - p["h_t"] / p["h_e"]) ** 3 * p["E_e"]
    layer = (1 - p["mu_m"] ** 2) / p["E_m"]
    return (1 - p["mu_e"] ** 2) / soft + layer, (1 - p["mu_e"] ** 2) / p["E_e"] + layer


@_route("C_E")
def _compliance() -> list[Any]:
    soft, solid = _compliances()
    return [soft, solid, 100 * (mp.sqrt(solid) - mp.sqrt(soft)) / mp.sqrt(soft)]


@_route("26")
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


@_route("27")
def _twenty_seven() -> list[Any]:
    return [1e3 * stator()["theta"] / stator()["k_c"]]


@_route("28")
def _twenty_eight() -> list[Any]:
    W, edge = stator()["W"], mp.cos(stator()["theta"])
    return [1e6 * W * edge, 1e6 * W, 1e6 * W * (1 - edge)]


@_route("29")
def _twenty_nine() -> list[Any]:
    v = stator()
    crest = 1e3 * v["D"] * v["k_c"] * 2 * mp.pi * v["f_q"] * v["W"]
    return [crest * mp.cos(v["theta"]), crest]


@_route("30")
def _thirty() -> list[Any]:
    v, nu = stator(), stator()["mu_m"]
    # strains 0 across and along, 1 upward, in Hooke's law
    hooke = mp.matrix([[1, -nu, -nu], [-nu, 1, -nu], [-nu, -nu, 1]])
    held = mp.lu_solve(hooke, mp.matrix([0, 0, 1]))[2]
    return [v["E_m"] * v["b_m"] / v["h_m"], held]


@_route("31")
def _thirty_one() -> list[Any]:
    v = stator()
    one = witness.contact_angle(2 * v["F_c"] * v["k_c"] / (v["k_N"] * v["W"]))
    rub = v["mu"] * v["F_c"]
    return [v["n_j"], one, v["theta"], v["F_c"], rub * 2 * v["n_j"], 2 * v["n_j"], rub]


@_route("32")
def _thirty_two() -> list[Any]:
    v = stator()
    top = v["k_N"] * v["W"] * (1 - mp.cos(v["theta"]))
    return [top, top / v["b_m"] / 1e6]


@_route("33")
def _thirty_three() -> list[Any]:
    return [100 * (cycle().v_A < 0).mean()]


@_route("34")
def _thirty_four() -> list[Any]:
    edge = _v("D") * _v("k_c") * _rate("q") * _v("W")
    shift = (math.pi / 6 - math.asin(_v("W") / 2)) / _v("k_c")
    angle, ratio = np.meshgrid((np.arange(4000) + 0.5) / 4000 * 2 * np.pi - np.pi / 2, np.linspace(-0.99, 0.99, 100))
    a, b, arc = np.cos(angle), np.sin(angle), np.arcsin(ratio)
    place = np.select([b >= 0, a > 0], [arc - angle, -np.pi - arc - angle], np.pi - arc - angle)
    return [_v("W"), 1e3 * edge, 1e3 * shift, 100 * ((place < -np.pi / 2) | (place > 1.5 * np.pi)).mean()]


def _table_4() -> float:
    return 633 / 3600 * math.pi / 180 * _v("r_c")


def _seen_from_crest(s: Sampled) -> tuple[Array, Array, Array, Array]:
    """phi, R, theta, and the crest's place, from the surface's velocity at the crest and a quarter wave on."""
    scale, crest = _v("D") * _v("k_c"), np.arctan2(s.w_A, s.w_B)
    at = [scale * (s.v_A * np.cos(u) - s.v_B * np.sin(u)) for u in (crest, crest + np.pi / 2)]
    return np.arctan2(at[1], at[0]), np.hypot(*at), zones(s.height), crest


@_route("35")
def _thirty_five() -> list[Any]:
    import sympy as sp

    from derivations.ledger.section_4_nonsliding import EQ35
    from derivations.nomenclature import sym

    x_px, k_c = sym("x_px k_c")
    s = Drive("periodic").phases(count=400000)
    angle, R, zone, crest = _seen_from_crest(s)
    crest, ratio = (crest + np.pi / 2) % (2 * np.pi) - np.pi / 2, _table_4() / R
    opening = np.arccos(np.clip(ratio, -1, 1))
    ends = np.array([angle + side * opening + turn for side in (1, -1) for turn in (-2 * np.pi, 0, 2 * np.pi)])
    inside = (ends > 0) & (ends < zone)
    single = inside.sum(0) == 1
    root = np.where(inside, ends, 0).sum(0)
    psi = (np.pi / 2 - angle - crest + np.pi / 2) % (2 * np.pi) - np.pi / 2
    arc = np.arcsin(np.clip(ratio, -1, 1))
    place = np.where(np.sin(psi) >= 0, arc - psi, np.where(np.cos(psi) > 0, -np.pi, np.pi) - arc - psi)
    first, k = np.arctan(np.cos(psi) / np.sin(psi)), _v("k_c")
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


@_route("36")
def _thirty_six() -> list[Any]:
    speed, rub = _table_4(), _v("mu") * _v("F_c")
    whole, half = (_rubbed(speed, part) for part in (False, True))
    heights = [_whole(lambda s: s.height, "periodic", top) for top in (True, False)]
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
    return float(_rubbed(0.0, half=False).mean()) * _v("mu") * _v("F_c") * _v("r_c")


@_route("37")
def _thirty_seven() -> list[Any]:
    return [_at_rest()]


@_route("transfer-cases")
def _cases() -> list[Any]:
    s = cycle()
    angle, R, zone, _ = _seen_from_crest(s)
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


@_route("38")
def _thirty_eight() -> list[Any]:
    return [_v("mu") * _v("F_c") * _v("r_c"), _at_rest()]


@_route("reverse-model")
def _reverse() -> list[Any]:
    return [2 * _v("mu") * _v("F_c")]


@_route("rotor-flange")
def _flange() -> list[Any]:
    """The plate's edge by Taylor's series of its equation, from two clamped starts; the half-angle by bisection."""
    p = motor()
    k, nu, length = stator()["k_c"], p["mu_f"], p["l_f"]

    def slopes(_: Any, w: Any) -> list[Any]:  # noqa: ANN401
        return [w[1], w[2], w[3], 2 * k**2 * w[2] - k**4 * w[0]]

    ends = [mp.odefun(slopes, 0, [0, 0, *start])(length) for start in ((1, 0), (0, 1))]
    moments = [w[2] - nu * k**2 * w[0] for w in ends]
    forces = [(2 - nu) * k**2 * w[1] - w[3] for w in ends]
    share = -moments[0] / moments[1]
    bending = p["E_f"] * p["h_f"] ** 3 / 12 / (1 - nu**2)
    plate = bending * (forces[0] + share * forces[1]) / (ends[0][0] + share * ends[1][0])
    tooth = p["E_e"] * p["b_e"] * (p["l_s"] / p["n_s"] - p["b_s"]) / (p["l_s"] / p["n_s"]) / p["h_t"]
    layer = p["E_m"] * p["b_m"] / p["h_m"]
    whole = 1 / (1 / plate + 1 / tooth + 1 / layer)
    scale = 2 * p["n_j"] * _v("W") / (k * _v("F_c"))

    def angle(stiffness: Any) -> Any:  # noqa: ANN401
        low, high = mp.mpf(0), +mp.pi
        for _ in range(80):
            middle = (low + high) / 2
            carried = scale * stiffness * (mp.sin(middle) - middle * mp.cos(middle))
            low, high = (middle, high) if carried < 1 else (low, middle)
        return low

    return [
        1e3 * p["h_f"],
        1e3 * length,
        plate / 1e9,
        tooth / 1e9,
        layer / 1e9,
        whole / 1e9,
        angle(whole),
        angle(layer),
    ]


@_route("rotor-orbit")
def _orbit() -> list[Any]:
    """Two rotors through a lap by the midpoint rule, friction summed point by point."""
    steps, most = 5000, _v("mu") * _v("F_c")
    s = Drive("periodic").phases(np.arange(2 * steps + 1) / (2 * steps) * _ends()[3] * (1 - 1e-15))
    angle, R, zone, _ = _seen_from_crest(s)
    spread = (np.arange(3000) + 0.5) / 1500 - 1
    ends = []
    for speed in (-4.0, 4.0):
        for i in range(steps):
            rate = speed
            for at, share in ((2 * i, 0.5), (2 * i + 1, 1.0)):
                u = zone[at] * spread
                press = np.cos(u) - np.cos(zone[at])
                net = float((np.sign(R[at] * np.cos(u - angle[at]) - rate) * press).sum() / press.sum())
                force = most * net - 0.3 / _v("r_c")
                rate = speed + share * _ends()[3] / steps * force * _v("r_c") ** 2 / _v("J")
            speed = rate
        ends.append(speed)
    return [100 * (ends[1] - ends[0]) / 8, most * _v("r_c")]


@_route("load-inertia")
def _load_inertia() -> list[Any]:
    """Of a weight that pulls 0.3 N m at 30 mm: by moments of force, and by the receptances of two bodies."""
    weight = 0.3 / 0.03  # N
    mass, friction, rate = weight / 9.80665, _v("mu") * 180 * _v("r_c"), 2 * math.pi / _ends()[3]
    wire = 2.1e11 * math.pi * 0.25e-3**2 / 0.3
    # rotor falls freely with the string's end: friction alone makes the angular acceleration g / r
    slack = -9.80665 / 0.03 * _v("J") / friction
    plate = friction / (9.80665 / 0.03) - _v("J")
    through = 1 / (-1 / (mass * rate**2) + 1 / wire)  # spring and mass in series
    met = (_v("J") * rate**2 - through * 0.03**2) / rate**2 / _v("J")
    added = mass * 0.03**2
    return [mass, added, added / _v("J"), slack, plate, 1 / _ends()[3], mass * rate**2, wire, met]


@_route("wave-reaction")
def _wave_reaction() -> list[Any]:
    """Mass and forces by sums along the ring; shifts and the force needed by complex dynamic stiffness."""
    v = stator()
    free, ratio = mp.re(resonance(v, v["k_c"], mp.mpf(0))[0]), v["beta"]
    angle = 2 * mp.pi * (np.arange(3600) + mp.mpf(1) / 2) / 3600
    ring = 2 * mp.pi * v["n_j"] / v["k_c"]
    lively = [v["rho A"] * mp.sin(a) ** 2 + v["rho I"] * (ratio * mp.cos(a)) ** 2 for a in angle]
    mass = ring * mp.fsum(lively) / len(lively)
    own, low = 2 * mp.pi * free, v["h_e"] - v["D"]
    measured = abs(mass * mp.mpc(0, 2 * v["xi"] * own * own)) * v["W_max"]
    moment = abs(v["d_31"]) / v["s_11E"] * v["U_s"] / v["h_p"] * v["b_p"] * v["h_p"] * (low + v["h_p"] / 2)
    ceramic = v["n_j"] * moment * ratio * mp.quad(lambda a: abs(mp.cos(a)), [k * mp.pi / 2 for k in range(5)])
    lifted = [
        mp.sqrt(own**2 * mass + 180 / height) / mp.sqrt(mass) / 2 / mp.pi - free
        for height in (12.6e-6, 5.56e-6, 1.5e-6)
    ]
    at, drive = 2 * mp.pi * v["f_n"], 2 * mp.pi * v["f_q"]
    needed = v["W"] * mass * abs(at**2 - drive**2 + mp.mpc(0, 2 * v["xi"] * at * drive))
    return [
        1e3 * mass,
        12.6,
        measured,
        ceramic,
        ceramic / 9 * 4,
        180,
        *lifted,
        1e6 * v["W"],
        needed,
        needed / measured,
    ]


@_route("electrical-port")
def _electrical_port() -> list[Any]:
    """Factor by sums of the charge along the ring, capacitance by k_31, circuit by Q and by the two frequencies."""
    v = stator()
    mass, _, force, *_ = _wave_reaction()
    own = 2 * mp.pi * mp.re(resonance(v, v["k_c"], mp.mpf(0))[0])
    square = v["d_31"] ** 2 / v["s_11E"] / v["eps_33T"]  # k_31
    area = 2 * mp.pi * v["n_j"] / v["k_c"] * v["b_p"]
    held = v["eps_33T"] * (1 - square) * area / v["h_p"]
    angle = 2 * mp.pi * (np.arange(7200) + mp.mpf(1) / 2) / 7200
    middle = v["h_e"] - v["D"] + v["h_p"] / 2
    strain = mp.fsum(abs(mp.cos(a)) for a in angle) / len(angle) * v["beta"] * v["k_c"] * middle
    factor = abs(v["d_31"]) / v["s_11E"] * strain * area
    quality, branch = 1 / (2 * v["xi"]), factor**2 / (mass / 1000 * own**2)
    resistance = 1 / (quality * own * branch)
    current = v["U_s"] / resistance
    parallel = own * mp.sqrt(1 + branch / held)
    return [
        factor,
        force / v["U_s"],
        12.6,
        1e9 * held,
        4e9 * held / 9,
        resistance,
        current,
        v["U_s"],
        current**2 * resistance / 2,
        (parallel - own) / (2 * mp.pi),
        mp.sqrt(1 - (own / parallel) ** 2),
    ]


# --- Tables -------------------------------------------------------------------------------------------------
@_route("table-1-R")
def _table_r() -> list[Any]:
    return [motor()["n_j"] / mp.mpf("0.06"), _hertz(_sections(), k=mp.mpf(150)) / 1e3, stator()["f_n"] / 1e3]


@_route("table-1-heights")
def _table_heights() -> list[Any]:
    v, changed = stator(), {"h_t": mp.mpf("0.0045"), "h_e": mp.mpf("0.002")}
    swapped, _ = resonance(_sections(**changed), v["k_c"], v["k_f"])
    return [motor()["E_e"] * (1 - mp.mpf("2.25")) ** 3 / 1e9, mp.im(swapped) / 1e3, v["f_n"] / 1e3]


@_route("table-1-isotropy")
def _table_isotropy() -> list[Any]:
    p = motor()
    shear = {f"G_{part}": p[f"E_{part}"] / 2 / (1 + p[f"mu_{part}"]) for part in "ep"}
    found = _hertz(_sections(**shear))
    return [shear["G_e"] / 1e9, shear["G_p"] / 1e9, found - stator()["f_n"], 100 * (found / stator()["f_n"] - 1)]


@_route("table-1-J")
def _table_j() -> list[Any]:
    return [1e3 * _v("J") / _v("r_c") ** 2, _v("mu") * 180 * _v("r_c") / _v("J")]


@_route("table-1-kappa")
def _table_kappa() -> list[Any]:
    nu = motor()["mu_e"]
    cowper = (10 + 10 * nu) / (12 + 11 * nu)
    return [cowper, _hertz(_sections(kappa=cowper)) - stator()["f_n"]]


@_route("table-1-U_s")
def _table_voltage() -> list[Any]:
    return [100 * (400 / 200) - 100]


@_route("table-2")
def _table_2() -> list[Any]:
    force = np.array([100, 120, 140, 160, 180, 200, 220.0])
    size = np.array([8.3, 7.3, 6.6, 6.0, 5.5, 5.2, 4.8])
    slope, level = np.polyfit(np.log(force), np.log(size), 1)
    p = motor()
    printed = [float(p[name]) for name in ("C_f", "varsigma", "W_max")]
    meet = mp.findroot(lambda f: printed[0] * f ** -printed[1] - 1, 50)
    return [math.exp(level + slope * math.log(180)), 1e6 * _v("W"), -slope - 0.678, meet]


@_route("table-3")
def _table_3() -> list[Any]:
    return [-(20 - 14)]


@_route("table-4")
def _table_4_units() -> list[Any]:
    return [math.radians(633 / 3600)]


@_route("table-5")
def _table_5() -> list[Any]:
    turns, f_n = 3300 / 2 / math.pi, _v("f_n")
    return [turns, 1e3 / turns, (f_n + turns) / 20 / turns, 1 / 3.3, (f_n + 3300) / 20 / 3300]


# --- Sections 6 and 7 ---------------------------------------------------------------------------------------
@_route("39")
def _thirty_nine() -> list[Any]:
    return [2e-3 * _v("f_q") / 20, 2e4 / _v("f_q")]


@_route("40")
def _forty() -> list[Any]:
    return [2e4 / _v("f_q")]


@_route("41")
def _forty_one() -> list[Any]:
    draw = np.random.default_rng(1).normal(size=100)
    return [100 * (draw.std(ddof=1) / draw.std() - 1)]


_NOTHING = 1e-9  # of W^2 omega_q: what rounding leaves where only one phase moves


def _senses(s: Sampled) -> tuple[Array, Array]:
    """Q over D k_c W^2 omega_q, its forward part and its backward part."""
    q = s.q / (_v("W") ** 2 * _rate("q"))
    return np.where(q > _NOTHING, q, 0.0), np.where(q < -_NOTHING, -q, 0.0)


@_route("Q(t)")
def _q_t() -> list[Any]:
    return [100 * (_senses(cycle(start))[0] > 0).mean() for start in _STARTS]


@_route("42")
def _forty_two() -> list[Any]:
    rise, q = (lambda s: np.abs(s.w_A * s.v_A + s.w_B * s.v_B)), (lambda s: np.abs(s.q))
    s = cycle()
    return [
        _whole(rise, "periodic", True),
        _v("D") * _v("k_c") * _whole(q, "periodic", True),
        100 * (s.climb * s.q < 0).mean(),
    ]


@cache
def _sums(start: str) -> tuple[float, float, float, float]:
    ahead, back = _senses(cycle(start))
    return float(ahead.sum()), float(back.sum()), float((ahead**2).sum()), float((back**2).sum())


def _average(start: str) -> float:
    ahead, back, _, _ = _sums(start)
    return (ahead - back) / (ahead + back) * _v("f_q") / 20


@_route("43")
def _forty_three() -> list[Any]:
    found = []
    for start in _STARTS:
        ahead, back = _senses(cycle(start))
        last = [int((part > 0).sum()) for part in (ahead, back)]
        sums = ahead[: last[0]].sum(), back[: last[1]].sum()
        found += [_average(start), (sums[0] - sums[1]) / (sums[0] + sums[1]) * _v("f_q") / 20]
    return found


def _root(start: str) -> complex:
    _, _, ahead, back = _sums(start)
    return complex(ahead + back) ** 0.5 / complex(ahead - back) ** 0.5


@_route("44")
def _forty_four() -> list[Any]:
    found, per = [], _v("f_q") / 20
    for start in _STARTS:
        printed = _root(start) * per**2 / _average(start)
        ratio = _sums(start)[2] / _sums(start)[3]
        found += [
            printed.real if abs(printed.imag) < 1e-6 * abs(printed) else printed.imag,
            abs(_root(start)) * per**2 / _average(start),
            ratio,
        ]
    return [*found, per]


@_route("45")
def _forty_five() -> list[Any]:
    beat = 1e3 / (45000 - 39703)
    damped = 39703 * math.sqrt(1 - _v("xi") ** 2)
    change = 100 * (1 - 1e3 / (45000 - damped) / beat)
    return [beat, 100 * (0.188 - beat) / beat, 100 * (0.19 - beat) / beat, change]


@_route("decay")
def _decay() -> list[Any]:
    seconds = 1 / (0.006 * _rate("n"))
    return [math.exp(2 * math.pi * 0.006), 1e3 * seconds, seconds * _v("f_q") / 20]


# --- Appendices ---------------------------------------------------------------------------------------------
@_route("A7")
def _a7() -> list[Any]:
    return [(_v("f_n") + _v("f_q")) / 3000]


@_route("A8")
def _a8() -> list[Any]:
    return [100 * 3000 / (_v("f_n") + _v("f_q"))]


@_route("A9")
def _a9() -> list[Any]:
    return [1 / 3]


@_route("A11")
def _a11() -> list[Any]:
    return [1e6 * _v("W"), 1e6 * _v("W") * _v("D") * _v("k_c")]


def _enclosed(a: complex, b: complex) -> float:
    """Area in um^2 of the path of two turning phases of constant size, as a polygon."""
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 200001))
    up, along = (b * turn).real, _v("D") * _v("k_c") * (a * turn).real  # at x = 0
    return 1e12 * abs(float((along[:-1] * up[1:] - along[1:] * up[:-1]).sum())) / 2


@_route("A13")
def _a13() -> list[Any]:
    W, end = _v("W"), _ends()[1]
    s = Drive("steady").phases(np.array([end * (1 - 1e-14)]))
    drift = 2 * math.pi * 3000 * end
    return [_enclosed(W, 1j * W), 1e6 * abs(s.a[0]), drift, _enclosed(complex(s.a[0]), complex(s.b[0]))]


@_route("A14")
def _a14() -> list[Any]:
    ahead, back, _, _ = _sums("periodic")
    return [ahead / back, _average("periodic")]


@_route("A15")
def _a15() -> list[Any]:
    ahead, back, _, _ = _sums("periodic")
    X, h = ahead / back, 1e-4
    slope = ((X + h - 1) / (X + h + 1) - (X - h - 1) / (X - h + 1)) / (2 * h) * _v("f_q") / 20
    return [slope, 100 * ((_v("f_n") + 2800) / (_v("f_n") + 3300) - 1)]


@_route("A16")
def _a16() -> list[Any]:
    found: list[Any] = []
    for start in ("periodic", "steady"):
        root, ratio = _root(start), _sums(start)[2] / _sums(start)[3]
        found += [root.real if abs(root.imag) < 1e-9 else root.imag, ratio, abs(root)]
    return found


@_route("A17")
def _a17() -> list[Any]:
    _, _, ahead, back = _sums("periodic")
    Y, h = ahead / back, 1e-5
    slope = (math.sqrt((Y + h + 1) / (Y + h - 1)) - math.sqrt((Y - h + 1) / (Y - h - 1))) / (2 * h)
    return [Y, -2 / (Y - 1), slope, -2 / (Y - 1) / slope]


# --- Statements ---------------------------------------------------------------------------------------------
@_route("claim-half-beat")
def _half_beat() -> list[Any]:
    found: list[Any] = []
    for start in _STARTS:
        s = cycle(start)
        ahead = _senses(s)[0] > 0
        found += [100 * ahead[s.region == region].mean() for region in range(3)]
    return [*found, 6 * 3000 / _v("f_q")]


@_route("claim-crest")
def _crest() -> list[Any]:
    speed = _whole(lambda s: np.hypot(s.v_A, s.v_B), "periodic", True)
    rms = math.sqrt(float((Drive("periodic").phases(count=4 * witness.MANY).climb ** 2).mean()))
    return [1e3 * _whole(lambda s: np.abs(s.climb), "periodic", True), 1e3 * rms, 1e3 * _v("D") * _v("k_c") * speed]


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


@_route("claim-proportional")
def _proportional() -> list[Any]:
    W, step = stator()["W"], mp.mpf("1e-4")
    ends = [mp.log(_balanced(W * mp.exp(side * step)) * mp.exp(side * step)) for side in (-1, 1)]
    sizes = stator(210)["W"] / stator(160)["W"]
    return [_balanced(W), (ends[1] - ends[0]) / (2 * step), 100 * (1 - sizes), 100 * (1 - sizes**2)]


@_route("claim-contact")
def _contact() -> list[Any]:
    v = stator()
    lowest = [1e9 * _whole(lambda s: s.height, start, False) for start in ("periodic", "steady")]
    return [*lowest, 1e9 * v["F_c"] / (v["n_j"] * 2 * mp.pi / v["k_c"]) / v["k_N"]]


@_route("claim-T_Qall")
def _constant() -> list[Any]:
    f_n = {force: stator(force)["f_n"] for force in (160, 180, 210)}
    return [100 * ((f_n[180] + 2800) / (f_n[180] + 3300) - 1), 100 * ((f_n[160] + 3000) / (f_n[210] + 3000) - 1)]


@_route("claim-one-beat")
def _one_beat() -> list[Any]:
    return [45 * 3000 / _v("f_q"), 6 * 3000 / _v("f_q")]


@_route("claim-add-beat")
def _add_beat() -> list[Any]:
    return [2e6 / (_v("f_n") + _v("f_q")), (_v("f_n") + _v("f_q")) / 2 / 3000]


@_route("claim-Q_vib")
def _trend() -> list[Any]:
    found: list[Any] = []
    for start in _STARTS:
        ahead, back, ahead_2, back_2 = _sums(start)
        found += [ahead / back, ahead_2 / back_2]
    forward, backward = _senses(Drive("periodic", 100, 55, 4000.0, 1).phases(count=3_000_000))
    return [*found, backward.sum() / forward.sum(), (backward**2).sum() / (forward**2).sum()]
