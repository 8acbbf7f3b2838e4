"""The paper's operating point, Table 3 on TRUM-60, from the derived expressions alone.

At 30 digits in mpmath, without the compiled kernels, so that the figures of the ledger and those of the
package check each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import mpmath as mp
import sympy as sp

from derivations import amplitude, beam, contact, section
from derivations.ledger.judge import DIGITS, evaluate, usual

__all__ = ["DRIVE", "at_point", "operating_point", "periods", "stator"]

DRIVE = {"F_c": 180, "m": 20, "n": 14, "N_1": 1}
_DIFFERENCE_HZ = 3000


def at_point(expr: sp.Basic, values: Mapping[str, object]) -> mp.mpf:
    """The value of an expression whose symbols' values are given by name."""
    free = sorted(expr.free_symbols, key=lambda s: s.name)
    return evaluate(expr, {symbol: values[symbol.name] for symbol in free})


def stator(prepressure: object, layered: bool = False) -> dict[str, mp.mpf]:
    """Values by symbol name: motor, section, contact, foundation and resonance at a prepressure in N.

    ``layered`` takes axis and bending stiffness of the layers that carry stress in place of eqs. 1 and 2.
    """
    with mp.workdps(DIGITS):
        values: dict[str, mp.mpf] = {name: mp.mpf(repr(value)) for name, value in usual().items()}
        values.update({name: mp.mpf(value) for name, value in DRIVE.items()})
        values["F_c"] = mp.mpf(str(prepressure))
        values["Delta_omega"] = 2 * mp.pi * _DIFFERENCE_HZ
        values["D"] = at_point(section.layered()["D"] if layered else section.neutral_axis(), values)
        values["k_c"] = at_point(contact.wavenumber(), values)
        values["k_N"] = at_point(contact.layer_stiffness(), values)
        values.update({name: at_point(expr, values) for name, expr in section.section().items()})
        if layered:
            values["E"] = at_point(section.layered()["EI"], values) / values["I_z"]
        values["W"] = values["W_maxf"] = at_point(amplitude.measured(), values)
        balance, _ = contact.winkler_balance()
        values["theta"] = mp.findroot(
            lambda angle: at_point(balance, {**values, "theta": angle}), (mp.mpf("0.05"), mp.mpf(3)), solver="anderson"
        )
        levels = contact.foundation()
        values["k_f"] = at_point(levels["harmonic"], values)
        values["k_dx"] = at_point(levels["printed"], values)
        values["omega_n"] = at_point(beam.resonance()["quartic"], values)
        values["omega_q"] = values["omega_n"] + values["Delta_omega"]
        values["beta"] = at_point(beam.rotation_ratio(), values)
    return values


@cache
def operating_point() -> Mapping[str, mp.mpf]:
    """Values by symbol name at the operating point of Table 3 (180 N, 3000 Hz, 14 of 20 pulses)."""
    return stator(DRIVE["F_c"])


def periods() -> dict[str, mp.mpf]:
    """t_1 to t_4 in s from t_1 = 0, by symbol name."""
    p = operating_point()
    pulse = 2 * mp.pi / p["omega_q"]
    off = p["m"] - p["n"]
    return {"t_1": mp.mpf(0), "t_2": off * pulse, "t_3": 2 * off * pulse, "t_4": p["m"] * pulse}
