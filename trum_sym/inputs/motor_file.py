"""Motor files: TOML in, a checked :class:`~trum_sym.inputs.motor.Motor` out."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike, number
from trum_sym.inputs.choices import path_of
from trum_sym.inputs.csv_text import read_text
from trum_sym.inputs.distributions import Distribution, checked
from trum_sym.inputs.domain import Domain, Spec
from trum_sym.inputs.drive import BOX_NAMES, DRIVE_DOMAINS, SPREADING
from trum_sym.inputs.motor import SPECS, Allowed, Amount, Motor, Parameter, Published, spec
from trum_sym.inputs.units import Unit, parse_unit, unit_for
from trum_sym.quantities import QUANTITIES

__all__ = ["BENCH", "SHIPPED", "load_motor", "motor_of", "motor_text"]

SHIPPED = ("dual60", "ring60", "trum60")
"""Motors that ship with the package, by name."""

_KEYS = (
    "value",
    "unit",
    "symbol",
    "source",
    "range",
    "reason",
    "note",
    "interval",
    "data",
    "distribution",
    "mean",
    "standard_deviation",
)


BENCH: Mapping[str, Spec] = {
    **{
        name: Spec(DRIVE_DOMAINS[name][1], symbol, DRIVE_DOMAINS[name][0], required=False)
        for name, symbol in (("load_inertia", "J_load"), ("load_radius", "r_s"))
    },
    "sampling_period": Spec("s", "T_s", Domain(low=0.0), required=False),
    "encoder_counts": Spec("1", "N_e", Domain(low=1.0, low_open=False, integer=True), required=False),
}
"""What a motor file may say of the bench that its published figures were measured on: of the load and the encoder."""

_TABLES = ("name", "parameters", "bench", "box", "allowed", "spreads", "published")
_OF_AMOUNT = ("value", "unit", "source", "reason")
_MAX_BYTES = 1_000_000  # a motor takes 10 000
_NAMES = ", ".join(SHIPPED)
_MAX_DOTS = 200  # in a line
_MAX_PUBLISHED = 1000


def _unit(name: str, given: str, wanted: str) -> Unit:
    """The given unit, if it converts to the wanted one."""
    allowed = f"a unit that converts to {wanted}" if wanted != "1" else "1, or a unit that converts to a pure number"
    try:
        return unit_for(given, wanted)
    except ValueError as error:
        raise ParameterError(name, given, f"{allowed} ({error})" if str(error) else allowed) from None


def _in_si(name: str, raw: object, unit: Unit, given: str) -> float:
    allowed = f"a number in {given}" if given != "1" else "a number"
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        raise ParameterError(name, raw, allowed)
    try:
        return unit.to_si(float(raw))
    except OverflowError:
        raise ParameterError(name, raw, allowed) from None


def _read_parameter(name: str, entry: object, wanted: Spec) -> Parameter:
    if not isinstance(entry, dict):
        raise ParameterError(name, entry, "a table with value, unit and source")
    unknown = sorted(set(entry) - set(_KEYS))
    if unknown:
        raise ParameterError(name, unknown[0], f"no other keys than {', '.join(_KEYS)}")
    for key in ("value", "unit", "source"):
        if key not in entry:
            raise ParameterError(f"{name}.{key}", "nothing", f"{key} in the motor file")
    for key in ("unit", "symbol", "source", "reason", "data", "note"):
        if not isinstance(entry.get(key, ""), str):
            raise ParameterError(f"{name}.{key}", entry[key], "text")
    symbol, source, reason = (
        entry.get("symbol", wanted.symbol),
        entry["source"].strip(),
        entry.get("reason", "").strip(),
    )
    if symbol != wanted.symbol:
        raise ParameterError(f"{name}.symbol", symbol, f"{wanted.symbol}, the equations' symbol")
    if not source:
        raise ParameterError(f"{name}.source", source, "where the value comes from")
    unit = _unit(f"{name}.unit", entry["unit"], wanted.unit)
    si = _in_si(f"{name}.value", entry["value"], unit, entry["unit"])
    value = number(name, si, wanted.domain, wanted.unit)
    limits = _read_ends(f"{name}.range", entry.get("range"), value, unit, entry["unit"])
    interval = _read_ends(f"{name}.interval", entry.get("interval"), value, unit, entry["unit"])
    data = entry.get("data", "").strip()
    if source.casefold() == "assumed" and (limits is None or not reason):
        raise ParameterError(name, "source = 'assumed'", "a range and a reason beside it")
    if source.casefold() == "calibrated" and (interval is None or not data):
        raise ParameterError(name, "source = 'calibrated'", "an interval and data, the name of the data, beside it")
    moments = {
        key: _in_si(f"{name}.{key}", entry[key], unit, entry["unit"])
        for key in ("mean", "standard_deviation")
        if key in entry
    }
    distribution = _read_distribution(name, entry.get("distribution"), float(value), limits, moments, wanted)
    return Parameter(value, wanted.unit, wanted.symbol, source, limits, reason, interval, data, distribution)


def _read_ends(name: str, raw: object, value: ArrayLike, unit: Unit, given: str) -> tuple[float, float] | None:
    """Two numbers around a value, in SI."""
    if raw is None:
        return None
    if not isinstance(raw, list) or len(raw) != 2:
        raise ParameterError(name, raw, "two numbers, low and high")
    low, high = (_in_si(name, end, unit, given) for end in raw)
    if not -float("inf") < low <= value <= high < float("inf"):
        raise ParameterError(name, raw, "finite numbers with low <= value <= high")
    return low, high


def _read_distribution(
    name: str,
    kind: object,
    value: float,
    limits: tuple[float, float] | None,
    moments: dict[str, float],
    wanted: Spec,
) -> Distribution | None:
    """What is said beyond the range.

    A triangular distribution has its peak at the value, a normal or lognormal one its mean unless another is given;
    without a standard deviation, the range reaches two of them to either side of its middle.
    """
    if kind is None:
        if moments:
            raise ParameterError(
                f"{name}.{next(iter(moments))}", "no distribution", "distribution = 'normal' beside it"
            )
        return None
    if not isinstance(kind, str):
        raise ParameterError(f"{name}.distribution", kind, "text")
    if kind in ("uniform", "triangular") and moments:
        raise ParameterError(f"{name}.{next(iter(moments))}", f"a {kind} distribution", "a range only")
    if limits is None and "standard_deviation" not in moments:
        raise ParameterError(f"{name}.distribution", kind, "a range or, if normal, a standard_deviation beside it")
    low, high = limits or (-float("inf"), float("inf"))
    if kind in ("uniform", "triangular"):
        distribution = Distribution(kind, low, high, mode=value if kind == "triangular" else None)
    else:
        deviation = moments.get("standard_deviation", (high - low) / 4)
        distribution = Distribution(kind, low, high, moments.get("mean", value), deviation)
    checked(name, distribution, wanted)
    return distribution


def _read_bench(table: object) -> dict[str, Parameter]:
    if not isinstance(table, dict):
        raise ParameterError("motor file: bench", table, "a table [bench]")
    for name in table:
        if name not in BENCH:
            raise ParameterError("bench", name, f"one of {', '.join(BENCH)}")
    return {name: _read_parameter(name, entry, BENCH[name]) for name, entry in table.items()}


def _read_published(entry: object) -> Published:
    keys = {"output", "value", "unit", "source", "drive"}
    if not isinstance(entry, dict) or set(entry) - {"sampling_period"} != keys or not isinstance(entry["drive"], dict):
        raise ParameterError(
            "published", entry, "tables with output, value, unit, source and a table drive, and maybe sampling_period"
        )
    for key in ("output", "unit", "source"):
        if not isinstance(entry[key], str):
            raise ParameterError(f"published.{key}", entry[key], "text")
    if entry["output"] not in QUANTITIES:
        raise ParameterError("published.output", entry["output"], f"one of {', '.join(QUANTITIES)}")
    unit = _unit("published.unit", entry["unit"], QUANTITIES[entry["output"]].unit)
    number("published.value", _in_si("published.value", entry["value"], unit, entry["unit"]), Domain(), entry["unit"])
    for name, value in entry["drive"].items():
        if name not in DRIVE_DOMAINS:
            raise ParameterError("published.drive", name, f"one of {', '.join(DRIVE_DOMAINS)}")
        domain, drive_unit = DRIVE_DOMAINS[name]
        bare = _in_si(f"published.drive.{name}", value, parse_unit(drive_unit), drive_unit)
        number(f"published.drive.{name}", bare, domain, drive_unit)
    if "sampling_period" in entry:
        period = _in_si("published.sampling_period", entry["sampling_period"], parse_unit("s"), "s")
        number("published.sampling_period", period, Domain(low=0.0), "s")
    return Published(**entry)


def _table(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """A table that a motor file may have."""
    found = data.get(name, {})
    if not isinstance(found, dict):
        raise ParameterError(name, found, f"a table [{name}]")
    return found


def _read_amount(name: str, entry: object) -> Amount:
    """How far an input may be off, of the table [spreads]."""
    place = f"spreads.{name}"
    if name not in SPREADING:
        raise ParameterError("motor file: spreads", name, f"one of {', '.join(SPREADING)}")
    if not isinstance(entry, dict) or not {"value", "unit", "source"} <= set(entry) <= {*_OF_AMOUNT}:
        raise ParameterError(place, entry, "a table with value, unit and source, and maybe a reason")
    for key in ("unit", "source", "reason"):
        if not isinstance(entry.get(key, "text"), str) or not entry.get(key, "text").strip():
            raise ParameterError(f"{place}.{key}", entry[key], "text")
    share = entry["unit"].strip() == "%"
    wanted = "1" if share else DRIVE_DOMAINS[name][1] if name in DRIVE_DOMAINS else SPECS[name].unit
    value = _in_si(f"{place}.value", entry["value"], _unit(f"{place}.unit", entry["unit"], wanted), entry["unit"])
    number(f"{place}.value", value, Domain(low=0.0), wanted)
    if entry["source"].strip().casefold() == "assumed" and "reason" not in entry:
        raise ParameterError(place, "source = 'assumed'", "a reason beside it")
    return Amount(value, share, entry["source"].strip())


def _read_allowed(table: str, name: str, entry: object) -> Allowed:
    """A range of the tables [box] and [allowed]."""
    place = f"{table}.{name}"
    if name not in BOX_NAMES:
        raise ParameterError(table, name, f"one of {', '.join(BOX_NAMES)}")
    if not isinstance(entry, dict) or set(entry) != {"range", "unit", "source"}:
        raise ParameterError(place, entry, "a table with range, unit and source")
    if not isinstance(entry["unit"], str) or not isinstance(entry["source"], str) or not entry["source"].strip():
        raise ParameterError(place, entry, "unit and source as text")
    domain, wanted = DRIVE_DOMAINS[name]
    unit, ends = _unit(f"{place}.unit", entry["unit"], wanted), entry["range"]
    if not isinstance(ends, list) or len(ends) != 2:
        raise ParameterError(f"{place}.range", ends, "two numbers, low and high")
    low, high = (
        float(number(f"{place}.range", _in_si(place, end, unit, entry["unit"]), domain, wanted)) for end in ends
    )
    if not low < high:
        raise ParameterError(f"{place}.range", ends, "low < high")
    return Allowed(low, high, entry["source"].strip())


def motor_text(source: str | PathLike[str]) -> str:
    """The text of a motor file, by name or path."""
    path = Path(__file__).parents[1] / "data" / f"{source}.toml" if str(source) in SHIPPED else Path(source)
    try:
        return read_text("motor", path, "a TOML file", _MAX_BYTES)
    except FileNotFoundError:
        raise ParameterError("motor", str(source), f"{_NAMES} or the path of a TOML file that exists") from None


def _read_toml(source: str | PathLike[str], text: str) -> dict[str, Any]:
    dots = max((line.count(".") for line in text.splitlines()), default=0)
    if dots > _MAX_DOTS:  # of a key that is nested without end tomllib takes minutes
        raise ParameterError("motor", str(source), f"a TOML file with at most {_MAX_DOTS} points in a line, not {dots}")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ParameterError("motor", str(source), f"a valid TOML file ({error})") from None


def load_motor(source: str | PathLike[str] = "trum60") -> Motor:
    """Read a motor by name or from a TOML file.

    Parameters
    ----------
    source : str or path
        ``"trum60"`` (the paper's motor, Table 1), ``"dual60"`` or ``"ring60"``, which come with the package, or the
        path of a motor file (docs/motor-file.md).

    Returns
    -------
    Motor
        Frozen; every value in SI with unit and source.

    Raises
    ------
    ParameterError
        If the file is missing, is not TOML, or an entry is unknown, incomplete, of a wrong unit or
        outside its domain.

    Examples
    --------
    >>> import trum_sym as ts
    >>> motor = ts.load_motor("trum60")
    >>> motor.radius.value, motor.radius.unit, motor.radius.source
    (0.03, 'm', 'Table 1')
    """
    path_of("motor", source, f"{_NAMES} or the path of a TOML file")
    return motor_of(source, motor_text(source))


def motor_of(source: str | PathLike[str], text: str) -> Motor:
    """The motor that a motor file's text states; ``source`` is what errors call it."""
    data = _read_toml(source, text)
    unknown = sorted(set(data) - set(_TABLES))
    if unknown:
        raise ParameterError("motor file", unknown[0], f"{', '.join(_TABLES[:-1])} and {_TABLES[-1]} at the top level")
    if not isinstance(data.get("name"), str) or not data["name"].strip():
        raise ParameterError("motor file: name", data.get("name", "nothing"), "the motor's name as text")
    if not isinstance(data.get("parameters"), dict):
        raise ParameterError("motor file: parameters", data.get("parameters", "nothing"), "a table [parameters]")
    if not isinstance(data.get("published", []), list) or len(data.get("published", [])) > _MAX_PUBLISHED:
        raise ParameterError("published", data["published"], f"up to {_MAX_PUBLISHED} tables [[published]]")
    parameters = {name: _read_parameter(name, entry, spec(name)) for name, entry in data["parameters"].items()}
    missing = [name for name, wanted in SPECS.items() if wanted.required and name not in parameters]
    if missing:
        raise ParameterError("motor file: parameters", f"no {', '.join(missing)}", "every required parameter")
    published = tuple(_read_published(entry) for entry in data.get("published", []))
    box, allowed = (
        {name: _read_allowed(table, name, entry) for name, entry in _table(data, table).items()}
        for table in ("box", "allowed")
    )
    spreads = {name: _read_amount(name, entry) for name, entry in _table(data, "spreads").items()}
    read: dict[str, Any] = {**parameters, "bench": _read_bench(data.get("bench", {})), "box": box, "allowed": allowed}
    return Motor(name=data["name"], published=published, spreads=spreads, text=text, **read)
