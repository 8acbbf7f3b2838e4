"""The benchmarks run, and what they time computes the same."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest


@pytest.mark.slow
def test_every_section_runs_and_the_step_agrees_in_every_form():
    command = [sys.executable, "-m", "benchmarks", "--quick", "--json", "--only", "step", "map", "start"]
    found = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    assert found["cpu"]
    assert len({row["section"] for row in found["rows"]}) == 3
    assert all(row["value"] > 0 for row in found["rows"])
