"""Time histories of the rotor's periodic orbit, as a labelled data set (Sects. 3, 4)."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.points import check_single, numbers_of, one_number, period_of
from trum_sym.model.cycle import response, scaled
from trum_sym.model.kernels import call
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import Case, OperatingPoint, settle
from trum_sym.model.rotor import RUNAWAY, history, solve_orbit, surface_and_contact
from trum_sym.model.string import SLACK
from trum_sym.text import one_line, plain

if TYPE_CHECKING:
    import xarray as xr

    from trum_sym.model.coupled_point import CoupledCase, CoupledPoint

__all__ = ["REGIONS", "VARIABLES", "simulate"]

REGIONS = ("A off", "B off", "both on")
"""What ``region`` 0, 1, 2 mean: the paper's T_redu, T_addredu, T_add."""

VARIABLES = {
    "w_A": ("m", "modal displacement of phase A"),
    "w_B": ("m", "modal displacement of phase B"),
    "zeta_z": ("m", "displacement of the surface towards the rotor at x = 0 (eq. 11)"),
    "zeta_x": ("m", "displacement of the surface along the circumference at x = 0 (eq. 11)"),
    "Q": ("m^2/s", "direction determinant (eq. A5)"),
    "crest_speed": ("m/s", "speed of the surface along the circumference at the wave's crest"),
    "theta": ("rad", "contact half-angle, pi for a whole wave in contact (eq. 31)"),
    "friction": ("1", "net friction, share of mu F_c (eqs. 34 to 37)"),
    "rotor_speed": ("rad/s", "speed of the rotor (eq. 38)"),
    "rotor_angle": ("rad", "angle of the rotor since t1 of the first cycle"),
}
"""Unit and meaning of every variable."""

_MAX_SAMPLES = 50_000_000


def simulate(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    cycles: float = 1,
    samples_per_period: float = 64,
    sampling_period: float | None = None,
    tolerance: float | None = None,
    **levels: Unpack[LevelChoice],
) -> xr.Dataset:
    """Time histories of one operating point on its periodic orbit.

    Parameters
    ----------
    motor, drive, contact, resonance, foundation, amplitude, compliance, tangential, coupling, sampling_period
        As for :func:`trum_sym.evaluate`, but every number a single one.
    tolerance
        As for :func:`trum_sym.evaluate`, but every number a single one.
    cycles : whole number
        Drive cycles.  The orbit repeats itself, the rotor's angle goes on.
    samples_per_period : whole number
        Samples in a drive period, the first of them at its start.

    Returns
    -------
    xarray.Dataset
        Over the one dimension ``time`` (s since t1, ``cycles * periods * samples_per_period`` values, the end not
        included) with the coordinate ``region``: 0 while A is off, 1 while B is off, 2 while both are on.  Variables:
        ``w_A``, ``w_B`` (m, eqs. 9, 10), ``zeta_z``, ``zeta_x`` (m, eq. 11), ``Q`` (m^2/s, eq. A5), ``crest_speed``
        (m/s), ``theta`` (rad, eq. 31), ``friction`` (share of mu F_c, eqs. 34 to 37), ``rotor_speed`` (rad/s, eq. 38),
        ``rotor_angle`` (rad); ``attrs`` of each holds unit and meaning, those of the set every setting, every figure of
        ``evaluate`` and the package's version.  With ``coupling = "contact"`` there is no ``Q``, but ``rotor_height``
        (m) and ``pressure_force`` (N), and the orbit is the one whose figures ``evaluate`` gives.  Where no speed
        balances the load, ``runaway`` is 1 there, and ``friction``, ``rotor_speed`` and ``rotor_angle`` are NaN.

    Raises
    ------
    ParameterError
        For bad input; names the parameter, what it got, what is allowed.
    ConvergenceError
        If the forced amplitude and the resonance do not settle.
    MissingExtraError
        Without xarray.

    Examples
    --------
    >>> import trum_sym as ts
    >>> histories = ts.simulate(drive=ts.Drive(load_torque=0.1), samples_per_period=16)
    >>> dict(histories.sizes), histories.rotor_speed.attrs["units"]
    ({'time': 320}, 'rad/s')
    """
    try:
        import xarray as xr
    except ImportError:
        raise MissingExtraError("simulate", "xarray", "data") from None
    count_domain = Domain(low=1, low_open=False, high=_MAX_SAMPLES, high_open=False, integer=True)
    repeats = int(one_number("cycles", cycles, "1", count_domain))
    per_period = int(one_number("samples_per_period", samples_per_period, "1", count_domain))
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    period = period_of(sampling_period)
    check_single({} if period is None else {"sampling_period": period})
    if isinstance(drive, Drive) and isinstance(motor, Motor):  # evaluate refuses all else
        check_single(numbers_of(motor, drive, period))
        if repeats * per_period * int(drive.periods) > _MAX_SAMPLES:
            allowed = f"at most {_MAX_SAMPLES} samples, cycles * periods * samples_per_period"
            raise ParameterError("cycles", repeats, allowed)
    chosen = Levels(**levels)
    case: Case | CoupledCase
    point: OperatingPoint | CoupledPoint
    if chosen.coupling == "contact":
        from trum_sym.model import coupled_histories as coupled
        from trum_sym.model.coupled_point import coupled_point, prepare_coupled

        case = prepare_coupled(motor, drive, chosen, tolerance, period)
        point = coupled_point(case)
        variables, data = coupled.VARIABLES, coupled.coupled_cycles(case, point, repeats, per_period)
        asked = case.tolerance
    else:
        case, point = settle(motor, drive, chosen, tolerance, period)
        variables, data = VARIABLES, _cycles(case, point, repeats, per_period)
        asked = float(np.asarray(case.arguments["tolerance"]))
    count = int(drive.periods) * per_period
    region = _regions(drive, count)
    time = point.cycle_time * (np.repeat(np.arange(repeats), count) + np.tile(np.arange(count), repeats) / count)
    settings = {"cycles": repeats, "samples_per_period": per_period, "tolerance": asked}
    return xr.Dataset(
        {
            name: ("time", data[name], {"units": unit, "long_name": meaning})
            for name, (unit, meaning) in variables.items()
        },
        coords={
            "time": ("time", time, {"units": "s", "long_name": "time since t1 of the first cycle"}),
            "region": (
                "time",
                np.tile(region, repeats),
                {"flag_values": [0, 1, 2], "flag_meanings": " ".join(name.replace(" ", "_") for name in REGIONS)},
            ),
        },
        attrs=_attributes(case, point, {**settings, "sampling_period": None if period is None else float(period)}),
    )


def _regions(drive: Drive, count: int) -> np.ndarray[tuple[int, ...], np.dtype[np.int8]]:
    """0, 1 or 2 while A is off, B is off, both are on, at ``count`` equal times of a cycle."""
    samples = np.arange(count)
    off = (int(drive.periods) - int(drive.on_periods)) * count // int(drive.periods)
    return ((samples >= off).astype(np.int8) + (samples >= 2 * off)).astype(np.int8)


def _cycles(case: Case, point: OperatingPoint, repeats: int, per_period: int) -> dict[str, Array]:
    """Some cycles at equal times, by the names of :data:`VARIABLES`; the rotor's angle goes on."""
    count = int(case.drive.periods) * per_period
    columns = _cycle(case, point, count)
    advance = columns.pop("advance")
    data = {name: np.tile(column, repeats) for name, column in columns.items()}
    data["rotor_angle"] += np.repeat(np.arange(repeats), count) * advance
    return data


def _cycle(case: Case, point: OperatingPoint, count: int) -> dict[str, Array]:
    """One cycle at ``count`` equal times from t1 on, and what the rotor's angle advances in it."""
    stator, arguments = case.stator, case.arguments
    radius = float(case.motor.contact_radius.value)
    samples = np.arange(count)
    found = response(point.cycle_time * samples / count, scaled(case.values, stator.W), stator.D, stator.k_c)
    touching = surface_and_contact(arguments, found)
    columns = {
        "w_A": found["w_A"],
        "w_B": found["w_B"],
        **call("trum_displacement", {**found, "D": stator.D, "k_c": stator.k_c, "x": 0.0}),
        "Q": found["Q"],
        "crest_speed": touching["R_v"] * np.asarray(touching["cos_phi"]),
        "theta": touching["theta"],
    }
    speed = angle = columns["friction"] = np.full(count, np.nan)
    advance = np.nan
    if np.isfinite(point.mean_speed):
        lap = history(arguments, solve_orbit(arguments, case.symbols).raw, count)  # the last one at the cycle's end
        path = lap["distance"] / radius
        speed, angle, advance = np.roll(lap["speed"], 1) / radius, np.append(0.0, path[:-1]), path[-1]
        columns["friction"] = (
            call("trum_friction", {**touching, "v": speed * radius})["f"]
            if "grip" not in arguments
            else np.full(count, arguments["f"])  # of a brush: what balances the load
        )
    columns |= {"rotor_speed": speed, "rotor_angle": angle, "advance": advance}
    return {name: np.array(column, np.float64) for name, column in columns.items()}


def _attributes(
    case: Case | CoupledCase, point: OperatingPoint | CoupledPoint, settings: Mapping[str, float | None]
) -> dict[str, str | float | int]:
    """Every setting, figure and flag, as text and numbers that any file format holds."""
    motor, drive, levels = case.motor, case.drive, case.levels
    figures = {name: value for name, value in point.figures.items() if name not in ("motor", "converged")}
    attributes = {
        "title": f"{one_line(motor.name)}: time histories on the periodic orbit",
        "source": f"trum-sym {version('trum-sym')}",
        "motor": plain(motor.name),
        **drive.numbers(),
        **drive.words(),
        "contact": levels.contact,
        "resonance_level": levels.resonance,
        "foundation": levels.foundation,
        "amplitude_level": levels.amplitude,
        "compliance": levels.compliance,
        "tangential": levels.tangential,
        "coupling": levels.coupling,
        **{name: "none" if value is None else value for name, value in settings.items()},
        **figures,
        "converged": int(bool(point.converged)),
        "runaway": int(point.reason == RUNAWAY),
        "slack": int(point.reason == SLACK),
    }
    for name, parameter in motor.parameters():
        attributes[f"motor_{name}"] = f"{float(parameter.value):.12g} {parameter.unit} ({plain(parameter.source)})"
    return {name: _plain(value) for name, value in attributes.items()}


def _plain(value: Any) -> str | float | int:  # noqa: ANN401
    """As text or a number that any file format holds."""
    return value if isinstance(value, str) else int(value) if isinstance(value, int) else float(value)
