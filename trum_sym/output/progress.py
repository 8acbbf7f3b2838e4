"""What a long run tells of itself."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import TextIO, TypeVar

__all__ = ["Progress", "duration", "said", "shown"]

T = TypeVar("T")


def shown(
    items: Iterable[T],
    label: str | None,
    length: int | None = None,
    describe: Callable[[T | None], str | None] | None = None,
) -> Iterator[T]:
    """The items one by one, with a bar on the standard error while they are worked through.

    Parameters
    ----------
    items : iterable
        What is worked through.
    label : str or None
        The bar's; no bar without one, nor where the standard error is no terminal.
    length : int, optional
        How many items there are, where they do not say.
    describe : callable, optional
        What to say of the item in work.
    """
    if label is None or not sys.stderr.isatty():
        yield from items
        return
    import click

    with click.progressbar(items, length, label, file=sys.stderr, item_show_func=describe, update_min_steps=1) as bar:
        yield from bar


def said(label: str | None) -> Callable[[str], None]:
    """For work whose length is not known: tells the standard error what is done now, or nothing without a label."""
    if label is None:
        return lambda _: None
    import click

    return lambda what: click.echo(f"{label}: {what}", err=True)


_TERMINAL, _LOG = 0.5, 30.0  # s between two lines


def duration(seconds: float) -> str:
    """In the units that people plan with."""
    if seconds < 120:
        return f"{seconds:.3g} s"
    if seconds < 7200:
        return f"{seconds / 60:.3g} min"
    return f"{seconds / 3600:.3g} h" if seconds < 48 * 3600 else f"{seconds / 86400:.3g} days"


class Progress:
    """Points done, rate, time left and failures: one line that is renewed, or a line now and then in a log.

    Parameters
    ----------
    total, before : int
        Points in all, and those that were done when the run began.
    stream : text file, optional
        Nothing is shown if not given.
    """

    def __init__(self, total: int, before: int, stream: TextIO | None = None) -> None:
        self.total, self.done, self.failed = total, before, 0
        self._before, self._begin, self._stream = before, time.monotonic(), stream
        self._terminal = stream is not None and stream.isatty()
        self._shown = self._begin - (_LOG if self._terminal else 0)

    def add(self, points: int, failed: int) -> None:
        """Count a chunk."""
        self.done += points
        self.failed += failed

    def tick(self) -> None:
        """Show where things are, if it is time to."""
        if self._stream and time.monotonic() - self._shown >= (_TERMINAL if self._terminal else _LOG):
            self._shown = time.monotonic()
            self._print("" if self._terminal else "\n")

    def close(self) -> None:
        """The last line."""
        if self._stream:
            self._print("\n")

    def _print(self, end: str) -> None:
        with suppress(OSError):  # what cannot be told does not stop the work
            print(("\r\x1b[K" if self._terminal else "") + self.line(), end=end, file=self._stream, flush=True)

    def line(self) -> str:
        """Where things are, in words."""
        seconds = time.monotonic() - self._begin
        rate = (self.done - self._before) / seconds if seconds > 0 else 0.0
        text = f"{self.done} of {self.total} points ({100 * self.done / self.total:.3g} %)"
        if rate > 0:
            text += f", {rate:.3g} a second"
            if self.done < self.total:
                text += f", {duration((self.total - self.done) / rate)} left"
        return f"{text}, {self.failed} failed"
