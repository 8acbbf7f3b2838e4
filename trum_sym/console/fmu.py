"""``trum-sym fmu``."""

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

__all__ = ["fmu"]


@click.command(
    epilog=examples("trum-sym fmu motor.fmu", "trum-sym fmu motor.fmu --load-torque '0.1 N m' --sources-only")
)
@click.argument("file", type=click.Path(path_type=Path), metavar="OUT.fmu")
@click.option("--fmi", type=click.Choice(["3", "2"]), default="3", show_default=True, help="Version of the standard.")
@click.option("--sources-only", is_flag=True, help="Do not compile it for this machine.")
@force_option
@continuous_options
def fmu(
    file: Path,
    fmi: str,
    sources_only: bool,
    force: bool,
    motor: str,
    overrides: tuple[str, ...],
    **options: Any,  # noqa: ANN401
) -> None:
    """Write the motor as a co-simulation unit of FMI, with its C source and compiled for this machine.

    Prepressure, frequency difference, load and pulse counts are inputs, which start as the options say; speed, angle,
    encoder counts and the phases' amplitudes are outputs.
    """
    from trum_sym.c_library.fmu import built
    from trum_sym.output.files import check_new, write_bytes

    check_new("OUT.fmu", file, (".fmu",), force)
    content, names = built(
        chosen_motor(motor, overrides),
        chosen_drive(options),
        chosen_levels(options),
        fmi=int(fmi),
        binary=not sources_only,
    )
    write_bytes("OUT.fmu", content, file)
    machines = [name.split("/")[1] for name in names if name.startswith("binaries/")]
    say(f"{file}: source, {'compiled for ' + machines[0] if machines else 'not compiled'}")
