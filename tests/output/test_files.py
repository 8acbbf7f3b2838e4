"""Every file appears whole or not at all, whatever the disk does, and rests of killed processes go."""

from __future__ import annotations

import csv
import errno
import os
import resource
import stat
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest
from lazily import lazily
from refusals import refusal

from trum_sym.output import files

xr = lazily("xarray")


def dataset(count=2000):
    values = np.random.default_rng(1).uniform(size=count)
    speed = ("time", values, {"units": "rad/s", "long_name": "speed"})
    return xr.Dataset({"speed": speed}, {"time": ("time", np.arange(count) / 7, {"units": "s"})}, {"motor": "TRUM-60"})


@contextmanager
def largest(size):
    """No file may be longer: what a quota does."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("suffix", files.SUFFIXES)
@pytest.mark.parametrize("size", [0, 1, 4096, 8192, 12000])
def test_a_quota_leaves_what_was_there_and_nothing_else(tmp_path, suffix, size):
    target = tmp_path / f"histories{suffix}"
    for before in (None, b"before"):
        if before is not None:
            target.write_bytes(before)
        with largest(size), refusal("--out", "a file that can be written (File too large)"):
            files.write("--out", dataset(), target)
        assert names(tmp_path) == ([] if before is None else [target.name])
    assert target.read_bytes() == b"before"


def test_netcdf_that_meets_a_full_disk_does_not_end_the_interpreter(tmp_path):
    """It did, after the message: HDF5 crashed as the process ended."""
    program = (
        "import resource, sys, pathlib, trum_sym as ts\n"
        "from trum_sym.output.files import write\n"
        "histories = ts.simulate(ts.load_motor(), cycles=5)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))\n"
        "try: write('out', histories, pathlib.Path(sys.argv[1]))\n"
        "except ts.ParameterError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-P", "-c", program, tmp_path / "a.nc"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("\n") == 1
    assert "File too large" in done.stdout
    assert names(tmp_path) == []


@pytest.mark.parametrize("suffix", files.SUFFIXES)
def test_what_is_written_is_read_again(tmp_path, suffix):
    target, wanted = tmp_path / f"histories{suffix}", dataset(50)
    files.write("--out", wanted, target)
    if suffix == ".nc":
        found = xr.open_dataset(target, engine="h5netcdf")
        assert found.identical(wanted)
        found.close()
    else:
        import pandas as pd

        if suffix == ".csv":
            header, *rows = csv.reader(target.read_text().splitlines())
            table = dict(zip(header, np.array(rows, float).T, strict=True))
        else:
            table = pd.read_parquet(target)
        assert list(table) == ["time [s]", "speed [rad/s]"]
        assert np.array_equal(np.asarray(table["speed [rad/s]"]), wanted.speed.values)


@pytest.mark.parametrize("call", ["mkstemp", "fsync", "replace", "chmod"])
def test_a_system_call_that_fails_is_one_line_and_leaves_nothing(tmp_path, monkeypatch, call):
    def fails(*_, **__):
        raise OSError(errno.EDQUOT, "Disk quota exceeded")

    owner = {"mkstemp": files.tempfile, "fsync": os, "replace": files.Path, "chmod": files.Path}[call]
    monkeypatch.setattr(owner, call, fails)
    with refusal("--out", "Disk quota exceeded"):
        files.write_bytes("--out", b"new", tmp_path / "a.csv")
    assert names(tmp_path) == []


def test_rests_of_killed_processes_go_and_those_of_living_ones_stay(tmp_path):
    target = tmp_path / "a.csv"
    for name in (".a.csv-01234567.partial", ".b.csv-01234567.partial", ".a.csv-mine.partial", "a.csv-01234567.partial"):
        (tmp_path / name).write_bytes(b"half")
    with files.replaced("--out", target) as living:
        living.write(b"slow")
        files.write_bytes("--out", b"quick", target)
        assert target.read_bytes() == b"quick"
        kept = [".a.csv-mine.partial", ".b.csv-01234567.partial", "a.csv", "a.csv-01234567.partial"]
        assert set(kept) < set(names(tmp_path))
        assert ".a.csv-01234567.partial" not in names(tmp_path)
    assert target.read_bytes() == b"slow"
    assert names(tmp_path) == kept


def test_a_process_that_is_killed_leaves_the_old_file_and_the_next_one_tidies_up(tmp_path):
    target = tmp_path / "a.csv"
    target.write_bytes(b"before")
    program = (
        "import os, sys, pathlib\n"
        "from trum_sym.output.files import replaced\n"
        "with replaced('out', pathlib.Path(sys.argv[1])) as file:\n"
        "    file.write(b'half'); file.flush(); os.kill(os.getpid(), 9)\n"
    )
    assert subprocess.run([sys.executable, "-P", "-c", program, target]).returncode == -9
    assert len(names(tmp_path)) == 2
    assert target.read_bytes() == b"before"
    files.write_bytes("--out", b"new", target)
    assert names(tmp_path) == ["a.csv"]
    assert target.read_bytes() == b"new"


def test_a_link_stays_and_what_it_leads_to_is_replaced(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data/real.csv").write_text("before")
    (tmp_path / "a.csv").symlink_to("data/real.csv")
    files.check_target("--out", tmp_path / "a.csv")
    files.write_bytes("--out", b"new", tmp_path / "a.csv")
    assert (tmp_path / "a.csv").is_symlink()
    assert (tmp_path / "data/real.csv").read_bytes() == b"new"
    assert names(tmp_path / "data") == ["real.csv"]


def test_the_rights_of_a_file_stay_and_a_new_one_has_the_usual(tmp_path):
    (tmp_path / "private.csv").write_text("before")
    (tmp_path / "private.csv").chmod(0o600)
    (tmp_path / "usual").write_text("")
    for name in ("private.csv", "new.csv"):
        files.write_bytes("--out", b"new", tmp_path / name)
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("private.csv", "new.csv", "usual")]
    assert modes == [0o600, modes[2], modes[2]]


def test_a_long_name_is_written_and_one_too_long_is_one_line(tmp_path):
    longest = "µ" * 125 + ".csv"  # 254 bytes
    files.check_target("--out", tmp_path / longest)
    files.write_bytes("--out", b"new", tmp_path / longest)
    assert names(tmp_path) == [longest]
    for name in ("x" * 300 + ".csv", "x/" * 3000 + "a.csv", "a\0.csv"):
        with refusal("--out", "a path that the system takes"):
            files.check_target("--out", tmp_path / name)


def test_what_is_no_file_is_not_replaced(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "circle.csv").symlink_to("circle.csv")
    (tmp_path / "away.csv").symlink_to("nowhere/away.csv")
    for name, why in (
        ("pipe.csv", "a pipe or a device"),
        ("circle.csv", "takes"),
        ("away.csv", "a folder that exists"),
    ):
        with refusal("--out", why):
            files.check_target("--out", tmp_path / name)
