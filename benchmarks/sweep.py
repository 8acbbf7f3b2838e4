"""A sweep into a Zarr store: overhead over the bare kernel, peak memory, Dask's processor time, what 10^8 cost."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np

from benchmarks.rows import Row

__all__ = ["rows"]

SECTION = "a sweep into a store"
_IDLE = 4.0  # s, over which a cluster that does nothing is looked at
# Each in a process of its own: its peak memory is its own, and imports are no part of its time
DRIVER = """
import json, resource, sys, time
from dataclasses import replace
import numpy as np
import trum_sym as ts
from trum_sym.model import rotor
from trum_sym.model.operating_point import results, prepare
from trum_sym.model.levels import Levels
TOLERANCE = 1e-3  # of the bare kernel and of the sweep
what, points, outputs, out, scheduler = sys.argv[1:]
side = max(2, round((int(points) / 10) ** 0.5))
ranges = {"prepressure": np.linspace(120, 220, side), "frequency_difference": np.linspace(1000, 5000, side),
          "switching_phase": np.linspace(0, 0.9, 10)}  # every figure depends on all three
motor, drive = ts.load_motor("trum60"), ts.Drive(load_torque=0.05)
outputs = tuple(outputs.split(","))
def mesh():
    return {n: v.reshape([-1 if i == j else 1 for j in range(3)]) for i, (n, v) in enumerate(ranges.items())}
def bare():  # only what these points cost: kernels on all cores, no grid, no chunks, no store
    levels = Levels()
    results(prepare(motor, replace(drive, **mesh()), levels, TOLERANCE), outputs)
def sweep(where):
    chosen = {"outputs": outputs, "out": where, "scheduler": scheduler or None, "tolerance": TOLERANCE}
    return ts.sweep(motor, drive, **chosen, **ranges)
def most():
    if sys.platform == "linux":
        return 1024 * int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
ts.sweep(motor, outputs=outputs, prepressure=[150.0, 180.0])  # imports, first calls
begin, cpu = time.perf_counter(), time.process_time()
if what == "bare":
    bare()
else:
    sweep(out)
print(json.dumps([time.perf_counter() - begin, time.process_time() - cpu, most(), side * side * 10]))
"""


def _run(what: str, points: int, outputs: str, folder: Path, scheduler: str = "") -> list[float]:
    """Wall and processor seconds, peak bytes, points."""
    out = folder / "map.zarr"
    shutil.rmtree(out, ignore_errors=True)
    command = [sys.executable, "-c", DRIVER, what, str(points), outputs, str(out), scheduler]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found: list[float] = json.loads(done.stdout)
    if what == "sweep":
        size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
        found.append(size)
    return found


@contextmanager
def _process(command: list[str], log: Path) -> Iterator[int]:
    with log.open("wb") as output:
        process = subprocess.Popen([sys.executable, "-m", *command], stdout=output, stderr=output)
    try:
        yield process.pid
    finally:
        process.terminate()
        process.wait()


@contextmanager
def _cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[int]]]:
    """A Dask scheduler on the loopback with workers of one thread each; yields its address and all processes."""
    from distributed import Client

    with ExitStack() as stack:
        log = folder / "scheduler.log"
        quiet = ["--no-dashboard", "--host", "127.0.0.1"]
        processes = [stack.enter_context(_process(["distributed.cli.dask_scheduler", "--port", "0", *quiet], log))]
        while not (found := re.search(r"Scheduler at:\s+(tcp://\S+)", log.read_text())):
            time.sleep(0.05)
        command = ["distributed.cli.dask_worker", found[1], "--nthreads", "1", "--no-nanny"]
        command += ["--local-directory", str(folder)]
        for i in range(workers):
            processes.append(stack.enter_context(_process([*command, *quiet], folder / f"worker{i}.log")))
        with Client(found[1], set_as_default=False) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(workers, timeout=120)  # type: ignore[no-untyped-call]
            client.run(lambda: __import__("trum_sym").evaluate() and None)  # imports, first calls
        yield found[1], processes


def _used(processes: list[int]) -> float:
    """Processor seconds of processes so far, as Linux counts them."""
    ticks = 0
    for number in processes:
        fields = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def _compared(name: str, points: int, outputs: str, repeats: int, folder: Path) -> Iterator[Row]:
    """The bare kernel and the sweep in turn."""
    bare = [_run("bare", points, outputs, folder)]
    swept = [_run("sweep", points, outputs, folder)]
    for _ in range(repeats - 1):
        bare.append(_run("bare", points, outputs, folder))
        swept.append(_run("sweep", points, outputs, folder))
    seconds, cpu = (np.median([run[i] for run in bare]) for i in (0, 1))
    wall, processor = (np.median([run[i] for run in swept]) for i in (0, 1))
    count, peak, size = int(swept[-1][3]), max(run[2] for run in swept), swept[-1][4]
    spread = [float(np.ptp([run[0] for run in runs]) / np.median([run[0] for run in runs])) for runs in (bare, swept)]
    yield Row(SECTION, f"{name}, {count} points, bare kernel", float(seconds), "s", spread[0], 1.0)
    note = f"{100 * (processor / cpu - 1):+.1f} % processor time; peak {peak / 2**20:.0f} MiB; "
    note += f"{size / count:.3g} bytes a point; 10^8 points: {1e8 * wall / count / 3600:.3g} h, "
    note += f"{1e8 * size / count / 2**30:.3g} GiB"
    yield Row(SECTION, f"{name}, {count} points, sweep", float(wall), "s", spread[1], float(wall / seconds), note)


def rows(repeats: int, points: int) -> list[Row]:
    """Ratios are to the bare kernel; with Dask of the processor time of all processes.

    ``points`` are those of the sums over a cycle; a twentieth of them is computed with the rotor's orbit.
    """
    found: list[Row] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        found += _compared("q_average", points, "q_average", repeats, folder)
        found += _compared("mean_speed", max(40, points // 20), "mean_speed", repeats, folder)
        found += _over_dask(max(40, points // 20), repeats, folder)
    return found


def _over_dask(points: int, repeats: int, folder: Path) -> Iterator[Row]:
    """What scheduler, workers and the process that writes use, over what the bare kernel does."""
    bare = min(_run("bare", points, "mean_speed", folder)[1] for _ in range(repeats))
    for workers in (1, 4):
        times: list[tuple[float, float]] = []
        with _cluster(folder, workers) as (address, processes):
            before = _used(processes)
            time.sleep(_IDLE)
            idle = (_used(processes) - before) / _IDLE
            for _ in range(repeats):
                before = _used(processes)
                wall, own = _run("sweep", points, "mean_speed", folder, address)[:2]
                times.append((own + _used(processes) - before, wall))
        least, wall = min(times)
        note = (
            f"{100 * (least / bare - 1):+.1f} % over the bare kernel's, in {wall:.0f} s; idle, scheduler and workers "
        )
        note += f"use {idle:.3f} s a second"
        name = f"mean_speed, {points} points, {workers} Dask worker{'s' * (workers > 1)}, all processes"
        yield Row(SECTION, name, least, "s", max(times)[0] / least - 1, least / bare, note)
