"""``python -m derivations certificates``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from derivations.certificates import checker
from derivations.certificates.make import as_json, make
from derivations.certificates.page import page
from derivations.certificates.reading import misread
from derivations.certificates.sources import SOURCES

__all__ = ["DATA", "command"]

DATA = Path(__file__).parent / "data"


def command(*, write: bool) -> int:
    """Replay all certificates as they lie in their files; 1 if one is refused, misread or stale."""
    from derivations.codegen.emit import GENERATED

    made = {source.name: make(source.name) for source in SOURCES}
    records = json.loads((GENERATED / "ledger.json").read_text("utf-8"))
    texts = {DATA / f"{name}.json": as_json(one) for name, one in made.items()}
    texts[GENERATED.parent / "docs" / "certificates.md"] = page(made.values(), records)
    if write:
        for path in DATA.glob("*.json"):
            path.unlink()
        for path, text in texts.items():
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, "utf-8")
    problems = [
        f"{path.name} is stale: run `python -m derivations certificates --write`"
        for path, text in texts.items()
        if not path.is_file() or path.read_text("utf-8") != text
    ]
    claims = 0
    for path in sorted(DATA.glob("*.json")):
        certificate = json.loads(path.read_text("utf-8"))
        try:
            checker.check(certificate)
            claims += len(certificate["claims"])
        except ValueError as error:
            problems.append(f"{path.name}: {error}")
        problems += [f"{path.name}: {problem}" for problem in misread(certificate)]
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(made)} certificates, {claims} claims replayed, {len(problems)} problems")
    return 1 if problems else 0
