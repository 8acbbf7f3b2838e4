"""C source that this package writes: what it refuses to be compiled with, and text of others inside it."""

from __future__ import annotations

from trum_sym.text import one_line

__all__ = ["EXACT_ARITHMETIC", "as_comment"]

EXACT_ARITHMETIC = (
    "#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)",
    '#error "trum: -Ofast, -ffast-math, -ffinite-math-only drop the tests for NaN that refuse input and end searches"',
    "#endif",
)
"""Lines that stop a compiler which was told that no number is NaN or infinite."""


def as_comment(text: str) -> str:
    r"""Text for the inside of a ``/* */`` comment on one line: it cannot end it, begin another, or go on.

    ``/`` beside ``*`` is set apart, and a backslash is written as a slash: at a line's end it would join lines, and
    before a ``u`` name a character.  A question mark after another is set apart, too: trigraphs make backslashes.

    Examples
    --------
    >>> as_comment("a */ b")
    'a * / b'
    """
    text = one_line(text).replace("\\", "/")
    for pair in ("*/", "/*", "??"):
        while pair in text:
            text = text.replace(pair, f"{pair[0]} {pair[1]}")
    return text
