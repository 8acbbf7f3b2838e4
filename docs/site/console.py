"""The console as pages, one a command, from its own help."""

from __future__ import annotations

from typing import Any

import click

from trum_sym import console

__all__ = ["pages"]


def _page(name: str, command: click.Command) -> str:
    word = name.replace("-", "_")
    nested = "\n   :nested: full" if isinstance(command, click.Group) else ""
    return f".. click:: trum_sym.console.{word}:{word}\n   :prog: trum-sym {name}{nested}\n"


def pages() -> dict[str, str]:
    """The pages of all commands and their index, by path."""
    group: Any = console._cli
    commands: dict[str, click.Command] = dict(group.commands)
    rows = "\n".join(
        f"| [`trum-sym {name}`](console/{name}.rst) | {command.get_short_help_str(200)} |"
        for name, command in commands.items()
    )
    tree = "\n".join(f"console/{name}" for name in commands)
    text = (
        f"# Console\n\n{(group.help or '').strip()}\n\n| command | what it does |\n|---|---|\n{rows}\n\n"
        "Tab completes names and options once the shell has read `_TRUM_SYM_COMPLETE=bash_source trum-sym` "
        f"(or `zsh_source`, `fish_source`).\n\n```{{toctree}}\n:hidden:\n\n{tree}\n```\n"
    )
    found = {f"console/{name}.rst": _page(name, command) for name, command in commands.items()}
    return {"console.md": text, **found}
