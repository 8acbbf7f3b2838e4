"""The outputs that codecheck.yml lists, made anew into a folder and compared with those kept here."""

from __future__ import annotations

import sys
from pathlib import Path

from derivations.certificates.make import as_json, make
from derivations.certificates.page import page as certificates_page
from derivations.certificates.sources import SOURCES
from derivations.ledger import ENTRIES
from derivations.ledger.command import outputs, prove

__all__ = ["ROOT", "command", "listed"]

ROOT = Path(__file__).parents[1]


def listed() -> list[str]:
    """The files of the manifest."""
    lines = (ROOT / "codecheck.yml").read_text("utf-8").splitlines()
    return [line.split("file:")[1].strip() for line in lines if "file:" in line]


def _made() -> dict[str, str]:
    """Every output by its path from the root."""
    records = prove(ENTRIES)
    found = {str(path.relative_to(ROOT)): text for path, text in outputs(records).items()}
    certificates = [make(source.name) for source in SOURCES]
    found["docs/certificates.md"] = certificates_page(certificates, records)
    found |= {f"derivations/certificates/data/{one['name']}.json": as_json(one) for one in certificates}
    return found


def command(folder: str) -> int:
    """Make what the manifest lists; 1 if a file of it is not what is kept here or is made by nothing."""
    target = Path(folder)
    if target.exists() and not target.is_dir():
        print(f"derivations: OUT is {folder!r}, a file; a folder is needed", file=sys.stderr)
        return 2
    made, wrong = _made(), 0
    for name in listed():
        text = made.get(name)
        if text is not None:
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            (target / name).write_text(text, "utf-8")
        kept = (ROOT / name).read_text("utf-8") if (ROOT / name).is_file() else None
        state = (
            "made by nothing" if text is None else "as kept here" if text == kept else "DIFFERS from what is kept here"
        )
        wrong += text is None or text != kept
        print(f"{name}: {state}")
    return 1 if wrong else 0
