"""The numeric figures of an operating point: label, unit, and the unit people read."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["OUTPUTS", "Output"]


class Output(NamedTuple):
    """How one figure is named and shown."""

    label: str
    unit: str
    shown: str


OUTPUTS = {
    "resonance_frequency": Output("resonance frequency f_n", "Hz", "Hz"),
    "drive_frequency": Output("drive frequency f_q", "Hz", "Hz"),
    "cycle_time": Output("cycle time T_Qall", "s", "ms"),
    "amplitude": Output("amplitude of a phase W_maxf", "m", "µm"),
    "neutral_axis": Output("neutral axis D", "m", "mm"),
    "wavenumber": Output("wavenumber k_c", "1/m", "1/m"),
    "q_ratio": Output("forward over backward X", "1", "1"),
    "q_square_ratio": Output("the same of squares Y", "1", "1"),
    "q_average": Output("speed determinant Q_aver", "1/s", "1/s"),
    "q_volatility": Output("volatility determinant Q_vib", "1/s", "1/s"),
    "mean_speed": Output("mean speed v_s", "rad/s", "arcsec/s"),
    "min_speed": Output("lowest speed", "rad/s", "arcsec/s"),
    "max_speed": Output("highest speed", "rad/s", "arcsec/s"),
    "speed_volatility": Output("speed volatility sigma_s", "1", "%"),
    "stall_torque": Output("stall torque", "N*m", "N*m"),
    "contact_fraction": Output("contact fraction", "1", "1"),
}
