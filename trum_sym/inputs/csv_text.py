"""CSV files as spreadsheets and instruments write them: encoding, separator and decimal mark found out, never guessed.

Columns are separated by commas, semicolons or tabs, whichever the header has, or as a first line ``sep=;`` says.
Numbers are written with the digits 0 to 9 and a point.  Where no comma separates, it may be the decimal mark, if the
file leaves no doubt that it is.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from trum_sym.errors import ParameterError
from trum_sym.inputs.reading import opened

__all__ = ["Table", "plain_number", "read_table", "read_text"]

_MAX_BYTES = 200_000_000
_MAX_COLUMNS = 1000
MAX_ROWS = 10_000_000
_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars"}

_PLAIN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?", re.I | re.ASCII)
_COMMA = re.compile(r"[+-]?\d*,\d+(?:e[+-]?\d+)?(?![\d,.])", re.I | re.ASCII)
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}(?![\d])", re.ASCII)  # may be a thousand and some
_POINT = re.compile(r"[+-]?\d*\.\d", re.ASCII)


def read_text(name: str, path: Path, what: str, limit: int = _MAX_BYTES) -> str:
    """The text of a file in UTF-8, without a byte order mark.

    Parameters
    ----------
    name, what : str
        For the errors: of the parameter, and of the file that is allowed.
    path : Path
        The file.
    limit : int
        Bytes that are read at most, whatever the file says that it has.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ParameterError
        If it cannot be read, is larger or not UTF-8.
    """
    try:
        with opened(path) as file:
            content = file.read(limit + 1)
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:  # ValueError: no path at all
        reason = error.strerror if isinstance(error, OSError) else "no path"
        raise ParameterError(name, str(path), f"a readable {what.removeprefix('a ')} ({reason})") from None
    if len(content) > limit:
        raise ParameterError(name, f"more than {limit} bytes", f"{what} of at most {limit} bytes")
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
        reason = "not UTF-8 text" + ("; this is UTF-16, save it as UTF-8" if wide else "")
        raise ParameterError(name, str(path), f"a readable {what.removeprefix('a ')} ({reason})") from None


@dataclass(frozen=True)
class Table:
    """A CSV file.

    Attributes
    ----------
    name : str
        What errors call it.
    path : Path
    text : str
    header : list of str
        Cells of the first row.
    comments : list of str
        Lines that begin with ``#``.
    separator, decimal : str
        Between columns, and in numbers.
    """

    name: str
    path: Path
    text: str
    header: list[str]
    comments: list[str]
    separator: str
    decimal: str

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Line numbers and cells behind the header; decimal commas are points."""
        rows = _rows(self.name, self.path, self.text, self.separator)
        next(rows)
        for count, (line, cells) in enumerate(rows):
            if count == MAX_ROWS:
                raise ParameterError(self.name, f"more than {MAX_ROWS} rows", f"at most {MAX_ROWS}")
            yield line, cells if self.decimal == "." else [_with_point(cell) for cell in cells]

    @property
    def written(self) -> str:
        """What to say of a cell that is no number."""
        if self.separator == ",":
            return "the digits 0 to 9 and a decimal point; decimal commas need semicolons or tabs between columns"
        return "the digits 0 to 9 and one decimal mark in the whole file"


def _with_point(cell: str) -> str:
    return cell.replace(",", ".") if _COMMA.match(cell.strip()) else cell


def plain_number(text: str) -> float | None:
    """The number that a text is; None for anything but ASCII digits, a point and an exponent, such as ``1_90``."""
    bare = text.strip()  # float() leaves separators such as \x1c on, which no tool shows
    return float(bare) if _PLAIN.fullmatch(bare) else None


def read_table(name: str, path: Path) -> Table:
    """Read a CSV file, and find out how it is written.

    Raises
    ------
    ParameterError
        If it cannot be read, has no rows or not one row a line, too many columns, or decimal marks that are open.
    """
    try:
        text = read_text(name, path, "a CSV file")
    except FileNotFoundError:
        raise ParameterError(name, str(path), "the path of a CSV file that exists") from None
    comments = [line for _, line in _lines(text) if line.startswith("#")]
    separator = _separator(name, text)
    rows = _rows(name, path, text, separator)
    _, header = next(rows, (0, []))
    if not header:
        raise ParameterError(name, str(path), "a CSV file with a header line such as prepressure [N],amplitude [um]")
    if len(header) > _MAX_COLUMNS:
        raise ParameterError(name, f"{len(header)} columns", f"at most {_MAX_COLUMNS}")
    return Table(name, path, text, header, comments, separator, _decimal(name, rows, text, separator))


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """Lines that are not blank, with their numbers; the one that says the separator is left out."""
    for number, line in enumerate(io.StringIO(text), 1):
        if line.strip() and not (number == 1 and _stated(line)):
            yield number, line.removesuffix("\n")


def _stated(line: str) -> str:
    """The separator that a line ``sep=;`` states, else nothing."""
    key, _, separator = line.removesuffix("\n").partition("=")
    return separator if key.strip().lower() == "sep" and len(separator) == 1 else ""


def _separator(name: str, text: str) -> str:
    stated = _stated(text.partition("\n")[0])
    if stated and stated not in _SEPARATORS:
        raise ParameterError(name, f"sep={stated}", f"columns separated by {', '.join(_SEPARATORS.values())}")
    header = next((line for _, line in _lines(text) if not line.startswith("#")), "")
    return stated or next((mark for mark in ("\t", ";") if mark in header), ",")


def _rows(name: str, path: Path, text: str, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Cells, and the line they stand in."""
    import csv

    number = 0

    def data() -> Iterator[str]:
        nonlocal number
        for place, line in _lines(text):
            number = place
            if not line.startswith("#"):
                yield line

    reader = csv.reader(data(), strict=True, delimiter=separator)
    count = 0
    try:
        for cells in reader:
            count += 1
            if reader.line_num != count:
                raise ParameterError(name, str(path), "a CSV file with one row a line")
            yield number, cells
    except csv.Error as error:
        raise ParameterError(name, str(path), f"a CSV file ({error})") from None


def _decimal(name: str, rows: Iterator[tuple[int, list[str]]], text: str, separator: str) -> str:
    """Whether numbers have decimal points or commas."""
    if separator == "," or "," not in text:
        return "."
    with_comma, proof, points = "", False, False
    for line, cells in rows:
        for cell in map(str.strip, cells):
            if _COMMA.match(cell):
                with_comma = with_comma or f"{cell} in line {line}"
                proof = proof or not _GROUPED.match(cell)
            else:
                points = points or bool(_POINT.match(cell))
    if not with_comma:
        return "."
    if points:
        raise ParameterError(name, with_comma, "decimal points or decimal commas, not both in one file")
    if not proof:
        raise ParameterError(name, with_comma, "a decimal point: with a comma and three digits it may be thousands")
    return ","
