"""Symbols of Sections 4, 6, 7 and Appendices B, C that only the ledger needs, with their SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, SupportsFloat

import sympy as sp

from trum_sym.units import Dimension, parse_unit

__all__ = ["KNOWN", "NAMES", "Name", "figure", "name", "worse"]


@dataclass(frozen=True)
class Name:
    """A symbol of the paper: where it is defined, its SI unit and meaning."""

    symbol: sp.Symbol
    unit: str
    where: str
    meaning: str


# name, unit, assumption (+ positive, r real), where defined, meaning
_ROWS = """
rho_k     | m      | + | eq. 25     | equivalent curvature diameter of the crest
zeta_zmax | m      | + | eq. 21     | displacement of the crest
C_E       | 1/Pa   | + | eq. 26     | contact compliance of stator and layer
x_m       | m      | + | eq. 26     | half-length of the contact
x_max     | m      | r | eq. 20     | position of the crest
x_xm      | m      | r | eq. 27     | right end of the contact
x_vm      | m      | r | eq. 28     | printed for x_xm; defined nowhere
delta_0   | m      | r | eq. 28     | displacement at the ends of the contact
zeta_z    | m      | r | eq. 11     | vertical displacement
zeta_x    | m      | r | eq. 11     | tangential displacement
A_p       | m^2    | + | eq. 2      | cross-section of the ceramic
M_a       | m/s    | r | eq. 18     | the sine's part of the tangential velocity over D k_c
M_b       | m/s    | r | eq. 19     | the cosine's part of the tangential velocity over D k_c
N_a       | 1/s    | r | eq. 18     | M_a between t_1 and t_2, where eq. 17 takes W_maxf out of it
N_b       | 1/s    | r | eq. 19     | M_b between t_1 and t_2
Psi_v     | rad    | r | eq. 17     | phase angle of the tangential velocity
phi_vm1   | m      | r | eq. 33     | position of an extremum of the tangential velocity
phi_vm2   | m      | r | eq. 35     | position of the other extremum
x_px      | m      | r | eq. 34     | position of a nonsliding point
v_xp      | m/s    | r | Sect. 4.2  | tangential velocity of the nonsliding point, the rotor's surface speed
v_xx      | m/s    | r | Sect. 4.2  | tangential velocity of a point of the stator's surface
v_xm      | m/s    | r | eq. 29     | tangential velocity at the end of the contact
v_xmax    | m/s    | r | eq. 22     | tangential velocity at the crest
f_t       | N      | r | Sect. 4.2  | friction of the driving zone
f_b       | N      | r | Sect. 4.2  | friction of the braking zone
f_nall    | N      | r | eq. 38     | resultant of the friction
M_n       | N*m    | r | eq. 38     | driving torque
T_load    | N*m    | r | eq. 38     | load torque
S_k       | rad/s  | r | eq. 40     | standard deviation of the speed
S_s       | rad/s  | r | eq. 41     | printed for S_k
v_s       | rad/s  | r | eq. 39     | mean speed
Q_q       | m^2/s  | r | eq. 42     | direction determinant
I         | 1      | + | eq. 39     | number of samples
Q_aver    | 1/s    | r | eq. 43     | speed determinant
X         | 1      | + | eq. A14    | forward over backward, of Q
Y         | 1      | + | eq. A16    | the same of Q squared
W_a       | m      | + | eq. A10    | amplitude of phase A
W_b       | m      | + | eq. A10    | amplitude of phase B
omega_a   | rad/s  | + | eq. A10    | angular frequency of phase A
omega_b   | rad/s  | + | eq. A10    | angular frequency of phase B
varphi_a  | rad    | r | eq. A10    | phase of phase A
varphi_b  | rad    | r | eq. A10    | phase of phase B
P_A       | m      | r | eq. A11    | modal response of phase A
P_B       | m      | r | eq. A11    | modal response of phase B
"""


def _names() -> dict[str, Name]:
    table = {}
    for line in _ROWS.strip().splitlines():
        label, unit, kind, where, meaning = (part.strip() for part in line.split("|"))
        symbol = sp.Symbol(label, positive=True) if kind == "+" else sp.Symbol(label, real=True)
        table[label] = Name(symbol, unit, where, meaning)
    return table


NAMES = _names()
KNOWN: dict[sp.Basic, Dimension] = {entry.symbol: parse_unit(entry.unit).dimension for entry in NAMES.values()}


def name(labels: str) -> tuple[sp.Symbol, ...]:
    """The symbols of this table by their names, separated by spaces."""
    return tuple(NAMES[label].symbol for label in labels.split())


def figure(value: SupportsFloat, digits: int = 4) -> str:
    """A number for a sentence, such as 12.6, 9 or 3e+10."""
    return f"{float(value):.{digits}g}"


def worse(worst: Any, error: Any) -> Any:  # noqa: ANN401
    """The larger of two errors; what is not a number stays, where ``max`` would drop it."""
    return worst if worst != worst or error <= worst else error
