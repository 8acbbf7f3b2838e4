"""What the docs show is what the programs print."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from trum_sym.console import main

ROOT = Path(__file__).parents[2]


def shown(document, marker):
    text = (ROOT / document).read_text("utf-8")
    return re.search(rf"<!-- {re.escape(marker)} -->\n```\n(.*?)```", text, re.DOTALL)[1]


def lines(text):
    return [line.rstrip() for line in text.strip().splitlines()]


@pytest.mark.parametrize("example", ["table4.py", "resonance_levels.py", "forced_amplitude.py", "rotor_speed.py"])
def test_the_docs_show_what_the_examples_print(example):
    done = subprocess.run(
        [sys.executable, ROOT / "examples" / example], capture_output=True, text=True, encoding="utf-8", check=True
    )
    assert lines(shown("docs/operating-point.md", f"examples/{example}")) == lines(done.stdout)


def test_the_characteristics_are_what_their_example_prints():
    """To the digits shown, which are few; the last may differ where another processor rounds otherwise."""
    done = subprocess.run(
        [sys.executable, ROOT / "examples" / "characteristics.py"],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    theirs, ours = (
        skeleton(text) for text in (shown("docs/characteristics.md", "examples/characteristics.py"), done.stdout)
    )
    assert theirs[0].strip() == ours[0].strip()
    assert ours[1] == pytest.approx(theirs[1], rel=0.02)


def figure(line):
    """A row without its figure and error if it has both, the figure, the error."""
    row = re.match(
        r"(?P<label>[a-z].*?_s|\S+ speed|stall torque) {2,}(?P<value>\S+)  (?P<error>\S+) (?P<rest>.*)", line
    )
    if row is None:
        return line, 0.0, 0.0
    rest = re.sub(r"[+-]\d+\.\d+ %", "#", row["rest"])  # the difference follows from the figure
    return f"{row['label']} {rest}", float(row["value"]), float(row["error"])


def test_the_readme_shows_what_evaluate_prints(capsys):
    main(["evaluate"])
    theirs, ours = (lines(text) for text in (shown("README.md", "trum-sym evaluate"), capsys.readouterr().out))
    assert len(theirs) == len(ours)
    for one, other in zip(theirs, ours, strict=True):
        assert figure(one)[0].split() == figure(other)[0].split()
        (_, value, error), (_, found, found_error) = figure(one), figure(other)
        assert abs(value - found) <= error + found_error  # which steps are taken is the processor's affair
        assert 0.3 < (error or 1.0) / (found_error or 1.0) < 3.0


def test_the_readme_has_the_two_commands_that_ci_runs():
    text = (ROOT / "README.md").read_text("utf-8")
    commands = re.findall(r"^    (python3 -m venv .*)$", text, re.MULTILINE)
    assert len(commands) == 2
    assert commands[0].endswith("trum-sym evaluate")
    assert commands[1].endswith("python -m pytest")


def alike(ours, theirs):
    """The same words, and numbers to a thousandth: a flat optimum's place differs between CPUs."""
    number = re.compile(r"[+-]?\d+\.?\d*(?:e[+-]?\d+)?")
    assert [number.sub("#", line).split() for line in lines(ours)] == [
        number.sub("#", line).split() for line in lines(theirs)
    ]
    for mine, other in zip(number.findall(ours), number.findall(theirs), strict=True):
        small = max(abs(float(mine)), abs(float(other))) < 1e-8  # violations of constraints: met is met
        if len(mine.strip("+-0.")) == len(other.strip("+-0.")) == 1 and "." in mine and "e" not in mine + other:
            small |= 1 / 3 <= float(mine) / float(other) <= 3  # an error, or a difference, of one digit
        assert small or float(mine) == pytest.approx(float(other), rel=2e-3, abs=2e-4)


def test_the_page_on_the_optimiser_shows_what_it_prints(capsys):
    assert main(["optimize", "--target-speed", "633 arcsec/s"]) == 0
    alike(shown("docs/optimise.md", "trum-sym optimize"), capsys.readouterr().out)


def test_the_page_on_the_optimiser_shows_what_its_example_prints():
    command = [sys.executable, ROOT / "examples" / "optimise.py"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    alike(shown("docs/optimise.md", "examples/optimise.py"), done.stdout)


def test_the_page_on_claims_has_table_4_by_reading_inertia_and_compliance():
    command = [sys.executable, ROOT / "examples" / "table4_bench.py"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    alike(shown("docs/claims.md", "examples/table4_bench.py"), done.stdout)


@pytest.mark.slow
def test_the_page_on_the_optimiser_shows_how_sharp_its_optima_are():
    command = [sys.executable, ROOT / "examples" / "knife_edge.py"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    alike(shown("docs/optimise.md", "examples/knife_edge.py"), done.stdout)


@pytest.mark.slow
def test_the_page_on_points_to_be_held_shows_what_its_example_prints():
    command = [sys.executable, ROOT / "examples" / "holdable.py"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    alike(shown("docs/holding.md", "examples/holdable.py"), done.stdout)


@pytest.mark.slow
def test_the_page_on_points_to_be_held_shows_what_track_prints(capsys):
    marker = re.search(r"<!-- (trum-sym track .*) -->", (ROOT / "docs/holding.md").read_text("utf-8"))[1]
    assert main(shlex.split(marker)[1:]) == 0
    alike(shown("docs/holding.md", marker), capsys.readouterr().out)


def test_the_python_of_the_page_on_the_optimiser_runs(capsys):
    text = (ROOT / "docs/optimise.md").read_text("utf-8")
    exec(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], {})
    assert capsys.readouterr().out.startswith("solved ")


COMMANDS = re.findall(r"^<!-- trum-sym (calibrate .*) -->$", (ROOT / "docs/calibrate.md").read_text("utf-8"), re.M)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_docs_show_what_calibrate_prints(command, capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    main(command.split())
    assert lines(shown("docs/calibrate.md", f"trum-sym {command}")) == lines(capsys.readouterr().out)


def test_the_synthetic_data_are_what_their_script_makes(tmp_path):
    subprocess.run([sys.executable, ROOT / "examples" / "synthetic_data.py", tmp_path], check=True)
    made = sorted(tmp_path.iterdir())
    assert [path.name for path in made] == sorted(
        path.name for path in (ROOT / "examples/data").glob("*_synthetic.csv")
    )
    for path in made:
        kept = ROOT / "examples" / "data" / path.name
        assert path.read_text("utf-8").splitlines()[:2] == kept.read_text("utf-8").splitlines()[:2]
        ours, theirs = (np.loadtxt(p, delimiter=",", skiprows=2) for p in (path, kept))
        assert ours == pytest.approx(theirs, rel=1e-5)  # other instruction sets round otherwise


STUDIES = re.findall(r"^<!-- trum-sym (.*) -->$", (ROOT / "docs/studies.md").read_text("utf-8"), re.M)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def skeleton(text):
    """Text without numbers, blanks and rules, and the numbers; how many orbits a search takes is the processor's."""
    text = re.sub(r"\d+ orbits computed|[-\d.]+e[-+]\d+|  +|-{3,}", " ", text)
    return re.sub(r"\s+", " ", NUMBER.sub("#", text)), [float(x) for x in NUMBER.findall(text)]


@pytest.mark.parametrize("command", STUDIES)
def test_the_docs_show_what_the_studies_print(command, capsys):
    main(shlex.split(command))
    theirs, ours = skeleton(shown("docs/studies.md", f"trum-sym {command}")), skeleton(capsys.readouterr().out)
    assert ours[0].strip() == theirs[0].strip()
    assert ours[1] == pytest.approx(
        theirs[1], rel=6e-3
    )  # slopes of three digits, the last of which CPUs round differently


def test_the_page_on_tolerances_shows_what_its_command_prints(capsys, monkeypatch, tmp_path):
    text = (ROOT / "docs/tolerance.md").read_text("utf-8")
    command = re.search(r"^    (trum-sym spread (?:.*\\\n)*.*)$", text, re.MULTILINE)[1]
    monkeypatch.chdir(tmp_path)
    main(shlex.split(command.replace("\\\n", " "))[1:])
    assert lines(shown("docs/tolerance.md", "trum-sym spread")) == lines(capsys.readouterr().out)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["points.csv", "study.png"]


def test_the_page_on_tolerances_has_python_that_runs(capsys):
    text = (ROOT / "docs/tolerance.md").read_text("utf-8")
    for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(block, {})
    assert capsys.readouterr().out.rstrip().endswith(")}"), "the indices of the last block"


@pytest.mark.parametrize("page", ["calibrate.md", "studies.md"])
def test_the_pages_on_calibration_and_studies_have_python_that_runs(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for block in re.findall(r"```python\n(.*?)```", (ROOT / "docs" / page).read_text("utf-8"), re.DOTALL):
        exec(block, {})
    assert [path.name for path in tmp_path.iterdir()] == [
        {"calibrate.md": "my-motor.toml", "studies.md": "table.h"}[page]
    ]
