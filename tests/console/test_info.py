"""``trum-sym info`` says what is installed and runs; a report of a fault begins with it."""

from __future__ import annotations

import json
import platform
from importlib.metadata import version

from trum_sym import _kernels
from trum_sym.console import main


def test_it_has_versions_instruction_sets_formats_and_levels(capsys):
    assert main(["info", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["trum_sym"] == version("trum-sym")
    assert platform.python_version() in found["python"]
    assert found["libraries"]["numpy"] == version("numpy")
    assert len(found["instruction_sets"]) == len(_kernels.instruction_sets())
    assert found["made_of"] == _kernels.made_of
    assert found["levels"]["contact"] == ["winkler", "hertz"]
    assert main(["evaluate", "--json"]) == 0
    assert found["formats"]["json"] == json.loads(capsys.readouterr().out)["schema"]


def test_the_lines_say_the_same_without_a_package_that_is_missing(capsys, monkeypatch):
    from trum_sym.console import info

    monkeypatch.setattr(info, "_LIBRARIES", ("numpy", "no-such-package"))
    assert main(["info"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["trum-sym", version("trum-sym")]
    assert any(line.endswith("no-such-package -") for line in lines)
    assert all(len(line) <= 120 for line in lines)
