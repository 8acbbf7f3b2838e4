"""The house: which package may know which, and no circles (the contracts stand in pyproject.toml)."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

import trum_sym

ROOT = Path(__file__).parents[1]


def test_no_package_imports_one_above_it_and_there_are_no_circles():
    assert lint_imports(no_cache=True) == EXIT_STATUS_SUCCESS


def typed_oscillators(text):
    """Lines of a module in which a driven or damped oscillator is written out.

    That is a difference of two squares of what is called a frequency, or a product with the damping ratio.
    """
    frequencies, damping = re.compile(r"omega|\bown\b|\bturn\b|\bfree\b"), re.compile(r"\bxi\b|damping_ratio")

    def square(node):
        return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and ast.unparse(node.right) == "2"

    found = set()
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.BinOp):
            continue
        parts = [ast.unparse(part) for part in (node.left, node.right)]
        of_squares = isinstance(node.op, ast.Sub) and square(node.left) and square(node.right)
        if of_squares and all(frequencies.search(part) for part in parts):
            found.add(node.lineno)
        if isinstance(node.op, ast.Mult) and any(damping.search(part) for part in parts):
            found.add(node.lineno)
    return sorted(found)


APART = {
    "model/coupling.py": ("_possible", "_heights", "_rates"),
    "studies/loop.py": ("loop_at",),
}
"""Functions with terms of an oscillator that no kernel has: what the plain wave's balance may be over an interval of
heights, its motion in a turning frame, and how fast a stator forgets between two samples of a controller."""


def test_no_oscillator_is_typed_beside_the_derivations():
    """The steady swing of a driven mode stood three times in Python."""
    home = Path(trum_sym.__file__).parent
    for file in sorted(home.rglob("*.py")):
        text, known = file.read_text("utf-8"), APART.get(file.relative_to(home).as_posix(), ())
        spans = [(f.lineno, f.end_lineno) for f in ast.walk(ast.parse(text)) if getattr(f, "name", None) in known]
        assert len(spans) == len(known)
        outside = [n for n in typed_oscillators(text) if not any(low <= n <= high for low, high in spans)]
        assert outside == [], f"{file}: a formula belongs in derivations/"


def test_an_oscillator_that_is_typed_is_seen():
    once = "lead = np.angle(complex(own**2 - turn**2, 2 * xi * own * turn))"
    assert typed_oscillators(once) == [1]
    assert typed_oscillators("gap = values['omega_n0'] ** 2 - values['omega_q'] ** 2") == [1]
    assert typed_oscillators("size = a**2 - b**2") == []


def test_every_test_in_a_browser_is_in_a_place_that_ci_runs():
    """.ci/run names files and folders, so that the slow tests of others stay out of it."""
    command = (ROOT / ".ci" / "run").read_text("utf-8").partition('-m "slow or browser"')[2].partition("\n.venv")[0]
    named = [word for word in command.split() if word.startswith("tests/")]
    for file in (ROOT / "tests").rglob("test_*.py"):
        if "pytest.mark." + "browser" in file.read_text("utf-8"):
            place = file.relative_to(ROOT)
            assert any(place.is_relative_to(word) for word in named), place
