"""The house: which package may know which, and no circles (the contracts stand in pyproject.toml)."""

from __future__ import annotations

from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports


def test_no_package_imports_one_above_it_and_there_are_no_circles():
    assert lint_imports(no_cache=True) == EXIT_STATUS_SUCCESS
