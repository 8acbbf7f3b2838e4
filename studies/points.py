"""Points that pass between commands: the same figures whether pasted as printed or given by --point.

    python -m studies.points [COUNT] [--seed N] [--searches]

draws drives, levels and values of the motor.  Each point goes typed, pasted from the table that ``evaluate`` prints,
and by ``--point`` from the JSON of ``evaluate``, of ``sensitivities`` and of ``spread`` into ``evaluate`` and, one
point after another, into its table, ``sensitivities``, ``sweep``, ``spread``, ``simulate`` and ``characteristics``:
the same figures to the last bit, and the same text.  With ``--searches`` the answers of ``optimize``, ``robust``,
``pareto`` and ``speed-table`` go by ``--point`` into ``evaluate``, ``sweep``, ``spread`` and ``simulate``.
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


def table(words: list[str], _: Path) -> str:
    """Of ``evaluate``, as text."""
    return asked("evaluate", *words)


def slopes(words: list[str], _: Path) -> object:
    """Of ``sensitivities``."""
    return json.loads(asked("sensitivities", *words, "--json"))["slopes"]


def swept(words: list[str], folder: Path) -> float:
    """The mean speed of ``sweep``, over the point's load and another."""
    target = folder / "swept.csv"
    inertia = ("--load-inertia", "0,1e-4")
    asked("sweep", *words, *inertia, "--outputs", "mean_speed", "--out", str(target), "--force")
    return float(next(csv.DictReader(target.read_text("utf-8").splitlines()))["mean_speed [rad/s]"])


FEW = ("--spread", "voltage=1 %", "--spread", "contact_radius=0.1 %", "--samples", "64", "--output", "mean_speed")


def nominal(words: list[str], _: Path) -> float:
    """The mean speed of ``spread``, of values as they are."""
    return json.loads(asked("spread", *words, *FEW, "--json"))["outputs"]["mean_speed"]["nominal"]


def simulated(words: list[str], folder: Path) -> float:
    """The mean speed of ``simulate``."""
    import xarray as xr

    target = folder / "simulated.nc"
    asked("simulate", *words, "--samples-per-period", "4", "--out", str(target), "--force")
    with xr.open_dataset(target) as found:
        return float(found.attrs["mean_speed"])


def speeds(words: list[str], _: Path) -> object:
    """The speed by frequency of ``characteristics``, which takes all of a point but the load."""
    found = json.loads(asked("characteristics", *words, "--points", "2", "--json"))
    return found["variables"]["speed_by_frequency"]["values"]


READERS = (table, slopes, swept, nominal, simulated, speeds)


def written(words: list[str], folder: Path) -> None:
    """The files of the commands that write a point."""
    for command, further in (("evaluate", ()), ("sensitivities", ()), ("spread", FEW)):
        (folder / f"{command}.json").write_text(asked(command, *words, *further, "--json"), "utf-8")


def wrong(words: list[str], folder: Path, number: int) -> list[str]:
    """Where a point does not give the same figures again: in ``evaluate``, and in one other command after another."""
    written(words, folder)
    record = json.loads((folder / "evaluate.json").read_text("utf-8"))
    reader = READERS[number % len(READERS)]
    text, expected = asked("evaluate", *words), reader(_without_load(words, reader), folder)
    found = []
    if reader in (swept, nominal, simulated) and expected != record["mean_speed"]:
        found.append(f"typed to {reader.__name__}")
    for way in WAYS:
        given = pasted(text, words) if way == "pasted" else ["--point", str(folder / f"{way}.json")]
        if json.loads(asked("evaluate", *given, "--json")) != record:
            found.append(f"{way} to evaluate")
        if reader(_without_load(given, reader), folder) != expected:
            found.append(f"{way} to {reader.__name__}")
    return found


def _without_load(words: list[str], reader: object) -> list[str]:
    """What ``characteristics`` takes: its curves run over all loads."""
    if reader is not speeds or "--load-torque" not in words:
        return words
    place = words.index("--load-torque")
    return [*words[:place], *words[place + 2 :]]


SEARCHES = {
    "optimize": ("--target-speed", "300000 arcsec/s"),
    "robust": ("--target-speed", "300000 arcsec/s", "--spread", "load_torque=0.045:0.055"),
    "pareto": ("--objective", "ripple", "--points", "3"),
    "speed-table": ("--from", "300000 arcsec/s", "--to", "301000 arcsec/s", "--points", "2"),
}
BOX = ("--load-torque", "0.05", "--prepressure", "180", "--frequency-difference", "2800:3100")


def searched(folder: Path) -> list[str]:
    """Where the answer of a search does not give its figures again, to the tolerance that it has them to."""
    found = []
    for command, words in SEARCHES.items():
        path = folder / f"{command}.json"
        path.write_text(asked(command, *BOX, *words, "--json"), "utf-8")
        answer = json.loads(path.read_text("utf-8"))
        point = answer["points"][0] if "points" in answer else answer
        speed = point.get("mean_speed")  # a robust point has its cases' objective only
        given = ["--point", f"{path}#1" if "points" in answer else str(path), "--tolerance", "1e-9"]
        record = json.loads(asked("evaluate", *given, "--json"))
        size = max(abs(record["min_speed"]), abs(record["max_speed"]))
        if speed is not None and not abs(record["mean_speed"] - speed) <= 1e-8 * size:
            found.append(f"{command} to evaluate: {speed}, then {record['mean_speed']}")
        for reader in (swept, nominal, simulated):
            if reader(given, folder) != record["mean_speed"]:
                found.append(f"{command} to {reader.__name__}")
    return found


def main() -> int:
    """Draw, compare, say."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--searches", action="store_true", help="the answers of searches, too")
    given = parser.parse_args()
    rng, faults = np.random.default_rng(given.seed), 0
    with tempfile.TemporaryDirectory() as place, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number in range(given.count):
            words = drawn(rng)
            for fault in wrong(words, Path(place), number):
                faults += 1
                print(f"{' '.join(words)}: {fault}")
        if given.searches:
            for fault in searched(Path(place)):
                faults += 1
                print(fault)
    others = ", ".join(reader.__name__ for reader in READERS)
    print(f"{given.count} points, {len(WAYS)} ways into evaluate and, in turn, {others}: {faults} differences")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
