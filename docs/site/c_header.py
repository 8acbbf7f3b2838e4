"""The C library's interface as a page: what its header declares, with the comment before each."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["pages"]

_FIELD = re.compile(r'X\((\w+), (\w+), "([^"]*)", (.*?)\)(?: \\)?$', re.MULTILINE)


def _comment(text: str) -> str:
    return " ".join(line.strip().lstrip("*").strip() for line in text.strip().splitlines())


def _declarations(header: str) -> str:
    parts = []
    text = header[header.index("#define TRUM_CHOICE_FIELD") :]
    for found in re.finditer(r"^(?:struct|enum|const|int|trum)[^;{]*(?:\{.*?^\})?;", text, re.MULTILINE | re.DOTALL):
        before = re.search(r"/\*((?:[^*]|\*(?!/))*)\*/\n\Z", text[: found.start()])
        name = re.search(r"(trum_\w+)(?:\(| \{)", found[0])
        if name is None:
            continue
        said = _comment(before[1]) if before else ""
        parts.append(f"## `{name[1]}`\n\n{said}\n\n```c\n{found[0]}\n```\n")
    return "\n".join(parts)


def _fields(fields: str, macro: str) -> str:
    body = fields[fields.index(f"#define {macro}(X)") :].split("\n\n")[0]
    rows = [f"| `{name}` | {symbol} | {unit} |" for name, symbol, unit, _ in _FIELD.findall(body)]
    return "| field | symbol | SI unit |\n|---|---|---|\n" + "\n".join(rows)


def pages(root: Path) -> dict[str, str]:
    """The page of the header."""
    header = (root / "trum_sym" / "_driver" / "trum.h").read_text("utf-8")
    fields = (root / "generated" / "trum_fields.h").read_text("utf-8")
    head = _comment(header[2 : header.index("*/")])
    tables = [
        f"## Fields of `{struct}`\n\n{_fields(fields, macro)}\n"
        for struct, macro in (("struct trum_motor", "TRUM_MOTOR_FIELDS"), ("struct trum_drive", "TRUM_DRIVE_FIELDS"))
    ]
    text = f"# The C header\n\n{head}  How to use it: [the C library](c-library.md).\n\n{_declarations(header)}\n"
    return {"c-header.md": text + "\n" + "\n".join(tables)}
