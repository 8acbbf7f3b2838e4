"""Kernels over many points: blocks on all cores, with progress, open to interruption between blocks."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.kernels import call, signature
from trum_sym.output.progress import shown

__all__ = ["StoppedError", "call_in_blocks", "one_thread", "over_points"]

_BLOCK, _SMALLEST = 512, 8  # points in a block, at most and at least: what a register has lanes for
_stopped: ContextVar[Callable[[], bool] | None] = ContextVar("_stopped", default=None)


class StoppedError(Exception):
    """The work of this thread is no longer wanted."""


@contextmanager
def one_thread(stopped: Callable[[], bool]) -> Iterator[None]:
    """Keep :func:`call_in_blocks` on the calling thread, for callers that share the cores out themselves.

    Parameters
    ----------
    stopped : callable
        Asked before every block; where it says yes, StoppedError is raised.
    """
    token = _stopped.set(stopped)
    try:
        yield
    finally:
        _stopped.reset(token)


def call_in_blocks(
    kernel: str,
    values: Mapping[str, ArrayLike],
    label: str | None = None,
    *,
    inner: Mapping[str, tuple[int, ...]] | None = None,
    smallest: int = _SMALLEST,
) -> dict[str, Array]:
    """Evaluate a kernel as :func:`trum_sym.model.kernels.call` does, block by block on all cores.

    Parameters
    ----------
    kernel : str
        A kernel of scalars; its outputs may have inner dimensions.
    values : mapping
        At least the kernel's arguments; arrays broadcast.
    label : str, optional
        Shows a bar of this name on the standard error, if there is more than one block.
    inner : mapping, optional
        The outputs that have inner dimensions, and these.
    smallest : int
        Points that are not worth sharing out.
    """
    inputs, outputs = signature(kernel)
    columns = np.broadcast_arrays(*(np.asarray(values[name], np.float64) for name in inputs))
    shape, size = columns[0].shape, columns[0].size
    # what is the same for all points is not laid out for each
    flat = [column.reshape(-1)[:1] if not any(column.strides) else column.ravel() for column in columns]
    results = {name: np.empty((size, *(inner or {}).get(name, ()))) for name in outputs}
    cores = os.cpu_count() or 1
    length = min(_BLOCK, max(smallest, -(-size // cores)))
    starts = range(0, size, length)
    workers = min(len(starts), cores)

    def run(begin: int) -> None:
        block = {
            name: column if column.size == 1 else column[begin : begin + length]
            for name, column in zip(inputs, flat, strict=True)
        }
        found = call(kernel, block)
        for name, result in results.items():
            result[begin : begin + length] = found[name]

    def whole() -> dict[str, Array]:
        return {name: result.reshape((*shape, *result.shape[1:])) for name, result in results.items()}

    stopped = _stopped.get()
    if stopped is not None:
        for begin in starts:
            if stopped():
                raise StoppedError
            run(begin)
        return whole()
    if workers > 1 or (label and len(starts) > 1):
        _in_threads(run, starts, workers, label)
    else:
        for begin in starts:
            run(begin)
    return whole()


def over_points(run: Callable[[int], None], count: int, label: str | None = None) -> None:
    """Work of some milliseconds a point, point by point on all cores, or on the calling thread as :func:`one_thread`
    asks; ``label`` as for :func:`call_in_blocks`.
    """
    stopped, workers = _stopped.get(), min(count, os.cpu_count() or 1)
    if stopped is None and workers > 1:
        _in_threads(run, range(count), workers, label)
        return
    for point in range(count):
        if stopped is not None and stopped():
            raise StoppedError
        run(point)


def _in_threads(run: Callable[[int], None], starts: range, workers: int, label: str | None) -> None:
    from concurrent.futures import ThreadPoolExecutor, as_completed  # not waited for by a single point

    with ThreadPoolExecutor(workers) as pool:
        try:
            tasks = [pool.submit(run, begin) for begin in starts]
            for task in shown(as_completed(tasks), label, len(tasks)):
                task.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # what has begun ends by itself, within a block
            raise
