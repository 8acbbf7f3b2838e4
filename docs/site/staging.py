"""The site's source: the pages of ``docs/``, those that are made of other sources, and the pictures."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from docs.site import c_header, console, kernels, ledger, records

__all__ = ["stage"]

_MORE = {"architecture.md": "ARCHITECTURE.md", "contributing.md": "CONTRIBUTING.md", "changes.md": "CHANGELOG.md"}
_LEDGER = re.compile(r"\]\((?:\.\./)?generated/ledger\.html(?:#([^)]*))?\)")
_OUTSIDE = re.compile(r"(?<!!)\[([^]]+)\]\(\.\./([^)]*)\)")


def adapted(text: str) -> str:
    """A page of the repository as a page of the site.

    Examples
    --------
    >>> adapted("[24](../generated/ledger.html#eq-24), [C](../examples/c), [words](docs/glossary.md)")
    '[24](ledger/eq-24.md), `examples/c`, [words](glossary.md)'
    """
    text = _LEDGER.sub(lambda found: f"](ledger/{found[1]}.md)" if found[1] else "](ledger/index.md)", text)
    text = _OUTSIDE.sub(lambda found: f"`{found[2]}`", text)
    text = re.sub(r"\$`([^`]*)`\$", r"{math}`\1`", text).replace("```math\n", "```{math}\n")
    for page, source in _MORE.items():
        text = text.replace(f"]({source})", f"]({page})")
    return text.replace("](docs/", "](")


def pages(root: Path) -> dict[str, str]:
    """Every page of the site by its path."""
    found = {path.name: path.read_text("utf-8") for path in (root / "docs").glob("*.md")}
    found |= {name: (root / source).read_text("utf-8") for name, source in _MORE.items()}
    adapted_pages = {name: adapted(text) for name, text in found.items()}
    made = {**ledger.pages(root), **kernels.pages(root), **c_header.pages(root), **records.pages(), **console.pages()}
    return {**adapted_pages, **made}


def stage(root: Path, target: Path) -> None:
    """Write all sources of the site into a folder that holds nothing else."""
    shutil.rmtree(target, ignore_errors=True)
    for name, text in pages(root).items():
        path = target / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    for kind in ("svg", "png"):
        for picture in (root / "docs").rglob(f"*.{kind}"):
            path = target / picture.relative_to(root / "docs")
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(picture, path)
