"""The dimension walker, and every kernel checked by it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from lazily import lazily

from trum_sym.inputs.units import parse_unit

sp = lazily("sympy")
beam = lazily("derivations.beam")
dimensions = lazily("derivations.dimensions")
emit = lazily("derivations.codegen.emit")
nomenclature = lazily("derivations.nomenclature")

MANIFEST = json.loads((Path(__file__).parents[2] / "generated" / "manifest.json").read_text("utf-8"))


def kernels():
    from derivations.codegen.kernels import kernels

    return {kernel.name: kernel for kernel in kernels()}


def dimension(text):
    symbols = {name: entry.symbol for name, entry in nomenclature.NOMENCLATURE.items()}
    return dimensions.dimension(sp.sympify(text, locals=symbols))


@pytest.mark.parametrize("name", [entry["name"] for entry in MANIFEST["kernels"]])
def test_every_output_has_the_dimension_of_its_unit(name):
    kernel = kernels()[name]
    verdicts = emit.check_dimensions(kernel)
    wrong = [name for name, verdict in verdicts.items() if verdict != "consistent"]
    assert wrong == list(kernel.inconsistent)


def test_only_the_printed_resonance_is_inconsistent():
    assert [(k.name, k.inconsistent) for k in kernels().values() if k.inconsistent] == [
        ("trum_resonance", ("printed",))
    ]


@pytest.mark.parametrize(
    ("expr", "unit"),
    [
        ("E * I_z * k_c**4 / (rho * A)", "1/s^2"),
        ("sqrt(E / rho)", "m/s"),
        ("sin(omega_n * t) * Max(E, 2 * E)", "Pa"),
        ("atan2(E, 3 * E)", "1"),
        ("exp(-omega_n * t) ** 2", "1"),
    ],
)
def test_dimension_of_an_expression(expr, unit):
    assert dimension(expr) == parse_unit(unit).dimension


@pytest.mark.parametrize(
    "expr", ["E + rho", "sin(omega_n)", "exp(t)", "Max(E, rho)", "atan2(E, rho)", "k_c ** (omega_n * t)", "1 + t"]
)
def test_inconsistent_expressions_are_refused(expr):
    with pytest.raises(dimensions.DimensionError):
        dimension(expr)


def test_a_lost_factor_is_noticed():
    levels = beam.resonance()
    (I_z,) = nomenclature.sym("I_z")
    with pytest.raises(dimensions.DimensionError):
        dimensions.dimension(levels["eq6"].subs(I_z, 1))
