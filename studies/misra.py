"""Findings of cppcheck's MISRA addon in the C library, beside those that docs/misra.md lists.

python -m studies.misra

Counts by rule, of the generated C and of the driver.  The exit code is 1 where a rule has more findings than the page
says, or is not on it; without cppcheck it says loudly that nothing was looked at.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "misra.md"
# What the compiler's own headers would say, which cppcheck does not read
DEFINED = {
    "FLT_RADIX": 2,
    "DBL_MANT_DIG": 53,
    "DBL_MAX_EXP": 1024,
    "FLT_MANT_DIG": 24,
    "FLT_MAX_EXP": 128,
    "CHAR_BIT": 8,
}


def findings(files: list[Path]) -> Counter[str]:
    """How often each rule is met."""
    command = ["cppcheck", "--addon=misra", "--std=c99", "--enable=style", "-q", "--template={id}"]
    command += [f"-I{ROOT / folder}" for folder in ("generated", "trum_sym/_driver")]
    command += [f"-D{name}={value}" for name, value in DEFINED.items()]
    done = subprocess.run([*command, *map(str, files)], capture_output=True, text=True, check=True)
    return Counter(re.findall(r"^misra-c2012-([\d.]+)$", done.stderr + done.stdout, re.M))


def listed() -> dict[str, int]:
    """What the page says of now, by rule."""
    rows = re.findall(r"^\| ([\d.]+) \| \w+ \| \d+ \| (\d+) \|", PAGE.read_text("utf-8"), re.M)
    return {rule: int(count) for rule, count in rows}


def main() -> int:
    """Count, print, compare."""
    if shutil.which("cppcheck") is None:
        print("*** MISRA NOT LOOKED AT: no cppcheck here (apt-get install cppcheck) ***")
        return 0
    with tempfile.TemporaryDirectory() as folder:  # cppcheck leaves files beside those that it reads
        kernels = [Path(shutil.copy(file, folder)) for file in sorted((ROOT / "generated").glob("trum_*.c"))]
        driver = Path(folder) / "library.c"
        driver.write_text('#define TRUM_COUPLED\n#define TRUM_IMPLEMENTATION\n#include "trum.h"\n')
        parts = {"generated": findings(kernels), "driver": findings([driver])}
    for part, counts in parts.items():
        print(f"{part}: " + ", ".join(f"{rule} {count}" for rule, count in counts.most_common()))
    found, known = parts["generated"] + parts["driver"], listed()
    if not found:
        print("nothing was found at all: cppcheck has not read the files")
        return 1
    more = [
        f"{rule}: {count}, {known.get(rule, 0)} on the page"
        for rule, count in found.items()
        if count > known.get(rule, 0)
    ]
    print(*more, f"{sum(found.values())} findings, {len(more)} rules have more than {PAGE.name} says", sep="\n")
    return int(bool(more))


if __name__ == "__main__":
    sys.exit(main())
