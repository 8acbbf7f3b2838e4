"""Checks of words that come from outside."""

from __future__ import annotations

from trum_sym.errors import ParameterError

__all__ = ["choice"]


def choice(name: str, value: object, allowed: tuple[str, ...]) -> None:
    """Check a word against the words that are allowed.

    Raises
    ------
    ParameterError
        If it is none of them.
    """
    if not isinstance(value, str) or value not in allowed:
        raise ParameterError(name, value, f"one of {', '.join(allowed)}")
