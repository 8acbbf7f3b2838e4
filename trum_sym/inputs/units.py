"""Units: SI inside, other units only at the edges.

One small table instead of a units library: importing pint alone takes longer than a whole
``trum-sym evaluate``, and the project needs some twenty units.  The same parser serves motor files,
the console, and the dimension checks of the derivations.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import NamedTuple

from trum_sym.errors import ParameterError, shorten

__all__ = ["ARCSEC", "Dimension", "Unit", "parse_quantity", "parse_unit"]

ARCSEC = math.pi / 648000
"""One second of arc in rad."""


class Dimension(NamedTuple):
    """Exponents of the SI base units metre, kilogram, second and ampere."""

    m: Fraction = Fraction(0)
    kg: Fraction = Fraction(0)
    s: Fraction = Fraction(0)
    A: Fraction = Fraction(0)

    def times(self, other: Dimension) -> Dimension:
        """The dimension of a product."""
        return Dimension(*(a + b for a, b in zip(self, other, strict=True)))

    def power(self, exponent: Fraction | int) -> Dimension:
        """The dimension of a power."""
        return Dimension(*(a * exponent for a in self))

    def __str__(self) -> str:
        named = zip(self._fields, self, strict=True)
        return " ".join(f"{n}^{e}" if e != 1 else n for n, e in named if e) or "1"


class Unit(NamedTuple):
    """A unit: its dimension and the factor that turns a value in it into SI."""

    dimension: Dimension
    factor: Fraction | float

    def to_si(self, value: float) -> float:
        """Convert a value to SI; decimal factors are exact, so 1.2 mm is 0.0012 m to the last bit."""
        if isinstance(self.factor, Fraction):
            return value * self.factor.numerator / self.factor.denominator
        return value * self.factor


def _dim(m: int = 0, kg: int = 0, s: int = 0, A: int = 0) -> Dimension:
    return Dimension(Fraction(m), Fraction(kg), Fraction(s), Fraction(A))


_BASE: dict[str, Unit] = {
    "1": Unit(_dim(), Fraction(1)),
    "%": Unit(_dim(), Fraction(1, 100)),
    "m": Unit(_dim(m=1), Fraction(1)),
    "g": Unit(_dim(kg=1), Fraction(1, 1000)),
    "s": Unit(_dim(s=1), Fraction(1)),
    "A": Unit(_dim(A=1), Fraction(1)),
    "Hz": Unit(_dim(s=-1), Fraction(1)),
    "N": Unit(_dim(m=1, kg=1, s=-2), Fraction(1)),
    "Pa": Unit(_dim(m=-1, kg=1, s=-2), Fraction(1)),
    "V": Unit(_dim(m=2, kg=1, s=-3, A=-1), Fraction(1)),
    "C": Unit(_dim(s=1, A=1), Fraction(1)),
    "rad": Unit(_dim(), Fraction(1)),
    "deg": Unit(_dim(), math.pi / 180),
    "arcsec": Unit(_dim(), ARCSEC),
    "rpm": Unit(_dim(s=-1), math.pi / 30),
}
_PREFIX = {"G": 9, "M": 6, "k": 3, "": 0, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9, "p": -12}
_PREFIXED = ("m", "g", "s", "A", "Hz", "N", "Pa", "V", "C", "rad")


def _symbols() -> dict[str, Unit]:
    table = dict(_BASE)
    for name in _PREFIXED:
        unit = _BASE[name]
        for prefix, power in _PREFIX.items():
            table.setdefault(prefix + name, Unit(unit.dimension, unit.factor * Fraction(10) ** power))
    return table


_SYMBOLS = _symbols()
_TERM = re.compile(r"([^\^\d]+)(?:\^?([+-]?\d\d?))?$|(1)$", re.ASCII)


def parse_unit(text: str) -> Unit:
    """Parse a unit such as ``mm``, ``kg/m^3``, ``N*m``, ``m^2/N`` or ``arcsec/s``.

    Factors are joined by ``*``, ``·`` or a space; everything after a ``/`` divides.

    Raises
    ------
    ValueError
        If a part of the text is not a known unit, or the unit is beyond any use.
    """
    dimension, factor = Dimension(), Fraction(1)
    scale: float = 1.0
    for position, part in enumerate(text.strip().split("/")):
        terms = re.split(r"[*·\s]+", part.strip())
        for term in terms:
            match = _TERM.match(term)
            unit = _SYMBOLS.get(match[1] or match[3]) if match else None
            if match is None or unit is None:
                raise ValueError(f"unknown unit {shorten(repr(term))}")
            exponent = int(match[2] or 1) * (-1 if position else 1)
            dimension = dimension.times(unit.dimension.power(exponent))
            if isinstance(unit.factor, Fraction):
                factor *= unit.factor**exponent
            else:
                scale *= unit.factor**exponent
    if not 1e-60 < factor * Fraction(scale) < 1e60:
        raise ValueError("a unit too large or too small")
    return Unit(dimension, factor if scale == 1.0 else float(factor) * scale)


_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|[+-]?inf|nan)(.*)", re.I | re.S | re.ASCII)


def parse_quantity(name: str, text: str, unit: str) -> float:
    """Read a number with an optional unit, ``"3000"`` or ``"3 kHz"``, and return it in ``unit``.

    A bare number is taken to be in ``unit`` (an SI unit).

    Raises
    ------
    ParameterError
        If the text is no number, or its unit is unknown or of another dimension than ``unit``.
    """
    wanted = "a number" if unit == "1" else f"a number in {unit}"
    match = _NUMBER.fullmatch(text.strip())
    if match is None:
        raise ParameterError(name, text, wanted)
    value, given_unit = float(match[1]), match[2].strip()
    if not given_unit:
        return value
    try:
        given = parse_unit(given_unit)
    except ValueError as error:
        raise ParameterError(name, text, f"{wanted} ({error})") from None
    if given.dimension != parse_unit(unit).dimension:
        raise ParameterError(name, text, wanted if unit == "1" else f"{wanted}, or in a unit that converts to it")
    return given.to_si(value)
