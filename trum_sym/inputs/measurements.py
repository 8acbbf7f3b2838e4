"""Measured data: a CSV file whose headers carry units, read into columns in SI."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.carried import Labels, labels_of
from trum_sym.inputs.checks import Array, check_labels, quantity
from trum_sym.inputs.csv_text import plain_number, read_table
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import DRIVE_DOMAINS, LEAD
from trum_sym.inputs.units import Unit, parse_unit, unit_for
from trum_sym.quantities import QUANTITIES
from trum_sym.values import Value

__all__ = [
    "ADMITTANCE",
    "INPUTS",
    "SIGNALS",
    "UNCERTAINTY",
    "Measurements",
    "from_columns",
    "read_measurements",
    "table_of",
]

INPUTS = MappingProxyType({**DRIVE_DOMAINS, "phase_lead": (LEAD, "1")})
SIGNALS = ("displacement", "velocity", "envelope")  # of a decay, each against time
ADMITTANCE = ("conductance", "susceptance")  # of a sweep, against frequency
UNCERTAINTY = "_uncertainty"
_POLAR = {"admittance": "S", "phase": "rad"}  # the same as its size and angle

_POSITIVE = (
    "amplitude",
    "resonance_frequency",
    "drive_frequency",
    "cycle_time",
    "neutral_axis",
    "wavenumber",
    "envelope",
)


@dataclass(frozen=True, eq=False)
class Measurements(Value):
    """Columns of one length, in SI units, by name.

    Attributes
    ----------
    name : str
        What the data are called: the file's name, or what the caller says.
    columns : mapping of str to (n,) array
        Fields of the drive, figures of an operating point, time and a signal, or frequency, conductance and
        susceptance; ``NAME_uncertainty`` is the standard uncertainty of a figure, row by row.
    units : mapping of str to str
        The unit that each column was given in.
    synthetic : bool
        Whether the file says of itself that a model made it.
    """

    name: str
    columns: Mapping[str, Array]
    units: Mapping[str, str]
    synthetic: bool = False

    def __len__(self) -> int:
        return next(iter(self.columns.values())).size

    @property
    def label(self) -> str:
        """The name, and that it is synthetic if it is."""
        return f"{self.name} (synthetic)" if self.synthetic else self.name

    @property
    def is_decay(self) -> bool:
        """Whether these are vibrations against time."""
        return "time" in self.columns

    @property
    def is_sweep(self) -> bool:
        """Whether these are admittances against frequency."""
        return "frequency" in self.columns

    @property
    def abscissa(self) -> str | None:
        """``time`` of a decay, ``frequency`` of a sweep."""
        return "time" if self.is_decay else "frequency" if self.is_sweep else None

    @property
    def observed(self) -> tuple[str, ...]:
        """The measured columns: figures, the signal of a decay, conductance and susceptance of a sweep."""
        if self.is_sweep:
            return ADMITTANCE
        return tuple(n for n in self.columns if n in (*QUANTITIES, *SIGNALS))

    @property
    def inputs(self) -> tuple[str, ...]:
        """The columns that say how the motor was driven."""
        return tuple(n for n in self.columns if n in INPUTS)


def from_columns(name: str, columns: Mapping[str, object], units: Mapping[str, str], synthetic: bool) -> Measurements:
    """Check columns in SI units, or with units of their own: quantities, DataArrays with ``attrs["units"]``.

    Raises
    ------
    ParameterError
        For an unknown or missing column, a value that is not finite or outside its domain, or unequal lengths.
    """
    checked: dict[str, Array] = {}
    labels: dict[str, Labels | None] = {}
    units = dict(units)
    for column, values in columns.items():
        wanted, domain = _expected(column)
        found, given = quantity(column, values, domain, wanted)
        if given is not None:
            units[column] = given
        labels[column] = labels_of(found)
        array = np.atleast_1d(np.asarray(found))
        if array.ndim != 1:
            raise ParameterError(column, f"shape {array.shape}", "one row of numbers")
        checked[column] = array
    check_labels(labels)
    lengths = {column: array.size for column, array in checked.items()}
    for column, length in lengths.items():
        if length != next(iter(lengths.values())):
            first = next(iter(lengths))
            raise ParameterError(column, f"{length} rows", f"as many as {first}, {lengths[first]}")
    if "frequency" in checked:
        checked = _sweep(checked)
    data = Measurements(name, checked, units, synthetic)
    _check_columns(data)
    return data


def _sweep(columns: dict[str, Array]) -> dict[str, Array]:
    """The columns of an admittance sweep, as conductance and susceptance.

    Raises
    ------
    ParameterError
        Unless they are frequency and both parts of the admittance, or its size and phase, of frequencies that rise.
    """
    names = set(columns)
    needed = ({*ADMITTANCE}, {*_POLAR}, {*ADMITTANCE, *(name + UNCERTAINTY for name in ADMITTANCE)})
    if names - {"frequency"} not in needed:
        allowed = (
            f"frequency with {' and '.join(ADMITTANCE)} (both with {UNCERTAINTY} or neither), or {' and '.join(_POLAR)}"
        )
        raise ParameterError("data", " and ".join(sorted(names)), allowed)
    hertz = columns["frequency"]
    if np.any(np.diff(hertz) <= 0):
        row = int(np.argmax(np.diff(hertz) <= 0)) + 2
        raise ParameterError(f"frequency: row {row}", hertz[row - 1], "frequencies that rise from row to row")
    if "phase" not in columns:
        return columns
    size, angle = columns["admittance"], columns["phase"]
    return {"frequency": hertz, "conductance": size * np.cos(angle), "susceptance": size * np.sin(angle)}


def _expected(column: object) -> tuple[str | None, Domain]:
    """SI unit (None: the user's choice) and domain of a column."""
    if not isinstance(column, str):
        raise ParameterError("column", column, "names of columns as text")
    of = column.removesuffix(UNCERTAINTY)
    if of in QUANTITIES or of in SIGNALS:
        unit = QUANTITIES[of].unit if of in QUANTITIES else {"displacement": "m", "velocity": "m/s"}.get(of)
        return unit, Domain(low=0.0) if of != column or of in _POSITIVE else Domain()
    if column in INPUTS:
        domain, unit = INPUTS[column]
        return unit, domain
    if column == "time":
        return "s", Domain()
    if column == "frequency":
        return "Hz", Domain(low=0.0)
    if of in ADMITTANCE:
        return "S", Domain(low=0.0) if of != column else Domain()
    if column in _POLAR:
        return _POLAR[column], Domain(low=0.0) if column == "admittance" else Domain()
    known = (*INPUTS, *QUANTITIES, "time", *SIGNALS, "frequency", *ADMITTANCE, *_POLAR)
    from difflib import get_close_matches

    close = get_close_matches(column, known, n=3, cutoff=0.5)
    hint = f"; close names: {', '.join(close)}" if close else ""
    raise ParameterError(
        "column",
        column,
        f"a field of the drive, a figure of evaluate, time with a signal, or frequency with an admittance{hint}",
    )


def _check_columns(data: Measurements) -> None:
    """Whether the columns together make data that can be fitted."""
    names = set(data.columns)
    if data.is_sweep:
        return
    signals = names & set(SIGNALS)
    if data.is_decay:
        if len(signals) != 1:
            raise ParameterError("data", " and ".join(sorted(names)), f"time and one of {', '.join(SIGNALS)}")
        odd = sorted(names - {"time"} - signals)
        if odd:
            raise ParameterError(
                "column", odd[0], f"time and {signals.pop()} only: a decay record has no other columns"
            )
        if np.any(np.diff(data.columns["time"]) <= 0):
            row = int(np.argmax(np.diff(data.columns["time"]) <= 0)) + 2
            raise ParameterError(f"time: row {row}", data.columns["time"][row - 1], "times that rise from row to row")
        return
    if signals:
        raise ParameterError("data", f"{signals.pop()} without time", "a column time beside it")
    if not data.observed:
        raise ParameterError(
            "data", "no measured column", f"at least one of {', '.join(QUANTITIES)}, or time and a signal"
        )
    for column in names:
        of = column.removesuffix(UNCERTAINTY)
        if of != column and of not in names:
            raise ParameterError("column", column, f"a column {of} beside it")
    if len(data.observed) > 1:
        for column in data.observed:
            if column + UNCERTAINTY not in names:
                raise ParameterError(
                    "data",
                    " and ".join(data.observed),
                    f"one measured column, or a column {column}{UNCERTAINTY} to weigh it against the others",
                )


def read_measurements(source: str | PathLike[str]) -> Measurements:
    """Read a CSV file such as ``prepressure [N],amplitude [um]``.

    Lines that begin with ``#`` are comments; one that begins with ``# synthetic`` says that a model made the data.

    Raises
    ------
    ParameterError
        If the file cannot be read, a header has no known name or a wrong unit, or a cell is no finite number.
    """
    path = Path(source)
    found, units, comments = table_of(path, lambda name: _expected(name)[0])
    synthetic = any(comment.lstrip("# ").casefold().startswith("synthetic") for comment in comments)
    return from_columns(path.name, found, units, synthetic)


def table_of(path: Path, unit_of: Callable[[str], str | None]) -> tuple[dict[str, Array], dict[str, str], list[str]]:
    """Columns in SI, the unit each was given in, and the comments of a CSV file with units in its headers.

    Parameters
    ----------
    path, unit_of : Path, callable
        The file; the SI unit of a column by name, None if any will do; raises a ParameterError for a name that is none.
    """
    table = read_table("data", path)
    columns = [_header(cell, unit_of) for cell in table.header]
    names = [name for name, _, _ in columns]
    for place, name in enumerate(names):
        if name in names[:place]:
            raise ParameterError("column", name, "each column once")
    found: dict[str, list[float]] = {name: [] for name in names}
    for line, cells in table.rows():
        if len(cells) != len(names):
            allowed = f"{len(names)}, one for each column, written with {table.written}"
            raise ParameterError(f"data: line {line}", f"{len(cells)} cells", allowed)
        for (name, unit, given), cell in zip(columns, cells, strict=True):
            found[name].append(_cell(f"{name}: line {line}", cell, unit, given, table.written))
    if not found[names[0]]:
        raise ParameterError("data", f"{path.name} with a header and no rows", "at least one row of numbers")
    units = {name: given for name, _, given in columns}
    return {name: np.array(values) for name, values in found.items()}, units, table.comments


def _header(cell: str, unit_of: Callable[[str], str | None]) -> tuple[str, Unit, str]:
    """Name, unit and the unit's text of ``name [unit]``; a pure number needs no unit."""
    name, bracket, rest = (part.strip() for part in cell.partition("["))
    wanted = unit_of(name)
    if bracket and not rest.endswith("]"):
        raise ParameterError("column", cell, "a header such as prepressure [N]")
    if "[" in rest or "]" in rest[:-1]:
        raise ParameterError("column", cell, "one column: separate them with commas, semicolons or tabs")
    given = rest.removesuffix("]").strip() if bracket else ""
    if not given:
        if wanted != "1":
            raise ParameterError("column", cell, f"a unit in brackets: {name} [{wanted or 'm'}]")
        given = "1"
    allowed = f"a unit that converts to {wanted}" if wanted not in (None, "1") else "1, or a unit"
    try:
        unit = parse_unit(given) if wanted is None else unit_for(given, wanted)
    except ValueError as error:
        raise ParameterError(f"column {name}", given, f"{allowed} ({error})" if str(error) else allowed) from None
    return name, unit, given


def _cell(name: str, text: str, unit: Unit, given: str, written: str) -> float:
    allowed = f"a finite number in {given}" if given != "1" else "a finite number"
    number_given = plain_number(text)
    if number_given is None:
        raise ParameterError(name, text, f"{allowed}, written with {written}")
    value = unit.to_si(number_given)
    if not np.isfinite(value):
        raise ParameterError(name, text, allowed)
    return value
