"""What stands at the root for those who release or report: changelog, workflows, issue forms, formats."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

from studies.wheel import unlike
from trum_sym.model.inputs import SCHEMA
from trum_sym.sweeps.task import STORE

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
KINDS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
FORMS = sorted(path for path in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml") if path.name != "config.yml")


def test_the_changelog_keeps_its_form():
    lines = (ROOT / "CHANGELOG.md").read_text("utf-8").splitlines()
    versions = [line for line in lines if line.startswith("## ")]
    assert lines[0] == "# Changelog"
    assert versions[0] == "## [Unreleased]"
    assert all(re.fullmatch(r"## \[\d+\.\d+\.\d+\] - \d{4}-\d\d-\d\d", line) for line in versions[1:])
    kinds = [line.removeprefix("### ") for line in lines if line.startswith("###")]
    assert kinds == [kind for kind in KINDS if kind in kinds]  # of one version so far
    assert re.fullmatch(r"\d+\.\d+\.\d+", PROJECT["project"]["version"])


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_is_one_and_says_that_it_was_not_run(path):
    text = path.read_text("utf-8")
    assert "# NOT RUN YET" in text.split("\nname:")[0]
    found = yaml.safe_load(text)
    triggers = found[True]  # YAML 1.1 reads `on` so
    assert triggers
    for job in found["jobs"].values():
        assert all(step.keys() & {"uses", "run"} for step in job["steps"])
        assert {*job.get("needs", [])} <= found["jobs"].keys()
    for script in re.findall(r"python -m (studies\.\w+)", text):
        assert (ROOT / f"{script.replace('.', '/')}.py").is_file()


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.name)
def test_an_issue_form_asks_what_info_prints(path):
    form = yaml.safe_load(path.read_text("utf-8"))
    assert form.keys() >= {"name", "description", "body"}
    assert any("`trum-sym info`" in field["attributes"]["label"] for field in form["body"])
    assert len({field["id"] for field in form["body"]}) == len(form["body"])


def test_wheels_are_tested_with_the_tools_of_the_lock_and_files_that_are_there():
    wheels, extras = PROJECT["tool"]["cibuildwheel"], PROJECT["project"]["optional-dependencies"]
    assert {*wheels["test-requires"]} <= {*extras["dev"]}
    for command in wheels["test-command"]:
        assert all((ROOT / word).exists() for word in command.split() if word.startswith("tests/"))
    oldest = PROJECT["project"]["requires-python"].removeprefix(">=").replace(".", "")
    assert PROJECT["tool"]["scikit-build"]["wheel"]["py-api"] == f"cp{oldest}"
    assert wheels["build"].split()[0] == f"cp{oldest}-*"


def test_the_page_states_the_formats_that_are_written():
    text = (ROOT / "docs" / "releases.md").read_text("utf-8")
    assert f"its `schema`, now {SCHEMA}" in text
    assert f"its `format`, now {STORE}" in text


def test_a_former_name_warns():
    code = "import trum_sym.figures"
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True)
    assert "DeprecationWarning: trum_sym.figures is trum_sym.plots" in done.stderr


def test_two_wheels_that_differ_are_told_apart(tmp_path):
    import zipfile

    for name, text in (("one", "1"), ("other", "2")):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("same", "0")
            archive.writestr("changed", text)
            archive.writestr(name, "")
    assert unlike(tmp_path / "one", tmp_path / "other") == ["changed", "one", "other"]
    assert unlike(tmp_path / "one", tmp_path / "one") == []
