"""Every symbol of the equations: its assumptions, SI unit and meaning.

Motor parameters take name and unit from :class:`trum_sym.motor.Motor`; the rest stands here.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import sympy as sp

from trum_sym.motor import Motor
from trum_sym.units import Dimension, parse_unit

__all__ = ["CONSTANTS", "NOMENCLATURE", "TINY", "Entry", "sym"]


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
W_full      | m        | + | wave height below which the Hertz width spans the whole wave
engagement_per_height | 1/m | + | engagement over wave height
f_A_re      | m        | r | phasor of phase A's free motion at the start of a step, real part
f_A_im      | m        | r | its imaginary part
f_B_re      | m        | r | phasor of phase B's free motion at the start of a step, real part
f_B_im      | m        | r | its imaginary part
p_re        | 1        | r | phasor of the drive at the start of a step, real part
p_im        | 1        | r | its imaginary part
e_re        | 1        | r | turn and decay of free motion within a step, real part
e_im        | 1        | r | its imaginary part
d_re        | 1        | r | turn of the drive within a step, real part
d_im        | 1        | r | its imaginary part
W_c         | m        | + | height of the wave at its crest
engagement  | 1        | + | the layer's force at full wave over the prepressure, 2 n_j k_N W_c / (k_c F_c)
share       | 1        | r | constant part of the pressure's share per angle
sin_theta   | 1        | r | sine of the contact half-angle
fullness    | 1        | + | how full the contact is, 1 when the whole wave touches
fullness_root | 1      | + | its cube root
phi         | rad      | r | phase of the surface speed, from the crest
cos_phi     | 1        | r | its cosine
sin_phi     | 1        | r | its sine
R_v         | m/s      | + | amplitude of the surface speed along the wave
f           | 1        | r | net friction fraction, of mu F_c
v           | m/s      | r | speed of the rotor's rim, omega r_c
T_load      | N*m      | r | load torque
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


# Keeps a quotient finite where both sides vanish; has whatever dimension it is added to.
TINY = sp.Symbol("tiny", positive=True)
# Symbols that are no arguments: their values in the kernels.
CONSTANTS = {NOMENCLATURE["N_1"].symbol: 1.0, TINY: 1e-300}


def sym(names: str) -> tuple[sp.Symbol, ...]:
    """The symbols of the nomenclature by their names, separated by spaces."""
    return tuple(NOMENCLATURE[name].symbol for name in names.split())
