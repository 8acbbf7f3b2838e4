"""Pipes and devices, which may have no end, are refused wherever a file is read; so are files beyond any use."""

from __future__ import annotations

import os
import threading
import time

import pytest

from trum_sym.inputs import motor_file

READERS = {
    "motor": ["evaluate", "--motor", "{}"],
    "measurements": ["calibrate", "{}"],
    "samples": ["robust", "--objective", "wear", "--samples", "{}"],
    "range": ["sweep", "--prepressure", "@{}", "--out", "map.zarr"],
    "range of the motor": ["sweep", "--set", "friction_coefficient=@{}", "--out", "map.zarr"],
    "point": ["spread", "--point", "{}"],
    "motor of the report": ["report", "out", "--motor", "{}"],
}


@pytest.mark.parametrize("what", ["pipe", "/dev/zero", "/dev/tty", "folder"])
@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_file_is_refused_at_once(console_refuses, tmp_path, monkeypatch, reader, what):
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    (tmp_path / "folder").mkdir()
    begin = time.monotonic()
    console_refuses(*(part.format(what) for part in READERS[reader]), naming=("got", what))
    assert time.monotonic() - begin < 5
    assert sorted(os.listdir()) == ["folder", "pipe"]


def test_a_pipe_with_a_writer_is_refused_too(console_refuses, tmp_path):
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    writer = threading.Thread(target=lambda: pipe.open("wb").close(), daemon=True)
    writer.start()
    console_refuses("evaluate", "--motor", str(pipe), naming=("motor", "a pipe or a device; save what it gives"))
    os.close(os.open(pipe, os.O_RDONLY | os.O_NONBLOCK))  # lets the writer go
    writer.join(5)


def test_a_file_without_end_is_refused_before_it_fills_the_memory(console_refuses, tmp_path):
    for name, arguments in (
        ("m.toml", ["evaluate", "--motor"]),
        ("d.csv", ["calibrate"]),
        ("p", ["spread", "--point"]),
    ):
        with (tmp_path / name).open("wb") as file:
            file.truncate(2**40)  # a hole of a TiB
        console_refuses(*arguments, str(tmp_path / name), naming=("bytes",))


def test_the_text_of_a_motor_file_is_what_it_was(motor_file):
    assert motor_file_text(motor_file("a = 1\r\nb = 2\r")) == "a = 1\nb = 2\n"


def motor_file_text(path):
    return motor_file.motor_text(path)
