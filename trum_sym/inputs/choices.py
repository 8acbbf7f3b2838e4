"""Checks of words and names of files that come from outside."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path

from trum_sym.errors import ParameterError

__all__ = ["choice", "path_of", "words"]


def choice(name: str, value: object, allowed: tuple[str, ...]) -> None:
    """Check a word against the words that are allowed.

    Raises
    ------
    ParameterError
        If it is none of them.
    """
    if not isinstance(value, str) or value not in allowed:
        raise ParameterError(name, value, f"one of {', '.join(allowed)}")


def words(name: str, given: object, allowed: str) -> tuple[str, ...]:
    """Several words in a list, a tuple or the like; one text is none.

    Raises
    ------
    ParameterError
        If it is no sequence, is empty, or something in it is no text.
    """
    if isinstance(given, str) or not isinstance(given, Sequence) or not given:
        raise ParameterError(name, given, allowed)
    for word in given:
        if not isinstance(word, str):
            raise ParameterError(name, word, allowed)
    return tuple(given)


def path_of(name: str, given: object, allowed: str = "the path of a file") -> Path:
    """The path of a file.

    Raises
    ------
    ParameterError
        If it is neither text nor a path, or no file can be called so.
    """
    try:
        text = fspath(given) if isinstance(given, str | PathLike) else None
    except Exception:  # what a stranger's path raises
        text = None
    if not isinstance(text, str) or not text or "\0" in text:
        raise ParameterError(name, given, allowed)
    return Path(text)
