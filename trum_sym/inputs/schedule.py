"""The schedule of a drive: which phase is driven in which drive period, how far apart both are, and by what voltage."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any, Literal, get_args

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array
from trum_sym.inputs.choices import choice
from trum_sym.inputs.domain import Domain
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.points import one_number
from trum_sym.values import Value

__all__ = ["SCHEDULES", "TERMINALS", "Schedule", "Terminals"]

Kind = Literal["pulses", "burst", "single", "continuous"]
SCHEDULES: tuple[Kind, ...] = get_args(Kind)
Terminals = Literal["short", "open"]
TERMINALS: tuple[Terminals, ...] = get_args(Terminals)

_COUNT = Domain(low=1, low_open=False, high=1e8, integer=True)
_QUARTER = math.pi / 2


def _number(default: float | None, unit: str, domain: Domain, text: str, metavar: str) -> Any:  # noqa: ANN401
    """A number of the schedule; the console makes its option of what is said here."""
    return field(default=default, metadata={"unit": unit, "domain": domain, "text": text, "metavar": metavar})


@dataclass(frozen=True, eq=False, kw_only=True)
class Schedule(Value):
    """Which phase is driven in which drive period of a cycle, how far apart both are, and by what voltage.

    Both phases are driven at one frequency.

    Parameters
    ----------
    kind : {"pulses", "burst", "single", "continuous"}
        The superimposed pulses of Sect. 2: A off for the first m - n periods, then B off for as many, then both on;
        both on for n of m periods, then both off (microstepping); A alone, always; both, always.
    periods, on_periods : int
        m and n.  Pulses take the drive's where they are not given; a burst needs them; the others have none.
    phase_difference : float, rad
        By which B is ahead of A where the drive's phase lead is 1, and behind where it is -1.
    voltage : float
        Of A, over the voltage that the level ``amplitude`` is of.
    ratio : float
        Voltage of B over that of A.
    off_terminals : {"short", "open"}
        Of a phase that is off.  Short, it has no modal force; open, it keeps the charge that voltage and displacement
        leave at that instant, or none where it is never driven, which stiffens it and holds it aside.  A burst's are
        short: what comes to rest then is a wave that nothing holds aside.

    Raises
    ------
    ParameterError
        For what is outside its domain, or has no meaning for the kind.

    Examples
    --------
    >>> import trum_sym as ts
    >>> ts.Schedule(kind="burst", periods=3, on_periods=2).gates(ts.Drive())
    array([[1., 1.],
           [1., 1.],
           [0., 0.]])
    >>> ts.Schedule(kind="continuous", phase_difference="60 deg", voltage=0.5).gates(ts.Drive())
    array([[1., 1.]])
    """

    kind: Kind = field(default=SCHEDULES[0], metadata={"words": SCHEDULES, "text": "Which phase is driven when."})
    periods: float | None = _number(None, "1", _COUNT, "Drive periods in a cycle; of pulses 20 if not given.", "M")
    on_periods: float | None = _number(
        None, "1", _COUNT, "Drive periods of a cycle in which a phase is on; of pulses 14 if not given.", "N"
    )
    phase_difference: float = _number(
        _QUARTER,
        "rad",
        Domain(low=-math.pi, low_open=False, high=math.pi, high_open=False),
        "By which B is ahead of A where the phase lead is 1, and behind where it is -1.",
        "RAD",
    )
    voltage: float = _number(
        1.0, "1", Domain(low=0.0, high=10.0, high_open=False), "Of A, over that of the level --amplitude.", "SHARE"
    )
    ratio: float = _number(
        1.0, "1", Domain(low=0.0, low_open=False, high=10.0, high_open=False), "Voltage of B over that of A.", "SHARE"
    )
    off_terminals: Terminals = field(
        default=TERMINALS[0], metadata={"words": TERMINALS, "text": "Terminals of a phase that is off."}
    )

    def __post_init__(self) -> None:
        """Checks and stores every number as a float."""
        choice("kind", self.kind, SCHEDULES)
        for quantity in fields(self):
            name, about = quantity.name, quantity.metadata
            if "unit" in about and quantity.default is not None:
                object.__setattr__(self, name, one_number(name, getattr(self, name), about["unit"], about["domain"]))
        choice("off_terminals", self.off_terminals, TERMINALS)
        if self.off_terminals == "open" and self.kind in ("burst", "continuous"):
            why = "no phase is off" if self.kind == "continuous" else "a charge would hold the wave aside at rest"
            raise ParameterError("off_terminals", "open", f"short where the schedule is {self.kind}: {why}")
        for name in ("periods", "on_periods"):
            given = getattr(self, name)
            if given is None and self.kind == "burst":
                raise ParameterError(name, "none", "an integer >= 1 for a burst")
            if given is not None and self.kind in ("single", "continuous"):
                raise ParameterError(name, given, f"none where the schedule is {self.kind}: every period is alike")
            if given is not None:
                object.__setattr__(self, name, one_number(name, given, "1", _COUNT))
        if self.kind == "single" and (self.phase_difference, self.ratio) != (_QUARTER, 1.0):
            name = "ratio" if self.ratio != 1 else "phase_difference"
            raise ParameterError(name, getattr(self, name), "none where the schedule is single: B is not driven")

    def counts(self, drive: Drive) -> tuple[int, int]:
        """Drive periods in a cycle, m, and how many of them a phase is driven, n.

        Raises
        ------
        ParameterError
            If n is more than m, or less than half of it in pulses.
        """
        if self.kind in ("single", "continuous"):
            return 1, 1
        m, n = (
            int(float(np.asarray(getattr(drive, name))) if getattr(self, name) is None else getattr(self, name))
            for name in ("periods", "on_periods")
        )
        if n > m or (self.kind == "pulses" and 2 * n < m):
            low = "periods/2" if self.kind == "pulses" else "1"
            raise ParameterError("on_periods", n, f"an integer from {low} to periods, with periods = {m}")
        return m, n

    def gates(self, drive: Drive) -> Array:
        """Whether A and B are driven, 1 or 0, in each drive period of a cycle, (m, 2).

        Parameters
        ----------
        drive : Drive
            Whose periods and on_periods count where the schedule has none.
        """
        found = self.symbols(drive)
        period = np.arange(found["m"])
        off = [(period >= found[f"off_{phase}"]) & (period < found[f"on_{phase}"]) for phase in "AB"]
        return (1 - np.stack(off, axis=1)).astype(np.float64)

    def symbols(self, drive: Drive) -> dict[str, float]:
        """What a lap needs of it, by the names of the lap's fields.

        Parameters
        ----------
        drive : Drive
            Whose periods, on_periods and phase lead count.
        """
        m, n = self.counts(drive)
        off = {
            "pulses": (0, m - n, m - n, 2 * (m - n)),
            "burst": (n, m, n, m),
            "single": (0, 0, 0, m),
            "continuous": (0, 0, 0, 0),
        }[self.kind]
        of_B = 0.0 if self.kind == "single" else self.voltage * self.ratio
        lead = float(np.asarray(drive.phase_lead))
        quarter = self.phase_difference == _QUARTER  # whose cosine is no exact 0
        return {
            "m": float(m),
            **dict(zip(("off_A", "on_A", "off_B", "on_B"), map(float, off), strict=True)),
            # at the cycle's end, where what is off does not come back to it holds no charge
            "driven_A": float(not off[0] < m <= off[1]),
            "driven_B": float(not off[2] < m <= off[3]),
            "pull_A": 0.0,
            "pull_B": 0.0,
            "force_A": self.voltage,
            "force_B_along": 0.0 if quarter else of_B * math.cos(self.phase_difference),
            "force_B_ahead": lead * of_B * (1.0 if quarter else math.sin(self.phase_difference)),
        }
