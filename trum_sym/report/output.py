"""The report on disk: the page and the ledger beside it, each whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from trum_sym.errors import ParameterError
from trum_sym.ledger import ledger_page
from trum_sym.motor import Motor
from trum_sym.report.page import page

__all__ = ["check_folder", "write_report"]


def check_folder(name: str, folder: Path) -> None:
    """Make the folder if it is not there; refuse, before any work is done, what cannot be written to.

    Raises
    ------
    ParameterError
        For a file, or a folder that is not ours to write in.
    """
    if folder.exists() and not folder.is_dir():
        raise ParameterError(name, str(folder), "a folder; this is a file")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ParameterError(name, str(folder), f"a folder to write in ({error.strerror or error})") from None


def write_report(motor: Motor, folder: Path, *, progress: bool = False) -> Path:
    """Write ``index.html`` and ``ledger.html`` into a folder; returns the path of the former.

    Parameters
    ----------
    motor : Motor
    folder : Path
        Made if it is not there.
    progress : bool
        Whether to show a bar on the standard error.

    Raises
    ------
    ParameterError
        If the folder cannot be written to.
    MissingExtraError
        Without matplotlib or jinja2.
    """
    check_folder("DIR", folder)
    text = page(motor, progress=progress)
    _replace(folder / "ledger.html", ledger_page())
    _replace(folder / "index.html", text)
    return folder / "index.html"


def _replace(target: Path, text: str) -> None:
    """Write beside the file and rename, so that no half-written one is ever seen."""
    beside = None
    try:
        handle, path = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
        beside = Path(path)
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        mask = os.umask(0)
        os.umask(mask)
        beside.chmod(0o666 & ~mask)  # as any other new file; mkstemp's are private
        beside.replace(target)
        beside = None
    except OSError as error:
        raise ParameterError("DIR", str(target), f"a file that can be written ({error.strerror or error})") from None
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)
