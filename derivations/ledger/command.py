"""``python -m derivations verify``: re-prove the ledger, or one entry of it."""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from derivations.codegen.emit import GENERATED
from derivations.codegen.kernels import kernels
from derivations.ledger import ENTRIES, entry
from derivations.ledger.model import Entry, confirm
from derivations.ledger.mutate import MUTATED, Outcome, try_misreadings, try_mutants
from derivations.ledger.referee import review
from derivations.ledger.report import record
from derivations.ledger.transcription import copy_of, differences, load
from derivations.proofs.mutants import Slip, kernel_mutants, table_mutants
from derivations.proofs.page import rests_on
from trum_sym.paper.ledger import table, written_out

__all__ = ["as_json", "as_pictures", "check_mutants", "outputs", "prove", "transcription", "verify"]


def _progress(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def prove(entries: tuple[Entry, ...]) -> list[dict[str, Any]]:
    """Confirm entries one by one, with a line of progress each on stderr; returns their records."""
    records = []
    for number, candidate in enumerate(entries, 1):
        start = time.perf_counter()
        result = confirm(candidate)
        records.append(record(result, review(result)))
        problems = records[-1]["problems"]
        state = "NOT CONFIRMED: " + "; ".join(problems) if problems else "confirmed"
        line = f"[{number}/{len(entries)}] ({candidate.id}) {candidate.verdict}: {state}"
        _progress(f"{line}, {time.perf_counter() - start:.1f} s")
    return records


def as_json(records: list[dict[str, Any]]) -> str:
    """The text of ledger.json."""
    said = [{key: value for key, value in record.items() if key != "pictures"} for record in records]
    return json.dumps(said, indent=1, ensure_ascii=False) + "\n"


def as_pictures(records: list[dict[str, Any]]) -> str:
    """The text of ledger.pictures.json, a line an entry."""
    rows = (f"{json.dumps(r['id'])}: {json.dumps(r['pictures'], ensure_ascii=False)}" for r in records)
    return "{\n" + ",\n".join(rows) + "\n}\n"


def _slips(name: str) -> tuple[list[Outcome], list[Outcome], float]:
    """What became of the mutants and misreadings of an entry, their forms left out, and the seconds it took."""
    start, candidate = time.perf_counter(), entry(name)
    found = [
        [replace(outcome, mutant=replace(outcome.mutant, forms={})) for outcome in attempt(candidate)]
        for attempt in (try_mutants, try_misreadings)
    ]
    return found[0], found[1], time.perf_counter() - start


def _all_slips(names: list[str]) -> Iterator[tuple[list[Outcome], list[Outcome], float]]:
    """The same for several entries, in their order, on all processors."""
    if len(names) < 2:
        yield from map(_slips, names)
        return
    with ProcessPoolExecutor() as pool:
        yield from pool.map(_slips, names)


def _tally(what: str, outcomes: list[tuple[str, Outcome]]) -> int:
    """Print the counts and every survivor; returns the number of survivors."""
    kinds = Counter(o.rejected_by.kind for _, o in outcomes if o.rejected_by is not None)
    survivors = [(name, o.mutant) for name, o in outcomes if o.survives]
    equivalent = sum(o.equivalent for _, o in outcomes)
    discarded = sum(o.discarded for _, o in outcomes)
    by_kind = ", ".join(f"{count} by {kind}" for kind, count in kinds.most_common())
    print(
        f"{len(outcomes)} {what}: {kinds.total()} rejected ({by_kind}), {equivalent} proved equivalent, "
        f"{discarded} in what the correction discards, {len(survivors)} surviving"
    )
    for name, mutant in survivors:
        print(f"surviving ({name}) {mutant.name}: {mutant.slip}")
    return len(survivors)


def check_mutants(entries: tuple[Entry, ...]) -> int:
    """Try all mutants and misreadings, on all processors; returns 1 if one goes unnoticed that changes something."""
    names = [e.id for e in entries if e.verdict in MUTATED]
    standing: list[tuple[str, Outcome]] = []
    printed: list[tuple[str, Outcome]] = []
    for name, (mutated, misread, seconds) in zip(names, _all_slips(names), strict=True):
        standing += [(name, outcome) for outcome in mutated]
        printed += [(name, outcome) for outcome in misread]
        _progress(f"({name}) {len(mutated) + len(misread)} slips, {seconds:.1f} s")
    survivors = _tally("mutants of what stands", standing) + _tally("misreadings of misprints", printed)
    return 1 if survivors else 0


def _kernel_slips(name: str) -> list[Slip]:
    """What became of the slips in a kernel, or of those in all tables for no name."""
    if not name:
        from derivations.codegen.emit import render

        return list(table_mutants(render()))
    return list(kernel_mutants(next(kernel for kernel in kernels() if kernel.name == name)))


def check_kernel_mutants() -> int:
    """Try all slips in kernels and tables of numbers, on all processors; returns 1 if one goes unnoticed."""
    names = [*(kernel.name for kernel in kernels()), ""]
    total: Counter[str] = Counter()
    survivors: list[Slip] = []
    with ProcessPoolExecutor() as pool:
        for name, found in zip(names, pool.map(_kernel_slips, names), strict=True):
            rejected, equivalent = sum(s.rejected for s in found), sum(bool(s.equivalent) for s in found)
            total.update(slips=len(found), rejected=rejected, equivalent=equivalent)
            survivors += [s for s in found if not s.rejected and not s.equivalent]
            print(f"{name or 'tables'}: {len(found)} slips, {rejected} rejected, {equivalent} proved equivalent")
    for slip in survivors:
        print(f"surviving in {slip.of}: {slip.what}")
    print(
        f"{total['slips']} slips in {len(names) - 1} kernels and the tables: {total['rejected']} rejected, "
        f"{total['equivalent']} proved equivalent, {len(survivors)} surviving"
    )
    return 1 if survivors else 0


def check_effects(entries: tuple[Entry, ...]) -> int:
    """Recompute every figure of the effects by the second route; returns 1 if one is not what is printed."""
    from derivations.ledger.check_effects import Checked, check

    figures, problems, start = [], [], time.perf_counter()
    for number, candidate in enumerate(entries, 1):
        for found in check((candidate,)):
            if isinstance(found, Checked):
                figures.append(found)
            if isinstance(found, str):
                problems.append(found)
            elif not found.holds:
                text = f"({found.entry}) states {found.figure.printed}, the second route finds {found.again:.8g}"
                problems.append(text)
        _progress(f"[{number}/{len(entries)}] ({candidate.id}) effect, {time.perf_counter() - start:.1f} s in all")
    for problem in problems:
        print(problem)
    worst = max(figures, key=lambda f: f.apart, default=None)
    largest = "" if worst is None else f"; both routes agree to {worst.apart:.1e} relative at worst, ({worst.entry})"
    print(f"{len(figures)} figures of effects recomputed, {len(problems)} do not hold{largest}")
    return 1 if problems else 0


def check_circular(entries: tuple[Entry, ...]) -> int:
    """Shift whatever derivation and judge of an entry both compute with; returns 1 if no evidence notices."""
    from derivations.ledger.circular import unnoticed

    found = 0
    for number, candidate in enumerate(entries, 1):
        shifted, blind = unnoticed(candidate)
        for name in blind:
            print(f"({candidate.id}) rests on {name}, and no evidence notices when that is wrong")
        found += len(blind)
        _progress(f"[{number}/{len(entries)}] ({candidate.id}) {shifted} shared computations shifted")
    print(f"{len(entries)} entries, {found} checks of a thing against itself")
    return 1 if found else 0


def outputs(records: list[dict[str, Any]]) -> dict[Path, str]:
    """What the ledger gives: its records and page, and the pages of the docs that are made of them."""
    from derivations.ledger import article, assumptions, html, protocol
    from derivations.proofs.page import filled

    docs = GENERATED.parent / "docs"
    return {
        GENERATED / "ledger.json": as_json(records),
        GENERATED / "ledger.pictures.json": as_pictures(records),
        GENERATED / "ledger.html": html.page(records, ENTRIES),
        docs / "assumptions.md": assumptions.page(),
        docs / "referee.md": protocol.page(records),
        docs / "article.md": article.page(records),
        docs / "proofs.md": filled((docs / "proofs.md").read_text("utf-8")),
    }


def _write(records: list[dict[str, Any]], check: bool) -> int:
    """Write the outputs, or say which are stale."""
    paths = outputs(records)
    if not check:
        for path, text in paths.items():
            path.write_text(text, "utf-8")
        return 0
    stale = [path.name for path, text in paths.items() if not path.is_file() or path.read_text("utf-8") != text]
    for name in stale:
        _progress(f"{name} is stale: run `python -m derivations verify --write`, read the diff, commit it")
    return 1 if stale else 0


def _show(records: list[dict[str, Any]], json_: bool, one: bool) -> None:
    """Print the records: as JSON, one written out, or a table with the count."""
    if json_:
        print(as_json(records), end="")
    elif one:
        print(written_out(records[0], records[0]["pictures"]))
    else:
        failed = sum(not r["confirmed"] for r in records)
        print(table(records))
        print(f"\n{len(records)} entries, {len(records) - failed} confirmed, {failed} not confirmed")


def verify(
    equation: str | None,
    *,
    json_: bool,
    mutants: bool,
    write: bool,
    check: bool,
    effects: bool = False,
    circular: bool = False,
    second_opinion: bool = False,
    every: int = 1,
) -> int:
    """Run the command; 0 when all is confirmed, 1 when something is not, 2 for an unknown equation."""
    try:
        entries = ENTRIES if equation is None else (entry(equation.strip().strip("()")),)
    except LookupError as error:
        print(f"derivations: {error.args[0]}", file=sys.stderr)
        return 2
    if second_opinion:
        from derivations.ledger.second_opinion import run, run_mutants

        return run_mutants(entries, every) if mutants else run(entries, write=write and equation is None)
    if mutants:
        return check_mutants(entries) | (check_kernel_mutants() if equation is None else 0)
    if effects:
        return check_effects(entries)
    if circular:
        return check_circular(entries)
    records = prove(entries)
    _show(records, json_, equation is not None)
    outputs = _write(records, check) if equation is None and (write or check) else 0
    unjudged = rests_on() - {e.id for e in ENTRIES} if equation is None else set()
    for name in sorted(unjudged):
        print(f"a kernel's proof rests on the entry {name}, which the ledger lacks", file=sys.stderr)
    return 0 if outputs == 0 and not unjudged and all(r["confirmed"] for r in records) else 1


def transcription(*, mutants: bool) -> int:
    """Compare both transcriptions of every entry, or see what changing a character does; 1 if something is amiss."""
    if mutants:
        from derivations.ledger.copy_mutants import copy_mutants, tally

        changed = list(copy_mutants())
        print(tally(changed))
        for mutant in changed:
            if not mutant.noticed:
                print(f"not noticed: {mutant.where}, {mutant.old!r} to {mutant.new!r}")
        return 0 if all(mutant.noticed for mutant in changed) else 1
    found = [line for candidate in ENTRIES for line in differences(candidate)]
    for line in found:
        print(line)
    quotes = [quote for block in load().values() for quote in block["quote"]]
    forms = sum(len(candidate.printed) for candidate in ENTRIES if candidate.id in load())
    doubtful = [candidate.id for candidate in ENTRIES if copy_of(candidate).word == "doubtful"]
    print(f"{len(load())} entries, {len(quotes)} lines quoted, {forms} forms twice: {len(found)} differences")
    print(f"the copy is doubtful in {len(doubtful)}: {', '.join(doubtful)}")
    return 1 if found else 0
