"""Points that pass between commands: the same figures whether pasted as printed or given by --point.

    python -m studies.points [COUNT] [--seed N]

draws drives, levels and values of the motor, and asks every command of one point for it: ``evaluate``,
``sensitivities``, ``sweep`` and ``spread``.  Each gets it typed, pasted from the table that ``evaluate`` prints, and by
``--point`` from the JSON of ``evaluate``, of ``sensitivities`` and of ``spread``.  Every way has to give the same
mean speed, to the last bit, and the same text.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import json
import re
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

from trum_sym import console

WAYS = ("pasted", "evaluate", "sensitivities", "spread")


def asked(*words: str) -> str:
    """What a command prints."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
        code = console.main(list(words))
    if code == 2:
        raise RuntimeError(f"{' '.join(words)}: refused")
    return out.getvalue()


def drawn(rng: np.random.Generator) -> list[str]:
    """The options of a point that converges quickly."""
    periods = int(rng.integers(4, 24))
    options = {
        "prepressure": rng.uniform(110, 215),
        "frequency-difference": rng.uniform(1500, 4000),
        "load-torque": rng.uniform(-0.05, 0.08),
        "switching-phase": rng.uniform(0, 3),
        "periods": periods,
        "on-periods": int(rng.integers((periods + 1) // 2, periods + 1)),
        "start": rng.choice(["periodic", "steady", "rest"]),
        "phase-lead": rng.choice(["1", "-1"]),
        "contact": rng.choice(["winkler", "hertz"]),
        "resonance": rng.choice(["quartic", "eq6"]),
        "tolerance": "1e-6",
    }
    words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    return [*words, "--set", f"friction_coefficient={rng.uniform(0.2, 0.3)!r}"]


def pasted(text: str, words: list[str]) -> list[str]:
    """The drive as the table prints it; levels, tolerance and the motor's values as they were given."""
    force, difference, on, periods, load = re.search(
        r"at (\S+) N, (\S+) Hz, (\S+) of (\S+) periods on, load (\S+) N m", text
    ).groups()  # type: ignore[union-attr]
    start, lead, phase = re.search(r"start (\w+), phase lead ([+-]1), switching phase (\S+) rad", text).groups()  # type: ignore[union-attr]
    own = {
        "--prepressure": force, "--frequency-difference": difference, "--on-periods": on, "--periods": periods,
        "--load-torque": load, "--start": start, "--phase-lead": lead.removeprefix("+"), "--switching-phase": phase,
    }  # fmt: skip
    changed = list(words)
    for name, value in own.items():
        changed[changed.index(name) + 1] = value
    return changed


def wrong(words: list[str], folder: Path) -> list[str]:
    """Where a point does not give the same figures again."""
    found = []
    few = ("--spread", "voltage=1 %", "--spread", "contact_radius=0.1 %", "--samples", "64", "--output", "mean_speed")
    text, record = asked("evaluate", *words), json.loads(asked("evaluate", *words, "--json"))
    made = {
        "evaluate": record,
        "sensitivities": json.loads(asked("sensitivities", *words, "--json")),
        "spread": json.loads(asked("spread", *words, *few, "--json")),
    }
    for name, content in made.items():
        (folder / f"{name}.json").write_text(json.dumps(content), "utf-8")
    for way in WAYS:
        given = pasted(text, words) if way == "pasted" else ["--point", str(folder / f"{way}.json")]
        again = json.loads(asked("evaluate", *given, "--json"))
        if again != record:
            found.append(f"{way} to evaluate")
        if asked("evaluate", *given) != text:
            found.append(f"{way} to evaluate's table")
        slopes = json.loads(asked("sensitivities", *given, "--json"))
        if slopes["slopes"] != made["sensitivities"]["slopes"]:
            found.append(f"{way} to sensitivities")
        target = folder / "swept.csv"
        force = repr(record["drive"]["prepressure"])
        line = list(given)
        if "--prepressure" in line:
            line[line.index("--prepressure") + 1] = f"{force},{float(force) + 1!r}"
        else:
            line += ["--prepressure", f"{force},{float(force) + 1!r}"]
        asked("sweep", *line, "--outputs", "mean_speed", "--out", str(target), "--force")
        (row, _) = csv.DictReader(target.read_text("utf-8").splitlines())
        if float(row["mean_speed [rad/s]"]) != record["mean_speed"]:
            found.append(f"{way} to sweep")
    if made["spread"]["outputs"]["mean_speed"]["nominal"] != record["mean_speed"]:
        found.append("typed to spread")
    return found


def main() -> int:
    """Draw, compare, say."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    rng, faults, done = np.random.default_rng(given.seed), 0, 0
    with tempfile.TemporaryDirectory() as place, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        while done < given.count:
            words = drawn(rng)
            done += 1
            for fault in wrong(words, Path(place)):
                faults += 1
                print(f"{' '.join(words)}: {fault}")
    print(f"{done} points, {len(WAYS)} ways into evaluate, its table, sensitivities and sweep: {faults} differences")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
