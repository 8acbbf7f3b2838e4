"""What becomes of the paper's plain wave where the rotor acts back on it, as tables beside the prescribed one."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.coupling import check_coupling, coupled_values, plain_waves
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import evaluate
from trum_sym.model.port import drawn, has_port
from trum_sym.paper.tables import Table

__all__ = ["coupled_tables"]

_TURN = 2 * np.pi
_LEVELS = {"layer": Levels(coupling="contact"), "flange": Levels(compliance="flange", coupling="contact")}
_OFFSETS = (0.0, 500.0, 1500.0, 3000.0)  # Hz above eq. 6's resonance; the last is Table 3's
_SHARE = 0.5  # of the torque that friction carries


class _Wave(NamedTuple):
    """The stable state of the highest wave, and what it takes; NaN where there is none."""

    values: dict[str, float]
    amplitude: float
    shift: float
    speed: float
    electric: float
    output: float


def _drive(offset: float, load: float) -> Drive:
    return Drive(frequency_difference=offset, load_torque=load, on_periods=Drive().periods)


def _wave(motor: Motor, levels: Levels, offset: float, load: float) -> _Wave:
    values = {name: float(np.asarray(v)) for name, v in coupled_values(motor, _drive(offset, load), levels).items()}
    waves = plain_waves(values)
    place = waves.highest
    if place < 0:
        return _Wave(values, *([np.nan] * 5))
    power = float(drawn(values, waves).electric_power[place]) if has_port(values) else np.nan
    shift = float(waves.resonance[place] - values["omega_n0"]) / _TURN
    at = float(waves.amplitude[place]), shift, float(waves.speed[place]), power, float(waves.output_power[place])
    return _Wave(values, *at)


def _asked(values: dict[str, float], amplitude: float) -> float:
    """The modal force of a plain wave of eq. 6's resonance that nothing else reacts on, N."""
    alone = {**values, "omega_n0": values["omega_n"], "W": amplitude, "central": 0.0, "along": 0.0}
    found = call("trum_plain_balance", alone)
    return float(np.hypot(np.asarray(found["in_phase"]), np.asarray(found["ahead"])))


def coupled_tables(motor: Motor) -> tuple[Table, ...]:
    """Three tables: the plain wave over the drive frequency, and under load; Table 3's pulses; none for a motor without
    that level.

    Parameters
    ----------
    motor : Motor
        Of single numbers.
    """
    for levels in _LEVELS.values():
        try:
            check_coupling(motor, _drive(0.0, 0.0), levels)
            coupled_values(motor, _drive(0.0, 0.0), levels)
        except ParameterError:  # an amplitude under prepressure, no friction, no flange, ...
            return ()
    steady, loss = (_by_frequency(motor), _under_load(motor)), motor.layer_loss_factor
    if loss is not None and float(np.asarray(loss.value)) > 0:  # which pulses do not know
        return steady
    return (*steady, _in_pulses(motor))


def _text(value: float, digits: str = ".3g") -> str:
    return f"{value:{digits}}".replace("-", "−") if np.isfinite(value) else "none"


def _by_frequency(motor: Motor) -> Table:
    rows = []
    for offset in _OFFSETS:
        prescribed = evaluate(motor, _drive(offset, 0.0))
        layer, flange = (_wave(motor, levels, offset, 0.0) for levels in _LEVELS.values())
        size = float(np.asarray(prescribed.amplitude))
        asked = _asked(layer.values, size)
        rows.append(
            (
                f"+{offset:g}" if offset else "0",
                _text(layer.values["omega_q"] / _TURN, ".0f"),
                *(_text(1e6 * w) for w in (size, layer.amplitude, flange.amplitude)),
                _text(asked, ".0f"),
                _text(asked / layer.values["F_q"], ".2g"),
                *(_text(x, ".0f") for x in (layer.shift, flange.shift)),
                *(_text(x) for x in (float(prescribed.mean_speed), layer.speed, flange.speed)),
            )
        )
    given = layer.values
    ceramic = float(np.asarray(call("trum_modal", given)["F_ceramic"]))
    return Table(
        "coupling-frequency",
        "The plain wave over the drive frequency",
        "Both phases always on, Table 3's prepressure, no load; frequencies above eq. 6's resonance. Prescribed: eq. "
        "8's amplitude at every frequency. With coupling the modal force is given and amplitude and resonance follow, "
        "on the layer alone and with the rotor's flange. Force asked: what eq. 8's amplitude takes of a phase that "
        f"resonates where eq. 6 says; the free amplitude at resonance stands for {_text(given['F_q'], '.0f')} N, the "
        f"ceramic's data give {_text(ceramic, '.0f')} N. Resonance up by: over that without a rotor, "
        f"{_text(given['omega_n0'] / _TURN, '.0f')} Hz.",
        (
            "Δf (Hz)",
            "drive (Hz)",
            "W by eq. 8 (µm)",
            "W, layer",
            "W, flange",
            "force asked (N)",
            "over the given",
            "resonance up by (Hz), layer",
            "flange",
            "speed (rad/s), prescribed",
            "layer",
            "flange",
        ),
        tuple(rows),
        tuple(range(12)),
    )


def _under_load(motor: Motor) -> Table:
    values = {**motor.symbols(), **_drive(0.0, 0.0).symbols(), "f": 1.0}
    load = _SHARE * float(np.asarray(call("trum_stall_torque", values)["torque"]))
    rows = []
    for offset in (500.0, 3000.0):
        kept = []
        for levels in _LEVELS.values():
            speeds = [evaluate(motor, _drive(offset, t), compliance=levels.compliance).mean_speed for t in (0.0, load)]
            kept.append(float(speeds[1]) / float(speeds[0]))
        for (name, levels), prescribed in zip(_LEVELS.items(), kept, strict=True):
            rest, loaded = (_wave(motor, levels, offset, t) for t in (0.0, load))
            rows.append(
                (
                    f"+{offset:g}",
                    name,
                    _text(prescribed),
                    _text(loaded.speed / rest.speed),
                    _text(loaded.output),
                    _text(loaded.electric),
                    _text(100 * loaded.output / loaded.electric),
                )
            )
    return Table(
        "coupling-load",
        "The plain wave under load",
        f"Under {_text(load)} N m, half of what friction carries. A negative speed kept: the load turns the "
        "rotor back. Electric power: of both phases, with the ceramic's loss; nearly all of it is lost in the stator, "
        "by the damping ratio that was measured with the rotor on it.",
        (
            "Δf (Hz)",
            "contact",
            "speed kept, prescribed",
            "speed kept, coupled",
            "output power (W)",
            "electric power (W)",
            "efficiency (%)",
        ),
        tuple(rows),
        (0, 2, 3, 4, 5, 6),
    )


def _in_pulses(motor: Motor) -> Table:
    """Table 3's point, its wave prescribed or coupled, without and with the bench's plate."""
    plate = float(motor.bench["load_inertia"].value) if "load_inertia" in motor.bench else 0.0
    with unquestioned():  # the limit of a light rotor, outside any range of a mass
        masses = {"none": motor.with_values({"rotor_mass": 0.0})}
    if motor.rotor_mass is not None:
        masses[f"{1e3 * float(motor.rotor_mass.value):g} g"] = motor
    rows = []
    for levels, inertia in product(_LEVELS.values(), dict.fromkeys((0.0, plate))):
        drive, compliance = Drive(load_inertia=inertia), levels.compliance
        load = f"{inertia:.2g}" if inertia else "0"
        prescribed = evaluate(motor, drive, compliance=compliance)
        swing = float(prescribed.speed_volatility) * abs(float(prescribed.mean_speed))
        of_none = (_text(float(prescribed.mean_speed)), _text(swing), _text(1e6 * float(prescribed.amplitude)))
        rows.append((compliance, load, "prescribed", *of_none, "", ""))
        for mass, machine in masses.items():
            point = evaluate(machine, drive, compliance=compliance, coupling="contact")
            swing = float(point.speed_volatility) * abs(float(point.mean_speed))
            speeds = (_text(float(point.mean_speed)), _text(swing), _text(1e6 * float(point.highest_wave)))
            state = f"from {point.start}, {point.branch}" if point.converged else str(point.reason)
            rows.append((compliance, load, mass, *speeds, _text(float(point.input_power)), state))
    return Table(
        "coupling-pulses",
        "Superimposed pulses",
        "Table 3's point, with and without the inertia of the bench's plate. Prescribed: eq. 8's amplitude of a phase, "
        "which no drive of this ceramic can give 3 kHz above the resonance. With coupling: the modal force of the "
        "measured free amplitude, and the highest wave that it makes. Laps begin at rest and in both phases' steady "
        "swing; the last column says from which the orbit is, and which it is of those that attract.",
        (
            "contact",
            "load's inertia (kg m²)",
            "rotor's mass, or prescribed",
            "mean speed (rad/s)",
            "standard deviation (rad/s)",
            "amplitude, highest wave (µm)",
            "input power (W)",
            "orbit",
        ),
        tuple(rows),
        (1, 3, 4, 5, 6),
    )
