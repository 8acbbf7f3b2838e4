"""``trum-sym admittance``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trum_sym.console.options import (
    check_plot,
    chosen_motor,
    examples,
    number_option,
    plain_wave_options,
    plot_options,
)
from trum_sym.console.say import say

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["admittance"]


@click.command(
    epilog=examples(
        "trum-sym admittance --points 51",
        "trum-sym admittance --amplitude forced --set phase_coverage=0.4444 --points 51",
        "trum-sym admittance --compliance flange --from '38.5 kHz' --to '39.5 kHz' --points 51 --plot admittance.png",
    )
)
@plain_wave_options
@number_option("--from", "Hz", None, "First frequency  [default: 1 kHz below the free resonance]", "F", "low")
@number_option("--to", "Hz", None, "Last frequency  [default: 1 kHz above that with open electrodes]", "F", "high")
@number_option("--points", "1", 201, "Frequencies.", "N")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the curves: .nc (NetCDF, with every setting and unit) or .csv, a row a frequency and state.",
)
@plot_options("Draw them")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables; SI units.")
def admittance(
    motor: str,
    overrides: tuple[str, ...],
    low: float | None,
    high: float | None,
    points: float,
    out: Path | None,
    plot: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """Admittance of a phase over frequency, without a rotor and under one, and its circuit.

    Both phases are always on, at the motor's voltage; --prepressure, --load-torque and --phase-lead are those of the
    rotor.  What it takes of the motor file: piezo_permittivity, piezo_loss_factor, phase_coverage.
    """
    from trum_sym.errors import ParameterError
    from trum_sym.inputs.drive import Drive
    from trum_sym.output.files import check_new, check_packages
    from trum_sym.studies.admittance import admittance as curves_of
    from trum_sym.studies.admittance import frequencies_of

    check_plot(plot, force)
    if out is not None:
        check_new("--out", out, (".nc", ".csv"), force)
        check_packages(out)
    if (low is None) != (high is None):
        name = "--to" if high is None else "--from"
        raise ParameterError(name, "nothing", "both ends, or neither")
    axis = None if low is None or high is None else frequencies_of(low, high, points)
    drive = Drive(
        **{name: options.pop(name) for name in ("prepressure", "load_torque")},
        phase_lead=int(options.pop("phase_lead")),
    )
    found = curves_of(chosen_motor(motor, overrides), drive, frequencies=axis, points=points, **options)
    if out is not None:
        _write(found, out)
    if plot is not None:
        from trum_sym.plots.admittance import draw

        draw("--plot", found, plot)
    if as_json:
        from trum_sym.output.json_text import json_text

        say(json_text(_as_json(found)))
    else:
        say(_as_text(found))


def _write(found: xr.Dataset, out: Path) -> None:
    from trum_sym.output.files import replaced, write

    if out.suffix == ".nc":
        write("--out", found, out)
        return
    columns = [name for name, v in found.data_vars.items() if v.dims == ("state", "frequency")]
    lines = ["state,frequency [Hz]," + ",".join(f"{name} [{found[name].attrs['units']}]" for name in columns)]
    for state in found["state"].values:
        of = found.sel(state=state)
        numbers = zip(of["frequency"].values, *(of[name].values for name in columns), strict=True)
        lines += [",".join((str(state), *(repr(float(x)) for x in row))) for row in numbers]
    with replaced("--out", out) as file:
        file.write(("\n".join(lines) + "\n").encode())


def _as_json(found: xr.Dataset) -> dict[str, Any]:
    variables = {
        str(name): {"dims": list(v.dims), "units": v.attrs.get("units"), "values": v.values.tolist()}
        for name, v in found.variables.items()
    }
    return {"variables": variables, "settings": dict(found.attrs)}


_PORT = (
    ("force factor", "force_factor", 1.0, "N/V"),
    ("capacitance, held still", "capacitance", 1e9, "nF"),
    ("motional inductance", "inductance", 1e3, "mH"),
    ("motional capacitance", "motional_capacitance", 1e9, "nF"),
    ("motional resistance", "resistance", 1.0, "ohm"),
    ("resonance, short", "resonance", 1.0, "Hz"),
    ("resonance, open", "open_resonance", 1.0, "Hz"),
    ("effective coupling factor", "coupling_factor", 1.0, ""),
)


def _as_text(found: xr.Dataset) -> str:
    """The free phase's circuit, and where each curve is highest and lowest."""
    import numpy as np
    from tabulate import tabulate

    circuit = [(name, scale * float(found[of]), unit) for name, of, scale, unit in _PORT]
    rows: list[tuple[object, ...]] = []
    for state in found["state"].values:
        of = found.sel(state=state)
        if not np.isfinite(of["conductance"].values).any():
            rows.append((state, *(["nan"] * 6)))
            continue
        most = of.isel(frequency=int(np.nanargmax(of["conductance"].values)))
        size = np.hypot(of["conductance"].values, of["susceptance"].values)
        least = int(np.nanargmin(size))
        rows.append(
            (
                state,
                1e3 * float(most["conductance"]),
                float(most["frequency"]),
                1e6 * float(most["amplitude"]),
                float(most["electric_power"]),
                1e3 * float(size[least]),
                float(of["frequency"].values[least]),
            )
        )
    head = ("", "largest conductance, mS", "at, Hz", "wave, um", "power, W", "least |Y|, mS", "at, Hz")
    several = int((found["states"].values > 1).sum())
    lines = [
        str(found.attrs["title"]),
        "",
        tabulate(circuit, tablefmt="plain", floatfmt=".5g"),
        "",
        tabulate(rows, head, floatfmt=("", ".4g", ".6g", ".4g", ".4g", ".4g", ".6g")),
        "",
        f"wave and power at {found.attrs['voltage']:g} V, pressed with {found.attrs['prepressure']:g} N under "
        f"{found.attrs['load_torque']:g} N m",
    ]
    if several:
        lines.append(
            f"at {several} of {found.sizes['frequency']} frequencies the pressed wave has several steady states"
        )
    return "\n".join(lines)
