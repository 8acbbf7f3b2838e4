"""What is killed is completed: real processes, a real Dask cluster, stores that are equal to the last byte."""

from __future__ import annotations

import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
import sweep_process
from lazily import lazily
from refusals import refusal
from sweep_process import CHUNKS, DRIVE, RANGES, SETTINGS, finished, hashes, logged, sweep

import trum_sym as ts
from trum_sym.console import main

xr = lazily("xarray")

HERE = Path(__file__).parent
ENVIRONMENT = {**os.environ, "SWEEP_PAUSE": "0.02", "PYTHONPATH": os.pathsep.join([str(HERE), str(HERE.parents[1])])}


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    sweep(folder / "map.zarr", folder / "log")
    assert sorted(logged(folder / "log")) == list(np.ndindex(24, 2))
    return hashes(folder / "map.zarr")


@contextmanager
def started(command, log, **environment):
    """A process, with its output in a file; killed in the end with all that it has started."""
    with Path(log).open("ab") as output:
        process = subprocess.Popen(
            command, stdout=output, stderr=output, start_new_session=True, env={**ENVIRONMENT, **environment}
        )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def wait_for(condition, what, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what} within {seconds} s"
        time.sleep(0.005)


@contextmanager
def scheduler(folder):
    """A Dask scheduler on the loopback; yields its address and process."""
    log = folder / "scheduler.log"
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
    with started([*command, "--no-dashboard", "--no-show"], log) as process:
        found = []

        def says_where():
            assert process.poll() is None, log.read_text()
            found[:] = re.findall(r"Scheduler at:\s+(tcp://127.0.0.1:\d+)", log.read_text())
            return found

        wait_for(says_where, "a scheduler")
        yield found[0], process


@contextmanager
def worker(folder, address, name, nanny=False):
    """A Dask worker of one thread."""
    log = folder / f"{name}.log"
    command = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--name", name]
    command += ["--no-dashboard", "--local-directory", str(folder), "--nanny" if nanny else "--no-nanny"]
    with started(command, log, SWEEP_LOG=str(folder / "log")) as process:
        yield process


def of_cluster(address, ask):
    from distributed import Client

    with Client(address, timeout=30, set_as_default=False) as client:
        return ask(client)


def driver(folder, address=None):
    """The sweep as a process."""
    command = [sys.executable, str(HERE / "sweep_process.py"), str(folder / "map.zarr"), str(folder / "log")]
    return started(command if address is None else [*command, address], folder / "driver.log")


def completed(folder, undisturbed, begun_before, done_before, address=None):
    """Complete a store; nothing that was done is done again, and the whole is as it would have been."""
    sweep(folder / "map.zarr", folder / "log", address)
    again = logged(folder / "log")[begun_before:]
    assert not set(again) & done_before
    assert len(again) == CHUNKS - len(done_before)
    assert hashes(folder / "map.zarr") == undisturbed


# --- The driver ------------------------------------------------------------------------------------------------------


def kill_the_driver(folder, undisturbed, when):
    folder.mkdir()
    out = folder / "map.zarr"
    with driver(folder) as process:
        when(process, out)
        process.kill()
        process.wait()
    done = finished(out)
    completed(folder, undisturbed, len(logged(folder / "log")), done)
    return len(done)


def test_a_driver_that_is_killed_is_completed(tmp_path, undisturbed):
    def halfway(process, out):
        wait_for(lambda: len(finished(out)) >= 20 or process.poll() is not None, "20 chunks")
        process.send_signal(signal.SIGSTOP)
        with refusal("out", "a store that no other process is writing"):
            ts.sweep(ts.load_motor(), DRIVE, out=out, **SETTINGS)

    assert 20 <= kill_the_driver(tmp_path / "killed", undisturbed, halfway) < CHUNKS


@pytest.mark.slow
def test_a_driver_that_is_killed_at_any_of_20_moments_is_completed(tmp_path, undisturbed):
    rng = random.Random(20)
    begin = time.monotonic()
    (tmp_path / "whole").mkdir()
    with driver(tmp_path / "whole") as process:
        wait_for((tmp_path / "whole/map.zarr").exists, "a store")
        started_in = time.monotonic() - begin
        assert process.wait() == 0
    done = []
    for i in range(20):

        def at_some_moment(process, out, i=i):
            if i % 4 == 0:  # before there is a store, or while it is made
                time.sleep(rng.uniform(0.5, 1.1) * started_in)
                return
            chunks = rng.randrange(CHUNKS - 3)
            wait_for(lambda: len(finished(out)) >= chunks or process.poll() is not None, f"{chunks} chunks")
            time.sleep(rng.uniform(0, 0.02))

        done.append(kill_the_driver(tmp_path / str(i), undisturbed, at_some_moment))
    assert sum(0 < n < CHUNKS for n in done) > 10, done
    print(f"chunks done when the driver was killed: {sorted(done)}")


@pytest.mark.parametrize("where", ["here", "on a cluster"])
def test_an_interruption_is_one_line_and_leaves_what_is_done(tmp_path, capsys, where):
    out = tmp_path / "map.zarr"
    command = ["sweep", "--prepressure", "150:210:40000", "--outputs", "mean_speed", "--chunk", "20", "--out", str(out)]
    with ExitStack() as cluster:
        there = []
        if where == "on a cluster":
            address, _ = cluster.enter_context(scheduler(tmp_path))
            cluster.enter_context(worker(tmp_path, address, "one"))
            there = ["--scheduler", address]
        interrupted(tmp_path, out, [sys.executable, "-m", "trum_sym", *command, *there])
    assert not list(out.rglob("*.partial"))
    speeds, done = ({file.name for file in (out / name / "c").iterdir()} for name in ("mean_speed", "status"))
    assert done <= speeds
    assert len(speeds - done) <= 1, "the chunk that was being written, which does not count"
    assert main([*command, "--dry-run"]) == 0
    left = 40000 - 20 * len(done)
    assert f"{left} points in {left // 20} chunks are missing" in capsys.readouterr().out


def interrupted(folder, out, command):
    """A sweep that Ctrl-C ends once there are five chunks."""
    with started(command, folder / "said") as process:
        wait_for(lambda: (out / "status/c/4").exists() or process.poll() is not None, "5 chunks")
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 130
    assert (folder / "said").read_text().splitlines()[-1] == "trum-sym: interrupted"


def test_rests_of_a_cut_off_write_are_swept_away(tmp_path, undisturbed):
    out = tmp_path / "map.zarr"
    sweep(out, tmp_path / "log")
    (out / "mean_speed/c/3/1").rename(out / "mean_speed/c/3/1.0123456789abcdef.partial")
    (tmp_path / ".other.zarr.new").mkdir()
    completed(tmp_path, undisturbed, CHUNKS, finished(out))


# --- Disks -----------------------------------------------------------------------------------------------------------


def test_a_disk_quota_is_one_line_and_the_store_is_completed(tmp_path, undisturbed, monkeypatch, capsys):
    from trum_sym.sweeps.store import Store

    out, write, limits = tmp_path / "map.zarr", Store.write, resource.getrlimit(resource.RLIMIT_FSIZE)

    def limited(store, index, figures):
        if len(finished(out)) >= 7:
            resource.setrlimit(resource.RLIMIT_FSIZE, (30, limits[1]))  # the system refuses longer files
        try:
            write(store, index, figures)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)

    monkeypatch.setattr(Store, "write", limited)
    with pytest.raises(ts.UnfinishedError, match="File too large; 28 of 192 points are done, and the same command"):
        sweep(out, tmp_path / "log")
    monkeypatch.undo()
    done = finished(out)
    assert len(done) == 7
    completed(tmp_path, undisturbed, len(logged(tmp_path / "log")), done)
    assert capsys.readouterr().err == ""


@pytest.mark.slow
def test_a_full_disk_is_completed_when_there_is_room(tmp_path, undisturbed):
    script = (
        "set -e; mount -t tmpfs -o size=600k tmpfs disk; "
        "set +e; $PYTHON $PROGRAM disk/map.zarr log 2> first; echo $? > code; df disk >> first; "
        "set -e; mount -o remount,size=100m disk; cp log log.first; cp -a disk/map.zarr copy.zarr; "
        "$PYTHON $PROGRAM disk/map.zarr log; cp -a disk/map.zarr map.zarr; umount disk"
    )
    (tmp_path / "disk").mkdir()
    root = [] if os.geteuid() == 0 else ["--map-root-user"]
    subprocess.run(
        ["unshare", "--mount", *root, "sh", "-c", script],
        cwd=tmp_path,
        check=True,
        timeout=300,
        env={**ENVIRONMENT, "PYTHON": sys.executable, "PROGRAM": str(HERE / "sweep_process.py")},
    )
    assert (tmp_path / "code").read_text() == "1\n"
    assert "No space left on device" in (tmp_path / "first").read_text()
    done, begun = finished(tmp_path / "copy.zarr"), len(logged(tmp_path / "log.first"))
    again = logged(tmp_path / "log")[begun:]
    assert 0 < len(done) < CHUNKS
    assert not set(again) & done
    assert len(again) == CHUNKS - len(done)
    assert hashes(tmp_path / "map.zarr") == undisturbed


def test_a_flipped_byte_is_noticed_and_computed_again(tmp_path, undisturbed):
    out = tmp_path / "map.zarr"
    sweep(out, tmp_path / "log")
    rng = random.Random(1)
    for name in (*SETTINGS["outputs"], "status"):
        file = out / name / f"c/{rng.randrange(24)}/1"
        content = bytearray(file.read_bytes())
        content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)
        file.write_bytes(content)
        with xr.open_zarr(out, chunks=None) as found, pytest.raises(ValueError, match="checksum"):
            found[name].load()
        before = len(logged(tmp_path / "log"))
        sweep(out, tmp_path / "log")
        assert logged(tmp_path / "log")[before:] == [(int(file.parent.name), 1)]
        assert hashes(out) == undisturbed
    (out / "status/c/7/0").write_bytes(b"")  # as a power failure may leave it
    sweep(out, tmp_path / "log")
    assert hashes(out) == undisturbed


# --- Stores that are not ours ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ours")
    sweep(folder / "map.zarr", folder / "log")
    return folder / "map.zarr"


OTHERS = [
    ({"outputs": ("q_average",)}, "its outputs is q_average mean_speed, not q_average"),
    ({"chunk": 8}, "its chunk is (1, 4), not (1, 8)"),
    ({"tolerance": 1e-4}, "its tolerance is 1e-06, not 0.0001"),
    ({"contact": "hertz"}, "its contact is winkler, not hertz"),
    ({"load_torque": 0.2}, "its load_torque is 0.1, not 0.2"),
    ({"contact_radius": 0.026}, "its motor_contact_radius is 0.0265 m (assumed), not 0.026 m (set)"),
    ({"prepressure": np.linspace(150, 209, 24)}, "its prepressure is"),
    ({"load_torque": [0.1, 0.2]}, "its load_torque is 0.1, not none"),
]


@pytest.mark.parametrize(("changes", "difference"), OTHERS, ids=[next(iter(c)) for c, _ in OTHERS])
def test_a_store_of_another_sweep_is_refused_with_the_difference_and_left_alone(store, changes, difference):
    before = hashes(store)
    with refusal("out", "another name", difference):
        ts.sweep(ts.load_motor(), DRIVE, out=store, **{**SETTINGS, **changes})
    assert hashes(store) == before


@pytest.mark.parametrize("name", ["format", "package", "code_sha256", "kernels_sha256", "instruction_set"])
def test_a_store_of_another_kernel_is_refused(store, name, monkeypatch):
    from trum_sym.sweeps import plan, task

    before = hashes(store)
    monkeypatch.setattr(plan, "identity", lambda: {**task.identity(), name: "other"})
    with refusal("out", f"its {name} is", "not other"):
        ts.sweep(ts.load_motor(), DRIVE, out=store, **SETTINGS)
    assert hashes(store) == before


def test_a_store_needs_a_system_that_can_lock_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "fcntl", None)  # as on Windows
    with refusal("out", "no store", "cannot lock"):
        ts.sweep(ts.load_motor(), DRIVE, out=tmp_path / "map.zarr", **SETTINGS)


def test_a_motor_file_of_other_words_is_another_one(store, tmp_path):
    (tmp_path / "motor.toml").write_text(ts.load_motor().text + "\n# measured again\n")
    with refusal("out", "its motor_file"):
        ts.sweep(ts.load_motor(tmp_path / "motor.toml"), DRIVE, out=store, **SETTINGS)


def test_chunks_without_a_figure_are_done_too(tmp_path):
    changes = {"load_torque": 2.0}  # more than friction carries
    found = sweep(tmp_path / "map.zarr", tmp_path / "log", **changes)
    assert np.isnan(found.mean_speed).all()
    sweep(tmp_path / "map.zarr", tmp_path / "log", **changes)
    assert len(logged(tmp_path / "log")) == CHUNKS


def test_a_store_goes_on_in_its_own_chunks_if_none_are_asked_for(store):
    before = hashes(store)
    ts.sweep(ts.load_motor(), DRIVE, out=store, **{**SETTINGS, "chunk": None})
    assert hashes(store) == before


@pytest.mark.parametrize("kind", ["file", "folder", "array", "group", "broken"])
def test_what_is_no_store_of_ours_is_refused_and_left_alone(tmp_path, kind):
    import zarr

    out = tmp_path / "map.zarr"
    if kind == "file":
        out.write_text("mine")
    elif kind == "array":
        zarr.create_array(out, shape=(3,), dtype=float)
    elif kind == "group":
        zarr.create_group(out)
    else:
        out.mkdir()
        (out / ("notes.txt" if kind == "folder" else "zarr.json")).write_text("mine")
    before = hashes(tmp_path)
    with refusal("out: got /", "need a"):
        ts.sweep(ts.load_motor(), DRIVE, out=out, **SETTINGS)
    assert hashes(tmp_path) == before


def test_the_console_goes_on_with_a_store(tmp_path, capsys):
    out = tmp_path / "map.zarr"
    options = ["--prepressure", "150:210:40", "--periods", "4", "--on-periods", "3,5", "--load-torque", "0.1"]
    command = ["sweep", *options, "--outputs", "q_average", "--chunk", "10", "--out", str(out)]
    assert main(command) == 0
    refused = "40 failed, see status (the first refused: on_periods: got 5, need an integer from periods/2 to periods"
    assert capsys.readouterr().out.startswith(f"{out}: 80 points of q_average; {refused}")
    shutil.rmtree(out / "q_average/c/1")
    assert main([*command, "--dry-run"]) == 0
    assert f"10 points in 1 chunks are missing in {out}" in capsys.readouterr().out
    assert main(command) == 0
    assert capsys.readouterr().out.startswith(f"{out}: 80 points of q_average; 10 of them computed now; 5 failed")


# --- A cluster -------------------------------------------------------------------------------------------------------


def test_one_worker_two_workers_and_none_write_the_same_store_and_any_may_die(tmp_path, undisturbed):
    with scheduler(tmp_path) as (address, its_process), worker(tmp_path, address, "first"):
        sweep(tmp_path / "one.zarr", tmp_path / "log", address)
        assert hashes(tmp_path / "one.zarr") == undisturbed
        with worker(tmp_path, address, "second") as second:
            of_cluster(address, lambda client: client.wait_for_workers(2, timeout=60))
            sweep(tmp_path / "two.zarr", tmp_path / "log", address)
            assert hashes(tmp_path / "two.zarr") == undisturbed
            assert kill_beside(tmp_path / "worker", address, second.kill, tmp_path / "log") < CHUNKS
            assert hashes(tmp_path / "worker/map.zarr") == undisturbed
        folder = tmp_path / "scheduler"
        folder.mkdir()
        done = kill_the_scheduler(folder, address, its_process)
    before = len(logged(folder / "log"))
    completed(folder, undisturbed, before, done)


def kill_beside(folder, address, kill, log, chunks=10):
    """Run the sweep on a cluster, and kill a process of it when some chunks are done; says how many were."""
    folder.mkdir()
    out = folder / "map.zarr"
    with driver(folder, address) as process:
        wait_for(lambda: len(finished(out)) >= chunks or process.poll() is not None, f"{chunks} chunks")
        done = finished(out)
        begun = len(logged(log))
        kill()
        assert process.wait(300) == 0, (folder / "driver.log").read_text()
    assert not set(logged(log)[begun:]) & done
    return len(done)


def kill_the_scheduler(folder, address, victim, chunks=10):
    with driver(folder, address) as process:
        wait_for(lambda: len(finished(folder / "map.zarr")) >= chunks or process.poll() is not None, "10 chunks")
        victim.kill()
        assert process.wait(60) == 1
        said = (folder / "driver.log").read_text()
    done = finished(folder / "map.zarr")
    assert chunks <= len(done) < CHUNKS
    assert f"UnfinishedError: the scheduler at {address} is gone; " in said
    return done


@pytest.mark.slow
def test_workers_that_are_killed_at_20_moments_lose_nothing(tmp_path, undisturbed):
    rng = random.Random(7)
    killed = []
    with (
        scheduler(tmp_path) as (address, _),
        worker(tmp_path, address, "one", True),
        worker(tmp_path, address, "two", True),
    ):
        of_cluster(address, lambda client: client.wait_for_workers(2, timeout=120))

        def kill_one():
            pids = of_cluster(address, lambda client: client.run(os.getpid))
            os.kill(rng.choice(list(pids.values())), signal.SIGKILL)

        for i in range(20):
            at = rng.randrange(CHUNKS - 10)
            killed.append(kill_beside(tmp_path / str(i), address, kill_one, tmp_path / "log", at))
            assert hashes(tmp_path / str(i) / "map.zarr") == undisturbed
    print(f"chunks done when a worker was killed: {sorted(killed)}")


@pytest.mark.slow
def test_schedulers_that_are_killed_at_5_moments_leave_what_is_completed(tmp_path, undisturbed):
    rng = random.Random(5)
    for i in range(5):
        folder = tmp_path / str(i)
        folder.mkdir()
        with scheduler(folder) as (address, process), worker(folder, address, "one"):
            done = kill_the_scheduler(folder, address, process, rng.randrange(1, 30))
        before = len(logged(folder / "log"))
        completed(folder, undisturbed, before, done)


def test_the_ranges_of_the_process_are_those_that_are_checked():
    assert np.prod([len(values) for values in RANGES.values()]) == CHUNKS * 4
    assert sweep_process.SETTINGS["chunk"] == 4
