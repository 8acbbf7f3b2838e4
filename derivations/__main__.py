"""``python -m derivations generate [--check]``: write generated/, or say what is stale."""

from __future__ import annotations

import argparse
import sys

from derivations.dimensions import DimensionError
from derivations.emit import GENERATED, render, stale, write


def _generate(check: bool) -> int:
    try:
        files = render()
    except (ArithmeticError, DimensionError) as error:
        print(f"derivations: a proof fails: {error}", file=sys.stderr)
        return 1
    if not check:
        changed = write(files)
        print(f"{len(files)} files in {GENERATED.name}/, {len(changed)} changed" + "".join(f"\n  {n}" for n in changed))
        return 0
    difference = stale(files)
    if not difference:
        print(f"{GENERATED.name}/ is what the derivations give ({len(files)} files)")
        return 0
    print(difference, end="")
    print(
        f"\n{GENERATED.name}/ is stale: run `python -m derivations generate`, read the diff, commit it", file=sys.stderr
    )
    return 1


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m derivations", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    generate = commands.add_parser("generate", help="write generated/ from the derivations")
    generate.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 with a diff if anything is stale"
    )
    options = parser.parse_args(arguments)
    return _generate(options.check)


if __name__ == "__main__":
    sys.exit(main())
