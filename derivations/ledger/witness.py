"""The effects' second witness: stator, drive cycle, contact and rotor anew, by other means than the ledger's.

Section and foundation by quadrature and bisection, the resonance as an eigenvalue, the phases as turning complex
numbers started from displacement and velocity, friction summed over the contact point by point; what is asked of a
cycle is counted, summed or picked from very many instants.  From the motor's data alone: of the derivations
nothing is used, nor of the modules that compute the effects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

__all__ = ["MANY", "Sampled", "beam", "contact_angle", "cycle", "friction", "motor", "peak", "resonance", "stator"]

Array = NDArray[np.float64]
MANY = 1 << 20
"""Instants of a cycle."""
_GATES = {"A": (0, 1, 1), "B": (1, 0, 1)}


@cache
def motor() -> Mapping[str, mp.mpf]:
    """TRUM-60's data, SI."""
    from trum_sym.inputs.motor_file import load_motor

    return {name: mp.mpf(repr(float(value))) for name, value in load_motor("trum60").symbols().items()}


def _moments(layers: list[tuple[mp.mpf, mp.mpf, mp.mpf]], about: mp.mpf, order: int) -> mp.mpf:
    return mp.fsum(k * mp.quad(lambda z: (z - about) ** order, [low, high]) for k, low, high in layers)


def beam(layered: bool = False, **changed: Any) -> dict[str, mp.mpf]:  # noqa: ANN401
    """The section: D, E I, the inertias rho A and rho I_z, kappa G A.

    ``layered`` takes the metal below the teeth and the ceramic, each with its own modulus, for what bends.
    """
    v = {**motor(), **changed}
    h_e, top = v["h_e"], v["h_e"] + v["h_p"]
    lost = 1 - v["h_t"] / h_e * v["n_s"] * v["b_s"] / v["l_s"]
    ceramic = (v["E_p"] * v["b_p"], h_e, top)
    whole = [((1 - v["h_t"] / h_e) ** 3 * v["E_e"] * v["b_e"], mp.mpf(0), h_e), ceramic]
    below = [(v["E_e"] * v["b_e"], v["h_t"], h_e), ceramic]
    bends = below if layered else whole
    axis = _moments(bends, mp.mpf(0), 1) / _moments(bends, mp.mpf(0), 0)
    area = v["b_e"] * h_e + v["b_p"] * v["h_p"]
    second = _moments([(v["b_e"], mp.mpf(0), h_e), (v["b_p"], h_e, top)], axis, 2)
    mass = lost * v["rho_e"] * v["b_e"] * h_e + v["rho_p"] * v["b_p"] * v["h_p"]
    shear = lost * v["G_e"] * v["b_e"] * h_e + v["G_p"] * v["b_p"] * v["h_p"]
    return {
        "D": axis,
        "EI": _moments(bends, axis, 2),
        "I_z": second,
        "A": area,
        "rho": mass / area,
        "G": shear / area,
        "rho A": mass,
        "rho I": mass / area * second,
        "shear": v["kappa"] * shear,
    }


def resonance(b: Mapping[str, mp.mpf], k: mp.mpf, k_f: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """The lower eigenvalue of (3) for a wave, in Hz, and the ratio beta of rotation to displacement."""
    stiffness = mp.matrix([[b["shear"] * k**2 + k_f, -b["shear"] * k], [-b["shear"] * k, b["EI"] * k**2 + b["shear"]]])
    scale = mp.diag([1 / mp.sqrt(b["rho A"]), 1 / mp.sqrt(b["rho I"])])
    square = min(mp.eigsy(scale * stiffness * scale, eigvals_only=True))
    ratio = (b["shear"] * k**2 + k_f - b["rho A"] * square) / (b["shear"] * k)
    return mp.sqrt(mp.mpc(square)) / (2 * mp.pi), ratio


def contact_angle(load: mp.mpf) -> mp.mpf:
    """The half-angle whose crest carries a load, in k_N W/k_c: the integral of cos u - cos theta, bisected."""
    low, high = mp.mpf(0), mp.pi
    for _ in range(110):
        middle = (low + high) / 2
        carried = mp.sin(middle) - middle * mp.cos(middle)
        low, high = (middle, high) if 2 * carried < load else (low, middle)
    return low


@cache
def stator(prepressure: int = 180, layered: bool = False) -> dict[str, mp.mpf]:
    """Values at a prepressure in N, by symbol name; ``f_n`` and ``f_q`` in Hz."""
    with mp.workdps(30):
        v: dict[str, Any] = {**motor(), **beam(layered)}
        k, force = v["n_j"] / v["R"], mp.mpf(prepressure)
        k_N = v["E_m"] * v["b_m"] / v["h_m"]
        W = v["C_f"] * mp.exp(-v["varsigma"] * mp.log(force)) * v["W_max"]
        theta = contact_angle(force * k / (v["n_j"] * k_N * W))
        first = mp.quad(lambda u: (mp.cos(u) - mp.cos(theta)) * mp.cos(u), [-theta, 0, theta])
        v |= {"k_c": k, "F_c": force, "k_N": k_N, "W": W, "theta": theta, "k_f": k_N * first / mp.pi}
        v |= {"k_dx": 2 * v["n_j"] * theta / k * k_N, "smeared": k_N * theta / mp.pi}
        f_n, v["beta"] = resonance(v, k, v["k_f"])
        v |= {"f_n": mp.re(f_n), "f_q": mp.re(f_n) + 3000, "m": mp.mpf(20), "n": mp.mpf(14)}
        v["T"] = v["m"] / v["f_q"]
        return v


@dataclass(frozen=True)
class Sampled:
    """A cycle at some times: region 0 to 2 and time since its start, displacements and velocities of both phases.

    ``a`` and ``b`` are the phases as turning complex numbers, whose real parts are the displacements.
    """

    time: Array
    region: NDArray[np.int64]
    since: Array
    w_A: Array
    w_B: Array
    v_A: Array
    v_B: Array
    a: NDArray[np.complex128]
    b: NDArray[np.complex128]

    @property
    def height(self) -> Array:
        """Of the crest."""
        return np.sqrt(self.w_A**2 + self.w_B**2)

    @property
    def q(self) -> Array:
        """The determinant over D k_c."""
        return self.v_A * self.w_B - self.v_B * self.w_A

    @property
    def climb(self) -> Array:
        """Rate of the crest's height."""
        return (self.w_A * self.v_A + self.w_B * self.v_B) / self.height


@dataclass(frozen=True)
class Drive:
    """What a cycle needs to know; ``lead`` is +1 or -1, ``start`` periodic, steady or rest.

    ``split`` sets B's resonance apart from A's, as a share of it.
    """

    start: str
    m: int = 20
    n: int = 14
    difference: float = 3000.0
    lead: int = 1
    split: float = 0.0

    def phases(self, time: Array | None = None, count: int = MANY) -> Sampled:
        """At the midpoints of equal steps, or at some times."""
        v = stator()
        f_q, W, xi = float(v["f_n"]) + self.difference, float(v["W"]), float(v["xi"])
        drive = 2 * math.pi * f_q
        lengths = [(self.m - self.n) / f_q, (self.m - self.n) / f_q, (2 * self.n - self.m) / f_q]
        ends = np.cumsum([0.0, *lengths])
        if time is None:
            time = (np.arange(count) + 0.5) / count * float(ends[-1])
        region = np.minimum(np.searchsorted(ends[1:-1], time, side="right"), 2)
        columns: dict[str, Any] = {"since": time - ends[region]}
        for phase, quarter in (("A", 0), ("B", self.lead)):
            forced = W * 1j**quarter
            own = 2 * math.pi * float(v["f_n"]) * (1 + self.split * (phase == "B"))
            eigenvalue = own * complex(-xi, math.sqrt(1 - xi**2))
            z = _free(self.start, forced, _GATES[phase], lengths, eigenvalue, drive)
            gate, since = np.array(_GATES[phase])[region], columns["since"]
            free, on = z[region] * np.exp(eigenvalue * since), gate * forced * np.exp(1j * drive * since)
            columns[phase.lower()] = free + on
            columns[f"w_{phase}"] = (free + on).real
            columns[f"v_{phase}"] = (eigenvalue * free + 1j * drive * on).real
        return Sampled(time, region, **columns)


def _free(
    start: str, forced: complex, gates: tuple[int, ...], lengths: list[float], eigenvalue: complex, drive: float
) -> NDArray[np.complex128]:
    """The free motion's complex amplitude at the start of the three regions."""

    def of(w: float, v: float) -> complex:  # Re z = w and Re(eigenvalue z) = v
        return complex(w, (eigenvalue.real * w - v) / eigenvalue.imag)

    steady = of(forced.real, (1j * drive * forced).real)

    def through(z: complex, before: int) -> tuple[list[complex], complex]:
        starts = []
        for gate, length in zip(gates, lengths, strict=True):
            z += (before - gate) * steady
            starts.append(z)
            z, before = z * np.exp(eigenvalue * length), gate
        return starts, z

    if start == "rest":
        return np.array(through(0j, 0)[0])
    if start == "steady":
        return np.array(through(0j, 1)[0])
    last = gates[-1]  # a cycle makes z exp(eigenvalue T) + shift of z
    shift = through(0j, last)[1]
    decay = np.exp(eigenvalue * sum(lengths))
    return np.array(through(shift / (1 - decay), last)[0])


@cache
def cycle(start: str = "periodic", m: int = 20, n: int = 14) -> Sampled:
    """A cycle at Table 3 but for the pulses, at very many instants."""
    return Drive(start, m, n).phases()


def peak(quantity: Callable[[Sampled], Array], drive: Drive, low: float, high: float, largest: bool = True) -> float:
    """The largest or smallest value between two times: picked from a scan, and from ever finer ones around the best."""
    sign = 1.0 if largest else -1.0
    best = -math.inf
    for _ in range(6):
        time = np.linspace(low, high, 200001)
        values = sign * quantity(drive.phases(time))
        at = int(values.argmax())
        best = max(best, float(values[at]))
        low, high = time[max(0, at - 3)], time[min(time.size - 1, at + 3)]
    return sign * best


def zones(heights: Array) -> Array:
    """Half-angles of the contact for heights of the crest: the load's function tabulated and read backwards."""
    v = stator()
    load = float(v["F_c"] * v["k_c"] / (v["n_j"] * v["k_N"])) / 2 / heights
    table = np.linspace(0, np.pi, 400001)
    return np.asarray(np.interp(load, np.sin(table) - table * np.cos(table), table))


def friction(states: Sampled, speed: float, half: bool = False, points: int = 1200) -> Array:
    """Net friction over mu F_c at every instant, for a rotor's speed: the contact summed point by point."""
    v, zone = stator(), zones(states.height)
    scale = float(v["D"] * v["k_c"])
    found = np.empty(states.time.size)
    share = (np.arange(points) + 0.5) / points
    for first in range(0, found.size, 4096):
        part = slice(first, first + 4096)
        edge = zone[part][:, None]
        u = edge * share if half else edge * (2 * share - 1)
        crest = np.arctan2(states.w_A[part], states.w_B[part])[:, None] + u
        surface = scale * (states.v_A[part][:, None] * np.cos(crest) - states.v_B[part][:, None] * np.sin(crest))
        press = np.cos(u) - np.cos(edge)
        found[part] = (np.sign(surface - speed) * press).sum(1) / press.sum(1)
    return found
