"""One page of everything: figures, tables, claims, the interactive part; the same bytes for the same input."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib.metadata import version
from importlib.resources import files
from itertools import groupby
from typing import Any

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.motor import Motor
from trum_sym.model.operating_point import evaluate
from trum_sym.output.progress import shown
from trum_sym.paper.claims import PARTLY
from trum_sym.paper.coupled import coupled_tables
from trum_sym.paper.ledger import Record, load_ledger
from trum_sym.paper.tables import Table, tables
from trum_sym.plots import svg
from trum_sym.plots.style import COLOURS, GRID, INK
from trum_sym.report.catalogue import PICTURES
from trum_sym.report.interactive import fragment
from trum_sym.report.judged import Judged, judge

__all__ = ["page"]

_INKS = {INK: "--ink", GRID: "--line", **{colour: f"--c{number}" for number, colour in enumerate(COLOURS, 1)}}


def page(motor: Motor, *, progress: bool = False) -> str:
    """The report on a motor as HTML: no file but the ledger beside it is linked, and no address.

    Parameters
    ----------
    motor : Motor
        The paper's TRUM-60, or another in its place.
    progress : bool
        Whether to show a bar on the standard error.

    Raises
    ------
    MissingExtraError
        Without matplotlib or jinja2.
    """
    try:
        from jinja2 import Environment, PackageLoader, StrictUndefined
    except ImportError as error:
        raise MissingExtraError("report", str(error.name), "report") from None
    environment = Environment(
        loader=PackageLoader("trum_sym.report", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    folder = files("trum_sym.report") / "templates"
    drawn = _drawn(motor, progress)
    judged = judge(motor, progress)
    records, coupling = load_ledger(), coupled_tables(motor)
    return environment.get_template("page.html").render(
        motor=motor.name,
        version=version("trum-sym"),
        style=(folder / "style.css").read_text("utf-8"),
        script=(folder / "page.js").read_text("utf-8"),
        facts=_facts(motor, records, judged),
        parts=[
            {"place": place, "anchor": _slug(place), "items_": list(group)}
            for place, group in groupby(drawn, lambda item: item["picture"].place)
        ],
        tables=list(tables(motor)),
        coupling=coupling,
        interactive=fragment(motor),
        judged=judged,
        labels=_labels(coupling),
        ledger={"all": len(records), "erratum": sum(record["verdict"] == "erratum" for record in records)},
    )


def _said(verdict: str) -> str:
    """A verdict in a sentence, where no readings follow it."""
    return f"{verdict} some readings" if verdict == PARTLY else verdict


def _facts(motor: Motor, records: list[Record], judged: Judged | None) -> list[dict[str, str]]:
    """What a reader takes away within a minute."""
    point = evaluate(motor)
    found = float(point.resonance_frequency)
    measured = next((entry.value for entry in motor.published if entry.output == "resonance_frequency"), None)
    facts = []
    if judged is not None:
        facts += [
            {
                "value": f"{len(judged.claims)} claims judged:",
                "text": ", ".join(f"{count} {_said(verdict)}" for verdict, count in judged.verdicts) + ".",
                "link": "#claims",
                "label": "The claims",
            },
            {
                "value": f"{judged.distance:.2f} %",
                "text": "is how near the best reading of what the paper leaves open comes to both determinants of "
                f"Table 4: {judged.best}.",
                "link": "#readings",
                "label": "All readings",
            },
        ]
    facts.append(
        {
            "value": f"{1e-3 * found:.2f} kHz",
            "text": "resonance at 180 N by the full Timoshenko root"
            + ("" if measured is None else f"; {1e-3 * measured:.2f} kHz was measured."),
            "link": "#figure-25b",
            "label": "Every level",
        }
    )
    errata = sum(record["verdict"] == "erratum" and record["id"].removeprefix("A").isdigit() for record in records)
    numbered = sum(record["id"].removeprefix("A").isdigit() for record in records)
    facts.append(
        {
            "value": f"{errata} of {numbered}",
            "text": "numbered equations are misprinted or wrong.",
            "link": "ledger.html",
            "label": "The ledger",
        }
    )
    return facts


def _drawn(motor: Motor, progress: bool) -> list[dict[str, Any]]:
    """The pictures with their SVG, in order."""
    return [
        {"picture": picture, "svg": _themed(svg(picture.draw(motor), picture.anchor, picture.alt))}
        for picture in shown(PICTURES, "figures" if progress else None, describe=lambda p: p.anchor if p else "")
    ]


def _labels(coupling: Iterable[Table]) -> dict[str, str]:
    """What an anchor of a claim is called."""
    named = {picture.anchor: picture.number or picture.title for picture in PICTURES}
    named |= {table.anchor: f"{table.title}, with the rotor's reaction" for table in coupling}
    return named | {f"table-{number}": f"Table {number}" for number in range(1, 6)}


def _themed(element: str) -> str:
    """The house's colours as variables of the page, so that pictures follow light and dark."""
    pattern = "|".join(_INKS)
    return re.sub(rf"(?<=: )({pattern})(?=[;\"])", lambda found: f"var({_INKS[found[1]]})", element)


def _slug(text: str) -> str:
    """A heading as an anchor."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
