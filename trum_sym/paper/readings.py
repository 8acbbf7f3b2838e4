"""Every reading of the conventions that the paper leaves open, at every drive that it reports results for.

A reading says in what state a cycle begins, which phase leads, at which phase of the drive it is switched, which
contact law, resonance, foundation and amplitude hold.  None is fitted; all are computed alike.
"""

from __future__ import annotations

import itertools
import math
import os
import warnings
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError, ValidityWarning
from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import STARTS, Drive, Start
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.batch import call_in_blocks
from trum_sym.model.cycle import PANELS_PER_PERIOD, modal_values, scaled
from trum_sym.model.kernels import call
from trum_sym.model.levels import AMPLITUDES, CONTACTS, FOUNDATIONS, RESONANCES, Levels
from trum_sym.model.rotor import encoder_deviation, history, orbit_values, solve_orbit
from trum_sym.model.stator import solve_stator
from trum_sym.paper.published import ENCODER, TABLE_5

__all__ = [
    "AXES",
    "COMBINATIONS",
    "DEFAULT",
    "LEADS",
    "LOAD_INERTIA",
    "PHASES",
    "POINTS",
    "RIG",
    "ROTOR_LEVELS",
    "TABLE_4",
    "Points",
    "Readings",
    "axis_words",
    "encoder_deviations",
    "published",
    "readings",
]

MEASURED = "39703 Hz"
LEADS = (1.0, -1.0)
PHASES = {"A at its crest at t1 (eqs. 18, 23)": 0.0, "B at its crest at t1 (eq. 10)": math.pi / 2}
"""Switching phases that the text writes down; half a turn more changes the sign of both phases and nothing else."""

COMBINATIONS = tuple(
    (contact, resonance, foundation, amplitude)
    for contact in CONTACTS
    for resonance in (*RESONANCES, MEASURED)
    for foundation in (FOUNDATIONS if resonance != MEASURED else ("any",))
    for amplitude in AMPLITUDES
)
AXES = ("start", "phase lead", "switching phase", "contact", "resonance", "foundation", "amplitude")
ROTOR_LEVELS = tuple(
    i for i, level in enumerate(COMBINATIONS) if level[1:3] in (("quartic", "harmonic"), (MEASURED, "any"))
)
"""The levels at which the rotor is computed at every drive; at Table 3's it is at all levels."""
DEFAULT = COMBINATIONS.index(("winkler", "quartic", "harmonic", "measured"))
TABLE_4 = ("q_average", "q_volatility", "mean_speed", "speed_volatility")

_DIFFERENCES = np.arange(2800.0, 3301.0, 100.0)
_FORCES = np.arange(160.0, 211.0, 10.0)
LOAD_INERTIA = np.array([0.0, *(load_motor("trum60").bench["load_inertia"].range or ())])
"""What the load adds to the rotor's moment of inertia, kg m^2: nothing, and the ends of what the motor file states for
the torque plate of Sect. 8.1.  The weight's own is not felt within a cycle (entry load-inertia of the ledger): its
string would have to be a thousand times as stiff as a wire.  If it were, 9.2e-4 would come on top at 30 mm."""
RIG = slice(1, None)
"""The values of ``LOAD_INERTIA`` between which the measured motor's lies."""
_SAMPLES = 64  # of a drive period, of the path that the encoder differences
_BLOCK = 128  # paths at a time, which bounds the memory
_OF_ROTOR = ("mean_speed", "speed_volatility", "encoder_volatility")
_TOLERANCE = 1e-4


@dataclass(frozen=True)
class Points:
    """The drives of the paper's results: prepressure (N), frequency difference (Hz), and where each group stands."""

    prepressure: Array
    difference: Array
    table_3: int
    figure_21: slice
    figure_23: slice
    figure_32: slice
    figure_31: slice


def _points() -> Points:
    groups = [
        (np.array([180.0]), np.array([3000.0])),
        (np.full(_DIFFERENCES.size, 180.0), _DIFFERENCES),
        (_FORCES, np.full(_FORCES.size, 3000.0)),
        (TABLE_5["prepressure"], TABLE_5["frequency_difference"]),
        (_FORCES, np.full(_FORCES.size, 3300.0)),
    ]
    ends = np.cumsum([group[0].size for group in groups])
    slices = [slice(int(low), int(high)) for low, high in itertools.pairwise([0, *ends])]
    force, difference = (np.concatenate(column) for column in zip(*groups, strict=True))
    return Points(force, difference, 0, *slices[1:])


POINTS = _points()


def published(motor: Motor) -> dict[str, float]:
    """What the paper prints for Table 3's drive, in SI units.

    Raises
    ------
    ParameterError
        If the motor file publishes no such figures: the claims are about the paper's motor.
    """
    scale = {"arcsec/s": ARCSEC, "%": 0.01}
    found = {p.output: p.value * scale.get(p.unit, 1.0) for p in motor.published}
    for name in ("resonance_frequency", *TABLE_4):
        if name not in found:
            raise ParameterError("motor", motor.name, f"a motor file that publishes {name}, as trum60 does")
    return found


def axis_words() -> dict[str, tuple[str, ...]]:
    """The conventions by axis, in words; the last four come in the combinations of ``COMBINATIONS``."""
    of_levels = {name: tuple(dict.fromkeys(level[i] for level in COMBINATIONS)) for i, name in enumerate(AXES[3:])}
    return {
        "start": STARTS,
        "phase lead": tuple(f"{s:+.0f}" for s in LEADS),
        "switching phase": tuple(PHASES),
        **of_levels,
    }


@dataclass(frozen=True)
class Readings:
    """Figures of all readings by start, phase lead, switching phase, level of ``COMBINATIONS`` and point of ``POINTS``.

    Attributes
    ----------
    paper : Table 4 and the measured resonance, SI units
    resonance_frequency, amplitude : (level, point), Hz and m
    figures : q_average, q_volatility (1/s), q_plus, q_minus (m^2, integrals of Q over a cycle), q_square_ratio
    loaded : mean_speed (rad/s), speed_volatility (1, of the speed itself), encoder_volatility (1, of what the encoder
        reads that averages over 2 ms), with the load's inertia of ``LOAD_INERTIA`` as another first axis
        NaN at other drives than Table 3's unless the level is one of ``ROTOR_LEVELS``
    """

    paper: Mapping[str, float]
    resonance_frequency: Array
    amplitude: Array
    figures: Mapping[str, Array]
    loaded: Mapping[str, Array]

    @cached_property
    def off(self) -> dict[str, Array]:
        """Differences from Table 4 over its values.

        Determinants by (start, phase lead, switching phase, level); mean speed and volatility, as the encoder reads
        them, by the load's inertia before that.
        """
        table = {name: self.figures[name][..., POINTS.table_3] for name in ("q_average", "q_volatility")}
        table["mean_speed"] = self.loaded["mean_speed"][..., POINTS.table_3]
        table["speed_volatility"] = self.loaded["encoder_volatility"][..., POINTS.table_3]
        return {name: table[name] / self.paper[name] - 1 for name in TABLE_4}

    @cached_property
    def distance(self) -> Array:
        """The larger of both determinants' differences from Table 4; needs no friction and no contact radius."""
        found: Array = np.maximum(np.abs(self.off["q_average"]), np.abs(self.off["q_volatility"]))
        return found

    def conventions(self, index: tuple[int, ...]) -> dict[str, str]:
        """A reading in words, by axis."""
        start, lead, phase, level = index
        words = axis_words()
        outer = [words[name][i] for name, i in zip(AXES, (start, lead, phase), strict=False)]
        return dict(zip(AXES, [*outer, *COMBINATIONS[level]], strict=True))

    def rows(self) -> list[dict[str, Any]]:
        """One record a reading, nearest first: its conventions, Table 4's figures, their differences in percent.

        Mean speed and volatility are lists, one value for each load's inertia.
        """
        order = np.argsort(self.distance, axis=None, kind="stable")
        found = []
        for flat in order:
            index = tuple(int(i) for i in np.unravel_index(flat, self.distance.shape))
            row: dict[str, Any] = dict(self.conventions(index))
            row["f_n Hz"] = float(self.resonance_frequency[index[-1], POINTS.table_3])
            for name in TABLE_4:
                off = self.off[name][..., index[0], index[1], index[2], index[3]]
                row[name] = ((1 + off) * self.paper[name]).tolist()
                row[f"{name} off %"] = (100 * off).tolist()
            row["distance %"] = 100 * float(self.distance[index])
            row["index"] = index
            found.append(row)
        return found


def _levels(motor: Motor, measured: float) -> tuple[Array, Array, Mapping[str, Any]]:
    """Resonance (Hz) and amplitude (m) by level and point, and the symbols of the section, which all share.

    The measured resonance is taken to hold at Table 3's prepressure, which the paper does not say; from there to other
    prepressures it moves as the default model does.
    """
    drive = Drive(prepressure=POINTS.prepressure, frequency_difference=POINTS.difference)
    resonance, amplitude = np.empty((2, len(COMBINATIONS), POINTS.prepressure.size))
    values: Mapping[str, Any] = {}
    for i, (contact, level, foundation, size) in enumerate(COMBINATIONS):
        model = ("quartic", "harmonic") if level == MEASURED else (level, foundation)
        stator = solve_stator(motor, drive, Levels(contact, *model, size))  # type: ignore[arg-type]
        resonance[i], amplitude[i] = np.asarray(stator.omega_n) / (2 * np.pi), stator.W
        if level == MEASURED:
            resonance[i] += measured - resonance[i, POINTS.table_3]
        values = stator.values
    return resonance, amplitude, values


def readings(motor: Motor, progress: bool = False) -> Readings:
    """Compute every reading.

    Parameters
    ----------
    motor : Motor
        The paper's; single numbers.
    progress : bool
        Whether to show a bar on the standard error.

    Raises
    ------
    ParameterError
        For a motor file without the paper's figures.
    """
    paper = published(motor)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        resonance, amplitude, section = _levels(motor, paper["resonance_frequency"])
    symbols = {**section, **motor.symbols(), "F_c": POINTS.prepressure}
    parts = [_of_start(motor, start, resonance, amplitude, symbols, progress) for start in STARTS]
    figures = {name: np.stack([part[name] for part in parts]) for name in parts[0] if name not in _OF_ROTOR}
    loaded = {name: np.stack([part[name] for part in parts], axis=1) for name in _OF_ROTOR}
    return Readings(paper, resonance, amplitude, figures, loaded)


def _of_start(
    motor: Motor, start: Start, resonance: Array, amplitude: Array, symbols: Mapping[str, Any], progress: bool
) -> dict[str, Array]:
    drive = Drive(
        prepressure=POINTS.prepressure,
        frequency_difference=POINTS.difference,
        start=start,
        phase_lead=np.array(LEADS)[:, None, None, None],
        switching_phase=np.array([*PHASES.values()])[:, None, None],
    )
    values = modal_values(2 * np.pi * resonance, motor.damping_ratio.value, drive)
    timing = call("trum_drive", values)
    sums = call_in_blocks("cycle_sums", {**values, "panels": PANELS_PER_PERIOD})
    figures: dict[str, Array] = {k: np.asarray(v) for k, v in call("trum_measures", {**sums, **timing}).items()}
    size = amplitude**2 * np.asarray(symbols["D"]) * np.asarray(symbols["k_c"])  # Q is bilinear in the phases
    figures |= {name: sums[name] * size for name in ("q_plus", "q_minus")}
    loaded = {**symbols, **drive.symbols()}
    return figures | _rotor(scaled(values, amplitude), loaded, np.asarray(timing["T"]), progress)


def _rotor(values: dict[str, Any], symbols: Mapping[str, Any], cycle_time: Array, progress: bool) -> dict[str, Array]:
    """Speed and volatility by (load's inertia, ...) where they are wanted, NaN elsewhere."""
    inner = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    shape = (LOAD_INERTIA.size, *inner)
    inertia = {**symbols, "J_load": LOAD_INERTIA.reshape(-1, *(1,) * len(inner))}
    by_law = {law: orbit_values(values, inertia, law, _TOLERANCE) for law in CONTACTS}
    hertz = np.array([level[0] == "hertz" for level in COMBINATIONS])[:, None]
    mixed = {name: np.where(hertz, by_law["hertz"][name], by_law["winkler"][name]) for name in ("W_full", "hertz")}
    arguments = {**by_law["winkler"], **mixed, "held": 0.0}
    wanted = np.zeros(shape, bool)
    wanted[..., POINTS.table_3] = True
    wanted[..., ROTOR_LEVELS, :] = True
    chosen = {name: np.broadcast_to(value, shape)[wanted] for name, value in {**inertia, **arguments}.items()}
    orbit = solve_orbit(chosen, chosen, progress)
    time = np.broadcast_to(cycle_time, shape)[wanted]
    read = encoder_deviations(chosen, orbit.raw, time) / np.asarray(symbols["r_c"])
    found = {name: np.full(shape, np.nan) for name in _OF_ROTOR}
    size = np.abs(orbit.mean_speed)
    for name, column in zip(_OF_ROTOR, (orbit.mean_speed, np.sqrt(orbit.variance) / size, read / size), strict=True):
        found[name][wanted] = column
    return found


def encoder_deviations(arguments: Mapping[str, Array], raw: Mapping[str, Array], cycle_time: Array) -> Array:
    """Standard deviation of what an encoder of 2 ms reads, m/s at the rim, of many orbits.

    Parameters
    ----------
    arguments, raw : mappings of arrays of one shape
        Of the orbits, from :func:`orbit_values` and :func:`solve_orbit`.
    cycle_time : array, s
        Of that shape.
    """
    of_path = {**arguments, **{name: raw[name] for name in ("low", "high", "start", "level")}}
    shape = np.shape(cycle_time)
    columns = {name: np.broadcast_to(value, shape).ravel() for name, value in of_path.items()}
    times, result = np.ravel(cycle_time), np.empty(np.size(cycle_time))
    count = int(_SAMPLES * columns["m"][0])

    def run(begin: int) -> None:
        block = {name: column[begin : begin + _BLOCK] for name, column in columns.items()}
        for i, path in enumerate(history(block, block, count)["distance"], begin):
            result[i] = encoder_deviation(path, float(times[i]), ENCODER)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, range(0, result.size, _BLOCK)))
    return result.reshape(shape)
