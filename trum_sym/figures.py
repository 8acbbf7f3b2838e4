"""The former name of :mod:`trum_sym.plots`; use that."""

from __future__ import annotations

import warnings

from trum_sym.plots import *  # noqa: F403
from trum_sym.plots import __all__  # noqa: F401

warnings.warn("trum_sym.figures is trum_sym.plots; the former name will go", DeprecationWarning, stacklevel=2)
