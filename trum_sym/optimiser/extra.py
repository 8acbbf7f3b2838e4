"""CasADi, or what to install."""

from __future__ import annotations

from trum_sym.errors import MissingExtraError

try:
    import casadi
except ImportError as error:
    raise MissingExtraError("the optimiser", str(error.name or "casadi"), "optimize") from None

__all__ = ["casadi"]
