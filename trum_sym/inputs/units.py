"""Units: SI inside, other units only at the edges.

One small table instead of a units library: importing pint alone takes longer than a whole ``trum-sym evaluate``, it
takes rad/s for Hz without a word, and the project needs some thirty units.  The same parser serves motor files, the
console, data files, objects that carry units, and the dimension checks of the derivations.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

from trum_sym.errors import ParameterError, shorten

__all__ = ["ARCSEC", "Dimension", "Kind", "Unit", "parse_quantity", "parse_unit", "unit_for"]

ARCSEC = math.pi / 648000
"""One second of arc in rad."""

_LONGEST_UNIT = 100  # characters
_LONGEST_QUANTITY = 400
_DEEPEST = 5  # brackets
_MOST = 99  # exponent

T = TypeVar("T")


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


_PURE, _PER_TIME = Dimension(), Dimension(s=Fraction(-1))


class Kind(NamedTuple):
    """What a unit measures: its dimension, and how often an angle is a factor of it.

    SI takes the radian for 1, and rad/s and Hz for the same.  Here a cycle and an angle are two things: a frequency
    and an angular speed of the same motion differ by 2 pi.
    """

    dimension: Dimension = _PURE
    angle: Fraction = Fraction(0)

    def times(self, other: Kind) -> Kind:
        """The kind of a product."""
        return Kind(self.dimension.times(other.dimension), self.angle + other.angle)

    def power(self, exponent: Fraction | int) -> Kind:
        """The kind of a power."""
        return Kind(self.dimension.power(exponent), self.angle * exponent)

    @property
    def compared(self) -> Kind:
        """What has to be equal for two to add; N*m/rad is a torque all the same, and rad/m a wavenumber."""
        return self if self.dimension in (_PURE, _PER_TIME) else Kind(self.dimension)

    def __str__(self) -> str:
        angle = "" if not self.angle else "rad" if self.angle == 1 else f"rad^{self.angle}"
        return angle if self.dimension == _PURE and angle else " ".join(filter(None, (angle, str(self.dimension))))


class Unit(NamedTuple):
    """A unit: its dimension, the factor that turns a value in it into SI, and how often an angle is a factor of it."""

    dimension: Dimension
    factor: Fraction | float
    angle: Fraction = Fraction(0)

    @property
    def kind(self) -> Kind:
        """What it measures."""
        return Kind(self.dimension, self.angle)

    def to_si(self, value: T) -> T:
        """Convert a float or an array to SI; decimal factors are exact, so 1.2 mm is 0.0012 m to the last bit."""
        given: Any = value
        if isinstance(self.factor, Fraction):
            converted: T = given * float(self.factor.numerator) / float(self.factor.denominator)
        else:
            converted = given * self.factor
        return converted


def _dim(m: int = 0, kg: int = 0, s: int = 0, A: int = 0) -> Dimension:
    return Dimension(Fraction(m), Fraction(kg), Fraction(s), Fraction(A))


_ANGLE = Fraction(1)
_BASE: dict[str, Unit] = {
    "1": Unit(_dim(), Fraction(1)),
    "%": Unit(_dim(), Fraction(1, 100)),
    "m": Unit(_dim(m=1), Fraction(1)),
    "g": Unit(_dim(kg=1), Fraction(1, 1000)),
    "s": Unit(_dim(s=1), Fraction(1)),
    "min": Unit(_dim(s=1), Fraction(60)),
    "A": Unit(_dim(A=1), Fraction(1)),
    "Hz": Unit(_dim(s=-1), Fraction(1)),
    "N": Unit(_dim(m=1, kg=1, s=-2), Fraction(1)),
    "gf": Unit(_dim(m=1, kg=1, s=-2), Fraction(980665, 10**8)),
    "Pa": Unit(_dim(m=-1, kg=1, s=-2), Fraction(1)),
    "V": Unit(_dim(m=2, kg=1, s=-3, A=-1), Fraction(1)),
    "C": Unit(_dim(s=1, A=1), Fraction(1)),
    "W": Unit(_dim(m=2, kg=1, s=-3), Fraction(1)),
    "F": Unit(_dim(m=-2, kg=-1, s=4, A=2), Fraction(1)),
    "S": Unit(_dim(m=-2, kg=-1, s=3, A=2), Fraction(1)),
    "H": Unit(_dim(m=2, kg=1, s=-2, A=-2), Fraction(1)),
    "ohm": Unit(_dim(m=2, kg=1, s=-3, A=-2), Fraction(1)),
    "rad": Unit(_dim(), Fraction(1), _ANGLE),
    "deg": Unit(_dim(), math.pi / 180, _ANGLE),
    "arcmin": Unit(_dim(), 60 * ARCSEC, _ANGLE),
    "arcsec": Unit(_dim(), ARCSEC, _ANGLE),
    "mas": Unit(_dim(), ARCSEC / 1000, _ANGLE),
    "rev": Unit(_dim(), 2 * math.pi, _ANGLE),
    "rpm": Unit(_dim(s=-1), math.pi / 30, _ANGLE),
}
_PREFIX = {"G": 9, "M": 6, "k": 3, "h": 2, "da": 1, "": 0, "d": -1, "c": -2, "m": -3, "u": -6, "n": -9, "p": -12}
_PREFIXED = ("m", "g", "s", "A", "Hz", "N", "gf", "Pa", "V", "C", "W", "F", "S", "H", "ohm", "rad")
_SPOKEN = {  # as CF conventions and units libraries write them, and plurals of them
    **{"meter": "m", "metre": "m", "gram": "g", "second": "s", "ampere": "A", "hertz": "Hz", "newton": "N"},
    **{"pascal": "Pa", "volt": "V", "coulomb": "C", "radian": "rad", "minute": "min", "percent": "%"},
    **{"watt": "W", "farad": "F", "siemens": "S", "henry": "H"},
    **{"degree": "deg", "arcminute": "arcmin", "arcsecond": "arcsec", "turn": "rev", "revolution": "rev"},
    **{"dimensionless": "1", "revolutions_per_minute": "rpm", "sec": "s", "r": "rev"},
}
_TEN_TO = {power: Fraction(10) ** power for power in range(-12, 10)}
_SPOKEN_PREFIX = {"giga": 9, "mega": 6, "kilo": 3, "centi": -2, "milli": -3, "micro": -6, "nano": -9, "pico": -12}


def _symbols() -> dict[str, Unit]:
    table = dict(_BASE)
    for name in _PREFIXED:
        unit = _BASE[name]
        for prefix, power in _PREFIX.items():
            table.setdefault(prefix + name, unit._replace(factor=unit.factor * _TEN_TO[power]))
    for name in ("m", "cm", "mm"):  # torques without a sign between
        for force in [symbol for symbol in table if symbol.endswith(("N", "gf"))]:
            first, second = table[force], table[name]
            table.setdefault(force + name, Unit(_TORQUE, Fraction(first.factor) * Fraction(second.factor)))
    for word, symbol in _SPOKEN.items():
        unit = _BASE[symbol]
        table.setdefault(word, unit)
        for prefix, power in _SPOKEN_PREFIX.items() if symbol in _PREFIXED and len(word) > 3 else ():
            table[prefix + word] = unit._replace(factor=unit.factor * _TEN_TO[power])
    return table


_TORQUE = _BASE["N"].dimension.times(_BASE["m"].dimension)
_SYMBOLS = _symbols()
_INERTIAS = {f"{mass}{length}": (mass, length) for mass in ("kg", "g") for length in ("m", "cm", "mm")}
del _INERTIAS["gm"]  # an old gram

_SPELLING = str.maketrans(
    {
        **dict.fromkeys("·⋅∙•×", "*"),
        **dict.fromkeys("µμ", "u"),
        **dict.fromkeys("−‐‑–", "-"),
        "°": "deg",
        "′": "arcmin",
        "″": "arcsec",
        **dict.fromkeys("Ω\u2126", "ohm"),
    }
)
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-")
_TOKEN = re.compile(
    r"\s*(?:(?P<symbol>[A-Za-z_]+|%|1(?!\d))(?:(?:\s*(?:\^|\*\*)\s*)?(?P<power>[+-]?\d\d?)(?!\d))?"
    r"|(?P<open>\()|\)(?:(?:\s*(?:\^|\*\*)\s*)?(?P<whole>[+-]?\d\d?)(?!\d))?|(?P<sign>[*/.]|-(?=[A-Za-z])))",
    re.ASCII,
)


@lru_cache(maxsize=512)  # a table of one point asks some two hundred times for a few units
def parse_unit(text: str) -> Unit:
    """Parse a unit such as ``mm``, ``kg/m^3``, ``kg m-3``, ``N*m``, ``mNm``, ``m²/N``, ``1/(N s)`` or ``arcsec/s``.

    Factors are joined by ``*``, ``·``, ``.``, a hyphen before a letter, or a space; exponents are written ``m^2``,
    ``m**2``, ``m2``, ``m²``.  What stands behind a ``/`` is one factor or in brackets, since people read ``N/m*s``
    in two ways.

    Raises
    ------
    ValueError
        If a part of the text is not a known unit, or the unit is beyond any use.
    """
    if len(text) > _LONGEST_UNIT:
        raise ValueError(f"a unit of more than {_LONGEST_UNIT} characters")
    spelt = re.sub("[⁰¹²³⁴-⁹⁺⁻]+", lambda raised: "^" + raised[0].translate(_RAISED), text.strip())
    tokens = _tokens(spelt.translate(_SPELLING), text)
    kind, factor, scale = _product(tokens, text, 0)
    if not 1e-60 < factor * Fraction(scale) < 1e60 or max(map(abs, (*kind.dimension, kind.angle))) > _MOST:
        raise ValueError("a unit too large or too small")
    return Unit(kind.dimension, factor if scale == 1.0 else float(factor) * scale, kind.angle)


def _tokens(spelt: str, text: str) -> Iterator[re.Match[str]]:
    place = 0
    while place < len(spelt):
        token = _TOKEN.match(spelt, place)
        if token is None:
            raise ValueError(f"unknown unit {shorten(repr(text.strip()))}")
        yield token
        place = token.end()


_Value = tuple[Kind, Fraction, float]


def _power(value: _Value, exponent: int) -> _Value:
    kind, factor, scale = value
    size = math.log10(factor.numerator) - math.log10(factor.denominator) + math.log10(scale)
    if max(map(abs, (*kind.dimension, kind.angle, Fraction(size)))) * abs(exponent) > _MOST:
        raise ValueError("a unit too large or too small")
    return kind.power(exponent), factor**exponent, scale**exponent


def _product(tokens: Iterator[re.Match[str]], text: str, depth: int) -> _Value:
    """A product of factors up to the closing bracket or the end."""
    kind, factor, scale = Kind(), Fraction(1), 1.0
    divide, behind, pending, count = False, False, True, 0  # pending: a factor has to follow
    unreadable = ValueError(f"unknown unit {shorten(repr(text.strip()))}")
    closed: int | None = None
    for token in tokens:
        if token["sign"]:
            if pending:
                raise unreadable
            pending, divide = True, token["sign"] == "/"
            continue
        if token["symbol"]:
            if not pending and not token[0][0].isspace():  # m2s: what the 2 belongs to is open
                raise unreadable
            value = _symbol(token["symbol"], token["power"])
        elif token["open"]:
            if depth == _DEEPEST:
                raise ValueError("a unit with too many brackets")
            value = _product(tokens, text, depth + 1)
        else:
            closed = int(token["whole"] or 1)
            break
        if behind and not divide:
            raise ValueError(f"{shorten(repr(text.strip()))} can be read in two ways; put what divides in brackets")
        value = _power(value, -1) if divide else value
        kind, factor, scale = kind.times(value[0]), factor * value[1], scale * value[2]
        if not 1e-90 < scale < 1e90:
            raise ValueError("a unit too large or too small")
        behind, divide, pending, count = behind or divide, False, False, count + 1
    if pending or (closed is None) != (depth == 0):
        raise unreadable
    return (kind, factor, scale) if closed is None else _power((kind, factor, scale), closed)


def _symbol(name: str, power: str | None) -> _Value:
    """A symbol with its exponent."""
    if name in _INERTIAS and power == "2":
        mass, length = (_SYMBOLS[symbol] for symbol in _INERTIAS[name])
        return mass.kind.times(length.kind.power(2)), Fraction(mass.factor) * Fraction(length.factor) ** 2, 1.0
    unit = _SYMBOLS.get(name) or _spoken(name)
    if unit is None or (power and _is_joined(name)) or (power and name == "1"):
        raise ValueError(f"unknown unit {shorten(repr(name + (power or '')))}{_nearest(name)}")
    exact = isinstance(unit.factor, Fraction)
    value = unit.kind, unit.factor if exact else Fraction(1), 1.0 if exact else float(unit.factor)
    return _power(value, int(power or 1))  # type: ignore[arg-type]


def _is_joined(name: str) -> bool:
    """Whether a symbol is a torque written without a sign between: whose metre an exponent would belong to is open."""
    return name in _SYMBOLS and _SYMBOLS[name].dimension == _TORQUE


def _spoken(name: str) -> Unit | None:
    """The unit of a word, which may be in the plural or begin with a capital."""
    word = name.lower()
    if len(word) < 4:
        return None
    words = (word, word.removesuffix("s"))
    return next((_SYMBOLS[w] for w in words if w in _SYMBOLS and (len(w) > 3 and w not in _BASE)), None)


def _nearest(name: str) -> str:
    from difflib import get_close_matches

    alike = [symbol for symbol in _SYMBOLS if symbol.casefold() == name.casefold() and symbol != name]
    close = alike or get_close_matches(name, _SYMBOLS, n=3, cutoff=0.6)
    return f"; close ones: {', '.join(close)}" if close else ""


def unit_for(given: str, wanted: str, value: float | None = None) -> Unit:
    """The unit ``given``, if what it measures is what ``wanted`` does.

    Parameters
    ----------
    given : str
        The unit that something is in.
    wanted : str
        The unit that it has to convert to.
    value : float, optional
        In the given unit, for the error to say what it would be.

    Raises
    ------
    ValueError
        For an unknown unit, or one of another kind: a frequency is not an angular speed, an angle not a pure number.
    """
    unit, target = parse_unit(given), parse_unit(wanted)
    if unit.kind.compared == target.kind.compared:
        return unit
    if unit.dimension == target.dimension == _PER_TIME:
        exact = unit.to_si(1.0 if value is None else value)
        if target.angle == 0 and unit.angle == 1:
            meant = "" if value is None else f": {exact / (2 * math.pi):.6g} {wanted} are meant if so"
            raise ValueError(f"{given} is an angle per time, which is 2*pi times the frequency{meant}")
        if target.angle == 1 and unit.angle == 0:
            meant = "" if value is None else f": {exact * 2 * math.pi:.6g} {wanted} are meant if these are turns"
            raise ValueError(f"{given} counts cycles per time, and a turn is 2*pi rad{meant}")
    if unit.dimension == target.dimension == _PURE:
        raise ValueError(f"{given} is {'an angle' if unit.angle else 'a pure number, not an angle'}")
    raise ValueError("")


_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|[+-]?inf|nan)(.*)", re.I | re.S | re.ASCII)


def parse_quantity(name: str, text: str, unit: str) -> float:
    """Read a number with an optional unit, ``"3000"`` or ``"3 kHz"``, and return it in ``unit``.

    A bare number is taken to be in ``unit`` (an SI unit).

    Raises
    ------
    ParameterError
        If the text is no number, or its unit is unknown or of another kind than ``unit``.
    """
    wanted = "a number" if unit == "1" else f"a number in {unit}"
    match = _NUMBER.fullmatch(text.strip()) if len(text) <= _LONGEST_QUANTITY else None
    if match is None:
        raise ParameterError(name, text, wanted)
    value, given_unit = float(match[1]), match[2].strip()
    if not given_unit:
        return value
    try:
        given = unit_for(given_unit, unit, value)
    except ValueError as error:
        other = f" ({error})" if str(error) else ", or in a unit that converts to it" if unit != "1" else ""
        raise ParameterError(name, text, wanted + other) from None
    return given.to_si(value)
