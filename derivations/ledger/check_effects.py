"""Hold every figure of the effects against the second route: ``python -m derivations verify --effects``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import mpmath as mp

from derivations.ledger.figures import Figure, recorded
from derivations.ledger.model import WORKING_DIGITS, Entry
from derivations.ledger.second_route import SECOND_ROUTES

__all__ = ["Checked", "check", "effect_of", "uncounted"]


@dataclass(frozen=True)
class Checked:
    """A printed figure and what the second route finds for it."""

    entry: str
    figure: Figure
    again: float

    @property
    def off(self) -> float:
        """The difference in units of the last printed digit."""
        return abs(self.again - float(self.figure.printed)) / (2 * self.figure.half_digit)

    @property
    def apart(self) -> float:
        """The relative difference of the two routes themselves, before anything is rounded."""
        size = max(abs(self.again), abs(self.figure.value))
        return abs(self.again - self.figure.value) / size if size > 1e-12 else 0.0

    @property
    def holds(self) -> bool:
        """Whether the figure is what the second route finds, rounded to the printed digit; a tie may go either way."""
        return self.off <= 0.5 + 1e-3


def effect_of(entry: Entry) -> tuple[str, list[Figure]]:
    """The sentence of an effect and the figures that it computes."""
    with mp.workdps(WORKING_DIGITS), recorded() as figures:
        text = entry.effect()
    return text, figures


_REFERENCE = re.compile(
    r"\b(?:eqs?\.|Eqs?\.|Tables?|Sects?\.|Figs?\.|App\.) ?\(?[A-C]?\d+(?:\.\d+)*\)?"
    r"(?:(?:, | and | to )\(?[A-C]?\d+\)?)*(?:'s)?"
    r"|\([A-C]?\d+\)|\b(?:m|s|mm|N|Pa)\^-?\d|1/(?=s|m|Pa|T)|\b[dA-C]\d+\b|\b(?:row|Row) \d"
)
_NUMBER = re.compile(r"(?<![\w^.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
_GIVEN = frozenset(
    (
        "0",
        "1",
        "2",
        "3",
        "4",
        "-1",
        "+1",
        "-3",
        "-4",
        "8",
        "9",
        "14",
        "20",
        "30",
        "55",
        "60",
        "100",
        "160",
        "180",
        "188.4",
        "200",
        "210",
        "220",
        "400",
        "633",
        "2800",
        "3000",
        "3300",
        "4000",
        "39703",
        "39.703",
        "12.6",
        "5.5",
        "5.56",
        "1.5",
        "0.3",
        "0.9",
        "0.19",
        "0.006",
        "1.6",
        "17.3",
        "46.8",
        "22.9",
        "1447.5",
        "3446.4",
        "0.01",
    )
)
"""The drive, what the paper prints or measured, and numbers of a sentence such as pi's factors."""


def uncounted(text: str, figures: Iterable[Figure]) -> list[str]:
    """Numbers of an effect's sentence that are neither among its figures nor given by the paper."""
    left = _NUMBER.findall(_REFERENCE.sub(" ", text))
    for figure in figures:
        if figure.printed in left:
            left.remove(figure.printed)
    return [number for number in left if number not in _GIVEN]


def check(entries: Iterable[Entry]) -> Iterator[Checked | str]:
    """Every figure with its second route, or a sentence that says why there is none."""
    for entry in entries:
        text, figures = effect_of(entry)
        for number in uncounted(text, figures):
            yield f"({entry.id}) states {number}, which nothing computes"
        again = [float(mp.mpf(value)) for value in SECOND_ROUTES[entry.id]()] if entry.id in SECOND_ROUTES else []
        if len(again) != len(figures):
            yield f"({entry.id}) has {len(figures)} figures, the second route {len(again)}"
            continue
        yield from (Checked(entry.id, figure, value) for figure, value in zip(figures, again, strict=True))
