"""Text on disk, whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from trum_sym.errors import ParameterError

__all__ = ["check_text_target", "write_text"]


def check_text_target(name: str, target: Path, suffixes: tuple[str, ...]) -> None:
    """Refuse, before any work is done, a file that cannot be written.

    Raises
    ------
    ParameterError
        For another suffix, a folder that is not there or not ours to write in.
    """
    if target.suffix not in suffixes:
        raise ParameterError(name, str(target), f"a file name that ends in {' or '.join(suffixes)}")
    if target.is_dir():
        raise ParameterError(name, str(target), "a file; this is a folder")
    if not target.parent.is_dir() or not os.access(target.parent, os.W_OK):
        raise ParameterError(name, str(target), "a file in a folder that exists and can be written to")


def write_text(name: str, text: str, target: Path) -> None:
    """Write beside the file and rename, so that no half-written one is ever seen.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    beside = None
    try:
        handle, path = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
        beside = Path(path)
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        mask = os.umask(0)
        os.umask(mask)
        beside.chmod(0o666 & ~mask)  # as any other new file; mkstemp's are private
        beside.replace(target)
        beside = None
    except OSError as error:
        raise ParameterError(name, str(target), f"a file that can be written ({error.strerror or error})") from None
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)
