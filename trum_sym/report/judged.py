"""The claims and the readings of the paper as the page shows them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import STARTS
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.paper.claims import VERDICTS, Claim, best, claims, reading_rows, readings, varied
from trum_sym.paper.findings import Context
from trum_sym.paper.readings import AXES, LEADS, LOAD_INERTIA, published
from trum_sym.paper.tables import Table
from trum_sym.paper.trends import FOLLOWS, PAIRS, trends

__all__ = ["Judged", "judge"]

_NEAREST = 12
_BEST = {
    "nearest": "nearest to both determinants",
    "determinants": "most claims on determinants",
    "claims": "most claims of all that depend on the reading",
}


@dataclass(frozen=True)
class Judged:
    """Claims with their verdicts counted, tables of the load's inertia and of readings, the nearest in words."""

    claims: list[Claim]
    verdicts: list[tuple[str, int]]
    by_inertia: tuple[Table, ...]
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
        "with load",
        "σ_s (%)",
        "with load",
        "farther of both determinants",
        "open claims that hold",
    )
    numeric = (0, *range(8, len(head)))
    caption = (
        "Sorted by the farther of both determinants from Table 4's, which need neither friction nor contact radius. "
        "An open claim is one that holds in some readings and not in others. σ_s is what the encoder of 2 ms reads; "
        f"with load: with {LOAD_INERTIA[-1]:.1e} kg m², the heaviest torque plate that the motor file states."
    )
    nearest = records[0]
    return Judged(
        claims=judged,
        verdicts=[(verdict, counts[verdict]) for verdict in VERDICTS],
        by_inertia=(_cells(judged), _trends(Context(motor, found))),
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


def _cells(judged: list[Claim]) -> Table:
    """Where the claims on the rotor hold, at each load's inertia."""
    loads = " and ".join(f"{value:.1e}" for value in LOAD_INERTIA[1:])
    names = tuple(f"{start}, lead {lead:+.0f}".replace("-", "−") for start in STARTS for lead in LEADS)
    rows = tuple(
        (
            row.place,
            row.id,
            *(cell.replace("-", "−") for cells in row.cells for cell in cells),
            row.verdicts[0],
            row.verdicts[1],
            row.verdict,
        )
        for row in varied(judged)
    )
    return Table(
        "claims-inertia",
        "Claims on the rotor, by what is read of its speed and by the load's inertia",
        "+ holds in all switching phases, levels and corners of what is assumed, o in some, − in none. First letter: "
        "the speed itself of a rotor without a load; second: what the encoder of 2 ms reads of it, for what was "
        f"measured; third and fourth: that with a load's inertia of {loads} kg m². The measured motor turns a torque "
        "plate (Sect. 8.1), so what is said of it is judged by the last two, of the simulation by the second.",
        ("place", "claim", *names, "by the speed", "by the encoder", "judged"),
        rows,
    )


def _trends(context: Context) -> Table:
    """From what inertia of the load on the rotor's trends are those of the determinants."""
    rows: dict[tuple[str, ...], list[str]] = {}
    for trend in trends(context):
        cells = rows.setdefault((f"{trend.start}, lead {trend.lead:+.0f}".replace("-", "−"), trend.variable), [])
        cells.append(" ".join(f"{value:+.2f}" for value in trend.at_ends).replace("-", "−"))
        start = trend.follows_from
        cells.append("never" if start is None else "always" if start == 0 else f"{start:.1e}")
    return Table(
        "trends-inertia",
        "Trends by the load's inertia",
        "Rank correlation of v_s with Q_aver and of σ_s with Q_vib at the default level, A at its crest, without a "
        f"load's inertia and with {LOAD_INERTIA[1]:.1e} and {LOAD_INERTIA[2]:.1e} kg m²; from: the inertia (kg m²) "
        f"from which on it is at least {FOLLOWS}. "
        "Six drives over 2800 to 3300 Hz at 180 N, and six over 160 to 210 N at 3000 Hz.",
        ("start, phase lead", "over", *(word for pair in PAIRS for word in (pair, "from"))),
        tuple((*key, *cells) for key, cells in rows.items()),
    )


def _row(name: str, record: dict[str, Any]) -> tuple[str, ...]:
    def percent(figure: str) -> str:
        return f"{record[figure]:+.1f} %".replace("-", "−")

    def plain(value: float) -> str:
        return f"{value:.5g}".replace("-", "−")

    speed, volatility = (
        [plain(record[name][i] / unit) for i in (0, -1)]
        for name, unit in (("mean_speed", ARCSEC), ("speed_volatility", 0.01))
    )
    known = len(record["holds"]) + len(record["fails"])
    return (
        name,
        *(str(record[axis]) for axis in AXES),
        plain(record["f_n Hz"]),
        plain(record["q_average"]),
        percent("q_average off %"),
        plain(record["q_volatility"]),
        percent("q_volatility off %"),
        *speed,
        *volatility,
        f"{record['distance %']:.2f} %",
        f"{len(record['holds'])} of {known}",
    )
