"""Both phases as complex exponentials, in mpmath: the witness for eqs. (9) to (24).

Written from the model alone (an oscillator per phase, gated forcing, displacement and velocity continuous),
not from the derivations.  The cycle begins in steady state at t_1 = 0, as Section 3 assumes; B leads A by a
quarter period.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import mpmath as mp

from derivations.ledger.operating import operating_point

__all__ = ["REGIONS", "Cycle", "at_table_3", "crest_states", "random_cycles", "vertical_displacement"]

REGIONS = ("redu", "addredu", "add")
_GATES = {"A": (0, 1, 1), "B": (1, 0, 1)}
_LEAD = {"A": mp.mpf(0), "B": mp.mpf(1)}


@dataclass(frozen=True, eq=False)  # hashed by identity, for caches
class Cycle:
    """A drive of amplitude W; values by symbol name."""

    values: Mapping[str, mp.mpf]

    def __getitem__(self, name: str) -> mp.mpf:
        return self.values[name]

    @property
    def _eigenvalue(self) -> mp.mpc:
        return self["omega_n"] * mp.mpc(-self["xi"], mp.sqrt(1 - self["xi"] ** 2))

    def durations(self) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
        """Of the three regions."""
        pulse, m, n = 2 * mp.pi / self["omega_q"], self["m"], self["n"]
        return (m - n) * pulse, (m - n) * pulse, (2 * n - m) * pulse

    def _forced(self, phase: str) -> mp.mpc:
        return self["W"] * mp.expj(self["psi"] + _LEAD[phase] * mp.pi / 2)

    def free(self, phase: str, region: str) -> mp.mpc:
        """Z of the free motion Re(z exp(lambda tau)) at the start of a region."""
        eigenvalue = self._eigenvalue
        forced = self._forced(phase)
        w, v = mp.re(forced), mp.re(1j * self["omega_q"] * forced)
        jump = mp.mpc(w, (mp.re(eigenvalue) * w - v) / mp.im(eigenvalue))
        z, before = mp.mpc(0), 1
        for name, gate, time in zip(REGIONS, _GATES[phase], self.durations(), strict=True):
            z += (before - gate) * jump
            if name == region:
                return z
            z, before = z * mp.exp(eigenvalue * time), gate
        raise ValueError(region)

    def response(self, phase: str, region: str, tau: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        """Displacement and velocity, tau after the start of a region."""
        gate = _GATES[phase][REGIONS.index(region)]
        eigenvalue = self._eigenvalue
        z = self.free(phase, region) * mp.exp(eigenvalue * tau)
        f = gate * self._forced(phase) * mp.expj(self["omega_q"] * tau)
        return mp.re(z + f), mp.re(eigenvalue * z + 1j * self["omega_q"] * f)

    def vector(self, phase: str, region: str, tau: mp.mpf) -> mp.mpc:
        """The phase as a rotating vector: free motion at omega_d with its decay, forced at omega_q."""
        gate = _GATES[phase][REGIONS.index(region)]
        free = self.free(phase, region) * mp.exp(self._eigenvalue * tau)
        return free + gate * self._forced(phase) * mp.expj(self["omega_q"] * tau)

    def determinant(self, region: str, tau: mp.mpf) -> mp.mpf:
        """Q / (D k_c)."""
        (w_A, v_A), (w_B, v_B) = (self.response(p, region, tau) for p in "AB")
        return v_A * w_B - v_B * w_A

    def times(self, region: str, count: int) -> list[mp.mpf]:
        """Equally spread times inside a region."""
        length = self.durations()[REGIONS.index(region)]
        return [length * (2 * i + 1) / (2 * count) for i in range(count)]


def vertical_displacement(a: mp.mpf, b: mp.mpf, k_c: mp.mpf, x: mp.mpf) -> mp.mpf:
    """zeta_z (11) at a place for the phases' displacements."""
    return a * mp.sin(k_c * x) + b * mp.cos(k_c * x)


def crest_states(count: int, seed: str) -> list[dict[str, mp.mpf]]:
    """Displacements a, b and velocities da, db of the phases in all four quadrants, a place x, D and k_c."""
    found, q = [], operating_point()
    for index in range(count):
        draw = random.Random(f"{seed} {index}")
        signs = (1 if index & 1 else -1, 1 if index & 2 else -1)
        found.append(
            {
                "a": signs[0] * mp.mpf(draw.uniform(1e-6, 9e-6)),
                "b": signs[1] * mp.mpf(draw.uniform(1e-6, 9e-6)),
                "da": mp.mpf(draw.uniform(-1, 1)),
                "db": mp.mpf(draw.uniform(-1, 1)),
                "x": mp.mpf(draw.uniform(-0.01, 0.01)),
                "D": q["D"],
                "k_c": q["k_c"],
            }
        )
    return found


@cache
def at_table_3() -> Cycle:
    """The operating point, switched at drive phase 0 as the paper does."""
    return Cycle({**operating_point(), "psi": mp.mpf(0)})


@cache
def random_cycles(count: int, seed: str, psi: bool = False) -> tuple[Cycle, ...]:
    """Drives around the operating point: resonance, difference, damping, pulses and, on request, switching phase."""
    found = []
    for index in range(count):
        draw = random.Random(f"{seed} {index}")
        omega_n = mp.mpf(2 * draw.uniform(35e3, 45e3)) * mp.pi
        omega_q = omega_n + 2 * mp.pi * mp.mpf(draw.uniform(2500, 3500))
        m = draw.randint(16, 30)
        n = draw.randint(m // 2 + 2, m - 3)
        found.append(
            Cycle(
                {
                    **operating_point(),
                    "omega_n": omega_n,
                    "omega_q": omega_q,
                    "Delta_omega": omega_q - omega_n,
                    "m": mp.mpf(m),
                    "n": mp.mpf(n),
                    "xi": mp.mpf(draw.uniform(0.004, 0.008)),
                    "W": mp.mpf(draw.uniform(4e-6, 8e-6)),
                    "psi": mp.mpf(draw.uniform(-3, 3) if psi else 0),
                }
            )
        )
    return tuple(found)
