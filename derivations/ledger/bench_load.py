"""What eq. 38 leaves out: the inertia of plate and weight of Sect. 8.1, and when the weight's string goes slack."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations import bench
from derivations.ledger.history import values
from derivations.ledger.judge import figure, largest
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import CONSTANTS, sym
from trum_sym.inputs.units import parse_unit

__all__ = ["ENTRIES"]

J, J_load, T_load, r_s, r_c, mu, F_c, f, g = bench.J, bench.J_load, *sym("T_load r_s r_c mu F_c f g")
Omega, stiffness = bench.Omega, bench.stiffness
_KNOWN = {Omega: parse_unit("rad/s").dimension, stiffness: parse_unit("N/m").dimension}
_RADIUS, _LOAD = 0.030, 0.3  # m and N m: the stator's, the least at which a string passes the motor; Table 3
_WIRE = (2.1e11, 0.5e-3, 0.3)  # Pa, m, m: modulus, thickness and length of a steel wire
_SYMBOLS = (J, J_load, T_load, r_s, r_c, mu, F_c, f, g, Omega, stiffness)


def _derive() -> Derivation:
    forms = {"J_total": bench.inertia(), "tension": bench.tension(), "J_met": bench.stretched()}
    weight = bench.mass()
    q, pull, turn = sp.symbols("q S turn", real=True)
    lifted = r_c * mu * F_c * f
    return Derivation(
        (
            step(
                "A weight of mass m on a string at the radius r_s holds the load's torque where nothing accelerates:",
                sp.Eq(sp.Symbol("m"), weight),
                zero=weight * g * r_s - sp.Abs(T_load),
            ),
            step(
                "The rotor turns with a plate of J_load under friction q and the string's pull S, in the sense that "
                "lifts the weight; on a taut string the weight's acceleration is r_s times the rotor's:",
                sp.Eq((J + J_load) * turn, q - pull * r_s),
                sp.Eq(sp.Symbol("m") * r_s * turn, pull - sp.Symbol("m") * g),
            ),
            step(
                "Without S the two are one body under q - |T_load|, of the moment of inertia",
                forms["J_total"],
                zero=(J + J_load) + weight * r_s**2 - forms["J_total"],
            ),
            step(
                "The pull over the weight, friction being q = r_c mu F_c f:",
                forms["tension"],
                zero=1 + r_s * (lifted - sp.Abs(T_load)) / forms["J_total"] / g - forms["tension"],
            ),
            step(
                "A string does not push: below 0 it is slack and the rotor is alone with its plate. It is taut "
                "whatever friction does if r_s r_c mu F_c <= g (J + J_load), f being -1 at least.",
            ),
            step(
                "A string gives. With a spring of k_string between rotor and weight a torque of the angular frequency "
                "Omega meets",
                forms["J_met"],
                zero=[
                    sp.limit(forms["J_met"], stiffness, sp.oo) - forms["J_total"],
                    sp.limit(forms["J_met"], stiffness, 0) - (J + J_load),
                ],
            ),
            step("so below k_string = m Omega^2 the rotor feels the weight's pull and not its mass."),
        ),
        forms,
    )


def _states(count: int) -> Iterator[dict[sp.Symbol, mp.mpf]]:
    """Random benches; the same on every run."""
    at = random.Random("bench")
    spans = ((1e-6, 1e-4), (1e-5, 1e-2), (-0.5, 0.5), (0.01, 0.2), (0.02, 0.03), (0.1, 0.4), (100, 220), (-1, 1))
    for _ in range(count):
        drawn = [mp.mpf(at.uniform(*span)) for span in spans]
        free = [mp.mpf("9.80665"), mp.mpf(at.uniform(1e3, 1e5)), mp.mpf(10 ** at.uniform(3, 9))]
        yield dict(zip(_SYMBOLS, [*drawn, *free], strict=True))


def _off(forms: Forms, name: str, wanted: list[mp.mpf]) -> mp.mpf:
    form = sp.lambdify(_SYMBOLS, forms[name], "mpmath")
    found = [form(*state.values()) for state in _states(len(wanted))]
    return largest(abs(a / b - 1) for a, b in zip(found, wanted, strict=True))


def _bodies(s: dict[sp.Symbol, mp.mpf]) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Acceleration, the string's pull and the weight's mass from the equations of both bodies."""
    mass, friction = abs(s[T_load]) / s[g] / s[r_s], s[r_c] * s[mu] * s[F_c] * s[f]
    turn, pull = mp.lu_solve(
        mp.matrix([[s[J] + s[J_load], s[r_s]], [mass * s[r_s], -1]]), mp.matrix([friction, -mass * s[g]])
    )
    return turn, pull, mass


def _judge(forms: Forms) -> Iterator[Evidence]:
    count = 20
    solved = [(s, *_bodies(s)) for s in _states(count)]
    one = _off(forms, "J_total", [(s[r_c] * s[mu] * s[F_c] * s[f] - abs(s[T_load])) / turn for s, turn, _, _ in solved])
    yield evidence(
        "numeric",
        one < 1e-25,
        f"torque over acceleration of two bodies and a string, solved at {count} random benches, is J_total within "
        f"{mp.nstr(one, 1)}",
    )
    share = _off(forms, "tension", [pull / (mass * s[g]) for s, _, pull, mass in solved])
    form = sp.lambdify(_SYMBOLS, forms["tension"], "mpmath")
    falls = all((form(*s.values()) < 0) == (s[r_s] * turn < -s[g]) for s, turn, _, _ in solved)
    yield evidence(
        "domain",
        share < 1e-25 and falls,
        f"the pull over the weight is that of the two bodies within {mp.nstr(share, 1)}, negative exactly where the "
        "string's end would have to fall faster than the weight can",
    )
    met = _off(forms, "J_met", [_swung(s) for s in _states(count)])
    yield evidence(
        "identity",
        met < 1e-25,
        f"the swing of two bodies with a spring between them, solved at {count} random frequencies and stiffnesses, "
        f"is that of J_met within {mp.nstr(met, 1)}",
    )
    ends = [forms["J_met"].subs(stiffness, at) for at in (mp.mpf("1e60"), mp.mpf("1e-60"))]
    wanted = (forms["J_total"], forms["J_total"].subs(r_s, 0))
    gaps = [
        abs(sp.lambdify(_SYMBOLS, end, "mpmath")(*s.values()) / sp.lambdify(_SYMBOLS, to, "mpmath")(*s.values()) - 1)
        for end, to in zip(ends, wanted, strict=True)
        for s in _states(3)
    ]
    yield evidence(
        "limit",
        max(gaps) < 1e-25,
        "a stiff string makes J_met J_total, a soft one the inertia without the weight, J_total at r_s = 0",
    )


def _swung(s: dict[sp.Symbol, mp.mpf]) -> mp.mpf:
    """Torque over angular acceleration, of unit torque at the frequency, from the equations of both bodies."""
    mass, k, square = abs(s[T_load]) / s[g] / s[r_s], s[stiffness], s[Omega] ** 2
    angle, _ = mp.lu_solve(
        mp.matrix([[k * s[r_s] ** 2 - square * (s[J] + s[J_load]), -k * s[r_s]], [-k * s[r_s], k - square * mass]]),
        mp.matrix([1, 0]),
    )
    return -1 / (square * angle)


def _effect() -> str:
    p = values()
    known = {
        **{symbol: p[symbol.name] for symbol in (J, r_c, mu, F_c)},
        **{J_load: 0.0, T_load: _LOAD, r_s: _RADIUS, g: CONSTANTS[g], Omega: 2 * math.pi / p["T"]},
    }
    added = float(bench.inertia().subs(known)) - p["J"]
    mass = float(bench.mass().subs(known))
    slack = float(sp.solve(bench.tension().subs(known), f)[0])
    plate = float(sp.solve(bench.tension().subs({**known, f: -1, J_load: sp.Symbol("x")}), sp.Symbol("x"))[0])
    needed = mass * known[Omega] ** 2
    wire = _WIRE[0] * math.pi * _WIRE[1] ** 2 / 4 / _WIRE[2]
    met = float(bench.stretched().subs({**known, stiffness: wire})) / p["J"]
    return (
        f"At Table 3 with a string at {1e3 * _RADIUS:g} mm the weight is {figure(mass, 3)} kg and would add "
        f"{figure(added, 3)} kg m^2, {figure(added / p['J'], 3)} times J. With no plate the string is slack wherever "
        f"the friction fraction is below {figure(slack, 2)}, as soon as friction turns back; from a plate of "
        f"{figure(plate, 3)} kg m^2 on it is never. Within a cycle, {figure(1 / p['T'], 4)} Hz, the weight moves with "
        f"the rotor only on a string stiffer than {figure(needed, 2)} N/m; a steel wire half a millimetre thick, 0.3 m "
        f"long, has {figure(wire, 2)} N/m, and with it the rotor meets {figure(met, 3)} times J: the weight pulls, and "
        "what adds inertia is the plate."
    )


ENTRIES = (
    Entry(
        id="load-inertia",
        section="8.1",
        title="What turns with the rotor: plate, weight and string",
        place="left out by eq. 38; Sect. 8.1 loads the rotor with a weight on a string over a torque plate",
        printed={},
        units={"J_total": "kg*m^2", "tension": "1", "J_met": "kg*m^2"},
        known=_KNOWN,
        verdict="reconstructed",
        reason="A weight on a taut string that does not give adds m r_s^2 = |T_load| r_s/g to J, a plate its own "
        "inertia; the string is slack where the rotor goes down faster than the weight can fall, and a string "
        "softer than m Omega^2 keeps the weight's mass from the rotor.",
        judge=_judge,
        derive=_derive,
        effect=_effect,
    ),
)
