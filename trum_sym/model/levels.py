"""The level of each part of the model: chosen once, passed on as one object.

A new level is a word more in its ``Literal``; a new choice is a field of both classes.  Nothing here needs NumPy, so
that the console can make options of it before anything heavy is loaded.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, Literal, TypedDict, get_args

from trum_sym.inputs.choices import choice
from trum_sym.values import Value

__all__ = ["AMPLITUDES", "CONTACTS", "FOUNDATIONS", "LEVEL_NAMES", "RESONANCES", "LevelChoice", "Levels"]

Contact = Literal["winkler", "hertz"]
Resonance = Literal["quartic", "eq6", "printed", "euler"]
Foundation = Literal["harmonic", "smeared", "printed", "none"]
Amplitude = Literal["measured", "forced"]
CONTACTS: tuple[Contact, ...] = get_args(Contact)
RESONANCES: tuple[Resonance, ...] = get_args(Resonance)
FOUNDATIONS: tuple[Foundation, ...] = get_args(Foundation)
AMPLITUDES: tuple[Amplitude, ...] = get_args(Amplitude)


class LevelChoice(TypedDict, total=False):
    """The levels as keyword arguments of the functions that evaluate; see :class:`Levels` for their meanings."""

    contact: Contact
    resonance: Resonance
    foundation: Foundation
    amplitude: Amplitude


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

    Raises
    ------
    ParameterError
        For a word that is none of them.
    """

    contact: Contact = _level(CONTACTS, "Contact law.")
    resonance: Resonance = _level(RESONANCES, "Level of the resonance.")
    foundation: Foundation = _level(FOUNDATIONS, "How the friction layer stiffens the stator.")
    amplitude: Amplitude = _level(AMPLITUDES, "Level of the amplitude.")

    def __post_init__(self) -> None:
        """Checks every word."""
        for level in fields(self):
            choice(level.name, getattr(self, level.name), level.metadata["words"])


LEVEL_NAMES = tuple(level.name for level in fields(Levels))
