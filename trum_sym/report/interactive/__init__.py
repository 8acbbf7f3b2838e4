"""The report's interactive part: the C library as WebAssembly with sliders, as a piece of an HTML page."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.motor import UNCOUPLED, Motor
from trum_sym.inputs.motor_file import SHIPPED, motor_text
from trum_sym.model.levels import LEVEL_NAMES

__all__ = ["fragment"]

_FOLDER = Path(__file__).parent
_PARTS = ("interactive.css", "fragment.html", "moving.js", "interactive.js")


def fragment(motor: Motor) -> str:
    """Style, markup, module and script: all that a page needs of it, in one piece.

    It stands alone, and takes the page's colours where the page sets ``--ink``, ``--soft``, ``--line``, ``--wash`` and
    ``--page``; ``data-theme="dark"`` or ``"light"`` on the root overrules the reader's preference.

    Parameters
    ----------
    motor : Motor
        Whose values the page begins with; single numbers, no arrays.

    Raises
    ------
    ParameterError
        For a motor with arrays.
    """
    given = {name: parameter.value for name, parameter in motor.parameters()}
    values = {}
    for name in UNCOUPLED:
        value = given.get(name, 0.0)  # 0 stands for a value that the model finds
        if not isinstance(value, float | int) and value.ndim:
            raise ParameterError(name, f"an array of shape {value.shape}", "a single number")
        values[name] = float(value)
    read = {name: (_FOLDER / name).read_text("utf-8") for name in _PARTS}
    module = base64.b64encode((_FOLDER / "motor.wasm").read_bytes()).decode("ascii")
    return (
        f"<style>\n{read['interactive.css']}</style>\n{read['fragment.html']}"
        f'<script type="application/json" id="trum-values">{json.dumps(values)}</script>\n'
        f'<script type="application/json" id="trum-motor">{json.dumps(_as_given(motor))}</script>\n'
        f'<script type="text/plain" id="trum-module">{module}</script>\n'
        f"<script>\n{read['moving.js']}</script>\n<script>\n{read['interactive.js']}</script>\n"
    )


def _as_given(motor: Motor) -> dict[str, Any]:
    """What a command needs to take the same motor: its name or that of a file to put in; what is set; levels."""
    named = next((name for name in SHIPPED if motor_text(name) == motor.text), "my.toml")
    changed = {name: parameter.value for name, parameter in motor.parameters() if parameter.source == "set"}
    return {"motor": named, "set": changed, "levels": LEVEL_NAMES}
