"""Whether a motor can be what its numbers say: sizes that contradict each other, materials that do not exist.

None of this is refused: a study may ask what such a motor would do.  It is warned of, with the unit that may be meant.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple, Protocol

import numpy as np

from trum_sym.errors import ImplausibleWarning
from trum_sym.inputs.checks import ArrayLike, outside

__all__ = ["doubts", "outside_range", "unquestioned", "usual_range", "warn_implausible", "warn_outside_range"]

_quiet: ContextVar[bool] = ContextVar("_quiet", default=False)


class Stated(Protocol):
    """What is looked at of a parameter of the motor; see :class:`trum_sym.inputs.motor.Parameter`."""

    @property
    def value(self) -> ArrayLike: ...
    @property
    def unit(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def range(self) -> tuple[float, float] | None: ...


class _Usual(NamedTuple):
    """From the least to the most that such a value is, in SI, and the units that people write it in."""

    low: float
    high: float
    units: str
    of: str


# wide: a factor of two or more beyond handbook values on either side
_USUAL = {
    "radius": _Usual(1e-3, 1.0, "mm", "a stator"),
    "beam_density": _Usual(1e3, 25e3, "g/cm^3", "a metal"),
    "beam_young_modulus": _Usual(5e9, 1e12, "GPa MPa", "a metal"),
    "beam_shear_modulus": _Usual(2e9, 5e11, "GPa MPa", "a metal"),
    "piezo_density": _Usual(1e3, 15e3, "g/cm^3", "a piezoelectric"),
    "piezo_young_modulus": _Usual(1e9, 5e11, "GPa MPa", "a piezoelectric"),
    "piezo_shear_modulus": _Usual(5e8, 2e11, "GPa MPa", "a piezoelectric"),
    "piezo_strain_constant": _Usual(1e-13, 5e-9, "pC/N", "a piezoelectric"),
    "piezo_compliance": _Usual(1e-12, 1e-9, "um^2/N", "a piezoelectric"),
    "voltage": _Usual(0.1, 1e4, "", "a piezoelectric motor"),
    "layer_density": _Usual(200.0, 20e3, "g/cm^3", "a friction layer"),
    "layer_young_modulus": _Usual(5e5, 1e12, "GPa MPa", "a friction layer"),
    "damping_ratio": _Usual(0.0, 0.2, "%", "a resonator"),
    "free_amplitude": _Usual(1e-9, 1e-3, "um", "a stator"),
    "flange_young_modulus": _Usual(5e8, 1e12, "GPa MPa", "a rotor"),
    "friction_coefficient": _Usual(0.0, 1.5, "", "a friction layer"),
    "resonance_frequency": _Usual(1e3, 1e7, "kHz", "an ultrasonic stator"),
    "amplitude": _Usual(1e-9, 1e-3, "um", "a stator"),
}
_OURS = ("trum_sym", "dataclasses")
_TURN = 2 * math.pi
_SAME = 0.01  # by how much two values of one size may differ
_ALIKE = 2.0  # by what factor two that follow from each other in an isotropic body only


def usual_range(name: str) -> tuple[float, float] | None:
    """From the least to the most that a quantity of real motors is, in SI; None where nothing is known.

    Examples
    --------
    >>> usual_range("friction_coefficient")
    (0.0, 1.5)
    """
    return (_USUAL[name].low, _USUAL[name].high) if name in _USUAL else None


@contextmanager
def unquestioned() -> Iterator[None]:
    """For searches and samples, which go where no motor is on purpose."""
    token = _quiet.set(True)
    try:
        yield
    finally:
        _quiet.reset(token)


def warn_implausible(motor: Mapping[str, Stated]) -> None:
    """Warn of everything that :func:`doubts` says."""
    if not _quiet.get():
        for doubt in doubts(motor):
            _warn(doubt)


def warn_outside_range(name: str, value: ArrayLike, before: Stated | None) -> None:
    """Warn of a value outside the range that was stated for it."""
    doubt = None if _quiet.get() else outside_range(name, value, before)
    if doubt is not None:
        _warn(doubt)


def _warn(doubt: str) -> None:
    """Warn at the line that called the package."""
    level, frame = 1, sys._getframe(0)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in _OURS:
        level, frame = level + 1, frame.f_back
    warnings.warn(doubt, ImplausibleWarning, stacklevel=level)


def outside_range(name: str, value: ArrayLike, stated: Stated | None) -> str | None:
    """What to say of a value outside the range that was stated for it, else None."""
    if stated is None or stated.range is None:
        return None
    low, high = stated.range
    beyond = outside(value, low, high)
    if not beyond.any():
        return None
    unit = "" if stated.unit == "1" else f" {stated.unit}"
    return (
        f"{name}: {np.asarray(value)[beyond].flat[0]:.6g}{unit} lies outside {low:g} to {high:g}{unit}, which the "
        f"motor file states for it ({stated.source})"
    )


def doubts(motor: Mapping[str, Stated]) -> list[str]:
    """What no such motor has, a line each, by the names of the motor file.

    ``motor`` has its parameters by name.  Values that follow from each other are compared, bodies that lie in each
    other, and materials with what there is.
    """
    with np.errstate(all="ignore"):
        unusual = dict(_unusual(motor))
        return [*_sizes(motor), *_bodies(motor), *_elasticity(motor, unusual), *unusual.values()]


def _value(motor: Mapping[str, Stated], name: str) -> Any:  # noqa: ANN401
    """As an array of at least one value; NaN where an optional one is not given: then nothing is doubted."""
    return np.asarray(motor[name].value if name in motor else math.nan)


def _first(wrong: Any, *values: Any) -> tuple[float, ...]:  # noqa: ANN401
    """The values where the first is wrong."""
    place = np.flatnonzero(wrong)[0]
    return tuple(float(np.broadcast_to(value, wrong.shape).flat[place]) for value in values)


def _sizes(motor: Mapping[str, Stated]) -> Iterator[str]:
    """Values of one size."""
    radius, around, crests, wavenumber = (_value(motor, n) for n in ("radius", "perimeter", "crests", "wavenumber"))
    wrong = np.abs(around / (_TURN * radius) - 1) > _SAME
    if wrong.any():
        r, u = _first(wrong, radius, around)
        meant = f"; is {1e3 * r:.6g} mm the diameter?" if abs(u / (math.pi * r) - 1) <= _SAME else ""
        yield (
            f"radius: {1e3 * r:.6g} mm contradicts perimeter {1e3 * u:.6g} mm, of which 2 pi radius, "
            f"{1e3 * _TURN * r:.6g} mm, may differ by {100 * _SAME:g} %{meant}"
        )
    wrong = np.abs(wavenumber * radius / crests - 1) > 0.1
    if wrong.any():
        k, n, r = _first(wrong, wavenumber, crests, radius)
        yield f"wavenumber: {k:.6g} 1/m contradicts crests / radius, {n / r:.6g} 1/m, by more than 10 %"


def _bodies(motor: Mapping[str, Stated]) -> Iterator[str]:
    """What lies in or on what."""

    def beyond(name: str, value: Any, limit: Any, what: str) -> Iterator[str]:  # noqa: ANN401
        wrong = value > limit * (1 + 1e-9)
        if wrong.any():
            found, most = _first(wrong, value, limit)
            yield f"{name}: {1e3 * found:.6g} mm is more than {what}, {1e3 * most:.6g} mm"

    def at(name: str) -> Any:  # noqa: ANN401
        return _value(motor, name)

    contact, radius, width = at("contact_radius"), at("radius"), at("beam_width")
    yield from beyond("contact_radius", contact, radius, "the stator's outer radius")
    wrong = contact < (radius - width) * (1 - 1e-9)
    if wrong.any():
        r, inner = _first(wrong, contact, radius - width)
        yield f"contact_radius: {1e3 * r:.6g} mm lies inside the ring, whose inner radius is {1e3 * inner:.6g} mm"
    yield from beyond("beam_width", width, radius, "the stator's outer radius")
    yield from beyond("layer_width", at("layer_width"), width, "the beam's width")
    yield from beyond("piezo_width", at("piezo_width"), width, "the beam's width")
    yield from beyond("beam_thickness", at("beam_thickness"), radius, "the stator's outer radius")
    yield from beyond("piezo_thickness", at("piezo_thickness"), at("beam_thickness"), "the beam's thickness")
    yield from beyond("layer_thickness", at("layer_thickness"), at("beam_thickness"), "the beam's thickness")
    yield from beyond(
        "flange_thickness", at("flange_thickness"), at("flange_length"), "the flange's length, no thin plate"
    )
    section = at("beam_thickness") + at("piezo_thickness")
    yield from beyond("neutral_axis", at("neutral_axis"), section, "beam and piezoelectric ring together")
    yield from beyond("amplitude", at("amplitude"), at("free_amplitude"), "the free amplitude")


def _elasticity(motor: Mapping[str, Stated], unusual: Mapping[str, str]) -> Iterator[str]:
    """Moduli that follow from each other in an isotropic body, and nearly so in any other; not of ``unusual`` ones."""
    for body in ("beam", "piezo"):
        if not unusual.keys().isdisjoint((f"{body}_young_modulus", f"{body}_shear_modulus")):
            continue
        names = (f"{body}_{of}" for of in ("young_modulus", "shear_modulus", "poisson_ratio"))
        young, shear, poisson = (_value(motor, name) for name in names)
        wrong = np.abs(np.log(shear * 2 * (1 + poisson) / young)) > math.log(_ALIKE)
        if wrong.any():
            found, follows = _first(wrong, shear, young / (2 * (1 + poisson)))
            yield (
                f"{body}_shear_modulus: {found / 1e9:.6g} GPa is far from {follows / 1e9:.6g} GPa, which follows from "
                f"{body}_young_modulus and {body}_poisson_ratio"
            )
    if not unusual.keys().isdisjoint(("piezo_compliance", "piezo_young_modulus")):
        return
    compliance, young = _value(motor, "piezo_compliance"), _value(motor, "piezo_young_modulus")
    wrong = np.abs(np.log(compliance * young)) > math.log(_ALIKE)
    if wrong.any():
        found, follows = _first(wrong, compliance, 1 / young)
        yield f"piezo_compliance: {found:.6g} m^2/N is far from 1 / piezo_young_modulus, {follows:.6g} m^2/N"


def _unusual(motor: Mapping[str, Stated]) -> Iterator[tuple[str, str]]:
    """Values of no material there is, by name, and what to say of them."""
    for name, usual in _USUAL.items():
        if name not in motor:
            continue
        parameter = motor[name]
        wrong = outside(np.abs(parameter.value), usual.low, usual.high)
        if wrong.any():
            (found,) = _first(wrong, parameter.value)
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            yield (
                name,
                f"{name}: {found:.6g}{unit} is not that of {usual.of}, {usual.low:g} to {usual.high:g}{unit}"
                + _suspected(found, usual),
            )


def _suspected(found: float, usual: _Usual) -> str:
    """The unit that may be meant: the one that people use, if the number as it is would be usual in it."""
    from trum_sym.inputs.units import parse_unit

    for unit in usual.units.split():
        if usual.low <= abs(parse_unit(unit).to_si(found)) <= usual.high:
            return f"; is {found:.6g} {unit} meant?"
    return ""
