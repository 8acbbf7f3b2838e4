"""Every link of a built site leads somewhere in it, and nothing is loaded from a network."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

__all__ = ["check"]

_LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "object": "data", "embed": "src"}
_FETCHED = re.compile(r"""(?:url\(|@import\s)\s*["']?((?:https?:)?//[^"')\s]*)""")
_NAVIGATION = {"canonical", "search", "next", "prev", "index", "genindex"}


class _Page(HTMLParser):
    """What a page has to lead to, what it leads to, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """One element."""
        found = {name: value or "" for name, value in attrs}
        self.names.update(found[name] for name in ("id", "name") if name in found)
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag == "link" and not _NAVIGATION & set(found.get("rel", "").split()):
            self.loads.append(found.get("href", ""))
        if _LOADED.get(tag) in found:
            self.loads.append(found[_LOADED[tag]])


def check(root: Path) -> list[str]:
    """What is wrong with the pages below a folder, a line each; nothing if all is well.

    Links to other sites are left alone; a script, style, picture or font from elsewhere is wrong.
    """
    root = root.resolve()
    pages = {
        path: _Page(path.read_text("utf-8")) for path in sorted(root.rglob("*.html")) if "_static" not in path.parts
    }
    wrong = []
    for path, page in pages.items():
        where = path.relative_to(root).as_posix()
        for link in dict.fromkeys(page.loads):
            parts = urlsplit(link)
            if parts.scheme not in ("", "data") or parts.netloc:
                wrong.append(f"{where}: loads {link}")
            elif not parts.scheme and parts.path and not _target(root, path, parts.path).is_file():
                wrong.append(f"{where}: loads {link}, which is not there")
        for link in dict.fromkeys(page.links):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = _target(root, path, parts.path)
            name = unquote(parts.fragment)
            if not target.is_file():
                wrong.append(f"{where}: {link} is not there")
            elif name and target in pages and name not in pages[target].names:
                wrong.append(f"{where}: {link} has no such place")
    for style in sorted(root.rglob("*.css")):
        for link in _FETCHED.findall(style.read_text("utf-8")):
            wrong.append(f"{style.relative_to(root).as_posix()}: loads {link}")
    return wrong


def _target(root: Path, page: Path, link: str) -> Path:
    """The file that a link means."""
    if not link:
        return page
    target = (page.parent / unquote(link)).resolve() if not link.startswith("/") else root / link.lstrip("/")
    return target / "index.html" if target.is_dir() else target
