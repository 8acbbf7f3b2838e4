"""How a speed table is made: a path over the map, Newton onto every speed, and points where interpolation fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.optimiser.chart import Chart
from trum_sym.optimiser.expressions import Constraint
from trum_sym.optimiser.model import Model, functions
from trum_sym.studies.path import Candidates, candidates, choose

__all__ = ["TOLERANCE", "Builder", "TableEntry"]

TOLERANCE = 1e-9  # of the orbits
_MET = 1e-6  # of a speed, or the orbits' tolerance where that is more
_NEWTON = 12
_MOST = 4000  # entries
_LEAST_STEP = 1e-4  # of the speed: neighbours closer than this whose drives differ too much are a jump
_BETWEEN = np.array([0.25, 0.5, 0.75])  # where interpolation is tried
_EDGE = 12  # bisections towards the end of what can be reached
_INSIDE = 0.01  # of a constraint's span, by which the path on the map keeps away from its bound


@dataclass
class TableEntry:
    """A speed, its place in the unit cube, and the speed's slope, standard deviation and the drive frequency there."""

    speed: float
    share: Array
    slope: Array
    deviation: float
    drive_frequency: float


@dataclass
class Builder:
    """A table under way.

    Attributes
    ----------
    speeds : (n,) array, rad/s
        Asked for, rising.
    floor : float, rad/s
        Of which errors are taken where speeds are smaller.
    error : float
        Allowed.
    """

    model: Model
    known: Chart
    constraints: Sequence[Constraint]
    speeds: Array
    floor: float
    error: float
    say: Callable[[str], None]
    largest_error: float = 0.0
    gaps: list[tuple[float, float, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        """The map's part of constraints and accuracy."""
        figures = self.known.figures
        with np.errstate(invalid="ignore"):
            fastest = float(np.nanmax(np.abs([figures["min_speed"], figures["max_speed"]])))
        self.accuracy = TOLERANCE * fastest
        if self.error * self.floor < 2 * self.accuracy:
            raise ParameterError(
                "error",
                self.error,
                f"at least {2 * self.accuracy / self.floor:.2g}: the rotor swings up to {fastest:.3g} rad/s, and its "
                f"mean is known to {self.accuracy:.2g} rad/s",
            )
        self._rows = functions([c.expression for c in self.constraints]) if self.constraints else None
        self._excess = np.full(figures["mean_speed"].size, -1.0)
        if self._rows is not None:
            values = self._rows.values(figures)
            for k, constraint in enumerate(self.constraints):
                span = float(np.nanmax(values[:, k]) - np.nanmin(values[:, k]))
                beyond = np.maximum(constraint.low - values[:, k], values[:, k] - constraint.high) + _INSIDE * span
                self._excess = beyond if k == 0 else np.maximum(self._excess, beyond)
            self._excess = np.where(np.isfinite(self._excess), self._excess, 1e300)

    def build(self) -> list[list[TableEntry]]:
        """Entries by segment, speeds rising; fills ``gaps`` and ``largest_error``."""
        levels = [self._level(speed) for speed in self.speeds]
        chosen = choose(levels)
        here = [k for k, place in enumerate(chosen) if place >= 0]
        self.say(f"{len(here)} of {len(self.speeds)} speeds are on the map")
        begun = np.array([levels[k].share[chosen[k]] for k in here]).reshape(len(here), len(self.known.shape))
        entries = dict(zip(here, self._onto(self.speeds[here], begun), strict=True))
        runs: list[list[TableEntry]] = []
        for k in range(len(self.speeds)):
            entry = entries.get(k)
            if entry is None:
                runs.append([])
            elif not runs:
                runs.append([entry])
            else:
                runs[-1].append(entry)
        segments = self._grown([segment for run in runs if run for segment in self._refined(run)])
        self._name_gaps(segments)
        return segments

    def _level(self, speed: float) -> Candidates:
        figures = self.known.figures
        return candidates(self.known, figures["mean_speed"], speed, figures["speed_deviation"], self._excess)

    def _onto(self, speeds: Array, share: Array) -> list[TableEntry | None]:
        """Newton along the speed's slope inside the box, all speeds side by side; None where it does not arrive."""
        share, wanted = share.copy(), np.asarray(speeds)
        found: list[TableEntry | None] = [None] * wanted.size
        best = np.full(wanted.size, np.inf)
        active = np.arange(wanted.size)
        for _ in range(_NEWTON):
            if active.size == 0:
                break
            points = self.model.box.at(share[active])
            figures, slopes = self.model.results_with_slopes(points, TOLERANCE)
            off = figures["mean_speed"] - wanted[active]
            allowed = np.maximum(_MET * np.abs(wanted[active]), self.accuracy)
            met = np.abs(off) <= allowed
            slope = slopes["mean_speed"] * self.model.box.width
            for place in np.flatnonzero(met):
                k = int(active[place])
                if self._allowed({name: value[place : place + 1] for name, value in figures.items()}):
                    more = (float(figures[name][place]) for name in ("speed_deviation", "drive_frequency"))
                    found[k] = TableEntry(float(wanted[k]), share[k].copy(), slope[place], *more)
            go = ~met & np.isfinite(off) & np.all(np.isfinite(slope), axis=1)
            # a step that does not help is halved by trying again from between
            worse = np.abs(off) > best[active]
            best[active] = np.minimum(best[active], np.abs(off))
            share[active[go]] = _steps(share[active[go]], slope[go], off[go], np.where(worse[go], 0.5, 1.0))
            active = active[go]
        return found

    def _allowed(self, figures: dict[str, Array]) -> bool:
        if self._rows is None:
            return True
        values = self._rows.values(figures)[0]
        return all(
            c.low - 1e-8 * abs(c.low) <= value <= c.high + 1e-8 * abs(c.high)
            for c, value in zip(self.constraints, values, strict=True)
        )

    def _grown(self, segments: list[list[TableEntry]]) -> list[list[TableEntry]]:
        """Segments with both ends moved into the gaps as far as it goes."""
        grown: list[list[TableEntry]] = []
        for k, segment in enumerate(segments):
            low = grown[-1][-1].speed if grown else float(self.speeds[0])
            high = segments[k + 1][0].speed if k + 1 < len(segments) else float(self.speeds[-1])
            down, up = self._towards(segment[0], low), self._towards(segment[-1], high)
            # one entry alone is between two jumps, and nothing to interpolate on
            grown += [part for part in self._refined([*down[::-1], *segment, *up]) if len(part) > 1]
        return grown

    def _towards(self, end: TableEntry, limit: float) -> list[TableEntry]:
        """Entries from the end of a segment towards a speed, by bisection for the last that can be had."""
        found: list[TableEntry] = []
        last, far = end, limit
        for _ in range(_EDGE):
            middle = 0.5 * (last.speed + far)
            if abs(middle - last.speed) <= _MET * max(abs(middle), self.floor):
                break
            (entry,) = self._onto(np.array([middle]), last.share[np.newaxis])
            on_the_way = entry is not None and (entry.slope @ (entry.share - last.share)) * (middle - last.speed) > 0
            if entry is not None and on_the_way:
                found.append(entry)
                last = entry
            else:
                far = middle
        return found

    def _refined(self, run: list[TableEntry]) -> list[list[TableEntry]]:
        """A run with entries added until interpolation holds, cut where it cannot."""
        if len(run) < 2:
            return [run]
        open_pairs = list(range(len(run) - 1))
        cut: set[int] = set()  # by identity of the entry before it
        while open_pairs:
            self.say(f"{len(run)} entries, {len(open_pairs)} stretches to check")
            wrong = self._wrong(run, open_pairs)
            news = self._between([(run[k], run[k + 1]) for k in wrong])
            added: dict[int, TableEntry] = {}
            for k, entry in zip(wrong, news, strict=True):
                a, b = run[k], run[k + 1]
                step = (b.speed - a.speed) / max(abs(a.speed), abs(b.speed), self.floor)
                if entry is None or step < _LEAST_STEP or len(run) + len(added) >= _MOST:
                    cut.add(id(a))
                else:
                    added[k] = entry
            grown: list[TableEntry] = []
            open_pairs = []
            for k, entry in enumerate(run):
                grown.append(entry)
                if k in added:
                    open_pairs += [len(grown) - 1, len(grown)]
                    grown.append(added[k])
            run = grown
        segments: list[list[TableEntry]] = [[]]
        for entry in run:
            segments[-1].append(entry)
            if id(entry) in cut:
                segments.append([])
        return [segment for segment in segments if segment]

    def _wrong(self, run: list[TableEntry], pairs: list[int]) -> list[int]:
        """Those pairs between which the motor does not do what interpolation says."""
        low = np.array([run[k].share for k in pairs])[:, np.newaxis]
        high = np.array([run[k + 1].share for k in pairs])[:, np.newaxis]
        share = low + _BETWEEN[:, np.newaxis] * (high - low)
        v_low = np.array([run[k].speed for k in pairs])[:, np.newaxis]
        v_high = np.array([run[k + 1].speed for k in pairs])[:, np.newaxis]
        wanted = v_low + _BETWEEN * (v_high - v_low)
        points = self.model.box.at(share.reshape(-1, share.shape[-1]))
        found = self.model.results(points, TOLERANCE)["mean_speed"].reshape(wanted.shape)
        off = np.abs(found - wanted) / np.maximum(np.abs(wanted), self.floor)
        worst = np.max(np.where(np.isfinite(off), off, np.inf), axis=1)
        good = worst <= self.error
        self.largest_error = max(self.largest_error, float(np.max(worst[good], initial=0.0)))
        return [k for k, fine in zip(pairs, good, strict=True) if not fine]

    def _between(self, pairs: list[tuple[TableEntry, TableEntry]]) -> list[TableEntry | None]:
        """An entry halfway between each two: from the middle of their places, from either, or from the map.

        On the way from one to the other the speed rises; a place where it falls along that way is none of it.
        """
        if not pairs:
            return []
        speeds = np.array([0.5 * (a.speed + b.speed) for a, b in pairs])
        middles = np.array([0.5 * (a.share + b.share) for a, b in pairs])
        found: list[TableEntry | None] = [None] * len(pairs)
        for starts in (
            middles,
            [a.share for a, _ in pairs],
            [b.share for _, b in pairs],
            self._nearest(speeds, middles),
        ):
            left = [k for k, entry in enumerate(found) if entry is None]
            if not left:
                break
            tried = self._onto(speeds[left], np.array([starts[k] for k in left]))
            for k, entry in zip(left, tried, strict=True):
                a, b = pairs[k]
                if entry is not None and entry.slope @ (b.share - a.share) > 0:
                    found[k] = entry
        return found

    def _nearest(self, speeds: Array, middles: Array) -> list[Array]:
        """The place of the map that has each speed and is nearest to a place; that place if none has."""
        places = []
        for speed, middle in zip(speeds, middles, strict=True):
            level = self._level(float(speed))
            away = np.linalg.norm(level.share - middle, axis=1)
            places.append(level.share[np.argmin(away)] if away.size else middle)
        return places

    def _name_gaps(self, segments: list[list[TableEntry]]) -> None:
        """Every speed between the first and the last asked for that no segment has."""
        figures = self.known.figures["mean_speed"]
        least, most = float(np.nanmin(figures)), float(np.nanmax(figures))
        at = float(self.speeds[0])
        ends = [(segment[0].speed, segment[-1].speed) for segment in segments]
        for low, high in [*ends, (float(self.speeds[-1]), float(self.speeds[-1]))]:
            if low > at:
                outside = high <= least or at >= most or low > most or at < least
                self.gaps.append((at, low, self._reason(at, low, outside)))
            at = max(at, high)

    def _reason(self, low: float, high: float, outside: bool) -> str:
        if outside:
            return "beyond the mean speeds of the box"
        if high - low <= 2 * _LEAST_STEP * max(abs(low), abs(high), self.floor):
            return "a jump: the drives on both sides are not connected"
        if self.constraints:
            return "no way on which the constraints hold"
        return "no continuous way"


def _steps(share: Array, slope: Array, off: Array, damping: Array) -> Array:
    """Newton's least steps to the wanted speeds that stay in the unit cube."""
    outward = ((share <= 0) & (slope * off[:, np.newaxis] > 0)) | ((share >= 1) & (slope * off[:, np.newaxis] < 0))
    free = np.where(outward, 0.0, slope)
    size = np.sum(free**2, axis=1)
    with np.errstate(all="ignore"):
        step = np.where(size[:, np.newaxis] > 0, -(damping * off / size)[:, np.newaxis] * free, 0.0)
    return np.asarray(np.clip(share + np.clip(step, -0.2, 0.2), 0.0, 1.0))
