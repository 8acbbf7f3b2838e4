"""Characteristics of a motor: speed, power and efficiency under load, speed by frequency and prepressure, stall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.inputs.checks import Array, ArrayLike, broadcast_shape
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.measured_points import CURVES, FORMS, MeasuredPoint
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_point, check_single, numbers_of, one_number
from trum_sym.model.coupling import check_coupling
from trum_sym.model.cycle import response, scaled
from trum_sym.model.kernels import call
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import evaluate, prepare
from trum_sym.model.rotor import history, solve_orbit, surface_and_contact
from trum_sym.studies.coupled import COUPLED, coupled_curves
from trum_sym.text import one_line, plain

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["characteristics", "predicted"]

_PLACES = 401  # over the contact, for the power that friction takes
_BRISTLE_STEPS = 4000
_SAMPLES = 32  # of a drive period
_POINTS = Domain(low=2, low_open=False, high=1001, integer=True)
_FREQUENCIES = (200.0, 5000.0)  # Hz above the resonance
_PLACES_OF = {
    "speed_torque": ("mean_speed", "torque"),
    "speed_frequency": ("speed_by_frequency", "drive_frequency"),
    "speed_prepressure": ("speed_by_prepressure", "prepressure"),
    "stall_prepressure": ("stall_by_prepressure", "prepressure"),
}
_VARIABLES = {
    "mean_speed": ("torque", "rad/s", "mean speed under load"),
    "output_power": ("torque", "W", "load torque times mean speed"),
    "contact_efficiency": ("torque", "1", "output power over what the stator's surface gives to the contact"),
    "speed_by_frequency": ("frequency", "rad/s", "mean speed without load"),
    "drive_frequency": ("frequency", "Hz", "drive frequency"),
    "speed_by_prepressure": ("prepressure", "rad/s", "mean speed without load"),
    "stall_by_prepressure": ("prepressure", "N*m", "mean torque on the rotor held still"),
}


def characteristics(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    points: float = 25,
    frequencies: ArrayLike | None = None,
    prepressures: ArrayLike | None = None,
    measured: Sequence[MeasuredPoint] = (),
    tolerance: float = 1e-6,
    **levels: Unpack[LevelChoice],
) -> xr.Dataset:
    """The characteristics of a motor for the plain wave, and for pulse drive where the drive has pulses.

    All speeds and torques are along the direction in which the drive runs without load.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given.  Of plain numbers, no arrays; so is the drive.
    drive : Drive, optional
        The paper's Table 3 if not given.  Its load is replaced; the plain wave has ``on_periods = periods``.
    points : int
        Of each curve whose abscissae are not given: loads from none to what friction can carry, frequency differences
        from 200 to 5000 Hz, prepressures over the range of eq. 8's fit.
    frequencies : (n,) array, Hz, optional
        Frequency differences.
    prepressures : (n,) array, N, optional
        Forces between rotor and stator.
    measured : sequence of MeasuredPoint
        From ``trum_sym.inputs.measured_points.load_measured``, kept beside the curves; nothing is fitted to them.
    tolerance : float
        As for :func:`trum_sym.evaluate`.
    contact, resonance, foundation, amplitude, compliance, tangential
        As for :func:`trum_sym.evaluate`.  The brush counts for the plain wave; pulses take the layer as rigid.
    coupling : {"none", "contact"}
        ``"contact"`` lets the rotor act back on the wave (docs/coupling.md): for the plain wave alone, so that the
        drive has to have ``on_periods = periods``.  Of several steady states, the stable one of the highest wave is
        shown.

    Returns
    -------
    xarray.Dataset
        Over ``drive`` (plain, pulse) and ``torque`` (N m): mean_speed, output_power, contact_efficiency; over
        ``frequency`` (Hz) and ``prepressure`` (N): speed_by_frequency, speed_by_prepressure, stall_by_prepressure.
        NaN where a load is beyond friction or runs the rotor back.  With ``coupling = "contact"`` also amplitude
        (m), lead (rad), resonance_shift (Hz), input_power, contact_power and layer_power (W), layer_share,
        efficiency, up to what amplitude and voltage the rotor stands (standing_amplitude, standing_voltage), what
        the phases draw (current, electric_power, reactive_power, power_factor, electric_efficiency; NaN for a motor
        file without ``piezo_permittivity``), the parts of the droop, and how many steady states there are.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    ConvergenceError
        As :func:`trum_sym.evaluate` does.
    MissingExtraError
        Without xarray.

    Examples
    --------
    >>> import trum_sym as ts
    >>> curves = ts.characteristics(ts.load_motor("trum60"), points=3, amplitude="forced", compliance="flange")
    >>> dict(curves.sizes)
    {'drive': 2, 'torque': 3, 'frequency': 3, 'prepressure': 3}
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise MissingExtraError("characteristics", str(error.name), "data") from None
    count = int(one_number("points", points, "1", _POINTS))
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    check_single(numbers_of(motor, drive, None), "one number: characteristics are of one motor and drive")
    chosen = Levels(**levels)
    coupled = chosen.coupling == "contact"
    if coupled:
        check_coupling(motor, drive, chosen)
    low, high = float(motor.fit_prepressure_min.value), float(motor.fit_prepressure_max.value)
    axes = {
        "torque": np.linspace(0.0, 1.0, count, endpoint=False) * _carried(motor, drive),
        "frequency": _axis("frequencies", frequencies, np.linspace(*_FREQUENCIES, count), "frequency_difference"),
        "prepressure": _axis("prepressures", prepressures, np.linspace(low, high, count), "prepressure"),
    }
    pulsed = float(np.asarray(drive.on_periods)) < float(np.asarray(drive.periods))
    forms = FORMS if pulsed else FORMS[:1]
    if coupled:
        found = [coupled_curves(motor, drive, chosen, axes)]
    else:
        found = [_of_form(motor, drive, chosen, form, axes, tolerance) for form in forms]
    variables = {**_VARIABLES, **(COUPLED if coupled else {})}
    units = {"torque": "N*m", "frequency": "Hz", "prepressure": "N"}
    return xr.Dataset(
        {
            **{
                name: (("drive", axis), np.stack([of[name] for of in found]), {"units": unit, "long_name": meaning})
                for name, (axis, unit, meaning) in variables.items()
            },
            "stall_torque": ("drive", np.array([of["stall_torque"] for of in found]), {"units": "N*m"}),
            "direction": ("drive", np.array([of["direction"] for of in found]), {"units": "1"}),
            **_measured(measured),
        },
        coords={
            "drive": list(forms),
            **{name: (name, values, {"units": units[name]}) for name, values in axes.items()},
        },
        attrs=_attributes(motor, drive, chosen, tolerance),
    )


def _axis(name: str, given: ArrayLike | None, usual: Array, quantity: str) -> Array:
    """Values of a curve's abscissa, checked as the drive's."""
    values = np.atleast_1d(np.asarray(getattr(Drive(**{quantity: usual if given is None else given}), quantity)))  # type: ignore[arg-type]
    if values.ndim != 1:
        raise ParameterError(name, f"an array of shape {values.shape}", "a row of numbers")
    return values


def _carried(motor: Motor, drive: Drive) -> float:
    """The most that friction can carry, N m."""
    values = {**motor.symbols(), **drive.symbols(), "f": 1.0}
    return float(np.asarray(call("trum_stall_torque", values)["torque"]))


def _of_form(
    motor: Motor, drive: Drive, levels: Levels, form: str, axes: dict[str, Array], tolerance: float
) -> dict[str, Any]:
    """All curves of a drive's form."""
    if form == "plain":
        drive = replace(drive, on_periods=drive.periods)
    else:
        levels = replace(levels, tangential="rigid")
    free = replace(drive, load_torque=0.0)
    words = {name: getattr(levels, name) for name in LevelChoice.__annotations__}

    def at(**changed: Any) -> Any:  # noqa: ANN401
        return evaluate(motor, replace(free, **changed), tolerance=tolerance, **words)

    direction = 1.0 if not np.asarray(at().mean_speed) < 0 else -1.0
    loaded = at(load_torque=direction * axes["torque"])
    speed = direction * np.asarray(loaded.mean_speed)
    speed = np.where(speed >= 0, speed, np.nan)
    power = axes["torque"] * speed
    by_frequency = at(frequency_difference=axes["frequency"])
    by_prepressure = at(prepressure=axes["prepressure"])
    losses = np.array(
        [
            _lost(motor, replace(free, load_torque=direction * load), levels, tolerance) if np.isfinite(v) else np.nan
            for load, v in zip(axes["torque"], speed, strict=True)
        ]
    )
    with np.errstate(all="ignore"):
        efficiency = power / (power + losses)
    return {
        "mean_speed": speed,
        "output_power": power,
        "contact_efficiency": efficiency,
        "speed_by_frequency": direction * np.asarray(by_frequency.mean_speed),
        "drive_frequency": np.asarray(by_frequency.drive_frequency),
        "speed_by_prepressure": direction * np.asarray(by_prepressure.mean_speed),
        "stall_by_prepressure": direction * np.asarray(by_prepressure.stall_torque),
        "stall_torque": direction * float(np.ravel(loaded.stall_torque)[0]),
        "direction": direction,
    }


def _lost(motor: Motor, drive: Drive, levels: Levels, tolerance: float) -> float:
    """Power that slip turns into heat, W: the mean over a cycle of traction times slip, over all crests."""
    case = prepare(motor, drive, levels, tolerance, warn=False)
    arguments = case.arguments
    raw = solve_orbit(arguments, case.symbols).raw
    if levels.tangential == "brush":
        return _lost_by_bristles(case.symbols, arguments, float(raw["mean"]), float(np.asarray(drive.load_torque)))
    count = _SAMPLES * int(drive.periods)
    timing = float(np.asarray(call("trum_drive", case.values)["T"]))
    times = timing * np.arange(1, count + 1) / count
    moving = response(times * (1 - 1e-12), scaled(case.values, case.stator.W), case.stator.D, case.stator.k_c)
    touching = surface_and_contact(arguments, moving)
    speed = history(arguments, raw, count)["speed"]
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in {**case.symbols, **touching}.items()}
    u = column["theta"] * np.linspace(-1, 1, _PLACES)
    at = call("trum_interface", {**column, "x": u / column["k_c"], "x_max": 0.0, "v": speed[:, np.newaxis]})
    heat = np.asarray(at["traction"]) * (np.asarray(at["v_x"]) - speed[:, np.newaxis])
    width = 2 * np.asarray(touching["theta"]) / np.asarray(case.stator.k_c) / (_PLACES - 1)
    over_contact = width * (heat.sum(axis=-1) - (heat[..., 0] + heat[..., -1]) / 2)
    return float(np.mean(over_contact) * np.asarray(case.symbols["n_j"]))


def _lost_by_bristles(symbols: dict[str, ArrayLike], values: dict[str, ArrayLike], speed: float, load: float) -> float:
    """What the surface gives to bristles less what the rotor passes on; the bristles are moved step by step."""
    side, crest = float(np.asarray(values["s"])), float(np.asarray(values["R_v"]))
    bristle = {"theta": values["theta"], "grip": values["grip"], "ratio": side * speed / crest}
    u = float(np.asarray(values["theta"])) * np.linspace(-1, 1, _BRISTLE_STEPS + 1)
    free = call("trum_brush_passage", {**bristle, "u": u, "u_0": u[0], "t_0": 0.0})
    limit, sheared = np.asarray(free["limit"]).tolist(), np.diff(np.asarray(free["stress"])).tolist()
    stress = [0.0]
    for most, by in zip(limit[1:], sheared, strict=True):
        stress.append(min(max(stress[-1] + by, -most), most))
    carried = np.trapezoid(np.array(stress) * np.cos(u), u) / np.trapezoid(limit, u)
    force = float(np.asarray(symbols["mu"])) * float(np.asarray(symbols["F_c"]))
    return force * crest * float(carried) - load * speed / float(np.asarray(symbols["r_c"]))


def _measured(points: Sequence[MeasuredPoint]) -> dict[str, Any]:
    """Measured points as variables along a dimension of their own."""
    if not isinstance(points, Sequence):
        raise ParameterError("measured", points, "a list of points from load_measured")
    for point in points:
        if not isinstance(point, MeasuredPoint):
            raise ParameterError("measured", point, "points from load_measured")
    names = ("curve", "drive", "source", "note")
    text = {f"measured_{name}": ("point", np.array([plain(getattr(p, name)) for p in points])) for name in names}
    units = {"units": "; ".join(f"{curve}: {x}, {y}" for curve, (x, y) in CURVES.items())}
    numbers = {f"measured_{name}": ("point", np.array([getattr(p, name) for p in points]), units) for name in "xy"}
    return {**text, **numbers} if points else {}


def _attributes(motor: Motor, drive: Drive, levels: Levels, tolerance: float) -> dict[str, Any]:
    broadcast_shape(drive.numbers())
    return {
        "title": f"{one_line(motor.name)}: characteristics",
        "motor": plain(motor.name),
        **{name: float(np.asarray(value)) for name, value in drive.numbers().items() if name != "load_torque"},
        "start": drive.start,
        **{f"{name}_level": getattr(levels, name) for name in LevelChoice.__annotations__},
        "pulse_tangential_level": "rigid",
        "tolerance": tolerance,
    }


def predicted(curves: xr.Dataset) -> Array:
    """What the curves say at the measured points' abscissae, in SI; NaN beyond their ends or for a drive without them.

    Parameters
    ----------
    curves : xarray.Dataset
        From :func:`characteristics`, with measured points.

    Returns
    -------
    (k,) array
    """
    forms = curves["drive"].values.tolist()
    found = np.full(curves.sizes.get("point", 0), np.nan)
    for k in range(found.size):
        curve, form = (str(curves[f"measured_{name}"].values[k]) for name in ("curve", "drive"))
        if form not in forms:
            continue
        place = forms.index(form)
        ordinate, abscissa = _PLACES_OF[curve]
        along = curves[abscissa].values if abscissa != "drive_frequency" else curves[abscissa].values[place]
        found[k] = np.interp(
            float(curves["measured_x"].values[k]), along, curves[ordinate].values[place], left=np.nan, right=np.nan
        )
    return found
