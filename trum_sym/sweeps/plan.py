"""What a sweep will compute: checked settings, grid, chunks, and the words that go with its result."""

from __future__ import annotations

import hashlib
import math
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from trum_sym.errors import ConvergenceError, ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.choices import choice, words
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.inputs.points import check_point, one_number, period_of
from trum_sym.inputs.shown import quantity_of
from trum_sym.model.coupled_point import COUPLED_FLAGS, check_present
from trum_sym.model.cycle import lack_of_damping
from trum_sym.model.levels import METHODS, Levels, Method
from trum_sym.model.operating_point import TOLERANCES, Case
from trum_sym.model.rotor import grid_is_tried
from trum_sym.model.stator import warn_outside_fit
from trum_sym.quantities import COUPLED, COUPLED_ERRORS, ERRORS, QUANTITIES
from trum_sym.sweeps.grid import PARAMETERS, Grid, chunk_shape, read_ranges
from trum_sym.sweeps.task import FLAGS, STATUS, Settings, Task, identity, sort_out
from trum_sym.text import one_line, plain

__all__ = ["Plan", "make_plan"]

_POINT_BYTES = 2048  # at most, while a point is evaluated
_MEMORY_SHARE = 0.25  # of the machine's, for all chunks that are computed at a time
_CHUNKS = 256  # at least, where that does not make them tiny
_CHUNK_POINTS = {True: (1024, 16384), False: (8192, 65536)}  # by whether the rotor's orbit is asked for
_COUPLED_POINTS = (8, 64)  # with coupling, whose orbits take some 0.1 s each
_MAX_CHUNKS = 1_000_000
_TRIAL, _COUPLED_TRIAL = 4096, 64
_COUNTS = {
    "cycles": "drive cycles after which the orbit repeats itself",
    "largest_multiplier": "of a small disturbance after them",
    "branches": "different orbits that attract, of those that the starts lead to",
}
_FIT = ("fit_prepressure_min", "fit_prepressure_max")


@dataclass(frozen=True)
class Plan:
    """A checked sweep.

    Attributes
    ----------
    settings : Settings
    grid : Grid
    chunk : tuple of int
        Points of a chunk along each axis.
    """

    settings: Settings
    grid: Grid
    chunk: tuple[int, ...]

    @property
    def chunks(self) -> tuple[int, ...]:
        """Number of chunks along each axis."""
        return tuple(math.ceil(n / c) for n, c in zip(self.grid.shape, self.chunk, strict=True))

    @property
    def size_bytes(self) -> int:
        """Of the result, uncompressed."""
        return self.grid.size * (1 + sum(1 if name in FLAGS else 8 for name in self.settings.outputs))

    def with_chunk(self, chunk: tuple[int, ...]) -> Plan:
        """The same in other chunks."""
        return replace(self, chunk=chunk)

    def task(self, index: tuple[int, ...]) -> Task:
        """A chunk as a worker takes it."""
        where = tuple(
            slice(i * c, min(n, (i + 1) * c)) for i, c, n in zip(index, self.chunk, self.grid.shape, strict=True)
        )
        shape = tuple(part.stop - part.start for part in where)
        return Task(self.settings, index, self.grid.mesh(where), shape, dict(identity()))

    def sample(self, count: int, shift: int = 0) -> Task:
        """About ``count`` points spread over the grid as a task of their own; another shift gives others."""
        step = max(1, self.grid.size // count)
        numbers = (np.arange(min(count, self.grid.size)) * step + shift) % self.grid.size
        return Task(self.settings, (), self.grid.points(numbers), numbers.shape, dict(identity()))

    def about(self, name: str) -> dict[str, Any]:
        """Unit and meaning of a coordinate or a figure."""
        if name == "status":
            values = [*range(len(STATUS)), 255]
            return {
                "long_name": "what became of the point",
                "flag_values": values,
                "flag_meanings": " ".join((*STATUS, "not_computed")),
            }
        if name in FLAGS:
            return {"long_name": FLAGS[name]}
        if any(name in axis.values for axis in self.grid.axes):
            return {"units": PARAMETERS[name][1], "long_name": name.replace("_", " ")}
        if name in _COUNTS:
            return {"units": "1", "long_name": _COUNTS[name]}
        quantity = quantity_of(name)
        return {"units": quantity.unit, "long_name": quantity.label}

    def attributes(self) -> dict[str, str | float]:
        """Everything that decides about the result but the swept values: as text and numbers that any file holds."""
        settings, swept = self.settings, [name for axis in self.grid.axes for name in axis.values]
        motor, levels = settings.motor, settings.levels
        period = settings.sampling_period
        numbers: dict[str, Any] = {**settings.numbers, "sampling_period": "none" if period is None else period}
        found: dict[str, str | float] = {
            "title": f"{one_line(motor.name)}: {', '.join(settings.outputs)} over {', '.join(swept)}",
            **identity(),
            "motor": plain(motor.name),
            **{name: value for name, value in numbers.items() if name not in swept},
            **settings.words,
            "contact": levels.contact,
            "resonance_level": levels.resonance,
            "foundation": levels.foundation,
            "amplitude_level": levels.amplitude,
            "compliance": levels.compliance,
            "tangential": levels.tangential,
            "coupling": levels.coupling,
            "tolerance": settings.tolerance,
            "method": settings.method,
            "outputs": " ".join(settings.outputs),
        }
        for name, parameter in motor.parameters():
            if name not in swept:
                found[f"motor_{name}"] = f"{parameter.value!r} {parameter.unit} ({plain(parameter.source)})"
        found["motor_file"] = motor.text
        found["motor_file_sha256"] = hashlib.sha256(motor.text.encode()).hexdigest()
        beside = [name for axis in self.grid.axes for name in axis.values if name != axis.name]
        return {**found, **({"coordinates": " ".join(beside)} if beside else {})}


def make_plan(
    motor: Motor,
    drive: Drive | None,
    levels: Levels,
    sampling_period: ArrayLike | None,
    tolerance: float,
    outputs: Sequence[str] | None,
    chunk: float | None,
    ranges: Mapping[str, object],
    method: Method = "auto",
) -> Plan:
    """Check everything that a sweep is given, and divide it.

    Raises
    ------
    ParameterError
        For whatever :func:`trum_sym.evaluate` refuses at every point, ranges that are none, figures that are none.
    """
    fixed, grid = read_ranges(ranges)
    swept = {name for axis in grid.axes for name in axis.values}
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    numbers = {**drive.numbers(), **{name: value for name, value in fixed.items() if name in drive.numbers()}}
    set_values = {name: value for name, value in fixed.items() if name in SPECS}
    machine = replace(motor, published=()).with_values(set_values)
    period = period_of(fixed.get("sampling_period", sampling_period))
    tolerance = one_number("tolerance", tolerance, "1", TOLERANCES)
    given: dict[str, ArrayLike] = {**numbers, **{name: parameter.value for name, parameter in machine.parameters()}}
    for name, value in given.items() if period is None else [*given.items(), ("sampling_period", period)]:
        if np.ndim(value) and name not in swept:
            raise ParameterError(name, f"an array of shape {np.shape(value)}", f"one number, or {name}=... as a range")
    choice("method", method, METHODS)
    figures = _outputs(outputs, swept, levels, on_grid=grid_is_tried(method, tolerance))
    settings = Settings(machine, numbers, drive.words(), levels, period, tolerance, figures, method)
    for axis in grid.axes:
        if axis.name in (*settings.outputs, "status"):
            raise ParameterError(f"dimension {axis.name}", axis.name, "a name that is not that of a figure")
    plan = Plan(settings, grid, chunk_shape(grid.shape, _points(grid, settings, chunk)))
    if math.prod(plan.chunks) > _MAX_CHUNKS:
        raise ParameterError("chunk", chunk, f"more points in a chunk: {math.prod(plan.chunks)} chunks are too many")
    _try(plan)
    return plan


def _outputs(given: Sequence[str] | None, swept: set[str], levels: Levels, *, on_grid: bool) -> tuple[str, ...]:
    if levels.coupling == "contact":
        known = [name for name in (*COUPLED, *COUPLED_ERRORS, *_COUNTS, *COUPLED_FLAGS) if name not in swept]
    else:
        flags = [name for name in FLAGS if name not in COUPLED_FLAGS or name == "converged"]
        flags = [name for name in flags if on_grid or name != "on_grid"]
        known = [name for name in (*QUANTITIES, *ERRORS, *flags) if name not in swept]
    if given is None:
        return tuple(known)
    given = words("outputs", given, f"a list of figures: {', '.join(known)}")
    for name in given:
        check_present("outputs", name, levels)
        if name in swept:
            raise ParameterError("outputs", name, "figures that are not swept themselves")
        choice("outputs", name, tuple(known))
    if len(set(given)) < len(given):
        raise ParameterError("outputs", ", ".join(given), "each figure once")
    return given


def _points(grid: Grid, settings: Settings, chunk: float | None) -> int:
    """Points of a chunk: for the grid, what its points cost, and the memory of this machine."""
    if chunk is not None:
        return int(one_number("chunk", chunk, "1", Domain(low=1, low_open=False, integer=True)))
    low, high = _CHUNK_POINTS[settings.of_orbit]
    if settings.coupled and settings.of_orbit:
        low, high = _COUPLED_POINTS
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    room = int(_MEMORY_SHARE * memory / (_POINT_BYTES * (os.cpu_count() or 1)))
    return max(1, min(high, room, max(low, grid.size // _CHUNKS)))


def _try(plan: Plan) -> None:
    """Refuse what is wrong at every point; warn of what is measured at none."""
    settings = plan.settings
    task = plan.sample(_COUPLED_TRIAL if settings.coupled else _TRIAL)
    try:
        settings.case(task.values)
    except (ParameterError, ConvergenceError):
        good, refusal = sort_out(settings, task.values)
        if refusal is not None and not good.any():
            raise refusal from None
    swept = {name: values for axis in plan.grid.axes for name, values in axis.values.items()}
    if not settings.coupled:
        _warn_undamped(settings, task.values, swept)
    if settings.motor.amplitude is None and swept.keys().isdisjoint(("amplitude", *_FIT)):
        force = swept.get("prepressure", np.array([settings.numbers["prepressure"]]))
        warn_outside_fit(settings.motor, Drive(prepressure=np.array([force.min(), force.max()])))


def _warn_undamped(settings: Settings, values: Mapping[str, Array], swept: Mapping[str, Array]) -> None:
    """Warn if a lack of damping makes the figures of any of these points, or of one next to the resonance."""
    first = {name: value[:1] for name, value in values.items()}
    for name in ("frequency_difference", "damping_ratio"):
        if name in swept:  # the nearest of all, which the sample may leave out
            sizes = np.abs(swept[name])
            nearest = np.argmin(np.where((sizes > 0) | (name == "damping_ratio"), sizes, np.inf))
            first[name] = swept[name][[nearest]]
    for points in (values, first):
        good, _ = sort_out(settings, points)
        if good.any():
            case = settings.case({name: value[good] for name, value in points.items()})
            said = lack_of_damping(case.values) if isinstance(case, Case) else None
            if said is not None:
                warnings.warn(said, ValidityWarning, stacklevel=5)
                return
