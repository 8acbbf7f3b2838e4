"""What calibration compares with measured columns: operating points row by row, or a decay in time."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

import numpy as np

from trum_sym.calibration.decay import SIGNAL_PARAMETERS, Motion, first_guess, free_motion, slopes_of
from trum_sym.errors import ConvergenceError, ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.measurements import UNCERTAINTY, Measurements
from trum_sym.inputs.motor import SPECS, Motor, spec
from trum_sym.inputs.plausible import usual_range
from trum_sym.inputs.units import parse_unit
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import evaluate
from trum_sym.model.rotor import weight_inertia
from trum_sym.model.sensitivities import DIFFERENTIATED, sensitivities
from trum_sym.model.stator import solve_stator

__all__ = ["FIT_TOLERANCE", "DecayModel", "Model", "PointModel"]

_TURN = 2 * np.pi
FIT_TOLERANCE = 1e-8
"""Of the rotor's orbits."""
_STEP_OF_ORBITS, _STEP_OF_FORMS = 1e-4, 1e-5  # relative steps of the differences
_OF_STATOR = ("resonance_frequency", "drive_frequency", "amplitude", "neutral_axis", "wavenumber")
_ROTOR_SCALES = ("friction_coefficient", "contact_radius", "rotor_inertia")


class Model(Protocol):
    """Predictions for all measured values, and their derivatives by the parameters."""

    names: tuple[str, ...]  # of the parameters: the motor's first
    units: tuple[str, ...]
    before: Array  # what the motor has; NaN for what only the record has
    start: Array  # of the search
    bounds: tuple[Array, Array]
    exact: tuple[bool, ...]  # whose derivatives are
    resolution: float  # relative error of the others
    measured: Array
    uncertainty: Array | None

    def predict(self, values: Array) -> Array:
        """(n,) values that the model gives for ``measured``; NaN where it has no answer."""

    def slopes(self, values: Array) -> Array:
        """(n, k) derivatives of :meth:`predict`."""


def _inside(domain: Domain) -> tuple[float, float]:
    """The closed interval that a search may use: open ends are left out by a hair."""
    low, high = domain.low, domain.high
    if np.isfinite(low) and domain.low_open:
        low = low + 1e-12 * max(abs(low), 1e-12 if not np.isfinite(high) else high - low)
    if np.isfinite(high) and domain.high_open:
        high = high - 1e-12 * max(abs(high), 1e-12)
    return low, high


def _searched(name: str, start: float) -> tuple[float, float]:
    """The interval of a search: the quantity's domain, to ten times beyond what it is of real motors or at the start.

    Data that no motor of this model fits would otherwise drive a value on for ever, at ever longer times a point.
    """
    low, high = _inside(spec(name).domain)
    usual = usual_range(name)
    if usual is None:
        return low, high
    return max(low, min(usual[0], start) / 10), min(high, 10 * max(usual[1], start))


class PointModel:
    """Figures of operating points, row by row."""

    def __init__(
        self,
        data: Measurements,
        motor: Motor,
        names: tuple[str, ...],
        drive: Drive,
        levels: Levels,
        sampling_period: float | None,
    ) -> None:
        columns = {name: data.columns[name] for name in data.inputs}
        self._drive = replace(drive, **columns)  # type: ignore[arg-type]
        self._rows, self._observed = len(data), data.observed
        self._levels, self._sampling_period, self._motor = levels, sampling_period, motor
        self._orbits = not set(self._observed) <= set(_OF_STATOR)
        self.names, self.units = names, tuple(SPECS[name].unit for name in names)
        self.before = self.start = np.array([_start_of(name, motor, self._drive, levels) for name in names])
        ends = [_searched(name, start) for name, start in zip(names, self.start, strict=True)]
        self.bounds = np.array([low for low, _ in ends]), np.array([high for _, high in ends])
        self.exact = tuple(self._is_exact(name) for name in names)
        # differences of orbits see the orbits' tolerance, the slopes their own
        self.resolution = 1e-8 if not self._orbits else 1e-6 if all(self.exact) else FIT_TOLERANCE / _STEP_OF_ORBITS
        self.measured = np.concatenate([data.columns[name] for name in self._observed])
        known = [data.columns.get(name + UNCERTAINTY) for name in self._observed]
        self.uncertainty = None if known[0] is None else np.concatenate([u for u in known if u is not None])
        missing = ~np.isfinite(self._at(self.start[:, np.newaxis])[0])
        if missing.any():
            row = int(np.argmax(missing)) % self._rows + 1
            raise ConvergenceError(
                f"calibrate: the search begins at {_listed(names, self.start)}, where no speed balances the load of "
                f"row {row}; start elsewhere with --set"
            )

    def _is_exact(self, name: str) -> bool:
        of_rotor = set(self._observed) <= set(DIFFERENTIATED) - (
            {"speed_volatility"} if self._sampling_period else set()
        )
        return name in _ROTOR_SCALES and of_rotor and self._levels.tangential == "rigid"

    def _figures(self, motor: Motor, drive: Drive) -> dict[str, ArrayLike]:
        if not self._orbits:
            stator = solve_stator(motor, drive, self._levels)
            f_n = np.asarray(stator.omega_n) / _TURN
            return {
                "resonance_frequency": f_n,
                "drive_frequency": f_n + np.asarray(drive.frequency_difference),
                "amplitude": stator.W,
                "neutral_axis": stator.D,
                "wavenumber": stator.k_c,
            }
        point = evaluate(
            motor,
            drive,
            contact=self._levels.contact,
            resonance=self._levels.resonance,
            foundation=self._levels.foundation,
            amplitude=self._levels.amplitude,
            compliance=self._levels.compliance,
            tangential=self._levels.tangential,
            sampling_period=self._sampling_period,
            tolerance=FIT_TOLERANCE,
        )
        return {name: getattr(point, name) for name in self._observed}

    def _at(self, values: Array) -> Array:
        """Figures of a batch: (k, b) values to (b, n)."""
        changed = {name: column[:, np.newaxis] for name, column in zip(self.names, values, strict=True)}
        found = self._figures(self._motor.with_values(changed), self._drive)
        shape = (values.shape[1], self._rows)
        return np.concatenate([np.broadcast_to(found[name], shape) for name in self._observed], axis=1)

    def predict(self, values: Array) -> Array:
        """(n,) values that the model gives for ``measured``; NaN where it has no answer."""
        try:
            return np.asarray(self._at(values[:, np.newaxis])[0])
        except ParameterError:  # the search left what makes a motor, such as teeth higher than their beam
            return np.full(self._rows * len(self._observed), np.nan)

    def slopes(self, values: Array) -> Array:
        """(n, k) derivatives of :meth:`predict`: the orbit's own where they are known, else central differences."""
        result = np.empty((self._rows * len(self._observed), values.size))
        if any(self.exact):
            of_rotor = self._rotor_slopes(values)
            for k, name in enumerate(self.names):
                if self.exact[k]:
                    result[:, k] = of_rotor[name]
        others = [k for k, exact in enumerate(self.exact) if not exact]
        if others:
            relative = _STEP_OF_ORBITS if self._orbits else _STEP_OF_FORMS
            batch = np.repeat(values[:, np.newaxis], 2 * len(others), axis=1)
            for place, k in enumerate(others):
                step = relative * (abs(values[k]) or abs(self.start[k]) or 1.0)
                low, high = self.bounds[0][k], self.bounds[1][k]
                batch[k, 2 * place], batch[k, 2 * place + 1] = min(values[k] + step, high), max(values[k] - step, low)
            figures = self._at(batch)
            for place, k in enumerate(others):
                up, down = 2 * place, 2 * place + 1
                result[:, k] = (figures[up] - figures[down]) / (batch[k, up] - batch[k, down])
        return result

    def _rotor_slopes(self, values: Array) -> dict[str, Array]:
        """By friction, contact radius and inertia.

        At the rim the pull is friction r_c^2 / J and the drag load r_c / J (eq. 38), J with the load's inertia, so two
        of the three follow from the orbit's slopes by friction and load.
        """
        motor = self._motor.with_values(dict(zip(self.names, (float(v) for v in values), strict=True)))
        known = sensitivities(
            motor,
            self._drive,
            contact=self._levels.contact,
            resonance=self._levels.resonance,
            foundation=self._levels.foundation,
            amplitude=self._levels.amplitude,
            compliance=self._levels.compliance,
            tolerance=FIT_TOLERANCE,
        )
        figures = self._figures(motor, self._drive)
        mu, radius, _ = (float(getattr(motor, name).value) for name in _ROTOR_SCALES)
        symbols = {**motor.symbols(), **self._drive.symbols()}
        inertia = np.broadcast_to(np.asarray(call("trum_total_inertia", symbols)["J_total"]), self._rows)
        weight = np.broadcast_to(weight_inertia(symbols), self._rows)
        found: dict[str, list[Array]] = {name: [] for name in _ROTOR_SCALES}
        for figure in self._observed:
            by_friction = np.broadcast_to(known[figure]["friction_coefficient"], self._rows)
            pull = mu * by_friction
            drag = np.asarray(self._drive.load_torque) * np.broadcast_to(known[figure]["load_torque"], self._rows)
            drag = drag - weight * np.broadcast_to(known[figure]["load_inertia"], self._rows)
            turned = figures[figure] if figure not in ("speed_volatility", "contact_fraction") else 0.0
            found["friction_coefficient"].append(by_friction)
            found["contact_radius"].append((2 * pull + drag - turned) / radius)
            held = figure == "stall_torque"  # a rotor held still has no inertia
            found["rotor_inertia"].append(np.zeros(self._rows) if held else -(pull + drag) / inertia)
        return {name: np.concatenate(parts) for name, parts in found.items()}


def _start_of(name: str, motor: Motor, drive: Drive, levels: Levels) -> float:
    """The motor's value; for one that would replace a modelled one, the modelled one."""
    given = getattr(motor, name)
    if given is not None:
        return float(given.value)
    stator = solve_stator(motor, drive, levels)
    modelled = {
        "resonance_frequency": np.asarray(stator.omega_n) / _TURN,
        "amplitude": stator.W,
        "neutral_axis": stator.D,
        "wavenumber": stator.k_c,
        "layer_stiffness": call("trum_layer_stiffness", motor.symbols())["k_N"],
        "contact_stiffness": stator.values["k_N"],
        "tangential_stiffness": call("trum_tangential_stiffness", motor.symbols())["k_T"],
    }
    if name not in modelled:
        raise ParameterError("parameters", name, "what the motor file has a value for, where a search can begin")
    return float(np.mean(modelled[name]))


def _listed(names: tuple[str, ...], values: Array) -> str:
    return ", ".join(f"{name} = {value:.6g}" for name, value in zip(names, values, strict=True))


class DecayModel:
    """A free vibration: a signal from any state, or the envelope."""

    def __init__(self, data: Measurements, motor: Motor, names: tuple[str, ...], drive: Drive, levels: Levels) -> None:
        (self._signal,) = data.observed
        allowed = ("damping_ratio",) if self._signal == "envelope" else ("damping_ratio", "resonance_frequency")
        for name in names:
            if name not in allowed:
                raise ParameterError("parameters", name, f"{' and '.join(allowed)} for a decay's {self._signal}")
        if "damping_ratio" not in names:
            raise ParameterError("parameters", ", ".join(names), "damping_ratio among them for a decay")
        self.names: tuple[str, ...]
        self.units: tuple[str, ...]
        self._elapsed = data.columns["time"] - data.columns["time"][0]
        self.measured = data.columns[self._signal]
        self.uncertainty: Array | None = None
        resonance = _start_of("resonance_frequency", motor, drive, levels)
        unit = data.units.get(self._signal, "")
        high = _inside(spec("damping_ratio").domain)[1]
        if self._signal == "envelope":
            self._frequency = resonance
            self.names, self.units = ("damping_ratio", "initial_amplitude"), ("1", _si(self._signal, unit))
            self.start = np.array([float(motor.damping_ratio.value) or 1e-3, float(self.measured[0])])
            self.bounds = np.array([0.0, 0.0]), np.array([high, np.inf])
        else:
            rest = SIGNAL_PARAMETERS if "resonance_frequency" in names else ("resonance_frequency", *SIGNAL_PARAMETERS)
            self.names = (*names, *rest)
            si = _si(self._signal, unit)
            self.units = tuple({"damping_ratio": "1", "resonance_frequency": "Hz"}.get(name, si) for name in self.names)
            damping, frequency = first_guess(self._elapsed, self.measured, resonance)
            cosine, sine, _ = free_motion(self._elapsed, damping, frequency)
            basis = np.stack([cosine, sine, np.ones_like(cosine)], axis=1)
            weights = np.linalg.lstsq(basis, self.measured, rcond=None)[0]
            guess = dict(zip(SIGNAL_PARAMETERS, weights, strict=True))
            guess |= {"damping_ratio": damping, "resonance_frequency": frequency}
            self.start = np.array([guess[name] for name in self.names])
            low = {"damping_ratio": 0.0, "resonance_frequency": 0.1 * frequency}
            top = {"damping_ratio": high, "resonance_frequency": 10 * frequency}
            self.bounds = (
                np.array([low.get(name, -np.inf) for name in self.names]),
                np.array([top.get(name, np.inf) for name in self.names]),
            )
        known = {"damping_ratio": float(motor.damping_ratio.value), "resonance_frequency": resonance}
        self.before = np.array([known.get(name, np.nan) for name in self.names])
        self.exact = tuple(name not in known for name in self.names)
        self.resolution = 1e-8

    def predict(self, values: Array) -> Array:
        """(n,) values that the model gives for ``measured``."""
        v = dict(zip(self.names, (float(x) for x in values), strict=True))
        return self._motion(v)(*free_motion(self._elapsed, v["damping_ratio"], self._frequency_of(v)))

    def slopes(self, values: Array) -> Array:
        """(n, k) derivatives of :meth:`predict`."""
        v = dict(zip(self.names, (float(x) for x in values), strict=True))
        cosine, sine, envelope = free_motion(self._elapsed, v["damping_ratio"], self._frequency_of(v))
        columns = {"cosine": cosine, "sine": sine, "offset": np.ones_like(cosine), "initial_amplitude": envelope}
        found = slopes_of(self._motion(v), self._elapsed, v["damping_ratio"], self._frequency_of(v))
        columns |= dict(zip(("damping_ratio", "resonance_frequency"), found, strict=True))
        return np.stack([columns[name] for name in self.names], axis=1)

    def _frequency_of(self, values: dict[str, float]) -> float:
        return self._frequency if self._signal == "envelope" else values["resonance_frequency"]

    def _motion(self, values: dict[str, float]) -> Motion:
        if self._signal == "envelope":
            return lambda cosine, sine, envelope: values["initial_amplitude"] * envelope  # noqa: ARG005
        return lambda cosine, sine, envelope: (  # noqa: ARG005
            values["cosine"] * cosine + values["sine"] * sine + values["offset"]
        )


def _si(signal: str, given: str) -> str:
    """The SI unit of a signal's amplitude; an envelope's is its column's."""
    return {"displacement": "m", "velocity": "m/s"}.get(signal, str(parse_unit(given).dimension) if given else "SI")
