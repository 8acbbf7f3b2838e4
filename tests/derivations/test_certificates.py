"""Certificates: replayed by a checker that needs nothing, refused when tampered with or when about something else."""

from __future__ import annotations

import ast
import copy
import json
import random
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from lazily import lazily

checker = lazily("derivations.certificates.checker")
make = lazily("derivations.certificates.make")
page = lazily("derivations.certificates.page")
reading = lazily("derivations.certificates.reading")
sources = lazily("derivations.certificates.sources")

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "derivations" / "certificates" / "data").glob("*.json"))
NAMES = [path.stem for path in FILES]


def load(name):
    return json.loads((ROOT / "derivations" / "certificates" / "data" / f"{name}.json").read_text("utf-8"))


def test_the_core_is_covered():
    about = {entry for name in NAMES for entry in load(name)["about"]}
    assert {"A5", "A6", "A14", "A15", "A16", "A17", "23", "A13", "36", "42", "44", "rotor-orbit"} <= about
    assert sum(len(load(name)["claims"]) for name in NAMES) > 20


def test_the_checker_needs_python_alone():
    path = ROOT / "derivations" / "certificates" / "checker.py"
    tree = ast.parse(path.read_text("utf-8"))
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    imported |= {name.name for node in ast.walk(tree) if isinstance(node, ast.Import) for name in node.names}
    assert {module.split(".")[0] for module in imported} <= {*sys.stdlib_module_names, "__future__"}
    done = subprocess.run([sys.executable, "-I", path, *FILES], capture_output=True, text=True, check=True)
    assert done.stdout.count("every claim is proved") == len(FILES)


@pytest.mark.parametrize("name", NAMES)
def test_a_certificate_is_proved_read_right_and_what_is_made_now(name):
    certificate = load(name)
    checker.check(certificate)
    assert reading.misread(certificate) == []
    assert (ROOT / "derivations" / "certificates" / "data" / f"{name}.json").read_text("utf-8") == make.as_json(
        make.make(name)
    )


def changed(certificate, draw):
    """One coefficient of what is claimed, or of what proves it, a little larger."""
    claim = draw.choice(certificate["claims"])
    places = [
        claim["goal"],
        *(m for _, m in claim["multipliers"]),
        *(p for _, _, p in (*claim["times"], *claim["equals"])),
    ]
    terms = draw.choice([place for place in places if place])
    key = draw.choice(sorted(terms))
    terms[key] = str(Fraction(terms[key]) + Fraction(1, 7))


@pytest.mark.parametrize("name", NAMES)
def test_a_tampered_certificate_is_refused(name):
    for seed in range(6):
        tampered = copy.deepcopy(load(name))
        changed(tampered, random.Random(f"{name} {seed}"))
        with pytest.raises(ValueError, match=":"):
            checker.check(tampered)


def test_what_could_be_nothing_proves_nothing():
    zero_times = {"positive": [], "rates": {}, "given": [], "claims": [{"name": "any", "goal": {"x": "1"}}]}
    for times in ([], [["1", [], {"y": "1"}]], [["0", [], {"": "1"}]], [["-1", [], {"": "1"}]], [["1", [], {}]]):
        zero_times["claims"][0] |= {"times": times, "equals": [], "multipliers": []}
        with pytest.raises(ValueError, match="any"):
            checker.check(zero_times)
    claim = {"name": "square", "goal": {"x^2": "1"}, "times": [["1", [], {"": "1"}]], "multipliers": []}
    with pytest.raises(ValueError, match="could be 0"):  # a square is not above 0
        checker.check({**zero_times, "claims": [{**claim, "equals": [["1", [], {"x": "1"}]]}]})


def test_a_certificate_of_a_wrong_statement_is_refused():
    right = load("root-above")
    printed = copy.deepcopy(right)  # the print: df/dY (Y - 1) + 2 = 0, given so that it is provable
    printed["given"].append({"F Y": "1", "F": "-1", "": "2"})
    printed["rates"] = {}
    one = [["1", [], {"": "1"}]]
    goal = {"F Y": "1", "F": "-1", "": "2"}
    printed["claims"] = [
        {"name": "slope", "says": "", "goal": goal, "times": one, "equals": [], "multipliers": [[2, {"": "1"}]]}
    ]
    checker.check(printed)  # the algebra is right
    assert any("is not 0" in problem for problem in reading.misread(printed))
    other = copy.deepcopy(right)
    other["letters"]["f"] = "sqrt((Y + 2)/(Y - 1))"
    assert reading.misread(other)
    weaker = copy.deepcopy(right)  # right about the derived form, and about anything else
    weaker["claims"][1]["goal"] = {}
    weaker["claims"][1]["multipliers"] = []
    checker.check({**weaker, "claims": weaker["claims"][1:2]})
    assert any("the print satisfies it too" in problem for problem in reading.misread(weaker))


def test_the_page_shows_what_the_files_say():
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    order = [source.name for source in sources.SOURCES]
    assert sorted(order) == sorted(NAMES)
    text = (ROOT / "docs" / "certificates.md").read_text("utf-8")
    assert text == page.page([load(name) for name in order], records)
    assert "F Y r - F r + 1 = 0 (slope)" in text
