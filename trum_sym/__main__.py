"""``trum-sym`` and ``python -m trum_sym``: the console as a process, with its signals and its streams.

Python raises what a signal means wherever it happens to be; in a module that is being loaded that may turn into another
error, and in a destructor into a report that nobody asked for.  Here a signal that has come is the answer, whatever it
was turned into.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

__all__ = ["run"]

_ENDING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
_AGAIN = 0.1  # s, until a signal that was lost in a destructor is raised again


class _Signals:
    """The signals that end a command, and which has come."""

    def __init__(self) -> None:
        self.come: int | None = None
        for number in _ENDING:
            if signal.getsignal(number) is not signal.SIG_IGN:  # as nohup and a shell's & leave it
                signal.signal(number, self._take)
        sys.unraisablehook = self._lost
        sys.excepthook = self._printed

    def _take(self, number: int, _: FrameType | None) -> None:
        if self.come is not None:  # while the first is tidied up after
            os._exit(128 + number)
        self.come = number
        raise KeyboardInterrupt

    def _printed(self, kind: type[BaseException], error: BaseException, where: TracebackType | None) -> None:
        if self.come is None:  # or Cython prints what it cannot pass on
            sys.__excepthook__(kind, error, where)

    def _lost(self, what: UnraisableHookArgs) -> None:
        if self.come is not None and issubclass(what.exc_type, KeyboardInterrupt):
            import threading

            number, self.come = self.come, None
            threading.Timer(_AGAIN, os.kill, (os.getpid(), number)).start()


def _open_streams() -> None:
    """Put the null device where a stream was closed: the next file that is opened would take its number."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def _end(code: int) -> NoReturn:
    """End without the interpreter's own attempt to write what could not be written."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(code)


def run() -> NoReturn:
    """Run the console, and end the process.

    Exit codes are the console's; 128 and the number of a signal that ended it, 141 without a word where a pipe was
    closed, as ``head`` does.
    """
    signals = _Signals()
    code, message = 0, None
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads take longer to start than any matrix here
    try:
        _open_streams()
        from trum_sym.console import outcome

        code, message = outcome()
    except BaseException:
        if signals.come is None:
            raise
    if signals.come is not None:
        code, message = 128 + signals.come, "interrupted"
    if message is not None:
        with suppress(OSError, ValueError):
            try:
                sys.stderr.write(f"trum-sym: {message}\n")
            except UnicodeEncodeError:
                sys.stderr.write(f"trum-sym: {message.encode('ascii', 'backslashreplace').decode('ascii')}\n")
    _end(code)


if __name__ == "__main__":
    run()
