"""The numeric figures of an operating point: label, units, symbol, meaning, and where they come from.

This is the one table of them: tables, JSON, CSV headers, NetCDF attributes, axes, messages, help and the glossary take
it from here.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

__all__ = [
    "COUPLED",
    "COUPLED_ERRORS",
    "ERRORS",
    "MORE",
    "QUANTITIES",
    "Quantity",
    "figures_at",
    "in_glossary",
    "in_help",
    "known_quantity",
    "unit_of_figure",
]


class Quantity(NamedTuple):
    """How one figure is named and shown.

    ``unit`` is the SI unit that programs read, ``shown`` the one that people read; ``source`` an equation of the paper.
    """

    term: str
    symbol: str
    unit: str
    shown: str
    meaning: str = ""
    source: str = ""

    @property
    def label(self) -> str:
        """The term with its symbol."""
        return f"{self.term} {self.symbol}".rstrip()


QUANTITIES = {
    "resonance_frequency": Quantity(
        "resonance frequency",
        "f_n",
        "Hz",
        "Hz",
        "at which the stator under prepressure vibrates by itself",
        "eq. 6",
    ),
    "drive_frequency": Quantity("drive frequency", "f_q", "Hz", "Hz", "of the voltage on both phases", "eq. 7"),
    "cycle_time": Quantity("cycle time", "T_Qall", "s", "ms", "of the pattern of switching that repeats", "eq. 43"),
    "amplitude": Quantity("amplitude of a phase", "W_maxf", "m", "µm", "steady amplitude of one phase", "eq. 8"),
    "neutral_axis": Quantity(
        "neutral axis",
        "D",
        "m",
        "mm",
        "from the tooth surface to the line of the section that bending leaves as long as it was",
        "eq. 1",
    ),
    "wavenumber": Quantity(
        "wavenumber", "k_c", "1/m", "1/m", "angle of the wave per length of the circumference", "eq. 4"
    ),
    "q_ratio": Quantity(
        "forward over backward",
        "X",
        "1",
        "1",
        "the direction determinant's positive part over the size of its negative part, over a cycle",
        "eq. A14",
    ),
    "q_square_ratio": Quantity(
        "the same of squares", "Y", "1", "1", "that ratio of the determinant's square", "eq. A16"
    ),
    "q_average": Quantity(
        "speed determinant",
        "Q_aver",
        "1/s",
        "1/s",
        "the determinant's positive less its negative part, over their sum and the cycle time: the paper's measure of "
        "the mean speed",
        "eq. 43",
    ),
    "q_volatility": Quantity(
        "volatility determinant",
        "Q_vib",
        "1/s",
        "1/s",
        "the paper's measure of the fluctuation, from the positive and negative parts of the determinant's square",
        "eq. 44",
    ),
    "mean_speed": Quantity(
        "mean speed", "v_s", "rad/s", "arcsec/s", "mean of the rotor's speed over the orbit", "eq. 39"
    ),
    "min_speed": Quantity("lowest speed", "", "rad/s", "arcsec/s", "lowest of the orbit"),
    "max_speed": Quantity("highest speed", "", "rad/s", "arcsec/s", "highest of the orbit"),
    "speed_volatility": Quantity(
        "speed volatility", "sigma_s", "1", "%", "standard deviation of the speed over the size of its mean", "eq. 40"
    ),
    "stall_torque": Quantity(
        "stall torque",
        "",
        "N*m",
        "N*m",
        "mean torque on a rotor that is held still; a load beyond it drives a heavy rotor back, a light one follows "
        "the beats and may still advance",
    ),
    "contact_fraction": Quantity(
        "contact fraction", "", "1", "1", "mean over the cycle of the contact half-angle over pi"
    ),
}

ERRORS = {
    f"{name}_error": Quantity(
        f"{QUANTITIES[name].label}, bound of its error", "", QUANTITIES[name].unit, QUANTITIES[name].shown
    )
    for name in ("mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque")
}
"""Bounds of the errors of the rotor's figures, by the figure's name with ``_error`` after it."""

_SHARED = (
    "resonance_frequency",
    "drive_frequency",
    "cycle_time",
    "neutral_axis",
    "wavenumber",
    "mean_speed",
    "min_speed",
    "max_speed",
    "speed_volatility",
    "contact_fraction",
)
COUPLED = {
    **{name: QUANTITIES[name] for name in _SHARED},
    "free_resonance": Quantity("resonance without a rotor", "f_0", "Hz", "Hz", "of a phase that nothing presses on"),
    "highest_wave": Quantity("highest wave", "", "m", "µm", "highest height of the wave in the cycle"),
    **{
        f"amplitude_{phase}": Quantity(
            f"amplitude of {phase}", "", "m", "µm", f"of the part of {phase}'s displacement that swings with the drive"
        )
        for phase in "AB"
    },
    **{
        f"lag_{phase}": Quantity(
            f"lag of {phase}",
            "",
            "rad",
            "deg",
            f"by which that part is behind {phase}'s modal force; 90 deg at resonance",
        )
        for phase in "AB"
    },
    "input_power": Quantity("input power", "", "W", "W", "mean of what both phases' modal forces put in"),
    "output_power": Quantity(
        "output power", "", "W", "W", "mean of what the load takes; negative where it drives the rotor"
    ),
    "efficiency": Quantity("efficiency", "", "1", "%", "output power over input power, the ceramic's loss left out"),
}
"""The figures of a point whose wave feels the rotor: those that it shares with a prescribed wave's, then its own."""

COUPLED_ERRORS = {
    f"{name}_error": Quantity(f"{quantity.label}, estimate of its error", "", quantity.unit, quantity.shown)
    for name, quantity in COUPLED.items()
    if name not in (*_SHARED[:5], "free_resonance")  # which take no orbit
}
"""Estimates of the errors of its orbit's figures, by the figure's name with ``_error`` after it."""

MORE = {
    "speed_deviation": Quantity("standard deviation of the speed", "", "rad/s", "arcsec/s"),
    "peak_pressure": Quantity("peak pressure", "", "Pa", "MPa", "highest pressure between layer and stator in a cycle"),
    "sampling_period": Quantity(
        "sampling period", "", "s", "ms", "over which an encoder averages the speed", "Sect. 8"
    ),
    "tolerance": Quantity("tolerance", "", "1", "1", "largest bound of the speeds' errors over the largest speed"),
    "constraint_violation": Quantity("constraint violation", "", "1", "1", "the largest, over the constraint's bound"),
    "reachable_speed": Quantity("reachable speed", "", "rad/s", "arcsec/s", "lowest and highest mean speed of the box"),
    "reachable": Quantity("reachable speed", "", "rad/s", "arcsec/s", "lowest and highest mean speed of the box"),
    "floor": Quantity("floor", "", "rad/s", "arcsec/s", "speed that errors are taken of where the speed is smaller"),
    "largest_error": Quantity("largest error seen", "", "1", "%", "over the speed"),
    "swing": Quantity("swing", "", "rad/s", "arcsec/s", "highest less lowest speed"),
    "drift": Quantity("drift", "", "rad/s", "arcsec/s", "of the mean speed by all spreads together, to first order"),
    "worst_speed_error": Quantity("worst speed error", "", "rad/s", "arcsec/s", "in the corners of the spreads"),
    "encoder_deviation": Quantity("standard deviation of an encoder's readings", "", "rad/s", "arcsec/s"),
    "encoder_volatility": Quantity("volatility of an encoder's readings", "", "1", "%", "over the size of the mean"),
    "start_time": Quantity("start time", "", "s", "ms", "from rest under the load until the rotor is at its speed"),
    "return_time": Quantity("return time", "", "s", "ms", "after a disturbance by a tenth of the largest speed"),
    "speed_time": Quantity(
        "time to come to speed", "", "s", "ms", "that a rotor has from rest and after a disturbance"
    ),
}
"""What answers have beside the figures of an operating point."""


def figures_at(coupled: bool) -> dict[str, Quantity]:
    """The figures of a point whose wave feels the rotor, or of one whose wave is prescribed."""
    return COUPLED if coupled else QUANTITIES


def in_help(names: Iterable[str]) -> str:
    """Figures with their SI units, for the end of a command's help."""
    known = {**QUANTITIES, **COUPLED, **MORE}
    return "\b\nFigures:\n" + "\n".join(f"  {n:<20} {known[n].unit:<6} {known[n].label}" for n in names)


def in_glossary() -> str:
    """The figures as rows of the glossary: term, meaning, symbol, unit, equation, name."""
    rows = []
    for name, q in {**QUANTITIES, **COUPLED}.items():
        units = q.unit if q.shown == q.unit else f"{q.unit}, read in {q.shown}"
        meaning = q.meaning[0].upper() + q.meaning[1:]
        rows.append(
            f"| {q.term} | {meaning}. | {q.symbol} | {units} | {q.source.removeprefix('eq. ') or 'ours'} | `{name}` |"
        )
    return "\n".join(rows)


def known_quantity(name: str) -> Quantity | None:
    """Label and units of a figure, None for what is none."""
    tables = (QUANTITIES, ERRORS, MORE, COUPLED, COUPLED_ERRORS)
    return next((table[name] for table in tables if name in table), None)


def unit_of_figure(name: str) -> str | None:
    """The SI unit of a figure, None for what is none."""
    found = known_quantity(name)
    return None if found is None else found.unit
