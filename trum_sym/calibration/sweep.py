"""An admittance sweep of a stator without a rotor: resonance, damping, force factor, capacitance and its loss."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.measurements import UNCERTAINTY, Measurements
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.stator import solve_stator

__all__ = ["SweepModel"]

_TURN = 2 * np.pi
_OF_MOTOR = {  # what the record has, and by what parameter of the motor it can be asked for
    "force_factor": "piezo_strain_constant",
    "capacitance": "piezo_permittivity",
    "loss_factor": "piezo_loss_factor",
}
_UNITS = {"free_resonance": "Hz", "force_factor": "N/V", "capacitance": "F", "loss_factor": "1"}
_DAMPING = np.geomspace(1e-5, 0.5, 60)  # tried to begin with
_STEP = 1e-6  # relative, of differences


class SweepModel:
    """Conductance and susceptance of a phase by frequency; see :class:`trum_sym.calibration.models.Model`.

    A phase shows force_factor^2 over its modal mass; the mass is the motor's.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    uncertainty: Array | None

    def __init__(self, data: Measurements, motor: Motor, names: tuple[str, ...], drive: Drive, levels: Levels) -> None:
        allowed = ("damping_ratio", *_OF_MOTOR.values())
        for name in names:
            if name not in allowed:
                raise ParameterError("parameters", name, f"{' and '.join(allowed)} for an admittance sweep")
        if "damping_ratio" not in names:
            raise ParameterError("parameters", ", ".join(names), "damping_ratio among them for an admittance sweep")
        self._values = _stator(motor, drive, levels)
        self._omega = _TURN * data.columns["frequency"]
        self.measured = np.concatenate([data.columns[name] for name in data.observed])
        known = [data.columns.get(name + UNCERTAINTY) for name in data.observed]
        self.uncertainty = None if known[0] is None else np.concatenate([u for u in known if u is not None])
        rest = tuple(of for of, name in _OF_MOTOR.items() if name not in names)
        self.names = (*names, "free_resonance", *rest)
        self.units = tuple(SPECS[name].unit if name in SPECS else _UNITS[name] for name in self.names)
        guess = self._first_guess()
        self.before = np.array([self._before(name, motor) for name in self.names])
        self.start = np.array([guess[name] for name in self.names])
        ends = [self._ends(name, value) for name, value in zip(self.names, self.start, strict=True)]
        self.bounds = np.array([low for low, _ in ends]), np.array([high for _, high in ends])
        self.exact = (False,) * len(self.names)
        self.resolution = 1e-8

    def predict(self, values: Array) -> Array:
        """(n,) values that the model gives for ``measured``."""
        return self._at(dict(zip(self.names, (float(x) for x in values), strict=True)))

    def slopes(self, values: Array) -> Array:
        """(n, k) derivatives of :meth:`predict`, by central differences."""
        result = np.empty((self.measured.size, values.size))
        for k, value in enumerate(values):
            step = _STEP * (abs(value) or abs(self.start[k]) or 1.0)
            up, down = values.copy(), values.copy()
            up[k], down[k] = value + step, value - step
            result[:, k] = (self.predict(up) - self.predict(down)) / (up[k] - down[k])
        return result

    def _at(self, v: dict[str, float]) -> Array:
        around = {**self._values, **{SPECS[name].symbol: v[name] for name in v if name in SPECS}}
        around["omega_n0"] = _TURN * v["free_resonance"]
        factor = v["force_factor"] if "force_factor" in v else _factor(around)
        around |= {"Theta_q": factor, "C_0": v["capacitance"] if "capacitance" in v else _capacitance(around)}
        around["tan_delta"] = v["loss_factor"] if "loss_factor" in v else v["piezo_loss_factor"]
        found = call("trum_free_admittance", {**around, "omega_q": self._omega})
        return np.concatenate([np.asarray(found["conductance"]), np.asarray(found["susceptance"])])

    def _first_guess(self) -> dict[str, float]:
        """Where the conductance, over its uncertainty, is largest, and the best of some damping ratios; linear else.

        Raises
        ------
        ParameterError
            Where the largest conductance is at an end of the sweep, or not positive.
        """
        weight = np.ones(self.measured.size) if self.uncertainty is None else 1 / self.uncertainty
        hertz, conductance = self._omega / _TURN, self.measured[: self._omega.size]
        place = int(np.argmax(conductance * weight[: hertz.size]))
        if place in (0, hertz.size - 1) or not conductance[place] > 0:
            ends = f"{hertz[0]:.6g} to {hertz[-1]:.6g} Hz"
            raise ParameterError("frequency", ends, "a sweep that has the largest conductance, above 0, inside")
        best = (np.inf, np.zeros(3), 0.0)
        for damping in _DAMPING:
            unit = {"Theta_q": 1.0, "C_0": 0.0, "tan_delta": 0.0, "omega_n0": self._omega[place], "xi": damping}
            found = call("trum_free_admittance", {**self._values, **unit, "omega_q": self._omega})
            motion = np.asarray(found["conductance"]) + 1j * np.asarray(found["susceptance"])
            basis = np.stack([motion, 1j * self._omega, self._omega + 0j], axis=1)
            real = weight[:, np.newaxis] * np.concatenate([basis.real, basis.imag])
            weights, *_ = np.linalg.lstsq(real, weight * self.measured, rcond=None)
            left = float(np.sum((real @ weights - weight * self.measured) ** 2))
            if left < best[0] and weights[0] > 0 and weights[1] > 0:
                best = (left, weights, float(damping))
        square, capacitance, leak = (float(x) for x in best[1])
        if not best[2]:
            raise ParameterError(
                "data", "no motion beside a capacitance", "the admittance of a phase over its resonance"
            )
        factor = float(np.sqrt(square))
        v = self._values
        given = float(np.asarray(v["d_31"]))
        of_sheet = given * factor / _factor(v) if given else np.nan
        loss = leak / capacitance
        area = _capacitance({**v, "d_31": 0.0, "eps_33T": 1.0})  # capacitance per permittivity
        strain = of_sheet**2 / float(np.asarray(v["s_11E"]))
        return {
            "damping_ratio": best[2],
            "free_resonance": float(hertz[place]),
            "force_factor": factor,
            "capacitance": capacitance,
            "loss_factor": loss,
            "piezo_strain_constant": of_sheet,
            "piezo_permittivity": capacitance / area + strain,
            "piezo_loss_factor": max(loss, 1e-6),
        }

    def _before(self, name: str, motor: Motor) -> float:
        """The motor's value, NaN where its file has none."""
        v = self._values
        if name in SPECS:
            given = getattr(motor, name)
            return np.nan if given is None else float(given.value)
        found = {
            "free_resonance": lambda: float(np.asarray(v["omega_n0"])) / _TURN,
            "force_factor": lambda: _factor(v),
            "capacitance": lambda: _capacitance(v) if "eps_33T" in v else np.nan,
            "loss_factor": lambda: float(np.asarray(v.get("tan_delta", np.nan))),
        }
        return found[name]()

    def _ends(self, name: str, start: float) -> tuple[float, float]:
        """Of a search."""
        if name == "piezo_strain_constant":  # its sign is not seen: that of the motor file stays
            return (-np.inf, 0.0) if start < 0 else (0.0, np.inf)
        if name == "free_resonance":
            return 0.1 * start, 10 * start
        if name == "loss_factor":  # scatter may make it negative
            return -1.0, 1.0
        return 0.0, 1.0 - 1e-12 if name in ("damping_ratio", "piezo_loss_factor") else np.inf


def _stator(motor: Motor, drive: Drive, levels: Levels) -> dict[str, ArrayLike]:
    """Modal mass, and resonance without a rotor, by symbol."""
    chosen = replace(levels, amplitude="measured")
    pressed = solve_stator(motor, drive, chosen, warn=False)
    values = {"c_p": 1.0, **motor.symbols(), **pressed.values, **drive.symbols()}
    modes = call("trum_resonance", {**values, "k_f": 0.0, "k_dx": 0.0})
    values |= {"beta": modes["beta"], "omega_n0": modes[levels.resonance]}
    return {**values, "M_q": call("trum_modal", values)["M_q"]}


def _factor(values: dict[str, ArrayLike]) -> float:
    """Force factor by the ceramic's data."""
    return float(np.asarray(call("trum_modal", values)["F_ceramic"])) / float(np.asarray(values["U_s"]))


def _capacitance(values: dict[str, ArrayLike]) -> float:
    return float(np.asarray(call("trum_port", {"F_q": 0.0, **values})["C_0"]))
