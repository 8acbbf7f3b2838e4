"""What every answer can be turned into, by the same names: a dictionary, JSON, text."""

from __future__ import annotations

from typing import Any

from trum_sym.output.json_text import json_text

__all__ = ["Result"]


class Result:
    """A result that knows its inputs.  Its classes say what :meth:`to_dict` and :meth:`to_text` hold."""

    def to_dict(self) -> dict[str, Any]:
        """Inputs, figures, remarks and units by name, in SI units."""
        raise NotImplementedError

    def to_text(self) -> str:
        """For people, in the units that they read."""
        raise NotImplementedError

    def to_json(self) -> str:
        """The same as :meth:`to_dict`, as a JSON object; null where a number has no meaning or is infinite."""
        return json_text(self.to_dict())

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self.to_text())}</pre>"
