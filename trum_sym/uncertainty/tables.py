"""A tolerance study for people (text), for programs (JSON) and as labelled data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from trum_sym.inputs.shown import full, quantity_of, readable
from trum_sym.model.inputs import units_of
from trum_sym.output.text_table import text_table
from trum_sym.text import one_line
from trum_sym.uncertainty.propagation import CONFIDENCE, Estimate, Indices
from trum_sym.uncertainty.result import BALANCED, MISSED, Drawn, unit_of

__all__ = ["as_dict", "as_text", "label", "shown"]

_NAMED = 3  # points of each kind that the text names; the JSON names all


def label(output: str) -> str:
    """An output in words."""
    return {BALANCED: "whether a speed balances the load", MISSED: "whether a target is missed"}.get(
        output, output.replace("_", " ")
    )


def shown(output: str, value: float) -> float:
    """A value in the unit that people read."""
    return readable(output, value)


def _percent(share: Estimate) -> str:
    return f"{100 * share.value:.3g} % ({100 * share.low:.3g} to {100 * share.high:.3g} %)"


def _range(estimate: Estimate) -> str:
    return f"{estimate.low:.3f} to {estimate.high:.3f}"


# --- Text ----------------------------------------------------------------------------------------


def as_text(study: Drawn) -> str:
    """All of it, in units that people read; intervals hold at 95 %."""
    drive, count = study.drive, len(study.distributions)
    lines = [
        f"{one_line(study.motor.name)} at "
        f"{full(drive.prepressure)} N, {'+' * (drive.frequency_difference >= 0)}{full(drive.frequency_difference)} Hz, "
        f"{full(drive.on_periods)} of {full(drive.periods)} periods on, {drive.load_text()}, start {drive.start}",
        f"{count} uncertain parameter{'s' * (count != 1)}, {study.samples} samples, "
        f"{study.samples * (count + 2)} points, seed {study.seed}; intervals at {100 * CONFIDENCE:g} %",
        "",
        *_parameters(study),
        "",
        *_spreads(study),
    ]
    for output, indices in study.propagation.indices.items():
        if indices is not None:
            lines += ["", *_indices(study, output, indices)]
    return "\n".join([*lines, "", *_balance(study), *_targets(study)])


def _table(rows: Sequence[tuple[str, ...]], headers: tuple[str, ...], align: str) -> list[str]:
    text = text_table(rows, headers, align)
    return text.splitlines()


def _parameters(study: Drawn) -> list[str]:
    rows = []
    for name, distribution in study.distributions.items():
        unit = unit_of(name)
        rows.append((name, distribution.describe(), "" if unit == "1" else unit))
    return _table(rows, ("uncertain", "distribution", "unit"), "lll")


def _spreads(study: Drawn) -> list[str]:
    rows = []
    for output in study.outputs:
        spread, unit = study.propagation.spread(output), quantity_of(output).shown
        median = spread.quantiles[0.5]
        values = [getattr(study.nominal, output), spread.mean, spread.standard_deviation]
        values += [spread.quantiles[level].value for level in (0.05, 0.5, 0.95)]
        figures = [f"{shown(output, value):.4g}" if np.isfinite(value) else "-" for value in values]
        ends = " to ".join(f"{shown(output, end):.4g}" for end in (median.low, median.high))
        rows.append((label(output), "" if unit == "1" else unit, *figures, ends))
    headers = ("output", "unit", "nominal", "mean", "std", "5 %", "median", "95 %", "interval of median")
    lines = _table(rows, headers, "llrrrrrrl")
    for output in study.outputs:
        missing = study.propagation.spread(output).without_value
        if missing:
            lines.append(f"{label(output)} has no value at {missing} of {2 * study.samples} points, which are left out")
    return lines


def _indices(study: Drawn, output: str, indices: Indices) -> list[str]:
    order = sorted(indices.first, key=lambda name: -indices.total[name].value)
    rows = [
        (name, f"{first.value:.3f}", _range(first), f"{total.value:.3f}", _range(total))
        for name in order
        for first, total in [(indices.first[name], indices.total[name])]
    ]
    lines = _table(rows, (label(output), "alone", "interval", "with others", "interval"), "lrlrl")
    if indices.rows < study.samples:
        lines.append(
            f"over the {indices.rows} of {study.samples} rows of points that all have a value, not over the whole "
            "distribution"
        )
    if output in study.unbounded:
        return [
            *lines,
            f"the mean speed passes zero, where the {label(output)} grows without bound: read its quantiles, for its",
            "mean, deviation and indices do not settle with more samples",
        ]
    return [*lines, *_advice(output, indices)]


def _advice(output: str, indices: Indices) -> Iterator[str]:
    """Which parameter to measure first, in words, and what the samples do not tell."""
    first = indices.first[indices.leader]
    if first.low <= 0:
        yield f"no parameter alone moves {label(output)} beyond what these samples can tell from nothing"
        return
    yield (
        f"measure {indices.leader} first: on average, knowing it takes away {_percent(first)} of the variance of "
        f"{label(output)}"
    )
    if indices.lead < CONFIDENCE:
        rest = {name: estimate.value for name, estimate in indices.first.items() if name != indices.leader}
        yield f"more samples are needed to tell it from {max(rest, key=rest.__getitem__)}"
    idle = [name for name, total in indices.total.items() if total.value == 0]
    if idle:
        yield f"no effect at any point: {', '.join(idle)}"


def _balance(study: Drawn) -> Iterator[str]:
    values = study.propagation.values
    lost, loose = values[BALANCED] == 0, ~study.settled & (values[BALANCED] == 1)
    if not (lost.any() or loose.any()):
        yield f"a speed balances the load at all {lost.size} points, and every orbit met its tolerance"
        return
    share = _percent(study.unbalanced)
    yield f"no speed balances the load at {int(lost.sum())} of {lost.size} points, probability {share}"
    if lost.any():
        yield "  these have no speed, no volatility and no extremes, and miss every target set on them"
        yield from _named(study, lost)
    yield f"the rotor's orbit did not meet its tolerance at {int(loose.sum())} of {loose.size} points"
    if loose.any():
        yield "  these count with the values they have"
        yield from _named(study, loose)


def _named(study: Drawn, chosen: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> Iterator[str]:
    points = study.points_where(chosen)
    for point in points[:_NAMED]:
        yield "  " + ", ".join(f"{name} = {value:.6g}" for name, value in point.items())
    if len(points) > _NAMED:
        yield f"  and {len(points) - _NAMED} more of the {2 * study.samples} random ones; --json names all, --out too"


def _targets(study: Drawn) -> Iterator[str]:
    for target in study.targets:
        yield f"probability of missing {target.text}: {_percent(study.missing(target))}"
    if len(study.targets) > 1:
        yield f"probability of missing any of them: {_percent(study.missing())}"


# --- JSON ----------------------------------------------------------------------------------------


def as_dict(study: Drawn) -> dict[str, Any]:
    """All of it by name, in SI units."""
    values, settled = study.propagation.values, study.settled
    lost, loose = values[BALANCED] == 0, ~settled & (values[BALANCED] == 1)
    found = {
        **study.nominal.inputs.record(),
        "samples": study.samples,
        "count": lost.size,
        "seed": study.seed,
        "confidence": CONFIDENCE,
        "parameters": {
            name: {**distribution.as_dict(), "unit": unit_of(name)}
            for name, distribution in study.distributions.items()
        },
        "outputs": {output: _output_record(study, output) for output in study.outputs},
        "unbalanced": {
            **study.unbalanced.as_dict(),
            "count": int(lost.sum()),
            "points": study.points_where(lost),
            "indices": _indices_record(study.propagation.indices[BALANCED]),
        },
        "unsettled": {"count": int(loose.sum()), "points": study.points_where(loose)},
        "targets": [{"target": target.text, **study.missing(target).as_dict()} for target in study.targets],
        "missed": None
        if not study.targets
        else {**study.missing().as_dict(), "indices": _indices_record(study.propagation.indices[MISSED])},
    }
    return {**found, "remarks": study.nominal.remarks, "units": units_of(found)}


def _output_record(study: Drawn, output: str) -> dict[str, object]:
    spread, nominal = study.propagation.spread(output), getattr(study.nominal, output)
    return {
        "unit": quantity_of(output).unit,
        "nominal": nominal,
        "mean": spread.mean,
        "standard_deviation": spread.standard_deviation,
        "quantiles": [{"probability": p, **estimate.as_dict()} for p, estimate in spread.quantiles.items()],
        "without_value": spread.without_value,
        "unbounded": output in study.unbounded,
        "indices": _indices_record(study.propagation.indices[output]),
    }


def _indices_record(indices: Indices | None) -> dict[str, object] | None:
    if indices is None:
        return None
    return {
        "parameters": {
            name: {"first": indices.first[name].as_dict(), "total": indices.total[name].as_dict()}
            for name in indices.first
        },
        "measure_first": indices.leader,
        "lead": indices.lead,
        "rows": indices.rows,
    }
