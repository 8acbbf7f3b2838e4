"""What a claim is checked with: the readings, the phases of Sect. 5, the ranges of what the paper does not give."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import STARTS, Drive, Start
from trum_sym.inputs.motor import Motor
from trum_sym.model.cycle import cycle_sums, modal_values, response
from trum_sym.model.kernels import call
from trum_sym.model.levels import Compliance, Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import solve_orbit
from trum_sym.paper.published import BOX
from trum_sym.paper.readings import (
    DEFAULT,
    LEADS,
    LOAD_INERTIA,
    PHASES,
    POINTS,
    RIG,
    Readings,
    encoder_deviations,
)

__all__ = [
    "ASSUMED",
    "LOADS",
    "SAMPLED",
    "Beat",
    "ByInertia",
    "Check",
    "Context",
    "Finding",
    "Truth",
    "by_load",
    "falls",
    "of_rotor",
    "rank_correlation",
    "rises",
    "spans",
    "together",
]

ASSUMED = {"friction_coefficient": (0.2, 0.3), "contact_radius": (0.025, 0.030)}
"""Ranges of what the paper does not give and the rotor's speed depends on, from ``trum60.toml``."""
SAMPLED = {"mean_speed": "mean_speed", "speed_volatility": "encoder_volatility"}
"""What was measured in place of a figure of the speed itself; the mean of all readings is the speed's own mean."""


Truth = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


@dataclass(frozen=True)
class ByInertia:
    """Where a claim on the rotor holds, at each load's inertia.

    Attributes
    ----------
    holds : (load's inertia, start, phase lead, switching phase, level)
    corners : the same over the corners of ``ASSUMED``, at the default level; None if they were not computed
    speed_holds, speed_corners : the same of the rotor without a load, with the speed itself where ``holds`` has what
        an encoder reads; the first row of the others if it says nothing of the volatility
    measured : whether the sentence is about the motor that was measured, which pulls a weight, and not its simulation
    correlation : (load's inertia, start, phase lead), a rank correlation at the default level if the claim is about
        one; the last two of the speed itself
    """

    holds: Truth
    corners: Truth | None
    speed_holds: Truth
    speed_corners: Truth | None
    measured: bool
    correlation: Array | None = None
    speed_correlation: Array | None = None


@dataclass(frozen=True)
class Finding:
    """What was computed for a claim.

    Attributes
    ----------
    holds : array or bool
        Whether the claim holds in each reading: broadcasts to (start, phase lead, switching phase, level).
    computed : what was computed, with its figures
    levels : the levels that the last axis of ``holds`` is about; all if None
    assumed : the same over (start, phase lead, switching phase, corner), where something matters that the paper does
        not give: friction, contact radius, the load's inertia
    assumed_of : what the corners are corners of, in words
    possible : where it holds with some load's inertia; ``holds`` if None
    undecidable : why the paper alone cannot decide it, whatever ``holds`` is
    rotor : the same for each load's inertia
    settings : of a claim that is judged apart from the readings: what was compared, and whether it holds there
    """

    holds: Any
    computed: str
    levels: tuple[int, ...] | None = None
    assumed: Truth | None = None
    assumed_of: str = "friction (0.2 to 0.3) and contact radius (25 to 30 mm)"
    possible: Truth | None = None
    undecidable: str | None = None
    rotor: ByInertia | None = None
    settings: Mapping[str, bool] | None = None


LOADS = f"without a load / with its inertia of {LOAD_INERTIA[1]:.1e} / {LOAD_INERTIA[2]:.1e} kg m^2"
"""What the parts between slashes in :func:`by_load` and :func:`spans` are."""
_LOAD_SPAN = f"{LOAD_INERTIA[1]:.1e} to {LOAD_INERTIA[-1]:.1e} kg m^2"


def of_rotor(found: ByInertia, computed: str, levels: tuple[int, ...], undecidable: str | None = None) -> Finding:
    """A finding from where a claim on the rotor holds.

    What is said of the measured motor is judged with the load's inertia that it had, which is known as a range only;
    what is said of the simulation with that of the rotor, as in eq. 38.
    """
    if not found.measured:
        return Finding(
            found.holds[0],
            computed,
            levels,
            found.corners if found.corners is None else found.corners[0],
            undecidable=undecidable,
            rotor=found,
        )
    ends = found.holds[RIG]
    if found.corners is None:
        corners, of = np.moveaxis(ends, 0, -1).reshape(*ends.shape[1:4], -1), f"load's inertia ({_LOAD_SPAN})"
    else:
        corners = np.moveaxis(found.corners[RIG], 0, -1).reshape(*ends.shape[1:4], -1)
        of = f"friction (0.2 to 0.3), contact radius (25 to 30 mm) and load's inertia ({_LOAD_SPAN})"
    return Finding(ends.all(axis=0), computed, levels, corners, of, np.asarray(ends.any(axis=0)), undecidable, found)


def by_load(values: Array, form: str) -> str:
    """Values by (load's inertia, start, phase lead) in words, those of a reading parted by slashes as in ``LOADS``."""
    return "; ".join(
        f"{start} {lead:+.0f}: {' / '.join(f'{value:{form}}' for value in values[:, i, j])}"
        for i, start in enumerate(STARTS)
        for j, lead in enumerate(LEADS)
    )


def spans(values: Array, form: str) -> str:
    """The span of values at each load's inertia, parted by slashes."""
    return " / ".join(f"{np.nanmin(row):{form}} to {np.nanmax(row):{form}}" for row in values)


def rises(values: Array) -> Truth:
    """Whether every step along the last axis goes up."""
    return np.asarray(np.all(np.diff(values, axis=-1) > 0, axis=-1))


def falls(values: Array) -> Truth:
    """Whether every step along the last axis goes down."""
    return np.asarray(np.all(np.diff(values, axis=-1) < 0, axis=-1))


def together(a: Array, b: Array) -> Truth:
    """Whether every step along the last axis goes the same way in both."""
    return np.asarray(np.all(np.sign(np.diff(a, axis=-1)) == np.sign(np.diff(b, axis=-1)), axis=-1))


def rank_correlation(a: Array, b: Array) -> Array:
    """Spearman's rank correlation along the last axis, NaN where a value is missing."""
    ranks = [np.argsort(np.argsort(values, axis=-1), axis=-1).astype(float) for values in (a, b)]
    x, y = (rank - rank.mean(axis=-1, keepdims=True) for rank in ranks)
    found = (x * y).sum(axis=-1) / np.sqrt((x * x).sum(axis=-1) * (y * y).sum(axis=-1))
    known = np.isfinite(a).all(axis=-1) & np.isfinite(b).all(axis=-1)
    return np.where(known, found, np.nan)


@dataclass(frozen=True)
class Beat:
    """Phases and determinant over a stretch of a cycle, the last axis being time."""

    time: Array
    w_A: Array
    w_B: Array
    v_A: Array
    v_B: Array
    Q: Array


class Context:
    """The motor, all readings, and further computations, each made once when first asked for."""

    def __init__(self, motor: Motor, readings: Readings) -> None:
        self.motor = motor
        self.readings = readings

    def beat(self, pulses: tuple[int, int], region: int, span: float, samples: int, all_levels: bool = False) -> Beat:
        """A region at 180 N and 3000 Hz from its start on, at the default level or at all.

        ``pulses`` are m and n; regions 0, 1, 2 are T_redu, T_addredu, T_add; ``span`` is how many beats to cover, the
        whole region if infinite; ``samples`` are those of a drive period.
        """
        resonance = self.readings.resonance_frequency[:, POINTS.table_3, None]
        if not all_levels:
            resonance = resonance[[DEFAULT]]
        found = [self._of_start(start, resonance, pulses, region, span, samples) for start in STARTS]
        return Beat(*(np.stack(column) for column in zip(*found, strict=True)))

    def _of_start(
        self, start: Start, resonance: Array, pulses: tuple[int, int], region: int, span: float, samples: int
    ) -> tuple[Array, ...]:
        difference = 3000.0
        drive = Drive(
            frequency_difference=difference,
            periods=pulses[0],
            on_periods=pulses[1],
            start=start,
            phase_lead=np.array(LEADS)[:, None, None, None],
            switching_phase=np.array([*PHASES.values()])[:, None, None],
        )
        values = modal_values(2 * np.pi * resonance, self.motor.damping_ratio.value, drive)
        regions = call("trum_regions", values)
        lengths = [np.asarray(regions[f"time_{name}"]) for name in ("redu", "addredu", "add")]
        begin = np.sum(lengths[:region], axis=0) if region else np.zeros_like(lengths[0])
        length = np.minimum(lengths[region], span / difference)
        count = int(np.ceil(samples * float(np.max(length * (resonance + difference)))))
        time = begin + length * (np.arange(count) + 0.5) / count
        found = response(time, values)
        shape = np.shape(found["Q"])
        return (
            np.broadcast_to(time - begin, shape),
            *(np.asarray(found[k]) for k in ("w_A", "w_B", "v_A", "v_B", "Q")),
        )

    @cached_property
    def ranges(self) -> Mapping[str, Array]:
        """Table 3's and the other drives at the corners of ``ASSUMED``.

        Figures by (load's inertia, start, phase lead, switching phase, corner, point).
        """
        corners = np.array(list(itertools.product(*ASSUMED.values())))
        motor = self.motor.with_values({name: corners[:, i, None] for i, name in enumerate(ASSUMED)})
        return self.loaded(motor, POINTS.prepressure, POINTS.difference)

    def loaded(
        self,
        motor: Motor,
        prepressure: Array,
        difference: Array,
        inertia: Array = LOAD_INERTIA,
        load_torque: float = 0.3,
        phases: tuple[float, ...] = (*PHASES.values(),),
    ) -> Mapping[str, Array]:
        """Figures of :meth:`evaluated` by (load's inertia, start, phase lead, switching phase, ...)."""
        rest = np.broadcast_shapes(*(np.shape(p.value) for _, p in motor.parameters()), np.shape(prepressure))
        total = np.asarray(motor.rotor_inertia.value) + inertia.reshape(-1, *(1,) * len(rest))
        found = self.evaluated(
            motor.with_values({"rotor_inertia": total}), prepressure, difference, load_torque, phases
        )
        return {name: np.moveaxis(value, 3, 0) for name, value in found.items()}

    def evaluated(
        self,
        motor: Motor,
        prepressure: Array,
        difference: Array,
        load_torque: float = 0.3,
        phases: tuple[float, ...] = (*PHASES.values(),),
    ) -> Mapping[str, Array]:
        """Figures by (start, phase lead, switching phase, ...), the rest as motor and drive broadcast."""
        inner = np.broadcast_shapes(*(np.shape(p.value) for _, p in motor.parameters()), np.shape(prepressure))
        outer = (-1, 1, *(1,) * len(inner))
        parts = []
        for start in STARTS:
            setting = Drive(
                prepressure=prepressure,
                frequency_difference=difference,
                start=start,
                phase_lead=np.array(LEADS).reshape(outer),
                switching_phase=np.array(phases).reshape(outer[:1] + outer[2:]),
                load_torque=load_torque,
            )
            parts.append(self.figures(motor, setting))
        return {name: np.stack([part[name] for part in parts]) for name in parts[0]}

    @staticmethod
    def figures(
        motor: Motor,
        drive: Drive,
        tolerance: float = 1e-4,
        encoder: bool = True,
        compliance: Compliance = "layer",
    ) -> dict[str, Array]:
        """Determinants and the rotor's figures at the default levels; what an encoder reads is NaN unless wanted."""
        levels = Levels("winkler", "quartic", "harmonic", "measured", compliance)
        case = prepare(motor, drive, levels, tolerance, warn=False)
        arguments = {**case.arguments, "held": 0.0}
        orbit = solve_orbit(arguments, case.symbols)
        time = np.broadcast_to(np.asarray(call("trum_drive", case.values)["T"]), case.shape)
        arrays = {name: np.asarray(value) for name, value in arguments.items()}
        read = encoder_deviations(arrays, orbit.raw, time) if encoder else np.full(case.shape, np.nan)
        read = read / np.asarray(case.symbols["r_c"])
        size = np.abs(orbit.mean_speed)
        found = {
            **cycle_sums(case.values),
            "mean_speed": orbit.mean_speed,
            "encoder_volatility": read / size,
            "speed_volatility": np.sqrt(orbit.variance) / size,
            "swing": orbit.max_speed - orbit.min_speed,
        }
        return {name: np.broadcast_to(np.asarray(value), case.shape) for name, value in found.items()}

    @cached_property
    def box(self) -> Mapping[str, Array]:
        """The default level over the paper's box, 160 to 210 N and 2800 to 3300 Hz; the last axis is its points."""
        force, difference = np.meshgrid(
            *(np.linspace(*BOX[name], 6) for name in ("prepressure", "frequency_difference"))
        )
        return self.loaded(self.motor, force.ravel(), difference.ravel())

    @cached_property
    def beyond(self) -> Mapping[str, Array]:
        """The same beyond it: 100 to 220 N and -5000 to 5000 Hz without resonance itself."""
        force, difference = np.meshgrid(np.linspace(100, 220, 7), np.linspace(-5000, 5000, 8))
        return self.loaded(self.motor, force.ravel(), difference.ravel())


Check = Callable[[Context], Finding]
"""What a claim is checked by."""
