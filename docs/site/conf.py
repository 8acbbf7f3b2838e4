"""Sphinx's settings; ``python -m docs`` builds with them."""

from __future__ import annotations

import re
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parents[2]))

project = "trum_sym"
author = "the authors of trum_sym"
version = release = version_of("trum-sym")
extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
    "sphinx_click",
    "sphinx_copybutton",
    "sphinx_design",
    "docs.site.mathml",
]
html_theme = "pydata_sphinx_theme"
html_title = "trum_sym"
html_static_path = [str(Path(__file__).parent / "static")]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_show_sourcelink = False
html_copy_source = False
html_show_search_summary = False  # it would be fetched, which a browser refuses where no server is
html_sidebars: dict[str, list[str]] = {"index": [], "tutorial": []}
html_theme_options = {
    "show_prev_next": False,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_toc_level": 2,
    "collapse_navigation": True,
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_context = {"default_mode": "auto"}
html_math_renderer = "mathml"

highlight_language = "text"
smartquotes = False  # "--option" is what is typed
myst_enable_extensions = ["colon_fence", "dollarmath", "attrs_inline"]
myst_heading_anchors = 4
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
copybutton_exclude = ".linenos, .gp, .go"

autodoc_typehints = "none"  # the docstrings say it with units
autodoc_default_options = {"members": True}
autosummary_generate = True
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
nitpicky = True
viewcode_follow_imported_members = True
templates_path = [str(Path(__file__).parent / "templates")]
python_use_unqualified_type_names = True


def _without_ways_back(_: Sphinx, page: str, __: str, context: dict[str, Any], ___: object) -> None:
    """Leave out the links from sources to docs: a name that is loaded lazily is documented in another module."""
    if page.startswith("_modules/") and "body" in context:
        context["body"] = re.sub(r'<a class="viewcode-back"[^>]*>.*?</a>', "", context["body"])


def setup(app: Sphinx) -> None:
    """Sphinx's hook."""
    app.connect("html-page-context", _without_ways_back)
