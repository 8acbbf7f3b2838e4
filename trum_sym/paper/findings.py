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
from trum_sym.model.cycle import modal_values, response
from trum_sym.model.kernels import call
from trum_sym.model.operating_point import evaluate
from trum_sym.paper.published import BOX, ENCODER
from trum_sym.paper.readings import DEFAULT, LEADS, PHASES, POINTS, Readings

__all__ = ["ASSUMED", "Beat", "Check", "Context", "Finding", "Truth", "falls", "rank_correlation", "rises", "together"]

ASSUMED = {"friction_coefficient": (0.2, 0.3), "contact_radius": (0.025, 0.030)}
"""Ranges of what the paper does not give and the rotor's speed depends on, from ``trum60.toml``."""


Truth = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


@dataclass(frozen=True)
class Finding:
    """What was computed for a claim.

    Attributes
    ----------
    holds : array or bool
        Whether the claim holds in each reading: broadcasts to (start, phase lead, switching phase, level).
    computed : what was computed, with its figures
    levels : the levels that the last axis of ``holds`` is about; all if None
    assumed : the same over (start, phase lead, switching phase, corner of ``ASSUMED``), where friction or contact
        radius matter
    undecidable : why the paper alone cannot decide it, whatever ``holds`` is
    """

    holds: Any
    computed: str
    levels: tuple[int, ...] | None = None
    assumed: Truth | None = None
    undecidable: str | None = None


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
            frequency_difference=difference, periods=pulses[0], on_periods=pulses[1], start=start,
            phase_lead=np.array(LEADS)[:, None, None, None],
            switching_phase=np.array([*PHASES.values()])[:, None, None],
        )  # fmt: skip
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

        Mean speed and volatility by (start, phase lead, switching phase, corner, point).
        """
        corners = np.array(list(itertools.product(*ASSUMED.values())))
        motor = self.motor.with_values({name: corners[:, i, None] for i, name in enumerate(ASSUMED)})
        return self.evaluated(motor, POINTS.prepressure, POINTS.difference)

    def evaluated(
        self,
        motor: Motor,
        prepressure: Array,
        difference: Array,
        sampling_period: float | None = None,
        load_torque: float = 0.3,
    ) -> Mapping[str, Array]:
        """Figures by (start, phase lead, switching phase, ...), the rest as motor and drive broadcast."""
        found: dict[str, list[Array]] = {}
        for start in STARTS:
            drive = Drive(
                prepressure=prepressure, frequency_difference=difference, start=start,
                phase_lead=np.array(LEADS)[:, None, None, None],
                switching_phase=np.array([*PHASES.values()])[:, None, None], load_torque=load_torque,
            )  # fmt: skip
            point = evaluate(motor, drive, tolerance=1e-4, sampling_period=sampling_period)
            for name in ("q_average", "q_volatility", "q_ratio", "mean_speed", "speed_volatility"):
                found.setdefault(name, []).append(np.asarray(getattr(point, name)))
        return {name: np.stack(parts) for name, parts in found.items()}

    @cached_property
    def encoder_ranges(self) -> Array:
        """The same of sigma_s at Table 3's drive as the encoder of 2 ms reads it."""
        corners = np.array(list(itertools.product(*ASSUMED.values())))
        motor = self.motor.with_values({name: corners[:, i] for i, name in enumerate(ASSUMED)})
        found = self.evaluated(motor, np.array(180.0), np.array(3000.0), ENCODER)
        return found["speed_volatility"].reshape(len(STARTS), len(LEADS), len(PHASES), -1)

    @cached_property
    def box(self) -> Mapping[str, Array]:
        """The default level over the paper's box, 160 to 210 N and 2800 to 3300 Hz; the last axis is its points."""
        force, difference = np.meshgrid(
            *(np.linspace(*BOX[name], 6) for name in ("prepressure", "frequency_difference"))
        )
        return self.evaluated(self.motor, force.ravel(), difference.ravel())

    @cached_property
    def beyond(self) -> Mapping[str, Array]:
        """The same beyond it: 100 to 220 N and -5000 to 5000 Hz without resonance itself."""
        force, difference = np.meshgrid(np.linspace(100, 220, 7), np.linspace(-5000, 5000, 8))
        return self.evaluated(self.motor, force.ravel(), difference.ravel())


Check = Callable[[Context], Finding]
"""What a claim is checked by."""
