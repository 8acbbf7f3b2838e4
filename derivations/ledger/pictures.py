"""Pictures of the ledger as inline SVG, the same bytes on every run."""

from __future__ import annotations

import io
import re
from typing import Any

import matplotlib

from derivations.ledger.model import Picture

__all__ = ["svg"]

_STYLES = ("-", "--", "-.", ":")


def svg(picture: Picture, salt: str) -> str:
    """The curves as an SVG element; text stays text, ids are salted so that pictures do not share them."""
    settings: dict[Any, Any] = {
        "svg.hashsalt": salt,
        "svg.fonttype": "none",
        "font.family": "sans-serif",
        "font.size": 9,
    }
    with matplotlib.rc_context(settings):
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7.2, 3.0), layout="constrained")
        FigureCanvasSVG(figure)
        axes = figure.add_subplot()
        for index, (label, (x, y)) in enumerate(picture.curves.items()):
            rounded = [float(f"{v:.5g}") for v in y]
            axes.plot([float(f"{v:.6g}") for v in x], rounded, _STYLES[index % 4], label=label, linewidth=1.3)
        axes.set_xlabel(picture.abscissa)
        axes.set_ylabel(picture.ordinate)
        axes.set_title(picture.title, fontsize=9)
        axes.grid(visible=True, linewidth=0.3)
        axes.legend(frameon=False)
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    element = text[text.index("<svg") :]
    element = re.sub(r"<metadata>.*?</metadata>", "", element, flags=re.S)
    element = re.sub(r' xmlns(:xlink)?="[^"]*"', "", element).replace("xlink:href", "href")
    ids = sorted(set(re.findall(r'id="([^"]+)"', element)), key=len, reverse=True)
    for old in ids:
        element = re.sub(rf'(id="|#){re.escape(old)}(?=["\)])', rf"\g<1>{salt}-{old}", element)
    return element
