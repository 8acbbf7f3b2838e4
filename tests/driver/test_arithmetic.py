"""The C library refuses a compiler that was told that no number is NaN, and says why."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from c_coverage import ROOT

COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
HEADERS = ["trum.h", "trum_cycle.h", "trum_kernels.h", "trum_orbit.h", "table.h"]
REFUSED = ["-Ofast", "-ffast-math", "-ffinite-math-only"]


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """A speed table's header."""
    import numpy as np

    from trum_sym.studies.table_files import Rows, as_c

    folder = tmp_path_factory.mktemp("table")
    rows = Rows(np.array([1.0, 2.0]), [np.array([180.0, 181.0])], np.array([0.1, 0.1]), np.array([1e-9, 1e-9]))
    (folder / "table.h").write_text(as_c("table", ["a table"], {"prepressure": "N"}, [rows]))
    return folder


def preprocessed(compiler, header, flags, table):
    folders = [ROOT / "generated", ROOT / "trum_sym" / "_driver", table]
    command = [compiler, "-std=c99", "-O2", *flags, *(f"-I{folder}" for folder in folders), "-E", "-x", "c", "-"]
    source = f'#define TRUM_IMPLEMENTATION\n#include "{header}"\n'
    return subprocess.run(command, input=source, capture_output=True, text=True)


@pytest.mark.parametrize("flag", REFUSED)
@pytest.mark.parametrize("header", HEADERS)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_arithmetic_without_nan_is_refused_with_the_reason(compiler, header, flag, table):
    done = preprocessed(compiler, header, [flag], table)
    assert done.returncode != 0
    assert "drop the tests for NaN that refuse input and end searches" in done.stderr


@pytest.mark.parametrize("flags", [[], ["-Ofast", "-fno-finite-math-only", "-fno-fast-math"], ["-fno-signed-zeros"]])
@pytest.mark.parametrize("compiler", COMPILERS)
def test_arithmetic_with_nan_is_taken(compiler, flags, table):
    for header in HEADERS:
        assert preprocessed(compiler, header, flags, table).returncode == 0, header
