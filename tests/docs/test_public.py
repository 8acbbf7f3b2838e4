"""Every public name is documented in full, and the example of each runs."""

from __future__ import annotations

import dataclasses
import doctest
import inspect
import re

import pytest

import trum_sym as ts
from trum_sym.calibration.result import FittedParameter
from trum_sym.model.inputs import Inputs
from trum_sym.model.levels import LEVEL_NAMES, Levels
from trum_sym.optimiser.result import Evidence
from trum_sym.studies.pareto import ParetoFront
from trum_sym.studies.robust import RobustPoint
from trum_sym.studies.speed_table_result import SpeedTable
from trum_sym.uncertainty.study import Study

PUBLIC = {name: getattr(ts, name) for name in ts.__all__}
FUNCTIONS = {name: of for name, of in PUBLIC.items() if inspect.isfunction(of)}
ANSWERS = (FittedParameter, Inputs, Levels, Evidence, ParetoFront, RobustPoint, SpeedTable, Study)
CLASSES = {of.__name__: of for of in (*PUBLIC.values(), *ANSWERS) if inspect.isclass(of)}
SOURCE = re.compile(r"\beqs?\. |Table \d|Sect\. |docs/\w+|[Tt]he paper")
NUMBERED = re.compile(r"\b(?:SI|N|Hz|rad|rad/s|m|s|shape|array|arrays|floats?|single)\b")


def sections(docstring):
    """The sections of a docstring by their headings; what stands before the first is under the empty name."""
    parts = re.split(r"^(\w[\w ]*)\n-{3,}$", inspect.cleandoc(docstring or ""), flags=re.M)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}


def named(section):
    """The names that the entries of a section begin with."""
    entries = re.findall(r"^(\*{0,2}\w[\w, .*]*?)(?: : .*)?$", section, re.M)
    return {name.strip("* ") for entry in entries for name in entry.split(",")}


def lacking(name, of):
    """What a function's docstring does not say."""
    found, wanted = sections(of.__doc__), dict(inspect.signature(of).parameters)
    missing = [f"no {part}" for part in ("Parameters", "Raises", "Examples") if part not in found and wanted]
    if "levels" in wanted:
        del wanted["levels"]
        wanted |= dict.fromkeys(LEVEL_NAMES)
    missing += [f"{p} is not described" for p in wanted if p not in named(found.get("Parameters", ""))]
    if inspect.signature(of).return_annotation not in (None, "None") and not found.get("Returns", "").strip():
        missing.append("no Returns")
    if name not in ("save_motor",):
        missing += [] if SOURCE.search(of.__doc__) else ["no equation, table, section or page"]
        missing += [] if NUMBERED.search(of.__doc__) else ["neither units nor shapes"]
    return missing


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_parameters_units_errors_source_and_has_an_example(name):
    assert lacking(name, FUNCTIONS[name]) == []


@pytest.mark.parametrize("name", CLASSES)
def test_every_class_describes_its_fields_and_methods(name):
    of = CLASSES[name]
    found = sections(of.__doc__)
    if dataclasses.is_dataclass(of):
        known = named(found.get("Attributes", "") + found.get("Parameters", ""))
        fields = {f.name for f in dataclasses.fields(of)}
        if of is ts.Motor:  # its parameters stand on a page of their own, made of the same specifications
            assert {"radius", "piezo_loss_factor"} <= known
            fields = {f.name for f in dataclasses.fields(of) if "Parameter" not in str(f.type) or f.name == "bench"}
        assert fields - known == set()
    if name in PUBLIC:
        assert "Examples" in found
    for member, value in vars(of).items():
        value = value.fget if isinstance(value, property) else getattr(value, "__func__", value)
        if not member.startswith("_") and inspect.isfunction(value):
            assert (value.__doc__ or "").strip(), f"{name}.{member} has no docstring"


def test_a_gap_is_noticed():
    def nothing(motor, *, tolerance=1.0):
        """Words.

        Parameters
        ----------
        motor : Motor
        """

    said = lacking("nothing", nothing)
    assert {"no Raises", "no Examples", "tolerance is not described", "no Returns"} <= set(said)


LONGER = ("characteristics", "pareto", "robust", "speed_table", "track")  # which .ci/run runs beside the site


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in LONGER else ()) for name in PUBLIC]
)
def test_the_examples_run(name):
    of = PUBLIC[name]
    found = [t for t in doctest.DocTestFinder(recurse=False).find(of, name, module=False, globs={}) if t.examples]
    assert found, "an example"
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    said = []
    for test in found:
        runner.run(test, out=said.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(said)
