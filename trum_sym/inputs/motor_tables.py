"""Motors for people: every value with its source, what is doubtful, what two differ in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from trum_sym.inputs.drive import BOX_NAMES, DRIVE_DOMAINS
from trum_sym.inputs.motor import SPECS, TO_DO, Motor, Parameter
from trum_sym.inputs.motor_schema import ENTRIES, in_unit
from trum_sym.inputs.plausible import doubts, outside_range
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line

__all__ = ["as_dict", "as_table", "checked", "differences"]


def _entries(parameters: Mapping[str, Parameter]) -> dict[str, Any]:
    return {
        name: {"value": p.value, "unit": p.unit, "symbol": p.symbol, "source": p.source, "range": p.range}
        for name, p in parameters.items()
    }


def as_dict(motor: Motor) -> dict[str, Any]:
    """Every value in SI with unit, symbol, source and range."""
    return {
        "motor": motor.name,
        "parameters": _entries(dict(motor.parameters())),
        "bench": _entries(motor.bench),
        "box": {
            name: {"range": [allowed.low, allowed.high], "source": allowed.source}
            for name, allowed in motor.box.items()
        },
        "allowed": {
            name: {"range": [allowed.low, allowed.high], "source": allowed.source}
            for name, allowed in motor.allowed.items()
        },
        "spreads": {
            name: {"value": amount.value, "share": amount.share, "source": amount.source}
            for name, amount in motor.spreads.items()
        },
        "published": [
            {"output": e.output, "value": e.value, "unit": e.unit, "source": e.source, "drive": dict(e.drive)}
            for e in motor.published
        ],
    }


def _shown(name: str, parameter: Parameter | None) -> tuple[str, str]:
    """A value in the unit that people write, and the unit."""
    if parameter is None:
        return "modelled", ""
    unit = ENTRIES[name].unit
    return f"{in_unit(float(parameter.value), unit):.10g}", "" if unit == "1" else unit


def _range(name: str, parameter: Parameter) -> str:
    if parameter.range is None:
        return ""
    low, high = (in_unit(end, ENTRIES[name].unit) for end in parameter.range)
    return f"{low:g} to {high:g}"


def as_table(motor: Motor) -> str:
    """Every value of a motor in the units that people write."""
    rows = [
        (name, p.symbol, *_shown(name, p), _range(name, p), one_line(p.source), ENTRIES[name].meaning)
        for name, p in motor.parameters()
    ]
    headers = ("", "symbol", "value", "unit", "range", "source", "what it is")
    lines = [one_line(motor.name), "", text_table(rows, headers, "llrllll")]
    optional = [name for name, spec in SPECS.items() if not spec.required and getattr(motor, name) is None]
    if optional:
        lines += ["", f"modelled, unless the file gives a measured value: {', '.join(optional)}"]
    for name, allowed in motor.box.items():
        lines += ["", f"searches vary {name} from {allowed.low:g} to {allowed.high:g} ({one_line(allowed.source)})"]
    for name, allowed in motor.allowed.items():
        lines += ["", f"hardware allows {name} from {allowed.low:g} to {allowed.high:g} ({one_line(allowed.source)})"]
    for name, amount in motor.spreads.items():
        unit = DRIVE_DOMAINS[name][1] if name in DRIVE_DOMAINS else SPECS[name].unit
        off = (
            f"{100 * amount.value:g} %" if amount.share else f"{amount.value:g} {'' if unit == '1' else unit}".rstrip()
        )
        lines += ["", f"{name} may be off by {off} ({one_line(amount.source)})"]
    return "\n".join(lines)


def checked(motor: Motor, further: Sequence[str] = ()) -> tuple[str, bool]:
    """What is to be looked at, and whether nothing of it is wrong; ``further`` is what the model finds wrong."""
    left = [name for name, p in motor.parameters() if p.source.casefold().startswith(TO_DO)]
    assumed = {name: p for name, p in motor.assumed().items() if name not in left}
    parameters = dict(motor.parameters())
    wrong = [*doubts(parameters), *further]
    outside = [text for name, p in parameters.items() if (text := outside_range(name, p.value, p)) is not None]
    lines = [f"{one_line(motor.name)}: {len(parameters)} values"]
    lines += [f"to do: {len(left)} values of the template: {', '.join(left)}"] if left else []
    for name, p in assumed.items():
        value, unit = _shown(name, p)
        lines.append(f"assumed: {name} {value} {unit}".rstrip() + f", {_range(name, p)}: {one_line(p.reason)}")
    lines += [f"contradictory or unusual: {text}" for text in wrong]
    lines += [f"out of range: {text}" for text in outside]
    for name in BOX_NAMES:
        if name not in motor.box:
            lines.append(f"no range of {name} in [box]: searches will ask for one")
    good = not (left or wrong or outside)
    return "\n".join([*lines, "nothing contradicts" if good else "not ready"]), good


def differences(one: Motor, other: Motor, called: tuple[str, str] = ("", "")) -> str:
    """The values in which two motors differ, in the units that people write; ``called`` where one name is the other."""
    rows = []
    for name in SPECS:
        a, b = getattr(one, name), getattr(other, name)
        if (a and a.value) == (b and b.value):
            continue
        change = f"{100 * (b.value / a.value - 1):+.3g} %" if a and b and a.value else ""
        unit = "" if ENTRIES[name].unit == "1" else ENTRIES[name].unit
        sources = (one_line(p.source) if p else "" for p in (a, b))
        rows.append((name, _shown(name, a)[0], _shown(name, b)[0], unit, change, *sources))
    names = [one_line(name) for name in (called if all(called) and one.name == other.name else (one.name, other.name))]
    if not rows:
        return f"{names[0]} and {names[1]} have the same values"
    headers = ("", *names, "unit", "change", *(f"source of {name}" for name in names))
    return text_table(rows, headers, "lrrlrll")
