"""What a motor file may say, from the one list that also checks it: a template, a JSON Schema, a page of the docs."""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

from trum_sym.inputs.distributions import KINDS
from trum_sym.inputs.drive import BOX_NAMES, DRIVE_DOMAINS, SPREADING
from trum_sym.inputs.motor import SPECS, TO_DO, Motor
from trum_sym.inputs.motor_file import BENCH, load_motor
from trum_sym.inputs.units import parse_unit
from trum_sym.quantities import QUANTITIES
from trum_sym.text import one_line

__all__ = ["ENTRIES", "Entry", "in_unit", "page", "schema", "template"]


class Entry(NamedTuple):
    """A parameter for people: the unit that they write it in, and what it is."""

    unit: str
    meaning: str


_SECTIONS: dict[str, dict[str, Entry]] = {
    "Stator ring: metal beam with teeth": {
        "radius": Entry("mm", "outer radius of the stator; half of the diameter"),
        "tooth_count": Entry("1", "teeth on the ring"),
        "perimeter": Entry("mm", "circumference, 2 pi radius"),
        "slot_width": Entry("mm", "width of the slots between teeth"),
        "beam_width": Entry("mm", "width of the ring, from inner to outer radius"),
        "beam_thickness": Entry("mm", "height of the metal with its teeth"),
        "tooth_height": Entry("mm", "height of the teeth, less than beam_thickness"),
        "beam_density": Entry("kg/m^3", "of the metal"),
        "beam_young_modulus": Entry("GPa", "of the metal"),
        "beam_shear_modulus": Entry("GPa", "of the metal"),
        "beam_poisson_ratio": Entry("1", "of the metal"),
    },
    "Piezoelectric ring": {
        "piezo_width": Entry("mm", "width of the ceramic ring"),
        "piezo_thickness": Entry("mm", "thickness of the ceramic"),
        "piezo_density": Entry("kg/m^3", "of the ceramic"),
        "piezo_young_modulus": Entry("GPa", "of the ceramic"),
        "piezo_shear_modulus": Entry("GPa", "of the ceramic"),
        "piezo_poisson_ratio": Entry("1", "of the ceramic"),
        "piezo_strain_constant": Entry(
            "pC/N", "d_31 of the ceramic, as its sheet gives it; used by --amplitude forced"
        ),
        "piezo_compliance": Entry("m^2/N", "s_11 at constant field; used by --amplitude forced"),
        "voltage": Entry("V", "amplitude of the drive, half of peak to peak; used by --amplitude forced"),
    },
    "Friction layer on the rotor": {
        "layer_width": Entry("mm", "radial width of the layer in contact"),
        "layer_thickness": Entry("mm", "thickness of the layer"),
        "layer_density": Entry("kg/m^3", "of the layer"),
        "layer_young_modulus": Entry("GPa", "of the layer"),
        "layer_poisson_ratio": Entry("1", "of the layer"),
    },
    "Vibration": {
        "crests": Entry("1", "wavelengths around the ring, as in mode B_09"),
        "shear_correction": Entry("1", "Timoshenko's coefficient of the section"),
        "damping_ratio": Entry("1", "of the stator under prepressure, as a decay of its vibration shows"),
        "free_amplitude": Entry("um", "amplitude of one phase without prepressure"),
        "amplitude_factor": Entry(
            "1", "C_f of eq. 8: a phase's amplitude is free_amplitude C_f (F_c / 1 N)^-varsigma; calibrate fits both"
        ),
        "amplitude_exponent": Entry("1", "varsigma, the exponent of eq. 8"),
        "fit_prepressure_min": Entry("N", "eq. 8 was measured from here"),
        "fit_prepressure_max": Entry("N", "eq. 8 was measured up to here"),
    },
    "Contact and rotor": {
        "friction_coefficient": Entry("1", "between layer and stator"),
        "contact_radius": Entry("mm", "radius of the circle of contact"),
        "curvature_radius": Entry("mm", "of the contact, eq. 25; used by --contact hertz"),
        "rotor_inertia": Entry("kg*m^2", "of the rotor and all that turns with it"),
    },
    "Measured values that replace the modelled ones; each is optional": {
        "resonance_frequency": Entry("kHz", "of the stator under prepressure"),
        "amplitude": Entry("um", "of one phase at the prepressure of the drive"),
        "neutral_axis": Entry("mm", "from the tooth surface"),
        "wavenumber": Entry("1/m", "crests / radius if not given"),
        "layer_stiffness": Entry("N/m^2", "force per length of the circumference and depth"),
        "contact_stiffness": Entry("N/m^2", "the same of layer, teeth and flange in series; --compliance flange"),
        "tangential_stiffness": Entry("N/m^2", "of the layer in shear; used by --tangential brush"),
    },
    "Flange that carries the layer; all four are needed by --compliance flange, else none": {
        "flange_thickness": Entry("mm", "of the flange, as a plate"),
        "flange_length": Entry("mm", "how far it reaches out, from where it is held to the contact"),
        "flange_young_modulus": Entry("GPa", "of the flange"),
        "flange_poisson_ratio": Entry("1", "of the flange"),
    },
    "Rotor, layer and electrodes where the rotor acts back on the wave, --coupling contact; each is optional": {
        "rotor_mass": Entry(
            "g",
            "of what moves up and down with the rotor, in pulses and other schedules; none if not given; no plain wave "
            "depends on it",
        ),
        "layer_loss_factor": Entry(
            "1",
            "tan delta of the contact's stiffness at the drive's frequency; none if not given; the plain wave alone",
        ),
        "phase_coverage": Entry(
            "1",
            "share of the circumference that a phase's electrodes drive: 1, as eq. 7 has it, if not given; 4/9 where "
            "each phase has four of nine waves; counts with --amplitude forced, and in the capacitance",
        ),
        "piezo_permittivity": Entry("nF/m", "of the ceramic along its poling, at constant stress; current and power"),
        "piezo_loss_factor": Entry("1", "tan delta of the ceramic's capacitance; none if not given"),
    },
}
ENTRIES = {name: entry for section in _SECTIONS.values() for name, entry in section.items()}
"""Every parameter of a motor file."""

_KEYS = {
    "value": "a number, in ``unit``",
    "unit": "any unit that converts",
    "source": "where it comes from: a drawing, a data sheet, ``measured``, ``assumed``",
    "symbol": "the equations' symbol, to be read beside them",
    "range": "``[low, high]``, what is plausible; needed beside ``assumed``",
    "reason": "why this value; needed beside ``assumed``",
    "note": "anything",
    "distribution": "``uniform``, ``triangular``, ``normal`` or ``lognormal``, for ``trum-sym spread``",
    "mean": "of a normal or lognormal distribution, if not the value",
    "standard_deviation": "of a normal or lognormal distribution",
    "interval": "of a calibrated value: its confidence interval",
    "data": "of a calibrated value: the name of the data",
}


def in_unit(value: float, unit: str) -> float:
    """A value in SI in the unit that people write."""
    return float(f"{value / parse_unit(unit).to_si(1.0):.12g}")


def _quoted(text: str) -> str:
    """A string of TOML: JSON's, but for one character that JSON leaves."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def template(name: str, like: Motor | None = None) -> str:
    """A motor file to fill in: every parameter with its unit and meaning, the values still those of another motor.

    Parameters
    ----------
    name : str
        The new motor's.
    like : Motor, optional
        Whose values stand in it; TRUM-60 if not given.
    """
    like = load_motor() if like is None else like
    lines = [
        f"# {one_line(name)}: a motor file of trum-sym.  Replace every value whose source begins with '{TO_DO}',",
        "# and its source.",
        "# `trum-sym motor check FILE` says what is left to do, assumed, out of range or contradictory.",
        "# Units may be any that convert: mm, um, GPa, g/cm^3, kHz, N*m, %, ...",
        "",
        f"name = {_quoted(name)}",
        "",
        "# What searches (optimize, pareto, robust, speed-table) vary of the drive; without it they ask for ranges",
        "# [box]",
        '# prepressure = { range = [10.0, 40.0], unit = "N", source = "spring of the housing" }',
        '# frequency_difference = { range = [500.0, 3000.0], unit = "Hz", source = "amplifier" }',
        "",
        "# How far what drifts while the motor works may be off, to either side; in a unit, or in % of the value",
        "# [spreads]",
        '# prepressure = { value = 0.2, unit = "N", source = "force sensor" }',
        '# friction_coefficient = { value = 1.0, unit = "%", source = "measured" }',
        "",
        "[parameters]",
    ]
    known = dict(like.parameters())
    for title, entries in _SECTIONS.items():
        lines += ["", f"# --- {title} " + "-" * max(3, 94 - len(title))]
        for parameter, entry in entries.items():
            spec = SPECS[parameter]
            allowed = "" if spec.domain.describe("1") == "a finite number" else f"; {spec.domain.describe(spec.unit)}"
            lines.append(f"# {entry.meaning}{allowed}")
            value = in_unit(float(known[parameter].value), entry.unit) if parameter in known else 0.0
            text = repr(int(value)) if spec.domain.integer else repr(value)
            source = _quoted(f"{TO_DO}: value of {like.name}" if spec.required else "measured")
            about = f'unit = "{entry.unit}", symbol = "{spec.symbol}", source = {source}'
            line = f"{parameter} = {{ value = {text}, {about} }}"
            lines.append(line if spec.required else f"# {line}")
    lines += [
        "",
        "# --- Figures that were measured or published, to be shown beside the computed ones --------------",
        "# [[published]]",
        '# output = "mean_speed"          # a figure as evaluate --json names it',
        "# value = 100.0",
        '# unit = "arcsec/s"',
        '# source = "measured, June"',
        "# drive = { prepressure = 20.0, load_torque = 0.01 }  # in SI units; what it was measured at",
        "# sampling_period = 2e-3         # s; only of an encoder's speed_volatility",
        "",
    ]
    return "\n".join(lines)


def schema() -> dict[str, Any]:
    """A JSON Schema of motor files, for editors that complete and check TOML by one."""
    text: dict[str, Any] = {"type": "string"}
    ends = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
    kinds: dict[str, dict[str, Any]] = {
        **{key: {**text, "description": said} for key, said in _KEYS.items()},
        **{key: {**ends, "description": _KEYS[key]} for key in ("range", "interval")},
        **{key: {"type": "number", "description": _KEYS[key]} for key in ("value", "mean", "standard_deviation")},
        "distribution": {"enum": list(KINDS), "description": _KEYS["distribution"]},
    }
    parameters = {
        name: {
            "type": "object",
            "description": f"{entry.meaning}; {SPECS[name].domain.describe(SPECS[name].unit)}",
            "properties": {**kinds, "symbol": {"const": SPECS[name].symbol}},
            "required": ["value", "unit", "source"],
            "additionalProperties": False,
        }
        for name, entry in ENTRIES.items()
    }
    allowed = {
        "type": "object",
        "properties": {"range": ends, "unit": text, "source": text},
        "required": ["range", "unit", "source"],
        "additionalProperties": False,
    }
    amount = {
        "type": "object",
        "properties": {
            "value": {"type": "number", "exclusiveMinimum": 0},
            "unit": text,
            "source": text,
            "reason": text,
        },
        "required": ["value", "unit", "source"],
        "additionalProperties": False,
    }
    drive = {
        name: {"type": "number", "description": domain.describe(unit)} for name, (domain, unit) in DRIVE_DOMAINS.items()
    }
    bench = {
        name: {
            "type": "object",
            "description": spec.domain.describe(spec.unit),
            "properties": {**kinds, "symbol": {"const": spec.symbol}},
            "required": ["value", "unit", "source"],
            "additionalProperties": False,
        }
        for name, spec in BENCH.items()
    }
    published = {
        "type": "object",
        "properties": {
            "output": {"enum": list(QUANTITIES)},
            "value": {"type": "number"},
            "unit": text,
            "source": text,
            "drive": {"type": "object", "properties": drive, "additionalProperties": False},
            "sampling_period": {"type": "number", "exclusiveMinimum": 0},
        },
        "required": ["output", "value", "unit", "source", "drive"],
        "additionalProperties": False,
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Motor file of trum-sym",
        "type": "object",
        "properties": {
            "name": text,
            "parameters": {
                "type": "object",
                "properties": parameters,
                "required": [name for name, spec in SPECS.items() if spec.required],
                "additionalProperties": False,
            },
            **{
                table: {"type": "object", "properties": dict.fromkeys(names, entry), "additionalProperties": False}
                for table, names, entry in (
                    ("box", BOX_NAMES, allowed),
                    ("allowed", BOX_NAMES, allowed),
                    ("spreads", SPREADING, amount),
                )
            },
            "bench": {"type": "object", "properties": bench, "additionalProperties": False},
            "published": {"type": "array", "items": published},
        },
        "required": ["name", "parameters"],
        "additionalProperties": False,
    }


def page() -> str:
    """The page of the docs on motor files; ``trum-sym motor schema --format markdown`` prints it."""
    lines = [
        "# Motor files",
        "",
        "<!-- made by trum-sym motor schema --format markdown -->",
        "",
        "A motor is a TOML file.  Begin with a template, fill it in, check it, use it:",
        "",
        "    trum-sym motor new my.toml --name 'my motor'",
        "    trum-sym motor check my.toml",
        "    trum-sym evaluate --motor my.toml --prepressure 20 --load-torque '0.01 N m'",
        "",
        "`motor show FILE` lists every value with its source, `motor diff FILE FILE` what two motors differ in, and",
        "`motor schema > motor.schema.json` gives editors a JSON Schema to complete and check by (with Taplo or Even",
        "Better TOML: `#:schema ./motor.schema.json` in the file's first line).  `trum60` ships with the package.",
        "",
        'A parameter is a line, `radius = { value = 15, unit = "mm", source = "drawing" }`, with these keys:',
        "",
        "| key | what it says |",
        "|---|---|",
        *(f"| `{key}` | {said.replace('``', '`')} |" for key, said in _KEYS.items()),
        "",
        "`value`, `unit` and `source` are needed.  A file may have the tables",
        "",
        "| table | what it says |",
        "|---|---|",
        "| `[parameters]` | the parameters below |",
        "| `[box]` | ranges that searches vary: " + " and ".join(f"`{name}`" for name in BOX_NAMES) + ", each "
        "`{ range = [LOW, HIGH], unit = ..., source = ... }`; a motor without them is asked for ranges |",
        "| `[allowed]` | of the same, what the hardware can be set to; a search that goes beyond warns |",
        "| `[spreads]` | how far what drifts may be off, to either side: "
        + ", ".join(f"`{name}`" for name in SPREADING)
        + ", each `{ value = ..., unit = ..., source = ... }`, with `%` of its own value; what a point has to hold |",
        "| `[bench]` | the bench that the published figures were measured on: "
        + ", ".join(f"`{name}`" for name in BENCH)
        + ", each as a parameter |",
        "| `[[published]]` | figures to be shown beside the computed ones: `output`, `value`, `unit`, `source`, "
        "`drive`, and `sampling_period` where an encoder's |",
    ]
    for title, entries in _SECTIONS.items():
        lines += [
            "",
            f"## {title}",
            "",
            "| name | symbol | unit | allowed, in SI | what it is |",
            "|---|---|---|---|---|",
        ]
        for name, entry in entries.items():
            spec = SPECS[name]
            unit = "" if entry.unit == "1" else entry.unit
            lines.append(f"| `{name}` | {spec.symbol} | {unit} | {spec.domain.describe('1')} | {entry.meaning} |")
    return "\n".join([*lines, ""])


assert set(ENTRIES) == set(SPECS), "every parameter has a place in the template"
assert all(math.isfinite(float(parse_unit(entry.unit).to_si(1.0))) for entry in ENTRIES.values())
