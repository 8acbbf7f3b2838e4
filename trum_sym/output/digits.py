"""Numbers with an error, printed to the digits that the error leaves."""

from __future__ import annotations

import math

__all__ = ["with_error"]

_MOST = 15  # significant digits of a double that mean something


def with_error(value: float, error: float) -> tuple[str, str]:
    """A value to the last digit that its error leaves, and the error, rounded up to one digit.

    The printed error holds for the printed value: it has room for the rounding of both.

    Parameters
    ----------
    value, error : float
        Of one unit; the error is a bound on the distance from the true value.

    Returns
    -------
    (str, str)
        Value and error with the same number of decimals; ``"-"`` for a value that is not finite, and no text for an
        error that is not known.

    Examples
    --------
    >>> with_error(632.9371, 0.0213)
    ('632.94', '0.03')
    >>> with_error(-475155.31, 3.2)
    ('-475155', '4')
    >>> with_error(1.23e-7, 4e-12)
    ('1.23000e-07', '5e-12')
    """
    if not math.isfinite(value):
        return "-", ""
    if not math.isfinite(error):
        return f"{value:.6g}", ""
    if error <= 0.0:
        return f"{value:.{_MOST}g}", "0"
    place = math.floor(math.log10(error))
    if _units(error, place) > 9:
        place += 1
    rounded = _units(error, place) * 10.0**place
    digits = max(1, min(_MOST, 1 + (math.floor(math.log10(abs(value))) if value else place) - place))
    if value and not -5 <= math.floor(math.log10(abs(value))) < 12:
        return f"{value:.{digits - 1}e}", f"{rounded:.0e}"
    decimals = max(0, -place)
    shown = f"{value:.{decimals}f}" if place < 0 else f"{round(value, -place):.0f}"
    return shown, f"{rounded:.{decimals}f}" if decimals < 7 else f"{rounded:.0e}"


def _units(error: float, place: int) -> int:
    """The error in units of a decimal place, with half a unit for the rounding of the value."""
    return math.ceil(error / 10.0**place + 0.5 - 1e-9)
