"""Nonlinear least squares with intervals, residual statistics and a check of what the data can separate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trum_sym.errors import ConvergenceError, MissingExtraError
from trum_sym.inputs.checks import Array
from trum_sym.values import Value

__all__ = ["Fit", "Residuals", "Separation", "fit", "interval_factor"]

_DETERMINED = 1.0  # largest half-width of an interval, over the value, of which data may be said to fix the value


@dataclass(frozen=True, eq=False)
class Residuals(Value):
    """What the fit leaves of the data.

    Attributes
    ----------
    count, degrees_of_freedom : int
        Residuals, and residuals less fitted parameters.
    standard_deviation : float
        sqrt(sum r^2 / degrees of freedom), in the unit of the residuals (1 if they are relative or weighted).
    largest : float
        The residual of largest magnitude, with its sign (measured less fitted).
    largest_row : int
        Its row, counted from 1.
    lag_correlation : float
        Correlation of neighbouring residuals: about 0 +- 2/sqrt(count) if they scatter, near 1 if the model's form
        does not fit, and then the intervals are too narrow.
    """

    count: int
    degrees_of_freedom: int
    standard_deviation: float
    largest: float
    largest_row: int
    lag_correlation: float


@dataclass(frozen=True, eq=False)
class Separation(Value):
    """Which combinations of parameters the data see.

    Attributes
    ----------
    singular_values : (k,) array
        Of the Jacobian by relative changes of the parameters, its columns set to length 1; largest first.  A small
        one means that some combination of the parameters leaves the data as they are.
    condition_number : float
        Largest over smallest of these.
    direction : dict
        The combination that the data see least, as relative changes; the largest is 1 or -1.
    half_width : float
        Half the interval of that combination, relative; infinite if the data do not see it at all.
    separated : bool
        Whether the data fix every combination at least to its order of magnitude.
    message : str
        What cannot be told apart; empty if all can.
    """

    singular_values: Array
    condition_number: float
    direction: dict[str, float]
    half_width: float
    separated: bool
    message: str


@dataclass(frozen=True)
class Fit:
    """A minimum: values, their covariance, and how far to trust them."""

    values: Array
    covariance: Array
    residuals: Residuals
    separation: Separation
    iterations: int


def interval_factor(confidence: float, degrees_of_freedom: int) -> float:
    """Student's t: half the interval over the standard error."""
    try:
        from scipy.special import stdtrit
    except ImportError as error:
        raise MissingExtraError("calibrate", str(error.name), "optimize") from None
    return float(stdtrit(degrees_of_freedom, 0.5 + confidence / 2))


def fit(
    names: tuple[str, ...],
    residuals: Callable[[Array], Array],
    jacobian: Callable[[Array], Array],
    start: Array,
    bounds: tuple[Array, Array],
    *,
    size: float,
    judged: tuple[str, ...],
    confidence: float,
    resolution: float,
    on_step: Callable[[], None] = lambda: None,
) -> Fit:
    """Minimise the sum of squares.

    Parameters
    ----------
    names : tuple of str, k of them
        Of the parameters.
    residuals : callable
        (k,) values to (n,) residuals, model less measured; NaN where the model has no answer.
    jacobian : callable
        (k,) values to the (n, k) derivatives of the residuals.
    start : (k,) array
        Where the search begins; the model must have an answer there.
    bounds : two (k,) arrays
        Lowest and highest values.
    size : float
        Of the data, in the unit of the residuals: what makes them numbers near 1.
    judged : tuple of str
        The parameters for which the data must be able to tell one from the others; the rest may be open.
    confidence : float
        Of the half-width by which separation is judged.
    resolution : float
        Relative error of the Jacobian's columns: combinations seen less than ten times as much count as unseen, and the
        search ends at steps of a tenth of it.
    on_step : callable
        Called at every new Jacobian.

    Raises
    ------
    ConvergenceError
        If the search does not settle.
    MissingExtraError
        Without SciPy.
    """
    try:
        from scipy.optimize import least_squares
    except ImportError as error:
        raise MissingExtraError("calibrate", str(error.name), "optimize") from None
    scale, size = np.where(start == 0, 1.0, np.abs(start)), size or 1.0

    def stepped(values: Array) -> Array:
        on_step()
        slopes = jacobian(values * scale) * scale / size
        if not np.isfinite(slopes).all():
            raise ConvergenceError(
                "calibrate: the fit came to values at which the model has no answer in some row; start closer, with "
                "--set, or choose other levels"
            )
        return slopes

    found = least_squares(
        lambda values: residuals(values * scale) / size,
        start / scale,
        stepped,
        x_scale="jac",
        max_nfev=200,
        bounds=(bounds[0] / scale, bounds[1] / scale),
        ftol=1e-14,
        xtol=0.1 * resolution,
        gtol=1e-14,
    )
    if not found.success:
        raise ConvergenceError(f"calibrate: the fit did not settle in {found.nfev} steps; start closer, with --set")
    values = found.x * scale
    J = np.asarray(found.jac) * size / scale
    left = _residuals(-size * np.asarray(found.fun), values.size)
    relative = np.where(values == 0, scale, np.abs(values))
    separation = _separation(names, J * relative, left, judged, confidence, resolution)
    return Fit(values, _covariance(J * relative, relative, left), left, separation, int(found.nfev))


def _residuals(left: Array, parameters: int) -> Residuals:
    free = left.size - parameters
    worst = int(np.argmax(np.abs(left)))
    square = float(left @ left)
    lag = float(left[1:] @ left[:-1]) / square if square > 0 else 0.0
    return Residuals(left.size, free, float(np.sqrt(square / free)), float(left[worst]), worst + 1, lag)


def _covariance(relative_jacobian: Array, relative: Array, left: Residuals) -> Array:
    """Of the values; infinite where the data see nothing."""
    lengths = np.linalg.norm(relative_jacobian, axis=0)
    if np.any(lengths == 0):
        return np.full((relative.size, relative.size), np.inf)
    _, singular, turn = np.linalg.svd(relative_jacobian / lengths, full_matrices=False)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        root = (turn.T / singular) * left.standard_deviation
        covariance = (root @ root.T) / np.outer(lengths, lengths) * np.outer(relative, relative)
    return np.asarray(covariance)


def _separation(
    names: tuple[str, ...],
    relative_jacobian: Array,
    left: Residuals,
    judged: tuple[str, ...],
    confidence: float,
    resolution: float,
) -> Separation:
    kept = [names.index(name) for name in judged]
    rest = [k for k in range(len(names)) if k not in kept]
    J = relative_jacobian
    if rest:  # what the open ones can explain is no evidence for the judged ones
        base, _ = np.linalg.qr(J[:, rest])
        J = J - base @ (base.T @ J)
    J = J[:, kept]
    lengths = np.linalg.norm(J, axis=0)
    blind = [name for name, length in zip(judged, lengths, strict=True) if not length > 0]
    if blind:
        direction = {name: float(name == blind[0]) for name in judged}
        message = f"{blind[0]} has no effect on these data"
        return Separation(np.zeros(len(kept)), np.inf, direction, np.inf, False, message)
    _, singular, turn = np.linalg.svd(J / lengths, full_matrices=False)
    worst = turn[-1] / lengths
    worst = worst / np.max(np.abs(worst)) * np.copysign(1.0, worst[0])
    direction = dict(zip(judged, (float(x) for x in worst), strict=True))
    condition = float(singular[0] / singular[-1]) if singular[-1] > 0 else np.inf
    if condition > 0.1 / resolution:
        message = f"these data cannot separate {', '.join(judged)}: {_changes(direction, 1)} leave them as they are"
        return Separation(singular, condition, direction, np.inf, False, message)
    seen = float(np.linalg.norm(J @ worst))
    half = interval_factor(confidence, left.degrees_of_freedom) * left.standard_deviation / seen
    message = ""
    if half > _DETERMINED:
        what = f"to separate {', '.join(judged)}" if len(judged) > 1 else f"for {judged[0]}"
        message = f"the data's scatter is too large {what}: {_changes(direction, 100 * half)} lie within it"
    return Separation(singular, condition, direction, half, not message, message)


def _changes(direction: dict[str, float], percent: float) -> str:
    changes = ", ".join(f"{name} {percent * change:+.3g} %" for name, change in direction.items())
    return f"{changes} together" if len(direction) > 1 else changes
