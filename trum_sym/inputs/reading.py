"""Files of others, read: only ordinary ones, and not without end."""

from __future__ import annotations

import errno
import io
import os
import stat
from pathlib import Path
from typing import BinaryIO, cast

__all__ = ["opened", "read_text"]


def opened(path: Path) -> BinaryIO:
    """An ordinary file to read.

    Raises
    ------
    OSError
        If there is none, or what is there is no file.
    """

    def check(mode: int) -> None:
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, "a pipe or a device; save what it gives to a file")

    check(path.stat().st_mode)  # what opening a device does is not known
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    file = cast("BinaryIO", os.fdopen(handle, "rb"))
    try:
        check(os.fstat(handle).st_mode)
    except OSError:
        file.close()
        raise
    return file


def read_text(path: Path, most: int, encoding: str = "utf-8") -> str:
    """The text of an ordinary file: a pipe or a device may have no end, or never begin.

    Raises
    ------
    OSError
        If there is none, it is no file, or is longer than ``most`` bytes.
    UnicodeDecodeError
        If it is no such text.
    """
    with opened(path) as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"longer than {most} bytes")
    return io.TextIOWrapper(io.BytesIO(content), encoding=encoding).read()
