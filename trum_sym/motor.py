"""The motor: a frozen set of parameters, each with its unit, symbol and source."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from importlib.resources import files
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.units import parse_quantity, parse_unit
from trum_sym.validate import ArrayLike, Domain, number

__all__ = ["Motor", "Parameter", "Published", "load_motor"]

_POSITIVE = Domain(low=0.0)
_NOT_NEGATIVE = Domain(low=0.0, low_open=False)
_COUNT = Domain(low=1, low_open=False, integer=True)
_POISSON = Domain(low=-1.0, high=0.5, high_open=False)
_REAL = Domain()


@dataclass(frozen=True)
class Parameter:
    """One value of a motor file.

    Attributes
    ----------
    value : float or ndarray
        In the SI unit ``unit``.
    unit : str
        SI unit; ``"1"`` for a pure number.
    symbol : str
        The symbol in the equations.
    source : str
        Where the value comes from: ``"Table 1"``, ``"measured ..."``, ``"assumed"``, ``"set"``, ...
    range : (float, float) or None
        For assumed values: what is plausible, in ``unit``.
    reason : str
        For assumed values: why this value and range.
    """

    value: ArrayLike
    unit: str
    symbol: str
    source: str
    range: tuple[float, float] | None = None
    reason: str = ""


@dataclass(frozen=True)
class _Spec:
    unit: str
    symbol: str
    domain: Domain
    required: bool


def _p(unit: str, symbol: str, domain: Domain = _POSITIVE) -> Any:
    return field(metadata={"spec": _Spec(unit, symbol, domain, required=True)})


def _optional(unit: str, symbol: str, domain: Domain = _POSITIVE) -> Any:
    return field(default=None, metadata={"spec": _Spec(unit, symbol, domain, required=False)})


@dataclass(frozen=True)
class Published:
    """A figure that a publication states for one drive, to be shown beside ours."""

    output: str
    value: float
    unit: str
    source: str
    drive: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Motor:
    """A travelling-wave rotary ultrasonic motor: every number with unit and source.

    The names are those of the motor file and of ``--set``.  The last five are optional: a measured
    value there replaces the modelled one.
    """

    name: str
    # Stator ring: metal beam with teeth
    radius: Parameter = _p("m", "R")
    tooth_count: Parameter = _p("1", "n_s", _COUNT)
    perimeter: Parameter = _p("m", "l_s")
    slot_width: Parameter = _p("m", "b_s")
    beam_width: Parameter = _p("m", "b_e")
    beam_thickness: Parameter = _p("m", "h_e")
    tooth_height: Parameter = _p("m", "h_t")
    beam_density: Parameter = _p("kg/m^3", "rho_e")
    beam_young_modulus: Parameter = _p("Pa", "E_e")
    beam_shear_modulus: Parameter = _p("Pa", "G_e")
    beam_poisson_ratio: Parameter = _p("1", "mu_e", _POISSON)
    # Piezoelectric ring
    piezo_width: Parameter = _p("m", "b_p")
    piezo_thickness: Parameter = _p("m", "h_p")
    piezo_density: Parameter = _p("kg/m^3", "rho_p")
    piezo_young_modulus: Parameter = _p("Pa", "E_p")
    piezo_shear_modulus: Parameter = _p("Pa", "G_p")
    piezo_poisson_ratio: Parameter = _p("1", "mu_p", _POISSON)
    piezo_strain_constant: Parameter = _p("C/N", "d_31", _REAL)
    piezo_compliance: Parameter = _p("m^2/N", "s_11E")
    voltage: Parameter = _p("V", "U_s")
    # Friction layer
    layer_width: Parameter = _p("m", "b_m")
    layer_thickness: Parameter = _p("m", "h_m")
    layer_density: Parameter = _p("kg/m^3", "rho_m")
    layer_young_modulus: Parameter = _p("Pa", "E_m")
    layer_poisson_ratio: Parameter = _p("1", "mu_m", _POISSON)
    # Vibration
    crests: Parameter = _p("1", "n_j", _COUNT)
    shear_correction: Parameter = _p("1", "kappa", Domain(low=0.0, high=1.0, high_open=False))
    damping_ratio: Parameter = _p("1", "xi", Domain(low=0.0, low_open=False, high=1.0))
    free_amplitude: Parameter = _p("m", "W_max")
    amplitude_factor: Parameter = _p("1", "C_f")
    amplitude_exponent: Parameter = _p("1", "varsigma", _NOT_NEGATIVE)
    fit_prepressure_min: Parameter = _p("N", "F_min")
    fit_prepressure_max: Parameter = _p("N", "F_max")
    # Contact and rotor
    friction_coefficient: Parameter = _p("1", "mu", _NOT_NEGATIVE)
    contact_radius: Parameter = _p("m", "r_c")
    curvature_radius: Parameter = _p("m", "r_t")
    rotor_inertia: Parameter = _p("kg*m^2", "J")
    # A measured value replaces the modelled one
    resonance_frequency: Parameter | None = _optional("Hz", "f_n")
    amplitude: Parameter | None = _optional("m", "W_maxf")
    neutral_axis: Parameter | None = _optional("m", "D")
    wavenumber: Parameter | None = _optional("1/m", "k_c")
    layer_stiffness: Parameter | None = _optional("N/m^2", "k_N")
    published: tuple[Published, ...] = ()

    def __post_init__(self) -> None:
        """Checks that no single value can fail: sizes that must fit each other."""
        _ordered(self, "tooth_height", "beam_thickness")
        _ordered(self, "fit_prepressure_min", "fit_prepressure_max")
        gaps = _value(self.tooth_count) * _value(self.slot_width)
        if _any(gaps >= _value(self.perimeter)):
            raise ParameterError("slot_width", self.slot_width.value, "slots that fit the perimeter: n_s b_s < l_s")

    def parameters(self) -> Iterator[tuple[str, Parameter]]:
        """The parameters that are set, by name."""
        for name in _SPECS:
            parameter = getattr(self, name)
            if parameter is not None:
                yield name, parameter

    def symbols(self) -> dict[str, ArrayLike]:
        """The values by the symbols of the equations, as the kernels name their arguments."""
        return {parameter.symbol: parameter.value for _, parameter in self.parameters()}

    def with_values(self, values: Mapping[str, float | ArrayLike | str], source: str = "set") -> Motor:
        """A motor with some values replaced; text may carry a unit, ``"26.5 mm"``.

        Parameters
        ----------
        values : mapping
            New values by parameter name; plain numbers are in the parameter's SI unit.
        source : str
            Recorded as the new values' source.

        Raises
        ------
        ParameterError
            For an unknown name, or a value outside the parameter's domain.
        """
        changed = {}
        for name, given in values.items():
            spec = _spec(name)
            value = parse_quantity(name, given, spec.unit) if isinstance(given, str) else given
            changed[name] = Parameter(number(name, value, spec.domain, spec.unit), spec.unit, spec.symbol, source)
        return replace(self, **changed)  # type: ignore[arg-type]


def _any(condition: object) -> bool:
    import numpy as np

    return bool(np.any(condition))  # type: ignore[arg-type]


def _value(parameter: Parameter) -> ArrayLike:
    return parameter.value


def _ordered(motor: Motor, low: str, high: str) -> None:
    small, large = getattr(motor, low), getattr(motor, high)
    if _any(small.value >= large.value):
        raise ParameterError(low, small.value, f"less than {high} ({large.value} {large.unit})")


_SPECS: Mapping[str, _Spec] = MappingProxyType(
    {f.name: f.metadata["spec"] for f in fields(Motor) if "spec" in f.metadata}
)


def _spec(name: str) -> _Spec:
    if name not in _SPECS:
        from difflib import get_close_matches

        close = get_close_matches(name, _SPECS, n=3, cutoff=0.5)
        hint = f"; close names: {', '.join(close)}" if close else ""
        raise ParameterError("motor parameter", name, f"a name of the motor file{hint}")
    return _SPECS[name]


def _read_parameter(name: str, entry: object) -> Parameter:
    spec = _spec(name)
    if not isinstance(entry, dict):
        raise ParameterError(name, entry, "a table with value, unit and source")
    unknown = sorted(set(entry) - {"value", "unit", "symbol", "source", "range", "reason", "note"})
    if unknown:
        raise ParameterError(f"{name}.{unknown[0]}", entry[unknown[0]], "value, unit, symbol, source, range, reason, note")
    for key in ("value", "unit", "source"):
        if key not in entry:
            raise ParameterError(f"{name}.{key}", "nothing", f"{key} in the motor file")
    for key in ("unit", "symbol", "source", "reason", "note"):
        if not isinstance(entry.get(key, ""), str):
            raise ParameterError(f"{name}.{key}", entry[key], "text")
    symbol, source, reason = entry.get("symbol", spec.symbol), entry["source"].strip(), entry.get("reason", "").strip()
    if symbol != spec.symbol:
        raise ParameterError(f"{name}.symbol", symbol, f"{spec.symbol}, the equations' symbol")
    if not source:
        raise ParameterError(f"{name}.source", "empty text", "where the value comes from")
    try:
        unit = parse_unit(entry["unit"])
    except ValueError as error:
        raise ParameterError(f"{name}.unit", entry["unit"], f"a unit that converts to {spec.unit} ({error})") from None
    if unit.dimension != parse_unit(spec.unit).dimension:
        raise ParameterError(f"{name}.unit", entry["unit"], f"a unit that converts to {spec.unit}")

    def si(label: str, raw: object) -> float:
        if isinstance(raw, bool) or not isinstance(raw, int | float):
            raise ParameterError(label, raw, f"a number in {entry['unit']}")
        return unit.to_si(raw)

    value = number(name, si(f"{name}.value", entry["value"]), spec.domain, spec.unit)
    limits = None
    if "range" in entry:
        raw = entry["range"]
        if not isinstance(raw, list) or len(raw) != 2:
            raise ParameterError(f"{name}.range", raw, "two numbers, low and high")
        low, high = (si(f"{name}.range", end) for end in raw)
        if not low <= value <= high:
            raise ParameterError(f"{name}.range", raw, "low <= value <= high")
        limits = (low, high)
    if source == "assumed" and (limits is None or not reason):
        raise ParameterError(name, "source = 'assumed'", "a range and a reason beside it")
    return Parameter(value, spec.unit, spec.symbol, source, limits, reason)


def _read_published(entry: object) -> Published:
    keys = {"output", "value", "unit", "source", "drive"}
    if not isinstance(entry, dict) or set(entry) != keys or not isinstance(entry["drive"], dict):
        raise ParameterError("published", entry, "tables with output, value, unit, source, drive")
    return Published(**{**entry, "drive": MappingProxyType(entry["drive"])})


def load_motor(source: str | PathLike[str] = "trum60") -> Motor:
    """Read a motor by name (``"trum60"`` ships with the package) or from a TOML file.

    Returns
    -------
    Motor
        Frozen; every value in SI with unit and source.

    Raises
    ------
    ParameterError
        If the file is missing, is not TOML, or an entry is unknown, incomplete, of a wrong unit or
        outside its domain.
    """
    if str(source) == "trum60":
        text = files("trum_sym").joinpath("data/trum60.toml").read_text("utf-8")
    else:
        path = Path(source)
        try:
            text = path.read_text("utf-8")
        except FileNotFoundError:
            raise ParameterError("motor", str(source), "trum60 or the path of a TOML file that exists") from None
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
            raise ParameterError("motor", str(source), f"a readable TOML file ({reason})") from None
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ParameterError("motor", str(source), f"a valid TOML file ({error})") from None
    unknown = sorted(set(data) - {"name", "parameters", "published"})
    if unknown:
        raise ParameterError("motor file", unknown[0], "name, parameters and published at the top level")
    if not isinstance(data.get("name"), str):
        raise ParameterError("motor file: name", data.get("name", "nothing"), "the motor's name as text")
    if not isinstance(data.get("parameters"), dict):
        raise ParameterError("motor file: parameters", "nothing", "a table [parameters]")
    if not isinstance(data.get("published", []), list):
        raise ParameterError("published", data["published"], "an array of tables [[published]]")
    parameters = {name: _read_parameter(name, entry) for name, entry in data["parameters"].items()}
    missing = [name for name, spec in _SPECS.items() if spec.required and name not in parameters]
    if missing:
        raise ParameterError("motor file: parameters", f"no {', '.join(missing)}", "every required parameter")
    published = tuple(_read_published(entry) for entry in data.get("published", []))
    return Motor(name=data["name"], published=published, **parameters)
