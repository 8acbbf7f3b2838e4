"""Travelling-wave rotary ultrasonic motors driven at very low speed.

>>> import trum_sym as ts
>>> motor = ts.load_motor("trum60")
>>> point = ts.evaluate(motor, ts.Drive(prepressure=180.0, frequency_difference=3000.0))

Names are loaded on first use, from where ``__init__.pyi`` says, so that the derivations, which share motor files and
units with this package, need no compiled kernels, and ``trum-sym --help`` does not wait for NumPy.
"""

from __future__ import annotations

from lazy_loader import attach_stub

_load, __dir__, __all__ = attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version

        return version("trum-sym")
    return _load(name)
