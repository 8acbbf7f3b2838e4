"""The second transcription of the paper's equations, and its comparison with the first, tree by tree.

The first one is what the entries print (``Entry.printed``).  The second one lies in ``transcription/*.toml``: per
entry how sure the copy of the paper's text is, and per quoted line its number, the line itself with its checksum,
and what it says in the notation of :mod:`derivations.ledger.notation`.  It was made from the text alone.

Three things are compared: the quote with its checksum, the quote with the notation (letters, numbers and signs in
reading order), and the notation with the first transcription (the same tree, term by term, the order of sums and
products aside; nothing is simplified, expanded or evaluated at numbers).  What lies between the print and the
ledger's symbols are *readings*, and they are stated in the data: ``names`` (a letter that stands for another of the
nomenclature), ``put`` (a name replaced by its definition elsewhere), ``as`` (the form's name in the ledger).
"""

from __future__ import annotations

import re
import tomllib
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import cache
from itertools import zip_longest
from pathlib import Path
from typing import Any, Literal

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from derivations.ledger.model import Entry, Forms
from derivations.ledger.notation import (
    Line,
    NotationError,
    atoms_of_notation,
    atoms_of_tex,
    condition,
    expression,
    lines,
)
from derivations.nomenclature import NOMENCLATURE

__all__ = ["Copy", "checksum", "copy_of", "differences", "load", "mends", "other_readings", "read", "second"]

FOLDER = Path(__file__).parent / "transcription"
Data = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True)
class Copy:
    """How sure the copy of the paper's text is: in a word, and what could be lost in it ('' if nothing)."""

    word: Literal["clear", "doubtful", "missing"]
    doubt: str
    lines: tuple[int, ...]


def copy_of(entry: Entry) -> Copy:
    """How sure the copy of an entry's text is; ``missing`` where there is no text to copy."""
    block = load().get(entry.id)
    if block is None:
        return Copy("clear" if entry.printed else "missing", "", ())
    word, _, doubt = block["copy"].partition(": ")
    if word not in ("clear", "doubtful") or bool(doubt) != (word == "doubtful"):
        raise NotationError(f"({entry.id}) copy is {block['copy']!r}; clear, or doubtful: what could be lost")
    return Copy(word, doubt, tuple(quote["line"] for quote in block["quote"]))


def other_readings(entry: Entry) -> Iterator[tuple[str, Forms]]:
    """What a doubtful copy may have lost, put back: what is read, and the printed forms then."""
    for other in load().get(entry.id, {}).get("otherwise", ()):
        yield other["what"], second(entry.id, _changed(entry.id, other))


def mends(entry: Entry) -> Iterator[tuple[int, Forms]]:
    """The print with signs of it changed: how many in the row where most are, and the forms then."""
    block = load().get(entry.id, {})
    for other in (*block.get("mend", ()), *block.get("otherwise", ())):
        data = _changed(entry.id, other)
        names = (entry.id, *other.get("also", ()))
        most = max(_signs_changed(load()[name], data[name]) for name in names)
        yield most, second(entry.id, data)


def _changed(name: str, other: Mapping[str, Any]) -> Data:
    """The transcription with some text of an entry replaced, and of those that it names."""
    data: dict[str, Any] = {key: dict(block) for key, block in load().items()}
    if "as" in other:
        data[name]["as"] = other["as"]
    for old, new in other["replace"]:
        found = 0
        for place in (name, *other.get("also", ())):
            quotes = [dict(quote) for quote in data[place]["quote"]]
            for quote in quotes:
                found += quote.get("forms", "").count(old)
                quote["forms"] = quote.get("forms", "").replace(old, new)
            data[place]["quote"] = quotes
        if not found:
            raise NotationError(f"({name}) {old!r} is not there")
    return data


def _signs_changed(block: Mapping[str, Any], other: Mapping[str, Any]) -> int:
    """Letters, numbers, signs and bars that differ, in the row where most do; a row that is lost counts whole."""
    most = 0
    for before, after in zip(block["quote"], other["quote"], strict=True):
        rows, new = (_lines_of(quote) for quote in (before, after))
        for _, low, high, first, last in SequenceMatcher(a=rows, b=new, autojunk=False).get_opcodes():
            for old, row in zip_longest(rows[low:high], new[first:last], fillvalue=()):
                most = max(most, _edits(list(old), list(row)))
    return most


def _lines_of(quote: Mapping[str, Any]) -> list[tuple[str, ...]]:
    return [tuple(atoms_of_notation(line, bars=True)) for line in quote.get("forms", "").splitlines()]


def _edits(old: list[str], new: list[str]) -> int:
    codes = SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
    return sum(max(high - low, last - first) for tag, low, high, first, last in codes if tag != "equal")


def checksum(text: str) -> str:
    """The checksum of a quoted line, eight hexadecimal digits."""
    return f"{zlib.crc32(text.encode()):08x}"


def read(text: str) -> Data:
    """One file of the transcription; a NotationError where it is no TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise NotationError(f"no TOML: {error}") from error


@cache
def load() -> Data:
    """The whole second transcription by the ledger's ids."""
    found: dict[str, Mapping[str, Any]] = {}
    for path in sorted(FOLDER.glob("*.toml")):
        for name, block in read(path.read_text("utf-8")).items():
            if name in found:
                raise NotationError(f"{name} is transcribed twice")
            found[name] = block
    return found


# --- names --------------------------------------------------------------------------------------------------
_EVERYWHERE = {"T_Qall": "T", "s_11_E": "s_11E"}
_ARGUMENTS = {(), ("t",), ("x", "t")}
_SAMPLES = {"v_1": 1, "v_2": 2, "v_i": sp.Symbol("i", integer=True, positive=True)}
_DOTS = sp.Symbol("dots")
_OF_TIME = {"xi_z", "xi_x", "phi_q"}  # of Appendix A, whose place is held


def _name(name: str, block: Mapping[str, Any]) -> str:
    return str({**_EVERYWHERE, **block.get("names", {})}.get(name, name))


def _resolver(block: Mapping[str, Any], data: Data) -> Callable[[str, tuple[sp.Expr, ...]], sp.Expr]:
    """What a printed name stands for in an entry: a symbol or function of the nomenclature, or what is put for it."""
    put: Mapping[str, str] = block.get("put", {})
    units = _units() if block.get("table") else {}

    def resolve(name: str, arguments: tuple[sp.Expr, ...]) -> sp.Expr:
        shown = tuple(str(a) for a in arguments)
        if name in units:
            return units[name]
        if name in put and shown not in ((), ("t",)):
            return _definition(name, data[put[name]], data)
        if name in _SAMPLES:
            return sp.IndexedBase("v", real=True)[_SAMPLES[name]]
        if name == "dots":
            return _DOTS
        if name == "v_xx" and shown == ("x_max", "t"):
            name, shown = "v_xmax", ()
        read_as = _name(name, block)
        if " " in read_as or "/" in read_as:  # an expression of the nomenclature
            return expression(read_as, lambda inner, _: NOMENCLATURE[inner].symbol)
        if read_as in _OF_TIME:
            return sp.Function(read_as, real=True)(arguments[-1])
        if name in block.get("functions", ()):
            return sp.Function(read_as)(*arguments)
        return _symbol(name, read_as, shown)

    return resolve


def _symbol(name: str, read_as: str, shown: tuple[str, ...]) -> sp.Expr:
    """The nomenclature's symbol, or one of that name, with the arguments that the text shows."""
    symbol = NOMENCLATURE[read_as].symbol if read_as in NOMENCLATURE else sp.Symbol(read_as)
    if isinstance(symbol, AppliedUndef):
        allowed = not shown or shown in (tuple(str(a) for a in symbol.args), ("x", "t"))
    else:
        allowed = shown in _ARGUMENTS
    if not allowed:
        raise NotationError(f"{name} of {', '.join(shown)}")
    return symbol


def _units() -> dict[str, sp.Expr]:
    """The units that the tables print."""
    from derivations.ledger.table_1 import UNITS

    found: dict[str, sp.Expr] = {str(symbol)[len(r"\mathrm{") : -1]: symbol for symbol in UNITS}
    return found | {"mm": found["m"] / 1000, "GPa": found["Pa"] * 10**9}


def _definition(name: str, block: Mapping[str, Any], data: Data) -> sp.Expr:
    """The right side that a name has in an entry."""
    for quote in block["quote"]:
        for line in lines(quote["forms"]):
            if re.match(rf"{name}\(", line.sides[0]):
                return expression(line.sides[-1], _resolver(block, data))
    raise NotationError(f"{name} is not defined there")


# --- from lines to forms ------------------------------------------------------------------------------------
REGIONS = {("t_1", "t_2"): "redu", ("t_2", "t_3"): "addredu", ("t_3", "t_4"): "add"}
_INTERVAL = re.compile(r"t in \[(t_\d), (t_\d)\]")


def _interval(text: str) -> tuple[str, str] | None:
    found = _INTERVAL.fullmatch(text)
    return (found[1], found[2]) if found else None


@dataclass(frozen=True)
class _Row:
    """A printed right side under the name of its form."""

    name: str
    left: str
    value: sp.Basic
    condition: str


def _rows(block: Mapping[str, Any], data: Data) -> Iterator[_Row]:
    """Every printed right side of an entry; of a chain of equalities the last one, or those that are named."""
    resolve = _resolver(block, data)
    named: dict[str, str] = block.get("as", {})
    for quote in block["quote"]:
        for line in lines(quote.get("forms", "")):
            if line.sides[0].partition("(")[0] not in _of_its_own(block):
                yield from _of_line(line, named, block, resolve)


def _of_its_own(block: Mapping[str, Any]) -> Mapping[str, str]:
    """Names that are defined in the entry only to be put into its other lines."""
    return {name: "" for name in block.get("put", {}) if name in ("f", "z")}


def _of_line(
    line: Line, named: Mapping[str, str], block: Mapping[str, Any], resolve: Callable[..., sp.Expr]
) -> Iterator[_Row]:
    left, *rights = line.sides
    bare = re.sub(r"\([xt, ]*\)$", "", left)
    names = named.get(left, _name(bare, block)).split(", ")
    if not rights:
        if ">>" in left:
            sides = [expression(side.strip(), resolve) for side in left.split(">>")]
            yield _Row(names[0], "", sp.Gt(*sides), line.condition)
        elif line.condition:  # of all rows above
            yield _Row("", left, sp.S.Zero, line.condition)
        else:
            raise NotationError(f"a line without an equality: {left}")
        return
    for name, right in zip(names, rights[-len(names) :], strict=True):
        if name.startswith("="):
            yield _Row(name[1:], left, sp.Eq(expression(left, resolve), _right(right, resolve)), line.condition)
        else:
            yield _Row(name, left, _right(right, resolve), line.condition)


def _right(text: str, resolve: Callable[..., sp.Expr]) -> sp.Basic:
    value = expression(text.removesuffix(" > 0"), resolve)
    return value if not value.has(_DOTS) else value.replace(lambda e: e.is_Add and e.has(_DOTS), _all_samples)


def _all_samples(total: sp.Add) -> sp.Sum:
    """f(v_1) + f(v_2) + dots + f(v_i): the sum over all samples."""
    v, i = sp.IndexedBase("v", real=True), _SAMPLES["v_i"]
    (last,) = (term for term in total.args if term.has(v[i]))
    if {last.xreplace({v[i]: v[1]}), last.xreplace({v[i]: v[2]}), last, _DOTS} != set(total.args):
        raise NotationError(f"no sum over samples: {total}")
    return sp.Sum(last, (i, 1, NOMENCLATURE["I"].symbol))


def second(name: str, data: Data | None = None) -> dict[str, sp.Basic]:
    """The forms of an entry by the second transcription, under the names that the ledger gives them."""
    data = load() if data is None else data
    block = data[name]
    rows: dict[str, list[tuple[sp.Basic, str]]] = {}
    for row in _rows(block, data):
        if row.name:
            rows.setdefault(row.name, []).append((row.value, row.condition))
        elif _interval(row.condition) != ("t_1", "t_4"):
            raise NotationError(f"({name}) a condition of all rows: {row.condition}")
    resolve = _resolver(block, data)
    return _of_24(rows, resolve, data) if name == "24" else _FINISH.get(name, _plain)(rows, resolve)


_Rows = Mapping[str, list[tuple[sp.Basic, str]]]
_Resolve = Callable[[str, tuple[sp.Expr, ...]], sp.Expr]


def _piecewise(rows: list[tuple[sp.Basic, str]], resolve: _Resolve) -> sp.Piecewise:
    """Rows with their conditions; a row that is printed again word for word counts once."""
    pairs = dict.fromkeys((value, condition(text, resolve)) for value, text in rows)
    return sp.Piecewise(*pairs, evaluate=False)


def _fits(name: str, text: str) -> bool:
    """Whether a condition says no more than the form's name: the whole cycle, or the region that ends the name."""
    interval = _interval(text)
    return interval == ("t_1", "t_4") or (interval in REGIONS and re.split("_", name)[-1] == REGIONS[interval])


def _plain(rows: _Rows, resolve: _Resolve) -> dict[str, sp.Basic]:
    found: dict[str, sp.Basic] = {}
    for name, of_name in rows.items():
        ((value, text), *more) = of_name
        always = not text or _fits(name, text) or condition(text, resolve) == sp.true
        found[name] = value if always and not more else _piecewise(of_name, resolve)
    return found


def _by_region(rows: _Rows, _: _Resolve) -> dict[str, sp.Basic]:
    """(18), (19): the ledger names the rows by their regions."""
    (of_name,) = rows.values()
    return {REGIONS[_interval(text) or ("", "")]: value for value, text in of_name}


_PER_W = {NOMENCLATURE[f"M_{s}"].symbol: NOMENCLATURE[f"N_{s}"].symbol for s in "ab"}


def _of_17(rows: _Rows, resolve: _Resolve) -> dict[str, sp.Basic]:
    """In T_redu M_a and M_b are printed without W_maxf: the ledger calls them N_a and N_b there."""
    amplitude = [(v.xreplace(_PER_W) if _interval(c) == ("t_1", "t_2") else v, c) for v, c in rows["A_v"]]
    return {"A_v": _piecewise(amplitude, resolve), "Psi_v": _piecewise(rows["Psi_v"], resolve)}


def _of_34(rows: _Rows, resolve: _Resolve) -> dict[str, sp.Basic]:
    """The same in (34), whose rows hold in all regions."""
    form = _piecewise(rows["x_px"], resolve)
    return {"x_px_redu": form.xreplace(_PER_W), "x_px": form, "lambda": rows["lambda"][0][0]}


def _of_33(rows: _Rows, _: _Resolve) -> dict[str, sp.Basic]:
    """Both rows have the same left side; the ledger counts them."""
    if rows["row"][-1][1] != "t in [t_1, t_4]":
        raise NotationError("(33) the condition of both rows")
    return {f"row {number}": value for number, (value, _) in enumerate(rows["row"], 1)}


def _of_23(rows: _Rows, _: _Resolve) -> dict[str, sp.Basic]:
    """Rows of T_redu, whose P are printed without W_maxf, apart from the others; equal rows once."""
    found: dict[str, sp.Basic] = {}
    for name, of_name in rows.items():
        for value, text in of_name:
            interval = _interval(text)
            region = REGIONS[interval] if interval else ""
            key = f"{name}_redu" if name.endswith("_ell") and region == "redu" else name
            if name in ("p_B", "P_B") and region in ("addredu", "add"):
                key = f"P_B_{region}"
            if found.setdefault(key, value) != value:
                raise NotationError(f"(23) {name} has two values")
    return found


def _of_q_t(rows: _Rows, resolve: _Resolve) -> dict[str, sp.Basic]:
    """The parts of Q, each 0 where its row does not hold."""
    return {
        f"Q_{value.func.__name__}": sp.Piecewise((value.args[0], condition(text, resolve)), (0, True))
        for value, text in rows["Q"]
    }


def _totals(rows: _Rows, resolve: _Resolve) -> dict[str, sp.Basic]:
    """(43), (44), (A14) to (A16): the sums of Q's parts by their symbols."""
    Q, t, T = (NOMENCLATURE[name].symbol for name in ("Q_q", "t", "T"))
    put = {}
    for sign in ("plus", "minus"):
        for power, letter in ((1, "q"), (2, "p")):
            for end in (T, sp.Symbol(f"T_Q{sign}")):
                part = sp.Abs(sp.Function(sign)(Q)) ** power
                put[sp.Function("total")(part, t, sp.S.Zero, end)] = NOMENCLATURE[f"{letter}_{sign}"].symbol
    return {name: value.xreplace(put) for name, value in _plain(rows, resolve).items()}


_OF_REGION = {
    "redu": (("omega_n", "omega_q"), 0),
    "addredu": (("mean", "omega_n"), 1),
    "add": (("mean", "mean"), 2),
}


def _of_24(rows: _Rows, resolve: _Resolve, data: Data) -> dict[str, sp.Basic]:
    """The general row with the amplitudes and angles of each region, and the frequencies of (9) and (10) there."""
    names = ("omega_n", "omega_q", "omega_a", "omega_b", "W_a", "W_b", "Delta_omega", "t_Q", "Delta_omega_add")
    s = {name: NOMENCLATURE[name].symbol for name in names}
    s["mean"] = (s["omega_n"] + s["omega_q"]) / 2
    turn = sp.Symbol("Delta_varphi_Q")
    fourteen = second("14", data)
    (general, _), *named = rows["Q_q"]
    if [(str(value), REGIONS[_interval(text) or ("", "")]) for value, text in named] != [
        (f"Q_{region}", region) for region in _OF_REGION
    ]:
        raise NotationError("(24) the determinant's three names")
    found = []
    for region, (rates, index) in _OF_REGION.items():
        span = next(key for key, value in REGIONS.items() if value == region)
        drift = _row_in(fourteen["Delta_omega"], span)
        drift = s["Delta_omega_add"] if drift is None else drift
        values = {
            s["W_a"]: _covering(rows["W_a"], span),
            s["W_b"]: _covering(rows["W_b"], span),
            s["omega_a"]: s[rates[0]],
            s["omega_b"]: s[rates[1]],
            s["Delta_omega"]: drift,
            s["t_Q"]: _row_in(fourteen["t_Q"], span),
            turn: rows["Delta_varphi_Q"][index][0],
        }
        if _interval(rows["Delta_varphi_Q"][index][1]) != span:
            raise NotationError("(24) the angle's rows")
        (wave,) = general.atoms(sp.sin)
        angle = wave.args[0].xreplace(values)
        rest = (general / wave).xreplace(values)
        found.append((rest * sp.sin(angle, evaluate=False), f"t in [{span[0]}, {span[1]}]"))
    return {"Q_q": _piecewise(found, resolve)}


def _row_in(form: sp.Piecewise, span: tuple[str, str]) -> sp.Basic | None:
    wanted = condition(f"t in [{span[0]}, {span[1]}]", lambda name, _: NOMENCLATURE[name].symbol)
    return next((value for value, held in form.args if held == wanted), None)


def _covering(rows: list[tuple[sp.Basic, str]], span: tuple[str, str]) -> sp.Basic:
    for value, text in rows:
        interval = _interval(text)
        if interval and interval[0] <= span[0] and span[1] <= interval[1]:
            return value
    raise NotationError(f"no row from {span[0]} to {span[1]}")


_FINISH: dict[str, Callable[[_Rows, _Resolve], dict[str, sp.Basic]]] = {
    "17": _of_17,
    "18": _by_region,
    "19": _by_region,
    "23": _of_23,
    "33": _of_33,
    "34": _of_34,
    "Q(t)": _of_q_t,
    "43": _totals,
    "44": _totals,
    "A14": _totals,
    "A16": _totals,
}


# --- the comparison -----------------------------------------------------------------------------------------
def _gap(first: sp.Basic, other: sp.Basic, where: str) -> Iterator[str]:
    """The smallest subtrees in which two forms differ."""
    if first == other:
        return
    alike = first.func == other.func and first.args and len(first.args) == len(other.args)
    if alike and isinstance(first, sp.Piecewise):
        for number, (a, b) in enumerate(zip(first.args, other.args, strict=True), 1):
            yield from _gap(a[0], b[0], f"{where}, row {number}")
            yield from _gap(a[1], b[1], f"{where}, condition {number}")
    elif alike and isinstance(first, Relational | sp.Derivative | sp.Integral):
        for a, b in zip(first.args, other.args, strict=True):
            yield from _gap(a, b, where)
    elif alike and isinstance(first, sp.Add | sp.Mul | sp.And | sp.Or):
        only = [set(first.args) - set(other.args), set(other.args) - set(first.args)]
        if all(len(part) == 1 for part in only):
            yield from _gap(only[0].pop(), only[1].pop(), where)
        else:
            yield f"{where}: {' and '.join(map(str, only[0]))} against {' and '.join(map(str, only[1]))}"
    else:
        yield f"{where}: {first} against {other}"


def differences(entry: Entry, data: Data | None = None, printed: Forms | None = None) -> list[str]:
    """Where the two transcriptions of an entry, or the second and its quotes, do not agree; empty if they do."""
    data = load() if data is None else data
    if entry.id not in data:
        missing = entry.printed and not entry.id.startswith("claim-")  # sentences are quoted by the entry itself
        return [f"({entry.id}) is not in the second transcription"] if missing else []
    found = []
    for quote in data[entry.id].get("quote", ()):
        at = f"({entry.id}) line {quote['line']}"
        try:
            if checksum(quote["text"]) != quote["checksum"]:
                found.append(f"{at}: the quote is not the one that was copied")
            if "forms" in quote:
                found += _against_quote(quote, at, data[entry.id].get("table", False))
        except NotationError as error:
            found.append(f"{at}: {error}")
    try:
        others = second(entry.id, data) if _has_forms(data[entry.id]) else {}
    except (NotationError, KeyError, ValueError, TypeError, AttributeError) as error:
        return [*found, f"({entry.id}) {error}"]
    forms = entry.printed if printed is None else printed
    for name in sorted(forms.keys() - others.keys()):
        found.append(f"({entry.id}) {name} stands in the first only")
    for name in sorted(others.keys() - forms.keys()):
        found.append(f"({entry.id}) {name} stands in the second only: {others[name]}")
    for name in (name for name in forms if name in others):
        found += _gap(_decimals(forms[name]), _decimals(others[name]), f"({entry.id}) {name}")
    return found


def _decimals(form: sp.Basic) -> sp.Basic:
    """Decimal figures as the fractions that they are."""
    return form.xreplace({number: sp.Rational(str(float(number))) for number in form.atoms(sp.Float)})


def _has_forms(block: Mapping[str, Any]) -> bool:
    return any("forms" in quote for quote in block.get("quote", ()))


def _against_quote(quote: Mapping[str, Any], at: str, table: bool) -> list[str]:
    """Sign by sign; of a table's row, which is words and a figure, the numbers alone."""
    if table:
        printed = re.findall(r"\d+(?:\.\d+)?", quote["text"].partition("\t")[2].replace("³", "3"))
        written = [atom for atom in atoms_of_notation(quote["forms"]) if atom[0].isdigit()]
    else:
        printed, written = atoms_of_tex(quote["text"]), atoms_of_notation(quote["forms"])
    if quote.get("unnamed"):  # the left side is the ledger's
        written = written[1:]
    for number, (a, b) in enumerate(zip([*printed, "the end"], [*written, "the end"], strict=False)):
        if a != b:
            return [f"{at}: the quote has {a} where the notation has {b}, {number} signs in"]
    return [] if len(printed) == len(written) else [f"{at}: the quote and the notation are not of one length"]
