"""Time histories of the orbit of wave, contact and rotor together, for :func:`trum_sym.simulate`."""

from __future__ import annotations

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.model.coupled_orbit import STATE
from trum_sym.model.coupled_point import CoupledCase, CoupledPoint, gates_of
from trum_sym.model.drive_orbit import history_of
from trum_sym.model.kernels import call

__all__ = ["VARIABLES", "coupled_cycles"]

VARIABLES = {
    "w_A": ("m", "modal displacement of phase A"),
    "w_B": ("m", "modal displacement of phase B"),
    "zeta_z": ("m", "displacement of the surface towards the rotor at x = 0 (eq. 11)"),
    "zeta_x": ("m", "displacement of the surface along the circumference at x = 0 (eq. 11)"),
    "crest_speed": ("m/s", "speed of the surface along the circumference at the wave's crest"),
    "theta": ("rad", "contact half-angle, pi for a whole wave in contact (eq. 31)"),
    "pressure_force": ("N", "of the layer on the rotor, against the prepressure"),
    "friction": ("1", "net friction, share of mu F_c (eqs. 34 to 37)"),
    "rotor_height": ("m", "height of the rotor over the surface of a stator at rest"),
    "rotor_speed": ("rad/s", "speed of the rotor (eq. 38)"),
    "rotor_angle": ("rad", "angle of the rotor since t1 of the first cycle"),
}
"""Unit and meaning of every variable; there is no direction determinant, which is of a prescribed wave."""


def coupled_cycles(case: CoupledCase, point: CoupledPoint, cycles: int, per_period: int) -> dict[str, Array]:
    """Some drive cycles of a single point's orbit at equal times; NaN where the load exceeds what friction carries.

    Parameters
    ----------
    case, point
        From :func:`trum_sym.model.coupled_point.prepare_coupled` and ``coupled_point``.
    cycles, per_period : int
        Drive cycles, and parts of a drive period.

    Returns
    -------
    dict
        (cycles * m * per_period,) arrays by the names of :data:`VARIABLES`, the first at t1.
    """
    values, orbit = case.points[0], point.orbit
    count = cycles * int(values["m"]) * per_period
    if orbit is None:
        return {name: np.full(count, np.nan) for name in VARIABLES}
    walked = history_of(values, orbit.state, gates_of(values, orbit.cycles), per_period)
    moving = dict(zip(STATE, walked.states[:, :-1], strict=True))
    instant = call("trum_coupled_instant", {**values, **moving})
    acting = call("trum_coupled_forces", {**values, **instant, "v": moving["v"]})
    found = {
        "w_A": moving["w_A"],
        "w_B": moving["w_B"],
        **call("trum_displacement", {**moving, "D": values["D"], "k_c": values["k_c"], "x": 0.0}),
        "crest_speed": np.asarray(instant["R_v"]) * np.asarray(instant["cos_phi"]),
        "theta": instant["theta"],
        "pressure_force": acting["F_z"],
        "friction": np.asarray(acting["F_x"]) / (values["mu"] * values["F_c"]),
        "rotor_height": moving["height"],
        "rotor_speed": walked.speed[:-1],
    }
    repeats = -(-cycles // orbit.cycles)
    tiled = {name: np.tile(np.asarray(column), repeats)[:count] for name, column in found.items()}
    advance = walked.angle[-1] * np.repeat(np.arange(repeats), walked.angle.size - 1)
    tiled["rotor_angle"] = (np.tile(walked.angle[:-1], repeats) + advance)[:count]
    return tiled
