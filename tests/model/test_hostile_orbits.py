"""The compiled search for an orbit ends, whatever numbers it is given."""

from __future__ import annotations

import subprocess
import sys

import pytest

VALUES = ("nan", "inf", "-inf", "0", "-1", "1e308")


@pytest.mark.parametrize("name", ["omega_n", "Delta_omega", "m", "n", "hertz"])
def test_a_search_ends_for_any_number_of_what_makes_the_schedule(name):
    """Others are looked at in the steps, where a number that is none ends a lap after its most attempts."""
    code = (
        "import faulthandler; faulthandler.dump_traceback_later(100, exit=True)\n"
        "import sys, numpy as np, trum_sym as ts\n"
        "from trum_sym import _kernels\n"
        "from trum_sym.model.levels import Levels\n"
        "from trum_sym.model.operating_point import prepare\n"
        "from trum_sym.model.rotor import _INPUTS\n"
        "given = {**prepare(ts.load_motor(), ts.Drive(), Levels(), 1e-3).arguments, 'tolerance': 1e-3}\n"
        "for value in sys.argv[2:]:\n"
        "    changed = {**given, sys.argv[1]: float(value)}\n"
        "    out = _kernels.rotor_orbit(*(changed[name] for name in _INPUTS))\n"
        "    mean, flags = out[0], int(out[-1])\n"
        "    assert np.isfinite(mean) or not flags & 1, (value, mean, flags)\n"
        "print('done')"
    )
    done = subprocess.run([sys.executable, "-c", code, name, *VALUES], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr[-300:]
