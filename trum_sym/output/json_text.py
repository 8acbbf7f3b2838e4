"""Results as JSON: null where a number has no meaning or is infinite, since JSON knows finite numbers only."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

__all__ = ["finite", "json_text"]


def finite(value: Any) -> Any:  # noqa: ANN401
    """A value with None in place of every number that is not finite, at any depth.

    Examples
    --------
    >>> finite({"speed": float("nan"), "cases": [1.0, float("inf")]})
    {'speed': None, 'cases': [1.0, None]}
    """
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {name: finite(entry) for name, entry in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [finite(entry) for entry in value]
    return value


def json_text(record: Mapping[str, Any]) -> str:
    """One JSON object, a line an entry."""
    import json

    return json.dumps(finite(record), indent=1, allow_nan=False)
