"""The resonance at every level, without and with prepressure, and whether its dimensions agree.

    python examples/resonance_levels.py

The last two columns are what the dimension check found when the kernels were generated.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.units import parse_unit

MANIFEST = Path(__file__).parent.parent / "generated" / "manifest.json"
FORCES = np.array([160.0, 180.0, 210.0])


def verdicts() -> tuple[dict[str, str], dict[str, str]]:
    """By resonance level, and by foundation level: does its unit fit the resonance's argument k_f?"""
    kernels = {kernel["name"]: kernel for kernel in json.loads(MANIFEST.read_text("utf-8"))["kernels"]}
    levels = {output["name"]: output["dimension"] for output in kernels["trum_resonance"]["outputs"]}
    (needed,) = (i["unit"] for i in kernels["trum_resonance"]["inputs"] if i["name"] == "k_f")
    foundations = {
        output["name"]: "consistent"
        if parse_unit(output["unit"]).dimension == parse_unit(needed).dimension
        else f"inconsistent: {output['unit']} for {needed}"
        for output in kernels["trum_foundation"]["outputs"]
    }
    return levels, foundations


def main() -> None:
    """Print the table."""
    motor, (by_level, by_foundation) = ts.load_motor("trum60"), verdicts()
    rows = []
    for level in ("euler", "printed", "eq6", "quartic"):
        free = ts.evaluate(motor, resonance=level, foundation="none").resonance_frequency
        for foundation in ("harmonic", "smeared", "printed"):
            loaded = ts.evaluate(
                motor, ts.Drive(prepressure=FORCES), resonance=level, foundation=foundation
            ).resonance_frequency
            rows.append((level, foundation, free, *loaded, by_level[level], by_foundation[foundation]))
    headers = ("resonance", "foundation", "none", *(f"{force:g} N" for force in FORCES), "level", "its foundation")
    print("Resonance of TRUM-60 in Hz; measured 39703 Hz (Sect. 7.3, prepressure not stated)\n")
    print(tabulate(rows, headers, floatfmt=".1f"))


if __name__ == "__main__":
    main()
