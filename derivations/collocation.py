"""The rule that the rotor's time steps use: collocation at Lobatto's nodes (Lobatto IIIA), from its definition."""

from __future__ import annotations

from functools import cache

import sympy as sp

__all__ = ["integrals", "legendre", "nodes", "outward", "powers"]

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
