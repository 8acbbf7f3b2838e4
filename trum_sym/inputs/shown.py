"""Figures in the units that people read, and numbers with all of their digits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from trum_sym.inputs.units import parse_unit
from trum_sym.quantities import Quantity, known_quantity

if TYPE_CHECKING:
    from trum_sym.inputs.checks import ArrayLike

__all__ = ["full", "quantity_of", "readable"]


def quantity_of(name: str) -> Quantity:
    """Label and units of a figure."""
    found = known_quantity(name)
    if found is None:
        raise KeyError(name)
    return found


def readable(name: str, value: float) -> float:
    """A figure in the unit that people read.

    Examples
    --------
    >>> f"{readable('speed_volatility', 0.173):.1f}"
    '17.3'
    """
    quantity = quantity_of(name)
    return parse_unit(quantity.unit).to_si(value) / parse_unit(quantity.shown).to_si(1.0)


def full(value: ArrayLike) -> str:
    """A number from which others compute the same: the fewest digits that give it back.

    Examples
    --------
    >>> full(180.0), full(2999.7312345)
    ('180', '2999.7312345')
    """
    text = repr(float(value))
    return text.removesuffix(".0")
