"""How far the inputs of a motor at work may be off, and what that does to its mean speed."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import DRIVE_DOMAINS, SPREADING
from trum_sym.inputs.motor import SPECS, Amount, Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.spreads import Spread, half_width
from trum_sym.model.operating_point import Case, prepare
from trum_sym.model.rotor import solve_orbit
from trum_sym.model.stator import solve_stator

__all__ = ["amounts_at", "amounts_of", "mean_speed_off", "speeds_off", "unit_of"]

_OF_STATOR = {"amplitude", "resonance_frequency"}


def unit_of(name: str) -> str:
    """The SI unit of an input that a speed's slope is by."""
    return DRIVE_DOMAINS[name][1] if name in DRIVE_DOMAINS else SPECS[name].unit


def amounts_of(motor: Motor, spreads: Mapping[str, Spread] | None) -> dict[str, Amount]:
    """How far inputs may be off: what the motor file states, and what is given in its place.

    Parameters
    ----------
    motor : Motor
        Whose ``[spreads]`` count where nothing is given.
    spreads : mapping, optional
        By the names of :data:`trum_sym.inputs.drive.SPREADING`: an amount ``"+-1 N"``, a share ``0.01`` or ``"1 %"``,
        or two ends, whose half distance counts.

    Raises
    ------
    ParameterError
        For a name or a spread that is none.
    """
    if spreads is not None and not isinstance(spreads, Mapping):
        raise ParameterError("spreads", spreads, "a mapping of names to amounts or shares")
    found = dict(motor.spreads)
    for name, given in (spreads or {}).items():
        if name not in SPREADING:
            raise ParameterError("spreads", name, f"one of {', '.join(SPREADING)}")
        value, share = half_width(name, given, unit_of(name))
        found[name] = Amount(value, share, "set")
    return found


def amounts_at(case: Case, amounts: Mapping[str, Amount]) -> dict[str, Array]:
    """How far every input may be off, at every point of a case, in SI units."""
    found = {}
    for name, amount in amounts.items():
        if name in DRIVE_DOMAINS:
            value: ArrayLike = getattr(case.drive, name)
        else:
            modelled = {
                "amplitude": case.stator.W,
                "resonance_frequency": np.asarray(case.stator.omega_n) / (2 * np.pi),
            }
            value = modelled[name] if name in modelled else getattr(case.motor, name).value
        by = amount.value * np.abs(value) if amount.share else amount.value
        found[name] = np.broadcast_to(np.asarray(by, np.float64), case.shape)
    return found


def speeds_off(case: Case, amounts: Mapping[str, Amount], names: Collection[str] | None = None) -> dict[str, Array]:
    """The mean speed with one input off, to more and to less, by the input's name; (2, ...) with the case's shape."""
    off = amounts_at(case, amounts)
    found: dict[str, Array] = {}
    for group in (_OF_STATOR, set(SPREADING) - _OF_STATOR):  # what replaces a modelled value is computed by itself
        chosen = [name for name in amounts if name in group and (names is None or name in names)]
        if not chosen:
            continue
        sides = np.array([1.0, -1.0]).reshape(2, *(1,) * len(case.shape))
        none = np.zeros((2, *case.shape))
        offsets = {
            name: np.concatenate([sides * off[name] if other == name else none for other in chosen]) for name in chosen
        }
        speeds = mean_speed_off(case, offsets)
        found |= {name: speeds[2 * k : 2 * k + 2] for k, name in enumerate(chosen)}
    return {name: found[name] for name in amounts if name in found}


def mean_speed_off(case: Case, offsets: Mapping[str, Array]) -> Array:
    """The mean speed with inputs off by these amounts, in SI units; of the offsets' shape."""
    motor, of_drive = case.motor, {name: off for name, off in offsets.items() if name in DRIVE_DOMAINS}
    moved_to: dict[str, Any] = {name: np.asarray(getattr(case.drive, name)) + off for name, off in of_drive.items()}
    drive = replace(case.drive, **moved_to)
    with unquestioned():
        if "friction_coefficient" in offsets:
            friction = np.asarray(motor.friction_coefficient.value) + offsets["friction_coefficient"]
            motor = motor.with_values({"friction_coefficient": friction})
        if _OF_STATOR & set(offsets):
            stator = solve_stator(motor, drive, case.levels, warn=False)
            modelled = {"amplitude": stator.W, "resonance_frequency": np.asarray(stator.omega_n) / (2 * np.pi)}
            motor = motor.with_values({name: modelled[name] + offsets[name] for name in modelled if name in offsets})
        moved = prepare(motor, drive, case.levels, case.tolerance, warn=False)
    return np.asarray(solve_orbit({**moved.arguments, "held": 0.0}, moved.symbols).mean_speed)
