"""The rule of orbits on a grid of equal steps, and what it leaves, with proofs that raise.

A lap's friction is known at equally spaced nodes.  Its integral is that of the cubic through the four nodes about each
cell; where the time is the solution's own, this is the rule of Adams and Moulton of order 3 (:func:`implicit_weights`),
but for the cells beside a region's ends.  Friction is not smooth, and nothing is done at its events.  What they leave
is bounded by differences of the values themselves: :func:`single` shows that a jump, a square root, a kink, or a jump
of the curvature leaves no more than a constant times the sum of the magnitudes of all fourth differences, wherever
between the nodes it lies, and that a polynomial of degree 4 does.

Events closer to each other than four nodes may have fourth differences that partly cancel.  The driver takes twice the
constants; what this leaves is measured (docs/rotor.md).
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import mpmath as mp
import sympy as sp

__all__ = [
    "EVENTS",
    "SAFETY",
    "bounds",
    "implicit_weights",
    "passing",
    "prove",
    "second_weights",
    "single",
    "slope_weight",
]

SAFETY = 2
"""Times what a single event leaves: what the driver counts."""
EVENTS = {"jump": 0, "root": sp.Rational(1, 2), "kink": 1, "curvature": 2}
"""Powers of the time after an event that friction rises by."""
_PLACES = 64  # of an event in its cell, where its rest is looked at
_FAR = 400  # nodes beyond the event, whose differences are summed
s = sp.Symbol("s", real=True)


class ProofError(ArithmeticError):
    """A step of a proof does not hold."""


def _cell(nodes: list[int]) -> list[sp.Expr]:
    """Weights of values at nodes in the integral of their polynomial from 0 to 1."""
    weights = []
    for node in nodes:
        others = [other for other in nodes if other != node]
        basis = sp.prod((s - other) / sp.Integer(node - other) for other in others)
        weights.append(sp.integrate(sp.expand(basis), (s, 0, 1)))
    return weights


def implicit_weights() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Weights over a step of the values at its end, its start and the node before: Adams and Moulton, order 3."""
    before, old, new = _cell([-1, 0, 1])
    return new, old, before


def second_weights() -> tuple[sp.Expr, sp.Expr]:
    """What the rule takes off the trapezoidal one, of each second difference; of the first and last of a region.

    The cubic's cell is the trapezium less 1/24 of the second differences at both ends, so that one that has a cell on
    either side counts twice.  At the region's ends the difference beyond is taken to be that beside it.

    Raises
    ------
    ProofError
        If the implicit rule does not take off the same inside the region.
    """
    cell = _cell([-1, 0, 1, 2])
    half = (sp.Rational(1, 2) - cell[1] - cell[0], sp.Rational(1, 2) - cell[2] - cell[3])
    if cell[0] != cell[3] or any(half):
        raise ProofError("the cubic's cell is not the trapezium less second differences")
    inner, edge = -2 * cell[0], -3 * cell[0]
    new, old, before = implicit_weights()
    if (new + inner, old - 2 * inner, before + inner) != (sp.Rational(1, 2), sp.Rational(1, 2), 0):
        raise ProofError("the implicit rule takes off another share of the second difference")
    return inner, edge


def slope_weight() -> sp.Expr:
    """Weight of the difference of a cell's slopes in the integral of the cubic through its ends (Hermite)."""
    a, b, c, d = sp.symbols("a b c d")
    cubic = a + b * s + c * s**2 + d * s**3
    left = sp.integrate(cubic, (s, 0, 1)) - (cubic.subs(s, 0) + cubic.subs(s, 1)) / 2
    slopes = cubic.diff(s).subs(s, 0) - cubic.diff(s).subs(s, 1)
    return sp.cancel(left / slopes)


def _left(power: sp.Rational, place: mp.mpf) -> mp.mpf:
    """The rule's error for t^power after an event, a share ``place`` of a cell before the next node.

    By Euler and Maclaurin's sum of a function with an end singularity: Hurwitz's zeta function; the rule's second
    differences add up to the sum's terms at the far end alone.
    """
    return mp.zeta(-mp.mpf(sp.Float(power, 30)), place)


def _fourths(power: sp.Rational, place: mp.mpf) -> mp.mpf:
    """The sum of the magnitudes of the fourth differences of that function over all nodes."""
    count = 8 if power in (0, 1, 2) else _FAR
    values = [mp.mpf(0)] * 4 + [(place + k) ** mp.mpf(sp.Float(power, 30)) for k in range(count)]
    for _ in range(4):
        values = [b - a for a, b in pairwise(values)]
    return mp.fsum(abs(value) for value in values)


def single(event: str) -> Fraction:
    """The constant that bounds what one event leaves, in fourth differences and steps; found to be enough.

    Raises
    ------
    ProofError
        If it is not, at one of the places looked at.
    """
    constant = {"jump": Fraction(1, 16), "root": Fraction(1, 22), "kink": Fraction(1, 48), "curvature": Fraction(1, 48)}
    power = sp.Rational(EVENTS[event])
    with mp.workdps(25):
        for k in range(1, _PLACES + 1):
            place = mp.mpf(k) / _PLACES
            left = abs(_left(power, place))
            counted = _fourths(power, place) * constant[event].numerator / constant[event].denominator
            if left > counted + mp.mpf("1e-20"):
                raise ProofError(f"{event} at {float(place):.3f} of a cell leaves more than {constant[event]}")
    return constant[event]


def end() -> Fraction:
    """The constant that bounds what an event in a region's first cell leaves, in both second differences beside it.

    There the second difference before the first node is taken to be the next one.  A region's last cell is its mirror.

    Raises
    ------
    ProofError
        If the constant is not enough, for one of the events at one of the places looked at.
    """
    constant, (inner, edge) = Fraction(3, 4), (mp.mpf(float(w)) for w in second_weights())
    with mp.workdps(25):
        for event, power in EVENTS.items():
            for k in range(1, _PLACES + 1):
                place, exponent = mp.mpf(k) / _PLACES, mp.mpf(sp.Float(power, 30))
                first, second, third = ((place + j) ** exponent for j in range(3))
                beside = second - 2 * first, third - 2 * second + first
                left = _left(sp.Rational(power), place) + inner * first - (edge - inner) * beside[0]
                if abs(left) > mp.mpf(3) / 4 * (abs(beside[0]) + abs(beside[1])) + mp.mpf("1e-12"):
                    raise ProofError(f"{event} at {float(place):.3f} of the first cell leaves more than {constant}")
    return constant


def passing() -> int:
    """Of a peak between two nodes as a nearly standing wave passes zero: its area over a step's y^(3/4), at most: 3.

    Over a step the wave's two displacements move along a straight line, by the way |P_2 - P_1|. Seen from zero their
    heights are W_1 and W_2 and the turn psi, so that the triangle's area says how near to zero the line comes: over
    the way, which a step takes, y = W_1 W_2 sin(psi) / (W_1^2 + W_2^2 - 2 W_1 W_2 cos(psi)). Friction follows the
    phase's cosine, a peak 1/sqrt(1 + (t/y)^2) in steps, whose integral over a step is at most 2 y asinh(1/(2 y)), as
    the inverse hyperbolic sine is concave. Over y^(3/4), with u = asinh(1/(2 y)), that is 2 u (2 sinh u)^(-1/4),
    largest where tanh u = u/4.

    Raises
    ------
    ProofError
        If the line's distance, or the largest value, is another.
    """
    one, other, psi, u = sp.symbols("W_1 W_2 psi u", positive=True)
    first, last = sp.Matrix([one, 0]), sp.Matrix([other * sp.cos(psi), other * sp.sin(psi)])
    way = last - first
    distance = sp.Abs(first[0] * last[1] - first[1] * last[0]) / sp.sqrt(way.dot(way))
    stated = one * other * sp.sin(psi) / (one**2 + other**2 - 2 * one * other * sp.cos(psi))
    if sp.simplify((distance / sp.sqrt(way.dot(way))) ** 2 - stated**2) != 0:
        raise ProofError("the distance of a line from zero")
    size = 2 * u * (2 * sp.sinh(u)) ** sp.Rational(-1, 4)
    if sp.simplify((size.diff(u) / size - (1 / u - sp.coth(u) / 4)).rewrite(sp.exp)) != 0:
        raise ProofError("the slope of a peak's area")  # falls through 0 once, as u coth u rises
    return int(sp.ceiling(size.subs(u, sp.nsolve(sp.tanh(u) - u / 4, u, 4))))


def smooth() -> sp.Expr:
    """What a polynomial of degree 4 leaves in a cell, of its fourth difference."""
    weights, nodes = _cell([-1, 0, 1, 2]), [-1, 0, 1, 2]
    rule = sum(weight * node**4 for weight, node in zip(weights, nodes, strict=True))
    return sp.Abs(rule - sp.Rational(1, 5)) / sp.factorial(4)


def bounds() -> dict[str, sp.Rational]:
    """The driver's constants: where friction is smooth or has kinks, next to square roots, at a region's ends; and of
    the held rotor, whose friction nearly jumps there and back where the wave nearly stands, twice as safe.
    """
    needed = {event: single(event) for event in EVENTS}
    plain = max(needed["kink"], needed["curvature"])
    if smooth() > sp.Rational(plain.numerator, plain.denominator):
        raise ProofError("a polynomial of degree 4 leaves more than a kink")
    found = {"PLAIN": plain, "EVENT": needed["root"], "END": end(), "HELD": 2 * needed["jump"]}
    return {name: SAFETY * sp.Rational(value.numerator, value.denominator) for name, value in found.items()}


def prove() -> None:
    """Raise a ProofError if something here does not hold."""
    if sum(implicit_weights()) != 1:
        raise ProofError("the weights do not add up to the step")
    second_weights(), slope_weight(), bounds(), passing()
