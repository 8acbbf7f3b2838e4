"""Helpers that turn forms into evidence: identity, 30-digit numbers, size of an error.

Forms are judged against something independent: a printed form against the derivation, a derived form
against the premises (the equation of motion it solves, an integral taken numerically, a limit).
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Mapping
from functools import cache, lru_cache, reduce
from typing import Any

import mpmath as mp
import sympy as sp

from derivations.ledger.algebra import difference, vanishes
from derivations.ledger.figures import figure
from derivations.ledger.model import APPROXIMATION_LIMIT, WORKING_DIGITS, Evidence, Forms, Kind
from trum_sym.inputs.motor import Motor

__all__ = [
    "DIGITS",
    "agrees",
    "compiled",
    "difference",
    "error_size",
    "evaluate",
    "figure",
    "identical",
    "largest",
    "points",
    "rounded",
    "usual",
    "vanishes",
    "worse",
]

DIGITS = 30
_ROUNDING = 1e-12  # of numbers of the size of one, in double precision
Point = dict[sp.Symbol, mp.mpf]
Range = tuple[float, float]

# Ranges of what is not a motor parameter, around TRUM-60 at Table 3.
_RANGES: dict[str, Range] = {
    "t": (1e-5, 4e-4),
    "x": (-0.01, 0.01),
    "tau": (1e-6, 2e-4),
    "E": (6e10, 9e10),
    "rho": (7e3, 9e3),
    "I_z": (6e-11, 1e-10),
    "G": (3e10, 5e10),
    "A": (3e-5, 5e-5),
    "E_eq": (2e10, 4e10),
    "D": (2.4e-3, 3.2e-3),
    "k_c": (250.0, 350.0),
    "k_f": (1e8, 5e8),
    "k_dx": (1e8, 5e8),
    "k_N": (2e10, 4e10),
    "theta": (0.2, 0.6),
    "F_c": (100.0, 220.0),
    "N_1": (1.0, 1.0),
    "W": (3e-6, 9e-6),
    "omega_n": (2.3e5, 2.6e5),
    "Delta_omega": (1.6e4, 2.2e4),
    "omega_q": (2.4e5, 2.8e5),
    "beta": (200.0, 320.0),
    "psi": (-3.0, 3.0),
    "a": (-5e-6, 5e-6),
    "b": (-1.0, 1.0),
    "a_A": (-5e-6, 5e-6),
    "b_A": (-1.0, 1.0),
    "a_B": (-5e-6, 5e-6),
    "b_B": (-1.0, 1.0),
    "T": (4e-4, 6e-4),
}


def worse(worst: Any, error: Any) -> Any:  # noqa: ANN401
    """The larger of two errors; what is not a number stays, where ``max`` would drop it."""
    return worst if worst != worst or error <= worst else error


def largest(errors: Iterable[Any]) -> Any:  # noqa: ANN401
    """The largest of errors, not a number if one of them is not."""
    return reduce(worse, errors)


@cache
def usual() -> dict[str, float]:
    """TRUM-60's parameters in SI, by symbol."""
    from trum_sym.inputs.motor_file import load_motor

    motor: Motor = load_motor("trum60")
    return {name: float(value) for name, value in motor.symbols().items()}


def _range(symbol: sp.Symbol, ranges: Mapping[str, Range]) -> Range:
    if symbol.name in ranges:
        return ranges[symbol.name]
    if symbol.name in usual():
        value = usual()[symbol.name]
        low, high = sorted((0.8 * value, 1.2 * value))
        return low, high
    if symbol.name in _RANGES:
        return _RANGES[symbol.name]
    raise LookupError(f"give a range for {symbol.name}")


def points(
    symbols: Iterable[sp.Symbol], count: int = 5, seed: str = "ledger", ranges: Mapping[str, Range] | None = None
) -> list[Point]:
    """Random points of the physical domain: motor parameters 20 % to either side, the rest by range."""
    ordered = sorted(symbols, key=lambda s: s.name)
    found = []
    for index in range(count):
        point = {}
        for symbol in ordered:
            low, high = _range(symbol, ranges or {})
            point[symbol] = mp.mpf(random.Random(f"{seed} {index} {symbol.name}").uniform(low, high))
        found.append(point)
    return found


@cache
def compiled(symbols: tuple[sp.Symbol, ...], expr: sp.Basic) -> Callable[..., object]:
    """An expression as a function of mpmath numbers."""
    function: Callable[..., object] = sp.lambdify(symbols, expr, modules=[{"expm1": mp.expm1}, "mpmath"])
    return function


def evaluate(expr: sp.Basic, point: Mapping[sp.Symbol, object]) -> mp.mpf | mp.mpc:
    """The number that an expression has at a point, at 30 digits and some to spare."""
    symbols = tuple(sorted(point, key=lambda s: s.name))
    function = compiled(symbols, sp.sympify(expr))
    with mp.workdps(max(WORKING_DIGITS, mp.mp.dps)):  # numerical derivatives ask for more
        return mp.mpmathify(function(*(mp.mpmathify(point[s]) for s in symbols)))


def rounded(difference: float) -> str:
    """A difference to two digits; of one that is rounding only that it is, since its digits are the processor's."""
    return f"{difference:.1e}" if difference >= _ROUNDING else f"below {_ROUNDING:.0e}"


def identical(forms: Forms, derived: Forms, kind: Kind = "identity") -> Evidence:
    """Form by form, printed less derived is identically 0."""
    for name, form in forms.items():
        if not vanishes(difference(form, derived[name])):
            return Evidence(kind, False, f"{name} is not the derived one")
    return Evidence(kind, True, f"identical with the derivation: {', '.join(forms)}")


@lru_cache(maxsize=10_000)
def _wanted(
    reference: Callable[[str, Point], object], name: str, values: tuple[tuple[sp.Symbol, mp.mpf], ...]
) -> mp.mpf | mp.mpc:
    """What a reference gives at a point, computed once for all mutants that it is held against."""
    return mp.mpmathify(reference(name, dict(values)))


def agrees(
    forms: Forms,
    reference: Forms | Callable[[str, Point], object],
    *,
    given: Mapping[sp.Basic, sp.Basic] | None = None,
    ranges: Mapping[str, Range] | None = None,
    symbols: Iterable[sp.Symbol] = (),
    count: int = 5,
    tolerance: float = 1e-25,
    kind: Kind = "numeric",
    against: str = "the derivation",
) -> Evidence:
    """Form by form, the same number as the reference at random points of the physical domain.

    Parameters
    ----------
    forms : mapping
        Expressions without undefined functions once ``given`` is put in.
    reference : mapping or callable
        Other expressions under the same names, or (name, point) -> number.
    given : mapping, optional
        Substitutions made first in both, derivatives and integrals done afterwards.
    ranges, symbols : optional
        Ranges that differ from the usual ones; symbols that only the callable needs.
    count, tolerance, kind, against : optional
        Number of points, relative error allowed, kind of the evidence, what the reference is called.
    """

    def put_in(expr: sp.Basic) -> sp.Basic:
        expr = expr.lhs - expr.rhs if isinstance(expr, sp.Equality) else expr
        return expr.subs(given).doit() if given else expr

    worst = mp.mpf(0)
    for name, form in forms.items():
        expr = put_in(form)
        other = None if callable(reference) else put_in(reference[name])
        free = set(expr.free_symbols) | (set(other.free_symbols) if other is not None else set()) | set(symbols)
        for index, point in enumerate(points(free, count, seed=name, ranges=ranges)):
            found = evaluate(expr, point)
            with mp.workdps(WORKING_DIGITS):
                wanted = evaluate(other, point) if other is not None else _wanted(reference, name, (*point.items(),))
                scale = max(abs(wanted), abs(found))
                error = abs(found - wanted) / scale if scale else mp.mpf(0)
            if not error <= tolerance:  # also when it is not a number
                text = f"{name} is {mp.nstr(found, 8)}, by {against} {mp.nstr(wanted, 8)}, at random point {index + 1}"
                return Evidence(kind, False, text)
            worst = worse(worst, error)
    digits = "all digits" if worst == 0 else f"{mp.nstr(worst, 2)} relative at most"
    return Evidence(kind, True, f"equals {against} at {count} random points, {digits}: {', '.join(forms)}")


def error_size(
    name: str, relative: Callable[[], tuple[float, float]], limit: str, closer: Callable[[], float]
) -> Evidence:
    """The relative error of an approximation, by the one rule for all of them.

    Parameters
    ----------
    name : str
        What is off: the figure that the paper computes from the form.
    relative : callable
        Its error at the operating point, and at most over the domain (for information).
    limit, closer
        In which limit the error vanishes, and what is left of it a hundred times closer to that limit.
    """
    there, most = relative()
    left = closer()
    # math.isfinite: what is not a number anywhere in the domain speaks against the form
    ok = abs(there) <= APPROXIMATION_LIMIT and abs(left) <= abs(there) / 10 and math.isfinite(most)
    detail = (
        f"{name} is off by {100 * there:+.3g} % at the operating point, {100 * most:.3g} % at most over the domain; it "
        f"vanishes for {limit}: {100 * left:+.2g} % a hundred times closer; allowed {100 * APPROXIMATION_LIMIT:g} % at "
        "the point"
    )
    return Evidence("error_size", ok, detail, float(there))
