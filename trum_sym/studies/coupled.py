"""Curves of a plain wave that the rotor acts back on: what :func:`trum_sym.characteristics` has at that level."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.coupling import PlainWaves, coupled_values, plain_waves, standing, wave_at
from trum_sym.model.levels import Levels
from trum_sym.model.port import drawn, has_port

__all__ = ["COUPLED", "coupled_curves"]

COUPLED = {
    "amplitude": ("torque", "m", "height of the wave"),
    "lead": ("torque", "rad", "by which the modal force is ahead of the wave"),
    "resonance_shift": ("torque", "Hz", "resonance of a wave of this height less that without a rotor"),
    "input_power": ("torque", "W", "that the modal forces of both phases put in"),
    "contact_power": ("torque", "W", "that the stator's surface gives to the contact"),
    "layer_power": ("torque", "W", "that the layer loses"),
    "layer_share": ("torque", "1", "of the input power that the layer loses"),
    "efficiency": ("torque", "1", "output power over input power"),
    "standing_amplitude": ("torque", "m", "height of the wave up to which friction holds the rotor"),
    "standing_voltage": ("torque", "V", "up to which it does if the voltage rises from none"),
    "current": ("torque", "A", "amplitude of a phase's current"),
    "electric_power": ("torque", "W", "that both phases draw"),
    "reactive_power": ("torque", "W", "of both phases, positive where the current is behind the voltage"),
    "power_factor": ("torque", "1", "electric power over that of effective voltage and current"),
    "electric_efficiency": ("torque", "1", "output power over electric power"),
    "droop_compliance": ("torque", "1", "speed over that without load, were the wave to stay as it is without load"),
    "droop_reaction": ("torque", "1", "what the load's effect on the wave makes of that"),
    "states": ("torque", "1", "steady states at this load"),
    "amplitude_by_frequency": ("frequency", "m", "height of the wave without load"),
    "states_by_frequency": ("frequency", "1", "steady states without load"),
    "amplitude_by_prepressure": ("prepressure", "m", "height of the wave without load"),
}
"""Variables that only this level has: the axis that they are over, unit, meaning."""

_TURN = 2 * np.pi


class _Found:
    """The stable state of the highest wave at one point, NaN where there is none."""

    def __init__(self, motor: Motor, drive: Drive, levels: Levels) -> None:
        self.values = coupled_values(motor, drive, levels)
        self.waves = plain_waves(self.values)
        self.direction = float(np.asarray(self.values["s"]))

    def of(self, name: str) -> float:
        """A field of the state."""
        index = self.waves.highest
        return float(getattr(self.waves, name)[index]) if index >= 0 else float("nan")

    def drawn(self, name: str) -> float:
        """A field of what the state draws, NaN where the motor file does not say what that takes."""
        index = self.waves.highest
        known = index >= 0 and has_port(self.values)
        return float(getattr(drawn(self.values, self.waves), name)[index]) if known else float("nan")

    @property
    def speed(self) -> float:
        """Along the direction in which the wave drives."""
        return self.direction * self.of("speed")

    @property
    def drive_frequency(self) -> float:
        return float(np.asarray(self.values["omega_q"])) / _TURN

    def standing(self) -> tuple[float, float]:
        """Height of the wave, in m, and voltage up to which the rotor stands."""
        height, force = standing(self.values)
        return height, force / float(np.asarray(self.values["F_q"])) * float(np.asarray(self.values["U_s"]))

    def stall(self) -> float:
        """Torque on a rotor held still, along the same direction."""
        held = plain_waves(self.values, "held")
        most = float(np.asarray(self.values["mu"]) * self.values["F_c"] * self.values["r_c"])
        return most * float(held.friction[held.highest]) if held.highest >= 0 else float("nan")


def coupled_curves(motor: Motor, drive: Drive, levels: Levels, axes: dict[str, Array]) -> dict[str, Any]:
    """All curves of the plain wave.

    Parameters
    ----------
    motor, drive, levels
        Of one point; the load is replaced.
    axes : mapping
        Abscissae ``torque`` (N m), ``frequency`` (Hz) and ``prepressure`` (N).

    Returns
    -------
    dict
        Arrays by the names of :func:`trum_sym.characteristics` and of :data:`COUPLED`.
    """
    free = replace(drive, load_torque=0.0)

    def at(**changed: Any) -> _Found:  # noqa: ANN401
        return _Found(motor, replace(free, **changed), levels)

    rest = at()
    loaded = [at(load_torque=rest.direction * load) for load in axes["torque"]]
    by_frequency = [at(frequency_difference=offset) for offset in axes["frequency"]]
    by_prepressure = [at(prepressure=force) for force in axes["prepressure"]]
    speed = np.array([found.speed for found in loaded])
    speed = np.where(speed >= 0, speed, np.nan)
    power = axes["torque"] * speed
    given = np.array([found.of("contact_power") for found in loaded])
    spent = np.array([found.of("input_power") for found in loaded])
    kept = np.array([_kept(rest, found) for found in loaded])
    with np.errstate(all="ignore"):
        return {
            "mean_speed": speed,
            "output_power": power,
            "contact_efficiency": power / given,
            "speed_by_frequency": np.array([found.speed for found in by_frequency]),
            "drive_frequency": np.array([found.drive_frequency for found in by_frequency]),
            "speed_by_prepressure": np.array([found.speed for found in by_prepressure]),
            "stall_by_prepressure": np.array([found.stall() for found in by_prepressure]),
            "stall_torque": rest.stall(),
            "direction": rest.direction,
            "amplitude": np.array([found.of("amplitude") for found in loaded]),
            "lead": np.array([found.of("lead") for found in loaded]),
            "resonance_shift": np.array([found.of("resonance") - found.values["omega_n0"] for found in loaded]) / _TURN,
            "input_power": spent,
            "contact_power": given,
            "efficiency": power / spent,
            **_layer(loaded, spent),
            **_electric(loaded, power),
            "droop_compliance": kept,
            "droop_reaction": speed / rest.speed / kept,
            "states": np.array([float(found.waves.amplitude.size) for found in loaded]),
            "amplitude_by_frequency": np.array([found.of("amplitude") for found in by_frequency]),
            "states_by_frequency": np.array([float(found.waves.amplitude.size) for found in by_frequency]),
            "amplitude_by_prepressure": np.array([found.of("amplitude") for found in by_prepressure]),
        }


def _layer(loaded: list[_Found], spent: Array) -> dict[str, Array]:
    """What the layer loses under each load, and up to where the rotor stands."""
    lost, stands = np.array([found.of("layer_power") for found in loaded]), [found.standing() for found in loaded]
    return {
        "layer_power": lost,
        "layer_share": lost / spent,
        "standing_amplitude": np.array([height for height, _ in stands]),
        "standing_voltage": np.array([voltage for _, voltage in stands]),
    }


def _electric(loaded: list[_Found], power: Array) -> dict[str, Array]:
    """What the phases draw under each load, and the output power over it."""
    draws = {
        name: np.array([found.drawn(name) for found in loaded])
        for name in ("current", "electric_power", "reactive_power", "power_factor")
    }
    return {**draws, "electric_efficiency": power / draws["electric_power"]}


def _kept(rest: _Found, loaded: _Found) -> float:
    """Speed of the rotor under load over that without, on the wave as it is without."""
    if rest.waves.highest < 0 or loaded.waves.highest < 0:
        return float("nan")
    same: PlainWaves = wave_at(loaded.values, np.array([rest.of("amplitude")]))
    return rest.direction * float(same.speed[0]) / rest.speed
