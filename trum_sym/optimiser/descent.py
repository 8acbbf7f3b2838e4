"""IPOPT from several starts side by side: one batch answers what all of them ask for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.optimiser.extra import casadi
from trum_sym.optimiser.lockstep import StoppedError, in_lockstep
from trum_sym.optimiser.model import Functions, Model

__all__ = ["Task", "Visit", "descend"]

_INFINITE = 1e19  # IPOPT's
_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.hessian_approximation": "limited-memory",
    "ipopt.nlp_scaling_method": "none",
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.honor_original_bounds": "yes",
    # optima lie on edges of the box more often than not, and starts beside them: the barrier is to let them stay
    "ipopt.bound_push": 1e-6,
    "ipopt.bound_frac": 1e-6,
    "ipopt.mu_strategy": "monotone",
    "ipopt.mu_init": 1e-7,
    "ipopt.tol": 1e-5,
    "ipopt.acceptable_tol": 1e-4,
    "ipopt.acceptable_iter": 2,
    "ipopt.accept_after_max_steps": 3,
    "ipopt.max_iter": 40,
}
_MOST_PLACES = 60  # of one start: where orbits are too rough for IPOPT, its line search would go on


@dataclass(frozen=True)
class Task:
    """A problem in the unit cube from a start.

    ``functions`` are objective and constraints; both are divided by ``scale``, one entry each, before IPOPT sees them.
    """

    functions: Functions
    low: Array
    high: Array
    scale: Array
    start: Array


@dataclass
class Visit:
    """A place in the unit cube, objective and constraints there, and their slopes, (1 + constraints, d)."""

    share: Array
    values: Array = field(default_factory=lambda: np.empty(0))
    slopes: Array = field(default_factory=lambda: np.empty(0))


class _Values(casadi.Callback):
    """Objective or constraints to CasADi, with their exact slopes."""

    def __init__(self, name: str, rows: slice, count: int, d: int, look: Callable[[Array], Visit]) -> None:
        casadi.Callback.__init__(self)
        self._rows, self._count, self._d, self._look = rows, count, d, look
        self._slopes: _Slopes | None = None
        self.construct(name, {})

    def get_n_in(self) -> int:
        return 1

    def get_n_out(self) -> int:
        return 1

    def get_sparsity_in(self, _: int) -> casadi.Sparsity:
        return casadi.Sparsity.dense(self._d, 1)

    def get_sparsity_out(self, _: int) -> casadi.Sparsity:
        return casadi.Sparsity.dense(self._count, 1)

    def eval(self, arguments: Sequence[casadi.DM]) -> list[casadi.DM]:
        visit = self._look(np.asarray(arguments[0]).ravel())
        return [casadi.DM(visit.values[self._rows])]

    def has_jacobian(self) -> bool:
        return True

    def get_jacobian(self, name: str, *_: object) -> casadi.Function:
        self._slopes = _Slopes(name, self._rows, self._count, self._d, self._look)
        return self._slopes


class _Slopes(casadi.Callback):
    def __init__(self, name: str, rows: slice, count: int, d: int, look: Callable[[Array], Visit]) -> None:
        casadi.Callback.__init__(self)
        self._rows, self._count, self._d, self._look = rows, count, d, look
        self.construct(name, {})

    def get_n_in(self) -> int:
        return 2

    def get_n_out(self) -> int:
        return 1

    def get_sparsity_in(self, i: int) -> casadi.Sparsity:
        return casadi.Sparsity.dense(self._d if i == 0 else self._count, 1)

    def get_sparsity_out(self, _: int) -> casadi.Sparsity:
        return casadi.Sparsity.dense(self._count, self._d)

    def eval(self, arguments: Sequence[casadi.DM]) -> list[casadi.DM]:
        visit = self._look(np.asarray(arguments[0]).ravel())
        return [casadi.DM(visit.slopes[self._rows])]


def descend(model: Model, tasks: Sequence[Task], tolerance: float) -> list[Visit]:
    """The best place that IPOPT saw from each start.

    Best is by violation of the constraints down to a millionth of their scale, then by the objective: whatever IPOPT
    says of its success is not asked.

    Parameters
    ----------
    model : Model
        Gives the figures.
    tasks : sequence of Task
        One for each start.
    tolerance : float
        Of the orbits.

    Returns
    -------
    list of Visit
        In the order of the tasks; of NaN where a start and all that came after it have no orbit.
    """
    box = model.box

    def answer(asked: list[tuple[int, Visit]]) -> list[Visit]:
        points = box.at(np.array([visit.share for _, visit in asked]))
        figures, slopes = model.results_with_slopes(points, tolerance)
        for row, (number, visit) in enumerate(asked):
            task = tasks[number]
            own = {name: figures[name][row : row + 1] for name in task.functions.names}
            by = {name: slopes[name][row : row + 1] * box.width for name in task.functions.names}
            visit.values = task.functions.values(own)[0] / task.scale
            visit.slopes = task.functions.slopes(own, by)[0] / task.scale[:, np.newaxis]
        return [visit for _, visit in asked]

    return in_lockstep(_ipopt, tasks, answer)


def _ipopt(task: Task, ask: Callable[[Visit], Visit]) -> Visit:
    d, seen = task.start.size, dict[bytes, Visit]()
    nothing = Visit(task.start, np.full(task.scale.size, np.nan), np.full((task.scale.size, d), np.nan))

    def look(share: Array) -> Visit:
        key = (share + 0.0).tobytes()  # where -0 is 0
        if key not in seen:
            if len(seen) == _MOST_PLACES:
                return nothing
            visit = seen[key] = Visit(share.copy())
            with suppress(StoppedError):  # IPOPT's callbacks may not raise; where there is no number, it soon ends
                ask(visit)
            if visit.slopes.size == 0:
                visit.values, visit.slopes = nothing.values, nothing.slopes
        return seen[key]

    x = casadi.MX.sym("x", d)
    count = task.scale.size - 1
    objective = _Values("objective", slice(0, 1), 1, d, look)
    problem: dict[str, Any] = {"x": x, "f": objective(x)}
    bounds: dict[str, Any] = {"lbx": np.zeros(d), "ubx": np.ones(d), "x0": task.start}
    low, high = task.low / task.scale[1:], task.high / task.scale[1:]
    if count:
        constraints = _Values("constraints", slice(1, None), count, d, look)
        problem["g"] = constraints(x)
        bounds["lbg"], bounds["ubg"] = np.maximum(low, -_INFINITE), np.minimum(high, _INFINITE)
    solver = casadi.nlpsol("solver", "ipopt", problem, _OPTIONS)
    solver(**bounds)

    def rank(visit: Visit) -> tuple[float, float]:
        g = visit.values[1:]
        violation = float(np.max(np.maximum(low - g, g - high), initial=0.0))
        return max(violation, 1e-6), float(visit.values[0])

    places = list(seen.values())
    usable = [visit for visit in places if np.all(np.isfinite(visit.values))]
    found = min(usable, key=rank) if usable else places[0]
    return Visit(found.share, found.values * task.scale, found.slopes * task.scale[:, np.newaxis])
