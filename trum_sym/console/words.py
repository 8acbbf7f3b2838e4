"""Errors in the words of the console: options as they are typed, values as they were typed."""

from __future__ import annotations

import re
from collections.abc import MutableMapping
from typing import Any

import click

from trum_sym.errors import ParameterError

__all__ = ["TYPED", "in_console_words", "typed"]

TYPED = "trum_sym.typed"
"""Where a context keeps what was typed, by the parameter's name: the text, and the number that it became."""

_NO_WORDS = ("slowest", "fastest", "spreads")  # arguments whose name is no option's, and no word of a sentence
_OF = re.compile(r"(bounds|tolerance|spread|holds) of (\w+)")


def typed(context: click.Context | None, name: str, text: str, value: float) -> None:
    """Keep what was typed for a number."""
    if context is not None:
        context.meta.setdefault(TYPED, {})[name] = (text, value)


def in_console_words(error: ParameterError, command: click.Command, meta: MutableMapping[str, Any]) -> ParameterError:
    """The same error by the option's name, with the value as it was typed."""
    options = {p.name: p.opts[0] for p in command.params if isinstance(p, click.Option) and p.name}
    name, got = error.name, error.got
    text = _as_typed(name, got, meta.get(TYPED, {}))
    of = _OF.fullmatch(name)
    if name in options:
        name = options[name]
    elif of and of[1] in ("spread", "holds"):
        name = f"--{of[1]} {of[2]}"
    elif of and of[2] in options:
        name = options[of[2]]
    return ParameterError(name, text, _renamed(error.allowed, options))


def _as_typed(name: str, got: object, known: dict[str, tuple[str, float]]) -> object:
    if name not in known:
        return _plain(got)
    text, value = known[name]
    try:
        number = float(got)  # type: ignore[arg-type]  # whatever is no number is shown as it is
    except (TypeError, ValueError):
        return got
    return text if number == value or (number != number and value != value) else _plain(got)


def _plain(got: object) -> object:
    """Numbers as people write them."""
    return f"{got:.12g}" if isinstance(got, float) else got


def _renamed(text: str, options: dict[str, str]) -> str:
    """Arguments of Python by the options' names, where the two differ."""
    unlike = {name: option for name, option in options.items() if name in _NO_WORDS}
    if not unlike:
        return text
    pattern = "|".join(map(re.escape, sorted(unlike, key=len, reverse=True)))
    return re.sub(rf"(?<![\w-])(?:{pattern})(?![\w])", lambda found: unlike[found[0]], text)
