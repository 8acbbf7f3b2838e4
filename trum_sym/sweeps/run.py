"""Sweeps: from settings and ranges to a labelled data set, on disk or in memory."""

from __future__ import annotations

import math
import os
import stat
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError, UnfinishedError
from trum_sym.inputs.checks import ArrayLike
from trum_sym.inputs.choices import path_of
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import period_of
from trum_sym.model.levels import LEVEL_NAMES, Levels, Method
from trum_sym.output.progress import Progress
from trum_sym.sweeps.engine import Cluster, Here, Pool, compute_all
from trum_sym.sweeps.plan import Plan, make_plan

if TYPE_CHECKING:
    import xarray as xr

    from trum_sym.sweeps.store import Store

__all__ = ["Summary", "Workload", "check_out", "estimate", "run", "sweep"]

_SMALL = 2**30  # bytes of a result that is held in memory
_SAMPLE_SECONDS = 2.0
_SAMPLE_POINTS, _COUPLED_SAMPLE = 64, 4  # a thread, at first; with coupling


@dataclass(frozen=True)
class Summary:
    """What a run did.

    Attributes
    ----------
    points, computed, failed : int
        Of the grid; those of this run; those of them without a figure that settled.
    damaged : int
        Chunks that were not as they had been written, and were computed again.
    refusal : str or None
        Why the first refused point of this run was refused.
    """

    points: int
    computed: int
    failed: int
    damaged: int
    refusal: str | None


@dataclass(frozen=True)
class Workload:
    """What a sweep would take: seconds for what is missing, at ``rate`` points a second on ``threads`` threads."""

    plan: Plan
    missing_points: int
    missing_chunks: int
    sample: int
    rate: float
    threads: int

    @property
    def seconds(self) -> float:
        """For what is missing."""
        return self.missing_points / self.rate


def sweep(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    outputs: Sequence[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    scheduler: str | None = None,
    chunk: int | None = None,
    progress: bool = False,
    sampling_period: ArrayLike | None = None,
    tolerance: float = 1e-6,
    method: Method = "auto",
    **ranges: object,
) -> xr.Dataset:
    """Operating points on a grid of parameters.

    Parameters
    ----------
    motor, drive, tolerance, method
        As for :func:`trum_sym.evaluate`, single numbers.  Where a grid of equal steps may be used, ``on_grid`` is among
        the outputs.
    outputs : names of figures, optional
        All of them if not given; what none of them needs is not computed.
    out : path, optional
        A Zarr store (``.zarr``), filled chunk by chunk: the same call again goes on with one that was left unfinished.
        Or a file for a small result: ``.nc``, ``.parquet``, ``.csv``.  In memory if not given.
    scheduler : str, optional
        Address of a Dask scheduler whose workers compute; this process and all its cores if not given.
    chunk : int, optional
        Points a chunk at most; by the size of the grid, its figures and this machine's memory if not given.
    progress : bool
        Whether to tell the standard error how far it is.
    sampling_period : float or range, s, optional
        As for ``evaluate``.
    **ranges
        Levels of the model by name, as words (see :class:`trum_sym.model.levels.Levels`).  Any number of the drive or
        value of the motor by name: a sequence, or text such as ``"160:210:51"``, ``"160:210:by=1"``, ``"160,180"`` or
        ``"@FILE.csv"``.  Each is an axis; xarray.DataArrays of one dimension, and
        columns of one file, vary together.  A single number is set.

    Returns
    -------
    xarray.Dataset
        The outputs and ``status`` (0 done, 1 no speed balances the load, 2 not converged, 3 refused) over the swept
        parameters, with units and meanings in ``attrs``, those of the set being every setting; read from the store as
        it is used, if there is one.  Where a combination is refused, or no speed balances the load, figures are NaN and
        ``status`` says why.

    Raises
    ------
    ParameterError
        For bad input, a scheduler that cannot be reached, a store that is not of this sweep.
    UnfinishedError
        If the disk is full or the scheduler is lost; the same call goes on.
    MissingExtraError
        Without xarray and zarr.

    Notes
    -----
    Stores, clusters and what it costs: docs/sweep.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> grid = ts.sweep(prepressure="160:210:3", friction_coefficient=[0.2, 0.25], outputs=("q_average", "amplitude"))
    >>> dict(grid.sizes), grid.q_average.attrs["units"]
    ({'prepressure': 3, 'friction_coefficient': 2}, '1/s')
    """
    level_names = [name for name in LEVEL_NAMES if name != "amplitude" or isinstance(ranges.get(name), str)]
    levels = Levels(**{name: ranges.pop(name) for name in level_names if name in ranges})  # type: ignore[arg-type]
    if isinstance(sampling_period, str) or isinstance(period_of(sampling_period), np.ndarray):
        ranges, sampling_period = {**ranges, "sampling_period": sampling_period}, None
    target = None if out is None else path_of("out", out)
    check_out("out", target)
    plan = make_plan(
        load_motor() if motor is None else motor,
        drive,
        levels,
        sampling_period,
        tolerance,
        outputs,
        chunk,
        ranges,
        method,
    )
    return run("out", plan, target, scheduler, chunk is not None, sys.stderr if progress else None)[0]


def check_out(name: str, target: Path | None) -> None:
    """Refuse, before any work is done, a name of a result that none can be written to.

    Raises
    ------
    ParameterError, MissingExtraError
    """
    from trum_sym.output.files import SUFFIXES, check_packages, check_target, found

    if target is None:
        return
    if target.suffix not in (".zarr", *SUFFIXES):
        raise ParameterError(
            name, str(target), f"a name that ends in .zarr, {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        )
    if target.suffix != ".zarr":
        check_target(name, target)
        check_packages(target)
        return
    there = found(name, target)
    if there is not None and not stat.S_ISDIR(there.st_mode):
        raise ParameterError(name, str(target), "a store; this is a file")
    if not os.access(target.absolute().parent if there is None else target, os.W_OK | os.X_OK):
        raise ParameterError(name, str(target), "a store in a folder that exists and can be written to")


def run(
    name: str, plan: Plan, target: Path | None, scheduler: str | None, chunk_given: bool, stream: TextIO | None
) -> tuple[xr.Dataset, Summary]:
    """Compute what is missing of a plan.

    Parameters
    ----------
    name : str
        Of the parameter that says where the result goes.
    plan : Plan
        From :func:`trum_sym.sweeps.plan.make_plan`.
    target : Path, optional
        Checked by :func:`check_out`; in memory if not given.
    scheduler : str, optional
        As for :func:`sweep`.
    chunk_given : bool
        Whether the plan's chunks are the user's wish.
    stream : text file, optional
        Where to tell how far it is.

    Raises
    ------
    ParameterError, UnfinishedError, MissingExtraError
        As :func:`sweep`.
    """
    on_disk = target is not None and target.suffix == ".zarr"
    if not on_disk and plan.size_bytes > _SMALL:
        size = f"{plan.size_bytes / 2**30:.3g} GiB for {plan.grid.size} points"
        raise ParameterError(name, size, "a store, NAME.zarr, for more than 1 GiB")
    with _pool(scheduler) as pool, _open(name, target if on_disk else None, plan, chunk_given) as store:
        summary = _fill(store, pool, stream)
    dataset = store.dataset()
    if target is not None and not on_disk:
        from trum_sym.output.files import write

        write(name, dataset, target)
    return dataset, summary


def _open(name: str, root: Path | None, plan: Plan, chunk_given: bool) -> AbstractContextManager[Store]:
    try:
        from trum_sym.sweeps.store import open_store
    except ImportError as error:
        raise MissingExtraError("sweep", str(error.name), "sweep") from None
    return open_store(name, root, plan, chunk_given)


@contextmanager
def _pool(scheduler: str | None) -> Iterator[Pool]:
    pool: Pool = Here() if scheduler is None else Cluster(scheduler)
    try:
        yield pool
    finally:
        pool.close()


def _fill(store: Store, pool: Pool, stream: TextIO | None) -> Summary:
    plan = store.plan
    missing = np.argwhere(store.missing)
    points = sum(int(np.prod(plan.task(tuple(index)).shape)) for index in missing)
    progress = Progress(plan.grid.size, plan.grid.size - points, stream)
    refusal: str | None = None
    tasks = (plan.task(tuple(int(i) for i in index)) for index in missing)
    try:
        for task, found in compute_all(tasks, pool, progress.tick):
            store.write(task.index, found.figures)
            failed = int(np.count_nonzero(found.figures["status"]))
            progress.add(found.figures["status"].size, failed)
            refusal = refusal or found.refusal
    except OSError as error:
        raise UnfinishedError(_unfinished(progress, f"{store.root}: {error.strerror or error}")) from None
    except UnfinishedError as error:
        raise UnfinishedError(_unfinished(progress, str(error))) from None
    finally:
        progress.close()
    return Summary(plan.grid.size, points, progress.failed, store.damaged, refusal)


def _unfinished(progress: Progress, reason: str) -> str:
    return (
        f"{reason}; {progress.done} of {progress.total} points are done, and the same command goes on with the others"
    )


def estimate(name: str, plan: Plan, target: Path | None, scheduler: str | None, chunk_given: bool) -> Workload:
    """Measure a sample of a plan's points, and say what the rest would take; writes nothing.

    Raises
    ------
    ParameterError, UnfinishedError, MissingExtraError
        As :func:`sweep`.
    """
    missing = np.ones(plan.chunks, np.bool_)
    if target is not None and target.suffix == ".zarr" and target.exists() and any(target.iterdir()):
        with _open(name, target, plan, chunk_given) as store:
            plan, missing = store.plan, store.missing
    left = sum(int(np.prod(plan.task(tuple(index)).shape)) for index in np.argwhere(missing))
    with _pool(scheduler) as pool:
        threads = max(1, pool.threads())
        count, seconds = _COUPLED_SAMPLE if plan.settings.coupled else _SAMPLE_POINTS, 0.0
        while True:
            tasks = [plan.sample(count, shift) for shift in range(threads)]
            begin = time.perf_counter()
            for _ in compute_all(iter(tasks), pool, lambda: None):
                pass
            seconds = time.perf_counter() - begin
            if seconds >= _SAMPLE_SECONDS / 2 or count >= min(plan.grid.size, math.prod(plan.chunk)):
                break
            count = int(count * min(8.0, max(2.0, _SAMPLE_SECONDS / max(seconds, 1e-3))))
    sample = threads * min(count, plan.grid.size)
    return Workload(plan, left, int(missing.sum()), sample, sample / seconds, threads)
