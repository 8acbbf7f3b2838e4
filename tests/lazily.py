"""Modules that are imported at their first use, so that collecting the tests does not wait for SymPy or numba.

``importlib.util.LazyLoader`` and ``lazy_loader`` do not serve here: pytest asks every global of a test module for its
class, which loads theirs.
"""

from __future__ import annotations

from importlib import import_module


class lazily:
    """A module by its full name; ``monkeypatch.setattr`` needs the module's name in its place."""

    def __init__(self, name):
        self.name = name

    def __getattr__(self, attribute):
        if attribute.startswith(("__", "_pytest", "_mock")):  # pytest's questions
            raise AttributeError(attribute)
        return getattr(import_module(self.name), attribute)
