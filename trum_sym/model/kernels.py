"""The compiled kernels, called by the names of their arguments."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from trum_sym.errors import StaleBuildWarning
from trum_sym.inputs.checks import ArrayLike

try:
    from trum_sym import _kernels
except ImportError as error:  # pragma: no cover - an installed package has them
    if error.name != "trum_sym":  # they are there and do not load
        raise
    raise ImportError(
        f"the compiled kernels are not beside {__file__}: this is a source tree; install it with "
        "`pip install -e .`, or leave its folder to use the installed package"
    ) from error

__all__ = ["ORBIT_FLAGS", "SLOPE_FIGURES", "SLOPE_PARAMETERS", "call", "check_build", "expect", "signature"]

_SIGNATURES = {name: (i.split(), o.split()) for name, (i, o) in _kernels.signatures.items()}

# The driver's own names, in its order: bits of an orbit's flags from the lowest, rows and columns of its slopes
ORBIT_FLAGS = tuple(_kernels.orbit_flags.split())
SLOPE_FIGURES = tuple(_kernels.slope_figures.split())
SLOPE_PARAMETERS = tuple(_kernels.slope_parameters.split())


_SOURCES = {"generated": (".c", ".h"), "trum_sym/_driver": (".h", ".hpp", ".inc", ".cpp")}


def check_build(root: Path, made_of: str, built: float) -> None:
    """Warn where the sources of the compiled kernels have changed since they were built.

    Parameters
    ----------
    root : Path
        Of the source tree; of an installed package there is none, and nothing to check.
    made_of : str
        The digest of the sources that the build has kept; CMakeLists.txt says of which.
    built : float
        When; only sources that are newer are looked at.
    """
    if not made_of or not (root / "generated").is_dir():
        return
    files = sorted(
        (file.relative_to(root).as_posix(), file)
        for folder, ends in _SOURCES.items()
        for file in (root / folder).rglob("*")
        if file.suffix in ends
    )
    if max(file.stat().st_mtime for _, file in files) <= built:
        return
    import hashlib

    digests = "".join(hashlib.sha256(file.read_bytes()).hexdigest() for _, file in files)
    if hashlib.sha256(digests.encode()).hexdigest() != made_of:
        warnings.warn(
            "the compiled kernels are older than their sources in generated/ and trum_sym/_driver/: every figure is "
            "that of the old ones; build with `pip install -e .`",
            StaleBuildWarning,
            stacklevel=2,
        )


check_build(Path(__file__).parents[2], getattr(_kernels, "made_of", ""), Path(_kernels.__file__ or "").stat().st_mtime)


def expect(what: str, names: Iterable[str], compiled: Iterable[str]) -> None:
    """Compare names that a module is written for with those of the compiled driver, in any order.

    Raises
    ------
    ImportError
        If they differ: the compiled kernels belong to another version of the package.
    """
    ours, theirs = set(names), set(compiled)
    if ours != theirs:
        raise ImportError(
            f"the compiled kernels are of another version: {what} differ by {', '.join(sorted(ours ^ theirs))}; "
            "install the package anew with `pip install -e .`"
        )


def signature(kernel: str) -> tuple[list[str], list[str]]:
    """The names of a kernel's arguments and outputs, in order."""
    return _SIGNATURES[kernel]


def call(kernel: str, values: Mapping[str, ArrayLike]) -> dict[str, ArrayLike]:
    """Evaluate a kernel; arrays broadcast.

    Parameters
    ----------
    kernel : str
        A name of ``generated/manifest.json``, or of the driver.
    values : mapping
        At least the kernel's arguments, by symbol, in SI units.

    Returns
    -------
    dict
        The kernel's outputs by name.
    """
    inputs, outputs = _SIGNATURES[kernel]
    with np.errstate(all="ignore"):
        results = getattr(_kernels, kernel)(*(values[name] for name in inputs))
    return dict(zip(outputs, results if len(outputs) > 1 else (results,), strict=True))
