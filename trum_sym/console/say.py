"""What the console prints: text of others, such as a motor's name or a path, cannot steer the terminal."""

from __future__ import annotations

import click

from trum_sym.text import plain

__all__ = ["say"]


def say(text: str, *, err: bool = False) -> None:
    """Print lines, on the standard error if ``err``.

    Raises
    ------
    ParameterError
        If the standard output takes no more; a standard error that takes no more is left alone.
    """
    try:
        click.echo(plain(text), err=err)
    except BrokenPipeError:
        raise  # click ends the command: whoever read has enough
    except OSError as error:
        if not err:
            from trum_sym.errors import ParameterError

            raise ParameterError("standard output", error.strerror, "a place that takes the result") from None
