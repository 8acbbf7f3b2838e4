"""Collecting the tests, which every process of a run does, waits for no large library."""

from __future__ import annotations

LARGE = {"distributed", "matplotlib", "numba", "pandas", "scipy.optimize", "scipy.stats", "selenium", "sympy", "zarr"}


def test_collecting_imports_no_large_library(loaded_by_collecting):
    assert loaded_by_collecting & LARGE == set(), "import it where it is used, or by lazily()"
