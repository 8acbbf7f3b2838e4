"""Tables 1 to 5 of the paper beside what the model uses and gives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from trum_sym.inputs.drive import STARTS, Drive
from trum_sym.inputs.motor import Motor, Parameter
from trum_sym.inputs.units import ARCSEC, parse_unit
from trum_sym.model.operating_point import evaluate
from trum_sym.model.rotor import encoder_readings, history
from trum_sym.paper.cycle import READINGS, Reading, pulling, solve
from trum_sym.paper.published import ENCODER, TABLE_2, TABLE_5

__all__ = ["TABLE_1", "TABLE_4", "Table", "tables"]


@dataclass(frozen=True)
class Table:
    """One table of the page: cells are text, numbers already rounded.

    Attributes
    ----------
    anchor, title, caption : str
    head : tuple of str
    rows : tuple of tuples of str
    numeric : tuple of int
        Columns of numbers.
    """

    anchor: str
    title: str
    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: tuple[int, ...] = ()


TABLE_1 = (
    ("radius", "R", "Stator radius", 60.0, "mm"),
    ("tooth_count", "n_s", "Number of stator teeth", 72.0, "1"),
    ("perimeter", "l_s", "Stator perimeter", 188.4, "mm"),
    ("slot_width", "b_s", "Stator slot width", 0.8, "mm"),
    ("beam_width", "b_e", "Stator elastic beam width", 8.0, "mm"),
    ("layer_width", "b_m", "Friction material width", 1.2, "mm"),
    ("tooth_height", "h_t", "Stator elastic beam thickness", 2.0, "mm"),
    ("beam_thickness", "h_e", "Stator teeth thickness", 4.5, "mm"),
    ("piezo_thickness", "h_p", "Piezoelectric material thickness", 0.5, "mm"),
    ("layer_thickness", "h_m", "Friction material thickness", 0.2, "mm"),
    ("beam_density", "ρ_e", "Stator elastic beam density", 8900.0, "kg/m^3"),
    ("piezo_density", "ρ_p", "Piezoelectric material density", 7500.0, "kg/m^3"),
    ("layer_density", "ρ_m", "Friction material density", 2100.0, "kg/m^3"),
    ("beam_young_modulus", "E_e", "Stator elastic beam Young's modulus", 155.0, "GPa"),
    ("piezo_young_modulus", "E_p", "Piezoelectric material Young's modulus", 76.5, "GPa"),
    ("layer_young_modulus", "E_m", "Friction material Young's modulus", 5.0, "GPa"),
    ("beam_shear_modulus", "G_e", "Stator elastic beam shear modulus", 46.8, "GPa"),
    ("piezo_shear_modulus", "G_p", "Piezoelectric material shear modulus", 22.9, "GPa"),
    ("beam_poisson_ratio", "μ_e", "Stator elastic beam Poisson's ratio", 0.33, "1"),
    ("piezo_poisson_ratio", "μ_p", "Piezoelectric material Poisson's ratio", 0.31, "1"),
    ("layer_poisson_ratio", "μ_m", "Friction material Poisson's ratio", 0.3, "1"),
    ("damping_ratio", "ξ", "Damping ratio", 0.006, "1"),
    ("voltage", "U_s", "Piezoelectric voltage", 400.0, "V"),
    ("rotor_inertia", "J", "Moment of inertia of the rotor (no unit)", 4.5e-6, "kg*m^2"),
    ("shear_correction", "κ", "Shear correction coefficient", 0.9, "1"),
)
"""Parameter of the motor file, symbol, description, value and unit as printed; the load is in Table 3 too."""
_WHY = {
    "radius": "60 mm is the diameter: the perimeter l_s is π · 60 mm",
    "tooth_height": "its description is that of h_e: eqs. 1 and 2 need h_t < h_e",
    "beam_thickness": "its description is that of h_t",
    "beam_density": "unit printed as kg·m³",
    "piezo_density": "unit printed as kg·m³",
    "layer_density": "unit printed as kg·m³",
    "voltage": "400 V is peak to peak (Sect. 7.1); the amplitude is half of it",
    "rotor_inertia": "printed without a unit",
}
TABLE_4 = {"v_s": 633.0, "range": 400.0, "sigma_s": 17.3, "Q_aver": 1447.5, "Q_vib": 3446.4}
"""arcsec/s, arcsec/s, %, 1/s, 1/s."""


def _text(value: float, digits: int = 6) -> str:
    return f"{value:.{digits}g}".replace("-", "−")


def _unit(text: str) -> str:
    return "" if text == "1" else text.replace("^2", "²").replace("^3", "³").replace("*", "·")


def _off(ours: float, printed: float) -> str:
    """The difference in percent of the print, or how many times as large where that says more."""
    if ours == printed:
        return "="
    if abs(ours) > 10 * abs(printed):
        return f"× {ours / printed:.0f}".replace("-", "−")
    return f"{100 * (ours / printed - 1):+.2f} %".replace("-", "−")


def _parameters(motor: Motor) -> Table:
    rows = []
    for name, symbol, description, printed, unit in TABLE_1:
        parameter: Parameter = getattr(motor, name)
        ours = float(np.asarray(parameter.value)) / parse_unit(unit).to_si(1.0)
        rows.append(
            (symbol, description, _text(printed), _unit(unit), _text(ours), _off(ours, printed), _WHY.get(name, ""))
        )
    return Table(
        "table-1",
        "Table 1: parameters",
        "As printed, and as the motor file has it. The print's second κ, a "
        "height-width ratio, enters no equation; the load torque stands in Table 3.",
        ("symbol", "description in the paper", "printed", "unit", "used", "difference", "why"),
        tuple(rows),
        (2, 4, 5),
    )


def _assumed(motor: Motor) -> Table:
    rows = [
        (
            parameter.symbol.replace("mu", "μ"),
            name.replace("_", " "),
            _text(float(np.asarray(parameter.value))),
            _unit(parameter.unit),
            "" if parameter.range is None else " to ".join(_text(bound) for bound in parameter.range),
            parameter.reason,
        )
        for name, parameter in motor.parameters()
        if parameter.source == "assumed"
    ]
    return Table(
        "table-assumed",
        "What the paper does not give",
        "Assumed values, in the open: any of them can be set.",
        ("symbol", "parameter", "used", "unit", "plausible", "why"),
        tuple(rows),
        (2, 4),
    )


def _amplitudes(motor: Motor) -> Table:
    force = np.array(list(TABLE_2))
    found = 1e6 * np.asarray(evaluate(motor, Drive(prepressure=force)).amplitude)
    rows = [
        (_text(F), _text(printed), f"{ours:.3f}", _off(ours, printed))
        for (F, measured), ours in zip(TABLE_2.items(), found, strict=True)
        for printed in [round(1e6 * measured, 1)]
    ]
    return Table(
        "table-2",
        "Table 2: amplitude under prepressure",
        "Measured, and eq. 8 with the paper's own fit.",
        ("F_c (N)", "measured (µm)", "eq. 8 (µm)", "difference"),
        tuple(rows),
        (0, 1, 2, 3),
    )


def _settings() -> Table:
    drive = Drive()
    rows = (
        ("Angular frequency difference Δω", "2π × 3000 rad/s", f"2π × {drive.frequency_difference:g} rad/s"),
        ("Number (single-phase pulses n)", "14", f"{drive.on_periods:g}"),
        ("Number (periodic pulses m)", "20", f"{drive.periods:g}"),
        ("Motor load T_load", "0.3 N·m", f"{drive.load_torque:g} N·m"),
        ("Prepressure F_c", "180 N", f"{drive.prepressure:g} N"),
    )
    return Table(
        "table-3",
        "Table 3: the drive",
        "The defaults of every command. Both pulse counts are printed as “Number”; "
        "n = 14 and m = 20 follow from Sect. 6.2.",
        ("parameter", "printed", "used"),
        rows,
    )


def _results(motor: Motor) -> Table:
    rows = []
    machines = {"no": motor, "a weight": pulling(motor)}
    for start, lead, load in product(STARTS, (1, -1), machines):
        reading, machine = Reading(start, lead), machines[load]
        drive = reading.of(Drive())
        point = evaluate(machine, drive, sampling_period=ENCODER)
        speed, volatility = float(point.mean_speed) / ARCSEC, 100 * float(point.speed_volatility)
        Q_aver, Q_vib = float(point.q_average), float(point.q_volatility)
        cells = [
            (speed, "v_s"),
            (_range(machine, drive), "range"),
            (volatility, "sigma_s"),
            (Q_aver, "Q_aver"),
            (Q_vib, "Q_vib"),
        ]
        texts = (f"{_text(value, 5)} ({_off(value, TABLE_4[name])})" for value, name in cells)
        rows.append((reading.label, load, *texts))
    printed = ("printed", "", *(_text(value) for value in TABLE_4.values()))
    return Table(
        "table-4",
        "Table 4: results at Table 3's drive",
        "In every reading that the paper leaves open. Speeds as an "
        "encoder of 2 ms reads them (Sect. 8); range is highest less lowest reading; in brackets the difference from "
        "the print. The load's inertia: none, as in eq. 38, or that of a weight on a string at the stator's radius, as "
        "the paper loaded its motor (Sect. 8.1). Nothing is tuned: friction and contact radius stand at their assumed "
        "values, on which the speeds hinge.",
        (
            "start, phase lead",
            "load's inertia",
            "v_s (arcsec/s)",
            "range (arcsec/s)",
            "σ_s (%)",
            "Q_aver (1/s)",
            "Q_vib (1/s)",
        ),
        (printed, *rows),
        (2, 3, 4, 5, 6),
    )


def _range(motor: Motor, drive: Drive) -> float:
    """Highest less lowest reading of the encoder, wherever in the cycle it starts, arcsec/s."""
    cycle = solve(motor, drive, tolerance=1e-3)
    distance = history(cycle.case.arguments, cycle.orbit.raw, 64 * int(np.asarray(drive.periods)))["distance"]
    starts = np.arange(distance.size) / distance.size
    readings = encoder_readings(distance, float(cycle.edges[-1]), ENCODER, starts)
    return float(np.ptp(readings)) / float(np.asarray(cycle.case.symbols["r_c"])) / ARCSEC


def _experiments(motor: Motor) -> Table:
    drive = replace(Drive(), prepressure=TABLE_5["prepressure"], frequency_difference=TABLE_5["frequency_difference"])
    rows = []
    for reading in (READINGS[0], READINGS[-1]):
        point = evaluate(pulling(motor), reading.of(drive), sampling_period=ENCODER)
        figures = (
            np.asarray(point.mean_speed) / ARCSEC,
            np.asarray(point.q_average),
            100 * np.asarray(point.speed_volatility),
            np.asarray(point.q_volatility),
        )
        for i, (force, difference) in enumerate(zip(*TABLE_5.values(), strict=True)):
            cells = (_text(float(figure[i]), 5) for figure in figures)
            rows.append((str(i + 1), reading.label, f"{force:g}", f"{difference:g}", *cells))
    return Table(
        "table-5",
        "Table 5: both variables at once",
        "Settings as printed (Δω there in rad/s, of the size of Hz) and "
        "the model's figures, σ_s as the encoder of 2 ms reads it, with the inertia of a weight on a string at the "
        "stator's radius; the paper's own are only drawn, in its Figure 32.",
        ("no.", "start, phase lead", "F_c (N)", "Δf (Hz)", "v_s (arcsec/s)", "Q_aver (1/s)", "σ_s (%)", "Q_vib (1/s)"),
        tuple(rows),
        (2, 3, 4, 5, 6, 7),
    )


def tables(motor: Motor) -> Iterator[Table]:
    """Tables 1 to 5 in order, and after the first what is assumed."""
    yield _parameters(motor)
    yield _assumed(motor)
    yield _amplitudes(motor)
    yield _settings()
    yield _results(motor)
    yield _experiments(motor)
