"""No option is ignored: each one changes what its command answers, or is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import click
import pytest
from test_language import LEAVES

import trum_sym as ts
from trum_sym import console

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
ROOT = Path(__file__).parents[2]

PLACE = ("--load-torque", "0.05", "--prepressure", "180", "--frequency-difference", "2990:3010")
# A short line of each command; what it prints is compared with what it prints with one option more
BASE = {
    ("evaluate",): (),
    ("simulate",): (),
    ("sensitivities",): (),
    ("characteristics",): ("--points", "3"),
    ("admittance",): ("--points", "3"),
    ("drive",): ("--compliance", "flange", "--tolerance", "1e-2", "--sampling-period", "1 ms"),
    ("sweep",): ("--prepressure", "170:180:2", "--out", "base.csv"),
    ("spread",): ("--samples", "64", "--spread", "friction_coefficient"),
    ("calibrate",): ("examples/data/torque_speed_synthetic.csv", "--fit", "friction_coefficient"),
    ("optimize",): ("--objective", "wear", *PLACE),
    ("pareto",): ("--objective", "wear", "--points", "3", *PLACE),
    ("robust",): ("--objective", "wear", "--spread", "friction_coefficient=0.01", *PLACE),
    ("speed-table",): (
        *("--from", "340000 arcsec/s", "--to", "350000 arcsec/s", "--points", "2", "--error", "0.5"),
        *("--direction", "positive", "--load-torque", "0.05", "--prepressure", "180"),
    ),
    ("track",): (
        *("--target-speed", "100000 arcsec/s", "--load-torque", "0.1", "--prepressure", "180"),
        *("--duration", "8 ms"),
    ),
    ("c-library",): ("new.library",),
    ("fmu",): ("new.fmu", "--sources-only"),
    ("equations",): (),
    ("info",): (),
    ("motor", "show"): ("trum60",),
    ("motor", "check"): ("trum60",),
    ("motor", "new"): ("my.toml",),
    ("motor", "diff"): ("trum60", "examples/own.toml"),
    ("motor", "schema"): (),
}
NO_ANSWER = {("report",): "tests/report makes one; it takes a minute"}
SLOW = {
    ("optimize",),
    ("pareto",),
    ("robust",),
    ("speed-table",),
    ("track",),
    ("spread",),
}  # a search or a study an option
SLOW |= {
    ("simulate",),
    ("sweep",),
    ("sensitivities",),
    ("characteristics",),
}  # whose options are made as those of evaluate are
SLOW_AS_EVALUATE = {
    ("calibrate",),
    ("drive",),
}  # a fit, or an orbit, an option: only those that evaluate does not have are always tried

# Another value of every option, by its name; of a command where that differs
OTHER = {
    "--motor": "own.toml",
    "--set": "contact_radius=26 mm",
    "--point": "point.json",
    "--sampling-period": "2 ms",
    "--tolerance": "1e-3",
    "--cycles": "2",
    "--samples-per-period": "32",
    "--outputs": "mean_speed",
    "--scheduler": "nowhere",
    "--chunk": "1",
    "--spread": "contact_radius",
    "--samples": "128",
    "--output": "stall_torque",
    "--target": "mean_speed >= 1",
    "--seed": "5",
    "--fit": "contact_radius",
    "--errors": "relative",
    "--confidence": "0.5",
    "--objective": "ripple",
    "--against": "speed_volatility",
    "--target-speed": "350000 arcsec/s",
    "--constraint": "mean_speed >= 342000 arcsec/s",
    "--points": "4",
    "--from": "342000 arcsec/s",
    "--to": "349000 arcsec/s",
    "--direction": "both",
    "--error": "0.4",
    "--equation": "24",
    "--verdict": "erratum",
    "--severity": "structural",
    "--width": "60",
    "--name": "other",
    "--like": "own.toml",
    "--load-torque": "0.07",
    "--prepressure": "172",
    "--frequency-difference": "3005",
    "--periods": "18",
    "--on-periods": "13",
    "--switching-phase": "0.5",
    "--phase-lead": "-1",
    "--hold-within": "0.02",
    "--holds": "friction_coefficient=0.001 %",
    "--starts": "0.1 us",
    "--duration": "12 ms",
    "--control-period": "1 ms",
    "--encoder-counts": "1000",
    "--disturb": "load_torque=+2 %@2 ms",
    ("admittance", "--from"): "38 kHz",  # which needs the other end
    ("admittance", "--to"): "39 kHz",
    **{(command, "--spread"): "prepressure=+-0.2 N" for command in ("evaluate", "optimize", "pareto", "speed-table")},
    ("robust", "--samples"): "cases.csv",
    ("speed-table", "--direction"): "both",
    ("drive", "--compliance"): "layer",
    ("pareto", "--constraint"): "mean_speed >= 400000 arcsec/s",
    ("sweep", "--prepressure"): "171",
}
FILES = {
    ("simulate", "--out"): "new.csv",
    ("sweep", "--out"): "new.csv",
    ("spread", "--out"): "new.csv",
    ("spread", "--plot"): "new.png",
    ("calibrate", "--out"): "new.toml",
    ("evaluate", "--out"): "new.csv",
    ("characteristics", "--out"): "new.csv",
    ("admittance", "--out"): "new.csv",
    ("characteristics", "--measured"): str(ROOT / "trum_sym" / "data" / "dual60.measured.toml"),
    ("speed-table", "--out"): "new.csv",
}
NO_FIGURE = {
    ("evaluate", "--method"): "it acts at coarse tolerances alone: tests/model/test_fixed_grid.py",
    ("equations", "--open"): "a page in a browser: below",
    ("sweep", "--chunk"): "how the work is divided: tests/sweeps",
    ("fmu", "--sources-only"): "it takes a compiler: tests/driver/test_export.py",
}
INPUTS = ("motor_values", "drive", "levels", "assumed", "sampling_period", "tolerance", "units", "motor", "start")


def flips():
    of_evaluate = {option.opts[0] for option in LEAVES["evaluate",].params}
    for words, command in LEAVES.items():
        if words in NO_ANSWER:
            continue
        for option in command.params:
            if isinstance(option, click.Option) and (" ".join(words), option.opts[0]) not in NO_FIGURE:
                if option.opts[0] == "--force":
                    continue  # whether files are replaced: below
                slow = words in SLOW or (words in SLOW_AS_EVALUATE and option.opts[0] in of_evaluate)
                name = f"{' '.join(words)} {option.opts[0]}"
                yield pytest.param(words, option, id=name, marks=[pytest.mark.slow] * slow)


def other(words, option):
    """The option with another value than it has by itself."""
    name = option.opts[0]
    if option.is_flag:
        return (name,)
    file = FILES.get((words[-1], name)) or OTHER.get((words[-1], name))
    if file or (name in OTHER and not isinstance(option.type, click.Choice)):
        return name, file or OTHER[name]
    if isinstance(option.type, click.Choice):
        return name, next(word for word in option.type.choices if word != option.default)
    if isinstance(option.default, float | int):
        return name, repr(1.1 * option.default + 0.1)
    if name == "--plot":
        return name, "new.png"
    raise AssertionError(f"no other value of {name}: give it one in OTHER")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    from refusals import WITHOUT_PUBLISHED

    folder = tmp_path_factory.mktemp("options")
    shutil.copytree(ROOT / "examples" / "data", folder / "examples" / "data")
    own = WITHOUT_PUBLISHED.replace('name = "TRUM-60"', 'name = "own"').replace("value = 12.6", "value = 12.1")
    for path in (folder / "own.toml", folder / "examples" / "own.toml"):
        path.write_text(own, "utf-8")
    (folder / "cases.csv").write_text("friction_coefficient\n0.24\n", "utf-8")
    drive = ts.Drive(prepressure=175.0, frequency_difference=3001.0, load_torque=0.06, on_periods=15)
    (folder / "point.json").write_text(ts.evaluate(drive=drive).to_json(), "utf-8")
    return folder


def answered(capsys, folder, words, line):
    """Exit code, what is printed without the inputs that it repeats, and what files say."""
    for path in folder.glob("new.*"):
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    (folder / "base.csv").unlink(missing_ok=True)
    (folder / "my.toml").unlink(missing_ok=True)
    has_json = any("--json" in option.opts for option in LEAVES[words].params)
    if has_json and "--json" in line:
        line = [word for word in line if word != "--json"]
        plain = True
    else:
        plain = not has_json
    code = console.main([*words, *line, *([] if plain else ["--json"])])
    out, _ = capsys.readouterr()
    record = None
    if not plain and code != 2:
        found = json.loads(out)
        record = {k: v for k, v in found.items() if k not in INPUTS} if isinstance(found, dict) else found
    written = (*folder.glob("new.*"), *folder.glob("*.csv"), *folder.glob("my.toml"))
    inside = [file for path in written for file in (path.rglob("*") if path.is_dir() else (path,))]
    files = {str(file): file.read_bytes() for file in inside if file.is_file()}
    return code, record if record is not None else out, files


BEFORE: dict[tuple[str, ...], object] = {}


@pytest.mark.parametrize(("words", "option"), list(flips()))
def test_every_option_changes_the_answer_or_is_refused(capsys, place, monkeypatch, words, option):
    monkeypatch.chdir(place)
    base = list(BASE.get(words, ()))
    if words not in BEFORE:
        BEFORE[words] = answered(capsys, place, words, base)
    before = BEFORE[words]
    assert before[0] in (0, 1)
    changed = other(words, option)
    kept = _without(base, changed[0]) if not option.multiple else base
    after = answered(capsys, place, words, [*kept, *changed])
    assert after[0] == 2 or after != before, f"{changed} changes nothing"


def _without(line, name):
    """A line without an option and its value."""
    return line if name not in line else line[: line.index(name)] + line[line.index(name) + 2 :]


DRAWN = {
    "evaluate": (),
    "sensitivities": (),
    "optimize": ("--objective", "wear", "--load-torque", "0.05", "--prepressure", "180"),
    "simulate": ("--load-torque", "0.1"),
    "sweep": ("--prepressure", "170,180", "--outputs", "amplitude", "--out", "{folder}/store.zarr"),
    "calibrate": (str(ROOT / "examples" / "data" / "table2.csv"),),
}


@pytest.mark.parametrize("command", DRAWN)
def test_a_picture_is_drawn_and_replaces_no_file(capsys, console_refuses, tmp_path, command):
    target = tmp_path / "picture.png"
    line = [command, *(word.format(folder=tmp_path) for word in DRAWN[command]), "--plot", str(target)]
    assert console.main(line) == 0
    capsys.readouterr()
    content = target.read_bytes()
    assert content.startswith(b"\x89PNG")
    console_refuses(*line, naming=("--plot: got", "--force to replace it"))
    assert target.read_bytes() == content
    assert console.main([*line, "--force"]) == 0


WRITTEN = {
    "simulate": ("new.csv", "--samples-per-period", "4"),
    "sweep": ("new.csv", "--prepressure", "170,180", "--outputs", "amplitude"),
    "calibrate": ("new.toml", "examples/data/table2.csv"),
    "evaluate": ("new.csv",),
}


@pytest.mark.parametrize("command", WRITTEN)
def test_a_file_that_exists_is_replaced_only_by_force(capsys, console_refuses, place, monkeypatch, command):
    monkeypatch.chdir(place)
    name, *line = WRITTEN[command]
    target = place / name
    target.write_text("mine", "utf-8")
    console_refuses(command, *line, "--out", name, naming=(f"--out: got {name}", "--force to replace it"))
    assert target.read_text("utf-8") == "mine"
    assert console.main([command, *line, "--out", name, "--force"]) == 0
    assert target.read_text("utf-8") != "mine"
    capsys.readouterr()
    target.unlink()


def test_the_ledgers_page_is_opened(capsys, monkeypatch):
    import webbrowser

    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    assert console.main(["equations", "--open", "--equation", "24"]) == 0
    assert capsys.readouterr().out.strip() == opened[0]
    address, _, place = opened[0].partition("#")
    assert f'id="{place}"' in Path(address.removeprefix("file://")).read_text("utf-8")


def test_a_value_holds_and_a_range_frees(capsys):
    """``--prepressure 120`` is what the answer has; it was ignored, and 160 to 210 N searched."""
    line = ["optimize", "--objective", "wear", "--load-torque", "0.05", "--frequency-difference", "3000:3010"]
    found = []
    for force in ("190", "185:186"):
        assert console.main([*line, "--prepressure", force, "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out))
    assert found[0]["prepressure"] == 190
    assert list(found[0]["searched"]) == ["frequency_difference"]
    assert 185 <= found[1]["prepressure"] <= 186
    assert found[1]["searched"] == {"prepressure": [185, 186], "frequency_difference": [3000, 3010]}


def test_a_motor_without_a_box_is_asked_for_it(console_refuses, motor_file):
    """The ranges of the TRUM-60 were taken for any motor."""
    from refusals import WITHOUT_PUBLISHED

    start = WITHOUT_PUBLISHED.index("[box]")
    own = motor_file(WITHOUT_PUBLISHED[:start] + WITHOUT_PUBLISHED[WITHOUT_PUBLISHED.index("[parameters]") :])
    line = ("optimize", "--motor", str(own), "--target-speed", "1")
    console_refuses(*line, naming=("--prepressure: got none", "the motor file states no range in [box]"))
    console_refuses(*line, "--prepressure", "20", naming=("--frequency-difference: got none", "[box]"))


@pytest.mark.parametrize(
    ("entry", "naming"),
    [
        ('load_torque = { range = [0.0, 1.0], unit = "N*m", source = "x" }', ("box: got load_torque", "prepressure")),
        ('prepressure = { range = [0.0, 1.0], unit = "N", source = "x" }', ("box.prepressure.range: got 0", "> 0")),
        ('prepressure = { range = [5.0, 1.0], unit = "N", source = "x" }', ("box.prepressure.range", "low < high")),
        ('prepressure = { range = [5.0], unit = "N", source = "x" }', ("box.prepressure.range", "two numbers")),
        ('prepressure = { range = [1.0, 5.0], unit = "m", source = "x" }', ("box.prepressure.unit: got m", "N")),
        ('prepressure = { range = [1.0, 5.0], unit = "N" }', ("box.prepressure", "range, unit and source")),
        ('prepressure = { range = [1.0, 5.0], unit = "N", source = " " }', ("box.prepressure", "source as text")),
    ],
)
def test_a_bad_box_is_refused(console_refuses, motor_file, entry, naming):
    from refusals import WITHOUT_PUBLISHED

    start, end = (WITHOUT_PUBLISHED.index(mark) for mark in ("[box]", "[parameters]"))
    own = motor_file(f"{WITHOUT_PUBLISHED[:start]}[box]\n{entry}\n{WITHOUT_PUBLISHED[end:]}")
    console_refuses("evaluate", "--motor", str(own), naming=naming)


def test_what_a_command_says_of_its_answer_is_in_its_json(capsys):
    """At the optimum for 633 arcsec/s the load is more than holds the rotor still: in words, and in JSON."""
    line = ["optimize", "--target-speed", "633 arcsec/s", "--prepressure", "177:178"]
    assert console.main(line) == 0
    assert "exceeds the stall torque" in capsys.readouterr().out
    assert console.main([*line, "--json"]) == 0
    assert "exceeds the stall torque" in json.loads(capsys.readouterr().out)["remarks"][0]


def test_a_runaway_ends_with_no(capsys):
    assert console.main(["evaluate", "--load-torque", "100", "--json"]) == 1
    assert "no speed balances the load" in json.loads(capsys.readouterr().out)["remarks"][0]
