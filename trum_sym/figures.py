"""The former name of :mod:`trum_sym.plots`; use that."""

from __future__ import annotations

from trum_sym.plots import *  # noqa: F403
from trum_sym.plots import __all__  # noqa: F401
