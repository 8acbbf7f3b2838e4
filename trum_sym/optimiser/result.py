"""What the optimiser answers, for people and for programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from trum_sym.inputs.shown import full, quantity_of, readable
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.holding import Holding
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.output.digits import with_error
from trum_sym.output.json_text import finite
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line
from trum_sym.values import Value

if TYPE_CHECKING:
    from trum_sym.optimiser.solve import Problem

__all__ = ["Evidence", "Optimum"]

_PLACE = (
    "prepressure",
    "frequency_difference",
    "on_periods",
    "periods",
    "switching_phase",
    "load_torque",
    "phase_lead",
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Evidence(Value):
    """Why the answer is to be believed.

    Attributes
    ----------
    map_shape : tuple of int
        Grid of the box on which the search began.
    basins : int
        Places of that map that meet the constraints and that no place around beats.
    starts : int
        How many places IPOPT started from.
    optima : tuple of float
        Objectives of the distinct local optima, the best first.
    places : tuple of dict
        Where these are, by the names of what varies.
    stationarity : float or None
        Slope of the objective across the box, over the objective, that the constraints and edges leave where IPOPT
        ended; above 3e-3 a kink has stopped it, and a compass search has gone on from there.
    pulses : int
        Combinations of periods, on_periods and phase lead in the ranges.
    pruned : int
        Those that a coarse map ruled out.
    reachable_speed : (float, float) or None
        Lowest and highest mean speed in the box under the other constraints, rad/s; where the target is not between.
    """

    map_shape: tuple[int, ...]
    basins: int
    starts: int
    optima: tuple[float, ...]
    places: tuple[dict[str, float], ...]
    stationarity: float | None
    pulses: int
    pruned: int
    reachable_speed: tuple[float, float] | None


@dataclass(frozen=True, eq=False, kw_only=True)
class Optimum(Result, Value):
    """An operating point under constraints; SI units, frequencies in Hz, speeds in rad/s.

    Attributes
    ----------
    status : {"solved", "infeasible", "failed"}
        What the checked point and the evidence say, not a solver.  ``failed``: neither a point that meets the
        constraints nor evidence that there is none.
    objective : float or None
        At the optimum; None unless solved.
    prepressure, frequency_difference, on_periods, periods, switching_phase, load_torque, phase_lead : float or None
        The optimum; of what is infeasible, the nearest point that can be reached; None where no speed balances the
        load anywhere in the box.
    mean_speed, speed_volatility, q_average, q_volatility : float or None
        There, by :func:`trum_sym.evaluate` at a tolerance of 1e-9.
    constraint_violation : float or None
        The largest, over the constraint's bound; up to 1e-8 counts as met.
    evaluations : int
        Orbits computed on the way.
    message : str
        The answer in one line.
    evidence : Evidence
    figures : mapping
        Every figure of the point.
    problem : Problem
        What was solved, at the best pulse counts; for more questions of the same kind.
    objective_unit : str
        SI unit of ``objective`` and of the local optima.

    Examples
    --------
    >>> import trum_sym as ts
    >>> bounds = {"prepressure": 180.0, "frequency_difference": (2800, 3300)}
    >>> best = ts.optimize(bounds=bounds, target_speed="633 arcsec/s")
    >>> best.status, f"{best.frequency_difference:.0f} Hz", len(best.evidence.optima)
    ('solved', '3140 Hz', 1)
    """

    status: str
    objective: float | None
    prepressure: float | None
    frequency_difference: float | None
    on_periods: int | None
    periods: int | None
    switching_phase: float | None
    load_torque: float | None
    phase_lead: int | None
    mean_speed: float | None
    speed_volatility: float | None
    q_average: float | None
    q_volatility: float | None
    constraint_violation: float | None
    evaluations: int
    message: str
    evidence: Evidence
    figures: Mapping[str, Any]
    problem: Problem
    objective_unit: str = "1"

    def __repr__(self) -> str:
        return f"<Optimum {self.status}: {self.message}>"

    def to_text(self, title: str = "") -> str:
        """The answer as a table under a title, which is the motor's name if not given."""
        return _as_table(self, title or one_line(self.problem.motor.name))

    def _answer(self) -> dict[str, object]:
        """The answer by name, without ``figures`` and ``problem``; None for what has no meaning or is infinite."""
        hidden = ("figures", "problem")
        names = [field.name for field in fields(self) if field.name not in hidden]
        found = {name: finite(getattr(self, name)) for name in names}
        evidence = {field.name: getattr(self.evidence, field.name) for field in fields(Evidence)}
        return {**found, "evidence": evidence}

    @property
    def inputs(self) -> Inputs:
        """Motor, drive at the optimum, levels, and the tolerance at which it was checked."""
        from trum_sym.optimiser.finish import TOLERANCE

        problem, place = self.problem, {}
        if self.prepressure is not None:
            place = {name: getattr(self, name) for name in _PLACE}
        return Inputs(problem.motor, replace(problem.drive, **place), problem.levels, None, TOLERANCE)

    def load_text(self) -> str:
        """The load at the optimum in words, or the range that it was sought in."""
        box = self.problem.box
        if "load_torque" in box.names and self.prepressure is None:
            k = box.names.index("load_torque")
            return f"load {full(box.low[k])} to {full(box.high[k])} N m"
        return self.inputs.drive.load_text()

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures do not say by themselves."""
        return () if self.holding is None else self.holding.remarks

    @property
    def holding(self) -> Holding | None:
        """What it takes to hold the point; None where no speed balances the load anywhere."""
        if self.prepressure is None:
            return None
        inputs = self.inputs
        return self.problem.asked.of(inputs.motor, inputs.drive, inputs.levels)

    def to_dict(self) -> dict[str, Any]:
        """Inputs, answer, every figure, remarks and units by name, in SI units: what ``optimize --json`` prints."""
        problem, inputs, holding = self.problem, self.inputs.record(), self.holding
        if self.prepressure is None:
            inputs["drive"] = {**inputs["drive"], "prepressure": None, "frequency_difference": None}
        found = {
            **inputs,
            **self.figures,
            **self._answer(),
            "searched": {
                name: [float(low), float(high)]
                for name, low, high in zip(problem.box.names, problem.box.low, problem.box.high, strict=True)
            },
            "constraints": [constraint.text for constraint in problem.constraints],
            "remarks": [],
        }
        found = {**found, "units": units_of(found)}
        return found if holding is None else holding.joined(found)


def _shown(name: str, figures: Mapping[str, Any]) -> tuple[str, str, str, str]:
    quantity = quantity_of(name)
    value, error = readable(name, figures[name]), figures.get(f"{name}_error")
    text = (f"{value:.8g}", "") if error is None else with_error(value, readable(name, error))
    return quantity.label, *text, "" if quantity.shown == "1" else quantity.shown


def _as_table(optimum: Optimum, title: str) -> str:
    heading = f"{title}\n\n{optimum.status}: {optimum.message}"
    if optimum.prepressure is None:
        return heading
    rows: list[tuple[str, str, str, str]] = [  # the place so that others compute the same figures from it
        ("prepressure", full(optimum.prepressure), "", "N"),
        ("frequency difference", full(optimum.frequency_difference or 0.0), "", "Hz"),
        ("periods in a cycle", f"{optimum.periods}", "", ""),
        ("of them on", f"{optimum.on_periods}", "", ""),
        ("switching phase", full(optimum.switching_phase or 0.0), "", "rad"),
        ("phase lead", f"{optimum.phase_lead:+d}", "", ""),
        ("load torque", full(optimum.load_torque or 0.0), "", "N*m"),
    ]
    names = (
        "mean_speed",
        "min_speed",
        "max_speed",
        "speed_volatility",
        "q_average",
        "q_volatility",
        "stall_torque",
        "contact_fraction",
    )
    rows += [_shown(name, optimum.figures) for name in names]
    rows.append(("constraint violation, of its bound", f"{optimum.constraint_violation:.1e}", "", ""))
    evidence = optimum.evidence
    grid = " x ".join(map(str, evidence.map_shape))
    notes = [
        f"map of {grid} places; basins meeting the constraints: {evidence.basins}, starts: {evidence.starts}",
        f"distinct local optima: {_optima(optimum)}",
    ]
    if evidence.pulses > 1:
        what = "pulse counts and phase leads"
        notes.append(f"{what}: {evidence.pulses} combinations, {evidence.pruned} ruled out by a coarse map")
    holding = optimum.holding
    held = [] if holding is None else ["", *holding.lines()]
    table = text_table(rows, align="lrll")
    remarks = [f"remark: {remark}" for remark in ([] if holding is None else holding.remarks)]
    return "\n".join([heading, "", table, *held, "", *remarks, *[""] * bool(remarks), *notes])


def _optima(optimum: Optimum) -> str:
    """The distinct local optima in the objective's unit that people read."""
    if not optimum.evidence.optima:
        return "none"
    unit, scale = optimum.objective_unit, 1.0
    if unit == "rad/s":
        unit, scale = "arcsec/s", 1 / ARCSEC
    values = ", ".join(f"{scale * value:.6g}" for value in optimum.evidence.optima)
    return values if unit == "1" else f"{values} {unit}"
