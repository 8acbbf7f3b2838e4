"""Spread of a motor: how uncertain parameters of motor and drive spread an operating point's figures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Unpack

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.choices import words
from trum_sym.inputs.distributions import Distribution, checked
from trum_sym.inputs.domain import Spec
from trum_sym.inputs.drive import DRIVE_DOMAINS, Drive
from trum_sym.inputs.motor import COUPLED, FLANGE, SPECS, Motor, Parameter, spec
from trum_sym.inputs.motor_file import load_motor
from trum_sym.inputs.plausible import unquestioned
from trum_sym.inputs.points import check_point, check_single, numbers_of, period_of
from trum_sym.inputs.shown import quantity_of
from trum_sym.inputs.spreads import Spread, read_spread
from trum_sym.inputs.units import parse_quantity
from trum_sym.model.coupled_point import CoupledPoint, check_present
from trum_sym.model.levels import LevelChoice, Levels
from trum_sym.model.operating_point import OperatingPoint, evaluate
from trum_sym.output.result import Result
from trum_sym.quantities import figures_at
from trum_sym.text import one_line
from trum_sym.uncertainty.propagation import check_design, propagate
from trum_sym.uncertainty.result import BALANCED, MISSED, Drawn, Target
from trum_sym.uncertainty.tables import as_dict, as_text

__all__ = ["MOTOR_FILE", "Study", "spread"]

MOTOR_FILE = "motor"  # stands for every parameter that the motor file gives a range or a distribution

_PLAIN = Levels()
_TARGET = re.compile(r"\s*(\w+)\s*(>=|<=|>|<)\s*(.+)", re.DOTALL)


@dataclass(frozen=True, eq=False)
class Study(Result, Drawn):
    """A study of spread: what was drawn, and what it can be turned into.

    Attributes
    ----------
    motor, drive, levels
        The point that is studied.
    distributions : mapping of str to Distribution
        Of the uncertain parameters, as they were given.
    samples, seed : int
    outputs : tuple of str
        The figures that were asked for.
    targets : tuple of Target
    nominal : OperatingPoint
        With every parameter at its own value.
    propagation : Propagation
        All points, all figures there, and indices.
    settled : (d + 2, n) array of bool
        Whether the rotor's orbit met the tolerance, by point.
    """

    def __repr__(self) -> str:
        return f"<Study of {one_line(self.motor.name)}: {', '.join(self.distributions)}; {self.samples} samples>"

    def to_dict(self) -> dict[str, Any]:
        """Inputs, distributions, indices, targets, remarks and units by name, in SI units."""
        return as_dict(self)

    def to_text(self) -> str:
        """All of it, in units that people read; intervals hold at 95 %."""
        return as_text(self)


def _spec_of(name: str) -> Spec:
    if name in DRIVE_DOMAINS:
        domain, unit = DRIVE_DOMAINS[name]
        return Spec(unit, name, domain, required=True)
    if name not in SPECS:  # a name that is no text is refused before
        from difflib import get_close_matches

        close = get_close_matches(name, [*SPECS, *DRIVE_DOMAINS], n=3, cutoff=0.5)
        hint = f"; close names: {', '.join(close)}" if close else ""
        raise ParameterError("spreads", name, f"a number of the motor file or the drive{hint}")
    return spec(name)


def _spreads(parameters: Iterable[tuple[str, Parameter]]) -> dict[str, Distribution]:
    """Distributions of the parameters that have one."""
    return {name: found for name, p in parameters if (found := p.spread()) is not None}


def _uncertain(motor: Motor, levels: Levels) -> dict[str, Distribution]:
    """What the motor file gives a range or a distribution, but for what the levels leave out."""
    counts = levels.compliance == "flange" and motor.contact_stiffness is None
    kept = ("rotor_mass", *(["phase_coverage"] if levels.amplitude == "forced" else []))
    without = [name for name in COUPLED if levels.coupling != "contact" or name not in kept]
    left_out = without if counts else (*without, *FLANGE)
    return _spreads((name, p) for name, p in motor.parameters() if name not in left_out)


def _chosen(
    motor: Motor, drive: Drive, spreads: Mapping[str, Spread] | Sequence[str] | None, levels: Levels
) -> dict[str, Distribution]:
    """The uncertain parameters, as given."""
    uncertain, values = _uncertain(motor, levels), numbers_of(motor, drive)
    of_bench = _spreads(motor.bench.items())
    if spreads is None:
        spreads = [MOTOR_FILE]
    if isinstance(spreads, str) or not isinstance(spreads, Mapping | Sequence):
        raise ParameterError("spreads", spreads, "names, or spreads by name")
    if not isinstance(spreads, Mapping):
        spreads = words("spreads", spreads, "names, or spreads by name") if len(spreads) else ()
    given: dict[str, Spread] = dict(spreads) if isinstance(spreads, Mapping) else dict.fromkeys(spreads)
    chosen: dict[str, Distribution] = {}
    for name, wish in given.items():
        if name == MOTOR_FILE and wish is None:
            chosen = {**uncertain, **chosen}
            continue
        if not isinstance(name, str):
            raise ParameterError("spreads", name, "names of uncertain parameters")
        wanted = _spec_of(name)
        value = float(values.get(name, np.nan))  # an optional one that the motor lacks has no share
        known = uncertain.get(name, of_bench.get(name))
        chosen[name] = read_spread(name, wish, value, wanted.unit, wanted.domain, known)
    if not chosen:
        raise ParameterError("spreads", "none", "at least one; the motor file gives no range or distribution")
    return chosen


def read_target(text: object, levels: Levels = _PLAIN) -> Target:
    found = _TARGET.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise ParameterError("target", text, "OUTPUT >= NUMBER or <=, >, <, such as mean_speed >= 600 arcsec/s")
    output, relation, bound = found.groups()
    _check_output("target", output, levels)
    value = parse_quantity(f"target, {output}", bound, quantity_of(output).unit)
    if not np.isfinite(value):
        raise ParameterError(f"target, {output}", bound, "a finite number")
    return Target(" ".join(str(text).split()), output, relation, value)


def _figures(levels: Levels) -> tuple[str, ...]:
    """That a point has at these levels."""
    return tuple(figures_at(levels.coupling == "contact"))


def _check_output(name: str, output: object, levels: Levels) -> None:
    check_present(name, output, levels)
    if not isinstance(output, str) or output not in _figures(levels):
        raise ParameterError(name, output, f"one of {', '.join(_figures(levels))}")


def _texts(name: str, given: object) -> tuple[str, ...]:
    """One text, or several, each once."""
    if isinstance(given, str):
        return (given,)
    if not isinstance(given, Sequence) or not all(isinstance(text, str) for text in given):
        raise ParameterError(name, given, "text, or a list of it")
    return tuple(dict.fromkeys(given))


def spread(
    motor: Motor | None = None,
    drive: Drive | None = None,
    *,
    spreads: Mapping[str, Spread] | Sequence[str] | None = None,
    samples: int = 1024,
    outputs: Sequence[str] = ("mean_speed", "speed_volatility"),
    target: str | Sequence[str] = (),
    seed: int = 0,
    sampling_period: ArrayLike | None = None,
    tolerance: float = 1e-6,
    progress: bool = False,
    **levels: Unpack[LevelChoice],
) -> Study:
    """How uncertain parameters spread the figures of an operating point, and which of them does it.

    Parameters
    ----------
    motor : Motor, optional
        TRUM-60 if not given.
        Of plain numbers, no arrays; so is the drive.
    drive : Drive, optional
        The paper's Table 3 if not given.
    spreads : mapping or sequence of names, optional
        The uncertain parameters, of motor and drive, taken as independent: by name a share of the value, ``0.1`` or
        ``"10 %"``, two ends, ``(0.2, 0.3)`` or ``"0.2:0.3"``, a :class:`Distribution` or its text,
        ``"normal:180:5"``, or None for what the motor file says.  ``"motor"`` stands for all that the motor
        file gives a range or a distribution, which is the default.
    samples : int
        Rows of the design, a power of two; samples (d + 2) points are computed for d parameters.
    outputs : sequence of str
        Figures of :class:`OperatingPoint`.
    target : str or sequence of str, optional
        What has to hold, such as ``"mean_speed >= 600 arcsec/s"``.
    seed : int
        Of points and bootstrap; the same seed gives the same bits.
    contact, resonance, foundation, amplitude, compliance, tangential, coupling, sampling_period, tolerance, progress
        As for :func:`trum_sym.evaluate`.

    Returns
    -------
    trum_sym.uncertainty.study.Study
        Every point drawn, distributions of the outputs, Sobol' indices, probabilities of missing the targets.

    Raises
    ------
    ParameterError
        For bad input, or an output that no parameter moves.
    MissingExtraError
        Without SciPy.
    ConvergenceError
        As :func:`trum_sym.evaluate` does.

    Notes
    -----
    Sobol' points and indices with bootstrap intervals: docs/tolerance.md.

    Examples
    --------
    >>> import trum_sym as ts
    >>> study = ts.spread(spreads={"prepressure": "1 %"}, samples=64, outputs=("amplitude",))
    >>> study
    <Study of TRUM-60: prepressure; 64 samples>
    """
    samples, seed = check_design(samples, seed)
    motor = load_motor() if motor is None else motor
    drive = Drive() if drive is None else drive
    check_point(motor, drive)
    period = period_of(sampling_period)
    check_single(numbers_of(motor, drive, period), "one number: a study is of one point")
    outputs, chosen = _texts("outputs", outputs), Levels(**levels)
    for output in outputs:
        _check_output("outputs", output, chosen)
    if not outputs:
        raise ParameterError("outputs", "none", f"at least one of {', '.join(_figures(chosen))}")
    targets = tuple(read_target(text, chosen) for text in _texts("target", target))
    distributions = _chosen(motor, drive, spreads, chosen)
    sampled = {name: checked(name, given, _spec_of(name)) for name, given in distributions.items()}
    nominal: OperatingPoint | CoupledPoint = evaluate(
        motor, drive, tolerance=tolerance, sampling_period=period, **levels
    )
    settled = []

    def figures(point: Mapping[str, Array]) -> dict[str, ArrayLike]:
        of_drive = {name: value for name, value in point.items() if name in DRIVE_DOMAINS}
        of_motor = {name: value for name, value in point.items() if name not in DRIVE_DOMAINS}
        with unquestioned():
            machine = motor.with_values(of_motor)
        found: OperatingPoint | CoupledPoint = evaluate(
            machine,
            replace(drive, **of_drive),  # type: ignore[arg-type]
            tolerance=tolerance,
            progress=progress,
            sampling_period=period,
            **levels,
        )
        values: dict[str, ArrayLike] = {name: np.asarray(getattr(found, name)) for name in _figures(chosen)}
        settled.append(np.asarray(found.converged))
        values[BALANCED] = np.isfinite(values["mean_speed"]).astype(float)
        if targets:
            missed = [target.missed(np.asarray(values[target.output])) for target in targets]
            values[MISSED] = np.any(missed, axis=0).astype(float)
        return values

    found = propagate(
        figures,
        {name: distribution.quantile for name, distribution in sampled.items()},
        samples=samples,
        seed=seed,
        outputs=outputs,
        indicators=(BALANCED, MISSED) if targets else (BALANCED,),
    )
    shape = found.values[BALANCED].shape
    settings = {**asdict(Levels(**levels)), "sampling_period": period}
    return Study(
        motor,
        drive,
        settings,
        distributions,
        samples,
        seed,
        outputs,
        targets,
        nominal,
        found,
        settled[0].reshape(shape),
    )
