"""The reconstructed supplement against an ODE solver, to 1e-9, and the compiled kernels, to 1e-12."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from lazily import lazily
from reference import integrate_regions, steady_state

import trum_sym as ts
from trum_sym.model.cycle import modal_values, response

exact = lazily("derivations.ledger.exact")
supplement = lazily("derivations.ledger.section_3_supplement")

PHASE = {"redu": "A", "addredu": "A", "add": "B"}
FRACTIONS = (0.03, 0.31, 0.62, 0.97)
DRIVES = [
    # f_n, difference, damping, switching phase, pulses, pulses on
    (39043.5, 3000.0, 0.006, 0.0, 20, 14),
    (41000.0, 2800.0, 0.004, 1.1, 24, 15),
    (38000.0, 3300.0, 0.009, -2.3, 17, 12),
    (39703.0, -1500.0, 0.02, 2.9, 30, 20),
]


def cycle_of(f_n, df, xi, psi, m, n):
    omega_n, omega_q = 2 * mp.pi * mp.mpf(f_n), 2 * mp.pi * (mp.mpf(f_n) + mp.mpf(df))
    named = {"omega_n": omega_n, "omega_q": omega_q, "Delta_omega": omega_q - omega_n, "xi": mp.mpf(xi), "W": mp.mpf(1)}
    return exact.Cycle({**named, "psi": mp.mpf(psi), "m": mp.mpf(m), "n": mp.mpf(n)})


def ours(cycle, region, fraction):
    length = cycle.durations()[exact.REGIONS.index(region)]
    return float(supplement.displacement(region, supplement.supplement_forms(region), cycle, length * mp.mpf(fraction)))


@pytest.mark.parametrize("drive", DRIVES)
def test_supplement_agrees_with_the_ode(drive):
    f_n, df, xi, psi, m, n = drive
    arrays = [np.array([float(v)]) for v in (f_n, df, xi, psi, 1.0)]
    start = steady_state(arrays[0], arrays[1], arrays[3], arrays[4], 0.0)
    seen, _ = integrate_regions(start, *arrays, np.array([m]), np.array([n]), FRACTIONS, rtol=1e-13)
    cycle = cycle_of(*drive)
    for region, phase in PHASE.items():
        for i, fraction in enumerate(FRACTIONS):
            assert (
                abs(ours(cycle, region, fraction) - seen[exact.REGIONS.index(region), i, "AB".index(phase), 0]) < 1e-9
            )


@pytest.mark.parametrize("drive", DRIVES)
def test_supplement_agrees_with_the_compiled_kernels(drive):
    f_n, df, xi, psi, m, n = drive
    setting = ts.Drive(frequency_difference=df, periods=m, on_periods=n, start="steady", switching_phase=psi)
    values = modal_values(2 * np.pi * f_n, xi, setting)
    cycle = cycle_of(*drive)
    start = mp.mpf(0)
    for region, length in zip(exact.REGIONS, cycle.durations(), strict=True):
        for fraction in FRACTIONS:
            found = response(float(start + length * mp.mpf(fraction)), values)
            phase = PHASE[region]
            assert abs(ours(cycle, region, fraction) - found[f"w_{phase}"]) < 1e-12 * 4
        start += length
