"""``trum-sym c-library``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    chosen_drive,
    chosen_levels,
    chosen_motor,
    continuous_options,
    examples,
    force_option,
)
from trum_sym.console.say import say

__all__ = ["c_library"]


@click.command(
    "c-library",
    epilog=examples(
        "trum-sym c-library my-library",
        "trum-sym c-library my-library --real float --fix-levels --amalgamated",
    ),
)
@click.argument("folder", type=click.Path(path_type=Path), metavar="DIR")
@click.option(
    "--real", type=click.Choice(("double", "float")), default="double", show_default=True, help="Type of all numbers."
)
@click.option("--fix-levels", is_flag=True, help="Compile levels, start and load in; without it they are free.")
@click.option("--amalgamated", is_flag=True, help="One pair trum.h, trum.c.")
@force_option
@continuous_options
def c_library(
    folder: Path,
    real: str,
    fix_levels: bool,
    amalgamated: bool,
    force: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> None:
    """Write the C library for a controller: sources, the motor's numbers, an example, Makefile and CMake file.

    The example computes the point that the options say.
    """
    from trum_sym.c_library.export import check_folder, exported, write_folder

    check_folder("DIR", folder, force)
    drive, levels = chosen_drive(options), chosen_levels(options)
    files = exported(chosen_motor(motor, overrides), drive, levels, real=real, fixed=fix_levels, single=amalgamated)
    write_folder("DIR", files, folder)
    say(f"{folder}: {len(files)} files; make -C {folder} && {folder}/example")
