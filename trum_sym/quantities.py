"""The numeric figures of an operating point: label, unit, and the unit people read."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["ERRORS", "QUANTITIES", "Quantity"]


class Quantity(NamedTuple):
    """How one figure is named and shown."""

    label: str
    unit: str
    shown: str


QUANTITIES = {
    "resonance_frequency": Quantity("resonance frequency f_n", "Hz", "Hz"),
    "drive_frequency": Quantity("drive frequency f_q", "Hz", "Hz"),
    "cycle_time": Quantity("cycle time T_Qall", "s", "ms"),
    "amplitude": Quantity("amplitude of a phase W_maxf", "m", "µm"),
    "neutral_axis": Quantity("neutral axis D", "m", "mm"),
    "wavenumber": Quantity("wavenumber k_c", "1/m", "1/m"),
    "q_ratio": Quantity("forward over backward X", "1", "1"),
    "q_square_ratio": Quantity("the same of squares Y", "1", "1"),
    "q_average": Quantity("speed determinant Q_aver", "1/s", "1/s"),
    "q_volatility": Quantity("volatility determinant Q_vib", "1/s", "1/s"),
    "mean_speed": Quantity("mean speed v_s", "rad/s", "arcsec/s"),
    "min_speed": Quantity("lowest speed", "rad/s", "arcsec/s"),
    "max_speed": Quantity("highest speed", "rad/s", "arcsec/s"),
    "speed_volatility": Quantity("speed volatility sigma_s", "1", "%"),
    "stall_torque": Quantity("stall torque", "N*m", "N*m"),
    "contact_fraction": Quantity("contact fraction", "1", "1"),
}

ERRORS = {
    f"{name}_error": Quantity(
        f"{QUANTITIES[name].label}, bound of its error", QUANTITIES[name].unit, QUANTITIES[name].shown
    )
    for name in ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque")
}
"""Bounds of the errors of the rotor's figures, by the figure's name with ``_error`` after it."""
