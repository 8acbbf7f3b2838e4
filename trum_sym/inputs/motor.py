"""The motor: a frozen set of parameters, each with its unit, symbol and source."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from trum_sym.errors import ParameterError
from trum_sym.inputs.checks import ArrayLike, broadcast_shape, number
from trum_sym.inputs.distributions import Distribution
from trum_sym.inputs.domain import Domain, Spec
from trum_sym.inputs.plausible import warn_implausible, warn_outside_range
from trum_sym.inputs.units import parse_quantity
from trum_sym.text import one_line
from trum_sym.values import FrozenDict, Value

__all__ = [
    "COUPLED",
    "FLANGE",
    "SPECS",
    "TO_DO",
    "UNCOUPLED",
    "Allowed",
    "Amount",
    "Motor",
    "Parameter",
    "Published",
    "spec",
]

TO_DO = "to do"
"""How the source of a value begins that is a template's and not yet the motor's."""

_POSITIVE = Domain(low=0.0)
_SIZE = Domain(low=0.0, high=10.0)  # m
_VIBRATION = Domain(low=0.0, high=1e-2)  # m
_NOT_NEGATIVE = Domain(low=0.0, low_open=False)
_COUNT = Domain(low=1, low_open=False, integer=True)
_POISSON = Domain(low=-1.0, high=0.5, high_open=False)
_FLANGE_POISSON = Domain(low=0.0, high=0.5, high_open=False)  # not 0, which says in C that it is not given
_REAL = Domain()


@dataclass(frozen=True, eq=False)
class Parameter(Value):
    """One value of a motor file.

    Attributes
    ----------
    value : float or ndarray
        In the SI unit ``unit``.
    unit : str
        SI unit; ``"1"`` for a pure number.
    symbol : str
        The symbol in the equations.
    source : str
        Where the value comes from: ``"Table 1"``, ``"measured ..."``, ``"assumed"``, ``"set"``, ...
    range : (float, float) or None
        For assumed values: what is plausible, in ``unit``.
    reason : str
        For assumed values: why this value and range.
    interval : (float, float) or None
        For calibrated values: the confidence interval, in ``unit``.
    data : str
        For calibrated values: the name of the data.
    distribution : Distribution or None
        How the value spreads, where the motor file says more than a range.

    Examples
    --------
    >>> import trum_sym as ts
    >>> friction = ts.load_motor("trum60").friction_coefficient
    >>> friction.value, friction.source, friction.range
    (0.25, 'assumed', (0.2, 0.3))
    """

    value: ArrayLike
    unit: str
    symbol: str
    source: str
    range: tuple[float, float] | None = None
    reason: str = ""
    interval: tuple[float, float] | None = None
    data: str = ""
    distribution: Distribution | None = None

    def spread(self) -> Distribution | None:
        """How the value spreads: its distribution, else uniform over its range, else None."""
        if self.distribution is not None:
            return self.distribution
        return None if self.range is None else Distribution("uniform", *self.range)


def _p(unit: str, symbol: str, domain: Domain = _POSITIVE) -> Any:  # noqa: ANN401
    return field(metadata={"spec": Spec(unit, symbol, domain, required=True)})


def _optional(unit: str, symbol: str, domain: Domain = _POSITIVE) -> Any:  # noqa: ANN401
    return field(default=None, metadata={"spec": Spec(unit, symbol, domain, required=False)})


@dataclass(frozen=True, eq=False)
class Published(Value):
    """A figure that a publication states for one drive, to be shown beside ours.

    ``sampling_period`` is that of the encoder, in s, where the figure is of an encoder's readings.
    """

    output: str
    value: float
    unit: str
    source: str
    drive: Mapping[str, float]
    sampling_period: float | None = None


@dataclass(frozen=True, eq=False)
class Allowed(Value):
    """The range of a number of the drive that the motor's hardware allows, in its SI unit, and who says so."""

    low: float
    high: float
    source: str


@dataclass(frozen=True, eq=False)
class Amount(Value):
    """How far an input of a motor at work may be off to either side, and who says so.

    ``value`` is in the input's SI unit, or where ``share`` is true a share of the input's own value.
    """

    value: float
    share: bool
    source: str


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Motor(Value):
    """A travelling-wave rotary ultrasonic motor: every number with unit and source.

    The names are those of the motor file and of ``--set``.  The last sixteen are optional: a measured value replaces
    the modelled one, the rotor's flange is needed where its compliance counts, and the last five count where the rotor
    acts back on the wave.  ``bench`` has what the file says of the
    bench that the published figures were measured on, by the names of :class:`trum_sym.Drive`; nothing is computed with
    it unless a drive takes it.  ``box`` has the ranges that searches vary, ``allowed`` those beyond which the hardware
    does not go, ``spreads`` how far inputs of a motor at work may be off.

    Attributes
    ----------
    name : str
    radius, tooth_count, ..., piezo_loss_factor : Parameter
        What docs/motor-file.md lists, with symbols, units and what is allowed; values may be arrays that broadcast.
    bench : mapping of Parameter
        By name, in SI units.
    published : tuple of Published
        Figures of a publication, to be shown beside ours.
    box, allowed : mapping of Allowed
        Ends in SI units, and who says so.
    spreads : mapping of Amount
        Amounts in SI units, or shares of the input's own value.
    text : str
        Of the motor file, whatever was set since.

    Raises
    ------
    ParameterError
        For a value outside its domain, a wrong unit, or sizes that do not fit each other.

    Examples
    --------
    >>> import trum_sym as ts
    >>> motor = ts.load_motor("trum60")
    >>> stiffer = motor.with_values({"layer_young_modulus": "3 GPa"}, source="data sheet")
    >>> stiffer.layer_young_modulus.value
    3000000000.0

    The paper's Table 1 is ``trum60``; :func:`trum_sym.save_motor` writes a changed motor.
    """

    name: str
    # Stator ring: metal beam with teeth
    radius: Parameter = _p("m", "R", _SIZE)
    tooth_count: Parameter = _p("1", "n_s", _COUNT)
    perimeter: Parameter = _p("m", "l_s", _SIZE)
    slot_width: Parameter = _p("m", "b_s", _SIZE)
    beam_width: Parameter = _p("m", "b_e", _SIZE)
    beam_thickness: Parameter = _p("m", "h_e", _SIZE)
    tooth_height: Parameter = _p("m", "h_t", _SIZE)
    beam_density: Parameter = _p("kg/m^3", "rho_e")
    beam_young_modulus: Parameter = _p("Pa", "E_e")
    beam_shear_modulus: Parameter = _p("Pa", "G_e")
    beam_poisson_ratio: Parameter = _p("1", "mu_e", _POISSON)
    # Piezoelectric ring
    piezo_width: Parameter = _p("m", "b_p", _SIZE)
    piezo_thickness: Parameter = _p("m", "h_p", _SIZE)
    piezo_density: Parameter = _p("kg/m^3", "rho_p")
    piezo_young_modulus: Parameter = _p("Pa", "E_p")
    piezo_shear_modulus: Parameter = _p("Pa", "G_p")
    piezo_poisson_ratio: Parameter = _p("1", "mu_p", _POISSON)
    piezo_strain_constant: Parameter = _p("C/N", "d_31", _REAL)
    piezo_compliance: Parameter = _p("m^2/N", "s_11E")
    voltage: Parameter = _p("V", "U_s")
    # Friction layer
    layer_width: Parameter = _p("m", "b_m", _SIZE)
    layer_thickness: Parameter = _p("m", "h_m", _SIZE)
    layer_density: Parameter = _p("kg/m^3", "rho_m")
    layer_young_modulus: Parameter = _p("Pa", "E_m")
    layer_poisson_ratio: Parameter = _p("1", "mu_m", _POISSON)
    # Vibration
    crests: Parameter = _p("1", "n_j", _COUNT)
    shear_correction: Parameter = _p("1", "kappa", Domain(low=0.0, high=1.0, high_open=False))
    damping_ratio: Parameter = _p("1", "xi", Domain(low=0.0, low_open=False, high=1.0))
    free_amplitude: Parameter = _p("m", "W_max", _VIBRATION)
    amplitude_factor: Parameter = _p("1", "C_f")
    amplitude_exponent: Parameter = _p("1", "varsigma", _NOT_NEGATIVE)
    fit_prepressure_min: Parameter = _p("N", "F_min")
    fit_prepressure_max: Parameter = _p("N", "F_max")
    # Contact and rotor
    friction_coefficient: Parameter = _p("1", "mu", _NOT_NEGATIVE)
    contact_radius: Parameter = _p("m", "r_c", _SIZE)
    curvature_radius: Parameter = _p("m", "r_t", _SIZE)
    rotor_inertia: Parameter = _p("kg*m^2", "J", Domain(low=1e-15, high=1e6))
    # A measured value replaces the modelled one
    resonance_frequency: Parameter | None = _optional("Hz", "f_n", Domain(low=0.0, high=1e9))
    amplitude: Parameter | None = _optional("m", "W_maxf", _VIBRATION)
    neutral_axis: Parameter | None = _optional("m", "D", _SIZE)
    wavenumber: Parameter | None = _optional("1/m", "k_c")
    layer_stiffness: Parameter | None = _optional("N/m^2", "k_N")
    contact_stiffness: Parameter | None = _optional("N/m^2", "k_con")
    tangential_stiffness: Parameter | None = _optional("N/m^2", "k_T")
    # The rotor's flange, which carries the friction layer: the level compliance = "flange" needs all four
    flange_thickness: Parameter | None = _optional("m", "h_f", _SIZE)
    flange_length: Parameter | None = _optional("m", "l_f", _SIZE)
    flange_young_modulus: Parameter | None = _optional("Pa", "E_f")
    flange_poisson_ratio: Parameter | None = _optional("1", "mu_f", _FLANGE_POISSON)
    # Of the rotor, the layer and the electrodes: the level coupling = "contact" alone knows them
    rotor_mass: Parameter | None = _optional("kg", "m_r", Domain(low=0.0, low_open=False, high=1e3))
    layer_loss_factor: Parameter | None = _optional("1", "eta_m", Domain(low=0.0, low_open=False, high=1.0))
    phase_coverage: Parameter | None = _optional("1", "c_p", Domain(low=0.0, high=1.0, high_open=False))
    piezo_permittivity: Parameter | None = _optional("F/m", "eps_33T")
    piezo_loss_factor: Parameter | None = _optional("1", "tan_delta", Domain(low=0.0, low_open=False, high=1.0))
    bench: Mapping[str, Parameter] = field(default_factory=FrozenDict)
    published: tuple[Published, ...] = ()
    box: Mapping[str, Allowed] = field(default_factory=dict)  # what searches vary of the drive
    allowed: Mapping[str, Allowed] = field(default_factory=dict)  # what the hardware can be set to
    spreads: Mapping[str, Amount] = field(default_factory=dict)
    text: str = field(default="", repr=False, compare=False)  # of the motor file, whatever was set since

    def __post_init__(self) -> None:
        """Checks every value, and the sizes that must fit each other; warns of what no such motor has."""
        for table in ("box", "allowed", "spreads"):
            object.__setattr__(self, table, FrozenDict(getattr(self, table)))
        if not isinstance(self.name, str):
            raise ParameterError("name", self.name, "the motor's name as text")
        for name, wanted in SPECS.items():
            parameter = getattr(self, name)
            if parameter is None and not wanted.required:
                continue
            if not isinstance(parameter, Parameter):
                raise ParameterError(name, parameter, "a Parameter; with_values takes plain numbers and text")
            for given, allowed in ((parameter.unit, wanted.unit), (parameter.symbol, wanted.symbol)):
                if given != allowed:
                    raise ParameterError(name, given, f"{allowed}, as every {name} has")
            value = number(name, parameter.value, wanted.domain, wanted.unit)
            if value is not parameter.value:
                object.__setattr__(self, name, replace(parameter, value=value))
        if not isinstance(self.bench, Mapping) or not all(isinstance(p, Parameter) for p in self.bench.values()):
            raise ParameterError("bench", self.bench, "a mapping of names to Parameters, as load_motor reads it")
        object.__setattr__(self, "bench", FrozenDict(self.bench))
        broadcast_shape({name: parameter.value for name, parameter in self.parameters()})
        _ordered(self, "tooth_height", "beam_thickness")
        _ordered(self, "fit_prepressure_min", "fit_prepressure_max")
        _ordered(self, "flange_thickness", "beam_thickness")
        _ordered(self, "flange_length", "radius")
        gaps = self.tooth_count.value * self.slot_width.value
        if np.any(gaps >= self.perimeter.value):
            raise ParameterError("slot_width", self.slot_width.value, "less than perimeter / tooth_count")
        warn_implausible(dict(self.parameters()))

    def __repr__(self) -> str:
        count = sum(1 for _ in self.parameters())
        assumed = len(self.assumed())
        return f"<Motor {one_line(self.name)}: {count} parameters, {assumed} of them assumed>"

    def _table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        rows: list[tuple[str, ...]] = [
            (name, p.symbol, f"{p.value}", p.unit, p.source, f"{p.range[0]:g} to {p.range[1]:g}" if p.range else "")
            for name, p in self.parameters()
        ]
        return (self.name, "symbol", "value", "unit", "source", "range"), rows

    def assumed(self) -> dict[str, Parameter]:
        """The parameters that nobody measured, by name: assumed ones, and those of a template that are still to do."""
        return {name: p for name, p in self.parameters() if p.source.casefold().startswith(("assumed", TO_DO))}

    def parameters(self) -> Iterator[tuple[str, Parameter]]:
        """The parameters that are set, by name."""
        for name in SPECS:
            parameter = getattr(self, name)
            if parameter is not None:
                yield name, parameter

    def symbols(self) -> dict[str, ArrayLike]:
        """The values by the symbols of the equations, as the kernels name their arguments."""
        return {parameter.symbol: parameter.value for _, parameter in self.parameters()}

    def with_values(self, values: Mapping[str, float | ArrayLike | str], source: str = "set") -> Motor:
        """A motor with some values replaced; text may carry a unit, ``"26.5 mm"``, and so may a quantity.

        Warns of a value outside the range that its former one was stated with.

        Parameters
        ----------
        values : mapping
            New values by parameter name; plain numbers are in the parameter's SI unit.
        source : str
            Recorded as the new values' source.

        Raises
        ------
        ParameterError
            For an unknown name, or a value outside the parameter's domain.
        """
        changed = {}
        if not isinstance(values, Mapping):
            raise ParameterError("values", values, "a mapping of names of the motor file to values")
        if not isinstance(source, str):
            raise ParameterError("source", source, "text")
        for name, given in values.items():
            wanted = spec(name)
            value = parse_quantity(name, given, wanted.unit) if isinstance(given, str) else given
            checked = number(name, value, wanted.domain, wanted.unit)
            changed[name] = Parameter(checked, wanted.unit, wanted.symbol, source)
            warn_outside_range(name, checked, getattr(self, name))
        return replace(self, **changed)  # type: ignore[arg-type]


def _ordered(motor: Motor, low: str, high: str) -> None:
    small, large = getattr(motor, low), getattr(motor, high)
    if small is None:
        return
    if np.any(small.value >= large.value):
        raise ParameterError(low, small.value, f"less than {high} ({np.max(large.value):g} {large.unit})")


SPECS: Mapping[str, Spec] = MappingProxyType(
    {f.name: f.metadata["spec"] for f in fields(Motor) if "spec" in f.metadata}
)


FLANGE = tuple(name for name in SPECS if name.startswith("flange_"))
"""The parameters of the rotor's flange, which the level compliance = "flange" needs."""

COUPLED = ("rotor_mass", "layer_loss_factor", "phase_coverage", "piezo_permittivity", "piezo_loss_factor")
"""The parameters that only the level coupling = "contact" knows."""

UNCOUPLED: Mapping[str, Spec] = MappingProxyType({name: spec for name, spec in SPECS.items() if name not in COUPLED})
"""All others: what the C library takes, which has not that level."""


def spec(name: object) -> Spec:
    """The specification of a parameter; a ParameterError for a name that is none."""
    if not isinstance(name, str) or name not in SPECS:
        from difflib import get_close_matches

        close = get_close_matches(name, SPECS, n=3, cutoff=0.5) if isinstance(name, str) else []
        hint = f"; close names: {', '.join(close)}" if close else ""
        raise ParameterError("motor parameter", name, f"a name of the motor file{hint}")
    return SPECS[name]
