"""``python -m studies.mex [COUNT]``: ``examples/mex/trum_point.c`` built by Octave, beside ``evaluate``.

Needs ``mkoctfile`` and ``octave-cli`` (Debian: octave-dev), and says so where they are not.  The exit code is 1 where a
figure is further off than both errors allow, or a refusal is another.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym.c_library.export import exported, write_folder

SOURCE = Path(__file__).parents[1] / "examples" / "mex" / "trum_point.c"
FIGURES = ("mean_speed", "min_speed", "max_speed", "stall_torque", "contact_fraction", "resonance_frequency")
REFUSED = {
    'struct("prepresure", 1)': "prepresure is no number of the drive",
    'struct("prepressure", -1)': "prepressure is outside its domain",
    'struct("prepressure", "x")': "prepressure has to be one real number",
    'struct("start", "up")': "start is one of: periodic steady rest",
    "3": "the drive has to be one struct of numbers by name",
}


def built(folder: Path) -> None:
    """The MEX file of the stock motor in a folder."""
    write_folder("DIR", exported(ts.load_motor(), ts.Drive(), {}, single=True), folder)
    shutil.copy(SOURCE, folder)
    command = ["mkoctfile", "--mex", "-Wall", "-Wextra", "-Werror", SOURCE.name, "trum.c", "-lm"]
    subprocess.run(command, cwd=folder, check=True)


def said(folder: Path, program: str) -> list[str]:
    """The lines that an Octave program prints."""
    done = subprocess.run(
        ["octave-cli", "--no-gui", "--eval", program], cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines()


def study(count: int, seed: int) -> list[str]:
    """What is not as it should be."""
    rng = np.random.default_rng(seed)
    force, difference = rng.uniform(150, 210, count), rng.uniform(1000, 5000, count)
    load = rng.uniform(-0.5, 0.5, count) * 0.25 * force * 0.0265
    point = ts.evaluate(
        drive=ts.Drive(prepressure=force, frequency_difference=difference, load_torque=load), tolerance=1e-6
    )
    columns = ", ".join(f"p.{name}" for name in FIGURES)
    form = " ".join(["%.17g"] * len(FIGURES))
    lines = [
        f'p = trum_point(struct("prepressure", {f!r}, "frequency_difference", {d!r}, "load_torque", {t!r})); '
        f'printf("{form}\\n", {columns});'
        for f, d, t in zip(force.tolist(), difference.tolist(), load.tolist(), strict=True)
    ]
    lines += [f"try, trum_point({given}); catch e, disp(e.message); end" for given in REFUSED]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "library"
        built(folder)
        answers = said(folder, "\n".join(lines))
    wrong = [
        f"{got!r}, not {want!r}" for got, want in zip(answers[count:], REFUSED.values(), strict=True) if want not in got
    ]
    found = np.array([[float(word) for word in line.split()] for line in answers[:count]])
    top = np.maximum(np.abs(point.min_speed), np.abs(point.max_speed))
    for k, figure in enumerate(FIGURES):
        scale = top if figure.endswith("speed") else np.abs(getattr(point, figure))
        off = float(np.max(np.abs(found[:, k] - getattr(point, figure)) / scale))
        print(f"{figure}: {count} points, largest difference {off:.2g}")
        if not off <= 2e-6:
            wrong.append(f"{figure}: off by {off:.2g}")
    return wrong


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m studies.mex", description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, nargs="?", default=20)
    parser.add_argument("--seed", type=int, default=24)
    options = parser.parse_args()
    if missing := [tool for tool in ("mkoctfile", "octave-cli") if shutil.which(tool) is None]:
        sys.exit(f"*** THE MEX FILE IS NOT BUILT HERE: no {', '.join(missing)} (apt-get install octave-dev) ***")
    wrong = study(options.count, options.seed)
    print("\n".join(wrong) or "nothing found")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
