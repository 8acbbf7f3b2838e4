"""Where chunks are computed: on the cores of this process, or by a Dask cluster's workers."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from queue import Empty, SimpleQueue
from typing import Any, Protocol

from trum_sym.errors import MissingExtraError, ParameterError, UnfinishedError
from trum_sym.sweeps.task import Found, Task, compute

__all__ = ["Cluster", "Here", "Pool", "compute_all", "cores"]

_TICK = 0.5  # s
_LOOK = 2.0  # s
_AHEAD = 2  # chunks per thread of a worker: one to compute, one waiting
_CONNECT = 10  # s, until a scheduler counts as unreachable
_WORKERS = 30  # s, until one without workers does
_DEATHS = 3  # of workers over one chunk, each counted by the scheduler's own limit


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Pool(Protocol):
    """What runs chunks."""

    def threads(self) -> int:
        """How many chunks are computed at a time."""

    def submit(self, task: Task) -> Any:  # noqa: ANN401
        """A future of :func:`compute`."""

    def result(self, future: Any) -> Found | None:  # noqa: ANN401
        """What a future that is done has found; None if the chunk is to be submitted again."""

    def close(self) -> None:
        """Give up what is under way."""


class Here:
    """The cores of this process."""

    def __init__(self) -> None:
        self._stop = threading.Event()
        self._pool = ThreadPoolExecutor(cores(), "sweep")

    def threads(self) -> int:
        """How many chunks are computed at a time."""
        return cores()

    def submit(self, task: Task) -> Any:  # noqa: ANN401
        """A future of :func:`compute`."""
        return self._pool.submit(compute, task, self._stop.is_set)

    def result(self, future: Any) -> Found | None:  # noqa: ANN401
        """What a future that is done has found."""
        found: Found = future.result()
        return found

    def close(self) -> None:
        """Give up what is under way, within a block of points."""
        self._stop.set()
        self._pool.shutdown(cancel_futures=True)


class Cluster:
    """The workers of a Dask scheduler.

    Raises
    ------
    ParameterError
        If there is no scheduler at the address, or none of its workers comes.
    MissingExtraError
        Without distributed.
    """

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            raise MissingExtraError("--scheduler", str(error.name), "sweep") from None
        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what is lost is said in our own words
        self._address = address
        try:
            self._client: Any = Client(address, timeout=_CONNECT, set_as_default=False)  # type: ignore[no-untyped-call]
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            reason = str(error).partition("\n")[0] or type(error).__name__
            raise ParameterError("scheduler", address, f"the address of a Dask scheduler ({reason})") from None
        try:
            self._client.wait_for_workers(1, timeout=_WORKERS)
        except TimeoutError:
            self.close()
            raise ParameterError("scheduler", address, f"a scheduler with workers; none within {_WORKERS} s") from None
        self._deaths: dict[tuple[int, ...], int] = {}
        self._tasks: dict[Any, Task] = {}

    def threads(self) -> int:
        """Threads of all workers that are there now."""
        try:
            return sum(self._client.nthreads().values())
        except (OSError, CancelledError, RuntimeError):
            raise self._lost() from None

    def submit(self, task: Task) -> Any:  # noqa: ANN401
        """A future of :func:`compute`."""
        try:
            future = self._client.submit(compute, task, pure=False)
        except (OSError, CancelledError):
            raise self._lost() from None
        self._tasks[future.key] = task
        return future

    def result(self, future: Any) -> Found | None:  # noqa: ANN401
        """What a future that is done has found; None if its workers died."""
        from distributed import KilledWorker

        task = self._tasks.pop(future.key)
        try:
            found: Found = future.result()
        except KilledWorker:
            self._deaths[task.index] = self._deaths.get(task.index, 0) + 1
            if self._deaths[task.index] > _DEATHS:
                raise UnfinishedError(f"workers die of chunk {task.index}: see their logs") from None
            return None
        except (OSError, CancelledError):  # the connection breaks, or was seen to have broken
            raise self._lost() from None
        except ImportError as error:
            raise ParameterError("scheduler", self._address, f"workers with this trum-sym ({error})") from None
        finally:
            future.release()  # or the scheduler has it computed again if its worker dies now
        return found

    def _lost(self) -> UnfinishedError:
        return UnfinishedError(f"the scheduler at {self._address} is gone")

    def close(self) -> None:
        """Give up what is under way."""
        self._client.close(timeout=2)


def compute_all(tasks: Iterator[Task], pool: Pool, tick: Callable[[], None]) -> Iterator[tuple[Task, Found]]:
    """Tasks with what was found, as they are done; only as many are under way as the pool can take.

    ``tick`` is called at least every half second.
    """
    done: SimpleQueue[Any] = SimpleQueue()
    running: dict[Any, Task] = {}
    room, look = 1, 0.0

    def start(task: Task) -> None:
        future = pool.submit(task)
        running[future] = task
        future.add_done_callback(done.put)

    while True:
        if time.monotonic() >= look:  # workers come and go
            room, look = max(1, _AHEAD * pool.threads()), time.monotonic() + _LOOK
        while len(running) < room and (task := next(tasks, None)) is not None:
            start(task)
        if not running:
            return
        tick()
        try:
            future = done.get(timeout=_TICK)
        except Empty:
            continue
        task = running.pop(future)
        found = pool.result(future)
        del future
        if found is None:
            start(task)
        else:
            yield task, found
