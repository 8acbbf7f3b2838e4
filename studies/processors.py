"""The package as installed, on processors with fewer instructions than this one's: emulated, with Python and NumPy.

python -m studies.processors [CPU ...]

Runs under qemu (apt-get install qemu-user-static), which stops a program at an instruction that a processor lacks:

Nehalem    SSE4.2, no AVX: the baseline's lanes
Haswell    AVX2 and fused multiply-add, no AVX-512: four lanes

On each the module is loaded and a point, a batch, orbits on a grid, a coupled orbit and slopes are computed, in about a
minute; figures are compared with this processor's, within the sum of both stated errors, slopes to two in a million.
The exit code is 1 if anything was found, 77 where nothing can be emulated.
"""

from __future__ import annotations

import argparse
import json
import platform
import shutil
import subprocess
import sys
from collections.abc import Iterable

import numpy as np

QEMU = "qemu-x86_64-static"
CPUS = {"Nehalem": "orbit_baseline", "Haswell": "orbit_avx2"}  # with the code that each is to choose

COMPUTE = """
import json
import numpy as np
import trum_sym as ts
from trum_sym import _kernels

FIGURES = ("mean_speed", "min_speed", "max_speed", "speed_volatility")
found = {}

def keep(name, figures):
    for figure in FIGURES:
        pair = figures[figure], figures[f"{figure}_error"]
        found[f"{name}: {figure}"] = [np.ravel(part).tolist() for part in pair]

motor, light = ts.load_motor(), ts.Drive(load_torque=0.05)
keep("point", ts.evaluate(motor).figures)
batch = ts.Drive(prepressure=np.linspace(170.0, 210.0, 5), load_torque=0.05)
keep("batch", ts.evaluate(motor, batch, tolerance=1e-6).figures)
keep("grid", ts.evaluate(motor, batch, tolerance=1e-2, method="grid").figures)
short = ts.Drive(load_torque=0.05, periods=4, on_periods=3)
keep("coupled", ts.evaluate(motor, short, coupling="contact", tolerance=1e-3).figures)
for name, slope in ts.sensitivities(motor, light, tolerance=1e-6)["mean_speed"].items():
    found[f"slope by {name}"] = [[float(slope)], [1e-6 * abs(float(slope))]]
print(json.dumps({"code": list(_kernels.instruction_sets())[-1], "figures": found}))
"""


def computed(*run: str) -> dict[str, object]:
    """What the package finds, on this processor or on the one that a command emulates.

    Raises
    ------
    subprocess.CalledProcessError
        If it ends otherwise, as it does at an unknown instruction.
    """
    done = subprocess.run([*run, sys.executable, "-c", COMPUTE], capture_output=True, text=True)
    if done.returncode:
        raise subprocess.CalledProcessError(done.returncode, run, done.stdout, done.stderr)
    found: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return found


def differences(found: dict[str, object], expected: dict[str, object]) -> list[str]:
    """Figures that are further apart than both errors and rounding allow, a line each."""
    wrong = []
    here, there = expected["figures"], found["figures"]
    assert isinstance(here, dict)
    assert isinstance(there, dict)
    for name, (values, errors) in here.items():
        value, error = (np.array(part) for part in there[name])
        off, allowed = np.abs(value - values), error + errors + 1e-12 * np.abs(values)
        wrong += [f"{name}: off by {o:.3g}, {a:.3g} allowed" for o, a in zip(off, allowed, strict=True) if not o <= a]
    return wrong


def main(arguments: Iterable[str]) -> int:
    """Compute on each processor and compare; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cpus", nargs="*", metavar="CPU", choices=[*CPUS, []], help=", ".join(CPUS))
    chosen = parser.parse_args(list(arguments)).cpus or list(CPUS)
    if platform.machine() != "x86_64" or shutil.which(QEMU) is None:
        print(f"*** NOT DONE: a processor of x86-64 and {QEMU} are not here ***")
        return 77
    expected, bad = computed(), 0
    print(f"this processor: {expected['code']}", flush=True)
    for cpu in chosen:
        try:
            found = computed(QEMU, "-cpu", cpu)
        except subprocess.CalledProcessError as error:
            print(f"{cpu}: ended with {error.returncode}\n{error.stderr[-2000:]}", flush=True)
            bad += 1
            continue
        wrong = differences(found, expected)
        if found["code"] != CPUS[cpu]:
            wrong.append(f"{found['code']} was chosen, not {CPUS[cpu]}")
        count = len(found["figures"])  # type: ignore[arg-type]
        print("\n".join([f"{cpu}: {found['code']}, {count} figures, {len(wrong)} wrong", *wrong]), flush=True)
        bad += len(wrong)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
