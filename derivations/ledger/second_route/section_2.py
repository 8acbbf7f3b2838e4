"""Sect. 2: section, resonance, amplitude."""

from __future__ import annotations

from typing import Any

import mpmath as mp

from derivations.ledger.second_route.common import at_table_3, beam_of, hertz_of, route
from derivations.ledger.witness import motor, stator


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


@route("1")
def _one() -> list[Any]:
    v, layers = stator(), stator(180, True)
    middle = v["h_e"] + v["h_p"] / 2
    softer = hertz_of({**beam_of(), "EI": layers["EI"]})
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


@route("equivalent-beam")
def _equivalent() -> list[Any]:
    whole, layers = beam_of(), beam_of(layered=True)
    softer = hertz_of({**whole, "EI": layers["EI"]})
    return [
        whole["EI"],
        layers["EI"],
        100 * (whole["EI"] - layers["EI"]) / layers["EI"],
        softer / 1e3,
        hertz_of(whole) / 1e3,
        100 * (hertz_of(whole) - softer) / softer,
    ]


@route("layered-section")
def _layers() -> list[Any]:
    v, layers = stator(), stator(180, True)
    off = [100 * (s["f_n"] - 39703) / 39703 for s in (layers, v)]
    return [layers["f_n"] / 1e3, off[0], v["f_n"] / 1e3, off[1], 100 * (layers["D"] - v["D"]) / v["D"]]


@route("2")
def _two() -> list[Any]:
    b = beam_of()
    return [b["EI"] / b["I_z"], b["rho"], b["I_z"], b["G"], b["A"]]


@route("4")
def _four() -> list[Any]:
    p = motor()
    return [2 * mp.pi * p["n_j"] / (2 * mp.pi * p["R"]), p["n_j"] / mp.mpf("0.06") * p["l_s"] / (2 * mp.pi)]


def _polynomial(k_f: mp.mpf, cross: bool) -> mp.mpf:
    """The lower root in Hz of the determinant of (3) over kappa G A, with or without what the foundation adds to it."""
    b, k = beam_of(), stator()["k_c"]
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


@route("5")
def _five() -> list[Any]:
    v = stator()
    full = _polynomial(v["k_f"], cross=True)
    return [_polynomial(v["k_f"], cross=False) - full, v["k_dx"], v["k_f"], _polynomial(v["k_dx"], cross=True) - full]


@route("k_dx")
def _foundation() -> list[Any]:
    v = stator()
    return [v["k_dx"], v["smeared"], v["k_f"]]


def _eq6(k_f: mp.mpf, k_dx: mp.mpf) -> dict[str, mp.mpf]:
    b, k = beam_of(), stator()["k_c"]
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


@route("6")
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


@route("7")
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


@route("8")
def _eight() -> list[Any]:
    p = motor()
    factor, power = p["C_f"], p["varsigma"]
    return [1e6 * at_table_3("W"), mp.findroot(lambda force: factor * force**-power - 1, mp.mpf(50))]
