"""Calibration: a motor's uncertain parameters from measured data, with intervals and what the data cannot separate."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Unpack

import numpy as np

from trum_sym.calibration.least_squares import fit, interval_factor
from trum_sym.calibration.models import FIT_TOLERANCE, DecayModel, Model, PointModel
from trum_sym.calibration.result import Calibration, FittedParameter
from trum_sym.calibration.sweep import SweepModel
from trum_sym.errors import ImplausibleWarning, ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array
from trum_sym.inputs.choices import choice, path_of, words
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.measurements import Measurements, from_columns, read_measurements
from trum_sym.inputs.motor import SPECS, Motor, Parameter, spec
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import doubts, outside_range, unquestioned
from trum_sym.inputs.points import check_single, one_number, period_of
from trum_sym.model.inputs import Inputs
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["ERRORS", "Calibration", "FittedParameter", "calibrate", "model_of"]

ERRORS = ("absolute", "relative")
_USUAL = {  # what is fitted if nothing else is asked for, by what was measured
    "amplitude": ("amplitude_factor", "amplitude_exponent"),
    "resonance_frequency": ("layer_stiffness",),
    "displacement": ("damping_ratio",),
    "velocity": ("damping_ratio",),
    "envelope": ("damping_ratio",),
    "conductance": ("damping_ratio",),
    "susceptance": ("damping_ratio",),
}
_USUAL_OTHERWISE = ("friction_coefficient", "contact_radius")
_LAW = ("amplitude_factor", "amplitude_exponent")


def calibrate(
    data: str | PathLike[str] | Measurements | Mapping[str, object] | pd.DataFrame,
    motor: Motor | str | PathLike[str] = "trum60",
    *,
    parameters: Sequence[str] | None = None,
    drive: Drive | None = None,
    errors: str = "absolute",
    confidence: float = 0.95,
    sampling_period: float | None = None,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> Calibration:
    """Fit parameters of the motor to measured data by least squares.

    Parameters
    ----------
    data : path, Measurements, mapping or data frame
        A CSV file with units in its headers, or columns in SI units by name: fields of the drive and at least one
        figure of :func:`trum_sym.evaluate`, or ``time`` and one of ``displacement``, ``velocity``, ``envelope``, or
        of a stator without a rotor ``frequency`` with ``conductance`` and ``susceptance`` or ``admittance`` and
        ``phase``.
        Several measured columns need a ``NAME_uncertainty`` each, which weighs them.
    motor : Motor, name or path
        Its values are where the search begins, and stay where they are not fitted.
    parameters : sequence of str, optional
        Any continuous ones of the motor.  If not given: eq. 8's factor and exponent for ``amplitude``, the layer's
        stiffness for ``resonance_frequency``, the damping ratio for a decay or an admittance sweep, else friction and
        contact radius.
    drive : Drive, optional
        What the data have no column for; Table 3 if not given.
    errors : {"absolute", "relative"}
        Whether the measured columns scatter by the same amount in every row, or by the same share of their value
        (then logarithms are compared).  An uncertainty column multiplies either.
    confidence : float
        Of the intervals.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling, sampling_period
        As for :func:`trum_sym.evaluate`.
    progress : bool
        Whether to count the steps on the standard error.

    Returns
    -------
    Calibration
        Estimates with intervals, residuals, what the data cannot tell apart, and the motor with the fitted values.

    Raises
    ------
    ParameterError
        For bad input; names the column, row or parameter.
    ConvergenceError
        If the fit does not settle, or the model has no answer where the search begins.
    MissingExtraError
        Without SciPy.

    Notes
    -----
    Fits to the paper's Table 2 and to made data: docs/calibrate.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> data = {"prepressure": [160, 180, 200, 210], "amplitude": [6.1e-6, 5.5e-6, 5.2e-6, 5.0e-6]}
    >>> found = ts.calibrate(data, parameters=["amplitude_factor"])
    >>> found.status, f"{found['amplitude_factor'].value:.2f}"
    ('solved', '14.95')
    """
    measured = _measurements(data)
    machine = motor if isinstance(motor, Motor) else load_motor(motor)
    choice("errors", errors, ERRORS)
    confidence = one_number("confidence", confidence, "1", Domain(low=0.0, high=1.0))
    names = _names(measured, parameters)
    drive = Drive() if drive is None else drive
    if not isinstance(drive, Drive) or any(np.ndim(value) for value in drive.numbers().values()):
        raise ParameterError("drive", drive, "a Drive of single numbers; what varies is a column of the data")
    if any(np.ndim(parameter.value) for _, parameter in machine.parameters()):
        raise ParameterError("motor", machine.name, "a motor of single numbers, not arrays")
    chosen = Levels(**levels)
    chosen.check_prescribed()
    period = period_of(sampling_period)
    check_single({} if period is None else {"sampling_period": period})
    with warnings.catch_warnings(), unquestioned():
        warnings.simplefilter("ignore", ValidityWarning)  # the search may leave eq. 8's range, or set it
        inputs = Inputs(machine, drive, chosen, period, FIT_TOLERANCE)
        model = _model(measured, inputs, names)
        found = _fitted(model, measured, inputs, names, errors, confidence, progress)
    _warn_beyond(found, machine)
    return found


def _model(data: Measurements, inputs: Inputs, names: tuple[str, ...]) -> Model:
    if data.is_decay:
        return DecayModel(data, inputs.motor, names, inputs.drive, inputs.levels)
    if data.is_sweep:
        return SweepModel(data, inputs.motor, names, inputs.drive, inputs.levels)
    period: float | None = inputs.sampling_period  # type: ignore[assignment]  # checked to be a single one
    return PointModel(data, inputs.motor, names, inputs.drive, inputs.levels, period)


def model_of(found: Calibration) -> Model:
    """The model that was fitted, which predicts the measured values in their order."""
    with warnings.catch_warnings(), unquestioned():
        warnings.simplefilter("ignore", ValidityWarning)
        return _model(found.measurements, found.inputs, tuple(e.name for e in found.estimates if e.in_motor))


def _warn_beyond(found: Calibration, before: Motor) -> None:
    """Warn of a fitted value that is outside its stated range, or that no such body has."""
    said = [outside_range(e.name, e.value, getattr(before, e.name)) for e in found.estimates if e.in_motor]
    known = doubts(dict(before.parameters()))
    said += [doubt for doubt in doubts(dict(found.motor.parameters())) if doubt not in known]
    for doubt in filter(None, said):
        warnings.warn(
            f"fitted {doubt}; look at the data's units and at what else could be fitted",
            ImplausibleWarning,
            stacklevel=3,
        )


def _measurements(data: object) -> Measurements:
    if isinstance(data, Measurements):
        return data
    pandas = sys.modules.get("pandas")
    if pandas is not None and isinstance(data, pandas.DataFrame):
        data = dict(data.items())
    if isinstance(data, Mapping):
        return from_columns("data", data, {}, synthetic=False)
    return read_measurements(path_of("data", data, "the path of a CSV file, or columns by name"))


def _names(data: Measurements, parameters: Sequence[str] | None) -> tuple[str, ...]:
    """The motor's parameters that are to be fitted."""
    if parameters is None:
        usual = {_USUAL.get(observed, _USUAL_OTHERWISE) for observed in data.observed}
        parameters = usual.pop() if len(usual) == 1 else _USUAL_OTHERWISE
    parameters = words("parameters", parameters, "names of the motor file in a list")
    for place, name in enumerate(parameters):
        if spec(name).domain.integer:
            raise ParameterError("parameters", name, "parameters that vary continuously")
        if name in parameters[:place]:
            raise ParameterError("parameters", name, "each name once")
    return parameters


def _fitted(
    model: Model,
    data: Measurements,
    inputs: Inputs,
    names: tuple[str, ...],
    errors: str,
    confidence: float,
    progress: bool,
) -> Calibration:
    measured, count, motor = model.measured, len(model.names), inputs.motor
    if measured.size <= count:
        raise ParameterError("data", f"{measured.size} measured values", f"more than the {count} fitted parameters")
    weights = 1.0 if model.uncertainty is None else 1.0 / model.uncertainty
    if errors == "relative":
        if np.any(measured <= 0):
            raise ParameterError("errors", "relative", "measured values all > 0, or errors absolute")
        weights = weights * (1.0 if model.uncertainty is None else measured)

    def residuals(values: Array) -> Array:
        found = model.predict(values)
        if errors == "relative":
            with np.errstate(invalid="ignore", divide="ignore"):
                return np.asarray(weights * np.log(found / measured))
        return np.asarray(weights * (found - measured))

    def jacobian(values: Array) -> Array:
        slopes = model.slopes(values)
        if errors == "relative":
            slopes = slopes / model.predict(values)[:, np.newaxis]
        return np.asarray(slopes * np.broadcast_to(weights, measured.shape)[:, np.newaxis])

    columns = np.split(_compared(measured, weights, errors), len(data.observed))
    whole = np.concatenate([column - np.mean(column) for column in columns])
    found = fit(
        model.names,
        residuals,
        jacobian,
        model.start,
        model.bounds,
        size=float(np.max(np.abs(whole))),
        judged=names,
        confidence=confidence,
        resolution=model.resolution,
        on_step=_counter() if progress else lambda: None,
    )
    width = interval_factor(confidence, found.residuals.degrees_of_freedom)
    error = np.sqrt(np.diag(found.covariance))
    if not np.isfinite(found.separation.half_width):  # what rounding makes of it is no error
        error[[model.names.index(name) for name in names]] = np.inf
    estimates = tuple(
        FittedParameter(
            name,
            model.units[k],
            float(value),
            float(value - width * error[k]),
            float(value + width * error[k]),
            float(error[k]),
            float(model.before[k]),
            name in names,
            model.exact[k],
        )
        for k, (name, value) in enumerate(zip(model.names, found.values, strict=True))
    )
    separation, ends = found.separation, _at_ends(model, found.values, names)
    message = separation.message or ends
    solved = not message
    with np.errstate(invalid="ignore"):
        correlation = np.where(np.isfinite(np.outer(error, error)), found.covariance / np.outer(error, error), np.nan)
    left = found.residuals
    if solved:
        motor = _with_estimates(motor, estimates, data)
    return Calibration(
        inputs=replace(inputs, motor=motor),
        measurements=data,
        data=data.label,
        observed=data.observed,
        errors=errors,
        confidence=confidence,
        status="solved" if solved else "unidentifiable",
        message=message,
        motor=motor,
        estimates=estimates,
        covariance=found.covariance,
        correlation=correlation,
        residuals=left,
        residual_unit=_residual_unit(data, model, errors),
        separation=separation,
        explained=1 - left.standard_deviation**2 * left.degrees_of_freedom / float(whole @ whole or np.nan),
        iterations=found.iterations,
    )


def _compared(measured: Array, weights: Array | float, errors: str) -> Array:
    return np.asarray(weights * (np.log(measured) if errors == "relative" else measured))


def _at_ends(model: Model, values: Array, names: tuple[str, ...]) -> str:
    """Says which parameter ran to the end of what it may be: then the interval means nothing."""
    for k, name in enumerate(model.names):
        low, high = model.bounds[0][k], model.bounds[1][k]
        reach = 1e-6 * (abs(model.start[k]) or 1.0)
        if name in names and (values[k] - low <= reach or high - values[k] <= reach):
            return f"the fit drives {name} to the end of its range, {values[k]:.6g}: no motor of this model fits"
    return ""


def _residual_unit(data: Measurements, model: Model, errors: str) -> str:
    if errors == "relative" or model.uncertainty is not None:
        return "1"
    if data.is_sweep:
        return "S"
    (name,) = data.observed
    return QUANTITIES[name].unit if name in QUANTITIES else model.units[-1]


def _with_estimates(motor: Motor, estimates: tuple[FittedParameter, ...], data: Measurements) -> Motor:
    """The motor with the fitted values; eq. 8 carries the range on which it was fitted."""
    changed = {}
    for e in estimates:
        if e.in_motor:
            symbol = SPECS[e.name].symbol
            changed[e.name] = Parameter(
                e.value, e.unit, symbol, "calibrated", interval=(e.low, e.high), data=data.label
            )
    if set(_LAW) & set(changed) and "prepressure" in data.inputs:
        force = data.columns["prepressure"]
        for name, value in (("fit_prepressure_min", force.min()), ("fit_prepressure_max", force.max())):
            changed[name] = Parameter(float(value), SPECS[name].unit, SPECS[name].symbol, data.label)
    return replace(motor, **changed)  # type: ignore[arg-type]


def _counter() -> Callable[[], None]:
    import click

    count = 0

    def step() -> None:
        nonlocal count
        count += 1
        click.echo(f"\rcalibrate: step {count}", err=True, nl=False)
        sys.stderr.flush()

    return step
