"""Every command that the documents show is there, with every option."""

from __future__ import annotations

import re
from pathlib import Path

import click
import pytest

from trum_sym import console

ROOT = Path(__file__).parents[2]
PAGES = ["README.md", *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").glob("*.md"))]


def shown(text):
    """Words of each command line: in a block of its own, going on after a backslash, or between backticks."""
    text = text.replace("\\\n", " ")
    lines = re.findall(r"^ {4}(?:\S+/)?trum-sym (.*)$", text, re.MULTILINE)
    return [line.split() for line in lines + re.findall(r"`trum-sym ([^`]*)`", text)]


def wrong(words):
    """The first word that no command has; None if all is well."""
    command = console._cli
    for word in words:
        name = word.split("=")[0].rstrip(",.:;")
        if isinstance(command, click.Group):
            if name.startswith("-"):
                return None  # of all commands
            if name not in command.commands:
                return name
            command = command.commands[name]
        elif re.fullmatch(r"--(?!help)[a-z][a-z-]*", name) and not any(name in p.opts for p in command.params):
            return name
    return None


@pytest.mark.parametrize("page", PAGES)
def test_commands_and_options_that_a_page_shows_are_there(page):
    assert [(words, bad) for words in shown((ROOT / page).read_text("utf-8")) if (bad := wrong(words))] == []
