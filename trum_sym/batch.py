"""Kernels over many points: blocks on all cores, with progress, open to interruption between blocks."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping

import numpy as np

from trum_sym.kernels import call, signature
from trum_sym.validate import Array, ArrayLike

__all__ = ["call_in_blocks"]

_BLOCK, _SMALLEST = 512, 32  # points in a block, at most and at least


def call_in_blocks(kernel: str, values: Mapping[str, ArrayLike], label: str | None = None) -> dict[str, Array]:
    """Evaluate a kernel as :func:`trum_sym.kernels.call` does, block by block on all cores.

    Parameters
    ----------
    kernel : str
        A kernel of scalars.
    values : mapping
        At least the kernel's arguments; arrays broadcast.
    label : str, optional
        Shows a bar of this name on the standard error, if there is more than one block.
    """
    inputs, outputs = signature(kernel)
    columns = np.broadcast_arrays(*(np.asarray(values[name], np.float64) for name in inputs))
    shape, size = columns[0].shape, columns[0].size
    # what is the same for all points is not laid out for each
    flat = [column.reshape(-1)[:1] if not any(column.strides) else column.ravel() for column in columns]
    results = np.empty((len(outputs), size))
    cores = os.cpu_count() or 1
    length = min(_BLOCK, max(_SMALLEST, -(-size // cores)))
    starts = range(0, size, length)
    workers = min(len(starts), cores)

    def run(begin: int) -> None:
        block = {
            name: column if column.size == 1 else column[begin : begin + length]
            for name, column in zip(inputs, flat, strict=True)
        }
        found = call(kernel, block)
        for row, name in zip(results, outputs, strict=True):
            row[begin : begin + length] = found[name]

    if workers > 1 or (label and len(starts) > 1):
        _in_threads(run, starts, workers, label)
    else:
        for begin in starts:
            run(begin)
    return {name: row.reshape(shape) for name, row in zip(outputs, results, strict=True)}


def _in_threads(run: Callable[[int], None], starts: range, workers: int, label: str | None) -> None:
    from concurrent.futures import ThreadPoolExecutor, as_completed  # not waited for by a single point

    with ThreadPoolExecutor(workers) as pool:
        try:
            tasks = [pool.submit(run, begin) for begin in starts]
            if label:
                import click

                with click.progressbar(length=len(tasks), label=label, file=sys.stderr, update_min_steps=1) as bar:
                    for task in as_completed(tasks):
                        task.result()
                        bar.update(1)
            else:
                for task in tasks:
                    task.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # what has begun ends by itself, within a block
            raise
