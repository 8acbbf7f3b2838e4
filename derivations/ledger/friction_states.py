"""Random states of one contact, and friction summed over it by brute force: witnesses for Section 4.2."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import mpmath as mp
import numpy as np
import sympy as sp

__all__ = ["State", "brute_fraction", "half_zone_signs", "integrals_done", "states"]

K = 300.0  # wavenumber of the states, 1/m


@dataclass(frozen=True)
class State:
    """v_x(u) = cos(u - phi) against the rotor's c, on |u| < theta, with the crest at u + k_c x_max."""

    phi: float
    c: float
    theta: float
    crest: float

    def faster(self, u: float) -> float:
        """v_x - v, over the largest surface speed."""
        return float(np.cos(u - self.phi) - self.c)

    def crossings(self) -> list[float]:
        """Where v_x passes the rotor's speed in 0 < u < theta, by scanning and bisection."""
        grid = np.linspace(0.0, self.theta, 721)
        values = np.cos(grid - self.phi) - self.c
        found = []
        for i in np.nonzero(np.sign(values[:-1]) != np.sign(values[1:]))[0]:
            low, high = float(grid[i]), float(grid[i + 1])
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if (self.faster(middle) > 0) == (self.faster(low) > 0) else (low, middle)
            found.append((low + high) / 2)
        return found

    def extremum_inside(self) -> bool:
        """Whether v_x turns between the crest and the contact's end: its slope changes sign there."""
        return bool((np.sin(-self.phi) > 0) != (np.sin(self.theta - self.phi) > 0))


def states(count: int, seed: str, widest: float = 3.1) -> Iterator[State]:
    """Random states; the same on every run."""
    draw = random.Random(seed)
    for _ in range(count):
        phi, c = draw.uniform(-np.pi, np.pi), draw.uniform(-1, 1)
        yield State(phi, c, draw.uniform(0.1, widest), draw.uniform(-np.pi / 2, 3 * np.pi / 2))


def half_zone_signs(state: State) -> tuple[bool, int, int, bool]:
    """Forward, sign at the crest, sign at the end, extremum inside: what tells the transfer cases apart."""
    ends = [1 if state.faster(u) > 0 else -1 for u in (0.0, state.theta)]
    return state.c > 0, ends[0], ends[1], state.extremum_inside()


def brute_fraction(state: State, whole: bool, steps: int = 40001) -> float:
    """Sum of sign(v_x - v) p over sum of p at equal steps, over the whole zone or its right half."""
    width = 2 * state.theta if whole else state.theta
    u = (np.arange(steps) + 0.5) / steps * width - (state.theta if whole else 0.0)
    press = np.cos(u) - np.cos(state.theta)
    return float((np.sign(np.cos(u - state.phi) - state.c) * press).sum() / press.sum())


def integrals_done(form: sp.Expr, values: Mapping[sp.Basic, object]) -> mp.mpf:
    """The number of a form with integrals whose integrands jump where the argument of a sign changes sign."""
    done: dict[sp.Basic, sp.Basic] = {}
    for integral in sorted(form.atoms(sp.Integral), key=str):
        integrand, (variable, low, high) = integral.function.subs(values), integral.limits[0]
        a, b = (mp.mpf(str(sp.N(limit.subs(values), 20))) for limit in (low, high))
        jumps = [sp.lambdify(variable, s.args[0], "mpmath") for s in sorted(integrand.atoms(sp.sign), key=str)]
        cuts = sorted({a, b, *(root for jump in jumps for root in _roots(jump, a, b))})
        function = sp.lambdify(variable, integrand, "mpmath")
        total = mp.fsum(mp.quad(function, piece) for piece in pairwise(cuts))
        done[integral] = sp.Float(str(total if a <= b else -total), 20)
    return mp.mpf(str(sp.N(form.xreplace(done).subs(values), 20)))


def _roots(function: Callable[[mp.mpf], mp.mpf], a: mp.mpf, b: mp.mpf) -> Iterator[mp.mpf]:
    low, high = min(a, b), max(a, b)
    grid = [low + (high - low) * i / 200 for i in range(201)]
    for left, right in pairwise(grid):
        if (function(left) > 0) != (function(right) > 0):
            x, y = left, right
            for _ in range(70):
                middle = (x + y) / 2
                x, y = (middle, y) if (function(middle) > 0) == (function(x) > 0) else (x, middle)
            yield (x + y) / 2
