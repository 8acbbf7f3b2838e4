r"""Text from outside, a motor's name or a file's, on its way to a terminal, a file or a message: it stays text.

A control character moves a terminal's cursor, ends a comment or a line, or turns what follows around; here it is shown
as Python writes it, ``\x1b``.
"""

from __future__ import annotations

import unicodedata

__all__ = ["one_line", "plain"]

_HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")  # controls, formatting such as bidirectional overrides, surrogates, separators
_KEPT = "\n\u200c\u200d"  # and the joiners of Persian and Indic scripts and of emoji


def plain(text: str) -> str:
    r"""Text with every control character but the newline made visible.

    Examples
    --------
    >>> print(plain("TRUM\x1b[2J-60"))
    TRUM\x1b[2J-60
    """
    if text.isascii() and text.replace("\n", "").isprintable():
        return text
    return "".join(_shown(c) for c in text)


def _shown(character: str) -> str:
    if character in _KEPT or unicodedata.category(character) not in _HIDDEN:
        return character
    return character.encode("unicode_escape").decode("ascii")


def one_line(text: str) -> str:
    r"""The same on one line: white space of any kind is one blank.

    Examples
    --------
    >>> one_line("TRUM-60\n=1+1\0")
    'TRUM-60 =1+1\\x00'
    """
    return plain(" ".join(text.split()))
