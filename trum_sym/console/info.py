"""``trum-sym info``."""

from __future__ import annotations

from typing import Any

import click

from trum_sym.console.options import examples
from trum_sym.console.say import say

__all__ = ["info"]

# What the extras bring, by the name under which it is installed
_LIBRARIES = (
    "numpy",
    "casadi",
    "scipy",
    "xarray",
    "h5netcdf",
    "zarr",
    "distributed",
    "pyarrow",
    "matplotlib",
    "jinja2",
)


@click.command(epilog=examples("trum-sym info", "trum-sym info --json"))
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def info(as_json: bool) -> None:
    """Versions, instruction set and levels of the model: what a report of a fault should begin with."""
    import textwrap

    found = _found()
    if as_json:
        from trum_sym.output.json_text import json_text

        say(json_text(found))
        return
    sets = found["instruction_sets"]
    say(f"trum-sym      {found['trum_sym']}")
    say(f"python        {found['python']}, {found['platform']}")
    say(f"kernels       {found['kernels']}, made of {found['made_of'][:12] or 'unknown sources'}")
    say(f"instructions  {sets[-1]} of {', '.join(sets)}")
    say(f"formats       JSON {found['formats']['json']}, sweep store {found['formats']['store']}")
    libraries = ", ".join(f"{name} {version or '-'}" for name, version in found["libraries"].items())
    say(textwrap.fill(libraries, 100, initial_indent="libraries     ", subsequent_indent=" " * 14))
    for name, words in found["levels"].items():
        say(f"{name:13} {', '.join(words)}")


def _found() -> dict[str, Any]:
    """What is installed and what it runs on."""
    import platform
    import sys
    from dataclasses import fields
    from importlib.metadata import PackageNotFoundError, version
    from pathlib import Path

    from trum_sym import _kernels
    from trum_sym.model.inputs import SCHEMA
    from trum_sym.model.levels import Levels
    from trum_sym.sweeps.task import STORE

    libraries: dict[str, str | None] = {}
    for name in _LIBRARIES:
        try:
            libraries[name] = version(name)
        except PackageNotFoundError:
            libraries[name] = None
    baselines = {"x86_64": "sse2", "AMD64": "sse2", "aarch64": "neon", "arm64": "neon"}
    baseline = baselines.get(platform.machine(), "baseline")
    sets = [code.removeprefix("orbit_").replace("baseline", baseline) for code in _kernels.instruction_sets()]
    return {
        "trum_sym": version("trum-sym"),
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "platform": f"{sys.platform} {platform.machine()}",
        "kernels": Path(_kernels.__file__ or "").name,
        "made_of": _kernels.made_of,
        "instruction_sets": sets,
        "formats": {"json": SCHEMA, "store": STORE},
        "libraries": libraries,
        "levels": {level.name: list(level.metadata["words"]) for level in fields(Levels)},
    }
