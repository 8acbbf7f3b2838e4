"""Figures of an effect: printed in its sentence, and kept apart so that a second route can recompute them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from decimal import Decimal
from typing import SupportsFloat

__all__ = ["Figure", "figure", "recorded"]


@dataclass(frozen=True)
class Figure:
    """A figure as it is printed, and the number behind it."""

    printed: str
    value: float

    @property
    def half_digit(self) -> float:
        """Half a unit of the last printed digit."""
        exponent = Decimal(self.printed).as_tuple().exponent
        return 0.5 * 10.0 ** (exponent if isinstance(exponent, int) else 0)


_seen: ContextVar[list[Figure] | None] = ContextVar("figures of an effect", default=None)


@contextmanager
def recorded() -> Iterator[list[Figure]]:
    """The figures that :func:`figure` prints meanwhile, in their order."""
    figures: list[Figure] = []
    token = _seen.set(figures)
    try:
        yield figures
    finally:
        _seen.reset(token)


def figure(value: SupportsFloat, digits: int = 4, spec: str | None = None) -> str:
    """A number for a sentence, such as 12.6, 9 or 3e+10; with ``spec`` as that format prints it."""
    text = format(float(value), spec or f".{digits}g")
    figures = _seen.get()
    if figures is not None:
        figures.append(Figure(text, float(value)))
    return text
