"""``python -m derivations verify``: re-prove the ledger, or one entry of it."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

from derivations.ledger import ENTRIES, entry
from derivations.ledger.model import Entry, confirm
from derivations.ledger.report import record, table, written_out

__all__ = ["prove", "verify"]


def prove(entries: tuple[Entry, ...]) -> list[dict[str, Any]]:
    """Confirm entries one by one, with a line of progress each on stderr; returns their records."""
    records = []
    for number, candidate in enumerate(entries, 1):
        start = time.perf_counter()
        result = confirm(candidate)
        records.append(record(result))
        state = "confirmed" if result.confirmed else "NOT CONFIRMED: " + "; ".join(result.problems)
        line = f"[{number}/{len(entries)}] ({candidate.id}) {candidate.verdict}: {state}"
        print(f"{line}, {time.perf_counter() - start:.1f} s", file=sys.stderr, flush=True)
    return records


def verify(equation: str | None, as_json: bool) -> int:
    """Run the command; 0 when all is confirmed, 1 when something is not, 2 for an unknown equation."""
    try:
        entries = ENTRIES if equation is None else (entry(equation.strip("()")),)
    except LookupError as error:
        print(f"derivations: {error.args[0]}", file=sys.stderr)
        return 2
    records = prove(entries)
    if as_json:
        print(json.dumps(records, indent=1, ensure_ascii=False))
    elif equation is not None:
        print(written_out(records[0]))
    else:
        failed = sum(not r["confirmed"] for r in records)
        print(table(records))
        print(f"\n{len(records)} entries, {len(records) - failed} confirmed, {failed} not confirmed")
    return 0 if all(r["confirmed"] for r in records) else 1
