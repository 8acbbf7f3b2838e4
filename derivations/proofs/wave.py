"""Proofs of the wave's kernels: phasors, their turn, wave height, surface speed, a surface point (eqs. 11 to 20)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import mpmath as mp

from derivations.proofs.cycle import follow, phase_at, state_after
from derivations.proofs.maths import DIGITS, Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS"]

Found = Mapping[str, Number]


def _eigenvalue(p: Point) -> Number:
    """The oscillator's, with positive imaginary part."""
    return mp.mpc(-p.xi * p.omega_n, mp.sqrt(p.omega_n**2 - (p.xi * p.omega_n) ** 2))


def _phasor(p: Point, m: Maths) -> Found:
    """Re z is the displacement, Re(lambda z) the velocity, with the oscillator's eigenvalue lambda."""
    re, im = -p.xi * p.omega_n, m.sqrt(p.omega_n**2 - (p.xi * p.omega_n) ** 2)
    return {"re": p.a, "im": (re * p.a - p.b) / im}


def _rotation(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Complex exponential of the oscillator's eigenvalue, and what the drive's exceeds it by."""
    free, drive = mp.exp(_eigenvalue(p) * p.tau), mp.expj((p.omega_n + p.Delta_omega) * p.tau)
    return {"e_re": free.real, "e_im": free.imag, "d_re": (drive - free).real, "d_im": (drive - free).imag}


def _phases(p: Point, free: Number, drive: Number) -> dict[str, tuple[Number, Number]]:
    """Displacement and velocity of both phases, whose drive has turned by ``drive`` and the rest by ``free``."""
    eigenvalue, turning = _eigenvalue(p), 1j * (p.omega_n + p.Delta_omega)
    found = {}
    for phase in "AB":
        on = p.values[f"g_{phase}"] * p.W * mp.mpc(p.p_re, p.p_im)
        on *= mp.mpc(0, p.s) if phase == "B" else 1  # s quarter turns ahead
        z = (mp.mpc(p.values[f"f_{phase}_re"], p.values[f"f_{phase}_im"]) - on) * free
        found[phase] = (z + on * drive).real, (eigenvalue * z + turning * on * drive).real
    return found


def _seen(p: Point, phases: Mapping[str, tuple[Number, Number]]) -> dict[str, Number]:
    """Height of the wave; amplitude and phase of the surface speed, from its value at two places about the crest.

    The wave is w_A sin kx + w_B cos kx and the surface moves along by D times its slope (eq. 11).
    """
    (w_A, v_A), (w_B, v_B) = phases["A"], phases["B"]
    crest = mp.arg(mp.mpc(w_B, w_A))
    height = w_A * mp.sin(crest) + w_B * mp.cos(crest)

    def speed(u: Number) -> Number:
        return p.D * p.k_c * (v_A * mp.cos(crest + u) - v_B * mp.sin(crest + u))

    there = mp.mpc(speed(mp.mpf(0)), speed(mp.pi / 2))  # R_v (cos phi, sin phi)
    size = abs(there)
    cos_phi, sin_phi = (there.real / size, there.imag / size) if size else (mp.mpf(0), mp.mpf(0))
    return {"W_c": height, "R_v": size, "phi": mp.arg(there), "cos_phi": cos_phi, "sin_phi": sin_phi}


def _wave(p: Point, m: Maths) -> Found:  # noqa: ARG001
    free = mp.mpc(p.e_re, p.e_im)
    return _seen(p, _phases(p, free, free + mp.mpc(p.d_re, p.d_im)))


def _standing_still() -> list[Point]:
    """No wave and no motion: what is divided by the surface speed stays finite."""
    still = grid(_WAVE, 1)()[0].with_(
        W=mp.mpf(0), **{f"f_{phase}_{part}": mp.mpf(0) for phase in "AB" for part in ("re", "im")}
    )
    return [still.with_(tiny=mp.mpf("1e-37"))]


def _wave_slopes(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Difference quotients at a fixed share of a drive period, and in time."""

    def at(point: Point) -> dict[str, Number]:
        free = mp.exp(_eigenvalue(point) * point.tau)
        drive = mp.expj((point.omega_n + point.Delta_omega) * point.tau)
        return _seen(point, _phases(point, free, drive))

    def along(direction: str) -> Callable[[Point, Number], Point]:
        curve = follow(direction, _PHASORS)

        def moved(point: Point, by: Number) -> Point:
            there = curve(point, by)
            share = point.tau * (point.omega_n + point.Delta_omega)
            return there.with_(tau=share / (there.omega_n + there.Delta_omega))

        return moved

    found, curves = {}, {name: along(name) for name in ("omega_n", "Delta_omega")}
    curves["tau"] = lambda point, by: point.with_(tau=point.tau + by)
    with mp.workdps(2 * DIGITS):
        for direction, curve in curves.items():
            step = mp.mpf(10) ** (-DIGITS // 2) * p.values[direction]
            ahead, behind = at(curve(p, step)), at(curve(p, -step))
            for name in ("W_c", "R_v", "phi"):
                found[f"{name}_{direction}"] = (ahead[name] - behind[name]) / (2 * step)
    return found


def _particle(p: Point, m: Maths) -> Found:
    """A point of the wave, along by D times its slope, in motion; the length of its rotating vector; the crest."""

    def displacement(tau: Number, x: Number) -> Number:
        w_A, w_B = (phase_at(p, phase, tau)[0] for phase in "AB")
        return w_A * m.sin(p.k_c * x) + w_B * m.cos(p.k_c * x)

    w_A, w_B = (phase_at(p, phase, p.tau)[0] for phase in "AB")
    v_A, v_B = (phase_at(p, phase, p.tau)[1] for phase in "AB")
    vector = mp.mpc(0)
    for phase, weight in (("A", m.sin(p.k_c * p.x)), ("B", m.cos(p.k_c * p.x))):
        w, v = state_after(p, (p.values[f"a_{phase}"], p.values[f"b_{phase}"]), p.tau)
        eigenvalue = _eigenvalue(p)
        free = mp.mpc(w, (eigenvalue.real * w - v) / eigenvalue.imag)
        lead = p.s * mp.pi / 2 if phase == "B" else 0
        on = p.values[f"g_{phase}"] * p.W * mp.expj((p.omega_n + p.Delta_omega) * p.tau + p.psi + lead)
        vector += weight * (free + on)
    return {
        "zeta_z": displacement(p.tau, p.x),
        "zeta_x": p.D * m.derivative(lambda x: displacement(p.tau, x), p.x),
        "v_x": p.D * m.derivative(lambda x: v_A * m.sin(p.k_c * x) + v_B * m.cos(p.k_c * x), p.x),
        "A_Q": abs(vector),
        "x_max": mp.arg(mp.mpc(w_B, w_A)) / p.k_c,
    }


def _displacement(p: Point, m: Maths) -> Found:
    def vertical(x: Number) -> Number:
        return p.w_A * m.sin(p.k_c * x) + p.w_B * m.cos(p.k_c * x)

    return {"zeta_z": vertical(p.x), "zeta_x": p.D * m.derivative(vertical, p.x)}


_PHASORS = "f_A_re f_A_im f_B_re f_B_im"
_WAVE = f"D Delta_omega W d_im d_re e_im e_re {_PHASORS} g_A g_B k_c omega_n p_im p_re s xi"
_RATES = " ".join(f"{name}_{frequency}" for name in _PHASORS.split() for frequency in ("omega_n", "Delta_omega"))
_WHERE = "random states, both phase leads, gates on and off"
PROOFS = (
    Proof(
        "trum_phasor",
        "re im",
        "12",
        "real parts of z and lambda z are displacement and velocity",
        _phasor,
        grid("a b omega_n xi"),
        "random free motion",
        symbolic=True,
    ),
    Proof(
        "trum_rotation",
        "e_re e_im d_re d_im",
        "9 10 12",
        "complex exponential of the eigenvalue, and the drive's less it",
        _rotation,
        grid("Delta_omega omega_n tau xi"),
        "random times",
    ),
    Proof(
        "trum_wave",
        "W_c R_v phi cos_phi sin_phi",
        "11 16 20 21",
        "complex phasors; height at the crest; surface speed at two places about it",
        _wave,
        grid(_WAVE, 8),
        _WHERE,
    ),
    Proof(
        "trum_wave",
        "W_c R_v phi cos_phi sin_phi",
        "11 16 20 21",
        "all zero without wave and motion",
        _wave,
        _standing_still,
        "the surface at rest",
    ),
    Proof(
        "trum_wave_slopes",
        " ".join(f"{name}_{by}" for by in ("omega_n", "Delta_omega", "tau") for name in ("W_c", "R_v", "phi")),
        "11 16 20 21",
        "difference quotients of the wave at a fixed share of a drive period, and in time",
        _wave_slopes,
        grid(f"D Delta_omega W {_PHASORS} {_RATES} g_A g_B k_c omega_n p_im p_re s tau xi", 8),
        _WHERE,
    ),
    Proof(
        "trum_particle",
        "zeta_z zeta_x v_x A_Q x_max",
        "11 12 16 20",
        "oscillator's matrix exponential; along by D times the slope; modulus of the rotating vector; highest point",
        _particle,
        grid("D Delta_omega W a_A a_B b_A b_B g_A g_B k_c omega_n psi s tau x xi", 8),
        _WHERE,
    ),
    Proof(
        "trum_displacement",
        "zeta_z zeta_x",
        "11",
        "the wave, and D times its slope",
        _displacement,
        grid("D k_c w_A w_B x"),
        "random points",
        symbolic=True,
    ),
)
