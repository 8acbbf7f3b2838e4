"""What ``--json`` prints and ``to_dict`` gives, as a page: made from a point that is evaluated while the site is."""

from __future__ import annotations

import json
from typing import Any

import trum_sym as ts
from trum_sym.inputs.motor_schema import schema
from trum_sym.model.inputs import SCHEMA
from trum_sym.quantities import known_quantity

__all__ = ["pages"]

_ABOUT = {
    "schema": "version of the record; it rises when a name changes its meaning or goes",
    "trum_sym": "version of the package",
    "motor": "the motor's name",
    "motor_values": "every number of the motor by name",
    "assumed": "the plausible range of every value that is assumed",
    "box": "ranges that searches vary",
    "allowed": "ranges that the hardware can be set to",
    "spreads": "how far what drifts may be off: amount, and whether it is a share",
    "drive": "every field of the drive",
    "levels": "the level of each part of the model",
    "sampling_period": "of the encoder; null for the continuous speed",
    "tolerance": "largest bound of the speeds' errors over the largest speed",
    "start": "state in which every cycle begins",
    "contact": "level of the contact",
    "converged": "whether all bounds meet the tolerance",
    "reason": "why not, or that a string goes slack",
    "remarks": "what the figures do not say by themselves",
    "units": "the SI unit of every number that has one, by name",
    "cycles": "drive cycles after which the orbit repeats itself",
    "largest_multiplier": "by how much a small disturbance is larger after them, at most",
    "multipliers": "the sizes of all of them",
    "branches": "different orbits that attract, of those that the starts lead to",
    "branch": "only, or which of several it is; none where none attracts",
    "closed": "whether laps end where they began",
    "stable": "whether small disturbances die out",
    "absent": "why figures of a prescribed wave are not there, by name",
}
_COUPLED = {
    "start": "where the laps began that led to the orbit",
    "converged": "closed, stable, errors within the tolerance",
}


def _meaning(name: str) -> str:
    known = known_quantity(name)
    if known is None:
        return _ABOUT.get(name, "as in the drive")
    return f"{known.label}: {known.meaning}" if known.meaning else known.label


def _kind(value: Any) -> str:  # noqa: ANN401
    words = {dict: "object", list: "array", tuple: "array", str: "text", bool: "true or false", int: "integer"}
    return "null or a number" if value is None else words.get(type(value), "number")


def pages() -> dict[str, str]:
    """The page of the records, and the schema of motor files."""
    record = ts.evaluate().to_dict()
    coupled = ts.evaluate(coupling="contact", compliance="flange", tolerance=1e-2).to_dict()
    units = {**coupled["units"], **record["units"]}
    own = {name: value for name, value in coupled.items() if name not in record or name in _COUPLED}

    def rows(of: dict[str, Any], about: dict[str, str]) -> str:
        cells = ((f"`{n}`", _kind(v), units.get(n, ""), about.get(n) or _meaning(n)) for n, v in of.items())
        return "\n".join(f"| {' | '.join(row)} |" for row in cells)

    text_of_schema = json.dumps(schema(), indent=2, ensure_ascii=False)
    text = (
        "# JSON\n\nEvery command has `--json`, every answer `to_dict` and `to_json`: one object, SI units, frequencies "
        "in Hz, speeds in rad/s, null for what has no meaning or is infinite; arrays where the inputs are.  It has "
        f"all inputs, so `--point FILE` gives it to any other command.  Records have version {SCHEMA} (`schema`).\n\n"
        "## The record of a point\n\nOf `trum-sym evaluate --json`; the console adds `published`, what the paper "
        f"prints beside it.\n\n| name | kind | unit | what it is |\n|---|---|---|---|\n{rows(record, {})}\n\n"
        "## With coupling\n\nOf `trum-sym evaluate --coupling contact --json`, beside the inputs and what `absent` "
        "does not name; errors are estimates.\n\n"
        f"| name | kind | unit | what it is |\n|---|---|---|---|\n{rows(own, _COUPLED)}\n\n"
        "Answers of searches have the same inputs and what their page in the [API](api.md) says: "
        "`holding` (slopes, drifts, precisions), `points` of a front or a table, `searched`, `evidence`.\n\n"
        "## The schema of motor files\n\nWhat `trum-sym motor schema` prints; editors complete and check by it.\n\n"
        f"```json\n{text_of_schema}\n```\n"
    )
    return {"json.md": text}
