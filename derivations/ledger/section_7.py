"""Section 7, the experiments: eq. (45) and the damping ratio from the decay."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import numpy as np
import sympy as sp

from derivations import phases
from derivations.ledger.history import values
from derivations.ledger.judge import evaluate, figure, usual
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.nomenclature import sym
from trum_sym.inputs.units import Dimension

__all__ = ["ENTRIES", "rounds_to"]

omega_q, omega_n, xi, t = sym("omega_q omega_n xi t")
_DRIVE_HZ, _FREE_HZ = 45000, 39703  # Sects. 7.3, 7.4
_MEASURED_MS = "0.19"  # Sect. 7.4


def rounds_to(value: float, printed: str) -> bool:
    """Whether a value is what is printed, to the last printed digit."""
    decimals = len(printed.partition(".")[2])
    return abs(value - float(printed)) <= 0.5 * 10.0**-decimals * (1 + 1e-9)


# --- (45) ---------------------------------------------------------------------------------------------------
_PERIOD = 2 * sp.pi / (omega_q - omega_n)
_EQ45: Forms = {"T_redu": _PERIOD, "T_redu/ms": sp.Float("0.188")}


def _value_ms(form: sp.Expr) -> float:
    at = {omega_q: 2 * mp.pi * _DRIVE_HZ, omega_n: 2 * mp.pi * _FREE_HZ}
    return 1000 * float(evaluate(form, at))


def _derive_45() -> Derivation:
    envelope = (1 + sp.exp(sp.I * (omega_q - omega_n) * t)) / 2
    rounded = sp.Float(f"{_value_ms(_PERIOD):.3f}")
    return Derivation(
        (
            step("Drive and free vibration together are the carrier times an envelope, for equal amplitudes", envelope),
            step("whose phase makes a full turn in", _PERIOD, zero=(omega_q - omega_n) * _PERIOD - 2 * sp.pi),
            step(f"For {_DRIVE_HZ} Hz and {_FREE_HZ} Hz that is {_value_ms(_PERIOD):.5f} ms, rounded", rounded),
        ),
        {"T_redu": _PERIOD, "T_redu/ms": rounded},
    )


def _judge_45(forms: Forms) -> Iterator[Evidence]:
    period = _value_ms(forms["T_redu"])
    time = np.linspace(0.1, 0.5, 400001)  # ms; two phasors beat: find neighbouring minima of their sum
    size = np.abs(np.exp(2j * np.pi * _DRIVE_HZ * time / 1000) + np.exp(2j * np.pi * _FREE_HZ * time / 1000))
    minima = time[1:-1][(size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:])]
    seen = float(np.diff(minima).mean())
    yield evidence(
        "limit", abs(period - seen) < 1e-4, f"the spacing of the nodes of two added vibrations, {seen:.5f} ms"
    )
    text = f"{float(forms['T_redu/ms']):.3f}"
    yield evidence("numeric", rounds_to(seen, text), f"the value {text} ms is {seen:.5f} ms rounded to its last digit")
    yield evidence(
        "data", rounds_to(period, _MEASURED_MS), f"agrees with the measured {_MEASURED_MS} ms in its last digit"
    )


def _effect_45() -> str:
    found = _value_ms(_PERIOD)
    damped = 100 * usual()["xi"] ** 2 / 2 * _FREE_HZ / (_DRIVE_HZ - _FREE_HZ)
    return (
        f"{figure(found, spec='.5f')} ms, cut off instead of rounded: "
        f"{figure(100 * (0.188 / found - 1), spec='+.2f')} %; "
        f"the measured 0.19 ms is {figure(100 * (0.19 / found - 1), spec='+.2f')} % off. The free vibration runs at "
        f"omega_n sqrt(1 - xi^2), which changes the period by {figure(damped, spec='.3f')} % only."
    )


# --- damping from decay -------------------------------------------------------------------------------------
ratio, cycles = sp.symbols("r_N N", positive=True)


def _derive_decay() -> Derivation:
    decay = sp.exp(-xi * omega_n * t)
    period = 2 * sp.pi / (omega_n * sp.sqrt(1 - xi**2))
    logarithm = xi * omega_n * cycles * period
    form = sp.log(ratio) / sp.sqrt((2 * sp.pi * cycles) ** 2 + sp.log(ratio) ** 2)
    back = logarithm.subs(xi, form)
    return Derivation(
        (
            step("The free vibration falls as", decay),
            step(
                "N of its periods apart the velocity has fallen by the ratio r_N:",
                sp.Eq(sp.log(ratio), logarithm),
                zero=logarithm - sp.log(1 / decay.subs(t, cycles * period)).expand(force=True),
            ),
            step(
                "Solved for the damping ratio:",
                sp.Eq(xi, form),
                zero=sp.simplify(
                    (back**2).subs(sp.log(ratio), sp.Symbol("l", positive=True)) - sp.Symbol("l", positive=True) ** 2
                ),
            ),
        ),
        {"xi": form},
    )


def _judge_decay(forms: Forms) -> Iterator[Evidence]:
    displacement, velocity = phases.free()
    a, b, tau = sym("a b tau")
    speed = sp.lambdify(tau, velocity.subs({a: 1, b: 0, omega_n: 1}).subs(xi, sp.Rational(3, 500)), "mpmath")
    with mp.workdps(30):
        turn = 2 * mp.pi / mp.sqrt(1 - mp.mpf("0.006") ** 2)
        peaks = [mp.findroot(lambda s: mp.diff(speed, s), k * turn + mp.mpf("4.7")) for k in (0, 5)]
        fall = speed(peaks[0]) / speed(peaks[1])
        found = evaluate(forms["xi"], {ratio: fall, cycles: mp.mpf(5)})
    del displacement
    yield evidence(
        "numeric",
        abs(found - mp.mpf("0.006")) < 1e-12,
        "gives back 0.006 from two velocity peaks, five periods apart, of the oscillator's free motion",
    )
    d = sp.Symbol("d", positive=True)
    small = sp.series(forms["xi"].subs(ratio, sp.exp(d)), d, 0, 2)
    first = d / (2 * sp.pi * cycles)
    yield evidence("limit", sp.simplify(small.removeO() - first) == 0, "tends to log(r_N)/(2 pi N) for little damping")


def _effect_decay() -> str:
    p = values()
    time_constant = 1 / (p["xi"] * p["omega_n"])
    return (
        "Sect. 7.3 names the method but prints no formula. xi = 0.006 means a fall by a factor "
        f"{figure(float(sp.exp(2 * sp.pi * p['xi'])), 5)} a period and by e in {figure(1e3 * time_constant, 3)} ms, "
        f"{figure(time_constant / p['T'], 3)} drive cycles of Table 3."
    )


ENTRIES = (
    Entry(
        id="45",
        section="7.4",
        title="Measured beat period",
        place="Sect. 7.4",
        printed=_EQ45,
        units={"T_redu": "s"},
        verdict="erratum",
        judge=_judge_45,
        derive=_derive_45,
        effect=_effect_45,
        repair=lambda forms: {**forms, "T_redu/ms": sp.Float("0.189")},
        found_by=("numeric",),
        reason="The formula holds; 45 kHz and 39.703 kHz give 0.18879 ms, which rounds to 0.189 ms.",
    ),
    Entry(
        id="decay",
        section="7.3",
        title="Damping ratio from the velocity's decay",
        place="Sect. 7.3, in words",
        printed={},
        units={"xi": "1"},
        verdict="reconstructed",
        judge=_judge_decay,
        derive=_derive_decay,
        effect=_effect_decay,
        known={ratio: Dimension(), cycles: Dimension()},
        reason="Named, not printed: the logarithmic decrement of the free vibration.",
    ),
)
