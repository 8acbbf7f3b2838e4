"""``trum-sym motor``: motor files, from a template to a check."""

from __future__ import annotations

from pathlib import Path

import click

from trum_sym.console.options import examples
from trum_sym.console.say import say

__all__ = ["motor"]

_NAME = click.argument("name", metavar="NAME|FILE")


@click.group(
    epilog=examples("trum-sym motor new my.toml", "trum-sym motor check my.toml", "trum-sym motor show trum60")
)
def motor() -> None:
    """Motor files: a template to begin with, checks, lists, differences."""


@motor.command(
    "new",
    epilog=examples("trum-sym motor new my.toml", "trum-sym motor new my.toml --name 'PMT-30' --like trum60"),
)
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE.toml")
@click.option("--name", metavar="TEXT", help="The motor's name.  [default: the file's]")
@click.option("--like", default="trum60", show_default=True, metavar="NAME|FILE", help="Whose values stand in it.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
def new(file: Path, name: str | None, like: str, force: bool) -> None:
    """Write a motor file to fill in: every parameter with its unit, range and meaning.

    Its values are those of another motor until they are replaced; every answer marks what is still to do.
    """
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.motor_schema import template
    from trum_sym.output.files import check_new, write_bytes

    check_new("FILE.toml", file, (".toml",), force)
    text = template(file.stem if name is None else name, load_motor(like))
    write_bytes("FILE.toml", text.encode(), file)
    say(f"{file}: fill it in; trum-sym motor check {file} says what is left to do")


@motor.command("show", epilog=examples("trum-sym motor show", "trum-sym motor show trum60 --json"))
@click.argument("name", metavar="[NAME|FILE]", default="trum60")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table.")
def show(name: str, as_json: bool) -> None:
    """Every value of a motor with its unit, source and range."""
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.motor_tables import as_dict, as_table

    found = load_motor(name)
    if as_json:
        from trum_sym.output.json_text import json_text

        say(json_text(as_dict(found)))
    else:
        say(as_table(found))


@motor.command("check", epilog=examples("trum-sym motor check trum60", "trum-sym motor check my.toml"))
@_NAME
def check(name: str) -> int:
    """What is left to do in a motor file, assumed, out of range or contradictory.

    Exit code 1 where values contradict each other, are those of no such material, or are left to do.
    """
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.motor_tables import checked
    from trum_sym.inputs.plausible import unquestioned
    from trum_sym.model.stator import above_free

    with unquestioned():
        found = load_motor(name)
    text, good = checked(found, above_free(found))
    say(text)
    return 0 if good else 1


@motor.command("diff", epilog=examples("trum-sym motor diff trum60 my.toml"))
@click.argument("one", metavar="NAME|FILE")
@click.argument("other", metavar="NAME|FILE")
def diff(one: str, other: str) -> None:
    """The values in which two motors differ."""
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.inputs.motor_tables import differences

    say(differences(load_motor(one), load_motor(other), (one, other)))


@motor.command("schema", epilog=examples("trum-sym motor schema", "trum-sym motor schema --format markdown"))
@click.option(
    "--format",
    "form",
    type=click.Choice(("json", "markdown")),
    default="json",
    show_default=True,
    help="A JSON Schema for editors, or the page of the docs.",
)
def schema(form: str) -> None:
    """What a motor file may say."""
    from trum_sym.inputs.motor_schema import page
    from trum_sym.inputs.motor_schema import schema as schema_of

    if form == "markdown":
        say(page().rstrip())
    else:
        import json

        say(json.dumps(schema_of(), indent=1))
