"""The dimension walker, and every kernel checked by it."""

from __future__ import annotations

import pytest
import sympy as sp

from derivations import beam
from derivations.codegen.emit import check_dimensions
from derivations.codegen.kernels import kernels
from derivations.dimensions import DimensionError, dimension
from derivations.nomenclature import sym
from trum_sym.inputs.units import parse_unit

E, I_z, k_c, rho, A, omega_n, t = sym("E I_z k_c rho A omega_n t")


@pytest.mark.parametrize("kernel", kernels(), ids=lambda kernel: kernel.name)
def test_every_output_has_the_dimension_of_its_unit(kernel):
    verdicts = check_dimensions(kernel)
    wrong = [name for name, verdict in verdicts.items() if verdict != "consistent"]
    assert wrong == list(kernel.inconsistent)


def test_only_the_printed_resonance_is_inconsistent():
    assert [(k.name, k.inconsistent) for k in kernels() if k.inconsistent] == [("trum_resonance", ("printed",))]


@pytest.mark.parametrize(
    ("expr", "unit"),
    [
        (E * I_z * k_c**4 / (rho * A), "1/s^2"),
        (sp.sqrt(E / rho), "m/s"),
        (sp.sin(omega_n * t) * sp.Max(E, 2 * E), "Pa"),
        (sp.atan2(E, 3 * E), "1"),
        (sp.exp(-omega_n * t) ** 2, "1"),
    ],
)
def test_dimension_of_an_expression(expr, unit):
    assert dimension(expr) == parse_unit(unit).dimension


@pytest.mark.parametrize(
    "expr", [E + rho, sp.sin(omega_n), sp.exp(t), sp.Max(E, rho), sp.atan2(E, rho), k_c ** (omega_n * t), 1 + t]
)
def test_inconsistent_expressions_are_refused(expr):
    with pytest.raises(DimensionError):
        dimension(expr)


def test_a_lost_factor_is_noticed():
    levels = beam.resonance()
    broken = levels["eq6"].subs(I_z, 1)
    with pytest.raises(DimensionError):
        dimension(broken)
