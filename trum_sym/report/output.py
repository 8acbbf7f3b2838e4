"""The report on disk: the page and the ledger beside it, each whole or not at all."""

from __future__ import annotations

import stat
import tempfile
from pathlib import Path

from trum_sym.errors import ParameterError
from trum_sym.inputs.motor import Motor
from trum_sym.output.files import found, write_bytes
from trum_sym.paper.ledger import ledger_page
from trum_sym.report.page import page

__all__ = ["check_folder", "write_report"]


def check_folder(name: str, folder: Path) -> None:
    """Make the folder if it is not there; refuse, before any work is done, what cannot be written to.

    Raises
    ------
    ParameterError
        For a file, or a folder that is not ours to write in.
    """
    there = found(name, folder)
    if there is not None and not stat.S_ISDIR(there.st_mode):
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
        Whose figures and tables.
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
    write_bytes("DIR", ledger_page().encode(), folder / "ledger.html")
    write_bytes("DIR", text.encode(), folder / "index.html")
    return folder / "index.html"
