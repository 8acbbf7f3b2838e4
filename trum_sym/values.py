"""Values: frozen, equal by what they hold, hashable, and what pickle and deepcopy make of them is equal again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, TypeVar

from trum_sym.errors import ParameterError
from trum_sym.text import one_line

__all__ = ["FrozenDict", "Value"]

K = TypeVar("K")
V = TypeVar("V")


class FrozenDict(Mapping[K, V]):
    """A mapping that does not change: hashable where its values are, and, unlike a mapping proxy, copied and pickled.

    Examples
    --------
    >>> FrozenDict(a=1)["a"]
    1
    """

    __slots__ = ("_known",)

    def __init__(self, *known: Any, **more: Any) -> None:  # noqa: ANN401
        self._known: dict[K, V] = {name: _frozen(value) for name, value in dict(*known, **more).items()}

    def __getitem__(self, key: K) -> V:
        return self._known[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def __repr__(self) -> str:
        return repr(self._known)

    def __eq__(self, other: object) -> bool:
        return _same(self, other) if isinstance(other, Mapping) else NotImplemented

    def __hash__(self) -> int:
        return hash(_key(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._known,)


class Value:
    """What frozen dataclasses of results and inputs share; they are declared with ``eq=False``.

    Arrays are read-only and mappings frozen.  Equality is by type and fields, arrays by all of their elements, and NaN
    counts as NaN.
    """

    def __post_init__(self) -> None:
        """Freezes what the fields hold."""
        for field in fields(self):  # type: ignore[arg-type]  # every subclass is a dataclass
            object.__setattr__(self, field.name, _frozen(getattr(self, field.name)))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in _compared(self))

    def __hash__(self) -> int:
        return hash((type(self), *(_key(getattr(self, name)) for name in _compared(self))))

    def _table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Headers and rows of what a notebook shows."""
        names = [field.name for field in fields(self) if field.repr]  # type: ignore[arg-type]
        shown: list[tuple[str, ...]] = [(name, repr(getattr(self, name))) for name in names]
        return ("field", "value"), shown

    def _repr_html_(self) -> str:
        from tabulate import tabulate

        headers, rows = self._table()
        head, *cells = ([one_line(cell) for cell in row] for row in (headers, *rows))
        return str(tabulate(cells, head, tablefmt="html", disable_numparse=True))

    def __reduce__(self) -> tuple[Any, ...]:
        from importlib.metadata import version

        state = {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        return _restored, (type(self), version("trum-sym"), state)


def _restored(kind: type[Any], version: str, state: dict[str, Any]) -> Any:  # noqa: ANN401
    """A value out of a pickle or a copy.

    Raises
    ------
    ParameterError
        For a pickle of a version whose values have other fields.
    """
    names = {field.name for field in fields(kind)}
    if names != set(state):
        raise ParameterError(
            "pickle",
            f"a {kind.__name__} of trum-sym {version}, which differs in {', '.join(sorted(names ^ set(state)))}",
            "one of this version; motor files, NetCDF and Zarr stores last longer than pickles",
        )
    value = object.__new__(kind)
    for name, held in state.items():
        object.__setattr__(value, name, _frozen(held))
    return value


def _compared(value: Any) -> Iterator[str]:  # noqa: ANN401
    return (field.name for field in fields(value) if field.compare)


def _is_array(value: object) -> bool:
    kind = type(value)  # a stranger's object is not asked
    return hasattr(kind, "__array_interface__") and hasattr(kind, "flags")


def _frozen(value: Any) -> Any:  # noqa: ANN401
    if _is_array(value) and value.ndim:
        if value.flags.writeable:
            value = value.view()
            value.flags.writeable = False
        return value
    if type(value) in (tuple, list):
        return tuple(map(_frozen, value))
    return FrozenDict(value) if isinstance(value, Mapping) and not isinstance(value, FrozenDict) else value


def _same(one: Any, other: Any) -> bool:  # noqa: ANN401
    if one is other:
        return True
    if _is_array(one) or _is_array(other):
        import numpy as np

        a, b = np.asarray(one), np.asarray(other)
        return a.shape == b.shape and bool(np.all((a == b) | ((a != a) & (b != b))))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_same(one[name], other[name]) for name in one)
    if isinstance(one, tuple | list) and isinstance(other, tuple | list):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(one == other or (one != one and other != other))


def _key(value: Any) -> Any:  # noqa: ANN401
    """What is equal for equal values, and hashable."""
    if _is_array(value):
        import numpy as np

        if value.dtype.kind not in "fiub":  # text
            return value.shape, tuple(value.ravel().tolist())
        numbers = np.asarray(value, np.float64) + 0.0  # -0.0 is 0.0
        numbers[np.isnan(numbers)] = np.nan  # of whatever bits
        return value.shape, numbers.tobytes()
    if isinstance(value, Mapping):
        return frozenset((name, _key(held)) for name, held in value.items())
    if isinstance(value, tuple | list):
        return tuple(map(_key, value))
    return "nan" if value != value else value
