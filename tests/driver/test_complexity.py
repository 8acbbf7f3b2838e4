"""No function is too complex to be read, and no header of the driver too long."""

from __future__ import annotations

from pathlib import Path

import lizard
import pytest

ROOT = Path(__file__).parents[2]
DRIVER = ROOT / "trum_sym" / "_driver"
FOLDERS = ("trum_sym", "derivations", "benchmarks", "studies", "tests", "examples")
MOST_COMPLEX, LONGEST_HEADER = 20, 350


def functions(path: Path) -> list[tuple[str, int]]:
    """Name and cyclomatic complexity of the functions of a file."""
    found = lizard.analyze_file(str(path)).function_list
    return [(function.name, function.cyclomatic_complexity) for function in found]


def sources() -> list[Path]:
    found = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    return sorted(path for path in found if path.suffix in (".py", ".c", ".h", ".cpp", ".hpp"))


def test_no_function_is_more_complex_than_20():
    measured = {path: functions(path) for path in sources()}
    assert "trum_finish_lap" in dict(measured[DRIVER / "orbit" / "shooting.h"])
    too_complex = [
        f"{path.relative_to(ROOT)}: {name} has {complexity}"
        for path, found in measured.items()
        for name, complexity in found
        if complexity > MOST_COMPLEX
    ]
    assert not too_complex, "\n".join(too_complex)


@pytest.mark.parametrize(("branches", "complexity"), [(19, 20), (20, 21)])
def test_a_function_of_many_branches_is_counted(tmp_path, branches, complexity):
    path = tmp_path / "many.h"
    body = "".join(f"  if (x == {k}) return {k};\n" for k in range(branches))
    path.write_text(f"static int many(int x) {{\n{body}  return -1;\n}}\n")
    assert functions(path) == [("many", complexity)]


def test_no_header_of_the_driver_is_longer_than_350_lines():
    lengths = {path.name: len(path.read_text().splitlines()) for path in DRIVER.rglob("*.h*")}
    assert len(lengths) > 20
    assert {name: length for name, length in lengths.items() if length > LONGEST_HEADER} == {}
