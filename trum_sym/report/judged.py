"""The claims and the readings of the paper as the page shows them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.claims import VERDICTS, Claim, best, claims, reading_rows, readings
from trum_sym.paper.readings import AXES, published
from trum_sym.paper.tables import Table

__all__ = ["Judged", "judge"]

_NEAREST = 12
_BEST = {
    "nearest": "nearest to both determinants",
    "determinants": "most claims on determinants",
    "claims": "most claims of all that depend on the reading",
}


@dataclass(frozen=True)
class Judged:
    """Claims with their verdicts counted, readings as tables, and the nearest of them in words."""

    claims: list[Claim]
    verdicts: list[tuple[str, int]]
    readings: tuple[Table, ...]
    all: Table
    best: str
    distance: float


def judge(motor: Motor, progress: bool = False) -> Judged | None:
    """All claims and readings; None for a motor that the paper is not about, whose file publishes no figures."""
    try:
        published(motor)
    except ParameterError:
        return None
    found = readings(motor, progress)
    judged = claims(motor, found, progress)
    counts = Counter(claim.verdict for claim in judged)
    records = reading_rows(found, judged)
    rows = tuple(_row(str(number), record) for number, record in enumerate(records, 1))
    chosen = best(found, judged)
    head = (
        "",
        *AXES,
        "f_n (Hz)",
        "Q_aver (1/s)",
        "off",
        "Q_vib (1/s)",
        "off",
        "v_s (arcsec/s)",
        "σ_s (%)",
        "off",
        "farther of both determinants",
        "open claims that hold",
    )
    numeric = (0, *range(8, len(head)))
    caption = (
        "Sorted by the farther of both determinants from Table 4's, which need neither friction nor contact radius. "
        "An open claim is one that holds in some readings and not in others."
    )
    nearest = records[0]
    return Judged(
        claims=judged,
        verdicts=[(verdict, counts[verdict]) for verdict in VERDICTS],
        readings=(
            Table(
                "readings-best",
                "Readings that stand out",
                "By what each is the best; ties go to the one nearer to "
                "Table 4. Claims on the speed are known for some of the readings only.",
                head,
                tuple(_row(_BEST[name], record) for name, record in chosen.items()),
                numeric[1:],
            ),
            Table(
                "readings-nearest",
                f"The {_NEAREST} readings nearest to Table 4, of {len(rows)}",
                caption,
                head,
                rows[:_NEAREST],
                numeric,
            ),
        ),
        all=Table("readings-all", f"All {len(rows)} readings", caption, head, rows, numeric),
        best=", ".join(f"{name} {nearest[name]}" for name in AXES),
        distance=nearest["distance %"],
    )


def _row(name: str, record: dict[str, Any]) -> tuple[str, ...]:
    def percent(figure: str) -> str:
        return f"{record[figure]:+.1f} %".replace("-", "−")

    def plain(value: float) -> str:
        return f"{value:.5g}".replace("-", "−")

    arcsec = record["mean_speed"] / ARCSEC
    known = len(record["holds"]) + len(record["fails"])
    return (
        name,
        *(str(record[axis]) for axis in AXES),
        plain(record["f_n Hz"]),
        plain(record["q_average"]),
        percent("q_average off %"),
        plain(record["q_volatility"]),
        percent("q_volatility off %"),
        plain(arcsec),
        plain(100 * record["speed_volatility"]),
        percent("speed_volatility off %"),
        f"{record['distance %']:.2f} %",
        f"{len(record['holds'])} of {known}",
    )
