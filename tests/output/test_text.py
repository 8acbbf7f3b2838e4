r"""Whatever a motor's name or a source holds, it stays data in CSV, C, JSON, HTML, TOML, pictures and on a terminal."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
import subprocess
from xml.etree import ElementTree

import numpy as np
import pytest
from refusals import MOTOR_TEXT

import trum_sym as ts
from trum_sym.console import main
from trum_sym.inputs.motor_writer import write_motor
from trum_sym.output.c_text import as_comment
from trum_sym.text import one_line, plain

HOSTILE = {
    "newline": "TRUM\n=cmd|' /C calc'!A0",
    "cell": "TRUM,=1+1;=2+2\t=3+3",
    "quote": 'TRUM,"\n"',
    "comment": "TRUM */ int hidden = 1; /*",
    "slash at the end": "TRUM \\\n */ int hidden = 1; /* \\",
    "trigraph": "TRUM ??/\n */ int hidden = 1; /* ??/",
    "half a comment": "TRUM *\\\n/ int hidden = 1;",
    "universal": "TRUM \\u002a\\u002f",
    "escape": "TRUM\x1b[2J\x1b]0;title\x07",
    "one byte escape": "TRUM\x9b2J",
    "nul": "TRUM\0-60",
    "backspace": "TRUM\b\b\b\bNONE",
    "carriage return": "TRUM-60\rNONE",
    "override": "TRUM\u202e06-",
    "line separator": "TRUM\u2028=1+1",
    "markup": "<script>alert(1)</script>&amp;<!-- ]]>",
    "template": "{{ 7 * 7 }}{% raw %}",
    "mathematics": r"TRUM $\frac{1}{$ \$",
    "format": "TRUM {0} {motor} %s %n",
    "joiners": "\u0645\u06cc\u200c\u062e",
}
CONTROL = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\u2028\u2029]")


def toml(text):
    """As a basic string."""
    return '"' + "".join(c if c.isalnum() and c.isascii() else f"\\U{ord(c):08x}" for c in text) + '"'


@pytest.fixture(params=HOSTILE.values(), ids=HOSTILE)
def hostile(request):
    return request.param


@pytest.fixture
def named(hostile, motor_file):
    """The path of a motor file whose name and sources are hostile."""
    return written(hostile, motor_file)


@pytest.fixture
def all_named(motor_file):
    """The same of all of them in a row."""
    return written(" ".join(HOSTILE.values()), motor_file)


def written(hostile, motor_file):
    text = MOTOR_TEXT.replace('"TRUM-60"', toml(hostile), 1).replace('source = "Table 1"', f"source = {toml(hostile)}")
    return motor_file(re.sub(r'^source = "Table \d"', lambda _: f"source = {toml(hostile)}", text, flags=re.M))


@pytest.fixture(scope="module")
def table():
    """A speed table, whose motor's name is given when it is written."""
    from dataclasses import replace

    from trum_sym.model.inputs import Inputs
    from trum_sym.model.levels import Levels
    from trum_sym.studies.speed_table_result import Segment, SpeedTable

    rows = {"speed": [1.0, 2.0], "deviation": [0.1, 0.1], "drive_frequency": [4e4, 4e4], "speed_error": [1e-9, 1e-9]}
    rows = {name: np.array(row) for name, row in rows.items()}
    segment = Segment(**rows, drive={"prepressure": np.array([180.0, 181.0])})
    inputs = Inputs(ts.load_motor(), ts.Drive(), Levels())
    made = SpeedTable(
        motor="", drive=ts.Drive(), inputs=inputs, variables=("prepressure",), segments=(segment,), gaps=(), error=0.01,
        largest_error=0.001, floor=1e-6, reachable=(0.0, 3.0), evaluations=1,
    )  # fmt: skip
    return lambda name: replace(made, motor=name)


def test_a_speed_tables_csv_has_one_comment_and_no_formula(hostile, table, tmp_path):
    table(hostile).save(tmp_path / "table.csv")
    text = (tmp_path / "table.csv").read_text("utf-8")
    assert not CONTROL.search(text)
    first, *rest = text.splitlines()
    assert first.startswith("# speed table of ")
    assert [line[0] for line in rest] == ["#", "#", "#", "s", "1", "1"]
    for separator in ",;":
        for row in csv.reader(io.StringIO(text), delimiter=separator):
            assert not any(cell[:1] in ("=", "+", "-", "@", "\t", "\r") for cell in row)
    assert len(list(csv.reader(io.StringIO(text)))) == 7


@pytest.mark.parametrize("compiler", [name for name in ("gcc", "clang") if shutil.which(name)])
def test_a_speed_tables_header_has_nothing_of_it_in_its_code(hostile, table, tmp_path, compiler):
    code = []
    for folder, motor in ("hostile", hostile), ("plain", "TRUM"):
        (tmp_path / folder).mkdir()
        table(motor).save(tmp_path / folder / "table.h")
        command = [compiler, "-std=c99", "-trigraphs", "-E", "-P", "-Wall", "-Wextra", "-Werror", "-x", "c"]
        done = subprocess.run([*command, tmp_path / folder / "table.h"], capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        code.append(done.stdout)
    assert code[0] == code[1]
    assert "hidden" not in code[0]


@pytest.mark.parametrize("arguments", [["evaluate"], ["evaluate", "--json"], ["simulate"]])
def test_the_terminal_sees_no_control_character(all_named, capsys, arguments):
    assert main([*arguments, "--motor", str(all_named)]) == 0
    out, err = capsys.readouterr()
    assert not CONTROL.search(out + err)


def test_json_gives_the_name_back(named, hostile, capsys):
    assert main(["evaluate", "--json", "--motor", str(named)]) == 0
    assert json.loads(capsys.readouterr().out)["motor"] == hostile


def test_a_title_is_one_line(named, hostile, capsys):
    assert main(["evaluate", "--motor", str(named)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(one_line(hostile))
    assert main(["evaluate"]) == 0
    assert len(lines) == len(capsys.readouterr().out.splitlines())


def test_errors_are_one_line_of_text(hostile, console_refuses):
    for arguments in (["--motor", hostile], ["--set", hostile], ["--prepressure", hostile], ["--start", hostile]):
        assert not CONTROL.search(console_refuses("evaluate", *arguments, naming=("trum-sym: ",)))


@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
def test_attributes_hold_it(all_named, tmp_path, suffix):
    import xarray as xr

    from trum_sym.output.files import write

    motor = ts.load_motor(all_named)
    if suffix == ".nc":
        write("out", ts.simulate(motor), tmp_path / "a.nc")
        with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as found:
            attributes = dict(found.attrs)
    else:
        ts.sweep(motor, prepressure=[170, 180], outputs=["amplitude"], out=tmp_path / "a.zarr")
        attributes = xr.open_zarr(tmp_path / "a.zarr", chunks=None).attrs
    assert attributes["motor"] == plain(motor.name)
    assert attributes["motor_radius"].endswith(f"({plain(motor.radius.source)})")


def test_a_motor_file_written_holds_it_to_the_letter(named, tmp_path):
    motor = ts.load_motor(named)
    write_motor(motor.with_values({"contact_radius": 0.026}, source=motor.name), named, tmp_path / "new.toml")
    again = ts.load_motor(tmp_path / "new.toml")
    assert again.name == motor.name
    assert again.radius == motor.radius
    assert again.contact_radius.source == motor.name.strip()


def test_pictures_show_it_as_text():
    from matplotlib.figure import Figure

    from trum_sym.plots.style import svg

    figure, wanted = Figure(), [" ".join(one_line(text).split()) for text in HOSTILE.values()]
    for place, text in enumerate(HOSTILE.values()):
        figure.text(0, place / 20, one_line(text), parse_math=False)
        figure.text(0.5, place / 20, one_line(text).replace("$", r"\$"))
    xlink = 'xmlns:xlink="http://www.w3.org/1999/xlink"'
    element = svg(figure, "a", " ".join(wanted))
    root = ElementTree.fromstring(element.replace("<svg", f"<svg {xlink}", 1))
    found = ["".join(text.itertext()) for text in root.iter() if text.tag in ("text", "title")]
    assert found[0] == " ".join(wanted)
    assert sorted(" ".join(text.split()) for text in found[1:]) == sorted(wanted * 2)


def test_the_report_shows_it_as_text(hostile):
    from jinja2 import Environment, PackageLoader

    environment = Environment(loader=PackageLoader("trum_sym.report", "templates"), autoescape=True)
    source = environment.loader.get_source(environment, "page.html")[0]
    assert set(re.findall(r"{{ ([\w.]+) \| safe }}", source)) == {"style", "interactive", "item.svg", "script"}
    shown = environment.from_string("<p title='{{ motor }}'>{{ motor }}</p>").render(motor=hostile)
    assert shown.count("<") == 2


@pytest.mark.parametrize("end", ["*/", "/*", "**//", "??/", "\\", "*\\\n/", "/\0*", "\n"])
def test_a_comment_cannot_be_ended(end):
    for text in (end, f"a{end}b", end * 3, f" {end} "):
        written = as_comment(text)
        assert not set(written) & set("\n\r\\\0")
        assert all(pair not in written for pair in ("*/", "/*", "??"))


def test_plain_text_is_left_alone():
    for text in ("TRUM-60 at 180 N, ±3 µm", "a\nb", "日本語 — “x”", "\u0645\u06cc\u200c\u062e"):
        assert plain(text) == text
    assert plain("\ud800") == "\\ud800"


def test_a_matplotlibrc_in_the_folder_runs_no_tex(tmp_path, monkeypatch):
    """A stranger's folder may hold one; with text.usetex every label would go through TeX."""
    import matplotlib as mpl
    from matplotlib import texmanager

    from trum_sym.plots import optimum, style, tolerance

    monkeypatch.setattr(texmanager.TexManager, "make_dvi", lambda *_: pytest.fail("TeX was called"))
    with mpl.rc_context({"text.usetex": True}):
        found = ts.optimize(
            ts.load_motor(),
            ts.Drive(load_torque=0.05),
            objective="q_volatility",
            bounds={"prepressure": (175, 185), "frequency_difference": 3000.0},
        )
        optimum.draw(found, tmp_path / "box.svg")
        assert tolerance.draw.__wrapped__
        assert style.styled(lambda: mpl.rcParams["text.usetex"])() is False
    assert "TRUM-60" in (tmp_path / "box.svg").read_text("utf-8")
