"""How the figures of an operating point change with what it depends on: derivatives, carried along the orbit."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_point
from trum_sym.inputs.shown import quantity_of, readable
from trum_sym.model.batch import call_in_blocks
from trum_sym.model.inputs import Inputs, units_of
from trum_sym.model.kernels import SLOPE_FIGURES, SLOPE_PARAMETERS, call, expect, signature
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import Case, prepare
from trum_sym.model.rotor import Orbit, as_orbit, weight_inertia
from trum_sym.model.stator import solve_stator
from trum_sym.output.digits import with_error
from trum_sym.output.result import Result
from trum_sym.output.text_table import text_table
from trum_sym.values import Value

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["DIFFERENTIATED", "PARAMETERS", "Sensitivities", "orbit_with_slopes", "sensitivities"]

PARAMETERS = (
    "prepressure",
    "frequency_difference",
    "load_torque",
    "load_inertia",
    "friction_coefficient",
    "amplitude",
    "resonance_frequency",
)
DIFFERENTIATED = ("mean_speed", "min_speed", "max_speed", "speed_volatility", "contact_fraction", "stall_torque")

# The driver's rows and columns by name
_FIGURE = {name: row for row, name in enumerate(SLOPE_FIGURES)}
_BY = {name: column for column, name in enumerate(SLOPE_PARAMETERS)}
_TURN = 2 * np.pi
_STATES = ("a_A", "b_A", "a_B", "b_B")
_FREQUENCIES = ("omega_n", "Delta_omega")
expect("the figures with slopes", ("mean", "low", "high", "variance", "contact", "held"), SLOPE_FIGURES)
expect(
    "what slopes are by",
    ("prepressure", "difference", "drag", "friction", "amplitude", "resonance"),
    SLOPE_PARAMETERS,
)
expect(
    "the slopes' inputs",
    (*signature("rotor_orbit")[0], *(f"{state}_{by}" for state in _STATES for by in _FREQUENCIES)),
    signature("rotor_slopes")[0],
)
_STEP = 1e-3  # of the stator's differences, relative: their error is its fourth power


@dataclass(frozen=True, eq=False)
class Sensitivities(Result, Value, Mapping[str, Mapping[str, Array]]):
    """Slopes of figures by parameters, ``[figure][parameter]``, with units.

    Attributes
    ----------
    slopes : mapping of mappings of arrays
        What ``evaluate``'s figure changes by, per change of the parameter, in SI units (frequencies in Hz).
    inputs : Inputs
        Motor, drive, levels and tolerance that they hold for.
    errors : mapping of mappings of arrays, or None
        With coupling, what the slopes may be off, estimates of the same units; None for slopes carried along an orbit.

    Examples
    --------
    >>> import trum_sym as ts
    >>> slopes = ts.sensitivities()
    >>> slopes.units["mean_speed"]["prepressure"]
    'rad/s/N'
    >>> slopes.to_frame().shape
    (6, 7)
    """

    slopes: Mapping[str, Mapping[str, Array]]
    inputs: Inputs
    errors: Mapping[str, Mapping[str, Array]] | None = None

    def __getitem__(self, figure: str) -> Mapping[str, Array]:
        return self.slopes[figure]

    def __iter__(self) -> Iterator[str]:
        return iter(self.slopes)

    def __len__(self) -> int:
        return len(self.slopes)

    def __repr__(self) -> str:
        return f"<Sensitivities of {', '.join(self)} by {', '.join(self.parameters)}>"

    @property
    def parameters(self) -> tuple[str, ...]:
        """What the slopes are by."""
        return tuple(next(iter(self.slopes.values())))

    @property
    def remarks(self) -> tuple[str, ...]:
        """Of a single point with coupling: what has no slope, and why."""
        if self.errors is None:
            return ()
        lost = [by for by in self.parameters if not np.isfinite(next(iter(self.values()))[by])]
        return tuple(f"no slope by {by}: an orbit beside the point's is not on its branch" for by in lost)

    @property
    def units(self) -> dict[str, dict[str, str]]:
        """The SI unit of every slope, ``[figure][parameter]``."""
        return {figure: {by: _per(quantity_of(figure).unit, _unit_of(by)) for by in self[figure]} for figure in self}

    def to_dict(self) -> dict[str, Any]:
        """Inputs, slopes and their units by name, in SI units."""
        slopes = {figure: {by: np.asarray(slope).tolist() for by, slope in self[figure].items()} for figure in self}
        found = self.inputs.record()
        if self.errors is not None:
            found["slope_errors"] = {f: {by: float(e) for by, e in of.items()} for f, of in self.errors.items()}
        return {
            **found,
            "slopes": slopes,
            "remarks": list(self.remarks),
            "units": {**units_of(found), "slopes": self.units},
        }

    def to_text(self) -> str:
        """A table: a row a figure, a column a parameter, in the units that people read."""
        rows = []
        for figure in self:
            quantity, scale = quantity_of(figure), readable(figure, 1.0)
            cells = [np.asarray(self[figure][by]) * scale for by in self.parameters]
            unit = "" if quantity.shown == "1" else f" [{quantity.shown}]"
            shown = [f"{float(x):.6g}" if not x.ndim else f"{x.shape}" for x in cells]
            if self.errors is not None:
                off = (float(self.errors[figure][by]) * scale for by in self.parameters)
                shown = [
                    " +- ".join(with_error(float(x), e)).removesuffix(" +- ") for x, e in zip(cells, off, strict=True)
                ]
            rows.append((quantity.label + unit, *shown))
        units = {by: "" if _unit_of(by) == "1" else f" [{_unit_of(by)}]" for by in self.parameters}
        headers = ("change of", *(f"per {by}\n{unit.strip()}" for by, unit in units.items()))
        table = text_table(rows, headers, "l" + "r" * len(self.parameters))
        return "\n".join([table, *(f"remark: {remark}" for remark in self.remarks)])

    def to_frame(self) -> pd.DataFrame:
        """A pandas data frame of a single point: figures by parameters; ``attrs["units"]`` has the units.

        Raises
        ------
        MissingExtraError
            Without pandas.
        ParameterError
            For an array of points, which :meth:`to_xarray` takes.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingExtraError("to_frame", "pandas", "data") from None
        if any(np.ndim(slope) for by in self.values() for slope in by.values()):
            raise ParameterError("to_frame", "slopes of an array of points", "a single point; to_xarray takes arrays")
        frame = pd.DataFrame({by: {figure: float(self[figure][by]) for figure in self} for by in self.parameters})
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self) -> xr.Dataset:
        """A data set with a variable a figure over the dimension ``parameter`` and those of the points.

        Raises
        ------
        MissingExtraError
            Without xarray.
        """
        try:
            import xarray as xr
        except ImportError:
            raise MissingExtraError("to_xarray", "xarray", "data") from None
        points = [f"dim_{k}" for k in range(np.ndim(self["mean_speed"]["prepressure"]))]
        return xr.Dataset(
            {
                figure: (["parameter", *points], np.stack([self[figure][by] for by in self.parameters]),
                         {"units": " or ".join(dict.fromkeys(self.units[figure].values()))})
                for figure in self
            },
            {"parameter": list(self.parameters)},
        )  # fmt: skip


def _unit_of(parameter: str) -> str:
    return DRIVE_DOMAINS[parameter][1] if parameter in DRIVE_DOMAINS else SPECS[parameter].unit


def _per(figure: str, parameter: str) -> str:
    if parameter == "1":
        return figure
    return f"{figure}/{parameter}" if parameter.isalpha() else f"{figure}/({parameter})"


def sensitivities(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    tolerance: float = 1e-6,
    **levels: Unpack[LevelChoice],
) -> Sensitivities:
    """Derivatives of an operating point's figures.

    The rotor's equation (38) is differentiated along its orbit together with the speed at which the orbit closes
    (implicit function theorem).  What amplitude and resonance do when prepressure or frequency difference changes is
    taken from the stator's closed forms by fourth-order differences.

    Parameters
    ----------
    motor, drive, contact, resonance, foundation, amplitude, compliance, tangential, coupling
        As for :func:`trum_sym.evaluate`; arrays broadcast.  ``tangential`` has to be ``"rigid"``.
    tolerance : float
        Of the orbit that is differentiated.  The slopes' median error is below it; single slopes are much worse
        (docs/rotor.md).

    Returns
    -------
    Sensitivities
        ``[figure][parameter]``, arrays of the inputs' common shape, in SI units (frequencies in Hz): what
        ``evaluate``'s figure changes by, per change of the parameter.  Figures are ``mean_speed``, ``min_speed``,
        ``max_speed``, ``speed_volatility``, ``contact_fraction``, ``stall_torque``; parameters ``prepressure``,
        ``frequency_difference``, ``load_torque``, ``load_inertia``, ``friction_coefficient``, ``amplitude``,
        ``resonance_frequency``.  Amplitude and resonance follow
        prepressure and frequency difference as they do in ``evaluate``; under ``amplitude`` and
        ``resonance_frequency`` stands what each does alone.  ``speed_volatility`` is the continuous one.  NaN where
        no speed balances the load.  A weight's inertia follows ``load_torque``.  Where an extreme changes hands the
        slope is that of the extreme which is seen, one of the two sides'.  With ``coupling = "contact"``, for a single
        point: central differences of orbits on one branch with estimates of their errors, ``errors``; of
        ``highest_wave`` and ``input_power`` and not the stall torque, by ``damping_ratio`` and ``rotor_mass`` and not
        amplitude and resonance.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    ConvergenceError
        If the forced amplitude and the resonance do not settle.

    Examples
    --------
    >>> import trum_sym as ts
    >>> slopes = ts.sensitivities(drive=ts.Drive(load_torque=0.1))
    >>> f"{slopes['mean_speed']['load_torque']:.3g} {slopes.units['mean_speed']['load_torque']}"
    '-16.5 rad/s/(N*m)'
    """
    chosen = Levels(**levels)
    if chosen.coupling == "contact":
        from trum_sym.model.coupled_slopes import coupled_slopes

        motor = load_motor() if motor is None else motor
        drive = Drive() if drive is None else drive
        check_point(motor, drive)
        slopes, errors = coupled_slopes(motor, drive, chosen, tolerance)
        return Sensitivities(slopes, Inputs(motor, drive, chosen, None, tolerance), errors)
    case = prepare(motor, drive, chosen, tolerance)
    _, found = orbit_with_slopes(case)
    inputs = Inputs(case.motor, case.drive, case.levels, None, case.tolerance)
    return Sensitivities({name: found[name] for name in DIFFERENTIATED}, inputs)


def orbit_with_slopes(case: Case) -> tuple[Orbit, dict[str, dict[str, Array]]]:
    """The orbit of a case that :func:`trum_sym.model.operating_point.prepare` has checked, and its figures' slopes.

    Beside those of :data:`DIFFERENTIATED` stands ``speed_deviation``, the speed's standard deviation in rad/s.

    Raises
    ------
    ParameterError
        For a layer that is a brush, whose slopes are not known.
    """
    if case.levels.tangential != "rigid":
        raise ParameterError("tangential", case.levels.tangential, "rigid: the slopes of the other are not known")
    raw = call_in_blocks(
        "rotor_slopes",
        {**case.arguments, **_states(case)},
        inner={"slopes": (len(SLOPE_FIGURES), len(SLOPE_PARAMETERS))},
        smallest=1,  # steps with slopes are long: a core each
    )
    slopes = raw["slopes"]
    force, friction, radius, load = (np.asarray(case.symbols[name]) for name in ("F_c", "mu", "r_c", "T_load"))
    inertia = np.asarray(call("trum_total_inertia", case.symbols)["J_total"])
    # push and drag are in inverse proportion to the inertia, as push is in proportion to the friction
    by_inertia = -(slopes[..., _BY["friction"]] + slopes[..., _BY["drag"]] * _column(case.arguments["drag"]))
    by_inertia = by_inertia / _column(inertia)
    per_torque = np.divide(weight_inertia(case.symbols), load, out=np.zeros(np.shape(inertia)), where=load != 0)
    alone = {
        "prepressure": slopes[..., _BY["prepressure"]] / _column(force),
        "frequency_difference": slopes[..., _BY["difference"]] * _TURN,
        "load_torque": slopes[..., _BY["drag"]] * _column(radius / inertia) + by_inertia * _column(per_torque),
        "load_inertia": by_inertia,
        "friction_coefficient": slopes[..., _BY["friction"]] / _column(friction),
        "amplitude": slopes[..., _BY["amplitude"]] / _column(case.stator.W),
        "resonance_frequency": slopes[..., _BY["resonance"]] * _TURN,
    }
    for name, (d_omega_n, d_W) in _following(case).items():
        alone[name] = alone[name] + alone["amplitude"] * _column(d_W)
        alone[name] = alone[name] + alone["resonance_frequency"] * _column(d_omega_n / _TURN)
    orbit = as_orbit({name: value for name, value in raw.items() if name != "slopes"}, case.symbols)
    return orbit, _figures(case, raw, alone)


def _column(value: ArrayLike) -> Array:
    """With a last axis for the figures."""
    return np.asarray(value, np.float64)[..., np.newaxis]


def _states(case: Case) -> dict[str, ArrayLike]:
    """How the free motion before t1 follows the frequencies."""
    rates: dict[str, ArrayLike] = {f"{state}_{by}": 0.0 for state in _STATES for by in _FREQUENCIES}
    if case.drive.start == "steady":
        return rates
    return {**rates, **call(f"trum_start_{case.drive.start}_slopes", case.arguments)}


def _following(case: Case) -> dict[str, tuple[Array, Array]]:
    """Derivatives of the resonance (rad/s) and the amplitude (m) by prepressure and frequency difference."""
    force, difference = (np.asarray(x) for x in (case.drive.prepressure, case.drive.frequency_difference))
    force_step, difference_step = _STEP * force, _STEP * np.asarray(case.stator.omega_n) / _TURN
    shifts = np.zeros((2, 8))
    shifts[0, :4] = shifts[1, 4:] = (1, -1, 2, -2)  # first along one, then along the other
    along_force, along_difference = shifts.reshape(2, 8, *(1,) * len(case.shape))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)  # the point itself has warned
        moved = replace(
            case.drive,
            prepressure=force + along_force * force_step,
            frequency_difference=difference + along_difference * difference_step,
        )
        stator = solve_stator(case.motor, moved, case.levels)

    def derivatives(of: ArrayLike) -> tuple[Array, Array]:
        at = np.broadcast_to(of, (8, *case.shape))
        by_force = (8 * (at[0] - at[1]) - (at[2] - at[3])) / (12 * force_step)
        return by_force, (8 * (at[4] - at[5]) - (at[6] - at[7])) / (12 * difference_step)

    resonance, amplitude = derivatives(stator.omega_n), derivatives(stator.W)
    return {
        "prepressure": (resonance[0], amplitude[0]),
        "frequency_difference": (resonance[1], amplitude[1]),
    }


def _figures(case: Case, orbit: Mapping[str, ArrayLike], slopes: Mapping[str, Array]) -> dict[str, dict[str, Array]]:
    """From rim speeds, variance and friction fraction to the rotor's figures."""
    radius, force, friction = (np.asarray(case.symbols[name]) for name in ("r_c", "F_c", "mu"))
    mean, held = np.asarray(orbit["mean"]), np.asarray(orbit["held"])
    found: dict[str, dict[str, Array]] = {name: {} for name in (*DIFFERENTIATED, "speed_deviation")}
    with np.errstate(all="ignore"):
        deviation = np.sqrt(orbit["variance"])
        for parameter, slope in slopes.items():
            for name, row in (("mean_speed", "mean"), ("min_speed", "low"), ("max_speed", "high")):
                found[name][parameter] = slope[..., _FIGURE[row]] / radius
            of_deviation, of_mean = (
                slope[..., _FIGURE["variance"]] / (2 * deviation),
                slope[..., _FIGURE["mean"]] * np.sign(mean),
            )
            volatility = (of_deviation - deviation * of_mean / np.abs(mean)) / np.abs(mean)
            found["speed_volatility"][parameter] = volatility
            found["speed_deviation"][parameter] = of_deviation / radius
            found["contact_fraction"][parameter] = slope[..., _FIGURE["contact"]]
            stall = call("trum_stall_torque", {**case.symbols, "f": slope[..., _FIGURE["held"]]})["torque"]
            if parameter in ("prepressure", "friction_coefficient"):  # the torque is in proportion to both
                own = call("trum_stall_torque", {**case.symbols, "f": held})["torque"]
                stall = stall + own / (force if parameter == "prepressure" else friction)
            found["stall_torque"][parameter] = np.asarray(stall)
    return {
        name: {parameter: np.broadcast_to(value, case.shape) for parameter, value in of.items()}
        for name, of in found.items()
    }
