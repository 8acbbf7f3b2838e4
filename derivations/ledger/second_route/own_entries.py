"""Entries of our own: flange, orbit, bench, coupling, layer, electrical port."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np

from derivations.ledger.second_route.common import at_table_3, rate_of, region_ends, route
from derivations.ledger.second_route.section_4 import seen_from_crest
from derivations.ledger.witness import Array, Drive, motor, resonance, stator


@route("rotor-flange")
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
    scale = 2 * p["n_j"] * at_table_3("W") / (k * at_table_3("F_c"))

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


@route("rotor-orbit")
def _orbit() -> list[Any]:
    """Two rotors through a lap by the midpoint rule, friction summed point by point."""
    steps, most = 5000, at_table_3("mu") * at_table_3("F_c")
    s = Drive("periodic").phases(np.arange(2 * steps + 1) / (2 * steps) * region_ends()[3] * (1 - 1e-15))
    angle, R, zone, _ = seen_from_crest(s)
    spread = (np.arange(3000) + 0.5) / 1500 - 1
    ends = []
    for speed in (-4.0, 4.0):
        for i in range(steps):
            rate = speed
            for at, share in ((2 * i, 0.5), (2 * i + 1, 1.0)):
                u = zone[at] * spread
                press = np.cos(u) - np.cos(zone[at])
                net = float((np.sign(R[at] * np.cos(u - angle[at]) - rate) * press).sum() / press.sum())
                force = most * net - 0.3 / at_table_3("r_c")
                rate = speed + share * region_ends()[3] / steps * force * at_table_3("r_c") ** 2 / at_table_3("J")
            speed = rate
        ends.append(speed)
    return [100 * (ends[1] - ends[0]) / 8, most * at_table_3("r_c")]


@route("load-inertia")
def _load_inertia() -> list[Any]:
    """Of a weight that pulls 0.3 N m at 30 mm: by moments of force, and by the receptances of two bodies."""
    weight = 0.3 / 0.03  # N
    mass, friction, rate = weight / 9.80665, at_table_3("mu") * 180 * at_table_3("r_c"), 2 * math.pi / region_ends()[3]
    wire = 2.1e11 * math.pi * 0.25e-3**2 / 0.3
    # rotor falls freely with the string's end: friction alone makes the angular acceleration g / r
    slack = -9.80665 / 0.03 * at_table_3("J") / friction
    plate = friction / (9.80665 / 0.03) - at_table_3("J")
    through = 1 / (-1 / (mass * rate**2) + 1 / wire)  # spring and mass in series
    met = (at_table_3("J") * rate**2 - through * 0.03**2) / rate**2 / at_table_3("J")
    added = mass * 0.03**2
    return [mass, added, added / at_table_3("J"), slack, plate, 1 / region_ends()[3], mass * rate**2, wire, met]


@route("wave-reaction")
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


@route("lossy-layer")
def _lossy_layer() -> list[Any]:
    """Ends of the contact by bisection, of the level by the load and of its beginning by the recovering depth; sums."""
    eta, size = 0.1, at_table_3("W")
    stiff = at_table_3("n_j") / at_table_3("k_c") * at_table_3("k_N")

    def contact(level: float) -> tuple[float, float]:
        out = halved(lambda u: math.cos(u) + eta * math.sin(u) - level, -math.pi + eta, 0.0)
        left = math.cos(out) - level

        def free(u: float) -> float:
            return left * math.exp(-(2 * math.pi + out - u) / eta)

        return out, halved(lambda u: free(u) - math.cos(u) + level, 0.0, math.pi)

    def halved(rises: Callable[[float], float], low: float, high: float) -> float:
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if rises(middle) < 0 else (low, middle)
        return low

    def pressure(level: float) -> tuple[Array, Array, float]:
        out, into = contact(level)
        u = out + (into - out) * (np.arange(200_000) + 0.5) / 200_000
        return u, np.cos(u) + eta * np.sin(u) - level, (into - out) / u.size

    def lacks(level: float) -> float:
        _, press, width = pressure(level)
        return 180 - stiff * size * float(press.sum()) * width

    level = halved(lacks, 0.0, 0.9999)
    u, press, width = pressure(level)
    power = stiff * size**2 * float((press * np.sin(u)).sum()) * width * rate_of("q")
    theta = at_table_3("theta")
    u = theta * (2 * (np.arange(200_000) + 0.5) / 200_000 - 1)
    bare = stiff * size**2 * eta * float((np.sin(u) ** 2).mean()) * 2 * theta * rate_of("q")
    return [eta, power, 1e6 * size, 180, *contact(level), theta, bare]


@route("sheared-layer")
def _sheared_layer() -> list[Any]:
    """By Young's and the shear modulus; the greatest stress less limit of a wave by a scan, both linear in it."""
    shear = at_table_3("E_m") / 2 / (1 + at_table_3("mu_m")) * at_table_3("b_m") / at_table_3("h_m")
    gripped = shear * at_table_3("D") * at_table_3("k_c") / at_table_3("mu") / at_table_3("k_N")
    u = np.linspace(0, math.pi, 2_000_001)
    most = float((gripped * np.sin(u) - np.cos(u)).max())
    mean = (
        180 / (2 * math.pi * at_table_3("n_j") / at_table_3("k_c")) / at_table_3("k_N")
    )  # depth pressed in where all touches
    return [gripped, 180, 1e9 * mean / most, 1 / most]


@route("electrical-port")
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
