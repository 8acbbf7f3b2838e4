"""The rule that steps phases, contact and rotor through time: Dormand and Prince's pair of orders 5 and 4.

J. Comp. Appl. Math. 6 (1980) 19.  The last stage is where the step ends; the proofs of the tables try every condition
that both orders ask for.
"""

from __future__ import annotations

import sympy as sp

__all__ = ["error_weights", "nodes", "stages"]

_STAGES = (
    "",
    "1/5",
    "3/40 9/40",
    "44/45 -56/15 32/9",
    "19372/6561 -25360/2187 64448/6561 -212/729",
    "9017/3168 -355/33 46732/5247 49/176 -5103/18656",
    "35/384 0 500/1113 125/192 -2187/6784 11/84",
)
_FOURTH = "5179/57600 0 7571/16695 393/640 -92097/339200 187/2100 1/40"


def _row(text: str) -> list[sp.Rational]:
    numbers = [sp.Rational(number) for number in text.split()]
    return numbers + [sp.Integer(0)] * (len(_STAGES) - len(numbers))


def stages() -> sp.Matrix:
    """Rows i: weights of the rates at the stages before in stage i; the last row adds up a step, to order 5."""
    return sp.Matrix([_row(text) for text in _STAGES])


def nodes() -> list[sp.Rational]:
    """Where in a step its stages are, as shares of it."""
    return [sum(stages().row(i)) for i in range(stages().rows)]


def error_weights() -> list[sp.Rational]:
    """Of the rates in how far a rule of order 4 over the same stages is from that of order 5."""
    last = stages().row(stages().rows - 1)
    return [sp.Rational(a - b) for a, b in zip(last, _row(_FOURTH), strict=True)]
