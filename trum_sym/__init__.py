"""Travelling-wave rotary ultrasonic motors driven at very low speed.

>>> import trum_sym as ts
>>> motor = ts.load_motor("trum60")
>>> point = ts.evaluate(motor, ts.Drive(prepressure=180.0, frequency_difference=3000.0))

Names are loaded on first use, so that the derivations, which share motor files and units with this
package, need no compiled kernels, and ``trum-sym --help`` does not wait for NumPy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trum_sym.calibration import Calibration, calibrate
    from trum_sym.drive import Drive
    from trum_sym.errors import ConvergenceError, MissingExtraError, ParameterError, UnfinishedError, ValidityWarning
    from trum_sym.histories import simulate
    from trum_sym.motor import Motor, Parameter
    from trum_sym.motor_file import load_motor
    from trum_sym.operating_point import OperatingPoint, evaluate
    from trum_sym.optimiser.result import Optimum
    from trum_sym.optimiser.search import optimize
    from trum_sym.slopes import sensitivities
    from trum_sym.studies.pareto import pareto
    from trum_sym.studies.robust import robust
    from trum_sym.studies.speed_table import speed_table
    from trum_sym.sweeps.run import sweep
    from trum_sym.uncertainty.distributions import Distribution
    from trum_sym.uncertainty.study import tolerance

__all__ = [
    "Calibration",
    "ConvergenceError",
    "Distribution",
    "Drive",
    "MissingExtraError",
    "Motor",
    "OperatingPoint",
    "Optimum",
    "Parameter",
    "ParameterError",
    "UnfinishedError",
    "ValidityWarning",
    "calibrate",
    "evaluate",
    "load_motor",
    "optimize",
    "pareto",
    "robust",
    "sensitivities",
    "simulate",
    "speed_table",
    "sweep",
    "tolerance",
]

_HOME = {
    "Calibration": "calibration",
    "ConvergenceError": "errors",
    "Distribution": "uncertainty.distributions",
    "Drive": "drive",
    "MissingExtraError": "errors",
    "Motor": "motor",
    "OperatingPoint": "operating_point",
    "Optimum": "optimiser.result",
    "Parameter": "motor",
    "ParameterError": "errors",
    "UnfinishedError": "errors",
    "ValidityWarning": "errors",
    "calibrate": "calibration",
    "evaluate": "operating_point",
    "load_motor": "motor_file",
    "optimize": "optimiser.search",
    "pareto": "studies.pareto",
    "robust": "studies.robust",
    "sensitivities": "slopes",
    "simulate": "histories",
    "speed_table": "studies.speed_table",
    "sweep": "sweeps.run",
    "tolerance": "uncertainty.study",
}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
