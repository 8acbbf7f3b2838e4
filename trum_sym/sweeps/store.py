"""The Zarr store of a sweep: chunks whole or absent, each with a checksum; made once, filled in any order."""

from __future__ import annotations

import json
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import google_crc32c
import numpy as np
import numpy.typing as npt
import xarray as xr
import zarr
from zarr.codecs import Crc32cCodec, ZstdCodec
from zarr.storage import LocalStore

from trum_sym.errors import ParameterError
from trum_sym.sweeps.plan import Plan
from trum_sym.sweeps.task import FLAGS

__all__ = ["Store", "open_store"]

_ABSENT = 255  # of the status, where a chunk is missing
_BUILD = {
    "format": "another layout of the store began it",
    "package": "another version began it",
    "code_sha256": "other Python code began it",
    "kernels_sha256": "other compiled kernels began it",
    "instruction_set": "a processor with another instruction set began it",
}


@dataclass(frozen=True)
class Store:
    """Where the chunks of a plan go.

    Attributes
    ----------
    plan : Plan
        With the chunks that the store has.
    root : Path or None
        None in memory.
    damaged : chunks that were there but not as they were written, and are missing now
    """

    plan: Plan
    root: Path | None
    arrays: Mapping[str, zarr.Array[Any]] | Mapping[str, npt.NDArray[Any]]
    missing: npt.NDArray[np.bool_]
    damaged: int

    def write(self, index: tuple[int, ...], figures: Mapping[str, npt.NDArray[Any]]) -> None:
        """Write a chunk; it counts as done when all its files are there, and each appears at once and whole."""
        for name, values in figures.items():
            array = self.arrays[name]
            if isinstance(array, np.ndarray):
                array[tuple(slice(k * n, (k + 1) * n) for k, n in zip(index, self.plan.chunk, strict=True))] = values
            else:
                array.blocks[index] = values
        self.missing[index] = False

    def dataset(self) -> xr.Dataset:
        """The data set; read from the store as it is used, or all of it if it is in memory."""
        if self.root is None:
            return _dataset(self.plan, self.arrays)
        found: xr.Dataset = xr.open_zarr(self.root, chunks=None)
        for variable in found.variables.values():  # or the set could only be written as this store is
            preferred = variable.encoding.get("preferred_chunks")
            variable.encoding = {} if preferred is None else {"preferred_chunks": preferred}
        return found


@contextmanager
def open_store(name: str, root: Path | None, plan: Plan, chunk_given: bool) -> Iterator[Store]:
    """Make a store for a plan, or open one that the same plan has begun; no other process can until it is closed.

    Parameters
    ----------
    name : str
        Of the parameter that says where.
    root : Path, optional
        In memory if not given.
    plan : Plan
        Of the sweep.
    chunk_given : bool
        Whether the plan's chunks are the user's wish; the store's are used otherwise.

    Raises
    ------
    ParameterError
        For a place that cannot be written, something else in that place, a store of another plan, or one that another
        process is writing.
    """
    if root is None:
        yield _in_memory(plan)
        return
    handle = None
    try:
        if not root.exists() or (root.is_dir() and not any(root.iterdir())):
            _make(root, plan)
        group = _check(name, root, plan, chunk_given)
        handle = _lock(name, root)
        store = _opened(root, group, plan.with_chunk(next(iter(_outputs(group, plan))).chunks))
    except OSError as error:
        if handle is not None:
            os.close(handle)
        raise ParameterError(name, str(root), f"a place that can be written ({error.strerror or error})") from None
    try:
        yield store
    finally:
        os.close(handle)


def _kind(name: str) -> tuple[type[np.generic], Any]:
    """Type of a figure, and what stands where it is missing."""
    return {"status": (np.uint8, _ABSENT), **dict.fromkeys(FLAGS, (np.bool_, False))}.get(name, (np.float64, np.nan))


def _in_memory(plan: Plan) -> Store:
    """Plain arrays: Zarr's would be written by a thread of its own, which may end as memory does."""
    arrays = {}
    for name in (*plan.settings.outputs, "status"):
        kind, absent = _kind(name)
        arrays[name] = np.full(plan.grid.shape, absent, kind)
    return Store(plan, None, arrays, np.ones(plan.chunks, np.bool_), 0)


def _dataset(plan: Plan, arrays: Mapping[str, Any]) -> xr.Dataset:
    """What a store of these arrays would be read as."""
    along = {name: ((axis.name,), values) for axis in plan.grid.axes for name, values in axis.values.items()}
    dimensions = tuple(axis.name for axis in plan.grid.axes)
    every = {**along, **{name: (dimensions, values) for name, values in arrays.items()}}
    variables = {name: (dims, values, plan.about(name)) for name, (dims, values) in every.items()}
    found: xr.Dataset = xr.decode_cf(xr.Dataset(variables, attrs=json.loads(json.dumps(plan.attributes()))))
    return found.drop_encoding()


def _make(root: Path, plan: Plan) -> None:
    """A new store, which appears when all of its metadata are there."""
    beside = root.with_name(f".{root.name[:100]}.new")
    shutil.rmtree(beside, ignore_errors=True)  # of a process that was killed
    try:
        _create(LocalStore(beside), plan)
        beside.rename(root)
    except BaseException:
        shutil.rmtree(beside, ignore_errors=True)
        raise


def _create(store: LocalStore, plan: Plan) -> zarr.Group:
    group = zarr.create_group(store, zarr_format=3, attributes=plan.attributes())
    dimensions = [axis.name for axis in plan.grid.axes]
    codecs = [ZstdCodec(level=1), Crc32cCodec()]
    for axis in plan.grid.axes:
        for name, values in axis.values.items():
            group.create_array(
                name,
                data=values,
                chunks=(axis.size,),
                compressors=codecs,
                fill_value=np.nan,
                dimension_names=[axis.name],
                attributes=plan.about(name),
            )
    for name in (*plan.settings.outputs, "status"):
        kind, absent = _kind(name)
        group.create_array(
            name,
            shape=plan.grid.shape,
            chunks=plan.chunk,
            dtype=kind,
            fill_value=absent,
            compressors=codecs,
            dimension_names=dimensions,
            attributes=plan.about(name),
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its form is not settled, but xarray looks for it
        zarr.consolidate_metadata(store)
    return group


def _outputs(group: zarr.Group, plan: Plan) -> Iterator[zarr.Array[Any]]:
    for name in (*plan.settings.outputs, "status"):
        array = group[name]
        assert isinstance(array, zarr.Array)
        yield array.with_config({"write_empty_chunks": True})  # so that a chunk of NaN is not an absent one


def _opened(root: Path, group: zarr.Group, plan: Plan) -> Store:
    arrays = dict(zip((*plan.settings.outputs, "status"), _outputs(group, plan), strict=True))
    missing = np.ones(plan.chunks, np.bool_)
    damaged = 0
    for rest in root.rglob("*.partial"):  # of a write that was cut off
        rest.unlink()
    for index in np.ndindex(plan.chunks):
        files = [root.joinpath(name, "c", *map(str, index)) for name in arrays]
        if all(file.exists() for file in files):
            missing[index] = not all(_intact(file) for file in files)
            damaged += bool(missing[index])
    return Store(plan, root, arrays, missing, damaged)


def _intact(file: Path) -> bool:
    """Whether a chunk's bytes are those that were written: its last four are the CRC-32C of the others."""
    content = file.read_bytes()
    return int.from_bytes(content[-4:], "little") == google_crc32c.value(content[:-4]) and len(content) > 4


def _lock(name: str, root: Path) -> int:
    """Hold the store until the handle is closed or this process ends, however it ends."""
    try:
        import fcntl
    except ImportError:  # Windows
        raise ParameterError(name, str(root), "a file that is no store, on a system that cannot lock one") from None
    handle = os.open(root / "zarr.json", os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        raise ParameterError(name, str(root), "a store that no other process is writing") from None
    return handle


def _check(name: str, root: Path, plan: Plan, chunk_given: bool) -> zarr.Group:
    """The store's group, if it is one of this very plan."""
    foreign = ParameterError(name, str(root), "a new name, or a store that trum-sym sweep has begun")
    try:
        group = zarr.open_group(LocalStore(root), mode="r+", zarr_format=3)
        theirs = dict(group.attrs)
        assert "kernels_sha256" in theirs
    except (OSError, ValueError, KeyError, AssertionError) as error:
        if isinstance(error, PermissionError):
            raise
        raise foreign from None
    ours = json.loads(json.dumps(plan.attributes()))
    for key in sorted({*ours, *theirs}, key=lambda key: key == "title"):  # which sums up the others
        if ours.get(key) != theirs.get(key):
            raise _differs(name, root, key, theirs.get(key), ours.get(key))
    for axis in plan.grid.axes:
        for parameter, values in axis.values.items():
            stored = np.asarray(group[parameter])
            if not np.array_equal(stored, values):
                raise _differs(name, root, parameter, stored, values)
    array = group["status"]
    assert isinstance(array, zarr.Array)
    if chunk_given and array.chunks != plan.chunk:
        raise _differs(name, root, "chunk", array.chunks, plan.chunk)
    return group


def _differs(name: str, root: Path, key: str, theirs: object, ours: object) -> ParameterError:
    def shown(value: object) -> str:
        if value is None:
            return "none"
        text = " ".join(str(value).split())
        return text if len(text) <= 40 else text[:37] + "..."

    why = f"; {_BUILD[key]}, and one store does not mix the bits of two" if key in _BUILD else ""
    return ParameterError(
        name,
        str(root),
        f"another name, or the sweep that this store is of: its {key} is {shown(theirs)}, not {shown(ours)}{why}",
    )
