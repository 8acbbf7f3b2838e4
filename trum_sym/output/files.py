"""Files, whole or not at all; data sets as NetCDF, Parquet or CSV by the file's suffix."""

from __future__ import annotations

import io
import os
import re
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from trum_sym.errors import MissingExtraError, ParameterError

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SUFFIXES", "check_packages", "check_target", "found", "replaced", "write", "write_bytes"]

SUFFIXES = (".nc", ".parquet", ".csv")
_REST = ".partial"


def found(name: str, target: Path) -> os.stat_result | None:
    """What is at a path, None if nothing is.

    Raises
    ------
    ParameterError
        For a path that the system does not take: too long, a circle of links, a folder that is closed to us.
    """
    try:
        return target.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ParameterError(name, str(target), f"a path that the system takes ({reason})") from None


def check_target(name: str, target: Path, suffixes: tuple[str, ...] = SUFFIXES) -> None:
    """Refuse, before any work is done, a file that cannot be written.

    Raises
    ------
    ParameterError
        For another suffix than these, what is there and no file, a file or a folder that is not there or not ours to
        write in.
    """
    if target.suffix not in suffixes:
        *others, last = suffixes
        words = f"{', '.join(others)} or {last}" if others else last
        raise ParameterError(name, str(target), f"a file name that ends in {words}")
    there = found(name, target)
    if there is not None and stat.S_ISDIR(there.st_mode):
        raise ParameterError(name, str(target), "a file; this is a folder")
    if there is not None and not stat.S_ISREG(there.st_mode):
        raise ParameterError(name, str(target), "a file; this is a pipe or a device")
    if there is not None and not os.access(target, os.W_OK):
        raise ParameterError(name, str(target), "a file that can be written to; this one is read-only")
    folder = Path(os.path.realpath(target)).parent
    if not folder.is_dir() or not os.access(folder, os.W_OK | os.X_OK):
        raise ParameterError(name, str(target), "a file in a folder that exists and can be written to")


def check_new(name: str, target: Path, suffixes: tuple[str, ...] = SUFFIXES, force: bool = False) -> None:
    """As :func:`check_target`; and refuse a file that exists, unless it is to be replaced.

    Raises
    ------
    ParameterError
        As there, or for a file that exists.
    """
    check_target(name, target, suffixes)
    if target.exists() and not force:
        raise ParameterError(name, str(target), "a new file, or --force to replace it: this one exists")


def check_packages(target: Path) -> None:
    """Refuse a data set's file for which a package is missing.

    Raises
    ------
    MissingExtraError
        Without xarray or, for NetCDF, h5netcdf or, for Parquet, pyarrow.
    """
    extra = "sweep" if target.suffix == ".parquet" else "data"
    try:
        import xarray  # noqa: F401

        if target.suffix == ".nc":
            import h5netcdf  # noqa: F401
            import h5py  # noqa: F401
        elif target.suffix == ".parquet":
            import pyarrow  # type: ignore[import-untyped]  # noqa: F401
    except ImportError as error:
        raise MissingExtraError(f"a {target.suffix} file", str(error.name), extra) from None


@contextmanager
def replaced(name: str, target: Path) -> Iterator[BinaryIO]:
    """A new file beside the target to write to; it takes the target's place at the end, if nothing failed until then.

    It is on the disk before it does, has the rights of the file that it replaces, and goes where a link leads.  What
    killed processes have left of the same target is removed first.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    beside = None
    try:
        real = Path(os.path.realpath(target))
        prefix = f".{real.name[:40]}-"
        _remove_rests(real.parent, prefix)
        handle, beside = _locked(real.parent, prefix)
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            beside.chmod(_rights(real))
            os.fsync(handle)  # a full disk may show only here
        beside.replace(real)
        beside = None
        with suppress(OSError):  # not every file system can
            folder = os.open(real.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)
    except OSError as error:
        raise ParameterError(name, str(target), f"a file that can be written ({error.strerror or error})") from None
    finally:
        if beside is not None:
            beside.unlink(missing_ok=True)


def _rights(target: Path) -> int:
    """Those of the file that is there, else of any new file; temporary ones are private."""
    with suppress(FileNotFoundError):
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _lock(handle: int, wait: bool) -> bool:
    """Hold a file until it is closed; whether that is possible here."""
    try:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (OSError, ImportError):
        return False
    return True


def _locked(folder: Path, prefix: str) -> tuple[int, Path]:
    """A new file that no process which looks for rests takes for one."""
    while True:
        handle, path = tempfile.mkstemp(prefix=prefix, suffix=_REST, dir=folder)
        _lock(handle, wait=True)
        if os.fstat(handle).st_nlink:
            return handle, Path(path)
        os.close(handle)  # removed between its making and its lock


def _remove_rests(folder: Path, prefix: str) -> None:
    """Remove what processes that were killed have left; one that lives holds a lock on its own."""
    ours = re.compile(re.escape(prefix) + r"[a-z0-9_]{8}" + re.escape(_REST))
    for entry in os.scandir(folder):
        if not ours.fullmatch(entry.name) or not entry.is_file(follow_symlinks=False):
            continue
        with suppress(OSError):
            handle = os.open(entry.path, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
            try:
                if _lock(handle, wait=False):
                    os.unlink(entry.path)
            finally:
                os.close(handle)


def write(name: str, dataset: xr.Dataset, target: Path) -> None:
    """Write beside the file and rename, so that no half-written one is ever seen.

    Parquet and CSV have one row per point and the units in the names of their columns; NetCDF and Parquet keep the
    attributes of the set too.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    MissingExtraError
        Without a package that writes this file.
    """
    check_target(name, target)
    check_packages(target)
    if target.suffix == ".nc":
        write_bytes(name, _netcdf(dataset), target)
        return
    units = {
        name: f"{name} [{array.attrs['units']}]" for name, array in dataset.variables.items() if "units" in array.attrs
    }
    table = dataset.to_dataframe().reset_index().rename(columns=units)
    if target.suffix == ".csv":
        with replaced(name, target) as file:
            table.to_csv(file, index=False, float_format="%.17g")
    else:
        table.attrs = dict(dataset.attrs)
        content = io.BytesIO()
        table.to_parquet(content, index=False)
        write_bytes(name, content.getbuffer(), target)


def _netcdf(dataset: xr.Dataset) -> memoryview:
    """The set as a NetCDF file in memory: HDF5 that meets a full disk as it closes a file crashes the interpreter."""
    import h5netcdf
    import xarray as xr

    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        dataset.dump_to_store(xr.backends.H5NetCDFStore(file))
    return content.getbuffer()


def write_bytes(name: str, content: bytes | memoryview, target: Path) -> None:
    """Write what is there already in the same way: beside the file, then rename.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    with replaced(name, target) as file:
        file.write(content)
