"""A calibration's result: for people, for programs, and as a motor file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from trum_sym.calibration.least_squares import Residuals, Separation
from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.measurements import Measurements
from trum_sym.inputs.motor import Motor
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line
from trum_sym.values import Value

__all__ = ["Calibration", "FittedParameter"]

_SHOWN_CORRELATION = 0.9


@dataclass(frozen=True, eq=False)
class FittedParameter(Value):
    """One fitted parameter, in SI.

    Attributes
    ----------
    name, unit : str
    value, low, high : float
        The best value and the ends of its interval, symmetric by construction (linearised, Student's t).
    standard_error : float
    before : float
        The motor's value, at which the search began.
    in_motor : bool
        Whether it is a parameter of the motor; the others belong to the record alone.
    exact_slopes : bool
        Whether its derivatives are exact; otherwise central differences.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    standard_error: float
    before: float
    in_motor: bool
    exact_slopes: bool


@dataclass(frozen=True, eq=False)
class Calibration(Result, Value):
    """What the data say about the motor.

    Attributes
    ----------
    inputs : Inputs
        The motor with the fitted values, and drive, levels and encoder, which give what the data have no column of.
    measurements : Measurements
        The data, in SI units.
    data, errors : str
        The data's name; how their errors are taken, ``"absolute"`` or ``"relative"``.
    observed : tuple of str
        The measured columns.
    confidence : float
        Of the intervals.
    status : str
        ``"solved"``, or ``"unidentifiable"``: the data do not fix these parameters, whatever the figures look like.
    message : str
        In words; for an unidentifiable fit, which combination stays open.
    motor : Motor
        With the fitted values in place; the motor as it came if the status is not ``"solved"``.
    estimates : tuple of FittedParameter
    covariance, correlation : (k, k) array
        Of the estimates in their order.
    residuals, separation
        See ``Residuals`` and ``Separation`` in ``trum_sym.calibration.least_squares``.
    residual_unit : str
        SI unit of the residuals.
    explained : float
        Share of the measured columns' variance that the fit explains, R^2.
    iterations : int
        Steps of the search.

    Examples
    --------
    >>> import trum_sym as ts
    >>> data = {"prepressure": [160, 180, 200, 210], "amplitude": [6.1e-6, 5.5e-6, 5.2e-6, 5.0e-6]}
    >>> found = ts.calibrate(data, parameters=["amplitude_factor"])
    >>> found["amplitude_factor"].low < found["amplitude_factor"].value < found["amplitude_factor"].high
    True
    """

    inputs: Inputs
    measurements: Measurements
    data: str
    observed: tuple[str, ...]
    errors: str
    confidence: float
    status: str
    message: str
    motor: Motor
    estimates: tuple[FittedParameter, ...]
    covariance: Array
    correlation: Array
    residuals: Residuals
    residual_unit: str
    separation: Separation
    explained: float
    iterations: int

    def __repr__(self) -> str:
        fitted = ", ".join(f"{e.name} {e.value:.6g}" for e in self.estimates)
        return f"<Calibration {self.status}: {fitted}>"

    def to_dict(self) -> dict[str, Any]:
        """All of it by name, in SI units, with the inputs as ``--point`` takes them."""
        return _as_dict(self)

    def to_text(self, before: Motor | None = None) -> str:
        """What was fitted beside what the motor had, what is left, and what the data can tell apart.

        Parameters
        ----------
        before : Motor, optional
            The motor as it came, for the sources of its values.
        """
        return _as_text(self, before or self.motor)

    def __getitem__(self, name: str) -> FittedParameter:
        """The estimate of a parameter."""
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        raise KeyError(name)

    def save(self, target: str | PathLike[str], base: str | PathLike[str] = "trum60") -> None:
        """Write a motor file: ``base`` with the fitted values in place, its other lines as they are.

        Raises
        ------
        ParameterError
            If the status is not ``"solved"``, or the file cannot be written.
        """
        from trum_sym.inputs.motor_writer import write_motor

        if self.status != "solved":
            raise ParameterError("calibration", self.status, f"a solved one; {self.message}")
        write_motor(self.motor, base, target)


def _as_dict(found: Calibration) -> dict[str, Any]:
    left, apart = found.residuals, found.separation
    record = {
        "status": found.status,
        "message": found.message,
        "data": found.data,
        "observed": list(found.observed),
        "rows": left.count // len(found.observed),
        "errors": found.errors,
        "confidence": found.confidence,
        "parameters": {e.name: _estimate(e) for e in found.estimates if e.in_motor},
        "of_the_record": {e.name: _estimate(e) for e in found.estimates if not e.in_motor},
        "order": [e.name for e in found.estimates],
        "covariance": found.covariance.tolist(),
        "correlation": found.correlation.tolist(),
        "residuals": {
            "degrees_of_freedom": left.degrees_of_freedom,
            "standard_deviation": left.standard_deviation,
            "unit": found.residual_unit,
            "largest": left.largest,
            "largest_row": left.largest_row,
            "lag_correlation": left.lag_correlation,
            "explained": float(found.explained),
        },
        "identifiability": {
            "separated": apart.separated,
            "singular_values": apart.singular_values.tolist(),
            "condition_number": float(apart.condition_number),
            "least_seen": apart.direction,
            "half_width": float(apart.half_width),
        },
        "iterations": found.iterations,
    }
    return {**found.inputs.record(), **record, "units": units_of(found.inputs.record())}


def _estimate(e: FittedParameter) -> dict[str, object]:
    known = math.isfinite(e.standard_error)
    return {
        "value": e.value if known else None,
        "unit": e.unit,
        "low": float(e.low),
        "high": float(e.high),
        "standard_error": float(e.standard_error),
        "before": float(e.before),
        "exact_slopes": e.exact_slopes,
    }


def _as_text(found: Calibration, motor: Motor) -> str:
    rows = []
    for e in found.estimates:
        parameter = getattr(motor, e.name) if e.in_motor else None
        source = one_line(parameter.source) if parameter is not None else "modelled" if e.in_motor else "of the record"
        before = f"{e.before:.6g}" if math.isfinite(e.before) else ""
        ends = f"{e.low:.6g} to {e.high:.6g}" if math.isfinite(e.standard_error) else "open"
        value = f"{e.value:.6g}" if math.isfinite(e.standard_error) else "open"
        rows.append((e.name, value, ends, "" if e.unit == "1" else e.unit, before, source))
    interval = f"{100 * found.confidence:g} % interval"
    table = text_table(rows, ("", "fitted", interval, "unit", "before", "source before"), "lrrlrl")
    left, apart = found.residuals, found.separation
    unit = "" if found.residual_unit == "1" else f" {found.residual_unit}"
    count = left.count // len(found.observed)
    lines = [
        f"{one_line(motor.name)} fitted to {one_line(found.data)}: "
        f"{count} rows of {' and '.join(found.observed)}, {found.errors} errors",
        "",
        table,
        "",
        f"residuals: standard deviation {left.standard_deviation:.3g}{unit} with {left.degrees_of_freedom} degrees of "
        f"freedom, largest {left.largest:+.3g}{unit} in {_place(found, count)}, R^2 {found.explained:.6f}, "
        f"neighbours' correlation {left.lag_correlation:+.2f}",
        "separation: "
        + (f"condition {apart.condition_number:.3g}; " if math.isfinite(apart.half_width) else "none; ")
        + "least seen "
        + ", ".join(f"{name} {100 * change:+.3g} %" for name, change in apart.direction.items())
        + (f", known to {100 * apart.half_width:.3g} %" if math.isfinite(apart.half_width) else ""),
    ]
    lines += _related(found)
    lines += _suspicious(found)
    if found.status != "solved":
        lines += ["", f"{found.status}: {found.message}"]
    return "\n".join(lines)


def _place(found: Calibration, rows: int) -> str:
    column, row = divmod(found.residuals.largest_row - 1, rows)
    return f"row {row + 1}" + (f" of {found.observed[column]}" if len(found.observed) > 1 else "")


def _related(found: Calibration) -> list[str]:
    """Pairs of the motor's parameters that must be used together."""
    notes = []
    for i, first in enumerate(found.estimates):
        for j in range(i):
            second, r = found.estimates[j], found.correlation[i, j]
            if first.in_motor and second.in_motor and np.isfinite(r) and abs(r) > _SHOWN_CORRELATION:
                notes.append(f"correlated {r:+.4f}: {second.name} and {first.name} hold together, not each for itself")
    return notes


def _suspicious(found: Calibration) -> list[str]:
    """Whether neighbouring residuals go together, which scatter does not do."""
    left = found.residuals
    if left.count >= 8 and left.lag_correlation > 2 / math.sqrt(left.count):
        return ["neighbouring residuals go together: the model's form may not fit, and the intervals are too narrow"]
    return []
