"""The errors and warnings that reach a user.  Each is one line that says what to do."""

from __future__ import annotations

from trum_sym.text import one_line

__all__ = [
    "ConvergenceError",
    "ImplausibleWarning",
    "MissingExtraError",
    "ParameterError",
    "StaleBuildWarning",
    "UnfinishedError",
    "ValidityWarning",
    "shorten",
]


def shorten(value: object) -> str:
    """What was given, on one line of at most 80 characters."""
    try:
        text = one_line(value if isinstance(value, str) else repr(value))
    except ValueError:  # Python does not print integers of more than 4300 digits
        text = "a number of too many digits"
    except Exception:  # what a stranger's object raises instead of printing itself
        text = f"an object of type {type(value).__name__}"
    text = text or "empty text"
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

    Examples
    --------
    >>> import trum_sym as ts
    >>> try:
    ...     ts.Drive(prepressure="-1 N")
    ... except ts.ParameterError as error:
    ...     print(error)
    prepressure: got -1.0, need a finite number > 0 and < 1e+06 in N
    """

    def __init__(self, name: str, got: object, allowed: str) -> None:
        self.name = name
        self.got = got
        self.allowed = allowed
        super().__init__(f"{one_line(name)}: got {shorten(got)}, need {one_line(allowed)}")

    def __reduce__(self) -> tuple[type[ParameterError], tuple[str, object, str]]:
        import pickle

        try:
            pickle.dumps(self.got)
        except Exception:  # whatever was given may raise anything
            return type(self), (self.name, shorten(self.got), self.allowed)
        return type(self), (self.name, self.got, self.allowed)


class ConvergenceError(RuntimeError):
    """A well-posed problem whose iteration did not settle; says which and what to try.

    Examples
    --------
    >>> import trum_sym as ts
    >>> issubclass(ts.ConvergenceError, RuntimeError)
    True
    """


class UnfinishedError(RuntimeError):
    """Work that stopped before its end, and that the same call goes on with; says why it stopped.

    Raised by :func:`trum_sym.sweep` where a disk is full or a scheduler is lost.

    Examples
    --------
    >>> import trum_sym as ts
    >>> issubclass(ts.UnfinishedError, RuntimeError)
    True
    """


class MissingExtraError(ImportError):
    """A package that the default install does not bring; names what needs it and how to get it.

    Parameters
    ----------
    what, package, extra : str
        What needs the package, the package, and the extra that brings it.

    Examples
    --------
    >>> import trum_sym as ts
    >>> print(ts.MissingExtraError("a picture", "matplotlib", "report"))
    a picture needs matplotlib: pip install 'trum-sym[report]'
    """

    def __init__(self, what: str, package: str, extra: str) -> None:
        self.what, self.package, self.extra = what, package, extra
        super().__init__(f"{what} needs {package}: pip install 'trum-sym[{extra}]'", name=package)

    def __reduce__(self) -> tuple[type[MissingExtraError], tuple[str, str, str]]:
        return type(self), (self.what, self.package, self.extra)


class StaleBuildWarning(UserWarning):
    """The compiled kernels are not those of the sources beside them.

    Examples
    --------
    >>> import warnings
    >>> import trum_sym as ts
    >>> warnings.simplefilter("error", ts.StaleBuildWarning)  # not to compute with them
    """


class ValidityWarning(UserWarning):
    """The input lies outside the range on which an empirical formula was fitted: eq. 8's prepressures (Table 2).

    Examples
    --------
    >>> import warnings
    >>> import trum_sym as ts
    >>> with warnings.catch_warnings(record=True) as said:
    ...     warnings.simplefilter("always")
    ...     point = ts.evaluate(drive=ts.Drive(prepressure="300 N"))
    >>> said[0].category.__name__
    'ValidityWarning'
    """


class ImplausibleWarning(ValidityWarning):
    """A motor's values contradict each other, or no such body has them; says which, and the unit that may be meant.

    Examples
    --------
    >>> import warnings
    >>> import trum_sym as ts
    >>> with warnings.catch_warnings(record=True) as said:
    ...     warnings.simplefilter("always")
    ...     motor = ts.load_motor("trum60").with_values({"beam_young_modulus": 113})  # in GPa, where Pa are meant
    >>> {warning.category.__name__ for warning in said}
    {'ImplausibleWarning'}
    """
