"""``trum-sym report``."""

from __future__ import annotations

from pathlib import Path

import click

from trum_sym.console.options import chosen_motor, examples
from trum_sym.console.say import say

__all__ = ["report"]


@click.command(epilog=examples("trum-sym report out"))
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--motor", default="trum60", show_default=True, metavar="NAME|FILE", help="Motor: trum60 or a TOML file.")
@click.option("--set", "overrides", multiple=True, metavar="NAME=VALUE", help="Replace a value of the motor file.")
def report(folder: Path, motor: str, overrides: tuple[str, ...]) -> None:
    """The paper's figures, tables and claims, redrawn and judged: DIR/index.html, which needs no network.

    The ledger of equations is written beside it, DIR/ledger.html.
    """
    machine = chosen_motor(motor, overrides)
    from trum_sym.report.output import check_folder, write_report

    check_folder("DIR", folder)
    path = write_report(machine, folder, progress=True)
    say(f"{path}: {path.stat().st_size / 1e6:.1f} MB, the ledger beside it")
