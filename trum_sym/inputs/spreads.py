"""How far a number may be off, in the one notation that every study takes: a share, two ends, or a distribution."""

from __future__ import annotations

from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.distributions import KINDS, Distribution, from_text
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.points import one_number

__all__ = ["FORMS", "Spread", "half_width", "read_spread"]

Spread = Distribution | float | str | tuple[float | str, float | str] | None

FORMS = "a share such as '10 %', an amount such as '+-1 N', LOW:HIGH, or KIND:NUMBER:... with KIND one of " + ", ".join(
    KINDS
)
"""What may be given, in words."""

_SHARE = Domain(low=0.0, high=1.0)
_POSITIVE = Domain(low=0.0)


def _amount(text: str) -> str | None:
    """What follows ``+-``, if a text begins so."""
    for mark in ("+-", "±"):
        if text.strip().startswith(mark):
            return text.strip().removeprefix(mark).strip()
    return None


def half_width(name: str, given: Any, unit: str) -> tuple[float, bool]:  # noqa: ANN401
    """How far a number may be off to either side, and whether that is a share of it.

    Parameters
    ----------
    name : str
        The parameter's, for errors.
    given : Spread
        An amount ``"+-1 N"``, a share, or two ends.
    unit : str
        The parameter's.

    Raises
    ------
    ParameterError
        If it is none of these.
    """
    label, forms = f"spread of {name}", "an amount such as '+-1 N', a share such as '1 %', or LOW:HIGH"
    if isinstance(given, str) and (amount := _amount(given)) is not None:
        return one_number(label, amount, unit, _POSITIVE), False
    if isinstance(given, str) and ":" in given:
        given = tuple(end.strip() for end in given.split(":"))
    if isinstance(given, tuple | list):
        if len(given) != 2:
            raise ParameterError(label, given, forms)
        low, high = (one_number(label, end, unit) for end in given)
        if not low < high:
            raise ParameterError(label, f"{low:g} to {high:g}", "low < high" + (f" in {unit}" if unit != "1" else ""))
        return (high - low) / 2, False
    if given is None or isinstance(given, Distribution):
        raise ParameterError(label, "nothing" if given is None else f"a {given.kind} distribution", forms)
    return one_number(label, given, "1", _SHARE), True


def read_spread(
    name: str,
    given: Any,  # noqa: ANN401
    value: float,
    unit: str,
    domain: Domain,
    stated: Distribution | None,
) -> Distribution:
    """The distribution that is meant; a share and two ends are uniform.

    Parameters
    ----------
    name : str
        The parameter's, for errors.
    given : Spread
        None for what the motor file states.
    value : float
        The parameter's own, in ``unit``, of which a share is taken.
    unit, domain
        The parameter's.
    stated : Distribution or None
        What the motor file says.

    Raises
    ------
    ParameterError
        For what is none of these, and for None where the motor file states nothing.
    """
    label = f"spread of {name}"
    if given is None:
        if stated is None:
            raise ParameterError(label, "nothing", f"{FORMS}; the motor file states none")
        return stated
    if isinstance(given, Distribution):
        return given
    if isinstance(given, str):
        kind, colon, _ = given.partition(":")
        if colon and kind.strip().isalpha():
            return from_text(name, given, unit)
        ends = [end.strip() for end in given.split(":")]
        if len(ends) > 2 or not all(ends):
            raise ParameterError(label, given, FORMS)
        given = tuple(ends) if colon else given
    if isinstance(given, str) and _amount(given) is not None:
        off = one_number(label, _amount(given), unit, _POSITIVE)
        given = (value - off, value + off)
    if isinstance(given, tuple | list):
        if len(given) != 2:
            raise ParameterError(label, given, f"two numbers, low and high, or {FORMS}")
        low, high = (one_number(label, end, unit, domain) for end in given)
    else:
        share = one_number(label, given, "1", _SHARE)
        low, high = sorted((value * (1 - share), value * (1 + share)))
        low, high = (one_number(label, end, unit, domain) for end in (low, high))
    if not low < high:
        raise ParameterError(label, f"{low:g} to {high:g}", "low < high" + (f" in {unit}" if unit != "1" else ""))
    return Distribution("uniform", low, high)
