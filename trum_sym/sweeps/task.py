"""One chunk of a sweep: what a worker is given, computes and hands back, in whatever process it runs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

import trum_sym
from trum_sym import _kernels
from trum_sym.errors import ConvergenceError, ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.batch import StoppedError, one_thread
from trum_sym.model.coupled_point import COUPLED_FLAGS, FREE_OF_ORBIT, CoupledCase, coupled_results, prepare_coupled
from trum_sym.model.levels import Levels, Method
from trum_sym.model.operating_point import OF_ORBIT, Case, prepare, results

__all__ = ["FLAGS", "STATUS", "STORE", "Found", "Settings", "Task", "compute", "identity", "sort_out"]

STATUS = ("done", "no_steady_speed", "not_converged", "refused", "slack_string")
"""What ``status`` 0 to 4 mean: refused is a combination that :func:`trum_sym.evaluate` refuses."""
FLAGS = MappingProxyType(
    {
        "converged": "whether the bounds of the errors meet the tolerance",
        "on_grid": "whether the orbit was found on a grid of equal steps",
        **{name: meaning for name, meaning in COUPLED_FLAGS.items() if name != "converged"},
    }
)
"""The outputs that are true or false, and what they say; the last two with coupling alone."""
STORE = "1"
"""The layout of a sweep's store: which arrays and attributes it has, and what they mean."""
_DONE, _RUNAWAY, _UNCONVERGED, _REFUSED, _SLACK = range(5)


@cache
def identity() -> Mapping[str, str]:
    """What decides about every bit of a figure: the package's version and code, kernels, their instruction set; and how
    it is stored.

    The code is that of the packages which compute figures.  A file's place does not count, only what it says.
    """
    home = Path(trum_sym.__file__).parent
    files = [file for package in ("inputs", "model", "sweeps") for file in (home / package).glob("*.py")]
    code = hashlib.sha256()
    for digest in sorted(hashlib.sha256(file.read_bytes()).digest() for file in files):
        code.update(digest)
    return MappingProxyType(
        {
            "format": STORE,
            "package": f"trum-sym {version('trum-sym')}",
            "code_sha256": code.hexdigest(),
            "kernels_sha256": hashlib.sha256(Path(_kernels.__file__).read_bytes()).hexdigest(),
            "instruction_set": list(_kernels.instruction_sets())[-1],
        }
    )


@dataclass(frozen=True)
class Settings:
    """What all points of a sweep share."""

    motor: Motor
    numbers: Mapping[str, ArrayLike]  # of the drive, where they are not swept
    words: Mapping[str, str]  # of the drive: start, kind of load
    levels: Levels
    sampling_period: ArrayLike | None
    tolerance: float
    outputs: tuple[str, ...]
    method: Method = "auto"

    @property
    def coupled(self) -> bool:
        """Whether the rotor acts back on the wave."""
        return self.levels.coupling == "contact"

    @property
    def of_orbit(self) -> bool:
        """Whether any output takes the rotor's orbit."""
        plain = {"prepressure", "frequency_difference", *FREE_OF_ORBIT}
        return not plain.issuperset(self.outputs) if self.coupled else not OF_ORBIT.isdisjoint(self.outputs)

    def case(self, values: Mapping[str, Array]) -> Case | CoupledCase:
        """Check points and solve their stators; the values broadcast.

        Raises
        ------
        ParameterError, ConvergenceError
            If one of the points cannot be evaluated.
        """
        of_motor = {name: value for name, value in values.items() if name in SPECS}
        of_drive = {name: values.get(name, value) for name, value in self.numbers.items()}
        with unquestioned():
            motor = self.motor.with_values(of_motor) if of_motor else self.motor
        drive = Drive(**of_drive, **self.words)  # type: ignore[arg-type]
        period = values.get("sampling_period", self.sampling_period)
        if self.coupled:
            return prepare_coupled(motor, drive, self.levels, self.tolerance, period, method=self.method)
        return prepare(motor, drive, self.levels, self.tolerance, period, warn=False, method=self.method)


@dataclass(frozen=True)
class Task:
    """A chunk: which one, and the swept values in it, which broadcast to ``shape``."""

    settings: Settings
    index: tuple[int, ...]
    values: Mapping[str, Array]
    shape: tuple[int, ...]
    identity: Mapping[str, str]


@dataclass(frozen=True)
class Found:
    """A chunk's figures and ``status`` by name, and why the first of its refused points was refused."""

    figures: Mapping[str, npt.NDArray[Any]]
    refusal: str | None


def compute(task: Task, stopped: Callable[[], bool] = lambda: False) -> Found:
    """Evaluate a chunk on the calling thread.

    Parameters
    ----------
    task : Task
        The chunk.
    stopped : callable
        Asked every few hundred points; where it says yes, the chunk is given up.

    Raises
    ------
    ParameterError
        If the kernels here are not those of the process that asks.
    trum_sym.model.batch.StoppedError
        If ``stopped`` says so.
    """
    for name, wanted in task.identity.items():
        if identity()[name] != wanted:
            raise ParameterError("worker", f"{name} {identity()[name]}", f"{wanted}, as where the sweep was started")
    settings = task.settings
    with one_thread(stopped):
        try:
            return Found(_evaluate(settings, settings.case(task.values), task.shape), None)
        except (ParameterError, ConvergenceError):
            flat = {name: np.broadcast_to(value, task.shape).ravel() for name, value in task.values.items()}
        good, refusal = sort_out(settings, flat, stopped)
        found = _blank(settings.outputs, good.shape)
        if good.any():
            kept = {name: value[good] for name, value in flat.items()}
            for name, values in _evaluate(settings, settings.case(kept), (int(good.sum()),)).items():
                found[name][good] = values
        return Found({name: values.reshape(task.shape) for name, values in found.items()}, str(refusal))


def _evaluate(settings: Settings, case: Case | CoupledCase, shape: tuple[int, ...]) -> dict[str, npt.NDArray[Any]]:
    """The outputs and the status of points that can be evaluated."""
    status = np.full(shape, _DONE, np.uint8)
    flags = ("converged", "runaway") if settings.of_orbit else ()
    if isinstance(case, CoupledCase):
        found = coupled_results(case, {*settings.outputs, *flags})
    else:
        found = results(case, {*settings.outputs, *flags, *(["slack"] if flags else [])})
    if flags:
        if "slack" in found:
            status[np.broadcast_to(found["slack"], shape)] = _SLACK
        status[~np.broadcast_to(found["converged"], shape)] = _UNCONVERGED
        status[np.broadcast_to(found["runaway"], shape)] = _RUNAWAY
    return {**{name: np.broadcast_to(found[name], shape) for name in settings.outputs}, "status": status}


def _blank(outputs: tuple[str, ...], shape: tuple[int, ...]) -> dict[str, npt.NDArray[Any]]:
    figures: dict[str, npt.NDArray[Any]] = {
        name: np.zeros(shape, np.bool_) if name in FLAGS else np.full(shape, np.nan) for name in outputs
    }
    return {**figures, "status": np.full(shape, _REFUSED, np.uint8)}


def sort_out(
    settings: Settings, flat: Mapping[str, Array], stopped: Callable[[], bool] = lambda: False
) -> tuple[npt.NDArray[np.bool_], Exception | None]:
    """Which points of a row can be evaluated, and what is said of the first that cannot be."""
    size = next(iter(flat.values())).size
    periods, on_periods = (
        np.broadcast_to(flat.get(name, settings.numbers[name]), (size,)) for name in ("periods", "on_periods")
    )
    good = (2 * on_periods >= periods) & (on_periods <= periods)  # grids of pulse counts have many such
    reasons: dict[int, Exception] = {}

    def examine(places: npt.NDArray[np.intp]) -> None:
        if stopped():
            raise StoppedError
        if not places.size:
            return
        try:
            settings.case({name: value[places] for name, value in flat.items()})
        except (ParameterError, ConvergenceError) as error:
            if places.size == 1:
                good[places] = False
                reasons[int(places[0])] = error
            else:
                examine(places[: places.size // 2])
                examine(places[places.size // 2 :])

    examine(np.flatnonzero(~good)[:1])
    examine(np.flatnonzero(good))
    return good, reasons[min(reasons)] if reasons else None
