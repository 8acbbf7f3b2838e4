"""Every symbol of the equations: its assumptions, SI unit and meaning.

Motor parameters take name and unit from :class:`trum_sym.motor.Motor`; the rest stands here.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import sympy as sp

from trum_sym.motor import Motor
from trum_sym.units import Dimension, parse_unit

__all__ = ["NOMENCLATURE", "Entry", "sym"]


@dataclass(frozen=True)
class Entry:
    """A symbol with its SI unit and meaning."""

    symbol: sp.Symbol
    unit: str
    meaning: str

    @property
    def dimension(self) -> Dimension:
        """The exponents of the SI base units."""
        return parse_unit(self.unit).dimension


# name, unit, assumptions (+ positive, r real), meaning
_REST = """
t           | s        | r | time
x           | m        | r | position along the unrolled circumference
tau         | s        | r | time since the start of a region of the drive cycle
E           | Pa       | + | Young's modulus of the composite section (eq. 2)
rho         | kg/m^3   | + | mean density of the composite section (eq. 2)
I_z         | m^4      | + | second moment of area of the composite section (eq. 2)
G           | Pa       | + | shear modulus of the composite section (eq. 2)
A           | m^2      | + | area of the composite section
E_eq        | Pa       | + | Young's modulus of the toothed beam, reduced for its grooves
k_f         | N/m^2    | + | stiffness per length of the foundation under the beam
k_dx        | N/m      | + | the paper's foundation stiffness (below eq. 5)
theta       | rad      | + | contact half-angle k_c x_m
F_c         | N        | + | prepressure
N_1         | N        | + | one newton, which makes the base of eq. 8's power a number
W           | m        | + | amplitude of a phase's standing wave
omega_n     | rad/s    | + | resonant angular frequency
omega_q     | rad/s    | + | drive angular frequency
Delta_omega | rad/s    | r | angular frequency difference, drive less resonance
beta        | 1/m      | + | rotation per displacement of the Timoshenko mode
m           | 1        | + | drive pulses per cycle (periods)
n           | 1        | + | pulses each phase gets per cycle (on_periods)
psi         | rad      | r | drive phase at which the phases are switched (switching_phase)
s           | 1        | r | phase lead of B in quarter periods, +1 or -1
T           | s        | + | duration of a drive cycle
a           | m        | r | free displacement at the start
b           | m/s      | r | free velocity at the start
a_A         | m        | r | free displacement of phase A at the start of the region
b_A         | m/s      | r | free velocity of phase A at the start of the region
a_B         | m        | r | free displacement of phase B at the start of the region
b_B         | m/s      | r | free velocity of phase B at the start of the region
g_A         | 1        | r | gate of phase A, 1 on and 0 off
g_B         | 1        | r | gate of phase B, 1 on and 0 off
q_plus      | 1        | + | integral of the positive part of the determinant, W = D k_c = 1
q_minus     | 1        | + | integral of the magnitude of its negative part
p_plus      | 1/s      | + | integral of the square of the positive part
p_minus     | 1/s      | + | integral of the square of the negative part
"""


def _symbol(name: str, positive: bool) -> sp.Symbol:
    return sp.Symbol(name, positive=True) if positive else sp.Symbol(name, real=True)


def _entries() -> dict[str, Entry]:
    table: dict[str, Entry] = {}
    for field in fields(Motor):
        spec = field.metadata.get("spec")
        if spec is not None:
            symbol = _symbol(spec.symbol, positive=spec.domain.low >= 0)
            table[spec.symbol] = Entry(symbol, spec.unit, field.name.replace("_", " "))
    for line in _REST.strip().splitlines():
        name, unit, kind, meaning = (part.strip() for part in line.split("|"))
        if name in table:
            raise ValueError(f"symbol {name} is defined twice")
        table[name] = Entry(_symbol(name, positive=kind == "+"), unit, meaning)
    return table


NOMENCLATURE = _entries()


def sym(names: str) -> tuple[sp.Symbol, ...]:
    """The symbols of the nomenclature by their names, separated by spaces."""
    return tuple(NOMENCLATURE[name].symbol for name in names.split())
