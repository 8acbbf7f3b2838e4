"""The public names, each from where it lives; read by type checkers and, on first use, by ``lazy_loader``."""

from .calibration.calibrate import Calibration as Calibration
from .calibration.calibrate import calibrate as calibrate
from .errors import ConvergenceError as ConvergenceError
from .errors import ImplausibleWarning as ImplausibleWarning
from .errors import MissingExtraError as MissingExtraError
from .errors import ParameterError as ParameterError
from .errors import StaleBuildWarning as StaleBuildWarning
from .errors import UnfinishedError as UnfinishedError
from .errors import ValidityWarning as ValidityWarning
from .inputs.distributions import Distribution as Distribution
from .inputs.drive import Drive as Drive
from .inputs.motor import Motor as Motor
from .inputs.motor import Parameter as Parameter
from .inputs.motor_file import load_motor as load_motor
from .inputs.motor_writer import save_motor as save_motor
from .inputs.schedule import Schedule as Schedule
from .model.coupled_point import CoupledPoint as CoupledPoint
from .model.drive_orbit import DriveOrbit as DriveOrbit
from .model.drive_orbit import drive_orbit as drive_orbit
from .model.histories import simulate as simulate
from .model.holding import Holding as Holding
from .model.holding import holding as holding
from .model.operating_point import OperatingPoint as OperatingPoint
from .model.operating_point import evaluate as evaluate
from .model.sensitivities import Sensitivities as Sensitivities
from .model.sensitivities import sensitivities as sensitivities
from .optimiser.result import Optimum as Optimum
from .optimiser.search import optimize as optimize
from .studies.admittance import admittance as admittance
from .studies.characteristics import characteristics as characteristics
from .studies.pareto import pareto as pareto
from .studies.robust import robust as robust
from .studies.speed_table import speed_table as speed_table
from .studies.track import Tracking as Tracking
from .studies.track import track as track
from .sweeps.run import sweep as sweep
from .uncertainty.study import spread as spread

__version__: str

__all__ = [
    "Calibration",
    "ConvergenceError",
    "CoupledPoint",
    "Distribution",
    "Drive",
    "DriveOrbit",
    "Holding",
    "ImplausibleWarning",
    "MissingExtraError",
    "Motor",
    "OperatingPoint",
    "Optimum",
    "Parameter",
    "ParameterError",
    "Schedule",
    "Sensitivities",
    "StaleBuildWarning",
    "Tracking",
    "UnfinishedError",
    "ValidityWarning",
    "admittance",
    "calibrate",
    "characteristics",
    "drive_orbit",
    "evaluate",
    "holding",
    "load_motor",
    "optimize",
    "pareto",
    "robust",
    "save_motor",
    "sensitivities",
    "simulate",
    "speed_table",
    "spread",
    "sweep",
    "track",
]
