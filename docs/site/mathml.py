"""Formulas as MathML, which browsers draw by themselves: no script, no network."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from latex2mathml.converter import convert

if TYPE_CHECKING:
    from sphinx.application import Sphinx

__all__ = ["setup"]


def _markup(latex: str, display: str) -> str:
    """A formula, indices of several letters upright."""
    return str(convert(re.sub(r"_\{([A-Za-z]{2,}\d?)\}", r"_{\\mathrm{\1}}", latex), display=display))


def _inline(translator: Any, node: Any) -> None:  # noqa: ANN401
    translator.body.append(_markup(node.astext(), "inline"))


def _block(translator: Any, node: Any) -> None:  # noqa: ANN401
    translator.body.append(f'<div class="formula" tabindex="0">{_markup(node.astext(), "block")}</div>')


def _skipping(visit: Any) -> Any:  # noqa: ANN401
    def visited(translator: Any, node: Any) -> None:  # noqa: ANN401
        from docutils.nodes import SkipNode

        visit(translator, node)
        raise SkipNode

    return visited


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.add_html_math_renderer("mathml", (_skipping(_inline), None), (_skipping(_block), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
