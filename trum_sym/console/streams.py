"""What the console prints, on streams that cannot hold every character: GBK, cp932, KOI8-R, ASCII and others.

A character that the stream has no code for is spelt in ASCII: ``um`` for a micrometre, ``^2`` for a square.
"""

from __future__ import annotations

import codecs
import io
import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["spelling_streams", "spelt"]

_ERRORS = "trum-sym.spelt"
_SPELT = {
    **{"µ": "u", "μ": "u", "·": "*", "⋅": "*", "×": "x", "−": "-", "–": "-", "—": "-", "°": "deg", "±": "+-"},
    **{"²": "^2", "³": "^3", "⁻": "-", "√": "sqrt", "∂": "d", "∫": "int", "∑": "sum", "∞": "inf", "′": "'", "″": '"'},
    **{"≤": "<=", "≥": ">=", "≠": "!=", "≈": "~", "→": "->", "“": '"', "”": '"', "‘": "'", "’": "'", "…": "..."},
    **{"∈": "in", "∝": "~", "∘": "o", "§": "Sect.", "█": "#", "ø": "o", "Ø": "O", "ß": "ss", "ı": "i"},
}


def spelt(text: str) -> str:
    """A text in ASCII.

    Examples
    --------
    >>> spelt("5.5 µm, Δf")
    '5.5 um, Deltaf'
    """
    return "".join(character if character.isascii() else _ascii(character) for character in text)


def _ascii(character: str) -> str:
    if character in _SPELT:
        return _SPELT[character]
    name = unicodedata.name(character, "")
    if name.startswith("GREEK "):
        letter = name.rpartition(" LETTER ")[2].split(" ")[0].lower()
        return letter.capitalize() if "CAPITAL" in name else letter
    plain = "".join(c for c in unicodedata.normalize("NFKD", character) if c.isascii())
    return plain or character.encode("ascii", "backslashreplace").decode("ascii")


def _spell(error: UnicodeError) -> tuple[str, int]:
    """What codecs ask for a character that they cannot encode."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return spelt(error.object[error.start : error.end]), error.end


class _Ascii(io.TextIOWrapper):
    """For a stream in ASCII, which Click would take for a mistake and fill with UTF-8."""

    def write(self, text: str) -> int:
        """Spell everything."""
        return super().write(spelt(text) if isinstance(text, str) else text)  # Click tries bytes


@contextmanager
def spelling_streams() -> Iterator[None]:
    """Let the standard streams spell what they cannot encode; as they were at the end."""
    codecs.register_error(_ERRORS, _spell)
    with _spelling("stdout"), _spelling("stderr"):
        yield


@contextmanager
def _spelling(name: str) -> Iterator[None]:
    stream = getattr(sys, name)
    if not isinstance(stream, io.TextIOWrapper):  # takes any character
        yield
    elif codecs.lookup(stream.encoding).name == "ascii":
        stream.flush()
        ours = _Ascii(stream.buffer, "utf-8", line_buffering=stream.line_buffering, write_through=True)
        setattr(sys, name, ours)
        try:
            yield
        finally:
            setattr(sys, name, stream)
            ours.detach()
    else:
        errors = stream.errors
        stream.reconfigure(errors=_ERRORS)
        try:
            yield
        finally:
            if not stream.closed:
                stream.reconfigure(errors=errors)
