"""What the computations assume without the paper's saying so, and what changes if it is otherwise.

Each assumption stands with the entries that it bears on, alternatives that the product's own levels and values can
compute, and estimates for what they cannot.  Figures are those of ``trum_sym.evaluate``, at Table 3's point as it is
computed by default and in the reading that comes near Table 4's determinants: start from rest, phase lead -1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np

from derivations import beam, bench, coupling, port
from derivations.ledger.course import Lap, share
from derivations.ledger.history import values
from derivations.ledger.operating import DRIVE, at_point, operating_point, stator
from derivations.ledger.witness import Drive
from derivations.nomenclature import CONSTANTS, sym

__all__ = ["ASSUMPTIONS", "Assumption", "assumptions_of", "page"]

_READINGS: dict[str, dict[str, Any]] = {
    "Table 3, default": {},
    "near Table 4": {"start": "rest", "phase_lead": -1},
}
_PLATE = 0.03  # m, the least radius of a torque plate outside of the rotor
_K_31 = 0.3  # longitudinal coupling of hard ceramics for power, about


@dataclass(frozen=True)
class Alternative:
    """What else could be: values of the motor in SI, of the drive, and levels, as ``evaluate`` takes them."""

    label: str
    motor: Mapping[str, float] = field(default_factory=dict)
    drive: Mapping[str, Any] = field(default_factory=dict)
    levels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Assumption:
    """Something taken for granted, the entries that it bears on, and what computes its weight."""

    id: str
    about: tuple[str, ...]
    title: str
    taken: str
    alternatives: Callable[[], tuple[Alternative, ...]] = tuple
    estimate: Callable[[], str] = str


def _point() -> Mapping[str, float]:
    return {name: float(value) for name, value in operating_point().items()}


def _own_hertz() -> float:
    return _point()["omega_n"] / (2 * math.pi)


def _rig_inertia() -> float:
    """What a weight on a string adds, kg m^2: m r^2 for m g r = 0.3 N m."""
    J, J_load, T_load, r_s = sym("J J_load T_load r_s")
    return float((bench.inertia() - J - J_load).subs({T_load: 0.3, r_s: _PLATE, **CONSTANTS}))


def _inertia() -> tuple[Alternative, ...]:
    J = _point()["J"]
    return (
        Alternative("half of it", {"rotor_inertia": J / 2}),
        Alternative("twice", {"rotor_inertia": 2 * J}),
        Alternative("with the rig's weight on a string, 30 mm from the axis", {"rotor_inertia": J + _rig_inertia()}),
    )


def _inertia_estimate() -> str:
    times = _rig_inertia() / _point()["J"]
    return (
        f"Sect. 8.1 loads the rotor with a weight on a string over the outer ring of a torque plate. For 0.3 N m, "
        f"m g r, it adds m r^2 = 0.3 N m r/g, {_rig_inertia():.2g} kg m^2 and {times:.0f} times J at r = 30 mm, more "
        "on a larger plate, and the plate's own. A string that gives or goes slack keeps the weight's part from the "
        "rotor within a cycle (entry load-inertia), not the plate's."
    )


def _held(**more: float) -> dict[str, float]:
    """Values besides a resonance that is kept where Table 3's model has it."""
    return {"resonance_frequency": _own_hertz(), **more}


def _radius() -> tuple[Alternative, ...]:
    return (Alternative("R = 26 mm, the middle of the ring", {"radius": 0.026}),)


def _wavenumber() -> tuple[Alternative, ...]:
    p = _point()
    at_contact = p["n_j"] / p["r_c"]
    return (
        Alternative(
            f"k_c = n_j/r_c = {at_contact:.1f} 1/m for the surface, same resonance", _held(wavenumber=at_contact)
        ),
        Alternative("contact radius 30 mm, where k_c is", {"contact_radius": 0.03}),
    )


def _wavenumber_estimate() -> str:
    p = _point()
    return (
        "On the contact radius the wave is shorter, and the slope of the same height "
        f"{100 * (p['R'] / p['r_c'] - 1):.1f} "
        "% larger, and with it the surface's speed; a ring that turns as it bends has a smaller height inside, which "
        "takes some of it back."
    )


@cache
def _resonance_at(height: float) -> float:
    """The modelled resonance in Hz when the wave under Table 3's prepressure has a height."""
    import trum_sym as ts
    from trum_sym.inputs.plausible import unquestioned

    with unquestioned():  # beyond what the free stator reaches, on purpose
        motor = ts.load_motor("trum60").with_values({"amplitude": height})
    return float(ts.evaluate(motor, ts.Drive()).resonance_frequency)


def _frequency() -> tuple[Alternative, ...]:
    found = []
    for height in (13e-6, 1e-6, 0.3e-6):
        hertz = _resonance_at(height)
        difference = 3000 + _own_hertz() - hertz
        if difference > 100:
            found.append(
                Alternative(
                    f"{hertz / 1000:.1f} kHz, as at a height of {1e6 * height:g} um, same drive frequency",
                    {"resonance_frequency": hertz, "amplitude": _point()["W"]},
                    {"frequency_difference": difference},
                )
            )
    return tuple(found)


def _frequency_estimate() -> str:
    low = share(lambda h: 2e-6 - h.W_c, Lap())
    heights = (13e-6, 1e-6, 3e-7)
    listed = ", ".join(f"{_resonance_at(height) / 1000:.1f} kHz at {1e6 * height:g} um" for height in heights)
    return (
        f"The foundation stiffens as the wave gets lower, at a constant prepressure: {listed}; {100 * low:.0f} % of "
        "the "
        "periodic cycle lies below 2 um. A resonance that follows the height would make both phases nonlinear and "
        "couple them; computed is what a constant one at either end gives."
    )


def _off_resonance() -> float:
    """What a resonator keeps of its amplitude at resonance when it is driven 3000 Hz off."""
    p = _point()
    ratio = p["omega_q"] / p["omega_n"]
    return 2 * p["xi"] / abs(complex(1 - ratio**2, 2 * p["xi"] * ratio))


def _amplitude() -> tuple[Alternative, ...]:
    return (
        Alternative(
            f"{1e6 * _off_resonance() * 12.6e-6:.2f} um free, what the resonator leaves of 12.6 um",
            _held(amplitude=_off_resonance() * _point()["W"]),
        ),
        Alternative("amplitude forced by the ceramic (7), put right", levels={"amplitude": "forced"}),
        Alternative("that of two phases, each on half of the ring", _held(amplitude=_forced() / 2)),
    )


def _forced() -> float:
    import trum_sym as ts

    return float(ts.evaluate(ts.load_motor("trum60"), ts.Drive(), amplitude="forced").amplitude)


def _amplitude_estimate() -> str:
    p = _point()
    band = 2 * p["xi"] * _own_hertz()
    return (
        f"The 12.6 um were measured at resonance, without prepressure. A bandwidth 2 xi f_n is {band:.0f} Hz, so the "
        "drive "
        f"runs {3000 / band:.1f} of them off, where a resonator keeps {100 * _off_resonance():.1f} %. Eq. 8 scales "
        "it by the "
        "prepressure alone."
    )


def _open_hertz() -> float:
    p = {**operating_point(), "E_p": operating_point()["E_p"] / (1 - _K_31**2)}
    from derivations import beam, section
    from derivations.ledger.operating import at_point

    p["D"] = at_point(section.neutral_axis(), p)
    p.update({name: at_point(expr, p) for name, expr in section.section().items()})
    return float(at_point(beam.resonance()["quartic"], p)) / (2 * math.pi)


def _electrodes() -> tuple[Alternative, ...]:
    shift = _open_hertz() - _own_hertz()
    return (
        Alternative(
            f"open, {shift:+.0f} Hz, same drive frequency",
            {"resonance_frequency": _open_hertz()},
            {"frequency_difference": 3000 - shift},
        ),
    )


def _electrodes_estimate() -> str:
    return (
        "A phase that is switched off is free to be short or open. Open, its ceramic is stiffer by 1/(1 - k_31^2), "
        "with a "
        f"coupling of about {_K_31:g}, and the phase's own resonance {_open_hertz() - _own_hertz():+.0f} Hz higher "
        "while "
        "it is off; computed is what that does if it held for both phases all cycle. By the phase's own force factor "
        f"and capacitance (entry electrical-port) it is {_port()['open']:+.0f} Hz."
    )


@cache
def _port() -> dict[str, float]:
    """Of a phase over the whole ring, by the ceramic's data: modal force, capacitance, what open electrodes add."""
    q: dict[str, Any] = dict(operating_point())
    own = at_point(beam.resonance()["quartic"], {**q, "k_f": mp.mpf(0)})
    whole = {**q, "omega_n0": own, "c_p": mp.mpf(1)}
    modal = {name: at_point(expr, whole) for name, expr in coupling.modal().items()}
    charge = {name: at_point(expr, whole) for name, expr in port.charge().items()}
    around = {**whole, **charge, "M_q": modal["M_q"]}
    open_ = at_point(port.circuit()["omega_open"], around)
    return {
        "force": float(modal["F_ceramic"]),
        "capacitance": float(charge["C_0"]),
        "open": float(open_ - own) / (2 * math.pi),
        "least mass": float(q["J"] / q["r_c"] ** 2),
    }


def _rotor_estimate() -> str:
    p = _port()
    return (
        f"With four of nine waves for each phase the ceramic's modal force is {p['force'] * 4 / 9:.0f} N in place of "
        f"{p['force']:.0f} N, and the capacitance {4e9 / 9 * p['capacitance']:.1f} nF in place of "
        f"{1e9 * p['capacitance']:.1f} nF; PZT-4 has 19 and 28 % more. No plain wave feels the rotor's mass; in pulses "
        "and under one phase a rotor with a mass bounces, and the amplitudes of Table 2 hang on it "
        f"(docs/coupling.md). J over the contact radius squared is {1000 * p['least mass']:.1f} g."
    )


def _share_of_turning(split: float) -> float:
    """Q_aver over a periodic cycle, B's resonance apart from A's by a share of it, 1/s."""
    q = Drive("periodic", split=split).phases(count=200000).q
    return float(q.sum() / np.abs(q).sum()) / values()["T"]


def _modes_estimate() -> str:
    return (
        f"A ring has two modes of one frequency only if nothing breaks its symmetry. Split by one permille, "
        f"{_own_hertz() / 1000:.0f} Hz, Q_aver goes from {_share_of_turning(0.0):.0f} 1/s to "
        f"{_share_of_turning(0.001):.0f} 1/s with B's above A's, to {_share_of_turning(-0.001):.0f} 1/s with B's below "
        "(periodic, phase lead +1)."
    )


def _damping() -> tuple[Alternative, ...]:
    return tuple(Alternative(f"xi = {xi:g}", {"damping_ratio": xi}) for xi in (0.004, 0.009, 0.012))


def _axis() -> tuple[Alternative, ...]:
    p, layers = _point(), {name: float(value) for name, value in stator(DRIVE["F_c"], layered=True).items()}
    turned, both = p["D"] * p["beta"] / p["k_c"], layers["D"] * layers["beta"] / p["k_c"]
    own = layers["omega_n"] / (2 * math.pi)
    return (
        Alternative(
            f"axis of the layers, D = {1000 * layers['D']:.3f} mm, same resonance", _held(neutral_axis=layers["D"])
        ),
        Alternative(
            f"rotation for slope, D beta/k_c = {1000 * turned:.3f} mm, same resonance", _held(neutral_axis=turned)
        ),
        Alternative(f"both, {1000 * both:.3f} mm, same resonance", _held(neutral_axis=both)),
        Alternative(
            f"both, at the layers' resonance of {own / 1000:.2f} kHz",
            {"neutral_axis": both, "resonance_frequency": own},
        ),
    )


def _axis_estimate() -> str:
    return (
        "By first principles the surface moves by D theta, with the layers' axis and Timoshenko's rotation; (1) and "
        "(11) "
        "take a bending modulus for an axial one and the slope for the rotation, and their errors nearly cancel. The "
        "default keeps both, since it computes the paper's model, whose stiffness (2) is about the same axis; D can be "
        "given. Given D, the section is taken about it, so the resonance is held here."
    )


ASSUMPTIONS: tuple[Assumption, ...] = (
    Assumption(
        "inertia",
        ("table-1-J", "38"),
        "The rotor's inertia",
        "J = 4.5e-6 kg m^2: Table 1 prints no unit, and nothing else turns with the rotor.",
        _inertia,
        _inertia_estimate,
    ),
    Assumption(
        "ring",
        ("4", "table-1-R"),
        "The radius of the beam",
        "R = 30 mm, which Table 1's perimeter gives. It is the outer radius: the ring is 8 mm wide, its middle "
        "at 26 mm.",
        _radius,
    ),
    Assumption(
        "contact-radius",
        ("11", "25"),
        "Where the rotor touches",
        "k_c is that of 30 mm, but the rotor's speed is the surface's over a contact radius of 26.5 mm, itself "
        "assumed.",
        _wavenumber,
        _wavenumber_estimate,
    ),
    Assumption(
        "constant-resonance",
        ("6", "9"),
        "One resonance all cycle",
        "f_n is that of the amplitude W_maxf under the prepressure, all through the cycle.",
        _frequency,
        _frequency_estimate,
    ),
    Assumption(
        "amplitude",
        ("8", "7"),
        "The measured amplitude off resonance",
        "W_maxf = 12.6 um scaled by the prepressure, whatever the drive frequency (eq. 8).",
        _amplitude,
        _amplitude_estimate,
    ),
    Assumption(
        "electrodes",
        ("10", "decay", "electrical-port"),
        "Electrodes of a phase that is off",
        "A phase vibrates at the same f_n whether it is driven, shorted or open.",
        _electrodes,
        _electrodes_estimate,
    ),
    Assumption(
        "rotor-and-electrodes",
        ("7", "wave-reaction", "electrical-port"),
        "The rotor's mass and the electrodes",
        "A rotor of 20 g, electrodes of each phase over the whole ring as eq. 7 has them, a ceramic like PZT-8: they "
        "count where the rotor acts back on the wave alone, so in none of the figures of the other tables.",
        estimate=_rotor_estimate,
    ),
    Assumption(
        "equal-modes",
        ("4", "9"),
        "Two equal modes",
        "Both phases have the same resonance, damping and amplitude.",
        estimate=_modes_estimate,
    ),
    Assumption(
        "damping",
        ("decay", "9"),
        "Damping with and without load",
        "xi = 0.006, from the decay that Sect. 7.3 measured, is that under prepressure and with the rotor too.",
        _damping,
    ),
    Assumption(
        "axis-and-rotation",
        ("1", "11", "layered-section"),
        "Axis and rotation of the section",
        "The surface's tangential motion is D times the slope, D from eq. 1.",
        _axis,
        _axis_estimate,
    ),
)
"""Every assumption, in the order of the page."""
_OUTPUTS = {
    "resonance_frequency": ("f_n, kHz", 1e-3, ".2f"),
    "amplitude": ("W, um", 1e6, ".2f"),
    "q_average": ("Q_aver, 1/s", 1.0, ".0f"),
    "q_volatility": ("Q_vib, 1/s", 1.0, ".0f"),
    "mean_speed": ("mean speed, rad/s", 1.0, ".2f"),
    "speed_volatility": ("volatility, %", 100.0, ".3g"),
}


@cache
def _base(reading: str) -> dict[str, str]:
    return _outcome(Alternative(""), reading)


def _outcome(alternative: Alternative, reading: str) -> dict[str, str]:
    """What ``evaluate`` gives for an alternative in a reading, as text."""
    import trum_sym as ts
    from trum_sym.inputs.plausible import unquestioned

    motor = ts.load_motor("trum60")
    if alternative.motor:
        with unquestioned():  # one value alone contradicts the others
            motor = motor.with_values(dict(alternative.motor))
    drive = ts.Drive(**{**_READINGS[reading], **alternative.drive})
    levels: dict[str, Any] = dict(alternative.levels)
    point = ts.evaluate(motor, drive, tolerance=1e-5, **levels)
    return {name: format(scale * float(getattr(point, name)), spec) for name, (_, scale, spec) in _OUTPUTS.items()}


@cache
def _record(identifier: str) -> dict[str, Any]:
    (one,) = (a for a in ASSUMPTIONS if a.id == identifier)
    rows = []
    alternatives = one.alternatives()
    for alternative in (None, *alternatives) if alternatives else ():
        for reading in _READINGS:
            found = _base(reading) if alternative is None else _outcome(alternative, reading)
            label = "as computed" if alternative is None else alternative.label
            rows.append({"what": label, "reading": reading, **found})
    return {
        "id": one.id,
        "title": one.title,
        "taken": one.taken,
        "estimate": one.estimate(),
        "outcomes": rows,
        "about": list(one.about),
    }


def assumptions_of(entry: str) -> list[dict[str, Any]]:
    """The assumptions that bear on an entry, with what their alternatives give."""
    return [_record(one.id) for one in ASSUMPTIONS if entry in one.about]


def _rows(outcomes: Iterable[Mapping[str, str]]) -> list[str]:
    head = ["what", "reading", *(label for label, _, _ in _OUTPUTS.values())]
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * 2}{'---:|' * len(_OUTPUTS)}"]
    lines += [f"| {' | '.join((row['what'], row['reading'], *(row[name] for name in _OUTPUTS)))} |" for row in outcomes]
    return lines


def page() -> str:
    """docs/assumptions.md, written by ``verify --write``."""
    lines = [
        "# What is assumed",
        "",
        "What the computations take for granted where the paper is silent or its text and its figures part, and what",
        "changes if it is otherwise: by the product's own values and levels (`trum-sym evaluate --set NAME=VALUE`), at",
        "Table 3's point as it is computed by default (periodic start, phase lead +1) and in the reading near Table "
        "4's",
        "determinants (start from rest, phase lead -1); what they cannot compute is estimated. The same stands, "
        "entry by",
        "entry, under `assumptions` in `generated/ledger.json`. Written by `python -m derivations verify --write`.",
    ]
    for one in ASSUMPTIONS:
        record = _record(one.id)
        about = ", ".join(f"[{name}](../generated/ledger.html#{_anchor(name)})" for name in one.about)
        lines += ["", f"## {one.title}", "", f"{record['taken']} Bears on {about}."]
        lines += ["", record["estimate"]] if record["estimate"] else []
        lines += ["", *_rows(record["outcomes"])] if record["outcomes"] else []
    return "\n".join(lines) + "\n"


def _anchor(name: str) -> str:
    return f"eq-{name}" if name.removeprefix("A").isdigit() else name
