"""A small sweep, as a process of its own that can be killed.

    python tests/sweeps/sweep_process.py STORE LOG [SCHEDULER]

SWEEP_PAUSE seconds before each chunk leave time to kill it.
"""

from __future__ import annotations

import hashlib
import os
import sys
import time
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym.sweeps import engine, task

RANGES = {"prepressure": np.linspace(150, 210, 24), "friction_coefficient": np.linspace(0.1, 0.3, 8)}
SETTINGS = {"outputs": ("q_average", "mean_speed"), "chunk": 4, **RANGES}
DRIVE = ts.Drive(periods=4, on_periods=3, load_torque=0.1)
CHUNKS = 48


def traced(chunk, *stopped):
    """Compute a chunk, and log that it was begun; LOG comes by the environment, so that workers know it too."""
    handle = os.open(os.environ["SWEEP_LOG"], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    os.write(handle, (",".join(map(str, chunk.index)) + "\n").encode())
    os.close(handle)
    time.sleep(float(os.environ.get("SWEEP_PAUSE", "0")))
    return task.compute(chunk, *stopped)


def sweep(out, log, scheduler=None, **changes):
    """The sweep, every chunk of it logged."""
    os.environ["SWEEP_LOG"] = str(log)
    engine.compute = traced
    try:
        return ts.sweep(ts.load_motor(), DRIVE, out=out, scheduler=scheduler, **{**SETTINGS, **changes})
    finally:
        engine.compute = task.compute


def logged(log):
    """The chunks that were begun."""
    path = Path(log)
    return [tuple(map(int, line.split(","))) for line in path.read_text().split()] if path.exists() else []


def finished(out):
    """The chunks all of whose files are there."""
    names = [*SETTINGS["outputs"], "status"]
    found = [
        {(int(file.parent.name), int(file.name)) for file in out.glob(f"{name}/c/*/*") if file.name.isdecimal()}
        for name in names
        if (out / name / "c").is_dir()
    ]
    return set.intersection(*found) if len(found) == len(names) else set()


def hashes(out):
    """Of every file of a store."""
    return {
        str(file.relative_to(out)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(out.rglob("*"))
        if file.is_file()
    }


if __name__ == "__main__":
    if hasattr(os, "sched_setaffinity"):  # not done before it is killed
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])
    sweep(*sys.argv[1:])
