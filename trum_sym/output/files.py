"""Data sets on disk: NetCDF, Parquet or CSV by the file's suffix, whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from trum_sym.errors import MissingExtraError, ParameterError

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SUFFIXES", "check_packages", "check_target", "replaced", "write", "write_bytes"]

SUFFIXES = (".nc", ".parquet", ".csv")


def check_target(name: str, target: Path, suffixes: tuple[str, ...] = SUFFIXES) -> None:
    """Refuse, before any work is done, a file that cannot be written.

    Raises
    ------
    ParameterError
        For another suffix than these, a folder that is not there or not ours to write in.
    """
    if target.suffix not in suffixes:
        *others, last = suffixes
        words = f"{', '.join(others)} or {last}" if others else last
        raise ParameterError(name, str(target), f"a file name that ends in {words}")
    if target.is_dir():
        raise ParameterError(name, str(target), "a file; this is a folder")
    if not target.parent.is_dir() or not os.access(target.parent, os.W_OK):
        raise ParameterError(name, str(target), "a file in a folder that exists and can be written to")


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
def replaced(name: str, target: Path) -> Iterator[Path]:
    """A file beside the target to write to; it takes the target's place at the end, if nothing failed until then.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    beside = None
    try:
        handle, path = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
        os.close(handle)
        beside = Path(path)
        yield beside
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
    with replaced(name, target) as beside:
        if target.suffix == ".nc":
            dataset.to_netcdf(beside, engine="h5netcdf")
        else:
            units = {
                name: f"{name} [{array.attrs['units']}]"
                for name, array in dataset.variables.items()
                if "units" in array.attrs
            }
            table = dataset.to_dataframe().reset_index().rename(columns=units)
            if target.suffix == ".csv":
                table.to_csv(beside, index=False, float_format="%.17g")
            else:
                table.attrs = dict(dataset.attrs)
                table.to_parquet(beside, index=False)


def write_bytes(name: str, content: bytes, target: Path) -> None:
    """Write what is there already in the same way: beside the file, then rename.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    with replaced(name, target) as beside:
        beside.write_bytes(content)
