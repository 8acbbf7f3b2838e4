"""What the console prints reaches streams of any encoding: as it is, or spelt in ASCII; never a traceback."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout

import pytest
from refusals import MOTOR_TEXT

from trum_sym import console
from trum_sym.console.streams import spelt

ENCODINGS = ("gbk", "cp932", "cp949", "big5", "koi8-r", "ascii", "latin-1", "cp1252", "utf-8", "utf-16")
NAME = "TRUM-60 µ·Δω ≤ 超音波 Ø²"
FAST = ("--samples", "64", "--spread", "friction_coefficient", "--output", "amplitude")
BOX = ("--prepressure", "170:171", "--frequency-difference", "3000:3001")


def commands(folder):
    """Every command, on a motor whose name no narrow encoding holds, writing into a folder of such a name."""
    motor = folder / "motor.toml"
    motor.write_text(MOTOR_TEXT.replace("TRUM-60", NAME), "utf-8")
    data = folder / "Messung-µ.csv"
    data.write_text("prepressure [N],amplitude [µm]\n100,8.5\n140,6.6\n180,5.6\n220,4.8\n", "utf-8")
    out = folder / "Δω-超"
    point = ("--motor", str(motor))
    return {
        "help": ("--help",),
        "evaluate": ("evaluate", *point),
        "evaluate --help": ("evaluate", "--help"),
        "evaluate --json": ("evaluate", *point, "--json"),
        "simulate": ("simulate", *point, "--out", f"{out}.csv"),
        "simulate table": ("simulate", *point),
        "sweep": ("sweep", *point, "--prepressure", "160:180:2", "--outputs", "amplitude", "--out", f"{out}-2.csv"),
        "tolerance": ("spread", *point, *FAST, "--out", f"{out}-3.csv"),
        "optimize": ("optimize", *point, *BOX, "--objective", "amplitude"),
        "pareto": ("pareto", *point, *BOX, "--objective", "wear", "--points", "3"),
        "robust": ("robust", *point, *BOX, "--objective", "wear", "--spread", "friction_coefficient=5 %"),
        "speed-table": ("speed-table", *point, "--from", "0.5 rad/s", "--to", "0.6 rad/s", "--points", "2"),
        "calibrate": ("calibrate", str(data), *point, "--out", f"{out}-4.toml"),
        "equations": ("equations",),
        "equations --equation": ("equations", "--equation", "24"),
        "equations --json": ("equations", "--json"),
        "report": ("report", str(data), *point),
        "a refusal": ("evaluate", *point, "--prepressure", "180 µ²Ø超"),
        "a usage error": ("evaluate", "--µ"),
        "a warning": ("evaluate", *point, "--prepressure", "90", "--set", "contact_radius=31 mm"),
    }


QUICK = ("help", "evaluate", "calibrate", "equations", "a refusal", "a usage error", "a warning")


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_encoding_takes_what_the_console_prints(tmp_path, encoding):
    for arguments in (commands(tmp_path)[name] for name in QUICK):
        out, err = (io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2))
        with redirect_stdout(out), redirect_stderr(err):
            assert console.main(list(arguments)) in (0, 1, 2)
        assert (out.errors, err.errors) == ("strict", "strict")  # as they were
        for stream in (out, err):
            stream.flush()
            stream.buffer.getvalue().decode(encoding)


@pytest.mark.parametrize("encoding", ["gbk", "ascii"])
def test_a_redirected_process_spells_the_micro_sign(tmp_path, encoding):
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    command = [sys.executable, "-m", "trum_sym", "evaluate"]
    with (tmp_path / "out.txt").open("wb") as out:
        done = subprocess.run(command, stdout=out, stderr=subprocess.PIPE, env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    lines = (tmp_path / "out.txt").read_text(encoding).splitlines()
    (amplitude,) = [line for line in lines if line.startswith("amplitude of a phase")]
    assert amplitude.split()[5:7] == ["5.56211", "um"]


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_command_redirected_in_every_encoding(tmp_path, encoding):
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    for name, arguments in commands(tmp_path).items():
        command = [sys.executable, "-m", "trum_sym", *arguments]
        done = subprocess.run(command, capture_output=True, env=environment, check=False)
        assert done.returncode in (0, 1, 2), name
        text = done.stderr.decode(encoding)
        assert "Traceback" not in text, name
        assert done.stdout or text, name
        done.stdout.decode(encoding)


def test_characters_are_spelt_as_the_field_spells_them():
    assert spelt("5.5 µm, Δf, N·m, m², −1 ≤ θ, ±5 °") == "5.5 um, Deltaf, N*m, m^2, -1 <= theta, +-5 deg"
    assert spelt("Müller") == "Muller"
    assert spelt("超") == "\\u8d85"
