"""The level of each part of the model: chosen once, passed on as one object.

A new level is a word more in its ``Literal``; a new choice is a field of both classes.  Nothing here needs NumPy, so
that the console can make options of it before anything heavy is loaded.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, Literal, TypedDict, get_args

from trum_sym.errors import ParameterError
from trum_sym.inputs.choices import choice
from trum_sym.values import Value

__all__ = [
    "AMPLITUDES",
    "COMPLIANCES",
    "CONTACTS",
    "COUPLINGS",
    "FOUNDATIONS",
    "LEVEL_NAMES",
    "METHODS",
    "RESONANCES",
    "TANGENTIALS",
    "LevelChoice",
    "Levels",
    "Method",
    "PrescribedChoice",
]

Contact = Literal["winkler", "hertz"]
Resonance = Literal["quartic", "eq6", "printed", "euler"]
Foundation = Literal["harmonic", "smeared", "printed", "none"]
Amplitude = Literal["measured", "forced"]
Compliance = Literal["layer", "flange"]
Tangential = Literal["rigid", "brush"]
Coupling = Literal["none", "contact"]
CONTACTS: tuple[Contact, ...] = get_args(Contact)
RESONANCES: tuple[Resonance, ...] = get_args(Resonance)
FOUNDATIONS: tuple[Foundation, ...] = get_args(Foundation)
AMPLITUDES: tuple[Amplitude, ...] = get_args(Amplitude)
COMPLIANCES: tuple[Compliance, ...] = get_args(Compliance)
TANGENTIALS: tuple[Tangential, ...] = get_args(Tangential)
COUPLINGS: tuple[Coupling, ...] = get_args(Coupling)
Method = Literal["auto", "adaptive", "grid"]
METHODS: tuple[Method, ...] = get_args(Method)
"""How orbits are integrated, which is no level of the model: in steps that end at events, on a grid of equal steps
where its bounds meet the tolerance, or so from the tolerance on at which that is faster."""


_NOT_ALONE = (
    "with it an orbit need not be the only one, so that evaluate, simulate, sensitivities, sweep and spread find each "
    "point's, and this does not (docs/coupling.md)"
)


class PrescribedChoice(TypedDict, total=False):
    """The levels of a wave that is prescribed, as keyword arguments; see :class:`Levels` for their meanings."""

    contact: Contact
    resonance: Resonance
    foundation: Foundation
    amplitude: Amplitude
    compliance: Compliance
    tangential: Tangential


class LevelChoice(PrescribedChoice, total=False):
    """All levels as keyword arguments of the functions that evaluate."""

    coupling: Coupling


def _level(words: tuple[str, ...], text: str) -> Any:  # noqa: ANN401
    return field(default=words[0], metadata={"words": words, "text": text})


@dataclass(frozen=True, eq=False)
class Levels(Value):
    """Which level of each part of the model to use; the first word of each is its default.

    Attributes
    ----------
    contact : {"winkler", "hertz"}
        How the half-angle of the contact follows from the prepressure (eqs. 25 to 31).
    resonance : {"quartic", "eq6", "printed", "euler"}
        Timoshenko's lower root, its truncation, eq. 6 as printed, Euler-Bernoulli.
    foundation : {"harmonic", "smeared", "printed", "none"}
        How the friction layer stiffens the stator.
    amplitude : {"measured", "forced"}
        Eq. 8 on the measured amplitude, or on the derived forced one (eq. 7 put right).
    compliance : {"layer", "flange"}
        What gives in the contact: the friction layer alone (eq. 30), or in series with the stator's teeth and the
        rotor's flange, whose dimensions the motor file then has to hold.  A ``contact_stiffness`` there stands for
        either.
    tangential : {"rigid", "brush"}
        Whether the layer gives way along the circumference: not at all, or as a brush, which is known for the steady
        plain wave alone (both phases always on).
    coupling : {"none", "contact"}
        Whether the rotor acts back on the wave: not at all, so that amplitude and resonance are prescribed, or through
        pressure and friction of the contact (docs/coupling.md, with a table of what takes it).

    Raises
    ------
    ParameterError
        For a word that is none of them, and for levels that do not go together: the paper's Hertz width knows neither
        a stiffness nor a brush.
    """

    contact: Contact = _level(CONTACTS, "Contact law.")
    resonance: Resonance = _level(RESONANCES, "Level of the resonance.")
    foundation: Foundation = _level(FOUNDATIONS, "How the friction layer stiffens the stator.")
    amplitude: Amplitude = _level(AMPLITUDES, "Level of the amplitude.")
    compliance: Compliance = _level(COMPLIANCES, "What gives in the contact.")
    tangential: Tangential = _level(TANGENTIALS, "Whether the layer gives way along the circumference.")
    coupling: Coupling = _level(COUPLINGS, "Whether the rotor acts back on the wave.")

    def __post_init__(self) -> None:
        """Checks every word."""
        for level in fields(self):
            choice(level.name, getattr(self, level.name), level.metadata["words"])
        for name, plain in (("compliance", COMPLIANCES[0]), ("tangential", TANGENTIALS[0])):
            if self.contact == "hertz" and getattr(self, name) != plain:
                raise ParameterError(name, getattr(self, name), f"{plain} where contact is hertz")

    def check_prescribed(self, why: str = _NOT_ALONE) -> None:
        """Raise a ParameterError unless the wave is prescribed, for all that knows no other, and say why."""
        if self.coupling != COUPLINGS[0]:
            raise ParameterError("coupling", self.coupling, f"none: {why}")


LEVEL_NAMES = tuple(level.name for level in fields(Levels))
