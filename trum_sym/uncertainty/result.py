"""A study of spread's result: the points that were computed, what spreads them, and which targets they miss."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.distributions import Distribution
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.model.coupled_point import CoupledPoint
from trum_sym.model.operating_point import OperatingPoint
from trum_sym.quantities import figures_at
from trum_sym.text import one_line
from trum_sym.uncertainty.propagation import Estimate, Propagation, share
from trum_sym.values import Value

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["BALANCED", "MISSED", "Drawn", "Target", "unit_of"]

BALANCED, MISSED = "balanced", "missed"  # outputs of the study itself: 1 or 0
_COMPARE = {">=": np.greater_equal, "<=": np.less_equal, ">": np.greater, "<": np.less}


def unit_of(name: str) -> str:
    """The SI unit of a parameter of motor or drive."""
    return DRIVE_DOMAINS[name][1] if name in DRIVE_DOMAINS else SPECS[name].unit


@dataclass(frozen=True, eq=False)
class Target(Value):
    """What an output has to keep to, such as ``mean_speed >= 600 arcsec/s``; ``bound`` in the output's SI unit."""

    text: str
    output: str
    relation: str
    bound: float

    def missed(self, values: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Where it is missed; a point without a value misses it."""
        return ~np.asarray(_COMPARE[self.relation](values, self.bound), bool)


@dataclass(frozen=True, eq=False)
class Drawn(Value):
    """What a study of spread has drawn and found; SI units, frequencies in Hz, speeds in rad/s.

    Attributes
    ----------
    motor, drive, levels
        The point that is studied.
    distributions : mapping of str to Distribution
        Of the uncertain parameters, as they were given.
    samples, seed : int
    outputs : tuple of str
        The figures that were asked for.
    targets : tuple of Target
    nominal : OperatingPoint
        With every parameter at its own value.
    propagation : Propagation
        All points, all figures there, and indices; besides the outputs, ``balanced`` is 1 where a speed balances the
        load and ``missed`` 1 where a target is missed.
    settled : (d + 2, n) array of bool
        Whether the rotor's orbit met the tolerance, by point.
    """

    motor: Motor
    drive: Drive
    levels: Mapping[str, object]
    distributions: Mapping[str, Distribution]
    samples: int
    seed: int
    outputs: tuple[str, ...]
    targets: tuple[Target, ...]
    nominal: OperatingPoint | CoupledPoint
    propagation: Propagation
    settled: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @property
    def unbalanced(self) -> Estimate:
        """The probability that no speed balances the load."""
        return share(self.propagation.values[BALANCED][:2] == 0)

    @property
    def unbounded(self) -> tuple[str, ...]:
        """Outputs without a variance: the volatility, if the mean speed passes zero among the points."""
        speed = self.propagation.values["mean_speed"]
        passes = bool((speed > 0).any() and (speed < 0).any())
        return ("speed_volatility",) if passes and "speed_volatility" in self.outputs else ()

    def points_where(self, chosen: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> list[dict[str, float]]:
        """The uncertain parameters at the chosen points of A and B."""
        drawn = {name: values[:2][chosen[:2]] for name, values in self.propagation.points.items()}
        return [dict(zip(drawn, map(float, row), strict=True)) for row in zip(*drawn.values(), strict=True)]

    def missing(self, target: Target | None = None) -> Estimate:
        """The probability of missing one target, or any of them; a point without a value misses."""
        values = self.propagation.values
        return share(values[MISSED][:2] == 1 if target is None else target.missed(values[target.output][:2]))

    def to_xarray(self) -> xr.Dataset:
        """Every computed point with its figures, units and settings.

        Raises
        ------
        MissingExtraError
            Without xarray.
        """
        try:
            import xarray as xr
        except ImportError as error:
            from trum_sym.errors import MissingExtraError

            raise MissingExtraError("a data set", str(error.name), "sweep") from None
        dims = ("matrix", "sample")
        found = self.propagation
        variables: dict[str, Any] = {
            name: (dims, values, {"units": unit_of(name)}) for name, values in found.points.items()
        }
        for name, output in figures_at(self.levels["coupling"] == "contact").items():
            # an uncertain amplitude is both, and the same
            variables[name] = (dims, found.values[name], {"units": output.unit, "long_name": output.label})
        variables["converged"] = (dims, self.settled, {"long_name": "the orbit met its tolerance"})
        attributes = {
            "title": f"spread of {one_line(self.motor.name)}",
            "trum_sym": version("trum-sym"),
            "samples": self.samples,
            "seed": self.seed,
            "distributions": "; ".join(f"{name}: {d.describe()}" for name, d in self.distributions.items()),
            **{f"drive_{name}": value for name, value in self.drive.numbers().items()},
            **self.drive.words(),
            **{f"motor_{name}": p.value for name, p in self.motor.parameters()},
            **{name: "" if level is None else level for name, level in self.levels.items()},
        }
        matrices = ["A", "B", *(f"A with {name} of B" for name in self.distributions)]
        return xr.Dataset(variables, coords={"matrix": matrices}, attrs=attributes)
