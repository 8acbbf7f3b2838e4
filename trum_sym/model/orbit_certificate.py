"""Whether an orbit of pulses is there, and alone: Newton and Kantorovich's conditions, by slopes that are measured.

In sizes of the state, with P the laps of an orbit and s their start, let A be the inverse of the slopes of P(s) - s.
Laps close at a fixed point of T(s) = s - A (P(s) - s).  In the box of all states whose numbers differ from the orbit's
by at most r, let T's slopes sum to at most z < 1 in each row.  If T moves the orbit's state by at most Y and
Y + z r <= r, then T maps the box into itself and contracts it: exactly one orbit begins there, no further away than
Y / (1 - z).

That takes no second derivative, so that kinks do no harm.  Forces have slopes where contact begins and ends; where
friction's driving zone opens they rise as a root, which a lap passes at a rate and whose slopes it sums, so that P's
own stay continuous.  Where a lap but grazes that instant, P's slopes grow as a logarithm, whose mean along a way
through the box is finite.  What rests in a pause leaves P flat.

What is measured, and not proved, is how much slopes vary in the box (at its corners and within, the worst of them,
times ``VARYING``) and how far the laps' time steps are off (Richardson's estimate from two levels, times the orbit's
own factors of safety).  The certificate holds given both.
``python -m studies.orbit_certificate 200`` counts how often.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.model.coupled_orbit import (
    NAMED,
    ORDERS,
    SAFETY,
    SHARE,
    STATE,
    Complex,
    CoupledOrbit,
    Lap,
    LapSystem,
    figures_in_units,
)
from trum_sym.values import Value

__all__ = ["VARYING", "OrbitCertificate", "certificate_of"]

VARYING = 1.5
"""Times the most by which slopes were seen to vary in a box, what they are taken to vary by."""
_LEVELS = (3e-4, 1e-5)  # of a tolerance, that time steps may be off where the orbit begins
_INNER = 1e-9  # of a state's size, that they may be off in the inner box
_OUTER = 1e-6  # and in the outer one
_WANTED = 1e-6  # the largest tolerance that levels go by
_NEAR = 1e-4  # of a state's size, half of the inner box's edge
_MOST = 0.9  # of z
_AIM = 0.5  # z for which the outer box is chosen
_TRIED = 0.02  # of a state's size, half of the outer box's edge at first
_FAR = 1.0  # and at most
_STEP = 16.0  # times, by which it is changed at most
_WORTH = 1.5  # times, by which it is worth to be changed
_TRIES = 6  # boxes
_BATCH = 4  # states that a box is tried at, at once
_BATCHES = 4  # at most
_SETTLED = 1.1  # times the most before, that another batch may find
_ROUNDING = 1e-15  # of a product of matrices, for each number that it sums
_ROUNDED = 1e-13  # of a figure, which rounding in a lap may put it off


@dataclass(frozen=True, eq=False)
class OrbitCertificate(Value):
    """What is certain of an orbit, given how slopes vary and how far time steps are off; boxes in the state's sizes.

    Attributes
    ----------
    certified : bool
        Whether there is an orbit, and one alone, within ``alone_within`` of the state.
    reason : str
        Why it is not certified; empty if it is.
    radius : float
        Of the box about the orbit's state in which the true orbit begins, over the state's sizes; inf if not certified.
    state_error : (7,) array
        By how much each number of the state is off at most.
    alone_within : float
        Half the edge, over the state's sizes, of the box in which no other orbit of as many cycles begins.
    mean_speed_error, min_speed_error, max_speed_error, deviation_error : float, rad/s
    contact_fraction_error : float
    highest_wave_error : float, m
    input_power_error : float, W
        Of the orbit's figures: what time steps make of them, and their slopes over ``state_error``.
    multipliers : (k,) complex array
        At the finest level.
    multiplier_error : (k,) array
        Radii of discs about them that hold those of the true orbit (Gershgorin).
    stable : bool
        Whether all of the discs lie inside the unit circle.
    moved : float
        Y: by how much one step of Newton's moves the orbit's state, with what time steps may be off.
    contraction : float
        z in the box of ``alone_within``.
    laps : int
        That it took, with slopes.
    """

    certified: bool
    reason: str
    radius: float
    state_error: Array
    alone_within: float
    mean_speed_error: float
    min_speed_error: float
    max_speed_error: float
    deviation_error: float
    contact_fraction_error: float
    highest_wave_error: float
    input_power_error: float
    multipliers: Complex
    multiplier_error: Array
    stable: bool
    moved: float
    contraction: float
    laps: int


@dataclass(eq=False)
class _Centre:
    """Laps where an orbit begins, at two levels of time steps, and what follows from their slopes.

    Attributes
    ----------
    lap : Lap
        At the finer level.
    inverse : (k, k) array
        A.
    moved, known : (k,) and (k, k) arrays
        Y of each number, and by how much A times the slopes is not known to be what it should.
    slope_error : (k, k) array
        Of the laps' slopes.
    figure_error : (7,) array
        By how much time steps put the figures of these very laps off.
    """

    system: LapSystem
    cycles: int
    lap: Lap
    inverse: Array
    moved: Array
    known: Array
    slope_error: Array
    figure_error: Array
    laps: int = 2
    own: dict[float, Lap] = field(default_factory=dict)

    def beside(self, aside: Array, allowed: float) -> Lap:
        """Laps from a state that differs by some sizes in its free numbers."""
        state = self.lap.state.copy()
        state[self.system.free] += self.system.sizes[self.system.free] * aside
        self.laps += 1
        return self.system.around(state, self.cycles, allowed)

    def here(self, allowed: float) -> Lap:
        """Laps from the orbit's own state."""
        if allowed not in self.own:
            self.own[allowed] = self.beside(np.zeros(self.moved.size), allowed)
        return self.own[allowed]

    def varied(self, aside: Array, allowed: float) -> Array:
        """By how much slopes differ there, (k, k), infinite where a lap cannot be stepped."""
        gap = self.beside(aside, allowed).slopes[:-1] - self.here(allowed).slopes[:-1]
        return gap if np.isfinite(gap).all() else np.full(gap.shape, np.inf)

    def rows(self, gap: Array) -> Array:
        """Sums (k,) of the rows of A times a difference of slopes."""
        return np.abs(self.inverse @ gap).sum(axis=1) if np.isfinite(gap).all() else np.full(len(gap), np.inf)

    def z(self, varying: Array) -> Array:
        """Most that the rows of T's slopes sum to, (k,), if slopes vary by such sums."""
        return np.asarray(self.known.sum(axis=1) + VARYING * varying)

    def holds(self, half: float, varying: Array) -> bool:
        """Whether T maps a box into itself and contracts it."""
        z = self.z(varying)
        return bool(z.max() < _MOST and (self.moved + z * half <= half).all())

    def within(self, varying: Array) -> Array:
        """How far each number of the fixed point is away at most, (k,)."""
        z = self.z(varying)
        return np.asarray(self.moved + z * self.moved.max() / (1 - z.max()))


def _centre(system: LapSystem, orbit: CoupledOrbit) -> _Centre | None:
    """None where laps cannot be stepped, or their slopes cannot be inverted."""
    wanted = min(system.values["wanted"], _WANTED)
    coarse, fine = (system.around(orbit.state, orbit.cycles, share * wanted) for share in _LEVELS)
    if not (np.isfinite(coarse.slopes).all() and np.isfinite(fine.slopes).all()):
        return None
    fell = (_LEVELS[0] / _LEVELS[1]) ** ORDERS[0] - 1
    slopes, count = fine.slopes[:-1], fine.gap.size
    try:
        inverse = np.asarray(np.linalg.inv(slopes - np.eye(count)), np.float64)
    except np.linalg.LinAlgError:
        return None
    off = np.abs(fine.gap - coarse.gap)
    off = SAFETY[0] / fell * np.maximum(off, SHARE * off.max())
    slope_error = SAFETY[0] / fell * np.abs(slopes - coarse.slopes[:-1])
    size = np.abs(inverse) @ np.abs(slopes - np.eye(count))
    left = np.abs(inverse @ (slopes - np.eye(count)) - np.eye(count)) + count * _ROUNDING * size
    figure_error = SAFETY / fell * np.abs(fine.figures - coarse.figures)
    figure_error[:4] = np.maximum(figure_error[:4], SHARE * figure_error[:4].max())
    figure_error += _ROUNDED * np.abs(fine.figures)
    return _Centre(
        system=system,
        cycles=orbit.cycles,
        lap=fine,
        inverse=inverse,
        moved=np.abs(inverse @ fine.gap) + np.abs(inverse) @ off,
        known=left + np.abs(inverse) @ slope_error,
        slope_error=slope_error,
        figure_error=figure_error,
    )


@dataclass(eq=False)
class _Inner:
    """The box in which the orbit lies.

    Attributes
    ----------
    half : float
        Of its edge, over the state's sizes.
    along : (k, k, k) array
        By how much slopes differ at its middle towards each number of the state: number, row, column.
    gaps : (n, k, k) array
        By how much they differ wherever they were taken.
    varying : (k,) array
        The most that the rows of A times such differences sum to.
    figures : (7, k) array
        The most by which figures change over each number of the state, per size.
    """

    half: float
    along: Array
    gaps: Array
    varying: Array
    figures: Array


def _inner(centre: _Centre, half: float, at: np.random.Generator) -> _Inner:
    """The box, by its faces' middles and the corners at which slopes should differ most."""
    count = centre.moved.size
    here = centre.here(_INNER)
    along, figures = np.zeros((count, count, count)), np.zeros((len(NAMED), count))
    for k in range(count):
        aside = half * np.eye(count)[k] * at.choice([-1.0, 1.0])
        lap = centre.beside(aside, _INNER)
        known = np.isfinite(lap.slopes).all()
        along[k] = np.sign(aside[k]) * (lap.slopes[:-1] - here.slopes[:-1]) if known else np.inf
        figures[:, k] = np.abs(lap.figures - here.figures) / half
    if not np.isfinite(along).all():
        return _Inner(half, along, along, np.full(count, np.inf), figures)
    corner = half * _corner(centre.inverse @ along)
    gaps = np.array([*along, *(centre.varied(sign * corner, _INNER) for sign in (1, -1))])
    return _Inner(half, along, gaps, np.max([centre.rows(gap) for gap in gaps], axis=0), figures)


def _corner(along: Array) -> Array:
    """The corner (k,) of signs at which a matrix that varies linearly has the largest sum of a row."""
    best, most = np.ones(len(along)), 0.0
    for row in range(len(along)):
        columns = np.ones(along.shape[2])
        for _ in range(4):
            corner = np.where(along[:, row] @ columns < 0, -1.0, 1.0)
            columns = np.where(corner @ along[:, row] < 0, -1.0, 1.0)
        size = float(np.abs(corner @ along[:, row]).sum())
        if size > most:
            best, most = corner, size
    return best


def _outer(centre: _Centre, corner: Array, half: float, at: np.random.Generator) -> Array:
    """The most that the rows of A times slopes' differences sum to in a box, (k,): batches until they find no more."""
    ends = [centre.varied(sign * half * corner, _OUTER) for sign in (1, -1)]
    most: Array = np.max([centre.rows(gap) for gap in ends], axis=0)
    for _ in range(_BATCHES):
        if centre.z(most).max() >= _MOST:
            break
        asides = [at.choice([-1.0, 1.0], corner.size) for _ in range(_BATCH // 2)]
        asides += [at.uniform(-1, 1, corner.size) for _ in range(_BATCH // 2)]
        found = np.max([centre.rows(centre.varied(half * aside, _OUTER)) for aside in asides], axis=0)
        settled = found.max() <= _SETTLED * most.max()
        most = np.asarray(np.maximum(most, found))
        if settled:
            break
    return most


def _alone(centre: _Centre, inner: _Inner, at: np.random.Generator) -> tuple[float, Array]:
    """Half the edge of the largest box found in which T contracts, and by how much slopes vary there, (k,)."""
    corner = _corner(centre.inverse @ inner.along)
    best = inner.half, inner.varying
    known = float(centre.known.sum(axis=1).max())
    half, failed = _TRIED, np.inf
    for _ in range(_TRIES):
        varying = _outer(centre, corner, half, at)
        if centre.holds(half, varying):
            best = half, varying
        else:
            failed = half
        change = (_AIM - known) / max(float(centre.z(varying).max()) - known, 1e-300)
        half = min(half * min(_STEP, max(1 / _STEP, change)), _FAR)
        if not _WORTH * best[0] < half < failed:
            break
    return best


def _discs(centre: _Centre, inner: _Inner) -> Array:
    """Radii (k,) of discs about the multipliers that hold those of the true orbit."""
    square = centre.lap.slopes[:-1]
    values, vectors = np.linalg.eig(square)
    try:
        back = np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return np.full(len(values), np.inf)
    rounded = 2 * len(values) * _ROUNDING * (np.abs(back) @ (np.abs(square) + np.eye(len(values))) @ np.abs(vectors))
    # what the inverse of the vectors is off makes a factor
    turned = float((np.abs(back @ vectors - np.eye(len(values))) + rounded).sum(axis=1).max())
    if not turned < 1:
        return np.full(len(values), np.inf)
    left = np.abs(back @ square @ vectors - np.diag(values)) + rounded
    steps = np.abs(back) @ centre.slope_error @ np.abs(vectors)
    varying = VARYING * np.abs(back @ inner.gaps @ vectors).sum(axis=2).max(axis=0)
    return np.asarray(((left + steps).sum(axis=1) + varying) / (1 - turned))


def certificate_of(values: Mapping[str, float], orbit: CoupledOrbit, seed: int = 0) -> OrbitCertificate:
    """Whether an orbit is there and alone, how far it is off at most, and whether it attracts beyond that.

    It takes some thirty laps with their slopes, about twice what an orbit takes, and no command asks for it by itself.

    Parameters
    ----------
    values : mapping
        From :func:`trum_sym.model.coupled_orbit.lap_values`, as of the orbit.
    orbit : CoupledOrbit
        From :func:`trum_sym.model.coupled_orbit.orbit_from`.
    seed : int
        Of the states at which slopes are taken.

    Returns
    -------
    OrbitCertificate
        ``certified`` is false, and ``reason`` says why, where no orbit is found to be there.

    Examples
    --------
    >>> import trum_sym as ts
    >>> from trum_sym.model.coupled_orbit import coupled_orbits, lap_values
    >>> from trum_sym.model.levels import Levels
    >>> values = lap_values(ts.load_motor(), ts.Drive(), Levels(compliance="flange"), rotor_mass=0.02)
    >>> (orbit,) = coupled_orbits(values, ("steady",))
    >>> found = certificate_of(values, orbit)
    >>> found.certified, found.stable, found.radius < 1e-5, found.alone_within > 0.01
    (True, True, True, True)
    """
    centre = _centre(LapSystem(values), orbit)
    if centre is None:
        return _refused(orbit, None, "laps from its state cannot be stepped, or their slopes not inverted")
    at = np.random.default_rng(seed)
    moved, halves = float(centre.moved.max()), [max(_NEAR, 2 * float(centre.moved.max()))]
    if moved < _NEAR / 12:
        halves.append(_NEAR / 8)
    if not halves[0] <= _FAR:
        return _refused(orbit, centre, f"Newton would move it by {moved:.2g} of the state's size")
    for half in halves:
        inner = _inner(centre, half, at)
        if centre.holds(half, inner.varying):
            return _certified(orbit, centre, inner, at)
    return _refused(orbit, centre, _why(centre, inner))


def _certified(orbit: CoupledOrbit, centre: _Centre, inner: _Inner, at: np.random.Generator) -> OrbitCertificate:
    """What holds of an orbit in whose inner box T contracts."""
    values, free, sizes = centre.system.values, centre.system.free, centre.system.sizes
    alone, varying = _alone(centre, inner, at)
    within, discs = centre.within(inner.varying), _discs(centre, inner)
    # the orbit's own figures may be of other time steps
    own = np.abs(figures_in_units(centre.lap.figures, values) - [getattr(orbit, name) for name in NAMED])
    errors = own + figures_in_units(centre.figure_error + VARYING * inner.figures @ within, values)
    state = np.zeros(len(STATE))
    state[free] = within
    if free.size < len(STATE):
        state[4] = np.hypot(within[0], within[2])  # the height follows, and no faster than the wave grows
    return OrbitCertificate(
        certified=True,
        reason="",
        radius=float(within.max()),
        state_error=state * sizes,
        alone_within=alone,
        **{f"{name}_error": float(error) for name, error in zip(NAMED, errors, strict=True)},
        multipliers=centre.lap.multipliers,
        multiplier_error=discs,
        stable=bool((np.abs(centre.lap.multipliers) + discs).max() < 1),
        moved=float(centre.moved.max()),
        contraction=float(centre.z(varying).max()),
        laps=centre.laps,
    )


def _why(centre: _Centre, inner: _Inner) -> str:
    z, moved = float(centre.z(inner.varying).max()), float(centre.moved.max())
    if not z < _MOST:
        return f"slopes vary too much within {inner.half:.2g} of the state's size: by {z:.2g}, where 1 is too much"
    return f"Newton would move it by {moved:.2g} of the state's size, too much for the box of {inner.half:.2g}"


def _refused(orbit: CoupledOrbit, centre: _Centre | None, reason: str) -> OrbitCertificate:
    count = orbit.multipliers.size
    return OrbitCertificate(
        certified=False,
        reason=reason,
        radius=np.inf,
        state_error=np.full(len(STATE), np.inf),
        alone_within=0.0,
        **{f"{name}_error": np.inf for name in NAMED},
        multipliers=orbit.multipliers,
        multiplier_error=np.full(count, np.inf),
        stable=False,
        moved=np.inf if centre is None else float(centre.moved.max()),
        contraction=np.inf,
        laps=2 if centre is None else centre.laps,
    )
