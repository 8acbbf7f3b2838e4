"""``python -m derivations``: ``generate [--check]`` writes generated/, ``verify`` re-proves the ledger,
``transcription`` compares its two copies of the print, ``certificates`` replays those of the algebraic core,
``codecheck`` makes the outputs of codecheck.yml, ``wasm [--check]`` compiles the C library for the report.
"""

from __future__ import annotations

import argparse
import sys

from derivations import error_bound, fixed_grid
from derivations.codegen.emit import GENERATED, render, stale, write
from derivations.codegen.kernels import kernels
from derivations.dimensions import DimensionError
from derivations.proofs import prove


def _generate(check: bool) -> int:
    try:
        files = render()
        prove(kernels(), files)
        error_bound.prove()
        fixed_grid.prove()
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


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"is {text!r}; a whole number from 1 on is needed")
    return int(text)


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m derivations", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    generate = commands.add_parser("generate", help="write generated/ from the derivations")
    generate.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 with a diff if anything is stale"
    )
    proving = commands.add_parser("verify", help="re-prove every equation of the paper, or one")
    proving.add_argument("--equation", metavar="ID", help="the paper's number, such as 6 or A13: its steps written out")
    proving.add_argument("--json", action="store_true", help="records instead of a table")
    proving.add_argument("--mutants", action="store_true", help="see whether the evidence notices every small slip")
    proving.add_argument("--effects", action="store_true", help="recompute the effects' figures by a second route")
    proving.add_argument(
        "--second-opinion", action="store_true", help="ask Maxima; with --mutants, whether it sees slips"
    )
    proving.add_argument("--every", type=_count, default=1, metavar="N", help="of those mutants every N-th only")
    proving.add_argument("--circular", action="store_true", help="look for checks of a thing against itself")
    proving.add_argument("--write", action="store_true", help="write generated/ledger.* and the pages made with it")
    proving.add_argument("--check", action="store_true", help="change nothing; exit 1 if those two are stale")
    copies = commands.add_parser("transcription", help="compare both transcriptions of the paper's equations")
    copies.add_argument("--mutants", action="store_true", help="change 200 characters, one at a time: is each noticed?")
    module = commands.add_parser("wasm", help="compile the C library for the report's interactive part")
    module.add_argument("--check", action="store_true", help="change nothing, need no compiler; exit 1 if it is stale")
    proofs = commands.add_parser("certificates", help="replay the certificates of the algebraic core")
    proofs.add_argument("--write", action="store_true", help="make them and docs/certificates.md anew")
    outside = commands.add_parser("codecheck", help="make what codecheck.yml lists, compare it with what is kept")
    outside.add_argument("out", metavar="OUT", help="the folder to write to")
    options = parser.parse_args(arguments)
    if options.command == "wasm":
        from derivations.codegen.wasm import command

        return command(options.check)
    if options.command == "generate":
        return _generate(options.check)
    if options.command == "certificates":
        from derivations.certificates.command import command as certificates

        return certificates(write=options.write)
    if options.command == "codecheck":
        from derivations.codecheck import command as codecheck

        return codecheck(options.out)
    from derivations.ledger.command import transcription, verify

    if options.command == "transcription":
        return transcription(mutants=options.mutants)
    return verify(
        options.equation,
        json_=options.json,
        mutants=options.mutants,
        write=options.write,
        check=options.check,
        effects=options.effects,
        circular=options.circular,
        second_opinion=options.second_opinion,
        every=options.every,
    )


if __name__ == "__main__":
    sys.exit(main())
