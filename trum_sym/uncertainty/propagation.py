"""Uncertain parameters through any function: quasi-random points, the outputs' spread, Sobol indices.

Points, estimators and intervals are SciPy's.  The indices are those of Saltelli et al., Computer Physics
Communications 181 (2010) 259: ``samples`` rows of a scrambled Sobol sequence make two independent matrices A and B of
the parameters, and for each parameter a matrix AB that is A with this parameter's column from B.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.inputs.checks import Array, number
from trum_sym.inputs.domain import Domain
from trum_sym.output.json_text import finite
from trum_sym.values import Value

__all__ = [
    "CONFIDENCE",
    "PROBABILITIES",
    "Estimate",
    "Indices",
    "Propagation",
    "Spread",
    "check_design",
    "propagate",
    "share",
]

CONFIDENCE = 0.95
PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the quantiles
# the fewest for which order statistics of A and B bound the 5 % quantile at 95 % confidence: 0.95^(2 n) < 0.025
_MIN_SAMPLES = 64
_MAX_SAMPLES = 2**20
_RESAMPLES = 999
_BATCH = 2**16  # numbers that the bootstrap works on at once

Function = Callable[[Mapping[str, Array]], Mapping[str, npt.ArrayLike]]
Quantile = Callable[[Array], npt.ArrayLike]


class Estimate(NamedTuple):
    """A value with the ends of its confidence interval."""

    value: float
    low: float
    high: float

    def as_dict(self) -> dict[str, float | None]:
        """By name; null where the samples do not give a number."""
        known: dict[str, float | None] = finite(self._asdict())
        return known


@dataclass(frozen=True, eq=False)
class Indices(Value):
    """Sobol indices of one output by parameter.

    Attributes
    ----------
    first : mapping of str to Estimate
        Share of the output's variance that knowing the parameter exactly would take away, on average.
    total : mapping of str to Estimate
        Share that would be left if all the others were known exactly.
    leader : str
        The parameter of the largest first-order index: the one to measure first.
    lead : float
        Share of the bootstrap's resamples in which the leader leads.
    rows : int
        Rows of the design that count: all of a row's points have a value.
    """

    first: Mapping[str, Estimate]
    total: Mapping[str, Estimate]
    leader: str
    lead: float
    rows: int


@dataclass(frozen=True, eq=False)
class Spread(Value):
    """How one output is distributed over A and B.

    Attributes
    ----------
    mean, standard_deviation : float
    quantiles : mapping of float to Estimate
        At each of ``PROBABILITIES``, with distribution-free intervals from order statistics.
    without_value : int
        Points left out of all this because the output is not finite there.
    """

    mean: float
    standard_deviation: float
    quantiles: Mapping[float, Estimate]
    without_value: int


@dataclass(frozen=True, eq=False)
class Propagation(Value):
    """What uncertain parameters do to a function.

    Attributes
    ----------
    points, values : mapping of str to (d + 2, n) array
        Every point: in the first two rows A and B, in the others AB by parameter; and what the function gave there.
    indices : mapping of str to Indices or None
        By output; None for an indicator that does not vary.
    """

    points: Mapping[str, Array]
    values: Mapping[str, Array]
    indices: Mapping[str, Indices | None]

    def spread(self, output: str) -> Spread:
        """How an output is distributed."""
        from scipy import stats

        drawn = self.values[output][:2].ravel()
        kept = drawn[np.isfinite(drawn)]
        quantiles = {}
        for level in PROBABILITIES:
            interval = stats.quantile_test(kept, p=level).confidence_interval(CONFIDENCE)
            quantiles[level] = Estimate(float(np.quantile(kept, level)), float(interval.low), float(interval.high))
        return Spread(float(kept.mean()), float(kept.std(ddof=1)), quantiles, drawn.size - kept.size)


def share(hits: npt.NDArray[np.bool_]) -> Estimate:
    """A probability from independent points, with its exact (Clopper-Pearson) interval."""
    from scipy import stats

    count, size = int(hits.sum()), hits.size
    interval = stats.binomtest(count, size).proportion_ci(CONFIDENCE, method="exact")
    return Estimate(count / size, float(interval.low), float(interval.high))


def check_design(samples: object, seed: object) -> tuple[int, int]:
    """The number of samples and the seed, checked.

    Raises
    ------
    ParameterError
        Unless samples is a power of two from 64 to 2^20 and seed a whole number that is not negative.
    MissingExtraError
        Without SciPy.
    """
    low, high = _MIN_SAMPLES, _MAX_SAMPLES
    allowed = f"a power of two from {low} to {high}: only then do the quasi-random points fill space evenly"
    try:
        count = number(
            "samples", samples, Domain(low=low, low_open=False, high=high, high_open=False, integer=True), "1"
        )
    except ParameterError:
        raise ParameterError("samples", samples, allowed) from None
    if np.ndim(count) or int(count) & (int(count) - 1):
        raise ParameterError("samples", samples, allowed)
    start = number("seed", seed, Domain(low=0, low_open=False, high=2**53, integer=True), "1")
    if np.ndim(start):
        raise ParameterError("seed", seed, "one whole number >= 0")
    try:
        import scipy  # noqa: F401
    except ImportError:
        raise MissingExtraError("a tolerance study", "scipy", "sweep") from None
    return int(count), int(start)


def propagate(
    function: Function,
    parameters: Mapping[str, Quantile],
    *,
    samples: int = 1024,
    seed: int = 0,
    outputs: tuple[str, ...] | None = None,
    indicators: tuple[str, ...] = (),
) -> Propagation:
    """Sample uncertain, independent parameters and find what they do to a function's outputs.

    Parameters
    ----------
    function : callable
        Takes the parameters by name as arrays of one shape (N,), returns outputs by name of that shape; NaN where an
        output has no value.  Called once, for all N = samples (d + 2) points.
    parameters : mapping of str to callable
        Inverse cumulative distributions, as ``ppf`` of SciPy's distributions.
    samples : int
        Rows of the design, a power of two.
    seed : int
        Of the points and of the bootstrap: the same seed gives the same bits.
    outputs : tuple of str, optional
        Those whose indices are wanted, which have to vary; all if not given.
    indicators : tuple of str
        More of them, which need not vary.

    Returns
    -------
    Propagation

    Notes
    -----
    An output without a value at any point of a row (a point of A, its partner in B and what is mixed from them)
    leaves that row out of its indices; ``Indices.rows`` says how many are left.

    Raises
    ------
    ParameterError
        For samples that are not a power of two, or an output that does not vary.
    """
    rows, start = check_design(samples, seed)
    if not parameters:
        raise ParameterError("parameters", "none", "at least one uncertain parameter")
    points = _design(parameters, rows, start)
    shape = (len(parameters) + 2, rows)
    found = function({name: value.ravel() for name, value in points.items()})
    values = {name: np.asarray(value, np.float64).reshape(shape) for name, value in found.items()}
    outputs = tuple(values) if outputs is None else outputs
    varied = {name: _centred(values[name]) for name in (*outputs, *indicators)}
    for name in outputs:
        if varied[name] is None:
            raise ParameterError("outputs", name, f"an output that {', '.join(parameters)} {_why_not(values[name])}")
    live = {name: value for name, value in varied.items() if value is not None}
    indices: dict[str, Indices | None] = dict.fromkeys(varied)
    indices.update(_indices(live, tuple(parameters), rows, start) if live else {})
    return Propagation(points, values, indices)


def _why_not(values: Array) -> str:
    finite = np.isfinite(values)
    if not finite.any():
        return f"give a value; here it has none at any of the {values.size} points"
    return (
        f"move; here it has {'the same' if finite.all() else 'a'} value at {int(finite.sum())} of {values.size} points"
    )


def _design(parameters: Mapping[str, Quantile], rows: int, seed: int) -> dict[str, Array]:
    """A, B and the mixtures, by parameter: (d + 2, n) each."""
    from scipy.stats import qmc

    count = len(parameters)
    engine = qmc.Sobol(2 * count, bits=64, rng=np.random.default_rng([seed, 0]))
    levels = engine.random(rows).T.reshape(2, count, rows)
    points = {}
    for place, (name, quantile) in enumerate(parameters.items()):
        a, b = (np.asarray(quantile(level), np.float64) for level in levels[:, place])
        points[name] = np.stack([a, b, *(b if other == place else a for other in range(count))])
    return points


def _centred(values: Array) -> tuple[Array, int] | None:
    """An output less its mean, zero in rows that lack a value, and the number of the others; None if it is constant.

    With such rows at zero SciPy's sums are those over the rows that are left: numerators and variance shrink alike.
    """
    whole = np.isfinite(values).all(axis=0)
    left = values[:, whole]
    # what rounding alone can do is no variation
    if left.shape[1] < 2 or np.ptp(left[:2]) <= 64 * np.finfo(float).eps * np.abs(left[:2]).max():
        return None
    return np.where(whole, values - left[:2].mean(), 0.0), int(whole.sum())


def _indices(
    outputs: Mapping[str, tuple[Array, int]], names: tuple[str, ...], rows: int, seed: int
) -> dict[str, Indices]:
    """First and total order of all outputs at once, with the bootstrap's intervals (rows resampled, percentiles)."""
    from scipy import stats

    table = np.stack([values for values, _ in outputs.values()], axis=1)  # (d + 2, s, n)

    def estimate(chosen: npt.NDArray[np.int64], axis: int = -1) -> Array:  # noqa: ARG001
        """Of chosen rows (..., n): (2, s, d, ...).  SciPy takes each choice of rows for another output."""
        drawn = table[..., np.atleast_2d(chosen)]
        count = drawn.shape[2]
        drawn = drawn.reshape(len(drawn), -1, rows)
        if drawn.shape[1] == 1:
            drawn = drawn.repeat(2, axis=1)  # it cannot return a single number
        found = stats.sobol_indices(func={"f_A": drawn[0], "f_B": drawn[1], "f_AB": drawn[2:]}, n=rows)
        both = np.stack([found.first_order, found.total_order]).reshape(2, drawn.shape[1], len(names))
        shaped = both[:, : len(outputs) * count].reshape(2, len(outputs), count, len(names)).swapaxes(2, 3)
        return np.asarray(shaped if np.ndim(chosen) > 1 else shaped[..., 0])

    every = np.arange(rows)
    best = estimate(every)
    resampled = stats.bootstrap(
        (every,),
        estimate,
        n_resamples=_RESAMPLES,
        batch=max(1, _BATCH // table.size),
        vectorized=True,
        method="percentile",
        confidence_level=CONFIDENCE,
        rng=np.random.default_rng([seed, 1]),
    )
    low, high = resampled.confidence_interval
    drawn = resampled.bootstrap_distribution
    result = {}
    for s, (output, (_, left)) in enumerate(outputs.items()):
        first, total = (
            {name: Estimate(*(float(x[order, s, d]) for x in (best, low, high))) for d, name in enumerate(names)}
            for order in (0, 1)
        )
        leader = int(best[0, s].argmax())
        lead = float(np.mean(drawn[0, s].argmax(axis=0) == leader))
        result[output] = Indices(first, total, names[leader], lead, left)
    return result
