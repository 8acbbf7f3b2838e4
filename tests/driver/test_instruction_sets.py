"""Code for instructions that a processor may lack runs only where the module has chosen it; ``python -m
studies.processors`` runs the package on emulated processors."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from studies.c_matrix import FOLDERS, INSTRUCTIONS
from studies.processors import CPUS, differences
from trum_sym import _kernels


def set_at_load(path):
    """Functions that run when an object file or a module is loaded, without the one that every compiler adds."""
    listed = subprocess.run(["readelf", "-W", "-S", path], capture_output=True, text=True, check=True).stdout
    sizes = re.findall(r"\.init_array\s+INIT_ARRAY\s+[0-9a-f]+ [0-9a-f]+ ([0-9a-f]+)", listed)
    return sum(int(size, 16) for size in sizes) // 8


@pytest.mark.skipif(sys.platform != "linux", reason="readelf reads Linux's modules")
def test_nothing_of_ours_runs_when_the_module_loads():
    assert set_at_load(_kernels.__file__) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="readelf reads Linux's modules")
def test_a_lane_in_a_namespace_would_be_noticed(tmp_path):
    head = '#include <math.h>\n#include "trum_elementary.h"\n#define LANES 2\nnamespace {\n#include "lanes.hpp"\n'
    rest = "}\ndouble at(double x);\ndouble at(double x) { return (Lane(x) + one)[0]; }\n"
    flags = ["-std=c++17", "-O0", *(f"-I{folder}" for folder in FOLDERS), "-c", "a.cpp"]
    for text, count in (("const Lane one = 1.0;\n", 1), ("constexpr double one = 1.0;\n", 0)):
        (tmp_path / "a.cpp").write_text(head + text + rest)
        subprocess.run(["g++", *flags], cwd=tmp_path, check=True)
        assert set_at_load(tmp_path / "a.o") == count


def test_figures_of_another_processor_are_held_to_both_errors():
    here = {"code": "orbit_avx2", "figures": {"mean": [[1.0, 2.0], [1e-3, 1e-3]]}}
    near = {"code": "orbit_avx2", "figures": {"mean": [[1.0, 2.0015], [1e-3, 1e-3]]}}
    far = {"code": "orbit_avx2", "figures": {"mean": [[1.0, float("nan")], [1e-3, 1e-3]]}}
    assert differences(near, here) == []
    assert differences(far, here) == ["mean: off by nan, 0.002 allowed"]
    assert {f"orbit_{name}" for name in INSTRUCTIONS} >= set(CPUS.values())
