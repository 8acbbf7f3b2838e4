"""The errors and warnings that reach a user.  Each is one line that says what to do."""

from __future__ import annotations

__all__ = ["ConvergenceError", "ParameterError", "ValidityWarning"]


def _short(value: object) -> str:
    text = " ".join((value if isinstance(value, str) else repr(value)).split())
    return text if len(text) <= 80 else text[:77] + "..."


class ParameterError(ValueError):
    """Bad input: names the parameter, what it got, and what is allowed in which unit.

    Parameters
    ----------
    name : str
        The parameter, by its public name.
    got : object
        What was given.
    allowed : str
        What is allowed, with its unit.
    """

    def __init__(self, name: str, got: object, allowed: str) -> None:
        self.name = name
        self.got = got
        self.allowed = allowed
        super().__init__(f"{name}: got {_short(got)}, need {allowed}")

    def __reduce__(self) -> tuple[type[ParameterError], tuple[str, object, str]]:
        return type(self), (self.name, self.got, self.allowed)


class ConvergenceError(RuntimeError):
    """A well-posed problem whose iteration did not settle; says which and what to try."""


class ValidityWarning(UserWarning):
    """The input lies outside the range on which an empirical formula was fitted."""
