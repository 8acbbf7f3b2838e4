"""What an answer was asked for: motor, drive, levels, encoder, tolerance; and the same as a record for programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from trum_sym.errors import MissingExtraError
from trum_sym.inputs.carried import Labels, labels_of
from trum_sym.inputs.checks import ArrayLike
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import SPECS, Motor
from trum_sym.inputs.shown import readable
from trum_sym.model.levels import Levels
from trum_sym.output.result import Result
from trum_sym.quantities import Quantity, known_quantity, unit_of_figure
from trum_sym.text import one_line
from trum_sym.values import Value

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["SCHEMA", "Inputs", "Point", "remarks_of", "units_of"]

SCHEMA = 1
"""Version of the records; it rises when a name changes its meaning or goes."""


_SWINGS = 100.0  # times the mean: beyond, it is said


@dataclass(frozen=True, eq=False)
class Inputs(Value):
    """Everything that decides about an operating point.

    Attributes
    ----------
    motor : Motor
    drive : Drive
    levels : Levels
    sampling_period : float or array, s, or None
        The encoder's; None for the continuous speed.
    tolerance : float
        Of the rotor's speeds, relative to the largest: what was asked for, or what it came to where nothing was.
    """

    motor: Motor
    drive: Drive
    levels: Levels
    sampling_period: ArrayLike | None = None
    tolerance: float | None = None

    def __repr__(self) -> str:
        return f"<Inputs {one_line(self.motor.name)}, {self.drive!r}>"

    def record(self) -> dict[str, Any]:
        """All of it by name, in SI units: what ``--point`` reads."""
        from importlib.metadata import version

        return {
            "schema": SCHEMA,
            "trum_sym": version("trum-sym"),
            "motor": self.motor.name,
            "motor_values": {name: _plain(p.value) for name, p in self.motor.parameters()},
            "assumed": {name: p.range for name, p in self.motor.assumed().items()},
            "box": {name: [allowed.low, allowed.high] for name, allowed in self.motor.box.items()},
            "allowed": {name: [allowed.low, allowed.high] for name, allowed in self.motor.allowed.items()},
            "spreads": {name: [off.value, off.share] for name, off in self.motor.spreads.items()},
            "drive": {f.name: _plain(getattr(self.drive, f.name)) for f in fields(Drive)},
            "levels": asdict(self.levels),
            "sampling_period": None if self.sampling_period is None else _plain(self.sampling_period),
            "tolerance": self.tolerance,
        }


def _plain(value: Any) -> Any:  # noqa: ANN401
    return value.tolist() if isinstance(value, np.ndarray) else value


class Point(Result, Value):
    """What operating points share, at whatever level: their figures by name, as record, text, data set and frame.

    A class of them is a dataclass with ``inputs`` and ``mean_speed`` among its fields.
    """

    inputs: Inputs
    quantities: ClassVar[Mapping[str, Quantity]] = {}
    """Label and units of the figures that people read, in order."""
    unlisted: ClassVar[tuple[str, ...]] = ("inputs",)
    """Fields that are no figures."""
    shared: ClassVar[tuple[str, ...]] = ("motor",)
    """Figures that are the same for all points of an array."""

    def __repr__(self) -> str:
        speed, about = np.asarray(self.figures["mean_speed"]), one_line(self.inputs.motor.name)
        if speed.ndim:
            return f"<{type(self).__name__} {about}, array of shape {speed.shape}>"
        state = "converged" if self.figures["converged"] else f"not converged: {self.figures['reason']}"
        return f"<{type(self).__name__} {about}, mean_speed {float(speed):.6g} rad/s, {state}>"

    @property
    def figures(self) -> dict[str, Any]:
        """The figures by name, in the order of the fields; without ``inputs``."""
        names = (field.name for field in fields(self))  # type: ignore[arg-type]  # every subclass is a dataclass
        return {name: getattr(self, name) for name in names if name not in self.unlisted}

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of every figure that has one."""
        return units_of(self.figures)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the figures of a single point do not say by themselves."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Inputs, figures, remarks and units by name, in SI units: what ``--point`` reads."""
        found = {**self.inputs.record(), **{k: _plain(v) for k, v in self.figures.items()}, "remarks": self.remarks}
        return {**found, "units": units_of(found)}

    def to_text(self) -> str:
        """The figures with their units, a line each; of arrays the range."""
        lines = []
        for name, quantity in self.quantities.items():
            values = np.asarray(getattr(self, name), np.float64)
            low, high = (readable(name, float(x)) for x in (np.nanmin(values), np.nanmax(values)))
            value = f"{low:.6g}" if not values.ndim else f"{low:.6g} to {high:.6g}"
            lines.append(f"{name:<20} {value} {'' if quantity.shown == '1' else quantity.shown}".rstrip())
        return "\n".join([repr(self), *lines, *(f"remark: {remark}" for remark in self.remarks)])

    def to_xarray(self) -> xr.Dataset:
        """The figures as a labelled data set with units; the inputs are its attributes.

        Dimensions are those of labelled inputs where they name them, else ``dim_0`` and so on.

        Raises
        ------
        MissingExtraError
            Without xarray.
        """
        try:
            import xarray as xr
        except ImportError:
            raise MissingExtraError("to_xarray", "xarray", "data") from None
        figures, settings = self.figures, self.inputs
        shape = np.shape(figures["mean_speed"])
        labels = _labels(settings, len(shape))
        dims = labels.dimensions if labels else tuple(f"dim_{k}" for k in range(len(shape)))
        coords = dict(zip(dims, labels.indices, strict=True)) if labels else {}
        units = self.units
        variables: dict[str, Any] = {}
        for name in (name for name in figures if name not in self.shared):
            known = known_quantity(name)
            attrs = {"units": units[name]} if name in units else {}
            variables[name] = (dims, figures[name], {**attrs, "long_name": known.label if known else name})
        attributes: dict[str, Any] = {name: figures[name] for name in self.shared if name != "contact"}
        attributes["tolerance"] = settings.tolerance
        attributes |= {f"{name}_level": level for name, level in asdict(settings.levels).items()}
        for name, value in settings.drive.numbers().items():
            if np.ndim(value):
                variables.setdefault(name, (dims, np.broadcast_to(value, shape), {"units": _unit_of_input(name)}))
            else:
                attributes.setdefault(name, value)
        return xr.Dataset(variables, {n: index for n, index in coords.items() if index is not None}, attrs=attributes)

    def to_frame(self) -> pd.DataFrame:
        """The figures as a pandas data frame, a row a point; ``attrs["units"]`` has the units.

        Raises
        ------
        MissingExtraError
            Without pandas.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingExtraError("to_frame", "pandas", "data") from None
        shape = np.shape(self.figures["mean_speed"])
        columns = {**self.figures, **self.inputs.drive.numbers()}
        frame = pd.DataFrame({name: np.broadcast_to(value, shape).ravel() for name, value in columns.items()})
        frame.attrs["units"] = {**{name: _unit_of_input(name) for name in self.inputs.drive.numbers()}, **self.units}
        return frame


def _unit_of_input(name: str) -> str:
    return DRIVE_DOMAINS[name][1] if name in DRIVE_DOMAINS else "1"


def _labels(inputs: Inputs, count: int) -> Labels | None:
    """Names of the dimensions, where an input of as many brings them."""
    values = (*inputs.drive.numbers().values(), *(p.value for _, p in inputs.motor.parameters()))
    found = (labels_of(value) for value in values)
    return next((labels for labels in found if labels is not None and len(labels.dimensions) == count), None)


def units_of(record: Mapping[str, Any]) -> dict[str, str]:
    """The SI unit of every number of a record that has one, by name, at any depth."""
    found: dict[str, str] = {}

    def look(entry: object) -> None:
        if isinstance(entry, Mapping):
            for name, value in entry.items():
                unit = _unit(name)
                if unit is not None and not isinstance(value, str | Mapping):
                    found[name] = unit
                look(value)
        elif isinstance(entry, list | tuple):
            for value in entry:
                look(value)

    look(record)
    return found


def _unit(name: str) -> str | None:
    if name in DRIVE_DOMAINS:
        return DRIVE_DOMAINS[name][1]
    return SPECS[name].unit if name in SPECS else unit_of_figure(name)


def remarks_of(figures: Mapping[str, Any], load_torque: float) -> tuple[str, ...]:
    """What the figures of one point do not say by themselves.

    Parameters
    ----------
    figures : mapping
        ``mean_speed`` and ``stall_torque``, and ``reason`` where there is one, in SI units; with coupling no stall
        torque.
    load_torque : float
        In N m.

    Returns
    -------
    tuple of str
        Why an orbit is not converged; that the rotor turns backward, or that the load is more than holds it still.
    """
    found = [str(figures["reason"])] if figures.get("reason") else []
    speed, load = float(figures["mean_speed"]), float(load_torque)
    if not np.isfinite(speed):
        return tuple(found)
    stall = float(figures.get("stall_torque", 0.0))
    if "stall_torque" not in figures:
        if speed * load < 0:
            found.append("the load drives the rotor back")
    elif speed * load < 0 and abs(load) > abs(stall):
        found.append("the load exceeds the stall torque and drives the rotor back")
    elif load * stall > 0 and abs(load) > abs(stall):
        found.append(
            f"the load, {load:g} N*m, exceeds the stall torque, {stall:.4g} N*m: it pulls back a rotor that is held "
            "still; one that is free follows the beats to this speed"
        )
    elif speed * stall < 0:
        found.append("the rotor turns backward, against the direction in which the stator drives it at standstill")
    swing = float(figures.get("max_speed", speed)) - float(figures.get("min_speed", speed))
    if swing > _SWINGS * abs(speed):
        times = f"{swing / abs(speed):.2g} times the mean" if speed else "about a mean of zero"
        found.append(f"the speed swings {times} within a cycle: a small drift of any input outweighs this mean")
    return tuple(found)
