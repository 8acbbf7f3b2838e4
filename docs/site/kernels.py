"""The compiled kernels as a page: arguments and results with units, operations, equations; from the manifest."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

__all__ = ["Kernel", "load", "pages"]


@dataclass(frozen=True)
class Kernel:
    """A kernel, as the manifest has it."""

    name: str
    title: str
    inputs: list[dict[str, Any]]
    outputs: list[dict[str, Any]]
    operations: dict[str, int]

    @property
    def place(self) -> str:
        """Its place on the page."""
        return self.name.replace("_", "-")

    @property
    def equations(self) -> set[str]:
        """The equations that its title names.

        Examples
        --------
        >>> sorted(Kernel("", "Resonance at every level (eqs. 3 to 6)", [], [], {}).equations)
        ['3', '4', '5', '6']
        >>> sorted(Kernel("", "Both phases (eqs. 9, 10), determinant (eqs. 24, A5)", [], [], {}).equations)
        ['10', '24', '9', 'A5']
        """
        return set(_numbers(self.title))


def _numbers(title: str) -> Iterator[str]:
    for listed in re.findall(r"eqs?\. ((?:A?\d+(?:, | to )?)+)", title):
        yield from re.findall(r"A?\d+", listed)
        for low, high in re.findall(r"(\d+) to (\d+)", listed):
            yield from map(str, range(int(low), int(high)))


def load(root: Path) -> list[Kernel]:
    """All kernels, in the manifest's order."""
    listed = json.loads((root / "generated" / "manifest.json").read_text("utf-8"))["kernels"]
    names = Kernel.__dataclass_fields__
    return [Kernel(**{name: kernel[name] for name in names}) for kernel in listed]


def _section(kernel: Kernel) -> str:
    rows = [f"| `{v['name']}` | {v['unit']} | {v['meaning']} |" for v in kernel.inputs]
    rows += [f"| **`{v['name']}`** | {v['unit']} | result |" for v in kernel.outputs]
    counted = ", ".join(f"{count} {name}" for name, count in kernel.operations.items())
    table = "| name | unit | what it is |\n|---|---|---|\n" + "\n".join(rows)
    return f"({kernel.place})=\n## `{kernel.name}`\n\n{kernel.title}.\n\n{table}\n\nOperations: {counted or 'none'}.\n"


def pages(root: Path) -> dict[str, str]:
    """The page of the kernels."""
    listed = load(root)
    head = (
        f"# Kernels\n\nThe {len(listed)} C functions in `generated/`, each written by CasADi from a SymPy expression, "
        "with its arguments and results.  In Python they are NumPy ufuncs in `trum_sym._kernels`; "
        "[what proves them](proofs.md), [how C calls them](c-library.md).\n\n"
    )
    return {"kernels.md": head + "\n".join(map(_section, listed))}
