"""The rule that the rotor's time steps use: collocation at Lobatto's nodes (Lobatto IIIA), from its definition."""

from __future__ import annotations

from functools import cache

import sympy as sp

__all__ = [
    "check_full_weights",
    "check_integrals",
    "check_nodes",
    "check_values",
    "check_weights",
    "integrals",
    "legendre",
    "nodes",
    "outward",
    "powers",
]

COUNT = 4


@cache
def nodes() -> tuple[sp.Expr, ...]:
    """Lobatto's nodes on [0, 1]: both ends, and where the derivative of a Legendre polynomial vanishes."""
    x = sp.Symbol("x")
    inner = sp.solve(sp.legendre(COUNT - 1, x).diff(x), x)
    return tuple(sorted((sp.nsimplify((1 + root) / 2) for root in [-1, *inner, 1]), key=float))


@cache
def powers() -> sp.ImmutableMatrix:
    """Rows k: weights of the values at the nodes in the coefficient of s^k of their polynomial."""
    return sp.ImmutableMatrix(COUNT, COUNT, lambda i, k: nodes()[i] ** k).inv().applyfunc(sp.radsimp)


def integrals() -> sp.Matrix:
    """Rows i: weights of the values at the nodes in the integral of their polynomial from 0 to node i."""
    upto = sp.Matrix(COUNT, COUNT, lambda i, k: nodes()[i] ** (k + 1) / (k + 1))
    return (upto * powers()).applyfunc(lambda weight: sp.radsimp(sp.expand(weight)))


def legendre() -> sp.Matrix:
    """Rows k: weights of the values at the nodes in the coefficient of the shifted Legendre polynomial of degree k."""
    s = sp.Symbol("s")
    rows = []
    for k in range(COUNT):
        shifted = sp.expand(sp.legendre(k, 2 * s - 1) * (2 * k + 1))
        moments = [sp.integrate(shifted * s**j, (s, 0, 1)) for j in range(COUNT)]
        rows.append([sp.radsimp(sum(m * powers()[j, i] for j, m in enumerate(moments))) for i in range(COUNT)])
    return sp.Matrix(rows)


def outward() -> list[sp.Expr]:
    """Weights of the values at the other nodes in the value at the first, of the polynomial through those."""
    points = nodes()
    weights = [sp.prod((0 - z) / (point - z) for z in points[1:] if z != point) for point in points[1:]]
    return [sp.Integer(0), *(sp.radsimp(sp.expand(sp.radsimp(weight))) for weight in weights)]


@cache
def check_nodes() -> tuple[sp.Expr, ...]:
    """Kronrod's three nodes between Lobatto's four: with them a quadrature is exact to degree 9 instead of 5.

    They are the zeros of the cubic that is orthogonal, with the weight of Lobatto's node polynomial, to all polynomials
    of a lower degree; that one is odd about the middle.
    """
    x, place = sp.symbols("x place")
    weight = sp.expand(sp.prod(x - node for node in nodes()))
    shifted = x - sp.Rational(1, 2)
    cubic = sp.expand(shifted**3 - place * shifted)
    condition = sp.integrate(sp.expand(weight * cubic * shifted), (x, 0, 1))
    square = sp.solve(sp.radsimp(sp.expand(condition)), place)[0]
    root = sp.sqrt(sp.nsimplify(sp.radsimp(square)))
    return sp.Rational(1, 2) - root, sp.Rational(1, 2), sp.Rational(1, 2) + root


def check_weights() -> list[sp.Expr]:
    """Weights of the check nodes in the integral of a function that vanishes at Lobatto's nodes."""
    x = sp.Symbol("x")
    weight = sp.expand(sp.prod(x - node for node in nodes()))
    points = check_nodes()
    moments = sp.Matrix([sp.integrate(sp.expand(weight * x**k), (x, 0, 1)) for k in range(3)])
    rows = sp.Matrix(3, 3, lambda k, i: sp.expand(weight.subs(x, points[i])) * points[i] ** k)
    return [sp.radsimp(sp.expand(sp.radsimp(value))) for value in rows.LUsolve(moments)]


def check_values() -> sp.Matrix:
    """Rows i: weights of the values at the nodes in their polynomial's value at check node i."""
    at = sp.Matrix(3, COUNT, lambda i, k: check_nodes()[i] ** k)
    return (at * powers()).applyfunc(lambda weight: sp.radsimp(sp.expand(weight)))


def check_integrals() -> sp.Matrix:
    """Rows i: weights of the values at the nodes in the integral of their polynomial from 0 to check node i."""
    upto = sp.Matrix(3, COUNT, lambda i, k: check_nodes()[i] ** (k + 1) / (k + 1))
    return (upto * powers()).applyfunc(lambda weight: sp.radsimp(sp.expand(weight)))


def check_full_weights() -> list[sp.Expr]:
    """Weights of Lobatto's nodes in Kronrod's quadrature over all seven; the check nodes' are check_weights."""
    values, extra = check_values(), check_weights()
    own = integrals().row(COUNT - 1)
    return [sp.radsimp(sp.expand(own[j] - sum(extra[i] * values[i, j] for i in range(3)))) for j in range(COUNT)]
