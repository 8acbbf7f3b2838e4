"""Checks of a thing against itself: what derivation and judge of an entry both compute with is made wrong in both.

Evidence is worth something only if what it is held against can disagree.  So every function of the derivations, and
of the ledger's own modules, that an entry's derivation *and* its judge call is replaced by one whose numbers and
expressions are off by a percent, in both alike.  A step that no longer holds, or evidence that turns against the
forms that stand, shows that something else bears the entry out.  If nothing notices, the forms were compared with
their own source.

What merely provides a place to compare at is left alone: the motor's data, the operating point, random points.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, is_dataclass
from types import FunctionType
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from derivations.ledger.model import WORKING_DIGITS, Derivation, Entry, Evidence, Forms, Step

__all__ = ["shared", "unnoticed"]

_SHIFT = sp.Rational(101, 100)
_PLACES = frozenset(
    (
        "_by_rows",
        "_c",
        "_cosine",
        "_number",
        "_row_at",
        "_s",
        "_sine",
        "agrees",
        "anywhere",
        "at_point",
        "at_table_3",
        "by_region",
        "compiled",
        "context",
        "crest_states",
        "cycle_time",
        "difference",
        "dimension",
        "drive_frequency",
        "error_size",
        "evaluate",
        "evidence",
        "figure",
        "identical",
        "largest",
        "latex",
        "motor",
        "numeric",
        "operating_point",
        "parse_unit",
        "points",
        "random_cycles",
        "region_edges",
        "region_times",
        "resolved",
        "row_value",
        "rows",
        "states",
        "stator",
        "step",
        "sym",
        "turning",
        "unit",
        "usual",
        "values",
        "vanishes",
        "with_rows",
        "within",
        "worse",
        "worst",
    )
)
"""Places to compare at, and tools that only pass on what they are given."""


@dataclass(frozen=True)
class _Known:
    """A function as modules know it."""

    function: Callable[..., Any]
    modules: tuple[tuple[str, str], ...]  # (module, name there)


def _functions() -> dict[Any, _Known]:
    """Functions of the derivations by the code that runs when they are called."""
    seen: dict[Any, list[Any]] = {}
    for module_name, module in list(sys.modules.items()):
        if not module_name.startswith("derivations"):
            continue
        for name, value in list(vars(module).items()):
            plain = getattr(value, "__wrapped__", value)
            if isinstance(plain, FunctionType) and plain.__module__.startswith("derivations") and name not in _PLACES:
                seen.setdefault(plain.__code__, [value]).append((module_name, name))
    return {code: _Known(found[0], tuple(found[1:])) for code, found in seen.items()}


def _forget() -> None:
    """Empty the caches of all functions that compute, so that they are seen to be called."""
    for module_name, module in list(sys.modules.items()):
        if module_name.startswith("derivations"):
            for name, value in list(vars(module).items()):
                if hasattr(value, "cache_clear") and name not in _PLACES:
                    value.cache_clear()


def _calls(action: Callable[[], object], functions: Mapping[Any, _Known]) -> set[Any]:
    """The codes of functions that are called, from wherever."""
    seen: set[Any] = set()

    def watch(frame: Any, event: str, _: object) -> None:  # noqa: ANN401
        if event == "call" and frame.f_code in functions:
            seen.add(frame.f_code)

    _forget()
    before = sys.getprofile()
    sys.setprofile(watch)
    try:
        action()
    finally:
        sys.setprofile(before)
    return seen


def shared(entry: Entry) -> list[_Known]:
    """What derivation and judge of an entry both compute with, besides the entry's own functions that make it."""
    functions = _functions()
    with mp.workdps(WORKING_DIGITS):
        forms = _forms(entry, entry.derive())
        deriving = _calls(entry.derive, functions)
        judging = _calls(lambda: list(entry.judge(forms)), functions)
    own = {entry.derive, entry.judge, entry.effect, entry.repair}
    return [functions[code] for code in deriving & judging if functions[code].function not in own]


def _forms(entry: Entry, derivation: Derivation) -> Forms:
    """What stands: the derived forms of an erratum or of what is missing, else the print."""
    return derivation.forms if entry.verdict in ("erratum", "reconstructed") else entry.printed


def _off(value: Any) -> Any:  # noqa: ANN401
    """A result made wrong: numbers and expressions a percent larger, inside of whatever holds them."""
    if isinstance(value, (bool, str, type(None), Evidence, Step, Derivation)) or value in (sp.true, sp.false):
        return value
    if isinstance(value, sp.Equality):
        return sp.Eq(value.lhs, value.rhs * _SHIFT)
    if isinstance(value, sp.Piecewise):
        return sp.Piecewise(*((branch * _SHIFT, condition) for branch, condition in value.args), evaluate=False)
    if isinstance(value, sp.Expr):
        return value * _SHIFT
    if isinstance(value, (int, float, complex, np.ndarray, np.generic, mp.mpf, mp.mpc)):
        number: Any = value
        return number * 1.01
    if isinstance(value, Mapping):
        return {key: _off(inner) for key, inner in value.items()}
    if isinstance(value, (tuple, list)) and not is_dataclass(value):
        return type(value)(_off(inner) for inner in value)
    return value


@contextmanager
def _made_wrong(known: _Known) -> Iterator[list[bool]]:
    """The function shifted wherever it is known; says whether a shift changed anything."""
    changed = [False]

    def shifted(*args: Any, **kwargs: Any) -> Any:  # noqa: ANN401
        value = known.function(*args, **kwargs)
        wrong = _off(value)
        changed[0] |= wrong is not value
        return wrong

    _forget()
    for module, name in known.modules:
        setattr(sys.modules[module], name, shifted)
    try:
        yield changed
    finally:
        for module, name in known.modules:
            setattr(sys.modules[module], name, known.function)
        _forget()


def unnoticed(entry: Entry) -> tuple[int, list[str]]:
    """How many shared computations were made wrong, and which of them no evidence and no step noticed."""
    blind, count = [], 0
    with mp.workdps(WORKING_DIGITS):
        true_forms = dict(entry.derive().forms)
    for known in shared(entry):
        with mp.workdps(WORKING_DIGITS), _made_wrong(known) as changed:
            try:
                derivation = entry.derive()
                if dict(derivation.forms) == true_forms:
                    continue  # the forms do not hang on it
                steps = all(one.holds is not False for one in derivation.steps)
                silent = steps and all(found.ok for found in entry.evidence(_forms(entry, derivation)))
            except Exception:
                count += changed[0]
                continue
        count += changed[0]
        if silent and changed[0]:
            blind.append(f"{known.function.__module__.removeprefix('derivations.')}.{known.modules[0][1]}")
    return count, blind
