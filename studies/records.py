"""Studies of random points that write a line a point, and take up where their file ends."""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import trum_sym as ts


def collect(text: str, count: int, record: Callable[[int], dict[str, Any]], report: Callable[[Path], None]) -> None:
    """The command of such a study: the records of all seeds that the file lacks, then its report.

    Parameters
    ----------
    text : str
        The help of the command.
    count : int
        Seeds, where the command names none.
    record : callable
        What is found of a seed, with ``"seed"`` among it.
    report : callable
        Prints the figures of a file.
    """
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("count", type=int, nargs="?", default=count)
    parser.add_argument("--first", type=int, default=0)
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", ts.ValidityWarning)
    done = set()
    if chosen.file.exists():
        done = {json.loads(line)["seed"] for line in chosen.file.read_text().splitlines()}
    for seed in range(chosen.first, chosen.first + chosen.count):
        if seed not in done:
            line = json.dumps(record(seed))
            with chosen.file.open("a") as stream:
                stream.write(line + "\n")
    report(chosen.file)
