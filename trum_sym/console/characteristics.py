"""``trum-sym characteristics``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import (
    check_plot,
    chosen_drive,
    chosen_levels,
    chosen_motor,
    continuous_options,
    examples,
    number_option,
    plot_options,
)
from trum_sym.console.say import say

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["characteristics"]

_RPM = 30 / math.pi  # of 1 rad/s


@click.command(
    epilog=examples(
        "trum-sym characteristics --amplitude forced --frequency-difference 500 --points 9",
        "trum-sym characteristics --motor ring60 --points 9 --plot curves.png",
        "trum-sym characteristics --compliance flange --points 9 --out curves.csv",
        "trum-sym characteristics --coupling contact --on-periods 20 --frequency-difference 500 --points 9",
    )
)
@continuous_options
@number_option("--points", "1", 25, "Points of each curve.", "N")
@number_option(
    "--tolerance", "1", 1e-6, "Largest bound of the errors of speeds over the largest speed, 1e-9 to 1e-2.", "T"
)
@click.option(
    "--measured",
    type=click.Path(path_type=Path),
    metavar="FILE.toml",
    help="Measured points to stand beside the curves.  [default: NAME.measured.toml beside the motor's file]",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the curves: .nc (NetCDF, with every setting and unit) or .csv, a row a point of a curve.",
)
@plot_options("Draw them")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units.")
def characteristics(
    motor: str,
    overrides: tuple[str, ...],
    points: float,
    tolerance: float,
    measured: Path | None,
    out: Path | None,
    plot: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """Speed, power and contact efficiency under load, speed by frequency and prepressure, stall by prepressure.

    For the plain wave (both phases always on), and for pulse drive where --on-periods is less than --periods.  Loads
    run from none to what friction can carry, so --load-torque is refused.
    """
    from trum_sym.inputs.measured_points import load_measured, measured_of
    from trum_sym.output.files import check_new, check_packages
    from trum_sym.studies.characteristics import characteristics as curves_of

    _refuse_load()
    check_plot(plot, force)
    if out is not None:
        check_new("--out", out, (".nc", ".csv"), force)
        check_packages(out)
    beside = measured_of(motor) if measured is None else measured
    machine, drive = chosen_motor(motor, overrides), chosen_drive(options)
    found = curves_of(
        machine,
        drive,
        points=points,
        measured=() if beside is None else load_measured(beside),
        tolerance=tolerance,
        **chosen_levels(options),
    )
    if out is not None:
        _write(found, out)
    if plot is not None:
        from trum_sym.plots.characteristics import draw

        draw("--plot", found, plot)
    if as_json:
        from trum_sym.model.inputs import Inputs
        from trum_sym.model.levels import Levels
        from trum_sym.output.json_text import json_text

        inputs = Inputs(machine, drive, Levels(**chosen_levels(options)), None, tolerance)
        say(json_text({**inputs.record(), **_as_json(found)}))
    else:
        say(_as_text(found))


def _refuse_load() -> None:
    from trum_sym.errors import ParameterError

    context = click.get_current_context()
    if context.get_parameter_source("load_torque") is click.core.ParameterSource.COMMANDLINE:
        raise ParameterError("load_torque", context.params["load_torque"], "nothing: the curves run over all loads")


def _write(found: xr.Dataset, out: Path) -> None:
    from trum_sym.output.files import replaced, write

    if out.suffix == ".nc":
        write("--out", found, out)
        return
    lines = ["curve,drive,x,y,x_unit,y_unit,kind"]
    lines += [",".join(str(cell) for cell in row) for row in _rows(found)]
    with replaced("--out", out) as file:
        file.write(("\n".join(lines) + "\n").encode())


def _rows(found: xr.Dataset) -> list[tuple[object, ...]]:
    """A row a point of a curve, computed ones first."""
    from trum_sym.inputs.measured_points import CURVES

    rows: list[tuple[object, ...]] = []
    for name, variable in found.data_vars.items():
        if variable.dims[0] != "drive" or len(variable.dims) < 2:
            continue
        axis = str(variable.dims[1])
        units = found[axis].attrs["units"], variable.attrs["units"]
        for k, form in enumerate(found["drive"].values):
            pairs = zip(found[axis].values, variable.values[k], strict=True)
            rows += [(name, form, repr(float(x)), repr(float(y)), *units, "computed") for x, y in pairs]
    for k in range(found.sizes.get("point", 0)):
        curve = str(found["measured_curve"].values[k])
        x, y = (repr(float(found[f"measured_{axis}"].values[k])) for axis in "xy")
        rows.append((curve, found["measured_drive"].values[k], x, y, *CURVES[curve], "measured"))
    return rows


def _as_json(found: xr.Dataset) -> dict[str, Any]:
    variables = {
        str(name): {"dims": list(v.dims), "units": v.attrs.get("units"), "values": v.values.tolist()}
        for name, v in found.variables.items()
    }
    return {"variables": variables, "settings": dict(found.attrs)}


def _as_text(found: xr.Dataset) -> str:
    """No-load speed, stall and droop for each form of the drive, then measured points beside the curves."""
    import numpy as np
    from tabulate import tabulate

    rows = []
    for k, form in enumerate(found["drive"].values):
        torque, speed = found["torque"].values, found["mean_speed"].values[k]
        stall = float(found["stall_torque"].values[k])
        at = [float(np.interp(share * stall, torque, speed)) / speed[0] for share in (0.49, 0.56)]
        power = found["output_power"].values[k]
        best = np.nanmax(power) if np.isfinite(power).any() else np.nan
        efficiency = found["contact_efficiency"].values[k]
        most = np.nanmax(efficiency) if np.isfinite(efficiency).any() else np.nan
        rows.append((form, _RPM * speed[0], stall, *at, best, 100 * most))
    head = ("drive", "no load, rpm", "stall, N m", "speed at 49 % of stall", "at 56 %", "power, W", "efficiency, %")
    lines = [str(found.attrs["title"]), "", tabulate(rows, head, floatfmt=".4g")]
    if "amplitude" in found:
        lines += ["", _under_load(found, _WAVE), "", _under_load(found, _ELECTRIC)]
    if "point" in found.sizes:
        lines += ["", _compared(found)]
    return "\n".join(lines)


_WAVE = {
    "wave, um": ("amplitude", 1e6),
    "force ahead, rad": ("lead", 1.0),
    "resonance up by, Hz": ("resonance_shift", 1.0),
    "power in, W": ("input_power", 1.0),
    "lost in layer, W": ("layer_power", 1.0),
    "of it, %": ("layer_share", 100.0),
    "efficiency, %": ("efficiency", 100.0),
    "speed kept by contact": ("droop_compliance", 1.0),
    "by reaction": ("droop_reaction", 1.0),
    "stands up to, V": ("standing_voltage", 1.0),
    "states": ("states", 1.0),
}
_ELECTRIC = {
    "current, A": ("current", 1.0),
    "electric power, W": ("electric_power", 1.0),
    "reactive, W": ("reactive_power", 1.0),
    "power factor": ("power_factor", 1.0),
    "efficiency, %": ("electric_efficiency", 100.0),
}


def _under_load(found: xr.Dataset, columns: dict[str, tuple[str, float]]) -> str:
    """The wave under load, and what the phases draw, where the rotor acts back on it."""
    import numpy as np
    from tabulate import tabulate

    torque, stall = found["torque"].values, float(found["stall_torque"].values[0])
    rows = [
        (
            f"{share:.0%} of stall",
            *(k * float(np.interp(share * stall, torque, found[name].values[0])) for name, k in columns.values()),
        )
        for share in (0.0, 0.25, 0.49, 0.75)
    ]
    return str(tabulate(rows, ("load", *columns), floatfmt=".4g"))


def _compared(found: xr.Dataset) -> str:
    """Every measured point, and the curve there."""
    from tabulate import tabulate

    from trum_sym.studies.characteristics import predicted

    table = []
    for k, computed in enumerate(predicted(found)):
        curve, form, source, note = (
            str(found[f"measured_{name}"].values[k]) for name in ("curve", "drive", "source", "note")
        )
        x, y = (float(found[f"measured_{axis}"].values[k]) for axis in "xy")
        scale = _RPM if curve.startswith("speed") else 1.0
        table.append((curve, form, x, scale * y, scale * computed, source, note))
    head = ("curve", "drive", "at", "measured (rpm, N m)", "computed", "source", "note")
    return str(tabulate(table, head, floatfmt=".4g"))
