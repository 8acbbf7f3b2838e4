"""The cells of a page, run: what a page shows below a prompt is what Python prints."""

from __future__ import annotations

import ast
import doctest
import re

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def cells(page):
    """The cells of a Markdown page, in the order in which they stand; each a doctest's text."""
    return re.findall(r"^```pycon\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S)


def wrong(page, names=None):
    """What the cells of a page print that stands otherwise below them; all of them share their names."""
    said, shared = [], {} if names is None else names
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=FLAGS)
    for number, text in enumerate(cells(page), 1):
        test = parser.get_doctest(text, shared, f"{page.name}, cell {number}", str(page), 0)
        runner.run(test, out=said.append, clear_globs=False)
        shared.update(test.globs)
    return "".join(said)


def not_to_be_pasted(page):
    """Blocks that Python's prompt would not end before the next line of their cell: it asks for an empty line."""
    parser = doctest.DocTestParser()
    found = []
    for text in cells(page):
        *before, _ = parser.get_examples(text)
        blocks = (example.source for example in before)
        found += [block for block in blocks if hasattr(ast.parse(block).body[0], "body")]
    return found
