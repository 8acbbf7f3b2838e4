"""How an uncertain parameter is distributed: read from a motor file or from text, checked, sampled."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, number
from trum_sym.inputs.domain import Domain, Spec
from trum_sym.inputs.units import parse_quantity
from trum_sym.output.json_text import finite
from trum_sym.values import Value

__all__ = ["KINDS", "Distribution", "checked", "from_text"]

# what each kind is told, in the order of its text form; optional ones after the bar
_FORMS = {
    "uniform": ("low", "high"),
    "triangular": ("low", "mode", "high"),
    "normal": ("mean", "standard_deviation", "|", "low", "high"),
    "lognormal": ("mean", "standard_deviation", "|", "low", "high"),
}
KINDS = tuple(_FORMS)
_WIDEST = 1e6  # beyond this times the width that is left, rounding shows in the levels of a cut distribution
_LONGEST = 1000  # characters of a text
_LEAST = 2.0**-53  # the lowest level that is drawn, and the distance of the highest from 1


@dataclass(frozen=True, eq=False)
class Distribution(Value):
    """The distribution of one uncertain parameter, in its SI unit.

    Attributes
    ----------
    kind : {"uniform", "triangular", "normal", "lognormal"}
    low, high : float
        Nothing beyond them is drawn: a normal or lognormal distribution is cut there.
    mean, standard_deviation : float, optional
        Of the value itself (for ``lognormal`` too, not of its logarithm), before it is cut.
    mode : float, optional
        Where a triangular distribution has its peak.

    Raises
    ------
    ParameterError
        Where it is used, for an unknown kind, ends in the wrong order or values that the parameter cannot have.

    Examples
    --------
    >>> import trum_sym as ts
    >>> ts.Distribution("triangular", low=0.2, mode=0.25, high=0.3).describe()
    'triangular, 0.2 to 0.3, peak 0.25'

    What studies do with it: docs/tolerance.md.
    """

    kind: str
    low: float = -math.inf
    high: float = math.inf
    mean: float | None = None
    standard_deviation: float | None = None
    mode: float | None = None

    def quantile(self, level: Array) -> Array:
        """The values below which shares ``level`` of the distribution lie; same shape, in the parameter's unit.

        Needs SciPy.
        """
        base = self._frozen()
        below, upto = base.cdf(self.low), base.cdf(self.high)
        share = below + np.clip(level, _LEAST, 1 - _LEAST) * (upto - below)
        return np.asarray(np.clip(base.ppf(share), self.low, self.high))

    def _frozen(self) -> Any:  # noqa: ANN401
        from scipy import stats

        width = self.high - self.low
        if self.kind == "uniform":
            return stats.uniform(self.low, width)
        if self.kind == "triangular":
            assert self.mode is not None
            return stats.triang((self.mode - self.low) / width, self.low, width)
        assert self.mean is not None
        assert self.standard_deviation is not None
        if self.kind == "normal":
            return stats.norm(self.mean, self.standard_deviation)
        spread = math.log1p((self.standard_deviation / self.mean) ** 2)
        return stats.lognorm(math.sqrt(spread), scale=self.mean * math.exp(-spread / 2))

    def describe(self) -> str:
        """In words, numbers in the SI unit."""
        if self.kind == "uniform":
            return f"uniform, {self.low:g} to {self.high:g}"
        if self.kind == "triangular":
            return f"triangular, {self.low:g} to {self.high:g}, peak {self.mode:g}"
        cut = f", cut to {self.low:g} to {self.high:g}" if math.isfinite(self.low) or math.isfinite(self.high) else ""
        return f"{self.kind}, {self.mean:g} +- {self.standard_deviation:g}{cut}"

    def as_dict(self) -> dict[str, object]:
        """Everything by name; null where it is not set or not bounded."""
        values: dict[str, object] = finite({field.name: getattr(self, field.name) for field in fields(self)})
        return values


def _wrong(name: str, got: object, allowed: str, unit: str) -> ParameterError:
    return ParameterError(name, got, allowed + (f", in {unit}" if unit != "1" else ""))


def checked(name: str, distribution: Distribution, wanted: Spec) -> Distribution:
    """The distribution as it is sampled: normal and lognormal ones are also cut at the parameter's domain.

    Raises
    ------
    ParameterError
        For an unknown kind, ends in the wrong order, a spread that is not positive, or values that the parameter
        cannot have.
    """
    domain, unit, given = wanted.domain, wanted.unit, _in_si(name, distribution, wanted.unit)
    if domain.integer:
        raise ParameterError(name, given.kind, "one value: it is a whole number and cannot vary continuously")
    if not isinstance(given.kind, str) or given.kind not in _FORMS:
        raise ParameterError(name, given.kind, f"a distribution: {', '.join(KINDS)}")
    for end, at in (("low", given.low), ("high", given.high)):
        if not _real(at) or math.isnan(at):
            raise _wrong(name, f"{end} = {at!r}", "a number", unit)
        if math.isfinite(at) and not domain.contains(np.asarray(at)):
            raise ParameterError(
                name, f"{given.kind} with {end} = {at:g}", f"only values that it can have: {domain.describe(unit)}"
            )
    if not given.low < given.high:
        raise _wrong(name, f"{given.kind} from {given.low:g} to {given.high:g}", "low < high", unit)
    return _checked_bounded(name, given, unit) if given.kind in ("uniform", "triangular") else _cut(name, given, wanted)


def _in_si(name: str, given: Distribution, unit: str) -> Distribution:
    """The distribution with plain numbers, those that carry a unit converted."""
    changed: dict[str, Any] = {}
    for field in fields(given):
        value = getattr(given, field.name)
        if field.name == "kind" or value is None or isinstance(value, float):
            continue
        plain = number(f"{name}, {field.name}", value, Domain(), unit)
        if np.ndim(plain):
            raise ParameterError(f"{name}, {field.name}", f"an array of shape {np.shape(plain)}", "one number")
        changed[field.name] = float(plain)
    return replace(given, **changed)


def _checked_bounded(name: str, given: Distribution, unit: str) -> Distribution:
    """A uniform or triangular distribution, as it was given."""
    if not (math.isfinite(given.low) and math.isfinite(given.high)):
        raise _wrong(name, f"{given.kind} from {given.low:g} to {given.high:g}", "finite low and high", unit)
    if given.kind == "triangular" and not (_real(given.mode) and given.low <= given.mode <= given.high):  # type: ignore[operator]
        raise _wrong(name, f"mode = {given.mode!r}", "low <= mode <= high", unit)
    return given


def _cut(name: str, given: Distribution, wanted: Spec) -> Distribution:
    """A normal or lognormal distribution, cut at the parameter's domain."""
    domain, unit = wanted.domain, wanted.unit
    mean, deviation = given.mean, given.standard_deviation
    if not _real(deviation) or not 0 < deviation < math.inf:  # type: ignore[operator]
        raise _wrong(name, f"standard_deviation = {deviation!r}", "a finite number > 0", unit)
    if not _real(mean) or not domain.contains(np.asarray(mean)):
        raise ParameterError(name, f"mean = {mean!r}", domain.describe(unit))
    if not given.low <= mean <= given.high:  # type: ignore[operator]
        raise _wrong(name, f"mean = {mean:g}", f"a mean from low to high, {given.low:g} to {given.high:g}", unit)
    if given.kind == "lognormal" and not mean > 0:  # type: ignore[operator]
        raise _wrong(name, f"lognormal with mean = {mean:g}", "a mean > 0", unit)
    cut = replace(given, low=max(given.low, domain.low), high=min(given.high, domain.high))
    limit = mean if given.kind == "lognormal" else cut.high - cut.low
    if not mean + deviation != mean or deviation > _WIDEST * limit:  # type: ignore[operator]
        raise _wrong(name, f"standard_deviation = {deviation:g}", "a spread of the size of its values", unit)
    return cut


def _real(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def from_text(name: str, text: str, unit: str) -> Distribution:
    """Read ``KIND:NUMBER:...``, such as ``uniform:25 mm:27 mm`` or ``normal:180:5``; bare numbers are in ``unit``.

    Raises
    ------
    ParameterError
        If the kind is unknown, or its numbers are too few, too many or unreadable.
    """
    if len(text) > _LONGEST:
        raise ParameterError(name, text, f"a distribution of at most {_LONGEST} characters")
    kind, *given = (part.strip() for part in text.split(":"))
    if kind not in _FORMS:
        raise ParameterError(name, kind or text, f"a distribution: {', '.join(KINDS)}")
    needed, _, more = " ".join(_FORMS[kind]).partition("|")
    wanted = [*needed.split(), *more.split()]
    if len(given) not in (len(needed.split()), len(wanted)):
        form = ":".join([kind, *(word.upper() for word in needed.split())])
        form += f"[:{':'.join(word.upper() for word in more.split())}]" if more else ""
        raise ParameterError(name, text, form)
    numbers = {key: parse_quantity(f"{name}, {key}", part, unit) for key, part in zip(wanted, given, strict=False)}
    return Distribution(kind, **numbers)
